//! Orders as texts, and what is told.

use std::rc::Rc;

use super::{counting, robot};
use crate::debug::Session;
use crate::debug::desk::Desk;
use crate::limits;
use crate::lower::{World, lower};
use crate::machine::trace::Deaf;
use crate::machine::{Machine, Options, STEP_MS};
use crate::project::Project;
use crate::sketch::Sketch;
use crate::stand_in::StandIn;
use lang_text::problem::Locale;

struct Stage {
    desk: Desk,
    robot: StandIn,
    now: u32,
    tag: u32,
}

impl Stage {
    fn order(&mut self, text: &str) -> String {
        self.tag += 1;
        let Self {
            desk,
            robot,
            now,
            tag,
        } = self;
        desk.order((*tag, text), *now, robot, &mut Deaf)
    }

    fn run(&mut self, steps: u32) -> Vec<String> {
        for _ in 0..steps {
            self.now += STEP_MS;
            self.robot.tick();
            self.desk.step(self.now, &mut self.robot, &mut Deaf);
        }
        self.desk.news()
    }
}

fn stage() -> (Stage, Vec<String>) {
    stage_of("n = n + 1")
}

fn stage_of(body: &str) -> (Stage, Vec<String>) {
    let (project, ids) = counting(body, "100");
    (stage_with(&project), ids)
}

fn stage_with(project: &Project) -> Stage {
    let program = Rc::new(lower(project, World::default()).unwrap().program);
    let machine = Machine::new(program, Options::default());
    Stage {
        desk: Desk::new(
            Session::alone(machine),
            Locale::English,
            limits::HISTORY_BYTES,
        ),
        robot: robot(),
        now: 0,
        tag: 0,
    }
}

#[test]
fn nothing_is_told_and_nothing_kept_before_a_debugger_is_attached() {
    let (mut stage, _) = stage();
    assert!(stage.run(20).is_empty());
    assert_eq!(
        stage.order("pause"),
        "{\"why\":\"attach the debugger first\",\"to\":1,\"done\":false}"
    );
    assert_eq!(
        stage.order("evaluate n * 2"),
        "{\"type\":\"float\",\"value\":\"4\",\"to\":2,\"done\":true}"
    );
    let state = stage.order("attach");
    assert!(state.contains("\"state\":\"running\""), "{state}");
    assert!(
        state.contains("\"name\":\"n\",\"type\":\"float\",\"value\":\"2\""),
        "{state}"
    );
}

#[test]
fn a_program_is_stopped_stepped_taken_back_and_let_go() {
    let (mut stage, ids) = stage();
    stage.order("attach");
    stage.run(1);
    let number = stage.order(&format!("break {}\nif n == 3", ids[2]));
    assert_eq!(number, "{\"number\":1,\"to\":2,\"done\":true}");
    let log = format!("break {}\nlog n is {{n}}", ids[3]);
    stage.order(&log);
    let news = stage.run(100);
    let [lines, state] = &news[..] else {
        panic!("{news:?}");
    };
    assert_eq!(lines, "{\"log\":[\"n is 2\",\"n is 3\"],\"lost\":0}");
    assert!(state.starts_with("{\"state\":\"stopped\",\"ms\":300,\"attached\":true,\"stop\":{\"reason\":\"breakpoint\",\"number\":1,\"thread\":0,\"name\":\"main\",\"at\":{"), "{state}");
    assert!(state.contains(&format!("\"id\":\"{}\",\"block\":\"Function\"", ids[2])));
    let back = stage.order("back");
    assert!(
        back.starts_with("{\"program\":{\"state\":\"past\",\"ms\":200"),
        "{back}"
    );
    let refused = stage.order("set n=5");
    assert!(refused.contains("looks at the past"), "{refused}");
    stage.order("present");
    let set = stage.order("set n=5");
    assert!(set.contains("\"value\":\"5\""), "{set}");
    let stepped = stage.order("step");
    assert!(stepped.contains("\"reason\":\"step\""), "{stepped}");
    assert!(stepped.contains("\"value\":\"6\""), "{stepped}");
    assert!(stage.order("breakpoints").contains("\"hits\":1"));
    assert!(stage.order("clear all").contains("true"));
    assert!(stage.order("detach").contains("\"done\":true"));
    let news = stage.run(100);
    assert!(
        news.len() == 1 && news[0].contains("\"attached\":false"),
        "{news:?}"
    );
    assert!(stage.run(100).is_empty());
    assert!(
        stage
            .order("evaluate n > 10")
            .contains("\"value\":\"true\"")
    );
}

