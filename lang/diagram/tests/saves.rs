//! Real saves, if they are there: read, written, changed and damaged.

use lang_diagram::archive::{self, Container, Entry};
use lang_diagram::edit::{Change, Editor};
use lang_diagram::project::{Link, Project};
use lang_diagram::read::{Opened, VERSION, VERSION_KEY, read};
use lang_text::problem::{Problem, Severity};
use needs::Random;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Real saves by name, in order; none, and a skip, if they are not there.
fn saves() -> Vec<(String, Vec<u8>)> {
    let Some(data) = needs::data() else {
        return Vec::new();
    };
    let folders = std::fs::read_dir(data).unwrap();
    let inside = |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten();
    let mut found: Vec<PathBuf> = folders
        .flat_map(|folder| inside(folder.unwrap().path()))
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "qrs"))
        .collect();
    found.sort();
    let name = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    let saves: Vec<_> = found
        .iter()
        .map(|path| (name(path), std::fs::read(path).unwrap()))
        .collect();
    assert!(saves.len() > 20, "only {} saves", saves.len());
    saves
}

fn opened(name: &str, bytes: &[u8]) -> Opened {
    read(bytes).unwrap_or_else(|problems| panic!("{name}: {problems:?}"))
}

fn files(bytes: &[u8]) -> BTreeMap<String, Vec<u8>> {
    let archive = archive::open(bytes, &mut Vec::new()).unwrap();
    let file = |entry: Entry| (entry.name, entry.bytes);
    archive.entries.into_iter().map(file).collect()
}

/// What a project is but its version.
fn meaning(mut project: Project) -> Project {
    project.meta.remove(VERSION_KEY);
    project
}

#[test]
fn real_saves_are_read_without_errors() {
    for (name, bytes) in saves() {
        let opened = opened(&name, &bytes);
        let bad = |problem: &&Problem| problem.severity == Severity::Error;
        assert_eq!(opened.problems.iter().find(bad), None, "{name}");
        let project = opened.project;
        assert_eq!(project.main, Some(0), "{name}");
        assert_eq!(project.meta[VERSION_KEY], VERSION, "{name}");
        // The one save that was made for a generator has no world.
        assert_eq!(
            project.world.is_none(),
            name == "smile-generator.qrs",
            "{name}"
        );
        let is_wired = |link: &&Link| link.from.is_some() && link.to.is_some();
        for diagram in &project.diagrams {
            let starts = diagram
                .blocks
                .iter()
                .filter(|block| block.kind == "InitialNode");
            assert!(starts.count() > 0, "{name}: {}", diagram.name);
        }
        let mut links = project.diagrams.iter().flat_map(|diagram| &diagram.links);
        assert!(
            links.any(|link| is_wired(&link)),
            "{name}: nothing is wired"
        );
    }
}

#[test]
fn real_saves_have_what_the_editor_shows() {
    let all: BTreeMap<_, _> = saves().into_iter().collect();
    if all.is_empty() {
        return;
    }
    let project = |name: &str| opened(name, &all[name]).project;
    let arc = project("21._Arc_movement.qrs");
    let names: Vec<&str> = arc.diagrams[1]
        .parameters
        .iter()
        .map(|one| &*one.name)
        .collect();
    assert_eq!(names, ["s", "R", "baseSpeed"]);
    let calls = arc.diagrams[0]
        .blocks
        .iter()
        .filter(|block| block.calls.is_some());
    let values: Vec<Vec<&str>> = calls
        .map(|block| block.arguments.iter().map(|one| &*one.value).collect())
        .collect();
    assert_eq!(values.len(), 2);
    assert!(values.contains(&vec!["70", "-15", "80"]) && values.contains(&vec!["95", "30", "80"]));
    assert_eq!(project("testsComplex.qrs").diagrams.len(), 42);
    assert_eq!(project("solution_full.qrs").diagrams.len(), 9);
    assert!(
        project("15._Dance_in_a_circle.qrs")
            .blobs
            .unwrap()
            .contains("<image ")
    );
    // Converted: the robot of 2016 stands where the robot of today would.
    let old = project("hello-world--44746332.qrs");
    let world = old.world.unwrap();
    assert!(
        world.contains("<robot position=\"-206:26\" direction=\"0\">"),
        "{world}"
    );
    assert!(world.contains("<robot id=\"trikKitRobot\">"), "{world}");
    let mut kinds = old.diagrams[0].blocks.iter().map(|block| &*block.kind);
    assert!(kinds.any(|kind| kind == "TrikSay"));
}

