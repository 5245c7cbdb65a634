//! Ports of TRIK: their names, the other names that people type, and the variables that show them.
//!
//! Owns the table and the look-ups for both kits. Knows neither devices nor expressions.
//!
//! Names of V62 are the canonical ones: encoder `B1` of V6 is `E1` here, its servo `E1` is `S1`.
//! Cyrillic letters that look like Latin ones count as those.

pub use lang_expr::Kit;

/// Which way a port works.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Direction {
    /// The robot is told something.
    Out,
    /// The robot tells something.
    In,
}

/// What a port gives or takes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Sort {
    /// Power of a motor.
    Motor,
    /// Angle of a servo.
    Servo,
    /// Degrees of an encoder.
    Encoder,
    /// One number.
    Scalar,
    /// Several numbers.
    Vector,
    /// A button with its code.
    Button(i32),
}

/// What stands at a port. What gives readings names all of these, so a new one does not compile until each does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Device {
    /// A motor.
    Motor,
    /// A servo.
    Servo,
    /// An encoder.
    Encoder,
    /// Whatever is plugged in there; it says one number.
    Plugged,
    /// The gyroscope.
    Gyroscope,
    /// The accelerometer.
    Accelerometer,
    /// Where the camera sees a line.
    LineSensor,
    /// What colour the camera sees.
    ColorSensor,
    /// A number of the object that the camera sees.
    ObjectSensor(ObjectPart),
    /// The lidar.
    Lidar,
    /// A button of the board with its code.
    Button(i32),
    /// A part of the gamepad.
    Gamepad(GamepadPart),
}

/// A number of an object that the camera sees.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ObjectPart {
    /// From the middle to the right.
    X,
    /// From the middle downwards.
    Y,
    /// How large it is.
    Size,
}

/// A pad of the gamepad.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Pad {
    /// The left one.
    One,
    /// The right one.
    Two,
}

/// A part of the gamepad.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum GamepadPart {
    /// Where a pad is touched.
    Place(Pad),
    /// Whether a pad is touched.
    Pressed(Pad),
    /// The wheel.
    Wheel,
    /// A button, 1 to 5.
    Button(u8),
    /// Whether there is a gamepad.
    Connected,
}

impl Pad {
    /// Its number, from 1.
    pub fn number(self) -> usize {
        match self {
            Self::One => 1,
            Self::Two => 2,
        }
    }
}

impl Device {
    /// What it gives or takes.
    pub fn sort(self) -> Sort {
        match self {
            Self::Motor => Sort::Motor,
            Self::Servo => Sort::Servo,
            Self::Encoder => Sort::Encoder,
            Self::Button(code) => Sort::Button(code),
            Self::Gyroscope
            | Self::Accelerometer
            | Self::LineSensor
            | Self::ColorSensor
            | Self::Lidar
            | Self::Gamepad(GamepadPart::Place(_)) => Sort::Vector,
            Self::Plugged
            | Self::ObjectSensor(_)
            | Self::Gamepad(
                GamepadPart::Pressed(_)
                | GamepadPart::Wheel
                | GamepadPart::Button(_)
                | GamepadPart::Connected,
            ) => Sort::Scalar,
        }
    }

    fn way(self) -> Direction {
        match self.sort() {
            Sort::Motor | Sort::Servo => Direction::Out,
            Sort::Encoder | Sort::Scalar | Sort::Vector | Sort::Button(_) => Direction::In,
        }
    }
}

/// One port, as an index into the table.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub struct Port(u8);

struct Line {
    name: &'static str,
    device: Device,
    /// The variable that shows it, or nothing.
    variable: &'static str,
}

const fn line(name: &'static str, device: Device, variable: &'static str) -> Line {
    Line {
        name,
        device,
        variable,
    }
}

