//! Tests of what a converter cannot do: run for ever, take all memory, leave the sandbox.

use super::*;

#[test]
fn endless_converters_are_ended_and_the_next_tuple_is_converted() {
    let bodies = [
        "while ba.get(a, 0) == 1 do end",
        "while ba.get(a, 0) == 1 do pcall(function() while true do end end) end",
        "while ba.get(a, 0) == 1 do xpcall(function() while true do end end, function() while true do end end) end",
        "if ba.get(a, 0) == 1 then coroutine.wrap(function() while true do end end)() end",
        "if ba.get(a, 0) == 1 then local t = {} for i = 1, 1000 do t[i] = i end table.sort(t, function() while true do end end) end",
        "if ba.get(a, 0) == 1 then while true do pcall(string.find, ('x'):rep(1000), '.-.-.-b') end end",
        "if ba.get(a, 0) == 1 then while true do string.gsub('aaaa', 'a', function() return 'b' end) end end",
        "if ba.get(a, 0) == 1 then setmetatable({}, { __index = function(t, k) return t[k + 1] end })[1] = nil local f f = function() return f() end f() end",
    ];
    for body in bodies {
        let (mut vm, stage) = bound(
            &format!("function(_, a, _, b) {body} ba.set(b, 0, 7) end"),
            1,
            1,
        );
        vm.limit(4096, 5_000);
        let mut output = [0];
        for _ in 0..2 {
            let error = vm.convert(stage, &[1], &mut output).unwrap_err();
            let error = error.to_string();
            assert!(
                error.ends_with("time budget spent (5000 us)"),
                "{body}: {error}"
            );
            assert_eq!(
                vm.convert(stage, &[0], &mut output),
                Ok(Conversion::Produced),
                "{body}"
            );
            assert_eq!(output, [7]);
        }
    }
}

#[test]
fn memory_without_bound_is_refused_and_the_next_tuple_is_converted() {
    let bodies = [
        "local t = {} for i = 1, 1e9 do t[i] = i end",
        "local s = 'x' while true do s = s .. s end",
        "local t = {} while true do t = { t } end",
        "local t = {} while true do pcall(function() while true do t = { t } end end) end",
        "local t = {} for i = 1, 1e9 do t[i] = coroutine.create(function() end) end",
        "return ('x'):rep(1e7)",
    ];
    for body in bodies {
        let body = format!("if ba.get(a, 0) == 1 then {body} end");
        let (mut vm, stage) = bound(
            &format!("function(_, a, _, b) {body} ba.set(b, 0, 7) end"),
            1,
            1,
        );
        vm.limit(1024, 50_000);
        let mut output = [0];
        let error = vm.convert(stage, &[1], &mut output).unwrap_err();
        let error = error.to_string();
        assert!(
            error.ends_with("not enough memory") || error.contains("time budget"),
            "{body}: {error}"
        );
        assert!(vm.memory() <= 1024 * 1024);
        assert_eq!(
            vm.convert(stage, &[0], &mut output),
            Ok(Conversion::Produced),
            "{body}"
        );
    }
}

#[test]
fn deep_recursion_of_any_kind_fits_a_small_machine_stack() {
    let bodies = [
        "local function f() return 1 + f() end f()",
        "local function f(g) return pcall(f, g) and 1 end f()",
        "local function f() coroutine.wrap(f)() end f()",
        "local function f() local c = coroutine.create(f) assert(coroutine.resume(c)) end f()",
        "local t = {} local function f() table.sort({1, 2, 3}, function() f() end) end f()",
        "local t = setmetatable({}, { __tostring = function(t) return tostring(t) end }) tostring(t)",
        "local t = setmetatable({}, { __tostring = function(t) return string.format('%s', t) end }) tostring(t)",
        "local function f() string.gsub('a', 'a', f) end f()",
        "local t = setmetatable({}, { __index = function(t, k) return t[k] end }) local x = t[1]",
        "local t = setmetatable({}, { __concat = function(a, b) return a .. b end }) local x = t .. t",
        "local t = setmetatable({}, { __lt = function(a, b) return a < b end }) local x = t < t",
        "local t = setmetatable({}, { __eq = function(a, b) return a == b end }) local x = t == setmetatable({}, getmetatable(t))",
        "local t = setmetatable({}, { __call = function(t) return t() + 1 end }) t()",
        "local function f() load(f) end pcall(f) error('text only')",
        "local s = ('('):rep(1000) .. '1' .. (')'):rep(1000) assert(load('return ' .. s))",
        "local s = ('{'):rep(100000) assert(load('return ' .. s))",
        "('a'):rep(10000):find(('a?'):rep(10000))",
    ];
    let run = move || {
        for body in bodies {
            let (mut vm, stage) = bound(&format!("function(_, a, _, b) {body} end"), 1, 1);
            vm.limit(65_536, 2_000_000);
            // An error or not (pcall swallows its own): the process is still there.
            let _ = vm.convert(stage, &[1], &mut [0]);
        }
    };
    std::thread::Builder::new()
        .stack_size(512 << 10)
        .spawn(run)
        .unwrap()
        .join()
        .unwrap();
}

#[test]
fn the_sandbox_has_no_way_out() {
    for name in [
        "os",
        "io",
        "debug",
        "package",
        "require",
        "module",
        "dofile",
        "loadfile",
        "getfenv",
        "setfenv",
        "newproxy",
        "collectgarbage",
        "gcinfo",
        "ffi",
        "jit",
        "string.dump",
        "string.buffer",
        "_LOADED",
    ] {
        assert_eq!(evaluated(name), "nil", "{name}");
    }
    assert_eq!(evaluated("load('\\27LJ\\2')"), "nil");
    assert_eq!(
        evaluated("select(2, load('\\27LJ\\2', 'x'))"),
        "attempt to load chunk with wrong mode"
    );
    assert_eq!(
        evaluated("select(2, loadstring('\\27LJ\\2', 'x', 'b'))"),
        "attempt to load chunk with wrong mode"
    );
    assert_eq!(
        evaluated("select(2, pcall(load, print))"),
        "load takes the text of a program"
    );
    assert_eq!(evaluated("load('return os')()"), "nil");
    assert_eq!(evaluated("load('return x', 'x', 't', { x = 5 })()"), "5");
    assert_eq!(evaluated("getmetatable(_G)"), "false");
    assert_eq!(evaluated("pcall(setmetatable, _G, {})"), "false");
    assert_eq!(evaluated("getmetatable(ba)"), "false");
    assert_eq!(
        evaluated("('x').find == string.find and getmetatable('').__index == string"),
        "true"
    );
    assert_eq!(evaluated("('x').dump"), "nil");
    assert_eq!(
        evaluated("coroutine.wrap(function() return os end)()"),
        "nil"
    );
    assert_eq!(evaluated("include == nil"), "false");
    let error = evaluated("select(2, pcall(include, 'x'))");
    assert_eq!(
        error,
        "'x' was not included when the configuration was loaded"
    );
}
