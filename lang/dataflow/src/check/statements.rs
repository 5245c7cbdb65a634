//! Statements that do nothing: their value is nobody's, as another statement follows.
//!
//! Owns which these are; mostly an operator was forgotten.

use super::found::Found;
use super::words;
use crate::program::{Program, Text};
use lang_expr::tree::{Id, Node as Part, Tree};
use lang_expr::{Source, Wanted};

/// Tells those of a text.
pub(super) fn look(program: &Program, text: &Text, source: &Source, found: &mut Found) {
    let tree = source.tree();
    let statements = tree.statements();
    if statements.is_empty() && text.wanted == Wanted::Bool && text.text.trim().is_empty() {
        let place = program.property_place(text.node, text.property, None);
        found.warn(place, words::empty_condition());
    }
    // The last one is the value, which somebody takes.
    let last = match text.wanted {
        Wanted::Statements => statements.len(),
        Wanted::Bool | Wanted::Int | Wanted::Float | Wanted::Text | Wanted::List | Wanted::Any => {
            statements.len().saturating_sub(1)
        }
    };
    let idle = statements[..last].iter().find(|&&one| is_idle(tree, one));
    if let Some(&idle) = idle {
        let place = program.property_place(text.node, text.property, Some(tree.place(idle)));
        found.warn(place, words::idle_statement());
    }
}

/// Whether a statement neither gives a value to a variable nor calls anything.
fn is_idle(tree: &Tree, statement: Id) -> bool {
    let mut open = vec![statement];
    while let Some(id) = open.pop() {
        tree.children(id, |child| open.push(child));
        let part = tree.node(id);
        if matches!(
            part,
            Part::Assign { .. } | Part::Call { .. } | Part::Method { .. }
        ) {
            return false;
        }
    }
    true
}
