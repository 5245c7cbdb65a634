//! The tree of files as a simulated robot has it: paths to readings and commands.
//!
//! Owns which file stands for what of a [`Brick`], so that what reads the tree of a real robot (JavaScript, Python) reads
//! this one as well. Knows no language and no order of time: the robot is handed in with each question.

use crate::limits;
use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::{Device, Direction, GamepadPart, Kit, ObjectPart, Pad, Port, Sort};
use std::collections::BTreeMap;
use std::io;

/// The files of the keys, in the order of the tree.
const KEYS: [&str; 7] = ["Power", "Up", "Esc", "Left", "Right", "Down", "Enter"];
/// Pads that nobody touches.
const RELEASED: i32 = -101;
/// Volts of a battery that never runs out.
const BATTERY: &str = "12.0";
/// Cells of the colour sensor, three in a row.
const CELLS: usize = 9;
/// Where the heading stands among the numbers of the gyroscope.
const HEADING: usize = 6;

/// How often the original's simulator comes through its events.
const TURN_MS: u32 = 30;

/// What the robot does not say by itself.
#[derive(Debug, Default)]
pub struct Tree {
    /// What motors and servos were told last.
    powers: BTreeMap<Port, i32>,
    green: bool,
    red: bool,
    /// How often each sensor of the camera has looked for its colour.
    detections: BTreeMap<String, u32>,
    /// Whether an encoder was cleared, and when one was cleared at no cost.
    cleared: bool,
    free: Option<u32>,
    /// Files that the program has written.
    written: BTreeMap<String, Vec<u8>>,
}

fn absent() -> io::Error {
    io::Error::new(
        io::ErrorKind::NotFound,
        "the simulated robot has no such file",
    )
}

fn unplugged() -> io::Error {
    io::Error::new(
        io::ErrorKind::NotFound,
        "nothing is plugged in there in this world",
    )
}

fn nothing_yet() -> io::Error {
    io::ErrorKind::WouldBlock.into()
}

fn port(name: &str, way: Direction) -> Option<Port> {
    Port::find(Kit::V62, name, way)
}

fn whole(text: &str) -> io::Result<i32> {
    let number: f64 = text
        .trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| io::Error::from(io::ErrorKind::InvalidInput))?;
    Ok(number as i32)
}

fn joined(numbers: impl IntoIterator<Item = i32>) -> String {
    let words: Vec<String> = numbers
        .into_iter()
        .map(|number| number.to_string())
        .collect();
    words.join(" ")
}

/// Where in the tree the readings of a device stand; what is there once for each port has a directory for each.
fn place(device: Device) -> &'static str {
    match device {
        Device::Motor => "motors",
        Device::Servo => "servos",
        Device::Encoder => "encoders",
        Device::Plugged => "sensors",
        Device::Gyroscope => "gyroscope",
        Device::Accelerometer => "accelerometer",
        Device::LineSensor => "camera/line",
        Device::ColorSensor => "camera/color",
        Device::ObjectSensor(_) => "camera/object",
        Device::Lidar => "lidar",
        Device::Button(_) => "keys",
        Device::Gamepad(GamepadPart::Place(Pad::One) | GamepadPart::Pressed(Pad::One)) => {
            "gamepad/pad1"
        }
        Device::Gamepad(GamepadPart::Place(Pad::Two) | GamepadPart::Pressed(Pad::Two)) => {
            "gamepad/pad2"
        }
        Device::Gamepad(GamepadPart::Wheel) => "gamepad/wheel",
        Device::Gamepad(GamepadPart::Button(_)) => "gamepad/buttons",
        Device::Gamepad(GamepadPart::Connected) => "gamepad",
    }
}

/// The device whose readings stand in a directory.
fn device_in(directory: &str) -> Option<Device> {
    Port::all()
        .map(Port::device)
        .find(|device| place(*device) == directory)
}

