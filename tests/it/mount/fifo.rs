//! Named pipes: one opening for all readers, writers that come and go.

use crate::mount_on;
use harness::Board;

fn with_pipe(script: &str) -> Option<harness::Mount> {
    let board = Board::new();
    board.fifo("in");
    let m = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4 } }",
    )?;
    m.python(script);
    Some(m)
}

#[test]
fn two_readers_both_get_every_tuple_from_their_opening_on() {
    with_pipe(
        "one, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'aaaa')
assert os.read(one, 4) == b'aaaa'
two = open_ro(M + '/n/device')
for number in range(500):
    os.write(pipe, struct.pack('<I', number))
    assert os.read(one, 4) == struct.pack('<I', number)
    if number % 100 == 99:
        got = read_exactly(two, 400, 7)
        assert got == b''.join(struct.pack('<I', n) for n in range(number - 99, number + 1))
",
    );
}

#[test]
fn a_slow_reader_loses_the_oldest_and_the_loss_is_counted() {
    let Some(m) = with_pipe(
        "slow, fast, pipe = open_ro(M + '/n/device'), open_ro(M + '/n/device'), feed('in')
for number in range(1000):
    os.write(pipe, struct.pack('<I', number))
    assert os.read(fast, 4) == struct.pack('<I', number)
eventually(lambda: stat_of(M + '/n/stats', 'dropped') == 744, 'the count')
got = read_exactly(slow, 4 * 256)
assert got == b''.join(struct.pack('<I', n) for n in range(744, 1000))
os.set_blocking(slow, False)
expect('EAGAIN', os.read, slow, 4)
",
    ) else {
        return;
    };
    assert_eq!(m.stat("n", "dropped"), 744.0);
}

#[test]
fn the_last_writer_that_leaves_ends_the_file_once_and_the_next_one_begins_anew() {
    with_pipe(
        "fds = [open_ro(M + '/n/device') for _ in range(2)]
for round in (b'aaaa', b'bbbb', b'cccc'):
    first = os.open(D + '/in', os.O_WRONLY)
    second = os.open(D + '/in', os.O_WRONLY)
    os.write(first, round)
    os.close(first)
    os.write(second, round)
    os.close(second)
    for fd in fds:
        assert read_exactly(fd, 8) == round * 2
        assert os.read(fd, 8) == b''
",
    );
}

#[test]
fn who_opens_after_the_end_sees_neither_it_nor_what_came_before() {
    with_pipe(
        "for turn in range(200):
    old, pipe = open_ro(M + '/n/device'), feed('in')
    os.write(pipe, b'past')
    os.close(pipe)
    new = open_ro(M + '/n/device', os.O_NONBLOCK)
    expect('EAGAIN', os.read, new, 4)
    assert os.read(old, 8) == b'past'
    assert os.read(old, 8) == b''
    os.close(old)
    os.close(new)
",
    );
}

#[test]
fn no_writer_yet_is_no_end() {
    with_pipe(
        "fd = open_ro(M + '/n/device', os.O_NONBLOCK)
expect('EAGAIN', os.read, fd, 4)
assert ready(fd, ms=20) == []
expect('EAGAIN', os.read, fd, 4)
",
    );
}

#[test]
fn an_end_inside_a_tuple_is_a_fault_and_the_torn_tuple_is_never_converted() {
    let Some(m) = with_pipe(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'aaaabb')
assert os.read(fd, 8) == b'aaaa'
os.close(pipe)
assert os.read(fd, 8) == b''
assert text(M + '/n/fault') == 'device: the source ended inside a tuple: Input/output error (os error 5)\\n', text(M + '/n/fault')
pipe = feed('in')
os.write(pipe, b'cccc')
assert os.read(fd, 8) == b'cccc'
",
    ) else {
        return;
    };
    assert_eq!(m.stat("n", "faults"), 1.0);
}

#[test]
fn what_programs_write_arrives_whole() {
    with_pipe(
        "pipe = feed('in')
sink = os.open(M + '/n/device', os.O_WRONLY)
os.write(sink, b'ab')
expect('EAGAIN', os.read, pipe, 100)
os.write(sink, b'cdef')
assert os.read(pipe, 100) == b'abcd'
os.write(sink, b'gh')
assert os.read(pipe, 100) == b'efgh'
os.close(sink)
",
    );
}

#[test]
fn readers_that_come_and_go_do_not_disturb_one_that_stays() {
    with_pipe(
        "stays, pipe = open_ro(M + '/n/device'), feed('in')
stop = threading.Event()
def visit():
    while not stop.is_set():
        fd = open_ro(M + '/n/device', os.O_NONBLOCK)
        error_of(os.read, fd, 4)
        os.close(fd)
visitors = [threading.Thread(target=visit) for _ in range(3)]
for visitor in visitors: visitor.start()
try:
    for number in range(2000):
        os.write(pipe, struct.pack('<I', number))
        assert os.read(stays, 4) == struct.pack('<I', number)
finally:
    stop.set()
    for visitor in visitors: visitor.join()
",
    );
}

#[test]
fn a_pipe_may_also_be_opened_by_each_reader_for_itself() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, share = false } }",
    ) else {
        return;
    };
    m.python(
        "one, two, pipe = open_ro(M + '/n/device', os.O_NONBLOCK), open_ro(M + '/n/device', os.O_NONBLOCK), feed('in')
os.write(pipe, b'x')
assert ready(one, ms=60000)
assert os.read(one, 1) == b'x'
expect('EAGAIN', os.read, two, 1)
",
    );
}

#[test]
fn a_pipe_that_was_deleted_and_made_again_is_found() {
    with_pipe(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'aaaa')
assert os.read(fd, 4) == b'aaaa'
os.close(pipe)
os.unlink(D + '/in')
os.mkfifo(D + '/in')
def reads_again():
    try:
        writer = os.open(D + '/in', os.O_WRONLY | os.O_NONBLOCK)
    except OSError:
        return False
    os.write(writer, b'bbbb')
    os.close(writer)
    return True
eventually(reads_again, 'the new pipe has a reader')
os.set_blocking(fd, False)
def got():
    try:
        return os.read(fd, 4) == b'bbbb'
    except OSError:
        return False
eventually(got, 'what the new pipe carries')
",
    );
}
