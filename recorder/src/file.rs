//! The thread that writes a recording, so that a slow disk delays nobody who looks at samples.
//!
//! Owns the bounded queue to it, what is dropped when the disk is too slow, and when the file is flushed and synced.

use crate::entry::{Batch, size};
use crate::error::Error;
use crate::limits;
use crate::pen::Pen;
use journal::write::Writer;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// A recording that is being written. Dropping it without `finish` leaves a cut file.
pub struct Disk {
    queue: SyncSender<Batch>,
    /// Bytes that may wait.
    most: usize,
    waiting: Arc<AtomicUsize>,
    has_failed: Arc<AtomicBool>,
    thread: Writing,
    path: PathBuf,
}

impl Disk {
    /// Makes the file; one that is there is left alone. `library` is the program that writes, with its version; `most` is how
    /// many bytes may wait for the disk.
    ///
    /// # Errors
    /// It is there, or cannot be made.
    pub fn create(path: &Path, library: &str, most: usize) -> Result<Self, Error> {
        Self::begin(path, library, most, false, 0)
    }

    /// The same with standard messages beside those of the nodes themselves, for tools that know no others.
    ///
    /// # Errors
    /// As `create`.
    pub fn create_with_standard(path: &Path, library: &str, most: usize) -> Result<Self, Error> {
        Self::begin(path, library, most, true, 0)
    }

    /// One that begins at this moment, in ns since 1970, with what is older.
    ///
    /// # Errors
    /// As `create`.
    pub fn create_at(
        begin_ns: u64,
        path: &Path,
        library: &str,
        most: usize,
    ) -> Result<Self, Error> {
        Self::begin(path, library, most, false, begin_ns)
    }

    fn begin(
        path: &Path,
        library: &str,
        most: usize,
        has_standard: bool,
        begin_ns: u64,
    ) -> Result<Self, Error> {
        let file = File::create_new(path).map_err(|error| Error::io(path, error))?;
        let synced = file.try_clone().map_err(|error| Error::io(path, error))?;
        let writer = Writer::new(BufWriter::new(file), library);
        let mut writer = writer.map_err(|error| Error::File(path.to_owned(), error))?;
        writer.begin_at(begin_ns);
        let (queue, entries) = sync_channel(limits::BATCHES);
        let (waiting, has_failed) = (Arc::<AtomicUsize>::default(), Arc::<AtomicBool>::default());
        let (left, failed, name) = (waiting.clone(), has_failed.clone(), path.to_owned());
        let thread = std::thread::Builder::new()
            .name("disk".to_owned())
            .spawn(move || {
                let pen = Pen::new(writer).with_standard(has_standard);
                let end = write(pen, &synced, &entries, &left);
                failed.store(end.is_err(), Ordering::Relaxed);
                end.map_err(|error| Error::Broken(name, error))
            })
            .map_err(|error| Error::Thread(error.to_string()))?;
        Ok(Self {
            queue,
            most,
            waiting,
            has_failed,
            thread,
            path: path.to_owned(),
        })
    }

    /// Hands entries over without waiting. False: there is no room for them.
    pub fn put(&self, batch: &Batch) -> bool {
        let size = size(batch);
        if self.waiting.load(Ordering::Relaxed) + size > self.most {
            return false;
        }
        self.waiting.fetch_add(size, Ordering::Relaxed);
        let is_taken = self.queue.try_send(batch.clone()).is_ok();
        if !is_taken {
            self.waiting.fetch_sub(size, Ordering::Relaxed);
        }
        is_taken
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file takes nothing more: the disk is full.
    pub fn has_failed(&self) -> bool {
        self.has_failed.load(Ordering::Relaxed)
    }

    /// Bytes of the file by now.
    pub fn size(&self) -> u64 {
        std::fs::metadata(&self.path).map_or(0, |file| file.len())
    }

    /// Writes what waits, and the end.
    ///
    /// # Errors
    /// The disk is full or has failed; what was flushed before is there.
    pub fn finish(self) -> Result<(), Error> {
        let end = self.end().join();
        end.unwrap_or_else(|_| Err(Error::Thread("the writer of the recording failed".into())))
    }

    /// The same without waiting for it.
    pub fn end(self) -> Writing {
        self.thread
    }
}

/// What is still being written.
pub type Writing = JoinHandle<Result<(), Error>>;

/// Writes until nobody sends any more.
fn write(
    mut pen: Pen<BufWriter<File>>,
    synced: &File,
    entries: &Receiver<Batch>,
    waiting: &AtomicUsize,
) -> Result<(), journal::error::Error> {
    let period = Duration::from_millis(limits::FLUSH_MS.into());
    let mut flush_at = Instant::now() + period;
    // A file that was begun is a recording, whenever it ends.
    pen.file.flush()?;
    loop {
        let left = flush_at.saturating_duration_since(Instant::now());
        match entries.recv_timeout(left) {
            Ok(batch) => {
                for entry in &*batch {
                    pen.put(entry)?;
                }
                pen.settle(false)?;
                waiting.fetch_sub(size(&batch), Ordering::Relaxed);
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        if Instant::now() >= flush_at {
            pen.file.flush()?;
            // A power cut then loses what came since.
            synced.sync_data()?;
            flush_at = Instant::now() + period;
        }
    }
    pen.settle(true)?;
    pen.file.finish()?;
    Ok(synced.sync_all()?)
}
