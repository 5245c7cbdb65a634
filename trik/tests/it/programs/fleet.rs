//! Several robots at once: which one is meant, and who has got the files.

use super::{Reachable, Running};
use crate::rig::{Home, loopback};
use harness::{eventually, processes};
use nix::sys::signal::Signal;
use std::sync::Arc;

#[test]
fn robots_side_by_side_are_told_apart() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let (one, other) = (Reachable::beside(&home, &[]), Reachable::beside(&home, &[]));
    let refusal = home.run(&["stop"]);
    assert_eq!(refusal.code(), 2);
    assert!(
        refusal
            .stderr
            .starts_with("trik: several robots run: say which with --robot: "),
        "{}",
        refusal.stderr
    );
    let mut running = one.start("loop.js");
    assert!(other.rests());
    let both = format!("{},{}", one.ip, other.ip);
    let said = home.run(&["stop", "--robot", &both]).good();
    assert!(
        said.contains("loop.js was stopped") && said.contains("no program was running"),
        "{said}"
    );
    assert_eq!(running.code(), Some(1));
}

#[test]
fn files_are_sent_to_several_robots_at_once_and_the_table_tells_who_has_got_them() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let (one, other) = (Reachable::beside(&home, &[]), Reachable::beside(&home, &[]));
    let dead = loopback();
    home.0
        .file("part.js", "function word() { return 'together'; }");
    home.0.file(
        "main.js",
        "include('part.js'); print(word()); script.wait(60000);",
    );
    home.0.file("big.bin", vec![0xff; 3 << 20]);
    let all = format!("{},{dead},{}", one.ip, other.ip);
    let words = [
        "send", "part.js", "main.js", "big.bin", "--robot", &all, "--run", "main.js",
    ];
    let output = home.run(&words);
    assert_eq!(output.code(), 1, "{}", output.stderr);
    let rows: Vec<Vec<&str>> = output
        .stdout
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert_eq!(rows.len(), 4, "{}", output.stdout);
    assert_eq!(
        rows[1],
        [one.ip.as_str(), "3", "of", "3", "main.js", "runs"]
    );
    assert_eq!(rows[2][..5], [dead.as_str(), "0", "of", "3", "FAILED:"]);
    assert_eq!(
        rows[3],
        [other.ip.as_str(), "3", "of", "3", "main.js", "runs"]
    );
    assert!(
        output
            .stderr
            .contains(&format!("{}: big.bin is sent, 3 of 3\n", other.ip)),
        "{}",
        output.stderr
    );
    assert!(
        output
            .stderr
            .ends_with("trik: 1 of 3 robots have not got everything\n"),
        "{}",
        output.stderr
    );
    for ip in [&one.ip, &other.ip] {
        let status = home.run(&["status", "--robot", ip]).good();
        assert!(status.contains(": program main.js ("), "{status}");
    }
    let scripts = one.robot.devices.with_extension("trikd").join("scripts");
    assert_eq!(
        std::fs::read(scripts.join("big.bin")).expect("kept").len(),
        3 << 20
    );
}

#[test]
fn a_file_that_does_not_get_there_is_a_failure_in_the_table() {
    let Some(one) = Reachable::new() else { return };
    let home = one.robot.home.clone();
    home.0.file("part.js", "");
    let output = home.run(&["send", "part.js", "--robot", &one.ip, "--run", "none.js"]);
    assert_eq!(output.code(), 1);
    assert!(
        output
            .stdout
            .contains("does not run none.js: there is no program 'none.js'"),
        "{}",
        output.stdout
    );
    home.0.file("huge.bin", vec![0; 17 << 20]);
    let output = home.run(&["send", "huge.bin", "--robot", &one.ip]);
    assert_eq!(output.code(), 1);
    assert!(
        output.stdout.contains(" bytes: at most 16777216 are taken"),
        "{}",
        output.stdout
    );
}

#[test]
fn robots_side_by_side_send_each_other_messages() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let (one, other) = (Reachable::beside(&home, &[]), Reachable::beside(&home, &[]));
    // Repeats what it has heard to every sender.
    let echo = "mailbox.setHullNumber(1); print('listens'); var text = mailbox.receive(); mailbox.send(2, 'you said ' + text); script.wait(60000);";
    let mut listener = one.spawn("echo.js", echo);
    listener.says("listens");
    let talk = format!(
        "mailbox.joinNetwork('{}', 8889, 2); while (!mailbox.isConnected()) script.wait(10); mailbox.send(1, 'hello'); print(mailbox.receive()); script.quit();",
        one.ip
    );
    let output = other.run("talk.js", &talk);
    assert_eq!(output.stdout, "you said hello\n", "{}", output.stderr);
    home.run(&["stop", "--robot", &one.ip]).good();
    assert_eq!(listener.code(), Some(1));
}

