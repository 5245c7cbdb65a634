//! The log: events of `tracing` as lines on standard error, for the person who looks after the robot.
//!
//! Owns the form of a line, which events become one, and how many may: a hostile client can neither forge a line nor
//! fill a disk. What is worth an event is known where it happens.

use crate::limits;
use std::fmt::{self, Write as _};
use std::io::Write as _;
use std::os::unix::fs::MetadataExt;
use std::str::FromStr;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;
use tracing::field::{Field, Visit};
use tracing::metadata::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Who comes, goes and is refused, on all ports.
pub const CLIENTS: &str = "clients";
/// The life of programs: uploads, starts, ends.
pub const PROGRAMS: &str = "programs";
/// The tree and what moves: rest, motors that do not come to rest.
pub const TREE: &str = "tree";
/// The daemon itself: start, end, crashes, its files.
pub const DAEMON: &str = "daemon";

const TARGETS: [&str; 4] = [CLIENTS, PROGRAMS, TREE, DAEMON];

/// Which events become lines: a level for all targets, and others for some.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Filter([LevelFilter; TARGETS.len()]);

impl Default for Filter {
    fn default() -> Self {
        Self([LevelFilter::INFO; TARGETS.len()])
    }
}

/// A text that is no filter.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoFilter {
    /// A word instead of a level.
    Level(String),
    /// Nothing that lines are about.
    Target(String),
}

impl fmt::Display for NoFilter {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Level(word) => write!(
                out,
                "'{word}' is no level: off, error, warn, info, debug, trace"
            ),
            Self::Target(target) => write!(
                out,
                "there are no lines about '{target}', but about {}",
                TARGETS.join(", ")
            ),
        }
    }
}

impl std::error::Error for NoFilter {}

fn level(word: &str) -> Result<LevelFilter, NoFilter> {
    match word {
        "off" => Ok(LevelFilter::OFF),
        "error" => Ok(LevelFilter::ERROR),
        "warn" => Ok(LevelFilter::WARN),
        "info" => Ok(LevelFilter::INFO),
        "debug" => Ok(LevelFilter::DEBUG),
        "trace" => Ok(LevelFilter::TRACE),
        _ => Err(NoFilter::Level(word.to_owned())),
    }
}

impl FromStr for Filter {
    type Err = NoFilter;

    /// Such as `warn`, or `info,clients=off`; the empty text is the default.
    fn from_str(text: &str) -> Result<Self, NoFilter> {
        let mut filter = Self::default();
        for part in text
            .split(',')
            .map(str::trim)
            .filter(|part| !part.is_empty())
        {
            match part.split_once('=') {
                None => filter.0 = [level(part)?; TARGETS.len()],
                Some((target, word)) => {
                    let index = TARGETS
                        .iter()
                        .position(|known| *known == target)
                        .ok_or_else(|| NoFilter::Target(target.to_owned()))?;
                    filter.0[index] = level(word)?;
                }
            }
        }
        Ok(filter)
    }
}

/// So many lines at once, and so many in a second in the long run.
#[derive(Debug)]
struct Bucket {
    left: f32,
    most: f32,
    per_second: f32,
    at: Instant,
    dropped: u32,
}

impl Bucket {
    fn new(most: f32, per_second: f32) -> Self {
        Self {
            left: most,
            most,
            per_second,
            at: Instant::now(),
            dropped: 0,
        }
    }

    /// How many were left out before this one, if this one may be written.
    fn admits(&mut self, now: Instant) -> Option<u32> {
        let passed = now.saturating_duration_since(self.at).as_secs_f32();
        self.at = now;
        self.left = (self.left + passed * self.per_second).min(self.most);
        if self.left < 1.0 {
            self.dropped = self.dropped.saturating_add(1);
            return None;
        }
        self.left -= 1.0;
        Some(std::mem::take(&mut self.dropped))
    }
}

/// Where events go.
struct Lines {
    filter: Filter,
    start: Instant,
    /// Standard error is the journal of systemd, which knows the time and wants the level as a number.
    is_journal: bool,
    /// One for each target, and one for all that is said only on demand.
    buckets: Mutex<Vec<Bucket>>,
}

/// Whether standard error is what systemd says (systemd.exec(5), JOURNAL_STREAM: device and inode).
fn is_journal() -> bool {
    let told = std::env::var("JOURNAL_STREAM").unwrap_or_default();
    let own = std::fs::metadata("/proc/self/fd/2");
    own.is_ok_and(|own| told == format!("{}:{}", own.dev(), own.ino()))
}

/// Begins to write lines; before, and in a process that does not call this, events cost nothing.
pub fn start(filter: &Filter) {
    let burst = |_| Bucket::new(limits::LOG_BURST, limits::LOG_LINES_PER_MINUTE / 60.0);
    let mut buckets: Vec<_> = TARGETS.iter().map(burst).collect();
    let fast = limits::LOG_VERBOSE_LINES_PER_SECOND;
    buckets.push(Bucket::new(fast, fast));
    // The first call counts.
    let _ = tracing::subscriber::set_global_default(Lines {
        filter: filter.clone(),
        start: Instant::now(),
        is_journal: is_journal(),
        buckets: Mutex::new(buckets),
    });
}

