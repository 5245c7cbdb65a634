-- A configuration for the library of this folder. Build it first, the command stands at the top of plain.c:
--
--     trikfs check robot.lua
--     trikfs mount --config robot.lua /tmp/trikfs
--     cat /tmp/trikfs/battery/value
--
-- A library's path is relative to this file. Replace /dev/urandom by your device.

trikfs = {
  battery = {
    src = '/dev/urandom',
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    -- In a process of its own: a crash costs this node an error, and fault says what it died of.
    isolate = true,
    converter = 'libplain.so',
  },
}
