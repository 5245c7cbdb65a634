-- The global `dataflow`: a node that computes by a program of data flow, from the newest values of other nodes.
--
-- Owns the options, and how tuples become readings. The program is the module that a generator made of it; chunk(name)
-- gives its function, or nil and why.

-- As often as programs poll their sensors.
local PERIOD_MS = 20
local KEYS = { program = true, inputs = true, shows = true, poll_ms = true, language = true }
local COUNT_MAX, NAME_MAX = 400, 1000
-- Room for a program in Lua of as many blocks as it may have.
local MEMORY_KB = 16384

local function fail(text) error('dataflow: ' .. text, 0) end

local function names_of(list)
  local names = {}
  for index, one in ipairs(list) do names[index] = one.name end
  return next(names) and table.concat(names, ', ') or 'none'
end

local function whole(key, value, least, most)
  if type(value) ~= 'number' or value % 1 ~= 0 or value < least or value > most then
    fail(key .. ' must be a whole number of ' .. least .. ' to ' .. most .. ', not ' .. shown(value))
  end
  return value
end

-- Where a reading comes from: 'NODE', or { 'NODE', type = ..., count = ... }.
local function source(input, given)
  local key = 'inputs.' .. input.name
  if given == nil then fail("inputs: nothing is said of '" .. input.name .. "': name its node, " .. input.name .. " = 'sensors/A1'") end
  local entry = type(given) == 'string' and { given } or given
  if type(entry) ~= 'table' or type(entry[1]) ~= 'string' then
    fail(key .. " must name a node, 'sensors/A1', not " .. shown(given))
  end
  for name in pairs(entry) do
    if name ~= 1 and name ~= 'type' and name ~= 'count' then
      fail(key .. ' has an unknown option ' .. shown(name) .. '; there are count, type')
    end
  end
  local kind = entry.type == nil and 'i32' or entry.type
  if not SIZES[kind] then fail(key .. ': type must be one of ' .. table.concat(sorted(SIZES), ', ') .. ', not ' .. shown(kind)) end
  if input.count == 0 and entry.count ~= nil then fail(key .. ' has no count: the program reads one number') end
  local count = input.count
  if entry.count ~= nil then count = whole(key .. '.count', entry.count, 1, COUNT_MAX) end
  return { node = entry[1], kind = kind, size = SIZES[kind], count = count, field = input.field, name = input.name }
end

