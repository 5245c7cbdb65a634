//! Names that belong to somebody alone: how they are told from those that a text can say.
//!
//! Knows no names of a project.

use std::rc::Rc;

/// What divides a name from whose own it is; no text has it in a name.
const OWNER: char = '@';

/// The name that stands for `name` where it belongs to the owner of this number alone.
pub fn own_name(name: &str, owner: u32) -> Rc<str> {
    format!("{name}{OWNER}{owner}").into()
}

/// A name as the text has it.
pub fn written(name: &str) -> &str {
    name.split(OWNER).next().unwrap_or(name)
}

/// Whether a name is somebody's own.
pub fn is_own(name: &str) -> bool {
    name.contains(OWNER)
}
