//! Changes of the diagram that runs, and looks at it, on their way to it.
//!
//! Owns which diagram is meant, and what clients hear if none runs. The diagram answers by itself.

use super::Supervisor;
use super::child::Language;
use crate::protocol::news;
use crate::protocol::program::{ToProgram, WhenGone};
use std::path::Path;

impl Supervisor {
    /// Whether what runs is a diagram.
    fn runs_diagram(&self) -> bool {
        let runs = self.current.as_ref();
        self.last == Language::Diagram && runs.is_some_and(|current| current.child.runs())
    }

    /// A new version for the diagram that runs, which answers by itself.
    pub(super) fn patch(&mut self, when_gone: WhenGone, path: &Path) {
        let name = self.name_of(path);
        let runs = match &self.current {
            Some(current) if self.runs_diagram() => Some(current.name.clone()),
            Some(_) | None => None,
        };
        let file = path.display().to_string();
        let why = match runs {
            None => news::NO_DIAGRAM.to_owned(),
            Some(other) if other != name => news::other_runs(&other),
            Some(_)
                if self.send(ToProgram::Patch {
                    when_gone,
                    path: &file,
                }) =>
            {
                return;
            }
            Some(_) => news::TOO_MUCH.to_owned(),
        };
        self.broadcast(&news::not_changed(&name, &why));
    }

    /// An assignment for the diagram that runs, `NAME=EXPRESSION`.
    pub(super) fn set(&mut self, text: &str) {
        if !self.runs_diagram() || !self.send(ToProgram::Set(text)) {
            let name = text.split('=').next().unwrap_or_default().trim();
            self.broadcast(&news::not_changed(name, news::NO_DIAGRAM));
        }
    }

    /// Tells a program when somebody begins or ceases to look at it.
    pub(super) fn send_watch(&mut self) {
        let watched = self.around.clients.are_watching();
        if let Some(current) = &mut self.current
            && current.is_watched != watched
        {
            current.is_watched = watched;
            self.send(ToProgram::Watch(watched));
        }
    }
}
