//! What happens in a tree, as its rings of samples, its log and its configuration show it.
//!
//! Owns what has been seen by now. Looks often enough that no ring goes round, waits for nothing, and keeps nothing that the
//! writer does not take: then it counts what is lost, and the count is in the recording.

use super::disk::{Disk, Entry};
use super::nodes;
use crate::error::Error;
use crate::limits;
use journal::layout::Layout;
use journal::node::Node;
use journal::standard::{Level, Log};
use journal::write::ABOUT;
use nix::time::{ClockId, clock_gettime};
use sample_bus::{Event, Reader, Step};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::Read;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What a recording has, and what it has not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) events: u64,
    /// Overwritten in their rings before they were looked at.
    pub(super) missed: u64,
    /// The disk was too slow.
    pub(super) dropped: u64,
}

/// One node that is recorded.
struct Watched {
    node: Node,
    ring: Reader,
    /// Its number in the file; None before it is there.
    number: Option<usize>,
    /// The last errno, and what `fault` said of it.
    fault: (i32, String),
}

/// Its samples; of an actuator, what is written to it.
fn ring(root: &Path, node: &Node) -> Option<Reader> {
    let is_actuator = !node.rest.is_empty();
    let written = is_actuator.then(|| Reader::open_written(root, &node.path).ok());
    written
        .flatten()
        .or_else(|| Reader::open(root, &node.path).ok())
}

impl Watched {
    fn new(mut node: Node, ring: Reader) -> Self {
        let size = Layout::parse(&node.format).map_or(0, |layout| layout.size());
        if size != ring.tuple_bytes() {
            // What is written has no names if it is converted on its way.
            node.format = format!("u8 x {}", ring.tuple_bytes());
        }
        Self {
            node,
            ring,
            number: None,
            fault: (0, String::new()),
        }
    }

    /// One event of its ring.
    fn entry(
        &mut self,
        root: &Path,
        number: usize,
        event: Event,
        unix_ns: u64,
        tuple: &[u8],
    ) -> Entry {
        if event.errno == self.fault.0 && event.errno != 0 {
            return Entry::Fault(number, unix_ns, event.errno, self.fault.1.clone());
        }
        self.fault = (event.errno, String::new());
        if event.errno == 0 {
            return Entry::Sample(number, unix_ns, tuple.to_vec());
        }
        let fault = nodes::text(&root.join(&self.node.path).join("fault"));
        self.fault.1 = fault.unwrap_or_default();
        Entry::Fault(number, unix_ns, event.errno, self.fault.1.clone())
    }
}

/// A tree that is looked at.
pub(super) struct Watch {
    root: PathBuf,
    watched: Vec<Watched>,
    left_out: Vec<String>,
    log: Option<File>,
    /// What of a line of the log has come.
    line: Vec<u8>,
    /// Length and time of the configuration that was attached.
    configuration: (u64, i64),
    offset_ns: i64,
    /// When it began, by the clock of the machine.
    begin_ns: u64,
    counts: Counts,
    /// Nodes in the file.
    added: usize,
    looks_at: Instant,
    is_gone: bool,
    tuple: Vec<u8>,
}

/// How often it is looked whether nodes, configuration and clock are still the same.
const CARE: Duration = Duration::from_secs(1);
/// A clock that is off by more has been set.
const CLOCK_NS: i64 = 1_000_000;

