//! All blocks of the data-flow language: one table row for each, with its ports, its properties and its documentation.
//!
//! Owns the look-up by element name, the numbers of ports and the kinds of properties. Rows stand in `control`, `flow`,
//! `devices`, `shell` and `drawing`, in the order of the palette. Knows neither edges nor expressions.
//!
//! Names, numbers, places and defaults are those of the editor's metamodel `RobotsDataFlowMetamodel`; the Russian names of
//! blocks are ours, and so is the property `keep` of a wait.

mod control;
mod devices;
mod drawing;
mod flow;
mod former;
pub mod page;
mod shell;

#[cfg(test)]
mod tests;

pub(crate) use devices::LED_COLORS;
pub(crate) use drawing::{BACKGROUNDS, COLORS};
pub use former::{Former, SHAPE};
use lang_text::problem::Locale;

/// One type of block.
#[derive(Debug)]
pub struct Row {
    /// Element name in the save, as `DFFunctionBlock`.
    pub element: &'static str,
    /// The name that the editor shows, in English.
    pub shown: &'static str,
    /// The same in Russian.
    pub russian: &'static str,
    /// Width and height of its picture, in pixels.
    pub size: (u16, u16),
    /// Its ports; an edge names one by its place here.
    pub ports: &'static [Port],
    /// Its properties, in the order of the editor.
    pub properties: &'static [Property],
    /// What it does, for people.
    pub text: &'static str,
    /// What it does, for `lower`.
    pub does: Does,
}

/// A port of a block.
#[derive(Debug)]
pub struct Port {
    /// Its name, as `CF_IN`.
    pub name: &'static str,
    /// Which way tokens go.
    pub way: Direction,
    /// What it takes or gives.
    pub of: Kind,
    /// Its place on the picture, in pixels.
    pub at: (i16, i16),
}

/// Which way tokens of a port go.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Direction {
    /// Into the block.
    In,
    /// Out of the block.
    Out,
}

/// What tokens of a port are.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Kind {
    /// Units: control tokens, whose value does not matter.
    Unit,
    /// Truths.
    Truth,
    /// Whole numbers; a float is rounded.
    Whole,
    /// Texts.
    Text,
    /// Lists of any length.
    List,
    /// Lists of exactly so many items.
    Items(u8),
    /// Anything.
    Any,
}

/// A property of a block.
#[derive(Debug)]
pub struct Property {
    /// Its name in the save.
    pub name: &'static str,
    /// The name that the editor shows; its own name where the editor has no other.
    pub shown: &'static str,
    /// What its text is.
    pub content: Content,
    /// Its text in a new block.
    pub default: &'static str,
}

/// What the text of a property is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Content {
    /// An expression, or statements of which the last one is an expression.
    Expression,
    /// An expression that is asked for a truth.
    Truth,
    /// An expression that is asked for a whole number.
    Whole,
    /// Assignments, or names of variables divided by `;`.
    Variables,
    /// Text as it stands, or an expression of type text if the flag `Evaluate` is set.
    Evaluated,
    /// Text as it stands.
    Raw,
    /// A constant: a number, a truth, a text, or a list in brackets.
    Constant,
    /// A whole number as it stands.
    Number,
    /// `true` or `false`.
    Flag,
    /// One of these words, in any case and with spaces or without.
    Choice(&'static [&'static str]),
    /// The name of a sensor variable.
    Sensor,
    /// The name of a port.
    Port,
}

/// A figure that a block draws.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Shape {
    /// x, y.
    Pixel,
    /// x, y of both ends.
    Line,
    /// x, y, width, height.
    Rectangle,
    /// x, y, width, height of the rectangle around it.
    Ellipse,
    /// x, y, width, height of the rectangle around it, start, span.
    Arc,
}

/// What a block does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Does {
    /// Ends the program.
    Stop,
    /// Computes.
    Function,
    /// Sends a token one of two ways.
    If,
    /// Computes by conditions.
    Switch,
    /// Counts.
    Loop,
    /// Calls a subprogram.
    Call,
    /// Where tokens come into a subprogram.
    InPort,
    /// Where tokens leave it.
    OutPort,
    /// Gives a constant.
    Value,
    /// Assigns and gives a variable.
    Variable,
    /// Gives random numbers.
    Random,
    /// Lets through what comes seldom enough and meets a condition.
    Filter,
    /// Holds a token for a time.
    Wait,
    /// One stream replaces another one.
    Replace,
    /// One stream stops another one.
    Inhibit,
    /// Two streams to one of pairs.
    Zip,
    /// One stream of pairs to two.
    Unzip,
    /// Tells a port a number.
    WritePort,
    /// Gives the reading of a port.
    ReadPort,
    /// Gives the readings of a sensor.
    Sensor,
    /// Power of motors.
    Motors,
    /// Angles of servos.
    Servos,
    /// Encoders to a number, and their readings.
    Encoders,
    /// The light on the board.
    Led,
    /// What the gamepad does.
    Gamepad,
    /// Speech.
    Say,
    /// A sound file.
    Sound,
    /// A command of the system.
    System,
    /// Video on.
    Stream,
    /// A sensor of the camera on.
    StartCamera,
    /// Readings of a sensor of the camera.
    Detect,
    /// A message to another robot.
    Send,
    /// Messages of other robots.
    Receive,
    /// Text to the end of a file.
    WriteFile,
    /// A file as tokens.
    ReadFile,
    /// A file away.
    RemoveFile,
    /// The marker up or down.
    Pen,
    /// Colours and width of the pen.
    Paint,
    /// Text on the screen.
    Print,
    /// Everything from the screen.
    Clear,
    /// A face.
    Smile,
    /// A figure.
    Draw(Shape),
}

