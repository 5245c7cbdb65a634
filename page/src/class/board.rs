//! The cards of all robots: what is known of each, and what it shall do.
//!
//! Owns them, and who is told of a change. Only the newest of a card is ever shown, so a viewer that is slow misses what lay
//! between and delays nobody.

use super::member::{Member, OwnPage};
use super::words::Why;
use crate::limits;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::{Notify, mpsc, watch};
use tokio::task::AbortHandle;
use tokio::time::Instant;

/// Whether a robot is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Nobody has looked yet.
    Unknown,
    /// It takes programs there.
    There(SocketAddr),
    /// It is not; the next attempt follows.
    Absent(Why),
}

/// What the battery of a robot had.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Battery {
    /// The value with its unit, as the robot has it.
    pub text: String,
    /// When that was.
    pub at: Instant,
}

/// Who commands a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Commander {
    /// This program.
    Own,
    /// A client at this address.
    Other(String),
}

/// What became of the last stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stop {
    /// It was ordered, and the robot has not answered. One that is not reached is told as soon as it is.
    Asked(Instant),
    /// Everything rests; so long after the order that was known.
    Rests(u64),
    /// The robot says that something does not rest.
    Failed(String),
    /// It was not reached in time.
    Missed,
}

/// How far a file is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// So many bytes are on their way.
    Sending(usize),
    /// The robot has it.
    Sent,
    /// It shall run, and the robot has not answered.
    Starts,
    /// It has started.
    Runs,
    /// It is not there, or does not run.
    Failed(Why),
}

/// A file that was sent to a robot, or a program that was started there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sending {
    /// Its name.
    pub name: String,
    /// Its size; 0: it was there already.
    pub bytes: usize,
    /// It shall run.
    pub runs: bool,
    /// How far it is.
    pub stage: Stage,
}

/// What is known of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Card {
    pub reach: Reach,
    pub page: Option<OwnPage>,
    /// The program that runs.
    pub runs: Option<String>,
    /// How the last one ended, in the robot's words.
    pub last: Option<String>,
    /// What it has told of as an error since its last start.
    pub error: Option<String>,
    /// Stays with its age when the robot is gone.
    pub battery: Option<Battery>,
    /// The client that has started or stopped a program last, if it is still connected.
    pub commander: Option<Commander>,
    /// Who controls its debugger.
    pub debugger: Option<String>,
    pub stop: Option<Stop>,
    pub sending: Option<Sending>,
}

/// What a robot shall be told.
pub struct Commands {
    /// Everything to rest: overtakes all else.
    pub stop: Notify,
    /// Programs to be started.
    pub runs: mpsc::Sender<String>,
    /// Who starts them, until the robot's task takes it.
    waiting: Mutex<Option<mpsc::Receiver<String>>>,
    /// A file that is on its way.
    upload: Mutex<Option<AbortHandle>>,
}

/// What viewers are told once.
pub struct Title {
    pub name: String,
    pub group: String,
    pub at: String,
}

/// All cards.
pub struct Board {
    pub titles: Vec<Title>,
    commands: Vec<Commands>,
    /// Each with the number of its last change.
    cards: Mutex<Vec<(u64, Card)>>,
    /// The number of the last change of all.
    changes: watch::Sender<u64>,
}

