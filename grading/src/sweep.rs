//! What no worker can be given is put aside before it harms another one.
//!
//! Anyone who publishes can give a message a header at which clients drop their connection, or which they take for the server's own
//! words: such a message never reaches a worker, comes again without end, and takes those beside it along. Here it is looked for in
//! what the server keeps. Owns how far was looked. What can be judged is not touched.

use crate::crew::{Crew, News};
use crate::error::Error;
use crate::limits::{AHEAD_MAX, SWEPT_BYTES_MAX};
use crate::queue::Queue;
use crate::submission::{Submission, id_of_rubbish};

/// How far was looked: messages do not change, so none is looked at twice.
#[derive(Debug, Default)]
pub(crate) struct Sweep {
    seen: u64,
    /// A connection was lost since.
    was_lost: bool,
}

impl Sweep {
    /// Looks at what workers were given and have not done, and, if a connection was lost, at what comes next. Says whether something
    /// was put aside.
    ///
    /// # Errors
    /// The server does not answer: what was not looked at is looked at the next time.
    pub async fn run(&mut self, crew: &Crew, was_lost: bool) -> Result<bool, Error> {
        let queue: &Queue = &crew.queue;
        if was_lost {
            // The stream may be another one.
            *self = Self {
                seen: 0,
                was_lost: true,
            };
        }
        let given = queue.given().await?;
        self.seen = self.seen.max(given.done);
        let (mut ahead, mut bytes, mut found) = (0, 0, false);
        let ahead_max = if self.was_lost { AHEAD_MAX } else { 0 };
        while bytes < SWEPT_BYTES_MAX {
            let Some(there) = queue.submission_from(self.seen + 1).await? else {
                break;
            };
            ahead += u64::from(there.sequence > given.last);
            if ahead > ahead_max {
                break;
            }
            bytes += there.bytes.len();
            if let Err(why) = Submission::kept(&there) {
                let id = id_of_rubbish(&there.subject, &there.bytes);
                let why = why.to_string();
                crew.tell_dead(&id, None, there.bytes, &why, &[]).await?;
                queue.drop_submission(there.sequence).await?;
                (crew.news)(News::Dead(id, None, why));
                found = true;
            }
            self.seen = there.sequence;
        }
        self.was_lost = false;
        Ok(found)
    }
}
