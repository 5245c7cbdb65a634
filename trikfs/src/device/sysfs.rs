//! Short texts in the attributes of sysfs: numbers and words that switch a port.
//!
//! Owns how they are read (the first line, bounded) and written (one write, with a newline). A plain file that
//! stands for an attribute is written in the same way, so that its readers never find it empty. Knows no port.

use super::device_error;
use crate::errno::Error;
use crate::limits::ATTRIBUTE_BYTES_MAX;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::str::FromStr;

/// The first line without spaces around it.
pub(super) fn read(path: &Path) -> Result<String, Error> {
    let failed = |error: std::io::Error| device_error(path, &error);
    let file = open(OpenOptions::new().read(true), path).map_err(failed)?;
    let mut bytes = Vec::new();
    file.take(ATTRIBUTE_BYTES_MAX)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    let line = bytes
        .split(|&byte| byte == b'\n')
        .next()
        .unwrap_or_default();
    Ok(String::from_utf8_lossy(line).trim().to_owned())
}

/// The number in the first line.
pub(super) fn read_number<T: FromStr>(path: &Path) -> Result<T, Error> {
    let text = read(path)?;
    text.parse().map_err(|_| {
        let shown: String = text.chars().take(32).flat_map(char::escape_debug).collect();
        let what = format!(
            "{}: '{shown}' is no number that can be there",
            path.display()
        );
        Error::Malformed(what)
    })
}

/// Writes a text at once.
pub(super) fn write(path: &Path, text: &str) -> Result<(), Error> {
    try_write(path, text).map_err(|error| device_error(path, &error))
}

/// As [`write`], with the error of the system.
pub(super) fn try_write(path: &Path, text: &str) -> Result<(), std::io::Error> {
    let mut file = open(OpenOptions::new().write(true), path)?;
    let text = format!("{text}\n");
    let written = file.write(text.as_bytes())?;
    if written < text.len() {
        return Err(ErrorKind::WriteZero.into());
    }
    // Only a plain file is longer than what was written and keeps what was there before.
    if let Ok(meta) = file.metadata()
        && meta.len() > text.len() as u64
        && meta.is_file()
        && !super::attribute::is_generated(path)
    {
        file.set_len(text.len() as u64)?;
    }
    Ok(())
}

fn open(options: &mut OpenOptions, path: &Path) -> Result<File, std::io::Error> {
    // A FIFO instead of an attribute must not make anybody wait.
    options
        .custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
        .open(path)
}

/// Writes a number to an `export` file. EBUSY means that somebody has exported it already, EINVAL that no chip has it.
pub(super) fn export(path: &Path, number: u32) -> Result<(), Error> {
    match try_write(path, &number.to_string()) {
        Err(error) if error.kind() == ErrorKind::ResourceBusy => Ok(()),
        Err(error) if error.kind() == ErrorKind::InvalidInput => Err(Error::NoDevice(format!(
            "{}: no chip has {number}",
            path.display()
        ))),
        Err(error) => Err(device_error(path, &error)),
        Ok(()) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn a_text_is_the_first_line_and_replaces_a_longer_one() {
        let scratch = Scratch::new();
        let path = scratch.path("duty_cycle");
        std::fs::write(&path, " 1500000 \nrest").unwrap();
        assert_eq!(read(&path), Ok("1500000".to_owned()));
        write(&path, "0").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"0\n");
        assert_eq!(read_number::<u32>(&path), Ok(0));
    }

    #[test]
    fn a_line_that_no_chip_has_is_a_missing_device() {
        // A file of the kernel that refuses this number as `export` does.
        let path = Path::new("/proc/self/oom_score_adj");
        let what = format!("{}: no chip has 5000", path.display());
        assert_eq!(export(path, 5000), Err(Error::NoDevice(what)));
    }

    #[test]
    fn what_is_missing_or_no_number_is_an_error_with_its_path() {
        let scratch = Scratch::new();
        let path = scratch.path("enable");
        let Err(Error::NoDevice(what)) = read(&path) else {
            panic!("a missing file was read")
        };
        assert!(what.starts_with(&format!("{}: ", path.display())), "{what}");
        assert!(write(&path, "1").is_err() && !path.exists());
        for text in ["", "x", "-1", "4294967296", "\u{7}"] {
            std::fs::write(&path, text).unwrap();
            let error = read_number::<u32>(&path).unwrap_err();
            assert_eq!(error.errno(), libc::EIO, "{text}");
        }
        std::fs::write(&path, vec![b'7'; 100_000]).unwrap();
        assert!(read(&path).unwrap().len() <= 4096);
    }
}
