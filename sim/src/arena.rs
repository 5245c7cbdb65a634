//! The running world of TRIK Studio's simulator: a field, its robots, and time in ticks of 10 ms.
//!
//! Owns the order of one tick (physics at the speeds chosen before, then noise, pose, gyroscope and encoders) and what
//! changes while it runs. Knows no programs and no rules: a program is given [`Arena::robot`], a judge reads the state.
//!
//! Facts are those of the original's simulator: ideal physics that takes its last step back when the robot touches
//! something, sensors that look at walls and solids in the order and with the roundings of its paths.

mod brick;
mod dynamics;
pub mod floor;
pub mod graphic;
pub mod outline;
pub(crate) mod ranges;
mod readings;
mod robot;
pub mod screen;
pub mod solids;
mod timeline;

pub use brick::Handle;
pub use floor::Floor;
pub use outline::{Bounds, Outline};
pub use readings::Readings;
pub use robot::{Dice, Gamepad, Marker, Pad, Robot};
pub use solids::Solids;
pub use timeline::Timeline;

use std::collections::VecDeque;

use self::dynamics::Dynamics;

use lang_diagram::brick::{Answer, Brick as _, Question};
use lang_diagram::devices;
use lang_diagram::machine::STEP_MS;
use lang_diagram::ports::Port;
use lang_diagram::program::Program;
use lang_diagram::stand_in::{Motion, motion};
use lang_text::problem::Problem;

use crate::field::{self, Field, SensorKind};
use crate::geometry::Point;
use crate::limits;

/// How a field is set going.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Of all noise and random numbers.
    pub seed: u64,
    /// Sensors that a program needs; they go onto ports that are empty.
    pub sensors: Vec<(Port, SensorKind)>,
    /// Robots beside that of the field.
    pub others: Vec<field::Robot>,
    /// What a person answers when a program asks, in order.
    pub answers: VecDeque<String>,
    /// Whether people watch it. Then things that robots push are where they were pushed to; without it sensors and rules
    /// see them where they stood, as in the original's background mode.
    pub is_watched: bool,
    /// Whether markers leave nothing: the original draws what they leave with its window, and without one there is none.
    pub is_unmarked: bool,
}

impl Setup {
    /// With the sensors that a program waits for.
    pub fn of(program: &Program) -> Self {
        let kind = |sensor| match sensor {
            devices::Sensor::Infrared => SensorKind::Infrared,
            devices::Sensor::Sonar => SensorKind::Sonar,
            devices::Sensor::Light => SensorKind::Light,
            devices::Sensor::Touch => SensorKind::Touch,
            devices::Sensor::Other => SensorKind::Other,
        };
        Self {
            sensors: devices::needed(program)
                .into_iter()
                .map(|(port, sensor)| (port, kind(sensor)))
                .collect(),
            ..Self::default()
        }
    }
}

/// Somebody who answers when a program asks and no answers are left.
pub trait Person: std::fmt::Debug + Send {
    /// What is answered to a question, which is asked again and again until then.
    fn ask(&mut self, question: Question<'_>) -> Answer;

    /// Whether this is what was just answered, and can be asked once more.
    fn may_ask_again(&mut self, _question: Question<'_>) -> bool {
        false
    }

    /// Asks it once more: the answer was no good, for these reasons.
    fn ask_again(&mut self, _question: Question<'_>, _why: &[Problem]) {}
}

/// What of a robot's devices was changed from outside its program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Change {
    /// The colour of the light.
    Led,
    /// What the shell said.
    Phrase,
    /// The marker.
    Marker,
    /// The colour behind the display.
    Background,
}

/// A field on which robots drive.
#[derive(Debug)]
pub struct Arena {
    field: Field,
    seed: u64,
    now: u32,
    solids: Solids,
    robots: Vec<Robot>,
    answers: VecDeque<String>,
    person: Option<Box<dyn Person>>,
    is_watched: bool,
    is_unmarked: bool,
    /// What rules have changed of things as they are drawn.
    pub graphics: graphic::Graphics,
    /// What rules have told robots since somebody asked.
    changes: Vec<(usize, Change)>,
    /// Laid when somebody looks at it or leaves something on it.
    floor: Option<Box<Floor>>,
    /// Instead of ideal physics, made at the first tick.
    dynamics: Option<Box<Dynamics>>,
    /// Room for windows of the floor.
    window: floor::Window,
    /// Room for outlines that live for one call.
    scratch: Outline,
}

impl Arena {
    /// A field before its first tick.
    pub fn new(field: &Field, setup: Setup) -> Self {
        let mut first = field.robot().cloned().unwrap_or_else(|| field::Robot {
            // Another kit's robot: only where it stands is ours.
            sensors: Vec::new(),
            left: field::Robot::default().left,
            right: field::Robot::default().right,
            ..field.robots.first().cloned().unwrap_or_default()
        });
        for &(port, kind) in &setup.sensors {
            if first.sensor(port).is_none() {
                first.sensors.push(field::Sensor::new(port, kind));
            }
        }
        let others = setup.others.into_iter().take(limits::FIELD_ROBOTS);
        let robots = std::iter::once(first)
            .chain(others)
            .enumerate()
            .map(|(index, robot)| Robot::new(robot, index, setup.seed))
            .collect();
        Self {
            solids: Solids::of(field),
            field: field.clone(),
            seed: setup.seed,
            now: 0,
            robots,
            answers: setup.answers,
            person: None,
            is_watched: setup.is_watched,
            is_unmarked: setup.is_unmarked,
            graphics: graphic::Graphics::default(),
            changes: Vec::new(),
            floor: None,
            dynamics: None,
            window: floor::Window::default(),
            scratch: Outline::default(),
        }
    }

