//! Every limit of the filters that is not a limit of one parameter.

/// Bytes of state of one open file, as much as a Lua converter gets by default.
pub const STATE_BYTES_MAX: usize = 1 << 20;
