//! Recordings of a robot, compared with a recording of their replay, and recorders that are killed at any moment.
//!
//! Owns what may be missing: what a recorder says that it has missed, and the last second of one that was killed.

use crate::replay::Recorder;
use crate::rig::{Home, Robot};
use harness::{eventually, processes};
use journal::mend::mend;
use journal::read::{EventKind, Reader};
use nix::sys::signal::Signal;
use std::collections::BTreeMap;
use std::collections::hash_map::RandomState;
use std::fs::{self, File};
use std::hash::BuildHasher;
use std::io::Cursor;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

/// A recorder hands over what it has each second; a busy disk takes its time.
const LOST_MOST: Duration = Duration::from_millis(1_500);
/// A busy machine, too, now and then.
const LOST_WHEN_BUSY: Duration = Duration::from_secs(10);

/// What happened to a node: when, and its numbers or its errno.
type Events = Vec<(u64, Result<String, i32>)>;

/// All that happened, by nodes.
fn events<F: std::io::Read + std::io::Seek>(file: F) -> BTreeMap<String, Events> {
    let mut reader = Reader::open(file).expect("a recording");
    let mut all = BTreeMap::new();
    for node in reader.nodes() {
        all.insert(node.path.clone(), Events::new());
    }
    while let Some(event) = reader.next().expect("an event") {
        let (node, what) = match event.what {
            EventKind::Sample { node, tuple, .. } => {
                let layout = reader.layout(node).expect("a layout");
                (node, Ok(layout.show(&tuple)))
            }
            EventKind::Fault { node, errno, .. } => (node, Err(errno)),
            EventKind::Line(..) => continue,
        };
        let path = &reader.nodes()[node].path;
        (all.get_mut(path).expect("a node")).push((event.unix_ns, what));
    }
    all
}

/// What a recording that is still written has by now.
fn events_by_now(path: &Path) -> BTreeMap<String, Events> {
    let mut mended = Cursor::new(Vec::new());
    match mend(File::open(path).expect("a recording"), &mut mended) {
        Ok(_) => events(mended),
        Err(_) => BTreeMap::new(),
    }
}

/// How many events a finished recording says that it has missed or dropped.
fn lost(path: &Path) -> usize {
    let mut reader = Reader::open(File::open(path).expect("a file")).expect("a recording");
    let counts = reader.facts("counts").expect("counts");
    let number = |key: &str| -> usize { counts[key].parse().expect("a number") };
    number("missed") + number("dropped")
}

/// Peers that are connected to a player.
fn peers(socket: &Path) -> usize {
    let name = socket.to_str().expect("UTF-8");
    let table = fs::read_to_string("/proc/net/unix").expect("sockets");
    // The sixth word is the state; 03 is connected.
    let is_peer =
        |line: &&str| line.ends_with(name) && line.split_whitespace().nth(5) == Some("03");
    table.lines().filter(is_peer).count()
}

#[test]
fn a_recording_of_a_replay_has_the_same_values() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let mut robot = Robot::start(home.clone(), &[]);
    let recorder = Recorder::start_to(&home, "run.mcap", &[]);
    eventually("a recording", || home.0.path("run.mcap").exists());
    robot.drive(30, 40);
    eventually("a way", || robot.number("encoders/E3/value") > 400.0);
    // What fails and is mended is there again.
    robot.fault(&["D1", "unplug"]);
    eventually("a failure", || robot.errno("sensors/D1/value") != 0);
    robot.fault(&["D1", "--clear"]);
    robot.drive(-20, 0);
    eventually("a way back", || robot.number("encoders/E3/value") < 200.0);
    robot.write("stop", "1").expect("stop");
    recorder.end();
    assert!(robot.end(Signal::SIGINT).success());
    let info = home.run(&["info", "run.mcap"]).good();
    for topic in [
        "ros/battery ",
        "ros/joint_states ",
        "ros/odometry ",
        "ros/sensors/D1 ",
        " tf ",
    ] {
        assert!(info.contains(topic), "{topic}: {info}");
    }
    let first = events(File::open(home.0.path("run.mcap")).expect("a recording"));
    for (speed, stalls) in [(1, false), (3, false), (1, true)] {
        let file = format!("again-{speed}-{stalls}.mcap");
        again(&home, &first, speed, stalls, &file);
    }
}

