//! What the sensors of a robot have said last, and what rules do to them.
//!
//! Owns the last reading of each sensor with one number, which of them are locked, and readings that a rule has given to a
//! sensor and no program has heard of. Knows no sensors: the code that reads one notes it here.
//!
//! Facts are those of the original: a rule sees what was read last and reads nothing itself; a locked sensor is not read
//! every 20 ms, but a block that waits for it reads it all the same.

use crate::limits;
use std::collections::VecDeque;

use lang_diagram::ports::Port;

/// How often sensors are read that nobody else has read, in milliseconds.
pub(super) const RENEWAL_MS: u32 = 20;
/// More than there are ports.
const PORTS: usize = 64;

/// Last readings of a robot.
#[derive(Clone, Debug)]
pub struct Readings {
    last: [i32; PORTS],
    /// When each one was read, in milliseconds.
    read_at: [u32; PORTS],
    /// A bit for each locked port.
    locked: u64,
    /// A bit for each port that a rule has asked for.
    watched: u64,
    announced: VecDeque<(Port, i32)>,
}

impl Default for Readings {
    fn default() -> Self {
        Self {
            last: [0; PORTS],
            read_at: [0; PORTS],
            locked: 0,
            watched: 0,
            announced: VecDeque::new(),
        }
    }
}

fn place(port: Port) -> usize {
    usize::from(port.index()) % PORTS
}

impl Readings {
    /// The last reading; 0 before the first one.
    pub fn last(&self, port: Port) -> i32 {
        self.last[place(port)]
    }

    /// Whether program or rules have read it.
    pub fn is_read(&self, port: Port) -> bool {
        self.read_at[place(port)] > 0
    }

    /// A sensor was read.
    pub(super) fn note(&mut self, port: Port, reading: i32, now: u32) {
        self.last[place(port)] = reading;
        self.read_at[place(port)] = now;
    }

    /// A rule gives a sensor a reading, which its program hears of at once.
    pub fn give(&mut self, port: Port, reading: i32) {
        self.last[place(port)] = reading;
        if self.announced.len() == limits::ANNOUNCED_MAX {
            self.announced.pop_front();
        }
        self.announced.push_back((port, reading));
    }

    /// The next reading that a program has not heard of.
    pub(super) fn announced(&mut self) -> Option<(Port, i32)> {
        self.announced.pop_front()
    }

    /// Locks a sensor or lets it go.
    pub fn lock(&mut self, port: Port, is_locked: bool) {
        let bit = 1 << place(port);
        self.locked = if is_locked {
            self.locked | bit
        } else {
            self.locked & !bit
        };
    }

    /// Whether a sensor is locked.
    pub fn is_locked(&self, port: Port) -> bool {
        self.locked & 1 << place(port) != 0
    }

    /// A rule asks for this sensor: it is read every now and then from here on.
    pub fn watch(&mut self, port: Port) {
        self.watched |= 1 << place(port);
    }

    /// Ports that are due to be read at a moment.
    pub(super) fn due(&self, now: u32) -> Vec<Port> {
        if self.watched == 0 {
            return Vec::new();
        }
        let is_due = |port: &Port| {
            let is_watched = self.watched & 1 << place(*port) != 0;
            is_watched && !self.is_locked(*port) && self.read_at[place(*port)] != now
        };
        Port::all().filter(is_due).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_port_has_a_place_of_its_own() {
        assert!(Port::all().count() <= PORTS);
    }

    #[test]
    fn a_locked_sensor_is_not_due_and_a_given_reading_is_heard_once() {
        let port = Port::named("A1").unwrap();
        let mut readings = Readings::default();
        assert!(readings.due(20).is_empty());
        readings.watch(port);
        assert_eq!(readings.due(20), [port]);
        readings.note(port, 7, 20);
        assert_eq!((readings.due(20).len(), readings.last(port)), (0, 7));
        readings.lock(port, true);
        assert!(readings.due(40).is_empty() && readings.is_locked(port));
        readings.give(port, 9);
        assert_eq!(readings.last(port), 9);
        assert_eq!(readings.announced(), Some((port, 9)));
        assert_eq!(readings.announced(), None);
        readings.lock(port, false);
        assert_eq!(readings.due(40), [port]);
    }
}
