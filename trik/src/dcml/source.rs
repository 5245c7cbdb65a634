//! A text with models on its way from a file, standard input or a shipped model to crate `lang-dcml`.
//!
//! Owns which files are read, and what is said of one that cannot be.

use crate::input::{self, Unread};
use crate::refusal::{Refusal, UNREADABLE};
use lang_dcml::limits::DCML_TEXT_MAX;
use lang_dcml::models as shipped;
use lang_dcml::{Understood, understand, understand_paper};
use std::io;
use std::path::Path;

/// A text with models, and how it is called in messages.
pub(crate) struct Source {
    /// Its file.
    pub name: String,
    /// All of it.
    pub text: String,
}

/// The text of a file, of standard input for `-`, or of a model that comes with the program where there is no file.
pub(crate) fn read(path: &Path) -> Result<Source, Refusal> {
    let is_input = path == Path::new("-");
    let name = if is_input {
        "<stdin>".to_owned()
    } else {
        path.to_string_lossy().into_owned()
    };
    let unreadable = |why: String| Refusal {
        lines: vec![format!("trik: {name}: {why}")],
        code: UNREADABLE,
    };
    let most = DCML_TEXT_MAX as u64;
    let bytes = if is_input {
        input::all_of(io::stdin().lock(), most)
    } else {
        input::read(path, most)
    };
    if let (Err(Unread::Missing), Some(model)) = (&bytes, shipped::named(&name)) {
        let text = model.text.to_owned();
        return Ok(Source { name, text });
    }
    let bytes = bytes.map_err(|unread| {
        unreadable(match unread {
            Unread::Missing => format!("there is no such file; {}", shipped::advice(&name)),
            Unread::Directory => "this is a directory: name a file with models".to_owned(),
            Unread::TooLong => format!("longer than {} MiB, which no model is", most >> 20),
            Unread::Silent => "nothing comes out of this FIFO or device: name a file".to_owned(),
            Unread::Failed(error) => format!("cannot be read: {error}"),
        })
    })?;
    match lang_dcml::decode(bytes) {
        Ok(text) => Ok(Source { name, text }),
        Err(why) => Err(Refusal {
            lines: vec![format!("trik: {name}:{why}")],
            code: UNREADABLE,
        }),
    }
}

/// Understands a text, as the published language if that is wanted.
pub(super) fn understood(source: &Source, paper: bool) -> Understood {
    if paper {
        understand_paper(&source.text)
    } else {
        understand(&source.text)
    }
}
