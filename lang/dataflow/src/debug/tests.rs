//! Programs under a debugger.

mod changes;
mod past;
mod points;

use super::*;
use crate::check::check;
use crate::machine::fixtures::{diagram, project};
use crate::machine::trace::Deaf;
use crate::project::{DiagramKind, Project};
use lang_diagram::limits::HISTORY_BYTES;
use lang_diagram::ports::Port;
use std::rc::Rc;

/// A robot whose one reading a test writes, with what it was told.
#[derive(Default)]
struct Robot {
    a1: i32,
    told: Vec<String>,
}

impl Brick for Robot {
    fn command(&mut self, command: Command<'_>) {
        self.told.push(command.to_string());
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        (port.name() == "A1").then_some(self.a1)
    }

    fn vector(&mut self, _port: Port, _into: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        low
    }
}

fn of(text: &str) -> Project {
    project(vec![diagram("main", DiagramKind::Main, text)])
}

fn desk(text: &str) -> Desk {
    let checked = check(&of(text));
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    Desk::new(
        Machine::new(Rc::new(checked.program)),
        Locale::English,
        HISTORY_BYTES,
    )
}

fn version(text: &str) -> Version {
    Version::of(&of(text)).expect("a good program")
}

const SLOW: &str = "A Sensor\nF Text programming {IO0=n = n + 1; I0 * k}\nV Variable {variable=n = 0; k = 2}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";

/// That program, whose sensor reads 5.
fn slow() -> (Desk, Robot) {
    let robot = Robot {
        a1: 5,
        ..Robot::default()
    };
    (desk(SLOW), robot)
}

fn runs(desk: &mut Desk, robot: &mut Robot, from: u32, to: u32) {
    for now in (from..=to).step_by(10) {
        desk.step(now, robot, &mut Deaf);
    }
}

fn last(robot: &Robot) -> &str {
    robot.told.last().map_or("", String::as_str)
}

/// What an order is answered.
fn told(desk: &mut Desk, order: &str) -> String {
    desk.order((1, order))
}

#[test]
fn a_program_that_is_watched_tells_its_variables_and_its_ports() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 20);
    let first = told(&mut desk, "look");
    assert!(
        first.contains("\"state\":\"running\",\"ms\":20,\"attached\":false"),
        "{first}"
    );
    assert!(
        first.contains("{\"name\":\"n\",\"type\":\"float\",\"value\":\"1\"}"),
        "{first}"
    );
    // Nobody had looked before.
    assert!(first.contains("\"ports\":[]"), "{first}");
    runs(&mut desk, &mut robot, 30, 60);
    let second = told(&mut desk, "look");
    let port = "\"caption\":\"F\",\"port\":\"O0\",\"type\":\"float\",\"value\":\"10\",\"count\":2}";
    assert!(second.contains(port), "{second}");
    // One that gives no token has reacted too.
    let motors = "\"caption\":\"M\",\"count\":2}";
    let reacted = second.split("\"reacted\":").nth(1).unwrap_or_default();
    assert!(reacted.contains(motors), "{second}");
    runs(&mut desk, &mut robot, 70, limits::TAP_MS + 100);
    let late = told(&mut desk, "look");
    assert!(late.contains("\"ports\":[],\"reacted\":[]"), "{late}");
    assert!(told(&mut desk, "pause").contains("\"done\":false"));
}

