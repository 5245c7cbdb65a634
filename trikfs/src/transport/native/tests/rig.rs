//! A filesystem made for the tests of the transports, and its mount.

use crate::errno::Error;
use crate::guardian::mounted::Mounted;
use crate::mount::{MountOptions, mount, unmount};
use crate::transport::null::NullFs;
use crate::transport::{
    Access, Answer, Attr, Caller, DirEntry, FileKind, Kernel, Opened, Operations, Outcome,
    PollHandle, RequestId, StatFs, Transfer,
};
use std::collections::{HashMap, VecDeque};
use std::io;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, UNIX_EPOCH};
use tempfile::TempDir;

/// How a transport serves.
pub(crate) type Serve = fn(OwnedFd, Arc<dyn Operations>) -> io::Result<()>;

/// Longest wait for anything in these tests.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// Waits until something has come true.
pub(crate) fn eventually(what: &str, condition: impl Fn() -> bool) {
    let deadline = Instant::now() + PATIENCE;
    while !condition() {
        assert!(Instant::now() < deadline, "never: {what}");
        std::thread::yield_now();
    }
}

/// The files, in the order of their node ids from 2 on.
const NAMES: [&str; 7] = [
    "null", "stream", "cached", "gate", "config", "panic", "slow",
];
pub(crate) const CACHED: u64 = 4;
const STREAM: u64 = 3;
const GATE: u64 = 5;
const CONFIG: u64 = 6;
const PANIC: u64 = 7;
/// Opening it passes the gate too.
const SLOW: u64 = 8;

/// A filesystem whose files each show one thing that a transport must do.
#[derive(Default)]
pub(crate) struct TestFs {
    kernel: Mutex<Option<Arc<dyn Kernel>>>,
    state: Mutex<State>,
    gate: Condvar,
    pub(crate) reads: AtomicU32,
    pub(crate) flushes: AtomicU32,
    pub(crate) stopped: AtomicU32,
}

#[derive(Default)]
pub(crate) struct State {
    /// Bytes of `stream`.
    queue: VecDeque<u8>,
    parked: HashMap<RequestId, usize>,
    poller: Option<PollHandle>,
    /// The gate is open.
    open: bool,
    /// Operations that wait at the gate.
    pub(crate) at_gate: u32,
    pub(crate) released: Vec<u64>,
    pub(crate) interrupted: u32,
    /// Lengths of the writes to `config`, its size as set, and the flags it was opened with.
    pub(crate) lengths: Vec<usize>,
    pub(crate) truncated: u32,
    pub(crate) open_flags: i32,
    bad: bool,
}

impl TestFs {
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap()
    }

    /// The way to the kernel, once the mount is live.
    pub(crate) fn kernel(&self) -> Arc<dyn Kernel> {
        eventually("the filesystem is started", || {
            self.kernel.lock().unwrap().is_some()
        });
        self.kernel.lock().unwrap().clone().unwrap()
    }

    /// Lets the connection go.
    pub(crate) fn forget_kernel(&self) {
        *self.kernel.lock().unwrap() = None;
    }

    pub(crate) fn parked(&self) -> usize {
        self.state().parked.len()
    }

    pub(crate) fn open_gate(&self) {
        self.state().open = true;
        self.gate.notify_all();
    }

    fn pass_gate(&self) {
        let mut state = self.state();
        state.at_gate += 1;
        while !state.open {
            state = self.gate.wait(state).unwrap();
        }
        state.at_gate -= 1;
    }

    /// Ends all requests that wait, so that the end of a failed test does not hang.
    fn let_go(&self) {
        self.open_gate();
        let Some(kernel) = self.kernel.lock().unwrap().clone() else {
            return;
        };
        for (id, _) in self.state().parked.drain() {
            kernel.answer(id, Err(Error::ShuttingDown));
        }
    }

    /// Appends to `stream` and serves the reads that wait for it.
    pub(crate) fn feed(&self, data: &[u8]) {
        let mut state = self.state();
        state.queue.extend(data);
        let mut answers = Vec::new();
        while !state.queue.is_empty() {
            let Some(id) = state.parked.keys().min().copied() else {
                break;
            };
            let room = state.parked.remove(&id).unwrap();
            let count = room.min(state.queue.len());
            answers.push((id, state.queue.drain(..count).collect::<Vec<u8>>()));
        }
        let poller = state.poller;
        drop(state);
        for (id, data) in answers {
            self.kernel().answer(id, Ok(Answer::Data(&data)));
        }
        if let Some(poller) = poller {
            self.kernel().notify_poll(poller);
        }
    }
}

