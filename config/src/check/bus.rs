//! Sources on a bus, and those that a board does not have: `i2c{...}` and `absent{...}`.
//!
//! Owns which transfers fit which sizes and registers. Opens nothing.

use super::fields::Fields;
use crate::description::{I2cDescription, I2cTransfer, SourceDescription};
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
mod tests {
    use crate::description::{I2cDescription, I2cTransfer, SourceDescription};
    use crate::load::Loader;

    fn source(src: &str, more: &str) -> Result<(SourceDescription, usize, u16), String> {
        let text = format!("trikfs = {{ x = {{\nsrc = {src}, {more} }} }}");
        let loaded = Loader::default().load("robot.lua", None, text.as_bytes());
        let node = loaded.map_err(|problem| problem.to_string())?.config.nodes;
        Ok((
            node[0].source.clone(),
            node[0].input_tuple_size,
            node[0].mode,
        ))
    }

    fn refused(src: &str, more: &str) -> String {
        source(src, more).unwrap_err()
    }

    #[test]
    fn a_register_has_the_defaults_of_the_manual() {
        let word = "i2c{ path = '/dev/i2c-2', address = 0x48, register = 0x25, transfer = 'word' }";
        let expected = I2cDescription {
            path: "/dev/i2c-2".into(),
            address: 0x48,
            register: 0x25,
            register_bytes: 1,
            transfer: I2cTransfer::Word,
            write_transfer: I2cTransfer::Word,
            readable: true,
            once: false,
        };
        assert_eq!(
            source(word, ""),
            Ok((SourceDescription::I2c(expected), 2, 0o644))
        );
        let block = "i2c{ '/dev/i2c-2', address = 0x48, register = 0x30, transfer = 'block', write_transfer = 'byte' }";
        let Ok((SourceDescription::I2c(block), 4, _)) = source(block, "format = 'i32 ticks'")
        else {
            panic!("{:?}", source(block, "format = 'i32 ticks'"))
        };
        assert_eq!(
            (block.transfer, block.write_transfer),
            (I2cTransfer::Block, I2cTransfer::Byte)
        );
        let raw = "i2c{ path = '/dev/i2c-1', address = 0x33, register = 0x2400, register_bytes = 2, transfer = 'raw', once = true }";
        let Ok((SourceDescription::I2c(raw), 1664, _)) = source(raw, "input_tuple_size = 1664")
        else {
            panic!("raw")
        };
        assert_eq!(
            (raw.register, raw.register_bytes, raw.once),
            (0x2400, 2, true)
        );
    }

    const AT: &str = "robot.lua:2: x: ";

    fn i2c(rest: &str) -> String {
        format!("i2c{{ path = '/dev/i2c-2', {rest} }}")
    }

    fn wrong_registers() -> Vec<(String, &'static str)> {
        vec![
            (
                i2c("register = 1, transfer = 'byte'"),
                "i2c: address is missing",
            ),
            (
                i2c("address = 0x48, transfer = 'byte'"),
                "i2c: register is missing",
            ),
            (
                i2c("address = 0x48, register = 1"),
                "i2c: transfer is missing",
            ),
            (
                "i2c{ address = 0x48, register = 1, transfer = 'byte' }".to_owned(),
                "i2c: path is missing",
            ),
            (
                i2c("address = 0x78, register = 1, transfer = 'byte'"),
                "address must be a whole number from 3 to 119, not 120",
            ),
            (
                i2c("address = '0x48', register = 1, transfer = 'byte'"),
                "address must be a number, not a string",
            ),
            (
                i2c("address = 0x48, register = 256, transfer = 'byte'"),
                "register must be a whole number from 0 to 255, not 256",
            ),
            (
                i2c("address = 0x48, register = 1, transfer = 'bytes'"),
                "i2c: transfer must be 'byte', 'word', 'block' or 'raw', not 'bytes', did you mean 'byte'",
            ),
            (
                i2c("address = 0x48, register = 1, register_bytes = 2, transfer = 'word'"),
                "i2c: register_bytes = 2 needs transfer = 'raw'; SMBus registers have one byte",
            ),
            (
                i2c(
                    "address = 0x48, register = 1, transfer = 'byte', once = true, readable = false",
                ),
                "i2c: once makes no sense with readable = false: nothing is ever read",
            ),
            (
                i2c("address = 0x48, register = 1, transfer = 'byte', speed = 1"),
                "i2c: unknown key 'speed'",
            ),
            (
                i2c("address = 0x48, register = 1, transfer = 'block', write_transfer = 'word'"),
                "i2c: a tuple has 1 bytes, but write_transfer = 'word' takes at least 2",
            ),
            ("absent{}".to_owned(), "absent: reason is missing: say why"),
            (
                "absent{ reason = 'no', why = 1 }".to_owned(),
                "absent: unknown key 'why'",
            ),
        ]
    }

    #[test]
    fn what_no_bus_can_do_is_refused() {
        for (src, reason) in wrong_registers() {
            let more = if src.contains("block") || src.contains("absent") {
                "input_tuple_size = 1"
            } else {
                ""
            };
            assert_eq!(refused(&src, more), format!("{AT}{reason}"), "{src}");
        }
    }

    #[test]
    fn sizes_that_no_transfer_has_are_refused() {
        let i2c = |rest: &str| format!("i2c{{ path = '/dev/i2c-2', {rest} }}");
        let at = "robot.lua:2: x: ";
        let block = i2c("address = 0x48, register = 1, transfer = 'block'");
        assert_eq!(
            refused(&block, "input_tuple_size = 33"),
            format!("{AT}i2c: a tuple has 33 bytes, but transfer = 'block' takes at most 32")
        );
        let word = i2c("address = 0x48, register = 1, transfer = 'word'");
        assert_eq!(
            refused(&word, "input_tuple_size = 4"),
            format!("{AT}input_tuple_size is 4, but the source gives tuples of 2 bytes")
        );
    }

    #[test]
    fn an_absent_port_is_described_like_one_that_is_there() {
        let absent = source(
            "absent{ reason = 'no such port on this board' }",
            "format = 'i8 power', rest = 0",
        );
        let expected = SourceDescription::Absent("no such port on this board".to_owned());
        assert_eq!(absent, Ok((expected, 1, 0o644)));
    }
}
