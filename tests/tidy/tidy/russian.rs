//! Pages in Russian: each has the blocks, the headings, the tables and the words in code of the page that it translates.
//!
//! Owns the list of these pages. Knows nothing of what they say: a sentence that changed without such a word is for readers.

use super::{files, none, root};
use harness::documents::{Example, examples};

/// Pages that `docs/ru` has under the same name.
const TRANSLATED: [&str; 10] = [
    "docs/teacher/checking.md",
    "docs/teacher/rules.md",
    "docs/teacher/site.md",
    "docs/user/class.md",
    "docs/user/page.md",
    "docs/user/programs.md",
    "docs/user/run.md",
    "docs/user/start.md",
    "docs/user/studio.md",
    "docs/user/trik-up.md",
];

/// The only page of `docs/ru` that translates none.
const INDEX: &str = "README.md";

fn name(page: &str) -> &str {
    page.rsplit('/').next().unwrap_or(page)
}

/// A page with its path from the root of the workspace.
struct Page<'t> {
    path: &'t str,
    text: &'t str,
}

/// What stands between two headings, without its blocks.
struct Section {
    line: usize,
    heading: String,
    rows: usize,
    prose: String,
}

impl Section {
    fn level(&self) -> usize {
        self.heading.chars().take_while(|c| *c == '#').count()
    }

    /// What stands between backticks.
    fn words(&self) -> impl Iterator<Item = &str> {
        self.prose
            .lines()
            .flat_map(|line| line.split('`').skip(1).step_by(2))
    }
}

impl Page<'_> {
    fn sections(&self) -> Vec<Section> {
        let mut found: Vec<Section> = Vec::new();
        let mut inside = false;
        for (index, line) in self.text.lines().enumerate() {
            let is_fence = line.starts_with("```");
            inside ^= is_fence;
            if inside || is_fence {
                continue;
            }
            if line.starts_with('#') {
                found.push(Section {
                    line: index + 1,
                    heading: line.to_owned(),
                    rows: 0,
                    prose: String::new(),
                });
            } else if let Some(section) = found.last_mut() {
                section.rows += usize::from(line.starts_with('|'));
                section.prose.push_str(line);
                section.prose.push('\n');
            }
        }
        found
    }

    /// The first block in which a translation differs from this page.
    fn differing_block(&self, other: &Page<'_>) -> Option<String> {
        let (ours, theirs) = (examples(self.text), examples(other.text));
        let mut pairs = ours.iter().zip(&theirs);
        let differ = |(our, their): &(&Example, &Example)| {
            (&our.info, &our.text) != (&their.info, &their.text)
        };
        if let Some((our, their)) = pairs.find(differ) {
            let mut lines = our.text.lines().zip(their.text.lines());
            let why = match lines.find(|(wanted, found)| wanted != found) {
                _ if our.info != their.info => {
                    format!("marked '{}', not '{}'", their.info, our.info)
                }
                Some((wanted, found)) => format!("'{found}', not '{wanted}'"),
                None => "it has more lines or less".to_owned(),
            };
            let number = ours.iter().take_while(|one| one.line <= our.line).count();
            let place = format!("{}:{}: block {number}", other.path, their.line);
            return Some(format!(
                "{place} is not that of {}:{}: {why}",
                self.path, our.line
            ));
        }
        let (wanted, found) = (ours.len(), theirs.len());
        (wanted != found).then(|| {
            let (page, english) = (other.path, self.path);
            format!("{page}: {found} blocks, and {english} has {wanted}")
        })
    }

    /// What a translation has differently or not at all, outside of blocks.
    fn differing_sections(&self, other: &Page<'_>) -> Vec<String> {
        let (ours, theirs) = (self.sections(), other.sections());
        let mut pairs = ours.iter().zip(&theirs);
        if let Some((our, their)) = pairs.find(|(our, their)| our.level() != their.level()) {
            let place = format!("{}:{}: '{}'", other.path, their.line, their.heading);
            let there = format!("{}:{} has '{}'", self.path, our.line, our.heading);
            return vec![format!("{place} is of another level: {there} there")];
        }
        if ours.len() != theirs.len() {
            let (found, wanted) = (theirs.len(), ours.len());
            let (page, english) = (other.path, self.path);
            return vec![format!(
                "{page}: {found} headings, and {english} has {wanted}"
            )];
        }
        let mut complaints = Vec::new();
        for (our, their) in ours.iter().zip(&theirs) {
            let place = format!("{}:{}: '{}'", other.path, their.line, their.heading);
            let there = format!("{}:{}", self.path, our.line);
            if our.rows != their.rows {
                let (found, wanted) = (their.rows, our.rows);
                complaints.push(format!(
                    "{place} has {found} rows of tables, {there} {wanted}"
                ));
            }
            for word in our.words().filter(|word| !their.prose.contains(word)) {
                complaints.push(format!("{place} says nothing of `{word}`, as {there} does"));
            }
        }
        complaints
    }
}