#[test]
fn real_saves_are_written_as_they_came() {
    for (name, bytes) in saves() {
        let opened = opened(&name, &bytes);
        let written = opened.save.write().unwrap();
        let again = self::opened(&name, &written);
        assert_eq!(again.project, opened.project, "{name}");
        assert_eq!(again.save.container(), Container::Zip);
        let (old, new) = (files(&bytes), files(&written));
        let plain = |files: &BTreeMap<String, Vec<u8>>| -> BTreeMap<String, Vec<u8>> {
            let kept = files.iter().filter(|(name, _)| !name.ends_with('/'));
            kept.map(|(name, bytes)| (name.clone(), bytes.clone()))
                .collect()
        };
        assert_eq!(plain(&new), plain(&old), "{name}");
        if opened.save.container() == Container::Zip {
            assert_eq!(new, old, "{name}");
        }
    }
}

#[test]
fn real_saves_keep_their_meaning_when_they_are_changed() {
    for (name, bytes) in saves() {
        let mut opened = opened(&name, &bytes);
        opened.save.set_meta("exerciseId", Some("mine")).unwrap();
        let written = opened.save.write().unwrap();
        let again = self::opened(&name, &written);
        let mut expected = meaning(opened.project);
        expected
            .meta
            .insert("exerciseId".to_owned(), "mine".to_owned());
        assert_eq!(meaning(again.project), expected, "{name}");
        let converted = |problem: &&Problem| problem.to_string().contains("converted");
        assert_eq!(again.problems.iter().find(converted), None, "{name}");
        if opened.problems.iter().find(converted).is_none() {
            // Only the file of the keys is another one.
            let (mut old, mut new) = (files(&bytes), files(&written));
            old.retain(|name, _| !name.ends_with('/') && name != "metaInfo.xml");
            new.retain(|name, _| !name.ends_with('/') && name != "metaInfo.xml");
            assert!(new == old, "{name}: another file has changed");
        }
    }
}

#[test]
fn real_orphans_are_recovered_or_removed() {
    let mut found = 0;
    for (name, bytes) in saves() {
        let mut removed = opened(&name, &bytes);
        let orphans = removed.save.orphans().len();
        found += orphans;
        let gone = removed.save.remove_orphans();
        assert!(gone >= orphans, "{name}: {gone} of {orphans}");
        let again = opened(&name, &removed.save.write().unwrap());
        assert_eq!(again.save.orphans(), [], "{name}");
        assert_eq!(meaning(again.project), meaning(removed.project), "{name}");
        let mut recovered = opened(&name, &bytes);
        recovered.save.recover_orphans();
        let again = opened(&name, &recovered.save.write().unwrap());
        let blocks = |project: &Project| -> usize {
            let diagrams = project.diagrams.iter();
            diagrams.map(|one| one.blocks.len() + one.links.len()).sum()
        };
        let lost = again.save.orphans().len();
        assert_eq!(
            blocks(&again.project) + lost,
            blocks(&recovered.project) + orphans,
            "{name}"
        );
    }
    assert!(found == 0 || found > 50, "{found} orphans");
}

