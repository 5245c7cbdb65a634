//! Breakpoints at changes of variables, and those that write lines.

use super::*;
use lang_diagram::limits::{BREAKPOINTS_MAX, CONDITION_MAX, DEBUG_LINE_BYTES_MAX, DEBUG_LINES_MAX};

/// A desk with a debugger that was given these orders.
fn asked(text: &str, orders: &[&str]) -> (Desk, Robot) {
    let mut desk = desk(text);
    told(&mut desk, "attach");
    for order in orders {
        let answer = told(&mut desk, order);
        assert!(answer.contains("\"done\":true"), "{order}: {answer}");
    }
    let robot = Robot {
        a1: 5,
        ..Robot::default()
    };
    (desk, robot)
}

/// Runs until it is stopped; what it says then.
fn until_stopped(desk: &mut Desk, robot: &mut Robot, from: u32) -> String {
    for now in (from..from + 1000).step_by(10) {
        desk.step(now, robot, &mut Deaf);
        if desk.is_stopped() {
            return told(desk, "look");
        }
    }
    panic!("it does not stop: {}", told(desk, "look"));
}

/// All lines that breakpoints have written since the last time.
fn lines(desk: &mut Desk) -> String {
    desk.log().unwrap_or_default()
}

#[test]
fn a_variable_that_changes_stops_the_program_and_names_the_block() {
    let (mut desk, mut robot) = asked(SLOW, &["watch n"]);
    let state = until_stopped(&mut desk, &mut robot, 0);
    let first = "\"stop\":{\"reason\":\"change\",\"number\":1,\"variable\":\"n\",\"is\":\"0\",\"by\":{\"diagram\":\"main\",\"id\":\"qrm:/main/V\"";
    assert!(state.contains(first), "{state}");
    told(&mut desk, "continue");
    let state = until_stopped(&mut desk, &mut robot, 10);
    let then = "\"was\":\"0\",\"is\":\"1\",\"by\":{\"diagram\":\"main\",\"id\":\"qrm:/main/F\"";
    assert!(state.contains(then), "{state}");
    // Before the token that this reaction has sent.
    assert!(state.contains("\"port\":\"M3\""), "{state}");
    assert_eq!(robot.told, Vec::<String>::new());
    told(&mut desk, "continue");
    desk.step(1000, &mut robot, &mut Deaf);
    assert_eq!(last(&robot), "power M3 10");
    // What a person assigns is no change of the program's.
    assert!(told(&mut desk, "set n=40").contains("\"done\":true"));
    let state = until_stopped(&mut desk, &mut robot, 1010);
    assert!(state.contains("\"was\":\"40\",\"is\":\"41\""), "{state}");
    told(&mut desk, "disable 1");
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 2000, 3000);
    assert!(!desk.is_stopped());
}

#[test]
fn a_change_by_the_last_reaction_of_an_instant_stops_before_its_end() {
    let text = "A Sensor\nF Text programming {IO0=n = I0}\nM Motors\nA.OUT > F.I0\nA.OUT > M.M3";
    let sorted = "A Sensor\nM Motors\nF Text programming {IO0=n = I0}\nA.OUT > M.M3\nA.OUT > F.I0";
    for text in [text, sorted] {
        let (mut desk, mut robot) = asked(text, &["watch n"]);
        let state = until_stopped(&mut desk, &mut robot, 0);
        assert!(state.contains("\"is\":\"5\",\"by\":"), "{state}");
        assert_eq!(desk.machine().now(), 20);
        assert_eq!(robot.told, Vec::<String>::new());
        told(&mut desk, "continue");
        runs(&mut desk, &mut robot, 1000, 1000);
        assert!(!desk.is_stopped());
        assert_eq!(last(&robot), "power M3 5");
        // The same value is no change.
        runs(&mut desk, &mut robot, 1010, 1100);
        assert!(!desk.is_stopped());
        robot.a1 = 6;
        until_stopped(&mut desk, &mut robot, 1110);
    }
}

