//! `bin_data` of sampled nodes from the page cache: never old, never wrong, and really without a round trip.

use crate::{mount, mount_on};
use harness::Board;

/// A counter that is sampled in the background.
const COUNTER: &str = "trikfs = { n = { src = fake{ data = DATA, period_ms = 0, loop = true }, input_tuple_size = 4, poll_ms = 5 } }";

fn counter() -> String {
    let data: String = (0..250).map(|n| format!("\\{n}\\{n}\\{n}\\{n}")).collect();
    COUNTER.replace("DATA", &format!("'{data}'"))
}

#[test]
fn new_values_become_visible_through_an_open_file() {
    let Some(m) = mount(&counter()) else { return };
    m.python(
        "fds = [open_ro(M + '/n/bin_data') for _ in range(3)]
eventually(lambda: error_of(os.pread, fds[0], 4, 0) is None, 'a sample')
fds += [open_ro(M + '/n/bin_data') for _ in range(3)]
fds += [os.open(M + '/n/bin_data', os.O_RDONLY | os.O_NONBLOCK)]
for fd in fds:
    seen = set()
    def look():
        got = os.pread(fd, 64, 0)
        assert len(got) == 4 and got == got[:1] * 4, got
        seen.add(got)
        return len(seen) > 5
    eventually(look, 'six different values')
    os.lseek(fd, 0, os.SEEK_SET)
    assert len(os.read(fd, 64)) == 4 and os.read(fd, 64) == b''
",
    );
}

#[test]
fn reads_of_a_cached_value_do_not_come_to_the_daemon() {
    if harness::mount::transport() != "native" {
        return harness::wait::note_skip(
            "the count of cached reads is checked on the native transport",
        );
    }
    let Some(m) = mount(&counter()) else { return };
    harness::eventually("a sample", || m.errno("n/bin_data") == 0);
    m.python(
        "fd = open_ro(M + '/n/bin_data')
os.pread(fd, 4, 0)
before = stat_of(M + '/n/stats', 'reads')
for _ in range(20000): os.pread(fd, 4, 0)
after = stat_of(M + '/n/stats', 'reads')
assert after - before < 200, after - before
",
    );
}

#[test]
fn a_file_that_is_opened_before_the_first_sample_sees_all_that_follow() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, on_event = true, timeout_ms = 20000 } }",
    ) else {
        return;
    };
    m.python(
        "early, pipe = open_ro(M + '/n/bin_data'), feed('in')
expect('EAGAIN', os.read, open_ro(M + '/n/bin_data', os.O_NONBLOCK), 4)
os.write(pipe, b'aaaa')
assert os.pread(early, 4, 0) == b'aaaa'
late = open_ro(M + '/n/bin_data')
for number in range(300):
    tuple = struct.pack('<I', number)
    os.write(pipe, tuple)
    for fd in (early, late):
        eventually(lambda: os.pread(fd, 4, 0) == tuple, 'tuple %d' % number)
",
    );
}

#[test]
fn an_old_value_is_taken_back() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, poll_ms = 10, timeout_ms = 150 } }",
    ) else {
        return;
    };
    m.python(
        "pipe = feed('in')
def fresh():
    os.write(pipe, b'aaaa')
    return error_of(lambda: open(M + '/n/bin_data', 'rb').read()) is None
for _ in range(3):
    eventually(fresh, 'a value')
    fd = open_ro(M + '/n/bin_data')
    eventually(lambda: error_of(os.pread, fd, 4, 0) == 'ETIMEDOUT', 'the error of an old value')
    os.write(pipe, b'bbbb')
    eventually(lambda: error_of(os.pread, fd, 4, 0) is None, 'a new value')
    assert os.pread(fd, 4, 0) == b'bbbb'
",
    );
}

#[test]
fn a_failing_source_takes_the_value_back() {
    let board = Board::new();
    board.file("raw", [1, 2, 3, 4]);
    let config = "trikfs = { n = { src = '$DIR/raw', input_tuple_size = 4, poll_ms = 2 } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    m.python(
        "eventually(lambda: error_of(lambda: open(M + '/n/bin_data', 'rb').read()) is None, 'a value')
fd = open_ro(M + '/n/bin_data')
for _ in range(5):
    os.truncate(D + '/raw', 2)
    eventually(lambda: error_of(os.pread, fd, 4, 0) == 'EIO', 'the failure')
    assert text(M + '/n/fault').startswith('device: the source gave 2 of the 4 bytes')
    with open(D + '/raw', 'wb') as file: file.write(b'\\1\\2\\3\\4')
    eventually(lambda: error_of(os.pread, fd, 4, 0) is None, 'recovery')
    assert os.pread(fd, 4, 0) == b'\\1\\2\\3\\4'
",
    );
}

