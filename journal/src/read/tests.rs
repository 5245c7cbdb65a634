//! Tests of files: what was written is read, from any moment on, whole, cut and damaged.

use super::*;
use crate::mend::mend;
use crate::standard::Level;
use crate::write::{ABOUT, Story, Writer};
use proptest::prelude::*;
use std::io::Cursor;

const MS: u64 = 1_000_000;
const ZERO: u64 = 1_700_000_000_000_000_000;

/// Two nodes: `fast` each ms, `slow` once at the beginning, with a failure of `fast` at half the time.
fn recording(ms: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    out.facts(
        ABOUT,
        BTreeMap::from([("robot".to_owned(), "r".to_owned())]),
    )
    .unwrap();
    out.attach(ZERO, "config.lua", "text/x-lua", b"trikfs = {}")
        .unwrap();
    let fast = out.add(&Node::sensor("a/fast", "i32 x, >u16 y")).unwrap();
    let slow = out.add(&Node::sensor("slow", "text 8")).unwrap();
    out.sample(slow, ZERO, b"here\0\0\0\0").unwrap();
    for at in 0..ms {
        let time = ZERO + at * MS;
        if at == ms / 2 {
            out.fault(fast, time, 5, "device: gone").unwrap();
            continue;
        }
        let mut tuple = u32::try_from(at).unwrap().to_le_bytes().to_vec();
        tuple.extend_from_slice(&[1, 2]);
        out.sample(fast, time, &tuple).unwrap();
    }
    let log = Log {
        level: Level::Warn,
        name: "trikfs".to_owned(),
        text: "a line".to_owned(),
        errno: 0,
    };
    out.log(ZERO + ms * MS, &log).unwrap();
    out.finish().unwrap();
    bytes
}

fn open(bytes: &[u8]) -> Result<Reader<Cursor<&[u8]>>, Error> {
    Reader::open(Cursor::new(bytes))
}

fn all(reader: &mut Reader<Cursor<&[u8]>>) -> Vec<Event> {
    let mut events = Vec::new();
    while let Some(event) = reader.next().unwrap() {
        events.push(event);
    }
    events
}

#[test]
fn what_sources_gave_is_read_apart_from_what_nodes_had() {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    let node = out.add(&Node::sensor("a/n", "i32 x")).unwrap();
    let raw = out.add(&Node::raw("a/n", 2)).unwrap();
    out.sample(raw, ZERO, &[1, 2]).unwrap();
    out.sample(node, ZERO + 1, &[7, 0, 0, 0]).unwrap();
    out.fault(raw, ZERO + MS, 19, "device: gone").unwrap();
    out.fault(node, ZERO + MS + 1, 19, "device: gone").unwrap();
    // Its tuples have another size from here on.
    let raw = out.add(&Node::raw("a/n", 3)).unwrap();
    out.sample(raw, ZERO + 2 * MS, &[1, 2, 3]).unwrap();
    assert!(out.sample(raw, ZERO, &[1]).is_err());
    out.finish().unwrap();
    let mut reader = open(&bytes).unwrap();
    assert_eq!(reader.nodes().len(), 1);
    assert_eq!(reader.raws(), ["a/n"]);
    assert_eq!(reader.counts().0["/raw/a/n"], 2);
    assert_eq!(
        all(&mut reader).len(),
        2,
        "the sample and the failure of the node"
    );
    reader.seek_raw(ZERO);
    let mut given = Vec::new();
    while let Some(event) = reader.next_raw().unwrap() {
        assert_eq!(event.raw, 0);
        given.push((event.unix_ns - ZERO, event.given));
    }
    let gone = Err((19, "device: gone".to_owned()));
    let wanted = [(0, Ok(vec![1, 2])), (MS, gone), (2 * MS, Ok(vec![1, 2, 3]))];
    assert_eq!(given, wanted);
}

