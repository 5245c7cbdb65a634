//! A node: what one description is at work.
//!
//! Owns its identity, its parts, and the flag that a reload sets when the description is gone. Each part has one reason
//! and a file below: how the device is opened, sampling, driving, converting, quarantine, faults, what was written, rest.
//! Knows no file of the tree and no request of the kernel.

// What a source drives must not be forgotten in silence.
#![deny(clippy::wildcard_enum_match_arm)]

mod converting;
mod driving;
mod fault;
mod linked;
mod quarantine;
mod rest;
mod sampling;
mod source;
mod written;

use crate::convert::Recipe;
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Due, Ready};
use crate::lease::Lease;
use crate::stats::Stats;
use config::description::NodeDescription;
use config::format::Format;
use config::problem::Problem;
use driving::Driving;
use fault::Trouble;
use quarantine::Quarantine;
pub use rest::{LeasedActuators, rest_all};
use sampling::Sampling;
pub use source::Feed;
use source::Source;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// One described peripheral.
pub struct Node {
    /// As the configuration says.
    pub description: NodeDescription,
    /// One file of another node's directory, not a directory of its own.
    pub is_attribute: bool,
    /// The description's fingerprint together with those of the nodes it is linked to.
    pub fingerprint: u128,
    /// Format of a converted tuple; single bytes when none was given.
    pub format: Format,
    /// The mount's services.
    pub engine: Arc<Engine>,
    /// Counts and times.
    pub stats: Stats,
    /// Converters that are opened from now on are made by it.
    pub recipe: Recipe,
    /// The way to the device.
    pub source: Source,
    /// The newest sample, and how often one is taken.
    pub sampling: Sampling,
    /// Leases and regulators.
    pub driving: Driving,
    /// How many operations may be inside.
    pub quarantine: Quarantine,
    trouble: Trouble,
    /// Nodes that the source names, by path.
    links: Vec<(String, Arc<Self>)>,
    retired: AtomicBool,
}

impl Node {
    /// Puts a node together; opens nothing.
    pub fn new(
        description: NodeDescription,
        is_attribute: bool,
        fingerprint: u128,
        recipe: Recipe,
        links: Vec<(String, Arc<Self>)>,
        engine: Arc<Engine>,
        lease: Arc<Lease>,
    ) -> Arc<Self> {
        let format = description
            .format
            .clone()
            .unwrap_or_else(|| Format::bytes(description.output_tuple_size));
        let stats = Stats::default();
        Arc::new_cyclic(|me| Self {
            is_attribute,
            fingerprint,
            format,
            recipe,
            source: Source::new(&description, &links, &engine, &stats),
            sampling: Sampling::new(me.clone(), &description),
            driving: Driving::new(&description, &links, lease),
            quarantine: Quarantine::new(&description),
            trouble: Trouble::new(&description.path, engine.log.clone()),
            links,
            retired: AtomicBool::new(false),
            engine,
            stats,
            description,
        })
    }

    /// Path below the mount point.
    pub fn path(&self) -> &str {
        &self.description.path
    }

    /// Path of the directory that holds the node's files.
    pub fn directory(&self) -> &str {
        directory_of(&self.description.path, self.is_attribute)
    }

    /// A reload has changed or removed the description.
    pub fn is_retired(&self) -> bool {
        self.retired.load(Ordering::Acquire)
    }

    /// From here on everything that is open on this node gets ESTALE.
    pub fn retire(&self) {
        self.retired.store(true, Ordering::Release);
        self.sampling.newest.stop();
        self.recipe.retire();
    }

    /// Bytes of one tuple that goes to the device.
    pub fn device_tuple_size(&self) -> usize {
        self.description.write_conversion_sizes().1
    }

    /// Whether programs may read or write at all: root passes the kernel's check of the mode bits.
    pub fn check_access(&self, read: bool, write: bool) -> Result<(), Error> {
        let mode = self.description.mode;
        if (read && mode & 0o444 == 0) || (write && mode & 0o222 == 0) {
            return Err(Error::AccessDenied);
        }
        if self.is_retired() {
            Err(Error::Stale)
        } else {
            Ok(())
        }
    }

    /// Format of what programs write.
    pub fn written_format(&self) -> Format {
        if self.format.size() == self.description.written_tuple_size() {
            self.format.clone()
        } else {
            Format::bytes(self.description.written_tuple_size())
        }
    }

    /// What was written last, or else the newest sample if it has the shape of what is written.
    pub fn last_tuple(&self) -> Option<Vec<u8>> {
        if let Some(tuple) = self.driving.written.last() {
            return Some(tuple);
        }
        let mut tuple = Vec::new();
        let _needed = self.sampling.newest.needed();
        let newest = self.sampling.newest.get(&mut tuple).ok().flatten();
        newest
            .filter(|_| self.description.output_tuple_size == self.description.written_tuple_size())
            .map(|_| tuple)
    }

    /// Notes a failure. One of the device or the converter is shown by `fault`, `stats` and the log; a mistake of the
    /// caller, which has the errno, by the log alone.
    pub fn report(&self, error: &Error) {
        self.trouble.report(error, &self.stats);
    }

    /// All is well again.
    pub fn recover(&self) {
        self.trouble.recover();
    }

    /// The present fault.
    pub fn fault(&self) -> Option<Error> {
        self.trouble.fault().or_else(|| self.driving.lost())
    }

    /// A problem at the place of this node's description.
    pub fn problem(&self, reason: &str) -> Problem {
        let place = &self.description.place;
        Problem::new(
            place.file.clone(),
            place.line,
            format!("node {}: {reason}", self.path()),
        )
    }
}

/// The directory of a node, or of an attribute.
pub fn directory_of(path: &str, is_attribute: bool) -> &str {
    let parent = path.rsplit_once('/').filter(|_| is_attribute);
    parent.map_or(path, |(parent, _)| parent)
}

impl Ready for Node {
    fn ready(&self) {
        self.sampling.newest.ready();
    }
}

impl Due for Node {
    fn due(&self) -> Option<Instant> {
        self.sampling.newest.expire()
    }
}
