//! The sample bus of a build that has none: nothing is published, and nothing else changes.

use super::{BusError, Readers};
use crate::clock::Stamp;
use crate::errno::Error;
use config::description::{Alias, NodeDescription};
use std::path::Path;
use std::time::Duration;

/// No sample bus.
#[derive(Default)]
pub struct SampleBus;

/// No ring.
pub enum Ring {}

impl SampleBus {
    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn open(&self, _mountpoint: &Path, _readers: Readers) -> Result<(), BusError> {
        Ok(())
    }

    /// Does nothing.
    pub fn close(&self) {}

    /// Nothing.
    pub fn status_line(&self) -> String {
        String::new()
    }

    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn restore(&self) -> Result<bool, BusError> {
        Ok(false)
    }

    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn set_aliases(&self, _aliases: &[Alias]) -> Result<(), BusError> {
        Ok(())
    }

    /// None.
    ///
    /// # Errors
    /// None.
    pub fn ring(&self, _description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        Ok(None)
    }
}

impl SampleBus {
    /// None.
    ///
    /// # Errors
    /// None.
    pub fn ring_of_writes(&self, _description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        Ok(None)
    }
}

impl SampleBus {
    /// Does nothing.
    pub fn set_raw(&self, _has_raw: bool) {}

    /// None.
    ///
    /// # Errors
    /// None.
    pub fn ring_of_raw(&self, _description: &NodeDescription) -> Result<Option<Ring>, BusError> {
        Ok(None)
    }
}

impl Ring {
    /// Cannot be called.
    pub fn publish(&mut self, _stamp: Stamp, _tuple: &[u8]) {
        match *self {}
    }

    /// Cannot be called.
    pub fn fail(&mut self, _stamp: Stamp, _error: &Error) {
        match *self {}
    }

    /// Cannot be called.
    pub fn set_too_old(&mut self, _age: Duration) {
        match *self {}
    }
}

/// Does nothing.
pub fn remove_left(_mountpoint: &Path) {}
