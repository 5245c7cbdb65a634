//! JavaScript. This build has no interpreter: programs are told so.

use crate::brick::Brick;
use crate::engine::{Engine, Outcome, Start};
use crate::host::Host;

/// Refuses every program with a reason.
#[derive(Debug, Default)]
pub struct Absent;

impl Engine for Absent {
    fn run(&mut self, _start: Start, _brick: &Brick, _host: &Host) -> Outcome {
        Err("this trikd was built without JavaScript: use Python".to_owned())
    }
}

/// The engine of this build.
pub fn engine() -> impl Engine {
    Absent
}
