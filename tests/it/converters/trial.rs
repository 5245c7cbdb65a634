//! `trikfs convert`: forms of output, reports of refused tuples, times, recordings, vectors and random bytes.

use crate::trikfs;
use harness::{Board, Output};

/// Refuses 0, takes 1 without output, and doubles the rest; `f` passes a float on.
const CONFIG: &str = "trikfs = {
  n = { src = '/dev/zero', input_tuple_size = 1, format = 'u16 twice', output_tuple_size = 2,
        converter = function(a_s, a, b_s, b)
          local x = ba.u8(a, 0)
          if x == 0 then error('nothing there', 0) end
          if x == 1 then return false end
          ba.u16(b, 0, 2 * x)
        end },
  f = { src = '/dev/zero', input_tuple_size = 4, format = 'f32 x' },
  bytes = { src = '/dev/zero', input_tuple_size = 2 },
}";

fn board() -> Board {
    let board = Board::new();
    board.file("robot.lua", CONFIG);
    board
}

/// `trikfs convert` with the words of a line.
fn convert(board: &Board, line: &str, input: &[u8]) -> Output {
    let mut words = vec!["convert", "--cache", "cache"];
    words.extend(line.split(' '));
    trikfs(board, &words, input)
}

#[test]
fn results_are_bytes_hexadecimal_or_the_text_of_value() {
    let board = board();
    board.file("raw", [2, 1, 200]);
    assert_eq!(
        convert(&board, "--text robot.lua n raw", b"").good(),
        "4\n400\n"
    );
    assert_eq!(
        convert(&board, "--hex robot.lua n raw", b"").good(),
        "0400\n9001\n"
    );
    assert_eq!(convert(&board, "--text robot.lua n -", &[3]).good(), "6\n");
    assert_eq!(convert(&board, "robot.lua n", b"  ").good(), "@\0@\0");
    assert_eq!(
        convert(&board, "--text robot.lua bytes", &[1, 2]).good(),
        "1 2\n"
    );
    // A converter that collects before it gives anything is not silent.
    let taken = convert(&board, "robot.lua n", &[1, 1, 1]);
    assert_eq!((taken.code(), taken.stdout.as_str()), (0, ""));
    assert_eq!(taken.stderr, "node n: 3 tuples taken, no output yet\n");
    assert_eq!(convert(&board, "robot.lua n", &[1, 2]).stderr, "");
    let both = convert(&board, "--text --hex robot.lua n", b"");
    assert_eq!(both.code(), 2);
    let absent = convert(&board, "robot.lua n absent", b"");
    assert_eq!((absent.code(), absent.stdout.as_str()), (1, ""));
    assert!(
        absent.stderr.starts_with("trikfs: absent: "),
        "{}",
        absent.stderr
    );
}

#[test]
fn a_refused_tuple_is_named_with_its_place_and_what_came_before_it_is_there() {
    let board = board();
    let stopped = convert(&board, "--text robot.lua n", &[5, 1, 0, 6]);
    assert_eq!((stopped.code(), stopped.stdout.as_str()), (1, "10\n"));
    assert_eq!(
        stopped.stderr,
        "trikfs: node n: tuple 3 at byte 2 (00): nothing there\n"
    );
    let all = convert(&board, "--text --keep-going robot.lua n", &[5, 0, 6, 0, 1]);
    assert_eq!((all.code(), all.stdout.as_str()), (1, "10\n12\n"));
    assert_eq!(
        all.stderr,
        "trikfs: node n: 2 of 5 tuples were refused\n  2 times, first tuple 2 at byte 1 (00): nothing there\n"
    );
    let good = convert(&board, "--text --keep-going robot.lua n", &[5]);
    assert_eq!((good.code(), good.stderr.as_str()), (0, ""));
}

#[test]
fn a_number_that_is_not_finite_is_no_text() {
    let board = board();
    let bytes: Vec<u8> = [1.5, f32::NAN, f32::INFINITY]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let text = convert(&board, "--text --keep-going robot.lua f", &bytes);
    assert_eq!((text.code(), text.stdout.as_str()), (1, "1.5\n"));
    for line in [
        "2 of 3 tuples were refused",
        "tuple 2 at byte 4 (0000c07f): field 'x' is NaN",
        "tuple 3 at byte 8 (0000807f): field 'x' is inf",
    ] {
        assert!(text.stderr.contains(line), "{}", text.stderr);
    }
}

