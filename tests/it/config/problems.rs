//! `trikfs check`: mistakes are told with file, line, and what was probably meant.

use crate::trikfs;
use harness::Board;

/// The first line of the refusal, without the name of the file.
fn problem(config: &str) -> String {
    let board = Board::new();
    board.file("robot.lua", config);
    let output = trikfs(&board, &["check", "--cache", "cache", "robot.lua"], b"");
    assert_eq!(
        output.code(),
        1,
        "{config}\n{}{}",
        output.stdout,
        output.stderr
    );
    assert_eq!(output.stdout, "", "{config}");
    let line = output.stderr.lines().next().unwrap_or_default();
    line.strip_prefix("robot.lua:")
        .unwrap_or_else(|| panic!("{config}\n{line}"))
        .to_owned()
}

#[test]
fn a_good_file_is_said_to_be_good_and_missing_devices_are_warnings() {
    let board = Board::new();
    board.file(
        "robot.lua",
        "trikfs = {\n  a = { src = '/absent/device', input_tuple_size = 1 },\n}",
    );
    let output = trikfs(&board, &["check", "robot.lua"], b"");
    assert_eq!(
        (output.code(), output.stdout.as_str()),
        (0, "robot.lua: good\n")
    );
    assert_eq!(
        output.stderr,
        "robot.lua:2: warning: node a: /absent/device does not exist; opening it will give ENODEV\n"
    );
}

/// A description of a robot misses everything at once on a PC.
#[test]
fn missing_devices_of_one_place_are_one_warning() {
    let board = Board::new();
    std::fs::create_dir(board.path("there")).unwrap();
    board.file("there/here", "");
    let node = |name: &str, path: &str| {
        format!("  {name} = {{ src = '{path}', input_tuple_size = 1 }},\n")
    };
    let there = |name: &str| board.path("there").join(name).display().to_string();
    let nodes = [
        ("a", "/dev/absent-2".to_owned()),
        ("b", "/dev/absent-2".to_owned()),
        ("c", "/dev/absent-3".to_owned()),
        ("d", "/absent/one/x".to_owned()),
        ("e", "/absent/two/y".to_owned()),
        ("f", there("here")),
        ("g", there("x")),
        ("h", there("y")),
        ("i", there("z")),
    ];
    let lines: String = nodes.iter().map(|(name, path)| node(name, path)).collect();
    board.file("robot.lua", format!("trikfs = {{\n{lines}}}"));
    let output = trikfs(&board, &["check", "robot.lua"], b"");
    assert_eq!(output.stdout, "robot.lua: good\n");
    let expected = format!(
        "robot.lua:2: warning: 2 nodes, such as a: /dev/absent-2 does not exist; opening them will give ENODEV\n\
         robot.lua:4: warning: node c: /dev/absent-3 does not exist; opening it will give ENODEV\n\
         robot.lua:5: warning: 2 nodes, such as d: /absent/one/x does not exist, nor does another one in /absent; opening them will give ENODEV\n\
         robot.lua:8: warning: 3 nodes, such as g: {} does not exist, nor do 2 more in {}; opening them will give ENODEV\n",
        there("x"),
        board.path("there").display()
    );
    assert_eq!(output.stderr, expected);
}

#[test]
fn the_shipped_configurations_are_good() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/lua");
    let board = Board::new();
    let hello = format!("{folder}/hello.lua");
    let output = trikfs(&board, &["check", "--cache", "cache", &hello], b"");
    assert_eq!(output.code(), 0, "{}", output.stderr);
    assert!(
        output.stderr.lines().all(|line| line.contains("warning: ")),
        "{}",
        output.stderr
    );
}

