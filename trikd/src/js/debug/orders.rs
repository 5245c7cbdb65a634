//! Orders of clients to the debugger of a program in JavaScript, their answers, and what all who debug hear.
//!
//! Owns the form of both, which is that of diagrams as far as there is one. What cannot be done is refused in words.

use super::motors::Resting;
use super::{Debugger, Seen, Stop, words};
use crate::brick::Brick;
use crate::limits;
use lang_diagram::debug::order::{NoOrder, Order};
use lang_text::json::Object;
use lang_text::problem::Locale;
use std::time::{Duration, Instant};

/// Why an order is not carried out.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Refused {
    /// The text is no order.
    NoOrder(NoOrder),
    /// There is no debugger.
    NotAttached,
    /// The engine gives no way to do it.
    Never,
}

impl Refused {
    /// For a person.
    fn in_locale(&self, locale: Locale) -> String {
        let words = match self {
            Self::NoOrder(why) => why.words(),
            Self::NotAttached => lang_diagram::debug::not_attached(),
            Self::Never => words::never(),
        };
        words.in_locale(locale).to_owned()
    }
}

/// The debugger's side of a program.
pub struct Orders {
    brick: Brick,
    resting: Resting,
    began: Instant,
    /// When it was stopped, until all know that everything stands still.
    stopping: Option<Instant>,
    /// A stop that was told, and what it was.
    told: Option<Stop>,
    keeps_motors: bool,
    /// A motor may still move at this stop, although it was told to rest.
    is_moving: bool,
    /// What a person is to hear of that, once at each stop.
    warning: Option<String>,
    /// The state has changed, and all are to hear of it.
    is_news: bool,
}

impl Orders {
    /// Of a program on this robot.
    pub fn new(brick: Brick) -> Self {
        Self {
            brick,
            resting: Resting::default(),
            began: Instant::now(),
            stopping: None,
            told: None,
            keeps_motors: false,
            is_moving: false,
            warning: None,
            is_news: false,
        }
    }

    /// Carries an order out, with what its client calls it; the answer, in this language.
    pub fn order(
        &mut self,
        debugger: &Debugger,
        (tag, text): (u32, &str),
        locale: Locale,
    ) -> String {
        let done = Order::parse(text).map_err(Refused::NoOrder);
        let done = done.and_then(|order| self.carry_out(debugger, &order));
        let told = object();
        let told = match &done {
            Ok(()) => told.plain("program", self.state(debugger)),
            Err(why) => told.text("why", &why.in_locale(locale)),
        };
        told.plain("to", tag).plain("done", done.is_ok()).done()
    }

    fn carry_out(&mut self, debugger: &Debugger, order: &Order) -> Result<(), Refused> {
        if order.is_for_debugger() && !debugger.is_attached() {
            return Err(Refused::NotAttached);
        }
        match order {
            Order::Look => {}
            Order::Attach => {
                debugger.attach();
                self.is_news = true;
            }
            Order::Detach => {
                self.go_on();
                debugger.detach();
                self.is_news = true;
            }
            Order::Pause => debugger.stop(Stop::Pause),
            Order::Continue => {
                self.go_on();
                debugger.go_on();
                self.is_news = true;
            }
            Order::Errors(is_wanted) => debugger.state().stops_at_errors = *is_wanted,
            Order::Motors(shall_rest) => {
                self.keeps_motors = !shall_rest;
                if self.keeps_motors {
                    self.is_moving = false;
                    self.resting.go_on(&self.brick);
                }
            }
            Order::Step(..)
            | Order::Until(_)
            | Order::Back(_)
            | Order::Present
            | Order::Hold(_)
            | Order::Release(_)
            | Order::Break(_)
            | Order::Clear(_)
            | Order::Enable(..)
            | Order::Breakpoints(_)
            | Order::Set(..)
            | Order::Evaluate(_) => return Err(Refused::Never),
        }
        self.turn(debugger);
        Ok(())
    }

    /// The client in control is gone: a program that is stopped stays so, another one loses its debugger.
    pub fn left(&mut self, debugger: &Debugger) {
        match debugger.state().stop.is_some() {
            true => self.keeps_motors = false,
            false => {
                debugger.detach();
                self.is_news = true;
            }
        }
        self.turn(debugger);
    }

    fn go_on(&mut self) {
        self.resting.go_on(&self.brick);
        (self.stopping, self.told) = (None, None);
        (self.is_moving, self.warning) = (false, None);
    }