#[test]
fn a_change_counts_with_its_condition_its_hits_and_once() {
    let (mut desk, mut robot) = asked(
        SLOW,
        &["watch n from 3 once\nif n > 4", "watch n\nlog n is {n}"],
    );
    let state = until_stopped(&mut desk, &mut robot, 0);
    assert!(state.contains("\"was\":\"6\",\"is\":\"7\""), "{state}");
    let written = lines(&mut desk);
    let all = "{\"log\":[\"n is 0\",\"n is 1\",\"n is 2\",\"n is 3\",\"n is 4\",\"n is 5\",\"n is 6\",\"n is 7\"],\"lost\":0}";
    assert_eq!(written, all);
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 1000, 1100);
    assert!(!desk.is_stopped());
    let left = told(&mut desk, "breakpoints");
    assert!(!left.contains("\"number\":1,"), "{left}");
    assert!(
        left.contains("\"variable\":\"n\",\"if\":\"\",\"from\":0,\"log\":\"n is {n}\""),
        "{left}"
    );
}

#[test]
fn a_breakpoint_writes_its_line_at_a_block_and_goes_on_also_where_a_step_ends() {
    let (mut desk, mut robot) = asked(
        SLOW,
        &[
            "break qrm:/main/M\nif data > 5\nlog {n}: {data} of {k}",
            "break qrm:/main/V\nlog n is {n}, {data}",
        ],
    );
    let refused = told(&mut desk, "break qrm:/main/M\nlog n is {n}, {nn + 1}");
    assert!(
        refused.contains("the line: 1:12 the program has no variable 'nn'"),
        "{refused}"
    );
    runs(&mut desk, &mut robot, 0, 20);
    assert_eq!(last(&robot), "power M3 10");
    let first = lines(&mut desk);
    // What starts a program is a token without a value, and nothing has assigned n before it.
    assert!(
        first.starts_with("{\"log\":[\"n is <no value yet>, <a control token came here"),
        "{first}"
    );
    assert!(first.ends_with(",\"1: 10 of 2\"],\"lost\":0}"), "{first}");
    told(&mut desk, "pause");
    runs(&mut desk, &mut robot, 30, 30);
    for _ in 0..3 {
        told(&mut desk, "step");
        until_stopped(&mut desk, &mut robot, 40);
    }
    assert_eq!(lines(&mut desk), "{\"log\":[\"2: 10 of 2\"],\"lost\":0}");
}

#[test]
fn mistakes_are_told_with_their_place_and_the_nearest_name() {
    let (mut desk, _) = asked(SLOW, &[]);
    for (order, why) in [
        (
            "watch power",
            "this cannot be watched: the program has no variable 'power'",
        ),
        ("watch data", "the program has no variable 'data'"),
        (
            "watch n\nif data > 3",
            "the condition: 1:1 the program has no variable 'data'",
        ),
        (
            "watch n\nif n + 1 > kkk",
            "the condition: 1:9 the program has no variable 'kkk'",
        ),
        (
            "watch n\nif n = 3",
            "the condition: 1:1 an expression that is only looked at cannot assign",
        ),
        (
            "break qrm:/main/M\nif random(5) > data",
            "reads no sensors and no random numbers",
        ),
        (
            "break qrm:/main/M\nif sensorA1 > data",
            "reads no sensors and no random numbers",
        ),
        ("break qrm:/main/M\nif data >", "the condition: 1:"),
        ("break qrm:/main/M\nlog {data} {(n}", "the line: 1:"),
    ] {
        let answer = told(&mut desk, order);
        assert!(answer.contains("\"done\":false"), "{order}: {answer}");
        assert!(answer.contains(why), "{order}: {answer}");
    }
    let long = format!("watch n\nlog {}", "x".repeat(CONDITION_MAX + 1));
    assert!(told(&mut desk, &long).contains("\"done\":false"));
    assert!(told(&mut desk, "breakpoints").contains("\"breakpoints\":[]"));
    let mut named = super::desk(&SLOW.replace("n = 0", "speed = 0; n = 0"));
    told(&mut named, "attach");
    for order in ["watch sped", "watch n\nif sped > 3", "watch n\nlog {sped}"] {
        let answer = told(&mut named, order);
        assert!(answer.contains("did you mean 'speed'?"), "{answer}");
    }
}

