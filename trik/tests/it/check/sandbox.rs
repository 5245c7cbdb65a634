//! Solutions in Python that want more than to drive a robot: their judge, the computer, all of its memory.

mod readonly;

use super::{drive, world};
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use std::fs;
use std::os::unix::fs::{PermissionsExt, chown};
use std::process::Command;
use std::time::{Duration, Instant};

/// Each line of a program `tries` something; it says what came of it.
const TRIES: &str = "import ctypes, mmap, os, signal, socket
libc = ctypes.CDLL(None, use_errno=True)
def tries(name, deed):
    try:
        print(name, 'refused' if deed() == -1 else 'done')
    except (OSError, MemoryError):
        print(name, 'refused')
def number(deed):
    try:
        return ctypes.get_errno() if deed() == -1 else 0
    except OSError as error:
        return error.errno
";

/// A world, and a folder that everybody may read, as those of graders are.
fn board() -> Board {
    let board = Board::new();
    board.file("far.xml", world(300));
    let everybody = fs::Permissions::from_mode(0o755);
    fs::set_permissions(board.dir(), everybody.clone()).expect("its mode");
    fs::create_dir(board.path("class")).expect("a folder");
    fs::set_permissions(board.path("class"), everybody).expect("its mode");
    board
}

/// With the Python of the system, which everybody may read.
fn trik(board: &Board, words: &[&str]) -> Output {
    let mut command = Command::new(TRIK);
    command.env("PATH", "/usr/local/bin:/usr/bin:/bin");
    tools::run(command.args(words).current_dir(board.dir()), b"")
}

fn check(board: &Board, program: &str, more: &[&str]) -> Output {
    board.file("class/a.py", program);
    let words = [&["check", "class/a.py", "--field", "far.xml"], more].concat();
    trik(board, &words)
}

/// What a program printed, in a sandbox of which nothing is missing.
fn printed(board: &Board, program: &str) -> Vec<String> {
    let output = check(board, program, &["--require-sandbox"]);
    assert_eq!(output.stderr, "", "{}", output.stdout);
    let lines = output.stdout.lines();
    let printed: Vec<_> = lines
        .filter_map(|line| Some(line.strip_prefix("print: ")?.to_owned()))
        .collect();
    assert!(!printed.is_empty(), "{}", output.stdout);
    printed
}

/// Whether all layers are here; nothing is seen of those that are not.
fn is_whole(board: &Board) -> bool {
    let output = check(board, "print(1)", &["--require-sandbox"]);
    let is_whole = !output.stderr.contains("--require-sandbox");
    if !is_whole {
        needs::Need::Extra.missing(&output.stderr);
    }
    is_whole
}

#[test]
fn a_solution_neither_sees_its_judge_nor_looks_into_anybody() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let program = format!(
        "{TRIES}
print('others', sorted(name for name in os.listdir('/proc') if name.isdigit() and int(name) != os.getpid()))
print('parent', os.getppid())
tries('memory', lambda: open('/proc/%d/mem' % os.getppid(), 'rb').read(1))
tries('trace', lambda: libc.ptrace(0, 0, 0, 0))
buffer = ctypes.create_string_buffer(8)
class Piece(ctypes.Structure):
    _fields_ = [('base', ctypes.c_void_p), ('size', ctypes.c_size_t)]
piece = Piece(ctypes.addressof(buffer), 8)
# Of itself, so that nothing but the filter refuses.
print('read', number(lambda: libc.process_vm_readv(os.getpid(), ctypes.byref(piece), 1, ctypes.byref(piece), 1, 0)))
print('write', number(lambda: libc.process_vm_writev(os.getpid(), ctypes.byref(piece), 1, ctypes.byref(piece), 1, 0)))
print('descriptor', number(lambda: libc.syscall(438, libc.syscall(434, os.getpid(), 0), 0, 0)))
print('immortal', number(lambda: libc.prctl(1, 0)))
"
    );
    let wanted = [
        "others []",
        "parent 0",
        "memory refused",
        "trace refused",
        "read 1",
        "write 1",
        "descriptor 1",
        "immortal 1",
    ];
    assert_eq!(printed(&board, &program), wanted);
}

#[test]
fn a_solution_cannot_kill_its_judge() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let program = "import os, signal
parent = os.getppid()
if parent: os.kill(parent, signal.SIGKILL)
print('judged')
";
    assert_eq!(printed(&board, program), ["judged"]);
    // All that it sees is itself and what it has started.
    let program = "import os, signal, time
