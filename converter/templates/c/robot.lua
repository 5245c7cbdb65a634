-- A configuration for the two libraries of this folder. Build them first, the commands stand at the top of each source:
--
--     trikfs check robot.lua
--     trikfs mount --config robot.lua /tmp/trikfs
--     cat /tmp/trikfs/battery/value /tmp/trikfs/battery_mean/value
--
-- A library's path is relative to this file. Replace /dev/urandom by your device.

trikfs = {
  battery = {
    src = '/dev/urandom',
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    converter = 'libplain.so',
  },
  battery_mean = {
    src = '/dev/urandom',
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    converter = 'libversioned.so#battery_mean',
    params = { count = 16 },
  },
}
