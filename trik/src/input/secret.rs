//! Files with secrets that a person names: passwords, certificates and keys.
//!
//! Owns how long they may be, and that a password is the first line. Shows nothing of them.

use super::read;
use super::words::{A_FILE, no_text, why};
use crate::error::Error;
use crate::limits;
use std::path::Path;

/// What is in a file.
///
/// # Errors
/// It cannot be read, or is too long.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Error> {
    let most = limits::SECRET_BYTES_MAX;
    read(path, most).map_err(|unread| Error::file(path, why(&unread, most, A_FILE).english))
}

/// The first line of a file.
///
/// # Errors
/// It cannot be read, or is no text.
pub(crate) fn password(path: &Path) -> Result<String, Error> {
    let text = String::from_utf8(bytes(path)?).map_err(|_| Error::file(path, no_text().english))?;
    Ok(text.lines().next().unwrap_or_default().to_owned())
}
