//! Lines of a gamepad, port 4444.
//!
//! Owns which lines are passed on to the robot and what a line does to the clock of its client.

/// What a line says.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Line {
    /// To be passed on as it is written here.
    Command(String),
    /// The client will be silent for at most so many milliseconds; 0: for as long as it likes.
    Keepalive(u32),
    /// Makes no sense and why; it shows all the same that the client is there.
    Nonsense(&'static str),
}

fn within(word: Option<&str>, least: i32, greatest: i32) -> Option<i32> {
    word?
        .parse()
        .ok()
        .filter(|number| (least..=greatest).contains(number))
}

fn pad(words: &[&str]) -> Line {
    let Some(id) = within(words.first().copied(), 1, 2) else {
        return Line::Nonsense("a pad is 1 or 2");
    };
    if words.get(1) == Some(&"up") {
        return Line::Command(format!("pad {id} up"));
    }
    let number = |index: usize| within(words.get(index).copied(), -100, 100);
    match (number(1), number(2)) {
        (Some(x), Some(y)) => Line::Command(format!("pad {id} {x} {y}")),
        _ => Line::Nonsense("a pad has x and y from -100 to 100, or up"),
    }
}

fn button(words: &[&str]) -> Line {
    let Some(number) = within(words.first().copied(), 1, 5) else {
        return Line::Nonsense("a button is 1 to 5");
    };
    let is_down = words.get(1).is_none_or(|word| *word == "down");
    Line::Command(format!(
        "btn {number} {}",
        if is_down { "down" } else { "up" }
    ))
}

impl Line {
    /// What a line without its newline says. Empty words are dropped, so blanks at the end are fine.
    pub fn parse(line: &[u8]) -> Self {
        let Ok(text) = std::str::from_utf8(line) else {
            return Self::Nonsense("not UTF-8");
        };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words.split_first() {
            Some((&"pad", rest)) => pad(rest),
            Some((&"btn", rest)) => button(rest),
            Some((&"wheel", rest)) => match within(rest.first().copied(), -100, 100) {
                Some(percent) => Self::Command(format!("wheel {percent}")),
                None => Self::Nonsense("a wheel has a percentage from -100 to 100"),
            },
            Some((&"keepalive", rest)) => match rest.first().and_then(|word| word.parse().ok()) {
                Some(wait_ms) => Self::Keepalive(wait_ms),
                None => Self::Nonsense("a keepalive has a number of milliseconds"),
            },
            Some((&"custom", _)) if !text.bytes().any(|byte| byte.is_ascii_control()) => {
                Self::Command(text.trim().to_owned())
            }
            Some(_) => Self::Nonsense("not pad, btn, wheel, keepalive or custom"),
            None => Self::Nonsense("empty"),
        }
    }
}

/// Lines in a stream of bytes; longer ones than `limit` are dropped whole.
#[derive(Debug)]
pub struct Lines {
    buffer: Vec<u8>,
    skips: bool,
    limit: usize,
}

impl Lines {
    /// For lines of at most `limit` bytes.
    pub fn new(limit: usize) -> Self {
        Self {
            buffer: Vec::new(),
            skips: false,
            limit,
        }
    }

    /// Takes the next bytes and hands over the lines that are whole.
    pub fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(&[u8])) {
        for piece in bytes.split_inclusive(|byte| *byte == b'\n') {
            let (piece, is_whole) = match piece.strip_suffix(b"\n") {
                Some(piece) => (piece, true),
                None => (piece, false),
            };
            if self.buffer.len() + piece.len() > self.limit {
                self.skips = true;
                self.buffer.clear();
            } else if !self.skips {
                self.buffer.extend_from_slice(piece);
            }
            if is_whole {
                if !std::mem::take(&mut self.skips) {
                    take(&self.buffer);
                }
                self.buffer.clear();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_both_applications_are_understood() {
        for (line, command) in [
            ("pad 1 0 100 ", "pad 1 0 100"),
            ("pad 2 up", "pad 2 up"),
            ("btn 3", "btn 3 down"),
            ("btn 3 down", "btn 3 down"),
            ("btn 3 off", "btn 3 up"),
            ("wheel -57\r", "wheel -57"),
            ("custom one two", "custom one two"),
        ] {
            assert_eq!(
                Line::parse(line.as_bytes()),
                Line::Command(command.to_owned()),
                "{line}"
            );
        }
        assert_eq!(Line::parse(b"keepalive 4000"), Line::Keepalive(4000));
    }

    #[test]
    fn nonsense_is_told_and_not_passed_on() {
        let lines = "wheel|keepalive|pad|pad 3 1 1|pad 1 101 0|pad 1 1|btn 0|btn x|keepalive -1|jump||custom a\u{7}";
        for line in lines.split('|') {
            assert!(
                matches!(Line::parse(line.as_bytes()), Line::Nonsense(_)),
                "{line}"
            );
        }
        assert!(matches!(Line::parse(b"\xff"), Line::Nonsense(_)));
    }

    #[test]
    fn a_line_without_an_end_costs_no_memory_and_the_next_one_counts() {
        let mut lines = Lines::new(8);
        let mut got = Vec::new();
        for piece in [&b"a\nb"[..], b"c\n", b"123456789", b"0\nd\n", b"12345678\n"] {
            lines.feed(piece, |line| {
                got.push(String::from_utf8_lossy(line).into_owned())
            });
        }
        assert_eq!(got, ["a", "bc", "d", "12345678"]);
    }
}
