//! The limits of the queue.
//!
//! Owns all numbers of this crate that somebody could want to change.

use std::time::Duration;

/// Bytes of a submission. The server has a limit of its own, which is 1 MB unless somebody changes it.
pub const SUBMISSION_BYTES_MAX: usize = 16 << 20;
/// Bytes of a task, and of the name of a file, as those of Linux.
pub const NAME_BYTES_MAX: usize = 255;
/// How often a submission is taken before it is a dead letter.
pub const ATTEMPTS_MAX: i64 = 3;
/// How often a submission is given to workers that then say nothing of it.
pub const LOSSES_MAX: i64 = 5;
/// A worker that has said nothing for so long has lost its submission to another one.
pub const ACK_TIME: Duration = Duration::from_secs(20);
/// How often a worker says that it still works.
pub const BEAT_TIME: Duration = Duration::from_secs(5);
/// Until a submission that could not be judged is taken again, for each time that it was taken.
pub const AGAIN_TIME: Duration = Duration::from_secs(2);
/// How long a worker waits for submissions at once.
pub const FETCH_TIME: Duration = Duration::from_secs(5);
/// For the server's answer; then it is asked again.
pub const ANSWER_TIME: Duration = Duration::from_secs(5);
/// Between attempts to reach a server.
pub const REACH_TIME: Duration = Duration::from_secs(1);
/// How often the server is asked for what may have changed.
pub const LOOK_TIME: Duration = Duration::from_secs(2);
/// Results that are asked for each time.
pub const ASKED_MAX: usize = 200;
/// How often what waits for its result is handed in once more: the server can have lost it.
pub const PUT_AGAIN_TIME: Duration = Duration::from_secs(30);
/// Messages that nobody was given yet and that are looked at when one has harmed a connection, and bytes of all that are looked at.
pub const AHEAD_MAX: u64 = 1000;
/// Bytes of what is looked at without a pause.
pub const SWEPT_BYTES_MAX: usize = 64 << 20;
/// Dead letters that a person is shown.
pub const SHOWN_MAX: usize = 20;
/// How long anybody waits for results.
pub const PATIENCE_MAX: Duration = Duration::from_secs(30 * 24 * 3600);
/// Submissions that all workers together have at once.
pub const TAKEN_MAX: i64 = 10_000;
/// Bytes of a result: of all its runs together.
pub const RESULT_BYTES_MAX: usize = 900 << 10;
