//! Tests of names: keys, files, attributes and groups.

use super::*;

#[test]
fn unknown_keys_name_the_nearest_known_one() {
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1,\nconvertor = print"),
        "robot.lua:3: x: unknown key 'convertor', did you mean 'converter'"
    );
    assert_eq!(
        refused("src = '/d', colour = 1"),
        "robot.lua:2: x: unknown key 'colour'"
    );
    assert_eq!(
        refused("src = '/d', 5"),
        "robot.lua:1: x: there is an entry with the number 1, but keys are names here"
    );
    assert_eq!(
        refused("src = '/d', [print] = 1"),
        "robot.lua:1: x: a key is a function, but keys are names here"
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1,\nleft = { src = '/e' }"),
        "robot.lua:3: x: 'left' looks like a node, but this table is a node itself because it has 'src'; further files of a node stand in 'attributes'"
    );
}

#[test]
fn names_that_cannot_be_files_are_refused() {
    let named = |key: &str| {
        refused_program(&format!(
            "trikfs = {{\n[{key}] = {{ src = '/d', input_tuple_size = 1 }} }}"
        ))
    };
    assert_eq!(named("''"), "robot.lua:2: trikfs: the name '' is empty");
    assert_eq!(
        named("'.'"),
        "robot.lua:2: trikfs: the name '.' is taken by every folder"
    );
    assert_eq!(
        named("'..'"),
        "robot.lua:2: trikfs: the name '..' is taken by every folder"
    );
    assert_eq!(
        named("'a/b'"),
        "robot.lua:2: trikfs: the name 'a/b' contains a slash"
    );
    assert_eq!(
        named("'a\\0b'"),
        "robot.lua:1: trikfs: the name 'a\\0b' contains a control character"
    );
    assert_eq!(
        named("'a\\nb'"),
        "robot.lua:1: trikfs: the name 'a\\nb' contains a control character"
    );
    assert_eq!(
        named("'\\255'"),
        "robot.lua:1: trikfs: the name '\u{fffd}' is not UTF-8"
    );
    assert!(named("('x'):rep(256)").ends_with("' has more than 255 bytes"));
    assert!(load("trikfs = { [('x'):rep(255)] = { src = '/d', input_tuple_size = 1 } }").is_ok());
    assert_eq!(
        named("5"),
        "robot.lua:1: trikfs: names are strings, but there is an entry with the number 5"
    );
    assert_eq!(
        named("true"),
        "robot.lua:1: trikfs: names are strings, but a key is a boolean"
    );
    for name in ["config", "log", "status", "stop"] {
        let reason = format!(
            "robot.lua:2: '{name}' is a file of the filesystem itself and cannot be a node"
        );
        assert_eq!(named(&format!("'{name}'")), reason);
    }
    assert!(load("trikfs = { g = { config = { src = '/d', input_tuple_size = 1 } } }").is_ok());
}

#[test]
fn attributes_are_nodes_of_their_own_with_names_of_their_own() {
    let attribute = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1,\nattributes = {{ {text} }}"
        ))
    };
    for name in [
        "device", "bin_data", "value", "value0", "value12", "units", "format", "poll_ms", "fault",
        "stages", "stats", "owner",
    ] {
        let reason =
            format!("robot.lua:3: x: '{name}' is a file of every node and cannot be an attribute");
        assert_eq!(attribute(&format!("{name} = {{ src = '/e' }}")), reason);
    }
    assert_eq!(attribute("a = {}"), "robot.lua:3: x/a: 'src' is missing");
    assert_eq!(
        attribute("a = { scr = '/e' }"),
        "robot.lua:3: x/a: 'src' is missing, is 'scr' a typing error"
    );
    assert_eq!(
        attribute("a = 5"),
        "robot.lua:3: x/a: a number stands where a node or a group belongs"
    );
    assert_eq!(
        attribute("a = { src = '/e' }"),
        "robot.lua:3: x/a: input_tuple_size is missing"
    );
    assert_eq!(
        attribute("a = { src = '/e', input_tuple_size = 1, attributes = {} }"),
        "robot.lua:3: x/a: an attribute has no attributes"
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1, attributes = 5"),
        "robot.lua:2: x: attributes must be a table, not a number"
    );
    let node =
        node("src = '/d', input_tuple_size = 1, attributes = { valued = { src = 'trikfs:x' } }");
    assert_eq!(node.attributes[0].path, "x/valued");
    assert_eq!(
        node.attributes[0].source,
        SourceDescription::Node("x".into())
    );
}

#[test]
fn groups_hold_nodes_and_nothing_else() {
    assert_eq!(
        refused_program("trikfs = {\nmotors = { left = 5 } }"),
        "robot.lua:2: motors/left: a number stands where a node or a group belongs"
    );
    assert_eq!(
        refused_program("trikfs = {\nx = { scr = '/d', input_tuple_size = 1 } }"),
        "robot.lua:2: x: 'src' is missing, and 'input_tuple_size' makes no sense in a group, is 'scr' a typing error"
    );
    assert_eq!(
        refused_program("trikfs = {\nx = { scr = '/d' } }"),
        "robot.lua:2: x/scr: a string stands where a node or a group belongs, did you mean 'src'"
    );
    assert_eq!(
        refused_program("trikfs = { src = '/dev/x', input_tuple_size = 1 }"),
        "robot.lua:1: 'trikfs' is the table of all nodes and cannot be a node itself"
    );
    let loaded =
        load("trikfs = {\nempty = {}, src = { src = '/d', input_tuple_size = 1 } }").unwrap();
    assert_eq!(
        loaded.warnings,
        [Problem::new("robot.lua", 2, "empty: the group is empty")]
    );
    assert_eq!(loaded.config.nodes[0].path, "src");
}
