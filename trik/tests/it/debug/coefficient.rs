//! A coefficient changes while the robot drives by it, under the record: example 10 of TRIK Studio, along a wall.
//!
//! Needs that project. A round of its loop tells both motors something, every 100 ms; each round counts itself here.

use crate::programs::Reachable;
use crate::rig::Home;
use harness::eventually;
use journal::read::{EventKind, Reader};
use lang_diagram::read::read;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs::{self, File};
use std::path::Path;
use std::process::Stdio;
use std::sync::Arc;

/// What its loop computes with.
const FORMULA: &str = "u=kp*(";

/// The example whose rounds count themselves and print that, with another text instead of kp in its loop.
fn version(example: &[u8], kp: &str) -> Vec<u8> {
    let mut save = read(example).expect("a project").save;
    let (project, _) = save.project();
    for block in project.diagrams.iter().flat_map(|sheet| &sheet.blocks) {
        let Some(body) = block.properties.get("Body") else {
            continue;
        };
        let body = match body.contains(FORMULA) {
            true => {
                let body = body.replace(FORMULA, &format!("u={kp}*("));
                format!("n = n + 1; print(n);\n{body}")
            }
            false => format!("n = 0;\n{body}"),
        };
        save.set_property(&block.id, "Body", &body)
            .expect("a property");
    }
    save.write().expect("a save")
}

/// When a motor was told something, in milliseconds, each command in its order; and how many the record lacks.
fn commands(record: &Path, motor: &str) -> (Vec<u64>, u32) {
    let file = File::open(record).expect("a record");
    let mut reader = Reader::open(file).expect("a whole record");
    let (mut times, mut lacks, mut last) = (Vec::new(), 0, None);
    while let Some(event) = reader.next().expect("an event") {
        if let EventKind::Sample {
            node,
            sequence,
            tuple,
            ..
        } = event.what
            && reader.nodes()[node].path == motor
        {
            lacks += last.map_or(0, |last| sequence - last - 1);
            last = Some(sequence);
            times.push((
                event.unix_ns / 1_000_000,
                tuple.iter().any(|byte| *byte != 0),
            ));
        }
    }
    // Before and after the program motors are brought to rest.
    let first = times.iter().position(|told| told.1).unwrap_or(0);
    let end = times.len() - times.iter().rev().position(|told| told.1).unwrap_or(0);
    let times = times[first..end].iter().map(|told| told.0).collect();
    (times, lacks)
}

#[test]
fn no_motor_command_is_missing_in_the_record_when_kp_of_example_10_changes() {
    let Some(data) = needs::data() else { return };
    let Some(home) = Home::new() else { return };
    let example = data.join("examples/10._AlongTheBox.qrs");
    let field = example.to_str().expect("UTF-8").to_owned();
    let example = fs::read(&example).expect("the example");
    let home = Arc::new(home);
    let robot = Reachable::beside(&home, &["--field", &field]);
    let record = home.0.path("kp.mcap");
    let mut recorder = home
        .command(&["record", "--only", "motors/M3", "--only", "motors/M4"])
        .args([&robot.robot.root, Path::new("-o"), &record])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a recorder");
    eventually("a record", || record.exists());

    let file = home.0.file("box.qrs", version(&example, "kp"));
    let running = robot.watch_file(file.to_str().expect("UTF-8"));
    let rounds = || -> Vec<usize> {
        let said = running.said();
        said.lines().filter_map(|line| line.parse().ok()).collect()
    };
    let last = || rounds().last().copied().unwrap_or(0);
    eventually("a robot that drives", || last() >= 10);
    for (count, kp) in (1..).zip(["1.5", "2.0", "kp"]) {
        home.0.file("box.qrs", version(&example, kp));
        let kept = " blocks kept, 0 new, 0 gone";
        eventually("a change", || running.said().matches(kept).count() == count);
        let at = last();
        eventually("rounds by it", || last() >= at + 5);
    }
    home.run(&["set", "kp=1.0", "--robot", robot.ip()]).good();
    let at = last();
    eventually("rounds by it", || last() >= at + 5);
    home.run(&["stop", "--robot", robot.ip()]).good();
    running.says("was stopped by");
    let pid = i32::try_from(recorder.id()).expect("a process");
    kill(Pid::from_raw(pid), Signal::SIGINT).expect("a recorder");
    assert!(recorder.wait().expect("its end").success());

    let counted = rounds();
    let all: Vec<usize> = (1..=counted.len()).collect();
    assert_eq!(counted, all, "the program goes on where it is");
    for motor in ["motors/M3", "motors/M4"] {
        let (times, lacks) = commands(&record, motor);
        assert_eq!(lacks, 0, "{motor}: the recorder was too slow");
        // One for each round, but for one that the stop has cut short.
        let rounds = counted.len() - 1..=counted.len();
        assert!(rounds.contains(&times.len()), "{motor}: {times:?}");
        let gaps = times.windows(2).map(|pair| pair[1] - pair[0]);
        println!(
            "{motor}: {} commands in {} rounds, at most {} ms apart",
            times.len(),
            counted.len(),
            gaps.max().unwrap_or(0)
        );
    }
}
