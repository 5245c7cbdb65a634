//! select, poll and epoll: a wake-up for every datum, and readiness that is true.

use crate::{mount, mount_on};
use harness::Board;

const PLAIN: &str = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4 } }";
/// Every fourth tuple gives one, the others are consumed.
const DECIMATING: &str =
    "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, output_tuple_size = 4,
  converter = (function()
    local count = 0
    return function(a_s, a, b_s, b)
      count = count + 1
      if count % 4 ~= 0 then return false end
      for i = 0, 3 do ba.set(b, i, ba.get(a, i)) end
    end
  end)() } }";

fn with_pipe(config: &str, script: &str) {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(board, config) else {
        return;
    };
    m.python(&format!(
        "fd, pipe = open_ro(M + '/n/device', os.O_NONBLOCK), feed('in')\n{script}"
    ));
}

#[test]
fn select_sees_data_and_its_absence() {
    with_pipe(
        PLAIN,
        "for _ in range(5):
    assert select.select([fd], [], [], 0) == ([], [], [])
    expect('EAGAIN', os.read, fd, 4)
    os.write(pipe, b'abcd')
    assert select.select([fd], [], [fd], 10)[0] == [fd]
    assert os.read(fd, 4) == b'abcd'
",
    );
}

#[test]
fn a_poll_that_waits_wakes_when_data_comes() {
    with_pipe(
        PLAIN,
        "for wait in ('select', 'poll', 'epoll'):
    for _ in range(5):
        seen = []
        def watch():
            if wait == 'select': seen.append(select.select([fd], [], [], 60)[0] == [fd])
            elif wait == 'poll': seen.append(ready(fd, ms=60000) == [select.POLLIN])
            else:
                epoll = select.epoll()
                epoll.register(fd, select.EPOLLIN)
                seen.append(epoll.poll(60) == [(fd, select.EPOLLIN)])
        watcher = threading.Thread(target=watch)
        watcher.start()
        tid = watcher.native_id
        eventually(lambda: asleep(tid), 'a watcher that waits')
        os.write(pipe, b'abcd')
        watcher.join()
        assert seen == [True], (wait, seen)
        assert os.read(fd, 4) == b'abcd'
",
    );
}

#[test]
fn epoll_reports_levels_for_as_long_as_they_hold() {
    with_pipe(
        PLAIN,
        "epoll = select.epoll()
epoll.register(fd, select.EPOLLIN)
assert epoll.poll(0) == []
os.write(pipe, b'abcdefgh')
for _ in range(3):
    assert epoll.poll(60) == [(fd, select.EPOLLIN)]
assert os.read(fd, 4) == b'abcd'
assert epoll.poll(0) == [(fd, select.EPOLLIN)]
assert os.read(fd, 3) == b'efg'
assert epoll.poll(0) == [(fd, select.EPOLLIN)]
assert os.read(fd, 4) == b'h'
assert epoll.poll(0) == []
expect('EAGAIN', os.read, fd, 4)
",
    );
}

#[test]
fn epoll_reports_every_edge() {
    with_pipe(
        PLAIN,
        "epoll = select.epoll()
epoll.register(fd, select.EPOLLIN | select.EPOLLET)
assert epoll.poll(0) == []
for turn in range(20):
    os.write(pipe, b'abcd')
    assert epoll.poll(60) == [(fd, select.EPOLLIN)], turn
    if turn % 3:
        # Read to the end, as edge-triggered programs do.
        while True:
            try: os.read(fd, 3)
            except BlockingIOError: break
",
    );
}

#[test]
fn readiness_is_true_also_when_the_converter_consumes() {
    with_pipe(
        DECIMATING,
        "rng = random.Random(7)
epoll = select.epoll()
epoll.register(fd, select.EPOLLIN | select.EPOLLET)
written = given = 0
for _ in range(200):
    for _ in range(rng.randrange(6)):
        os.write(pipe, struct.pack('<I', written))
        written += 1
    while given < written // 4:
        if rng.random() < 0.5:
            assert ready(fd, ms=60000) == [select.POLLIN]
        else:
            eventually(lambda: ready(fd), 'readiness')
        assert os.read(fd, 4) == struct.pack('<I', given * 4 + 3)
        given += 1
    assert ready(fd) == []
    expect('EAGAIN', os.read, fd, 4)
",
    );
}

