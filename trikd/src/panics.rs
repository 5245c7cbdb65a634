//! Panics of threads and tasks: each ends at its border, is logged, and is counted for the status.
//!
//! Owns the hook that hears of all of them, also of those in crates beside this one, and the borders at which what has failed
//! begins again. A task is caught by the event loop, a thread here.

use crate::{limits, log};
use std::panic::{AssertUnwindSafe, PanicHookInfo, catch_unwind, set_hook};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// How many there were.
#[derive(Debug, Default)]
pub struct Panics(AtomicU32);

impl Panics {
    /// Hears of every panic of this process from now on.
    pub fn watch() -> Arc<Self> {
        let panics = Arc::<Self>::default();
        let told = panics.clone();
        set_hook(Box::new(move |info| told.hear(info)));
        panics
    }

    fn hear(&self, info: &PanicHookInfo<'_>) {
        self.0.fetch_add(1, Ordering::Relaxed);
        let thread = std::thread::current();
        let place = info
            .location()
            .map_or_else(String::new, |place| place.to_string());
        tracing::error!(
            target: log::DAEMON,
            "a mistake of trikd, please report it: panic in the thread '{}' at {place}: {}",
            thread.name().unwrap_or("?"),
            info.payload_as_str().unwrap_or("no text")
        );
    }

    /// A line for the status.
    pub fn describe(&self) -> String {
        format!("panics {} caught\n", self.0.load(Ordering::Relaxed))
    }
}

/// The work of a thread, which begins again after a panic until it ends by itself.
pub fn restart_on_panic(mut work: impl FnMut()) {
    while catch_unwind(AssertUnwindSafe(&mut work)).is_err() {
        std::thread::sleep(Duration::from_millis(limits::PANIC_MS));
    }
}

/// A task that begins again after a panic until it ends by itself.
pub async fn restart_task_on_panic<F>(name: &'static str, task: impl Fn() -> F)
where
    F: Future<Output = ()> + 'static,
{
    while let Err(error) = tokio::task::spawn_local(task()).await
        && error.is_panic()
    {
        tracing::warn!(target: log::DAEMON, "{name} begins again");
        tokio::time::sleep(Duration::from_millis(limits::PANIC_MS)).await;
    }
}

/// A place at which a test has this process fail: in builds with assertions, if `TRIKD_PANIC` names it.
pub fn seam(name: &str, fails: impl FnOnce() -> bool) {
    if cfg!(debug_assertions) && fails() {
        let wanted = std::env::var("TRIKD_PANIC").unwrap_or_default();
        assert!(
            !wanted.split(',').any(|part| part == name),
            "a test wants that"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_that_fails_begins_again_with_what_it_had() {
        let mut turns = 0;
        restart_on_panic(|| {
            turns += 1;
            assert!(turns > 2, "the first two turns fail");
        });
        assert_eq!(turns, 3);
    }

    #[test]
    fn a_task_that_fails_begins_again() {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        let turns = std::rc::Rc::new(std::cell::Cell::new(0));
        let counts = turns.clone();
        let task = move || {
            let turns = counts.clone();
            async move {
                turns.set(turns.get() + 1);
                assert!(turns.get() > 1, "the first turn fails");
            }
        };
        tokio::task::LocalSet::new().block_on(&runtime, restart_task_on_panic("a test", task));
        assert_eq!(turns.get(), 2);
    }
}
