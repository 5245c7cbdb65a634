//! The memory that a daemon and the process of an isolated converter share: whose turn it is, a message, tuples, and how far a
//! batch has come.
//!
//! Owns where in it what is, its mapping, which is the only `unsafe` here, and the waiting for the other side. The daemon copies
//! what it needs out before it looks at it, so that nothing changes under its hands, and the memory cannot be made shorter.

use crate::limits::{ISOLATED_BYTES, ISOLATED_MESSAGE_BYTES, ISOLATED_TUPLES};
use nix::fcntl::{FcntlArg, SealFlag, fcntl};
use nix::sys::memfd::{MFdFlags, memfd_create};
use rustix::thread::futex;
use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Numbers of four bytes, each in a line of the processor's cache of its own: whose turn it is, bytes of the message, and how
/// many tuples of a batch were taken (its upper half) and made.
const TURN_AT: usize = 0;
const LENGTH_AT: usize = 64;
const PROGRESS_AT: usize = 128;
/// Where the message and the tuples begin; a page keeps them aligned for every converter.
const MESSAGE_AT: usize = 4096;
const INPUT_AT: usize = MESSAGE_AT + ISOLATED_MESSAGE_BYTES;
const OUTPUT_AT: usize = INPUT_AT + ISOLATED_BYTES;
const BYTES: usize = OUTPUT_AT + ISOLATED_BYTES;

/// Values of the turn; new memory is zero. A daemon that sleeps says so: on one processor the answer is mostly there before it
/// would, and nobody has to be woken.
const BEGIN: u32 = 0;
const ASKED: u32 = 1;
const AWAITED: u32 = 2;
const ANSWERED: u32 = 3;

/// The memory, mapped.
#[derive(Debug)]
pub(super) struct Shared {
    start: NonNull<u8>,
}

// SAFETY: `Shared` owns its mapping, which is not bound to a thread.
unsafe impl Send for Shared {}

fn timespec(time: Duration) -> futex::Timespec {
    futex::Timespec {
        tv_sec: i64::try_from(time.as_secs()).unwrap_or(i64::MAX),
        tv_nsec: time.subsec_nanos().into(),
    }
}

/// What has come of waiting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Waited {
    Answered,
    NotYet,
    /// The turn is what neither side makes it.
    Rubbish,
}

impl Shared {
    /// New memory, and what gives it to another process. What is not used of it takes none.
    pub(super) fn new() -> io::Result<(Self, File)> {
        let flags = MFdFlags::MFD_CLOEXEC | MFdFlags::MFD_ALLOW_SEALING;
        let file = File::from(memfd_create(c"isolated", flags)?);
        file.set_len(BYTES as u64)?;
        let seals = SealFlag::F_SEAL_SHRINK | SealFlag::F_SEAL_GROW | SealFlag::F_SEAL_SEAL;
        fcntl(&file, FcntlArg::F_ADD_SEALS(seals))?;
        Ok((Self::of(&file)?, file))
    }

    /// The memory that another process has made.
    pub(super) fn of(file: &File) -> io::Result<Self> {
        if file.metadata()?.len() != BYTES as u64 {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        // SAFETY: a new mapping at a place that the kernel chooses overlaps nothing; the arguments are plain numbers.
        let start = unsafe {
            libc::mmap(
                std::ptr::null_mut(),
                BYTES,
                libc::PROT_READ | libc::PROT_WRITE,
                libc::MAP_SHARED,
                file.as_raw_fd(),
                0,
            )
        };
        if start == libc::MAP_FAILED {
            return Err(io::Error::last_os_error());
        }
        let start = NonNull::new(start.cast()).ok_or(io::ErrorKind::InvalidInput)?;
        Ok(Self { start })
    }

    /// One of the numbers in front.
    fn number(&self, at: usize) -> &AtomicU32 {
        debug_assert!(at.is_multiple_of(4) && at < MESSAGE_AT);
        // SAFETY: `at` is one of the three offsets above, inside the first page of the mapping, which lives as long as `self`, and
        // aligned because a mapping begins at a page. Both sides use atomic operations alone on these bytes.
        unsafe { AtomicU32::from_ptr(self.start.add(at).as_ptr().cast()) }
    }

    /// Bytes into one of the areas.
    ///
    /// # Panics
    /// They are more than it has.
    fn put(&self, at: usize, room: usize, bytes: &[u8]) {
        assert!(bytes.len() <= room && at + room <= BYTES);
        // SAFETY: the area is inside the mapping (assert above) and no part of `bytes`, which is memory of this process alone. No
        // reference into it exists in this process: `batch` has `&mut self`. Another process is no part of the language's memory
        // model; what it stores at the same time gives other bytes, and any byte is one.
        unsafe {
            let target = self.start.add(at).as_ptr();
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, bytes.len());
        }
    }

