//! A data-flow program ready to run: one node for each block of each instance of a diagram, and where its tokens go.
//!
//! Owns plain data and look-ups. Calls of subprograms are gone: a call's body is there once more for each call, and its
//! ports lead into it. Knows neither saves nor time.

use crate::blocks::{Row, Shape};
use crate::project::Policy;
use lang_diagram::ports::Port;
use lang_expr::reserved::SensorIndex;
use lang_expr::{Kit, Value, Wanted};
use lang_text::problem::{Place, Position};
use std::rc::Rc;

/// A node by its index.
pub type NodeId = u32;
/// An expression by its index in [`Program::formulas`].
pub type Formula = u32;

/// A whole program.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// All nodes: those of the main diagram in the order of its `children`, then those of each instance.
    pub nodes: Vec<Node>,
    /// All expressions.
    pub formulas: Vec<Text>,
    /// The main diagram, then the body of each call.
    pub instances: Vec<Instance>,
    /// Which names there are.
    pub kit: Kit,
}

/// A diagram that runs.
#[derive(Clone, Debug)]
pub struct Instance {
    /// The name of the diagram.
    pub name: Rc<str>,
    /// Index of the diagram in the project.
    pub diagram: u32,
    /// The node that calls it; `None`: the main diagram.
    pub caller: Option<NodeId>,
    /// Which nodes are its blocks.
    pub nodes: std::ops::Range<NodeId>,
    /// The blocks that a unit starts, in order, with their ports.
    pub starts: Vec<Target>,
    /// Its input ports, in order: which port of the call each shows.
    pub inputs: Vec<(u8, NodeId)>,
}

/// Where a token goes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Target {
    /// The node.
    pub node: NodeId,
    /// The number of its port.
    pub port: u8,
}

/// One block of one instance.
#[derive(Clone, Debug)]
pub struct Node {
    /// What it is.
    pub row: &'static Row,
    /// What it does.
    pub op: Op,
    /// Id of the block's graphical object.
    pub id: Rc<str>,
    /// Its caption.
    pub caption: Rc<str>,
    /// Which instance it is of.
    pub instance: u32,
    /// Its output that says that it is done, if it has one and an edge is there.
    pub done: Option<u8>,
    /// Where tokens go, by the number of the port.
    pub outs: Box<[Box<[Target]>]>,
    /// Inputs with at least one edge, as bits by the number of the port.
    pub linked: u16,
    /// Those of them that carry values.
    pub data: u16,
    /// Queues of the inputs, by the number of the port; only blocks that wait for several inputs have any.
    pub queues: Box<[Queue]>,
}

/// How many tokens wait at a port, and what comes then.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Queue {
    /// What comes when it is full.
    pub policy: Policy,
    /// Its places.
    pub capacity: u16,
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Text {
    /// As written.
    pub text: Rc<str>,
    /// What it is asked for.
    pub wanted: Wanted,
    /// The property that has it, by the name that the editor shows.
    pub property: &'static str,
    /// The node that it belongs to.
    pub node: NodeId,
    /// Names in it that are the node's own.
    pub own: &'static [&'static str],
}

/// A text of a block: as it stands, or computed.
#[derive(Clone, Debug)]
pub enum Words {
    /// As it stands.
    Plain(Rc<str>),
    /// Computed at each firing.
    Computed(Formula),
}

/// What a node does, with its properties.
#[derive(Clone, Debug)]
pub enum Op {
    /// It computes, steers, waits or arbitrates.
    Flow(Flow),
    /// It gives readings from its start on.
    Source(Source),
    /// It tells or asks a device something when a token comes.
    Act(Act),
}

