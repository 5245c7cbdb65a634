//! Reading `device`: any read size, waiting, and being ended while waiting.

use crate::{mount, waiting_readers_can_be_killed};
use std::io::Write;

/// Four bytes in, four bytes out, each one more.
const MORE: &str = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, output_tuple_size = 4,
  converter = function(a_s, a, b_s, b) for i = 0, 3 do ba.set(b, i, ba.get(a, i) + 1) end end } }";

#[test]
fn any_read_size_gives_the_same_bytes() {
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "source = bytes(i * 7 % 251 for i in range(4000))
for sizes in ([1], [2], [3], [4], [5], [7], [64], [1, 2, 3, 4, 5, 6, 7, 8, 9], [100, 1], [5000]):
    fd, pipe = open_ro(M + '/n/device'), feed('in')
    got, turn = b'', 0
    for start in range(0, len(source), 400):
        os.write(pipe, source[start:start + 400])
        while len(got) < start + 400:
            size = sizes[turn % len(sizes)]
            turn += 1
            piece = os.read(fd, size)
            assert 0 < len(piece) <= size, (size, piece)
            got += piece
    assert got == bytes((byte + 1) % 256 for byte in source), sizes
    os.close(fd)
    os.close(pipe)
",
    );
}

#[test]
fn a_torn_tuple_waits_for_its_rest() {
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "fd, pipe = open_ro(M + '/n/device', os.O_NONBLOCK), feed('in')
expect('EAGAIN', os.read, fd, 4)
os.write(pipe, b'abc')
assert ready(fd, ms=30) == []
expect('EAGAIN', os.read, fd, 4)
os.write(pipe, b'def')
assert ready(fd, ms=60000)
assert os.read(fd, 100) == b'bcde'
expect('EAGAIN', os.read, fd, 4)
os.write(pipe, b'gh')
assert ready(fd, ms=60000)
assert os.read(fd, 3) == b'fgh'
assert ready(fd)
assert os.read(fd, 3) == b'i'
",
    );
}

#[test]
fn the_tools_of_the_shell_read_streams() {
    let tools = [
        ("head -c 3 n/device", "bcd"),
        ("cat n/device", "bcdefghi"),
        ("dd if=n/device bs=1 count=4 2>/dev/null", "bcde"),
        (
            "dd if=n/device bs=3 count=3 iflag=fullblock 2>/dev/null",
            "bcdefghi",
        ),
        ("od -An -c -N4 n/device | tr -d ' '", "bcde"),
    ];
    // A tree for each: who closes a stream takes along what it has not read.
    for (tool, expected) in tools {
        let Some(m) = mount(MORE) else { return };
        m.board().fifo("in");
        let script = format!("printf abcdefgh > $DIR/in & {tool}; wait");
        assert_eq!(m.sh(&script).trim_end(), expected, "{tool}");
    }
}

#[test]
fn a_reader_that_waits_gets_what_comes() {
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "pipe = feed('in')
for end in (4, 8, 12):
    read_end, write_end = os.pipe()
    fd = open_ro(M + '/n/device')
    child = forked(lambda: os.write(write_end, os.read(fd, 100)))
    eventually(lambda: asleep(child), 'a reader that waits')
    os.write(pipe, b'wxyz')
    assert os.read(read_end, 100) == b'xyz{'
    assert ended(child) == 0
    os.close(fd)
",
    );
}

#[test]
fn a_signal_ends_a_reader_that_waits_at_once() {
    if !waiting_readers_can_be_killed() {
        return;
    }
    let Some(m) = mount(MORE) else { return };
    let mut pipe = m.board().pipe("in");
    m.python(
        "for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
    child = subprocess.Popen(['cat', M + '/n/device'])
    eventually(lambda: has_open(child.pid, '/n/device'), 'cat to open')
    eventually(lambda: asleep(child.pid), 'cat to wait')
    child.send_signal(number)
    assert child.wait(LIMIT) == -number
",
    );
    pipe.write_all(b"abcd").unwrap();
}

#[test]
fn a_signal_handler_interrupts_a_wait_and_reading_goes_on_afterwards() {
    if !waiting_readers_can_be_killed() {
        return;
    }
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "class Alarm(Exception): pass
def handler(*_): raise Alarm
signal.signal(signal.SIGALRM, handler)
fd, pipe = open_ro(M + '/n/device'), feed('in')
for _ in range(3):
    signal.setitimer(signal.ITIMER_REAL, 0.02)
    try:
        os.read(fd, 4)
        raise AssertionError('read returned')
    except Alarm:
        pass
    os.write(pipe, b'abcd')
    assert os.read(fd, 4) == b'bcde'
",
    );
}

