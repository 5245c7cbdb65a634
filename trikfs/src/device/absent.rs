//! Something that this board does not have.
//!
//! Owns nothing: opening it gives the reason that the configuration tells.

use super::{Device, Kind, Sink, Surroundings};
use crate::errno::Error;
use config::description::AbsentDescription;

impl Kind for AbsentDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Err(Error::NoDevice(self.reason.clone()))
    }

    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Err(Error::NoDevice(self.reason.clone()))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }
}
