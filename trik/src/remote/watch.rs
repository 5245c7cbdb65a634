//! `trik watch`: where the diagram that runs on a robot is, and what its variables hold, while it runs.
//!
//! Owns what a person sees: a picture that is drawn anew in a terminal, or a line for each change elsewhere. It only looks:
//! it takes no control and changes nothing.

use super::link::{Link, Message, ms};
use super::output::{harmless, say};
use super::target::{Target, target, the_one};
use crate::debug::listing::{Listing, listing_of};
use crate::debug::report::Report;
use crate::debug::stops::{standing, words};
use crate::debug::target::why_not;
use crate::debug::target::words::{ctrl_c_ends, seconds as unit, told as words_of_robot};
use crate::error::Error;
use crate::language;
use crate::limits;
use crate::refusal::{Refusal, UNREADABLE};
use clap::Args;
use lang_text::problem::Locale;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::io::{self, IsTerminal, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use trikd::protocol::news;

/// How often a robot is asked.
const PAUSE: Duration = Duration::from_millis(100);
/// Values that are drawn beside a variable.
const DRAWN: usize = 40;

/// What `trik watch` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct WatchArgs {
    /// The diagram that runs, a file NAME.qrs or NAME.flow: with it the sentence of each block is shown.
    pub file: Option<PathBuf>,
    /// The main diagram of FILE that runs, if it is not the first one.
    #[arg(long, value_name = "NAME", requires = "file")]
    pub diagram: Option<String>,
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
    /// End after this many seconds [default: with the program].
    #[arg(long, value_name = "SECONDS", value_parser = patience)]
    pub seconds: Option<Duration>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// How long somebody waits: `0.3`, in seconds.
///
/// # Errors
/// It is no time from 0.01 to 86400 s.
pub(super) fn patience(text: &str) -> Result<Duration, Error> {
    let seconds = text.trim().parse::<f64>().ok();
    let seconds = seconds.filter(|seconds| (0.01..=86_400.0).contains(seconds));
    let wanted = || Error::Refused("a number of seconds from 0.01 to 86400 is wanted".to_owned());
    seconds.map(Duration::from_secs_f64).ok_or_else(wanted)
}

/// Watches until the program has ended. The exit code: 0 it has ended, the time is over, or nobody reads any more, 1 no diagram runs, 2 the robot
/// could not be reached.
///
/// # Errors
/// The diagram cannot be read.
pub(crate) fn run(args: &WatchArgs) -> Result<u8, Refusal> {
    let listing = match &args.file {
        None => None,
        Some(file) => Some(listing_of(file, args.diagram.as_deref(), args.language)?),
    };
    Ok(match watch(args, listing.as_ref()) {
        Ok(code) => code,
        Err(error) => {
            say(&words_of_robot(&error.to_string(), args.language));
            UNREADABLE
        }
    })
}

fn watch(args: &WatchArgs, listing: Option<&Listing>) -> Result<u8, Error> {
    let target = match &args.robot {
        Some(target) => target.clone(),
        None => the_one()?,
    };
    let mut link = target.connect()?;
    link.speak(args.language);
    let until = args.seconds.map(|seconds| Instant::now() + seconds);
    let mut picture = Picture::new(listing, io::stdout().is_terminal(), args.language);
    let mut has_seen = false;
    for tag in 1u64.. {
        let answer = look(&mut link, tag, &mut picture.control)?;
        if let Some(why) = why_not(&answer) {
            let is_end = has_seen && why == news::NO_DIAGRAM;
            say(&match is_end {
                true => words::in_locale(args.language, words::has_ended()),
                false => words_of_robot(&why, args.language),
            });
            return Ok(u8::from(!is_end));
        }
        if let Some(told) = answer.get("program").and_then(Report::read) {
            has_seen = true;
            match picture.show(&told) {
                Err(error) if error.kind() == io::ErrorKind::BrokenPipe => break,
                shown => shown.map_err(|error| Error::system("standard output", error))?,
            }
        }
        if is_unread(io::stdout().as_fd()) {
            break;
        }
        // However short the time is, there is one look.
        if until.is_some_and(|until| Instant::now() >= until) {
            break;
        }
        let next = Instant::now() + PAUSE;
        let next = until.map_or(next, |until| next.min(until));
        while Instant::now() < next {
            while let Some(message) = link.next() {
                note_control(&message, &mut picture.control);
            }
            link.turn(next.saturating_duration_since(Instant::now()), None, true)?;
        }
    }
    Ok(0)
}

/// Whether nobody reads any more what is written there: the other end of a pipe is closed.
fn is_unread(output: BorrowedFd<'_>) -> bool {
    let mut output = [PollFd::new(output, PollFlags::empty())];
    let polled = poll(&mut output, PollTimeout::ZERO);
    let events = output[0].revents().unwrap_or(PollFlags::empty());
    polled.is_ok() && events.contains(PollFlags::POLLERR)
}

/// Hears who is in control of the debugger: an address, or nobody.
fn note_control(message: &Message, control: &mut Option<String>) {
    if let Message::Debug(text) = message
        && let Ok(told) = serde_json::from_str::<Value>(text)
        && let Some(holder) = told.get("control")
    {
        *control = holder.as_str().map(str::to_owned);
    }
}

/// Asks where the program is, and hears who is in control of its debugger.
pub(super) fn look(
    link: &mut Link,
    tag: u64,
    control: &mut Option<String>,
) -> Result<Value, Error> {
    link.ask(&[format!("debug:{tag} look").as_bytes()]);
    let deadline = Instant::now() + ms(limits::ANSWER_MS);
    while Instant::now() < deadline {
        while let Some(message) = link.next() {
            note_control(&message, control);
            let Message::Debug(text) = message else {
                continue;
            };
            let told: Value = serde_json::from_str(&text).unwrap_or_default();
            if told.get("to").and_then(Value::as_u64) == Some(tag) {
                return Ok(told);
            }
        }
        link.turn(ms(limits::TURN_MS), None, true)?;
    }
    Err(Error::Robot(format!(
        "{} has not answered for {} s: perhaps its trikd is older than this program",
        link.name(),
        limits::ANSWER_MS / 1000
    )))
}

/// What is shown.
struct Picture<'a> {
    listing: Option<&'a Listing>,
    is_drawn: bool,
    locale: Locale,
    /// The last values of each variable that is a number.
    values: BTreeMap<String, VecDeque<f64>>,
    /// The address of who is in control of the debugger.
    control: Option<String>,
    last: Vec<String>,
}