#[test]
fn mistakes_are_told_with_their_line_and_the_nearest_right_word() {
    let zero = "src = '/dev/zero', input_tuple_size = 1";
    let node = |rest: &str| format!("trikfs = {{\n  a = {{ {zero}, {rest} }},\n}}");
    let cases = [
        ("trikfs = {\n a = 1 1 }".to_owned(), "2: ", ""),
        ("\n\nlocal x = y.z".to_owned(), "3: ", "y"),
        ("error('mine', 0)".to_owned(), "", "mine"),
        ("trikfs = nil".to_owned(), "", "trikfs"),
        ("trikfs = { 1, 2 }".to_owned(), "", ""),
        (node("convertr = id_create(1)"), "2: ", "converter"),
        (node("Units = 'mm'"), "2: ", "units"),
        (node("poll_ms = 0"), "2: ", "poll_ms"),
        (node("poll_ms = 1.5"), "2: ", "poll_ms"),
        (node("poll_ms = 3600001"), "2: ", "3600000"),
        (node("poll_ms = 5, on_event = true"), "2: ", "on_event"),
        (node("timeout_ms = 0"), "2: ", "timeout_ms"),
        (node("budget_us = -1"), "2: ", "budget_us"),
        (node("memory_kb = 0 / 0"), "2: ", "memory_kb"),
        (node("mode = 4096"), "2: ", "mode"),
        (node("owner = 'nobody-like-this'"), "2: ", "nobody-like-this"),
        (node("format = 'i16 x'"), "2: ", "1 and 2 bytes"),
        (node("format = 'u9 x'"), "2: ", "u9"),
        (node("format = 'u8'"), "2: ", "format"),
        (node("units = 5"), "2: ", "units"),
        (node("units = 'a\\nb'"), "2: ", "units"),
        (node("rest = { 1, 2 }"), "2: ", "rest"),
        (node("params = { k = 'x' }"), "2: ", "params"),
        (node("share = 1"), "2: ", "share"),
        (node("attributes = { b = 5 }"), "2: ", "b"),
        (node("b = { src = '/dev/zero', input_tuple_size = 1 }"), "2: ", "b"),
        (node("converter = 5"), "2: ", "converter"),
        (node("converter = {}"), "2: ", "converter"),
        (node("converter = 'absent.so'"), "2: ", "absent.so"),
        ("trikfs = {\n  a = { src = 5, input_tuple_size = 1 } }".to_owned(), "2: ", "src"),
        ("trikfs = {\n  a = { src = '/dev/zero' } }".to_owned(), "2: ", "input_tuple_size"),
        ("trikfs = {\n  a = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 2 } }".to_owned(), "2: ", "1 and 2 bytes"),
        ("trikfs = {\n  log = { src = '/dev/zero', input_tuple_size = 1 } }".to_owned(), "2: ", "log"),
        ("trikfs = {\n  a = { src = fake{ data = '' }, input_tuple_size = 1 } }".to_owned(), "", "data"),
        ("trikfs = {\n  a = { src = evdev{ path = '/dev/input/event0', axes = { 'ABS_Q' } } } }".to_owned(), "", "ABS_Q"),
        ("trikfs = {\n  a = { src = faulty{ src = '/dev/zero', fail = 'EWHAT' }, input_tuple_size = 1 } }".to_owned(), "", "EWHAT"),
    ];
    for (config, place, word) in cases {
        let line = problem(&config);
        assert!(
            line.starts_with(place) && line.contains(word),
            "{config}\n{line}"
        );
        let reason = line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':' || c == ' ');
        assert!(
            !reason.is_empty() && !reason.ends_with('.'),
            "{config}\n{line}"
        );
    }
}

#[test]
fn circles_are_told_with_every_node_on_the_way() {
    let size = ", input_tuple_size = 1";
    for (config, expected) in [
        (
            format!(
                "trikfs = {{\n a = {{ src = 'trikfs:b'{size} }},\n b = {{ src = 'newest:c'{size}, poll_ms = 5 }},\n c = {{ src = 'trikfs:a'{size}, poll_ms = 5 }} }}"
            ),
            "2: a: the node reads itself in a circle: a -> b -> c -> a",
        ),
        (
            format!(
                "trikfs = {{ a = {{ src = 'trikfs:b/x'{size} }}, b = {{ src = '/dev/zero'{size}, attributes = {{ x = {{ src = 'trikfs:a'{size} }} }} }} }}"
            ),
            "1: a: the node reads itself in a circle: a -> b/x -> a",
        ),
        (
            "trikfs = { a = { alias = 'b' }, b = { alias = 'a' } }".to_owned(),
            "1: a: 'b' is a second name itself; name the node that it stands for",
        ),
        (
            "local c = {} c[1] = c trikfs = { a = { src = '/dev/zero', converter = c } }"
                .to_owned(),
            "1: a/converter/1: the table holds itself",
        ),
    ] {
        assert_eq!(problem(&config), expected, "{config}");
    }
}

#[test]
fn what_does_not_fit_into_a_chain_or_a_range_is_told_with_both_sides() {
    let chain = |converter: &str, params: &str| {
        format!(
            "trikfs = {{ a = {{ src = '/dev/zero', input_tuple_size = 4, format = 'i16 x', params = {{ {params} }}, converter = {converter} }} }}"
        )
    };
    for (config, expected) in [
        // Sizes that do not fit in a chain.
        (
            chain(
                "{ 'libtrikfs_filters.so#median3', 'libtrikfs_filters.so#scale' }",
                "",
            ),
            "1: node a: libtrikfs_filters.so#scale: scale: tuples of 4 to 2 bytes; it needs equal sizes, a multiple of 4",
        ),
        (
            chain(
                "{ id_create(4), { converter = id_create(2), output_tuple_size = 3 } }",
                "",
            ),
            "1: a: the last stage gives 3 bytes, but the tuple has 2",
        ),
        // Parameters out of range, not finite, mistyped.
        (
            chain("filter.moving_average{ window = 0 / 0 }", ""),
            "1: moving_average: window must be a whole number from 1 to 256, not nan",
        ),
        (
            chain("filter.low_pass{ alpha = 1 / 0 }", ""),
            "1: low_pass: alpha must be from 3.0517578125e-05 to 1, not inf",
        ),
        (
            chain("'libtrikfs_filters.so#identity'", "window = 0 / 0"),
            "1: a: params: 'window' must be finite, not NaN",
        ),
        (
            chain("id_create(2)", "gain = { 5, min = 9, max = 1 }"),
            "1: a: params: 'gain': min, 9, is above max, 1",
        ),
        (
            chain("filter.low_pass{ alhpa = 0.5 }", ""),
            "1: low_pass: no parameter 'alhpa'",
        ),
    ] {
        assert_eq!(problem(&config), expected, "{config}");
    }
    let mistyped = problem(&chain("filter.meddian3{}", ""));
    assert!(
        mistyped.starts_with("1: there is no filter.meddian3 in Lua; there are: ")
            && mistyped.contains(" median3, ")
            && mistyped.ends_with("'libtrikfs_filters.so#NAME'"),
        "{mistyped}"
    );
}

