//! `restart` of an editor that debugs a diagram on a robot: what runs becomes the file as it is now.

use super::dap::Editor;
use crate::programs::Reachable;
use harness::eventually;
use lang_diagram::sketch::Sketch;
use serde_json::{Value, json};

/// Drives with M3, and counts by a step every 20 ms; line 5 counts.
pub(super) fn driving(step: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0")]);
    let motor = [("Ports", "M3"), ("Power", "40")];
    let motor = sketch.block("TrikV6EnginesForward", &motor);
    let body = format!("n = n + {step}");
    let count = sketch.block("Function", &[("Body", body.as_str())]);
    let wait = sketch.block("Timer", &[("Delay", "20")]);
    sketch.chain(&[start, clear, motor, count, wait, count]);
    sketch.qrs().expect("a save")
}

/// An editor that has launched or joined the diagram.
fn begun(robot: &Reachable, request: &str) -> Editor {
    let file = robot.robot.home.0.path("drive.qrs");
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    let arguments = json!({"program": file, "robot": robot.ip()});
    editor.good(request, arguments);
    editor.event("initialized");
    editor.good("configurationDone", json!({}));
    editor
}

fn told(editor: &mut Editor, begin: &str) -> Value {
    editor.wait(|message| {
        let text = message["body"]["output"].as_str();
        text.is_some_and(|text| text.starts_with(begin))
    })
}

fn count(editor: &mut Editor) -> i64 {
    editor.value("n").parse().expect("a number")
}

/// Another version comes while it drives, one with mistakes does not, and then the first one again.
fn changes(robot: &Reachable, editor: &mut Editor) {
    let home = &robot.robot.home;
    let drives = || robot.robot.duty(3).is_ok_and(|duty| duty != 0);
    eventually("a robot that drives", drives);
    eventually("a count", || count(editor) > 5);
    home.0.file("drive.qrs", driving("1000"));
    editor.good("restart", json!({}));
    told(editor, "changed: 5 blocks kept, 0 new, 0 gone");
    assert_eq!(editor.event("loadedSource")["reason"], "changed");
    eventually("the other step", || count(editor) > 1000);
    // A beginning would have begun at 0.
    assert!(count(editor) % 1000 > 5);
    home.0.file("drive.qrs", driving(""));
    let why = editor.bad("restart", json!({}));
    assert!(why.contains("goes on as it was"), "{why}");
    assert!(drives(), "a refusal moves nothing");
    // And back.
    home.0.file("drive.qrs", driving("1"));
    editor.good("restart", json!({}));
    told(editor, "changed: 5 blocks kept, 0 new, 0 gone");
    let before = count(editor);
    eventually("the first step", || count(editor) != before);
    assert!(drives());
}

#[test]
fn a_diagram_on_a_robot_becomes_its_file_without_a_stop() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    robot.robot.home.0.file("drive.qrs", driving("1"));
    let mut editor = begun(&robot, "launch");
    changes(&robot, &mut editor);
    // A breakpoint is where its block is in the new version.
    let points = json!({"source": {"sourceReference": 1}, "breakpoints": [{"line": 5}]});
    let set = editor.good("setBreakpoints", points);
    assert_eq!(set["breakpoints"][0]["verified"], true, "{set}");
    editor.event("stopped");
    eventually("motors at rest", || robot.rests());
    robot.robot.home.0.file("drive.qrs", driving("7"));
    editor.good("restart", json!({}));
    assert_eq!(editor.event("breakpoint")["breakpoint"]["line"], 5);
    editor.event("stopped");
    let before = count(&mut editor);
    editor.good("next", json!({"threadId": 1}));
    editor.event("stopped");
    assert_eq!(count(&mut editor), before + 7);
    editor.end();
    eventually("motors at rest", || robot.rests());
}

#[test]
fn a_diagram_that_runs_already_is_changed_by_who_joins_it() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let file = robot.robot.home.0.file("drive.qrs", driving("1"));
    let running = robot.spawn_file(file.to_str().expect("UTF-8"));
    let drives = || robot.robot.duty(3).is_ok_and(|duty| duty != 0);
    eventually("a robot that drives", drives);
    // The file is another version already when the editor comes.
    robot.robot.home.0.file("drive.qrs", driving("1000"));
    let mut editor = begun(&robot, "attach");
    eventually("a count", || count(&mut editor) > 5);
    editor.good("restart", json!({}));
    told(&mut editor, "changed: 5 blocks kept, 0 new, 0 gone");
    eventually("the other step", || count(&mut editor) > 1000);
    editor.end();
    // It goes on without the editor.
    assert!(drives());
    drop(running);
}

#[test]
fn an_editor_that_joins_may_stop_what_runs_and_hears_that_it_is_another_diagram() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("drive.qrs", driving("1"));
    let running = robot.spawn_file(file.to_str().expect("UTF-8"));
    eventually("a robot that drives", || !robot.rests());
    let mut short = Sketch::new();
    let (start, end) = (
        short.block("InitialNode", &[]),
        short.block("FinalNode", &[]),
    );
    short.chain(&[start, end]);
    home.0.file("short.qrs", short.qrs().expect("a save"));
    let joined = |name: &str| {
        let mut editor = Editor::start();
        editor.good("initialize", json!({"adapterID": "trik"}));
        let program = home.0.path(name);
        let arguments = json!({"program": program, "robot": robot.ip(), "stopOnEntry": true});
        editor.good("attach", arguments);
        editor.event("initialized");
        editor.good("configurationDone", json!({}));
        editor
    };
    let mut editor = joined("short.qrs");
    told(&mut editor, "another diagram than short.qrs");
    editor.event("stopped");
    eventually("motors at rest", || robot.rests());
    editor.end();
    eventually("a robot that drives on", || !robot.rests());
    let mut editor = joined("drive.qrs");
    editor.event("stopped");
    editor.end();
    drop(running);
}
