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
    let (constraints, templates) = (xml::parse(&text).unwrap(), xml::parse(SAY).unwrap());
    assert!(read_with_templates(&constraints, Some(&templates)).is_ok());
    assert!(read_with_templates(&constraints, None).is_err());
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
fn refused(inside: &str, words: &str) {
    let told = problems(&document(inside));
    assert_eq!(told, [words], "{inside}");
}

#[test]
fn what_is_wrong_with_a_use_is_told_with_its_chain() {
    let in_say = |usage: &str| format!("{SAY}{usage}");
    refused(
        &in_say("<use/>"),
        "use '': The <use> tag must contain a \"template\" attribute",
    );
    refused(
        &in_say(r#"<use template="shout"/>"#),
        "use 'shout': The <use> tag contains a template=shout attribute that is not the name of a declared template",
    );
    refused(
        &in_say(r#"<say/>"#),
        "say 'say': The parameter text of template say has no default value and was not explicitly specified by the user",
    );
    refused(
        &in_say(r#"<say text="a" loud="true"/>"#),
        "say 'say': The using an undeclared parameter loud for template say",
    );
    refused(
        &in_say(r#"<say text="a"><message/></say>"#),
        "say 'say': The <use> tag can only contain a child tag <with>",
    );
    refused(
        &in_say(r#"<say text="a &lt; b"/>"#),
        "template 'say': After substituting the parameters for the template say, it did not become a valid xml node: \
         2:76 '<' cannot stand in the value of 'text': write &lt; Substitution chain: say.",
    );
    let recursive = r#"<templates>
      <template name="a"><content><![CDATA[<b/>]]></content></template>
      <template name="b"><content><![CDATA[<a/>]]></content></template></templates><a/>"#;
    refused(
        recursive,
        "a 'a': Recursive template expansion detected: a -> b -> a Substitution chain: a -> b.",
    );
}

#[test]
fn what_is_wrong_with_a_declaration_is_told() {
    let declare = |inside: &str| format!("<templates>{inside}</templates>");
    for (inside, words) in [
        (
            "<pattern/>",
            "templates: the <templates> tag can only contain the <template> tag as a child tag, actual pattern",
        ),
        (
            "<template/>",
            "templates: The <template> tag was provided, but the required \"name\" attribute was missing.",
        ),
        (
            r#"<template name="robot-start"><content>a</content></template>"#,
            "template 'robot-start': Redefinition a template robot-start that already exists",
        ),
        (
            r#"<template name="a"><params><parameter/></params></template>"#,
            "template 'a': the <params> tag can only contain the <param> tag as a child tag for template a, actual tag is <parameter>",
        ),
        (
            r#"<template name="a"><params><param/></params></template>"#,
            "template 'a': The <param> tag of template a was provided, but the required \"name\" attribute was missing.",
        ),
        (
            r#"<template name="a"/>"#,
            "template 'a': The <template> of template a tag was provided, but the required child tag <content> was missing",
        ),
        (
            r##"<template name="a"><content><![CDATA[<message text="#{b}"/>]]></content></template>"##,
            "template 'a': When defining the template a, the syntax #{b} was used for an undeclared parameter b.",
        ),
    ] {
        refused(&declare(inside), words);
    }
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
        told[0].contains("more than 100000 tags"),
        "{:?}",
        &told[..1]
    );

    let doubles = r##"<templates><template name="d">
        <params><param name="a"/><param name="b" default="#{a}#{a}#{a}#{a}#{a}#{a}#{a}#{a}"/><param name="c" default="#{b}#{b}#{b}#{b}#{b}#{b}#{b}#{b}"/>
        <param name="d" default="#{c}#{c}#{c}#{c}#{c}#{c}#{c}#{c}"/></params>
        <content><![CDATA[<message text="#{d}#{d}#{d}#{d}"/>]]></content></template></templates>"##;
    let usage = format!(r#"<d a="{}"/>"#, "x".repeat(10_000));
    let told = problems(&document(&format!("{doubles}{usage}")));
    assert_eq!(
        told,
        ["d 'd': templates have grown to more than 4194304 bytes"]
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
