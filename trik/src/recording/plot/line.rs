//! One number of a recording over time, as it is drawn.
//!
//! Owns what is left of it: of each step of time the first, least, greatest and last number, so that a long recording makes no
//! larger picture and no peak is lost.

use crate::limits;

/// One number over time.
pub(crate) struct Line {
    pub(super) node: usize,
    pub(super) name: String,
    pub(crate) title: String,
    steps: Vec<Step>,
    /// Moments of failures, in s.
    pub(crate) faults: Vec<f64>,
    /// Since when there is no number, in s.
    lost: Option<f64>,
    /// Gaps within the last step of time.
    gaps: usize,
}

/// What is left of all numbers within a step of time: first, least, greatest and last, each with its moment in s.
struct Step {
    number: usize,
    /// When what was before had ended, in s, if there was no number in between.
    gap: Option<f64>,
    points: [(f64, f64); 4],
}

impl Line {
    /// Nothing of it yet.
    pub(crate) fn new(node: usize, name: String, title: String) -> Self {
        Self {
            node,
            name,
            title,
            steps: Vec::new(),
            faults: Vec::new(),
            lost: None,
            gaps: 0,
        }
    }

    /// There is no number.
    pub(crate) fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// A number at this moment, in s, within the step of time with this number.
    pub(crate) fn take(&mut self, number: usize, at: f64, value: f64) {
        if !value.is_finite() {
            self.lost.get_or_insert(at);
            return;
        }
        let gap = self.lost.take();
        match self.steps.last_mut() {
            // More gaps than these cannot be seen.
            Some(step)
                if step.number == number
                    && (gap.is_none() || self.gaps == limits::PLOT_GAPS_MAX) =>
            {
                let [_, least, greatest, last] = &mut step.points;
                if value < least.1 {
                    *least = (at, value);
                }
                if value > greatest.1 {
                    *greatest = (at, value);
                }
                *last = (at, value);
            }
            last => {
                let is_same = last.is_some_and(|step| step.number == number);
                self.gaps = if is_same { self.gaps + 1 } else { 0 };
                self.steps.push(Step {
                    number,
                    gap,
                    points: [(at, value); 4],
                });
            }
        }
    }

    /// It fails at this moment.
    pub(crate) fn fail(&mut self, at: f64) {
        self.lost.get_or_insert(at);
        if self.faults.len() < limits::PLOT_FAULTS_MAX {
            self.faults.push(at);
        }
    }

    /// Places of the pen up to the end. A number holds until the next one comes or the node fails, as for a program that
    /// reads; a gap is a place without a number.
    pub(crate) fn points(&self, end: f64) -> Vec<(f64, f64)> {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for step in &self.steps {
            let held = points.last().copied();
            if let Some((lost, (_, value))) = step.gap.zip(held) {
                points.extend([(lost, value), (f64::NAN, f64::NAN)]);
            }
            let mut of_step = step.points;
            of_step[1..3].sort_by(|one, other| one.0.total_cmp(&other.0));
            for (at, value) in of_step {
                if let Some((_, held)) = points.last().filter(|last| last.1.is_finite())
                    && *held != value
                {
                    points.push((at, *held));
                }
                if points.last() != Some(&(at, value)) {
                    points.push((at, value));
                }
            }
        }
        if let Some((_, value)) = points.last().copied() {
            points.push((self.lost.unwrap_or(end), value));
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> Line {
        Line::new(0, "x".to_owned(), "a.x".to_owned())
    }

    #[test]
    fn a_number_holds_until_the_next_one_or_a_failure() {
        let mut line = line();
        line.take(0, 0.0, 1.0);
        line.take(10, 1.0, 2.0);
        line.fail(3.0);
        line.take(40, 4.0, 5.0);
        let points = line.points(9.0);
        let before = [(0.0, 1.0), (1.0, 1.0), (1.0, 2.0), (3.0, 2.0)];
        assert_eq!(points[..4], before);
        assert!(points[4].0.is_nan());
        assert_eq!(points[5..], [(4.0, 5.0), (9.0, 5.0)]);
        // What is lost to the end is drawn no further.
        line.fail(5.0);
        assert_eq!(line.points(9.0).last(), Some(&(5.0, 5.0)));
    }

    #[test]
    fn many_numbers_take_little_and_no_peak_is_lost() {
        let mut line = line();
        for at in 0..100_000_u32 {
            let value = match at {
                50_000 => 9.0,
                _ if at % 2 == 0 => f64::NAN,
                _ => f64::from(at % 3),
            };
            line.take(at as usize / 10_000, at.into(), value);
            line.fail(at.into());
        }
        assert!(line.steps.len() <= 10 * (limits::PLOT_GAPS_MAX + 1));
        assert_eq!(line.faults.len(), limits::PLOT_FAULTS_MAX);
        let greatest = line
            .points(1e5)
            .iter()
            .map(|point| point.1)
            .fold(0.0, f64::max);
        assert_eq!(greatest, 9.0);
    }
}
