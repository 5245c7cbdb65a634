//! Lua patterns (manual of Lua 5.1, section 5.4.1) with a limit of steps: the matcher behind `find`, `match`, `gmatch`
//! and `gsub`, because the ones in the Lua library loop in C where no budget reaches them.
//!
//! A recursive matcher as in the reference implementation, with the same error texts. Pure; positions are from 0.

use crate::limits::{CAPTURES_MAX, PATTERN_DEPTH_MAX, PATTERN_STEPS_MAX};

const ESCAPE: u8 = b'%';

/// Where a pattern matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Match {
    /// First byte.
    pub(crate) start: usize,
    /// Behind the last byte.
    pub(crate) end: usize,
    captures: [Capture; CAPTURES_MAX],
    count: usize,
}

impl Match {
    /// The captures in order; none if the pattern has none.
    pub(crate) fn captures(&self) -> &[Capture] {
        self.captures.get(..self.count).unwrap_or_default()
    }
}

/// One capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Capture {
    /// `(...)` that is not closed yet; never in a result.
    Open(usize),
    /// Bytes from, to.
    Text(usize, usize),
    /// `()`: a position.
    Position(usize),
}

/// Finds the first match of `pattern` in `subject` from byte `from` on. With `anchors`, a leading `^` ties the match to
/// `from`.
///
/// # Errors
/// A malformed pattern, or too many steps; the text is for the Lua program.
pub(crate) fn find(
    subject: &[u8],
    pattern: &[u8],
    from: usize,
    anchors: bool,
) -> Result<Option<Match>, &'static str> {
    let anchored = anchors && pattern.first() == Some(&b'^');
    let mut matcher = Matcher {
        subject,
        pattern,
        captures: [Capture::Open(0); CAPTURES_MAX],
        count: 0,
        depth: 0,
        steps: PATTERN_STEPS_MAX,
    };
    let mut start = from;
    while start <= subject.len() {
        matcher.count = 0;
        if let Some(end) = matcher.attempt(start, usize::from(anchored))? {
            return matcher.result(start, end).map(Some);
        }
        if anchored {
            break;
        }
        start += 1;
    }
    Ok(None)
}

/// Finds the bytes `wanted` in `subject` from byte `from` on.
///
/// # Errors
/// Too many steps.
pub(crate) fn find_plain(
    subject: &[u8],
    wanted: &[u8],
    from: usize,
) -> Result<Option<usize>, &'static str> {
    let Some(first) = wanted.first() else {
        return Ok((from <= subject.len()).then_some(from));
    };
    let mut steps = PATTERN_STEPS_MAX as usize;
    let mut at = from;
    while let Some(rest) = subject.get(at..).filter(|rest| rest.len() >= wanted.len()) {
        let Some(skipped) = rest.iter().position(|byte| byte == first) else {
            break;
        };
        at += skipped;
        let equal = subject
            .iter()
            .skip(at)
            .zip(wanted)
            .take_while(|(a, b)| a == b)
            .count();
        if equal == wanted.len() {
            return Ok(Some(at));
        }
        // Skipping to the first byte is as cheap as reading the text once; only comparisons can multiply.
        steps = steps.checked_sub(equal).ok_or(TOO_LONG)?;
        at += 1;
    }
    Ok(None)
}

const TOO_LONG: &str = "pattern match takes too long";

type Step = Result<Option<usize>, &'static str>;

struct Matcher<'a> {
    subject: &'a [u8],
    pattern: &'a [u8],
    captures: [Capture; CAPTURES_MAX],
    count: usize,
    depth: u32,
    steps: u32,
}

