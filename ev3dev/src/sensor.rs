//! Sensors: the class lego-sensor over the sensors of the tree.
//!
//! Owns the kinds of sensors: which driver a kind answers for, its modes, and how its values come from files of the tree.
//! While one of its files is open the file of the tree stays open, because some sensors of the tree measure only then.

use crate::device::{Attribute, Device, Shown, line, lock, no_such_word, read, read_write, write};
use crate::errno;
use crate::tree::{KeptFile, Tree};
use std::sync::Mutex;
use trikfs::errno::Error;

const ATTRIBUTES: [Attribute; 22] = [
    read("address"),
    read("bin_data"),
    read("bin_data_format"),
    write("command"),
    read("commands"),
    read("decimals"),
    read_write("direct"),
    read("driver_name"),
    read("fw_version"),
    read_write("mode"),
    read("modes"),
    read("num_values"),
    read_write("poll_ms"),
    read("units"),
    read("value0"),
    read("value1"),
    read("value2"),
    read("value3"),
    read("value4"),
    read("value5"),
    read("value6"),
    read("value7"),
];

/// What an ultrasonic sensor of EV3 says when nothing is in reach, in mm, and in tenths of an inch.
const US_NOTHING_MM: f64 = 2550.0;
const US_NOTHING_TENTH_INCH: f64 = 1003.0;
/// Distance that an infrared sensor of EV3 calls 100 percent.
const IR_FULL_CM: f64 = 70.0;
/// What python-ev3dev2 writes to `direct` of a gyroscope to begin at 0.
const GYRO_RESET: &str = "\u{11}";
/// A whole turn in mdeg.
const TURN_MDEG: f64 = 360_000.0;

/// How the values of a mode come about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Source {
    /// The numbers of `value`.
    Value,
    /// The number of the attribute `raw`.
    Raw,
    /// Ultrasonic: distance in mm.
    EchoMm,
    /// Ultrasonic: distance in tenths of an inch.
    EchoTenthInch,
    /// Infrared: share of [`IR_FULL_CM`] in percent, full where there is no signal.
    Proximity,
    /// Light: percent of white from percent of black.
    Reflection,
    /// Gyroscope: degrees clockwise since the mode was set.
    Angle,
    /// Gyroscope: degrees per second clockwise.
    Rate,
    /// Both.
    AngleAndRate,
    /// No values.
    Nothing,
}

/// A mode of a kind of sensor.
#[derive(Debug)]
struct Mode {
    name: &'static str,
    units: &'static str,
    decimals: u8,
    values: usize,
    from: Source,
}

const fn mode(
    name: &'static str,
    units: &'static str,
    decimals: u8,
    values: usize,
    from: Source,
) -> Mode {
    Mode {
        name,
        units,
        decimals,
        values,
        from,
    }
}

const ANALOG: [Mode; 2] = [
    mode("PERCENT", "pct", 0, 1, Source::Value),
    mode("RAW", "", 0, 1, Source::Raw),
];
const INFRARED: [Mode; 3] = [
    mode("IR-PROX", "pct", 0, 1, Source::Proximity),
    mode("DIST-CM", "cm", 0, 1, Source::Value),
    mode("RAW", "", 0, 1, Source::Raw),
];
const TOUCH: [Mode; 1] = [mode("TOUCH", "", 0, 1, Source::Value)];
const LIGHT: [Mode; 2] = [
    mode("COL-REFLECT", "pct", 0, 1, Source::Reflection),
    mode("RAW", "", 0, 1, Source::Raw),
];
const ULTRASONIC: [Mode; 4] = [
    mode("US-DIST-CM", "cm", 1, 1, Source::EchoMm),
    mode("US-DIST-IN", "in", 1, 1, Source::EchoTenthInch),
    mode("US-SI-CM", "cm", 1, 1, Source::EchoMm),
    mode("US-SI-IN", "in", 1, 1, Source::EchoTenthInch),
];
const GYROSCOPE: [Mode; 4] = [
    mode("GYRO-ANG", "deg", 0, 1, Source::Angle),
    mode("GYRO-RATE", "d/s", 0, 1, Source::Rate),
    mode("GYRO-G&A", "", 0, 2, Source::AngleAndRate),
    mode("GYRO-CAL", "", 0, 0, Source::Nothing),
];
const ACCELEROMETER: [Mode; 1] = [mode("ACCEL", "mg", 0, 3, Source::Value)];

/// A kind of sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Analog port with anything.
    Analog,
    /// Infrared distance.
    Infrared,
    /// Bumper.
    Touch,
    /// Reflected light.
    Light,
    /// Ultrasonic distance.
    Ultrasonic,
    /// Of the board.
    Gyroscope,
    /// Of the board.
    Accelerometer,
}

