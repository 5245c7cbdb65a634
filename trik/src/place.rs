//! Where the virtual robots of a user are: names, locks, records, and what dead ones left behind.
//!
//! Owns one private directory, `$XDG_RUNTIME_DIR/trik` or `/tmp/trik-UID`. For a robot NAME it has `NAME` (the default
//! mount point), `NAME.board` (devices), `NAME.trikd` (folders of trikd), `NAME.ev3dev` (the view of ev3dev of a robot
//! at its default mount point) and `NAME.lock`: who holds the lock is alive, whatever its process number, and the file
//! tells where the robot is: a line with the path of its tree, one with the address where trikd takes programs, if it
//! runs, and one with that of its page. Knows nothing of what a board or a tree is.

use crate::error::Error;
use crate::limits;
use nix::sys::statfs::statfs;
use nix::unistd::geteuid;
use std::ffi::OsStr;
use std::fs::{self, DirBuilder, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::net::SocketAddr;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, FileExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

/// Ending of the directory for the view of ev3dev.
const VIEW: &str = "ev3dev";
/// Ending of the directory for the folders of trikd.
const TRIKD: &str = "trikd";
/// Ending of the configuration that a world makes.
const WORLD: &str = "lua";

/// The directory for the robots of this user.
///
/// # Errors
/// It cannot be made, or somebody else could write to it.
pub fn base() -> Result<PathBuf, Error> {
    let dir = path();
    make_private(&dir).map_err(|error| Error::file(&dir, error))?;
    Ok(dir)
}

fn path() -> PathBuf {
    let runtime = std::env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    match runtime.filter(|dir| dir.is_absolute() && dir.is_dir()) {
        Some(runtime) if runtime.as_os_str().len() + 5 <= limits::BASE_BYTES_MAX => {
            runtime.join("trik")
        }
        Some(_) | None => PathBuf::from(format!("/tmp/trik-{}", geteuid())),
    }
}

/// In /tmp everybody may have been here first.
fn make_private(dir: &Path) -> io::Result<()> {
    match DirBuilder::new().mode(0o700).create(dir) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    check_private(dir)
}

fn check_private(dir: &Path) -> io::Result<()> {
    let found = dir.symlink_metadata()?;
    if !found.is_dir() || found.uid() != geteuid().as_raw() || found.mode() & 0o077 != 0 {
        return Err(io::Error::other(
            "not a private directory of yours: remove it, or set XDG_RUNTIME_DIR to one that is",
        ));
    }
    Ok(())
}

/// The place of a robot of this process. Dropping it gives it up.
#[derive(Debug)]
pub struct Place {
    /// Where its tree is to be mounted.
    pub mountpoint: PathBuf,
    /// For its devices; nothing is there yet.
    pub board: PathBuf,
    /// For the folders of trikd; nothing is there yet.
    pub trikd: PathBuf,
    /// The file of a configuration that is made for a world.
    pub world: PathBuf,
    /// From 1: which of the robots of this user it is.
    pub number: usize,
    made_mountpoint: bool,
    /// Made for the view of ev3dev.
    made_view: Option<PathBuf>,
    lock: PathBuf,
    held: File,
}

impl Place {
    /// Takes the first free name, and cleans up what a dead robot left there.
    ///
    /// # Errors
    /// The mount point is not an empty directory, or too many robots run.
    pub fn claim(base: &Path, mountpoint: Option<&Path>) -> Result<Self, Error> {
        // Those of other names too: nobody may ever ask for their names again.
        sweep(base);
        for number in 1..=limits::ROBOTS_MAX {
            let name = name(number);
            let lock = base.join(format!("{name}.lock"));
            let fail = |error: io::Error| Error::file(&lock, error);
            let taken = match take(&lock) {
                // The last of the robots before has taken the directory with it.
                Err(error) if error.kind() == io::ErrorKind::NotFound => make_private(base)
                    .and_then(|()| take(&lock))
                    .map_err(fail)?,
                taken => taken.map_err(fail)?,
            };
            let Some(held) = taken else { continue };
            let default = base.join(&name);
            // Nobody is left to unmount a dead one, and a guardian that has lost its parent may still be busy with a
            // living one.
            if mountpoint.is_none() && is_dead(&default) {
                let _ = trikfs::mount::unmount(&default);
            }
            if mountpoint.is_none() && is_mount(&default)? {
                continue;
            }
            let mut place = Self {
                mountpoint: mountpoint.unwrap_or(&default).to_owned(),
                board: base.join(format!("{name}.board")),
                trikd: lock.with_extension(TRIKD),
                world: lock.with_extension(WORLD),
                number,
                made_mountpoint: false,
                made_view: None,
                lock,
                held,
            };
            // The default one is ours, whichever process of ours made it.
            place.made_mountpoint = make_mountpoint(&place.mountpoint)? || mountpoint.is_none();
            place
                .record()
                .map_err(|error| Error::file(&place.lock, error))?;
            return Ok(place);
        }
        Err(Error::Refused(format!(
            "{} robots run already: stop one",
            limits::ROBOTS_MAX
        )))
    }

    /// A directory for the view of ev3dev: this one, or the one beside the tree.
    ///
    /// # Errors
    /// It is not empty, cannot be made, or the tree has no name to which one could be added.
    pub fn make_view(&mut self, wanted: Option<&Path>) -> Result<PathBuf, Error> {
        let path = match wanted {
            Some(path) => path.to_owned(),
            None => view_of(&self.mountpoint).ok_or_else(|| {
                let shown = self.mountpoint.display();
                Error::Refused(format!(
                    "nothing can be beside {shown}: say where the view is to be with --ev3dev=DIR"
                ))
            })?,
        };
        // The one in our own directory is ours, whichever process of ours made it.
        if make_mountpoint(&path)? || path == self.lock.with_extension(VIEW) {
            self.made_view = Some(path.clone());
        }
        Ok(path)
    }

    /// Tells others where this robot is.
    fn record(&mut self) -> io::Result<()> {
        let mut text = self.mountpoint.as_os_str().as_bytes().to_vec();
        if text.contains(&b'\n') {
            return Err(io::Error::other("the mount point has a line break in it"));
        }
        text.push(b'\n');
        self.held.write_all(&text)
    }

    /// Tells others where its trikd takes programs, and where its page is, if it has one.
    ///
    /// # Errors
    /// Those of the file system.
    pub fn announce(
        &self,
        address: Option<SocketAddr>,
        page: Option<SocketAddr>,
    ) -> io::Result<()> {
        let first = self.mountpoint.as_os_str().len() + 1;
        let first = u64::try_from(first).map_err(io::Error::other)?;
        self.held.set_len(first)?;
        match address {
            Some(address) => {
                let page = page.map_or_else(String::new, |page| format!("{page}\n"));
                self.held
                    .write_all_at(format!("{address}\n{page}").as_bytes(), first)
            }
            None => Ok(()),
        }
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        if self.made_mountpoint {
            // Not if it is not empty: somebody has put something there, or it is still mounted.
            let _ = fs::remove_dir(&self.mountpoint);
        }
        let _ = self.made_view.as_ref().map(fs::remove_dir);
        let _ = fs::remove_dir_all(&self.board);
        let _ = fs::remove_dir_all(&self.trikd);
        let _ = fs::remove_file(&self.world);
        let _ = fs::remove_file(&self.lock);
        // Only the last robot succeeds.
        let _ = self.lock.parent().map(fs::remove_dir);
    }
}

/// A robot that runs now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Running {
    /// Where its tree is mounted.
    pub mountpoint: PathBuf,
    /// Its devices.
    pub board: PathBuf,
    /// Where its trikd takes programs; None: it has no trikd.
    pub trikd: Option<SocketAddr>,
    /// Where its page is, if it has one.
    pub page: Option<SocketAddr>,
}

