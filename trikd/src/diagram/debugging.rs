//! A running diagram with its debugger: orders of clients, what all who debug are told, and motors at a stop.
//!
//! Owns when something is told: a stop at once, lines of breakpoints at most every [`limits::WATCH_MS`]. What orders do is
//! known in `lang_diagram::debug` alone. While no debugger is attached, the program runs as if there were none.

use super::motors::{Driven, Motors};
use super::robot::Robot;
use super::watch::Watch;
use crate::host::Host;
use crate::limits;
use crate::protocol::program::ALL;
use lang_diagram::debug::desk::Desk;
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Phase, Session};
use lang_diagram::machine::Machine;
use lang_text::problem::Locale;
use std::io;

/// A diagram that runs.
#[derive(Debug)]
pub(super) struct Debugging {
    desk: Desk,
    motors: Motors,
    was_stopped: bool,
    told_at: u32,
}

/// An order, and what its client calls it.
type Tagged<'a> = (u32, &'a str);

impl Debugging {
    pub(super) fn new(machine: Machine, locale: Locale) -> Self {
        let session = Session::alone(machine);
        Self {
            desk: Desk::new(session, locale, limits::DEBUG_HISTORY_BYTES),
            motors: Motors::default(),
            was_stopped: false,
            told_at: 0,
        }
    }

    /// The program is to stop before its first block.
    pub(super) fn stop_first(&mut self, robot: &mut Robot<'_>, watch: &mut Watch) {
        for order in [Order::Attach, Order::Pause] {
            self.order((0, &order.to_string()), 0, robot, watch);
        }
    }

    /// Runs what is due; false: the program has ended.
    pub(super) fn step(&mut self, now: u32, robot: &mut Robot<'_>, watch: &mut Watch) -> bool {
        let phase = self.desk.step(now, &mut self.motors.over(robot), watch);
        self.settle(robot);
        !matches!(phase, Phase::Ended { .. })
    }

    /// Carries out an order; the answer is a JSON object.
    pub(super) fn order(
        &mut self,
        order: Tagged<'_>,
        now: u32,
        robot: &mut Robot<'_>,
        watch: &mut Watch,
    ) -> String {
        let answer = self
            .desk
            .order(order, now, &mut self.motors.over(robot), watch);
        self.settle(robot);
        answer
    }

    /// The same, with an answer in this language.
    pub(super) fn answer(
        &mut self,
        order: Tagged<'_>,
        locale: Locale,
        now: u32,
        (robot, watch): (&mut Robot<'_>, &mut Watch),
    ) -> String {
        let own = self.desk.speak(locale);
        let answer = self.order(order, now, robot, watch);
        self.desk.speak(own);
        answer
    }

    /// The client that was in control is gone: a program that is stopped stays so, with its motors at rest whatever was asked for;
    /// another one loses its debugger.
    pub(super) fn left(&mut self, now: u32, robot: &mut Robot<'_>, watch: &mut Watch) {
        let order = match self.desk.is_stopped() {
            true => Order::Motors(true),
            false => Order::Detach,
        };
        self.order((0, &order.to_string()), now, robot, watch);
    }

    /// Somebody has changed the program from elsewhere: who debugs hears of it.
    pub(super) fn changed(&mut self) {
        self.desk.tell_again();
    }

    fn settle(&mut self, robot: &mut Robot<'_>) {
        self.motors.settle(self.desk.is_at_rest(), robot);
    }

    /// The program, and its robot, for the code that changes it.
    pub(super) fn parts<'a>(
        &'a mut self,
        robot: &'a mut Robot<'_>,
    ) -> (&'a mut Session, Driven<'a>) {
        (self.desk.session(), self.motors.over(robot))
    }

    /// The machine that runs.
    pub(super) fn machine(&mut self) -> &Machine {
        self.desk.session().live()
    }

    /// Tells all who debug what is new, if it is time; after an order it always is.
    pub(super) fn report(&mut self, now: u32, is_time: bool, host: &Host) -> io::Result<()> {
        let is_stopped = self.desk.is_stopped();
        let is_due = now.saturating_sub(self.told_at) >= limits::WATCH_MS;
        if !is_time && !is_due && is_stopped == self.was_stopped {
            return Ok(());
        }
        self.was_stopped = is_stopped;
        self.told_at = now;
        if let Some(log) = self.desk.log() {
            host.debug_log(&log)?;
        }
        for state in self.desk.news() {
            host.debug(ALL, &state)?;
        }
        Ok(())
    }

    /// Ends the program from outside.
    pub(super) fn end(&mut self, robot: &mut Robot<'_>, watch: &mut Watch) {
        let (session, mut driven) = self.parts(robot);
        session.end(&mut driven, watch);
    }
}
