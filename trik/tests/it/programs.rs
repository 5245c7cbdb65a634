//! Programs that come over the network to virtual robots: `trik run`, `stop`, `status`, `send`, and trikd behind them.
//!
//! Every robot has an address of its own, so that all have the ports that clients know.

mod dataflow;
mod fleet;
mod pretended;

use crate::rig::{Home, Robot, loopback};
use harness::{Output, eventually, processes};
use lang_diagram::sketch::Sketch;
use nix::sys::signal::Signal;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;

/// Drives until it is stopped.
pub const LOOP: &str = "brick.motor(M3).setPower(40); brick.motor(M4).setPower(40);\n\
                    print('drives');\nwhile (true) script.wait(50);\n";

/// A robot that takes programs, and where.
pub struct Reachable {
    pub robot: Robot,
    ip: String,
}

impl Reachable {
    /// A robot in a home of its own; None if nothing can be mounted here.
    pub fn new() -> Option<Self> {
        Some(Self::beside(&Arc::new(Home::new()?), &[]))
    }

    pub fn beside(home: &Arc<Home>, words: &[&str]) -> Self {
        let ip = loopback();
        let mut all = vec!["--trikd-address", &ip];
        all.extend(words);
        let robot = Robot::start(home.clone(), &all);
        Self { robot, ip }
    }

    /// One in a home of its own, whose programs find what is in this directory first.
    pub fn with(bin: &std::path::Path) -> Option<Self> {
        let ip = loopback();
        let home = Arc::new(Home::new()?);
        let robot = Robot::start_with(home, &["--trikd-address", &ip], bin);
        Some(Self { robot, ip })
    }

    /// Writes a program and runs it here.
    pub fn run(&self, name: &str, text: impl AsRef<[u8]>) -> Output {
        let file = self.robot.home.0.file(name, text);
        let file = file.to_str().expect("UTF-8");
        self.robot.home.run(&["run", file, "--robot", &self.ip])
    }

    /// Its address.
    pub fn ip(&self) -> &str {
        &self.ip
    }

    /// Starts a program that is there.
    pub fn spawn_file(&self, file: &str) -> Running {
        Running::new(&mut self.robot.home.command(&["run", file, "--robot", &self.ip]))
    }

    /// The same, and each save of it changes what runs.
    pub fn watch_file(&self, file: &str) -> Running {
        let words = ["run", file, "--watch", "--robot", &self.ip];
        Running::new(&mut self.robot.home.command(&words))
    }

    /// Writes a program and starts it.
    pub fn spawn(&self, name: &str, text: impl AsRef<[u8]>) -> Running {
        let file = self.robot.home.0.file(name, text);
        self.spawn_file(file.to_str().expect("UTF-8"))
    }

    /// Starts a program that drives, and waits until it does.
    fn start(&self, name: &str) -> Running {
        let running = self.spawn(name, LOOP);
        eventually("a robot that drives", || {
            running.said().contains("drives") && self.robot.duty(3).is_ok_and(|duty| duty != 0)
        });
        running
    }

    /// Whether both motors are off.
    pub fn rests(&self) -> bool {
        [3, 4]
            .iter()
            .all(|&motor| self.robot.duty(motor).is_ok_and(|duty| duty == 0))
    }

    /// The guardian of its trikd, and the process that serves.
    pub fn trikd(&self) -> (u32, u32) {
        let mut found = None;
        eventually("the processes of trikd", || {
            let is_trikd = |pid: &u32| {
                std::fs::read(format!("/proc/{pid}/cmdline"))
                    .is_ok_and(|words| words.starts_with(b"trikd\0"))
            };
            let guardian = processes::children(self.robot.pid())
                .into_iter()
                .find(is_trikd);
            let serving =
                guardian.and_then(|pid| processes::children(pid).into_iter().find(is_trikd));
            found = guardian.zip(serving);
            found.is_some()
        });
        found.unwrap_or_default()
    }
}

/// A `trik run` that is still there.
pub struct Running {
    child: Child,
    said: Arc<Mutex<String>>,
    readers: [JoinHandle<()>; 2],
}

