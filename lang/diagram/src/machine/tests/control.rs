//! Conditions, loops, switches, subprograms, and what is said of their links.

use super::{Ran, Sketch, chain, code, run, run_with};
use crate::lower::World;
use crate::machine::Options;
use lang_expr::Compat;

#[test]
fn time_is_30_at_the_first_block() {
    let ran = run(&chain(&[("Function", &[("Body", "t = time()")])]), 100);
    assert_eq!((ran.text("t").as_str(), ran.end()), ("30", Some(30)));
}

#[test]
fn a_busy_loop_makes_4948_rounds_in_a_second() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = sketch.block("VariableInit", &[("variable", "x"), ("value", "0")]);
    let busy = sketch.block("PreconditionalLoop", &[("Condition", "time() < 1000")]);
    let count = code(&mut sketch, "x = x + 1");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, zero, busy]);
    sketch.guarded(busy, count, "iteration");
    sketch.guarded(busy, end, "");
    sketch.link(count, busy);
    let ran = run(&sketch, 2000);
    assert_eq!((ran.text("x").as_str(), ran.end()), ("4948", Some(1000)));
}

#[test]
fn timers_round_up_to_ten_and_take_at_least_one_step() {
    for (delay, took) in [
        ("0", 10),
        ("-5", 10),
        ("1", 10),
        ("10", 10),
        ("11", 20),
        ("15", 20),
        ("14.4", 20),
        ("10.4", 10),
        ("1000", 1000),
    ] {
        let ran = run(&chain(&[("Timer", &[("Delay", delay)])]), 5000);
        assert_eq!(ran.end(), Some(30 + took), "{delay}");
    }
}

/// A loop whose body leaves it when `again` says so, and which is entered twice.
fn rounds(iterations: &str, leave: &str, options: Options) -> String {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "n = 0; entered = 1; first = 0");
    let counted = sketch.block("Loop", &[("Iterations", iterations)]);
    let body = code(&mut sketch, "n = n + 1");
    let early = sketch.block("IfBlock", &[("Condition", leave)]);
    let out = code(&mut sketch, "");
    let again = sketch.block("IfBlock", &[("Condition", "entered == 1")]);
    let second = code(&mut sketch, "first = n; n = 0; entered = 2");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, zero, counted]);
    sketch.guarded(counted, body, "iteration");
    sketch.guarded(counted, out, "");
    sketch.link(body, early);
    sketch.guarded(early, out, "true");
    sketch.guarded(early, counted, "false");
    sketch.link(out, again);
    sketch.guarded(again, second, "true");
    sketch.guarded(again, end, "");
    sketch.link(second, counted);
    let ran = run_with(&sketch, 5000, options, World::default(), |_| {});
    assert!(ran.errors().is_empty(), "{:?}", ran.errors());
    format!("{} {}", ran.text("first"), ran.text("n"))
}

#[test]
fn the_counter_of_a_loop_belongs_to_the_block() {
    let real = Options::simulated();
    // Left after one of three, and entered again: two more.
    assert_eq!(rounds("3", "entered == 1 and n == 1", real), "1 2");
    // After a full run it begins anew.
    assert_eq!(rounds("3", "false", real), "3 3");
    assert_eq!(rounds("2.5", "false", real), "3 3");
    assert_eq!(rounds("0", "false", real), "0 0");
    assert_eq!(rounds("-4", "false", real), "0 0");
}

#[test]
fn a_counted_loop_is_counted_anew_when_it_is_entered_if_oddities_are_mended() {
    let fixed = Options {
        compat: Compat::Fixed,
        ..Options::simulated()
    };
    assert_eq!(rounds("3", "entered == 1 and n == 1", fixed), "1 3");
}

fn branch(expression: &str, guards: &[&str]) -> Ran {
    branch_with(expression, guards, Options::simulated())
}

fn branch_with(expression: &str, guards: &[&str], options: Options) -> Ran {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let switch = sketch.block("SwitchBlock", &[("Expression", expression)]);
    sketch.link(start, switch);
    for guard in guards {
        let taken = code(&mut sketch, &format!("taken = 'g{guard}'"));
        let end = sketch.block("FinalNode", &[]);
        sketch.guarded(switch, taken, guard);
        sketch.link(taken, end);
    }
    run_with(&sketch, 100, options, World::default(), |_| {})
}