#[test]
fn a_breakpoint_stops_before_the_token_and_motors_are_told_after_it() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    let added = told(&mut desk, "break qrm:/main/M\nif data > 15");
    assert!(added.contains("\"number\":1"), "{added}");
    runs(&mut desk, &mut robot, 0, 40);
    assert_eq!(last(&robot), "power M3 10");
    robot.a1 = 8;
    robot.told.clear();
    runs(&mut desk, &mut robot, 50, 100);
    assert_eq!(robot.told, Vec::<String>::new());
    assert!(desk.is_at_rest());
    let state = told(&mut desk, "look");
    assert!(state.contains("\"state\":\"stopped\",\"ms\":60"), "{state}");
    assert!(
        state.contains("\"reason\":\"breakpoint\",\"number\":1"),
        "{state}"
    );
    assert!(
        state.contains("\"port\":\"M3\",\"type\":\"float\",\"value\":\"16\""),
        "{state}"
    );
    let news = desk.news();
    assert!(news.len() == 1 && news[0].contains("stopped"), "{news:?}");
    assert_eq!(desk.news(), Vec::<String>::new());
    // The same token goes on, and time with it from where it stood.
    assert!(told(&mut desk, "step").contains("\"done\":true"));
    runs(&mut desk, &mut robot, 110, 110);
    assert_eq!(last(&robot), "power M3 16");
    assert_eq!(desk.machine().now(), 60);
    runs(&mut desk, &mut robot, 120, 130);
    let next = told(&mut desk, "look");
    assert!(next.contains("\"reason\":\"step\""), "{next}");
    assert!(next.contains("\"ms\":80"), "{next}");
    // Without the debugger it runs on.
    assert!(told(&mut desk, "detach").contains("\"done\":true"));
    runs(&mut desk, &mut robot, 140, 200);
    assert!(!desk.is_stopped());
    assert!(desk.machine().now() > 120);
}

#[test]
fn a_step_out_goes_to_the_next_instant() {
    let (mut desk, mut robot) = slow();
    desk.stop_first();
    runs(&mut desk, &mut robot, 0, 50);
    assert!(desk.is_stopped());
    assert_eq!((desk.machine().now(), robot.told.len()), (0, 0));
    told(&mut desk, "step");
    runs(&mut desk, &mut robot, 60, 60);
    // What starts the program are tokens too.
    assert!(told(&mut desk, "look").contains("\"ms\":0"));
    told(&mut desk, "step out");
    runs(&mut desk, &mut robot, 60, 100);
    let state = told(&mut desk, "look");
    assert!(state.contains("\"reason\":\"step\""), "{state}");
    assert!(state.contains("\"ms\":20"), "{state}");
}

#[test]
fn what_cannot_be_done_is_refused_with_a_reason() {
    let mut desk = desk(SLOW);
    for (order, why) in [
        ("continue", "attach the debugger first"),
        ("fly", "'fly' is no order"),
        ("set zz=1", "no variable 'zz'"),
        ("evaluate sensorA1", "reads no sensors"),
        ("evaluate n = 3", "assigns none"),
        ("evaluate 1 +", "1:"),
    ] {
        let answer = told(&mut desk, order);
        assert!(answer.contains("\"done\":false"), "{answer}");
        assert!(
            answer.to_lowercase().contains(&why.to_lowercase()),
            "{answer}"
        );
    }
    told(&mut desk, "attach");
    for (order, why) in [
        ("continue", "not stopped"),
        ("back", "pause it first"),
        ("hold main", "no threads"),
        ("break qrm:/main/Z", "no such block"),
        ("break qrm:/main/A", "stop at the block after it"),
        ("watch nn", "this cannot be watched: "),
        ("watch nn", "no variable 'nn'"),
        ("watch kk", "no variable 'kk'"),
        ("watch sensorA1", "whose readings are tokens"),
        ("watch abs", "never changes"),
        ("errors stop", "ends a data-flow program"),
        ("clear 7", "7"),
    ] {
        let answer = told(&mut desk, order);
        assert!(answer.contains("\"done\":false"), "{order}: {answer}");
        assert!(answer.contains(why), "{order}: {answer}");
    }
    for _ in 0..lang_diagram::limits::BREAKPOINTS_MAX {
        assert!(told(&mut desk, "break qrm:/main/M").contains("\"done\":true"));
    }
    assert!(told(&mut desk, "break qrm:/main/M").contains("\"done\":false"));
}

#[test]
fn a_condition_that_cannot_be_computed_stops_and_says_so() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    let unknown = told(&mut desk, "break qrm:/main/M\nif dta > 15");
    assert!(unknown.contains("\"done\":false"), "{unknown}");
    let assigns = told(&mut desk, "break qrm:/main/M\nif n = 15");
    assert!(assigns.contains("\"done\":false"), "{assigns}");
    // That a rest wants whole numbers is known only when the token is there.
    told(&mut desk, "break qrm:/main/M\nif data % 2 == 1");
    runs(&mut desk, &mut robot, 0, 40);
    let state = told(&mut desk, "look");
    assert!(
        state.contains("\"reason\":\"condition\",\"number\":1"),
        "{state}"
    );
}

