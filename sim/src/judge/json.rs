//! JSON, as far as reports, trajectories and recorded runs need it: texts written, values read.
//!
//! Owns escapes and numbers in both directions, and the limits of a text that comes from outside. Knows nothing of what
//! is said in it.

use crate::limits;
use std::fmt::Write as _;

/// A value that was read.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// A finite number.
    Number(f64),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Value>),
    /// Names with values, in the order of the text.
    Object(Vec<(String, Value)>),
}

impl Value {
    /// The first value with a name, of an object.
    pub fn get(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Object(pairs) => pairs
                .iter()
                .find(|(key, _)| key == name)
                .map(|(_, value)| value),
            _ => None,
        }
    }

    /// The number.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The text.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The value as text again.
    pub fn write(&self, into: &mut String) {
        match self {
            Self::Null => into.push_str("null"),
            Self::Bool(value) => into.push_str(if *value { "true" } else { "false" }),
            Self::Number(value) => number(into, *value),
            Self::Text(value) => text(into, value),
            Self::List(values) => {
                into.push('[');
                for (index, value) in values.iter().enumerate() {
                    if index > 0 {
                        into.push(',');
                    }
                    value.write(into);
                }
                into.push(']');
            }
            Self::Object(pairs) => {
                into.push('{');
                for (index, (key, value)) in pairs.iter().enumerate() {
                    if index > 0 {
                        into.push(',');
                    }
                    text(into, key);
                    into.push(':');
                    value.write(into);
                }
                into.push('}');
            }
        }
    }
}

/// Writes a text with quotes. What a page of HTML could take for a tag is escaped too.
pub fn text(into: &mut String, text: &str) {
    into.push('"');
    for c in text.chars() {
        match c {
            '"' => into.push_str("\\\""),
            '\\' => into.push_str("\\\\"),
            '\n' => into.push_str("\\n"),
            '\r' => into.push_str("\\r"),
            '\t' => into.push_str("\\t"),
            c if (c as u32) < 0x20 || matches!(c, '<' | '\u{2028}' | '\u{2029}' | '\u{7f}') => {
                let _ = write!(into, "\\u{:04x}", c as u32);
            }
            c => into.push(c),
        }
    }
    into.push('"');
}

/// Writes a number so that it is the same when it is read; what JSON cannot hold becomes `null`.
pub fn number(into: &mut String, number: f64) {
    if number.is_finite() {
        // Minus zero is what an original never writes.
        let number = if number == 0.0 { 0.0 } else { number };
        let _ = write!(into, "{number}");
    } else {
        into.push_str("null");
    }
}

/// Reads one value and nothing behind it.
///
/// # Errors
/// The line and column, and what is wrong there; also depth and length beyond the limits.
pub fn read(text: &str) -> Result<Value, String> {
    let mut reader = Reader {
        text,
        at: 0,
        values: 0,
    };
    let value = reader.value(0).and_then(|value| {
        reader.end()?;
        Ok(value)
    });
    value.map_err(|why| reader.place(why))
}

/// Reads a list value by value, so that a long one needs no memory at once.
///
/// # Errors
/// As [`read`], and what `use_one` says of a value.
pub fn read_list(
    text: &str,
    mut use_one: impl FnMut(Value) -> Result<(), &'static str>,
) -> Result<(), String> {
    let mut reader = Reader {
        text,
        at: 0,
        values: 0,
    };
    let done = reader.each(&mut use_one);
    done.map_err(|why| reader.place(why))
}

/// The beginning of the character at a place.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    values: usize,
}

type Read<T> = Result<T, &'static str>;

