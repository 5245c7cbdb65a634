//! `trikfs new-converter`: a project to begin with, for each language.
//!
//! Owns which files there are and what names they get. The files themselves lie in `converter/templates` and in the
//! sources of the crate `converter`, and are compiled into the program, so that one installed on a robot has them too.

use crate::failure::Failure;
use crate::limits::PROJECT_NAME_BYTES_MAX;
use config::source::is_constructor;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// A language of converters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// In the configuration itself.
    Lua,
    /// A library of the versioned form.
    C,
    /// A library on top of the crate `converter`.
    Rust,
}

/// What the templates are called; replaced by the name of the project, in both spellings.
const TEMPLATE: (&str, &str) = ("battery_mean", "BatteryMean");

/// What a name is that the sandbox of configurations has taken.
const GLOBAL: &str = "a global name of configurations";

/// Names that would be syntax, or something else already, in a file of a project. Words that make sources are known to
/// `config`.
const RESERVED: &[(&str, &[&str])] = &[
    (
        "a word of Lua",
        &[
            "and", "break", "do", "else", "elseif", "end", "false", "for", "function", "goto",
            "if", "in", "local", "nil", "not", "or", "repeat", "return", "then", "true", "until",
            "while",
        ],
    ),
    (
        GLOBAL,
        &[
            "ba",
            "bit",
            "coroutine",
            "dataflow",
            "dcml",
            "error",
            "filter",
            "id_create",
            "include",
            "load",
            "math",
            "params",
            "print",
            "string",
            "table",
            "trikfs",
            "trikfs_log",
        ],
    ),
    ("a file of the tree", &["config", "log", "status", "stop"]),
    (
        "a word of C",
        &[
            "auto", "case", "char", "const", "continue", "default", "double", "enum", "extern",
            "float", "inline", "int", "long", "register", "restrict", "short", "signed", "sizeof",
            "static", "struct", "switch", "typedef", "union", "unsigned", "void", "volatile",
        ],
    ),
    (
        "a word of Rust",
        &[
            "abstract", "as", "async", "await", "become", "box", "crate", "dyn", "final", "fn",
            "gen", "impl", "let", "loop", "macro", "match", "mod", "move", "mut", "override",
            "priv", "pub", "ref", "self", "super", "trait", "try", "type", "typeof", "unsafe",
            "unsized", "use", "virtual", "where", "yield",
        ],
    ),
    (
        "a library that is there already",
        &[
            "alloc",
            "c",
            "converter",
            "core",
            "m",
            "proc_macro",
            "std",
            "test",
        ],
    ),
];

/// Where a file goes, and its text before names are replaced.
type File = (&'static str, &'static str);

macro_rules! template {
    ($path:literal) => {
        include_str!(concat!("../../converter/templates/", $path))
    };
}

const LUA: &[File] = &[
    ("README.md", template!("lua/README.md")),
    ("robot.lua", template!("lua/robot.lua")),
    ("vectors.txt", template!("vectors.txt")),
    ("test.sh", template!("lua/test.sh")),
    (".gitignore", template!("lua/.gitignore")),
];

const C: &[File] = &[
    ("README.md", template!("c/README.md")),
    ("battery_mean.c", template!("c/battery_mean.c")),
    (
        "trikfs_converter.h",
        include_str!("../../converter/include/trikfs_converter.h"),
    ),
    ("test.c", template!("c/test.c")),
    ("vectors.txt", template!("vectors.txt")),
    ("robot.lua", template!("c/robot.lua")),
    ("Makefile", template!("c/Makefile")),
    (".gitignore", template!("c/.gitignore")),
];

const RUST: &[File] = &[
    ("README.md", template!("rust/README.md")),
    ("Cargo.toml", template!("rust/Cargo.toml")),
    ("src/lib.rs", template!("rust/src/lib.rs")),
    ("vectors.txt", template!("vectors.txt")),
    ("robot.lua", template!("rust/robot.lua")),
    (".gitignore", template!("rust/.gitignore")),
    ("converter/Cargo.toml", template!("rust/converter.toml")),
];

