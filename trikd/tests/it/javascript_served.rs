//! JavaScript under a real daemon and with streams: direct texts, events, stop, hostile programs, what documents say.

use crate::javascript::run;
use crate::rig::{Client, robot};
use harness::documents::examples;
use harness::processes;
use harness::put;
use nix::sys::stat::Mode;
use proptest::prelude::*;
use proptest::test_runner::Config;
use std::fs;
use std::io::{Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

fn start(client: &mut Client, name: &str, text: &str) {
    client.send(&format!("file:{name}:{text}"));
    client.send(&format!("run:{name}"));
    client.expect(&format!("info: {name} has started"));
}

#[test]
fn a_program_prints_and_fails_as_desktop_programs_expect() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    start(
        &mut client,
        "a.js",
        "var main = function() {\n  print('in main ', brick.sensor(A1).read(), [1, [2]]);\n  foo;\n}",
    );
    client.expect("print: in main 27[1, [2]]\n");
    let told = client.until("error: ");
    assert_eq!(
        told,
        "error: Line 3: ReferenceError: Can't find variable: foo\nmain() at 3\n<global>() at 5"
    );
    assert!(robot.has_rested());
    client.send("directScript:print(brick.motor('Z9')); brick.motor('Z9').setPower(1)");
    assert_eq!(client.until("print: "), "print: null\n");
    assert!(
        client
            .until("error: ")
            .starts_with("error: Line 1: TypeError: Result of expression 'brick.motor('Z9')' [null] is not an object.")
    );
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn direct_texts_share_variables_and_survive_failures_and_timers_run_between_them() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send("direct:var x = 1;");
    client.send("direct:print(x + 1)");
    assert_eq!(client.until("print: "), "print: 2\n");
    client.send("direct:x.y.z");
    assert_eq!(
        client.until("error: "),
        "error: TypeError: Result of expression 'x.y' [undefined] is not an object."
    );
    client.send("direct:this is wrong");
    let told = client.until("error: ");
    assert!(
        told.starts_with("error: SyntaxError: Parse error"),
        "{told}"
    );
    client.send("direct:print(x); var t = script.timer(1); t.singleShot = true; t.timeout.connect(function() { this_fails_once; })");
    assert_eq!(client.until("print: "), "print: 1\n");
    assert_eq!(
        client.until("error: "),
        "error: ReferenceError: Can't find variable: this_fails_once"
    );
    client.send("direct:script.quit()");
    client.sync();
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn a_program_that_is_event_driven_takes_direct_texts_and_shows_its_variables() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    start(
        &mut client,
        "e.js",
        "var n = 0; web = { n: 5, list: [1, 2] }; script.run(); print('runs')",
    );
    client.expect("print: runs\n");
    client.send("direct:n += 1; print(n)");
    client.expect("print: 1\n");
    let mut web = robot.client("variables");
    web.raw("GET /web/ HTTP/1.0\r\n\r\n");
    let mut answer = String::new();
    web.stream.read_to_string(&mut answer).unwrap();
    assert!(
        answer.ends_with("{\"n\":\"5\",\"list\":\"[1, 2]\"}"),
        "{answer}"
    );
    client.send("direct:script.quit()");
    client.until("info: e.js ");
    assert_eq!(processes::children(robot.daemon()), [0_u32; 0]);
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn stop_ends_loops_waits_threads_and_recursion() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    for (index, text) in [
        "while (true);",
        "script.wait(1000000)",
        "while (true) { try { while (true); } catch (e) {} }",
        "script.timer(1).timeout.connect(function() { while (true); }); script.run()",
        "f = function() { while (true); }; Threading.startThread('a', f); Threading.joinThread('a')",
        "mailbox.receive()",
        "/(a+)+$/.test('a'.repeat(50) + 'b')",
        "script.system('sleep 1000', true)",
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("loop{index}.js");
        start(&mut client, &name, text);
        robot.forget_rest();
        client.send("stop");
        let told = client.until("info: ");
        assert!(told.contains("was stopped"), "{text}: {told}");
        assert!(robot.has_rested(), "{text}");
        assert_eq!(processes::children(robot.daemon()), [0_u32; 0], "{text}");
    }
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn all_threads_of_a_program_fit_into_its_memory() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    let text = "var work = function() {\n\
        var a = []; for (var i = 0; i < 10000; i++) a.push('x' + i);\n\
        Threading.receiveMessage(); Threading.sendMessage('main', a.length); }\n\
        var main = function() {\n\
        for (var i = 0; i < 15; i++) Threading.startThread('t' + i, work);\n\
        for (var i = 0; i < 15; i++) Threading.sendMessage('t' + i, 'go');\n\
        var sum = 0; for (var i = 0; i < 15; i++) sum += +Threading.receiveMessage();\n\
        print(sum); }";
    start(&mut client, "t.js", text);
    client.expect("print: 150000\n");
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn messages_between_robots_reach_a_program() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    start(
        &mut client,
        "m.js",
        "mailbox.setHullNumber(3); print(mailbox.myHullNumber(), mailbox.isEnabled());\n\
         print(mailbox.receive())",
    );
    client.expect("print: 3true\n");
    let mut other = robot.client("mailbox");
    other.send("register:9999:7");
    other.send("data:hello: you");
    assert_eq!(client.until("print: "), "print: hello: you\n");
    assert_eq!(robot.end(), Some(0));
}