#[test]
fn a_killed_reader_takes_no_data_with_it() {
    if !waiting_readers_can_be_killed() {
        return;
    }
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
child = forked(lambda: os.read(fd, 4))
eventually(lambda: asleep(child), 'a reader that waits')
os.kill(child, signal.SIGKILL)
assert ended(child) == -signal.SIGKILL
os.write(pipe, b'abcd')
assert os.read(fd, 4) == b'bcde'
",
    );
}

#[test]
fn nonblocking_follows_fcntl() {
    let Some(m) = mount(MORE) else { return };
    m.board().fifo("in");
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
flags = fcntl.fcntl(fd, fcntl.F_GETFL)
for _ in range(3):
    fcntl.fcntl(fd, fcntl.F_SETFL, flags | os.O_NONBLOCK)
    expect('EAGAIN', os.read, fd, 4)
    fcntl.fcntl(fd, fcntl.F_SETFL, flags)
    os.write(pipe, b'abcd')
    assert os.read(fd, 4) == b'bcde'
",
    );
}

#[test]
fn a_state_is_sampled_anew_at_offset_zero_and_ends() {
    let Some(m) = mount(
        "trikfs = {
          file = { src = '$DIR/file', input_tuple_size = 2 },
          turn = { src = fake{ data = 'aabbcc', period_ms = 0, loop = true }, input_tuple_size = 2 },
          up = { src = '/proc/uptime', input_tuple_size = 64 },
        }",
    ) else {
        return;
    };
    m.board().file("file", "112233");
    assert_eq!(
        m.sh("cat file/device; dd if=file/device bs=1 2>/dev/null; head -c 3 file/device"),
        "112233112233112"
    );
    m.python(
        "fd = open_ro(M + '/file/device')
assert os.pread(fd, 2, 0) == b'11'
with open(D + '/file', 'r+b') as file: file.write(b'99')
assert os.pread(fd, 2, 0) == b'99'
assert os.pread(fd, 2, 2) == b'22' and os.pread(fd, 3, 1) == b'922'
os.lseek(fd, 0, os.SEEK_SET)
assert os.read(fd, 6) == b'992233' and os.read(fd, 6) == b''
fd = open_ro(M + '/turn/device')
assert [os.pread(fd, 2, 0) for _ in range(4)] == [b'aa', b'bb', b'cc', b'aa']
assert ready(fd)
fd = open_ro(M + '/up/device')
first = os.pread(fd, 64, 0)
eventually(lambda: os.pread(fd, 64, 0) != first, 'another uptime')
",
    );
}

#[test]
fn a_stream_has_no_position_and_serves_large_reads() {
    let Some(m) = mount(
        "trikfs = { z = { src = '/dev/zero', input_tuple_size = 3 }, u = { src = '/dev/urandom', input_tuple_size = 8 } }",
    ) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/z/device')
expect('ESPIPE', os.lseek, fd, 0, os.SEEK_SET)
expect('ESPIPE', os.pread, fd, 4, 0)
assert len(read_exactly(fd, 3 << 20)) == 3 << 20
assert os.read(fd, 0) == b''
one = open_ro(M + '/u/device')
assert read_exactly(one, 100000) != read_exactly(one, 100000)
",
    );
    assert_eq!(
        m.sh("dd if=z/device bs=1M count=4 iflag=fullblock 2>/dev/null | wc -c")
            .trim(),
        "4194304"
    );
}

#[test]
fn a_parallel_write_is_not_held_up_by_a_read_that_waits() {
    let Some(m) = mount("trikfs = { n = { src = '$DIR/in', input_tuple_size = 1 } }") else {
        return;
    };
    m.board().fifo("in");
    // The node reads what is written to it: the pipe is both its source and its sink.
    m.python(
        "pipe = feed('in')
fd = os.open(M + '/n/device', os.O_RDWR)
got = []
reader = threading.Thread(target=lambda: got.append(os.read(fd, 1)), daemon=True)
reader.start()
assert os.write(fd, b'x') == 1
reader.join(LIMIT)
assert got == [b'x'], got
",
    );
}

#[test]
fn what_only_the_page_cache_could_serve_is_refused_and_loses_nothing() {
    let board = harness::Board::new();
    board.fifo("in");
    let Some(m) = crate::mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4 } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'aaaabbbbcccc')
eventually(lambda: select.select([fd], [], [], 0)[0], 'data')
out, into = os.pipe()
expect('EINVAL', os.splice, fd, into, 4)
assert os.read(fd, 12) == b'aaaabbbbcccc'
with open(M + '/status') as status:
    expect('EINVAL', os.sendfile, into, status.fileno(), 0, 100)
    assert status.read().startswith('config ok')
",
    );
    // cp finds its way without them.
    assert!(
        m.sh("cp status $DIR/copy; head -n 1 $DIR/copy")
            .contains("config ok")
    );
}