impl Kind {
    /// The kind of an analog sensor by the `format` of its node.
    pub fn of_format(format: &str) -> Self {
        match format.split_ascii_whitespace().nth(1) {
            Some("distance") => Self::Infrared,
            Some("touch") => Self::Touch,
            Some("darkness") => Self::Light,
            _ => Self::Analog,
        }
    }

    fn driver_name(self) -> &'static str {
        match self {
            Self::Analog => "trik-analog",
            Self::Infrared => "lego-ev3-ir",
            Self::Touch => "lego-ev3-touch",
            Self::Light => "lego-ev3-color",
            Self::Ultrasonic => "lego-ev3-us",
            Self::Gyroscope => "lego-ev3-gyro",
            Self::Accelerometer => "trik-accelerometer",
        }
    }

    /// The first is the one at the start.
    fn modes(self) -> &'static [Mode] {
        match self {
            Self::Analog => &ANALOG,
            Self::Infrared => &INFRARED,
            Self::Touch => &TOUCH,
            Self::Light => &LIGHT,
            Self::Ultrasonic => &ULTRASONIC,
            Self::Gyroscope => &GYROSCOPE,
            Self::Accelerometer => &ACCELEROMETER,
        }
    }
}

/// A sensor of the tree.
pub struct Sensor {
    address: String,
    kind: Kind,
    work: Mutex<Work>,
}

struct Work {
    /// Number in the list of modes.
    mode: usize,
    /// Open files of the view.
    open: u32,
    value: KeptFile,
    raw: KeptFile,
    heading: KeptFile,
    turn: Turn,
}

/// The angle of a gyroscope without the jump at half a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Turn {
    /// The heading before, none after a reset.
    heading: Option<f64>,
    mdeg: f64,
}

impl Turn {
    /// Takes the shorter way round, so it has to be asked at least every half a turn.
    fn take(&mut self, heading: f64) -> f64 {
        if let Some(before) = self.heading.replace(heading) {
            let way = heading - before;
            self.mdeg += way - TURN_MDEG * (way / TURN_MDEG).round();
        }
        self.mdeg
    }
}

impl Sensor {
    /// The sensor of a node such as `sensors/A1`.
    pub fn new(tree: &Tree, address: String, node: &str, kind: Kind) -> Self {
        let file = |name: &str| KeptFile::new(tree.clone(), format!("{node}/{name}"));
        Self {
            address,
            kind,
            work: Mutex::new(Work {
                mode: 0,
                open: 0,
                value: file("value"),
                raw: file("raw"),
                heading: file("heading"),
                turn: Turn::default(),
            }),
        }
    }

    fn mode(&self, work: &Work) -> &'static Mode {
        &self.kind.modes()[work.mode]
    }

    /// The values of the present mode.
    fn values(&self) -> Result<Vec<i32>, Error> {
        let mut work = lock(&self.work);
        let mode = self.mode(&work);
        let values = work.measure(mode.from);
        if work.open == 0 {
            work.close();
        }
        let mut values = values?;
        if values.len() < mode.values {
            return Err(errno::no_answer(format!(
                "{}: the tree gives {} values",
                self.address,
                values.len()
            )));
        }
        values.truncate(mode.values);
        Ok(values.iter().map(|value| value.round() as i32).collect())
    }

    fn set_mode(&self, text: &str) -> Result<(), Error> {
        let found = self.kind.modes().iter().position(|mode| mode.name == text);
        let mut work = lock(&self.work);
        let number = found.ok_or_else(|| no_such_word("mode", text))?;
        if number != work.mode {
            work.turn = Turn::default();
        }
        work.mode = number;
        Ok(())
    }
}

impl Work {
    fn measure(&mut self, from: Source) -> Result<Vec<f64>, Error> {
        let one = |value| Ok(vec![value]);
        match from {
            Source::Value => self.value.numbers(),
            Source::Raw => one(self.raw.number()?),
            Source::EchoMm => one(self.echo(10.0)?.unwrap_or(US_NOTHING_MM).min(US_NOTHING_MM)),
            Source::EchoTenthInch => {
                let far = US_NOTHING_TENTH_INCH;
                one(self.echo(10.0 / 2.54)?.unwrap_or(far).min(far))
            }
            Source::Proximity => {
                let cm = self.value.number()?;
                let percent = if cm > 0.0 {
                    cm / IR_FULL_CM * 100.0
                } else {
                    100.0
                };
                one(percent.clamp(0.0, 100.0))
            }
            Source::Reflection => one((100.0 - self.value.number()?).clamp(0.0, 100.0)),
            Source::Angle => one(self.angle()?),
            Source::Rate => one(self.rate()?),
            Source::AngleAndRate => Ok(vec![self.angle()?, self.rate()?]),
            Source::Nothing => Ok(Vec::new()),
        }
    }

