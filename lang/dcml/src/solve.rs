//! Initial value problems of systems under actions that change with time: x' = f(x, u(t)).
//!
//! Owns the state of a solution between steps, the choice of their size, and what ends it early. Single steps are
//! `solve/step`'s part, the values between their ends `solve/dense`'s, whole runs with events `solve/run`'s. Angles never
//! wrap in here; [`wrapped`] is for what is shown.

mod dense;
pub mod event;
pub mod propagate;
pub mod run;
mod step;

use super::system::System;
use crate::limits;
use std::fmt;

/// How steps are made.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Method {
    /// Order 1, one derivative for each step.
    Euler,
    /// Order 2: the trapezoid of a step of Euler.
    Heun,
    /// Order 4, the classical one.
    Rk4,
    /// Order 5 with steps as large as the error allows: the pair of Dormand and Prince.
    Rk45,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Euler, Self::Heun, Self::Rk4, Self::Rk45];

    /// Its name for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Euler => "euler",
            Self::Heun => "heun",
            Self::Rk4 => "rk4",
            Self::Rk45 => "rk45",
        }
    }
}

/// What a solution is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How steps are made.
    pub method: Method,
    /// The size of steps in s; for [`Method::Rk45`] the largest one.
    pub step: f64,
    /// For [`Method::Rk45`]: the error that a step may have, as a part of the state.
    pub relative: f64,
    /// For [`Method::Rk45`]: and beside that, in the unit of the state.
    pub absolute: f64,
    /// After how many steps it is given up.
    pub steps_max: usize,
}

impl Options {
    /// Steps of one size, in s.
    pub const fn fixed(method: Method, step: f64) -> Self {
        Self {
            method,
            step,
            relative: 1e-6,
            absolute: 1e-9,
            steps_max: limits::DCML_STEPS_MAX,
        }
    }

    /// Steps as the error allows.
    pub const fn adaptive(relative: f64, absolute: f64) -> Self {
        Self {
            method: Method::Rk45,
            step: f64::INFINITY,
            relative,
            absolute,
            steps_max: limits::DCML_STEPS_MAX,
        }
    }
}

/// Why a solution ends before its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// What is asked for makes no sense; why.
    Options(&'static str),
    /// A part of the state, or its derivative, is no finite number from this time in s on.
    NotFinite {
        /// In s.
        time: f64,
        /// Which part.
        state: usize,
    },
    /// Steps would have to be smaller than numbers can say.
    StepTooSmall {
        /// In s.
        time: f64,
        /// The part with the largest error.
        state: usize,
    },
    /// More steps than allowed.
    TooManySteps {
        /// How far it came, in s.
        time: f64,
    },
    /// More events than anyone looks at.
    TooManyEvents {
        /// How far it came, in s.
        time: f64,
    },
}

impl Failure {
    /// The part of the state that it is about.
    pub const fn state(&self) -> Option<usize> {
        match self {
            Self::NotFinite { state, .. } | Self::StepTooSmall { state, .. } => Some(*state),
            _ => None,
        }
    }

