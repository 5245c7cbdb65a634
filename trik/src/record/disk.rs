//! The thread that writes a recording, so that a slow disk delays nobody who looks at samples.
//!
//! Owns the bounded queue to it, what is dropped when the disk is too slow, and when the file is flushed and synced.

use crate::error::Error;
use crate::limits;
use journal::node::Node;
use journal::standard::Log;
use journal::write::{Id, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Something for the file.
pub(super) enum Entry {
    /// A node begins, with the next number; also one whose format has changed.
    Node(Node),
    /// A sample of the node with this number.
    Sample(usize, u64, Vec<u8>),
    /// The node with this number has no value.
    Fault(usize, u64, i32, String),
    /// A line of the log.
    Log(u64, Log),
    /// A file that goes with the recording.
    Attachment(u64, &'static str, &'static str, Vec<u8>),
    /// Facts.
    Facts(&'static str, BTreeMap<String, String>),
}

impl Entry {
    /// Bytes that it keeps in memory, about.
    fn size(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Sample(_, _, bytes) | Self::Attachment(_, _, _, bytes) => bytes.len(),
                Self::Fault(_, _, _, text) => text.len(),
                Self::Log(_, line) => line.name.len() + line.text.len(),
                Self::Node(_) | Self::Facts(..) => 0,
            }
    }
}

/// A recording that is being written. Dropping it without `finish` leaves a cut file.
pub(super) struct Disk {
    queue: SyncSender<Vec<Entry>>,
    waiting: Arc<AtomicUsize>,
    has_failed: Arc<AtomicBool>,
    thread: JoinHandle<Result<(), Error>>,
    path: PathBuf,
}

impl Disk {
    /// Makes the file; one that is there is left alone.
    ///
    /// # Errors
    /// It is there, or cannot be made.
    pub(super) fn create(path: &Path) -> Result<Self, Error> {
        let file = File::create_new(path).map_err(|error| Error::file(path, error))?;
        let synced = file.try_clone().map_err(|error| Error::file(path, error))?;
        let library = concat!("trik/", env!("CARGO_PKG_VERSION"));
        let writer = Writer::new(BufWriter::new(file), library);
        let writer = writer.map_err(|error| Error::file(path, error))?;
        let (queue, entries) = sync_channel(limits::RECORD_BATCHES);
        let (waiting, has_failed) = (Arc::<AtomicUsize>::default(), Arc::<AtomicBool>::default());
        let (left, failed, name) = (waiting.clone(), has_failed.clone(), path.to_owned());
        let thread = std::thread::Builder::new()
            .name("disk".to_owned())
            .spawn(move || {
                let end = write(writer, &synced, &entries, &left);
                failed.store(end.is_err(), Ordering::Relaxed);
                end.map_err(|error| Error::file(&name, error))
            })
            .map_err(|error| Error::system("a thread", error))?;
        Ok(Self {
            queue,
            waiting,
            has_failed,
            thread,
            path: path.to_owned(),
        })
    }

    /// Hands entries over without waiting. Gives back those for which there is no room.
    pub(super) fn put(&self, batch: Vec<Entry>) -> Result<(), Vec<Entry>> {
        let size: usize = batch.iter().map(Entry::size).sum();
        if self.waiting.load(Ordering::Relaxed) + size > limits::RECORD_BYTES {
            return Err(batch);
        }
        self.waiting.fetch_add(size, Ordering::Relaxed);
        self.queue.try_send(batch).map_err(|refused| {
            self.waiting.fetch_sub(size, Ordering::Relaxed);
            let (TrySendError::Full(batch) | TrySendError::Disconnected(batch)) = refused;
            batch
        })
    }

    /// The file takes nothing more: the disk is full.
    pub(super) fn has_failed(&self) -> bool {
        self.has_failed.load(Ordering::Relaxed)
    }

    /// Bytes of the file by now.
    pub(super) fn size(&self) -> u64 {
        std::fs::metadata(&self.path).map_or(0, |file| file.len())
    }

    /// Writes what waits, and the end.
    ///
    /// # Errors
    /// The disk is full or has failed; what was flushed before is there.
    pub(super) fn finish(self) -> Result<(), Error> {
        let Self { queue, thread, .. } = self;
        drop(queue);
        let end = thread.join();
        end.unwrap_or_else(|_| Err(Error::Process("the writer of the recording failed".into())))
    }
}

/// Writes until nobody sends any more.
fn write(
    mut file: Writer<BufWriter<File>>,
    synced: &File,
    entries: &Receiver<Vec<Entry>>,
    waiting: &AtomicUsize,
) -> Result<(), journal::error::Error> {
    let mut ids: Vec<Id> = Vec::new();
    let period = Duration::from_millis(limits::RECORD_FLUSH_MS.into());
    let mut flush_at = Instant::now() + period;
    loop {
        let left = flush_at.saturating_duration_since(Instant::now());
        match entries.recv_timeout(left) {
            Ok(batch) => {
                let size: usize = batch.iter().map(Entry::size).sum();
                for entry in batch {
                    put(&mut file, &mut ids, entry)?;
                }
                waiting.fetch_sub(size, Ordering::Relaxed);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if Instant::now() >= flush_at {
            file.flush()?;
            // A power cut then loses what came since.
            synced.sync_data()?;
            flush_at = Instant::now() + period;
        }
    }
    file.finish()?;
    Ok(synced.sync_all()?)
}

fn put(
    file: &mut Writer<BufWriter<File>>,
    ids: &mut Vec<Id>,
    entry: Entry,
) -> Result<(), journal::error::Error> {
    match entry {
        Entry::Node(node) => ids.push(file.add(&node)?),
        Entry::Sample(node, unix_ns, tuple) => file.sample(ids[node], unix_ns, &tuple)?,
        Entry::Fault(node, unix_ns, errno, reason) => {
            file.fault(ids[node], unix_ns, errno, &reason)?;
        }
        Entry::Log(unix_ns, line) => file.log(unix_ns, &line)?,
        Entry::Attachment(unix_ns, name, media_type, bytes) => {
            file.attach(unix_ns, name, media_type, &bytes)?;
        }
        Entry::Facts(name, facts) => file.facts(name, facts)?,
    }
    Ok(())
}
