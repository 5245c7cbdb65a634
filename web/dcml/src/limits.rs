//! Every limit of this crate.

/// Bytes of options of one request.
pub const OPTIONS_BYTES_MAX: usize = 64 << 10;
/// Rows of a solution.
pub const ROWS_MAX: usize = 10_000;
/// Numbers in all rows of a solution.
pub const NUMBERS_MAX: usize = 1 << 20;
/// Steps of a solution.
pub const STEPS_MAX: usize = 1_000_000;
/// Models that a failure names.
pub const NAMES_MAX: usize = 20;
