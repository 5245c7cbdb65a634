//! The view of ev3dev beside the tree.
//!
//! Owns its words only; `companion` is its life.

use super::companion::Companion;
use std::ffi::OsString;
use std::path::Path;

/// A view of this tree, at `mountpoint`. It does not run yet.
pub(super) fn of(tree: &Path, mountpoint: &Path) -> Companion {
    // In one word, so that a path that begins with a dash stays a value.
    let mut place = OsString::from("--tree=");
    place.push(tree);
    let arguments = vec![place, "--".into(), mountpoint.into()];
    Companion::new(
        "the view of ev3dev",
        "trikfs-ev3dev",
        ": ready on ",
        arguments,
    )
}
