//! `isolate = true`: whatever machine code does costs its own node an error that says what happened, and nobody else anything.

mod rest;
mod system;

use super::shared::COUNTING;
use crate::{is_of_the_controller, mount_on, trikfs};
use harness::wait::eventually;
use harness::{Board, Mount, processes};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::os::unix::fs::FileExt;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Does what the first byte of a tuple says.
const HOSTILE: &str = r"
#include <errno.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
static int result(long done) { return done < 0 ? errno : 0; }
static int deep(volatile char *at) { volatile char here[4096]; here[0] = *at; return deep(here) + here[1]; }
int converter(int in_s, char *in, int out_s, char *out)
{
    static char rubbish[64] = { 5, 9, 9 };
    static int seen;
    switch (in[0]) {
    case 's': *(volatile int *)0 = 1; break;
    case 'a': abort();
    case 'e': exit(3);
    case 'h': for (;;) { }
    case 'd': return deep(in);
    case 'z': raise(SIGSTOP); return 99;
    case 'w': for (int i = 0; i < 64; i++) { write(i, rubbish, sizeof rubbish); } return 99;
    case 'c': for (int i = 0; i < 64; i++) { close(i); } return result(close(0));
    case 'f': return result(fork());
    case 'k': return result(kill(getppid(), SIGKILL));
    case 'p': return result(prctl(PR_SET_PDEATHSIG, 0));
    case 'x': return result(execl(in, in, (char *)0));
    case 'm': for (;;) { char *more = malloc(1 << 20); if (!more) return ENOMEM; more[0] = 1; }
    }
    out[0] = in[0];
    out[1] = (char)++seen;
    return 0;
}";

/// A byte, and what the fault says of it; true: the process is gone after that, and its states with it. What only fails because
/// of filters and limits is in [`DENIED`].
const DEEDS: &[(&str, &str, bool)] = &[
    ("s", "its process was ended by SIGSEGV", true),
    ("a", "its process was ended by SIGABRT", true),
    ("e", "its process ended itself with status 3", true),
    ("h", "gave no answer in ", true),
    // Of the overflow of a stack the Rust runtime makes a message and an abort.
    ("d", "its process was ended by SIG", true),
    ("z", "its process was stopped by a signal (SIGSTOP)", true),
    ("w", "converter returned 99", false),
];
const DENIED: &[(&str, &str, bool)] = &[
    ("c", "converter returned 1", false),
    ("f", "converter returned 1", false),
    ("k", "converter returned 1", false),
    ("p", "converter returned 1", false),
    ("x", "converter returned ", false),
    ("m", "converter returned 12", false),
];

const CONFIG: &str = "trikfs = {
  good = { src = '$DIR/quiet', input_tuple_size = 1, output_tuple_size = 1, converter = id_create(1) },
  bad = { src = '$DIR/raw', input_tuple_size = 1, output_tuple_size = 2, isolate = true, converter = 'hostile.so' },
}";

fn hostile() -> Option<Mount> {
    let board = Board::new();
    board.library("hostile.so", HOSTILE);
    board.file("raw", "A");
    board.file("quiet", "A");
    mount_on(board, CONFIG)
}

/// The same converter behind a pipe, which gives it batches.
fn hostile_stream() -> Option<Mount> {
    let board = Board::new();
    board.library("hostile.so", HOSTILE);
    board.fifo("in");
    let config = "trikfs = { bad = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 2, share = false, isolate = true, converter = 'hostile.so' } }";
    mount_on(board, config)
}

/// What the next tuple is; the file is never empty.
fn put(m: &Mount, byte: &str) {
    let raw = std::fs::File::options()
        .write(true)
        .open(m.board().path("raw"));
    raw.unwrap().write_all_at(byte.as_bytes(), 0).unwrap();
}

/// Reads until the process that took the place of a dead one answers: growing pauses are between them.
fn in_the_end(m: &Mount) -> Vec<u8> {
    let mut got = Vec::new();
    eventually("another process", || {
        m.read("bad/device").is_ok_and(|bytes| {
            got = bytes;
            true
        })
    });
    got
}

/// Whether the kernel holds that process to its filters and limits: an emulator of processors does not.
fn is_confined(m: &Mount) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process_of(m))).unwrap();
    let is_confined = status.contains("Seccomp:\t2");
    if !is_confined {
        harness::wait::note_skip("the emulated processor has no filters of system calls");
    }
    is_confined
}

/// The only process of isolated converters.
fn process_of(m: &Mount) -> u32 {
    let children = processes::children(m.daemon());
    assert_eq!(children.len(), 1, "one process for one node");
    children[0]
}

