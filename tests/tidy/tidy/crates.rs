//! Rules between crates and files: who may depend on whom, no file that nobody compiles, a map that is up to date.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::{CRATES, files, none, root};
use crate::circles::LARGEST;

/// Libraries that stand behind a border, and the only crates that may link them.
const BEHIND_A_BORDER: [(&str, &[&str]); 11] = [
    ("async-nats", &["grading"]),
    ("axum", &["page"]),
    ("box2d-rust", &["sim"]),
    ("clap", &["trik", "trikd", "trikfs", "trikfs-ev3dev"]),
    ("flate2", &["lang-diagram"]),
    ("fuser", &["trikfs"]),
    ("libloading", &["trikfs"]),
    ("mlua-sys", &["config"]),
    ("rquickjs", &["trikd"]),
    ("tokio", &["grading", "page", "trikd"]),
    ("zip", &["lang-diagram"]),
];

/// What a crate's manifest says, as far as the rules need it.
struct Manifest {
    name: String,
    /// What sources call it, if its library has another name.
    library: Option<String>,
    /// Names of crates that it is linked with, ours and others; not those of its tests alone.
    dependencies: BTreeSet<String>,
    /// Those for its tests, benchmarks and build script.
    helpers: BTreeSet<String>,
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn manifest(folder: &str) -> Manifest {
    let text = text(&root().join(folder).join("Cargo.toml"));
    let mut section = "";
    let mut found = Manifest {
        name: String::new(),
        library: None,
        dependencies: BTreeSet::new(),
        helpers: BTreeSet::new(),
    };
    for line in text.lines() {
        if line.starts_with('[') {
            section = line;
        }
        let Some((key, value)) = line.split_once('=') else {
            continue;
        };
        let key = key.trim();
        let key = key.strip_suffix(".workspace").unwrap_or(key).to_owned();
        match section {
            "[package]" if key == "name" => found.name = value.trim().trim_matches('"').to_owned(),
            "[lib]" if key == "name" => {
                found.library = Some(value.trim().trim_matches('"').to_owned());
            }
            "[dependencies]" => {
                found.dependencies.insert(key);
            }
            "[dev-dependencies]" | "[build-dependencies]" => {
                found.helpers.insert(key);
            }
            _ => (),
        }
    }
    assert!(!found.name.is_empty(), "{folder}/Cargo.toml has no name");
    found
}

fn quoted(cell: &str) -> BTreeSet<String> {
    cell.split('`')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

/// The table of ARCHITECTURE.md: each crate with those that it depends on.
fn rules() -> BTreeMap<String, BTreeSet<String>> {
    let map = text(&root().join("ARCHITECTURE.md"));
    let table = map
        .split_once("| crate | depends on |\n| --- | --- |\n")
        .expect("ARCHITECTURE.md has a table of crates")
        .1;
    let mut rules = BTreeMap::new();
    for line in table.lines().take_while(|line| line.starts_with('|')) {
        let mut cells = line.split('|').skip(1);
        let (crates, allowed) = (cells.next().unwrap(), cells.next().unwrap());
        // What stands in parentheses is for readers.
        let crates = crates.split('(').next().unwrap_or_default();
        for name in quoted(crates) {
            rules.insert(name, quoted(allowed));
        }
    }
    rules
}

/// Folders that the workspace has as members.
fn members() -> BTreeSet<String> {
    let manifest = text(&root().join("Cargo.toml"));
    let list = manifest
        .split_once("members = [")
        .and_then(|(_, rest)| rest.split_once(']'))
        .expect("the workspace has members")
        .0;
    list.split('"')
        .skip(1)
        .step_by(2)
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_lists_of_the_rules_have_every_crate() {
    let mut complaints = Vec::new();
    let mut compare = |list: &str, found: BTreeSet<String>, wanted: &BTreeSet<String>| {
        for name in wanted.symmetric_difference(&found) {
            complaints.push(format!("{list}: {name} is there or in `members` alone"));
        }
    };
    let members = members();
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    compare("CRATES in tidy.rs", owned(&CRATES), &members);
    // Those have no product.
    let products = members
        .iter()
        .filter(|name| !name.starts_with("tests"))
        .cloned()
        .collect();
    let measured: Vec<&str> = LARGEST.iter().map(|(name, _)| *name).collect();
    compare("LARGEST in circles.rs", owned(&measured), &products);
    none(&complaints);
}

#[test]
fn every_crate_takes_the_lints_and_has_no_tests_in_comments() {
    let mut complaints = Vec::new();
    for folder in CRATES {
        let manifest = text(&root().join(folder).join("Cargo.toml"));
        for section in ["[lints]\nworkspace = true", "doctest = false"] {
            if !manifest.contains(section) {
                complaints.push(format!("{folder}/Cargo.toml: no {section:?}"));
            }
        }
    }
    none(&complaints);
}

#[test]
fn crates_depend_on_each_other_as_the_table_says() {
    let rules = rules();
    let manifests = CRATES.map(manifest);
    let ours: BTreeSet<String> = manifests.iter().map(|crate_| crate_.name.clone()).collect();
    let mut complaints = Vec::new();
    for name in rules.keys().filter(|name| !ours.contains(*name)) {
        complaints.push(format!("ARCHITECTURE.md: there is no crate {name}"));
    }
    for Manifest {
        name, dependencies, ..
    } in &manifests
    {
        let linked: BTreeSet<String> = dependencies.intersection(&ours).cloned().collect();
        match rules.get(name) {
            None => complaints.push(format!("ARCHITECTURE.md: no row for {name}")),
            Some(allowed) if *allowed != linked => complaints.push(format!(
                "{name} depends on {linked:?}, and ARCHITECTURE.md has {allowed:?}"
            )),
            Some(_) => (),
        }
    }
    none(&complaints);
}

#[test]
fn nothing_for_the_controller_links_what_is_for_a_pc() {
    let rules = rules();
    let mut linked: Vec<&str> = vec!["trikfs", "trikfs-ev3dev", "trikd"];
    let mut next = 0;
    while let Some(name) = linked.get(next).copied() {
        next += 1;
        for other in &rules[name] {
            if !linked.contains(&other.as_str()) {
                linked.push(other);
            }
        }
    }
    for name in [
        "bridge",
        "grading",
        "sim",
        "trik",
        "lang-constraint",
        "lang-plan",
        "lang-editor",
        "studio",
        "web",
        "web-dcml",
    ] {
        assert!(!linked.contains(&name), "the controller links {name}");
    }
}

/// JSON is taken as values: decision 007. Crates of others may do as they like.
#[test]
fn nobody_derives_the_forms_of_json() {
    let mut manifests = vec![root().join("Cargo.toml")];
    manifests.extend(CRATES.map(|name| root().join(name).join("Cargo.toml")));
    let mut asks = Vec::new();
    for path in manifests {
        let text = text(&path);
        let lines = text.lines();
        let found = lines.filter(|line| line.starts_with("serde") && line.contains("derive"));
        asks.extend(found.map(|line| format!("{}: {line}", path.display())));
    }
    none(&asks);
}

/// The controller's programs are built together without default features, and one that asks for them asks for all.
#[test]
fn nobody_on_the_controller_asks_for_all_that_trikfs_can() {
    let workspace = text(&root().join("Cargo.toml"));
    assert!(workspace.contains("trikfs = { path = \"trikfs\", default-features = false }"));
    assert!(workspace.contains("config = { path = \"config\", default-features = false }"));
    for folder in ["ev3dev", "trikd", "trikfs", "filters"] {
        let manifest = text(&root().join(folder).join("Cargo.toml"));
        let asks = manifest.lines().filter(|line| {
            let is_of_it = line.starts_with("trikfs =") || line.starts_with("config =");
            is_of_it && (line.contains("\"default\"") || line.contains("\"dataflow\""))
        });
        assert_eq!(asks.count(), 0, "{folder}/Cargo.toml");
    }
}

#[test]
fn libraries_behind_a_border_are_linked_by_nobody_else() {
    let mut complaints = Vec::new();
    for Manifest {
        name, dependencies, ..
    } in CRATES.map(manifest)
    {
        for (library, owners) in BEHIND_A_BORDER {
            if dependencies.contains(library) && !owners.contains(&name.as_str()) {
                complaints.push(format!("{name} links {library}, which is for {owners:?}"));
            }
        }
    }
    none(&complaints);
}

/// Dependencies that no source names, with their reason.
const NAMED_NOWHERE: [(&str, &str); 1] = [
    // Its shared library has to be built with the program.
    ("trikfs", "filters"),
];

#[test]
fn every_dependency_is_used() {
    let manifests = CRATES.map(|folder| (folder, manifest(folder)));
    let mut complaints = Vec::new();
    for (folder, manifest) in &manifests {
        let mut found = Vec::new();
        files(&root().join(folder), "rs", &mut found);
        let texts: Vec<String> = found.iter().map(|path| text(path)).collect();
        for dependency in manifest.dependencies.union(&manifest.helpers) {
            let ours = manifests
                .iter()
                .find(|(_, other)| other.name == *dependency);
            let library = ours.and_then(|(_, other)| other.library.clone());
            let library = library.unwrap_or_else(|| dependency.replace('-', "_"));
            let is_word = |text: &String| {
                text.split(|letter: char| !letter.is_alphanumeric() && letter != '_')
                    .any(|word| word == library)
            };
            let may_be_silent = NAMED_NOWHERE.contains(&(&manifest.name, dependency));
            if texts.iter().any(is_word) == may_be_silent {
                complaints.push(format!(
                    "{folder}/Cargo.toml: {dependency}: named by no source, or listed as such"
                ));
            }
        }
    }
    none(&complaints);
}

/// Files that may declare the module of `path`: beside or above it, up to the folder of the crate.
fn parents(path: &Path, folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for above in path
        .ancestors()
        .skip(1)
        .take_while(|above| above.starts_with(folder))
    {
        found.extend(["lib.rs", "main.rs", "mod.rs"].map(|name| above.join(name)));
        found.push(above.with_extension("rs"));
    }
    found.retain(|parent| parent != path && parent.is_file());
    found
}

#[test]
fn every_source_is_compiled() {
    let mut complaints = Vec::new();
    for name in CRATES {
        let folder = root().join(name);
        let manifest = text(&folder.join("Cargo.toml"));
        let mut found = Vec::new();
        files(&folder, "rs", &mut found);
        // Crates in folders of this one.
        let inner = CRATES.map(|other| root().join(other));
        let inner = inner.iter().filter(|other| **other != folder);
        let inner: Vec<_> = inner.filter(|other| other.starts_with(&folder)).collect();
        found.retain(|path| !inner.iter().any(|other| path.starts_with(other)));
        let texts: Vec<String> = found.iter().map(|path| text(path)).collect();
        for path in &found {
            let inside = path.strip_prefix(&folder).unwrap().to_str().unwrap();
            let parts: Vec<&str> = inside.split('/').collect();
            // What cargo finds by itself, projects that are copied, and a tool with a manifest of its own.
            let is_root = matches!(
                parts.as_slice(),
                ["build.rs"]
                    | ["src", "lib.rs" | "main.rs"]
                    | ["tests" | "benches" | "examples", _]
                    | ["tests" | "benches" | "examples", _, "main.rs"]
                    | ["templates", ..]
                    | ["bindgen", "src", "main.rs"]
            );
            if is_root || manifest.contains(&format!("path = \"{inside}\"")) {
                continue;
            }
            let stem = path.file_stem().unwrap().to_str().unwrap();
            let declares = |text: &str| {
                text.lines()
                    .any(|line| line.trim_end().ends_with(&format!("mod {stem};")))
            };
            let by_parent = || {
                parents(path, &folder)
                    .iter()
                    .any(|path| declares(&text(path)))
            };
            let by_path = || {
                let quoted = format!("{stem}.rs\"");
                texts.iter().any(|text| text.contains(&quoted))
            };
            if !by_parent() && !by_path() {
                complaints.push(format!("{name}/{inside}: no module, nobody compiles it"));
            }
        }
    }
    none(&complaints);
}

#[test]
fn every_snapshot_belongs_to_a_test() {
    let mut complaints = Vec::new();
    for name in CRATES {
        let mut found = Vec::new();
        files(&root().join(name), "snap", &mut found);
        for path in found {
            let snapshot = text(&path);
            let source = snapshot
                .lines()
                .find_map(|line| line.strip_prefix("source: "));
            let test = source.map(|source| root().join(source));
            let compares = |test: PathBuf| test.is_file() && text(&test).contains("insta::");
            if !test.is_some_and(compares) {
                complaints.push(format!("{}: no test compares it", path.display()));
            }
        }
    }
    none(&complaints);
}

#[test]
fn the_map_is_short() {
    let lines = text(&root().join("ARCHITECTURE.md")).lines().count();
    assert!(
        lines <= 300,
        "ARCHITECTURE.md has {lines} lines: it keeps crates and flows; what a module is, its first line says"
    );
}

#[test]
fn the_list_of_modules_is_up_to_date() {
    let made = std::process::Command::new(root().join(".ci/modules"))
        .arg("--check")
        .output()
        .unwrap();
    assert!(
        made.status.success(),
        "{}",
        String::from_utf8_lossy(&made.stderr)
    );
}

#[test]
fn what_the_emulated_controller_leaves_out_starts_no_program() {
    let script = text(&root().join("cross/test.sh"));
    let modules = script
        .split_once("for module in ")
        .and_then(|(_, rest)| rest.split_once("; do"))
        .expect("cross/test.sh names modules that are native")
        .0;
    let mut complaints = Vec::new();
    for module in modules.split_whitespace() {
        let path = format!("tests/it/{}.rs", module.replace("::", "/"));
        let code = text(&root().join(&path));
        for starts in [
            "mount(",
            "mount_on(",
            "mount_with(",
            "trikfs(",
            "program()",
            "Setting {",
        ] {
            if code.contains(starts) {
                complaints.push(format!("{path}: {starts} starts the program under test, and cross/test.sh leaves it out"));
            }
        }
    }
    none(&complaints);
}
