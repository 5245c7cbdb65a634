//! The operations of the filesystem on its tree and its open files.
//!
//! Owns the table of open files and the tree in force. Each operation finds what a number stands for and calls it;
//! what an open file does is in `files/`. Knows no FUSE.

// A file that is forgotten must not be a text in silence.
#![deny(clippy::wildcard_enum_match_arm)]

use crate::admission::{Admission, Place};
use crate::clock;
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::lock;
use crate::files::config::ConfigFile;
use crate::files::control::{PeriodFile, StopFile, TextFile, fault_line, status_lines};
use crate::files::device::DeviceFile;
use crate::files::devices::DevicesFile;
use crate::files::log::LogFile;
use crate::files::owner::OwnerFile;
use crate::files::param::ParamFile;
use crate::files::stages::StagesFile;
use crate::files::value::ValueFile;
use crate::files::{OpenFile, READY};
use crate::limits;
use crate::node::Node;
use crate::reload::Reloader;
use crate::transport::{
    Access, Attr, Caller, DirEntry, Kernel, Opened, Operations, Outcome, PollHandle, RequestId,
    StatFs, Transfer,
};
use crate::tree::{Kind, Tree};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// The tree in force, shared between the operations and the reloader.
pub struct Forest {
    tree: Mutex<Arc<Tree>>,
}

impl Forest {
    /// Starts with this tree.
    pub fn new(tree: Tree) -> Self {
        Self {
            tree: Mutex::new(Arc::new(tree)),
        }
    }

    /// The tree in force.
    pub fn tree(&self) -> Arc<Tree> {
        lock(&self.tree).clone()
    }

    /// Puts another tree in force and returns the one before.
    pub fn replace(&self, tree: Tree) -> Arc<Tree> {
        std::mem::replace(&mut *lock(&self.tree), Arc::new(tree))
    }
}

/// Open files by number.
#[derive(Default)]
pub struct OpenFiles {
    slots: Mutex<Slots>,
}

#[derive(Default)]
struct Slots {
    files: Vec<Option<Held>>,
    free: Vec<usize>,
}

/// An open file and what its user is charged for it.
struct Held {
    file: Arc<dyn OpenFile>,
    _place: Place,
}

impl OpenFiles {
    /// How many there may be is the admission's to say.
    fn add(&self, file: Arc<dyn OpenFile>, place: Place) -> u64 {
        let mut slots = lock(&self.slots);
        let index = slots.free.pop().unwrap_or_else(|| {
            slots.files.push(None);
            slots.files.len() - 1
        });
        slots.files[index] = Some(Held {
            file,
            _place: place,
        });
        index as u64
    }

    fn get(&self, fh: u64) -> Result<Arc<dyn OpenFile>, Error> {
        let slots = lock(&self.slots);
        let file = usize::try_from(fh)
            .ok()
            .and_then(|index| slots.files.get(index)?.as_ref())
            .map(|held| held.file.clone());
        file.ok_or(Error::Stale)
    }

    fn remove(&self, fh: u64) -> Option<Held> {
        let mut slots = lock(&self.slots);
        let index = usize::try_from(fh).ok()?;
        let held = slots.files.get_mut(index)?.take()?;
        slots.free.push(index);
        Some(held)
    }

    /// Every open file, for a reload that retires nodes.
    pub fn all(&self) -> Vec<Arc<dyn OpenFile>> {
        let slots = lock(&self.slots);
        let held = slots.files.iter().flatten();
        held.map(|held| held.file.clone()).collect()
    }
}

/// Makes the content of a text file.
type Text = Box<dyn Fn() -> String + Send + Sync>;

/// The filesystem.
pub struct Fs {
    engine: Arc<Engine>,
    forest: Arc<Forest>,
    files: Arc<OpenFiles>,
    admission: Arc<Admission>,
    refused: Refused,
    reloader: Arc<Reloader>,
}

