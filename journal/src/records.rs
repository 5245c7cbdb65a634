//! Records of a recording that is read while it is made: types, channels and messages, as they come.
//!
//! Owns what of a live recording others pass on in a form of their own. What its `Writer` has just written is not checked as
//! a file of strangers is.

use crate::chunk::HEADER_BYTES;
use crate::error::Error;
use crate::limits::RECORD_BYTES_MAX;
use crate::shape::is_whole;
use crate::standard::Log;
use crate::write::Story;
use mcap::records::{Record as Raw, op};
use std::collections::{BTreeMap, HashMap};

/// Something that a live recording says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Record {
    /// A type, by its number: its name and its text in ros2msg.
    Schema(u16, String, String),
    /// A channel, by its number.
    Channel {
        /// Its number.
        id: u16,
        /// That of its type.
        schema: u16,
        /// Its topic.
        topic: String,
        /// What else is said of it.
        metadata: BTreeMap<String, String>,
    },
    /// A message of the channel with this number: when it was, in ns since 1970, and its bytes in CDR.
    Message(u16, u64, Vec<u8>),
}

/// All that these bytes say; they are whole records, and perhaps the beginning of the recording.
///
/// # Errors
/// They are none.
pub fn records(bytes: &[u8]) -> Result<Vec<Record>, Error> {
    let mut rest = bytes.strip_prefix(mcap::MAGIC).unwrap_or(bytes);
    let mut all = Vec::new();
    while let Some((header, after)) = rest.split_at_checked(HEADER_BYTES) {
        let length = header[1..].try_into().map(u64::from_le_bytes);
        let length = length.ok().and_then(|length| usize::try_from(length).ok());
        let cut = length.and_then(|length| after.split_at_checked(length));
        let (body, after) = cut.ok_or(Error::Cut)?;
        rest = after;
        if matches!(header[0], op::SCHEMA | op::CHANNEL | op::MESSAGE) {
            all.extend(record(header[0], body)?);
        }
    }
    match rest.is_empty() {
        true => Ok(all),
        false => Err(Error::Cut),
    }
}

/// The lines of stories in a recording that comes piece by piece from somewhere else: all that others want of it who see the
/// nodes themselves.
#[derive(Debug, Default)]
pub struct Lines {
    /// What of a record has come.
    rest: Vec<u8>,
    stories: HashMap<u16, Story>,
}

impl Lines {
    /// The lines that are whole with this piece, each with its time in ns since 1970.
    ///
    /// # Errors
    /// It is no recording, or has a record that is too large.
    pub fn take(&mut self, piece: &[u8]) -> Result<Vec<(Story, u64, Log)>, Error> {
        self.rest.extend_from_slice(piece);
        let whole = whole(&self.rest)?;
        let records = records(&self.rest[..whole])?;
        self.rest.drain(..whole);
        let mut lines = Vec::new();
        for record in records {
            match record {
                Record::Schema(..) => {}
                Record::Channel { id, topic, .. } => match Story::of(&topic) {
                    Some(story) => drop(self.stories.insert(id, story)),
                    None => drop(self.stories.remove(&id)),
                },
                Record::Message(id, at_ns, bytes) => {
                    if let Some(story) = self.stories.get(&id)
                        && let Some(line) = Log::decode(&bytes)
                    {
                        lines.push((*story, at_ns, line));
                    }
                }
            }
        }
        Ok(lines)
    }
}

/// How many of these bytes are whole records.
fn whole(bytes: &[u8]) -> Result<usize, Error> {
    if bytes.len() < mcap::MAGIC.len() && mcap::MAGIC.starts_with(bytes) {
        return Ok(0);
    }
    let mut at = match bytes.starts_with(mcap::MAGIC) {
        true => mcap::MAGIC.len(),
        false => 0,
    };
    while let Some(header) = bytes.get(at..at + HEADER_BYTES) {
        let length = header[1..].try_into().map_or(u64::MAX, u64::from_le_bytes);
        let most = RECORD_BYTES_MAX as u64;
        if length > most {
            return Err(Error::TooLarge {
                what: "a record",
                bytes: length,
                most,
            });
        }
        let next = at + HEADER_BYTES + usize::try_from(length).unwrap_or(usize::MAX);
        if next > bytes.len() {
            break;
        }
        at = next;
    }
    Ok(at)
}

