//! An open `device` of a whole I2C bus: each read and write is one transfer with the register at its position.
//!
//! Owns nothing but the two; what a position means is the bus's business.

use super::OpenFile;
use super::ownership::Ownership;
use crate::device::i2c::devices::Devices;
use crate::errno::Error;
use crate::limits;
use crate::node::Node;
use crate::transport::{Caller, Outcome, RequestId, Transfer};
use config::description::I2cBusDescription;
use std::sync::Arc;

/// One open `device`.
pub struct DevicesFile {
    node: Arc<Node>,
    devices: Devices,
    ownership: Ownership,
}

impl DevicesFile {
    /// Opens the bus, which must be there.
    pub fn open(
        node: &Arc<Node>,
        bus: &I2cBusDescription,
        read: bool,
        write: bool,
    ) -> Result<Arc<Self>, Error> {
        node.check_access(read, write)?;
        Ok(Arc::new(Self {
            node: node.clone(),
            devices: Devices::open(bus, node.description.timeout_ms, &node.engine)?,
            ownership: Ownership::default(),
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
        self.reported(self.devices.read(request.offset, &mut out[..size]))?;
        self.node.stats.reads.add(1);
        Ok(Outcome::Done(size))
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let _inside = self.node.quarantine.enter()?;
        let _admitted = self.ownership.admit(&self.node, request.caller)?;
        self.reported(self.devices.write(request.offset, data))?;
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
