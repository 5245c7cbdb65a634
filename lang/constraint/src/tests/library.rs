//! Every template of both libraries against what is known of the original.
//!
//! The rows were written by hand: what a template becomes with its defaults and with every parameter given. A template or a
//! parameter that no row has fails a test.

use super::facts::stage;
use super::{Run, Value};
use crate::expand::expand;
use crate::former::FORMER;
use crate::library::LIBRARY;
use lang_text::xml::{self, Element, Node};

/// A template: its required parameters, all others with their defaults, and what becomes of it when all are given as
/// `GIVEN` has them.
pub(super) struct Template {
    pub(super) name: &'static str,
    pub(super) required: &'static [&'static str],
    pub(super) defaults: &'static [(&'static str, &'static str)],
    pub(super) becomes: &'static str,
}

/// What parameters are given; contents of tags, or texts.
const GIVEN: &[(&str, &str)] = &[
    ("id", "ID"),
    ("settedUpInit", "SET"),
    ("regionId", "REGION"),
    ("objectId", "OBJECT"),
    ("objectPoint", "POINT"),
    ("message", "TEXT"),
    ("trigger", "<T/>"),
    ("conditions", "<C/>"),
    ("not", "maybe"),
    ("glue", "GLUE"),
    ("glue1", "ONE"),
    ("glue2", "TWO"),
    ("operation", "twist"),
    ("scoreVariable", "SCORE"),
    ("value", "VALUE"),
    ("left", "LEFT"),
    ("right", "RIGHT"),
    ("timeout", "TIME"),
    ("forceDropOnTimeout", "FORCE"),
    ("name", "NAME"),
    ("type", "TYPE"),
];

