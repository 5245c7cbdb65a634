-- A configuration with a converter in Lua, to copy. Nothing has to be built:
--
--     trikfs check robot.lua
--     trikfs mount --config robot.lua /tmp/trikfs
--     cat /tmp/trikfs/battery/value
--
-- The battery of the TRIK controller behind its voltage divider: the low 10 bits of a 16-bit word are the
-- voltage, 1023 stands for 13256 mV. Replace /dev/urandom by your device.

local full_scale_mv = 13256

trikfs = {
  battery = {
    src = '/dev/urandom',
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    converter = function(a_s, a, b_s, b)
      local raw = ba.u16(a, 0) % 1024
      ba.i32(b, 0, math.floor(raw * full_scale_mv / 1023 + 0.5))
    end,
  },
}
