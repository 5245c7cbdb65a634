//! The past of programs: every moment that is computed again is the one that was.

use std::rc::Rc;

use super::random::{self, Dice};
use super::{Desk, alone, counting, robot};
use crate::debug::{Back, Breakpoint, NoBack, NotNow, Phase, Reason, Session, Step};
use crate::limits;
use crate::lower::{World, lower};
use crate::machine::trace::{Deaf, Guard, Moment, Trace};
use crate::machine::{Machine, Options, STEP_MS};
use crate::program::Node;

/// What a program looked like when a thread was about to enter a block.
#[derive(Clone, Debug, Eq, PartialEq)]
struct Seen {
    ms: u32,
    thread: u16,
    node: Node,
    values: Vec<(String, String)>,
}

fn seen(machine: &Machine, thread: u16, node: Node) -> Seen {
    let values = machine.variables();
    Seen {
        ms: machine.now(),
        thread,
        node,
        values: values
            .map(|(name, value)| (name.to_owned(), value.printed().to_string()))
            .collect(),
    }
}

/// Writes down every moment of a program.
#[derive(Default)]
struct Chronicle(Vec<Seen>);

impl Trace for Chronicle {
    fn guard(&mut self, machine: &Machine, at: Moment) -> Guard {
        if let Moment::Enters { thread, node } = at {
            self.0.push(seen(machine, thread, node));
        }
        Guard::Go
    }
}

fn chronicle(machine: Machine, steps: u32) -> Vec<Seen> {
    let mut machine = machine;
    machine.set_guarded(true);
    let mut robot = robot();
    let mut chronicle = Chronicle::default();
    for step in 0..steps {
        robot.tick();
        machine.step(step * STEP_MS, &mut robot, &mut chronicle);
    }
    chronicle.0
}

fn here(session: &Session) -> Seen {
    let stop = session.stop().unwrap();
    seen(session.machine(), stop.thread.unwrap(), stop.node.unwrap())
}

/// Whether a moment between two steps has the values with which the next block was entered.
fn is_between(session: &Session, moments: &[Seen]) -> bool {
    let machine = session.machine();
    let seen = seen(machine, 0, 0);
    let next = moments.iter().find(|one| one.ms > seen.ms);
    let last = moments.iter().rfind(|one| one.ms <= seen.ms);
    // A block may assign in its wait, and the last one of a step after it was entered.
    let is_like = |one: Option<&Seen>| one.is_none_or(|one| one.values == seen.values);
    let is_beginning = seen.ms == 0 && is_like(moments.first());
    is_beginning
        || is_like(next)
        || is_like(last)
        || next.is_some_and(|next| next.ms > seen.ms + STEP_MS)
}

/// Whether the oldest moment that is kept has values of its time: it may be in the middle of what a step has begun.
fn is_of_its_time(session: &Session, moments: &[Seen]) -> bool {
    let seen = seen(session.machine(), 0, 0);
    let before = moments.iter().rfind(|one| one.ms < seen.ms);
    let after = moments.iter().find(|one| one.ms > seen.ms);
    let [from, until] = [before, after].map(|one| one.map(|one| one.ms));
    let mut near = moments
        .iter()
        .filter(|one| one.ms >= from.unwrap_or(0) && until.is_none_or(|until| one.ms <= until));
    near.any(|one| one.values == seen.values)
}