child = os.fork()
if not child: signal.pause()
os.kill(-1, signal.SIGKILL)
print(os.WTERMSIG(os.waitpid(child, 0)[1]), os.getpid())
";
    assert_eq!(printed(&board, program), ["9 1"]);
    let output = check(&board, "import os\nos.killpg(0, 9)", &[]);
    assert_eq!(output.code(), 1, "{}{}", output.stdout, output.stderr);
}

#[test]
fn a_solution_has_no_sockets_mounts_and_namespaces() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let program = format!(
        "{TRIES}
for family in (socket.AF_INET, socket.AF_UNIX, socket.AF_NETLINK, socket.AF_PACKET):
    print('socket', number(lambda: socket.socket(family, socket.SOCK_RAW if family > 2 else socket.SOCK_STREAM).close()))
# Numbers of x86-64 of calls that say something else than EPERM without the filter: perf_event_open, keyctl,
# io_uring_setup, setns, mq_open; and ptrace of programs of 32 bits in 64. The other ones are known to a test of the filter.
is_known = os.uname().machine == 'x86_64'
for call in (298, 250, 425, 308, 240, 101 | 0x40000000):
    told = number(lambda: libc.syscall(call, 0, 0, 0, 0, 0)) if is_known else 1
    print('call', 1 if told == 38 and call > 1000 else told)
for flag in (0x20000, 0x10000000, 0x20000000, 0x40000000):
    print('clone', number(lambda: libc.syscall(56, flag | 17, 0, 0, 0, 0)) if is_known else 1)
for kind in (socket.SOCK_DGRAM, socket.SOCK_SEQPACKET, socket.SOCK_RAW):
    print('pair', number(lambda: [one.close() for one in socket.socketpair(socket.AF_UNIX, kind)] and 0))
print('pair', number(lambda: [one.close() for one in socket.socketpair(socket.AF_TIPC)] and 0))
tries('unshare', lambda: libc.unshare(0x10000000))
tries('mount', lambda: libc.mount(b'none', os.getcwd().encode(), b'tmpfs', 0, 0))
tries('system', lambda: os.listdir('/sys'))
tries('pair', lambda: [one.close() for one in socket.socketpair()] and 0)
"
    );
    let told = printed(&board, &program);
    let (pair, refused) = told.split_last().expect("lines");
    assert_eq!((refused.len(), &**pair), (21, "pair done"), "{told:?}");
    assert!(
        refused
            .iter()
            .all(|line| line.ends_with("refused") || line.ends_with(" 1")),
        "{told:?}"
    );
}

#[test]
fn a_solution_reads_its_folder_and_writes_nothing_but_its_scratch_folder() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    board.file("secret.txt", "the tests of the teacher");
    board.file("class/beside.txt", "beside");
    board.file("class/helper.py", "def help(): return 'helped'");
    let dir = board.dir().display().to_string();
    let program = format!(
        "{TRIES}
import tempfile, helper
print(helper.help(), open({dir:?} + '/class/beside.txt').read(), open('class/beside.txt').read())
for file in ('secret.txt', 'far.xml', '../../../etc/passwd', '../../etc/hostname'):
    tries('read', lambda: open({dir:?} + '/' + file).read())
for place in ({dir:?}, {dir:?} + '/class', '/tmp', '/var/tmp', '/dev', os.path.expanduser('~')):
    tries('write', lambda: open(place + '/trik-was-here', 'w'))
tries('change', lambda: open({dir:?} + '/class/beside.txt', 'a'))
tries('remove', lambda: os.remove({dir:?} + '/class/beside.txt'))
tries('kernel', lambda: open('/proc/sys/kernel/core_pattern', 'r+'))
with tempfile.TemporaryFile() as file:
    file.write(b'scratch')
    file.flush()
    def fill():
        for at in range(100):
            with open(tempfile.gettempdir() + '/%d' % at, 'wb') as one: one.write(bytes(1 << 20))
    tries('fill', fill)
print(os.getuid() if os.getuid() == 65534 else 'own', open(os.devnull, 'r+').write(''))
"
    );
    let told = printed(&board, &program);
    let (last, told) = told.split_last().expect("lines");
    assert_eq!(told[0], "helped beside beside");
    assert_eq!(told.len(), 15, "{told:?}");
    assert!(
        told[1..].iter().all(|line| line.ends_with("refused")),
        "{told:?}"
    );
    assert_eq!(
        fs::read_to_string(board.path("class/beside.txt")).expect("a file"),
        "beside"
    );
    let user = if nix::unistd::geteuid().is_root() {
        "65534"
    } else {
        "own"
    };
    assert_eq!(*last, format!("{user} 0"));
}

