//! A regulator as a source: what it measures.
//!
//! Owns nothing of the control itself, which is the business of `regulation`; written tuples do not come here.

use super::{Device, Drives, Kind, Surroundings};
use crate::errno::Error;
use config::description::RegulatorDescription;
use std::collections::BTreeSet;
use std::path::PathBuf;

impl Kind for RegulatorDescription {
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        self.feedback.open(tuple_size, around)
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }

    fn add_buses(&self, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        if let Ok(node) = around.link(&self.actuator) {
            node.add_buses(buses);
        }
        self.feedback.add_buses(around, buses);
    }

    fn drives(&self) -> Drives<'_> {
        Drives::Held(&self.actuator)
    }
}