/// When it was last told that somebody has too much open: once in a while is enough.
#[derive(Default)]
struct Refused(Mutex<Option<Instant>>);

impl Refused {
    fn tell(&self, engine: &Engine, error: &Error) {
        let now = Instant::now();
        let mut last = lock(&self.0);
        let pause = Duration::from_millis(limits::MISTAKE_MS.into());
        if last.is_none_or(|last| now.duration_since(last) >= pause) {
            *last = Some(now);
            // Followers of the log are told inside.
            drop(last);
            engine.log.line(&format!("open: {error}"));
        }
    }
}

impl Fs {
    /// Puts the operations in front of what the reloader keeps in force.
    pub fn new(
        engine: Arc<Engine>,
        forest: Arc<Forest>,
        files: Arc<OpenFiles>,
        admission: Arc<Admission>,
        reloader: Arc<Reloader>,
    ) -> Self {
        Self {
            engine,
            forest,
            files,
            admission,
            refused: Refused::default(),
            reloader,
        }
    }

    fn sizes(&self) -> (u64, u64) {
        (self.reloader.in_force_len(), self.engine.log.end())
    }

    fn open_kind(
        &self,
        kind: &Kind,
        ino: u64,
        flags: i32,
        caller: Caller,
    ) -> Result<(Arc<dyn OpenFile>, Access, bool), Error> {
        let (read, write) = match flags & libc::O_ACCMODE {
            libc::O_RDONLY => (true, false),
            libc::O_WRONLY => (false, true),
            _ => (true, true),
        };
        if let Some(make) = self.text_of(kind) {
            if write {
                return Err(Error::AccessDenied);
            }
            let mut file = TextFile::new(make);
            if matches!(kind, Kind::Status) {
                file = file.long(self.forest.tree().nodes().len() * limits::STATUS_LINE_BYTES);
            }
            return Ok((Arc::new(file), Access::Direct, false));
        }
        match kind {
            Kind::Directory => Err(Error::IsADirectory),
            Kind::Config => {
                let file =
                    ConfigFile::open(&self.engine, &self.reloader, flags & libc::O_TRUNC != 0);
                Ok((Arc::new(file), Access::Direct, write))
            }
            Kind::Log if write => Err(Error::AccessDenied),
            Kind::Log => Ok((LogFile::open(&self.engine), Access::Direct, false)),
            Kind::Stop if read => Err(Error::AccessDenied),
            Kind::Stop => {
                let forest = self.forest.clone();
                let stop = StopFile::new(move || forest.tree().nodes().to_vec());
                Ok((Arc::new(stop), Access::Direct, false))
            }
            Kind::Device(node) => {
                if let Some(file) = DevicesFile::open(node, read, write)? {
                    return Ok((file, Access::Direct, write));
                }
                let (file, access) = DeviceFile::open(node, read, write)?;
                Ok((file, access, write))
            }
            Kind::Value(node, view) => {
                let (file, access) = ValueFile::open(node, *view, ino, read, write)?;
                if access == Access::Cached {
                    self.reloader.note_cached(ino);
                }
                let is_owned = write && node.description.rest.is_some();
                Ok((file, access, is_owned))
            }
            Kind::Owner(node) if !write => {
                let lease = node.driving.lease.clone();
                let file = Arc::new(TextFile::new(move || lease.line()));
                Ok((file, Access::Direct, false))
            }
            Kind::Owner(node) => {
                let file = OwnerFile::open(node, read, caller)?;
                Ok((file, Access::Direct, true))
            }
            Kind::Period(node) => {
                if write && node.sampling.period_ms() == 0 {
                    return Err(Error::AccessDenied);
                }
                Ok((Arc::new(PeriodFile::new(node)), Access::Direct, false))
            }
            Kind::Param(node, name) => {
                Ok((Arc::new(ParamFile::new(node, name)), Access::Direct, false))
            }
            Kind::Stages(_) if write => Err(Error::AccessDenied),
            Kind::Stages(node) => Ok((Arc::new(StagesFile::open(node)?), Access::Direct, false)),
            Kind::Status | Kind::Units(_) | Kind::Format(_) | Kind::Fault(_) | Kind::Stats(_) => {
                Err(Error::Internal("a text without a text".to_owned()))
            }
        }
    }

