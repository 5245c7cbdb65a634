-- id_create(n): a converter that copies n bytes.
local _, raw = ...
local error, type, get, set = raw.error, raw.type, raw.get, raw.set

return function(n)
  if type(n) ~= 'number' or n < 0 or n % 1 ~= 0 then error('id_create wants a number of bytes', 2) end
  return function(a_s, a, b_s, b)
    if n > a_s or n > b_s then
      error('id_create(' .. n .. '): tuples of ' .. a_s .. ' to ' .. b_s .. ' bytes are shorter', 0)
    end
    for i = 0, n - 1 do set(b, i, get(a, i)) end
  end
end
