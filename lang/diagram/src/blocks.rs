//! All blocks: one table row for each, with its properties, its documentation and what it does.
//!
//! Owns the look-up by type name and the kinds of properties. Rows stand in `core`, `motors`, `actions`, `waits` and
//! `drawing`, in the order of the palette; blocks of other kits, which are only known by name, in `foreign`. Knows neither
//! links nor expressions: it says that a text is an expression, and `lower` asks for its meaning.
//!
//! Names, defaults and choices are those of the editor's metamodels (`robotsMetamodel`, `trikMetamodel`).

pub mod act;
mod actions;
pub mod choices;
mod core;
mod does;
mod drawing;
pub mod example;
pub mod foreign;
mod motors;
pub mod page;
mod parts;
pub mod wait;
mod waits;

#[cfg(test)]
mod tests;

use super::ports::Kit;
pub use act::Act;
pub use does::Does;
use example::Example;
use lang_expr::Wanted;
use lang_text::problem::{Locale, Words};
pub(crate) use parts::{EVALUATE, REDRAW};
pub use wait::Wait;

/// One type of block.
#[derive(Debug)]
pub struct Row {
    /// Type name in the save, as `TrikV6EnginesForward`.
    pub kind: &'static str,
    /// The name that the editor shows, in English.
    pub shown: &'static str,
    /// The same in Russian.
    pub russian: &'static str,
    /// Where the editor's palette has it.
    pub category: Category,
    /// Which kits have it.
    pub kits: Kits,
    /// Where it does nothing, as in the original.
    pub silent: Silent,
    /// Its properties, in the order of the editor.
    pub properties: &'static [Property],
    /// What it does, for people: in English and Russian.
    pub text: [&'static str; 2],
    /// Its picture: SVG within a square of 50 px around the origin.
    pub icon: &'static str,
    /// What it does, for `lower`.
    pub does: Does,
    /// Small programs that show what it does, for the tests.
    pub examples: &'static [Example],
}

/// A group of blocks.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Category {
    /// Order of execution, variables, threads.
    Algorithms,
    /// Motors, sound, files, messages.
    Actions,
    /// Blocks that wait.
    Wait,
    /// The screen and the marker.
    Drawing,
}

/// Which kits a block belongs to.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kits {
    /// All kits of TRIK.
    Both,
    /// The kit V6 only.
    V6,
    /// The kit V62 only.
    V62,
}

/// Where a block is passed through without doing anything.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Silent {
    /// Nowhere.
    Never,
    /// In the simulator.
    Simulated,
    /// In the simulator, unless its mailbox is switched on.
    WithoutMailbox,
    /// In the simulator, unless somebody has a gamepad there.
    WithoutGamepad,
    /// On a real robot that the editor drives.
    Real,
    /// In both.
    Always,
}

/// One property of a block.
#[derive(Debug)]
pub struct Property {
    /// Its name in the save.
    pub name: &'static str,
    /// The name that the editor shows, in English.
    pub shown: &'static str,
    /// The same in Russian.
    pub russian: &'static str,
    /// What its text is.
    pub content: Content,
    /// Its text in a new block.
    pub default: &'static str,
}

/// What the text of a property is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Content {
    /// An expression.
    Expression(Type),
    /// Text as it stands, or an expression of type text if the flag `Evaluate` is set.
    Evaluated,
    /// Text as it stands.
    Raw,
    /// The name of a variable, to which is assigned.
    Variable,
    /// Ports divided by commas, as they stand.
    Ports,
    /// A whole number as it stands; anything else counts as 0.
    Number,
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// The name of a port or button.
    Port(&'static [&'static str]),
}

/// What a block wants an expression to give.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Type {
    /// Nothing: statements.
    Statements,
    /// True or false.
    Truth,
    /// A whole number.
    Whole,
    /// A number.
    Number,
    /// A text.
    Text,
    /// A text for the screen, where numbers have at most six decimals.
    Printed,
    /// A list of texts.
    List,
}

impl Type {
    /// What an expression is asked for.
    pub(crate) fn wanted(self) -> Wanted {
        match self {
            Self::Statements => Wanted::Statements,
            Self::Truth => Wanted::Bool,
            Self::Whole => Wanted::Int,
            Self::Number => Wanted::Float,
            Self::Text | Self::Printed => Wanted::Text,
            Self::List => Wanted::List,
        }
    }
}

/// What is copied into a variable.
#[derive(Clone, Copy, Debug)]
pub struct Copied {
    /// The expression that the variable gets.
    pub value: &'static str,
    /// What has to be there for that.
    pub device: Option<Needed>,
}

/// A device that a block cannot do without.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    /// The port that has to answer.
    pub port: &'static str,
    /// What is said if it does not.
    pub absent: fn() -> Words,
}

impl Row {
    /// The name that the editor shows.
    pub fn shown_in(&self, locale: Locale) -> &'static str {
        match locale {
            Locale::English => self.shown,
            Locale::Russian => self.russian,
        }
    }

    /// What it does, in a language.
    pub fn text_in(&self, locale: Locale) -> &'static str {
        let [english, russian] = self.text;
        match locale {
            Locale::English => english,
            Locale::Russian => russian,
        }
    }

    /// A property that is known by its own name or by the one that the editor shows in English, as the editor shows it; the
    /// name itself if there is none.
    pub fn label<'a>(&self, name: &'a str, locale: Locale) -> &'a str {
        let mut all = self.properties.iter();
        let found = all.find(|one| one.name == name || one.shown == name);
        found.map_or(name, |property| property.shown_in(locale))
    }

    /// Whether it is there only to be drawn: programs in words and in other languages do not have it.
    pub fn is_mark(&self) -> bool {
        self.does.is_mark()
    }

    /// The property by its name in the save.
    pub fn property(&self, name: &str) -> Option<&'static Property> {
        self.properties
            .iter()
            .find(|property| property.name == name)
    }

    /// Whether a kit has this block.
    pub fn is_of(&self, kit: Kit) -> bool {
        match self.kits {
            Kits::Both => true,
            Kits::V6 => kit == Kit::V6,
            Kits::V62 => kit == Kit::V62,
        }
    }
}

impl Property {
    /// The name that the editor shows.
    pub fn shown_in(&self, locale: Locale) -> &'static str {
        match locale {
            Locale::English => self.shown,
            Locale::Russian => self.russian,
        }
    }
}

/// The row of a block by the name that a person sees in English.
pub fn find_shown(shown: &str) -> Option<&'static Row> {
    table().find(|row| row.shown == shown)
}

/// All rows, by category and in the order of the palette.
pub fn table() -> impl Iterator<Item = &'static Row> {
    let all = [
        core::ROWS,
        motors::ROWS,
        actions::ROWS,
        waits::ROWS,
        drawing::ROWS,
    ];
    all.into_iter().flatten()
}

/// The row of a type name.
pub fn find(kind: &str) -> Option<&'static Row> {
    table().find(|row| row.kind == kind)
}