/// A node that computes, steers, waits or arbitrates.
#[derive(Clone, Debug)]
pub enum Flow {
    /// Ends the program.
    Stop,
    /// Computes.
    Function {
        /// Whether it waits for a token at each linked input.
        waits: bool,
        /// The text of each output, where there is one.
        texts: [Option<Formula>; 6],
    },
    /// Sends a token one of two ways.
    If(Formula),
    /// Computes by conditions.
    Switch {
        /// Condition and value of each output.
        arms: [(Option<Formula>, Option<Formula>); 6],
        /// Whether the first condition that holds is the last one asked.
        first_only: bool,
    },
    /// Counts.
    Loop {
        /// First, last and step.
        bounds: [i32; 3],
        /// Time before each number.
        time_ms: u32,
    },
    /// A subprogram: which instance.
    Call(u32),
    /// Where tokens come into an instance.
    InPort,
    /// Where they leave it: the calling node and its port.
    OutPort(Option<Target>),
    /// Gives a constant.
    Constant(Value),
    /// Assigns and gives variables.
    Variable {
        /// The assignments, if there are any.
        run: Option<Formula>,
        /// The variables.
        names: Box<[Rc<str>]>,
    },
    /// Gives random numbers.
    Random {
        /// Lower and upper bound.
        bounds: [Formula; 2],
        /// The interval, if it repeats.
        every_ms: Option<u32>,
    },
    /// A gate.
    Filter {
        /// How long after the start nothing passes.
        quiet_ms: u32,
        /// What has to hold.
        condition: Formula,
        /// How many pass; below 0: all.
        count: i32,
        /// Shortest time between two that pass.
        pause_ms: u32,
    },
    /// Holds a token.
    Wait {
        /// For how long, in milliseconds.
        ms: i32,
        /// Whether what comes meanwhile waits its turn.
        keeps: bool,
    },
    /// A stream that another one replaces for a time.
    Replace(i32),
    /// A stream that another one stops for a time.
    Inhibit(i32),
    /// Two streams to pairs.
    Zip,
    /// Pairs to two streams.
    Unzip,
}

/// What a node does that waits for a token at each of its linked data inputs.
#[derive(Clone, Copy, Debug)]
pub enum Gathers<'a> {
    /// Computes its texts.
    Function(&'a [Option<Formula>; 6]),
    /// Tells its devices.
    Drive(&'a [(Port, i32); 4]),
    /// Makes a pair.
    Zip,
}

/// A node that gives readings from its start on.
#[derive(Clone, Debug)]
pub enum Source {
    /// Gives readings of a sensor.
    Sensor(SensorIndex),
    /// Readings of a sensor of the camera.
    Detect(Camera),
    /// Encoders: which a start makes 0.
    Encoders([(Port, bool); 4]),
    /// The gamepad.
    Gamepad,
    /// Messages of other robots.
    Receive,
}

/// A node that tells or asks a device something.
#[derive(Clone, Debug)]
pub enum Act {
    /// Tells a port a number.
    WritePort {
        /// Which one.
        port: Port,
        /// The number that a start gives it.
        value: i32,
    },
    /// Gives the reading of a port.
    ReadPort(Read),
    /// Power of motors or angles of servos.
    Drive {
        /// Whether it waits for a token at each linked input.
        waits: bool,
        /// The devices and what a start tells them.
        devices: [(Port, i32); 4],
    },
    /// The light.
    Led(&'static str),
    /// Speech.
    Say(Words),
    /// A sound file.
    Sound(Rc<str>),
    /// A command of the system.
    System {
        /// The command.
        command: Words,
        /// Whether it is a line of a program.
        code: bool,
    },
    /// Video on.
    Stream,
    /// A sensor of the camera on.
    StartCamera(Camera),
    /// A message to another robot.
    Send {
        /// To whom.
        number: i32,
        /// The message.
        message: Rc<str>,
    },
    /// Text to the end of a file.
    WriteFile {
        /// The file.
        file: Rc<str>,
        /// The text.
        text: Rc<str>,
    },
    /// A file as tokens.
    ReadFile {
        /// The file.
        file: Rc<str>,
        /// Words or lines.
        words: bool,
    },
    /// A file away.
    RemoveFile(Rc<str>),
    /// The marker.
    Pen {
        /// Its colour.
        color: Rc<str>,
        /// Whether a start lets it down.
        down: bool,
    },
    /// Colours and width of the pen.
    Paint {
        /// Colour of the pen.
        color: Rc<str>,
        /// Its width in pixels.
        width: i32,
        /// Colour behind everything.
        background: Rc<str>,
        /// Whether it is shown at once.
        redraw: bool,
    },
    /// Text on the screen.
    Print {
        /// The text.
        text: Words,
        /// x and y.
        at: [Formula; 2],
        /// Whether it is shown at once.
        redraw: bool,
        /// Whether a token at TEXT is an expression.
        computed: bool,
    },
    /// Everything from the screen.
    Clear,
    /// A face; whether a start draws a happy one.
    Smile(bool),
    /// A figure.
    Draw {
        /// Which one.
        shape: Shape,
        /// Its coordinates at a start.
        numbers: Box<[Formula]>,
        /// Whether it is filled.
        filled: bool,
        /// Whether it is shown at once.
        redraw: bool,
    },
}

/// What gives the reading of a port.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Read {
    /// A device.
    Device(Port),
    /// One number of a device that has several.
    Part(Port, u8),
    /// The power that a motor was told last.
    Told(Port),
}

impl Read {
    /// The port of what is read.
    pub fn port(self) -> Port {
        match self {
            Self::Device(port) | Self::Part(port, _) | Self::Told(port) => port,
        }
    }
}

/// A sensor of the camera.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Camera {
    /// A line.
    Line,
    /// An object.
    Object,
    /// A colour.
    Color,
}