const PORTS: &[Line] = &[
    line("M1", Device::Motor, ""),
    line("M2", Device::Motor, ""),
    line("M3", Device::Motor, ""),
    line("M4", Device::Motor, ""),
    line("S1", Device::Servo, ""),
    line("S2", Device::Servo, ""),
    line("S3", Device::Servo, ""),
    line("S4", Device::Servo, ""),
    line("S5", Device::Servo, ""),
    line("S6", Device::Servo, ""),
    line("E1", Device::Encoder, "encoder1"),
    line("E2", Device::Encoder, "encoder2"),
    line("E3", Device::Encoder, "encoder3"),
    line("E4", Device::Encoder, "encoder4"),
    line("A1", Device::Plugged, "sensorA1"),
    line("A2", Device::Plugged, "sensorA2"),
    line("A3", Device::Plugged, "sensorA3"),
    line("A4", Device::Plugged, "sensorA4"),
    line("A5", Device::Plugged, "sensorA5"),
    line("A6", Device::Plugged, "sensorA6"),
    line("D1", Device::Plugged, "sensorD1"),
    line("D2", Device::Plugged, "sensorD2"),
    line("F1", Device::Plugged, "sensorF1"),
    line("GyroscopePort", Device::Gyroscope, "gyroscope"),
    line("AccelerometerPort", Device::Accelerometer, "accelerometer"),
    line("LineSensorPort", Device::LineSensor, "lineSensor"),
    line("ColorSensorPort", Device::ColorSensor, "colorSensor"),
    line(
        "ObjectSensorXPort",
        Device::ObjectSensor(ObjectPart::X),
        "objectSensorX",
    ),
    line(
        "ObjectSensorYPort",
        Device::ObjectSensor(ObjectPart::Y),
        "objectSensorY",
    ),
    line(
        "ObjectSensorSizePort",
        Device::ObjectSensor(ObjectPart::Size),
        "objectSensorSize",
    ),
    line("LidarPort", Device::Lidar, "lidar"),
    line("Left", Device::Button(105), "buttonLeft"),
    line("Right", Device::Button(106), "buttonRight"),
    line("Up", Device::Button(103), "buttonUp"),
    line("Down", Device::Button(108), "buttonDown"),
    line("Enter", Device::Button(28), "buttonEnter"),
    line("Esc", Device::Button(1), "buttonEsc"),
    line("Power", Device::Button(116), "buttonPower"),
    line(
        "GamepadPad1PosPort",
        Device::Gamepad(GamepadPart::Place(Pad::One)),
        "gamepadPad1",
    ),
    line(
        "GamepadPad2PosPort",
        Device::Gamepad(GamepadPart::Place(Pad::Two)),
        "gamepadPad2",
    ),
    line(
        "GamepadPad1PressedPort",
        Device::Gamepad(GamepadPart::Pressed(Pad::One)),
        "gamepadPad1Pressed",
    ),
    line(
        "GamepadPad2PressedPort",
        Device::Gamepad(GamepadPart::Pressed(Pad::Two)),
        "gamepadPad2Pressed",
    ),
    line(
        "GamepadWheelPort",
        Device::Gamepad(GamepadPart::Wheel),
        "gamepadWheel",
    ),
    line(
        "GamepadButton1Port",
        Device::Gamepad(GamepadPart::Button(1)),
        "gamepadButton1",
    ),
    line(
        "GamepadButton2Port",
        Device::Gamepad(GamepadPart::Button(2)),
        "gamepadButton2",
    ),
    line(
        "GamepadButton3Port",
        Device::Gamepad(GamepadPart::Button(3)),
        "gamepadButton3",
    ),
    line(
        "GamepadButton4Port",
        Device::Gamepad(GamepadPart::Button(4)),
        "gamepadButton4",
    ),
    line(
        "GamepadButton5Port",
        Device::Gamepad(GamepadPart::Button(5)),
        "gamepadButton5",
    ),
    line(
        "GamepadConnectionIndicatorPort",
        Device::Gamepad(GamepadPart::Connected),
        "gamepadConnected",
    ),
];

/// Other names of camera ports, from several versions of the editor.
const CAMERA: &[(&str, &str)] = &[
    ("Video2Port", "LineSensorPort"),
    ("TrikLineSensorPort", "LineSensorPort"),
];

