-- Digests the functions of a configuration: equal digests mean that the functions do the same with the same.
--
-- functions: the list; globals: the program's; pristine: what the globals held before it ran, by name; salt: what changes
-- with every change of the program's text. debug and constant(f, i) look into functions, digest(text) gives 16 bytes.
-- Gives the digests one after the other.
local functions, globals, pristine, salt, raw, string, debug, constant, digest, table = ...
local error, next, pcall, rawget, tostring, type = raw.error, raw.next, raw.pcall, raw.rawget, raw.tostring, raw.type
local getupvalue = debug.getupvalue
local dump, format, match, concat, sort = raw.dump or string.dump, string.format, string.match, table.concat, table.sort

-- What is ours, by name: the globals of the beginning and those that are made on first use.
local known = {}
for name, value in next, pristine do known[value] = name end
for name, value in next, raw.late do known[value] = name end

-- Bytes that one function may lead to; beyond that any change of the program counts as a change of the function.
local SIZE_MAX = 4194304

local function describe(root)
  local out, size, seen, count = {}, 0, {}, 0
  local value

  local function put(text)
    size = size + #text
    if size > SIZE_MAX then error('too much', 0) end
    out[#out + 1] = text
  end

  -- Globals of the program that the code names, as far as they are not ours.
  local function names(prototype)
    local i = -1
    while true do
      local k = constant(prototype, i)
      if k == nil then return end
      if type(k) == 'proto' then
        names(k)
      elseif type(k) == 'string' then
        local global = rawget(globals, k)
        if global ~= nil and known[global] ~= k then
          put('g' .. #k .. ':' .. k)
          value(global)
        end
      end
      i = i - 1
    end
  end

  local function lua_function(f)
    local ok, code = pcall(dump, f, 'sd')
    if not ok then return put('c' .. (match(tostring(f), 'builtin#%d+') or '')) end
    put('f' .. #code .. ':' .. code)
    names(f)
    local i = 1
    while true do
      local name, upvalue = getupvalue(f, i)
      if name == nil then return end
      put('u')
      value(upvalue)
      i = i + 1
    end
  end

  local function table_entries(t)
    local keys, others, map = {}, 0, {}
    for key in next, t do
      local kind = type(key)
      if kind == 'string' or kind == 'number' or kind == 'boolean' then
        local text = kind .. tostring(key)
        keys[#keys + 1], map[text] = text, key
      else
        others = others + 1
      end
    end
    sort(keys)
    put('t' .. #keys .. ',' .. others .. ':')
    for i = 1, #keys do
      put(#keys[i] .. ':' .. keys[i])
      value(rawget(t, map[keys[i]]))
    end
    value(raw.getmetatable(t))
  end

  function value(v)
    local kind = type(v)
    if kind == 'number' then return put('n' .. format('%.17g', v) .. ';') end
    if kind == 'string' then return put('s' .. #v .. ':' .. v) end
    if kind ~= 'function' and kind ~= 'table' then return put('o' .. kind .. (kind == 'boolean' and tostring(v) or '')) end
    if known[v] then return put('p' .. known[v] .. ';') end
    if seen[v] then return put('@' .. seen[v] .. ';') end
    count = count + 1
    seen[v] = count
    if kind == 'function' then return lua_function(v) end
    return table_entries(v)
  end

  local ok = pcall(value, root)
  return digest(concat(out) .. (ok and '' or salt))
end

local digests = {}
for i = 1, #functions do digests[i] = describe(functions[i]) end
return concat(digests)
