//! Who debugs a program on a robot, and where it stands: what others are told, in the language that they ask for.

use super::dap::Editor;
use super::driving;
use super::restart::driving as stepping;
use crate::programs::Reachable;
use harness::eventually;
use serde_json::json;

/// Whether a text has letters that only Russian has here.
fn is_russian(text: &str) -> bool {
    text.contains('\u{430}') || text.contains('\u{43e}')
}

#[test]
fn others_hear_who_is_in_control_and_where_the_program_is_stopped() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let file = home.0.file("drive.qrs", driving());
    let mut editor = Editor::start();
    editor.good("initialize", json!({"adapterID": "trik"}));
    editor.good("launch", json!({"program": file, "robot": robot.ip()}));
    editor.event("initialized");
    let set = json!({"source": {"sourceReference": 1}, "breakpoints": [{"line": 6}]});
    editor.good("setBreakpoints", set);
    editor.good("configurationDone", json!({}));
    assert_eq!(editor.event("stopped")["reason"], "breakpoint");

    let status = home.run(&["status", "--robot", robot.ip()]).good();
    let line = |part: &str| status.lines().find(|line| line.contains(part));
    let stopped = line(": stopped ").expect("where it is stopped");
    assert!(
        stopped.ends_with(" s, thread main: breakpoint 1, main, Timer"),
        "{status}"
    );
    let control = line(" is in control").filter(|line| line.contains(": debugger 127."));
    let holder = control
        .expect("who is in control")
        .trim_end_matches(" is in control");
    let holder = holder.rsplit(' ').next().expect("an address").to_owned();
    assert!(holder.contains(':'), "{status}");

    // The same one everywhere.
    let attach = ["debug", "drive.qrs", "--attach", "--robot", robot.ip()];
    let refused = home.run(&attach);
    let why = format!("{holder} is in control");
    // One address is enough.
    assert_eq!(refused.stderr, format!("trik: {why}\n"));
    for command in [&["step"][..], &["continue"]] {
        let words = [command, &["--robot", robot.ip()]].concat();
        let refused = home.run(&words);
        assert!(refused.stderr.contains(&why), "{}", refused.stderr);
        let russian = home.run(&[&words[..], &["--language", "ru"]].concat());
        assert!(russian.stderr.contains(&holder) && is_russian(&russian.stderr));
    }
    let watch = ["watch", "--seconds", "0.3", "--robot", robot.ip()];
    let watched = home.run(&watch).good();
    assert!(watched.contains(&why), "{watched}");

    let none = json!({"source": {"sourceReference": 1}, "breakpoints": []});
    editor.good("setBreakpoints", none);
    editor.good("continue", json!({"threadId": 1}));
    let status = home.run(&["status", "--robot", robot.ip()]).good();
    assert!(!status.contains(": stopped "), "{status}");
    assert!(status.contains(&why), "{status}");
    editor.end();
    let status = home.run(&["status", "--robot", robot.ip()]).good();
    assert!(!status.contains("debugger"), "{status}");
}

#[test]
fn commands_about_a_program_that_runs_speak_russian_to_who_wants_it() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let at = ["--robot", robot.ip(), "--language", "ru"];
    let said = |words: &[&str]| home.run(&[words, &at].concat());
    let no_diagram =
        "\u{434}\u{438}\u{430}\u{433}\u{440}\u{430}\u{43c}\u{43c}\u{430} \u{43d}\u{435} ";
    for words in [
        &["set", "n=1"][..],
        &["step"],
        &["continue"],
        &["watch"],
        &["break", "a/b"],
    ] {
        let refused = said(words).stderr;
        assert!(refused.contains(no_diagram), "{words:?}: {refused}");
        assert!(!refused.contains("diagram"), "{words:?}: {refused}");
    }
    let file = home.0.file("drive.qrs", stepping("1"));
    let file = file.to_str().expect("UTF-8").to_owned();
    let mut command = home.command(&[&["run", &file, "--watch"][..], &at].concat());
    let running = crate::programs::Running::new(&mut command);
    eventually("a robot that drives", || {
        robot.robot.duty(3).is_ok_and(|duty| duty != 0)
    });
    let status = said(&["status"]).stdout;
    for line in status.lines() {
        assert!(is_russian(line), "{status}");
    }
    assert!(status.contains("drive.qrs") && !status.contains("started"));
    // The robot itself says why, in the language that was asked for.
    let refused = said(&["set", "n=1 +"]).stderr;
    assert!(
        is_russian(&refused) && !refused.contains("Unexpected"),
        "{refused}"
    );
    let set = said(&["set", "n=1000"]);
    assert_eq!(set.code(), 0, "{}", set.stderr);
    assert!(
        is_russian(&set.stderr) && !set.stderr.contains("changed"),
        "{}",
        set.stderr
    );
    home.0.file("drive.qrs", stepping("1000"));
    let blocks = "\u{431}\u{43b}\u{43e}\u{43a}\u{43e}\u{432} ";
    running.says(&format!(
        "drive.qrs \u{438}\u{437}\u{43c}\u{435}\u{43d}\u{435}\u{43d}\u{430}: {blocks}"
    ));
    // Mistakes too, although the robot speaks English.
    home.0.file("drive.qrs", stepping(""));
    running.says(
        "drive.qrs \u{43d}\u{435} \u{438}\u{437}\u{43c}\u{435}\u{43d}\u{435}\u{43d}\u{430}: ",
    );
    let all = running.said();
    let last = all.lines().last().expect("a line");
    assert!(
        last.contains("main: Function (") && last.contains(" 1:7 "),
        "{all}"
    );
    assert!(!last.contains("Unexpected"), "{all}");
    home.run(&["stop", "--robot", robot.ip()]).good();
    let mut running = running;
    assert_eq!(running.code(), Some(1));
    assert!(
        is_russian(running.said().lines().last().expect("its end")),
        "{}",
        running.said()
    );
}

#[test]
fn a_robot_that_is_not_there_is_told_in_russian() {
    let Some(home) = crate::rig::Home::new() else {
        return;
    };
    let file = home.0.file("drive.qrs", driving());
    let file = file.to_str().expect("UTF-8");
    for words in [
        &["set", "n=1"][..],
        &["step"],
        &["continue"],
        &["watch"],
        &["run", file],
        &["run", file, "--watch"],
    ] {
        let told = home.run(&[words, &["--robot", "127.0.0.9:1", "--language", "ru"]].concat());
        assert_eq!(told.code(), 2, "{words:?}");
        assert!(is_russian(&told.stderr), "{words:?}: {}", told.stderr);
        assert!(
            !told.stderr.contains("nothing takes"),
            "{words:?}: {}",
            told.stderr
        );
    }
}
