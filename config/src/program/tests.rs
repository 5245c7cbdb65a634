//! Tests of programs and their states: conversions, budgets, memory, the sandbox.

use super::*;
use crate::vm::bytecode::compile;
use crate::vm::persist::keep_pristine;
use std::sync::Mutex;

fn program(source: &str) -> Program {
    let code = compile("@test.lua", source.as_bytes(), false).unwrap();
    let mut state = State::new(LOAD_MEMORY_BYTES, None, None).unwrap();
    keep_pristine(&state).unwrap();
    let ran = state.run(&code, 5_000_000).and_then(|()| state.keep_tree());
    Program::new(
        code,
        BTreeMap::new(),
        ran.is_ok().then_some(state),
        Vec::new(),
    )
}

/// A state with `converter` bound as the one stage of the node `x`.
fn bound(converter: &str, input_size: usize, output_size: usize) -> (Vm, StageId) {
    let source = format!("trikfs = {{ x = {{ src = '/dev/null', converter = {converter} }} }}");
    let mut vm = program(&source).open("x").unwrap();
    let stage = vm
        .bind("x", Direction::Read, 0, input_size, output_size)
        .unwrap();
    (vm, stage)
}

/// Converts one tuple so often that compiled code is covered; all results must be equal.
fn converted(converter: &str, input: &[u8], output_size: usize) -> Result<Vec<u8>, String> {
    let (mut vm, stage) = bound(converter, input.len(), output_size);
    let mut once = || {
        let mut output = vec![0xee; output_size];
        vm.convert(stage, input, &mut output).map(|_| output)
    };
    let first = once();
    for _ in 0..300 {
        assert_eq!(once(), first, "{converter}");
    }
    first.map_err(|fault| fault.to_string())
}

/// The fault of a converter with this body, which has four bytes of input and output.
fn fault(body: &str) -> String {
    converted(
        &format!("function(a_s, a, b_s, b) {body} end"),
        &[1, 2, 3, 4],
        4,
    )
    .unwrap_err()
}

/// A Lua expression in a converter, as text that a fault carries out.
fn evaluated(expression: &str) -> String {
    let (mut vm, stage) = bound(
        &format!("function() error(tostring({expression}), 0) end"),
        4,
        4,
    );
    // What is asked is the value, on an emulated processor too.
    vm.limit(1024, 5_000_000);
    let fault = vm.convert(stage, &[0; 4], &mut [0; 4]).unwrap_err();
    fault.to_string()
}

#[test]
fn the_converter_of_the_thesis_converts() {
    let converter = "function(a_s, a, b_s, b) for i = 0, b_s - 1 do ba.set(b, i, ba.get(a, i) % 10 + (i + 1) + 33) end end";
    assert_eq!(converted(converter, &[0, 19, 255], 3), Ok(vec![34, 44, 41]));
    assert_eq!(converted("id_create(3)", &[7, 8, 9], 3), Ok(vec![7, 8, 9]));
    assert_eq!(converted("id_create(2)", &[7, 8, 9], 3), Ok(vec![7, 8, 0]));
}

#[test]
fn a_converter_says_whether_it_produced() {
    let outcome = |result: &str| {
        let (mut vm, stage) = bound(
            &format!("function(_, a, _, b) ba.set(b, 0, 9) return {result} end"),
            1,
            1,
        );
        let mut output = [5];
        vm.convert(stage, &[1], &mut output)
            .map(|conversion| (conversion, output[0]))
    };
    assert_eq!(outcome(""), Ok((Conversion::Produced, 9)));
    assert_eq!(outcome("nil"), Ok((Conversion::Produced, 9)));
    assert_eq!(outcome("true"), Ok((Conversion::Produced, 9)));
    assert_eq!(outcome("false"), Ok((Conversion::Consumed, 5)));
    assert_eq!(
        outcome("1"),
        Err("the converter returned a number, not true, false or nothing".into())
    );
    assert_eq!(
        outcome("'x'"),
        Err("the converter returned a string, not true, false or nothing".into())
    );
    assert_eq!(
        outcome("{}"),
        Err("the converter returned a table, not true, false or nothing".into())
    );
    assert_eq!(
        outcome("b"),
        Err("the converter returned a table, not true, false or nothing".into())
    );
}

