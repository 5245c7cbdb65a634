//! The known word that a mistyped one was probably meant to be.
//!
//! Distance: insertions, deletions, substitutions and swaps of neighbours count one each (optimal string alignment);
//! case counts half an edit, since `r` and `R` are often both names of a model. The rules of `lang/text` for longer names are
//! others, and this crate depends on no crate of ours. Pure; bounded by [`crate::limits::DCML_WORDS_COMPARED`].

use strsim::osa_distance;

use crate::limits::{DCML_WORD_COMPARED_BYTES, DCML_WORDS_COMPARED};

/// The nearest of `known` if it is near enough: at most a third of the letters are wrong, or one.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > DCML_WORD_COMPARED_BYTES {
        return None;
    }
    let letters = word.chars().count();
    let most = ((letters + 1) / 3).max(1) * 2;
    let mut best: Option<(usize, &str)> = None;
    for one in known.into_iter().take(DCML_WORDS_COMPARED) {
        // A letter that is there once more is one edit at least.
        if one.chars().count().abs_diff(letters) * 2 > most {
            continue;
        }
        let found = distance(word, one);
        // A word of one letter has nothing left of it after one edit, except its case.
        let enough = if letters == 1 {
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

/// Twice the number of edits, and one more if the case differs somewhere.
fn distance(a: &str, b: &str) -> usize {
    let edits = osa_distance(&a.to_ascii_lowercase(), &b.to_ascii_lowercase());
    2 * edits + usize::from(edits != osa_distance(a, b))
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
