//! The priority of the threads that must not be late when the daemon dies, on a machine that has much to do.
//!
//! Owns the nice value of one thread. They sleep until something has gone wrong, so nobody else is slower for it.

use rustix::process::{getpriority_process, setpriority_process};

/// The highest priority that a nice value gives (setpriority(2)).
const HIGHEST: i32 = -20;

/// While it lives, this thread comes first, if the system allows that; then it has the nice value that it had before.
pub(super) struct Hurry(Option<i32>);

impl Hurry {
    /// Begins it. Threads that this one starts meanwhile are in a hurry as well.
    pub(super) fn begin() -> Self {
        // None: this thread alone, of Linux, whose nice values are those of threads.
        let before = getpriority_process(None).ok();
        let raised = before.filter(|_| setpriority_process(None, HIGHEST).is_ok());
        Self(raised)
    }

    /// Begins it for good.
    pub(super) fn for_good() {
        std::mem::forget(Self::begin());
    }
}

impl Drop for Hurry {
    fn drop(&mut self) {
        if let Some(before) = self.0 {
            let _ = setpriority_process(None, before);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_hurries_and_the_nice_value_comes_back() {
        let seen = std::thread::spawn(|| {
            let now = || getpriority_process(None).expect("a nice value");
            let before = now();
            let hurry = Hurry::begin();
            let (during, is_allowed) = (now(), hurry.0.is_some());
            drop(hurry);
            (before, during, is_allowed, now())
        });
        let other = getpriority_process(None).expect("a nice value");
        let (before, during, is_allowed, after) = seen.join().expect("no panic");
        assert_eq!(during, if is_allowed { HIGHEST } else { before });
        assert_eq!((before, after), (other, other));
    }
}