/// A program, and what it prints while keys are pressed: one record of seven integers for each change.
#[test]
fn no_key_is_missed_while_a_program_does_something_else() {
    let scratch = tempdir().unwrap();
    let device = scratch.path().join("keys/device");
    fs::create_dir_all(scratch.path().join("keys")).unwrap();
    nix::unistd::mkfifo(&device, Mode::from_bits_truncate(0o600)).unwrap();
    let program = put(
        scratch.path(),
        "keys.js",
        "var keys = brick.keys();\n\
         print(keys.wasPressed(KeysEnum.Up));\n\
         script.writeToFile('ready', 'x');\n\
         while (!keys.wasPressed(KeysEnum.Enter)) script.wait(1);\n\
         print(keys.wasPressed(KeysEnum.Up), keys.wasPressed(KeysEnum.Up), keys.wasPressed(KeysEnum.Esc));\n\
         print(keys.buttonCode(false), ' ', keys.buttonCode(), ' ', keys.buttonCode(false));\n\
         for (var i = 0; i < 5; i++) script.wait(1);\n\
         keys.buttonPressed.connect(function(code, value) { print(code, ' ', value); if (code == KeysEnum.Power) script.quit(); });\n\
         script.writeToFile('ready2', 'x');\n\
         script.run();",
    );
    // Open for both, so that neither end closes early.
    let mut presses = fs::File::options()
        .read(true)
        .write(true)
        .open(&device)
        .unwrap();
    let folder = scratch.path().to_owned();
    let presser = std::thread::spawn(move || {
        let mut press = |keys: [i32; 7]| {
            let bytes: Vec<u8> = keys.iter().flat_map(|key| key.to_ne_bytes()).collect();
            presses.write_all(&bytes).unwrap();
        };
        harness::eventually("the program listens", || folder.join("ready").exists());
        press([0, 1, 0, 0, 0, 0, 0]);
        press([0, 0, 0, 0, 0, 0, 0]);
        press([0, 0, 0, 0, 0, 0, 1]);
        harness::eventually("the program is event-driven", || {
            folder.join("ready2").exists()
        });
        press([0, 0, 0, 0, 0, 0, 0]);
        press([1, 0, 0, 0, 0, 0, 0]);
        // The end that writes stays open until the program has read.
        presses
    });
    let output = run(scratch.path(), &program);
    drop(presser.join().unwrap());
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        "false\ntruefalsefalse\n103 28 -1\n28 0\n116 1\n",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// Whether the process of a program ends with a signal that nobody sent.
fn crashes(text: &[u8]) -> Option<String> {
    let scratch = tempdir().unwrap();
    let program = put(scratch.path(), "hostile.js", text);
    let mut child = Command::new(crate::rig::trikd())
        .args(["js", "--tree"])
        .arg(scratch.path())
        .arg(program)
        .current_dir(scratch.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let patience = Instant::now() + Duration::from_secs(1);
    while Instant::now() < patience {
        if let Some(status) = child.try_wait().unwrap() {
            return status.signal().map(|signal| format!("signal {signal}"));
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    // It loops, as programs may.
    child.kill().unwrap();
    child.wait().unwrap();
    None
}

/// Pieces that together are nearly programs.
const PIECES: [&str; 48] = [
    "var a=",
    "function f(){",
    "}",
    "{",
    "(",
    ")",
    "[",
    "]",
    ";",
    ",",
    "a",
    "f()",
    "1e309",
    "-0",
    "null",
    "undefined",
    "brick.motor(",
    "brick.sensor(",
    "A1",
    "'x'",
    "Threading.startThread('t',f)",
    "script.wait(1)",
    "script.run()",
    "script.quit()",
    "print(",
    "print(a)",
    "new Array(1e9)",
    ".repeat(1e8)",
    "/(a+)+/",
    "class B extends a{",
    "=>",
    "...",
    "`${",
    "`",
    "try{",
    "catch(e){",
    "throw a",
    "f.call(f)",
    "Object.defineProperty(a,'toString',{get:f})",
    "JSON.stringify(",
    "a.b.c",
    "mailbox.receive(false)",
    "gamepad.pad.connect(f)",
    "new Proxy(",
    "eval(a)",
    "async ",
    "await ",
    "Error.prepareStackTrace=f",
];

proptest! {
    #![proptest_config(Config { cases: 40, failure_persistence: None, ..Config::default() })]

    #[test]
    fn arbitrary_bytes_never_crash(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        prop_assert_eq!(crashes(&bytes), None);
    }

    #[test]
    fn arbitrary_programs_never_crash(pieces in proptest::collection::vec(0..PIECES.len(), 0..40)) {
        let text: Vec<_> = pieces.iter().map(|index| PIECES[*index]).collect();
        prop_assert_eq!(crashes(text.join(" ").as_bytes()), None, "{}", text.join(" "));
    }
}

#[test]
fn hostile_programs_end_with_a_text() {
    for text in [
        "var a = []; for (;;) a = [a, a.concat(a), 'x'.repeat(1e6)]",
        "function f() { try { f(); } finally { f(); } } f()",
        "var e = new Error('x'); e.toString = function() { throw e; }; throw e",
        "throw { toString: function() { throw 1; } }",
        "Object.defineProperty(Error.prototype, 'name', { get: function() { throw 2; } }); nothing",
        "var n = '['.repeat(1e6); JSON.parse(n)",
        "eval('('.repeat(1e6))",
        "var p = {}; for (var i = 0; i < 1e5; i++) p = { p: p }; print(JSON.stringify(p))",
        "Array.prototype.map = null; print([1])",
        "brick = null; script = null; print = null; Object.prototype.toString = null; x",
        "(function f() { [1].map(f); })()",
        "new Uint8Array(1e12)",
        "native.next(1)",
    ] {
        assert_eq!(crashes(text.as_bytes()), None, "{text}");
    }
}

fn document() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/user/javascript.md");
    fs::read_to_string(path).unwrap()
}

#[test]
fn every_name_of_the_document_is_there() {
    let scratch = tempdir().unwrap();
    crate::javascript::tree(&scratch);
    let markdown = document();
    let rows = markdown.lines().filter_map(|line| line.strip_prefix("| `"));
    let names: Vec<_> = rows
        .filter_map(|row| row.split('`').next())
        .filter_map(|call| call.split(['(', ' ']).next().zip(Some(call)))
        .collect();
    assert!(names.len() > 100, "only {} rows", names.len());
    let mut text = String::from(
        "function check(call, value, wanted) { if (typeof value !== wanted && !(wanted === 'object' && value !== null && typeof value === 'object')) print(call, ' is ', typeof value); }\n",
    );
    for (name, call) in &names {
        // Columns name objects as programs get them: `motor.setPower(...)` is one of brick.motor(M1).
        let object = [
            ("motor.", "brick.motor(M1)."),
            ("sensor.", "brick.sensor(A1)."),
            ("encoder.", "brick.encoder(E1)."),
            ("keys.", "brick.keys()."),
            ("led.", "brick.led()."),
            ("battery.", "brick.battery()."),
            ("display.", "brick.display()."),
            ("pwmCapture.", "brick.pwmCapture(S3)."),
            ("accelerometer.", "brick.accelerometer()."),
            ("gyroscope.", "brick.gyroscope()."),
            ("lineSensor.", "brick.lineSensor(video1)."),
            ("objectSensor.", "brick.objectSensor(video1)."),
            ("colorSensor.", "brick.colorSensor(video1)."),
            ("soundSensor.", "brick.soundSensor(video2)."),
            ("i2c.", "brick.i2c(1, 0x33, 2)."),
            ("eventDevice.", "brick.eventDevice('/dev/input/event0')."),
            ("lidar.", "brick.lidar()."),
            ("irCamera.", "brick.irCamera()."),
            ("fifo.", "brick.fifo('gamepad/text')."),
            ("timer.", "script.timer(1000)."),
            ("signal.", "script.timer(1000).timeout."),
        ]
        .into_iter()
        .find_map(|(short, long)| name.strip_prefix(short).map(|rest| format!("{long}{rest}")))
        .unwrap_or_else(|| (*name).to_owned());
        let wanted = if call.contains('(') {
            "function"
        } else {
            "object"
        };
        text.push_str(&format!("check({call:?}, {object}, {wanted:?});\n"));
    }
    put(scratch.path(), "camera/object/value", "1 2 3\n");
    put(scratch.path(), "gamepad/text/value", "pad 1 up\n");
    for file in [
        "microphones/value",
        "i2c/bus1/device",
        "input/event0/value",
        "input/event0/device",
    ] {
        put(scratch.path(), file, "");
    }
    let program = put(scratch.path(), "names.js", text);
    let output = run(scratch.path(), &program);
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert_eq!(said, "");
}

#[test]
fn every_example_of_the_document_prints_what_the_document_says() {
    let markdown = document();
    let all = examples(&markdown);
    let mut tried = 0;
    for pair in all.windows(2).filter(|pair| pair[0].info == "js") {
        let scratch = tempdir().unwrap();
        crate::javascript::tree(&scratch);
        let program = put(scratch.path(), "example.js", &pair[0].text);
        let output = run(scratch.path(), &program);
        let said = String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr).replace("trikd: ", "error: ");
        assert_eq!(pair[1].info, "text", "line {}", pair[0].line);
        assert_eq!(said, pair[1].text, "line {}", pair[0].line);
        tried += 1;
    }
    assert!(tried >= 4, "only {tried} examples");
}
