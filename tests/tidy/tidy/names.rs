//! Rules of names: types are called by terms of their field.
//!
//! Owns the names that say nothing, and the crates that have none of them.

use super::{none, sources};

/// Crates that are held to it.
const NAMED: [&str; 27] = [
    "bridge",
    "config",
    "converter",
    "ev3dev",
    "filters",
    "frame",
    "grading",
    "journal",
    "lang/constraint",
    "lang/dataflow",
    "lang/dcml",
    "lang/diagram",
    "lang/editor",
    "lang/expr",
    "lang/plan",
    "lang/text",
    "page",
    "recorder",
    "sample-bus",
    "screen",
    "sim",
    "studio",
    "trik",
    "trikd",
    "trikfs",
    "web",
    "web/dcml",
];
/// Names that any type could have.
const EMPTY: [&str; 8] = [
    "Given", "Made", "Said", "Sheet", "Thing", "Told", "Way", "What",
];

/// The type that a line declares.
fn declared(line: &str) -> Option<&str> {
    let words = line.split_whitespace();
    let mut words = words.skip_while(|word| word.starts_with("pub") || word.ends_with(')'));
    let is_type = [
        "class",
        "enum",
        "interface",
        "struct",
        "trait",
        "type",
        "union",
    ]
    .contains(&words.next()?);
    let name = words.next()?;
    let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    is_type.then_some(&name[..end.unwrap_or(name.len())])
}

#[test]
fn declarations_of_types_are_found() {
    for line in [
        "struct Thing;",
        "pub enum Thing {",
        "    pub(super) struct Thing<'a> {",
        "pub(in crate::a) type Thing = u8;",
        "struct Thing(u8);",
        "interface Thing {",
    ] {
        assert_eq!(declared(line), Some("Thing"), "{line}");
    }
    assert_eq!(declared("impl Thing {"), None);
    assert_eq!(declared("    Thing(usize),"), None);
}

#[test]
fn names_of_types_say_something() {
    let mut complaints = Vec::new();
    for name in NAMED.iter().filter(|name| !super::CRATES.contains(name)) {
        complaints.push(format!("there is no crate {name}"));
    }
    for source in sources() {
        let of = |name: &&str| source.path.starts_with(&format!("{name}/"));
        if !NAMED.iter().any(of) {
            continue;
        }
        for (number, line) in source.code() {
            if let Some(name) = declared(line).filter(|name| EMPTY.contains(name)) {
                complaints.push(format!("{}:{number}: {name}", source.path));
            }
        }
    }
    none(&complaints);
}

#[test]
fn names_of_types_of_the_page_say_something() {
    let mut found = Vec::new();
    for ending in ["ts", "svelte"] {
        super::files(&super::root().join("page/app/src"), ending, &mut found);
    }
    assert!(found.len() > 50, "only {} files", found.len());
    let mut complaints = Vec::new();
    for path in found {
        let text = std::fs::read_to_string(&path).unwrap();
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.trim_start();
            let line = line.strip_prefix("export ").unwrap_or(line);
            if let Some(name) = declared(line).filter(|name| EMPTY.contains(name)) {
                complaints.push(format!("{}:{number}: {name}", path.display()));
            }
        }
    }
    none(&complaints);
}
