//! Conditions and values as a person reads them in an explanation.
//!
//! Owns these words, which are the same in all languages: names of the rules and signs.

use super::rules::{Binary, Comparison, Condition, Operand, Unary};
use super::scene::ObjectPoint;
use super::value::{Value, shown};
use crate::limits;

/// A condition that has no others in it.
pub(super) fn condition(condition: &Condition) -> String {
    let text = match condition {
        Condition::Compare(comparison, operands) => {
            let [left, right] = &**operands;
            format!("{} {} {}", operand(left), sign(*comparison), operand(right))
        }
        Condition::Inside {
            object,
            region,
            point,
        } => {
            let point = match point {
                ObjectPoint::Center => "",
                ObjectPoint::All => " (all)",
                ObjectPoint::Any => " (any)",
            };
            format!("{} inside {}{point}", object.text, region.text)
        }
        Condition::SettedUp(named) => format!("settedUp {}", named.id),
        Condition::Dropped(named) => format!("dropped {}", named.id),
        Condition::Timer { ms, .. } => format!("timer {ms} ms"),
        Condition::True => "true".to_owned(),
        Condition::All(_) => "and".to_owned(),
        Condition::Any(_) => "or".to_owned(),
        Condition::Not(_) => "not".to_owned(),
        Condition::Using(..) => "using".to_owned(),
    };
    cut(text)
}

fn sign(comparison: Comparison) -> &'static str {
    match comparison {
        Comparison::Equals => "=",
        Comparison::NotEqual => "!=",
        Comparison::Greater => ">",
        Comparison::Less => "<",
        Comparison::NotGreater => "<=",
        Comparison::NotLess => ">=",
    }
}

fn operand(one: &Operand) -> String {
    match one {
        Operand::Constant(constant) => value(constant),
        Operand::Variable(path) | Operand::State(path) => path.text.to_string(),
        Operand::Either(path) => path.text.to_string(),
        Operand::TypeOf(name) => format!("typeOf({})", name.text),
        Operand::Unary(Unary::Minus, one) => format!("-{}", operand(one)),
        Operand::Unary(Unary::Abs, one) => format!("abs({})", operand(one)),
        Operand::Unary(Unary::BoundingRect, one) => format!("boundingRect({})", operand(one)),
        Operand::Binary(operation, operands) => {
            let [left, right] = &**operands;
            let (left, right) = (operand(left), operand(right));
            match operation {
                Binary::Sum => format!("({left} + {right})"),
                Binary::Difference => format!("({left} - {right})"),
                Binary::Mul => format!("({left} * {right})"),
                Binary::Min => format!("min({left}, {right})"),
                Binary::Max => format!("max({left}, {right})"),
                Binary::Distance => format!("distance({left}, {right})"),
            }
        }
    }
}

/// A value.
pub(super) fn value(value: &Value) -> String {
    let text = match value {
        Value::Null => "nothing".to_owned(),
        Value::Bool(_) | Value::Int(_) => value.to_text(),
        Value::Double(number) => shown((number * 1000.0).round() / 1000.0),
        Value::NoText => "\"\"".to_owned(),
        Value::Text(text) => format!("\"{text}\""),
        Value::Point(at) => format!("({}, {})", at.x, at.y),
        Value::Place([x, y]) => format!("({x:.1}, {y:.1})"),
        Value::Rect(rect) => format!("({}, {}, {} x {})", rect.x, rect.y, rect.width, rect.height),
        Value::Colour(colour) => format!("#{colour:08x}"),
        Value::Opaque => "...".to_owned(),
        Value::List(list) => format!("list of {}", list.len()),
        Value::Record(_) => "figure".to_owned(),
        Value::Object(_) => "object".to_owned(),
    };
    cut(text)
}

/// A text no longer than an explanation needs.
pub(super) fn cut(text: String) -> String {
    match text.char_indices().nth(limits::EXPLAINED_CHARS_MAX) {
        Some((at, _)) => format!("{}...", &text[..at]),
        None => text,
    }
}
