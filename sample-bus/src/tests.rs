//! The two ends of a ring together, with hostile files and hostile names.

use crate::layout::{self, HEADER_BYTES, Layout};
use crate::place::{self, Directory};
use crate::{Event, Reader, Rights, Step, Writer};
use proptest::prelude::*;
use std::collections::HashMap;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::os::unix::fs::{FileExt, PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::TempDir;

const READABLE: Rights = Rights {
    mode: 0o444,
    group: None,
};

/// A directory for one test, gone with it.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn ring(&self, tuple_bytes: usize) -> (Writer, Reader) {
        let path = self.path("ring");
        let writer = Writer::create(&path, tuple_bytes, READABLE).unwrap();
        (writer, Reader::open_file(&path).unwrap())
    }
}

fn errno(result: io::Result<Event>) -> i32 {
    result.unwrap_err().raw_os_error().unwrap()
}

fn now_ns() -> u64 {
    let event = Event {
        sequence: 0,
        time_ns: 0,
        errno: 0,
    };
    event.age_ns()
}

#[test]
fn a_reader_gets_the_newest_value_and_what_came_before() {
    let folder = Folder::new();
    let (mut writer, mut reader) = folder.ring(5);
    let mut tuple = Vec::new();
    assert_eq!(errno(reader.newest(&mut tuple)), libc::EAGAIN);
    assert_eq!(reader.next_event(&mut tuple), Step::Nothing);
    writer.publish(7, b"first");
    writer.publish(8, b"2");
    let event = reader.newest(&mut tuple).unwrap();
    assert_eq!((event.sequence, event.time_ns, event.errno), (2, 8, 0));
    assert_eq!(tuple, b"2");
    for (sequence, time_ns, bytes) in [(1, 7, &b"first"[..]), (2, 8, b"2")] {
        let errno = 0;
        let event = Event {
            sequence,
            time_ns,
            errno,
        };
        assert_eq!(reader.next_event(&mut tuple), Step::Event(event));
        assert_eq!(tuple, bytes);
    }
    assert_eq!(reader.next_event(&mut tuple), Step::Nothing);
}

#[test]
fn a_failure_an_old_value_and_a_node_that_is_gone_are_no_values() {
    let folder = Folder::new();
    let (mut writer, reader) = folder.ring(4);
    let mut tuple = Vec::new();
    writer.publish(now_ns(), b"good");
    writer.fail(now_ns(), libc::ENODEV);
    assert_eq!(errno(reader.newest(&mut tuple)), libc::ENODEV);
    assert!(tuple.is_empty());
    writer.publish(now_ns() - 11_000_000, b"good");
    reader.newest(&mut tuple).unwrap();
    writer.set_stale_ms(10);
    assert_eq!(errno(reader.newest(&mut tuple)), libc::ETIMEDOUT);
    writer.publish(now_ns(), b"good");
    writer.set_stale_ms(60_000);
    reader.newest(&mut tuple).unwrap();
    assert!(reader.is_current());
    drop(writer);
    assert_eq!(errno(reader.newest(&mut tuple)), libc::ESTALE);
    assert!(!reader.is_current() && !folder.path("ring").exists());
}

#[test]
fn a_ring_whose_file_was_replaced_is_not_current() {
    let folder = Folder::new();
    let (_first, reader) = folder.ring(4);
    std::fs::remove_file(folder.path("ring")).unwrap();
    assert!(!reader.is_current());
    let (_second, other) = folder.ring(4);
    assert!(!reader.is_current() && other.is_current());
}

