//! `trik record` and `trik replay`: what a robot gave is given again, from any moment on, and what programs write is compared.

use crate::rig::{Home, Robot};
use harness::eventually;
use journal::read::{EventKind, Reader};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::os::unix::fs::{FileTypeExt, PermissionsExt};
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::time::Duration;

/// A recorder that has begun, and is asked to end by SIGINT.
pub struct Recorder(pub Child);

impl Recorder {
    fn start(home: &Home, words: &[&str]) -> Self {
        Self::start_to(home, "run.mcap", words)
    }

    /// Records into this file of the home.
    pub fn start_to(home: &Home, file: &str, words: &[&str]) -> Self {
        let mut command = home.command(&["record", "-o", file]);
        command
            .args(words)
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        Self(command.spawn().expect("trik record"))
    }

    pub fn end(mut self) {
        let pid = Pid::from_raw(i32::try_from(self.0.id()).expect("a pid"));
        kill(pid, Signal::SIGINT).expect("SIGINT");
        assert!(self.0.wait().expect("an end").success());
    }
}

/// Samples of each node as texts, in their order.
fn samples(home: &Home) -> BTreeMap<String, Vec<String>> {
    let file = File::open(home.0.path("run.mcap")).expect("a recording");
    let mut reader = Reader::open(file).expect("a recording");
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    while let Some(event) = reader.next().expect("an event") {
        if let EventKind::Sample { node, tuple, .. } = event.what {
            let text = reader.layout(node).expect("a layout").show(&tuple);
            let path = reader.nodes()[node].path.clone();
            all.entry(path).or_default().push(text);
        }
    }
    all
}

/// Seconds from the beginning of the recording to the first sample of a node.
fn first_s(home: &Home, path: &str) -> f64 {
    let file = File::open(home.0.path("run.mcap")).expect("a recording");
    let mut reader = Reader::open(file).expect("a recording");
    while let Some(event) = reader.next().expect("an event") {
        if let EventKind::Sample { node, .. } = event.what
            && reader.nodes()[node].path == path
        {
            return (event.unix_ns - reader.begin_ns()) as f64 / 1e9;
        }
    }
    panic!("{path} has no samples");
}

/// Records a robot that drives to some encoder reading and back to rest.
fn drive_and_record(home: &Arc<Home>) {
    let mut robot = Robot::start(home.clone(), &[]);
    let recorder = Recorder::start(home, &[]);
    eventually("a recording", || home.0.path("run.mcap").exists());
    // The recorder needs the samples, so they come without any other reader.
    robot.drive(30, 40);
    eventually("a way", || robot.number("encoders/E3/value") > 300.0);
    robot.write("stop", "1").expect("stop");
    eventually("rest in the recording", || {
        robot.number("motors/M4/value") == 0.0
    });
    recorder.end();
    assert!(robot.end(Signal::SIGINT).success());
}

