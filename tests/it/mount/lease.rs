//! Leases: one program drives an actuator, others are kept out, and it comes to rest when the lease ends.

use crate::mount_on;
use harness::{Board, Mount, eventually, processes};
use nix::sys::signal::Signal;

const ROBOT: &str = "trikfs = {
  motor = { src = '$DIR/motor', input_tuple_size = 2, format = 'i8 speed, u8 mode', rest = { 0, 7 },
    params = { gain = 1 },
    attributes = { brake = { src = '$DIR/brake', input_tuple_size = 1, rest = { 1 } } } },
  alias = { src = 'trikfs:motor', input_tuple_size = 2, mode = '0644' },
  lamp = { src = '$DIR/lamp', input_tuple_size = 1 },
}";

/// Words of the scripts below.
const WORDS: &str = "
def state(): return open(D + '/motor', 'rb').read()
RUNS, RESTS = b'\\x64\\1', b'\\0\\7'
def drive(): return open(M + '/motor/value', 'w')
def put(name, text):
    fd = os.open(M + '/' + name, os.O_WRONLY | os.O_TRUNC)
    try:
        os.write(fd, text)
    finally:
        os.close(fd)
def take(flags=os.O_WRONLY): return os.open(M + '/motor/owner', flags)
def rests(): return state() == RESTS
def owner(): return text(M + '/motor/owner')
def kept(holds, what):
    '''Runs an action in a child, which says when it is done and then waits for its end.'''
    read_end, write_end = os.pipe()
    def act():
        os.close(read_end)
        left = holds()
        os.write(write_end, b'.')
        signal.pause()
    child = forked(act)
    os.close(write_end)
    assert os.read(read_end, 1) == b'.', what
    os.close(read_end)
    return child
def held():
    def act():
        fd = take()
        put('motor/value', b'100 1')
        return fd
    return kept(act, 'a holder')
def killed(child, number=signal.SIGKILL):
    os.kill(child, number)
    ended(child)
";

fn robot() -> Option<Mount> {
    let board = Board::new();
    board.file("motor", "..");
    board.file("brake", ".");
    board.file("lamp", ".");
    mount_on(board, ROBOT)
}

fn python(m: &Mount, script: &str) {
    m.python(&format!("{WORDS}{script}"));
}

#[test]
fn a_lease_in_a_shell_lasts_until_it_is_closed() {
    let Some(m) = robot() else { return };
    m.sh("test -z \"$(cat motor/owner)\"
exec 3>motor/owner
read pid name rest < motor/owner
test \"$pid $rest\" = \"$$ priority 0 deadman_ms 0\"
echo 50 1 > motor/value
echo 51 > motor/value0
printf '\\064\\001' | dd of=motor/device status=none
test \"$(od -An -tu1 $DIR/motor)\" = '  52   1'
exec 3>&-
until test \"$(od -An -tu1 $DIR/motor)\" = '   0   7'; do :; done
until test -z \"$(cat motor/owner)\"; do :; done
echo 50 1 > motor/value
test \"$(od -An -tu1 $DIR/motor)\" = '  50   1'
test ! -e lamp/owner");
}

#[test]
fn others_get_ebusy_at_every_file_of_the_actuator_also_through_open_files_and_links() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
before = [os.open(M + '/' + name, os.O_WRONLY)
          for name in ('motor/value', 'motor/value0', 'motor/bin_data', 'motor/device', 'motor/brake', 'alias/device')]
texts = [b'1 1', b'1', b'ab', b'ab', b'1', b'ab']
for fd, data in zip(before, texts): os.write(fd, data)
child = held()
for fd, data in zip(before, texts):
    expect('EBUSY', os.write, fd, data)
for name, data in (('value', b'1 1'), ('device', b'ab'), ('brake', b'1'), ('params/gain', b'2')):
    expect('EBUSY', put, 'motor/' + name, data)
expect('EBUSY', take)
assert owner().startswith('%d python3' % child) and owner().endswith(' priority 0 deadman_ms 0\\n'), owner()
assert state() == RUNS
put('lamp/device', b'x')
assert len(text(M + '/motor/value').split()) == 2, 'everybody may read'
killed(child)
eventually(rests)
eventually(lambda: owner() == '\\n', 'free')
for fd, data in zip(before, texts): os.write(fd, data)
assert state() == b'ab'
",
    );
}

