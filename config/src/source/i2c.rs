//! `i2c{ path, address, register, transfer, ... }`: a register of a device on an I2C bus.
//!
//! Owns which transfers fit which sizes and registers, and what a rest needs of it.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::{Form, Rest, position, put_path};
use crate::fields::Fields;
use crate::limits::{I2C_ADDRESS_MAX, I2C_ADDRESS_MIN, I2C_BLOCK_BYTES_MAX, I2C_RAW_BYTES_MAX};
use crate::nearest::suggestion;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// The words of `transfer`; their positions are their numbers in the form of a device.
const TRANSFERS: [(&str, I2cTransfer); 4] = [
    ("byte", I2cTransfer::Byte),
    ("word", I2cTransfer::Word),
    ("block", I2cTransfer::Block),
    ("raw", I2cTransfer::Raw),
];
/// How the bytes of a register travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum I2cTransfer {
    /// SMBus byte data: one byte.
    Byte,
    /// SMBus word data: two bytes, low byte first as on the wire.
    Word,
    /// I2C block data of the SMBus layer: 1 to 32 bytes.
    Block,
    /// Plain I2C messages: register bytes out, repeated start, data in; or register bytes and data out.
    Raw,
}

/// `i2c{ path = '/dev/i2c-2', address = 0x48, register = 0x25, transfer = 'word' }`
#[derive(Clone, Debug, PartialEq)]
pub struct I2cDescription {
    /// The bus: a node of i2c-dev, or the socket of a virtual bus.
    pub path: PathBuf,
    /// 7-bit address of the device.
    pub address: u16,
    /// First register of the tuple.
    pub register: u16,
    /// Bytes of the register number on the wire, 1 or 2, high byte first.
    pub register_bytes: u8,
    /// How a tuple is read.
    pub transfer: I2cTransfer,
    /// How the beginning of a tuple is written.
    pub write_transfer: I2cTransfer,
    /// False: the device cannot be read back; reading gives what was written last.
    pub readable: bool,
    /// Read once after the bus was opened, then remembered.
    pub once: bool,
}

impl Kind for I2cDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "i2c",
        keys: &[
            "address",
            "once",
            "path",
            "readable",
            "register",
            "register_bytes",
            "transfer",
            "write_transfer",
        ],
        read,
    }];
    const REST: Rest<Self> = Rest::Device(Form {
        tag: 4,
        put: |i2c, out| {
            put_path(&i2c.path, out)?;
            out.extend_from_slice(&i2c.address.to_le_bytes());
            out.extend_from_slice(&i2c.register.to_le_bytes());
            out.push(i2c.register_bytes);
            out.push(position(
                &TRANSFERS.map(|(_, transfer)| transfer),
                &i2c.write_transfer,
            )?);
            Some(())
        },
        take: |bytes| {
            let path = bytes.path()?;
            let address = bytes.u16().filter(|address| *address < 128)?;
            let register = bytes.u16()?;
            let register_bytes = bytes.u8().filter(|count| (1..=2).contains(count))?;
            let (_, transfer) = *TRANSFERS.get(usize::from(bytes.u8()?))?;
            Some(Self {
                path,
                address,
                register,
                register_bytes,
                transfer,
                write_transfer: transfer,
                readable: true,
                once: false,
            })
        },
    });

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::State
    }

    fn keeps_what_is_written(&self) -> bool {
        true
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(match self.transfer {
            I2cTransfer::Byte => Some(1),
            I2cTransfer::Word => Some(2),
            I2cTransfer::Block | I2cTransfer::Raw => None,
        })
    }

    /// The tuple can be read and written with the transfers that were chosen.
    fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
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
            Err(fields.problem("src", reason))
        };
        check("transfer", self.transfer)?;
        check("write_transfer", self.write_transfer)
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<I2cDescription, Problem> {
    let missing = |field: &str| fields.problem("src", format!("i2c: {field} is missing"));
    let path = fields.own_path("i2c")?;
    let address = fields
        .whole("address", I2C_ADDRESS_MIN, I2C_ADDRESS_MAX)?
        .ok_or_else(|| missing("address"))?;
    let register_bytes = fields.whole("register_bytes", 1, 2)?.unwrap_or(1);
    let most = if register_bytes == 1 { 0xff } else { 0xffff };
    let register = fields
        .whole("register", 0, most)?
        .ok_or_else(|| missing("register"))?;
    let transfer = transfer_of(fields, "transfer")?.ok_or_else(|| missing("transfer"))?;
    let write_transfer = transfer_of(fields, "write_transfer")?.unwrap_or(transfer);
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
    Ok(I2cDescription {
        path,
        address: u16::try_from(address).unwrap_or(u16::MAX),
        register: u16::try_from(register).unwrap_or(u16::MAX),
        register_bytes: if register_bytes == 2 { 2 } else { 1 },
        transfer,
        write_transfer,
        readable,
        once,
    })
}

/// One of the words of `transfer`.
fn transfer_of(fields: &Fields<'_>, field: &str) -> Result<Option<I2cTransfer>, Problem> {
    let Some(word) = fields.text(field, 16)? else {
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
            Err(fields.problem("src", reason))
        }
    }
}
