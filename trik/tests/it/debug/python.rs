//! Programs in Python in the debugger of an editor: debugpy on a virtual robot, and the adapter between.
//!
//! Needs debugpy: `TRIK_DEBUGPY_PYTHON` names the python3 of a virtual environment that has it. Without it the tests are
//! skipped by name.

use super::dap::Editor;
use crate::programs::Reachable;
use harness::eventually;
use needs::Need;
use serde_json::{Value, json};
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Line 3 is in a function, line 5 turns a motor, and line 9 never ends.
pub(super) const DRIVING: &str = "\
# A program in Python.
def double(k):
    return k * 2
n = double(4)
brick.motor(M3).setPower(40)
print('n is', n)
while True:
    n += 1
    script.wait(10)
";

/// The python of the environment, and a robot whose programs run in it too.
pub(super) fn debugged() -> Option<(String, Reachable)> {
    let Ok(python) = std::env::var("TRIK_DEBUGPY_PYTHON") else {
        Need::Extra.missing("TRIK_DEBUGPY_PYTHON is not set");
        return None;
    };
    let path = PathBuf::from(&python);
    let robot = Reachable::with(path.parent().expect("its directory"))?;
    Some((python, robot))
}

/// An editor that has launched a program, and the number of that request.
pub(super) fn launched(python: &str, robot: &Reachable, text: &str, more: Value) -> (Editor, u64) {
    let file = robot.robot.home.0.file("x.py", text);
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    let mut arguments = json!({"program": file, "robot": robot.ip(), "python": python});
    for (name, value) in more.as_object().expect("members") {
        arguments[name] = value.clone();
    }
    let launch = editor.post("launch", arguments);
    (editor, launch)
}

pub(super) fn points(robot: &Reachable, lines: &[u32]) -> Value {
    let lines = lines.iter().map(|line| json!({ "line": line }));
    let lines: Vec<_> = lines.collect();
    let file = robot.robot.home.0.path("x.py");
    json!({"source": {"path": file}, "breakpoints": lines})
}

pub(super) fn duty(robot: &Reachable) -> i8 {
    robot.robot.duty(3).expect("a motor")
}

/// Where it is stopped: the thread, and the innermost frame.
pub(super) fn top(editor: &mut Editor, stopped: &Value) -> (Value, Value) {
    let thread = stopped["threadId"].clone();
    let mut stack = editor.good("stackTrace", json!({ "threadId": thread }));
    (thread, stack["stackFrames"][0].take())
}

fn status(robot: &Reachable) -> String {
    let home = &robot.robot.home;
    home.run(&["status", "--robot", robot.ip()]).good()
}

#[test]
fn a_program_in_python_stops_at_lines_and_its_motors_rest_there() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, DRIVING, json!({}));
    let told = editor.event("capabilities");
    assert_eq!(told["capabilities"]["supportsStepBack"], false, "{told}");
    editor.event("initialized");
    let set = editor.good("setBreakpoints", points(&robot, &[3, 6]));
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.answer(launch)["success"], true);
    let stopped = editor.event("stopped");
    let (thread, frame) = top(&mut editor, &stopped);
    assert_eq!(
        (&frame["line"], &frame["name"]),
        (&json!(3), &json!("double"))
    );
    eventually("a status that says where", || {
        status(&robot).contains(": stopped at x.py line 3")
    });
    let file = robot.robot.home.0.path("x.py");
    assert_eq!(frame["source"]["path"], json!(file));
    let asked = json!({"expression": "k * 10", "frameId": frame["id"], "context": "watch"});
    assert_eq!(editor.good("evaluate", asked)["result"], "40");
    let scopes = editor.good("scopes", json!({"frameId": frame["id"]}));
    let reference = &scopes["scopes"][0]["variablesReference"];
    let variables = editor.good("variables", json!({"variablesReference": reference}));
    assert!(
        variables.to_string().contains("\"name\":\"k\""),
        "{variables}"
    );
    editor.good("stepOut", json!({"threadId": thread}));
    editor.event("stopped");
    editor.good("continue", json!({"threadId": thread}));

    // The motor was told in the line before.
    let stopped = editor.event("stopped");
    assert_eq!(top(&mut editor, &stopped).1["line"], 6);
    eventually("a motor at rest", || duty(&robot) == 0);
    // What debugpy refuses moves neither the program nor a motor.
    for _ in 0..2 {
        editor.bad("next", json!({"threadId": 99_999}));
        editor.bad("goto", json!({"threadId": thread, "targetId": 987_654}));
        eventually("a motor at rest", || duty(&robot) == 0);
    }
    editor.good("next", json!({"threadId": thread}));
    editor.wait(|message| message["body"]["output"] == "n is 8\n");
    editor.event("stopped");
    eventually("a motor at rest", || duty(&robot) == 0);
    editor.good("continue", json!({"threadId": thread}));
    eventually("a motor that goes on", || duty(&robot) != 0);
    eventually("a status without a stop", || {
        !status(&robot).contains("stopped at")
    });
    let threads = editor.good("threads", json!({}));
    assert_eq!(
        threads["threads"].as_array().map(Vec::len),
        Some(1),
        "{threads}"
    );
    editor.good("pause", json!({"threadId": thread}));
    assert_eq!(editor.event("stopped")["reason"], "pause");
    eventually("a motor at rest", || duty(&robot) == 0);
    let why = editor.bad("stepBack", json!({"threadId": thread}));
    assert!(why.contains("cannot be taken back"), "{why}");
    editor.end();
    assert!(robot.rests());
}

