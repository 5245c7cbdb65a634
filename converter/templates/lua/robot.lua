-- A configuration with the converter battery_mean in Lua. Nothing has to be built; README.md has the commands.
--
-- The example to replace by your own: the battery of the TRIK controller behind its voltage divider. The low 10 bits of
-- a little-endian 16-bit word are the voltage, and 1023 stands for 13256 mV. Each output is the mean of `count` inputs;
-- the inputs in between give none.

local FULL_SCALE_MV, FULL_SCALE = 13256, 1023

local function battery_mean()
  -- Each open file runs this program anew, so these are the memory of one open file.
  local sum, taken = 0, 0
  return function(a_s, a, b_s, b)
    local raw = ba.u16(a, 0)
    if raw == 0xffff then
      -- Nothing answers on the bus: never invent a voltage.
      error('battery_mean: the converter chip does not answer', 0)
    end
    sum, taken = sum + raw % 1024, taken + 1
    if taken < params.count then return false end
    ba.i32(b, 0, math.floor((sum * FULL_SCALE_MV + 511 * taken) / (FULL_SCALE * taken)))
    sum, taken = 0, 0
  end
end

trikfs = {
  battery_mean = {
    -- Words 500, 510, 520 and 530, one in each 5 ms. Replace it by your device: src = '/dev/...'
    src = fake{ data = '\244\1\254\1\8\2\18\2', period_ms = 5, loop = true },
    input_tuple_size = 2,
    output_tuple_size = 4,
    format = 'i32 millivolts',
    units = 'mV',
    converter = battery_mean(),
    params = { count = { 16, min = 1, max = 1000 } },
  },
}
