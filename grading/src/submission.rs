//! What somebody hands in: a file for a task, known by what is in it.
//!
//! Owns its form as a message. Two that are the same have the same id, so that nothing is judged twice.

use crate::error::Error;
use crate::limits::{NAME_CHARS_MAX, SUBMISSION_BYTES_MAX};
use crate::names::{FILE, TASK};
use async_nats::{HeaderMap, Message};
use ring::digest::{Context, SHA256};
use std::fmt::Write;

/// A solution that waits to be judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Submission {
    task: String,
    file: String,
    bytes: Vec<u8>,
}

impl Submission {
    /// A file of this name for a task.
    ///
    /// # Errors
    /// A name that cannot be one, or too many bytes.
    pub fn new(task: &str, file: &str, bytes: Vec<u8>) -> Result<Self, Error> {
        for name in [task, file] {
            if !is_name(name) {
                return Err(Error::Name(name.to_owned()));
            }
        }
        if bytes.len() > SUBMISSION_BYTES_MAX {
            return Err(Error::TooLarge(bytes.len(), SUBMISSION_BYTES_MAX));
        }
        Ok(Self {
            task: task.to_owned(),
            file: file.to_owned(),
            bytes,
        })
    }

    /// As a message has it.
    ///
    /// # Errors
    /// A header is missing, or what [`Submission::new`] says.
    pub fn read(message: &Message) -> Result<Self, Error> {
        let header = |name| {
            let headers = message.headers.as_ref();
            let value = headers.and_then(|headers| headers.get(name));
            value
                .map(|value| value.as_str())
                .ok_or(Error::NoHeader(name))
        };
        Self::new(header(TASK)?, header(FILE)?, message.payload.to_vec())
    }

    /// The headers of its message; the bytes are its payload.
    pub fn headers(&self) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(TASK, &*self.task);
        headers.insert(FILE, &*self.file);
        headers
    }

    /// The task.
    pub fn task(&self) -> &str {
        &self.task
    }

    /// The name of the file.
    pub fn file(&self) -> &str {
        &self.file
    }

    /// What is in it.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// SHA-256 over the task, the name and the content, as 64 letters.
    pub fn id(&self) -> String {
        let mut all = Context::new(&SHA256);
        for name in [&self.task, &self.file] {
            all.update(name.as_bytes());
            // No name has one.
            all.update(&[0]);
        }
        all.update(&self.bytes);
        hex(all.finish().as_ref())
    }
}

/// The id of a message that is no submission, so that it can be told of.
pub fn id_of_rubbish(message: &Message) -> String {
    hex(ring::digest::digest(&SHA256, &message.payload).as_ref())
}

fn hex(bytes: &[u8]) -> String {
    let mut text = String::new();
    for byte in bytes {
        // Writing to a text cannot fail.
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// A header takes no control characters, and a file is below no other folder.
fn is_name(name: &str) -> bool {
    let has_wrong = name.contains(|letter: char| letter == '/' || letter.is_control());
    (1..=NAME_CHARS_MAX).contains(&name.chars().count())
        && !has_wrong
        && !name.starts_with('.')
        && name.trim() == name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_file_for_the_same_task_is_one_and_anything_else_is_another() {
        let one =
            |task, file, bytes: &[u8]| Submission::new(task, file, bytes.to_vec()).unwrap().id();
        let first = one("line", "a.qrs", b"x");
        assert_eq!(first.len(), 64);
        assert_eq!(first, one("line", "a.qrs", b"x"));
        for other in [
            one("lin", "ea.qrs", b"x"),
            one("line", "b.qrs", b"x"),
            one("line", "a.qrs", b"y"),
            one("line", "a.qrsx", b""),
        ] {
            assert_ne!(first, other);
        }
    }

    #[test]
    fn names_are_those_of_files_in_a_folder() {
        for name in ["line", "a b.qrs", "\u{43b}\u{438}\u{43d}\u{438}\u{44f}.js"] {
            assert!(Submission::new(name, name, Vec::new()).is_ok(), "{name}");
        }
        let long = "a".repeat(NAME_CHARS_MAX + 1);
        for name in [
            "", ".", "..", ".a", "a/b", "../a", "a\nb", "a\0b", " a", "a ", &long,
        ] {
            let refused = Submission::new(name, "a.qrs", Vec::new());
            assert_eq!(refused, Err(Error::Name(name.to_owned())));
            assert!(Submission::new("line", name, Vec::new()).is_err());
        }
        let large = vec![0; SUBMISSION_BYTES_MAX + 1];
        let refused = Submission::new("line", "a.qrs", large).unwrap_err();
        assert_eq!(
            refused,
            Error::TooLarge(SUBMISSION_BYTES_MAX + 1, SUBMISSION_BYTES_MAX)
        );
    }
}
