//! Reading a recording: what is in it, and what happened from any moment on.
//!
//! Owns seeking and its bounds, and what messages mean. The file comes from anywhere: `container` checks it, and whatever
//! contradicts itself is an error and no panic. A file without an end is for `mend`.

mod container;

use crate::error::Error;
use crate::layout::Layout;
use crate::limits::{ATTACHMENT_BYTES_MAX, CHUNKS_BACK, NODES_MAX, RECORD_BYTES_MAX};
use crate::node::{self, Node};
use crate::shape::is_whole;
use crate::standard::Log;
use crate::write::{FAULTS, Story};
pub(crate) use container::summary_of;
use container::{attachment_of, check_chunk, new_indexed, step};
use mcap::Summary;
use mcap::records::op;
use mcap::sans_io::{IndexedReader, IndexedReaderOptions, indexed_reader::ReadOrder};
use std::collections::{BTreeMap, HashMap};
use std::io::{Read, Seek, SeekFrom};

/// A recording that can be read.
pub struct Reader<F> {
    file: F,
    size: u64,
    summary: Summary,
    nodes: Vec<Node>,
    layouts: Vec<Layout>,
    /// Nodes whose sources are recorded too, by their paths.
    raws: Vec<String>,
    /// What each channel carries.
    carries: HashMap<u16, Carries>,
    /// Nodes and sources by the names that failures have, which are those of their topics.
    named: HashMap<String, usize>,
    raws_named: HashMap<String, usize>,
    /// Reads forwards; None before the first event is wanted.
    forwards: Option<IndexedReader>,
    from_ns: u64,
    /// Topics that are wanted; empty for all.
    only: Vec<String>,
    chunk: Vec<u8>,
}

/// What the messages of a channel are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carries {
    /// Samples of the node with this number, in the layout with this number.
    Samples(usize, usize),
    /// What the source gave of which `raws` has the node, in tuples of so many bytes.
    Raw(usize, usize),
    Faults,
    Lines(Story),
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Event {
    /// When, in ns since 1970.
    pub unix_ns: u64,
    /// What.
    pub what: EventKind,
}

/// What the source of a node gave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RawEvent {
    /// When, in ns since 1970.
    pub unix_ns: u64,
    /// Among `raws`.
    pub raw: usize,
    /// Its bytes as they were before the converter, or the errno and the reason why it gave none.
    pub given: Result<Vec<u8>, (i32, String)>,
}

/// What happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// A sample of the node with this number.
    Sample {
        /// Among `nodes`.
        node: usize,
        /// Its layout, among `layouts`; one node may have several, one after the other.
        layout: usize,
        /// Its number among the samples of the node, from 1.
        sequence: u32,
        /// Its bytes, as `bin_data` had them.
        tuple: Vec<u8>,
    },
    /// A node had no value.
    Fault {
        /// Among `nodes`.
        node: usize,
        /// Its errno.
        errno: i32,
        /// Why.
        reason: String,
    },
    /// A line of the log, or of another story.
    Line(Story, Log),
}

impl<F: Read + Seek> Reader<F> {
    /// Reads what is in it, and none of the events.
    ///
    /// # Errors
    /// It is none, it is cut, or it contradicts itself.
    pub fn open(mut file: F) -> Result<Self, Error> {
        let mut summary = summary_of(&mut file)?;
        let size = file.seek(SeekFrom::End(0))?;
        // Chunks are found again by their place.
        summary
            .chunk_indexes
            .sort_by_key(|index| index.chunk_start_offset);
        for index in &summary.chunk_indexes {
            check_chunk(index, size)?;
        }
        let mut reader = Self {
            file,
            size,
            summary,
            nodes: Vec::new(),
            layouts: Vec::new(),
            raws: Vec::new(),
            carries: HashMap::new(),
            named: HashMap::new(),
            raws_named: HashMap::new(),
            forwards: None,
            from_ns: 0,
            only: Vec::new(),
            chunk: Vec::new(),
        };
        reader.learn_channels()?;
        reader.from_ns = reader.begin_ns();
        Ok(reader)
    }

