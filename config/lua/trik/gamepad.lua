-- Gamepad: lines of text that a telephone or a PC sends, which the board passes on in a pipe.
--
-- Owns their grammar. Every line shows that the gamepad is there, so every line makes a sample; without lines for
-- MAX_AGE_MS, longer than clients pause, values are too old and reads fail.
local text = include 'trik/text.lua'

local gamepad = { top = true, ports = { gamepad = {} } }

local MAX_AGE_MS = 6000
local SRC = 'trikfs:gamepad/text'

local function limited(word, least, greatest)
  local value = #word <= 6 and word:find('^-?%d+$') and tonumber(word)
  if value and value >= least and value <= greatest then return value end
  return nil
end

local function words_of(a)
  local words = {}
  for word in ba.text(a):gmatch('%S+') do words[#words + 1] = word end
  return words
end

-- A node whose numbers change with some lines: change(values, words) changes them in place.
local function node(about, format, values, change)
  return {
    about = about, src = SRC, format = format, on_event = true, max_age_ms = MAX_AGE_MS,
    converter = function(a_s, a, b_s, b)
      change(values, words_of(a))
      for index, value in ipairs(values) do ba.i32(b, 4 * (index - 1), value) end
    end,
  }
end

local function pad(which)
  return node('pad ' .. which .. ': x and y -100 to 100, and 1 while it is touched', 'i32 x, i32 y, i32 touched',
    { 0, 0, 0 }, function(values, words)
      if words[1] ~= 'pad' or words[2] ~= tostring(which) then return end
      if words[3] == 'up' then
        values[1], values[2], values[3] = 0, 0, 0
        return
      end
      local x, y = limited(words[3] or '', -100, 100), limited(words[4] or '', -100, 100)
      if x and y then values[1], values[2], values[3] = x, y, 1 end
    end)
end

function gamepad.make()
  local buttons = node('buttons 1 to 5: 1 from down to up; a client that never says up leaves it',
    'i32 b1, i32 b2, i32 b3, i32 b4, i32 b5', { 0, 0, 0, 0, 0 }, function(values, words)
      local button = words[1] == 'btn' and limited(words[2] or '', 1, 5)
      if button then values[button] = words[3] == 'up' and 0 or 1 end
    end)
  local presses = node('how often each button was pressed since the start',
    'i32 b1, i32 b2, i32 b3, i32 b4, i32 b5', { 0, 0, 0, 0, 0 }, function(values, words)
      local button = words[1] == 'btn' and limited(words[2] or '', 1, 5)
      if button and words[3] ~= 'up' then values[button] = (values[button] + 1) % 2147483648 end
    end)
  buttons.attributes = { presses = presses }
  return {
    gamepad = {
      text = {
        about = 'the lines of the gamepad as they come',
        src = lines { path = '/run/gamepad-service.out.fifo' }, format = 'text ' .. text.SIZE,
        on_event = true, max_age_ms = MAX_AGE_MS,
      },
      pad1 = pad(1),
      pad2 = pad(2),
      buttons = buttons,
      wheel = node('the steering wheel, -100 to 100', 'i32 wheel', { 0 }, function(values, words)
        local value = words[1] == 'wheel' and limited(words[2] or '', -100, 100)
        if value then values[1] = value end
      end),
    },
  }
end

return gamepad
