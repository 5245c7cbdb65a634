//! Many new versions of a program that runs: none is lost, broken ones change nothing, no thread is forgotten, nothing
//! grows.

use std::rc::Rc;

use super::random::Dice;
use super::{Desk, code, ids};
use crate::debug::Phase;
use crate::lower::World;
use crate::machine::STEP_MS;
use crate::machine::patch::{Refused, Version, WhenGone};
use crate::machine::trace::Deaf;
use crate::project::Project;
use crate::sketch::{Sketch, Spot};

/// Three threads that count; the first one also assigns `v`. With the ids of its blocks.
fn three() -> (Project, Vec<String>) {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, "a = 0; b = 0; c = 0; v = 0");
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, set, fork]);
    let thread = |sketch: &mut Sketch, name: &str, body: &str| -> Spot {
        let count = code(sketch, body);
        let wait = sketch.block("Timer", &[("Delay", "10")]);
        sketch.chain(&[count, wait, count]);
        sketch.guarded(fork, count, name);
        count
    };
    thread(&mut sketch, "main", "a = a + 1; v = 0");
    thread(&mut sketch, "second", "b = b + 1");
    thread(&mut sketch, "third", "c = c + 1");
    let project = sketch.project();
    let ids = ids(&project);
    (project, ids)
}

/// The same with another body of a block.
fn with(project: &Project, id: &str, body: &str) -> Project {
    let mut project = project.clone();
    let blocks = project.diagrams.iter_mut().flat_map(|one| &mut one.blocks);
    for block in blocks.filter(|block| block.id == id) {
        block.properties.insert("Body".into(), body.into());
    }
    project
}

fn counters(desk: &Desk) -> [i64; 3] {
    ["a", "b", "c"].map(|name| desk.variable(name).parse().unwrap())
}

/// What a version does when it comes.
enum Comes {
    /// It is in force, and `v` becomes this.
    InForce(u32),
    Refused,
}

fn come(desk: &mut Desk, (project, ids): (&Project, &[String]), dice: &mut Dice) -> Comes {
    let value = dice.below(1_000_000);
    let good = format!("a = a + 1; v = {value}");
    let (project, is_good) = match dice.below(6) {
        0 => (with(project, &ids[3], "a = a +"), false),
        1 => (with(project, &ids[5], "b = 'text'"), false),
        // The blocks in which threads wait are gone.
        2 => {
            let mut other = with(project, &ids[3], &good);
            let all = other.diagrams.iter_mut().flat_map(|one| &mut one.blocks);
            for block in all.filter(|block| block.kind == "Timer") {
                block.id.push('x');
            }
            (other, false)
        }
        3 => {
            let mut other = project.clone();
            other.diagrams.clear();
            (other, false)
        }
        _ => (with(project, &ids[3], &good), true),
    };
    let before = (desk.session.live().program().clone(), counters(desk));
    let Desk { session, robot, .. } = desk;
    let version = Version::of(&project, World::default());
    let patched =
        version.and_then(|version| session.patch(&version, WhenGone::Refuse, robot, &mut Deaf));
    match (is_good, patched) {
        (true, Ok(patched)) => {
            assert_eq!((patched.added, patched.gone), (0, 0));
            Comes::InForce(value)
        }
        (false, Err(Refused::Mistakes(problems) | Refused::Occupied(problems))) => {
            assert!(!problems.is_empty());
            assert!(Rc::ptr_eq(&before.0, desk.session.live().program()));
            assert_eq!(before.1, counters(desk));
            Comes::Refused
        }
        (is_good, patched) => panic!("{is_good}: {patched:?}"),
    }
}

