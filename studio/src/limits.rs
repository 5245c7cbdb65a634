//! Every limit of this crate. Saves, worlds and runs have those of `lang` and `sim`.

/// Calls to the robot in one tick of a judged world: who asks without waiting is charged a tick for so many.
pub const SCRIPT_CALLS: u32 = 100;
/// For how many calls it counts when a program computes until its engine looks up, which is every 10 000 jumps and calls.
pub const SCRIPT_LOOK_CALLS: u32 = 50;
/// Bytes of the files that a judged program has written; they are kept in memory.
pub const SCRIPT_FILES_BYTES: usize = 16 << 20;
/// Remarks about a judged program that are kept.
pub const SCRIPT_REMARKS: usize = 20;
/// Threads of a judged program whose lines are kept.
pub const SCRIPT_LINES: usize = 64;
/// Characters of the name of a thread or a file that are kept beside a line.
pub const SCRIPT_NAME_CHARS: usize = 100;
/// Events of the keys and the gamepad that wait for one thread of a judged program.
pub const SCRIPT_EVENTS: usize = 256;
/// Moment of the calendar at which judged programs begin, in milliseconds of the epoch: 2026-01-01, 00:00 UTC.
pub const SCRIPT_EPOCH_MS: u64 = 1_767_225_600_000;
/// Bytes of one message of a judged program in a process of its own.
pub const SCRIPT_FRAME_BYTES: usize = 1 << 20;
