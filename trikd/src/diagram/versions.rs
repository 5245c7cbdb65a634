//! New versions of a program on their way to it: a thread of its own reads and checks each while the program runs, so that
//! only the exchange itself comes between two steps.
//!
//! Owns the order of changes: what was asked for later is done later, also what would be quicker. Knows no language: how a
//! file is read and checked is given to it.

use super::live::{self, Answer, Prepared};
use super::words;
use crate::host::Incoming;
use crate::limits;
use crate::protocol::program::WhenGone;
use lang_text::problem::Locale;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

/// Reads and checks the version in a file, or says what a person is told instead; with the language of the program, and that
/// of the one who asks.
pub(super) type Prepare<S> = fn(&Path, Locale, Locale) -> Result<Prepared<S>, Answer>;

/// A version whose thread has said what it has to say of it.
#[derive(Debug)]
pub(super) struct Ready<S> {
    pub(super) when_gone: WhenGone,
    pub(super) name: String,
    /// The client that has asked hears of it in this language.
    pub(super) locale: Locale,
    /// The version, or what a person is told instead.
    pub(super) version: Result<Prepared<S>, Answer>,
}

/// One that is being prepared.
#[derive(Debug)]
struct Coming<S> {
    when_gone: WhenGone,
    name: String,
    locale: Locale,
    version: Receiver<Result<Prepared<S>, Answer>>,
}

/// Changes of a program that are asked for and not done.
#[derive(Debug)]
pub(super) struct Versions<S> {
    prepare: Prepare<S>,
    /// The language of the program.
    own: Locale,
    coming: Option<Coming<S>>,
    /// Changes that were asked for after it. The daemon has a limit for those that have no answer.
    waiting: VecDeque<Incoming>,
}

impl<S: Send + 'static> Versions<S> {
    /// None is asked for yet.
    pub(super) fn new(prepare: Prepare<S>, own: Locale) -> Self {
        Self {
            prepare,
            own,
            coming: None,
            waiting: VecDeque::new(),
        }
    }

    /// Keeps a change until those before it are done; nothing is before it: it comes back.
    pub(super) fn keep(&mut self, change: Incoming) -> Option<Incoming> {
        if self.coming.is_none() {
            return Some(change);
        }
        self.waiting.push_back(change);
        None
    }

    /// The next change that waits, once nothing is before it.
    pub(super) fn next(&mut self) -> Option<Incoming> {
        match self.coming {
            Some(_) => None,
            None => self.waiting.pop_front(),
        }
    }

    /// Begins to prepare a version.
    pub(super) fn begin(&mut self, when_gone: WhenGone, path: PathBuf, locale: Locale) {
        let (sender, version) = channel();
        let (prepare, own, file) = (self.prepare, self.own, path.clone());
        let here = sender.clone();
        let work = move || {
            // The program may have ended meanwhile.
            let _ = sender.send(prepare(&file, own, locale));
        };
        let thread = std::thread::Builder::new().name("version".to_owned());
        if thread.spawn(work).is_err() {
            // No thread can be had: then here, and now.
            let _ = here.send(prepare(&path, own, locale));
        }
        self.coming = Some(Coming {
            when_gone,
            name: live::name(&path),
            locale,
            version,
        });
    }

    /// Until when the daemon may be heard before somebody looks whether a version is ready; at most to this moment.
    pub(super) fn until(&self, due: Instant) -> Instant {
        match self.coming {
            Some(_) => due.min(Instant::now() + Duration::from_millis(limits::VERSION_LOOK_MS)),
            None => due,
        }
    }

    /// The version that was being prepared, if it is ready.
    pub(super) fn ready(&mut self) -> Option<Ready<S>> {
        let coming = self.coming.as_ref()?;
        let version = match coming.version.try_recv() {
            Ok(version) => version,
            Err(TryRecvError::Empty) => return None,
            // A version that ends its thread does not end the program that runs.
            Err(TryRecvError::Disconnected) => {
                let why = words::not_prepared();
                Err(Answer::unchanged(
                    &coming.name,
                    why.in_locale(coming.locale),
                ))
            }
        };
        let Coming {
            when_gone,
            name,
            locale,
            ..
        } = self.coming.take()?;
        Some(Ready {
            when_gone,
            name,
            locale,
            version,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_done_in_their_order() {
        let mut versions = Versions::new(live::prepared, Locale::English);
        let set = |text: &str| Incoming::Set(text.to_owned(), Locale::English);
        assert_eq!(versions.keep(set("n=1")), Some(set("n=1")));
        let folder = tempfile::tempdir().unwrap();
        versions.begin(
            WhenGone::End,
            folder.path().join("none.qrs"),
            Locale::English,
        );
        assert_eq!(versions.keep(set("n=2")), None);
        assert_eq!(versions.next(), None, "it overtakes no version");
        let ready = loop {
            match versions.ready() {
                Some(ready) => break ready,
                None => std::thread::yield_now(),
            }
        };
        assert_eq!(ready.name, "none.qrs");
        let answer = ready.version.unwrap_err();
        assert!(
            answer.text.starts_with("none.qrs is not changed: "),
            "{answer:?}"
        );
        assert!(!answer.is_changed);
        assert_eq!(versions.next(), Some(set("n=2")));
        assert_eq!(versions.next(), None);
        assert!(versions.ready().is_none());
    }
    #[test]
    fn a_version_that_ends_its_thread_is_refused() {
        let mut versions: Versions<()> =
            Versions::new(|_, _, _| panic!("a fault of the checks"), Locale::English);
        versions.begin(WhenGone::End, "fault.qrs".into(), Locale::English);
        let ready = loop {
            match versions.ready() {
                Some(ready) => break ready,
                None => std::thread::yield_now(),
            }
        };
        let answer = ready.version.unwrap_err();
        assert!(!answer.is_changed);
        assert!(
            answer.text.starts_with("fault.qrs is not changed: "),
            "{answer:?}"
        );
        assert!(versions.ready().is_none());
    }
}