    /// Which channels are nodes. Those of other programs are left out.
    fn learn_channels(&mut self) -> Result<(), Error> {
        let mut channels: Vec<_> = self.summary.channels.values().cloned().collect();
        channels.sort_by_key(|channel| channel.id);
        for channel in channels {
            let topic = channel.topic.as_str();
            // What is said of a channel comes first: older recordings have nodes with topics of other things.
            let carries = match Node::of_channel(topic, &channel.metadata) {
                Some(node) => self.learn_node(topic.trim_start_matches('/'), node)?,
                None if topic == FAULTS => Carries::Faults,
                None => match Story::of(topic) {
                    Some(story) => Carries::Lines(story),
                    None => continue,
                },
            };
            self.carries.insert(channel.id, carries);
        }
        Ok(())
    }

    /// A channel of this name has samples of a node, or what its source gave.
    fn learn_node(&mut self, name: &str, node: Node) -> Result<Carries, Error> {
        if self.layouts.len() == NODES_MAX || self.raws.len() == NODES_MAX {
            return Err(Error::TooMany("nodes"));
        }
        let layout = Layout::parse(&node.format)?;
        if node.is_raw {
            let known = self.raws.iter().position(|other| *other == node.path);
            let raw = known.unwrap_or(self.raws.len());
            if known.is_none() {
                self.raws.push(node.path);
            }
            self.raws_named.insert(name.to_owned(), raw);
            return Ok(Carries::Raw(raw, layout.size()));
        }
        self.layouts.push(layout);
        let known = self.nodes.iter().position(|other| other.path == node.path);
        let number = known.unwrap_or(self.nodes.len());
        match known {
            // A later format is the one that it has.
            Some(number) => self.nodes[number] = node,
            None => self.nodes.push(node),
        }
        self.named.insert(name.to_owned(), number);
        Ok(Carries::Samples(number, self.layouts.len() - 1))
    }

    /// The topics of the channels that carry this.
    fn topics(&self, is_it: impl Fn(&Carries) -> bool) -> Vec<String> {
        let channels = self.carries.iter().filter(|(_, carries)| is_it(carries));
        let channels = channels.filter_map(|(id, _)| self.summary.channels.get(id));
        channels.map(|channel| channel.topic.clone()).collect()
    }

    /// The topic of a node.
    pub fn topic_of(&self, node: usize) -> Option<String> {
        let is_it = |carries: &Carries| matches!(carries, Carries::Samples(of, _) if *of == node);
        self.topics(is_it).pop()
    }

    /// Whether any source gave anything, as far as the counts of the recording say; a piece of one may have their topics alone.
    pub fn has_raw(&self) -> bool {
        let Some(stats) = &self.summary.stats else {
            return !self.raws.is_empty();
        };
        let is_raw = |id: &u16| matches!(self.carries.get(id), Some(Carries::Raw(..)));
        let mut counts = stats.channel_message_counts.iter();
        counts.any(|(id, count)| is_raw(id) && *count > 0)
    }

    /// The paths of the nodes whose sources are recorded too.
    pub fn raws(&self) -> &[String] {
        &self.raws
    }

    /// The nodes, in the order in which they were added.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// All layouts of samples, in the order in which they came.
    pub fn layouts(&self) -> &[Layout] {
        &self.layouts
    }

    /// The numbers of the layouts that samples of a node have.
    pub fn layouts_of(&self, node: usize) -> Vec<usize> {
        let of_node = self.carries.values().filter_map(|carries| match carries {
            Carries::Samples(number, layout) if *number == node => Some(*layout),
            Carries::Samples(..) | Carries::Raw(..) | Carries::Faults | Carries::Lines(_) => None,
        });
        let mut all: Vec<usize> = of_node.collect();
        all.sort_unstable();
        all
    }

    /// The layout of the samples of a node; of one that changed it, the last.
    pub fn layout(&self, node: usize) -> Option<&Layout> {
        let last = self.layouts_of(node).pop()?;
        self.layouts.get(last)
    }

    /// When the first event was, in ns since 1970; 0 if there is none.
    pub fn begin_ns(&self) -> u64 {
        let chunks = self.summary.chunk_indexes.iter();
        // A chunk of schemas and channels alone has no time.
        let begins = chunks.filter(|index| index.message_end_time > 0);
        begins
            .map(|index| index.message_start_time)
            .min()
            .unwrap_or(0)
    }

