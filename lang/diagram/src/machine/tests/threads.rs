//! Fork, join, kill, messages between threads.

use super::{Ran, Sketch, Spot, chain, code, run, run_with};
use crate::lower::World;
use crate::machine::Options;
use lang_expr::Compat;

/// A fork of `main` and the named threads; blocks of each are given by their names.
struct Forked {
    sketch: Sketch,
    fork: Spot,
}

impl Forked {
    fn new() -> Self {
        let mut sketch = Sketch::new();
        let start = sketch.block("InitialNode", &[]);
        let zero = code(&mut sketch, "log = ''");
        let fork = sketch.block("Fork", &[]);
        sketch.chain(&[start, zero, fork]);
        Self { sketch, fork }
    }

    /// A thread that runs blocks and ends.
    fn thread(&mut self, guard: &str, blocks: &[(&str, &[(&str, &str)])]) -> Vec<Spot> {
        let mut spots: Vec<Spot> = blocks
            .iter()
            .map(|(kind, properties)| self.sketch.block(kind, properties))
            .collect();
        spots.push(self.sketch.block("FinalNode", &[]));
        self.sketch.guarded(self.fork, spots[0], guard);
        self.sketch.chain(&spots);
        spots
    }

    fn run(&self, ms: u32) -> Ran {
        run(&self.sketch, ms)
    }
}

const fn say(text: &'static str) -> (&'static str, &'static [(&'static str, &'static str)]) {
    match text.as_bytes()[0] {
        b'a' => ("Function", &[("Body", "log = log .. 'a' .. time() .. ' '")]),
        b'b' => ("Function", &[("Body", "log = log .. 'b' .. time() .. ' '")]),
        _ => ("Function", &[("Body", "log = log .. 'm' .. time() .. ' '")]),
    }
}

#[test]
fn threads_of_the_first_moment_begin_a_turn_apart_and_by_name() {
    let mut forked = Forked::new();
    forked.thread("b", &[say("b")]);
    forked.thread("main", &[say("m")]);
    forked.thread("a", &[say("a")]);
    let ran = forked.run(1000);
    assert_eq!(ran.text("log"), "a60 b90 m90 ");
    assert_eq!(ran.end(), Some(90));
}

#[test]
fn later_threads_begin_at_once_and_run_until_they_wait() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "log = ''");
    let wait = sketch.block("Timer", &[("Delay", "100")]);
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, zero, wait, fork]);
    let mut forked = Forked { sketch, fork };
    forked.thread("main", &[say("m")]);
    forked.thread("x", &[say("a"), ("Timer", &[("Delay", "20")]), say("b")]);
    let ran = forked.run(1000);
    // The second timer comes later in the order of blocks, so it counts the step in which it is set.
    assert_eq!(ran.text("log"), "a130 m130 b140 ");
}

#[test]
fn a_blank_link_continues_the_thread_or_begins_a_nameless_one() {
    let mut forked = Forked::new();
    forked.thread("", &[say("m")]);
    forked.thread("other", &[say("a")]);
    assert_eq!(forked.run(1000).text("log"), "a60 m60 ");
    let mut forked = Forked::new();
    forked.thread("main", &[say("m")]);
    forked.thread("", &[say("a")]);
    assert_eq!(forked.run(1000).text("log"), "a60 m60 ");
}

#[test]
fn a_join_waits_for_all_and_the_named_one_goes_on() {
    let mut forked = Forked::new();
    let wait = forked.sketch.block("Timer", &[("Delay", "200")]);
    let quick = code(&mut forked.sketch, "log = log .. 'quick '");
    let join = forked.sketch.block("Join", &[]);
    let after = code(&mut forked.sketch, "log = log .. 'after' .. time()");
    let end = forked.sketch.block("FinalNode", &[]);
    forked.sketch.guarded(forked.fork, wait, "main");
    forked.sketch.guarded(forked.fork, quick, "other");
    forked.sketch.link(wait, join);
    forked.sketch.link(quick, join);
    forked.sketch.guarded(join, after, "other");
    forked.sketch.link(after, end);
    let ran = forked.run(1000);
    assert_eq!(ran.text("log"), "quick after260");
    assert_eq!(ran.end(), Some(260));
}

