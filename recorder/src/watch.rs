//! What happens in a tree, as its rings of samples, its log and its configuration show it.
//!
//! Owns what has been seen by now, and the newest of each node. Looks when it is told to, which must be often enough that no
//! ring goes round; waits for nothing and counts what was overwritten meanwhile. Keeps no file.

use crate::clock::{clock_ns, now_ns, offset_ns};
use crate::entry::{Entry, Known};
use crate::errno::LEFT;
use crate::error::Error;
use crate::raw::Raws;
pub use crate::watched::Wish;
use crate::watched::{From, Watched};
use crate::world::World;
use crate::{limits, nodes};
use journal::node::Node;
use journal::standard::{Level, Log};
use journal::write::{ABOUT, Story};
use nix::time::ClockId;
use sample_bus::Reader;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How the configuration of a tree begins that gives what was recorded.
pub const REPLAYED: &str = "-- Made for a replay";

/// Its samples; of an actuator, what is written to it, which in a replayed tree is a sample as well.
fn ring(root: &Path, node: &Node, wish: Wish, is_replayed: bool) -> Option<Reader> {
    let is_actuator = !node.rest.is_empty() && !is_replayed;
    let written = is_actuator.then(|| Reader::open_written(root, &node.path).ok());
    if let Some(written) = written.flatten() {
        return Some(written);
    }
    let is_needed = match wish {
        Wish::Samples => true,
        Wish::ByTheClock => is_sampled_by_the_clock(root, &node.path),
    };
    match is_needed {
        true => Reader::open(root, &node.path).ok(),
        false => Reader::open_beside(root, &node.path).ok(),
    }
}

fn is_sampled_by_the_clock(root: &Path, node: &str) -> bool {
    let period_ms = nodes::text(&root.join(node).join("poll_ms"));
    period_ms.is_some_and(|text| text.trim().parse().is_ok_and(|ms: f64| ms > 0.0))
}

/// Which nodes are looked at; None for one that is not.
pub type Wants = Box<dyn Fn(&str) -> Option<Wish> + Send>;

/// A tree that is looked at.
pub struct Watch {
    root: PathBuf,
    wants: Wants,
    /// What says of itself that it records.
    program: String,
    watched: Vec<Watched>,
    /// What their sources give, before it is converted; None if nobody wants it.
    raws: Option<Raws>,
    /// Nodes that nothing samples in the background.
    left_out: BTreeSet<String>,
    log: Option<File>,
    /// What of a line of the log has come.
    line: Vec<u8>,
    /// Length and time of the configuration, and its text.
    configuration: (u64, (i64, i64)),
    text: Option<Entry>,
    /// Around a virtual robot.
    world: Option<World>,
    /// It gives what was recorded.
    is_replayed: bool,
    offset_ns: i64,
    /// When it began, by the clock of the machine.
    begin_ns: u64,
    missed: u64,
    /// The facts are in what was handed over.
    is_told: bool,
    numbers: u32,
    looks_at: Instant,
    is_gone: bool,
    tuple: Vec<u8>,
}

/// No configuration has been seen.
const NONE: (u64, (i64, i64)) = (0, (0, 0));
/// How often it is looked whether nodes, configuration and clock are still the same.
const CARE: Duration = Duration::from_secs(1);
/// A clock that is off by more has been set.
const CLOCK_NS: i64 = 1_000_000;

impl Watch {
    /// Finds the nodes that are wanted; `program` is what records, with its version.
    ///
    /// # Errors
    /// There are none.
    pub fn begin(root: &Path, program: &str, wants: Wants) -> Result<Self, Error> {
        Self::begin_after(0, root, program, wants)
    }

    /// The same for one who has looked at another tree before: nodes have numbers after `numbers`.
    ///
    /// # Errors
    /// As of [`Watch::begin`].
    pub fn begin_after(
        numbers: u32,
        root: &Path,
        program: &str,
        wants: Wants,
    ) -> Result<Self, Error> {
        let mut watch = Self {
            root: root.to_owned(),
            wants,
            program: program.to_owned(),
            watched: Vec::new(),
            raws: None,
            left_out: BTreeSet::new(),
            log: log(root),
            line: Vec::new(),
            configuration: NONE,
            text: None,
            world: None,
            is_replayed: is_replayed(root),
            offset_ns: offset_ns(),
            begin_ns: u64::try_from(clock_ns(ClockId::CLOCK_MONOTONIC)).unwrap_or(0),
            missed: 0,
            is_told: true,
            numbers,
            looks_at: Instant::now(),
            is_gone: false,
            tuple: Vec::new(),
        };
        watch.find(&mut Vec::new());
        if watch.watched.is_empty() {
            return Err(Error::Nothing(root.to_owned()));
        }
        Ok(watch)
    }