#[test]
fn orders_that_cannot_be_change_nothing_and_say_why() {
    let (mut stage, ids) = stage();
    stage.order("attach");
    stage.run(1);
    for (order, why) in [
        ("jump", "'jump' is no order"),
        ("break nowhere", "the program has no such block"),
        ("until nowhere", "the program has no such block"),
        ("step", "the program is not stopped"),
        ("continue", "the program is not stopped"),
        ("back", "the program runs: pause it first"),
        ("clear 7", "there is no breakpoint 7"),
        ("enable 7", "there is no breakpoint 7"),
        ("release x", "the thread 'x' is not held"),
        ("set n=", "Variable n"),
        ("set n=\"a\"", ""),
        ("evaluate 1 +", ""),
        ("evaluate m + 1", "Nothing has given 'm' a value"),
        ("evaluate 99999999999999999999", "counts as 0"),
    ] {
        let answer = stage.order(order);
        assert!(answer.ends_with("\"done\":false}"), "{order}: {answer}");
        assert!(
            answer.contains(why) || order.starts_with("set"),
            "{order}: {answer}"
        );
    }
    for (order, why) in [
        (
            "set step=1",
            "the program has no variable 'step'; it has: n\"",
        ),
        (
            "set N=1",
            "the program has no variable 'N'; it has: n; did you mean 'n'?",
        ),
        (
            "set n=99999999999999999999",
            "1:1 The number 99999999999999999999 counts as 0.",
        ),
        (
            "set n='one'",
            "'n' is of the type 'integer', and this gives it 'string': a variable keeps its type until the program starts anew. Give it 'integer', or take another name.",
        ),
    ] {
        let answer = stage.order(order);
        assert!(answer.contains(why), "{order}: {answer}");
    }
    let long = "x".repeat(limits::CONDITION_MAX + 1);
    let answer = stage.order(&format!("break {}\nif {long}", ids[2]));
    assert!(answer.contains("at most 4096 bytes"), "{answer}");
    stage.run(50);
    stage.order("pause");
    stage.run(1);
    assert!(
        stage
            .order("step over nobody")
            .contains("there is no thread 'nobody'")
    );
}

/// Two threads that count, `main` and `other`, the second of which begins after a while.
fn two_threads() -> Stage {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let set = sketch.block("Function", &[("Body", "a = 0; b = 0")]);
    let first = sketch.block("Timer", &[("Delay", "100")]);
    let fork = sketch.block("Fork", &[]);
    sketch.chain(&[start, set, first, fork]);
    for (name, body) in [("main", "a = a + 1"), ("other", "b = b + 1")] {
        let count = sketch.block("Function", &[("Body", body)]);
        let wait = sketch.block("Timer", &[("Delay", "50")]);
        sketch.guarded(fork, count, name);
        sketch.chain(&[count, wait, count]);
    }
    stage_with(&sketch.project())
}

#[test]
fn a_thread_that_is_held_is_known_to_all_and_one_that_cannot_be_is_refused() {
    let mut stage = two_threads();
    stage.order("attach");
    stage.run(2);
    let refused = stage.order("hold othr");
    assert!(
        refused.contains("\"why\":\"there is no thread 'othr'; threads are main, other\""),
        "{refused}"
    );
    // It has not begun yet.
    let held = stage.order("hold other");
    assert!(held.contains("\"held\":[\"other\"]"), "{held}");
    let news = stage.run(1).join("\n");
    assert!(news.contains("\"held\":[\"other\"]"), "{news}");
    stage.run(30);
    let look = stage.order("look");
    assert!(look.contains("\"does\":\"held\""), "{look}");
    assert!(stage.order("evaluate b").contains("\"value\":\"0\""));
    let released = stage.order("release other");
    assert!(!released.contains("\"held\":["), "{released}");
    let news = stage.run(1).join("\n");
    assert!(news.contains("\"state\":\"running\""), "{news}");
    assert!(!news.contains("\"held\":["), "{news}");
    // One that has not come to a block can be released too.
    stage.order("hold main");
    assert!(stage.order("release main").contains("\"done\":true"));
    let again = stage.order("release main");
    assert!(again.contains("the thread 'main' is not held"), "{again}");
    // If none would go on, nothing is gone on with.
    stage.order("pause");
    stage.run(1);
    stage.order("hold main");
    stage.order("hold other");
    let refused = stage.order("continue");
    assert!(refused.contains("all threads are held"), "{refused}");
    stage.order("release other");
    assert!(stage.order("continue").contains("\"done\":true"));
}

#[test]
fn what_would_be_too_long_to_tell_is_cut_and_says_by_how_much() {
    let assigned = (0..3000).map(|number| format!("v{number} = 1"));
    let (mut stage, ids) = stage_of(&assigned.collect::<Vec<_>>().join("; "));
    stage.order("attach");
    stage.run(1);
    let state = stage.order("look");
    assert!(state.len() < 256 << 10, "{}", state.len());
    let told = state.matches("{\"name\":\"").count();
    let left_out = format!("\"variables_left_out\":{}", 3001 - told);
    assert!(state.contains(&left_out), "{told}: {left_out}");
    let line = format!("break {}\nlog {}", ids[2], "x".repeat(900));
    for _ in 0..100 {
        stage.order(&line);
    }
    let news = stage.run(20);
    assert!(news[0].len() < 128 << 10, "{}", news[0].len());
    let told = news[0].matches("xxx\"").count();
    let lost = news[0].rsplit(':').next().unwrap();
    let lost: usize = lost.trim_end_matches('}').parse().unwrap();
    assert!(
        lost > 0 && (told + lost).is_multiple_of(100),
        "{told} and {lost}"
    );
}