#[test]
fn switches_compare_texts_with_guards_in_lower_case() {
    assert_eq!(branch("1.0", &["1", "2", ""]).text("taken"), "g1");
    assert_eq!(branch("1 + 1", &["1", "2", ""]).text("taken"), "g2");
    assert_eq!(branch("'A'", &["A", ""]).text("taken"), "g");
    assert_eq!(branch("'a'", &["A", ""]).text("taken"), "gA");
    assert_eq!(branch("true", &["TRUE", ""]).text("taken"), "gTRUE");
    let fixed = Options {
        compat: Compat::Fixed,
        ..Options::simulated()
    };
    let mended = |value| branch_with(value, &["A", ""], fixed).text("taken");
    assert_eq!(
        (mended("'A'").as_str(), mended("'a'").as_str()),
        ("gA", "g")
    );
}

#[test]
fn conditions_take_the_missing_role_for_a_blank_link() {
    for (guards, condition, taken) in [
        (["true", "false"], "1 < 2", "0"),
        (["TRUE", "False"], "1 > 2", "1"),
        (["", "false"], "1 < 2", "0"),
        (["true", ""], "1 > 2", "1"),
        (["anything", "true"], "1 < 2", "1"),
    ] {
        let mut sketch = Sketch::new();
        let start = sketch.block("InitialNode", &[]);
        let choice = sketch.block("IfBlock", &[("Condition", condition)]);
        sketch.link(start, choice);
        for (at, guard) in guards.iter().enumerate() {
            let set = code(&mut sketch, &format!("taken = {at}"));
            let end = sketch.block("FinalNode", &[]);
            sketch.guarded(choice, set, guard);
            sketch.link(set, end);
        }
        assert_eq!(
            run(&sketch, 100).text("taken"),
            taken,
            "{guards:?} {condition}"
        );
    }
}

/// What is said when a block with such links is reached: guards of links that lead to a final node, and loose ones.
fn said(kind: &str, guards: &[&str], loose: usize) -> Vec<String> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let block = sketch.block(kind, &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.link(start, block);
    for guard in guards {
        sketch.guarded(block, end, guard);
    }
    for _ in 0..loose {
        sketch.connect(Some(block), None, "");
    }
    run(&sketch, 100).errors()
}

const NO_LINKS: &str =
    "No outgoing links, please connect this block to something or use Final Node to end program";
const LOOSE: &str = "Outgoing link is not connected";
const TWO: &str = "There must be exactly TWO links outgoing from if block";
const NO_BODY: &str = "There must be a link with \"body\" marker on it";
const NO_EXIT: &str = "There must be a non-marked outgoing link";

/// Type, guards, how many loose links, and what is said.
const CASES: &[(&str, &[&str], usize, &str)] = &[
    ("FiBlock", &[], 0, NO_LINKS),
    ("FiBlock", &["", ""], 0, "Too many outgoing links"),
    ("FiBlock", &[], 1, LOOSE),
    ("IfBlock", &["true"], 0, TWO),
    ("IfBlock", &["true", "false", ""], 0, TWO),
    ("IfBlock", &["true"], 1, LOOSE),
    (
        "IfBlock",
        &["true", "true"],
        0,
        "Two links marked with 'true' found",
    ),
    (
        "IfBlock",
        &["FALSE", "false"],
        0,
        "Two links marked with 'false' found",
    ),
    (
        "IfBlock",
        &["", "x"],
        0,
        "There must be at least one link with \"true\" or \"false\" marker on it",
    ),
    ("Loop", &[""], 0, NO_BODY),
    ("Loop", &["iteration"], 0, NO_EXIT),
    ("Loop", &["", ""], 0, NO_BODY),
    (
        "Loop",
        &["iteration", "Iteration"],
        0,
        "Two links marked as \"body\" found",
    ),
    ("PreconditionalLoop", &["", ""], 0, NO_BODY),
    (
        "SwitchBlock",
        &["1"],
        0,
        "There must be at list TWO links outgoing from switch block",
    ),
    (
        "SwitchBlock",
        &["1", "2"],
        0,
        "There must be a link without marker on it (default branch)",
    ),
    (
        "SwitchBlock",
        &["", ""],
        0,
        "There must be exactly one link without marker on it (default branch)",
    ),
    (
        "SwitchBlock",
        &["a", "A", ""],
        0,
        "Duplicate case branch: 'a'",
    ),
    (
        "Fork",
        &["main"],
        0,
        "There must be at least two outgoing links",
    ),
    (
        "Fork",
        &["a", "b"],
        0,
        "There must be a link that has its 'Guard' property set to the current thread id main",
    ),
    (
        "Fork",
        &["a", "a"],
        0,
        "Cannot create two threads with the same id a",
    ),
    (
        "Join",
        &[""],
        0,
        "Link outgoing from join block must have surviving thread id in its 'Guard' property",
    ),
    ("KillThread", &[], 0, NO_LINKS),
];

