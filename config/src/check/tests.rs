//! Tests of the checks: every mistake that a description can hold, with its place and words.

use crate::description::{
    EvdevDescription, EvdevLayout, FakeDescription, FaultyDescription, NodeDescription, Pace,
    ReplayDescription, SourceDescription, StageKind,
};
use crate::load::{Loaded, Loader};
use crate::problem::Problem;
use std::path::{Path, PathBuf};

fn load(source: &str) -> Result<Loaded, Problem> {
    Loader::default().load("robot.lua", None, source.as_bytes())
}

/// The node `x` with these fields.
fn node(fields: &str) -> NodeDescription {
    let loaded = load(&format!(
        "trikfs = {{ x = {{ {fields} }}, other = {{ src = '/dev/o', format = 'i16 a, i16 b' }} }}"
    ));
    let nodes = loaded
        .unwrap_or_else(|problem| panic!("{fields}: {problem}"))
        .config
        .nodes;
    nodes.into_iter().find(|node| node.path == "x").unwrap()
}

/// The refusal of the node `x` with these fields, which begin at line 2.
fn refused(fields: &str) -> String {
    let source = format!(
        "trikfs = {{ x = {{\n{fields} }}, other = {{ src = '/dev/o', format = 'i16 a, i16 b' }} }}"
    );
    load(&source).unwrap_err().to_string()
}

fn refused_program(source: &str) -> String {
    load(source).unwrap_err().to_string()
}

#[test]
fn a_description_has_the_defaults_of_the_manual() {
    let node = node("src = '/dev/urandom', input_tuple_size = 3");
    assert_eq!(node.source, SourceDescription::Path("/dev/urandom".into()));
    assert_eq!((node.input_tuple_size, node.output_tuple_size), (3, 3));
    assert!(node.converter.is_empty() && node.write_converter.is_none() && node.format.is_none());
    assert_eq!(
        (node.timeout_ms, node.budget_us, node.memory_kb),
        (1000, crate::limits::BUDGET_US, 1024)
    );
    assert_eq!(
        (node.mode, node.owner, node.group, node.share),
        (0o644, None, None, None)
    );
    assert_eq!(
        (node.pace, node.units.as_str(), node.rest),
        (Pace::OnRead, "", None)
    );
}

