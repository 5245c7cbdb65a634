//! Named fields of a tuple: parsed from `'i16 x, >u16 y, f32 z'`, and the way between a tuple's bytes and text.
//!
//! Owns the text of the `value` files. Little endian unless a field's type is preceded by `>`. Pure.

mod bound;
mod error;

pub use error::{EncodeError, RenderError};

use crate::error::Error;
use crate::limits::{FIELDS_MAX, TUPLE_BYTES_MAX};
use crate::nearest::suggestion;
use std::fmt::{self, Write};
use std::ops::Range;

/// The layout of a tuple. Without named fields it is a row of unsigned bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Format {
    fields: Vec<Field>,
    /// Offset of each field, then the size of the whole.
    offsets: Vec<usize>,
    /// Unnamed bytes; used only if there are no fields.
    bytes: usize,
    /// These bytes are one text, filled up with zero bytes.
    is_text: bool,
}

/// One field of a format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// A letter or `_`, then letters, digits and `_`; unique in its format.
    pub name: String,
    /// Type of the number.
    pub kind: FieldKind,
    /// Most significant byte first.
    pub big_endian: bool,
}

/// Type of one number in a tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 64 bits.
    U64,
    /// IEEE 754 binary32.
    F32,
    /// IEEE 754 binary64.
    F64,
}

impl FieldKind {
    /// All types with the words that name them.
    const WORDS: [(&'static str, Self); 10] = [
        ("i8", Self::I8),
        ("u8", Self::U8),
        ("i16", Self::I16),
        ("u16", Self::U16),
        ("i32", Self::I32),
        ("u32", Self::U32),
        ("i64", Self::I64),
        ("u64", Self::U64),
        ("f32", Self::F32),
        ("f64", Self::F64),
    ];

    /// The word that names the type in a format.
    pub fn word(self) -> &'static str {
        Self::WORDS
            .iter()
            .find(|(_, kind)| *kind == self)
            .map_or("", |(word, _)| word)
    }

    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

impl Format {
    /// Reads `'TYPE NAME, TYPE NAME'`, a type perhaps preceded by `>` for big endian, or `'text BYTES'`.
    ///
    /// # Errors
    /// The reason in lower case, naming the field.
    pub fn parse(text: &str) -> Result<Self, Error> {
        if let Some(size) = text.trim().strip_prefix("text ") {
            return Self::text(size.trim());
        }
        let mut fields: Vec<Field> = Vec::new();
        for part in text.split(',') {
            if fields.len() == FIELDS_MAX {
                return Err(Error::Text(format!(
                    "format has more than {FIELDS_MAX} fields"
                )));
            }
            let field = Field::parse(part)?;
            if fields.iter().any(|f| f.name == field.name) {
                return Err(Error::Text(format!(
                    "format names the field '{}' twice",
                    field.name
                )));
            }
            fields.push(field);
        }
        let mut offsets = Vec::with_capacity(fields.len() + 1);
        let mut size = 0;
        for field in &fields {
            offsets.push(size);
            size += field.kind.size();
        }
        offsets.push(size);
        Ok(Self {
            fields,
            offsets,
            bytes: 0,
            is_text: false,
        })
    }

    /// A tuple of `size` unnamed unsigned bytes, as a node without a format has.
    pub fn bytes(size: usize) -> Self {
        Self {
            bytes: size,
            ..Self::default()
        }
    }

    fn text(size: &str) -> Result<Self, Error> {
        let bytes: usize = size.parse().unwrap_or(0);
        if (1..=TUPLE_BYTES_MAX).contains(&bytes) {
            return Ok(Self {
                bytes,
                is_text: true,
                ..Self::default()
            });
        }
        let shown: String = size.chars().take(20).flat_map(char::escape_debug).collect();
        Err(Error::Text(format!(
            "format: a text has 1 to {TUPLE_BYTES_MAX} bytes ('text 64'), not '{shown}'"
        )))
    }

    /// The tuple is one text.
    pub fn is_text(&self) -> bool {
        self.is_text
    }

    /// The named fields in order; empty for plain bytes.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// How many numbers the text of a tuple has.
    pub fn len(&self) -> usize {
        if self.is_text {
            0
        } else if self.fields.is_empty() {
            self.bytes
        } else {
            self.fields.len()
        }
    }

    /// True if a tuple has no numbers at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of one tuple.
    pub fn size(&self) -> usize {
        self.offsets.last().copied().unwrap_or(self.bytes)
    }

