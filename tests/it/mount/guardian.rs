//! Death of the daemon by any cause: actuators rest, nothing old is served, the tree comes back.

use crate::mount_on;
use harness::{Board, Mount, eventually, processes};
use nix::sys::signal::Signal;

/// Takes the param `zero` away; makes nothing with 77.
const SHIFT: &str = r#"
#include "trikfs_converter.h"
#include <stdlib.h>
static int open_it(const trikfs_open_info *info, void **state)
{
    unsigned char *zero = calloc(1, 1);
    if (zero) *zero = (unsigned char)info->params[0].value;
    *state = zero;
    return !zero;
}
static int down(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size)
{ if (*(unsigned char *)state == 77) abort(); out[0] = in[0] - *(unsigned char *)state; return in_size != out_size; }
static const trikfs_converter only = { TRIKFS_ABI_VERSION, sizeof(trikfs_converter), "down", 0, 1, 1, open_it, down, free, 0 };
static const trikfs_converter *const all[] = { &only };
static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof(trikfs_library), 1, all };
TRIKFS_EXPORT const trikfs_library *trikfs_library_entry(void) { return &library; }
"#;

const ROBOT: &str = "trikfs = {
  motor = { src = '$DIR/motor', input_tuple_size = 2, format = 'i8 speed, u8 mode', rest = { 0, 7 } },
  gyro = { src = fake{ data = 'abcd', period_ms = 0, loop = true }, input_tuple_size = 4, poll_ms = 5 },
  stream = { src = '$DIR/in', input_tuple_size = 1 },
}";

fn robot() -> Option<Mount> {
    let board = Board::new();
    board.file("motor", "..");
    board.fifo("in");
    let m = mount_on(board, ROBOT)?;
    m.sh("echo 100 1 > motor/value");
    assert_eq!(m.board().content("motor"), [100, 1]);
    eventually("a sample", || m.errno("gyro/bin_data") == 0);
    Some(m)
}

/// Waits until another daemon serves the tree.
fn comes_back(m: &Mount, before: u32) {
    eventually("another daemon", || {
        processes::children(m.guardian())
            .iter()
            .any(|&pid| pid != before)
    });
    eventually("the tree", || m.read("motor/units").is_ok());
}

#[test]
fn after_a_kill_actuators_rest_and_the_tree_comes_back_with_its_configuration() {
    let Some(m) = robot() else { return };
    m.apply(&ROBOT.replace("stream", "renamed")).unwrap();
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || m.board().content("motor") == [0, 7]);
    comes_back(&m, daemon);
    assert!(m.path("renamed/device").exists());
    assert_eq!(
        m.text("config"),
        m.board().fill_in(&ROBOT.replace("stream", "renamed"))
    );
    eventually("what it says", || {
        m.complaints().contains("starting it again")
    });
    m.sh("echo 50 2 > motor/value");
    assert_eq!(m.board().content("motor"), [50, 2]);
}

#[test]
fn a_daemon_that_is_stopped_and_does_not_go_on_counts_as_dead() {
    let Some(m) = robot() else { return };
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGSTOP);
    eventually("rest", || m.board().content("motor") == [0, 7]);
    comes_back(&m, daemon);
    let complaint = "trikfs: the daemon was stopped and did not go on; starting it again";
    eventually("what it says", || m.complaints().contains(complaint));
}

#[test]
fn a_daemon_that_is_stopped_for_a_moment_goes_on() {
    let Some(m) = robot() else { return };
    let daemon = m.daemon();
    for _ in 0..20 {
        processes::signal(daemon, Signal::SIGSTOP);
        processes::signal(daemon, Signal::SIGCONT);
    }
    assert_eq!(m.text("motor/value"), "100 1\n");
    assert_eq!(m.daemon(), daemon);
}

#[test]
fn while_its_guardian_is_stopped_the_daemon_lets_actuators_rest_and_has_it_go_on() {
    let Some(m) = robot() else { return };
    for _ in 0..2 {
        m.sh("echo 100 1 > motor/value");
        assert_eq!(m.board().content("motor"), [100, 1]);
        processes::signal(m.guardian(), Signal::SIGSTOP);
        eventually("rest", || m.board().content("motor") == [0, 7]);
        eventually("the guardian", || !processes::is_stopped(m.guardian()));
    }
    let told = format!(
        "the guardian (process {}) was stopped: actuators were brought to rest, and it was told to go on",
        m.guardian()
    );
    eventually("what is told of it", || m.log().contains(&told));
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    comes_back(&m, daemon);
}

#[test]
fn a_terminal_does_not_stop_what_guards_motors() {
    let Some(m) = robot() else { return };
    let daemon = m.daemon();
    // As Ctrl-Z does: to the whole group.
    processes::signal_group(m.guardian(), Signal::SIGTSTP);
    eventually("what it says", || {
        m.complaints().contains("not stopped by Ctrl-Z")
    });
    assert!(!processes::is_stopped(m.guardian()) && !processes::is_stopped(daemon));
    m.sh("echo 50 2 > motor/value");
    assert_eq!(m.board().content("motor"), [50, 2]);
    // The daemon lives on, and so does its guardian.
    processes::signal(daemon, Signal::SIGKILL);
    eventually("rest", || m.board().content("motor") == [0, 7]);
    comes_back(&m, daemon);
}

