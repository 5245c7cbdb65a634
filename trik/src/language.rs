//! The language of messages, as `--language` and the system say it.
//!
//! Owns the short names. What is said in each language is known where it is said.

use crate::error::Error;
use lang_text::problem::Locale;

/// The language of messages by its short name.
pub(crate) fn locale(name: &str) -> Result<Locale, Error> {
    Locale::named(name).ok_or_else(|| Error::Refused("there are en and ru".to_owned()))
}

/// That of the system, as its environment has it.
pub(crate) fn of_system() -> Locale {
    let names = ["LC_ALL", "LC_MESSAGES", "LANG"];
    let mut values = names.into_iter().filter_map(std::env::var_os);
    match values.find(|value| !value.is_empty()) {
        Some(value) if value.to_string_lossy().starts_with("ru") => Locale::Russian,
        _ => Locale::English,
    }
}
