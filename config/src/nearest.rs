//! The known word that a mistyped one was probably meant to be.
//!
//! Distance: optimal string alignment (Damerau 1964, Levenshtein 1966): insertions, deletions, substitutions and
//! swaps of neighbours each count one. Pure.

use crate::limits::WORD_BYTES_MAX;
use strsim::osa_distance;

/// The nearest of `known` if it is near enough: at most a third of the word's letters, at least one, are wrong.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > WORD_BYTES_MAX {
        return None;
    }
    let most = (word.chars().count() / 3).max(1);
    let distances = known.into_iter().map(|k| (osa_distance(word, k), k));
    distances
        .filter(|(d, _)| *d <= most)
        .min_by_key(|(d, _)| *d)
        .map(|(_, k)| k)
}

/// `, did you mean 'X'` to append to a reason, or nothing.
pub fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, known).map_or_else(String::new, |k| format!(", did you mean '{k}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 4] = [
        "input_tuple_size",
        "output_tuple_size",
        "converter",
        "units",
    ];

    #[test]
    fn a_typing_error_finds_its_word() {
        assert_eq!(nearest("convertor", KNOWN), Some("converter"));
        assert_eq!(nearest("imput_tuple_size", KNOWN), Some("input_tuple_size"));
        assert_eq!(nearest("untis", KNOWN), Some("units"));
    }

    #[test]
    fn another_word_finds_none() {
        assert_eq!(nearest("colour", KNOWN), None);
        assert_eq!(nearest(&"u".repeat(1 << 20), KNOWN), None);
        assert_eq!(suggestion("unit", KNOWN), ", did you mean 'units'");
        assert_eq!(suggestion("x", KNOWN), "");
    }
}
