-- The global `dcml`: a node that follows a robot by its model, from the newest values of other nodes.
--
-- Owns the options, what each source means and the integration: one classical Runge-Kutta step of the fourth order for at
-- most STEP_S. The model is the module that a generator made of its text; chunk(name) gives its function, or nil and why.

-- As often as encoders are sampled; longest step of the integration, and steps that one tuple may take.
local PERIOD_MS, STEP_S, STEPS_MAX = 20, 0.025, 200
-- Angles of other nodes are degrees unless `scale` says otherwise.
local DEGREE = 3.14159265358979323846 / 180
-- More between two tuples is a counter that was set back, not a wheel that turned; one that is near 0 and seems to have
-- turned so far was set to 0.
local JUMP, RESET, NEAR = 10 * 360 * DEGREE, 60 * DEGREE, 4
local PLACE = { 'x', 'y', 'theta' }
local KEYS = { model = true, params = true, actions = true, heading = true, start = true, poll_ms = true }

local function fail(text) error('dcml: ' .. text, 0) end

local function table_of(given, key)
  local value = given[key]
  if value == nil then return {} end
  if type(value) ~= 'table' then fail(key .. ' must be a table, not ' .. shown(value)) end
  return value
end

-- Refuses names that the model has not. `what` is what they name in it.
local function only(key, value, names, what)
  local known = {}
  for _, name in ipairs(names) do known[name] = true end
  for _, name in ipairs(sorted(value)) do
    if not known[name] then
      fail(key .. ": the model has no " .. what .. " '" .. name .. "'; it has " .. (next(known) and table.concat(names, ', ') or 'none'))
    end
  end
end

local function number_of(key, value)
  if type(value) ~= 'number' or value - value ~= 0 then fail(key .. ' must be a number, not ' .. shown(value)) end
  return value
end

-- Where a number comes from: 'NODE', 'd(NODE)' for how fast it changes, or { 'NODE', scale = ..., type = ... }.
local function source(key, given)
  local entry = type(given) == 'string' and { given } or given
  if type(entry) ~= 'table' or type(entry[1]) ~= 'string' then
    fail(key .. " must name a node, 'encoders/E3', or say how fast it changes, 'd(encoders/E3)', not " .. shown(given))
  end
  for name in pairs(entry) do
    if name ~= 1 and name ~= 'scale' and name ~= 'type' then
      fail(key .. ' has an unknown option ' .. shown(name) .. '; there are scale, type')
    end
  end
  local kind = entry.type == nil and 'i32' or entry.type
  if not SIZES[kind] then fail(key .. ': type must be one of ' .. table.concat(sorted(SIZES), ', ') .. ', not ' .. shown(kind)) end
  local inner = entry[1]:match('^d%((.*)%)$')
  local scale = entry.scale == nil and DEGREE or number_of(key .. ': scale', entry.scale)
  return { node = inner or entry[1], is_rate = inner ~= nil, scale = scale, kind = kind, size = SIZES[kind] }
end