    /// Brings motors to rest, unless somebody wants otherwise.
    fn hold(&mut self) {
        if self.keeps_motors {
            return;
        }
        let done = self.resting.hold(&self.brick);
        let was_moving = std::mem::replace(&mut self.is_moving, done.is_err());
        if let Err(moving) = done
            && !was_moving
        {
            self.warning = Some(moving.to_string());
        }
    }

    /// What a person is to hear of motors.
    pub fn warning(&mut self) -> Option<String> {
        self.warning.take()
    }

    /// Brings motors to rest while it is stopped, and finds out when everything stands still.
    fn turn(&mut self, debugger: &Debugger) {
        let stop = debugger.state().stop.clone();
        if stop.is_none() || stop == self.told {
            if stop.is_some() {
                self.hold();
            }
            return;
        }
        let since = *self.stopping.get_or_insert_with(Instant::now);
        self.hold();
        let is_late = since.elapsed() >= Duration::from_millis(limits::JS_STILL_MS);
        if debugger.is_still() || is_late {
            self.told = stop;
            self.stopping = None;
            self.is_news = true;
        }
    }

    /// What all who debug are to hear, if something is new; and after how long to ask again, if that is soon.
    pub fn news(&mut self, debugger: &Debugger) -> (Option<String>, Option<Duration>) {
        self.turn(debugger);
        let is_stopped = debugger.state().stop.is_some();
        let is_unsettled = is_stopped && (self.is_moving || !debugger.is_still());
        let soon = is_unsettled.then(|| Duration::from_millis(limits::JS_LOOK_MS));
        let told = std::mem::take(&mut self.is_news).then(|| self.state(debugger));
        (told, soon)
    }

    /// Where the program is.
    fn state(&self, debugger: &Debugger) -> String {
        let state = debugger.state();
        let word = match &self.told {
            Some(_) => "stopped",
            None => "running",
        };
        let told = object()
            .text("state", word)
            .plain("ms", self.began.elapsed().as_millis())
            .plain("attached", debugger.is_attached())
            .text("language", "JavaScript");
        let told = match &self.told {
            None => told,
            Some(Stop::Pause) => told.plain("stop", object().text("reason", "pause").done()),
            Some(Stop::Error { thread, text }) => {
                let stop = object().text("reason", "error").text("text", text);
                told.plain("stop", stop.plain("thread", thread).done())
            }
        };
        let threads = state.threads.iter();
        told.list(
            "threads",
            threads.map(|(number, seen)| thread(*number, seen)),
        )
        .done()
    }
}

fn thread(number: u32, seen: &Seen) -> String {
    let frames = seen.frames.iter().map(|frame| {
        object()
            .text("function", &frame.function)
            .text("file", &frame.file)
            .plain("line", frame.line)
            .plain("column", frame.column)
            .done()
    });
    object()
        .plain("number", number)
        .text("name", &seen.name)
        .text("does", seen.does.word())
        .list("frames", frames)
        .done()
}

fn object() -> Object {
    Object::new(limits::DEBUG_CHARACTERS_MAX)
}

#[cfg(test)]
mod tests {
    use super::super::Who;
    use super::super::motors::tests::Robot;
    use super::*;

    #[test]
    fn a_motor_that_does_not_rest_is_told_again_until_it_does() {
        let robot = Robot::new();
        let mut orders = Orders::new(Brick::answered(robot.clone()));
        let debugger = Debugger::default();
        let who = Who {
            number: 1,
            name: "main",
        };
        debugger.enter(who);
        debugger.waits(who, true);
        debugger.begin();
        robot.fails.set(true);
        for is_first in [true, false] {
            let (_, soon) = orders.news(&debugger);
            assert_eq!(soon, Some(Duration::from_millis(limits::JS_LOOK_MS)));
            assert_eq!(orders.warning().is_some(), is_first, "told once");
        }
        // If motors are to be kept, those that turn are not reported.
        orders.order(&debugger, (1, "motors keep"), Locale::English);
        assert_eq!(orders.news(&debugger).1, None);
        orders.order(&debugger, (2, "motors rest"), Locale::English);
        assert!(orders.news(&debugger).1.is_some());
        robot.fails.set(false);
        assert_eq!(orders.news(&debugger).1, None);
        assert_eq!(robot.value("motors/M3/value"), "0");
        orders.order(&debugger, (3, "continue"), Locale::English);
        assert_eq!(robot.value("motors/M3/value"), "40");
    }
}
