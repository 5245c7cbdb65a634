//! Every limit of the contract between the filesystem and native converters.
//!
//! Owns the numbers only; `include/trikfs_converter.h` states the same ones in prose and `abi.rs` enforces them.

/// Bytes of one tuple, before or after a converter.
pub const TUPLE_BYTES_MAX: usize = 64 << 10;
/// Converters in one library.
pub const CONVERTERS_MAX: usize = 256;
/// Bytes of a converter's or a parameter's name, without the terminating zero.
pub const NAME_BYTES_MAX: usize = 64;
/// Bytes of any other text that crosses the boundary (description, fault, log line); the rest is cut.
pub const TEXT_BYTES_MAX: usize = 1024;
/// Parameters given to one converter at open.
pub const PARAMS_MAX: usize = 1024;
/// Bytes of a file of vectors.
pub const VECTORS_BYTES_MAX: usize = 1 << 20;
/// Tuples of one trial with random bytes.
pub const TRIAL_TUPLES_MAX: usize = 1_000_000;
/// Reasons of refusals that a trial tells apart.
pub const TRIAL_REASONS_MAX: usize = 16;