#[test]
fn times_are_told_with_every_count_also_when_a_tuple_was_refused() {
    let board = board();
    for (input, code) in [(&[2, 3, 4][..], 0), (&[2, 3, 0], 1)] {
        let output = convert(&board, "--timing robot.lua n", input);
        assert_eq!(output.code(), code);
        let line = output.stderr.lines().next().unwrap_or_default();
        let rest = line
            .strip_prefix("node n: 3 tuples: p50 ")
            .unwrap_or_else(|| panic!("{line}"));
        let numbers: Vec<f64> = rest
            .split(|c: char| !c.is_ascii_digit())
            .filter_map(|word| word.parse().ok())
            .collect();
        // p50, p99 with its own number, max, rate.
        let [p50, _, p99, max, rate] = numbers[..] else {
            panic!("{line}")
        };
        assert!(
            0.0 < p50 && p50 <= p99 && p99 <= max && rate > 0.0,
            "{line}"
        );
    }
    let nothing = convert(&board, "--timing robot.lua n", b"");
    assert_eq!(
        (nothing.code(), nothing.stderr.as_str()),
        (0, "node n: 0 tuples\n")
    );
}

#[test]
fn what_programs_write_is_tried_as_well() {
    let board = Board::new();
    board.file(
        "robot.lua",
        "trikfs = { motor = { src = '/dev/null', input_tuple_size = 1, format = 'i16 power',
           converter = function(a_s, a, b_s, b) ba.i16(b, 0, ba.i8(a, 0)) end,
           write_converter = function(a_s, a, b_s, b)
             local power = ba.i16(a, 0)
             if power < -100 or power > 100 then error('ERANGE: power is -100 to 100', 0) end
             ba.i8(b, 0, power)
           end } }",
    );
    let written = convert(
        &board,
        "--write --hex --keep-going robot.lua motor",
        &[50, 0, 200, 0, 0x9c, 0xff],
    );
    assert_eq!((written.code(), written.stdout.as_str()), (1, "32\n9c\n"));
    assert!(
        written
            .stderr
            .contains("tuple 2 at byte 2 (c800): power is -100 to 100"),
        "{}",
        written.stderr
    );
    assert_eq!(
        convert(&board, "--write --text robot.lua motor", &[0x9c, 0xff]).good(),
        "156\n"
    );
    assert_eq!(
        convert(&board, "--text robot.lua motor", &[0x9c]).good(),
        "-100\n"
    );
    board.file("v.txt", "size 2 1\n3200 > 32\nc800 > fault\n");
    assert_eq!(
        convert(&board, "--write --vectors v.txt robot.lua motor", b"").good(),
        "v.txt: 2 vectors hold\n"
    );
    let random = convert(
        &board,
        "--write --random 1000 --seed 3 robot.lua motor",
        b"",
    )
    .good();
    assert!(
        random.contains(" times: power is -100 to 100\n"),
        "{random}"
    );
}

#[test]
fn a_recording_keeps_its_times() {
    let board = board();
    board.file("run.rec", "# hand\n0 02\n12.5 01 03\n20 04 05\n");
    assert_eq!(
        convert(&board, "--replay --text robot.lua n run.rec", b"").good(),
        "0 4\n12.5 6\n20 8\n20 10\n"
    );
    assert_eq!(
        convert(&board, "--replay robot.lua n", b"0 02\n").good(),
        "\u{4}\0"
    );
    let bad = convert(&board, "--replay --text robot.lua n", b"0 02\nx 03\n");
    assert_eq!(bad.code(), 1);
    assert_eq!(
        bad.stderr,
        "trikfs: standard input:2: the time is not a number of ms\n"
    );
}

#[test]
fn vectors_hold_or_the_first_that_does_not_is_named() {
    let board = board();
    let check = |text: &str| {
        board.file("v.txt", text);
        convert(&board, "--vectors v.txt robot.lua n", b"")
    };
    assert_eq!(
        check("size 1 2\n02 > 0400\n01 > consumed\n00 > fault\n").good(),
        "v.txt: 3 vectors hold\n"
    );
    for (text, reason) in [
        (
            "size 1 2\n02 > 0500",
            "v.txt: line 2: 02 gives 0400, not 0500",
        ),
        (
            "size 1 2\n00 > 0500",
            "v.txt: line 2: 00 gives fault (nothing there), not 0500",
        ),
        (
            "size 2 2\n0002 > 0500",
            "v.txt: the vectors have tuples of 2 and 2 bytes, node n of 1 and 2 bytes",
        ),
        (
            "size 1 2\n0 > 0500",
            "v.txt: line 2: '0' is not 1 bytes in hexadecimal",
        ),
        ("", "v.txt: line 0: no vectors"),
    ] {
        let output = check(text);
        assert_eq!(
            (output.code(), output.stderr),
            (1, format!("trikfs: {reason}\n")),
            "{text}"
        );
    }
}