#[test]
fn a_robot_whose_records_were_removed_is_no_absent_one_and_has_its_address() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let robot = &reachable.robot;
    std::fs::remove_file(robot.home.base().join("robot.lock")).unwrap();
    let tree = robot.path("");
    for command in ["status", "stop"] {
        let path = tree.to_str().expect("UTF-8");
        let output = robot.home.run(&[command, "--robot", path]);
        assert_ne!(output.code(), 0, "{}", output.stderr);
        let why = "a tree is mounted there, and nothing says where its robot takes programs";
        assert!(output.stderr.contains(why), "{}", output.stderr);
        let output = robot.home.run(&[command, "--robot", reachable.ip()]);
        output.good();
    }
}

/// Three robots in a file: two that run here, and one that does not.
fn class_of(home: &Home, robots: [&Reachable; 2]) -> String {
    let [one, other] = robots.map(|robot| robot.robot.root.display().to_string());
    let lines = format!("# A room\nanna {one} red\nboris {other} blue\nclara ./none blue\n");
    home.0.file("class.txt", lines).display().to_string()
}

#[test]
fn a_class_is_told_to_stop_by_its_file_and_one_that_does_not_run_delays_nobody() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let (one, other) = (Reachable::beside(&home, &[]), Reachable::beside(&home, &[]));
    let class = class_of(&home, [&one, &other]);
    let mut running = one.start("loop.js");
    let said = home.run(&["status", "--class", &class]);
    assert_eq!(said.code(), 2, "{}", said.stderr);
    assert!(
        said.stdout.contains("anna: program loop.js (")
            && said.stdout.contains("boris: program none"),
        "{}",
        said.stdout
    );
    assert!(
        said.stderr.starts_with("trik: clara: ") && said.stderr.contains("no virtual robot"),
        "{}",
        said.stderr
    );
    let red = home
        .run(&["stop", "--class", &format!("{class}:red")])
        .good();
    assert!(
        red.starts_with("anna: loop.js was stopped") && red.lines().count() == 1,
        "{red}"
    );
    assert_eq!(running.code(), Some(1));
    assert!(one.rests());
    let wrong = home.run(&["stop", "--class", &format!("{class}:green")]);
    assert_eq!(wrong.code(), 2);
    assert!(
        wrong
            .stderr
            .contains("no robot is in the group 'green': it has blue, red"),
        "{}",
        wrong.stderr
    );
    let list = home
        .run(&["class", "list", "--class", &format!("{class}:red")])
        .good();
    assert!(
        list.starts_with("anna  /") && list.ends_with("  red\n"),
        "{list}"
    );
}

#[test]
fn a_robot_that_is_killed_during_a_send_is_a_failure_of_its_own() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let (one, other) = (Reachable::beside(&home, &[]), Reachable::beside(&home, &[]));
    let class = class_of(&home, [&one, &other]);
    home.0.file("big.bin", vec![0xff; 15 << 20]);
    home.0.file("main.js", "script.wait(60000);");
    // A robot that is stopped takes what its socket holds, and no more: it is within the send when it dies.
    let (guardian, serving) = other.trikd();
    for pid in [guardian, serving] {
        processes::signal(pid, Signal::SIGSTOP);
        eventually("a standstill", || processes::is_stopped(pid));
    }
    let words = [
        "send", "big.bin", "main.js", "--class", &class, "--run", "main.js",
    ];
    let mut sending = Running::new(&mut home.command(&words));
    eventually("one has got it", || {
        sending.said().contains("anna: main.js is sent, 2 of 2")
    });
    for pid in [guardian, serving] {
        processes::signal(pid, Signal::SIGKILL);
    }
    assert_eq!(sending.code(), Some(1));
    let table = sending.said();
    assert!(table.contains("anna   2 of 2    main.js runs"), "{table}");
    assert!(table.contains("boris  0 of 2    FAILED: "), "{table}");
    assert!(table.contains("clara  0 of 2    FAILED: "), "{table}");
}
