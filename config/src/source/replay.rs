//! `replay{ path, speed, loop }`: bytes recorded with their timing.
//!
//! A recording is a file of the configuration and no device: it is looked for like an include.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::problem::Problem;
use std::path::{Path, PathBuf};

/// `replay{ path = 'run.rec', speed = 1, loop = false }`
///
/// Lines `TIME_MS HEX`, time from the start, not decreasing; `#` starts a comment.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayDescription {
    /// The recording, resolved like an include.
    pub path: PathBuf,
    /// Time factor, above 0.
    pub speed: f64,
    /// Start again at the end.
    pub repeat: bool,
}

impl Kind for ReplayDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "replay",
        keys: &["path", "speed", "loop"],
        read,
    }];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn each_path(&mut self, _take: &mut dyn FnMut(&mut PathBuf)) {}

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Stream
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<ReplayDescription, Problem> {
    let Some(value) = fields.get("path") else {
        return Err(fields.problem("src", "replay: path is missing"));
    };
    let name = fields.path_bytes("path", value)?;
    let path = fields.search.recording(name);
    let path = path.map_err(|reason| fields.problem("src", format!("replay: {reason}")))?;
    let speed = match fields.get("speed") {
        None => 1.0,
        Some(value) => fields.finite_value("speed", value)?,
    };
    if !(1e-3..=1e6).contains(&speed) {
        return Err(fields.problem(
            "src",
            format!("replay: speed must be from 0.001 to 1000000, not {speed}"),
        ));
    }
    let repeat = fields.boolean("loop")?.unwrap_or(false);
    Ok(ReplayDescription {
        path,
        speed,
        repeat,
    })
}
