//! Templates of a save, `u:`, and what becomes of each use, tag by tag.
//!
//! Every name of the library may be declared by a save as well; what is said of names, parameters, bodies and mistakes
//! holds for those of the library too.

use super::document;
use super::library::{TEMPLATES, Template, bare, parsed, used, value_of};
use crate::expand::expand;
use crate::read_with_templates;
use lang_text::xml;

/// A text of a save with one template.
fn file(name: &str, params: &str, body: &str) -> String {
    format!(
        r#"<templates><template name="{name}"><params>{params}</params><content><![CDATA[{body}]]></content></template></templates>"#
    )
}

/// What uses become with the texts of a save.
fn with(files: &[&str], inside: &str) -> Result<String, Vec<String>> {
    let text = format!("<constraints>{inside}</constraints>");
    let element = xml::parse(&text).expect("the test writes XML");
    match expand(&element, files) {
        Ok(all) => {
            assert!(all.faults.is_empty(), "{:?}", all.faults);
            Ok(bare(&all.constraints.expect("there is a template")))
        }
        Err(problems) => Err(problems.iter().map(ToString::to_string).collect()),
    }
}

#[track_caller]
fn becomes(files: &[&str], usage: &str, wanted: &str) {
    assert_eq!(with(files, usage), Ok(parsed(wanted)), "{usage}");
}

/// Words of the one thing that is wrong, without the place.
#[track_caller]
fn wrong(files: &[&str], usage: &str) -> String {
    let told = with(files, usage).expect_err(usage);
    told.join("\n")
}

