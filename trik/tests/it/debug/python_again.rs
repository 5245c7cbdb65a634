//! `restart` of an editor that debugs a program in Python, and who else of this computer knocks at its debugger.
//!
//! Needs debugpy as `python` does.

use super::dap::Editor;
use super::python::{DRIVING, debugged, duty, launched, points, top};
use crate::programs::Reachable;
use harness::eventually;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// As DRIVING, with another number and no motor.
const OTHER: &str = "\
# A program in Python.
def double(k):
    return k * 2
n = double(5)

print('n is', n)
while True:
    n += 1
    script.wait(10)
";

fn file(robot: &Reachable, text: &str) {
    robot.robot.home.0.file("x.py", text);
}

/// The value of n where it is stopped.
fn n(editor: &mut Editor, stopped: &Value) -> Value {
    let (_, frame) = top(editor, stopped);
    let asked = json!({"expression": "n", "frameId": frame["id"], "context": "watch"});
    editor.good("evaluate", asked)["result"].take()
}

fn breakpoint(told: &Value) -> Value {
    told["hitBreakpointIds"][0].clone()
}

#[test]
fn a_program_begins_anew_with_its_file_and_its_breakpoints() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let keep = json!({"motors": "keep"});
    let (mut editor, launch) = launched(&python, &robot, DRIVING, keep);
    let told = editor.event("capabilities");
    assert_eq!(told["capabilities"]["supportsRestartRequest"], true);
    editor.event("initialized");
    // The second of three lines is where it stops: their numbers differ.
    let mut all = points(&robot, &[3, 6, 8]);
    all["breakpoints"][0]["condition"] = json!("k == 100");
    all["breakpoints"][2]["condition"] = json!("n > 20");
    let set = editor.good("setBreakpoints", all);
    let number = |at: usize| set["breakpoints"][at]["id"].clone();
    editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.answer(launch)["success"], true);
    let stopped = editor.event("stopped");
    assert_eq!(stopped["allThreadsStopped"], true);
    assert_eq!(n(&mut editor, &stopped), "8");
    assert_eq!(breakpoint(&stopped), number(1));
    eventually("a motor that is kept on", || duty(&robot) != 0);

    // A file that is not there changes nothing.
    let path = robot.robot.home.0.path("x.py");
    std::fs::remove_file(&path).expect("a file");
    let why = editor.bad("restart", json!({}));
    assert!(why.contains("x.py"), "{why}");
    assert_eq!(n(&mut editor, &stopped), "8");
    assert_ne!(duty(&robot), 0);

    file(&robot, OTHER);
    editor.good("restart", json!({}));
    assert_eq!(editor.event("continued")["allThreadsContinued"], true);
    let gone = editor.wait(|message| message["body"]["reason"] == "exited");
    assert_eq!(gone["body"]["threadId"], stopped["threadId"]);
    let stopped = editor.event("stopped");
    assert_eq!(n(&mut editor, &stopped), "10");
    assert_eq!(breakpoint(&stopped), number(1), "the editor knows this one");
    eventually("a motor that rests since the end", || duty(&robot) == 0);
    let thread = json!({"threadId": stopped["threadId"]});
    editor.good("continue", thread.clone());
    let stopped = editor.event("stopped");
    assert_eq!(breakpoint(&stopped), number(2));
    assert_eq!(n(&mut editor, &stopped), "21");

    // Breakpoints that are set now have numbers of their own.
    let set = editor.good("setBreakpoints", points(&robot, &[9]));
    let new = set["breakpoints"][0]["id"].clone();
    assert!((0..3).all(|at| number(at) != new), "{new}");
    editor.good("continue", thread);
    let stopped = editor.event("stopped");
    assert_eq!(
        (breakpoint(&stopped), &stopped["threadId"]),
        (new.clone(), &json!(1))
    );

    // While it runs, and with the breakpoint that is set now.
    editor.good("setBreakpoints", points(&robot, &[]));
    editor.good("continue", json!({"threadId": 1}));
    // Once more it means nothing, and does not wait for a stop.
    let going = editor.good("continue", json!({"threadId": 1}));
    assert_eq!(going["allThreadsContinued"], true);
    editor.good("restart", json!({}));
    editor.wait(|message| message["body"]["output"] == "n is 10\n");
    let pause = editor.good("pause", json!({"threadId": 1}));
    assert_eq!(pause, Value::Null);
    assert_eq!(editor.event("stopped")["reason"], "pause");
    editor.end();
    eventually("motors at rest", || robot.rests());
}

