//! Tests of several sources: layout, triggers, formats that follow from other nodes, circles.

use crate::description::{NodeDescription, SeveralDescription, SourceDescription};
use crate::load::Loader;

/// The node `x` with these fields, beside two nodes that it can read.
fn load(fields: &str) -> Result<NodeDescription, String> {
    let source = format!(
        "trikfs = {{ x = {{ {fields} }}, gyro = {{ src = '/g', format = 'i32 x, i32 y' }},\n\
         wheels = {{ left = {{ src = '/l', format = 'f32 angle' }}, plain = {{ src = '/p', input_tuple_size = 2 }} }} }}"
    );
    let loaded = Loader::default().load("robot.lua", None, source.as_bytes());
    let nodes = loaded.map_err(|problem| problem.to_string())?.config.nodes;
    Ok(nodes.into_iter().find(|node| node.path == "x").unwrap())
}

fn several(fields: &str) -> SeveralDescription {
    match load(fields).unwrap().source {
        SourceDescription::Several(several) => several,
        other => panic!("{other:?}"),
    }
}

#[test]
fn times_stand_behind_the_tuples_and_count_in_the_size() {
    let parts = "src = { 'trikfs:gyro', 'newest:wheels/left' }";
    assert_eq!(load(parts).unwrap().input_tuple_size, 12);
    let node = load(&format!("{parts}, ages = true, interval = true")).unwrap();
    assert_eq!(node.input_tuple_size, 12 + 2 * 4 + 4);
    assert!(several(&format!("{parts}, ages = true")).ages);
    assert_eq!(
        several(parts).parts[1].source,
        SourceDescription::Newest("wheels/left".into())
    );
}

#[test]
fn only_the_named_sources_trigger() {
    let triggers = |fields: &str| -> Vec<bool> {
        let several = several(&format!(
            "src = {{ a = 'trikfs:gyro', b = 'trikfs:wheels/left', c = 'newest:gyro' }}{fields}"
        ));
        several.parts.iter().map(|part| part.is_trigger).collect()
    };
    assert_eq!(triggers(""), [true, true, true]);
    assert_eq!(triggers(", trigger = 'b'"), [false, true, false]);
    assert_eq!(triggers(", trigger = { 'a', 'b' }"), [true, true, false]);
    assert!(several("src = { 'trikfs:gyro', 'newest:gyro' }, trigger = 1").parts[0].is_trigger);
}

#[test]
fn the_format_of_nodes_side_by_side_follows_from_theirs() {
    let format = |fields: &str| {
        load(fields)
            .unwrap()
            .format
            .map(|format| format.to_string())
    };
    assert_eq!(
        format(
            "src = { g = 'newest:gyro', left = 'newest:wheels/left' }, ages = true, interval = true"
        )
        .unwrap(),
        "i32 g_x, i32 g_y, f32 left, u32 age_g_us, u32 age_left_us, u32 interval_us"
    );
    assert_eq!(
        format("src = { 'newest:wheels/left', 'trikfs:gyro' }, ages = true").unwrap(),
        "f32 wheels_left, i32 gyro_x, i32 gyro_y, u32 age1_us, u32 age2_us"
    );
    // Bytes without names, the same name twice, and files of the system give none.
    assert_eq!(format("src = { 'newest:wheels/plain' }"), None);
    assert_eq!(format("src = { 'newest:gyro', 'trikfs:gyro' }"), None);
    assert_eq!(
        format("src = { a = '/dev/a', b = 'newest:gyro' }, input_tuple_size = { a = 1 }"),
        None
    );
    // What is given stands.
    assert_eq!(
        format("src = { 'newest:gyro' }, format = 'i64 both'").unwrap(),
        "i64 both"
    );
}

#[test]
fn what_makes_no_sense_is_refused_with_its_reason() {
    let cases = [
        (
            "src = { 'trikfs:gyro' }, trigger = 'gyor'",
            "robot.lua:1: x: trigger: there is no source 'gyor'",
        ),
        (
            "src = { gyro = 'trikfs:gyro' }, trigger = 'gyor'",
            "robot.lua:1: x: trigger: there is no source 'gyor', did you mean 'gyro'",
        ),
        (
            "src = { a = 'newest:gyro' }, trigger = 'a'",
            "robot.lua:1: x: trigger: 'newest:gyro' has no events of its own; 'trikfs:gyro' has if the source of 'gyro' is a stream",
        ),
        (
            "src = { 'trikfs:gyro' }, trigger = {}",
            "robot.lua:1: x: trigger is an empty list",
        ),
        (
            "src = { 'trikfs:gyro' }, ages = 1",
            "robot.lua:1: x: ages must be true or false, not a number",
        ),
        (
            "src = 'trikfs:gyro', ages = true",
            "robot.lua:1: x: ages is for several sources: src = { a = ..., b = ... }",
        ),
        (
            "src = 'trikfs:gyro', trigger = 'a'",
            "robot.lua:1: x: trigger is for several sources: src = { a = ..., b = ... }",
        ),
        (
            "src = 'newest:giro'",
            "robot.lua:1: x: there is no node 'giro', did you mean 'gyro'",
        ),
        (
            "src = { 'newest:x' }",
            "robot.lua:1: x: the node reads itself in a circle: x -> x",
        ),
    ];
    for (fields, expected) in cases {
        assert_eq!(load(fields).unwrap_err(), expected, "{fields}");
    }
}