    /// Bytes out of one of the areas.
    ///
    /// # Panics
    /// As of [`put`](Self::put).
    fn take(&self, at: usize, room: usize, bytes: &mut [u8]) {
        assert!(bytes.len() <= room && at + room <= BYTES);
        // SAFETY: as in `put`.
        unsafe {
            let source = self.start.add(at).as_ptr();
            std::ptr::copy_nonoverlapping(source, bytes.as_mut_ptr(), bytes.len());
        }
    }

    /// A message for the other side.
    fn put_message(&self, message: &[u8]) {
        self.put(MESSAGE_AT, ISOLATED_MESSAGE_BYTES, message);
        let length = u32::try_from(message.len()).unwrap_or(0);
        self.number(LENGTH_AT).store(length, Ordering::Relaxed);
    }

    fn take_message<'a>(&self, into: &'a mut [u8]) -> Option<&'a [u8]> {
        let length = self.number(LENGTH_AT).load(Ordering::Relaxed) as usize;
        let message = into.get_mut(..length)?;
        self.take(MESSAGE_AT, ISOLATED_MESSAGE_BYTES, message);
        Some(message)
    }

    fn wake(&self) {
        // Fails only for an address that is none.
        let _ = futex::wake(self.number(TURN_AT), futex::Flags::empty(), 1);
    }

    // The daemon's side.

    /// A message for the process. One that is too long is not sent.
    pub(super) fn ask(&self, message: &[u8]) -> bool {
        let fits = message.len() <= ISOLATED_MESSAGE_BYTES;
        if fits {
            self.put_message(message);
            self.number(TURN_AT).store(ASKED, Ordering::Release);
            self.wake();
        }
        fits
    }

    /// Waits for its answer, but not longer than this.
    pub(super) fn wait(&self, patience: Duration) -> Waited {
        let turn = self.number(TURN_AT);
        let (acquire, relaxed) = (Ordering::Acquire, Ordering::Relaxed);
        match turn.compare_exchange(ASKED, AWAITED, relaxed, acquire) {
            Ok(_) | Err(AWAITED) => {}
            Err(ANSWERED) => return Waited::Answered,
            Err(_) => return Waited::Rubbish,
        }
        let patience = timespec(patience);
        // Whatever ends it: the turn tells.
        let _ = futex::wait(turn, futex::Flags::empty(), AWAITED, Some(&patience));
        match turn.load(acquire) {
            ANSWERED => Waited::Answered,
            AWAITED => Waited::NotYet,
            _ => Waited::Rubbish,
        }
    }

    /// The answer, copied to the beginning of `into`; None: it says that it is longer than one may be.
    pub(super) fn answer<'a>(&self, into: &'a mut [u8]) -> Option<&'a [u8]> {
        self.take_message(into)
    }

    /// Puts tuples where the process finds them; none of them counts as done.
    pub(super) fn put_input(&self, input: &[u8]) {
        // The process may die before it begins, and what is left of the batch before is not of this one.
        self.number(PROGRESS_AT).store(0, Ordering::Release);
        self.put(INPUT_AT, ISOLATED_BYTES, input);
    }

    /// Takes the first tuples that it has made.
    pub(super) fn take_output(&self, output: &mut [u8]) {
        self.take(OUTPUT_AT, ISOLATED_BYTES, output);
    }

    /// How many tuples of the present batch were taken and made, says the process.
    pub(super) fn progress(&self) -> (usize, usize) {
        let both = self.number(PROGRESS_AT).load(Ordering::Acquire) as usize;
        (both >> 16, both & ISOLATED_TUPLES)
    }

    // The side of the process.

    /// Waits for the next message and copies it to the beginning of `into`. None: nobody wants anything any more, as `is_over`
    /// tells, which is asked after each `patience`; without one it is never asked, and each wait is cheaper by a timer.
    pub(super) fn next<'a>(
        &self,
        into: &'a mut [u8],
        patience: Option<Duration>,
        is_over: impl Fn() -> bool,
    ) -> Option<&'a [u8]> {
        let turn = self.number(TURN_AT);
        let time = patience.map(timespec);
        loop {
            match turn.load(Ordering::Acquire) {
                ASKED | AWAITED => return self.take_message(into),
                other @ (BEGIN | ANSWERED) => {
                    let waited = futex::wait(turn, futex::Flags::empty(), other, time.as_ref());
                    if waited == Err(rustix::io::Errno::TIMEDOUT) && is_over() {
                        return None;
                    }
                }
                _ => return None,
            }
        }
    }

    /// The answer to it.
    ///
    /// # Panics
    /// It is longer than a message may be.
    pub(super) fn reply(&self, message: &[u8]) {
        self.put_message(message);
        if self.number(TURN_AT).swap(ANSWERED, Ordering::Release) == AWAITED {
            self.wake();
        }
    }

    /// The input of a batch, room for its output, and where to tell how far it has come. None: there is not so much of it.
    pub(super) fn batch(
        &mut self,
        input_bytes: usize,
        output_bytes: usize,
    ) -> Option<(&[u8], &mut [u8], Progress<'_>)> {
        if input_bytes > ISOLATED_BYTES || output_bytes > ISOLATED_BYTES {
            return None;
        }
        // SAFETY: both areas are inside the mapping, which lives as long as `self`, and do not overlap (sizes checked above). The
        // daemon changes neither between its request and the answer, and `&mut self` keeps this process from touching them.
        let (input, output) = unsafe {
            (
                std::slice::from_raw_parts(self.start.add(INPUT_AT).as_ptr(), input_bytes),
                std::slice::from_raw_parts_mut(self.start.add(OUTPUT_AT).as_ptr(), output_bytes),
            )
        };
        let progress = Progress {
            word: self.number(PROGRESS_AT),
            counts: 0,
        };
        Some((input, output, progress))
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: this is the mapping that `of` made, with its length, and nothing borrows from it any more.
        unsafe { libc::munmap(self.start.as_ptr().cast(), BYTES) };
    }
}