#[test]
fn a_variable_that_is_set_counts_at_the_next_reaction() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 20);
    assert_eq!(last(&robot), "power M3 10");
    assert!(told(&mut desk, "set k=k + 1").contains("\"value\":\"3\""));
    runs(&mut desk, &mut robot, 30, 40);
    assert_eq!(last(&robot), "power M3 15");
    assert!(told(&mut desk, "set k='far'").contains("\"done\":false"));
    for odd in ["sqrt(0 - 1)", "exp(1000)", "{1, sqrt(0 - 1)}"] {
        let refused = told(&mut desk, &format!("set k={odd}"));
        assert!(
            refused.contains("k would be infinite or no number"),
            "{refused}"
        );
    }
    let refused = told(&mut desk, "set kk=1");
    assert!(
        refused.contains("no variable 'kk' with a value; it has: n, k"),
        "{refused}"
    );
}

/// Ten numbers, one each 10 ms.
const TICKS: &str = "L Loop {start_border=1 | end_border=10 | time=10}\nM Motors\nL.OUT > M.M3";

#[test]
fn time_stands_still_however_often_the_program_is_stopped() {
    let (mut desk, mut robot) = (desk(TICKS), Robot::default());
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    let mut stops = 0;
    // The caller's clock goes on, and the program is looked at for 70 ms at each stop.
    for now in (0..2000).step_by(10) {
        desk.step(now, &mut robot, &mut Deaf);
        if desk.is_stopped() && now % 70 == 0 {
            stops += 1;
            assert_eq!(desk.machine().now(), 10 * stops);
            told(&mut desk, "continue");
        }
    }
    assert_eq!(stops, 10);
    let wanted: Vec<String> = (1..=10).map(|n| format!("power M3 {n}")).collect();
    assert_eq!(robot.told[..10], wanted);
}

#[test]
fn a_program_that_waits_is_paused_too() {
    let wait = "G Motors {M3Power=50}\nW Wait and send {time=60000}\nG.CF_OUT > W.CF_IN";
    let (mut desk, mut robot) = (desk(wait), Robot::default());
    told(&mut desk, "attach");
    runs(&mut desk, &mut robot, 0, 100);
    told(&mut desk, "pause");
    runs(&mut desk, &mut robot, 110, 200);
    assert!(desk.is_at_rest());
    let state = told(&mut desk, "look");
    assert!(state.contains("\"stop\":{\"reason\":\"pause\"}"), "{state}");
    assert_eq!(desk.machine().now(), 100);
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 210, 230);
    assert_eq!(desk.machine().now(), 130);
}

#[test]
fn a_pause_of_a_caller_whose_clock_stands_still_takes_no_time() {
    let wait = "G Motors {M3Power=50}\nW Wait and send {time=60000}\nG.CF_OUT > W.CF_IN";
    let (mut desk, mut robot) = (desk(wait), Robot::default());
    told(&mut desk, "attach");
    runs(&mut desk, &mut robot, 0, 100);
    told(&mut desk, "pause");
    runs(&mut desk, &mut robot, 110, 110);
    assert!(desk.is_stopped());
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 110, 110);
    assert_eq!(desk.machine().now(), 110);
}

#[test]
fn a_debugger_that_never_stops_it_changes_nothing() {
    let run = |orders: &[&str]| {
        let (mut desk, mut robot) = (desk(SLOW), Robot::default());
        for order in orders {
            assert!(told(&mut desk, order).contains("\"done\":true"), "{order}");
        }
        for now in (0..400).step_by(10) {
            robot.a1 = (now as i32 * 7) % 41;
            desk.step(now, &mut robot, &mut Deaf);
            if !orders.is_empty() {
                told(&mut desk, "look");
                told(&mut desk, "evaluate n + k * 2");
            }
        }
        robot.told
    };
    let watched = run(&[
        "attach",
        "break qrm:/main/M\nif data > 1000",
        "break qrm:/main/F\nif data == 0 - 1 or n > 1000",
    ]);
    assert_eq!(watched, run(&[]));
}