/// The crate `converter`, for projects in Rust; its own tests are left out.
const CRATE: &[File] = &[
    (
        "converter/src/lib.rs",
        include_str!("../../converter/src/lib.rs"),
    ),
    (
        "converter/src/abi.rs",
        include_str!("../../converter/src/abi.rs"),
    ),
    (
        "converter/src/abi/instance.rs",
        include_str!("../../converter/src/abi/instance.rs"),
    ),
    (
        "converter/src/abi/validate.rs",
        include_str!("../../converter/src/abi/validate.rs"),
    ),
    (
        "converter/src/error.rs",
        include_str!("../../converter/src/error.rs"),
    ),
    (
        "converter/src/export.rs",
        include_str!("../../converter/src/export.rs"),
    ),
    (
        "converter/src/limits.rs",
        include_str!("../../converter/src/limits.rs"),
    ),
    (
        "converter/src/trial.rs",
        include_str!("../../converter/src/trial.rs"),
    ),
    (
        "converter/src/vectors.rs",
        include_str!("../../converter/src/vectors.rs"),
    ),
];

/// What was made, and how to go on.
#[derive(Debug)]
pub struct NewProject {
    /// The folder.
    pub folder: PathBuf,
    /// Paths in the folder, in the order in which they are worth reading.
    pub files: Vec<String>,
    /// Commands for a shell, which work as they stand.
    pub next: Vec<String>,
}

/// Writes the project `name` into `folder`, or into a folder of its name, which must not be there yet.
///
/// # Errors
/// A name that some file of the project could not have, a folder that is there, or one that cannot be written; then
/// nothing is left.
pub fn new_converter(
    language: Language,
    name: &str,
    folder: Option<&Path>,
) -> Result<NewProject, Failure> {
    check_name(name)?;
    let folder = folder.unwrap_or(Path::new(name));
    fs::create_dir(folder).map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => Failure::Refused(format!(
            "{} is there already; take another name, or another folder with --dir",
            folder.display()
        )),
        std::io::ErrorKind::NotFound => Failure::file(
            folder,
            "the folder around it is not there; make it first with mkdir -p",
        ),
        _ => Failure::file(folder, error),
    })?;
    let files = files(language, name);
    for (path, text) in &files {
        let path = folder.join(path);
        let parent = path.parent().unwrap_or(folder);
        let written = fs::create_dir_all(parent).and_then(|()| fs::write(&path, text));
        if let Err(error) = written {
            // We made the folder, so everything in it is ours.
            let _ = fs::remove_dir_all(folder);
            return Err(Failure::file(&path, error));
        }
    }
    Ok(NewProject {
        folder: folder.to_owned(),
        next: next(folder, &files),
        files: files.into_iter().map(|(path, _)| path).collect(),
    })
}

impl NewProject {
    /// For people.
    pub fn render(&self) -> String {
        let mut text = format!("made {}:\n", self.folder.display());
        for file in &self.files {
            let _ = writeln!(text, "  {file}");
        }
        text.push_str("next, and what it means is in README.md:\n");
        for command in &self.next {
            let _ = writeln!(text, "  {command}");
        }
        text
    }
}

/// All files of a project with their texts.
fn files(language: Language, name: &str) -> Vec<(String, String)> {
    let own = match language {
        Language::Lua => LUA,
        Language::C => C,
        Language::Rust => RUST,
    };
    let own = own.iter().map(|(path, text)| {
        // Its own words in a crate's manifest mean the crate.
        (named(path, name), named(text, name))
    });
    let beside = CRATE.iter().filter(|_| language == Language::Rust);
    let beside = beside.map(|(path, text)| ((*path).to_owned(), without_tests(text)));
    own.chain(beside).collect()
}

/// A text of the template with the name of the project.
fn named(text: &str, name: &str) -> String {
    text.replace(TEMPLATE.0, name)
        .replace(TEMPLATE.1, &camel(name))
}

