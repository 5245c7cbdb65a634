//! Debugged programs against the same ones alone, and stops where they were asked for.

mod desk;
mod past;
mod patches;
mod points;
mod random;

use std::rc::Rc;

use super::{Breakpoint, NoBreakpoint, NotNow, Phase, Reason, Session, Step};
use crate::limits;
use crate::lower::{World, lower};
use crate::machine::patch::{Refused, Version, WhenGone};
use crate::machine::trace::Deaf;
use crate::machine::view::{Doing, Waits};
use crate::machine::{Machine, Options, STEP_MS, Status};
use crate::program::Program;
use crate::project::Project;
use crate::sketch::{Sketch, Spot};
use crate::stand_in::{Placing, StandIn};
use random::Dice;

/// A session with its robot and its clock.
struct Desk {
    session: Session,
    robot: StandIn,
    now: u32,
}

impl Desk {
    fn of(project: &Project) -> Self {
        let program = lower(project, World::default()).unwrap().program;
        Self {
            session: Session::new(Rc::new(program), Options::simulated()),
            robot: StandIn::new(Placing::default()),
            now: 0,
        }
    }

    /// Runs until it stops or ends, for at most so many steps.
    fn run(&mut self, steps: u32) -> Phase {
        let mut phase = self.session.phase();
        for _ in 0..steps {
            if phase != Phase::Runs {
                break;
            }
            self.tick();
            phase = self.session.step(self.now, &mut self.robot, &mut Deaf);
        }
        phase
    }

    fn tick(&mut self) {
        if self.session.machine().now() > 0 || self.now > 0 {
            self.now += STEP_MS;
            self.robot.tick();
        } else {
            self.now = STEP_MS;
        }
    }

    /// Goes on for so many steps, from a stop too.
    fn go_on_for(&mut self, steps: u32) {
        self.session.go_on(self.now, &mut self.robot, &mut Deaf);
        self.run(steps);
    }

    fn go_on(&mut self) -> Phase {
        let phase = self.session.go_on(self.now, &mut self.robot, &mut Deaf);
        match phase {
            Phase::Runs => self.run(1000),
            Phase::Stopped(_) | Phase::Ended { .. } => phase,
        }
    }

    fn walk(&mut self, step: Step) -> Phase {
        let stop = self.session.debugger().stop().cloned().unwrap();
        let thread = stop.thread.unwrap();
        let phase = self
            .session
            .walk((thread, step), self.now, &mut self.robot, &mut Deaf);
        match phase {
            Phase::Runs => self.run(1000),
            Phase::Stopped(_) | Phase::Ended { .. } => phase,
        }
    }

    /// The id of the block that is entered next, and why it has stopped.
    fn place(&self, phase: &Phase) -> (String, Reason) {
        let Phase::Stopped(stop) = phase else {
            panic!("{phase:?}");
        };
        let node = stop.node.unwrap();
        let id = self.session.machine().program().id(node).unwrap();
        (id.to_owned(), stop.reason.clone())
    }

    fn variable(&self, name: &str) -> String {
        let value = self.session.machine().variable(name);
        value.map_or_else(|| "nothing".into(), |value| value.to_text().to_string())
    }

    fn stop_at(&mut self, block: &str) -> u32 {
        self.session.add(Breakpoint::before(block)).unwrap()
    }
}

fn code(sketch: &mut Sketch, body: &str) -> Spot {
    sketch.block("Function", &[("Body", body)])
}

/// Counts `n` up and waits, forever. With the ids of its blocks: start, set, count, wait.
fn counting(count: &str, wait: &str) -> (Project, Vec<String>) {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, "n = 0");
    let count = code(&mut sketch, count);
    let wait = sketch.block("Timer", &[("Delay", wait)]);
    sketch.chain(&[start, set, count, wait, count]);
    let project = sketch.project();
    let ids = ids(&project);
    (project, ids)
}

fn ids(project: &Project) -> Vec<String> {
    let blocks = project.diagrams.iter().flat_map(|sheet| &sheet.blocks);
    blocks.map(|block| block.id.clone()).collect()
}

/// What a program does alone.
fn alone(program: &Rc<Program>, options: Options, steps: u32) -> (Vec<(u32, String)>, Status) {
    let mut machine = Machine::new(program.clone(), options);
    let mut robot = robot();
    let mut status = Status::Running;
    for step in 0..steps {
        robot.tick();
        status = machine.step(step * STEP_MS, &mut robot, &mut Deaf);
    }
    (robot.log, status)
}

