//! Success, failure and the end of a run.

use super::checking::{at_once, event};
use super::{Level, Run, Stage, Value, Verdict, rules};
use crate::Checker;
use lang_text::problem::Locale;

#[test]
fn success_is_told_with_its_time_and_what_follows_in_the_same_trigger_too() {
    let done = event(
        r#"id="a" settedUpInitially="true""#,
        r#"<timer timeout="19830"/>"#,
        r#"<success/><message text="points: ${total_score}"/>"#,
    );
    let mut run = Run::new(&done);
    assert_eq!(run.ticks(3000), Verdict::Accomplished { after_ms: 19_830 });
    assert_eq!(
        run.told(),
        ["The task was accomplished in 19.83 sec!", "points: 0"]
    );
    assert_eq!(run.entries[1].level, Level::Variables);
}

#[test]
fn seconds_have_no_more_digits_than_needed() {
    for (ms, text) in [
        (1000, "1"),
        (15_000, "15"),
        (40_110, "40.11"),
        (1_234_567, "1234.57"),
    ] {
        assert_eq!(crate::report::seconds(ms), text);
    }
}

#[test]
fn before_success_is_told_events_are_checked_that_wait_for_it() {
    let all = [
        at_once("a", "<success/>"),
        event(
            r#"id="on_success_bonus""#,
            "<true/>",
            r#"<setter name="total_score" _1="7"/><message text="bonus"/><success/>"#,
        ),
        event(
            r#"id="on_success_never""#,
            "<not><true/></not>",
            r#"<message text="never"/>"#,
        ),
        event(r#"id="on_failure""#, "<true/>", r#"<message text="no"/>"#),
    ];
    let mut run = Run::new(&all.concat());
    run.ticks(1);
    assert_eq!(
        run.told(),
        ["bonus", "The task was accomplished in 0.01 sec!"]
    );
    assert!(
        run.entries[2].text.contains(r#""value":7"#),
        "{:?}",
        run.entries
    );
}

#[test]
fn deferred_success_counts_when_the_program_ends_by_itself() {
    let deferred = at_once("a", r#"<success deferred="true"/>"#);
    let mut run = Run::new(&deferred);
    assert_eq!(run.ticks(9), Verdict::Open);
    assert_eq!(run.ends(), Verdict::Accomplished { after_ms: 90 });
    assert_eq!(run.told(), ["The task was accomplished in 0.09 sec!"]);

    let mut run = Run::new(&deferred);
    run.ticks(9);
    let stopped = run
        .checker
        .program_ended(90, true, &mut run.stage, &mut run.entries);
    assert_eq!(stopped, Verdict::Failed { after_ms: 90 });
    assert_eq!(
        run.told(),
        ["Program has finished, but the task is not accomplished."]
    );
}

#[test]
fn events_are_checked_once_more_before_the_end() {
    let all = event(
        r#"id="a" settedUpInitially="true""#,
        r#"<equals _1="${robot1.on}" _2="true"/>"#,
        "<success/>",
    );
    let mut stage = Stage::new();
    stage.set("robot1", "on", Value::Bool(false));
    let mut run = Run::on(stage, &all);
    run.ticks(4);
    run.stage.set("robot1", "on", Value::Bool(true));
    assert_eq!(run.ends(), Verdict::Accomplished { after_ms: 40 });
}

#[test]
fn a_failure_lets_the_pass_go_on_and_one_more_pass_is_made() {
    let all = [
        at_once("c", r#"<fail message="c"/><setUp id="a"/>"#),
        at_once("b", r#"<fail message="b"/>"#),
        event(r#"id="a""#, "<true/>", r#"<success/>"#),
    ];
    let mut run = Run::new(&all.concat());
    // Whatever else happens, a task that has failed is failed.
    assert_eq!(run.ticks(1), Verdict::Failed { after_ms: 10 });
    assert_eq!(
        run.told(),
        ["c", "b", "The task was accomplished in 0.01 sec!"]
    );
}

#[test]
fn a_run_can_go_on_after_failures_and_tell_them_all() {
    let all = [
        at_once("b", r#"<fail message="b"/>"#),
        event(
            r#"id="a" settedUpInitially="true""#,
            r#"<timer timeout="100"/>"#,
            r#"<fail message="a"/>"#,
        ),
        event(
            r#"id="s" settedUpInitially="true""#,
            r#"<timer timeout="200"/>"#,
            "<success/>",
        ),
    ];
    let mut checker = Checker::new(rules(&all.concat()), Locale::English).continuing();
    let (mut stage, mut entries) = (Stage::new(), Vec::new());
    for tick in 1..20 {
        assert_eq!(
            checker.check(tick * 10, &mut stage, &mut entries),
            Verdict::Open
        );
    }
    let failed = Verdict::Failed { after_ms: 200 };
    assert_eq!(checker.check(200, &mut stage, &mut entries), failed);
    let told: Vec<_> = entries
        .iter()
        .map(|entry| (entry.level, &*entry.text))
        .collect();
    let variables = r#"{"variables":[{"name":"total_score","value":0}]}"#;
    assert_eq!(
        told,
        [
            (Level::Error, "b"),
            (Level::Error, "a"),
            (Level::Variables, variables)
        ]
    );
}

#[test]
fn a_run_that_goes_on_ends_when_the_time_is_over() {
    let all = [
        r#"<timelimit value="100"/>"#.to_owned(),
        at_once("b", r#"<fail message="b"/>"#),
    ];
    let mut checker = Checker::new(rules(&all.concat()), Locale::English).continuing();
    let (mut stage, mut entries) = (Stage::new(), Vec::new());
    for tick in 1..=10 {
        checker.check(tick * 10, &mut stage, &mut entries);
    }
    assert_eq!(checker.verdict(), Verdict::Failed { after_ms: 100 });
    let texts: Vec<_> = entries.iter().map(|entry| &*entry.text).collect();
    assert_eq!(texts[..2], ["b", "Program worked for too long time"]);
}
