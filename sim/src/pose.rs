//! Where the robot truly is, for people beside it: the file `pose`.
//!
//! One line, written anew while the robot moves: x and y in metres, heading in degrees counter-clockwise, simulated
//! seconds, and how often it has run into a wall. No sensor, no noise, no fault.

use crate::attributes::Attributes;
use crate::files::Part;
use crate::machine::Machine;
use crate::shared::Shared;
use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

/// Between two lines, in simulated time.
const PERIOD_S: f64 = 0.01;

/// The file and what it says.
pub struct PoseFile {
    file: File,
    said: [f64; 4],
}

impl PoseFile {
    /// The file; it says nothing until the board runs.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        Ok(Self {
            file: File::create(attributes.root().join("pose"))?,
            said: [f64::NAN; 4],
        })
    }
}

/// Place, heading and meetings with walls.
fn facts(machine: &Machine) -> [f64; 4] {
    let senses = machine.senses();
    let pose = senses.pose;
    let bumps = f64::from(senses.bumps);
    [pose.at.x, pose.at.y, pose.heading_rad.to_degrees(), bumps]
}

impl Part for PoseFile {
    fn run(&mut self, shared: &Shared) -> f64 {
        let machine = shared.machine();
        let (facts, time_s) = (facts(&machine), machine.time_s());
        drop(machine);
        if facts == self.said {
            return f64::INFINITY;
        }
        self.said = facts;
        let [x, y, heading, bumps] = facts;
        // Every line is as long as the one before: a reader never sees pieces of two.
        let line = format!("{x:8.4} {y:8.4} {heading:10.2} {time_s:10.3} {bumps:6}\n");
        let _ = self.file.write_all_at(line.as_bytes(), 0);
        time_s + PERIOD_S
    }
}
