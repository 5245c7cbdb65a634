//! Making a cut recording whole again.
//!
//! Owns what is kept: every whole record before the cut, in its order, with the summary that a recorder would have written. A
//! recorder writes chunks whole, so what it lost is what it had not written yet. A damaged chunk is left out, and what follows
//! it is kept as long as records follow each other. Knows no path; the caller renames the new one over it.

use crate::chunk::{Chunk, HEADER_BYTES};
use crate::error::Error;
use crate::limits::{CHUNK_BYTES, RECORD_BYTES_MAX};
use crate::node::Node;
use crate::shape::is_whole;
use crate::standard::Log;
use crate::write::{FAULTS, Story};
use mcap::records::{Channel, MessageHeader, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Attachment, Compression, Summary, WriteOptions};
use std::cell::RefCell;
use std::collections::HashMap;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// How much of a recording that is followed may be in memory alone.
const FLUSH_NS: u64 = 1_000_000_000;

/// What was saved.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Saved {
    /// Messages.
    pub messages: u64,
    /// Files that go with it.
    pub attachments: u64,
    /// What was wrong first; None if the file was whole.
    pub cut: Option<Error>,
    /// Records that are left out because they are damaged, or messages of channels that are not known therefore.
    pub left_out: u64,
    /// The place of the first of them, or of the cut, in bytes from the beginning.
    pub at: u64,
}

impl Saved {
    /// Something is wrong at this place.
    fn note(&mut self, error: Error, at: u64) {
        if self.cut.is_none() {
            self.cut = Some(error);
            self.at = at;
        }
    }

    /// Whether only what its recorder had not written yet is missing.
    pub fn is_only_cut(&self) -> bool {
        self.left_out == 0 && matches!(self.cut, None | Some(Error::Cut))
    }
}

/// Copies what is whole of a recording into a new one.
///
/// # Errors
/// It is no recording, or the new one cannot be written.
pub fn mend<R: Read, W: Write + Seek>(from: R, to: W) -> Result<Saved, Error> {
    copy(from, to, |_, _| true)
}

/// The same with a file, whose summary, if it is there, says what channels are that stand in a damaged part.
///
/// # Errors
/// As of [`mend`].
pub fn mend_file<F: Read + Seek, W: Write + Seek>(mut from: F, to: W) -> Result<Saved, Error> {
    let mut target = Target::new(to);
    target.known = crate::read::summary_of(&mut from).ok();
    from.rewind()?;
    let mut saved = Saved::default();
    target.pour(from, &mut saved, &|_, _, _| true)?;
    target.finish()?;
    Ok(saved)
}

/// Reads all of a recording and keeps nothing: what is wrong with it.
///
/// # Errors
/// It is no recording, or cannot be read.
pub fn check<R: Read>(from: R) -> Result<Saved, Error> {
    copy(from, Nowhere(0), |_, _| false)
}

/// A file of which only the length is known.
struct Nowhere(u64);

