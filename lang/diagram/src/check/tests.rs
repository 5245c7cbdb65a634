//! What a check tells, all at once and at the right blocks.

use super::check;
use crate::lower::World;
use crate::sketch::{Sketch, Spot};
use lang_text::problem::{Locale, Severity};

fn lines(sketch: &Sketch, locale: Locale) -> Vec<String> {
    let problems = check(&sketch.project(), World::default());
    problems
        .iter()
        .map(|problem| problem.in_locale(locale))
        .collect()
}

fn code(sketch: &mut Sketch, body: &str) -> Spot {
    sketch.block("Function", &[("Body", body)])
}

#[test]
fn all_errors_are_told_at_once_at_their_blocks() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wrong = code(&mut sketch, "x = 1 +");
    let choice = sketch.block("IfBlock", &[("Condition", "x + 'a' > 1")]);
    let loose = sketch.block("Timer", &[("Delay", "1.5.2")]);
    let alone = sketch.block("TrikLed", &[("Color", "pink")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wrong, choice]);
    sketch.guarded(choice, loose, "true");
    sketch.guarded(choice, end, "false");
    sketch.link(alone, end);
    let mut told = lines(&sketch, Locale::English);
    // An expression may have several errors.
    told.dedup_by_key(|line| line.split("1:").next().unwrap_or_default().to_owned());
    let expected = [
        "main: Timer: No outgoing links, please connect this block to something or use Final Node to end program",
        "main: Function: 'Expression', 1:7 ",
        "main: Condition: 'Condition', 1:",
        "main: Led: 'Color': 'pink' is none of the words that this property may have",
        "main: Led: No way leads to this block",
    ];
    assert_eq!(told.len(), expected.len(), "{told:#?}");
    for (told, expected) in told.iter().zip(expected) {
        assert!(told.starts_with(expected), "{told}\n{expected}");
    }
    let russian = lines(&sketch, Locale::Russian);
    let is_russian = |line: &String| {
        line.chars()
            .any(|letter| ('\u{430}'..'\u{450}').contains(&letter))
    };
    assert!(russian.iter().all(is_russian), "{russian:#?}");
}

#[test]
fn what_only_seems_wrong_from_the_top_is_no_error() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let ask = sketch.block("PreconditionalLoop", &[("Condition", "n < 3 or later > 2")]);
    let random = sketch.block("Randomizer", &[("Variable", "n")]);
    let button = sketch.block("GetButtonCode", &[("Variable", "key")]);
    let got = sketch.block("ReceiveMessageThreads", &[("Variable", "message")]);
    let use_it = code(&mut sketch, "later = n + key; both = message .. later");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, random, ask]);
    sketch.guarded(ask, button, "iteration");
    sketch.guarded(ask, end, "");
    sketch.chain(&[button, got, use_it, ask]);
    let sheet = sketch.subprogram("unused", &[("speed", "int", "1")]);
    let inner = sketch.block("InitialNode", &[]);
    let broken = sketch.block("FiBlock", &[]);
    sketch.link(inner, broken);
    sketch.draw_on(sheet);
    let problems = check(&sketch.project(), World::default());
    let worst = problems.iter().map(|problem| problem.severity).max();
    assert_eq!(worst, Some(Severity::Warning), "{problems:#?}");
    let told = lines(&sketch, Locale::English);
    assert_eq!(told.len(), 2, "{told:#?}");
    assert!(
        told[0].starts_with("unused: End if: No outgoing links"),
        "{told:?}"
    );
    assert_eq!(
        told[1],
        "unused: Initial Node: Diagram \"unused\" is never run"
    );
}

#[test]
fn parameters_are_known_in_their_subprogram() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let sheet = sketch.subprogram("drive", &[("speed", "float", "1"), ("name", "string", "")]);
    let inner = sketch.block("InitialNode", &[]);
    let body = code(&mut sketch, "v = speed * 2; t = name .. v");
    let inner_end = sketch.block("FinalNode", &[]);
    sketch.chain(&[inner, body, inner_end]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(sheet, &["2.5", "'left'"]);
    let wrong = sketch.call(sheet, &["2 +", "'left'"]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, call, wrong, end]);
    let told = lines(&sketch, Locale::English);
    assert_eq!(told.len(), 1, "{told:#?}");
    assert!(told[0].starts_with("main: Subprogram: '', 1:"), "{told:?}");
}

#[test]
fn a_number_that_no_block_takes_is_told_in_its_place() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let long = sketch.block("Timer", &[("Delay", "1e10")]);
    let product = sketch.block("Timer", &[("Delay", "60 * 60 * 1000 * 1000")]);
    let fits = sketch.block("Timer", &[("Delay", "2147483647")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, long, product, fits, end]);
    let problems = check(&sketch.project(), World::default());
    assert!(
        problems
            .iter()
            .all(|problem| problem.severity == Severity::Error)
    );
    assert_eq!(
        lines(&sketch, Locale::English),
        [
            "main: Timer: 'Delay (ms)', 1:1 1e+10 is beyond the whole numbers that a block takes: -2147483648 to 2147483647.",
            "main: Timer: 'Delay (ms)', 1:1 3.6e+09 is beyond the whole numbers that a block takes: -2147483648 to 2147483647.",
        ]
    );
}

#[test]
fn a_variable_of_two_types_is_told_with_both() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let number = code(&mut sketch, "speed = 5");
    let text = code(&mut sketch, "speed = 'fast'");
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, number, text, end]);
    let told = lines(&sketch, Locale::English);
    let wanted = "'speed' is of the type 'integer', and this gives it 'string'";
    assert!(told.iter().any(|line| line.contains(wanted)), "{told:#?}");
    let told = lines(&sketch, Locale::Russian);
    let wanted = "'speed' \u{438}\u{43c}\u{435}\u{435}\u{442} \u{442}\u{438}\u{43f} \u{ab}\u{446}\u{435}\u{43b}\u{44b}\u{439}\u{bb}, \u{430} \u{43f}\u{43e}\u{43b}\u{443}\u{447}\u{430}\u{435}\u{442} \u{ab}\u{442}\u{435}\u{43a}\u{441}\u{442}\u{bb}";
    assert!(told.iter().any(|line| line.contains(wanted)), "{told:#?}");
}
