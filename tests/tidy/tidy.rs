//! Words, lengths, places of unsafe code and of names: rules for single files and documents.

use std::path::{Path, PathBuf};

/// Rules between crates and files.
mod crates;
mod exact;
/// Examples of documents.
mod fences;
/// Names of types.
mod names;
/// Where limits and numbers of errors stand.
mod places;
/// Rules of the documents.
mod prose;
/// Pages in Russian beside those that they translate.
mod russian;
/// Rules of waiting.
mod waits;

/// Folders of our crates, those that the workspace has as members.
pub(crate) const CRATES: [&str; 29] = [
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
    "tests",
    "tests/needs",
    "trik",
    "trikd",
    "trikfs",
    "web",
    "web/dcml",
];
/// Files that may hold `unsafe`, as beginnings of paths.
const UNSAFE: [&str; 12] = [
    "config/src/vm",
    "config/src/watchdog",
    "converter/src/abi",
    "converter/src/export",
    "trikfs/src/command/signals",
    "sample-bus/src/map",
    "trikfs/src/convert/isolated/memory",
    "trikfs/src/convert/shared",
    "trikfs/src/device/evdev/present",
    "trikfs/src/device/i2c/adapter",
    "trikfs/src/transport/native",
    "converter/templates/",
];

struct Source {
    /// From the root of the workspace.
    path: String,
    text: String,
}

impl Source {
    /// Without the module of tests at the end.
    fn product(&self) -> &str {
        let begins = ["mod tests {", "pub(crate) mod tests {"];
        let found = begins.map(|begin| self.text.find(&format!("\n#[cfg(test)]\n{begin}")));
        let end = found.into_iter().flatten().min();
        &self.text[..end.unwrap_or(self.text.len())]
    }

    fn is_test(&self) -> bool {
        self.path.starts_with("tests/")
            || self.path.ends_with("/tests.rs")
            || self.path.contains("/tests/")
            // A test that reads vectors, and one of all parts together.
            || ["filters/src/golden.rs", "lang/plan/src/whole.rs"].contains(&self.path.as_str())
    }

    /// Lines that are no comments, with their numbers.
    fn code(&self) -> impl Iterator<Item = (usize, &str)> {
        let lines = self
            .text
            .lines()
            .enumerate()
            .map(|(index, line)| (index + 1, line));
        lines.filter(|(_, line)| !line.trim_start().starts_with("//"))
    }
}

pub(crate) fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

pub(crate) fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in
        std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
    {
        let path = entry.unwrap().path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        // What others have made, and what is made of the sources.
        let is_ours = !["target", "node_modules", "dist"].contains(&name) && !name.starts_with('.');
        if path.is_dir() && is_ours {
            files(&path, ending, found);
        } else if path.extension().is_some_and(|other| other == ending) {
            found.push(path);
        }
    }
}

fn sources() -> Vec<Source> {
    let mut found = Vec::new();
    for name in CRATES {
        files(&root().join(name), "rs", &mut found);
    }
    found.sort();
    // A crate may stand inside of another one.
    found.dedup();
    let read = |path: PathBuf| Source {
        text: std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display())),
        path: path
            .strip_prefix(root())
            .unwrap()
            .to_str()
            .unwrap()
            .to_owned(),
    };
    let all: Vec<_> = found.into_iter().map(read).collect();
    assert!(all.len() > 60, "only {} sources", all.len());
    all
}

