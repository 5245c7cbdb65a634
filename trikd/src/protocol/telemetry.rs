//! Requests and answers of the telemetry port 9000.
//!
//! Owns the exact shape of the answers: a desktop client crashes on an entry without a colon and on a semicolon at the
//! end. Where a value cannot be read its place is empty.

use std::fmt::Write;

/// Keys in the order and by the names of this protocol.
pub const KEYS: [&str; 7] = ["Left", "Up", "Down", "Enter", "Right", "Power", "Esc"];

/// What a piece of a recording begins with.
pub const STREAM: &[u8] = b"stream:";

/// What a client asks for.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Request<'a> {
    /// Nothing.
    Keepalive,
    /// The version of the protocol.
    Version,
    /// Everything.
    Data,
    /// Names of ports.
    Ports,
    /// One key.
    Key(&'a str),
    /// One sensor.
    Sensor(&'a str),
    /// Everything that happens, from now on, as a recording: which nodes, and how often.
    Stream(&'a str),
    /// The last minutes, as a recording.
    Box,
    /// Something else.
    Unknown,
}

impl<'a> Request<'a> {
    /// What a frame asks for.
    pub fn parse(frame: &'a [u8]) -> Self {
        let Ok(text) = std::str::from_utf8(frame) else {
            return Self::Unknown;
        };
        match text {
            "keepalive" => return Self::Keepalive,
            "version" => return Self::Version,
            _ => {}
        }
        if text.starts_with("data") {
            return Self::Data;
        }
        if text.starts_with("ports") {
            return Self::Ports;
        }
        if text == "box" {
            return Self::Box;
        }
        if let Some(wanted) = text.strip_prefix("stream:") {
            return Self::Stream(wanted);
        }
        match text.strip_prefix("sensor:") {
            Some(name) => name
                .strip_prefix("button:")
                .map_or(Self::Sensor(name), Self::Key),
            None => Self::Unknown,
        }
    }
}

/// Numbers of one device; None: it cannot be read.
pub type Reading = Option<Vec<i32>>;

/// One port with its reading and raw reading.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// The reading.
    pub value: Option<i32>,
    /// The raw reading.
    pub raw: Option<i32>,
}

/// The gamepad.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Gamepad {
    /// Whether one is there.
    pub is_connected: bool,
    /// Buttons 1 to 5.
    pub buttons: [bool; 5],
    /// The steering wheel; None before it was moved.
    pub wheel: Option<i32>,
    /// Pads 1 and 2 while they are touched.
    pub pads: [Option<(i32, i32)>; 2],
}

/// Everything that the robot senses, at about one time.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Snapshot {
    /// Analog inputs.
    pub analog: Vec<Port>,
    /// Distances.
    pub digital: Vec<Port>,
    /// Encoders.
    pub encoders: Vec<Port>,
    /// x, y, z.
    pub accelerometer: Reading,
    /// Seven numbers.
    pub gyroscope: Reading,
    /// The gamepad.
    pub gamepad: Gamepad,
    /// In the order of [`KEYS`].
    pub keys: [bool; KEYS.len()],
}

/// What stands for a wheel or pad that nobody has touched.
const UNTOUCHED: i32 = -101;

fn text(number: Option<i32>) -> String {
    number.map_or_else(String::new, |number| number.to_string())
}

fn vector_of(numbers: &[i32]) -> String {
    let words: Vec<_> = numbers.iter().map(i32::to_string).collect();
    format!("({})", words.join(","))
}

/// The words of any node: one as it is, several as a vector. What the protocol separates with is not in them.
pub fn list(text: &str) -> String {
    let words: Vec<String> = text
        .split_whitespace()
        .map(|word| word.replace([':', ';', ','], "_"))
        .collect();
    match &words[..] {
        [one] => one.clone(),
        several => format!("({})", several.join(",")),
    }
}

fn vector(reading: &Reading) -> String {
    reading.as_deref().map_or_else(String::new, vector_of)
}

impl Snapshot {
    fn ports(&self) -> impl Iterator<Item = &Port> {
        self.analog
            .iter()
            .chain(&self.digital)
            .chain(&self.encoders)
    }

