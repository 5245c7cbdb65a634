//! Mistakes of trikd itself: one costs its own connection or wish, is told and counted, and everything else goes on.

use crate::rig::{BUILT, Robot, small_tree, trikd};
use harness::wait::note_skip;
use harness::{eventually, processes};
use std::io::{Read, Write};
use std::net::TcpStream;

/// A robot whose parts fail when a test wants it; None for a build that cannot.
fn fragile(words: &[&str]) -> Option<Robot> {
    if trikd() != BUILT || !cfg!(debug_assertions) {
        note_skip("a build without assertions has no way to fail");
        return None;
    }
    let home = small_tree();
    let tree = home.path("tree");
    Some(Robot::start_with(
        home,
        tree,
        words,
        &[("TRIKD_PANIC", "control,rest,page")],
    ))
}

#[test]
fn a_task_that_fails_ends_alone_and_is_counted() {
    let Some(robot) = fragile(&[]) else { return };
    let daemon = robot.daemon();
    let mut other = robot.client("control");
    other.sync();
    assert!(
        robot.status().contains("\npanics 0 caught\n"),
        "{}",
        robot.status()
    );
    for count in 1..=2 {
        let mut client = robot.client("control");
        client.send("panic");
        assert_eq!(client.next(), None);
        let told = format!("\npanics {count} caught\n");
        assert!(robot.status().contains(&told), "{}", robot.status());
    }
    robot.expect_log(
        "a mistake of trikd, please report it: panic in the thread 'main' at trikd/src/panics.rs",
    );
    other.sync();
    eventually("their places", || {
        robot.status().contains("\nconnections 1 of ")
    });
    assert_eq!(robot.daemon(), daemon);
}

#[test]
fn the_thread_that_brings_motors_to_rest_begins_again() {
    let Some(robot) = fragile(&[]) else { return };
    let daemon = robot.daemon();
    let fails = robot.home.file("tree/panic", "");
    let mut client = robot.client("control");
    client.keep_alive();
    client.send("stop");
    client.until("error: the tree has not brought the motors to rest");
    assert!(
        !robot.status().contains("\npanics 0 caught\n"),
        "{}",
        robot.status()
    );
    std::fs::remove_file(fails).expect("a file");
    robot.forget_rest();
    client.send("stop");
    client.send("status");
    client.until("status: ");
    assert!(robot.has_rested());
    assert_eq!(processes::threads_named(daemon, "rest"), 1);
    assert_eq!(robot.daemon(), daemon);
}

#[test]
fn the_thread_that_serves_the_page_begins_again() {
    let Some(robot) = fragile(&["--page-port", "0"]) else {
        return;
    };
    let daemon = robot.daemon();
    let port = robot.port("page");
    let ask = || {
        let mut stream = TcpStream::connect(("127.0.0.1", port)).expect("a connection");
        let request = format!("GET /plain HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\n\r\n");
        // It may be cut already.
        let _ = stream.write_all(request.as_bytes());
        let mut answer = String::new();
        let _ = stream.read_to_string(&mut answer);
        answer
    };
    assert!(ask().starts_with("HTTP/1.0 200 "));
    let fails = robot.home.file("tree/panic", "");
    assert_eq!(ask(), "");
    assert!(
        robot.status().contains("\npanics 1 caught\n"),
        "{}",
        robot.status()
    );
    robot.expect_log("panic in the thread 'page' at ");
    std::fs::remove_file(fails).expect("a file");
    let answer = ask();
    assert!(answer.starts_with("HTTP/1.0 200 "), "{answer}");
    assert_eq!(processes::threads_named(daemon, "page"), 1);
    assert_eq!(robot.daemon(), daemon);
}
