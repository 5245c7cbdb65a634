//! How a robot moves when its motors turn and its servos stand: a model in DCML.
//!
//! Owns which port is which action of the model, and where the plane of the model lies on the map: walls push the plane,
//! so that a model whose place is computed from other states is pushed as well. Knows no walls and no sensors.

pub mod configuration;
pub mod refusal;

use crate::geometry::{Point, Pose};
use crate::limits::{SERVO_RAD_S, STEP_S};
use lang_dcml::model::{Model, Symbol};
use lang_dcml::robot::Robot;
use lang_dcml::solve::{Method, Options, Solver};
use lang_dcml::syntax::Kind;
use lang_dcml::system::System;
use refusal::{Refusal, TAG};
use std::f64::consts::FRAC_PI_2;

/// Pulses of a servo of TRIK, in nanoseconds: a quarter of a turn to the right, ahead, and a quarter to the left.
const PULSES_NS: [f64; 3] = [700_000.0, 1_425_000.0, 2_150_000.0];
/// What gives the place, in states or outputs.
const PLACE: [&str; 3] = ["x", "y", "theta"];

/// A connector that moves something.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Port {
    /// M1 to M4, from 0: an action is how fast its wheel turns, in radians per second.
    Motor(usize),
    /// S1 to S6, from 0: an action is where it stands, in radians to the left.
    Servo(usize),
}

/// A port, and how much of an action one unit of it is: the radius of the wheel, if the action is a speed in m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Actuator {
    /// Which.
    pub port: Port,
    /// Action for each rad/s or rad.
    pub factor: f64,
}

impl Port {
    /// `M3`, `S1`.
    pub fn named(name: &str) -> Option<Self> {
        let number: usize = name.get(1..)?.parse().ok()?;
        match (name.get(..1)?, number) {
            ("M", 1..=4) => Some(Self::Motor(number - 1)),
            ("S", 1..=6) => Some(Self::Servo(number - 1)),
            _ => None,
        }
    }

    /// Its name.
    pub fn name(self) -> String {
        match self {
            Self::Motor(index) => format!("M{}", index + 1),
            Self::Servo(index) => format!("S{}", index + 1),
        }
    }
}

impl Actuator {
    /// `M3`, or `M3*0.028`.
    ///
    /// # Errors
    /// What is wrong with the words.
    pub fn read(words: &str) -> Result<Self, Refusal> {
        let (name, factor) = words.split_once('*').unwrap_or((words, "1"));
        let port =
            Port::named(name.trim()).ok_or_else(|| Refusal::NoPort(name.trim().to_owned()))?;
        let factor = factor
            .trim()
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite() && *number != 0.0);
        let factor = factor.ok_or_else(|| Refusal::NoFactor(words.to_owned()))?;
        Ok(Self { port, factor })
    }

    /// What the model says of an action: its name is that of a port, or its documentation has `@port M3`.
    fn of(symbol: &Symbol) -> Result<Option<Self>, Refusal> {
        if let Some(port) = Port::named(&symbol.name) {
            return Ok(Some(Self { port, factor: 1.0 }));
        }
        let text = symbol.doc.as_ref().map_or("", |doc| doc.text.as_str());
        let mut words = text.split_whitespace();
        let Some(_) = words.find(|word| *word == TAG) else {
            return Ok(None);
        };
        let named = Self::read(words.next().unwrap_or_default());
        named
            .map(Some)
            .map_err(|why| Refusal::Documented(symbol.name.clone(), why.into()))
    }
}

/// What a person says of a robot beside its model, by names of the model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Overrides {
    /// A number for each parameter.
    pub params: Vec<(String, f64)>,
    /// Ports of actions, before what the model says.
    pub drive: Vec<(String, Actuator)>,
    /// States that do not begin with 0.
    pub start: Vec<(String, f64)>,
}

/// Where a number of the place is.
#[derive(Debug, Clone, Copy)]
enum Place {
    State(usize),
    Output(usize),
}

/// A model that moves.
pub struct Rolling {
    robot: Robot,
    solver: Solver,
    actuators: Vec<Actuator>,
    place: [Place; 3],
    state: Vec<f64>,
    action: Vec<f64>,
    outputs: Vec<f64>,
    /// Where the servos stand.
    servos_rad: [f64; 6],
    /// The origin of the model on the map, and its x axis.
    plane: Pose,
    /// On the map.
    pose: Pose,
}

