//! `regulator{ feedback, actuator }`: what is written is held by driving another node.
//!
//! Owns what its parts can be. What its node needs beside the source (a control law, a pace) is checked with the node.

use super::SourceDescription;
use super::kind::{Constructor, Delivery, Kind, Nodes, size_of_node};
use super::rest::Rest;
use super::several::{PartDescription, SeveralDescription};
use crate::fields::Fields;
use crate::problem::Problem;
use crate::value::Value;
use std::path::{Path, PathBuf};

/// `regulator{ feedback = 'trikfs:encoder', actuator = 'trikfs:motor' }`
///
/// The converter makes the measured tuple of the feedback, and the write converter is the control law: at each sample it
/// takes what was ordered, what was measured and the time since the step before, and gives what the actuator is to do.
#[derive(Clone, Debug, PartialEq)]
pub struct RegulatorDescription {
    /// What is measured: one source, with the interval after it.
    pub feedback: SeveralDescription,
    /// Path of the driven node.
    pub actuator: String,
    /// Bytes of one tuple that the driven node takes.
    pub actuator_tuple_size: usize,
}

impl RegulatorDescription {
    /// Bytes that the control law takes: ordered, measured, interval.
    pub fn law_input_size(output_tuple_size: usize) -> usize {
        2 * output_tuple_size + size_of::<u32>()
    }
}

impl Kind for RegulatorDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "regulator",
        keys: &["actuator", "feedback"],
        read,
    }];
    const REST: Rest<Self> = Rest::NoDevice;

    fn each_path(&mut self, _take: &mut dyn FnMut(&mut PathBuf)) {}

    fn needed_paths(&self) -> Vec<&Path> {
        Vec::new()
    }

    fn delivery(&self, nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        self.feedback.delivery(nodes)
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(Some(self.feedback.tuple_size()))
    }

    fn nodes(&self) -> Vec<&str> {
        let mut nodes = self.feedback.nodes();
        nodes.push(&self.actuator);
        nodes
    }

    fn written_node(&self) -> Option<&str> {
        Some(&self.actuator)
    }

    fn law_output_size(&self) -> Option<usize> {
        Some(self.actuator_tuple_size)
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, nodes: &mut dyn Nodes) -> Result<RegulatorDescription, Problem> {
    let Some(value) = fields.get("feedback") else {
        return Err(fields.problem("src", "regulator: feedback is missing"));
    };
    let source = SourceDescription::read(value, fields, nodes)?;
    if source.linked_node().or(source.sampled_node()).is_none() {
        return Err(fields.problem(
            "src",
            "regulator: feedback is another node: 'trikfs:NODE' or 'newest:NODE'",
        ));
    }
    let tuple_size = source.known_tuple_size(fields, nodes)?.unwrap_or_default();
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
        return Err(fields.problem("src", "regulator: actuator is another node: 'trikfs:NODE'"));
    };
    let driven = driven(actuator, fields, nodes)?;
    Ok(RegulatorDescription {
        feedback,
        actuator: actuator.to_owned(),
        actuator_tuple_size: driven,
    })
}

/// Bytes that a node takes when it is written, if it is something that can be driven.
fn driven(actuator: &str, fields: &Fields<'_>, nodes: &mut dyn Nodes) -> Result<usize, Problem> {
    size_of_node(actuator, fields, nodes)?;
    nodes.driven_tuple_size(actuator).map_err(|reason| {
        let reason = format!("regulator: '{actuator}' cannot be driven: {reason}");
        fields.problem("src", reason)
    })
}
