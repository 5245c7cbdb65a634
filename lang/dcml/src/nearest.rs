//! The known word that a mistyped one was probably meant to be.
//!
//! Distance: insertions, deletions, substitutions and swaps of neighbours count one each (optimal string alignment);
//! case counts half. Pure; bounded by [`crate::limits::DCML_WORDS_COMPARED`].

use crate::limits::{DCML_WORD_COMPARED_BYTES, DCML_WORDS_COMPARED};

/// The nearest of `known` if it is near enough: at most a third of the letters are wrong, or one.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > DCML_WORD_COMPARED_BYTES {
        return None;
    }
    let word: Vec<char> = word.chars().collect();
    let most = ((word.len() + 1) / 3).max(1) * 2;
    let mut best: Option<(usize, &str)> = None;
    for one in known.into_iter().take(DCML_WORDS_COMPARED) {
        // A letter that is there once more is one edit at least.
        if one.len().abs_diff(word.len()) * 2 > most {
            continue;
        }
        let letters: Vec<char> = one.chars().collect();
        let is_case = letters.len() == word.len()
            && letters
                .iter()
                .zip(&word)
                .all(|(a, b)| a.eq_ignore_ascii_case(b));
        let found = if is_case {
            1
        } else {
            distance(&word, &letters)
        };
        // A word of one letter has nothing left of it after one edit, except its case.
        let enough = if word.len() == 1 {
            found < 2
        } else {
            found <= most
        };
        if enough && best.is_none_or(|(least, _)| found < least) {
            best = Some((found, one));
        }
    }
    best.map(|(_, one)| one)
}

/// Twice the number of edits between two words.
fn distance(a: &[char], b: &[char]) -> usize {
    let cost = |x: char, y: char| match () {
        () if x == y => 0,
        () if x.eq_ignore_ascii_case(&y) => 1,
        () => 2,
    };
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).map(|at| at * 2).collect();
    for (i, &x) in a.iter().enumerate() {
        let mut row = Vec::with_capacity(b.len() + 1);
        row.push((i + 1) * 2);
        for (j, &y) in b.iter().enumerate() {
            let mut best = (last[j] + cost(x, y)).min(last[j + 1] + 2).min(row[j] + 2);
            if i > 0 && j > 0 && x == b[j - 1] && a[i - 1] == y && x != y {
                best = best.min(before_last[j - 1] + 2);
            }
            row.push(best);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last.last().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_typing_error_finds_its_word() {
        let known = ["theta", "u_left", "u_right", "L", "r"];
        assert_eq!(nearest("thet", known), Some("theta"));
        assert_eq!(nearest("Theta", known), Some("theta"));
        assert_eq!(nearest("thtea", known), Some("theta"));
        assert_eq!(nearest("tetha", known), Some("theta"));
        assert_eq!(nearest("u_rihgt", known), Some("u_right"));
        assert_eq!(nearest("l", known), Some("L"));
        assert_eq!(nearest("THETA", known), Some("theta"));
        assert_eq!(nearest("q", known), None);
        assert_eq!(nearest("velocity", known), None);
        assert_eq!(nearest(&"u".repeat(1 << 20), known), None);
    }
}
