//! New versions of a program on their way to it: a thread of its own reads and checks each while the program runs, so that
//! only the exchange itself comes between two steps.
//!
//! Owns the order of changes: what was asked for later is done later, also what would be quicker. Knows no language: how a
//! file is read and checked is given to it.

use super::live::{self, Answer, Prepared};
use super::words;
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

/// What somebody asks for.
#[derive(Debug, Eq, PartialEq)]
pub(super) enum Change {
    /// The version in a file.
    Version(Asked),
    /// An assignment, `NAME=EXPRESSION`; the client that has asked hears of it in this language.
    Set(String, Locale),
}

/// A version that is asked for.
#[derive(Debug, Eq, PartialEq)]
pub(super) struct Asked {
    pub(super) when_gone: WhenGone,
    pub(super) path: PathBuf,
    /// The client that has asked hears of it in this language.
    pub(super) locale: Locale,
}

/// A version whose thread has said what it has to say of it.
#[derive(Debug)]
pub(super) struct Ready<S> {
    pub(super) when_gone: WhenGone,
    pub(super) name: String,
    pub(super) locale: Locale,
    /// How many changes have asked for it, each of which has an answer.
    pub(super) count: usize,
    /// The version, or what a person is told instead.
    pub(super) version: Result<Prepared<S>, Answer>,
}

/// One that is being prepared.
#[derive(Debug)]
struct Coming<S> {
    asked: Asked,
    count: usize,
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
    waiting: VecDeque<Change>,
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

    /// A change is asked for; it is due once all before it are done.
    pub(super) fn ask(&mut self, change: Change) {
        self.waiting.push_back(change);
    }

    /// The next assignment that is due, with the language of its answer. A version that is due begins to be prepared.
    pub(super) fn next(&mut self) -> Option<(String, Locale)> {
        while self.coming.is_none() {
            match self.waiting.pop_front()? {
                Change::Set(text, locale) => return Some((text, locale)),
                Change::Version(asked) => {
                    let mut count = 1;
                    // The file is read now, so all that ask for it in a row mean this one.
                    let is_same =
                        |next: &mut Change| matches!(next, Change::Version(next) if *next == asked);
                    while self.waiting.pop_front_if(is_same).is_some() {
                        count += 1;
                    }
                    self.begin(asked, count);
                }
            }
        }
        None
    }

    fn begin(&mut self, asked: Asked, count: usize) {
        let (sender, version) = channel();
        let (prepare, own, locale) = (self.prepare, self.own, asked.locale);
        let (file, here) = (asked.path.clone(), sender.clone());
        let work = move || {
            // The program may have ended meanwhile.
            let _ = sender.send(prepare(&file, own, locale));
        };
        let thread = std::thread::Builder::new().name("version".to_owned());
        if thread.spawn(work).is_err() {
            // No thread can be had: then here, and now.
            let _ = here.send(prepare(&asked.path, own, locale));
        }
        self.coming = Some(Coming {
            asked,
            count,
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
        let name = live::name(&coming.asked.path);
        let locale = coming.asked.locale;
        let version = match coming.version.try_recv() {
            Ok(version) => version,
            Err(TryRecvError::Empty) => return None,
            // A version that ends its thread does not end the program that runs.
            Err(TryRecvError::Disconnected) => {
                let why = words::not_prepared();
                Err(Answer::unchanged(&name, why.in_locale(locale)))
            }
        };
        let Coming { asked, count, .. } = self.coming.take()?;
        Some(Ready {
            when_gone: asked.when_gone,
            name,
            locale,
            count,
            version,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn version(path: PathBuf) -> Change {
        Change::Version(Asked {
            when_gone: WhenGone::End,
            path,
            locale: Locale::English,
        })
    }

    fn set(text: &str) -> Change {
        Change::Set(text.to_owned(), Locale::English)
    }

    fn wait<S: Send + 'static>(versions: &mut Versions<S>) -> Ready<S> {
        loop {
            match versions.ready() {
                Some(ready) => return ready,
                None => std::thread::yield_now(),
            }
        }
    }

    #[test]
    fn changes_are_done_in_their_order() {
        let mut versions = Versions::new(live::prepared, Locale::English);
        let due = |text: &str| Some((text.to_owned(), Locale::English));
        versions.ask(set("n=1"));
        assert_eq!(versions.next(), due("n=1"));
        let folder = tempfile::tempdir().unwrap();
        let none = folder.path().join("none.qrs");
        versions.ask(version(none.clone()));
        versions.ask(set("n=2"));
        assert_eq!(versions.next(), None, "it overtakes no version");
        let ready = wait(&mut versions);
        assert_eq!((&*ready.name, ready.count), ("none.qrs", 1));
        let answer = ready.version.unwrap_err();
        assert!(
            answer.text.starts_with("none.qrs is not changed: "),
            "{answer:?}"
        );
        assert!(!answer.is_changed);
        // Several that mean the same file in a row are one, and a change between them divides them.
        for change in [version(none.clone()), version(none.clone()), set("n=3")] {
            versions.ask(change);
        }
        versions.ask(version(none));
        assert_eq!(versions.next(), due("n=2"));
        assert_eq!(versions.next(), None);
        assert_eq!(wait(&mut versions).count, 2);
        assert_eq!(versions.next(), due("n=3"));
        assert_eq!(versions.next(), None);
        assert_eq!(wait(&mut versions).count, 1);
        assert_eq!(versions.next(), None);
        assert!(versions.ready().is_none());
    }

    #[test]
    fn a_version_that_ends_its_thread_is_refused() {
        let fault: Prepare<()> = |_, _, _| panic!("a fault of the checks");
        let mut versions = Versions::new(fault, Locale::English);
        versions.ask(version("fault.qrs".into()));
        assert_eq!(versions.next(), None);
        let answer = wait(&mut versions).version.unwrap_err();
        assert!(!answer.is_changed);
        assert!(
            answer.text.starts_with("fault.qrs is not changed: "),
            "{answer:?}"
        );
        assert!(versions.ready().is_none());
    }
}
