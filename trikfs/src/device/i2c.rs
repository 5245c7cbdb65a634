//! Registers of devices on an I2C bus: a state that is sampled with one transfer, and a sink that writes with one.
//!
//! Owns what a tuple means: which bytes are sent, what is remembered, what an error is called. `bus` owns the buses and
//! the turns on each of them, `adapter` the calls of i2c-dev, `virtual_bus` the socket that stands in for it, and `devices`
//! reaches any register of a bus.

mod adapter;
pub mod bus;
pub mod devices;
mod virtual_bus;

use super::{Device, Kind, Sink, State, Surroundings};
use crate::bytes::copy_at;
use crate::errno::Error;
use bus::{Buses, InUse, Key};
use config::description::{I2cDescription, I2cTransfer};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Duration;

impl Kind for I2cDescription {
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        let register = Register::open(self, tuple_size, around.timeout_ms, &around.buses)?;
        Ok(Device::State(Box::new(register)))
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        // The size only matters for reading.
        let register = Register::open(self, 0, around.timeout_ms, &around.buses)?;
        Ok(Box::new(register))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }

    fn add_buses(&self, _around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        buses.insert(self.path.clone());
    }
}

/// What one transfer moves.
pub(super) enum Data<'a> {
    /// From the device.
    Read(&'a mut [u8]),
    /// To the device.
    Write(&'a [u8]),
}

/// One transaction on a bus.
pub(super) struct Transfer<'a> {
    /// 7 bits.
    address: u16,
    /// How the bytes travel.
    kind: I2cTransfer,
    /// One or two bytes, as on the wire.
    register: &'a [u8],
    data: Data<'a>,
}

/// A register, open for reading or writing.
pub struct Register {
    bus: InUse,
    description: I2cDescription,
    tuple_size: usize,
    timeout: Duration,
    /// The tuple that reading on from inside it goes on in.
    current: Vec<u8>,
}

impl Register {
    /// Opens a register of a bus that is there. The bus itself is opened at the first transfer.
    pub fn open(
        description: &I2cDescription,
        tuple_size: usize,
        timeout_ms: u32,
        buses: &Buses,
    ) -> Result<Self, Error> {
        let bus = InUse::new(buses.get(&description.path));
        bus.check()?;
        Ok(Self {
            bus,
            description: description.clone(),
            tuple_size,
            timeout: Duration::from_millis(timeout_ms.into()),
            current: Vec::new(),
        })
    }

    fn key(&self) -> Key {
        (self.description.address, self.description.register)
    }

    fn transfer(&self, kind: I2cTransfer, data: Data<'_>) -> Result<(), Error> {
        let high_first = self.description.register.to_be_bytes();
        let register = match self.description.register_bytes {
            2 => &high_first[..],
            _ => &high_first[1..],
        };
        let mut transfer = Transfer {
            address: self.description.address,
            kind,
            register,
            data,
        };
        self.bus.transfer(&mut transfer, self.timeout)
    }

    /// Fills a tuple with what the register holds.
    fn sample(&self, tuple: &mut [u8]) -> Result<(), Error> {
        if !self.description.readable {
            self.bus.written(self.key(), tuple);
            return Ok(());
        }
        if self.description.once && self.bus.remembered(self.key(), tuple) {
            return Ok(());
        }
        self.transfer(self.description.transfer, Data::Read(tuple))?;
        if self.description.once {
            self.bus.remember(self.key(), tuple);
        }
        Ok(())
    }
}

impl State for Register {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            let mut tuple = std::mem::take(&mut self.current);
            tuple.clear();
            tuple.resize(self.tuple_size, 0);
            self.sample(&mut tuple)?;
            self.current = tuple;
        }
        Ok(copy_at(&self.current, offset, buf))
    }
}

impl Sink for Register {
    /// As with an attribute the device is always waited for: it takes bytes as soon as the bus is free.
    fn write(&mut self, tuple: &[u8], _waits: bool) -> Result<(), Error> {
        let kind = self.description.write_transfer;
        let sent = match kind {
            I2cTransfer::Byte => tuple.get(..1),
            I2cTransfer::Word => tuple.get(..2),
            I2cTransfer::Block | I2cTransfer::Raw => Some(tuple),
        };
        let sent = sent.ok_or_else(|| Error::Invalid("the tuple is too short".to_owned()))?;
        self.transfer(kind, Data::Write(sent))?;
        if self.description.readable {
            self.bus.forget(self.key());
        } else {
            self.bus.wrote(self.key(), tuple);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
