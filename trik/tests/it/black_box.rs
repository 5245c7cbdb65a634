//! The black box of a robot and what it sends over the network: recordings, every node by its name.

use crate::programs::Reachable;
use crate::rig::Home;
use harness::wait::SOON;
use harness::{eventually, processes, tools};
use journal::read::{EventKind, Reader};
use journal::write::Story;
use nix::sys::signal::Signal;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A robot with its black box in a folder that stays.
fn robot() -> Option<(Reachable, PathBuf)> {
    let home = Arc::new(Home::new()?);
    let folder = home.0.dir().join("box");
    let named = folder.to_str().expect("UTF-8").to_owned();
    let robot = Reachable::beside(&home, &["--box", &named]);
    Some((robot, folder))
}

/// What a recording has: samples by node, and lines by story.
fn content(path: &Path) -> (BTreeMap<String, u64>, Vec<(Story, String)>) {
    let mut reader = Reader::open(File::open(path).expect("a file")).expect("a whole recording");
    let mut samples = BTreeMap::new();
    let mut lines = Vec::new();
    while let Some(event) = reader.next().expect("an event") {
        match event.what {
            EventKind::Sample { node, .. } => {
                *samples
                    .entry(reader.nodes()[node].path.clone())
                    .or_default() += 1;
            }
            EventKind::Line(story, line) => lines.push((story, line.text)),
            EventKind::Fault { .. } => {}
        }
    }
    (samples, lines)
}

/// When a node of a recording had its samples, in seconds.
fn times(path: &Path, of: &str) -> Vec<f64> {
    let mut reader = Reader::open(File::open(path).expect("a file")).expect("a whole recording");
    let mut times = Vec::new();
    while let Some(event) = reader.next().expect("an event") {
        if let EventKind::Sample { node, .. } = event.what
            && reader.nodes()[node].path == of
        {
            times.push(event.unix_ns as f64 / 1e9);
        }
    }
    times
}

/// The one saved file for this reason, when it is there.
fn saved(folder: &Path, why: &str) -> PathBuf {
    let find = || {
        let all = recorder::kept::saved(folder).ok()?;
        let end = format!("-{why}.mcap");
        let mut of_it = all
            .into_iter()
            .filter(|path| path.to_string_lossy().ends_with(&end));
        of_it.next()
    };
    eventually("a saved black box", || find().is_some());
    find().expect("it was there")
}

#[test]
fn the_last_minutes_are_fetched_with_what_programs_did() {
    let Some((robot, folder)) = robot() else {
        return;
    };
    let output = robot.run(
        "drive.js",
        "brick.motor(M3).setPower(25); print('on the way'); script.wait(200);",
    );
    assert_eq!(output.status.code(), Some(0), "{}", output.stderr);
    let home = &robot.robot.home;
    let file = home.0.dir().join("last.mcap");
    let name = file.to_str().expect("UTF-8");
    let output = home.run(&["box", "save", "-o", name, "--robot", robot.ip()]);
    assert_eq!(output.status.code(), Some(0), "{}", output.stderr);
    assert!(output.stdout.contains("all is there"), "{}", output.stdout);
    let (samples, lines) = content(&file);
    for node in ["sensors/A1", "encoders/E3", "motors/M3", "accelerometer"] {
        assert!(
            samples.get(node).is_some_and(|count| *count > 1),
            "{samples:?}"
        );
    }
    let has = |story, text: &str| {
        lines
            .iter()
            .any(|(of, line)| *of == story && line.contains(text))
    };
    assert!(
        has(Story::Programs, "drive.js has started as JavaScript"),
        "{lines:?}"
    );
    assert!(has(Story::Output, "print: on the way"), "{lines:?}");
    assert!(has(Story::Programs, "drive.js has ended"), "{lines:?}");
    assert!(has(Story::World, "\"robots\":[{\"at\":["), "{lines:?}");
    let reader = Reader::open(File::open(&file).expect("a file")).expect("a recording");
    let attached = reader.attachments();
    for wanted in ["world.json", "config.lua", "programs/drive.js"] {
        let is_there = attached.iter().any(|(name, _)| name == wanted);
        assert!(is_there, "{attached:?}");
    }
    let words = ["info", name, "--attachment", "programs/drive.js"];
    let program = home.run(&words).good();
    assert!(program.contains("print('on the way')"), "{program}");
    // The robot has it too, and what is there is not written over.
    assert_eq!(content(&saved(&folder, "asked")).1, lines);
    let output = home.run(&["box", "save", "-o", name, "--robot", robot.ip()]);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    let why = "last.mcap is there already: --force replaces it";
    assert!(output.stderr.contains(why), "{}", output.stderr);
    let before = fs::read(&file).expect("a file");
    let words = ["box", "save", "--force", "-o", name, "--robot", robot.ip()];
    home.run(&words).good();
    assert_ne!(fs::read(&file).expect("a file"), before);
}

#[test]
fn a_crash_of_a_program_and_of_trikd_saves_what_was_before() {
    let Some((robot, folder)) = robot() else {
        return;
    };
    let output = robot.run("bad.js", "print('last words'); throw 'boom';");
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    let (_, lines) = content(&saved(&folder, "crash"));
    let texts: Vec<&str> = lines.iter().map(|(_, text)| text.as_str()).collect();
    assert!(texts.contains(&"print: last words\n"), "{texts:?}");
    assert!(
        texts.iter().any(|text| text.contains("has failed")),
        "{texts:?}"
    );
    processes::signal(robot.trikd().1, Signal::SIGKILL);
    let (samples, lines) = content(&saved(&folder, "restart"));
    assert!(
        samples.get("sensors/A1").is_some_and(|count| *count > 1),
        "{samples:?}"
    );
    assert!(
        lines.iter().any(|(_, text)| text == "print: last words\n"),
        "{lines:?}"
    );
}

