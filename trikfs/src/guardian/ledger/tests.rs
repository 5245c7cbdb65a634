//! A ledger is read by a process that must survive whatever the dead one left in it.

use super::*;
use config::description::SourceDescription;
use needs::Random;

fn action(path: &str, bytes: &[u8]) -> RestAction {
    RestAction {
        sink: SourceDescription::Path(path.into()),
        tuple: bytes.to_vec(),
        timeout_ms: 1,
    }
}

#[test]
fn what_one_holder_records_the_other_reads() {
    let ledger = Ledger::create().expect("created");
    let other = Ledger::inherited(ledger.number()).expect("opened");
    assert_eq!(
        (other.config(), other.rest(), other.cached()),
        (None, vec![], vec![])
    );
    let rest = vec![
        action("/dev/motor", b"\0\0"),
        action("/sys/x y", b""),
        action("/dev/motor", &[255; 60_000]),
    ];
    ledger.set_config(b"trikfs = {}").expect("config");
    ledger.set_rest(&rest).expect("rest");
    ledger.set_cached(&[7, u64::MAX]).expect("cached");
    assert_eq!(other.copies(), b"");
    ledger.set_copies(b"a\0b").expect("copies");
    assert_eq!(other.copies(), b"a\0b");
    assert_eq!(other.config().as_deref(), Some(&b"trikfs = {}"[..]));
    assert_eq!(other.rest(), rest);
    assert_eq!(other.cached(), [7, u64::MAX]);
    other.set_rest(&[]).expect("cleared by the other side");
    assert_eq!(ledger.rest(), []);
    assert_eq!(ledger.config().as_deref(), Some(&b"trikfs = {}"[..]));
}

#[test]
fn an_empty_configuration_is_one() {
    let ledger = Ledger::create().expect("created");
    ledger.set_config(b"").expect("config");
    assert_eq!(ledger.config(), Some(vec![]));
}

#[test]
fn the_last_of_many_writes_counts_also_when_the_sequence_wraps() {
    let ledger = Ledger::create().expect("created");
    let near_the_end = header(Section::Config, u32::MAX - 2, b"0");
    let offset = Section::Config.offset(0);
    ledger
        .file
        .write_all_at(&near_the_end, offset)
        .expect("written");
    ledger
        .file
        .write_all_at(b"0", offset + HEADER_BYTES as u64)
        .expect("written");
    for number in 1..10_u8 {
        ledger.set_config(&[number]).expect("config");
        assert_eq!(ledger.config(), Some(vec![number]));
    }
}

#[test]
fn a_write_cut_short_anywhere_leaves_the_value_before_it() {
    let ledger = Ledger::create().expect("created");
    let old: Vec<u8> = vec![b'a'; 300];
    let new: Vec<u8> = vec![b'b'; 300];
    for cut in 0..HEADER_BYTES + new.len() {
        ledger.set_config(b"older").expect("config");
        ledger.set_config(&old).expect("config");
        let (slot, sequence, _) = ledger.newest(Section::Config).expect("there");
        let offset = Section::Config.offset(1 - slot);
        // The order of `write`: zeros over the header, payload, header.
        let mut steps = vec![0; HEADER_BYTES];
        steps.extend_from_slice(&new[..cut.min(new.len())]);
        ledger.file.write_all_at(&steps, offset).expect("written");
        if let Some(part @ 1..) = cut.checked_sub(new.len()) {
            let header = header(Section::Config, sequence.wrapping_add(1), &new);
            ledger
                .file
                .write_all_at(&header[..part], offset)
                .expect("written");
        }
        assert_eq!(
            ledger.config().as_ref(),
            Some(&old),
            "cut after {cut} bytes"
        );
    }
}

#[test]
fn a_truncated_ledger_gives_the_older_value_or_none() {
    let ledger = Ledger::create().expect("created");
    ledger.set_cached(&[1]).expect("cached");
    ledger.set_cached(&[2, 3]).expect("cached");
    ledger
        .file
        .set_len(Section::Cached.offset(1) + HEADER_BYTES as u64 + 9)
        .expect("truncated");
    assert_eq!(ledger.cached(), [1]);
    for size in [Section::Cached.offset(0) + 3, 1, 0] {
        ledger.file.set_len(size).expect("truncated");
        assert_eq!(ledger.cached(), [0; 0]);
    }
    ledger.set_cached(&[4]).expect("usable again");
    assert_eq!(ledger.cached(), [4]);
}

#[test]
fn garbage_is_never_taken_for_a_value() {
    let seed = 0x5eed_0001;
    println!("seed {seed:#x}");
    let mut random = Random::new(seed);
    let ledger = Ledger::create().expect("created");
    let rest = vec![action("/dev/a", b"12"), action("/dev/b", b"345")];
    for round in 0..2000 {
        ledger.set_config(b"trikfs = {}").expect("config");
        ledger.set_rest(&rest).expect("rest");
        ledger.set_cached(&[9, 8]).expect("cached");
        for _ in 0..=random.below(40) {
            let section = Section::ALL[random.below(Section::ALL.len())];
            let offset = section.offset(random.below(2)) + random.below(60) as u64;
            ledger
                .file
                .write_all_at(&random.bits().to_le_bytes(), offset)
                .expect("written");
        }
        assert!(
            [None, Some(b"trikfs = {}".to_vec())].contains(&ledger.config()),
            "round {round}"
        );
        assert!(
            [vec![], rest.clone()].contains(&ledger.rest()),
            "round {round}"
        );
        assert!(
            [vec![], vec![9, 8]].contains(&ledger.cached()),
            "round {round}"
        );
    }
}

#[test]
fn any_payload_decodes_without_panic_or_large_memory() {
    let seed = 0x5eed_0002;
    println!("seed {seed:#x}");
    let mut random = Random::new(seed);
    let good = actions::encode(&[action("/dev/a", b"12"), action("/dev/b", b"345")]);
    let good = good.expect("devices");
    for _ in 0..20_000 {
        let mut bytes = good.clone();
        let at = random.below(bytes.len());
        bytes[at] = random.bits() as u8;
        bytes.truncate(random.below(bytes.len() + 1));
        if let Some(actions) = actions::decode(&bytes) {
            assert_eq!(actions::encode(&actions), Some(bytes));
        }
    }
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let ledger = Ledger::create().expect("created");
    ledger.set_config(b"small").expect("config");
    ledger
        .set_config(&vec![0; config::limits::CONFIG_BYTES_MAX + 1])
        .expect_err("too large");
    assert_eq!(ledger.config().as_deref(), Some(&b"small"[..]));
    ledger
        .set_config(&vec![1; config::limits::CONFIG_BYTES_MAX])
        .expect("just fits");
    ledger
        .set_cached(&vec![1; limits::CACHED_MAX + 1])
        .expect_err("too many");
    ledger
        .set_rest(&vec![action("a", b""); limits::REST_ACTIONS_MAX + 1])
        .expect_err("too many");
    ledger
        .set_rest(&[action("a", &vec![0; 4 << 20])])
        .expect_err("too large");
    assert_eq!(
        ledger.config().map(|bytes| bytes.len()),
        Some(config::limits::CONFIG_BYTES_MAX)
    );
}
