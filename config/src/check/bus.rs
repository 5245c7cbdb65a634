//! Sources on a bus, and those that a board does not have: `i2c{...}`, `i2c_bus{...}` and `absent{...}`.
//!
//! Owns which transfers fit which sizes and registers. Opens nothing.

use super::fields::Fields;
use crate::description::{I2cBusDescription, I2cDescription, I2cTransfer, SourceDescription};
use crate::limits::{I2C_BLOCK_BYTES_MAX, I2C_RAW_BYTES_MAX};
use crate::nearest::suggestion;
use crate::problem::Problem;
use crate::search::path_of;
use crate::value::Table;

/// The words of `transfer`.
const TRANSFERS: [(&str, I2cTransfer); 4] = [
    ("byte", I2cTransfer::Byte),
    ("word", I2cTransfer::Word),
    ("block", I2cTransfer::Block),
    ("raw", I2cTransfer::Raw),
];
/// 7-bit addresses below and above these are reserved by the I2C specification.
const ADDRESS_MIN: u32 = 0x03;
const ADDRESS_MAX: u32 = 0x77;
/// Bytes of the reason of an absent source.
const REASON_BYTES_MAX: usize = 200;

/// Bytes of one tuple, if the transfer has a fixed size.
pub(super) fn i2c_size(transfer: I2cTransfer) -> Option<usize> {
    match transfer {
        I2cTransfer::Byte => Some(1),
        I2cTransfer::Word => Some(2),
        I2cTransfer::Block | I2cTransfer::Raw => None,
    }
}

impl<'a> Fields<'_, 'a> {
    /// `i2c{ path, address, register, transfer, ... }`
    pub(super) fn i2c(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        const KEYS: [&str; 9] = [
            "",
            "address",
            "once",
            "path",
            "readable",
            "register",
            "register_bytes",
            "transfer",
            "write_transfer",
        ];
        self.inner(table, |fields| {
            fields.only("i2c", table, &KEYS)?;
            let missing = |field: &str| fields.problem("src", format!("i2c: {field} is missing"));
            let Some(path) = fields.get("path") else {
                return Err(missing("path"));
            };
            let path = path_of(fields.absolute("path", path)?);
            let address = fields
                .whole("address", ADDRESS_MIN, ADDRESS_MAX)?
                .ok_or_else(|| missing("address"))?;
            let register_bytes = fields.whole("register_bytes", 1, 2)?.unwrap_or(1);
            let most = if register_bytes == 1 { 0xff } else { 0xffff };
            let register = fields
                .whole("register", 0, most)?
                .ok_or_else(|| missing("register"))?;
            let transfer = fields
                .transfer("transfer")?
                .ok_or_else(|| missing("transfer"))?;
            let write_transfer = fields.transfer("write_transfer")?.unwrap_or(transfer);
            if register_bytes == 2 && [transfer, write_transfer] != [I2cTransfer::Raw; 2] {
                return Err(fields.problem(
                    "src",
                    "i2c: register_bytes = 2 needs transfer = 'raw'; SMBus registers have one byte",
                ));
            }
            let readable = fields.boolean("readable")?.unwrap_or(true);
            let once = fields.boolean("once")?.unwrap_or(false);
            if once && !readable {
                return Err(fields.problem(
                    "src",
                    "i2c: once makes no sense with readable = false: nothing is ever read",
                ));
            }
            Ok(SourceDescription::I2c(I2cDescription {
                path,
                address: u16::try_from(address).unwrap_or(u16::MAX),
                register: u16::try_from(register).unwrap_or(u16::MAX),
                register_bytes: if register_bytes == 2 { 2 } else { 1 },
                transfer,
                write_transfer,
                readable,
                once,
            }))
        })
    }

    /// `i2c_bus{ path, reserved }`
    pub(super) fn i2c_bus(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("i2c_bus", table, &["", "path", "reserved"])?;
            let Some(path) = fields.get("path") else {
                return Err(fields.problem("src", "i2c_bus: path is missing"));
            };
            let path = path_of(fields.absolute("path", path)?);
            let mut reserved = Vec::new();
            if let Some(value) = fields.get("reserved") {
                let Some(list) = fields.table_of(value) else {
                    return Err(fields.wrong_type("reserved", "a list of addresses", value));
                };
                for value in list.list() {
                    let address =
                        fields.whole_value("reserved", value, ADDRESS_MIN, ADDRESS_MAX)?;
                    reserved.push(u16::try_from(address).unwrap_or(u16::MAX));
                }
            }
            Ok(SourceDescription::I2cBus(I2cBusDescription {
                path,
                reserved,
            }))
        })
    }

    fn transfer(&self, field: &str) -> Result<Option<I2cTransfer>, Problem> {
        let Some(word) = self.text(field, 16)? else {
            return Ok(None);
        };
        let found = TRANSFERS.iter().find(|(name, _)| *name == word);
        match found {
            Some((_, transfer)) => Ok(Some(*transfer)),
            None => {
                let hint = suggestion(word, TRANSFERS.iter().map(|(name, _)| *name));
                let reason = format!(
                    "i2c: {field} must be 'byte', 'word', 'block' or 'raw', not '{word}'{hint}"
                );
                Err(self.problem("src", reason))
            }
        }
    }

    /// The tuple can be read and written with the transfers that were chosen.
    pub(super) fn check_i2c_size(&self, i2c: &I2cDescription, size: usize) -> Result<(), Problem> {
        let check = |field: &str, transfer| {
            let (least, most) = match transfer {
                I2cTransfer::Byte => (1, usize::MAX),
                I2cTransfer::Word => (2, usize::MAX),
                I2cTransfer::Block => (1, I2C_BLOCK_BYTES_MAX),
                I2cTransfer::Raw => (1, I2C_RAW_BYTES_MAX),
            };
            if (least..=most).contains(&size) {
                return Ok(());
            }
            let name = TRANSFERS
                .iter()
                .find(|(_, known)| *known == transfer)
                .map_or("", |(name, _)| *name);
            let limit = if size < least {
                format!("at least {least}")
            } else {
                format!("at most {most}")
            };
            let reason =
                format!("i2c: a tuple has {size} bytes, but {field} = '{name}' takes {limit}");
            Err(self.problem("src", reason))
        };
        check("transfer", i2c.transfer)?;
        check("write_transfer", i2c.write_transfer)
    }

    /// `absent{ reason = '...' }`
    pub(super) fn absent(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("absent", table, &["", "reason"])?;
            let reason = fields.text("reason", REASON_BYTES_MAX)?.unwrap_or_default();
            if reason.trim().is_empty() {
                return Err(fields.problem("src", "absent: reason is missing: say why"));
            }
            Ok(SourceDescription::Absent(reason.to_owned()))
        })
    }
}

#[cfg(test)]
mod tests;