#[test]
fn what_was_recorded_is_given_again_and_stays_where_the_clock_stands() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    drive_and_record(&home);
    let recorded = samples(&home);
    assert_eq!(recorded["motors/M4"].last().map(String::as_str), Some("0"));
    assert!(recorded["motors/M4"].iter().any(|power| power == "40"));
    let way: f64 = recorded["encoders/E3"]
        .last()
        .expect("samples")
        .parse()
        .expect("a number");
    assert!(way > 300.0, "{way}");

    let mut replay = Robot::replay(home.clone(), "run.mcap", &["--paused"]);
    let control = replay.devices.join("replay");
    let order = |line: &str| std::fs::write(&control, format!("{line}\n")).expect("an order");
    // Where it stands, each node has what it had then, by both of its names. A busy machine records its first sample late.
    order(&format!("seek {:.3}", first_s(&home, "encoders/E3") + 0.3));
    eventually("the same by both names", || {
        let read = |name| replay.read(name).ok();
        let left = read("encoders/left/value");
        left.is_some() && left == read("encoders/E3/value")
    });
    assert_eq!(replay.read("sensors/D1/units").expect("units"), "cm");
    order("seek 100:00");
    eventually("the end", || {
        replay.errno("encoders/E3/value") == 0 && replay.number("encoders/E3/value") == way
    });
    // Each node gets what it had for itself.
    eventually("rest", || replay.number("motors/M4/value") == 0.0);
    // A recorded failure has its errno and its reason.
    eventually("a failure", || {
        replay.errno("sensors/D3/value") == nix::libc::ETIMEDOUT
    });
    assert!(
        replay
            .read("sensors/D3/fault")
            .expect("a fault")
            .starts_with("device: no echo")
    );
    order("seek 0.3");
    eventually("the beginning", || {
        replay.errno("encoders/E3/value") == 0 && replay.number("encoders/E3/value") < way / 2.0
    });
    // Again and again, and so fast that only what stays can be read.
    for line in ["speed 100", "loop on", "go"] {
        order(line);
    }
    eventually("samples at any time", || {
        (0..200).all(|_| replay.errno("encoders/E3/value") == 0)
    });
    for line in ["pause", "loop off", "speed 1", "seek 0.3"] {
        order(line);
    }
    order("dance");
    let complaint = replay.devices.join("replay.error");
    eventually("a complaint", || {
        std::fs::read_to_string(&complaint).is_ok_and(|text| text.contains("unknown word 'dance'"))
    });
    // The nodes hear of the jump a moment after the player.
    eventually("the beginning again", || {
        replay.number("encoders/E3/value") < way / 2.0
    });
    order("go");
    eventually("the end in its own time", || {
        replay.number("encoders/E3/value") == way
    });
    assert!(!complaint.exists());
    // At the end nothing follows: it begins again. The nodes have their last values before the recording ends.
    for line in ["seek 100:00", "speed 0.01", "go"] {
        order(line);
    }
    eventually("the beginning after the end", || {
        replay.number("encoders/E3/value") < way / 2.0
    });
    assert!(replay.end(Signal::SIGINT).success());
    assert!(!control.exists());
}

/// When the first came of each node that had a value first, after the beginning.
fn firsts(home: &Home) -> BTreeMap<String, Duration> {
    let file = File::open(home.0.path("run.mcap")).expect("a recording");
    let mut reader = Reader::open(file).expect("a recording");
    let begin_ns = reader.begin_ns();
    let mut firsts = BTreeMap::new();
    while let Some(event) = reader.next().expect("an event") {
        if let Some(node) = event.node() {
            let after = Duration::from_nanos(event.unix_ns - begin_ns);
            let is_sample = matches!(event.what, EventKind::Sample { .. });
            let path = reader.nodes()[node].path.clone();
            firsts.entry(path).or_insert((after, is_sample));
        }
    }
    firsts.retain(|_, (_, is_sample)| *is_sample);
    (firsts.into_iter())
        .map(|(path, (after, _))| (path, after))
        .collect()
}

#[test]
fn at_its_very_beginning_each_node_has_what_it_had_at_first() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let mut robot = Robot::start(home.clone(), &[]);
    robot.drive(30, 40);
    let recorder = Recorder::start(&home, &[]);
    eventually("a way", || robot.number("encoders/E3/value") > 300.0);
    recorder.end();
    assert!(robot.end(Signal::SIGINT).success());
    // What a recorder finds has the time when it began; what it has to wait for comes a moment later.
    let firsts = firsts(&home);
    assert_eq!(firsts["motors/M4"], Duration::ZERO);
    let soon = Duration::from_millis(100);
    let replay = Robot::replay(home.clone(), "run.mcap", &["--paused"]);
    for (path, after) in &firsts {
        let is_there = replay.errno(&format!("{path}/value")) == 0;
        assert!(is_there || *after > soon, "{path} after {after:?}");
    }
    assert_eq!(replay.number("motors/M4/value"), 40.0);
    let control = replay.devices.join("replay");
    let order = |line: &str| std::fs::write(&control, format!("{line}\n")).expect("an order");
    let faults = |robot: &Robot| {
        let stats = robot.read("motors/M4/stats").expect("stats");
        let faults = stats.lines().find(|line| line.starts_with("faults "));
        faults.expect("a number of faults").to_owned()
    };
    let before = faults(&replay);
    for line in ["seek 100:00", "seek 0"] {
        order(line);
    }
    eventually("the orders", || {
        std::fs::write(&control, "dance\n").is_ok() && replay.devices.join("replay.error").exists()
    });
    assert_eq!(replay.number("motors/M4/value"), 40.0);
    assert_eq!(faults(&replay), before);
}

