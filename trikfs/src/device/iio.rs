//! Sensors that Linux IIO samples into a buffer.
//!
//! Owns how a device is found by its name, switched on before its samples are read and off when nobody reads, and
//! how a sample becomes a tuple. What a sample looks like, `scan` knows. One process at a time can have the buffer
//! of a device open, so this source is always shared.

mod scan;

use super::cutter::{Cut, Cutter};
use super::{Device, Got, Kind, Stream, Surroundings, chardev, device_error, fifo, sysfs};
use crate::convert::LogSink;
use crate::errno::Error;
use crate::limits;
use crate::stats::Counter;
use config::description::IioDescription;
use scan::Scan;
use std::os::fd::BorrowedFd;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

impl Kind for IioDescription {
    fn open(&self, _tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        let iio = Iio::open(self, around.damaged.clone(), &around.log)?;
        Ok(Device::Stream(Box::new(iio)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A device that samples.
pub struct Iio {
    bytes: Box<dyn Stream>,
    cutter: Cutter<Samples>,
    /// `buffer/enable`, written again when this is dropped.
    enable: PathBuf,
    node: PathBuf,
}

impl Iio {
    /// Finds the device, opens it and switches it on.
    pub fn open(
        description: &IioDescription,
        damaged: Arc<Counter>,
        log: &LogSink,
    ) -> Result<Self, Error> {
        let (folder, position) = find(description)?;
        let node = description
            .nodes
            .join(folder.file_name().unwrap_or_default());
        // Before anything is changed: a process that has it open now has made its settings.
        let bytes = open_node(&node)?;
        let enable = folder.join("buffer/enable");
        // Channels cannot be chosen while the buffer runs.
        sysfs::write(&enable, "0")?;
        let scan = configure(&folder, description, log)?;
        sysfs::write(&enable, "1")?;
        let raw_size = limits::PORT_READ_BYTES / scan.size().max(1) * scan.size();
        let samples = Samples {
            scan,
            position: description.gives_position.then_some(position),
        };
        let size = description.tuple_size();
        let raw_size = raw_size.max(samples.scan.size());
        Ok(Self {
            bytes,
            cutter: Cutter::new(samples, size, raw_size, damaged),
            enable,
            node,
        })
    }
}

/// The folder of the first name that a device has, and the position of the name from 1.
fn find(description: &IioDescription) -> Result<(PathBuf, i32), Error> {
    let devices = &description.devices;
    let entries = std::fs::read_dir(devices).map_err(|error| device_error(devices, &error))?;
    let mut known = Vec::new();
    for entry in entries.flatten().take(limits::IIO_DEVICES_MAX) {
        let path = entry.path();
        let is_device = path
            .file_name()
            .is_some_and(|name| name.as_encoded_bytes().starts_with(b"iio:device"));
        if is_device && let Ok(name) = sysfs::read(&path.join("name")) {
            known.push((path, name));
        }
    }
    // Of two devices with one name the one with the lower number, every time.
    known.sort_by(|(a, _), (b, _)| (a.as_os_str().len(), a).cmp(&(b.as_os_str().len(), b)));
    for (position, name) in (1..).zip(&description.names) {
        if let Some((path, _)) = known.iter().find(|(_, other)| other == name) {
            return Ok((path.clone(), position));
        }
    }
    let names: Vec<_> = known.into_iter().map(|(_, name)| name).collect();
    Err(Error::NoDevice(format!(
        "{}: there is no {}; there are: {}",
        devices.display(),
        description.names.join(" or "),
        if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        }
    )))
}

fn open_node(node: &Path) -> Result<Box<dyn Stream>, Error> {
    let meta = std::fs::metadata(node).map_err(|error| device_error(node, &error))?;
    Ok(if meta.file_type().is_fifo() {
        Box::new(fifo::Fifo::open(node)?)
    } else if meta.file_type().is_char_device() {
        Box::new(chardev::CharDevice::open(node)?)
    } else {
        let what = format!("{} is no device node", node.display());
        return Err(Error::NoDevice(what));
    })
}

/// Chooses channels and rate, and reads what a sample then looks like.
fn configure(folder: &Path, description: &IioDescription, log: &LogSink) -> Result<Scan, Error> {
    let elements = folder.join("scan_elements");
    for channel in &description.channels {
        let switch = elements.join(format!("in_{channel}_en"));
        if !switch.exists() {
            return Err(Error::NoDevice(format!(
                "{}: there is no channel '{channel}' ({} is missing)",
                folder.display(),
                switch.display()
            )));
        }
        sysfs::write(&switch, "1")?;
    }
    // The kernel's own choice is two samples, too few for a moment in which nobody reads.
    let length = limits::IIO_BUFFER_SAMPLES.to_string();
    let _ = sysfs::write(&folder.join("buffer/length"), &length);
    if let Some(hz) = description.sampling_frequency {
        set_frequency(folder, &description.channels, hz, log);
    }
    Scan::read(&elements, &description.channels)
}

/// Asks for a rate. A driver that does not know it goes on with its own: samples carry their time.
fn set_frequency(folder: &Path, channels: &[String], hz: f64, log: &LogSink) {
    let mut names = vec!["sampling_frequency".to_owned()];
    for channel in channels {
        // `in_accel_sampling_frequency` is that of all channels `accel_x`, `accel_y` ...
        let group = channel
            .rsplit_once('_')
            .map_or(&**channel, |(group, _)| group);
        for group in [group, channel] {
            names.push(format!("in_{group}_sampling_frequency"));
        }
    }
    let present = names
        .iter()
        .map(|name| folder.join(name))
        .find(|path| path.exists());
    let outcome = match &present {
        Some(path) => sysfs::write(path, &hz.to_string()).map_err(|error| error.to_string()),
        None => Err(format!(
            "{}: it has no sampling_frequency",
            folder.display()
        )),
    };
    if let Err(reason) = outcome {
        log(&format!(
            "a sampling frequency of {hz} Hz cannot be set: {reason}"
        ));
    }
}

impl Drop for Iio {
    fn drop(&mut self) {
        // A device that is gone needs no switching off.
        let _ = sysfs::write(&self.enable, "0");
    }
}

impl Stream for Iio {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        match self.cutter.read(self.bytes.as_mut(), buf)? {
            // Opening it anew beside the old opening would be refused, so this is a loss and not an end.
            Got::End => Err(Error::NoDevice(format!(
                "{}: the device gives no samples any more",
                self.node.display()
            ))),
            got => Ok(got),
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        self.bytes.fd()
    }

    fn wake_at(&self) -> Option<Instant> {
        self.cutter.wake_at()
    }

    fn is_still_there(&self) -> bool {
        self.bytes.is_still_there()
    }
}

/// Samples to tuples.
struct Samples {
    scan: Scan,
    position: Option<i32>,
}

impl Cut for Samples {
    fn cut(&mut self, input: &[u8], _is_end: bool, tuple: &mut [u8]) -> (usize, bool) {
        let Some(sample) = input.get(..self.scan.size()) else {
            return (input.len(), false);
        };
        match self.position {
            Some(position) => {
                let (head, tail) = tuple.split_at_mut(4);
                head.copy_from_slice(&position.to_le_bytes());
                self.scan.decode(sample, tail);
            }
            None => self.scan.decode(sample, tuple),
        }
        (sample.len(), true)
    }

    /// The kernel gives whole samples. Where one begins in anything else, nobody knows.
    fn accepts(&self, read: &[u8]) -> bool {
        read.len().is_multiple_of(self.scan.size())
    }

    fn take_damaged(&mut self) -> u32 {
        0
    }
}

#[cfg(test)]
mod tests;
