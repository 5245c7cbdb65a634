//! What a person orders a world in words: the words, what they mean, and why one is not done.
//!
//! Owns the words of `control/world` and of pages, and the bounds of their numbers. What an order does is the body's part.

mod words;

use crate::geometry::{Point, Pose, point};
use crate::limits;
use lang_text::problem::Words;
use std::fmt;

/// An order to a world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Order<'w> {
    /// Time stands still.
    Pause,
    /// Time goes on.
    Go,
    /// So many ticks of 10 ms, then time stands still.
    Step(u32),
    /// How many times as fast as the clock.
    Speed(f64),
    /// Other walls, colours and things: those of this file.
    Field(&'w str),
    /// The robot and all things go to where they began, and what markers have left is wiped.
    Reset,
    /// A hand puts the robot there.
    Robot(Pose),
    /// A hand puts a thing there: its number in the world, from 0.
    Thing(usize, Point),
}

/// Why an order to the world is not done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BadOrder {
    /// There is no world.
    NoOrders,
    /// The words are no order.
    Unknown(String),
    /// A count of ticks that cannot be.
    Ticks,
    /// A speed that cannot be.
    Speed(String),
    /// A place that cannot be.
    Place(String),
    /// A place beyond the walls.
    Outside,
    /// No thing has this number.
    NoThing(usize),
    /// The robot is in a room of its own, which has no other walls.
    OwnRoom,
    /// The author of the project locks its world.
    Locked,
    /// The author of the project locks where the robot begins.
    RobotLocked,
    /// A file of a world that cannot be read, and what the system says.
    Unread(String, String),
    /// A file that is no world, and the first thing that is wrong in it.
    Field(String, Words),
}

/// What there is.
const ORDERS: &str = "pause, go, step, step NUMBER, speed NUMBER, reset, robot X Y DEGREES, thing NUMBER X Y or \
                      field FILE";

impl fmt::Display for BadOrder {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoOrders => {
                out.write_str("this robot has no world around it that takes orders: choose another robot")
            }
            Self::Unknown(words) => write!(out, "'{words}' is no order: there are {ORDERS}"),
            Self::Ticks => {
                write!(
                    out,
                    "step takes 1 to {} ticks of 10 ms",
                    limits::STEPS_ORDERED
                )
            }
            Self::Speed(word) => {
                let (least, most) = (limits::MIN_SPEED, limits::MAX_SPEED);
                write!(out, "speed takes {least} to {most}, not '{word}'")
            }
            Self::Place(words) => write!(
                out,
                "'{words}' is no place: write metres from {} to {}, and degrees",
                -limits::PLACE_M,
                limits::PLACE_M
            ),
            Self::Outside => out.write_str("that place is beyond the walls of the room"),
            Self::NoThing(number) => write!(out, "there is no thing number {number} in this world"),
            Self::OwnRoom => out.write_str(
                "this robot is in a room of its own; only one of `trik up --field` takes other worlds",
            ),
            Self::Locked => {
                out.write_str("the project of this world locks it: its walls and things stay")
            }
            Self::RobotLocked => {
                out.write_str("the project of this world locks the place of the robot")
            }
            Self::Unread(file, why) => write!(out, "{file}: {why}"),
            Self::Field(file, why) => write!(out, "{file}: {}", why.english),
        }
    }
}

impl BadOrder {
    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
    }
}

impl std::error::Error for BadOrder {}

impl<'w> Order<'w> {
    /// Reads one.
    ///
    /// # Errors
    /// It is none, or one of its numbers cannot be.
    pub fn parse(words: &'w str) -> Result<Self, BadOrder> {
        let words = words.trim();
        let (order, rest) = words.split_once(' ').unwrap_or((words, ""));
        let rest = rest.trim();
        match (order, rest) {
            ("pause", "") => Ok(Self::Pause),
            ("go", "") => Ok(Self::Go),
            ("reset", "") => Ok(Self::Reset),
            ("step", "") => Ok(Self::Step(1)),
            ("step", _) => {
                let ticks = rest.parse().unwrap_or(0);
                let can_be = (1..=limits::STEPS_ORDERED).contains(&ticks);
                can_be.then_some(Self::Step(ticks)).ok_or(BadOrder::Ticks)
            }
            ("speed", _) => {
                let speed = rest.parse().unwrap_or(f64::NAN);
                let can_be = (limits::MIN_SPEED..=limits::MAX_SPEED).contains(&speed);
                let why = || BadOrder::Speed(rest.chars().take(40).collect());
                can_be.then_some(Self::Speed(speed)).ok_or_else(why)
            }
            ("robot", _) => {
                let [x, y, degrees] = numbers(rest)?;
                Ok(Self::Robot(Pose::new(x, y, degrees.to_radians())))
            }
            ("thing", _) => {
                let (number, place) = rest.split_once(' ').unwrap_or((rest, ""));
                let unknown = |_| BadOrder::Unknown(words.chars().take(80).collect());
                let number = number.parse().map_err(unknown)?;
                let [x, y] = numbers(place)?;
                Ok(Self::Thing(number, point(x, y)))
            }
            ("field", file) if !file.is_empty() => Ok(Self::Field(file)),
            _ => Err(BadOrder::Unknown(words.chars().take(80).collect())),
        }
    }
}

/// So many numbers that can be metres or degrees.
fn numbers<const N: usize>(words: &str) -> Result<[f64; N], BadOrder> {
    let why = || BadOrder::Place(words.chars().take(80).collect());
    let read = |word: &str| -> Option<f64> {
        let number: f64 = word.parse().ok()?;
        (number.abs() <= limits::PLACE_M).then_some(number)
    };
    let all: Option<Vec<f64>> = words.split_whitespace().map(read).collect();
    all.and_then(|all| all.try_into().ok()).ok_or_else(why)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read() {
        let pose = Pose::new(1.0, -0.5, std::f64::consts::FRAC_PI_2);
        for (words, order) in [
            (" pause ", Order::Pause),
            ("go", Order::Go),
            ("reset", Order::Reset),
            ("step", Order::Step(1)),
            ("step 20", Order::Step(20)),
            ("speed 0.5", Order::Speed(0.5)),
            ("robot 1 -0.5 90", Order::Robot(pose)),
            ("thing 3  0.25 1e0", Order::Thing(3, point(0.25, 1.0))),
            ("field a b.xml", Order::Field("a b.xml")),
        ] {
            assert_eq!(Order::parse(words), Ok(order), "{words}");
        }
    }

    #[test]
    fn numbers_that_cannot_be_move_nothing() {
        for words in [
            "",
            "fly",
            "pause now",
            "reset all",
            "step 0",
            "step 1e9",
            "step -1",
            "speed nan",
            "speed 0",
            "speed inf",
            "robot",
            "robot 1 2",
            "robot 1 2 3 4",
            "robot nan 0 0",
            "robot 0 inf 0",
            "robot 1e9 0 0",
            "robot 0 0 1e300",
            "robot a b c",
            "thing",
            "thing 1",
            "thing -1 0 0",
            "thing 1 0",
            "thing 1 0 -inf",
            "thing 99999999999999999999999 0 0",
            "field",
        ] {
            assert!(Order::parse(words).is_err(), "{words}");
        }
        let long = "x".repeat(1 << 20);
        let told = Order::parse(&long).unwrap_err().to_string();
        assert!(told.len() < 300);
    }
}
