//! `trik dcml models`: the models that come with the program.
//!
//! Owns the list for people; the texts are in `lang`.

use super::ModelsArgs;
use crate::diagrams::Refusal;
use crate::diagrams::output::standard;
use lang_dcml::models::{ALL, named};

/// Lists them, or prints one.
pub(super) fn models(args: &ModelsArgs) -> Result<u8, Refusal> {
    let text = match &args.name {
        None => ALL
            .iter()
            .map(|one| format!("{:<20}{}\n", one.name, one.about))
            .collect(),
        Some(name) => match named(name) {
            Some(one) => one.text.to_owned(),
            None => {
                let all: Vec<&str> = ALL.iter().map(|one| one.name).collect();
                let why = format!("there is no model {name}; there are {}", all.join(", "));
                return Err(Refusal::new(why));
            }
        },
    };
    standard(text.as_bytes())?;
    Ok(0)
}