#[test]
fn sizes_follow_from_each_other() {
    let sizes = |fields: &str| {
        (
            node(fields).input_tuple_size,
            node(fields).output_tuple_size,
        )
    };
    assert_eq!(sizes("src = '/d', output_tuple_size = 3"), (3, 3));
    assert_eq!(sizes("src = '/d', format = 'i16 a, u8 b'"), (3, 3));
    assert_eq!(
        sizes("src = '/d', input_tuple_size = 8, format = 'i16 a', converter = id_create(2)"),
        (8, 2)
    );
    assert_eq!(sizes("src = 'trikfs:other'"), (4, 4));
    assert_eq!(
        sizes("src = 'trikfs:other', output_tuple_size = 1, converter = id_create(1)"),
        (4, 1)
    );
    assert_eq!(
        sizes("src = evdev{ path = '/d', axes = { 'ABS_X', 'ABS_Y' } }"),
        (8, 8)
    );
    assert_eq!(
        sizes("src = { 'trikfs:other', '/d' }, input_tuple_size = { [2] = 6 }"),
        (10, 10)
    );
    let chain = node("src = '/d', input_tuple_size = 8, output_tuple_size = 2,
        converter = { id_create(8), { converter = id_create(4), output_tuple_size = 4 }, id_create(2) },
        write_converter = { { converter = id_create(1), output_tuple_size = 1 }, id_create(1) }");
    let sizes: Vec<_> = chain
        .converter
        .iter()
        .map(|stage| (stage.input_size, stage.output_size))
        .collect();
    assert_eq!(sizes, [(8, 8), (8, 4), (4, 2)]);
    let sizes: Vec<_> = chain
        .write_converter
        .unwrap()
        .iter()
        .map(|stage| (stage.input_size, stage.output_size))
        .collect();
    assert_eq!(sizes, [(2, 1), (1, 8)]);
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let number = |text: &str| {
        format!(
            "robot.lua:2: x: input_tuple_size must be a whole number from 1 to 4194304, not {text}"
        )
    };
    assert_eq!(refused("src = '/d', input_tuple_size = 0"), number("0"));
    assert_eq!(refused("src = '/d', input_tuple_size = -1"), number("-1"));
    assert_eq!(refused("src = '/d', input_tuple_size = 1.5"), number("1.5"));
    assert_eq!(
        refused("src = '/d', input_tuple_size = 4194305"),
        number("4194305")
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 0 / 0"),
        number("NaN")
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1 / 0"),
        number("inf")
    );
    let wrong = "robot.lua:2: x: input_tuple_size must be a number, not a string";
    assert_eq!(refused("src = '/d', input_tuple_size = '3'"), wrong);
    assert_eq!(
        refused("src = '/d'"),
        "robot.lua:1: x: input_tuple_size is missing"
    );
    let missing = "robot.lua:1: x: output_tuple_size is missing; a format gives it as well";
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1, converter = id_create(1)"),
        missing
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 1, output_tuple_size = 2"),
        "robot.lua:2: x: without a converter the tuples before and after have the same size, not 1 and 2 bytes"
    );
    assert_eq!(
        refused("src = '/d', input_tuple_size = 4,\noutput_tuple_size = 4,\nformat = 'i16 a'"),
        "robot.lua:4: x: format has 2 bytes, but output_tuple_size is 4"
    );
    assert_eq!(
        refused("src = 'trikfs:other', input_tuple_size = 3"),
        "robot.lua:2: x: input_tuple_size is 3, but the source gives tuples of 4 bytes"
    );
    assert_eq!(
        refused(
            "src = '/d', input_tuple_size = 1, output_tuple_size = 1,\nconverter = { { converter = id_create(1), output_tuple_size = 2 } }"
        ),
        "robot.lua:3: x: the last stage gives 2 bytes, but the tuple has 1"
    );
    assert_eq!(
        refused("src = '/d', format = 'i17 a'"),
        "robot.lua:2: x: format has an unknown type 'i17', did you mean 'i16'"
    );
}

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
        "stats", "owner",
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

#[test]
fn sources_of_all_kinds_are_read() {
    let source = |text: &str| node(&format!("src = {text}, input_tuple_size = 4")).source;
    assert_eq!(
        source("attribute{ '/sys/x' }"),
        SourceDescription::Attribute("/sys/x".into())
    );
    assert_eq!(
        source("attribute '/sys/x'"),
        SourceDescription::Attribute("/sys/x".into())
    );
    assert_eq!(
        source("fifo{ path = '/run/x' }"),
        SourceDescription::Fifo("/run/x".into())
    );
    let evdev = EvdevDescription {
        path: "/dev/input/event0".into(),
        codes: vec![(3, 7)],
        layout: EvdevLayout::Bits64,
    };
    assert_eq!(
        source("evdev{ path = '/dev/input/event0', codes = { { 3, 7 } }, layout = 'bits64' }"),
        SourceDescription::Evdev(evdev)
    );
}

