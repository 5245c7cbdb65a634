//! Makes the files of the computer read-only in the mounts of a judged program, which holds also where there is no Landlock.
//!
//! Owns which mounts stay as they are. It goes through them one by one: `mount_setattr`, which does all in one call since
//! Linux 5.12, can only be called by unsafe code, and what a program is kept from is the same on all kernels this way.

use nix::errno::Errno;
use nix::mount::{MsFlags, mount};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use trikfs::mount::{parse_mountinfo, table};

/// Where the list of mounts is.
const TABLE: &str = "/proc/self/mountinfo";
/// A mount that waits until somebody needs it. It has no files, and a look at it would have the computer mount something.
const WAITING: &str = "autofs";
/// Options of a mount that have to be said again: a namespace of users may not take them away from mounts of others.
const OPTIONS: [(&str, MsFlags); 4] = [
    ("nosuid", MsFlags::MS_NOSUID),
    ("nodev", MsFlags::MS_NODEV),
    ("noexec", MsFlags::MS_NOEXEC),
    // linux/mount.h, since 5.10.
    ("nosymfollow", MsFlags::from_bits_retain(256)),
];

/// Every mount but those at and below `kept`. Only a process that is not root of the computer passes by what it cannot
/// reach: then the program cannot reach it either.
///
/// # Errors
/// The first place that stays writable.
pub(super) fn shut(kept: &Path, is_root: bool) -> Result<(), PathBuf> {
    let table = table().map_err(|_| PathBuf::from(TABLE))?;
    let places = uppermost(&table).ok_or_else(|| PathBuf::from(TABLE))?;
    let places = places.into_iter();
    for (place, flags) in places.filter(|(place, _)| !place.starts_with(kept)) {
        if !is_shut(&place, flags, is_root) {
            return Err(place);
        }
    }
    Ok(())
}

/// The flags of each mount that can be written to and that nothing stands over at the same place. None if a line is not
/// understood.
fn uppermost(table: &[u8]) -> Option<BTreeMap<PathBuf, MsFlags>> {
    let entries: Vec<_> = parse_mountinfo(table).collect();
    let lines = table.split_inclusive(|byte| *byte == b'\n');
    // A list that was cut ends anywhere.
    if entries.len() != lines.count() || !table.ends_with(b"\n") {
        return None;
    }
    let mut places = BTreeMap::new();
    // Later lines lie over earlier ones.
    for entry in entries {
        let has = |name: &str| entry.options.split(',').any(|option| option == name);
        let is_done = has("ro") || entry.kind == WAITING;
        let flags = OPTIONS.into_iter().filter(|(name, _)| has(name));
        let flags = flags.fold(MsFlags::empty(), |all, (_, flag)| all | flag);
        places.insert(entry.mountpoint, (!is_done).then_some(flags));
    }
    let open = places.into_iter();
    Some(
        open.filter_map(|(place, flags)| Some((place, flags?)))
            .collect(),
    )
}

fn is_shut(place: &Path, flags: MsFlags, is_root: bool) -> bool {
    let none: Option<&str> = None;
    let shut = MsFlags::MS_REMOUNT | MsFlags::MS_BIND | MsFlags::MS_RDONLY;
    match mount(none, place, none, shut | flags, none) {
        // Something lies over a folder above it.
        Ok(()) | Err(Errno::ENOENT | Errno::ENOTDIR | Errno::EINVAL) => true,
        Err(why) => why == Errno::EACCES && !is_root,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_counts_once_as_its_uppermost_mount_is() {
        let table = b"27 1 254:0 / / rw,relatime - ext4 /dev/vda rw\n\
            28 27 0:25 / /a rw,nosuid,nodev,relatime - tmpfs a rw\n\
            29 27 0:26 / /b rw - tmpfs b rw\n\
            30 29 0:27 / /b ro,noexec - tmpfs b rw\n\
            31 27 0:28 / /c\\040d rw,noexec,nosymfollow - tmpfs c rw\n\
            32 27 0:29 / /e rw - autofs systemd-1 rw\n";
        let places = uppermost(table).unwrap();
        let flags = |place: &str| places.get(Path::new(place)).copied();
        assert_eq!(places.len(), 3);
        assert_eq!(flags("/"), Some(MsFlags::empty()));
        assert_eq!(flags("/a"), Some(MsFlags::MS_NOSUID | MsFlags::MS_NODEV));
        let last = MsFlags::from_bits_retain(256) | MsFlags::MS_NOEXEC;
        assert_eq!(flags("/c d"), Some(last));
    }

    #[test]
    fn a_list_that_is_not_understood_or_cut_shuts_nothing() {
        assert_eq!(uppermost(b"27 1 254:0 / / rw - ext4 /dev/vda rw"), None);
        assert_eq!(
            uppermost(b"27 1 254:0 / / rw - ext4 /dev/vda rw\nx\n"),
            None
        );
        assert_eq!(uppermost(b""), None);
    }
}