#[test]
fn a_cached_value_of_a_dead_daemon_is_not_served() {
    let Some(m) = robot() else { return };
    let open = m.open("gyro/bin_data");
    let read = || std::os::unix::fs::FileExt::read_at(&open, &mut [0; 4], 0);
    eventually("a cached value", || read().is_ok());
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("an error", || read().is_err());
    comes_back(&m, daemon);
    assert!(read().is_err());
    eventually("a new value", || {
        m.read("gyro/bin_data").is_ok_and(|bytes| bytes == b"abcd")
    });
}

#[test]
fn readers_of_a_dead_daemon_are_told() {
    let Some(m) = robot() else { return };
    let mut reader = std::process::Command::new("cat")
        .arg(m.path("stream/device"))
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    eventually("a reader that waits", || processes::is_asleep(reader.id()));
    let daemon = m.daemon();
    processes::signal(daemon, Signal::SIGKILL);
    eventually("the end of the reader", || {
        reader.try_wait().unwrap().is_some()
    });
    comes_back(&m, daemon);
}

#[test]
fn the_death_of_the_guardian_ends_the_daemon_in_order() {
    let Some(mut m) = robot() else { return };
    let daemon = m.daemon();
    processes::signal(m.guardian(), Signal::SIGKILL);
    m.wait();
    eventually("the end of the daemon", || !processes::is_alive(daemon));
    eventually("rest", || m.board().content("motor") == [0, 7]);
    eventually("the end of the mount", || !m.is_mounted());
}

#[test]
fn after_the_death_of_everything_the_tree_can_be_mounted_again() {
    let Some(mut m) = robot() else { return };
    m.kill_everything();
    // ECONNABORTED at first, ENOTCONN afterwards.
    m.read("motor/units").unwrap_err();
    let mut command = std::process::Command::new(crate::program());
    command
        .args(["mount", "--background", "--config"])
        .arg(m.board().path("robot.lua"));
    command
        .arg("--cache")
        .arg(m.board().path("cache"))
        .arg(m.root());
    harness::run(&mut command, b"").good();
    m.sh("echo 3 4 > motor/value");
    assert_eq!(m.board().content("motor"), [3, 4]);
    let root = m.root().to_str().unwrap().to_owned();
    assert_eq!(crate::trikfs(m.board(), &["umount", &root], b"").code(), 0);
    eventually("rest", || m.board().content("motor") == [0, 7]);
}

#[test]
fn a_crash_in_native_code_is_survived() {
    let board = Board::new();
    board.file("motor", "..");
    let Some(m) = mount_on(
        board,
        "trikfs = {
          motor = { src = '$DIR/motor', input_tuple_size = 2, rest = { 0, 7 } },
          crash = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1, converter = { code = [[
            int converter(int in_s, char *in, int out_s, char *out) { *(volatile int *)8 = 1; return 0; }
          ]] } },
        }",
    ) else {
        return;
    };
    m.sh("printf dd > motor/device");
    let daemon = m.daemon();
    assert_ne!(m.errno("crash/device"), 0);
    eventually("rest", || m.board().content("motor") == [0, 7]);
    comes_back(&m, daemon);
    m.sh("printf ee > motor/device");
    assert_eq!(m.board().content("motor"), b"ee");
}

#[test]
fn a_daemon_that_crashes_again_and_again_is_given_up() {
    let Some(mut m) = robot() else { return };
    for _ in 0..5 {
        let Some(&daemon) = processes::children(m.guardian()).first() else {
            break;
        };
        processes::signal(daemon, Signal::SIGKILL);
        eventually("a new daemon or the end", || {
            let now = processes::children(m.guardian());
            !processes::is_alive(m.guardian()) || now.first().is_some_and(|&pid| pid != daemon)
        });
    }
    let status = m.wait();
    assert_eq!(status.code(), Some(3), "{}", m.complaints());
    eventually("what it says", || m.complaints().contains("giving up"));
    assert!(!m.is_mounted());
    assert_eq!(m.board().content("motor"), [0, 7]);
}

#[test]
fn native_code_that_calls_exit_does_not_end_the_filesystem() {
    let config = "trikfs = {
  bad = { src = '/dev/zero', input_tuple_size = 1, output_tuple_size = 1,
          converter = { code = [[
#include <stdlib.h>
int converter(int in_s, char *in, int out_s, char *out) { exit(0); }
]] } },
  good = { src = '/dev/zero', input_tuple_size = 1 },
}";
    let Some(m) = mount_on(Board::new(), config) else {
        return;
    };
    let daemon = m.daemon();
    assert_ne!(m.errno("bad/device"), 0);
    eventually("another daemon", || {
        processes::children(m.guardian())
            .iter()
            .any(|&pid| pid != daemon)
    });
    eventually("the tree", || m.read("good/units").is_ok());
    eventually("what it says", || {
        m.complaints().contains("ended from inside with status 0")
    });
}

