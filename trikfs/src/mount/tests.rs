//! Tests of mounting: the mount table, its escapes, messages.

use super::*;
use crate::transport::native::{Session, SessionOptions};
use crate::transport::null::NullFs;
use std::sync::Arc;
use tempfile::TempDir;

/// A directory of one test, taken away with it after whatever is mounted there.
struct Scratch(PathBuf, TempDir);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = tempfile::Builder::new()
            .prefix(&format!("trikfs-mount-{name}-"))
            .tempdir();
        let folder = folder.unwrap();
        Self(folder.path().to_owned(), folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        loop {
            match unmount(&self.0) {
                Ok(_) => {}
                Err(MountError::NotMounted(_)) => return,
                // What is still mounted is not emptied.
                Err(_) => return self.1.disable_cleanup(true),
            }
        }
    }
}

/// False, with a named skip, where nothing can be mounted.
fn can_mount() -> bool {
    if Path::new(DEVICE).exists() && geteuid().is_root() {
        return true;
    }
    needs::Need::Fuse.missing(format_args!("no {DEVICE} or not root"));
    false
}

fn serve(device: OwnedFd) -> std::thread::JoinHandle<io::Result<()>> {
    let session = Session::new(device, Arc::new(NullFs), SessionOptions::default());
    std::thread::spawn(move || session.serve())
}

fn mounted(path: &Path) -> OwnedFd {
    mount(path, &MountOptions::default()).unwrap()
}

const TABLE: &[u8] = b"22 28 0:21 / /sys rw,nosuid shared:7 - sysfs sysfs rw\n\
    40 28 0:50 / /mnt/my\\040robot rw,nosuid,nodev - fuse.trikfs tr\\134ik rw,user_id=0\n\
    41 28 0:51 / /mnt/x rw - fuse.trikfs\n\
    not a line\n\
    99 28 0:52 / /mnt/x rw master:1 propagate_from:2 - fuse.sshfs host:/ rw\n";

#[test]
fn the_mount_table_is_read_with_its_escapes() {
    let entries: Vec<_> = parse_mountinfo(TABLE).collect();
    assert_eq!(entries.len(), 3);
    assert_eq!(entries[0].kind, "sysfs");
    let expected = MountEntry {
        id: 40,
        device: (0, 50),
        root: "/".into(),
        mountpoint: "/mnt/my robot".into(),
        options: "rw,nosuid,nodev".into(),
        kind: "fuse.trikfs".into(),
        source: "tr\\ik".into(),
        super_options: "rw,user_id=0".to_owned(),
    };
    assert_eq!(entries[1], expected);
    assert_eq!(
        (entries[2].id, entries[2].kind.as_str()),
        (99, "fuse.sshfs")
    );
}

#[test]
fn escapes_that_are_none_stay() {
    assert_eq!(unescape(b"a\\040b\\"), b"a b\\");
    assert_eq!(unescape(b"\\04"), b"\\04");
    assert_eq!(unescape(b"\\777\\134134"), b"\\777\\134");
}

#[test]
fn messages_say_what_to_do() {
    let at = || PathBuf::from("/r");
    let texts = [
        (
            MountError::NoDevice,
            "/dev/fuse: no such device: load the kernel module fuse (modprobe fuse)",
        ),
        (
            MountError::NoPermission,
            "no permission to mount: install package fuse3 or run as root",
        ),
        (
            MountError::NoMountpoint(at()),
            "/r: no such directory: create it first",
        ),
        (MountError::NotADirectory(at()), "/r: not a directory"),
        (
            MountError::AlreadyMounted(at()),
            "/r: a trikfs is mounted there already",
        ),
        (
            MountError::Dead(at(), "fuse.sshfs".into()),
            "/r: a dead filesystem of type fuse.sshfs is mounted there: unmount it first",
        ),
        (
            MountError::NotMounted(at()),
            "/r: no trikfs is mounted there",
        ),
        (
            MountError::BadOption("a,b".into()),
            "\"a,b\": cannot be part of a mount option",
        ),
    ];
    for (error, text) in texts {
        assert_eq!(error.to_string(), text);
    }
}

#[test]
fn a_missing_mountpoint_and_a_file_are_refused() {
    let scratch = Scratch::new("refused");
    let options = MountOptions::default();
    let missing = scratch.0.join("missing");
    assert!(matches!(
        mount(&missing, &options),
        Err(MountError::NoMountpoint(_))
    ));
    let file = scratch.0.join("file");
    fs::write(&file, "").unwrap();
    assert!(matches!(
        mount(&file, &options),
        Err(MountError::NotADirectory(_))
    ));
}

