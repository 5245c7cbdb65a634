//! What streams, subjects and headers are called.
//!
//! Owns these names; other programs publish and read by them (docs/teacher/queue.md).

/// Submissions that are not judged: each goes when a worker has told its result.
pub const SUBMISSIONS: &str = "TRIK_GRADE";
/// A submission. The id follows.
pub const SUBMIT: &str = "trik.grade.submit.";
/// Results, one for each submission, for as long as somebody keeps them.
pub const RESULTS: &str = "TRIK_GRADE_RESULTS";
/// A result. The id follows.
pub const RESULT: &str = "trik.grade.result.";
/// Submissions that nobody could judge.
pub const DEAD_LETTERS: &str = "TRIK_GRADE_DEAD";
/// A dead letter. The id follows.
pub const DEAD: &str = "trik.grade.dead.";
/// All workers are one consumer, so that each submission goes to one of them.
pub const WORKERS: &str = "workers";

/// The header with the task.
pub const TASK: &str = "Trik-Task";
/// The header with the name of the file, whose ending tells what it is.
pub const FILE: &str = "Trik-File";
/// The header of a dead letter that says why it is one.
pub const WHY: &str = "Trik-Why";