#[test]
fn whatever_machine_code_does_costs_its_own_node_an_error_and_no_other_node_its_latency() {
    let Some(m) = hostile() else { return };
    let daemon = m.daemon();
    let good = m.open("good/device");
    m.read("bad/device").unwrap();
    let confined = is_confined(&m);
    let (over, is_over) = channel::<()>();
    std::thread::scope(|scope| {
        let watched = scope.spawn(move || {
            let mut worst = Duration::ZERO;
            while is_over.recv_timeout(Duration::from_millis(1)) == Err(RecvTimeoutError::Timeout) {
                let start = Instant::now();
                let mut got = [0; 1];
                good.read_exact_at(&mut got, 0).unwrap();
                worst = worst.max(start.elapsed());
            }
            worst
        });
        let denied = if confined { DENIED } else { &[] };
        for (deed, word, is_gone) in DEEDS.iter().chain(denied) {
            put(&m, "A");
            assert_eq!(in_the_end(&m)[0], b'A', "before {deed}");
            put(&m, deed);
            assert_eq!(m.errno("bad/device"), libc::EIO, "{deed}");
            let fault = m.text("bad/fault");
            assert!(
                fault.starts_with("converter: hostile.so: ") && fault.contains(word),
                "{deed}: {fault}"
            );
            put(&m, "B");
            let after = in_the_end(&m);
            assert_eq!(after[0], b'B', "after {deed}");
            // What is remembered in static variables begins anew with the process.
            assert_eq!(after[1] == 1, *is_gone, "after {deed}: {after:?}");
        }
        drop(over);
        let worst = watched.join().unwrap();
        assert!(
            worst < Duration::from_secs(10),
            "a good node took {worst:?}"
        );
    });
    assert_eq!(m.daemon(), daemon, "the daemon was not replaced");
    let log = m.log();
    assert!(
        log.contains("bad: converter: hostile.so: its process was ended by SIGSEGV, and its states begin anew"),
        "{log}"
    );
}

#[test]
fn its_process_has_no_descriptors_few_rights_and_ends_with_the_daemon_even_if_it_hangs() {
    let Some(m) = hostile() else { return };
    m.read("bad/device").unwrap();
    if !is_confined(&m) {
        return;
    }
    let process = process_of(&m);
    let folder = format!("/proc/{process}");
    let open: Vec<String> = std::fs::read_dir(format!("{folder}/fd"))
        .unwrap()
        .map(|entry| std::fs::read_link(entry.unwrap().path()).unwrap())
        .map(|path| path.display().to_string())
        .collect();
    assert_eq!(open, [""; 0], "it has nothing open");
    let status = std::fs::read_to_string(format!("{folder}/status")).unwrap();
    for line in ["Seccomp:\t2", "NoNewPrivs:\t1", "Threads:\t1"] {
        assert!(status.contains(line), "{line} is not in {status}");
    }
    let limits = std::fs::read_to_string(format!("{folder}/limits")).unwrap();
    let data = limits
        .lines()
        .find(|line| line.starts_with("Max data size"));
    assert!(
        data.is_some_and(|line| line.contains("67108864")),
        "{limits}"
    );

    put(&m, "h");
    std::thread::scope(|scope| {
        let hung = scope.spawn(|| m.read("bad/device").is_err());
        eventually("it hangs", || !processes::is_asleep(process));
        kill(Pid::from_raw(m.daemon().cast_signed()), Signal::SIGKILL).unwrap();
        assert!(hung.join().unwrap());
    });
    eventually("it ends with the daemon", || !processes::is_alive(process));
}

#[test]
fn of_a_batch_in_which_it_dies_everything_before_is_delivered_and_it_goes_on_behind() {
    let Some(m) = hostile_stream() else { return };
    m.python(
        "fd, pipe = open_ro(M + '/bad/device'), feed('in')
os.write(pipe, b'ABCsDE')
assert os.read(fd, 6) == b'A\\x01B\\x02C\\x03', 'what was whole'
expect('EIO', os.read, fd, 12)
assert os.read(fd, 4) == b'D\\x01E\\x02', 'anew'
os.write(pipe, b'FG' * 20000)
got = b''
while len(got) < 80000: got += os.read(fd, 65536)
assert got[0::2] == b'FG' * 20000
assert got[1::2] == bytes((3 + i) % 256 for i in range(40000))",
    );
}

