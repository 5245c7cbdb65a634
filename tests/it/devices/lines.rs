//! Sensor programs: scripts that make pipes and leave with them, fail, hang or are missing.

use crate::mount_on;
use harness::{Board, Mount};
use std::fs;
use std::os::unix::fs::PermissionsExt;

/// A sensor whose script begins with these lines; it notes its calls, makes both pipes and removes them.
fn sensor(script: &str) -> Option<Mount> {
    sensor_with(script, "")
}

/// The same, whose node has more than the usual.
fn sensor_with(script: &str, more: &str) -> Option<Mount> {
    let board = Board::new();
    let text = format!(
        "#!/bin/sh
cd ${{0%/*}}
echo $1 >>calls
{script}
case $1 in
  start) mkfifo out in ;;
  stop) rm -f out in ;;
esac
"
    );
    let path = board.file("sensor", text);
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    board.file("calls", "");
    let config = format!(
        "trikfs = {{ line = {{ src = lines{{ path = '$DIR/out', input = '$DIR/in', start = {{ '$DIR/sensor', 'start' }}, stop = {{ '$DIR/sensor', 'stop' }} }}, input_tuple_size = 16{more} }} }}"
    );
    mount_on(board, &config)
}

#[test]
fn a_reader_that_goes_while_lines_are_converted_stops_the_sensor() {
    // A moment for each line. A program for ARM is emulated, and some fifty times as slow.
    let loops = if crate::is_of_the_controller() {
        "6e5"
    } else {
        "3e7"
    };
    let slow = format!(
        ", output_tuple_size = 16, budget_us = 10000000, converter = function(a_s, a, b_s, b)
      local sum = 0
      for i = 1, {loops} do sum = sum + i end
      assert(sum > 0)
      for i = 0, 15 do ba.set(b, i, ba.get(a, i)) end
    end"
    );
    let Some(m) = sensor_with("", &slow) else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/line/bin_data', os.O_NONBLOCK)
eventually(lambda: os.path.exists(D + '/in'), 'the pipes')
pipe = feed('out')
os.write(pipe, b'one\\n' * 40)
eventually(lambda: stat_of(M + '/line/stats', 'samples') >= 1, 'a first sample')
assert stat_of(M + '/line/stats', 'samples') < 40, 'others are on their way'
os.close(fd)
eventually(lambda: text(D + '/calls') == 'start\\nstop\\n', 'the stop')
",
    );
}

#[test]
fn the_first_reader_starts_the_sensor_and_the_last_one_stops_it() {
    let Some(m) = sensor("") else { return };
    m.python(
        "one = open_ro(M + '/line/device')
two = open_ro(M + '/line/device')
assert ready(one) == []
eventually(lambda: os.path.exists(D + '/in'), 'the pipes')
pipe, back = feed('out'), open_ro(D + '/in', os.O_NONBLOCK)
for byte in b'loc: -5 0 42\\nloc: 100 100 100 100\\nl\\0c\\nloc: 1 2 3\\r\\n':
    os.write(pipe, bytes([byte]))
for fd in (one, two):
    assert ready(fd, ms=60000)
    assert read_exactly(fd, 32) == b'loc: -5 0 42'.ljust(16, b'\\0') + b'loc: 1 2 3'.ljust(16, b'\\0')
assert stat_of(M + '/line/stats', 'damaged') == 2
commands = os.open(M + '/line/device', os.O_WRONLY)
os.write(commands, b'detect'.ljust(16, b'\\0'))
assert os.read(back, 100) == b'detect\\n'
os.close(back)
expect('ENODEV', os.write, commands, b'detect'.ljust(16, b'\\0'))
log = os.read(open_ro(M + '/log', os.O_NONBLOCK), 1 << 16).decode()
reason = 'the sensor is not running (nobody reads its pipe): keep one of its files open for reading\\n'
assert 'line: caller: ' in log and reason in log, log
assert text(M + '/line/fault') == ''
os.close(one)
assert text(D + '/calls') == 'start\\n'
os.close(two)
eventually(lambda: text(D + '/calls') == 'start\\nstop\\n', 'the stop')
three = open_ro(M + '/line/device')
eventually(lambda: text(D + '/calls') == 'start\\nstop\\nstart\\n', 'the next start')
",
    );
}

#[test]
fn the_last_answer_is_there_for_who_comes_later_until_the_question_is_asked_anew() {
    let board = Board::new();
    board.fifo("out");
    board.fifo("in");
    let Some(m) = mount_on(
        board,
        "trikfs = {
           camera = { src = lines{ path = '$DIR/out', input = '$DIR/in', question = 'detect', answer = 'hsv:' }, format = 'text 16' },
           colour = { src = 'trikfs:camera', format = 'i32 hue', timeout_ms = 600000, converter = function(a_s, a, b_s, b)
             local hue = ba.text(a):match('^hsv: (%d+)$')
             if not hue then return false end
             ba.i32(b, 0, tonumber(hue))
           end },
         }",
    ) else {
        return;
    };
    m.python(
        "reader = open_ro(M + '/camera/device')
pipe, back = feed('out'), open_ro(D + '/in', os.O_NONBLOCK)
def ask(words):
    fd = os.open(M + '/camera/value', os.O_WRONLY)
    os.write(fd, words)
    os.close(fd)
    assert os.read(back, 100) == words + b'\\n'
def line():
    return read_exactly(reader, 16).rstrip(b'\\0')
fd = open_ro(M + '/colour/value', os.O_NONBLOCK)
expect('EAGAIN', os.read, fd, 99)
os.close(fd)
ask(b'detect')
os.write(pipe, b'loc: 1 2 3\\nhsv: 120\\nloc: 4 5 6\\n')
assert [line() for _ in range(3)] == [b'loc: 1 2 3', b'hsv: 120', b'loc: 4 5 6']
for _ in range(3):
    assert text(M + '/colour/value') == '120\\n'
ask(b'hsv 1')
assert text(M + '/colour/value') == '120\\n', 'that asked for nothing'
late = open_ro(M + '/camera/device')
assert os.read(late, 16).rstrip(b'\\0') == b'hsv: 120'
ask(b'detect')
fd = open_ro(M + '/colour/value', os.O_NONBLOCK)
expect('EAGAIN', os.read, fd, 99)
got = []
waiting = threading.Thread(target=lambda: got.append(text(M + '/colour/value')))
waiting.start()
os.write(pipe, b'hsv: 7\\n')
waiting.join()
assert got == ['7\\n'], got
os.close(reader)
os.close(late)
os.close(fd)
assert text(M + '/colour/value') == '7\\n', 'also when nobody has read for a while'
",
    );
}

#[test]
fn a_pipe_that_vanishes_makes_the_sensor_start_again() {
    let Some(m) = sensor("") else { return };
    m.python(
        "fd = open_ro(M + '/line/device')
eventually(lambda: os.path.exists(D + '/in'), 'the pipes')
pipe = feed('out')
os.write(pipe, b'one\\n')
assert read_exactly(fd, 16) == b'one'.ljust(16, b'\\0')
os.remove(D + '/out')
os.remove(D + '/in')
eventually(lambda: text(D + '/calls') == 'start\\nstop\\nstart\\n', 'the restart')
eventually(lambda: os.path.exists(D + '/in'), 'the new pipes')
pipe = feed('out')
def is_back():
    os.write(pipe, b'two\\n')
    try: return os.read(fd, 16) == b'two'.ljust(16, b'\\0')
    except OSError as error:
        assert error.errno == errno.ENODEV
        return False
eventually(is_back, 'lines')
",
    );
}

#[test]
fn a_sensor_that_fails_says_why_and_is_not_started_over_and_over() {
    let Some(m) = sensor("echo no camera on video1 >&2; exit 3") else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/line/device')
expect('ENODEV', os.read, fd, 16)
reason = text(M + '/line/fault')
assert reason.startswith('device: ') and 'sensor start failed: exit status: 3, it said: no camera on video1' in reason, reason
other = open_ro(M + '/line/device')
expect('ENODEV', os.read, other, 16)
assert text(D + '/calls') == 'start\\n', text(D + '/calls')
assert b'no camera on video1' in os.read(open_ro(M + '/log', os.O_NONBLOCK), 1 << 16)
",
    );
}

#[test]
fn a_script_that_hangs_keeps_nobody_from_anything_and_one_that_is_missing_is_named() {
    let Some(m) = sensor("[ $1 = start ] && sleep 1000") else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/line/device', os.O_NONBLOCK)
eventually(lambda: text(D + '/calls') == 'start\\n', 'the start')
began = time.monotonic()
for _ in range(100):
    expect('EAGAIN', os.read, fd, 16)
    text(M + '/line/stats')
assert time.monotonic() - began < 60
other = open_ro(M + '/line/device', os.O_NONBLOCK)
assert text(D + '/calls') == 'start\\n'
with open(M + '/config', 'w') as config:
    config.write(\"trikfs = { line = { src = lines{ path = '/x/out', start = { '/x/no-such-program' } }, input_tuple_size = 16 } }\")
fd = open_ro(M + '/line/device')
expect('ENODEV', os.read, fd, 16)
assert '/x/no-such-program' in text(M + '/line/fault')
",
    );
}

#[test]
fn the_end_of_the_mount_stops_the_sensor() {
    let Some(m) = sensor("") else { return };
    m.python(
        "fd = open_ro(M + '/line/device')
eventually(lambda: os.path.exists(D + '/in'), 'the pipes')
os.close(fd)
",
    );
    let calls = m.board().path("calls");
    // A board of its own, since that of the mount goes with it.
    let kept = Board::new();
    let copy = kept.path("calls");
    fs::hard_link(calls, &copy).unwrap();
    drop(m);
    let text = fs::read_to_string(&copy).unwrap();
    assert_eq!(text, "start\nstop\n");
}
