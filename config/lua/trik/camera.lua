-- Camera: line, object and colours, found by programs on the signal processor that talk through pipes; and pictures.
--
-- Owns their commands and answers. A sensor or the encoder of pictures runs while one of its files is open for reading; only one runs at a time.
local text = include 'trik/text.lua'
local number = include 'trik/number.lua'

local camera = { top = true, ports = { camera = {} } }

-- A first sample takes as long as the program needs to start.
local START_MS = 30000

-- Bytes of the largest picture: 320 x 240 points in the best quality have half of that.
local PICTURE_BYTES = 65536

-- JPEG pictures of the encoder on the signal processor, or of a pipe that the robot file names.
local function pictures_of(entry)
  local quality = entry:whole('quality', 50, 1, 100)
  local src
  if entry.given.pictures ~= nil then
    src = pictures { path = entry:path('pictures') }
  else
    local script = '/etc/init.d/mjpg-encoder-ov7670'
    src = pictures {
      path = '/run/mjpg-encoder.out.fifo', start = { script, 'start', '--jpeg-qual', tostring(quality) },
      stop = { script, 'stop' },
    }
  end
  return {
    about = 'pictures of the camera, each a JPEG file that is filled up with zero bytes',
    src = src, input_tuple_size = PICTURE_BYTES, timeout_ms = START_MS,
  }
end

local function command(sensor, ...)
  return text.command('camera/' .. sensor .. '/text', ...)
end

-- What all three have: their lines, and whether the picture is shown on the screen.
local function attributes(sensor, script)
  local fifo = '/run/' .. sensor .. '-sensor.'
  script = '/etc/init.d/' .. script
  return {
    text = {
      about = 'the lines of the sensor; the other files are made of them',
      src = lines {
        path = fifo .. 'out.fifo', input = fifo .. 'in.fifo', start = { script, 'start' }, stop = { script, 'stop' },
        question = 'detect', answer = 'hsv:',
      },
      format = 'text ' .. text.SIZE, timeout_ms = START_MS,
    },
  }
end

-- `hsv: a b c d e f` is the answer to `detect`, and `hsv a b c d e f` says what to look for.
local function detection(sensor, into)
  into.detect = command(sensor, 'writing 1 measures the colour in the middle of the picture', 'i32 detect', 1, 1, 'detect')
  into.hsv = {
    about = 'colour to look for: hue, saturation, value, each with its tolerance; reads the last answer to detect',
    src = 'trikfs:camera/' .. sensor .. '/text', timeout_ms = START_MS,
    format = 'i32 hue, i32 hue_tolerance, i32 saturation, i32 saturation_tolerance, i32 value, i32 value_tolerance',
    converter = function(a_s, a, b_s, b)
      local numbers = text.numbers(a, 'hsv:')
      if not numbers then return false end
      if #numbers ~= 6 then error('EIO: the sensor gave ' .. #numbers .. ' numbers of a colour, not 6', 0) end
      for index = 1, 6 do ba.i32(b, 4 * (index - 1), numbers[index]) end
    end,
    write_converter = function(a_s, a, b_s, b)
      local numbers = {}
      for index = 1, 6 do numbers[index] = number.within('each number', ba.i32(a, 4 * (index - 1)), 0, 360) end
      text.put(b, 'hsv ' .. table.concat(numbers, ' '))
    end,
  }
end

-- A sensor that says `loc:` and three numbers.
local function located(sensor, about, format)
  local node = {
    about = about, src = 'trikfs:camera/' .. sensor .. '/text', format = format, units = '%', timeout_ms = START_MS,
    mode = 0444,
    converter = function(a_s, a, b_s, b)
      local numbers = text.numbers(a, 'loc:')
      if not numbers then return false end
      if #numbers ~= 3 then error('EIO: the sensor gave ' .. #numbers .. ' numbers of a place, not 3', 0) end
      for index = 1, 3 do
        if numbers[index] < -100 or numbers[index] > 100 then
          error('EIO: the sensor gave ' .. numbers[index] .. ', which is not -100 to 100', 0)
        end
        ba.i32(b, 4 * (index - 1), numbers[index])
      end
    end,
    attributes = attributes(sensor, sensor .. '-sensor-ov7670'),
  }
  detection(sensor, node.attributes)
  node.attributes.video_out =
    command(sensor, '1 shows the picture on the screen, 0 does not', 'i32 shown', 0, 1, 'video_out')
  return node
end

-- Colours of a grid of cells, row by row.
local function colours(rows, columns)
  local fields = {}
  for row = 1, rows do
    for column = 1, columns do fields[#fields + 1] = 'u32 row' .. row .. '_' .. column end
  end
  local node = {
    about = 'mean colour of each cell of the picture, row by row, as 65536 red + 256 green + blue',
    src = 'trikfs:camera/color/text', format = table.concat(fields, ', '), timeout_ms = START_MS, mode = 0444,
    converter = function(a_s, a, b_s, b)
      local numbers = text.numbers(a, 'color:')
      if not numbers then return false end
      if #numbers ~= #fields then
        error('EIO: the sensor gave ' .. #numbers .. ' colours, not ' .. #fields .. ': write mxn', 0)
      end
      for index, value in ipairs(numbers) do
        if value < 0 or value > 0xffffff then error('EIO: the sensor gave ' .. value .. ', which is no colour', 0) end
        ba.u32(b, 4 * (index - 1), value)
      end
    end,
    attributes = attributes('mxn', 'mxn-sensor-ov7670'),
  }
  node.attributes.mxn = command('color', 'rows and columns of the picture, 1 to 3 each', 'i32 rows, i32 columns', 1, 3, 'mxn')
  node.attributes.video_out =
    command('color', '1 shows the picture on the screen, 0 does not', 'i32 shown', 0, 1, 'video_out')
  return node
end

function camera.make(_, entry)
  local rows, columns = entry:whole('rows', 3, 1, 3), entry:whole('columns', 3, 1, 3)
  return {
    camera = {
      line = located('line', 'line on the floor: x -100 left to 100 right, crossroads and mass 0 to 100',
        'i32 x, i32 crossroads, i32 mass'),
      object = located('object', 'largest spot of a colour: x and y -100 to 100, size 0 to 100, 0 if there is none',
        'i32 x, i32 y, i32 size'),
      color = colours(rows, columns),
      picture = pictures_of(entry),
    },
  }
end

return camera
