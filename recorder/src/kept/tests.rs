//! Tests of the black box: parts, savings, what a killed process leaves.

use super::*;
use crate::entry::Known;
use journal::node::Node;
use journal::read::{EventKind, Reader};
use std::sync::Arc;
use std::sync::mpsc::channel;
use tempfile::tempdir;

fn settings(directory: &Path) -> Settings {
    Settings {
        directory: directory.to_owned(),
        span: Duration::from_secs(3600),
        bytes: 1 << 20,
    }
}

fn nothing() -> OnSaved {
    Box::new(|told| panic!("nothing was left, but {told:?}"))
}

fn known(number: u32, path: &str) -> Arc<Known> {
    let node = Node::sensor(path, "u32 x");
    Arc::new(Known { number, node })
}

fn sample(known: &Arc<Known>, at: u32) -> Entry {
    let unix_ns = BEGIN_NS + u64::from(at);
    Entry::Sample(known.clone(), unix_ns, Arc::new(at.to_ne_bytes()))
}

/// The moment 0.
const BEGIN_NS: u64 = 1_700_000_000_000_000_000;

/// All values, in their order in time; that of the node that speaks once is the last.
fn values(path: &Path) -> Vec<u32> {
    let mut reader = Reader::open(File::open(path).unwrap()).unwrap();
    let mut all = Vec::new();
    while let Some(event) = reader.next().unwrap() {
        if let EventKind::Sample { tuple, .. } = event.what {
            all.push(u32::from_ne_bytes(tuple.try_into().unwrap()));
        }
    }
    all
}

/// Keeps one sample after the other, and begins a new part before each number that is named.
fn fill(kept: &mut BlackBox, all: std::ops::Range<u32>, parts: &[u32]) {
    let (known, still) = (known(1, "a"), known(2, "still"));
    for at in all {
        if parts.contains(&at) {
            kept.end_part();
        }
        // One node speaks once and each part begins with it; the other all the time.
        let mut batch = vec![sample(&known, at)];
        if at == 0 {
            batch.push(sample(&still, 1000));
        }
        kept.put(&batch.into(), || {
            let before = at.checked_sub(1).map(|before| sample(&known, before));
            let nodes = [Entry::Node(known.clone()), sample(&still, 1000)];
            nodes.into_iter().chain(before).collect()
        });
    }
}

fn saved_now(kept: &mut BlackBox, why: SaveReason) -> PathBuf {
    let (tell, told) = channel();
    kept.save(why, Box::new(move |path| tell.send(path).unwrap()));
    told.recv().unwrap().unwrap()
}

#[test]
fn parts_are_saved_as_one_file_without_what_they_repeat() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    assert!(kept.is_due(SaveReason::Stop));
    fill(&mut kept, 0..100, &[30, 60]);
    let path = saved_now(&mut kept, SaveReason::Stop);
    assert!(path.to_string_lossy().ends_with("-stop.mcap"));
    assert_eq!(values(&path), (0..100).chain([1000]).collect::<Vec<_>>());
    assert!(!kept.is_due(SaveReason::Stop), "not again and again");
    // It goes on meanwhile.
    fill(&mut kept, 100..150, &[]);
    let path = saved_now(&mut kept, SaveReason::Asked);
    assert_eq!(values(&path), (0..150).chain([1000]).collect::<Vec<_>>());
    kept.close();
    assert_eq!(named(folder.path(), PART).unwrap(), [] as [PathBuf; 0]);
    assert_eq!(saved(folder.path()).unwrap().len(), 2);
}

#[test]
fn the_oldest_part_begins_when_it_was_begun_and_not_with_what_was_long_before() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    let (moving, still) = (known(1, "a"), known(2, "still"));
    for at in [5000, 6000] {
        kept.end_part();
        let first = || vec![sample(&still, 10)];
        kept.put(&[sample(&moving, at)].into(), first);
    }
    let path = saved_now(&mut kept, SaveReason::Asked);
    let reader = Reader::open(File::open(&path).unwrap()).unwrap();
    assert_eq!(reader.begin_ns(), BEGIN_NS + 5000);
    assert_eq!(values(&path), [10, 5000, 6000], "and not once more");
}

#[test]
fn what_is_too_much_or_too_old_goes() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    fill(&mut kept, 0..30, &[10, 20]);
    kept.end_part();
    for part in &mut kept.parts {
        part.bytes = 400 << 10;
    }
    kept.forget(Instant::now());
    assert_eq!(kept.parts.len(), 2, "of three parts with 1200 KiB");
    assert_eq!(values(&saved_now(&mut kept, SaveReason::Asked))[0], 10);
    kept.forget(Instant::now() + Duration::from_secs(3601));
    assert_eq!(kept.parts.len(), 0);
    let (tell, told) = channel();
    kept.save(
        SaveReason::Asked,
        Box::new(move |path| tell.send(path).unwrap()),
    );
    let told = told.recv().unwrap().unwrap_err().to_string();
    assert!(told.contains("yet"), "{told}");
}

