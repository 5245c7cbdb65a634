//! Where an expression demands numbers: what is none there makes the whole text a mistake, before any of it runs.
//!
//! Owns which places demand a number, as the types of [`lang_expr`] do. Knows no lists.

use super::operators::{arithmetic, of_wholes};
use super::{Phrase, Word, Writer};
use crate::generate::language::quoted;
use crate::generate::step::Step;
use lang_expr::tree::{Binary, Id, Node, Unary};

/// Whether an operator takes numbers alone.
fn takes_numbers(operator: Binary) -> bool {
    let orders = match operator {
        Binary::Less | Binary::Greater | Binary::LessEqual | Binary::GreaterEqual => true,
        Binary::Add
        | Binary::Subtract
        | Binary::Multiply
        | Binary::Divide
        | Binary::Power
        | Binary::DivideWhole
        | Binary::Modulo
        | Binary::BitAnd
        | Binary::BitOr
        | Binary::BitXor
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::Join
        | Binary::Or
        | Binary::And
        | Binary::NotEqual
        | Binary::Equal => false,
    };
    orders || arithmetic(operator).is_some() || of_wholes(operator).is_some()
}

/// The parts of which a part demands numbers.
fn demanded(part: &Node) -> Vec<Id> {
    match part {
        Node::Unary(Unary::Minus | Unary::BitNot, operand) => vec![*operand],
        Node::Binary(operator, left, right) if takes_numbers(*operator) => vec![*left, *right],
        Node::Call { arguments, .. } => arguments.clone(),
        Node::Nil
        | Node::Bool(_)
        | Node::Int(_)
        | Node::Float(_)
        | Node::Text(_)
        | Node::RawText(_)
        | Node::Name(_)
        | Node::Unary(Unary::Not | Unary::Length, _)
        | Node::Binary(..)
        | Node::Index { .. }
        | Node::Method { .. }
        | Node::Table { .. }
        | Node::Assign { .. }
        | Node::Block(_) => Vec::new(),
    }
}

/// Why a part is no number, whatever the values of names.
fn never_a_number(part: &Node) -> Option<&'static str> {
    match part {
        Node::Bool(_) | Node::Unary(Unary::Not, _) => Some("a truth is no number"),
        Node::Binary(operator, ..) => {
            let is_text = matches!(operator, Binary::Join);
            (!is_text && arithmetic(*operator).is_none() && of_wholes(*operator).is_none())
                .then_some("a truth is no number")
        }
        Node::Table { .. } => Some("a list is no number"),
        Node::Nil
        | Node::Int(_)
        | Node::Float(_)
        | Node::Text(_)
        | Node::RawText(_)
        | Node::Name(_)
        | Node::Unary(Unary::Minus | Unary::BitNot | Unary::Length, _)
        | Node::Index { .. }
        | Node::Call { .. }
        | Node::Method { .. }
        | Node::Assign { .. }
        | Node::Block(_) => None,
    }
}

impl Writer<'_, '_> {
    /// Fails where a number is demanded of what is none. Most of it is seen where it is computed; what is known before is
    /// told first, and so are names if a side of `and` or `or` may be left out.
    pub(super) fn demands(&mut self, leaves_out: bool) -> Vec<Step> {
        let mut steps = Vec::new();
        let mut asked: Vec<Id> = Vec::new();
        for part in self.source.tree().nodes.clone() {
            asked.extend(demanded(&part));
        }
        for id in asked {
            let part = self.source.tree().node(id).clone();
            if let Some(why) = never_a_number(&part) {
                let why = Phrase::atom(quoted(self.plan.target, why));
                steps.push(Step::Do(self.say(Word::Fail, &[why]).text));
            } else if let (true, Node::Name(name)) = (leaves_out, &part)
                && self.is_changing(name)
            {
                let field = self.target(name);
                let asks = Step::Do(self.say(Word::Demand, &[field]).text);
                steps.push(asks);
            }
        }
        steps
    }
}