#[test]
fn a_program_that_does_something_else_is_told_with_its_time() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    drive_and_record(&home);
    let mut replay = Robot::replay(home.clone(), "run.mcap", &["--paused"]);
    // What was recorded first: the same is no difference, and moves nothing.
    replay.write("motors/M3/value", "30").expect("a write");
    replay.write("motors/M4/value", "40").expect("a write");
    replay.write("motors/M4/value", "55").expect("a write");
    let mut told = replay.next_line();
    while told.is_empty() {
        told = replay.next_line();
    }
    assert!(
        told.starts_with("motors/M4 at 0:00.0: a program wrote 55, recorded is 0 at "),
        "{told}"
    );
    // Nothing moves: the tree has what was recorded, which may begin a moment later.
    assert_ne!(replay.read("motors/M4/value").ok().as_deref(), Some("55"));
    assert!(replay.end(Signal::SIGINT).success());
}

/// Where the middle of each chunk of a recording is, which is among its compressed messages: a length that is changed would
/// make the file look cut. Records have an opcode and a length of 8 bytes, and chunks the opcode 6 (MCAP specification).
fn middles_of_chunks(bytes: &[u8]) -> Vec<usize> {
    const MAGIC: usize = 8;
    const HEADER: usize = 9;
    let mut found = Vec::new();
    let mut at = MAGIC;
    while let Some(header) = bytes.get(at..at + HEADER) {
        let length = u64::from_le_bytes(header[1..].try_into().expect("8 bytes")) as usize;
        if header[0] == 6 {
            found.push(at + HEADER + length / 2);
        }
        at += HEADER + length;
        if at + MAGIC >= bytes.len() {
            break;
        }
    }
    assert!(!found.is_empty(), "no chunk");
    found
}

#[test]
fn a_recording_that_ends_is_well_and_one_that_is_damaged_is_not() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    drive_and_record(&home);
    let words = [
        "replay",
        "run.mcap",
        "--exit",
        "--no-view",
        "--no-trikd",
        "--speed",
        "50",
    ];
    let played = home.run(&words);
    assert_eq!(played.status.code(), Some(0), "{}", played.stderr);
    let path = home.0.path("run.mcap");
    let mut bytes = std::fs::read(&path).expect("a recording");
    for middle in middles_of_chunks(&bytes) {
        bytes[middle] ^= 0xff;
    }
    std::fs::write(&path, bytes).expect("a recording");
    let failed = home.run(&words);
    assert_eq!(failed.status.code(), Some(1), "{}", failed.stderr);
    assert!(failed.stderr.contains("damaged"), "{}", failed.stderr);
}

/// Where the first chunk of a recording is: each record has an opcode, that of a chunk is 6, and a length.
fn first_chunk(bytes: &[u8]) -> usize {
    let mut at = 8;
    while bytes[at] != 6 {
        let length = bytes[at + 1..at + 9].try_into().map(u64::from_le_bytes);
        at += 9 + usize::try_from(length.expect("8 bytes")).expect("a length");
    }
    at
}