#[test]
fn a_node_that_stands_for_another_has_its_lease() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
def named(): return os.open(M + '/alias/owner', os.O_WRONLY)
fd = named()
assert owner().startswith('%d ' % os.getpid())
expect('EBUSY', take)
def stranger():
    expect('EBUSY', put, 'motor/value', b'1 1')
    expect('EBUSY', put, 'alias/device', b'ab')
put('alias/device', b'\\x64\\1')
assert state() == RUNS
os.close(fd)
eventually(rests, 'rest')
child = held()
expect('EBUSY', named)
stranger()
killed(child)
eventually(rests)
",
    );
}

#[test]
fn a_lease_ends_with_its_program_by_any_way() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV):
    child = held()
    assert state() == RUNS
    killed(child, number)
    eventually(rests, 'rest after signal %d' % number)
def exits():
    take()
    put('motor/value', b'100 1')
    assert state() == RUNS
ended(forked(exits))
eventually(rests, 'rest after an exit')
# A child that has the descriptor keeps no lease alive for a parent that is gone.
def leaves_a_child():
    fd = take()
    put('motor/value', b'100 1')
    orphan.append(kept(lambda: os.set_inheritable(fd, True), 'a child'))
    os.write(told, struct.pack('i', orphan[0]))
orphan = []
tell, told = os.pipe()
assert ended(forked(leaves_a_child)) == 0
child = struct.unpack('i', os.read(tell, 4))[0]
eventually(rests, 'rest although a child has owner open')
eventually(lambda: owner() == '\\n')
os.kill(child, signal.SIGKILL)
# What is closed by execve is closed.
def execs():
    take()
    put('motor/value', b'100 1')
    os.execv('/bin/sh', ['sh', '-c', 'kill -STOP $$'])
child = forked(execs)
eventually(rests, 'rest after execve')
killed(child)
# What execve keeps open is kept.
def inherits():
    os.set_inheritable(take(), True)
    os.chdir(M)
    os.execv('/bin/sh', ['sh', '-c', 'echo 100 1 > motor/value; kill -STOP $$'])
child = forked(inherits)
eventually(lambda: state() == RUNS, 'the new program drives')
assert owner().startswith('%d sh ' % child), owner()
killed(child)
eventually(rests)
",
    );
}

#[test]
fn children_of_the_holder_drive_and_strangers_do_not() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
fd = take()
value = os.open(M + '/motor/value', os.O_WRONLY)
os.set_inheritable(value, True)
assert ended(forked(lambda: os.write(value, b'1 1'))) == 0
assert state() == b'\\1\\1'
assert ended(forked(lambda: put('motor/value', b'2 1'))) == 0
assert state() == b'\\2\\1', 'the end of a child that closed its file changes nothing'
subprocess.check_call(['sh', '-c', 'sh -c \"echo 3 1 > motor/value\"'], cwd=M)
assert state() == b'\\3\\1'
thread = threading.Thread(target=lambda: put('motor/value', b'4 1'))
thread.start(); thread.join()
assert state() == b'\\4\\1'
# A grandchild whose parent is gone belongs to nobody.
tell, told = os.pipe()
def orphan(parent):
    eventually(lambda: os.getppid() != parent, 'a new parent')
    os.write(told, (error_of(os.write, value, b'9 9') or 'none').encode())
def middle():
    me = os.getpid()
    forked(lambda: orphan(me))
    os._exit(0)
ended(forked(middle))
assert os.read(tell, 20) == b'EBUSY'
assert state() == b'\\4\\1'
",
    );
}

#[test]
fn a_dead_mans_clock_brings_a_silent_holder_to_rest_and_takes_the_lease() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
fd = take(os.O_RDWR)
os.write(fd, b'priority 10 deadman_ms 3000\\n')
assert owner().endswith(' priority 10 deadman_ms 3000\\n'), owner()
watcher = select.poll()
watcher.register(fd, select.POLLIN)
assert watcher.poll(0) == [(fd, select.POLLIN)]
# Writes keep it, to the actuator or to owner, for longer than the clock.
end = time.monotonic() + 4
value = os.open(M + '/motor/value', os.O_WRONLY)
writes = 0
while time.monotonic() < end:
    writes += 1
    os.write(*((value, b'100 1') if writes % 2 else (fd, b'\\n')))
