//! Bytes that the configuration itself holds, as a state or as a stream in time.
//!
//! Owns the turn and the timing. For trying things with no device at hand, and for tests.

use super::{Device, Got, Kind, State, Stream, Surroundings};
use crate::bytes::copy_at;
use crate::errno::Error;
use config::description::FakeDescription;
use std::os::fd::BorrowedFd;
use std::time::{Duration, Instant};

impl Kind for FakeDescription {
    fn open(&self, tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(open(self, tuple_size))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(self.period_ms > 0)
    }
}

/// A state without a period, a stream with one.
fn open(description: &FakeDescription, tuple_size: usize) -> Device {
    let turn = Turn {
        data: description.data.clone(),
        tuple_size,
        at: 0,
        repeat: description.repeat,
    };
    if description.period_ms == 0 {
        return Device::State(Box::new(FakeState {
            turn,
            current: Vec::new(),
        }));
    }
    let period = Duration::from_millis(description.period_ms.into());
    Device::Stream(Box::new(FakeStream {
        turn,
        period,
        due: Instant::now() + period,
    }))
}

/// Which tuple comes next.
struct Turn {
    data: Vec<u8>,
    tuple_size: usize,
    at: usize,
    repeat: bool,
}

impl Turn {
    fn next(&mut self) -> Option<&[u8]> {
        let count = self.data.len() / self.tuple_size.max(1);
        if self.at == count && self.repeat {
            self.at = 0;
        }
        if self.at >= count {
            return None;
        }
        let start = self.at * self.tuple_size;
        self.at += 1;
        Some(&self.data[start..start + self.tuple_size])
    }
}

struct FakeState {
    turn: Turn,
    current: Vec<u8>,
}

impl State for FakeState {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0
            && let Some(tuple) = self.turn.next()
        {
            self.current = tuple.to_vec();
        }
        Ok(copy_at(&self.current, offset, buf))
    }
}

struct FakeStream {
    turn: Turn,
    period: Duration,
    due: Instant,
}

impl Stream for FakeStream {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        if buf.len() < self.turn.tuple_size || Instant::now() < self.due {
            return Ok(Got::Nothing);
        }
        self.due += self.period;
        match self.turn.next() {
            None => Ok(Got::End),
            Some(tuple) => {
                buf[..tuple.len()].copy_from_slice(tuple);
                Ok(Got::Bytes(tuple.len()))
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        None
    }

    fn wake_at(&self) -> Option<Instant> {
        Some(self.due)
    }

    fn begins_anew(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fake(period_ms: u32, repeat: bool) -> Device {
        open(
            &FakeDescription {
                data: vec![1, 2, 3, 4, 5],
                period_ms,
                repeat,
            },
            2,
        )
    }

    #[test]
    fn a_state_takes_turns_and_stays_at_the_last_tuple() {
        let Device::State(mut state) = fake(0, false) else {
            panic!("not a state")
        };
        let mut buf = [0; 2];
        let mut seen = Vec::new();
        for _ in 0..3 {
            assert_eq!(state.read_at(0, &mut buf), Ok(2));
            seen.push(buf);
        }
        assert_eq!(seen, [[1, 2], [3, 4], [3, 4]]);
        assert_eq!(state.read_at(2, &mut buf), Ok(0));
    }

    #[test]
    fn a_stream_gives_nothing_before_its_time() {
        let Device::Stream(mut stream) = fake(3_600_000, true) else {
            panic!("not a stream")
        };
        assert_eq!(stream.read(&mut [0; 2]), Ok(Got::Nothing));
        assert!(stream.wake_at().is_some_and(|due| due > Instant::now()));
    }
}
