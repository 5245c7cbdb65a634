//! What an editor asks of a document: what a name is, where it is used, what may stand here.
//!
//! Owns the answers, over places in bytes; works on texts that are half written. How an editor asks, and how it counts
//! columns, is known to `trik`.

mod about;
mod colours;
mod complete;
mod facts;
mod fix;
pub mod limits;
mod names;
mod outline;
mod refusal;
mod rename;
mod signature;
#[cfg(test)]
mod tests;
mod words;

pub use about::Hover;
pub use colours::{Colour, Painted};
pub use complete::{Completion, Item};
pub use fix::Fix;
pub use outline::{Fold, Symbol, SymbolKind};
pub use refusal::Refusal;
pub use signature::Signature;

use crate::limits::DCML_EDITOR_BYTES;
use lang_dcml::diagnostic::Diagnostic;
use lang_dcml::syntax::{Document, Span};
use lang_dcml::{Understood, understand};
use words::Words;

/// A document that was read for an editor. Made anew for each change.
#[derive(Debug)]
pub struct Reading {
    text: String,
    understood: Understood,
    words: Words,
}

/// A change: what stands in a place is replaced.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Edit {
    /// Where.
    pub span: Span,
    /// With what.
    pub text: String,
}

impl Reading {
    /// Reads a text. One that is longer than [`DCML_EDITOR_BYTES`] has diagnostics, and nothing else is known of it.
    pub fn of(text: String) -> Self {
        let understood = understand(&text);
        let words = if text.len() <= DCML_EDITOR_BYTES {
            Words::of(&text)
        } else {
            Words::default()
        };
        Self {
            text,
            understood,
            words,
        }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What is wrong with it.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.understood.diagnostics
    }

    fn document(&self) -> &Document {
        &self.understood.document
    }

    fn slice(&self, span: Span) -> &str {
        lang_dcml::lexer::slice(&self.text, span)
    }

    /// The edit that makes the text as the formatter wants it; nothing if it is so already.
    ///
    /// # Errors
    /// Why it cannot be formatted: what cannot be read has no layout.
    pub fn formatted(&self) -> Result<Option<Edit>, Refusal> {
        let wanted = lang_dcml::format::format(&self.text).map_err(|found| {
            let first = found.first().map(|one| one.message.clone());
            Refusal::Mistakes(first.unwrap_or_default())
        })?;
        Ok(difference(&self.text, &wanted))
    }
}

/// The smallest stretch to replace for one text to become another.
fn difference(old: &str, new: &str) -> Option<Edit> {
    if old == new {
        return None;
    }
    let same = old.bytes().zip(new.bytes());
    let mut start = same.take_while(|(a, b)| a == b).count();
    while !(old.is_char_boundary(start) && new.is_char_boundary(start)) {
        start -= 1;
    }
    let most = old.len().min(new.len()) - start;
    let same = old.bytes().rev().zip(new.bytes().rev()).take(most);
    let mut tail = same.take_while(|(a, b)| a == b).count();
    while !(old.is_char_boundary(old.len() - tail) && new.is_char_boundary(new.len() - tail)) {
        tail -= 1;
    }
    let byte = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
    Some(Edit {
        span: Span {
            start: byte(start),
            end: byte(old.len() - tail),
        },
        text: new[start..new.len() - tail].to_owned(),
    })
}
