//! A diagram that somebody debugs on a robot, over its control port.
//!
//! Owns tags of orders and what comes between them. What orders mean is known in `lang_diagram::debug`; what front ends do
//! with it, in `debug`.

use super::link::{Link, Message, ms};
use super::relay::Relay;
use super::upload::Upload;
use crate::debug::asking::{Asked, Listener};
use crate::debug::report::Report;
use crate::debug::target::words;
use crate::debug::target::{Changed, Channel, Event, Target, Written, why_not};
use crate::error::Error;
use crate::limits;
use lang_diagram::debug::order::Order;
use lang_text::problem::{Locale, Words};
use serde_json::Value;
use std::collections::VecDeque;
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::time::{Duration, Instant};
use trikd::protocol::news;
use trikd::protocol::program::WhenGone;

/// How a talk about a program begins, and with that how it ends.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Begun {
    /// It was started for this talk, and is ended with it.
    Here,
    /// It ran already, and goes on after it.
    Elsewhere,
}

/// What is expected to run where somebody joins.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Runs {
    /// A program of blocks.
    Blocks,
    /// A program in JavaScript.
    JavaScript,
    /// Whatever can be debugged.
    Any,
}

impl Runs {
    /// Why a program that tells this of itself is not joined.
    fn misfit(self, program: &Value) -> Option<&'static str> {
        // Programs of blocks tell no language.
        let is_javascript = program.get("language").and_then(Value::as_str) == Some("JavaScript");
        match (self, is_javascript) {
            (Self::Blocks, true) => {
                Some("a program in JavaScript runs there: say its file NAME.js to join it")
            }
            (Self::JavaScript, false) => Some(
                "no program in JavaScript runs there: say the file of the program that runs to join it",
            ),
            (Self::Any, _) | (Self::Blocks, false) | (Self::JavaScript, true) => None,
        }
    }
}

/// A diagram on a robot.
pub(crate) struct Debugged {
    link: Link,
    /// The language of who debugs.
    locale: Locale,
    tag: u64,
    begun: Begun,
    /// What has come and was not asked for yet.
    events: VecDeque<Event>,
    is_gone: bool,
    /// A program in Python: its name, and where it connects to its debugger.
    python: Option<(String, Option<Relay>)>,
    /// The program whose change is waited for, and what has become of it.
    awaits: Option<String>,
    is_changed: Option<Changed>,
    /// The number of the question that was told last, and what it proposes.
    question: Option<(u64, String)>,
}

impl Debugged {
    /// Sends a diagram to a robot, where it is stopped before its first block. `diagram` is the main one of the file that is
    /// run, if it is not the first.
    ///
    /// # Errors
    /// A sentence: the robot cannot be reached, or refuses.
    pub(crate) fn launch(
        path: &Path,
        diagram: Option<&str>,
        at: &super::target::Target,
        locale: Locale,
    ) -> Result<Self, Error> {
        let upload = Upload::read(path, diagram, locale)?;
        let mut link = at.connect()?;
        upload.send(&mut link, |_, _| {})?;
        let mut debugged = Self::over(link, Begun::Here, locale);
        debugged.must(&format!("run {}", upload.name))?;
        // What was told before is of the program that ran until then.
        debugged.events.clear();
        debugged.is_gone = false;
        Ok(debugged)
    }

    /// Joins the program that runs on a robot.
    ///
    /// # Errors
    /// A sentence: the robot cannot be reached, no such program runs there, or somebody else is in control.
    pub(crate) fn attach(
        at: &super::target::Target,
        runs: Runs,
        locale: Locale,
    ) -> Result<Self, Error> {
        let mut debugged = Self::over(at.connect()?, Begun::Elsewhere, locale);
        // Before a diagram is stopped for nothing.
        let seen = debugged.must(&Order::Look.to_string())?;
        if let Some(why) = seen.get("program").and_then(|program| runs.misfit(program)) {
            return Err(Error::Robot(format!("{}: {why}", debugged.link.name())));
        }
        debugged.events.clear();
        let answer = debugged.must(&Order::Attach.to_string())?;
        if let Some(program) = answer.get("program") {
            debugged.events.push_back(Event::Report(program.clone()));
        }
        Ok(debugged)
    }

    /// Names of the variables of the program of blocks that runs on a robot; it is only looked at.
    ///
    /// # Errors
    /// A sentence: the robot cannot be reached, or no such program runs there.
    pub(crate) fn variables(
        at: &super::target::Target,
        locale: Locale,
    ) -> Result<Vec<String>, Error> {
        let mut debugged = Self::over(at.connect()?, Begun::Elsewhere, locale);
        let seen = debugged.must(&Order::Look.to_string())?;
        let told = seen.get("program").and_then(Report::read);
        let variables = told.unwrap_or_default().variables;
        Ok(variables.into_iter().map(|one| one.name).collect())
    }

