//! The constraints of real fields and projects are read as they stand.

use lang_constraint::read;
use lang_text::xml::{self, Element};
use std::path::{Path, PathBuf};

fn shared(folder: &str) -> Option<Vec<PathBuf>> {
    let folder = needs::data()?.join(folder);
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    Some(paths)
}

fn find<'e, 'x>(element: &'e Element<'x>, name: &str) -> Option<&'e Element<'x>> {
    if element.name.eq_ignore_ascii_case(name) {
        return Some(element);
    }
    element.elements().find_map(|inside| find(inside, name))
}

#[test]
fn constraints_of_real_fields_are_read_and_their_misspelt_attributes_told() {
    let mut count = 0;
    let mut told = Vec::new();
    let folders: Vec<_> = ["fields", "grading", "worlds"]
        .into_iter()
        .filter_map(shared)
        .collect();
    if folders.is_empty() {
        return;
    }
    for folder in folders {
        for path in folder {
            if path.extension().is_none_or(|extension| extension != "xml") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let world = xml::parse(&text).unwrap();
            let Some(constraints) = find(&world, "constraints") else {
                continue;
            };
            if constraints.nodes.is_empty() {
                continue;
            }
            let rules = read(constraints).unwrap_or_else(|problems| {
                let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
                panic!("{}: {}", path.display(), lines.join("\n"))
            });
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            for warning in rules.warnings() {
                told.push(format!("{name}: {warning}"));
            }
            count += 1;
        }
    }
    assert_eq!(count, 14);
    let misspelt = |line: &&String| line.contains("did you mean \"dropsOnFire\"?");
    let others: Vec<_> = told.iter().filter(|line| !misspelt(line)).collect();
    let one = |event: &str| {
        format!(
            "ts-finish1-test.xml: event '{event}' > conditions: there is one condition in \"conditions\": \
             write \"condition\", or was something forgotten?"
        )
    };
    assert_eq!(
        others,
        [
            "smile.xml: text stands in the tag constraints: remove it, only tags mean something here",
            &one("Robot is in Finish1 zone"),
            &one("Robot is in wrong zone Finish2"),
        ]
    );
    assert_eq!(told.iter().filter(misspelt).count(), 10);
}

#[test]
fn whatever_stands_in_constraints_is_read_and_checked_within_limits() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/constraints");
    let mut numbers = needs::Random::new(0x9e37_79b9);
    let mut random = move |below: usize| numbers.below(below);
    for name in ["all.xml", "templates.xml"] {
        let seed = std::fs::read(seeds.join(name)).unwrap();
        lang_constraint::fuzz::constraints(&seed);
        for _ in 0..2000 {
            // Pieces of the seed put elsewhere, and bytes changed: much of it is still XML.
            let mut bytes = seed.clone();
            for _ in 0..=random(3) {
                let (from, to) = (random(bytes.len()), random(bytes.len()));
                let length = random(60).min(bytes.len() - from);
                let piece = bytes[from..from + length].to_vec();
                match random(3) {
                    0 => drop(bytes.splice(to..to, piece)),
                    1 => drop(bytes.drain(from..from + length)),
                    _ => bytes[to] = [b'0', b'"', b'-', b'a'][random(4)],
                }
                if bytes.is_empty() {
                    break;
                }
            }
            lang_constraint::fuzz::constraints(&bytes);
        }
    }
}

#[test]
fn examples_of_the_documents_are_right() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for page in ["docs/teacher/rules.md", "docs/ru/rules.md"] {
        let document = std::fs::read_to_string(root.join(page)).expect(page);
        let mut count = 0;
        for part in document.split("```xml rules\n").skip(1) {
            let example = part.split("```").next().unwrap();
            let rules = read(&xml::parse(example).unwrap()).unwrap();
            let warnings = rules.warnings();
            assert!(warnings.is_empty(), "{page}: {warnings:?}");
            count += 1;
        }
        assert_eq!(count, 3, "{page}");
    }
}