    /// From now on this person answers when a program asks and no answers are left.
    pub fn set_person(&mut self, person: Box<dyn Person>) {
        self.person = Some(person);
    }

    /// One tick: 10 ms of the world. A program's step at the same time comes after it.
    pub fn tick(&mut self) {
        self.now = self.now.saturating_add(STEP_MS);
        if self.field.settings.realistic_physics {
            let made = || Box::new(Dynamics::new(&self.field, &self.robots));
            let dynamics = self.dynamics.get_or_insert_with(made);
            dynamics.tick(&mut self.robots);
            if self.is_watched {
                let solids = &mut self.solids;
                dynamics.read_back(&mut self.field, |index, solid| solids.moved(index, solid));
            }
        } else {
            self.ideal();
        }
        for robot in &mut self.robots {
            let begin = robot.centre();
            robot.advance(&self.field.settings);
            if robot.marker.is_down && robot.centre() != begin && !self.is_unmarked {
                let rgb = screen::named(&robot.marker.colour);
                let stroke = floor::Stroke {
                    begin,
                    end: robot.centre(),
                    rgb: [rgb.red, rgb.green, rgb.blue],
                };
                laid(&mut self.floor, &self.field).mark(stroke);
            }
        }
    }

    /// What a tick moves the robots with ideal wheels; a robot that touches something takes its last step back.
    fn ideal(&mut self) {
        for robot in &mut self.robots {
            robot.outline_into(&mut self.scratch);
            robot.is_stuck = self.solids.meets(&self.scratch);
            robot.motion = if robot.is_stuck {
                let Motion { shift, turn } = robot.motion;
                Motion {
                    shift: (-shift.0, -shift.1),
                    turn: -turn,
                }
            } else {
                motion(&robot.rolling, robot.chosen, robot.pose.degrees)
            };
        }
    }

    /// Reads sensors that rules have asked for and nobody else has read, every 20 ms and after the step of the program.
    pub fn renew(&mut self) {
        if self.now == 0 || !self.now.is_multiple_of(readings::RENEWAL_MS) {
            return;
        }
        for index in 0..self.robots.len() {
            for port in self.robots[index].readings.due(self.now) {
                self.robot(index).scalar(port);
            }
        }
    }

    /// A rule has told a robot something that records have.
    pub fn note(&mut self, robot: usize, change: Change) {
        if self.changes.len() < limits::RECORDS {
            self.changes.push((robot, change));
        }
    }

    /// What rules have told robots since the last call.
    pub fn take_changes(&mut self) -> Vec<(usize, Change)> {
        std::mem::take(&mut self.changes)
    }

    /// Milliseconds since the beginning.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// The seed that it was made with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The field as it is now: solids are where they have been pushed.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// Changes the field while it runs: walls, colours, regions. Robots stay where they are.
    pub fn edit(&mut self, change: impl FnOnce(&mut Field)) {
        change(&mut self.field);
        self.solids = Solids::of(&self.field);
        self.dynamics = None;
        if let Some(old) = self.floor.take() {
            // What markers have left lies over everything new.
            let floor = laid(&mut self.floor, &self.field);
            floor.wipe();
            for stroke in old.trace() {
                floor.mark(*stroke);
            }
        }
    }

    /// A hand puts a thing elsewhere: `index` is that of [`Field::solids`]. False: there is no such thing.
    pub fn put_solid(&mut self, index: usize, at: Point) -> bool {
        let Some(solid) = self.field.solids.get_mut(index) else {
            return false;
        };
        solid.at = at;
        self.solids.moved(index, solid);
        // Its body is made anew where it stands now.
        self.dynamics = None;
        true
    }

    /// All things go to where another field has them, robots stay.
    pub fn put_solids_of(&mut self, other: &Field) {
        self.field.solids.clone_from(&other.solids);
        for (index, solid) in self.field.solids.iter().enumerate() {
            self.solids.moved(index, solid);
        }
        self.dynamics = None;
    }

    /// Takes away what markers have left.
    pub fn wipe(&mut self) {
        if let Some(floor) = &mut self.floor {
            floor.wipe();
        }
    }

    /// What optical sensors see, and what markers have left on it.
    pub fn floor(&mut self) -> &mut Floor {
        laid(&mut self.floor, &self.field)
    }

    /// What markers have left; nothing as long as none was down.
    pub fn trace(&self) -> &[floor::Stroke] {
        self.floor.as_deref().map_or(&[], Floor::trace)
    }

    /// What robots and rays run into.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }

    /// All robots as they are now; the first one is that of the field.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// A robot, to be changed from outside its program: keys pressed, a gamepad, another place.
    pub fn robot_mut(&mut self, index: usize) -> Option<&mut Robot> {
        self.robots.get_mut(index)
    }

    /// A robot as its program sees it.
    ///
    /// # Panics
    /// If there is no such robot.
    pub fn robot(&mut self, index: usize) -> Handle<'_> {
        assert!(index < self.robots.len(), "no robot number {index}");
        Handle { arena: self, index }
    }
}

/// The floor, laid at the first call.
fn laid<'a>(floor: &'a mut Option<Box<Floor>>, field: &Field) -> &'a mut Floor {
    floor.get_or_insert_with(|| Box::new(floor::lay(field).0))
}

#[cfg(test)]
mod tests;
