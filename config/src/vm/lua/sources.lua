-- Makes the constructor of one kind of source. It copies the table that it gets and writes the kind into it.
local kind, raw = ...
local error, pairs, type = raw.error, raw.pairs, raw.type

return function(description)
  if type(description) == 'string' then description = { path = description } end
  if type(description) ~= 'table' then error(kind .. ' wants a table or a path', 2) end
  local copy = {}
  for key, value in pairs(description) do copy[key] = value end
  if copy.path == nil and type(copy[1]) == 'string' then copy.path, copy[1] = copy[1], nil end
  copy[''] = kind
  return copy
end
