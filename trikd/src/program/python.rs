//! The Python module `trik`, which programs find because trikd puts it where they look.

use std::io;
use std::path::Path;

/// Its text.
pub const MODULE: &str = include_str!("../python/trik.py");

/// What programs import it from.
const FILE: &str = "trik.py";

/// Puts the module into `folder`.
///
/// # Errors
/// Those of the file system.
pub fn install(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    crate::scripts::replace(&folder.join(FILE), MODULE.as_bytes(), 0o644)
}

/// The same if somebody has removed it since.
///
/// # Errors
/// Those of the file system.
pub fn restore(folder: &Path) -> io::Result<()> {
    match folder.join(FILE).exists() {
        true => Ok(()),
        false => install(folder),
    }
}
