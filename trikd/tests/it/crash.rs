//! The serving process is killed: motors rest, its program is gone, and another one serves.

use crate::rig::robot;
use harness::{eventually, processes};
use nix::sys::signal::Signal;

#[test]
fn a_killed_serving_process_leaves_rest_and_no_program_and_is_followed_by_another() {
    let robot = robot(&["--control-port", "18471", "--telemetry-port", "18472"]);
    let mut client = robot.client("control");
    client.send(
        "file:a:#!/bin/sh\n(setsid sleep 1000 >/dev/null 2>&1 &)\necho go\nexec sleep 1000\n",
    );
    client.send("run:a");
    client.until("print: go");
    let daemon = robot.daemon();
    let children = processes::children(daemon);
    assert!(!children.is_empty());
    robot.forget_rest();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || robot.has_rested());
    eventually("no program", || {
        children.iter().all(|pid| !processes::is_alive(*pid))
    });
    eventually("another one", || {
        robot.daemon() != daemon && std::net::TcpStream::connect(("127.0.0.1", 18471)).is_ok()
    });
    robot.client("control").sync();
    robot.expect_log("the serving process has crashed");
    let own = processes::children(robot.guardian());
    assert_eq!(own.len(), 1, "only the serving process is left");
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn the_serving_process_ends_with_its_guardian() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send("file:a:#!/bin/sh\necho go\nexec sleep 1000\n");
    client.send("run:a");
    client.until("print: go");
    let daemon = robot.daemon();
    let children = processes::children(daemon);
    robot.forget_rest();
    processes::signal(robot.guardian(), Signal::SIGKILL);
    eventually("the serving process ends", || !processes::is_alive(daemon));
    assert!(robot.has_rested());
    assert!(children.iter().all(|pid| !processes::is_alive(*pid)));
}

#[test]
fn a_program_that_stops_the_serving_process_is_ended_and_another_one_serves() {
    let robot = robot(&["--control-port", "18473", "--telemetry-port", "18474"]);
    let mut client = robot.client("control");
    client.send("file:a:#!/bin/sh\necho go\nwhile ! [ -e known ]; do sleep 0.01; done\nkill -STOP $PPID\nexec sleep 1000\n");
    client.send("run:a");
    client.until("print: go");
    let daemon = robot.daemon();
    let children = processes::children(daemon);
    robot.forget_rest();
    robot.home.file("scripts/known", "");
    eventually("no program", || {
        children.iter().all(|pid| !processes::is_alive(*pid))
    });
    eventually("rest", || robot.has_rested());
    eventually("another one", || {
        robot.daemon() != daemon && std::net::TcpStream::connect(("127.0.0.1", 18473)).is_ok()
    });
    robot.client("control").sync();
    robot.expect_log("was stopped with SIGSTOP");
    assert_eq!(robot.end(), Some(0));
}
