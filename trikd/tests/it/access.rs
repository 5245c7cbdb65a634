//! The allow-list and pairing, with clients that know of neither.

use crate::rig::{robot, trikd};
use std::io::Read;
use std::process::Command;

#[test]
fn computers_that_the_list_lacks_are_not_served() {
    let robot = robot(&["--allow", "10.0.0.0/8"]);
    for port in [
        "control",
        "telemetry",
        "mailbox",
        "gamepad",
        "video",
        "variables",
    ] {
        let mut client = robot.client(port);
        let mut bytes = Vec::new();
        let end = client.stream.read_to_end(&mut bytes);
        assert!(end.is_err() || bytes.is_empty(), "{port}");
    }
    robot.expect_log("is not in the list of --allow");
    let other = crate::rig::robot(&["--allow", "10.0.0.0/8", "--allow", "127.0.0.1"]);
    other.client("control").sync();
}

#[test]
fn an_unpaired_computer_may_look_and_stop_and_may_run_programs_when_it_is_paired() {
    let robot = robot(&["--pair"]);
    let mut client = robot.client("control");
    client.send("configVersion");
    client.expect("configVersion: model-2015");
    for request in [
        "file:a.py:print(1)",
        "run:a.py",
        "direct:1",
        "directScript:1",
    ] {
        client.send(request);
        let told = client.next().unwrap();
        assert!(
            told.starts_with("error: this computer is not paired"),
            "{told}"
        );
    }
    assert!(!robot.home.path("scripts/a.py").exists());
    robot.forget_rest();
    client.send("stop");
    harness::eventually("rest", || robot.has_rested());
    let pair = |address: &str| {
        let output = Command::new(trikd())
            .args(["pair", address, "--run"])
            .arg(robot.home.path("run"))
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert_eq!(pair("127.0.0.1"), "paired 127.0.0.1\n");
    client.send("file:a.py:print(1)");
    client.send("run:a.py");
    client.until("print: 1\n");
    assert!(
        robot.status().contains("paired computers: 127.0.0.1"),
        "{}",
        robot.status()
    );
    assert_eq!(robot.home.content("state/paired"), b"127.0.0.1\n");
}

#[test]
fn a_pairing_code_is_given_out_where_the_robot_is_and_only_if_it_pairs() {
    let code = |robot: &crate::rig::Robot, words: &[&str]| {
        let output = Command::new(trikd())
            .arg("pair")
            .args(words)
            .arg("--run")
            .arg(robot.home.path("run"))
            .output()
            .unwrap();
        let texts = [output.stdout, output.stderr];
        let [said, why] = texts.map(|text| String::from_utf8_lossy(&text).into_owned());
        (said.trim().to_owned(), why)
    };
    let (said, why) = code(&robot(&["--pair"]), &["--code"]);
    assert!(
        said.len() == 6 && said.parse::<u32>().is_ok(),
        "{said} {why}"
    );
    let open = robot(&[]);
    let (said, why) = code(&open, &["--code"]);
    assert!(said.is_empty() && why.contains("pairing is off"), "{why}");
    for words in [&["--code", "10.0.0.1"][..], &[]] {
        let (said, why) = code(&open, words);
        assert!(said.is_empty() && why.contains("ADDRESS"), "{why}");
    }
}
