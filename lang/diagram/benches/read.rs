//! How long saves take to be read, to be read, checked and lowered, and to be written: one line for each real save that
//! is there, and for one made here.
//!
//! `cargo bench -p lang-diagram --bench read`. The goal is 20 ms for reading, checking and lowering together on one core of a PC.

use lang_diagram::check::check;
use lang_diagram::lower::{World, lower};
use lang_diagram::read::read;
use lang_diagram::sketch::Sketch;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How often each thing is done.
const RUNS: u32 = 20;

/// How long this thread has had a processor; wall time where Linux does not tell, so that others' work counts too.
fn now(begin: Instant) -> Duration {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ran = told.split(' ').next().and_then(|text| text.parse().ok());
    ran.map_or_else(|| begin.elapsed(), Duration::from_nanos)
}

/// The mean time of some runs.
fn mean(mut work: impl FnMut()) -> Duration {
    work();
    let origin = Instant::now();
    let begin = now(origin);
    for _ in 0..RUNS {
        work();
    }
    (now(origin) - begin) / RUNS
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn measure(name: &str, bytes: &[u8]) -> Duration {
    let opened = match read(bytes) {
        Ok(opened) => opened,
        Err(problems) => {
            println!("{name}: {}", problems[0]);
            return Duration::ZERO;
        }
    };
    let reading = mean(|| drop(std::hint::black_box(read(bytes))));
    let all = mean(|| {
        if let Ok(opened) = read(bytes) {
            std::hint::black_box(check(&opened.project, World::default()));
            drop(std::hint::black_box(lower(
                &opened.project,
                World::default(),
            )));
        }
    });
    let mut changed = opened.save.clone();
    let is_set = changed.set_meta("exerciseId", Some("bench")).is_ok();
    let writing = mean(|| drop(std::hint::black_box(changed.write())));
    let diagrams = &opened.project.diagrams;
    let blocks: usize = diagrams.iter().map(|diagram| diagram.blocks.len()).sum();
    println!(
        "{:8.2} {:8.2} {:8.2} {:7} {:6} {}{}",
        ms(reading),
        ms(all),
        ms(writing),
        bytes.len() / 1000,
        blocks,
        name,
        if is_set { "" } else { " (not changed)" }
    );
    all
}

fn made() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let blocks: Vec<_> = (0..1000)
        .map(|at| sketch.block("Timer", &[("Delay", &at.to_string())]))
        .collect();
    sketch.chain(&blocks);
    sketch.qrs().unwrap_or_default()
}

fn main() {
    let inside = |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = needs::data()
        .into_iter()
        .flat_map(inside)
        .flat_map(|folder| inside(folder.path()))
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"))
        .collect();
    paths.sort();
    println!(" read ms   all ms write ms      kB blocks (ms of a processor, mean of {RUNS} runs)");
    measure("1000 timers in a row", &made());
    let times = paths.iter().filter_map(|path| {
        let bytes = std::fs::read(path).ok()?;
        Some(measure(&path.file_name()?.to_string_lossy(), &bytes))
    });
    match times.max() {
        Some(longest) => println!(
            "longest of the real ones, read, checked and lowered: {:.2} ms",
            ms(longest)
        ),
        None => println!("no ../shared: only a save made here"),
    }
}