/// The row of the library as a save would declare it: its body is what it becomes, with places for all parameters.
fn declared(template: &Template) -> String {
    let required = template.required.iter().map(|name| (*name, None));
    let others = template.defaults.iter();
    let others = others.map(|(name, default)| (*name, Some(*default)));
    let (mut params, mut body) = (String::new(), template.becomes.to_owned());
    for (name, default) in required.chain(others) {
        let inside = default.unwrap_or_default();
        params += &match default {
            Some("") => format!(r#"<param name="{name}" default=""/>"#),
            None => format!(r#"<param name="{name}"/>"#),
            Some(_) => format!(r#"<param name="{name}">{inside}</param>"#),
        };
        let value = value_of(name).expect("all have one");
        let place = format!("#{{{name}}}");
        // Names of tags and properties are put in as well as texts.
        body = body.replace(value, &place);
    }
    file(template.name, &params, &body)
}

#[test]
fn a_save_may_declare_every_name_of_the_library_and_both_are_what_they_are() {
    for template in TEMPLATES {
        let own = declared(template);
        let system = used(template, value_of);
        let usage = system.replace("ts:", "u:");
        becomes(&[&own], &usage, template.becomes);
        // Beside each other, and each with its own body.
        let mine = file(template.name, "", "<mine/>");
        let both = format!("<u:{}/>{system}", template.name);
        becomes(&[&mine], &both, &format!("<mine/>{}", template.becomes));
        // What is wrong with that of the library is not hidden by that of the save.
        assert!(with(&[], &format!("<u:{}/>", template.name)).is_err());
    }
}

#[test]
fn a_save_that_says_what_the_library_says_with_defaults_gets_the_same_rules() {
    for template in TEMPLATES {
        let least = |prefix: &str| {
            let usage = used(template, |name| {
                template
                    .required
                    .contains(&name)
                    .then(|| value_of(name))
                    .flatten()
            });
            usage.replace("ts:", prefix)
        };
        let own = declared(template);
        assert_eq!(
            with(&[&own], &least("u:")),
            with(&[], &least("ts:")),
            "{}",
            template.name
        );
    }
}

#[test]
fn a_name_that_has_its_prefix_already_keeps_it() {
    for name in ["a", "u:a"] {
        let own = file(name, "", "<b/>");
        for usage in ["<u:a/>", r#"<use template="u:a"/>"#] {
            becomes(&[&own], usage, "<b/>");
        }
        assert!(with(&[&own], "<u:u:a/>").is_err());
    }
    // Twice is twice, with and without.
    let twice = "<templates><template name=\"a\"><content><![CDATA[<b/>]]></content></template>\n\
                 <template name=\"u:a\"><content><![CDATA[<b/>]]></content></template></templates>";
    let text = document("<u:a/>");
    let constraints = xml::parse(&text).expect("the test writes XML");
    let all = expand(&constraints, &[twice]).expect("the first one is right");
    assert_eq!(all.faults.len(), 1);
}

#[test]
fn what_is_given_last_counts_and_one_tag_may_give_several() {
    let own = file(
        "a",
        r#"<param name="p"/><param name="q" default="Q"/>"#,
        r##"<b p="#{p}" q="#{q}"/>"##,
    );
    for (usage, wanted) in [
        (r#"<u:a p="1"/>"#, r#"<b p="1" q="Q"/>"#),
        (r#"<u:a><with p="1" q="2"/></u:a>"#, r#"<b p="1" q="2"/>"#),
        (
            r#"<u:a p="1" q="1"><with q="2"/></u:a>"#,
            r#"<b p="1" q="2"/>"#,
        ),
        (
            r#"<u:a><with p="1" q="1"/><with param="p">3</with></u:a>"#,
            r#"<b p="3" q="1"/>"#,
        ),
        (
            r#"<u:a><with param="p">3</with><with p="4"/></u:a>"#,
            r#"<b p="4" q="Q"/>"#,
        ),
    ] {
        becomes(&[&own], usage, wanted);
    }
}

#[test]
fn parameters_are_put_in_from_the_last_to_the_first_as_texts_and_names_of_tags() {
    let own = file(
        "a",
        r##"<param name="p" default="P"/><param name="q" default="(#{p})"/><param name="tag" default="condition"/>"##,
        r##"<#{tag} q="#{q}"><#{p}/></#{tag}>"##,
    );
    becomes(&[&own], "<u:a/>", r#"<condition q="(P)"><P/></condition>"#);
    becomes(
        &[&own],
        r#"<u:a tag="not" p="x"/>"#,
        r#"<not q="(x)"><x/></not>"#,
    );
    // One that is given may mention those before it too; one before it is not gone through again.
    becomes(
        &[&own],
        r##"<u:a q="#{p}#{p}"/>"##,
        r#"<condition q="PP"><P/></condition>"#,
    );
    let later = file(
        "a",
        r##"<param name="p" default="#{q}"/><param name="q" default="Q"/>"##,
        r##"<b p="#{p}"/>"##,
    );
    becomes(&[&later], "<u:a/>", r##"<b p="#{q}"/>"##);
}

#[test]
fn tags_alone_are_put_in_and_a_comment_within_one_counts() {
    let event = r#"<event id="i" settedUpInitially="true"><!-- d --><condition><true/></condition><trigger><message text="m"/></trigger></event>"#;
    let own = file("a", "", &format!("text <!-- c -->{event} more"));
    let text = format!("<constraints>{}</constraints>", "<u:a/>");
    let constraints = xml::parse(&text).expect("the test writes XML");
    let all = expand(&constraints, &[&own]).expect("it is right");
    let put_in = xml::write(&all.constraints.expect("there is a template"), 0);
    assert!(
        !put_in.contains("text <!--") && !put_in.contains("<!-- c -->") && !put_in.contains("more")
    );
    assert!(put_in.contains("<!-- d -->"), "{put_in}");
    let text = document("<u:a/>");
    let constraints = xml::parse(&text).expect("the test writes XML");
    let told = read_with_templates(&constraints, &[&own]).expect_err("three children");
    assert!(
        told[0]
            .to_string()
            .ends_with("event tag must have exactly 2 child tag(s)"),
        "{told:?}"
    );
}

#[test]
fn templates_of_a_save_use_each_other_and_the_library_but_not_themselves() {
    let inner = file("inner", r#"<param name="m"/>"#, r##"<b m="#{m}"/>"##);
    let outer = file(
        "outer",
        r##"<param name="a"/><param name="b" default="b#{a}"/>"##,
        r##"<u:inner m="#{a}-#{b}"/><ts:is-undefined name="#{a}"/>"##,
    );
    becomes(
        &[&inner, &outer],
        r#"<u:outer a="1"/>"#,
        r#"<b m="1-b1"/><equals><typeOf objectId="1"/><string value="undefined"/></equals>"#,
    );
    // The same name in the other space is another template.
    let typeof_ = file("typeof", "", r#"<ts:typeof name="n" type="t"/>"#);
    becomes(
        &[&typeof_],
        "<u:typeof/>",
        r#"<equals><typeOf objectId="n"/><string value="t"/></equals>"#,
    );
    let (one, two) = (file("one", "", "<u:two/>"), file("two", "", "<u:one/>"));
    let told = wrong(&[&one, &two], "<u:one/>");
    assert!(
        told.contains("Recursive template expansion detected: u:one -> u:two -> u:one"),
        "{told}"
    );
}

#[test]
fn of_what_is_wrong_the_last_use_is_told_with_its_parameters_from_the_last_to_the_first() {
    let own = file("a", r#"<param name="p"/><param name="q"/>"#, "<b/>");
    let told = wrong(&[&own], r#"<u:no-such/><u:a/>"#);
    let lines: Vec<&str> = told.lines().collect();
    let missing = |line: &str, name: &str| {
        line.contains(&format!(
            "The parameter {name} of template a has no default value"
        ))
    };
    assert_eq!(lines.len(), 2, "{told}");
    assert!(missing(lines[0], "q") && missing(lines[1], "p"), "{told}");
    // A use without its prefix is none where others have theirs.
    assert!(with(&[&own], r#"<u:a p="" q=""/><use template="a" p="" q=""/>"#).is_err());
    becomes(
        &[&own],
        r#"<u:a p="" q=""/><a p="" q=""/>"#,
        r#"<b/><a p="" q=""/>"#,
    );
}

#[test]
fn after_any_mistake_in_a_use_no_rule_is_left() {
    let own = file("a", "", "<b/>");
    let text = document(r#"<u:a/><u:b/><constraint failMessage="no"><true/></constraint>"#);
    let constraints = xml::parse(&text).expect("the test writes XML");
    assert!(read_with_templates(&constraints, &[&own]).is_err());
}
