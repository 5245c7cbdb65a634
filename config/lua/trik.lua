-- The TRIK controller: every port and every device of the board as nodes in physical units.
--
--   local trik = include 'trik.lua'
--   trikfs = trik.robot { { port = 'M1', type = 'motor95', name = 'left' }, { port = 'A1', type = 'sharpGP2' } }
--
-- A robot file names what is plugged in; ports that it does not name get the usual type. It also leaves the global
-- `setup`, what is done once at the start, after the actions that the robot file has put there.
--
-- Owns the tree and the messages about robot files. What each kind of port means stands in the folder trik.
local Entry = include 'trik/entry.lua'
local speed = include 'trik/speed.lua'
local encoders = include 'trik/encoders.lua'
local imu = include 'trik/imu.lua'
local families = {
  include 'trik/motors.lua', include 'trik/encoders.lua', include 'trik/analog.lua', include 'trik/distance.lua',
  include 'trik/servos.lua', include 'trik/imu.lua', include 'trik/onboard.lua', include 'trik/camera.lua',
  include 'trik/lidar.lua', include 'trik/ir_camera.lua', include 'trik/gamepad.lua', include 'trik/odometry.lua',
  include 'trik/display.lua', include 'trik/raw.lua',
  include 'trik/microphones.lua',
}

-- Names of all ports in order, and the family of each.
local port_names, family_of = {}, {}
for _, family in ipairs(families) do
  local names = {}
  for name in pairs(family.ports) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do
    port_names[#port_names + 1], family_of[name] = name, family
  end
end

local function sorted_types(family)
  local names = {}
  for name in pairs(family.types) do names[#names + 1] = name end
  table.sort(names)
  return names
end

-- Which family has a type, to tell where it belongs.
local function home_of(kind)
  for _, family in ipairs(families) do
    if family.types and (family.types[kind] or family.synonyms and family.synonyms[kind]) then return family end
  end
  return nil
end

local function fitting_type(entry, port, family)
  local kind = entry.given.type
  if not family.types then
    if kind ~= nil then entry:refuse("'" .. port .. "' is part of the board and has no type") end
    return nil
  end
  if kind == nil then return family.default end
  kind = family.synonyms and family.synonyms[kind] or kind
  if type(kind) == 'string' and family.types[kind] then return kind end
  local fits = 'port ' .. port .. ' takes ' .. table.concat(sorted_types(family), ', ')
  if type(kind) ~= 'string' then entry:refuse(fits .. '; type must be one of these words') end
  local home = home_of(kind)
  entry:refuse(fits .. ', not ' .. kind .. (home and ', which belongs to ' .. home.group or ''))
end

-- Checks the list and gives the entry of each port that it names.
local function entries_of(list)
  if type(list) ~= 'table' then error('trik.robot takes a list of ports, not a ' .. type(list), 0) end
  for key in pairs(list) do
    if type(key) ~= 'number' then
      error("trik.robot takes a list of ports: { port = 'M1', ... }, { ... }; '" .. tostring(key)
        .. "' does not belong there", 0)
    end
  end
  local last = table.maxn(list)
  if last > 256 then error('trik.robot takes at most 256 entries, not ' .. last, 0) end
  for number = 1, last do
    if list[number] == nil then error('entry ' .. number .. ' of ' .. last .. ' is nil: is a name mistyped?', 0) end
  end
  local entries = {}
  for number, given in ipairs(list) do
    if type(given) ~= 'table' then error('entry ' .. number .. ' is not a table but a ' .. type(given), 0) end
    local entry, port = Entry.new(given, number), given.port
    if type(port) ~= 'string' then entry:refuse("the port is missing, for example port = 'M1'") end
    if not family_of[port] then
      entry:refuse('there is no such port; there are ' .. table.concat(port_names, ', '))
    end
    if entries[port] then entry:refuse('the port is used already by entry ' .. entries[port].number) end
    entries[port] = entry
  end
  return entries
end

-- Gives a port a second name in its group.
local function add_name(group, entry, port, family)
  local name = entry.given.name
  if name == nil then return end
  if type(name) ~= 'string' or not name:find('^%a[%w_-]*$') or #name > 64 then
    entry:refuse('name must be a word of letters, digits, _ and -, not ' .. Entry.shown(name))
  end
  if family_of[name] then entry:refuse("the name '" .. name .. "' is that of a port") end
  if group[name] then entry:refuse("the name '" .. name .. "' is used twice in " .. family.group) end
  group[name] = { alias = family.group .. '/' .. port }
end

-- Actions of the board itself, then those of what is plugged in.
local function add_setup(actions, extra)
  actions[#actions + 1] = { path = '/sys/class/gpio/gpio62/value', write = '1' }
  for _, gpio in ipairs { 94, 35, 36, 37 } do
    local folder = '/sys/class/gpio/gpio' .. gpio
    actions[#actions + 1] = { path = '/sys/class/gpio/export', write = tostring(gpio), unless = folder }
    actions[#actions + 1] = { path = folder .. '/direction', write = 'high' }
  end
  actions[#actions + 1] = { run = { '/sbin/modprobe', 'hcsr04' }, timeout_ms = 5000 }
  for _, action in ipairs(extra) do actions[#actions + 1] = action end
end

-- The tree of one robot and its actions.
local function build(list)
  local entries, tree, extra = entries_of(list), {}, {}
  for _, port in ipairs(port_names) do
    local family, listed = family_of[port], entries[port] ~= nil
    local entry = entries[port] or Entry.new({ port = port }, 0)
    local kind = fitting_type(entry, port, family)
    if family.top then
      if entry.given.name ~= nil then entry:refuse("'" .. port .. "' is part of the board and takes no name") end
      for name, node in pairs(family.make(port, entry, listed)) do tree[name] = node end
      if listed and family.setup then
        for _, action in ipairs(family.setup()) do extra[#extra + 1] = action end
      end
    else
      local group = tree[family.group] or {}
      tree[family.group] = group
      group[port] = family.make(port, kind, entry)
      add_name(group, entry, port, family)
      if family.setup then extra[#extra + 1] = family.setup(port, kind) end
    end
  end
  speed.add(tree.motors, entries, function(port, entry) return fitting_type(entry, port, family_of[port]) end)
  imu.hold(tree, entries.gyroscope or Entry.new({ port = 'gyroscope' }, 0), encoders.named(entries))
  for _, port in ipairs(port_names) do
    if entries[port] then entries[port]:close() end
  end
  return tree, extra
end

local trik = {}

-- The tree of a robot with these things plugged in.
function trik.robot(list)
  local good, tree, extra = pcall(build, list)
  if not good then error(tree, 2) end
  setup = rawget(_G, 'setup') or {}
  add_setup(setup, extra)
  return tree
end

return trik
