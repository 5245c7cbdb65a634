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

/// One port, as an index into the table.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub struct Port(u8);

struct Line {
    name: &'static str,
    way: Direction,
    sort: Sort,
    /// The variable that shows it, or nothing.
    variable: &'static str,
}

const fn line(name: &'static str, way: Direction, sort: Sort, variable: &'static str) -> Line {
    Line {
        name,
        way,
        sort,
        variable,
    }
}

const PORTS: &[Line] = &[
    line("M1", Direction::Out, Sort::Motor, ""),
    line("M2", Direction::Out, Sort::Motor, ""),
    line("M3", Direction::Out, Sort::Motor, ""),
    line("M4", Direction::Out, Sort::Motor, ""),
    line("S1", Direction::Out, Sort::Servo, ""),
    line("S2", Direction::Out, Sort::Servo, ""),
    line("S3", Direction::Out, Sort::Servo, ""),
    line("S4", Direction::Out, Sort::Servo, ""),
    line("S5", Direction::Out, Sort::Servo, ""),
    line("S6", Direction::Out, Sort::Servo, ""),
    line("E1", Direction::In, Sort::Encoder, "encoder1"),
    line("E2", Direction::In, Sort::Encoder, "encoder2"),
    line("E3", Direction::In, Sort::Encoder, "encoder3"),
    line("E4", Direction::In, Sort::Encoder, "encoder4"),
    line("A1", Direction::In, Sort::Scalar, "sensorA1"),
    line("A2", Direction::In, Sort::Scalar, "sensorA2"),
    line("A3", Direction::In, Sort::Scalar, "sensorA3"),
    line("A4", Direction::In, Sort::Scalar, "sensorA4"),
    line("A5", Direction::In, Sort::Scalar, "sensorA5"),
    line("A6", Direction::In, Sort::Scalar, "sensorA6"),
    line("D1", Direction::In, Sort::Scalar, "sensorD1"),
    line("D2", Direction::In, Sort::Scalar, "sensorD2"),
    line("F1", Direction::In, Sort::Scalar, "sensorF1"),
    line("GyroscopePort", Direction::In, Sort::Vector, "gyroscope"),
    line(
        "AccelerometerPort",
        Direction::In,
        Sort::Vector,
        "accelerometer",
    ),
    line("LineSensorPort", Direction::In, Sort::Vector, "lineSensor"),
    line(
        "ColorSensorPort",
        Direction::In,
        Sort::Vector,
        "colorSensor",
    ),
    line(
        "ObjectSensorXPort",
        Direction::In,
        Sort::Scalar,
        "objectSensorX",
    ),
    line(
        "ObjectSensorYPort",
        Direction::In,
        Sort::Scalar,
        "objectSensorY",
    ),
    line(
        "ObjectSensorSizePort",
        Direction::In,
        Sort::Scalar,
        "objectSensorSize",
    ),
    line("LidarPort", Direction::In, Sort::Vector, "lidar"),
    line("Left", Direction::In, Sort::Button(105), "buttonLeft"),
    line("Right", Direction::In, Sort::Button(106), "buttonRight"),
    line("Up", Direction::In, Sort::Button(103), "buttonUp"),
    line("Down", Direction::In, Sort::Button(108), "buttonDown"),
    line("Enter", Direction::In, Sort::Button(28), "buttonEnter"),
    line("Esc", Direction::In, Sort::Button(1), "buttonEsc"),
    line("Power", Direction::In, Sort::Button(116), "buttonPower"),
    line(
        "GamepadPad1PosPort",
        Direction::In,
        Sort::Vector,
        "gamepadPad1",
    ),
    line(
        "GamepadPad2PosPort",
        Direction::In,
        Sort::Vector,
        "gamepadPad2",
    ),
    line(
        "GamepadPad1PressedPort",
        Direction::In,
        Sort::Scalar,
        "gamepadPad1Pressed",
    ),
    line(
        "GamepadPad2PressedPort",
        Direction::In,
        Sort::Scalar,
        "gamepadPad2Pressed",
    ),
    line(
        "GamepadWheelPort",
        Direction::In,
        Sort::Scalar,
        "gamepadWheel",
    ),
    line(
        "GamepadButton1Port",
        Direction::In,
        Sort::Scalar,
        "gamepadButton1",
    ),
    line(
        "GamepadButton2Port",
        Direction::In,
        Sort::Scalar,
        "gamepadButton2",
    ),
    line(
        "GamepadButton3Port",
        Direction::In,
        Sort::Scalar,
        "gamepadButton3",
    ),
    line(
        "GamepadButton4Port",
        Direction::In,
        Sort::Scalar,
        "gamepadButton4",
    ),
    line(
        "GamepadButton5Port",
        Direction::In,
        Sort::Scalar,
        "gamepadButton5",
    ),
    line(
        "GamepadConnectionIndicatorPort",
        Direction::In,
        Sort::Scalar,
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

    /// What it gives or takes.
    pub fn sort(self) -> Sort {
        PORTS[usize::from(self.0)].sort
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
            row.way == way && (row.name == name || row.name == button)
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
