//! One test for each step, and for which steps a version gets.

use super::*;
use crate::archive::{self, Entry};
use crate::read::{Opened, read};
use crate::sketch::Sketch;

/// What a save of a version becomes.
fn opened(version: &str, sketch: &mut Sketch) -> Opened {
    sketch.meta(VERSION_KEY, version);
    let bytes = sketch.qrs().unwrap();
    read(&bytes).unwrap_or_else(|problems| panic!("{problems:?}"))
}

/// The property of the first block of a kind after conversion.
fn property(version: &str, kind: &str, key: &str, value: &str) -> String {
    let mut sketch = Sketch::new();
    sketch.block(kind, &[(key, value)]);
    let opened = opened(version, &mut sketch);
    opened.project.diagrams[0].blocks[0].properties[key].clone()
}

fn world(version: &str, world: &str) -> String {
    let mut sketch = Sketch::new();
    sketch.world(world);
    opened(version, &mut sketch).project.world.unwrap()
}

#[test]
fn ports_lose_their_j_in_blocks_of_trik_only() {
    let text = "JM3, digitSensor1 + sensor2";
    assert_eq!(
        property("3.0.0-a4", "TrikV6EnginesForward", "Ports", text),
        "M3, sensorD1 + sensorA2"
    );
    assert_eq!(property("3.0.0-a4", "Function", "Body", text), text);
    assert_eq!(
        property("3.0.0-a5", "TrikV6EnginesForward", "Ports", text),
        text
    );
}

#[test]
fn spoken_texts_become_expressions() {
    assert_eq!(property("3.0.0-b2", "TrikSay", "Text", "Hi!"), "\"Hi!\"");
    assert_eq!(
        property("3.0.0-b1", "TrikSay", "Text", "\"Hi!\""),
        "\"Hi!\""
    );
    assert_eq!(property("3.0.0-rc1", "TrikSay", "Text", "Hi!"), "Hi!");
    assert_eq!(property("3.0.0-b2", "PrintText", "PrintText", "x"), "\"x\"");
}

#[test]
fn buttons_get_new_names() {
    let text = "enterButton + escapeButton + powerButton";
    let function = "buttonEnter + buttonEscape + buttonEsc";
    assert_eq!(property("3.0.0", "Function", "Body", text), function);
    let trik = "buttonEnter + buttonEsc + buttonEsc";
    assert_eq!(property("3.0.0", "TrikPrintText", "PrintText", text), trik);
    assert_eq!(property("3.0.1", "Function", "Body", text), text);
}

#[test]
fn waits_for_single_buttons_are_taken_out_and_their_links_hang_loose() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wait = sketch.block("TrikWaitForEnter", &[]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wait, end]);
    let opened = opened("3.0.0", &mut sketch);
    let diagram = &opened.project.diagrams[0];
    let kinds: Vec<&str> = diagram.blocks.iter().map(|block| &*block.kind).collect();
    assert_eq!(kinds, ["InitialNode", "FinalNode"]);
    let ends: Vec<_> = diagram
        .links
        .iter()
        .map(|link| (link.from, link.to))
        .collect();
    assert_eq!(ends, [(Some(0), None), (None, Some(1))]);
    assert_eq!(opened.save.orphans(), []);
}

#[test]
fn commands_become_expressions() {
    assert_eq!(property("3.0.1", "TrikSystem", "Command", "ls"), "\"ls\"");
    assert_eq!(property("3.0.2", "TrikSystem", "Command", "ls"), "ls");
}

#[test]
fn the_world_moves_out_of_the_diagram() {
    let mut sketch = Sketch::new();
    sketch.block("Function", &[("Body", "lineSensorX + lineSensorCross")]);
    sketch.diagram_property("worldModel", "<root class=\"trikKitInterpreter::A\"/>");
    let opened = opened("3.0.2", &mut sketch);
    assert_eq!(
        opened.project.world.as_deref(),
        Some("<root class=\"trik::A\"/>")
    );
    let function = &opened.project.diagrams[0].blocks[0];
    assert_eq!(function.properties["Body"], "lineSensor[0] + lineSensor[2]");
}

#[test]
fn vectors_get_indices() {
    let text = "gyroscopeX + accelerometerZ";
    let new = "gyroscope[0] + accelerometer[2]";
    assert_eq!(property("3.1.1-alpha3", "Function", "Body", text), new);
    assert_eq!(property("3.1.3", "Function", "Body", text), text);
}

#[test]
fn the_robot_gets_one_name() {
    let old = "<root><robots><robot id=\"trikV62KitRobot\"/></robots></root>";
    assert_eq!(world("3.2.0", old), old.replace("V62", ""));
    assert_eq!(world("3.3.0", old), old);
}

