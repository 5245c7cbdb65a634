//! Calls on the kernel's device that fail: what passes is tried again, nobody waits for ever, and what cannot be mended ends.

use super::rig::{CACHED, Rig, TestFs, eventually};
use crate::limits::KERNEL_PATIENCE;
use crate::transport::native::link::{Call, Inject, Link};
use crate::transport::native::{Session, SessionOptions, abi, encode};
use nix::errno::Errno;
use std::fs::{self, File};
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Errors that may pass.
const PASSING: [Errno; 5] = [
    Errno::EAGAIN,
    Errno::EIO,
    Errno::ENOMEM,
    Errno::EFAULT,
    Errno::ENOBUFS,
];
/// The answer to a read of four bytes.
const FOUR_BYTES: Call = Call::Write(abi::OUT_HEADER + 4);

/// A mount whose calls can be made to fail.
struct Failing {
    rig: Rig,
    /// Which error a call gets now.
    rule: Arc<Mutex<Rule>>,
    lost: Arc<AtomicBool>,
    /// Calls that got one.
    failed: Arc<AtomicU32>,
}

type Rule = Box<dyn FnMut(Call) -> Option<Errno> + Send>;

impl Failing {
    fn new(test: &str) -> Option<Self> {
        let rule: Arc<Mutex<Rule>> = Arc::new(Mutex::new(Box::new(|_| None)));
        let (lost, failed) = (Arc::new(AtomicBool::new(false)), Arc::default());
        let inject = {
            let (rule, failed): (Arc<Mutex<Rule>>, Arc<AtomicU32>) =
                (Arc::clone(&rule), Arc::clone(&failed));
            Inject {
                error: Arc::new(move |call| {
                    let error = (rule.lock().unwrap())(call);
                    failed.fetch_add(error.is_some().into(), Ordering::SeqCst);
                    error
                }),
                lost: Arc::clone(&lost),
            }
        };
        let rig = Rig::new(test, move |device, fs: Arc<TestFs>| {
            let link = Link::new(device).with_errors(inject);
            Session::over(link, fs, SessionOptions::default()).serve()
        })?;
        Some(Self {
            rig,
            rule,
            lost,
            failed,
        })
    }

    /// From here on calls fail as this says.
    fn fail(&self, rule: impl FnMut(Call) -> Option<Errno> + Send + 'static) {
        *self.rule.lock().unwrap() = Box::new(rule);
    }

    fn count(&self) -> u32 {
        self.failed.load(Ordering::SeqCst)
    }

