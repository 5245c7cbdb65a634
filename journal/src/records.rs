//! Records of a recording that is read while it is made: types, channels and messages, as they come.
//!
//! Owns what of a live recording others pass on in a form of their own. What its `Writer` has just written is not checked as
//! a file of strangers is.

use crate::chunk::HEADER_BYTES;
use crate::error::Error;
use mcap::records::{Record as Raw, op};
use std::collections::BTreeMap;

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

#[allow(clippy::wildcard_enum_match_arm, reason = "kinds of another crate")]
fn record(opcode: u8, body: &[u8]) -> Result<Option<Record>, Error> {
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
    use crate::write::{Out, Writer};

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