#[test]
fn what_a_killed_process_has_left_is_saved_by_the_next() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    fill(&mut kept, 0..100, &[50]);
    kept.end_part();
    for part in &mut kept.parts {
        part.writing.take().unwrap().join().unwrap().unwrap();
    }
    // The last part has no end, as after a kill.
    let last = kept.parts.back().unwrap().path.clone();
    let bytes = fs::read(&last).unwrap();
    fs::write(&last, &bytes[..bytes.len() - 8]).unwrap();
    drop(kept);
    fs::write(folder.path().join("part-9999999999999999.mcap"), "").unwrap();
    let (tell, told) = channel();
    let tell = Box::new(move |path| tell.send(path).unwrap());
    let _kept = BlackBox::open(settings(folder.path()), "test", tell).unwrap();
    let path = told.recv().unwrap().unwrap();
    assert_eq!(values(&path), (0..100).chain([1000]).collect::<Vec<_>>());
    assert_eq!(named(folder.path(), PART).unwrap(), [] as [PathBuf; 0]);
}

#[test]
fn one_is_saved_at_a_time_and_the_end_waits_for_it() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    fill(&mut kept, 0..100, &[50]);
    let (tell, told) = channel();
    let (go, wait) = channel();
    kept.save(
        SaveReason::Stop,
        Box::new(move |path| {
            wait.recv().unwrap();
            tell.send(path).unwrap();
        }),
    );
    // As while parts are put together.
    kept.is_saving.store(true, Ordering::Relaxed);
    let (refuse, refused) = channel();
    kept.save(
        SaveReason::Asked,
        Box::new(move |path| refuse.send(path).unwrap()),
    );
    assert_eq!(refused.recv().unwrap(), Err(Error::Saving));
    go.send(()).unwrap();
    kept.close();
    let path = told.try_recv().unwrap().unwrap();
    assert_eq!(values(&path).len(), 101);
}

#[test]
fn only_so_many_saved_files_are_kept() {
    let folder = tempdir().unwrap();
    let save = |at: usize, why: &str| {
        fs::write(folder.path().join(format!("{SAVED}{at:02}-{why}.mcap")), "").unwrap();
    };
    for at in 0..limits::BOX_SAVED + 3 {
        save(at, "stop");
        save(at, "asked");
    }
    prune(folder.path()).unwrap();
    let left = saved(folder.path()).unwrap();
    let is_asked = |path: &&PathBuf| path.to_string_lossy().ends_with("asked.mcap");
    assert_eq!(left.len(), limits::BOX_SAVED);
    assert_eq!(left.iter().filter(is_asked).count(), limits::BOX_ASKED);
    assert!(left[0].ends_with("saved-05-stop.mcap"), "{left:?}");
}

#[test]
fn a_clock_that_is_set_back_costs_no_sample_and_repeats_none() {
    let folder = tempdir().unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    let (moving, still) = (known(1, "a"), known(2, "still"));
    let fault = |number: u32, path: &str| {
        let unix_ns = BEGIN_NS + u64::from(number);
        Entry::Fault(known(number, path), unix_ns, 5, "device: gone".into())
    };
    // What each of these has in the end, and each part begins with.
    let last = [sample(&still, 500), fault(4, "c"), fault(3, "b")];
    for at in (1000..1010).chain(0..10) {
        if at % 5 == 0 {
            kept.end_part();
        }
        let first = if at == 1000 { &last[..] } else { &[] };
        let batch = [first, &[sample(&moving, at)]].concat();
        kept.put(&batch.into(), || {
            let before = if at == 0 { 1009 } else { at - 1 };
            [&last[..], &[sample(&moving, before)]].concat()
        });
    }
    let path = saved_now(&mut kept, SaveReason::Asked);
    let mut had = values(&path);
    had.sort_unstable();
    let all = (0..10).chain([500]).chain(1000..1010);
    assert_eq!(had, all.collect::<Vec<_>>());
    let mut reader = Reader::open(File::open(&path).unwrap()).unwrap();
    let mut faults = 0;
    while let Some(event) = reader.next().unwrap() {
        faults += usize::from(matches!(event.what, EventKind::Fault { .. }));
    }
    assert_eq!(faults, 2);
    kept.close();
}

#[test]
fn what_is_saved_after_the_clock_was_set_back_is_the_newest_and_replaces_none() {
    let folder = tempdir().unwrap();
    let file = |second: u64| folder.path().join(format!("{SAVED}{second}-crash.mcap"));
    for number in 0..limits::BOX_SAVED as u64 {
        fs::write(file(9_000_000_000 + number), "").unwrap();
    }
    // As of a clock that was not set yet.
    fs::write(file(25), "").unwrap();
    let mut kept = BlackBox::open(settings(folder.path()), "test", nothing()).unwrap();
    for _ in 0..2 {
        fill(&mut kept, 0..10, &[]);
        let path = saved_now(&mut kept, SaveReason::Crash);
        assert!(path.exists());
        assert_eq!(saved(folder.path()).unwrap().last(), Some(&path));
    }
    let left = saved(folder.path()).unwrap();
    assert_eq!(left.len(), limits::BOX_SAVED);
    assert!(left[0].ends_with("saved-9000000002-crash.mcap"), "{left:?}");
    kept.close();
}

#[test]
fn a_folder_that_was_removed_is_made_again_with_the_next_part() {
    let folder = tempdir().unwrap();
    let place = folder.path().join("box");
    let mut kept = BlackBox::open(settings(&place), "test", nothing()).unwrap();
    fill(&mut kept, 0..10, &[]);
    fs::remove_dir_all(&place).unwrap();
    // A look later.
    kept.looks_at = Instant::now();
    fill(&mut kept, 10..20, &[]);
    let had = values(&saved_now(&mut kept, SaveReason::Asked));
    assert_eq!(had, (10..20).chain([1000]).collect::<Vec<_>>());
    kept.close();
}
