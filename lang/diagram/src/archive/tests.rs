//! Containers whole, damaged and hostile.

use super::*;
use flate2::{Compress, Compression, FlushCompress};

fn entry(name: &str, bytes: &[u8]) -> Entry {
    Entry {
        name: name.to_owned(),
        bytes: bytes.to_vec(),
    }
}

fn opened(bytes: &[u8]) -> (Archive, Vec<String>) {
    let mut problems = Vec::new();
    let archive = open(bytes, &mut problems).expect("it opens");
    (archive, problems.iter().map(Problem::to_string).collect())
}

fn refused(bytes: &[u8]) -> String {
    let mut problems = Vec::new();
    open(bytes, &mut problems)
        .expect_err("it is refused")
        .to_string()
}

/// A save of the old container.
fn stream(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (name, piece) in entries {
        let name: Vec<u8> = name.encode_utf16().flat_map(u16::to_be_bytes).collect();
        bytes.extend((name.len() as u32).to_be_bytes());
        bytes.extend(name);
        let mut packed = Vec::with_capacity(piece.len() + 64);
        let mut compress = Compress::new(Compression::default(), true);
        compress
            .compress_vec(piece, &mut packed, FlushCompress::Finish)
            .unwrap();
        bytes.extend((packed.len() as u32 + 4).to_be_bytes());
        bytes.extend((piece.len() as u32).to_be_bytes());
        bytes.extend(packed);
    }
    bytes
}

fn find(bytes: &[u8], signature: u32) -> usize {
    let signature = signature.to_le_bytes();
    bytes
        .windows(4)
        .rposition(|window| window == signature)
        .unwrap()
}

#[test]
fn a_zip_gives_back_what_was_packed() {
    let entries = [
        entry("a.xml", b"short"),
        entry("tree/logical/{id}", &[b'x'; 5000]),
        entry("tree/\u{43c}", b""),
        entry("empty/", b""),
    ];
    let bytes = pack(&entries).unwrap();
    assert!(bytes.len() < 1000, "{} bytes are not packed", bytes.len());
    let (archive, problems) = opened(&bytes);
    assert_eq!(problems, [""; 0]);
    assert_eq!(archive.container, Container::Zip);
    let names: Vec<&str> = archive.entries.iter().map(|one| &*one.name).collect();
    assert_eq!(
        names,
        [
            "a.xml",
            "tree/",
            "tree/logical/",
            "tree/logical/{id}",
            "tree/\u{43c}",
            "empty/"
        ]
    );
    assert_eq!(archive.entries[3].bytes, entries[1].bytes);
    assert_eq!(pack(&archive.entries).unwrap(), bytes);
}

#[test]
fn a_stream_gives_back_what_was_packed() {
    let bytes = stream(&[
        ("/metaInfo.xml", b"<a/>"),
        ("\\tree\\logical\\{id}", b"<b/>"),
    ]);
    let (archive, problems) = opened(&bytes);
    assert_eq!(problems, [""; 0]);
    assert_eq!(archive.container, Container::Stream);
    assert_eq!(archive.entries[0], entry("metaInfo.xml", b"<a/>"));
    assert_eq!(archive.entries[1], entry("tree/logical/{id}", b"<b/>"));
}

#[test]
fn what_is_no_save_is_refused_in_words() {
    assert!(refused(b"").starts_with("the file is empty"));
    assert!(refused(b"#!/bin/sh\n").starts_with("this is not a project of TRIK Studio"));
    assert!(refused(b"\x89PNG\r\n").starts_with("this is not a project of TRIK Studio"));
    assert!(refused(b"PK").contains("cut short"));
    assert!(refused(&vec![0; limits::SAVE_BYTES + 1]).contains("too large for a project"));
}

#[test]
fn every_cut_of_a_save_is_refused() {
    let zip = pack(&[entry("a", b"one"), entry("b/c", &[7; 300])]).unwrap();
    let old = stream(&[("/a", b"one"), ("/b", &[7; 300])]);
    let second = stream(&[("/a", b"one")]).len();
    for length in 0..zip.len() {
        refused(&zip[..length]);
    }
    for length in (1..old.len()).filter(|&length| length != second) {
        refused(&old[..length]);
    }
    assert!(refused(&old[..old.len() - 1]).starts_with("/b: the save is cut short"));
}