#[test]
fn a_node_with_the_name_of_something_else_is_apart_from_it() {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    let node = out.add(&Node::sensor("raw/A1", "u8 x")).unwrap();
    let raw = out.add(&Node::raw("A1", 1)).unwrap();
    let world = out.add(&Node::sensor("world", "u8 x")).unwrap();
    out.sample(node, ZERO, &[1]).unwrap();
    out.sample(raw, ZERO, &[2]).unwrap();
    out.fault(raw, ZERO + MS, 19, "device: gone").unwrap();
    out.fault(node, ZERO + 2 * MS, 5, "no").unwrap();
    out.sample(world, ZERO + 3 * MS, &[3]).unwrap();
    let line = Log {
        level: Level::Info,
        name: String::new(),
        text: "{}".to_owned(),
        errno: 0,
    };
    out.line(Story::World, ZERO + 4 * MS, &line).unwrap();
    out.finish().unwrap();
    let mut reader = open(&bytes).unwrap();
    let paths: Vec<&str> = reader.nodes().iter().map(|node| &*node.path).collect();
    assert_eq!(paths, ["raw/A1", "world"]);
    assert_eq!(reader.raws(), ["A1"]);
    assert_eq!(reader.topic_of(0).as_deref(), Some("/node/raw/A1"));
    assert!(reader.has_raw());
    let events = all(&mut reader);
    let times: Vec<u64> = events.iter().map(|event| event.unix_ns - ZERO).collect();
    assert_eq!(times, [0, 2 * MS, 3 * MS, 4 * MS]);
    assert!(matches!(
        &events[1].what,
        EventKind::Fault {
            node: 0,
            errno: 5,
            ..
        }
    ));
    assert!(matches!(events[2].what, EventKind::Sample { node: 1, .. }));
    reader.seek_raw(ZERO);
    let first = reader.next_raw().unwrap().unwrap();
    assert_eq!((first.raw, first.given), (0, Ok(vec![2])));
    let second = reader.next_raw().unwrap().unwrap();
    assert_eq!(second.given, Err((19, "device: gone".to_owned())));
    assert_eq!(reader.next_raw(), Ok(None));
    // Of the node alone, from any moment on, and what it had.
    reader.seek_among(ZERO, &[0]);
    assert_eq!(all(&mut reader).len(), 1);
    let had = reader.newest(ZERO + 9 * MS).unwrap();
    assert!(had.iter().all(Option::is_some), "{had:?}");
}

/// A recording as programs made it that gave such a node the topic of its path.
fn older() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut out = mcap::Writer::new(Cursor::new(&mut bytes)).unwrap();
    let words = |pairs: &[(&str, &str)]| -> BTreeMap<String, String> {
        let pairs = pairs.iter();
        pairs
            .map(|(key, word)| ((*key).to_owned(), (*word).to_owned()))
            .collect()
    };
    let schema = out.add_schema("trik_msgs/msg/X", "ros2msg", b"").unwrap();
    let node = words(&[("format", "u8 x"), ("access", "r")]);
    let raw = words(&[("raw_of", "A1"), ("bytes", "1")]);
    for (topic, metadata, value) in [
        ("/raw/A1", &node, 1),
        ("/raw/A1", &raw, 2),
        ("/log", &node, 3),
    ] {
        let channel_id = out.add_channel(schema, topic, "cdr", metadata).unwrap();
        let layout = Layout::Bytes(1);
        let data = node::encode(topic, &layout, ZERO, 1, &[value]).unwrap();
        let header = mcap::records::MessageHeader {
            channel_id,
            sequence: 1,
            log_time: ZERO,
            publish_time: ZERO,
        };
        out.write_to_known_channel(&header, &data).unwrap();
    }
    out.finish().unwrap();
    drop(out);
    bytes
}

#[test]
fn older_recordings_with_one_topic_for_both_are_read() {
    let bytes = older();
    let mut reader = open(&bytes).unwrap();
    let paths: Vec<&str> = reader.nodes().iter().map(|node| &*node.path).collect();
    assert_eq!(paths, ["raw/A1", "log"]);
    let had: Vec<Vec<u8>> = (all(&mut reader).into_iter())
        .filter_map(|event| match event.what {
            EventKind::Sample { tuple, .. } => Some(tuple),
            EventKind::Fault { .. } | EventKind::Line(..) => None,
        })
        .collect();
    assert_eq!(had, [[1], [3]]);
    reader.seek_raw(ZERO);
    let first = reader.next_raw().unwrap().unwrap();
    assert_eq!((first.raw, first.given), (0, Ok(vec![2])));
    assert_eq!(reader.next_raw(), Ok(None));
}

