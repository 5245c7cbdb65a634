//! Tests of the checks of a description: sizes, pace, owners, rest; helpers for the subjects below.

mod converters;
mod names;
mod sources;

use crate::description::{
    EvdevDescription, EvdevLayout, FakeDescription, FaultyDescription, NodeDescription, Pace,
    PlayedDescription, ReplayDescription, SourceDescription, StageKind,
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
fn bytes_of_a_source_need_samples_in_the_background() {
    let reason = "raw needs samples in the background: give the node poll_ms or on_event";
    let why = refused("src = '/dev/null', input_tuple_size = 1, raw = true");
    assert!(why.ends_with(reason), "{why}");
}

#[test]
fn only_machine_code_is_isolated() {
    let field = |text: &str| {
        refused(&format!(
            "src = '/d', input_tuple_size = 1, output_tuple_size = 1,\n{text}"
        ))
    };
    assert_eq!(
        field("isolate = 1, converter = { code = 'x' }"),
        "robot.lua:3: x: isolate must be true or false, not a number"
    );
    let reason = "isolate is for shared libraries and inline C, and this node has neither; a converter in Lua needs no process of its own";
    for converter in ["", "converter = id_create(1)"] {
        let found = field(&format!("isolate = true, {converter}"));
        assert_eq!(found, format!("robot.lua:3: x: {reason}"));
    }
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