#[test]
fn bytes_outside_an_array_are_a_fault() {
    assert_eq!(
        fault("ba.get(a, 4)"),
        "test.lua:1: position 4 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, -1)"),
        "test.lua:1: position -1 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.set(b, 7, 1)"),
        "test.lua:1: position 7 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, 0.5)"),
        "test.lua:1: position 0.5 is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, 0 / 0)"),
        "test.lua:1: position nan is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, 1e300)"),
        "test.lua:1: position 1e+300 is outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.get(a, 1 / 0)"),
        "test.lua:1: position inf is not a whole number"
    );
    assert_eq!(
        fault("ba.get(a, '0')"),
        "test.lua:1: a position is a number, not a string"
    );
    assert_eq!(
        fault("ba.get(a)"),
        "test.lua:1: a position is a number, not a nil"
    );
    assert_eq!(
        fault("ba.get(true, 0)"),
        "test.lua:1: not a byte array: true"
    );
    assert_eq!(fault("ba.get(nil, 0)"), "test.lua:1: not a byte array: nil");
    assert_eq!(fault("ba.len(7)"), "test.lua:1: not a byte array: 7");
    assert_eq!(
        fault("ba.i32(a, 1)"),
        "test.lua:1: 4 bytes at position 1 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.i16_be(a, -1)"),
        "test.lua:1: 2 bytes at position -1 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.f64(b, 0, 1)"),
        "test.lua:1: 8 bytes at position 0 are outside the array of 4 bytes"
    );
    assert_eq!(
        fault("ba.u8(b, 4, 1)"),
        "test.lua:1: 1 bytes at position 4 are outside the array of 4 bytes"
    );
}

#[test]
fn a_value_that_is_no_number_is_a_fault() {
    assert_eq!(
        fault("ba.set(b, 0, 0 / 0)"),
        "test.lua:1: the value nan is not finite"
    );
    assert_eq!(
        fault("ba.set(b, 0, 1 / 0)"),
        "test.lua:1: the value inf is not finite"
    );
    assert_eq!(
        fault("ba.set(b, 0)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.set(b, 0, '1')"),
        "test.lua:1: a value is a number, not a string"
    );
    assert_eq!(
        fault("ba.i16(b, 0, nil)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.f32(b, 0, nil)"),
        "test.lua:1: a value is a number, not a nil"
    );
    assert_eq!(
        fault("ba.u32(b, 0, -1 / 0)"),
        "test.lua:1: the value -inf is not finite"
    );
}

#[test]
fn set_takes_the_low_bits() {
    let set = |value: &str| {
        converted(
            &format!("function(_, a, _, b) ba.set(b, 0, {value}) end"),
            &[0],
            1,
        )
        .unwrap()[0]
    };
    assert_eq!(set("256"), 0);
    assert_eq!(set("-1"), 255);
    assert_eq!(set("3.7"), 3);
    assert_eq!(set("-3.7"), 253);
    assert_eq!(set("2 ^ 31 + 5"), 5);
    assert_eq!(set("2 ^ 53 + 2"), 2);
    assert_eq!(set("-2 ^ 31 - 1"), 255);
    let typed =
        |call: &str| converted(&format!("function(_, a, _, b) ba.{call} end"), &[0; 4], 4).unwrap();
    assert_eq!(typed("u32(b, 0, 2 ^ 32 - 1)"), [255; 4]);
    assert_eq!(typed("u32(b, 0, -1)"), [255; 4]);
    assert_eq!(typed("i32(b, 0, 2 ^ 31)"), [0, 0, 0, 0x80]);
    assert_eq!(typed("i16_be(b, 1, 0x12345)"), [0, 0x23, 0x45, 0]);
    assert_eq!(typed("u8(b, 3, 511)"), [0, 0, 0, 255]);
}

