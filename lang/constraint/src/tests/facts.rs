//! Every tag of the language against what is known of the original.
//!
//! The rows were written by hand: what a tag does or whether it holds. A tag that no row has fails a test.

use super::{Run, Stage, Value, holds_on};
use crate::expand::LANGUAGE;

/// Tags of conditions and of values in them, and whether they hold where the robot is in `zone` and `robot1.n` is 7.
const CONDITIONS: &[(&str, &str, bool)] = &[
    ("true", "<true/>", true),
    ("not", "<not><true/></not>", false),
    (
        "condition",
        "<condition><not><true/></not></condition>",
        false,
    ),
    (
        "conditions",
        r#"<conditions glue="or"><not><true/></not><true/></conditions>"#,
        true,
    ),
    (
        "conditions",
        r#"<conditions glue="and"><not><true/></not><true/></conditions>"#,
        false,
    ),
    ("equals", r#"<equals _1=" 7 " _2="7"/>"#, true),
    ("equals", r#"<equals _1="1e2" _2="100"/>"#, true),
    ("notequal", r#"<notEqual _1="7" _2="8"/>"#, true),
    ("greater", r#"<greater _1="7" _2="7"/>"#, false),
    ("less", r#"<less _1="7" _2="8"/>"#, true),
    ("notgreater", r#"<notGreater _1="7" _2="7"/>"#, true),
    ("notless", r#"<notLess _1="6" _2="7"/>"#, false),
    (
        "inside",
        r#"<inside objectId="robot1" regionId="zone"/>"#,
        true,
    ),
    (
        "inside",
        r#"<inside objectId="robot1" regionId="elsewhere"/>"#,
        false,
    ),
    ("settedup", r#"<settedUp id="a"/>"#, true),
    ("dropped", r#"<dropped id="a"/>"#, false),
    // 0 and less are over at the first check.
    ("timer", r#"<timer timeout="0"/>"#, true),
    ("timer", r#"<timer timeout="-5"/>"#, true),
    ("timer", r#"<timer timeout="1000"/>"#, false),
    (
        "using",
        r#"<using><setter name="v" _1="3"/><return><equals _1="${v}" _2="3"/></return></using>"#,
        true,
    ),
    (
        "return",
        r#"<using><setter name="v" _1="3"/><return><not><true/></not></return></using>"#,
        false,
    ),
    (
        "bool",
        r#"<equals><bool value="true"/><string value="yes"/></equals>"#,
        true,
    ),
    (
        "int",
        r#"<equals><int value="3"/><string value="3"/></equals>"#,
        true,
    ),
    (
        "double",
        r#"<less><double value="0.5"/><bool value="true"/></less>"#,
        true,
    ),
    (
        "string",
        r#"<less><string value="10"/><string value="9"/></less>"#,
        true,
    ),
    (
        "variablevalue",
        r#"<equals><variableValue name="five"/><int value="5"/></equals>"#,
        true,
    ),
    (
        "objectstate",
        r#"<equals><objectState object="robot1.n"/><int value="7"/></equals>"#,
        true,
    ),
    (
        "typeof",
        r#"<equals><typeOf objectId="robot2"/><string value="undefined"/></equals>"#,
        true,
    ),
    (
        "minus",
        r#"<equals><minus _1="7"/><int value="-7"/></equals>"#,
        true,
    ),
    (
        "abs",
        r#"<equals><abs _1="-7"/><int value="7"/></equals>"#,
        true,
    ),
    // Halves are rounded up (the recorded run a_arith has 2 for the size of -2.5), and a text with a point is 0.
    (
        "sum",
        r#"<equals><sum _1="2.5" _2="-2.5"/><int value="1"/></equals>"#,
        true,
    ),
    (
        "sum",
        r#"<equals><sum><string value="2.7"/><string value="abc"/></sum><int value="0"/></equals>"#,
        true,
    ),
    (
        "difference",
        r#"<equals><difference _1="7" _2="9"/><int value="-2"/></equals>"#,
        true,
    ),
    // Products wrap at 32 bits.
    (
        "mul",
        r#"<equals><mul _1="65536" _2="65536"/><int value="0"/></equals>"#,
        true,
    ),
    (
        "min",
        r#"<equals><min _1="7" _2="-9"/><int value="-9"/></equals>"#,
        true,
    ),
    (
        "max",
        r#"<equals><max _1="7" _2="-9"/><int value="7"/></equals>"#,
        true,
    ),
    (
        "distance",
        r#"<equals><distance _1="${robot1.at}" _2="${robot1.zero}"/><double value="5"/></equals>"#,
        true,
    ),
];

/// Tags that do something, and what is told in three ticks.
const TRIGGERS: &[(&str, &str, &[&str])] = &[
    (
        "trigger",
        "<trigger><message text=\"a\"/></trigger>",
        &["a"],
    ),
    (
        "triggers",
        "<triggers><message text=\"a\"/><message text=\"b\"/></triggers>",
        &["a", "b"],
    ),
    (
        "message",
        r#"<message text="n is ${robot1.n}"/>"#,
        &["n is 7"],
    ),
    (
        "replace",
        r#"<message text="%x%"><replace var="x" _1="1e2"/></message>"#,
        &["100"],
    ),
    ("log", r#"<log text="so"/>"#, &["so"]),
    (
        "setter",
        r#"<setter name="v" _1="abc"/><log text="${v}"/>"#,
        &["abc"],
    ),
    ("setup", r#"<setUp id="b"/>"#, &["b"]),
    ("drop", r#"<setUp id="b"/><drop id="b"/>"#, &[]),
    (
        "setstate",
        r#"<setState object="robot1" property="n" _1="9"/><log text="${robot1.n}"/>"#,
        &["9"],
    ),
    ("fail", r#"<fail message="no"/>"#, &["no"]),
    (
        "success",
        "<success/>",
        &["The task was accomplished in 0.01 sec!"],
    ),
    // Both are told, in the order in which they fire.
    (
        "success",
        r#"<fail message="no"/><success/>"#,
        &["no", "The task was accomplished in 0.01 sec!"],
    ),
];

/// Tags that stand outermost, and what is told in three ticks.
const OUTERMOST: &[(&str, &str, &[&str])] = &[
    (
        "timelimit",
        r#"<timelimit value="20"/>"#,
        &["Program worked for too long time"],
    ),
    ("timelimit", r#"<timelimit value="40"/>"#, &[]),
    (
        "event",
        r#"<event settedUpInitially="true"><condition><true/></condition><trigger><log text="a"/></trigger></event>"#,
        &["a"],
    ),
    (
        "event",
        r#"<event id="a"><condition><true/></condition><trigger><log text="a"/></trigger></event>"#,
        &[],
    ),
    (
        "constraint",
        r#"<constraint failMessage="no"><not><true/></not></constraint>"#,
        &["no"],
    ),
    ("init", r#"<init><log text="a"/></init>"#, &["a"]),
    (
        "initialization",
        r#"<initialization><log text="a"/></initialization>"#,
        &["a"],
    ),
];

pub(super) fn stage() -> Stage {
    let mut stage = Stage::new();
    stage.region("zone", 0, 0, 400, 400);
    stage.region("elsewhere", 900, 0, 40, 40);
    stage.set("robot1", "n", Value::Int(7));
    stage.set("robot1", "at", Value::Point(crate::Point { x: 3, y: 4 }));
    stage.set("robot1", "zero", Value::Point(crate::Point::default()));
    stage
}

#[test]
fn every_condition_and_value_is_what_it_is_in_the_original() {
    for (_, condition, wanted) in CONDITIONS {
        assert_eq!(
            holds_on(stage(), condition),
            (*wanted, Vec::new()),
            "{condition}"
        );
    }
}

#[test]
fn every_trigger_and_rule_does_what_it_does_in_the_original() {
    let in_event = TRIGGERS.iter().map(|(_, trigger, told)| {
        let rules = format!(
            r#"<event id="c" settedUpInitially="true"><condition><true/></condition><triggers>{trigger}</triggers></event>
            <event id="b"><condition><true/></condition><trigger><log text="b"/></trigger></event>"#
        );
        (rules, *told)
    });
    let outermost = OUTERMOST
        .iter()
        .map(|(_, rule, told)| ((*rule).to_owned(), *told));
    for (rules, told) in in_event.chain(outermost) {
        let mut run = Run::on(stage(), &rules);
        run.ticks(3);
        assert_eq!(run.told(), told, "{rules}");
    }
}

#[test]
fn no_tag_of_the_language_is_without_a_row() {
    let rows = CONDITIONS.iter().map(|(tag, text, _)| (*tag, *text));
    let rows = rows.chain(TRIGGERS.iter().map(|(tag, text, _)| (*tag, *text)));
    let rows: Vec<_> = rows
        .chain(OUTERMOST.iter().map(|(tag, text, _)| (*tag, *text)))
        .collect();
    for (tag, text) in &rows {
        assert!(
            text.to_lowercase().contains(&format!("<{tag}")),
            "{text} has no {tag}"
        );
        assert!(LANGUAGE.contains(tag), "{tag} is no tag of the language");
    }
    // What a rectangle is needs an object with a place: it is in the tests of values.
    let values = include_str!("values.rs").to_lowercase();
    for tag in LANGUAGE {
        let is_told = rows.iter().any(|(known, _)| *known == tag);
        assert!(
            is_told || values.contains(&format!("<{tag}>")),
            "nothing is told of <{tag}>"
        );
    }
}
