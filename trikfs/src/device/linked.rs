//! Other nodes of the same tree as sources and sinks (`trikfs:other`), without a round trip through the kernel.
//!
//! Owns the border: all that devices know of nodes is the trait [`LinkedNode`]. How a node answers is its own business.

use super::{Device, Drives, Kind, Sink, Surroundings};
use crate::errno::Error;
use crate::latch::Latch;
use config::description::LinkDescription;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

impl Kind for LinkDescription {
    fn open(&self, _tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        around.link(&self.path)?.clone().open()
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        around.link(&self.path)?.clone().open_sink()
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }

    fn add_buses(&self, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        if let Ok(node) = around.link(&self.path) {
            node.add_buses(buses);
        }
    }

    fn drives(&self) -> Drives<'_> {
        Drives::Other(&self.path)
    }
}

/// A node that others read or drive.
pub trait LinkedNode: Send + Sync {
    /// Path below the mount point.
    fn path(&self) -> &str;

    /// Opens the node for reading: its converted tuples.
    ///
    /// # Errors
    /// [`Error::Stale`] for a node that a reload has changed or removed; what opening its source says.
    fn open(self: Arc<Self>) -> Result<Device, Error>;

    /// Opens the node for writing, as a program would.
    ///
    /// # Errors
    /// What opening its sink says.
    fn open_sink(self: Arc<Self>) -> Result<Box<dyn Sink>, Error>;

    /// Joins the readers of the newest value; without background sampling the node's source is open from here on. A
    /// device that is gone and is sampled in the background may come back: that is no error.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    fn join_newest(&self) -> Result<(), Error>;

    /// The opposite of [`join_newest`](Self::join_newest).
    fn leave_newest(&self);

    /// Brings the latch up to date: samples now unless the background does.
    ///
    /// # Errors
    /// A node that cannot be entered.
    fn refresh_newest(&self) -> Result<(), Error>;

    /// The node has no sample, and none is on its way.
    fn is_silent(&self) -> bool;

    /// The newest sample.
    fn latch(&self) -> &Latch;

    /// The age from which the newest sample is not to be used. None: it is never too old.
    fn too_old(&self) -> Option<Duration>;

    /// Adds the buses whose transfers a reading or writing of the node waits for.
    fn add_buses(&self, buses: &mut BTreeSet<PathBuf>);
}