#[test]
fn a_new_version_keeps_what_is_watched_and_is_no_change_itself() {
    let (mut desk, mut robot) = asked(
        SLOW,
        &["watch n\nif n > 6", "break qrm:/main/M\nif data > 90"],
    );
    runs(&mut desk, &mut robot, 0, 40);
    let next = SLOW.replace("n = n + 1", "n = n + 2");
    desk.patch(&version(&next), &mut robot).expect("a change");
    let state = until_stopped(&mut desk, &mut robot, 50);
    assert!(state.contains("\"was\":\"6\",\"is\":\"8\""), "{state}");
    // A block that is gone takes no breakpoint with it.
    told(&mut desk, "clear 1");
    told(&mut desk, "continue");
    let without = "A Sensor\nF Text programming {IO0=n = n + 1; I0 * k}\nV Variable {variable=n = 0; k = 2}\nA.OUT > F.I0";
    desk.patch(&version(without), &mut robot).expect("a change");
    desk.patch(&version(SLOW), &mut robot).expect("a change");
    robot.a1 = 50;
    let state = until_stopped(&mut desk, &mut robot, 2000);
    assert!(
        state.contains("\"reason\":\"breakpoint\",\"number\":2"),
        "{state}"
    );
}

#[test]
fn a_condition_of_a_change_means_the_variable_data_and_no_token_also_in_the_past() {
    // The token that comes after each change is above 100; the variable is not.
    let text = "A Sensor\nF Text programming {IO0=data = I0; data + 100}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    let (mut desk, mut robot) = asked(text, &["watch data\nif data > 100"]);
    let back = |desk: &mut Desk| {
        told(desk, "back continue");
        while desk.search_on() {}
        told(desk, "look")
    };
    for now in (0..400).step_by(10) {
        robot.a1 = now as i32 / 10 % 7;
        desk.step(now, &mut robot, &mut Deaf);
        assert!(!desk.is_stopped());
    }
    told(&mut desk, "pause");
    until_stopped(&mut desk, &mut robot, 400);
    let state = back(&mut desk);
    assert!(state.contains("\"reason\":\"oldest\""), "{state}");
    told(&mut desk, "present");
    // It counts where the variable itself is.
    robot.a1 = 120;
    told(&mut desk, "continue");
    let state = until_stopped(&mut desk, &mut robot, 1400);
    assert!(state.contains("\"is\":\"120\""), "{state}");
    told(&mut desk, "step");
    until_stopped(&mut desk, &mut robot, 2400);
    told(&mut desk, "step");
    until_stopped(&mut desk, &mut robot, 3400);
    let state = back(&mut desk);
    assert!(state.contains("\"reason\":\"change\""), "{state}");
    assert!(state.contains("\"is\":\"120\""), "{state}");
}

/// A cycle that counts to a number within one instant.
fn cycle(to: u32) -> String {
    format!(
        "V Variable {{variable=n = 0}}\nF Text programming {{IO0=n = n + 1; n}}\nG If {{condition=data < {to}}}\nV.CF_OUT > F.CF_IN\nT Value generator\nT.OUT > F.I0\nF.O0 > G.DATA\nG.TRUE > F.I0"
    )
}

#[test]
fn a_variable_that_changes_thousands_of_times_in_an_instant_writes_no_more_than_is_kept() {
    let (mut desk, mut robot) = asked(
        &cycle(3000),
        &["watch n\nlog n is {n}", "watch n\nif n == 2999"],
    );
    let state = until_stopped(&mut desk, &mut robot, 0);
    assert!(
        state.contains("\"was\":\"2998\",\"is\":\"2999\""),
        "{state}"
    );
    let written = lines(&mut desk);
    let count = written.matches("n is ").count();
    assert!(count <= DEBUG_LINES_MAX, "{count}");
    assert!(written.contains("\"n is 2999\""), "{written}");
    assert!(
        written.contains(&format!("\"lost\":{}}}", 3000 - count)),
        "{written}"
    );
    assert_eq!(lines(&mut desk), "");
}

#[test]
fn a_thousand_breakpoints_and_a_long_text_at_each_instant_stay_within_bounds() {
    let long = "x".repeat(3000);
    let text = format!(
        "A Sensor\nF Text programming {{IO0=t = '{long}'; I0}}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3"
    );
    let (mut desk, mut robot) = asked(&text, &["break qrm:/main/M\nlog {t}{t}{t}"]);
    for _ in 1..BREAKPOINTS_MAX {
        assert!(told(&mut desk, "break qrm:/main/M\nif data > 1000").contains("\"done\":true"));
    }
    assert!(told(&mut desk, "break qrm:/main/M").contains("1000 breakpoints already"));
    runs(&mut desk, &mut robot, 0, 200);
    assert!(!desk.is_stopped());
    let written = lines(&mut desk);
    assert_eq!(written.matches("\"xxx").count(), 10, "{written}");
    assert!(
        written.len() < 12 * DEBUG_LINE_BYTES_MAX,
        "{}",
        written.len()
    );
}

