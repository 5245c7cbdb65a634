//! What the system lacks or refuses: it is told, and no converter is blamed for it.

use super::{CONFIG, HOSTILE};
use crate::{is_of_the_controller, program};
use harness::{Board, Mount, Setting};

/// Becomes a program to which the kernel says that it has no seccomp: a filter answers as a kernel without it does.
const WITHOUT_SECCOMP: &str = "
import ctypes, os, platform, struct, sys
seccomp, prctl = {'x86_64': (317, 157), 'aarch64': (277, 167)}[platform.machine()]
code = [(0x20, 0, 0, 0), (0x15, 0, 1, seccomp), (6, 0, 0, 0x50000 | 38),
        (0x15, 0, 3, prctl), (0x20, 0, 0, 16), (0x15, 0, 1, 22), (6, 0, 0, 0x50000 | 22), (6, 0, 0, 0x7fff0000)]
code = ctypes.create_string_buffer(b''.join(struct.pack('=HBBI', *one) for one in code))
filter = struct.pack('@HP', 8, ctypes.addressof(code))
libc = ctypes.CDLL(None, use_errno=True)
if libc.prctl(22, 2, filter) != 0: sys.exit('a filter of system calls: ' + os.strerror(ctypes.get_errno()))
os.execvp(sys.argv[1], sys.argv[1:])
";

/// Mounted where the kernel has no filters of system calls; an emulator of processors has none anyway.
fn without_seccomp(config: &str) -> Option<Mount> {
    let is_emulated = is_of_the_controller();
    if !is_emulated && !nix::unistd::geteuid().is_root() {
        harness::wait::note_skip("only root has filters of system calls and mounts after that");
        return None;
    }
    let board = Board::new();
    board.library("hostile.so", HOSTILE);
    board.file("raw", "A");
    board.file("quiet", "A");
    Mount::new(Setting {
        program: program(),
        board,
        config,
        options: &[],
        launcher: if is_emulated {
            &[]
        } else {
            &["python3", "-c", WITHOUT_SECCOMP]
        },
    })
}

#[test]
fn a_kernel_without_seccomp_is_told_once_in_the_log_with_the_nodes_and_what_it_means() {
    let Some(m) = without_seccomp(CONFIG) else {
        return;
    };
    let told = |whose: &str| {
        let line = format!(
            "{whose}: this kernel has no filters of system calls (seccomp): the isolated converter is held by limits of memory and the user's rights alone"
        );
        m.log().matches(&line).count()
    };
    assert_eq!(m.read("bad/device").unwrap(), b"A\x01");
    assert_eq!(told("node bad"), 1, "{}", m.log());
    // Neither another process nor a configuration that leaves the node as it is says it again.
    let process = super::process_of(&m);
    super::signal(process, nix::sys::signal::Signal::SIGKILL);
    assert_eq!(super::in_the_end(&m)[0], b'A');
    assert_ne!(super::process_of(&m), process);
    let config = m.board().fill_in(CONFIG);
    m.apply(&format!("{config} trikfs.more = trikfs.good"))
        .unwrap();
    assert_eq!(told("node bad"), 1, "{}", m.log());
    // Others that come do.
    m.apply(&format!(
        "{config} trikfs.a = trikfs.bad trikfs.b = trikfs.bad"
    ))
    .unwrap();
    assert_eq!(told("nodes a, b"), 1, "{}", m.log());
    assert_eq!(told("node bad"), 1, "{}", m.log());
}

#[test]
fn a_process_that_cannot_be_started_is_the_systems_fault_and_is_tried_again() {
    let Some(m) = super::hostile() else { return };
    // While the daemon may open nothing, there is neither memory for another process nor a way to start it.
    m.python(&format!(
        "
fd = open_ro(M + '/bad/device')
assert os.pread(fd, 2, 0) == b'A\\x01'
daemon, process = {}, {}
soft, hard = resource.prlimit(daemon, resource.RLIMIT_NOFILE)
def fault(): return open(M + '/bad/fault').read()
def refused():
    try: os.pread(fd, 2, 0)
    except OSError as error: assert error.errno == errno.EIO, error
    return fault().startswith('system: ')
resource.prlimit(daemon, resource.RLIMIT_NOFILE, (3, hard))
try:
    os.kill(process, 9)
    eventually(refused, 'a process that does not come')
    told = fault()
    assert told.startswith('system: hostile.so: its process cannot be started: Too many open files'), told
finally:
    resource.prlimit(daemon, resource.RLIMIT_NOFILE, (soft, hard))
def works():
    try: return os.pread(fd, 2, 0) == b'A\\x01'
    except OSError: return False
eventually(works, 'another process')
assert fault() == '', fault()
",
        m.daemon(),
        super::process_of(&m)
    ));
    let log = m.log();
    assert!(
        log.contains("bad: system: hostile.so: its process cannot be started"),
        "{log}"
    );
    assert!(
        !log.contains("bad: converter: hostile.so: its process cannot"),
        "{log}"
    );
}

#[test]
fn more_isolated_nodes_than_any_computer_may_have_are_refused_and_the_former_ones_stay() {
    let Some(m) = super::hostile() else { return };
    m.read("bad/device").unwrap();
    let process = super::process_of(&m);
    let config = m.board().fill_in(CONFIG);
    let many = |count: u32| {
        format!("{config} local bad = trikfs.bad for i = 1, {count} do trikfs['n' .. i] = bad end")
    };
    let line = m.apply(&many(256)).unwrap_err();
    assert!(
        line.contains("isolate: the configuration has 257 isolated nodes"),
        "{line}"
    );
    assert_eq!(super::process_of(&m), process);
    assert_eq!(m.read("bad/device").unwrap()[0], b'A');
    // `check` refuses it too.
    m.board().file("many.lua", many(256));
    let output = crate::trikfs(m.board(), &["check", "many.lua"], b"");
    assert_eq!(output.code(), 1, "{}", output.stderr);
    assert!(
        output.stderr.contains("257 isolated nodes"),
        "{}",
        output.stderr
    );
}
