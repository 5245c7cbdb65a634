//! The two containers of a save, as named pieces of bytes.
//!
//! Owns names, sizes and checksums of the pieces. Knows nothing of what is in them, and writes nothing to a disk.
//! A zip begins with `PK`; a legacy stream begins with the length of a name, which is a small number.

use crate::limits;
use lang_text::problem::{Problem, Severity, Words, keep};
use std::collections::{HashMap, HashSet};

mod deflate;
mod stream;
mod words;
mod zip;

/// One piece of a save.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Entry {
    /// Where it belongs, with `/` between folders and none at the beginning; a folder ends with `/`.
    pub name: String,
    /// What is in it, unpacked.
    pub bytes: Vec<u8>,
}

impl Entry {
    /// Whether it is a folder, which has no bytes.
    pub fn is_folder(&self) -> bool {
        self.name.ends_with('/')
    }
}

/// How the pieces were kept together.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Container {
    /// A zip, as all saves since about 2019.
    Zip,
    /// Records one after another, as before.
    Stream,
}

/// All pieces of a save.
#[derive(Clone, Debug)]
pub struct Archive {
    /// How they were kept.
    pub container: Container,
    /// The pieces, in the order of the container, each name once.
    pub entries: Vec<Entry>,
}

/// Takes a save to pieces.
///
/// # Errors
/// Bytes that are neither container, a damaged or hostile one, and anything above the limits of [`limits`].
pub fn open(bytes: &[u8], problems: &mut Vec<Problem>) -> Result<Archive, Problem> {
    if bytes.is_empty() {
        return Err(Problem::error(words::empty()));
    }
    if bytes.len() > limits::SAVE_BYTES {
        return Err(Problem::error(words::too_large(bytes.len())));
    }
    let mut pieces = Pieces {
        problems,
        entries: Vec::new(),
        places: HashMap::new(),
        claimed: 0,
        records: 0,
    };
    let container = if bytes.starts_with(b"PK") {
        zip::unpack(bytes, &mut pieces)?;
        Container::Zip
    } else if stream::is_likely(bytes) {
        stream::unpack(bytes, &mut pieces)?;
        Container::Stream
    } else {
        return Err(Problem::error(words::no_save()));
    };
    let entries = pieces.entries;
    Ok(Archive { container, entries })
}

/// Puts pieces into a zip, with an entry for each folder before what is in it.
///
/// # Errors
/// More entries or bytes than a save may have, and a name that is there twice or too long for a zip.
pub fn pack(entries: &[Entry]) -> Result<Vec<u8>, Problem> {
    fill(zip::Packer::new(), entries)
}

/// The same with nothing compressed, to be compressed as a whole: what small files repeat takes little room then.
///
/// # Errors
/// As [`pack`].
pub fn pack_stored(entries: &[Entry]) -> Result<Vec<u8>, Problem> {
    fill(zip::Packer::storing(), entries)
}

/// The same as an OpenDocument file has it: its type comes first, not packed, as the piece `mimetype`.
///
/// # Errors
/// As [`pack`].
pub fn pack_document(kind: &str, entries: &[Entry]) -> Result<Vec<u8>, Problem> {
    let mut packer = zip::Packer::new();
    packer.add_stored("mimetype", kind.as_bytes())?;
    fill(packer, entries)
}

fn fill(mut packer: zip::Packer, entries: &[Entry]) -> Result<Vec<u8>, Problem> {
    let mut folders = HashSet::new();
    for entry in entries {
        let mut end = 0;
        while let Some(at) = entry.name[end..].find('/') {
            end += at + 1;
            let folder = &entry.name[..end];
            if folders.insert(folder) {
                packer.add(folder, &[])?;
            }
        }
        if !entry.is_folder() {
            packer.add(&entry.name, &entry.bytes)?;
        }
    }
    packer.finish()
}

/// What was found so far, and what it may still become.
struct Pieces<'a> {
    problems: &'a mut Vec<Problem>,
    entries: Vec<Entry>,
    places: HashMap<String, usize>,
    claimed: usize,
    records: usize,
}

impl Pieces<'_> {
    /// Counts one more record of the container.
    fn count(&mut self) -> Result<(), Problem> {
        self.records += 1;
        if self.records > limits::ENTRIES {
            return Err(Problem::error(words::too_many()));
        }
        Ok(())
    }

    /// Refuses a piece of so many packed bytes that says it has `claimed` if there would be too many: nothing is
    /// unpacked before all have been asked.
    fn admit(&mut self, name: &str, packed: usize, claimed: usize) -> Result<(), Problem> {
        let rest = limits::SAVE_UNPACKED_BYTES - self.claimed;
        if claimed > limits::ENTRY_BYTES.min(rest) {
            return Err(in_file(name, words::bomb()));
        }
        if claimed > packed.saturating_mul(limits::UNPACKED_BYTES_OF_ONE) {
            return Err(in_file(name, words::damaged()));
        }
        self.claimed += claimed;
        Ok(())
    }

    /// Takes a piece; of two with one name the later one counts, as when both are unpacked over each other.
    fn add(&mut self, name: &str, bytes: Vec<u8>) {
        let Some(name) = self.safe(name) else {
            return;
        };
        if name.ends_with('/') && bytes.is_empty() && self.places.contains_key(&name) {
            return;
        }
        if let Some(&at) = self.places.get(&name) {
            self.report(&name, words::twice());
            self.entries[at].bytes = bytes;
            return;
        }
        self.places.insert(name.clone(), self.entries.len());
        self.entries.push(Entry { name, bytes });
    }

    /// A name with `/` between its parts; `None`, and a problem, for one that leads out of the save.
    fn safe(&mut self, name: &str) -> Option<String> {
        if is_plain(name) {
            return Some(name.to_owned());
        }
        let plain = name.replace('\\', "/");
        let parts: Vec<&str> = plain
            .split('/')
            .filter(|part| !part.is_empty() && *part != ".")
            .collect();
        let mut whole = parts.join("/");
        if plain.ends_with('/') {
            whole.push('/');
        }
        if !is_plain(&whole) {
            self.report(name, words::leads_out());
            return None;
        }
        Some(whole)
    }

    fn report(&mut self, name: &str, words: Words) {
        let mut problem = in_file(name, words);
        problem.severity = Severity::Warning;
        keep(self.problems, problem);
    }
}

/// Whether a name stays inside of the save and is written as it should be.
fn is_plain(name: &str) -> bool {
    let bytes = name.as_bytes();
    // The length of a part that has nothing but dots so far; a name begins like a part.
    let mut dots = Some(0);
    for &byte in bytes {
        match byte {
            b'/' if matches!(dots, Some(0..=2)) => return false,
            b'/' => dots = Some(0),
            b'.' => dots = dots.map(|count| count + 1),
            b'\\' | 0..b' ' => return false,
            _ => dots = None,
        }
    }
    let is_folder = bytes.last() == Some(&b'/');
    let ends_well = is_folder || !matches!(dots, Some(0..=2));
    ends_well && bytes.get(1) != Some(&b':')
}

/// An error in one piece.
fn in_file(name: &str, words: Words) -> Problem {
    let mut problem = Problem::error(words);
    problem.place.file = Some(name.chars().filter(|c| !c.is_control()).take(200).collect());
    problem
}

/// A number of the container, or `None` where it ends.
fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

#[cfg(test)]
mod tests;
