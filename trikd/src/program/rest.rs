//! Brings the motors to rest, on a thread of its own that does nothing else.
//!
//! Owns that thread and the open file `stop`. A device that hangs delays the thread, and others wait for it as long as
//! they like.

use crate::blame::Os;
use crate::limits;
use crate::panics;
use crate::priority::{self, Rank};
use crate::tree::{Access, Tree};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;
use tokio::sync::oneshot;

type Answer = oneshot::Sender<Result<(), Failure>>;

/// Why not everything is at rest, as far as anybody knows. The tree, or its mount, is to blame.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Failure {
    /// None is mounted there.
    NoTree(PathBuf),
    /// It is not served any more.
    Gone(PathBuf),
    /// An actuator, or the tree itself.
    Tree(PathBuf, Os),
    /// It has not answered within so many milliseconds.
    Late(u64),
}

impl Failure {
    /// What a failed write of `stop` means.
    pub fn of(root: &Path, error: io::Error) -> Self {
        let root = root.to_owned();
        match error.raw_os_error() {
            Some(libc::ENOENT) => Self::NoTree(root),
            // ENODEV is no word of FUSE for its end: an actuator of the robot is not there.
            Some(libc::ENOTCONN | libc::ECONNABORTED) => Self::Gone(root),
            Some(_) | None => Self::Tree(root, error.into()),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoTree(root) => write!(
                out,
                "there is no tree at {}: start it with `trikfs mount`",
                root.display()
            ),
            Self::Gone(root) => write!(
                out,
                "the tree at {} is gone: its guardian brings the motors to rest",
                root.display()
            ),
            Self::Tree(root, os) => {
                write!(
                    out,
                    "not everything is at rest: {}/stop: {os}",
                    root.display()
                )
            }
            Self::Late(wait_ms) => write!(
                out,
                "the tree has not brought the motors to rest within {wait_ms} ms"
            ),
        }
    }
}

/// The way to the thread.
#[derive(Debug)]
pub struct Rest {
    ask: SyncSender<Answer>,
}

impl Rest {
    /// Starts the thread for the tree at `root`; it ends with this.
    ///
    /// # Errors
    /// There can be no more threads.
    pub fn start(root: &Path) -> io::Result<Self> {
        let (ask, asked) = sync_channel(limits::REST_ASKS);
        let root: PathBuf = root.to_owned();
        std::thread::Builder::new()
            .name("rest".to_owned())
            .spawn(move || panics::restart_on_panic(|| serve(&root, &asked)))?;
        Ok(Self { ask })
    }

    /// Brings everything that moves to rest; returns when it is there, or after `wait_ms`, when it is still on its way.
    ///
    /// # Errors
    /// There is no tree, it does not answer, an actuator fails.
    pub async fn now(&self, wait_ms: u64) -> Result<(), Failure> {
        let (answer, done) = oneshot::channel();
        let late = || Err(Failure::Late(wait_ms));
        if self.ask.try_send(answer).is_err() {
            return late();
        }
        match tokio::time::timeout(Duration::from_millis(wait_ms), done).await {
            Ok(Ok(done)) => done,
            Ok(Err(_)) | Err(_) => late(),
        }
    }
}

fn serve(root: &Path, asked: &Receiver<Answer>) {
    priority::set(Rank::Rest);
    let tree = Tree::new(root);
    let stop = tree.node("stop", Access::Write);
    while let Ok(first) = asked.recv() {
        panics::seam("rest", || root.join("panic").exists());
        // A caller that asked meanwhile is served by the same write.
        let others: Vec<_> = asked.try_iter().collect();
        let done = stop.write("1\n").map_err(|error| Failure::of(root, error));
        for answer in std::iter::once(first).chain(others) {
            let _ = answer.send(done.clone());
        }
    }
}

/// How the sentences of [`Failure`] begin. Those who hear a robot know by them that something may still move.
pub const EXPLAINED: [&str; 4] = [
    "there is no tree at ",
    "the tree at ",
    "not everything is at rest: ",
    "the tree has not brought the motors to rest ",
];

/// Whether a text is that of a [`Failure`]: after a stop something may still move.
pub fn is_explained(text: &str) -> bool {
    EXPLAINED.iter().any(|start| text.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::tempdir;

    #[test]
    fn every_failure_is_told_so_that_it_is_known_as_one() {
        for code in [libc::ENOENT, libc::ENOTCONN, libc::EIO] {
            let error = io::Error::from_raw_os_error(code);
            let text = Failure::of(Path::new("/t"), error).to_string();
            assert!(is_explained(&text), "{text}");
        }
        let late = Failure::Late(2000).to_string();
        assert!(is_explained(&late), "{late}");
        let absent = Failure::of(Path::new("/t"), io::Error::from_raw_os_error(libc::ENODEV));
        let text = absent.to_string();
        assert!(
            text.starts_with("not everything is at rest: /t/stop: "),
            "a tree that misses an actuator is not gone: {text}"
        );
        assert!(!is_explained("x.js was stopped by a client after 0.1 s"));
    }

    #[test]
    fn everything_is_brought_to_rest_by_one_write() {
        let scratch = tempdir().unwrap();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_time()
            .build()
            .unwrap();
        let rest = Rest::start(scratch.path()).unwrap();
        let why = runtime
            .block_on(rest.now(limits::REST_LAST_MS))
            .unwrap_err();
        assert_eq!(why, Failure::NoTree(scratch.path().to_owned()));
        let stop = put(scratch.path(), "stop", "");
        runtime.block_on(rest.now(limits::REST_LAST_MS)).unwrap();
        assert_eq!(std::fs::read_to_string(stop).unwrap(), "1\n");
    }
}