#[test]
fn typed_accessors_read_and_write_both_byte_orders() {
    let bytes: Vec<u8> = (0x81..0x89).collect();
    for (name, value) in [
        ("i8", -127.0),
        ("u8", 129.0),
        ("i8_be", -127.0),
        ("i16", f64::from(i16::from_le_bytes([0x81, 0x82]))),
        ("i16_be", f64::from(i16::from_be_bytes([0x81, 0x82]))),
        ("u16", f64::from(u16::from_le_bytes([0x81, 0x82]))),
        ("u16_be", f64::from(u16::from_be_bytes([0x81, 0x82]))),
        (
            "i32",
            f64::from(i32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "i32_be",
            f64::from(i32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "u32",
            f64::from(u32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "u32_be",
            f64::from(u32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f32",
            f64::from(f32::from_le_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f32_be",
            f64::from(f32::from_be_bytes([0x81, 0x82, 0x83, 0x84])),
        ),
        (
            "f64",
            f64::from_le_bytes([0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88]),
        ),
        (
            "f64_be",
            f64::from_be_bytes([0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88]),
        ),
    ] {
        let copy = format!(
            "function(_, a, _, b) local v = ba.{name}(a, 0) ba.{name}(b, 0, v) ba.f64(b, 8, v) end"
        );
        let output = converted(&copy, &bytes, 16).unwrap();
        let size = output.iter().take(8).take_while(|byte| **byte != 0).count();
        assert_eq!(output[..size], bytes[..size], "{name}");
        assert_eq!(
            f64::from_le_bytes(output[8..].try_into().unwrap()),
            value,
            "{name}"
        );
    }
    assert_eq!(evaluated("ba.i15"), "nil");
    assert_eq!(evaluated("rawget(ba, 'i16') or type(ba.i16)"), "function");
}

#[test]
fn no_bits_of_a_float_become_anything_but_a_number() {
    // In a loop, so that compiled code is seen as well; a table, a string or nil would be told by `type`.
    let is_number = |name: &str, bytes: &[u8]| {
        let look = format!(
            "function(_, a, _, b) for i = 1, 300 do local v = ba.{name}(a, 0)
               if type(v) ~= 'number' or v == v then error('it is a ' .. type(v), 0) end end ba.u8(b, 0, 1) end"
        );
        assert_eq!(converted(&look, bytes, 1), Ok(vec![1]), "{name} {bytes:x?}");
    };
    for low in [0_u64, 1, 0x4141_4141_4141, 0xffff_ffff_ffff] {
        for high in 0xfff8..=0xffff_u64 {
            let bits = high << 48 | low;
            is_number("f64", &bits.to_le_bytes());
            is_number("f64_be", &bits.to_be_bytes());
        }
        for high in (0xff81..=0xffff_u32).step_by(9).chain([0xffff, 0x7fc1]) {
            let bits = high << 16 | low as u32 & 0xffff;
            is_number("f32", &bits.to_le_bytes());
            if high & 3 == 0 {
                is_number("f32_be", &bits.to_be_bytes());
            }
        }
    }
}

#[test]
fn two_arrays_of_a_stage_and_two_stages_do_not_mix() {
    let source = "trikfs = { x = { src = '/dev/null', converter = {
        function(n, a, m, b) for i = 0, n - 1 do ba.set(b, i, ba.get(a, i) + 1) end end,
        { converter = function(n, a, m, b) ba.set(b, 0, ba.get(a, 0) * 2) end, output_tuple_size = 1 } } } }";
    let mut vm = program(source).open("x").unwrap();
    let first = vm.bind("x", Direction::Read, 0, 2, 2).unwrap();
    let second = vm.bind("x", Direction::Write, 1, 2, 1).unwrap();
    let (mut middle, mut output) = ([0; 2], [0]);
    for i in 0..200 {
        vm.convert(first, &[i, i], &mut middle).unwrap();
        assert_eq!(middle, [i + 1, i + 1]);
        vm.convert(second, &middle, &mut output).unwrap();
        assert_eq!(output, [(i + 1).wrapping_mul(2)]);
    }
    let error = vm.convert(first, &[1], &mut [0; 2]).unwrap_err();
    let error = error.to_string();
    assert_eq!(error, "the stage takes 2 bytes and gives 2, not 1 and 2");
}

#[test]
fn a_converter_is_found_through_groups_lists_and_attributes() {
    let source = "local function f(x) return function(n, a, m, b) ba.set(b, 0, x) end end
        trikfs = { motors = { left = { src = '/dev/null', converter = f(1), write_converter = { f(2), f(3) },
        attributes = { speed = { src = '/dev/null', converter = { converter = f(4) } } } } } }";
    let program = program(source);
    let at = |node: &str, direction, position| {
        let mut vm = program.open(node).unwrap();
        let bound = vm.bind(node, direction, position, 1, 1);
        let stage = bound.map_err(|error| error.to_string())?;
        let mut output = [0];
        let done = vm.convert(stage, &[0], &mut output);
        // A failed search leaves the state as it was.
        vm.bind("other", direction, 0, 1, 1).unwrap_err();
        done.map(|_| output[0]).map_err(|fault| fault.to_string())
    };
    assert_eq!(at("motors/left", Direction::Read, 0), Ok(1));
    assert_eq!(at("motors/left", Direction::Write, 0), Ok(2));
    assert_eq!(at("motors/left", Direction::Write, 1), Ok(3));
    assert_eq!(at("motors/left/speed", Direction::Read, 0), Ok(4));
    assert_eq!(at("motors/left/speed", Direction::Write, 0), Ok(4));
    let missing = "motors/right: the program made no such node this time";
    assert_eq!(at("motors/right", Direction::Read, 0), Err(missing.into()));
    let missing = "motors/left: the program made no lua converter here this time";
    assert_eq!(at("motors/left", Direction::Write, 7), Err(missing.into()));
}

#[test]
fn states_share_nothing() {
    let source = "local n = 0 trikfs = { x = { src = '/dev/null', converter = function(_, a, _, b) n = n + 1 ba.set(b, 0, n) end } }";
    let program = program(source);
    let mut ends = Vec::new();
    for rounds in [1, 3] {
        let mut vm = program.open("x").unwrap();
        let stage = vm.bind("x", Direction::Read, 0, 1, 1).unwrap();
        let mut output = [0];
        for _ in 0..rounds {
            vm.convert(stage, &[0], &mut output).unwrap();
        }
        ends.push(output[0]);
    }
    assert_eq!(ends, [1, 3]);
}

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

#[test]
fn a_byte_array_is_opaque() {
    assert_eq!(
        fault("a[0] = 1"),
        "test.lua:1: use ba.set to write a byte array"
    );
    assert_eq!(fault("error(tostring(getmetatable(a)), 0)"), "false");
    assert_eq!(
        fault("setmetatable(a, {})"),
        "test.lua:1: cannot change a protected metatable"
    );
    assert_eq!(fault("error(tostring(next(a)), 0)"), "nil");
    assert_eq!(fault("error(ba.len(a) + #a, 0)"), "4");
}

#[test]
fn string_functions_do_what_the_manual_says() {
    for (expression, value) in [
        ("('abc'):find('b', 1, true)", "2"),
        ("('a.c'):find('.', 1, true)", "2"),
        ("('abc'):find('b()')", "2"),
        ("select(3, ('abc'):find('(b)'))", "b"),
        ("('abc'):find('x')", "nil"),
        ("('abc'):find('', 10)", "nil"),
        ("('abc'):find('', -10)", "1"),
        ("('abc'):match('^(a)(b)')", "a"),
        ("('x = 12'):match('%d+')", "12"),
        ("('abc'):gsub('%w', '%0%0')", "aabbcc"),
        ("('abc'):gsub('%w', '%%%1')", "%a%b%c"),
        ("('hello world'):gsub('o', '0', 1)", "hell0 world"),
        ("select(2, ('hello world'):gsub('o', '0'))", "2"),
        ("('abc'):gsub('', '-')", "-a-b-c-"),
        ("('abc'):gsub('^a', 'x')", "xbc"),
        ("('aaa'):gsub('^a', 'x')", "xaa"),
        ("('$name is'):gsub('%$(%w+)', { name = 'x' })", "x is"),
        ("('abc'):gsub('b', function() return nil end)", "abc"),
        (
            "('abc'):gsub('(a)(b)', function(x, y) return y .. x end)",
            "bac",
        ),
        ("('abc'):gsub('%w', 1)", "111"),
        ("('abc def'):gsub('%w*', 'x')", "xx xx"),
        (
            "table.concat((function() local t = {} for k, v in ('a=1, b=2'):gmatch('(%w)=(%w)') do t[#t + 1] = k .. v end return t end)(), ';')",
            "a1;b2",
        ),
        (
            "table.concat((function() local t = {} for w in ('ab cd'):gmatch('%a*') do t[#t + 1] = '<' .. w .. '>' end return t end)())",
            "<ab><><cd><>",
        ),
        ("('ab'):rep(3)", "ababab"),
        ("('ab'):rep(3, '-')", "ab-ab-ab"),
        ("('ab'):rep(-1)", ""),
        (
            "string.format('%5.1f|%d|%s|%q', 1.25, 7, true, 'x')",
            "  1.2|7|true|\"x\"",
        ),
        ("('x'):upper() .. #'abc' .. ('abc'):byte(2)", "X398"),
    ] {
        assert_eq!(
            evaluated(&format!("(({expression}))")),
            value,
            "{expression}"
        );
    }
}

#[test]
fn string_functions_name_what_they_refuse() {
    assert_eq!(
        fault("('x'):find('[')"),
        "test.lua:1: malformed pattern (missing ']')"
    );
    assert_eq!(
        fault("('x'):gsub('(', '')"),
        "test.lua:1: unfinished capture"
    );
    assert_eq!(
        fault("('x'):gsub('x', '%2')"),
        "test.lua:1: invalid capture index"
    );
    assert_eq!(
        fault("for w in ('x'):gmatch('(') do end"),
        "test.lua:1: unfinished capture"
    );
    assert_eq!(
        fault("('x'):rep(1e9)"),
        "test.lua:1: a string of 1000000000 bytes is too long"
    );
    assert_eq!(
        fault("('a'):rep(1e5):find(('.-'):rep(20) .. 'b')"),
        "test.lua:1: pattern match takes too long"
    );
    assert_eq!(
        fault("string.find({}, 'x')"),
        "test.lua:1: bad argument #1 to 'find' (string expected, got table)"
    );
}

#[test]
fn table_functions_do_what_the_manual_says() {
    for (expression, value) in [
        (
            "(function() local t = {3, 1, 2, 5, 4} table.sort(t) return table.concat(t) end)()",
            "12345",
        ),
        (
            "(function() local t = {3, 1, 2} table.sort(t, function(a, b) return a > b end) return table.concat(t) end)()",
            "321",
        ),
        (
            "(function() local t = {'b', 'a'} table.sort(t) return table.concat(t) end)()",
            "ab",
        ),
        (
            "(function() local t = {} table.sort(t) return #t end)()",
            "0",
        ),
        (
            "(function() local t = {} for i = 1, 1000 do t[i] = (i * 7919) % 1009 end table.sort(t) for i = 2, 1000 do if t[i - 1] > t[i] then return i end end return 'sorted' end)()",
            "sorted",
        ),
        (
            "(function() local t = {1, 3} table.insert(t, 2, 2) table.insert(t, 4) return table.concat(t) end)()",
            "1234",
        ),
        (
            "(function() local t = {1, 2, 3} table.remove(t, 1) return table.concat(t) end)()",
            "23",
        ),
        ("math.floor(2.5) + bit.band(6, 3)", "4"),
        ("unpack({1, 2})", "1"),
        (
            "(function() local c = coroutine.wrap(function(x) local y = coroutine.yield(x + 1) return y * 2 end) c(1) return c(10) end)()",
            "20",
        ),
        (
            "select(2, xpcall(function() error('x', 0) end, function(m) return m .. 'y' end))",
            "xy",
        ),
    ] {
        assert_eq!(evaluated(&format!("({expression})")), value, "{expression}");
    }
    let error = "test.lua:1: bad argument #2 to 'insert' (position out of bounds)";
    assert_eq!(fault("table.insert({}, -2147483647, 1)"), error);
    assert_eq!(fault("table.insert({}, '-2147483647', 1)"), error);
}

#[test]
fn what_is_logged_reaches_the_sink_of_the_state() {
    let (mut vm, stage) = bound(
        "function(_, a) trikfs_log('byte', ba.get(a, 0), nil) print() end",
        1,
        1,
    );
    vm.convert(stage, &[5], &mut [0]).unwrap();
    let lines: Arc<Mutex<Vec<String>>> = Arc::default();
    let sink = Arc::clone(&lines);
    vm.set_log(Arc::new(move |line| {
        sink.lock().unwrap().push(line.to_owned())
    }));
    vm.convert(stage, &[6], &mut [0]).unwrap();
    assert_eq!(*lines.lock().unwrap(), ["byte\t6\tnil", ""]);
}

#[test]
fn a_log_that_panics_costs_nothing() {
    let (mut vm, stage) = bound("function() trikfs_log(('x'):rep(5000)) end", 1, 1);
    // Reporting the panic takes its time.
    vm.limit(1024, 5_000_000);
    let longest = Arc::new(Mutex::new(0));
    let seen = Arc::clone(&longest);
    vm.set_log(Arc::new(move |line| {
        *seen.lock().unwrap() = line.len();
        panic!("on purpose, in a test");
    }));
    assert_eq!(vm.convert(stage, &[6], &mut [0]), Ok(Conversion::Produced));
    assert_eq!(*longest.lock().unwrap(), crate::limits::LOG_LINE_BYTES_MAX);
}

#[test]
fn params_can_be_changed_while_the_converter_lives() {
    let source = "local own = { gain = 2 }
        trikfs = { x = { src = '/dev/null', params = own, converter = function(_, a, _, b)
          ba.set(b, 0, own.gain) ba.set(b, 1, params.gain or 0) end } }";
    let mut vm = program(source).open("x").unwrap();
    let stage = vm.bind("x", Direction::Read, 0, 1, 2).unwrap();
    let mut output = [0; 2];
    vm.convert(stage, &[0], &mut output).unwrap();
    assert_eq!(output, [2, 0]);
    vm.set_params("x", &BTreeMap::from([("gain".to_owned(), 5.0)]))
        .unwrap();
    vm.convert(stage, &[0], &mut output).unwrap();
    assert_eq!(output, [5, 5]);
}

#[test]
fn many_tuples_are_converted_until_one_fails() {
    let converter = "function(_, a, _, b)
        local v = ba.get(a, 0) if v == 0 then error('zero', 0) end if v % 2 == 1 then return false end ba.set(b, 0, v) end";
    let (mut vm, stage) = bound(converter, 1, 1);
    let mut output = [0xee; 4];
    assert_eq!(
        vm.convert_many(stage, &[2, 3, 4, 5], &mut output),
        (4, 2, None)
    );
    assert_eq!(output, [2, 4, 0xee, 0xee]);
    assert_eq!(
        vm.convert_many(stage, &[2, 3, 0, 4], &mut output),
        (3, 1, Some("zero".into()))
    );
    assert_eq!(
        vm.convert_many(stage, &[2, 4, 6], &mut output[..2]),
        (2, 2, None)
    );
    assert_eq!(vm.convert_many(stage, &[], &mut output), (0, 0, None));
}

#[test]
fn faults_of_any_shape_have_a_text() {
    assert_eq!(fault("error('plain', 0)"), "plain");
    assert_eq!(fault("error('here')"), "test.lua:1: here");
    assert_eq!(fault("error({})"), "the error is not a text but a table");
    assert_eq!(fault("error()"), "the error is not a text but a nil");
    assert_eq!(fault("error(7, 0)"), "7");
    assert_eq!(
        fault("local x = nil + 1"),
        "test.lua:1: attempt to perform arithmetic on a nil value"
    );
    assert_eq!(
        fault("nothing()"),
        "test.lua:1: attempt to call global 'nothing' (a nil value)"
    );
    assert!(fault("error(('x'):rep(100000), 0)").len() <= crate::limits::LOG_LINE_BYTES_MAX);
}

#[test]
fn a_state_can_move_between_threads() {
    let (mut vm, stage) = bound(
        "function(_, a, _, b) while ba.get(a, 0) == 1 do end ba.set(b, 0, 3) end",
        1,
        1,
    );
    vm.limit(1024, 3_000);
    for _ in 0..3 {
        vm = std::thread::spawn(move || {
            assert!(
                vm.convert(stage, &[1], &mut [0])
                    .unwrap_err()
                    .text()
                    .contains("time budget spent")
            );
            assert_eq!(vm.convert(stage, &[0], &mut [0]), Ok(Conversion::Produced));
            vm
        })
        .join()
        .unwrap();
    }
}

#[test]
fn a_program_that_fails_this_time_is_an_error() {
    let program = program("local n = nil\nerror('no luck')");
    assert_eq!(
        program.open("x").unwrap_err(),
        Error::Script("test.lua:2: no luck".to_owned())
    );
}

#[test]
fn a_state_that_converts_a_lot_is_compiled_and_made_smaller() {
    let (mut vm, stage) = bound("function(_, a, _, b) ba.set(b, 0, ba.get(a, 0)) end", 1, 1);
    let cold = vm.memory();
    for _ in 0..8 {
        vm.convert(stage, &[1], &mut [0]).unwrap();
    }
    // Starting the compiler ends with a collection; without it the libraries that it needs would have made it grow.
    assert!(vm.memory() < cold, "{} bytes, {cold} before", vm.memory());
    for _ in 0..1000 {
        vm.convert(stage, &[1], &mut [0]).unwrap();
    }
    assert!(vm.memory() < 64 << 10, "{} bytes", vm.memory());
}

#[test]
fn of_the_tree_remains_the_way_to_the_own_node() {
    let source = "local function node(text) return { src = '/dev/null', params = { gain = 2 },
        converter = function(a_s, a, b_s, b) return text ~= nil end } end
      trikfs = { other = node(('x'):rep(100000)), group = { second = node(('y'):rep(100000)), inner = { x = {
        src = '/dev/null', params = { gain = 2 }, attributes = { extra = {
          src = '/dev/null', params = { gain = 3 },
          converter = function(a_s, a, b_s, b)
            local names = ''
            for name in pairs(trikfs) do names = names .. name .. ' ' end
            for name in pairs(trikfs.group) do names = names .. name .. ' ' end
            for name in pairs(trikfs.group.inner) do names = names .. name .. ' ' end
            error(names .. trikfs.group.inner.x.attributes.extra.params.gain, 0)
          end } } } } } }";
    let (node, direction) = ("group/inner/x/extra", Direction::Read);
    let program = program(source);
    let copied = program.open(node).unwrap();
    let mut anew = program.run_anew().unwrap();
    let before = anew.memory();
    anew.stages.keep_only(node).unwrap();
    anew.stages.state().collect().unwrap();
    for mut vm in [copied, anew] {
        assert!(vm.memory() + 200_000 < before, "{} {before}", vm.memory());
        let stage = vm.bind(node, direction, 0, 4, 4).unwrap();
        let mut told = || {
            let fault = vm.convert(stage, &[0; 4], &mut [0; 4]).unwrap_err();
            fault.to_string()
        };
        assert_eq!(told(), "group inner x 3");
        let params = BTreeMap::from([("gain".to_owned(), 7.0)]);
        vm.set_params(node, &params).unwrap();
        let mut told = || {
            let fault = vm.convert(stage, &[0; 4], &mut [0; 4]).unwrap_err();
            fault.to_string()
        };
        assert_eq!(told(), "group inner x 7");
        // Another node is not there any more, and that is an error and no crash.
        vm.bind("other", direction, 0, 4, 4).unwrap_err();
    }
    let mut absent = program.open("absent/node").unwrap();
    absent.bind(node, direction, 0, 4, 4).unwrap_err();
}

#[test]
fn a_state_keeps_only_the_filters_that_it_uses() {
    let memory = |source: &str| program(source).open("x").unwrap().memory();
    let none = memory("trikfs = {}");
    let one = memory("trikfs = { x = { src = '/dev/null', converter = filter.median3{} } }");
    let all = "local kept, names = {}, { 'identity', 'median3', 'moving_average', 'low_pass', 'scale', 'inverse',
        'dead_band', 'rate', 'debounce', 'hysteresis', 'kalman', 'complementary', 'pid', 'speed_hold' }
      for _, name in ipairs(names) do kept[name] = filter[name] end
      assert(filter.pid == kept.pid)
      trikfs = { x = { src = '/dev/null', converter = function() return kept ~= nil end } }";
    assert!(2 * (one - none) < memory(all) - none, "{none} {one}");
}
