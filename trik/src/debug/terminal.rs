//! A debugger in a terminal: lines in, sentences out.
//!
//! Owns what a person sees. The program runs while nothing is asked for; Ctrl-C stops it. Lines that come from a file or a
//! pipe are read one after the other, each when the program has stopped.

mod lists;

use super::asking::{Asked, Listener};
use super::complete::Known;
use super::lines::{Heard, Lines, PROMPT, Wanted};
use super::listing::Listing;
use super::report::{Report, State};
use super::signals::{Pressed, interrupts, pressed};
use super::stops::{self, words};
use super::target::{Changed, Channel, Event, Target, Written, log_lines, why_not};
use super::words::{NotUnderstood, Typed, understand};
use crate::diagrams::flow;
use crate::diagrams::save::must;
use crate::error::Error;
use crate::remote::person::{question_of, with_reason};
use crate::terminal::{harmless, harmless_lines};
use lang_diagram::debug::Spot;
use lang_diagram::debug::order::Order;
use lang_text::problem::{Locale, Words};
use nix::sys::signalfd::SignalFd;
use serde_json::Value;
use std::cell::RefCell;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;
use std::sync::mpsc::RecvTimeoutError;
use std::time::Duration;

/// How long one look at the program and the keyboard takes.
const TURN: Duration = Duration::from_millis(50);

/// What is debugged, as a person has named it.
pub(crate) struct Source {
    /// The file of the program.
    pub file: PathBuf,
    /// Its main diagram, if that is not the first one.
    pub diagram: Option<String>,
    /// The language of messages.
    pub locale: Locale,
}

/// A debugger with its person.
pub(crate) struct Terminal<'a> {
    target: &'a mut dyn Target,
    listing: Listing,
    source: Source,
    told: Report,
    /// Whether somebody reads prompts.
    is_interactive: bool,
    last: String,
    lines: Lines,
    /// What is to be shown above a command that is being typed, while it is put together.
    above: RefCell<Option<String>>,
    /// A question of the program that is not answered.
    asked: Option<Asked>,
    /// Somebody wants this process to end.
    is_leaving: bool,
}

impl<'a> Terminal<'a> {
    /// Of a program.
    pub(crate) fn new(target: &'a mut dyn Target, listing: Listing, source: Source) -> Self {
        Self {
            target,
            listing,
            source,
            told: Report::default(),
            is_interactive: io::stdin().is_terminal() && io::stdout().is_terminal(),
            last: String::new(),
            lines: Lines::none(),
            above: RefCell::new(None),
            asked: None,
            is_leaving: false,
        }
    }

    /// Talks until the person has enough.
    ///
    /// # Errors
    /// The robot is gone, or nobody can hear.
    pub(crate) fn run(&mut self) -> Result<(), Error> {
        let keys = interrupts().map_err(|error| Error::system("signals", error))?;
        self.lines = Lines::begin(self.is_interactive);
        self.says(words::greeting())?;
        self.wait(&keys)?;
        while !self.is_leaving {
            self.prompt()?;
            let Some(line) = self.line(&keys)? else {
                return Ok(());
            };
            if !self.is_interactive {
                self.say(&format!("(trik) {}", harmless(&line)))?;
            }
            // An empty line is the line before.
            if !line.trim().is_empty() {
                self.last = line;
            }
            if self.last.trim().is_empty() {
                continue;
            }
            match understand(&self.last, &self.listing) {
                Err(why) => self.refuse(&why)?,
                Ok(Typed::Quit) => return Ok(()),
                Ok(typed) => self.carry_out(&typed, &keys)?,
            }
        }
        Ok(())
    }

    /// Says why a line is not understood, and what may be meant by the name of a variable.
    fn refuse(&mut self, why: &NotUnderstood) -> Result<(), Error> {
        let mut said = why.in_locale(self.source.locale);
        if let NotUnderstood::NoBlock { text, .. } = why {
            self.look()?;
            if self.told.variables.iter().any(|one| one.name == *text) {
                said += words::is_variable(text).in_locale(self.source.locale);
            }
        }
        self.say(&harmless(&said))
    }

    fn say(&self, line: &str) -> Result<(), Error> {
        self.write(&format!("{line}\n"))
    }

    fn write(&self, text: &str) -> Result<(), Error> {
        if let Some(above) = &mut *self.above.borrow_mut() {
            above.push_str(text);
            return Ok(());
        }
        let mut out = io::stdout().lock();
        let said = out.write_all(text.as_bytes()).and_then(|()| out.flush());
        said.map_err(|error| Error::system("standard output", error))
    }

    fn says(&self, words: Words) -> Result<(), Error> {
        self.say(words.in_locale(self.source.locale))
    }

    fn prompt(&mut self) -> Result<(), Error> {
        self.lines.know(|| Known::of(&self.told, &self.listing));
        let is_shown = self.lines.ask(Wanted::Command);
        match self.is_interactive && !is_shown {
            true => self.write(PROMPT),
            false => Ok(()),
        }
    }

