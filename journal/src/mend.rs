//! Making a cut recording whole again.
//!
//! Owns what is kept: every whole record before the cut, in its order, with the summary that a recorder would have written. A
//! recorder writes chunks whole, so what it lost is what it had not written yet. Knows no path; whoever has the file renames
//! the new one over it.

use crate::error::Error;
use crate::limits::{CHUNK_BYTES, RECORD_BYTES_MAX};
use mcap::records::{MessageHeader, Record};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Attachment, Compression, WriteOptions};
use std::collections::HashMap;
use std::io::{Read, Seek, Write};

/// What was saved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Saved {
    /// Messages.
    pub messages: u64,
    /// Files that go with it.
    pub attachments: u64,
    /// Why it went no further; None if the file was whole.
    pub cut: Option<Error>,
}

/// Copies what is whole of a recording into a new one.
///
/// # Errors
/// It is no recording, or the new one cannot be written.
pub fn mend<R: Read, W: Write + Seek>(from: R, to: W) -> Result<Saved, Error> {
    copy(from, to, |_, _| true)
}

/// The same with some of its messages: those that are wanted, by their topic and their moment in ns since 1970.
///
/// # Errors
/// It is no recording, or the new one cannot be written.
pub fn copy<R: Read, W: Write + Seek>(
    mut from: R,
    to: W,
    is_wanted: impl Fn(&str, u64) -> bool,
) -> Result<Saved, Error> {
    let options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        // Else messages of a damaged chunk would come before anybody knows that they are none.
        .with_prevalidate_chunk_crcs(true)
        .with_record_length_limit(RECORD_BYTES_MAX);
    let mut reader = LinearReader::new_with_options(options);
    let mut saved = Saved::default();
    let mut target = Target {
        out: None,
        to: Some(to),
        schemas: HashMap::new(),
        channels: HashMap::new(),
    };
    loop {
        let step = match reader.next_event() {
            None => break,
            Some(step) => step,
        };
        match step {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = from.read(reader.insert(wanted))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                match target.take(opcode, data, &mut saved, &is_wanted) {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(Stop::Damage(error)) => {
                        saved.cut = Some(error);
                        break;
                    }
                    Err(Stop::Disk(error)) => return Err(error),
                }
            }
            Err(error) => {
                let error = Error::reading(error);
                if error == Error::NotARecording {
                    return Err(error);
                }
                saved.cut = Some(error);
                break;
            }
        }
    }
    let mut out = target.out.ok_or(Error::NotARecording)?;
    out.finish().map_err(Error::writing)?;
    Ok(saved)
}

/// Why a record is not copied.
enum Stop {
    /// It is none.
    Damage(Error),
    /// The new file takes no more.
    Disk(Error),
}

struct Target<W: Write + Seek> {
    /// From the header on.
    out: Option<mcap::Writer<W>>,
    to: Option<W>,
    /// Numbers there to numbers here.
    schemas: HashMap<u16, u16>,
    channels: HashMap<u16, (u16, String)>,
}

impl<W: Write + Seek> Target<W> {
    /// Begins the new file as the old one was begun.
    fn begin(&mut self, header: &mcap::records::Header) -> Result<(), Stop> {
        let Some(to) = self.to.take() else {
            return Err(Stop::Damage(Error::Damaged("a second header".to_owned())));
        };
        let options = WriteOptions::new()
            .profile(header.profile.clone())
            .library(header.library.clone())
            .compression(Some(Compression::Lz4))
            .chunk_size(Some(CHUNK_BYTES))
            .disable_seeking(true);
        let begun = options.create(to);
        self.out = Some(begun.map_err(|error| Stop::Disk(Error::writing(error)))?);
        Ok(())
    }

    /// Copies a record. False after the last that is copied.
    fn take(
        &mut self,
        opcode: u8,
        data: &[u8],
        saved: &mut Saved,
        is_wanted: &impl Fn(&str, u64) -> bool,
    ) -> Result<bool, Stop> {
        let damage = |error| Stop::Damage(Error::reading(error));
        let disk = |error| Stop::Disk(Error::writing(error));
        // The library takes four bytes off an attachment that it has not looked for.
        if opcode == mcap::records::op::ATTACHMENT && !holds_an_attachment(data) {
            return Err(Stop::Damage(Error::Damaged("an attachment".to_owned())));
        }
        let record = mcap::parse_record(opcode, data).map_err(damage)?;
        if let Record::Header(header) = &record {
            return self.begin(header).map(|()| true);
        }
        let Some(out) = &mut self.out else {
            return Err(Stop::Damage(Error::NotARecording));
        };
        let unknown = |what: &str| Stop::Damage(Error::Damaged(format!("an unknown {what}")));
        match record {
            Record::Schema { header, data } => {
                let id = out.add_schema(&header.name, &header.encoding, &data);
                self.schemas.insert(header.id, id.map_err(disk)?);
            }
            Record::Channel(channel) => {
                let schema = match channel.schema_id {
                    0 => 0,
                    id => *(self.schemas.get(&id)).ok_or_else(|| unknown("schema"))?,
                };
                let id = out.add_channel(
                    schema,
                    &channel.topic,
                    &channel.message_encoding,
                    &channel.metadata,
                );
                let named = (id.map_err(disk)?, channel.topic);
                self.channels.insert(channel.id, named);
            }
            Record::Message { header, data } => {
                let channel = self.channels.get(&header.channel_id);
                let (id, topic) = channel.ok_or_else(|| unknown("channel"))?;
                if is_wanted(topic, header.log_time) {
                    let header = MessageHeader {
                        channel_id: *id,
                        ..header
                    };
                    out.write_to_known_channel(&header, &data).map_err(disk)?;
                    saved.messages += 1;
                }
            }
            Record::Attachment { header, data, .. } => {
                let attachment = Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data,
                };
                out.attach(&attachment).map_err(disk)?;
                saved.attachments += 1;
            }
            Record::Metadata(metadata) => out.write_metadata(&metadata).map_err(disk)?,
            // The summary begins, which is made anew.
            Record::DataEnd(_) | Record::Footer(_) => return Ok(false),
            // Indexes are made anew; chunks were taken apart by the reader; what is unknown has no meaning here.
            Record::Header(_)
            | Record::Chunk { .. }
            | Record::MessageIndex(_)
            | Record::ChunkIndex(_)
            | Record::AttachmentIndex(_)
            | Record::Statistics(_)
            | Record::MetadataIndex(_)
            | Record::SummaryOffset(_)
            | Record::Unknown { .. } => {}
        }
        Ok(true)
    }
}

/// Whether all parts of an attachment are there: two times, name, media type, length, bytes, checksum.
fn holds_an_attachment(data: &[u8]) -> bool {
    let length_at = |at: usize| -> Option<usize> {
        let bytes = data.get(at..at.checked_add(4)?)?;
        usize::try_from(u32::from_le_bytes(bytes.try_into().ok()?)).ok()
    };
    let mut at = Some(16);
    for _ in ["name", "media type"] {
        at = at.and_then(|at: usize| at.checked_add(4)?.checked_add(length_at(at)?));
    }
    at.and_then(|at| at.checked_add(8 + 4))
        .is_some_and(|end| end <= data.len())
}
