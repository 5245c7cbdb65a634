//! One recorded node: its channel, its type, and its samples as messages.
//!
//! Owns what a channel says of its node, so that a recording explains itself, and the form of a sample: header, sequence
//! number, the numbers of the tuple. A failure is no sample; it stands on the topic of faults.

use crate::cdr::{Reader, Writer};
use crate::error::Error;
use crate::layout::{Field, Layout, text};
use crate::limits::TUPLE_BYTES_MAX;
use crate::standard::stamp;
use crate::write::{FAULTS, Story};
use std::collections::BTreeMap;

/// What is known of a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Its path below the mount point, which is the topic without the `/` before it, but where that is another thing's.
    pub path: String,
    /// The text of its `format`.
    pub format: String,
    /// Its unit.
    pub units: String,
    /// What it is, for people.
    pub about: String,
    /// It can be written.
    pub is_written: bool,
    /// What brings it to rest: numbers with spaces between them; empty if it needs none.
    pub rest: String,
    /// Other names of it.
    pub aliases: Vec<String>,
    /// Not the node, but what its source gave before it was converted: bytes, under a topic of their own.
    pub is_raw: bool,
}

/// Keys of a channel's metadata.
const FORMAT: &str = "format";
const UNITS: &str = "units";
const ABOUT: &str = "about";
const ACCESS: &str = "access";
const REST: &str = "rest";
const ALIASES: &str = "aliases";
const RAW_OF: &str = "raw_of";
const BYTES: &str = "bytes";
/// The path of a node whose topic is another one.
const PATH: &str = "path";
/// What the topics of bytes of sources begin with.
const RAW: &str = "raw";
/// What the topics of nodes begin with whose own are those of other things.
const APART: &str = "node";
/// Groups that are no nodes: bytes of sources, messages of standard types, nodes that stand apart.
const TAKEN_GROUPS: [&str; 3] = [RAW, "ros", APART];
/// Topics that are no nodes, beside those of stories.
const TAKEN: [&str; 2] = [FAULTS, "/tf"];

/// Whether the topic that a node of this path would have may be that of something else. Without an exception for those
/// below `APART`, two nodes could meet there.
fn is_taken(path: &str) -> bool {
    let group = path.split_once('/').map_or(path, |(group, _)| group);
    let topic = format!("/{path}");
    TAKEN_GROUPS.contains(&group) || TAKEN.contains(&&*topic) || Story::of(&topic).is_some()
}

/// The path of the node with this topic, which is without the `/` before it, if it is one of a node.
pub fn path_of(topic: &str) -> &str {
    let apart = topic
        .strip_prefix(APART)
        .and_then(|rest| rest.strip_prefix('/'));
    apart.unwrap_or(topic)
}

impl Node {
    /// A sensor of this path and format, of which nothing else is known.
    pub fn sensor(path: &str, format: &str) -> Self {
        Self {
            path: path.to_owned(),
            format: format.to_owned(),
            units: String::new(),
            about: String::new(),
            is_written: false,
            rest: String::new(),
            aliases: Vec::new(),
            is_raw: false,
        }
    }

    /// What the source of the node at this path gave: tuples of so many bytes.
    pub fn raw(path: &str, tuple_bytes: usize) -> Self {
        Self {
            is_raw: true,
            ..Self::sensor(path, &format!("u8 x {tuple_bytes}"))
        }
    }

    /// Its topic.
    pub(crate) fn topic(&self) -> String {
        format!("/{}", self.name())
    }

    /// The topic without the `/` before it.
    pub(crate) fn name(&self) -> String {
        match (self.is_raw, is_taken(&self.path)) {
            (true, _) => format!("{RAW}/{}", self.path),
            (false, true) => format!("{APART}/{}", self.path),
            (false, false) => self.path.clone(),
        }
    }