impl Camera {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Line, Self::Object, Self::Color];

    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Object => "object",
            Self::Color => "color",
        }
    }

    /// The sensor of a word in any case.
    pub fn of(word: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|one| one.word().eq_ignore_ascii_case(word.trim()))
    }
}

impl From<Flow> for Op {
    fn from(flow: Flow) -> Self {
        Self::Flow(flow)
    }
}

impl From<Source> for Op {
    fn from(source: Source) -> Self {
        Self::Source(source)
    }
}

impl From<Act> for Op {
    fn from(act: Act) -> Self {
        Self::Act(act)
    }
}

impl Program {
    /// A node; a program has all that its edges name.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id as usize]
    }

    /// Where a node is, for a problem.
    pub fn place(&self, id: NodeId) -> Place {
        let node = self.node(id);
        let instance = &self.instances[node.instance as usize];
        Place {
            diagram: Some(instance.name.to_string()),
            object: Some(node.id.to_string()),
            block: Some(node.label()),
            ..Place::default()
        }
    }

    /// Where a property of a node is, or a place in its text.
    pub fn property_place(&self, id: NodeId, property: &str, at: Option<Position>) -> Place {
        Place {
            property: Some(property.to_owned()),
            position: at,
            ..self.place(id)
        }
    }

    /// All edges of a node: from which port, and where to.
    pub fn edges(&self, id: NodeId) -> impl Iterator<Item = (u8, Target)> {
        let outs = self.node(id).outs.iter().enumerate();
        outs.flat_map(|(port, targets)| {
            let port = u8::try_from(port).unwrap_or(u8::MAX);
            targets.iter().map(move |&target| (port, target))
        })
    }
}

impl Node {
    /// The block in words: what it is, and its caption if that says something else.
    pub fn label(&self) -> String {
        label(self.row.shown, &self.caption)
    }

    /// Whether a port has an edge.
    pub fn is_linked(&self, port: u8) -> bool {
        self.linked & (1 << port) != 0
    }

    /// The name of a port.
    pub fn port_name(&self, port: u8) -> &'static str {
        self.row
            .ports
            .get(usize::from(port))
            .map_or("?", |port| port.name)
    }
}

/// A block in words: what it is, and its caption if that says something else.
pub(crate) fn label(shown: &str, caption: &str) -> String {
    if caption.is_empty() || caption == shown {
        shown.to_owned()
    } else {
        format!("{shown} '{caption}'")
    }
}
