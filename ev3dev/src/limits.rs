//! Every limit of the view, and nothing else.

/// Longest text that one write to an attribute may be: a page, as in sysfs.
pub const WRITE_BYTES_MAX: usize = 4096;
/// Longest text that is read from a file of the tree.
pub const TREE_TEXT_BYTES_MAX: usize = 4096;
/// Open files of the view.
pub const OPEN_MAX: usize = 65_536;
/// Devices that the view ever shows, with those that are gone: their numbers are not used again.
pub const DEVICES_MAX: usize = 1024;
/// How often at most the tree is looked through for new devices.
pub const SCAN_MS: u64 = 500;
/// How long the kernel may keep a name or an attribute of a file.
pub const NAME_TTL_MS: u64 = 500;
/// Period of the loop of a motor that runs.
pub const LOOP_MS: u64 = 10;
/// How often a motor that cannot be reached is tried to be let go.
pub const RETRY_MS: u64 = 100;
/// How long the loop goes on after the speed of a motor at rest was read.
pub const OBSERVE_S: f64 = 0.3;
/// How long the encoder or the power of a motor may fail before it is stopped.
pub const LOST_S: f64 = 0.2;
/// Longest ramp.
pub const RAMP_MS_MAX: i32 = 60_000;
/// Longest ramp of a motor without an encoder.
pub const DC_RAMP_MS_MAX: i32 = 10_000;
/// Longest line of the serving process.
pub const LINE_BYTES_MAX: usize = 64;
/// How long the serving process may be stopped (SIGSTOP) before it is ended: nobody holds the motors that it drives.
pub const STOPPED_MS: u64 = 500;
/// How often the serving process looks whether the keeper stands still (SIGSTOP): nobody would clean up after this process.
pub const KEEPER_LOOK_MS: u64 = 400;
/// Time for the serving process to end after it was asked to, before it is forced.
pub const GRACE_MS: u64 = 2_000;