#[test]
fn every_moment_of_the_past_is_the_one_that_was() {
    const STEPS: u32 = 60;
    let seed: u32 = std::env::var("TRIK_SEED")
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or_else(std::process::id);
    println!("seed {seed}");
    let mut looked = 0;
    for round in 0..200 {
        let mut dice = Dice::new(seed.wrapping_mul(7919).wrapping_add(round));
        let project = random::project(&mut dice);
        let options = [Options::simulated(), Options::default()][dice.below(2) as usize];
        let program = Rc::new(lower(&project, World::default()).unwrap().program);
        let told = format!("TRIK_SEED={seed}, round {round}");
        let moments = chronicle(Machine::new(program.clone(), options), STEPS);
        let expected = alone(&program, options, STEPS);

        let mut session = Session::new(program, options);
        // Now all of the past is kept, and now the end of it.
        session.keep([1 << 24, 20_000][dice.below(2) as usize]);
        let mut robot = robot();
        for step in 0..STEPS {
            robot.tick();
            let now = step * STEP_MS;
            if dice.below(6) == 0 {
                session.debugger().pause();
            }
            session.step(now, &mut robot, &mut Deaf);
            while session.debugger().stop().is_some() {
                for _ in 0..dice.below(4) {
                    let ms = dice.below(STEPS) * STEP_MS;
                    let how = match dice.below(5) {
                        0 => Back::To(ms),
                        1 => Back::Step(Step::Over),
                        2 => Back::Step(Step::Out),
                        3 if dice.below(4) == 0 => Back::Oldest,
                        _ => Back::Step(Step::Into),
                    };
                    match session.back(how) {
                        // The beginning is between two steps too.
                        Ok(stop) if matches!(how, Back::To(_)) || stop.thread.is_none() => {
                            looked += 1;
                            let is_oldest = !matches!(how, Back::To(_));
                            let is_there = is_between(&session, &moments)
                                || is_oldest && is_of_its_time(&session, &moments);
                            assert!(is_there, "{told}");
                        }
                        Ok(_) => {
                            let here = here(&session);
                            assert!(moments.contains(&here), "{told}: {here:?}");
                            looked += 1;
                        }
                        Err(NoBack::AtOldest | NoBack::NotYet) => {}
                        Err(why) => panic!("{told}: {why:?}"),
                    }
                    if dice.below(3) == 0
                        && session.stop().is_some_and(|stop| stop.node.is_some())
                        && session.forth(Some(Step::Into))
                    {
                        assert!(moments.contains(&here(&session)), "{told}");
                    }
                }
                if dice.below(3) == 0 {
                    session.debugger().pause();
                }
                session.go_on(now, &mut robot, &mut Deaf);
            }
        }
        assert_eq!(expected, (robot.log, session.machine().status()), "{told}");
    }
    assert!(looked > 500, "only {looked} moments");
}

/// A counter that is stopped in its tenth round.
fn stopped() -> (Desk, Vec<String>) {
    let (project, ids) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    desk.session.keep(limits::HISTORY_BYTES);
    let point = Breakpoint {
        condition: "n == 9".into(),
        is_once: true,
        ..Breakpoint::before(ids[2].as_str())
    };
    desk.session.add(point).unwrap();
    assert!(matches!(desk.run(1000), Phase::Stopped(_)));
    (desk, ids)
}

#[test]
fn steps_back_undo_what_steps_do() {
    let (mut desk, ids) = stopped();
    let mut way = Vec::new();
    let place = |desk: &Desk| {
        let stop = desk.session.stop().unwrap();
        let machine = desk.session.machine();
        let id = machine.program().id(stop.node.unwrap()).unwrap();
        (id.to_owned(), desk.variable("n"))
    };
    for _ in 0..4 {
        desk.session.back(Back::Step(Step::Over)).unwrap();
        way.push(place(&desk));
    }
    let at = |block: usize, n: &str| (ids[block].clone(), n.to_owned());
    assert_eq!(way, [at(3, "9"), at(2, "8"), at(3, "8"), at(2, "7")]);
    assert!(desk.session.is_past());
    assert!(desk.session.forth(Some(Step::Over)));
    assert_eq!(place(&desk), at(3, "8"));
    assert!(desk.session.forth(Some(Step::Over)) && desk.session.forth(Some(Step::Over)));
    // The next one is the moment at which it is stopped.
    assert!(!desk.session.forth(Some(Step::Over)));
    assert!(!desk.session.is_past());
    assert_eq!(place(&desk), at(2, "9"));
}

