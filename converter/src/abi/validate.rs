//! The checks on a foreign library, over plain copied fields: safe code that any bytes can be thrown at.
//!
//! Knows nothing of pointers; `abi.rs` copies the fields.

use crate::abi::{RawConverter, RawLibrary, VERSION};
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
    pub(crate) fn check(self, what: &str, size: usize) -> Result<(), String> {
        if self.abi_version != VERSION {
            return Err(format!(
                "{what} has abi version {}, this trikfs reads version {VERSION}",
                self.abi_version
            ));
        }
        if (self.size as usize) < size {
            return Err(format!(
                "{what} says that its descriptor has {} bytes, version {VERSION} has {size}",
                self.size
            ));
        }
        Ok(())
    }
}

/// Checks the number of converters and that there is an array of them.
pub(crate) fn check_count(count: u32, has_array: bool) -> Result<(), String> {
    if count == 0 || count as usize > CONVERTERS_MAX {
        return Err(format!(
            "library has {count} converters, the limit is 1 to {CONVERTERS_MAX}"
        ));
    }
    if has_array {
        Ok(())
    } else {
        Err("library has no array of converters".to_owned())
    }
}

/// Checks that no two converters share a name.
pub(crate) fn check_unique<'a>(names: impl Iterator<Item = &'a str>) -> Result<(), String> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(format!("library has two converters named '{name}'"));
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
    pub(crate) fn check(&self, what: &str) -> Result<String, String> {
        let bytes = self.name.ok_or_else(|| format!("{what} has no name"))?;
        let name = name(bytes).map_err(|problem| format!("{what}: {problem}"))?;
        for (way, size) in [("input", self.input_size), ("output", self.output_size)] {
            if size as usize > TUPLE_BYTES_MAX {
                return Err(format!(
                    "converter '{name}' wants {way} tuples of {size} bytes, the limit is {TUPLE_BYTES_MAX}"
                ));
            }
        }
        if !self.has_convert {
            return Err(format!("converter '{name}' has no convert function"));
        }
        Ok(name)
    }
}

/// True for a byte that a converter's name may hold.
pub(crate) const fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_'
}

/// Checks a converter's name.
fn name(bytes: &[u8]) -> Result<String, String> {
    if bytes.is_empty() || bytes.len() > NAME_BYTES_MAX {
        return Err(format!("its name must have 1 to {NAME_BYTES_MAX} bytes"));
    }
    match bytes.iter().position(|byte| !is_name_byte(*byte)) {
        Some(at) => Err(format!("byte {at} of its name is not one of a-z 0-9 _")),
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
    let mut header = |what, size| {
        let header = Header {
            abi_version: word()?,
            size: word()?,
        };
        header.check(what, size).ok()?;
        Some(header)
    };
    if header("library", size_of::<RawLibrary>()).is_none() {
        return;
    }
    let Some(converter) = header("converter", size_of::<RawConverter>()) else {
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
        if let Ok(name) = fields.check("converter") {
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
mod tests {
    use super::*;

    fn fields(name: &[u8]) -> ConverterFields<'_> {
        ConverterFields {
            name: Some(name),
            input_size: 4,
            output_size: 0,
            has_convert: true,
        }
    }

    #[test]
    fn a_newer_minor_with_a_longer_struct_is_accepted_and_a_shorter_one_refused() {
        let header = |abi_version, size| Header { abi_version, size }.check("library", 24);
        assert_eq!(header(1, 24), Ok(()));
        assert_eq!(header(1, u32::MAX), Ok(()));
        assert_eq!(
            header(1, 23).unwrap_err(),
            "library says that its descriptor has 23 bytes, version 1 has 24"
        );
        assert_eq!(
            header(0, 24).unwrap_err(),
            "library has abi version 0, this trikfs reads version 1"
        );
        assert_eq!(
            header(2, 64).unwrap_err(),
            "library has abi version 2, this trikfs reads version 1"
        );
    }

    #[test]
    fn the_number_of_converters_has_a_limit() {
        assert_eq!(check_count(1, true), Ok(()));
        assert_eq!(check_count(256, true), Ok(()));
        assert_eq!(
            check_count(0, true).unwrap_err(),
            "library has 0 converters, the limit is 1 to 256"
        );
        assert_eq!(
            check_count(257, true).unwrap_err(),
            "library has 257 converters, the limit is 1 to 256"
        );
        assert_eq!(
            check_count(1, false).unwrap_err(),
            "library has no array of converters"
        );
    }

    #[test]
    fn names_are_short_and_plain() {
        assert_eq!(fields(b"low_pass_f32").check("c").unwrap(), "low_pass_f32");
        assert_eq!(fields(&[b'a'; 64]).check("c").unwrap().len(), 64);
        assert_eq!(
            fields(&[b'a'; 65]).check("c").unwrap_err(),
            "c: its name must have 1 to 64 bytes"
        );
        assert_eq!(
            fields(b"").check("c").unwrap_err(),
            "c: its name must have 1 to 64 bytes"
        );
        for bad in [
            &b"Median"[..],
            b"a b",
            b"a/b",
            b"\xff",
            b"a\n",
            "\u{44f}".as_bytes(),
        ] {
            assert!(
                fields(bad)
                    .check("c")
                    .unwrap_err()
                    .contains("is not one of a-z 0-9 _")
            );
        }
        let nameless = ConverterFields {
            name: None,
            ..fields(b"")
        };
        assert_eq!(nameless.check("c").unwrap_err(), "c has no name");
    }

    #[test]
    fn sizes_have_a_limit_and_convert_must_exist() {
        let big = ConverterFields {
            input_size: 65_537,
            ..fields(b"a")
        };
        assert_eq!(
            big.check("c").unwrap_err(),
            "converter 'a' wants input tuples of 65537 bytes, the limit is 65536"
        );
        let big = ConverterFields {
            output_size: u32::MAX,
            ..fields(b"a")
        };
        assert!(
            big.check("c")
                .unwrap_err()
                .contains("output tuples of 4294967295 bytes")
        );
        let most = ConverterFields {
            input_size: 65_536,
            output_size: 65_536,
            ..fields(b"a")
        };
        assert!(most.check("c").is_ok());
        let empty = ConverterFields {
            has_convert: false,
            ..fields(b"a")
        };
        assert_eq!(
            empty.check("c").unwrap_err(),
            "converter 'a' has no convert function"
        );
    }

    #[test]
    fn two_converters_of_one_name_are_refused() {
        assert_eq!(check_unique(["a", "b"].into_iter()), Ok(()));
        assert_eq!(
            check_unique(["a", "b", "a"].into_iter()).unwrap_err(),
            "library has two converters named 'a'"
        );
    }

    #[test]
    fn no_bytes_pass_that_break_a_rule() {
        let seed = std::process::id();
        println!("seed {seed}");
        let mut state = seed | 1;
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 17;
            state ^= state << 5;
            state
        };
        for _ in 0..20_000 {
            let mut bytes = Vec::new();
            for plausible in [1, 4096, 1, 4096, 2, 8, 8] {
                let value = if random() % 8 == 0 {
                    random()
                } else {
                    plausible
                };
                bytes.extend(value.to_le_bytes());
            }
            for _ in 0..random() % 80 {
                bytes.push(b"ab_0\0\0Z\xff"[random() as usize % 8]);
            }
            bytes.truncate(random() as usize % 200);
            fuzz_library(&bytes);
        }
    }
}
