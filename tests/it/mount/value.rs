//! `bin_data`, `value`, `valueN`: the newest value, as bytes and as text, fresh or not at all.

use crate::{mount, mount_on};
use harness::Board;
use std::io::Write;

#[test]
fn values_are_text_on_one_line_and_single_numbers() {
    let board = Board::new();
    board.file("raw", [1, 0xff, 0x2c, 1, 0, 0, 0x80, 0x3f]);
    let Some(m) = mount_on(
        board,
        "trikfs = {
          plain = { src = '$DIR/raw', input_tuple_size = 4 },
          fields = { src = '$DIR/raw', input_tuple_size = 8, format = 'u8 flags, i8 t, u16 n, f32 v', units = 'mixed' },
          big = { src = '$DIR/raw', input_tuple_size = 4, format = '>u16 a, >i16 b' },
        }",
    ) else {
        return;
    };
    assert_eq!(m.text("plain/value"), "1 255 44 1\n");
    assert_eq!(m.text("fields/value"), "1 -1 300 1\n");
    assert_eq!(m.text("fields/value0"), "1\n");
    assert_eq!(m.text("fields/value1"), "-1\n");
    assert_eq!(m.text("fields/value2"), "300\n");
    assert_eq!(m.text("fields/value3"), "1\n");
    assert_eq!(m.text("fields/units"), "mixed\n");
    assert_eq!(m.text("big/value"), "511 11265\n");
    let format = m.text("fields/format");
    assert!(
        format.contains("u8 flags") && format.ends_with('\n'),
        "{format}"
    );
    assert_eq!(m.read("fields/bin_data").unwrap(), m.board().content("raw"));
    assert!(!m.path("plain/value0").exists());
}

#[test]
fn reading_again_at_the_beginning_samples_again_and_reading_on_does_not() {
    let Some(m) = mount(
        "trikfs = { n = { src = fake{ data = '\\1\\0\\2\\0\\3\\0\\4\\0', period_ms = 0, loop = true }, input_tuple_size = 2, format = 'u16 x' } }",
    ) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/n/bin_data')
assert [os.pread(fd, 2, 0) for _ in range(3)] == [b'\\1\\0', b'\\2\\0', b'\\3\\0']
assert os.read(fd, 100) == b'\\4\\0'
assert os.read(fd, 100) == b''
os.lseek(fd, 0, os.SEEK_SET)
assert os.read(fd, 1) == b'\\1' and os.read(fd, 1) == b'\\0' and os.read(fd, 1) == b''
",
    );
    assert_eq!(m.sh("dd if=n/value bs=1 2>/dev/null"), "1\n");
    assert_eq!(m.sh("cat n/value; cat n/value0"), "1\n1\n");
}

#[test]
fn a_first_value_that_is_on_its_way_is_waited_for_no_longer_than_the_time_limit() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "local never = function() return false end
         trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, format = 'u8 x', on_event = true, timeout_ms = 300, converter = never } }",
    ) else {
        return;
    };
    m.python(
        "pipe = feed('in')
os.write(pipe, b'\\x2a')
def late():
    start = time.monotonic()
    failed = error_of(open(M + '/n/value', 'rb').read)
    return failed == 'ETIMEDOUT' and 0.29 < time.monotonic() - start < 60
eventually(late, 'the end of the time, once the source has spoken')
for name in ('value', 'bin_data'):
    expect('ETIMEDOUT', lambda: open(M + '/n/' + name, 'rb').read())
    expect('EAGAIN', os.read, open_ro(M + '/n/' + name, os.O_NONBLOCK), 10)
",
    );
}

#[test]
fn a_source_that_has_never_spoken_says_so_at_once_and_can_be_waited_for() {
    let board = Board::new();
    for name in ["in", "in2", "in3"] {
        board.fifo(name);
    }
    let Some(m) = mount_on(
        board,
        "trikfs = {
           heard = { src = '$DIR/in', format = 'u8 x', on_event = true, timeout_ms = 60000 },
           asked = { src = '$DIR/in2', format = 'u8 x', timeout_ms = 60000 },
           polled = { src = '$DIR/in3', format = 'u8 x', poll_ms = 20, timeout_ms = 60000 },
           alias = { src = 'trikfs:polled', format = 'u8 x', timeout_ms = 60000 },
           newest = { src = 'newest:heard', format = 'u8 x', poll_ms = 20, timeout_ms = 60000 },
           both = { src = { 'trikfs:polled', 'newest:heard' }, format = 'u8 x, u8 y', on_event = true, timeout_ms = 60000 } }",
    ) else {
        return;
    };
    m.python(
        "import select
def soon(name):
    start = time.monotonic()
    expect('ENODATA', open(M + '/' + name, 'rb', buffering=0).read)
    return time.monotonic() - start
def nonblocking(name):
    expect('EAGAIN', os.read, open_ro(M + '/' + name, os.O_NONBLOCK), 10)
nodes = ('heard', 'asked', 'polled', 'alias', 'newest', 'both')
for node in nodes:
    for name in ('value', 'bin_data', 'value0'):
        # The least of some, for a machine that is busy; who waits waits for a minute.
        took = min(soon(node + '/' + name) for _ in range(5))
        assert took <= 5, (node, name, took)
        nonblocking(node + '/' + name)
    assert open(M + '/' + node + '/fault').read() == '', node
log = os.read(open_ro(M + '/log'), 65536)
assert b'heard: caller: nothing has come from the source since it was opened' in log, log
assert b'newest: caller: nothing has come' in log, log
# Who polls has chosen to wait.
fd = open_ro(M + '/asked/value')
poll = select.poll()
poll.register(fd, select.POLLIN)
assert poll.poll(100) == []
pipe = feed('in2')
os.write(pipe, b'\\x2a')
assert poll.poll(60000) != []
assert os.read(fd, 100) == b'42\\n'
# What has spoken once is waited for.
pipe1, pipe3 = feed('in'), feed('in3')
os.write(pipe1, b'\\x01')
os.write(pipe3, b'\\x02')
for node, text in (('heard', b'1\\n'), ('polled', b'2\\n'), ('newest', b'1\\n')):
    eventually(lambda: error_of(open(M + '/' + node + '/value', 'rb').read) is None, node)
    assert open(M + '/' + node + '/value', 'rb').read() == text, node
",
    );
}

