//! What programs write to actuators of a replayed tree, beside what was written when it was recorded.
//!
//! Owns the comparison: both are taken as a row of changes, so that how often a value is sampled or repeated does not matter.
//! The first difference of each actuator is kept with its time. Knows no clock.

use std::time::Duration;

/// How much later than recorded a change may come and still be the same: a program waits for the replayed tree as it did for
/// the real one, and is woken some milliseconds later.
const LATE: Duration = Duration::from_millis(100);

/// The changes of one actuator.
#[derive(Clone, Debug, Default)]
pub(crate) struct Output {
    recorded: Vec<(Duration, Vec<u8>)>,
    /// How many changes have been repeated by now.
    at: usize,
    /// What it has been told last in the replay.
    last: Option<Vec<u8>>,
    /// Nothing of the recording is left out.
    is_whole: bool,
    difference: Option<Difference>,
    same: u32,
    /// A program has written since the last jump.
    is_driven: bool,
}

/// Where a replay leaves the recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Difference {
    /// When a program wrote, or should have.
    pub(crate) at: Duration,
    /// What it wrote; None if it wrote nothing where something was recorded.
    pub(crate) wrote: Option<Vec<u8>>,
    /// What was recorded in its place, and when; None after the last one.
    pub(crate) recorded: Option<(Duration, Vec<u8>)>,
}

impl Output {
    /// Nothing is recorded yet.
    pub(crate) fn new() -> Self {
        Self {
            is_whole: true,
            ..Self::default()
        }
    }

    /// One recorded value; they come in order. At most `most` changes are kept.
    pub(crate) fn record(&mut self, at: Duration, tuple: &[u8], most: usize) {
        if self.recorded.last().is_some_and(|(_, last)| last == tuple) {
            return;
        }
        match self.recorded.len() < most {
            true => self.recorded.push((at, tuple.to_vec())),
            false => self.is_whole = false,
        }
    }

    /// The replay is at another position: what it had there counts as what was told last.
    pub(crate) fn seek(&mut self, position: Duration) {
        self.at = self.recorded.partition_point(|(at, _)| *at <= position);
        self.last = self.at.checked_sub(1).map(|at| self.recorded[at].1.clone());
        self.difference = None;
        self.same = 0;
        self.is_driven = false;
    }

    /// It was brought to rest. Before a program drives it, that is where it begins, and nothing to compare.
    pub(crate) fn rest(&mut self, at: Duration, tuple: &[u8]) -> bool {
        if self.is_driven {
            return self.write(at, tuple);
        }
        self.last = Some(tuple.to_vec());
        false
    }

    /// A program has written. True if this is the first difference.
    pub(crate) fn write(&mut self, at: Duration, tuple: &[u8]) -> bool {
        if self.last.as_deref() == Some(tuple) || self.difference.is_some() {
            return false;
        }
        self.last = Some(tuple.to_vec());
        self.is_driven = true;
        let recorded = self.recorded.get(self.at);
        match recorded {
            Some((_, wanted)) if wanted == tuple => {
                self.at += 1;
                self.same += 1;
                return false;
            }
            // What was recorded beyond is not known.
            None if !self.is_whole => return false,
            Some(_) | None => {}
        }
        self.difference = Some(Difference {
            at,
            wrote: Some(tuple.to_vec()),
            recorded: recorded.cloned(),
        });
        true
    }

    /// Looks for a recorded change that no program has made, although one drives the actuator; at this speed events come
    /// that much later. True if this is the first difference.
    pub(crate) fn miss(&mut self, position: Duration, speed: f64) -> bool {
        let Some((at, tuple)) = self.recorded.get(self.at) else {
            return false;
        };
        let late = LATE.mul_f64(speed.max(1.0));
        if !self.is_driven || self.difference.is_some() || position <= *at + late {
            return false;
        }
        self.difference = Some(Difference {
            at: position,
            wrote: None,
            recorded: Some((*at, tuple.clone())),
        });
        true
    }

    /// Where it left the recording.
    pub(crate) fn difference(&self) -> Option<&Difference> {
        self.difference.as_ref()
    }

    /// Changes that were made as recorded.
    pub(crate) fn same(&self) -> u32 {
        self.same
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: Duration = Duration::from_secs(1);

    fn motor() -> Output {
        let mut output = Output::new();
        for (at, power) in [(0, 0), (1, 0), (2, 30), (3, 30), (4, -30), (6, 0)] {
            output.record(S * at, &[power as u8], 100);
        }
        output.seek(Duration::ZERO);
        output
    }

    #[test]
    fn the_same_changes_are_no_difference_however_often_they_are_written() {
        let mut motor = motor();
        for (at, power) in [(0, 0_i8), (2, 30), (2, 30), (5, -30), (6, 0)] {
            assert!(!motor.write(S * at, &[power as u8]), "{at}");
        }
        assert_eq!((motor.same(), motor.difference()), (3, None));
        assert!(!motor.miss(S * 60, 1.0));
    }

    #[test]
    fn the_first_other_change_is_the_difference_and_the_next_is_not() {
        let mut motor = motor();
        assert!(!motor.write(S * 2, &[30]));
        assert!(motor.write(S * 4, &[20]));
        assert!(!motor.write(S * 5, &[10]));
        let wanted = Difference {
            at: S * 4,
            wrote: Some(vec![20]),
            recorded: Some((S * 4, vec![226])),
        };
        assert_eq!(motor.difference(), Some(&wanted));
    }

    #[test]
    fn a_change_too_many_and_one_too_few_are_differences() {
        let mut many = motor();
        many.seek(S * 6);
        assert!(many.write(S * 7, &[50]));
        assert_eq!(many.difference().unwrap().recorded, None);
        let mut few = motor();
        // Without a program there is nothing to compare.
        assert!(!few.miss(S * 5, 1.0));
        assert!(!few.write(S * 2, &[30]));
        assert!(!few.miss(S * 4, 1.0));
        assert!(!few.miss(S * 4 + LATE * 10, 10.0));
        assert!(few.miss(S * 5, 1.0));
        assert_eq!(few.difference().unwrap().wrote, None);
    }

    #[test]
    fn a_rest_before_anybody_drives_is_no_difference() {
        let mut motor = motor();
        assert!(!motor.rest(S, &[0]));
        assert!(!motor.write(S * 2, &[30]));
        assert!(motor.rest(S * 3, &[0]));
    }

    #[test]
    fn a_jump_begins_with_what_was_there() {
        let mut motor = motor();
        motor.seek(S * 5);
        assert!(!motor.write(S * 5, &[226]));
        assert!(!motor.write(S * 6, &[0]));
        assert_eq!(motor.same(), 1);
    }

    #[test]
    fn what_was_not_kept_is_not_compared() {
        let mut output = Output::new();
        for at in 0..5 {
            output.record(S * at, &[u8::try_from(at).unwrap()], 2);
        }
        output.seek(Duration::ZERO);
        assert!(!output.write(S, &[1]));
        assert!(!output.write(S * 2, &[77]));
        assert_eq!(output.difference(), None);
    }
}
