//! The guardian: a small process that mounts, starts the daemon, outlives it, and cleans up after it.
//!
//! Owns the order of things at the daemon's end, whatever ended it: actuators come to rest, cached values are taken
//! back, the mount goes. After a crash it starts the daemon again with the configuration that was in force.
//! It holds the connection to the kernel, so that the connection cannot end before that is done.
//! It serves no request, runs no converter and reads no configuration, so it has little to crash of.
//!
//! `ledger` is what both processes share (`actions` a part of it), `inherit` the daemon's side of it; `child` starts the
//! daemon, `watch` waits for its end, `mounted` knows our mount from others at the same place, `rest` stops the actuators;
//! `oversight` is how the daemon sees to it that this process is not stopped; `precedence` is for what must not be late.

// An end of the daemon, or a device to bring to rest, that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod actions;
mod child;
pub mod inherit;
pub mod ledger;
pub mod mounted;
pub mod oversight;
mod precedence;
pub mod rest;
mod watch;

use crate::failure::Failure;
use crate::limits::{self, FIRST_REST};
use crate::mount::{self, MountOptions};
use crate::sample_bus;
use crate::transport::native::invalidate_message;
use child::Child;
use ledger::Ledger;
use mounted::Mounted;
use precedence::{Hurry, Reserve, Spared};
use std::collections::VecDeque;
use std::ffi::OsString;
use std::os::fd::OwnedFd;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use watch::{End, LastMoment, Watch};

/// What to guard.
pub struct Plan {
    /// Where to mount.
    pub mountpoint: PathBuf,
    /// How to mount.
    pub mount: MountOptions,
    /// Options of the hidden subcommand `serve`, without those of [`inherit::Handover`] and the mount point.
    pub arguments: Vec<OsString>,
}

/// Mounts, runs the daemon until it is stopped, cleans up. `ready` is called with the number of nodes each time a
/// daemon serves, so a second call means that one has crashed.
///
/// Call it while the process has one thread: SIGTERM, SIGINT and SIGHUP are blocked and waited for from here on.
///
/// # Errors
/// Why the filesystem does not run; [`Failure::Reported`] if the daemon has printed the reason itself.
pub fn run(plan: &Plan, ready: &mut dyn FnMut(usize)) -> Result<(), Failure> {
    let own = |error: std::io::Error| Failure::system("guardian", error);
    let watch = Watch::new().map_err(own)?;
    let ledger = Ledger::create().map_err(own)?;
    let mut crashes = Crashes::default();
    loop {
        match serve_once(plan, &watch, &ledger, crashes.any(), ready)? {
            End::Stopped => return Ok(()),
            End::Failed => return Err(Failure::Reported),
            End::Crashed(how) => {
                if crashes.note(Instant::now()) {
                    return Err(Failure::Crashed(how));
                }
                complain(&format!("the daemon was {how}; starting it again"));
            }
        }
    }
}

/// One life of the daemon, from mounting to the end of the mount.
fn serve_once(
    plan: &Plan,
    watch: &Watch,
    ledger: &Ledger,
    again: bool,
    ready: &mut dyn FnMut(usize),
) -> Result<End, Failure> {
    let device = mount::mount(&plan.mountpoint, &plan.mount)?;
    let mounted = match Mounted::find(&plan.mountpoint) {
        Ok(mounted) => mounted,
        Err(error) => {
            drop(device);
            let _ = mount::unmount(&plan.mountpoint);
            return Err(error.into());
        }
    };
    let child = Child::start(&device, ledger, &mounted, &plan.arguments, again);
    // The daemon itself has the priorities that this process was started with.
    let precedence = (Hurry::begin(), Spared::begin());
    let reserve = Reserve::new();
    let end = child.and_then(|mut child| {
        let last_moment = LastMoment {
            rest: &|| {
                reserve.give_back();
                // What fails is told by the second time.
                drop(rest::bring_to_rest_within(&ledger.rest(), FIRST_REST));
            },
            cut_off: &|| mounted.abort(),
        };
        watch.until_end(&mut child, &|| mounted.is_there(), &last_moment, ready)
    });
    clean_up(ledger, &mounted, device);
    drop(precedence);
    end.map_err(|error| Failure::system("daemon", error))
}

/// What the guardian is for. Goes on whatever fails, and says what did.
fn clean_up(ledger: &Ledger, mounted: &Mounted, device: OwnedFd) {
    for complaint in rest::bring_to_rest(&ledger.rest()) {
        complain(&complaint);
    }
    // First the abort: an invalidation waits for pages that an unanswered read of the dead daemon keeps locked.
    mounted.abort();
    for ino in ledger.cached() {
        // Nothing to do about a refusal: the kernel does not know the node (any more), so it has no page of it.
        let _ = nix::unistd::write(&device, &invalidate_message(ino));
    }
    // With the last descriptor the connection ends, and with it every request that is still waiting.
    drop(device);
    if mounted.is_there()
        && let Err(error) = mount::unmount(mounted.path())
    {
        complain(&format!("unmounting {}: {error}", mounted.path().display()));
    }
    sample_bus::remove_left(mounted.path());
    // The next daemon begins with nothing to undo.
    if let Err(error) = ledger.set_rest(&[]).and_then(|()| ledger.set_cached(&[])) {
        complain(&format!("ledger: {error}"));
    }
}

/// A line on standard error, where nobody may be listening any more.
fn complain(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "trikfs: {text}");
}

/// When the daemon crashed, as far back as it matters.
#[derive(Default)]
struct Crashes {
    times: VecDeque<Instant>,
    happened: bool,
}

impl Crashes {
    /// Notes one; true if there were too many within the window.
    fn note(&mut self, now: Instant) -> bool {
        let window = Duration::from_secs(limits::CRASH_WINDOW_SECONDS.into());
        self.happened = true;
        self.times.push_back(now);
        self.times.retain(|then| now.duration_since(*then) < window);
        self.times.len() >= limits::CRASHES_MAX
    }

    /// True if there ever was one.
    fn any(&self) -> bool {
        self.happened
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_crashes_within_a_minute_are_too_many() {
        let start = Instant::now();
        let at = |seconds| start + Duration::from_secs(seconds);
        let mut crashes = Crashes::default();
        assert!(!crashes.any());
        assert!(
            [0, 10, 20, 30]
                .iter()
                .all(|second| !crashes.note(at(*second)))
        );
        assert!(crashes.any());
        assert!(crashes.note(at(40)));
    }

    #[test]
    fn a_crash_now_and_then_is_forgiven_for_ever() {
        let start = Instant::now();
        let mut crashes = Crashes::default();
        let mut note = |second| crashes.note(start + Duration::from_secs(second));
        assert!((0..1000).all(|number| !note(number * 16)));
    }
}
