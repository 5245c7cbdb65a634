//! `trik bridge`: tools of other people see a robot, and that it is gone.

use crate::programs::Reachable;
use crate::rig::{Home, Robot};
use harness::eventually;
use harness::wait::SOON;
use lang_diagram::sketch::Sketch;
use needs::Need;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// A bridge that serves, and is asked to end by SIGINT.
struct Bridge {
    child: Child,
    address: String,
}

impl Bridge {
    fn start(home: &Home, more: &[&str]) -> Self {
        Self::of(home, "prometheus", more)
    }

    fn of(home: &Home, which: &str, more: &[&str]) -> Self {
        let words = ["bridge", which, "--port", "0"];
        let mut command = home.command(&[&words[..], more].concat());
        let mut child = command.stdout(Stdio::piped()).spawn().expect("trik bridge");
        let mut line = String::new();
        let out = child.stdout.as_mut().expect("its output");
        BufReader::new(out).read_line(&mut line).expect("a line");
        let rest = line.split_once("://").expect("an address").1;
        let address = rest
            .split(['/', ';'])
            .next()
            .expect("an address")
            .to_owned();
        Self { child, address }
    }

    /// The text, or nothing.
    fn text(&self) -> String {
        let mut text = String::new();
        let mut client = TcpStream::connect(&self.address).expect("a server");
        client.set_read_timeout(Some(SOON)).expect("a limit");
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

/// One that a failed test leaves does not outlive it.
impl Drop for Bridge {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
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

/// A client of Foxglove's own libraries, and what it tells.
struct Client {
    child: Child,
    orders: ChildStdin,
    lines: Receiver<String>,
    told: Vec<String>,
}

impl Client {
    /// None if the libraries are not there.
    fn new(address: &str) -> Option<Self> {
        let Some(modules) = std::env::var_os("TRIK_MCAP_NODE") else {
            Need::Extra.missing("TRIK_MCAP_NODE is not set");
            return None;
        };
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/foxglove.mjs");
        let mut child = Command::new("node")
            .args([script, &format!("ws://{address}")])
            .env("TRIK_MCAP_NODE", modules)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("node");
        let (out, orders) = (child.stdout.take(), child.stdin.take());
        let (send, lines) = channel();
        std::thread::spawn(move || {
            let lines = BufReader::new(out.expect("its output")).lines();
            for line in lines.map_while(Result::ok) {
                let _ = send.send(line);
            }
        });
        Some(Self {
            child,
            orders: orders.expect("its input"),
            lines,
            told: Vec::new(),
        })
    }

    /// Asks for something; what was told before counts no more.
    fn order(&mut self, order: &str) {
        self.told.clear();
        writeln!(self.orders, "{order}").expect("an order");
    }

    /// Waits for a line with all of these since the last order.
    fn tells(&mut self, parts: &[&str]) -> String {
        let mut found = None;
        eventually(&format!("{parts:?} from a client"), || {
            let over = loop {
                match self.lines.try_recv() {
                    Ok(line) => self.told.push(line),
                    Err(why) => break why == TryRecvError::Disconnected,
                }
            };
            let has_all = |line: &&String| parts.iter().all(|part| line.contains(part));
            found = self.told.iter().find(has_all).cloned();
            assert!(
                found.is_some() || !over,
                "the client ended before {parts:?}"
            );
            found.is_some()
        });
        found.unwrap_or_default()
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A diagram that counts, and never ends.
fn counting() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let begin = sketch.block("Function", &[("Body", "n = 1")]);
    let wait = sketch.block("Timer", &[("Delay", "100")]);
    let again = sketch.block("Timer", &[("Delay", "100")]);
    sketch.chain(&[start, begin, wait, again, wait]);
    sketch.qrs().expect("a save")
}

/// Parameters are set, refused, and told when somebody else changes them.
fn changes_parameters(client: &mut Client, reachable: &Reachable) {
    client.order("watch sensors/A2/poll_ms");
    client.order("set sensors/A1/poll_ms 50");
    client.tells(&[
        r#""id":"told""#,
        r#"{"name":"sensors/A1/poll_ms","value":50}"#,
    ]);
    assert_eq!(reachable.robot.number("sensors/A1/poll_ms"), 50.0);
    client.order("set ../secret 1");
    client.tells(&[r#""what":"status""#, "no such parameter"]);
    // A change that somebody else makes.
    reachable
        .robot
        .write("sensors/A2/poll_ms", "40")
        .expect("a period");
    client.tells(&[r#"{"name":"sensors/A2/poll_ms","value":40}"#]);
}

/// A diagram runs, its variable is read and set, it is stopped and run again.
fn runs_programs(client: &mut Client, reachable: &Reachable) {
    client.order("call /run none.js");
    client.tells(&[r#""what":"failed""#, "none.js"]);
    let running = reachable.spawn("count.qrs", counting());
    eventually("a variable", || {
        client.order("get diagram/n");
        let told = client.tells(&[r#""id":"asked""#]);
        told.contains(r#"{"name":"diagram/n","value":1}"#)
    });
    // What programs do is a channel as soon as there is some of it.
    client.order("subscribe /diagram");
    client.tells(&[r#""topic":"/diagram""#]);
    client.order("set diagram/n 7");
    client.tells(&[r#""id":"told""#, r#"{"name":"diagram/n","value":7}"#]);
    client.tells(&[r#""topic":"/diagram""#, r#"\"n\""#]);
    client.order("subscribe /programs");
    client.order("call /stop");
    client.tells(&[r#""what":"done""#]);
    client.order("call /run count.qrs");
    client.tells(&[r#""what":"done""#]);
    client.tells(&[r#""topic":"/programs""#, "count.qrs has started"]);
    drop(running);
}

#[test]
fn a_client_of_foxglove_sees_a_robot_changes_it_and_sees_it_go_and_come_back() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let reachable = Reachable::beside(&home, &[]);
    let bridge = Bridge::of(&home, "foxglove", &[]);
    let Some(mut client) = Client::new(&bridge.address) else {
        bridge.end();
        return;
    };
    client.tells(&[r#""what":"info""#, "services"]);
    client.tells(&[
        r#""what":"channels""#,
        "/motors/M3",
        "trik_msgs/msg/MotorsM3",
        "/ros/odometry",
    ]);
    client.order("graph");
    client.tells(&[r#""what":"graph""#, r#""name":"/motors/M3""#, "/stop"]);
    client.order("subscribe /battery");
    client.order("subscribe /motors/M3");
    // What it had long before comes at once, and then what is new.
    client.tells(&[r#""topic":"/motors/M3""#, r#""duty_cycle":0"#]);
    client.tells(&[r#""what":"graph""#, "subscriberIds"]);
    reachable.robot.drive(40, 40);
    client.tells(&[r#""topic":"/motors/M3""#, r#""duty_cycle":40"#]);
    client.order("call /stop");
    client.tells(&[r#""what":"done""#]);
    assert!(reachable.rests(), "a stop is done when all rests");
    client.tells(&[r#""duty_cycle":0"#]);
    client.tells(&[r#""what":"time""#]);
    changes_parameters(&mut client, &reachable);
    runs_programs(&mut client, &reachable);
    client.order("text nothing");
    client.tells(&[r#""what":"status""#, "must be a JSON object with 'op'"]);
    client.order("bytes ffff");
    client.tells(&[r#""what":"status""#, "an unknown binary message"]);
    let root = reachable.robot.root.clone();
    drop(reachable);
    client.tells(&[r#""what":"gone""#, "/motors/M3"]);
    client.tells(&[r#""what":"status""#, "the robot is gone"]);
    // It answers without a robot too.
    client.order("text again");
    client.tells(&[r#""what":"status""#, "must be a JSON object with 'op'"]);
    let back = Robot::start(home.clone(), &[root.to_str().expect("UTF-8")]);
    client.tells(&[r#""what":"removeStatus""#, "robot"]);
    client.tells(&[r#""topic":"/battery""#]);
    drop(back);
    drop(client);
    bridge.end();
}
