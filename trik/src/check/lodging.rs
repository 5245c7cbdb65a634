//! The folder of a worker, in which submissions are while they are judged.
//!
//! Owns that such folders do not stay: a worker that is killed leaves its own behind, and the next one takes it away. One that is in
//! use is claimed by a lock, which the system gives back however its worker ends.

use std::fs::{self, DirEntry, File, OpenOptions, Permissions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::Path;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

const PREFIX: &str = "trik-grade-";
/// A folder that is younger may belong to a worker that is just about to claim it.
const YOUNG: Duration = Duration::from_secs(60);

/// A folder that everybody may read, and the claim to it. Takes those away that nobody claims.
///
/// # Errors
/// There is no place for it.
pub(super) fn new() -> io::Result<(TempDir, File)> {
    let folder = tempfile::Builder::new().prefix(PREFIX).tempdir()?;
    readable(folder.path())?;
    let claim = File::open(folder.path())?;
    claim.try_lock()?;
    if let Some(parent) = folder.path().parent() {
        clear(parent, SystemTime::now());
    }
    Ok((folder, claim))
}

/// A program of a submission may be another user.
pub(super) fn readable(folder: &Path) -> io::Result<()> {
    fs::set_permissions(folder, Permissions::from_mode(0o755))
}

/// Takes folders away that nobody claims. What cannot be removed is met by the next one.
fn clear(parent: &Path, now: SystemTime) {
    let all = fs::read_dir(parent).into_iter().flatten().flatten();
    for folder in all.filter(|entry| is_left(entry, now)) {
        let mut options = OpenOptions::new();
        let no_link = (rustix::fs::OFlags::NOFOLLOW | rustix::fs::OFlags::DIRECTORY).bits();
        let opened = (options.read(true).custom_flags(no_link.cast_signed())).open(folder.path());
        if opened.is_ok_and(|opened| opened.try_lock().is_ok()) {
            let _ = fs::remove_dir_all(folder.path());
        }
    }
}

/// It is such a folder of this user, and no young one.
fn is_left(entry: &DirEntry, now: SystemTime) -> bool {
    let is_named = entry.file_name().to_string_lossy().starts_with(PREFIX);
    is_named
        && entry.metadata().is_ok_and(|about| {
            let age = about.modified().map(|then| now.duration_since(then));
            let is_old = matches!(age, Ok(Ok(age)) if age >= YOUNG);
            about.is_dir() && is_old && about.uid() == nix::unistd::geteuid().as_raw()
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_claims_is_taken_away_when_it_is_old() {
        let parent = tempfile::tempdir().unwrap();
        let folder = |name: &str| {
            let path = parent.path().join(name);
            fs::create_dir(&path).unwrap();
            fs::write(path.join("a.js"), "x").unwrap();
            path
        };
        let left = folder("trik-grade-left");
        let used = folder("trik-grade-used");
        let other = folder("trik-other");
        let link = parent.path().join("trik-grade-link");
        std::os::unix::fs::symlink(&other, &link).unwrap();
        let claim = File::open(&used).unwrap();
        claim.try_lock().unwrap();
        let now = SystemTime::now();
        clear(parent.path(), now);
        assert!(left.exists(), "a young one");
        clear(parent.path(), now + YOUNG * 2);
        let there = [&left, &used, &other, &link].map(|path| path.join("a.js").exists());
        assert_eq!(there, [false, true, true, true]);
        drop(claim);
        clear(parent.path(), now + YOUNG * 2);
        assert!(!used.exists());
    }
}
