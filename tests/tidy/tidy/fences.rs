//! Fenced examples of the documents: each mark is known, and what is to be run is on a page that a test reads.
//!
//! Owns the list of marks with the tests that run them; a mark that is misspelt would run nowhere.

use super::{none, root};
use harness::documents::{documents, examples};

/// Marks of examples that are run on every page, by `tests/it/docs.rs`, as beginnings.
const ON_EVERY_PAGE: [&str; 6] = [
    "c converter",
    "lua config",
    "rust converter",
    "sh convert",
    "sh mount",
    "sh session",
];

/// Marks of examples that are run on pages that the source of a test names: the mark, that source, and the page if it
/// runs the mark on no other one of those that it names.
const ON_NAMED_PAGES: [(&str, &str, &str); 17] = [
    ("dcml", "trik/tests/it/dcml.rs", ""),
    ("expression", "lang/expr/src/tests/documents.rs", ""),
    ("js generated", "lang/diagram/tests/generate/main.rs", ""),
    ("js studio", "web/test/documents.mjs", ""),
    ("python stepik", "trik/tests/it/check/class.rs", ""),
    ("sh check", "trik/tests/it/check.rs", ""),
    ("sh check", "trik/tests/it/documents.rs", "docs/dcml.md"),
    ("sh check", "trik/tests/it/recording.rs", ""),
    ("sh checker", "trik/tests/it/check/class.rs", ""),
    ("sh dcml", "trik/tests/it/dcml.rs", ""),
    ("sh diagrams", "trik/tests/it/diagrams.rs", ""),
    ("sh robot", "trik/tests/it/documents.rs", ""),
    ("sh task", "trik/tests/it/tasks.rs", ""),
    ("text outline", "lang/diagram/tests/generate/main.rs", ""),
    ("wire", "trikd/tests/it/documents.rs", ""),
    ("xml rules", "lang/constraint/tests/constraints.rs", ""),
    ("xml world", "trik/tests/it/tasks.rs", ""),
];

/// Languages of examples that are only shown, though a test may read some of them.
const SHOWN: [&str; 13] = [
    "", "c", "dcml", "java", "js", "json", "lua", "python", "sh", "text", "toml", "xml", "yaml",
];

/// Whether the words of a fence are those of a mark, with names after them.
fn begins(info: &str, mark: &str) -> bool {
    info.strip_prefix(mark)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
}

/// Why nothing runs an example with these words on this page, if that is so.
fn complaint(page: &str, info: &str, source: impl Fn(&str) -> String) -> Option<String> {
    if SHOWN.contains(&info) || ON_EVERY_PAGE.iter().any(|mark| begins(info, mark)) {
        return None;
    }
    let mut tests = ON_NAMED_PAGES
        .iter()
        .filter(|(mark, ..)| begins(info, mark))
        .peekable();
    if tests.peek().is_none() {
        return Some(format!("no test knows the mark '{info}'"));
    }
    let files: Vec<&str> = tests.clone().map(|(_, file, _)| *file).collect();
    let mut reads = |(_, file, only): &(&str, &str, &str)| {
        let source = source(file);
        (only.is_empty() || *only == page) && source.contains(page)
    };
    (!tests.any(&mut reads)).then(|| {
        let files = files.join(", ");
        format!("'{info}' is run on no such page: {files}")
    })
}

fn source(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn every_marked_example_is_run() {
    let mut complaints = Vec::new();
    let mut count = 0;
    for document in documents() {
        let page = document.strip_prefix(root()).unwrap().to_str().unwrap();
        let text = source(page);
        for example in examples(&text) {
            count += 1;
            let found = complaint(page, &example.info, source);
            complaints.extend(found.map(|why| format!("{page}:{}: {why}", example.line)));
        }
    }
    assert!(count > 200, "only {count} examples");
    none(&complaints);
}

#[test]
fn a_mark_that_is_misspelt_or_on_another_page_is_found() {
    let reads = |_: &str| "\"docs/a.md\"".to_owned();
    assert_eq!(complaint("docs/a.md", "sh robot", reads), None);
    assert_eq!(complaint("docs/b.md", "sh session", reads), None);
    assert_eq!(
        complaint("docs/a.md", "sh robots", reads).as_deref(),
        Some("no test knows the mark 'sh robots'")
    );
    assert_eq!(
        complaint("docs/b.md", "sh robot", reads).as_deref(),
        Some("'sh robot' is run on no such page: trik/tests/it/documents.rs")
    );
}