impl Row {
    /// The name that the editor shows.
    pub fn shown_in(&self, locale: Locale) -> &'static str {
        match locale {
            Locale::English => self.shown,
            Locale::Russian => self.russian,
        }
    }

    /// The property by its name in the save.
    pub fn property(&self, name: &str) -> Option<&'static Property> {
        self.properties.iter().find(|one| one.name == name)
    }

    /// The number of a port by its name.
    pub fn port(&self, name: &str) -> Option<u8> {
        let at = self.ports.iter().position(|port| port.name == name)?;
        u8::try_from(at).ok()
    }

    /// The number of the port for control tokens, if there is one.
    pub fn control(&self) -> Option<u8> {
        self.port(CONTROL_IN)
    }
}

impl Kind {
    /// Whether tokens of this kind carry a value.
    pub fn is_data(self) -> bool {
        match self {
            Self::Unit => false,
            Self::Truth | Self::Whole | Self::Text | Self::List | Self::Items(_) | Self::Any => {
                true
            }
        }
    }
}

/// The port that starts most blocks.
pub const CONTROL_IN: &str = "CF_IN";
/// The port on which most blocks say that they are done.
pub const CONTROL_OUT: &str = "CF_OUT";
/// The flag that makes a text an expression.
pub const EVALUATE: &str = "Evaluate";
/// Which port of the call a block *Input port* or *Output port* is.
pub const PORT_OF_CALL: &str = "identifier";
/// The flag that makes a block wait for all its inputs.
pub const SYNCHRONIZED: &str = "synch";

/// What blocks of the palette stand together for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Group {
    /// Blocks that compute and steer.
    Control,
    /// Blocks that arbitrate between streams.
    Streams,
    /// Motors, sensors and all else of the robot.
    Devices,
    /// Sound, system, camera, messages and files.
    Shell,
    /// What draws.
    Drawing,
}

/// All rows by their groups, in the order of the palette.
pub const GROUPS: [(Group, &[Row]); 5] = [
    (Group::Control, control::ROWS),
    (Group::Streams, flow::ROWS),
    (Group::Devices, devices::ROWS),
    (Group::Shell, shell::ROWS),
    (Group::Drawing, drawing::ROWS),
];

/// All rows, in the order of the palette.
pub fn table() -> impl Iterator<Item = &'static Row> {
    GROUPS.into_iter().flat_map(|(_, rows)| rows)
}

/// The row of an element name of the present version.
pub fn find(element: &str) -> Option<&'static Row> {
    table().find(|row| row.element == element)
}

/// The row of an element name of an older version, with how its ports were numbered; `shape` is its property [`SHAPE`].
pub fn find_former(element: &str, shape: Option<&str>) -> Option<(&'static Row, &'static Former)> {
    let is_shape = |wanted: &str| shape.is_some_and(|has| has.trim().eq_ignore_ascii_case(wanted));
    former::FORMER
        .iter()
        .find(|former| former.element == element && former.shape.is_none_or(is_shape))
        .and_then(|former| Some((find(former.now)?, former)))
}

/// Whether this is a block of an older version that drew any shape.
pub fn is_painter(element: &str) -> bool {
    former::PAINTERS.contains(&element)
}

/// Shapes that such a block drew, with the shown names of the blocks that draw them now.
pub fn painted() -> impl Iterator<Item = (&'static str, &'static Row)> {
    let rows = former::FORMER.iter();
    rows.filter_map(|former| Some((former.shape?, find(former.now)?)))
}

const fn port(name: &'static str, way: Direction, of: Kind, x: i16, y: i16) -> Port {
    Port {
        name,
        way,
        of,
        at: (x, y),
    }
}

const fn input(name: &'static str, of: Kind, x: i16, y: i16) -> Port {
    port(name, Direction::In, of, x, y)
}

const fn output(name: &'static str, of: Kind, x: i16, y: i16) -> Port {
    port(name, Direction::Out, of, x, y)
}

const fn control_in(x: i16, y: i16) -> Port {
    input(CONTROL_IN, Kind::Unit, x, y)
}

const fn control_out(x: i16, y: i16) -> Port {
    output(CONTROL_OUT, Kind::Unit, x, y)
}

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