/// How far a batch has come, for the daemon, which looks only when it waits too long or the process has died.
pub(super) struct Progress<'a> {
    word: &'a AtomicU32,
    /// What is in it: how many were taken, and in the lower half how many were made.
    counts: u32,
}

impl Progress<'_> {
    /// Another tuple was taken, and one was made of it or none. A batch has at most [`ISOLATED_TUPLES`].
    #[inline]
    pub(super) fn done(&mut self, is_made: bool) {
        self.counts = self.counts.wrapping_add(0x1_0000 | u32::from(is_made));
        // A tuple is whole before it counts.
        self.word.store(self.counts, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHORT: Duration = Duration::from_millis(1);

    #[test]
    fn messages_go_to_and_fro_and_each_side_waits_for_the_other() {
        let (daemon, file) = Shared::new().unwrap();
        let process = Shared::of(&file).unwrap();
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let mut room = [0; 64];
                for _ in 0..100 {
                    let mut message = process.next(&mut room, None, || false).unwrap().to_vec();
                    message.reverse();
                    process.reply(&message);
                }
            });
            let mut room = [0; 64];
            for round in 0..100 {
                assert!(daemon.ask(&[round, 1, 2]));
                while daemon.wait(SHORT) == Waited::NotYet {}
                assert_eq!(daemon.answer(&mut room), Some(&[2, 1, round][..]));
            }
            assert!(daemon.ask(&[]));
            assert_eq!(
                daemon.wait(SHORT),
                Waited::NotYet,
                "nobody is there any more"
            );
        });
        assert!(!daemon.ask(&vec![0; ISOLATED_MESSAGE_BYTES + 1]));
    }

    #[test]
    fn tuples_and_progress_are_where_the_other_side_looks_for_them() {
        let (daemon, file) = Shared::new().unwrap();
        let mut process = Shared::of(&file).unwrap();
        daemon.put_input(&[1, 2, 3]);
        let (input, output, mut progress) = process.batch(3, ISOLATED_BYTES).unwrap();
        assert_eq!(input, [1, 2, 3]);
        output[63] = 9;
        (1..ISOLATED_TUPLES).for_each(|_| progress.done(false));
        progress.done(true);
        let mut taken = [0; 64];
        daemon.take_output(&mut taken);
        assert_eq!((taken[0], taken[63]), (0, 9));
        assert_eq!(daemon.progress(), (ISOLATED_TUPLES, 1));
        daemon.put_input(&[4]);
        assert_eq!(
            daemon.progress(),
            (0, 0),
            "nothing of the next batch is done"
        );
        let nothing = process.next(&mut [0; 8], Some(SHORT), || true).is_none();
        assert!(nothing, "nobody is there any more");
        assert!(process.batch(ISOLATED_BYTES + 1, 0).is_none());
        assert!(process.batch(0, ISOLATED_BYTES + 1).is_none());
    }

    #[test]
    fn rubbish_in_front_is_told_and_the_memory_cannot_be_cut() {
        let (daemon, file) = Shared::new().unwrap();
        assert!(daemon.ask(&[1]));
        daemon.number(TURN_AT).store(77, Ordering::Release);
        assert_eq!(daemon.wait(SHORT), Waited::Rubbish);
        daemon.number(LENGTH_AT).store(u32::MAX, Ordering::Release);
        assert_eq!(daemon.answer(&mut [0; 64]), None);
        assert!(file.set_len(1).is_err());
        assert!(Shared::of(&File::open("/dev/null").unwrap()).is_err());
    }
}
