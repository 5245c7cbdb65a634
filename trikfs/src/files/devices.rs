//! An open `device` that has no tuples: each read and write is one transfer with what its position stands for.
//!
//! Owns nothing but the open device and who may write it; what a position means is the device's business.

use super::OpenFile;
use super::ownership::Ownership;
use crate::device::Positions;
use crate::errno::Error;
use crate::limits;
use crate::node::Node;
use crate::transport::{Caller, Outcome, RequestId, Transfer};
use std::sync::Arc;

/// One open `device`.
pub struct DevicesFile {
    node: Arc<Node>,
    device: Box<dyn Positions>,
    ownership: Ownership,
}

impl DevicesFile {
    /// Opens the device, if it has no tuples.
    ///
    /// # Errors
    /// The node cannot be opened that way, or its device is not there.
    pub fn open(node: &Arc<Node>, read: bool, write: bool) -> Result<Option<Arc<Self>>, Error> {
        node.check_access(read, write)?;
        let device = node.open_positions()?;
        Ok(device.map(|device| {
            Arc::new(Self {
                node: node.clone(),
                device,
                ownership: Ownership::default(),
            })
        }))
    }

    fn reported<T>(&self, result: Result<T, Error>) -> Result<T, Error> {
        result.inspect_err(|error| self.node.report(error))
    }
}

impl OpenFile for DevicesFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let _inside = self.node.quarantine.enter()?;
        let size = out.len().min(limits::READ_BYTES);
        self.reported(self.device.read(request.offset, &mut out[..size]))?;
        self.node.stats.reads.add(1);
        Ok(Outcome::Done(size))
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let _inside = self.node.quarantine.enter()?;
        let _admitted = self.ownership.admit(&self.node, request.caller)?;
        self.reported(self.device.write(request.offset, data))?;
        self.node.stats.writes.add(1);
        Ok(Outcome::Done(data.len()))
    }

    fn flush(&self, _id: RequestId, caller: Caller) -> Result<Outcome, Error> {
        self.ownership.closed(&self.node, caller);
        Ok(Outcome::Done(0))
    }

    fn release(&self) {
        self.ownership.released(&self.node);
    }
}