#[test]
fn pages_in_russian_are_those_that_they_translate() {
    let mut complaints = Vec::new();
    for path in TRANSLATED {
        let name = name(path);
        let translation = format!("docs/ru/{name}");
        let read = |path: &str| {
            std::fs::read_to_string(root().join(path))
                .unwrap_or_else(|error| panic!("{path}: {error}"))
        };
        let (english, russian) = (read(path), read(&translation));
        let folder = path.strip_suffix(&format!("/{name}")).unwrap_or(path);
        let there = format!("[{name}](../ru/{name})");
        let back = format!("[{name}](../{}/{name})", self::name(folder));
        for (page, text, link) in [(path, &english, there), (&translation, &russian, back)] {
            if !text.lines().take(4).any(|line| line.contains(&link)) {
                complaints.push(format!("{page}: {link} is not at its top"));
            }
        }
        let english = Page {
            path,
            text: &english,
        };
        let russian = Page {
            path: &translation,
            text: &russian,
        };
        complaints.extend(english.differing_block(&russian));
        complaints.extend(english.differing_sections(&russian));
    }
    none(&complaints);
}

#[test]
fn every_page_in_russian_is_compared() {
    let mut found = Vec::new();
    files(&root().join("docs/ru"), "md", &mut found);
    let index = std::fs::read_to_string(root().join("docs/ru").join(INDEX)).expect(INDEX);
    let mut complaints = Vec::new();
    for path in found {
        let page = path.file_name().and_then(|name| name.to_str()).unwrap();
        if page == INDEX {
            continue;
        }
        if !TRANSLATED.iter().any(|one| name(one) == page) {
            complaints.push(format!("docs/ru/{page}: is not in TRANSLATED"));
        }
        if !index.contains(&format!("]({page})")) {
            complaints.push(format!("docs/ru/{page}: is not in docs/ru/{INDEX}"));
        }
    }
    none(&complaints);
}

#[test]
fn what_a_translation_lacks_is_told_with_its_place() {
    let english = "# A\n\n```sh check\n$ a\nb\n```\n\n## B\n\nSay `x`.\n\n| a |\n| - |\n";
    let told = |russian: &str| {
        let english = Page {
            path: "en.md",
            text: english,
        };
        let russian = Page {
            path: "ru.md",
            text: russian,
        };
        let mut told = Vec::from_iter(english.differing_block(&russian));
        told.extend(english.differing_sections(&russian));
        told.join("\n")
    };
    assert_eq!(told(english), "");
    let cases = [
        (
            "b\n```",
            "c\n```",
            "ru.md:3: block 1 is not that of en.md:3: 'c', not 'b'",
        ),
        (
            "check",
            "robot",
            "ru.md:3: block 1 is not that of en.md:3: marked 'sh robot', not 'sh check'",
        ),
        (
            "```sh check\n$ a\nb\n```\n",
            "",
            "ru.md: 0 blocks, and en.md has 1",
        ),
        (
            "## B",
            "### B",
            "ru.md:8: '### B' is of another level: en.md:8 has '## B' there",
        ),
        ("## B\n", "", "ru.md: 1 headings, and en.md has 2"),
        (
            "`x`",
            "y",
            "ru.md:8: '## B' says nothing of `x`, as en.md:8 does",
        ),
        (
            "| - |\n",
            "",
            "ru.md:8: '## B' has 1 rows of tables, en.md:8 2",
        ),
    ];
    for (from, to, wanted) in cases {
        assert_eq!(told(&english.replace(from, to)), wanted);
    }
}
