//! Mounting and unmounting, and what the system says of a mountpoint.
//!
//! Root mounts by itself; everybody else through the setuid helper `fusermount3`. Either way the result is the open
//! /dev/fuse of a mounted filesystem that nobody serves yet. Owns the options that every mount of ours has and the
//! messages for people. Knows no request of the protocol.
//!
//! A directory that is not empty may be mounted over, as fusermount3 allows; what it holds is hidden until the unmount.

use crate::limits::{HELPER_COMPLAINT_BYTES_MAX, MOUNT_TABLE_BYTES_MAX, MOUNT_TABLE_READS_MAX};
use crate::transport::native::received::receive_descriptor;
use nix::errno::Errno;
use nix::mount::{MntFlags, MsFlags, umount2};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::statfs::statfs;
use nix::unistd::{getegid, geteuid};
use std::ffi::{OsStr, OsString};
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::os::fd::{AsFd, AsRawFd, OwnedFd};
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The kernel's device for filesystems in user space.
const DEVICE: &str = "/dev/fuse";
/// The setuid helper for users who may not mount.
const HELPER: &str = "fusermount3";
/// Type of our mounts as /proc/mounts shows it: the kernel's `fuse` followed by our name.
const TYPE: &str = "fuse.trikfs";
/// The name alone, as the helper wants it.
const SUBTYPE: &str = "trikfs";
/// The list of mounts.
const TABLE: &str = "/proc/self/mountinfo";

/// How to mount. Permissions are always checked by the kernel; set-user-ID and device nodes never work there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MountOptions {
    /// Let other users in; for others than root /etc/fuse.conf must allow it.
    pub allow_other: bool,
    /// First column of `df` and of /proc/mounts.
    pub source: String,
    /// Refuse writes.
    pub read_only: bool,
}

impl Default for MountOptions {
    fn default() -> Self {
        Self {
            allow_other: false,
            source: "trikfs".into(),
            read_only: false,
        }
    }
}

/// Why a mount or unmount failed, in a sentence that says what to do.
#[derive(Debug)]
pub enum MountError {
    /// There is no /dev/fuse.
    NoDevice,
    /// Not root, and no helper.
    NoPermission,
    /// The mountpoint does not exist.
    NoMountpoint(PathBuf),
    /// The mountpoint is not a directory.
    NotADirectory(PathBuf),
    /// A trikfs is mounted there and alive.
    AlreadyMounted(PathBuf),
    /// A dead filesystem of another kind is in the way.
    Dead(PathBuf, String),
    /// No trikfs is mounted there.
    NotMounted(PathBuf),
    /// It was mounted just now, and the list of mounts does not have it.
    Unlisted(PathBuf),
    /// The helper refused, in its own words.
    Helper(String),
    /// A path or option with a character that a mount option cannot carry.
    BadOption(String),
    /// Anything else the system said.
    System(PathBuf, io::Error),
}

impl fmt::Display for MountError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDevice => write!(
                f,
                "{DEVICE}: no such device: load the kernel module fuse (modprobe fuse)"
            ),
            Self::NoPermission => {
                f.write_str("no permission to mount: install package fuse3 or run as root")
            }
            Self::NoMountpoint(path) => {
                write!(f, "{}: no such directory: create it first", path.display())
            }
            Self::NotADirectory(path) => write!(f, "{}: not a directory", path.display()),
            Self::AlreadyMounted(path) => {
                write!(f, "{}: a trikfs is mounted there already", path.display())
            }
            Self::Dead(path, kind) => {
                write!(
                    f,
                    "{}: a dead filesystem of type {kind} is mounted there: unmount it first",
                    path.display()
                )
            }
            Self::NotMounted(path) => write!(f, "{}: no trikfs is mounted there", path.display()),
            Self::Unlisted(path) => write!(f, "{}: not in the list of mounts", path.display()),
            Self::Helper(complaint) => f.write_str(complaint),
            Self::BadOption(text) => write!(f, "{text:?}: cannot be part of a mount option"),
            Self::System(path, error) => write!(f, "{}: {error}", path.display()),
        }
    }
}

impl std::error::Error for MountError {}

/// How an unmount went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unmounted {
    /// Nobody used it; it is gone.
    Clean,
    /// Somebody still has files open: the name is gone, the filesystem goes with the last of them.
    Detached,
}

