//! What is compared with, and the mounts: processes of this same program in other roles, and the shipped binary.

use nix::sched::{CpuSet, sched_getaffinity, sched_setaffinity};
use nix::unistd::Pid;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use tempfile::TempDir;
use trikfs::mount::MountError;
use trikfs::transport::null::NullFs;

/// Puts this process and all that it starts on the last processor it may use.
pub fn pin_to_one_core() {
    let Ok(allowed) = sched_getaffinity(Pid::from_raw(0)) else {
        return;
    };
    let last = (0..CpuSet::count())
        .rev()
        .find(|&cpu| allowed.is_set(cpu).unwrap_or(false));
    let mut one = CpuSet::new();
    if let Some(cpu) = last
        && one.set(cpu).is_ok()
        && let Err(errno) = sched_setaffinity(Pid::from_raw(0), &one)
    {
        println!("not pinned to one core: {errno}");
    }
}

/// Puts this process on the first processor, where [`pin_to_one_core`] has put nothing if there are two.
pub fn pin_to_other_core() {
    let mut first = CpuSet::new();
    if let Err(errno) = first
        .set(0)
        .and_then(|()| sched_setaffinity(Pid::from_raw(0), &first))
    {
        eprintln!("not pinned to another core: {errno}");
    }
}

/// Does something with this process, and what it starts meanwhile, on all processors there are.
pub fn on_all_cores<R>(act: impl FnOnce() -> R) -> R {
    let mut all = CpuSet::new();
    // The kernel leaves out those that are not there.
    for cpu in 0..CpuSet::count() {
        let _ = all.set(cpu);
    }
    let before = sched_getaffinity(Pid::from_raw(0));
    let _ = sched_setaffinity(Pid::from_raw(0), &all);
    let result = act();
    if let Ok(before) = before {
        let _ = sched_setaffinity(Pid::from_raw(0), &before);
    }
    result
}

/// Another process of this program.
pub struct Peer {
    child: Child,
    pub to: ChildStdin,
    pub from: ChildStdout,
}

impl Peer {
    pub fn start(role: &str, words: &[&str]) -> Result<Self, String> {
        let program = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = Command::new(program);
        command
            .arg(format!("role={role}"))
            .args(words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped());
        let mut child = command.spawn().map_err(|error| error.to_string())?;
        let (Some(to), Some(from)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("no pipes".to_owned());
        };
        Ok(Self { child, to, from })
    }

    /// Sends and waits for the echo: one ping-pong.
    pub fn ping(&mut self, bytes: &mut [u8]) {
        self.to.write_all(bytes).expect("the peer is gone");
        self.from.read_exact(bytes).expect("the peer is gone");
    }
}

