//! Changes of the diagram that runs, looks at it, and orders to its debugger, on their way to it.
//!
//! Owns which diagram is meant, and what clients hear if none runs. The diagram answers by itself.

use super::child::Language;
use super::output::Manner;
use super::queue::{Heard, Meeting, Wish};
use super::says::cut;
use super::{Cause, Current, Supervisor};
use crate::clients::debugging::OrderId;
use crate::protocol::news;
use crate::protocol::program::{ALL, ToProgram, WhenGone};
use crate::{diagram, limits, log};
use lang_text::problem::Locale;
use std::path::Path;

impl Supervisor {
    /// Whether what runs is a diagram.
    fn runs_diagram(&self) -> bool {
        let runs = self.current.as_ref();
        self.last == Language::Diagram && runs.is_some_and(|current| current.child.runs())
    }

    /// Whether what runs takes orders of a debugger.
    fn takes_orders(&self) -> bool {
        let runs = self.current.as_ref();
        self.last.has_debugger() && runs.is_some_and(|current| current.child.runs())
    }

    /// The language of an answer.
    fn locale(&self, heard: Heard) -> Locale {
        heard.unwrap_or_else(|| diagram::locale(&self.around.settings.language))
    }

    /// A new version for the diagram that runs, which answers by itself.
    pub(super) fn patch(&mut self, client: u32, when_gone: WhenGone, path: &Path, heard: Heard) {
        let locale = self.locale(heard);
        let name = self.name_of(path);
        let runs = match &self.current {
            Some(current) if self.runs_diagram() => Some(current.name.clone()),
            Some(_) | None => None,
        };
        let file = path.display().to_string();
        let why = match runs {
            None => news::NO_DIAGRAM.to_owned(),
            Some(other) if other != name => news::other_runs(&other),
            Some(_) => {
                let message = ToProgram::Patch {
                    when_gone,
                    locale,
                    path: &file,
                };
                return self.change(client, &name, message);
            }
        };
        self.not_changed(client, &name, &why);
    }

    /// Sends a change to the diagram that runs, and keeps in mind whose it is.
    fn change(&mut self, client: u32, name: &str, message: ToProgram<'_>) {
        if let Some(current) = &mut self.current
            && current.changes.len() < limits::DEBUG_ORDERS
            && current.child.send(message)
        {
            current.changes.push_back((client, name.to_owned()));
        } else {
            self.not_changed(client, name, news::TOO_MUCH);
        }
    }

    /// A refusal is for who has asked: to all others it would look like something that the program says.
    fn not_changed(&self, client: u32, name: &str, why: &str) {
        let told = news::not_changed(name, why);
        self.around.clients.tell(client, told.as_bytes());
    }

    /// What has become of the oldest change. What is in force concerns everybody.
    pub(super) fn hear_change(&mut self, is_changed: bool, text: &str) {
        let current = self.current.as_mut();
        let asked = current.and_then(|current| current.changes.pop_front());
        match (is_changed, asked) {
            (true, _) => self.show(Manner::Info, text),
            (false, Some((client, _))) => {
                let told = format!("error: {}", cut(text));
                self.around.clients.tell(client, told.as_bytes());
            }
            // A program answers nothing that nobody has asked.
            (false, None) => {}
        }
    }

    /// A question of the diagram, for everybody who answers questions.
    pub(super) fn question(&mut self, number: u32, json: &str) {
        if self.around.clients.ask(json) {
            return;
        }
        let name = self.current.as_ref().map(|current| current.name.clone());
        let name = name.unwrap_or_default();
        if let Some(current) = &mut self.current
            && !std::mem::replace(&mut current.has_asked_nobody, true)
        {
            self.broadcast(&format!("info: {}", news::nobody_answers(&name)));
        }
        self.reply(number, None);
    }

    /// What a person says to it.
    pub(super) fn reply(&mut self, number: u32, text: Option<&str>) {
        if self.runs_diagram() {
            self.send(ToProgram::Reply { number, text });
        }
    }

    /// An assignment for the diagram that runs, `NAME=EXPRESSION`.
    pub(super) fn set(&mut self, client: u32, text: &str, heard: Heard) {
        let locale = self.locale(heard);
        let name = text.split('=').next().unwrap_or_default().trim();
        match self.runs_diagram() {
            true => self.change(client, name, ToProgram::Set { locale, text }),
            false => self.not_changed(client, name, news::NO_DIAGRAM),
        }
    }

    /// What somebody wants who debugs; each has one answer.
    pub(super) async fn debug(&mut self, asked: OrderId, wish: Wish) {
        match wish {
            Wish::Run(path) => self.run_debugged(asked, &path).await,
            Wish::Debugpy(place, path) => self.run_python(asked, &place, &path).await,
            Wish::Order(order) => self.order(asked, &order),
            Wish::Overtaken => self.refuse(asked, news::OVERTAKEN),
            Wish::Left => self.around.clients.debug_done(asked),
        }
    }

