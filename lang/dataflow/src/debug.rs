//! A debugger's desk for programs of data flow: orders come in as texts, what they do goes out as JSON.
//!
//! Owns what each order does to a program of this language and to a look at its past, and what is told: variables, the
//! last token of each port, blocks that have reacted, and tokens that wait. The words of orders and the form of answers are
//! those of `lang_diagram::debug` and `docs/protocol.md`. The owner of the desk gives it the robot and the clock, carries
//! the texts, and decides what motors do at a stop. Knows no transport, no clients and no files.

mod report;
#[cfg(test)]
mod tests;
mod words;

use crate::limits;
use crate::machine::Machine;
use crate::machine::patch::{Patched, Refused as NoVersion, Version};
use crate::machine::stops::Step;
use crate::machine::trace::Trace;
use crate::program::{NodeId, Target};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::debug::answers::Noting;
use lang_diagram::debug::desk::Refused as Common;
use lang_diagram::debug::hindsight::{Hindsight, Present};
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{
    Back, Breakpoint, NoBack, NoBreakpoint, NotNow, Step as Walk, report as shared,
};
use lang_diagram::machine::Status;
use lang_expr::Value;
use lang_text::json::Object;
use lang_text::problem::{Locale, Problem, Words};
use std::collections::BTreeMap;

/// A program with its debugger, for people elsewhere.
#[derive(Clone, Debug)]
pub struct Desk {
    machine: Machine,
    hindsight: Hindsight<Machine>,
    /// How much memory the past may take.
    history_bytes: usize,
    locale: Locale,
    tap: Tap,
    is_attached: bool,
    /// Whether motors rest while the program is stopped.
    motors_rest: bool,
    told: Announcement,
}

/// The last token of each port, and the reactions of each block, while somebody looks.
#[derive(Clone, Debug, Default)]
struct Tap {
    /// Until when it listens, in milliseconds of the program.
    until: Option<u32>,
    ports: BTreeMap<(NodeId, u8), Seen>,
    /// How often each block has reacted.
    reactions: BTreeMap<NodeId, u32>,
}

/// What a port gave.
#[derive(Clone, Debug)]
struct Seen {
    /// The last token; of a long one what of it is told.
    last: Value,
    /// The word of its type.
    kind: &'static str,
    /// How many there were.
    count: u32,
}

impl Tap {
    /// Listens for a while from now on.
    fn listen(&mut self, now: u32) {
        self.until = Some(now.saturating_add(limits::TAP_MS));
    }

    /// Whether it listens; what it has heard is gone when it ends.
    fn listens(&mut self, now: u32) -> bool {
        if self.until.is_some_and(|until| now > until) {
            *self = Self::default();
        }
        self.until.is_some()
    }

    fn hear(&mut self, now: u32, at: (NodeId, u8), value: &Value) {
        if !self.listens(now) {
            return;
        }
        if self.ports.len() >= limits::TAP_PORTS_MAX && !self.ports.contains_key(&at) {
            return;
        }
        let is_long = value.cells() > limits::TAP_CELLS_MAX;
        let seen = self.ports.entry(at).or_insert(Seen {
            last: Value::Nil,
            kind: "",
            count: 0,
        });
        seen.kind = shared::kind(value);
        seen.count = seen.count.saturating_add(1);
        seen.last = match is_long {
            true => Value::text(value.brief()),
            false => value.clone(),
        };
    }

    fn see(&mut self, now: u32, node: NodeId) {
        if !self.listens(now) {
            return;
        }
        if self.reactions.len() >= limits::TAP_BLOCKS_MAX && !self.reactions.contains_key(&node) {
            return;
        }
        let count = self.reactions.entry(node).or_default();
        *count = count.saturating_add(1);
    }

    /// Forgets what it has heard: nodes have other numbers now.
    fn forget(&mut self) {
        self.ports.clear();
        self.reactions.clear();
    }
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
enum Refused {
    /// As with other diagrams.
    Common(Common),
    /// A program of this language cannot do that.
    Cannot(Words),
}

impl From<Common> for Refused {
    fn from(why: Common) -> Self {
        Self::Common(why)
    }
}

impl From<NoBreakpoint> for Refused {
    fn from(why: NoBreakpoint) -> Self {
        Common::Breakpoint(why).into()
    }
}

/// Tells the tap and somebody else.
struct Both<'a> {
    tap: &'a mut Tap,
    other: &'a mut dyn Trace,
}

