//! One GPIO line of sysfs.
//!
//! Owns its export, its direction, and the meaning of its value: a tuple is one byte, 0 or 1. A line that goes out
//! already is left as it is, since something may hang on it. Knows nothing of what is wired to it.

use super::{Device, Kind, Sink, State, Surroundings, sysfs};
use crate::bytes::copy_at;
use crate::errno::Error;
use config::description::{GpioDescription, GpioDirection};
use std::path::{Path, PathBuf};

impl Kind for GpioDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::State(Box::new(Gpio::open(self)?)))
    }

    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        if self.direction == GpioDirection::In {
            return Err(Error::AccessDenied);
        }
        Ok(Box::new(Gpio::open(self)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }
}

/// One line, exported and with its direction.
pub struct Gpio {
    value: PathBuf,
    current: [u8; 1],
}

impl Gpio {
    /// Exports the line and sets it up, as far as that is not done.
    pub fn open(description: &GpioDescription) -> Result<Self, Error> {
        let line = description.base.join(format!("gpio{}", description.number));
        if !line.is_dir() {
            sysfs::export(&description.base.join("export"), description.number)?;
        }
        set_active_low(&line.join("active_low"), description.active_low)?;
        set_direction(&line.join("direction"), description.direction)?;
        Ok(Self {
            value: line.join("value"),
            current: [0],
        })
    }
}

fn set_active_low(path: &Path, active_low: bool) -> Result<(), Error> {
    let wanted = if active_low { "1" } else { "0" };
    match sysfs::read(path) {
        Ok(present) if present == wanted => Ok(()),
        // A line without the file is active high for good.
        Err(Error::NoDevice(_)) if !active_low => Ok(()),
        _ => sysfs::write(path, wanted),
    }
}

fn set_direction(path: &Path, direction: GpioDirection) -> Result<(), Error> {
    let wanted = match direction {
        GpioDirection::In => "in",
        GpioDirection::Out => "out",
        GpioDirection::High => "high",
        GpioDirection::Low => "low",
    };
    let is_in = direction == GpioDirection::In;
    match sysfs::read(path) {
        // The file says `in` or `out`, whatever was written to it.
        Ok(present) if (present == "in") == is_in && !present.is_empty() => Ok(()),
        // A line whose direction cannot be changed has no such file; its value tells whether it fits.
        Err(Error::NoDevice(_)) if path.with_file_name("value").exists() => Ok(()),
        _ => sysfs::write(path, wanted),
    }
}

impl State for Gpio {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            let level = sysfs::read_number::<u8>(&self.value)?;
            if level > 1 {
                let what = format!("{}: {level} is no level", self.value.display());
                return Err(Error::Device(libc::EIO, what));
            }
            self.current = [level];
        }
        Ok(copy_at(&self.current, offset, buf))
    }
}

impl Sink for Gpio {
    fn write(&mut self, tuple: &[u8], _waits: bool) -> Result<(), Error> {
        match tuple {
            [0] => sysfs::write(&self.value, "0"),
            [1] => sysfs::write(&self.value, "1"),
            _ => Err(Error::OutOfRange(format!(
                "{}: a line takes one byte, 0 or 1",
                self.value.display()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;
    use std::fs;

    fn description(scratch: &Scratch, direction: GpioDirection) -> GpioDescription {
        GpioDescription {
            base: scratch.dir().to_owned(),
            number: 56,
            direction,
            active_low: false,
        }
    }

    fn line(scratch: &Scratch, direction: &str, value: &str) -> PathBuf {
        let line = scratch.path("gpio56");
        fs::create_dir_all(&line).unwrap();
        fs::write(line.join("direction"), direction).unwrap();
        fs::write(line.join("value"), value).unwrap();
        line
    }

    #[test]
    fn a_line_is_read_and_written_as_0_and_1() {
        let scratch = Scratch::new();
        let line = line(&scratch, "in\n", "1\n");
        let mut gpio = Gpio::open(&description(&scratch, GpioDirection::In)).unwrap();
        let mut buf = [9; 1];
        assert_eq!((gpio.read_at(0, &mut buf), buf), (Ok(1), [1]));
        fs::write(line.join("value"), "0\n").unwrap();
        assert_eq!((gpio.read_at(0, &mut buf), buf), (Ok(1), [0]));
        assert_eq!(fs::read(line.join("direction")).unwrap(), b"in\n");
        let mut gpio = Gpio::open(&description(&scratch, GpioDirection::High)).unwrap();
        assert_eq!(fs::read(line.join("direction")).unwrap(), b"high\n");
        gpio.write(&[1], true).unwrap();
        assert_eq!(fs::read(line.join("value")).unwrap(), b"1\n");
        for wrong in [&[2][..], &[255], &[], &[0, 0]] {
            assert_eq!(gpio.write(wrong, true).unwrap_err().errno(), libc::ERANGE);
        }
        assert_eq!(fs::read(line.join("value")).unwrap(), b"1\n");
    }

    #[test]
    fn a_line_that_goes_out_already_keeps_its_level() {
        let scratch = Scratch::new();
        let line = line(&scratch, "out\n", "1\n");
        Gpio::open(&description(&scratch, GpioDirection::Low)).unwrap();
        assert_eq!(fs::read(line.join("direction")).unwrap(), b"out\n");
    }

    #[test]
    fn what_is_no_level_is_an_error_and_never_a_value() {
        let scratch = Scratch::new();
        line(&scratch, "in", "");
        for text in ["", "2\n", "x", "-1", "256", "1 0"] {
            fs::write(scratch.path("gpio56/value"), text).unwrap();
            let mut gpio = Gpio::open(&description(&scratch, GpioDirection::In)).unwrap();
            let error = gpio.read_at(0, &mut [0]).unwrap_err();
            assert_eq!(error.errno(), libc::EIO, "{text:?}");
        }
    }

    #[test]
    fn a_missing_line_is_exported_and_a_missing_board_is_named() {
        let scratch = Scratch::new();
        let wanted = description(&scratch, GpioDirection::In);
        let Err(Error::NoDevice(what)) = Gpio::open(&wanted) else {
            panic!("opened without a board")
        };
        assert!(what.contains("export"), "{what}");
        fs::write(scratch.path("export"), "").unwrap();
        assert!(Gpio::open(&wanted).is_err());
        assert_eq!(fs::read(scratch.path("export")).unwrap(), b"56\n");
    }

    #[test]
    fn active_low_is_set_only_where_it_differs() {
        let scratch = Scratch::new();
        let line = line(&scratch, "in", "0");
        let mut wanted = description(&scratch, GpioDirection::In);
        wanted.active_low = true;
        assert!(matches!(Gpio::open(&wanted), Err(Error::NoDevice(_))));
        fs::write(line.join("active_low"), "0\n").unwrap();
        Gpio::open(&wanted).unwrap();
        assert_eq!(fs::read(line.join("active_low")).unwrap(), b"1\n");
    }
}