/// All robots of this user that run. Looking makes nothing, so that many may look while a robot starts or ends.
///
/// # Errors
/// The directory cannot be read, or somebody else could write to it.
pub fn running() -> Result<Vec<Running>, Error> {
    let base = path();
    let found = match check_private(&base) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        private => private.and_then(|()| running_in(&base)),
    };
    found.map_err(|error| Error::file(&base, error))
}

fn running_in(base: &Path) -> io::Result<Vec<Running>> {
    let mut found = Vec::new();
    for number in 1..=limits::ROBOTS_MAX {
        let name = name(number);
        let mut file = match File::open(base.join(format!("{name}.lock"))) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            file => file?,
        };
        // A shared lock, so that two who look at the same time do not take each other for the robot.
        match file.try_lock_shared() {
            Err(TryLockError::WouldBlock) => {}
            Err(TryLockError::Error(error)) => return Err(error),
            Ok(()) => continue,
        }
        if let Some(record) = read_record(&mut file)? {
            found.push(Running {
                mountpoint: record.mountpoint,
                board: base.join(format!("{name}.board")),
                trikd: record.trikd,
                page: record.page,
            });
        }
    }
    Ok(found)
}

/// Where the view of a tree is if nobody says another place: beside it, with an ending after its whole name.
fn view_of(mountpoint: &Path) -> Option<PathBuf> {
    let mut name = mountpoint.file_name()?.to_owned();
    name.push(".");
    name.push(VIEW);
    Some(mountpoint.with_file_name(name))
}