#[test]
fn a_pause_of_a_program_that_is_stopped_asks_for_nothing() {
    let (mut stage, _) = stage();
    stage.order("attach");
    stage.order("pause");
    stage.run(1);
    assert!(stage.order("pause").contains("\"state\":\"stopped\""));
    assert!(stage.order("continue").contains("\"state\":\"running\""));
    stage.run(2);
    assert!(stage.order("look").contains("\"state\":\"running\""));
}

#[test]
fn breakpoints_come_in_pages_and_none_is_left_out() {
    let (mut stage, ids) = stage();
    stage.order("attach");
    for _ in 0..limits::BREAKPOINTS_MAX {
        let line = "x".repeat(400);
        stage.order(&format!("break {}\nlog {line}", ids[2]));
    }
    let mut seen = Vec::new();
    let mut pages = 0;
    loop {
        let after = seen.last().copied().unwrap_or(0);
        let page = match after {
            0 => stage.order("breakpoints"),
            after => stage.order(&format!("breakpoints after {after}")),
        };
        assert!(page.len() < 200_000, "{}", page.len());
        pages += 1;
        let numbers = page.split("\"number\":").skip(1);
        let numbers = numbers.map(|rest| rest.split(',').next().unwrap().parse::<u32>().unwrap());
        seen.extend(numbers);
        if !page.contains("breakpoints_left_out") {
            break;
        }
    }
    assert!(pages > 2, "{pages}");
    let all: Vec<u32> = (1..=limits::BREAKPOINTS_MAX as u32).collect();
    assert_eq!(seen, all);
}

#[test]
fn a_change_is_told_with_what_was_and_what_is() {
    let (mut stage, ids) = stage();
    stage.order("attach");
    let refused = stage.order("watch nn");
    assert!(
        refused.contains("this cannot be watched: 1:1 "),
        "{refused}"
    );
    let refused = stage.order(&format!("break {}\nif n +", ids[2]));
    assert!(
        refused.contains("\"why\":\"the condition: 1:3 "),
        "{refused}"
    );
    assert!(stage.order("watch n\nif n == 3").contains("\"number\":1"));
    let news = stage.run(100).join("\n");
    for part in [
        "\"reason\":\"change\",\"number\":1,\"variable\":\"n\",\"was\":\"2\",\"is\":\"3\",\"by\":{",
        &format!("\"id\":{:?}", ids[2]),
    ] {
        assert!(news.contains(part), "{part}: {news}");
    }
    assert!(
        stage
            .order("breakpoints")
            .contains("\"variable\":\"n\",\"if\":\"n == 3\"")
    );
}

#[test]
fn a_long_search_is_told_at_its_end_and_a_pause_ends_it() {
    let (mut stage, ids) = stage();
    stage.order("attach");
    stage.run(8000);
    stage.order("pause");
    stage.run(1);
    stage.order(&format!("break {}\nif n < 0", ids[2]));
    let answer = stage.order("back continue");
    assert!(answer.contains("\"state\":\"searching\""), "{answer}");
    assert!(stage.order("evaluate n").contains("\"done\":true"));
    let answer = stage.order("pause");
    assert!(answer.contains("\"state\":\"stopped\""), "{answer}");
    let ms = stage.desk.live().now();
    stage.order("back continue");
    let news = stage.run(500).join("\n");
    assert!(news.contains("\"state\":\"past\""), "{news}");
    assert!(news.contains("\"reason\":\"oldest\""), "{news}");
    assert_eq!(stage.desk.live().now(), ms, "the program stands still");
}

#[test]
fn a_program_that_has_ended_takes_no_values_and_stops_in_its_past() {
    let (mut stage, ids) = stage_of("n = n + 1; m = 6 / (3 - n)");
    stage.order("attach");
    let news = stage.run(100).join("\n");
    assert!(news.contains("\"state\":\"ended\""), "{news}");
    let until = format!("until {}", ids[2]);
    for order in ["set n=4", &until, "step", "continue"] {
        let answer = stage.order(order);
        assert!(answer.contains("\"done\":false"), "{order}: {answer}");
        assert!(answer.contains("has ended"), "{order}: {answer}");
        assert!(answer.contains("begin anew"), "{order}: {answer}");
    }
    assert!(stage.order("evaluate n").contains("\"value\":\"3\""));
    let points = stage.order("breakpoints");
    assert!(points.contains("\"breakpoints\":[]"), "{points}");
    let added = stage.order(&format!("break {}\nif n == 1", ids[2]));
    assert!(added.contains("\"number\":1"), "{added}");
    let back = stage.order("back continue");
    assert!(
        back.contains("\"reason\":\"breakpoint\",\"number\":1"),
        "{back}"
    );
    assert!(stage.order("evaluate n").contains("\"value\":\"1\""));
    assert!(stage.order("set n=4").contains("looks at the past"));
}