-- What the node shows: the place first, then all other states, then all other outputs, in the order of the model.
local function places(model)
  local found, is_place, all = {}, {}, {}
  local function every(names, is_state)
    for index, name in ipairs(names) do
      all[#all + 1] = { name = name, index = index, is_state = is_state, is_angle = name == 'theta' or model.angles[name] }
    end
  end
  every(model.states, true)
  every(model.outputs, false)
  for _, name in ipairs(PLACE) do
    is_place[name] = true
    for _, one in ipairs(all) do
      if one.name == name then found[#found + 1] = one end
    end
  end
  if #found ~= #PLACE then
    fail("the model '" .. model.name .. "' must have x, y and theta in its CONFIG; it has "
      .. table.concat(model.states, ', ') .. (model.outputs[1] and ', ' .. table.concat(model.outputs, ', ') or ''))
  end
  for _, one in ipairs(all) do
    if not is_place[one.name] then found[#found + 1] = one end
  end
  return found
end

local function bounded(value, range)
  if not range then return value end
  return value < range[1] and range[1] or value > range[2] and range[2] or value
end

-- The way from one value of a counter to the next. Whole numbers of 32 bits go on behind their end.
local function way_of(input, before, now)
  local way = now - before
  if input.kind == 'i32' or input.kind == 'u32' then way = (way + 2 ^ 31) % 2 ^ 32 - 2 ^ 31 end
  local far = math.abs(way * input.scale)
  if far > RESET and math.abs(now) * NEAR < math.abs(way) then return now end
  return way
end

-- One step of x' = f(x, u). `held` is a state that does not follow the model, and `rate` how fast it changes.
local function stepper(model, count)
  local k1, k2, k3, k4, mid = {}, {}, {}, {}, {}
  local derivative = model.derivative
  return function(x, u, p, h, held, rate)
    local function slope(at, k)
      derivative(at, u, p, k)
      if held then k[held] = rate end
    end
    slope(x, k1)
    for i = 1, count do mid[i] = x[i] + h / 2 * k1[i] end
    slope(mid, k2)
    for i = 1, count do mid[i] = x[i] + h / 2 * k2[i] end
    slope(mid, k3)
    for i = 1, count do mid[i] = x[i] + h * k3[i] end
    slope(mid, k4)
    for i = 1, count do x[i] = x[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]) end
  end
end

-- The converter from the values of `inputs`, in this order, and the time since the tuple before to what the node shows.
local function follower(model, inputs, defaults, start, place)
  local count, step = #model.states, stepper(model, #model.states)
  local x, u, p, y, before = {}, {}, {}, {}, {}
  local pi, floor = math.pi, math.floor
  local function begin()
    for i = 1, count do x[i] = start[model.states[i]] or 0 end
    for i = 1, #inputs do before[i] = nil end
  end
  local function lose(why)
    begin()
    error('ENODEV: ' .. why .. ': the place is lost and begins anew', 0)
  end
  begin()
  return function(a_s, a, b_s, b)
    local at, held, turned = 0, nil, 0
    local us = ba.u32(a, a_s - 4)
    local dt = us / 1e6
    for index, name in ipairs(model.params) do p[model.keys[index]] = params[name] or defaults[name] end
    for index, input in ipairs(inputs) do
      local now = ba[input.kind](a, at)
      at = at + input.size
      local old = before[index]
      if input.is_rate or input.state then
        local way = old and us > 0 and way_of(input, old, now) * input.scale or 0
        if math.abs(way) > JUMP then lose("'" .. input.node .. "' jumped by " .. way) end
        if input.state then
          held, turned = input.state, way - 2 * pi * floor((way + pi) / (2 * pi))
        else
          u[input.action] = us > 0 and way / dt or 0
        end
        -- A tuple that took no time is looked at with the next one.
        if us > 0 or not old then before[index] = now end
      else
        -- The mean of both ends of the time in which it became what it is.
        u[input.action] = ((old or now) + now) / 2 * input.scale
        before[index] = now
      end
    end
    for index, range in pairs(model.ranges) do u[index] = bounded(u[index], range) end
    if us > 0 then
      local steps = math.min(STEPS_MAX, math.ceil(dt / STEP_S))
      for _ = 1, steps do step(x, u, p, dt / steps, held, turned / dt) end
    end
    for i = 1, count do
      if x[i] - x[i] ~= 0 then lose("the model's " .. model.states[i] .. ' is no finite number') end
    end
    model.output(x, u, p, y)
    for index, one in ipairs(place) do
      local value = one.is_state and x[one.index] or y[one.index]
      if value - value ~= 0 then lose("the model's " .. one.name .. ' is no finite number') end
      if one.is_angle then value = value - 2 * pi * floor((value + pi) / (2 * pi)) end
      ba.f32(b, 4 * (index - 1), value)
    end
  end
end

local function numbers(key, value, names, what)
  only(key, value, names, what)
  local plain = {}
  for name, given in pairs(value) do
    plain[name] = number_of(key .. '.' .. name, type(given) == 'table' and given[1] or given)
  end
  return plain
end

-- What each action comes from, and the heading, in the order in which the sources' tuples stand.
local function sources(given, model)
  local actions, inputs, src = table_of(given, 'actions'), {}, {}
  only('actions', actions, model.actions, 'action')
  local by_name = {}
  for index, name in ipairs(model.actions) do
    if actions[name] == nil then fail("actions: nothing is said of '" .. name .. "': name its node, " .. name .. " = 'd(encoders/E3)'") end
    local input = source('actions.' .. name, actions[name])
    input.action, by_name[name] = index, input
  end
  if given.heading ~= nil then
    local input = source('heading', given.heading)
    for index, name in ipairs(model.states) do
      if name == 'theta' then input.state = index end
    end
    if input.is_rate or not input.state then fail('heading: it takes the place of theta, which must be a state, and is an angle') end
    by_name['(heading)'] = input
  end
  local format = {}
  for _, name in ipairs(sorted(by_name)) do
    local input = by_name[name]
    inputs[#inputs + 1], src[name] = input, 'newest:' .. input.node
    format[#format + 1] = input.kind .. ' ' .. name:gsub('[()]', '_')
  end
  return inputs, src, table.concat(format, ', ') .. ', u32 interval_us'
end

local function describe(given)
  if type(given) ~= 'table' then fail("takes a table: dcml { model = 'robot.dcml', ... }, not " .. shown(given)) end
  for _, key in ipairs(sorted(given)) do
    if not KEYS[key] then fail("there is no option '" .. key .. "'; there are " .. table.concat(sorted(KEYS), ', ')) end
  end
  if type(given.model) ~= 'string' then fail("model must be a file, 'robot.dcml', or a text, not " .. shown(given.model)) end
  local run, problem = chunk('dcml:' .. given.model)
  if not run then error(problem, 0) end
  local model = run()
  local params = table_of(given, 'params')
  local defaults = numbers('params', params, model.params, 'parameter')
  for _, name in ipairs(model.params) do
    if defaults[name] == nil then fail("params: the model needs the number '" .. name .. "'") end
  end
  local start = numbers('start', table_of(given, 'start'), model.states, 'state')
  local place = places(model)
  local inputs, src, format = sources(given, model)
  local shows = {}
  for index, one in ipairs(place) do shows[index] = 'f32 ' .. one.name end
  if #inputs == 0 then fail('the model has no actions: nothing says how it moves') end
  return {
    about = 'place by the model ' .. model.name .. ': x, y, theta and all else of its state in its units, from where it began', mode = 0444,
    src = src, interval = true, input_format = format, poll_ms = given.poll_ms or PERIOD_MS, always = true,
    format = table.concat(shows, ', '), params = next(params) and params or nil,
    converter = follower(model, inputs, defaults, start, place),
  }
end

return function(given)
  local good, made = pcall(describe, given)
  if not good then error(made, 2) end
  return made
end
