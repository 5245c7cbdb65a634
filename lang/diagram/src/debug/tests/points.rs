//! Breakpoints that are checked when they are set, and those that stop at changes, forwards and backwards.

use super::{Desk, code, counting, ids};
use crate::debug::{Back, Breakpoint, NoBreakpoint, Phase, Reason, Step};
use crate::limits;
use crate::machine::trace::Deaf;
use crate::ports::Port;
use crate::sketch::Sketch;
use lang_text::problem::{Locale, Problem};

/// Where a text of a breakpoint is wrong, and why.
fn told(problems: &[Problem]) -> String {
    let lines = problems.iter().map(|one| one.in_locale(Locale::English));
    lines.collect::<Vec<_>>().join("; ")
}

fn condition(desk: &mut Desk, block: &str, text: &str) -> Result<u32, NoBreakpoint> {
    desk.session.add(Breakpoint {
        condition: text.into(),
        ..Breakpoint::before(block)
    })
}

#[test]
fn a_condition_that_can_never_be_computed_is_refused_with_its_place() {
    let (project, ids) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    for (text, why) in [
        ("n +", "1:3 Unexpected end"),
        ("n + 1 > nn", "1:9 "),
        ("(n", "1:"),
        (
            "n = 3",
            "1:1 An expression that is only looked at cannot assign",
        ),
        ("random(5) > 2", "1:1 random would change the run"),
        ("sensorA1 > 5", "1:1 The program does not read sensorA1"),
        ("fly(n)", "1:1 "),
        ("n .. ", "1:"),
    ] {
        let refused = condition(&mut desk, &ids[2], text);
        let Err(NoBreakpoint::Condition(problems)) = refused else {
            panic!("{text}: {refused:?}");
        };
        let told = told(&problems);
        assert!(told.contains(why), "{text}: {told}");
    }
    assert_eq!(desk.session.debugger().breakpoints().count(), 0);
    // Nothing has run yet, and no variable has a value.
    for text in ["n == 3", "n + 1 > 5", "time() > 100", "not (n > 3)", "true"] {
        condition(&mut desk, &ids[2], text).unwrap();
    }
}

#[test]
fn what_only_running_can_tell_is_no_mistake() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wait = sketch.block(
        "ReceiveMessageThreads",
        &[("Variable", "m"), ("Synchronized", "true")],
    );
    let copy = code(&mut sketch, "k = m");
    sketch.chain(&[start, wait, copy, wait]);
    let project = sketch.project();
    let ids = ids(&project);
    let mut desk = Desk::of(&project);
    for text in ["m == 'go'", "m > 3", "k + 1 == 2"] {
        condition(&mut desk, &ids[2], text).unwrap();
    }
    let refused = condition(&mut desk, &ids[2], "m +");
    assert!(matches!(refused, Err(NoBreakpoint::Condition(_))));
}

#[test]
fn a_line_is_checked_in_its_braces() {
    let (project, ids) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    let line = |text: &str| Breakpoint {
        log: text.into(),
        ..Breakpoint::before(ids[2].as_str())
    };
    let refused = desk.session.add(line("n is {n}, m is {n + mm}"));
    let Err(NoBreakpoint::Line(problems)) = refused else {
        panic!("{refused:?}");
    };
    assert!(told(&problems).contains("1:21 "), "{}", told(&problems));
    for (bad, why) in [
        ("n is {n", "1:6 This brace is not closed: write }"),
        ("{n} and {", "1:9 This brace is not closed"),
        ("{}", "1:1 There is nothing between these braces"),
        ("n {n}, {  }", "1:8 There is nothing between these braces"),
    ] {
        let refused = desk.session.add(line(bad));
        let Err(NoBreakpoint::Line(problems)) = refused else {
            panic!("{bad}: {refused:?}");
        };
        assert!(told(&problems).starts_with(why), "{}", told(&problems));
    }
    for good in ["n is {n}", "}", "} {n}", "{ n }"] {
        desk.session.add(line(good)).unwrap();
    }
}

#[test]
fn a_variable_that_changes_stops_the_program_and_names_the_block() {
    let (project, ids) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    let number = desk.session.add(Breakpoint::of_changes("n")).unwrap();
    for (was, is, by) in [("", "0", 1), ("0", "1", 2), ("1", "2", 2)] {
        let phase = match desk.session.phase() {
            Phase::Stopped(_) => desk.go_on(),
            Phase::Runs | Phase::Ended { .. } => desk.run(100),
        };
        let Phase::Stopped(stop) = phase else {
            panic!("{phase:?}");
        };
        let Reason::Changed(change) = stop.reason else {
            panic!("{:?}", stop.reason);
        };
        let shown = |value: &Option<lang_expr::Value>| {
            let text = value.as_ref().map(|value| value.to_text().to_string());
            text.unwrap_or_default()
        };
        let seen = (shown(&change.was), shown(&change.is));
        assert_eq!(seen, (was.to_owned(), is.to_owned()));
        let program = desk.session.machine().program();
        assert_eq!(program.id(change.by.unwrap()), Some(ids[by].as_str()));
        assert_eq!((&*change.variable, change.number), ("n", number));
    }
    // What a person assigns is no change of the program's.
    let Desk { session, robot, .. } = &mut desk;
    session.assign("n", "10", robot, &mut Deaf).unwrap();
    desk.go_on();
    assert_eq!(desk.variable("n"), "11");
    desk.session.debugger().enable(number, false);
    assert_eq!(desk.go_on(), Phase::Runs);
}

