//! The private directory that holds machine code: copies of shared libraries, compiled inline C.
//!
//! Owns its names, its permissions and its size. Knows nothing of what the files contain.
//! Code from this directory is executed, so nobody else may be able to write there.

use super::refusal::CacheError;
use crate::limits;
use std::ffi::OsString;
use std::fs::{self, DirBuilder, File, Metadata, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

/// A directory that belongs to this user alone.
#[derive(Clone, Debug)]
pub struct Cache {
    dir: PathBuf,
}

impl Cache {
    /// Opens the directory, creating it (mode 0700) if needed: `dir` if given; otherwise /var/cache/trikfs for
    /// root, `$XDG_CACHE_HOME/trikfs` or `~/.cache/trikfs` for everyone else, and if that cannot be had a
    /// directory of the user's own below the directory for temporary files.
    ///
    /// Fails if it belongs to somebody else or others can write to it.
    pub fn open(dir: Option<&Path>) -> Result<Self, CacheError> {
        let user = nix::unistd::geteuid().as_raw();
        if let Some(dir) = dir {
            return Self::open_at(dir, user);
        }
        let fallback = std::env::temp_dir().join(format!("trikfs-{user}"));
        let Some(usual) = usual_dir(
            user,
            std::env::var_os("XDG_CACHE_HOME"),
            std::env::var_os("HOME"),
        ) else {
            return Self::open_at(&fallback, user);
        };
        Self::open_at(&usual, user).or_else(|first| {
            Self::open_at(&fallback, user)
                .map_err(|second| CacheError::Both(Box::new([first, second])))
        })
    }

    fn open_at(dir: &Path, user: u32) -> Result<Self, CacheError> {
        let shown = dir;
        let fail = |error: io::Error| CacheError::system(shown, &error);
        let dir = std::path::absolute(dir).map_err(fail)?;
        DirBuilder::new()
            .recursive(true)
            .mode(0o700)
            .create(&dir)
            .map_err(fail)?;
        // Not through a symbolic link: in a directory for temporary files anybody could have put it there.
        let found = fs::symlink_metadata(&dir).map_err(fail)?;
        refuse_unless_private(&dir, &found, user)?;
        Ok(Self { dir })
    }

    /// Where it is.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The path of an entry, whether it exists or not.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// True if `path` is an entry of this directory.
    pub fn holds(&self, path: &Path) -> bool {
        path.parent() == Some(&self.dir)
    }

    /// Makes an entry with these contents, all at once; nothing happens if it has them already.
    pub fn put(&self, name: &str, contents: &[u8]) -> Result<PathBuf, CacheError> {
        let path = self.path(name);
        if same_contents(&path, contents) {
            self.touch(&path);
            return Ok(path);
        }
        let temporary = self.temporary("");
        let written = (|| {
            let mut file = OpenOptions::new()
                .write(true)
                .create_new(true)
                .mode(0o700)
                .open(&temporary)?;
            file.write_all(contents)?;
            file.sync_all()
        })();
        if let Err(error) = written {
            let _ = fs::remove_file(&temporary);
            return Err(CacheError::system(&self.dir, &error));
        }
        self.adopt(&temporary, name)
    }

    /// Renames a finished temporary file to its final name.
    pub fn adopt(&self, temporary: &Path, name: &str) -> Result<PathBuf, CacheError> {
        let path = self.path(name);
        // A name must never point at a file whose bytes a power cut can still lose.
        let moved = File::open(temporary)
            .and_then(|file| file.sync_all())
            .and_then(|()| fs::rename(temporary, &path));
        if let Err(error) = moved {
            let _ = fs::remove_file(temporary);
            return Err(CacheError::system(&self.dir, &error));
        }
        self.prune(&path);
        Ok(path)
    }

    /// A fresh name for a file in the making; `suffix` with its dot.
    pub fn temporary(&self, suffix: &str) -> PathBuf {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        self.dir
            .join(format!("tmp-{}-{number}{suffix}", std::process::id()))
    }

    /// Marks an entry as used just now, so that it is the last to be pruned.
    pub fn touch(&self, path: &Path) {
        // Failure costs nothing but the order in which entries are thrown away.
        let _ = File::open(path).and_then(|file| file.set_modified(SystemTime::now()));
    }

    /// Removes the libraries used longest ago until the limits hold, and temporary files of dead processes.
    /// A library that is in use stays loaded without its name.
    fn prune(&self, keep: &Path) {
        let Ok(entries) = fs::read_dir(&self.dir) else {
            return;
        };
        let mut libraries: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
        for entry in entries.flatten() {
            let Ok(found) = entry.metadata() else {
                continue;
            };
            let modified = found.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            match entry.file_name().to_str() {
                Some(name)
                    if name.starts_with("tmp-")
                        && modified
                            .elapsed()
                            .is_ok_and(|age| age > limits::CACHE_TEMPORARY_AGE) =>
                {
                    let _ = fs::remove_file(entry.path());
                }
                Some(name) if is_ours(name) && entry.path() != keep => {
                    libraries.push((modified, found.len(), entry.path()));
                }
                _ => {}
            }
        }
        libraries.sort_by_key(|entry| std::cmp::Reverse(entry.0));
        let mut bytes = fs::metadata(keep).map_or(0, |found| found.len());
        for (index, (_, size, path)) in libraries.iter().enumerate() {
            bytes = bytes.saturating_add(*size);
            if index + 1 >= limits::CACHE_FILES_MAX || bytes > limits::CACHE_BYTES_MAX {
                let _ = fs::remove_file(path);
            }
        }
    }
}

/// The directory that a user's caches go to, before the fallback.
fn usual_dir(user: u32, xdg: Option<OsString>, home: Option<OsString>) -> Option<PathBuf> {
    if user == 0 {
        return Some(PathBuf::from("/var/cache/trikfs"));
    }
    // The base directory specification says to ignore relative paths.
    let absolute = |path: OsString| Some(PathBuf::from(path)).filter(|path| path.is_absolute());
    xdg.and_then(absolute)
        .or_else(|| home.and_then(absolute).map(|home| home.join(".cache")))
        .map(|caches| caches.join("trikfs"))
}

fn refuse_unless_private(dir: &Path, found: &Metadata, user: u32) -> Result<(), CacheError> {
    if !found.is_dir() {
        return Err(CacheError::NotADirectory(dir.to_owned()));
    }
    if found.uid() != user {
        return Err(CacheError::Foreign {
            dir: dir.to_owned(),
            owner: found.uid(),
            user,
        });
    }
    if found.mode() & 0o022 != 0 {
        return Err(CacheError::Writable(dir.to_owned(), found.mode() & 0o7777));
    }
    Ok(())
}

/// True for the names that this program gives to libraries: only those are ever removed.
pub(super) fn is_ours(name: &str) -> bool {
    let digits = name
        .strip_prefix("lib-")
        .or_else(|| name.strip_prefix("c-"))
        .and_then(|rest| rest.strip_suffix(".so"));
    digits.is_some_and(|digits| {
        digits.len() == 32 && digits.bytes().all(|byte| byte.is_ascii_hexdigit())
    })
}

fn same_contents(path: &Path, contents: &[u8]) -> bool {
    let Ok(file) = File::open(path) else {
        return false;
    };
    let size = contents.len() as u64;
    if file
        .metadata()
        .map_or(true, |found| !found.is_file() || found.len() != size)
    {
        return false;
    }
    let mut found = Vec::new();
    file.take(size + 1).read_to_end(&mut found).is_ok() && found == contents
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::time::Duration;

    #[test]
    fn a_new_directory_is_private() {
        let scratch = Scratch::new();
        let cache = Cache::open(Some(&scratch.path("a/b"))).expect("opens");
        assert_eq!(
            fs::metadata(cache.dir()).expect("exists").mode() & 0o777,
            0o700
        );
        assert!(cache.holds(&cache.path("x")));
        assert!(!cache.holds(Path::new("/etc/x")));
    }

    #[test]
    fn a_directory_that_others_can_write_to_is_refused() {
        let scratch = Scratch::new();
        let dir = scratch.path("open");
        fs::create_dir(&dir).expect("created");
        fs::set_permissions(&dir, fs::Permissions::from_mode(0o770)).expect("chmod");
        let refusal = Cache::open(Some(&dir)).expect_err("refused").to_string();
        assert!(
            refusal
                .ends_with("others can write to it (mode 0770); make it private with chmod go-w"),
            "{refusal}"
        );
    }

    #[test]
    fn a_directory_of_somebody_else_is_refused() {
        let scratch = Scratch::new();
        let stranger = nix::unistd::geteuid().as_raw() + 1;
        let refusal = Cache::open_at(&scratch.path("x"), stranger).expect_err("refused");
        let refusal = refusal.to_string();
        assert!(refusal.contains("belongs to user"), "{refusal}");
    }

    #[test]
    fn a_symbolic_link_or_a_file_in_its_place_is_refused() {
        let scratch = Scratch::new();
        fs::create_dir(scratch.path("real")).expect("created");
        symlink(scratch.path("real"), scratch.path("link")).expect("linked");
        assert!(
            Cache::open(Some(&scratch.path("link")))
                .expect_err("refused")
                .to_string()
                .ends_with("not a directory")
        );
        fs::write(scratch.path("file"), "").expect("written");
        Cache::open(Some(&scratch.path("file"))).expect_err("refused");
    }

    #[test]
    fn the_usual_directory_follows_the_base_directory_specification() {
        let dir = |user, xdg: Option<&str>, home: Option<&str>| {
            usual_dir(user, xdg.map(Into::into), home.map(Into::into))
        };
        assert_eq!(
            dir(0, Some("/x"), Some("/h")),
            Some("/var/cache/trikfs".into())
        );
        assert_eq!(dir(7, Some("/x"), Some("/h")), Some("/x/trikfs".into()));
        assert_eq!(
            dir(7, Some("relative"), Some("/h")),
            Some("/h/.cache/trikfs".into())
        );
        assert_eq!(dir(7, None, None), None);
    }

    #[test]
    fn a_damaged_entry_is_replaced() {
        let scratch = Scratch::new();
        let cache = scratch.cache();
        let path = cache.put("lib-x", b"right").expect("put");
        fs::write(&path, b"wrong").expect("damaged");
        cache.put("lib-x", b"right").expect("put again");
        assert_eq!(fs::read(&path).expect("read"), b"right");
    }

    #[test]
    fn the_oldest_libraries_go_first_and_strangers_files_stay() {
        let scratch = Scratch::new();
        let cache = scratch.cache();
        let name = |number: usize| format!("lib-{number:032x}.so");
        for number in 0..limits::CACHE_FILES_MAX {
            let file = File::create(cache.path(&name(number))).expect("created");
            let age = Duration::from_secs(10 * (limits::CACHE_FILES_MAX - number) as u64);
            file.set_modified(SystemTime::now() - age).expect("aged");
        }
        fs::write(cache.path("notes.so"), "").expect("written");
        cache.put(&name(9999), b"new").expect("put");
        assert!(!cache.path(&name(0)).exists(), "the oldest is gone");
        assert!(cache.path(&name(1)).exists(), "the second oldest is there");
        assert!(cache.path(&name(9999)).exists());
        assert!(cache.path("notes.so").exists());
    }
}