#[test]
fn sources_that_make_their_own_bytes_are_read() {
    let source = |text: &str| node(&format!("src = {text}, input_tuple_size = 4")).source;
    let fake = FakeDescription {
        data: b"abcdefgh".to_vec(),
        period_ms: 10,
        repeat: true,
    };
    assert_eq!(
        source("fake{ data = 'abcdefgh', period_ms = 10, loop = true }"),
        SourceDescription::Fake(fake.clone())
    );
    let replay = ReplayDescription {
        path: "/tmp/run.rec".into(),
        speed: 0.5,
        repeat: false,
    };
    assert_eq!(
        source("replay{ '/tmp/run.rec', speed = 0.5 }"),
        SourceDescription::Replay(replay)
    );
    let faulty = |errno, from, count, short| {
        SourceDescription::Faulty(FaultyDescription {
            source: Box::new(SourceDescription::Fake(fake.clone())),
            errno,
            from,
            count,
            short,
        })
    };
    let inner = "fake{ data = 'abcdefgh', period_ms = 10, loop = true }";
    assert_eq!(
        source(&format!(
            "faulty{{ src = {inner}, fail = 'EIO', from = 3 }}"
        )),
        faulty(libc::EIO, 3, 1, 0)
    );
    assert_eq!(
        source(&format!(
            "faulty{{ src = {inner}, fail = 'EOF', count = 0 }}"
        )),
        faulty(0, 1, 0, 0)
    );
    assert_eq!(
        source(&format!("faulty{{ src = {inner}, fail = 19, short = 2 }}")),
        faulty(19, 1, 1, 2)
    );
    assert_eq!(
        source(&format!("faulty{{ src = {inner}, short = 1 }}")),
        faulty(libc::EIO, u32::MAX, 1, 1)
    );
    let SourceDescription::Several(several) =
        node("src = { gyro = '/g', accel = 'trikfs:other' }, input_tuple_size = { gyro = 6 }")
            .source
    else {
        panic!("several sources");
    };
    let parts: Vec<_> = several
        .parts
        .iter()
        .map(|part| (part.name.as_str(), part.tuple_size))
        .collect();
    assert_eq!(parts, [("accel", 4), ("gyro", 6)]);
}

#[test]
fn a_second_name_is_no_source_and_its_node_is_named() {
    let told = refused_program(
        "trikfs = { e1 = { src = '/dev/o', input_tuple_size = 4 }, left = { alias = 'e1' },
            x = { src = 'trikfs:left' } }",
    );
    assert!(
        told.ends_with("x: there is no node 'left': it is a second name; write 'e1'"),
        "{told}"
    );
}

#[test]
fn sources_that_cannot_be_are_refused() {
    let source = |text: &str| refused(&format!("src = {text}, input_tuple_size = 4"));
    assert_eq!(
        source("5"),
        "robot.lua:2: x: src must be a path, a source or a table of these, not a number"
    );
    assert_eq!(source("''"), "robot.lua:2: x: src is empty");
    assert_eq!(
        source("'dev/x'"),
        "robot.lua:2: x: the path 'dev/x' must begin with a slash"
    );
    assert_eq!(
        source("'/a\\0b'"),
        "robot.lua:2: x: src contains a zero byte"
    );
    assert_eq!(
        source("'trikfs:othr'"),
        "robot.lua:2: x: there is no node 'othr', did you mean 'other'"
    );
    assert_eq!(
        source("'trikfs:x'"),
        "robot.lua:2: x: the node reads itself in a circle: x -> x"
    );
    assert_eq!(
        source("attribute{}"),
        "robot.lua:2: x: attribute: path is missing"
    );
    assert_eq!(
        source("attribute(5)"),
        "robot.lua:2: attribute wants a table or a path"
    );
    assert_eq!(
        source("fifo{ path = '/x', size = 1 }"),
        "robot.lua:2: x: fifo: unknown key 'size'"
    );
    assert_eq!(
        source("evdev{ path = '/x' }"),
        "robot.lua:2: x: evdev: axes is missing, for example axes = { 'ABS_X' }; events = true gives every event"
    );
    assert_eq!(
        source("evdev{ path = '/x', axes = {} }"),
        "robot.lua:2: x: evdev: axes must be a list of event names"
    );
    assert_eq!(
        source("evdev{ path = '/x', axes = { 'ABS_Q' } }"),
        "robot.lua:2: x: evdev: unknown event code 'ABS_Q', did you mean 'ABS_X'"
    );
    assert_eq!(
        source("evdev{ path = '/x', axes = { 'ABS_X', { 3, 0 } } }"),
        "robot.lua:2: x: evdev: axes names the event 3,0 twice"
    );
}

