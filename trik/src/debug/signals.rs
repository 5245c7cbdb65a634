//! Ctrl-C, and the ends of a terminal and a session, as something to read.
//!
//! Owns which signals a debugger in a terminal hears, and what each asks for.

use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};

/// Has this thread and those to come read these signals.
///
/// # Errors
/// The system has no room for it.
pub(super) fn interrupts() -> nix::Result<SignalFd> {
    let signals: SigSet = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP]
        .into_iter()
        .collect();
    signals.thread_block()?;
    SignalFd::with_flags(&signals, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)
}

/// What a signal asks for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Pressed {
    /// To stop the program.
    Interrupt,
    /// To leave.
    Leave,
}

/// What has come since the last time, if something has.
pub(super) fn pressed(keys: &SignalFd) -> Option<Pressed> {
    let info = keys.read_signal().ok()??;
    let is_interrupt = i32::try_from(info.ssi_signo) == Ok(Signal::SIGINT as i32);
    Some(match is_interrupt {
        true => Pressed::Interrupt,
        false => Pressed::Leave,
    })
}