    /// The same with the world that is told in this folder.
    #[must_use]
    pub fn with_world(self, folder: Option<&Path>) -> Self {
        Self {
            world: folder.map(World::new),
            ..self
        }
    }

    /// The same with what sources give before it is converted, as far as the tree publishes that.
    #[must_use]
    pub fn with_raw(self, is_wanted: bool) -> Self {
        let mut watch = self;
        watch.want_raw(is_wanted, &mut Vec::new());
        watch
    }

    /// What sources give is wanted from now on, or no more; those that are new come at once.
    pub fn want_raw(&mut self, is_wanted: bool, out: &mut Vec<Entry>) {
        match is_wanted {
            true => drop(self.raws.get_or_insert_default()),
            false => self.raws = None,
        }
        self.find_raws(out);
    }

    /// Of how many nodes that is looked at.
    pub fn raws(&self) -> usize {
        self.raws.as_ref().map_or(0, Raws::count)
    }

    fn find_raws(&mut self, out: &mut Vec<Entry>) {
        if let Some(raws) = &mut self.raws {
            let nodes = self.watched.iter().map(|one| &one.known.node);
            raws.find(&self.root, nodes, &mut self.numbers, out);
        }
    }

    /// The greatest number of a node.
    pub fn numbers(&self) -> u32 {
        self.numbers
    }

    /// Where the tree is mounted.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// How many nodes are looked at.
    pub fn recorded(&self) -> usize {
        self.watched.len()
    }

    /// Nodes that are wanted and have no samples.
    pub fn left_out(&self) -> impl Iterator<Item = &str> {
        self.left_out.iter().map(String::as_str)
    }

    /// Samples that were overwritten before they were looked at.
    pub fn missed(&self) -> u64 {
        self.missed
    }

    /// The tree is not mounted any more.
    pub fn is_gone(&self) -> bool {
        self.is_gone
    }

    /// Takes what has come since the last look.
    pub fn look(&mut self, out: &mut Vec<Entry>) {
        if Instant::now() >= self.looks_at {
            self.looks_at = Instant::now() + CARE;
            self.care(out);
        }
        let from = From {
            root: &self.root,
            begin_ns: self.begin_ns,
            offset_ns: self.offset_ns,
        };
        // Samples first: what they were made of is then there.
        let samples = out.len();
        for watched in &mut self.watched {
            self.missed += watched.look(&from, &mut self.tuple, out);
        }
        if let Some(raws) = &mut self.raws {
            let made = out.split_off(samples);
            self.missed += raws.look(&from, &mut self.tuple, out);
            out.extend(made);
        }
        self.read_log(out);
        if let Some(world) = &mut self.world {
            world.look(Instant::now(), out);
        }
    }

    /// What a recording that begins now must have first: facts, configuration, all nodes, and what each had last.
    pub fn beginning(&self) -> Vec<Entry> {
        let facts = Entry::Facts(ABOUT, Arc::new(self.facts()));
        let raws = self.raws.iter().flat_map(Raws::all);
        let nodes = self.watched.iter().chain(raws);
        let nodes = nodes.map(|watched| Entry::Node(watched.known.clone()));
        let newest = self.watched.iter().filter_map(|one| one.newest.clone());
        let first = [facts].into_iter().chain(self.text.clone());
        let world = self.world.iter().flat_map(World::beginning);
        first.chain(nodes).chain(newest).chain(world).collect()
    }

    /// The next look tells once more what is told only when it changes: it was lost.
    pub fn tell_again(&mut self) {
        self.configuration = NONE;
        self.is_told = false;
        if let Some(world) = &mut self.world {
            world.tell_again();
        }
    }

    /// Other nodes are wanted from now on; new ones come at once.
    pub fn want(&mut self, wants: Wants, out: &mut Vec<Entry>) {
        self.wants = wants;
        let (wants, root, is_replayed) = (&self.wants, &self.root, self.is_replayed);
        self.watched.retain_mut(|one| {
            let Some(wish) = wants(&one.known.node.path) else {
                return false;
            };
            if wish == one.wish {
                return true;
            }
            let opened = ring(root, &one.known.node, wish, is_replayed);
            let opened = opened.filter(|ring| ring.tuple_bytes() == one.ring.tuple_bytes());
            let is_same = one.ring.is_current() && opened.is_some();
            // Else it is found anew, as one of another daemon is.
            if let Some(opened) = opened.filter(|_| is_same) {
                one.reopen(opened, wish);
            }
            is_same
        });
        self.find(out);
    }

