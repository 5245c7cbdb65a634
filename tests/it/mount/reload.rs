//! A new configuration under open files: what is unchanged goes on without a gap, what changed says ESTALE.

use crate::{mount, mount_on};
use harness::Board;

const TWO: &str = "trikfs = {
  kept = { src = '$DIR/kept', input_tuple_size = 4 },
  changed = { src = '$DIR/changed', input_tuple_size = 4 },
}";
const CHANGED: &str = "-- the same node at another place, and a changed one
trikfs = {
  added = { src = '/dev/zero', input_tuple_size = 4 },
  kept = { input_tuple_size = 4, src = '$DIR/kept' },
  changed = { src = '$DIR/changed', input_tuple_size = 2 },
}";

fn with_pipes(config: &str) -> Option<harness::Mount> {
    let board = Board::new();
    board.fifo("kept");
    board.fifo("changed");
    let new = board.fill_in(CHANGED);
    board.file("new", new);
    mount_on(board, config)
}

#[test]
fn files_of_changed_and_removed_nodes_are_stale_and_others_go_on() {
    let Some(m) = with_pipes(TWO) else { return };
    m.python(
        "names = ('device', 'bin_data', 'value')
kept, gone = open_ro(M + '/kept/device', os.O_NONBLOCK), [open_ro(M + '/changed/' + name, os.O_NONBLOCK) for name in names]
sink = os.open(M + '/changed/device', os.O_WRONLY)
pipe = feed('kept')
os.write(pipe, b'aaaabb')
assert ready(kept, ms=60000)
assert os.read(kept, 3) == b'aaa'
for fd in gone: ready(fd)
with open(D + '/new') as new, open(M + '/config', 'w') as config: config.write(new.read())
for fd in gone:
    expect('ESTALE', os.read, fd, 4)
    assert ready(fd)[0] & select.POLLERR
expect('ESTALE', os.write, sink, b'abcd')
assert os.read(kept, 3) == b'a'
os.write(pipe, b'bb')
assert ready(kept, ms=60000)
assert os.read(kept, 4) == b'bbbb'
assert ready(open_ro(M + '/changed/device')) == []
assert open(M + '/added/bin_data', 'rb').read() == bytes(4)
with open(M + '/config', 'w') as config: config.write('trikfs = {}')
expect('ESTALE', os.read, kept, 4)
expect('ENOENT', os.open, M + '/kept/device', os.O_RDONLY)
",
    );
}

#[test]
fn a_reader_that_waits_on_a_changed_node_is_told() {
    let Some(m) = with_pipes(TWO) else { return };
    m.python(
        "def wait(): expect('ESTALE', os.read, fd, 4)
def poll(): assert ready(fd, ms=60000)[0] & select.POLLERR
for action in (wait, poll):
    fd = open_ro(M + '/changed/device')
    child = forked(action)
    eventually(lambda: asleep(child), 'a reader that waits')
    with open(D + '/new') as new, open(M + '/config', 'w') as config: config.write(new.read())
    assert ended(child) == 0
    with open(M + '/config', 'w') as config: config.write(open(D + '/new').read().replace('= 2', '= 4'))
",
    );
}

#[test]
fn a_changed_upvalue_or_helper_changes_the_node_and_a_comment_does_not() {
    let Some(m) = mount(
        "local gain = 1
         local function helper(x) return x * gain end
         trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
           converter = function(a_s, a, b_s, b) ba.set(b, 0, helper(ba.get(a, 0)) + 1) end } }",
    ) else {
        return;
    };
    m.python(
        "def apply(change):
    fd = open_ro(M + '/n/device')
    assert os.read(fd, 1)
    config = open(M + '/config').read()
    with open(M + '/config', 'w') as file: file.write(change(config))
    return error_of(os.read, fd, 1)
assert apply(lambda config: config) is None
assert apply(lambda config: '-- a comment\\n\\n' + config.replace(' = ', '=')) is None
assert apply(lambda config: config.replace('gain=1', 'gain=2')) == 'ESTALE'
assert apply(lambda config: config.replace('x * gain', 'x + gain')) == 'ESTALE'
assert apply(lambda config: config.replace('+ 1) end', '+ 2) end')) == 'ESTALE'
assert apply(lambda config: config + '\\ntrikfs.other = { src = \"/dev/zero\", input_tuple_size = 1 }') is None
",
    );
}

