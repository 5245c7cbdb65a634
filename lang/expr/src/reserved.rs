//! Names that belong to the robot: ports, sensor variables, buttons, the gamepad, functions.
//!
//! From the real program's kits TRIK V6 and V62. Knows no values of sensors.

/// A kit that a diagram is drawn for.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Kit {
    /// The controller of 2014: encoders B1 to B4, servos C1 to C3 and E1 to E3.
    V6,
    /// The controller since 2015: encoders E1 to E4, servos S1 to S6.
    #[default]
    V62,
}

impl Kit {
    /// The kit of `lastKitId` in metaInfo.xml, if it is one of TRIK.
    pub fn of_id(id: &str) -> Option<Self> {
        match id {
            "trikV6Kit" => Some(Self::V6),
            "trikV62Kit" => Some(Self::V62),
            _ => None,
        }
    }

    /// What `lastKitId` calls it.
    pub fn id(self) -> &'static str {
        match self {
            Self::V6 => "trikV6Kit",
            Self::V62 => "trikV62Kit",
        }
    }
}

/// What a sensor variable holds.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Shape {
    /// One whole number.
    Number,
    /// A table of so many whole numbers.
    Numbers(usize),
}

/// A variable that the robot refreshes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Sensor {
    /// Its name in expressions.
    pub name: &'static str,
    /// What it holds.
    pub shape: Shape,
}

/// Index of a sensor variable in [`SENSORS`].
pub type SensorIndex = u16;

const fn one(name: &'static str) -> Sensor {
    Sensor {
        name,
        shape: Shape::Number,
    }
}

const fn many(name: &'static str, count: usize) -> Sensor {
    Sensor {
        name,
        shape: Shape::Numbers(count),
    }
}

/// All sensor variables; what asks for a value names it by its index here.
pub const SENSORS: [Sensor; 38] = [
    one("sensorA1"),
    one("sensorA2"),
    one("sensorA3"),
    one("sensorA4"),
    one("sensorA5"),
    one("sensorA6"),
    one("sensorD1"),
    one("sensorD2"),
    one("encoder1"),
    one("encoder2"),
    one("encoder3"),
    one("encoder4"),
    many("gyroscope", 7),
    many("accelerometer", 3),
    many("lineSensor", 3),
    many("colorSensor", 3),
    one("objectSensorX"),
    one("objectSensorY"),
    one("objectSensorSize"),
    many("lidar", 360),
    one("buttonLeft"),
    one("buttonRight"),
    one("buttonUp"),
    one("buttonDown"),
    one("buttonEnter"),
    one("buttonEsc"),
    one("buttonPower"),
    one("gamepadButton1"),
    one("gamepadButton2"),
    one("gamepadButton3"),
    one("gamepadButton4"),
    one("gamepadButton5"),
    many("gamepadPad1", 2),
    many("gamepadPad2", 2),
    one("gamepadPad1Pressed"),
    one("gamepadPad2Pressed"),
    one("gamepadWheel"),
    one("gamepadConnected"),
];

/// Codes of the buttons on the controller, by the names that expressions have for them.
pub const BUTTONS: [(&str, i32); 7] = [
    ("LeftButton", 105),
    ("RightButton", 106),
    ("UpButton", 103),
    ("DownButton", 108),
    ("EnterButton", 28),
    ("PowerButton", 116),
    ("EscButton", 1),
];

