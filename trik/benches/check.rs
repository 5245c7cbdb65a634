//! How fast tasks are judged: whole processes, as a grader starts them.
//!
//! Runs the program on real tasks of `../shared/data`; without them it says so and measures nothing. Ratios are against
//! what one run of TRIK Studio's `2D-model` takes on a PC by the record: 0.7 s at least.

use nix::sys::resource::{UsageWho, getrusage};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const TRIK: &str = env!("CARGO_BIN_EXE_trik");
/// What the original takes for one run, start included, in milliseconds.
const ORIGINAL_MS: f64 = 700.0;
const ROUNDS: usize = 41;

fn main() {
    let Some(data) = needs::data() else {
        return;
    };
    println!(
        "{:<44} {:>9} {:>9} {:>11} {:>12}",
        "one task, a whole process", "p50 ms", "p90 ms", "model time", "2D-model/us"
    );
    let tasks = [
        ("move forward", "course/move-forward--e873613c.qrs"),
        ("sensor of distance", "course/monster--79c0f8ff.qrs"),
        ("labyrinth, 35 s", "course/example17-at-start.qrs"),
        (
            "along the box, sensor, 40 s",
            "course/along-the-box--e52f9a1d.qrs",
        ),
        ("to the line, floor", "examples/3._StraightToTheLine.qrs"),
        (
            "along the line, floor, 60 s",
            "examples/4._AlongTheLine.qrs",
        ),
        ("camera, floor, 60 s", "examples/6._AlongTheLineVideo.qrs"),
    ];
    for (name, file) in tasks {
        one(name, &data.join(file));
    }
    start();
    many(&data);
    let most = getrusage(UsageWho::RUSAGE_CHILDREN).map_or(0, |usage| usage.max_rss());
    println!("largest process: {:.1} MiB", most as f64 / 1024.0);
}

/// Milliseconds of a process with these words, and what it said.
fn timed(words: &[&str]) -> (f64, String) {
    let begin = Instant::now();
    let output = Command::new(TRIK)
        .args(words)
        .stdin(Stdio::null())
        .output()
        .expect("trik");
    let ms = begin.elapsed().as_secs_f64() * 1000.0;
    (ms, String::from_utf8_lossy(&output.stdout).into_owned())
}

fn one(name: &str, file: &Path) {
    let file = file.to_str().expect("UTF-8");
    let words = ["check", file, "--results", "-", "--time-limit", "60"];
    let mut all = Vec::new();
    let mut said = String::new();
    for _ in 0..ROUNDS {
        let (ms, text) = timed(&words);
        all.push(ms);
        said = text;
    }
    all.sort_by(f64::total_cmp);
    let (p50, p90) = (all[ROUNDS / 2], all[ROUNDS * 9 / 10]);
    let model: f64 = said
        .split("\"ms\":")
        .nth(1)
        .and_then(|rest| rest.split(',').next())
        .and_then(|number| number.parse().ok())
        .unwrap_or(0.0);
    println!(
        "{name:<44} {p50:>9.2} {p90:>9.2} {:>10.0}x {:>11.0}x",
        model / p50,
        ORIGINAL_MS / p50
    );
}

/// A process that does nothing.
fn start() {
    let mut all: Vec<f64> = (0..ROUNDS).map(|_| timed(&["--version"]).0).collect();
    all.sort_by(f64::total_cmp);
    println!(
        "{:<44} {:>9.2} {:>9.2}",
        "starting the program alone",
        all[ROUNDS / 2],
        all[ROUNDS * 9 / 10]
    );
}

/// A thousand submissions of the course.
fn many(data: &Path) {
    let folder = std::env::temp_dir().join(format!("trik-bench-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let mut solutions: Vec<PathBuf> = fs::read_dir(data.join("course"))
        .expect("the course")
        .map(|entry| entry.expect("an entry").path())
        .collect();
    solutions.sort();
    for number in 0..1000 {
        let from = &solutions[number % solutions.len()];
        fs::copy(from, folder.join(format!("{number:04}.qrs"))).expect("a copy");
    }
    let path = folder.to_str().expect("UTF-8").to_owned();
    for jobs in ["1", "2"] {
        let (ms, said) = timed(&["check", &path, "--jobs", jobs]);
        let last = said.lines().last().unwrap_or_default();
        println!(
            "1000 submissions, {jobs} at once: {:.2} s, {:.0} a second ({last})",
            ms / 1000.0,
            1e6 / ms
        );
    }
    let _ = fs::remove_dir_all(&folder);
}