    /// Sends a program in Python to a robot, where it waits for its debugger; also gives the folder that it is in there.
    ///
    /// # Errors
    /// A sentence: the robot cannot be reached, or refuses.
    pub(crate) fn python(
        path: &Path,
        at: &super::target::Target,
        locale: Locale,
    ) -> Result<(Self, String), Error> {
        let upload = Upload::read(path, None, locale)?;
        let mut link = at.connect()?;
        upload.send(&mut link, |_, _| {})?;
        let mut debugged = Self::over(link, Begun::Here, locale);
        let folder = debugged.begin_python(&upload.name)?;
        Ok((debugged, folder))
    }

    /// Ends the program in Python that runs, and has the same file begin, as it is now; also gives the folder that it is in there.
    /// What the old one has said in time is still told, and not its end.
    ///
    /// # Errors
    /// A sentence: the file cannot be sent, and what ran goes on unless its end is told; or the robot is gone.
    pub(crate) fn python_again(&mut self, path: &Path) -> Result<String, Error> {
        let upload = Upload::read(path, None, self.locale)?;
        upload.send(&mut self.link, |_, _| {})?;
        let folder = self.begin_python(&upload.name)?;
        self.events
            .retain(|event| matches!(event, Event::Said(Channel::Output, _)));
        self.is_gone = false;
        Ok(folder)
    }

    /// Has a program in Python begin that has been sent; the folder that it is in.
    fn begin_python(&mut self, name: &str) -> Result<String, Error> {
        let own = |error| Error::system("a port for debugpy", error);
        let (here, there) = self.link.addresses().map_err(own)?;
        let relay = Relay::new(here, there).map_err(own)?;
        let (port, secret) = relay.place().map_err(own)?;
        let order = format!("python {port}:{secret} {name}");
        // Before it begins: it may end as soon as that.
        self.python = Some((name.to_owned(), Some(relay)));
        let answer = self.ask(&order)?;
        match why_not(&answer) {
            None => {}
            // It takes the port and the secret for one word.
            Some(why) if words::is(&why, news::NO_PORT, self.locale) => {
                return Err(Error::Robot(format!(
                    "{}: its trikd is older than this program, and would let other programs of this computer in: install the one that belongs to it",
                    self.link.name()
                )));
            }
            Some(why) => return Err(Error::Robot(format!("{}: {why}", self.link.name()))),
        }
        let folder = answer.get("folder").and_then(Value::as_str);
        Ok(folder.unwrap_or_default().to_owned())
    }

    /// The debugger of a program in Python is at the other end of this.
    pub(crate) fn lead_to(&mut self, debugger: TcpStream) {
        if let Some((_, Some(relay))) = &mut self.python {
            relay.lead_to(debugger);
        }
    }

    fn let_in(&mut self) -> Result<(), Error> {
        if let Some((_, relay)) = &mut self.python
            && let Some(waits) = relay
        {
            let is_in = waits.turn();
            let lost = |error| Error::system("the connection of the program to debugpy", error);
            if is_in.map_err(lost)? {
                *relay = None;
            }
        }
        Ok(())
    }

    /// Whether a text tells the end of the program in Python.
    fn is_end(&self, text: &str) -> bool {
        let name = self.python.as_ref().map(|(name, _)| name.as_str());
        name.is_some_and(|name| news::ended(text, name).is_some())
    }

    fn over(mut link: Link, begun: Begun, locale: Locale) -> Self {
        link.speak(locale);
        Self {
            link,
            locale,
            tag: 0,
            begun,
            events: VecDeque::new(),
            is_gone: false,
            python: None,
            awaits: None,
            is_changed: None,
            question: None,
        }
    }

    fn must(&mut self, text: &str) -> Result<Value, Error> {
        let answer = self.ask(text)?;
        match why_not(&answer) {
            None => Ok(answer),
            Some(why) => Err(Error::Robot(match is_about_holder(&why, self.locale) {
                // It has an address already.
                true => why,
                false => format!("{}: {why}", self.link.name()),
            })),
        }
    }