#[test]
fn a_storm_of_reloads_makes_no_gap_in_an_unchanged_stream() {
    let Some(m) = with_pipes(TWO) else { return };
    m.python(
        "fd, pipe = open_ro(M + '/kept/device'), feed('kept')
base = open(D + '/new').read()
stop, problems = threading.Event(), []
def reload():
    turn = 0
    while not stop.is_set():
        turn += 1
        try:
            with open(M + '/config', 'w') as file: file.write(base + '\\ntrikfs.changed.input_tuple_size = %d' % (turn % 5 + 1))
        except OSError as error:
            problems.append(error)
def visit():
    while not stop.is_set():
        got = error_of(lambda: open(M + '/changed/stats').read())
        if got not in (None, 'ENOENT', 'ESTALE'): problems.append(got)
threads = [threading.Thread(target=action) for action in (reload, visit, visit)]
for thread in threads: thread.start()
try:
    sent = got = 0
    pending = b''
    deadline = time.monotonic() + 3
    while time.monotonic() < deadline:
        for _ in range(50):
            os.write(pipe, struct.pack('<I', sent))
            sent += 1
        while got < sent:
            pending += os.read(fd, 64)
            while len(pending) >= 4:
                assert struct.unpack('<I', pending[:4])[0] == got, (pending, got)
                pending, got = pending[4:], got + 1
finally:
    stop.set()
    for thread in threads: thread.join()
assert not problems, problems[:3]
assert sent > 1000
",
    );
    assert_eq!(m.result(), "config ok: 3 nodes");
}

#[test]
fn a_kept_node_keeps_its_newest_value_and_its_counts() {
    let board = Board::new();
    let mut pipe = board.pipe("kept");
    let Some(m) = mount_on(
        board,
        "trikfs = { kept = { src = '$DIR/kept', input_tuple_size = 2, format = 'u16 x', on_event = true } }",
    ) else {
        return;
    };
    harness::eventually("a sample", || {
        std::io::Write::write_all(&mut pipe, &[7, 0]).unwrap();
        m.errno("kept/value") == 0
    });
    let samples = m.stat("kept", "samples");
    m.apply("trikfs = { new = { src = '/dev/zero', input_tuple_size = 1 }, kept = { src = '$DIR/kept', input_tuple_size = 2, format = 'u16 x', on_event = true } }").unwrap();
    assert_eq!(m.text("kept/value"), "7\n");
    assert!(m.stat("kept", "samples") >= samples);
}

#[test]
fn sampling_stops_with_its_node() {
    let Some(m) =
        mount("trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 1 } }")
    else {
        return;
    };
    harness::eventually("samples", || m.stat("n", "samples") > 3.0);
    let stats = m.open("n/stats");
    m.apply("trikfs = { n = { src = '/dev/zero', input_tuple_size = 2, poll_ms = 1 } }")
        .unwrap();
    let samples = || {
        let mut buffer = [0; 600];
        let n = std::os::unix::fs::FileExt::read_at(&stats, &mut buffer, 0).unwrap_or(0);
        String::from_utf8_lossy(&buffer[..n])
            .lines()
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    // At most one sample was being taken at that moment.
    harness::eventually("the new node's samples", || m.stat("n", "samples") > 3.0);
    let after = samples();
    let new = m.stat("n", "samples");
    harness::eventually("more of the new node's samples", || {
        m.stat("n", "samples") > new + 5.0
    });
    assert_eq!(samples(), after);
}
