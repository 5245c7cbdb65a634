//! `i2c_bus{ path, reserved }`: all registers of all devices on an I2C bus, chosen by the position in the file.
//!
//! Owns its keys. What a position means is not known here.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::limits::{I2C_ADDRESS_MAX, I2C_ADDRESS_MIN};
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `i2c_bus{ path = '/dev/i2c-2', reserved = { 0x48 } }`
#[derive(Clone, Debug, PartialEq)]
pub struct I2cBusDescription {
    /// The bus: a node of i2c-dev, or the socket of a virtual bus.
    pub path: PathBuf,
    /// Addresses of devices that belong to other nodes or to drivers: nobody reaches them through this file.
    pub reserved: Vec<u16>,
}

impl Kind for I2cBusDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "i2c_bus",
        keys: &["path", "reserved"],
        read,
    }];
    const REST: Rest<Self> = Rest::NoDevice;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Unknown
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(Some(1))
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<I2cBusDescription, Problem> {
    let path = fields.own_path("i2c_bus")?;
    let mut reserved = Vec::new();
    if let Some(value) = fields.get("reserved") {
        let Some(list) = fields.table_of(value) else {
            return Err(fields.wrong_type("reserved", "a list of addresses", value));
        };
        for value in list.list() {
            let address =
                fields.whole_value("reserved", value, I2C_ADDRESS_MIN, I2C_ADDRESS_MAX)?;
            reserved.push(u16::try_from(address).unwrap_or(u16::MAX));
        }
    }
    Ok(I2cBusDescription { path, reserved })
}