    /// What the channel says of it.
    pub(crate) fn metadata(&self) -> BTreeMap<String, String> {
        if self.is_raw {
            // Without a format it is no node, also for readers that know nothing of raw bytes.
            let bytes = Layout::parse(&self.format).map_or(0, |layout| layout.size());
            let all = [(RAW_OF, self.path.clone()), (BYTES, bytes.to_string())];
            return all.map(|(key, value)| (key.to_owned(), value)).into();
        }
        let access = if self.is_written { "rw" } else { "r" };
        let path = is_taken(&self.path).then(|| self.path.clone());
        let all = [
            (PATH, path.unwrap_or_default()),
            (FORMAT, self.format.clone()),
            (UNITS, self.units.clone()),
            (ABOUT, self.about.clone()),
            (ACCESS, access.to_owned()),
            (REST, self.rest.clone()),
            (ALIASES, self.aliases.join("\n")),
        ];
        let there = all.into_iter().filter(|(_, value)| !value.is_empty());
        there.map(|(key, value)| (key.to_owned(), value)).collect()
    }

    /// The node of a channel; None if it is one of something else.
    pub(crate) fn of_channel(topic: &str, metadata: &BTreeMap<String, String>) -> Option<Self> {
        let of = |key: &str| metadata.get(key).cloned().unwrap_or_default();
        if let Some(path) = metadata.get(RAW_OF) {
            let bytes = of(BYTES).parse().ok()?;
            let is_one = (1..=TUPLE_BYTES_MAX).contains(&bytes);
            return is_one.then(|| Self::raw(path, bytes));
        }
        Some(Self {
            path: match metadata.get(PATH) {
                Some(path) => path.clone(),
                None => topic.strip_prefix('/')?.to_owned(),
            },
            format: metadata.get(FORMAT)?.clone(),
            units: of(UNITS),
            about: of(ABOUT),
            is_written: of(ACCESS).contains('w'),
            rest: of(REST),
            aliases: of(ALIASES).lines().map(str::to_owned).collect(),
            is_raw: false,
        })
    }
}

/// A sample as a message.
///
/// # Errors
/// The tuple has another size than the layout.
pub(crate) fn encode(
    node: &str,
    layout: &Layout,
    unix_ns: u64,
    sequence: u32,
    tuple: &[u8],
) -> Result<Vec<u8>, Error> {
    if tuple.len() != layout.size() {
        return Err(Error::Tuple {
            node: node.to_owned(),
            bytes: tuple.len(),
            wanted: layout.size(),
        });
    }
    let mut out = Writer::new();
    stamp(&mut out, unix_ns);
    out.string("").u32(sequence);
    match layout {
        Layout::Bytes(_) => {
            out.bytes(tuple);
        }
        Layout::Text(_) => {
            out.string(text(tuple));
        }
        Layout::Fields(fields) => {
            let mut rest = tuple;
            for field in fields {
                let (bytes, after) = rest.split_at(field.kind.size());
                rest = after;
                put(&mut out, field, bytes);
            }
        }
    }
    Ok(out.finish())
}

fn put(out: &mut Writer, field: &Field, bytes: &[u8]) {
    let mut little = [0; 8];
    let little = &mut little[..bytes.len()];
    little.copy_from_slice(bytes);
    if field.is_big_endian {
        little.reverse();
    }
    out.number(little);
}