    /// A program that reads, and may wait for ever.
    fn reader(&self) -> Child {
        Command::new("cat")
            .arg(self.rig.path("null"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    }

    fn null(&self) -> std::io::Result<Vec<u8>> {
        fs::read(self.rig.path("null"))
    }
}

/// Every second call of this kind fails, with each of the errors in turn.
fn every_second(matches: impl Fn(Call) -> bool) -> impl FnMut(Call) -> Option<Errno> {
    let mut calls = 0_usize;
    move |call| {
        if !matches(call) {
            return None;
        }
        calls += 1;
        calls
            .is_multiple_of(2)
            .then(|| PASSING[calls / 2 % PASSING.len()])
    }
}

#[test]
fn a_read_of_a_request_that_fails_is_tried_again() {
    let Some(failing) = Failing::new("a_read_of_a_request_that_fails_is_tried_again") else {
        return;
    };
    failing.fail(every_second(|call| call == Call::Read));
    for _ in 0..30 {
        assert_eq!(failing.null().unwrap(), b"null");
    }
    assert!(failing.count() >= 30, "{} calls failed", failing.count());
    assert!(!failing.lost.load(Ordering::SeqCst));
}

#[test]
fn an_answer_that_the_kernel_does_not_take_is_sent_again() {
    let Some(failing) = Failing::new("an_answer_that_the_kernel_does_not_take_is_sent_again")
    else {
        return;
    };
    failing.fail(every_second(|call| matches!(call, Call::Write(_))));
    for _ in 0..30 {
        assert_eq!(failing.null().unwrap(), b"null");
    }
    // A read that waited is answered by another way.
    let mut stream = File::open(failing.rig.path("stream")).unwrap();
    std::thread::scope(|scope| {
        let reader = scope.spawn(move || {
            let mut bytes = [0; 3];
            stream.read_exact(&mut bytes).map(|()| bytes)
        });
        eventually("the reader waits", || failing.rig.fs.parked() == 1);
        failing.rig.fs.feed(b"abc");
        assert_eq!(&reader.join().unwrap().unwrap(), b"abc");
    });
    assert!(failing.count() >= 30, "{} calls failed", failing.count());
    assert!(!failing.lost.load(Ordering::SeqCst));
}

#[test]
fn an_answer_that_never_arrives_is_an_error_for_its_caller() {
    let Some(failing) = Failing::new("an_answer_that_never_arrives_is_an_error_for_its_caller")
    else {
        return;
    };
    // One that may pass is tried for a while; one that is final is not.
    for (errno, at_least) in [
        (Errno::ENOMEM, KERNEL_PATIENCE),
        (Errno::EINVAL, Duration::ZERO),
    ] {
        let begun = Instant::now();
        failing.fail(move |call| (call == FOUR_BYTES).then_some(errno));
        let error = failing.null().expect_err("no answer");
        assert_eq!(error.raw_os_error(), Some(libc::EIO));
        assert!(begun.elapsed() >= at_least, "{:?}", begun.elapsed());
        failing.fail(|_| None);
        assert_eq!(failing.null().unwrap(), b"null");
    }
    assert!(!failing.lost.load(Ordering::SeqCst));
}

#[test]
fn a_file_whose_opening_could_not_be_told_is_released() {
    let Some(failing) = Failing::new("a_file_whose_opening_could_not_be_told_is_released") else {
        return;
    };
    // The body of an answer to OPEN has 16 bytes.
    let opened = Call::Write(abi::OUT_HEADER + 16);
    failing.fail(move |call| (call == opened).then_some(Errno::EINVAL));
    let error = failing.null().expect_err("no answer");
    assert_eq!(error.raw_os_error(), Some(libc::EIO));
    failing.fail(|_| None);
    // The caller may hear of it first.
    eventually("the file is released", || {
        failing.rig.fs.state().released.len() == 1
    });
}

#[test]
fn a_kernel_that_takes_nothing_any_more_ends_the_process() {
    let Some(failing) = Failing::new("a_kernel_that_takes_nothing_any_more_ends_the_process")
    else {
        return;
    };
    failing.fail(|call| matches!(call, Call::Write(_)).then_some(Errno::ENOMEM));
    let mut reader = failing.reader();
    eventually("the process would end", || {
        failing.lost.load(Ordering::SeqCst)
    });
    failing.rig.abort();
    assert!(!reader.wait().unwrap().success());
}

#[test]
fn an_invalidation_is_never_lost() {
    let Some(failing) = Failing::new("an_invalidation_is_never_lost") else {
        return;
    };
    assert!(fs::read(failing.rig.path("cached")).is_ok());
    failing.fail(every_second(|call| matches!(call, Call::Write(_))));
    for _ in 0..10 {
        failing.rig.fs.kernel().invalidate(CACHED);
    }
    assert!(failing.count() >= 5);
    assert!(!failing.lost.load(Ordering::SeqCst));
    failing.fail(|call| matches!(call, Call::Write(_)).then_some(Errno::ENOMEM));
    failing.rig.fs.kernel().invalidate(CACHED);
    assert!(failing.lost.load(Ordering::SeqCst));
    failing.fail(|_| None);
}

#[test]
fn a_value_that_cannot_be_stored_does_not_stay_an_old_one() {
    let Some(failing) = Failing::new("a_value_that_cannot_be_stored_does_not_stay_an_old_one")
    else {
        return;
    };
    let kernel = failing.rig.fs.kernel();
    let read = || fs::read(failing.rig.path("cached")).unwrap();
    let own = read();
    let stored = vec![b'#'; own.len()];
    assert!(kernel.store(CACHED, &stored));
    // The page is full of what was stored, and the filesystem is not asked.
    assert_eq!(read(), stored);
    // By its size: the answer to the release of the file that was read may come at this moment.
    let newer = b"newer";
    let storing = Call::Write(abi::OUT_HEADER + encode::store(CACHED, 0).len() + newer.len());
    failing.fail(move |call| (call == storing).then_some(Errno::ENOMEM));
    assert!(!kernel.store(CACHED, newer));
    assert_eq!(read(), own);
}

#[test]
fn reads_that_fail_for_good_end_the_session_with_the_reason() {
    let Some(mut failing) =
        Failing::new("reads_that_fail_for_good_end_the_session_with_the_reason")
    else {
        return;
    };
    failing.fail(|call| (call == Call::Read).then_some(Errno::EIO));
    // The read that is under way is served, the next one fails.
    let mut reader = failing.reader();
    let error = failing.rig.served().expect_err("it cannot serve");
    assert_eq!(error.raw_os_error(), Some(libc::EIO));
    failing.rig.abort();
    assert!(!reader.wait().unwrap().success());
}