impl Trace for Both<'_> {
    fn sent(&mut self, now: u32, from: NodeId, port: u8, value: &Value) {
        self.tap.hear(now, (from, port), value);
        self.other.sent(now, from, port, value);
    }

    fn fired(&mut self, now: u32, node: NodeId) {
        self.tap.see(now, node);
        self.other.fired(now, node);
    }

    fn dropped(&mut self, now: u32, at: Target) {
        self.other.dropped(now, at);
    }

    fn told(&mut self, now: u32, command: &Command<'_>) {
        self.other.told(now, command);
    }

    fn trap(&mut self, now: u32, problem: &Problem) {
        self.other.trap(now, problem);
    }
}

impl Desk {
    /// For a program to which no debugger is attached yet.
    pub fn new(machine: Machine, locale: Locale, history_bytes: usize) -> Self {
        Self {
            machine,
            hindsight: Hindsight::default(),
            history_bytes,
            locale,
            tap: Tap::default(),
            is_attached: false,
            motors_rest: true,
            told: Announcement::Detached,
        }
    }

    /// Speaks this language from now on; the one before.
    pub fn speak(&mut self, locale: Locale) -> Locale {
        std::mem::replace(&mut self.locale, locale)
    }

    /// The program as it is, also while a client looks at its past.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// Whether it is stopped.
    pub fn is_stopped(&self) -> bool {
        self.machine.stopped().is_some()
    }

    /// Whether motors have to rest now.
    pub fn is_at_rest(&self) -> bool {
        self.motors_rest && self.is_stopped()
    }

    /// When the past begins that is kept, in milliseconds of the program, and how many bytes it takes.
    pub fn kept(&self) -> Option<(u32, usize)> {
        self.hindsight.kept()
    }

    /// Attaches a debugger; the past is kept from now on.
    pub fn attach(&mut self) {
        if !self.is_attached {
            self.is_attached = true;
            self.hindsight.keep(self.history_bytes);
            self.machine.set_kept(true);
        }
    }

    /// Goes on with a search through the past; whether there is more of it.
    pub fn search_on(&mut self) -> bool {
        self.hindsight.search_on(self.machine.points())
    }

    /// The program stops before its first instant.
    pub fn stop_first(&mut self) {
        self.attach();
        self.tap.listen(0);
        self.machine.pause();
    }

