//! A world that a judge runs, as people see it, as JSON.
//!
//! Owns nothing of it: what there is to see is in `field` and `moving`, its names in `text`.

use super::{field, moving, text};
use crate::arena::{Arena, Robot};

/// What stands still. Each robot begins where it is now.
pub fn still(arena: &Arena) -> String {
    let start = arena.robots().first().map(moving::pose);
    text::scene(&field::scene(arena, start.unwrap_or_default()), &[])
}

/// What moves.
pub fn motion(arena: &Arena) -> String {
    text::moving(&moving::moving(arena), &text::Beside::default())
}

/// Where the middle of a robot is, in metres with x to the right and y up.
pub fn middle(robot: &Robot) -> (f64, f64) {
    let pose = moving::pose(robot);
    (pose.at.x, pose.at.y)
}