impl Write for Nowhere {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Nowhere {
    /// It only goes forward.
    fn seek(&mut self, _to: SeekFrom) -> io::Result<u64> {
        Ok(self.0)
    }
}

/// The same with some of its messages: those that are wanted, by their topic and their moment in ns since 1970.
///
/// # Errors
/// It is no recording, or the new one cannot be written.
pub fn copy<R: Read, W: Write + Seek>(
    from: R,
    to: W,
    is_wanted: impl Fn(&str, u64) -> bool,
) -> Result<Saved, Error> {
    let mut target = Target::new(to);
    let mut saved = Saved::default();
    let is_wanted =
        |topic: &str, message: &MessageHeader, _: &[u8]| is_wanted(topic, message.log_time);
    target.pour(from, &mut saved, &is_wanted)?;
    target.finish()?;
    Ok(saved)
}

/// Makes a file of a recording that is read while it is made, until `from` ends: what is a second old, by the time of the
/// messages, is in the file if this is killed. `begun` hears the nodes that are known when the first message comes, once.
///
/// # Errors
/// It is no recording, or the file cannot be written.
pub fn follow<R: Read, W: Write + Seek>(
    from: R,
    to: W,
    begun: impl FnOnce(&[Node]) + 'static,
) -> Result<Saved, Error> {
    let mut target = Target::new(to);
    target.begun = Some(Box::new(begun));
    target.flushed_ns = Some(0);
    let mut saved = Saved::default();
    target.pour(from, &mut saved, &|_, _, _| true)?;
    target.finish()?;
    Ok(saved)
}

/// Puts recordings of one recorder that follow each other into one. Each may begin with what nodes had before; that is left
/// out where an earlier one has it. One that is cut gives what is whole of it.
///
/// # Errors
/// None of them is a recording, or the new one cannot be written.
pub fn join<R: Read, W: Write + Seek>(
    all: impl IntoIterator<Item = R>,
    to: W,
) -> Result<Saved, Error> {
    let mut target = Target::new(to);
    target.joins = true;
    let mut saved = Saved::default();
    // Of each node the number of the recording with its last message, and when that was so first.
    let last = RefCell::new(HashMap::new());
    for (number, from) in all.into_iter().enumerate() {
        let is_new = |topic: &str, message: &MessageHeader, data: &[u8]| {
            // Lines are never repeated.
            if Story::of(topic).is_some() {
                return true;
            }
            // Failures of all nodes have one topic.
            let fault = (topic == FAULTS).then(|| Log::decode(data)).flatten();
            let node = fault.map(|fault| fault.name).unwrap_or_default();
            // What is repeated comes first of its node in a further recording, with the moment of the last one before. What
            // is only earlier is news: the clock was set back.
            let unix_ns = message.publish_time;
            let mut last = last.borrow_mut();
            let before = last.insert((topic.to_owned(), node), (number, unix_ns));
            before.is_none_or(|(part, at_ns)| part == number || at_ns != unix_ns)
        };
        match target.pour(from, &mut saved, &is_new) {
            // It was begun and nothing was written: the recorder was killed just then.
            Ok(()) | Err(Error::NotARecording) => {}
            Err(error) => return Err(error),
        }
    }
    target.finish()?;
    Ok(saved)
}

/// Why a record is not copied.
enum Stop {
    /// It is none.
    Damage(Error),
    /// The new file takes no more.
    Disk(Error),
}

impl From<Error> for Stop {
    fn from(error: Error) -> Self {
        Self::Damage(error)
    }
}

fn on_disk(error: mcap::McapError) -> Stop {
    Stop::Disk(Error::writing(error))
}

/// What is written to, once the header of the recording that is copied has come.
fn begun<W: Write + Seek>(
    out: &mut Option<mcap::Writer<W>>,
    is_begun: bool,
) -> Result<&mut mcap::Writer<W>, Stop> {
    let out = out.as_mut().filter(|_| is_begun);
    out.ok_or(Stop::Damage(Error::NotARecording))
}

/// Hears the nodes of a recording, once.
type Begun = Box<dyn FnOnce(&[Node])>;

struct Target<W: Write + Seek> {
    /// From the header on.
    out: Option<mcap::Writer<W>>,
    to: Option<W>,
    /// The header of the recording that is copied now has come.
    is_begun: bool,
    /// The message with which all was handed to the file the last time; None if nobody waits for that.
    flushed_ns: Option<u64>,
    /// Who hears the nodes that are known when the first message comes; None if nobody does, or it has come.
    begun: Option<Begun>,
    /// These nodes, while somebody is to hear them.
    nodes: Vec<Node>,
    /// Several recordings become one.
    joins: bool,
    /// Checksums of the files that go with it, by their names.
    attached: HashMap<String, u32>,
    /// Numbers there to numbers here.
    schemas: HashMap<u16, u16>,
    channels: HashMap<u16, (u16, String)>,
    /// What the summary of the old one says.
    known: Option<Summary>,
    /// Where the record that is copied begins in the old one.
    at: u64,
}

impl<W: Write + Seek> Target<W> {
    fn new(to: W) -> Self {
        Self {
            out: None,
            to: Some(to),
            is_begun: false,
            flushed_ns: None,
            begun: None,
            nodes: Vec::new(),
            joins: false,
            attached: HashMap::new(),
            schemas: HashMap::new(),
            channels: HashMap::new(),
            known: None,
            at: 0,
        }
    }

