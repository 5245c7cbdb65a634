//! Tests of programs and their states: conversions, faults, logs, what a state keeps; helpers for the subjects below.

mod accessors;
mod library;
mod sandbox;

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
fn a_node_may_be_called_as_the_key_of_a_source() {
    let source = "local function f(n) return function(_, _, _, b) ba.set(b, 0, n) end end
        local function node(n) return { src = '/dev/null', converter = f(n) } end
        trikfs = { a = node(1), src = node(2), group = { b = node(3), src = node(4) } }";
    let program = program(source);
    for (node, value) in [("a", 1), ("src", 2), ("group/b", 3), ("group/src", 4)] {
        let mut vm = program.open(node).unwrap();
        let stage = vm.bind(node, Direction::Read, 0, 1, 1).unwrap();
        let mut output = [0];
        vm.convert(stage, &[0], &mut output).unwrap();
        assert_eq!(output, [value], "{node}");
    }
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
