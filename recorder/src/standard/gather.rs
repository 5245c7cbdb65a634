//! The newest numbers of several nodes that are one message, such as all joints of a robot.
//!
//! Owns when that message is due: once for all that came in one look, and not more often than a limit; and which numbers are
//! too old for it.

use crate::limits::{STANDARD_OLD_NS, STANDARD_PERIOD_NS};
use std::collections::BTreeMap;

/// One node.
#[derive(Debug, Default)]
struct Member {
    /// It has a value for as long as nobody writes another one.
    stays: bool,
    value: Option<(u64, Vec<f64>)>,
}

/// Nodes by their paths.
#[derive(Debug, Default)]
pub(super) struct Gathered {
    members: BTreeMap<String, Member>,
    /// The moment of the newest number that no message has.
    newest_ns: Option<u64>,
    told_ns: u64,
}

impl Gathered {
    /// A node takes part; `stays` if it keeps its value until it is written.
    pub(super) fn join(&mut self, path: &str, stays: bool) {
        let value = None;
        self.members
            .insert(path.to_owned(), Member { stays, value });
    }

    /// It takes part no longer.
    pub(super) fn leave(&mut self, path: &str) {
        self.members.remove(path);
    }

    /// What it has now; None for nothing.
    pub(super) fn set(&mut self, path: &str, value: Option<(u64, Vec<f64>)>) {
        let Some(member) = self.members.get_mut(path) else {
            return;
        };
        if let Some((unix_ns, _)) = value {
            self.newest_ns = Some(self.newest_ns.unwrap_or(0).max(unix_ns));
        }
        member.value = value;
    }

    /// The moment of the message that is due.
    pub(super) fn due(&mut self, is_end: bool) -> Option<u64> {
        let newest_ns = self.newest_ns?;
        // A clock that was set back begins anew.
        let is_early = (self.told_ns..self.told_ns + STANDARD_PERIOD_NS).contains(&newest_ns);
        if is_early && !is_end {
            return None;
        }
        self.told_ns = newest_ns;
        self.newest_ns = None;
        Some(newest_ns)
    }

    /// Those that have a value at this moment.
    pub(super) fn values(&self, now_ns: u64) -> impl Iterator<Item = (&str, &[f64])> {
        self.members.iter().filter_map(move |(path, member)| {
            let (unix_ns, numbers) = member.value.as_ref()?;
            let is_fresh = member.stays || now_ns.saturating_sub(*unix_ns) <= STANDARD_OLD_NS;
            is_fresh.then_some((path.as_str(), numbers.as_slice()))
        })
    }

    /// How many nodes there are.
    pub(super) fn len(&self) -> usize {
        self.members.len()
    }
}