local function sources(given, program)
  local wanted = given.inputs == nil and {} or given.inputs
  if type(wanted) ~= 'table' then fail('inputs must be a table, not ' .. shown(wanted)) end
  local known = {}
  for _, input in ipairs(program.inputs) do known[input.name] = true end
  if #wanted > 0 then fail("inputs must name sensors: " .. (program.inputs[1] or { name = 'sensorA1' }).name .. " = 'sensors/A1'") end
  for _, name in ipairs(sorted(wanted)) do
    if not known[name] then fail("inputs: the program reads no '" .. name .. "'; it reads " .. names_of(program.inputs)) end
  end
  local inputs, src, format = {}, {}, {}
  -- In the order of their names, in which the tuples of several sources stand.
  for index, input in ipairs(program.inputs) do
    local one = source(input, wanted[input.name])
    inputs[index], src[input.name] = one, 'newest:' .. one.node
    for at = 1, one.count == 0 and 1 or one.count do
      format[#format + 1] = one.kind .. ' ' .. input.name .. (one.count == 0 and '' or '_' .. at)
    end
  end
  return inputs, src, table.concat(format, ', ') .. ', u32 interval_us'
end

-- What the node shows: outputs and variables by their names.
local function shows(given, program)
  local wanted, found = given.shows, {}
  if wanted == nil then
    for index, output in ipairs(program.outputs) do found[index] = output end
    if #found == 0 then
      fail("shows: the program tells no motor anything: name variables that the node shows, shows = { 'heading' }; it has " .. names_of(program.variables))
    end
    return found
  end
  if type(wanted) == 'string' then wanted = { wanted } end
  if type(wanted) ~= 'table' or #wanted == 0 then fail('shows must be a list of names, not ' .. shown(given.shows)) end
  for key in pairs(wanted) do
    if type(key) ~= 'number' then fail('shows is a list: ' .. shown(key) .. ' is no place in it') end
  end
  for index, name in ipairs(wanted) do
    for _, list in ipairs({ program.outputs, program.variables }) do
      for _, one in ipairs(list) do
        if one.name == name then found[index] = one end
      end
    end
    if type(name) ~= 'string' then fail('shows must be a list of names: ' .. shown(name) .. ' is none') end
    if found[name] then fail("shows names '" .. name .. "' twice") end
    found[name] = true
    if not found[index] then
      fail('shows: the program has no ' .. shown(name) .. '; there are ' .. names_of(program.outputs) .. ' and the variables ' .. names_of(program.variables))
    end
  end
  return found
end

-- The converter in Lua.
local function runner(program, inputs, fields)
  local begin = program.new
  local step, readings = begin(), {}
  return function(a_s, a, b_s, b)
    local at = 0
    for index = 1, #inputs do
      local input = inputs[index]
      local read, size = ba[input.kind], input.size
      if input.count == 0 then
        readings[input.field] = read(a, at)
        at = at + size
      else
        -- A new one each time: the program may keep it.
        local list = { n = input.count }
        for item = 0, input.count - 1 do
          list[item] = read(a, at)
          at = at + size
        end
        readings[input.field] = list
      end
    end
    local good, s = pcall(step, ba.u32(a, a_s - 4), readings)
    if not good then
      -- Whatever was wrong, the program begins anew.
      step = begin()
      error(s, 0)
    end
    for index = 1, #fields do
      local value = s[fields[index].field]
      if value == nil then return false end
      if value == true then value = 1 elseif value == false then value = 0 end
      local is_number = type(value) == 'number'
      if not is_number or value - value ~= 0 then
        step = begin()
        error(fields[index].name .. (is_number and ': this is no finite number' or ': this is no number'), 0)
      end
      ba.f64(b, 8 * (index - 1), value)
    end
  end
end

-- The converter in C, which is told what its tuples are.
local function code(program, inputs, fields)
  local lines = {}
  for _, input in ipairs(inputs) do
    lines[#lines + 1] = '#define TYPE_' .. input.name .. ' ' .. input.kind
    if input.count > 0 then lines[#lines + 1] = '#define COUNT_' .. input.name .. ' ' .. input.count end
  end
  local names = {}
  for index, field in ipairs(fields) do names[index] = 'FIELD(' .. field.field .. ')' end
  lines[#lines + 1] = '#define FIELDS(FIELD) ' .. table.concat(names, ' ')
  return { code = table.concat(lines, '\n') .. '\n' .. program.code }
end

local function describe(given)
  if type(given) ~= 'table' then fail("takes a table: dataflow { program = 'balance.flow', ... }, not " .. shown(given)) end
  for _, key in ipairs(sorted(given)) do
    if not KEYS[key] then fail("there is no option '" .. key .. "'; there are " .. table.concat(sorted(KEYS), ', ')) end
  end
  if type(given.program) ~= 'string' then fail("program must be a file, 'balance.flow', or a text, not " .. shown(given.program)) end
  if #given.program > NAME_MAX and not given.program:find('\n', 1, true) then
    fail('program is neither the name of a file nor a text of several lines')
  end
  local language = given.language == nil and 'lua' or given.language
  if language ~= 'lua' and language ~= 'c' then fail("language must be 'lua' or 'c', not " .. shown(language)) end
  local run, problem = chunk((language == 'c' and 'dataflow-c:' or 'dataflow:') .. given.program)
  if not run then error(problem, 0) end
  local program = run()
  local is_program = type(program) == 'table' and type(program.new) == 'function' and type(program.name) == 'string'
  for _, key in ipairs({ 'inputs', 'outputs', 'variables' }) do
    is_program = is_program and type(program[key]) == 'table'
  end
  if not is_program then
    fail(shown(given.program) .. " is no program that 'trik gen --lang lua' wrote")
  end
  local inputs, src, format = sources(given, program)
  local fields, names = shows(given, program), {}
  for index, field in ipairs(fields) do
    -- A format has Latin letters alone; the field of a program's name has them too.
    names[index] = 'f64 ' .. (field.name:match('^[%a_][%w_]*$') or field.field)
  end
  return {
    memory_kb = MEMORY_KB, about = 'computed by the program of data flow ' .. program.name, mode = 0444,
    src = src, interval = true, input_format = format, poll_ms = given.poll_ms == nil and PERIOD_MS or given.poll_ms, always = true,
    format = table.concat(names, ', '),
    converter = language == 'c' and code(program, inputs, fields) or runner(program, inputs, fields),
  }
end

return function(given)
  local good, made = pcall(describe, given)
  if not good then error(made, 2) end
  return made
end
