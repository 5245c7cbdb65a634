//! New versions of a diagram on their way to it: a thread of its own reads and checks each while the program runs, so that
//! only the exchange itself comes between two steps.
//!
//! Owns the order of changes: what was asked for later is done later, also what would be quicker.

use super::live::{self, Answer};
use crate::host::Incoming;
use crate::limits;
use crate::protocol::program::WhenGone;
use lang_diagram::project::Project;
use lang_text::problem::Locale;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

/// A version whose thread has said what it has to say of it.
#[derive(Debug)]
pub(super) struct Ready {
    pub(super) when_gone: WhenGone,
    pub(super) name: String,
    /// Who has asked hears of it in this language.
    pub(super) locale: Locale,
    /// The project, or what a person is told instead.
    pub(super) project: Result<Project, Answer>,
}

/// One that is being prepared.
#[derive(Debug)]
struct Coming {
    when_gone: WhenGone,
    path: PathBuf,
    locale: Locale,
    project: Receiver<Result<Project, Answer>>,
}

/// Changes of a diagram that are asked for and not done.
#[derive(Debug, Default)]
pub(super) struct Versions {
    coming: Option<Coming>,
    /// Changes that were asked for after it. The daemon has a limit for those that have no answer.
    waiting: VecDeque<Incoming>,
}

impl Versions {
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
        let (sender, project) = channel();
        let file = path.clone();
        let prepare = move || {
            // The program may have ended meanwhile.
            let _ = sender.send(live::prepared(&file, locale));
        };
        let thread = std::thread::Builder::new().name("version".to_owned());
        // Without a thread nobody sends, which is seen where the version is taken.
        let _ = thread.spawn(prepare);
        self.coming = Some(Coming {
            when_gone,
            path,
            locale,
            project,
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
    pub(super) fn ready(&mut self) -> Option<Ready> {
        let coming = self.coming.as_ref()?;
        let project = match coming.project.try_recv() {
            Ok(project) => project,
            Err(TryRecvError::Empty) => return None,
            // No thread could be had, or it has failed: then here, and now.
            Err(TryRecvError::Disconnected) => live::prepared(&coming.path, coming.locale),
        };
        let Coming {
            when_gone,
            path,
            locale,
            ..
        } = self.coming.take()?;
        Some(Ready {
            when_gone,
            name: live::name(&path),
            locale,
            project,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_done_in_their_order() {
        let mut versions = Versions::default();
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
        let answer = ready.project.unwrap_err();
        assert!(
            answer.text.starts_with("none.qrs is not changed: "),
            "{answer:?}"
        );
        assert!(!answer.is_changed);
        assert_eq!(versions.next(), Some(set("n=2")));
        assert_eq!(versions.next(), None);
        assert!(versions.ready().is_none());
    }
}