#[test]
fn states_params_faults_and_log_are_those_of_a_converter_in_the_daemon() {
    let mut seen = Vec::new();
    for isolate in [false, true] {
        let board = Board::new();
        board.library("libcounting.so", COUNTING);
        board.fifo("in");
        let config = format!(
            "trikfs = {{ n = {{ src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, share = false, isolate = {isolate},
               params = {{ start = 40 }}, converter = 'libcounting.so#counting' }} }}"
        );
        let Some(m) = mount_on(board, &config) else {
            return;
        };
        let told = m.python(
            "fd, pipe = open_ro(M + '/n/device'), feed('in')
def told(*words): print(*words)
os.write(pipe, b'a-a')
told(os.read(fd, 1), os.read(fd, 1))
os.write(pipe, b'!')
try: os.read(fd, 1)
except OSError as error: told(error.errno)
told(open(M + '/n/fault').read())
open(M + '/n/params/start', 'w').write('7')
os.write(pipe, b'a')
told(os.read(fd, 1))
try: open(M + '/n/params/start', 'w').write('-1')
except OSError as error: told(error.errno)
os.write(pipe, b'a')
told(os.read(fd, 1))",
        );
        let log = m.log();
        assert!(log.contains("n: opened"), "{log}");
        seen.push(told);
    }
    assert_eq!(seen[0], seen[1]);
    assert!(seen[0].contains("b')' b'*'"), "{}", seen[0]);
}

#[test]
fn closed_files_leave_nothing_in_its_process() {
    let Some(m) = hostile() else { return };
    m.read("bad/device").unwrap();
    let process = process_of(&m);
    let kib = || {
        let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
        let line = status
            .lines()
            .find_map(|line| line.strip_prefix("RssAnon:"));
        line.and_then(|text| text.split_whitespace().next()?.parse::<u64>().ok())
            .unwrap()
    };
    let before = kib();
    for _ in 0..3000 {
        m.read("bad/device").unwrap();
    }
    assert!(kib() <= before + 64, "{before} KiB, {} after", kib());
    assert_eq!(processes::children(m.daemon()), [process]);
}

#[test]
fn what_crashes_or_hangs_while_it_is_loaded_or_opened_is_refused_with_its_place() {
    let board = Board::new();
    let plain = "int converter(int a, char *b, int c, char *d) { return 0; }\n";
    board.library(
        "crash.so",
        &format!(
            "__attribute__((constructor)) static void begin(void) {{ __builtin_trap(); }}\n{plain}"
        ),
    );
    board.library("fork.so", &format!("#include <unistd.h>\n#include <stdlib.h>\n__attribute__((constructor)) static void begin(void) {{ if (fork() < 0) exit(77); }}\n{plain}"));
    board.library("write.so", &format!("#include <fcntl.h>\n#include <stdlib.h>\n__attribute__((constructor)) static void begin(void) {{ if (open(\"written\", O_CREAT | O_WRONLY, 0600) < 0) exit(78); }}\n{plain}"));
    let all = [
        ("crash.so", "its process was ended by SIG"),
        ("fork.so", "its process ended itself with status 77"),
        ("write.so", "its process ended itself with status 78"),
    ];
    // Without filters of system calls, as an emulated processor is, the other two are loaded.
    let count = if is_of_the_controller() { 1 } else { all.len() };
    for (library, word) in &all[..count] {
        let config = format!(
            "trikfs = {{\n  n = {{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, isolate = true,\n converter = '{library}' }} }}"
        );
        board.file("robot.lua", config);
        let output = trikfs(&board, &["check", "robot.lua"], b"");
        assert_eq!(output.code(), 1, "{library}: {}", output.stderr);
        assert!(
            output.stderr.contains("robot.lua:3: n: ")
                || output.stderr.contains("robot.lua:3: node n: "),
            "{library}: {}",
            output.stderr
        );
        assert!(output.stderr.contains(word), "{library}: {}", output.stderr);
    }
    board.file("robot.lua", "trikfs = {\n n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, isolate = true,\n converter = id_create(1) } }");
    let output = trikfs(&board, &["check", "robot.lua"], b"");
    assert!(
        output
            .stderr
            .contains("isolate is for shared libraries and inline C"),
        "{}",
        output.stderr
    );
}

/// As `kill` does, from outside.
fn signal(process: u32, signal: Signal) {
    kill(Pid::from_raw(process.cast_signed()), signal).unwrap();
}

#[test]
fn what_an_earlier_batch_has_left_is_never_given_again() {
    let Some(m) = hostile_stream() else { return };
    // The process is stopped, so it dies of its time before it looks at the second batch.
    m.python(&format!(
        "
def children(parent):
    found = []
    for name in os.listdir('/proc'):
        try:
            words = open('/proc/' + name + '/stat').read().rsplit(')', 1)[1].split()
        except (OSError, IndexError):
            continue
        if int(words[1]) == parent: found.append(int(name))
    return found
fd, pipe = open_ro(M + '/bad/device'), feed('in')
os.write(pipe, b'AAAA')
assert os.read(fd, 1024) == b'A\x01A\x02A\x03A\x04'
os.kill(children({0})[0], 19)
os.write(pipe, b'BBBB')
expect('EIO', os.read, fd, 1024)
got = os.read(fd, 1024)
assert got == b'B\x01B\x02B\x03', got
old = children({0})[0]
os.kill(old, 9)
eventually(lambda: open('/proc/%d/stat' % old).read().rsplit(')', 1)[1].split()[0] == 'Z', 'its end')
# So long that it is asked first whether the process lives.
time.sleep(0.1)
os.write(pipe, b'CC')
got = os.read(fd, 1024)
assert got == b'C\x01C\x02', (got, 'ended while nobody asked it: costs nobody a tuple')
",
        m.daemon()
    ));
}