impl Rolling {
    /// A robot that stands at `start`.
    ///
    /// # Errors
    /// Why this model with these numbers and ports does not move a robot, for the person who said so.
    pub fn new(model: &Model, said: &Overrides, start: Pose) -> Result<Self, Refusal> {
        let of = |kind: Kind| -> Vec<&Symbol> { model.of_kind(kind).collect() };
        let params = numbers(
            &of(Kind::Param),
            "parameter",
            "--params",
            &said.params,
            None,
        )?;
        let states: Vec<&Symbol> = model.states().collect();
        let state = numbers(&states, "state", "--start", &said.start, Some(0.0))?;
        let robot = Robot::new(model, &params).map_err(Refusal::Equations)?;
        let step = Options::fixed(Method::Rk4, STEP_S);
        let solver = Solver::new(step, robot.states(), robot.actions());
        let mut rolling = Self {
            solver: solver.map_err(Refusal::Steps)?,
            actuators: actuators(&of(Kind::Action), &said.drive)?,
            place: place(model)?,
            action: vec![0.0; robot.actions()],
            outputs: vec![0.0; robot.output_parts().len()],
            servos_rad: [0.0; 6],
            plane: Pose::default(),
            pose: Pose::default(),
            robot,
            state,
        };
        let begin = rolling.found();
        if ![begin.at.x, begin.at.y, begin.heading_rad]
            .iter()
            .all(|one| one.is_finite())
        {
            return Err(Refusal::NoPlaceToStart);
        }
        rolling.pose = start;
        rolling.put(start);
        Ok(rolling)
    }

    /// Where it is on the map.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// What each action of the model is driven by.
    pub fn actuators(&self) -> &[Actuator] {
        &self.actuators
    }

    /// The motors that it has.
    pub fn has_motor(&self, index: usize) -> bool {
        let port = Port::Motor(index);
        self.actuators.iter().any(|one| one.port == port)
    }

    /// Moves while the motors turn by these angles, evenly, and the servos go where these pulses say. Where the model has
    /// no finite number the robot stays.
    pub fn roll(&mut self, dt_s: f64, turned_rad: [f64; 4], pulses_ns: [u32; 6]) {
        if dt_s <= 0.0 {
            return;
        }
        let most = SERVO_RAD_S * dt_s;
        for (angle, pulse) in self.servos_rad.iter_mut().zip(pulses_ns) {
            if pulse > 0 {
                *angle += (angle_of(pulse) - *angle).clamp(-most, most);
            }
        }
        for (index, one) in self.actuators.iter().enumerate() {
            let value = one.factor
                * match one.port {
                    Port::Motor(motor) => turned_rad[motor] / dt_s,
                    Port::Servo(servo) => self.servos_rad[servo],
                };
            let range = self.robot.action_range(index);
            self.action[index] = range.map_or(value, |(low, high)| value.max(low).min(high));
        }
        self.solver.start(0.0, &self.state);
        let held = &self.action;
        let mut actions = |_: f64, into: &mut [f64]| into.copy_from_slice(held);
        while self.solver.time() < dt_s {
            if self
                .solver
                .step(&mut self.robot, &mut actions, dt_s)
                .is_err()
            {
                return;
            }
        }
        self.state.copy_from_slice(self.solver.state());
        let found = self.found();
        let at = self.plane.place(found.at.x, found.at.y);
        let heading_rad = nearest(
            self.plane.heading_rad + found.heading_rad,
            self.pose.heading_rad,
        );
        if at.x.is_finite() && at.y.is_finite() && heading_rad.is_finite() {
            self.pose = Pose { at, heading_rad };
        }
    }

    /// A wall holds it here.
    pub fn push(&mut self, to: Point) {
        let way = to.from(self.pose.at);
        self.plane.at = Point {
            x: self.plane.at.x + way.x,
            y: self.plane.at.y + way.y,
        };
        self.pose.at = to;
    }

