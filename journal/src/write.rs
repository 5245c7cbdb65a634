//! Writing a recording.
//!
//! Owns the order of what is in a file, and its channels. Compression and framing are those of the crate `mcap`. Nothing here
//! waits for a device or reads a clock: a caller that must not be delayed writes on a thread of its own.

use crate::error::Error;
use crate::layout::Layout;
use crate::limits::{CHUNK_BYTES, NODES_MAX, TEXT_BYTES_MAX};
use crate::node::{self, Node};
use crate::schema::{ENCODING, MESSAGE_ENCODING, Names, schema_of, text_of, type_of};
use crate::standard::robot::{self, Message};
use crate::standard::{self, Log};
use mcap::records::MessageHeader;
use mcap::{Attachment, Compression, WriteOptions};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};

/// The topic of failures: a node has no value, and why.
pub const FAULTS: &str = "/faults";
/// The name of the metadata that say where the recording is from.
pub const ABOUT: &str = "trikfs";

/// What a line of a recording is about; each has a topic of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Story {
    /// The log of the tree.
    Log,
    /// Programs begin and end, and what is wrong with them.
    Programs,
    /// What programs print.
    Output,
    /// Messages of other robots.
    Mail,
    /// Where a diagram is, with its variables: JSON.
    Diagram,
    /// Where the robots and the things of a virtual world are: JSON.
    World,
}

impl Story {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Log,
        Self::Programs,
        Self::Output,
        Self::Mail,
        Self::Diagram,
        Self::World,
    ];

    /// Its topic.
    pub fn topic(self) -> &'static str {
        match self {
            Self::Log => "/log",
            Self::Programs => "/programs",
            Self::Output => "/output",
            Self::Mail => "/mail",
            Self::Diagram => "/diagram",
            Self::World => "/world",
        }
    }

    /// That of a topic; None if it is another one.
    pub fn of(topic: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|story| story.topic() == topic)
    }
}

/// A recording that is being written. It is finished by `finish`, or when it is dropped.
pub struct Writer<W: Write + Seek> {
    file: mcap::Writer<W>,
    nodes: Vec<Channel>,
    names: Names,
    faults: u16,
    /// The channels of lines; None before the first line.
    stories: [Option<u16>; Story::ALL.len()],
    /// When the recording begins, in ns since 1970.
    begin_ns: u64,
}

struct Channel {
    id: u16,
    path: String,
    layout: Layout,
    sequence: u32,
}