    fn ask(&mut self, text: &str) -> Result<Value, Error> {
        self.tag += 1;
        let request = format!("debug:{} {text}", self.tag);
        self.link.ask(&[request.as_bytes()]);
        let deadline = Instant::now() + ms(limits::ANSWER_MS);
        while Instant::now() < deadline {
            if let Some(mut answer) = self.take()? {
                if let Some(why) = why_not(&answer) {
                    answer["why"] = Value::String(words::told(&why, self.locale));
                }
                return Ok(answer);
            }
            self.link.turn(ms(limits::TURN_MS), None, true)?;
        }
        Err(self.silence())
    }

    fn silence(&self) -> Error {
        Error::Robot(format!(
            "{} has not answered for {} s: perhaps its trikd is older than this program",
            self.link.name(),
            limits::ANSWER_MS / 1000
        ))
    }

    /// Whether a text is the answer to a change that is waited for.
    fn is_answer(&mut self, text: &str) -> bool {
        let name = self.awaits.as_deref();
        let answer = name.and_then(|name| Some((name, news::is_changed(text, name)?)));
        let Some((name, is_changed)) = answer else {
            return false;
        };
        let what = text.strip_prefix(name).unwrap_or(text);
        let what = what.split_once(": ").map_or(what, |(_, what)| what);
        let what = words::told(what, self.locale);
        self.is_changed = Some(match is_changed {
            true => Changed::InForce(what),
            false => Changed::CannotBe(what),
        });
        true
    }

    /// States that were told so far are of before the order that was answered just now.
    pub(crate) fn forget_states(&mut self) {
        self.events.retain(|event| match event {
            Event::Report(told) => told.get("state").is_none(),
            Event::Said(..) | Event::Asked(_) | Event::Over(_) => true,
        });
    }

    /// Gives up control as if the connection had ended: a program that is stopped stays so, with its motors at rest.
    pub(crate) fn leave(&mut self) {
        // A robot that does not answer has lost the connection, which means the same.
        let _ = self.ask("leave");
        self.is_gone = true;
    }

    /// Takes what has come; the answer to the last order, if it is among it.
    fn take(&mut self) -> Result<Option<Value>, Error> {
        self.let_in()?;
        while let Some(message) = self.link.next() {
            match message {
                Message::Debug(text) => {
                    let told: Value = serde_json::from_str(&text).map_err(|why| {
                        Error::Robot(format!("{}: {why} in its answer", self.link.name()))
                    })?;
                    if told.get("to").and_then(Value::as_u64) == Some(self.tag) {
                        return Ok(Some(told));
                    }
                    self.hear(told);
                }
                Message::Error(text) if text == news::NOT_PAIRED => {
                    return Err(Error::Robot(words::told(&text, self.locale)));
                }
                Message::Error(text) | Message::Info(text) if self.is_answer(&text) => {}
                Message::Error(text) | Message::Info(text) if self.is_end(&text) => {
                    self.is_gone = true;
                    self.put(Event::Over(text));
                }
                Message::Error(text) => {
                    self.link.remember(&text);
                    self.put(Event::Said(Channel::Message, text));
                }
                Message::Print(text) => {
                    let text = String::from_utf8_lossy(&text).into_owned();
                    self.put(Event::Said(Channel::Output, text));
                }
                Message::Info(_) | Message::Version | Message::Status(_) | Message::Stream(_) => {}
                Message::Question(json) => self.question(&json),
            }
        }
        Ok(None)
    }

    /// A question of the program; only who attends is asked.
    fn question(&mut self, json: &str) {
        let told: Value = serde_json::from_str(json).unwrap_or_default();
        let text = |name: &str| {
            let text = told.get(name).and_then(Value::as_str);
            text.unwrap_or_default().to_owned()
        };
        let seconds = told.get("seconds").and_then(Value::as_u64);
        let asked = Asked {
            variable: text("variable"),
            prompt: text("question"),
            default: text("default"),
            wrong: text("wrong"),
            until: seconds.map(|seconds| Instant::now() + Duration::from_secs(seconds)),
        };
        let number = told.get("number").and_then(Value::as_u64);
        if let Some(number) = number {
            self.question = Some((number, asked.default.clone()));
            self.put(Event::Asked(asked));
        }
    }

    fn hear(&mut self, told: Value) {
        if told.get("to").is_some() {
            // Of an order that was given up.
            return;
        }
        if told.get("state").and_then(Value::as_str) == Some("gone") {
            self.is_gone = true;
            let over = words::told(news::HAS_ENDED, self.locale);
            self.put(Event::Over(over));
            return;
        }
        if let Some(control) = told.get("control") {
            let control = control.as_str().unwrap_or("nobody");
            if control != self.link.own_address() {
                let text = words::told(&news::in_control(control), self.locale);
                self.put(Event::Said(Channel::Message, text));
            }
            return;
        }
        self.put(Event::Report(told));
    }

