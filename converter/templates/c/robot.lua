-- A configuration for the library of this folder; README.md has the commands.
-- A library's path is relative to this file.

trikfs = {
  battery_mean = {
    -- Words 500, 510, 520 and 530, one in each 5 ms. Replace it by your device: src = '/dev/...'
    src = fake{ data = '\244\1\254\1\8\2\18\2', period_ms = 5, loop = true },
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    -- In a process of its own: a crash costs this node an error, and fault says what it died of.
    isolate = true,
    converter = 'libbattery_mean.so#battery_mean',
    params = { count = 16 },
  },
}
