//! What keeps a solution in Python away from its judge and from the computer: layers of the kernel, put on by this program
//! before it becomes Python.
//!
//! Owns the two hidden steps between a judge and such a program, which run under the name [`NAME`]: `outer` makes
//! namespaces and waits, `inner` is the first process in them, makes files of the computer read-only (`readonly`), gives up
//! rights (`files`, `calls`) and becomes Python.
//! `group` counts a program with all that it starts. `layer` has what may be missing, `words` what is told of it, `order`
//! what the steps are told. Knows nothing of robots and of what is said to a program.

mod calls;
mod files;
mod group;
mod inner;
mod layer;
mod order;
mod outer;
mod readonly;
mod words;

use crate::error::Error;
use crate::limits;
use frame::encode;
pub(crate) use group::{delegated, sweep};
pub(crate) use layer::Layer;
use layer::Missing;
pub(crate) use layer::named;
use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;
use order::{Order, Step};
use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::os::unix::ffi::OsStringExt;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Output, Stdio};
use std::sync::mpsc::sync_channel;
use std::thread;
use std::time::{Duration, Instant};
pub(crate) use words::{lacks, required};

/// The name under which this program is such a step.
pub const NAME: &str = "trik-sandbox";
/// This program, whatever has happened to its file since it was started.
const SELF: &str = "/proc/self/exe";
/// Prints where Python is and the folders that it reads, each followed by a zero.
const WHERE: &str = "import sys; print(*(p for p in [sys.executable, sys.base_prefix, sys.prefix, \
    sys.base_exec_prefix, sys.exec_prefix, *sys.path] if p.startswith('/') and p != '/'), sep='\\0', end='\\0')";

/// What solutions in Python are confined by.
#[derive(Clone, Debug, Default)]
pub struct Sandbox {
    /// The interpreter, and folders that it reads; empty if it has not been asked yet.
    python: Vec<PathBuf>,
    /// Layers that are left out, as if the kernel did not have them.
    without: Vec<Layer>,
    /// Whether a program is only started if no layer is missing.
    is_required: bool,
    /// The control group in which programs get one each.
    group: Option<PathBuf>,
    /// Whether there is none: tests of what a program is told start no other program than Python.
    #[cfg(test)]
    is_open: bool,
}

impl Sandbox {
    /// With the interpreter that was found before, or none.
    pub(crate) fn new(python: &[PathBuf], without: &[Layer], is_required: bool) -> Self {
        Self {
            python: python.to_vec(),
            without: without.to_vec(),
            is_required,
            ..Self::default()
        }
    }

    /// The same, with a control group in which programs get one each.
    #[must_use]
    pub(crate) fn below(mut self, group: Option<&Path>) -> Self {
        self.group = group.map(Path::to_owned);
        self
    }

    /// Ends what is left of a program, by the process that has started it.
    pub(crate) fn leave(&self, process: u32) {
        if let Some(group) = &self.group {
            group::leave(group, process);
        }
    }

    /// None at all.
    #[cfg(test)]
    pub(crate) fn open() -> Self {
        Self {
            is_open: true,
            ..Self::default()
        }
    }

    /// How to start Python with arguments, for a program in a folder that may compute for so long.
    ///
    /// # Errors
    /// There is no Python.
    pub(crate) fn command(
        &self,
        arguments: &[&str],
        folder: &Path,
        longest: Duration,
    ) -> io::Result<Command> {
        #[cfg(test)]
        if self.is_open {
            let mut command = Command::new("python3");
            clear(command.args(arguments));
            return Ok(command);
        }
        let mut order = self.order(folder)?;
        order.group = self.group.clone();
        order.cpu_s = longest.as_secs().saturating_add(limits::SCRIPT_CPU_GRACE_S);
        order
            .program
            .extend(arguments.iter().map(|word| OsString::from(*word)));
        Ok(step(&order))
    }

    /// What is missing here for programs in these folders.
    ///
    /// # Errors
    /// There is no Python, or no process can be started.
    pub(crate) fn missing<'a>(
        &self,
        folders: impl Iterator<Item = &'a Path>,
    ) -> Result<Missing, Error> {
        let failed = |error| Error::system("sandbox", error);
        let mut order = self.order(Path::new("/")).map_err(failed)?;
        order.folders = folders
            .take(limits::SANDBOX_FOLDERS)
            .map(Path::to_owned)
            .collect();
        order.is_probe = true;
        let mut probe = step(&order);
        let output = answer(probe.stderr(Stdio::piped())).map_err(failed)?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            return Err(Error::system("sandbox", said.trim()));
        }
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let (names, place) = said.split_once('\n').unwrap_or_default();
        let place = place.trim_end_matches('\n');
        Ok(Missing {
            layers: names.split_whitespace().filter_map(layer::find).collect(),
            place: (!place.is_empty()).then(|| place.into()),
        })
    }

    fn order(&self, folder: &Path) -> io::Result<Order> {
        let python = match self.python.is_empty() {
            true => python()?,
            false => self.python.clone(),
        };
        let mut python = python.into_iter();
        let program = python.next().ok_or(io::ErrorKind::NotFound)?;
        Ok(Order {
            parent: i32::try_from(std::process::id()).unwrap_or(0),
            folders: vec![folder.to_owned()],
            reads: python.collect(),
            without: self.without.clone(),
            is_required: self.is_required,
            // None at all would end a step at the first look of the kernel's clock.
            cpu_s: limits::SCRIPT_CPU_GRACE_S,
            program: vec![program.into_os_string()],
            ..Order::default()
        })
    }
}

