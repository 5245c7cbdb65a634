//! The two processes of the view: one that serves it, and one that keeps the mount and cleans up after it.
//!
//! The keeper mounts, starts the serving process and waits for a signal, an unmount or its end; then it unmounts, so that a
//! kill of the serving process leaves no dead mount. If the keeper is killed, the kernel tells the serving process, which
//! unmounts by itself. A serving process that somebody stops (SIGSTOP) and does not soon continue is killed. While the keeper
//! is stopped nobody would notice that, so the serving process looks at it, brings to rest what it drives, and has it go on. The serving
//! process ends with its files of the tree open: the tree then brings to rest what it drove. So nothing has to be done for the motors here, whatever ends the view.

use crate::cli::SERVE;
use crate::failure::Failure;
use crate::limits;
use crate::limits::GRACE_MS;
use crate::scan::Options;
use crate::tree::Tree;
use crate::view::View;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::prctl::{set_name, set_pdeathsig};
use nix::sys::signal::{SigSet, Signal, kill};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use nix::sys::wait::{Id, WaitPidFlag, WaitStatus, waitid};
use nix::unistd::{Pid, getppid};
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, PipeReader, Read, Write};
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use trikfs::guardian::mounted::Mounted;
use trikfs::mount::{self, MountOptions};
use trikfs::process::is_stopped;
use trikfs::transport::{Operations, native};

/// First column of /proc/mounts.
const SOURCE: &str = "trikfs-ev3dev";
/// What ends the view in order.
const SIGNALS: [Signal; 3] = [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP];

/// What to show where.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The mount point of the tree.
    pub tree: PathBuf,
    /// Of the view; made if nothing is there, and then removed at the end.
    pub mountpoint: PathBuf,
    /// Let other users in.
    pub allow_other: bool,
    /// Arguments for the serving process, without those of [`Handover`] and the mount point.
    pub arguments: Vec<OsString>,
}

/// What the serving process has to know of its keeper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Handover {
    /// Process id.
    pub keeper: u32,
    /// Numbers of the mount.
    pub mount: (u32, u32),
}

/// Mounts, serves, and unmounts at the end. `ready` gets the number of devices.
///
/// Call it while the process has one thread.
///
/// # Errors
/// Why there is no view, or how it ended.
pub fn keep(plan: &Plan, ready: &mut dyn FnMut(usize)) -> Result<(), Failure> {
    // Started through /proc/self/exe it would be listed as `exe`.
    let _ = set_name(c"trikfs-ev3dev");
    let mut mask: SigSet = SIGNALS.into_iter().collect();
    // It comes also when the serving process is stopped.
    mask.add(Signal::SIGCHLD);
    mask.thread_block().map_err(Failure::Signals)?;
    unstoppable().map_err(Failure::Signals)?;
    let signals = SignalFd::with_flags(&mask, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)
        .map_err(Failure::Signals)?;
    let path = &plan.mountpoint;
    // Dropped last, when nothing is mounted there any more.
    let _made =
        MadeDirectory::at(path).map_err(|error| Failure::MountPoint(path.clone(), error))?;
    let options = MountOptions {
        allow_other: plan.allow_other,
        source: SOURCE.to_owned(),
        ..MountOptions::default()
    };
    let device = mount::mount(path, &options).map_err(|error| Failure::Mount(error.to_string()))?;
    let mounted = match Mounted::find(path) {
        Ok(mounted) => mounted,
        Err(error) => {
            drop(device);
            let _ = mount::unmount(path);
            return Err(Failure::Mount(error.to_string()));
        }
    };
    let end = start(plan, &device, &mounted)
        .and_then(|mut server| server.until_end(&signals, &mounted, ready));
    // With the last descriptor every program that waits in the mount is released.
    drop(device);
    unmount(&mounted);
    end.map_err(Failure::Serving)?
}

/// A terminal stops whatever runs in it (Ctrl-Z), and motors would go on: not this.
fn unstoppable() -> nix::Result<()> {
    SigSet::from(Signal::SIGTSTP).thread_block()
}

/// A directory that was not there before. Dropping it removes it, if it is empty.
struct MadeDirectory<'a>(&'a Path);

impl<'a> MadeDirectory<'a> {
    /// None if something is there already.
    fn at(path: &'a Path) -> io::Result<Option<Self>> {
        match path.symlink_metadata() {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                std::fs::create_dir_all(path).map(|()| Some(Self(path)))
            }
            _ => Ok(None),
        }
    }
}

impl Drop for MadeDirectory<'_> {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir(self.0);
    }
}