#[test]
fn sources_that_cannot_make_bytes_are_refused() {
    let source = |text: &str| refused(&format!("src = {text}, input_tuple_size = 4"));
    assert_eq!(
        source("fake{ data = 'abc' }"),
        "robot.lua:2: x: fake: data has 3 bytes, not whole tuples of 4"
    );
    assert_eq!(
        source("fake{ data = '' }"),
        "robot.lua:2: x: fake: data is empty"
    );
    assert_eq!(
        source("fake{ data = 'abcd', period_ms = 1e9 }"),
        "robot.lua:2: x: period_ms must be a whole number from 0 to 3600000, not 1000000000"
    );
    assert_eq!(
        source("replay{ '../x' }"),
        "robot.lua:2: x: replay: '../x' leads outside the search path"
    );
    assert_eq!(
        source("replay{ '/x', speed = 0 }"),
        "robot.lua:2: x: replay: speed must be from 0.001 to 1000000, not 0"
    );
    assert_eq!(
        source("faulty{ fail = 'EIO' }"),
        "robot.lua:2: x: faulty: src is missing"
    );
    assert_eq!(
        source("faulty{ src = '/x', fail = 'EOI' }"),
        "robot.lua:2: x: faulty: unknown error 'EOI', did you mean 'EIO'"
    );
    assert_eq!(
        source("faulty{ src = '/x' }"),
        "robot.lua:2: x: faulty: give fail, for example fail = 'EIO', or short"
    );
    assert_eq!(
        source("faulty{ src = faulty{ src = '/x', short = 1 }, short = 1 }"),
        "robot.lua:2: x: faulty: src is faulty already"
    );
    assert_eq!(source("{}"), "robot.lua:2: x: src is an empty table");
    assert_eq!(
        source("{ '/a' }"),
        "robot.lua:2: x: input_tuple_size of several sources is a table with a size for each, not a number"
    );
    assert_eq!(
        refused("src = { '/a', '/b' }, input_tuple_size = { 1 }"),
        "robot.lua:2: x: input_tuple_size of '2' is missing"
    );
    assert_eq!(
        refused("src = { '/a' }, input_tuple_size = { 1, 2 }"),
        "robot.lua:2: x: input_tuple_size has '2', but src has not"
    );
    assert_eq!(
        refused("src = { '/a', b = '/b' }"),
        "robot.lua:2: x: src mixes a list with names"
    );
    assert_eq!(
        refused("src = { { '/a' } }"),
        "robot.lua:2: x: src is nested; sources of several stand side by side"
    );
}

#[test]
fn circles_and_long_rows_of_nodes_are_refused() {
    assert_eq!(
        refused_program("trikfs = {\na = { src = 'trikfs:b' },\nb = { src = 'trikfs:a' } }"),
        "robot.lua:2: a: the node reads itself in a circle: a -> b -> a"
    );
    let row = "trikfs = { n0 = { src = '/d', input_tuple_size = 1 } } for i = 1, N do trikfs['n' .. i] = { src = 'trikfs:n' .. (i - 1) } end";
    assert!(load(&row.replace('N', "60")).is_ok());
    let error = refused_program(
        "trikfs = { z = { src = 'trikfs:a001' } } for i = 1, 4000 do trikfs[('a%03d'):format(i)] = { src = ('trikfs:a%03d'):format(i + 1) } end",
    );
    assert!(
        error.ends_with("more than 64 nodes read each other in a row"),
        "{error}"
    );
}

