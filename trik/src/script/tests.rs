//! Programs under a judge, on a stand-in for a robot: time, threads, ends, failures, files, events.

use super::*;
use crate::sandbox::Sandbox;
use lang_diagram::machine::{STEP_MS, Status};
use lang_diagram::ports::Port;
use lang_diagram::stand_in::{Placing, StandIn};
use sim::judge::Program;
use std::path::Path;
use std::time::Duration;
use studio::script::asked::START_MS;

mod official;

/// Runs a program in JavaScript for at most so long: its status and what went wrong.
fn run(text: &str, ms: u32, robot: &mut StandIn) -> (Status, String) {
    let mut program = JavaScript::new(Path::new("/nowhere/p.js"), text).unwrap();
    drive(&mut program, ms, robot)
}

fn drive(program: &mut dyn Program, ms: u32, robot: &mut StandIn) -> (Status, String) {
    let mut now = 0;
    let mut status = program.step(now, robot);
    while status == Status::Running && now < ms {
        now += STEP_MS;
        robot.tick();
        status = program.step(now, robot);
    }
    program.stop(robot);
    let errors: Vec<_> = program.errors().iter().map(ToString::to_string).collect();
    (status, errors.join("\n"))
}

fn robot() -> StandIn {
    let mut robot = StandIn::new(Placing::default());
    robot.readings.insert(Port::named("A1").unwrap(), 45);
    robot
}

fn log(text: &str) -> Vec<String> {
    let mut robot = robot();
    let (status, error) = run(text, 10_000, &mut robot);
    assert!(matches!(status, Status::Ended { .. }), "{text}: {status:?}");
    assert_eq!(error, "", "{text}");
    robot
        .log
        .iter()
        .map(|(ms, line)| format!("{} {line}", ms - START_MS))
        .collect()
}

#[test]
fn a_wait_lets_the_world_move() {
    let told = log(
        "brick.motor(M3).setPower(50); script.wait(25); print(script.time() % 1000, ' ', brick.sensor(A1).read()); \
        brick.motor(M3).powerOff(); script.wait(0); print(brick.encoder(E3).read() > 0)",
    );
    assert_eq!(
        told,
        [
            "0 power M3 50",
            "30 print \"30 45\"",
            "30 power M3 0",
            "30 print \"true\"",
            "30 rest"
        ]
    );
}

/// What was printed, with the time.
fn printed(text: &str) -> Vec<String> {
    let lines = log(text).into_iter();
    lines
        .filter_map(|line| {
            let (ms, rest) = line.split_once(' ')?;
            let what = rest.strip_prefix("print \"")?.strip_suffix('"')?;
            Some(format!("{ms} {what}"))
        })
        .collect()
}

#[test]
fn who_asks_without_waiting_takes_time_as_well() {
    let asks = "let n = 0; while (brick.encoder(E3).read() < 11) n++; print(n)";
    let told = printed(&format!("brick.motor(M3).setPower(100); {asks}"));
    assert_eq!(told, ["30 296"]);
    // One that only computes, too; one that computes between waits does not.
    let told = printed(
        "const end = Date.now() + 50; let n = 0; for (;;) { for (let i = 0; i < 1000; i++); if (Date.now() >= end) break; n++ } print(n)",
    );
    assert_eq!(told, ["50 47"]);
    let told = printed(
        "for (let k = 0; k < 20; k++) { for (let i = 0; i < 4000; i++); script.wait(10) } print()",
    );
    assert_eq!(told, ["200 "]);
}

#[test]
fn a_program_without_end_is_ended_wherever_it_is() {
    let endless = [
        "for (;;);",
        "for (;;) { try { script.wait(10) } catch (error) { } }",
        "for (;;) { try { for (;;); } finally { for (;;); } }",
        "const f = async () => { for (;;) await 0; }; f(); f();",
        "script.timer(10).timeout.connect(() => { for (;;); }); script.run();",
        "function a() { for (;;) brick.sensor(A1).read(); }
            var main = function () { Threading.startThread('a', a); Threading.joinThread('a'); }",
        "for (;;) print('x'.repeat(1000));",
        "for (;;) { Threading.sendMessage('main', 'x'); Threading.receiveMessage(true); }",
        "/(a*)*b/.exec('a'.repeat(100));",
    ];
    for text in endless {
        let mut robot = robot();
        robot.is_logging = false;
        let (status, error) = run(text, 300, &mut robot);
        assert_eq!((status, error.as_str()), (Status::Running, ""), "{text}");
    }
}

