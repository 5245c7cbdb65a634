//! Entries as bytes for one client: a recording without an end, which it reads while it is made.
//!
//! Owns what the client wants: patterns of nodes, and how often each may speak. A client that does not read loses events and
//! is told how many; it delays nobody. Knows no network.

use crate::clock::now_ns;
use crate::desk::Listener;
use crate::entry::{Entry, Known};
use crate::error::Error;
use crate::limits::{PATTERN_BYTES_MAX, PATTERNS_MAX};
use crate::pattern::matches;
use crate::pen::Pen;
use crate::watch::{Wants, Wish};
use journal::write::{Out, Writer};
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// What a client wants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Request {
    /// Nodes and groups; empty for all.
    patterns: Vec<String>,
    /// Least time between two samples of a node.
    period_ns: u64,
    /// What devices give too, before it is converted.
    raw: bool,
}

impl Request {
    /// `PATTERN,PATTERN;hz=10` or `PATTERN,PATTERN;raw`; all parts may be missing.
    ///
    /// # Errors
    /// Too many or too long patterns, a rate that is none, or one with bytes of devices: what is made of those would differ.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let wrong = |what: String| Err(Error::Request(what));
        let mut request = Self::default();
        let mut parts = text.split(';');
        let patterns = parts.next().unwrap_or_default().split(',').map(str::trim);
        for pattern in patterns.filter(|pattern| !pattern.is_empty()) {
            if request.patterns.len() == PATTERNS_MAX {
                return wrong(format!("at most {PATTERNS_MAX} patterns"));
            }
            if pattern.len() > PATTERN_BYTES_MAX {
                return wrong(format!(
                    "a pattern of {} bytes: at most {PATTERN_BYTES_MAX}",
                    pattern.len()
                ));
            }
            request.patterns.push(pattern.to_owned());
        }
        for part in parts {
            if part.trim() == "raw" {
                request.raw = true;
                continue;
            }
            let Some(rate) = part.trim().strip_prefix("hz=") else {
                return wrong(format!(
                    "{part:?} is no option: there are hz=NUMBER and raw"
                ));
            };
            request.period_ns = match rate.trim().parse::<f64>() {
                Ok(rate) if (0.01..=10_000.0).contains(&rate) => period_ns(rate),
                Ok(_) | Err(_) => return wrong(format!("{rate:?} is no rate: 0.01 to 10000 Hz")),
            };
        }
        if request.raw && request.period_ns > 0 {
            return wrong("raw is for all bytes of devices: leave hz out".to_owned());
        }
        Ok(request)
    }

    /// Whether a node is wanted.
    pub fn wants(&self, path: &str) -> bool {
        let patterns = &self.patterns;
        patterns.is_empty() || patterns.iter().any(|pattern| matches(pattern, path))
    }
}

fn period_ns(rate_hz: f64) -> u64 {
    // It is from 1e5 to 1e11, so nothing is cut off but a part of a nanosecond.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let period_ns = (1e9 / rate_hz) as u64;
    period_ns
}

/// What became of bytes that were handed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Took {
    /// They are on their way.
    All,
    /// The client has not read what was sent before.
    Full,
    /// The client is gone.
    Gone,
}

/// Where the bytes go.
pub trait Client: Send {
    /// Whether there is room for more.
    fn state(&mut self) -> Took;

    /// Takes bytes; called only while there is room.
    fn send(&mut self, bytes: Vec<u8>);
}

/// One node of a client that does not want everything.
#[derive(Default)]
struct Pace {
    due_ns: u64,
    held: Option<Entry>,
}

/// The recording of one client.
pub struct Stream {
    request: Request,
    client: Box<dyn Client>,
    pen: Pen<Out>,
    out: Out,
    paces: HashMap<u32, Pace>,
    lost: u64,
    told: u64,
}

impl Stream {
    /// Begins it; `library` is the program that sends, with its version.
    ///
    /// # Errors
    /// None is seen.
    pub fn begin(
        request: Request,
        library: &str,
        client: Box<dyn Client>,
    ) -> Result<Self, journal::error::Error> {
        let out = Out::default();
        let mut writer = Writer::live(out.clone(), library)?;
        // It is told first what each node has had, maybe for long.
        writer.begin_at(now_ns());
        Ok(Self {
            request,
            client,
            pen: Pen::new(writer),
            out,
            paces: HashMap::new(),
            lost: 0,
            told: 0,
        })
    }

