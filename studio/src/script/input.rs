//! Keys and gamepad of a simulated robot as the streams that programs listen to.
//!
//! Owns what has changed since the last look: records of `keys/device`, lines of `gamepad/text/device`. Knows no threads.

use super::tree::keys;
use lang_diagram::brick::Brick;
use lang_diagram::ports::{Device, GamepadPart, Pad, Port};

/// What one of them has brought.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Record {
    /// Numbers of a stream of them.
    Numbers(Vec<i32>),
    /// A line of a stream of text.
    Line(String),
}

/// Presses of the keys, seven numbers in the order of the tree.
pub const KEYS: &str = "keys/device";
/// Lines of a gamepad.
pub const GAMEPAD: &str = "gamepad/text/device";

/// What was seen last.
#[derive(Debug, Default)]
pub struct Input {
    keys: [i32; 7],
    pads: [Option<[i32; 2]>; 2],
    wheel: Option<i32>,
    buttons: [bool; 5],
}

fn scalar(brick: &mut dyn Brick, part: GamepadPart) -> Option<i32> {
    brick.scalar(Port::of(Device::Gamepad(part))?)
}

fn pad(brick: &mut dyn Brick, pad: Pad) -> Option<[i32; 2]> {
    if scalar(brick, GamepadPart::Pressed(pad))? == 0 {
        return None;
    }
    let mut at = Vec::new();
    let port = Port::of(Device::Gamepad(GamepadPart::Place(pad)))?;
    brick.vector(port, &mut at);
    Some([at.first().copied()?, at.get(1).copied()?])
}

impl Input {
    /// What has happened to the keys.
    pub fn keys(&mut self, brick: &mut dyn Brick) -> Option<Record> {
        let now = keys(brick);
        let has_changed = now != self.keys;
        self.keys = now;
        has_changed.then(|| Record::Numbers(now.to_vec()))
    }

    /// What has happened to the gamepad.
    pub fn gamepad(&mut self, brick: &mut dyn Brick) -> Vec<Record> {
        let mut lines = Vec::new();
        for (which, was) in [Pad::One, Pad::Two].into_iter().zip(&mut self.pads) {
            let number = which.number();
            let is = pad(brick, which);
            if is != *was {
                lines.push(match is {
                    Some([x, y]) => format!("pad {number} {x} {y}"),
                    None => format!("pad {number} up"),
                });
                *was = is;
            }
        }
        let wheel = scalar(brick, GamepadPart::Wheel);
        if wheel != self.wheel {
            lines.extend(wheel.map(|at| format!("wheel {at}")));
            self.wheel = wheel;
        }
        for (number, was) in (1..).zip(&mut self.buttons) {
            let is = scalar(brick, GamepadPart::Button(number)).unwrap_or(0) != 0;
            if is != *was {
                lines.push(format!("btn {number} {}", if is { "down" } else { "up" }));
                *was = is;
            }
        }
        lines.into_iter().map(Record::Line).collect()
    }
}