/// `my_sensor` as `MySensor`.
fn camel(name: &str) -> String {
    name.split('_').fold(String::new(), |mut all, word| {
        let mut letters = word.chars();
        all.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        all.push_str(letters.as_str());
        all
    })
}

/// A source of ours without what only its own tests need.
fn without_tests(text: &str) -> String {
    let text = text
        .split_once("\n#[cfg(test)]\nmod tests {")
        .map_or(text, |(code, _)| code);
    let mut code = String::with_capacity(text.len());
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        if line == "#[cfg(test)]" {
            // `mod NAME;` and the empty line after it.
            lines.next();
            lines.next_if(|line| line.is_empty());
        } else {
            code.push_str(line);
            code.push('\n');
        }
    }
    code.truncate(code.trim_end().len() + 1);
    code
}

/// The first commands of the README, from the folder where we are.
fn next(folder: &Path, files: &[(String, String)]) -> Vec<String> {
    let readme = files.iter().find(|(path, _)| path == "README.md");
    let commands = readme
        .and_then(|(_, text)| text.split_once("```sh\n"))
        .and_then(|(_, rest)| rest.split_once("```"))
        .map_or("", |(commands, _)| commands);
    let enter = format!("cd {}", quoted(&folder.display().to_string()));
    std::iter::once(enter)
        .chain(commands.lines().map(str::to_owned))
        .collect()
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-".contains(c);
    if word.chars().all(is_plain) && !word.starts_with('-') {
        return word.to_owned();
    }
    let inside = word.replace('\'', "'\\''");
    if word.starts_with('-') {
        return format!("'./{inside}'");
    }
    format!("'{inside}'")
}