    /// Runs what is due at a moment of the caller's clock, in milliseconds; a program that is stopped goes on with a search
    /// through its past.
    pub fn step(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Status {
        self.search_on();
        let machine = &mut self.machine;
        let mut both = Both {
            tap: &mut self.tap,
            other: trace,
        };
        if !self.hindsight.is_kept() || !machine.runs_next() {
            return machine.step(now, brick, &mut both);
        }
        let begins = machine.begins(now);
        let Some(notes) = self.hindsight.begin(machine, begins, machine.reached()) else {
            return machine.step(now, brick, &mut both);
        };
        let mut noting = Noting {
            robot: brick,
            notes,
        };
        let status = machine.step(now, &mut noting, &mut both);
        self.hindsight.end(machine.stopped().is_none(), []);
        status
    }

    /// Ends the program from outside.
    pub fn stop(&mut self, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        self.machine.stop(brick, trace);
    }

    /// A new version takes the place of the program.
    ///
    /// # Errors
    /// Why it does not; nothing has changed then.
    pub fn patch(
        &mut self,
        version: &Version,
        brick: &mut dyn Brick,
    ) -> Result<Patched, NoVersion> {
        let patched = self.machine.patch(version, brick)?;
        self.hindsight.to_present();
        self.hindsight.changed();
        self.tap.forget();
        self.tell_again();
        Ok(patched)
    }

    /// Gives a variable the value of an expression.
    ///
    /// # Errors
    /// What is wrong with either, or somebody looks at the past, or the program has ended.
    pub fn assign(&mut self, name: &str, text: &str) -> Result<(), NotNow> {
        if self.hindsight.is_past() {
            return Err(NotNow::Past);
        }
        if let Status::Ended { .. } = self.machine.status() {
            return Err(NotNow::Ended);
        }
        let assigned = self.machine.assign_aside(name, text);
        assigned.map_err(NotNow::Problems)?;
        self.hindsight.changed();
        self.tell_again();
        Ok(())
    }

    fn tell_again(&mut self) {
        self.told = Announcement::Detached;
    }

    /// The client in control is gone: a program that is stopped stays so, with its motors at rest; another one loses its
    /// debugger.
    pub fn left(&mut self) {
        match self.is_stopped() {
            true => self.motors_rest = true,
            false => self.detach(),
        }
    }

    /// Carries out an order; the answer is a JSON object that ends with the tag of the order.
    pub fn order(&mut self, (tag, text): (u32, &str)) -> String {
        let parsed = Order::parse(text).map_err(|why| Common::Order(why).into());
        let done = parsed.and_then(|order| self.carry_out(&order));
        let (is_done, told) = match done {
            Ok(more) => (true, more),
            Err(why) => (false, report::object().text("why", &self.explained(&why))),
        };
        told.plain("to", tag).plain("done", is_done).done()
    }

    /// The lines that breakpoints have written since the last time, as a JSON object.
    pub fn log(&mut self) -> Option<String> {
        shared::log(self.machine.points_mut().take_lines())
    }

    /// What has happened since the last time, for everybody who looks on, each as a JSON object.
    pub fn news(&mut self) -> Vec<String> {
        let mut news: Vec<_> = self.log().into_iter().collect();
        let now = match (self.is_attached, self.machine.status()) {
            (false, _) => Announcement::Detached,
            (true, _) if self.hindsight.is_searching() => Announcement::Searches,
            (true, Status::Ended { .. }) => Announcement::Ended,
            (true, Status::Running) if self.is_stopped() => Announcement::Stopped,
            (true, Status::Running) => Announcement::Runs,
        };
        if now != self.told {
            self.told = now;
            news.extend((now != Announcement::Detached).then(|| self.state()));
        }
        news
    }

    fn state(&self) -> String {
        let (machine, stop) = match self.hindsight.shown() {
            Some((machine, stop)) => (machine, Some(stop)),
            None => (&self.machine, self.machine.stopped()),
        };
        let word = match (self.machine.status(), self.hindsight.is_past()) {
            _ if self.hindsight.is_searching() => "searching",
            (_, true) => "past",
            (Status::Ended { .. }, false) => "ended",
            (Status::Running, false) if self.is_stopped() => "stopped",
            (Status::Running, false) => "running",
        };
        // What ports gave and blocks did is known of the present alone.
        let none = Tap::default();
        let told = report::State {
            word,
            is_attached: self.is_attached,
            status: self.machine.status(),
            machine,
            stop,
            tap: match self.hindsight.is_past() {
                true => &none,
                false => &self.tap,
            },
            kept: self.hindsight.kept(),
        };
        report::state(&told, self.locale)
    }

    fn explained(&self, why: &Refused) -> String {
        match why {
            Refused::Common(why) => why.in_locale(self.locale),
            Refused::Cannot(words) => words.in_locale(self.locale).to_owned(),
        }
    }

    fn carry_out(&mut self, order: &Order) -> Result<Object, Refused> {
        self.admit(order)?;
        let machine = &mut self.machine;
        match order {
            Order::Attach => self.attach(),
            Order::Detach => self.detach(),
            Order::Look => {}
            // It has ended a search, which is all.
            Order::Pause if self.told == Announcement::Searches => {}
            Order::Pause => {
                Self::must_run(machine)?;
                machine.pause();
            }
            Order::Continue => self.go_on(None, Machine::go_on)?,
            Order::Step(_, Some(_)) | Order::Hold(_) | Order::Release(_) => {
                return Err(Refused::Cannot(words::no_threads()));
            }
            Order::Step(step @ (Walk::Into | Walk::Over), None) => {
                self.go_on(Some(*step), |machine| machine.walk(Step::Reaction))?;
            }
            Order::Step(Walk::Out, None) => {
                self.go_on(Some(Walk::Out), |machine| machine.walk(Step::Instant))?;
            }
            Order::Until(block) => self.until(block)?,
            Order::Back(how) => self.back(*how)?,
            Order::Present => self.hindsight.to_present(),
            Order::Break(point) => {
                // It stops those who look for it in the past of a program that has ended.
                let number = machine.add_point(point.clone())?;
                return Ok(report::object().plain("number", number));
            }
            Order::Clear(number) => {
                let is_found = machine.points_mut().clear(*number);
                return found(is_found, *number);
            }
            Order::Enable(number, is_enabled) => {
                let is_found = machine.points_mut().enable(*number, *is_enabled);
                return found(is_found, Some(*number));
            }
            Order::Breakpoints(after) => return Ok(shared::breakpoints(machine.points(), *after)),
            Order::Errors(true) => return Err(Refused::Cannot(words::errors_end())),
            Order::Errors(false) => return Ok(report::object()),
            Order::Motors(rest) => {
                self.motors_rest = *rest;
                return Ok(report::object());
            }
            Order::Set(name, text) => {
                self.assign(name, text).map_err(Common::NotNow)?;
                let value = self.machine.value_of(name);
                return Ok(value.map_or_else(report::object, |value| shared::value(&value)));
            }
            Order::Evaluate(text) => {
                let value = match self.hindsight.shown() {
                    // Looking at the past changes nothing in it.
                    Some((machine, _)) => machine.clone().evaluate_aside(text),
                    None => machine.evaluate_aside(text),
                };
                let value = value.map_err(Common::Expression)?;
                return Ok(shared::value(&value));
            }
        }
        self.tap.listen(self.machine.now());
        Ok(report::object().plain("program", self.state()))
    }

    /// Whether an order can be carried out now; one that moves the program ends a search.
    fn admit(&mut self, order: &Order) -> Result<(), Refused> {
        if order.is_for_debugger() && !self.is_attached {
            return Err(Common::NotAttached.into());
        }
        if order.is_for_control() && self.hindsight.give_up_search() {
            self.told = Announcement::Searches;
        }
        Ok(())
    }

    /// Lets a program go on that is stopped, or a look at its past by such a step.
    fn go_on(&mut self, step: Option<Walk>, how: impl FnOnce(&mut Machine)) -> Result<(), Refused> {
        if self.hindsight.is_past() {
            let present = Self::present(&self.machine);
            self.hindsight.begin_forth(step, &present);
            self.search();
            return Ok(());
        }
        Self::must_run(&self.machine)?;
        if !self.is_stopped() {
            return Err(Common::NotStopped.into());
        }
        how(&mut self.machine);
        self.tell_again();
        Ok(())
    }

    fn until(&mut self, block: &str) -> Result<(), Refused> {
        Self::must_run(&self.machine)?;
        if self.hindsight.is_past() {
            return Err(Common::NotNow(NotNow::Past).into());
        }
        self.machine.add_point(Breakpoint {
            is_once: true,
            ..Breakpoint::before(block)
        })?;
        if self.is_stopped() {
            self.machine.go_on();
        }
        self.tell_again();
        Ok(())
    }

    fn back(&mut self, how: Back) -> Result<(), Refused> {
        if self.machine.status() == Status::Running && !self.is_stopped() {
            return Err(Common::Back(NoBack::Runs).into());
        }
        let present = Self::present(&self.machine);
        let begun = self.hindsight.begin_back(how, &present);
        begun.map_err(Common::Back)?;
        self.search();
        Ok(())
    }

    /// A search has begun. A short one is done at once; of a longer one the answer says that it goes on, and its end is told
    /// like a stop.
    fn search(&mut self) {
        if self.search_on() {
            self.told = Announcement::Searches;
        }
    }

    fn present(machine: &Machine) -> Present<'_, Machine> {
        Present {
            machine,
            at: machine.moment(),
            stop: machine.stopped(),
        }
    }

    fn must_run(machine: &Machine) -> Result<(), Refused> {
        match machine.status() {
            Status::Running => Ok(()),
            Status::Ended { .. } => Err(Common::Ended.into()),
        }
    }

    fn detach(&mut self) {
        self.is_attached = false;
        self.motors_rest = true;
        self.hindsight = Hindsight::default();
        self.machine.set_kept(false);
        self.machine.let_go();
    }
}

fn found(is_found: bool, number: Option<u32>) -> Result<Object, Refused> {
    match is_found {
        true => Ok(report::object()),
        false => Err(Common::NoBreakpoint(number).into()),
    }
}