#[test]
fn a_solution_changes_no_rights_times_and_notes_of_files() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    // Each would be done in the scratch folder, or say something else than EPERM, without the filter.
    let program = format!(
        "{TRIES}
path = '/dev/shm/own'
file = open(path, 'wb')
file.write(b'scratch')
file.flush()
text = path.encode()
import fcntl
is_known = os.uname().machine == 'x86_64'
for deed in (
    lambda: os.truncate(path, 0),
    lambda: os.chmod(path, 0o700),
    lambda: os.chmod(file.fileno(), 0o700),
    lambda: os.chmod('own', 0o700, dir_fd=os.open('/dev/shm', os.O_RDONLY)),
    lambda: libc.syscall(452, -100, text, 0o700, 0),
    lambda: os.chown(path, -1, -1),
    lambda: os.lchown(path, -1, -1),
    lambda: os.fchown(file.fileno(), -1, -1),
    lambda: os.utime(path),
    lambda: os.utime(file.fileno()),
    lambda: os.setxattr(path, 'user.note', b'x'),
    lambda: os.setxattr(path, 'user.note', b'x', follow_symlinks=False),
    lambda: os.setxattr(file.fileno(), 'user.note', b'x'),
    lambda: os.removexattr(path, 'user.note'),
    lambda: os.removexattr(file.fileno(), 'user.note'),
    # FS_IOC_SETFLAGS, the one of 32 bits, FS_IOC_FSSETXATTR; TIOCSTI and TIOCLINUX, which type into a terminal.
    lambda: fcntl.ioctl(file.fileno(), 0x40086602, bytes(8)),
    lambda: fcntl.ioctl(file.fileno(), 0x40046602, bytes(8)),
    lambda: fcntl.ioctl(file.fileno(), 0x401c5820, bytes(28)),
    lambda: fcntl.ioctl(file.fileno(), 0x5412, b'x'),
    lambda: fcntl.ioctl(file.fileno(), 0x541c, b'x'),
):
    print(number(deed))
# Numbers of x86-64: chmod, chown, lchown, utime, utimes, futimesat.
for call in (90, 92, 94, 132, 235, 261):
    print(number(lambda: libc.syscall(call, 0, 0, 0, 0)) if is_known else 1)
os.ftruncate(file.fileno(), 3)
print(os.path.getsize(path))
"
    );
    let told = printed(&board, &program);
    let (size, refused) = told.split_last().expect("lines");
    assert_eq!((refused.len(), &**size), (26, "3"), "{told:?}");
    assert!(refused.iter().all(|line| line == "1"), "{told:?}");
}

#[test]
fn a_solution_has_nothing_that_its_judge_was_left_open() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    board.file("secret.txt", "the tests of the teacher");
    board.file(
        "class/a.py",
        "import os
try: print(os.read(9, 100))
except OSError as error: print('none', error.errno)
print(sorted(int(name) for name in os.listdir('/proc/self/fd'))[:3])
",
    );
    let mut command = Command::new("sh");
    command
        .env("PATH", "/usr/local/bin:/usr/bin:/bin")
        .args(["-c", "exec 9<secret.txt && exec \"$0\" \"$@\"", TRIK])
        .args("check class/a.py --field far.xml --require-sandbox".split(' '))
        .current_dir(board.dir());
    let output = tools::run(&mut command, b"");
    // EBADF.
    assert!(
        output.stdout.contains("print: none 9\n") && output.stdout.contains("print: [0, 1, 2]\n"),
        "{}{}",
        output.stdout,
        output.stderr
    );
}

#[test]
fn a_solution_that_takes_all_its_processes_leaves_others_theirs() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let hoard = "import os, signal
try:
    while True:
        if os.fork() == 0: signal.pause()
except OSError: pass
signal.pause()
";
    let good = "import os
