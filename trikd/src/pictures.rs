//! Pictures of the camera: one reader for all who watch, and single pictures for programs.
//!
//! Owns the thread that reads while somebody watches, so that ten viewers cost the camera and the tree as much as one.
//! Pictures are JPEG files in [`PICTURES`], which the tree fills up with zero bytes; each reading gives the newest one.

use crate::blame::{Blame, Os};
use crate::limits;
use crate::panics;
use screen::Fault;
use screen::{Pixels, picture};
use std::fmt;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// Where the tree has the newest picture.
pub const PICTURES: &str = "camera/picture/bin_data";

/// Why there is no picture.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoPicture {
    /// The tree gives none: its file, and what it says of the fault, if anything.
    Tree(PathBuf, Os, String),
    /// What it gives is none.
    Strange(PathBuf, Fault),
    /// A judge's robot has none.
    Simulated,
    /// Nothing has come from the camera yet.
    NoneYet,
    /// The camera has given nothing for so many seconds.
    Silent(u64),
    /// Nobody can read: there can be no more threads.
    NoReader(Os),
    /// trikd ends.
    End,
}

impl NoPicture {
    /// A failure with what the tree says of it.
    fn of(path: &Path, error: io::Error) -> Self {
        let fault = std::fs::read_to_string(path.with_file_name("fault")).unwrap_or_default();
        Self::Tree(path.to_owned(), error.into(), fault.trim().to_owned())
    }

    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Tree(..) | Self::Strange(..) | Self::NoneYet | Self::Silent(_) => Blame::Tree,
            Self::Simulated => Blame::Client,
            Self::NoReader(_) => Blame::System,
            Self::End => Blame::Operator,
        }
    }
}

impl fmt::Display for NoPicture {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tree(path, os, fault) => {
                write!(out, "{}: {os}", path.display())?;
                match fault.as_str() {
                    "" => Ok(()),
                    fault => write!(out, " ({fault})"),
                }
            }
            Self::Strange(path, why) => write!(out, "{}: {why}", path.display()),
            Self::Simulated => out.write_str("the simulated robot has no picture of its camera"),
            Self::NoneYet => out.write_str("there is no picture yet"),
            Self::Silent(seconds) => {
                write!(out, "the camera has given nothing for {seconds} s")
            }
            Self::NoReader(os) => write!(out, "{os}"),
            Self::End => out.write_str("trikd ends"),
        }
    }
}

impl std::error::Error for NoPicture {}

/// A JPEG file, or why there is none; nothing before the first.
pub type Newest = Option<Result<Arc<[u8]>, NoPicture>>;

/// A client that wants to watch asks here.
#[derive(Debug)]
pub struct Pictures {
    path: PathBuf,
    newest: Arc<watch::Sender<Newest>>,
    /// Whether the thread reads.
    reads: Arc<Mutex<bool>>,
}

impl Pictures {
    /// Of the tree that is mounted at `root`. Reads nothing yet.
    pub fn new(root: &Path) -> Self {
        Self {
            path: root.join(PICTURES),
            newest: Arc::new(watch::channel(None).0),
            reads: Arc::default(),
        }
    }

    /// The next pictures, for as long as the receiver lives. After an error nothing more comes.
    ///
    /// # Errors
    /// There can be no more threads.
    pub fn watch(&self) -> io::Result<watch::Receiver<Newest>> {
        let mut reads = self.reads.lock().unwrap_or_else(PoisonError::into_inner);
        let mut watcher = self.newest.subscribe();
        watcher.mark_unchanged();
        if !*reads {
            let (path, newest, flag) = (self.path.clone(), self.newest.clone(), self.reads.clone());
            std::thread::Builder::new()
                .name("pictures".to_owned())
                .spawn(move || panics::restart_on_panic(|| read_for(&path, &newest, &flag)))?;
            *reads = true;
        }
        Ok(watcher)
    }
}