#[test]
fn damaged_saves_do_no_harm() {
    let mut random = Random::new(0x2545_f491);
    let (mut refused, mut all) = (0, 0);
    for (_, bytes) in saves() {
        for _ in 0..10 {
            let mut damaged = bytes.clone();
            match random.below(3) {
                0 => damaged.truncate(random.below(bytes.len())),
                1 => damaged[random.below(bytes.len())] ^= 1 << random.below(8),
                _ => {
                    let at = random.below(bytes.len());
                    let end = bytes.len().min(at + random.below(100));
                    damaged.drain(at..end);
                }
            }
            all += 1;
            refused += usize::from(read(&damaged).is_err());
        }
    }
    // A flipped bit in a time or an attribute of a zip does no harm; nearly all others are found.
    assert!(refused * 10 >= all * 8, "{refused} of {all} refused");
}

#[test]
fn damaged_files_in_saves_do_no_harm() {
    let mut random = Random::new(0x9e37_79b9);
    let small = saves();
    let mut read_again = 0;
    for (_, bytes) in small.iter().filter(|(_, bytes)| bytes.len() < 100_000) {
        let whole = archive::open(bytes, &mut Vec::new()).unwrap().entries;
        for _ in 0..4 {
            let mut entries = whole.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(entries.len());
                damage(&mut random, &mut entries[at]);
            }
            let packed = archive::pack(&entries).unwrap();
            read_again += usize::from(read(&packed).is_ok());
            lang_diagram::fuzz::reader(&packed);
        }
    }
    assert!(
        small.is_empty() || read_again > 20,
        "{read_again} were read"
    );
}

/// Changes something in a file that its checksum does not protect.
fn damage(random: &mut Random, entry: &mut Entry) {
    let bytes = &mut entry.bytes;
    let at = random.below(bytes.len());
    match random.below(6) {
        0 => bytes.truncate(at),
        1 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
        2 => {
            let end = bytes.len().min(at + random.below(60));
            bytes.drain(at..end);
        }
        3 => {
            let end = bytes.len().min(at + random.below(200));
            let piece = bytes[at..end].to_vec();
            bytes.splice(at..at, piece);
        }
        4 => entry.name.push('x'),
        _ => {
            let text = String::from_utf8_lossy(bytes);
            *bytes = text.replace("ControlFlow", "Timer").into_bytes();
        }
    }
}

/// Random changes of real saves are taken back without a trace, and what is written is read as the same.
#[test]
fn real_saves_are_changed_and_changed_back() {
    let mut random = Random::new(26);
    for (name, bytes) in saves() {
        let save = opened(&name, &bytes).save;
        let changes: Vec<u8> = (0..400).map(|_| random.below(256) as u8).collect();
        lang_diagram::fuzz::edits_of(Editor::new(save, 26), &changes);
    }
}

/// A block that is moved is all that changes in what TRIK Studio has written.
#[test]
fn a_block_that_moves_leaves_all_other_files_as_they_came() {
    for (name, bytes) in saves() {
        let opened = opened(&name, &bytes);
        if opened.save.container() != Container::Zip {
            continue;
        }
        let blocks = opened.project.diagrams.iter().flat_map(|one| &one.blocks);
        let Some(block) = blocks.into_iter().find(|one| one.incoming.is_empty()) else {
            continue;
        };
        let id = block.id.clone();
        let links = block.outgoing.len();
        let before = files(&opened.save.write().unwrap());
        let mut editor = Editor::new(opened.save, 1);
        let places = vec![(id, (block.position.0 + 10.0, block.position.1))];
        editor.apply(&Change::Move { places }).unwrap();
        let after = files(&editor.save().write().unwrap());
        assert!(before.keys().eq(after.keys()), "{name}");
        let other = before
            .iter()
            .filter(|(file, bytes)| after[*file] != **bytes);
        // An old save is written anew as a whole; the version says so.
        let other: Vec<_> = other.map(|(file, _)| file).collect();
        let is_old = other.iter().any(|file| file.contains("metaInfo"));
        assert!(is_old || other.len() <= 1 + links, "{name}: {other:?}");
    }
}