    /// In words, with a name for the part of the state.
    pub fn told(&self, name: &str) -> String {
        match self {
            Self::Options(why) => (*why).into(),
            Self::NotFinite { time, .. } => format!(
                "at {time} s {name} or its derivative is no finite number: check parameters, start and actions"
            ),
            Self::StepTooSmall { time, .. } => format!(
                "at {time} s {name} changes faster than any step can follow: a jump or a pole, or tolerances that are too small"
            ),
            Self::TooManySteps { time } => format!(
                "too many steps, it came to {time} s: allow larger steps or larger errors, or a shorter time"
            ),
            Self::TooManyEvents { time } => {
                format!("too many events, it came to {time} s")
            }
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.state().map(|state| format!("state {state}"));
        f.write_str(&self.told(name.as_deref().unwrap_or_default()))
    }
}

impl std::error::Error for Failure {}

/// A solution on its way: the last step, and what the next one needs. Allocates nothing after it is made.
#[derive(Clone, Debug)]
pub struct Solver {
    options: Options,
    time: f64,
    state: Vec<f64>,
    action: Vec<f64>,
    /// Where the last step began.
    before: f64,
    old: Vec<f64>,
    /// How far it went, and the state there; an event may have cut it since.
    size: f64,
    ended: Vec<f64>,
    /// The stages of the last step; the first is at its begin and the last at its end.
    slopes: [Vec<f64>; 7],
    stage: Vec<f64>,
    /// Whether the derivative at the begin of the next step must be asked for.
    is_fresh: bool,
    /// Steps of one size are counted from here, so that their ends do not drift.
    origin: f64,
    since_origin: f64,
    /// The size of the next step, if the error decides.
    next: f64,
    /// The error of the last step, for the controller.
    last_error: f64,
    steps: usize,
}

impl Solver {
    /// For a system of that many states and actions, at time 0 with all states 0.
    ///
    /// # Errors
    ///
    /// [`Failure::Options`]
    pub fn new(options: Options, states: usize, actions: usize) -> Result<Self, Failure> {
        // Written so that what is no number is refused.
        if options.step.is_nan() || options.step <= 0.0 {
            return Err(Failure::Options("a step must be larger than zero"));
        }
        if options.method != Method::Rk45 && options.step.is_infinite() {
            return Err(Failure::Options("a step must have an end"));
        }
        let is_tolerance = |one: f64| one.is_finite() && one >= 0.0;
        let (relative, absolute) = (options.relative, options.absolute);
        if !is_tolerance(relative) || !is_tolerance(absolute) || relative + absolute == 0.0 {
            return Err(Failure::Options(
                "errors that are allowed must be zero or more, and one of them more",
            ));
        }
        let zeros = || vec![0.0; states];
        Ok(Self {
            options,
            time: 0.0,
            state: zeros(),
            action: vec![0.0; actions],
            before: 0.0,
            old: zeros(),
            size: 0.0,
            ended: zeros(),
            slopes: std::array::from_fn(|_| zeros()),
            stage: zeros(),
            is_fresh: true,
            origin: 0.0,
            since_origin: 0.0,
            next: 0.0,
            last_error: 1e-4,
            steps: 0,
        })
    }

    /// Puts it to a time in s and a state, from which it starts anew. What is missing of the state stays as it is.
    pub fn start(&mut self, time: f64, state: &[f64]) {
        self.time = time;
        for (one, given) in self.state.iter_mut().zip(state) {
            *one = *given;
        }
        self.before = time;
        self.old.copy_from_slice(&self.state);
        self.ended.copy_from_slice(&self.state);
        self.size = 0.0;
        self.next = 0.0;
        self.last_error = 1e-4;
        self.steps = 0;
        self.renew();
    }

    /// Tells that actions jump here: the next step begins with a derivative of its own.
    pub fn renew(&mut self) {
        self.is_fresh = true;
        self.origin = self.time;
        self.since_origin = 0.0;
    }

    /// Where it is, in s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The state there.
    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Where its last step began, in s.
    pub fn before(&self) -> f64 {
        self.before
    }

    /// How many steps were made since the start.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The state at a time in the last step, to about the order of the method.
    pub fn between(&self, time: f64, state: &mut [f64]) {
        dense::between(self, time, state);
    }

    /// Goes back to a time in the last step.
    fn cut(&mut self, time: f64) {
        let mut stage = std::mem::take(&mut self.stage);
        self.between(time, &mut stage);
        self.state.copy_from_slice(&stage);
        self.stage = stage;
        self.time = time;
        self.renew();
    }

    /// Makes one step, at the most to `limit`. The actions are asked at times within the step; at its end for what holds
    /// just before.
    ///
    /// # Errors
    ///
    /// [`Failure`]; time and state are then those before the step.
    pub fn step<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        actions: &mut impl FnMut(f64, &mut [f64]),
        limit: f64,
    ) -> Result<(), Failure> {
        // Written so that what is no number ends it.
        if !(self.time < limit && limit.is_finite()) {
            return Err(Failure::Options("a solution goes ahead in time"));
        }
        if self.steps >= self.options.steps_max {
            return Err(Failure::TooManySteps { time: self.time });
        }
        self.begin(system, actions)?;
        match self.options.method {
            Method::Rk45 => self.adaptive(system, actions, limit)?,
            _ => self.fixed(system, actions, limit)?,
        }
        self.steps += 1;
        Ok(())
    }