/// A thread forks and joins twice.
fn twice(options: Options) -> Ran {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "n = 0");
    let fork = sketch.block("Fork", &[]);
    let (one, two) = (
        code(&mut sketch, "n = n + 1"),
        code(&mut sketch, "n = n + 1"),
    );
    let join = sketch.block("Join", &[]);
    let again = sketch.block("IfBlock", &[("Condition", "n < 4")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, zero, fork]);
    sketch.guarded(fork, one, "main");
    sketch.guarded(fork, two, "other");
    sketch.link(one, join);
    sketch.link(two, join);
    sketch.guarded(join, again, "main");
    sketch.guarded(again, fork, "true");
    sketch.guarded(again, end, "false");
    run_with(&sketch, 2000, options, World::default(), |_| {})
}

#[test]
fn a_fork_remembers_its_threads_unless_oddities_are_mended() {
    let ran = twice(Options::simulated());
    assert_eq!(
        ran.errors(),
        ["Cannot create two threads with the same id other"]
    );
    let fixed = Options {
        compat: Compat::Fixed,
        ..Options::simulated()
    };
    let ran = twice(fixed);
    assert_eq!((ran.errors().len(), ran.text("n")), (0, "4".into()));
}

#[test]
fn killing_ends_a_thread_and_a_missing_one_is_told_but_the_flow_goes_on() {
    let mut forked = Forked::new();
    forked.thread(
        "main",
        &[
            ("Timer", &[("Delay", "50")]),
            ("KillThread", &[("Thread", "x")]),
            ("KillThread", &[("Thread", "nobody")]),
            say("m"),
        ],
    );
    forked.thread("x", &[("Timer", &[("Delay", "100")]), say("a")]);
    let ran = forked.run(1000);
    assert_eq!(ran.text("log"), "m110 ");
    assert_eq!(ran.errors(), ["Killing non-existent thread nobody"]);
    assert_eq!(ran.end(), Some(110));
}

#[test]
fn a_thread_may_kill_itself() {
    let sketch = chain(&[
        ("KillThread", &[("Thread", "main")]),
        ("Function", &[("Body", "x = 1")]),
    ]);
    let ran = run(&sketch, 100);
    assert_eq!((ran.text("x").as_str(), ran.end()), ("nothing", Some(30)));
}

#[test]
fn a_name_that_is_taken_ends_the_whole_run() {
    let mut forked = Forked::new();
    let second = forked.sketch.block("Fork", &[]);
    let (one, two) = (
        forked.sketch.block("Timer", &[]),
        forked.sketch.block("Timer", &[]),
    );
    let end = forked.sketch.block("FinalNode", &[]);
    forked.sketch.guarded(forked.fork, second, "main");
    forked.thread("x", &[("Timer", &[("Delay", "5000")])]);
    forked.sketch.guarded(second, one, "main");
    forked.sketch.guarded(second, two, "x");
    forked.sketch.link(one, end);
    forked.sketch.link(two, end);
    let ran = forked.run(1000);
    assert_eq!(
        ran.errors(),
        ["Cannot create new thread with already occupied id x"]
    );
    assert!(ran.end().is_some());
}

#[test]
fn no_more_than_a_hundred_threads() {
    let mut forked = Forked::new();
    for number in 0..105 {
        forked.thread(
            &format!("t{number:03}"),
            &[("Timer", &[("Delay", "100000")])],
        );
    }
    forked.thread("main", &[("Timer", &[("Delay", "100000")])]);
    let ran = forked.run(10_000);
    assert_eq!(
        ran.errors(),
        ["Threads limit exceeded. Maximum threads count is 100"]
    );
}

fn message(text: &'static str) -> Ran {
    message_with(text, Options::simulated())
}

fn message_with(text: &'static str, options: Options) -> Ran {
    let mut forked = Forked::new();
    let send = forked.sketch.block(
        "SendMessageThreads",
        &[("Thread", "main"), ("Message", text)],
    );
    let end = forked.sketch.block("FinalNode", &[]);
    forked.sketch.guarded(forked.fork, send, "other");
    forked.sketch.link(send, end);
    forked.thread(
        "main",
        &[("ReceiveMessageThreads", &[("Variable", "got")]), say("m")],
    );
    run_with(&forked.sketch, 1000, options, World::default(), |_| {})
}

