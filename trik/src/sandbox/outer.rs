//! The outer step: makes the namespaces, starts the inner step in them, and waits for its end.
//!
//! A namespace of processes begins with the next child, so somebody has to stay outside. Owns which user the program
//! will be.

use super::layer::Layer;
use super::order::{Order, Step};
use super::{NAME, SELF, group};
use crate::error::Error;
use nix::fcntl::{OFlag, open, openat};
use nix::sched::{CloneFlags, unshare};
use nix::sys::prctl::{set_dumpable, set_pdeathsig};
use nix::sys::resource::{Resource, getrlimit};
use nix::sys::signal::Signal;
use nix::sys::stat::Mode;
use nix::sys::utsname::uname;
use nix::unistd::{
    Gid, Uid, close, dup2_stdin, getegid, geteuid, getppid, setegid, seteuid, setgid, setgroups,
    setuid, write,
};
use std::fs::{self, File};
use std::io;
use std::os::fd::OwnedFd;
use std::os::unix::fs::MetadataExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

/// The user and the group that own nothing.
const NOBODY: u32 = 65534;
/// Since which kernel processes are counted for each namespace of users.
const COUNTS_APART: (u32, u32) = (5, 14);
/// What this process has open.
const OPEN: &str = "/proc/self/fd";
/// How many namespaces of users there may be at all.
const USERS_MOST: &str = "/proc/sys/user/max_user_namespaces";
const NAMESPACES: [(CloneFlags, Layer); 4] = [
    (CloneFlags::CLONE_NEWPID, Layer::Processes),
    (CloneFlags::CLONE_NEWNS, Layer::Mounts),
    (CloneFlags::CLONE_NEWNET, Layer::Network),
    (CloneFlags::CLONE_NEWIPC, Layer::Messages),
];

/// Starts the program, and gives how it has ended.
pub(super) fn run(mut order: Order) -> Result<u8, Error> {
    let failed = |error: nix::Error| Error::system("sandbox", error);
    close_others().map_err(|error| Error::system(format_args!("sandbox: {OPEN}"), error))?;
    set_pdeathsig(Signal::SIGKILL).map_err(failed)?;
    if getppid().as_raw() != order.parent {
        return Err(Error::system("sandbox", "the judge is gone"));
    }
    if let Some(base) = order.group.take() {
        // The memory of one process is that of all.
        let memory = getrlimit(Resource::RLIMIT_AS).map_err(failed)?.0;
        group::enter(&base, memory)?;
    }
    separate(&mut order);
    // A change of the user clears it.
    set_pdeathsig(Signal::SIGKILL).map_err(failed)?;
    order.step = Step::Inner;
    let mut inner = Command::new(SELF)
        .arg0(NAME)
        .args(order.write())
        .spawn()
        .map_err(|error| Error::system(format_args!("sandbox: {SELF}"), error))?;
    // The way to the judge is the program's alone: when that closes it, it is closed.
    if let Ok(null) = File::open("/dev/null") {
        let _ = dup2_stdin(null);
    }
    let status = inner.wait();
    let status = status.map_err(|error| Error::system("sandbox", error))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    code.ok_or_else(|| Error::system("sandbox", status))
}

/// Closes what this process was left by what started the judge: the program has the three standard ones alone.
fn close_others() -> io::Result<()> {
    let open = fs::read_dir(OPEN)?;
    let numbers: Vec<i32> = open
        .filter_map(|one| one.ok()?.file_name().to_str()?.parse().ok())
        .collect();
    for number in numbers.into_iter().filter(|number| *number > 2) {
        // The one of that folder is closed already.
        let _ = close(number);
    }
    Ok(())
}

/// Leaves what can be left, and keeps what cannot.
fn separate(order: &mut Order) {
    let (uid, gid) = (geteuid(), getegid());
    order
        .without
        .clone()
        .into_iter()
        .for_each(|layer| order.miss(layer));
    let wanted: Vec<_> = NAMESPACES
        .into_iter()
        .filter(|(_, layer)| order.wants(*layer))
        .collect();
    let all = wanted
        .iter()
        .fold(CloneFlags::empty(), |all, one| all | one.0);
    (order.uid, order.gid) = (uid.as_raw(), gid.as_raw());
    let mut is_other = false;
    if uid.is_root() {
        (order.uid, order.gid) = (NOBODY, NOBODY);
        let user = match order.wants(Layer::User) {
            true => reader(order),
            false => None,
        };
        if let Some((uid, gid)) = user {
            (order.uid, order.gid) = (uid, gid);
            order.is_dropping = unshare(all).is_ok();
            if order.is_dropping {
                order.threads = threads(Uid::from_raw(uid), has_users());
                return;
            }
            // The root of a container makes no namespaces, but another user may perhaps have one of users.
            is_other = become_user(uid, gid).is_ok();
        }
        if !is_other {
            order.miss(Layer::User);
        }
    }
    order.is_alone = geteuid().is_root();
    let (uid, gid) = (geteuid(), getegid());
    let user = match order.wants(Layer::User) {
        true => CloneFlags::CLONE_NEWUSER,
        false => CloneFlags::empty(),
    };
    // Afterwards the process has no user number of its own any more.
    order.threads = threads(uid, !user.is_empty());
    let is_whole = unshare(user | all).is_ok();
    order.is_mapped = !user.is_empty() && (is_whole || unshare(user).is_ok());
    if !order.is_mapped && order.threads == 0 {
        order.threads = threads(uid, false);
    }
    if !is_whole {
        for (flag, layer) in wanted {
            if unshare(flag).is_err() {
                order.miss(layer);
            }
        }
    }
    match order.is_mapped {
        true => {
            // Without it the inner step cannot mount, and says that.
            let _ = open_self().and_then(|own| map(&own, (0, uid.as_raw()), (0, gid.as_raw())));
        }
        false if !is_other => order.miss(Layer::User),
        false => {}
    }
}

