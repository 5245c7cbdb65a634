//! How long saves take to be read and written: one line for each real save that is there, and for one made here.
//!
//! `cargo bench -p lang --bench read`. The goal is 20 ms for reading, checking and lowering together on one core of a PC.

use lang::diagram::read::read;
use lang::diagram::sketch::Sketch;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The shortest of some runs: what is longer was disturbed.
fn shortest(mut work: impl FnMut()) -> Duration {
    let one = || {
        let begin = Instant::now();
        work();
        begin.elapsed()
    };
    std::iter::repeat_with(one)
        .take(15)
        .min()
        .unwrap_or_default()
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
    let reading = shortest(|| drop(std::hint::black_box(read(bytes))));
    let mut changed = opened.save.clone();
    let is_set = changed.set_meta("exerciseId", Some("bench")).is_ok();
    let writing = shortest(|| drop(std::hint::black_box(changed.write())));
    let diagrams = &opened.project.diagrams;
    let blocks: usize = diagrams.iter().map(|diagram| diagram.blocks.len()).sum();
    println!(
        "{:8.2} {:8.2} {:7} {:6} {}{}",
        ms(reading),
        ms(writing),
        bytes.len() / 1000,
        blocks,
        name,
        if is_set { "" } else { " (not changed)" }
    );
    reading
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
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    let inside = |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = inside(data.to_owned())
        .flat_map(|folder| inside(folder.path()))
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"))
        .collect();
    paths.sort();
    println!(" read ms write ms      kB blocks");
    measure("1000 timers in a row", &made());
    let times = paths.iter().filter_map(|path| {
        let bytes = std::fs::read(path).ok()?;
        Some(measure(&path.file_name()?.to_string_lossy(), &bytes))
    });
    match times.max() {
        Some(longest) => println!("longest of the real ones: {:.2} ms", ms(longest)),
        None => println!("no ../shared: only a save made here"),
    }
}