    /// The derivative at the begin of a step: that at the end of the last one, or asked for.
    fn begin<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        actions: &mut impl FnMut(f64, &mut [f64]),
    ) -> Result<(), Failure> {
        if !std::mem::take(&mut self.is_fresh) {
            self.slopes.swap(0, 6);
            return Ok(());
        }
        actions(self.time, &mut self.action);
        system.derivative(&self.state, &self.action, &mut self.slopes[0]);
        let (state, slope) = (&self.state, &self.slopes[0]);
        match (0..state.len()).find(|at| !(state[*at] + slope[*at]).is_finite()) {
            Some(state) => {
                self.is_fresh = true;
                let time = self.time;
                Err(Failure::NotFinite { time, state })
            }
            None => Ok(()),
        }
    }

    fn fixed<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        actions: &mut impl FnMut(f64, &mut [f64]),
        limit: f64,
    ) -> Result<(), Failure> {
        let step = self.options.step;
        let mut end = self.origin + (self.since_origin + 1.0) * step;
        if end <= self.time {
            let (time, state) = (self.time, 0);
            return Err(Failure::StepTooSmall { time, state });
        }
        if end > limit - 1e-9 * step {
            end = limit;
        }
        let size = end - self.time;
        step::fixed(self, system, actions, size);
        if let Some(state) = self.stage.iter().position(|one| !one.is_finite()) {
            self.is_fresh = true;
            return Err(Failure::NotFinite { time: end, state });
        }
        self.accept(end);
        self.since_origin += 1.0;
        actions(end.next_down(), &mut self.action);
        system.derivative(&self.state, &self.action, &mut self.slopes[6]);
        if self.slopes[6].iter().any(|one| !one.is_finite()) {
            // It may be finite after a jump of actions: the next step tells.
            self.renew();
        }
        Ok(())
    }

    /// The state of the stage is the new one.
    fn accept(&mut self, end: f64) {
        self.before = self.time;
        self.old.copy_from_slice(&self.state);
        self.state.copy_from_slice(&self.stage);
        self.ended.copy_from_slice(&self.stage);
        self.size = end - self.time;
        self.time = end;
    }

    /// Tries steps until the error is allowed. Size by a controller with memory (Hairer, Norsett, Wanner, Solving
    /// Ordinary Differential Equations I, II.4 and IV.2).
    fn adaptive<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        actions: &mut impl FnMut(f64, &mut [f64]),
        limit: f64,
    ) -> Result<(), Failure> {
        const SAFETY: f64 = 0.9;
        const MEMORY: f64 = 0.04;
        const EXPONENT: f64 = 0.2 - 0.75 * MEMORY;
        if self.next == 0.0 {
            self.next = step::first(self, system, actions, limit);
        }
        let mut is_rejected = false;
        loop {
            let smallest = 10.0 * (self.time.next_up() - self.time);
            let planned = self.next.min(self.options.step);
            let is_last = self.time + planned * 1.01 >= limit;
            let size = if is_last { limit - self.time } else { planned };
            if size < smallest && !is_last {
                return Err(self.lost());
            }
            let end = if is_last { limit } else { self.time + size };
            let error = step::dormand_prince(self, system, actions, size, end);
            if error <= 1.0 {
                let smooth = error.max(1e-10);
                let factor =
                    SAFETY * libm::pow(smooth, -EXPONENT) * libm::pow(self.last_error, MEMORY);
                let most = if is_rejected { 1.0 } else { 10.0 };
                let next = size * factor.clamp(0.2, most);
                self.next = if is_last { next.max(planned) } else { next };
                self.last_error = smooth.max(1e-4);
                self.accept(end);
                return Ok(());
            }
            if is_last && size < smallest {
                return Err(self.lost());
            }
            is_rejected = true;
            let factor = if error.is_finite() {
                (SAFETY * libm::pow(error, -EXPONENT)).clamp(0.1, 1.0)
            } else {
                0.1
            };
            self.next = size * factor.min(0.9);
        }
    }

    /// Why no step is small enough, from the stages of the last one.
    fn lost(&mut self) -> Failure {
        self.is_fresh = true;
        let time = self.time;
        if let Some(state) = self.stage.iter().position(|one| !one.is_finite()) {
            return Failure::NotFinite { time, state };
        }
        let errors = (0..self.state.len()).map(|at| (step::error_of(self, at).abs(), at));
        let worst = errors.max_by(|one, other| one.0.total_cmp(&other.0));
        let state = worst.map_or(0, |(_, at)| at);
        Failure::StepTooSmall { time, state }
    }
}

/// An angle in rad on the circle, from -pi (without it) to pi.
pub fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > -PI && angle <= PI {
        return angle;
    }
    let turned = angle.rem_euclid(TAU);
    if turned > PI { turned - TAU } else { turned }
}

#[cfg(test)]
mod tests;
