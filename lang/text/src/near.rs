//! The word that was meant: the nearest of those that are known.
//!
//! Distance: optimal string alignment (Damerau 1964, Levenshtein 1966), in which two letters that changed places are one
//! mistake. Owns how far a word may be from what was meant. Models of robots have their own in `lang/dcml`, which depends on
//! no crate of ours: there names have one letter, and their case tells them apart.

use crate::limits::NEAR_BYTES;
use crate::problem::Words;
use strsim::osa_distance;

/// The known word that is nearest to another one, which is not known: the same in another case, or at most a third of
/// the letters are wrong, one of three or four.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // A text that is no name at all is near to none, and costs nothing.
    if word.len() > NEAR_BYTES {
        return None;
    }
    let letters = word.chars().count();
    let most = if letters < 3 { 0 } else { (letters / 3).min(3) };
    let distance = |known: &str| match known.eq_ignore_ascii_case(word) {
        true => 0,
        false => osa_distance(word, known),
    };
    let others = known.into_iter().filter(|known| *known != word);
    let near = others.map(|known| (distance(known), known));
    near.filter(|(distance, _)| *distance <= most)
        .min()
        .map(|(_, known)| known)
}

/// A sentence to append to a message; nothing if no word is near.
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Words {
    match nearest(word, known) {
        Some(known) => Words::new(
            format!("; did you mean '{known}'?"),
            format!(
                "; \u{43c}\u{43e}\u{436}\u{435}\u{442} \u{431}\u{44b}\u{442}\u{44c}, '{known}'?"
            ),
        ),
        None => Words::new("", ""),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_meant_and_a_far_one_is_not() {
        let known = ["robot1", "finish", "start"];
        for (word, meant) in [
            ("robto1", Some("robot1")),
            ("ROBOT1", Some("robot1")),
            ("finnish", Some("finish")),
            ("wall7", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, known), meant, "{word}");
        }
        assert_eq!(
            did_you_mean("strat", known).english,
            "; did you mean 'start'?"
        );
        assert_eq!(did_you_mean("elsewhere", known).english, "");
    }
}