forked = 0
for _ in range(10):
    children = []
    read, write = os.pipe()
    for _ in range(30):
        child = os.fork()
        if child == 0:
            os.close(write)
            os.read(read, 1)
            os._exit(0)
        children.append(child)
    os.close(write)
    for child in children: os.waitpid(child, 0)
    os.close(read)
    forked += len(children)
print(forked)
";
    board.file("class/a.py", hoard);
    board.file("class/b.py", good);
    board.file("class/c.py", good);
    let words =
        "check class --field far.xml --jobs 3 --wall-limit 20 --results - --require-sandbox";
    let output = trik(&board, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(
        output.stdout.matches("\"printed\":[\"300\"]").count(),
        2,
        "{}{}",
        output.stdout,
        output.stderr
    );
    assert!(output.stdout.contains("does not wait"), "{}", output.stdout);
}

/// Processes that stand in a folder.
fn standing(board: &Board) -> usize {
    let processes = fs::read_dir("/proc").expect("processes").flatten();
    let places = processes.filter_map(|one| fs::read_link(one.path().join("cwd")).ok());
    places.filter(|place| place == board.dir()).count()
}

#[test]
fn a_solution_that_forks_without_end_is_over_with_its_time() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let bomb = "import os, signal
for number in range(1, 32):
    if number not in (signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD): signal.signal(number, signal.SIG_IGN)
def forever():
    while True:
        try: os.fork() or os.setsid()
        except OSError: pass
if os.fork() == 0: forever()
sum(range(10 ** 12))
";
    let began = Instant::now();
    let output = check(&board, bomb, &["--wall-limit", "2", "--results", "-"]);
    let took = began.elapsed();
    assert_eq!(output.code(), 2, "{}{}", output.stdout, output.stderr);
    assert!(output.stdout.contains("does not wait"), "{}", output.stdout);
    assert_eq!(standing(&board), 0);
    // Without an end, but for the limit: with room for a machine that is busy.
    assert!(took < Duration::from_secs(60), "{took:?}");
    // There were never more than a few at once.
    let count = "import os
children = 0
try:
    while children < 500:
        if os.fork() == 0: os.read(os.pipe()[0], 1)
        children += 1
except OSError: pass
print(20 < children < 81)
";
    assert_eq!(printed(&board, count), ["True"]);
    assert_eq!(standing(&board), 0);
}

#[test]
fn a_solution_that_takes_memory_without_end_gets_no_more_than_it_may() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let program = format!(
        "{TRIES}
def grow():
    pieces = []
    while True: pieces.append(bytes(1 << 20))
tries('memory', grow)
tries('file', lambda: os.memfd_create('x'))
tries('shared', lambda: libc.shmget(0, 1 << 30, 0o1600))
def open_all():
    while True: os.pipe()
tries('open', open_all)
"
    );
    board.file("class/a.py", &program);
    let words = "check class/a.py --field far.xml --memory 128";
    let output = trik(&board, &words.split(' ').collect::<Vec<_>>());
    let told = output
        .stdout
        .lines()
        .filter(|line| line.ends_with(" refused"));
    assert_eq!(told.count(), 4, "{}{}", output.stdout, output.stderr);
}

#[test]
fn what_is_missing_is_told_once_and_refused_on_demand() {
    let board = board();
    if !is_whole(&board) {
        return;
    }
    board.file("class/a.py", "print(1)");
    board.file("class/b.py", "print(2)");
    let words = ["check", "class", "--field", "far.xml"];
    let layers = [
        "user",
        "processes",
        "mounts",
        "network",
        "messages",
        "calls",
        "files",
    ];
    for layer in layers {
        let seam = format!("--without-layer={layer}");
        let told = trik(&board, &[&words[..], &[&seam]].concat());
        let line =
            format!("trik: solutions in Python run without a layer of their sandbox: {layer}: ");
        assert_eq!(
            told.stderr.matches("without a layer").count(),
            1,
            "{}",
            told.stderr
        );
        assert!(told.stderr.starts_with(&line), "{}", told.stderr);
        assert!(
            told.stdout.contains("2 runs: 0 accomplished"),
            "{}",
            told.stdout
        );
        let refused = trik(
            &board,
            &[&words[..], &[&seam, "--require-sandbox"]].concat(),
        );
        assert_eq!(
            (refused.code(), &*refused.stdout),
            (2, ""),
            "{}",
            refused.stderr
        );
        assert!(
            refused.stderr.contains("nothing was run"),
            "{}",
            refused.stderr
        );
    }
    let whole = trik(&board, &[&words[..], &["--require-sandbox"]].concat());
    assert_eq!((whole.code(), &*whole.stderr), (1, ""), "{}", whole.stdout);
    // Who judges no Python needs no sandbox.
    board.file("far.js", "script.wait(10);");
    let other = [
        &["check", "far.js", "--field", "far.xml", "--require-sandbox"],
        &["--without-layer=files"][..],
    ];
    let other = trik(&board, &other.concat());
    assert_eq!((other.code(), &*other.stderr), (1, ""), "{}", other.stdout);
}