#[test]
fn the_golden_vectors_of_a_filter_hold_with_their_params() {
    let board = Board::new();
    board.file("robot.lua", "trikfs = { n = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 4, converter = 'libtrikfs_filters.so#moving_average' } }");
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/golden/filters/");
    let mut tried = 0;
    for entry in std::fs::read_dir(golden).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        if name.starts_with("moving_average.") && text.contains("\nsize 4 4\n") {
            let line = format!("--vectors {} robot.lua n", path.display());
            assert!(
                convert(&board, &line, b"")
                    .good()
                    .ends_with(" vectors hold\n")
            );
            tried += 1;
        }
    }
    assert!(tried > 0, "no vectors of one value");
}

#[test]
fn random_bytes_find_what_examples_do_not() {
    let board = board();
    let good = convert(&board, "--random 1000 --seed 4 robot.lua n", b"").good();
    assert!(
        good.starts_with("node n: 1000 random tuples, seed 4: "),
        "{good}"
    );
    assert!(good.contains(" times: nothing there\n"), "{good}");
    let infinite = convert(&board, "--random 1000 --seed 4 robot.lua f", b"");
    assert_eq!(infinite.code(), 1);
    assert!(
        infinite
            .stderr
            .starts_with("trikfs: node f: seed 4, tuple "),
        "{}",
        infinite.stderr
    );
    assert!(
        infinite.stderr.contains(": field 'x' is "),
        "{}",
        infinite.stderr
    );
    for line in [
        "--random 0 robot.lua n",
        "--random 1000001 robot.lua n",
        "--random 5 --text robot.lua n",
        "--seed 5 robot.lua n",
    ] {
        assert_eq!(convert(&board, line, b"").code(), 2, "{line}");
    }
}

#[test]
fn random_bytes_show_states_that_are_shared_and_writes_beside_the_output() {
    let board = Board::new();
    board.library(
        "libstatic.so",
        "static unsigned char sum; int converter(int n, char *a, int m, char *b) { (void)n; (void)m; sum += a[0]; b[0] = (char)sum; return 0; }",
    );
    board.library(
        "libbeside.so",
        "int converter(int n, char *a, int m, char *b) { (void)n; (void)m; b[0] = a[0]; if (a[0] == 77) b[-1] = 1; return 0; }",
    );
    board.library(
        "libcrash.so",
        "int converter(int n, char *a, int m, char *b) { (void)n; (void)m; b[0] = a[0]; if (a[0] == 77) __builtin_trap(); return 0; }",
    );
    board.file(
        "robot.lua",
        "trikfs = {} for _, name in ipairs{ 'static', 'beside', 'crash' } do
           trikfs[name] = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = 'lib' .. name .. '.so' } end",
    );
    for (node, words) in [
        ("static", "opened again it gives something else"),
        ("beside", "(4d): wrote outside its output"),
    ] {
        let output = convert(
            &board,
            &format!("--random 5000 --seed 9 robot.lua {node}"),
            b"",
        );
        assert_eq!(output.code(), 1);
        assert!(output.stderr.contains(words), "{}", output.stderr);
    }
    let crashed = convert(&board, "--random 5000 --seed 9 robot.lua crash", b"");
    assert!(crashed.code() > 128, "{crashed:?}");
}

#[test]
fn damaged_tuples_come_from_a_recording() {
    let board = Board::new();
    // A packet with a check byte: random bytes hardly ever pass.
    board.file(
        "robot.lua",
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 4, output_tuple_size = 2, converter = function(a_s, a, b_s, b)
           if ba.u8(a, 0) ~= 0x55 or (ba.u8(a, 1) + ba.u8(a, 2)) % 256 ~= ba.u8(a, 3) then error('damaged', 0) end
           ba.u16(b, 0, ba.u16(a, 1)) end } }",
    );
    let blind = convert(&board, "--random 300 --seed 2 robot.lua n", b"");
    assert_eq!(blind.code(), 1);
    assert!(
        blind
            .stderr
            .contains("all 300 tuples were refused, so nothing was tried: damaged"),
        "{}",
        blind.stderr
    );
    board.file("recorded", [0x55, 1, 2, 3, 0x55, 200, 100, 44]);
    let said = convert(&board, "--random 300 --seed 2 robot.lua n recorded", b"").good();
    assert!(said.contains(" times: damaged\n"), "{said}");
}
