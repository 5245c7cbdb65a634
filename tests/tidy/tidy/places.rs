//! Rules of where things stand: limits, numbers of errors, texts instead of errors.
//!
//! Owns the lists of crates and files that they are for, and of what they let pass.

use super::{Source, none, sources};
use std::collections::BTreeSet;

/// Crates whose limits all stand in their `limits.rs`. Those of `filters` are ranges of parameters, which stand with them;
/// `ev3dev`, `sim`, `lang/dcml` and `lang/diagram` have facts of devices and of picture and text beside theirs.
const LIMITED: [&str; 16] = [
    "config",
    "converter",
    "frame",
    "journal",
    "lang/constraint",
    "lang/editor",
    "lang/expr",
    "lang/plan",
    "lang/text",
    "page",
    "recorder",
    "sample-bus",
    "screen",
    "trik",
    "trikd",
    "trikfs",
];
/// Crates in which numbers of errors stand in one place, and no function gives a text as an error.
const BLAMING: [&str; 15] = [
    "config",
    "converter",
    "journal",
    "lang/constraint",
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
    "trikfs",
];
/// Crates in which no function gives a text as an error either. Numbers of errors stand in several of their files: each
/// says what an answer of the system means there.
const TYPED: [&str; 3] = ["bridge", "trik", "trikd"];
/// Constants of such a crate that are named like limits and are none of ours, as beginnings of paths with a name.
const NO_LIMITS: [(&str, &str); 5] = [
    ("config/src/vm/memory", "SMALL_MAX"),
    ("trikd/src/brick/actuators", "ANGLE_MAX"),
    ("trikd/src/brick/actuators", "POWER_MAX"),
    ("trikfs/src/transport/native/abi", "MAX_PAGES"),
    ("trikfs/src/transport/native/abi", "MINOR_MIN"),
];
/// Files that give errors their numbers: of the filesystem, of the words of `faulty`, of a reader of the sample bus.
const NUMBERS: [&str; 3] = [
    "config/src/source/faulty.rs",
    "sample-bus/src/reader.rs",
    "trikfs/src/errno.rs",
];

/// Sources of the product in one of the crates.
fn product<'a>(all: &'a [Source], crates: &'a [&str]) -> impl Iterator<Item = &'a Source> {
    all.iter().filter(|source| {
        let of = |name: &str| source.path.starts_with(&format!("{name}/src/"));
        crates.iter().any(|name| of(name)) && !source.is_test()
    })
}

/// Lines of code before the module of tests.
fn lines(source: &Source) -> impl Iterator<Item = (usize, &str)> {
    let count = source.product().lines().count();
    source
        .code()
        .take_while(move |(number, _)| *number <= count)
}

/// The name of the constant that a line declares.
fn constant(line: &str) -> Option<&str> {
    let (before, rest) = line.split_once("const ")?;
    let is_item = before.trim().is_empty() || before.trim_start().starts_with("pub");
    let name = rest.split(':').next().unwrap_or_default();
    let is_name = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    (is_item && name.chars().all(is_name)).then_some(name)
}

#[test]
fn the_lists_name_crates() {
    let mut complaints = Vec::new();
    for name in LIMITED.iter().chain(&BLAMING).chain(&TYPED) {
        if !super::CRATES.contains(name) {
            complaints.push(format!("there is no crate {name}"));
        }
    }
    for name in LIMITED {
        let path = format!("{name}/src/limits.rs");
        if !super::root().join(&path).is_file() {
            complaints.push(format!("there is no {path}"));
        }
    }
    none(&complaints);
}

#[test]
fn limits_stand_in_limits() {
    let mut complaints = Vec::new();
    let all = sources();
    for source in product(&all, &LIMITED).filter(|source| !source.path.ends_with("/limits.rs")) {
        for (number, line) in lines(source) {
            let Some(name) = constant(line) else { continue };
            let words: Vec<&str> = name.split('_').collect();
            let is_limit = ["MAX", "MIN", "LIMIT"]
                .iter()
                .any(|word| words.first() == Some(word) || words.last() == Some(word));
            let passes =
                |(path, known): &(&str, &str)| source.path.starts_with(path) && *known == name;
            if is_limit && !NO_LIMITS.iter().any(passes) {
                complaints.push(format!("{}:{number}: {name}", source.path));
            }
        }
    }
    none(&complaints);
}

#[test]
fn errors_get_their_numbers_in_one_file() {
    let mut complaints = Vec::new();
    let all = sources();
    for source in product(&all, &BLAMING).filter(|source| !NUMBERS.contains(&source.path.as_str()))
    {
        for (number, line) in lines(source) {
            let is_number = line.split("libc::").skip(1).any(|rest| {
                let mut letters = rest.chars();
                letters.next() == Some('E')
                    && letters.next().is_some_and(|c| c.is_ascii_uppercase())
            });
            if is_number {
                complaints.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    none(&complaints);
}

/// Functions that a parser of an option's value calls and that give its error; parsers themselves are found by the
/// attribute that names them. `clap` shows such a text beside the option.
const TEXTS: [&str; 1] = ["seconds"];

/// The names of functions that parse the value of an option, with the directories of their crates.
fn value_parsers(all: &[Source]) -> BTreeSet<(&str, &str)> {
    let mut names = BTreeSet::new();
    for source in all {
        let (folder, _) = source.path.split_once("/src/").unwrap_or_default();
        for (_, rest) in source
            .code()
            .filter_map(|(_, line)| line.split_once("value_parser = "))
        {
            let end = rest.find([')', ',', '(']).unwrap_or(rest.len());
            let name = rest[..end].rsplit("::").next().unwrap_or_default();
            names.insert((folder, name));
        }
    }
    names
}

/// The name of the function whose head begins in a line.
fn function(line: &str) -> Option<&str> {
    let (_, rest) = line.split_once("fn ")?;
    rest.split(['(', '<']).next()
}

/// Whether the types after `Result<` end with a text as the error.
fn gives_text(types: &str) -> bool {
    let mut depth = 1;
    let end = types.bytes().position(|byte| {
        match byte {
            b'<' | b'(' => depth += 1,
            b'>' | b')' => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    end.is_some_and(|end| types[..end].ends_with(", String"))
}

#[test]
fn what_goes_wrong_is_no_text() {
    let mut complaints = Vec::new();
    let all = sources();
    let parsers = value_parsers(&all);
    for source in product(&all, &BLAMING).chain(product(&all, &TYPED)) {
        let (folder, _) = source.path.split_once("/src/").unwrap_or_default();
        let may = |name: &str| TEXTS.contains(&name) || parsers.contains(&(folder, name));
        for (number, line) in lines(source) {
            let is_text = line.split("Result<").skip(1).any(gives_text);
            if is_text && !function(line).is_some_and(may) {
                complaints.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    none(&complaints);
}
