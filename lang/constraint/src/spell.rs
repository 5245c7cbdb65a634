//! Conditions and values as a person reads them in an explanation.
//!
//! Owns how they are put together. Names of rules and signs are the same in all languages; other words are in `words`.

mod words;

use super::rules::{Binary, Comparison, Condition, Operand, Unary};
use super::scene::ObjectPoint;
use super::value::{Value, shown};
use crate::limits;
use lang_text::problem::Locale;
use words::{Wording, told};

/// A condition that has no others in it; the head of several is "and" or "or", which is no text for people.
pub(super) fn condition(condition: &Condition, locale: Locale) -> String {
    let told = told(locale);
    let text = match condition {
        Condition::Compare(comparison, operands) => {
            let [left, right] = &**operands;
            let sign = sign(*comparison);
            format!("{} {sign} {}", operand(left, told), operand(right, told))
        }
        Condition::Inside {
            object,
            region,
            point,
        } => {
            let point = match point {
                ObjectPoint::Center => String::new(),
                ObjectPoint::All => format!(" ({})", told.all),
                ObjectPoint::Any => format!(" ({})", told.any),
            };
            format!("{} {} {}{point}", object.text, told.inside, region.text)
        }
        Condition::SettedUp(named) => format!("{} {}", told.set_up, named.id),
        Condition::Dropped(named) => format!("{} {}", told.dropped, named.id),
        Condition::Timer { ms, .. } => format!("{} {ms} {}", told.timer, told.ms),
        Condition::True => told.yes.to_owned(),
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

fn operand(one: &Operand, told: &Wording) -> String {
    let of = |name: &str, one: &Operand| format!("{name}({})", operand(one, told));
    match one {
        Operand::Constant(constant) => spelt(constant, told),
        Operand::Variable(path) | Operand::State(path) => path.text.to_string(),
        Operand::Either(path) => path.text.to_string(),
        Operand::TypeOf(name) => format!("typeOf({})", name.text),
        Operand::Unary(Unary::Minus, one) => format!("-{}", operand(one, told)),
        Operand::Unary(Unary::Abs, one) => of("abs", one),
        Operand::Unary(Unary::BoundingRect, one) => of("boundingRect", one),
        Operand::Binary(operation, operands) => {
            let [left, right] = &**operands;
            let (left, right) = (operand(left, told), operand(right, told));
            match operation {
                Binary::Sum => format!("({left} + {right})"),
                Binary::Difference => format!("({left} - {right})"),
                Binary::Mul => format!("({left} * {right})"),
                Binary::Min => format!("min({left}, {right})"),
                Binary::Max => format!("max({left}, {right})"),
                Binary::Distance => format!("{}({left}, {right})", told.distance),
            }
        }
    }
}

/// A value.
pub(super) fn value(value: &Value, locale: Locale) -> String {
    spelt(value, told(locale))
}

fn spelt(value: &Value, told: &Wording) -> String {
    let text = match value {
        Value::Null => told.nothing.to_owned(),
        Value::Bool(true) => told.yes.to_owned(),
        Value::Bool(false) => told.no.to_owned(),
        Value::Int(_) => value.to_text(),
        Value::Double(number) => shown((number * 1000.0).round() / 1000.0),
        Value::NoText => "\"\"".to_owned(),
        Value::Text(text) => format!("\"{text}\""),
        Value::Point(at) => format!("({}, {})", at.x, at.y),
        Value::Place([x, y]) => format!("({x:.1}, {y:.1})"),
        Value::Rect(rect) => format!("({}, {}, {} x {})", rect.x, rect.y, rect.width, rect.height),
        Value::Colour(colour) => format!("#{colour:08x}"),
        Value::Opaque => "...".to_owned(),
        Value::List(list) => format!("{} {}", told.list, list.len()),
        Value::Record(_) => told.figure.to_owned(),
        Value::Object(_) => told.object.to_owned(),
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
