//! State in a file: sysfs and procfs attributes, and regular files.
//!
//! Owns reading afresh from an offset and writing at offset 0. An attribute's text is shorter or longer from
//! one reading to the next, so it fills its tuple up with zero bytes; a regular file holds tuples one after the other.

use super::{Device, Kind, Sink, State, Surroundings, device_error};
use crate::errno::Error;
use config::description::AttributeDescription;
use nix::sys::statfs::statfs;
use std::fs::{File, OpenOptions};
use std::os::unix::fs::{FileExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

impl Kind for AttributeDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        let state = Attribute::open(&self.path, true)?;
        Ok(Device::State(Box::new(state)))
    }

    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(AttributeSink::open(&self.path, true)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }
}

/// Filesystems whose files are made at the moment of reading (linux/magic.h).
const GENERATED: [i64; 5] = [
    0x6265_6572, // sysfs
    0x9fa0,      // proc
    0x6462_6720, // debugfs
    0x7472_6163, // tracefs
    0x6573_5546, // another FUSE filesystem
];

/// True for files of sysfs, procfs and their kind.
pub(super) fn is_generated(path: &Path) -> bool {
    #[allow(
        clippy::useless_conversion,
        clippy::unnecessary_cast,
        reason = "the type of a magic number differs between targets"
    )]
    statfs(path).is_ok_and(|fs| GENERATED.contains(&(fs.filesystem_type().0 as i64)))
}

/// A file that is read afresh.
pub struct Attribute {
    file: File,
    path: PathBuf,
    text: bool,
}

impl Attribute {
    /// Opens for reading. `text`: the whole content is one tuple.
    pub fn open(path: &Path, text: bool) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .read(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(path);
        let file = file.map_err(|error| device_error(path, &error))?;
        Ok(Self {
            file,
            path: path.to_owned(),
            text,
        })
    }
}

impl State for Attribute {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        let mut filled = 0;
        while filled < buf.len() {
            match self
                .file
                .read_at(&mut buf[filled..], offset + filled as u64)
            {
                Ok(0) => break,
                Ok(n) => filled += n,
                Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
                Err(error) => return Err(device_error(&self.path, &error)),
            }
            if self.text {
                break; // a second read would be a second sampling
            }
        }
        Ok(filled)
    }

    fn is_text(&self) -> bool {
        self.text
    }
}

/// A file that is written at offset 0, one tuple at a time.
pub struct AttributeSink {
    file: File,
    path: PathBuf,
    text: bool,
}

impl AttributeSink {
    /// Opens for writing. `text`: zero bytes at the end of a tuple are padding and are not sent.
    pub fn open(path: &Path, text: bool) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .write(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(path);
        let file = file.map_err(|error| device_error(path, &error))?;
        Ok(Self {
            file,
            path: path.to_owned(),
            text,
        })
    }
}

impl Sink for AttributeSink {
    fn write(&mut self, tuple: &[u8], _waits: bool) -> Result<(), Error> {
        let mut bytes = tuple;
        if self.text {
            let end = tuple
                .iter()
                .rposition(|&byte| byte != 0)
                .map_or(0, |last| last + 1);
            bytes = &tuple[..end];
        }
        self.file
            .write_all_at(bytes, 0)
            .map_err(|error| device_error(&self.path, &error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_attribute_is_read_afresh_and_written_without_its_padding() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("attribute");
        std::fs::write(&path, "41\n").unwrap();
        let mut source = Attribute::open(&path, true).unwrap();
        let mut buf = [0; 8];
        assert_eq!(source.read_at(0, &mut buf), Ok(3));
        assert_eq!(&buf[..3], b"41\n");
        AttributeSink::open(&path, true)
            .unwrap()
            .write(b"42\n\0\0\0", true)
            .unwrap();
        assert_eq!(source.read_at(0, &mut buf), Ok(3));
        assert_eq!(&buf[..3], b"42\n");
        std::fs::remove_file(&path).unwrap();
        assert!(matches!(
            Attribute::open(&path, true),
            Err(Error::NoDevice(_))
        ));
    }

    #[test]
    fn procfs_is_known_to_be_generated_and_the_temporary_folder_is_not() {
        assert!(is_generated(Path::new("/proc/uptime")));
        assert!(!is_generated(&std::env::current_dir().unwrap()));
    }
}
