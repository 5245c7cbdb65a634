//! The language of messages, as `--language` and the system say it.
//!
//! Owns the short names. What is said in each language is known where it is said.

use crate::error::Error;
use lang_text::problem::Tongue;

/// The language of messages by its short name.
pub(crate) fn tongue(name: &str) -> Result<Tongue, Error> {
    match name {
        "en" => Ok(Tongue::English),
        "ru" => Ok(Tongue::Russian),
        _ => Err(Error::Refused("there are en and ru".to_owned())),
    }
}

/// Its short name.
pub(crate) fn name(tongue: Tongue) -> &'static str {
    match tongue {
        Tongue::English => "en",
        Tongue::Russian => "ru",
    }
}

/// That of the system, as its environment has it.
pub(crate) fn of_system() -> Tongue {
    let names = ["LC_ALL", "LC_MESSAGES", "LANG"];
    let mut values = names.into_iter().filter_map(std::env::var_os);
    match values.find(|value| !value.is_empty()) {
        Some(value) if value.to_string_lossy().starts_with("ru") => Tongue::Russian,
        _ => Tongue::English,
    }
}
