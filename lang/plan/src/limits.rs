//! Every limit of this crate: how far a search for paths may grow.

/// Axes of the metric of a planner.
pub const PLAN_AXES_MAX: usize = 64;
/// States, outputs and actions of a model that is planned for.
pub const PLAN_NUMBERS_MAX: usize = 4096;
/// Steps for which a planner holds an action.
pub const PLAN_HOLD_MAX: u32 = 1_000_000;
/// Samples of one search.
pub const PLAN_ITERATIONS_MAX: u64 = 4_000_000_000;
/// Places of one search.
pub const PLAN_NODES_MAX: usize = 4_000_000;
/// Numbers of all places of one search: 8 bytes each.
pub const PLAN_MEMORY_NUMBERS: usize = 128 << 20;
/// Samples between two reports of progress.
pub const PLAN_REPORT_EVERY: u64 = 64;
/// Poses of a goal that are looked at before it is refused.
pub const PLAN_GOAL_TRIES: u32 = 4096;
/// Obstacles of one plan.
pub const PLAN_OBSTACLES_MAX: usize = 1_000_000;
/// Corners of all obstacles of one plan.
pub const PLAN_CORNERS_MAX: usize = 4_000_000;
/// Bytes of a text with obstacles.
pub const PLAN_OBSTACLES_TEXT_MAX: usize = 128 << 20;
/// Coordinates of obstacles go so far from zero.
pub const PLAN_COORDINATE_MAX: f64 = 1e9;
/// Poses between two steps of a solver; a robot that moves further than so many resolutions is refused.
pub const PLAN_SWEEP_STEPS_MAX: u32 = 100_000;

/// Rigid links of a robot.
pub const PLAN_LINKS_MAX: usize = 16;
/// Bodies of a robot that each have a footprint.
pub const PLAN_BODIES_MAX: usize = 64;
/// Rounds of Newton's method in which an action is bent to keep the links.
pub const PLAN_LINK_ROUNDS: u32 = 3;
