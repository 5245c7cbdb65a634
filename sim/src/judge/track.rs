//! What a robot and its program did beside moving: motors, readings, variables and blocks, each change with its time.
//!
//! Owns how much of a long run is kept: when it is too much, changes that follow one another within twice the time become
//! one, the last of them. Knows no world: names and texts come from outside. Nothing of it exists unless it is wanted.

use crate::limits;
use std::collections::HashMap;

/// What a value belongs to.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Group {
    /// Blocks at which the threads of a program are, by the thread.
    Block,
    /// Motors and servomotors, by the port: power in percent, angle in degrees.
    Motor,
    /// Sensors and encoders, by the port, as program or rules have read them.
    Sensor,
    /// Variables of the program.
    Variable,
}

impl Group {
    /// All, in the order in which they are shown.
    pub const ALL: [Self; 4] = [Self::Block, Self::Motor, Self::Sensor, Self::Variable];
}

/// The changes of one value.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Column {
    /// What it belongs to.
    pub group: Group,
    /// Its name there.
    pub name: String,
    /// Milliseconds of model time and the value from then on, in order.
    pub changes: Vec<(u32, String)>,
}

/// All that was noted of a run.
#[derive(Clone, Debug)]
pub struct Track {
    columns: Vec<Column>,
    index: HashMap<(Group, String), usize>,
    /// Values that were noted in this round, to see which are gone.
    seen: Vec<bool>,
    /// At most one change of a value in so many milliseconds is kept.
    period_ms: u32,
    bytes: usize,
}

impl Default for Track {
    fn default() -> Self {
        Self {
            columns: Vec::new(),
            index: HashMap::new(),
            seen: Vec::new(),
            period_ms: 1,
            bytes: 0,
        }
    }
}

/// Bytes that a change takes in a page beside its text.
const CHANGE_BYTES: usize = 10;

impl Track {
    /// Notes the value of something at a moment.
    pub fn note(&mut self, group: Group, name: &str, now: u32, value: &str) {
        let found = self.index.get(&(group, name.to_owned())).copied();
        let column = match found {
            Some(column) => column,
            None if self.columns.len() >= limits::TRACK_COLUMNS => return,
            None => {
                self.index
                    .insert((group, name.to_owned()), self.columns.len());
                self.columns.push(Column {
                    group,
                    name: brief(name),
                    changes: Vec::new(),
                });
                self.seen.push(false);
                self.columns.len() - 1
            }
        };
        self.seen[column] = true;
        self.change(column, now, value);
    }

    /// Whether something was noted before.
    pub fn has(&self, group: Group, name: &str) -> bool {
        self.index.contains_key(&(group, name.to_owned()))
    }

    /// A round of notes is over: blocks of threads that were not noted in it are gone.
    pub fn round(&mut self, now: u32) {
        for column in 0..self.columns.len() {
            let was_seen = std::mem::replace(&mut self.seen[column], false);
            if !was_seen && self.columns[column].group == Group::Block {
                self.change(column, now, "");
            }
        }
        // In the end one change of each is left, and limits see to it that those are not too many.
        while self.bytes > limits::TRACK_BYTES && self.period_ms < limits::RUN_MS_MAX {
            self.thin();
        }
    }

    fn change(&mut self, column: usize, now: u32, value: &str) {
        let value = brief(value);
        let changes = &mut self.columns[column].changes;
        if changes.last().is_some_and(|(_, last)| *last == value) {
            return;
        }
        self.bytes += CHANGE_BYTES + value.len();
        let period_ms = self.period_ms;
        let is_same = |last: &(u32, String)| last.0 / period_ms == now / period_ms;
        // The first one stands: it is where the value began.
        if changes.len() > 1 && changes.last().is_some_and(is_same) {
            let gone = changes.pop();
            self.bytes -= gone.map_or(0, |(_, text)| CHANGE_BYTES + text.len());
        }
        changes.push((now, value));
    }

    /// Half as much, at least of what changes fast.
    fn thin(&mut self) {
        self.period_ms = self.period_ms.saturating_mul(2);
        let period_ms = self.period_ms;
        self.bytes = 0;
        for column in &mut self.columns {
            let all = std::mem::take(&mut column.changes);
            for (ms, value) in all {
                let is_same = |last: &(u32, String)| last.0 / period_ms == ms / period_ms;
                if column.changes.last().is_some_and(is_same) {
                    column.changes.pop();
                }
                // What came back to what it was has not changed.
                if column.changes.last().is_none_or(|(_, last)| *last != value) {
                    column.changes.push((ms, value));
                }
            }
            let texts = column.changes.iter();
            self.bytes += texts
                .map(|(_, text)| CHANGE_BYTES + text.len())
                .sum::<usize>();
        }
    }

    /// The values in the order in which they are shown: by group, then by name, numbers in names as numbers.
    pub fn columns(&self) -> Vec<&Column> {
        let mut all: Vec<&Column> = self.columns.iter().collect();
        all.sort_by(|one, other| (one.group, &one.name).cmp(&(other.group, &other.name)));
        all
    }
}

/// The beginning of a text.
fn brief(text: &str) -> String {
    let mut chars = text.chars();
    let mut brief: String = chars.by_ref().take(limits::TRACK_CHARS).collect();
    if chars.next().is_some() {
        brief.push_str("...");
    }
    brief
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_changes_are_kept_and_a_thread_that_ends_has_no_block() {
        let mut track = Track::default();
        for (ms, power, block) in [
            (0, "0", Some("Start")),
            (10, "0", Some("Wait")),
            (20, "60", None),
        ] {
            track.note(Group::Motor, "M3", ms, power);
            if let Some(block) = block {
                track.note(Group::Block, "main", ms, block);
            }
            track.round(ms);
        }
        let columns = track.columns();
        let change = |ms, value: &str| (ms, value.to_owned());
        assert_eq!(columns[0].name, "main");
        let blocks = [change(0, "Start"), change(10, "Wait"), change(20, "")];
        assert_eq!(columns[0].changes, blocks);
        assert_eq!(columns[1].changes, [change(0, "0"), change(20, "60")]);
    }

    #[test]
    fn the_longest_run_is_kept_within_its_bounds_and_its_last_values_are_right() {
        let mut track = Track::default();
        for ms in (0..600_000).step_by(10) {
            for variable in 0..30 {
                let name = format!("v{variable}");
                track.note(Group::Variable, &name, ms, &format!("{}", ms + variable));
            }
            track.round(ms);
        }
        let columns = track.columns();
        let bytes: usize = columns
            .iter()
            .flat_map(|column| &column.changes)
            .map(|(_, text)| CHANGE_BYTES + text.len())
            .sum();
        assert!(bytes <= limits::TRACK_BYTES, "{bytes}");
        assert!(bytes > limits::TRACK_BYTES / 4, "{bytes}");
        assert_eq!(
            columns[0].changes.last(),
            Some(&(599_990, "599990".to_owned()))
        );
        for number in 0..2000 {
            track.note(
                Group::Variable,
                &format!("w{number}"),
                600_000,
                &"x".repeat(5000),
            );
        }
        assert_eq!(track.columns().len(), limits::TRACK_COLUMNS);
    }
}