#[test]
fn of_ten_thousand_versions_none_is_lost_and_no_thread_is_forgotten() {
    const VERSIONS: u32 = 10_000;
    let seed = std::env::var("TRIK_SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let seed: u32 = seed.unwrap_or_else(std::process::id);
    println!("TRIK_SEED={seed}");
    let mut dice = Dice::new(seed);
    let (project, ids) = three();
    let mut desk = Desk::of(&project);
    desk.session.keep(1 << 20);
    assert_eq!(desk.run(20), Phase::Runs);
    let weight = desk.session.live().weight();
    let (mut in_force, mut refused) = (0, 0);
    for _ in 0..VERSIONS {
        // Between two steps, or in the middle of one.
        if dice.below(3) == 0 {
            desk.session.debugger().pause();
            desk.run(1);
        }
        let before = counters(&desk);
        let comes = come(&mut desk, (&project, &ids), &mut dice);
        desk.go_on_for(4);
        match comes {
            Comes::InForce(value) => {
                in_force += 1;
                assert_eq!(desk.variable("v"), value.to_string());
            }
            Comes::Refused => refused += 1,
        }
        let after = counters(&desk);
        let grows = before
            .iter()
            .zip(after)
            .all(|(before, after)| *before < after);
        assert!(grows, "{before:?}, {after:?}");
        assert_eq!(desk.session.live().views().count(), 3);
    }
    assert!(in_force > VERSIONS / 5 && refused > VERSIONS / 5);
    // Texts of versions have other lengths, and no more.
    let grown = desk.session.live().weight().abs_diff(weight);
    assert!(grown < 1000, "{grown} bytes more");
    let (_, bytes) = desk.session.kept().unwrap();
    assert!(bytes < 2 << 20, "{bytes}");
}

/// Steers by a coefficient, a command for each motor in each round.
fn steering() -> (Project, Vec<String>) {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, "kp = 1; u = 0");
    let round = code(&mut sketch, "u = kp * 3");
    let left = [("Ports", "M3"), ("Power", "40 + u")];
    let left = sketch.block("TrikV6EnginesForward", &left);
    let right = [("Ports", "M4"), ("Power", "40 - u")];
    let right = sketch.block("TrikV6EnginesForward", &right);
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[start, set, round, left, right, wait, round]);
    let project = sketch.project();
    let ids = ids(&project);
    (project, ids)
}

#[test]
fn no_command_to_a_motor_is_missing_when_a_coefficient_changes() {
    let (project, ids) = steering();
    let other = with(&project, &ids[2], "u = kp * 5");
    let commands = |patched_at: Option<u32>| {
        let mut desk = Desk::of(&project);
        for step in 0..300 {
            desk.go_on_for(1);
            if patched_at == Some(step) {
                let version = Version::of(&other, World::default()).unwrap();
                let told = desk.robot.log.len();
                let Desk { session, robot, .. } = &mut desk;
                session
                    .patch(&version, WhenGone::Refuse, robot, &mut Deaf)
                    .unwrap();
                assert_eq!(desk.robot.log.len(), told, "a version moves nothing");
            }
        }
        desk.robot.log
    };
    let alone = commands(None);
    assert!(alone.len() > 300, "{}", alone.len());
    for patched_at in [100, 101, 102, 103, 250] {
        let patched = commands(Some(patched_at));
        let times = |log: &[(u32, String)]| log.iter().map(|(at, _)| *at).collect::<Vec<_>>();
        assert_eq!(times(&patched), times(&alone), "at step {patched_at}");
        let is_later = |(at, _): &&(u32, String)| *at > (patched_at + 8) * STEP_MS;
        let later: Vec<_> = patched.iter().filter(is_later).collect();
        assert!(later.iter().any(|(_, said)| said.contains("45")));
        assert!(!later.iter().any(|(_, said)| said.contains("43")));
    }
}

#[test]
fn a_version_with_another_type_is_refused_with_the_variable_and_both_types() {
    let (project, ids) = three();
    let mut desk = Desk::of(&project);
    desk.run(5);
    let other = with(&project, &ids[1], "a = 0; c = 0; v = 0");
    let version = Version::of(&with(&other, &ids[5], "b = 'text'"), World::default());
    let Desk { session, robot, .. } = &mut desk;
    let patched = session.patch(&version.unwrap(), WhenGone::End, robot, &mut Deaf);
    let Err(Refused::Mistakes(problems)) = patched else {
        panic!("{patched:?}");
    };
    let told = problems[0].to_string();
    assert!(
        told.contains("'b' is of the type 'integer', and this gives it 'string'"),
        "{told}"
    );
}

#[test]
fn a_version_may_read_what_has_no_value_yet() {
    let (project, ids) = three();
    let mut desk = Desk::of(&project);
    let version = Version::of(&with(&project, &ids[3], "a = a + 5 * c"), World::default());
    let Desk { session, robot, .. } = &mut desk;
    let patched = session.patch(&version.unwrap(), WhenGone::End, robot, &mut Deaf);
    assert!(patched.is_ok(), "{patched:?}");
    desk.run(50);
    assert!(counters(&desk)[0] > 5, "{:?}", counters(&desk));
}
