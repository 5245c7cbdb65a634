//! What a person or a program can ask of a running replay: one line of its control file, or one key.
//!
//! Owns the words, the keys and the forms of times. Knows no recording.

use crate::limits;
use std::fmt;
use std::time::Duration;

/// A wish about the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Order {
    /// Stands.
    Pause,
    /// Runs; at the end, from the beginning.
    Go,
    /// The other of both.
    Toggle,
    /// Stands, after so many further events.
    Step(u32),
    /// Other seconds of the recording in a real one.
    Speed(f64),
    /// Twice as fast, or half.
    Double(bool),
    /// Another position.
    Seek(Seek),
    /// Begins again at the end, or stands there.
    Loop(bool),
}

/// A position to go to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Seek {
    /// From the beginning.
    To(Duration),
    /// From here on.
    Forward(Duration),
    /// From here back.
    Back(Duration),
}

impl Seek {
    /// The position, for one who is here.
    pub(crate) fn from(self, here: Duration) -> Duration {
        match self {
            Self::To(position) => position,
            Self::Forward(by) => here.saturating_add(by),
            Self::Back(by) => here.saturating_sub(by),
        }
    }
}

/// A line that is no order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum BadOrder {
    /// The first word is unknown.
    Word(String),
    /// What belongs after it is missing or has another form.
    Argument(Wanted),
}

/// An order whose form was not met.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Wanted {
    Step,
    Speed,
    Seek,
    Loop,
    /// A word and at most one number.
    Short,
    /// A word and nothing after it.
    WordAlone,
    /// A line that can be shown.
    Printable,
}

impl Wanted {
    /// Its form, in English.
    fn form(self) -> &'static str {
        match self {
            Self::Step => "step NUMBER, 1 to 1000000 events",
            Self::Speed => "speed NUMBER, 0.01 to 1000 times the real time",
            Self::Seek => "seek TIME: seconds, MINUTES:SECONDS, or +SECONDS and -SECONDS from here",
            Self::Loop => "loop on or loop off",
            Self::Short => "one word and at most one number after it",
            Self::WordAlone => "nothing after this word",
            Self::Printable => "one printable line",
        }
    }
}

impl fmt::Display for BadOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Word(word) => write!(
                f,
                "unknown word '{word}': pause, go, step [NUMBER], speed NUMBER, seek TIME, loop on, loop off"
            ),
            Self::Argument(wanted) => write!(f, "expected {}", wanted.form()),
        }
    }
}

impl Order {
    /// One line.
    pub(crate) fn read(line: &str) -> Result<Self, BadOrder> {
        let mut words = line.split_whitespace();
        let (first, second) = (words.next().unwrap_or_default(), words.next());
        let bad = |wanted| Err(BadOrder::Argument(wanted));
        if words.next().is_some() {
            return bad(Wanted::Short);
        }
        match (first, second) {
            ("pause", None) => Ok(Self::Pause),
            ("go", None) => Ok(Self::Go),
            ("pause" | "go", Some(_)) => bad(Wanted::WordAlone),
            ("step", None) => Ok(Self::Step(1)),
            ("step", Some(count)) => match count.parse() {
                Ok(count @ 1..=1_000_000) => Ok(Self::Step(count)),
                _ => bad(Wanted::Step),
            },
            ("speed", speed) => speed
                .and_then(speed_of)
                .map_or(bad(Wanted::Speed), |it| Ok(Self::Speed(it))),
            ("seek", time) => time
                .and_then(seek)
                .map_or(bad(Wanted::Seek), |it| Ok(Self::Seek(it))),
            ("loop", Some("on")) => Ok(Self::Loop(true)),
            ("loop", Some("off")) => Ok(Self::Loop(false)),
            ("loop", _) => bad(Wanted::Loop),
            (word, _) => Err(BadOrder::Word(word.chars().take(40).collect())),
        }
    }

