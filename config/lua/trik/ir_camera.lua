-- Infrared camera MLX90640 on the I2C connector: 768 pixels to the classes of a grid of cells.
--
-- Owns the registers and the offsets of the pixels. It gives no temperatures: those need the maker's whole equation.
-- Everything in the camera is big-endian, in words of 16 bits.
local ir_camera = { top = true, ports = { ir_camera = {} } }

local BUS, ADDRESS = '/dev/i2c-1', 0x33
local ROWS, COLUMNS, WORDS = 24, 32, 832
-- Means of a cell below these belong to class 0 to 5, others to 6.
local THRESHOLDS = { -120, -80, -20, 20, 90, 200 }

local function register(address, once)
  return i2c { path = BUS, address = ADDRESS, register = address, register_bytes = 2, transfer = 'raw', once = once }
end

-- Four bits of a word as a signed number.
local function nibble(word, index)
  local value = math.floor(word / 16 ^ index) % 16
  return value < 8 and value or value - 16
end

-- The value of a pixel when it sees nothing. `at`: where the memory of the camera begins in the input.
local function offset_of(a, at, row, column)
  local function word(index) return ba.u16_be(a, at + 2 * index) end
  local scales = word(16)
  local of_row = nibble(word(18 + math.floor(row / 4)), row % 4) * 2 ^ (math.floor(scales / 256) % 16)
  local of_column = nibble(word(24 + math.floor(column / 4)), column % 4) * 2 ^ (math.floor(scales / 16) % 16)
  local rest = math.floor(word(64 + COLUMNS * row + column) / 1024)
  if rest > 31 then rest = rest - 64 end
  return ba.i16_be(a, at + 34) + of_row + of_column + rest * 2 ^ (scales % 16)
end

-- The node of the camera; absent unless the robot file names it.
function ir_camera.make(_, entry, listed)
  local about = 'warmth of each cell of the picture, row by row, 0 cold to 6 hot'
  if not listed then
    return {
      ir_camera = {
        about = about, input_tuple_size = 1,
        src = absent { reason = "there is no infrared camera in the robot file: add { port = 'ir_camera' }" },
      },
    }
  end
  local rows, columns = entry:whole('rows', 3, 1, ROWS), entry:whole('columns', 3, 1, COLUMNS)
  local fields = {}
  for row = 1, rows do
    for column = 1, columns do fields[#fields + 1] = 'i32 row' .. row .. '_' .. column end
  end
  local offsets
  local src, sizes = { register(0x0400), register(0x2400, true) }, { 2 * WORDS, 2 * WORDS }
  return {
    ir_camera = {
      about = about, src = src, input_tuple_size = sizes, format = table.concat(fields, ', '),
      poll_ms = 250, timeout_ms = 3000, budget_us = 200000,
      converter = function(a_s, a, b_s, b)
        if not offsets then
          offsets = {}
          for pixel = 0, ROWS * COLUMNS - 1 do
            offsets[pixel] = offset_of(a, 2 * WORDS, math.floor(pixel / COLUMNS), pixel % COLUMNS)
          end
        end
        local sums, counts = {}, {}
        for pixel = 0, ROWS * COLUMNS - 1 do
          local row, column = math.floor(pixel / COLUMNS), pixel % COLUMNS
          local cell = math.floor(row * rows / ROWS) * columns + math.floor(column * columns / COLUMNS)
          sums[cell] = (sums[cell] or 0) + ba.i16_be(a, 2 * pixel) - offsets[pixel]
          counts[cell] = (counts[cell] or 0) + 1
        end
        for cell = 0, rows * columns - 1 do
          local mean, class = sums[cell] / counts[cell], 0
          while class < #THRESHOLDS and mean >= THRESHOLDS[class + 1] do class = class + 1 end
          ba.i32(b, 4 * cell, class)
        end
      end,
    },
  }
end

-- Four pictures in a second, in chess order, one after the other.
function ir_camera.setup()
  return {
    { to = register(0x800D), write = '\25\129' },
    { to = register(0x8000), write = '\0\48' },
  }
end

return ir_camera
