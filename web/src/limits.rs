//! Every limit of this crate. Saves, worlds, programs and runs have those of `lang` and `sim`.

/// Bytes of a world, of answers and of what a person does, together with the other options, as JSON.
pub const OPTIONS_BYTES_MAX: usize = 40 << 20;
/// Bytes of the name of a file.
pub const NAME_BYTES_MAX: usize = 4096;
/// Bytes of an order to a debugger, as a text of JavaScript may have them.
pub const ORDER_BYTES_MAX: usize = lang_diagram::limits::ORDER_BYTES_MAX;
/// Ticks of a run that one call makes: a minute of model time.
pub const TICKS_MAX: u32 = 6_000;
/// Moments and steps of the past that one call looks through, in pieces of a millisecond.
pub const SEARCHES_MAX: usize = 50;
/// Longest run, in seconds of model time.
pub const MODEL_SECONDS_MAX: f64 = 3600.0;
/// Longest run in one call, in seconds of real time.
pub const WALL_SECONDS_MAX: f64 = 3600.0;
/// Messages of a run that its outcome has; more are only counted.
pub const MESSAGES_MAX: usize = 1_000;
/// Characters of one of them.
pub const MESSAGE_CHARS_MAX: usize = 2_000;
/// Answers of a person.
pub const ANSWERS_MAX: usize = 10_000;
/// Numbers of the way of a robot that one answer has: milliseconds and pose of each tick, about a quarter of an hour.
pub const TRAIL_NUMBERS_MAX: usize = 4 * 100_000;
/// Greatest seed: what a number of JavaScript holds, and 32 bits.
pub const SEED_MAX: u32 = u32::MAX;
/// Blocks, links or places that one change names.
pub const CHANGED_MAX: usize = 20_000;
/// Bytes of a change as JSON: a world is the largest one.
pub const CHANGE_BYTES_MAX: usize = 40 << 20;