impl Port {
    /// Its canonical name.
    pub fn name(self) -> &'static str {
        PORTS[usize::from(self.0)].name
    }

    /// What stands there.
    pub fn device(self) -> Device {
        PORTS[usize::from(self.0)].device
    }

    /// What it gives or takes.
    pub fn sort(self) -> Sort {
        self.device().sort()
    }

    /// The variable that shows it.
    pub fn variable(self) -> Option<&'static str> {
        let name = PORTS[usize::from(self.0)].variable;
        (!name.is_empty()).then_some(name)
    }

    /// Its place in the table of ports.
    pub fn index(self) -> u8 {
        self.0
    }

    /// The port at a place in the table.
    pub fn at(index: u8) -> Option<Self> {
        (usize::from(index) < PORTS.len()).then_some(Self(index))
    }

    /// All ports.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..PORTS.len()).filter_map(|index| u8::try_from(index).ok().map(Self))
    }

    /// The port with a canonical name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|port| port.name() == name)
    }

    /// The first port at which a device stands.
    pub fn of(device: Device) -> Option<Self> {
        Self::all().find(|port| port.device() == device)
    }

    /// The port that a variable shows.
    pub fn shown_by(variable: &str) -> Option<Self> {
        Self::all().find(|port| port.variable() == Some(variable))
    }

    /// The port that a text means in a kit, if it works that way.
    pub fn find(kit: Kit, text: &str, way: Direction) -> Option<Self> {
        let mut name = latin(text.trim())?;
        let number = name.chars().nth(1).filter(char::is_ascii_digit);
        if name.len() == 2 && number.is_some() {
            // Of letters that stand for others, by the way in which the port is used.
            let letter = match (name.as_bytes()[0], way, kit) {
                (b'M' | b'B', Direction::In, _) => Some('E'),
                (b'J', Direction::In, _) => Some('A'),
                (b'E' | b'C', Direction::Out, Kit::V6) => Some('S'),
                (b'E', Direction::In, _) => None,
                _ => None,
            };
            if let Some(letter) = letter {
                name.replace_range(..1, letter.encode_utf8(&mut [0; 4]));
            }
        }
        let name = CAMERA
            .iter()
            .find(|(other, _)| *other == name)
            .map_or(name.as_str(), |(_, canonical)| canonical);
        let button = name.strip_suffix("ButtonPort").unwrap_or(name);
        Self::all().find(|port| {
            let row = &PORTS[usize::from(port.0)];
            row.device.way() == way && (row.name == name || row.name == button)
        })
    }
}

/// The text with Latin letters instead of Cyrillic ones that look like them; `None` if it is longer than any name.
fn latin(text: &str) -> Option<String> {
    const LONGEST: usize = 40;
    if text.len() > LONGEST {
        return None;
    }
    let change = |letter| match letter {
        '\u{410}' => 'A',
        '\u{412}' => 'B',
        '\u{415}' => 'E',
        '\u{41c}' => 'M',
        '\u{421}' => 'C',
        other => other,
    };
    Some(text.chars().map(change).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(kit: Kit, text: &str, way: Direction) -> Option<&'static str> {
        Port::find(kit, text, way).map(Port::name)
    }

    #[test]
    fn names_are_found_in_both_kits_and_with_cyrillic_letters() {
        for kit in [Kit::V6, Kit::V62] {
            assert_eq!(found(kit, " M3 ", Direction::Out), Some("M3"));
            assert_eq!(found(kit, "\u{41c}3", Direction::Out), Some("M3"));
            assert_eq!(found(kit, "B1", Direction::In), Some("E1"));
            assert_eq!(found(kit, "M4", Direction::In), Some("E4"));
            assert_eq!(found(kit, "\u{410}1", Direction::In), Some("A1"));
            assert_eq!(found(kit, "LeftButtonPort", Direction::In), Some("Left"));
            assert_eq!(found(kit, "Esc", Direction::In), Some("Esc"));
            assert_eq!(found(kit, "A1", Direction::Out), None);
            assert_eq!(found(kit, "", Direction::In), None);
            assert_eq!(found(kit, "M9", Direction::Out), None);
        }
        assert_eq!(found(Kit::V6, "E1", Direction::Out), Some("S1"));
        assert_eq!(found(Kit::V62, "E1", Direction::Out), None);
        assert_eq!(found(Kit::V62, "E1", Direction::In), Some("E1"));
        assert_eq!(found(Kit::V62, &"M".repeat(1000), Direction::Out), None);
    }

    #[test]
    fn variables_show_ports() {
        for port in Port::all() {
            if let Some(variable) = port.variable() {
                assert_eq!(Port::shown_by(variable), Some(port));
            }
            assert_eq!(Port::named(port.name()), Some(port));
        }
        assert_eq!(Port::shown_by("sensorA1").map(Port::name), Some("A1"));
        assert_eq!(Port::shown_by(""), None);
    }
}
