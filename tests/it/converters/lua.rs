//! Lua converters: a state for each open file, byte arrays, faults with file and line.

use crate::{mount, mount_on};
use harness::Board;

#[test]
fn every_open_file_has_a_state_of_its_own() {
    let Some(m) = mount(
        "shared = 0
         local count = 0
         trikfs = { n = { src = '/dev/zero', input_tuple_size = 2, output_tuple_size = 2, converter = function(a_s, a, b_s, b)
           count = count + 1
           shared = shared + 1
           ba.set(b, 0, count)
           ba.set(b, 1, shared)
         end } }
         trikfs.other = trikfs.n",
    ) else {
        return;
    };
    m.python(
        "one, two, other = [open_ro(M + '/%s/device' % name) for name in ('n', 'n', 'other')]
for number in range(1, 6): assert os.read(one, 2) == bytes([number, number])
assert os.read(two, 2) == b'\\1\\1'
assert os.read(other, 2) == b'\\1\\1'
assert os.read(one, 4) == b'\\6\\6\\7\\7'
",
    );
    // A fresh opening of the newest value begins with a fresh state.
    let newest = m.read("n/bin_data").unwrap();
    assert_eq!(m.read("n/bin_data").unwrap(), newest);
}

#[test]
fn byte_arrays_read_and_write_numbers_of_all_types() {
    let board = Board::new();
    let mut input = Vec::new();
    input.extend((-2i8).to_le_bytes());
    input.extend((-300i16).to_le_bytes());
    input.extend((-70000i32).to_be_bytes());
    input.extend(1.5f32.to_le_bytes());
    input.extend((-2.25f64).to_be_bytes());
    input.extend(65535u16.to_be_bytes());
    board.file("in", &input);
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 21, output_tuple_size = 21, converter = function(a_s, a, b_s, b)
          assert(a_s == 21 and b_s == 21 and ba.len(a) == 21 and ba.len(b) == 21)
          ba.i8(b, 0, ba.i8(a, 0) + 1)
          ba.i16(b, 1, ba.i16(a, 1) + 1)
          ba.i32_be(b, 3, ba.i32_be(a, 3) + 1)
          ba.f32(b, 7, ba.f32(a, 7) + 1)
          ba.f64_be(b, 11, ba.f64_be(a, 11) + 1)
          ba.u16_be(b, 19, ba.u16_be(a, 19) + 3)
        end } }",
    ) else {
        return;
    };
    let mut expected = Vec::new();
    expected.extend((-1i8).to_le_bytes());
    expected.extend((-299i16).to_le_bytes());
    expected.extend((-69999i32).to_be_bytes());
    expected.extend(2.5f32.to_le_bytes());
    expected.extend((-1.25f64).to_be_bytes());
    expected.extend(2u16.to_be_bytes());
    assert_eq!(m.read("n/bin_data").unwrap(), expected);
}

#[test]
fn positions_outside_and_foreign_arrays_are_faults() {
    let cases = [
        ("ba.get(a, 2)", "outside the array of 2 bytes"),
        ("ba.get(a, -1)", "outside the array of 2 bytes"),
        ("ba.set(b, 2, 1)", "outside the array of 2 bytes"),
        ("ba.i32(a, 0)", "outside the array of 2 bytes"),
        ("ba.i16(b, 1, 1)", "outside the array of 2 bytes"),
        ("ba.get(a, 0.5)", "not a whole number"),
        ("ba.get({}, 0)", "not a byte array"),
        ("ba.set(b, 0, 'x')", "a value is a number"),
        ("b[1] = 5", "use ba.set"),
        ("nothing.at_all = 1", "nothing"),
        ("error('mine', 0)", "mine"),
        ("return 5", "return"),
        ("return 'text'", "return"),
    ];
    let mut config = "trikfs = {}\n".to_owned();
    for (number, (code, _)) in cases.iter().enumerate() {
        config.push_str(&format!(
            "trikfs.n{number} = {{ src = '/dev/zero', input_tuple_size = 2, output_tuple_size = 2,\nconverter = function(a_s, a, b_s, b)\n{code}\nend }}\n"
        ));
    }
    let Some(m) = mount(&config) else { return };
    for (number, (code, words)) in cases.iter().enumerate() {
        assert_eq!(m.errno(&format!("n{number}/bin_data")), libc::EIO, "{code}");
        let fault = m.text(&format!("n{number}/fault"));
        assert!(
            fault.starts_with("converter: ") && fault.contains(words),
            "{code}: {fault}"
        );
    }
    // The line of an error is that of the configuration.
    let fault = m.text("n9/fault");
    assert!(fault.contains(&format!(":{}:", 2 + 9 * 4 + 2)), "{fault}");
}