    /// Appends the tuple as text: numbers separated by one space, no line end. Floating-point numbers have as many
    /// digits as it takes to read back the same bits.
    ///
    /// # Errors
    /// A number that is not finite, or a tuple of another size. `out` then holds a part.
    pub fn render(&self, tuple: &[u8], out: &mut String) -> Result<(), RenderError> {
        self.check_size(tuple.len())?;
        if self.is_text {
            let end = tuple.iter().position(|&byte| byte == 0);
            let text = std::str::from_utf8(&tuple[..end.unwrap_or(tuple.len())]);
            let text = text.ok().filter(|text| !text.chars().any(char::is_control));
            out.push_str(text.ok_or(RenderError::NotText)?);
            return Ok(());
        }
        for index in 0..self.len() {
            if index > 0 {
                out.push(' ');
            }
            self.render_field(index, tuple, out)?;
        }
        Ok(())
    }

    /// Appends one number of the tuple.
    ///
    /// # Errors
    /// As [`render`](Self::render), or no such field.
    pub fn render_field(
        &self,
        index: usize,
        tuple: &[u8],
        out: &mut String,
    ) -> Result<(), RenderError> {
        let (kind, big_endian, range) = self.at(index)?;
        let bytes = tuple
            .get(range)
            .ok_or_else(|| self.wrong_size(tuple.len()))?;
        let written = match Number::decode(kind, big_endian, bytes) {
            Number::Signed(n) => write!(out, "{n}"),
            Number::Unsigned(n) => write!(out, "{n}"),
            Number::Single(x) if !x.is_finite() => {
                return Err(RenderError::NotFinite(self.title(index), x.into()));
            }
            Number::Double(x) if !x.is_finite() => {
                return Err(RenderError::NotFinite(self.title(index), x));
            }
            Number::Single(x) if plain(x.into()) => write!(out, "{x}"),
            Number::Single(x) => write!(out, "{x:e}"),
            Number::Double(x) if plain(x) => write!(out, "{x}"),
            Number::Double(x) => write!(out, "{x:e}"),
        };
        // Writing to a string cannot fail.
        let _ = written;
        Ok(())
    }

    /// Reads text as [`render`](Self::render) writes it; any white space separates, hexadecimal integers (`0x1f`) are
    /// understood. `out` must have the size of a tuple.
    ///
    /// # Errors
    /// `out` may then hold a part.
    pub fn encode(&self, text: &str, out: &mut [u8]) -> Result<(), EncodeError> {
        self.check_size(out.len())?;
        if self.is_text {
            return encode_text(text, out);
        }
        let mut words = text.split_ascii_whitespace();
        for index in 0..self.len() {
            let word = words.next().ok_or_else(|| self.wrong_count(index))?;
            self.encode_field(index, word, out)?;
        }
        match words.count() {
            0 => Ok(()),
            more => Err(self.wrong_count(self.len() + more)),
        }
    }

    /// Reads one number into its place in a tuple; the other bytes stay.
    ///
    /// # Errors
    /// As [`encode`](Self::encode), or no such field.
    pub fn encode_field(
        &self,
        index: usize,
        text: &str,
        out: &mut [u8],
    ) -> Result<(), EncodeError> {
        let (kind, big_endian, range) = self.at(index)?;
        let size = out.len();
        let place = out.get_mut(range).ok_or_else(|| self.wrong_size(size))?;
        let number = Number::parse(kind, text.trim()).map_err(|error| match error {
            EncodeError::Syntax(what) => {
                EncodeError::Syntax(format!("{}: {what}", self.title(index)))
            }
            EncodeError::Range(what) => {
                EncodeError::Range(format!("{}: {what}", self.title(index)))
            }
        })?;
        number.store(kind, big_endian, place);
        Ok(())
    }

    /// Writes numbers into a tuple as if they stood in a `value` file.
    ///
    /// # Errors
    /// As [`encode`](Self::encode).
    pub fn encode_numbers(&self, numbers: &[f64], out: &mut [u8]) -> Result<(), EncodeError> {
        if self.is_text {
            return Err(EncodeError::Syntax(
                "numbers where a text belongs".to_owned(),
            ));
        }
        let mut text = String::new();
        for number in numbers {
            // Writing to a string cannot fail.
            let _ = write!(text, "{number} ");
        }
        self.encode(&text, out)
    }

    fn at(&self, index: usize) -> Result<(FieldKind, bool, Range<usize>), RenderError> {
        if let (Some(field), Some(start)) = (self.fields.get(index), self.offsets.get(index)) {
            return Ok((
                field.kind,
                field.big_endian,
                *start..start + field.kind.size(),
            ));
        }
        if index < self.len() {
            return Ok((FieldKind::U8, false, index..index + 1));
        }
        Err(RenderError::NoField {
            index,
            numbers: self.len(),
        })
    }

