//! A debugger's desk: orders come in as texts, what they do goes out as JSON.
//!
//! Owns what each order does, and what is told when. The owner of the desk gives it the robot and the clock, carries the
//! texts, and decides what motors do at a stop. Knows no transport, no clients and no files.

use super::order::{NoOrder, Order};
use super::{Breakpoint, NoBack, NoBreakpoint, NotNow, Phase, Session, Step, report, words};
use crate::brick::Brick;
use crate::limits;
use crate::machine::Machine;
use crate::machine::trace::Trace;
use crate::machine::view::Doing;
use lang_text::json::Object;
use lang_text::problem::{Locale, Problem};
use std::collections::BTreeSet;

/// A program with its debugger, for people elsewhere.
#[derive(Clone, Debug)]
pub struct Desk {
    session: Session,
    locale: Locale,
    /// How much memory the past may take.
    history_bytes: usize,
    /// Whether motors rest while the program is stopped.
    pub motors_rest: bool,
    /// What was told last: whether it runs, and how often it was stopped.
    told: Announcement,
}

/// What is told by itself when it changes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Announcement {
    /// Nothing is to be told.
    Detached,
    Runs,
    /// A search through the past goes on.
    Searches,
    Stopped,
    Ended,
}

/// Why an order is not carried out.
#[derive(Clone, Debug, PartialEq)]
pub enum Refused {
    /// The text is none.
    Order(NoOrder),
    /// No debugger is attached.
    NotAttached,
    /// The program runs, or has ended.
    NotStopped,
    /// The program has ended.
    Ended,
    /// The breakpoint cannot be.
    Breakpoint(NoBreakpoint),
    /// There is no breakpoint with this number, or none at all.
    NoBreakpoint(Option<u32>),
    /// No thread lives.
    NoThread,
    /// There is no thread with this name; those that there are.
    NoSuchThread(Box<str>, Vec<Box<str>>),
    /// This thread is not held.
    NotHeld(Box<str>),
    /// This thread is held, and makes no step.
    Held(Box<str>),
    /// All threads are held, and none would go on.
    AllHeld,
    /// There is no way back.
    Back(NoBack),
    /// Nothing can be changed.
    NotNow(NotNow),
    /// The expression is wrong.
    Expression(Vec<Problem>),
}

impl Refused {
    /// For a person.
    pub fn in_locale(&self, locale: Locale) -> String {
        let words = match self {
            Self::Order(why) => why.words(),
            Self::Breakpoint(why) => return why.in_locale(locale),
            Self::Back(why) => return why.in_locale(locale),
            Self::NotNow(why) => return why.in_locale(locale),
            Self::Expression(problems) => return report::problems(problems, locale),
            Self::NotAttached => words::not_attached(),
            Self::NotStopped => words::not_stopped(),
            Self::Ended => words::ended(),
            Self::NoBreakpoint(number) => words::no_breakpoint(*number),
            Self::NoThread => words::no_thread(),
            Self::NoSuchThread(name, there) => words::no_such_thread(name, there),
            Self::NotHeld(name) => words::not_held(name),
            Self::Held(name) => words::held(name),
            Self::AllHeld => words::all_held(),
        };
        words.in_locale(locale).to_owned()
    }
}

impl Desk {
    /// For a program to which no debugger is attached yet.
    pub fn new(session: Session, locale: Locale, history_bytes: usize) -> Self {
        Self {
            session,
            locale,
            history_bytes,
            motors_rest: true,
            told: Announcement::Detached,
        }
    }

    /// Speaks this language from now on; the one before.
    pub fn speak(&mut self, locale: Locale) -> Locale {
        std::mem::replace(&mut self.locale, locale)
    }

    /// The program.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// The program as it is, also while a client looks at its past.
    pub fn live(&self) -> &Machine {
        self.session.live()
    }

    /// Whether motors have to rest now.
    pub fn is_at_rest(&self) -> bool {
        self.motors_rest && self.is_stopped()
    }

    /// Whether it is stopped at this moment of the present.
    pub fn is_stopped(&self) -> bool {
        matches!(self.session.phase(), Phase::Stopped(_))
    }