#[test]
fn names_that_lead_out_are_left_out_and_told() {
    for name in ["../up", "a/../../b", "C:/windows", "..\\up", "/", "a\0b"] {
        let (archive, problems) = opened(&stream(&[("/ok", b"1"), (name, b"2")]));
        assert_eq!(archive.entries, [entry("ok", b"1")], "{name}");
        assert_eq!(problems.len(), 1, "{name}");
        assert!(
            problems[0].contains("its name leads out of the save"),
            "{problems:?}"
        );
    }
    let (archive, _) = opened(&stream(&[("//etc//./passwd", b"1")]));
    assert_eq!(archive.entries[0].name, "etc/passwd");
}

#[test]
fn of_two_entries_with_a_name_the_later_counts() {
    let (archive, problems) = opened(&stream(&[("/a", b"1"), ("\\a", b"2")]));
    assert_eq!(archive.entries, [entry("a", b"2")]);
    assert_eq!(
        problems,
        ["a: it is in the save twice, the later one is taken"]
    );
}

#[test]
fn a_changed_byte_in_an_entry_is_found() {
    let zip = pack(&[entry("a", &[b'x'; 3000])]).unwrap();
    for at in 31..31 + 10 {
        for bit in 0..8 {
            let mut bytes = zip.clone();
            bytes[at] ^= 1 << bit;
            let reason = refused(&bytes);
            assert!(
                reason.starts_with("a: it is damaged"),
                "{at}.{bit}: {reason}"
            );
        }
    }
    let mut old = stream(&[("/a", &[b'x'; 3000])]);
    let last = old.len() - 1;
    old[last] ^= 1;
    assert!(refused(&old).starts_with("/a: it is damaged"));
}

#[test]
fn bombs_are_refused_before_they_are_unpacked() {
    let bomb = stream(&[("/a", &vec![0; limits::ENTRY_BYTES + 1])]);
    assert!(refused(&bomb).contains("unpacked it is too large"));
    let piece = vec![0; limits::ENTRY_BYTES];
    let bomb = pack(&[entry("a", &piece), entry("b", &piece), entry("c", &piece)]).unwrap();
    assert!(bomb.len() < 200_000);
    assert!(refused(&bomb).starts_with("c: unpacked it is too large"));
    // One that lies about its size.
    let mut bytes = pack(&[entry("a", &[0; 100_000])]).unwrap();
    let directory = find(&bytes, 0x0201_4b50);
    bytes[directory + 24..directory + 28].copy_from_slice(&10_u32.to_le_bytes());
    assert!(refused(&bytes).contains("damaged"));
}

#[test]
fn nothing_is_unpacked_of_a_save_that_would_be_too_large() {
    let piece = vec![0; limits::ENTRY_BYTES];
    // The first piece is damaged, which only who unpacks it finds.
    let mut zip = pack(&[entry("a", &piece), entry("b", &piece), entry("c", &piece)]).unwrap();
    zip[40..60].fill(0xff);
    let reason = refused(&zip);
    assert!(
        reason.starts_with("c: unpacked it is too large"),
        "{reason}"
    );
    let mut old = stream(&[("/a", &piece), ("/b", &piece), ("/c", &piece)]);
    old[20..40].fill(0xff);
    let reason = refused(&old);
    assert!(
        reason.starts_with("/c: unpacked it is too large"),
        "{reason}"
    );
}

#[test]
fn what_no_packed_bytes_can_become_is_refused_before_it_is_unpacked() {
    let mut zip = pack(&[entry("a", &[0; 1000]), entry("b", &[1; 1000])]).unwrap();
    zip[31..34].fill(0xff);
    assert!(refused(&zip).starts_with("a: it is damaged"));
    let directory = find(&zip, 0x0201_4b50);
    zip[directory + 24..directory + 28].copy_from_slice(&20_000_000_u32.to_le_bytes());
    let reason = refused(&zip);
    assert!(reason.starts_with("b: it is damaged"), "{reason}");
}