#[test]
fn a_value_that_is_too_old_is_an_error_until_there_is_a_new_one() {
    for pace in [
        "poll_ms = 10, timeout_ms = 150",
        "poll_ms = 10, max_age_ms = 150",
        "on_event = true, max_age_ms = 150",
    ] {
        grows_old(pace);
    }
}

fn grows_old(pace: &str) {
    let board = Board::new();
    let mut pipe = board.pipe("in");
    let Some(m) = mount_on(
        board,
        &format!(
            "trikfs = {{ n = {{ src = '$DIR/in', input_tuple_size = 4, format = 'u32 x', {pace} }} }}"
        ),
    ) else {
        return;
    };
    for number in 1u32..=3 {
        harness::eventually("a fresh value", || {
            pipe.write_all(&number.to_le_bytes()).unwrap();
            m.errno("n/value") == 0
        });
        harness::eventually("this value", || {
            m.errno("n/value") != 0 || m.text("n/value") == format!("{number}\n")
        });
        harness::eventually("the error of an old value", || {
            m.errno("n/value") == libc::ETIMEDOUT
        });
        assert_eq!(m.errno("n/bin_data"), libc::ETIMEDOUT);
        assert_eq!(m.errno("n/value0"), libc::ETIMEDOUT);
    }
}

#[test]
fn a_number_that_is_none_is_an_error_never_a_value() {
    let board = Board::new();
    board.file("raw", [0, 0, 0xc0, 0x7f]);
    let config = "trikfs = { n = { src = '$DIR/raw', input_tuple_size = 4, format = 'f32 x' } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    for file in ["value", "value0", "bin_data"] {
        assert_eq!(m.errno(&format!("n/{file}")), libc::EIO, "{file}");
    }
    assert!(
        m.text("n/fault").starts_with("converter: "),
        "{}",
        m.text("n/fault")
    );
    m.board().file("raw", 1.5f32.to_le_bytes());
    assert_eq!(m.text("n/value"), "1.5\n");
    assert_eq!(m.text("n/fault"), "");
}

#[test]
fn the_period_can_be_read_and_changed() {
    let Some(m) = mount(
        "trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 3600000 }, r = { src = '/dev/zero', input_tuple_size = 1 } }",
    ) else {
        return;
    };
    assert_eq!(
        (m.text("n/poll_ms"), m.text("r/poll_ms")),
        ("3600000\n".to_owned(), "0\n".to_owned())
    );
    harness::eventually("the first sample", || m.stat("n", "samples") > 0.0);
    let errno = |text: &str| {
        m.write("n/poll_ms", text)
            .err()
            .map_or(0, |error| error.raw_os_error().unwrap())
    };
    assert_eq!(errno("0"), libc::ERANGE);
    assert_eq!(errno("-1"), libc::ERANGE);
    assert_eq!(errno("3600001"), libc::ERANGE);
    assert_eq!(errno("soon"), libc::EINVAL);
    assert_eq!(errno(""), 0);
    m.sh("echo 1 > n/poll_ms");
    assert_eq!(m.text("n/poll_ms"), "1\n");
    harness::eventually("many samples", || m.stat("n", "samples") > 50.0);
    m.sh("echo 3600000 > n/poll_ms");
    assert!(m.write("r/poll_ms", "5").is_err());
}

#[test]
fn reading_values_disturbs_no_stream_and_no_other_reader() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, format = 'u32 x', on_event = true } }",
    ) else {
        return;
    };
    m.python(
        "stream, pipe = open_ro(M + '/n/device'), feed('in')
for number in range(200):
    os.write(pipe, struct.pack('<I', number))
    assert os.read(stream, 4) == struct.pack('<I', number)
    eventually(lambda: text(M + '/n/value') == '%d\\n' % number, 'value %d' % number)
    # The page cache gets it after `value`; whatever it is that is read meanwhile, it is a sample.
    eventually(lambda: open(M + '/n/bin_data', 'rb').read() == struct.pack('<I', number), 'bytes of %d' % number)
    assert text(M + '/n/value') == '%d\\n' % number
",
    );
}

#[test]
fn a_plain_stream_gives_its_newest_value_without_background_sampling() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1 }, u = { src = '/dev/urandom', input_tuple_size = 8, format = 'u64 x' } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/value'), feed('in')
os.write(pipe, b'\\1\\2\\3')
eventually(lambda: os.pread(fd, 10, 0) == b'3\\n', 'the newest')
assert text(M + '/u/value') != text(M + '/u/value')
",
    );
}
