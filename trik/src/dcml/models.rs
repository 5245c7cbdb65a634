//! `trik dcml models`: the models that come with the program.
//!
//! Owns the list for people; the texts are in `lang`.

use crate::output::standard;
use crate::refusal::Refusal;
use clap::Args;
use lang_dcml::models::{ALL, advice, named};

/// What `trik dcml models` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ModelsArgs {
    /// The one to print.
    pub name: Option<String>,
}

/// Lists them, or prints one.
pub(super) fn run(args: &ModelsArgs) -> Result<u8, Refusal> {
    let text = match &args.name {
        None => ALL
            .iter()
            .map(|one| format!("{:<20}{}\n", one.name, one.about))
            .collect(),
        Some(name) => match named(name) {
            Some(one) => one.text.to_owned(),
            None => {
                let why = format!("there is no model {name}; {}", advice(name));
                return Err(Refusal::new(why));
            }
        },
    };
    standard(text.as_bytes())?;
    Ok(0)
}