#[test]
fn everything_that_was_written_is_read_in_its_order() {
    let bytes = recording(1000);
    let mut reader = open(&bytes).unwrap();
    assert_eq!(
        (reader.begin_ns(), reader.end_ns()),
        (ZERO, ZERO + 1000 * MS)
    );
    let paths: Vec<&str> = reader.nodes().iter().map(|node| &*node.path).collect();
    assert_eq!(paths, ["a/fast", "slow"]);
    assert_eq!(reader.layout(0).unwrap().names(), ["x", "y"]);
    assert_eq!(reader.counts().1, 1002);
    assert_eq!(reader.counts().0["/a/fast"], 999);
    assert_eq!(reader.attachment("config.lua").unwrap(), b"trikfs = {}");
    assert!(matches!(reader.attachment("x"), Err(Error::Absent(_))));
    assert_eq!(reader.facts(ABOUT).unwrap()["robot"], "r");
    let events = all(&mut reader);
    assert_eq!(events.len(), 1002);
    assert!(events.is_sorted_by_key(|event| event.unix_ns));
    let third = events.iter().find(|event| event.unix_ns == ZERO + 3 * MS);
    let wanted = EventKind::Sample {
        node: 0,
        layout: 0,
        sequence: 4,
        tuple: vec![3, 0, 0, 0, 1, 2],
    };
    assert_eq!(third.unwrap().what, wanted);
    let fault = events.iter().find(|event| event.unix_ns == ZERO + 500 * MS);
    let wanted = EventKind::Fault {
        node: 0,
        errno: 5,
        reason: "device: gone".to_owned(),
    };
    assert_eq!(fault.unwrap().what, wanted);
    assert!(
        matches!(&events.last().unwrap().what, EventKind::Line(Story::Log, log) if log.text == "a line")
    );
}

#[test]
fn a_moment_is_found_with_what_each_node_had_before_it() {
    let bytes = recording(30_000);
    let mut reader = open(&bytes).unwrap();
    let at = ZERO + 20_000 * MS;
    reader.seek(at);
    assert_eq!(reader.next().unwrap().unwrap().unix_ns, at);
    let newest = reader.newest(at).unwrap();
    let times: Vec<u64> = newest.iter().flatten().map(|event| event.unix_ns).collect();
    // The slow one is many chunks further back.
    assert_eq!(times, [at - MS, ZERO]);
    reader.seek_among(ZERO, &[1]);
    let slow = reader.next().unwrap().unwrap();
    assert_eq!((slow.unix_ns, slow.node()), (ZERO, Some(1)));
    assert_eq!(reader.next().unwrap(), None);
    reader.seek(at + MS);
    // It has disturbed nothing.
    assert_eq!(reader.next().unwrap().unwrap().unix_ns, at + MS);
    assert_eq!(reader.newest(ZERO).unwrap(), [None, None]);
    let failed = reader.newest(ZERO + 15_000 * MS + 1).unwrap();
    assert!(matches!(
        failed[0].as_ref().unwrap().what,
        EventKind::Fault { errno: 5, .. }
    ));
}

#[test]
fn a_node_whose_format_changes_stays_one_node() {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    let before = out.add(&Node::sensor("n", "u8 x")).unwrap();
    out.sample(before, ZERO, &[1]).unwrap();
    let after = out.add(&Node::sensor("n", "u16 x")).unwrap();
    out.sample(after, ZERO + MS, &[1, 0]).unwrap();
    out.finish().unwrap();
    let mut reader = open(&bytes).unwrap();
    assert_eq!(reader.nodes().len(), 1);
    assert_eq!(reader.nodes()[0].format, "u16 x");
    let tuples: Vec<usize> = all(&mut reader)
        .iter()
        .map(|event| match &event.what {
            EventKind::Sample { tuple, .. } => tuple.len(),
            EventKind::Fault { .. } | EventKind::Line(..) => 0,
        })
        .collect();
    assert_eq!(tuples, [1, 2]);
}

#[test]
fn bytes_that_are_no_recording_are_refused() {
    assert_eq!(open(b"").err(), Some(Error::NotARecording));
    assert_eq!(open(b"#!/bin/sh").err(), Some(Error::NotARecording));
    assert_eq!(open(mcap::MAGIC).err(), Some(Error::Cut));
    let refused = mend(&b"#!/bin/sh"[..], Cursor::new(Vec::new()));
    assert_eq!(refused, Err(Error::NotARecording));
}