#[test]
fn who_is_root_and_reads_what_nobody_else_may_is_told_so() {
    if !nix::unistd::geteuid().is_root() {
        return;
    }
    let board = board();
    if !is_whole(&board) {
        return;
    }
    fs::set_permissions(board.path("class"), fs::Permissions::from_mode(0o700)).expect("its mode");
    let program = format!(
        "{TRIES}
children = 0
try:
    while children < 500:
        if os.fork() == 0: os.read(os.pipe()[0], 1)
        children += 1
except OSError: pass
tries('forks', lambda: -1 if children < 400 else 0)
tries('kernel', lambda: open('/proc/sys/kernel/core_pattern', 'r+'))
tries('password', lambda: open('/etc/shadow'))
tries('owner', lambda: os.chown('class/a.py', 0, 0))
"
    );
    let output = check(&board, &program, &[]);
    assert!(
        output.stderr.contains("sandbox: user: ") && output.stderr.contains("chmod o+rX"),
        "{}",
        output.stderr
    );
    assert_eq!(
        output.stdout.matches(" refused").count(),
        4,
        "{}",
        output.stdout
    );
    let refused = check(&board, &program, &["--require-sandbox"]);
    assert_eq!(
        (refused.code(), &*refused.stdout),
        (2, ""),
        "{}",
        refused.stderr
    );
    // With no namespace of users either, as in some containers, it has no right of root.
    let rights = "for line in open('/proc/self/status'):
    if line.startswith('Cap'): print(int(line.split()[1], 16))
";
    let output = check(&board, rights, &["--without-layer=user"]);
    let printed = output.stdout.matches("print: 0\n").count();
    assert_eq!(printed, 5, "{}{}", output.stdout, output.stderr);
}

#[test]
fn the_solution_of_a_pupil_who_shows_it_to_nobody_runs_as_the_pupil() {
    if !nix::unistd::geteuid().is_root() {
        return;
    }
    let board = board();
    if !is_whole(&board) {
        return;
    }
    let program =
        "import os, helper\nprint(helper.help(), os.getuid(), os.getgid(), os.getgroups())";
    board.file("class/helper.py", "def help(): return 'helped'");
    let class = board.path("class");
    fs::set_permissions(&class, fs::Permissions::from_mode(0o700)).expect("its mode");
    for path in [class.clone(), class.join("helper.py")] {
        chown(&path, Some(1234), Some(2345)).expect("its owner");
    }
    assert_eq!(printed(&board, program), ["helped 1234 2345 []"]);
}

#[test]
fn rules_that_say_a_megabyte_in_each_tick_take_bounded_memory() {
    let board = board();
    let long = "x".repeat(1 << 20);
    let rule = format!(
        "<event id=\"again\" settedUpInitially=\"true\" dropsOnFire=\"false\"><condition><timer timeout=\"0\" forceDropOnTimeout=\"false\"/></condition><triggers><message text=\"{long}\"/></triggers></event>"
    );
    let world = world(300).replace(
        "<timelimit value=\"10000\"/>",
        &format!("<timelimit value=\"10000\"/>{rule}"),
    );
    assert!(world.contains("again"));
    board.file("class/a.qrs", drive("5000", Some(&world)));
    let output = trik(&board, &["check", "class/a.qrs", "--memory", "128"]);
    assert_eq!(output.code(), 0, "{:.2000}{}", output.stdout, output.stderr);
    assert!(
        output.stdout.contains("or 8 MiB of them"),
        "{:.2000}",
        output.stdout
    );
    assert!(output.stdout.len() < 1 << 20, "{}", output.stdout.len());
}