    fn title(&self, index: usize) -> String {
        match self.fields.get(index) {
            Some(field) => format!("field '{}'", field.name),
            None => format!("byte {index}"),
        }
    }

    fn check_size(&self, size: usize) -> Result<(), RenderError> {
        if size == self.size() {
            Ok(())
        } else {
            Err(self.wrong_size(size))
        }
    }

    fn wrong_size(&self, size: usize) -> RenderError {
        RenderError::Size {
            tuple: size,
            format: self.size(),
        }
    }

    fn wrong_count(&self, count: usize) -> EncodeError {
        let s = if count == 1 { "" } else { "s" };
        EncodeError::Syntax(format!("{count} number{s} where {} belong", self.len()))
    }
}

impl fmt::Display for Format {
    /// The canonical text: one space after each type, a comma and a space after each field.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_text {
            return write!(f, "text {}", self.bytes);
        }
        if self.fields.is_empty() {
            return write!(f, "u8 x {}", self.bytes);
        }
        for (index, field) in self.fields.iter().enumerate() {
            let comma = if index > 0 { ", " } else { "" };
            let order = if field.big_endian { ">" } else { "" };
            write!(f, "{comma}{order}{} {}", field.kind.word(), field.name)?;
        }
        Ok(())
    }
}

impl Field {
    fn parse(text: &str) -> Result<Self, Error> {
        let text = text.trim();
        let (big_endian, rest) = match text.strip_prefix('>') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let mut words = rest.split_whitespace();
        let word = words.next().ok_or_else(|| {
            Error::Text("format has an empty field; write for example 'i16 x, i16 y'".into())
        })?;
        let Some((_, kind)) = FieldKind::WORDS.iter().find(|(known, _)| *known == word) else {
            let hint = suggestion(word, FieldKind::WORDS.iter().map(|(known, _)| *known));
            return Err(Error::Text(format!(
                "format has an unknown type '{}'{hint}",
                shorten(word)
            )));
        };
        let name = words
            .next()
            .ok_or_else(|| Error::Text(format!("format has a field '{word}' without a name")))?;
        if let Some(more) = words.next() {
            return Err(Error::Text(format!(
                "format wants a comma before '{}'",
                shorten(more)
            )));
        }
        let mut letters = name.chars();
        let first = letters
            .next()
            .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
        if !first || !letters.all(|c| c.is_ascii_alphanumeric() || c == '_') || name.len() > 64 {
            return Err(Error::Text(format!(
                "format has a field with the bad name '{}'",
                shorten(name)
            )));
        }
        Ok(Self {
            name: name.to_owned(),
            kind: *kind,
            big_endian,
        })
    }
}

/// The beginning of a text that goes into a message.
fn shorten(text: &str) -> String {
    text.chars()
        .take(32)
        .flat_map(char::escape_default)
        .collect()
}

/// Without an exponent the text stays short.
fn plain(x: f64) -> bool {
    x == 0.0 || (1e-5..1e16).contains(&x.abs())
}

/// A number of any field type, without loss.
#[derive(Clone, Copy)]
enum Number {
    Signed(i64),
    Unsigned(u64),
    Single(f32),
    Double(f64),
}

impl Number {
    /// `bytes` has the size of the kind.
    fn decode(kind: FieldKind, big_endian: bool, bytes: &[u8]) -> Self {
        let mut word = [0; 8];
        for (place, byte) in word.iter_mut().zip(bytes) {
            *place = *byte;
        }
        if big_endian {
            word[..kind.size()].reverse();
        }
        let bits = u64::from_le_bytes(word);
        match kind {
            FieldKind::I8 => Self::Signed((bits as i8).into()),
            FieldKind::I16 => Self::Signed((bits as i16).into()),
            FieldKind::I32 => Self::Signed((bits as i32).into()),
            FieldKind::I64 => Self::Signed(bits as i64),
            FieldKind::U8 | FieldKind::U16 | FieldKind::U32 | FieldKind::U64 => {
                Self::Unsigned(bits)
            }
            FieldKind::F32 => Self::Single(f32::from_bits(bits as u32)),
            FieldKind::F64 => Self::Double(f64::from_bits(bits)),
        }
    }

