//! The table against itself and against its page.

use std::collections::BTreeSet;

use super::{Content, Does, Watch, find, foreign, page, table, words};

#[test]
fn every_type_stands_once_and_has_words() {
    let mut seen = BTreeSet::new();
    for row in table() {
        assert!(seen.insert(row.kind), "{} twice", row.kind);
        assert!(row.text.ends_with('.'), "{}: {}", row.kind, row.text);
        assert!(words::has(row.shown), "no Russian for {}", row.shown);
        for property in row.properties {
            assert!(
                words::has(property.shown),
                "no Russian for {}",
                property.shown
            );
        }
        assert!(foreign::find(row.kind).is_none(), "{}", row.kind);
    }
    // 26 core blocks and those of both kits of TRIK.
    assert_eq!(seen.len(), 75);
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
fn what_is_waited_for_is_a_property_of_the_block() {
    for row in table() {
        let Does::Watch(watch) = row.does else {
            continue;
        };
        if let Watch::Sensor(name)
        | Watch::Encoder(name)
        | Watch::Gyroscope(name)
        | Watch::Acceleration(name)
        | Watch::Wheel(name) = watch
        {
            assert!(row.property(name).is_some(), "{} {name}", row.kind);
            assert!(row.property("Sign").is_some(), "{}", row.kind);
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
