//! Where robots were and how their devices changed, moment by moment: recorded, written, read.
//!
//! Owns the form in which TRIK Studio's `2D-model` writes it: a list of poses, one for each robot and tick, and of changes
//! of devices. Lengths are pixels, the pose is that of the upper left corner of the unturned robot, angles are degrees
//! clockwise. Knows no world.

use super::json::{self, Value};
use crate::limits;

/// One thing that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// Where a robot was.
    Pose {
        /// Which of [`Trajectory::robots`].
        robot: u16,
        /// Model time, in milliseconds.
        ms: u32,
        /// Pixels to the right.
        x: f64,
        /// Pixels down.
        y: f64,
        /// Degrees clockwise, not wrapped.
        degrees: f64,
    },
    /// A device was changed.
    Device {
        /// Which of [`Trajectory::robots`].
        robot: u16,
        /// Model time, in milliseconds.
        ms: u32,
        /// What it is and what was changed.
        change: Box<DeviceChange>,
    },
}

/// A change of a device.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceChange {
    /// Kind of the device, as `display`.
    pub device: String,
    /// Its port, as `DisplayPort`.
    pub port: String,
    /// What was changed, as `objects`.
    pub property: String,
    /// To what.
    pub value: Value,
}

/// A recorded run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Names of the robots.
    pub robots: Vec<String>,
    /// What happened, in order.
    pub records: Vec<Record>,
}

impl Record {
    /// Model time, in milliseconds.
    pub fn ms(&self) -> u32 {
        match self {
            Self::Pose { ms, .. } | Self::Device { ms, .. } => *ms,
        }
    }
}

impl Trajectory {
    /// The number of a robot by its name; a new one if the name is new.
    pub fn robot(&mut self, name: &str) -> u16 {
        let found = self.robots.iter().position(|robot| robot == name);
        let index = found.unwrap_or_else(|| {
            self.robots.push(name.to_owned());
            self.robots.len() - 1
        });
        u16::try_from(index).unwrap_or(u16::MAX)
    }

