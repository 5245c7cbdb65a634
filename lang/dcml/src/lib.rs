//! The Differential Constraints Modeling Language: what a robot's state does under an action, as text.
//!
//! Owns the border. Text to a [`syntax`] tree to a checked [`model`] to straight-line [`tape`]s; code that simulates, plans
//! or drives a robot sees a [`system::System`] only. The language is that of Guarnieri, Magri, Brugali and Gherardi, *A
//! Domain Specific Language for Modeling Differential Constraints of Mobile Robots*.

mod check;
mod code;
pub mod diagnostic;
pub mod fold;
pub mod format;
pub mod formulas;
pub mod function;
pub mod fuzz;
pub mod generate;
pub mod jacobian;
pub mod lexer;
pub mod limits;
pub mod lines;
pub mod lower;
pub mod manual;
pub mod model;
pub mod models;
pub mod nearest;
mod parser;
pub mod robot;
pub mod run;
#[cfg(test)]
mod sketch;
pub mod solve;
pub mod syntax;
pub mod system;
pub mod tape;
pub mod unit;

use crate::limits::DCML_TEXT_MAX;
use diagnostic::{Code, Diagnostic, Findings};
use model::Model;
use syntax::{Document, Span};

/// A document and all that is known of it.
#[derive(Clone, Debug, Default)]
pub struct Understood {
    /// As it was written.
    pub document: Document,
    /// The models that have no errors, in the order of the text.
    pub models: Vec<Model>,
    /// Errors and warnings, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

/// A file that is no text: the first byte that cannot be.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct NoText {
    /// The line, from 1.
    pub line: usize,
    /// The column in characters, from 1.
    pub column: usize,
    /// The byte.
    pub byte: u8,
}

impl std::fmt::Display for NoText {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { line, column, byte } = self;
        write!(
            f,
            "{line}:{column}: the byte 0x{byte:02x} is no text in UTF-8: save the file as UTF-8"
        )
    }
}

impl std::error::Error for NoText {}

/// The text of a file.
///
/// # Errors
/// It is not in UTF-8.
pub fn decode(bytes: Vec<u8>) -> Result<String, NoText> {
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let before = String::from_utf8_lossy(&bytes[..place]);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default();
        let column = column.chars().count() + 1;
        let byte = bytes.get(place).copied().unwrap_or_default();
        NoText { line, column, byte }
    })
}

/// Understands a document: all its errors, and the models that have none.
pub fn understand(text: &str) -> Understood {
    understand_as(text, false)
}

/// Understands a document of the published language alone: what that does not have is an error.
pub fn understand_paper(text: &str) -> Understood {
    understand_as(text, true)
}

fn understand_as(text: &str, paper: bool) -> Understood {
    let mut findings = Findings::default();
    if text.len() > DCML_TEXT_MAX {
        let mib = DCML_TEXT_MAX >> 20;
        let message = format!("the document is longer than {mib} MiB");
        let found = Diagnostic::new(Code::TooLong, Span::default(), message, "too long");
        findings.add(found.hint("put its models into several files"));
        return Understood {
            diagnostics: findings.finish(),
            ..Understood::default()
        };
    }
    let document = parser::parse(text, paper, &mut findings);
    let models = check::check(&document, &mut findings);
    Understood {
        document,
        models,
        diagnostics: findings.finish(),
    }
}

#[cfg(test)]
mod tests;
