//! What runs in the process of an isolated converter: gives up its rights, loads libraries, and converts what it is told to.
//!
//! Owns the states of all open files of one node. It has no descriptors once its libraries are loaded, and ends when the daemon
//! ends it or dies.

use super::blame_number;
use super::calls::{Stage, confine};
use super::memory::Shared;
use super::process::room;
use super::words::{Answer, Begun, Closed, Load, Loaded, Many, One, Opened, Request, Sealed};
use crate::convert::shared::{Library, LibraryError, NativeStage, OpenInfo};
use crate::events::lock;
use crate::failure::Failure;
use crate::limits::{
    ISOLATED_DATA_MIB, ISOLATED_LIBRARY_BYTES, ISOLATED_LOG_BYTES, ISOLATED_LOG_LINES,
    ISOLATED_ORPHAN_LOOK,
};
use converter::{Conversion, Direction};
use nix::sys::prctl::set_pdeathsig;
use nix::sys::resource::{Resource, setrlimit};
use nix::sys::signal::Signal;
use nix::unistd::{SysconfVar, dup2_stderr, dup2_stdin, dup2_stdout, getppid, sysconf};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::{AsFd, RawFd};
use std::path::Path;
use std::sync::{Arc, Mutex};

/// The process; `daemon` is the process that has started it. Returns if what it is told makes no sense.
///
/// # Errors
/// It was not started by a daemon.
pub fn run(daemon: i32) -> Result<(), Failure> {
    let fail = |error: io::Error| Failure::system("not started by trikfs", error);
    set_pdeathsig(Signal::SIGKILL).map_err(|error| fail(error.into()))?;
    // It may have died before that.
    if getppid().as_raw() != daemon {
        return Err(fail(io::ErrorKind::NotConnected.into()));
    }
    let shared = inherit().map_err(fail)?;
    limit().map_err(fail)?;
    let mut inner = Inner {
        shared,
        is_confined: confine(Stage::Loading),
        libraries: Vec::new(),
        stages: Vec::new(),
        made: Vec::new(),
    };
    let mut room = room();
    let mut reply = Vec::new();
    loop {
        // The kernel ends it with the daemon. Where no filter holds it, a library may have undone that.
        let patience = (!inner.is_confined).then_some(ISOLATED_ORPHAN_LOOK);
        let is_over = || getppid().as_raw() != daemon;
        let message = inner.shared.next(&mut room, patience, is_over);
        let Some(request) = message.and_then(Request::read) else {
            return Err(fail(io::ErrorKind::InvalidData.into()));
        };
        reply.clear();
        inner.answer(request, &mut reply);
        inner.shared.reply(&reply);
    }
}

/// Maps the memory, which is standard input, and closes everything.
fn inherit() -> io::Result<Shared> {
    let shared = Shared::of(&File::from(io::stdin().as_fd().try_clone_to_owned()?))?;
    let nothing = OpenOptions::new()
        .read(true)
        .write(true)
        .open("/dev/null")?;
    dup2_stdin(&nothing)?;
    dup2_stdout(&nothing)?;
    dup2_stderr(&nothing)?;
    drop(nothing);
    close_from(3)?;
    Ok(shared)
}

/// Closes this descriptor and all after it: what a thread of the daemon had open at the moment of the start and did not mark,
/// and what constructors have opened.
fn close_from(first: RawFd) -> io::Result<()> {
    let open: Vec<RawFd> = std::fs::read_dir("/proc/self/fd")?
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .collect();
    for number in open.into_iter().filter(|number| *number >= first) {
        // One of them was that of the folder.
        let _ = nix::unistd::close(number);
    }
    Ok(())
}

fn limit() -> io::Result<()> {
    // Shared memory and stacks that grow are no data, but they have addresses.
    let pages = std::fs::read_to_string("/proc/self/statm")?;
    let pages = pages
        .split(' ')
        .next()
        .and_then(|pages| pages.parse::<libc::rlim_t>().ok());
    let page = sysconf(SysconfVar::PAGE_SIZE).ok().flatten();
    let page = page.and_then(|page| libc::rlim_t::try_from(page).ok());
    let now = pages
        .unwrap_or(0)
        .saturating_mul(page.unwrap_or(PAGE_BYTES));
    let data = libc::rlim_t::from(ISOLATED_DATA_MIB) << 20;
    let addresses = now
        .saturating_add(data)
        .saturating_add(ISOLATED_LIBRARY_BYTES);
    for (what, most) in [
        (Resource::RLIMIT_AS, addresses),
        (Resource::RLIMIT_DATA, data),
        (Resource::RLIMIT_FSIZE, 0),
        (Resource::RLIMIT_CORE, 0),
    ] {
        setrlimit(what, most, most)?;
    }
    // If memory is short, this one goes before the daemon. A kernel without that file has another order.
    let _ = std::fs::write("/proc/self/oom_score_adj", "900");
    Ok(())
}