start = time.monotonic()
os.write(value, b'100 1')
is_kept = owner() != '\\n' and state() == RUNS
assert is_kept or time.monotonic() - start > 2.9
eventually(rests, 'rest')
took = time.monotonic() - start
assert took >= 3, took
assert select.POLLERR & dict(watcher.poll(60000))[fd]
eventually(lambda: owner() == '\\n')
# It must ask again, and until then cannot move anything; all others can.
expect('EBUSY', os.write, value, b'100 1')
expect('EBUSY', os.write, fd, b'deadman_ms 1')
assert rests()
os.write(fd, b'priority 0 deadman_ms 0')
os.write(value, b'100 1')
assert state() == RUNS
os.close(fd)
eventually(rests, 'rest')
os.write(value, b'100 1')
assert state() == RUNS
for name, data in (('EINVAL', b'priority'), ('EINVAL', b'please'), ('ERANGE', b'priority 101'), ('ERANGE', b'deadman_ms 60001'),
                   ('EINVAL', b'\\xff')):
    # The kernel tells of a close a moment after it returned: until then the one before has the lease.
    eventually(lambda: owner() == '\\n')
    expect(name, put, 'motor/owner', data)
",
    );
}

#[test]
fn a_stopped_holder_is_brought_to_rest_and_does_not_go_on() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
read_end, write_end = os.pipe()
def act():
    fd = take()
    os.write(fd, b'deadman_ms 200')
    value = os.open(M + '/motor/value', os.O_WRONLY)
    os.write(write_end, b'.')
    try:
        while True: os.write(value, b'100 1')
    except OSError as error:
        os._exit(error.errno)
child = forked(act)
os.read(read_end, 1)
eventually(lambda: state() == RUNS)
os.kill(child, signal.SIGSTOP)
eventually(rests, 'rest of a stopped program')
os.kill(child, signal.SIGCONT)
assert ended(child) == errno.EBUSY
assert rests()
",
    );
}

#[test]
fn a_higher_priority_takes_over_and_a_lower_one_does_not() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
told, tell = os.pipe()
def act():
    fd = take(os.O_RDWR)
    os.write(fd, b'priority 20')
    put('motor/value', b'100 1')
    watcher = select.poll()
    watcher.register(fd, 0)
    os.write(tell, b'.')
    ((_, events),) = watcher.poll(60000)
    assert events & select.POLLERR and events & select.POLLHUP, events
    expect('EBUSY', put, 'motor/value', b'100 1')
    os.write(tell, b'.')
    signal.pause()
child = forked(act)
os.read(told, 1)
def wins():
    expect('EBUSY', take)
    fd = take(os.O_RDWR)
    for wish in (b'\\n', b'priority 0', b'priority 20', b'deadman_ms 5'):
        expect('EBUSY', os.write, fd, wish)
    expect('EBUSY', put, 'motor/value', b'1 1')
    assert state() == RUNS
    os.write(fd, b'priority 21')
    assert rests(), 'between two leases there is rest'
    assert os.pread(fd, 100, 0).decode().startswith('%d ' % os.getpid())
    assert os.read(told, 1) == b'.'
    put('motor/value', b'50 2')
    return fd
winner = kept(wins, 'the winner')
killed(child)
assert state() == b'\\x32\\2', 'the end of who lost it changes nothing'
killed(winner)
eventually(rests)
# Also a parent takes it from its child.
child = forked(act)
os.read(told, 1)
fd = take(os.O_RDWR)
os.write(fd, b'priority 21')
assert os.read(told, 1) == b'.', 'the child was told and kept out'
put('motor/value', b'50 2')
killed(child)
assert state() == b'\\x32\\2'
",
    );
}

#[test]
fn stop_reaches_an_actuator_under_a_lease_which_stays() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
child = held()
put('stop', b'1')
assert rests()
assert owner().startswith('%d ' % child)
expect('EBUSY', put, 'motor/value', b'1 1')
killed(child)
",
    );
}

