//! Every limit of the filters that is not a limit of one parameter.

/// Bytes of state of one open file, as much as a Lua converter gets by default.
pub const STATE_BYTES_MAX: usize = 1 << 20;
/// Values of the largest tuple of a filter with several inputs, without the time: nine inertial values.
pub const FUSED_INPUTS_MAX: usize = 9;
/// Values of the largest result of such a filter: a quaternion and three angles.
pub const FUSED_OUTPUTS_MAX: usize = 7;
/// Longest time between two tuples that is still bridged: what happened in a longer one is unknown.
pub const GAP_US_MAX: u32 = 1_000_000;
/// How long a sensor of direction may give nothing but zeros, as in free fall, before it counts as dead.
pub const SILENCE_US_MAX: u32 = 1_000_000;
/// Longest `period_ms`: one hour, as for `poll_ms`.
pub const PERIOD_MS_MAX: f64 = 3_600_000.0;
/// Largest gain, variance and other real parameter without a limit of its own.
pub const REAL_MAX: f64 = 1e9;
