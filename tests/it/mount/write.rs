//! Writing: whole tuples reach the device, a rest is kept, text becomes tuples, refusals say why.

use crate::{mount, mount_on};
use harness::Board;
use std::io::Read;
use std::os::unix::fs::FileExt;

const MOTOR: &str = "trikfs = { motor = {
  src = '$DIR/motor', input_tuple_size = 2, output_tuple_size = 2, format = 'i8 left, u8 right',
  converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 1); ba.set(b, 1, ba.get(a, 1) + 1) end,
} }";

#[test]
fn whole_tuples_pass_through_the_converter_to_the_device() {
    let board = Board::new();
    let mut motor = board.pipe("motor");
    let Some(m) = mount_on(board, MOTOR) else {
        return;
    };
    // A write has returned when its bytes are with the device, so nothing has to be waited for.
    let mut take = |size: usize| {
        let mut got = vec![0; 16];
        let n = motor.read(&mut got).unwrap();
        assert_eq!(n, size);
        got.truncate(n);
        got
    };
    m.sh("printf abcd > motor/device");
    assert_eq!(take(4), b"bcde");
    m.sh("printf ab | dd of=motor/device bs=1 conv=notrunc 2>/dev/null");
    assert_eq!(take(2), b"bc");
    m.sh("echo 5 6 > motor/value");
    assert_eq!(take(2), [6, 7]);
    m.sh("echo -1 > motor/value0");
    assert_eq!(take(2), [0, 7]);
    m.sh("echo 9 > motor/value1");
    assert_eq!(take(2), [0, 10]);
    m.sh("printf xy > motor/bin_data");
    assert_eq!(take(2), b"yz");
}

#[test]
fn an_incomplete_tuple_is_kept_and_at_close_an_error() {
    let board = Board::new();
    board.file("motor", "..");
    let Some(m) = mount_on(board, MOTOR) else {
        return;
    };
    m.python(
        "fd = os.open(M + '/motor/device', os.O_WRONLY)
assert os.write(fd, b'a') == 1
assert open(D + '/motor', 'rb').read() == b'..'
assert os.write(fd, b'bc') == 2
assert open(D + '/motor', 'rb').read() == b'bc'
expect('EINVAL', os.close, fd)
assert open(D + '/motor', 'rb').read() == b'bc'
fd = os.open(M + '/motor/device', os.O_WRONLY)
assert os.write(fd, b'') == 0
os.close(fd)
",
    );
    assert_eq!(m.text("motor/fault"), "");
    let line = "motor: caller: 1 bytes were written after the last whole tuple of 2\n";
    assert!(m.log().contains(line), "{}", m.log());
}

#[test]
fn text_that_means_nothing_or_does_not_fit_is_refused() {
    let board = Board::new();
    board.file("motor", "..");
    let Some(m) = mount_on(board, MOTOR) else {
        return;
    };
    m.python(
        "def write(file, data):
    fd = os.open(M + '/motor/' + file, os.O_WRONLY)
    try:
        return os.write(fd, data)
    finally:
        os.close(fd)
for data in (b'', b'\\n', b'fast', b'1 x', b'1', b'1 2 3', b'1,2', b'\\xff\\xfe', b'1 2\\0', b'nan 1', b'1.5 2'):
    if data: expect('EINVAL', write, 'value', data)
for data in (b'128 0', b'-129 0', b'0 256', b'0 -1', b'99999999999999999999 0'):
    expect('ERANGE', write, 'value', data)
expect('EINVAL', write, 'value0', b'5')
expect('EINVAL', write, 'value0', b'two')
for data in (b'a', b'abc'):
    expect('EINVAL', write, 'bin_data', data)
assert open(D + '/motor', 'rb').read() == b'..'
assert write('value', b' 1\\t2 \\n') == 6
expect('ERANGE', write, 'value0', b'200')
expect('EINVAL', write, 'value0', b'two')
assert open(D + '/motor', 'rb').read() == b'\\x02\\x03'
",
    );
}

#[test]
fn directions_may_have_converters_of_their_own() {
    let board = Board::new();
    board.file("motor", "\x05");
    let Some(m) = mount_on(
        board,
        "trikfs = { motor = {
          src = '$DIR/motor', input_tuple_size = 1, output_tuple_size = 4, format = 'i32 speed',
          converter = function(a_s, a, b_s, b) ba.i32(b, 0, ba.get(a, 0) * 100) end,
          write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.i32(a, 0) / 100) end,
        } }",
    ) else {
        return;
    };
    assert_eq!(m.text("motor/value"), "500\n");
    m.sh("echo 1200 > motor/value");
    assert_eq!(m.board().content("motor"), [12]);
    assert_eq!(m.text("motor/value0"), "1200\n");
    m.python("with open(M + '/motor/device', 'wb', 0) as file: assert file.write(struct.pack('<i', 700)) == 4");
    assert_eq!(m.board().content("motor"), [7]);
}

