//! Is this file a whole shared library? Asked before the dynamic linker sees it, because that maps a file that was cut
//! short, touches what is not there and dies.
//!
//! Looks at the file header and the program headers only (System V ABI, chapter 4 and 5); the linker judges the rest.

use super::refusal::NotLoadable;

/// e_type of a shared object, at this offset.
const ET_DYN: u16 = 3;
const TYPE_AT: usize = 16;
/// p_type of a segment that is mapped from the file.
const PT_LOAD: u32 = 1;

/// Where the fields stand, by class.
struct Layout {
    program_headers_at: usize,
    entry_size_at: usize,
    count_at: usize,
    /// Within a program header.
    offset_at: usize,
    file_size_at: usize,
}

const BITS_32: Layout = Layout {
    program_headers_at: 28,
    entry_size_at: 42,
    count_at: 44,
    offset_at: 4,
    file_size_at: 16,
};

const BITS_64: Layout = Layout {
    program_headers_at: 32,
    entry_size_at: 54,
    count_at: 56,
    offset_at: 8,
    file_size_at: 32,
};

/// Says why `bytes` cannot be a shared library for this machine.
pub(super) fn check(bytes: &[u8]) -> Result<(), NotLoadable> {
    if !bytes.starts_with(b"\x7fELF") {
        return Err(NotLoadable::NotElf);
    }
    let class = *bytes.get(4).ok_or(NotLoadable::Cut)?;
    let order = *bytes.get(5).ok_or(NotLoadable::Cut)?;
    let native_order = if cfg!(target_endian = "little") { 1 } else { 2 };
    let layout = match class {
        1 if size_of::<usize>() == 4 && order == native_order => BITS_32,
        2 if size_of::<usize>() == 8 && order == native_order => BITS_64,
        _ => return Err(NotLoadable::OtherMachine),
    };
    let kind = u16_at(bytes, TYPE_AT).ok_or(NotLoadable::Cut)?;
    if kind != ET_DYN {
        return Err(NotLoadable::OtherKind);
    }
    segments_are_inside(bytes, &layout)
        .filter(|inside| *inside)
        .map(|_| ())
        .ok_or(NotLoadable::Cut)
}

/// Nothing if a header is not there.
fn segments_are_inside(bytes: &[u8], layout: &Layout) -> Option<bool> {
    let start = word_at(bytes, layout.program_headers_at)?;
    let entry_size = usize::from(u16_at(bytes, layout.entry_size_at)?);
    for index in 0..usize::from(u16_at(bytes, layout.count_at)?) {
        let header = start.checked_add(index.checked_mul(entry_size)?)?;
        let kind = u32::from_ne_bytes(*bytes.get(header..)?.first_chunk()?);
        let offset = word_at(bytes, header.checked_add(layout.offset_at)?)?;
        let size = word_at(bytes, header.checked_add(layout.file_size_at)?)?;
        if kind == PT_LOAD && offset.checked_add(size)? > bytes.len() {
            return Some(false);
        }
    }
    Some(true)
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    Some(u16::from_ne_bytes(*bytes.get(at..)?.first_chunk()?))
}

fn word_at(bytes: &[u8], at: usize) -> Option<usize> {
    // `check` compared the class with this machine's, so an address is a usize.
    Some(usize::from_ne_bytes(*bytes.get(at..)?.first_chunk()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The C library's own file, found through the maps of this process.
    fn a_library() -> Vec<u8> {
        let maps = std::fs::read_to_string("/proc/self/maps").expect("maps");
        let path = maps
            .split_whitespace()
            .find(|word| word.starts_with('/') && word.contains(".so"))
            .expect("a loaded library");
        std::fs::read(path).expect("readable")
    }

    #[test]
    fn a_whole_library_passes_and_no_cut_of_it_panics_or_passes_without_its_segments() {
        let whole = a_library();
        assert_eq!(check(&whole), Ok(()));
        for length in (0..2000.min(whole.len())).chain([whole.len() / 2]) {
            check(&whole[..length]).expect_err("cut");
        }
    }

    #[test]
    fn other_files_are_named_for_what_they_are() {
        let library = a_library();
        let changed = |at: usize, byte: u8| {
            let mut bytes = library.clone();
            bytes[at] = byte;
            check(&bytes).expect_err("refused")
        };
        assert_eq!(
            check(b"#!/bin/sh").expect_err("refused"),
            NotLoadable::NotElf
        );
        assert_eq!(
            changed(4, if size_of::<usize>() == 8 { 1 } else { 2 }),
            NotLoadable::OtherMachine
        );
        assert_eq!(changed(16, 1), NotLoadable::OtherKind);
    }

    #[test]
    fn any_header_is_read_without_panic() {
        let seed = 0x5eed_0003_u32;
        println!("seed {seed:#x}");
        let mut random = needs::Random::new(seed);
        let start = a_library()[..4096].to_vec();
        for _ in 0..20_000 {
            let mut bytes = start.clone();
            for _ in 0..4 {
                bytes[6 + random.below(200)] = random.byte();
            }
            let _ = check(&bytes);
        }
    }
}
