//! How long the text of a tuple can be, for those who keep room for it.
//!
//! Owns a bound for each type, which the longest text of it comes near to. How numbers are written is known to `format`.

use super::{FieldKind, Format};

impl Format {
    /// Bytes that the text of a tuple cannot exceed, its line end included.
    pub fn text_bytes_max(&self) -> usize {
        let of_fields: usize = self
            .fields
            .iter()
            .map(|field| field.kind.text_bytes_max())
            .sum();
        match (self.is_text, self.fields.is_empty()) {
            (true, _) => self.bytes + 1,
            (false, true) => self.bytes * FieldKind::U8.text_bytes_max(),
            (false, false) => of_fields,
        }
    }
}

impl FieldKind {
    /// Bytes of the longest number of this type, and of what separates it from the next one.
    fn text_bytes_max(self) -> usize {
        match self {
            Self::U8 => "255 ".len(),
            Self::I8 => "-128 ".len(),
            Self::U16 | Self::I16 => "-32768 ".len(),
            Self::U32 | Self::I32 => "-2147483648 ".len(),
            Self::I64 | Self::U64 => "-9223372036854775808 ".len(),
            Self::F32 => "-1.17549435e-38 ".len(),
            Self::F64 => "-2.2250738585072014e-308 ".len(),
        }
    }
}
