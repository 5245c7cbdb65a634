//! Failures: the right errno, the right blame, the right count, and the next read works.

use crate::{mount, mount_on};
use harness::Board;
use harness::wait::nine_tenths;

#[test]
fn the_nth_read_fails_with_its_errno_and_the_next_one_works() {
    let faulty = |errno: &str| {
        format!(
            "faulty{{ src = fake{{ data = 'ab', period_ms = 0, loop = true }}, fail = '{errno}', from = 2, count = 2 }}"
        )
    };
    let config = format!(
        "trikfs = {{ io = {{ src = {}, input_tuple_size = 2 }}, gone = {{ src = {}, input_tuple_size = 2 }}, busy = {{ src = {}, input_tuple_size = 2 }} }}",
        faulty("EIO"),
        faulty("ENODEV"),
        faulty("EBUSY")
    );
    let Some(m) = mount(&config) else { return };
    m.python(
        "for name, error in (('io', 'EIO'), ('gone', 'ENODEV'), ('busy', 'EBUSY')):
    fd = open_ro(M + '/' + name + '/device')
    assert os.pread(fd, 2, 0) == b'ab'
    assert text(M + '/' + name + '/fault') == ''
    for count in (1, 2):
        expect(error, os.pread, fd, 2, 0)
        assert text(M + '/' + name + '/fault').startswith('device: faulty source')
        assert stat_of(M + '/' + name + '/stats', 'faults') == count
    assert os.pread(fd, 2, 0) == b'ab'
    assert text(M + '/' + name + '/fault') == '', name
",
    );
}

#[test]
fn short_reads_of_a_source_are_put_together() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = faulty{ src = fifo{ path = '$DIR/in' }, from = 1000000, count = 1, fail = 'EIO', short = 1 }, input_tuple_size = 4,
           output_tuple_size = 4, converter = function(a_s, a, b_s, b) for i = 0, 3 do ba.set(b, i, ba.get(a, 3 - i)) end end } }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe = open_ro(M + '/n/device'), feed('in')
os.write(pipe, b'abcdefghij')
assert read_exactly(fd, 8, 3) == b'dcbahgfe'
os.write(pipe, b'kl')
assert read_exactly(fd, 4) == b'lkji'
",
    );
}

#[test]
fn a_stream_that_ends_vanishes_and_returns_goes_on() {
    let board = Board::new();
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = {
          ends = { src = faulty{ src = '/dev/zero', fail = 0, from = 3, count = 1 }, input_tuple_size = 1, share = false },
          gone = { src = '$DIR/in', input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    m.python(
        "fd, pipe, got = open_ro(M + '/gone/device'), feed('in'), []
os.write(pipe, b'a')
assert os.read(fd, 1) == b'a'
os.unlink(D + '/in')
os.close(pipe)
# The end of its writer, unless it was looked for between the two calls before.
assert error_of(lambda: got.append(os.read(fd, 1))) in (None, 'ENODEV')
assert got in ([], [b'']), got
expect('ENODEV', os.read, fd, 1)
assert text(M + '/gone/fault').startswith('device: ')
os.mkfifo(D + '/in')
pipe = feed('in')
got = []
def again():
    os.write(pipe, b'b')
    error = error_of(lambda: got.append(os.read(fd, 1)))
    assert error in (None, 'ENODEV'), error
    return got
eventually(again, 'the return')
assert got == [b'b']
assert text(M + '/gone/fault') == ''
",
    );
    assert_eq!(m.sh("head -c 2 ends/device | od -An -tu1; dd if=ends/device bs=1 count=5 2>/dev/null | wc -c").split_whitespace().collect::<Vec<_>>(), ["0", "0", "2"]);
}

#[test]
fn a_fault_is_one_line_and_goes_away() {
    let board = Board::new();
    board.file("raw", [9]);
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 1,
          converter = function(a_s, a, b_s, b)
            if ba.get(a, 0) == 9 then error('bad\\nsensor \\27[31m', 0) end
            ba.set(b, 0, 1)
          end } }",
    ) else {
        return;
    };
    assert_eq!(m.text("n/fault"), "");
    assert_eq!(m.errno("n/value"), libc::EIO);
    let fault = m.text("n/fault");
    assert!(
        fault.starts_with("converter: bad sensor") && !fault.contains('\u{1b}'),
        "{fault:?}"
    );
    assert_eq!(fault.lines().count(), 1);
    assert_eq!(m.errno("n/device"), libc::EIO);
    m.board().file("raw", [8]);
    assert_eq!(m.text("n/value"), "1\n");
    assert_eq!(m.text("n/fault"), "");
    assert!(m.stat("n", "faults") >= 2.0);
}

#[test]
fn stats_count_what_happens() {
    let board = Board::new();
    board.file("raw", "ab");
    let Some(m) = mount_on(
        board,
        "trikfs = { n = { src = '$DIR/raw', input_tuple_size = 2 } }",
    ) else {
        return;
    };
    for _ in 0..5 {
        m.read("n/bin_data").unwrap();
        m.sh("printf cd > n/device");
    }
    assert_eq!(
        (
            m.stat("n", "samples"),
            m.stat("n", "reads"),
            m.stat("n", "writes")
        ),
        (5.0, 5.0, 5.0)
    );
    assert_eq!((m.stat("n", "faults"), m.stat("n", "dropped")), (0.0, 0.0));
    let keys: Vec<String> = m
        .text("n/stats")
        .lines()
        .map(|line| line.split(' ').next().unwrap().to_owned())
        .collect();
    let expected = [
        "samples",
        "reads",
        "writes",
        "faults",
        "dropped",
        "damaged",
        "age_last_us",
        "age_mean_us",
        "age_p99_us",
        "conversion_last_us",
        "conversion_mean_us",
        "conversion_p99_us",
        "realtime_offset_ns",
    ];
    assert_eq!(keys, expected);
}

#[test]
fn a_device_that_hangs_costs_no_other_file_its_answer() {
    let board = Board::new();
    board.file("raw", "x");
    // Reading this pipe through /proc blocks in open, as a driver that waits for its bus would.
    let Some(m) = mount_on(
        board,
        "trikfs = {
          slow = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, budget_us = 2000000,
            converter = function() while true do end end },
          quick = { src = '$DIR/raw', input_tuple_size = 1 },
        }",
    ) else {
        return;
    };
    std::thread::scope(|scope| {
        let slow: Vec<_> = (0..3)
            .map(|_| scope.spawn(|| m.errno("slow/device")))
            .collect();
        let mut times = Vec::new();
        while !slow.iter().all(std::thread::ScopedJoinHandle::is_finished) {
            let start = std::time::Instant::now();
            assert_eq!(m.read("quick/bin_data").unwrap(), b"x");
            times.push(start.elapsed());
        }
        let (rounds, most) = (times.len(), nine_tenths(&mut times));
        assert!(
            rounds > 20 && most < std::time::Duration::from_millis(1500),
            "{rounds} reads, nine of ten within {most:?}"
        );
        for one in slow {
            assert_eq!(one.join().unwrap(), libc::EIO);
        }
    });
}