/// Numbers of a sensor with several, at least as many as asked for; zeros where it has none.
fn vector(brick: &mut dyn Brick, device: Device, least: usize) -> Option<Vec<i32>> {
    let mut numbers = Vec::new();
    let found = brick.vector(Port::of(device)?, &mut numbers);
    if numbers.len() < least {
        numbers.resize(least, 0);
    }
    found.then_some(numbers)
}

fn scalar(brick: &mut dyn Brick, device: Device) -> Option<i32> {
    brick.scalar(Port::of(device)?)
}

/// Presses of the keys, in the order of the tree.
pub fn keys(brick: &mut dyn Brick) -> [i32; 7] {
    KEYS.map(|name| {
        let key = Port::named(name);
        key.and_then(|key| brick.scalar(key)).unwrap_or(0)
    })
}

impl Tree {
    /// Whether this directory is there and something is plugged in.
    pub fn has(&self, brick: &mut dyn Brick, directory: &str) -> bool {
        match directory.split_once('/') {
            Some(("motors", name)) => is_sort(name, Direction::Out, Sort::Motor),
            Some(("servos", name)) => is_sort(name, Direction::Out, Sort::Servo),
            Some(("encoders", name)) => is_sort(name, Direction::In, Sort::Encoder),
            Some(("sensors", name)) => {
                let port = port(name, Direction::In).filter(|port| port.sort() == Sort::Scalar);
                port.is_some_and(|port| brick.scalar(port).is_some())
            }
            Some(("camera", _)) => device_in(directory).is_some(),
            Some(_) => false,
            None => match device_in(directory) {
                Some(
                    device @ (Device::Gyroscope
                    | Device::Accelerometer
                    | Device::LineSensor
                    | Device::ColorSensor
                    | Device::Lidar),
                ) => vector(brick, device, 0).is_some(),
                Some(Device::Button(_) | Device::Gamepad(_)) => true,
                // These have a directory for each port or each number.
                Some(
                    Device::Motor
                    | Device::Servo
                    | Device::Encoder
                    | Device::Plugged
                    | Device::ObjectSensor(_),
                ) => false,
                None => ["marker", "led", "battery", "display"].contains(&directory),
            },
        }
    }

    /// Names in a directory.
    pub fn names(&self, brick: &mut dyn Brick, directory: &str) -> Vec<String> {
        let mut names: Vec<String> = Port::all()
            .map(|port| port.name().to_owned())
            .filter(|name| self.has(brick, &format!("{directory}/{name}")))
            .collect();
        names.sort();
        names
    }

    /// The newest text of a file.
    pub fn read(&self, brick: &mut dyn Brick, path: &str) -> io::Result<String> {
        let parts: Vec<&str> = path.split('/').collect();
        let text = match parts[..] {
            ["motors" | "servos", name, "value"] => {
                let port = port(name, Direction::Out).ok_or_else(absent)?;
                self.powers.get(&port).copied().unwrap_or(0).to_string()
            }
            ["servos", _, "units"] => "deg".to_owned(),
            ["sensors" | "encoders", name, "value" | "raw"] => {
                let port = port(name, Direction::In).ok_or_else(absent)?;
                brick.scalar(port).ok_or_else(unplugged)?.to_string()
            }
            ["battery", _] => BATTERY.to_owned(),
            ["camera", mode, "hsv"] => {
                let count = self.detections.get(mode).ok_or_else(nothing_yet)?;
                format!("{count} 0 0 0 0 0")
            }
            _ => {
                let (directory, file) = path.rsplit_once('/').ok_or_else(absent)?;
                match (device_in(directory), &parts[..]) {
                    (Some(device), _) => reading(brick, device, file)?,
                    // What else the gamepad says never comes here.
                    (None, ["gamepad", _, _]) => return Err(nothing_yet()),
                    (None, _) => return Err(absent()),
                }
            }
        };
        Ok(text)
    }