#[test]
fn pace_and_limits_are_checked() {
    let field = |text: &str| refused(&format!("src = '/d', input_tuple_size = 1,\n{text}"));
    assert_eq!(
        field("poll_ms = 0"),
        "robot.lua:3: x: poll_ms must be a whole number from 1 to 3600000, not 0"
    );
    assert_eq!(
        field("on_event = true, always = true"),
        "robot.lua:3: x: always goes with poll_ms: it says whether the clock samples while nobody needs it"
    );
    assert_eq!(
        field("poll_ms = 5, on_event = true"),
        "robot.lua:3: x: poll_ms and on_event exclude each other"
    );
    assert_eq!(
        field("max_age_ms = 5"),
        "robot.lua:3: x: max_age_ms goes with poll_ms or on_event: without them each read takes a new sample"
    );
    assert_eq!(
        field("on_event = true, max_age_ms = 0"),
        "robot.lua:3: x: max_age_ms must be a whole number from 1 to 3600000, not 0"
    );
    assert_eq!(
        field("on_event = 1"),
        "robot.lua:3: x: on_event must be true or false, not a number"
    );
    assert_eq!(
        field("timeout_ms = 3600001"),
        "robot.lua:3: x: timeout_ms must be a whole number from 1 to 3600000, not 3600001"
    );
    assert_eq!(
        field("budget_us = 1e8"),
        "robot.lua:3: x: budget_us must be a whole number from 1 to 10000000, not 100000000"
    );
    assert_eq!(
        field("memory_kb = 16"),
        "robot.lua:3: x: memory_kb must be a whole number from 128 to 65536, not 16"
    );
    assert_eq!(
        field("units = 5"),
        "robot.lua:3: x: units must be a string, not a number"
    );
    assert_eq!(
        field("units = 'a\\nb'"),
        "robot.lua:3: x: units contains a control character"
    );
    assert_eq!(
        field("units = ('x'):rep(65)"),
        "robot.lua:3: x: units has more than 64 bytes"
    );
    assert_eq!(
        field("share = 'yes'"),
        "robot.lua:3: x: share must be true or false, not a string"
    );
    let node = node("src = '/d', input_tuple_size = 1, poll_ms = 5, units = 'mm/s', share = false");
    assert_eq!(
        (node.pace, node.units.as_str(), node.share),
        (
            Pace::Every {
                period_ms: 5,
                always: false
            },
            "mm/s",
            Some(false)
        )
    );
}

#[test]
fn permissions_are_octal_digits() {
    let mode = |text: &str| node(&format!("src = '/d', input_tuple_size = 1, mode = {text}")).mode;
    assert_eq!(mode("0644"), 0o644);
    assert_eq!(mode("'0600'"), 0o600);
    assert_eq!(mode("0"), 0);
    let wrong = |text: &str| refused(&format!("src = '/d', input_tuple_size = 1, mode = {text}"));
    assert_eq!(wrong("1777"), "robot.lua:2: x: mode '1777' is beyond 0777");
    assert_eq!(
        wrong("'rw'"),
        "robot.lua:2: x: mode must be octal digits like '0644', not 'rw'"
    );
    assert_eq!(
        wrong("689"),
        "robot.lua:2: x: mode must be octal digits like '0644', not '689'"
    );
    assert_eq!(
        wrong("-1"),
        "robot.lua:2: x: mode must be octal digits like '0644', not '-1'"
    );
    assert_eq!(
        wrong("{}"),
        "robot.lua:2: x: mode must be permissions like '0644', not a table"
    );
    let default = |source: &str| node(&format!("src = {source}")).mode;
    assert_eq!(default("'trikfs:other'"), 0o444);
    assert_eq!(
        default("faulty{ src = 'trikfs:other', fail = 'EIO' }"),
        0o444
    );
    assert_eq!(
        default("faulty{ src = '/d', fail = 'EIO' }, input_tuple_size = 1"),
        0o644
    );
    assert_eq!(default("evdev{ path = '/d', axes = { 'ABS_X' } }"), 0o444);
}

#[test]
fn owners_are_accounts_of_the_system() {
    let node = node("src = '/d', input_tuple_size = 1, owner = 'root', group = 5");
    assert_eq!((node.owner, node.group), (Some(0), Some(5)));
    let wrong = |text: &str| refused(&format!("src = '/d', input_tuple_size = 1, {text}"));
    assert_eq!(
        wrong("owner = 'no-such-user'"),
        "robot.lua:2: x: there is no user 'no-such-user'"
    );
    assert_eq!(
        wrong("group = 'no-such-group'"),
        "robot.lua:2: x: there is no group 'no-such-group'"
    );
    assert_eq!(
        wrong("owner = -1"),
        "robot.lua:2: x: owner must be a whole number from 0 to 4294967294, not -1"
    );
    assert_eq!(
        wrong("owner = {}"),
        "robot.lua:2: x: owner must be a string, not a table"
    );
}