#[test]
fn threads_take_turns_in_a_fixed_order() {
    let text = "
        function talk(name) { for (let i = 0; i < 2; i++) { print(name, i); script.wait(20); } }
        function a() { talk('a'); }
        function b() { talk('b'); Threading.sendMessage('main', 'hello'); print('b sent'); }
        var main = function () {
            Threading.startThread('a', a); print('begun');
            Threading.startThread('b', b);
            print(Threading.receiveMessage(true)); Threading.joinThread('b'); print('joined');
        }";
    let told = printed(text);
    let wanted = [
        "0 a0",
        "0 begun",
        "0 b0",
        "20 a1",
        "20 b1",
        "40 hello",
        "40 b sent",
        "40 joined",
    ];
    assert_eq!(told, wanted);
}

#[test]
fn the_calendar_and_chance_are_those_of_the_judge() {
    let text = "print(new Date(0).getTime(), ' ', new Date().toISOString(), ' ', typeof Date(), ' ', \
        new Date() instanceof Date, ' ', Date.now() - new Date(2026, 0, 1) < 1e9, ' ', performance.now());
        script.wait(1500); print(Date.now() % 60000); print(script.random(5, 5), ' ', Math.random() < 1);
        const numbers = []; for (let i = 0; i < 5; i++) numbers.push(script.random(1, 1000)); print(numbers)";
    let told = printed(text);
    assert_eq!(told[0], "0 0 2026-01-01T00:00:00.000Z string true true 0");
    assert_eq!(told[1], "1500 1500");
    assert_eq!(told[2], "1500 5 true");
    assert_eq!(told, printed(text), "chance is the same each time");
}

#[test]
fn failures_have_their_line_and_end_all_threads() {
    let mut robot = robot();
    let text = "function a() { for (;;) script.wait(10); }\nvar main = function () { Threading.startThread('a', a); script.wait(50);\nbrick.motor('Z9').setPower(1); }";
    let (status, error) = run(text, 1000, &mut robot);
    let ended = Status::Ended {
        at: 50,
        with_errors: true,
    };
    assert_eq!(status, ended);
    assert!(
        error.contains("p.js") && error.contains('3') && error.contains("brick.motor('Z9')"),
        "{error}"
    );
}

#[test]
fn files_stay_in_memory_and_only_those_beside_the_program_are_read() {
    let told = printed(
        "script.writeToFile('a.txt', 'one\\n'); script.writeToFile('a.txt', 'two'); print(script.readAll('a.txt').length);
        script.removeFile('a.txt');
        for (const file of ['a.txt', '/etc/passwd', '../x']) { try { print(script.readAll(file)) } catch (error) { print('no') } }
        print(script.system('rm -rf /'))",
    );
    assert_eq!(told, ["0 2", "0 no", "0 no", "0 no", "0 0"]);
    assert!(!std::path::Path::new("a.txt").exists());
}

#[test]
fn keys_and_timers_are_events() {
    let mut robot = robot();
    let text = "brick.keys().buttonPressed.connect((code, value) => print(code, ' ', value)); \
        script.timer(100).timeout.connect(() => print('timer')); script.run();";
    let mut program = JavaScript::new(Path::new("/nowhere/p.js"), text).unwrap();
    let enter = Port::named("Enter").unwrap();
    for now in (0..=180).step_by(STEP_MS as usize) {
        robot.readings.insert(enter, i32::from(now == 80));
        assert_eq!(program.step(now, &mut robot), Status::Running);
        robot.tick();
    }
    program.stop(&mut robot);
    let told: Vec<_> = robot.log.iter().map(|(_, line)| line.as_str()).collect();
    assert_eq!(
        told,
        [
            "print \"28 1\"",
            "print \"28 0\"",
            "print \"timer\"",
            "rest"
        ]
    );
}

#[test]
fn the_display_and_the_marker_tell_what_blocks_tell() {
    let told = log(
        "const d = brick.display(); d.setBackground('white'); d.addLabel('Hi', 1, 2); d.drawRect(1, 2, 3, 4, true); d.redraw(); \
        brick.marker().down('red'); brick.marker().up(); brick.led().orange(); brick.playTone(440, 100); brick.smile(); mailbox.send(3, 'hey')",
    );
    let told: Vec<_> = told.iter().map(|line| &line[2..]).collect();
    assert_eq!(
        told,
        [
            "background white",
            "label 1 2 20 \"Hi\"",
            "rectangle 1 2 3 4 filled",
            "redraw",
            "marker red",
            "marker up",
            "led orange",
            "tone 440 100",
            "smile",
            "send \"hey\" 3",
            "rest"
        ]
    );
}

fn python(text: &str, ms: u32, robot: &mut StandIn) -> (Status, String) {
    let wall = Duration::from_secs(60);
    let mut program =
        Python::new(Path::new("/nowhere/p.py"), text, 1, wall, Sandbox::open()).unwrap();
    drive(&mut program, ms, robot)
}

