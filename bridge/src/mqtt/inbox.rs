//! Commands that have come and are not carried out yet.
//!
//! Owns what a command may be, and the order: a stop goes before all others and takes those that came before it away; of values
//! for one actuator the newest counts. Knows no tree.

use super::topics::Topics;
use crate::limits::{ORDER_BYTES_MAX, ORDERS_MAX};
use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Something that is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// Everything comes to rest, and the program ends.
    Stop,
    /// A program that the robot has begins.
    Run(String),
    /// An actuator gets a value: its path, and the text for `value`.
    Set(String, String),
    /// A parameter gets a value.
    Parameter(String, String),
    /// Nothing new: what drives may go on.
    Alive,
}

impl Order {
    /// The words of its topic below `cmd/`.
    pub fn words(&self) -> String {
        match self {
            Self::Stop => "stop".to_owned(),
            Self::Run(_) => "run".to_owned(),
            Self::Set(node, _) => format!("set/{node}"),
            Self::Parameter(name, _) => format!("parameter/{name}"),
            Self::Alive => "alive".to_owned(),
        }
    }

    /// Only for those whom the bridge lets drive. Anyone who sees danger may stop the robot, as by its trikd.
    fn is_privileged(&self) -> bool {
        match self {
            Self::Stop => false,
            Self::Run(_) | Self::Set(..) | Self::Parameter(..) | Self::Alive => true,
        }
    }
}

/// An order with what its answer repeats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Letter {
    /// What is asked for.
    pub order: Order,
    /// MQTT's correlation data.
    pub ticket: Option<Vec<u8>>,
    /// When it came.
    pub at: Instant,
}

/// What is next.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Next {
    /// It is to be carried out.
    Carry(Letter),
    /// It is not carried out: a stop came after it.
    Overtaken(Letter),
}

/// Why a command is not taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Untaken {
    /// There is no such command.
    Unknown,
    /// A broker would give it again to each who comes, at any time.
    Retained,
    /// It is too long.
    Long,
    /// It is no text.
    NoText,
    /// Only a stop is taken here.
    LooksOnly,
    /// Too many wait already.
    Full,
    /// A stop came after it, before it was carried out.
    Overtaken,
    /// It waited for longer than an actuator may drive without a word.
    Late,
}

impl fmt::Display for Untaken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str(
                "there is no such command: stop, run, set/NODE, parameter/NAME and alive are known",
            ),
            Self::Retained => f.write_str(
                "a retained command is not taken: it would be carried out again at each connection; publish it without retain",
            ),
            Self::Long => write!(f, "a command has at most {ORDER_BYTES_MAX} bytes"),
            Self::NoText => f.write_str("a command is text in UTF-8"),
            Self::LooksOnly => f.write_str(
                "this bridge takes no command but stop; trik bridge mqtt --control takes all",
            ),
            Self::Full => write!(f, "{ORDERS_MAX} commands wait already"),
            Self::Overtaken => f.write_str("a stop came after it"),
            Self::Late => f.write_str("the robot was busy for too long, and the value is old by now"),
        }
    }
}

impl std::error::Error for Untaken {}

/// What a command with these words, its topic below `cmd/`, asks for.
fn order(words: &str, text: &str) -> Option<Order> {
    let text = text.trim();
    match words.split_once('/') {
        None => match words {
            "stop" => Some(Order::Stop),
            "run" => Some(Order::Run(text.to_owned())),
            "alive" => Some(Order::Alive),
            _ => None,
        },
        Some(("set", node)) => Some(Order::Set(node.to_owned(), text.to_owned())),
        Some(("parameter", name)) => Some(Order::Parameter(name.to_owned(), text.to_owned())),
        Some(_) => None,
    }
}

/// What waits.
#[derive(Debug, Default)]
struct Waiting {
    stop: Option<Letter>,
    /// By actuator, so that one who sends faster than it can be done drives with the newest value.
    values: BTreeMap<String, Letter>,
    /// Actuators with a value, the one that has waited longest first.
    turns: VecDeque<String>,
    /// A stop has come, and nothing was brought to rest since.
    must_brake: bool,
    others: VecDeque<Letter>,
    /// Not to be carried out; those who sent them are told.
    overtaken: Vec<Letter>,
    is_over: bool,
}

/// Commands that wait.
#[derive(Debug)]
pub struct Inbox {
    waiting: Mutex<Waiting>,
    news: Condvar,
    may_drive: bool,
}

