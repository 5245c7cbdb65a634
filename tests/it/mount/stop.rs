//! Bringing actuators to rest: on request, at the end, and each of them.

use crate::mount_on;
use harness::Board;

const MOTORS: &str = "trikfs = {
  left = { src = '$DIR/left', input_tuple_size = 2, format = 'i8 speed, u8 mode', rest = { 0, 7 } },
  right = { src = '$DIR/right', input_tuple_size = 1, output_tuple_size = 1, rest = { 0 },
    converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0) + 64) end },
  lamp = { src = '$DIR/lamp', input_tuple_size = 1 },
}";

fn board() -> Board {
    let board = Board::new();
    board.file("left", "..");
    board.file("right", ".");
    board.file("lamp", ".");
    board
}

fn drive(m: &harness::Mount) {
    m.sh("echo 100 1 > left/value; printf '\\012' > right/device; printf on | dd of=lamp/device bs=1 conv=notrunc 2>/dev/null");
    assert_eq!(m.board().content("left"), [100, 1]);
    assert_eq!(m.board().content("right"), [10 + 64]);
}

fn at_rest(board: &Board) -> bool {
    board.content("left") == [0, 7] && board.content("right") == [64]
}

#[test]
fn any_write_to_stop_brings_every_actuator_to_rest() {
    let Some(m) = mount_on(board(), MOTORS) else {
        return;
    };
    for word in ["1", "stop", "x"] {
        drive(&m);
        m.sh(&format!("echo {word} > stop"));
        assert!(at_rest(m.board()), "{word}");
    }
    assert_eq!(m.board().content("lamp"), b"n");
}

#[test]
fn the_end_of_the_filesystem_brings_actuators_to_rest() {
    let Some(mut m) = mount_on(board(), MOTORS) else {
        return;
    };
    drive(&m);
    assert!(m.stop().success());
    assert!(at_rest(m.board()));
    assert!(!m.is_mounted());
}

#[test]
fn unmounting_brings_actuators_to_rest() {
    let Some(mut m) = mount_on(board(), MOTORS) else {
        return;
    };
    drive(&m);
    let root = m.root().to_str().unwrap().to_owned();
    assert_eq!(crate::trikfs(m.board(), &["umount", &root], b"").code(), 0);
    assert!(m.wait().success());
    assert!(at_rest(m.board()));
}

#[test]
fn one_actuator_that_fails_keeps_no_other_from_resting() {
    let board = board();
    std::fs::remove_file(board.path("left")).unwrap();
    let Some(m) = mount_on(board, MOTORS) else {
        return;
    };
    m.board().file("right", "!");
    let error = m.write("stop", "1").unwrap_err();
    assert_eq!(error.raw_os_error(), Some(libc::ENODEV));
    assert_eq!(m.board().content("right"), [64]);
    assert!(
        m.text("left/fault").starts_with("device: "),
        "{}",
        m.text("left/fault")
    );
    m.board().file("left", "..");
    m.write("stop", "1").unwrap();
    assert!(at_rest(m.board()));
}

#[test]
fn a_rest_that_does_not_fit_its_format_refuses_the_configuration() {
    let Some(m) = mount_on(board(), MOTORS) else {
        return;
    };
    for rest in ["{ 0 }", "{ 200, 0 }", "{ 0, 0, 0 }", "'off'", "{ 'a', 0 }"] {
        let line = m.apply(&MOTORS.replace("{ 0, 7 }", rest)).expect_err(rest);
        assert!(line.contains("rest"), "{rest}: {line}");
    }
}

#[test]
fn a_program_that_ends_with_the_file_open_loses_its_actuator() {
    let Some(m) = mount_on(board(), MOTORS) else {
        return;
    };
    m.python(
        "left = D + '/left'
def drive(end):
    read_end, write_end = os.pipe()
    def act():
        fd = os.open(M + '/left/value', os.O_WRONLY)
        os.write(fd, b'100 1')
        os.write(write_end, b'.')
        end(fd)
    child = forked(act)
    os.read(read_end, 1)
    return child
def rests(): return open(left, 'rb').read() == b'\\0\\7'
for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGSEGV):
    child = drive(lambda fd: signal.pause())
    assert open(left, 'rb').read() == b'\\x64\\1'
    os.kill(child, number)
    ended(child)
    eventually(rests, 'rest after signal %d' % number)
ended(drive(lambda fd: None))
eventually(rests, 'rest after an exit')
# Who closes the file hands the actuator over.
ended(drive(os.close))
assert open(left, 'rb').read() == b'\\x64\\1'
",
    );
}

/// execve(2) closes descriptors while the kernel keeps others from looking at the process: a daemon that answers those
/// closes must not wait for the process (found as a mount that hung for good).
#[test]
fn a_program_that_replaces_itself_is_answered_and_keeps_or_hands_over_its_actuator() {
    let Some(m) = mount_on(board(), MOTORS) else {
        return;
    };
    m.python(
        "left = D + '/left'
def replaced(inherits, times):
    fd = os.open(M + '/left/value', os.O_WRONLY)
    draft = os.open(M + '/config', os.O_WRONLY)
    os.write(draft, b'')
    os.write(fd, b'100 1')
    os.set_inheritable(fd, inherits)
    if inherits:
        script = 'import os, signal; signal.pause()'
        os.execv(sys.executable, [sys.executable, '-c', script])
    script = '''
import os, sys
times = int(sys.argv[1])
fd = os.open(os.environ['MNT'] + '/left/value', os.O_WRONLY)
draft = os.open(os.environ['MNT'] + '/config', os.O_RDWR)
os.write(draft, os.read(draft, 10)[:0])
os.write(fd, b'100 1')
if times:
    os.execv(sys.executable, [sys.executable, '-S', '-c', os.environ['SCRIPT'], str(times - 1)])
os.close(fd)
'''
    os.environ['SCRIPT'] = script
    os.environ['MNT'] = M
    os.execv(sys.executable, [sys.executable, '-S', '-c', script, str(times)])
children = [forked(lambda: replaced(False, 20)) for _ in range(4)]
for child in children:
    assert ended(child) == 0
assert open(left, 'rb').read() == b'\\x64\\1', 'closed by execve: handed over'
child = forked(lambda: replaced(True, 0))
eventually(lambda: b'signal.pause' in open('/proc/%d/cmdline' % child, 'rb').read() and asleep(child))
assert open(left, 'rb').read() == b'\\x64\\1', 'inherited through execve'
os.kill(child, signal.SIGKILL)
ended(child)
eventually(lambda: open(left, 'rb').read() == b'\\0\\7', 'rest')
",
    );
}
