//! What the native transport can do beyond the crate: interrupts, taking over, held-down versions, an end on request.

use super::rig::{CACHED, Rig, TestFs, eventually};
use crate::transport::native::{Session, SessionOptions, serve};
use nix::errno::Errno;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs::{self, File, OpenOptions};
use std::io::{Read, Write};
use std::os::unix::fs::FileExt;
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::Ordering;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

/// A program that reads a file to its end.
fn cat(rig: &Rig, name: &str) -> Child {
    Command::new("cat")
        .arg(rig.path(name))
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

fn signal(child: &Child, signal: Signal) {
    kill(Pid::from_raw(child.id().cast_signed()), signal).unwrap();
}

/// Waits for the program's end by a signal, which must come at once.
fn dies_of(child: &mut Child, of: Signal) {
    let begun = Instant::now();
    signal(child, of);
    let status = child.wait().unwrap();
    assert_eq!(status.signal(), Some(of as i32));
    assert!(
        begun.elapsed() < Duration::from_secs(60),
        "took {:?}",
        begun.elapsed()
    );
}

/// A rig over a session that the test keeps, with options.
fn session(test: &str, options: SessionOptions) -> Option<(Rig, Arc<Session>)> {
    let (give, get) = mpsc::channel();
    let rig = Rig::new(test, move |device, fs: Arc<TestFs>| {
        let session = Arc::new(Session::new(device, fs, options));
        give.send(Arc::clone(&session)).unwrap();
        session.serve()
    })?;
    Some((rig, get.recv().unwrap()))
}

#[test]
fn a_waiting_reader_dies_at_once() {
    let Some(rig) = Rig::over("a_waiting_reader_dies_at_once", serve) else {
        return;
    };
    for of in [Signal::SIGKILL, Signal::SIGTERM, Signal::SIGINT] {
        let mut child = cat(&rig, "stream");
        eventually("the reader waits", || rig.fs.parked() == 1);
        dies_of(&mut child, of);
        eventually("nobody waits", || rig.fs.parked() == 0);
    }
    let read = File::open(rig.path("null"))
        .unwrap()
        .read(&mut [0; 4])
        .unwrap();
    assert_eq!(read, 4);
}

#[test]
fn a_reader_inside_an_operation_dies_at_once() {
    let Some((rig, session)) = session(
        "a_reader_inside_an_operation_dies_at_once",
        SessionOptions::default(),
    ) else {
        return;
    };
    let mut child = cat(&rig, "gate");
    eventually("the reader is inside", || rig.fs.state().at_gate == 1);
    dies_of(&mut child, Signal::SIGKILL);
    assert!(session.late_count() >= 1);
    // The late result finds nobody and harms nobody.
    rig.fs.open_gate();
    eventually("the operation is over", || rig.fs.state().at_gate == 0);
    assert_eq!(fs::read(rig.path("null")).unwrap(), b"null");
}

#[test]
fn many_readers_die_while_data_comes() {
    let Some(rig) = Rig::over("many_readers_die_while_data_comes", serve) else {
        return;
    };
    // Signals race with answers, with parking and with the end of operations; nobody may be left behind.
    for round in 0..40 {
        let mut children: Vec<_> = (0..4).map(|_| cat(&rig, "stream")).collect();
        if round % 2 == 0 {
            eventually("somebody waits", || rig.fs.parked() > 0);
        }
        std::thread::scope(|scope| {
            scope.spawn(|| (0..20).for_each(|_| rig.fs.feed(b"x")));
            for child in &mut children {
                dies_of(child, Signal::SIGKILL);
            }
        });
    }
    eventually("nobody waits", || rig.fs.parked() == 0);
}

#[test]
fn a_file_whose_opening_was_interrupted_is_released() {
    let Some(rig) = Rig::over("a_file_whose_opening_was_interrupted_is_released", serve) else {
        return;
    };
    let mut child = cat(&rig, "slow");
    eventually("the open is inside", || rig.fs.state().at_gate == 1);
    dies_of(&mut child, Signal::SIGKILL);
    assert!(rig.fs.state().released.is_empty());
    rig.fs.open_gate();
    eventually("the file is released", || rig.fs.state().released == [80]);
}

#[test]
fn a_late_operation_does_not_hold_up_other_files() {
    let Some((rig, session)) = session(
        "a_late_operation_does_not_hold_up_other_files",
        SessionOptions::default(),
    ) else {
        return;
    };
    let file = File::open(rig.path("null")).unwrap();
    let mut bytes = [0; 4];
    let mut children: Vec<_> = (0..10).map(|_| cat(&rig, "gate")).collect();
    eventually("ten are inside", || rig.fs.state().at_gate == 10);
    for _ in 0..100 {
        file.read_exact_at(&mut bytes, 0).unwrap();
    }
    assert!(session.late_count() >= 10);
    assert!(session.threads() >= 11);
    rig.fs.open_gate();
    for child in &mut children {
        assert!(
            child.wait().unwrap().success(),
            "a late answer arrives all the same"
        );
    }
    file.read_exact_at(&mut bytes, 0).unwrap();
    assert!(session.threads() <= crate::limits::MAX_THREADS);
}

#[test]
fn an_old_version_serves_without_the_newer_bits() {
    let options = SessionOptions {
        minor_max: 26,
        ..SessionOptions::default()
    };
    let Some((rig, _session)) = session("an_old_version_serves_without_the_newer_bits", options)
    else {
        return;
    };
    assert_eq!(fs::read(rig.path("null")).unwrap(), b"null");
    // NOFLUSH does not exist: closing is announced, and answered.
    assert!(rig.fs.flushes.load(Ordering::SeqCst) > 0);
    let stream = File::open(rig.path("stream")).unwrap();
    let position = nix::unistd::lseek(&stream, 0, nix::unistd::Whence::SeekSet);
    assert_eq!(position, Err(Errno::ESPIPE));
    let mut child = cat(&rig, "stream");
    eventually("the reader waits", || rig.fs.parked() == 1);
    let mut writer = OpenOptions::new()
        .write(true)
        .open(rig.path("stream"))
        .unwrap();
    writer.write_all(b"x").unwrap();
    eventually("the reader waits again", || rig.fs.parked() == 1);
    dies_of(&mut child, Signal::SIGKILL);
    let kernel = rig.fs.kernel();
    let cached = File::open(rig.path("cached")).unwrap();
    assert!(kernel.store(CACHED, b"abcd"));
    let mut bytes = [0; 4];
    cached.read_exact_at(&mut bytes, 0).unwrap();
    assert_eq!(&bytes, b"abcd");
}

#[test]
fn without_features_the_kernel_does_it_the_long_way() {
    let options = SessionOptions {
        withhold: u64::MAX,
        ..SessionOptions::default()
    };
    let Some((rig, _session)) =
        session("without_features_the_kernel_does_it_the_long_way", options)
    else {
        return;
    };
    let truncating = OpenOptions::new()
        .write(true)
        .truncate(true)
        .open(rig.path("config"));
    let mut file = truncating.unwrap();
    assert_eq!(rig.fs.state().open_flags & libc::O_TRUNC, 0);
    assert_eq!(rig.fs.state().truncated, 1);
    file.write_all(&[7; 10_000]).unwrap();
    let lengths = rig.fs.state().lengths.clone();
    assert_eq!(lengths.iter().sum::<usize>(), 10_000);
    assert!(lengths.iter().all(|&length| length <= 4096), "{lengths:?}");
}

#[test]
fn a_session_ends_on_request_and_lets_everybody_go() {
    let Some((mut rig, session)) = session(
        "a_session_ends_on_request_and_lets_everybody_go",
        SessionOptions::default(),
    ) else {
        return;
    };
    let mut child = Command::new("cat")
        .arg(rig.path("stream"))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    eventually("the reader waits", || rig.fs.parked() == 1);
    assert_eq!(rig.unmount(), crate::mount::Unmounted::Detached);
    session.stop();
    rig.served().unwrap();
    assert_eq!(rig.fs.stopped.load(Ordering::SeqCst), 1);
    // The connection goes with the last holder of its descriptor.
    assert!(child.try_wait().unwrap().is_none());
    drop(session);
    rig.fs.forget_kernel();
    assert!(!child.wait().unwrap().success());
}