#[test]
fn a_file_with_a_mistake_does_not_begin_anew_and_its_end_is_told() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, DRIVING, json!({"stopOnEntry": true}));
    editor.event("initialized");
    editor.good("configurationDone", json!({}));
    editor.answer(launch);
    assert_eq!(editor.event("stopped")["reason"], "entry");
    editor.good("restart", json!({}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "entry", "asked for at each beginning");
    assert_eq!(top(&mut editor, &stopped).1["line"], 2);
    editor.good("continue", json!({"threadId": stopped["threadId"]}));
    eventually("a motor that turns", || duty(&robot) != 0);
    file(&robot, "print(\n");
    let restart = editor.post("restart", json!({}));
    // What comes meanwhile is answered when it is decided.
    let threads = editor.post("threads", json!({}));
    let told = editor.answer(restart);
    assert_eq!(told["success"], false);
    let why = told["message"].as_str().expect("why");
    assert!(why.contains("SyntaxError"), "{why}");
    assert_eq!(editor.answer(threads)["success"], false);
    assert_eq!(editor.event("exited")["exitCode"], 1);
    editor.event("terminated");
    eventually("motors at rest", || robot.rests());
    let why = editor.bad("restart", json!({}));
    assert!(why.contains("no program"), "{why}");
    editor.end();
}

/// Line 7 is reached while another thread counts.
const TWO: &str = "\
import threading
count = [0]
def turn():
    while True:
        script.wait(1)
        count[0] += 1
threading.Thread(target=turn, daemon=True).start()
while True:
    script.wait(5)
";

/// The count, if the thread that counts says it, as it does at its stop: debugpy evaluates in the thread of the frame.
fn count_of_other(editor: &mut Editor, main: &Value) -> Option<u64> {
    let threads = editor.good("threads", json!({}));
    let mut ids = threads["threads"].as_array()?.iter().map(|one| &one["id"]);
    let other = ids.find(|id| *id != main)?;
    let stack = editor.ask("stackTrace", json!({"threadId": other}));
    let mut frames = stack["body"]["stackFrames"].as_array()?.iter();
    let frame = frames.find(|frame| frame["name"] == "turn")?;
    let asked = json!({"expression": "count[0]", "frameId": frame["id"], "context": "watch"});
    let told = editor.ask("evaluate", asked);
    told["body"]["result"].as_str()?.parse().ok()
}

#[test]
fn all_threads_stop_and_go_on_when_it_is_said() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, TWO, json!({}));
    editor.event("initialized");
    editor.good("setBreakpoints", points(&robot, &[9]));
    editor.good("configurationDone", json!({}));
    editor.answer(launch);
    let count = |editor: &mut Editor, stopped: &Value| {
        assert_eq!(stopped["allThreadsStopped"], true, "{stopped}");
        let (_, frame) = top(editor, stopped);
        let asked = json!({"expression": "count[0]", "frameId": frame["id"], "context": "watch"});
        let told = editor.good("evaluate", asked);
        told["result"]
            .as_str()
            .and_then(|text| text.parse::<u64>().ok())
    };
    let mut stopped = editor.event("stopped");
    for _ in 0..5 {
        // The other one may be on its way to its stop.
        let mut before = None;
        eventually("a count that stands", || {
            before = count_of_other(&mut editor, &stopped["threadId"]);
            before.is_some()
        });
        for _ in 0..20 {
            assert_eq!(count(&mut editor, &stopped), before, "it stands");
        }
        let thread = json!({"threadId": stopped["threadId"]});
        let told = editor.good("continue", thread);
        assert_eq!(told["allThreadsContinued"], true, "{told}");
        // It may come there again before the other one has had its turn.
        eventually("a count that goes on", || {
            stopped = editor.event("stopped");
            let goes_on = count(&mut editor, &stopped) > before;
            if !goes_on {
                let thread = json!({"threadId": stopped["threadId"]});
                editor.good("continue", thread);
            }
            goes_on
        });
    }
    editor.end();
}

/// A thread that ends at once, and a motor that turns at line 8.
const SHORT: &str = "\
import threading
short = threading.Thread(target=script.wait, args=(3000,))
short.start()
script.wait(100)
short.join()
brick.motor(M3).setPower(40)
while True:
    script.wait(5)
";