/// Ports of both kits; the value of each name is the name.
pub const PORTS: [&str; 45] = [
    "M1",
    "M2",
    "M3",
    "M4",
    "MAll",
    "E1",
    "E2",
    "E3",
    "E4",
    "B1",
    "B2",
    "B3",
    "B4",
    "A1",
    "A2",
    "A3",
    "A4",
    "A5",
    "A6",
    "D1",
    "D2",
    "Video2Port",
    "LidarPort",
    "GyroscopePort",
    "AccelerometerPort",
    "DisplayPort",
    "SpeakerPort",
    "LedPort",
    "ShellPort",
    "CommunicatorPort",
    "RandomPort",
    "MarkerPort",
    "LeftButtonPort",
    "RightButtonPort",
    "UpButtonPort",
    "DownButtonPort",
    "EnterButtonPort",
    "EscButtonPort",
    "PowerButtonPort",
    "GamepadPad1PosPort",
    "GamepadPad2PosPort",
    "GamepadPad1PressedPort",
    "GamepadPad2PressedPort",
    "GamepadWheelPort",
    "GamepadConnectionIndicatorPort",
];

/// Ports that only one kit has.
pub fn ports_of(kit: Kit) -> &'static [&'static str] {
    match kit {
        Kit::V6 => &["C1", "C2", "C3"],
        Kit::V62 => &["S1", "S2", "S3", "S4", "S5", "S6"],
    }
}

/// Names with a Cyrillic letter that looks like the Latin one, and the port that each means.
pub fn look_alikes(kit: Kit) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut add = |letter: char, ports: &[&str]| {
        for port in ports {
            let digits = &port[1..];
            found.push((format!("{letter}{digits}"), (*port).to_owned()));
        }
    };
    // Cyrillic Em, A.
    add('\u{41c}', &["M1", "M2", "M3", "M4"]);
    add('\u{410}', &["A1", "A2", "A3", "A4", "A5", "A6"]);
    match kit {
        // Cyrillic Es, Ve.
        Kit::V6 => {
            add('\u{421}', &["C1", "C2", "C3"]);
            add('\u{412}', &["B1", "B2", "B3", "B4"]);
        }
        // Cyrillic Ie.
        Kit::V62 => add('\u{415}', &["E1", "E2", "E3", "E4"]),
    }
    found
}

/// A function of the language.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Function {
    /// `time()`: ms since the program began.
    Time,
    /// `sensor(port)`
    Sensor,
    /// `print(value)`
    Print,
    /// Sine of radians.
    Sin,
    /// Cosine of radians.
    Cos,
    /// Natural logarithm.
    Ln,
    /// e to a power.
    Exp,
    /// Arc sine in radians.
    Asin,
    /// Arc cosine in radians.
    Acos,
    /// Arc tangent in radians.
    Atan,
    /// -1, 0 or 1.
    Sgn,
    /// Square root.
    Sqrt,
    /// Without its sign.
    Abs,
    /// Up to a whole number.
    Ceil,
    /// Down to a whole number.
    Floor,
    /// `random(n)`: 0 to n - 1.
    Random,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
    /// `atan2(y, x)` in radians.
    Atan2,
}

/// How functions are called: name, types of arguments as letters (`i`, `f`, `s`, `a` for any), type of the result (`n`
/// for nothing).
pub const FUNCTIONS: [(&str, Function, &str, char); 19] = [
    ("time", Function::Time, "", 'i'),
    ("sensor", Function::Sensor, "s", 'i'),
    ("print", Function::Print, "a", 'n'),
    ("sin", Function::Sin, "f", 'f'),
    ("cos", Function::Cos, "f", 'f'),
    ("ln", Function::Ln, "f", 'f'),
    ("exp", Function::Exp, "f", 'f'),
    ("asin", Function::Asin, "f", 'f'),
    ("acos", Function::Acos, "f", 'f'),
    ("atan", Function::Atan, "f", 'f'),
    ("sgn", Function::Sgn, "f", 'i'),
    ("sqrt", Function::Sqrt, "f", 'f'),
    ("abs", Function::Abs, "f", 'f'),
    ("ceil", Function::Ceil, "f", 'i'),
    ("floor", Function::Floor, "f", 'i'),
    ("random", Function::Random, "i", 'i'),
    ("min", Function::Min, "ff", 'f'),
    ("max", Function::Max, "ff", 'f'),
    ("atan2", Function::Atan2, "ff", 'f'),
];
