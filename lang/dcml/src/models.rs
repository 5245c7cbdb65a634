//! The models that come with the language: texts of well-known robots, each with its source.
//!
//! Owns their names; what they mean is what their texts say.

use super::nearest::nearest;

/// A part of a name with fewer letters could mean anything.
const LIKE_LETTERS: usize = 3;

/// A model that comes with the language.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Shipped {
    /// Its name on command lines.
    pub name: &'static str,
    /// A document with this one model.
    pub text: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
}

/// All of them: those of the paper first.
pub const ALL: [Shipped; 9] = [
    Shipped {
        name: "differential-drive",
        text: include_str!("models/differential-drive.dcml"),
        about: "two driven wheels on one axle",
    },
    Shipped {
        name: "bart",
        text: include_str!("models/bart.dcml"),
        about: "two steered blocks of two driven wheels",
    },
    Shipped {
        name: "bicycle",
        text: include_str!("models/bicycle.dcml"),
        about: "a car",
    },
    Shipped {
        name: "trailer",
        text: include_str!("models/trailer.dcml"),
        about: "a car with a trailer",
    },
    Shipped {
        name: "unicycle",
        text: include_str!("models/unicycle.dcml"),
        about: "one wheel that rolls and turns",
    },
    Shipped {
        name: "mecanum",
        text: include_str!("models/mecanum.dcml"),
        about: "four wheels with rollers, to all sides",
    },
    Shipped {
        name: "dubins",
        text: include_str!("models/dubins.dcml"),
        about: "a car of one speed, ahead",
    },
    Shipped {
        name: "reeds-shepp",
        text: include_str!("models/reeds-shepp.dcml"),
        about: "a car of one speed, ahead and back",
    },
    Shipped {
        name: "dynamic-unicycle",
        text: include_str!("models/dynamic-unicycle.dcml"),
        about: "a unicycle under a force and a torque",
    },
];

/// The one with this name.
pub fn named(name: &str) -> Option<&'static Shipped> {
    ALL.iter().find(|one| one.name == name)
}

/// Those that a name which is none of them could mean: mistyped, one of its words, its beginning, the name of the model in
/// its text, a file `NAME.dcml`, or a word of what it is. In the order of [`ALL`].
pub fn like(name: &str) -> Vec<&'static Shipped> {
    let file = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let word = file.strip_suffix(".dcml").unwrap_or(file);
    let word = word.to_lowercase().replace(['_', ' '], "-");
    let is_near = |known: &str| nearest(&word, [known]).is_some();
    let is_like = |one: &&Shipped| {
        let is_part = word.len() >= LIKE_LETTERS
            && (one.name.starts_with(&word) || one.about.split([' ', ',']).any(|it| it == word));
        is_near(one.name) || is_part || one.name.split('-').any(is_near)
    };
    ALL.iter().filter(is_like).collect()
}

/// What to say of a name that is no file and no shipped model: `did you mean A or B?`, or which there are.
pub fn advice(name: &str) -> String {
    let names = |all: &[&Shipped]| -> Vec<&str> { all.iter().map(|one| one.name).collect() };
    let all: Vec<&Shipped> = ALL.iter().collect();
    match names(&like(name)).as_slice() {
        [] => format!("shipped models are {}", names(&all).join(", ")),
        [one] => format!("did you mean the shipped model {one}?"),
        [first @ .., last] => format!(
            "did you mean one of the shipped models {} and {last}?",
            first.join(", ")
        ),
    }
}

#[cfg(test)]
mod tests;