#[test]
fn a_change_counts_with_its_condition_its_hits_and_once() {
    let (project, _) = counting("n = n + 1", "10");
    let mut desk = Desk::of(&project);
    let point = Breakpoint {
        condition: "n > 5".into(),
        from_hit: 3,
        is_once: true,
        ..Breakpoint::of_changes("n")
    };
    desk.session.add(point).unwrap();
    let line = Breakpoint {
        log: "n is {n}".into(),
        ..Breakpoint::of_changes("n")
    };
    desk.session.add(line).unwrap();
    assert!(matches!(desk.run(1000), Phase::Stopped(_)));
    assert_eq!(desk.variable("n"), "8");
    let (lines, _) = desk.session.debugger().take_lines();
    assert_eq!(lines.last().map(String::as_str), Some("n is 8"));
    assert_eq!(desk.go_on(), Phase::Runs);
}

#[test]
fn a_sensor_that_the_program_reads_can_be_watched() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let read = code(&mut sketch, "a = sensorA1");
    let wait = sketch.block("Timer", &[("Delay", "50")]);
    sketch.chain(&[start, read, wait, read]);
    let mut desk = Desk::of(&sketch.project());
    let port = Port::all().find(|port| port.variable() == Some("sensorA1"));
    let port = port.unwrap();
    desk.robot.readings.insert(port, 30);
    let unread = desk.session.add(Breakpoint::of_changes("sensorA2"));
    assert!(matches!(unread, Err(NoBreakpoint::Variable(_))));
    desk.run(20);
    desk.session
        .add(Breakpoint::of_changes("sensorA1"))
        .unwrap();
    assert_eq!(desk.run(20), Phase::Runs);
    desk.robot.readings.insert(port, 31);
    let Phase::Stopped(stop) = desk.run(20) else {
        panic!("{:?}", desk.session.phase());
    };
    let Reason::Changed(change) = stop.reason else {
        panic!("{:?}", stop.reason);
    };
    assert_eq!((&*change.variable, change.by), ("sensorA1", None));
}

#[test]
fn what_is_no_variable_is_not_watched_and_there_are_bounds() {
    let (project, _) = counting("n = n + 1", "100");
    let mut desk = Desk::of(&project);
    for name in ["m", "pi", "print", "n + 1", "", "1", "n[0]"] {
        let refused = desk.session.add(Breakpoint::of_changes(name));
        let Err(NoBreakpoint::Variable(problems)) = refused else {
            panic!("{name}: {refused:?}");
        };
        assert!(!problems.is_empty(), "{name}");
    }
    for _ in 0..limits::WATCHES_MAX {
        desk.session.add(Breakpoint::of_changes("n")).unwrap();
    }
    assert_eq!(
        desk.session.add(Breakpoint::of_changes("n")),
        Err(NoBreakpoint::TooManyWatches)
    );
}

/// Counts without a wait: a hundred times in each step, so that the last count of a step is seen by no block of it.
fn racing(first: i64) -> Desk {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = code(&mut sketch, &format!("n = {first}"));
    let count = code(&mut sketch, "n = n + 1; k = (n - n % 100) / 100");
    sketch.chain(&[start, set, count, count]);
    let mut desk = Desk::of(&sketch.project());
    desk.session.keep(limits::HISTORY_BYTES);
    desk.run(150);
    desk.session.debugger().pause();
    assert!(matches!(desk.run(1), Phase::Stopped(_)));
    desk
}

fn number(desk: &Desk) -> i64 {
    desk.variable("n").parse().unwrap()
}

#[test]
fn every_change_is_found_again_in_the_past_in_both_directions() {
    for first in [0, 98, 99] {
        let mut desk = racing(first);
        let last = number(&desk);
        assert!(last > 10_000, "{last}");
        desk.session.add(Breakpoint::of_changes("k")).unwrap();
        // The first value of k is none that has changed from another one when nothing before is kept.
        let expected: Vec<i64> = (first + 2..last).filter(|n| n % 100 == 0).collect();
        let mut found = Vec::new();
        while let Ok(stop) = desk.session.back(Back::Continue) {
            if stop.reason == Reason::Oldest {
                break;
            }
            assert!(matches!(stop.reason, Reason::Changed(_)));
            found.insert(0, number(&desk));
        }
        found.retain(|n| (first + 2..last).contains(n));
        assert_eq!(found, expected, "backwards from {first}");
        let mut found = Vec::new();
        while desk.session.forth(None) {
            found.push(number(&desk));
        }
        found.retain(|n| (first + 2..last).contains(n));
        assert_eq!(found, expected, "forwards from {first}");
    }
}

#[test]
fn a_search_is_done_in_pieces_and_can_be_given_up() {
    let mut desk = racing(0);
    let last = number(&desk);
    let point = Breakpoint {
        condition: "n < 0".into(),
        ..Breakpoint::of_changes("n")
    };
    desk.session.add(point).unwrap();
    desk.session.begin_back(Back::Continue).unwrap();
    let mut pieces = 1;
    while desk.session.search_on() {
        pieces += 1;
        assert!(desk.session.is_searching());
        assert_eq!(number(&desk), last, "it stays while it looks");
    }
    assert!(pieces > 5, "{pieces}");
    assert_eq!(desk.session.stop().unwrap().reason, Reason::Oldest);
    desk.session.to_present();
    desk.session.begin_back(Back::Continue).unwrap();
    assert!(desk.session.search_on());
    assert!(desk.session.give_up_search());
    assert!(!desk.session.search_on() && !desk.session.is_past());
    assert_eq!(number(&desk), last);
    // It goes on as if nothing had been looked for.
    desk.session.begin_back(Back::Step(Step::Over)).unwrap();
    desk.session.debugger().clear(None);
    assert_eq!(desk.go_on(), Phase::Runs);
    assert!(!desk.session.is_searching());
}
