-- The tree of the boot test: one node of each kind that needs neither hardware nor a compiler.

local function tenths(a_s, a, b_s, b)
  ba.i32(b, 0, tonumber(ba.text(a):match('%S+')) * 10)
end

trikfs = {
  -- A state, converted in Lua.
  battery = {
    src = attribute{ path = '/tmp/battery' }, input_tuple_size = 16,
    format = 'i32 voltage', units = 'dV', converter = tenths,
  },
  -- The same through a shared library.
  scaled = {
    src = fake{ data = '\1\0\0\0', loop = true }, input_tuple_size = 4,
    format = 'i32 length', units = 'mm',
    converter = 'libtrikfs_filters.so#scale', params = { x0 = 0, y0 = 100, x1 = 1, y1 = 107 },
  },
  hello = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = 'libhello.so' },
  -- Events: a pipe and an input device.
  line = { src = '/tmp/line', input_tuple_size = 4, format = 'i32 line', converter = function(a_s, a, b_s, b)
    ba.i32(b, 0, ba.i32(a, 0) + 1)
  end },
  key = { src = evdev{ path = '/dev/input/event0', axes = { 'KEY_ENTER' } }, format = 'i32 pressed' },
  -- An actuator with a rest value.
  motor = {
    src = '/tmp/motor', input_tuple_size = 1, format = 'i32 power', units = '%', rest = 0,
    converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.i8(a, 0)) end,
    write_converter = function(a_s, a, b_s, b) ba.i8(b, 0, ba.i32(a, 0)) end,
  },
  -- What a reading costs: the same four bytes through each kind of converter.
  plain = { src = fake{ data = '\1\2\3\4', loop = true }, input_tuple_size = 4 },
  lua = {
    src = fake{ data = '\1\2\3\4', loop = true }, input_tuple_size = 4, output_tuple_size = 4,
    converter = function(a_s, a, b_s, b)
      for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i) + 1) end
    end,
  },
  library = {
    src = fake{ data = '\1\2\3\4', loop = true }, input_tuple_size = 4, output_tuple_size = 4,
    converter = 'libhello.so',
  },
  burned = {
    src = fake{ data = '\1\2\3\4', loop = true }, input_tuple_size = 4, output_tuple_size = 4,
    converter = function() while true do end end,
  },
}
