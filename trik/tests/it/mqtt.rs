//! `trik bridge mqtt` with a real broker, and clients of other people.
//!
//! Owns the broker. What a robot says is read by `mosquitto_sub`, and commands are sent by `mosquitto_pub`.

use crate::programs::{Reachable, Running};
use crate::rig::{Home, loopback};
use harness::{eventually, processes};
use needs::Need;
use nix::sys::signal::Signal;
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

const ROBOT: &str = "trik/7b/anna";
/// The port of each broker, at an address of its own.
const PORT: u16 = 1883;

/// A broker that is killed with the test.
struct Broker {
    process: Child,
    program: PathBuf,
    ip: String,
    config: String,
}

impl Broker {
    /// One with these lines in its configuration; None if it is not installed.
    fn new(home: &Home, more: &str) -> Option<Self> {
        let paths = std::env::var_os("PATH").unwrap_or_default();
        let places = std::env::split_paths(&paths).chain([Path::new("/usr/sbin").to_owned()]);
        let Some(program) = places
            .map(|place| place.join("mosquitto"))
            .find(|path| path.is_file())
        else {
            Need::Tools.missing("mosquitto is not installed");
            return None;
        };
        let ip = loopback();
        let text = format!("listener {PORT} {ip}\nuser root\n{more}\n");
        let file = home.0.file("broker.conf", text);
        let config = file.to_str().expect("UTF-8").to_owned();
        let process = started(&program, &config, &ip);
        Some(Self {
            process,
            program,
            ip,
            config,
        })
    }

    fn kill(&mut self) {
        self.process.kill().expect("killed");
        self.process.wait().expect("an end");
    }

    fn again(&mut self) {
        self.process = started(&self.program, &self.config, &self.ip);
    }

    fn client(&self, program: &str, words: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(["-h", &self.ip, "-p", &PORT.to_string(), "-V", "5"]);
        command.args(words);
        command
    }

    /// Somebody who hears all of the robot, with its topics.
    fn listener(&self, words: &[&str]) -> Running {
        let all = format!("{ROBOT}/#");
        let words = [words, &["-v", "-t", &all]].concat();
        Running::new(&mut self.client("mosquitto_sub", &words))
    }

    /// Says a power of the motor again and again, as one who drives, until it is seen.
    fn drives(&self, percent: &str, mut is_seen: impl FnMut() -> bool) {
        eventually("a motor that runs", || {
            self.says("set/motors/M3", percent, &[]);
            is_seen()
        });
    }

    fn says(&self, command: &str, text: &str, words: &[&str]) {
        let topic = format!("{ROBOT}/cmd/{command}");
        let words = [words, &["-t", &topic, "-m", text]].concat();
        let status = self.client("mosquitto_pub", &words).status();
        assert!(status.expect("mosquitto_pub").success(), "{command}");
    }

    fn bridge(&self, home: &Home, words: &[&str]) -> Running {
        let at = format!("{}:{PORT}", self.ip);
        let first = [
            "bridge", "mqtt", "--broker", &at, "--class", "7b", "--name", "anna",
        ];
        Running::new(&mut home.command(&[&first, words].concat()))
    }
}

fn started(program: &Path, config: &str, ip: &str) -> Child {
    let child = Command::new(program)
        .args(["-c", config])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("mosquitto");
    eventually("a broker", || TcpStream::connect((ip, PORT)).is_ok());
    child
}

impl Drop for Broker {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// The power of a motor, as its file says it.
fn power(robot: &Reachable) -> f64 {
    robot.robot.numbers("motors/M3/value")[0]
}

fn comes_to_rest(robot: &Reachable, when: &str) {
    eventually(when, || power(robot) == 0.0);
}

#[test]
fn a_broker_has_the_newest_values_and_one_who_goes_on_saying_so_drives() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let Some(broker) = Broker::new(home, "allow_anonymous true") else {
        return;
    };
    let words = ["--control", "--home-assistant", "--deadman", "5000"];
    let mut bridge = broker.bridge(home, &words);
    bridge.says(": connected");
    // A client that comes late is told what there is.
    let heard = broker.listener(&[]);
    heard.says("trik/7b/anna/life online");
    heard.says("tel/sensors/D1 {\"");
    broker.drives("40", || heard.said().contains("\"duty_cycle\":40"));
    heard.says("tel/motors/M3 {\"time\"");
    heard.says("answer {\"command\":\"set/motors/M3\",\"ok\":true}");
    // Nobody says anything more.
    comes_to_rest(&robot, "rest after a command that is not repeated");
    for (command, text, why) in [
        ("set/motors/M3", "NaN", "it takes a number"),
        ("set/motors/M3", "[1, 2]", "it takes a number"),
        ("set/motors/M3", "1000", "out of range"),
        ("set/sensors/D1", "1", "it only measures"),
        ("set/../secret", "1", "the tree has no such node"),
        ("parameter/sensors/D1/no", "1", "there is no such parameter"),
        ("run", "no.js", "no.js"),
        ("drive", "1", "there is no such command"),
    ] {
        broker.says(command, text, &[]);
        eventually(&format!("{command} {text}"), || {
            let said = heard.said();
            said.lines().any(|line| {
                line.contains(&format!("\"command\":\"{command}\""))
                    && line.contains("\"ok\":false")
                    && line.contains(why)
            })
        });
        assert_eq!(power(&robot), 0.0, "{command} {text}");
    }
    // What a broker keeps would come again.
    broker.says("set/motors/M3", "40", &["-r"]);
    heard.says("a retained command is not taken");
    broker.says("parameter/sensors/A1/poll_ms", "120", &[]);
    eventually("a parameter", || {
        robot
            .robot
            .read("sensors/A1/poll_ms")
            .is_ok_and(|text| text == "120")
    });
    let found = broker.client(
        "mosquitto_sub",
        &["-t", "homeassistant/#", "-C", "20", "-W", "80"],
    );
    let found = harness::tools::run(&mut { found }, b"").good();
    assert!(
        found.contains("\"availability_topic\":\"trik/7b/anna/life\""),
        "{found}"
    );
    // A client that goes on to drive after a stop is refused.
    broker.drives("30", || power(&robot) == 30.0);
    broker.says("stop", "", &[]);
    comes_to_rest(&robot, "rest after a stop");
    heard.says("answer {\"command\":\"stop\",\"ok\":true}");
    broker.says("set/motors/M3", "30", &[]);
    heard.says("motors/M3: it was stopped");
    assert_eq!(power(&robot), 0.0);
    processes::signal(bridge.pid(), Signal::SIGINT);
    assert_eq!(bridge.code(), Some(0), "{}", bridge.said());
    heard.says("trik/7b/anna/life offline");
}