#[test]
fn what_a_constructor_prepares_is_undone_before_the_first_tuple() {
    if is_of_the_controller() {
        return harness::wait::note_skip("the emulated processor has no filters of system calls");
    }
    let head = "#include <fcntl.h>\n#include <errno.h>\n#include <signal.h>\n#include <stddef.h>\n#include <sys/mman.h>\n#include <sys/prctl.h>\n#include <unistd.h>\nstatic int kept, told;\n__attribute__((constructor)) static void begin(void) { ";
    let tail = " }\nint converter(int a, char *in, int b, char *out) { ";
    let cases = [
        // A descriptor that is open.
        (
            "kept = open(\"/etc/hostname\", O_RDONLY);",
            "return read(kept, out, 1) < 0 ? errno : 77; }",
            9,
        ),
        // One under a number that is always open.
        (
            "close(0); kept = open(\"/etc/hostname\", O_RDONLY);",
            "return read(0, out, 1) < 0 ? errno : 77; }",
            9,
        ),
        // Signals for others, by the owner of a descriptor.
        (
            "kept = open(\"/\", O_RDONLY); told = fcntl(kept, F_SETOWN, getppid()) < 0 ? errno : 77;",
            "return told; }",
            1,
        ),
        // A life after the daemon's.
        (
            "told = prctl(PR_SET_PDEATHSIG, 0) < 0 ? errno : 77;",
            "return told; }",
            1,
        ),
        // Memory that is no data.
        (
            "",
            "for (int n = 0; n < 400; n++) { char *p = mmap(NULL, 1 << 20, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0); if (p == MAP_FAILED) return errno; p[0] = 1; } return 77; }",
            12,
        ),
    ];
    let board = Board::new();
    let mut config = "trikfs = {}\n".to_owned();
    for (number, (begin, convert, _)) in cases.iter().enumerate() {
        let library = format!("case{number}.so");
        board.library(&library, &format!("{head}{begin}{tail}{convert}"));
        config.push_str(&format!("trikfs.case{number} = {{ src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, isolate = true, converter = '{library}' }}\n"));
    }
    let Some(m) = mount_on(board, &config) else {
        return;
    };
    for (number, (_, _, result)) in cases.iter().enumerate() {
        assert_eq!(m.errno(&format!("case{number}/device")), libc::EIO);
        let fault = m.text(&format!("case{number}/fault"));
        let wanted = format!("converter returned {result}\n");
        assert!(fault.ends_with(&wanted), "case {number}: {fault}");
    }
}

#[test]
fn a_library_that_keeps_its_rights_is_refused() {
    if is_of_the_controller() {
        return harness::wait::note_skip("the emulated processor has no filters of system calls");
    }
    let board = Board::new();
    // A filter of its own: whatever comes after it fails, as if the kernel had none.
    board.library(
        "keeps.so",
        "#include <errno.h>\n#include <stddef.h>\n#include <linux/filter.h>\n#include <linux/seccomp.h>\n#include <sys/prctl.h>\n#include <sys/syscall.h>\n#include <unistd.h>
__attribute__((constructor)) static void begin(void) {
  struct sock_filter code[] = { { 0x20, 0, 0, 0 }, { 0x15, 0, 1, SYS_seccomp }, { 6, 0, 0, 0x00050000 | EPERM }, { 6, 0, 0, 0x7fff0000 } };
  struct sock_fprog program = { 4, code };
  syscall(SYS_seccomp, 1, 0, &program);
}
int converter(int a, char *in, int b, char *out) { return 0; }",
    );
    board.file("robot.lua", "trikfs = {\n  n = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, isolate = true, converter = 'keeps.so' } }");
    let output = trikfs(&board, &["check", "robot.lua"], b"");
    assert_eq!(output.code(), 1, "{}", output.stderr);
    assert!(
        output
            .stderr
            .contains("does not let the right to open files be taken"),
        "{}",
        output.stderr
    );
}

#[test]
fn a_library_whose_copy_is_gone_is_loaded_again_all_the_same() {
    let Some(m) = hostile() else { return };
    m.read("bad/device").unwrap();
    let before = process_of(&m);
    std::fs::remove_dir_all(m.board().path("cache")).unwrap();
    put(&m, "s");
    assert_eq!(m.errno("bad/device"), libc::EIO);
    put(&m, "B");
    assert_eq!(in_the_end(&m)[0], b'B');
    assert_ne!(process_of(&m), before);
}
