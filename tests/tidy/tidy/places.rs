//! Rules of where things stand: limits, numbers of errors, texts instead of errors, folders of tests.
//!
//! Owns the lists of crates and files that they are for, and of what they let pass.

use super::{Source, none, sources};
use std::collections::BTreeSet;

/// Crates whose limits all stand in their `limits.rs`: all but `filters`, whose numbers are ranges of parameters, which
/// stand with the equations that they are for.
const LIMITED: [&str; 25] = [
    "bridge",
    "config",
    "converter",
    "ev3dev",
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
    "trik",
    "trikd",
    "trikfs",
    "web",
    "web/dcml",
];
/// Crates in which numbers of errors stand in one place, and no function gives a text as an error.
const BLAMING: [&str; 24] = [
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
    "trikfs",
    "web",
    "web/dcml",
];
/// Crates in which no function gives a text as an error either. Numbers of errors stand in several of their files: each
/// says what an answer of the system means there.
const TYPED: [&str; 4] = ["bridge", "grading", "trik", "trikd"];
/// Constants of such a crate that are named like limits and are none of ours, as beginnings of paths with a name: facts of
/// devices, of the physics that a virtual robot obeys, of the kernel and of the picture of a page.
const NO_LIMITS: [(&str, &str); 20] = [
    ("config/src/vm/memory", "SMALL_MAX"),
    ("ev3dev/src/fixed", "LED_BRIGHTNESS_MAX"),
    ("ev3dev/src/motor/command", "POWER_MAX"),
    ("ev3dev/src/motor/control", "LAG_MAX"),
    ("ev3dev/src/motor/shaft", "COUNTS_PER_S_MAX"),
    ("ev3dev/src/motor/shaft", "STEP_S_MAX"),
    ("ev3dev/src/servo", "DEGREES_MAX"),
    ("ev3dev/src/view", "NAME_MAX"),
    ("lang/diagram/src/blocks/act", "WHOLES_MAX"),
    ("lang/diagram/src/blocks/waits", "LIMIT"),
    ("sim/src/arena/brick", "RANGE_NOISE_MAX"),
    ("sim/src/arena/dynamics", "BOUNCE_MIN"),
    ("sim/src/arena/floor/sensors", "LIGHT_LIMIT"),
    ("sim/src/arena/floor/sensors", "LIGHT_MAX"),
    ("sim/src/judge/picture", "LETTERS_MIN"),
    ("sim/src/sensors", "MAX_GRID"),
    ("trikd/src/brick/actuators", "ANGLE_MAX"),
    ("trikd/src/brick/actuators", "POWER_MAX"),
    ("trikfs/src/transport/native/abi", "MAX_PAGES"),
    ("trikfs/src/transport/native/abi", "MINOR_MIN"),
];
/// Files that give errors their numbers: of the filesystem, of the words of `faulty`, of the view of ev3dev, of a reader of
/// the sample bus, of a virtual I2C bus, of nodes that leave the tree while they are recorded.
const NUMBERS: [&str; 6] = [
    "config/src/source/faulty.rs",
    "ev3dev/src/errno.rs",
    "recorder/src/errno.rs",
    "sample-bus/src/reader.rs",
    "sim/src/errno.rs",
    "trikfs/src/errno.rs",
];
/// Lines that name a number of the system and choose none, as the end of a path with a part of the line: patterns that are
/// broken over lines, and a mount that is there and that nobody serves, which the kernel would say itself.
const NUMBERS_READ: [(&str, &str); 2] = [
    (
        "trikfs/src/mount.rs",
        "Err(MountError::System(path.into(), Errno::ENOTCONN.into()))",
    ),
    (
        "trikfs/src/mount.rs",
        "Some(Errno::ENOTCONN | Errno::ECONNABORTED)",
    ),
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

/// Whether a line chooses the number of an error. What the system gives may be compared with one of nix's names: in a
/// pattern, by `matches!` and by `==`.
fn chooses_number(line: &str) -> bool {
    let names_one = |after: &str| {
        let is_other = ["EPOLL", "EFD_"].iter().any(|word| after.starts_with(word));
        let mut letters = after.chars();
        letters.next() == Some('E')
            && letters.next().is_some_and(|c| c.is_ascii_uppercase())
            && !is_other
    };
    let is_bare = |after: &str| after.starts_with(|c: char| c.is_ascii_digit());
    let given = line.rsplit("=>").next().unwrap_or(line);
    let is_compared = line.contains("matches!(") || line.contains("== ");
    line.split("libc::").skip(1).any(names_one)
        || !is_compared && given.split("Errno::").skip(1).any(names_one)
        || ["from_raw_os_error(", "Error::Device(", "Errno::from_raw("]
            .iter()
            .any(|call| line.split(call).skip(1).any(is_bare))
}

#[test]
fn numbers_that_are_chosen_are_told_from_those_that_are_read() {
    for line in [
        "return Err(libc::EINVAL);",
        "Err(Errno::EPERM) => Err(Errno::EIO),",
        "io::Error::from_raw_os_error(5)",
        "Error::Device(5, name)",
    ] {
        assert!(chooses_number(line), "{line}");
    }
    for line in [
        "Err(Errno::EINTR | Errno::ENOENT) => continue,",
        "matches!(read, Ok(None) | Err(Errno::EINTR))",
        "if error == Errno::EINVAL {",
        "io::Error::from_raw_os_error(errno)",
        "libc::EPOLLIN",
    ] {
        assert!(!chooses_number(line), "{line}");
    }
}

#[test]
fn errors_get_their_numbers_in_one_file() {
    let mut complaints = Vec::new();
    let all = sources();
    for source in product(&all, &BLAMING).filter(|source| !NUMBERS.contains(&source.path.as_str()))
    {
        for (number, line) in lines(source) {
            let passes =
                |(path, part): &(&str, &str)| source.path.ends_with(path) && line.contains(part);
            if chooses_number(line) && !NUMBERS_READ.iter().any(passes) {
                complaints.push(format!("{}:{number}: {}", source.path, line.trim()));
            }
        }
    }
    none(&complaints);
}

/// Functions that a parser of an option's value calls and that give its error; parsers themselves are found by the
/// attribute that names them. `clap` shows such a text beside the option.
const TEXTS: [&str; 2] = ["mountpoint", "seconds"];

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

/// Whether the types after `Result<` end with a text as the error, which may stand in another line.
fn gives_text(types: &str) -> bool {
    let mut depth = 1;
    let mut before = b' ';
    let end = types.bytes().position(|byte| {
        match byte {
            b'<' | b'(' => depth += 1,
            // An arrow ends nothing.
            b'>' if before == b'-' => {}
            b'>' | b')' => depth -= 1,
            _ => {}
        }
        before = byte;
        depth == 0
    });
    end.is_some_and(|end| {
        let types = types[..end].trim_end().trim_end_matches(',').trim_end();
        let error = types.rsplit_once(',').map(|(_, error)| error.trim());
        error == Some("String")
    })
}

/// The name of the last function that begins in a text.
fn last_function(text: &str) -> &str {
    let begun = text.rsplit_once("fn ").map_or("", |(_, begun)| begun);
    let end = begun.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    &begun[..end.unwrap_or(begun.len())]
}

/// Numbers of the lines in which a text gives a text as an error, but for functions that may.
fn texts_as_errors(text: &str, may: impl Fn(&str) -> bool) -> Vec<usize> {
    let mut found = Vec::new();
    for (at, word) in text.match_indices("Result<") {
        let is_text = gives_text(&text[at + word.len()..]);
        if is_text && !may(last_function(&text[..at])) {
            found.push(text[..at].lines().count());
        }
    }
    found
}

#[test]
fn a_text_as_an_error_is_seen_over_lines() {
    let broken = "fn f() -> Result<\n    (u8, fn() -> u8),\n    String,\n> {";
    assert_eq!(texts_as_errors(broken, |_| false), [1]);
    assert_eq!(
        texts_as_errors("\nfn f() -> Result<u8, String> {", |_| false),
        [2]
    );
    assert!(texts_as_errors("fn f() -> Result<String, Error> {", |_| false).is_empty());
    assert!(
        texts_as_errors(
            "fn seconds(text: &str) -> Result<u32, String> {",
            |name| name == "seconds"
        )
        .is_empty()
    );
}

#[test]
fn what_goes_wrong_is_no_text() {
    let mut complaints = Vec::new();
    let all = sources();
    let parsers = value_parsers(&all);
    for source in product(&all, &BLAMING).chain(product(&all, &TYPED)) {
        let (folder, _) = source.path.split_once("/src/").unwrap_or_default();
        let may = |name: &str| TEXTS.contains(&name) || parsers.contains(&(folder, name));
        let mut kept = vec![""; source.product().lines().count()];
        for (number, line) in lines(source) {
            kept[number - 1] = line;
        }
        for number in texts_as_errors(&kept.join("\n"), may) {
            let line = kept[number - 1].trim();
            complaints.push(format!("{}:{number}: {line}", source.path));
        }
    }
    none(&complaints);
}

/// What makes a folder or a file of its own below the temporary one, as a path and why `tempfile` is not for it.
const OWN_FOLDERS: [(&str, &str); 12] = [
    (
        "lang/dcml/benches/generated.rs",
        "a measured program, which stays",
    ),
    (
        "lang/dcml/benches/run.rs",
        "a measured program, which stays",
    ),
    (
        "lang/dcml/tests/generate/tools.rs",
        "stays when a compiler complains",
    ),
    (
        "lang/diagram/tests/generate/main.rs",
        "stays when a compiler complains",
    ),
    (
        "lang/plan/benches/plan.rs",
        "a measured program, which stays",
    ),
    (
        "tests/harness/board.rs",
        "what killed runs have left is unmounted first",
    ),
    ("tests/needs/src/lib.rs", "the crate depends on none"),
    ("trik/benches/check.rs", "a measured folder"),
    (
        "trikfs/src/cli/edit.rs",
        "the product: the user's text stays when it is not in force",
    ),
    (
        "trikfs/src/convert/shared/cache.rs",
        "the product: where caches are without a home",
    ),
    ("tests/tidy/tidy/places.rs", "this rule"),
    (
        "trik/src/replay.rs",
        "makes a file without a name there, and errors name the folder",
    ),
];

/// Generators of random numbers that are not `needs::Random`, as a path and why.
const OWN_RANDOM: [(&str, &str); 5] = [
    (
        "converter/src/trial.rs",
        "the product: a trial of a library",
    ),
    (
        "lang/dcml/src/sketch.rs",
        "the product: what a sketch is drawn with",
    ),
    (
        "lang/diagram/src/stand_in.rs",
        "the product: a robot that is none",
    ),
    ("tests/needs/src/random.rs", "that one"),
    ("tests/tidy/tidy/places.rs", "this rule"),
];

#[test]
fn random_numbers_of_tests_are_those_of_needs() {
    let mut complaints = Vec::new();
    let mut found = Vec::new();
    for source in sources() {
        // The first step of a generator of Marsaglia.
        let is_step = |line: &str| line.contains("^=") && line.contains("<< 13");
        let mut lines = source.code().filter(|(_, line)| is_step(line));
        let Some((number, _)) = lines.next() else {
            continue;
        };
        if !OWN_RANDOM.iter().any(|(path, _)| *path == source.path) {
            complaints.push(format!("{}:{number}: use needs::Random", source.path));
        }
        drop(lines);
        found.push(source.path);
    }
    for (path, _) in OWN_RANDOM {
        if !found.iter().any(|one| one == path) {
            complaints.push(format!("{path}: has no generator"));
        }
    }
    none(&complaints);
}

#[test]
fn folders_of_tests_are_those_of_tempfile() {
    let mut complaints = Vec::new();
    let mut found = Vec::new();
    for source in sources() {
        let lines = source
            .code()
            .filter(|(_, line)| line.contains("temp_dir()"));
        let lines: Vec<usize> = lines.map(|(number, _)| number).collect();
        let Some(number) = lines.first() else {
            continue;
        };
        if !OWN_FOLDERS.iter().any(|(path, _)| *path == source.path) {
            complaints.push(format!("{}:{number}: temp_dir()", source.path));
        }
        found.push(source.path);
    }
    for (path, _) in OWN_FOLDERS {
        if !found.iter().any(|one| one == path) {
            complaints.push(format!("{path}: makes no folder of its own"));
        }
    }
    none(&complaints);
}
