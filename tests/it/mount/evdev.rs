//! Input events, recorded with 24- and 16-byte layouts, through a pipe.

use crate::mount_on;
use harness::Board;

fn with_events(layout: &str, times: usize) {
    let board = Board::new();
    board.fifo("events");
    let config = format!(
        "trikfs = {{ pad = {{ src = evdev{{ path = '$DIR/events', axes = {{ 'ABS_X', 'ABS_Y' }}, layout = '{layout}' }}, format = 'i32 x, i32 y', on_event = true }} }}"
    );
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    m.python(&format!(
        "def event(kind, code, value): return b'\\xaa' * {times} + struct.pack('=HHi', kind, code, value)
fd, pipe = open_ro(M + '/pad/device', os.O_NONBLOCK), feed('events')
recorded = event(3, 0, -5) + event(3, 16, 77) + event(3, 1, 99)
for byte in recorded: os.write(pipe, bytes([byte]))
assert ready(fd, ms=30) == []
os.write(pipe, event(0, 0, 0))
assert ready(fd, ms=60000)
assert os.read(fd, 100) == struct.pack('<ii', -5, 99)
eventually(lambda: text(M + '/pad/value') == '-5 99\\n', 'the value')
assert text(M + '/pad/value1') == '99\\n'
# What was dropped is not made up: everything up to the next report is thrown away.
os.write(pipe, event(0, 3, 0) + event(3, 0, 1000) + event(0, 0, 0) + event(3, 1, 4) + event(0, 0, 0))
assert ready(fd, ms=60000)
assert os.read(fd, 100) == struct.pack('<ii', -5, 4)
"
    ));
}

#[test]
fn events_of_64_bit_machines_become_tuples() {
    with_events("bits64", 16);
}

#[test]
fn events_of_32_bit_machines_become_tuples() {
    with_events("bits32", 8);
}

/// Everybody shares one opening, and who listens to a device that speaks of changes only may have come too late for all of them.
#[test]
fn a_reader_that_comes_later_begins_with_the_present_values_and_not_with_old_events() {
    let board = Board::new();
    // One for each: a close is told a moment later, and until then events would go to either node.
    board.fifo("pad");
    board.fifo("all");
    let Some(m) = mount_on(
        board,
        "local function pad(name, events)
  return { src = evdev{ path = '$DIR/' .. name, axes = not events and { 'ABS_X' } or nil, events = events, layout = 'bits64' } }
end
trikfs = { pad = pad('pad'), all = pad('all', true) }",
    ) else {
        return;
    };
    m.python(
        "def event(kind, code, value): return bytes(16) + struct.pack('=HHi', kind, code, value)
for node, first in (('pad', struct.pack('<i', 7)), ('all', None)):
    early, pipe = open_ro(M + '/' + node + '/device', os.O_NONBLOCK), feed(node)
    os.write(pipe, event(3, 0, -5) + event(0, 0, 0) + event(3, 0, 7) + event(0, 0, 0))
    eventually(lambda: ready(early), 'events')
    size = 0
    def all_come():
        global size
        size += len(os.read(early, 100)) if ready(early) else 0
        return size == (8 if first else 64)
    eventually(all_come, 'all of them')
    late = open_ro(M + '/' + node + '/device', os.O_NONBLOCK)
    if first:
        assert os.read(late, 100) == first
    expect('EAGAIN', os.read, late, 100)
    # That nothing more comes is known soon, also after others have heard something.
    value = open_ro(M + '/' + node + '/value')
    if first:
        assert os.read(value, 100).split() == [b'7', b'0', b'0', b'0']
    else:
        expect('ENODATA', os.read, value, 100)
    os.close(value)
    # What comes now is for both.
    os.write(pipe, event(3, 0, 9) + event(0, 0, 0))
    for fd in (early, late):
        assert ready(fd, ms=60000) and len(os.read(fd, 100)) == (4 if first else 32)
        os.close(fd)
    os.close(pipe)
",
    );
}