    /// There is no room: nodes and files must come later, since they come only once; the newest of each node as well.
    fn lose(&mut self, entries: &[Entry]) {
        for entry in entries {
            match entry {
                Entry::Sample(known, ..) | Entry::Fault(known, ..)
                    if self.request.wants(&known.node.path) =>
                {
                    let pace = self.paces.entry(known.number).or_default();
                    self.lost += u64::from(pace.held.replace(entry.clone()).is_some());
                }
                Entry::Sample(..) | Entry::Fault(..) | Entry::Node(_) => {}
                Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => self.lost += 1,
            }
        }
    }

    /// What is sent now.
    fn due(&mut self, entries: &[Entry], now_ns: u64) -> Vec<Entry> {
        let mut due = Vec::with_capacity(entries.len());
        let period_ns = self.request.period_ns;
        for pace in self.paces.values_mut() {
            // A clock that was set back would leave the node silent until it comes there again.
            let is_due = now_ns >= pace.due_ns || pace.due_ns > now_ns + period_ns;
            if pace.held.is_some() && is_due {
                pace.due_ns = now_ns + period_ns;
                due.extend(pace.held.take());
            }
        }
        for entry in entries {
            match entry {
                Entry::Sample(known, unix_ns, _) => {
                    // For up to a second after the clock was set back, samples have times of the clock before.
                    let at_ns = now_ns.min(*unix_ns);
                    self.sample(known, at_ns, entry, &mut due);
                }
                Entry::Node(known) | Entry::Fault(known, ..) => {
                    if self.request.wants(&known.node.path) {
                        due.push(entry.clone());
                    }
                }
                Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {
                    due.push(entry.clone());
                }
            }
        }
        due
    }

    fn sample(&mut self, known: &Known, at_ns: u64, entry: &Entry, due: &mut Vec<Entry>) {
        if !self.request.wants(&known.node.path) {
            return;
        }
        if self.request.period_ns == 0 {
            due.push(entry.clone());
            return;
        }
        let pace = self.paces.entry(known.number).or_default();
        if at_ns < pace.due_ns {
            pace.held = Some(entry.clone());
            return;
        }
        pace.held = None;
        pace.due_ns = at_ns + self.request.period_ns;
        due.push(entry.clone());
    }
}

impl Listener for Stream {
    /// What is named is needed; everything is what there is anyway.
    fn wants(&self) -> Wants {
        let request = self.request.clone();
        let wish = match request.patterns.is_empty() {
            true => Wish::ByTheClock,
            false => Wish::Samples,
        };
        Box::new(move |path| request.wants(path).then_some(wish))
    }

    fn wants_raw(&self) -> bool {
        self.request.raw
    }

