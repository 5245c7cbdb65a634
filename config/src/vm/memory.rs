//! Memory of a Lua state, counted, with a limit.
//!
//! Owns the allocator function that LuaJIT calls. A state consists of some five hundred blocks of a few dozen bytes;
//! malloc would add a sixth to them for its own notes. LuaJIT tells the size of a block when it gives it back, so small
//! blocks are cut from chunks and kept in lists by size; large ones come from malloc. Chunks go back when the state is
//! closed, and those that hold nothing when `trim` finds them.
//! Knows nothing of what the memory holds.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr;

/// Sizes of small blocks are multiples of this; it is also their alignment, that of LuaJIT's own allocator.
const GRAIN: usize = 8;
/// Largest small block.
const SMALL_MAX: usize = 512;
/// A chunk with malloc's notes fills half a page.
const CHUNK_BYTES: usize = 2048 - 2 * GRAIN;
/// Chunks may take so much more than the limit, for blocks of sizes that are not wanted any more.
const CHUNKS_SLACK: usize = 256 << 10;

/// What a chunk has for blocks: all but the address of another one.
const CHUNK_ROOM: usize = CHUNK_BYTES - GRAIN;
/// Free memory in chunks from which on it is worth looking for chunks that hold nothing.
const TRIM_BYTES: usize = 16 << 10;

const _: () = assert!(GRAIN >= size_of::<*mut c_void>());

/// Gives pages back to the system that hold no block of malloc's any more.
pub(crate) fn give_back() {
    // SAFETY: needs nothing; other threads' calls of malloc wait for it.
    #[cfg(target_env = "gnu")]
    unsafe {
        libc::malloc_trim(0);
    }
}

/// Makes all threads share a few heaps. Two and not one: who opens a file should not wait for the thread that makes states.
pub(crate) fn keep_together() {
    // SAFETY: needs nothing; a limit that is refused changes nothing.
    #[cfg(target_env = "gnu")]
    unsafe {
        libc::mallopt(libc::M_ARENA_MAX, 2);
    }
}

/// Account and blocks of one state. Its address is the allocator's user data for the life of the state.
#[derive(Debug)]
pub(crate) struct Memory {
    used: Cell<usize>,
    limit: Cell<usize>,
    /// Free small blocks by size; each begins with the address of the next.
    free: [Cell<*mut c_void>; SMALL_MAX / GRAIN],
    /// What is left of the newest chunk.
    rest: Cell<*mut u8>,
    rest_bytes: Cell<usize>,
    /// One of the chunks; each begins with the address of another.
    chunks: Cell<*mut c_void>,
    chunk_bytes: Cell<usize>,
}

impl Memory {
    /// An empty account that may grow to `limit` bytes.
    pub(crate) fn new(limit: usize) -> Self {
        Self {
            used: Cell::new(0),
            limit: Cell::new(limit),
            free: [const { Cell::new(ptr::null_mut()) }; SMALL_MAX / GRAIN],
            rest: Cell::new(ptr::null_mut()),
            rest_bytes: Cell::new(0),
            chunks: Cell::new(ptr::null_mut()),
            chunk_bytes: Cell::new(0),
        }
    }

    /// Bytes that the state holds now.
    pub(crate) fn used(&self) -> usize {
        self.used.get()
    }

    /// Changes the limit. What is held already stays; only growth beyond the limit is refused.
    pub(crate) fn set_limit(&self, limit: usize) {
        self.limit.set(limit);
    }

    /// Books a change of one block's size. False if the account does not allow it.
    fn book(&self, old: usize, new: usize) -> bool {
        let used = self.used.get().saturating_sub(old).saturating_add(new);
        let allowed = new <= old || used <= self.limit.get();
        if allowed {
            self.used.set(used);
        }
        allowed
    }

    /// The list of free blocks for a size; None for large blocks.
    fn list(&self, size: usize) -> Option<&Cell<*mut c_void>> {
        self.free.get(size.div_ceil(GRAIN).checked_sub(1)?)
    }

    /// A block of `size` bytes, not zero, or null. `shrinks`: instead of a larger one.
    fn take(&self, size: usize, shrinks: bool) -> *mut c_void {
        let Some(list) = self.list(size) else {
            // SAFETY: the size is not zero.
            return unsafe { libc::malloc(size) };
        };
        let block = list.get();
        if !block.is_null() {
            // SAFETY: blocks in the list were put there by `give`, which wrote the next one's address into them.
            list.set(unsafe { block.cast::<*mut c_void>().read() });
            return block;
        }
        let size = size.next_multiple_of(GRAIN);
        if self.rest_bytes.get() < size && !self.add_chunk(shrinks) {
            return ptr::null_mut();
        }
        let block = self.rest.get();
        self.rest_bytes.set(self.rest_bytes.get() - size);
        // SAFETY: the chunk has at least `size` bytes left, as compared above.
        self.rest.set(unsafe { block.add(size) });
        block.cast()
    }