#[test]
fn a_save_inside_of_a_save_stays_packed() {
    let mut inner = pack(&[entry("0", &vec![0; 1 << 20])]).unwrap();
    for depth in 0..20 {
        inner = pack(&[
            entry(&format!("{depth}.qrs"), &inner),
            entry("x.zip", &inner),
        ])
        .unwrap();
        assert!(inner.len() < limits::ENTRY_BYTES);
        let (archive, _) = opened(&inner);
        let bytes: usize = archive.entries.iter().map(|one| one.bytes.len()).sum();
        assert!(archive.entries.len() == 2 && bytes < limits::SAVE_UNPACKED_BYTES);
        if bytes * 2 > limits::ENTRY_BYTES / 4 {
            break;
        }
    }
}

/// The list of a zip with one entry, a number of times and each time with another name of the same length or not.
fn listed_again(zip: &[u8], count: u8, has_other_names: bool) -> Vec<u8> {
    let end = find(zip, 0x0605_4b50);
    let directory = find(zip, 0x0201_4b50);
    let mut record = zip[directory..end].to_vec();
    let mut bytes = zip[..directory].to_vec();
    let begin = bytes.len() as u32;
    for at in 0..count {
        if has_other_names {
            record[46] = b'a' + at;
        }
        bytes.extend(&record);
    }
    bytes.extend(0x0605_4b50_u32.to_le_bytes());
    bytes.extend([0, 0, 0, 0, count, 0, count, 0]);
    bytes.extend((u32::from(count) * record.len() as u32).to_le_bytes());
    bytes.extend(begin.to_le_bytes());
    bytes.extend([0, 0]);
    bytes
}

#[test]
fn entries_that_share_their_bytes_are_refused() {
    let zip = pack(&[entry("a", &[0; 100_000])]).unwrap();
    let reason = refused(&listed_again(&zip, 20, true));
    assert!(reason.contains("lie over each other"), "{reason}");
}

#[test]
fn a_zip_that_lists_an_entry_twice_is_told_of_and_unpacked_once() {
    let zip = pack(&[entry("a", &[0; 100_000])]).unwrap();
    let (archive, problems) = opened(&listed_again(&zip, 200, false));
    assert_eq!(archive.entries, [entry("a", &[0; 100_000])]);
    assert_eq!(
        problems,
        ["some files are in the save twice, the later ones are taken"]
    );
}

#[test]
fn a_zip_with_wide_numbers_is_refused_before_its_list_is_read() {
    let zip = pack(&[entry("a", b"1")]).unwrap();
    let end = find(&zip, 0x0605_4b50);
    let mut wide = zip[..end].to_vec();
    wide.extend(b"PK\x06\x07");
    wide.extend([0; 16]);
    wide.extend(&zip[end..]);
    assert!(refused(&wide).starts_with("the zip has 64-bit extensions"));
}

#[test]
fn a_name_is_packed_once() {
    let problem = pack(&[entry("a", b"1"), entry("a", b"2")]).unwrap_err();
    assert!(problem.to_string().starts_with("a: it cannot be packed"));
}

#[test]
fn names_of_a_zip_that_lead_out_are_left_out_and_told() {
    let (archive, problems) = opened(&pack(&[entry("ok", b"1"), entry("../up", b"2")]).unwrap());
    assert_eq!(archive.entries, [entry("ok", b"1")]);
    assert!(
        problems.iter().any(|told| told.contains("leads out")),
        "{problems:?}"
    );
}

#[test]
fn what_saves_do_not_use_is_refused_by_name() {
    let zip = pack(&[entry("a", &[b'x'; 3000])]).unwrap();
    let directory = find(&zip, 0x0201_4b50);
    let mut bytes = zip.clone();
    bytes[directory + 8] |= 1;
    assert!(refused(&bytes).starts_with("a: it is encrypted"));
    let mut bytes = zip.clone();
    bytes[directory + 10] = 12;
    assert!(refused(&bytes).starts_with("a: it is packed by method 12"));
    let mut bytes = zip;
    bytes[directory + 42] = 9;
    assert!(refused(&bytes).starts_with("a: it is damaged"));
}

#[test]
fn more_entries_than_a_zip_can_count_are_refused() {
    let record = stream(&[("/a", b"x")]);
    assert!(refused(&record.repeat(limits::ENTRIES + 1)).contains("may have 65535 files"));
    let entries: Vec<Entry> = (0..=limits::ENTRIES)
        .map(|at| entry(&at.to_string(), b""))
        .collect();
    let problem = pack(&entries).unwrap_err().to_string();
    assert!(problem.contains("may have 65535 files"), "{problem}");
}