struct Inner {
    shared: Shared,
    is_confined: bool,
    libraries: Vec<Library>,
    /// By their numbers; a closed one leaves its place to the next.
    stages: Vec<Option<NativeStage>>,
    /// The newest tuple.
    made: Vec<u8>,
}

/// Of memory, where the system does not say it.
const PAGE_BYTES: libc::rlim_t = 4096;
/// An answer to what the daemon never asks.
const UNKNOWN: &str = "there is no such converter here";

impl Inner {
    fn answer(&mut self, request: Request<'_>, out: &mut Vec<u8>) {
        match request {
            Request::Begin => Begun.write(out),
            Request::Load(load) => self.load(&load).write(out),
            Request::Seal => self.seal().write(out),
            Request::Open {
                library,
                direction,
                input_size,
                output_size,
                node,
                params,
            } => {
                let sizes = [input_size, output_size];
                self.open(library, direction, sizes, &node, &params)
                    .write(out);
            }
            Request::Close { instance } => {
                if let Some(stage) = self.stages.get_mut(instance as usize) {
                    *stage = None;
                }
                Closed.write(out);
            }
            Request::One { instance, tuple } => self.one(instance, tuple).write(out),
            Request::Many {
                instance,
                input_bytes,
                output_bytes,
            } => {
                let many = self.many(instance, input_bytes as usize, output_bytes as usize);
                many.write(out);
            }
        }
    }

    fn seal(&mut self) -> Sealed {
        // The first three as well: a constructor may have others under their numbers.
        let is_closed = close_from(0).is_ok();
        let is_sealed = confine(Stage::Sealed) && is_closed;
        Sealed {
            is_confined: self.is_confined && is_sealed,
            // What the kernel could do before, a library has undone.
            is_resisted: self.is_confined && !is_sealed,
        }
    }

    fn load(&mut self, load: &Load) -> Loaded {
        let file = Path::new(&load.file);
        match Library::load_copy(file, &load.shown, &load.short, load.name.as_deref()) {
            Ok(library) => {
                self.libraries.push(library);
                Loaded::Done
            }
            Err(error) => Loaded::Refused {
                blame: blame_number(error.blame()),
                why: match error {
                    LibraryError::Library { why, .. } => why.to_string(),
                    LibraryError::Cache(error) => error.to_string(),
                },
            },
        }
    }

    fn open(
        &mut self,
        library: u32,
        direction: Direction,
        sizes: [u32; 2],
        node: &str,
        params: &BTreeMap<String, f64>,
    ) -> Opened {
        let Some(library) = self.libraries.get(library as usize) else {
            return Opened::Fault(UNKNOWN.to_owned());
        };
        let log = Arc::new(Mutex::new(Vec::<String>::new()));
        let heard = Arc::clone(&log);
        let info = OpenInfo {
            direction,
            input_size: sizes[0] as usize,
            output_size: sizes[1] as usize,
            node,
            params,
            log: Arc::new(move |line| {
                let mut lines = lock(&heard);
                let bytes: usize = lines.iter().map(String::len).sum();
                if lines.len() < ISOLATED_LOG_LINES && bytes + line.len() < ISOLATED_LOG_BYTES {
                    lines.push(line.to_owned());
                }
            }),
        };
        match library.open(&info) {
            Ok(stage) => {
                let free = self.stages.iter().position(Option::is_none);
                let at = free.unwrap_or(self.stages.len());
                if at == self.stages.len() {
                    self.stages.push(None);
                }
                self.stages[at] = Some(stage);
                let log = std::mem::take(&mut *lock(&log));
                Opened::Done {
                    instance: u32::try_from(at).unwrap_or(u32::MAX),
                    log,
                }
            }
            Err(fault) => Opened::Fault(fault.to_string()),
        }
    }

    fn one(&mut self, instance: u32, tuple: &[u8]) -> One<'_> {
        let Some(Some(stage)) = self.stages.get_mut(instance as usize) else {
            return One::Fault(UNKNOWN.to_owned());
        };
        self.made.resize(stage.output_size(), 0);
        match stage.convert(tuple, &mut self.made) {
            Ok(Conversion::Produced) => One::Produced(&self.made),
            Ok(Conversion::Consumed) => One::Consumed,
            Err(fault) => One::Fault(fault.to_string()),
        }
    }

    fn many(&mut self, instance: u32, input_bytes: usize, output_bytes: usize) -> Many {
        let unknown = || Many {
            taken: 0,
            made: 0,
            fault: Some(UNKNOWN.to_owned()),
        };
        let Some(Some(stage)) = self.stages.get_mut(instance as usize) else {
            return unknown();
        };
        let Some((input, output, mut progress)) = self.shared.batch(input_bytes, output_bytes)
        else {
            return unknown();
        };
        let (taken, made, fault) =
            stage.convert_watched(input, output, |is_made| progress.done(is_made));
        let word = |number| u32::try_from(number).unwrap_or(u32::MAX);
        Many {
            taken: word(taken),
            made: word(made),
            fault: fault.map(|fault| fault.to_string()),
        }
    }
}