#[test]
fn what_may_not_be_reached_is_not_there() {
    let mut config = "trikfs = {}\nlocal names = {}\n".to_owned();
    for name in [
        "os",
        "io",
        "ffi",
        "debug",
        "package",
        "require",
        "dofile",
        "loadfile",
        "jit",
        "collectgarbage",
        "getfenv",
        "setfenv",
        "newproxy",
        "module",
    ] {
        config.push_str(&format!(
            "if _G['{name}'] ~= nil then error('{name} is there') end\n"
        ));
    }
    config.push_str("if string.dump then error('string.dump is there') end\n");
    config.push_str("if load('\\27LJ') then error('bytecode was loaded') end\n");
    config.push_str("if pcall(include, '/etc/passwd') or pcall(include, '../robot.lua') then error('a file was included') end\n");
    let Some(m) = mount(&config) else { return };
    assert_eq!(m.result(), "config ok: 0 nodes");
}

#[test]
fn files_of_the_search_path_can_be_included_and_may_fail() {
    let board = Board::new();
    board.file(
        "gain.lua",
        "local gain = 3\nreturn function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) * gain) end\n",
    );
    board.file("broken.lua", "\n\nreturn = 1\n");
    board.file("raw", [5]);
    let dir = board.dir().to_str().unwrap().to_owned();
    let config = "trikfs = { n = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1, converter = include('gain.lua') } }";
    let Some(m) = crate::mount_with(board, config, &["--include", &dir]) else {
        return;
    };
    assert_eq!(m.read("n/bin_data").unwrap(), [15]);
    let line = m.apply("include('broken.lua')").unwrap_err();
    assert!(line.contains("broken.lua:3:"), "{line}");
    let line = m.apply("\ninclude('absent.lua')").unwrap_err();
    assert!(
        line.contains("config:2:") && line.contains("absent.lua"),
        "{line}"
    );
    // A changed file reaches only those who load the configuration again.
    m.board().file(
        "gain.lua",
        "return function(a_s, a, b_s, b) ba.set(b, 0, 99) end\n",
    );
    assert_eq!(m.read("n/bin_data").unwrap(), [15]);
    m.apply(config).unwrap();
    assert_eq!(m.read("n/bin_data").unwrap(), [99]);
}

#[test]
fn parameters_are_seen_by_the_converter() {
    let board = Board::new();
    board.file("raw", [5]);
    let Some(m) = mount_on(
        board,
        "local function scaled(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) * params.gain) end
         trikfs = {
           twice = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1, params = { gain = 2 }, converter = scaled },
           thrice = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1, params = { gain = 3 }, converter = scaled },
         }",
    ) else {
        return;
    };
    assert_eq!(
        (
            m.read("twice/bin_data").unwrap(),
            m.read("thrice/bin_data").unwrap()
        ),
        (vec![10], vec![15])
    );
}

#[test]
fn converters_can_be_tried_without_a_mount() {
    let board = Board::new();
    board.file(
        "robot.lua",
        "trikfs = { n = { src = '/absent', input_tuple_size = 2, output_tuple_size = 1,
           converter = function(a_s, a, b_s, b)
             if ba.get(a, 0) == 255 then return false end
             if ba.get(a, 0) == 254 then error('no', 0) end
             ba.set(b, 0, ba.get(a, 0) + ba.get(a, 1))
           end } }",
    );
    let convert = |input: &[u8]| {
        crate::trikfs(
            &board,
            &["convert", "--cache", "cache", "robot.lua", "n"],
            input,
        )
    };
    assert_eq!(
        convert(b"\x20\x21\xff\x00\x22\x20").good().as_bytes(),
        [0x41, 0x42]
    );
    assert_eq!(convert(b"").good(), "");
    let torn = convert(b"\x20\x21\x20");
    assert_eq!((torn.code(), torn.stdout.as_str()), (1, "A"));
    assert_eq!(
        torn.stderr,
        "trikfs: node n: the input ends 1 bytes into a tuple of 2\n"
    );
    let words = ["convert", "--keep-going", "robot.lua", "n"];
    let both = crate::trikfs(&board, &words, b"\xfe\x00\x20\x21\x20");
    assert_eq!((both.code(), both.stdout.as_str()), (1, "A"));
    let told = both.stderr;
    assert!(
        told.contains("1 of 2 tuples were refused") && told.contains("the input ends 1 bytes"),
        "{told}"
    );
    let fault = convert(b"\x20\x21\xfe\x00");
    assert_eq!((fault.code(), fault.stdout.as_str()), (1, "A"));
    assert!(
        fault.stderr.contains("tuple 2 at byte 2 (fe00): no"),
        "{}",
        fault.stderr
    );
    let absent = crate::trikfs(&board, &["convert", "robot.lua", "m"], b"");
    assert_eq!(absent.code(), 1);
    assert!(
        absent.stderr.contains("there is no node m; there are: n"),
        "{}",
        absent.stderr
    );
}