impl Running {
    pub fn new(command: &mut Command) -> Self {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("trik");
        let said = Arc::new(Mutex::new(String::new()));
        let pipes: [Box<dyn Read + Send>; 2] = [
            Box::new(child.stdout.take().expect("a pipe")),
            Box::new(child.stderr.take().expect("a pipe")),
        ];
        let readers = pipes.map(|pipe| {
            let said = said.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(pipe).lines().map_while(Result::ok) {
                    let mut all = said.lock().unwrap_or_else(PoisonError::into_inner);
                    all.push_str(&format!("{line}\n"));
                }
            })
        });
        Self {
            child,
            said,
            readers,
        }
    }

    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    /// Both outputs so far.
    pub fn said(&self) -> String {
        self.said
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    pub fn says(&self, text: &str) {
        eventually(text, || self.said().contains(text));
    }

    /// How it ended; [`Running::said`] has all that it said after that.
    pub fn code(&mut self) -> Option<i32> {
        let mut code = None;
        eventually("the end of trik run", || {
            code = self.child.try_wait().expect("a child");
            code.is_some() && self.readers.iter().all(JoinHandle::is_finished)
        });
        code.and_then(|status| status.code())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn programs_in_three_languages_drive_the_robot_and_talk_here() {
    let Some(one) = Reachable::new() else { return };
    let drive = |percent: i32, last: &str| {
        format!(
            "brick.motor(M3).setPower({percent})\nbrick.motor(M4).setPower({percent})\nscript.wait(1000)\n{last}"
        )
    };
    let shell = "#!/bin/sh\ncd $TRIK_TREE\necho 40 > motors/M3/value; echo 40 > motors/M4/value\n\
                 sleep 1; echo driven $(cat sensors/D1/units)\n";
    // To and fro: there is a wall.
    for (name, text, said) in [
        (
            "go.js",
            drive(40, "print('driven'); script.quit();\n"),
            "driven\n",
        ),
        (
            "go.py",
            drive(-40, "print('driven', 'in', 'Python')\n"),
            "driven in Python\n",
        ),
        ("go", shell.to_owned(), "driven cm\n"),
    ] {
        let before = one.robot.pose();
        let output = one.run(name, &text);
        assert_eq!(
            (output.stdout.as_str(), output.stderr.as_str()),
            (said, ""),
            "{name}"
        );
        assert_eq!(output.code(), 0, "{name}");
        let away = one.robot.pose().away_from(&before);
        assert!(away > 0.05, "{name}: {away} m");
        assert!(one.rests(), "{name}");
    }
    let status = one.robot.home.run(&["status"]).good();
    assert!(
        status.contains(": program none\n") && status.contains("last go has ended after "),
        "{status}"
    );
}

#[test]
fn a_sensor_of_the_camera_that_starts_slowly_fails_no_program() {
    let Some(one) = Reachable::new() else { return };
    let script = one.robot.devices.join("etc/init.d/line-sensor-ov7670");
    let text = std::fs::read_to_string(&script).expect("the script of the sensor");
    let slow = text.replacen("start)\n", "start)\n    sleep 1\n", 1);
    assert_ne!(text, slow);
    std::fs::write(&script, slow).expect("a slower script");
    let (js, py) = (
        "var s = brick.lineSensor('video1'); s.init(true); print(s.read().length); s.stop(); script.quit();",
        "s = brick.lineSensor('video1')\ns.init(True)\nprint(len(s.read()))\ns.stop()\n",
    );
    for (name, text) in [("see.js", js), ("see.py", py)] {
        let output = one.run(name, text);
        let said = (output.stdout.as_str(), output.stderr.as_str());
        assert_eq!(said, ("3\n", ""), "{name}");
    }
    // A diagram detects as soon as the sensor hears, and the sensor runs until it has ended.
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let on = sketch.block("TrikInitCamera", &[("Mode", "line")]);
    let detect = sketch.block("TrikDetect", &[("Mode", "line")]);
    let wait = sketch.block("Timer", &[("Delay", "60000")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, on, detect, wait, end]);
    let running = one.spawn("see.qrs", sketch.qrs().expect("a save"));
    eventually("an answer of the sensor", || {
        let colours = one.robot.read("camera/line/hsv");
        colours.is_ok_and(|text| text.split(' ').count() == 6)
    });
    assert!(!running.said().contains("camera"), "{}", running.said());
}

#[test]
fn a_program_that_fails_gives_its_reason_and_the_exit_code_1() {
    let Some(one) = Reachable::new() else { return };
    for (name, text, reasons) in [
        (
            "bad.py",
            "print('first')\n1 / 0\n",
            [
                "ZeroDivisionError",
                "trik: bad.py has failed with exit code 1 after ",
            ],
        ),
        (
            "bad.js",
            "print('first');\nmotor.turn();\n",
            ["motor", "trik: bad.js has failed"],
        ),
        (
            "exit",
            "#!/bin/sh\necho first; exit 7\n",
            ["", "trik: exit has failed with exit code 7 after "],
        ),
        (
            "kill",
            "#!/bin/sh\necho first; kill -SEGV $$\n",
            ["", "trik: kill was killed by SIGSEGV after "],
        ),
    ] {
        let output = one.run(name, text);
        assert_eq!(output.code(), 1, "{name}: {}", output.stderr);
        assert_eq!(output.stdout.trim_end(), "first", "{name}");
        for reason in reasons {
            assert!(output.stderr.contains(reason), "{name}: {}", output.stderr);
        }
    }
}

#[test]
fn programs_in_three_languages_draw_on_the_display() {
    let Some(one) = Reachable::new() else { return };
    for (name, text) in [
        (
            "draw.js",
            "brick.display().addLabel('hi', 1, 1); brick.display().redraw(); script.quit();",
        ),
        (
            "draw.py",
            "brick.display().addLabel('hi', 1, 1)\nbrick.display().redraw()\n",
        ),
        (
            "draw",
            "#!/bin/sh\nprintf 'label 1 1 20 hi\\nredraw\\n' | \"$TRIKD\" draw\n",
        ),
    ] {
        let black = vec![0; 320 * 240 * 2];
        std::fs::write(one.robot.path("display/device"), &black).expect("a display");
        let output = one.run(name, text);
        assert_eq!((output.code(), output.stderr.as_str()), (0, ""), "{name}");
        let shown = std::fs::read(one.robot.path("display/bin_data")).expect("a picture");
        assert_ne!(shown, black, "{name}");
    }
}

#[test]
fn ctrl_c_stops_the_program_on_the_robot_and_a_second_one_does_not_wait() {
    let Some(one) = Reachable::new() else { return };
    let mut running = one.start("loop.js");
    processes::signal(running.child.id(), Signal::SIGINT);
    running.says(&format!(
        "trik: stopping loop.js on {}; a second Ctrl-C does not wait\n",
        one.ip
    ));
    running.says("trik: loop.js was stopped by a client after ");
    assert_eq!(running.code(), Some(1));
    assert!(one.rests());
    // A trikd that hangs cannot stop anything. Its guardian would not suffer a serving process that stands still.
    let mut running = one.start("again.js");
    let (guardian, serving) = one.trikd();
    for process in [guardian, serving] {
        processes::signal(process, Signal::SIGSTOP);
        eventually("a standstill", || processes::is_stopped(process));
    }
    processes::signal(running.child.id(), Signal::SIGINT);
    running.says("trik: stopping again.js");
    processes::signal(running.child.id(), Signal::SIGINT);
    assert_eq!(running.code(), Some(1));
    running.says("trik: left; again.js may still run on ");
    for process in [serving, guardian] {
        processes::signal(process, Signal::SIGCONT);
    }
    eventually("the stop that was asked for", || one.rests());
}

#[test]
fn a_stop_ends_the_program_of_somebody_else_and_says_which() {
    let Some(one) = Reachable::new() else { return };
    let mut running = one.start("loop.js");
    let status = one.robot.home.run(&["status"]).good();
    assert!(
        status.contains(": program loop.js (JavaScript, process "),
        "{status}"
    );
    let said = one.robot.home.run(&["stop"]).good();
    assert!(
        said.starts_with(&format!(
            "{}: loop.js was stopped by a client after ",
            one.ip
        )),
        "{said}"
    );
    assert!(one.rests());
    assert_eq!(running.code(), Some(1));
    let said = one.robot.home.run(&["stop", "--robot", &one.ip]).good();
    assert_eq!(
        said,
        format!("{}: no program was running; everything rests\n", one.ip)
    );
}

#[test]
fn a_reader_that_has_seen_enough_stops_the_program() {
    let Some(one) = Reachable::new() else { return };
    let file = one
        .robot
        .home
        .0
        .file("talk.js", "while (true) { print('x'); script.wait(20); }");
    let output = one.robot.sh(&format!(
        "trik run {} --robot {} | head -n 2",
        file.display(),
        one.ip
    ));
    assert_eq!(
        (output.stdout.as_str(), output.stderr.as_str()),
        ("x\nx\n", "")
    );
    let status = one.robot.home.run(&["status"]).good();
    assert!(
        status.contains(": program none\n") && status.contains("talk.js was stopped by a client"),
        "{status}"
    );
}

#[test]
fn a_port_that_is_taken_is_one_line_and_the_robot_runs() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let ip = loopback();
    let taken = TcpListener::bind((ip.as_str(), 9000)).expect("a port");
    let robot = Robot::start(home.clone(), &["--trikd-address", &ip]);
    assert_eq!(robot.errno("motors/M3/value"), 0);
    assert!(!robot.said().contains("TRIK Studio"), "{}", robot.said());
    eventually("a line", || robot.complaints().ends_with('\n'));
    let line = robot.complaints();
    assert_eq!(line.lines().count(), 1, "{line}");
    for part in [
        "trik: trikd does not run: port 9000 (telemetry) cannot be served: another program has it",
        "ss -ltnp 'sport = :9000'",
        "--trikd-ports=18888",
        "--no-trikd",
    ] {
        assert!(line.contains(part), "{line}");
    }
    // No half of it: the port of programs is free.
    TcpListener::bind((ip.as_str(), 8888)).expect("a free port");
    let refusal = home.run(&["status"]);
    assert_eq!(refusal.code(), 2);
    assert!(
        refusal
            .stderr
            .contains(" has no trikd, which takes programs: "),
        "{}",
        refusal.stderr
    );
    drop(taken);
    // Ports of the system's choice are found as well.
    let other = Robot::start(
        home.clone(),
        &["--trikd-address", &ip, "--trikd-ports", "0"],
    );
    assert!(
        other.said().contains("TRIK Studio needs port 8888"),
        "{}",
        other.said()
    );
    let status = home.run(&["status"]).good();
    assert!(status.contains(": program none\n"), "{status}");
}

#[test]
fn after_a_kill_of_trikd_motors_rest_it_comes_back_and_who_waits_is_told() {
    let Some(one) = Reachable::new() else { return };
    let mut running = one.start("loop.js");
    let (guardian, serving) = one.trikd();
    processes::signal(serving, Signal::SIGKILL);
    running.says(&format!("trik: the connection to {} is lost: ", one.ip));
    running.says("loop.js may still run: trik stop ends it");
    assert_eq!(running.code(), Some(2));
    eventually("rest", || one.rests());
    eventually("a line", || {
        one.robot
            .complaints()
            .contains("the serving process has crashed")
    });
    eventually("trikd again", || {
        one.trikd().1 != serving && one.robot.home.run(&["status"]).code() == 0
    });
    assert_eq!(one.run("hi.js", "print('hi');").stdout, "hi\n");
    // Now the guardian: trik starts both again.
    let mut running = one.start("loop.js");
    processes::signal(guardian, Signal::SIGKILL);
    running.says("trik: loop.js was stopped by the end of trikd after ");
    assert_eq!(running.code(), Some(1));
    eventually("a line", || {
        one.robot
            .complaints()
            .contains("trik: trikd has ended; started again")
    });
    eventually("trikd once more", || {
        one.robot.home.run(&["status"]).code() == 0
    });
    eventually("rest", || one.rests());
    assert_eq!(one.run("hi.js", "print('hi');").stdout, "hi\n");
}

#[test]
fn the_end_of_the_robot_ends_its_program_and_keeps_uploads_only_where_it_was_told() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let scripts = home.0.path("kept");
    let option = format!("--scripts={}", scripts.display());
    let mut one = Reachable::beside(&home, &[&option]);
    let mut running = one.start("loop.js");
    let (guardian, serving) = one.trikd();
    let devices = one.robot.devices.clone();
    assert!(devices.with_extension("trikd").exists());
    assert_eq!(
        one.robot.end(Signal::SIGINT).code(),
        Some(0),
        "{}",
        one.robot.complaints()
    );
    running.says("trik: loop.js was stopped by the end of trikd after ");
    assert_eq!(running.code(), Some(1));
    for pid in [guardian, serving] {
        assert!(!processes::is_alive(pid));
    }
    one.robot.leaves_nothing();
    assert!(!home.base().exists());
    assert_eq!(
        std::fs::read_to_string(scripts.join("loop.js")).expect("kept"),
        LOOP
    );
}