    /// Copies what is whole of a recording.
    fn pour<R: Read>(
        &mut self,
        mut from: R,
        saved: &mut Saved,
        is_wanted: &impl Fn(&str, &MessageHeader, &[u8]) -> bool,
    ) -> Result<(), Error> {
        let options = LinearReaderOptions::default()
            .with_skip_end_magic(true)
            .with_emit_chunks(true)
            .with_record_length_limit(RECORD_BYTES_MAX);
        let mut reader = LinearReader::new_with_options(options);
        self.is_begun = false;
        self.schemas.clear();
        self.channels.clear();
        let mut at = mcap::MAGIC.len() as u64;
        while let Some(step) = reader.next_event() {
            match step {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let read = from.read(reader.insert(wanted))?;
                    reader.notify_read(read);
                }
                Ok(LinearReadEvent::Record { opcode, data }) => {
                    self.at = at;
                    at += (HEADER_BYTES + data.len()) as u64;
                    match self.take_whole(opcode, data, saved, is_wanted) {
                        Ok(true) => {}
                        Ok(false) => break,
                        // A damaged chunk gives nothing, and the next record may be whole.
                        Err(Stop::Damage(error)) if self.is_begun => {
                            saved.note(error, self.at);
                            saved.left_out += 1;
                        }
                        Err(Stop::Damage(_)) => break,
                        Err(Stop::Disk(error)) => return Err(error.of_output()),
                    }
                }
                Err(error) => {
                    let error = Error::reading(error);
                    if error == Error::NotARecording {
                        return Err(error);
                    }
                    saved.note(error, at);
                    break;
                }
            }
        }
        match self.is_begun {
            true => Ok(()),
            false => Err(Error::NotARecording),
        }
    }

    /// Writes the summary and the end.
    fn finish(self) -> Result<(), Error> {
        let mut out = self.out.ok_or(Error::NotARecording)?;
        let end = out.finish().map(drop);
        end.map_err(|error| Error::writing(error).of_output())
    }

