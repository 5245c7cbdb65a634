//! What a person does beside the robot while it is judged: keys and a gamepad, by time.
//!
//! Owns the lines in which that is written and how they change the robot. The words of the gamepad are those that gamepads
//! send to a robot. Knows no programs.

use crate::arena::{Gamepad, Pad, Robot};
use crate::limits;
use lang_diagram::ports::{Port, Sort};
use std::fmt;

/// One thing that a person does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Deed {
    /// When, in milliseconds of model time.
    pub ms: u32,
    gesture: Gesture,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Gesture {
    /// A finger on a pad, or off it.
    Pad(usize, Option<[i32; 2]>),
    Button(usize, bool),
    Wheel(i32),
    /// The gamepad is there, or is not.
    Connected(bool),
    /// A key of the controller, by its code.
    Key(i32, bool),
}

/// What is wrong in a line. Its author can change that.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Reason {
    /// It does not begin with a time.
    NoTime(String),
    /// Its time is before that of the line above.
    Back,
    /// It is one more than [`limits::DEEDS`].
    TooMany,
    /// Nobody can do this.
    Unknown(String),
    /// A word instead of a number within these bounds.
    NotWithin(String, i32, i32),
    /// No key has this name.
    NoKey(String),
}

/// A line that is refused, from 1, and why.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Refusal {
    /// Its number.
    pub line: u32,
    /// Why.
    pub reason: Reason,
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        const FORMS: &str = "'pad 1 X Y', 'pad 1 up', 'btn 3 down', 'btn 3 up', 'wheel PERCENT', 'gamepad on', 'gamepad off', \
                             'key Enter down' or 'key Enter up'";
        write!(out, "line {}: ", self.line)?;
        match &self.reason {
            Reason::NoTime(word) => write!(
                out,
                "it begins with a time in seconds, as 1.5, not with '{word}'"
            ),
            Reason::Back => out.write_str("time goes back"),
            Reason::TooMany => write!(out, "there are more than {}", limits::DEEDS),
            Reason::Unknown(words) => write!(out, "'{words}' is none of {FORMS}"),
            Reason::NotWithin(word, low, high) => {
                write!(out, "'{word}' is no number from {low} to {high}")
            }
            Reason::NoKey(name) => write!(out, "there is no key '{name}'"),
        }
    }
}

impl std::error::Error for Refusal {}

/// Reads deeds: in each line seconds and what is done, in order of time. Empty lines and what follows `#` mean nothing.
///
/// # Errors
/// The number of the line and what is wrong in it.
pub fn read(text: &str) -> Result<Vec<Deed>, Refusal> {
    let mut deeds: Vec<Deed> = Vec::new();
    for (number, text) in (1..).zip(text.lines()) {
        let line = text.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some((seconds, words)) = words.split_first() else {
            continue;
        };
        let place = |reason| Refusal {
            line: number,
            reason,
        };
        let ms = ms(seconds).map_err(place)?;
        let gesture = gesture(words).map_err(place)?;
        if deeds.last().is_some_and(|last| last.ms > ms) {
            return Err(place(Reason::Back));
        }
        if deeds.len() == limits::DEEDS {
            return Err(place(Reason::TooMany));
        }
        deeds.push(Deed { ms, gesture });
    }
    Ok(deeds)
}

fn ms(text: &str) -> Result<u32, Reason> {
    let ms = text
        .parse::<f64>()
        .map(|seconds| (seconds * 1000.0).round());
    match ms {
        Ok(ms) if (0.0..=f64::from(limits::RUN_MS_MAX)).contains(&ms) => Ok(ms as u32),
        _ => Err(Reason::NoTime(text.to_owned())),
    }
}

fn gesture(words: &[&str]) -> Result<Gesture, Reason> {
    let is_down = |word: &str| match word {
        "down" => Some(true),
        "up" => Some(false),
        _ => None,
    };
    let within = |word: &str, low: i32, high: i32| {
        let number: Option<i32> = word.parse().ok();
        number
            .filter(|number| (low..=high).contains(number))
            .ok_or_else(|| Reason::NotWithin(word.to_owned(), low, high))
    };
    let unknown = || Reason::Unknown(words.join(" "));
    Ok(match *words {
        ["pad", pad, "up"] => Gesture::Pad(within(pad, 1, 2)? as usize - 1, None),
        ["pad", pad, x, y] => {
            let at = [within(x, -100, 100)?, within(y, -100, 100)?];
            Gesture::Pad(within(pad, 1, 2)? as usize - 1, Some(at))
        }
        ["btn", button, state] => {
            let is_down = is_down(state).ok_or_else(unknown)?;
            Gesture::Button(within(button, 1, 5)? as usize - 1, is_down)
        }
        ["wheel", percent] => Gesture::Wheel(within(percent, -100, 100)?),
        ["gamepad", "on"] => Gesture::Connected(true),
        ["gamepad", "off"] => Gesture::Connected(false),
        ["key", name, state] => {
            let is_down = is_down(state).ok_or_else(unknown)?;
            match Port::named(name).map(Port::sort) {
                Some(Sort::Button(code)) => Gesture::Key(code, is_down),
                _ => return Err(Reason::NoKey(name.to_owned())),
            }
        }
        _ => return Err(unknown()),
    })
}

