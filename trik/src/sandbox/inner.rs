//! The inner step: the first process in the namespaces. It mounts, takes limits, gives up its rights and becomes Python.
//!
//! Owns the order of these, which matters: what is given up first is missed by what comes later.

use super::layer::Layer;
use super::order::Order;
use super::{calls, files, outer, readonly, words};
use crate::error::Error;
use crate::limits;
use nix::mount::{MsFlags, mount};
use nix::sched::{CloneFlags, unshare};
use nix::sys::prctl::{set_no_new_privs, set_pdeathsig};
use nix::sys::resource::{Resource, getrlimit, rlim_t, setrlimit};
use nix::sys::signal::Signal;
use nix::unistd::{getegid, geteuid, setsid};
use rustix::thread::{
    CapabilitySet, CapabilitySets, remove_capability_from_bounding_set, set_capabilities,
};
use std::fs;
use std::io::Write;
use std::os::fd::OwnedFd;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is mounted over, so that nothing of it is seen.
const SYSTEM: &str = "/sys";
const PROC: &str = "/proc";
const NUMBERS: &str = "/proc/sys/kernel/pid_max";
/// Since which kernel the greatest number of a process is one of each namespace; before, it is the computer's.
const NUMBERS_APART: (u32, u32) = (6, 14);
/// The place of the scratch folder, which Linux has for files in memory.
pub(super) const SCRATCH: &str = "/dev/shm";

/// Becomes the program; comes back if only asked what is missing, or if something went wrong.
pub(super) fn run(mut order: Order) -> Result<u8, Error> {
    let failed = |error: nix::Error| Error::system("sandbox", error);
    // Fails only for who leads a session already, which is what is wanted.
    let _ = setsid();
    let own = outer::open_self().map_err(|error| Error::system("sandbox: /proc/self", error))?;
    let mounted = match order.has(Layer::Mounts) {
        true => mount_own(&order),
        false => Mounted::default(),
    };
    if order.has(Layer::Mounts) && mounted.lack.is_some() {
        order.miss(Layer::Mounts);
    }
    if order.is_dropping {
        outer::become_user(order.uid, order.gid).map_err(failed)?;
    }
    shed(&own, &mut order);
    // A namespace of users keeps the number of processes that its maker may have as one for all such namespaces of that
    // user together (Linux 5.14): taken before, all programs would share it.
    take_limits(&order).map_err(failed)?;
    drop_rights();
    set_no_new_privs().map_err(failed)?;
    // After the last change of the user, which clears it.
    set_pdeathsig(Signal::SIGKILL).map_err(failed)?;
    if order.wants(Layer::Files) && !files::confine(&order, &mounted) {
        order.miss(Layer::Files);
    }
    if order.wants(Layer::Calls) && !calls::confine(order.is_alone && !mounted.is_counted) {
        order.miss(Layer::Calls);
    }
    if order.is_probe {
        let names: Vec<_> = order.missing.iter().map(|layer| layer.name()).collect();
        let place = mounted.lack.unwrap_or_default();
        let told = writeln!(
            std::io::stdout(),
            "{}\n{}",
            names.join(" "),
            place.display()
        );
        return told
            .map(|()| 0)
            .map_err(|error| Error::system("sandbox", error));
    }
    if order.is_required && !order.missing.is_empty() {
        return Err(Error::Refused(words::refused(&order.missing)));
    }
    let mut program = order.program.iter();
    let interpreter = program.next().map_or("python3".as_ref(), |word| &**word);
    let mut command = Command::new(interpreter);
    let error = command.args(program).env("TMPDIR", SCRATCH).exec();
    let what = format!("{} cannot be started", Path::new(interpreter).display());
    Err(Error::system(what, error))
}

/// What of this process stands over the files of the computer.
#[derive(Clone, Debug, Default)]
pub(super) struct Mounted {
    /// The first place that is not as it should be.
    lack: Option<PathBuf>,
    /// A `/proc` that shows no other process.
    pub has_proc: bool,
    /// The namespace has no numbers for more processes than a program may have.
    is_counted: bool,
    /// A scratch folder.
    pub has_scratch: bool,
}