    /// `place` has the size of the kind.
    fn store(self, kind: FieldKind, big_endian: bool, place: &mut [u8]) {
        let bits = match self {
            Self::Signed(n) => n as u64,
            Self::Unsigned(n) => n,
            Self::Single(x) => x.to_bits().into(),
            Self::Double(x) => x.to_bits(),
        };
        let mut word = bits.to_le_bytes();
        if big_endian {
            word[..kind.size()].reverse();
        }
        for (to, from) in place.iter_mut().zip(word) {
            *to = from;
        }
    }

    fn parse(kind: FieldKind, text: &str) -> Result<Self, EncodeError> {
        match kind {
            FieldKind::I8 => Self::signed(text, i8::MIN.into(), i8::MAX.into()),
            FieldKind::I16 => Self::signed(text, i16::MIN.into(), i16::MAX.into()),
            FieldKind::I32 => Self::signed(text, i32::MIN.into(), i32::MAX.into()),
            FieldKind::I64 => Self::signed(text, i64::MIN, i64::MAX),
            FieldKind::U8 => Self::unsigned(text, u8::MAX.into()),
            FieldKind::U16 => Self::unsigned(text, u16::MAX.into()),
            FieldKind::U32 => Self::unsigned(text, u32::MAX.into()),
            FieldKind::U64 => Self::unsigned(text, u64::MAX),
            FieldKind::F32 => {
                let x: f32 = real(text)?;
                if x.is_finite() {
                    Ok(Self::Single(x))
                } else {
                    Err(out_of_range(text, f32::MIN, f32::MAX))
                }
            }
            FieldKind::F64 => {
                let x: f64 = real(text)?;
                if x.is_finite() {
                    Ok(Self::Double(x))
                } else {
                    Err(out_of_range(text, f64::MIN, f64::MAX))
                }
            }
        }
    }

    fn signed(text: &str, min: i64, max: i64) -> Result<Self, EncodeError> {
        let wide = whole(text)?.filter(|n| (i128::from(min)..=i128::from(max)).contains(n));
        let fits = wide.and_then(|n| i64::try_from(n).ok());
        fits.map(Self::Signed)
            .ok_or_else(|| out_of_range(text, min, max))
    }

    fn unsigned(text: &str, max: u64) -> Result<Self, EncodeError> {
        let wide = whole(text)?.filter(|n| *n <= max.into());
        let fits = wide.and_then(|n| u64::try_from(n).ok());
        fits.map(Self::Unsigned)
            .ok_or_else(|| out_of_range(text, 0, max))
    }
}

/// A whole number; None if it is one but too long for any field.
fn whole(text: &str) -> Result<Option<i128>, EncodeError> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    };
    let (radix, digits) = match digits
        .strip_prefix("0x")
        .or_else(|| digits.strip_prefix("0X"))
    {
        Some(rest) => (16, rest),
        None => (10, digits),
    };
    if digits.is_empty() || !digits.chars().all(|c| c.is_digit(radix)) {
        return Err(EncodeError::Syntax(format!(
            "'{}' is not a whole number",
            shorten(text)
        )));
    }
    let magnitude = i128::from_str_radix(digits, radix).ok();
    Ok(magnitude.map(|n| if negative { -n } else { n }))
}

/// A number with an optional fraction and exponent; the words that Rust also takes (`inf`, `nan`) are not numbers here.
fn real<T: std::str::FromStr>(text: &str) -> Result<T, EncodeError> {
    let digits = text
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, '+' | '-' | '.' | 'e' | 'E'));
    let number = if digits { text.parse().ok() } else { None };
    number.ok_or_else(|| EncodeError::Syntax(format!("'{}' is not a number", shorten(text))))
}

fn encode_text(text: &str, out: &mut [u8]) -> Result<(), EncodeError> {
    if text.chars().any(char::is_control) {
        let reason = "the text has control characters; it is one line";
        return Err(EncodeError::Syntax(reason.to_owned()));
    }
    let (size, most) = (text.len(), out.len());
    let Some(place) = out.get_mut(..size) else {
        let reason = format!("the text has {size} bytes, at most {most} fit");
        return Err(EncodeError::Range(reason));
    };
    place.copy_from_slice(text.as_bytes());
    out[size..].fill(0);
    Ok(())
}

fn out_of_range(text: &str, min: impl fmt::Display, max: impl fmt::Display) -> EncodeError {
    let text = shorten(text);
    // The limits of the floating-point types are forty and three hundred digits long without an exponent.
    let limits = format!("{min}..{max}");
    if limits.len() > 64 {
        return EncodeError::Range(format!("{text} is out of range"));
    }
    EncodeError::Range(format!("{text} is outside {limits}"))
}

#[cfg(test)]
mod tests;