impl Watch {
    /// Finds the nodes that are wanted.
    ///
    /// # Errors
    /// There are none.
    pub(super) fn begin(root: &Path, wants: impl Fn(&str) -> bool) -> Result<Self, Error> {
        let mut watch = Self {
            root: root.to_owned(),
            watched: Vec::new(),
            left_out: Vec::new(),
            log: log(root),
            line: Vec::new(),
            configuration: (0, 0),
            offset_ns: offset_ns(),
            begin_ns: u64::try_from(clock_ns(ClockId::CLOCK_MONOTONIC)).unwrap_or(0),
            counts: Counts::default(),
            added: 0,
            looks_at: Instant::now(),
            is_gone: false,
            tuple: Vec::new(),
        };
        for node in nodes::find(root) {
            if !wants(&node.path) {
                continue;
            }
            match ring(root, &node) {
                Some(ring) => watch.watched.push(Watched::new(node, ring)),
                None => watch.left_out.push(node.path),
            }
        }
        if watch.watched.is_empty() {
            return Err(Error::file(
                root,
                "nothing to record: no node that is wanted is sampled in the background, or the tree is another user's",
            ));
        }
        Ok(watch)
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    pub(super) fn recorded(&self) -> usize {
        self.watched.len()
    }

    pub(super) fn left_out(&self) -> &[String] {
        &self.left_out
    }

    pub(super) fn counts(&self) -> Counts {
        self.counts
    }

    /// The tree is not mounted any more.
    pub(super) fn is_gone(&self) -> bool {
        self.is_gone
    }

    /// Takes what has come since the last look.
    pub(super) fn look(&mut self, disk: &Disk) {
        let mut batch = Vec::new();
        if Instant::now() >= self.looks_at {
            self.looks_at = Instant::now() + CARE;
            self.care(&mut batch);
        }
        let added = self.added;
        let mut missed = 0;
        for watched in &mut self.watched {
            let number = match watched.number {
                Some(number) => number,
                None => {
                    batch.push(Entry::Node(watched.node.clone()));
                    watched.number = Some(self.added);
                    self.added += 1;
                    self.added - 1
                }
            };
            // What a node had when the recording began stands at its beginning.
            let mut before = None;
            loop {
                match watched.ring.next_event(&mut self.tuple) {
                    Step::Event(event) => {
                        let time_ns = event.time_ns.max(self.begin_ns);
                        let unix_ns = time_ns.saturating_add_signed(self.offset_ns);
                        let entry = watched.entry(&self.root, number, event, unix_ns, &self.tuple);
                        if event.time_ns < self.begin_ns {
                            before = Some(entry);
                        } else {
                            batch.extend(before.take());
                            batch.push(entry);
                        }
                    }
                    Step::Missed(count) => missed += u64::from(count),
                    Step::Nothing => break,
                }
            }
            batch.extend(before);
        }
        self.counts.missed += missed;
        self.read_log(&mut batch);
        if batch.is_empty() {
            return;
        }
        let events = events_of(&batch);
        match disk.put(batch) {
            Ok(()) => self.counts.events += events,
            Err(_) => {
                self.counts.dropped += events;
                // What the file does not know is told again with the next batch.
                self.added = added;
                for watched in &mut self.watched {
                    watched.number = watched.number.filter(|number| *number < added);
                }
                self.configuration = (0, 0);
            }
        }
    }

    /// Looks after nodes whose rings have ended, the configuration and the clock.
    fn care(&mut self, batch: &mut Vec<Entry>) {
        self.is_gone = !self.root.join("status").exists();
        let offset_ns = offset_ns();
        let is_set = (offset_ns - self.offset_ns).abs() > CLOCK_NS;
        if is_set || self.configuration == (0, 0) {
            self.offset_ns = offset_ns;
            batch.push(Entry::Facts(ABOUT, self.facts()));
        }
        let path = self.root.join("config");
        let found = path.metadata().map(|file| (file.len(), file.mtime()));
        if let Ok(found) = found
            && found != self.configuration
        {
            let mut text = Vec::new();
            let most = limits::RECORDED_CONFIG_BYTES_MAX;
            let read = File::open(&path).map(|file| file.take(most).read_to_end(&mut text));
            if read.is_ok_and(|read| read.is_ok()) {
                self.configuration = found;
                batch.push(Entry::Attachment(
                    now_ns(),
                    "config.lua",
                    "text/x-lua",
                    text,
                ));
            }
        }
        for watched in &mut self.watched {
            if watched.ring.is_current() {
                continue;
            }
            let Some(ring) = ring(&self.root, &watched.node) else {
                continue;
            };
            let mut node = watched.node.clone();
            let format = nodes::text(&self.root.join(&node.path).join("format"));
            node.format = format.unwrap_or_default();
            let fresh = Watched::new(node, ring);
            let is_same = fresh.node.format == watched.node.format;
            // Of another format, it is another channel.
            let number = watched.number.filter(|_| is_same);
            *watched = Watched { number, ..fresh };
        }
    }

    fn facts(&self) -> BTreeMap<String, String> {
        let boot = nodes::text(Path::new("/proc/sys/kernel/random/boot_id"));
        let host = nodes::text(Path::new("/proc/sys/kernel/hostname"));
        let all = [
            (
                "program",
                concat!("trik ", env!("CARGO_PKG_VERSION")).to_owned(),
            ),
            ("tree", self.root.display().to_string()),
            ("host", host.unwrap_or_default()),
            ("boot_id", boot.unwrap_or_default()),
            ("realtime_offset_ns", self.offset_ns.to_string()),
        ];
        all.into_iter()
            .map(|(key, value)| (key.to_owned(), value))
            .collect()
    }

    fn read_log(&mut self, batch: &mut Vec<Entry>) {
        let Some(log) = &mut self.log else { return };
        let mut bytes = [0; 4096];
        // A log that is read to its end has nothing; what is too much for one look comes with the next.
        let count = log.read(&mut bytes).unwrap_or(0);
        for &byte in &bytes[..count] {
            match byte {
                b'\n' => {
                    let text =
                        String::from_utf8_lossy(&std::mem::take(&mut self.line)).into_owned();
                    let line = Log {
                        level: Level::Info,
                        name: "trikfs".to_owned(),
                        text,
                        errno: 0,
                    };
                    batch.push(Entry::Log(now_ns(), line));
                }
                _ if self.line.len() < limits::LINE_BYTES_MAX => self.line.push(byte),
                _ => {}
            }
        }
    }

    /// Says at the end what is missing.
    pub(super) fn end(&mut self, disk: &Disk) {
        self.look(disk);
        let counts = self.counts;
        let facts = [
            ("events", counts.events),
            ("missed", counts.missed),
            ("dropped", counts.dropped),
        ];
        let facts = facts.map(|(key, count)| (key.to_owned(), count.to_string()));
        // Without room the end of the file is all that is left to write.
        let _ = disk.put(vec![Entry::Facts("counts", facts.into())]);
    }
}

/// How many of these are events.
fn events_of(batch: &[Entry]) -> u64 {
    let is_event = |entry: &&Entry| match entry {
        Entry::Sample(..) | Entry::Fault(..) | Entry::Log(..) => true,
        Entry::Node(_) | Entry::Attachment(..) | Entry::Facts(..) => false,
    };
    batch.iter().filter(is_event).count() as u64
}

/// Lines from now on: those that are kept have no time.
fn log(root: &Path) -> Option<File> {
    let mut options = OpenOptions::new();
    let log = options.read(true).custom_flags(libc::O_NONBLOCK);
    let mut log = log.open(root.join("log")).ok()?;
    let mut kept = [0; 4096];
    for _ in 0..limits::LOG_READS_MAX {
        if log.read(&mut kept).unwrap_or(0) == 0 {
            break;
        }
    }
    Some(log)
}

fn clock_ns(clock: ClockId) -> i64 {
    clock_gettime(clock).map_or(0, |time| time.tv_sec() * 1_000_000_000 + time.tv_nsec())
}

/// What the clock of the world is ahead of the machine's own.
fn offset_ns() -> i64 {
    clock_ns(ClockId::CLOCK_REALTIME) - clock_ns(ClockId::CLOCK_MONOTONIC)
}

fn now_ns() -> u64 {
    u64::try_from(clock_ns(ClockId::CLOCK_REALTIME)).unwrap_or(0)
}