#[test]
fn it_runs_back_to_a_breakpoint_to_a_time_and_to_the_beginning() {
    let (mut desk, ids) = stopped();
    let point = Breakpoint {
        condition: "n == 4".into(),
        ..Breakpoint::before(ids[3].as_str())
    };
    let number = desk.session.add(point).unwrap();
    let stop = desk.session.back(Back::Continue).unwrap();
    assert_eq!(stop.reason, Reason::Breakpoint(number));
    assert_eq!(desk.variable("n"), "4");
    let ms = desk.session.machine().now();
    assert_eq!(
        desk.session.back(Back::Continue).unwrap().reason,
        Reason::Oldest
    );
    // The first block of a simulated program is entered after a turn, and the beginning is before that.
    assert_eq!(desk.session.machine().now(), 0);
    assert_eq!(desk.session.back(Back::Oldest), Err(NoBack::AtOldest));
    assert!(desk.session.forth(Some(Step::Into)));
    assert_eq!(desk.session.machine().now(), 30);
    desk.session.back(Back::Oldest).unwrap();
    assert_eq!(desk.session.machine().now(), 0);
    assert_eq!(desk.session.back(Back::Continue), Err(NoBack::AtOldest));
    assert!(desk.session.forth(None));
    assert_eq!(desk.session.machine().now(), ms);
    // In the middle of a wait.
    assert_eq!(
        desk.session.back(Back::To(250)).unwrap().reason,
        Reason::Past
    );
    assert_eq!(
        (desk.variable("n").as_str(), desk.session.machine().now()),
        ("3", 250)
    );
    assert_eq!(desk.session.back(Back::To(90_000)), Err(NoBack::NotYet));
    desk.session.back(Back::To(450)).unwrap();
    assert_eq!(desk.variable("n"), "5");
    desk.session.back(Back::To(250)).unwrap();
    assert!(desk.session.forth(Some(Step::Into)));
    assert_eq!(
        (desk.variable("n").as_str(), desk.session.machine().now()),
        ("3", 330)
    );
    desk.session.back(Back::To(250)).unwrap();
    desk.session.back(Back::Step(Step::Into)).unwrap();
    assert_eq!(
        (desk.variable("n").as_str(), desk.session.machine().now()),
        ("3", 230)
    );
    assert_eq!(
        desk.session.back(Back::Oldest).unwrap().reason,
        Reason::Oldest
    );
    // Going on begins where it was stopped.
    assert!(matches!(desk.go_on(), Phase::Runs));
    assert!(desk.variable("n").parse::<u32>().unwrap() > 50);
}

#[test]
fn the_past_is_looked_at_and_not_changed() {
    let (mut desk, _) = stopped();
    let assigned = |desk: &mut Desk| {
        let Desk { session, robot, .. } = desk;
        session.assign("n", "100", robot, &mut Deaf)
    };
    desk.session.back(Back::To(250)).unwrap();
    assert_eq!(assigned(&mut desk), Err(NotNow::Past));
    let value = desk.session.machine().evaluate_aside("n * 10").unwrap();
    assert_eq!(&*value.to_text(), "30");
    desk.session.to_present();
    assert_eq!(assigned(&mut desk), Ok(()));
    // What was before the change is still there, and what comes after it is computed from it.
    let first = desk.session.debugger().stop().unwrap().thread.unwrap();
    for _ in 0..4 {
        let Desk {
            session,
            robot,
            now,
        } = &mut desk;
        session.walk((first, Step::Into), *now, robot, &mut Deaf);
        desk.run(1000);
    }
    assert_eq!(desk.variable("n"), "102");
    let mut values = Vec::new();
    while desk.session.back(Back::Step(Step::Into)).is_ok() && values.len() < 7 {
        values.push(desk.variable("n"));
    }
    assert_eq!(values, ["102", "101", "101", "9", "9", "8", "8"]);
}

#[test]
fn nothing_is_kept_of_a_program_that_runs_unasked() {
    let (project, _) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    desk.run(5);
    assert_eq!(desk.session.back(Back::Oldest), Err(NoBack::NotKept));
    desk.session.keep(limits::HISTORY_BYTES);
    desk.run(5);
    assert_eq!(desk.session.back(Back::Oldest), Err(NoBack::Runs));
}

#[test]
fn memory_is_bounded_and_the_oldest_goes_first() {
    let (project, _) = counting("n = n + 1", "10");
    let mut desk = Desk::of(&project);
    desk.session.keep(100_000);
    desk.run(20_000);
    desk.session.debugger().pause();
    desk.run(10);
    let (first_ms, bytes) = desk.session.kept().unwrap();
    assert!(first_ms > 10_000, "{first_ms}");
    assert!(bytes < 120_000, "{bytes}");
    desk.session.back(Back::Oldest).unwrap();
    let oldest = desk.session.machine().now();
    assert!(oldest.abs_diff(first_ms) <= 20, "{oldest} {first_ms}");
}