/// Takes our mount away, if it is still there.
fn unmount(mounted: &Mounted) {
    if mounted.is_there()
        && let Err(error) = mount::unmount(mounted.path())
    {
        complain(&format!("unmounting {}: {error}", mounted.path().display()));
    }
}

/// Starts this program again to serve.
fn start(plan: &Plan, device: &OwnedFd, mounted: &Mounted) -> io::Result<Server> {
    let (said, writer) = io::pipe()?;
    let (id, connection) = mounted.numbers();
    // Through this link it is the same program even if its file has been replaced since.
    let mut command = Command::new("/proc/self/exe");
    command
        .arg0("trikfs-ev3dev")
        .arg(format!("{SERVE}{},{id},{connection}", std::process::id()))
        .args(&plan.arguments)
        .arg("--")
        .arg(mounted.path())
        .stdin(device.try_clone()?)
        .stdout(writer);
    let child = command.spawn()?;
    Ok(Server {
        child,
        said,
        heard: Vec::new(),
        stopped: None,
        was_killed: false,
    })
}

/// The serving process. Dropping it kills it.
struct Server {
    child: Child,
    /// Ends with the process.
    said: PipeReader,
    heard: Vec<u8>,
    /// When it has to go on.
    stopped: Option<Instant>,
    /// It did not.
    was_killed: bool,
}

impl Server {
    /// Notices whether it stands still; one that did for too long is killed, and what it drove comes to rest.
    fn watch_standstill(&mut self) {
        let Ok(pid) = i32::try_from(self.child.id()) else {
            return;
        };
        // Looks only: the stop stays to be seen, and an end is left to `wait`.
        let flags = WaitPidFlag::WSTOPPED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
        let seen = waitid(Id::Pid(Pid::from_raw(pid)), flags);
        if !matches!(seen, Ok(WaitStatus::Stopped(..))) {
            self.stopped = None;
            return;
        }
        let patience = Duration::from_millis(limits::STOPPED_MS);
        let until = *self
            .stopped
            .get_or_insert_with(|| Instant::now() + patience);
        if Instant::now() >= until && !self.was_killed {
            self.was_killed = true;
            self.signal(Signal::SIGKILL);
        }
    }

    /// Waits for the end and brings it about when it is asked for.
    fn until_end(
        &mut self,
        signals: &SignalFd,
        mounted: &Mounted,
        ready: &mut dyn FnMut(usize),
    ) -> io::Result<Result<(), Failure>> {
        // Has an exceptional condition when the list of mounts changes.
        let mounts = File::open("/proc/self/mountinfo")?;
        let mut stopping: Option<Instant> = None;
        loop {
            let mut watched = [
                PollFd::new(signals.as_fd(), PollFlags::POLLIN),
                PollFd::new(mounts.as_fd(), PollFlags::POLLPRI),
                PollFd::new(self.said.as_fd(), PollFlags::POLLIN),
            ];
            let next = stopping.into_iter().chain(self.stopped).min();
            let patience = next.map_or(PollTimeout::NONE, |at| {
                let left = at.saturating_duration_since(Instant::now()) + Duration::from_millis(1);
                left.try_into().unwrap_or(PollTimeout::MAX)
            });
            match poll(&mut watched, patience) {
                Err(Errno::EINTR) => continue,
                result => result?,
            };
            let [signal, changed, word] = watched.map(|fd| fd.any().unwrap_or(true));
            let mut stop = changed && !mounted.is_there();
            if signal {
                while let Some(info) = signals.read_signal()? {
                    stop |= i32::try_from(info.ssi_signo) != Ok(Signal::SIGCHLD as i32);
                }
            }
            self.watch_standstill();
            if stop && stopping.is_none() {
                self.signal(Signal::SIGTERM);
                stopping = Some(Instant::now() + Duration::from_millis(GRACE_MS));
            }
            if stopping.is_some_and(|at| Instant::now() >= at) {
                self.signal(Signal::SIGKILL);
            }
            if word && self.hear(ready)? {
                let (status, asked) = (self.child.wait()?, stopping.is_some());
                if self.was_killed && !asked {
                    return Ok(Err(Failure::Stopped));
                }
                return Ok(judge(status, asked, mounted));
            }
        }
    }

