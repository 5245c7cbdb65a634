//! The languages, one file for each: words, reserved names, helpers.
//!
//! Owns what they share.

pub(super) mod c;
pub(super) mod fsharp;
pub(super) mod javascript;
mod library;
pub(super) mod lua;
pub(super) mod pascal;
pub(super) mod python;

use super::code::Kind;

/// What a variable has before it gets a value: of numbers, truths, texts, tables, anything.
pub(super) fn start_value<'a>(kind: Option<&Kind>, values: [&'a str; 5]) -> &'a str {
    match kind {
        Some(Kind::Int | Kind::Float) => values[0],
        Some(Kind::Bool) => values[1],
        Some(Kind::Text) => values[2],
        Some(Kind::List(_)) => values[3],
        Some(Kind::Any) | None => values[4],
    }
}

/// A letter as its bytes, each written in the language's way.
fn escaped(letter: u32, byte: fn(u8) -> String) -> String {
    let mut buffer = [0; 4];
    let letter = char::from_u32(letter).unwrap_or(' ');
    let bytes = letter.encode_utf8(&mut buffer).bytes();
    bytes.map(byte).collect()
}

/// A table in Lua that begins at 0.
fn zero_based(parts: &[String]) -> String {
    match parts.split_first() {
        None => "{}".to_owned(),
        Some((first, rest)) => {
            let rest: String = rest.iter().map(|part| format!(", {part}")).collect();
            format!("{{ [0] = {first}{rest} }}")
        }
    }
}
