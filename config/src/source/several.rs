//! Several sources of one node: the tuples stand one after the other, then their times.
//!
//! Owns the layout of what the one converter behind them gets. It is no constructor: the node says which sources, and
//! which of them make a tuple.

use super::SourceDescription;
use super::kind::{Constructor, Delivery, Kind};
use super::rest::Rest;
use std::path::{Path, PathBuf};

/// Several sources: the tuples stand one after the other in the order of the parts, then the ages, then the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct SeveralDescription {
    /// The sources, at least one.
    pub parts: Vec<PartDescription>,
    /// Behind the tuples stands, for each source, the age of its tuple in us as a little-endian u32, saturated.
    pub ages: bool,
    /// At the end stands the time since the tuple before in us as a little-endian u32, saturated; 0 in the first.
    pub interval: bool,
}

impl SeveralDescription {
    /// Bytes of one tuple of all sources with their times.
    pub fn tuple_size(&self) -> usize {
        let tuples: usize = self.parts.iter().map(|part| part.tuple_size).sum();
        let times = if self.ages { self.parts.len() } else { 0 } + usize::from(self.interval);
        tuples + times * size_of::<u32>()
    }
}

/// One of several sources.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDescription {
    /// Key in the table, or its position from 1.
    pub name: String,
    /// The source.
    pub source: SourceDescription,
    /// Bytes of one tuple of this source.
    pub tuple_size: usize,
    /// Its tuples make one of the node; false: only its newest is used when another source makes one.
    pub is_trigger: bool,
}

impl SeveralDescription {
    /// One stream makes a stream of all.
    pub(super) fn joint_delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        let mut all = Delivery::State;
        for part in &self.parts {
            match part.source.delivery(nodes) {
                Delivery::Stream => return Delivery::Stream,
                Delivery::Unknown => all = Delivery::Unknown,
                Delivery::State => {}
            }
        }
        all
    }
}

impl Kind for SeveralDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        for part in &mut self.parts {
            part.source.each_path(take);
        }
    }

    fn needed_paths(&self) -> Vec<&Path> {
        let parts = self.parts.iter();
        parts.flat_map(|part| part.source.needed_paths()).collect()
    }

    fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        self.joint_delivery(nodes)
    }

    fn nodes(&self) -> Vec<&str> {
        let parts = self.parts.iter();
        parts.flat_map(|part| part.source.nodes()).collect()
    }
}
