//! `regulator{ feedback = ..., actuator = ... }`: a node that holds what is written to it by driving another one.
//!
//! Owns what such a description needs beside its source: a control law, a pace, and a driven node with a rest.

use super::fields::NodeFields;
use crate::description::{NodeDescription, Pace};
use crate::format::Format;
use crate::problem::Problem;

impl NodeFields<'_, '_> {
    /// What a regulator needs. It comes to rest with what it drives: its own rest is to hold nothing.
    pub(super) fn check_regulator(&self, node: &mut NodeDescription) -> Result<(), Problem> {
        if node.source.law_output_size().is_none() {
            return Ok(());
        }
        if !matches!(node.pace, Pace::Every { .. }) {
            return Err(self.problem(
                "poll_ms",
                "a regulator works by the clock: give poll_ms, the time between its steps",
            ));
        }
        if node.write_converter.is_none() {
            return Err(self.problem(
                "write_converter",
                "a regulator needs a write_converter: the control law from ordered, measured and interval to what the actuator is to do",
            ));
        }
        if node.rest.is_some() {
            return Err(self.problem(
                "rest",
                "a regulator has no rest of its own: it comes to rest with what it drives",
            ));
        }
        let numbers = node
            .format
            .as_ref()
            .map_or(node.output_tuple_size, Format::len);
        node.rest = Some(vec![0.0; numbers]);
        Ok(())
    }
}
