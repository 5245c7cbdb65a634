//! Every limit of looking at a tree and of keeping what was seen.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Depth of directories below a mount point: groups of a configuration, and the nodes in them.
pub const TREE_DEPTH_MAX: usize = 17;
/// Nodes of a tree that are recorded.
pub const NODES_MAX: usize = 4096;
/// Bytes of a small text of the tree: a format of 1024 fields.
pub const TEXT_BYTES_MAX: u64 = 128 << 10;
/// Bytes of the numbers that bring a node to rest.
pub const REST_BYTES_MAX: usize = 4096;
/// Bytes of a configuration that goes with a recording.
pub const CONFIG_BYTES_MAX: u64 = 1 << 20;
/// How often the rings are looked at: they hold at least 3 samples, mostly 15.
pub const LOOK_MS: u16 = 5;
/// How often what was recorded is handed to the disk.
pub const FLUSH_MS: u32 = 1_000;
/// Batches of events that wait for the disk; a batch is what came in one look.
pub const BATCHES: usize = 1_024;
/// Bytes of events that wait for the disk.
pub const WAITING_BYTES: usize = 16 << 20;
/// The same for a black box, which goes on for as long as the robot runs.
pub const BOX_WAITING_BYTES: usize = 1 << 20;
/// Reads of 4 KiB that skip the lines of a log that are kept: 64 KiB, and some that come meanwhile.
pub const LOG_READS_MAX: usize = 32;
/// Bytes of one line of a log.
pub const LINE_BYTES_MAX: usize = 16 << 10;
/// Files of which a black box consists: what is thrown away at once is one part of so many.
pub const BOX_PARTS: u64 = 8;
/// Least bytes of one of them.
pub const BOX_PART_BYTES_MIN: u64 = 64 << 10;
/// Saved black boxes that are kept; the oldest goes first.
pub const BOX_SAVED: usize = 8;
/// Of these, for those that a person has asked for and has, so that they push out none that was saved by itself.
pub const BOX_ASKED: usize = 2;
/// Time between two savings that no person has asked for.
pub const BOX_AGAIN_MS: u64 = 30_000;
/// The same after a failure: a loose plug fails all the time.
pub const BOX_FAULT_AGAIN_MS: u64 = 300_000;
/// Patterns of one client.
pub const PATTERNS_MAX: usize = 64;
/// Bytes of one of them.
pub const PATTERN_BYTES_MAX: usize = 256;
/// Clients of live streams at once.
pub const STREAMS: usize = 32;
/// Those who hear what is seen, at once.
pub const LISTENERS: usize = 32;
/// Lines of others that wait until the next look.
pub const LINES: usize = 1_024;
/// Least time between two standard messages that are made of several nodes.
pub const STANDARD_PERIOD_NS: u64 = 10_000_000;
/// What was sampled so long ago is in no message of several nodes, and tells no speed.
pub const STANDARD_OLD_NS: u64 = 1_000_000_000;
/// Most time between the halves of one `Imu`: some samples of the slower one.
pub const IMU_APART_NS: u64 = 100_000_000;
/// Distances that are a scan; fewer are so many sensors.
pub const SCAN_NUMBERS_MIN: usize = 8;
/// How often it is looked whether the world around a virtual robot has told something.
pub const WORLD_MS: u64 = 50;
/// Bytes of what stands still in it, which goes with a recording as a file.
pub const WORLD_SCENE_BYTES_MAX: u64 = 256 << 10;
/// Bytes of what moves in it, which is one line.
pub const WORLD_PLACES_BYTES_MAX: u64 = 8 << 10;
/// Bytes of such lines in a second.
pub const WORLD_BYTES_PER_S: u64 = 20 << 10;
/// Bytes of a tuple of a source that is recorded as it was: no pictures.
pub const RAW_BYTES_MAX: usize = 64 << 10;
