//! How fast diagrams run: blocks per second on one core with a trace that keeps what it hears, and how that compares to a
//! plain loop over a vector of operations that keeps the same.
//!
//! Beside it: what a loaded diagram takes of memory, and how long real projects take to be read, checked and lowered.
//! `cargo bench -p lang-diagram --bench machine`; the best of several runs counts.

use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use lang_diagram::brick::{Brick, Command};
use lang_diagram::check::check;
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::trace::Trace;
use lang_diagram::machine::{Machine, Options, STEP_MS};
use lang_diagram::ports::Port;
use lang_diagram::read::read;
use lang_diagram::sketch::Sketch;
use lang_expr::Value;

const STEPS: u32 = 200_000;
const RUNS: u32 = 5;

/// Keeps the newest events, as a debugger would.
struct Ring {
    events: Box<[(u32, u16, u32)]>,
    at: usize,
    changes: u32,
}

impl Ring {
    fn new() -> Self {
        Self {
            events: vec![(0, 0, 0); 1024].into(),
            at: 0,
            changes: 0,
        }
    }
}

impl Trace for Ring {
    fn entered(&mut self, now: u32, thread: u16, node: u32) {
        self.events[self.at % 1024] = (now, thread, node);
        self.at += 1;
    }

    fn changed(&mut self, _: u32, _: u16, _: &str, value: &Value) {
        black_box(value);
        self.changes += 1;
    }
}

struct Nothing;

impl Brick for Nothing {
    fn command(&mut self, command: Command<'_>) {
        black_box(command);
    }
    fn scalar(&mut self, _: Port) -> Option<i32> {
        Some(50)
    }
    fn vector(&mut self, _: Port, _: &mut Vec<i32>) -> bool {
        false
    }
    fn random(&mut self, low: i32, _: i32) -> i32 {
        low
    }
}

/// A ring of blocks of one kind after an initial node.
fn ring(kind: &str, properties: &[(&str, &str)], count: usize) -> Sketch {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = sketch.block("Function", &[("Body", "x = 1; y = 2")]);
    let blocks: Vec<_> = (0..count).map(|_| sketch.block(kind, properties)).collect();
    sketch.chain(&[start, set, blocks[0]]);
    sketch.chain(&blocks);
    sketch.link(blocks[count - 1], blocks[0]);
    sketch
}

fn counted() -> Sketch {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let head = sketch.block("Loop", &[("Iterations", "1000000")]);
    let body = sketch.block("FiBlock", &[]);
    sketch.chain(&[start, head]);
    sketch.guarded(head, body, "iteration");
    sketch.guarded(head, start, "");
    sketch.link(body, head);
    sketch
}

/// Blocks per second of the best run.
fn blocks(sketch: &Sketch) -> f64 {
    let program = Rc::new(lower(&sketch.project(), World::default()).unwrap().program);
    let mut best = 0.0_f64;
    for _ in 0..RUNS {
        let mut machine = Machine::new(program.clone(), Options::simulated());
        let mut trace = Ring::new();
        let began = Instant::now();
        for step in 0..STEPS {
            machine.step(step * STEP_MS, &mut Nothing, &mut trace);
        }
        let took = began.elapsed().as_secs_f64();
        assert!(machine.errors().is_empty() && trace.at as u32 > STEPS * 50);
        best = best.max(trace.at as f64 / took);
    }
    best
}

/// The yardstick: what one writes in a few minutes for the same ring.
enum Plain {
    Pass(usize),
    Loop(usize, usize),
}

fn plain() -> f64 {
    let mut best = 0.0_f64;
    for _ in 0..RUNS {
        let ops: Vec<Plain> = (1..=10)
            .map(|next| Plain::Pass(next % 11))
            .chain([Plain::Loop(0, 0)])
            .collect();
        let ops = black_box(ops);
        let mut ring = Ring::new();
        let trace: &mut dyn Trace = black_box(&mut ring);
        let (mut at, mut count) = (0, 0_i64);
        let began = Instant::now();
        let total = u64::from(STEPS) * 100;
        for step in 0..total {
            trace.entered(step as u32, 0, at as u32);
            at = match &ops[at] {
                Plain::Pass(next) => *next,
                Plain::Loop(one, other) => {
                    count += 1;
                    if count % 7 == 0 { *one } else { *other }
                }
            };
        }
        let took = began.elapsed().as_secs_f64();
        black_box(count);
        best = best.max(total as f64 / took);
    }
    best
}

/// Bytes of this process in memory.
fn resident() -> usize {
    let pages = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = pages.split(' ').nth(1).and_then(|pages| pages.parse().ok());
    pages.unwrap_or(0_usize) * 4096
}

/// What one of many machines takes that have run for two seconds, each with a program of its own.
fn memory(project: &lang_diagram::project::Project, kept: &mut Vec<Machine>) -> usize {
    const COPIES: usize = 30;
    let before = resident();
    kept.extend((0..COPIES).map(|_| {
        let program = Rc::new(lower(project, World::default()).unwrap().program);
        let mut machine = Machine::new(program, Options::simulated());
        for step in 0..200 {
            machine.step(step * STEP_MS, &mut Nothing, &mut Ring::new());
        }
        machine
    }));
    // They are kept, so that nobody gets memory that somebody has left.
    resident().saturating_sub(before) / COPIES
}

/// Real projects: time to be read, checked and lowered, and memory of a machine that has run for two seconds.
fn projects() {
    let Some(data) = needs::data() else {
        return;
    };
    let mut kept = Vec::new();
    let (mut slowest, mut largest) = ((0.0_f64, String::new()), (0, String::new()));
    for folder in ["examples", "course", "grading", "structure"] {
        for entry in std::fs::read_dir(data.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if !name.ends_with(".qrs") {
                continue;
            }
            let bytes = std::fs::read(&path).unwrap();
            let (mut best, mut ours) = (f64::MAX, f64::MAX);
            for _ in 0..RUNS {
                let began = Instant::now();
                let opened = read(&bytes).unwrap();
                let between = began.elapsed().as_secs_f64() * 1000.0;
                black_box(check(&opened.project, World::default()));
                black_box(lower(&opened.project, World::default()).unwrap());
                let all = began.elapsed().as_secs_f64() * 1000.0;
                best = best.min(all);
                ours = ours.min(all - between);
            }
            let project = read(&bytes).unwrap().project;
            let blocks: usize = project.diagrams.iter().map(|one| one.blocks.len()).sum();
            let memory = memory(&project, &mut kept);
            println!(
                "{name}: {best:.2} ms, without reading {ours:.2} ms; {blocks} blocks, {} KiB",
                memory / 1024
            );
            if best > slowest.0 {
                slowest = (best, name.clone());
            }
            if memory > largest.0 {
                largest = (memory, name);
            }
        }
    }
    println!("slowest: {:.2} ms ({})", slowest.0, slowest.1);
    println!("largest: {} KiB ({})", largest.0 / 1024, largest.1);
}

fn main() {
    let yardstick = plain();
    println!("plain loop: {:.1} million operations/s", yardstick / 1e6);
    for (name, sketch) in [
        ("merges", ring("FiBlock", &[], 10)),
        ("counted loop", counted()),
        ("x = x + 1", ring("Function", &[("Body", "x = x + 1")], 10)),
        (
            "motors",
            ring("TrikV6EnginesForward", &[("Power", "x + y")], 10),
        ),
    ] {
        let speed = blocks(&sketch);
        println!(
            "{name}: {:.1} million blocks/s, {:.2} of the plain loop",
            speed / 1e6,
            speed / yardstick
        );
    }
    projects();
}