fn robot() -> StandIn {
    let mut robot = StandIn::new(Placing::default());
    robot.mail.push_back("mail".into());
    robot.answers.push_back("x = 5".into());
    robot
}

/// The same program, stopped, stepped, looked at and replaced by itself at random.
fn disturbed(
    program: &Rc<Program>,
    options: Options,
    steps: u32,
    seed: u32,
) -> (Vec<(u32, String)>, Status) {
    let mut dice = Dice::new(seed);
    let mut session = Session::new(program.clone(), options);
    session.debugger().stops_at_errors = seed.is_multiple_of(2);
    for node in 0..program.len().min(20) as u32 {
        if dice.below(3) == 0 {
            let at = match dice.below(4) {
                0 => Breakpoint::of_changes("x"),
                _ => Breakpoint::before(program.id(node).unwrap()),
            };
            let point = Breakpoint {
                condition: ["", "x > 0", "1 / x > 0", "1 +"][dice.below(4) as usize].into(),
                from_hit: dice.below(4),
                log: ["", "x is {x}"][dice.below(2) as usize].into(),
                ..at
            };
            let is_broken = &*point.condition == "1 +";
            assert!(!(session.add(point).is_ok() && is_broken));
        }
    }
    let mut robot = robot();
    for step in 0..steps {
        robot.tick();
        let now = step * STEP_MS;
        if dice.below(10) == 0 {
            session.debugger().pause();
        }
        let mut phase = session.step(now, &mut robot, &mut Deaf);
        for _ in 0..2000 {
            let Phase::Stopped(stop) = &phase else {
                break;
            };
            if dice.below(8) == 0 {
                let version = Version::unchecked(program.clone());
                let patched = session.patch(&version, WhenGone::Refuse, &mut robot, &mut Deaf);
                assert_eq!(patched.unwrap().gone, 0);
            }
            let _ = session.machine().evaluate_aside("x = x + 1");
            assert!(session.machine().views().count() <= limits::THREADS_MAX);
            phase = match (stop.thread, dice.below(3)) {
                (Some(thread), 0) => {
                    let step = [Step::Into, Step::Over, Step::Out][dice.below(3) as usize];
                    session.walk((thread, step), now, &mut robot, &mut Deaf)
                }
                _ => session.go_on(now, &mut robot, &mut Deaf),
            };
        }
        // Too many stops for one step: the rest goes on at once.
        while let Phase::Stopped(_) = phase {
            let numbers: Vec<u32> = session.debugger().breakpoints().map(|(n, ..)| n).collect();
            for number in numbers {
                session.debugger().remove(number);
            }
            phase = session.go_on(now, &mut robot, &mut Deaf);
        }
    }
    (robot.log, session.machine().status())
}

