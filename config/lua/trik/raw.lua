-- Buses and input devices as they are, for parts that have no node of their own: programs speak their language.
--
-- Owns which devices of the board are out of reach: those that other nodes drive and those that have a driver.
local raw = { top = true, ports = { i2c = {}, input = {} } }

-- Both buses of the controller. The coprocessor drives the motors, and only its nodes know their rest.
local RESERVED = { bus1 = {}, bus2 = { 0x18, 0x1c, 0x48, 0x50 } }

local function i2c()
  local nodes = {}
  for number, name in ipairs { 'bus1', 'bus2' } do
    nodes[name] = {
      about = 'all devices on a bus: bytes at position 65536 address + register are those of the register',
      src = i2c_bus { path = '/dev/i2c-' .. number, reserved = RESERVED[name] }, format = 'u8 byte',
    }
  end
  return nodes
end

-- The keys, and as many others as a user plugs in.
local DEVICES = {
  '/dev/input/by-path/platform-soc@1c00000:gpio-keys-event', '/dev/input/event0', '/dev/input/event1',
  '/dev/input/event2', '/dev/input/event3',
}
local DEVICES_MAX = 16

-- The last word of the path, with _ for what cannot be in a name.
local function node_name(path)
  return (path:match('[^/]*$'):gsub('[^%w_-]', '_'))
end

local function input(entry)
  local nodes = {}
  local function add(path)
    local name = node_name(path)
    if path:sub(1, 1) ~= '/' or not name:find('^%a') or #name > 64 then
      entry:refuse('devices must be paths of input devices such as /dev/input/event4, not ' .. entry.shown(path))
    end
    nodes[name] = {
      about = 'every event of the input device ' .. path:sub(-100),
      src = evdev { path = path, events = true }, format = 'u16 type, u16 code, i32 value, i64 time_us',
    }
  end
  for _, path in ipairs(DEVICES) do add(path) end
  local more = entry:get('devices', {})
  if type(more) ~= 'table' or #more > DEVICES_MAX then
    entry:refuse('devices must be a list of at most ' .. DEVICES_MAX .. ' paths')
  end
  for _, path in ipairs(more) do
    if type(path) ~= 'string' then entry:refuse('devices must be paths, not ' .. entry.shown(path)) end
    add(path)
  end
  return nodes
end

local makers = { i2c = i2c, input = input }

function raw.make(port, entry)
  return { [port] = makers[port](entry) }
end

return raw
