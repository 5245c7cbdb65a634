//! The table against itself and against its page.

use std::collections::BTreeSet;

use super::wait::{Asked, Reading, Until};
use super::{Content, Does, find, foreign, page, table};
use crate::ports::Port;

/// Whether a Russian name is one; names of coordinates are the same in all languages.
fn is_russian(shown: &str, russian: &str) -> bool {
    (shown.len() <= 2 && shown == russian) || (!russian.is_empty() && !russian.is_ascii())
}

#[test]
fn every_type_stands_once_and_has_words() {
    let mut seen = BTreeSet::new();
    for row in table() {
        assert!(seen.insert(row.kind), "{} twice", row.kind);
        for text in row.text {
            assert!(text.ends_with('.'), "{}: {text}", row.kind);
        }
        assert!(row.icon.starts_with('<'), "{} has no picture", row.kind);
        assert!(is_russian(row.shown, row.russian), "{}", row.kind);
        for property in row.properties {
            let is_said = is_russian(property.shown, property.russian);
            assert!(is_said, "{} {}", row.kind, property.name);
        }
        assert!(foreign::find(row.kind).is_none(), "{}", row.kind);
    }
}

#[test]
fn defaults_of_choices_are_among_them() {
    for row in table() {
        for property in row.properties {
            if let Content::Choice(words) | Content::Port(words) = property.content {
                assert!(words.contains(&property.default), "{}", row.kind);
            }
        }
    }
}

#[test]
fn what_a_wait_names_is_a_property_of_its_block() {
    for row in table() {
        let Does::Wait(wait) = row.does else {
            continue;
        };
        let mut named = Vec::new();
        match wait.port {
            Asked::Named(property) => named.push(property),
            Asked::Numbered(property, names) => {
                assert!(names.len() > 1, "{}", row.kind);
                named.push(property);
            }
            Asked::Fixed(port) => assert!(Port::named(port).is_some(), "{port}"),
        }
        match wait.reading {
            Reading::Chosen(property, choices) => {
                assert!(!choices.is_empty(), "{}", row.kind);
                named.push(property);
            }
            Reading::Of(_) => {}
        }
        match wait.until {
            Until::Compared(property) => named.extend([property, "Sign"]),
            Until::Positive | Until::Zero => {}
        }
        for property in named {
            assert!(row.property(property).is_some(), "{} {property}", row.kind);
        }
    }
}

#[test]
fn a_name_for_messages_is_written_only_if_it_is_another_one() {
    for row in table() {
        if let Does::Act(act) = row.does {
            assert_ne!(act.russian, row.russian, "{}", row.kind);
        }
    }
}

#[test]
fn blocks_of_other_kits_are_known_by_name() {
    let (kit, name) = foreign::find("Ev3EnginesForward").unwrap();
    assert_eq!((kit.name(), name), ("EV3", "EnginesForward"));
    let (kit, name) = foreign::find("GeoTakeoff").unwrap();
    assert_eq!((kit.name(), name), ("Pioneer", "GeoTakeoff"));
    assert!(foreign::find("Ev3").is_none());
    assert!(foreign::find("SomethingElse").is_none());
    assert!(find("SomethingElse").is_none());
}

#[test]
fn the_page_of_blocks_is_that_of_the_table() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/user/blocks.md");
    let document = std::fs::read_to_string(path).unwrap();
    let (before, rest) = document.split_once(page::BEGIN).unwrap();
    let (written, after) = rest.split_once(page::END).unwrap();
    let made = page::markdown();
    if std::env::var_os("TRIK_WRITE_DOCS").is_some() {
        let text = format!("{before}{}{made}{}{after}", page::BEGIN, page::END);
        std::fs::write(path, text).unwrap();
        return;
    }
    assert_eq!(written, made, "write it anew with TRIK_WRITE_DOCS=1");
}