/// Replays and records at once; nothing else may be in the file, and nothing may be lost that is not counted.
fn again(home: &Arc<Home>, first: &BTreeMap<String, Events>, speed: u32, stalls: bool, file: &str) {
    let speed_word = speed.to_string();
    let mut replay = Robot::replay(
        home.clone(),
        "run.mcap",
        &["--paused", "--speed", &speed_word],
    );
    let mount = replay.root.to_str().expect("UTF-8").to_owned();
    let socket = replay.devices.join("player.sock");
    // All but those that have just failed, which are read again a little later.
    eventually("readers of all nodes", || peers(&socket) + 4 > first.len());
    let recorder = Recorder::start_to(home, file, &["--no-standard", &mount]);
    // It makes the file when it has found the rings.
    eventually("a recording", || home.0.path(file).exists());
    fs::write(replay.devices.join("replay"), "go\n").expect("an order");
    if stalls {
        // The stall is what is tried here: more than any ring holds.
        eventually("a way", || {
            replay.errno("encoders/E3/value") == 0 && replay.number("encoders/E3/value") > 50.0
        });
        processes::signal(replay.pid(), Signal::SIGSTOP);
        std::thread::sleep(Duration::from_millis(1_500));
        processes::signal(replay.pid(), Signal::SIGCONT);
    }
    while !replay.next_line().contains("at its end") {}
    let path = home.0.path(file);
    // All of it is in the file a second after the end; if it is not, the difference says what is missing.
    let deadline = Instant::now() + Duration::from_secs(3);
    while difference(first, &events_by_now(&path), 0).is_some() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(100));
    }
    recorder.end();
    assert!(replay.end(Signal::SIGINT).success());
    let again = events(File::open(&path).expect("a recording"));
    let info = home.run(&["info", file]).good();
    assert!(!info.contains("ros/"), "{info}");
    let lost = lost(&path);
    let found = difference(first, &again, lost);
    assert_eq!(found, None, "at speed {speed}, with {lost} counted as lost");
    // A recorder that is always overrun would be no recorder.
    assert!(lost < 100, "{lost}");
}

/// The first node whose events are others, or by how many more than `lost` are missing; None if there is no difference.
fn difference(
    first: &BTreeMap<String, Events>,
    again: &BTreeMap<String, Events>,
    lost: usize,
) -> Option<String> {
    let mut missing = 0;
    let mut which = String::new();
    for (path, events) in first {
        let had = again.get(path).map(Vec::as_slice).unwrap_or_default();
        let mut rest = events.iter();
        let mut was_there = |one: &Result<String, i32>| rest.any(|(_, other)| other == one);
        if let Some((_, other)) = had.iter().find(|(_, one)| !was_there(one)) {
            return Some(format!(
                "{path}: {other:?} was not recorded before, or not there"
            ));
        }
        if had.len() < events.len() {
            missing += events.len() - had.len();
            which.push_str(&format!(" {path} {} of {},", had.len(), events.len()));
        }
    }
    (missing > lost).then(|| format!("{missing} are missing:{which}"))
}

/// How often a recorder is killed: `TRIK_KILL_ROUNDS`, or a few times.
fn rounds() -> usize {
    let rounds = std::env::var("TRIK_KILL_ROUNDS").ok();
    rounds.and_then(|rounds| rounds.parse().ok()).unwrap_or(4)
}

#[test]
fn a_recorder_that_is_killed_at_any_moment_loses_a_second_at_most() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let mut robot = Robot::start(home.clone(), &[]);
    let mut lost = Vec::new();
    let path = home.0.path("killed.mcap");
    for round in 0..rounds() {
        let mut recorder = Recorder::start_to(&home, "killed.mcap", &[]);
        let is_begun = || fs::metadata(&path).is_ok_and(|file| file.len() > 0);
        eventually("a file", is_begun);
        // The moment is what is tried here; any is good.
        let random = RandomState::new().hash_one(round) % 2_500;
        std::thread::sleep(Duration::from_millis(random));
        recorder.0.kill().expect("SIGKILL");
        let killed = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        recorder.0.wait().expect("an end");
        let mended = home.run(&["mend", "killed.mcap"]);
        assert_eq!(mended.status.code(), Some(0), "{}", mended.stderr);
        let mut reader = Reader::open(File::open(&path).expect("a file")).expect("a recording");
        while reader.next().expect("an event").is_some() {}
        let last = Duration::from_nanos(reader.end_ns());
        if reader.end_ns() > 0 {
            lost.push(killed.expect("a time").saturating_sub(last));
        } else {
            // Before the first second is over nothing but the beginning is there.
            lost.push(Duration::from_millis(random));
        }
        fs::remove_file(&path).expect("a file");
    }
    lost.sort();
    let (middle, most) = (lost[lost.len() / 2], lost[lost.len() - 1]);
    println!("{} times: {middle:?} lost, {most:?} at most", lost.len());
    assert!(middle < LOST_MOST && most < LOST_WHEN_BUSY, "{lost:?}");
    assert!(robot.end(Signal::SIGINT).success());
}