    /// Nodes that are wanted and not looked at yet.
    fn find(&mut self, out: &mut Vec<Entry>) {
        self.left_out.clear();
        for node in nodes::find(&self.root) {
            let is_known = |one: &Watched| one.known.node.path == node.path;
            let Some(wish) = (self.wants)(&node.path) else {
                continue;
            };
            if self.watched.iter().any(is_known) {
                continue;
            }
            match ring(&self.root, &node, wish, self.is_replayed) {
                Some(ring) => {
                    self.numbers += 1;
                    let watched = Watched::new(self.numbers, node, ring, wish);
                    out.push(Entry::Node(watched.known.clone()));
                    self.watched.push(watched);
                }
                None => {
                    self.left_out.insert(node.path);
                }
            }
        }
    }

    /// Looks after nodes whose rings have ended, the configuration and the clock.
    fn care(&mut self, out: &mut Vec<Entry>) {
        self.is_gone = !self.root.join("status").exists();
        if self.log.is_none() {
            self.log = log(&self.root);
        }
        let offset_ns = offset_ns();
        let is_set = (offset_ns - self.offset_ns).abs() > CLOCK_NS;
        if is_set || !self.is_told {
            self.offset_ns = offset_ns;
            self.is_told = true;
            out.push(Entry::Facts(ABOUT, Arc::new(self.facts())));
        }
        let path = self.root.join("config");
        let found = path.metadata();
        let found = found.map(|file| (file.len(), (file.mtime(), file.mtime_nsec())));
        if let Ok(found) = found
            && found != self.configuration
        {
            let mut text = Vec::new();
            let most = limits::CONFIG_BYTES_MAX;
            let read = File::open(&path).map(|file| file.take(most).read_to_end(&mut text));
            if read.is_ok_and(|read| read.is_ok()) {
                self.configuration = found;
                let entry =
                    Entry::Attachment(now_ns(), "config.lua".into(), "text/x-lua", text.into());
                self.text = Some(entry.clone());
                out.push(entry);
                // It may have other nodes.
                self.part(out);
                self.find(out);
            }
        }
        for watched in &mut self.watched {
            if watched.ring.is_current() {
                continue;
            }
            let (node, wish) = (&watched.known.node, watched.wish);
            let Some(ring) = ring(&self.root, node, wish, self.is_replayed) else {
                continue;
            };
            let mut node = watched.known.node.clone();
            let format = nodes::text(&self.root.join(&node.path).join("format"));
            node.format = format.unwrap_or_default();
            let mut fresh = Watched::new(watched.known.number, node, ring, watched.wish);
            if fresh.known.node.format != watched.known.node.format {
                // Of another format, it is another channel.
                self.numbers += 1;
                let node = fresh.known.node.clone();
                let number = self.numbers;
                fresh.known = Arc::new(Known { number, node });
            }
            *watched = fresh;
        }
        self.find_raws(out);
    }

    /// Nodes that have left the tree say so once: nothing else would tell a reader that their last value is none any more.
    fn part(&mut self, out: &mut Vec<Entry>) {
        let root = &self.root;
        self.watched.retain(|one| {
            let is_there = root.join(&one.known.node.path).join("bin_data").exists();
            if !is_there {
                let why = "the node has left the tree".into();
                out.push(Entry::Fault(one.known.clone(), now_ns(), LEFT, why));
            }
            is_there
        });
    }

    fn facts(&self) -> BTreeMap<String, String> {
        let boot = nodes::text(Path::new("/proc/sys/kernel/random/boot_id"));
        let host = nodes::text(Path::new("/proc/sys/kernel/hostname"));
        let all = [
            ("program", self.program.clone()),
            ("tree", self.root.display().to_string()),
            ("host", host.unwrap_or_default()),
            ("boot_id", boot.unwrap_or_default()),
            ("realtime_offset_ns", self.offset_ns.to_string()),
        ];
        all.into_iter()
            .map(|(key, value)| (key.to_owned(), value))
            .collect()
    }

    fn read_log(&mut self, out: &mut Vec<Entry>) {
        let Some(log) = &mut self.log else { return };
        let mut bytes = [0; 4096];
        // A log that is read to its end has nothing; what is too much for one look comes with the next.
        let count = match log.read(&mut bytes) {
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => 0,
            Err(_) => {
                // Its daemon is over; the next one has another.
                self.log = None;
                return;
            }
        };
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
                    out.push(Entry::Line(Story::Log, now_ns(), Arc::new(line)));
                }
                _ if self.line.len() < limits::LINE_BYTES_MAX => self.line.push(byte),
                _ => {}
            }
        }
    }
}

fn is_replayed(root: &Path) -> bool {
    let mut begin = [0; REPLAYED.len()];
    let file = File::open(root.join("config"));
    file.is_ok_and(|mut file| file.read_exact(&mut begin).is_ok()) && begin == *REPLAYED.as_bytes()
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
