//! Our mount among all mounts: is it still there, and how is it cut off.
//!
//! Others may mount over it, below it or at the same place again, so a path alone does not name it.
//! Touches no file of the mount, which may have nobody to answer.

use crate::mount;
use nix::mount::{MntFlags, umount2};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// One mount of a FUSE filesystem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mounted {
    path: PathBuf,
    /// The kernel's number for the mount; may be given to another one later.
    id: u32,
    /// Minor device number, which is also the name of the connection below /sys/fs/fuse.
    connection: u32,
}

impl Mounted {
    /// The uppermost mount at `path`.
    ///
    /// # Errors
    /// There is none, or the list cannot be read.
    pub fn find(path: &Path) -> Result<Self, String> {
        let entry = mount::find(path).map_err(|error| error.to_string())?;
        let entry =
            entry.ok_or_else(|| format!("{}: not in the list of mounts", path.display()))?;
        Ok(Self {
            path: entry.mountpoint,
            id: entry.id,
            connection: entry.device.1,
        })
    }

    /// The mount that [`Mounted::numbers`] named to another process.
    pub fn named(path: PathBuf, id: u32, connection: u32) -> Self {
        Self {
            path,
            id,
            connection,
        }
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
        // If the list cannot be read, nothing says that the mount is gone. Before Linux 5.8 an entry can be missing
        // from a list that is read while others unmount, so one that is missing is looked for once more.
        let look = || fs::read("/proc/self/mountinfo").map_or(true, |list| self.is_in(&list));
        look() || look()
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
        let file = format!("/sys/fs/fuse/connections/{}/abort", self.connection);
        let written = OpenOptions::new()
            .write(true)
            .open(file)
            .and_then(|mut file| file.write_all(b"1"));
        if written.is_err() && self.is_there() {
            // Without that file system, root has the same from a forced unmount, which ends the connection even if
            // the mount is busy and stays.
            let _ = umount2(&self.path, MntFlags::MNT_FORCE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: &[u8] = b"90 22 0:45 / /tmp/robot rw,nosuid - fuse.trikfs trikfs rw,user_id=0\n\
        91 22 0:46 / /tmp/my\\040robot rw - fuse.trikfs trikfs rw\n\
        92 90 0:47 / /tmp/robot rw,nosuid shared:7 - fuse.trikfs trikfs rw,user_id=0\n";

    #[test]
    fn a_mount_is_there_until_it_is_gone_or_something_lies_over_it() {
        let there =
            |path: &str, id, connection| Mounted::named(path.into(), id, connection).is_in(LIST);
        assert!(there("/tmp/robot", 92, 47));
        assert!(!there("/tmp/robot", 90, 45), "covered");
        assert!(there("/tmp/my robot", 91, 46));
        assert!(!there("/tmp/my robot", 91, 47), "a number used again");
        assert!(!there("/tmp", 91, 46));
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