#[test]
fn a_recording_that_is_cut_anywhere_is_mended_up_to_its_last_whole_chunk() {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    let node = out.add(&Node::sensor("n", "u32 x")).unwrap();
    for at in 0..200_u32 {
        out.sample(node, ZERO + u64::from(at) * MS, &at.to_le_bytes())
            .unwrap();
        if at == 99 {
            out.flush().unwrap();
        }
    }
    out.finish().unwrap();
    let whole = open(&bytes).unwrap();
    let chunks = &whole.summary.chunk_indexes;
    assert_eq!(chunks.len(), 2);
    let begin = usize::try_from(chunks[1].chunk_start_offset).unwrap();
    let end = begin + usize::try_from(chunks[1].chunk_length).unwrap();
    // At every byte of the last chunk, and some beyond it.
    for cut in begin..(end + 40).min(bytes.len() - 1) {
        assert_eq!(open(&bytes[..cut]).err(), Some(Error::Cut), "{cut}");
        let mut mended = Vec::new();
        let saved = mend(&bytes[..cut], Cursor::new(&mut mended)).unwrap();
        // The last bytes of a chunk say nothing: all that it holds, or nothing of it, and never a part.
        let wanted = match cut {
            _ if cut < end - 8 => 100,
            _ if cut < end => saved.messages.max(100),
            _ => 200,
        };
        assert_eq!(saved.messages, wanted, "{cut}");
        assert!([100, 200].contains(&wanted), "{cut}: {wanted}");
        let mut reader = open(&mended).unwrap();
        let events = all(&mut reader);
        assert_eq!(events.len() as u64, wanted, "{cut}");
        assert_eq!(reader.nodes()[0].format, "u32 x");
    }
    // Mending what is whole changes nothing that can be read.
    let mut mended = Vec::new();
    let saved = mend(&bytes[..], Cursor::new(&mut mended)).unwrap();
    assert_eq!((saved.messages, saved.cut), (200, None));
    assert_eq!(
        all(&mut open(&mended).unwrap()),
        all(&mut open(&bytes).unwrap())
    );
}

/// Three chunks of 100 samples each, and where they begin.
fn three_chunks() -> (Vec<u8>, Vec<usize>) {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    let node = out.add(&Node::sensor("a", "u32 x")).unwrap();
    for at in 0..300_u32 {
        out.sample(node, ZERO + u64::from(at) * MS, &at.to_le_bytes())
            .unwrap();
        if at % 100 == 99 {
            out.flush().unwrap();
        }
    }
    out.finish().unwrap();
    let whole = open(&bytes).unwrap();
    let chunks = whole.summary.chunk_indexes.iter();
    let begins = chunks.map(|chunk| usize::try_from(chunk.chunk_start_offset).unwrap());
    let begins = begins.collect();
    (bytes, begins)
}

#[test]
fn a_damaged_part_is_left_out_and_what_follows_it_is_kept() {
    let (whole, begins) = three_chunks();
    assert_eq!(begins.len(), 3);
    let mut bytes = whole.clone();
    bytes[begins[1] + 200] ^= 1;
    let mut reader = open(&bytes).unwrap();
    let why = loop {
        if let Err(why) = reader.next() {
            break why.to_string();
        }
    };
    let place = format!("in the part at byte {}", begins[1]);
    assert!(why.contains(&place), "{why}");
    let mut mended = Vec::new();
    let saved = mend(&bytes[..], Cursor::new(&mut mended)).unwrap();
    assert_eq!((saved.messages, saved.left_out), (200, 1));
    assert_eq!(saved.at, begins[1] as u64);
    assert!(!saved.is_only_cut());
    assert_eq!(all(&mut open(&mended).unwrap()).len(), 200);
    assert_eq!(crate::mend::check(&bytes[..]).unwrap().left_out, 1);
    assert_eq!(crate::mend::check(&whole[..]).unwrap().cut, None);
    // Lengths that lead nowhere are the end of what can be read.
    bytes[begins[1] + 1..begins[1] + 9].fill(0xff);
    let saved = mend(&bytes[..], Cursor::new(Vec::new())).unwrap();
    assert_eq!((saved.messages, saved.is_only_cut()), (100, false));
}

#[test]
fn channels_of_a_damaged_part_are_those_of_the_summary() {
    let (mut bytes, begins) = three_chunks();
    bytes[begins[0] + 200] ^= 1;
    let saved = mend(&bytes[..], Cursor::new(Vec::new())).unwrap();
    assert_eq!((saved.messages, saved.left_out), (0, 201));
    let mut mended = Vec::new();
    let from = Cursor::new(&bytes);
    let saved = crate::mend::mend_file(from, Cursor::new(&mut mended)).unwrap();
    assert_eq!((saved.messages, saved.left_out), (200, 1));
    let mut reader = open(&mended).unwrap();
    assert_eq!(reader.nodes()[0].format, "u32 x");
    assert_eq!(all(&mut reader).len(), 200);
}

