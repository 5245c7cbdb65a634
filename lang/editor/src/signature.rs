//! The function whose arguments are being written.
//!
//! Owns where a call begins and which argument is next.

use super::words::{Role, Word};
use super::{Reading, facts};
use crate::limits::DCML_EDITOR_LOOK_BACK;
use lang_dcml::lexer::TokenKind;
use lang_dcml::syntax::Span;

/// A function with its arguments.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Signature {
    /// The function with the names of its arguments.
    pub code: String,
    /// What it gives.
    pub said: String,
    /// Where the arguments stand in `code`, in bytes.
    pub arguments: Vec<Span>,
    /// The one that is written.
    pub active: usize,
}

impl Reading {
    /// The function in whose parentheses a place is.
    pub fn signature(&self, offset: u32) -> Option<Signature> {
        let before = self.words.before(offset);
        let (mut depth, mut commas) = (0usize, 0usize);
        for at in (before.saturating_sub(DCML_EDITOR_LOOK_BACK)..before).rev() {
            match self.words.all[at].role {
                Role::Sign(TokenKind::Semicolon) | Role::Keyword(_) => return None,
                Role::Sign(TokenKind::Close) => depth += 1,
                Role::Sign(TokenKind::Open) if depth > 0 => depth -= 1,
                Role::Sign(TokenKind::Open) => {
                    let called = at.checked_sub(1).and_then(|at| self.words.all.get(at));
                    if let Some(signature) = called.and_then(|word| of_call(word, commas)) {
                        return Some(signature);
                    }
                    // A plain parenthesis: its commas, if any, are nobody's.
                    commas = 0;
                }
                Role::Sign(TokenKind::Comma) if depth == 0 => commas += 1,
                _ => {}
            }
        }
        None
    }
}

fn of_call(word: &Word, commas: usize) -> Option<Signature> {
    let (name, arguments, said): (&str, &[&str], &str) = match word.role {
        Role::Function(function) => (
            function.name(),
            facts::parameters(function),
            facts::function(function),
        ),
        Role::Derivative => ("d", &["configuration"], facts::DERIVATIVE),
        Role::Piecewise => (
            "piecewise",
            &["condition", "value", "...", "otherwise"],
            facts::PIECEWISE_MEANS,
        ),
        _ => return None,
    };
    let active = match word.role {
        // Conditions and values take turns; which one is the last is not known before it is there.
        Role::Piecewise => commas % 2,
        _ => commas,
    };
    let mut code = format!("{name}(");
    let mut spans = Vec::new();
    for (at, argument) in arguments.iter().enumerate() {
        if at > 0 {
            code.push_str(", ");
        }
        let start = u32::try_from(code.len()).unwrap_or_default();
        code.push_str(argument);
        let end = u32::try_from(code.len()).unwrap_or_default();
        spans.push(Span { start, end });
    }
    code.push(')');
    Some(Signature {
        code,
        said: said.to_owned(),
        arguments: spans,
        active,
    })
}