#[test]
fn the_line_sensor_becomes_a_camera() {
    let old = "<root><a port=\"LineSensorPort###input###TrikLineSensorPort###lineSensor\" type=\"trik::robotModel::parts::TrikLineSensor\"/></root>";
    let new = "<root><a port=\"Video2Port###input######\" type=\"trik::robotModel::parts::TrikVideoCamera\"/></root>";
    assert_eq!(world("3.3.0", old), new);
    assert_eq!(world("2020.4", old), old);
    let infrared = "<root value=\"trik::robotModel::twoD::parts::TwoDInfraredSensor\"/>";
    let range = "<root value=\"twoDModel::robotModel::parts::RangeSensor\"/>";
    assert_eq!(world("3.3.0", infrared), range);
}

#[test]
fn printed_text_gets_a_size_on_trik_only() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let print = sketch.block("PrintText", &[("PrintText", "x")]);
    sketch.link(start, print);
    let found = opened("2020.4", &mut sketch);
    let diagram = &found.project.diagrams[0];
    assert_eq!(diagram.blocks[1].kind, "TrikPrintText");
    assert_eq!(diagram.blocks[1].properties["FontSize"], "20");
    assert_eq!(diagram.blocks[1].properties["PrintText"], "x");
    assert_eq!(diagram.blocks[1].incoming, [0]);
    assert_eq!(
        (diagram.links[0].from, diagram.links[0].to),
        (Some(0), Some(1))
    );
    let later = opened("2020.4.1", &mut sketch);
    assert_eq!(later.project.diagrams[0].blocks[1].kind, "PrintText");
    sketch.meta("lastKitId", "ev3Kit");
    let other = opened("2020.4", &mut sketch);
    assert_eq!(other.project.diagrams[0].blocks[1].kind, "PrintText");
}

#[test]
fn the_robot_moves_into_the_world() {
    let old = "<root><world><walls/></world><robots><robot id=\"r\" position=\"1:2\"><sensors/><startPosition x=\"3\"/></robot></robots></root>";
    let new = parsed(&world("2020.5", old));
    let expected = "<root><world><walls/><robot position=\"1:2\" direction=\"0\"><startPosition x=\"3\"/></robot></world><robots><robot id=\"r\"><sensors/></robot></robots></root>";
    assert_eq!(new, parsed(expected));
    assert_eq!(world("2022.2", old), old);
    assert_eq!(modern_world(expected).unwrap(), None);
    assert_eq!(modern_world("<root/>").unwrap(), None);
}

fn parsed(text: &str) -> String {
    xml::write(&xml::parse(text).unwrap(), 1)
}

#[test]
fn a_world_that_is_no_xml_is_told_and_kept() {
    let mut sketch = Sketch::new();
    sketch.world("<root>");
    let opened = opened("3.1.0", &mut sketch);
    assert_eq!(opened.project.world.as_deref(), Some("<root>"));
    let told = opened.problems.iter().map(Problem::to_string);
    assert!(
        told.into_iter()
            .any(|line| line.starts_with("worldModel.xml: 1:7 the text ends"))
    );
}

#[test]
fn a_newer_and_a_too_old_save_are_refused_with_what_to_do() {
    let refused = |version: &str| {
        let mut sketch = Sketch::new();
        sketch.meta(VERSION_KEY, version);
        let problems = read(&sketch.qrs().unwrap()).unwrap_err();
        problems[0].to_string()
    };
    assert_eq!(
        refused("2026.1"),
        "metaInfo.xml: the project was saved by version 2026.1, which is newer than 2024.1.0, the newest that is known here: update this program, or save the project in an older TRIK Studio"
    );
    assert!(refused("2.9").contains("too old: open it in TRIK Studio 3"));
}

#[test]
fn a_save_without_a_version_is_read_as_of_today() {
    let entries = archive::open(&Sketch::new().qrs().unwrap(), &mut Vec::new())
        .unwrap()
        .entries;
    let with = |meta: Option<&str>| {
        let others = entries
            .iter()
            .filter(|entry| entry.name != "metaInfo.xml")
            .cloned();
        let meta = meta.map(|text| Entry {
            name: "metaInfo.xml".to_owned(),
            bytes: text.into(),
        });
        let entries: Vec<Entry> = others.chain(meta).collect();
        let opened = read(&archive::pack(&entries).unwrap()).unwrap();
        opened
            .problems
            .iter()
            .map(Problem::to_string)
            .collect::<Vec<_>>()
    };
    assert!(with(Some("<metaInformation/>"))[0].contains("does not tell its version"));
    let strange =
        "<metaInformation><info key='RobotsMetamodelVersion' value='new'/></metaInformation>";
    assert!(with(Some(strange))[0].contains("'new' is no version"));
    assert!(with(None)[0].contains("version and kit of the project are not known"));
}

#[test]
fn a_present_save_is_not_converted() {
    let found = opened(VERSION, &mut Sketch::new());
    assert_eq!(found.problems, []);
    let mut sketch = Sketch::new();
    sketch.block("Function", &[("Body", "gyroscopeX")]);
    let found = opened("3.1.0", &mut sketch);
    assert_eq!(found.problems.len(), 1);
    assert_eq!(found.problems[0].severity, Severity::Note);
    assert!(
        found.problems[0]
            .to_string()
            .contains("from version 3.1.0 to 2024.1.0")
    );
}
