//! What somebody hands in: a file for a task, known by what is in it.
//!
//! Owns its form as a message. Two that are the same have the same id, so that nothing is judged twice.

use crate::error::Error;
use crate::kept::{Kept, fields};
use crate::limits::{NAME_BYTES_MAX, SUBMISSION_BYTES_MAX};
use crate::names::{FILE, SUBMIT, TASK};
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
    /// A header is missing, it stands under the subject of another one, or what [`Submission::new`] says.
    pub fn read(message: &Message) -> Result<Self, Error> {
        let header = |name| {
            let headers = message.headers.as_ref();
            let value = headers.and_then(|headers| headers.get(name));
            value.map(|value| value.as_str())
        };
        Self::of(&message.subject, header, &message.payload)
    }

    /// As the server keeps it.
    ///
    /// # Errors
    /// A header that nobody can read, or what [`Submission::read`] says.
    pub fn kept(message: &Kept) -> Result<Self, Error> {
        let all = fields(&message.header).ok_or(Error::Unreadable)?;
        let header = |name| {
            let mut all = all.iter();
            all.find(|(other, _)| *other == name)
                .map(|(_, value)| *value)
        };
        Self::of(&message.subject, header, &message.bytes)
    }

    fn of<'a>(
        subject: &str,
        header: impl Fn(&'static str) -> Option<&'a str>,
        bytes: &[u8],
    ) -> Result<Self, Error> {
        let must = |name| header(name).ok_or(Error::NoHeader(name));
        let submission = Self::new(must(TASK)?, must(FILE)?, bytes.to_vec())?;
        let is_its = subject.strip_prefix(SUBMIT) == Some(&*submission.id());
        is_its.then_some(submission).ok_or(Error::Place)
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

/// The id of a message that is no submission, so that it can be told of. No submission can have it: there the task comes first, and
/// none is empty.
pub fn id_of_rubbish(subject: &str, bytes: &[u8]) -> String {
    let mut all = Context::new(&SHA256);
    for part in [&[0], subject.as_bytes(), &[0], bytes] {
        all.update(part);
    }
    hex(all.finish().as_ref())
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
    (1..=NAME_BYTES_MAX).contains(&name.len())
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
        // 254 bytes, and 256.
        let long = "\u{44f}".repeat(NAME_BYTES_MAX / 2);
        assert!(Submission::new(&long, &long, Vec::new()).is_ok());
        let long = "\u{44f}".repeat(NAME_BYTES_MAX / 2 + 1);
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

    #[test]
    fn what_stands_elsewhere_or_cannot_be_read_is_no_submission() {
        let one = Submission::new("line", "a.js", b"x".to_vec()).unwrap();
        let header = b"NATS/1.0\r\nTrik-File: a.js\r\nTrik-Task: line\r\n\r\n";
        let kept = |subject: String, header: &[u8]| {
            let (header, bytes) = (header.to_vec(), b"x".to_vec());
            let kept = Kept {
                subject,
                header,
                bytes,
                ..Kept::default()
            };
            Submission::kept(&kept)
        };
        let id = one.id();
        assert_eq!(kept(format!("{SUBMIT}{id}"), header), Ok(one));
        let other = id_of_rubbish(&format!("{SUBMIT}{id}"), b"x");
        for elsewhere in [String::new(), SUBMIT.to_owned(), format!("{SUBMIT}{other}")] {
            assert_eq!(kept(elsewhere, header), Err(Error::Place));
        }
        let status = b"NATS/1.0 404\r\nTrik-File: a.js\r\nTrik-Task: line\r\n\r\n";
        assert_eq!(
            kept(format!("{SUBMIT}{id}"), status),
            Err(Error::Unreadable)
        );
        assert_eq!(
            kept(format!("{SUBMIT}{id}"), b""),
            Err(Error::NoHeader(TASK))
        );
    }

    #[test]
    fn nothing_that_is_no_submission_has_the_id_of_one() {
        let one = Submission::new("line", "a.js", b"x".to_vec()).unwrap();
        let same = b"line\0a.js\0x";
        assert_ne!(one.id(), id_of_rubbish("", same));
        assert_ne!(one.id(), id_of_rubbish("line\0a.js", b"x"));
        assert_ne!(id_of_rubbish("a", b"x"), id_of_rubbish("b", b"x"));
    }
}