#[test]
fn rest_must_be_something_that_can_be_written() {
    let rest = |text: &str| node(&format!("src = '/d', format = 'i16 a, u8 b', {text}")).rest;
    assert_eq!(rest("rest = { -5, 0 }"), Some(vec![-5.0, 0.0]));
    assert_eq!(
        node("src = '/d', input_tuple_size = 1, rest = 7").rest,
        Some(vec![7.0])
    );
    let wrong = |text: &str| refused(&format!("src = '/d', format = 'i16 a, u8 b',\n{text}"));
    assert_eq!(
        wrong("rest = 0"),
        "robot.lua:3: x: rest: 1 number where 2 belong"
    );
    assert_eq!(
        wrong("rest = { 0, 256 }"),
        "robot.lua:3: x: rest: field 'b': 256 is outside 0..255"
    );
    assert_eq!(
        wrong("rest = { 0, 0 / 0 }"),
        "robot.lua:3: x: rest must be finite, not NaN"
    );
    assert_eq!(
        wrong("rest = { a = 0 }"),
        "robot.lua:3: x: rest must be a number or a list of numbers"
    );
    assert_eq!(
        wrong("rest = 'x'"),
        "robot.lua:3: x: rest must be a number, not a string"
    );
    assert_eq!(
        refused("src = 'trikfs:other', rest = { 0, 0 }"),
        "robot.lua:2: x: rest makes no sense: the source cannot be written"
    );
    assert_eq!(
        refused(
            "src = fake{ data = 'abcd' }, input_tuple_size = 4, write_converter = id_create(4)"
        ),
        "robot.lua:2: x: write_converter makes no sense: the source cannot be written"
    );
}

#[test]
fn a_node_writes_through_another_if_it_says_how_and_the_other_can_be_written() {
    let through = |mode: &str| {
        load(&format!(
            "trikfs = {{ a = {{ src = '/d', input_tuple_size = 4, mode = {mode} }},
              x = {{ src = 'trikfs:a', write_converter = id_create(4), rest = {{ 0, 0, 0, 0 }} }} }}"
        ))
    };
    let config = through("0644").unwrap().config;
    assert_eq!(config.nodes[1].mode, 0o644);
    assert_eq!(config.nodes[1].written_tuple_size(), 4);
    let refused = through("0444").unwrap_err().to_string();
    assert_eq!(
        refused,
        "robot.lua:2: x: write_converter makes no sense: the source cannot be written"
    );
}

#[test]
fn params_are_numbers_with_names() {
    let node = node("src = '/d', input_tuple_size = 1, params = { gain = 2.5 }");
    assert_eq!(node.params.get("gain"), Some(&2.5));
    let wrong = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1, params = {text}"
        ))
    };
    assert_eq!(
        wrong("5"),
        "robot.lua:2: x: params must be a table of numbers, not a number"
    );
    assert_eq!(
        wrong("{ a = 'x' }"),
        "robot.lua:2: x: params: 'a' must be a number, not a string"
    );
    assert_eq!(
        wrong("{ a = 1 / 0 }"),
        "robot.lua:2: x: params: 'a' must be finite, not inf"
    );
    assert_eq!(
        wrong("{ 1 }"),
        "robot.lua:2: x: the name of a param is a word of letters, digits and '_'"
    );
}

#[test]
fn converters_of_all_kinds_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lib.so");
    std::fs::write(&path, "").unwrap();
    let source = "trikfs = { x = { src = '/d', input_tuple_size = 1, output_tuple_size = 1,\n converter = { 'lib.so',\n\
        'lib.so#median3', { library = 'lib.so', name = 'low_pass' }, {\n code = [[\nint converter;\n]] },\n\
        function() end } } }";
    let loaded = Loader::default().load("robot.lua", Some(folder.path()), source.as_bytes());
    let stages = loaded.unwrap().config.nodes[0].converter.clone();
    let library = |name: Option<&str>| StageKind::Library {
        path: path.clone(),
        name: name.map(str::to_owned),
    };
    let code = StageKind::InlineC {
        code: "int converter;\n".into(),
    };
    let kinds: Vec<StageKind> = stages.iter().map(|stage| stage.kind.clone()).collect();
    assert_eq!(
        kinds,
        [
            library(None),
            library(Some("median3")),
            library(Some("low_pass")),
            code,
            StageKind::Lua
        ]
    );
    assert_eq!(stages[3].place.to_string(), "robot.lua:5");
    assert_eq!(stages[4].place.to_string(), "robot.lua:7");
}