/// Mounts at a directory; a trikfs there that has lost its process is replaced.
///
/// # Errors
/// See [`MountError`].
pub fn mount(path: &Path, options: &MountOptions) -> Result<OwnedFd, MountError> {
    check_option(OsStr::new(&options.source))?;
    clear_mountpoint(path)?;
    let device = match OpenOptions::new().read(true).write(true).open(DEVICE) {
        Ok(device) => device,
        Err(error) => match error.kind() {
            io::ErrorKind::NotFound => return Err(MountError::NoDevice),
            io::ErrorKind::PermissionDenied => return mount_with_helper(path, options),
            _ => return Err(MountError::System(DEVICE.into(), error)),
        },
    };
    if !geteuid().is_root() {
        return mount_with_helper(path, options);
    }
    match mount_as_root(&device, path, options) {
        Ok(()) => Ok(device.into()),
        // A container's root.
        Err(Errno::EPERM) => mount_with_helper(path, options),
        // The module is not loaded although the device node exists.
        Err(Errno::ENODEV) => Err(MountError::NoDevice),
        Err(errno) => Err(MountError::System(path.into(), errno.into())),
    }
}

/// Unmounts a trikfs; if it is busy, lazily.
///
/// # Errors
/// [`MountError::NotMounted`] for anything that is not a trikfs: nothing else is ever unmounted.
pub fn unmount(path: &Path) -> Result<Unmounted, MountError> {
    match find(path)? {
        Some(entry) if entry.kind == TYPE => {}
        _ => return Err(MountError::NotMounted(path.into())),
    }
    match umount2(path, MntFlags::UMOUNT_NOFOLLOW) {
        Ok(()) => Ok(Unmounted::Clean),
        Err(Errno::EBUSY) => detach(path).map(|()| Unmounted::Detached),
        Err(Errno::EPERM) => {
            match run_helper(&[OsStr::new("-u"), OsStr::new("--"), path.as_os_str()]) {
                Ok(()) => Ok(Unmounted::Clean),
                Err(MountError::Helper(_)) => detach(path).map(|()| Unmounted::Detached),
                Err(error) => Err(error),
            }
        }
        Err(Errno::EINVAL) => Err(MountError::NotMounted(path.into())),
        Err(errno) => Err(MountError::System(path.into(), errno.into())),
    }
}

/// True if a trikfs is mounted exactly there, alive or dead.
///
/// # Errors
/// If the mount table cannot be read.
pub fn is_mounted(path: &Path) -> Result<bool, MountError> {
    Ok(find(path)?.is_some_and(|entry| entry.kind == TYPE))
}

/// The uppermost mount exactly at `path`.
///
/// # Errors
/// If the mount table cannot be read.
pub fn find(path: &Path) -> Result<Option<MountEntry>, MountError> {
    let path = absolute(path);
    let text = table().map_err(|error| MountError::System(TABLE.into(), error))?;
    // Later lines lie over earlier ones.
    Ok(parse_mountinfo(&text)
        .filter(|entry| entry.mountpoint == path)
        .last())
}

/// The text of /proc/self/mountinfo as it was at one moment.
///
/// A list that is read while others mount and unmount can lack an entry that is there all the time (before Linux 5.8),
/// so it is read again when it has changed meanwhile, which poll(2) tells (proc(5)).
///
/// # Errors
/// If it cannot be read.
pub fn table() -> io::Result<Vec<u8>> {
    let mut text = Vec::new();
    for _ in 0..MOUNT_TABLE_READS_MAX {
        let file = File::open(TABLE)?;
        text.clear();
        (&file).take(MOUNT_TABLE_BYTES_MAX).read_to_end(&mut text)?;
        let mut changed = [PollFd::new(file.as_fd(), PollFlags::POLLPRI)];
        if poll(&mut changed, PollTimeout::ZERO)? == 0 {
            break;
        }
    }
    Ok(text)
}

/// One line of /proc/self/mountinfo; see proc(5).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MountEntry {
    /// Number of the mount, unique while it exists.
    pub id: u32,
    /// Device number of the filesystem; the minor one names a FUSE connection in /sys/fs/fuse/connections.
    pub device: (u32, u32),
    /// What of the filesystem is there: `/` if it is all of it.
    pub root: PathBuf,
    /// Where it is.
    pub mountpoint: PathBuf,
    /// Its own options, for example `rw,nosuid`.
    pub options: String,
    /// Type, for example `fuse.trikfs`.
    pub kind: String,
    /// What was mounted.
    pub source: OsString,
    /// Options of the filesystem as a whole, separated by commas (the super options of proc_pid_mountinfo(5)).
    pub super_options: String,
}