    /// Poses of one robot: milliseconds, x, y, degrees.
    pub fn poses(&self, of: u16) -> impl Iterator<Item = [f64; 4]> + '_ {
        self.records.iter().filter_map(move |record| match *record {
            Record::Pose {
                robot,
                ms,
                x,
                y,
                degrees,
            } if robot == of => Some([f64::from(ms), x, y, degrees]),
            Record::Pose { .. } | Record::Device { .. } => None,
        })
    }

    /// As text: a record in each line, keys in the order of the original.
    pub fn write(&self) -> String {
        let mut out = String::with_capacity(self.records.len() * 100 + 8);
        out.push('[');
        for (index, record) in self.records.iter().enumerate() {
            out.push_str(if index == 0 { "\n" } else { ",\n" });
            self.write_one(record, &mut out);
        }
        out.push_str("\n]\n");
        out
    }

    fn write_one(&self, record: &Record, out: &mut String) {
        let name = |robot: u16| self.robots.get(usize::from(robot)).map_or("", |name| name);
        match record {
            Record::Pose {
                robot,
                ms,
                x,
                y,
                degrees,
            } => {
                out.push_str("{\"robotId\":");
                json::text(out, name(*robot));
                for (key, value) in [
                    ("rotation", *degrees),
                    ("timestamp", f64::from(*ms)),
                    ("x", *x),
                    ("y", *y),
                ] {
                    out.push_str(",\"");
                    out.push_str(key);
                    out.push_str("\":");
                    json::number(out, value);
                }
            }
            Record::Device { robot, ms, change } => {
                for (key, value) in [
                    ("{\"device\":", &*change.device),
                    (",\"port\":", &change.port),
                    (",\"property\":", &change.property),
                    (",\"robotId\":", name(*robot)),
                ] {
                    out.push_str(key);
                    json::text(out, value);
                }
                out.push_str(",\"timestamp\":");
                json::number(out, f64::from(*ms));
                out.push_str(",\"value\":");
                json::write(out, &change.value);
            }
        }
        out.push('}');
    }

    /// Reads what a run of ours or of the original has written.
    ///
    /// # Errors
    /// The place and what is wrong there: no JSON, a record without its parts, time that goes back, more than
    /// [`limits::RECORDS`].
    pub fn read(text: &str) -> Result<Self, json::Refusal> {
        let mut trajectory = Self::default();
        let mut now = 0;
        json::read_list(text, |value| {
            let record = trajectory.record(&value)?;
            if record.ms() < now {
                return Err("time goes back in this record");
            }
            if trajectory.records.len() >= limits::RECORDS {
                return Err("there are too many records");
            }
            now = record.ms();
            trajectory.records.push(record);
            Ok(())
        })?;
        Ok(trajectory)
    }

    fn record(&mut self, value: &Value) -> Result<Record, &'static str> {
        let name = value.get("robotId").and_then(Value::as_str);
        let robot = self.robot(name.ok_or("'robotId' is missing in this record")?);
        if usize::from(robot) >= limits::ROBOTS {
            return Err("there are too many robots");
        }
        let ms = value.get("timestamp").and_then(Value::as_f64);
        let ms = ms.filter(|ms| (0.0..=f64::from(limits::RUN_MS_MAX)).contains(ms));
        let ms = ms.ok_or("'timestamp' of this record is no time in milliseconds")? as u32;
        if let Some(property) = value.get("property").and_then(Value::as_str) {
            let part = |key| {
                value
                    .get(key)
                    .and_then(Value::as_str)
                    .unwrap_or("")
                    .to_owned()
            };
            let change = DeviceChange {
                device: part("device"),
                port: part("port"),
                property: property.to_owned(),
                value: value.get("value").cloned().unwrap_or(Value::Null),
            };
            let change = Box::new(change);
            return Ok(Record::Device { robot, ms, change });
        }
        let number = |key| value.get(key).and_then(Value::as_f64);
        let parts = (number("x"), number("y"), number("rotation"));
        let (Some(x), Some(y), Some(degrees)) = parts else {
            return Err("this record has neither 'x', 'y' and 'rotation' nor 'property'");
        };
        if [x, y, degrees]
            .iter()
            .any(|part| part.abs() > limits::FAR_PX)
        {
            return Err("this pose is too far away");
        }
        Ok(Record::Pose {
            robot,
            ms,
            x,
            y,
            degrees,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let mut trajectory = Trajectory::default();
        let robot = trajectory.robot("trikKitRobot");
        assert_eq!(trajectory.robot("trikKitRobot"), robot);
        for ms in [10, 20] {
            trajectory.records.push(Record::Pose {
                robot,
                ms,
                x: 0.1 + f64::from(ms),
                y: -3.0,
                degrees: 450.5,
            });
        }
        trajectory.records.push(Record::Device {
            robot,
            ms: 20,
            change: Box::new(DeviceChange {
                device: "led".into(),
                port: "LedPort".into(),
                property: "color".into(),
                value: "#008000".into(),
            }),
        });
        let text = trajectory.write();
        assert!(text.contains(
            r#"{"robotId":"trikKitRobot","rotation":450.5,"timestamp":10,"x":10.1,"y":-3}"#
        ));
        assert_eq!(Trajectory::read(&text), Ok(trajectory.clone()));
        let poses: Vec<_> = trajectory.poses(robot).collect();
        assert_eq!(poses[1], [20.0, 20.1, -3.0, 450.5]);
    }

    #[test]
    fn what_is_no_trajectory_is_refused_with_its_place() {
        for (text, why) in [
            ("{}", "line 1, column 1: invalid type: map, expected a list"),
            (
                "[1]",
                "line 1, column 3: 'robotId' is missing in this record",
            ),
            (
                r#"[{"robotId":"a","timestamp":-1}]"#,
                "line 1, column 32: 'timestamp' of this record is no time in milliseconds",
            ),
            (
                r#"[{"robotId":"a","timestamp":1}]"#,
                "line 1, column 31: this record has neither 'x', 'y' and 'rotation' nor 'property'",
            ),
            (
                r#"[{"robotId":"a","timestamp":1,"x":1e300,"y":0,"rotation":0}]"#,
                "line 1, column 60: this pose is too far away",
            ),
        ] {
            assert_eq!(Trajectory::read(text).unwrap_err().to_string(), why);
        }
        let back = r#"[{"robotId":"a","timestamp":2,"property":"x"},
{"robotId":"a","timestamp":1,"property":"x"}]"#;
        let why = Trajectory::read(back).unwrap_err().to_string();
        assert!(
            why.starts_with("line 2") && why.contains("time goes back"),
            "{why}"
        );
    }
}