fn name(number: usize) -> String {
    match number {
        1 => "robot".to_owned(),
        _ => format!("robot-{number}"),
    }
}

/// The lock of a name, or nothing if a living process has it.
fn take(path: &Path) -> io::Result<Option<File>> {
    loop {
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .mode(0o600)
            .open(path)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => return Err(error),
            Ok(()) => {}
        }
        // The one who had it may have removed the file since it was opened: then the lock is of nothing.
        if path
            .metadata()
            .is_ok_and(|now| file.metadata().is_ok_and(|own| own.ino() == now.ino()))
        {
            file.set_len(0)?;
            return Ok(Some(file));
        }
    }
}

/// Cleans up after robots whose process is gone. Goes on whatever fails: the next start tries again.
fn sweep(base: &Path) {
    for number in 1..=limits::ROBOTS_MAX {
        let name = name(number);
        let lock = base.join(format!("{name}.lock"));
        let Ok(mut file) = OpenOptions::new().read(true).write(true).open(&lock) else {
            continue;
        };
        let is_ours = file.try_lock().is_ok()
            && lock
                .metadata()
                .is_ok_and(|now| file.metadata().is_ok_and(|own| own.ino() == now.ino()));
        if !is_ours {
            continue;
        }
        if let Ok(Some(Record { mountpoint, .. })) = read_record(&mut file) {
            for path in view_of(&mountpoint).iter().chain([&mountpoint]) {
                if is_dead(path) {
                    let _ = trikfs::mount::unmount(path);
                }
            }
            // Its own mount point only, and only if it is empty.
            if mountpoint == base.join(&name) {
                let _ = fs::remove_dir(&mountpoint);
            }
        }
        let view = lock.with_extension(VIEW);
        if is_dead(&view) {
            let _ = trikfs::mount::unmount(&view);
        }
        let _ = fs::remove_dir(view);
        let _ = fs::remove_dir_all(base.join(format!("{name}.board")));
        let _ = fs::remove_dir_all(lock.with_extension(TRIKD));
        let _ = fs::remove_file(lock.with_extension(WORLD));
        let _ = fs::remove_file(&lock);
    }
}

/// What the file of a robot tells.
struct Record {
    mountpoint: PathBuf,
    trikd: Option<SocketAddr>,
    page: Option<SocketAddr>,
}

fn read_record(file: &mut File) -> io::Result<Option<Record>> {
    let mut text = Vec::new();
    file.seek(SeekFrom::Start(0))?;
    file.take(limits::RECORD_BYTES_MAX).read_to_end(&mut text)?;
    let mut lines = text.split(|&byte| byte == b'\n');
    let mountpoint = lines.next().filter(|line| line.starts_with(b"/"));
    let mut address = || std::str::from_utf8(lines.next()?).ok()?.parse().ok();
    let (trikd, page) = (address(), address());
    Ok(mountpoint.map(|line| Record {
        mountpoint: PathBuf::from(OsStr::from_bytes(line)),
        trikd,
        page,
    }))
}

/// A tree that has lost all its processes.
fn is_dead(mountpoint: &Path) -> bool {
    is_mount(mountpoint).unwrap_or(false)
        && matches!(
            statfs(mountpoint),
            Err(nix::errno::Errno::ENOTCONN | nix::errno::Errno::ECONNABORTED)
        )
}

fn is_mount(path: &Path) -> Result<bool, Error> {
    trikfs::mount::find(path)
        .map(|found| found.is_some())
        .map_err(|error| Error::Refused(error.to_string()))
}

