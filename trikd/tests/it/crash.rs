//! The serving process is killed, or a process is stopped (SIGSTOP): motors rest, programs are gone, and robots are served.

use crate::diagrams::upload;
use crate::rig::robot;
use harness::{eventually, processes};
use lang_diagram::sketch::Sketch;
use nix::sys::signal::Signal;
use std::time::{Duration, Instant};

/// What is noticed within a second has this much on a machine that is busy.
const NOTICED: Duration = Duration::from_secs(60);

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

#[test]
fn a_guardian_that_is_stopped_is_noticed_and_goes_on_and_motors_rest() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.keep_alive();
    client.send("file:a:#!/bin/sh\necho go\nexec sleep 1000\n");
    client.send("run:a");
    client.until("print: go");
    let daemon = robot.daemon();
    let children = processes::children(daemon);
    robot.forget_rest();
    let begin = Instant::now();
    processes::signal(robot.guardian(), Signal::SIGSTOP);
    eventually("rest", || robot.has_rested());
    let rested = begin.elapsed();
    println!("rest {rested:?} after the guardian was stopped");
    assert!(rested < NOTICED, "{rested:?}");
    client.until("info: a was stopped by trikd, whose guardian stood still after ");
    assert!(children.iter().all(|pid| !processes::is_alive(*pid)));
    eventually("a guardian that goes on", || {
        !processes::is_stopped(robot.guardian())
    });
    assert_eq!(robot.daemon(), daemon);
    robot.expect_log("the guardian was stopped (SIGSTOP)");
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn a_program_that_is_stopped_is_ended_and_motors_rest() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.keep_alive();
    for (name, text) in [
        ("a", "#!/bin/sh\necho go\nexec sleep 1000\n"),
        ("b", "#!/bin/sh\nsleep 1000 &\necho go\nwait\n"),
    ] {
        client.send(&format!("file:{name}:{text}"));
        client.send(&format!("run:{name}"));
        client.until("print: go");
        let program = processes::children(robot.daemon())[0];
        let stopped = processes::children(program).first().copied();
        let stopped = stopped.unwrap_or(program);
        robot.forget_rest();
        let begin = Instant::now();
        processes::signal(stopped, Signal::SIGSTOP);
        eventually("rest", || robot.has_rested());
        let rested = begin.elapsed();
        println!("rest {rested:?} after process {stopped} of {name} was stopped");
        assert!(rested < NOTICED, "{rested:?}");
        let told = client.until(&format!("error: {name} was stopped after "));
        let why = format!(": its process {stopped} stood still (SIGSTOP)");
        assert!(told.ends_with(&why), "{told}");
        assert!(!processes::is_alive(program) && !processes::is_alive(stopped));
    }
}

#[test]
fn a_terminal_cannot_stop_what_guards_motors() {
    let robot = robot(&[]);
    let (daemon, mut client) = (robot.daemon(), robot.client("control"));
    for pid in [robot.guardian(), daemon] {
        processes::signal(pid, Signal::SIGTSTP);
    }
    robot.expect_log("what guards motors is not stopped");
    client.sync();
    assert!(!processes::is_stopped(daemon) && !processes::is_stopped(robot.guardian()));
    assert_eq!(robot.daemon(), daemon);
    assert_eq!(robot.end(), Some(0));
}

#[test]
fn a_motor_that_is_away_while_the_tree_comes_back_is_driven_when_it_is_there() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let forward = [("Ports", "M1"), ("Power", "40")];
    let forward = sketch.block("TrikV6EnginesForward", &forward);
    let wait = sketch.block("Timer", &[("Delay", "30")]);
    sketch.chain(&[start, forward, wait, forward]);
    let robot = robot(&[]);
    let mut client = robot.client("control");
    upload(&mut client, "drive.qrs", &sketch.qrs().expect("a save"));
    let [motor, away] = ["motors/M1", "away"].map(|name| robot.tree.join(name));
    std::fs::rename(&motor, &away).expect("the motor goes");
    client.send("run:drive.qrs");
    client.until("info: M1: ");
    std::fs::rename(&away, &motor).expect("the motor comes");
    let value = motor.join("value");
    let is_driven = || std::fs::read_to_string(&value).is_ok_and(|value| value.trim() == "40");
    eventually("a motor that is driven", is_driven);
}
