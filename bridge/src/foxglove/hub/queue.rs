//! What waits for one client, and what it has asked to hear.
//!
//! Owns the bounds: of samples the oldest are lost, and a client that does not read its answers is given up. Knows no other
//! client.

use super::super::protocol::{self, Weight};
use crate::limits::{
    CONTROL_BYTES_MAX, DATA_BYTES_MAX, NAMES_MAX, SAMPLE_BYTES, SUBSCRIPTIONS_MAX,
};
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};
use std::io::Write;
use std::os::unix::net::UnixStream;
use std::sync::Arc;

/// The id of the status of a client that loses samples.
const SLOW: &str = "slow";

/// What goes to one client next.
#[derive(Debug)]
pub enum Next {
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
}

/// A client does not read what it has asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GivenUp;

/// A message of a channel.
#[derive(Clone)]
pub(super) struct Sample {
    pub(super) at_ns: u64,
    pub(super) bytes: Arc<[u8]>,
}

impl Sample {
    /// What it takes while it waits.
    fn size(&self) -> usize {
        self.bytes.len() + SAMPLE_BYTES
    }
}

/// Of which parameters a client hears.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum Watches {
    /// Of none.
    #[default]
    None,
    /// Of all.
    All,
    /// Of those with these names, which are some.
    These(BTreeSet<String>),
}

impl Watches {
    /// Of these too, of all if none is named; false if that would be too many.
    fn add(&mut self, names: Vec<String>) -> bool {
        if names.is_empty() {
            *self = Self::All;
            return true;
        }
        let mut all = match self {
            Self::All => return true,
            Self::None => BTreeSet::new(),
            Self::These(known) => known.clone(),
        };
        all.extend(names);
        let fits = all.len() <= NAMES_MAX;
        if fits {
            *self = Self::These(all);
        }
        fits
    }

    /// Not of these any more, of none if none is named. Who hears of all goes on to hear of all.
    fn remove(&mut self, names: &[String]) {
        match self {
            _ if names.is_empty() => *self = Self::None,
            Self::None | Self::All => {}
            Self::These(known) => {
                for name in names {
                    known.remove(name);
                }
                if known.is_empty() {
                    *self = Self::None;
                }
            }
        }
    }

    pub(super) fn has(&self, name: &str) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::These(names) => names.contains(name),
        }
    }
}

/// What waits for one client.
pub(super) struct Queue {
    pub(super) name: String,
    pub(super) watches_graph: bool,
    pub(super) watches: Watches,
    control: VecDeque<Next>,
    control_bytes: usize,
    data: VecDeque<(u32, Sample)>,
    data_bytes: usize,
    time: Option<u64>,
    /// The number that the client has for a channel.
    listens: HashMap<u32, u32>,
    subscriptions: HashMap<u32, u32>,
    lost: u64,
    /// It was told that it has lost some.
    is_slow: bool,
    is_given_up: bool,
    wake: UnixStream,
}

impl Queue {
    pub(super) fn new(name: &str, wake: UnixStream) -> Self {
        Self {
            name: name.to_owned(),
            watches_graph: false,
            watches: Watches::None,
            control: VecDeque::new(),
            control_bytes: 0,
            data: VecDeque::new(),
            data_bytes: 0,
            time: None,
            listens: HashMap::new(),
            subscriptions: HashMap::new(),
            lost: 0,
            is_slow: false,
            is_given_up: false,
            wake,
        }
    }

    pub(super) fn say(&mut self, what: Next) {
        self.control_bytes += match &what {
            Next::Text(text) => text.len(),
            Next::Bytes(bytes) => bytes.len(),
        };
        self.is_given_up |= self.control_bytes > CONTROL_BYTES_MAX;
        if self.is_given_up {
            self.control.clear();
            self.data.clear();
        } else {
            self.control.push_back(what);
        }
        self.wake();
    }

    pub(super) fn warn(&mut self, text: &str) {
        self.say(Next::Text(protocol::status(Weight::Warning, text, None)));
    }

    pub(super) fn time(&mut self, now_ns: u64) {
        self.time = Some(now_ns);
        self.wake();
    }