    /// Takes what it says; true at its end.
    fn hear(&mut self, ready: &mut dyn FnMut(usize)) -> io::Result<bool> {
        let mut piece = [0; limits::LINE_BYTES_MAX];
        let size = match self.said.read(&mut piece) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => return Ok(false),
            result => result?,
        };
        self.heard.extend_from_slice(&piece[..size]);
        if let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = self.heard.drain(..=end).collect();
            let line = String::from_utf8_lossy(&line);
            if let Some(Ok(devices)) = line.trim().strip_prefix("ready ").map(str::parse) {
                ready(devices);
            }
        }
        self.heard.truncate(limits::LINE_BYTES_MAX);
        Ok(size == 0)
    }

    fn signal(&self, signal: Signal) {
        // The number is its own until `wait`: a dead child keeps it.
        if let Ok(pid) = i32::try_from(self.child.id()) {
            let _ = kill(Pid::from_raw(pid), signal);
        }
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        if let Ok(None) = self.child.try_wait() {
            self.signal(Signal::SIGKILL);
            let _ = self.child.wait();
        }
    }
}

/// What the end of the serving process means.
fn judge(status: ExitStatus, was_asked: bool, mounted: &Mounted) -> Result<(), Failure> {
    match status.code() {
        _ if was_asked => Ok(()),
        Some(0) => Ok(()),
        Some(_) => Err(Failure::Told),
        // An unmount ends it too, and may be seen later.
        None if !mounted.is_there() => Ok(()),
        None => Err(Failure::Killed(status)),
    }
}

/// Serves the view, as the keeper starts it: the mounted device is the standard input.
///
/// # Errors
/// Why it cannot.
pub fn serve(
    tree: &Path,
    mountpoint: PathBuf,
    options: Options,
    handover: Handover,
) -> Result<(), Failure> {
    let own = |error: Errno| Failure::Serving(error.into());
    // Started through /proc/self/exe it would be listed as `exe`.
    let _ = set_name(c"trikfs-ev3dev");
    set_pdeathsig(Signal::SIGTERM).map_err(own)?;
    let mounted = Mounted::inherited(mountpoint, handover.mount);
    // It may have died before the line above, and then no signal comes.
    if u32::try_from(getppid().as_raw()) != Ok(handover.keeper) {
        unmount(&mounted);
        return Err(Failure::KeeperGone);
    }
    let mask: SigSet = SIGNALS.into_iter().collect();
    mask.thread_block().map_err(own)?;
    unstoppable().map_err(own)?;
    let signals = SignalFd::with_flags(&mask, SfdFlags::SFD_CLOEXEC).map_err(own)?;
    thread::Builder::new()
        .name("signals".to_owned())
        .spawn(move || {
            while matches!(signals.read_signal(), Ok(None) | Err(Errno::EINTR)) {}
            unmount(&mounted);
            // With the files of the tree open: what they drive comes to rest.
            std::process::exit(0);
        })
        .map_err(Failure::Serving)?;
    let device = io::stdin()
        .as_fd()
        .try_clone_to_owned()
        .map_err(Failure::Serving)?;
    let view = Arc::new(View::new(Tree::new(tree.to_owned()), options));
    watch_keeper(handover.keeper, &view).map_err(Failure::Serving)?;
    let devices = view.devices();
    // Nobody may listen any more; the view can be used all the same.
    let mut out = io::stdout();
    let _ = writeln!(out, "ready {devices}").and_then(|()| out.flush());
    // The view outlives its mount: dropped, it would close its files of the tree, and what it drives would go on.
    native::serve(device, Arc::clone(&view) as Arc<dyn Operations>).map_err(Failure::Serving)?;
    std::process::exit(0)
}

/// Looks at the keeper for ever: the kernel tells nobody that a parent was stopped.
fn watch_keeper(keeper: u32, view: &Arc<View>) -> io::Result<()> {
    let view = Arc::clone(view);
    let look = move || {
        loop {
            thread::sleep(Duration::from_millis(limits::KEEPER_LOOK_MS));
            if !is_stopped(keeper) {
                continue;
            }
            let why = format!("the process that keeps the mount ({keeper}) was stopped");
            if let Ok(keeper) = i32::try_from(keeper) {
                // First, because a device may hang. One that has ended is told of by the kernel.
                let _ = kill(Pid::from_raw(keeper), Signal::SIGCONT);
            }
            let rested = match view.rest(&why) {
                true => "motors were brought to rest, and ",
                false => "",
            };
            complain(&format!("{why}: {rested}it was told to go on"));
        }
    };
    let thread = thread::Builder::new().name("oversight".to_owned());
    thread.spawn(look).map(|_| ())
}

fn complain(text: &str) {
    let _ = writeln!(io::stderr(), "trikfs-ev3dev: {text}");
}
