-- The robot for generated Lua: reads and writes of files are lines to the test, which holds the stand-in.

local function say(...)
  local words = { ... }
  for index, word in ipairs(words) do
    words[index] = tostring(word):gsub("\\", "\\\\"):gsub("\t", "\\t"):gsub("\n", "\\n")
  end
  io.stdout:write(table.concat(words, "\t"), "\n")
  io.stdout:flush()
end

local function ask(...)
  say(...)
  local line = io.stdin:read("*l")
  if not line or line == "quit" then os.exit(0) end
  return line
end

-- What the program may not define itself.
local hooks = {
  writeFile = function(name, text) say("write", name, text) end,
  readFile = function(name) return ask("read", name) end,
  sleep = function(ms) ask("wait", 0, ms) end,
  milliseconds = function() return tonumber(ask("time")) end,
  random = function(low, high) return tonumber(ask("random", low, high)) end,
  append = function(name, text) say("append", name, text) end,
  removeFile = function(name) say("remove", name) end,
  system = function(command) say("system", command) end,
  say_text = function(text) say("print", text) end,
  label = function(text, x, y, size) say("label", x, y, size, text) end,
}
setmetatable(_G, { __newindex = function(globals, name, value) rawset(globals, name, hooks[name] or value) end })

local file = arg[1]
arg = nil
dofile(file)
ask("end", 0)