/// One that is damaged in the middle is not replaced, and a new file has what is whole.
fn mends_around_damage(home: &Home) {
    let mut damaged = fs::read(home.0.path("run.mcap")).expect("a recording");
    let chunk = first_chunk(&damaged);
    // Behind what a chunk says of itself, in what is compressed.
    damaged[chunk + 9 + 45] ^= 1;
    fs::write(home.0.path("damaged.mcap"), &damaged).expect("a file");
    let refused = home.run(&["mend", "damaged.mcap"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        refused.stderr.contains("not only cut"),
        "{}",
        refused.stderr
    );
    let mended = home
        .run(&["mend", "damaged.mcap", "-o", "whole.mcap"])
        .good();
    assert!(mended.contains("left out: 1 damaged"), "{mended}");
    home.run(&["info", "whole.mcap"]).good();
    assert_eq!(
        fs::read(home.0.path("damaged.mcap")).expect("it stays"),
        damaged
    );
}

#[test]
fn a_killed_recorder_leaves_what_can_be_mended() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let mut robot = Robot::start(home.clone(), &[]);
    let mut recorder = Recorder::start(&home, &["--only", "encoders", "--only", "battery"]);
    let path = home.0.path("run.mcap");
    // A second flush: there is something to save. The first one has what stands still around the robot.
    let size = || std::fs::metadata(&path).map_or(0, |file| file.len());
    let mut first = 0;
    eventually("a flush", || {
        first = size();
        first > 4000
    });
    eventually("another flush", || size() > first);
    recorder.0.kill().expect("SIGKILL");
    recorder.0.wait().expect("an end");
    let refused = home.run(&["replay", "run.mcap"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(refused.stderr.contains("trik mend"), "{}", refused.stderr);
    assert_eq!(home.run(&["info", "run.mcap"]).status.code(), Some(1));
    let private = fs::Permissions::from_mode(0o600);
    fs::set_permissions(&path, private).expect("a mode");
    let mended = home.run(&["mend", "run.mcap"]);
    assert_eq!(mended.status.code(), Some(0), "{}", mended.stderr);
    let mode = path.metadata().expect("a file").permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let info = home.run(&["info", "run.mcap"]);
    assert!(info.stdout.contains("encoders/E3"), "{}", info.stdout);
    assert!(!info.stdout.contains("sensors/"), "{}", info.stdout);
    assert!(samples(&home)["encoders/E3"].len() > 10);
    let again = home.run(&["mend", "run.mcap"]);
    assert!(again.stdout.contains("it is whole"), "{}", again.stdout);
    home.0.file("old.mcap", "old");
    mends_around_damage(&home);
    let words = ["mend", "run.mcap", "-o", "old.mcap"];
    let refused = home.run(&words);
    assert_eq!(refused.status.code(), Some(1));
    let why = "old.mcap is there already: --force replaces it";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
    home.run(&[&words[..], &["--force"]].concat()).good();
    let whole = home.run(&["info", "old.mcap"]).good();
    assert!(whole.contains("encoders/E3"), "{whole}");
    home.0.fifo("pipe");
    let refused = home.run(&["mend", "run.mcap", "-o", "pipe", "--force"]);
    assert!(
        refused.stderr.contains("pipe is no file"),
        "{}",
        refused.stderr
    );
    let pipe = home.0.path("pipe").symlink_metadata().expect("a pipe");
    assert!(pipe.file_type().is_fifo());
    // Nothing is written to before it is known what is to be recorded.
    let refused = home.run(&["record", "-o", "run.mcap", "--seconds", "1"]);
    let why = "run.mcap is there already: --force replaces it";
    assert!(refused.stderr.contains(why), "{}", refused.stderr);
    let words = "record -o run.mcap --seconds 1 --force --only battery";
    home.run(&words.split(' ').collect::<Vec<_>>()).good();
    let info = home.run(&["info", "run.mcap"]).good();
    assert!(!info.contains("encoders/E3"), "{info}");
    assert!(robot.end(Signal::SIGINT).success());
}

#[test]
fn what_is_no_recording_and_no_tree_is_refused() {
    let Some(home) = Home::new() else { return };
    home.0.file("text", "hello");
    for words in [["replay", "text"], ["info", "text"], ["mend", "text"]] {
        let refused = home.run(&words);
        assert_eq!(refused.status.code(), Some(1), "{words:?}");
        assert!(
            refused.stderr.contains("text: no recording"),
            "{}",
            refused.stderr
        );
    }
    assert_eq!(home.run(&["replay", "nothing"]).status.code(), Some(1));
    let refused = home.run(&["record", "."]);
    assert!(
        refused.stderr.contains("no tree of trikfs"),
        "{}",
        refused.stderr
    );
    assert_eq!(home.run(&["record"]).status.code(), Some(1));
    assert_eq!(
        home.run(&["replay", "text", "--speed", "0"]).status.code(),
        Some(2)
    );
}
