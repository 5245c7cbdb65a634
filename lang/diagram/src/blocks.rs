//! All blocks: one table row for each, with its properties, its documentation and what it does.
//!
//! Owns the look-up by type name and the kinds of properties. Rows stand in `core`, `actions`, `waits` and `drawing`; names in
//! Russian in `words`; blocks of other kits, which are only known by name, in `foreign`. Knows neither links nor expressions:
//! it says that a text is an expression, and `lower` asks for its meaning.
//!
//! Names, defaults and choices are those of the editor's metamodels (`robotsMetamodel`, `trikMetamodel`).

pub mod act;
mod actions;
mod core;
mod drawing;
pub mod foreign;
pub mod page;
mod waits;
pub mod words;

#[cfg(test)]
mod tests;

use super::ports::Kit;
pub use act::Act;

/// One type of block.
#[derive(Debug)]
pub struct Row {
    /// Type name in the save, as `TrikV6EnginesForward`.
    pub kind: &'static str,
    /// The name that the editor shows, in English.
    pub shown: &'static str,
    /// Where the editor's palette has it.
    pub category: Category,
    /// Which kits have it.
    pub kits: Kits,
    /// Where it does nothing, as in the original.
    pub silent: Silent,
    /// Its properties, in the order of the editor.
    pub properties: &'static [Property],
    /// What it does, for people.
    pub text: &'static str,
    /// What it does, for `lower`.
    pub does: Does,
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

/// What a block does, as far as the table knows.
#[derive(Clone, Copy, Debug)]
pub enum Does {
    /// The program or subprogram begins here.
    Start,
    /// The present diagram ends here.
    End,
    /// A note for people.
    Comment,
    /// Nothing: two branches meet.
    Merge,
    /// Runs statements.
    Statements,
    /// Assigns a value.
    Assign,
    /// Assigns a random number.
    Random,
    /// Asks a person.
    Ask,
    /// Takes one of two branches.
    If,
    /// Takes one of many branches.
    Switch,
    /// A loop with a counter.
    Loop,
    /// A loop with a condition.
    While,
    /// Begins threads.
    Fork,
    /// Threads meet.
    Join,
    /// Ends a thread.
    Kill,
    /// Sends to a thread.
    Send,
    /// Receives from a thread.
    Receive,
    /// Runs another diagram.
    Call,
    /// Waits for some time.
    Timer,
    /// Waits for any button.
    AnyButton,
    /// Waits for a message of another robot.
    Mail,
    /// Copies a sensor into a variable.
    Copy(Copied),
    /// Tells a device something and goes on.
    Act(&'static Act),
    /// Waits until a device says something.
    Watch(Watch),
}

/// What is copied into a variable.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Copied {
    /// Place of the line, the first number of `lineSensor`.
    Line,
    /// All distances of the lidar.
    Lidar,
}

/// What is waited for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Watch {
    /// A sensor against the expression in this property.
    Sensor(&'static str),
    /// An encoder against the expression in this property.
    Encoder(&'static str),
    /// The heading against the expression in this property.
    Gyroscope(&'static str),
    /// Acceleration along an axis against the expression in this property.
    Acceleration(&'static str),
    /// A touch sensor.
    Touch,
    /// The motion sensor.
    Motion,
    /// A button of the board.
    Button,
    /// A button of the gamepad.
    PadButton,
    /// A pad of the gamepad.
    Pad,
    /// The wheel of the gamepad against the expression in this property.
    Wheel(&'static str),
    /// A gamepad comes.
    Connected,
    /// The gamepad goes.
    Disconnected,
}

impl Row {
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

/// All rows, by category and in the order of the palette.
pub fn table() -> impl Iterator<Item = &'static Row> {
    [core::ROWS, actions::ROWS, waits::ROWS, drawing::ROWS]
        .into_iter()
        .flatten()
}

/// The row of a type name.
pub fn find(kind: &str) -> Option<&'static Row> {
    table().find(|row| row.kind == kind)
}

/// A property whose text is an expression.
const fn expression(
    name: &'static str,
    shown: &'static str,
    wanted: Type,
    default: &'static str,
) -> Property {
    Property {
        name,
        shown,
        content: Content::Expression(wanted),
        default,
    }
}

/// A property of another content.
const fn property(
    name: &'static str,
    shown: &'static str,
    content: Content,
    default: &'static str,
) -> Property {
    Property {
        name,
        shown,
        content,
        default,
    }
}

/// A flag.
const fn flag(name: &'static str, shown: &'static str, default: &'static str) -> Property {
    property(name, shown, Content::Flag, default)
}

/// A variable that is assigned to.
const fn variable(name: &'static str, default: &'static str) -> Property {
    property(name, "Variable", Content::Variable, default)
}

/// How a reading is compared.
const SIGN: Property = property("Sign", "Sign", Content::Choice(SIGNS), "greater");
const SIGNS: &[&str] = &["greater", "less", "notLess", "notGreater", "equals"];
/// The sign of blocks that send.
const ENVELOPE: &str = "<rect class=\"i\" x=\"-14\" y=\"-9\" width=\"28\" height=\"19\"/><path class=\"i\" d=\"M-14 -9L0 3L14 -9\"/>";
pub(crate) const REDRAW: Property = flag("Redraw", "Redraw", "true");
pub(crate) const EVALUATE: Property = flag("Evaluate", "Evaluate", "false");
const COLORS: &[&str] = &[
    "white",
    "black",
    "red",
    "darkRed",
    "green",
    "darkGreen",
    "blue",
    "darkBlue",
    "cyan",
    "darkCyan",
    "magenta",
    "darkMagenta",
    "yellow",
    "darkYellow",
    "gray",
    "darkGray",
    "lightGray",
];