/// The number of a level in syslog(3).
fn priority(level: Level) -> u8 {
    match level {
        Level::ERROR => 3,
        Level::WARN => 4,
        Level::INFO => 6,
        _ => 7,
    }
}

impl Lines {
    /// The beginning of a line.
    fn head(&self, level: Level, target: &str) -> String {
        let mut head = if self.is_journal {
            format!("<{}>", priority(level))
        } else {
            format!("trikd: {:.3} ", self.start.elapsed().as_secs_f64())
        };
        let word = match level {
            Level::ERROR => "error",
            Level::WARN => "warning",
            Level::INFO => "info",
            Level::DEBUG => "debug",
            _ => "trace",
        };
        let _ = write!(head, "{word} {target}: ");
        head
    }

    fn admits(&self, level: Level, target: usize) -> Option<u32> {
        let mut buckets = self.buckets.lock().unwrap_or_else(PoisonError::into_inner);
        let index = if level > Level::INFO {
            TARGETS.len()
        } else {
            target
        };
        buckets.get_mut(index)?.admits(Instant::now())
    }
}

fn target(metadata: &Metadata<'_>) -> Option<usize> {
    TARGETS
        .iter()
        .position(|target| *target == metadata.target())
}

impl Subscriber for Lines {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_event()
            && target(metadata).is_some_and(|index| *metadata.level() <= self.filter.0[index])
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        self.filter.0.iter().max().copied()
    }

    fn event(&self, event: &Event<'_>) {
        let (level, name) = (*event.metadata().level(), event.metadata().target());
        let admitted = target(event.metadata()).and_then(|index| self.admits(level, index));
        let Some(dropped) = admitted else { return };
        let head = self.head(level, name);
        let mut lines = String::new();
        if dropped > 0 {
            let _ = writeln!(
                lines,
                "{head}{dropped} lines were left out: there were too many"
            );
        }
        let mut text = Text::default();
        event.record(&mut text);
        let _ = writeln!(
            lines,
            "{head}{}{}",
            printable(&text.message),
            printable(&text.fields)
        );
        // Nobody may be listening. One write, so that lines of several processes stay whole.
        let _ = std::io::stderr().write_all(lines.as_bytes());
    }

    // Nothing here has a duration that is worth a line.
    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }
    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// What an event says: its message, and the other fields after it.
#[derive(Default)]
struct Text {
    message: String,
    fields: String,
}

impl Visit for Text {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        let _ = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, " {name}={value:?}"),
        };
    }
}

/// Whether a character could make a terminal or an editor show something else than what is written: control
/// characters, separators of lines, changes of the direction of writing (Unicode TR 36).
fn deceives(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// One line outside of any log. Nobody may be listening.
pub fn report(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "trikd: {text}");
}

/// Text of strangers on one line and of a bearable length.
pub fn printable(text: &str) -> String {
    let limit = limits::LOG_LINE_CHARACTERS;
    let plain = |c| if deceives(c) { ' ' } else { c };
    let mut short: String = text.chars().take(limit).map(plain).collect();
    if text.chars().nth(limit).is_some() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn levels_are_told_for_all_and_for_some() {
        let filter = |text: &str| text.parse::<Filter>();
        assert_eq!(filter(""), Ok(Filter::default()));
        assert_eq!(
            filter("warn, programs=debug").unwrap().0,
            [
                LevelFilter::WARN,
                LevelFilter::DEBUG,
                LevelFilter::WARN,
                LevelFilter::WARN
            ]
        );
        assert!(
            filter("loud")
                .unwrap_err()
                .to_string()
                .contains("off, error, warn")
        );
        assert!(
            filter("cats=info")
                .unwrap_err()
                .to_string()
                .contains("clients, pro")
        );
    }

    #[test]
    fn no_more_lines_pass_than_a_disk_bears() {
        let mut bucket = Bucket::new(3.0, 0.5);
        let start = Instant::now();
        let passed = (0..100).filter(|_| bucket.admits(start).is_some());
        assert_eq!(passed.count(), 3);
        assert_eq!(bucket.admits(start + Duration::from_secs(1)), None);
        let later = start + Duration::from_secs(2);
        assert_eq!(bucket.admits(later), Some(98));
        assert_eq!(bucket.admits(later), None);
        let tomorrow = start + Duration::from_secs(86_400);
        assert_eq!(bucket.admits(tomorrow), Some(1));
        assert_eq!(bucket.admits(tomorrow), Some(0));
    }

    #[test]
    fn a_stranger_writes_neither_lines_nor_colours() {
        assert_eq!(printable("a\nb\x1b[31m\u{202e}c"), "a b [31m c");
        let long = "x".repeat(limits::LOG_LINE_CHARACTERS);
        assert_eq!(printable(&long), long);
        assert!(printable(&format!("{long}\u{1f916}")).ends_with("x..."));
    }
}