impl Inbox {
    /// Empty; it takes all commands, or only a stop.
    pub fn new(may_drive: bool) -> Self {
        Self {
            waiting: Mutex::default(),
            news: Condvar::new(),
            may_drive,
        }
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes what came under these words.
    ///
    /// # Errors
    /// It is no command, or none that is taken here.
    pub fn take(
        &self,
        words: &str,
        payload: &[u8],
        is_retained: bool,
        ticket: Option<Vec<u8>>,
    ) -> Result<(), Untaken> {
        if payload.len() > ORDER_BYTES_MAX {
            return Err(Untaken::Long);
        }
        let text = std::str::from_utf8(payload).map_err(|_| Untaken::NoText)?;
        let order = order(words, text).ok_or(Untaken::Unknown)?;
        if order.is_privileged() && !self.may_drive {
            return Err(Untaken::LooksOnly);
        }
        // A stop that is meant for later too is one for now.
        if is_retained && order.is_privileged() {
            return Err(Untaken::Retained);
        }
        let at = Instant::now();
        let letter = Letter { order, ticket, at };
        let mut waiting = self.waiting();
        match &letter.order {
            Order::Stop => {
                let values = std::mem::take(&mut waiting.values).into_values();
                let others = std::mem::take(&mut waiting.others);
                waiting.overtaken.extend(values.chain(others));
                // One who floods is told no more than fits.
                waiting.overtaken.truncate(ORDERS_MAX * 2);
                waiting.turns.clear();
                waiting.stop = Some(letter);
                waiting.must_brake = true;
            }
            Order::Set(node, _) => {
                let is_new = !waiting.values.contains_key(node);
                if is_new && waiting.values.len() >= ORDERS_MAX {
                    return Err(Untaken::Full);
                }
                if is_new {
                    waiting.turns.push_back(node.clone());
                }
                waiting.values.insert(node.clone(), letter);
            }
            Order::Run(_) | Order::Parameter(..) | Order::Alive => {
                if waiting.others.len() >= ORDERS_MAX {
                    return Err(Untaken::Full);
                }
                waiting.others.push_back(letter);
            }
        }
        drop(waiting);
        self.news.notify_all();
        Ok(())
    }

    /// Waits for a stop for as long; true: one has come, and everything is to be brought to rest now, whatever else is done.
    pub fn brake(&self, patience: Duration) -> bool {
        let waiting = self.waiting();
        let is_calm = |waiting: &mut Waiting| !waiting.must_brake && !waiting.is_over;
        let waited = self.news.wait_timeout_while(waiting, patience, is_calm);
        let (mut waiting, _) = waited.unwrap_or_else(PoisonError::into_inner);
        std::mem::take(&mut waiting.must_brake)
    }

    /// Nothing is taken out any more.
    pub fn end(&self) {
        self.waiting().is_over = true;
        self.news.notify_all();
    }

    /// What is next, waited for as long; None: nothing came. [`Inbox::is_over`] says whether something may come.
    pub fn next(&self, patience: Duration) -> Option<Next> {
        let waiting = self.waiting();
        let is_empty = |waiting: &mut Waiting| {
            let has_some = waiting.stop.is_some()
                || !waiting.values.is_empty()
                || !waiting.others.is_empty()
                || !waiting.overtaken.is_empty();
            !has_some && !waiting.is_over
        };
        let waited = self.news.wait_timeout_while(waiting, patience, is_empty);
        let (mut waiting, _) = waited.unwrap_or_else(PoisonError::into_inner);
        if waiting.is_over {
            return None;
        }
        let value = |waiting: &mut Waiting| {
            let next = waiting.turns.pop_front()?;
            waiting.values.remove(&next)
        };
        let stop = waiting.stop.take();
        // A program that begins may not wait for ever behind one who sends values without end.
        let carried = stop
            .or_else(|| waiting.others.pop_front())
            .or_else(|| value(&mut waiting));
        carried
            .map(Next::Carry)
            .or_else(|| waiting.overtaken.pop().map(Next::Overtaken))
    }

    /// Whether it was ended.
    pub fn is_over(&self) -> bool {
        self.waiting().is_over
    }
}

/// Whether a topic is a command for the robot, and what becomes of it.
pub fn take(
    inbox: &Inbox,
    topics: &Topics,
    topic: &[u8],
    payload: &[u8],
    is_retained: bool,
    ticket: Option<Vec<u8>>,
) -> Option<(String, Result<(), Untaken>)> {
    let topic = std::str::from_utf8(topic).ok()?;
    let words = topics.command_of(topic)?;
    let taken = inbox.take(words, payload, is_retained, ticket);
    Some((words.to_owned(), taken))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: Duration = Duration::ZERO;

    fn inbox() -> Inbox {
        Inbox::new(true)
    }

    fn takes(inbox: &Inbox, words: &str, text: &str) -> Result<(), Untaken> {
        inbox.take(words, text.as_bytes(), false, None)
    }

    fn next(inbox: &Inbox) -> Option<Order> {
        inbox.next(NOW).map(|next| match next {
            Next::Carry(letter) => letter.order,
            Next::Overtaken(letter) => panic!("{letter:?} is overtaken"),
        })
    }

    #[test]
    fn of_values_the_newest_counts_and_a_stop_goes_before_all() {
        let inbox = inbox();
        for power in ["10", "20", " 30\n"] {
            takes(&inbox, "set/motors/M3", power).unwrap();
        }
        let set = Order::Set("motors/M3".to_owned(), "30".to_owned());
        assert_eq!(next(&inbox), Some(set));
        assert_eq!(next(&inbox), None);
        takes(&inbox, "set/motors/M3", "40").unwrap();
        takes(&inbox, "run", "a.js").unwrap();
        takes(&inbox, "stop", "").unwrap();
        takes(&inbox, "run", "b.js").unwrap();
        assert_eq!(next(&inbox), Some(Order::Stop));
        // What came before the stop is gone, what came after it counts.
        assert_eq!(next(&inbox), Some(Order::Run("b.js".to_owned())));
        let told: Vec<String> = (0..3)
            .filter_map(|_| match inbox.next(NOW)? {
                Next::Overtaken(letter) => Some(letter.order.words()),
                Next::Carry(letter) => panic!("{letter:?} is carried out"),
            })
            .collect();
        assert_eq!(told, ["run", "set/motors/M3"]);
    }

    #[test]
    fn one_who_sends_without_end_keeps_no_other_actuator_waiting() {
        let inbox = inbox();
        takes(&inbox, "set/b", "0").unwrap();
        for _ in 0..3 {
            takes(&inbox, "set/a", "1").unwrap();
        }
        let words = |order: Option<Order>| order.map(|order| order.words());
        assert_eq!(words(next(&inbox)), Some("set/b".to_owned()));
        takes(&inbox, "set/b", "0").unwrap();
        assert_eq!(words(next(&inbox)), Some("set/a".to_owned()));
        assert_eq!(words(next(&inbox)), Some("set/b".to_owned()));
        assert_eq!(next(&inbox), None);
    }

    #[test]
    fn a_stop_brakes_at_once_and_once() {
        let inbox = inbox();
        assert!(!inbox.brake(NOW));
        takes(&inbox, "stop", "").unwrap();
        assert!(inbox.brake(NOW));
        assert!(!inbox.brake(NOW));
        assert_eq!(next(&inbox), Some(Order::Stop));
    }

    #[test]
    fn what_is_no_command_is_refused_in_words() {
        let inbox = inbox();
        for words in ["run", "set/a", "parameter/a", "alive"] {
            assert_eq!(inbox.take(words, b"1", true, None), Err(Untaken::Retained));
        }
        inbox.take("stop", b"", true, None).unwrap();
        assert_eq!(next(&inbox), Some(Order::Stop));
        for (words, bytes, why) in [
            ("sotp", &b""[..], Untaken::Unknown),
            ("", b"", Untaken::Unknown),
            ("get/a", b"", Untaken::Unknown),
            ("set/a", b"\xff", Untaken::NoText),
            ("set/a", &[b'1'; ORDER_BYTES_MAX + 1], Untaken::Long),
        ] {
            assert_eq!(inbox.take(words, bytes, false, None), Err(why), "{words}");
        }
        let looks = Inbox::new(false);
        for words in ["run", "set/a", "parameter/a", "alive"] {
            assert_eq!(takes(&looks, words, "1"), Err(Untaken::LooksOnly));
        }
        takes(&looks, "stop", "").unwrap();
        assert_eq!(next(&looks), Some(Order::Stop));
    }

    #[test]
    fn more_than_can_wait_is_refused_and_a_stop_never() {
        let inbox = inbox();
        for number in 0..ORDERS_MAX {
            takes(&inbox, &format!("set/n{number}"), "1").unwrap();
            takes(&inbox, "alive", "").unwrap();
        }
        assert_eq!(takes(&inbox, "set/more", "1"), Err(Untaken::Full));
        assert_eq!(takes(&inbox, "set/n0", "2"), Ok(()));
        assert_eq!(takes(&inbox, "run", "a"), Err(Untaken::Full));
        takes(&inbox, "stop", "").unwrap();
        assert_eq!(next(&inbox), Some(Order::Stop));
        inbox.end();
        assert!(inbox.is_over() && next(&inbox).is_none());
    }

    #[test]
    fn only_topics_of_this_robot_are_commands() {
        let topics = Topics::new("7b", "anna").unwrap();
        let inbox = inbox();
        let take = |topic: &[u8]| take(&inbox, &topics, topic, b"", false, None);
        assert_eq!(take(b"trik/7b/boris/cmd/stop"), None);
        assert_eq!(take(b"\xff"), None);
        assert_eq!(
            take(b"trik/7b/anna/cmd/stop"),
            Some(("stop".to_owned(), Ok(())))
        );
    }
}