#[test]
fn a_stop_is_for_everybody_and_an_end_of_any_part_brings_to_rest() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let Some(mut broker) = Broker::new(home, "allow_anonymous true") else {
        return;
    };
    let mut looks = broker.bridge(home, &[]);
    looks.says(": connected");
    let heard = broker.listener(&[]);
    heard.says("life online");
    broker.says("set/motors/M3", "40", &[]);
    heard.says("takes no command but stop");
    let mut runs = robot.spawn("go.js", crate::programs::LOOP);
    runs.says("drives");
    broker.says("stop", "", &[]);
    heard.says("answer {\"command\":\"stop\",\"ok\":true}");
    runs.code();
    comes_to_rest(&robot, "rest after a stop");
    // A second one of this name takes its place.
    let mut bridge = broker.bridge(home, &["--control", "--deadman", "60000"]);
    bridge.says(": connected");
    assert_eq!(looks.code(), Some(1));
    assert!(
        looks.said().contains("another bridge has come"),
        "{}",
        looks.said()
    );
    // The first one has looked for the mark of the second, for which it took its connection.
    eventually("the second one is back", || {
        bridge.said().matches(": connected").count() > 1
    });
    // The bridge dies.
    broker.says("set/motors/M3", "40", &[]);
    eventually("a motor that runs", || power(&robot) == 40.0);
    let ends = || heard.said().matches("life offline").count();
    let before = ends();
    processes::signal(bridge.pid(), Signal::SIGKILL);
    bridge.code();
    comes_to_rest(&robot, "rest after the death of the bridge");
    eventually("the will of the bridge", || ends() > before);
    // The broker dies.
    let bridge = broker.bridge(home, &["--control", "--deadman", "5000"]);
    bridge.says(": connected");
    broker.drives("40", || power(&robot) == 40.0);
    broker.kill();
    comes_to_rest(&robot, "rest after the death of the broker");
    bridge.says("it is tried again");
    broker.again();
    let heard = broker.listener(&[]);
    heard.says("life online");
    heard.says("tel/motors/M3 {");
    // The tree goes.
    drop(robot);
    heard.says("life offline");
    bridge.says("the tree is gone");
}

#[test]
fn a_broker_that_lets_nobody_in_and_names_that_mean_something_are_told() {
    let Some(robot) = Reachable::new() else {
        return;
    };
    let home = &robot.robot.home;
    let passwords = home.0.file("passwords", "");
    let secret = home.0.file("secret", "apple\nonly the first line counts\n");
    let made = Command::new("mosquitto_passwd")
        .args(["-b", passwords.to_str().expect("UTF-8"), "anna", "apple"])
        .status();
    if !made.is_ok_and(|status| status.success()) {
        Need::Tools.missing("mosquitto_passwd is not installed");
        return;
    }
    let config = format!(
        "allow_anonymous false\npassword_file {}",
        passwords.display()
    );
    let Some(broker) = Broker::new(home, &config) else {
        return;
    };
    let mut stranger = broker.bridge(home, &[]);
    assert_eq!(stranger.code(), Some(1));
    assert!(
        stranger.said().contains("does not let the bridge in"),
        "{}",
        stranger.said()
    );
    let secret = secret.to_str().expect("UTF-8");
    let anna = broker.bridge(home, &["--user", "anna", "--password-file", secret]);
    anna.says(": connected");
    for (words, why) in [
        (&["--class", "a/b"][..], "cannot be part of a topic"),
        (&["--name", "#"], "cannot be part of a topic"),
        (&["--broker", "mqtts://127.0.0.1"], "built without TLS"),
        (&["--ca", secret], "mqtts://"),
        (&["--broker", "http://b"], "mqtts://HOST"),
        (
            &["--user", "anna", "--password-file", "/nowhere"],
            "there is no such file",
        ),
    ] {
        let output = home.run(&[&["bridge", "mqtt"], words].concat());
        assert_ne!(output.code(), 0);
        assert!(output.stderr.contains(why), "{words:?}: {}", output.stderr);
    }
}
