//! One action on its port in the tree: what is written to a motor or a servo, and what its encoder says.
//!
//! Owns the files, the loop of one motor, and that no number is written that is not in its range. Knows no path.

use crate::error::Error;
use crate::limits::{DRIVE_GAIN, DRIVE_NEAR_DEG, DRIVE_SERVO_DEG};
use sim::body::rolling::{Actuator, Port};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

/// An action and what does it.
#[derive(Debug)]
pub(super) struct Driven {
    /// `u_l on M3`.
    name: String,
    value: PathBuf,
    encoder: Option<PathBuf>,
    actuator: Actuator,
    top_deg_s: f64,
    /// What the encoder said first and last.
    begun: Option<f64>,
    last: f64,
    lag_deg: f64,
    /// How far it turned since the last look.
    moved_deg: f64,
}

impl Driven {
    /// The port of an action in a tree.
    ///
    /// # Errors
    /// The tree has no such port.
    pub fn new(
        tree: &Path,
        action: &str,
        actuator: Actuator,
        top_deg_s: f64,
    ) -> Result<Self, Error> {
        let port = actuator.port.name();
        let (group, encoder) = match actuator.port {
            Port::Motor(index) => ("motors", Some(format!("encoders/E{}/value", index + 1))),
            Port::Servo(_) => ("servos", None),
        };
        let value = tree.join(group).join(&port).join("value");
        if let Err(error) = fs::metadata(&value) {
            let why = format!(
                "{action} is to be on {port}, but there is no such file ({error}): is it plugged in in the configuration, and \
                 is the robot mounted there? --robot says where it is"
            );
            return Err(Error::file(&value, why));
        }
        let encoder = encoder
            .map(|name| tree.join(name))
            .filter(|path| path.exists());
        Ok(Self {
            name: format!("{action} on {port}"),
            value,
            encoder,
            actuator,
            top_deg_s,
            begun: None,
            last: 0.0,
            lag_deg: 0.0,
            moved_deg: 0.0,
        })
    }

    /// The action and its port.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether another action has the same port.
    pub fn shares(&self, other: &Self) -> bool {
        self.value == other.value
    }

    pub fn is_servo(&self) -> bool {
        matches!(self.actuator.port, Port::Servo(_))
    }

    pub fn is_measured(&self) -> bool {
        self.encoder.is_some()
    }

    /// How far the shaft is behind where it should be.
    pub fn lag_deg(&self) -> f64 {
        self.lag_deg
    }

    /// Whether it is where it should be and stands.
    pub fn is_settled(&self) -> bool {
        self.encoder.is_none() || (self.lag_deg.abs() <= DRIVE_NEAR_DEG && self.moved_deg == 0.0)
    }

    /// Degrees, or degrees per second, of an action.
    fn degrees(&self, action: f64) -> f64 {
        (action / self.actuator.factor).to_degrees()
    }

    /// Why an action cannot be done, if it cannot.
    pub fn refuses(&self, action: f64) -> Option<String> {
        let degrees = self.degrees(action);
        let (most, unit) = match self.actuator.port {
            Port::Motor(_) => (self.top_deg_s, "degrees per second"),
            Port::Servo(_) => (DRIVE_SERVO_DEG, "degrees"),
        };
        let advice = "plan with a smaller range of --actions";
        // What is no number is beyond everything.
        let is_good = degrees.abs() <= most;
        (!is_good).then(|| {
            format!(
                "{} would need {degrees:.0} {unit}, and {most} is all it has: {advice}",
                self.name
            )
        })
    }

    /// Before the first motor turns: where the encoder stands, and a servo where it has to be.
    pub fn prepare(&mut self, action: f64) -> Result<(), Error> {
        if let Some(now) = self.read()? {
            self.begun = Some(now);
            self.last = now;
        }
        if self.is_servo() {
            self.write(self.degrees(action), DRIVE_SERVO_DEG)?;
        }
        Ok(())
    }

    /// Looks at the encoder, which should have gone as far as this sum of the action. How much of the action was done since
    /// the last look, if that can be known.
    pub fn measure(&mut self, wanted: f64) -> Result<Option<f64>, Error> {
        let (Some(now), Some(begun)) = (self.read()?, self.begun) else {
            return Ok(None);
        };
        self.moved_deg = now - self.last;
        self.last = now;
        self.lag_deg = self.degrees(wanted) - (now - begun);
        Ok(Some(self.moved_deg.to_radians() * self.actuator.factor))
    }