    /// Begins the new file as the old one was begun; a further one goes on in the same file.
    fn begin(&mut self, header: &mcap::records::Header) -> Result<(), Stop> {
        if self.is_begun {
            return Err(Stop::Damage(Error::Damaged("a second header".to_owned())));
        }
        self.is_begun = true;
        let Some(to) = self.to.take() else {
            return Ok(());
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

    /// Copies a record, or those of a chunk. False after the last that is copied.
    fn take_whole(
        &mut self,
        opcode: u8,
        data: &[u8],
        saved: &mut Saved,
        is_wanted: &impl Fn(&str, &MessageHeader, &[u8]) -> bool,
    ) -> Result<bool, Stop> {
        if opcode != op::CHUNK {
            return self.take(opcode, data, saved, is_wanted);
        }
        let chunk = Chunk::of(data).map_err(Stop::Damage)?;
        chunk.each(|opcode, data| match opcode {
            op::CHUNK => Err(Error::Damaged("a chunk in a chunk".to_owned()).into()),
            _ => self.take(opcode, data, saved, is_wanted),
        })
    }

    fn take_channel(&mut self, channel: Channel) -> Result<(), Stop> {
        let schema = match (channel.schema_id, self.schemas.get(&channel.schema_id)) {
            (0, _) => 0,
            (_, Some(schema)) => *schema,
            // It stood in a damaged part; maybe the summary knows the channel, when a message comes.
            (_, None) => return Ok(()),
        };
        let out = begun(&mut self.out, self.is_begun)?;
        let id = declare(out, schema, &channel).map_err(on_disk)?;
        if self.begun.is_some() {
            let node = Node::of_channel(&channel.topic, &channel.metadata);
            self.nodes.extend(node);
        }
        self.channels.insert(channel.id, (id, channel.topic));
        Ok(())
    }

    fn take_message(
        &mut self,
        header: MessageHeader,
        data: &[u8],
        saved: &mut Saved,
        is_wanted: &impl Fn(&str, &MessageHeader, &[u8]) -> bool,
    ) -> Result<(), Stop> {
        if let Some(hear) = self.begun.take() {
            hear(&std::mem::take(&mut self.nodes));
        }
        let out = begun(&mut self.out, self.is_begun)?;
        let known = self.known.as_ref();
        if !knows(out, &mut self.channels, known, header.channel_id).map_err(on_disk)? {
            // Others of its chunk may be known.
            saved.note(Error::Damaged("an unknown channel".to_owned()), self.at);
            saved.left_out += 1;
            return Ok(());
        }
        let (id, topic) = &self.channels[&header.channel_id];
        if is_wanted(topic, &header, data) {
            let channel_id = *id;
            let header = MessageHeader {
                channel_id,
                ..header
            };
            write(out, &header, data, &mut self.flushed_ns).map_err(on_disk)?;
            saved.messages += 1;
        }
        Ok(())
    }

    /// Copies a record. False after the last that is copied.
    fn take(
        &mut self,
        opcode: u8,
        data: &[u8],
        saved: &mut Saved,
        is_wanted: &impl Fn(&str, &MessageHeader, &[u8]) -> bool,
    ) -> Result<bool, Stop> {
        if !is_whole(opcode, data) {
            return Err(damaged("a length inside a record"));
        }
        let record = mcap::parse_record(opcode, data);
        let record = record.map_err(|error| Stop::Damage(Error::reading(error)))?;
        if let Record::Header(header) = &record {
            return self.begin(header).map(|()| true);
        }
        let out = begun(&mut self.out, self.is_begun)?;
        match record {
            Record::Schema { header, data } => {
                let id = out.add_schema(&header.name, &header.encoding, &data);
                self.schemas.insert(header.id, id.map_err(on_disk)?);
            }
            Record::Channel(channel) => self.take_channel(channel)?,
            Record::Message { header, data } => {
                self.take_message(header, &data, saved, is_wanted)?;
            }
            Record::Attachment { header, data, .. } => {
                let attachment = Attachment {
                    log_time: header.log_time,
                    create_time: header.create_time,
                    name: header.name,
                    media_type: header.media_type,
                    data,
                };
                // One that is there is there in each part.
                if !self.joins || is_new(&mut self.attached, &attachment) {
                    out.attach(&attachment).map_err(on_disk)?;
                    saved.attachments += 1;
                }
            }
            Record::Metadata(metadata) => out.write_metadata(&metadata).map_err(on_disk)?,
            // The summary begins, which is made anew.
            Record::DataEnd(_) | Record::Footer(_) => return Ok(false),
            // Indexes are made anew; chunks were taken apart; what is unknown has no meaning here.
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

/// The same channel in the new file.
fn declare<W: Write + Seek>(
    out: &mut mcap::Writer<W>,
    schema: u16,
    channel: &mcap::records::Channel,
) -> mcap::McapResult<u16> {
    let encoding = &channel.message_encoding;
    out.add_channel(schema, &channel.topic, encoding, &channel.metadata)
}

/// The same for one that the old summary tells of.
fn declare_known<W: Write + Seek>(
    out: &mut mcap::Writer<W>,
    channel: &mcap::Channel<'_>,
) -> mcap::McapResult<u16> {
    let schema = match &channel.schema {
        Some(schema) => out.add_schema(&schema.name, &schema.encoding, &schema.data)?,
        None => 0,
    };
    let encoding = &channel.message_encoding;
    out.add_channel(schema, &channel.topic, encoding, &channel.metadata)
}

fn damaged(what: &str) -> Stop {
    Stop::Damage(Error::Damaged(what.to_owned()))
}

/// Whether the new file has a channel, which it gets now if the old summary tells of it.
fn knows<W: Write + Seek>(
    out: &mut mcap::Writer<W>,
    channels: &mut HashMap<u16, (u16, String)>,
    known: Option<&Summary>,
    id: u16,
) -> mcap::McapResult<bool> {
    if channels.contains_key(&id) {
        return Ok(true);
    }
    let Some(channel) = known.and_then(|known| known.channels.get(&id)) else {
        return Ok(false);
    };
    let new = declare_known(out, channel)?;
    channels.insert(channel.id, (new, channel.topic.clone()));
    Ok(true)
}

/// Writes a message, and hands all to the file if it is time.
fn write<W: Write + Seek>(
    out: &mut mcap::Writer<W>,
    header: &MessageHeader,
    data: &[u8],
    flushed_ns: &mut Option<u64>,
) -> mcap::McapResult<()> {
    out.write_to_known_channel(header, data)?;
    if let Some(before) = flushed_ns
        && header.log_time.abs_diff(*before) >= FLUSH_NS
    {
        *before = header.log_time;
        out.flush()?;
    }
    Ok(())
}

/// Whether the last file of this name was another one.
fn is_new(attached: &mut HashMap<String, u32>, attachment: &Attachment<'_>) -> bool {
    let checksum = crc32fast::hash(&attachment.data);
    attached.insert(attachment.name.clone(), checksum) != Some(checksum)
}