    /// Takes one text.
    pub fn write(&mut self, brick: &mut dyn Brick, path: &str, text: &str) -> io::Result<()> {
        let parts: Vec<&str> = path.split('/').collect();
        match parts[..] {
            ["motors", name, "value"] => {
                let port = port(name, Direction::Out).ok_or_else(absent)?;
                let percent = whole(text)?;
                self.powers.insert(port, percent);
                brick.command(Command::Power { port, percent });
            }
            ["servos", name, "value"] => {
                let port = port(name, Direction::Out).ok_or_else(absent)?;
                let degrees = whole(text)?;
                self.powers.insert(port, degrees);
                brick.command(Command::Servo { port, degrees });
            }
            ["motors" | "servos", name, "brake" | "power"] => {
                let port = port(name, Direction::Out).ok_or_else(absent)?;
                self.powers.remove(&port);
                let brake = parts[2] == "brake";
                brick.command(Command::Off { port, brake });
            }
            ["encoders", name, "value"] => {
                let port = port(name, Direction::In).ok_or_else(absent)?;
                brick.command(Command::ResetEncoder { port });
                self.cleared = true;
            }
            ["led", light, "value"] => self.light(brick, light, whole(text)? != 0),
            ["sound", "play", "value"] => {
                let file = text.rsplit('/').next().unwrap_or(text);
                brick.command(Command::Sound { file });
            }
            ["sound", "say", "value"] => brick.command(Command::Say { text: Some(text) }),
            ["sound", "tone", "value"] => {
                let (hertz, ms) = text.trim().split_once(' ').ok_or_else(absent)?;
                let (hertz, ms) = (whole(hertz)?, whole(ms)?);
                brick.command(Command::Tone { hertz, ms });
            }
            ["camera", mode, "video_out"] => {
                let show = whole(text)? != 0;
                brick.command(Command::StartCamera { mode, show });
            }
            ["camera", mode, "detect"] => {
                *self.detections.entry(mode.to_owned()).or_default() += 1;
                brick.command(Command::Detect { mode });
            }
            // The colour that was detected is looked for anyway.
            ["camera", _, "hsv"] => {}
            ["marker", "value"] => brick.command(match text.trim() {
                "" => Command::MarkerUp,
                color => Command::MarkerDown { color },
            }),
            ["stop"] => {
                self.powers.clear();
                brick.command(Command::Rest);
            }
            _ => return Err(absent()),
        }
        Ok(())
    }

    /// Whether an encoder was cleared since the last question, and the program goes on in the next tick. So it is for a
    /// diagram: the block takes a turn of the simulator's, which comes through its events every third tick.
    pub fn has_cleared(&mut self, now_ms: u32) -> bool {
        if !std::mem::take(&mut self.cleared) {
            return false;
        }
        if now_ms.is_multiple_of(TURN_MS) && self.free != Some(now_ms) {
            self.free = Some(now_ms);
            return false;
        }
        true
    }

    /// One order sets green and red one after the other; the colour is told when red is known.
    fn light(&mut self, brick: &mut dyn Brick, light: &str, on: bool) {
        if light == "green" {
            self.green = on;
            return;
        }
        self.red = on;
        let color = match (self.green, self.red) {
            (true, true) => "orange",
            (true, false) => "green",
            (false, true) => "red",
            (false, false) => "off",
        };
        brick.command(Command::Led { color });
    }

    /// What the program has put into a file of its own; it never reaches the disk.
    pub fn written(&self, file: &str) -> Option<&[u8]> {
        self.written.get(file).map(Vec::as_slice)
    }