/// Does to a robot what is due at a moment; what was done is taken away.
pub(super) fn act(deeds: &mut &[Deed], now: u32, robot: &mut Robot) {
    while let Some((deed, rest)) = deeds.split_first()
        && deed.ms <= now
    {
        *deeds = rest;
        let mut gamepad = robot.gamepad().copied().unwrap_or_default();
        gamepad.is_away = false;
        match deed.gesture {
            Gesture::Key(code, is_down) => {
                robot.press(code, is_down);
                continue;
            }
            Gesture::Connected(is_there) => {
                gamepad = Gamepad {
                    is_away: !is_there,
                    ..Gamepad::default()
                };
            }
            Gesture::Pad(pad, at) => {
                gamepad.pads[pad] = at.map_or_else(Pad::default, |[x, y]| Pad {
                    x,
                    y,
                    is_pressed: true,
                });
            }
            Gesture::Button(button, is_down) => gamepad.buttons[button] = is_down,
            Gesture::Wheel(percent) => gamepad.wheel = percent,
        }
        robot.set_gamepad(Some(gamepad));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arena::{Arena, Setup};
    use crate::field::Field;
    use lang_diagram::brick::Brick;

    #[test]
    fn what_a_person_does_is_done_when_it_is_due() {
        let text = "# a game\n0 gamepad on\n\n0.5 pad 2 30 -50 # drive\n0.51 btn 5 down\n1 wheel -7\n1 pad 2 up\n1.5 key Enter down\n2 gamepad off\n";
        let all = read(text).unwrap();
        let mut deeds = &all[..];
        let mut arena = Arena::new(&Field::default(), Setup::default());
        let robot = arena.robot_mut(0).unwrap();
        act(&mut deeds, 0, robot);
        assert_eq!(robot.gamepad(), Some(&Gamepad::default()));
        act(&mut deeds, 510, robot);
        let gamepad = *robot.gamepad().unwrap();
        let pad = Pad {
            x: 30,
            y: -50,
            is_pressed: true,
        };
        assert_eq!((gamepad.pads[1], gamepad.buttons[4]), (pad, true));
        act(&mut deeds, 1500, robot);
        let gamepad = *robot.gamepad().unwrap();
        assert_eq!((gamepad.pads[1], gamepad.wheel), (Pad::default(), -7));
        assert!(robot.is_pressed(28));
        act(&mut deeds, 9000, robot);
        assert!(robot.gamepad().unwrap().is_away);
        let handle = &mut arena.robot(0);
        for (port, value) in [
            ("GamepadConnectionIndicatorPort", 0),
            ("GamepadWheelPort", 0),
        ] {
            assert_eq!(handle.scalar(Port::named(port).unwrap()), Some(value));
        }
        assert!(deeds.is_empty());
    }

    #[test]
    fn what_nobody_can_do_is_refused_with_its_line() {
        for (text, why) in [
            ("pad 1 up", "line 1: it begins with a time"),
            ("1e9 pad 1 up", "line 1: it begins with a time"),
            ("nan pad 1 up", "line 1: it begins with a time"),
            ("\n1 jump", "line 2: 'jump' is none of 'pad 1 X Y'"),
            ("1", "line 1: '' is none of"),
            ("1 pad 3 0 0", "line 1: '3' is no number from 1 to 2"),
            (
                "1 pad 1 0 101",
                "line 1: '101' is no number from -100 to 100",
            ),
            ("1 btn 1 sideways", "line 1: 'btn 1 sideways' is none of"),
            ("1 key Reset down", "line 1: there is no key 'Reset'"),
            ("2 wheel 1\n1 wheel 2", "line 2: time goes back"),
        ] {
            let told = read(text).unwrap_err().to_string();
            assert!(told.starts_with(why), "{text}: {told}");
        }
        let many = "0 wheel 1\n".repeat(limits::DEEDS + 1);
        assert!(read(&many).is_err());
    }
}
