//! Why a tuple could not become text, and text no tuple.
//!
//! Owns both errors and their words. Each case says which side can mend it.

use std::fmt;

/// Why text could not become a tuple.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EncodeError {
    /// Not numbers, or not as many as the format has.
    Syntax(String),
    /// A number that its field cannot hold.
    Range(String),
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Syntax(text) | Self::Range(text)) = self;
        f.write_str(text)
    }
}

impl std::error::Error for EncodeError {}

/// Why a tuple could not become text.
#[derive(Clone, Debug, PartialEq)]
pub enum RenderError {
    /// The field or byte of this title is no finite number; the converter gave it.
    NotFinite(String, f64),
    /// A text that is none; the converter or the device gave it.
    NotText,
    /// A tuple of another size than the format's; the caller gave it.
    Size {
        /// Bytes of the tuple.
        tuple: usize,
        /// Bytes of the format.
        format: usize,
    },
    /// No such number; the caller asked for it.
    NoField {
        /// Which was asked for.
        index: usize,
        /// How many there are.
        numbers: usize,
    },
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite(title, number) => write!(f, "{title} is {number}"),
            Self::NotText => f.write_str("the text is no UTF-8, or has control characters"),
            Self::Size { tuple, format } => {
                write!(f, "the tuple has {tuple} bytes, the format {format}")
            }
            Self::NoField { index, numbers } => write!(
                f,
                "value{index} does not exist: the tuple has {numbers} numbers"
            ),
        }
    }
}

impl std::error::Error for RenderError {}

impl From<RenderError> for EncodeError {
    /// Text has no way into a tuple that it would not come out of.
    fn from(error: RenderError) -> Self {
        Self::Syntax(error.to_string())
    }
}