#[test]
fn a_converter_that_only_consumes_never_makes_its_file_readable() {
    with_pipe(
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = function() return false end } }",
        "os.write(pipe, bytes(1000))
assert ready(fd, ms=50) == []
expect('EAGAIN', os.read, fd, 1)
",
    );
}

#[test]
fn each_of_several_pollers_is_woken() {
    with_pipe(
        PLAIN,
        "others = [open_ro(M + '/n/device', os.O_NONBLOCK) for _ in range(20)]
epoll = select.epoll()
for other in others: epoll.register(other, select.EPOLLIN | select.EPOLLET)
for turn in range(5):
    os.write(pipe, b'abcd')
    left = set(others)
    eventually(lambda: not left.difference_update(number for number, _ in epoll.poll(1)) and not left, 'all of them')
    for other in others: assert os.read(other, 4) == b'abcd'
",
    );
}

#[test]
fn the_end_of_a_source_is_readable() {
    with_pipe(
        PLAIN,
        "os.write(pipe, b'abcd')
os.close(pipe)
assert ready(fd, ms=60000)
assert os.read(fd, 4) == b'abcd'
assert ready(fd, ms=60000)
assert os.read(fd, 4) == b''
assert ready(fd) == []
expect('EAGAIN', os.read, fd, 4)
pipe = feed('in')
os.write(pipe, b'efgh')
assert ready(fd, ms=60000)
assert os.read(fd, 4) == b'efgh'
",
    );
}

#[test]
fn a_failing_converter_makes_its_file_readable_because_a_read_does_not_wait() {
    with_pipe(
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1,
          converter = function(a_s, a, b_s, b) error('no', 0) end } }",
        "os.write(pipe, b'a')
assert ready(fd, ms=60000)
expect('EIO', os.read, fd, 1)
assert ready(fd) == []
expect('EAGAIN', os.read, fd, 1)
",
    );
}

#[test]
fn value_reports_new_samples_also_as_priority_like_sysfs() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 2, format = 'u16 x', on_event = true } }",
    ) else {
        return;
    };
    m.python(
        "pipe = feed('in')
eventually(lambda: os.write(pipe, b'\\x01\\x00') and error_of(lambda: open(M + '/n/value').read()) is None, 'a sample')
for name in ('value', 'value0', 'bin_data'):
    fd = open_ro(M + '/n/' + name, os.O_NONBLOCK)
    both = select.POLLIN | select.POLLPRI
    def drained():
        os.pread(fd, 10, 0)
        return ready(fd, both) == []
    eventually(drained, 'no news')
    for number in range(2, 6):
        watcher = threading.Thread(target=lambda: got.append(ready(fd, select.POLLPRI, 10000)))
        got = []
        watcher.start()
        os.write(pipe, struct.pack('<H', number))
        watcher.join()
        assert got == [[select.POLLPRI]], got
        assert ready(fd, both) == [both]
        expected = struct.pack('<H', number) if name == 'bin_data' else b'%d\\n' % number
        assert os.pread(fd, 10, 0) == expected
        assert ready(fd, both) == []
",
    );
}

#[test]
fn log_can_be_polled() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/log', os.O_NONBLOCK)
def drain():
    while error_of(os.read, fd, 4096) is None: pass
drain()
assert ready(fd) == []
epoll = select.epoll()
epoll.register(fd, select.EPOLLIN | select.EPOLLET)
epoll.poll(0)
for name in ('one', 'two'):
    with open(M + '/config', 'w') as file: file.write(\"trikfs_log('%s'); trikfs = {}\" % name)
    seen = b''
    while name.encode() not in seen:
        assert epoll.poll(60)
        while True:
            try: seen += os.read(fd, 10)
            except BlockingIOError: break
",
    );
}

#[test]
fn plain_files_and_endless_devices_are_always_ready() {
    let Some(m) = mount(
        "trikfs = { z = { src = '/dev/zero', input_tuple_size = 1 }, f = { src = '$DIR/f', input_tuple_size = 1 } }",
    ) else {
        return;
    };
    m.board().file("f", "x");
    m.python(
        "for name in ('status', 'config', 'z/device', 'z/value', 'z/stats', 'f/device', 'f/bin_data', 'f/value'):
    fd = open_ro(M + '/' + name, os.O_NONBLOCK)
    assert ready(fd) == [select.POLLIN], name
    assert os.read(fd, 1), name
",
    );
}