    /// The answer to `data`.
    pub fn all_data(&self) -> String {
        let mut answer = "allData:".to_owned();
        for port in self.ports() {
            let _ = write!(
                answer,
                "{}:{}:{};",
                port.name,
                text(port.value),
                text(port.raw)
            );
        }
        let _ = write!(
            answer,
            "AccelerometerPort:{};GyroscopePort:{}",
            vector(&self.accelerometer),
            vector(&self.gyroscope)
        );
        for name in GAMEPAD {
            let _ = write!(
                answer,
                ";{name}:{}",
                self.gamepad.named(name).unwrap_or_default()
            );
        }
        for (name, is_pressed) in KEYS.iter().zip(self.keys) {
            let _ = write!(answer, ";{name}:{}", u8::from(is_pressed));
        }
        answer
    }

    /// The answer to `ports`.
    pub fn port_names(&self) -> String {
        let names = |ports: &[Port]| {
            let names: Vec<_> = ports.iter().map(|port| port.name.as_str()).collect();
            names.join(",")
        };
        format!(
            "ports:analog:{};digital:{};special:;encoders:{}",
            names(&self.analog),
            names(&self.digital),
            names(&self.encoders)
        )
    }

    /// The answer to `sensor:` of this name; the value of a name that is not known is empty.
    pub fn sensor(&self, name: &str) -> String {
        let axis = |reading: &Reading, port: &str| {
            let index = ["X", "Y", "Z"]
                .iter()
                .position(|axis| name.strip_prefix(port) == Some(*axis))?;
            reading.as_ref()?.get(index).copied()
        };
        let value = if name.starts_with("Gamepad") {
            self.gamepad.named(name).unwrap_or_default()
        } else if name.starts_with("AccelerometerPort") {
            text(axis(&self.accelerometer, "AccelerometerPort"))
        } else if name.starts_with("GyroscopePort") {
            text(axis(&self.gyroscope, "GyroscopePort"))
        } else {
            text(
                self.ports()
                    .find(|port| port.name == name)
                    .and_then(|port| port.value),
            )
        };
        format!("sensor:{name}:{value}")
    }

    /// The answer to `sensor:button:` of this name.
    pub fn key(&self, name: &str) -> String {
        let index = KEYS.iter().position(|key| *key == name);
        let value = index.map(|index| i32::from(self.keys[index]));
        format!("sensor:{name}:{}", text(value))
    }

    /// One JSON object, as PlotJuggler's UDP source reads it; what cannot be read is not in it.
    pub fn json(&self, time_s: f64) -> String {
        let mut json = format!("{{\"timestamp\":{time_s:.6}");
        for (group, ports) in [
            ("analog", &self.analog),
            ("digital", &self.digital),
            ("encoders", &self.encoders),
        ] {
            let known: Vec<_> = ports
                .iter()
                .filter_map(|port| Some(format!("\"{}\":{}", port.name, port.value?)))
                .collect();
            let _ = write!(json, ",\"{group}\":{{{}}}", known.join(","));
        }
        for (name, reading) in [
            ("accelerometer", &self.accelerometer),
            ("gyroscope", &self.gyroscope),
        ] {
            if let Some(numbers) = reading {
                let words: Vec<_> = numbers.iter().map(i32::to_string).collect();
                let _ = write!(json, ",\"{name}\":[{}]", words.join(","));
            }
        }
        let keys: Vec<_> = KEYS
            .iter()
            .zip(self.keys)
            .map(|(name, is_pressed)| format!("\"{name}\":{}", u8::from(is_pressed)))
            .collect();
        let _ = write!(json, ",\"keys\":{{{}}}}}", keys.join(","));
        json
    }
}

/// Names of what a gamepad has, in the order of `data`.
const GAMEPAD: [&str; 11] = [
    "GamepadButton1Port",
    "GamepadButton2Port",
    "GamepadButton3Port",
    "GamepadButton4Port",
    "GamepadButton5Port",
    "GamepadWheelPort",
    "GamepadConnectionIndicatorPort",
    "GamepadPad1PressedPort",
    "GamepadPad2PressedPort",
    "GamepadPad1PosPort",
    "GamepadPad2PosPort",
];

