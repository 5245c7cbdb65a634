//! Templates: declared, put in, refused; and those of the library.

use super::{Run, Stage, Value, Verdict, document, problems};
use crate::read_with_templates;
use lang_text::xml;

/// A template that says a text.
const SAY: &str = r##"<templates><template name="say">
  <params><param name="text"/><param name="when"><true/></param></params>
  <content><![CDATA[
    <event settedUpInitially="true"><condition>#{when}</condition><trigger><message text="#{text}"/></trigger></event>
  ]]></content>
</template></templates>"##;

fn said(inside: &str) -> Vec<String> {
    let mut run = Run::new(inside);
    run.ticks(1);
    run.told().into_iter().map(str::to_owned).collect()
}

#[test]
fn a_template_is_put_in_by_use_by_its_name_and_by_its_prefix() {
    for usage in [
        r#"<use template="say" text="hello"/>"#,
        r#"<use template="say"><with text="hello"/></use>"#,
        r#"<use template="say"><with param="text">hello</with></use>"#,
        r#"<say text="hello"/>"#,
        r#"<u:say text="hello"/>"#,
        r#"<use template="u:say" text="hello"/>"#,
        r#"<say text="hello"><with param="when"><not><not><true/></not></not></with></say>"#,
    ] {
        assert_eq!(said(&format!("{SAY}{usage}")), ["hello"], "{usage}");
    }
    let never = r#"<say text="hello"><with param="when"><not><true/></not></with></say>"#;
    assert_eq!(said(&format!("{SAY}{never}")), [""; 0]);
}

