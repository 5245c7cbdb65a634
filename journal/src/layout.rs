//! The layout of a tuple as the `format` file of its node tells it, and the numbers in a tuple.
//!
//! Owns reading that text, which is the contract with the tree: `i16 x, >u16 y`, `u8 x 4` for bytes without names, `text 64`.
//! What a configuration may say beyond that is known to `config`.

use crate::error::Error;
use crate::limits::{FIELDS_MAX, FORMAT_BYTES_MAX, TUPLE_BYTES_MAX};

/// Type of one number. It is `FieldKind` of `config` again: recordings are read by programs that link no configuration,
/// and what they hold stays readable when configurations have other types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
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

impl Kind {
    /// The words of the tree, and those of ros2msg.
    const WORDS: [(&'static str, &'static str, Self); 10] = [
        ("i8", "int8", Self::I8),
        ("u8", "uint8", Self::U8),
        ("i16", "int16", Self::I16),
        ("u16", "uint16", Self::U16),
        ("i32", "int32", Self::I32),
        ("u32", "uint32", Self::U32),
        ("i64", "int64", Self::I64),
        ("u64", "uint64", Self::U64),
        ("f32", "float32", Self::F32),
        ("f64", "float64", Self::F64),
    ];

    /// Bytes of one number.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Its word in ros2msg.
    pub(crate) fn ros(self) -> &'static str {
        let found = Self::WORDS.iter().find(|(_, _, kind)| *kind == self);
        found.map_or("", |(_, word, _)| word)
    }
}

/// One named number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: Kind,
    /// Most significant byte first.
    pub is_big_endian: bool,
}

/// The layout of a tuple.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Named numbers, one after the other.
    Fields(Vec<Field>),
    /// So many bytes without names.
    Bytes(usize),
    /// One text, filled up with zero bytes to this size.
    Text(usize),
}

/// One number of a tuple.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// Of a signed type.
    Signed(i64),
    /// Of an unsigned type.
    Unsigned(u64),
    /// Of 32 bits; kept apart, because its shortest text differs.
    Single(f32),
    /// Of 64 bits.
    Double(f64),
}

impl Number {
    /// As a number for a graph; integers beyond 2^53 are rounded.
    #[allow(
        clippy::cast_precision_loss,
        reason = "a graph has no more digits than these"
    )]
    pub fn to_f64(self) -> f64 {
        match self {
            Self::Signed(number) => number as f64,
            Self::Unsigned(number) => number as f64,
            Self::Single(number) => number.into(),
            Self::Double(number) => number,
        }
    }
}

impl std::fmt::Display for Number {
    /// With as many digits as it takes to read back the same number.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Signed(number) => write!(f, "{number}"),
            Self::Unsigned(number) => write!(f, "{number}"),
            Self::Single(number) => write!(f, "{number}"),
            Self::Double(number) => write!(f, "{number}"),
        }
    }
}

impl Layout {
    /// Reads the text of a `format` file.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let text = text.trim();
        let bad = |why: &str| {
            let shown: String = text.chars().take(60).flat_map(char::escape_debug).collect();
            Err(Error::Format(format!("the format '{shown}' {why}")))
        };
        if text.len() > FORMAT_BYTES_MAX {
            return bad("is too long");
        }
        let size = |digits: &str| -> Option<usize> {
            let size = digits.trim().parse().ok()?;
            (1..=TUPLE_BYTES_MAX).contains(&size).then_some(size)
        };
        if let Some(digits) = text.strip_prefix("u8 x ") {
            return size(digits).map_or_else(|| bad("has no size"), |size| Ok(Self::Bytes(size)));
        }
        if let Some(digits) = text.strip_prefix("text ") {
            return size(digits).map_or_else(|| bad("has no size"), |size| Ok(Self::Text(size)));
        }
        let mut fields: Vec<Field> = Vec::new();
        for part in text.split(',') {
            let Some(field) = field(part) else {
                return bad("has a field that is not TYPE NAME");
            };
            if fields.len() == FIELDS_MAX {
                return bad("has too many fields");
            }
            fields.push(field);
        }
        Ok(Self::Fields(fields))
    }

    /// Bytes of one tuple.
    pub fn size(&self) -> usize {
        match self {
            Self::Fields(fields) => fields.iter().map(|field| field.kind.size()).sum(),
            Self::Bytes(size) | Self::Text(size) => *size,
        }
    }

    /// Names of its numbers; `0`, `1` and so on for bytes without names; none for a text.
    pub fn names(&self) -> Vec<String> {
        match self {
            Self::Fields(fields) => fields.iter().map(|field| field.name.clone()).collect(),
            Self::Bytes(size) => (0..*size).map(|at| at.to_string()).collect(),
            Self::Text(_) => Vec::new(),
        }
    }

    /// The numbers of a tuple, in the order of their names; none if it has another size.
    pub fn numbers(&self, tuple: &[u8]) -> Vec<Number> {
        if tuple.len() != self.size() {
            return Vec::new();
        }
        match self {
            Self::Text(_) => Vec::new(),
            Self::Bytes(_) => tuple
                .iter()
                .map(|byte| Number::Unsigned((*byte).into()))
                .collect(),
            Self::Fields(fields) => {
                let mut rest = tuple;
                let mut numbers = Vec::with_capacity(fields.len());
                for field in fields {
                    let (bytes, after) = rest.split_at(field.kind.size());
                    numbers.push(number(field.kind, field.is_big_endian, bytes));
                    rest = after;
                }
                numbers
            }
        }
    }

    /// The tuple as the `value` file shows it, but that a number that is not finite is shown too.
    pub fn show(&self, tuple: &[u8]) -> String {
        if let Self::Text(_) = self {
            return text(tuple).to_owned();
        }
        let numbers: Vec<String> = self.numbers(tuple).iter().map(Number::to_string).collect();
        numbers.join(" ")
    }
}