#[test]
fn a_trikd_that_hangs_does_not_hold_up_the_end_for_ever() {
    for signals in [1, 2] {
        let Some(mut one) = Reachable::new() else {
            return;
        };
        let (guardian, serving) = one.trikd();
        // The guardian would not suffer a serving process that stands still.
        for process in [guardian, serving] {
            processes::signal(process, Signal::SIGSTOP);
            eventually("a standstill", || processes::is_stopped(process));
        }
        if signals > 1 {
            processes::signal(one.robot.pid(), Signal::SIGTERM);
        }
        let status = one.robot.end(Signal::SIGINT);
        assert_eq!(status.code(), Some(0), "{}", one.robot.complaints());
        one.robot.leaves_nothing();
        assert!(!processes::is_alive(guardian));
        // A person without patience leaves it to itself: it ends as soon as it goes on.
        processes::signal(serving, Signal::SIGCONT);
        eventually("its end", || !processes::is_alive(serving));
    }
}

#[test]
fn a_gamepad_on_its_port_is_a_gamepad_in_the_tree() {
    let Some(one) = Reachable::new() else { return };
    let mut pad = TcpStream::connect((one.ip.as_str(), 4444)).expect("the port of gamepads");
    eventually("a gamepad in the tree", || {
        pad.write_all(b"pad 1 40 -30\n").expect("sent");
        one.robot
            .read("gamepad/pad1/value")
            .is_ok_and(|text| text == "40 -30 1")
    });
}