    /// When the last event was.
    pub fn end_ns(&self) -> u64 {
        let ends = self.summary.chunk_indexes.iter();
        ends.map(|index| index.message_end_time).max().unwrap_or(0)
    }

    /// How many messages each topic has, and how many there are in all.
    pub fn counts(&self) -> (BTreeMap<String, u64>, u64) {
        let mut counts = BTreeMap::new();
        let Some(stats) = &self.summary.stats else {
            return (counts, 0);
        };
        for (id, count) in &stats.channel_message_counts {
            if let Some(channel) = self.summary.channels.get(id) {
                *counts.entry(channel.topic.clone()).or_default() += count;
            }
        }
        (counts, stats.message_count)
    }

    /// Bytes of the file.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Names and sizes of the files that go with it.
    pub fn attachments(&self) -> Vec<(String, u64)> {
        let indexes = self.summary.attachment_indexes.iter();
        indexes
            .map(|index| (index.name.clone(), index.data_size))
            .collect()
    }

    /// The last file of this name.
    ///
    /// # Errors
    /// There is none, it is too large, or the file contradicts itself.
    pub fn attachment(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        let mut indexes = self.summary.attachment_indexes.iter().rev();
        let found = indexes.find(|index| index.name == name);
        let index = found.ok_or_else(|| Error::Absent(format!("attachment {name}")))?;
        let (offset, length) = (index.offset, index.length);
        self.attached(name, offset, length)
    }

    fn attached(&mut self, name: &str, offset: u64, length: u64) -> Result<Vec<u8>, Error> {
        let record = self.record(offset, length, ATTACHMENT_BYTES_MAX)?;
        attachment_of(&record).ok_or_else(|| Error::Damaged(format!("attachment {name}")))
    }

    /// When the file of this name began to hold that was in force at a moment; before the first one, that.
    pub fn attachment_time(&self, name: &str, unix_ns: u64) -> Option<u64> {
        let indexes = self.summary.attachment_indexes.iter();
        let times = indexes.filter(|index| index.name == name);
        let times = times.map(|index| index.log_time);
        let until = times.clone().filter(|time| *time <= unix_ns).max();
        until.or_else(|| times.min())
    }

    /// The last file of this name and time.
    ///
    /// # Errors
    /// As for [`attachment`](Self::attachment).
    pub fn attachment_of(&mut self, name: &str, unix_ns: u64) -> Result<Vec<u8>, Error> {
        let mut indexes = self.summary.attachment_indexes.iter().rev();
        let found = indexes.find(|index| index.name == name && index.log_time == unix_ns);
        let index = found.ok_or_else(|| Error::Absent(format!("attachment {name}")))?;
        let (offset, length) = (index.offset, index.length);
        self.attached(name, offset, length)
    }

    /// Facts of this name; empty if there are none.
    ///
    /// # Errors
    /// The file contradicts itself.
    pub fn facts(&mut self, name: &str) -> Result<BTreeMap<String, String>, Error> {
        let mut indexes = self.summary.metadata_indexes.iter().rev();
        let Some(index) = indexes.find(|index| index.name == name) else {
            return Ok(BTreeMap::new());
        };
        let (offset, length) = (index.offset, index.length);
        let record = self.record(offset, length, RECORD_BYTES_MAX as u64)?;
        let damaged = || Error::Damaged("an index of metadata".to_owned());
        let body = match record.split_first() {
            Some((&op::METADATA, rest)) => rest.get(8..).ok_or_else(damaged)?,
            Some(_) | None => return Err(damaged()),
        };
        if !is_whole(op::METADATA, body) {
            return Err(damaged());
        }
        let parsed = mcap::parse_record(op::METADATA, body).map_err(Error::reading)?;
        let mcap::records::Record::Metadata(metadata) = parsed else {
            return Err(damaged());
        };
        Ok(metadata.metadata)
    }

    /// A whole record, its head too.
    fn record(&mut self, offset: u64, length: u64, most: u64) -> Result<Vec<u8>, Error> {
        if length > most {
            return Err(Error::TooLarge {
                what: "a part of the recording",
                bytes: length,
                most,
            });
        }
        if offset.checked_add(length).is_none_or(|end| end > self.size) {
            return Err(Error::Damaged("an index leads outside the file".to_owned()));
        }
        self.file.seek(SeekFrom::Start(offset))?;
        let mut record = vec![0; usize::try_from(length).unwrap_or(0)];
        self.file.read_exact(&mut record)?;
        Ok(record)
    }

