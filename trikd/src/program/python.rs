//! The Python module `trik`, which programs find because trikd puts it where they look.

use std::io;
use std::path::Path;

/// Its text.
pub const MODULE: &str = include_str!("../python/trik.py");

/// Puts the module into `folder`.
///
/// # Errors
/// Those of the file system.
pub fn install(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    crate::scripts::replace(&folder.join("trik.py"), MODULE.as_bytes(), 0o644)
}
