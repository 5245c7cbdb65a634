//! Every limit of the daemon and every default that is a number.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Bytes of the name of a port.
pub const PORT_NAME_BYTES: usize = 32;
/// Bytes of one value of the tree: 360 distances of a lidar fit.
pub const VALUE_BYTES: usize = 4096;
/// Bytes of the count in front of a frame, with what stands before its colon.
pub const FRAME_HEADER_BYTES: usize = 1024;
/// Bytes of one frame on the control port: the greatest upload.
pub const CONTROL_FRAME_BYTES: usize = 16 << 20;
/// Bytes of one frame on the telemetry and mailbox ports.
pub const SMALL_FRAME_BYTES: usize = 64 << 10;
/// Bytes of one frame between the daemon and a program.
pub const CHANNEL_FRAME_BYTES: usize = 16 << 20;
/// Bytes of a buffer of frames that are kept when it is empty.
pub const FRAME_BUFFER_KEPT_BYTES: usize = 64 << 10;
