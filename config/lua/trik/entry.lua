-- One entry of a robot file: { port = 'A1', type = 'sharpGP2', name = 'front', ... }, read key by key.
--
-- Owns the words of every refusal. Errors have no place here; trik.lua gives them the line of the robot file.
local Entry = {}
Entry.__index = Entry

-- `number` is the position of the entry in the list, for messages.
function Entry.new(given, number)
  local entry = setmetatable({ given = given, number = number, known = { port = true, type = true, name = true } }, Entry)
  return entry
end

function Entry:refuse(text)
  local port = self.given.port
  local which = type(port) == 'string' and "port '" .. port .. "'" or 'no port'
  error('entry ' .. self.number .. ' (' .. which .. '): ' .. text, 0)
end

local function shown(value)
  if type(value) == 'string' then return "'" .. value .. "'" end
  if type(value) == 'number' or type(value) == 'boolean' then return tostring(value) end
  return value == nil and 'nothing' or 'a ' .. type(value)
end
Entry.shown = shown

-- The value of an option, or its default.
function Entry:get(name, default)
  self.known[name] = true
  local value = self.given[name]
  if value == nil then return default end
  return value
end

-- A number within limits.
function Entry:number_of(name, default, least, greatest)
  local value = self:get(name, default)
  if type(value) ~= 'number' or not (value >= least and value <= greatest) then
    self:refuse(name .. ' must be a number from ' .. least .. ' to ' .. greatest .. ', not ' .. shown(value))
  end
  return value
end

-- A whole number within limits.
function Entry:whole(name, default, least, greatest)
  local value = self:number_of(name, default, least, greatest)
  if value % 1 ~= 0 then self:refuse(name .. ' must be a whole number, not ' .. shown(value)) end
  return value
end

function Entry:boolean(name, default)
  local value = self:get(name, default)
  if type(value) ~= 'boolean' then self:refuse(name .. ' must be true or false, not ' .. shown(value)) end
  return value
end

-- One of some words.
function Entry:word(name, default, words)
  local value = self:get(name, default)
  for _, word in ipairs(words) do
    if value == word then return value end
  end
  self:refuse(name .. " must be '" .. table.concat(words, "' or '") .. "', not " .. shown(value))
end

-- A path of the system.
function Entry:path(name, default)
  local value = self:get(name, default)
  if type(value) ~= 'string' or value:sub(1, 1) ~= '/' then
    self:refuse(name .. ' must be a path that begins with a slash, not ' .. shown(value))
  end
  return value
end

-- A list of whole numbers, or nil if it is not given.
function Entry:numbers(name, count, least, greatest)
  local value = self:get(name)
  if value == nil then return nil end
  if type(value) ~= 'table' or #value ~= count then
    self:refuse(name .. ' must be a list of ' .. count .. ' numbers')
  end
  for _, number in ipairs(value) do
    if type(number) ~= 'number' or not (number >= least and number <= greatest) then
      self:refuse(name .. ' must be numbers from ' .. least .. ' to ' .. greatest .. ', not ' .. shown(number))
    end
  end
  return value
end

-- A list of points { {x, y}, ... } whose numbers are all at least 0, or nil if it is not given.
function Entry:points(name, count_min, count_max)
  local value = self:get(name)
  if value == nil then return nil end
  local good = type(value) == 'table' and #value >= count_min and #value <= count_max
  if good then
    for _, point in ipairs(value) do
      good = good and type(point) == 'table' and #point == 2
      for index = 1, 2 do
        local number = good and point[index]
        good = good and type(number) == 'number' and number >= 0 and number <= 1e6 and number % 1 == 0
      end
    end
  end
  if not good then
    local count = count_min == count_max and count_min or count_min .. ' to ' .. count_max
    self:refuse(name .. ' must be a list of ' .. count .. ' pairs of whole numbers from 0 to 1000000')
  end
  return value
end

-- Refuses what nobody has asked for.
function Entry:close()
  local stray
  for key in pairs(self.given) do
    if not self.known[key] and (stray == nil or tostring(key) < tostring(stray)) then stray = key end
  end
  if stray == nil then return end
  local known = {}
  for key in pairs(self.known) do known[#known + 1] = key end
  table.sort(known)
  self:refuse('unknown option ' .. shown(stray) .. ', there are: ' .. table.concat(known, ', '))
end

return Entry
