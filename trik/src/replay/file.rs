//! A recording in a file as the player reads it.
//!
//! Owns the way from the file's times to positions, and which of its events are played: samples and failures of nodes.

use super::recording::{Channel, Event, Reading, Recording};
use crate::error::Error;
use crate::limits;
use journal::layout::Layout;
use journal::read::{self, Reader};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// An open file.
pub(crate) struct FileRecording {
    reader: Reader<BufReader<File>>,
    channels: Vec<Channel>,
    path: PathBuf,
}

impl FileRecording {
    /// Opens it.
    ///
    /// # Errors
    /// It is none, is cut, or has no nodes that can be played.
    pub(crate) fn open(path: &Path) -> Result<Self, Error> {
        Self::of(
            File::open(path).map_err(|error| Error::file(path, error))?,
            path,
        )
    }

    /// The same of a file that is open; errors name it by this path.
    ///
    /// # Errors
    /// As of `open`.
    pub(crate) fn of(file: File, path: &Path) -> Result<Self, Error> {
        if !file.metadata().is_ok_and(|file| file.is_file()) {
            return Err(Error::file(path, "a recording is a regular file"));
        }
        let reader = Reader::open(BufReader::new(file)).map_err(|why| Error::file(path, why))?;
        let mut channels = Vec::new();
        for (number, node) in reader.nodes().iter().enumerate() {
            let layout = reader.layout(number).cloned().unwrap_or(Layout::Bytes(1));
            channels.push(Channel {
                path: node.path.clone(),
                format: node.format.clone(),
                units: node.units.clone(),
                about: node.about.clone(),
                bytes: layout.size(),
                layout,
                is_written: node.is_written,
                rest: node.rest.clone(),
                aliases: node.aliases.clone(),
            });
        }
        if channels.is_empty() {
            return Err(Error::file(path, "the recording has no nodes of a tree"));
        }
        let large = (channels.iter()).find(|it| it.bytes > limits::REPLAY_MESSAGE_BYTES);
        if let Some(large) = large {
            let most = limits::REPLAY_MESSAGE_BYTES;
            let why = format!(
                "{}: tuples of {} bytes; at most {most} can be played",
                large.path, large.bytes
            );
            return Err(Error::file(path, why));
        }
        Ok(Self {
            reader,
            channels,
            path: path.to_owned(),
        })
    }

    fn fail(&self, why: impl std::fmt::Display) -> Error {
        Error::file(&self.path, why)
    }

    /// An event that is played.
    fn event(&self, event: read::Event) -> Option<Event> {
        let at = event.unix_ns.saturating_sub(self.reader.begin_ns());
        let (channel, what) = match event.what {
            read::EventKind::Sample { node, tuple, .. } => (node, Reading::Sample(tuple)),
            read::EventKind::Fault {
                node,
                errno,
                reason,
            } => {
                // The tree puts the blame before it again.
                let reason = reason.strip_prefix("device: ").unwrap_or(&reason);
                (node, Reading::Failure(errno, reason.to_owned()))
            }
            read::EventKind::Line(..) => return None,
        };
        // Before its format changed it was another node.
        let fits = match &what {
            Reading::Sample(tuple) => tuple.len() == self.channels[channel].bytes,
            Reading::Failure(..) => true,
        };
        fits.then_some(Event {
            at: Duration::from_nanos(at),
            channel,
            what,
        })
    }

    fn moment(&self, position: Duration) -> u64 {
        let after = u64::try_from(position.as_nanos()).unwrap_or(u64::MAX);
        self.reader.begin_ns().saturating_add(after)
    }
}

impl Recording for FileRecording {
    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn length(&self) -> Duration {
        Duration::from_nanos(self.reader.end_ns().saturating_sub(self.reader.begin_ns()))
    }

    fn seek(&mut self, position: Duration) -> Result<(), Error> {
        self.reader.seek(self.moment(position));
        Ok(())
    }

    fn seek_among(&mut self, position: Duration, channels: &[usize]) -> Result<(), Error> {
        self.reader.seek_among(self.moment(position), channels);
        Ok(())
    }

    fn next(&mut self) -> Result<Option<Event>, Error> {
        loop {
            let next = self.reader.next();
            let Some(event) = next.map_err(|why| self.fail(why))? else {
                return Ok(None);
            };
            if let Some(event) = self.event(event) {
                return Ok(Some(event));
            }
        }
    }

    fn newest(&mut self, position: Duration) -> Result<Vec<Option<Reading>>, Error> {
        let newest = self.reader.newest(self.moment(position));
        let newest = newest.map_err(|why| self.fail(why))?;
        let played = newest.into_iter().map(|event| self.event(event?));
        Ok(played.map(|event| event.map(|event| event.what)).collect())
    }
}