impl<'a> Picture<'a> {
    fn new(listing: Option<&'a Listing>, is_drawn: bool, locale: Locale) -> Self {
        Self {
            listing,
            is_drawn,
            locale,
            values: BTreeMap::new(),
            control: None,
            last: Vec::new(),
        }
    }

    fn show(&mut self, told: &Report) -> io::Result<()> {
        let lines = self.lines(told);
        let mut out = io::stdout().lock();
        if self.is_drawn {
            // To the top, each line to its end, and nothing below.
            let mut text = String::from("\x1b[H");
            let seconds = told.ms as f64 / 1000.0;
            let (s, end) = (unit().in_locale(self.locale).to_owned(), ctrl_c_ends());
            let end = end.in_locale(self.locale);
            text.push_str(&format!("{seconds:.1} {s}, {end}\x1b[K\n\x1b[K\n"));
            for line in &lines {
                text.push_str(line);
                text.push_str("\x1b[K\n");
            }
            text.push_str("\x1b[J");
            if self.last.is_empty() {
                out.write_all(b"\x1b[2J")?;
            }
            out.write_all(text.as_bytes())?;
            self.last = lines;
            return out.flush();
        }
        if lines != self.last {
            let seconds = told.ms as f64 / 1000.0;
            let s = unit();
            let s = s.in_locale(self.locale);
            writeln!(out, "{seconds:.2} {s}  {}", lines.join("; "))?;
            self.last = lines;
            out.flush()?;
        }
        Ok(())
    }

