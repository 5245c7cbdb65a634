//! The way to the queue, for all its commands.
//!
//! Owns what a person is told when the server is gone and back, and what becomes of errors.

use super::args::ServerArgs;
use crate::input::secret::password;
use crate::refusal::{Refusal, UNREADABLE, say};
use grading::{Queue, Settings, error};
use std::future::Future;

/// Does something with the queue.
///
/// # Errors
/// The server is not reached, or what is done says.
pub fn with<T, F: Future<Output = Result<T, Refusal>>>(
    args: &ServerArgs,
    command: &str,
    work: impl FnOnce(Queue) -> F,
) -> Result<T, Refusal> {
    let settings = settings(args, command)?;
    grading::run(async {
        let queue = Queue::open(&settings, told()).await?;
        work(queue).await
    })
}

/// What is said when the server is gone, and when it is back; it is there at first.
fn told() -> impl Fn(bool) + Send + Sync + 'static {
    let is_there = std::sync::atomic::AtomicBool::new(true);
    move |now| {
        let before = is_there.swap(now, std::sync::atomic::Ordering::AcqRel);
        match (before, now) {
            (true, false) => {
                say(&["trik: the connection to the server is lost; it is tried again".to_owned()])
            }
            (false, true) => say(&["trik: the connection to the server is back".to_owned()]),
            (true, true) | (false, false) => {}
        }
    }
}

fn settings(args: &ServerArgs, command: &str) -> Result<Settings, Refusal> {
    let login = match (&args.user, &args.password_file) {
        (Some(user), Some(file)) => Some((user.clone(), password(file)?)),
        (None, _) | (_, None) => None,
    };
    Ok(Settings {
        server: args.server.clone(),
        login,
        authority: args.ca.clone(),
        name: format!("trik {command}"),
    })
}

impl From<grading::Error> for Refusal {
    fn from(why: grading::Error) -> Self {
        let code = match why.blame() {
            error::Blame::Caller | error::Blame::Machine => crate::refusal::REFUSED,
            error::Blame::Server => UNREADABLE,
        };
        Self {
            code,
            ..Self::new(why.to_string())
        }
    }
}
