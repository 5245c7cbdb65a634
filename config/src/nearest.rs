//! What a message appends when a word is not known: the known one that was probably meant.
//!
//! Owns the sentence. Which word is near enough is decided in `lang-dcml`, whose models a configuration names.

pub use lang_dcml::nearest::nearest;

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
