//! What is said to a person, and what is refused.

use crate::rig::{Home, Robot, robot};
use std::sync::Arc;

#[test]
fn the_ready_text_says_where_the_robot_is_and_every_command_in_it_works() {
    let Some(robot) = robot(&[]) else { return };
    let root = robot.root.display();
    assert!(
        robot
            .said()
            .starts_with(&format!("trik: the robot two-wheels is ready on {root} (")),
        "{}",
        robot.said()
    );
    let commands: Vec<&str> = robot
        .said()
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("  cd "))
        .collect();
    assert!(commands.len() >= 4, "{}", robot.said());
    for command in commands {
        let output = robot.sh(&format!("set -e\n{command}"));
        assert_eq!(output.stderr, "", "{command}");
        output.good();
    }
}

#[test]
fn a_mount_point_of_the_users_own_is_used_and_what_is_not_empty_is_refused() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let full = home.0.path("full");
    std::fs::create_dir_all(full.join("x")).unwrap();
    let refusal = home.run(&["up", "full"]);
    assert_eq!(refusal.code(), 1);
    assert_eq!(
        refusal.stderr,
        format!(
            "trik: {} is not empty: name an empty directory, or none\n",
            full.display()
        )
    );
    let robot = Robot::start(home.clone(), &["mine"]);
    assert_eq!(robot.root, home.0.path("mine"));
    let refusal = home.run(&["up", "mine"]);
    assert_eq!(refusal.code(), 1);
    assert!(
        refusal
            .stderr
            .contains("something is mounted there already"),
        "{}",
        refusal.stderr
    );
    drop(robot);
    assert!(!home.base().exists());
}

#[test]
fn what_cannot_be_is_refused_with_a_reason_and_leaves_nothing() {
    let Some(home) = Home::new() else { return };
    home.0.file("bad.lua", "trikfs = { x = 3 }");
    for (words, code, reason) in [
        (
            &["up", "--robot", "tank"] as &[&str],
            2,
            "there is no such robot",
        ),
        (&["up", "--speed", "0"], 2, "not a number from 0.1 to 20"),
        (
            &["up", "--config", "none.lua"],
            1,
            "trik: none.lua: no such configuration\n",
        ),
        (&["up", "--config", "bad.lua"], 1, "bad.lua:1: "),
        (
            &["fault", "D1", "unplug"],
            1,
            "trik: no robot of yours runs: start one with trik up\n",
        ),
        (
            &["fault", "D9", "unplug"],
            1,
            "trik: there is no device 'D9'",
        ),
        (
            &["fault", "D1", "explode"],
            1,
            "trik: there is no fault 'explode' here; possible are ",
        ),
    ] {
        let output = home.run(words);
        assert_eq!(output.code(), code, "{words:?}: {}", output.stderr);
        assert!(
            output.stderr.contains(reason),
            "{words:?}: {}",
            output.stderr
        );
        assert!(!home.base().exists(), "{words:?}");
    }
}

#[test]
fn without_a_terminal_there_are_no_control_characters() {
    let Some(robot) = robot(&[]) else { return };
    let said = robot.said();
    assert!(
        said.chars().all(|c| c == '\n' || !c.is_control()),
        "{said:?}"
    );
}