#[test]
fn a_slow_reader_hears_how_many_events_it_has_missed() {
    let folder = Folder::new();
    let (mut writer, mut reader) = folder.ring(4);
    let mut tuple = Vec::new();
    let kept = u32::try_from(reader.history()).unwrap() - 1;
    writer.publish(1, b"1");
    assert!(matches!(reader.next_event(&mut tuple), Step::Event(_)));
    for number in 2..=101_u64 {
        writer.publish(number, &number.to_ne_bytes()[..4]);
    }
    assert_eq!(reader.next_event(&mut tuple), Step::Missed(100 - kept));
    for number in 102 - kept..=101 {
        let Step::Event(event) = reader.next_event(&mut tuple) else {
            panic!("event {number}");
        };
        assert_eq!((event.sequence, event.time_ns), (number, number.into()));
        assert_eq!(tuple, number.to_ne_bytes());
    }
    assert_eq!(reader.next_event(&mut tuple), Step::Nothing);
    // A late reader begins with the oldest, and has missed nothing.
    let mut late = Reader::open_file(&folder.path("ring")).unwrap();
    let Step::Event(event) = late.next_event(&mut tuple) else {
        panic!("nothing");
    };
    assert_eq!(event.sequence, 102 - kept);
}

#[test]
fn numbers_wrap_and_leave_out_the_one_that_means_nothing_yet() {
    let folder = Folder::new();
    let (mut writer, mut reader) = folder.ring(4);
    let mut tuple = Vec::new();
    writer.start_from(u32::MAX - 2);
    let mut seen = Vec::new();
    for _ in 0..4 {
        writer.publish(1, b"x");
        if let Step::Event(event) = reader.next_event(&mut tuple) {
            seen.push(event.sequence);
        }
    }
    // The first of a ring that begins so high is looked for where the oldest kept one would be.
    assert_eq!(reader.newest_event(&mut tuple).unwrap().sequence, 2);
    assert_eq!(layout::next_event(u32::MAX), 1);
    assert!(seen.iter().all(|sequence| *sequence != 0));
}

#[test]
fn nobody_sees_half_of_two_events() {
    const BYTES: usize = 4_000;
    let folder = Folder::new();
    let (mut writer, reader) = folder.ring(BYTES);
    let done = AtomicBool::new(false);
    let mut seen = 0;
    std::thread::scope(|scope| {
        scope.spawn(|| {
            for number in 1..=60_000_u32 {
                writer.publish(number.into(), &[number.to_ne_bytes()[0]; BYTES]);
            }
            done.store(true, Ordering::Relaxed);
        });
        let mut tuple = Vec::new();
        loop {
            let last_round = done.load(Ordering::Relaxed);
            if let Some(event) = reader.newest_event(&mut tuple) {
                seen += 1;
                assert_eq!(event.time_ns, u64::from(event.sequence));
                let byte = event.sequence.to_ne_bytes()[0];
                assert!(tuple.len() == BYTES && tuple.iter().all(|other| *other == byte));
            }
            if last_round {
                break;
            }
        }
    });
    assert!(seen > 0);
}

#[test]
fn a_ring_can_be_read_by_all_who_may_and_written_by_nobody() {
    let folder = Folder::new();
    let (_writer, _) = folder.ring(4);
    let mode = std::fs::metadata(folder.path("ring"))
        .unwrap()
        .permissions()
        .mode();
    assert_eq!(mode & 0o7777, READABLE.mode);
    let again = Writer::create(&folder.path("ring"), 4, READABLE).unwrap_err();
    assert_eq!(again.kind(), ErrorKind::AlreadyExists);
}

#[test]
fn large_tuples_have_a_shorter_history() {
    let folder = Folder::new();
    let (mut writer, reader) = folder.ring(3 << 20);
    assert_eq!(reader.history(), 4);
    let frame: Vec<u8> = (0..3 << 20).map(|at: u32| at.to_le_bytes()[1]).collect();
    let mut tuple = Vec::new();
    for _ in 0..9 {
        writer.publish(1, &frame);
        reader.newest(&mut tuple).unwrap();
        assert!(tuple == frame);
    }
    assert!(Layout::new(1 << 30).is_err());
}

