//! What is refused, in which words, and what is only warned of.

use super::{document, problems};
use crate::limits;

#[track_caller]
fn refused(inside: &str, words: &[&str]) {
    assert_eq!(problems(&document(inside)), words, "{inside}");
}

const EVENT: &str = "event (2)";

#[test]
fn the_root_and_the_time_limit_are_demanded() {
    let root = r#"Root element must be "constraints" tag"#;
    assert_eq!(problems("<rules/>"), [root]);
    let none = r#"There must be a "timelimit" constraint."#;
    assert_eq!(problems("<CONSTRAINTS/>"), [none]);
    let limit = r#"<timelimit value="5"/>"#;
    refused(
        &format!("{limit}{limit}"),
        &[r#"timelimit (2): There must be only one "timelimit" tag."#],
    );
    refused(
        "<timelimit/>",
        &[r#"timelimit (1): "timelimit" tag must have "value" attribute."#],
    );
    refused(
        r#"<timelimit value="soon"/>"#,
        &[r#"timelimit (1): Invalid integer value "soon""#],
    );
    refused(
        r#"<timelimit value="-1"/>"#,
        &["timelimit (1): the time limit is -1 ms: it must not be below 0"],
    );
    refused(
        r#"<TimeLimit value=" 100 "/>"#.replace("TimeLimit", "timelimit").as_str(),
        &[],
    );
}

#[test]
fn names_of_tags_may_be_written_in_any_case_and_names_of_attributes_not() {
    refused(
        r#"<EVENT id="a"><Condition><TRUE/></Condition><Trigger><SUCCESS/></Trigger></EVENT>"#,
        &[],
    );
    refused(
        r#"<event ID="a"><condition><true/></condition><trigger><success/></trigger></event>"#,
        &[r#"?event (2): the tag "event" knows no attribute "ID": did you mean "id"?"#],
    );
}

#[test]
fn an_unknown_tag_is_named_wherever_it_stands() {
    refused(
        "<evnt/>",
        &[r#"evnt (2): Unknown tag "evnt". Did you mean "event"?"#],
    );
    for (inside, tag, place) in [
        (
            "<condition><blue/></condition><trigger><success/></trigger>",
            "blue",
            "condition > blue",
        ),
        (
            "<condition><true/></condition><trigger><blue/></trigger>",
            "blue",
            "trigger > blue",
        ),
    ] {
        let words = format!(r#"{EVENT} > {place}: Unknown tag "{tag}"."#);
        refused(&format!("<event>{inside}</event>"), &[&words]);
    }
    refused(
        r#"<constraint failMessage="no"><equals><blue/><int value="1"/></equals></constraint>"#,
        &[r#"constraint (2) > equals > blue: Unknown value "blue"."#],
    );
}

#[test]
fn an_event_has_a_condition_and_a_trigger_in_whatever_order() {
    refused(
        "<event><trigger><success/></trigger><conditions glue=\"OR\"><true/><true/></conditions></event>",
        &[],
    );
    refused(
        "<event/>",
        &["event (2): event tag must have exactly 2 child tag(s)"],
    );
    refused(
        "<event><true/><trigger><success/></trigger></event>",
        &[
            r#"event (2): Event tag must have "condition" or "conditions" child tag. "trigger" found instead."#,
        ],
    );
    refused(
        "<event><condition><true/></condition><success/></event>",
        &[
            r#"event (2): Event tag must have "trigger" or "triggers" child tag. "success" found instead."#,
        ],
    );
}

#[test]
fn a_comment_counts_as_a_child_where_children_are_counted_and_nowhere_else() {
    refused(
        "<event><condition><!-- so --><true/></condition><trigger><success/></trigger></event>",
        &[
            "event (2) > condition: condition tag must have exactly 1 child tag(s)",
            "?event (2) > condition: a comment counts as a child of the tag condition: put it outside",
        ],
    );
    refused(
        "<event><condition>so<true/></condition><trigger><success/></trigger></event>",
        &[
            "event (2) > condition: condition tag must have exactly 1 child tag(s)",
            "?event (2) > condition: text stands in the tag condition: remove it, only tags mean something here",
        ],
    );
    refused(
        "<!-- a --><event><condition><true/></condition><triggers><!-- b --><success/></triggers></event>",
        &[],
    );
}

fn in_event(condition: &str, trigger: &str) -> String {
    format!("<event><condition>{condition}</condition><trigger>{trigger}</trigger></event>")
}

/// Conditions, and what is said of them.
const CONDITIONS: &[(&str, &str)] = &[
    (
        r#"<timer/>"#,
        r#"timer: "timer" tag must have "timeout" attribute."#,
    ),
    (
        r#"<timer timeout=""/>"#,
        r#"timer: Attribute "timer" of the tag "timeout" must not be empty."#,
    ),
    (
        r#"<timer timeout="1.5"/>"#,
        r#"timer: Invalid integer value "1.5""#,
    ),
    (
        r#"<timer timeout="1" forceDropOnTimeout="yes"/>"#,
        r#"timer: Invalid boolean value "yes" (expected "true" or "false")"#,
    ),
    (
        r#"<inside regionId="a"/>"#,
        r#"inside: "inside" tag must have "objectId" attribute."#,
    ),
    (
        r#"<inside objectId="a"/>"#,
        r#"inside: "inside" tag must have "regionId" attribute."#,
    ),
    (
        r#"<settedUp/>"#,
        r#"settedUp: "settedUp" tag must have "id" attribute."#,
    ),
    (
        r#"<dropped id=""/>"#,
        r#"dropped: Attribute "dropped" of the tag "id" must not be empty."#,
    ),
    (
        r#"<equals/>"#,
        "equals: equals tag must have exactly 2 child tag(s)",
    ),
    (
        r#"<equals><int value="1"/></equals>"#,
        "equals: equals tag must have exactly 2 child tag(s)",
    ),
    (r#"<not/>"#, "not: not tag must have exactly 1 child tag(s)"),
    (
        r#"<conditions glue="xor"><true/><true/></conditions>"#,
        r#"conditions: "Glue" attribute must have value "and" or "or"."#,
    ),
    (
        r#"<conditions><true/><true/></conditions>"#,
        r#"conditions: "conditions" tag must have "glue" attribute."#,
    ),
    (
        r#"<conditions glue="and"/>"#,
        "conditions: conditions tag must have at least 1 child tag(s)",
    ),
    (
        r#"<using><return><true/></return></using>"#,
        "using: using tag must have at least 2 child tag(s)",
    ),
    (
        r#"<using><success/><success/></using>"#,
        r#"using: There must be "return" tag in "using" expression."#,
    ),
    (
        r#"<using><return><true/></return><return><true/></return></using>"#,
        r#"using: There must be only one tag "return" in "using" expression."#,
    ),
];

/// Values, and what is said of them.
const VALUES: &[(&str, &str)] = &[
    (r#"<bool/>"#, r#""bool" tag must have "value" attribute."#),
    (
        r#"<bool value="1"/>"#,
        r#"Invalid boolean value "1" (expected "true" or "false")"#,
    ),
    (r#"<int value="x"/>"#, r#"Invalid integer value "x""#),
    (
        r#"<double value="1e999"/>"#,
        r#"Invalid floating point value "1e999""#,
    ),
    (
        r#"<double value="nan"/>"#,
        r#"Invalid floating point value "nan""#,
    ),
    (
        r#"<string/>"#,
        r#""string" tag must have "value" attribute."#,
    ),
    (
        r#"<variableValue/>"#,
        r#""variableValue" tag must have "name" attribute."#,
    ),
    (
        r#"<objectState/>"#,
        r#""objectState" tag must have "object" attribute."#,
    ),
    (
        r#"<typeOf/>"#,
        r#""typeOf" tag must have "objectId" attribute."#,
    ),
    (r#"<abs/>"#, "abs tag must have exactly 1 child tag(s)"),
];

/// Triggers, and what is said of them.
const TRIGGERS: &[(&str, &str)] = &[
    (r#"<fail/>"#, r#""fail" tag must have "message" attribute."#),
    (
        r#"<fail message=""/>"#,
        r#"Attribute "fail" of the tag "message" must not be empty."#,
    ),
    (
        r#"<success deferred="maybe"/>"#,
        r#"Invalid boolean value "maybe" (expected "true" or "false")"#,
    ),
    (
        r#"<message/>"#,
        r#""message" tag must have "text" attribute."#,
    ),
    (r#"<log/>"#, r#""log" tag must have "text" attribute."#),
    (
        r#"<setter _1="2"/>"#,
        r#""setter" tag must have "name" attribute."#,
    ),
    (
        r#"<setter name="a"/>"#,
        "setter tag must have exactly 1 child tag(s)",
    ),
    (r#"<setUp/>"#, r#""setUp" tag must have "id" attribute."#),
    (r#"<drop/>"#, r#""drop" tag must have "id" attribute."#),
    (
        r#"<setState property="a" _1="1"/>"#,
        r#""setState" tag must have "object" attribute."#,
    ),
    (
        r#"<setState object="a" _1="1"/>"#,
        r#""setState" tag must have "property" attribute."#,
    ),
];

#[test]
fn too_few_attributes_for_values_are_told_twice_and_nothing_but_dots_is_warned_of() {
    for count in [1, 3] {
        let written: String = (1..=count).map(|at| format!(" _{at}=\"1\"")).collect();
        let place = format!("{EVENT} > condition > equals: ");
        let first = format!(
            "{place}When using the extended form for the equals tag, the number of arguments starting with _ must \
             be 2, {count} was provided"
        );
        let second = format!("{place}equals tag must have exactly 2 child tag(s)");
        let condition = format!("<equals{written}/>");
        refused(&in_event(&condition, "<success/>"), &[&first, &second]);
    }
    let path = r#"<less><objectState object=".."/><int value="1"/></less>"#;
    refused(
        &in_event(path, "<success/>"),
        &["?event (2) > condition > less > objectState: Object path is empty!"],
    );
}

#[test]
fn attributes_are_demanded_and_must_be_what_they_are() {
    for (condition, words) in CONDITIONS {
        let words = format!("{EVENT} > condition > {words}");
        refused(&in_event(condition, "<success/>"), &[&words]);
    }
    for (value, words) in VALUES {
        let condition = format!("<less>{value}<int value=\"1\"/></less>");
        let tag = value[1..].split(['/', ' ']).next().unwrap_or_default();
        let words = format!("{EVENT} > condition > less > {tag}: {words}");
        refused(&in_event(&condition, "<success/>"), &[&words]);
    }
    for (trigger, words) in TRIGGERS {
        let tag = trigger[1..].split(['/', ' ']).next().unwrap_or_default();
        let words = format!("{EVENT} > trigger > {tag}: {words}");
        refused(&in_event("<true/>", trigger), &[&words]);
    }
}

#[test]
fn a_constraint_says_what_it_says_when_it_fails() {
    refused(
        "<constraint><true/></constraint>",
        &[r#"constraint (2): "constraint" tag must have "failMessage" attribute."#],
    );
    refused(
        r#"<constraint failMessage=""><true/></constraint>"#,
        &[r#"constraint (2): Attribute "constraint" of the tag "failMessage" must not be empty."#],
    );
    refused(
        r#"<constraint failMessage="a"/>"#,
        &["constraint (2): constraint tag must have exactly 1 child tag(s)"],
    );
}

#[test]
fn ids_stand_once() {
    let event =
        "<event id=\"a\"><condition><true/></condition><trigger><success/></trigger></event>";
    refused(
        &format!("{event}{event}"),
        &[r#"Duplicate id: "a". A rule before has this id too: give one of them another id"#],
    );
    let nameless = event.replace(" id=\"a\"", "");
    refused(&format!("{nameless}{nameless}"), &[]);
    let init = r#"<init><setter name="a" _1="1"/></init>"#;
    refused(&format!("{init}{init}"), &[r#"init (3): Duplicate id: """#]);
}

#[test]
fn what_is_perhaps_not_meant_is_warned_of() {
    refused(
        r#"<event id="a" dropOnFire="false"><condition><true/></condition><trigger><success/></trigger></event>"#,
        &[
            r#"?event 'a': the tag "event" knows no attribute "dropOnFire": did you mean "dropsOnFire"?"#,
        ],
    );
    refused(
        r#"<event><condition><settedUp id="ghost"/></condition><trigger><drop id="ghost"/></trigger></event>"#,
        &[
            "?event (2) > trigger > drop: No such event: ghost",
            "?event (2) > condition > settedUp: No such event: ghost",
        ],
    );
    refused(
        r#"<constraint failMessage="a" checkOnce="yes"><inside objectId="r" regionId="s" objectPoint="centre"/></constraint>"#,
        &[
            r#"?constraint (2) > inside: objectPoint="centre" is unknown, and "center" is taken; write "center", "all" or "any""#,
            r#"?constraint (2): checkOnce is "yes", and is taken for "false""#,
        ],
    );
    refused(
        r#"<constraint failMessage="a"><conditions glue="and"><true/></conditions></constraint>"#,
        &[
            r#"?constraint (2) > conditions: there is one condition in "conditions": write "condition", or was something forgotten?"#,
        ],
    );
}

#[test]
fn nothing_grows_without_limit() {
    let deep = limits::CONSTRAINT_DEPTH_MAX - 10;
    let nested = |depth: usize| {
        format!(
            r#"<constraint failMessage="a">{}<true/>{}</constraint>"#,
            "<not>".repeat(depth),
            "</not>".repeat(depth)
        )
    };
    assert_eq!(problems(&document(&nested(deep))), [""; 0]);
    let one = r#"<constraint failMessage="a"><true/></constraint>"#;
    let many = one.repeat(limits::CONSTRAINT_EVENTS_MAX);
    assert_eq!(
        problems(&document(&many)),
        ["more than 10000 events and constraints"]
    );
    let most = one.repeat(limits::CONSTRAINT_EVENTS_MAX - 1);
    assert_eq!(problems(&document(&most)), [""; 0]);
}
