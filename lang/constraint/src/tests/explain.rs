//! What is told of a run beyond its verdict, and that asking for it changes nothing.

use super::checking::event;
use super::{Run, rules};
use crate::{Checker, Explanation, Kind, Near, Standing, Unit, Verdict};
use lang_text::problem::Locale;

/// A run to the end of its program, with what is told of it.
fn explained(inside: &str, ticks: usize) -> (Run, Explanation) {
    let mut run = Run::new(inside);
    run.checker = Checker::new(rules(inside), Locale::English).explaining();
    run.ticks(ticks);
    run.ends();
    let explanation = run.checker.explain().expect("an explanation");
    (run, explanation)
}

fn near(gap: f64, unit: Unit, at_ms: u64) -> Option<Near> {
    Some(Near { gap, unit, at_ms })
}

#[test]
fn the_rule_that_decided_is_told_with_the_last_values_of_its_conditions() {
    let wrong = r#"<constraint id="c" failMessage="too late" checkOnce="false">
        <less><variableValue name="n"/><int value="3"/></less></constraint>"#;
    let count = event(
        r#"id="z" settedUpInitially="true" dropsOnFire="false""#,
        "<true/>",
        r#"<setter name="n"><sum _1="${n}" _2="1"/></setter>"#,
    );
    let zero = r#"<init><setter name="n"><int value="0"/></setter></init>"#;
    let (_, told) = explained(&format!("{zero}{count}{wrong}"), 9);
    let [rule] = &told.rules[..] else {
        panic!("{told:?}");
    };
    assert_eq!(
        (&*rule.id, rule.kind, rule.decided, rule.fired_ms),
        ("c", Kind::Constraint, true, Some(40))
    );
    let [seen] = &rule.conditions[..] else {
        panic!("{rule:?}");
    };
    assert_eq!((&*seen.text, seen.holds), ("n < 3", Some(false)));
    assert_eq!(seen.values, ["3", "3"]);
}

#[test]
fn of_rules_that_never_fired_it_is_told_how_near_they_came() {
    let done = event(
        r#"id="done" settedUpInitially="true""#,
        r#"<conditions glue="and"><timer timeout="5000" forceDropOnTimeout="false"/>
           <conditions glue="or"><greater _1="${n}" _2="10"/><not><equals _1="${n}" _2="${n}"/></not></conditions>
           </conditions>"#,
        "<success/>",
    );
    let later = event(r#"id="later""#, "<true/>", "<success/>");
    let opens = event(
        r#"id="opens" settedUpInitially="true""#,
        r#"<equals _1="${n}" _2="99"/>"#,
        r#"<setUp id="later"/>"#,
    );
    let count = event(
        r#"id="z" settedUpInitially="true" dropsOnFire="false""#,
        r#"<less _1="${n}" _2="7"/>"#,
        r#"<setter name="n"><sum _1="${n}" _2="2"/></setter>"#,
    );
    let zero = event(
        r#"id="zz" settedUpInitially="true""#,
        "<true/>",
        r#"<setter name="n"><int value="0"/></setter>"#,
    );
    let (run, told) = explained(&format!("{zero}{count}{done}{later}{opens}"), 20);
    assert!(matches!(run.checker.verdict(), Verdict::Failed { .. }));
    let names: Vec<_> = told
        .rules
        .iter()
        .map(|rule| (&*rule.id, rule.state))
        .collect();
    assert_eq!(
        names,
        [
            ("done", Standing::Alive),
            ("opens", Standing::Alive),
            ("later", Standing::NeverSetUp)
        ]
    );
    assert!(
        told.rules
            .iter()
            .all(|rule| !rule.decided && rule.fired_ms.is_none())
    );
    let [timer, head, greater, equals] = &told.rules[0].conditions[..] else {
        panic!("{:?}", told.rules[0]);
    };
    assert_eq!(timer.nearest, near(4800.0, Unit::Milliseconds, 200));
    assert_eq!((&*head.text, head.depth, head.holds), ("or", 0, None));
    assert_eq!((&*greater.text, greater.depth), ("n > 10", 1));
    assert_eq!(greater.nearest, near(2.0, Unit::Value, 40));
    assert_eq!(
        (equals.negated, equals.holds, equals.nearest),
        (true, Some(true), None)
    );
    assert_eq!(
        told.rules[1].conditions[0].nearest,
        near(91.0, Unit::Value, 40)
    );
    assert_eq!(
        told.rules[2].set_up_by,
        [(Kind::Event, "opens".to_owned(), run_number("opens"))]
    );
}

/// The place of an event of the test above among events: the time limit is none.
fn run_number(id: &str) -> usize {
    ["zz", "z", "done", "later", "opens"]
        .iter()
        .position(|one| *one == id)
        .map_or(0, |at| at + 1)
}

#[test]
fn a_run_that_is_explained_is_the_same_run() {
    let all = [
        event(
            r#"id="a" settedUpInitially="true" dropsOnFire="false""#,
            r#"<using><setter name="n"><sum _1="${n}" _2="1"/></setter><return><greater _1="${n}" _2="4"/></return></using>"#,
            r#"<message text="n ${n}"/>"#,
        ),
        event(
            r#"id="b" settedUpInitially="true""#,
            r#"<conditions glue="and"><timer timeout="50"/><not><true/></not></conditions>"#,
            r#"<message text="never"/>"#,
        ),
        event(
            r#"id="c" settedUpInitially="true" dropsOnFire="false""#,
            r#"<inside objectId="nobody" regionId="nowhere"/>"#,
            r#"<message text="never"/>"#,
        ),
        event(r#"id="d" settedUpInitially="true""#, r#"<timer timeout="90"/>"#, "<success/>"),
    ]
    .concat();
    let run = |explains: bool| {
        let mut run = Run::new(&all);
        if explains {
            run.checker = Checker::new(rules(&all), Locale::English).explaining();
        }
        let verdict = run.ticks(20);
        (verdict, run.entries, run.checker.explain().is_some())
    };
    let (plain, explained) = (run(false), run(true));
    assert_eq!((plain.0, plain.1), (explained.0, explained.1));
    assert_eq!((plain.2, explained.2), (false, true));
}
