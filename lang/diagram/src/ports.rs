//! Ports of TRIK: their names, the other names that people type, and the variables that show them.
//!
//! Owns the table and the look-ups for both kits. Knows neither devices nor expressions.
//!
//! Names of V62 are the canonical ones: encoder `B1` of V6 is `E1` here, its servo `E1` is `S1`.
//! Cyrillic letters that look like Latin ones count as those.

pub use lang_expr::Kit;

/// Which way a port works.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Way {
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
    way: Way,
    sort: Sort,
    /// The variable that shows it, or nothing.
    variable: &'static str,
}

const fn line(name: &'static str, way: Way, sort: Sort, variable: &'static str) -> Line {
    Line {
        name,
        way,
        sort,
        variable,
    }
}

const PORTS: &[Line] = &[
    line("M1", Way::Out, Sort::Motor, ""),
    line("M2", Way::Out, Sort::Motor, ""),
    line("M3", Way::Out, Sort::Motor, ""),
    line("M4", Way::Out, Sort::Motor, ""),
    line("S1", Way::Out, Sort::Servo, ""),
    line("S2", Way::Out, Sort::Servo, ""),
    line("S3", Way::Out, Sort::Servo, ""),
    line("S4", Way::Out, Sort::Servo, ""),
    line("S5", Way::Out, Sort::Servo, ""),
    line("S6", Way::Out, Sort::Servo, ""),
    line("E1", Way::In, Sort::Encoder, "encoder1"),
    line("E2", Way::In, Sort::Encoder, "encoder2"),
    line("E3", Way::In, Sort::Encoder, "encoder3"),
    line("E4", Way::In, Sort::Encoder, "encoder4"),
    line("A1", Way::In, Sort::Scalar, "sensorA1"),
    line("A2", Way::In, Sort::Scalar, "sensorA2"),
    line("A3", Way::In, Sort::Scalar, "sensorA3"),
    line("A4", Way::In, Sort::Scalar, "sensorA4"),
    line("A5", Way::In, Sort::Scalar, "sensorA5"),
    line("A6", Way::In, Sort::Scalar, "sensorA6"),
    line("D1", Way::In, Sort::Scalar, "sensorD1"),
    line("D2", Way::In, Sort::Scalar, "sensorD2"),
    line("F1", Way::In, Sort::Scalar, "sensorF1"),
    line("GyroscopePort", Way::In, Sort::Vector, "gyroscope"),
    line("AccelerometerPort", Way::In, Sort::Vector, "accelerometer"),
    line("LineSensorPort", Way::In, Sort::Vector, "lineSensor"),
    line("ColorSensorPort", Way::In, Sort::Vector, "colorSensor"),
    line("ObjectSensorXPort", Way::In, Sort::Scalar, "objectSensorX"),
    line("ObjectSensorYPort", Way::In, Sort::Scalar, "objectSensorY"),
    line(
        "ObjectSensorSizePort",
        Way::In,
        Sort::Scalar,
        "objectSensorSize",
    ),
    line("LidarPort", Way::In, Sort::Vector, "lidar"),
    line("Left", Way::In, Sort::Button(105), "buttonLeft"),
    line("Right", Way::In, Sort::Button(106), "buttonRight"),
    line("Up", Way::In, Sort::Button(103), "buttonUp"),
    line("Down", Way::In, Sort::Button(108), "buttonDown"),
    line("Enter", Way::In, Sort::Button(28), "buttonEnter"),
    line("Esc", Way::In, Sort::Button(1), "buttonEsc"),
    line("Power", Way::In, Sort::Button(116), "buttonPower"),
    line("GamepadPad1PosPort", Way::In, Sort::Vector, "gamepadPad1"),
    line("GamepadPad2PosPort", Way::In, Sort::Vector, "gamepadPad2"),
    line(
        "GamepadPad1PressedPort",
        Way::In,
        Sort::Scalar,
        "gamepadPad1Pressed",
    ),
    line(
        "GamepadPad2PressedPort",
        Way::In,
        Sort::Scalar,
        "gamepadPad2Pressed",
    ),
    line("GamepadWheelPort", Way::In, Sort::Scalar, "gamepadWheel"),
    line(
        "GamepadButton1Port",
        Way::In,
        Sort::Scalar,
        "gamepadButton1",
    ),
    line(
        "GamepadButton2Port",
        Way::In,
        Sort::Scalar,
        "gamepadButton2",
    ),
    line(
        "GamepadButton3Port",
        Way::In,
        Sort::Scalar,
        "gamepadButton3",
    ),
    line(
        "GamepadButton4Port",
        Way::In,
        Sort::Scalar,
        "gamepadButton4",
    ),
    line(
        "GamepadButton5Port",
        Way::In,
        Sort::Scalar,
        "gamepadButton5",
    ),
    line(
        "GamepadConnectionIndicatorPort",
        Way::In,
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
    pub fn find(kit: Kit, text: &str, way: Way) -> Option<Self> {
        let mut name = latin(text.trim())?;
        let number = name.chars().nth(1).filter(char::is_ascii_digit);
        if name.len() == 2 && number.is_some() {
            // Of letters that stand for others, by the way in which the port is used.
            let letter = match (name.as_bytes()[0], way, kit) {
                (b'M' | b'B', Way::In, _) => Some('E'),
                (b'J', Way::In, _) => Some('A'),
                (b'E' | b'C', Way::Out, Kit::V6) => Some('S'),
                (b'E', Way::In, _) => None,
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

/// The text with Latin letters in place of Cyrillic ones that look like them; `None` if it is longer than any name.
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

    fn found(kit: Kit, text: &str, way: Way) -> Option<&'static str> {
        Port::find(kit, text, way).map(Port::name)
    }

    #[test]
    fn names_are_found_in_both_kits_and_with_cyrillic_letters() {
        for kit in [Kit::V6, Kit::V62] {
            assert_eq!(found(kit, " M3 ", Way::Out), Some("M3"));
            assert_eq!(found(kit, "\u{41c}3", Way::Out), Some("M3"));
            assert_eq!(found(kit, "B1", Way::In), Some("E1"));
            assert_eq!(found(kit, "M4", Way::In), Some("E4"));
            assert_eq!(found(kit, "\u{410}1", Way::In), Some("A1"));
            assert_eq!(found(kit, "LeftButtonPort", Way::In), Some("Left"));
            assert_eq!(found(kit, "Esc", Way::In), Some("Esc"));
            assert_eq!(found(kit, "A1", Way::Out), None);
            assert_eq!(found(kit, "", Way::In), None);
            assert_eq!(found(kit, "M9", Way::Out), None);
        }
        assert_eq!(found(Kit::V6, "E1", Way::Out), Some("S1"));
        assert_eq!(found(Kit::V62, "E1", Way::Out), None);
        assert_eq!(found(Kit::V62, "E1", Way::In), Some("E1"));
        assert_eq!(found(Kit::V62, &"M".repeat(1000), Way::Out), None);
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
