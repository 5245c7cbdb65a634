//! Tests of sources: each kind as it is read, and every mistake in one.

use super::*;

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
    let played = PlayedDescription {
        path: "/run/player.sock".into(),
        channel: "sensors/A1".to_owned(),
    };
    assert_eq!(
        source("played{ '/run/player.sock', channel = 'sensors/A1' }"),
        SourceDescription::Played(played)
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
        source("played{ '/run/x' }"),
        "robot.lua:2: x: played: channel is missing"
    );
    assert_eq!(
        source("played{ '/run/x', channel = '' }"),
        "robot.lua:2: x: played: channel must be 1 to 512 bytes without control characters"
    );
    assert_eq!(
        refused("src = played{ '/run/x', channel = 'c' }, input_tuple_size = 131073"),
        "robot.lua:2: x: played: a tuple may have 131072 bytes, this one has 131073"
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
