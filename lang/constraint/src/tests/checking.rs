//! Passes: order, timers, conditions and what is told.

use std::rc::Rc;

use super::{Level, Run, Stage, Value, Verdict, holds, holds_on, rules};
use crate::Checker;
use crate::limits;
use lang_text::problem::Locale;

pub(super) fn event(attributes: &str, condition: &str, triggers: &str) -> String {
    format!(
        "<event {attributes}><condition>{condition}</condition><triggers>{triggers}</triggers></event>"
    )
}

pub(super) fn at_once(id: &str, triggers: &str) -> String {
    event(
        &format!(r#"id="{id}" settedUpInitially="true""#),
        "<true/>",
        triggers,
    )
}

#[test]
fn the_program_ends_with_neither_success_nor_failure() {
    let mut run = Run::new("");
    assert_eq!(run.ticks(3), Verdict::Open);
    assert_eq!(run.ends(), Verdict::Failed { after_ms: 30 });
    assert_eq!(
        run.told(),
        ["Program has finished, but the task is not accomplished."]
    );
    assert_eq!(run.entries[0].level, Level::Error);
    assert_eq!(run.entries[1].level, Level::Variables);
    let variables = r#"{"variables":[{"name":"total_score","value":0}]}"#;
    assert_eq!(run.entries[1].text, variables);
    // And nothing happens any more.
    run.ticks(10_000);
    assert_eq!(run.entries.len(), 2);
}

#[test]
fn the_time_limit_fails_the_task_when_it_is_reached() {
    let mut run = Run::new(r#"<timelimit value="50"/>"#);
    assert_eq!(run.ticks(4), Verdict::Open);
    assert_eq!(run.ticks(1), Verdict::Failed { after_ms: 50 });
    assert_eq!(run.told(), ["Program worked for too long time"]);
}

#[test]
fn time_counts_from_the_start_of_the_run() {
    let rules = rules(r#"<timelimit value="50"/>"#);
    let mut checker = Checker::new(rules, Locale::Russian).starting_at(1000);
    let (mut stage, mut entries) = (Stage::new(), Vec::new());
    assert_eq!(checker.check(1040, &mut stage, &mut entries), Verdict::Open);
    let failed = Verdict::Failed { after_ms: 50 };
    assert_eq!(checker.check(1050, &mut stage, &mut entries), failed);
    assert!(
        entries[0].text.starts_with('\u{41f}'),
        "{}",
        entries[0].text
    );
}

#[test]
fn a_constraint_fails_as_soon_as_it_does_not_hold() {
    let mut stage = Stage::new();
    stage.region("zone", 0, 0, 400, 400);
    let mut run = Run::on(
        stage,
        r#"<constraint failMessage="left the zone"><inside objectId="robot1" regionId="zone"/></constraint>"#,
    );
    assert_eq!(run.ticks(5), Verdict::Open);
    run.stage.place("robot1", 500, 0, 50, 50);
    assert_eq!(run.ticks(1), Verdict::Failed { after_ms: 60 });
    assert_eq!(run.told(), ["left the zone"]);
}

#[test]
fn a_constraint_that_is_checked_once_is_checked_at_first_only() {
    let inside = r#"<constraint checkOnce="TRUE" failMessage="not at the start">
        <inside objectId="robot1" regionId="zone"/></constraint>"#;
    let mut stage = Stage::new();
    stage.region("zone", 0, 0, 400, 400);
    let mut run = Run::on(stage, inside);
    run.ticks(1);
    run.stage.place("robot1", 500, 0, 50, 50);
    assert_eq!(run.ticks(5), Verdict::Open);

    let mut stage = Stage::new();
    stage.region("zone", 500, 0, 40, 40);
    let mut run = Run::on(stage, inside);
    assert_eq!(run.ticks(1), Verdict::Failed { after_ms: 10 });
    assert_eq!(run.told(), ["not at the start"]);
}

#[test]
fn events_are_checked_by_id_descending_and_nameless_ones_where_a_brace_stands() {
    let say = |id: &str, text: &str| at_once(id, &format!(r#"<message text="{text}"/>"#));
    let all = [
        r#"<init><log text="init"/></init>"#.to_owned(),
        say("a", "a"),
        say("", "first"),
        say("b", "b"),
        say("", "second"),
        say("\u{42e}", "yu"),
        say("Z", "Z"),
        say("|", "bar"),
    ];
    let mut run = Run::new(&all.concat());
    run.ticks(1);
    assert_eq!(
        run.told(),
        ["yu", "bar", "first", "second", "b", "a", "Z", "init"]
    );
    assert_eq!(run.entries[7].level, Level::Log);
    assert_eq!(run.entries[0].level, Level::Info);
}

#[test]
fn what_is_set_up_during_a_pass_is_checked_in_the_next() {
    let all = [
        at_once("b", r#"<setUp id="a"/><message text="b"/>"#),
        event(r#"id="a""#, "<true/>", r#"<message text="a"/>"#),
    ];
    let mut run = Run::new(&all.concat());
    run.ticks(1);
    assert_eq!(run.told(), ["b"]);
    run.ticks(1);
    assert_eq!(run.told(), ["b", "a"]);
    run.ticks(5);
    assert_eq!(run.told(), ["b", "a"]);
}

#[test]
fn what_is_dropped_during_a_pass_is_not_checked_any_more() {
    let all = [
        at_once("b", r#"<drop id="a"/>"#),
        at_once("a", r#"<fail message="a"/>"#),
    ];
    assert_eq!(Run::new(&all.concat()).ticks(3), Verdict::Open);
}

#[test]
fn an_event_that_does_not_drop_fires_again_and_again() {
    let stays = event(
        r#"id="a" settedUpInitially="true" dropsOnFire="false""#,
        "<true/>",
        r#"<setter name="n"><sum _1="1"><!-- --></sum></setter>"#,
    );
    let stays = stays.replace(
        r#"<sum _1="1"><!-- --></sum>"#,
        r#"<sum _1="${n}" _2="1"/>"#,
    );
    let mut run = Run::new(&format!(r#"<init><setter name="n" _1="0"/></init>{stays}"#));
    run.ticks(10);
    // The first pass has no `n` yet, and `init`, which comes last, sets it to 0.
    let n = run.checker.variable("n").map(Value::to_int);
    assert_eq!(n, Some(9));
}

#[test]
fn events_know_of_each_other_whether_they_are_there() {
    let all = [
        at_once("z", r#"<message text="z"/>"#),
        event(
            r#"id="a" settedUpInitially="true""#,
            r#"<conditions glue="and"><dropped id="z"/><settedUp id="a"/></conditions>"#,
            r#"<success/>"#,
        ),
    ];
    assert_eq!(
        Run::new(&all.concat()).ticks(1),
        Verdict::Accomplished { after_ms: 10 }
    );
    let (holds, told) = holds_on(Stage::new(), r#"<settedUp id="ghost"/>"#);
    assert_eq!(
        (holds, told),
        (
            false,
            vec!["Error in checker: No such event: ghost".to_owned()]
        )
    );
    let (holds, _) = holds_on(Stage::new(), r#"<dropped id="ghost"/>"#);
    assert!(holds);
}

#[test]
fn a_timer_counts_from_the_moment_its_event_was_set_up() {
    let all = [
        event(
            r#"id="b" settedUpInitially="true""#,
            r#"<timer timeout="100"/>"#,
            r#"<setUp id="a"/>"#,
        ),
        event(
            r#"id="a""#,
            r#"<timer timeout="50" forceDropOnTimeout="false"/>"#,
            r#"<message text="now"/>"#,
        ),
    ];
    let mut run = Run::new(&all.concat());
    run.ticks(14);
    assert_eq!(run.told(), [""; 0]);
    run.ticks(1);
    assert_eq!(run.told(), ["now"]);
    assert_eq!(run.entries[0].at_ms, 150);
}

#[test]
fn a_timer_that_drops_gives_its_event_one_chance() {
    let timed = |drop: &str| {
        let condition = format!(
            r#"<conditions glue="and"><timer timeout="20" forceDropOnTimeout="{drop}"/><equals _1="${{robot1.on}}" _2="true"/></conditions>"#
        );
        let mut stage = Stage::new();
        stage.set("robot1", "on", Value::Bool(false));
        let event = event(
            r#"id="a" settedUpInitially="true""#,
            &condition,
            "<success/>",
        );
        let mut run = Run::on(stage, &event);
        run.ticks(5);
        run.stage.set("robot1", "on", Value::Bool(true));
        run.ticks(1)
    };
    assert_eq!(timed("true"), Verdict::Open);
    assert_eq!(timed("false"), Verdict::Accomplished { after_ms: 60 });
    // It may still fire in the check that drops it.
    let once = event(
        r#"id="a" settedUpInitially="true""#,
        r#"<timer timeout="20"/>"#,
        "<success/>",
    );
    assert_eq!(
        Run::new(&once).ticks(2),
        Verdict::Accomplished { after_ms: 20 }
    );
}

#[test]
fn an_event_that_is_set_up_again_begins_its_time_anew() {
    let all = [
        event(
            r#"id="b" settedUpInitially="true" dropsOnFire="false""#,
            r#"<equals _1="${robot1.on}" _2="true"/>"#,
            r#"<setUp id="a"/>"#,
        ),
        event(
            r#"id="a" settedUpInitially="true""#,
            r#"<timer timeout="30"/>"#,
            "<success/>",
        ),
    ];
    let mut stage = Stage::new();
    stage.set("robot1", "on", Value::Bool(true));
    let mut run = Run::on(stage, &all.concat());
    assert_eq!(run.ticks(20), Verdict::Open);
    run.stage.set("robot1", "on", Value::Bool(false));
    assert_eq!(run.ticks(3), Verdict::Accomplished { after_ms: 230 });
}

#[test]
fn conditions_are_looked_at_in_order_and_no_further_than_needed() {
    let asks = r#"<equals _1="${robot1.on}" _2="true"/>"#;
    for (glue, first, asked) in [
        ("and", "<not><true/></not>", 0),
        ("or", "<true/>", 0),
        ("and", "<true/>", 2),
        ("or", "<not><true/></not>", 2),
    ] {
        let condition = format!(r#"<conditions glue="{glue}">{first}{asks}</conditions>"#);
        let mut stage = Stage::new();
        stage.set("robot1", "on", Value::Bool(false));
        let mut run = Run::on(
            stage,
            &event(
                r#"id="a" settedUpInitially="true" dropsOnFire="false""#,
                &condition,
                r#"<setter name="a" _1="1"/>"#,
            ),
        );
        run.ticks(2);
        assert_eq!(run.stage.asked, asked, "{glue} {first}");
    }
    assert!(holds(
        r#"<condition><not><not><true/></not></not></condition>"#
    ));
    assert!(holds(
        r#"<conditions glue="or"><not><true/></not><true/></conditions>"#
    ));
}

#[test]
fn using_does_something_in_each_check_and_then_asks() {
    let counts = event(
        r#"id="a" settedUpInitially="true""#,
        r#"<using><setter name="n"><sum><variableValue name="n"/><int value="1"/></sum></setter>
           <return><greater _1="${n}" _2="3"/></return></using>"#,
        "<success/>",
    );
    assert_eq!(
        Run::new(&counts).ticks(10),
        Verdict::Accomplished { after_ms: 40 }
    );
}

#[test]
fn inside_asks_for_the_centre_all_or_any_of_an_object() {
    for (x, center, all, any) in [
        (0, true, true, true),
        (80, true, false, true),
        (90, false, false, true),
        (200, false, false, false),
    ] {
        for (point, wanted) in [
            ("", center),
            (r#"objectPoint="center""#, center),
            (r#"objectPoint="all""#, all),
            (r#"objectPoint="any""#, any),
        ] {
            let mut stage = Stage::new();
            stage.region("zone", 0, 0, 100, 100);
            stage.place("robot1", x, 0, 40, 40);
            let condition = format!(r#"<inside objectId="robot1" regionId="zone" {point}/>"#);
            assert_eq!(holds_on(stage, &condition), (wanted, vec![]), "{x} {point}");
        }
    }
}

#[test]
fn a_region_or_object_that_is_not_there_or_none_is_told() {
    let mut stage = Stage::new();
    stage.region("zone", 0, 0, 400, 400);
    stage.add("robot1.shell", "Shell");
    let inside = |object: &str, region: &str| {
        event(
            r#"settedUpInitially="true" dropsOnFire="false""#,
            &format!(r#"<inside objectId="{object}" regionId="{region}"/>"#),
            r#"<fail message="no"/>"#,
        )
    };
    let all = [
        inside("ghost", "zone"),
        inside("robot1", "nowhere"),
        inside("robot1", "robot1"),
        inside("robot1.shell", "zone"),
    ];
    let mut run = Run::on(stage, &all.concat());
    assert_eq!(run.ticks(1), Verdict::Open);
    assert_eq!(
        run.told(),
        [
            "Error in checker: No such object: ghost",
            "Error in checker: No such region: nowhere",
            "Error in checker: robot1 is not a region",
            "Error in checker: robot1.shell has incorrect type for matching it with region",
        ]
    );
    assert!(
        run.entries
            .iter()
            .all(|entry| entry.level == Level::Critical)
    );
}

#[test]
fn errors_of_rules_are_told_in_each_pass_as_the_original_does() {
    let ghost = event(
        r#"settedUpInitially="true" dropsOnFire="false""#,
        r#"<inside objectId="ghost" regionId="zone"/>"#,
        "<success/>",
    );
    let mut checker = Checker::new(rules(&ghost), Locale::English);
    let (mut stage, mut entries) = (Stage::new(), Vec::new());
    for tick in 1..=5 {
        checker.check(tick * 10, &mut stage, &mut entries);
    }
    assert_eq!(entries.len(), 5);
}

#[test]
fn messages_are_filled_with_values_by_name_and_by_path() {
    let says = at_once(
        "a",
        r#"<setter name="n" _1="5"/>
        <message text="%a% and %b%, %c%: ${n}, ${robot1.name}, ${n">
          <replace var="b"><variableValue name="n"/></replace>
          <replace var="a" _1="2.50"/>
        </message>"#,
    );
    let mut stage = Stage::new();
    stage.set("robot1", "name", Value::text("Anna"));
    let mut run = Run::on(stage, &says);
    run.ticks(1);
    assert_eq!(run.told(), ["2.5 and 5, %c%: 5, Anna, ${n"]);
}

#[test]
fn a_state_of_an_object_can_be_set() {
    let mut stage = Stage::new();
    stage.add("robot1.random", "Random");
    stage.set("robot1.random", "fixedValue", Value::Int(0));
    let sets = at_once(
        "a",
        r#"<setState object="robot1.random" property="fixedValue"><int value="2"/></setState>
        <setState object="robot1.random" property="missing" _1="2"/>
        <setState object="robot1.random.fixedValue" property="x" _1="2"/>
        <setState object="ghost" property="x" _1="2"/>"#,
    );
    let mut run = Run::on(stage, &sets);
    run.ticks(1);
    assert_eq!(
        run.told(),
        [
            "Error in checker: Object QObject* has no property missing",
            "Error in checker: Invalid <setState> object type int",
            "Error in checker: No such object: ghost",
            "Error in checker: Invalid <setState> object type ",
        ]
    );
    let id = run.stage.id("robot1.random").unwrap();
    let value = &run.stage.properties[&(id, "fixedValue".to_owned())];
    assert_eq!(value.to_int(), 2);
}

#[test]
fn triggers_may_stand_in_triggers() {
    let nested = "<triggers><trigger><message text=\"a\"/></trigger><triggers><message text=\"b\"/></triggers></triggers>";
    let mut run = Run::new(&at_once("x", nested));
    run.ticks(1);
    assert_eq!(run.told(), ["a", "b"]);
}

#[test]
fn long_messages_in_each_tick_take_bounded_memory_and_the_verdict_is_told_all_the_same() {
    let long = "x".repeat(1 << 20);
    let again = r#"settedUpInitially="true" dropsOnFire="false""#;
    for deed in ["message", "log"] {
        let storm = event(
            &format!("id=\"a\" {again}"),
            "<true/>",
            &format!("<{deed} text=\"{long}\"/>"),
        );
        let mut run = Run::new(&storm);
        run.ticks(1000);
        let bytes: usize = run.entries.iter().map(|entry| entry.text.len()).sum();
        assert!(bytes <= limits::CONSTRAINT_ENTRIES_BYTES + 1000, "{bytes}");
        assert_eq!(
            run.entries.len(),
            (limits::CONSTRAINT_ENTRIES_BYTES >> 20) + 1
        );
        let last = run.entries.last().unwrap();
        assert!(last.text.contains("or 8 MiB of them"), "{}", last.text);
        assert_eq!(last.level, Level::Critical);
    }
}

#[test]
fn a_storm_of_messages_is_cut_off_and_the_verdict_is_told_all_the_same() {
    let storm = event(
        r#"id="a" settedUpInitially="true" dropsOnFire="false""#,
        "<true/>",
        &r#"<message text="again"/>"#.repeat(50),
    );
    let mut run = Run::new(&storm);
    run.ticks(1000);
    assert_eq!(run.entries.len(), limits::CONSTRAINT_ENTRIES_MAX + 1);
    let last = &run.entries[limits::CONSTRAINT_ENTRIES_MAX];
    assert_eq!(last.level, Level::Critical);
    assert!(
        last.text.starts_with("more than 10000 messages"),
        "{}",
        last.text
    );
    run.ends();
    let unfinished = "Program has finished, but the task is not accomplished.";
    assert_eq!(run.told().last(), Some(&unfinished));
}

#[test]
fn a_message_cannot_grow_without_limit() {
    let places = "%a%".repeat(1000);
    let long = "x".repeat(1000);
    let says = at_once(
        "a",
        &format!(
            r#"<message text="{places}"><replace var="a"><string value="{long}"/></replace></message>"#
        ),
    );
    let mut run = Run::new(&says);
    run.ticks(1);
    let told = run.told();
    assert!(
        told.iter()
            .all(|text| text.len() <= limits::CONSTRAINT_MESSAGE_BYTES)
    );
    assert!(told[0].contains("longer than 65536 bytes"), "{}", told[0]);
}

#[test]
fn one_reading_serves_many_runs() {
    let rules = rules(&at_once(
        "a",
        r#"<setter name="n"><sum _1="${n}" _2="1"/></setter><success/>"#,
    ));
    for _ in 0..3 {
        let mut checker = Checker::new(Rc::clone(&rules), Locale::English);
        let (mut stage, mut entries) = (Stage::new(), Vec::new());
        checker.check(10, &mut stage, &mut entries);
        assert_eq!(checker.variable("n").map(Value::to_int), Some(1));
        assert_eq!(checker.verdict(), Verdict::Accomplished { after_ms: 10 });
    }
}

#[test]
fn a_variable_of_the_dump_is_json_whatever_it_holds() {
    for (value, json) in [
        (r#"<string value="a&quot;\&#10;"/>"#, r#""a\"\\\n""#),
        (r#"<double value="1.5"/>"#, "1.5"),
        (r#"<bool value="true"/>"#, "true"),
        (r#"<objectState object="robot1"/>"#, "null"),
    ] {
        let sets = at_once(
            "a",
            &format!(r#"<setter name="total_score">{value}</setter><success/>"#),
        );
        let mut run = Run::new(&sets);
        run.ticks(1);
        let wanted = format!(r#"{{"variables":[{{"name":"total_score","value":{json}}}]}}"#);
        assert_eq!(run.entries[1].text, wanted);
    }
}