    /// The next line; none at the end.
    fn line(&mut self, keys: &SignalFd) -> Result<Option<String>, Error> {
        loop {
            match self.lines.next(TURN) {
                Ok(Heard::Line(line)) => return Ok(Some(line)),
                Ok(Heard::TooLong(bytes)) => {
                    self.says(words::too_long(bytes))?;
                    self.prompt()?;
                }
                Ok(Heard::Interrupt) => {
                    self.says(words::ends_by_quit())?;
                    self.prompt()?;
                }
                Err(RecvTimeoutError::Disconnected) => return Ok(None),
                Err(RecvTimeoutError::Timeout) => {
                    match pressed(keys) {
                        Some(Pressed::Leave) => return Ok(None),
                        Some(Pressed::Interrupt) if self.is_interactive => {
                            let words = words::ends_by_quit();
                            let text = format!("\n{}\n", words.in_locale(self.source.locale));
                            if !self.lines.show_above(&text) {
                                self.write(&text)?;
                                self.prompt()?;
                            }
                        }
                        // Nobody types who could be told.
                        Some(Pressed::Interrupt) => return Ok(None),
                        None => {}
                    }
                    // A robot goes on living while a person thinks.
                    let events = self.target.turn(Duration::ZERO)?;
                    self.hear_above(&events)?;
                }
            }
        }
    }

    /// Hears while a command may be being typed.
    fn hear_above(&mut self, events: &[Event]) -> Result<(), Error> {
        self.above = RefCell::new(Some(String::new()));
        let heard = self.hear(events);
        let above = self.above.take().unwrap_or_default();
        if !above.is_empty() && !self.lines.show_above(&above) {
            self.write(&above)?;
        }
        heard
    }

    fn carry_out(&mut self, typed: &Typed, keys: &SignalFd) -> Result<(), Error> {
        match typed {
            Typed::Order(order) => self.order(order, keys),
            Typed::List(line) => self.list(*line),
            Typed::Threads => {
                self.look()?;
                self.threads()
            }
            Typed::Calls => {
                self.look()?;
                self.calls()
            }
            Typed::Variables => {
                self.look()?;
                self.variables()
            }
            Typed::Scene => match self.target.scene(self.told.ms) {
                Some(scene) => self.says(scene),
                None => self.says(words::scene_unknown()),
            },
            Typed::Reload => self.reload(),
            Typed::Help => self.help(),
            // The caller ends at this one.
            Typed::Quit => Ok(()),
        }
    }

    /// Where the program is now: a person may have set a variable since it stopped.
    fn look(&mut self) -> Result<(), Error> {
        let answer = self.target.order(&Order::Look)?;
        if let Some(told) = answer.get("program").and_then(Report::read) {
            self.told = told;
        }
        Ok(())
    }

    fn order(&mut self, order: &Order, keys: &SignalFd) -> Result<(), Error> {
        let answer = self.target.order(order)?;
        if let Some(why) = why_not(&answer) {
            return self.say(&harmless(&why));
        }
        if let Some(value) = answer.get("value").and_then(Value::as_str) {
            return self.say(&harmless(value));
        }
        if let Some(number) = answer.get("number") {
            return self.says(self.set_at(number, order));
        }
        if let Some(points) = answer.get("breakpoints").and_then(Value::as_array) {
            let points = points.clone();
            return self.breakpoints(points, answer);
        }
        let Some(told) = answer.get("program").and_then(Report::read) else {
            return Ok(());
        };
        self.told = told;
        match self.told.state {
            State::Running | State::Searching => self.wait(keys),
            State::Past | State::Stopped => {
                // What was told of it meanwhile says the same again.
                let events = self.target.turn(Duration::ZERO)?;
                self.hear_but_states(&events)?;
                self.show_stop()
            }
            State::Ended => {
                let events = self.target.turn(Duration::ZERO)?;
                self.hear_but_states(&events)?;
                match events.iter().any(|event| matches!(event, Event::Over(_))) {
                    true => Ok(()),
                    false => self.says(words::ended_at(&stops::time(
                        &self.told,
                        self.source.locale,
                    ))),
                }
            }
        }
    }

    /// Lets the program run until it stops.
    fn wait(&mut self, keys: &SignalFd) -> Result<(), Error> {
        // It was stopped while it asked.
        self.show_question()?;
        loop {
            let events = self.target.turn(TURN)?;
            let has_ended = events.iter().any(|event| matches!(event, Event::Over(_)));
            self.hear(&events)?;
            if has_ended {
                self.asked = None;
            }
            if has_ended || !self.told.state.is_under_way() {
                return Ok(());
            }
            self.answer()?;
            match pressed(keys) {
                Some(Pressed::Interrupt) => {
                    if self.is_interactive && self.asked.is_some() {
                        self.say("")?;
                    }
                    self.target.order(&Order::Pause)?;
                }
                Some(Pressed::Leave) => {
                    self.is_leaving = true;
                    return Ok(());
                }
                None => {}
            }
        }
    }

    /// Shows the question that is open to a person; elsewhere it is shown with its answer.
    fn show_question(&self) -> Result<(), Error> {
        let Some(asked) = self.asked.as_ref().filter(|_| self.is_interactive) else {
            return Ok(());
        };
        self.write(&question(asked))
    }

