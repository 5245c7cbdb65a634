-- The tree of the stage "drivers": each kind of source that has a driver of the kernel below it. Words between @ are put
-- in by the stage, which knows where the kernel has put the devices.

local function stub(register, transfer, also)
  local source = { '@stub@', address = 0x48, register = register, transfer = transfer }
  for key, value in pairs(also or {}) do source[key] = value end
  return i2c(source)
end

local function number(a_s, a, b_s, b)
  ba.i32(b, 0, assert(tonumber(ba.text(a):match('^%s*(%-?%d+)'))))
end

local function digits(a_s, a, b_s, b)
  local text = ('%d\n'):format(ba.i32(a, 0))
  for at = 1, #text do ba.set(b, at - 1, text:byte(at)) end
end

trikfs = {
  -- SMBus, on i2c-stub.
  i2c = {
    byte = { src = stub(0x10, 'byte'), format = 'u8 level' },
    word = { src = stub(0x20, 'word'), format = 'u16 level' },
    block = { src = stub(0x30, 'block'), input_tuple_size = 4, format = 'i32 level' },
    once = { src = stub(0x40, 'byte', { once = true }), format = 'u8 level', mode = 0444 },
    sampled = { src = stub(0x50, 'word'), format = 'u16 level', poll_ms = 20 },
    motor = { src = stub(0x60, 'byte', { readable = false }), format = 'i8 power', rest = 0 },
    silent = { src = i2c { '@stub@', address = 0x51, register = 0, transfer = 'byte' }, format = 'u8 level' },
    unfit = { src = stub(0x10, 'raw'), input_tuple_size = 1, format = 'u8 level' },
    any = { src = i2c_bus { path = '@stub@', reserved = { 0x49 } }, format = 'u8 byte' },
  },
  -- Plain messages, on the board's own bus: 56 bytes of memory in a clock chip.
  memory = {
    src = i2c { '@wire@', address = 0x68, register = 0x10, transfer = 'raw' }, input_tuple_size = 8,
    format = 'i32 low, i32 high',
  },
  nobody = { src = i2c { '@wire@', address = 0x33, register = 0, transfer = 'raw' }, input_tuple_size = 2, format = 'u16 level' },

  -- A sampled sensor, its numbers of different sizes, and an attribute of it.
  sensor = {
    src = iio { name = 'board_sensor', channels = { 'accel_x', 'voltage0', 'voltage1-voltage2', 'voltage3-voltage4', 'timestamp' } },
    format = 'i32 accel, i32 voltage, i32 difference1, i32 difference2, i64 time_ns', on_event = true,
  },
  bias = {
    src = attribute { path = '@sensor@/in_accel_x_calibbias' }, input_tuple_size = 32, format = 'i32 bias',
    converter = number, write_converter = digits,
  },
  scale = {
    src = attribute { path = '@sensor@/in_accel_x_calibscale' }, input_tuple_size = 32, format = 'i32 scale',
    converter = number, write_converter = digits,
  },
  direct = {
    src = attribute { path = '@sensor@/in_voltage0_raw' }, input_tuple_size = 32, format = 'i32 raw', converter = number,
    mode = 0444,
  },

  -- Input.
  stick = { src = evdev { path = '@input@', axes = { 'ABS_X', 'ABS_Y', 'BTN_SOUTH' } }, format = 'i32 x, i32 y, i32 south' },
  events = { src = evdev { path = '@input@', events = true }, format = 'u16 type, u16 code, i32 value, i64 time_us' },
  lamp = {
    src = attribute { path = '@lamp@/brightness' }, input_tuple_size = 32, format = 'i32 brightness',
    converter = number, write_converter = digits, rest = 0,
  },

  -- Lines, a lamp, pulses.
  line_in = { src = gpio { number = @line0@, direction = 'in' }, format = 'u8 level' },
  line_low = { src = gpio { number = @line1@, direction = 'in', active_low = true }, format = 'u8 level' },
  line_out = { src = gpio { number = @line2@, direction = 'out' }, format = 'u8 level', rest = 0 },
  line_high = { src = gpio { number = @line3@, direction = 'high' }, format = 'u8 level' },
  led = {
    src = attribute { path = '/sys/class/leds/board:lamp/brightness' }, input_tuple_size = 32, format = 'i32 brightness',
    converter = number, write_converter = digits, rest = 0,
  },
  servo = { src = pwm { chip = '@chip@', channel = 0, period_ns = 20000000 }, format = 'u32 pulse', units = 'ns', rest = 0 },

  -- A serial line, as bytes and as packets.
  serial = { src = '/tmp/line', input_tuple_size = 2, format = '>u16 word' },
  packets = {
    src = packets {
      path = '/tmp/lidar', baud = 230400, start = '\xAA', length = { at = 1, bytes = 1, add = 3 }, checksum = 'sum8',
    },
    input_tuple_size = 8, format = 'u8 start, u8 length, u8 a, u8 b, u8 c, u8 d, u8 e, u8 f', on_event = true,
  },
}
