//! What a read costs over each transport, against a ping-pong over two pipes.
//!
//! Run by `cargo bench -p trikfs --bench null_fs` (with `--features fuser` for both transports), as root. Filesystem
//! and echo are processes of their own; all are pinned to one processor, because a wake-up across processors costs
//! more than everything that is measured here. Each round measures every variant once, the ratio to the pipe is taken
//! inside the round, and the median over the rounds is printed.

use nix::sched::{CpuSet, sched_setaffinity};
use nix::unistd::Pid;
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use std::time::Instant;
use tempfile::TempDir;
use trikfs::mount::{MountOptions, mount, unmount};
use trikfs::transport::null::NullFs;

const ROUNDS: usize = 15;
const READS: usize = 4000;

fn main() -> io::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["echo"] => echo(),
        ["serve", transport, path] => serve(transport, Path::new(path)),
        _ => drive(),
    }
}

/// Gives back four bytes at a time until its input ends, without any buffer of its own.
fn echo() -> io::Result<()> {
    let mut bytes = [0; 4];
    while nix::unistd::read(io::stdin(), &mut bytes)? == 4 {
        nix::unistd::write(io::stdout(), &bytes)?;
    }
    Ok(())
}

/// Serves a null filesystem until it is unmounted. Says so when it is mounted.
fn serve(transport: &str, path: &Path) -> io::Result<()> {
    let device = mount(path, &MountOptions::default()).map_err(io::Error::other)?;
    println!("mounted");
    match transport {
        #[cfg(feature = "fuser")]
        "fuser" => trikfs::transport::fuser::serve(device, Arc::new(NullFs)),
        _ => trikfs::transport::native::serve(device, Arc::new(NullFs)),
    }
}

fn this_program() -> io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    command.stdout(Stdio::piped());
    Ok(command)
}

/// A process that echoes.
struct Pipe {
    child: Child,
    to: Option<ChildStdin>,
    from: ChildStdout,
}

impl Pipe {
    fn new() -> io::Result<Self> {
        let mut child = this_program()?.arg("echo").stdin(Stdio::piped()).spawn()?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let from = from.ok_or(io::ErrorKind::BrokenPipe)?;
        Ok(Self { child, to, from })
    }

    fn ping_pong(&mut self) -> io::Result<()> {
        let to = self.to.as_mut().ok_or(io::ErrorKind::BrokenPipe)?;
        to.write_all(b"ping")?;
        self.from.read_exact(&mut [0; 4])
    }
}

impl Drop for Pipe {
    fn drop(&mut self) {
        self.to = None;
        let _ = self.child.wait();
    }
}

/// A mounted null filesystem in a process of its own.
struct Mounted {
    name: &'static str,
    child: Child,
    path: PathBuf,
    _folder: TempDir,
    file: Option<File>,
    /// Ratio to the pipe and nanoseconds, of each round.
    results: Vec<(f64, u32)>,
}

impl Mounted {
    fn new(name: &'static str) -> io::Result<Self> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().to_owned();
        let mut child = this_program()?.args(["serve", name]).arg(&path).spawn()?;
        let mut said = [0; 8];
        if let Some(output) = child.stdout.as_mut() {
            output.read_exact(&mut said)?;
        }
        let file = Some(File::open(path.join("null"))?);
        Ok(Self {
            name,
            child,
            path,
            _folder: folder,
            file,
            results: Vec::new(),
        })
    }

    fn read(&self) -> io::Result<()> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        file.read_exact_at(&mut [0; 4], 0)
    }
}

impl Drop for Mounted {
    fn drop(&mut self) {
        self.file = None;
        let _ = unmount(&self.path);
        let _ = self.child.wait();
    }
}

/// Median time of one call in nanoseconds.
fn median(mut call: impl FnMut() -> io::Result<()>) -> io::Result<u32> {
    let mut times = Vec::with_capacity(READS);
    for _ in 0..READS {
        let begun = Instant::now();
        call()?;
        times.push(u32::try_from(begun.elapsed().as_nanos()).unwrap_or(u32::MAX));
    }
    times.sort_unstable();
    Ok(times[READS / 2])
}

fn drive() -> io::Result<()> {
    let mut cpus = CpuSet::new();
    cpus.set(0)?;
    sched_setaffinity(Pid::from_raw(0), &cpus)?;
    let mut pipe = Pipe::new()?;
    let mut mounts = vec![Mounted::new("native")?];
    if cfg!(feature = "fuser") {
        mounts.push(Mounted::new("fuser")?);
    }
    let mut pipes = Vec::with_capacity(ROUNDS);
    for _ in 0..ROUNDS {
        let of_pipe = median(|| pipe.ping_pong())?;
        pipes.push(of_pipe);
        for mounted in &mut mounts {
            let of_mount = median(|| mounted.read())?;
            mounted
                .results
                .push((f64::from(of_mount) / f64::from(of_pipe), of_mount));
        }
    }
    pipes.sort_unstable();
    println!("pipe ping-pong     {:>6} ns  1.00", pipes[ROUNDS / 2]);
    for mounted in &mut mounts {
        mounted.results.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (ratio, nanos) = mounted.results[ROUNDS / 2];
        println!("pread over {:<7} {nanos:>6} ns  {ratio:.2}", mounted.name);
    }
    Ok(())
}