impl Operations for TestFs {
    fn start(&self, kernel: Arc<dyn Kernel>) {
        let before = self.kernel.lock().unwrap().replace(kernel);
        assert!(before.is_none());
    }

    fn lookup(&self, _parent: u64, name: &[u8]) -> Result<Attr, Error> {
        let at = NAMES
            .iter()
            .position(|known| known.as_bytes() == name)
            .ok_or(Error::NotFound)?;
        self.getattr(at as u64 + 2)
    }

    fn getattr(&self, ino: u64) -> Result<Attr, Error> {
        Ok(Attr {
            ino,
            kind: if ino == 1 {
                FileKind::Directory
            } else {
                FileKind::File
            },
            size: if ino == 1 { 0 } else { 4 },
            mode: if ino == 1 { 0o755 } else { 0o644 },
            uid: 0,
            gid: 0,
            modified: UNIX_EPOCH + Duration::new(5, 6),
            attr_ttl: Duration::from_secs(3600),
            entry_ttl: Duration::from_secs(3600),
        })
    }

    fn setattr(
        &self,
        ino: u64,
        _fh: Option<u64>,
        size: Option<u64>,
        other: bool,
    ) -> Result<Attr, Error> {
        if other {
            return Err(Error::NotPermitted);
        }
        if size == Some(0) {
            self.state().truncated += 1;
        }
        self.getattr(ino)
    }

    fn readdir(
        &self,
        _ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error> {
        for (name, next) in NAMES.into_iter().zip(1..) {
            let entry = DirEntry {
                ino: next + 1,
                kind: FileKind::File,
                name,
                next,
            };
            if next > from && !add(entry) {
                break;
            }
        }
        Ok(())
    }

    fn open(&self, ino: u64, flags: i32, _caller: Caller) -> Result<Opened, Error> {
        if ino == SLOW {
            self.pass_gate();
        }
        if ino == CONFIG {
            self.state().open_flags = flags;
        }
        Ok(Opened {
            fh: ino * 10,
            access: match ino {
                STREAM => Access::Stream,
                CACHED => Access::Cached,
                _ => Access::Direct,
            },
            flush: ino == CONFIG,
        })
    }

    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        assert_eq!(request.fh, request.ino * 10);
        self.reads.fetch_add(1, Ordering::SeqCst);
        match request.ino {
            STREAM => {
                let mut state = self.state();
                if !state.queue.is_empty() {
                    let count = out.len().min(state.queue.len());
                    state
                        .queue
                        .drain(..count)
                        .zip(out)
                        .for_each(|(from, to)| *to = from);
                    return Ok(Outcome::Done(count));
                }
                if request.nonblocking {
                    return Err(Error::WouldBlock);
                }
                state.parked.insert(request.id, out.len());
                Ok(Outcome::Wait)
            }
            PANIC => panic!("on purpose, in a test"),
            // The four bytes of the null file.
            ino => {
                if ino == GATE {
                    self.pass_gate();
                }
                NullFs.read(&Transfer { fh: 2, ..*request }, out)
            }
        }
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        match request.ino {
            STREAM => self.feed(data),
            CONFIG => {
                let mut state = self.state();
                state.lengths.push(data.len());
                state.bad = data == b"bad";
            }
            GATE if data == b"wait" => self.pass_gate(),
            _ => {}
        }
        Ok(Outcome::Done(data.len()))
    }