#[test]
fn a_polled_file_knows_what_it_has_read() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/in', input_tuple_size = 4, on_event = true } }",
    ) else {
        return;
    };
    m.python(
        "pipe = feed('in')
eventually(lambda: os.write(pipe, b'aaaa') and error_of(lambda: open(M + '/n/bin_data', 'rb').read()) is None, 'a value')
fd, unpolled = open_ro(M + '/n/bin_data'), open_ro(M + '/n/bin_data')
def calm():
    os.pread(fd, 4, 0)
    return ready(fd) == []
eventually(calm, 'no news')
for number in range(100):
    tuple = struct.pack('<I', number)
    os.write(pipe, tuple)
    assert ready(fd, ms=60000)
    eventually(lambda: os.pread(fd, 4, 0) == tuple and ready(fd) == [], 'no news after reading')
    eventually(lambda: os.pread(unpolled, 4, 0) == tuple, 'the unpolled file')
os.close(fd)
for number in range(100):
    tuple = struct.pack('<I', number)
    os.write(pipe, tuple)
    eventually(lambda: os.pread(unpolled, 4, 0) == tuple, 'the unpolled file')
",
    );
}

#[test]
fn readers_for_writing_and_tuples_that_do_not_fit_a_word_work_as_well() {
    let board = Board::new();
    board.file("four", "aaaa");
    board.file("three", "aaa");
    let Some(m) = mount_on(
        board,
        "trikfs = {
          four = { src = '$DIR/four', input_tuple_size = 4, poll_ms = 2 },
          three = { src = '$DIR/three', input_tuple_size = 3, poll_ms = 2 },
        }",
    ) else {
        return;
    };
    m.python(
        "for name, size in (('four', 4), ('three', 3)):
    eventually(lambda: error_of(lambda: open(M + '/%s/bin_data' % name, 'rb').read()) is None, 'a value')
    fd, both = open_ro(M + '/%s/bin_data' % name), os.open(M + '/%s/bin_data' % name, os.O_RDWR)
    for letter in (b'b', b'c', b'd'):
        assert os.pwrite(both, letter * size, 0) == size
        eventually(lambda: os.pread(fd, 9, 0) == letter * size, 'the new value')
        eventually(lambda: os.pread(both, 9, 0) == letter * size, 'the new value')
",
    );
}

#[test]
fn a_value_from_before_a_reload_is_not_served_afterwards() {
    let config = |byte: u8| {
        format!(
            "trikfs = {{ n = {{ src = fake{{ data = '\\{byte}\\{byte}', period_ms = 0, loop = true }}, input_tuple_size = 2, poll_ms = 2 }} }}"
        )
    };
    let Some(m) = mount(&config(1)) else { return };
    let is_stale = |file: &std::fs::File| {
        let error = std::os::unix::fs::FileExt::read_at(file, &mut [0; 2], 0)
            .map_err(|error| error.raw_os_error());
        assert_eq!(error, Err(Some(libc::ESTALE)));
    };
    let mut of_the_past = Vec::new();
    for byte in 1u8..30 {
        if byte > 1 {
            m.apply(&config(byte)).unwrap();
        }
        harness::eventually("a value", || m.errno("n/bin_data") == 0);
        let open = m.open("n/bin_data");
        let mut got = [0; 2];
        std::os::unix::fs::FileExt::read_exact_at(&open, &mut got, 0).unwrap();
        assert_eq!(got, [byte; 2]);
        // The next sample goes into the page: a reload that comes at this moment meets the sampler there.
        let samples = m.stat("n", "samples");
        harness::eventually("the next sample", || m.stat("n", "samples") > samples);
        m.apply("trikfs = {}").unwrap();
        is_stale(&open);
        of_the_past.push(open);
    }
    // Nor does it come back: a sampler may have been slow.
    of_the_past.iter().for_each(is_stale);
}
