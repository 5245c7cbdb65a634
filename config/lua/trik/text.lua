-- Lines of text of the sensors that are programs, between bytes and words.
--
-- Owns the size of a line. The sensors' own grammar stands in camera.lua and gamepad.lua.
local number = include 'trik/number.lua'

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

-- A node that is written: the text of a command from numbers, for the node whose lines are at `lines`.
function text.command(lines, about, format, least, greatest, line)
  local names = {}
  for name in format:gmatch('%S+ (%w+)') do names[#names + 1] = name end
  return {
    about = about, src = 'trikfs:' .. lines, format = format, mode = 0222,
    converter = function() return false end,
    write_converter = function(a_s, a, b_s, b)
      local values = {}
      for index, name in ipairs(names) do
        values[index] = number.within(name, ba.i32(a, 4 * (index - 1)), least, greatest)
      end
      text.put(b, line .. (line == 'detect' and '' or ' ' .. table.concat(values, ' ')))
    end,
  }
end

return text
