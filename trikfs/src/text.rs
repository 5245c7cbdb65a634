//! Text that programs write, turned into tuples: the errors of the format in terms of errno.
//!
//! Owns only that translation; the formats are the configuration's.

use crate::errno::Error;
use config::format::{EncodeError, Format};

fn refused(error: EncodeError) -> Error {
    match error {
        EncodeError::Syntax(what) => Error::Invalid(what),
        EncodeError::Range(what) => Error::OutOfRange(what),
    }
}

/// All numbers of a tuple, separated by white space.
pub fn encode(format: &Format, text: &str, tuple: &mut [u8]) -> Result<(), Error> {
    format.encode(text, tuple).map_err(refused)
}

/// One number of a tuple.
pub fn encode_field(
    format: &Format,
    index: usize,
    text: &str,
    tuple: &mut [u8],
) -> Result<(), Error> {
    format.encode_field(index, text, tuple).map_err(refused)
}

/// What was written, as text: UTF-8 without white space around it.
pub fn from_bytes(data: &[u8]) -> Result<&str, Error> {
    if data.len() > crate::limits::TEXT_BYTES_MAX {
        return Err(Error::Invalid("the text is too long".to_owned()));
    }
    let text = std::str::from_utf8(data).map_err(|_| Error::Invalid("not a number".to_owned()))?;
    let text = text.trim();
    if text.is_empty() {
        Err(Error::Invalid("nothing was written".to_owned()))
    } else {
        Ok(text)
    }
}