    /// Takes a block back.
    ///
    /// # Safety
    /// The block must come from `take` with this size, and must not be used any more.
    unsafe fn give(&self, block: *mut c_void, size: usize) {
        // SAFETY: the caller vouches for the block; a small one has room for an address because of the grain.
        unsafe {
            match self.list(size) {
                Some(list) => {
                    block.cast::<*mut c_void>().write(list.get());
                    list.set(block);
                }
                None => libc::free(block),
            }
        }
    }

    /// A new chunk for small blocks. False if there is no memory or too much is held in chunks already; a block that
    /// shrinks is not refused for that, because Lua shrinks where it cannot fail.
    fn add_chunk(&self, shrinks: bool) -> bool {
        let most = self.limit.get().saturating_mul(2);
        if !shrinks && self.chunk_bytes.get() >= most.saturating_add(CHUNKS_SLACK) {
            return false;
        }
        // SAFETY: the size is not zero, and a chunk is larger than the address that it begins with. What is left of the
        // newest chunk is a multiple of the grain and below the size that was asked for, hence a small block.
        unsafe {
            let chunk = libc::malloc(CHUNK_BYTES);
            if chunk.is_null() {
                return false;
            }
            if self.rest_bytes.get() > 0 {
                self.give(self.rest.get().cast(), self.rest_bytes.get());
            }
            chunk.cast::<*mut c_void>().write(self.chunks.get());
            self.chunks.set(chunk);
            self.rest.set(chunk.cast::<u8>().add(GRAIN));
        }
        self.rest_bytes.set(CHUNK_ROOM);
        self.chunk_bytes.set(self.chunk_bytes.get() + CHUNK_BYTES);
        true
    }

    /// Gives chunks that hold nothing back, if that may be worth the time: after a collection much of what a program
    /// needed while it ran is free, and this state will hardly ask for it again.
    pub(crate) fn trim(&self) {
        if self.chunk_bytes.get().saturating_sub(self.used.get()) < TRIM_BYTES {
            return;
        }
        // Where each chunk begins and how much of it is free, by address.
        let mut chunks = Vec::new();
        // SAFETY: chunks and free blocks were made by `add_chunk` and `give`, which wrote the address of the next into each.
        let next = |place: *mut c_void| unsafe { place.cast::<*mut c_void>().read() };
        let mut chunk = self.chunks.get();
        while !chunk.is_null() {
            chunks.push((chunk, 0));
            chunk = next(chunk);
        }
        chunks.sort_unstable_by_key(|(chunk, _)| chunk.addr());
        let home = |chunks: &[(*mut c_void, usize)], block: *mut c_void| {
            let after = chunks.partition_point(|(chunk, _)| chunk.addr() <= block.addr());
            after.saturating_sub(1)
        };
        for (list, size) in self.free.iter().zip((GRAIN..).step_by(GRAIN)) {
            let mut block = list.get();
            while !block.is_null() {
                let at = home(&chunks, block);
                chunks[at].1 += size;
                block = next(block);
            }
        }
        for list in &self.free {
            let mut block = list.replace(ptr::null_mut());
            while !block.is_null() {
                let after = next(block);
                if chunks[home(&chunks, block)].1 < CHUNK_ROOM {
                    // SAFETY: as above; the block stays a free one.
                    unsafe { block.cast::<*mut c_void>().write(list.get()) };
                    list.set(block);
                }
                block = after;
            }
        }
        self.chunks.set(ptr::null_mut());
        for (chunk, free) in chunks {
            // SAFETY: of a chunk whose whole room was in the lists nobody has a block, and the lists have none of it any
            // more. `rest` is in no list, so that it does not point into such a chunk, or it is empty.
            unsafe {
                if free == CHUNK_ROOM {
                    libc::free(chunk);
                    self.chunk_bytes.set(self.chunk_bytes.get() - CHUNK_BYTES);
                } else {
                    chunk.cast::<*mut c_void>().write(self.chunks.get());
                    self.chunks.set(chunk);
                }
            }
        }
    }
}

impl Drop for Memory {
    /// Gives the chunks back. The state must be closed.
    fn drop(&mut self) {
        let mut chunk = self.chunks.get();
        while !chunk.is_null() {
            // SAFETY: chunks were made by `add_chunk`, which wrote the address of another into each.
            unsafe {
                let before = chunk.cast::<*mut c_void>().read();
                libc::free(chunk);
                chunk = before;
            }
        }
    }
}