#[test]
fn points_that_make_no_curve_are_refused_at_the_line_that_has_them() {
    for (points, expected) in [
        ("{ { 10, 700 } }", "there are 2 to 20 of them, not 1"),
        (
            "{ { 10, 700 }, { 20 } }",
            "number 2 is no pair { distance, raw } of numbers",
        ),
        (
            "{ { 10, 700 }, { 20, 0 / 0 } }",
            "number 2 is no pair { distance, raw } of numbers",
        ),
        (
            "{ { 10, 700 }, 5 }",
            "number 2 is no pair { distance, raw } of numbers",
        ),
        ("5", "a list of { distance, raw } pairs, not a number"),
        (
            "{ { 10, 200 }, { 20, 700 } }",
            "they do not lie on a curve that falls as the signal grows",
        ),
        (
            "{ { 10, 200 }, { 10, 200 }, { 10, 200 } }",
            "they do not lie on a curve that falls as the signal grows",
        ),
    ] {
        let config = format!(
            "local calibrate = include 'calibrate'\nlocal curve = calibrate.inverse({points})\ntrikfs = {{ a = {{ src = '/dev/zero' }} }}"
        );
        assert_eq!(
            problem(&config),
            format!("2: points: {expected}"),
            "{points}"
        );
    }
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let board = Board::new();
    for (name, words) in [("absent.lua", "absent.lua: "), (".", ".: ")] {
        let output = trikfs(&board, &["check", name], b"");
        assert_eq!(output.code(), 1);
        assert!(
            output.stderr.starts_with(words) && output.stderr.lines().count() == 1,
            "{}",
            output.stderr
        );
    }
    board.file("long.lua", vec![b' '; (1 << 20) + 1]);
    let output = trikfs(&board, &["check", "long.lua"], b"");
    assert_eq!(output.code(), 1);
    assert!(output.stderr.contains("1048576"), "{}", output.stderr);
}

#[test]
fn the_command_line_explains_itself() {
    let board = Board::new();
    let help = trikfs(&board, &["--help"], b"").good();
    for word in [
        "mount",
        "check",
        "convert",
        "new-converter",
        "umount",
        "edit",
        "Exit status",
    ] {
        assert!(help.contains(word), "{word} is missing in:\n{help}");
    }
    assert!(
        trikfs(&board, &["--version"], b"")
            .good()
            .starts_with("trikfs 0.")
    );
    let mount = trikfs(&board, &["mount", "--help"], b"").good();
    for option in [
        "--config",
        "--allow-other",
        "--background",
        "--config-group",
        "--include",
        "--cache",
        "--transport",
    ] {
        assert!(mount.contains(option), "{option} is missing in:\n{mount}");
    }
    for arguments in [
        &["nonsense"][..],
        &["check"],
        &["mount"],
        &["convert", "x"],
        &[],
    ] {
        assert_eq!(trikfs(&board, arguments, b"").code(), 2, "{arguments:?}");
    }
    if !help.contains("completions") {
        // A program built without the feature `manual`, such as a robot's; the one of these tests has it.
        assert!(std::env::var_os(crate::UNDER_TEST).is_some());
        return;
    }
    assert!(
        trikfs(&board, &["completions", "bash"], b"")
            .good()
            .contains("trikfs")
    );
    assert!(trikfs(&board, &["man"], b"").good().starts_with(".ie"));
    for (command, option) in [("convert", "keep\\-going"), ("new-converter", "lang")] {
        let page = trikfs(&board, &["man", command], b"").good();
        assert!(page.contains(&format!("\\-\\-{option}")), "{page}");
        let words = trikfs(&board, &["completions", "bash"], b"").good();
        assert!(
            words.contains(&option.replace('\\', "")),
            "{command}: {option}"
        );
    }
}
