//! Every limit of frames.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

/// Bytes of the count in front of a frame, with what stands before its colon.
pub const HEADER_BYTES: usize = 1024;
/// Bytes of a buffer that are kept when it is empty.
pub const BUFFER_KEPT_BYTES: usize = 64 << 10;
/// Bytes of one frame on the control port: the greatest upload.
pub const CONTROL_BYTES: usize = 16 << 20;
