//! `read_back`: what was written is read while the device still has it, also where several tuples become the same bytes.

use crate::{mount_on, trikfs};
use harness::{Board, Mount};

/// Percent to halves of percent: 30 and 31 become the same byte.
const ROBOT: &str = "
local function write(a_s, a, b_s, b) ba.set(b, 0, (ba.i16(a, 0) - ba.i16(a, 0) % 2) / 2) end
local function read(a_s, a, b_s, b) ba.i16(b, 0, 2 * ba.get(a, 0)) end
trikfs = {
  motor = { src = '$DIR/motor', input_tuple_size = 1, format = 'i16 power', rest = 0, read_back = true,
    converter = read, write_converter = write,
    attributes = {
      raw = { src = '$DIR/motor', input_tuple_size = 1 },
      other = { src = '$DIR/motor', input_tuple_size = 1, format = 'i16 power', converter = read, write_converter = write },
      linked = { src = 'trikfs:motor', format = 'i16 power', converter = function(a_s, a, b_s, b) ba.i16(b, 0, ba.i16(a, 0)) end,
        write_converter = function(a_s, a, b_s, b) ba.i16(b, 0, ba.i16(a, 0)) end },
    } },
  plain = { alias = 'motor' },
}";

fn robot() -> Option<Mount> {
    let board = Board::new();
    board.file("motor", [5]);
    mount_on(board, ROBOT)
}

#[test]
fn a_read_shows_what_was_written_by_whatever_file() {
    let Some(m) = robot() else { return };
    m.write("motor/value", "31").unwrap();
    assert_eq!(m.text("motor/value"), "31\n");
    assert_eq!(m.text("plain/value0"), "31\n");
    assert_eq!(m.read("motor/bin_data").unwrap(), [31, 0]);
    assert_eq!(m.read("motor/device").unwrap(), [31, 0]);
    assert_eq!(m.text("motor/raw"), "15\n");
    assert_eq!(m.text("motor/linked"), "31\n");
    assert_eq!(m.text("motor/other"), "30\n", "it has not asked for it");
    m.python(
        "fd = os.open(M + '/motor/device', os.O_WRONLY)
os.write(fd, bytes([33, 0, 35, 0]))
os.close(fd)
",
    );
    assert_eq!(m.text("motor/value"), "35\n");
    m.write("motor/linked", "37").unwrap();
    assert_eq!(m.text("motor/value"), "37\n");
    assert!(m.write("motor/value", "fast").is_err());
    assert_eq!(m.text("motor/value"), "37\n");
}

#[test]
fn other_bytes_of_the_device_and_a_rest_end_it() {
    let Some(m) = robot() else { return };
    m.write("motor/value", "31").unwrap();
    m.board().file("motor", [9]);
    assert_eq!(m.text("motor/value"), "18\n", "somebody else has written");
    m.board().file("motor", [15]);
    assert_eq!(m.text("motor/value"), "30\n", "and it stays forgotten");
    m.write("motor/value", "1").unwrap();
    assert_eq!(m.text("motor/value"), "1\n");
    m.write("stop", "1").unwrap();
    assert_eq!(m.text("motor/raw"), "0\n");
    assert_eq!(m.text("motor/value"), "0\n");
}

#[test]
fn it_needs_a_device_that_keeps_what_is_written() {
    for (node, reason) in [
        (
            "src = '/dev/null', input_tuple_size = 1, read_back = 1",
            "read_back must be true or false, not a number",
        ),
        (
            "src = '/dev/null', input_tuple_size = 1, read_back = true",
            "read_back is for devices that keep what is written, with a converter and a write_converter",
        ),
        (
            "src = fifo{ '/x' }, input_tuple_size = 1, format = 'u8 n', read_back = true, converter = print, write_converter = print",
            "read_back is for devices that keep what is written, with a converter and a write_converter",
        ),
    ] {
        let board = Board::new();
        board.file("robot.lua", format!("trikfs = {{ n = {{ {node} }} }}"));
        let output = trikfs(&board, &["check", "robot.lua"], b"");
        assert_eq!(output.code(), 1, "{node}");
        assert!(output.stderr.contains(reason), "{}", output.stderr);
    }
}
