//! The log of the daemon, and what clients cannot do to it.

use crate::rig::{Robot, robot};
use harness::eventually;

/// Lines about this, without the time.
fn lines(robot: &Robot, part: &str) -> Vec<String> {
    let log = robot.log();
    log.lines()
        .filter(|line| line.contains(part))
        .map(|line| line.splitn(3, ' ').nth(2).unwrap_or_default().to_owned())
        .collect()
}

#[test]
fn the_life_of_a_program_and_of_a_client_is_told() {
    let robot = robot(&[]);
    let mut client = robot.client("control");
    client.send("file:a.py:1/0");
    client.send("run:a.py");
    client.until("info: a.py has failed");
    client.send("file:../b.py:x");
    client.until("error: ");
    let peer = client.stream.local_addr().expect("an address");
    drop(client);
    eventually("the end of the client", || {
        !lines(&robot, "has left").is_empty()
    });
    for told in [
        format!("info clients: control: {peer} has come"),
        format!("is uploaded by {peer}"),
        "info programs: a.py starts as process".to_owned(),
        "warning programs: a.py has failed with exit code 1".to_owned(),
        format!("warning programs: an upload by {peer} is refused: '../b.py' cannot be"),
        format!("info clients: control: {peer} has left: closed by the client"),
    ] {
        robot.expect_log(&told);
        assert_eq!(lines(&robot, &told).len(), 1, "{told}:\n{}", robot.log());
    }
    assert!(lines(&robot, "asks: run").is_empty());
}

#[test]
fn levels_choose_what_is_told() {
    let robot = robot(&["--log", "off,clients=debug"]);
    let mut client = robot.client("control");
    client.send("file:a.py:print(1)");
    client.send("run:a.py");
    client.until("info: a.py has ended");
    robot.expect_log("asks: run:a.py");
    assert_eq!(lines(&robot, "asks: run:a.py").len(), 1);
    assert!(
        robot.log().lines().all(|line| line.contains(" clients: ")),
        "{}",
        robot.log()
    );
}

#[test]
fn a_client_writes_no_lines_of_its_own() {
    let robot = robot(&["--log", "debug"]);
    let mut client = robot.client("control");
    client.send("file:x\ntrikd: 1.0 error daemon: \u{1b}[31mforged\u{202e}\u{2028}:x");
    client.until("error: ");
    client.send("run:\r\nforged");
    client.until("error: ");
    eventually("lines", || lines(&robot, "forged").len() >= 2);
    for line in robot.log().lines() {
        assert!(line.starts_with("trikd: "), "{line:?}");
        assert!(!line.starts_with("trikd: 1.0 "), "{line:?}");
        assert!(
            !line.contains(|c: char| c.is_control() || c == '\u{202e}' || c == '\u{2028}'),
            "{line:?}"
        );
    }
}

#[test]
fn a_flood_of_connections_is_a_few_lines() {
    let robot = robot(&[]);
    for _ in 0..300 {
        drop(robot.client("telemetry"));
    }
    let mut client = robot.client("control");
    client.sync();
    eventually("nobody else", || {
        robot.status().contains("\nconnections 1 of ")
    });
    let told = lines(&robot, "clients: ").len();
    // Two for each would be 600; the time that this takes brings some more than come at once.
    assert!((100..=200).contains(&told), "{told} lines");
    // About programs there is still something to say.
    client.send("file:a.py:print(1)");
    client.send("run:a.py");
    client.until("info: a.py has ended");
    eventually("both lines", || lines(&robot, "programs: a.py").len() == 2);
}
