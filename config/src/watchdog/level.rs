//! How awake the watchdog is: by who waits for the work that goes on.
//!
//! Owns the levels, and which one fits what a look at all work has found. Knows no thread and no clock.

/// Nothing has worked for a while: a thread that begins has to wake the watchdog.
pub(super) const ASLEEP: u8 = 0;
/// The watchdog looks every few milliseconds: a thread that begins awaited work has to wake it.
pub(super) const DOZING: u8 = 1;
/// The thread looks every millisecond.
pub(super) const TICKING: u8 = 2;

/// Who waits for the work of a thread, and so how soon it is late.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Urgency {
    /// Somebody waits: late after about one millisecond, at most two ticks.
    Awaited,
    /// Nobody waits for this very work: late after some fifteen milliseconds.
    Background,
}

impl Urgency {
    /// How awake the watchdog must be.
    pub(super) fn level(self) -> u8 {
        match self {
            Self::Awaited => TICKING,
            Self::Background => DOZING,
        }
    }
}

/// What one look at everything has found.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    /// Somebody has worked since the last look, or works.
    any: bool,
    /// The same of awaited work.
    awaited: bool,
    /// Somebody is in the middle of work.
    unfinished: bool,
}

impl Found {
    /// How awake the watchdog has to be after this.
    pub(super) fn level(self) -> u8 {
        if self.awaited || self.unfinished {
            TICKING
        } else if self.any {
            DOZING
        } else {
            ASLEEP
        }
    }

    /// Takes in one line of work.
    pub(super) fn add(&mut self, is_new: bool, number: u32, urgency: Urgency) {
        let works = number & 1 == 1;
        self.any |= is_new || works;
        self.awaited |= (is_new || works) && urgency == Urgency::Awaited;
        self.unfinished |= works;
    }
}