#[test]
fn templates_may_stand_outside_of_the_constraints() {
    let text = document(r#"<say text="hello"/>"#);
    let constraints = xml::parse(&text).unwrap();
    assert!(read_with_templates(&constraints, &[SAY]).is_ok());
    assert!(read_with_templates(&constraints, &[]).is_err());
}

#[test]
fn a_parameter_may_mention_those_before_it() {
    let templates = r##"<templates><template name="t">
      <params><param name="who"/><param name="text" default="hello, #{who}"/></params>
      <content><![CDATA[<say text="#{text}"/>]]></content></template></templates>"##;
    let all = format!("{SAY}{templates}<t who=\"you\"/><t who=\"all\" text=\"#{{who}}!\"/>");
    assert_eq!(said(&all), ["hello, you", "all!"]);
}

#[track_caller]
fn refused(inside: &str, words: &[&str]) {
    let told = problems(&document(inside));
    assert_eq!(told, words, "{inside}");
}

/// The text of an error in a use that stands in a line of the constraints.
fn in_use(place: &str, words: &str, line: usize) -> String {
    format!(
        "{place}: Error while template substitution: {words} line {line} relative the beginning of the \
         &lt;constraints&gt; tag"
    )
}

#[test]
fn what_is_wrong_with_a_use_is_told_with_its_line() {
    for (usage, place, words) in [
        (
            "<use/>",
            "use ''",
            "The &lt;use&gt; tag must contain a \"template\" attribute",
        ),
        (
            r#"<use template="shout"/>"#,
            "use 'shout'",
            "The &lt;use&gt; tag contains a template=shout attribute that is not the name of a declared template",
        ),
        (
            r#"<say/>"#,
            "say 'say'",
            "The parameter text of template say has no default value and was not explicitly specified by the user",
        ),
        (
            r#"<say text="a" loud="true"/>"#,
            "say 'say'",
            "The using an undeclared parameter loud for template say",
        ),
        (
            r#"<say text="a"><message/></say>"#,
            "say 'say'",
            "The &lt;use&gt; tag can only contain a child tag &lt;with&gt;",
        ),
    ] {
        let told = problems(&document(&format!("{SAY}{usage}")));
        // The declaration takes lines too, each tag one and each line of a text.
        assert_eq!(told, [in_use(place, words, 16)], "{usage}");
    }
}

#[test]
fn a_body_that_is_no_xml_and_a_template_in_itself_are_told() {
    let told = problems(&document(&format!(r#"{SAY}<say text="a &lt; b"/>"#)));
    let words = "After substituting the parameters for the template say, it did not become a valid xml node error \
                 occurred while parsing element";
    assert_eq!(told[0], in_use("template 'say'", words, 16));
    assert!(
        told[1].starts_with("?template 'say': 2:76 '<' cannot stand"),
        "{told:?}"
    );
    let recursive = r#"<templates>
      <template name="a"><content><![CDATA[<b/>]]></content></template>
      <template name="b"><content><![CDATA[<a/>]]></content></template></templates><a/>"#;
    refused(
        recursive,
        &[
            "a 'a': Error while template substitution: Recursive template expansion detected: a -> b -> a line 1 \
             relative to the beginning of the b template body",
            "a 'a': Error while template substitution: Substitution chain: a -> b.",
        ],
    );
}

#[test]
fn what_is_wrong_with_a_declaration_is_told() {
    let declare = |inside: &str| format!("<templates>{inside}</templates>");
    for (inside, words) in [
        (
            "<pattern/>",
            "templates: Error while parsing template: the &lt;templates&gt; tag can only contain the &lt;template&gt; \
             tag as a child tag, actual pattern line 1",
        ),
        (
            "<template/>",
            "templates: Error while parsing template: The &lt;template&gt; tag was provided, but the required \"name\" \
             attribute was missing. line 1",
        ),
        (
            r#"<template name="a"><params><parameter/></params></template>"#,
            "template 'a': Error while parsing template: the &lt;params&gt; tag can only contain the &lt;param&gt; tag \
             as a child tag for template a, actual tag is &lt;parameter&gt; line 1 template a",
        ),
        (
            r#"<template name="a"><params><param/></params></template>"#,
            "template 'a': Error while parsing template: The &lt;param&gt; tag of template a was provided, but the \
             required \"name\" attribute was missing. line 1 template a",
        ),
        (
            r#"<template name="a"/>"#,
            "template 'a': Error while parsing template: The &lt;template&gt; of template a tag was provided, but the \
             required child tag &lt;content&gt; was missing line 1 template a",
        ),
        (
            r##"<template name="a"><content><![CDATA[<message text="#{b}"/>]]></content></template>"##,
            "template 'a': Error while parsing template: When defining the template a, the syntax #{b} was used to \
             substitute an offset 15 for an undeclared parameter b. line 1 template a",
        ),
    ] {
        refused(&declare(inside), &[words]);
    }
}

/// What is wrong with templates of a save although the rules are read.
fn faults(file: &str) -> Vec<String> {
    let text = document("");
    let constraints = xml::parse(&text).unwrap();
    let rules = read_with_templates(&constraints, &[file]).expect("the rules are right");
    rules.faults().iter().map(ToString::to_string).collect()
}

#[test]
fn what_is_wrong_with_a_template_of_a_save_keeps_nothing_else_from_working() {
    let double = "<templates>\n<template name=\"a\"><content><![CDATA[<true/>]]></content></template>\n\
                  <template name=\"a\"><content><![CDATA[<true/>]]></content></template></templates>";
    assert_eq!(
        faults(double),
        [
            "template 'a': Error while parsing template: Redefinition a template a that already exists line 3"
        ]
    );
    let tags = r#"<templates><template name="a"><content><true/></content></template></templates>"#;
    assert_eq!(
        faults(tags),
        [
            "template 'a': Error while parsing template: Currently, this method of setting &lt;content&gt; tag for the \
          template a is not supported. line 1 template a"
        ]
    );
    assert_eq!(
        faults("<templates><template>"),
        ["1:22: unexpected end of file"]
    );
}

#[test]
fn with_prefixes_names_have_spaces_of_their_own_and_stand_for_nothing_without_one() {
    let mine = r##"<templates><template name="robot-start"><params><param name="id"/></params>
      <content><![CDATA[<event id="#{id}" settedUpInitially="true"><condition><true/></condition>
      <trigger><message text="mine"/></trigger></event>]]></content></template></templates>"##;
    let read = |inside: &str| {
        let text = document(inside);
        let constraints = xml::parse(&text).unwrap();
        read_with_templates(&constraints, &[mine]).map(|rules| rules.events())
    };
    // Both are there: the time limit and one event each.
    assert_eq!(read(r#"<u:robot-start id="a"/>"#).ok(), Some(2));
    let system =
        r#"<ts:robot-start id="b"><with param="trigger"><success/></with></ts:robot-start>"#;
    assert_eq!(
        read(&format!(r#"{system}<u:robot-start id="a"/>"#)).ok(),
        Some(3)
    );
    assert!(read(&format!(r#"{system}<robot-start id="a"/>"#)).is_err());
    assert!(read(&format!(r#"{system}<use template="robot-start" id="a"/>"#)).is_err());
    // The last use that is wrong is the only one that is told.
    let told = problems(&document("<ts:robot-start/><ts:no-such/>"));
    let words = "The &lt;use&gt; tag contains a template=ts:no-such attribute that is not the name of a declared template";
    assert_eq!(told, [in_use("ts:no-such 'ts:no-such'", words, 4)]);
}

/// A robot whose motors have these powers.
fn powered(left: i32, right: i32) -> Stage {
    let mut stage = driving(left != 0 || right != 0);
    for (name, power) in [("robot1.left", left), ("robot1.right", right)] {
        stage.add(name, "twoDModel::robotModel::parts::Motor");
        stage.set(name, "power", Value::Int(power));
    }
    stage
}

fn present(stage: Stage, inside: &str) -> (Verdict, Vec<String>) {
    let mut run = Run::on(stage, inside);
    let verdict = run.ticks(3);
    (verdict, run.told().into_iter().map(str::to_owned).collect())
}

const DONE: Verdict = Verdict::Accomplished { after_ms: 10 };

#[test]
fn events_timers_and_zones_of_the_present_library_do_what_they_say() {
    let stands = || powered(0, 0);
    // Not set up by itself, and done at once if it is.
    assert_eq!(present(stands(), "<ts:condition-event/>").0, Verdict::Open);
    assert_eq!(
        present(stands(), r#"<ts:condition-event settedUpInit="true"/>"#).0,
        DONE
    );
    let timer = r#"<ts:timer-success-event timeout="20"><with param="trigger"><log text="so"/></with></ts:timer-success-event>"#;
    let (verdict, told) = present(stands(), timer);
    assert_eq!(verdict, Verdict::Accomplished { after_ms: 20 });
    assert_eq!(told[0], "so");
    for name in ["set-object-warzone", "set-robot-warzone"] {
        let zone = |region: &str| format!(r#"<ts:{name} regionId="{region}" message="left"/>"#);
        assert_eq!(present(stands(), &zone("zone")).0, Verdict::Open, "{name}");
        let (verdict, told) = present(stands(), &zone("elsewhere"));
        assert_eq!((verdict, &*told[0]), (DONE, "left"), "{name}");
        // The message has a default, which no message may be.
        let told = problems(&document(&format!(r#"<ts:{name} regionId="zone"/>"#)));
        assert!(told[0].ends_with(r#"Attribute "message" of the tag "text" must not be empty."#));
    }
    for (condition, holds) in [
        (r#"<ts:is-undefined name="robot1.A1"/>"#, true),
        (r#"<ts:is-undefined name="robot1"/>"#, false),
        (
            r#"<ts:typeof name="robot1" type="twoDModel::model::RobotModel"/>"#,
            true,
        ),
    ] {
        let rule = format!(r#"<constraint failMessage="no">{condition}</constraint>"#);
        let is_open = present(stands(), &rule).0 == Verdict::Open;
        assert_eq!(is_open, holds, "{condition}");
    }
}

#[test]
fn scores_of_the_present_library_are_counted() {
    let set_up = r#"id="x" settedUpInit="true" value="4" message="got ${total_score}""#;
    let change = format!(
        r#"<ts:change-score-with-log {set_up} operation="difference"><with param="conditions"><condition><true/></condition></with></ts:change-score-with-log>"#
    );
    assert_eq!(present(powered(0, 0), &change).1, ["got -4"]);
    for (name, stage, more, wanted) in [
        (
            "object-region-with-score",
            powered(0, 0),
            r#"regionId="zone""#,
            true,
        ),
        (
            "object-region-with-score",
            powered(0, 0),
            r#"regionId="elsewhere""#,
            false,
        ),
        (
            "object-region-with-score",
            powered(0, 0),
            r#"regionId="elsewhere" not="not""#,
            true,
        ),
        (
            "robot-stop-in-region-with-score",
            powered(0, 0),
            r#"regionId="zone""#,
            true,
        ),
        (
            "robot-stop-in-region-with-score",
            powered(0, 5),
            r#"regionId="zone""#,
            false,
        ),
        ("robot-start-with-score", powered(0, 5), "", true),
        ("robot-start-with-score", powered(0, 0), "", false),
    ] {
        let (verdict, told) = present(stage, &format!("<ts:{name} {set_up} {more}/>"));
        let wanted = if wanted {
            vec!["got 4".to_owned()]
        } else {
            Vec::new()
        };
        assert_eq!((verdict, told), (Verdict::Open, wanted), "{name} {more}");
    }
    let finish = format!(r#"<ts:robot-finish-in-region-with-score {set_up} regionId="zone"/>"#);
    assert_eq!(present(powered(0, 0), &finish).0, DONE);
}

#[test]
fn the_present_library_looks_at_motors_for_start_and_stop() {
    let go = r#"<with param="trigger"><message text="so"/></with>"#;
    let start = format!(r#"<ts:robot-start id="a">{go}</ts:robot-start>"#);
    assert_eq!(present(powered(0, 0), &start).1, [""; 0]);
    assert_eq!(present(powered(0, -5), &start).1, ["so"]);
    let stop = format!(r#"<ts:robot-stop id="a" settedUpInit="true">{go}</ts:robot-stop>"#);
    assert_eq!(present(powered(5, 0), &stop).1, [""; 0]);
    assert_eq!(present(powered(0, 0), &stop).1, ["so"]);
    // Without a trigger there is nothing to be done.
    let told = problems(&document(r#"<ts:robot-start id="a"/>"#));
    assert!(
        told[0].contains("triggers tag must have at least 1 child tag(s)"),
        "{told:?}"
    );
}

#[test]
fn templates_that_grow_without_end_are_stopped() {
    let mut templates = String::from("<templates>");
    for level in 0..30 {
        templates.push_str(&format!(
            r#"<template name="t{level}"><content><![CDATA[<t{0}/><t{0}/>]]></content></template>"#,
            level + 1
        ));
    }
    templates.push_str(
        r#"<template name="t30"><content><![CDATA[<constraint failMessage="a"><true/></constraint>]]></content></template></templates>"#,
    );
    let told = problems(&document(&format!("{templates}<t0/>")));
    assert!(
        told.iter().any(|one| one.contains("more than 100000 tags")),
        "{:?}",
        &told[..1]
    );

    let doubles = r##"<templates><template name="d">
        <params><param name="a"/><param name="b" default="#{a}#{a}#{a}#{a}#{a}#{a}#{a}#{a}"/><param name="c" default="#{b}#{b}#{b}#{b}#{b}#{b}#{b}#{b}"/>
        <param name="d" default="#{c}#{c}#{c}#{c}#{c}#{c}#{c}#{c}"/></params>
        <content><![CDATA[<message text="#{d}#{d}#{d}#{d}"/>]]></content></template></templates>"##;
    let usage = format!(r#"<d a="{}"/>"#, "x".repeat(10_000));
    let told = problems(&document(&format!("{doubles}{usage}")));
    assert!(
        told[0].contains("templates have grown to more than 4194304 bytes"),
        "{told:?}"
    );
}

fn driving(riding: bool) -> Stage {
    let mut stage = Stage::new();
    stage.region("zone", 0, 0, 400, 400);
    stage.region("elsewhere", 900, 0, 40, 40);
    stage.set("robot1", "isRiding", Value::Bool(riding));
    stage
}

fn ten(inside: &str, riding: bool) -> (Verdict, Vec<String>) {
    let all = format!(r#"<init><setter name="ten" _1="10"/></init>{inside}"#);
    // The score is added in the second pass, because `init` comes last in the first.
    let wait = r#"<event id="~" settedUpInitially="true"><condition><timer timeout="20"/></condition><trigger><setUp id="x"/></trigger></event>"#;
    let mut run = Run::on(driving(riding), &format!("{all}{wait}"));
    let verdict = run.ticks(5);
    (verdict, run.told().into_iter().map(str::to_owned).collect())
}

#[test]
fn the_library_scores_robots_that_stop_finish_and_start() {
    let use_it = |name: &str, region: &str| {
        format!(r#"<{name} id="x" settedUpInit="false" variable="ten" {region}/>"#)
    };
    let here = r#"regionId="zone""#;
    let there = r#"regionId="elsewhere""#;
    let scored = "Points scored: 10".to_owned();
    for name in [
        "object-in-region-with-score",
        "object-region-with-score",
        "robot-stop-in-region-with-score",
    ] {
        let (verdict, told) = ten(&use_it(name, here), false);
        assert_eq!(
            (verdict, &told),
            (Verdict::Open, &vec![scored.clone()]),
            "{name}"
        );
        assert_eq!(ten(&use_it(name, there), false).1, [""; 0], "{name}");
    }
    assert_eq!(
        ten(&use_it("robot-stop-in-region-with-score", here), true).1,
        [""; 0]
    );
    let left = use_it("object-left-region-with-score", there);
    assert_eq!(ten(&left, true).1, ["Points scored: 10"]);
    let (verdict, told) = ten(&use_it("robot-finish-in-region-with-score", here), false);
    assert_eq!(verdict, Verdict::Accomplished { after_ms: 30 });
    assert_eq!(
        told,
        [
            scored.clone(),
            "The task was accomplished in 0.03 sec!".to_owned()
        ]
    );
    assert_eq!(ten(&use_it("robot-start-with-score", ""), true).1, [scored]);
    assert_eq!(ten(&use_it("robot-start-with-score", ""), false).1, [""; 0]);
}

#[test]
fn the_library_watches_zones_timers_starts_and_types() {
    let first = |inside: &str| {
        let mut run = Run::on(driving(false), inside);
        let verdict = run.ticks(3);
        (
            verdict,
            run.told()
                .into_iter()
                .map(str::to_owned)
                .collect::<Vec<_>>(),
        )
    };
    assert_eq!(first(r#"<robot-start regionId="zone"/>"#).0, Verdict::Open);
    let (verdict, told) = first(r#"<robot-start regionId="elsewhere" message="not here"/>"#);
    assert_eq!(
        (verdict, told),
        (
            Verdict::Failed { after_ms: 10 },
            vec!["not here".to_owned()]
        )
    );
    assert_eq!(
        first(r#"<robot-stop regionId="zone"/>"#).0,
        Verdict::Accomplished { after_ms: 10 }
    );
    assert_eq!(
        first(r#"<set-robot-warzone regionId="zone"/>"#).0,
        Verdict::Open
    );
    let (_, told) = first(r#"<set-robot-warzone regionId="elsewhere"/>"#);
    let out = "The robot has moved out of a valid region";
    assert_eq!(told, [out, "The task was accomplished in 0.01 sec!"]);
    let (verdict, _) = first(r#"<timer-success-event timeout="20"/>"#);
    assert_eq!(verdict, Verdict::Accomplished { after_ms: 20 });
    for (condition, holds) in [
        (r#"<is-undefined objectId="robot1.A1"/>"#, true),
        (r#"<is-undefined objectId="robot1"/>"#, false),
        (
            r#"<use template="typeof" objectId="robot1" type="twoDModel::model::RobotModel"/>"#,
            true,
        ),
    ] {
        let (verdict, _) = first(&format!(
            r#"<constraint failMessage="no">{condition}</constraint>"#
        ));
        assert_eq!(verdict == Verdict::Open, holds, "{condition}");
    }
    let (verdict, told) = first(
        r#"<condition-event id="a"><with param="trigger"><message text="so"/></with></condition-event>"#,
    );
    assert_eq!((verdict, told), (Verdict::Open, vec!["so".to_owned()]));
}