    /// What a file says that is only a text; None for all others.
    fn text_of(&self, kind: &Kind) -> Option<Text> {
        Some(match kind {
            Kind::Status => {
                let (reloader, forest) = (self.reloader.clone(), self.forest.clone());
                let engine = self.engine.clone();
                Box::new(move || {
                    let lines = status_lines(forest.tree().nodes());
                    format!(
                        "{}\n{}{}{}{lines}",
                        reloader.result_line(),
                        engine.panics.status_lines(),
                        reloader.setup_lines(),
                        engine.samples.status_line()
                    )
                })
            }
            Kind::Units(node) => {
                let node = node.clone();
                Box::new(move || format!("{}\n", node.description.units))
            }
            Kind::Format(node) => {
                let node = node.clone();
                Box::new(move || format!("{}\n", node.format))
            }
            Kind::Fault(node) => {
                let node = node.clone();
                Box::new(move || {
                    node.fault()
                        .map_or_else(String::new, |error| fault_line(&error) + "\n")
                })
            }
            Kind::Stats(node) => {
                let node = node.clone();
                Box::new(move || node.stats.render(clock::realtime_offset_ns()))
            }
            Kind::Directory
            | Kind::Config
            | Kind::Log
            | Kind::Stop
            | Kind::Device(_)
            | Kind::Value(..)
            | Kind::Period(_)
            | Kind::Param(..)
            | Kind::Stages(_)
            | Kind::Owner(_) => return None,
        })
    }

    fn node_of(&self, ino: u64) -> Result<Arc<Node>, Error> {
        let tree = self.forest.tree();
        tree.entry(ino)?
            .kind
            .node()
            .cloned()
            .ok_or(Error::NoAttribute)
    }
}

impl Fs {
    /// The range of a param, as its attribute has it: a side without a limit is `-`.
    fn range_of(&self, ino: u64) -> Option<String> {
        let tree = self.forest.tree();
        let Kind::Param(node, name) = &tree.entry(ino).ok()?.kind else {
            return None;
        };
        let (min, max) = node.description.param_ranges.get(name.as_ref())?;
        let side = |number: f64| match number.abs() == f64::MAX {
            true => "-".to_owned(),
            false => number.to_string(),
        };
        Some(format!("{} {}", side(*min), side(*max)))
    }
}

/// The extended attribute with the time of the newest sample.
const TIME_ATTRIBUTE: &[u8] = b"user.trik.time_ns";
/// That with what brings an actuator to rest.
const REST_ATTRIBUTE: &[u8] = b"user.trik.rest";
/// That with the least and the greatest number that a param takes.
const RANGE_ATTRIBUTE: &[u8] = b"user.trik.range";

impl Operations for Fs {
    fn start(&self, kernel: Arc<dyn Kernel>) {
        self.engine.connect(kernel);
    }

    fn lookup(&self, parent: u64, name: &[u8]) -> Result<Attr, Error> {
        let tree = self.forest.tree();
        tree.attr(tree.lookup(parent, name)?, self.sizes())
    }

    fn getattr(&self, ino: u64) -> Result<Attr, Error> {
        self.forest.tree().attr(ino, self.sizes())
    }

    fn setattr(
        &self,
        ino: u64,
        fh: Option<u64>,
        size: Option<u64>,
        other: bool,
    ) -> Result<Attr, Error> {
        if other {
            return Err(Error::NotPermitted);
        }
        if let (Some(fh), Some(size)) = (fh, size) {
            self.files.get(fh)?.truncate(size)?;
        }
        self.getattr(ino)
    }