#[test]
fn a_program_that_is_debugged_does_what_it_does_alone() {
    let seed = std::env::var("TRIK_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let seed: u32 = seed.unwrap_or_else(std::process::id);
    println!("seed {seed}");
    let mut lines = 0;
    for round in 0..400 {
        let mut dice = Dice::new(seed.wrapping_mul(7919).wrapping_add(round));
        let project = random::project(&mut dice);
        let options = [Options::simulated(), Options::default()][dice.below(2) as usize];
        let lowered = lower(&project, World::default()).unwrap();
        let program = Rc::new(lowered.program);
        let expected = alone(&program, options, 80);
        let seen = disturbed(&program, options, 80, dice.below(u32::MAX));
        assert_eq!(expected, seen, "TRIK_SEED={seed}, round {round}");
        lines += expected.0.len();
    }
    assert!(lines > 4000, "the programs did {lines} things");
}

#[test]
fn it_stops_before_a_block_and_goes_on_from_there() {
    let (project, ids) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    let number = desk.stop_at(&ids[3]);
    let phase = desk.run(100);
    assert_eq!(
        desk.place(&phase),
        (ids[3].clone(), Reason::Breakpoint(number))
    );
    assert_eq!(desk.variable("n"), "1");
    let phase = desk.go_on();
    assert_eq!(desk.place(&phase).0, ids[3]);
    assert_eq!(desk.variable("n"), "2");
    assert!(desk.session.debugger().remove(number));
    assert_eq!(desk.go_on(), Phase::Runs);
}

#[test]
fn conditions_hits_and_lines_are_heeded() {
    let (project, ids) = counting("n = n + 1", "10");
    let mut desk = Desk::of(&project);
    let point = Breakpoint {
        condition: "n > 5".into(),
        from_hit: 3,
        ..Breakpoint::before(ids[3].as_str())
    };
    desk.session.add(point.clone()).unwrap();
    let line = Breakpoint {
        log: "n is {n}, twice {n * 2}, {1 / (n - 8)} }".into(),
        ..Breakpoint::before(ids[3].as_str())
    };
    desk.session.add(line).unwrap();
    let phase = desk.run(1000);
    assert_eq!(desk.place(&phase).1, Reason::Breakpoint(1));
    assert_eq!(desk.variable("n"), "8");
    let (lines, lost) = desk.session.debugger().take_lines();
    assert_eq!((lines.len(), lost), (8, 0));
    assert_eq!(lines[7], "n is 8, twice 16, <Division by zero> }");
    let wrong = Breakpoint {
        condition: "1 / (n - 10) > 0".into(),
        ..point
    };
    let number = desk.session.add(wrong).unwrap();
    let phase = desk.go_on();
    assert!(matches!(desk.place(&phase).1, Reason::Breakpoint(1)));
    desk.session.debugger().remove(1);
    let phase = desk.go_on();
    let (_, Reason::Condition(told, problems)) = desk.place(&phase) else {
        panic!("{phase:?}");
    };
    assert_eq!((told, problems.is_empty()), (number, false));
}

#[test]
fn breakpoints_that_cannot_be_are_refused() {
    let (project, ids) = counting("n = n + 1", "10");
    let mut desk = Desk::of(&project);
    let nowhere = Breakpoint::before("{no}");
    assert_eq!(desk.session.add(nowhere), Err(NoBreakpoint::NoSuchBlock));
    let long = Breakpoint {
        condition: "1 + ".repeat(limits::CONDITION_MAX).into(),
        ..Breakpoint::before(ids[1].as_str())
    };
    assert_eq!(desk.session.add(long), Err(NoBreakpoint::TooLong));
    for _ in 0..limits::BREAKPOINTS_MAX {
        desk.stop_at(&ids[1]);
    }
    let more = Breakpoint::before(ids[1].as_str());
    assert_eq!(desk.session.add(more), Err(NoBreakpoint::TooMany));
}

#[test]
fn steps_go_into_calls_over_them_and_out_of_them() {
    let mut sketch = Sketch::new();
    let sub = sketch.subprogram("twice", &[]);
    sketch.draw_on(sub);
    let begin = sketch.block("InitialNode", &[]);
    let double = code(&mut sketch, "x = x * 2");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[begin, double, end]);
    sketch.draw_on(sketch.main());
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, "x = 1");
    let one = sketch.call(sub, &[]);
    let two = sketch.call(sub, &[]);
    let last = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, set, one, two, last]);
    let project = sketch.project();
    let main = project.main.unwrap();
    let main_ids: Vec<_> = project.diagrams[main]
        .blocks
        .iter()
        .map(|b| b.id.clone())
        .collect();
    let sub_ids: Vec<_> = project.diagrams[1 - main]
        .blocks
        .iter()
        .map(|b| b.id.clone())
        .collect();
    let mut desk = Desk::of(&project);
    desk.stop_at(&main_ids[2]);
    let phase = desk.run(100);
    assert_eq!(desk.place(&phase).0, main_ids[2]);
    let phase = desk.walk(Step::Over);
    assert_eq!(
        (desk.place(&phase).0, desk.variable("x").as_str()),
        (main_ids[3].clone(), "2")
    );
    let phase = desk.walk(Step::Into);
    assert_eq!(desk.place(&phase).0, sub_ids[0]);
    let views: Vec<_> = desk.session.machine().views().collect();
    assert_eq!(views[0].doing, Doing::Enters);
    let calls: Vec<_> = views[0]
        .calls
        .iter()
        .map(|node| desk.session.machine().program().id(*node).unwrap())
        .collect();
    assert_eq!(calls, [main_ids[3].as_str()]);
    let phase = desk.walk(Step::Out);
    assert_eq!(
        (desk.place(&phase).0, desk.variable("x").as_str()),
        (main_ids[4].clone(), "4")
    );
    let phase = desk.walk(Step::Over);
    assert!(
        matches!(
            phase,
            Phase::Ended {
                with_errors: false,
                ..
            }
        ),
        "{phase:?}"
    );
}