/// Line 8 is between turns of a motor by another thread.
const TURNING: &str = "\
import threading
def turn():
    while True:
        script.wait(5)
        brick.motor(M4).setPower(60)
threading.Thread(target=turn, daemon=True).start()
script.wait(300)
n = 1
while True:
    script.wait(10)
";

#[test]
fn a_thread_that_tells_a_motor_something_at_a_stop_does_not_turn_it() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, TURNING, json!({}));
    editor.event("initialized");
    editor.good("setBreakpoints", points(&robot, &[8]));
    editor.good("configurationDone", json!({}));
    editor.answer(launch);
    let m4 = || robot.robot.duty(4).expect("a motor");
    for _ in 0..5 {
        let stopped = editor.event("stopped");
        eventually("a motor at rest", || m4() == 0);
        let end = Instant::now() + Duration::from_millis(500);
        while Instant::now() < end {
            assert_eq!(m4(), 0, "it stays at rest");
        }
        let thread = json!({"threadId": stopped["threadId"]});
        editor.good("continue", thread.clone());
        eventually("a motor that goes on", || m4() != 0);
        editor.good("pause", thread);
    }
    editor.event("stopped");
    editor.end();
    assert!(robot.rests());
}

#[test]
fn an_error_that_nobody_catches_is_shown_where_it_is() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let text = "n = 1\nbrick.motor(M3).setPower(30)\nprint(n / 0)\n";
    let entry = json!({"stopOnEntry": true});
    let (mut editor, launch) = launched(&python, &robot, text, entry);
    editor.event("initialized");
    let filters = json!({"filters": ["uncaught"]});
    editor.good("setExceptionBreakpoints", filters);
    editor.good("configurationDone", json!({}));
    editor.answer(launch);
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "entry");
    let (thread, frame) = top(&mut editor, &stopped);
    assert_eq!(frame["line"], 1);
    editor.good("continue", json!({"threadId": thread}));
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "exception", "{stopped}");
    assert_eq!(top(&mut editor, &stopped).1["line"], 3);
    let told = editor.good("exceptionInfo", json!({"threadId": thread}));
    assert!(
        told["exceptionId"].to_string().contains("ZeroDivision"),
        "{told}"
    );
    eventually("motors at rest", || robot.rests());
    editor.good("continue", json!({"threadId": thread}));
    let told = editor.wait(|message| message["body"]["category"] == "stderr");
    assert!(
        told["body"]["output"].to_string().contains("line 3"),
        "{told}"
    );
    let told = editor.wait(|message| message["body"]["category"] == "console");
    let told = told["body"]["output"].to_string();
    assert!(told.contains("x.py has failed with exit code 1"), "{told}");
    assert_eq!(editor.event("exited")["exitCode"], 1);
    editor.event("terminated");
    editor.end();
}

#[test]
fn an_editor_that_is_gone_leaves_no_program_behind() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let (mut editor, _) = launched(&python, &robot, DRIVING, json!({"motors": "keep"}));
    editor.event("initialized");
    editor.good("setBreakpoints", points(&robot, &[6]));
    editor.good("configurationDone", json!({}));
    editor.event("stopped");
    // Asked otherwise, they go on turning at a stop.
    assert_ne!(duty(&robot), 0);
    editor.kill();
    eventually("motors at rest", || robot.rests());
    let status = robot
        .robot
        .home
        .run(&["status", "--robot", robot.ip()])
        .good();
    assert!(!status.contains("x.py ("), "{status}");
}

#[test]
fn what_cannot_be_debugged_in_python_is_refused_in_words() {
    let Some((python, robot)) = debugged() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("x.py", "print(1)\n");
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    let arguments = json!({"program": file, "robot": robot.ip()});
    for (command, member, value, part) in [
        ("attach", "speed", json!(null), "cannot be joined"),
        (
            "launch",
            "field",
            json!("f.xml"),
            "\"field\" is not for programs in Python",
        ),
        (
            "launch",
            "python",
            json!("/bin/false"),
            "/bin/false -m pip install debugpy",
        ),
        (
            "launch",
            "python",
            json!("no-python"),
            "no-python cannot be started",
        ),
        (
            "launch",
            "robot",
            json!("127.1.2.3:1"),
            "nothing takes programs",
        ),
    ] {
        let mut all = arguments.clone();
        all["python"] = json!(python);
        all[member] = value;
        let why = editor.bad(command, all);
        assert!(why.contains(part), "{why}");
    }
    // One with a mistake has not begun when it ends.
    home.0.file("x.py", "print(\n");
    let mut all = arguments.clone();
    all["python"] = json!(python);
    let why = editor.bad("launch", all);
    assert!(why.contains("SyntaxError"), "{why}");
    editor.end();
}

#[test]
fn a_robot_without_debugpy_says_what_to_type() {
    let Ok(python) = std::env::var("TRIK_DEBUGPY_PYTHON") else {
        return Need::Extra.missing("TRIK_DEBUGPY_PYTHON is not set");
    };
    let bin = harness::Board::new();
    // Packages of the site are not looked for.
    let script = bin.file("python3", format!("#!/bin/sh\nexec {python} -S \"$@\"\n"));
    let executable = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(&script, executable).expect("a program");
    let Some(robot) = Reachable::with(bin.dir()) else {
        return;
    };
    let (mut editor, launch) = launched(&python, &robot, "print(1)\n", json!({}));
    let told = editor.answer(launch);
    assert_eq!(told["success"], false, "{told}");
    let why = told["message"].as_str().expect("why");
    assert!(why.contains("this robot has none: type there: "), "{why}");
    assert!(why.contains(" -m pip install debugpy"), "{why}");
    editor.end();
}