/// A name that can be the name of a node, of a library, and part of names in C, Rust and Lua.
fn check_name(name: &str) -> Result<(), Failure> {
    let is_good = name.len() <= PROJECT_NAME_BYTES_MAX
        && name.starts_with(|c: char| c.is_ascii_lowercase())
        && name
            .bytes()
            .all(|b| b.is_ascii_lowercase() || b.is_ascii_digit() || b == b'_');
    if !is_good {
        let near: String = name
            .chars()
            .map(|c| {
                if c.is_ascii_alphanumeric() {
                    c.to_ascii_lowercase()
                } else {
                    '_'
                }
            })
            .skip_while(|c| !c.is_ascii_lowercase())
            .take(PROJECT_NAME_BYTES_MAX)
            .collect();
        let near = near.trim_end_matches('_');
        let try_it = match near {
            "" => String::new(),
            near => format!("; try {near}"),
        };
        let shown: String = name
            .chars()
            .take(2 * PROJECT_NAME_BYTES_MAX)
            .flat_map(char::escape_debug)
            .collect();
        return Err(Failure::Refused(format!(
            "the name '{shown}' does not do: a name begins with a letter a-z, goes on with a-z, 0-9 and _, and has at \
             most {PROJECT_NAME_BYTES_MAX} characters{try_it}"
        )));
    }
    let meaning = RESERVED
        .iter()
        .find(|(_, words)| words.contains(&name))
        .map(|(meaning, _)| *meaning)
        .or_else(|| is_constructor(name.as_bytes()).then_some(GLOBAL));
    match meaning {
        Some(meaning) => Err(Failure::Refused(format!(
            "the name '{name}' does not do: it is {meaning}; try {name}_sensor"
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn a_name_is_replaced_everywhere_and_no_word_of_the_template_is_left() {
        for language in [Language::Lua, Language::C, Language::Rust] {
            for (path, text) in files(language, "sharp_ir") {
                for word in [TEMPLATE.0, TEMPLATE.1] {
                    assert!(
                        !path.contains(word) && !text.contains(word),
                        "{path}: {word}"
                    );
                }
                assert!(
                    !text.contains("cfg(test)") || path == "src/lib.rs",
                    "{path}"
                );
            }
        }
        let rust = files(Language::Rust, "sharp_ir");
        let text = |wanted: &str| &rust.iter().find(|(path, _)| path == wanted).unwrap().1;
        assert!(text("src/lib.rs").contains("\"sharp_ir\" => SharpIrState,"));
        assert!(text("robot.lua").contains("target/release/libsharp_ir.so#sharp_ir"));
    }

    #[test]
    fn the_copied_crate_is_whole_and_says_what_rust_it_needs() {
        let map = files(Language::Rust, "x");
        let sources = ["src/lib.rs", "src/abi.rs"].map(|path| format!("converter/{path}"));
        for (path, text) in map.iter().filter(|(path, _)| sources.contains(path)) {
            let folder = if path.ends_with("lib.rs") {
                "converter/src/"
            } else {
                "converter/src/abi/"
            };
            for line in text.lines().map(|line| line.trim_start_matches("pub ")) {
                if let Some(module) = line
                    .strip_prefix("mod ")
                    .and_then(|rest| rest.strip_suffix(';'))
                {
                    let wanted = format!("{folder}{module}.rs");
                    assert!(map.iter().any(|(path, _)| *path == wanted), "{wanted}");
                }
            }
        }
        let manifest = &map
            .iter()
            .find(|(path, _)| path == "converter/Cargo.toml")
            .unwrap()
            .1;
        for (key, value) in [
            ("version", env!("CARGO_PKG_VERSION")),
            ("rust-version", env!("CARGO_PKG_RUST_VERSION")),
            ("license", env!("CARGO_PKG_LICENSE")),
        ] {
            let line = format!("\n{key} = \"{value}\"\n");
            assert!(manifest.contains(&line), "no {line} in\n{manifest}");
        }
    }

    #[test]
    fn bad_names_are_refused_with_a_better_one() {
        for (name, words) in [
            ("", "has at most 32 characters"),
            ("Sharp-IR", "; try sharp_ir"),
            ("9dof", "; try dof"),
            ("../x", "; try x"),
            ("a b", "; try a_b"),
            ("caf\u{e9}", "; try caf"),
            ("a\nb", "'a\\nb'"),
            (&"a".repeat(33), "has at most 32 characters"),
            ("end", "it is a word of Lua; try end_sensor"),
            ("int", "it is a word of C; try int_sensor"),
            ("self", "it is a word of Rust; try self_sensor"),
            ("log", "it is a file of the tree; try log_sensor"),
            ("converter", "it is a library that is there already"),
            ("i2c_bus", "it is a global name of configurations"),
            ("bit", "it is a global name of configurations"),
        ] {
            let refusal = check_name(name).unwrap_err().to_string();
            assert!(
                refusal.contains(words) && refusal.is_ascii() | name.contains('\u{e9}'),
                "{refusal}"
            );
        }
        for name in ["a", "sharp_ir", "gp2y0a21", "result", "free", "open", "x_"] {
            assert!(check_name(name).is_ok(), "{name}");
        }
    }

    #[test]
    fn a_folder_that_is_there_is_left_alone() {
        let scratch = Scratch::new();
        let folder = scratch.path("mine");
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join("robot.lua"), "precious").unwrap();
        let refusal = new_converter(Language::Lua, "x", Some(&folder)).unwrap_err();
        let refusal = refusal.to_string();
        assert!(refusal.ends_with("another folder with --dir"), "{refusal}");
        assert_eq!(fs::read(folder.join("robot.lua")).unwrap(), b"precious");
        let refusal = new_converter(Language::Lua, "x", Some(&folder.join("a/b"))).unwrap_err();
        let refusal = refusal.to_string();
        assert!(refusal.contains("mkdir -p"), "{refusal}");
    }

    #[test]
    fn words_reach_the_shell_as_they_are() {
        assert_eq!(quoted("a/b_c-1.x"), "a/b_c-1.x");
        assert_eq!(quoted("it's mine"), "'it'\\''s mine'");
        assert_eq!(quoted("-x"), "'./-x'");
    }
}