#[test]
fn a_source_cannot_smuggle_options_in() {
    let options = MountOptions {
        source: "x,allow_other".into(),
        ..MountOptions::default()
    };
    assert!(matches!(
        mount(Path::new("/"), &options),
        Err(MountError::BadOption(_))
    ));
}

#[test]
fn nothing_but_a_trikfs_is_unmounted() {
    for path in ["/", "/proc", "/tmp", "/no/such/path"] {
        assert!(
            matches!(unmount(Path::new(path)), Err(MountError::NotMounted(_))),
            "{path}"
        );
    }
}

#[test]
fn a_mount_is_served_found_and_unmounted() {
    if !can_mount() {
        return;
    }
    let scratch = Scratch::new("served dir");
    let options = MountOptions {
        source: "robot".into(),
        ..MountOptions::default()
    };
    let served = serve(mount(&scratch.0, &options).unwrap());
    assert_eq!(fs::read_dir(&scratch.0).unwrap().count(), 2);
    let entry = find(&scratch.0).unwrap().unwrap();
    assert_eq!(
        (entry.kind.as_str(), entry.source.to_str()),
        (TYPE, Some("robot"))
    );
    assert!(is_mounted(&scratch.0).unwrap());
    assert!(matches!(
        mount(&scratch.0, &options),
        Err(MountError::AlreadyMounted(_))
    ));
    assert_eq!(unmount(&scratch.0).unwrap(), Unmounted::Clean);
    served.join().unwrap().unwrap();
    assert!(!is_mounted(&scratch.0).unwrap());
}

#[test]
fn a_read_only_mount_refuses_writers() {
    if !can_mount() {
        return;
    }
    let scratch = Scratch::new("read-only");
    let options = MountOptions {
        read_only: true,
        ..MountOptions::default()
    };
    let served = serve(mount(&scratch.0, &options).unwrap());
    let error = OpenOptions::new()
        .write(true)
        .open(scratch.0.join("null"))
        .unwrap_err();
    assert_eq!(error.raw_os_error(), Some(libc::EROFS));
    unmount(&scratch.0).unwrap();
    served.join().unwrap().unwrap();
}

#[test]
fn a_busy_mount_is_detached_and_ends_with_its_last_file() {
    if !can_mount() {
        return;
    }
    let scratch = Scratch::new("busy");
    let served = serve(mounted(&scratch.0));
    let file = File::open(scratch.0.join("null")).unwrap();
    assert_eq!(unmount(&scratch.0).unwrap(), Unmounted::Detached);
    assert!(!is_mounted(&scratch.0).unwrap());
    let mut bytes = [0; 4];
    (&file).read_exact(&mut bytes).unwrap();
    assert!(!served.is_finished());
    drop(file);
    served.join().unwrap().unwrap();
}

#[test]
fn a_stale_mount_is_replaced() {
    if !can_mount() {
        return;
    }
    let scratch = Scratch::new("stale");
    drop(mounted(&scratch.0));
    assert!(is_dead(&fs::metadata(&scratch.0).unwrap_err()));
    assert!(is_mounted(&scratch.0).unwrap());
    let served = serve(mounted(&scratch.0));
    assert_eq!(
        fs::read(scratch.0.join("null")).unwrap().first(),
        Some(&b'n')
    );
    assert_eq!(unmount(&scratch.0).unwrap(), Unmounted::Clean);
    served.join().unwrap().unwrap();
    assert!(
        matches!(unmount(&scratch.0), Err(MountError::NotMounted(_))),
        "the stale one was taken away"
    );
}

#[test]
fn the_helper_mounts_and_hands_the_device_over() {
    if !can_mount() {
        return;
    }
    if Command::new(HELPER).arg("--version").output().is_err() {
        needs::Need::Fuse.missing(format_args!("no {HELPER}"));
        return;
    }
    let scratch = Scratch::new("helper");
    let served = serve(mount_with_helper(&scratch.0, &MountOptions::default()).unwrap());
    assert_eq!(fs::read_dir(&scratch.0).unwrap().count(), 2);
    assert_eq!(find(&scratch.0).unwrap().unwrap().kind, TYPE);
    assert_eq!(unmount(&scratch.0).unwrap(), Unmounted::Clean);
    served.join().unwrap().unwrap();
    let error =
        mount_with_helper(&scratch.0.join("missing"), &MountOptions::default()).unwrap_err();
    assert!(
        matches!(&error, MountError::Helper(text) if text.starts_with(HELPER)),
        "{error}"
    );
}
