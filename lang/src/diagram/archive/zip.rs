//! Zip as saves use it: entries that are stored or deflated, no encryption, no parts, no 64-bit extensions.
//!
//! The format is the `zip` crate's; owned here are the limits, which files are let in, and that what is written is the
//! same in each run. The crate keeps one entry for each name and tells only that there were more: the later one counts,
//! and the problem cannot name it.

use super::{Pieces, in_file, words};
use crate::limits;
use crate::problem::{Problem, Severity, Words, keep};
use std::io::{Cursor, Read, Write};
use zip::read::{ArchiveOffset, Config};
use zip::result::ZipError;
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
        let allowed = pieces.allowance(&name, claimed)?;
        let piece = take(&mut zip, at, allowed).map_err(|error| in_file(&name, reason(&error)))?;
        pieces.add(&name, piece);
    }
    Ok(())
}

/// The bytes of an entry, unpacked and compared with their checksum, if there are as many as it should have.
fn take(
    zip: &mut ZipArchive<Cursor<&[u8]>>,
    at: usize,
    allowed: usize,
) -> Result<Vec<u8>, ZipError> {
    // One more, so that a longer piece is seen, and so that the end comes, where the checksum is compared.
    let mut piece = Vec::with_capacity(allowed + 1);
    let limit = allowed as u64 + 1;
    zip.by_index(at)?.take(limit).read_to_end(&mut piece)?;
    match piece.len() == allowed {
        true => Ok(piece),
        false => Err(ZipError::InvalidArchive("length".into())),
    }
}

/// Why an entry cannot be taken.
fn reason(error: &ZipError) -> Words {
    match *error {
        ZipError::UnsupportedArchive(ZipError::PASSWORD_REQUIRED) => words::encrypted(),
        ZipError::CompressionMethodNotSupported(method) => words::method(method),
        // Found while it was read.
        ZipError::Io(ref error) => match error.get_ref().and_then(|inner| inner.downcast_ref()) {
            Some(&ZipError::CompressionMethodNotSupported(method)) => words::method(method),
            _ => words::damaged(),
        },
        _ => words::damaged(),
    }
}

/// A zip that grows.
pub(super) struct Packer {
    inner: ZipWriter<Cursor<Vec<u8>>>,
    count: usize,
    bytes: u64,
}

impl Packer {
    pub(super) fn new() -> Self {
        Self {
            inner: ZipWriter::new(Cursor::default()),
            count: 0,
            bytes: 0,
        }
    }

    /// Adds a file, or a folder if the name ends with `/`.
    pub(super) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Problem> {
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
            let method = match bytes.is_empty() {
                true => CompressionMethod::Stored,
                false => CompressionMethod::Deflated,
            };
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
