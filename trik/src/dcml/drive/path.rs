//! A planned path as a drive needs it: which action holds when, how much of each is done until then, and where it ends.
//!
//! Owns what a path must be. The form of its table is known to `rows`.

use super::super::rows::{read, table_of};
use super::port::Driven;
use crate::limits::DRIVE_LONGEST_S;
use crate::refusal::Refusal;
use lang_dcml::robot::{Part, Robot};
use std::path::Path;

/// A path.
pub(super) struct Plan {
    times: Vec<f64>,
    actions: Vec<Vec<f64>>,
    /// Of each action until each time.
    sums: Vec<Vec<f64>>,
    /// States at the same times, if the table has them.
    states: Option<Vec<Vec<f64>>>,
    name: String,
}

fn names(parts: &[Part]) -> Vec<&str> {
    parts.iter().map(|one| one.name.as_str()).collect()
}

impl Plan {
    /// Reads the table of a path.
    ///
    /// # Errors
    /// It is no table of these actions; each with its place.
    pub fn read(path: &Path, robot: &Robot) -> Result<Self, Refusal> {
        let name = path.to_string_lossy().into_owned();
        let text = read(&name)?;
        let (actions, states) = (names(robot.action_parts()), names(robot.state_parts()));
        let outputs = names(robot.output_parts());
        let others = [states.clone(), outputs.clone()].concat();
        let (times, rows) = table_of(&text, &actions, &others)
            .map_err(|(place, why)| Refusal::new(format!("{name}:{place}: {why}")))?;
        if times.len() < 2 {
            let why = "a path has a line for its end: one line is no path";
            return Err(Refusal::new(format!("{name}: {why}")));
        }
        let others = [actions, outputs].concat();
        let states = table_of(&text, &states, &others).ok().map(|(_, rows)| rows);
        let first = times[0];
        let times: Vec<f64> = times.iter().map(|time| time - first).collect();
        let mut sums = vec![vec![0.0; rows[0].len()]];
        for (at, pair) in times.windows(2).enumerate() {
            let seconds = pair[1] - pair[0];
            let held = sums[at].iter().zip(&rows[at]);
            let next = held.map(|(sum, action)| sum + action * seconds).collect();
            sums.push(next);
        }
        Ok(Self {
            times,
            actions: rows,
            sums,
            states,
            name,
        })
    }

    /// Refuses a path that the ports cannot do, before anything moves.
    pub fn check(&self, ports: &[Driven]) -> Result<(), Refusal> {
        let (name, seconds) = (&self.name, self.duration());
        // What is no number is longer than everything.
        let is_short = seconds <= DRIVE_LONGEST_S;
        if !is_short {
            let why = format!(
                "it takes {seconds} s, and a drive takes {DRIVE_LONGEST_S} s at most: look at the column t"
            );
            return Err(Refusal::new(format!("{name}: {why}")));
        }
        let shares = |at: usize| ports[..at].iter().find(|one| one.shares(&ports[at]));
        if let Some((at, other)) = (0..ports.len()).find_map(|at| Some((at, shares(at)?))) {
            let why = format!(
                "{} and {} would drive the same one: give each action a port of its own with --drive",
                other.name(),
                ports[at].name()
            );
            return Err(Refusal::new(why));
        }
        // The actions of the last line are not done, and refused all the same: a path with such a number is not what it should be.
        let rows = self.actions.iter().zip(&self.times);
        for (row, time) in rows {
            for (action, port) in row.iter().zip(ports) {
                if let Some(why) = port.refuses(*action) {
                    return Err(Refusal::new(format!("{name}: at {time} s {why}")));
                }
            }
        }
        Ok(())
    }

    /// Seconds from its beginning to its end.
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or_default()
    }

    fn row(&self, time: f64) -> usize {
        let after = self.times.partition_point(|one| *one <= time);
        after.saturating_sub(1).min(self.times.len() - 2)
    }

    /// The actions at a time; after the end the last ones that were held.
    pub fn at(&self, time: f64) -> &[f64] {
        &self.actions[self.row(time)]
    }

    /// How much of an action is done until a time: its integral.
    pub fn sum(&self, action: usize, time: f64) -> f64 {
        let row = self.row(time);
        let held = time.min(self.duration()) - self.times[row];
        self.sums[row][action] + self.actions[row][action] * held
    }

    /// The state in which it begins; zeros if the table does not say it.
    pub fn start(&self, states: usize) -> Vec<f64> {
        let first = self.states.as_ref().and_then(|all| all.first());
        first.cloned().unwrap_or_else(|| vec![0.0; states])
    }

    /// The state in which it ends, if the table says it.
    pub fn end(&self) -> Option<Vec<f64>> {
        self.states.as_ref().and_then(|all| all.last()).cloned()
    }
}

/// x and y of a state.
pub(super) fn position(robot: &mut Robot, state: &[f64], action: &[f64]) -> Option<[f64; 2]> {
    let mut outputs = vec![0.0; robot.output_parts().len()];
    robot.output(state, action, &mut outputs);
    let of = |name: &str| {
        let states = robot.state_parts().iter().zip(state);
        let mut all = states.chain(robot.output_parts().iter().zip(&outputs));
        all.find(|(part, _)| part.name == name)
            .map(|(_, value)| *value)
    };
    Some([of("x")?, of("y")?])
}
