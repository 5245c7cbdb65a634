//! Panics of the daemon's threads: each is a defect of ours, costs only the work that it happened in, and is told in `status`.
//!
//! Owns the count and the words of the last ones. Where a panic is caught is the business of each thread; a thread without a
//! border of its own ends, and this file still knows.

use crate::events::lock;
use crate::limits::{PANIC_WORDS_MAX, PANICS_KEPT};
use std::collections::VecDeque;
use std::panic::{PanicHookInfo, set_hook, take_hook};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;

/// What is known of the panics of this process.
#[derive(Debug, Default)]
pub struct Panics {
    count: AtomicU32,
    last: Mutex<VecDeque<String>>,
}

impl Panics {
    /// Hears of every panic of this process from here on; what was done at one before is done as well.
    pub fn listen(self: &Arc<Self>) {
        let (before, heard) = (take_hook(), Arc::clone(self));
        set_hook(Box::new(move |info| {
            heard.note(info);
            before(info);
        }));
    }

    /// Waits for nothing that the thread may hold: it panics, wherever it is.
    fn note(&self, info: &PanicHookInfo<'_>) {
        self.count.fetch_add(1, Ordering::Relaxed);
        let thread = thread::current();
        let place = info
            .location()
            .map_or_else(String::new, |at| format!(" at {}:{}", at.file(), at.line()));
        let what = info.payload_as_str().unwrap_or("no words");
        let words = format!("{}{place}: {what}", thread.name().unwrap_or("a thread"));
        let words: String = words
            .chars()
            .map(|c| if c.is_control() { ' ' } else { c })
            .take(PANIC_WORDS_MAX)
            .collect();
        if let Ok(mut last) = self.last.try_lock() {
            last.truncate(PANICS_KEPT - 1);
            last.push_front(words);
        }
    }

    /// How many there were. Wraps.
    pub fn count(&self) -> u32 {
        self.count.load(Ordering::Relaxed)
    }

    /// Lines for `status`; none as long as all is well.
    pub fn status_lines(&self) -> String {
        let count = self.count();
        if count == 0 {
            return String::new();
        }
        let mut lines = format!("panics {count}: a defect of trikfs, please report it\n");
        for words in lock(&self.last).iter() {
            lines += &format!("panic in {words}\n");
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_counted_and_told_with_its_thread_and_place() {
        let panics = Arc::new(Panics::default());
        assert_eq!(panics.status_lines(), "");
        panics.listen();
        let thread = thread::Builder::new().name("injected".to_owned());
        let panicking = thread.spawn(|| panic!("on\npurpose")).expect("a thread");
        assert!(panicking.join().is_err());
        let lines = panics.status_lines();
        assert!(lines.starts_with("panics "), "{lines}");
        let told = format!("panic in injected at {}:", file!());
        assert!(lines.contains(&told), "{lines}");
        assert!(lines.contains(": on purpose\n"), "{lines}");
    }
}
