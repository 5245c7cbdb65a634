//! `attributes`: further files in a node's directory, each a description of its own.

use crate::mount_on;
use harness::Board;

#[test]
fn attributes_are_text_files_with_sources_of_their_own() {
    let board = Board::new();
    board.file("motor", [0; 4]);
    board.file("speed", [0; 2]);
    board.file("mode", [1]);
    let Some(m) = mount_on(
        board,
        "trikfs = { motors = { left = {
          src = '$DIR/motor', input_tuple_size = 4, format = 'i32 position',
          attributes = {
            speed = { src = '$DIR/speed', input_tuple_size = 2, format = 'i16 speed' },
            mode = { src = '$DIR/mode', input_tuple_size = 1, mode = '0444' },
            doubled = { src = '$DIR/mode', input_tuple_size = 1, output_tuple_size = 1,
              converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) * 2) end },
          },
        } } }",
    ) else {
        return;
    };
    let files = "bin_data device doubled fault format mode poll_ms speed stats units value value0";
    assert_eq!(m.sh("echo $(ls motors/left)"), format!("{files}\n"));
    assert_eq!(
        m.sh("cd motors/left; cat value speed mode doubled"),
        "0\n0\n1\n2\n"
    );
    m.sh("cd motors/left; echo -300 > speed");
    assert_eq!(m.board().content("speed"), (-300i16).to_le_bytes());
    assert_eq!(m.sh("cd motors/left; cat speed"), "-300\n");
    assert_eq!(
        m.write("motors/left/mode", "1").unwrap_err().raw_os_error(),
        Some(libc::EACCES)
    );
    assert_eq!(
        m.write("motors/left/speed", "99999")
            .unwrap_err()
            .raw_os_error(),
        Some(libc::ERANGE)
    );
}

#[test]
fn an_attribute_may_not_take_the_name_of_a_file() {
    let Some(m) = mount_on(Board::new(), "trikfs = {}") else {
        return;
    };
    for name in [
        "device", "value", "value0", "value12", "bin_data", "units", "format", "poll_ms", "fault",
        "stages", "stats",
    ] {
        let config = format!(
            "trikfs = {{ n = {{ src = '/dev/zero', input_tuple_size = 1, attributes = {{ {name} = {{ src = '/dev/zero', input_tuple_size = 1 }} }} }} }}"
        );
        let line = m.apply(&config).expect_err(name);
        assert!(line.contains(name), "{line}");
    }
}

#[test]
fn a_changed_attribute_leaves_its_node_alone() {
    let board = Board::new();
    board.fifo("in");
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, attributes = { a = { src = '/dev/zero', input_tuple_size = 1 } } } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    m.python(
        "fd, attribute, pipe = open_ro(M + '/n/device'), open_ro(M + '/n/a'), feed('in')
os.write(pipe, b'x')
config = open(M + '/config').read()
with open(M + '/config', 'w') as file: file.write(config.replace('/dev/zero', '/dev/urandom'))
assert os.read(fd, 1) == b'x'
expect('ESTALE', os.pread, attribute, 1, 0)
",
    );
}
