//! Zip as saves use it: entries that are stored or deflated, no encryption, no parts, no 64-bit extensions.
//!
//! The format is the `zip` crate's; owned here are the limits, which files are let in, and that what is written is the
//! same in each run. The crate keeps one entry for each name and tells only that there were more: the later one counts,
//! and the problem cannot name it.

use super::deflate::{Unpacker, checksum};
use super::{Pieces, in_file, words};
use crate::limits;
use lang_text::problem::{Problem, Severity, Words, keep};
use std::io::{Cursor, Read, Write};
use zip::read::{ArchiveOffset, Config};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipArchive, ZipWriter};

/// What stands before the end of a zip with 64-bit extensions.
const LOCATOR_64: &[u8] = b"PK\x06\x07";
/// The locator, the end, and the longest remark after it.
const END_BYTES: usize = 20 + 22 + 0xffff;

pub(super) fn unpack(bytes: &[u8], pieces: &mut Pieces<'_>) -> Result<(), Problem> {
    // Without them a zip lists no more files than a save may have, and the list is what the crate takes memory for
    // before it can be asked.
    let end = &bytes[bytes.len().saturating_sub(END_BYTES)..];
    if end.windows(4).any(|four| four == LOCATOR_64) {
        return Err(Problem::error(words::extensions_64()));
    }
    let config = Config {
        archive_offset: ArchiveOffset::Known(0),
    };
    let damaged = |_| Problem::error(words::zip_damaged());
    let mut zip = ZipArchive::with_config(config, Cursor::new(bytes)).map_err(damaged)?;
    if zip.has_duplicate_names() {
        let mut problem = Problem::error(words::some_twice());
        problem.severity = Severity::Warning;
        keep(pieces.problems, problem);
    }
    // An honest zip holds each packed byte once; one that counts bytes twice wants to cost time.
    let mut budget = bytes.len() as u64;
    let mut list = Vec::with_capacity(zip.len());
    for at in 0..zip.len() {
        pieces.count()?;
        let entry = zip.by_index_data(at).map_err(damaged)?;
        if entry.name_raw().len() > limits::ENTRY_NAME_BYTES {
            return Err(Problem::error(words::zip_damaged()));
        }
        let name = String::from_utf8_lossy(entry.name_raw()).into_owned();
        budget = budget
            .checked_sub(entry.compressed_size())
            .ok_or_else(|| in_file(&name, words::overlaps()))?;
        let claimed = usize::try_from(entry.size()).unwrap_or(usize::MAX);
        let packed = usize::try_from(entry.compressed_size()).unwrap_or(usize::MAX);
        pieces.admit(&name, packed, claimed)?;
        list.push((name, claimed));
    }
    let mut unpacker = Unpacker::bare();
    for (at, (name, claimed)) in list.into_iter().enumerate() {
        let piece = take(&mut zip, at, claimed, &mut unpacker);
        let piece = piece.map_err(|words| in_file(&name, words))?;
        pieces.add(&name, piece);
    }
    Ok(())
}

/// The bytes of an entry, unpacked and compared with their checksum, if there are as many as it should have.
///
/// Unpacks by itself: the crate makes tables of 40 KiB for each entry anew, and what is kept beside them leaves holes of
/// that size in memory, 700 MiB in a save of 10000 blocks.
#[expect(deprecated, reason = "nothing else tells the number of a method")]
fn take(
    zip: &mut ZipArchive<Cursor<&[u8]>>,
    at: usize,
    allowed: usize,
    unpacker: &mut Unpacker,
) -> Result<Vec<u8>, Words> {
    let mut file = zip.by_index_raw(at).map_err(|_| words::damaged())?;
    if file.encrypted() {
        return Err(words::encrypted());
    }
    let mut packed = Vec::new();
    file.read_to_end(&mut packed)
        .map_err(|_| words::damaged())?;
    let piece = match file.compression() {
        CompressionMethod::Stored => (packed.len() == allowed).then_some(packed),
        CompressionMethod::Deflated => unpacker.unpack(&packed, allowed),
        CompressionMethod::Unsupported(number) => return Err(words::method(number)),
        _ => return Err(words::damaged()),
    };
    let is_whole = |piece: &Vec<u8>| checksum(piece) == file.crc32();
    piece.filter(is_whole).ok_or_else(words::damaged)
}

/// A zip that grows.
pub(super) struct Packer {
    inner: ZipWriter<Cursor<Vec<u8>>>,
    count: usize,
    bytes: u64,
    /// Files are compressed.
    is_packing: bool,
}

impl Packer {
    pub(super) fn new() -> Self {
        Self {
            inner: ZipWriter::new(Cursor::default()),
            count: 0,
            bytes: 0,
            is_packing: true,
        }
    }

    /// One whose files are not compressed.
    pub(super) fn storing() -> Self {
        Self {
            is_packing: false,
            ..Self::new()
        }
    }

    /// Adds a file, or a folder if the name ends with `/`.
    pub(super) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Problem> {
        let method = match bytes.is_empty() || !self.is_packing {
            true => CompressionMethod::Stored,
            false => CompressionMethod::Deflated,
        };
        self.add_by(method, name, bytes)
    }

    /// Adds a file as it is.
    pub(super) fn add_stored(&mut self, name: &str, bytes: &[u8]) -> Result<(), Problem> {
        self.add_by(CompressionMethod::Stored, name, bytes)
    }

    fn add_by(
        &mut self,
        method: CompressionMethod,
        name: &str,
        bytes: &[u8],
    ) -> Result<(), Problem> {
        self.count += 1;
        if self.count > limits::ENTRIES {
            return Err(in_file(name, words::too_many()));
        }
        self.bytes += bytes.len() as u64;
        if self.bytes > u64::from(u32::MAX) {
            return Err(in_file(name, words::too_large(bytes.len())));
        }
        let options = SimpleFileOptions::default()
            .system(System::Unix)
            // 1 January 1980, the first day that the format can name.
            .last_modified_time(DateTime::default());
        let outcome = if name.ends_with('/') {
            self.inner
                .add_directory(name, options.unix_permissions(0o755))
        } else {
            let options = options.unix_permissions(0o644).compression_method(method);
            let started = self.inner.start_file(name, options);
            started.and_then(|()| Ok(self.inner.write_all(bytes)?))
        };
        outcome.map_err(|_| in_file(name, words::not_packed()))
    }

    /// The whole zip.
    pub(super) fn finish(self) -> Result<Vec<u8>, Problem> {
        let whole = self.inner.finish();
        let whole = whole.map_err(|_| Problem::error(words::too_many()))?;
        Ok(whole.into_inner())
    }
}
