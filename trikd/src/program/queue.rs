//! Requests to the part that runs programs, in the order in which they came, and what the status shows of programs.
//!
//! Owns the queue and its limit. Knows no processes.

use crate::clients::debugging::OrderId;
use crate::limits;
use crate::protocol::news;
use crate::protocol::program::WhenGone;
use lang_text::problem::Locale;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::fmt::Write;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Instant;
use tokio::sync::{Notify, oneshot};

/// The language in which somebody wants to hear of what is asked for; none: that of the robot.
pub type Heard = Option<Locale>;

/// What can be asked for.
#[derive(Debug)]
pub enum Command {
    /// End what runs and run this file.
    Run(PathBuf, Heard),
    /// End what runs and run this text in JavaScript.
    Script(String),
    /// Evaluate this text after the ones before it.
    Direct(String),
    /// Replace the diagram that runs by this file, for the client of this number.
    Patch(u32, WhenGone, PathBuf, Heard),
    /// Assign a variable of the diagram that runs, `NAME=EXPRESSION`, for the client of this number.
    Set(u32, String, Heard),
    /// What a person says to the question with this number; none: nobody answers.
    Reply(u32, Option<String>),
    /// Something that a client wants who debugs; each has an answer.
    Debug(OrderId, Wish),
    /// The client in control of the debugger is gone.
    DebugLeft,
    /// End what runs and bring everything to rest; says for whom.
    Stop(&'static str),
    /// A message of the mailbox for the program: hull number and text.
    Mail(i32, String),
    /// The variables that the program shows, as a JSON object.
    Web(oneshot::Sender<String>),
    /// Tell what runs and how the last one ended, when everything before this is done.
    Ask(oneshot::Sender<String>),
    /// End what runs, then tell.
    Quit(oneshot::Sender<()>),
}

/// Where a program in Python meets its debugger.
#[derive(Debug)]
pub struct Meeting {
    /// Who listens there.
    pub address: SocketAddr,
    /// What the program says first, so that nobody else is taken for it.
    pub secret: Option<String>,
}

/// What somebody wants who debugs.
#[derive(Debug)]
pub enum Wish {
    /// End what runs and run this diagram, stopped before its first block.
    Run(PathBuf),
    /// End what runs and run this Python program under debugpy, which connects to this place.
    Debugpy(Meeting, PathBuf),
    /// Do this with the debugger of the diagram that runs.
    Order(String),
    /// It was to run a program, and somebody has stopped everything meanwhile.
    Overtaken,
    /// Nothing more: it is answered when everything is done that was asked for before.
    Left,
}

/// What the status shows of the program.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown {
    pub(super) text: Option<(String, Instant)>,
    /// Where a debugger has stopped it, if the program says so by itself.
    pub(super) place: Option<String>,
    pub(super) started: u32,
    pub(super) failed: u32,
    pub(super) last_end: String,
    /// Microseconds from each order to the motors' rest, the newest last.
    pub(super) rests_us: VecDeque<u128>,
}

impl Shown {
    /// How long the last rests took.
    fn rests(&self) -> String {
        let mut sorted: Vec<_> = self.rests_us.iter().collect();
        sorted.sort_unstable();
        let (Some(last), count) = (sorted.len().checked_sub(1), sorted.len()) else {
            return String::new();
        };
        let part = |thousandths: usize| sorted[last * thousandths / 1000];
        format!(
            "rest of the last {count} ends: median {} us, p99 {} us, most {} us\n",
            part(500),
            part(990),
            sorted[last]
        )
    }
}

/// The way to the one who runs programs.
#[derive(Debug, Default)]
pub struct Programs {
    queue: RefCell<VecDeque<Command>>,
    filled: Notify,
    drained: Notify,
    pub(super) shown: RefCell<Shown>,
}

impl Programs {
    /// Asks for something; waits while too much is asked for already. A stop makes everything before it pointless.
    pub async fn send(&self, command: Command) {
        if matches!(command, Command::Stop(_) | Command::Quit(_)) {
            self.queue.borrow_mut().retain_mut(outlives_stop);
        } else {
            while self.queue.borrow().len() >= limits::COMMANDS {
                self.drained.notified().await;
            }
        }
        self.queue.borrow_mut().push_back(command);
        self.filled.notify_one();
    }

    /// As [`Programs::send`] for what may be lost when too much is asked for.
    pub fn try_send(&self, command: Command) {
        let mut queue = self.queue.borrow_mut();
        if queue.len() < limits::COMMANDS {
            queue.push_back(command);
            self.filled.notify_one();
        }
    }

    /// The next command; waits for one.
    pub(super) async fn next(&self) -> Command {
        loop {
            if let Some(command) = self.queue.borrow_mut().pop_front() {
                self.drained.notify_one();
                return command;
            }
            self.filled.notified().await;
        }
    }

    /// Whether a program runs.
    pub fn runs(&self) -> bool {
        self.shown.borrow().text.is_some()
    }

    /// Lines for the status.
    pub fn describe(&self) -> String {
        let shown = self.shown.borrow();
        let mut text = match &shown.text {
            Some((text, since)) => {
                news::running(&format!("{text} for {} s", since.elapsed().as_secs()))
            }
            None => news::running(news::NONE),
        };
        if let Some(place) = &shown.place {
            let _ = writeln!(text, "stopped at {place}");
        }
        let _ = writeln!(
            text,
            "programs {} started, {} failed",
            shown.started, shown.failed
        );
        if !shown.last_end.is_empty() {
            text.push_str(&news::last(&shown.last_end));
        }
        text.push_str(&shown.rests());
        text
    }
}

/// Whether what was asked for before a stop is still to be done: what has an answer.
fn outlives_stop(command: &mut Command) -> bool {
    match command {
        Command::Debug(_, wish) => {
            if matches!(wish, Wish::Run(_) | Wish::Debugpy(..)) {
                *wish = Wish::Overtaken;
            }
            true
        }
        Command::Quit(_) | Command::Ask(_) => true,
        Command::Run(..)
        | Command::Script(_)
        | Command::Direct(_)
        | Command::Patch(..)
        | Command::Set(..)
        | Command::Reply(..)
        | Command::DebugLeft
        | Command::Stop(_)
        | Command::Mail(..)
        | Command::Web(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waiting(programs: &Programs) -> Vec<String> {
        programs
            .queue
            .borrow()
            .iter()
            .map(|command| format!("{command:?}"))
            .collect()
    }

    #[test]
    fn a_stop_makes_everything_before_it_pointless_and_nothing_behind_it() {
        let programs = Programs::default();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        runtime.block_on(async {
            programs.send(Command::Run("a".into(), None)).await;
            programs.send(Command::Direct("b".to_owned())).await;
            let asked = OrderId {
                client: 1,
                tag: 2,
                locale: None,
            };
            let debug = Command::Debug(asked, Wish::Run("d".into()));
            programs.send(debug).await;
            programs.send(Command::Stop("somebody")).await;
            programs.send(Command::Script("c".to_owned())).await;
        });
        assert_eq!(
            waiting(&programs),
            [
                "Debug(OrderId { client: 1, tag: 2, locale: None }, Overtaken)",
                "Stop(\"somebody\")",
                "Script(\"c\")"
            ]
        );
    }

    #[test]
    fn what_may_be_lost_is_lost_when_too_much_waits() {
        let programs = Programs::default();
        (0..2 * limits::COMMANDS).for_each(|_| programs.try_send(Command::Mail(1, String::new())));
        assert_eq!(waiting(&programs).len(), limits::COMMANDS);
    }
}
