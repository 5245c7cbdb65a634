//! Programs that want too much, or are no programs at all.

use std::rc::Rc;

use super::{Sketch, code, run};
use crate::check::check;
use crate::lower::{World, lower};
use crate::machine::trace::Deaf;
use crate::machine::{Machine, Options, Status};
use crate::project::{Block, Diagram, DiagramKind, Link, Project};
use crate::stand_in::StandIn;

#[test]
fn subprograms_that_only_call_each_other_overflow_and_are_warned_of() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let one = sketch.subprogram("one", &[]);
    let first = sketch.block("InitialNode", &[]);
    let two = sketch.subprogram("two", &[]);
    let second = sketch.block("InitialNode", &[]);
    let back = sketch.call(one, &[]);
    sketch.chain(&[second, back, back]);
    sketch.draw_on(one);
    let there = sketch.call(two, &[]);
    sketch.chain(&[first, there, there]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(one, &[]);
    sketch.chain(&[start, call, call]);
    let ran = run(&sketch, 5000);
    assert_eq!(ran.errors(), ["Stack overflow"]);
    let problems = check(&sketch.project(), World::default());
    let words: Vec<_> = problems
        .iter()
        .map(|one| one.words.english.as_str())
        .collect();
    assert!(
        words
            .iter()
            .any(|words| words.ends_with("calls itself at once and never comes back")),
        "{words:?}"
    );
}

#[test]
fn a_thread_that_nobody_reads_is_not_flooded() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let send = sketch.block(
        "SendMessageThreads",
        &[("Thread", "main"), ("Message", "1")],
    );
    sketch.chain(&[start, send, send]);
    let ran = run(&sketch, 5000);
    let expected = format!(
        "Thread main does not read its messages: {} are waiting",
        crate::limits::MESSAGES_MAX
    );
    assert_eq!(ran.errors(), [expected]);
}

#[test]
fn errors_without_end_are_counted() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let kill = sketch.block("KillThread", &[("Thread", "nobody")]);
    sketch.chain(&[start, kill, kill]);
    let ran = run(&sketch, 1000);
    assert_eq!(ran.errors().len(), lang_text::limits::PROBLEMS);
    assert!(ran.machine.more_errors() > 5000);
    assert_eq!(ran.status, Status::Running);
}

#[test]
fn blocks_that_lead_to_themselves_keep_nobody_else() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "n = 0");
    let fork = sketch.block("Fork", &[]);
    let busy = sketch.block("FiBlock", &[]);
    let wait = sketch.block("Timer", &[("Delay", "50")]);
    let count = code(&mut sketch, "n = n + 1");
    sketch.chain(&[start, zero, fork]);
    sketch.guarded(fork, busy, "main");
    sketch.guarded(fork, wait, "other");
    sketch.link(busy, busy);
    sketch.chain(&[wait, count, wait]);
    assert_eq!(run(&sketch, 1000).text("n"), "18");
}

fn blank(kind: &str, outgoing: Vec<usize>) -> Block {
    Block {
        id: kind.into(),
        kind: kind.into(),
        name: "x".into(),
        outgoing,
        ..Block::default()
    }
}

fn only(blocks: Vec<Block>, links: Vec<Link>) -> Project {
    Project {
        diagrams: vec![Diagram {
            id: "d".into(),
            logical: "d".into(),
            kind: DiagramKind::Main,
            name: "d".into(),
            parameters: Vec::new(),
            blocks,
            links,
        }],
        main: Some(0),
        ..Project::default()
    }
}

#[test]
fn indices_that_lead_nowhere_are_loose_links() {
    let start = blank("InitialNode", vec![0, 77]);
    let link = Link {
        to: Some(99),
        ..Link::default()
    };
    let project = only(vec![start], vec![link]);
    let lowered = lower(&project, World::default()).unwrap();
    assert_eq!(
        lowered.problems[0].words.english,
        "Outgoing link is not connected"
    );
    assert!(!check(&project, World::default()).is_empty());
    assert!(!check(&only(Vec::new(), Vec::new()), World::default()).is_empty());
    assert!(!check(&Project::default(), World::default()).is_empty());
    let mut machine = Machine::new(Rc::default(), Options::default());
    let status = machine.step(0, &mut StandIn::default(), &mut Deaf);
    assert_eq!(
        machine.errors()[0].words.english,
        "There is no diagram to run"
    );
    assert!(matches!(
        status,
        Status::Ended {
            at: 0,
            with_errors: true
        }
    ));
}

#[test]
fn a_million_blocks_are_checked() {
    // Work that grows with the square of their number would take hours.
    let count = 1_000_000;
    let mut blocks = vec![blank("InitialNode", vec![0])];
    blocks.extend((1..count).map(|at| blank("FiBlock", vec![at])));
    let links = (0..count).map(|at| Link {
        from: Some(at),
        to: Some((at + 1) % count),
        ..Link::default()
    });
    let project = only(blocks, links.collect());
    assert!(check(&project, World::default()).is_empty());
}

#[test]
fn more_blocks_than_can_be_numbered_are_refused() {
    let blocks = vec![Block::default(); crate::limits::NODES_MAX + 1];
    let refused = lower(&only(blocks, Vec::new()), World::default()).unwrap_err();
    assert!(
        refused.words.english.contains("at most 2000000"),
        "{refused}"
    );
}