#[test]
fn files_that_are_no_rings_are_refused() {
    let folder = Folder::new();
    let path = folder.path("foreign");
    let mut header = [0; HEADER_BYTES];
    {
        let (_writer, _) = folder.ring(8);
        File::open(folder.path("ring"))
            .unwrap()
            .read_exact_at(&mut header, 0)
            .unwrap();
    }
    let open = |header: &[u8; HEADER_BYTES], bytes: u64| {
        let file = File::create(&path).unwrap();
        file.write_all_at(header, 0).unwrap();
        file.set_len(bytes).unwrap();
        Reader::open_file(&path)
    };
    assert!(open(&header, 4096).is_ok());
    assert!(open(&header, 64).is_err());
    assert!(open(&header, 10).is_err());
    for at in (0..36).step_by(4).filter(|at| ![24, 28, 32].contains(at)) {
        for number in [0, 3, 12, u32::MAX] {
            let mut bad = header;
            bad[at..at + 4].copy_from_slice(&number.to_ne_bytes());
            let opened = open(&bad, 1 << 20);
            let fits = at == layout::AT_TUPLE_BYTES && number < 33;
            assert_eq!(opened.is_ok(), fits, "{number} at {at}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn arbitrary_memory_harms_no_reader(
        bytes in prop::collection::vec(any::<u8>(), 4096),
        newest in any::<u32>(),
    ) {
        let folder = Folder::new();
        let path = folder.path("hostile");
        let (writer, _) = folder.ring(8);
        let mut all = bytes;
        File::open(folder.path("ring")).unwrap().read_exact_at(&mut all[..HEADER_BYTES], 0).unwrap();
        all[layout::AT_NEWEST..layout::AT_NEWEST + 4].copy_from_slice(&newest.to_ne_bytes());
        drop(writer);
        std::fs::write(&path, &all).unwrap();
        let mut reader = Reader::open_file(&path).unwrap();
        let mut tuple = Vec::new();
        for _ in 0..4 {
            let _ = reader.newest(&mut tuple);
            prop_assert!(tuple.len() <= 8);
            let _ = reader.next_event(&mut tuple);
            let _ = reader.event(newest, &mut tuple);
        }
    }

    #[test]
    fn two_paths_never_have_the_same_name(one in "[a-z/+%. \u{e4}]{1,12}", other in "[a-z/+%. \u{e4}]{1,12}") {
        let name = |path: &str| place::directory(Path::new("/dev/shm"), Path::new(path)).unwrap();
        if Path::new(&one).as_os_str() != Path::new(&other).as_os_str() {
            prop_assert_ne!(name(&one).into_os_string(), name(&other).into_os_string());
        }
    }
}

#[test]
fn names_are_as_the_manual_says() {
    let name = |path| place::directory(Path::new("/dev/shm"), Path::new(path)).unwrap();
    assert_eq!(name("/mnt/robot"), Path::new("/dev/shm/trikfs+mnt+robot"));
    assert_eq!(name("/a+b/c d"), Path::new("/dev/shm/trikfs+a%2Bb+c%20d"));
    assert_eq!(place::file_name("sensors/A1").unwrap(), "sensors+A1");
    assert!(place::file_name("").is_err() && place::file_name("../x").is_err());
    assert!(place::file_name(&"x".repeat(256)).is_err());
}

#[test]
fn a_directory_has_one_publisher_and_is_cleaned_of_what_a_dead_one_left() {
    let folder = Folder::new();
    let path = folder.path("trikfs+mnt");
    let first = Directory::take(&path, 0o755).unwrap();
    assert_eq!(path.metadata().unwrap().permissions().mode() & 0o777, 0o755);
    std::fs::write(path.join("ring"), b"x").unwrap();
    let second = Directory::take(&path, 0o755).unwrap_err();
    assert_eq!(second.kind(), ErrorKind::ResourceBusy);
    assert!(!place::remove_left(&path) && path.join("ring").exists());
    drop(first);
    assert!(!path.exists());

    std::fs::create_dir_all(path.join("folder/folder")).unwrap();
    std::fs::write(path.join("ring"), b"x").unwrap();
    symlink(folder.path(""), path.join("link")).unwrap();
    let next = Directory::take(&path, 0o700).unwrap();
    assert_eq!(std::fs::read_dir(&path).unwrap().count(), 0);
    drop(next);

    std::fs::create_dir(&path).unwrap();
    std::fs::write(path.join("ring"), b"x").unwrap();
    let other = folder.path("trikfs+other");
    let lives = Directory::take(&other, 0o700).unwrap();
    place::sweep(folder.0.path());
    assert!(!path.exists() && lives.path().exists());
    assert!(!place::remove_left(&path));
}

#[test]
fn a_link_in_the_place_of_the_directory_is_not_followed() {
    let folder = Folder::new();
    let precious = folder.path("precious");
    std::fs::create_dir(&precious).unwrap();
    std::fs::write(precious.join("file"), b"x").unwrap();
    symlink(&precious, folder.path("trikfs+mnt")).unwrap();
    assert!(Directory::take(&folder.path("trikfs+mnt"), 0o700).is_err());
    assert!(!place::remove_left(&folder.path("trikfs+mnt")));
    assert!(precious.join("file").exists());
}

#[test]
fn publishers_that_begin_and_sweepers_do_not_disturb_each_other() {
    let folder = Folder::new();
    std::thread::scope(|scope| {
        for number in 0..4 {
            let path = folder.path(&format!("trikfs+{number}"));
            let shared_memory = folder.0.path();
            scope.spawn(move || {
                for _ in 0..50 {
                    place::sweep(shared_memory);
                    let taken = Directory::take(&path, 0o700).unwrap();
                    let ring = Writer::create(&taken.path().join("ring"), 4, READABLE).unwrap();
                    place::sweep(shared_memory);
                    assert!(taken.path().join("ring").exists());
                    std::mem::forget(ring);
                }
            });
        }
    });
    assert_eq!(std::fs::read_dir(folder.0.path()).unwrap().count(), 0);
}

#[test]
fn a_directory_that_was_removed_is_noticed_and_another_one_in_its_place_stays() {
    let folder = Folder::new();
    let path = folder.path("bus");
    let gone = Directory::take(&path, 0o700).unwrap();
    assert!(gone.is_there());
    std::fs::remove_dir_all(&path).unwrap();
    assert!(!gone.is_there());
    gone.set_links(&HashMap::new()).unwrap();
    let links = HashMap::from([("one".to_owned(), "ring".to_owned())]);
    let (name, error) = gone.set_links(&links).unwrap_err();
    assert_eq!(name, "one");
    let why = error.to_string();
    assert!(why.starts_with(&path.display().to_string()), "{why}");
    let another = Directory::take(&path, 0o700).unwrap();
    assert!(!gone.is_there());
    drop(gone);
    assert!(another.is_there());
}

#[test]
fn second_names_are_those_that_are_wanted_and_never_replace_a_ring() {
    let folder = Folder::new();
    let directory = Directory::take(&folder.path("bus"), 0o700).unwrap();
    let at = |name: &str| directory.path().join(name);
    let links = |pairs: &[(&str, &str)]| {
        let owned = pairs
            .iter()
            .map(|(a, b)| ((*a).to_owned(), (*b).to_owned()));
        directory.set_links(&owned.collect())
    };
    std::fs::write(at("ring"), "of a node").unwrap();
    links(&[("one", "ring"), ("two", "absent")]).unwrap();
    assert_eq!(std::fs::read_to_string(at("one")).unwrap(), "of a node");
    assert!(!at("two").exists());
    links(&[("two", "ring")]).unwrap();
    assert!(at("one").symlink_metadata().is_err());
    assert_eq!(std::fs::read_to_string(at("two")).unwrap(), "of a node");
    let (name, error) = links(&[("ring", "two")]).unwrap_err();
    assert_eq!(
        (name.as_str(), error.kind()),
        ("ring", io::ErrorKind::AlreadyExists)
    );
    assert_eq!(std::fs::read_to_string(at("ring")).unwrap(), "of a node");
    let path = directory.path().to_owned();
    drop(directory);
    assert!(!path.exists());
}
