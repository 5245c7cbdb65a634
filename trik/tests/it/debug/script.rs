//! Programs in JavaScript in the debugger of an editor: what their engine can, and words for what it cannot.

use super::dap::Editor;
use super::restart::driving;
use crate::programs::Reachable;
use harness::eventually;
use serde_json::{Value, json};

/// Drives; line 2 waits, and a second thread computes for ever. Each thread evaluates the text, and one of them calls `main`.
const DRIVING: &str = "\
function pace(ms) {
  script.wait(ms);
}
function compute() {
  for (var n = 0; ; ++n) { if (n % 100000 == 0) brick.sensor(A1).read(); if (n == 0) print('computes'); }
}
var main = function() {
  Threading.startThread('busy', compute);
  brick.motor(M3).setPower(40);
  for (;;) { pace(20); }
}
";

fn begun(robot: &Reachable, request: &str, text: &str, more: Value) -> Editor {
    let file = robot.robot.home.0.file("drive.js", text);
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    let mut arguments = json!({"program": file, "robot": robot.ip()});
    for (name, value) in more.as_object().expect("members") {
        arguments[name] = value.clone();
    }
    editor.good(request, arguments);
    editor.event("initialized");
    editor
}

fn duty(robot: &Reachable) -> i8 {
    robot.robot.duty(3).expect("a motor")
}

#[test]
fn a_program_in_javascript_pauses_with_its_motors_and_goes_on() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let entry = json!({"stopOnEntry": true});
    let mut editor = begun(&robot, "launch", DRIVING, entry);
    let told = editor.event("capabilities");
    assert_eq!(told["capabilities"]["supportsStepBack"], false, "{told}");
    let set = editor.good("setBreakpoints", json!({"breakpoints": [{"line": 2}]}));
    assert_eq!(set["breakpoints"][0]["verified"], false);
    let why = set["breakpoints"][0]["message"].as_str().expect("why");
    assert!(why.contains("can only be paused"), "{why}");
    editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "entry");
    assert_eq!(duty(&robot), 0);
    editor.good("continue", json!({"threadId": 1}));
    eventually("a robot that drives", || duty(&robot) != 0);
    // Before it has called the robot once, nobody knows where it is.
    eventually("a second thread", || {
        let told = editor.event("output");
        told["output"]
            .as_str()
            .is_some_and(|text| text.contains("computes"))
    });
    for _ in 0..3 {
        editor.good("pause", json!({"threadId": 1}));
        assert_eq!(editor.event("stopped")["reason"], "pause");
        eventually("motors at rest", || robot.rests());
        let status = robot.robot.home.run(&["status", "--robot", robot.ip()]);
        let status = status.good();
        assert!(status.contains(": pause, line 2\n"), "{status}");
        let threads = editor.good("threads", json!({}));
        let named = json!({"threads": [{"id": 1, "name": "main"}, {"id": 2, "name": "busy"}]});
        assert_eq!(threads, named);
        let stack = editor.good("stackTrace", json!({"threadId": 1}));
        let frames = &stack["stackFrames"];
        assert_eq!(
            (&frames[0]["name"], &frames[0]["line"]),
            (&json!("pace"), &json!(2))
        );
        assert_eq!(frames[1]["line"], 10, "{stack}");
        assert_eq!(
            frames[0]["source"]["path"],
            json!(robot.robot.home.0.path("drive.js"))
        );
        let stack = editor.good("stackTrace", json!({"threadId": 2}));
        assert_eq!(stack["stackFrames"][0]["line"], 5, "{stack}");
        editor.good("continue", json!({"threadId": 1}));
        eventually("a robot that drives again", || duty(&robot) != 0);
    }
    for never in [
        "next",
        "stepIn",
        "stepBack",
        "evaluate",
        "variables",
        "restart",
    ] {
        let why = editor.bad(never, json!({"threadId": 1, "expression": "n"}));
        assert!(why.contains("can only be paused"), "{never}: {why}");
    }
    let why = editor.bad("fly", json!({}));
    assert!(why.contains("does not know 'fly'"), "{why}");
    editor.end();
    eventually("motors at rest", || robot.rests());
}