    fn readdir(
        &self,
        ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error> {
        self.forest.tree().list(ino, from, add)
    }

    fn open(&self, ino: u64, flags: i32, caller: Caller) -> Result<Opened, Error> {
        let kind = self.forest.tree().entry(ino)?.kind.clone();
        let refused = |error: &Error| self.refused.tell(&self.engine, error);
        let mut place = self.admission.admit(caller.uid).inspect_err(refused)?;
        let (file, access, flush) = self.open_kind(&kind, ino, flags, caller)?;
        if let Err(error) = place.hold(file.held_bytes()).inspect_err(refused) {
            file.release();
            return Err(error);
        }
        Ok(Opened {
            fh: self.files.add(file, place),
            access,
            flush,
        })
    }

    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        let file = self.files.get(request.fh)?;
        if request.paged && !file.is_cached() {
            // What the kernel reads ahead for splice(2) or a mapping would be lost or grow old there.
            let what = "the file cannot be mapped or spliced: use read(2)";
            return Err(Error::Invalid(what.to_owned()));
        }
        file.read(request, out)
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        self.files.get(request.fh)?.write(request, data)
    }

    fn poll(&self, _ino: u64, fh: u64, handle: PollHandle, events: u32) -> Result<u32, Error> {
        match self.files.get(fh) {
            Ok(file) => file.poll(handle, events),
            Err(_) => Ok((events & READY) | libc::POLLERR as u32),
        }
    }

    fn flush(&self, id: RequestId, _ino: u64, fh: u64, caller: Caller) -> Result<Outcome, Error> {
        self.files.get(fh)?.flush(id, caller)
    }

    fn fsync(&self, id: RequestId, _ino: u64, fh: u64, caller: Caller) -> Result<Outcome, Error> {
        self.files.get(fh)?.fsync(id, caller)
    }

    fn release(&self, _ino: u64, fh: u64) {
        if let Some(held) = self.files.remove(fh) {
            held.file.release();
        }
    }

    fn interrupt(&self, id: RequestId) -> bool {
        self.engine.refuse(id, Error::Interrupted)
    }

    fn getxattr(&self, ino: u64, name: &[u8]) -> Result<Vec<u8>, Error> {
        if name == REST_ATTRIBUTE {
            let node = self.node_of(ino)?;
            let rest = node.description.rest.as_ref().ok_or(Error::NoAttribute)?;
            let numbers: Vec<String> = rest.iter().map(f64::to_string).collect();
            return Ok(numbers.join(" ").into_bytes());
        }
        if name == RANGE_ATTRIBUTE {
            let range = self.range_of(ino).ok_or(Error::NoAttribute)?;
            return Ok(range.into_bytes());
        }
        if name != TIME_ATTRIBUTE {
            return Err(Error::NoAttribute);
        }
        let stamp = self
            .node_of(ino)?
            .sampling
            .newest
            .stamp()
            .ok_or(Error::NoAttribute)?;
        Ok(stamp.0.to_string().into_bytes())
    }

    fn listxattr(&self, ino: u64) -> Result<Vec<u8>, Error> {
        let mut names = Vec::new();
        if let Ok(node) = self.node_of(ino) {
            let has_sample = node.sampling.newest.stamp().is_some();
            let has_rest = node.description.rest.is_some();
            for (name, is_there) in [
                (TIME_ATTRIBUTE, has_sample),
                (REST_ATTRIBUTE, has_rest),
                (RANGE_ATTRIBUTE, self.range_of(ino).is_some()),
            ] {
                if is_there {
                    names.extend_from_slice(name);
                    names.push(0);
                }
            }
        }
        Ok(names)
    }

    fn statfs(&self) -> StatFs {
        StatFs {
            files: self.forest.tree().len() as u64,
            name_max: 255,
        }
    }

    fn stop(&self) {
        self.engine.refuse_all(&Error::ShuttingDown);
    }
}
