//! Every limit of the tool, and nothing else.

/// Robots of one user that run side by side.
pub const ROBOTS_MAX: usize = 32;
/// Slowest and fastest course of simulated time: far below nothing moves, far above the threads cannot follow.
pub const SPEED_MIN: f64 = 0.1;
/// See [`SPEED_MIN`].
pub const SPEED_MAX: f64 = 20.0;
/// How often the view is drawn anew, or what was said is told.
pub const VIEW_MS: u16 = 100;
/// Characters of what the loudspeaker gave that a line tells: they fit into a pipe that has any room.
pub const SOUND_CHARS_MAX: usize = 500;
/// Time for the tree to be there.
pub const START_MS: u32 = 60_000;
/// Time for the tree to end after it was asked to, before it is forced.
pub const STOP_MS: u32 = 8_000;
/// Time for a daemon that has lost its guardian to clean up, before the board goes.
pub const ORPHAN_MS: u32 = 8_000;
/// Longest line that is passed on from the processes of the tree.
pub const LINE_BYTES_MAX: usize = 16 << 10;
/// Bytes of a record of a running robot.
pub const RECORD_BYTES_MAX: u64 = 16 << 10;
/// Longest path of a directory for robots: names of sockets below it end at 107 bytes.
pub const BASE_BYTES_MAX: usize = 64;
/// How often a tree is started again whose guardian was killed.
pub const RESTARTS_MAX: usize = 5;
