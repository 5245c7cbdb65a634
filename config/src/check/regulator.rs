//! `regulator{ feedback = ..., actuator = ... }`: a node that holds what is written to it by driving another one.
//!
//! Owns what such a description needs beside its source: a control law, a pace, and a driven node with a rest.

use super::fields::Fields;
use super::source::is_read_only;
use crate::description::{
    NodeDescription, Pace, PartDescription, RegulatorDescription, SeveralDescription,
    SourceDescription,
};
use crate::format::Format;
use crate::problem::Problem;
use crate::value::{Table, Value};

impl<'a> Fields<'_, 'a> {
    /// Reads the constructor.
    pub(super) fn regulator(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("regulator", table, &["", "actuator", "feedback"])?;
            let Some(value) = fields.get("feedback") else {
                return Err(fields.problem("src", "regulator: feedback is missing"));
            };
            let source = fields.single(value)?;
            if !matches!(
                source,
                SourceDescription::Node(_) | SourceDescription::Newest(_)
            ) {
                return Err(fields.problem(
                    "src",
                    "regulator: feedback is another node: 'trikfs:NODE' or 'newest:NODE'",
                ));
            }
            let tuple_size = fields.size_of(&source)?.unwrap_or_default();
            let feedback = SeveralDescription {
                parts: vec![PartDescription {
                    name: "feedback".to_owned(),
                    source,
                    tuple_size,
                    is_trigger: true,
                }],
                ages: false,
                interval: true,
            };
            let actuator = match fields.get("actuator") {
                Some(Value::Text(text)) => String::from_utf8_lossy(text).into_owned(),
                Some(value) => {
                    return Err(fields.wrong_type("actuator", "a node: 'trikfs:NODE'", value));
                }
                None => return Err(fields.problem("src", "regulator: actuator is missing")),
            };
            let Some(actuator) = actuator.strip_prefix("trikfs:") else {
                return Err(
                    fields.problem("src", "regulator: actuator is another node: 'trikfs:NODE'")
                );
            };
            let driven = fields.driven(actuator)?;
            Ok(SourceDescription::Regulator(RegulatorDescription {
                feedback,
                actuator: actuator.to_owned(),
                actuator_tuple_size: driven,
            }))
        })
    }

    /// Bytes that a node takes when it is written, if it is something that can be driven.
    fn driven(&mut self, actuator: &str) -> Result<usize, Problem> {
        if self.checker.size_of_node(actuator, self.depth)?.is_none() {
            let hint = self.checker.nearest_node(actuator);
            return Err(self.problem("src", format!("there is no node '{actuator}'{hint}")));
        }
        let Some(description) = self.checker.built(actuator) else {
            return Err(self.problem("src", format!("there is no node '{actuator}'")));
        };
        let is_linked = matches!(description.source, SourceDescription::Node(_));
        let reason = if !is_linked && is_read_only(&description.source) {
            "it cannot be written"
        } else if description.rest.is_none() {
            "it has no rest, so nothing could stop it"
        } else {
            return Ok(description.written_tuple_size());
        };
        Err(self.problem(
            "src",
            format!("regulator: '{actuator}' cannot be driven: {reason}"),
        ))
    }

    /// What a regulator needs. It comes to rest with what it drives: its own rest is to hold nothing.
    pub(super) fn check_regulator(&self, node: &mut NodeDescription) -> Result<(), Problem> {
        if !matches!(node.source, SourceDescription::Regulator(_)) {
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