#[test]
fn the_advice_about_a_trigger_depends_on_what_the_node_is() {
    let state = "i2c{ path = '/dev/i2c-2', address = 72, register = 1, transfer = 'word' }";
    let stream = "fifo{ path = '/run/f' }, input_tuple_size = 2";
    let refusal = |other: &str, fields: &str| {
        let source = format!(
            "trikfs = {{ g = {{ near = {{ src = {other} }}, far = {{ src = 'trikfs:g/near' }},\n\
             pair = {{ src = {{ 'newest:g/far', 'trikfs:g/far' }} }} }}, x = {{ {fields} }} }}"
        );
        let loaded = Loader::default().load("robot.lua", None, source.as_bytes());
        loaded.err().map(|problem| problem.to_string())
    };
    let instead = "name a stream, or leave out trigger and let poll_ms say when to sample";
    for node in ["g/near", "g/far", "g/pair"] {
        let newest = format!("src = {{ a = 'newest:{node}' }}, trigger = 'a'");
        let own = format!("src = {{ a = 'trikfs:{node}' }}, trigger = 'a'");
        assert_eq!(
            refusal(stream, &newest).unwrap(),
            format!(
                "robot.lua:2: x: trigger: 'newest:{node}' has no events of its own; 'trikfs:{node}' delivers each tuple"
            )
        );
        assert_eq!(refusal(stream, &own), None);
        assert_eq!(
            refusal(state, &newest).unwrap(),
            format!(
                "robot.lua:2: x: trigger: 'newest:{node}' has no events of its own, and '{node}' is a state, which has none either; {instead}"
            )
        );
        assert_eq!(
            refusal(state, &own).unwrap(),
            format!(
                "robot.lua:2: x: trigger: source 'a' is a state, which has no events of its own; {instead}"
            )
        );
        // What a plain path is, only its opening tells.
        let path = "'/dev/x', input_tuple_size = 2";
        assert_eq!(refusal(path, &own), None);
        let advice = format!("'trikfs:{node}' has if the source of '{node}' is a stream");
        assert!(refusal(path, &newest).unwrap().ends_with(&advice));
    }
}

#[test]
fn a_circle_is_named_from_its_beginning() {
    let source = "trikfs = {\n\
        a = { src = 'trikfs:b' },\n\
        b = { src = { 'newest:c', '/dev/zero' }, input_tuple_size = { [2] = 1 } },\n\
        c = { src = 'trikfs:d' },\n\
        d = { src = 'trikfs:b' } }";
    let problem = Loader::default().load("robot.lua", None, source.as_bytes());
    assert_eq!(
        problem.unwrap_err().to_string(),
        "robot.lua:3: b: the node reads itself in a circle: b -> c -> d -> b"
    );
}

#[test]
fn what_the_converter_takes_is_compared_with_what_the_sources_give() {
    let node = |format: &str| {
        format!(
            "trikfs = {{ a = {{ src = '/dev/zero', format = '{format}', poll_ms = 10 }},
b = {{ src = {{ x = 'newest:a', y = '/dev/zero' }}, input_tuple_size = {{ y = 2 }}, input_format = 'i32 x, u16 y', format = 'i32 z',
  converter = function(a_s, a, b_s, b) end }},
c = {{ src = {{ x = 'newest:a' }}, interval = true, input_format = 'f32 x, u32 us', format = 'i32 z',
  converter = function(a_s, a, b_s, b) end }} }}"
        )
    };
    let reason = |format: &str| {
        let loader = crate::load::Loader::default();
        let loaded = loader.load("robot.lua", None, node(format).as_bytes());
        loaded
            .err()
            .map_or_else(String::new, |problem| problem.to_string())
    };
    assert_eq!(reason("f32 x"), "");
    // A file has no format, so only the sizes are compared.
    assert_eq!(
        reason("f64 x"),
        "robot.lua:2: b: the converter takes 'i32 x, u16 y', 6 bytes, but the sources give 10"
    );
    assert_eq!(
        reason("i32 x"),
        "robot.lua:4: c: the converter takes 'f32 x, u32 us', but the sources give 'i32 x, u32 interval_us'"
    );
}
