//! The checks on a foreign library, over plain copied fields: safe code that any bytes can be thrown at.
//!
//! Knows nothing of pointers; `abi.rs` copies the fields.

use crate::abi::{RawConverter, RawLibrary, VERSION};
use crate::error::{LibraryFault, Part, Side};
use crate::limits::{CONVERTERS_MAX, NAME_BYTES_MAX, TUPLE_BYTES_MAX};
use std::collections::BTreeSet;

/// What every struct of every version begins with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Header {
    pub(crate) abi_version: u32,
    pub(crate) size: u32,
}

impl Header {
    /// Checks that a struct can be read as ours, which has `size` bytes. A longer one is from a newer header and fine.
    pub(crate) fn check(self, part: Part, size: usize) -> Result<(), LibraryFault> {
        if self.abi_version != VERSION {
            return Err(LibraryFault::Version {
                part,
                found: self.abi_version,
                ours: VERSION,
            });
        }
        if (self.size as usize) < size {
            return Err(LibraryFault::Short {
                part,
                bytes: self.size,
                least: size,
                version: VERSION,
            });
        }
        Ok(())
    }
}

/// Checks the number of converters and that there is an array of them.
pub(crate) fn check_count(count: u32, has_array: bool) -> Result<(), LibraryFault> {
    if count == 0 || count as usize > CONVERTERS_MAX {
        return Err(LibraryFault::Count(count));
    }
    if has_array {
        Ok(())
    } else {
        Err(LibraryFault::NoArray)
    }
}

/// Checks that no two converters share a name.
pub(crate) fn check_unique<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), LibraryFault> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(LibraryFault::Twice(name.to_owned()));
        }
    }
    Ok(())
}

/// The fields of one converter that can be wrong without being unreadable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ConverterFields<'a> {
    /// Bytes before the zero byte, or one more than the limit; absent for a null pointer.
    pub(crate) name: Option<&'a [u8]>,
    pub(crate) input_size: u32,
    pub(crate) output_size: u32,
    pub(crate) has_convert: bool,
}

impl ConverterFields<'_> {
    /// Checks everything and returns the name.
    pub(crate) fn check(&self, part: Part) -> Result<String, LibraryFault> {
        let bytes = self.name.ok_or(LibraryFault::Nameless(part))?;
        let name = name(part, bytes)?;
        for (side, size) in [
            (Side::Input, self.input_size),
            (Side::Output, self.output_size),
        ] {
            if size as usize > TUPLE_BYTES_MAX {
                return Err(LibraryFault::TupleSize {
                    converter: name,
                    side,
                    bytes: size,
                });
            }
        }
        if !self.has_convert {
            return Err(LibraryFault::NoConvert(name));
        }
        Ok(name)
    }
}

/// True for a byte that a converter's name may hold.
pub(crate) const fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_'
}

/// Checks a converter's name.
fn name(part: Part, bytes: &[u8]) -> Result<String, LibraryFault> {
    if bytes.is_empty() || bytes.len() > NAME_BYTES_MAX {
        return Err(LibraryFault::NameLength(part));
    }
    match bytes.iter().position(|byte| !is_name_byte(*byte)) {
        Some(at) => Err(LibraryFault::NameByte(part, at)),
        None => Ok(bytes.iter().copied().map(char::from).collect()),
    }
}

/// Fuzz target: reads any bytes as the fields of a library and checks them.
///
/// Panics only if something passes that must not.
pub fn fuzz_library(bytes: &[u8]) {
    let mut rest = bytes;
    let mut word = || {
        let (head, tail) = rest.split_at_checked(4)?;
        rest = tail;
        Some(u32::from_le_bytes(head.try_into().ok()?))
    };
    let mut header = |part, size| {
        let header = Header {
            abi_version: word()?,
            size: word()?,
        };
        header.check(part, size).ok()?;
        Some(header)
    };
    if header(Part::Library, size_of::<RawLibrary>()).is_none() {
        return;
    }
    let Some(converter) = header(Part::Converter(0), size_of::<RawConverter>()) else {
        return;
    };
    assert!(
        converter.abi_version == VERSION && converter.size as usize >= size_of::<RawConverter>()
    );
    let (Some(count), Some(input_size), Some(output_size)) = (word(), word(), word()) else {
        return;
    };
    if check_count(count, true).is_ok() {
        assert!((1..=CONVERTERS_MAX).contains(&(count as usize)));
    }
    let names: Vec<&[u8]> = rest.split(|byte| *byte == 0).collect();
    let mut accepted = Vec::new();
    for bytes in names {
        let fields = ConverterFields {
            name: Some(bytes),
            input_size,
            output_size,
            has_convert: true,
        };
        if let Ok(name) = fields.check(Part::Converter(0)) {
            assert!(
                !name.is_empty() && name.len() <= NAME_BYTES_MAX && name.bytes().all(is_name_byte)
            );
            assert!(input_size.max(output_size) as usize <= TUPLE_BYTES_MAX);
            accepted.push(name);
        }
    }
    let distinct: BTreeSet<&String> = accepted.iter().collect();
    assert_eq!(
        check_unique(accepted.iter().map(String::as_str)).is_ok(),
        distinct.len() == accepted.len()
    );
}

#[cfg(test)]
mod tests;
