//! Which copy of each shared library is in force, so that a daemon which takes the place of a dead one loads the same code
//! even if the files have been replaced or damaged meanwhile.
//!
//! Owns the list and its form as bytes of the ledger. Knows nothing of what a library contains.

use super::{Cache, LibraryError, copy};
use crate::events::lock;
use crate::limits;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Names of copies in the cache, by the path of their library.
pub type CopyNames = BTreeMap<PathBuf, String>;

/// The copies of one configuration while it is brought into force.
#[derive(Debug, Default)]
pub struct Copies {
    /// What must be loaded whatever the files contain now.
    promised: CopyNames,
    made: Mutex<CopyNames>,
    remarks: Mutex<Vec<String>>,
}

impl Copies {
    /// Loads these for their paths, as far as they are still there.
    pub fn promised(promised: CopyNames) -> Self {
        Self {
            promised,
            ..Self::default()
        }
    }

    /// Whether the copy of this library was in force before.
    pub fn is_promised(&self, path: &Path) -> bool {
        self.promised.contains_key(path)
    }

    /// The file to load for the library at `path`: the promised copy, else a copy of what is there now.
    ///
    /// # Errors
    /// The library cannot be read or is none.
    pub fn of(&self, path: &Path, cache: &Cache) -> Result<PathBuf, LibraryError> {
        let promised = self.promised.get(path);
        let kept = promised
            .map(|name| cache.path(name))
            .filter(|file| is_whole(file))
            // Before another copy comes, which may take the place of the oldest ones.
            .inspect(|file| cache.touch(file));
        let file = match (kept, copy(path, cache)) {
            (None, now) => now?,
            (Some(kept), now) => {
                if now.as_ref().ok() != Some(&kept) {
                    lock(&self.remarks).push(format!(
                        "{} is not what it was: the copy that was in force is used until the next configuration",
                        path.display()
                    ));
                }
                kept
            }
        };
        if let Some(name) = file.file_name().and_then(OsStr::to_str) {
            lock(&self.made).insert(path.to_owned(), name.to_owned());
        }
        Ok(file)
    }

    /// What was loaded, and lines for the log.
    pub fn finish(self) -> (CopyNames, Vec<String>) {
        let take = |lines: Mutex<Vec<String>>| lines.into_inner().unwrap_or_default();
        let mut remarks = take(self.remarks);
        remarks.dedup();
        (self.made.into_inner().unwrap_or_default(), remarks)
    }
}

/// True for a copy whose contents are those that its name says: a disk may have lost some.
fn is_whole(file: &Path) -> bool {
    let mut bytes = Vec::new();
    let read = File::open(file).and_then(|opened| {
        opened
            .take(limits::LIBRARY_BYTES_MAX)
            .read_to_end(&mut bytes)
    });
    read.is_ok() && file.file_name() == Some(OsStr::new(&super::copy_name(&bytes)))
}

/// As bytes: name and path in turn, each followed by a zero.
pub fn encode(copies: &CopyNames) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (path, name) in copies {
        for part in [name.as_bytes(), path.as_os_str().as_bytes()] {
            bytes.extend_from_slice(part);
            bytes.push(0);
        }
    }
    bytes
}

/// Reads what [`encode`] made; a name that is not one of a copy is left out.
pub fn decode(bytes: &[u8]) -> CopyNames {
    let mut parts = bytes.split(|byte| *byte == 0);
    let mut copies = CopyNames::new();
    while let (Some(name), Some(path)) = (parts.next(), parts.next()) {
        if let Ok(name) = std::str::from_utf8(name)
            && super::cache::is_ours(name)
        {
            copies.insert(PathBuf::from(OsStr::from_bytes(path)), name.to_owned());
        }
    }
    copies
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hash::Hash;
    use crate::scratch::Scratch;
    use std::fs;

    /// Something that `copy` takes for a library is not needed where the copy itself is given.
    fn kept(cache: &Cache, contents: &[u8]) -> String {
        let name = super::super::copy_name(contents);
        cache.put(&name, contents).expect("put");
        name
    }

    #[test]
    fn a_promised_copy_is_loaded_whatever_has_become_of_the_file() {
        let scratch = Scratch::new();
        let cache = scratch.cache();
        let name = kept(&cache, b"as it was");
        let path = scratch.path("n.so");
        for now in [None, Some("rubbish"), Some("")] {
            if let Some(now) = now {
                fs::write(&path, now).expect("written");
            }
            let copies = Copies::promised([(path.clone(), name.clone())].into());
            assert!(copies.is_promised(&path));
            assert_eq!(copies.of(&path, &cache).expect("kept"), cache.path(&name));
            assert_eq!(copies.of(&path, &cache).expect("kept"), cache.path(&name));
            let (made, remarks) = copies.finish();
            assert_eq!(made, [(path.clone(), name.clone())].into());
            assert_eq!(remarks.len(), 1, "{remarks:?}");
        }
    }

    #[test]
    fn a_copy_that_was_damaged_or_is_gone_is_not_loaded() {
        let scratch = Scratch::new();
        let cache = scratch.cache();
        let name = kept(&cache, b"as it was");
        let path = scratch.path("n.so");
        fs::write(cache.path(&name), "damaged").expect("written");
        for _ in 0..2 {
            let copies = Copies::promised([(path.clone(), name.clone())].into());
            copies.of(&path, &cache).expect_err("no file, no copy");
            let _ = fs::remove_file(cache.path(&name));
        }
    }

    #[test]
    fn the_list_survives_as_bytes_and_rubbish_in_it_does_not() {
        let name = format!("lib-{}.so", Hash::of(b"x").hex());
        let copies: CopyNames = [
            (PathBuf::from("/a b/c.so"), name.clone()),
            (PathBuf::from(OsStr::from_bytes(b"/\xff\n.so")), name),
        ]
        .into();
        assert_eq!(decode(&encode(&copies)), copies);
        let mut bytes = b"../../etc/passwd\0/a.so\0".to_vec();
        bytes.extend(encode(&copies));
        bytes.extend(b"lib-");
        assert_eq!(decode(&bytes), copies);
        assert_eq!(decode(b""), CopyNames::new());
    }
}
