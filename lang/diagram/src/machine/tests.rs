//! Small programs on the stand-in: what the real program was seen to do with the same ones, and what its sources say.

mod control;
mod devices;
mod hostile;
mod rows;
mod threads;

use std::rc::Rc;

use super::trace::{Deaf, Trace};
use super::{Machine, Options, STEP_MS, Status};
use crate::lower::{World, lower};
use crate::program::Node;
use crate::sketch::{Sketch, Spot};
use crate::stand_in::{Placing, StandIn};
use lang_expr::{Compat, Value};

/// What a run leaves.
struct Ran {
    machine: Machine,
    robot: StandIn,
    status: Status,
}

impl Ran {
    fn errors(&self) -> Vec<String> {
        let errors = self.machine.errors().iter();
        errors.map(|error| error.words.english.clone()).collect()
    }

    fn text(&self, variable: &str) -> String {
        let value = self.machine.variable(variable);
        value.map_or_else(|| "nothing".into(), |value| value.to_text().to_string())
    }

    fn log(&self) -> Vec<String> {
        let log = self.robot.log.iter();
        log.map(|(now, line)| format!("{now} {line}")).collect()
    }

    fn end(&self) -> Option<u32> {
        match self.status {
            Status::Ended { at, .. } => Some(at),
            Status::Running => None,
        }
    }
}

/// Runs a sketch as the original's simulator does, for at most so many milliseconds.
fn run(sketch: &Sketch, ms: u32) -> Ran {
    run_with(sketch, ms, Options::simulated(), World::default(), |_| {})
}

fn run_with(
    sketch: &Sketch,
    ms: u32,
    options: Options,
    world: World,
    script: impl Fn(&mut StandIn),
) -> Ran {
    let lowered = lower(&sketch.project(), world).unwrap();
    let mut machine = Machine::new(Rc::new(lowered.program), options);
    let mut robot = StandIn::new(Placing::default());
    script(&mut robot);
    let mut status = Status::Running;
    for now in (0..=ms).step_by(STEP_MS as usize) {
        if now > 0 {
            robot.tick();
        }
        status = machine.step(now, &mut robot, &mut Deaf);
        if status != Status::Running {
            break;
        }
    }
    Ran {
        machine,
        robot,
        status,
    }
}

/// A chain from an initial node to a final one.
fn chain(blocks: &[(&str, &[(&str, &str)])]) -> Sketch {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let mut spots = vec![start];
    for (kind, properties) in blocks {
        spots.push(sketch.block(kind, properties));
    }
    spots.push(sketch.block("FinalNode", &[]));
    sketch.chain(&spots);
    sketch
}

/// A block that runs statements.
fn code(sketch: &mut Sketch, body: &str) -> Spot {
    sketch.block("Function", &[("Body", body)])
}

/// Keeps everything that is told.
#[derive(Default)]
struct Recorder {
    lines: Vec<String>,
}

impl Trace for Recorder {
    fn entered(&mut self, now: u32, thread: u16, node: Node) {
        self.lines.push(format!("{now} {thread} at {node}"));
    }

    fn changed(&mut self, now: u32, _: u16, variable: &str, value: &Value) {
        self.lines
            .push(format!("{now} {variable} = {}", value.to_text()));
    }

    fn trap(&mut self, now: u32, problem: &lang_text::problem::Problem) {
        self.lines.push(format!("{now} {}", problem.words.english));
    }

    fn thread_started(&mut self, now: u32, thread: u16, name: &str) {
        self.lines.push(format!("{now} {thread} is {name}"));
    }

    fn thread_ended(&mut self, now: u32, thread: u16) {
        self.lines.push(format!("{now} {thread} ends"));
    }
}

#[test]
fn everything_is_told_in_order() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, "x = 1; y = x + 1");
    let wait = sketch.block("Timer", &[("Delay", "15")]);
    let wrong = code(&mut sketch, "z = 1 / 0");
    sketch.chain(&[start, set, wait, wrong]);
    sketch.link(wrong, wrong);
    let lowered = lower(&sketch.project(), World::default()).unwrap();
    let mut machine = Machine::new(Rc::new(lowered.program), Options::simulated());
    let (mut robot, mut recorder) = (StandIn::default(), Recorder::default());
    for now in (0..=100).step_by(10) {
        machine.step(now, &mut robot, &mut recorder);
    }
    let expected = [
        "0 0 is main",
        "30 0 at 0",
        "30 0 at 1",
        "30 x = 1",
        "30 y = 2",
        "30 0 at 2",
        "50 0 at 3",
        "50 Division by zero",
        "50 0 ends",
    ];
    assert_eq!(recorder.lines, expected);
    let ended = Status::Ended {
        at: 50,
        with_errors: true,
    };
    assert_eq!(machine.status(), ended);
    let error = &machine.errors()[0];
    assert_eq!(error.place.property.as_deref(), Some("Expression"));
    assert!(error.to_string().contains("'Expression', 1:"), "{error}");
    assert_eq!(machine.step(200, &mut robot, &mut recorder), ended);
}

#[test]
fn what_runs_can_be_looked_at_and_stopped() {
    let sketch = chain(&[
        ("Function", &[("Body", "x = 7")]),
        ("TrikV6EnginesForward", &[("Power", "50")]),
        ("Timer", &[("Delay", "100000")]),
    ]);
    let mut ran = run(&sketch, 500);
    assert_eq!(ran.status, Status::Running);
    let threads: Vec<_> = ran.machine.threads().collect();
    assert_eq!(threads, [("main", 3)]);
    let row = ran.machine.program().row(3).unwrap();
    assert_eq!(row.kind, "Timer");
    let names: Vec<_> = ran.machine.variables().map(|(name, _)| name).collect();
    assert_eq!(names, ["x"]);
    ran.machine.stop(&mut ran.robot, &mut Deaf);
    assert_eq!(ran.log(), ["30 power M3 50", "30 power M4 50", "500 rest"]);
    assert_eq!(ran.machine.threads().count(), 0);
}

#[test]
fn the_same_program_does_the_same_again() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let random = sketch.block("Randomizer", &[("LowerBound", "1"), ("UpperBound", "50")]);
    let motors = sketch.block("TrikV6EnginesForward", &[("Power", "x")]);
    let wait = sketch.block("Timer", &[("Delay", "x * 3")]);
    sketch.chain(&[start, random, motors, wait, random]);
    let (one, two) = (run(&sketch, 5000), run(&sketch, 5000));
    assert!(one.log().len() > 50);
    assert_eq!(one.log(), two.log());
}

#[test]
fn on_a_robot_the_first_block_runs_at_once() {
    let sketch = chain(&[("Function", &[("Body", "t = time()")])]);
    let ran = run_with(
        &sketch,
        100,
        Options::of(World::Robot),
        World::Robot,
        |_| {},
    );
    assert_eq!((ran.text("t").as_str(), ran.end()), ("0", Some(0)));
    let options = Options {
        compat: Compat::Fixed,
        in_turns: false,
    };
    assert_eq!(
        run_with(&sketch, 100, options, World::default(), |_| {}).end(),
        Some(0)
    );
}
