//! Names in a language: what the user called something, as far as the language allows.
//!
//! Owns letters, reserved words and clashes. Knows no meaning of a name.

use crate::limits;
use std::collections::{HashMap, HashSet};

/// Latin letters for the Cyrillic ones from U+0430 on.
const LATIN: [&str; 32] = [
    "a", "b", "v", "g", "d", "e", "zh", "z", "i", "y", "k", "l", "m", "n", "o", "p", "r", "s", "t",
    "u", "f", "h", "ts", "ch", "sh", "sch", "", "y", "", "e", "yu", "ya",
];

/// What a language allows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    /// Whether Cyrillic letters may stand in names.
    pub(super) cyrillic: bool,
    /// Whether case makes no difference.
    pub(super) caseless: bool,
    /// Words that are taken.
    pub(super) reserved: &'static [&'static str],
    /// More of them, with spaces between.
    pub(super) taken: &'static str,
    /// Whether names may begin with an underscore and a letter.
    pub(super) underscores: bool,
}

/// Names that are in use.
#[derive(Clone, Debug)]
pub struct Names {
    rules: Rules,
    used: HashSet<String>,
    /// How far the numbers of a name have come, so that many alike take no longer each.
    counts: HashMap<String, usize>,
}

impl Names {
    pub(super) fn new(rules: Rules) -> Self {
        Self {
            rules,
            counts: HashMap::new(),
            used: rules
                .reserved
                .iter()
                .copied()
                .chain(rules.taken.split_whitespace())
                .map(|word| folded(word, rules))
                .collect(),
        }
    }

    /// A free name like the one that is wanted.
    pub fn take(&mut self, wanted: &str) -> String {
        let plain = plain(wanted, self.rules);
        let mut name = plain.clone();
        let count = self.counts.entry(folded(&plain, self.rules)).or_insert(1);
        while !self.used.insert(folded(&name, self.rules)) {
            *count += 1;
            name = format!("{plain}_{count}");
        }
        name
    }
}

fn folded(name: &str, rules: Rules) -> String {
    if rules.caseless {
        name.to_lowercase()
    } else {
        name.to_owned()
    }
}

/// The name with letters, digits and underscores only.
pub(super) fn plain(name: &str, rules: Rules) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if out.len() >= limits::GENERATED_NAME_MAX {
            break;
        }
        match letter {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' => out.push(letter),
            '\u{410}'..='\u{44f}' | '\u{401}' | '\u{451}' if rules.cyrillic => out.push(letter),
            '\u{410}'..='\u{44f}' | '\u{401}' | '\u{451}' => out.push_str(&latin(letter)),
            ' ' | '-' | '.' | ',' => out.push('_'),
            other if other.is_alphanumeric() => out.push_str(&format!("u{:x}", other as u32)),
            _ => out.push('_'),
        }
    }
    if out
        .chars()
        .next()
        .is_none_or(|first| first.is_ascii_digit())
    {
        out.insert(0, '_');
    }
    let is_hidden = |rest: &str| !rest.starts_with(|first: char| first.is_ascii_digit());
    if !rules.underscores && out.strip_prefix('_').is_some_and(is_hidden) {
        out.insert(0, 'v');
    }
    out
}

fn latin(letter: char) -> String {
    let small = letter.to_lowercase().next().unwrap_or(letter);
    let text = match small {
        '\u{451}' => "yo",
        _ => LATIN
            .get((small as usize).wrapping_sub(0x430))
            .copied()
            .unwrap_or("_"),
    };
    let mut text = text.to_owned();
    if letter != small
        && let Some(first) = text.get_mut(..1)
    {
        first.make_ascii_uppercase();
    }
    text
}