/// Fails with all complaints at once.
fn none(complaints: &[String]) {
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn every_file_says_what_it_is() {
    let bad = |source: &Source| !source.text.starts_with("//! ");
    none(
        &sources()
            .iter()
            .filter(|source| bad(source))
            .map(|source| format!("{}: does not open with //!", source.path))
            .collect::<Vec<_>>(),
    );
}

#[test]
fn no_file_is_longer_than_six_hundred_lines() {
    let long = |source: &Source| {
        let lines = source.product().lines().count();
        (lines > 600).then(|| format!("{}: {lines} lines", source.path))
    };
    none(&sources().iter().filter_map(long).collect::<Vec<_>>());
}

/// What the repository keeps is written by people, or a picture or recording of theirs; what a program leaves behind, such
/// as the image of one that crashed, is larger.
#[test]
fn no_tracked_file_is_larger_than_two_mebibytes() {
    let git = std::process::Command::new("git")
        .args(["ls-files", "-z"])
        .current_dir(root())
        .output()
        .expect("git");
    assert!(git.status.success(), "git ls-files: {}", git.status);
    let names = String::from_utf8_lossy(&git.stdout);
    let mut complaints = Vec::new();
    let mut count = 0;
    for name in names.split_terminator('\0') {
        count += 1;
        // A file that was removed and is not committed yet is no concern of this rule.
        let size = std::fs::metadata(root().join(name)).map_or(0, |file| file.len());
        if size > 2 << 20 {
            complaints.push(format!("{name}: {size} bytes"));
        }
    }
    assert!(count > 500, "only {count} files");
    none(&complaints);
}

#[test]
fn long_tests_stand_in_a_file_of_their_own() {
    let long = |source: &Source| {
        let lines = source.text.lines().count() - source.product().lines().count();
        (lines > 160).then(|| format!("{}: {lines} lines of tests", source.path))
    };
    none(&sources().iter().filter_map(long).collect::<Vec<_>>());
}

#[test]
fn nothing_is_left_to_be_done() {
    let words = ["todo!", "unimplemented!", "dbg!", "FIXME", "TODO", "XXX"];
    let mut complaints = Vec::new();
    for source in sources()
        .iter()
        .filter(|source| source.path != "tests/tidy/tidy.rs")
    {
        for (index, line) in source.text.lines().enumerate() {
            for word in words.iter().filter(|word| line.contains(**word)) {
                complaints.push(format!("{}:{}: {word}", source.path, index + 1));
            }
        }
    }
    none(&complaints);
}

#[test]
fn sources_and_documents_are_ascii() {
    let mut found = Vec::new();
    for name in CRATES.iter().chain(&["docs", "examples"]) {
        for ending in [
            "rs", "md", "lua", "h", "c", "toml", "py", "js", "sh", "ts", "svelte", "css", "html",
        ] {
            files(&root().join(name), ending, &mut found);
        }
    }
    found.extend(
        [
            "README.md",
            "ARCHITECTURE.md",
            "CONTRIBUTING.md",
            "CHANGELOG.md",
            "Cargo.toml",
        ]
        .map(|name| root().join(name)),
    );
    // What programs of pupils print, in any language.
    let programs = root().join("trikd/tests/js");
    found.retain(|path| !path.starts_with(&programs));
    // Messages for pupils, in Russian too.
    let speaks_russian = [
        "lang",
        "page/src",
        "screen/src",
        "sim/src",
        "studio/src",
        "trik/src",
        "trikd/src",
        "web/src",
    ]
    .map(|part| root().join(part));
    // A row of a block or of a reading has its words in both languages.
    let blocks =
        ["lang/diagram/src/blocks", "lang/dataflow/src/blocks"].map(|part| root().join(part));
    let readings = root().join("lang/diagram/src/generate/readings.rs");
    // What a new task tells pupils.
    let task = root().join("trik/src/task/README.ru.md");
    // What the pages say in Russian.
    let pages = root().join("page/app/src");
    // Pages that pupils and teachers read, in Russian.
    let documents = root().join("docs/ru");
    let is_words = |path: &Path| {
        blocks.iter().any(|part| path.starts_with(part))
            || path.starts_with(&documents)
            || path == task
            || path.starts_with(&pages) && path.ends_with("ru.ts")
            || path == readings
            || path.ends_with("words.rs")
                && speaks_russian.iter().any(|part| path.starts_with(part))
    };
    found.retain(|path| !path.starts_with(&programs) && !is_words(path));
    let mut complaints = Vec::new();
    for path in found {
        let bytes =
            std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        if let Some(at) = bytes.iter().position(|byte| !byte.is_ascii()) {
            let line = bytes[..at].iter().filter(|&&byte| byte == b'\n').count() + 1;
            complaints.push(format!("{}:{line}: not ASCII", path.display()));
        }
    }
    none(&complaints);
}

#[test]
fn unsafe_code_stands_only_where_it_may_and_says_why_it_is_sound() {
    let mut complaints = Vec::new();
    for source in sources() {
        let allowed = UNSAFE.iter().any(|start| source.path.starts_with(start));
        let lines: Vec<&str> = source.text.lines().collect();
        for (number, line) in source.code() {
            let code = line.split("//").next().unwrap_or_default();
            let words: Vec<&str> = code
                .split(|c: char| !c.is_alphanumeric() && c != '_')
                .collect();
            // As a word of a message or an attribute, or of a policy for browsers, it is harmless.
            if !words.contains(&"unsafe")
                || code.contains("'wasm-unsafe-eval'")
                || code.contains("unsafe\"")
                || code.contains("\"unsafe")
                || source.path == "tests/tidy/tidy.rs"
            {
                continue;
            }
            if !allowed {
                complaints.push(format!("{}:{number}: unsafe", source.path));
            }
            let opens_block = code.contains("unsafe {");
            let from = number.saturating_sub(12);
            if opens_block
                && !lines[from..number]
                    .iter()
                    .any(|line| line.contains("SAFETY:"))
            {
                complaints.push(format!("{}:{number}: no SAFETY comment", source.path));
            }
        }
    }
    none(&complaints);
}

#[test]
fn only_the_transport_knows_fuse_and_only_devices_open_devices() {
    let mut complaints = Vec::new();
    for source in sources()
        .iter()
        .filter(|source| source.path.starts_with("trikfs/src/"))
    {
        let in_folder = |folder: &str| source.path.starts_with(&format!("trikfs/src/{folder}"));
        for (number, line) in source.code() {
            let place = format!("{}:{number}", source.path);
            let knows_protocol = line.contains("fuser::") || line.contains("FUSE_");
            if knows_protocol
                && !in_folder("transport")
                && !in_folder("mount")
                && !line.contains("cfg(feature")
                && !line.contains("transport::fuser")
                && !line.contains("_FUSE_COMMFD")
            {
                complaints.push(format!("{place}: knows the protocol: {}", line.trim()));
            }
            let words = line.split(|c: char| !c.is_alphanumeric() && c != ':' && c != '_');
            let opens = words.into_iter().any(|word| {
                word.starts_with("OpenOptions::")
                    || ["File::open", "File::options", "fs::File::open"].contains(&word)
            });
            let of_ours = [
                "device",
                "mount",
                "guardian",
                "cli",
                "check.rs",
                "convert",
                "transport",
                "scratch",
                "reload",
            ]
            .iter()
            .any(|part| in_folder(part));
            if opens && !of_ours && !source.is_test() {
                complaints.push(format!("{place}: opens a file: {}", line.trim()));
            }
        }
    }
    none(&complaints);
}

#[test]
fn there_are_no_atomics_that_the_controller_lacks() {
    let mut complaints = Vec::new();
    for source in sources()
        .iter()
        .filter(|source| source.path != "tests/tidy/tidy.rs")
    {
        for (number, line) in source.code() {
            if line.contains("AtomicU64") || line.contains("AtomicI64") {
                complaints.push(format!("{}:{number}: a 64-bit atomic", source.path));
            }
        }
    }
    none(&complaints);
}

#[test]
fn what_is_pure_knows_no_files_network_threads_or_clocks() {
    let mut complaints = Vec::new();
    for source in sources().iter().filter(|source| !source.is_test()) {
        let is_pure = ["lang/", "screen/", "filters/", "studio/"]
            .iter()
            .any(|part| source.path.starts_with(part))
            && source.path.contains("/src/");
        if !is_pure {
            continue;
        }
        for (number, line) in source.code() {
            if [
                "std::fs",
                "std::net",
                "std::thread",
                "std::time",
                "std::process",
            ]
            .iter()
            .any(|part| line.contains(part))
            {
                complaints.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    none(&complaints);
}

#[test]
fn only_the_cross_build_names_its_target() {
    // In two pieces, so that this file does not name it either.
    let name = ["arm", "v5te"].concat();
    let mut complaints = Vec::new();
    let manifests = CRATES.map(|name| root().join(name).join("Cargo.toml"));
    let others = ["Cargo.toml", ".cargo/config.toml", ".ci/run"].map(|name| root().join(name));
    let here = root().join("cross");
    let documents = harness::documents::documents();
    let documents = documents.iter().filter(|path| !path.starts_with(&here));
    let mut files: Vec<PathBuf> = manifests.into_iter().chain(others).collect();
    files.extend(documents.cloned());
    files.extend(sources().iter().map(|source| root().join(&source.path)));
    for path in files {
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        if text.contains(&name) {
            complaints.push(format!("{}: names the cross target", path.display()));
        }
    }
    none(&complaints);
}

#[test]
fn every_path_that_a_document_names_exists() {
    let mut complaints = Vec::new();
    for document in harness::documents::documents() {
        let text = std::fs::read_to_string(&document)
            .unwrap_or_else(|error| panic!("{}: {error}", document.display()));
        let names_paths = |path: &Path| path.file_name().is_some_and(|name| name != "CHANGELOG.md");
        if !names_paths(&document) {
            continue;
        }
        for (index, line) in text.lines().enumerate() {
            for quoted in line.split('`').skip(1).step_by(2) {
                let looks_like_ours = CRATES
                    .iter()
                    .chain(&["docs", "cross", "editors", "examples", ".ci"])
                    .any(|name| quoted.starts_with(&format!("{name}/")));
                let is_plain = quoted
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || "_./-".contains(c))
                    && !quoted.contains("NAME");
                if looks_like_ours && is_plain && !root().join(quoted).exists() {
                    complaints.push(format!("{}:{}: {quoted}", document.display(), index + 1));
                }
            }
        }
    }
    none(&complaints);
}

/// Modules that match our own enums in full, so that a new variant does not compile until each of them has an answer.
const EXHAUSTIVE: &[&str] = &[
    "bridge/src/lib.rs",
    "config/src/source.rs",
    "ev3dev/src/lib.rs",
    "grading/src/lib.rs",
    "journal/src/lib.rs",
    "lang/constraint/src/lib.rs",
    "lang/dataflow/src/lib.rs",
    "lang/dcml/src/generate.rs",
    "lang/diagram/src/lib.rs",
    "lang/expr/src/lib.rs",
    "page/src/lib.rs",
    "recorder/src/lib.rs",
    "sim/src/arena/brick.rs",
    "sim/src/arena/screen.rs",
    "sim/src/judge.rs",
    "sim/src/judge/recorder.rs",
    "trik/src/lib.rs",
    "trikd/src/diagram.rs",
    "trikd/src/guardian.rs",
    "trikd/src/program.rs",
    "trikd/src/server.rs",
    "trikfs/src/device/packets/framer.rs",
    "trikfs/src/files.rs",
    "trikfs/src/fs.rs",
    "trikfs/src/guardian.rs",
    "trikfs/src/newest.rs",
    "trikfs/src/node.rs",
    "web/dcml/src/lib.rs",
];

#[test]
fn where_an_end_may_not_be_silent_wildcard_arms_are_denied() {
    let denies = |source: &&Source| {
        let mut lines = source.text.lines();
        lines.any(|line| line == "#![deny(clippy::wildcard_enum_match_arm)]")
    };
    let all = sources();
    let denying: Vec<&str> = all
        .iter()
        .filter(denies)
        .map(|source| source.path.as_str())
        .collect();
    let mut complaints = Vec::new();
    for name in EXHAUSTIVE.iter().filter(|name| !denying.contains(name)) {
        complaints.push(format!(
            "{name}: does not deny clippy::wildcard_enum_match_arm"
        ));
    }
    for name in denying.iter().filter(|name| !EXHAUSTIVE.contains(name)) {
        complaints.push(format!(
            "{name}: denies wildcard arms and is not in EXHAUSTIVE"
        ));
    }
    none(&complaints);
}

#[test]
fn what_is_skipped_is_said_by_one_crate() {
    let mut complaints = Vec::new();
    for source in sources() {
        // Benchmarks judge nothing, so they skip nothing.
        if source.path.starts_with("tests/") || source.path.contains("/benches/") {
            continue;
        }
        for (number, line) in source.code() {
            if line.contains("println!(\"skipped") {
                complaints.push(format!(
                    "{}:{number}: a skip that nobody counts",
                    source.path
                ));
            }
        }
    }
    none(&complaints);
}
