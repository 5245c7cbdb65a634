//! The documents of the project, and the fenced examples of a Markdown file.
//!
//! Owns finding them, nothing of what they mean.

use std::path::{Path, PathBuf};

/// One fenced block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Example {
    /// Words after the opening fence, for example `lua config battery`.
    pub info: String,
    /// Line of the opening fence, from 1.
    pub line: usize,
    /// The text between the fences.
    pub text: String,
}

/// All documents of the project; not those that are copied into projects of users.
pub fn documents() -> Vec<PathBuf> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut found: Vec<_> = [
        "README.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "CHANGELOG.md",
        "SECURITY.md",
        "editors/vscode/README.md",
        "tests/recorded/README.md",
    ]
    .iter()
    .map(|name| root.join(name))
    .collect();
    let mut folders = ["docs", "cross", ".github"]
        .map(|name| root.join(name))
        .to_vec();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// All fenced blocks in order. One that is not closed ends with the file.
pub fn examples(markdown: &str) -> Vec<Example> {
    let mut found = Vec::new();
    let mut open: Option<Example> = None;
    for (index, line) in markdown.lines().enumerate() {
        match (line.strip_prefix("```"), open.as_mut()) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(info), None) => {
                open = Some(Example {
                    info: info.trim().to_owned(),
                    line: index + 1,
                    text: String::new(),
                });
            }
            (None, Some(example)) => {
                example.text.push_str(line);
                example.text.push('\n');
            }
            (None, None) => {}
        }
    }
    found.extend(open);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_come_with_their_words_and_lines() {
        let found = examples("text\n```sh session\n$ ls\na\n```\n```\nplain\n```\n");
        let expected = |info: &str, line, text: &str| Example {
            info: info.to_owned(),
            line,
            text: text.to_owned(),
        };
        assert_eq!(
            found,
            [
                expected("sh session", 2, "$ ls\na\n"),
                expected("", 6, "plain\n")
            ]
        );
    }
}