/// Reads until nobody watches any more, or until it fails.
fn read_for(path: &Path, newest: &watch::Sender<Newest>, reads: &Mutex<bool>) {
    let mut opened = File::open(path);
    let mut last: Option<(Arc<[u8]>, Instant)> = None;
    let again = Duration::from_millis(limits::PICTURE_AGAIN_MS);
    loop {
        let due = Instant::now() + Duration::from_millis(limits::PICTURE_MS);
        let read = match &mut opened {
            Ok(file) => one(file),
            Err(error) => Err(io::Error::new(error.kind(), error.to_string())),
        };
        // Who begins to watch from here on finds either that nobody reads, or what is sent below.
        let mut reads = reads.lock().unwrap_or_else(PoisonError::into_inner);
        match read {
            Err(error) => {
                newest.send_replace(Some(Err(NoPicture::of(path, error))));
                *reads = false;
            }
            Ok(bytes) => {
                let is_old = last
                    .as_ref()
                    .is_some_and(|(before, at)| **before == *bytes && at.elapsed() < again);
                if !is_old {
                    let picture: Arc<[u8]> = bytes.into();
                    last = Some((picture.clone(), Instant::now()));
                    newest.send_replace(Some(Ok(picture)));
                }
                *reads = newest.receiver_count() > 0;
            }
        }
        if !*reads {
            return;
        }
        drop(reads);
        std::thread::sleep(due.saturating_duration_since(Instant::now()));
    }
}

/// One JPEG file without what it is filled up with.
fn one(file: &File) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; limits::PICTURE_BYTES];
    let mut size = file.read_at(&mut bytes, 0)?;
    while size > 0 && bytes[size - 1] == 0 {
        size -= 1;
    }
    if size == 0 {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "the picture is empty",
        ));
    }
    bytes.truncate(size);
    Ok(bytes)
}

/// One picture for a program. Waits for a camera that has to be started.
///
/// # Errors
/// The tree has no camera, the camera gives nothing, or what it gives is no picture.
pub fn photo(root: &Path) -> Result<Pixels, NoPicture> {
    let path = root.join(PICTURES);
    let read = File::open(&path).and_then(|file| one(&file));
    let bytes = read.map_err(|error| NoPicture::of(&path, error))?;
    picture::decode(&bytes).map_err(|why| NoPicture::Strange(path, why))
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::put;
    use tempfile::tempdir;

    const ONE: &[u8] = b"\xff\xd8one\xff\xd9";

    fn wait(watcher: &mut watch::Receiver<Newest>) -> Result<Arc<[u8]>, NoPicture> {
        let deadline = Instant::now() + Duration::from_secs(60);
        loop {
            if watcher.has_changed().unwrap() {
                return watcher.borrow_and_update().clone().unwrap();
            }
            assert!(Instant::now() < deadline, "no picture");
            std::thread::yield_now();
        }
    }

    #[test]
    fn all_who_watch_share_one_reader_which_ends_with_the_last() {
        let scratch = tempdir().unwrap();
        put(scratch.path(), PICTURES, [ONE, &[0; 99]].concat());
        let pictures = Pictures::new(scratch.path());
        let mut watchers: Vec<_> = (0..5).map(|_| pictures.watch().unwrap()).collect();
        for watcher in &mut watchers {
            assert_eq!(wait(watcher).unwrap()[..], *ONE);
        }
        // One owner is here, the other is the thread.
        assert_eq!(Arc::strong_count(&pictures.newest), 2);
        watchers.clear();
        let deadline = Instant::now() + Duration::from_secs(60);
        while *pictures.reads.lock().unwrap() {
            assert!(Instant::now() < deadline, "it reads on");
            std::thread::yield_now();
        }
        let mut late = pictures.watch().unwrap();
        assert_eq!(wait(&mut late).unwrap()[..], *ONE);
    }

    #[test]
    fn without_a_camera_there_is_a_reason() {
        let scratch = tempdir().unwrap();
        let pictures = Pictures::new(scratch.path());
        let told = wait(&mut pictures.watch().unwrap())
            .unwrap_err()
            .to_string();
        assert!(told.contains(PICTURES), "{told}");
        let why = || photo(scratch.path()).unwrap_err().to_string();
        assert!(why().contains(PICTURES));
        put(
            scratch.path(),
            "camera/picture/fault",
            "device: unplugged\n",
        );
        put(scratch.path(), PICTURES, [0; 10]);
        let told = why();
        assert!(
            told.ends_with("the picture is empty (device: unplugged)"),
            "{told}"
        );
        put(scratch.path(), PICTURES, ONE);
        assert!(why().contains("JPEG"));
    }
}