/// The mounts in the text of /proc/self/mountinfo. Lines that are not understood are left out.
pub fn parse_mountinfo(text: &[u8]) -> impl Iterator<Item = MountEntry> + '_ {
    text.split(|&b| b == b'\n').filter_map(parse_line)
}

/// `36 35 98:0 /root /mnt rw,noatime shared:1 ... - ext3 /dev/root rw,errors=continue`
fn parse_line(line: &[u8]) -> Option<MountEntry> {
    let mut fields = line.split(|&b| b == b' ');
    let id = number(fields.next()?)?;
    let (_parent, device) = (fields.next()?, fields.next()?);
    let (root, mountpoint) = (fields.next()?, fields.next()?);
    let options = String::from_utf8(fields.next()?.to_vec()).ok()?;
    let colon = device.iter().position(|&b| b == b':')?;
    let mut behind = fields.skip_while(|&field| field != b"-").skip(1);
    let kind = String::from_utf8(unescape(behind.next()?)).ok()?;
    let source = OsString::from_vec(unescape(behind.next()?));
    let super_options = behind.next().unwrap_or_default();
    Some(MountEntry {
        id,
        device: (number(&device[..colon])?, number(&device[colon + 1..])?),
        root: PathBuf::from(OsString::from_vec(unescape(root))),
        mountpoint: PathBuf::from(OsString::from_vec(unescape(mountpoint))),
        options,
        kind,
        source,
        super_options: String::from_utf8_lossy(&unescape(super_options)).into_owned(),
    })
}

fn number(digits: &[u8]) -> Option<u32> {
    std::str::from_utf8(digits).ok()?.parse().ok()
}

/// The kernel writes space, tab, newline, backslash and `#` as a backslash and three octal digits.
fn unescape(field: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(field.len());
    let mut rest = field;
    while let Some((&first, behind)) = rest.split_first() {
        let escaped = match (first, behind) {
            (b'\\', [a @ b'0'..=b'3', b @ b'0'..=b'7', c @ b'0'..=b'7', ..]) => {
                Some((a - b'0') << 6 | (b - b'0') << 3 | (c - b'0'))
            }
            _ => None,
        };
        bytes.push(escaped.unwrap_or(first));
        rest = if escaped.is_some() {
            &behind[3..]
        } else {
            behind
        };
    }
    bytes
}

/// The path as the mount table has it. Of a dead mount only the parent can be asked.
fn absolute(path: &Path) -> PathBuf {
    let resolved = path.canonicalize().or_else(|error| {
        let (Some(parent), Some(name)) = (path.parent(), path.file_name()) else {
            return Err(error);
        };
        let parent = if parent.as_os_str().is_empty() {
            Path::new(".")
        } else {
            parent
        };
        parent.canonicalize().map(|parent| parent.join(name))
    });
    resolved.unwrap_or_else(|_| path.into())
}

/// Sees to it that `path` is a directory that can be mounted on, and takes a dead trikfs away.
fn clear_mountpoint(path: &Path) -> Result<(), MountError> {
    // A mount may lie over a dead one; more layers than that are not our doing.
    for _ in 0..2 {
        let over = find(path)?;
        // The kernel answers stat(2) of a dead mount from its cache; statfs(2) always asks the process.
        let checked = fs::metadata(path).and_then(|data| match &over {
            Some(entry) if entry.kind == TYPE => Ok(statfs(path).map(|_| data)?),
            _ => Ok(data),
        });
        match (checked, over) {
            (Ok(_), Some(entry)) if entry.kind == TYPE => {
                return Err(MountError::AlreadyMounted(path.into()));
            }
            (Ok(data), _) if data.is_dir() => return Ok(()),
            (Ok(_), _) => return Err(MountError::NotADirectory(path.into())),
            (Err(error), Some(entry)) if is_dead(&error) => {
                if entry.kind != TYPE {
                    return Err(MountError::Dead(path.into(), entry.kind));
                }
                detach(path)?;
            }
            (Err(error), _) if error.kind() == io::ErrorKind::NotFound => {
                return Err(MountError::NoMountpoint(path.into()));
            }
            (Err(error), Some(entry))
                if entry.kind == TYPE && error.kind() == io::ErrorKind::PermissionDenied =>
            {
                // Somebody else's, mounted without allow_other.
                return Err(MountError::AlreadyMounted(path.into()));
            }
            (Err(error), _) => return Err(MountError::System(path.into(), error)),
        }
    }
    Err(MountError::System(path.into(), Errno::ENOTCONN.into()))
}

