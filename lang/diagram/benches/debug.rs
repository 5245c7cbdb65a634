//! What a debugger costs: programs with nobody attached, attached, and with their past kept, as ratios to a bare machine;
//! and how long it takes to go back over a minute.
//!
//! `cargo bench -p lang-diagram --bench debug`; the best of several runs counts, in turns.

use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

use lang_diagram::brick::{Brick, Command};
use lang_diagram::debug::{Back, Breakpoint, Session, Step};
use lang_diagram::limits;
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Machine, Options, STEP_MS};
use lang_diagram::ports::Port;
use lang_diagram::program::Program;
use lang_diagram::sketch::Sketch;
use needs::Random;

const RUNS: u32 = 7;
/// A minute of model time.
const MINUTE: u32 = 60_000 / STEP_MS;
/// Going back may take so long.
const GOAL_MS: f64 = 100.0;

/// Sensors that never rest.
struct Robot(Random);

impl Brick for Robot {
    fn command(&mut self, command: Command<'_>) {
        black_box(command);
    }

    fn scalar(&mut self, _: Port) -> Option<i32> {
        i32::try_from(self.0.below(128)).ok()
    }

    fn vector(&mut self, _: Port, _: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, _: i32) -> i32 {
        low
    }
}

/// A controller: two sensors, two motors, a round each 10 ms. The id of the block that computes.
fn controller() -> (Rc<Program>, String) {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = sketch.block("Function", &[("Body", "old = 0; kp = 0.5; kd = 2")]);
    let body = "e = sensorA1 - sensorA2; u = kp * e + kd * (e - old); old = e";
    let compute = sketch.block("Function", &[("Body", body)]);
    let motor = |sketch: &mut Sketch, port, power| {
        sketch.block("TrikV6EnginesForward", &[("Ports", port), ("Power", power)])
    };
    let left = motor(&mut sketch, "M3", "50 + u");
    let right = motor(&mut sketch, "M4", "50 - u");
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[start, set, compute, left, right, wait, compute]);
    let project = sketch.project();
    let mut blocks = project.diagrams.iter().flat_map(|sheet| &sheet.blocks);
    let id = blocks.find(|block| block.properties.values().any(|text| text == body));
    let id = id.unwrap().id.clone();
    let lowered = lower(&project, World::default()).unwrap();
    (Rc::new(lowered.program), id)
}

fn session(program: &Rc<Program>, keeps: bool) -> Session {
    let mut session = Session::new(program.clone(), Options::default());
    if keeps {
        session.keep(limits::HISTORY_BYTES);
    }
    session
}

fn minute(session: &mut Session) -> f64 {
    let mut robot = Robot(Random::new(1));
    let began = Instant::now();
    for step in 0..MINUTE {
        session.step(step * STEP_MS, &mut robot, &mut Deaf);
    }
    // A program that is stopped would cost nothing.
    assert!(session.stop().is_none());
    began.elapsed().as_secs_f64() * 1000.0
}

fn bare(program: &Rc<Program>) -> f64 {
    let mut machine = Machine::new(program.clone(), Options::default());
    let mut robot = Robot(Random::new(1));
    let began = Instant::now();
    for step in 0..MINUTE {
        machine.step(step * STEP_MS, &mut robot, &mut Deaf);
    }
    began.elapsed().as_secs_f64() * 1000.0
}

fn costs(program: &Rc<Program>, id: &str) {
    let mut best = [f64::MAX; 5];
    for _ in 0..RUNS {
        let alone = Machine::new(program.clone(), Options::default());
        let mut marked = session(program, false);
        let point = Breakpoint {
            condition: "old > 100000".into(),
            ..Breakpoint::before(id)
        };
        marked.add(point).unwrap();
        let took = [
            bare(program),
            minute(&mut Session::alone(alone)),
            minute(&mut session(program, false)),
            minute(&mut session(program, true)),
            minute(&mut marked),
        ];
        for (best, took) in best.iter_mut().zip(took) {
            *best = best.min(took);
        }
    }
    let [bare, alone, attached, kept, marked] = best;
    println!("a minute of a controller, bare machine: {bare:.2} ms");
    for (name, took) in [
        ("nobody attached", alone),
        ("attached", attached),
        ("attached, its past kept", kept),
        ("attached, a condition in each round", marked),
    ] {
        println!("  {name}: {:.2} of the bare machine", took / bare);
    }
}

fn told(name: &str, mut took: Vec<f64>) {
    took.sort_by(f64::total_cmp);
    let most = took.last().copied().unwrap_or_default();
    let median = took.get(took.len() / 2).copied().unwrap_or_default();
    let is_met = if most <= GOAL_MS { "met" } else { "not met" };
    println!("  {name}: median {median:.2} ms, most {most:.2} ms; goal {GOAL_MS} ms {is_met}");
}

fn way_back(program: &Rc<Program>, id: &str) {
    let mut session = session(program, true);
    minute(&mut session);
    session.debugger().pause();
    session.step(MINUTE * STEP_MS, &mut Robot(Random::new(1)), &mut Deaf);
    let (from_ms, bytes) = session.kept().unwrap();
    println!(
        "back over a minute, kept from {from_ms} ms on in {} KiB:",
        bytes / 1024
    );
    let mut timed = |how: Back| {
        let began = Instant::now();
        black_box(session.back(how)).unwrap();
        began.elapsed().as_secs_f64() * 1000.0
    };
    told(
        "200 steps",
        (0..200).map(|_| timed(Back::Step(Step::Over))).collect(),
    );
    let times = (1..60).rev().map(|second| timed(Back::To(second * 1000)));
    told("to each second", times.collect());
    told("to the beginning", vec![timed(Back::Oldest)]);
    session.to_present();
    let point = Breakpoint {
        condition: "old > 100000".into(),
        ..Breakpoint::before(id)
    };
    session.add(point).unwrap();
    let began = Instant::now();
    black_box(session.back(Back::Continue)).unwrap();
    let took = began.elapsed().as_secs_f64() * 1000.0;
    told("past a condition that never holds", vec![took]);
}

fn main() {
    let (program, id) = controller();
    costs(&program, &id);
    way_back(&program, &id);
}