#[test]
fn what_the_device_says_reaches_the_writer() {
    let Some(m) = mount(
        "trikfs = {
          full = { src = '/dev/full', input_tuple_size = 1 },
          lonely = { src = '$DIR/lonely', input_tuple_size = 1 },
          absent = { src = '$DIR/absent', input_tuple_size = 1 },
          slow = { src = '$DIR/slow', input_tuple_size = 4096, timeout_ms = 50 },
          null = { src = '/dev/null', input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    m.board().fifo("lonely");
    let _slow = m.board().pipe("slow");
    m.python(
        "def write(file, data):
    fd = os.open(M + '/' + file, os.O_WRONLY)
    try:
        return os.write(fd, data)
    finally:
        os.close(fd)
expect('EIO', write, 'full/device', b'x')
expect('ENODEV', write, 'lonely/device', b'x')
expect('ENODEV', write, 'absent/device', b'x')
assert write('null/device', b'x' * 100000) == 100000
def fill():
    for _ in range(1000): write('slow/device', bytes(4096))
start = time.monotonic()
expect('ETIMEDOUT', fill)
assert time.monotonic() - start < 60
",
    );
    assert!(
        m.text("full/fault").starts_with("device: /dev/full"),
        "{}",
        m.text("full/fault")
    );
    assert!(
        m.text("slow/fault")
            .contains("took 0 of 4096 bytes in 50 ms"),
        "{}",
        m.text("slow/fault")
    );
}

#[test]
fn a_fault_of_the_converter_is_met_by_the_writer_and_reaches_no_device() {
    let board = Board::new();
    board.file("motor", ".");
    let Some(m) = mount_on(
        board,
        "trikfs = { motor = { src = '$DIR/motor', input_tuple_size = 1, output_tuple_size = 1,
          converter = function(a_s, a, b_s, b)
            if ba.get(a, 0) == 33 then error('too fast', 0) end
            ba.set(b, 0, ba.get(a, 0))
          end } }",
    ) else {
        return;
    };
    m.python(
        "fd = os.open(M + '/motor/device', os.O_WRONLY)
expect('EIO', os.write, fd, b'!')
assert open(M + '/motor/fault').read() == 'converter: too fast\\n'
assert open(D + '/motor', 'rb').read() == b'.'
assert os.write(fd, b'ab!') == 2
expect('EIO', os.write, fd, b'!')
assert os.write(fd, b'c') == 1
assert open(D + '/motor', 'rb').read() == b'c'
assert open(M + '/motor/fault').read() == ''
os.close(fd)
",
    );
    assert!(m.stat("motor", "writes") >= 2.0);
}

#[test]
fn who_reads_after_a_write_gets_nothing_from_before_it() {
    let board = Board::new();
    board.file("position", "abcd");
    let Some(m) = mount_on(
        board,
        "trikfs = { e = { src = '$DIR/position', input_tuple_size = 4, output_tuple_size = 4, format = 'u8 a, u8 b, u8 c, u8 d',
  poll_ms = 3600000,
} }",
    ) else {
        return;
    };
    harness::eventually("the first sample", || m.stat("e", "samples") > 0.0);
    assert_eq!(m.text("e/value"), "97 98 99 100\n");
    // A small tuple: its reads come from the page cache.
    let cached = m.open("e/bin_data");
    let mut seen = [0; 4];
    for (told, bytes) in [("1 2 3 4", [1, 2, 3, 4]), ("5 6 7 8", [5, 6, 7, 8])] {
        cached.read_exact_at(&mut seen, 0).unwrap();
        m.sh(&format!("echo {told} > e/value"));
        assert_eq!(m.text("e/value"), format!("{told}\n"));
        cached.read_exact_at(&mut seen, 0).unwrap();
        assert_eq!(seen, bytes);
    }
    m.sh("printf wxyz > e/device");
    assert_eq!(m.text("e/value"), "119 120 121 122\n");
    assert_eq!(m.read("e/bin_data").unwrap(), b"wxyz");
}

#[test]
fn what_was_sampled_before_a_write_is_not_shown_while_the_next_sample_takes_long() {
    let board = Board::new();
    board.file("position", "abcd");
    // Each sample takes some tenths of a second: longer than a write waits for it, and less than its budget. A program for
    // ARM is emulated, and some fifty times as slow.
    let loops = if crate::is_of_the_controller() {
        "5e6"
    } else {
        "2e8"
    };
    let config = "trikfs = { e = { src = '$DIR/position', input_tuple_size = 4, output_tuple_size = 4, format = 'u8 a, u8 b, u8 c, u8 d',
  poll_ms = 3600000, timeout_ms = 20000, budget_us = 10000000,
  converter = function(a_s, a, b_s, b)
    local sum = 0
    for i = 1, LOOPS do sum = sum + i end
    for i = 0, 3 do ba.u8(b, i, sum > 0 and ba.u8(a, i) or 0) end
  end,
} }"
        .replace("LOOPS", loops);
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    harness::eventually("the first sample", || m.stat("e", "samples") > 0.0);
    let cached = m.open("e/bin_data");
    let mut seen = [0; 4];
    cached.read_exact_at(&mut seen, 0).unwrap();
    assert_eq!(&seen, b"abcd");
    m.sh("printf wxyz > e/device");
    m.python(
        "fd = open_ro(M + '/e/value', os.O_NONBLOCK)
expect('EAGAIN', os.read, fd, 100)
",
    );
    assert_eq!(m.text("e/value"), "119 120 121 122\n");
    // The page goes a moment later than the sample.
    harness::eventually("the new bytes", || {
        cached
            .read_exact_at(&mut seen, 0)
            .is_ok_and(|()| &seen == b"wxyz")
    });
}