#[test]
fn a_step_of_a_thread_that_has_ended_turns_no_motor() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, SHORT, json!({}));
    editor.event("initialized");
    editor.good("setBreakpoints", points(&robot, &[4, 8]));
    editor.good("configurationDone", json!({}));
    editor.answer(launch);
    let stopped = editor.event("stopped");
    let main = stopped["threadId"].clone();
    let threads = editor.good("threads", json!({}));
    let ids = threads["threads"].as_array().expect("threads").iter();
    let mut others = ids.map(|one| &one["id"]).filter(|id| **id != main);
    let other = others.next().expect("the other thread").clone();
    editor.good("continue", json!({"threadId": main}));
    editor.event("stopped");
    eventually("an end of the thread", || {
        let threads = editor.good("threads", json!({}));
        threads["threads"].as_array().map(Vec::len) == Some(1)
    });
    eventually("motors at rest", || robot.rests());
    let why = editor.bad("next", json!({"threadId": other}));
    assert!(why.contains("has ended"), "{why}");
    assert!(robot.rests());
    // With its breakpoint, the motor would turn for the 5 ms of a round only, which nobody need see.
    editor.good("setBreakpoints", points(&robot, &[]));
    editor.good("continue", json!({"threadId": main}));
    eventually("a motor that turns", || duty(&robot) != 0);
    editor.end();
}

/// Ports of 127.0.0.1 at which processes below this one listen.
fn doors(parent: u32) -> BTreeSet<u16> {
    let below = |process: u32| {
        let list = format!("/proc/{process}/task/{process}/children");
        let text = std::fs::read_to_string(list).unwrap_or_default();
        let all = text.split_whitespace().filter_map(|word| word.parse().ok());
        all.collect::<Vec<u32>>()
    };
    let mut all = vec![parent];
    all.extend(below(parent));
    let mut inodes = BTreeSet::new();
    for process in all {
        let files = std::fs::read_dir(format!("/proc/{process}/fd")).into_iter();
        for file in files.flatten().flatten() {
            let name = std::fs::read_link(file.path()).unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            let inode = name.strip_prefix("socket:[");
            inodes.extend(
                inode
                    .and_then(|rest| rest.strip_suffix(']'))
                    .map(str::to_owned),
            );
        }
    }
    let table = std::fs::read_to_string("/proc/net/tcp").unwrap_or_default();
    let door = |line: &str| {
        let words: Vec<_> = line.split_whitespace().collect();
        let listens = words.get(3) == Some(&"0A") && inodes.contains(*words.get(9)?);
        let port = words.get(1)?.split_once(':')?.1;
        listens.then(|| u16::from_str_radix(port, 16).ok())?
    };
    table.lines().filter_map(door).collect()
}

/// Connects to all these doors again and again, as a program of another user could; true: somebody has answered one.
fn knock(editor: u32, is_over: &AtomicBool) -> bool {
    let mut is_heard = false;
    while !is_over.load(Ordering::Relaxed) {
        for port in doors(editor) {
            let Ok(mut stream) = TcpStream::connect(("127.0.0.1", port)) else {
                continue;
            };
            let _ = stream.set_read_timeout(Some(Duration::from_millis(50)));
            let rubbish = "0123456789abcdef0123456789abcdef\n";
            let _ = stream.write_all(rubbish.as_bytes());
            is_heard |= stream.read(&mut [0; 1]).is_ok_and(|count| count > 0);
        }
    }
    is_heard
}

#[test]
fn others_of_this_computer_are_not_taken_for_the_program() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    file(&robot, DRIVING);
    let mut editor = Editor::start();
    let is_over = Arc::new(AtomicBool::new(false));
    let (process, end) = (editor.id(), is_over.clone());
    let knocks = std::thread::spawn(move || knock(process, &end));
    editor.good("initialize", json!({"adapterID": "trik"}));
    let path = robot.robot.home.0.path("x.py");
    let arguments = json!({"program": path, "robot": robot.ip(), "python": python});
    let launch = editor.post("launch", arguments);
    editor.event("initialized");
    editor.good("setBreakpoints", points(&robot, &[6]));
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.answer(launch)["success"], true);
    let stopped = editor.event("stopped");
    assert_eq!(n(&mut editor, &stopped), "8");
    assert!(
        !doors(process).is_empty(),
        "there was something to knock at"
    );
    // And at the doors of the next program.
    editor.good("restart", json!({}));
    editor.event("stopped");
    is_over.store(true, Ordering::Relaxed);
    assert!(!knocks.join().expect("a thread"), "nobody spoke with them");
    editor.end();
    eventually("motors at rest", || robot.rests());
}