pub(super) const TEMPLATES: &[Template] = &[
    Template {
        name: "condition-event",
        required: &[],
        defaults: &[
            ("id", ""),
            ("settedUpInit", "false"),
            ("trigger", "<trigger><success/></trigger>"),
            ("conditions", "<condition><true/></condition>"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><C/><triggers><T/></triggers></event>"#,
    },
    Template {
        name: "timer-success-event",
        required: &["timeout"],
        defaults: &[("trigger", ""), ("forceDropOnTimeout", "false")],
        becomes: r#"<event id="" settedUpInitially="true"><condition><timer timeout="TIME" forceDropOnTimeout="FORCE"/>
            </condition><triggers><T/><success/></triggers></event>"#,
    },
    Template {
        name: "set-object-warzone",
        required: &["regionId"],
        defaults: &[
            ("id", ""),
            ("settedUpInit", "true"),
            ("objectId", "robot1"),
            ("objectPoint", "any"),
            ("message", ""),
            ("trigger", ""),
            ("conditions", ""),
            ("not", "not"),
            ("glue", "and"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <maybe><inside objectId="OBJECT" regionId="REGION" objectPoint="POINT"/></maybe><C/></conditions>
            <triggers><T/><message text="TEXT"/><success/></triggers></event>"#,
    },
    Template {
        name: "set-robot-warzone",
        required: &["regionId"],
        defaults: &[
            ("id", ""),
            ("settedUpInit", "true"),
            ("objectPoint", "any"),
            ("message", ""),
            ("trigger", ""),
            ("conditions", ""),
            ("not", "not"),
            ("glue", "and"),
        ],
        // Whatever is given, it is set up from the start.
        becomes: r#"<event id="ID" settedUpInitially="true"><conditions glue="GLUE">
            <maybe><inside objectId="robot1" regionId="REGION" objectPoint="POINT"/></maybe><C/></conditions>
            <triggers><T/><message text="TEXT"/><success/></triggers></event>"#,
    },
    Template {
        name: "change-score-with-log",
        required: &["conditions", "value"],
        defaults: &[
            ("id", ""),
            ("settedUpInit", "false"),
            ("trigger", ""),
            ("operation", "sum"),
            ("scoreVariable", "total_score"),
            ("message", ""),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><C/><triggers>
            <setter name="SCORE"><twist _1="${SCORE}" _2="VALUE"/></setter><message text="TEXT"/><T/></triggers></event>"#,
    },
    Template {
        name: "object-region-with-score",
        required: &["id", "regionId", "value"],
        defaults: &[
            ("settedUpInit", "false"),
            ("objectId", "robot1"),
            ("objectPoint", "any"),
            ("trigger", ""),
            ("conditions", ""),
            ("not", "condition"),
            ("operation", "sum"),
            ("scoreVariable", "total_score"),
            ("message", ""),
            ("glue", "and"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <maybe><inside objectId="OBJECT" regionId="REGION" objectPoint="POINT"/></maybe><C/></conditions><triggers>
            <setter name="SCORE"><twist _1="${SCORE}" _2="VALUE"/></setter><message text="TEXT"/><T/></triggers></event>"#,
    },
    Template {
        name: "robot-stop-in-region-with-score",
        required: &["id", "regionId", "value"],
        defaults: &[
            ("settedUpInit", "false"),
            ("objectPoint", "any"),
            ("trigger", ""),
            ("conditions", ""),
            ("not", "condition"),
            ("operation", "sum"),
            ("scoreVariable", "total_score"),
            ("message", ""),
            ("glue", "and"),
            ("left", "left"),
            ("right", "right"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <maybe><inside objectId="robot1" regionId="REGION" objectPoint="POINT"/></maybe>
            <equals _1="${robot1.LEFT.power}" _2="0"/><equals _1="${robot1.RIGHT.power}" _2="0"/><C/></conditions><triggers>
            <setter name="SCORE"><twist _1="${SCORE}" _2="VALUE"/></setter><message text="TEXT"/><T/></triggers></event>"#,
    },
    Template {
        name: "robot-finish-in-region-with-score",
        required: &["id", "regionId", "value"],
        defaults: &[
            ("settedUpInit", "false"),
            ("objectPoint", "any"),
            ("trigger", ""),
            ("conditions", ""),
            ("not", "condition"),
            ("operation", "sum"),
            ("scoreVariable", "total_score"),
            ("message", ""),
            ("glue", "and"),
            ("left", "left"),
            ("right", "right"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <maybe><inside objectId="robot1" regionId="REGION" objectPoint="POINT"/></maybe>
            <equals _1="${robot1.LEFT.power}" _2="0"/><equals _1="${robot1.RIGHT.power}" _2="0"/><C/></conditions><triggers>
            <setter name="SCORE"><twist _1="${SCORE}" _2="VALUE"/></setter><message text="TEXT"/><T/><success/>
            </triggers></event>"#,
    },
    Template {
        name: "robot-start-with-score",
        required: &["id", "value"],
        defaults: &[
            ("settedUpInit", "false"),
            ("trigger", ""),
            ("conditions", ""),
            ("operation", "sum"),
            ("scoreVariable", "total_score"),
            ("message", ""),
            ("left", "left"),
            ("right", "right"),
            ("glue1", "and"),
            ("glue2", "or"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="ONE"><conditions glue="TWO">
            <notEqual _1="${robot1.LEFT.power}" _2="0"/><notEqual _1="${robot1.RIGHT.power}" _2="0"/></conditions><C/>
            </conditions><triggers><setter name="SCORE"><twist _1="${SCORE}" _2="VALUE"/></setter>
            <message text="TEXT"/><T/></triggers></event>"#,
    },
    Template {
        name: "robot-start",
        required: &["id"],
        defaults: &[
            ("settedUpInit", "true"),
            ("trigger", ""),
            ("conditions", ""),
            ("left", "left"),
            ("right", "right"),
            ("glue", "or"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <notEqual _1="${robot1.LEFT.power}" _2="0"/><notEqual _1="${robot1.RIGHT.power}" _2="0"/><C/></conditions>
            <triggers><T/></triggers></event>"#,
    },
    Template {
        name: "robot-stop",
        required: &["id"],
        defaults: &[
            ("settedUpInit", "false"),
            ("trigger", ""),
            ("conditions", ""),
            ("left", "left"),
            ("right", "right"),
            ("glue", "and"),
        ],
        becomes: r#"<event id="ID" settedUpInitially="SET"><conditions glue="GLUE">
            <equals _1="${robot1.LEFT.power}" _2="0"/><equals _1="${robot1.RIGHT.power}" _2="0"/><C/></conditions>
            <triggers><T/></triggers></event>"#,
    },
    Template {
        name: "is-undefined",
        required: &["name"],
        defaults: &[],
        becomes: r#"<equals><typeOf objectId="NAME"/><string value="undefined"/></equals>"#,
    },
    Template {
        name: "typeof",
        required: &["name", "type"],
        defaults: &[],
        becomes: r#"<equals><typeOf objectId="NAME"/><string value="TYPE"/></equals>"#,
    },
];

/// XML in one form: tags without the texts between them.
pub(super) fn bare(element: &Element<'_>) -> String {
    fn strip(element: &Element<'_>) -> Element<'static> {
        let mut copy = element.clone().into_owned();
        copy.nodes = element
            .elements()
            .map(|one| Node::Element(strip(one)))
            .collect();
        copy
    }
    xml::write(&strip(element), 0)
}

pub(super) fn parsed(inside: &str) -> String {
    let text = format!("<constraints>{inside}</constraints>");
    bare(&xml::parse(&text).expect("the test writes XML"))
}

/// What rules become when their templates are put in.
fn expanded(inside: &str) -> String {
    let text = format!("<constraints>{inside}</constraints>");
    let element = xml::parse(&text).expect("the test writes XML");
    match expand(&element, &[]) {
        Ok(all) => bare(&all.constraints.expect("there is a template")),
        Err(problems) => panic!("{inside}: {problems:?}"),
    }
}

/// A use of a template with some parameters.
pub(super) fn used(template: &Template, given: impl Fn(&str) -> Option<&'static str>) -> String {
    let names = template.required.iter().copied();
    let names = names.chain(template.defaults.iter().map(|(name, _)| *name));
    let with: String = names
        .filter_map(|name| Some((name, given(name)?)))
        .map(|(name, value)| format!(r#"<with param="{name}">{value}</with>"#))
        .collect();
    format!("<ts:{0}>{with}</ts:{0}>", template.name)
}

pub(super) fn value_of(name: &str) -> Option<&'static str> {
    let found = GIVEN.iter().find(|(known, _)| *known == name);
    Some(
        found
            .unwrap_or_else(|| panic!("nothing is given for {name}"))
            .1,
    )
}

#[test]
fn every_template_becomes_what_it_becomes_in_the_original() {
    for template in TEMPLATES {
        assert_eq!(
            expanded(&used(template, value_of)),
            parsed(template.becomes),
            "{}",
            template.name
        );
        // With nothing but what must be given, all others are as if their defaults had been given.
        let least = used(template, |name| {
            template
                .required
                .contains(&name)
                .then(|| value_of(name))
                .flatten()
        });
        let spoken = used(template, |name| {
            let default = template.defaults.iter().find(|(known, _)| *known == name);
            default.map_or_else(|| value_of(name), |(_, value)| Some(*value))
        });
        assert_eq!(expanded(&least), expanded(&spoken), "{}", template.name);
        for missing in template.required {
            let usage = used(template, |name| {
                (name != *missing).then(|| value_of(name)).flatten()
            });
            let text = format!("<constraints>{usage}</constraints>");
            let element = xml::parse(&text).expect("the test writes XML");
            assert!(
                expand(&element, &[]).is_err(),
                "{} {missing}",
                template.name
            );
        }
    }
}

#[test]
fn no_template_and_no_parameter_is_without_a_row() {
    let library = xml::parse(LIBRARY).expect("ours");
    for template in library.elements() {
        let name = template.attribute("name").unwrap_or_default();
        let row = TEMPLATES.iter().find(|row| row.name == name);
        let row = row.unwrap_or_else(|| panic!("nothing is told of ts:{name}"));
        let params = template
            .child("params")
            .into_iter()
            .flat_map(Element::elements);
        let mut there: Vec<&str> = params.filter_map(|one| one.attribute("name")).collect();
        let mut told: Vec<&str> = row.required.to_vec();
        told.extend(row.defaults.iter().map(|(name, _)| *name));
        there.sort_unstable();
        told.sort_unstable();
        assert_eq!(there, told, "{name}");
    }
    assert_eq!(library.elements().count(), TEMPLATES.len());
    // Those of the older release have a use each.
    let former = xml::parse(FORMER).expect("ours");
    for template in former.elements() {
        let name = template.attribute("name").unwrap_or_default();
        // Of one of them the name is a tag of the language too.
        let forms = [format!("<{name} "), format!("template=\"{name}\"")];
        let is_told =
            |row: &(&str, &[&str])| forms.iter().any(|form| row.0.contains(form.as_str()));
        assert!(
            FORMER_USES.iter().any(is_told),
            "nothing is told of <{name}>"
        );
    }
}

/// Uses of templates of the older release, without a prefix, and what is told in three ticks.
const FORMER_USES: &[(&str, &[&str])] = &[
    // All of the object has to be in it, and it is set up from the start.
    (
        r#"<set-object-warzone objectId="robot1" regionId="elsewhere" message="out"/>"#,
        &["out", "The task was accomplished in 0.01 sec!"],
    ),
    (
        r#"<set-object-warzone objectId="robot1" regionId="zone" message="out"/>"#,
        &[],
    ),
    (
        r#"<set-object-warzone objectId="robot1" regionId="edge" message="out"/>"#,
        &["out", "The task was accomplished in 0.01 sec!"],
    ),
    // What is added is the value of a variable that is named.
    (
        r#"<change-score-with-log id="a" variable="total_score" operation="difference"><with param="conditions"><true/></with></change-score-with-log>"#,
        &["Points scored: 0"],
    ),
    (
        r#"<condition-event id="a"/>"#,
        &["The task was accomplished in 0.01 sec!"],
    ),
    (
        r#"<timer-success-event timeout="20"/>"#,
        &["The task was accomplished in 0.02 sec!"],
    ),
    (
        r#"<set-robot-warzone regionId="elsewhere"/>"#,
        &[
            "The robot has moved out of a valid region",
            "The task was accomplished in 0.01 sec!",
        ],
    ),
    (
        r#"<object-in-region-with-score id="a" regionId="zone" variable="total_score"/>"#,
        &["Points scored: 0"],
    ),
    (
        r#"<object-region-with-score id="a" regionId="edge" variable="total_score"/>"#,
        &[],
    ),
    (
        r#"<object-left-region-with-score id="a" regionId="elsewhere" variable="total_score"/>"#,
        &["Points scored: 0"],
    ),
    (
        r#"<robot-stop-in-region-with-score id="a" regionId="zone" variable="total_score"/>"#,
        &["Points scored: 0"],
    ),
    (
        r#"<robot-finish-in-region-with-score id="a" regionId="zone" variable="total_score"/>"#,
        &["Points scored: 0", "The task was accomplished in 0.01 sec!"],
    ),
    // It stands.
    (
        r#"<robot-start-with-score id="a" variable="total_score"/>"#,
        &[],
    ),
    (
        r#"<robot-start regionId="elsewhere"/>"#,
        &["The robot must be in the start region at the start"],
    ),
    (
        r#"<robot-stop regionId="zone"/>"#,
        &["The task was accomplished in 0.01 sec!"],
    ),
    (
        r#"<constraint failMessage="no"><is-undefined objectId="robot1"/></constraint>"#,
        &["no"],
    ),
    (
        r#"<constraint failMessage="no"><use template="typeof" objectId="robot1" type="Robot"/></constraint>"#,
        &["no"],
    ),
];

#[test]
fn templates_of_the_older_release_do_what_they_did() {
    for (usage, told) in FORMER_USES {
        let mut stage = stage();
        stage.region("edge", 0, 0, 120, 400);
        stage.set("robot1", "isRiding", Value::Bool(false));
        let mut run = Run::on(stage, usage);
        run.ticks(3);
        assert_eq!(run.told(), *told, "{usage}");
    }
}