    fn wake(&mut self) {
        // A full pipe wakes as well.
        let _ = self.wake.write(&[0]);
    }

    /// Channels to which it listens.
    pub(super) fn listens(&self) -> impl Iterator<Item = u32> {
        self.listens.keys().copied()
    }

    /// A sample of a channel, if it listens to that.
    pub(super) fn sample(&mut self, channel: u32, sample: &Sample) {
        if let Some(&subscription) = self.listens.get(&channel) {
            self.push(subscription, sample);
        }
    }

    /// Adds a sample, instead of the oldest ones if there is no room.
    fn push(&mut self, subscription: u32, sample: &Sample) {
        self.data_bytes += sample.size();
        self.data.push_back((subscription, sample.clone()));
        while self.data_bytes > DATA_BYTES_MAX && self.data.len() > 1 {
            if let Some((_, old)) = self.data.pop_front() {
                self.data_bytes -= old.size();
                self.lost += 1;
            }
        }
        self.wake();
    }

    /// It listens to a channel from now on, of which this is the newest.
    ///
    /// # Errors
    /// Why it does not.
    pub(super) fn subscribe(
        &mut self,
        subscription: u32,
        channel: u32,
        newest: Option<&Sample>,
    ) -> Result<(), &'static str> {
        if self.subscriptions.len() >= SUBSCRIPTIONS_MAX {
            return Err("too many subscriptions");
        }
        if self.subscriptions.contains_key(&subscription) {
            return Err("a subscription with this number is there");
        }
        if self.listens.contains_key(&channel) {
            return Err("this client has a subscription to this channel");
        }
        self.subscriptions.insert(subscription, channel);
        self.listens.insert(channel, subscription);
        if let Some(newest) = newest {
            self.push(subscription, newest);
        }
        Ok(())
    }

    /// It does not any more; what waits for these subscriptions goes with them.
    pub(super) fn unsubscribe(&mut self, subscriptions: &[u32]) {
        let mut ended = HashSet::new();
        for subscription in subscriptions {
            if let Some(channel) = self.subscriptions.remove(subscription) {
                self.listens.remove(&channel);
                ended.insert(*subscription);
            }
        }
        self.drop_data(&ended);
    }

    /// These channels are gone.
    pub(super) fn forget(&mut self, channels: &[u32]) {
        let mut ended = HashSet::new();
        for channel in channels {
            if let Some(subscription) = self.listens.remove(channel) {
                self.subscriptions.remove(&subscription);
                ended.insert(subscription);
            }
        }
        self.drop_data(&ended);
    }

    fn drop_data(&mut self, ended: &HashSet<u32>) {
        if ended.is_empty() {
            return;
        }
        self.data.retain(|(one, _)| !ended.contains(one));
        self.data_bytes = self.data.iter().map(|(_, one)| one.size()).sum();
    }

    /// It hears of changes of parameters, of all if none is named, or not any more.
    pub(super) fn watch(&mut self, names: Vec<String>, wants: bool) {
        if !wants {
            self.watches.remove(&names);
        } else if !self.watches.add(names) {
            self.warn(&format!(
                "a client hears of at most {NAMES_MAX} parameters by their names: none of these is added"
            ));
        }
    }

    /// What goes out next; None if there is nothing.
    ///
    /// # Errors
    /// It was given up.
    pub(super) fn next(&mut self) -> Result<Option<Next>, GivenUp> {
        if self.is_given_up {
            return Err(GivenUp);
        }
        if let Some(next) = self.control.pop_front() {
            self.control_bytes -= match &next {
                Next::Text(text) => text.len(),
                Next::Bytes(bytes) => bytes.len(),
            };
            return Ok(Some(next));
        }
        if let Some(now_ns) = self.time.take() {
            return Ok(Some(Next::Bytes(protocol::time(now_ns))));
        }
        if self.lost > 0 {
            let text = format!("this client is slow: {} samples are lost", self.lost);
            (self.lost, self.is_slow) = (0, true);
            let text = protocol::status(Weight::Warning, &text, Some(SLOW));
            return Ok(Some(Next::Text(text)));
        }
        if let Some((subscription, sample)) = self.data.pop_front() {
            self.data_bytes -= sample.size();
            let bytes = protocol::message(subscription, sample.at_ns, &sample.bytes);
            return Ok(Some(Next::Bytes(bytes)));
        }
        // It has caught up.
        let was_slow = std::mem::take(&mut self.is_slow);
        Ok(was_slow.then(|| Next::Text(protocol::remove_status(&[SLOW]))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn queue() -> (Queue, UnixStream) {
        let (wake, woken) = UnixStream::pair().unwrap();
        wake.set_nonblocking(true).unwrap();
        (Queue::new("c", wake), woken)
    }

    fn sample(size: usize) -> Sample {
        Sample {
            at_ns: 1,
            bytes: vec![0; size].into(),
        }
    }

    fn names(all: &[&str]) -> Vec<String> {
        all.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn who_watches_all_some_or_none_goes_on_as_was_asked() {
        let mut watches = Watches::None;
        let mut told = |wants: bool, all: &[&str]| {
            match wants {
                true => assert!(watches.add(names(all))),
                false => watches.remove(&names(all)),
            }
            ["a", "b", "c"].map(|name| watches.has(name))
        };
        assert_eq!(told(true, &["a", "b"]), [true, true, false]);
        assert_eq!(told(false, &["b"]), [true, false, false]);
        assert_eq!(told(false, &["a"]), [false; 3], "the last one is not all");
        assert_eq!(told(false, &["a"]), [false; 3]);
        assert_eq!(told(true, &[]), [true; 3]);
        assert_eq!(
            told(true, &["a"]),
            [true; 3],
            "all are not fewer by one more"
        );
        assert_eq!(told(false, &["a"]), [true; 3]);
        assert_eq!(told(false, &[]), [false; 3]);
        assert_eq!(watches, Watches::None);
    }

    #[test]
    fn names_that_a_client_watches_are_bounded() {
        let (mut queue, _woken) = queue();
        let many = |from: usize| {
            (from..from + NAMES_MAX)
                .map(|one| one.to_string())
                .collect()
        };
        queue.watch(many(0), true);
        assert!(queue.next().unwrap().is_none());
        queue.watch(many(0), true);
        assert!(queue.next().unwrap().is_none(), "they are the same");
        queue.watch(many(1), true);
        let Some(Next::Text(told)) = queue.next().unwrap() else {
            panic!("nothing is told");
        };
        assert!(told.contains("none of these is added"), "{told}");
        assert!(queue.watches.has("0") && !queue.watches.has(&NAMES_MAX.to_string()));
    }

    #[test]
    fn what_waits_is_bounded_however_it_came() {
        let (mut queue, _woken) = queue();
        let large = sample(DATA_BYTES_MAX / 4);
        for number in 0..10 {
            queue.subscribe(number, number, Some(&large)).unwrap();
        }
        assert!(queue.data_bytes <= DATA_BYTES_MAX && queue.lost == 7);
        // Empty ones take room too.
        for _ in 0..DATA_BYTES_MAX / SAMPLE_BYTES * 2 {
            queue.sample(0, &sample(0));
        }
        assert!(queue.data.len() <= DATA_BYTES_MAX / SAMPLE_BYTES);
    }

    #[test]
    fn samples_end_with_their_subscription() {
        let (mut queue, _woken) = queue();
        for number in 1..=3 {
            queue
                .subscribe(number, number + 10, Some(&sample(8)))
                .unwrap();
        }
        let twice = queue.subscribe(9, 11, Some(&sample(8)));
        assert_eq!(twice, Err("this client has a subscription to this channel"));
        queue.unsubscribe(&[1, 7]);
        queue.forget(&[12, 99]);
        let left: Vec<u32> = queue.data.iter().map(|(one, _)| *one).collect();
        assert_eq!((left, queue.data_bytes), (vec![3], sample(8).size()));
        queue.subscribe(1, 11, None).unwrap();
        queue.subscribe(2, 12, None).unwrap();
    }
}
