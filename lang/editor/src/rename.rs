//! A name becomes another one, everywhere in its model.
//!
//! Owns what may be renamed, and to what.

use super::words::{Role, Word};
use super::{Edit, Reading, Refusal};
use crate::limits::{DCML_EDITOR_NAME_BYTES, DCML_EDITOR_PLACES};
use lang_dcml::function::Function;
use lang_dcml::lexer::{self, Keyword, TokenKind};
use lang_dcml::syntax::Span;

impl Reading {
    /// The name at a place, if it can be renamed.
    ///
    /// # Errors
    /// Why it cannot be.
    pub fn renamable(&self, offset: u32) -> Result<Span, Refusal> {
        let meant = self.meant(offset).ok_or(Refusal::NoName)?;
        let text = meant.text;
        match meant.word.role {
            Role::Declared(_) | Role::ModelName => Ok(meant.word.span),
            Role::Use => match self.definition(offset) {
                Some(_) => Ok(meant.word.span),
                None if matches!(text, "pi" | "e") => Err(Refusal::OfLanguage(text.to_owned())),
                None => Err(Refusal::Undeclared(text.to_owned())),
            },
            Role::Function(_) | Role::Piecewise | Role::Derivative => {
                Err(Refusal::OfLanguage(text.to_owned()))
            }
            Role::Keyword(_) | Role::In | Role::Circle => Err(Refusal::Keyword(text.to_owned())),
            Role::Unit => Err(Refusal::Unit),
            Role::Package => Err(Refusal::Package),
            Role::Unknown => Err(Refusal::NoFunction(text.to_owned())),
            Role::Number | Role::Comment(_) | Role::Sign(_) => Err(Refusal::NoName),
        }
    }

    /// The edits that give the name at a place another one.
    ///
    /// # Errors
    /// Why that cannot be: it is no name, or the new one is none, is taken or belongs to the language.
    pub fn rename(&self, offset: u32, new: &str) -> Result<Vec<Edit>, Refusal> {
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
                return Err(Refusal::ModelTaken(new.to_owned()));
            }
        } else {
            self.is_free(span, new)?;
        }
        let places = self.references(offset);
        if places.len() >= DCML_EDITOR_PLACES {
            return Err(Refusal::TooManyPlaces);
        }
        let edits = places.into_iter().map(|(span, _)| Edit {
            span,
            text: new.to_owned(),
        });
        Ok(edits.collect())
    }

    /// Whether no name of the model is this one.
    fn is_free(&self, span: Span, new: &str) -> Result<(), Refusal> {
        if Function::named(new).is_some() || matches!(new, "piecewise" | "d") {
            return Err(Refusal::Function(new.to_owned()));
        }
        let Some(model) = self.words.model(span.start) else {
            return Err(Refusal::NoModel);
        };
        let is_name = |one: &&Word| matches!(one.role, Role::Declared(_) | Role::Use);
        let mut names = self.words.of_model(model).iter().filter(is_name);
        match names.find(|one| self.slice(one.span) == new) {
            None => Ok(()),
            Some(one) if matches!(one.role, Role::Declared(_)) => {
                Err(Refusal::Declared(new.to_owned()))
            }
            Some(_) => Err(Refusal::Used(new.to_owned())),
        }
    }
}

/// Whether a word can be a name.
fn is_name(word: &str) -> Result<(), Refusal> {
    if word.len() > DCML_EDITOR_NAME_BYTES {
        return Err(Refusal::TooLong);
    }
    if Keyword::named(word).is_some() {
        return Err(Refusal::Keyword(word.to_owned()));
    }
    let mut tokens = lexer::tokens(word);
    let first = tokens.next();
    let is_one =
        first.is_some_and(|one| one.kind == TokenKind::Word && one.span.end as usize == word.len());
    if is_one && first.is_some_and(|one| one.span.start == 0) {
        return Ok(());
    }
    Err(Refusal::Unfit(word.to_owned()))
}
