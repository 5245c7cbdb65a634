//! A configuration after all checks: plain typed values that the filesystem builds its tree from.
//!
//! Owns the meaning of each field of a node's description. Knows nothing of Lua and opens nothing.

pub use crate::place::Place;
pub use crate::source::*;

use crate::format::Format;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Everything that a configuration describes, in the order of the paths.
#[derive(Clone, Debug, Default)]
pub struct Config {
    /// All nodes, sorted by `path`; groups exist only as parts of the paths.
    pub nodes: Vec<NodeDescription>,
    /// The global `setup`: what is done once, in this order, when the configuration comes into force.
    pub setup: Vec<SetupAction>,
    /// Second names of nodes, sorted by path.
    pub aliases: Vec<Alias>,
}

/// `{ alias = 'motors/M1' }`: the same node, with all its files, at a second place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alias {
    /// Where the second directory is.
    pub path: String,
    /// Path of the node.
    pub node: String,
}

/// One node of the tree.
#[derive(Clone, Debug)]
pub struct NodeDescription {
    /// Path below the mount point without a leading slash, for example `motors/M1`.
    /// For an attribute, the node's path followed by the attribute's name.
    pub path: String,
    /// Where the description stands, for messages.
    pub place: Place,
    /// Where bytes come from and go to.
    pub source: SourceDescription,
    /// Bytes of one tuple before the converter; for several sources, their sum.
    pub input_tuple_size: usize,
    /// Bytes of one tuple after the converter.
    pub output_tuple_size: usize,
    /// Stages from device to program; empty means the bytes pass unchanged.
    pub converter: Vec<StageDescription>,
    /// Stages from program to device when they differ from `converter`; then a written tuple has
    /// `output_tuple_size` bytes and the device gets `input_tuple_size`.
    pub write_converter: Option<Vec<StageDescription>>,
    /// Named fields of the converted tuple.
    pub format: Option<Format>,
    /// What the node is, in a few words, for tables and people; empty when none was given.
    pub about: String,
    /// Physical unit as the user wrote it; empty when none was given.
    pub units: String,
    /// When samples are taken.
    pub pace: Pace,
    /// The age in ms from which a sample that was taken in the background is an error; absent: as the pace has it.
    pub max_age_ms: Option<u32>,
    /// Permission bits (0o777 at most).
    pub mode: u16,
    /// Owner of the files; the mounting user when absent.
    pub owner: Option<u32>,
    /// Group of the files; the mounting user's when absent.
    pub group: Option<u32>,
    /// Values that bring the actuator to rest, written like the text of `value`.
    pub rest: Option<Vec<f64>>,
    /// A read shows the tuple that was written last while the device has the bytes that it became.
    pub read_back: bool,
    /// How long a reader of the newest value waits for the first one.
    pub timeout_ms: u32,
    /// Time that one converter call may take.
    pub budget_us: u32,
    /// Memory that one open file's Lua state may take.
    pub memory_kb: u32,
    /// Numbers that a converter can read as `params` (Lua) or at open (native).
    pub params: BTreeMap<String, f64>,
    /// Least and greatest value of those params that have a range.
    pub param_ranges: BTreeMap<String, (f64, f64)>,
    /// Further files of the node's directory; each has its own source and converter.
    pub attributes: Vec<NodeDescription>,
    /// `share` as written; absent means "by kind of source".
    pub share: Option<bool>,
    /// Whether its shared libraries and inline C run in a process of their own.
    pub isolate: bool,
    /// Whether the sample bus has what the source gives before it is converted, too.
    pub raw: bool,
    /// Equal for equal descriptions: plain fields, stripped bytecode, upvalues (attributes excluded, they have their own).
    pub fingerprint: u128,
}

impl NodeDescription {
    /// True if any stage of either direction is a Lua function.
    pub fn uses_lua(&self) -> bool {
        self.stages().any(|stage| !stage.kind.is_machine_code())
    }

    /// True if any stage of either direction is a shared library or inline C.
    pub fn uses_machine_code(&self) -> bool {
        self.stages().any(|stage| stage.kind.is_machine_code())
    }

    fn stages(&self) -> impl Iterator<Item = &StageDescription> {
        let write = self.write_converter.iter().flatten();
        self.converter.iter().chain(write)
    }

    /// Bytes of a tuple before and after the conversion in the direction of writing.
    pub fn write_conversion_sizes(&self) -> (usize, usize) {
        match self.source.law_output_size() {
            Some(driven) => {
                let taken = RegulatorDescription::law_input_size(self.output_tuple_size);
                (taken, driven)
            }
            None if self.write_converter.is_some() => {
                (self.output_tuple_size, self.input_tuple_size)
            }
            None => (self.input_tuple_size, self.output_tuple_size),
        }
    }

    /// Bytes of one tuple that a program writes.
    pub fn written_tuple_size(&self) -> usize {
        if self.write_converter.is_some() {
            self.output_tuple_size
        } else {
            self.input_tuple_size
        }
    }
}

/// When a node takes samples for its newest-value files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// When somebody reads.
    OnRead,
    /// In the background, every so many milliseconds (at least 1).
    Every {
        /// Sampling period.
        period_ms: u32,
        /// Whether anybody needs the samples or not.
        always: bool,
    },
    /// In the background, whenever the source has data.
    OnEvent,
}

/// One entry of the global `setup`.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupAction {
    /// Where it stands, for messages.
    pub place: Place,
    /// What to do.
    pub step: SetupStep,
    /// Nothing is done if this path exists.
    pub unless: Option<PathBuf>,
    /// How long it may take.
    pub timeout_ms: u32,
}

/// What one action of `setup` does.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupStep {
    /// `{ path = ..., write = ... }`: one write(2) to a file that exists.
    Write {
        /// Usually an attribute of sysfs.
        path: PathBuf,
        /// What is written.
        bytes: Vec<u8>,
    },
    /// `{ run = { '/sbin/modprobe', 'hcsr04' } }`: a program that must end with 0.
    Run {
        /// Absolute path of the program.
        program: PathBuf,
        /// Its arguments.
        arguments: Vec<String>,
    },
    /// `{ to = i2c{ ... }, write = ... }`: one tuple to a source that takes writes.
    Send {
        /// Where to.
        to: SourceDescription,
        /// The tuple.
        bytes: Vec<u8>,
    },
}

/// One stage of a chain of converters.
#[derive(Clone, Debug, PartialEq)]
pub struct StageDescription {
    /// Code of the stage.
    pub kind: StageKind,
    /// Bytes of the tuple it takes.
    pub input_size: usize,
    /// Bytes of the tuple it gives.
    pub output_size: usize,
    /// Where it stands, for messages.
    pub place: Place,
}

/// The code of one stage.
#[derive(Clone, Debug, PartialEq)]
pub enum StageKind {
    /// A Lua function; found again in another state by node path, direction and position in the chain.
    Lua,
    /// A shared library.
    Library {
        /// Absolute path of a file that exists, or as written when `missing`.
        path: PathBuf,
        /// Converter inside a library of several; absent for a library with one.
        name: Option<String>,
    },
    /// C source compiled on this machine.
    InlineC {
        /// The source text.
        code: String,
    },
}

impl StageKind {
    /// Whether it is code of the processor, which nothing holds back but another process.
    pub fn is_machine_code(&self) -> bool {
        match self {
            Self::Lua => false,
            Self::Library { .. } | Self::InlineC { .. } => true,
        }
    }
}
