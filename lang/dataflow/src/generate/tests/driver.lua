-- Runs converters with their readings: luajit driver.lua NAME ..., for NAME.lua and NAME.rows.
for _, name in ipairs(arg) do
  print('=')
  local module = assert(loadfile(name .. '.lua'))()
  local step = module.new()
  local first = true
  for line in io.lines(name .. '.rows') do
    local row = {}
    for number in line:gmatch('%S+') do row[#row + 1] = tonumber(number) end
    local readings = {}
    local all = {
      sensorA1 = row[1], sensorA2 = row[2], sensorD1 = row[3], accelerometer = { n = 3, [0] = row[4], row[5], row[6] },
      encoder3 = row[7], encoder4 = row[8],
    }
    for _, input in ipairs(module.inputs) do readings[input.field] = all[input.name] end
    local good, s = pcall(step, first and 0 or 20000, readings)
    first = false
    if not good then
      print('fault ' .. s)
      break
    end
    local function show(list)
      for _, one in ipairs(list) do
        local value = s[one.field]
        if type(value) == 'boolean' then value = value and 1 or 0 end
        if type(value) == 'number' then print(('%s %.17g'):format(one.name, value)) end
      end
    end
    show(module.outputs)
    show(module.variables)
    print('')
  end
end
