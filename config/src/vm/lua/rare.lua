-- Globals that most converters do without; gives the one that is asked for.
-- log(text) writes to the log; chunk(name) gives the function of an included file, or nil and the reason.
local name, raw, log, chunk = ...
local error, pcall, select, tostring, type = raw.error, raw.pcall, raw.select, raw.tostring, raw.type
local load = raw.load

local rare = {}

function rare.include(file)
  local run, problem = chunk(file)
  if not run then error(problem, 2) end
  return run()
end

function rare.load(text, title, _, env)
  if type(text) ~= 'string' then error('load takes the text of a program', 2) end
  if type(title) ~= 'string' then title = '=load' end
  if env == nil then return load(text, title, 't') end
  return load(text, title, 't', env)
end
rare.loadstring = rare.load

function rare.trikfs_log(...)
  local count = select('#', ...)
  local text = tostring((...))
  for i = 2, count do text = text .. '\t' .. tostring((select(i, ...))) end
  log(count > 0 and text or '')
end
rare.print = rare.trikfs_log

-- The real xpcall runs its handler where no hook can end it.
local function handle(handler, ok, ...)
  if ok then return true, ... end
  return false, handler(...)
end

function rare.xpcall(f, handler, ...)
  return handle(handler, pcall(f, ...))
end

return rare[name]