#[test]
fn an_expression_of_a_person_narrows_no_type_of_the_program() {
    let text = "A Sensor\nF Text programming {IO0=l = {}; l[0] = I0; x = l[0]; x}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    let (mut desk, mut robot) = (
        desk(text),
        Robot {
            a1: 5,
            ..Robot::default()
        },
    );
    runs(&mut desk, &mut robot, 0, 40);
    for order in ["evaluate x + 1", "evaluate l[0] + 1", "evaluate x == 5"] {
        told(&mut desk, order);
    }
    runs(&mut desk, &mut robot, 50, 100);
    assert_eq!(
        desk.machine().errors().len(),
        0,
        "{:?}",
        desk.machine().errors()
    );
    assert_eq!(last(&robot), "power M3 5");
}

#[test]
fn a_number_that_a_text_cannot_take_is_not_set() {
    let text = SLOW.replace("I0 * k", "I0 % k");
    let (mut desk, mut robot) = (
        desk(&text),
        Robot {
            a1: 5,
            ..Robot::default()
        },
    );
    runs(&mut desk, &mut robot, 0, 40);
    assert!(told(&mut desk, "set k=0.5").contains("\"done\":false"));
    assert!(told(&mut desk, "set k=3").contains("\"done\":true"));
    runs(&mut desk, &mut robot, 50, 60);
    assert_eq!(last(&robot), "power M3 2");
}

/// How many items of a list an answer says that it leaves out.
fn left_out(answer: &str, list: &str) -> usize {
    let Some((_, rest)) = answer.split_once(&format!("\"{list}_left_out\":")) else {
        return 0;
    };
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    digits.parse().expect("a number")
}

#[test]
fn what_is_too_much_to_tell_is_cut_and_counted() {
    use crate::limits::{TOLD_BYTES, TOLD_CHARACTERS_MAX};
    use std::fmt::Write as _;
    const VALUES: usize = 40;
    const PAIRS: usize = 300;
    // Texts of which each is cut by itself, and is one of too many.
    let long = "x".repeat(2 * TOLD_CHARACTERS_MAX);
    let mut text = "T Value generator\nR Message receiver\n".to_owned();
    for at in 0..VALUES {
        let _ = writeln!(text, "V{at} Variable {{variable=v{at} = '{long}'}}");
        let _ = writeln!(text, "S{at} Say\nV{at}.OUT > S{at}.DATA");
    }
    // Pairs of which the other half never comes.
    for at in 0..PAIRS {
        let _ = writeln!(text, "Z{at} Zip flows");
        let _ = writeln!(text, "T.OUT > Z{at}.DATA1\nR.OUT > Z{at}.DATA2");
    }
    let (mut desk, mut robot) = (desk(&text), Robot::default());
    told(&mut desk, "attach");
    let before = told(&mut desk, "look");
    for list in ["variables", "ports", "reacted", "waiting"] {
        assert_eq!(left_out(&before, list), 0, "{before}");
    }
    runs(&mut desk, &mut robot, 0, 20);
    let state = told(&mut desk, "look");
    for (list, item, all) in [
        ("variables", "{\"name\":\"v", VALUES),
        // Those of the variables, and that of the value that all pairs get.
        ("ports", "\"port\":\"OUT\"", VALUES + 1),
        ("waiting", "\"port\":\"DATA1\"", PAIRS),
    ] {
        let (shown, left_out) = (state.matches(item).count(), left_out(&state, list));
        assert!(shown > 0 && left_out > 0, "{list}: {shown}, {left_out}");
        assert_eq!(shown + left_out, all, "{list}");
    }
    assert!(!state.contains(&"x".repeat(TOLD_CHARACTERS_MAX + 1)));
    // Four lists, each with the one item more that has filled it, and what is told beside them.
    let most = 4 * (TOLD_BYTES + TOLD_CHARACTERS_MAX + 1000) + 1000;
    assert!(state.len() < most, "{} of {most} bytes", state.len());
}