fn python_log(text: &str) -> Vec<String> {
    let mut robot = robot();
    let (status, error) = python(text, 10_000, &mut robot);
    assert!(matches!(status, Status::Ended { .. }), "{text}: {status:?}");
    assert_eq!(error, "", "{text}");
    let lines = robot.log.iter();
    lines
        .map(|(ms, line)| format!("{} {line}", ms - START_MS))
        .collect()
}

#[test]
fn python_waits_in_model_time_too() {
    if !needs::tool("python3") {
        return;
    }
    let text = "
import queue, threading, time
began = time.time()
brick.motor('M3').setPower(50)
script.wait(25)
print(brick.sensor(A1).read(), round(time.time() - began, 3))
box = queue.Queue()
def work():
    time.sleep(0.1)
    box.put('from a thread')
threading.Thread(target=work).start()
print(box.get())
def other():
    print('begins')
    script.wait(30)
    Threading.sendMessage('main', 'hello')
    print('sent')
Threading.startThread('b', other)
print(Threading.receiveMessage(True))
Threading.joinThread('b')
while brick.encoder('E3').read() < 60: pass
brick.display().addLabel('x', 1, 2)
brick.marker().down('red')
timer = script.timer(50)
timer.timeout.connect(lambda: (print('tick'), script.quit()))
script.run()
brick.motor('M3').powerOff()
";
    let wanted = [
        "0 power M3 50",
        "30 print \"45 0.03\"",
        "130 print \"from a thread\"",
        "130 print \"begins\"",
        "160 print \"hello\"",
        "160 print \"sent\"",
        "230 label 1 2 20 \"x\"",
        "230 marker red",
        "280 print \"tick\"",
        "280 power M3 0",
        "280 rest",
    ];
    assert_eq!(python_log(text), wanted);
}

#[test]
fn python_does_the_same_each_time() {
    if !needs::tool("python3") {
        return;
    }
    let text = "
import random, threading, time
def work(name):
    for i in range(5):
        print(name, random.randint(1, 1000), script.random(1, 1000), hash('x') % 100, time.time())
        time.sleep(random.random() / 10)
for name in 'abc': threading.Thread(target=work, args=(name,)).start()
";
    let first = python_log(text);
    assert!(first.len() > 10, "{first:?}");
    for _ in 0..3 {
        assert_eq!(python_log(text), first);
    }
}

#[test]
fn python_that_never_ends_or_fails_is_ended_and_says_where() {
    if !needs::tool("python3") {
        return;
    }
    for text in [
        "while True: pass",
        "while True:\n  try:\n    script.wait(10)\n  except BaseException: pass",
        "Threading.startThread('a', lambda: brick.keys().buttonCode())",
        "import threading\nthreading.Lock().acquire()\nlock = threading.Lock()\nlock.acquire()\nlock.acquire()",
        "while True: print('x' * 1000)",
    ] {
        let (status, error) = python(text, 300, &mut robot());
        assert_eq!((status, error.as_str()), (Status::Running, ""), "{text}");
    }
    let failures = [
        ("\n1 / 0", "2:1 ZeroDivisionError: division by zero"),
        ("x = (", "1:1 SyntaxError: '(' was never closed"),
        (
            "def f():\n  brick.motor('Z1').setPower(1)\nThreading.startThread('a', f)\nscript.wait(100)",
            "2:1 AttributeError",
        ),
        ("import sys\nsys.exit(3)", "ended itself with an error"),
        ("import os\nos._exit(0)", "broken off"),
    ];
    for (text, said) in failures {
        let (status, error) = python(text, 1000, &mut robot());
        assert!(
            matches!(
                status,
                Status::Ended {
                    with_errors: true,
                    ..
                }
            ),
            "{text}"
        );
        assert!(error.contains(said), "{text}: {error}");
    }
    let mut slow = Python::new(
        Path::new("/nowhere/p.py"),
        "sum(range(10 ** 12))",
        1,
        Duration::from_millis(300),
        Sandbox::open(),
    )
    .unwrap();
    let (_, error) = drive(&mut slow, 1000, &mut robot());
    assert!(error.contains("does not wait"), "{error}");
}

#[test]
fn what_the_child_process_says_is_what_is_heard_here() {
    use trikd::protocol::program::FROM_PROGRAM;
    let child = include_str!("virtual.py");
    let parts = ["link.ask('", "link.send('"].map(|mark| child.split(mark).skip(1));
    let words: Vec<_> = parts
        .into_iter()
        .flatten()
        .filter_map(|rest| rest.split('\'').next())
        .collect();
    assert!(words.len() > 15, "{words:?}");
    let here = include_str!("../../../studio/src/script/asked.rs");
    for word in words {
        let is_heard = FROM_PROGRAM.contains(&word) || here.contains(&format!("\"{word}\" =>"));
        assert!(is_heard, "{word}");
    }
}