/// What a mount whose process is gone answers: ENOTCONN, or ECONNABORTED right after it went.
fn is_dead(error: &io::Error) -> bool {
    matches!(
        error.raw_os_error().map(Errno::from_raw),
        Some(Errno::ENOTCONN | Errno::ECONNABORTED)
    )
}

fn detach(path: &Path) -> Result<(), MountError> {
    match umount2(path, MntFlags::MNT_DETACH | MntFlags::UMOUNT_NOFOLLOW) {
        Ok(()) => Ok(()),
        Err(Errno::EPERM) => run_helper(&[OsStr::new("-uz"), OsStr::new("--"), path.as_os_str()]),
        Err(errno) => Err(MountError::System(path.into(), errno.into())),
    }
}

/// mount(2) with the options of `fuse` (Documentation/filesystems/fuse in the kernel).
fn mount_as_root(device: &File, path: &Path, options: &MountOptions) -> Result<(), Errno> {
    let mut data = format!(
        "fd={},rootmode=40000,user_id={},group_id={},default_permissions",
        device.as_raw_fd(),
        geteuid(),
        getegid()
    );
    if options.allow_other {
        data.push_str(",allow_other");
    }
    let mut flags = MsFlags::MS_NOSUID | MsFlags::MS_NODEV;
    if options.read_only {
        flags |= MsFlags::MS_RDONLY;
    }
    nix::mount::mount(
        Some(options.source.as_str()),
        path,
        Some(TYPE),
        flags,
        Some(data.as_str()),
    )
}

/// Lets the helper mount; it sends the open device over a socket, which it finds as its standard input.
fn mount_with_helper(path: &Path, options: &MountOptions) -> Result<OwnedFd, MountError> {
    let system = |error| MountError::System(path.into(), error);
    let mut list = format!(
        "nosuid,nodev,default_permissions,fsname={},subtype={SUBTYPE}",
        options.source
    );
    if options.allow_other {
        list.push_str(",allow_other");
    }
    if options.read_only {
        list.push_str(",ro");
    }
    let (here, there) = UnixStream::pair().map_err(system)?;
    let arguments = [
        OsStr::new("-o"),
        OsStr::new(&list),
        OsStr::new("--"),
        path.as_os_str(),
    ];
    let mut command = helper(&arguments);
    command
        .env("_FUSE_COMMFD", "0")
        .stdin(Stdio::from(OwnedFd::from(there)));
    run(command)?;
    receive_descriptor(&here).map_err(system)
}

fn run_helper(arguments: &[&OsStr]) -> Result<(), MountError> {
    let mut command = helper(arguments);
    command.stdin(Stdio::null());
    run(command)
}

fn helper(arguments: &[&OsStr]) -> Command {
    let mut command = Command::new(HELPER);
    command
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

/// Runs the helper to its end. The command and with it our copy of the other end of the socket are dropped, so that
/// a helper that sends nothing is seen to have closed.
fn run(mut command: Command) -> Result<(), MountError> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => MountError::NoPermission,
        _ => MountError::System(HELPER.into(), error),
    };
    let mut child = command.spawn().map_err(failed)?;
    let mut complaint = Vec::new();
    if let Some(stderr) = child.stderr.take() {
        let _ = stderr
            .take(HELPER_COMPLAINT_BYTES_MAX)
            .read_to_end(&mut complaint);
    }
    let status = child.wait().map_err(failed)?;
    if status.success() {
        return Ok(());
    }
    let complaint = String::from_utf8_lossy(&complaint).trim().to_owned();
    Err(MountError::Helper(if complaint.is_empty() {
        format!("{HELPER}: {status}")
    } else {
        complaint
    }))
}

/// Options are a list with commas; a source with one would be another option.
fn check_option(text: &OsStr) -> Result<(), MountError> {
    let bad = |&byte: &u8| byte == b',' || byte == b'\\' || byte.is_ascii_control();
    if text.as_bytes().iter().any(bad) {
        return Err(MountError::BadOption(text.to_string_lossy().into_owned()));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
