//! How a robot ends: every way leaves nothing behind and actuators at rest.

use crate::rig::{Home, Robot, robot};
use harness::{board, eventually, processes};
use nix::sys::signal::Signal;
use std::sync::Arc;

/// A robot that drives.
fn moving() -> Option<Robot> {
    let robot = robot(&[])?;
    robot.drive(30, 30);
    assert_ne!(robot.duty(3).expect("the bus"), 0);
    assert_ne!(robot.duty(4).expect("the bus"), 0);
    Some(robot)
}

/// The motors have come to rest, by their bytes on the bus.
fn rests(robot: &Robot) -> bool {
    [1, 2, 3, 4]
        .iter()
        .all(|&motor| robot.duty(motor).expect("the bus") == 0)
}

/// The tree is served again, by new processes.
fn comes_back(robot: &Robot, before: u32) {
    // What the old daemon still answers says nothing.
    eventually("the end of the old daemon", || !processes::is_alive(before));
    eventually("the tree again", || robot.errno("motors/M3/value") == 0);
    robot.drive(20, 20);
    assert_ne!(robot.duty(3).expect("the bus"), 0);
}

#[test]
fn each_signal_that_ends_a_program_leaves_no_mount_no_process_and_no_directory() {
    for signal in [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP] {
        let Some(mut robot) = moving() else { return };
        let (guardian, daemon) = (robot.guardian(), robot.daemon());
        let status = robot.end(signal);
        assert_eq!(status.code(), Some(0), "{signal}: {}", robot.complaints());
        assert!(!processes::is_alive(guardian) && !processes::is_alive(daemon));
        robot.leaves_nothing();
        assert!(!robot.home.base().exists());
    }
}

#[test]
fn an_unmount_by_somebody_else_ends_everything() {
    let Some(mut robot) = moving() else { return };
    let done = std::process::Command::new("umount")
        .arg(&robot.root)
        .status();
    assert!(done.expect("umount").success());
    assert_eq!(robot.wait().code(), Some(0), "{}", robot.complaints());
    robot.leaves_nothing();
}

#[test]
fn a_program_that_has_a_file_open_hears_of_the_end_and_does_not_delay_it() {
    let Some(mut robot) = moving() else { return };
    let mut reader = std::process::Command::new("sh")
        .args(["-c", "exec 3<> \"$1\"; exec cat sensors/D1/device", "sh"])
        .arg(robot.path("motors/M3/value"))
        .current_dir(&robot.root)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .expect("a program");
    eventually("a program in the tree", || {
        processes::is_asleep(reader.id())
    });
    assert_eq!(
        robot.end(Signal::SIGINT).code(),
        Some(0),
        "{}",
        robot.complaints()
    );
    eventually("the end of the program", || {
        reader.try_wait().expect("a child").is_some()
    });
    robot.leaves_nothing();
}

#[test]
fn after_a_kill_of_the_daemon_motors_rest_and_the_tree_comes_back() {
    let Some(robot) = moving() else { return };
    let daemon = robot.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || rests(&robot));
    comes_back(&robot, daemon);
    robot.complains("killed by SIGKILL; starting it again");
}

#[test]
fn after_a_kill_of_the_guardian_motors_rest_and_the_tree_comes_back() {
    let Some(robot) = moving() else { return };
    let (guardian, daemon) = (robot.guardian(), robot.daemon());
    processes::signal(guardian, Signal::SIGKILL);
    eventually("rest", || rests(&robot));
    eventually("the end of both", || {
        !processes::is_alive(guardian) && !processes::is_alive(daemon)
    });
    comes_back(&robot, daemon);
    robot.complains("the guardian of the tree was ended by signal: 9");
}

#[test]
fn after_kills_of_daemon_and_guardian_in_turn_motors_rest_each_time() {
    let Some(robot) = moving() else { return };
    for pid in [Robot::daemon, Robot::guardian, Robot::daemon] {
        let (victim, daemon) = (pid(&robot), robot.daemon());
        robot.drive(30, 30);
        processes::signal(victim, Signal::SIGKILL);
        eventually("rest", || rests(&robot));
        comes_back(&robot, daemon);
    }
}

#[test]
fn after_a_kill_of_both_at_once_motors_rest_before_the_tree_is_there_again() {
    let Some(robot) = moving() else { return };
    let (guardian, daemon) = (robot.guardian(), robot.daemon());
    // Stopped first, the guardian cannot do anything about the daemon's death.
    processes::signal(guardian, Signal::SIGSTOP);
    eventually("a standstill", || processes::is_stopped(guardian));
    processes::signal(daemon, Signal::SIGKILL);
    processes::signal(guardian, Signal::SIGKILL);
    eventually("the end of both", || {
        !processes::is_alive(guardian) && !processes::is_alive(daemon)
    });
    eventually("the tree again", || robot.errno("motors/M3/value") == 0);
    assert!(rests(&robot), "{}", robot.complaints());
}

#[test]
fn a_kill_of_trik_itself_unmounts_and_the_next_start_removes_the_board() {
    let Some(mut robot) = moving() else { return };
    let (guardian, daemon) = (robot.guardian(), robot.daemon());
    assert_eq!(robot.end(Signal::SIGKILL).code(), None);
    eventually("the end of the processes", || {
        !processes::is_alive(guardian) && !processes::is_alive(daemon)
    });
    assert!(board::mounts_below(&robot.root).is_empty());
    assert!(robot.devices.exists());
    let next = Robot::start(robot.home.clone(), &[]);
    assert_eq!(next.root, robot.root);
    drop(next);
    robot.leaves_nothing();
}

#[test]
fn after_the_death_of_all_processes_at_once_the_next_start_takes_the_place_over() {
    let Some(mut robot) = moving() else { return };
    let all = [robot.pid(), robot.guardian(), robot.daemon()];
    // Stopped first, none can clean up after the others.
    for pid in all {
        processes::signal(pid, Signal::SIGSTOP);
    }
    eventually("a standstill", || {
        all.iter().all(|&pid| processes::is_stopped(pid))
    });
    // The children first: a stopped process that loses its parent is continued by the kernel.
    for pid in [all[2], all[1]] {
        processes::signal(pid, Signal::SIGKILL);
    }
    robot.end(Signal::SIGKILL);
    eventually("the end of the processes", || {
        all.iter().all(|&pid| !processes::is_alive(pid))
    });
    assert!(!board::mounts_below(&robot.root).is_empty());
    // The record may be gone as well.
    std::fs::remove_file(robot.devices.with_extension("lock")).expect("a record");
    let next = Robot::start(robot.home.clone(), &[]);
    assert_eq!(next.root, robot.root);
    assert_eq!(next.errno("motors/M3/value"), 0);
    drop(next);
    robot.leaves_nothing();
}

#[test]
fn two_robots_live_side_by_side_and_end_one_by_one() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let one = Robot::start(home.clone(), &[]);
    let other = Robot::start(home.clone(), &[]);
    assert_ne!(one.root, other.root);
    one.drive(30, 30);
    assert_ne!(one.duty(3).expect("the bus"), 0);
    assert_eq!(other.duty(3).expect("the bus"), 0);
    let refusal = home.run(&["fault", "D1", "unplug"]);
    assert_eq!(refusal.code(), 1);
    assert!(
        refusal
            .stderr
            .starts_with("trik: several robots run: say which with --robot; there are "),
        "{}",
        refusal.stderr
    );
    drop(one);
    assert_eq!(other.errno("motors/M3/value"), 0);
    home.run(&["fault", "D1", "unplug"]).good();
    drop(other);
    assert!(!home.base().exists());
}