fn mount_own(order: &Order) -> Mounted {
    let none: Option<&str> = None;
    let private = mount(none, "/", none, MsFlags::MS_REC | MsFlags::MS_PRIVATE, none);
    if private.is_err() {
        return Mounted {
            lack: Some("/".into()),
            ..Mounted::default()
        };
    }
    // All that is seen of it later is what is put over it; and by its files this process tells the kernel which user it is.
    let still_open = readonly::shut(Path::new(PROC), order.is_dropping).err();
    let plain = MsFlags::MS_NOSUID | MsFlags::MS_NODEV | MsFlags::MS_NOEXEC;
    let shut = plain | MsFlags::MS_RDONLY;
    let put = |kind: &str, place: &str, flags, data: &str| {
        mount(Some(kind), place, Some(kind), flags, Some(data)).is_ok()
    };
    let is_counted = order.is_alone
        && outer::is_since(NUMBERS_APART)
        && order.has(Layer::Processes)
        && put("proc", PROC, plain, "")
        && fs::write(NUMBERS, limits::SCRIPT_PID_MAX.to_string()).is_ok();
    // With nothing but processes since Linux 5.8; a container may allow neither, and then nothing of it is seen.
    let has_proc = order.has(Layer::Processes)
        && (put("proc", PROC, shut, "subset=pid") || put("proc", PROC, shut, ""));
    let has_proc = has_proc || put("tmpfs", PROC, shut, "size=4k,mode=755");
    let is_shut = !Path::new(SYSTEM).is_dir() || put("tmpfs", SYSTEM, shut, "size=4k,mode=755");
    // A program that stands there itself has to stay visible.
    let is_taken = order
        .folders
        .iter()
        .any(|folder| folder.starts_with(SCRATCH));
    let (mib, files) = (limits::SCRIPT_SCRATCH_MIB, limits::SCRIPT_SCRATCH_FILES);
    let room = format!("size={mib}m,nr_inodes={files},mode=1777");
    let has_scratch =
        !is_taken && Path::new(SCRATCH).is_dir() && put("tmpfs", SCRATCH, plain, &room);
    let places = [(has_proc, PROC), (is_shut, SYSTEM), (has_scratch, SCRATCH)];
    let lack = places.into_iter().find(|(is_right, _)| !is_right);
    Mounted {
        lack: lack.map(|(_, place)| place.into()).or(still_open),
        has_proc,
        is_counted,
        has_scratch,
    }
}

/// What the program may use of the computer.
fn take_limits(order: &Order) -> nix::Result<()> {
    let processes = order.threads.saturating_add(limits::SCRIPT_PROCESSES);
    for (resource, most) in [
        (Resource::RLIMIT_NPROC, processes),
        (Resource::RLIMIT_CPU, order.cpu_s),
        (Resource::RLIMIT_FSIZE, limits::SCRIPT_FILE_BYTES),
        (Resource::RLIMIT_NOFILE, limits::SCRIPT_OPEN_FILES),
        (Resource::RLIMIT_CORE, 0),
    ] {
        let most = rlim_t::try_from(most).unwrap_or(rlim_t::MAX);
        let most = most.min(getrlimit(resource)?.1);
        setrlimit(resource, most, most)?;
    }
    Ok(())
}

/// Gives up every right of root, also for programs that this process becomes: where it could not become another user, for
/// example in a container that has no other, that is what is left of root.
fn drop_rights() {
    for bit in 0..u64::BITS {
        // A process without rights may not drop any, and no kernel knows all of them.
        let _ = remove_capability_from_bounding_set(CapabilitySet::from_bits_retain(1 << bit));
    }
    let none = CapabilitySet::empty();
    // Fewer rights than before are never refused.
    let _ = set_capabilities(
        None,
        CapabilitySets {
            effective: none,
            permitted: none,
            inheritable: none,
        },
    );
}

/// Gives up what this process may do in its namespaces: in one of users below theirs a program that is not root has no
/// rights at all, and its processes are counted by themselves.
fn shed(own: &OwnedFd, order: &mut Order) {
    if !order.wants(Layer::User) {
        return;
    }
    let (uid, gid) = (geteuid().as_raw(), getegid().as_raw());
    let shed = unshare(CloneFlags::CLONE_NEWUSER)
        .and_then(|()| outer::map(own, (order.uid, uid), (order.gid, gid)));
    if shed.is_err() && order.is_mapped {
        order.miss(Layer::User);
    }
}
