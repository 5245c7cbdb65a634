//! The two languages: how each word is said.
//!
//! Owns what both have in common; the words of each are in a file of its own. Knows no blocks and no files.

mod c;
mod lua;

use super::target::Target;
use lang_diagram::generate::row::{Row, fill, float};
use lang_expr::Value;
use lang_expr::reserved::Function;

/// Everything that a language must be able to say.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Word {
    /// A field of the state.
    Field,
    /// Milliseconds of the program's time.
    Now,
    /// Nothing, as a token.
    Unit,
    Yes,
    No,
    Add,
    Subtract,
    Multiply,
    /// The right one may be 0, which is a fault.
    Divide,
    Power,
    /// 0 stays 0 without a sign.
    Minus,
    DivideWhole,
    Modulo,
    BitAnd,
    BitOr,
    BitXor,
    BitNot,
    ShiftLeft,
    ShiftRight,
    Not,
    And,
    Or,
    Less,
    Greater,
    LessEqual,
    GreaterEqual,
    EqualNumbers,
    /// Of any values.
    Same,
    /// A value as a number; a fault if it is none.
    Number,
    /// The same of an index, where a truth counts too.
    NumberOfAny,
    /// list, index: an item as a number; what the items are, the first one says
    NumberOfItem,
    /// A fault if it is a value that is no number.
    Demand,
    /// A number as a whole one of 32 bits: halves go up, and what is above is cut off.
    Whole,
    /// A value as a truth.
    Truth,
    NumberOfTruth,
    ValueOfNumber,
    ValueOfTruth,
    /// list, index: nothing beyond the end
    Item,
    /// list, index, value: the list with that item
    Put,
    Length,
    /// Computed for what may be wrong with it.
    Ignore,
    /// A function of numbers.
    Math(Function),
    /// place, value: a token on its way
    Post,
    /// text
    Fail,
    /// The program is over.
    Stop,
    /// One more reaction.
    Count,
    /// A token as a whole number, halves away from 0; a fault if it is none.
    AsWhole,
    /// number, the most: within both ends
    Clamp,
    /// The value itself; a fault if it is none.
    NeedsValue,
    /// list, count: a fault if it has fewer items
    NeedsItems,
    /// A fault if it is no list of at least two items.
    NeedsPair,
    /// A time as timers keep it.
    RoundUp,
    /// timer, time
    SetTimer,
    /// timer
    Cancel,
    /// timer, the time at which it was due, period
    Repeat,
    /// next, last, step: whether a loop has nothing more to give
    IsOver,
    /// queue, token, capacity, policy
    Push,
    Has,
    Take,
}

/// How a word is said.
pub(super) fn row(target: Target, word: Word) -> Row {
    match target {
        Target::Lua => lua::row(word),
        Target::C => c::row(word),
    }
}

/// A word with operands that are names, numbers or calls.
pub(super) fn say(target: Target, word: Word, operands: &[&str]) -> String {
    fill(row(target, word).text, operands)
}

/// A number, as the language writes one that may have a fraction.
pub(super) fn number(target: Target, value: &Value) -> String {
    let number = match value {
        Value::Int(number) if target == Target::Lua => return number.to_string(),
        Value::Nil
        | Value::Bool(_)
        | Value::Int(_)
        | Value::Float(_)
        | Value::Text(_)
        | Value::Unset
        | Value::List(_) => value.to_float(),
    };
    if number.is_finite() {
        return float(number);
    }
    match (target, number.is_nan(), number > 0.0) {
        (Target::Lua, true, _) => "(0 / 0)".to_owned(),
        (Target::Lua, false, true) => "math.huge".to_owned(),
        (Target::Lua, false, false) => "(-math.huge)".to_owned(),
        (Target::C, true, _) => "(0.0 / 0.0)".to_owned(),
        (Target::C, false, true) => "HUGE_VAL".to_owned(),
        (Target::C, false, false) => "(-HUGE_VAL)".to_owned(),
    }
}

/// A list of values.
pub(super) fn list(target: Target, items: &[String]) -> String {
    match target {
        Target::Lua => lua::list(items),
        Target::C => c::list(items),
    }
}

/// A constant as a value.
pub(super) fn constant(target: Target, value: &Value) -> String {
    match value {
        Value::Bool(truth) => {
            let word = if *truth { Word::Yes } else { Word::No };
            say(target, Word::ValueOfTruth, &[&say(target, word, &[])])
        }
        Value::Int(_) | Value::Float(_) => {
            say(target, Word::ValueOfNumber, &[&number(target, value)])
        }
        Value::List(items) => {
            let items = items.items().iter();
            let items: Vec<String> = items.map(|item| constant(target, item)).collect();
            list(target, &items)
        }
        // Texts are refused before.
        Value::Nil | Value::Text(_) | Value::Unset => say(target, Word::Unit, &[]),
    }
}

/// A text of our own in quotes.
pub(super) fn quoted(target: Target, text: &str) -> String {
    match target {
        Target::Lua => format!("'{text}'"),
        Target::C => format!("\"{text}\""),
    }
}

/// The place of a port, as the language counts.
pub(super) fn place(target: Target, place: usize) -> String {
    match target {
        Target::Lua => (place + 1).to_string(),
        Target::C => place.to_string(),
    }
}
