//! Tokens as ports take them: units, truths, whole numbers, texts, lists.
//!
//! Owns the conversions and their errors: nothing becomes a number that is none, so that no motor turns by mistake.

use super::words;
use crate::limits;
use lang_expr::Value;
use lang_text::problem::Words;
use std::rc::Rc;

/// A whole number: a float is rounded, halves away from zero, and a text may be a number.
pub fn whole(value: &Value) -> Result<i32, Words> {
    let number = match value {
        Value::Int(number) => return Ok(*number),
        Value::Float(number) => *number,
        Value::Text(text) => match text.trim().parse() {
            Ok(number) => number,
            Err(_) => return Err(words::no_whole(value)),
        },
        Value::Nil => return Err(words::unit()),
        Value::Bool(_) | Value::Unset | Value::List(_) => return Err(words::no_whole(value)),
    };
    let rounded = number.round();
    // Also false for not-a-number.
    if rounded.abs() <= f64::from(i32::MAX) {
        Ok(rounded as i32)
    } else if rounded.is_nan() {
        Err(words::no_whole(value))
    } else {
        Err(words::too_large_number(value))
    }
}

/// A truth; of a number, whether it is not 0.
pub fn truth(value: &Value) -> Result<bool, Words> {
    match value {
        Value::Bool(truth) => Ok(*truth),
        Value::Int(number) => Ok(*number != 0),
        Value::Text(text) if text.eq_ignore_ascii_case("true") => Ok(true),
        Value::Text(text) if text.eq_ignore_ascii_case("false") => Ok(false),
        Value::Nil => Err(words::unit()),
        Value::Float(_) | Value::Text(_) | Value::Unset | Value::List(_) => {
            Err(words::no_truth(value))
        }
    }
}

/// A text; numbers and truths as they are printed.
pub fn text(value: &Value) -> Result<Rc<str>, Words> {
    match value {
        Value::Text(text) => Ok(text.clone()),
        Value::Bool(_) | Value::Int(_) | Value::Float(_) => Ok(value.printed()),
        Value::Unset => Ok("".into()),
        Value::Nil => Err(words::unit()),
        Value::List(_) => Err(words::no_text(value)),
    }
}

/// The items of a list.
pub fn items(value: &Value) -> Result<&[Value], Words> {
    match value {
        Value::List(list) => Ok(list.items()),
        Value::Nil => Err(words::unit()),
        Value::Bool(_) | Value::Int(_) | Value::Float(_) | Value::Text(_) | Value::Unset => {
            Err(words::no_list(value))
        }
    }
}

/// Exactly so many whole numbers.
pub fn numbers<const N: usize>(value: &Value) -> Result<[i32; N], Words> {
    let all = items(value)?;
    if all.len() != N {
        return Err(words::wrong_count(all.len(), N));
    }
    let mut numbers = [0; N];
    for (number, item) in numbers.iter_mut().zip(all) {
        *number = whole(item)?;
    }
    Ok(numbers)
}

/// A list of values that are few.
pub fn list(values: Vec<Value>) -> Value {
    Value::List(Rc::new(
        lang_expr::value::List::new(values).unwrap_or_default(),
    ))
}

/// Whether a value may be a token: lists and texts have a limit.
pub fn fits(value: &Value) -> bool {
    match value {
        Value::Text(text) => text.len() <= limits::TEXT_BYTES_MAX,
        Value::List(list) => {
            list.items().len() <= limits::ITEMS_MAX && list.items().iter().all(fits)
        }
        Value::Nil | Value::Bool(_) | Value::Int(_) | Value::Float(_) | Value::Unset => true,
    }
}

/// Whether all numbers of a value are numbers: a person assigns no other ones, for motors and waits take none.
pub fn is_finite(value: &Value) -> bool {
    match value {
        Value::Float(number) => number.is_finite(),
        Value::List(list) => list.items().iter().all(is_finite),
        Value::Nil | Value::Bool(_) | Value::Int(_) | Value::Text(_) | Value::Unset => true,
    }
}

/// Whether a token carries a value.
pub fn is_unit(value: &Value) -> bool {
    match value {
        Value::Nil => true,
        Value::Bool(_)
        | Value::Int(_)
        | Value::Float(_)
        | Value::Text(_)
        | Value::Unset
        | Value::List(_) => false,
    }
}
