//! Notices that the guardian stands still (SIGSTOP): then nobody would bring motors to rest after this process.
//!
//! Owns the looks at it. A process hears of stops of its children alone, so a parent has to be looked at. What to do is known
//! here as well: everything comes to rest, and the guardian goes on.

use crate::program::kill;
use crate::program::{Command, Programs};
use crate::{limits, log};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::rc::Rc;
use std::time::Duration;
use tokio::time::{MissedTickBehavior, interval};

/// Who a stop is told to be by.
const WHO: &str = "trikd, whose guardian stood still";

/// Looks after the guardian for ever. While it stands still nothing moves.
pub async fn watch(guardian: Pid, programs: Rc<Programs>) {
    let mut looks = interval(Duration::from_millis(limits::GUARDIAN_LOOK_MS));
    looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        looks.tick().await;
        if kill::stands_still(guardian) {
            tracing::error!(
                target: log::DAEMON,
                "the guardian was stopped (SIGSTOP): motors are brought to rest, and it is continued"
            );
            programs.send(Command::Stop(WHO)).await;
            // One that is gone is noticed by its signal.
            let _ = kill(guardian, Signal::SIGCONT);
        }
    }
}
