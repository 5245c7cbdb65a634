//! Programs in languages with text under a judge: JavaScript and Python in virtual time.
//!
//! Owns the engines: `stage` is where JavaScript stands, `javascript` steps its threads; `python` serves a child process. What
//! answers them is `studio::script`.

mod javascript;
mod python;
mod stage;

pub use javascript::JavaScript;
pub use python::Python;

use std::path::{Component, Path};
use trikd::js::files::{Unread, read_text};

/// A file of the program's folder: programs under a judge see nothing else.
fn beside(folder: &Path, file: &str) -> Result<String, Unread> {
    let is_plain = Path::new(file)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    if !is_plain {
        return Err(Unread::Outside(file.to_owned()));
    }
    read_text(&folder.join(file))
}

#[cfg(test)]
mod tests;