/// The tuple of a message; None if it is no sample of this layout.
pub(crate) fn decode(layout: &Layout, message: &[u8]) -> Option<Vec<u8>> {
    let mut read = Reader::new(message)?;
    read.i32()?;
    read.u32()?;
    read.string()?;
    read.u32()?;
    let size = layout.size();
    let tuple = match layout {
        Layout::Bytes(_) => read.bytes(size)?.to_vec(),
        Layout::Text(_) => {
            let mut tuple = read.string()?.as_bytes().to_vec();
            (tuple.len() <= size).then(|| tuple.resize(size, 0))?;
            tuple
        }
        Layout::Fields(fields) => {
            let mut tuple = Vec::with_capacity(size);
            for field in fields {
                let bytes = read.number(field.kind.size())?;
                let begin = tuple.len();
                tuple.extend_from_slice(bytes);
                if field.is_big_endian {
                    tuple[begin..].reverse();
                }
            }
            tuple
        }
    };
    read.is_at_end().then_some(tuple)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_accelerometer_is_the_bytes_that_another_implementation_makes() {
        // header {0, 0, ""}, sequence 1, then x = 1, y = 2, z = 1000: 40 bytes less the errno of that example.
        let layout = Layout::parse("i32 x, i32 y, i32 z").unwrap();
        let tuple: Vec<u8> = [1_i32, 2, 1000]
            .iter()
            .flat_map(|n| n.to_le_bytes())
            .collect();
        let message = encode("a", &layout, 0, 1, &tuple).unwrap();
        let mut wanted = vec![0, 1, 0, 0];
        wanted.extend_from_slice(&[0; 8]);
        wanted.extend_from_slice(&[1, 0, 0, 0, 0, 0, 0, 0]);
        wanted.extend_from_slice(&[1, 0, 0, 0]);
        wanted.extend_from_slice(&tuple);
        assert_eq!(message, wanted);
    }

    #[test]
    fn a_channel_tells_what_its_node_is() {
        let mut node = Node::sensor("motors/M1", "i32 power");
        node.units = "%".to_owned();
        node.is_written = true;
        node.rest = "0".to_owned();
        node.aliases = vec!["left".to_owned(), "a b".to_owned()];
        assert_eq!(
            Node::of_channel(&node.topic(), &node.metadata()),
            Some(node)
        );
        assert_eq!(Node::of_channel("/faults", &BTreeMap::new()), None);
        let raw = Node::raw("motors/M1", 3);
        assert_eq!(raw.topic(), "/raw/motors/M1");
        assert_eq!(
            Node::of_channel(&raw.topic(), &raw.metadata()),
            Some(raw.clone())
        );
        for bytes in ["", "0", "-1", "4194305", "x"] {
            let mut metadata = raw.metadata();
            metadata.insert(BYTES.to_owned(), bytes.to_owned());
            assert_eq!(Node::of_channel(&raw.topic(), &metadata), None, "{bytes}");
        }
    }

    #[test]
    fn no_node_has_the_topic_of_another_thing() {
        for (path, topic) in [
            ("raw/A1", "/node/raw/A1"),
            ("raw", "/node/raw"),
            ("node/raw/A1", "/node/node/raw/A1"),
            ("ros/joint_states", "/node/ros/joint_states"),
            ("tf", "/node/tf"),
            ("world", "/node/world"),
            ("faults", "/node/faults"),
            ("rawness", "/rawness"),
            ("output/A1", "/output/A1"),
            ("sensors/raw", "/sensors/raw"),
        ] {
            let node = Node::sensor(path, "u8 x");
            assert_eq!(node.topic(), topic);
            assert_eq!(path_of(&node.name()), path);
            assert_eq!(Node::of_channel(topic, &node.metadata()), Some(node));
        }
        assert_eq!(Node::raw("node/A1", 1).topic(), "/raw/node/A1");
        // As older programs wrote it.
        let mut metadata = Node::sensor("raw/A1", "u8 x").metadata();
        metadata.remove(PATH);
        let node = Node::of_channel("/raw/A1", &metadata);
        assert_eq!(node.map(|node| node.path).as_deref(), Some("raw/A1"));
    }

    #[test]
    fn a_tuple_of_another_size_is_refused() {
        let refused = encode("a", &Layout::Bytes(4), 0, 0, &[1]);
        assert!(matches!(
            refused,
            Err(Error::Tuple {
                bytes: 1,
                wanted: 4,
                ..
            })
        ));
    }

    proptest! {
        #[test]
        fn every_tuple_comes_back(
            kinds in prop::collection::vec((0_usize..10, any::<bool>()), 1..20),
            seed in prop::collection::vec(any::<u8>(), 160),
        ) {
            let words = ["i8", "u8", "i16", "u16", "i32", "u32", "i64", "u64", "f32", "f64"];
            let text: Vec<String> = kinds.iter().enumerate().map(|(at, (kind, big))| {
                format!("{}{} f{at}", if *big { ">" } else { "" }, words[*kind])
            }).collect();
            let layout = Layout::parse(&text.join(", ")).unwrap();
            let tuple = &seed[..layout.size()];
            let message = encode("a", &layout, 5, 7, tuple).unwrap();
            prop_assert_eq!(decode(&layout, &message), Some(tuple.to_vec()));
            // A cut message is none.
            prop_assert_eq!(decode(&layout, &message[..message.len() - 1]), None);
        }
    }
}
