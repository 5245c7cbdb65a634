-- Where a sound comes from: a program that listens to two microphones and talks through pipes.
--
-- Owns its lines. It runs while one of its files is open for reading. Few boards have the program; without it opening
-- the files fails, and `fault` says so.
local text = include 'trik/text.lua'

local microphones = { top = true, ports = { microphones = {} } }

-- A first sample takes as long as the program needs to start.
local START_MS = 30000
local LINES = 'microphones/text'
local SCRIPT = '/etc/init.d/sound-sensor-1.sh'

function microphones.make()
  return {
    microphones = {
      about = 'direction of a sound in degrees, and how loud it is in each microphone',
      src = 'trikfs:' .. LINES, format = 'i32 angle, i32 left, i32 right', timeout_ms = START_MS, mode = 0444,
      converter = function(a_s, a, b_s, b)
        local numbers = text.numbers(a, 'sound:')
        if not numbers then return false end
        if #numbers ~= 3 then error('EIO: the sensor gave ' .. #numbers .. ' numbers of a sound, not 3', 0) end
        for index = 1, 3 do ba.i32(b, 4 * (index - 1), numbers[index]) end
      end,
      attributes = {
        text = {
          about = 'the lines of the sensor; the other files are made of them',
          src = lines {
            path = '/run/sound-sensor.out.fifo', input = '/run/sound-sensor.in.fifo',
            start = { SCRIPT, 'start' }, stop = { SCRIPT, 'stop' },
          },
          format = 'text ' .. text.SIZE, timeout_ms = START_MS,
        },
        detect = text.command(LINES, 'writing 1 takes the present noise for silence', 'i32 detect', 1, 1, 'detect'),
        volume = text.command(LINES, 'how much louder sounds are taken than they are', 'i32 volume', 0, 100, 'volcoeff'),
        video_out = text.command(LINES, '1 shows the sensor on the screen, 0 does not', 'i32 shown', 0, 1, 'video_out'),
      },
    },
  }
end

return microphones