    /// Whether it stands still, threads, then variables, then ports of a data-flow program.
    fn lines(&mut self, told: &Report) -> Vec<String> {
        let mut lines: Vec<String> = standing(told, self.listing, self.locale)
            .into_iter()
            .collect();
        if self.is_drawn && !lines.is_empty() {
            lines.push(String::new());
        }
        for thread in told.threads.iter().take(limits::WATCH_LINES_MAX) {
            let place = match self.listing {
                Some(listing) if listing.has(&thread.at.id) => {
                    let line = listing.line_of(&thread.at.id);
                    format!("{line}: {}", listing.text(line).trim())
                }
                Some(_) | None => harmless(&thread.at.block),
            };
            let name = harmless(&thread.name);
            lines.push(match self.is_drawn {
                true => format!(
                    "{name:12} {:22} {place}",
                    harmless(&thread.doing(self.locale))
                ),
                false => format!("{name}: {place}"),
            });
        }
        if !told.held.is_empty() {
            let names = harmless(&told.held.join(", "));
            lines.push(words::in_locale(self.locale, words::held(&names)));
        }
        if self.is_drawn && !told.variables.is_empty() {
            lines.push(String::new());
        }
        let names = told.variables.iter().map(|variable| &variable.name);
        let names: BTreeSet<&String> = names.take(limits::WATCH_LINES_MAX).collect();
        self.values.retain(|name, _| names.contains(name));
        for variable in told.variables.iter().take(limits::WATCH_LINES_MAX) {
            let (name, value) = (harmless(&variable.name), harmless(&variable.value));
            if !self.is_drawn {
                lines.push(format!("{name} = {value}"));
                continue;
            }
            let spark = match variable.value.parse::<f64>() {
                Ok(number) if number.is_finite() => self.spark(&variable.name, number),
                Ok(_) | Err(_) => String::new(),
            };
            lines.push(format!("{name:12} {value:>14.14}  {spark}"));
        }
        if self.is_drawn && !told.ports.is_empty() {
            lines.push(String::new());
        }
        lines.extend(self.ports(told));
        if let Some(holder) = &self.control {
            lines.push(harmless(&words_of_robot(
                &news::in_control(holder),
                self.locale,
            )));
        }
        lines
    }

    /// The last token of each port, and tokens that wait or are lost.
    fn ports(&mut self, told: &Report) -> Vec<String> {
        let mut lines = Vec::new();
        for port in told.ports.iter().take(limits::WATCH_LINES_MAX) {
            let (name, value) = (harmless(&port.full_name()), harmless(&port.value));
            lines.push(match self.is_drawn {
                true => format!("{name:24} {value:>14.14}  {:>8}", port.count),
                false => format!("{name} -> {value}"),
            });
        }
        for port in told.waiting.iter().take(limits::WATCH_LINES_MAX) {
            let name = harmless(&port.full_name());
            let words = words::waiting(&name, port.count, port.lost);
            lines.push(words::in_locale(self.locale, words));
        }
        lines
    }

    /// The last values of a variable, from its least to its greatest.
    fn spark(&mut self, name: &str, number: f64) -> String {
        let values = self.values.entry(name.to_owned()).or_default();
        if values.len() == DRAWN {
            values.pop_front();
        }
        values.push_back(number);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let bar = |value: &f64| {
            let part = match most > least {
                true => (value - least) / (most - least),
                false => 0.0,
            };
            // From a block of one eighth to a full one.
            char::from_u32(0x2581 + (part * 7.0).round() as u32).unwrap_or('?')
        };
        values.iter().map(bar).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_times_are_times_and_others_are_refused_in_words() {
        for (text, ms) in [("0.3", 300), ("0.01", 10), ("2", 2000)] {
            assert_eq!(patience(text), Ok(Duration::from_millis(ms)));
        }
        for text in ["0", "-1", "NaN", "inf", "1e9", "soon", ""] {
            let why = patience(text).unwrap_err().to_string();
            assert!(why.contains("from 0.01 to 86400"), "{text}: {why}");
        }
    }

    #[test]
    fn a_pipe_whose_other_end_is_closed_is_not_read() {
        let (reader, writer) = io::pipe().unwrap();
        assert!(!is_unread(writer.as_fd()));
        drop(reader);
        assert!(is_unread(writer.as_fd()));
    }

    #[test]
    fn threads_that_are_held_are_shown() {
        let told = serde_json::json!({
            "state": "running",
            "threads": [{"name": "main", "at": {"block": "Timer"}}],
            "held": ["other", "third"],
        });
        let told = Report::read(&told).expect("a state");
        let mut picture = Picture::new(None, false, Locale::English);
        assert_eq!(picture.lines(&told), ["main: Timer", "held: other, third"]);
    }

    #[test]
    fn the_last_values_of_a_variable_are_drawn() {
        let mut picture = Picture::new(None, true, Locale::English);
        for value in [0.0, 7.0, 3.5] {
            picture.spark("n", value);
        }
        assert_eq!(picture.spark("n", 7.0), "\u{2581}\u{2588}\u{2585}\u{2588}");
        for _ in 0..100 {
            picture.spark("n", 1.0);
        }
        assert_eq!(picture.spark("n", 1.0), "\u{2581}".repeat(DRAWN));
    }
}
