//! Shared memory as numbers that another process may change at any moment.
//!
//! Owns the mapping of a file and the only `unsafe` of this crate. All access is by atomic operations, so that a
//! concurrent change gives other numbers and nothing worse. Knows nothing of what the numbers mean.

use crate::ring::Memory;
use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering, fence};

const WORD_BYTES: usize = size_of::<usize>();

/// The first bytes of a file, mapped.
#[derive(Debug)]
pub(crate) struct Map {
    start: NonNull<u8>,
    bytes: usize,
    is_writable: bool,
}

// SAFETY: `Map` owns its mapping, which is not bound to a thread, and all access goes through atomics.
unsafe impl Send for Map {}
// SAFETY: as above.
unsafe impl Sync for Map {}

impl Map {
    /// Maps the first `bytes` of a file.
    ///
    /// A file that its owner shortens later ends the process at the next access: only map files of those who are
    /// trusted with that.
    pub(crate) fn new(file: &File, bytes: usize, is_writable: bool) -> io::Result<Self> {
        let access = match is_writable {
            true => libc::PROT_READ | libc::PROT_WRITE,
            false => libc::PROT_READ,
        };
        // SAFETY: a new mapping at a place that the kernel chooses overlaps nothing; the arguments are plain numbers.
        let start = unsafe {
            libc::mmap(
                std::ptr::null_mut(),
                bytes,
                access,
                libc::MAP_SHARED,
                file.as_raw_fd(),
                0,
            )
        };
        if start == libc::MAP_FAILED {
            return Err(io::Error::last_os_error());
        }
        let start = NonNull::new(start.cast()).ok_or(io::ErrorKind::InvalidInput)?;
        Ok(Self {
            start,
            bytes,
            is_writable,
        })
    }

    /// The number at an offset.
    ///
    /// # Panics
    /// The offset is not inside, or no multiple of four.
    fn number(&self, at: usize) -> &AtomicU32 {
        assert!(at.is_multiple_of(4) && at + 4 <= self.bytes);
        // SAFETY: the offset is inside the mapping, which lives as long as `self`, and aligned, because a mapping
        // begins at a page (assert above). Every access to this memory is atomic, in this process by this file.
        unsafe { AtomicU32::from_ptr(self.start.as_ptr().add(at).cast()) }
    }

    /// The words from an offset on.
    ///
    /// # Panics
    /// They are not all inside, or the offset is no multiple of a word.
    fn words(&self, at: usize, count: usize) -> &[AtomicUsize] {
        let room = self.bytes.checked_sub(at).map(|room| room / WORD_BYTES);
        assert!(at.is_multiple_of(WORD_BYTES) && room.is_some_and(|room| count <= room));
        // SAFETY: all words are inside the mapping, which lives as long as `self`, and aligned (assert above);
        // AtomicUsize has the layout of usize, and all bytes of a mapped file are initialised.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr().add(at).cast(), count) }
    }
}

impl Memory for Map {
    // Stronger loads are not promised to work on memory that is read-only.
    fn get(&self, at: usize) -> u32 {
        self.number(at).load(Ordering::Relaxed)
    }

    fn set(&self, at: usize, number: u32) {
        assert!(self.is_writable);
        self.number(at).store(number, Ordering::Relaxed);
    }

    fn copy_in(&self, at: usize, bytes: &[u8]) {
        assert!(self.is_writable);
        let words = self.words(at, bytes.len().div_ceil(WORD_BYTES));
        let (whole, rest) = bytes.as_chunks::<WORD_BYTES>();
        for (word, bytes) in words.iter().zip(whole) {
            word.store(usize::from_ne_bytes(*bytes), Ordering::Relaxed);
        }
        if let (Some(word), false) = (words.get(whole.len()), rest.is_empty()) {
            let mut last = [0; WORD_BYTES];
            last[..rest.len()].copy_from_slice(rest);
            word.store(usize::from_ne_bytes(last), Ordering::Relaxed);
        }
    }

    fn copy_out(&self, at: usize, bytes: &mut [u8]) {
        let words = self.words(at, bytes.len().div_ceil(WORD_BYTES));
        let (whole, rest) = bytes.as_chunks_mut::<WORD_BYTES>();
        for (word, bytes) in words.iter().zip(whole.iter_mut()) {
            *bytes = word.load(Ordering::Relaxed).to_ne_bytes();
        }
        if let (Some(word), false) = (words.get(whole.len()), rest.is_empty()) {
            let last = word.load(Ordering::Relaxed).to_ne_bytes();
            rest.copy_from_slice(&last[..rest.len()]);
        }
    }

    fn fence(&self, order: Ordering) {
        fence(order);
    }
}

impl Drop for Map {
    fn drop(&mut self) {
        // SAFETY: this is the mapping that `new` made, with its length, and nothing borrows from it any more.
        unsafe { libc::munmap(self.start.as_ptr().cast(), self.bytes) };
    }
}
