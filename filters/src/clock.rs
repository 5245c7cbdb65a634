//! The time between two tuples: from the tuples themselves, or from the configuration.
//!
//! Owns the rule for time. Reads no clock: a filter knows only what it is told.
//!
//! A tuple may end with `time_us`, microseconds as u32; it may start anywhere and wraps to 0 after its greatest value,
//! after 71 minutes. If there is one, it counts. Otherwise all tuples lie `period_ms` apart.

use crate::limits::{GAP_US_MAX, PERIOD_MS_MAX};
use crate::params::Params;
use converter::{Fault, OpenInfo};

/// Microseconds of a millisecond.
const MS_US: f64 = 1000.0;

/// Where time comes from, and the time of the last tuple.
#[derive(Clone, Copy, Debug)]
pub enum Clock {
    /// All tuples lie this far apart; `begun` is false before the first.
    Period {
        /// Microseconds between two tuples.
        us: f64,
        /// True after the first tuple.
        begun: bool,
    },
    /// Tuples tell their time, the last one this; absent before the first.
    Stamp(Option<u32>),
    /// Time means nothing to this filter.
    None,
}

/// What lies between a tuple and the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Elapsed {
    /// There is none before.
    First,
    /// Nothing: the same sample again.
    Nothing,
    /// So many microseconds, more than 0.
    Us(f64),
}

impl Elapsed {
    /// Seconds, absent for the first tuple.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::First => None,
            Self::Nothing => Some(0.0),
            Self::Us(us) => Some(us / 1e6),
        }
    }
}

impl Clock {
    /// A clock for tuples that all lie `period_ms` apart.
    ///
    /// # Errors
    /// A period that is missing or out of range.
    pub fn period(filter: &'static str, info: &OpenInfo<'_>) -> Result<Self, Fault> {
        if info.param("period_ms").is_none() {
            return Err(Fault::new(format!(
                "{filter}: period_ms is missing, and the tuple does not end with a time_us"
            )));
        }
        let period_ms = Params::new(filter, info).whole("period_ms", 1.0, 1.0..=PERIOD_MS_MAX)?;
        Ok(Self::Period {
            us: period_ms * MS_US,
            begun: false,
        })
    }

    /// The time since the last tuple. `stamp` is this one's, and counts only for [`Clock::Stamp`].
    ///
    /// # Errors
    /// Time that went back, and a gap that cannot be bridged.
    pub fn elapsed(&mut self, stamp: u32) -> Result<Elapsed, Fault> {
        match self {
            Self::None => Ok(Elapsed::First),
            Self::Period { us, begun } => {
                let before = std::mem::replace(begun, true);
                Ok(if before {
                    Elapsed::Us(*us)
                } else {
                    Elapsed::First
                })
            }
            Self::Stamp(last) => {
                let Some(before) = last.replace(stamp) else {
                    return Ok(Elapsed::First);
                };
                let us = stamp.wrapping_sub(before);
                // The upper half of the numbers are steps back.
                if us > u32::MAX / 2 {
                    let back = us.wrapping_neg();
                    return Err(Fault::new(format!("time went back by {back} us")));
                }
                if us > GAP_US_MAX {
                    return Err(Fault::new(format!(
                        "{us} us since the last tuple, more than {GAP_US_MAX}"
                    )));
                }
                Ok(if us == 0 {
                    Elapsed::Nothing
                } else {
                    Elapsed::Us(f64::from(us))
                })
            }
        }
    }

    /// Forgets the last tuple.
    pub fn reset(&mut self) {
        match self {
            Self::None => {}
            Self::Period { begun, .. } => *begun = false,
            Self::Stamp(last) => *last = None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_give_differences_across_the_end_of_their_range() {
        let mut clock = Clock::Stamp(None);
        assert_eq!(clock.elapsed(u32::MAX - 4), Ok(Elapsed::First));
        assert_eq!(clock.elapsed(5), Ok(Elapsed::Us(10.0)));
        assert_eq!(clock.elapsed(5), Ok(Elapsed::Nothing));
        clock.reset();
        assert_eq!(clock.elapsed(7), Ok(Elapsed::First));
    }

    #[test]
    fn time_that_goes_back_and_long_gaps_are_faults() {
        let text = |from, to| {
            Clock::Stamp(Some(from))
                .elapsed(to)
                .unwrap_err()
                .to_string()
        };
        assert_eq!(text(1000, 900), "time went back by 100 us");
        assert_eq!(text(3, u32::MAX), "time went back by 4 us");
        assert_eq!(
            text(0, 1_000_001),
            "1000001 us since the last tuple, more than 1000000"
        );
        assert_eq!(
            Clock::Stamp(Some(0)).elapsed(1_000_000),
            Ok(Elapsed::Us(1e6))
        );
    }

    #[test]
    fn a_period_is_what_the_configuration_says() {
        let mut clock = Clock::Period {
            us: 10_000.0,
            begun: false,
        };
        assert_eq!(clock.elapsed(1), Ok(Elapsed::First));
        assert_eq!(clock.elapsed(0), Ok(Elapsed::Us(10_000.0)));
        assert_eq!(Elapsed::Us(10_000.0).seconds(), Some(0.01));
    }
}
