//! Any register of any device on an I2C bus, chosen by the position in a file, as /dev/cpu/0/msr chooses registers.
//!
//! Owns what a position means: the register in its low 16 bits, the address of the device above them, and
//! [`WIDE`] for registers whose number has two bytes on the wire. Bytes travel as plain messages, in the order of the
//! wire. Knows no open file and no program.

use super::super::{Device, Kind, Positions, Sink, Surroundings};
use super::bus::InUse;
use super::{Data, Transfer};
use crate::errno::Error;
use config::description::{I2cBusDescription, I2cTransfer};
use config::limits::I2C_RAW_BYTES_MAX;
use std::time::Duration;

/// In a position: the number of the register has two bytes on the wire, the high one first.
pub const WIDE: u64 = 1 << 24;

impl Kind for I2cBusDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Err(only_device())
    }

    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Err(only_device())
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }

    /// The bus must be there.
    fn open_positions(&self, around: &Surroundings) -> Result<Option<Box<dyn Positions>>, Error> {
        let bus = InUse::new(around.buses.get(&self.path));
        bus.check()?;
        Ok(Some(Box::new(Devices {
            bus,
            reserved: self.reserved.clone(),
            timeout: Duration::from_millis(around.timeout_ms.into()),
        })))
    }
}

/// What all other files of such a node say.
fn only_device() -> Error {
    Error::Invalid(
        "all devices of a bus: only the file `device` can be read and written, at the position of a register"
            .to_owned(),
    )
}

/// The devices of one bus.
struct Devices {
    bus: InUse,
    reserved: Vec<u16>,
    timeout: Duration,
}

/// One register, as a position names it.
struct Place {
    address: u16,
    register: [u8; 2],
    is_wide: bool,
}

impl Place {
    fn of(position: u64) -> Result<Self, Error> {
        let register = (position & 0xffff) as u16;
        let address = (position >> 16 & 0xff) as u16;
        let is_wide = position & WIDE != 0;
        let wrong = |what: String| {
            Err(Error::Invalid(format!(
                "position {position:#x}: {what}; a position is 0x10000 times the address and the register, and 0x1000000 more for registers of two bytes"
            )))
        };
        if position >= 2 * WIDE || !(0x03..=0x77).contains(&address) {
            return wrong(format!("address {:#x} is not 0x03 to 0x77", position >> 16));
        }
        if !is_wide && register > 0xff {
            return wrong(format!("register {register:#x} has more than one byte"));
        }
        Ok(Self {
            address,
            register: register.to_be_bytes(),
            is_wide,
        })
    }
}

impl Devices {
    fn transfer(&self, position: u64, data: Data<'_>) -> Result<(), Error> {
        let place = Place::of(position)?;
        if self.reserved.contains(&place.address) {
            return Err(Error::Reserved(format!(
                "the device at address {:#x} has nodes or a driver of its own; nothing is sent to it from here",
                place.address
            )));
        }
        let bytes = match &data {
            Data::Read(buffer) => buffer.len(),
            Data::Write(bytes) => bytes.len(),
        };
        if !(1..=I2C_RAW_BYTES_MAX).contains(&bytes) {
            return Err(Error::Invalid(format!(
                "{bytes} bytes: one transfer has 1 to {I2C_RAW_BYTES_MAX}"
            )));
        }
        let mut transfer = Transfer {
            address: place.address,
            kind: I2cTransfer::Raw,
            register: &place.register[usize::from(!place.is_wide)..],
            data,
        };
        self.bus.transfer(&mut transfer, self.timeout)
    }
}

impl Positions for Devices {
    fn read(&self, position: u64, buffer: &mut [u8]) -> Result<(), Error> {
        self.transfer(position, Data::Read(buffer))
    }

    fn write(&self, position: u64, bytes: &[u8]) -> Result<(), Error> {
        self.transfer(position, Data::Write(bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_names_address_and_register() {
        let place = Place::of(0x50_0010).unwrap();
        assert_eq!((place.address, place.register), (0x50, [0, 0x10]));
        assert!(!place.is_wide);
        let place = Place::of(WIDE | 0x33_2400).unwrap();
        assert_eq!((place.address, place.register), (0x33, [0x24, 0]));
        assert!(place.is_wide);
        for position in [
            0,
            0x02_0000,
            0x78_0000,
            0x50_0100,
            (2 * WIDE) | 0x50_0000,
            u64::MAX,
        ] {
            let refusal = Place::of(position).map(|_| ()).unwrap_err();
            assert!(matches!(refusal, Error::Invalid(_)), "{position:#x}");
        }
    }
}
