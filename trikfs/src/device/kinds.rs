//! The kind of a source, and what is asked of it.
//!
//! Owns the list of kinds, and nothing that one of them does.

use super::{Device, Drives, Kind, Positions, Sink, Surroundings};
use crate::errno::Error;
use config::description::SourceDescription;
use std::collections::BTreeSet;
use std::path::PathBuf;

fn kind(source: &SourceDescription) -> &dyn Kind {
    match source {
        SourceDescription::Path(source) => source,
        SourceDescription::Attribute(source) => source,
        SourceDescription::Fifo(source) => source,
        SourceDescription::Evdev(source) => source,
        SourceDescription::Iio(source) => source,
        SourceDescription::Pwm(source) => source,
        SourceDescription::Gpio(source) => source,
        SourceDescription::Lines(source) => source,
        SourceDescription::Packets(source) => source,
        SourceDescription::Fake(source) => source,
        SourceDescription::I2c(source) => source,
        SourceDescription::I2cBus(source) => source,
        SourceDescription::Absent(source) => source,
        SourceDescription::Replay(source) => source,
        SourceDescription::Played(source) => source,
        SourceDescription::Faulty(source) => source,
        SourceDescription::Node(source) => source,
        SourceDescription::Newest(source) => source,
        SourceDescription::Several(source) => source,
        SourceDescription::Program(source) => source,
        SourceDescription::Regulator(source) => source,
    }
}

/// Opens a source for reading. `tuple_size` is that of the source, for kinds that produce whole tuples.
pub fn open(
    source: &SourceDescription,
    tuple_size: usize,
    around: &Surroundings,
) -> Result<Device, Error> {
    kind(source).open(tuple_size, around)
}

/// Opens a source for writing.
pub fn open_sink(
    source: &SourceDescription,
    around: &Surroundings,
) -> Result<Box<dyn Sink>, Error> {
    kind(source).open_sink(around)
}

/// Whether all readers share one opening: the source gives each datum once or lets only one process in.
/// The kind of a plain path is looked up each time, because a device may appear later as something else.
pub fn is_shared(source: &SourceDescription) -> Result<bool, Error> {
    kind(source).is_shared()
}

/// Opens a source that has no tuples; None for all that have them.
pub fn open_positions(
    source: &SourceDescription,
    around: &Surroundings,
) -> Result<Option<Box<dyn Positions>>, Error> {
    kind(source).open_positions(around)
}

/// What moves when a source is written.
pub fn drives(source: &SourceDescription) -> Drives<'_> {
    kind(source).drives()
}

/// The buses whose transfers a source waits for, itself or through nodes that it reads or drives.
pub fn add_buses(source: &SourceDescription, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
    kind(source).add_buses(around, buses);
}