#[test]
fn a_reload_keeps_the_lease_of_what_did_not_change_and_ends_the_others() {
    let Some(m) = robot() else { return };
    m.board().file("other", ".");
    let more = ROBOT.replace(
        "lamp =",
        "other = { src = '$DIR/other', input_tuple_size = 1 }, lamp =",
    );
    let changed = m
        .board()
        .fill_in(&more.replace("rest = { 0, 7 }", "rest = { 0, 8 }"));
    let gone = m.board().fill_in("trikfs = {}");
    python(
        &m,
        &format!(
            "
fd = take(os.O_RDWR)
put('motor/value', b'100 1')
put('config', br\"\"\"{}\"\"\")
assert os.path.exists(M + '/other/value')
assert owner().startswith('%d ' % os.getpid()) and state() == RUNS
put('motor/value', b'100 2')
put('config', br\"\"\"{changed}\"\"\")
assert state() in (RESTS, b'\\0\\x08'), state()
expect('ESTALE', os.write, fd, b'priority 1')
expect('ESTALE', os.pread, fd, 10, 0)
assert select.POLLERR & ready(fd)[0]
assert owner() == '\\n'
again = take()
put('motor/value', b'100 1')
put('config', br\"\"\"{gone}\"\"\")
assert state() == b'\\0\\x08', state()
expect('ESTALE', os.write, again, b'priority 1')
",
            m.board().fill_in(&more)
        ),
    );
}

#[test]
fn a_thousand_openings_leave_one_holder_and_nothing_behind() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
fd = take()
readers = [open_ro(M + '/motor/owner') for _ in range(1000)]
askers = [take(os.O_RDWR) for _ in range(1000)]
for _ in range(1000): expect('EBUSY', take)
put('motor/value', b'100 1')
assert state() == RUNS
for one in askers + readers: os.close(one)
assert owner().startswith('%d ' % os.getpid()) and state() == RUNS
os.close(fd)
eventually(lambda: owner() == '\\n')
for _ in range(1000):
    fd = take(os.O_RDWR)
    os.write(fd, b'priority 0')
    os.close(fd)
    # The kernel tells of the end of a file later, and the second transport has a thread for each request.
    eventually(lambda: owner() == '\\n')
",
    );
}

#[test]
fn two_programs_that_fight_for_a_lease_never_both_drive() {
    let Some(m) = robot() else { return };
    python(
        &m,
        "
def fight(mine):
    won = 0
    while won < 30:
        try:
            fd = take()
        except OSError as error:
            assert error.errno == errno.EBUSY
            continue
        try:
            for _ in range(20):
                put('motor/bin_data', mine)
                seen = state()
                assert seen == mine, (mine, seen)
        finally:
            os.close(fd)
        won += 1
children = [forked(lambda mine=mine: fight(mine)) for mine in (b'aa', b'bb', b'cc')]
for child in children: assert ended(child) == 0
eventually(rests)
",
    );
}

#[test]
fn a_lease_ends_with_the_daemon_and_the_actuator_rests() {
    let Some(m) = robot() else { return };
    let mut holder = std::process::Command::new("sh")
        .args([
            "-c",
            "exec 3>motor/owner; echo 100 1 > motor/value; exec sleep 1000",
        ])
        .current_dir(m.root())
        .spawn()
        .unwrap();
    eventually("a holder", || m.board().content("motor") == [100, 1]);
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || m.board().content("motor") == [0, 7]);
    eventually("another daemon", || {
        processes::children(m.guardian())
            .iter()
            .any(|&pid| pid != daemon)
    });
    eventually("a free lease", || {
        m.read("motor/owner").is_ok_and(|line| line == b"\n")
    });
    m.sh("echo 50 2 > motor/value");
    assert_eq!(m.board().content("motor"), [50, 2]);
    holder.kill().unwrap();
    holder.wait().unwrap();
    assert_eq!(m.board().content("motor"), [50, 2]);
}

#[test]
fn who_is_kept_out_finds_the_holder_in_the_log_and_in_owner() {
    let Some(m) = robot() else { return };
    m.python(&format!(
        "{WORDS}
child = held()
expect('EBUSY', put, 'motor/value', b'1 1')
expect('EBUSY', put, 'motor/brake', b'1')
expect('EBUSY', take)
log = os.read(open_ro(M + '/log', os.O_NONBLOCK), 1 << 16).decode()
name = text('/proc/%d/comm' % child).strip()
reason = 'process %d (%s) holds the lease with priority 0: see motor/owner\\n' % (child, name)
assert '] motor: caller: ' + reason in log, log
assert '] motor/brake: caller: ' + reason in log, log
assert owner() == '%d %s priority 0 deadman_ms 0\\n' % (child, name), owner()
# Nothing is broken.
assert text(M + '/motor/fault') == '' and stat_of(M + '/motor/stats', 'faults') == 0
killed(child)
"
    ));
}
