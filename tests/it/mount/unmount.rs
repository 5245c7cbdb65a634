//! Leaving: clean, busy, with readers that wait, over a stale mount.

use crate::{mount_on, program, trikfs};
use harness::{Board, Mount, eventually};
use nix::sys::signal::Signal;

const PIPE: &str = "trikfs = { n = { src = '$DIR/in', input_tuple_size = 1 }, z = { src = '/dev/zero', input_tuple_size = 1, poll_ms = 5 } }";

fn mounted() -> Option<Mount> {
    let board = Board::new();
    board.fifo("in");
    mount_on(board, PIPE)
}

/// A shell that reads `n/device` for ever; it holds the mount.
fn waiting_reader(m: &Mount) -> std::process::Child {
    let child = std::process::Command::new("cat")
        .arg(m.path("n/device"))
        .spawn()
        .unwrap();
    let opened = || {
        let links = std::fs::read_dir(format!("/proc/{}/fd", child.id()))
            .into_iter()
            .flatten()
            .flatten();
        links
            .filter_map(|link| std::fs::read_link(link.path()).ok())
            .any(|path| path.ends_with("n/device"))
    };
    eventually("a reader", opened);
    eventually("a reader that waits", || {
        harness::processes::is_asleep(child.id())
    });
    child
}

#[test]
fn each_signal_to_stop_unmounts_and_is_a_success() {
    for signal in [Signal::SIGTERM, Signal::SIGINT] {
        let Some(mut m) = mounted() else { return };
        harness::processes::signal(m.guardian(), signal);
        assert_eq!(m.wait().code(), Some(0), "{signal}: {}", m.complaints());
        assert!(!m.is_mounted());
        assert!(std::fs::read_dir(m.root()).unwrap().next().is_none());
    }
}

#[test]
fn unmounting_ends_the_program() {
    let Some(mut m) = mounted() else { return };
    let root = m.root().to_str().unwrap().to_owned();
    let output = trikfs(m.board(), &["umount", &root], b"");
    assert_eq!((output.code(), output.stderr.as_str()), (0, ""));
    assert_eq!(m.wait().code(), Some(0), "{}", m.complaints());
    assert!(!m.is_mounted());
    let again = trikfs(m.board(), &["umount", &root], b"");
    assert_eq!(again.code(), 1);
    assert!(again.stderr.starts_with("trikfs: "), "{}", again.stderr);
}

#[test]
fn readers_that_wait_do_not_hold_up_the_end() {
    let Some(mut m) = mounted() else { return };
    let mut readers = [waiting_reader(&m), waiting_reader(&m)];
    assert_eq!(m.stop().code(), Some(0), "{}", m.complaints());
    assert!(!m.is_mounted());
    for reader in &mut readers {
        // The wait ends with an error; the reader is not killed by us.
        eventually("the end of a reader", || {
            reader.try_wait().unwrap().is_some()
        });
        assert_eq!(reader.wait().unwrap().code(), Some(1));
    }
}

#[test]
fn a_busy_tree_is_detached() {
    let Some(mut m) = mounted() else { return };
    let held = m.open("z/stats");
    let root = m.root().to_str().unwrap().to_owned();
    let mut reader = waiting_reader(&m);
    let output = trikfs(m.board(), &["umount", &root], b"");
    assert_eq!(output.code(), 0, "{}", output.stderr);
    assert!(!m.is_mounted());
    assert_eq!(m.wait().code(), Some(0), "{}", m.complaints());
    eventually("the end of the reader", || {
        reader.try_wait().unwrap().is_some()
    });
    assert!(std::os::unix::fs::FileExt::read_at(&held, &mut [0; 10], 0).is_err());
}

#[test]
fn a_stale_mount_is_replaced() {
    let Some(mut m) = mounted() else { return };
    let held = m.open("z/stats");
    m.kill_everything();
    assert!(m.is_mounted());
    // ECONNABORTED at first, ENOTCONN afterwards.
    nix::sys::statvfs::statvfs(m.root()).unwrap_err();
    let dead = nix::sys::statvfs::statvfs(m.root()).unwrap_err();
    assert_eq!(dead, nix::Error::ENOTCONN);
    assert!(std::os::unix::fs::FileExt::read_at(&held, &mut [0; 1], 0).is_err());
    let mut command = std::process::Command::new(program());
    command
        .args(["mount", "--background", "--config"])
        .arg(m.board().path("robot.lua"));
    command
        .arg("--cache")
        .arg(m.board().path("cache"))
        .arg(m.root());
    let line = harness::run(&mut command, b"").good();
    assert!(
        line.starts_with("trikfs: ready on ") && line.lines().count() == 1,
        "{line}"
    );
    assert_eq!(m.read("z/bin_data").unwrap(), [0]);
    assert_eq!(harness::board::mounts_below(m.root()).len(), 1);
    let root = m.root().to_str().unwrap().to_owned();
    assert_eq!(trikfs(m.board(), &["umount", &root], b"").code(), 0);
    eventually("the end of the mount", || !m.is_mounted());
}
