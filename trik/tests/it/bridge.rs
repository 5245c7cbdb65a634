//! `trik bridge`: tools of other people see a robot, and that it is gone.

use crate::rig::{Home, Robot};
use harness::eventually;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::time::Duration;

/// A bridge that serves, and is asked to end by SIGINT.
struct Bridge {
    child: Child,
    address: String,
}

impl Bridge {
    fn start(home: &Home, more: &[&str]) -> Self {
        let words = ["bridge", "prometheus", "--port", "0"];
        let mut command = home.command(&[&words[..], more].concat());
        let mut child = command.stdout(Stdio::piped()).spawn().expect("trik bridge");
        let mut line = String::new();
        let out = child.stdout.as_mut().expect("its output");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let rest = line.split_once("http://").expect("an address").1;
        let address = rest.split('/').next().expect("an address").to_owned();
        Self { child, address }
    }

    /// The text, or nothing.
    fn text(&self) -> String {
        let mut text = String::new();
        let mut client = TcpStream::connect(&self.address).expect("a server");
        let most = Some(Duration::from_secs(10));
        client.set_read_timeout(most).expect("a limit");
        let request = b"GET /metrics HTTP/1.1\r\nHost: robot\r\n\r\n";
        client.write_all(request).expect("sent");
        client.read_to_string(&mut text).expect("an answer");
        text
    }

    fn end(mut self) {
        let pid = Pid::from_raw(i32::try_from(self.child.id()).expect("a pid"));
        kill(pid, Signal::SIGINT).expect("SIGINT");
        assert!(self.child.wait().expect("an end").success());
    }
}

/// The number of a series.
fn number(text: &str, series: &str) -> Option<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(series))?;
    line.trim().parse().ok()
}

#[test]
fn prometheus_sees_a_robot_drive_and_go() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let robot = Robot::start(home.clone(), &[]);
    let bridge = Bridge::start(&home, &[]);
    robot.drive(30, 40);
    eventually("a power that is told", || {
        let text = bridge.text();
        number(
            &text,
            r#"trikfs_value{node="motors/M4",field="duty_cycle",unit="%"}"#,
        ) == Some(40.0)
    });
    let text = bridge.text();
    assert_eq!(number(&text, "trikfs_up"), Some(1.0), "{text}");
    assert!(text.contains("trikfs_rate_hertz{name="), "{text}");
    let root = robot.root.to_str().expect("UTF-8");
    let named = Bridge::start(&home, &["--robot", root]);
    let text = named.text();
    assert_eq!(number(&text, "trikfs_up"), Some(1.0), "{text}");
    named.end();
    let mut nowhere = home.command(&["bridge", "prometheus", "--robot", "/nowhere"]);
    let refused = harness::tools::run(&mut nowhere, b"");
    assert_ne!(refused.code(), 0);
    assert!(refused.stderr.contains("/nowhere"), "{}", refused.stderr);
    drop(robot);
    eventually("a tree that is gone", || {
        let text = bridge.text();
        number(&text, "trikfs_up") == Some(0.0) && !text.contains("trikfs_value{")
    });
    bridge.end();
}
