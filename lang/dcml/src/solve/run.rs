//! A whole solution: steps from jump to jump of the actions, until its time is over or an event ends it.
//!
//! Owns the order of what happens within a step.

use super::event::Event;
use super::{Failure, Solver};
use crate::limits;
use crate::system::System;

/// An event that has happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Happened {
    /// Which one.
    pub event: usize,
    /// When, in s.
    pub time: f64,
    /// The state there.
    pub state: Vec<f64>,
}

/// How far a solution shall go.
pub struct Course<'a> {
    /// Its end, in s.
    pub to: f64,
    /// Times in s, rising, at which actions jump: steps end there. Those that are past are left out.
    pub jumps: &'a [f64],
    /// What is looked for on the way.
    pub events: &'a mut [Event<'a>],
}

impl Solver {
    /// Goes to the end of the course, or to the first event that ends it. `seen` is told after each step, when
    /// [`Solver::between`] gives what was in it. Gives the events in the order of their times.
    ///
    /// # Errors
    ///
    /// [`Failure`]; the solver then stands before the step that could not be made.
    pub fn run<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        actions: &mut impl FnMut(f64, &mut [f64]),
        course: &mut Course<'_>,
        mut seen: impl FnMut(&Solver),
    ) -> Result<Vec<Happened>, Failure> {
        let mut happened = Vec::new();
        let mut jumps = course.jumps.iter().copied().peekable();
        while self.time() < course.to {
            let next = loop {
                match jumps.peek() {
                    Some(jump) if *jump <= self.time() => {
                        jumps.next();
                        self.renew();
                    }
                    Some(jump) => break jump.min(course.to),
                    None => break course.to,
                }
            };
            self.step(system, actions, next)?;
            let is_over = self.find_events(course.events, &mut happened)?;
            seen(self);
            if is_over {
                break;
            }
        }
        Ok(happened)
    }

    /// Finds the events of the last step; goes back to the first one that ends the solution.
    fn find_events(
        &mut self,
        events: &mut [Event<'_>],
        happened: &mut Vec<Happened>,
    ) -> Result<bool, Failure> {
        if events.is_empty() {
            return Ok(false);
        }
        let mut state = vec![0.0; self.state().len()];
        let mut found: Vec<(f64, usize)> = Vec::new();
        for (at, event) in events.iter_mut().enumerate() {
            found.extend(event.first_in(self, &mut state).map(|time| (time, at)));
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        for (time, event) in found {
            if happened.len() >= limits::DCML_EVENTS_MAX {
                return Err(Failure::TooManyEvents { time });
            }
            self.between(time, &mut state);
            happened.push(Happened {
                event,
                time,
                state: state.clone(),
            });
            if events[event].is_terminal {
                self.cut(time);
                return Ok(true);
            }
        }
        Ok(false)
    }
}
