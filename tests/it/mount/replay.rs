//! Recordings and bytes made up by the configuration, as streams in time.

use harness::{Board, Mount};

/// A recording of the board, which is found like an included file.
fn recorded(recording: &str, config: &str) -> Option<Mount> {
    let board = Board::new();
    board.file("run.rec", recording);
    let dir = board.dir().to_str()?.to_owned();
    crate::mount_with(board, config, &["--include", &dir])
}

#[test]
fn a_recording_runs_once_in_its_own_time_and_ends() {
    let Some(m) = recorded(
        "# two tuples, then one in two parts\n0 0102\n20 0304\n40 05\n60 06 # late\n",
        "trikfs = { n = { src = replay{ path = 'run.rec', speed = 1, loop = false }, input_tuple_size = 2 } }",
    ) else {
        return;
    };
    m.python(
        "start = time.monotonic()
fd = open_ro(M + '/n/device')
assert read_exactly(fd, 6, 1) == bytes([1, 2, 3, 4, 5, 6])
assert time.monotonic() - start > 0.05
assert os.read(fd, 2) == b''
assert os.read(fd, 2) == b''
",
    );
}

#[test]
fn a_recording_can_be_slower_and_begin_again_and_be_polled() {
    let Some(m) = recorded(
        "0 01\n10 02\n",
        "trikfs = { n = { src = replay{ path = 'run.rec', speed = 0.5, loop = true }, input_tuple_size = 1 } }",
    ) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/n/device', os.O_NONBLOCK)
got = b''
while len(got) < 20:
    assert ready(fd, ms=60000)
    got += os.read(fd, 1)
assert got == b'\\1\\2' * 10, got
",
    );
}

#[test]
fn a_recording_that_is_none_is_no_device_and_says_the_line() {
    let Some(m) = recorded(
        "0 01\nx 02\n",
        "trikfs = { n = { src = replay{ path = 'run.rec' }, input_tuple_size = 1 } }",
    ) else {
        return;
    };
    assert_eq!(m.errno("n/device"), libc::ENODEV);
    assert!(
        m.text("n/fault")
            .contains("run.rec:2: the time is not a number of ms"),
        "{}",
        m.text("n/fault")
    );
}

#[test]
fn made_up_bytes_come_by_the_clock_and_wake_a_reader() {
    let Some(m) = crate::mount(
        "trikfs = {
          once = { src = fake{ data = 'aabbcc', period_ms = 5, loop = false }, input_tuple_size = 2 },
          ever = { src = fake{ data = 'xyz', period_ms = 2, loop = true }, input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    assert_eq!(m.sh("cat once/device"), "aabbcc");
    assert_eq!(m.sh("head -c 9 ever/device"), "xyzxyzxyz");
    m.python(
        "fd = open_ro(M + '/ever/device', os.O_NONBLOCK)
epoll = select.epoll()
epoll.register(fd, select.EPOLLIN | select.EPOLLET)
got = b''
while len(got) < 12:
    assert epoll.poll(60)
    while True:
        try: got += os.read(fd, 1)
        except BlockingIOError: break
start = b'xyz'.index(got[:1])
assert got == (b'xyz' * 1000)[start:start + len(got)], got
",
    );
}
