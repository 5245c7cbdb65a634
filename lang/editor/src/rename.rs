//! A name becomes another one, everywhere in its model.
//!
//! Owns what may be renamed, and to what.

use super::words::{Role, Word};
use super::{Edit, Reading};
use crate::limits::{DCML_EDITOR_NAME_BYTES, DCML_EDITOR_PLACES};
use lang_dcml::function::Function;
use lang_dcml::lexer::{self, Keyword, TokenKind};
use lang_dcml::syntax::Span;

impl Reading {
    /// The name at a place, if it can be renamed.
    ///
    /// # Errors
    /// Why it cannot be.
    pub fn renamable(&self, offset: u32) -> Result<Span, String> {
        let no_name = || "there is no name here".to_owned();
        let meant = self.meant(offset).ok_or_else(no_name)?;
        let text = meant.text;
        match meant.word.role {
            Role::Declared(_) | Role::ModelName => Ok(meant.word.span),
            Role::Use => match self.definition(offset) {
                Some(_) => Ok(meant.word.span),
                None if matches!(text, "pi" | "e") => {
                    Err(format!("`{text}` belongs to the language"))
                }
                None => Err(format!("`{text}` is not declared: declare it first")),
            },
            Role::Function(_) | Role::Piecewise | Role::Derivative => {
                Err(format!("`{text}` belongs to the language"))
            }
            Role::Keyword(_) | Role::In | Role::Circle => {
                Err(format!("`{text}` is a word of the language"))
            }
            Role::Unit => Err("units cannot be renamed".to_owned()),
            Role::Package => Err("packages cannot be renamed".to_owned()),
            Role::Unknown => Err(format!("there is no function `{text}`")),
            Role::Number | Role::Comment(_) | Role::Sign(_) => Err(no_name()),
        }
    }

    /// The edits that give the name at a place another one.
    ///
    /// # Errors
    /// Why that cannot be: it is no name, or the new one is none, is taken or belongs to the language.
    pub fn rename(&self, offset: u32, new: &str) -> Result<Vec<Edit>, String> {
        let span = self.renamable(offset)?;
        if new == self.slice(span) {
            return Ok(Vec::new());
        }
        is_name(new)?;
        let is_model = self
            .meant(offset)
            .is_some_and(|meant| meant.word.role == Role::ModelName);
        if is_model {
            let mut names = self.words.models.iter().filter_map(|one| one.name);
            if names.any(|name| self.slice(name) == new) {
                return Err(format!("there is a model `{new}` already"));
            }
        } else {
            self.is_free(span, new)?;
        }
        let places = self.references(offset);
        if places.len() >= DCML_EDITOR_PLACES {
            return Err(format!(
                "it is used in more than {DCML_EDITOR_PLACES} places"
            ));
        }
        let edits = places.into_iter().map(|(span, _)| Edit {
            span,
            text: new.to_owned(),
        });
        Ok(edits.collect())
    }

    /// Whether no name of the model is this one.
    fn is_free(&self, span: Span, new: &str) -> Result<(), String> {
        if Function::named(new).is_some() || matches!(new, "piecewise" | "d") {
            return Err(format!("`{new}` is a function of the language"));
        }
        let Some(model) = self.words.model(span.start) else {
            return Err("it stands in no model".to_owned());
        };
        let is_name = |one: &&Word| matches!(one.role, Role::Declared(_) | Role::Use);
        let mut names = self.words.of_model(model).iter().filter(is_name);
        match names.find(|one| self.slice(one.span) == new) {
            None => Ok(()),
            Some(one) if matches!(one.role, Role::Declared(_)) => {
                Err(format!("`{new}` is declared in this model already"))
            }
            Some(_) => Err(format!("`{new}` is used in this model already")),
        }
    }
}

/// Whether a word can be a name.
fn is_name(word: &str) -> Result<(), String> {
    if word.len() > DCML_EDITOR_NAME_BYTES {
        return Err(format!(
            "a name that is put in has at most {DCML_EDITOR_NAME_BYTES} letters"
        ));
    }
    if Keyword::named(word).is_some() {
        return Err(format!("`{word}` is a word of the language"));
    }
    let mut tokens = lexer::tokens(word);
    let first = tokens.next();
    let is_one =
        first.is_some_and(|one| one.kind == TokenKind::Word && one.span.end as usize == word.len());
    if is_one && first.is_some_and(|one| one.span.start == 0) {
        return Ok(());
    }
    let short: String = word.chars().take(40).collect();
    Err(format!(
        "`{short}` is no name: a name has Latin letters, digits and _, and no digit first"
    ))
}
