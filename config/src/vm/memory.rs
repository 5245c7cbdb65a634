//! Memory of a Lua state: from malloc, counted, with a limit.
//!
//! Owns the allocator function that LuaJIT calls. Knows nothing of what the memory holds.

use std::cell::Cell;
use std::ffi::c_void;
use std::ptr;

/// Account of one state. Its address is the allocator's user data for the life of the state.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    used: Cell<usize>,
    limit: Cell<usize>,
}

impl Memory {
    /// An empty account that may grow to `limit` bytes.
    pub(crate) fn new(limit: usize) -> Self {
        Self {
            used: Cell::new(0),
            limit: Cell::new(limit),
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
    // SAFETY: the caller vouches for the block; null is allowed by both functions.
    unsafe {
        if new == 0 {
            libc::free(block);
            return ptr::null_mut();
        }
        let moved = libc::realloc(block, new);
        if moved.is_null() {
            memory.book(new, old);
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growth_beyond_the_limit_is_refused_and_counted_right() {
        let memory = Memory::new(100);
        let account = (&raw const memory).cast_mut().cast();
        // SAFETY: the account lives to the end of the test and blocks are passed with their true sizes.
        unsafe {
            let block = allocate(account, ptr::null_mut(), 0, 60);
            assert!(!block.is_null());
            assert!(allocate(account, ptr::null_mut(), 0, 50).is_null());
            assert_eq!(memory.used(), 60);
            assert!(allocate(account, block, 60, 101).is_null());
            let block = allocate(account, block, 60, 100);
            assert!(!block.is_null());
            memory.set_limit(10);
            let block = allocate(account, block, 100, 50);
            assert!(!block.is_null(), "shrinking is always allowed");
            allocate(account, block, 50, 0);
            assert_eq!(memory.used(), 0);
        }
    }
}