#[test]
fn converters_that_cannot_be_are_refused() {
    let converter = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1, output_tuple_size = 1,\nconverter = {text}"
        ))
    };
    let kinds =
        "a function, the path of a library, a table with code or library, or a list of these";
    assert_eq!(
        converter("5"),
        format!("robot.lua:3: x: converter must be {kinds}, not a number")
    );
    assert_eq!(
        converter("{}"),
        format!("robot.lua:3: x: converter must be {kinds}")
    );
    assert_eq!(
        converter("{ { {} } }"),
        format!("robot.lua:3: x: converter must be {kinds}")
    );
    assert_eq!(
        converter("math.floor"),
        "robot.lua:3: x: converter must be a function written in lua, not one of the library"
    );
    assert_eq!(
        converter("'none.so'"),
        "robot.lua:3: x: library 'none.so' was not found in any folder: no search path is set"
    );
    assert_eq!(
        converter("'/nowhere/none.so'"),
        "robot.lua:3: x: library '/nowhere/none.so' does not exist"
    );
    assert_eq!(
        converter("'#x'"),
        "robot.lua:3: x: the path of the library is empty"
    );
    assert_eq!(
        converter("'x.so#'"),
        "robot.lua:3: x: the name of a converter in a library has 1 to 64 letters"
    );
    assert_eq!(
        converter("{ code = 5 }"),
        "robot.lua:3: x: code must be a string of C, not a number"
    );
    assert_eq!(converter("{ code = ' ' }"), "robot.lua:3: x: code is empty");
    assert_eq!(
        converter("{ code = 'a\\0' }"),
        "robot.lua:3: x: code contains a zero byte"
    );
    assert_eq!(
        converter("{ code = '\\255' }"),
        "robot.lua:3: x: code is not UTF-8"
    );
    assert_eq!(
        converter("{ code = 'x', lang = 'c' }"),
        "robot.lua:3: x: converter: unknown key 'lang'"
    );
    assert_eq!(
        converter("{ libary = 'x' }"),
        "robot.lua:3: x: converter: unknown key 'libary', did you mean 'library'"
    );
    assert_eq!(
        converter("{ id_create(1), x = 1 }"),
        "robot.lua:3: x: converter mixes a list with names"
    );
    let long = "(function() local t = {} for i = 1, 17 do t[i] = id_create(1) end return t end)()";
    assert_eq!(
        converter(long),
        "robot.lua:3: x: converter has more than 16 stages"
    );
}

#[test]
fn a_library_is_never_taken_from_the_working_directory() {
    let here = std::env::current_dir().unwrap().join("Cargo.toml");
    assert!(here.is_file());
    let source = "trikfs = { x = { src = '/d', input_tuple_size = 1, output_tuple_size = 1, converter = 'Cargo.toml' } }";
    assert!(load(source).is_err());
    let beside = Loader::default().load(
        "robot.lua",
        Some(Path::new(env!("CARGO_MANIFEST_DIR"))),
        source.as_bytes(),
    );
    let PathKind(path) = PathKind::of(&beside.unwrap());
    assert!(path.is_absolute());
}

/// Path of the library of the first node.
struct PathKind(PathBuf);

impl PathKind {
    fn of(loaded: &Loaded) -> Self {
        match &loaded.config.nodes[0].converter[0].kind {
            StageKind::Library { path, .. } => Self(path.clone()),
            other => panic!("not a library: {other:?}"),
        }
    }
}
