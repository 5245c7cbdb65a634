//! The models that come with the language: texts of well-known robots, each with its source.
//!
//! Owns their names; what they mean is what their texts say.

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

#[cfg(test)]
mod tests;