#[test]
fn an_error_is_looked_at_where_it_happened() {
    let (project, ids) = counting("n = 1 / n", "10");
    let mut desk = Desk::of(&project);
    desk.session.debugger().stops_at_errors = true;
    let phase = desk.run(100);
    let (place, Reason::Error(problem)) = desk.place(&phase) else {
        panic!("{phase:?}");
    };
    assert_eq!(
        (place, problem.words.english.as_str()),
        (ids[2].clone(), "Division by zero")
    );
    let views: Vec<_> = desk
        .session
        .machine()
        .views()
        .map(|view| view.doing)
        .collect();
    assert_eq!(views, [Doing::Failed]);
    assert!(matches!(
        desk.go_on(),
        Phase::Ended {
            with_errors: true,
            ..
        }
    ));
}

#[test]
fn model_time_stands_still_in_a_stop() {
    let (project, ids) = counting("n = time()", "1000");
    let mut desk = Desk::of(&project);
    let number = desk.stop_at(&ids[3]);
    desk.run(100);
    desk.session.debugger().remove(number);
    let before = desk.session.machine().now();
    // A person thinks for a minute by the robot's clock.
    desk.now += 60_000;
    assert_eq!(desk.go_on(), Phase::Runs);
    assert_eq!(desk.session.machine().now(), before + 1000 * STEP_MS);
}

#[test]
fn one_thread_is_held_and_the_others_go_on() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let fork = sketch.block("Fork", &[]);
    let one = code(&mut sketch, "a = a + 1");
    let wait_one = sketch.block("Timer", &[("Delay", "10")]);
    let two = code(&mut sketch, "b = b + 1");
    let wait_two = sketch.block("Timer", &[("Delay", "10")]);
    let set = code(&mut sketch, "a = 0; b = 0");
    sketch.chain(&[start, set, fork]);
    sketch.guarded(fork, one, "main");
    sketch.guarded(fork, two, "other");
    sketch.chain(&[one, wait_one, one]);
    sketch.chain(&[two, wait_two, two]);
    let mut desk = Desk::of(&sketch.project());
    desk.session.debugger().hold_thread("other").unwrap();
    assert_eq!(desk.run(50), Phase::Runs);
    assert_eq!(desk.variable("b"), "0");
    let counted: i32 = desk.variable("a").parse().unwrap();
    assert!(counted > 20, "{counted}");
    let held: Vec<_> = desk
        .session
        .machine()
        .views()
        .filter(|view| view.doing == Doing::Held)
        .map(|view| view.name)
        .collect();
    assert_eq!(held, ["other"]);
    assert!(desk.session.release("other"));
    assert!(!desk.session.release("nobody"));
    desk.run(50);
    let counted: i32 = desk.variable("b").parse().unwrap();
    assert!(counted > 20, "{counted}");
}

#[test]
fn what_a_thread_waits_for_is_told() {
    let (project, _) = counting("n = n + 1", "500");
    let mut desk = Desk::of(&project);
    desk.run(20);
    let doing = desk.session.machine().views().next().unwrap().doing;
    let Doing::Waits(Waits::Time { left_ms }) = doing else {
        panic!("{doing:?}");
    };
    assert!((1..500).contains(&left_ms), "{left_ms}");
}