    fn put(&mut self, entries: &[Entry], now_ns: u64) -> bool {
        match self.client.state() {
            Took::Gone => return false,
            Took::Full => {
                self.lose(entries);
                return true;
            }
            Took::All => {}
        }
        let due = self.due(entries, now_ns);
        for entry in &due {
            if self.pen.put(entry).is_err() {
                // A sample that is none, or more nodes than a recording has.
                self.lost += 1;
            }
        }
        if self.lost > self.told {
            self.told = self.lost;
            let lost = BTreeMap::from([("dropped".to_owned(), self.lost.to_string())]);
            // It is told again with the next.
            let _ = self.pen.put(&Entry::Facts("counts", Arc::new(lost)));
        }
        let bytes = self.out.take();
        if !bytes.is_empty() {
            self.client.send(bytes);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use journal::read::{EventKind, Reader};
    use std::io::Cursor;
    use std::sync::Mutex;

    #[derive(Clone)]
    struct Pipe(Arc<Mutex<(Vec<u8>, Took)>>);

    impl Client for Pipe {
        fn state(&mut self) -> Took {
            self.0.lock().unwrap().1
        }

        fn send(&mut self, bytes: Vec<u8>) {
            self.0.lock().unwrap().0.extend(bytes);
        }
    }

    fn pipe() -> Pipe {
        Pipe(Arc::new(Mutex::new((Vec::new(), Took::All))))
    }

    fn known(number: u32, path: &str) -> Arc<Known> {
        let node = Node::sensor(path, "u8 x");
        Arc::new(Known { number, node })
    }

    fn sample(known: &Arc<Known>, unix_ns: u64, value: u8) -> Entry {
        Entry::Sample(known.clone(), unix_ns, Arc::new([value]))
    }

    /// Node and value of every sample that a client has.
    fn had(pipe: &Pipe) -> Vec<(String, u8)> {
        let mut whole = Cursor::new(Vec::new());
        let bytes = pipe.0.lock().unwrap().0.clone();
        journal::mend::mend(&bytes[..], &mut whole).unwrap();
        let mut reader = Reader::open(whole).unwrap();
        let mut all = Vec::new();
        while let Some(event) = reader.next().unwrap() {
            if let EventKind::Sample { node, tuple, .. } = event.what {
                all.push((reader.nodes()[node].path.clone(), tuple[0]));
            }
        }
        all
    }

    #[test]
    fn a_request_says_which_nodes_and_how_often() {
        let request = Request::parse("sensors/A*, motors;hz=10").unwrap();
        assert!(request.wants("sensors/A1") && request.wants("motors/left"));
        assert!(!request.wants("battery"));
        assert_eq!(request.period_ns, 100_000_000);
        assert!(!request.raw && Request::parse("a; raw").unwrap().raw);
        assert_eq!(Request::parse("").unwrap(), Request::default());
        for wrong in [
            "a;hz=0".to_owned(),
            "a;hz=nan".to_owned(),
            "a;hz=1e9".to_owned(),
            "a;every=5".to_owned(),
            "a;raw;hz=5".to_owned(),
            "x".repeat(PATTERN_BYTES_MAX + 1),
            "x,".repeat(PATTERNS_MAX + 1),
        ] {
            assert!(Request::parse(&wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_client_has_what_it_wants_at_its_rate_and_the_newest_in_the_end() {
        let pipe = pipe();
        let request = Request::parse("a;hz=10").unwrap();
        let mut stream = Stream::begin(request, "test", Box::new(pipe.clone())).unwrap();
        let (a, b) = (known(1, "a"), known(2, "b"));
        let ms = 1_000_000;
        let begin = 1_700_000_000_000_000_000;
        let samples: Vec<_> = (0..5_u8)
            .flat_map(|at| {
                let unix_ns = begin + u64::from(at) * 10 * ms;
                [sample(&a, unix_ns, at), sample(&b, unix_ns, at)]
            })
            .collect();
        assert!(stream.put(&samples, begin + 40 * ms));
        assert_eq!(had(&pipe), [("a".to_owned(), 0)]);
        assert!(stream.put(&[], begin + 100 * ms));
        assert_eq!(had(&pipe), [("a".to_owned(), 0), ("a".to_owned(), 4)]);
    }

    #[test]
    fn a_client_that_does_not_read_has_the_newest_of_each_node_and_a_count_later() {
        let pipe = pipe();
        let mut stream = Stream::begin(Request::default(), "test", Box::new(pipe.clone())).unwrap();
        let (a, b) = (known(1, "a"), known(2, "b"));
        pipe.0.lock().unwrap().1 = Took::Full;
        let begin = 1_700_000_000_000_000_000;
        let all = [
            sample(&a, begin, 1),
            sample(&b, begin, 2),
            sample(&a, begin + 1, 3),
        ];
        assert!(stream.put(&all, begin + 1));
        assert!(pipe.0.lock().unwrap().0.is_empty());
        pipe.0.lock().unwrap().1 = Took::All;
        assert!(stream.put(&[], begin + 2));
        let mut values = had(&pipe);
        values.sort();
        assert_eq!(values, [("a".to_owned(), 3), ("b".to_owned(), 2)]);
        assert_eq!(stream.lost, 1);
        pipe.0.lock().unwrap().1 = Took::Gone;
        assert!(!stream.put(&[], begin + 3));
    }

    #[test]
    fn a_clock_that_is_set_back_does_not_silence_a_client_with_a_rate() {
        let pipe = pipe();
        let request = Request::parse("a;hz=10").unwrap();
        let mut stream = Stream::begin(request, "test", Box::new(pipe.clone())).unwrap();
        let a = known(1, "a");
        let period = 100_000_000;
        let (before, hour) = (1_700_000_000_000_000_000, 36_000 * period);
        let now = before - hour;
        let has = |value: u8| had(&pipe).contains(&("a".to_owned(), value));
        assert!(stream.put(&[sample(&a, before, 1)], before));
        // Held when the clock changes ...
        assert!(stream.put(&[sample(&a, before + 1, 2)], before + 1));
        assert!(has(1) && !has(2));
        // ... and sent at the next look, whatever that says.
        assert!(stream.put(&[], now));
        assert!(has(2));
        // At its rate from then on, also with times of the clock before.
        assert!(stream.put(&[sample(&a, before + 2, 3)], now + 1));
        assert!(stream.put(&[sample(&a, now + 2, 4)], now + 2));
        assert!(!has(3) && !has(4));
        assert!(stream.put(&[], now + period));
        assert!(!has(3) && has(4));
        let next = now + 2 * period;
        assert!(stream.put(&[sample(&a, next, 5)], next));
        assert!(has(5));
        // One that was sent just before is due a look after it comes.
        let earlier = next - hour;
        assert!(stream.put(&[sample(&a, earlier, 6)], earlier));
        assert!(stream.put(&[], earlier + 1));
        assert!(has(6));
    }
}