    /// From now on `next` gives what happened at this moment and after it.
    pub fn seek(&mut self, unix_ns: u64) {
        self.seek_among(unix_ns, &[]);
    }

    /// As `seek`, but it gives samples of these nodes alone, and does not read chunks without any; of all if there are none.
    pub fn seek_among(&mut self, unix_ns: u64, nodes: &[usize]) {
        self.from_ns = unix_ns;
        self.only = self
            .topics(|carries| matches!(carries, Carries::Samples(node, _) if nodes.contains(node)));
        self.forwards = None;
    }

    /// As `seek_among`, but it gives failures too, those of other nodes among them.
    pub fn seek_with_failures(&mut self, unix_ns: u64, nodes: &[usize]) {
        self.seek_among(unix_ns, nodes);
        self.only.push(FAULTS.to_owned());
    }

    /// As `seek`, but it gives lines of this story alone, and does not read chunks without any.
    pub fn seek_lines(&mut self, unix_ns: u64, story: Story) {
        self.seek(unix_ns);
        self.only.push(story.topic().to_owned());
    }

    /// From now on `next_raw` gives what sources gave at this moment and after it.
    pub fn seek_raw(&mut self, unix_ns: u64) {
        self.seek(unix_ns);
        self.only = self.topics(|carries| matches!(carries, Carries::Raw(..)));
        self.only.push(FAULTS.to_owned());
    }

    /// What a source gave next, in the order of time; call `seek_raw` before.
    ///
    /// # Errors
    /// The file cannot be read, or contradicts itself.
    pub fn next_raw(&mut self) -> Result<Option<RawEvent>, Error> {
        while let Some((id, unix_ns, data)) = self.message()? {
            if let Some(event) = self.raw_event(id, unix_ns, &data)? {
                return Ok(Some(event));
            }
        }
        Ok(None)
    }

    fn raw_event(&self, id: u16, unix_ns: u64, data: &[u8]) -> Result<Option<RawEvent>, Error> {
        let (raw, given) = match self.carries.get(&id) {
            Some(&Carries::Raw(raw, bytes)) => {
                let tuple = node::decode(&Layout::Bytes(bytes), data);
                let what = || {
                    Error::Damaged(format!(
                        "bytes of the device of {} are none",
                        self.raws[raw]
                    ))
                };
                (raw, Ok(tuple.ok_or_else(what)?))
            }
            Some(Carries::Faults) => {
                let fault = Log::decode(data)
                    .ok_or_else(|| Error::Damaged("a message of faults is none".to_owned()))?;
                let Some(&raw) = self.raws_named.get(&fault.name) else {
                    return Ok(None);
                };
                let errno = i32::try_from(fault.errno).unwrap_or(i32::MAX);
                (raw, Err((errno, fault.text)))
            }
            Some(Carries::Samples(..) | Carries::Lines(_)) | None => return Ok(None),
        };
        Ok(Some(RawEvent {
            unix_ns,
            raw,
            given,
        }))
    }