impl Matcher<'_> {
    fn result(&self, start: usize, end: usize) -> Result<Match, &'static str> {
        let captures = self.captures.get(..self.count).unwrap_or_default();
        if captures.iter().any(|c| matches!(c, Capture::Open(_))) {
            return Err("unfinished capture");
        }
        Ok(Match {
            start,
            end,
            captures: self.captures,
            count: self.count,
        })
    }

    fn step(&mut self) -> Result<(), &'static str> {
        self.steps = self.steps.checked_sub(1).ok_or(TOO_LONG)?;
        Ok(())
    }

    fn at(&self, p: usize) -> Option<u8> {
        self.pattern.get(p).copied()
    }

    /// Matches the pattern from `p` at `s`: the end of the match.
    fn attempt(&mut self, s: usize, p: usize) -> Step {
        if self.depth == PATTERN_DEPTH_MAX {
            return Err("pattern too complex");
        }
        self.depth += 1;
        let end = self.attempt_here(s, p);
        self.depth -= 1;
        end
    }

    fn attempt_here(&mut self, mut s: usize, mut p: usize) -> Step {
        loop {
            self.step()?;
            match (self.at(p), self.at(p + 1)) {
                (None, _) => return Ok(Some(s)),
                (Some(b'('), Some(b')')) => {
                    return self.open_capture(s, p + 2, Capture::Position(s));
                }
                (Some(b'('), _) => return self.open_capture(s, p + 1, Capture::Open(s)),
                (Some(b')'), _) => return self.close_capture(s, p + 1),
                (Some(b'$'), None) => return Ok((s == self.subject.len()).then_some(s)),
                (Some(ESCAPE), Some(b'b')) => match self.balance(s, p + 2)? {
                    Some(end) => (s, p) = (end, p + 4),
                    None => return Ok(None),
                },
                (Some(ESCAPE), Some(b'f')) => match self.frontier(s, p + 2)? {
                    Some(behind) => p = behind,
                    None => return Ok(None),
                },
                (Some(ESCAPE), Some(digit)) if digit.is_ascii_digit() => {
                    match self.back_reference(s, digit)? {
                        Some(end) => (s, p) = (end, p + 2),
                        None => return Ok(None),
                    }
                }
                _ => {
                    let behind = self.class_end(p)?;
                    match self.at(behind) {
                        Some(b'?') => {
                            if self.single(s, p, behind)?
                                && let Some(end) = self.attempt(s + 1, behind + 1)?
                            {
                                return Ok(Some(end));
                            }
                            p = behind + 1;
                        }
                        Some(b'*') => return self.longest(s, p, behind),
                        Some(b'+') => {
                            return if self.single(s, p, behind)? {
                                self.longest(s + 1, p, behind)
                            } else {
                                Ok(None)
                            };
                        }
                        Some(b'-') => return self.shortest(s, p, behind),
                        _ if self.single(s, p, behind)? => (s, p) = (s + 1, behind),
                        _ => return Ok(None),
                    }
                }
            }
        }
    }

    fn longest(&mut self, s: usize, p: usize, behind: usize) -> Step {
        let mut more = 0;
        while self.single(s + more, p, behind)? {
            more += 1;
        }
        loop {
            if let Some(end) = self.attempt(s + more, behind + 1)? {
                return Ok(Some(end));
            }
            if more == 0 {
                return Ok(None);
            }
            more -= 1;
        }
    }

    fn shortest(&mut self, mut s: usize, p: usize, behind: usize) -> Step {
        loop {
            if let Some(end) = self.attempt(s, behind + 1)? {
                return Ok(Some(end));
            }
            if !self.single(s, p, behind)? {
                return Ok(None);
            }
            s += 1;
        }
    }

    fn open_capture(&mut self, s: usize, p: usize, capture: Capture) -> Step {
        let place = self
            .captures
            .get_mut(self.count)
            .ok_or("too many captures")?;
        *place = capture;
        self.count += 1;
        let end = self.attempt(s, p)?;
        if end.is_none() {
            self.count -= 1;
        }
        Ok(end)
    }

    fn close_capture(&mut self, s: usize, p: usize) -> Step {
        let captures = self.captures.get(..self.count).unwrap_or_default();
        let open = captures.iter().rposition(|c| matches!(c, Capture::Open(_)));
        let index = open.ok_or("invalid pattern capture")?;
        let before = self.captures[index];
        if let Capture::Open(start) = before {
            self.captures[index] = Capture::Text(start, s);
        }
        let end = self.attempt(s, p)?;
        if end.is_none() {
            self.captures[index] = before;
        }
        Ok(end)
    }

    /// `%bxy`, with `x` at `p`.
    fn balance(&mut self, s: usize, p: usize) -> Step {
        let (Some(open), Some(close)) = (self.at(p), self.at(p + 1)) else {
            return Err("unbalanced pattern");
        };
        if self.subject.get(s) != Some(&open) {
            return Ok(None);
        }
        let mut depth = 1;
        let mut at = s + 1;
        while let Some(&byte) = self.subject.get(at) {
            self.step()?;
            at += 1;
            if byte == close {
                depth -= 1;
                if depth == 0 {
                    return Ok(Some(at));
                }
            } else if byte == open {
                depth += 1;
            }
        }
        Ok(None)
    }

    /// `%f[set]`, with `[` at `p`: the pattern's position after the set.
    fn frontier(&mut self, s: usize, p: usize) -> Step {
        if self.at(p) != Some(b'[') {
            return Err("missing '[' after '%f' in pattern");
        }
        let behind = self.class_end(p)?;
        // Both ends of the subject count as a zero byte.
        let before = s
            .checked_sub(1)
            .and_then(|i| self.subject.get(i))
            .copied()
            .unwrap_or(0);
        let after = self.subject.get(s).copied().unwrap_or(0);
        let here = !self.in_set(before, p, behind) && self.in_set(after, p, behind);
        Ok(here.then_some(behind))
    }

    fn back_reference(&mut self, s: usize, digit: u8) -> Step {
        let index = usize::from(digit)
            .checked_sub(usize::from(b'1'))
            .filter(|i| *i < self.count);
        let Some(Capture::Text(from, to)) = index.and_then(|i| self.captures.get(i)).copied()
        else {
            return Err("invalid capture index");
        };
        for _ in from..to {
            self.step()?;
        }
        let (text, rest) = (self.subject.get(from..to), self.subject.get(s..));
        let equal = text
            .zip(rest)
            .is_some_and(|(text, rest)| rest.starts_with(text));
        Ok(equal.then_some(s + (to - from)))
    }

    /// The pattern's position after the single-character class at `p`.
    fn class_end(&mut self, p: usize) -> Result<usize, &'static str> {
        match self.at(p) {
            Some(ESCAPE) => match self.at(p + 1) {
                Some(_) => Ok(p + 2),
                None => Err("malformed pattern (ends with '%')"),
            },
            Some(b'[') => {
                let mut q = p + 1;
                if self.at(q) == Some(b'^') {
                    q += 1;
                }
                // A `]` that comes first stands for itself.
                loop {
                    self.step()?;
                    match self.at(q) {
                        None => return Err("malformed pattern (missing ']')"),
                        Some(ESCAPE) if self.at(q + 1).is_none() => {
                            return Err("malformed pattern (ends with '%')");
                        }
                        Some(ESCAPE) => q += 2,
                        Some(_) => q += 1,
                    }
                    if self.at(q) == Some(b']') {
                        return Ok(q + 1);
                    }
                }
            }
            _ => Ok(p + 1),
        }
    }

    /// Does the byte at `s` match the class from `p` up to `behind`? Costs a step, and more for a long set.
    fn single(&mut self, s: usize, p: usize, behind: usize) -> Result<bool, &'static str> {
        let cost = 1 + (behind - p) / 16;
        self.steps = u32::try_from(cost)
            .ok()
            .and_then(|cost| self.steps.checked_sub(cost))
            .ok_or(TOO_LONG)?;
        let Some(&byte) = self.subject.get(s) else {
            return Ok(false);
        };
        Ok(match (self.at(p), self.at(p + 1)) {
            (Some(b'.'), _) => true,
            (Some(ESCAPE), Some(class)) => in_class(byte, class),
            (Some(b'['), _) => self.in_set(byte, p, behind),
            (own, _) => own == Some(byte),
        })
    }

    /// Is the byte in the set `[...]` from `p` up to `behind`?
    fn in_set(&self, byte: u8, p: usize, behind: usize) -> bool {
        let last = behind - 1;
        let inverted = self.at(p + 1) == Some(b'^');
        let mut q = if inverted { p + 2 } else { p + 1 };
        while q < last {
            match (self.at(q), self.at(q + 1), self.at(q + 2)) {
                (Some(ESCAPE), Some(class), _) => {
                    if in_class(byte, class) {
                        return !inverted;
                    }
                    q += 2;
                }
                (Some(from), Some(b'-'), Some(to)) if q + 2 < last => {
                    if (from..=to).contains(&byte) {
                        return !inverted;
                    }
                    q += 3;
                }
                (own, _, _) => {
                    if own == Some(byte) {
                        return !inverted;
                    }
                    q += 1;
                }
            }
        }
        inverted
    }
}

/// `%a` and its like; an upper-case letter is the complement, any other character is itself.
fn in_class(byte: u8, class: u8) -> bool {
    let inside = match class.to_ascii_lowercase() {
        b'a' => byte.is_ascii_alphabetic(),
        b'c' => byte.is_ascii_control(),
        b'd' => byte.is_ascii_digit(),
        b'g' => byte.is_ascii_graphic(),
        b'l' => byte.is_ascii_lowercase(),
        b'p' => byte.is_ascii_punctuation(),
        b's' => byte.is_ascii_whitespace() || byte == 0x0b,
        b'u' => byte.is_ascii_uppercase(),
        b'w' => byte.is_ascii_alphanumeric(),
        b'x' => byte.is_ascii_hexdigit(),
        b'z' => byte == 0,
        _ => return byte == class,
    };
    inside != class.is_ascii_uppercase()
}

#[cfg(test)]
mod tests;
