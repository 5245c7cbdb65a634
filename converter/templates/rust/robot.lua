-- A configuration for the library of this folder. Run `cargo build --release` first:
--
--     trikfs check robot.lua
--     trikfs mount --config robot.lua /tmp/trikfs
--     cat /tmp/trikfs/battery_mean/value
--
-- A library's path is relative to this file. Replace /dev/urandom by your device.

trikfs = {
  battery_mean = {
    src = '/dev/urandom',
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    converter = 'target/release/libmy_converters.so#battery_mean',
    params = { count = 16 },
  },
}
