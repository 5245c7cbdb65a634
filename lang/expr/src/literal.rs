//! Numbers as they are written, and what they count as.
//!
//! TRIK Studio reads a leading 0 as base 8, and takes what it cannot read, a whole number beyond 32 bits or a float in
//! base 16, for 0.

use super::value::{Compat, Value};

/// The value of a whole number.
pub fn whole(text: &str, compat: Compat) -> Value {
    let lower = text.to_ascii_lowercase();
    let (digits, base) = match lower.strip_prefix("0x") {
        Some(digits) => (digits, 16),
        None if compat == Compat::Studio && lower.len() > 1 && lower.starts_with('0') => {
            (lower.as_str(), 8)
        }
        None => (lower.as_str(), 10),
    };
    match i32::from_str_radix(digits, base) {
        Ok(number) => Value::Int(number),
        Err(_) if compat == Compat::Studio => Value::Int(0),
        Err(_) => Value::Float(many_digits(digits, base)),
    }
}

/// The value of another number.
pub fn float(text: &str, compat: Compat) -> f64 {
    if let Ok(number) = text.parse() {
        return number;
    }
    if compat == Compat::Studio {
        return 0.0;
    }
    let lower = text.to_ascii_lowercase();
    let Some(digits) = lower.strip_prefix("0x") else {
        // An exponent without digits.
        return lower
            .trim_end_matches(['e', '+', '-'])
            .parse()
            .unwrap_or(0.0);
    };
    let (mantissa, exponent) = digits.split_once('p').unwrap_or((digits, "0"));
    let (before, after) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.parse::<i32>().unwrap_or(0).clamp(-5000, 5000);
    let places = i32::try_from(after.len()).unwrap_or(i32::MAX).min(5000);
    (many_digits(before, 16) + many_digits(after, 16) * 16f64.powi(-places)) * 2f64.powi(exponent)
}

fn many_digits(digits: &str, base: u32) -> f64 {
    digits
        .chars()
        .filter_map(|digit| digit.to_digit(base))
        .fold(0.0, |sum, digit| sum * f64::from(base) + f64::from(digit))
}

/// What a whole number counts as, if that is not what it looks like.
pub(super) fn odd_whole(text: &str, compat: Compat) -> Option<f64> {
    if compat == Compat::Fixed {
        return None;
    }
    let counts = whole(text, Compat::Studio).to_float();
    (counts != whole(text, Compat::Fixed).to_float()).then_some(counts)
}

/// The same for another number.
pub(super) fn odd_float(text: &str, compat: Compat) -> Option<f64> {
    if compat == Compat::Fixed {
        return None;
    }
    let counts = float(text, Compat::Studio);
    (counts != float(text, Compat::Fixed)).then_some(counts)
}