/// A user that is not root and reads the programs and Python: nobody, or else whose folder it is.
fn reader(order: &Order) -> Option<(u32, u32)> {
    let mut found = None;
    for folder in &order.folders {
        let owner = fs::metadata(folder).ok().map(|it| (it.uid(), it.gid()));
        let owner = owner.filter(|(uid, gid)| *uid != 0 && *gid != 0);
        let mut users = [Some((NOBODY, NOBODY)), owner].into_iter().flatten();
        let user = users.find(|user| can_be(*user, folder, order))?;
        found.get_or_insert(user);
    }
    found
}

/// Whether a user reads a folder, and Python.
fn can_be((uid, gid): (u32, u32), folder: &Path, order: &Order) -> bool {
    let become_it = || {
        setgroups(&[])?;
        setegid(Gid::from_raw(gid))?;
        seteuid(Uid::from_raw(uid))
    };
    let can_read = |path: &Path| match path.is_dir() {
        true => fs::read_dir(path).is_ok(),
        false => File::open(path).is_ok(),
    };
    let interpreter = order.program.first().map(Path::new);
    let can = become_it().is_ok()
        && can_read(folder)
        && interpreter.is_some_and(can_read)
        // The inner step is this program.
        && can_read(Path::new(SELF));
    seteuid(Uid::from_raw(0)).is_ok() && setegid(Gid::from_raw(0)).is_ok() && can
}

/// Becomes another user, for good.
pub(super) fn become_user(uid: u32, gid: u32) -> nix::Result<()> {
    setgroups(&[])?;
    setgid(Gid::from_raw(gid))?;
    setuid(Uid::from_raw(uid))?;
    // Its own files of /proc were root's since then.
    set_dumpable(true)
}

/// Whether a user other than root may make a namespace of users, as far as that is known before.
fn has_users() -> bool {
    fs::read_to_string(USERS_MOST).is_ok_and(|most| most.trim() != "0")
}

/// How many threads of a user there are, where they count against those of the program: not where it has a namespace of
/// users.
fn threads(user: Uid, is_apart: bool) -> u64 {
    if is_apart && is_since(COUNTS_APART) {
        return 0;
    }
    let Ok(processes) = fs::read_dir("/proc") else {
        return 0;
    };
    let statuses = processes
        .flatten()
        .filter_map(|one| fs::read_to_string(one.path().join("status")).ok());
    statuses.filter_map(|text| threads_of(&text, user)).sum()
}

/// How many threads a process has by its `status`, if it is one of a user: the owner of its folder in `/proc` is root for
/// some that count.
fn threads_of(status: &str, user: Uid) -> Option<u64> {
    let value = |key: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(key))?;
        line.split_whitespace().next()?.parse::<u32>().ok()
    };
    (value("Uid:")? == user.as_raw()).then(|| value("Threads:").map(u64::from))?
}

/// Whether the kernel is at least so new.
pub(super) fn is_since(version: (u32, u32)) -> bool {
    uname().ok().is_some_and(|system| {
        let release = system.release().to_string_lossy().into_owned();
        let mut numbers = release.split(['.', '-']).map(str::parse);
        let (major, minor) = (numbers.next(), numbers.next());
        matches!((major, minor), (Some(Ok(major)), Some(Ok(minor))) if (major, minor) >= version)
    })
}

/// The folder of this process in `/proc`, whatever is mounted over that later.
pub(super) fn open_self() -> nix::Result<OwnedFd> {
    let flags = OFlag::O_PATH | OFlag::O_DIRECTORY | OFlag::O_CLOEXEC;
    open("/proc/self", flags, Mode::empty())
}

/// In a new namespace of users: which user and group inside is which outside.
pub(super) fn map(own: &OwnedFd, user: (u32, u32), group: (u32, u32)) -> nix::Result<()> {
    let put = |name: &str, text: &str| {
        let file = openat(own, name, OFlag::O_WRONLY | OFlag::O_CLOEXEC, Mode::empty())?;
        write(&file, text.as_bytes()).map(|_| ())
    };
    put("uid_map", &format!("{} {} 1", user.0, user.1))?;
    // A kernel before 3.19 has no such file and does not ask for it.
    let _ = put("setgroups", "deny");
    put("gid_map", &format!("{} {} 1", group.0, group.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_count_by_the_user_that_a_process_has() {
        let status = "Name:\tUid: 7\nUid:\t7\t0\t0\t0\nGid:\t1\t1\t1\t1\nThreads:\t12\n";
        assert_eq!(threads_of(status, Uid::from_raw(7)), Some(12));
        assert_eq!(threads_of(status, Uid::from_raw(0)), None);
        let (send, wait) = std::sync::mpsc::channel::<()>();
        let own = Uid::current();
        std::thread::scope(|scope| {
            scope.spawn(move || wait.recv());
            let status = fs::read_to_string("/proc/self/status").unwrap();
            let of_this = threads_of(&status, own).unwrap();
            assert!(of_this >= 2, "{of_this}");
            // Others of this process may end meanwhile, but these two do not.
            assert!(threads(own, false) >= 2);
            drop(send);
        });
    }
}
