//! A PWM channel of sysfs: servos and the like.
//!
//! Owns the order in which the files of a channel are written, which the kernel and the servos ask for: the period
//! never falls below the pulse, a pulse is given only when the channel is on, and a channel goes off before its pulse
//! becomes 0. A tuple is the pulse in ns, u32 little endian; 0 means off. Knows no angle.

use super::{Device, Kind, Sink, State, Surroundings, sysfs};
use crate::bytes::copy_at;
use crate::errno::Error;
use config::description::PwmDescription;
use std::path::PathBuf;

impl Kind for PwmDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::State(Box::new(Pwm::open(self)?)))
    }

    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(Pwm::open(self)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }
}

/// One channel, exported and with its period.
pub struct Pwm {
    channel: PathBuf,
    period_ns: u32,
    current: [u8; 4],
}

impl Pwm {
    /// Exports the channel and gives it its period, unless both is done. A channel that has its period already is
    /// left as it is: it may be holding a servo.
    pub fn open(description: &PwmDescription) -> Result<Self, Error> {
        let channel = description.chip.join(format!("pwm{}", description.channel));
        if !channel.is_dir() {
            sysfs::export(&description.chip.join("export"), description.channel)?;
        }
        let pwm = Self {
            channel,
            period_ns: description.period_ns,
            current: [0; 4],
        };
        let period = sysfs::read(&pwm.file("period"))?;
        if period != pwm.period_ns.to_string() {
            // The kernel refuses every setting of a channel without a period, even those that it has.
            for name in ["enable", "duty_cycle"] {
                if sysfs::read_number::<u64>(&pwm.file(name))? != 0 {
                    pwm.put(name, 0)?;
                }
            }
            pwm.put("period", pwm.period_ns)?;
        }
        Ok(pwm)
    }

    fn file(&self, name: &str) -> PathBuf {
        self.channel.join(name)
    }

    fn put(&self, name: &str, number: u32) -> Result<(), Error> {
        sysfs::write(&self.file(name), &number.to_string())
    }

    fn is_on(&self) -> Result<bool, Error> {
        Ok(sysfs::read_number::<u32>(&self.file("enable"))? != 0)
    }

    fn duty_ns(&self) -> Result<u32, Error> {
        if self.is_on()? {
            sysfs::read_number(&self.file("duty_cycle"))
        } else {
            Ok(0)
        }
    }
}

impl State for Pwm {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            self.current = self.duty_ns()?.to_le_bytes();
        }
        Ok(copy_at(&self.current, offset, buf))
    }
}

