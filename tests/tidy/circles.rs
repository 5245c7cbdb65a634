//! Circles of files: files that need each other, directly or through others, so that none of them can be read alone.
//!
//! Owns the measure: an edge goes from a file to each file of the same crate that it names by a path; a circle is a
//! strongly connected component of that graph. Tests do not count. The roots of crates do not count either: what they
//! list depends on nothing. `cargo test -p tests circles -- --nocapture` prints all circles.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The largest circle that a crate may have. Lower a number with the circle; never raise one.
pub(crate) const LARGEST: [(&str, usize); 27] = [
    ("bridge", 1),
    ("config", 4),
    ("converter", 3),
    ("ev3dev", 2),
    ("filters", 1),
    ("frame", 1),
    ("grading", 1),
    ("journal", 2),
    ("lang/constraint", 2),
    ("lang/dataflow", 6),
    ("lang/dcml", 4),
    ("lang/diagram", 9),
    ("lang/editor", 1),
    ("lang/expr", 1),
    ("lang/plan", 1),
    ("lang/text", 2),
    ("page", 1),
    ("recorder", 1),
    ("sample-bus", 1),
    ("screen", 3),
    ("sim", 8),
    ("studio", 1),
    ("trik", 4),
    ("trikd", 9),
    ("trikfs", 12),
    ("web", 1),
    ("web/dcml", 1),
];

/// The way to a module from the root of its crate.
type Module = Vec<String>;

#[test]
fn no_circle_of_files_grows() {
    let mut complaints = Vec::new();
    for (name, most) in LARGEST {
        let files = modules(&crate::tidy::root().join(name).join("src"));
        assert!(!files.is_empty(), "{name}: no sources");
        let mut circles = circles(&edges(&files));
        circles.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
        let sizes: Vec<usize> = circles.iter().map(Vec::len).collect();
        println!("{name}: {} files, circles of {sizes:?}", files.len());
        let largest = sizes.first().copied().unwrap_or(1);
        if largest > most {
            let members: Vec<String> = circles[0].iter().map(|module| module.join("/")).collect();
            complaints.push(format!(
                "{name}: a circle of {largest} files, more than {most}: {}",
                members.join(", ")
            ));
        } else if largest < most {
            complaints.push(format!(
                "{name}: the largest circle has {largest} files: write that down"
            ));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

/// The texts of a crate without comments and tests.
fn modules(src: &Path) -> BTreeMap<Module, String> {
    let mut paths = Vec::new();
    crate::tidy::files(src, "rs", &mut paths);
    let mut modules = BTreeMap::new();
    for path in paths {
        let name = path.strip_prefix(src).unwrap().with_extension("");
        let module: Module = name
            .iter()
            .map(|part| part.to_str().unwrap().to_owned())
            .collect();
        let is_root = module.len() == 1 && ["lib", "main"].contains(&module[0].as_str());
        if is_root || module.iter().any(|part| part == "tests") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let end = text.find("\n#[cfg(test)]\nmod tests {");
        let product = &text[..end.unwrap_or(text.len())];
        let code: Vec<&str> = product
            .lines()
            .map(|line| line.split("//").next().unwrap_or_default())
            .collect();
        modules.insert(module, code.join("\n"));
    }
    modules
}

/// Which files each file names.
fn edges(files: &BTreeMap<Module, String>) -> BTreeMap<&Module, BTreeSet<&Module>> {
    let known = |path: &[String]| {
        let mut path = path.to_vec();
        while !path.is_empty() {
            if let Some((module, _)) = files.get_key_value(&path) {
                return Some(module);
            }
            path.pop();
        }
        None
    };
    let mut edges = BTreeMap::new();
    for (module, text) in files {
        let mut named = BTreeSet::new();
        for path in paths(text, module, files) {
            named.extend(known(&path).filter(|other| *other != module));
        }
        edges.insert(module, named);
    }
    edges
}

/// All paths of a text that begin with `crate`, `super` or a child of this module, from the root of the crate.
fn paths(text: &str, module: &Module, files: &BTreeMap<Module, String>) -> Vec<Module> {
    let mut found = Vec::new();
    let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut rest = text;
    while let Some(start) = rest.find(is_part) {
        let word_end = rest[start..]
            .find(|c| !is_part(c))
            .map_or(rest.len(), |length| start + length);
        let word = &rest[start..word_end];
        rest = &rest[word_end..];
        let Some((head, tail)) = word.split_once("::") else {
            continue;
        };
        let child = [module.as_slice(), &[head.to_owned()]].concat();
        let base = match head {
            "crate" => Vec::new(),
            "super" => module[..module.len() - 1].to_vec(),
            "self" => module.clone(),
            _ if files.contains_key(&child) => child,
            _ => continue,
        };
        if let Some(list) = tail.ends_with("::").then(|| group(rest)).flatten() {
            let common = tail.trim_end_matches("::");
            for one in list {
                found.push(joined(&base, &format!("{common}::{one}")));
            }
        } else if tail.is_empty() {
            for one in group(rest).unwrap_or_default() {
                found.push(joined(&base, &one));
            }
        } else {
            found.push(joined(&base, tail));
        }
    }
    found
}

/// The entries of a list in braces with which a text begins; of an entry that has a list of its own only what is common.
fn group(text: &str) -> Option<Vec<String>> {
    let inner = text.strip_prefix('{')?;
    let mut depth = 0;
    let mut entries = vec![String::new()];
    for c in inner.chars() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => entries.push(String::new()),
            c if depth == 0 && !c.is_whitespace() => entries.last_mut()?.push(c),
            _ => {}
        }
    }
    Some(entries)
}

fn joined(base: &[String], tail: &str) -> Module {
    let mut path = base.to_vec();
    for part in tail.split("::").filter(|part| !part.is_empty()) {
        match part {
            "super" => {
                path.pop();
            }
            "self" => {}
            part => path.push(part.to_owned()),
        }
    }
    path
}

/// The strongly connected components of more than one file.
fn circles(edges: &BTreeMap<&Module, BTreeSet<&Module>>) -> Vec<Vec<Module>> {
    // How far each file reaches; crates have at most some hundred files.
    let mut reach: BTreeMap<&Module, BTreeSet<&Module>> = BTreeMap::new();
    for &module in edges.keys() {
        let mut seen = BTreeSet::new();
        let mut next: Vec<&Module> = edges[module].iter().copied().collect();
        while let Some(one) = next.pop() {
            if seen.insert(one) {
                next.extend(&edges[one]);
            }
        }
        reach.insert(module, seen);
    }
    let mut found: Vec<Vec<Module>> = Vec::new();
    for (&module, seen) in &reach {
        let circle: Vec<Module> = seen
            .iter()
            .filter(|other| reach[**other].contains(module))
            .map(|other| (*other).clone())
            .collect();
        if circle.len() > 1 && !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

#[test]
fn a_circle_is_found_through_lists_and_children() {
    let text = |code: &str| code.to_owned();
    let name = |path: &str| path.split('/').map(str::to_owned).collect::<Module>();
    let files = BTreeMap::from([
        (name("a"), text("use crate::{b::{X, Y}, c};\nmod d;")),
        (name("b"), text("fn f() { super::c::g() }")),
        (name("c"), text("use crate::a::d::Z;")),
        (name("a/d"), text("use super::super::b;")),
        (name("e"), text("use crate::a;")),
    ]);
    let found = circles(&edges(&files));
    assert_eq!(found, [vec![name("a/d"), name("b"), name("c")]]);
}