/// A text without the zero bytes after it; empty if it is none.
pub(crate) fn text(tuple: &[u8]) -> &str {
    let end = tuple.iter().position(|&byte| byte == 0);
    std::str::from_utf8(&tuple[..end.unwrap_or(tuple.len())]).unwrap_or("")
}

fn field(part: &str) -> Option<Field> {
    let part = part.trim();
    let (is_big_endian, rest) = match part.strip_prefix('>') {
        Some(rest) => (true, rest),
        None => (false, part),
    };
    let (word, name) = rest.split_once(' ')?;
    let (_, _, kind) = Kind::WORDS.iter().find(|(known, _, _)| *known == word)?;
    let is_name = !name.is_empty()
        && name.len() <= 64
        && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    is_name.then(|| Field {
        name: name.to_owned(),
        kind: *kind,
        is_big_endian,
    })
}

/// Bytes of this type as a number; `bytes` has its size.
fn number(kind: Kind, is_big_endian: bool, bytes: &[u8]) -> Number {
    let mut wide = [0; 8];
    let size = bytes.len().min(8);
    wide[..size].copy_from_slice(&bytes[..size]);
    if is_big_endian {
        wide[..size].reverse();
    }
    let bits = u64::from_le_bytes(wide);
    let unused = 64 - 8 * u32::try_from(size).unwrap_or(8);
    match kind {
        Kind::U8 | Kind::U16 | Kind::U32 | Kind::U64 => Number::Unsigned(bits),
        Kind::I8 | Kind::I16 | Kind::I32 | Kind::I64 => {
            Number::Signed((bits << unused).cast_signed() >> unused)
        }
        Kind::F32 => {
            let [a, b, c, d, ..] = wide;
            Number::Single(f32::from_le_bytes([a, b, c, d]))
        }
        Kind::F64 => Number::Double(f64::from_bits(bits)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_the_tree_are_layouts() {
        let layout = Layout::parse("i16 x, >u16 y, f32 z, i8 w\n").unwrap();
        assert_eq!(layout.size(), 9);
        assert_eq!(layout.names(), ["x", "y", "z", "w"]);
        let mut tuple = vec![0xfe, 0xff, 0x01, 0x02];
        tuple.extend_from_slice(&1.5_f32.to_le_bytes());
        tuple.push(0x80);
        assert_eq!(layout.show(&tuple), "-2 258 1.5 -128");
        assert_eq!(Layout::parse("u8 x 4"), Ok(Layout::Bytes(4)));
        assert_eq!(Layout::Bytes(2).show(&[7, 255]), "7 255");
        assert_eq!(Layout::parse("text 8"), Ok(Layout::Text(8)));
        assert_eq!(Layout::Text(8).show(b"green\0\0\0"), "green");
        let wide = Layout::parse("i64 a, u64 b").unwrap();
        let mut tuple = i64::MIN.to_le_bytes().to_vec();
        tuple.extend_from_slice(&u64::MAX.to_le_bytes());
        assert_eq!(
            wide.show(&tuple),
            "-9223372036854775808 18446744073709551615"
        );
    }

    #[test]
    fn other_texts_are_refused() {
        for text in [
            "",
            "x",
            "i16",
            "i15 x",
            "i16 x y",
            "u8 x 0",
            "text x",
            "u8 x 99999999",
        ] {
            assert!(
                matches!(Layout::parse(text), Err(Error::Format(_))),
                "{text}"
            );
        }
        let many = vec!["u8 a"; FIELDS_MAX + 1].join(",");
        assert!(Layout::parse(&many).is_err());
    }

    #[test]
    fn a_tuple_of_another_size_has_no_numbers() {
        assert!(Layout::Bytes(2).numbers(&[1]).is_empty());
    }
}