    /// The distance in cm times `scale`; nothing if there is no echo, which the tree reports as an error.
    fn echo(&mut self, scale: f64) -> Result<Option<f64>, Error> {
        match self.value.number() {
            Ok(cm) => Ok(Some(cm * scale)),
            Err(error @ Error::Device(..)) => match self.raw.number() {
                Ok(raw) if raw < 0.0 => Ok(None),
                Ok(_) => Err(error),
                Err(error) => Err(error),
            },
            Err(error) => Err(error),
        }
    }

    fn angle(&mut self) -> Result<f64, Error> {
        let heading = self.heading.number()?;
        Ok(self.turn.take(heading) / 1000.0)
    }

    /// The tree turns counter-clockwise around z, which points up.
    fn rate(&mut self) -> Result<f64, Error> {
        let rates = self.value.numbers()?;
        let z = rates.get(2).copied();
        z.map(|z| -z / 1000.0)
            .ok_or_else(|| errno::no_answer("no rate around z".to_owned()))
    }

    fn close(&mut self) {
        self.value.close();
        self.raw.close();
        self.heading.close();
    }
}

impl Device for Sensor {
    fn attributes(&self) -> &'static [Attribute] {
        &ATTRIBUTES
    }

    fn show(&self, attribute: &str) -> Result<Shown, Error> {
        let mode = self.mode(&lock(&self.work));
        match attribute {
            "address" => line(&self.address),
            "bin_data" => {
                let values = self.values()?;
                let bytes = values.iter().flat_map(|value| value.to_le_bytes());
                Ok(Shown::Bytes(bytes.collect()))
            }
            "bin_data_format" => line("s32"),
            "commands" | "direct" | "poll_ms" => Err(Error::Unsupported),
            "decimals" => line(mode.decimals),
            "driver_name" => line(self.kind.driver_name()),
            "fw_version" => line(""),
            "mode" => line(mode.name),
            "modes" => {
                let names: Vec<_> = self.kind.modes().iter().map(|mode| mode.name).collect();
                line(names.join(" "))
            }
            "num_values" => line(mode.values),
            "units" => line(mode.units),
            _ => match attribute.strip_prefix("value").map(str::parse::<usize>) {
                Some(Ok(number)) if number < mode.values => {
                    let values = self.values()?;
                    values
                        .get(number)
                        .map_or(Err(Error::NoDevice(attribute.to_owned())), line)
                }
                // What has no value in this mode.
                Some(Ok(_)) => Err(Error::NoDevice(format!(
                    "{attribute}: mode {} has {} values",
                    mode.name, mode.values
                ))),
                _ => Err(Error::NotFound),
            },
        }
    }

    fn store(&self, attribute: &str, text: &str) -> Result<(), Error> {
        match attribute {
            "mode" => self.set_mode(text),
            "direct" if self.kind == Kind::Gyroscope => {
                if text != GYRO_RESET {
                    return Err(no_such_word(attribute, text));
                }
                lock(&self.work).turn = Turn::default();
                Ok(())
            }
            "command" | "direct" | "poll_ms" => Err(Error::Unsupported),
            _ => Err(Error::AccessDenied),
        }
    }

    fn opened(&self) {
        let mut work = lock(&self.work);
        work.open = work.open.saturating_add(1);
    }

    fn closed(&self) {
        let mut work = lock(&self.work);
        work.open = work.open.saturating_sub(1);
        if work.open == 0 {
            work.close();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Folder(tempfile::TempDir);

    impl Folder {
        fn new() -> Self {
            let folder = tempfile::tempdir().unwrap();
            std::fs::create_dir(folder.path().join("s")).unwrap();
            Self(folder)
        }

        fn write(&self, file: &str, text: &str) {
            std::fs::write(self.0.path().join("s").join(file), text).unwrap();
        }

        fn sensor(&self, kind: Kind) -> Sensor {
            let tree = Tree::new(self.0.path().to_owned());
            Sensor::new(&tree, "in1:A1".to_owned(), "s", kind)
        }
    }

    fn shown(sensor: &Sensor, attribute: &str) -> String {
        let bytes = sensor.show(attribute).expect(attribute).into_bytes();
        String::from_utf8(bytes).unwrap().trim_end().to_owned()
    }

    #[test]
    fn values_are_those_of_the_sensors_that_programs_know() {
        let folder = Folder::new();
        for (kind, mode, value, shows) in [
            (Kind::Ultrasonic, "US-DIST-CM", "37", "370"),
            (Kind::Ultrasonic, "US-DIST-CM", "300", "2550"),
            (Kind::Ultrasonic, "US-DIST-IN", "254", "1000"),
            (Kind::Infrared, "IR-PROX", "35", "50"),
            (Kind::Infrared, "IR-PROX", "0", "100"),
            (Kind::Infrared, "IR-PROX", "300", "100"),
            (Kind::Infrared, "DIST-CM", "35", "35"),
            (Kind::Touch, "TOUCH", "1", "1"),
            (Kind::Light, "COL-REFLECT", "90", "10"),
            (Kind::Light, "COL-REFLECT", "-3", "100"),
            (Kind::Analog, "PERCENT", "77", "77"),
            (Kind::Gyroscope, "GYRO-RATE", "0 0 -90400", "90"),
            (Kind::Accelerometer, "ACCEL", "1 2 999", "1"),
        ] {
            folder.write("value", value);
            let sensor = folder.sensor(kind);
            sensor.store("mode", mode).expect(mode);
            assert_eq!(shown(&sensor, "value0"), shows, "{mode} {value}");
            assert_eq!(shown(&sensor, "mode"), mode);
            let values: usize = shown(&sensor, "num_values").parse().unwrap();
            let bytes = sensor.show("bin_data").unwrap().into_bytes();
            assert_eq!(bytes.len(), 4 * values);
            let beyond = sensor.show(&format!("value{values}")).unwrap_err();
            assert_eq!(beyond.errno(), libc::ENODEV);
        }
    }

    #[test]
    fn an_angle_goes_on_beyond_half_a_turn_and_begins_anew_when_it_is_told_to() {
        let folder = Folder::new();
        folder.write("value", "0 0 0");
        let sensor = folder.sensor(Kind::Gyroscope);
        sensor.opened();
        for (heading, angle) in [
            ("170000", "0"),
            ("-170000", "20"),
            ("-20000", "170"),
            ("150000", "340"),
            ("150400", "340"),
        ] {
            folder.write("heading", heading);
            assert_eq!(shown(&sensor, "value0"), angle, "{heading}");
        }
        assert!(sensor.store("direct", "x").is_err());
        sensor.store("direct", GYRO_RESET).unwrap();
        assert_eq!(shown(&sensor, "value0"), "0");
        folder.write("heading", "90000");
        sensor.store("mode", "GYRO-G&A").unwrap();
        assert_eq!(shown(&sensor, "value0"), "0");
        assert_eq!(shown(&sensor, "value1"), "0");
        sensor.closed();
    }

    #[test]
    fn nothing_in_reach_is_far_and_a_failure_is_a_failure() {
        let folder = Folder::new();
        let sensor = folder.sensor(Kind::Ultrasonic);
        assert_eq!(sensor.show("value0").unwrap_err().errno(), libc::ENODEV);
        folder.write("value", "");
        assert_eq!(sensor.show("value0").unwrap_err().errno(), libc::ENODEV);
        folder.write("raw", "-1 0");
        assert_eq!(shown(&sensor, "value0"), "2550");
        folder.write("raw", "5 300");
        assert_eq!(sensor.show("value0").unwrap_err().errno(), libc::EIO);
        assert_eq!(
            sensor.store("mode", "US-LISTEN").unwrap_err().errno(),
            libc::EINVAL
        );
        assert_eq!(
            sensor.store("poll_ms", "5").unwrap_err().errno(),
            libc::EOPNOTSUPP
        );
    }

    #[test]
    fn kinds_are_told_by_the_format() {
        for (format, kind) in [
            ("i32 distance", Kind::Infrared),
            ("i32 touch", Kind::Touch),
            ("i32 darkness", Kind::Light),
            ("i32 percent", Kind::Analog),
            ("", Kind::Analog),
        ] {
            assert_eq!(Kind::of_format(format), kind);
        }
    }

    /// A type that is not told apart here is shown as a plain analog sensor.
    #[test]
    fn every_type_of_the_analog_ports_is_told() {
        let family = include_str!("../../config/lua/trik/analog.lua");
        let (types, _) = family.split_once("local ports").expect("types, then ports");
        let formats = types.split("format = '").skip(1);
        let kinds: Vec<Kind> = formats
            .filter_map(|rest| rest.split_once('\''))
            .filter(|(format, _)| *format != "i32 percent")
            .map(|(format, _)| Kind::of_format(format))
            .collect();
        assert_eq!(kinds, [Kind::Infrared, Kind::Touch, Kind::Light]);
    }
}
