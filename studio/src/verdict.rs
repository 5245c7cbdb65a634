//! How a run ended, with the kinds of failure told apart.
//!
//! Owns the kinds, their exit codes and their names in JSON. What people read of them is said by those who tell them.

use sim::judge;

/// How a run ended; a later one is worse.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The task was accomplished.
    Accomplished,
    /// There are no rules, and the program ended without an error.
    Ended,
    /// The program ran, and did not do what the rules demand.
    Wrong,
    /// The model time of the rules or of `--time-limit` was over.
    ModelTime,
    /// The program had an error while it ran.
    Program,
    /// The solution is no program that can begin: a damaged save, a diagram that cannot be understood.
    Structure,
    /// Nothing is known of the solution: its world or rules are broken, a file is missing, a limit of the machine was met.
    NotRun,
}

/// Kinds of ends, in the order of [`Verdict::ALL`].
pub type Counts = [usize; Verdict::ALL.len()];

impl Verdict {
    /// All of them, the best first.
    pub const ALL: [Self; 7] = [
        Self::Accomplished,
        Self::Ended,
        Self::Wrong,
        Self::ModelTime,
        Self::Program,
        Self::Structure,
        Self::NotRun,
    ];

    /// The exit code.
    pub fn code(self) -> u8 {
        match self {
            Self::Accomplished | Self::Ended => 0,
            Self::Wrong | Self::ModelTime | Self::Program => 1,
            Self::Structure | Self::NotRun => 2,
        }
    }

    /// Whether the program ran to a verdict, so that there is a time and there may be points.
    pub fn is_judged(self) -> bool {
        self.code() < 2
    }

    /// Whether nothing is wrong.
    pub fn is_good(self) -> bool {
        self.code() == 0
    }

    /// The field `verdict` of a line of JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Accomplished => "accomplished",
            Self::Ended => "ended",
            Self::Wrong | Self::ModelTime | Self::Program => "failed",
            Self::Structure | Self::NotRun => "broken",
        }
    }

    /// The field `failure` of a line of JSON: the kind of failure, if it is one.
    pub fn failure(self) -> Option<&'static str> {
        match self {
            Self::Accomplished | Self::Ended => None,
            Self::Wrong => Some("wrong"),
            Self::ModelTime => Some("model_time"),
            Self::Program => Some("program"),
            Self::Structure => Some("structure"),
            Self::NotRun => Some("not_run"),
        }
    }

    /// Of both fields.
    pub fn named(name: &str, failure: Option<&str>) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|one| one.name() == name && one.failure() == failure)
    }

    /// Of what the judge says.
    pub fn of(outcome: &judge::Outcome) -> Self {
        match outcome.verdict {
            judge::Verdict::Accomplished => Self::Accomplished,
            judge::Verdict::Ended => Self::Ended,
            judge::Verdict::Unknown => Self::NotRun,
            judge::Verdict::Failed => match outcome.failure {
                None | Some(judge::Failure::Wrong) => Self::Wrong,
                Some(judge::Failure::ModelTime) => Self::ModelTime,
                Some(judge::Failure::Program) => Self::Program,
                Some(judge::Failure::Structure) => Self::Structure,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_is_found_by_its_names() {
        for (index, verdict) in Verdict::ALL.into_iter().enumerate() {
            assert_eq!(verdict as usize, index);
            assert_eq!(
                Verdict::named(verdict.name(), verdict.failure()),
                Some(verdict)
            );
        }
        assert_eq!(Verdict::named("failed", None), None);
        assert!(
            Verdict::ALL
                .windows(2)
                .all(|pair| pair[0].code() <= pair[1].code())
        );
    }
}
