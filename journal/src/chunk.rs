//! A chunk of a recording, record by record.
//!
//! Owns what is asked of a chunk before its records count: that its checksum is right, and that its records fill it, because
//! the library goes on reading behind a chunk without compression whose records are longer than it. Knows no recording and
//! no meaning of records.

use crate::error::Error;
use crate::limits::RECORD_BYTES_MAX;
use crate::shape::is_whole;
use mcap::records::{Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use std::io::Read as _;

/// Opcode and length of a record.
pub(crate) const HEADER_BYTES: usize = 9;

/// The bytes of a chunk's record without its opcode and length, checked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chunk<'a>(&'a [u8]);

impl<'a> Chunk<'a> {
    /// Checks what can be checked before its records are read.
    ///
    /// # Errors
    /// It is damaged.
    pub fn of(data: &'a [u8]) -> Result<Self, Error> {
        let damaged = || Error::Damaged("a chunk".to_owned());
        if !is_whole(op::CHUNK, data) {
            return Err(damaged());
        }
        let read = mcap::parse_record(op::CHUNK, data).map_err(Error::reading)?;
        let Record::Chunk {
            header,
            data: records,
        } = read
        else {
            return Err(damaged());
        };
        if header.compression.is_empty() && !fill(&records) {
            return Err(damaged());
        }
        Ok(Self(data))
    }

    /// Gives its records with their opcodes, once its checksum was found right, until one is the last that is wanted;
    /// whether none was.
    ///
    /// # Errors
    /// It is damaged, or somebody fails with a record.
    pub fn each<E: From<Error>>(
        self,
        mut take: impl FnMut(u8, &[u8]) -> Result<bool, E>,
    ) -> Result<bool, E> {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            // Else messages of a damaged chunk would come before anybody knows that they are none.
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(RECORD_BYTES_MAX);
        let mut reader = LinearReader::new_with_options(options);
        let mut header = [op::CHUNK; HEADER_BYTES];
        header[1..].copy_from_slice(&(self.0.len() as u64).to_le_bytes());
        let mut rest = header.chain(self.0);
        while let Some(event) = reader.next_event() {
            match event.map_err(Error::reading)? {
                LinearReadEvent::ReadRequest(wanted) => {
                    let read = rest.read(reader.insert(wanted)).map_err(Error::from)?;
                    reader.notify_read(read);
                }
                LinearReadEvent::Record { opcode, data } => {
                    if !take(opcode, data)? {
                        return Ok(false);
                    }
                }
            }
        }
        Ok(true)
    }
}

/// Whether records end where their bytes end.
fn fill(mut bytes: &[u8]) -> bool {
    while let Some((header, rest)) = bytes.split_at_checked(HEADER_BYTES) {
        let length = header[1..].try_into().map(u64::from_le_bytes);
        let length = length.ok().and_then(|length| usize::try_from(length).ok());
        let Some((_, after)) = length.and_then(|length| rest.split_at_checked(length)) else {
            return false;
        };
        bytes = after;
    }
    bytes.is_empty()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chunk without compression whose header says that so many bytes of records follow.
    fn chunk(records: &[u8], said: u64) -> Vec<u8> {
        let mut data = Vec::new();
        data.extend([0; 16]);
        data.extend(said.to_le_bytes());
        // No checksum, no compression.
        data.extend([0; 8]);
        data.extend(said.to_le_bytes());
        data.extend(records);
        data
    }

    fn taken(data: &[u8]) -> Result<Vec<(u8, Vec<u8>)>, Error> {
        let mut all = Vec::new();
        Chunk::of(data)?.each(|opcode, data| {
            all.push((opcode, data.to_vec()));
            Ok::<bool, Error>(true)
        })?;
        Ok(all)
    }

    #[test]
    fn records_come_in_order() {
        let mut records = vec![0x80, 2, 0, 0, 0, 0, 0, 0, 0, 7, 8];
        records.extend([0x81, 0, 0, 0, 0, 0, 0, 0, 0]);
        let all = taken(&chunk(&records, records.len() as u64)).expect("records");
        assert_eq!(all, [(0x80, vec![7, 8]), (0x81, vec![])]);
    }

    #[test]
    fn a_record_that_is_longer_than_its_chunk_is_damage() {
        for length in [1_u64, 3, 1 << 40, u64::MAX - 8, u64::MAX] {
            let mut records = vec![0x80];
            records.extend(length.to_le_bytes());
            let read = taken(&chunk(&records, records.len() as u64));
            assert!(matches!(read, Err(Error::Damaged(_))), "{length}: {read:?}");
        }
        let half = [0x80, 0, 0, 0];
        assert!(taken(&chunk(&half, 4)).is_err());
        // The record goes on in what follows the chunk's own bytes.
        let beyond = [0x80, 5, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5];
        assert!(taken(&chunk(&beyond, 9)).is_err());
    }
}
