//! Where a node's bytes come from and go to: the table of all kinds of sources.
//!
//! Owns the list of kinds and asks the one that a source has; what a kind is stands in its file below, in one place:
//! its description, the word and the keys of its constructor, sizes, paths, delivery, and how it comes to rest.
//! Opens nothing.

// A kind of source that is forgotten must not be another one in silence.
#![deny(clippy::wildcard_enum_match_arm)]

mod absent;
mod attribute;
mod command;
mod evdev;
mod fake;
mod faulty;
mod fifo;
mod gpio;
mod i2c;
mod i2c_bus;
mod iio;
pub(crate) mod kind;
mod lines;
mod newest;
mod node;
mod packets;
mod path;
mod played;
mod program;
mod pwm;
mod regulator;
mod replay;
pub mod rest;
mod several;

pub use absent::AbsentDescription;
pub use attribute::AttributeDescription;
pub use command::CommandDescription;
pub use evdev::{EvdevDescription, EvdevLayout};
pub use fake::FakeDescription;
pub use faulty::FaultyDescription;
pub use fifo::FifoDescription;
pub use gpio::{GpioDescription, GpioDirection};
pub use i2c::{I2cDescription, I2cTransfer};
pub use i2c_bus::I2cBusDescription;
pub use iio::IioDescription;
pub use lines::{AnswerDescription, LinesDescription};
pub use newest::NewestDescription;
pub use node::LinkDescription;
pub use packets::{ByteOrder, Checksum, LengthField, PacketsDescription};
pub use path::PathDescription;
pub use played::PlayedDescription;
pub use program::ProgramDescription;
pub use pwm::PwmDescription;
pub use regulator::RegulatorDescription;
pub use replay::ReplayDescription;
pub use several::{PartDescription, SeveralDescription};

use crate::fields::Fields;
use crate::problem::Problem;
use crate::value::Value;
use kind::{Delivery, Kind, Nodes};
use rest::{Bytes, Rest, Resting};
use std::path::{Path, PathBuf};