/// Nothing that holds one of these locks can fail halfway.
fn held<T>(lock: &Mutex<T>) -> MutexGuard<'_, T> {
    lock.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Board {
    /// For these robots; nothing is known of them.
    pub fn new(robots: &[Member]) -> Self {
        let title = |member: &Member| Title {
            name: member.name.clone(),
            group: member.group.clone(),
            at: member.at.clone(),
        };
        let commands = |_: &Member| {
            let (runs, waiting) = mpsc::channel(limits::CLASS_RUNS);
            Commands {
                stop: Notify::new(),
                runs,
                waiting: Mutex::new(Some(waiting)),
                upload: Mutex::new(None),
            }
        };
        let card = Card {
            reach: Reach::Unknown,
            page: None,
            runs: None,
            last: None,
            error: None,
            battery: None,
            commander: None,
            debugger: None,
            stop: None,
            sending: None,
        };
        Self {
            titles: robots.iter().map(title).collect(),
            commands: robots.iter().map(commands).collect(),
            cards: Mutex::new(vec![(0, card); robots.len()]),
            changes: watch::Sender::new(0),
        }
    }

    /// What a robot shall be told.
    pub fn commands(&self, id: usize) -> Option<&Commands> {
        self.commands.get(id)
    }

    /// The programs that shall be started, for the task that has the connection.
    pub fn take_runs(&self, id: usize) -> Option<mpsc::Receiver<String>> {
        held(&self.commands.get(id)?.waiting).take()
    }

    /// Hears of every change.
    pub fn watch(&self) -> watch::Receiver<u64> {
        self.changes.subscribe()
    }

    /// The cards that have changed since this change, with their numbers.
    pub fn since(&self, change: u64) -> Vec<(usize, Card)> {
        let cards = held(&self.cards);
        let changed = cards.iter().enumerate().filter(|(_, (at, _))| *at > change);
        changed.map(|(id, (_, card))| (id, card.clone())).collect()
    }

    /// Looks at a card.
    pub fn with<T>(&self, id: usize, look: impl FnOnce(&Card) -> T) -> Option<T> {
        held(&self.cards).get(id).map(|(_, card)| look(card))
    }

    /// Changes a card; viewers are told if that has made a difference.
    pub fn change(&self, id: usize, change: impl FnOnce(&mut Card)) {
        let mut cards = held(&self.cards);
        let Some((at, card)) = cards.get_mut(id) else {
            return;
        };
        let before = card.clone();
        change(card);
        if *card != before {
            self.changes.send_modify(|number| {
                *number += 1;
                *at = *number;
            });
        }
    }

    /// Changes what is known of the file that was sent last, if it has this name.
    pub fn stage(&self, id: usize, name: &str, stage: Stage) {
        self.change(id, |card| {
            if let Some(sending) = card.sending.as_mut().filter(|one| one.name == name) {
                sending.stage = stage;
            }
        });
    }

    /// Orders everything to rest. A file that is on its way to be run does not arrive; one that is only sent does.
    pub fn stop(&self, id: usize) {
        let Some(told) = self.commands.get(id) else {
            return;
        };
        let is_to_run = |card: &Card| card.sending.as_ref().is_some_and(|one| one.runs);
        if self.with(id, is_to_run) == Some(true)
            && let Some(upload) = held(&told.upload).take()
        {
            upload.abort();
        }
        self.change(id, |card| {
            card.stop = Some(Stop::Asked(Instant::now()));
            if let Some(sending) = &mut card.sending
                && sending.runs
                && matches!(sending.stage, Stage::Sending(_) | Stage::Starts)
            {
                sending.stage = Stage::Failed(Why::Stopped);
            }
        });
        told.stop.notify_one();
    }

    /// When the order to stop was given that the robot is still to be told; None: there is none.
    pub fn wanted_stop(&self, id: usize) -> Option<Instant> {
        let asked = |card: &Card| match card.stop {
            Some(Stop::Asked(since)) => Some(since),
            Some(Stop::Rests(_) | Stop::Failed(_) | Stop::Missed) | None => None,
        };
        let since = self.with(id, asked).flatten()?;
        if since.elapsed() <= limits::CLASS_STOP_TIME {
            return Some(since);
        }
        // Somebody else may have begun something since.
        self.change(id, |card| card.stop = Some(Stop::Missed));
        None
    }

    /// A file is on its way; one that was before it does not arrive.
    pub fn begin(
        &self,
        id: usize,
        (name, bytes): (&str, usize),
        runs: bool,
        upload: Option<AbortHandle>,
    ) {
        let Some(told) = self.commands.get(id) else {
            return;
        };
        if let Some(former) = std::mem::replace(&mut *held(&told.upload), upload) {
            former.abort();
        }
        self.change(id, |card| {
            card.sending = Some(Sending {
                name: name.to_owned(),
                bytes,
                runs,
                stage: match bytes {
                    0 => Stage::Starts,
                    _ => Stage::Sending(0),
                },
            });
        });
    }

    /// Whether a file of this name is on its way.
    pub fn is_sending(&self, id: usize, name: &str) -> bool {
        let is_it = |card: &Card| {
            let sending = card.sending.as_ref().filter(|one| one.name == name);
            sending.is_some_and(|one| matches!(one.stage, Stage::Sending(_)))
        };
        self.with(id, is_it) == Some(true)
    }

    /// Nothing can be sent to a robot that is not reached.
    pub fn away(&self, id: usize, name: &str) {
        self.stage(id, name, Stage::Failed(Why::Away));
    }

    /// Starts a program that is there.
    pub fn run(&self, id: usize, name: &str) {
        let is_there = self.with(id, |card| matches!(card.reach, Reach::There(_)));
        let sent = self
            .commands
            .get(id)
            .filter(|_| is_there == Some(true))
            .is_some_and(|told| told.runs.try_send(name.to_owned()).is_ok());
        let stage = match sent {
            true => Stage::Starts,
            false => Stage::Failed(Why::Away),
        };
        self.stage(id, name, stage);
    }
}
