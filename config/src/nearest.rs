//! The known word that a mistyped one was probably meant to be.
//!
//! Distance: optimal string alignment (Damerau 1964, Levenshtein 1966): insertions, deletions, substitutions and
//! swaps of neighbours each count one. Pure.

/// Longest word that is looked at, in bytes; longer ones are not typing errors.
const WORD_BYTES_MAX: usize = 64;

/// The nearest of `known` if it is near enough: at most a third of the word's letters, at least one, are wrong.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    if word.len() > WORD_BYTES_MAX {
        return None;
    }
    let most = (word.chars().count() / 3).max(1);
    let distances = known.into_iter().map(|k| (distance(word, k), k));
    distances
        .filter(|(d, _)| *d <= most)
        .min_by_key(|(d, _)| *d)
        .map(|(_, k)| k)
}

/// `, did you mean 'X'` to append to a reason, or nothing.
pub fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, known).map_or_else(String::new, |k| format!(", did you mean '{k}'"))
}

/// Smallest number of edits between two words.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let substituted = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = substituted.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(before_last[j - 2] + 1);
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

    const KNOWN: [&str; 4] = [
        "input_tuple_size",
        "output_tuple_size",
        "converter",
        "units",
    ];

    #[test]
    fn distance_counts_edits_and_swaps() {
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("untis", "units"), 1);
    }

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
