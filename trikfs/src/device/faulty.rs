//! A source that fails on purpose, so that what happens then can be tried and tested.
//!
//! Owns counting the reads and choosing the failure. The source within it knows nothing of this.

use super::{Device, Got, Kind, Patience, Sink, State, Stream, Surroundings, kinds};
use crate::errno::Error;
use config::description::FaultyDescription;
use std::collections::BTreeSet;
use std::os::fd::BorrowedFd;
use std::path::PathBuf;
use std::time::{Duration, Instant};

impl Kind for FaultyDescription {
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        let device = kinds::open(&self.source, tuple_size, around)?;
        Ok(put_before(self, device))
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        let sink = kinds::open_sink(&self.source, around)?;
        Ok(Box::new(FaultySink::new(self, sink)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        kinds::is_shared(&self.source)
    }

    fn add_buses(&self, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        kinds::add_buses(&self.source, around, buses);
    }
}

/// Puts the failures in front of an open source.
fn put_before(description: &FaultyDescription, device: Device) -> Device {
    let plan = Plan::new(description);
    match device {
        Device::State(state) => Device::State(Box::new(FaultyState { state, plan })),
        Device::Stream(stream) => Device::Stream(Box::new(FaultyStream { stream, plan })),
    }
}

/// Which call fails, and how.
struct Plan {
    errno: i32,
    from: u32,
    count: u32,
    short: usize,
    calls: u32,
}

impl Plan {
    fn new(description: &FaultyDescription) -> Self {
        let FaultyDescription {
            errno,
            from,
            count,
            short,
            ..
        } = *description;
        Self {
            errno,
            from,
            count,
            short,
            calls: 0,
        }
    }

    /// None: go on. Some(None): end of file. Some(Some(error)): fail.
    fn next(&mut self) -> Option<Option<Error>> {
        self.calls = self.calls.saturating_add(1);
        let since = self.calls.checked_sub(self.from)?;
        if self.count != 0 && since >= self.count {
            return None;
        }
        Some((self.errno != 0).then(|| Error::of_number("faulty source".to_owned(), self.errno)))
    }

    fn limit(&self, len: usize) -> usize {
        if self.short == 0 {
            len
        } else {
            len.min(self.short)
        }
    }
}

struct FaultyState {
    state: Box<dyn State>,
    plan: Plan,
}

impl State for FaultyState {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        match self.plan.next() {
            Some(Some(error)) => Err(error),
            Some(None) => Ok(0),
            None => {
                let len = self.plan.limit(buf.len());
                self.state.read_at(offset, &mut buf[..len])
            }
        }
    }

    fn is_text(&self) -> bool {
        self.state.is_text()
    }

    fn is_silent(&self) -> bool {
        self.state.is_silent()
    }
}

struct FaultyStream {
    stream: Box<dyn Stream>,
    plan: Plan,
}

impl Stream for FaultyStream {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        match self.plan.next() {
            Some(Some(error)) => Err(error),
            Some(None) => Ok(Got::End),
            None => {
                let len = self.plan.limit(buf.len());
                self.stream.read(&mut buf[..len])
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        self.stream.fd()
    }

    fn wake_at(&self) -> Option<Instant> {
        self.stream.wake_at()
    }

    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        self.stream.is_silent(open, patience)
    }

    fn is_still_there(&self) -> bool {
        self.stream.is_still_there()
    }

    fn tells_changes_only(&self) -> bool {
        self.stream.tells_changes_only()
    }

    fn begins_anew(&self) -> bool {
        self.stream.begins_anew()
    }
}

/// A sink whose writes fail by the same plan.
pub struct FaultySink {
    sink: Box<dyn Sink>,
    plan: Plan,
}

impl FaultySink {
    /// Puts the failures in front of an open sink.
    pub fn new(description: &FaultyDescription, sink: Box<dyn Sink>) -> Self {
        Self {
            sink,
            plan: Plan::new(description),
        }
    }
}

impl Sink for FaultySink {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        match self.plan.next() {
            Some(Some(error)) => Err(error),
            Some(None) => Err(Error::NoDevice("faulty source".to_owned())),
            None => self.sink.write(tuple, waits),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::description::SourceDescription;

    #[test]
    fn exactly_the_planned_calls_fail() {
        let source = Box::new(SourceDescription::Path("/dev/zero".into()));
        let plan = FaultyDescription {
            source,
            errno: libc::EIO,
            from: 2,
            count: 2,
            short: 3,
        };
        let zero = super::super::chardev::CharDevice::open("/dev/zero".as_ref()).unwrap();
        let Device::Stream(mut stream) = put_before(&plan, Device::Stream(Box::new(zero))) else {
            panic!("not a stream")
        };
        let mut buf = [0; 8];
        assert_eq!(stream.read(&mut buf), Ok(Got::Bytes(3)));
        assert!(matches!(
            stream.read(&mut buf),
            Err(Error::Device(libc::EIO, _))
        ));
        assert!(stream.read(&mut buf).is_err());
        assert_eq!(stream.read(&mut buf), Ok(Got::Bytes(3)));
    }
}
