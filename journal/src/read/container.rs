//! The container of a recording: where its parts are, and whether they are whole.
//!
//! Owns every check of lengths, places and checksums, made before memory is taken or bytes are believed, and the way of chunks
//! into the indexed reader of the library. What messages mean is not known here.

use crate::chunk::{Chunk, HEADER_BYTES};
use crate::error::Error;
use crate::limits::{INFLATION_MAX, RECORD_BYTES_MAX, SUMMARY_BYTES_MAX};
use crate::shape::is_whole;
use mcap::Summary;
use mcap::records::op;
use mcap::sans_io::{
    IndexedReadEvent, IndexedReader, IndexedReaderOptions, SummaryReadEvent, SummaryReader,
    SummaryReaderOptions,
};
use std::io::{BufReader, Read, Seek, SeekFrom};

/// Bytes of a footer with its head, and of the magic after it.
const FOOTER_BYTES: u64 = 9 + 20;
const MAGIC_BYTES: u64 = 8;

/// The summary of a recording.
///
/// # Errors
/// It is none, it is cut, or its end contradicts itself.
pub(crate) fn summary_of<F: Read + Seek>(file: &mut F) -> Result<Summary, Error> {
    let size = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    let mut magic = [0; MAGIC_BYTES as usize];
    let begins = file.read_exact(&mut magic);
    if begins.is_err() || magic != *mcap::MAGIC {
        return Err(Error::NotARecording);
    }
    if size < 2 * MAGIC_BYTES + FOOTER_BYTES {
        return Err(Error::Cut);
    }
    file.seek(SeekFrom::End(-(MAGIC_BYTES as i64)))?;
    file.read_exact(&mut magic)?;
    if magic != *mcap::MAGIC {
        return Err(Error::Cut);
    }
    let (start, bytes) = check_footer(file, size)?;
    check_records(file, start, bytes)?;
    summary(file, size)
}

/// The library trusts the lengths inside the records of a summary with memory.
fn check_records<F: Read + Seek>(file: &mut F, start: u64, bytes: u64) -> Result<(), Error> {
    let damaged = || Error::Damaged("its summary has a record that is none".to_owned());
    file.seek(SeekFrom::Start(start))?;
    let mut rest = BufReader::new(file.by_ref().take(bytes));
    let (mut left, mut record) = (bytes, Vec::new());
    while left > 0 {
        let mut header = [0; HEADER_BYTES];
        rest.read_exact(&mut header).map_err(|_| damaged())?;
        let length = u64_at(&header, 1).unwrap_or(u64::MAX);
        left = (left.checked_sub(HEADER_BYTES as u64))
            .and_then(|left| left.checked_sub(length))
            .ok_or_else(damaged)?;
        if length > RECORD_BYTES_MAX as u64 {
            return Err(damaged());
        }
        record.resize(usize::try_from(length).unwrap_or(0), 0);
        rest.read_exact(&mut record)?;
        if !is_whole(header[0], &record) {
            return Err(damaged());
        }
    }
    Ok(())
}

/// The library trusts the footer with memory for all that follows the start of the summary. Gives where that is and its bytes.
fn check_footer<F: Read + Seek>(file: &mut F, size: u64) -> Result<(u64, u64), Error> {
    let begin = size - MAGIC_BYTES - FOOTER_BYTES;
    file.seek(SeekFrom::Start(begin))?;
    let mut footer = [0; FOOTER_BYTES as usize];
    file.read_exact(&mut footer)?;
    if footer[0] != op::FOOTER || footer[1..9] != 20_u64.to_le_bytes() {
        return Err(Error::Damaged("there is no footer at its end".to_owned()));
    }
    let start = u64_at(&footer, 9).unwrap_or(0);
    if start == 0 {
        // Without a summary it can only be read from its beginning on.
        return Err(Error::Cut);
    }
    match begin.checked_sub(start) {
        None => Err(Error::Damaged("its summary lies outside it".to_owned())),
        Some(bytes) if bytes > SUMMARY_BYTES_MAX => Err(Error::TooLarge {
            what: "the summary",
            bytes,
            most: SUMMARY_BYTES_MAX,
        }),
        Some(bytes) => {
            check_summary(file, start, bytes, &footer)?;
            Ok((start, bytes))
        }
    }
}

/// The checksum covers the summary and the footer up to itself; 0 says that there is none.
fn check_summary<F: Read + Seek>(
    file: &mut F,
    start: u64,
    bytes: u64,
    footer: &[u8],
) -> Result<(), Error> {
    let (covered, sum) = footer.split_at(footer.len() - 4);
    let wanted = u32_at(sum, 0).unwrap_or(0);
    if wanted == 0 {
        return Ok(());
    }
    file.seek(SeekFrom::Start(start))?;
    let mut hasher = crc32fast::Hasher::new();
    let mut rest = file.by_ref().take(bytes);
    let mut piece = [0; 8192];
    loop {
        let size = rest.read(&mut piece)?;
        if size == 0 {
            break;
        }
        hasher.update(&piece[..size]);
    }
    hasher.update(covered);
    match hasher.finalize() == wanted {
        true => Ok(()),
        false => Err(Error::Damaged(
            "its summary has another checksum".to_owned(),
        )),
    }
}