    /// Passes the next line on to the program, if it asks.
    fn answer(&mut self) -> Result<(), Error> {
        // What is typed after the end of the time is an order at the next stop.
        if self.asked.as_ref().is_some_and(Asked::is_over) {
            self.asked = None;
        }
        let Some(asked) = &self.asked else {
            return Ok(());
        };
        self.lines.ask(Wanted::Answer);
        let line = match self.lines.next(Duration::ZERO) {
            Ok(Heard::Line(line)) => Some(line),
            Ok(Heard::TooLong(bytes)) => {
                self.says(words::too_long(bytes))?;
                return self.show_question();
            }
            Ok(Heard::Interrupt) | Err(RecvTimeoutError::Timeout) => return Ok(()),
            Err(RecvTimeoutError::Disconnected) => None,
        };
        if !self.is_interactive {
            let typed = line.as_deref().unwrap_or_default();
            let shown = format!("{}{}", question(asked), harmless(typed));
            self.say(shown.trim_end())?;
        }
        self.asked = None;
        match line {
            Some(line) => self.target.answer(&line),
            None => {
                self.says(words::answers_end())?;
                self.target.attend(Listener::Gone);
            }
        }
        Ok(())
    }

    fn hear(&mut self, events: &[Event]) -> Result<(), Error> {
        self.hear_but_states(events)?;
        let is_over = events.iter().any(|event| matches!(event, Event::Over(_)));
        let mut states = events.iter().filter_map(|event| match event {
            Event::Report(value) => Report::read(value),
            Event::Said(..) | Event::Asked(_) | Event::Over(_) => None,
        });
        let Some(told) = states.next_back() else {
            return Ok(());
        };
        // An answer said the same already.
        if told.is_same(&self.told) {
            return Ok(());
        }
        self.told = told;
        match self.told.state {
            State::Stopped | State::Past => self.show_stop(),
            // The end of a run is said with its verdict.
            State::Ended if is_over => Ok(()),
            State::Ended => self.says(words::ended_at(&stops::time(
                &self.told,
                self.source.locale,
            ))),
            State::Running | State::Searching => Ok(()),
        }
    }

    fn hear_but_states(&mut self, events: &[Event]) -> Result<(), Error> {
        for event in events {
            match event {
                Event::Report(value) => {
                    for line in log_lines(value) {
                        self.say(&harmless(line))?;
                    }
                }
                Event::Said(Channel::Output, text) => self.say(&harmless(text))?,
                Event::Said(Channel::Message, text) if text.trim().is_empty() => {}
                Event::Said(Channel::Message, text) => {
                    self.say(&format!("! {}", harmless(text)))?
                }
                Event::Asked(asked) => {
                    self.asked = Some(asked.clone());
                    self.show_question()?;
                }
                Event::Over(why) => {
                    self.say(&harmless(why))?;
                    if self.target.keeps_past() {
                        self.says(words::past_remains())?;
                    }
                }
            }
        }
        Ok(())
    }

    /// A breakpoint that was set, and where.
    fn set_at(&self, number: &Value, order: &Order) -> Words {
        // Only that order has a number for an answer.
        let Order::Break(point) = order else {
            return words::breakpoint(number.as_u64().unwrap_or_default());
        };
        match &point.at {
            Spot::Block(block) => {
                let line = self.listing.line_of(block);
                let text = self.listing.text(line);
                words::set_at(&number.to_string(), line, text.trim())
            }
            Spot::Change(variable) => words::watches(&number.to_string(), variable),
        }
    }

    fn show_stop(&mut self) -> Result<(), Error> {
        for line in stops::lines(&self.told, Some(&self.listing), self.source.locale) {
            self.say(&line)?;
        }
        Ok(())
    }

    /// The file as it is now takes the place of what runs.
    fn reload(&mut self) -> Result<(), Error> {
        let Source {
            file,
            diagram,
            locale,
        } = &self.source;
        let diagram = diagram.as_deref();
        let opened = match must(flow::open(file, diagram), file, *locale) {
            Ok(opened) => opened,
            Err(refusal) => return self.say(&harmless_lines(&refusal.lines.join("\n"))),
        };
        let version = match &opened {
            flow::Program::Diagram(opened) => Written::Diagram(&opened.project),
            flow::Program::Flow(flow, _) | flow::Program::Text(flow) => Written::Flow(flow),
        };
        match self.target.change(file, diagram, version)? {
            Changed::InForce(what) => {
                self.listing = Listing::of_program(&opened, *locale);
                self.says(words::changed(&harmless(&what)))?;
                let events = self.target.turn(Duration::ZERO)?;
                self.hear_but_states(&events)?;
                self.look()?;
                self.show_stop()
            }
            Changed::Wrong(why) => self.says(words::unchanged(&harmless_lines(&why))),
            Changed::CannotBe(why) => {
                self.says(words::unchanged_unless_anew(&harmless_lines(&why)))
            }
        }
    }
}

/// A question, with a blank behind it for the answer.
fn question(asked: &Asked) -> String {
    let shown = question_of(&asked.variable, &asked.prompt, &asked.default);
    with_reason(&asked.wrong, shown)
}
