//! A text with models on its way from a file, standard input or a shipped model to crate `lang-dcml`.
//!
//! Owns which files are read, and what is said of one that cannot be.

use crate::refusal::{Refusal, UNREADABLE};
use lang_dcml::limits::DCML_TEXT_MAX;
use lang_dcml::models as shipped;
use lang_dcml::{Understood, understand, understand_paper};
use std::fs::File;
use std::io::{self, Read};
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
    let bytes = if is_input {
        bytes(io::stdin().lock())
    } else {
        File::open(path).and_then(bytes)
    };
    if let (Err(error), Some(model)) = (&bytes, shipped::named(&name))
        && error.kind() == io::ErrorKind::NotFound
    {
        let text = model.text.to_owned();
        return Ok(Source { name, text });
    }
    let bytes = bytes.map_err(|error| {
        unreadable(match error.kind() {
            io::ErrorKind::NotFound => "there is no such file".to_owned(),
            io::ErrorKind::IsADirectory => {
                "this is a directory: name a file with models".to_owned()
            }
            _ => format!("cannot be read: {error}"),
        })
    })?;
    if bytes.len() > DCML_TEXT_MAX {
        let mib = DCML_TEXT_MAX >> 20;
        return Err(unreadable(format!(
            "longer than {mib} MiB, which no model is"
        )));
    }
    match lang_dcml::decode(bytes) {
        Ok(text) => Ok(Source { name, text }),
        Err(why) => Err(Refusal {
            lines: vec![format!("trik: {name}:{why}")],
            code: UNREADABLE,
        }),
    }
}

/// One byte more than may be, so that it can be seen.
fn bytes(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(DCML_TEXT_MAX as u64 + 1)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Understands a text, as the published language if that is wanted.
pub(super) fn understood(source: &Source, paper: bool) -> Understood {
    if paper {
        understand_paper(&source.text)
    } else {
        understand(&source.text)
    }
}