#[test]
fn numbers_that_come_by_themselves_are_met_at_the_block_after_them() {
    let text = "R Random generator {fromNumber=1 | toNumber=3 | repeatedly=true | time=20}\nM Motors\nR.OUT > M.M3";
    let (mut desk, mut robot) = asked(text, &[]);
    for order in ["break qrm:/main/R", "until qrm:/main/R"] {
        let refused = told(&mut desk, order);
        assert!(refused.contains("\"done\":false"), "{refused}");
        assert!(refused.contains("stop at the block after it"), "{refused}");
    }
    told(&mut desk, "break qrm:/main/M");
    for ms in [20, 40, 60] {
        until_stopped(&mut desk, &mut robot, 100 * ms);
        assert_eq!(desk.machine().now(), ms);
        told(&mut desk, "continue");
    }
    // What starts one anew is a token like any other.
    let started = format!("{text}\nL Loop {{time=50}}\nL.OUT > R.CF_IN");
    let (mut desk, mut robot) = asked(&started, &["break qrm:/main/R"]);
    for (ms, from) in [(50, 0), (100, 10_000)] {
        until_stopped(&mut desk, &mut robot, from);
        assert_eq!(desk.machine().now(), ms);
        told(&mut desk, "continue");
    }
    // One that gives a number for each token reacts to each.
    let once = "R Random generator\nM Motors\nR.OUT > M.M3";
    asked(once, &["break qrm:/main/R"]);
}

#[test]
fn the_token_that_comes_next_is_looked_at_and_changed() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    runs(&mut desk, &mut robot, 0, 20);
    assert!(desk.is_stopped());
    let seen = told(&mut desk, "evaluate data + 1");
    assert!(seen.contains("\"value\":\"11\""), "{seen}");
    for (order, why) in [
        ("set data='fast'", "is a number and stays one"),
        ("set data={1, 2}", "is a number and stays one"),
        ("set data=dato", "no variable 'dato'"),
        ("set data=random(3)", "reads no sensors"),
        ("evaluate data = 3", "assigns none"),
    ] {
        let answer = told(&mut desk, order);
        assert!(answer.contains(why), "{order}: {answer}");
    }
    let set = told(&mut desk, "set data=data * 2 + n");
    assert!(set.contains("\"value\":\"21\""), "{set}");
    assert!(told(&mut desk, "look").contains("\"value\":\"21\""));
    told(&mut desk, "clear all");
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 30, 30);
    assert_eq!(last(&robot), "power M3 21");
    // Between two instants nothing comes next.
    told(&mut desk, "pause");
    runs(&mut desk, &mut robot, 40, 40);
    assert!(told(&mut desk, "evaluate data").contains("no variable 'data'"));
    assert!(told(&mut desk, "set data=3").contains("no variable 'data'"));
}

#[test]
fn a_token_that_is_whole_stays_whole() {
    let text = "V Value generator {varValue=10}\nM Motors\nV.OUT > M.M3";
    let (mut desk, mut robot) = (desk(text), Robot::default());
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    runs(&mut desk, &mut robot, 0, 40);
    assert!(desk.is_stopped());
    for wrong in ["2.5", "9999999999999", "0.0 / 0.0"] {
        let answer = told(&mut desk, &format!("set data={wrong}"));
        assert!(!answer.contains("\"done\":true"), "{wrong}: {answer}");
    }
    let told = told(&mut desk, "set data=2.0 * 3");
    assert!(told.contains("\"type\":\"int\",\"value\":\"6\""), "{told}");
}

#[test]
fn a_token_without_a_value_gets_none() {
    let text = "W Wait and send {time=20}\nM Motors\nW.CF_OUT > M.CF_IN";
    let (mut desk, mut robot) = (desk(text), Robot::default());
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    runs(&mut desk, &mut robot, 0, 40);
    assert!(desk.is_stopped());
    let answer = told(&mut desk, "set data=3");
    assert!(answer.contains("has no value"), "{answer}");
}