#[test]
fn a_length_in_the_summary_takes_no_memory() {
    let whole = recording(10);
    let end = whole.len() - 8;
    // Lengths of the topic, of its encoding and of what is said of it.
    let topic = b"/a/fast";
    let at = whole.windows(7).rposition(|bytes| bytes == topic).unwrap();
    for place in [at - 4, at + 7, at + 7 + 4 + 3] {
        let mut bytes = whole.clone();
        bytes[place..place + 4].fill(0xff);
        // No checksum of the summary.
        bytes[end - 4..end].fill(0);
        let refused = open(&bytes).err();
        assert!(matches!(refused, Some(Error::Damaged(_))), "{refused:?}");
        let saved = crate::mend::mend_file(Cursor::new(&bytes), Cursor::new(Vec::new()));
        assert_eq!(saved.unwrap().messages, 12);
    }
}

#[test]
fn an_index_that_leads_elsewhere_takes_no_memory() {
    let bytes = recording(10);
    let mut reader = open(&bytes).unwrap();
    reader.summary.attachment_indexes[0].length = u64::MAX;
    assert!(matches!(
        reader.attachment("config.lua"),
        Err(Error::TooLarge { .. })
    ));
    reader.summary.attachment_indexes[0].length = 10_000;
    assert!(matches!(
        reader.attachment("config.lua"),
        Err(Error::Damaged(_))
    ));
    let mut chunk = reader.summary.chunk_indexes[0].clone();
    chunk.uncompressed_size = u64::MAX;
    assert!(check_chunk(&chunk, u64::MAX).is_err());
    chunk.chunk_start_offset = u64::MAX;
    assert!(check_chunk(&chunk, u64::MAX).is_err());
}

/// Everything that a reader believes, of a file with one other byte: an error, or what was written.
#[test]
fn no_other_byte_becomes_another_number() {
    let whole = recording(60);
    let everything = |bytes: &[u8]| -> Result<_, Error> {
        let mut reader = open(bytes)?;
        let file = reader.attachment("config.lua")?;
        let nodes = reader.nodes().to_vec();
        let mut events = Vec::new();
        while let Some(event) = reader.next()? {
            events.push(event);
        }
        let newest = reader.newest(ZERO + 30 * MS)?;
        Ok((file, nodes, events, newest))
    };
    let wanted = everything(&whole).unwrap();
    let mut refused = 0;
    for at in 0..whole.len() {
        for change in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= change;
            match everything(&bytes) {
                Ok(read) => assert!(read == wanted, "byte {at}"),
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > whole.len(), "{refused}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn damage_is_an_error_and_never_a_crash(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
        is_cut in any::<bool>(),
    ) {
        let mut bytes = recording(60);
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if is_cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        crate::fuzz::recording(&bytes);
    }
}

#[test]
fn a_piece_has_what_is_wanted_and_all_that_explains_it() {
    let bytes = recording(1000);
    let mut piece = Vec::new();
    let wanted = |topic: &str, at: u64| topic != "/log" && at >= ZERO + 499 * MS;
    let saved = crate::mend::copy(&bytes[..], Cursor::new(&mut piece), wanted).unwrap();
    // 499, 501 to 999, and the failure between them.
    assert_eq!(
        (saved.messages, saved.attachments, saved.cut),
        (501, 1, None)
    );
    let mut reader = open(&piece).unwrap();
    assert_eq!(reader.begin_ns(), ZERO + 499 * MS);
    assert_eq!(reader.nodes().len(), 2);
    assert_eq!(reader.attachment("config.lua").unwrap(), b"trikfs = {}");
    assert_eq!(reader.facts(ABOUT).unwrap()["robot"], "r");
}

#[test]
fn samples_before_and_after_a_change_of_the_format_are_told_apart() {
    let mut bytes = Vec::new();
    let mut out = Writer::new(Cursor::new(&mut bytes), "test 1").unwrap();
    for (at, format) in ["i32 x", "f32 x"].into_iter().enumerate() {
        let node = out.add(&Node::sensor("a", format)).unwrap();
        out.sample(node, ZERO + at as u64, &[0, 0, 128, 63])
            .unwrap();
    }
    out.finish().unwrap();
    let mut reader = open(&bytes).unwrap();
    assert_eq!(reader.layouts_of(0), [0, 1]);
    let shown: Vec<String> = all(&mut reader)
        .into_iter()
        .map(|event| match event.what {
            EventKind::Sample { layout, tuple, .. } => reader.layouts()[layout].show(&tuple),
            EventKind::Fault { .. } | EventKind::Line(..) => String::new(),
        })
        .collect();
    assert_eq!(shown, ["1065353216", "1"]);
}
