//! A model in DCML as the robot of `trik up`: from a file or the name of a shipped one to a body and a configuration.
//!
//! Owns what `--body` takes beside names of robots. What a model means is `lang`'s part, how it moves `sim`'s.

use super::args::UpArgs;
use crate::error::Error;
use sim::body::Body;
use sim::body::rolling::{Overrides, Rolling};
use sim::robots;

/// An option that only a model takes.
pub(super) fn stray(args: &UpArgs) -> Option<&'static str> {
    [
        ("--model", args.model.is_none()),
        ("--params", args.params.is_empty()),
        ("--drive", args.drive.is_empty()),
        ("--start", args.start.is_empty()),
    ]
    .into_iter()
    .find_map(|(option, is_empty)| (!is_empty).then_some(option))
}

/// The body that the model moves, where `two-wheels` starts, and its configuration.
///
/// # Errors
/// Why there is none, for the person; what is wrong with the text has been told.
pub(super) fn robot(args: &UpArgs) -> Result<(Box<dyn Body>, String), Error> {
    let loaded = crate::dcml::load::load(args.body.as_ref(), args.model.as_deref());
    let (text, model) = loaded.map_err(|refusal| {
        let lines: Vec<&str> = refusal.lines.iter().map(String::as_str).collect();
        let text = lines.join("\n");
        Error::Refused(text.strip_prefix("trik: ").unwrap_or(&text).to_owned())
    })?;
    let said = Overrides {
        params: args.params.clone(),
        drive: args.drive.clone(),
        start: args.start.clone(),
    };
    let about = |reason| Error::file(args.body.as_ref(), reason);
    let rolling = Rolling::new(&model, &said, robots::MODEL_START).map_err(about)?;
    Ok(robots::modelled(rolling, one(&text, &model.name), &said))
}

/// The text of one model of a document.
fn one<'t>(text: &'t str, name: &str) -> &'t str {
    let document = lang_dcml::understand(text).document;
    let found = document.models.iter().find(|one| one.name.text == name);
    let span = found.map(|one| one.span.start as usize..one.span.end as usize);
    span.and_then(|span| text.get(span)).unwrap_or(text)
}
