//! The `log`: what converters and the filesystem say, as a stream that can be followed.

use crate::mount;

const TALKER: &str = "trikfs_log('loaded', 1)
trikfs = { n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
  converter = function(a_s, a, b_s, b) trikfs_log('tuple', ba.get(a, 0), nil, true); print('printed') end } }";

#[test]
fn what_converters_and_configurations_say_is_logged_with_their_node() {
    let Some(m) = mount(TALKER) else { return };
    assert_eq!(m.sh("head -c 1 n/device | wc -c").trim(), "1");
    m.python(
        "fd = open_ro(M + '/log')
log = b''
while b'printed' not in log: log += os.read(fd, 100)
log = log.decode()
lines = [line.split('] ', 1)[1] for line in log.splitlines()]
assert any(line.endswith('loaded\\t1') or line.endswith('loaded 1') for line in lines), log
assert 'n: tuple 0 nil true' in lines and 'n: printed' in lines, log
assert lines.count('n: tuple 0 nil true') == 1, log
",
    );
}

#[test]
fn tail_follows_and_readers_do_not_take_lines_from_each_other() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    m.python(
        "tails = [subprocess.Popen(['tail', '-s', '0.02', '-f', M + '/log'], stdout=subprocess.PIPE) for _ in range(2)]
try:
    for number in range(5):
        with open(M + '/config', 'w') as file: file.write(\"trikfs_log('line %d') trikfs = {}\" % number)
        for tail in tails:
            while b'line %d' % number not in tail.stdout.readline(): pass
finally:
    for tail in tails:
        tail.kill()
        tail.wait()
",
    );
}

#[test]
fn a_reader_at_the_end_waits_and_one_that_does_not_want_to_is_told() {
    let Some(m) = mount("trikfs = {}") else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/log', os.O_NONBLOCK)
while error_of(os.read, fd, 4096) is None: pass
expect('EAGAIN', os.read, fd, 10)
fcntl.fcntl(fd, fcntl.F_SETFL, 0)
got = []
waiter = threading.Thread(target=lambda: got.append(os.read(fd, 4096)))
waiter.start()
eventually(lambda: asleep(waiter.native_id), 'a reader that waits')
with open(M + '/config', 'w') as file: file.write(\"trikfs_log('news') trikfs = {}\")
waiter.join()
assert b'news' in got[0], got
assert b'news' in os.pread(fd, 65536, 0)
",
    );
}

#[test]
fn a_flood_of_lines_is_bounded_and_cut_into_whole_lines() {
    let Some(m) =
        mount("for i = 1, 20000 do trikfs_log('line', i, ('x'):rep(50)) end\ntrikfs = {}")
    else {
        return;
    };
    m.python(
        "fd = open_ro(M + '/log', os.O_NONBLOCK)
log = b''
while True:
    try: log += os.read(fd, 1 << 16)
    except BlockingIOError: break
assert len(log) <= 65536 + 2000, len(log)
assert log.startswith(b'[') and log.endswith(b'\\n')
",
    );
}
