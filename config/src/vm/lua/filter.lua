-- The global `filter`. A state keeps only the filters that it uses: all of them together take as much memory as
-- everything else in it. filters() gives the function that makes them all; a table that nobody holds is made anew.
local raw, filters = ...
local rawset = raw.rawset
local made = raw.setmetatable({}, { __mode = 'v' })

return raw.setmetatable({}, {
  __metatable = false,
  __index = function(self, name)
    local all = made.all
    if not all then
      all = filters()()
      made.all = all
    end
    rawset(self, name, all[name])
    if raw.note_member then raw.note_member('filter', name, all[name]) end
    return all[name]
  end,
})