    /// Does an action: a motor gets the power for its speed, and more or less by how far it is behind. At the end it is
    /// only brought to where it should be.
    pub fn apply(&mut self, action: f64, is_over: bool) -> Result<(), Error> {
        if self.is_servo() {
            return self.write(self.degrees(action), DRIVE_SERVO_DEG);
        }
        let ahead = if is_over { 0.0 } else { self.degrees(action) };
        let power = 100.0 * ahead / self.top_deg_s + DRIVE_GAIN * self.lag_deg;
        // More than everything is everything; what is no number is refused.
        let within = if power.is_finite() {
            power.clamp(-100.0, 100.0)
        } else {
            power
        };
        self.write(within, 100.0)
    }

    /// A motor without power.
    fn stop(&self) -> Result<(), Error> {
        if self.is_servo() {
            Ok(())
        } else {
            self.write(0.0, 100.0)
        }
    }

    /// Writes a whole number that is in its range, and no other.
    fn write(&self, number: f64, most: f64) -> Result<(), Error> {
        let number = number.round();
        if !(-most..=most).contains(&number) {
            let why = format!("{number} is not from -{most} to {most}: it is not written");
            return Err(Error::Robot(format!("{}: {why}", self.name)));
        }
        let failed = |error| Error::file(&self.value, format!("{}: {error}", self.name));
        let mut file = File::options()
            .write(true)
            .open(&self.value)
            .map_err(failed)?;
        file.write_all(format!("{number:.0}").as_bytes())
            .map_err(failed)
    }

    fn read(&self) -> Result<Option<f64>, Error> {
        let Some(path) = &self.encoder else {
            return Ok(None);
        };
        let text = fs::read_to_string(path)
            .map_err(|error| Error::file(path, format!("the encoder of {}: {error}", self.name)))?;
        match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            _ => Err(Error::file(
                path,
                format!("the encoder of {} says no number", self.name),
            )),
        }
    }
}

/// Ports of which no motor goes on when they are dropped.
#[derive(Debug)]
pub(super) struct Stopping(pub Vec<Driven>);

impl Stopping {
    /// Stops all motors, also after one that cannot be stopped.
    pub fn stop(&mut self) -> Result<(), Error> {
        let failed: Vec<String> = self
            .0
            .iter()
            .filter_map(|port| port.stop().err())
            .map(|error| error.to_string())
            .collect();
        if failed.is_empty() {
            return Ok(());
        }
        let failed = failed.join("; ");
        Err(Error::Robot(format!(
            "a motor could not be stopped, look at the robot: {failed}"
        )))
    }
}

impl Drop for Stopping {
    fn drop(&mut self) {
        let _ = self.stop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_outside_its_range_reaches_a_motor() {
        let folder = tempfile::tempdir().unwrap();
        let tree = folder.path();
        let value = tree.join("motors/M3/value");
        fs::create_dir_all(value.parent().unwrap()).unwrap();
        fs::write(&value, "").unwrap();
        let actuator = Actuator::read("M3*0.5").unwrap();
        let mut port = Driven::new(tree, "u", actuator, 1200.0).unwrap();
        let mut does = |action: f64| {
            fs::write(&value, "").unwrap();
            let done = port.apply(action, false).map_err(|why| why.to_string());
            (done, fs::read_to_string(&value).unwrap())
        };
        // 0.5 of the action are 1 rad/s.
        assert_eq!(does(600_f64.to_radians() * 0.5), (Ok(()), "50".to_owned()));
        assert_eq!(does(1e9), (Ok(()), "100".to_owned()));
        assert_eq!(does(-1e300), (Ok(()), "-100".to_owned()));
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let (done, written) = does(wrong);
            assert_eq!(written, "", "{wrong}");
            assert!(done.unwrap_err().contains("is not written"), "{wrong}");
        }
        assert_eq!(port.refuses(1.0), None);
        let far = port.refuses(20.0).unwrap();
        assert!(
            far.starts_with("u on M3 would need 2292 degrees per second, and 1200"),
            "{far}"
        );
        assert!(port.refuses(f64::NAN).is_some());
        let stopping = Stopping(vec![port]);
        drop(stopping);
        assert_eq!(fs::read_to_string(&value).unwrap(), "0");
        let missing = Driven::new(tree, "v", Actuator::read("M4").unwrap(), 1200.0).unwrap_err();
        assert!(
            missing
                .to_string()
                .contains("v is to be on M4, but there is no such file"),
            "{missing}"
        );
    }
}