    /// One key of a terminal.
    pub(crate) fn of_key(key: u8) -> Option<Self> {
        let forward = |seconds| Self::Seek(Seek::Forward(Duration::from_secs(seconds)));
        let back = |seconds| Self::Seek(Seek::Back(Duration::from_secs(seconds)));
        Some(match key {
            b' ' => Self::Toggle,
            b's' | b'.' => Self::Step(1),
            b'+' | b'=' => Self::Double(true),
            b'-' => Self::Double(false),
            b'f' => forward(5),
            b'b' => back(5),
            b'F' => forward(60),
            b'B' => back(60),
            b'0' => Self::Seek(Seek::To(Duration::ZERO)),
            _ => return None,
        })
    }
}

/// What the keys of [`Order::of_key`] do, in one line.
pub(crate) const KEYS: &str =
    "space stops and goes on, s step, f b 5 s, F B 60 s, 0 begin, + - speed";

/// A factor between real time and that of the recording.
pub(crate) fn speed_of(text: &str) -> Option<f64> {
    let range = limits::REPLAY_SPEED_MIN..=limits::REPLAY_SPEED_MAX;
    text.parse().ok().filter(|speed| range.contains(speed))
}

/// Seconds, or minutes and seconds.
pub(crate) fn time(text: &str) -> Option<Duration> {
    let number = |text: &str| -> Option<f64> {
        let plain = text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
        text.parse().ok().filter(|_| plain && !text.is_empty())
    };
    let seconds = match text.split_once(':') {
        Some((minutes, seconds)) => {
            let seconds = number(seconds).filter(|seconds| *seconds < 60.0)?;
            number(minutes).filter(|minutes| minutes.fract() == 0.0)? * 60.0 + seconds
        }
        None => number(text)?,
    };
    let fits = seconds <= limits::SEEK_S_MAX;
    fits.then(|| Duration::try_from_secs_f64(seconds).ok())
        .flatten()
}

fn seek(text: &str) -> Option<Seek> {
    match text.as_bytes().first()? {
        b'+' => time(&text[1..]).map(Seek::Forward),
        b'-' => time(&text[1..]).map(Seek::Back),
        _ => time(text).map(Seek::To),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_orders() {
        let s = Duration::from_secs_f64;
        for (line, order) in [
            ("pause", Order::Pause),
            (" go ", Order::Go),
            ("step", Order::Step(1)),
            ("step 20", Order::Step(20)),
            ("speed 0.5", Order::Speed(0.5)),
            ("seek 12.5", Order::Seek(Seek::To(s(12.5)))),
            ("seek 2:03.5", Order::Seek(Seek::To(s(123.5)))),
            ("seek +5", Order::Seek(Seek::Forward(s(5.0)))),
            ("seek -1:00", Order::Seek(Seek::Back(s(60.0)))),
            ("loop on", Order::Loop(true)),
        ] {
            assert_eq!(Order::read(line), Ok(order), "{line}");
        }
    }

    #[test]
    fn other_lines_are_refused_with_what_was_wanted() {
        for (line, reason) in [
            ("", "unknown word ''"),
            ("dance", "unknown word 'dance'"),
            ("pause 1", "expected nothing after this word"),
            ("go on now", "expected one word"),
            ("step 0", "expected step NUMBER"),
            ("step -1", "expected step NUMBER"),
            ("speed", "expected speed NUMBER"),
            ("speed nan", "expected speed NUMBER"),
            ("speed 1e9", "expected speed NUMBER"),
            ("seek", "expected seek TIME"),
            ("seek 1:99", "expected seek TIME"),
            ("seek inf", "expected seek TIME"),
            ("seek 99999999999999999999", "expected seek TIME"),
            ("seek +", "expected seek TIME"),
            ("seek --5", "expected seek TIME"),
            ("loop maybe", "expected loop on or loop off"),
        ] {
            let told = Order::read(line).unwrap_err().to_string();
            assert!(told.starts_with(reason), "{line}: {told}");
        }
    }

    #[test]
    fn the_keys_are_those_of_their_line() {
        for key in ["space", "s", "f", "b", "F", "B", "0", "+", "-"] {
            let byte = if key == "space" {
                b' '
            } else {
                key.as_bytes()[0]
            };
            assert!(Order::of_key(byte).is_some() && KEYS.contains(key), "{key}");
        }
        assert_eq!(Order::of_key(b'\x1b'), None);
    }
}