    /// Appends to what is in a file of the program.
    pub fn append(&mut self, brick: &mut dyn Brick, file: &str, bytes: &[u8]) -> io::Result<()> {
        let held: usize = self
            .written
            .iter()
            .map(|(name, bytes)| name.len() + bytes.len())
            .sum();
        if held + file.len() + bytes.len() > limits::SCRIPT_FILES_BYTES {
            return Err(io::Error::other(format!(
                "the files of a judged program hold at most {} MiB",
                limits::SCRIPT_FILES_BYTES >> 20
            )));
        }
        let whole = self.written.entry(file.to_owned()).or_default();
        whole.extend_from_slice(bytes);
        let text = &*String::from_utf8_lossy(bytes);
        brick.command(Command::Append { file, text });
        Ok(())
    }

    /// Removes a file of the program.
    pub fn remove(&mut self, brick: &mut dyn Brick, file: &str) {
        self.written.remove(file);
        brick.command(Command::Remove { file });
    }
}

fn is_sort(name: &str, way: Direction, sort: Sort) -> bool {
    port(name, way).is_some_and(|port| port.sort() == sort)
}

/// A file of readings of a device.
fn reading(brick: &mut dyn Brick, device: Device, file: &str) -> io::Result<String> {
    let mut several = |least| vector(brick, device, least);
    Ok(match device {
        Device::Gyroscope => {
            let all = several(HEADING + 1).ok_or_else(unplugged)?;
            match file {
                "tilt" => joined(all[4..6].iter().copied()),
                "heading" => all[HEADING].to_string(),
                _ => joined(all[..3].iter().copied()),
            }
        }
        Device::Accelerometer => joined(several(3).ok_or_else(unplugged)?),
        Device::Lidar if file == "value" => joined(several(0).ok_or_else(unplugged)?),
        Device::LineSensor => joined(several(3).unwrap_or_else(|| vec![0; 3])),
        Device::ColorSensor => {
            let all = several(3).unwrap_or_else(|| vec![0; 3]);
            let colour = all[..3]
                .iter()
                .fold(0, |sum, part| sum << 8 | (part & 0xff));
            joined([colour; CELLS])
        }
        Device::ObjectSensor(_) => joined(
            [ObjectPart::X, ObjectPart::Y, ObjectPart::Size]
                .map(|part| scalar(brick, Device::ObjectSensor(part)).unwrap_or(0)),
        ),
        Device::Button(_) if file == "value" => joined(keys(brick)),
        Device::Gamepad(GamepadPart::Connected) => return Err(absent()),
        Device::Gamepad(part) => gamepad(brick, part, file)?,
        // Of the first four each port has a directory; the others have no such file.
        Device::Motor
        | Device::Servo
        | Device::Encoder
        | Device::Plugged
        | Device::Lidar
        | Device::Button(_) => return Err(absent()),
    })
}

fn gamepad(brick: &mut dyn Brick, part: GamepadPart, file: &str) -> io::Result<String> {
    let mut number = |part| scalar(brick, Device::Gamepad(part));
    let is_connected = number(GamepadPart::Connected).unwrap_or(0) != 0;
    Ok(match part {
        GamepadPart::Place(pad) | GamepadPart::Pressed(pad) if file == "value" => {
            let pressed = number(GamepadPart::Pressed(pad)).unwrap_or(0);
            let at = vector(brick, Device::Gamepad(GamepadPart::Place(pad)), 2);
            let at = at.unwrap_or_else(|| vec![RELEASED; 2]);
            joined([at[0], at[1], i32::from(pressed != 0)])
        }
        GamepadPart::Wheel if file == "value" => {
            number(GamepadPart::Wheel).unwrap_or(RELEASED).to_string()
        }
        GamepadPart::Button(_) if is_connected && ["value", "presses"].contains(&file) => {
            joined([1, 2, 3, 4, 5].map(|button| number(GamepadPart::Button(button)).unwrap_or(0)))
        }
        GamepadPart::Place(_)
        | GamepadPart::Pressed(_)
        | GamepadPart::Wheel
        | GamepadPart::Button(_)
        | GamepadPart::Connected => return Err(nothing_yet()),
    })
}