impl Reader<'_> {
    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn blank(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\n' | b'\r' | b'\t')) {
            self.at += 1;
        }
    }

    fn take(&mut self, byte: u8) -> bool {
        self.blank();
        let is_there = self.peek() == Some(byte);
        self.at += usize::from(is_there);
        is_there
    }

    /// What is wrong, with the place where it was noticed.
    fn place(&self, why: &str) -> String {
        let before = &self.text[..floor(self.text, self.at)];
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        format!("line {line}, column {column}: {why}")
    }

    fn end(&mut self) -> Read<()> {
        self.blank();
        if self.at < self.text.len() {
            return Err("something stands behind the end");
        }
        Ok(())
    }

    fn each(&mut self, use_one: &mut dyn FnMut(Value) -> Read<()>) -> Read<()> {
        if !self.take(b'[') {
            return Err("a list begins with [");
        }
        if self.take(b']') {
            return self.end();
        }
        loop {
            use_one(self.value(1)?)?;
            if self.take(b']') {
                return self.end();
            }
            if !self.take(b',') {
                return Err("a comma or ] is missing here");
            }
        }
    }

    fn value(&mut self, depth: usize) -> Read<Value> {
        self.blank();
        self.values += 1;
        if depth > limits::JSON_DEPTH {
            return Err("it nests too deep");
        }
        if self.values > limits::JSON_VALUES {
            return Err("there are too many values");
        }
        match self.peek() {
            Some(b'{') => self.object(depth),
            Some(b'[') => self.list(depth),
            Some(b'"') => self.string().map(Value::Text),
            Some(b'-' | b'0'..=b'9') => self.numeral(),
            _ => {
                for (word, value) in [
                    ("true", Value::Bool(true)),
                    ("false", Value::Bool(false)),
                    ("null", Value::Null),
                ] {
                    if self.text[floor(self.text, self.at)..].starts_with(word) {
                        self.at += word.len();
                        return Ok(value);
                    }
                }
                Err("a value is missing here")
            }
        }
    }

    fn list(&mut self, depth: usize) -> Read<Value> {
        self.at += 1;
        let mut values = Vec::new();
        if self.take(b']') {
            return Ok(Value::List(values));
        }
        loop {
            values.push(self.value(depth + 1)?);
            if self.take(b']') {
                return Ok(Value::List(values));
            }
            if !self.take(b',') {
                return Err("a comma or ] is missing here");
            }
        }
    }

    fn object(&mut self, depth: usize) -> Read<Value> {
        self.at += 1;
        let mut pairs = Vec::new();
        if self.take(b'}') {
            return Ok(Value::Object(pairs));
        }
        loop {
            self.blank();
            if self.peek() != Some(b'"') {
                return Err("a name is missing here");
            }
            let key = self.string()?;
            if !self.take(b':') {
                return Err("a colon is missing here");
            }
            let value = self.value(depth + 1)?;
            pairs.push((key, value));
            if self.take(b'}') {
                return Ok(Value::Object(pairs));
            }
            if !self.take(b',') {
                return Err("a comma or } is missing here");
            }
        }
    }

    fn numeral(&mut self) -> Read<Value> {
        let from = self.at;
        while matches!(
            self.peek(),
            Some(b'-' | b'+' | b'.' | b'e' | b'E' | b'0'..=b'9')
        ) {
            self.at += 1;
        }
        let number: Option<f64> = self.text[from..self.at].parse().ok();
        let number = number.filter(|number| number.is_finite());
        number.map(Value::Number).ok_or("this is no number")
    }

    fn string(&mut self) -> Read<String> {
        self.at += 1;
        let mut string = String::new();
        loop {
            let from = self.at;
            while !matches!(self.peek(), None | Some(b'"' | b'\\')) {
                self.at += 1;
            }
            string.push_str(&self.text[from..self.at]);
            match self.peek() {
                None => return Err("a text has no end"),
                Some(b'"') => {
                    self.at += 1;
                    return Ok(string);
                }
                Some(_) => string.push(self.escape()?),
            }
        }
    }

    fn escape(&mut self) -> Read<char> {
        let letter = self.text.as_bytes().get(self.at + 1).copied();
        self.at += 2;
        Ok(match letter {
            Some(b'n') => '\n',
            Some(b'r') => '\r',
            Some(b't') => '\t',
            Some(b'b') => '\u{8}',
            Some(b'f') => '\u{c}',
            Some(c @ (b'"' | b'\\' | b'/')) => char::from(c),
            Some(b'u') => {
                let high = self.hex()?;
                let is_pair = (0xd800..0xdc00).contains(&high)
                    && self.text.as_bytes().get(self.at..self.at + 2) == Some(b"\\u");
                if !is_pair {
                    return Ok(char::from_u32(high).unwrap_or('\u{fffd}'));
                }
                self.at += 2;
                let low = self.hex()?.wrapping_sub(0xdc00);
                let code = 0x1_0000 + ((high - 0xd800) << 10) + (low & 0x3ff);
                char::from_u32(code).unwrap_or('\u{fffd}')
            }
            _ => return Err("this escape is unknown"),
        })
    }

    fn hex(&mut self) -> Read<u32> {
        let digits = self.text.get(self.at..self.at + 4).unwrap_or("");
        if digits.len() != 4 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
            return Err("four hexadecimal digits are missing here");
        }
        self.at += 4;
        u32::from_str_radix(digits, 16).map_err(|_| "this is no number")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let source = "a\"b\\c\n</script>\u{2028}\u{1f600}\u{7}";
        let mut json = String::new();
        text(&mut json, source);
        assert!(!json.contains('<') && json.is_ascii() != json.contains('\u{1f600}'));
        assert_eq!(read(&json), Ok(Value::Text(source.to_owned())));
        for value in [0.1, -0.0, 1e300, -304.290027188038, 5.0] {
            let mut json = String::new();
            number(&mut json, value);
            assert_eq!(read(&json), Ok(Value::Number(value)));
        }
        let mut json = String::new();
        number(&mut json, f64::NAN);
        assert_eq!(json, "null");
        let nested = r#"{"a":[1,true,null,{}],"b":""}"#;
        let mut again = String::new();
        read(nested).unwrap().write(&mut again);
        assert_eq!(again, nested);
        assert_eq!(
            read(r#""\ud83d\ude00""#),
            Ok(Value::Text("\u{1f600}".into()))
        );
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (json, place) in [
            ("", "line 1, column 1: a value is missing here"),
            ("[1,\n x]", "line 2, column 2: a value is missing here"),
            ("{\"a\" 1}", "line 1, column 6: a colon is missing here"),
            ("[1] 2", "line 1, column 5: something stands behind the end"),
            ("\"abc", "line 1, column 5: a text has no end"),
            ("1e999", "line 1, column 6: this is no number"),
            ("\"\\q\"", "line 1, column 4: this escape is unknown"),
            (
                "\"\\u12\u{44f}\"",
                "line 1, column 4: four hexadecimal digits are missing here",
            ),
            ("\u{44f}", "line 1, column 1: a value is missing here"),
        ] {
            assert_eq!(read(json), Err(place.to_owned()), "{json}");
        }
        let deep = "[".repeat(100_000);
        assert!(read(&deep).unwrap_err().ends_with("it nests too deep"));
    }
}