#[test]
fn a_robot_is_recorded_over_the_network_with_patterns_and_a_rate() {
    let Some((robot, _)) = robot() else { return };
    let home = &robot.robot.home;
    let record = |name: &str, words: &[&str]| {
        let file = home.0.dir().join(name);
        let all = [
            "record",
            "--robot",
            robot.ip(),
            "-o",
            file.to_str().expect("UTF-8"),
        ];
        let all: Vec<&str> = all.iter().chain(words).copied().collect();
        (home.run(&all), file)
    };
    let (output, file) = record(
        "some.mcap",
        &["--only", "sensors/A*", "--hz", "5", "--seconds", "2"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", output.stderr);
    assert!(
        output.stdout.contains("the time is over"),
        "{}",
        output.stdout
    );
    let (samples, _) = content(&file);
    let names: Vec<&str> = samples.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "sensors/A1",
            "sensors/A2",
            "sensors/A3",
            "sensors/A4",
            "sensors/A5",
            "sensors/A6"
        ]
    );
    // 5 Hz for as long as it lasted, which a busy machine does not always reach; and what the node had before.
    let times = times(&file, "sensors/A1");
    let lasted_s = times[times.len() - 1] - times[0];
    let most = 5.0 * lasted_s + 2.0;
    let is_paced = times.len() >= 3 && times.len() as f64 <= most;
    assert!(is_paced, "{lasted_s} s: {samples:?}");
    let (output, file) = record("bad.mcap", &["--only", &"x".repeat(300)]);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    assert!(
        output.stderr.contains("a pattern of 300 bytes"),
        "{}",
        output.stderr
    );
    assert!(!file.exists(), "nothing was begun");
}

/// What a connection hears after these frames, up to this text.
fn talk(robot: &Reachable, port: u16, frames: &[&str], last: &str) -> String {
    let mut stream = TcpStream::connect((robot.ip(), port)).expect("trikd");
    for frame in frames {
        write!(stream, "{}:{frame}", frame.len()).expect("sent");
    }
    stream.set_read_timeout(Some(SOON)).expect("a time");
    let mut all = Vec::new();
    let mut piece = [0; 4096];
    loop {
        let text = String::from_utf8_lossy(&all).into_owned();
        if text.contains(last) || all.len() > 1 << 20 {
            return text;
        }
        match stream.read(&mut piece) {
            Ok(count @ 1..) => all.extend_from_slice(&piece[..count]),
            end => panic!("{end:?} before {last}: {text}"),
        }
    }
}

#[test]
fn every_node_is_asked_for_by_its_name_and_none_outside_of_the_tree() {
    let Some((robot, _)) = robot() else { return };
    eventually("a battery", || {
        talk(&robot, 9000, &["sensor:battery"], "sensor:battery:").contains("sensor:battery:1")
    });
    let all = talk(
        &robot,
        9000,
        &[
            "sensor:accelerometer",
            "sensor:motors/M1",
            "sensor:../../etc",
            "sensor:nothing/there",
        ],
        "sensor:nothing/there:",
    );
    assert!(all.contains("sensor:accelerometer:("), "{all}");
    assert!(all.contains("sensor:motors/M1:0"), "{all}");
    // Frames have their length, so nothing comes after these names.
    let nothing = ["17:sensor:../../etc:", "21:sensor:nothing/there:"].concat();
    assert!(all.ends_with(&nothing), "{all}");
}

#[test]
fn streams_that_mean_nothing_are_refused_and_many_clients_that_do_not_read_harm_nobody() {
    let Some((robot, _)) = robot() else { return };
    for (request, why) in [
        ("stream:a;hz=0", "is no rate"),
        ("stream:a;x", "is no option"),
    ] {
        let all = talk(&robot, 9000, &[request], why);
        assert!(all.contains("error: ") && all.contains(why), "{all}");
    }
    let why = "a recording is on its way already";
    let twice = talk(
        &robot,
        8888,
        &["stream:battery;hz=1", "stream:battery;hz=1"],
        why,
    );
    assert!(twice.contains(why), "{twice}");
    let mut silent = Vec::new();
    for _ in 0..40 {
        let mut stream = TcpStream::connect((robot.ip(), 9000)).expect("trikd");
        stream.write_all(b"7:stream:").expect("sent");
        silent.push(stream);
    }
    // The last ones have found no room; the robot goes on, and everybody else is served.
    let output = robot.run("quick.js", "print('served');");
    assert_eq!(output.stdout, "served\n", "{}", output.stderr);
    drop(silent);
    let home = &robot.robot.home;
    let file = home.0.dir().join("after.mcap");
    let name = file.to_str().expect("UTF-8");
    let words = [
        "record",
        "--robot",
        robot.ip(),
        "-o",
        name,
        "--seconds",
        "1",
    ];
    eventually("room for one more", || {
        let _ = fs::remove_file(&file);
        tools::run(&mut home.command(&words), b"").status.code() == Some(0)
            && content(&file).0.contains_key("sensors/A1")
    });
}