impl Drop for Peer {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The other roles of this program.
pub fn play(role: &str, words: &[String]) {
    match (role, words) {
        ("echo", [size]) => echo(size.parse().unwrap_or(4)),
        ("null", [mountpoint]) => null(Path::new(mountpoint)),
        ("relay", [from, to]) => super::events::relay(Path::new(from), Path::new(to)),
        ("i2c", [path, delay_ms]) => {
            super::bus_peer::serve(Path::new(path), delay_ms.parse().unwrap_or(0));
        }
        ("reader", [way, mountpoint, node]) => {
            super::samples::subscribe(way, Path::new(mountpoint), node);
        }
        ("reader", [mode, file]) => super::events::read_events(Path::new(file), mode == "epoll"),
        _ => eprintln!("no such role: {role}"),
    }
}

/// Sends back what comes in: the other end of a pipe ping-pong, and a relay between two pipes.
fn echo(size: usize) {
    let (mut from, mut to) = (std::io::stdin().lock(), std::io::stdout().lock());
    let mut bytes = vec![0; size];
    while from.read_exact(&mut bytes).is_ok() && to.write_all(&bytes).is_ok() && to.flush().is_ok()
    {
    }
}

/// Serves the filesystem that does nothing.
fn null(mountpoint: &Path) {
    let options = trikfs::mount::MountOptions::default();
    let device =
        trikfs::mount::mount(mountpoint, &options).expect("the null filesystem cannot be mounted");
    println!("ready");
    if let Err(error) = trikfs::transport::native::serve(device, Arc::new(NullFs)) {
        eprintln!("null filesystem: {error}");
    }
}

/// A fresh directory that is unmounted and removed at the end.
pub struct Place(pub PathBuf, TempDir);

impl Place {
    pub fn new(name: &str) -> Result<Self, String> {
        let folder = tempfile::Builder::new()
            .prefix(&format!("trikfs-bench-{name}-"))
            .tempdir();
        let folder = folder.map_err(|error| error.to_string())?;
        Ok(Self(folder.path().to_owned(), folder))
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let unmounted = trikfs::mount::unmount(&self.0);
        let is_bare = matches!(unmounted, Ok(_) | Err(MountError::NotMounted(_)));
        // What is still mounted is not emptied.
        self.1.disable_cleanup(!is_bare);
    }
}

/// The null filesystem, mounted.
pub struct NullMount {
    pub place: Place,
    _peer: Peer,
}

impl NullMount {
    pub fn start() -> Result<Self, String> {
        let place = Place::new("null")?;
        let mut peer = Peer::start("null", &[&place.0.display().to_string()])?;
        let mut line = [0; 6];
        peer.from
            .read_exact(&mut line)
            .map_err(|error| format!("the null filesystem did not start: {error}"))?;
        Ok(Self { place, _peer: peer })
    }
}

/// trikfs as it ships, with a configuration.
pub struct Mount {
    pub place: Place,
    child: Child,
}

impl Mount {
    pub fn start(name: &str, config: &str) -> Result<Self, String> {
        let place = Place::new(name)?;
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let file = folder.path().join("config.lua");
        std::fs::write(&file, config).map_err(|error| error.to_string())?;
        let mut command = Command::new(env!("CARGO_BIN_EXE_trikfs"));
        command
            .arg("mount")
            .arg("--config")
            .arg(&file)
            .args(extra_words())
            .arg(&place.0)
            .stdout(Stdio::piped());
        let mut child = command.spawn().map_err(|error| error.to_string())?;
        let Some(out) = child.stdout.take() else {
            return Err("no pipe".to_owned());
        };
        let mut line = String::new();
        BufReader::new(out)
            .read_line(&mut line)
            .map_err(|error| error.to_string())?;
        if !line.contains("ready") {
            let _ = child.wait();
            return Err(format!("trikfs did not start: {line}"));
        }
        Ok(Self { place, child })
    }

    pub fn file(&self, name: &str) -> PathBuf {
        self.place.0.join(name)
    }

    pub fn open(&self, name: &str) -> Result<File, String> {
        File::open(self.file(name)).map_err(|error| format!("{name}: {error}"))
    }

    /// Process id of the daemon, the guardian's child.
    pub fn daemon(&self) -> Result<u32, String> {
        let path = format!("/proc/{0}/task/{0}/children", self.child.id());
        let children = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
        children
            .split_whitespace()
            .next()
            .and_then(|pid| pid.parse().ok())
            .ok_or_else(|| "the daemon is not there".to_owned())
    }
}

/// `TRIK_TRANSPORT=fuser` measures the other transport.
fn extra_words() -> Vec<String> {
    std::env::var("TRIK_TRANSPORT")
        .map_or_else(|_| Vec::new(), |name| vec!["--transport".to_owned(), name])
}

impl Drop for Mount {
    fn drop(&mut self) {
        let pid = Pid::from_raw(self.child.id().cast_signed());
        let _ = nix::sys::signal::kill(pid, nix::sys::signal::Signal::SIGTERM);
        let _ = self.child.wait();
    }
}

/// Resident memory of a process in KiB.
pub fn resident_kib(pid: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|text| text.split_whitespace().next()?.parse().ok())
        .unwrap_or(0)
}

/// One file of tmpfs, for comparison.
pub fn tmpfs_file(size: usize) -> Result<File, String> {
    let path = format!("/dev/shm/trikfs-bench-{}", std::process::id());
    std::fs::write(&path, vec![1; size]).map_err(|error| error.to_string())?;
    let file = File::open(&path).map_err(|error| error.to_string());
    let _ = std::fs::remove_file(&path);
    file
}