    fn refuse(&self, asked: OrderId, why: &str) {
        self.around.clients.debug_refused(asked, why);
    }

    /// Runs a diagram or a program in JavaScript, stopped at its beginning.
    async fn run_debugged(&mut self, asked: OrderId, path: &Path) {
        self.end(Cause::Ordered("another program")).await;
        let name = self.name_of(path);
        let file = path.display().to_string();
        let first = ToProgram::Debugged(&file);
        let language = Language::of(path);
        self.start(language, name, Some(path.to_owned()), (first, asked.locale));
        match self.current {
            Some(_) => self.around.clients.debug_done(asked),
            None => self.refuse(asked, news::NOT_STARTED),
        }
    }

    /// Runs a Python program that lets itself be debugged by who listens at this place.
    async fn run_python(&mut self, asked: OrderId, place: &Meeting, path: &Path) {
        self.end(Cause::Ordered("another program")).await;
        let name = self.name_of(path);
        let file = path.display().to_string();
        let first = ToProgram::Debugpy {
            address: &place.address.to_string(),
            secret: place.secret.as_deref(),
            path: &file,
        };
        let first = (first, asked.locale);
        self.start(Language::Python, name, Some(path.to_owned()), first);
        let Some(current) = &mut self.current else {
            return self.refuse(asked, news::NOT_STARTED);
        };
        current.is_under_debugpy = true;
        let folder = path.parent().unwrap_or(path).display().to_string();
        self.around.clients.debug_begun(asked, &folder);
    }

    /// Writes once to the log, for the person in charge of the robot, that a program does not reach its debugger.
    pub(super) fn note_debugger(&mut self, said: &str) {
        if let Some(current) = &mut self.current
            && current.is_under_debugpy
            && said.starts_with(news::NO_DEBUGGER_THERE)
            && !std::mem::replace(&mut current.has_missed_debugger, true)
        {
            let name = &current.name;
            tracing::warn!(target: log::PROGRAMS, "{name}: {}", said.trim_end());
        }
    }

    /// An order for the debugger of the diagram that runs, which answers by itself.
    fn order(&mut self, asked: OrderId, order: &str) {
        if !self.takes_orders() {
            return self.refuse(asked, news::NO_DIAGRAM);
        }
        let locale = self.locale(asked.locale);
        let Some(current) = &mut self.current else {
            return;
        };
        let message = ToProgram::Debug {
            client: asked.client,
            tag: asked.tag,
            locale,
            order,
        };
        if current.orders.len() < limits::DEBUG_ORDERS && current.child.send(message) {
            current.orders.push_back(asked);
        } else {
            self.refuse(asked, news::TOO_MUCH);
        }
    }

    /// The client in control of the debugger is gone. A program in Python would drive on from where it was stopped, with
    /// nobody there.
    pub(super) async fn debugger_left(&mut self) {
        let is_under_debugpy = |current: &Current| current.is_under_debugpy;
        if self.takes_orders() {
            self.send(ToProgram::DebugLeft);
        } else if self.current.as_ref().is_some_and(is_under_debugpy) {
            self.end(Cause::Ordered("the end of its debugger")).await;
        }
    }

    /// The answer to the oldest order, or a state for all who debug.
    pub(super) fn hear_debugger(&mut self, client: u32, json: &str) {
        let clients = &self.around.clients;
        if client == ALL {
            return clients.tell_state(json);
        }
        if let Some(current) = &mut self.current {
            // A program answers in order, and no client that has not asked.
            let is_oldest = |asked: &OrderId| asked.client == client;
            if current
                .orders
                .pop_front_if(|asked| is_oldest(asked))
                .is_some()
            {
                clients.tell_answer(client, json);
            }
        }
    }

    /// Nobody answers any more.
    pub(super) fn end_debugger(&self, current: &mut Current) {
        for asked in current.orders.drain(..) {
            self.refuse(asked, news::HAS_ENDED);
        }
        for (client, name) in current.changes.drain(..) {
            self.not_changed(client, &name, news::HAS_ENDED);
        }
        if self.last.has_debugger() {
            self.around.clients.tell_state(news::GONE);
        }
    }

    /// Tells a program when somebody begins or ceases to look at it, and to tell everything again for a client that has missed
    /// some of it or begins to record.
    pub(super) fn send_watch(&mut self) {
        let clients = &self.around.clients;
        let is_behind = clients.take_behind();
        let is_again = self.around.record.take_newcomer() || is_behind;
        let watched = clients.are_watching() || self.around.record.is_heard();
        if let Some(current) = &mut self.current
            && (current.is_watched != watched || watched && is_again)
        {
            current.is_watched = watched;
            self.send(ToProgram::Watch(watched));
        }
    }
}
