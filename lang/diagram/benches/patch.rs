//! What a new version of a running diagram costs between two steps, as a part of one, beside what is done while the program
//! runs: reading, checking.
//!
//! `cargo bench -p lang-diagram --bench patch`; the median of several rounds counts, with the worst beside it.

use std::hint::black_box;
use std::time::Instant;

use lang_diagram::debug::Session;
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::patch::{Version, WhenGone};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Options, STEP_MS};
use lang_diagram::read::read;
use lang_diagram::sketch::Sketch;
use lang_diagram::stand_in::StandIn;

const ROUNDS: u32 = 20;

/// A loop that counts, with so many blocks behind it in each round, the last ones of which have another number.
fn save(blocks: usize, changed: usize, by: u32) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let clear = sketch.block("Function", &[("Body", "n = 0; m = 0")]);
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    let count = sketch.block("Function", &[("Body", "n = n + 1")]);
    let many = (0..blocks).map(|at| {
        let by = if at + changed < blocks { 0 } else { by };
        let body = format!("m = (m * 3 + n * {at} + {by}) % 1000");
        sketch.block("Function", &[("Body", &body)])
    });
    let many: Vec<_> = many.collect();
    sketch.chain(&[start, clear, wait, count]);
    sketch.link(count, many[0]);
    sketch.chain(&many);
    sketch.link(many[blocks - 1], wait);
    sketch.qrs().expect("a save")
}

fn ms(began: Instant) -> f64 {
    began.elapsed().as_secs_f64() * 1000.0
}

/// The median and the worst.
fn of(mut took: Vec<f64>) -> (f64, f64) {
    took.sort_by(f64::total_cmp);
    (took[took.len() / 2], took[took.len() - 1])
}

fn look(blocks: usize, changed: usize) {
    let saves = [save(blocks, changed, 1), save(blocks, changed, 2)];
    let first = read(&saves[0]).expect("a project").project;
    let program = lower(&first, World::Robot).expect("a program").program;
    let mut session = Session::new(program.into(), Options::of(World::Robot));
    let mut robot = StandIn::default();
    let (mut beside, mut lowered, mut exchanged) = (Vec::new(), Vec::new(), Vec::new());
    for round in 0..ROUNDS {
        session.step(round * STEP_MS, &mut robot, &mut Deaf);
        let began = Instant::now();
        let project = read(&saves[(round as usize + 1) % 2])
            .expect("a project")
            .project;
        black_box(Version::mistakes(&project, World::Robot)).expect("no mistakes");
        beside.push(ms(began));
        let began = Instant::now();
        let version = Version::of_checked(&project, World::Robot).expect("a version");
        lowered.push(ms(began));
        let began = Instant::now();
        let patched = session.patch(&version, WhenGone::End, &mut robot, &mut Deaf);
        exchanged.push(ms(began));
        assert_eq!(patched.expect("changed").gone, 0);
    }
    let step = f64::from(STEP_MS);
    println!("{changed} of {blocks} blocks change:");
    let (median, worst) = of(beside);
    println!("  read and checked beside the program: {median:.2} ms, most {worst:.2} ms");
    for (name, took) in [("made a program", lowered), ("exchanged", exchanged)] {
        let (median, worst) = of(took);
        let part = median / step;
        println!(
            "  {name} between two steps: {median:.3} ms, most {worst:.3} ms; {part:.3} of a step"
        );
    }
}

fn main() {
    for (blocks, changed) in [(30, 1), (300, 1), (300, 300), (10_000, 1), (10_000, 10_000)] {
        look(blocks, changed);
    }
}