    /// A hand puts it there: the plane of the model moves, its states stay.
    pub fn put(&mut self, to: Pose) {
        let found = self.found();
        let heading_rad = nearest(to.heading_rad, self.pose.heading_rad);
        let turned = Pose {
            at: Point::default(),
            heading_rad: heading_rad - found.heading_rad,
        };
        let at = to.at.from(turned.place(found.at.x, found.at.y));
        let is_finite = at.x.is_finite() && at.y.is_finite() && turned.heading_rad.is_finite();
        if is_finite {
            self.plane = Pose { at, ..turned };
            self.pose = Pose {
                at: to.at,
                heading_rad,
            };
        }
    }

    /// The place as the model has it.
    fn found(&mut self) -> Pose {
        self.robot
            .output(&self.state, &self.action, &mut self.outputs);
        let [x, y, theta] = self.place.map(|place| match place {
            Place::State(index) => self.state[index],
            Place::Output(index) => self.outputs[index],
        });
        Pose::new(x, y, theta)
    }
}

/// The angle of that direction which is nearest to another: headings go through whole turns.
fn nearest(angle: f64, to: f64) -> f64 {
    angle - ((angle - to) / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

/// Where a pulse puts a servo.
fn angle_of(pulse_ns: u32) -> f64 {
    let [right, ahead, left] = PULSES_NS;
    let beside = f64::from(pulse_ns) - ahead;
    let span = if beside < 0.0 {
        ahead - right
    } else {
        left - ahead
    };
    (beside / span * FRAC_PI_2).clamp(-FRAC_PI_2, FRAC_PI_2)
}

/// A number for each name of a model: what was said, or the usual one.
fn numbers(
    names: &[&Symbol],
    what: &'static str,
    option: &'static str,
    said: &[(String, f64)],
    usual: Option<f64>,
) -> Result<Vec<f64>, Refusal> {
    known(names, what, said.iter().map(|(name, _)| name))?;
    let missing: Vec<String> = names
        .iter()
        .map(|symbol| symbol.name.clone())
        .filter(|name| usual.is_none() && !said.iter().any(|(other, _)| other == name))
        .collect();
    if !missing.is_empty() {
        return Err(Refusal::Missing(option, missing));
    }
    let number = |symbol: &&Symbol| {
        let given = said.iter().rev().find(|(name, _)| *name == symbol.name);
        given
            .map(|(_, number)| *number)
            .or(usual)
            .unwrap_or(f64::NAN)
    };
    Ok(names.iter().map(number).collect())
}

/// Refuses names that a model has not.
fn known<'n>(
    names: &[&Symbol],
    what: &'static str,
    mut said: impl Iterator<Item = &'n String>,
) -> Result<(), Refusal> {
    match said.find(|name| !names.iter().any(|symbol| symbol.name == **name)) {
        None => Ok(()),
        Some(stray) => {
            let there = names.iter().map(|symbol| symbol.name.clone()).collect();
            Err(Refusal::Stray(what, stray.clone(), there))
        }
    }
}

/// The port of each action.
fn actuators(actions: &[&Symbol], said: &[(String, Actuator)]) -> Result<Vec<Actuator>, Refusal> {
    known(actions, "action", said.iter().map(|(name, _)| name))?;
    if actions.is_empty() {
        return Err(Refusal::NoActions);
    }
    let mut found = Vec::new();
    for symbol in actions {
        let given = said.iter().rev().find(|(name, _)| *name == symbol.name);
        let one = match given {
            Some((_, actuator)) => Some(*actuator),
            None => Actuator::of(symbol)?,
        };
        found.push(one.ok_or_else(|| Refusal::Idle(symbol.name.clone()))?);
    }
    Ok(found)
}

/// Where a model has the place.
fn place(model: &Model) -> Result<[Place; 3], Refusal> {
    let find = |name: &str| {
        let state = model.states().position(|symbol| symbol.name == name);
        let output = || model.outputs().position(|symbol| symbol.name == name);
        state
            .map(Place::State)
            .or_else(|| output().map(Place::Output))
    };
    let [x, y, theta] = PLACE.map(find);
    match (x, y, theta) {
        (Some(x), Some(y), Some(theta)) => Ok([x, y, theta]),
        _ => Err(Refusal::NoPlace(model.name.clone())),
    }
}

#[cfg(test)]
mod tests;
