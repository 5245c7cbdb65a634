//! What programs in other languages find because trikd puts it where they look: the Python module `trik`, and trikd
//! itself, which draws for them.

use std::io;
use std::path::Path;

const MODULE: &str = include_str!("../python/trik.py");

/// The name of trikd beside the module.
pub const HELPER: &str = "trikd";

/// Puts the module into `folder`, and a link to this program with the name by which it is trikd.
///
/// # Errors
/// Those of the file system.
pub fn install(folder: &Path) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    crate::scripts::replace(&folder.join("trik.py"), MODULE.as_bytes(), 0o644)?;
    let (link, fresh) = (folder.join(HELPER), folder.join(".trikd"));
    let _ = std::fs::remove_file(&fresh);
    std::os::unix::fs::symlink(std::env::current_exe()?, &fresh)?;
    std::fs::rename(fresh, link)
}
