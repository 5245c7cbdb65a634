//! Configurations that somebody hostile would write: refused in bounded time and memory, without a crash.

use crate::program;
use harness::wait::LIFE;
use harness::{Board, Output, tools};
use std::process::Command;

/// Seconds of processor time that a check may take: 5 are for the configuration.
const PROCESSOR_S: u32 = 20;

#[test]
fn each_is_refused_with_one_place_and_reason() {
    let zero = "{ src = '/dev/zero', input_tuple_size = 1 }";
    let cases: Vec<Vec<u8>> = [
        "while true do end".to_owned(),
        "local function f() return pcall(f) end while true do f() end".to_owned(),
        "repeat until false".to_owned(),
        "local t = {} while true do t[#t + 1] = {} end".to_owned(),
        "local s = 'x' while true do s = s .. s end".to_owned(),
        "string.rep('x', 1e10)".to_owned(),
        "('x'):rep(1e7):find(('x*'):rep(100) .. 'y')".to_owned(),
        "string.format('%1000000000d', 1)".to_owned(),
        "trikfs = setmetatable({}, { __index = function() while true do end end, __pairs = error }) x.y = 1".to_owned(),
        "trikfs = {} trikfs.a = trikfs".to_owned(),
        "local t = {} for i = 1, 100 do t = { a = t } end trikfs = t trikfs.b = 5".to_owned(),
        "trikfs = { a = { src = {}, input_tuple_size = 1 } }".to_owned(),
        "trikfs = { a = { src = '', input_tuple_size = 1 } }".to_owned(),
        "trikfs = { a = { src = 'a\\0b', input_tuple_size = 1 } }".to_owned(),
        format!("trikfs = {{ [''] = {zero} }}"),
        format!("trikfs = {{ ['.'] = {zero} }}"),
        format!("trikfs = {{ ['..'] = {zero} }}"),
        format!("trikfs = {{ ['a/b'] = {zero} }}"),
        format!("trikfs = {{ ['a\\nb'] = {zero} }}"),
        format!("trikfs = {{ ['\\255'] = {zero} }}"),
        format!("trikfs = {{ [('x'):rep(256)] = {zero} }}"),
        format!("trikfs = {{ [1] = {zero} }}"),
        format!("trikfs = {{ [true] = {zero} }}"),
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = 1e300 } }".to_owned(),
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = -1 } }".to_owned(),
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = 0 / 0 } }".to_owned(),
        "trikfs = { a = { src = '/dev/zero', input_tuple_size = '4' } }".to_owned(),
        "error(setmetatable({}, { __tostring = function() while true do end end }))".to_owned(),
        "error()".to_owned(),
        "include('../../etc/passwd')".to_owned(),
        "include('/etc/passwd')".to_owned(),
        "local t = {} for i = 1, 70 do t[i] = '/dev/zero' end trikfs = { a = { src = t, input_tuple_size = 1 } }".to_owned(),
        "local t = {} for i = 1, 17 do t[i] = id_create(1) end trikfs = { a = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = t } }".to_owned(),
        "x = load('return') and load(('('):rep(100000))()".to_owned(),
        format!("x = {}1{}", "(".repeat(100_000), ")".repeat(100_000)),
        format!("x = {}", "{".repeat(300_000)),
        "local a = ".repeat(50_000),
        "\u{1b}LJ\u{2}\n".to_owned(),
        "#!/bin/sh\nexit".to_owned(),
        String::new(),
    ]
    .into_iter()
    .map(String::into_bytes)
    .chain([vec![0; 1000], vec![0xff; 1000], b"trikfs = {}\0".to_vec(), (0..=255).collect()])
    .collect();
    let board = Board::new();
    std::thread::scope(|scope| {
        // Two at a time: each may use up its time limit.
        for half in cases.chunks(cases.len().div_ceil(2)) {
            let board = &board;
            scope.spawn(move || half.iter().for_each(|config| refused(board, config)));
        }
    });
}

/// Checks a configuration. What takes more than its processor time is killed, however busy the machine is; the clock only
/// ends what waits for ever.
fn check(board: &Board, name: &str) -> Output {
    let limited = format!("ulimit -t {PROCESSOR_S}; exec \"$@\"");
    let mut command = Command::new("sh");
    command
        .args(["-c", &limited, "sh", program(), "check", name])
        .current_dir(board.dir());
    tools::run_within(&mut command, b"", LIFE)
}

fn refused(board: &Board, config: &[u8]) {
    let name = format!("{:?}.lua", std::thread::current().id());
    board.file(&name, config);
    let shown = String::from_utf8_lossy(&config[..config.len().min(100)]);
    let output = check(board, &name);
    assert_eq!(
        output.code(),
        1,
        "{shown}\n{}{}",
        output.stdout,
        output.stderr
    );
    let rest = output
        .stderr
        .strip_prefix(&format!("{name}:"))
        .unwrap_or_else(|| panic!("{shown}\n{}", output.stderr));
    let line: String = rest.chars().take_while(char::is_ascii_digit).collect();
    assert!(line.parse::<u32>().is_ok(), "{shown}\n{}", output.stderr);
    assert!(
        output.stderr.len() < 10_000,
        "{shown}\n{}",
        output.stderr.len()
    );
}