/// Makes the type of all sources, and what asks the kind of one.
macro_rules! kinds {
    ($($(#[$what:meta])* $kind:ident($description:ty),)+) => {
        /// What a node reads from and writes to.
        #[derive(Clone, Debug, PartialEq)]
        pub enum SourceDescription {
            $($(#[$what])* $kind($description),)+
        }

        /// Runs an expression on the description inside a source.
        macro_rules! ask {
            ($source:expr, $inside:ident => $answer:expr) => {
                match $source { $(SourceDescription::$kind($inside) => $answer,)+ }
            };
        }

        /// Whether a word of the sandbox makes a source.
        #[must_use]
        pub fn is_constructor(word: &[u8]) -> bool {
            false $(|| is_word_of::<$description>(word))+
        }

        /// All words of the sandbox that make a source.
        #[cfg(test)]
        fn constructors() -> Vec<&'static str> {
            let mut words = Vec::new();
            $(words.extend(<$description as Kind>::CONSTRUCTORS.iter().map(|made| made.word));)+
            words
        }

        /// What the constructor `word` made of the table that `fields` reads; None if there is no such constructor.
        fn construct(
            word: &str,
            fields: &Fields<'_>,
            nodes: &mut dyn Nodes,
        ) -> Option<Result<SourceDescription, Problem>> {
            $(if let Some(made) = made_by::<$description>(word, fields, nodes) {
                return Some(made.map(SourceDescription::$kind));
            })+
            None
        }

        const TAGS: &[Option<u8>] = &[$(<$description as Kind>::REST.tag(),)+];

        /// The device of a form.
        fn taken(tag: u8, bytes: &mut Bytes<'_>) -> Option<SourceDescription> {
            $(if let Rest::Device(form) = <$description as Kind>::REST && form.tag == tag {
                return (form.take)(bytes).map(SourceDescription::$kind);
            })+
            None
        }
    };
}

kinds! {
    /// A path of the system; what it is (regular file, character device, FIFO, terminal) is found out at open.
    Path(PathDescription),
    /// `attribute{ path }`: state, read afresh from offset 0, whatever the file's type says.
    Attribute(AttributeDescription),
    /// `fifo{ path }`: a named pipe, opened once and fanned out.
    Fifo(FifoDescription),
    /// `evdev{ path }`: input events decoded and grouped up to SYN_REPORT.
    Evdev(EvdevDescription),
    /// `iio{ ... }`: a sampled sensor.
    Iio(IioDescription),
    /// `pwm{ ... }`: pulses of a PWM channel, state.
    Pwm(PwmDescription),
    /// `gpio{ ... }`: one line, state.
    Gpio(GpioDescription),
    /// `lines{ ... }`, `pictures{ ... }`: lines of text of a sensor program, or its pictures.
    Lines(LinesDescription),
    /// `packets{ ... }`: packets of a serial line.
    Packets(PacketsDescription),
    /// `fake{ ... }`: bytes that the configuration itself holds.
    Fake(FakeDescription),
    /// `i2c{ ... }`: a register of a device on an I2C bus.
    I2c(I2cDescription),
    /// `i2c_bus{ ... }`: all registers of all devices on an I2C bus, chosen by the position in the file.
    I2cBus(I2cBusDescription),
    /// `absent{ reason }`: something that this board does not have; opening it tells why.
    Absent(AbsentDescription),
    /// `replay{ ... }`: bytes recorded with their timing.
    Replay(ReplayDescription),
    /// `played{ path, channel }`: a channel of a player that has the clock of a recording.
    Played(PlayedDescription),
    /// `faulty{ ... }`: another source that fails on purpose.
    Faulty(FaultyDescription),
    /// `src = 'trikfs:other'`: the converted tuples of another node.
    Node(LinkDescription),
    /// `src = 'newest:other'`: the newest sample of another node, which is taken by that node alone.
    Newest(NewestDescription),
    /// Several sources, one converter.
    Several(SeveralDescription),
    /// `program{ run = { ... } }`: each written text is the last argument of a program that is run for it.
    Program(ProgramDescription),
    /// `regulator{ feedback = ..., actuator = ... }`: what is written is held by driving another node.
    Regulator(RegulatorDescription),
}

const _: () = assert!(rest::are_different(TAGS), "two forms have the same number");

fn is_word_of<T: Kind>(word: &[u8]) -> bool {
    let mut all = T::CONSTRUCTORS.iter();
    all.any(|constructor| constructor.word.as_bytes() == word)
}

fn made_by<T: Kind>(
    word: &str,
    fields: &Fields<'_>,
    nodes: &mut dyn Nodes,
) -> Option<Result<T, Problem>> {
    let mut all = T::CONSTRUCTORS.iter();
    let constructor = all.find(|constructor| constructor.word == word)?;
    // The sandbox has written the word under the empty key.
    let keys: Vec<&str> = [""].iter().chain(constructor.keys).copied().collect();
    let known = fields.only(word, fields.table, &keys);
    Some(known.and_then(|()| (constructor.read)(fields, nodes)))
}

fn resting<'a, T: Kind>(source: &'a T) -> Resting<'a> {
    match T::REST {
        Rest::ReadOnly => Resting::ReadOnly,
        Rest::Absent => Resting::Absent,
        Rest::NoDevice => Resting::NoDevice,
        Rest::Node(path) => Resting::Node(path(source)),
        Rest::Within => Resting::Within,
        Rest::Device(_) if source.takes_writes() => Resting::Device,
        Rest::Device(_) => Resting::ReadOnly,
    }
}

fn put<T: Kind>(source: &T, out: &mut Vec<u8>) -> Option<()> {
    match T::REST {
        Rest::Device(form) => {
            out.push(form.tag);
            (form.put)(source, out)
        }
        Rest::ReadOnly | Rest::Absent | Rest::NoDevice | Rest::Node(_) | Rest::Within => None,
    }
}

impl SourceDescription {
    /// One source as the configuration wrote it: a path, another node, or what a constructor made.
    pub(crate) fn read<'a>(
        value: &'a Value,
        fields: &Fields<'a>,
        nodes: &mut dyn Nodes,
    ) -> Result<Self, Problem> {
        if let Value::Text(text) = value {
            let after = |prefix: &[u8]| {
                let other = text.strip_prefix(prefix)?;
                Some(String::from_utf8_lossy(other).into_owned())
            };
            if let Some(path) = after(b"trikfs:") {
                return Ok(Self::Node(LinkDescription { path }));
            }
            if let Some(path) = after(b"newest:") {
                return Ok(Self::Newest(NewestDescription { path }));
            }
            let path = fields.absolute("src", value)?;
            return Ok(Self::Path(PathDescription { path }));
        }
        let Some(table) = fields.table_of(value) else {
            return Err(fields.wrong_type("src", "a path, a source or a table of these", value));
        };
        let Some(Value::Text(word)) = table.get("") else {
            return Err(fields.problem(
                "src",
                "src is nested; sources of several stand side by side",
            ));
        };
        let made = construct(&String::from_utf8_lossy(word), &fields.inner(table), nodes);
        let unknown = || Err(fields.problem("src", "src is of an unknown kind"));
        fields.at("src", made.unwrap_or_else(unknown))
    }

    /// The source that others stand before.
    pub fn innermost(&self) -> &Self {
        let mut source = self;
        while let Self::Faulty(faulty) = source {
            source = &faulty.source;
        }
        source
    }

    /// Paths that must be there for it to work, the device itself first.
    pub fn needed_paths(&self) -> Vec<&Path> {
        ask!(self, source => source.needed_paths())
    }

    /// Paths of the nodes that it names.
    pub fn nodes(&self) -> Vec<&str> {
        ask!(self, source => source.nodes())
    }

    /// The node that a write to it goes to.
    pub fn written_node(&self) -> Option<&str> {
        ask!(self, source => source.written_node())
    }

    /// The node whose tuples it hands on, each of them.
    pub fn linked_node(&self) -> Option<&str> {
        ask!(self, source => source.linked_node())
    }

    /// The node whose newest sample it hands on.
    pub fn sampled_node(&self) -> Option<&str> {
        ask!(self, source => source.sampled_node())
    }

    /// The sources that stand side by side in it.
    pub(crate) fn several(&self) -> Option<&SeveralDescription> {
        if let Self::Several(several) = self {
            Some(several)
        } else {
            None
        }
    }

    /// Bytes of one tuple of the node that it drives, if its write converter is a control law.
    pub(crate) fn law_output_size(&self) -> Option<usize> {
        ask!(self, source => source.law_output_size())
    }

    /// How the line begins that is kept for readers who come later; of the innermost source.
    pub fn kept_answer(&self) -> Option<&str> {
        ask!(self.innermost(), source => source.kept_answer())
    }

    /// How an actuator behind it is brought to rest.
    pub fn resting(&self) -> Resting<'_> {
        ask!(self, source => resting(source))
    }

    /// Appends the form of the device that it is; None if it is none that takes writes, or does not fit.
    pub fn put(&self, out: &mut Vec<u8>) -> Option<()> {
        ask!(self, source => put(source, out))
    }

    /// A device from its form; None if the bytes do not begin with one.
    pub fn take(bytes: &mut Bytes<'_>) -> Option<Self> {
        taken(bytes.u8()?, bytes)
    }

    /// Shows every path of a device or its program.
    pub(crate) fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        ask!(self, source => source.each_path(take))
    }

    /// How tuples come out of it; `nodes` tells that of the nodes that it names.
    pub(crate) fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        ask!(self, source => source.delivery(nodes))
    }

    /// Whether a node writes to it without being asked to.
    pub(crate) fn takes_writes(&self) -> bool {
        ask!(self, source => source.takes_writes())
    }

    /// A read gives what was written last.
    pub(crate) fn keeps_what_is_written(&self) -> bool {
        ask!(self, source => source.keeps_what_is_written())
    }

    /// False if it only takes writes.
    pub(crate) fn gives_tuples(&self) -> bool {
        ask!(self, source => source.gives_tuples())
    }

    /// Bytes of one tuple, if the source knows.
    pub(crate) fn known_tuple_size(
        &self,
        fields: &Fields<'_>,
        nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        ask!(self, source => source.known_tuple_size(fields, nodes))
    }

    /// Refuses a size of tuples that it cannot have.
    pub(crate) fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
        ask!(self, source => source.check_tuple_size(size, fields))
    }
}

#[cfg(test)]
mod tests;