/// Bytes of a recording that is read while it is made; copies are the same bytes.
#[derive(Clone, Debug, Default)]
pub struct Out(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Out {
    /// What was written since the last call.
    pub fn take(&self) -> Vec<u8> {
        std::mem::take(&mut *self.lock()).into_inner()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Cursor<Vec<u8>>> {
        // Bytes are whole, whatever failed elsewhere.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Out {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.lock().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Out {
    /// It only goes forward: the place that is asked for is that of the bytes that nobody has taken yet.
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.lock().seek(to)
    }
}

/// A node of a recording that is being written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Id(usize);

/// A topic with messages of a standard type in a recording that is being written.
#[derive(Debug)]
pub struct Topic<M> {
    id: u16,
    sequence: u32,
    kind: PhantomData<M>,
}

impl<W: Write + Seek> Writer<W> {
    /// Begins a recording; `library` is the program that writes, with its version.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn new(out: W, library: &str) -> Result<Self, Error> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(library)
            .compression(Some(Compression::Lz4))
            .chunk_size(Some(CHUNK_BYTES))
            // A chunk is written whole: a recorder that is killed leaves none that is broken.
            .disable_seeking(true);
        Self::with(options.create(out))
    }

    /// Begins a recording that is read while it is made and has no end: each message is written at once, and nothing of it is
    /// kept. It has neither chunks nor a summary; `mend` makes a file of it.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn live(out: W, library: &str) -> Result<Self, Error> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(library)
            .use_chunks(false)
            .calculate_data_section_crc(false)
            .disable_seeking(true);
        Self::with(options.create(out))
    }

    fn with(file: mcap::McapResult<mcap::Writer<W>>) -> Result<Self, Error> {
        let mut file = file.map_err(Error::writing)?;
        let faults = lines(&mut file, FAULTS)?;
        let log = lines(&mut file, Story::Log.topic())?;
        let mut stories = [None; Story::ALL.len()];
        stories[Story::Log as usize] = Some(log);
        Ok(Self {
            file,
            nodes: Vec::new(),
            names: Names::default(),
            faults,
            stories,
            begin_ns: 0,
        })
    }

    /// The recording begins at this moment. What is older was still so then: it stands at the beginning, and keeps its own time
    /// as the time of publication.
    pub fn begin_at(&mut self, unix_ns: u64) {
        self.begin_ns = unix_ns;
    }

    /// A node from now on. One whose format changes is added once more: same topic, another type.
    ///
    /// # Errors
    /// Its format is none, there are too many nodes, or the file cannot be written.
    pub fn add(&mut self, node: &Node) -> Result<Id, Error> {
        if self.nodes.len() == NODES_MAX {
            return Err(Error::TooMany("nodes"));
        }
        let layout = Layout::parse(&node.format)?;
        let name = schema_of(&self.names.take(type_of(&node.name())));
        let schema = (self.file)
            .add_schema(&name, ENCODING, text_of(&layout).as_bytes())
            .map_err(Error::writing)?;
        let id = (self.file)
            .add_channel(schema, &node.topic(), MESSAGE_ENCODING, &node.metadata())
            .map_err(Error::writing)?;
        self.nodes.push(Channel {
            id,
            path: node.name(),
            layout,
            sequence: 0,
        });
        Ok(Id(self.nodes.len() - 1))
    }

    /// The form of the tuples of a node.
    pub fn layout(&self, node: Id) -> &Layout {
        &self.nodes[node.0].layout
    }

    /// A sample of a node.
    ///
    /// # Errors
    /// The tuple is not as the format says, or the file cannot be written.
    pub fn sample(&mut self, node: Id, unix_ns: u64, tuple: &[u8]) -> Result<(), Error> {
        let channel = &mut self.nodes[node.0];
        let sequence = channel.sequence.wrapping_add(1);
        let message = node::encode(&channel.path, &channel.layout, unix_ns, sequence, tuple)?;
        channel.sequence = sequence;
        let id = channel.id;
        // The message counts itself; a second counter beside it would be compressed badly.
        self.message(id, 0, unix_ns, &message)
    }

    /// A topic with messages of a standard type from now on; its name begins with `/`.
    ///
    /// # Errors
    /// There are too many, or the file cannot be written.
    pub fn topic<M: Message>(&mut self, name: &str) -> Result<Topic<M>, Error> {
        let text = robot::text_of::<M>();
        let schema = (self.file)
            .add_schema(M::NAME, ENCODING, text.as_bytes())
            .map_err(Error::writing)?;
        let id = (self.file)
            .add_channel(schema, name, MESSAGE_ENCODING, &BTreeMap::new())
            .map_err(Error::writing)?;
        Ok(Topic {
            id,
            sequence: 0,
            kind: PhantomData,
        })
    }

    /// A message of a standard type.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn publish<M: Message>(
        &mut self,
        topic: &mut Topic<M>,
        unix_ns: u64,
        message: &M,
    ) -> Result<(), Error> {
        topic.sequence = topic.sequence.wrapping_add(1);
        let data = robot::encode(message, unix_ns);
        self.message(topic.id, topic.sequence, unix_ns, &data)
    }

    /// A node has no value.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn fault(&mut self, node: Id, unix_ns: u64, errno: i32, reason: &str) -> Result<(), Error> {
        let fault = Log {
            level: standard::Level::Error,
            name: self.nodes[node.0].path.clone(),
            text: cut(reason).to_owned(),
            errno: errno.unsigned_abs(),
        };
        self.message(self.faults, 0, unix_ns, &fault.encode(unix_ns))
    }

    /// A line of the log.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn log(&mut self, unix_ns: u64, line: &Log) -> Result<(), Error> {
        self.line(Story::Log, unix_ns, line)
    }

    /// A line of one of the stories.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn line(&mut self, story: Story, unix_ns: u64, line: &Log) -> Result<(), Error> {
        let line = Log {
            text: cut(&line.text).to_owned(),
            ..line.clone()
        };
        let id = match self.stories[story as usize] {
            Some(id) => id,
            None => lines(&mut self.file, story.topic())?,
        };
        self.stories[story as usize] = Some(id);
        self.message(id, 0, unix_ns, &line.encode(unix_ns))
    }

    fn message(&mut self, id: u16, sequence: u32, unix_ns: u64, data: &[u8]) -> Result<(), Error> {
        let begin_ns = self.begin_ns;
        if unix_ns >= begin_ns {
            // It has begun. If the clock is set back later, times are what they are.
            self.begin_ns = 0;
        }
        let header = MessageHeader {
            channel_id: id,
            sequence,
            log_time: unix_ns.max(begin_ns),
            publish_time: unix_ns,
        };
        (self.file)
            .write_to_known_channel(&header, data)
            .map_err(Error::writing)
    }

    /// A file that goes with the recording: the configuration in force, a program.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn attach(
        &mut self,
        unix_ns: u64,
        name: &str,
        media_type: &str,
        bytes: &[u8],
    ) -> Result<(), Error> {
        let attachment = Attachment {
            log_time: unix_ns,
            create_time: unix_ns,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: Cow::Borrowed(bytes),
        };
        self.file.attach(&attachment).map_err(Error::writing)
    }

    /// Facts about the recording, by a name; [`ABOUT`] for where it is from.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn facts(&mut self, name: &str, facts: BTreeMap<String, String>) -> Result<(), Error> {
        let metadata = mcap::records::Metadata {
            name: name.to_owned(),
            metadata: facts,
        };
        (self.file)
            .write_metadata(&metadata)
            .map_err(Error::writing)
    }

    /// Ends the chunk and hands everything to the file, so that a kill loses nothing of it. What a power cut loses is the
    /// business of the caller, who has the file: it must be synced.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.file.flush().map_err(Error::writing)
    }

    /// Writes the summary, by which readers find things, and the end.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<(), Error> {
        self.file.finish().map(drop).map_err(Error::writing)
    }
}

/// A channel of lines.
fn lines<W: Write + Seek>(file: &mut mcap::Writer<W>, topic: &str) -> Result<u16, Error> {
    let text = standard::log_text();
    let schema = file.add_schema(standard::LOG, ENCODING, text.as_bytes());
    let schema = schema.map_err(Error::writing)?;
    file.add_channel(schema, topic, MESSAGE_ENCODING, &BTreeMap::new())
        .map_err(Error::writing)
}

/// A text within the limit.
fn cut(text: &str) -> &str {
    let mut end = text.len().min(TEXT_BYTES_MAX);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    &text[..end]
}