    fn poll(&self, ino: u64, _fh: u64, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let mut state = self.state();
        if ino == STREAM {
            state.poller = Some(handle);
        }
        let readable = ino != STREAM || !state.queue.is_empty();
        let ready = libc::POLLOUT | if readable { libc::POLLIN } else { 0 };
        Ok(events & u32::from(ready.cast_unsigned()))
    }

    fn flush(&self, _id: RequestId, ino: u64, _fh: u64, _caller: Caller) -> Result<Outcome, Error> {
        self.flushes.fetch_add(1, Ordering::SeqCst);
        if ino == CONFIG && self.state().bad {
            return Err(Error::Invalid("bad".into()));
        }
        Ok(Outcome::Done(0))
    }

    fn fsync(&self, id: RequestId, ino: u64, fh: u64, caller: Caller) -> Result<Outcome, Error> {
        self.flush(id, ino, fh, caller)
    }

    fn release(&self, ino: u64, fh: u64) {
        let mut state = self.state();
        state.released.push(fh);
        if ino == STREAM {
            state.poller = None;
        }
    }

    fn interrupt(&self, id: RequestId) -> bool {
        let mut state = self.state();
        state.interrupted += 1;
        let parked = state.parked.remove(&id).is_some();
        drop(state);
        if parked {
            self.kernel().answer(id, Err(Error::Interrupted));
        }
        parked
    }

    fn getxattr(&self, _ino: u64, name: &[u8]) -> Result<Vec<u8>, Error> {
        if name == b"user.trik.time_ns" {
            Ok(b"12345".to_vec())
        } else {
            Err(Error::NoAttribute)
        }
    }

    fn listxattr(&self, _ino: u64) -> Result<Vec<u8>, Error> {
        Ok(b"user.trik.time_ns\0".to_vec())
    }

    fn statfs(&self) -> StatFs {
        StatFs {
            files: 8,
            name_max: 255,
        }
    }

    fn stop(&self) {
        self.stopped.fetch_add(1, Ordering::SeqCst);
    }
}

/// A [`TestFs`], mounted and served; unmounted on drop, with all requests that wait in it ended.
pub(crate) struct Rig {
    pub(crate) fs: Arc<TestFs>,
    path: PathBuf,
    _folder: TempDir,
    served: Option<JoinHandle<io::Result<()>>>,
}

impl Rig {
    /// None, with a named skip, where nothing can be mounted.
    pub(crate) fn new(
        test: &str,
        serve: impl FnOnce(OwnedFd, Arc<TestFs>) -> io::Result<()> + Send + 'static,
    ) -> Option<Self> {
        if !Path::new("/dev/fuse").exists() || !nix::unistd::geteuid().is_root() {
            needs::Need::Fuse.missing(format_args!("no /dev/fuse or not root, for {test}"));
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_owned();
        let device = mount(&path, &MountOptions::default()).unwrap();
        let fs = Arc::new(TestFs::default());
        let served = {
            let fs = Arc::clone(&fs);
            std::thread::spawn(move || serve(device, fs))
        };
        fs.kernel();
        Some(Self {
            fs,
            path,
            _folder: folder,
            served: Some(served),
        })
    }

    /// With one of the two transports.
    pub(crate) fn over(test: &str, serve: Serve) -> Option<Self> {
        Self::new(test, move |device, fs| serve(device, fs))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Takes the name away; the filesystem goes on while somebody has files open.
    pub(crate) fn unmount(&self) -> crate::mount::Unmounted {
        unmount(&self.path).unwrap()
    }

    /// Cuts the connection off, as the guardian does when the daemon is dead: all that wait are told.
    pub(crate) fn abort(&self) {
        Mounted::find(&self.path).unwrap().abort();
    }

    /// Waits for the end of serving, which somebody else has brought about.
    pub(crate) fn served(&mut self) -> io::Result<()> {
        self.served.take().unwrap().join().unwrap()
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        self.fs.let_go();
        let _ = unmount(&self.path);
        if let Some(served) = self.served.take().filter(|_| !std::thread::panicking()) {
            served.join().unwrap().unwrap();
            assert_eq!(self.fs.stopped.load(Ordering::SeqCst), 1);
        }
    }
}
