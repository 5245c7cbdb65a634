-- Lines of text of the sensors that are programs, between bytes and words.
--
-- Owns the size of a line. The sensors' own grammar stands in camera.lua and gamepad.lua.
local text = { SIZE = 128 }

-- The whole numbers of a line that begins with this word, or nothing.
function text.numbers(a, word)
  local line = ba.text(a)
  if line:sub(1, #word) ~= word then return nil end
  local numbers = {}
  for part in line:sub(#word + 1):gmatch('%S+') do
    if not part:find('^-?%d+$') or #part > 10 then return nil end
    numbers[#numbers + 1] = tonumber(part)
  end
  return numbers
end

-- Puts a line into the output.
function text.put(b, line)
  for at = 1, #line do ba.set(b, at - 1, line:byte(at)) end
end

return text