/// A step of this program.
fn step(order: &Order) -> Command {
    let mut command = Command::new(SELF);
    clear(command.arg0(NAME).args(order.write()));
    command
}

/// The environment of a judged program: the same each time.
fn clear(command: &mut Command) {
    let kept = ["PATH", "HOME"].map(|name| (name, std::env::var_os(name)));
    let kept = kept
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)));
    command.env_clear().envs(kept).envs([
        ("PYTHONHASHSEED", "0"),
        ("TZ", "UTC"),
        ("LC_ALL", "C.UTF-8"),
    ]);
}

/// What a process says until its end, which is forced if it does not come; it may be a wrapper that hangs.
fn answer(command: &mut Command) -> io::Result<Output> {
    let until = Instant::now() + Duration::from_millis(limits::PYTHON_ANSWER_MS.into());
    let command = command.stdin(Stdio::null()).stdout(Stdio::piped());
    let name = command.get_program().display().to_string();
    let failed = |error: io::Error| io::Error::new(error.kind(), format!("{name}: {error}"));
    let mut child = command.process_group(0).spawn().map_err(failed)?;
    let (stdout, stderr) = (child.stdout.take(), child.stderr.take());
    let (send, said) = sync_channel(1);
    thread::spawn(move || {
        let most = limits::PYTHON_PATHS_BYTES;
        let (mut out, mut err) = (Vec::new(), Vec::new());
        let read = stdout.map_or(Ok(0), |pipe| pipe.take(most).read_to_end(&mut out));
        let read = read.and(stderr.map_or(Ok(0), |pipe| pipe.take(most).read_to_end(&mut err)));
        // After the time limit nobody receives it.
        let _ = send.send(read.map(|_| (out, err)));
    });
    let left = until.saturating_duration_since(Instant::now());
    if let Ok(said) = said.recv_timeout(left) {
        let (stdout, stderr) = said?;
        while Instant::now() < until {
            if let Some(status) = child.try_wait()? {
                return Ok(Output {
                    status,
                    stdout,
                    stderr,
                });
            }
            thread::sleep(Duration::from_millis(1));
        }
    }
    if let Ok(group) = i32::try_from(child.id()) {
        let _ = killpg(Pid::from_raw(group), Signal::SIGKILL);
    }
    child.wait()?;
    let seconds = limits::PYTHON_ANSWER_MS / 1000;
    let told = format!("{name} does not answer in {seconds} s");
    Err(io::Error::new(io::ErrorKind::TimedOut, told))
}

/// The interpreter that the path has, and after it the folders that it reads.
///
/// # Errors
/// There is none, or it does not answer.
pub(crate) fn python() -> io::Result<Vec<PathBuf>> {
    let mut command = Command::new("python3");
    clear(command.args(["-s", "-B", "-c", WHERE]));
    let said = answer(command.stderr(Stdio::null()))?.stdout;
    let mut paths: Vec<PathBuf> = Vec::new();
    for path in said
        .split(|byte| *byte == 0)
        .filter(|path| path.starts_with(b"/"))
    {
        let path = PathBuf::from(OsString::from_vec(path.to_vec()));
        // What is below a folder that is there already is there too.
        let is_known = paths.iter().skip(1).any(|known| path.starts_with(known));
        if !is_known && paths.len() < limits::PYTHON_PATHS {
            paths.push(path);
        }
    }
    match paths.is_empty() {
        true => Err(io::ErrorKind::NotFound.into()),
        false => Ok(paths),
    }
}

/// One of the steps; comes back only from the outer one, with how the program has ended, or if something went wrong.
pub fn main() -> ExitCode {
    let Some(order) = Order::read(std::env::args_os().skip(1)) else {
        return ExitCode::from(2);
    };
    let is_probe = order.is_probe;
    let ended = match order.step {
        Step::Outer => outer::run(order),
        Step::Inner => inner::run(order),
    };
    let Err(why) = ended else {
        return ended.map_or(ExitCode::FAILURE, ExitCode::from);
    };
    if is_probe {
        let _ = writeln!(io::stderr(), "{why}");
    } else {
        // Standard input is the way to the judge, who takes it for the last words of the program.
        let _ = nix::unistd::write(io::stdin(), &encode(format!("error:{why}").as_bytes()));
    }
    ExitCode::FAILURE
}
