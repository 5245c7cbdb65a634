//! The sample bus of one mount.
//!
//! Owns the mount's directory in shared memory and the sum of what its rings take. Whatever fails here becomes a line
//! for the log and for `status`; files never notice.

use super::{BusError, Readers};
use crate::clock::Stamp;
use crate::errno::Error;
use crate::events::lock;
use crate::{limits, memory};
use config::description::{Alias, NodeDescription};
use sample_bus::place::{self, Directory, SHARED_MEMORY};
use sample_bus::{Rights, Writer};
use std::collections::HashMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Samples of one mount in shared memory. Without a directory there are none.
#[derive(Default)]
pub struct SampleBus {
    place: Mutex<Option<Place>>,
    /// Why there is no directory.
    problem: Mutex<Option<BusError>>,
    used_bytes: Arc<AtomicUsize>,
    /// Every node publishes what its source gives.
    has_raw: AtomicBool,
}

struct Place {
    directory: Directory,
    readers: Readers,
    /// Bytes that all rings may take together.
    most_bytes: usize,
}

/// One node's part of it.
pub struct Ring {
    writer: Writer,
    bytes: usize,
    used_bytes: Arc<AtomicUsize>,
}

impl SampleBus {
    /// Takes the directory of a mount point.
    ///
    /// # Errors
    /// Why there is no sample bus; `status` shows it as well.
    pub fn open(&self, mountpoint: &Path, readers: Readers) -> Result<(), BusError> {
        let shared_memory = Path::new(SHARED_MEMORY);
        place::sweep(shared_memory);
        let path = place::directory(shared_memory, mountpoint);
        let directory = self.note(path.and_then(|path| take(&path, readers)))?;
        // Shared memory counts in the control group, and on a small board it is the memory of programs.
        let part = usize::try_from(memory::bytes() / limits::SAMPLE_BUS_PART);
        *lock(&self.place) = Some(Place {
            directory,
            readers,
            most_bytes: part.map_or(limits::SAMPLE_BUS_BYTES_MAX, |part| {
                part.min(limits::SAMPLE_BUS_BYTES_MAX)
            }),
        });
        Ok(())
    }

    /// Takes the directory again if somebody has removed it. True: it is another one, and all rings are to be made anew.
    ///
    /// # Errors
    /// Why there is no sample bus any more; `status` shows it as well.
    pub fn restore(&self) -> Result<bool, BusError> {
        let mut place = lock(&self.place);
        let Some(place) = place.as_mut() else {
            return Ok(false);
        };
        if place.directory.is_there() {
            return Ok(false);
        }
        place.directory = self.note(take(place.directory.path(), place.readers))?;
        Ok(true)
    }

    /// Notes for `status` whether there is a directory.
    fn note(&self, taken: std::io::Result<Directory>) -> Result<Directory, BusError> {
        let taken = taken.map_err(|error| BusError::Off(error.to_string()));
        *lock(&self.problem) = taken.as_ref().err().cloned();
        taken
    }

    /// Removes the directory.
    pub fn close(&self) {
        let place = lock(&self.place).take();
        drop(place);
    }

    /// A line for `status`, or nothing if all is well.
    pub fn status_line(&self) -> String {
        let problem = lock(&self.problem);
        problem
            .as_ref()
            .map_or_else(String::new, |error| format!("{error}\n"))
    }

    /// Second names lead to the rings of their nodes, and to nothing while those have none. Links are the names of the
    /// configuration in force and no others; call it when the rings of nodes that are gone have ended.
    ///
    /// # Errors
    /// The first name that could not be made.
    pub fn set_aliases(&self, aliases: &[Alias]) -> Result<(), BusError> {
        let place = lock(&self.place);
        let Some(place) = place.as_ref() else {
            return Ok(());
        };
        let mut links = HashMap::new();
        let mut failed = None;
        for alias in aliases {
            match (place::file_name(&alias.path), place::file_name(&alias.node)) {
                (Ok(link), Ok(ring)) => drop(links.insert(link, ring)),
                (Err(error), _) | (_, Err(error)) => {
                    failed.get_or_insert((alias.path.clone(), error));
                }
            }
        }
        if let Err((name, error)) = place.directory.set_links(&links) {
            failed.get_or_insert((name, error));
        }
        failed.map_or(Ok(()), |(name, error)| {
            let why = error.to_string();
            Err(BusError::Alias { name, why })
        })
    }

    /// A ring for a node, with the rights of its files. None: the mount has no sample bus.
    ///
    /// # Errors
    /// Why this node has none.
    pub fn ring(&self, description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        let size = description.output_tuple_size;
        self.with_rights(description, place::file_name(&description.path), size)
    }

    /// A ring for what is written to an actuator, with the rights of its files; as `ring`.
    ///
    /// # Errors
    /// Why this node has none.
    pub fn ring_of_writes(&self, description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        let size = description.written_tuple_size();
        let name = place::written_file_name(&description.path);
        self.with_rights(description, name, size)
    }

