//! Points that the rules of a task say in words, as "20 points" or "score: 20".
//!
//! Owns how a number is recognised as points. Knows no runs: a message in, a number out.

use super::words;

/// Words that mean points.
const POINTS: [&str; 4] = ["points", "score", "scores", "pts"];
/// The word for one of them, which before a number is the name of a place.
const POINT: &str = "point";
/// A part of a message.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Number(f64),
    Points,
    Point,
    Between,
    OutOf,
    Other,
}

/// The points that a message tells: the number that stands at a word for points. Of "30 of 100 points" it is 30. The last
/// such number counts, because messages tell the sum at their ends.
pub(super) fn stated(message: &str) -> Option<f64> {
    let parts = parts(message);
    let mut found = None;
    for (index, part) in parts.iter().enumerate() {
        if !matches!(part, Part::Points | Part::Point) {
            continue;
        }
        let mut after = parts[index + 1..].iter();
        let after = after.find(|part| **part != Part::Between);
        if let (Part::Points, Some(&Part::Number(number))) = (part, after) {
            found = Some(number);
        } else if let Some(number) = before(&parts[..index]) {
            found = Some(number);
        }
    }
    found
}

/// The number right before a word; of two with "of" between them the first.
fn before(parts: &[Part]) -> Option<f64> {
    let last = |from: usize| match parts.len().checked_sub(from).map(|at| parts[at]) {
        Some(Part::Number(number)) => Some(number),
        _ => None,
    };
    let highest = last(1)?;
    let of = parts
        .iter()
        .rev()
        .skip(1)
        .take_while(|part| **part == Part::OutOf)
        .count();
    if of == 0 {
        return Some(highest);
    }
    last(2 + of).or(Some(highest))
}

fn parts(message: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut rest = message;
    while let Some(first) = rest.chars().next() {
        let is_number = |c: char| c.is_ascii_digit();
        if is_number(first) || (first == '-' && rest[1..].starts_with(is_number)) {
            let (number, length) = number(rest);
            parts.push(Part::Number(number));
            rest = &rest[length..];
        } else if first.is_alphabetic() {
            let end = rest
                .find(|c: char| !c.is_alphanumeric())
                .unwrap_or(rest.len());
            parts.push(word(&rest[..end]));
            rest = &rest[end..];
        } else {
            if first == '/' {
                parts.push(Part::OutOf);
            } else if matches!(first, '.' | ';' | '!' | '?' | ',') {
                // What belongs together stands in one part of a sentence.
                parts.push(Part::Other);
            }
            rest = &rest[first.len_utf8()..];
        }
    }
    parts
}

fn word(word: &str) -> Part {
    let word = word.to_lowercase();
    let is_points = POINTS.contains(&&*word);
    if is_points
        || words::POINTS_RUSSIAN
            .iter()
            .any(|start| word.starts_with(start))
    {
        Part::Points
    } else if word == POINT {
        Part::Point
    } else if words::OUT_OF.contains(&&*word) {
        Part::OutOf
    } else if words::BETWEEN_POINTS.contains(&&*word) {
        Part::Between
    } else {
        Part::Other
    }
}

/// A number at the beginning of a text, with a point or a comma, and its length.
fn number(text: &str) -> (f64, usize) {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let more = bytes[from..]
            .iter()
            .take_while(|byte| byte.is_ascii_digit());
        from + more.count()
    };
    let mut end = digits(usize::from(bytes[0] == b'-'));
    if matches!(bytes.get(end), Some(b'.' | b',')) && digits(end + 1) > end + 1 {
        end = digits(end + 1);
    }
    let number = text[..end].replace(',', ".").parse().unwrap_or(0.0);
    (number, end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_the_number_at_a_word_for_points() {
        for (message, points) in [
            ("Zone 3: 20 points", Some(20.0)),
            ("+5 points", Some(5.0)),
            ("Score: -2.5.", Some(-2.5)),
            ("30 of 100 points", Some(30.0)),
            ("40/100 points", Some(40.0)),
            ("30 out of 100 points", Some(30.0)),
            ("The corner: 20 points, 40 points in all", Some(40.0)),
            ("1 point", Some(1.0)),
            ("At point 7", None),
            ("Gate 3. points are counted", None),
            ("The task was accomplished in 15 sec!", None),
            ("no number of points", None),
            ("", None),
            ("points", None),
            ("- -5- 7", None),
        ] {
            assert_eq!(stated(message), points, "{message}");
        }
    }
}
