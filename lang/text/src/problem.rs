//! What is wrong, where, and in words that a pupil understands: the one kind of diagnostics of this crate.
//!
//! Owns the shape of a problem and how it is shown. Knows no language: each part words its own problems, in English and
//! in Russian.

use crate::{limits, words};
use std::fmt;

/// A language of messages.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Locale {
    /// English.
    #[default]
    English,
    /// Russian.
    Russian,
}

impl Locale {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::English, Self::Russian];

    /// Its short name.
    pub fn name(self) -> &'static str {
        match self {
            Self::English => "en",
            Self::Russian => "ru",
        }
    }

    /// The one with this short name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }
}

/// One message in both languages.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Words {
    /// In English.
    pub english: String,
    /// In Russian.
    pub russian: String,
}

impl Words {
    /// Both texts of one message.
    pub fn new(english: impl Into<String>, russian: impl Into<String>) -> Self {
        Self {
            english: english.into(),
            russian: russian.into(),
        }
    }

    /// The message in a language.
    pub fn in_locale(&self, locale: Locale) -> &str {
        match locale {
            Locale::English => &self.english,
            Locale::Russian => &self.russian,
        }
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// It works, but perhaps not as meant.
    Warning,
    /// It does not work.
    Error,
}

impl Severity {
    /// Its word.
    pub fn words(self) -> Words {
        words::severity(self)
    }
}

/// A place in a text, both from 1.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Position {
    /// The line.
    pub line: u32,
    /// The column, in characters.
    pub column: u32,
}

/// Where something is wrong; each part may be unknown.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Place {
    /// The file inside a save, as `metaInfo.xml`.
    pub file: Option<String>,
    /// The diagram by its name.
    pub diagram: Option<String>,
    /// The object: a block or link, by its id in the save.
    pub object: Option<String>,
    /// The block in words: its type as a person knows it.
    pub block: Option<String>,
    /// The property of the block, by the name that the editor shows.
    pub property: Option<String>,
    /// The place in the text of the property or the file.
    pub position: Option<Position>,
    /// Bytes of the file before that place, if the part that found the problem does not have the text: [`locate`].
    pub offset: Option<u32>,
}

/// The place of a byte of a text.
pub fn position(text: &str, at: usize) -> Position {
    let at = (0..=at.min(text.len()))
        .rev()
        .find(|&at| text.is_char_boundary(at))
        .unwrap_or(0);
    let before = &text[..at];
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    Position {
        line: u32::try_from(line).unwrap_or(u32::MAX),
        column: u32::try_from(column).unwrap_or(u32::MAX),
    }
}

/// Something that is wrong.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Problem {
    /// How bad.
    pub severity: Severity,
    /// Where.
    pub place: Place,
    /// What, why, and what to do.
    pub words: Words,
    /// A sentence of advice that people are given and reports in the form of others are not.
    pub hint: Option<Words>,
}

impl Problem {
    /// An error whose place is not known yet.
    pub fn error(words: Words) -> Self {
        Self {
            severity: Severity::Error,
            place: Place::default(),
            words,
            hint: None,
        }
    }

    /// What people are told: the words, and the hint if there is one.
    pub fn said(&self, locale: Locale) -> String {
        let words = self.words.in_locale(locale);
        match &self.hint {
            None => words.to_owned(),
            Some(hint) => {
                let end = if words.ends_with('.') { "" } else { "." };
                format!("{words}{end} {}", hint.in_locale(locale))
            }
        }
    }

    /// A warning whose place is not known yet.
    pub fn warning(words: Words) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(words)
        }
    }

    /// The same without its position, for a line that begins with another one.
    #[must_use]
    pub fn without_position(&self) -> Self {
        let mut problem = self.clone();
        problem.place.position = None;
        problem
    }

    /// The problem in one line, in both languages.
    pub fn in_both(&self) -> Words {
        Words::new(
            self.in_locale(Locale::English),
            self.in_locale(Locale::Russian),
        )
    }

    /// The problem in one line: place, severity, words.
    pub fn in_locale(&self, locale: Locale) -> String {
        let place = &self.place;
        let mut line = String::new();
        for part in [&place.file, &place.diagram, &place.block]
            .into_iter()
            .flatten()
        {
            line.push_str(part);
            line.push_str(": ");
        }
        match (&place.property, place.position) {
            (Some(property), Some(at)) => {
                line.push_str(&format!("'{property}', {}:{} ", at.line, at.column));
            }
            (Some(property), None) => line.push_str(&format!("'{property}': ")),
            (None, Some(at)) => line.push_str(&format!("{}:{} ", at.line, at.column)),
            (None, None) => {}
        }
        line.push_str(&self.said(locale));
        line
    }
}

/// Says lines and columns of problems that have offsets, in one walk through their text.
pub fn locate(problems: &mut [Problem], text: &str) {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_open = |one: &&mut Problem| one.place.position.is_none() && one.place.offset.is_some();
    let mut open: Vec<&mut Problem> = problems.iter_mut().filter(is_open).collect();
    open.sort_by_key(|problem| problem.place.offset);
    let mut chars = text.char_indices().peekable();
    let (mut line, mut column) = (1u32, 1u32);
    for problem in open {
        let to = problem.place.offset.unwrap_or_default() as usize;
        while let Some((_, c)) = chars.next_if(|(at, _)| *at < to) {
            (line, column) = match c {
                '\n' => (line.saturating_add(1), 1),
                _ => (line, column.saturating_add(1)),
            };
        }
        problem.place.position = Some(Position { line, column });
    }
}

/// What the system said of an error, in Russian as far as that is known: its sentence, with the number of the error or without.
pub fn of_system(said: &str) -> String {
    words::of_system(said)
}

/// Adds a problem to others, unless there are so many already that one more helps nobody.
pub fn keep(problems: &mut Vec<Problem>, problem: Problem) {
    if problems.len() < limits::PROBLEMS_KEPT {
        problems.push(problem);
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.in_locale(Locale::English))
    }
}