    fn put(&mut self, event: Event) {
        if self.events.len() >= limits::DEBUG_EVENTS_MAX {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}

/// Whether a refusal says who is in control, in this language.
fn is_about_holder(why: &str, locale: Locale) -> bool {
    let mut words = why.split(' ');
    let holder = words.find(|word| word.parse::<SocketAddr>().is_ok());
    holder.is_some_and(|holder| words::is(why, &news::in_control(holder), locale))
}

impl Target for Debugged {
    fn order(&mut self, order: &Order) -> Result<Value, Error> {
        let answer = self.ask(&order.to_string())?;
        if let Some(program) = answer.get("program") {
            // What came before it, such as the stop at which the order was given, is older.
            self.forget_states();
            // A program that is stopped already tells no other stop.
            let is_stopped = program.get("state").and_then(Value::as_str) == Some("stopped");
            if *order == Order::Pause && is_stopped {
                self.put(Event::Report(program.clone()));
            }
        }
        Ok(answer)
    }

    fn turn(&mut self, wait: Duration) -> Result<Vec<Event>, Error> {
        let until = Instant::now() + wait;
        loop {
            // An answer that comes now is one that was given up.
            self.take()?;
            let left = until.saturating_duration_since(Instant::now());
            if !self.events.is_empty() || left.is_zero() {
                self.link.turn(Duration::ZERO, None, true)?;
                return Ok(self.events.drain(..).collect());
            }
            self.link.turn(left, None, true)?;
        }
    }

    fn change(
        &mut self,
        file: &Path,
        diagram: Option<&str>,
        version: Written<'_>,
    ) -> Result<Changed, Error> {
        if let Some(mistakes) = version.mistakes(file, self.locale) {
            return Ok(Changed::Wrong(mistakes));
        }
        let upload = Upload::read(file, diagram, self.locale)?;
        let patch = format!("patch:{}:{}", WhenGone::Refuse.word(), upload.name);
        self.is_changed = None;
        self.awaits = Some(upload.name.clone());
        self.link.ask(&[&upload.request()]);
        self.link.ask(&[patch.as_bytes()]);
        let deadline = Instant::now() + ms(limits::ANSWER_MS);
        while self.is_changed.is_none() && Instant::now() < deadline {
            self.take()?;
            self.link.turn(ms(limits::TURN_MS), None, true)?;
        }
        self.awaits = None;
        let changed = self.is_changed.take();
        changed.ok_or_else(|| self.silence())
    }

    fn attend(&mut self, listener: Listener) {
        match listener {
            Listener::Person => self.link.ask(&[b"questions"]),
            Listener::Nobody | Listener::Gone => {
                if let Some((number, _)) = self.question.take() {
                    self.link.ask(&[format!("answer:{number}").as_bytes()]);
                }
                self.link.ask(&[b"noquestions"]);
            }
        }
    }

    fn answer(&mut self, text: &str) {
        if let Some((number, default)) = self.question.take() {
            let text = if text.is_empty() { &default } else { text };
            self.link
                .ask(&[format!("answer:{number}:{text}").as_bytes()]);
        }
    }

    fn keeps_past(&self) -> bool {
        false
    }

    fn scene(&self, _ms: u64) -> Option<Words> {
        None
    }

    fn end(&mut self) {
        // Its end may have come just now; what runs after it is another program, perhaps of somebody else.
        let _ = self.link.turn(Duration::ZERO, None, true);
        let _ = self.take();
        if !self.is_gone {
            self.link.ask(&[b"stop"]);
        }
        // The motors are at rest when this is answered; who does not answer has lost its connection, which is told.
        let _ = self.ask("leave");
        self.is_gone = true;
    }

    fn close(&mut self) {
        if self.is_gone {
            return;
        }
        match self.begun {
            Begun::Here => self.end(),
            Begun::Elsewhere => {
                let _ = self.ask(&Order::Detach.to_string());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_is_in_control_is_known_by_the_sentence_in_both_languages() {
        let why = news::in_control("127.0.0.1:33016");
        let russian = words::told(&why, Locale::Russian);
        assert_ne!(why, russian);
        assert!(is_about_holder(&why, Locale::English));
        assert!(is_about_holder(&russian, Locale::Russian));
        for other in [news::NO_DIAGRAM, "127.0.0.1:33016 is away", ""] {
            assert!(!is_about_holder(other, Locale::English), "{other}");
        }
    }
}
