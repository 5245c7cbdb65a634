//! A program of blocks on its way from its file to crate `studio`.
//!
//! Owns how the file is read. What its bytes are is known in `studio`.

use super::save::bytes;
use std::path::Path;

pub(crate) use studio::program::{Flow, Program, is_of_blocks, is_text, unread, with_main};
use studio::program::{Unreadable, of_bytes};

/// Reads a save or a text. `diagram` is the main diagram that is run, if it is not the first one.
pub(crate) fn open(path: &Path, diagram: Option<&str>) -> Result<Program, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    of_bytes(bytes, is_text(path), diagram)
}