#[allow(clippy::wildcard_enum_match_arm, reason = "kinds of another crate")]
fn record(opcode: u8, body: &[u8]) -> Result<Option<Record>, Error> {
    if !is_whole(opcode, body) {
        return Err(Error::Damaged("a length inside a record".to_owned()));
    }
    Ok(
        match mcap::parse_record(opcode, body).map_err(Error::reading)? {
            Raw::Schema { header, data } => {
                let text = String::from_utf8_lossy(&data).into_owned();
                Some(Record::Schema(header.id, header.name, text))
            }
            Raw::Channel(channel) => Some(Record::Channel {
                id: channel.id,
                schema: channel.schema_id,
                topic: channel.topic,
                metadata: channel.metadata,
            }),
            Raw::Message { header, data } => Some(Record::Message(
                header.channel_id,
                header.log_time,
                data.into_owned(),
            )),
            _ => None,
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::node::Node;
    use crate::standard::Level;
    use crate::write::{Out, Writer};

    #[test]
    fn lines_come_out_of_pieces_of_any_size() {
        let out = Out::default();
        let mut writer = Writer::live(out.clone(), "test").unwrap();
        let node = writer.add(&Node::sensor("a/b", "i32 x")).unwrap();
        let line = |text: &str| Log {
            level: Level::Info,
            name: "x.py".to_owned(),
            text: text.to_owned(),
            errno: 0,
        };
        writer.line(Story::Output, 4, &line("first")).unwrap();
        writer.sample(node, 5, &7_i32.to_le_bytes()).unwrap();
        writer.attach(6, "a", "b", b"programs").unwrap();
        writer.line(Story::Diagram, 7, &line("{}")).unwrap();
        let bytes = out.take();
        for size in [1, 7, 64, bytes.len()] {
            let mut lines = Lines::default();
            let all: Vec<_> = (bytes.chunks(size))
                .flat_map(|piece| lines.take(piece).unwrap())
                .map(|(story, at, line)| (story, at, line.text))
                .collect();
            let wanted = [
                (Story::Output, 4, "first".to_owned()),
                (Story::Diagram, 7, "{}".to_owned()),
            ];
            assert_eq!(all, wanted, "pieces of {size} bytes");
        }
        let mut hostile = vec![op::MESSAGE];
        hostile.extend_from_slice(&u64::MAX.to_le_bytes());
        assert!(Lines::default().take(&hostile).is_err());
    }

    #[test]
    fn what_a_live_recording_says_comes_in_order() {
        let out = Out::default();
        let mut writer = Writer::live(out.clone(), "test").unwrap();
        let node = writer.add(&Node::sensor("a/b", "i32 x")).unwrap();
        writer.sample(node, 5, &7_i32.to_le_bytes()).unwrap();
        let bytes = out.take();
        let all = records(&bytes).unwrap();
        let channel = all.iter().find_map(|record| match record {
            Record::Channel {
                id, schema, topic, ..
            } if topic == "/a/b" => Some((*id, *schema)),
            Record::Channel { .. } | Record::Schema(..) | Record::Message(..) => None,
        });
        let (channel, schema) = channel.unwrap();
        let is_schema = |record: &Record| {
            matches!(record, Record::Schema(id, name, text)
                if *id == schema && name == "trik_msgs/msg/AB" && text.contains("int32 x"))
        };
        assert!(all.iter().any(is_schema), "{all:?}");
        let last = all.last().unwrap();
        let Record::Message(of, 5, data) = last else {
            panic!("{last:?}");
        };
        assert_eq!(
            (*of, &data[data.len() - 4..]),
            (channel, &7_i32.to_le_bytes()[..])
        );
        writer.sample(node, 6, &8_i32.to_le_bytes()).unwrap();
        assert_eq!(records(&out.take()).unwrap().len(), 1);
        assert_eq!(records(&bytes[..bytes.len() - 1]), Err(Error::Cut));
    }
}