    /// From now on every node has a ring of what its source gives, not only those whose description asks for it.
    pub fn set_raw(&self, has_raw: bool) {
        self.has_raw.store(has_raw, Ordering::Relaxed);
    }

    /// A ring for what a node's source gives before it is converted, with the rights of its files; as `ring`. None also if
    /// nobody asked for it.
    ///
    /// # Errors
    /// Why this node has none.
    pub fn ring_of_raw(&self, description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        if !(description.raw || self.has_raw.load(Ordering::Relaxed)) {
            return Ok(None);
        }
        let size = description.input_tuple_size;
        self.with_rights(description, place::raw_file_name(&description.path), size)
    }

    fn with_rights(
        &self,
        description: &NodeDescription,
        name: std::io::Result<String>,
        size: usize,
    ) -> Result<Option<Ring>, BusError> {
        let place = lock(&self.place);
        let Some(place) = place.as_ref() else {
            return Ok(None);
        };
        let shown = match place.readers {
            Readers::Owner => 0o400,
            Readers::All => 0o444,
        };
        let rights = Rights {
            mode: u32::from(description.mode) & shown,
            group: description.group,
        };
        let ring = name.and_then(|name| self.make(place, &name, size, rights));
        ring.map(Some)
            .map_err(|error| BusError::Ring(error.to_string()))
    }

    fn make(
        &self,
        place: &Place,
        name: &str,
        tuple_bytes: usize,
        rights: Rights,
    ) -> std::io::Result<Ring> {
        let file = place.directory.path().join(name);
        let bytes = Writer::bytes_for(tuple_bytes)?;
        let before = self.used_bytes.fetch_add(bytes, Ordering::Relaxed);
        let made = if before + bytes > place.most_bytes {
            Err(std::io::Error::other(format!(
                "the rings of this mount would take more than {} MiB",
                place.most_bytes >> 20
            )))
        } else {
            Writer::create(&file, tuple_bytes, rights).map_err(|error| {
                std::io::Error::other(format!("{} ({bytes} bytes): {error}", file.display()))
            })
        };
        let writer = made.inspect_err(|_| {
            self.used_bytes.fetch_sub(bytes, Ordering::Relaxed);
        })?;
        Ok(Ring {
            writer,
            bytes,
            used_bytes: self.used_bytes.clone(),
        })
    }
}

/// Takes a directory for these readers.
fn take(path: &Path, readers: Readers) -> std::io::Result<Directory> {
    let mode = match readers {
        Readers::Owner => 0o700,
        Readers::All => 0o755,
    };
    let taken = Directory::take(path, mode);
    taken.map_err(|error| std::io::Error::other(format!("{}: {error}", path.display())))
}

impl Ring {
    /// A new sample.
    pub fn publish(&mut self, stamp: Stamp, tuple: &[u8]) {
        self.writer.publish(stamp.0, tuple);
    }

    /// There is no newest value any more.
    pub fn fail(&mut self, stamp: Stamp, error: &Error) {
        self.writer.fail(stamp.0, error.errno());
    }

    /// The age from which a sample is not shown.
    pub fn set_too_old(&mut self, age: Duration) {
        let ms = u32::try_from(age.as_millis()).unwrap_or(u32::MAX);
        self.writer.set_stale_ms(ms);
    }
}

impl Drop for Ring {
    fn drop(&mut self) {
        self.used_bytes.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

/// Removes what a daemon that was killed left of its part of the bus.
pub fn remove_left(mountpoint: &Path) {
    if let Ok(path) = place::directory(Path::new(SHARED_MEMORY), mountpoint) {
        place::remove_left(&path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn memory_is_given_back_and_its_limit_names_itself() {
        let scratch = Scratch::new();
        let bus = SampleBus::default();
        let directory = Directory::take(&scratch.path("trikfs+test"), 0o700).unwrap();
        let readers = Readers::Owner;
        let place = Place {
            directory,
            readers,
            most_bytes: limits::SAMPLE_BUS_BYTES_MAX,
        };
        let rights = Rights {
            mode: 0o400,
            group: None,
        };
        let large = 4 << 20;
        let make = |name: &str, size| bus.make(&place, name, size, rights);
        let rings: Vec<_> = ["n0", "n1", "n2"]
            .map(|name| make(name, large).unwrap())
            .into();
        let refused = make("n3", large).err().unwrap().to_string();
        assert!(refused.contains("more than 64 MiB"), "{refused}");
        drop(rings);
        assert_eq!(bus.used_bytes.load(Ordering::Relaxed), 0);
        let _ring = make("n3", large).unwrap();
        let again = make("n3", 4).err().unwrap().to_string();
        assert!(again.contains("n3"), "{again}");
        drop(place);
        assert!(!scratch.path("trikfs+test").exists());
    }
}