#[test]
fn an_error_of_javascript_that_nobody_catches_stops_with_its_calls() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let text = "print('begins');\nbrick.motor(M3).setPower(30);\nfunction f() {\n  return nobody.x;\n}\nf();\n";
    let mut editor = begun(&robot, "launch", text, json!({}));
    editor.good("setExceptionBreakpoints", json!({"filters": ["errors"]}));
    editor.good("configurationDone", json!({}));
    editor.wait(|message| message["body"]["output"] == "begins\n");
    let stopped = editor.event("stopped");
    assert_eq!(stopped["reason"], "exception", "{stopped}");
    let text = stopped["text"].as_str().expect("a text");
    assert!(text.starts_with("Line 4: ReferenceError: "), "{text}");
    eventually("motors at rest", || robot.rests());
    let stack = editor.good("stackTrace", json!({"threadId": 1}));
    let lines: Vec<_> = stack["stackFrames"]
        .as_array()
        .expect("all")
        .iter()
        .collect();
    let lines: Vec<_> = lines.iter().map(|frame| &frame["line"]).collect();
    assert_eq!(lines, [4, 6]);
    let told = editor.good("exceptionInfo", json!({"threadId": 1}));
    assert!(
        told["exceptionId"].to_string().contains("ReferenceError"),
        "{told}"
    );
    editor.good("continue", json!({"threadId": 1}));
    let told = editor.wait(|message| message["body"]["category"] == "stderr");
    assert!(
        told["body"]["output"]
            .to_string()
            .contains("ReferenceError"),
        "{told}"
    );
    assert_eq!(editor.event("exited")["exitCode"], 1);
    editor.event("terminated");
    editor.end();
}

#[test]
fn a_program_in_another_language_is_not_joined_and_runs_on() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home.0;
    let (diagram, script) = (
        home.file("blocks.qrs", driving("1")),
        home.file("drive.js", DRIVING),
    );
    for (runs, joined, part) in [
        (&script, &diagram, "a program in JavaScript runs there"),
        (&diagram, &script, "no program in JavaScript runs there"),
    ] {
        let running = robot.spawn_file(runs.to_str().expect("UTF-8"));
        let name = runs.file_name().expect("a name").to_string_lossy();
        let status = || {
            let status = robot.robot.home.run(&["status", "--robot", robot.ip()]);
            status.good().contains(&format!("{name} ("))
        };
        eventually("a program", status);
        let mut editor = Editor::start();
        editor.good("initialize", json!({"adapterID": "trik"}));
        let arguments = json!({"program": joined, "robot": robot.ip()});
        let why = editor.bad("attach", arguments);
        assert!(why.contains(part), "{why}");
        drop(editor);
        assert!(status());
        drop(running);
    }
}

#[test]
fn what_runs_after_a_program_in_javascript_is_not_ended_with_its_debugger() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    for last in ["terminate", "disconnect"] {
        let mut editor = begun(&robot, "launch", "print('done');\n", json!({}));
        editor.good("configurationDone", json!({}));
        editor.event("terminated");
        let other = robot.spawn("other.js", DRIVING);
        eventually("a robot that drives", || duty(&robot) != 0);
        if last == "terminate" {
            editor.good(last, json!({}));
        }
        editor.end();
        let status = robot.robot.home.run(&["status", "--robot", robot.ip()]);
        let status = status.good();
        assert!(status.contains("other.js ("), "{last}: {status}");
        assert_ne!(duty(&robot), 0, "{last}");
        drop(other);
        robot.robot.home.run(&["stop", "--robot", robot.ip()]);
    }
}

#[test]
fn a_program_in_javascript_that_runs_is_joined_and_let_go() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let file = robot.robot.home.0.file("drive.js", DRIVING);
    let running = robot.spawn_file(file.to_str().expect("UTF-8"));
    eventually("a robot that drives", || duty(&robot) != 0);
    let mut editor = begun(&robot, "attach", DRIVING, json!({}));
    editor.good("configurationDone", json!({}));
    editor.good("pause", json!({"threadId": 1}));
    editor.event("stopped");
    eventually("motors at rest", || robot.rests());
    // Who debugs is gone: a program that was stopped stays so, with its motors at rest.
    editor.kill();
    let mut editor = begun(&robot, "attach", DRIVING, json!({}));
    assert!(robot.rests());
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "entry");
    editor.end();
    eventually("a robot that goes on alone", || duty(&robot) != 0);
    // The shell can do as much with it, and no more.
    let home = &robot.robot.home;
    let stopped = home.run(&["step", "--robot", robot.ip()]).good();
    assert!(stopped.contains("pause"), "{stopped}");
    eventually("motors at rest", || robot.rests());
    let refused = home.run(&["step", "--robot", robot.ip()]);
    assert_eq!(refused.code(), 1, "{}", refused.stdout);
    let why = &refused.stderr;
    assert!(why.contains("can only be paused"), "{why}");
    home.run(&["continue", "--robot", robot.ip()]).good();
    eventually("a robot that goes on", || duty(&robot) != 0);
    drop(running);
}