#[test]
fn after_a_crash_the_library_in_force_is_loaded_whatever_its_file_contains() {
    let board = Board::new();
    let plus = |number: u32| {
        format!(
            "int converter(int in_s, char *in, int out_s, char *out)
{{ out[0] = in[0] + {number}; return in_s != out_s; }}"
        )
    };
    board.library("plus.so", &plus(1));
    board.file("in", [5]);
    let config = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1, output_tuple_size = 1, converter = 'plus.so' } }";
    let Some(m) = mount_on(board, config) else {
        return;
    };
    assert_eq!(m.read("n/bin_data").unwrap(), [6]);
    let crash = || {
        let daemon = m.daemon();
        processes::signal(daemon, Signal::SIGKILL);
        eventually("another daemon", || {
            processes::children(m.guardian())
                .iter()
                .any(|&pid| pid != daemon)
        });
        eventually("the tree", || m.read("n/bin_data").is_ok());
    };
    // Twice, because the second life must promise the same.
    for rubbish in [&b"no library"[..], b""] {
        m.board().file("plus.so", rubbish);
        crash();
        assert_eq!(m.read("n/bin_data").unwrap(), [6]);
        let told = "plus.so is not what it was: the copy that was in force is used until the next configuration";
        // Nodes are in force a moment before what there is to say of them.
        eventually(told, || m.log().contains(told));
    }
    // A program that asks for the configuration anew hears what the file is now, and then has what it is.
    let line = m.apply(config).unwrap_err();
    assert!(line.contains("plus.so"), "{line}");
    assert_eq!(m.read("n/bin_data").unwrap(), [6]);
    m.board().library("plus.so", &plus(2));
    m.apply(config).unwrap();
    assert_eq!(m.read("n/bin_data").unwrap(), [7]);
    crash();
    assert_eq!(m.read("n/bin_data").unwrap(), [7]);
}

/// What a motor that is a named pipe has got since it was asked last.
fn got(pipe: &mut std::fs::File) -> Vec<u8> {
    let mut bytes = Vec::new();
    // It never ends; what it has is read before it says that there is no more.
    let _ = std::io::Read::read_to_end(pipe, &mut bytes);
    bytes
}

#[test]
fn after_a_kill_the_rest_is_that_of_the_params_of_now_whoever_converts_it() {
    let lua = "write_converter = function(a_s, a, b_s, b) assert(params.zero ~= 77) ba.set(b, 0, (ba.get(a, 0) - params.zero) % 256) end";
    let isolated = "isolate = true, write_converter = 'shift.so#down'";
    for converter in [lua, isolated] {
        let board = Board::new();
        let mut motor = board.pipe("motor");
        board.library("shift.so", SHIFT);
        // The arm has its rest through the converter of the motor.
        let config = format!(
            "trikfs = {{ motor = {{ src = '$DIR/motor', input_tuple_size = 1, format = 'u8 power', rest = 50, params = {{ zero = 1 }}, {converter} }},
               arm = {{ src = 'trikfs:motor', input_tuple_size = 1, format = 'u8 power', rest = 60, write_converter = function(a_s, a, b_s, b) ba.set(b, 0, ba.get(a, 0)) end }} }}"
        );
        let Some(m) = mount_on(board, &config) else {
            return;
        };
        got(&mut motor);
        m.write("motor/params/zero", "3").unwrap();
        // Of one that a converter makes no rest of, what is known stays.
        let odd = m.write("motor/params/zero", "77");
        if converter == isolated {
            assert_eq!(odd.unwrap_err().raw_os_error(), Some(libc::EIO));
            assert_eq!(m.text("motor/params/zero"), "3\n");
        } else {
            odd.unwrap();
            let log = m.log();
            assert_eq!(
                log.matches("the guardian keeps the former one").count(),
                2,
                "{log}"
            );
            m.write("motor/params/zero", "3").unwrap();
        }
        m.write("motor/value", "30").unwrap();
        assert_eq!(got(&mut motor), [27]);
        let daemon = m.daemon();
        processes::signal(daemon, Signal::SIGKILL);
        let mut rest = Vec::new();
        // The next daemon has the params of the configuration, and lets them rest once more.
        eventually("rest by guardian and daemon", || {
            rest.extend(got(&mut motor));
            rest.contains(&49) && rest.contains(&59)
        });
        // The guardian does it twice if the threads of the daemon end later than its lifeline.
        let before = rest.len() - 2;
        rest[..before].sort_unstable();
        rest[before..].sort_unstable();
        let expected: [&[u8]; 2] = [&[47, 57, 49, 59], &[47, 47, 57, 57, 49, 59]];
        assert!(expected.contains(&&rest[..]), "{converter}: {rest:?}");
    }
}
