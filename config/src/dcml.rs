//! Models in DCML that a configuration names: from their text to a chunk of Lua that every state loads.
//!
//! Owns what a name means (a file, a shipped model, a text in the configuration itself) and how what is wrong with a text
//! is told. The language is `lang`'s; the global `dcml` makes a node of what the chunk gives.

use crate::error::Error;
use crate::limits::MODEL_PROBLEMS_MAX;
use lang_dcml::diagnostic::{Diagnostic, Severity};
use lang_dcml::generate::{Options, Target, generate};
use lang_dcml::lines::Lines;
use lang_dcml::model::Model;
use lang_dcml::syntax::{Domain, Kind};
use std::fmt::Write;

/// What stands before the name of a model where the global `dcml` asks for a chunk.
pub(crate) const PREFIX: &[u8] = b"dcml:";

/// What a name of a model means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Named<'n> {
    /// A text: a name has no semicolon, and every model has.
    Text(&'n [u8]),
    /// A file or a shipped model, and perhaps which of its models.
    File(&'n [u8], Option<&'n [u8]>),
}

impl<'n> Named<'n> {
    /// `robot.dcml`, `robot.dcml#Car`, or a text.
    pub(crate) fn of(name: &'n [u8]) -> Self {
        if name.contains(&b';') {
            return Self::Text(name);
        }
        match name.iter().rposition(|byte| *byte == b'#') {
            Some(at) => Self::File(&name[..at], Some(&name[at + 1..])),
            None => Self::File(name, None),
        }
    }
}

/// The chunk of one model of a text: it gives a table with `name`, lists of names `states`, `actions`, `params` and
/// `outputs`, `angles` by their names, `ranges` of actions by their numbers, `derivative(x, u, p, dx)` and `output(x, u, p, y)`, whose parameters
/// have the names `keys`.
///
/// `place` gives the words for a line and a column of the text.
///
/// # Errors
/// What is wrong with the text, each with its place; that it has not the model; that it is too large for Lua.
pub(crate) fn chunk(
    text: &str,
    wanted: Option<&str>,
    shown: &str,
    place: impl Fn(usize, usize) -> String,
) -> Result<String, Error> {
    let understood = lang_dcml::understand(text);
    // Errors of another model are no hindrance.
    let is_good =
        wanted.is_some_and(|wanted| understood.models.iter().any(|one| one.name == wanted));
    let errors = told(text, &understood.diagnostics, place);
    if !errors.is_empty() && !is_good {
        return Err(Error::Named(errors));
    }
    let model = pick(&understood.models, wanted, shown)?;
    let code = generate(model, Target::Lua, &Options::default())
        .map_err(|refused| Error::Named(format!("{shown}: {refused}")))?;
    Ok(adapted(model, &code))
}

/// The errors, one in each line.
fn told(text: &str, diagnostics: &[Diagnostic], place: impl Fn(usize, usize) -> String) -> String {
    let lines = Lines::of(text);
    let errors = diagnostics
        .iter()
        .filter(|one| one.severity == Severity::Error);
    let mut told: Vec<String> = errors
        .map(|one| {
            let at = lines.place(one.span.start);
            let hint = one.hint.iter().map(|hint| format!("; {hint}"));
            format!(
                "{}: {}{}",
                place(at.line, at.column),
                one.message,
                hint.collect::<String>()
            )
        })
        .collect();
    let more = told.len().saturating_sub(MODEL_PROBLEMS_MAX);
    told.truncate(MODEL_PROBLEMS_MAX);
    if more > 0 {
        told.push(format!("and {more} more"));
    }
    told.join("\n")
}

fn pick<'m>(models: &'m [Model], wanted: Option<&str>, shown: &str) -> Result<&'m Model, Error> {
    let names = || {
        let all: Vec<&str> = models.iter().map(|one| one.name.as_str()).collect();
        all.join(", ")
    };
    match (wanted, models) {
        (Some(wanted), _) => {
            let found = models.iter().find(|one| one.name == wanted);
            found.ok_or_else(|| {
                Error::Named(format!(
                    "{shown} has no model '{wanted}'; it has {}",
                    names()
                ))
            })
        }
        (None, [one]) => Ok(one),
        (None, []) => Err(Error::Named(format!("{shown} has no model"))),
        (None, _) => Err(Error::Named(format!(
            "{shown} has several models: say which, '{shown}#NAME', with {}",
            names()
        ))),
    }
}

/// The generated module with what the global `dcml` has to know of it.
fn adapted(model: &Model, code: &str) -> String {
    let quoted = |names: Vec<&str>| -> String {
        let all: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
        all.join(", ")
    };
    let of = |kind: Kind| quoted(model.of_kind(kind).map(|one| one.name.as_str()).collect());
    let states = quoted(model.states().map(|one| one.name.as_str()).collect());
    let outputs = quoted(model.outputs().map(|one| one.name.as_str()).collect());
    let mut ranges = String::new();
    for (index, one) in model.of_kind(Kind::Action).enumerate() {
        if let Some(Domain::Range(low, high)) = one.domain {
            let _ = write!(ranges, "[{}] = {{ {low:?}, {high:?} }}, ", index + 1);
        }
    }
    let mut angles = String::new();
    for one in model.of_kind(Kind::Config) {
        if one.domain == Some(Domain::Circle) {
            let _ = write!(angles, "['{}'] = true, ", one.name);
        }
    }
    format!(
        "local module = (function()\n{code}\nend)()\nreturn {{\n  name = '{}', states = {{ {states} }}, outputs = {{ {outputs} }}, actions = {{ {} }}, params = {{ {} }}, ranges = {{ {ranges}}}, angles = {{ {angles}}},\n  keys = module.PARAMS, derivative = module.derivative, output = module.outputs,\n}}\n",
        model.name,
        of(Kind::Action),
        of(Kind::Param),
    )
}

#[cfg(test)]
mod tests;
