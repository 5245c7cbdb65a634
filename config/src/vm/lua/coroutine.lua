-- The coroutine library with a limit of nesting: every nested resume takes machine stack.
local coroutine, raw = ...
local create, resume, running = coroutine.create, coroutine.resume, coroutine.running
local error, type = raw.error, raw.type
local DEPTH_MAX = 100

-- How deep each coroutine was resumed; the main program is not in it.
local depths = raw.setmetatable({}, { __mode = 'k' })

local function enter(co)
  local self = running()
  local depth = (self and depths[self] or 0) + 1
  if depth > DEPTH_MAX then return false end
  depths[co] = depth
  return true
end

local function pass(ok, ...)
  if ok then return ... end
  local text = ...
  error(text, type(text) == 'string' and 0 or 1)
end

local function wrap(f)
  local co = create(f)
  return function(...)
    if not enter(co) then error('coroutines are nested too deeply', 2) end
    return pass(resume(co, ...))
  end
end

return {
  create = create, running = running, status = coroutine.status, yield = coroutine.yield, wrap = wrap,
  resume = function(co, ...)
    if type(co) ~= 'thread' then error("bad argument #1 to 'resume' (coroutine expected)", 2) end
    if not enter(co) then return false, 'coroutines are nested too deeply' end
    return resume(co, ...)
  end,
}