    /// Runs what is due at a moment of the caller's clock, in milliseconds; a program that is stopped goes on with a search
    /// through its past.
    pub fn step(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Phase {
        self.session.search_on();
        self.session.step(now, brick, trace)
    }

    /// Something else has changed the program: its state is told again.
    pub fn tell_again(&mut self) {
        if self.session.is_attached() {
            self.told = Announcement::Detached;
        }
    }

    /// Carries out an order; the answer is a JSON object that begins with the tag of the order.
    pub fn order(
        &mut self,
        (tag, text): (u32, &str),
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> String {
        let parsed = Order::parse(text).map_err(Refused::Order);
        let done = parsed.and_then(|order| self.carry_out(&order, now, brick, trace));
        let (is_done, told) = match done {
            Ok(more) => (true, more),
            Err(why) => (false, object().text("why", &why.in_locale(self.locale))),
        };
        told.plain("to", tag).plain("done", is_done).done()
    }

    /// The lines that breakpoints have written since the last time, as a JSON object.
    pub fn log(&mut self) -> Option<String> {
        report::log(self.session.debugger().take_lines())
    }

    /// What has happened since the last time, for everybody who looks on, each as a JSON object.
    pub fn news(&mut self) -> Vec<String> {
        let mut news: Vec<_> = self.log().into_iter().collect();
        let now = match self.session.phase() {
            _ if !self.session.is_attached() => Announcement::Detached,
            _ if self.session.is_searching() => Announcement::Searches,
            Phase::Runs => Announcement::Runs,
            Phase::Stopped(_) => Announcement::Stopped,
            Phase::Ended { .. } => Announcement::Ended,
        };
        if now != self.told {
            self.told = now;
            news.push(report::state(&self.session, self.locale));
        }
        news
    }

    fn carry_out(
        &mut self,
        order: &Order,
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<Object, Refused> {
        self.admit(order)?;
        let session = &mut self.session;
        match order {
            Order::Attach => self.attach(),
            Order::Detach => {
                self.motors_rest = true;
                session.detach(now, brick, trace);
            }
            Order::Look => {}
            Order::Pause => self.pause(),
            Order::Continue => self.go_on(now, brick, trace)?,
            Order::Step(step, thread) => {
                self.walk((thread.as_deref(), *step), now, brick, trace)?;
            }
            Order::Until(block) => self.until(block, now, brick, trace)?,
            Order::Back(how) => {
                session.begin_back(*how).map_err(Refused::Back)?;
                self.search();
            }
            Order::Present => session.to_present(),
            Order::Hold(name) => self.hold(name)?,
            Order::Release(name) => self.release(name)?,
            Order::Break(point) => {
                let number = session.add(point.clone()).map_err(Refused::Breakpoint)?;
                return Ok(object().plain("number", number));
            }
            Order::Clear(number) => {
                return found(session.debugger().clear(*number), *number);
            }
            Order::Enable(number, is_enabled) => {
                let is_found = session.debugger().enable(*number, *is_enabled);
                return found(is_found, Some(*number));
            }
            Order::Breakpoints(after) => {
                return Ok(report::breakpoints(&session.debugger().points, *after));
            }
            Order::Errors(stop) => {
                session.debugger().stops_at_errors = *stop;
                return Ok(object());
            }
            Order::Motors(rest) => {
                self.motors_rest = *rest;
                return Ok(object());
            }
            Order::Set(name, text) => {
                let assigned = session.assign(name, text, brick, trace);
                assigned.map_err(Refused::NotNow)?;
                let value = session.machine().variable(name).unwrap_or_default();
                return Ok(report::value(&value));
            }
            Order::Evaluate(text) => {
                let found = session.machine().evaluate_aside(text);
                let found = found.map_err(Refused::Expression)?;
                return Ok(report::value(&found));
            }
        }
        Ok(self.state())
    }

    /// Whether an order can be carried out now; one that moves the program ends a search.
    fn admit(&mut self, order: &Order) -> Result<(), Refused> {
        if order.is_for_debugger() && !self.session.is_attached() {
            return Err(Refused::NotAttached);
        }
        if order.is_for_control() && self.session.give_up_search() {
            self.told = Announcement::Searches;
        }
        Ok(())
    }

    fn attach(&mut self) {
        if !self.session.is_attached() {
            self.session.attach();
            self.session.keep(self.history_bytes);
        }
    }

    fn pause(&mut self) {
        // One that is stopped would stop again as soon as it goes on.
        if !self.is_stopped() {
            self.session.debugger().pause();
        }
    }

    fn walk(
        &mut self,
        (thread, step): (Option<&str>, Step),
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), Refused> {
        let number = self.thread(thread)?;
        if self.session.is_past() {
            self.session.begin_forth(Some(step));
            self.search();
        } else {
            self.session.walk((number, step), now, brick, trace);
            self.told = Announcement::Runs;
        }
        Ok(())
    }

    fn until(
        &mut self,
        block: &str,
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), Refused> {
        if self.session.is_past() {
            return Err(Refused::NotNow(NotNow::Past));
        }
        if let Phase::Ended { .. } = self.session.phase() {
            return Err(Refused::Ended);
        }
        let point = Breakpoint {
            is_once: true,
            ..Breakpoint::before(block)
        };
        self.session.add(point).map_err(Refused::Breakpoint)?;
        if self.is_stopped() {
            self.go_on(now, brick, trace)?;
        }
        Ok(())
    }

    fn go_on(
        &mut self,
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), Refused> {
        if self.session.is_past() {
            self.session.begin_forth(None);
            self.search();
            return Ok(());
        }
        match self.session.phase() {
            Phase::Stopped(_) if self.are_all_held() => Err(Refused::AllHeld),
            Phase::Stopped(_) => {
                self.session.go_on(now, brick, trace);
                // A stop at the next block is another stop, which is told again.
                self.told = Announcement::Runs;
                Ok(())
            }
            Phase::Runs => Err(Refused::NotStopped),
            Phase::Ended { .. } => Err(Refused::Ended),
        }
    }

    /// Whether every thread that lives is to be held.
    fn are_all_held(&self) -> bool {
        let held: BTreeSet<&str> = self.session.held().collect();
        let mut there = self.session.machine().views();
        !held.is_empty() && there.all(|view| held.contains(view.name))
    }

    /// The thread that makes a step: the one with this name, or the one at which the program is stopped.
    fn thread(&self, name: Option<&str>) -> Result<u16, Refused> {
        let Some(stop) = self.session.stop() else {
            return Err(match self.session.phase() {
                Phase::Ended { .. } => Refused::Ended,
                Phase::Runs | Phase::Stopped(_) => Refused::NotStopped,
            });
        };
        let machine = self.session.machine();
        let found = match name {
            Some(name) => machine.views().find(|view| view.name == name),
            None => machine
                .views()
                .find(|view| stop.thread.is_none_or(|thread| thread == view.number)),
        };
        if let Some(view) = found.as_ref().filter(|view| view.doing == Doing::Held) {
            return Err(Refused::Held(view.name.into()));
        }
        match (found.map(|view| view.number), name) {
            (Some(number), _) => Ok(number),
            (None, None) => Err(Refused::NoThread),
            (None, Some(name)) => {
                let there: BTreeSet<&str> = machine.views().map(|view| view.name).collect();
                Err(no_such_thread(name, &there))
            }
        }
    }

    /// Holds a thread that lives, or that the program may begin.
    fn hold(&mut self, name: &str) -> Result<(), Refused> {
        if let Phase::Ended { .. } = self.session.phase() {
            return Err(Refused::Ended);
        }
        let machine = self.session.live();
        let mut there: BTreeSet<&str> = machine.program().thread_names().collect();
        there.extend(machine.views().map(|view| view.name));
        if !there.contains(name) {
            return Err(no_such_thread(name, &there));
        }
        self.session.hold(name).map_err(Refused::Breakpoint)?;
        // Others look on.
        self.tell_again();
        Ok(())
    }

    fn release(&mut self, name: &str) -> Result<(), Refused> {
        if !self.session.release(name) {
            return Err(Refused::NotHeld(name.into()));
        }
        self.tell_again();
        Ok(())
    }

    /// A search has begun. A short one is done at once; of a longer one the answer says that it goes on, and its end is told
    /// like a stop.
    fn search(&mut self) {
        if self.session.search_on() {
            self.told = Announcement::Searches;
        }
    }

    fn state(&self) -> Object {
        object().plain("program", report::state(&self.session, self.locale))
    }
}

/// What is told of a breakpoint that was looked for.
fn found(is_found: bool, number: Option<u32>) -> Result<Object, Refused> {
    match is_found {
        true => Ok(object()),
        false => Err(Refused::NoBreakpoint(number)),
    }
}

fn no_such_thread(name: &str, there: &BTreeSet<&str>) -> Refused {
    let there = there.iter().take(limits::NAMES_LISTED_MAX);
    Refused::NoSuchThread(name.into(), there.map(|name| (*name).into()).collect())
}

fn object() -> Object {
    Object::new(limits::TOLD_CHARACTERS_MAX)
}