/// True if the directory was made here.
fn make_mountpoint(path: &Path) -> Result<bool, Error> {
    let shown = path.display();
    // Before it is looked into: who serves it may not answer.
    if is_mount(path)? {
        let why = "something is mounted there already: unmount it, or name another directory";
        return Err(Error::file(path, why));
    }
    match fs::read_dir(path).map(|entries| entries.count()) {
        Ok(0) => Ok(false),
        Ok(_) => Err(Error::Refused(format!(
            "{shown} is not empty: name an empty directory, or none"
        ))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let made = DirBuilder::new().recursive(true).mode(0o700).create(path);
            made.map(|()| true).map_err(|error| {
                Error::system(format!("the mount point {shown} cannot be made"), error)
            })
        }
        Err(error) => Err(Error::system(format!("the mount point {shown}"), error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A private directory for one test.
    struct Base(PathBuf);

    impl Base {
        fn new(name: &str) -> Self {
            let dir = PathBuf::from(format!("/tmp/trik-place-{name}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&dir);
            make_private(&dir).expect("a directory");
            Self(dir)
        }
    }

    impl Drop for Base {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn robots_side_by_side_have_different_names_and_leave_nothing() {
        let base = Base::new("side");
        let first = Place::claim(&base.0, None).expect("a place");
        let second = Place::claim(&base.0, None).expect("another place");
        assert_eq!(first.mountpoint, base.0.join("robot"));
        assert_eq!(second.mountpoint, base.0.join("robot-2"));
        let found = running_in(&base.0).expect("a list");
        let points: Vec<_> = found.into_iter().map(|found| found.mountpoint).collect();
        assert_eq!(
            points,
            [first.mountpoint.clone(), second.mountpoint.clone()]
        );
        let at = "127.0.0.1:8888".parse().ok();
        let page = "127.0.0.1:8000".parse().ok();
        let told = || {
            let first = running_in(&base.0).expect("a list").swap_remove(0);
            (first.trikd, first.page)
        };
        first.announce(at, page).expect("a record");
        assert_eq!(told(), (at, page));
        first.announce(at, None).expect("a record");
        assert_eq!(told(), (at, None));
        first.announce(None, page).expect("a record");
        assert_eq!(told(), (None, None));
        drop(first);
        let third = Place::claim(&base.0, None).expect("the first place again");
        assert_eq!(third.mountpoint, base.0.join("robot"));
        drop((second, third));
        assert!(!base.0.exists());
    }

    #[test]
    fn what_a_dead_robot_left_is_removed_at_the_next_start() {
        let base = Base::new("dead");
        // Nobody holds this lock.
        fs::write(
            base.0.join("robot-3.lock"),
            base.0.join("robot-3").as_os_str().as_bytes(),
        )
        .expect("a record");
        fs::create_dir_all(base.0.join("robot-3.board/dev")).expect("a board");
        fs::create_dir_all(base.0.join("robot-3.trikd/scripts")).expect("folders");
        fs::create_dir(base.0.join("robot-3")).expect("a mount point");
        assert_eq!(running_in(&base.0).expect("a list"), []);
        let place = Place::claim(&base.0, None).expect("a place");
        for name in ["robot-3", "robot-3.board", "robot-3.trikd", "robot-3.lock"] {
            assert!(!base.0.join(name).exists(), "{name}");
        }
        drop(place);
    }

    #[test]
    fn a_mount_point_that_is_not_empty_is_refused_and_one_of_the_user_stays() {
        let base = Base::new("point");
        let full = base.0.join("full");
        fs::create_dir_all(full.join("x")).expect("a directory");
        let refusal = Place::claim(&base.0, Some(&full))
            .expect_err("refused")
            .to_string();
        assert_eq!(
            refusal,
            format!(
                "{} is not empty: name an empty directory, or none",
                full.display()
            )
        );
        let refusal = Place::claim(&base.0, Some(Path::new("/proc")))
            .expect_err("refused")
            .to_string();
        assert!(
            refusal.contains("something is mounted there already"),
            "{refusal}"
        );
        let empty = base.0.join("empty");
        fs::create_dir(&empty).expect("a directory");
        drop(Place::claim(&base.0, Some(&empty)).expect("a place"));
        assert!(empty.exists());
        let fresh = base.0.join("fresh");
        drop(Place::claim(&base.0, Some(&fresh)).expect("a place"));
        assert!(!fresh.exists());
    }

    #[test]
    fn the_view_is_beside_the_tree_and_goes_with_it_if_it_was_made() {
        let base = Base::new("view");
        // The last robot takes this one with it.
        let run = base.0.join("run");
        let tree = base.0.join("my.tree");
        let view = base.0.join("my.tree.ev3dev");
        let mut place = Place::claim(&run, Some(&tree.join(""))).expect("a place");
        assert_eq!(place.make_view(None).as_deref(), Ok(view.as_path()));
        drop(place);
        assert!(!view.exists());
        fs::create_dir(&view).expect("a directory of the user's own");
        let mut place = Place::claim(&run, Some(&tree)).expect("a place");
        assert_eq!(place.make_view(None).as_deref(), Ok(view.as_path()));
        drop(place);
        assert!(view.exists());
        let mut place = Place::claim(&run, None).expect("a place");
        let default = run.join("robot.ev3dev");
        assert_eq!(place.make_view(None).as_deref(), Ok(default.as_path()));
        drop(place);
        assert!(!default.exists());
        assert_eq!(view_of(Path::new("/")), None);
    }

    #[test]
    fn a_directory_that_others_can_write_to_is_refused() {
        let base = Base::new("open");
        fs::set_permissions(&base.0, std::os::unix::fs::PermissionsExt::from_mode(0o777))
            .expect("a mode");
        assert!(make_private(&base.0).is_err());
        let link = base.0.join("link");
        std::os::unix::fs::symlink("/tmp", &link).expect("a link");
        assert!(make_private(&link).is_err());
    }
}