/// LuaJIT's allocator: `new` zero frees, otherwise gives a block of `new` bytes with the old block's contents, or null.
///
/// # Safety
/// `account` must point to a live [`Memory`] that no other thread uses now; `block` must be null or come from this
/// function with the size `old`.
pub(crate) unsafe extern "C" fn allocate(
    account: *mut c_void,
    block: *mut c_void,
    old: usize,
    new: usize,
) -> *mut c_void {
    // SAFETY: the caller vouches for the account.
    let memory = unsafe { &*account.cast::<Memory>() };
    let old = if block.is_null() { 0 } else { old };
    if !memory.book(old, new) {
        return ptr::null_mut();
    }
    // SAFETY: the caller vouches for the block and its size; the copy stays within both sizes.
    unsafe {
        if new == 0 {
            if old > 0 {
                memory.give(block, old);
            }
            return ptr::null_mut();
        }
        if old > SMALL_MAX && new > SMALL_MAX {
            let moved = libc::realloc(block, new);
            if moved.is_null() {
                memory.book(new, old);
            }
            return moved;
        }
        if old > 0 && old.div_ceil(GRAIN) == new.div_ceil(GRAIN) {
            return block;
        }
        let moved = memory.take(new, new < old);
        if moved.is_null() {
            memory.book(new, old);
        } else if old > 0 {
            ptr::copy_nonoverlapping(block.cast::<u8>(), moved.cast::<u8>(), old.min(new));
            memory.give(block, old);
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The blocks of one account, each filled with a byte of its own.
    struct Blocks {
        memory: Memory,
        blocks: Vec<(*mut c_void, usize)>,
    }

    impl Blocks {
        fn new(limit: usize) -> Self {
            Self {
                memory: Memory::new(limit),
                blocks: Vec::new(),
            }
        }

        /// Resizes a block; the next number makes one. True if it was allowed.
        fn resize(&mut self, number: usize, new: usize) -> bool {
            if number == self.blocks.len() {
                self.blocks.push((ptr::null_mut(), 0));
            }
            let fill = u8::try_from(number % 251).unwrap();
            let (block, old) = self.blocks[number];
            let account = (&raw const self.memory).cast_mut().cast();
            // SAFETY: the account lives as long as the blocks, which are passed with their true sizes and are read and
            // written within them.
            unsafe {
                let moved = allocate(account, block, old, new);
                if new > 0 {
                    if moved.is_null() {
                        return false;
                    }
                    let kept = std::slice::from_raw_parts(moved.cast::<u8>(), old.min(new));
                    assert!(
                        kept.iter().all(|byte| *byte == fill),
                        "block {number} keeps its bytes"
                    );
                    moved.cast::<u8>().write_bytes(fill, new);
                    assert_eq!(moved.addr() % GRAIN, 0);
                }
                self.blocks[number] = (moved, new);
            }
            true
        }
    }

    impl Drop for Blocks {
        fn drop(&mut self) {
            for number in 0..self.blocks.len() {
                self.resize(number, 0);
            }
            if !std::thread::panicking() {
                assert_eq!(self.memory.used(), 0);
            }
        }
    }

    #[test]
    fn growth_beyond_the_limit_is_refused_and_counted_right() {
        let mut blocks = Blocks::new(1000);
        assert!(blocks.resize(0, 60));
        assert!(!blocks.resize(1, 950));
        assert_eq!(blocks.memory.used(), 60);
        assert!(!blocks.resize(0, 1001));
        assert!(blocks.resize(0, 1000));
        blocks.memory.set_limit(10);
        assert!(blocks.resize(0, 500), "shrinking is always allowed");
        assert_eq!(blocks.memory.used(), 500);
    }

    #[test]
    fn blocks_of_all_sizes_keep_their_bytes() {
        let mut blocks = Blocks::new(1 << 20);
        for round in 1..40 {
            for number in 0..100 {
                assert!(blocks.resize(number, (number * 7 + round * 31) % 1500));
            }
        }
    }

    #[test]
    fn chunks_that_hold_nothing_are_given_back_and_the_others_keep_their_bytes() {
        let mut blocks = Blocks::new(1 << 20);
        for number in 0..3000 {
            assert!(blocks.resize(number, 1 + (number * 7) % 300));
        }
        let full = blocks.memory.chunk_bytes.get();
        blocks.memory.trim();
        assert_eq!(blocks.memory.chunk_bytes.get(), full, "all are in use");
        // A long run and single ones out of the rest.
        for number in (500..2500).chain((0..500).step_by(2)) {
            blocks.resize(number, 0);
        }
        blocks.memory.trim();
        let left = blocks.memory.chunk_bytes.get();
        assert!(left < full / 2, "{left} of {full}");
        blocks.memory.trim();
        assert_eq!(blocks.memory.chunk_bytes.get(), left);
        for number in 0..3000 {
            assert!(blocks.resize(number, 1 + (number * 11) % 400));
        }
        for number in 0..3000 {
            blocks.resize(number, 0);
        }
        blocks.memory.trim();
        // The chunk that new blocks are cut from stays, and nothing else.
        assert!(blocks.memory.chunk_bytes.get() <= CHUNK_BYTES);
        assert!(blocks.resize(0, 100));
    }

    #[test]
    fn chunks_of_sizes_that_are_not_wanted_any_more_are_bounded() {
        const LIMIT: usize = 100 << 10;
        let mut blocks = Blocks::new(LIMIT);
        for size in (GRAIN..=SMALL_MAX).step_by(GRAIN) {
            while blocks.resize(blocks.blocks.len(), size) {}
            for number in 0..blocks.blocks.len() {
                blocks.resize(number, 0);
            }
            blocks.blocks.clear();
        }
        let most = 2 * LIMIT + CHUNKS_SLACK + CHUNK_BYTES;
        assert!(blocks.memory.chunk_bytes.get() <= most);
    }
}