#[test]
fn looking_changes_nothing_and_assigning_does() {
    let (project, ids) = counting("n = n + step", "10");
    let mut project = project;
    project.diagrams[0].blocks[1]
        .properties
        .insert("Body".into(), "n = 0; step = 1".into());
    let mut desk = Desk::of(&project);
    desk.stop_at(&ids[3]);
    desk.run(100);
    let machine = desk.session.machine();
    let value = machine.evaluate_aside("n + 41").unwrap();
    assert_eq!(&*value.to_text(), "42");
    assert_eq!(desk.variable("n"), "1");
    for (text, why) in [
        ("n = 77", "cannot assign; == compares"),
        ("random(5)", "random would change"),
        ("print(n)", "print would change"),
        ("sensorA1", "does not read sensorA1"),
    ] {
        let problems = desk.session.machine().evaluate_aside(text).unwrap_err();
        assert!(problems[0].words.english.contains(why), "{problems:?}");
    }
    let Desk { session, robot, .. } = &mut desk;
    session.assign("step", "n + 9", robot, &mut Deaf).unwrap();
    for (name, text) in [
        ("step", "'text'"),
        ("step; n", "1"),
        ("step", "1; n = 5"),
        ("step", "1 / 0"),
        ("step", "1e999"),
        ("step", "sqrt(0 - 1)"),
        ("", "1"),
        ("step", ""),
    ] {
        assert!(
            session.assign(name, text, robot, &mut Deaf).is_err(),
            "{name} = {text}"
        );
    }
    let refused = session.assign("step", "1; n = 5", robot, &mut Deaf);
    let Err(NotNow::Problems(problems)) = refused else {
        panic!("{refused:?}");
    };
    assert!(
        problems[0]
            .to_string()
            .starts_with("1:4 one expression is wanted after step=")
    );
    assert_eq!(
        (desk.variable("step").as_str(), desk.variable("n").as_str()),
        ("10", "1")
    );
    desk.go_on();
    assert_eq!(desk.variable("n"), "11");
}

#[test]
fn a_new_number_counts_from_the_next_round() {
    let (project, _) = counting("n = n + 1", "100");
    let (changed, _) = counting("n = n + 100", "100");
    let mut desk = Desk::of(&project);
    desk.run(35);
    let before: i32 = desk.variable("n").parse().unwrap();
    let log = desk.robot.log.clone();
    let version = Version::of(&changed, World::default()).unwrap();
    let Desk { session, robot, .. } = &mut desk;
    let patched = session
        .patch(&version, WhenGone::Refuse, robot, &mut Deaf)
        .unwrap();
    assert_eq!((patched.kept, patched.added, patched.gone), (4, 0, 0));
    assert_eq!(desk.robot.log, log);
    desk.run(10);
    assert_eq!(desk.variable("n"), (before + 100).to_string());
}

#[test]
fn a_thread_whose_block_is_gone_ends_or_the_version_is_refused() {
    let (project, ids) = counting("n = n + 1", "100");
    let mut changed = project.clone();
    changed.diagrams[0].blocks[3].id = "{another}".into();
    let mut desk = Desk::of(&project);
    desk.run(20);
    let version = Version::of(&changed, World::default()).unwrap();
    let Desk { session, robot, .. } = &mut desk;
    let refused = session.patch(&version, WhenGone::Refuse, robot, &mut Deaf);
    let Err(Refused::Occupied(problems)) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(problems[0].place.object.as_deref(), Some(ids[3].as_str()));
    assert_eq!(session.machine().views().count(), 1);
    let patched = session
        .patch(&version, WhenGone::End, robot, &mut Deaf)
        .unwrap();
    assert_eq!((patched.gone, patched.ended.len()), (1, 1));
    assert!(matches!(
        session.phase(),
        Phase::Ended {
            with_errors: true,
            ..
        }
    ));
    assert_eq!(
        session.patch(&version, WhenGone::End, robot, &mut Deaf),
        Err(Refused::Ended)
    );
}

#[test]
fn a_version_with_mistakes_changes_nothing() {
    let (project, ids) = counting("n = n + 1", "100");
    let (broken, _) = counting("n = n +", "100");
    let refused = Version::of(&broken, World::default()).unwrap_err();
    let Refused::Mistakes(problems) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(problems[0].place.object.as_deref(), Some(ids[2].as_str()));
    // Good alone, but n is a number in the program that runs.
    let mut other = project.clone();
    for block in [1, 2] {
        let properties = &mut other.diagrams[0].blocks[block].properties;
        properties.insert("Body".into(), "n = 'text'".into());
    }
    let version = Version::of(&other, World::default()).unwrap();
    let mut desk = Desk::of(&project);
    desk.run(20);
    let before = desk.variable("n");
    let Desk { session, robot, .. } = &mut desk;
    let refused = session.patch(&version, WhenGone::End, robot, &mut Deaf);
    let Err(Refused::Mistakes(problems)) = refused else {
        panic!("{refused:?}");
    };
    assert_eq!(problems[0].place.object.as_deref(), Some(ids[1].as_str()));
    assert_eq!(desk.variable("n"), before);
    assert_eq!(desk.run(50), Phase::Runs);
}
