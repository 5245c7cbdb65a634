//! A plain path: what stands there decides how it is read and written.
//!
//! Owns that decision. It is made anew at each opening, because a device may appear later as something else.

use super::attribute::{self, Attribute, AttributeSink};
use super::chardev::{CharDevice, CharSink};
use super::fifo::Fifo;
use super::{Device, Kind, Sink, Surroundings, device_error};
use crate::errno::Error;
use config::description::PathDescription;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::Path;

impl Kind for PathDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        let path = &self.path;
        Ok(match kind_of(path)? {
            PathKind::Attribute => Device::State(Box::new(Attribute::open(path, true)?)),
            PathKind::Regular => Device::State(Box::new(Attribute::open(path, false)?)),
            PathKind::Fifo => Device::Stream(Box::new(Fifo::open(path)?)),
            PathKind::CharDevice | PathKind::SharedDevice => {
                Device::Stream(Box::new(CharDevice::open(path)?))
            }
        })
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        let path = &self.path;
        Ok(match kind_of(path)? {
            PathKind::Attribute => Box::new(AttributeSink::open(path, true)?),
            PathKind::Regular => Box::new(AttributeSink::open(path, false)?),
            PathKind::CharDevice | PathKind::SharedDevice | PathKind::Fifo => {
                Box::new(CharSink::open(path, around.timeout_ms)?)
            }
        })
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(match kind_of(&self.path)? {
            PathKind::Fifo | PathKind::SharedDevice => true,
            PathKind::Attribute | PathKind::Regular | PathKind::CharDevice => false,
        })
    }
}

/// What a plain path is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PathKind {
    /// A file of sysfs, procfs or the like, whose content is made when it is read.
    Attribute,
    /// A regular file, a block device or a display: tuples at their places.
    Regular,
    /// A character device that each handle may open for itself.
    CharDevice,
    /// A terminal or input device: one queue for all readers.
    SharedDevice,
    /// A named pipe.
    Fifo,
}

/// Major numbers of Linux terminals (4, 5, 136-143, 188 USB serial, 166 ACM, 204 low-density serial) and of input (13).
/// Source: Documentation/admin-guide/devices.txt of the kernel.
const SHARED_MAJORS: [u32; 14] = [
    4, 5, 13, 136, 137, 138, 139, 140, 141, 142, 143, 166, 188, 204,
];

/// Major number of frame buffers: a picture is written from the beginning each time (the same source).
const DISPLAY_MAJOR: u32 = 29;

fn kind_of(path: &Path) -> Result<PathKind, Error> {
    let meta = std::fs::metadata(path).map_err(|error| device_error(path, &error))?;
    let kind = meta.file_type();
    if kind.is_fifo() {
        return Ok(PathKind::Fifo);
    }
    if kind.is_char_device() {
        let major = u32::try_from((meta.rdev() >> 8) & 0xfff).unwrap_or(0);
        if major == DISPLAY_MAJOR {
            return Ok(PathKind::Regular);
        }
        let shared = SHARED_MAJORS.contains(&major);
        return Ok(if shared {
            PathKind::SharedDevice
        } else {
            PathKind::CharDevice
        });
    }
    if kind.is_dir() {
        return Err(Error::NoDevice(format!(
            "{} is a directory",
            path.display()
        )));
    }
    if kind.is_socket() {
        return Err(Error::NoDevice(format!("{} is a socket", path.display())));
    }
    Ok(if attribute::is_generated(path) {
        PathKind::Attribute
    } else {
        PathKind::Regular
    })
}