    /// The next event, in the order of time.
    ///
    /// # Errors
    /// The file cannot be read, or contradicts itself.
    #[allow(
        clippy::should_implement_trait,
        reason = "it fails, and a position can be chosen in between"
    )]
    pub fn next(&mut self) -> Result<Option<Event>, Error> {
        while let Some((id, unix_ns, data)) = self.message()? {
            let event = self.event(id, unix_ns, &data);
            if let Some(event) = event? {
                return Ok(Some(event));
            }
        }
        Ok(None)
    }

    /// The next message of those that are wanted: its channel, its time, its bytes.
    fn message(&mut self) -> Result<Option<(u16, u64, Vec<u8>)>, Error> {
        let forwards = match &mut self.forwards {
            Some(forwards) => forwards,
            none => {
                let mut options = IndexedReaderOptions::new()
                    .with_order(ReadOrder::LogTime)
                    .starting_at(self.from_ns)
                    .with_record_length_limit(RECORD_BYTES_MAX);
                if !self.only.is_empty() {
                    options = options.include_topics(self.only.clone());
                }
                none.insert(new_indexed(&self.summary, options)?)
            }
        };
        let (file, chunk) = (&mut self.file, &mut self.chunk);
        step(forwards, &self.summary, file, chunk, &mut 0)
    }

    /// What each node had before this moment, the newest of it.
    ///
    /// # Errors
    /// The file cannot be read, or contradicts itself.
    pub fn newest(&mut self, unix_ns: u64) -> Result<Vec<Option<Event>>, Error> {
        let mut newest: Vec<Option<Event>> = vec![None; self.nodes.len()];
        let mut missing = newest.len();
        let mut before = unix_ns;
        let mut is_first = true;
        // First of all nodes; then, further back, of those alone that have been silent for long.
        while missing > 0 && before > 0 {
            let topics = self.topics_without(&newest);
            let options = IndexedReaderOptions::new()
                .with_order(ReadOrder::ReverseLogTime)
                .ending_before(before)
                .include_topics(topics)
                .with_record_length_limit(RECORD_BYTES_MAX);
            let mut backwards = new_indexed(&self.summary, options)?;
            let mut chunks = 0;
            let had = missing;
            loop {
                let (file, chunk) = (&mut self.file, &mut self.chunk);
                let got = step(&mut backwards, &self.summary, file, chunk, &mut chunks)?;
                let Some((id, at, data)) = got else {
                    return Ok(newest);
                };
                before = at;
                let event = self.event(id, at, &data)?;
                let node = event.as_ref().and_then(Event::node);
                if let Some(node) = node
                    && newest[node].is_none()
                {
                    newest[node] = event;
                    missing -= 1;
                }
                if missing == 0 {
                    return Ok(newest);
                }
                let found_some = missing < had;
                if chunks > CHUNKS_BACK && (is_first || found_some) {
                    break;
                }
            }
            is_first = false;
            // What has the same moment as the last one that was read is read again.
            before = before.saturating_add(1);
        }
        Ok(newest)
    }

    fn topics_without(&self, newest: &[Option<Event>]) -> Vec<String> {
        let mut topics = self.topics(
            |carries| matches!(carries, Carries::Samples(node, _) if newest[*node].is_none()),
        );
        topics.push(FAULTS.to_owned());
        topics
    }

    /// A message as an event; None if it is of another program.
    fn event(&self, id: u16, unix_ns: u64, data: &[u8]) -> Result<Option<Event>, Error> {
        let damaged = |what: &str| Error::Damaged(format!("a message of {what} is none"));
        let what = match self.carries.get(&id) {
            None | Some(Carries::Raw(..)) => return Ok(None),
            Some(&Carries::Samples(node, layout)) => {
                let name = &self.nodes[node].path;
                let tuple = node::decode(&self.layouts[layout], data);
                EventKind::Sample {
                    node,
                    layout,
                    sequence: sequence(data).unwrap_or(0),
                    tuple: tuple.ok_or_else(|| damaged(name))?,
                }
            }
            Some(Carries::Faults) => {
                let fault = Log::decode(data).ok_or_else(|| damaged("faults"))?;
                let Some(&node) = self.named.get(&fault.name) else {
                    return Ok(None);
                };
                EventKind::Fault {
                    node,
                    errno: i32::try_from(fault.errno).unwrap_or(i32::MAX),
                    reason: fault.text,
                }
            }
            Some(&Carries::Lines(story)) => {
                let line = Log::decode(data).ok_or_else(|| damaged(story.topic()))?;
                EventKind::Line(story, line)
            }
        };
        Ok(Some(Event { unix_ns, what }))
    }
}

impl Event {
    /// The node that it is of.
    pub fn node(&self) -> Option<usize> {
        match &self.what {
            EventKind::Sample { node, .. } | EventKind::Fault { node, .. } => Some(*node),
            EventKind::Line(..) => None,
        }
    }
}

fn sequence(data: &[u8]) -> Option<u32> {
    let mut read = crate::cdr::Reader::new(data)?;
    read.i32()?;
    read.u32()?;
    read.string()?;
    read.u32()
}

#[cfg(test)]
mod tests;