#[test]
fn links_are_checked_in_the_words_of_the_original() {
    for (kind, guards, count, expected) in CASES {
        assert_eq!(said(kind, guards, *count), [*expected], "{kind} {guards:?}");
    }
}

#[test]
fn texts_that_must_be_there_are_asked_for() {
    for (kind, properties, expected) in [
        (
            "KillThread",
            ("Thread", ""),
            "Need to specify a thread to be stopped",
        ),
        (
            "SendMessageThreads",
            ("Thread", ""),
            "Need to specify a receiving thread in 'Thread' property",
        ),
        (
            "ReceiveMessageThreads",
            ("Variable", ""),
            "Need to specify variable which will contain received message",
        ),
    ] {
        assert_eq!(
            run(&chain(&[(kind, &[properties])]), 100).errors(),
            [expected]
        );
    }
}

#[test]
fn a_diagram_needs_a_beginning() {
    let mut sketch = Sketch::new();
    sketch.block("FinalNode", &[]);
    let ran = run(&sketch, 100);
    assert_eq!(
        ran.errors(),
        ["No entry point found, please add Initial Node to a diagram"]
    );
    // When it would have begun.
    assert_eq!(ran.end(), Some(30));
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let sheet = sketch.subprogram("empty", &[]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(sheet, &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, call, end]);
    let ran = run(&sketch, 100);
    assert_eq!(
        ran.errors(),
        ["No entry point found, please add Initial Node to a diagram"]
    );
}

/// A program that calls `drive(speed)` once with 5 and shows what is left of `speed`.
fn call_with(before: &str, options: Options) -> Ran {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, before);
    let sheet = sketch.subprogram("drive", &[("speed", "int", "0")]);
    let inner = sketch.block("InitialNode", &[]);
    let body = code(&mut sketch, "seen = speed; speed = 100");
    let inner_end = sketch.block("FinalNode", &[]);
    sketch.chain(&[inner, body, inner_end]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(sheet, &["2.5 * 2"]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, set, call, end]);
    run_with(&sketch, 100, options, World::default(), |_| {})
}

#[test]
fn parameters_are_global_and_come_back() {
    let ran = call_with("speed = 7", Options::simulated());
    assert_eq!(
        (ran.text("seen"), ran.text("speed")),
        ("5".into(), "7".into())
    );
    assert!(ran.errors().is_empty(), "{:?}", ran.errors());
}

#[test]
fn a_parameter_that_had_no_value_is_an_empty_text_afterwards() {
    let ran = call_with("", Options::simulated());
    assert_eq!(
        (ran.text("seen"), ran.text("speed")),
        ("5".into(), String::new())
    );
    let fixed = Options {
        compat: Compat::Fixed,
        ..Options::simulated()
    };
    assert_eq!(call_with("", fixed).text("speed"), "nothing");
}

/// A subprogram that calls itself `depth - 1` times.
fn recursion(depth: u32) -> Ran {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "n = 0; back = 0");
    let sheet = sketch.subprogram("down", &[]);
    let inner = sketch.block("InitialNode", &[]);
    let count = code(&mut sketch, "n = n + 1");
    let choice = sketch.block("IfBlock", &[("Condition", &format!("n < {depth}"))]);
    let deeper = sketch.call(sheet, &[]);
    let up = code(&mut sketch, "back = back + 1");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[inner, count, choice]);
    sketch.guarded(choice, deeper, "true");
    sketch.guarded(choice, up, "false");
    sketch.chain(&[deeper, up, end]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(sheet, &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, zero, call, end]);
    run(&sketch, 20_000)
}

#[test]
fn subprograms_may_call_themselves_3999_times_deep() {
    let ran = recursion(3999);
    assert_eq!((ran.errors().len(), ran.text("back")), (0, "3999".into()));
    let ran = recursion(4000);
    assert_eq!(ran.errors(), ["Stack overflow"]);
    assert_eq!(ran.text("n"), "3999");
}

#[test]
fn blocks_of_others_are_passed_through() {
    let sketch = chain(&[
        ("Ev3EnginesForward", &[]),
        ("NeverHeardOf", &[]),
        ("PrintText", &[]),
        ("TrikWaitForMotion", &[]),
        ("TrikV6ClearEncoder", &[]),
        ("Function", &[("Body", "x = 1")]),
    ]);
    let ran = run(&sketch, 100);
    assert_eq!((ran.text("x").as_str(), ran.end()), ("1", Some(30)));
    assert_eq!(ran.log(), ["30 rest"]);
}