impl Gamepad {
    /// The value of one of [`GAMEPAD`].
    fn named(&self, name: &str) -> Option<String> {
        let index = GAMEPAD.iter().position(|known| *known == name)?;
        let flag = |is_set: bool| u8::from(is_set).to_string();
        let place = |pad: Option<(i32, i32)>| {
            let (x, y) = pad.unwrap_or((UNTOUCHED, UNTOUCHED));
            vector_of(&[x, y])
        };
        Some(match index {
            0..=4 => flag(self.buttons[index]),
            5 => self.wheel.unwrap_or(UNTOUCHED).to_string(),
            6 => flag(self.is_connected),
            7 | 8 => flag(self.pads[index - 7].is_some()),
            _ => place(self.pads[index - 9]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn port(name: &str, value: i32, raw: Option<i32>) -> Port {
        Port {
            name: name.to_owned(),
            value: Some(value),
            raw,
        }
    }

    fn snapshot() -> Snapshot {
        Snapshot {
            analog: vec![
                port("A1", 27, Some(281)),
                Port {
                    name: "A2".to_owned(),
                    ..Port::default()
                },
            ],
            digital: vec![port("D1", -1, Some(-1))],
            encoders: vec![port("E1", 90, None)],
            accelerometer: Some(vec![1, -2, 1000]),
            gyroscope: None,
            gamepad: Gamepad {
                is_connected: true,
                buttons: [false, true, false, false, false],
                wheel: None,
                pads: [Some((-5, 100)), None],
            },
            keys: [true, false, false, false, false, false, false],
        }
    }

    #[test]
    fn all_data_has_the_exact_shape() {
        assert_eq!(
            snapshot().all_data(),
            "allData:A1:27:281;A2::;D1:-1:-1;E1:90:;AccelerometerPort:(1,-2,1000);GyroscopePort:;\
             GamepadButton1Port:0;GamepadButton2Port:1;GamepadButton3Port:0;GamepadButton4Port:0;GamepadButton5Port:0;\
             GamepadWheelPort:-101;GamepadConnectionIndicatorPort:1;GamepadPad1PressedPort:1;GamepadPad2PressedPort:0;\
             GamepadPad1PosPort:(-5,100);GamepadPad2PosPort:(-101,-101);\
             Left:1;Up:0;Down:0;Enter:0;Right:0;Power:0;Esc:0"
        );
        let empty = Snapshot::default().all_data();
        assert!(empty.split(';').all(|entry| entry.contains(':')), "{empty}");
    }

    #[test]
    fn one_sensor_is_asked_for_by_its_name() {
        for (name, answer) in [
            ("A1", "sensor:A1:27"),
            ("A2", "sensor:A2:"),
            ("Z9", "sensor:Z9:"),
            ("", "sensor::"),
            ("AccelerometerPortZ", "sensor:AccelerometerPortZ:1000"),
            ("AccelerometerPortQ", "sensor:AccelerometerPortQ:"),
            ("GyroscopePortX", "sensor:GyroscopePortX:"),
            ("GamepadFoo", "sensor:GamepadFoo:"),
            ("GamepadPad1PosPort", "sensor:GamepadPad1PosPort:(-5,100)"),
        ] {
            assert_eq!(snapshot().sensor(name), answer);
        }
        assert_eq!(snapshot().key("Left"), "sensor:Left:1");
        assert_eq!(snapshot().key("Any"), "sensor:Any:");
        assert_eq!(
            snapshot().port_names(),
            "ports:analog:A1,A2;digital:D1;special:;encoders:E1"
        );
    }

    #[test]
    fn requests_are_told_by_their_beginning() {
        assert_eq!(Request::parse(b"dataXYZ"), Request::Data);
        assert_eq!(Request::parse(b"ports?"), Request::Ports);
        assert_eq!(Request::parse(b"sensor:button:Left"), Request::Key("Left"));
        assert_eq!(Request::parse(b"sensor:A1"), Request::Sensor("A1"));
        for unknown in [&b"button:Left"[..], b"", b"Data", b"\xff"] {
            assert_eq!(Request::parse(unknown), Request::Unknown);
        }
    }

    #[test]
    fn json_leaves_out_what_is_not_known() {
        let json = snapshot().json(1.5);
        let start = "{\"timestamp\":1.500000,\"analog\":{\"A1\":27},\"digital\":{\"D1\":-1},\"encoders\":{\"E1\":90},\"accelerometer\":[1,-2,1000],\"keys\":{\"Left\":1,";
        assert!(
            json.starts_with(start) && json.ends_with("\"Esc\":0}}"),
            "{json}"
        );
        assert!(!json.contains("gyroscope"));
    }
}
