//! The table of blocks holds together.

use super::*;
use std::collections::HashSet;

#[test]
fn there_are_47_blocks_and_each_name_is_there_once() {
    let elements: HashSet<_> = table().map(|row| row.element).collect();
    assert_eq!(table().count(), 47);
    assert_eq!(elements.len(), 47);
    let shown: HashSet<_> = table().map(|row| row.shown).collect();
    assert_eq!(shown.len(), 47, "a textual program names blocks by these");
    let russian: HashSet<_> = table().map(|row| row.russian).collect();
    assert_eq!(russian.len(), 47);
}

#[test]
fn names_of_ports_and_properties_are_unique_within_a_block() {
    for row in table() {
        let ports: HashSet<_> = row
            .ports
            .iter()
            .map(|port| (port.name, port.way as u8))
            .collect();
        assert_eq!(ports.len(), row.ports.len(), "{}", row.element);
        let names: HashSet<_> = row.properties.iter().map(|one| one.name).collect();
        assert_eq!(names.len(), row.properties.len(), "{}", row.element);
        for port in row.ports {
            let (width, height) = row.size;
            let inside = |at: i16, size: u16| at >= 0 && at <= size as i16;
            assert!(
                inside(port.at.0, width) && inside(port.at.1, height),
                "{}: {}",
                row.element,
                port.name
            );
        }
    }
}

#[test]
fn ports_have_the_numbers_of_the_metamodel() {
    let numbered = |element: &str, names: &[&str]| {
        let row = find(element).expect(element);
        let found: Vec<_> = row.ports.iter().map(|port| port.name).collect();
        assert_eq!(found, names, "{element}");
    };
    numbered(
        "DFLoopBlock",
        &["FROM", "TO", "STEP", "CF_IN", "CF_OUT", "OUT"],
    );
    numbered("DFPlayToneBlock", &["FILE", "CF_IN", "CF_OUT"]);
    numbered(
        "DFDelayFilterBlock",
        &["DISPATCH_TIME", "FAILURE", "COUNT", "OUT", "DATA"],
    );
    numbered("DFUserBlock", &["CF_IN", "I0", "O0", "I1", "O1", "CF_OUT"]);
    numbered("DFGetSetVariableBlock", &["CF_IN", "IN", "CF_OUT", "OUT"]);
    numbered("DFSupressorBlock", &["REPLACE_DATA", "DATA", "OUT", "TIME"]);
}

#[test]
fn former_names_lead_to_ports_that_there_are() {
    for former in former::FORMER {
        let row = find(former.now).expect(former.now);
        for name in former.ports.unwrap_or_default() {
            // Nobody knows what came to this one.
            let is_gone = former.shape.is_some() && *name == "CONFIG";
            let is_there = row.port(name).is_some();
            assert!(is_there != is_gone, "{}: {name}", former.element);
        }
        assert!(find(former.element).is_none(), "{}", former.element);
    }
}

/// The page beside the sources; `TRIK_WRITE_DOCS=1` writes it.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/user/dataflow.md");

#[test]
fn the_page_has_all_blocks_as_the_table_does() {
    let text = std::fs::read_to_string(PAGE).expect("the page");
    let (before, rest) = text
        .split_once(page::BEGIN)
        .expect("where the made part begins");
    let (_, after) = rest.split_once(page::END).expect("where it ends");
    let (begin, end) = (page::BEGIN, page::END);
    let wanted = format!("{before}{begin}{}{end}{after}", page::markdown());
    if std::env::var_os("TRIK_WRITE_DOCS").is_some() {
        std::fs::write(PAGE, &wanted).expect("the page is written");
    } else {
        let command = "TRIK_WRITE_DOCS=1 cargo test -p lang-dataflow --lib page";
        assert!(text == wanted, "{command}");
    }
}