impl Sink for Pwm {
    fn write(&mut self, tuple: &[u8], _waits: bool) -> Result<(), Error> {
        let Ok(bytes) = tuple.try_into() else {
            return Err(Error::Invalid("a pulse has 4 bytes".to_owned()));
        };
        let duty_ns = u32::from_le_bytes(bytes);
        if duty_ns > self.period_ns {
            return Err(Error::OutOfRange(format!(
                "{}: a pulse of {duty_ns} ns is longer than the period of {} ns",
                self.channel.display(),
                self.period_ns
            )));
        }
        if duty_ns == 0 {
            self.put("enable", 0)?;
        } else if !self.is_on()? {
            self.put("enable", 1)?;
        }
        self.put("duty_cycle", duty_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use std::fs;

    fn chip(scratch: &Scratch) -> PwmDescription {
        let chip = scratch.path("pwmchip3");
        fs::create_dir_all(chip.join("pwm1")).unwrap();
        for (name, text) in [("period", "0"), ("duty_cycle", "0"), ("enable", "0")] {
            fs::write(chip.join("pwm1").join(name), text).unwrap();
        }
        PwmDescription {
            chip,
            channel: 1,
            period_ns: 20_000_000,
        }
    }

    fn text(description: &PwmDescription, name: &str) -> String {
        fs::read_to_string(description.chip.join("pwm1").join(name)).unwrap()
    }

    /// Replaces a file with something that cannot be written.
    fn block(description: &PwmDescription, name: &str) -> PathBuf {
        let path = description.chip.join("pwm1").join(name);
        fs::remove_file(&path).unwrap();
        nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).unwrap();
        path
    }

    #[test]
    fn a_new_channel_is_switched_off_before_it_gets_its_period() {
        let scratch = Scratch::new();
        let description = chip(&scratch);
        for name in ["enable", "duty_cycle"] {
            fs::write(description.chip.join("pwm1").join(name), "7").unwrap();
        }
        let period = block(&description, "period");
        assert!(Pwm::open(&description).is_err());
        assert_eq!(text(&description, "enable"), "0\n");
        assert_eq!(text(&description, "duty_cycle"), "0\n");
        fs::remove_file(&period).unwrap();
        fs::write(&period, "5\n").unwrap();
        let enable = block(&description, "enable");
        assert!(Pwm::open(&description).is_err());
        assert_eq!(text(&description, "period"), "5\n");
        fs::remove_file(&enable).unwrap();
        fs::write(&enable, "0\n").unwrap();
        Pwm::open(&description).unwrap();
        assert_eq!(text(&description, "period"), "20000000\n");
    }

    #[test]
    fn a_channel_that_never_had_a_period_is_given_nothing_before_it() {
        let scratch = Scratch::new();
        let description = chip(&scratch);
        Pwm::open(&description).unwrap();
        assert_eq!(text(&description, "period"), "20000000\n");
        for name in ["enable", "duty_cycle"] {
            assert_eq!(text(&description, name), "0", "{name} was written");
        }
    }

    #[test]
    fn a_channel_goes_on_before_its_pulse_and_off_before_it_ends() {
        let scratch = Scratch::new();
        let description = chip(&scratch);
        let mut pwm = Pwm::open(&description).unwrap();
        pwm.write(&1_500_000u32.to_le_bytes(), true).unwrap();
        assert_eq!(text(&description, "enable"), "1\n");
        assert_eq!(text(&description, "duty_cycle"), "1500000\n");
        pwm.write(&[0; 4], true).unwrap();
        assert_eq!(text(&description, "enable"), "0\n");
        assert_eq!(text(&description, "duty_cycle"), "0\n");
        block(&description, "duty_cycle");
        assert!(pwm.write(&900_000u32.to_le_bytes(), true).is_err());
        assert_eq!(text(&description, "enable"), "1\n");
        assert!(pwm.write(&[0; 4], true).is_err());
        assert_eq!(text(&description, "enable"), "0\n");
    }

    #[test]
    fn a_second_opening_does_not_disturb_a_servo() {
        let scratch = Scratch::new();
        let description = chip(&scratch);
        let pulse = 700_000u32.to_le_bytes();
        Pwm::open(&description)
            .unwrap()
            .write(&pulse, true)
            .unwrap();
        let mut again = Pwm::open(&description).unwrap();
        let mut buf = [0; 4];
        assert_eq!(again.read_at(0, &mut buf), Ok(4));
        assert_eq!(buf, pulse);
        assert_eq!(text(&description, "enable"), "1\n");
        fs::write(description.chip.join("pwm1/enable"), "0\n").unwrap();
        assert_eq!((again.read_at(0, &mut buf), buf), (Ok(4), [0; 4]));
    }

    #[test]
    fn a_pulse_longer_than_the_period_is_refused_and_changes_nothing() {
        let scratch = Scratch::new();
        let description = chip(&scratch);
        let mut pwm = Pwm::open(&description).unwrap();
        pwm.write(&20_000_000u32.to_le_bytes(), true).unwrap();
        let refused = pwm.write(&20_000_001u32.to_le_bytes(), true).unwrap_err();
        assert_eq!(refused.errno(), libc::ERANGE);
        assert_eq!(text(&description, "duty_cycle"), "20000000\n");
    }

    #[test]
    fn a_channel_that_is_not_there_is_exported_and_else_missing() {
        let scratch = Scratch::new();
        let mut description = chip(&scratch);
        description.channel = 0;
        assert!(matches!(Pwm::open(&description), Err(Error::NoDevice(_))));
        fs::write(description.chip.join("export"), "").unwrap();
        assert!(matches!(Pwm::open(&description), Err(Error::NoDevice(_))));
        assert_eq!(fs::read(description.chip.join("export")).unwrap(), b"0\n");
    }
}
