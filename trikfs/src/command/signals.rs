//! The signals of a program that is started: none is blocked.
//!
//! The daemon blocks those that end it in all its threads, and a program inherits that: a sensor that `stop` ends with
//! `kill` would go on for ever.

use nix::sys::signal::SigSet;
use std::io;
use std::os::unix::process::CommandExt;
use std::process::Command;

/// The program that this command starts begins with all signals unblocked.
pub(super) fn unblock(command: &mut Command) {
    let none = SigSet::empty();
    let unblock = move || none.thread_set_mask().map_err(io::Error::from);
    // SAFETY: between fork and exec only what is async-signal-safe may happen. `unblock` makes one such call,
    // pthread_sigmask(3), with a set that was made before; it allocates nothing, also for an error, and takes no lock.
    unsafe { command.pre_exec(unblock) };
}
