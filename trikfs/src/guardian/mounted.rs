//! Our mount among all mounts: is it still there, and how is it cut off.
//!
//! Others may mount over it, below it or at the same place again, so a path alone does not name it; and the kernel
//! gives the numbers of a mount that is gone to the next one. So the file that ends the connection is opened while the
//! mount is surely there: it belongs to that connection for ever and can hit no other.
//! Touches no file of the mount, which may have nobody to answer.

use crate::mount::{self, MountError};
use nix::mount::{MntFlags, umount2};
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Where the kernel shows its FUSE connections, a directory for each.
const CONNECTIONS: &str = "/sys/fs/fuse/connections";

/// One mount of a FUSE filesystem.
#[derive(Debug)]
pub struct Mounted {
    path: PathBuf,
    /// The kernel's number for the mount; may be given to another one later.
    id: u32,
    /// Minor device number, which is also the name of the connection below /sys/fs/fuse.
    connection: u32,
    /// `abort` of the connection; none where that file system is not mounted or not allowed to us.
    abort: Option<File>,
}

impl Mounted {
    /// The uppermost mount at `path`.
    ///
    /// # Errors
    /// There is none, or the list cannot be read.
    pub fn find(path: &Path) -> Result<Self, MountError> {
        let entry = mount::find(path)?.ok_or_else(|| MountError::Unlisted(path.to_owned()))?;
        Ok(Self::named(
            entry.mountpoint,
            entry.id,
            entry.device.1,
            Path::new(CONNECTIONS),
        ))
    }

    /// The mount that [`Mounted::numbers`] named to another process.
    pub fn inherited(path: PathBuf, (id, connection): (u32, u32)) -> Self {
        Self::named(path, id, connection, Path::new(CONNECTIONS))
    }

    fn named(path: PathBuf, id: u32, connection: u32, connections: &Path) -> Self {
        let mut mounted = Self {
            path,
            id,
            connection,
            abort: None,
        };
        let file = connections.join(connection.to_string()).join("abort");
        let abort = OpenOptions::new().write(true).open(file).ok();
        // Looked at after the opening: as long as the mount is there, nobody else has its number.
        mounted.abort = abort.filter(|_| mounted.is_there());
        mounted
    }

    /// Number of the mount and of its connection.
    pub fn numbers(&self) -> (u32, u32) {
        (self.id, self.connection)
    }

    /// Where it is mounted.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// True as long as this mount can be reached by its path.
    pub fn is_there(&self) -> bool {
        // If the list cannot be read, nothing says that the mount is gone.
        mount::table().map_or(true, |list| self.is_in(&list))
    }

    /// The last entry at a path is the uppermost.
    fn is_in(&self, list: &[u8]) -> bool {
        mount::parse_mountinfo(list)
            .filter(|entry| entry.mountpoint == self.path)
            .last()
            .is_some_and(|entry| (entry.id, entry.device.1) == self.numbers())
    }

    /// Ends the connection: every request that waits, and every later one, fails at once.
    pub fn abort(&self) {
        let written = self
            .abort
            .as_ref()
            .is_some_and(|mut file| file.write_all(b"1").is_ok());
        if !written && self.is_there() {
            // Without that file system, root has the same from a forced unmount, which ends the connection even if
            // the mount is busy and stays.
            let _ = umount2(&self.path, MntFlags::MNT_FORCE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    const LIST: &[u8] = b"90 22 0:45 / /tmp/robot rw,nosuid - fuse.trikfs trikfs rw,user_id=0\n\
        91 22 0:46 / /tmp/my\\040robot rw - fuse.trikfs trikfs rw\n\
        92 90 0:47 / /tmp/robot rw,nosuid shared:7 - fuse.trikfs trikfs rw,user_id=0\n";

    #[test]
    fn a_mount_is_there_until_it_is_gone_or_something_lies_over_it() {
        let there = |path: &str, id, connection| {
            Mounted::inherited(path.into(), (id, connection)).is_in(LIST)
        };
        assert!(there("/tmp/robot", 92, 47));
        assert!(!there("/tmp/robot", 90, 45), "covered");
        assert!(there("/tmp/my robot", 91, 46));
        assert!(!there("/tmp/my robot", 91, 47), "a number used again");
        assert!(!there("/tmp", 91, 46));
    }

    /// The number of a mount that is gone belonged to somebody else's mount by then, and that one was cut off.
    #[test]
    fn the_connection_of_another_mount_is_never_aborted() {
        let scratch = Scratch::new();
        let proc = Mounted::find(Path::new("/proc")).expect("mounted");
        let (id, connection) = proc.numbers();
        let file = scratch.path(&format!("{connection}/abort"));
        std::fs::create_dir(file.parent().expect("a folder")).expect("made");
        let at = |id| Mounted::named("/proc".into(), id, connection, &scratch.path(""));
        std::fs::write(&file, "").expect("written");
        // Its number is used again by another mount at the same place.
        at(id + 1_000_000).abort();
        assert_eq!(std::fs::read(&file).expect("read"), b"");
        let ours = at(id);
        assert!(ours.abort.is_some());
        // From here on the name stands for another connection.
        std::fs::rename(&file, scratch.path("before")).expect("renamed");
        std::fs::write(&file, "").expect("written");
        ours.abort();
        assert_eq!(std::fs::read(&file).expect("read"), b"");
        assert_eq!(std::fs::read(scratch.path("before")).expect("read"), b"1");
    }

    #[test]
    fn mounts_of_this_machine_are_found() {
        assert!(
            Mounted::find(Path::new("/proc"))
                .expect("mounted")
                .is_there()
        );
        Mounted::find(Path::new("/nonexistent")).expect_err("not mounted");
    }
}