#[test]
fn messages_are_texts_or_numbers_if_oddities_are_mended() {
    let fixed = Options {
        compat: Compat::Fixed,
        ..Options::simulated()
    };
    for (sent, got) in [
        ("\"hello\"", "hello"),
        ("\"'hello'\"", "hello"),
        ("\"1 + 2\"", "1 + 2"),
        ("12", "12"),
        ("0.5", "0.5"),
        ("\"a' .. x\"", "a' .. x"),
    ] {
        let ran = message_with(sent, fixed);
        assert_eq!((ran.text("got").as_str(), ran.errors().len()), (got, 0));
    }
}

#[test]
fn messages_are_expressions() {
    let ran = message("\"'hello'\"");
    assert_eq!((ran.text("got"), ran.errors().len()), ("hello".into(), 0));
    let ran = message("\"1 + 2\"");
    assert_eq!(ran.text("got"), "3");
    let ran = message("\"hello\"");
    assert!(
        ran.errors()[0].contains("Undeclared identifier: hello"),
        "{:?}",
        ran.errors()
    );
    assert_eq!(ran.text("log"), "");
    // Nobody has written that statement into a property.
    assert_eq!(ran.machine.errors()[0].place.property, None);
}

#[test]
fn who_waits_for_a_message_runs_before_the_sender_goes_on() {
    let mut forked = Forked::new();
    forked.thread(
        "a",
        &[("ReceiveMessageThreads", &[("Variable", "got")]), say("a")],
    );
    forked.thread(
        "b",
        &[
            ("Timer", &[("Delay", "40")]),
            ("SendMessageThreads", &[("Thread", "a"), ("Message", "5")]),
            (
                "SendMessageThreads",
                &[("Thread", "nobody"), ("Message", "5")],
            ),
            say("b"),
        ],
    );
    forked.thread("main", &[say("m")]);
    let ran = forked.run(1000);
    assert_eq!(ran.text("log"), "m90 a130 b130 ");
    assert_eq!(ran.text("got"), "5");
}

#[test]
fn messages_wait_in_order_and_who_does_not_wait_goes_on_without() {
    let sketch = chain(&[
        (
            "SendMessageThreads",
            &[("Thread", "main"), ("Message", "1")],
        ),
        (
            "SendMessageThreads",
            &[("Thread", "main"), ("Message", "2")],
        ),
        ("ReceiveMessageThreads", &[("Variable", "x")]),
        ("ReceiveMessageThreads", &[("Variable", "y")]),
        (
            "ReceiveMessageThreads",
            &[("Variable", "z"), ("Synchronized", "false")],
        ),
    ]);
    let ran = run(&sketch, 100);
    assert_eq!(
        [ran.text("x"), ran.text("y"), ran.text("z")],
        ["1", "2", "nothing"]
    );
    assert_eq!(ran.end(), Some(30));
}

#[test]
fn an_error_ends_one_thread_and_not_the_others() {
    let mut forked = Forked::new();
    forked.thread("a", &[("Function", &[("Body", "x = 1 / 0")]), say("a")]);
    forked.thread("main", &[("Timer", &[("Delay", "100")]), say("m")]);
    let ran = forked.run(1000);
    assert_eq!(ran.text("log"), "m160 ");
    assert_eq!(ran.errors(), ["Division by zero"]);
}

#[test]
fn two_threads_at_one_timer_go_on_together_at_the_later_time() {
    let mut forked = Forked::new();
    let late = forked.sketch.block("Timer", &[("Delay", "30")]);
    let shared = forked.sketch.block("Timer", &[("Delay", "100")]);
    let mark = code(&mut forked.sketch, "log = log .. time() .. ' '");
    let end = forked.sketch.block("FinalNode", &[]);
    forked.sketch.guarded(forked.fork, shared, "a");
    forked.sketch.guarded(forked.fork, late, "main");
    forked.sketch.chain(&[late, shared, mark, end]);
    let ran = forked.run(1000);
    // The first one came at 60. The second one came at 90 and set the clock anew, which counted that step.
    assert_eq!(ran.text("log"), "180 180 ");
}
