//! One model out of a file: the one that is named, or the only one.
//!
//! Owns what is said of a file without such a model. What is wrong with a text is shown by `report`.

use super::report;
use super::source::read;
use crate::refusal::Refusal;
use lang_dcml::diagnostic::Severity;
use lang_dcml::model::Model;
use lang_dcml::{Understood, understand};
use std::path::Path;

/// The text of one model and the model: the one of this name, or the only one of the file. What is wrong with the file is
/// shown on standard error, warnings too; errors of another model are no hindrance.
pub(crate) fn load(path: &Path, model: Option<&str>) -> Result<(String, Model), Refusal> {
    let source = read(path)?;
    let understood = understand(&source.text);
    report::show(&source, &understood.diagnostics);
    let model = pick(&source.name, understood, model)?;
    Ok((source.text, model))
}

fn pick(file: &str, understood: Understood, wanted: Option<&str>) -> Result<Model, Refusal> {
    let Understood {
        document,
        mut models,
        diagnostics,
    } = understood;
    let all: Vec<&str> = document
        .models
        .iter()
        .map(|one| one.name.text.as_str())
        .collect();
    let is_broken = diagnostics
        .iter()
        .any(|one| one.severity == Severity::Error);
    let listed = all.iter().take(20).copied().collect::<Vec<_>>().join(", ");
    match wanted {
        Some(name) => match models.iter().position(|one| one.name == name) {
            Some(at) => Ok(models.swap_remove(at)),
            None if all.contains(&name) => {
                Err(Refusal::new(format!("{file}: the model {name} has errors")))
            }
            None if all.is_empty() => Err(Refusal::new(format!(
                "{file}: there is no model that can be read"
            ))),
            None => Err(Refusal::new(format!(
                "{file}: there is no model {name}; there are {listed}"
            ))),
        },
        None if all.len() > 1 => Err(Refusal::new(format!(
            "{file}: there are several models: name one with --model: {listed}"
        ))),
        None => match models.pop() {
            Some(model) if !is_broken => Ok(model),
            _ => Err(Refusal::new(format!("{file}: the model has errors"))),
        },
    }
}
