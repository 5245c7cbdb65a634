//! Files of the robot's tree as the page opens them: by the path of a node, and without waiting for a device.
//!
//! Owns which paths a browser may name. Knows no browser, and not what becomes of a value.

use crate::error::Error;
use crate::limits;
use std::fs::OpenOptions;
use std::io::{self, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Component, Path, PathBuf};

/// Nothing here waits for a device.
pub const NONBLOCK: i32 = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();

/// The directory of a node.
///
/// # Errors
/// The text leads elsewhere.
pub fn node(tree: &Path, path: &str) -> Result<PathBuf, Error> {
    let is_plain = |part: Component| matches!(part, Component::Normal(_));
    let is_path = !path.is_empty()
        && path.len() <= limits::PATH_BYTES_MAX
        && !path.contains('\0')
        && Path::new(path).components().all(is_plain);
    if !is_path {
        return Err(Error::Path(
            path.chars().take(limits::REPEATED_MAX).collect(),
        ));
    }
    Ok(tree.join(path))
}

/// What the file of a value says now. One that would have to be waited for is an error.
pub fn read(file: &Path) -> io::Result<String> {
    let mut text = String::new();
    let mut options = OpenOptions::new();
    let opened = options.read(true).custom_flags(NONBLOCK).open(file)?;
    opened
        .take(limits::WORDS_BYTES_MAX as u64)
        .read_to_string(&mut text)?;
    Ok(text)
}