fn summary<F: Read + Seek>(file: &mut F, size: u64) -> Result<Summary, Error> {
    let options = SummaryReaderOptions::default()
        .with_file_size(size)
        .with_record_length_limit(RECORD_BYTES_MAX);
    let mut reader = SummaryReader::new_with_options(options);
    while let Some(event) = reader.next_event() {
        match event.map_err(Error::reading)? {
            SummaryReadEvent::ReadRequest(wanted) => {
                let read = file.read(reader.insert(wanted))?;
                reader.notify_read(read);
            }
            SummaryReadEvent::SeekRequest(to) => {
                let at = file.seek(to)?;
                reader.notify_seeked(at);
            }
        }
    }
    reader.finish().ok_or(Error::Cut)
}

/// Whether a chunk lies in the file and becomes no more than it can.
pub(super) fn check_chunk(index: &mcap::records::ChunkIndex, size: u64) -> Result<(), Error> {
    let end = index.chunk_start_offset.checked_add(index.chunk_length);
    if end.is_none_or(|end| end > size) || index.compressed_size > index.chunk_length {
        return Err(Error::Damaged("a chunk leads outside the file".to_owned()));
    }
    let most = (RECORD_BYTES_MAX as u64).min(index.compressed_size.saturating_mul(INFLATION_MAX));
    if index.uncompressed_size > most {
        return Err(Error::TooLarge {
            what: "a chunk",
            bytes: index.uncompressed_size,
            most,
        });
    }
    Ok(())
}

pub(super) fn new_indexed(
    summary: &Summary,
    options: IndexedReaderOptions,
) -> Result<IndexedReader, Error> {
    IndexedReader::new_with_options(summary, options).map_err(Error::reading)
}

/// The next message: its channel, time and bytes. `chunks` counts those that were read for it.
pub(super) fn step<F: Read + Seek>(
    reader: &mut IndexedReader,
    summary: &Summary,
    file: &mut F,
    chunk: &mut Vec<u8>,
    chunks: &mut usize,
) -> Result<Option<(u16, u64, Vec<u8>)>, Error> {
    loop {
        let wanted = match reader.next_event() {
            None => return Ok(None),
            Some(event) => match event.map_err(Error::reading)? {
                IndexedReadEvent::ReadChunkRequest { offset, length } => (offset, length),
                IndexedReadEvent::Message { header, data } => {
                    return Ok(Some((header.channel_id, header.log_time, data.to_vec())));
                }
            },
        };
        let (offset, length) = wanted;
        *chunks += 1;
        let data = read_chunk(summary, (offset, length), file, chunk)?;
        reader
            .insert_chunk_record_data(offset, data)
            .map_err(Error::reading)?;
    }
}

/// Reads the chunk whose compressed bytes are there. The indexed reader of the library does not look at the checksum, so this
/// does: a damaged chunk must not become numbers.
fn read_chunk<'a, F: Read + Seek>(
    summary: &Summary,
    (offset, length): (u64, usize),
    file: &mut F,
    chunk: &'a mut Vec<u8>,
) -> Result<&'a [u8], Error> {
    let damaged = || Error::Damaged("an index leads to no chunk".to_owned());
    let chunks = &summary.chunk_indexes;
    let after = chunks.partition_point(|index| index.chunk_start_offset <= offset);
    let index = chunks[..after].last().ok_or_else(damaged)?;
    // Its place in the file and its size were checked when the file was opened.
    file.seek(SeekFrom::Start(index.chunk_start_offset))?;
    chunk.resize(usize::try_from(index.chunk_length).unwrap_or(0), 0);
    file.read_exact(chunk)?;
    check_sum(chunk).map_err(|why| why.in_part(index.chunk_start_offset))?;
    let begin = usize::try_from(offset - index.chunk_start_offset).unwrap_or(usize::MAX);
    let end = begin.checked_add(length).ok_or_else(damaged)?;
    chunk.get(begin..end).ok_or_else(damaged)
}

/// Whether a chunk, as a whole record, has the bytes that its checksum is of.
fn check_sum(record: &[u8]) -> Result<(), Error> {
    let damaged = || Error::Damaged("an index leads to no chunk".to_owned());
    let (header, data) = record.split_at_checked(HEADER_BYTES).ok_or_else(damaged)?;
    if header[0] != op::CHUNK || u64_at(header, 1) != u64::try_from(data.len()).ok() {
        return Err(damaged());
    }
    // The sum is right, or nothing in it is told.
    Chunk::of(data)?
        .each(|_, _| Ok::<bool, Error>(false))
        .map(drop)
}

fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    let bytes = bytes.get(at..at.checked_add(8)?)?;
    Some(u64::from_le_bytes(bytes.try_into().ok()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(bytes.try_into().ok()?))
}

/// The bytes of a file in its record: opcode and length, two times, name, media type, length, bytes, checksum.
pub(super) fn attachment_of(record: &[u8]) -> Option<Vec<u8>> {
    let (&opcode, _) = record.split_first()?;
    let mut at = 9 + 16;
    for _ in ["name", "media type"] {
        let length = usize::try_from(u32_at(record, at)?).ok()?;
        at = at.checked_add(4)?.checked_add(length)?;
    }
    let length = usize::try_from(u64_at(record, at)?).ok()?;
    let begin = at.checked_add(8)?;
    let end = begin.checked_add(length)?;
    let bytes = record.get(begin..end)?;
    let wanted = u32_at(record, end)?;
    let is_whole = wanted == 0 || crc32fast::hash(&record[9..end]) == wanted;
    (opcode == op::ATTACHMENT && is_whole).then(|| bytes.to_vec())
}
