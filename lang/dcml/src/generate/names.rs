//! Names in a language: those of the model as far as the language has no other use for them.
//!
//! Owns letters, lengths and clashes. Which words are taken is known to the printer of the language.

use crate::limits;
use std::collections::{HashMap, HashSet};

/// Names that are in use in one text.
pub(super) struct Names {
    used: HashSet<String>,
    /// How often a name was wanted again.
    again: HashMap<String, u32>,
}

impl Names {
    /// No names are in use but the words of these lists.
    pub fn new(taken: &[&str]) -> Self {
        let words = taken.iter().flat_map(|list| list.split_whitespace());
        Self {
            used: words.map(str::to_owned).collect(),
            again: HashMap::new(),
        }
    }

    /// A free name like the one that is wanted. The same wishes in the same order give the same names.
    pub fn take(&mut self, wanted: &str) -> String {
        let plain = plain(wanted);
        if self.used.insert(plain.clone()) {
            return plain;
        }
        let count = self.again.entry(plain.clone()).or_insert(1);
        loop {
            *count += 1;
            let name = format!("{plain}_{count}");
            if self.used.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// A name of Latin letters, digits and underscores that begins with a letter and is not too long.
fn plain(name: &str) -> String {
    let mut out = letters(name, limits::DCML_WRITTEN_NAME);
    // An underscore at the beginning makes a name special in one language or another.
    if !out.starts_with(|first: char| first.is_ascii_alphabetic()) {
        out.insert(0, 'v');
    }
    out
}

/// The name with Latin letters, digits and underscores only, and with at most so many of them.
pub(super) fn letters(name: &str, length: usize) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if out.len() >= length {
            break;
        }
        match letter {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' => out.push(letter),
            other if other.is_alphanumeric() => out.push_str(&format!("u{:x}", other as u32)),
            _ => out.push('_'),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taken_names_get_a_number_and_keep_it() {
        let mut names = Names::new(&["end x", "end_2"]);
        let wanted = ["end", "x", "x", "y", "X", "__proto__", "9", ""];
        let got = wanted.map(|one| names.take(one));
        let right = ["end_3", "x_2", "x_3", "y", "X", "v__proto__", "v9", "v"];
        assert_eq!(got, right);
        assert_eq!(
            names.take(&"z".repeat(9000)).len(),
            limits::DCML_WRITTEN_NAME
        );
        assert_eq!(
            names.take(&"z".repeat(9000)).len(),
            limits::DCML_WRITTEN_NAME + 2
        );
    }
}
