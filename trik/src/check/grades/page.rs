//! The table of a class as the page of marks has it, also before all is judged.
//!
//! Owns that form. What is not judged yet counts nothing; points of a column may still change with the runs that come.

use super::{Grades, Run};
use crate::check::words;
use crate::terminal::harmless;
use lang_text::problem::{Locale, Words};
use page::marks::{Cell, Column, Mark, MarkTable, Row, Tone};
use studio::verdict::Verdict;

impl Grades {
    /// The table before the first run.
    pub fn sheet(&self, name: String, waiting: &[usize]) -> MarkTable {
        let columns = self.columns.iter().map(|column| Column {
            name: harmless(&column.name()),
            weight: column.weight,
        });
        MarkTable {
            name,
            pupils: self.pupils.iter().map(|name| harmless(name)).collect(),
            columns: columns.collect(),
            pass_mark: self.pass_mark,
            runs: waiting.iter().sum(),
            rows: (0..self.pupils.len())
                .map(|pupil| self.shown(pupil, waiting))
                .collect(),
            left_out: self.left_out.clone(),
        }
    }

    /// How many runs there are for each pupil and column, row by row.
    pub fn runs_of_cells(&self) -> Vec<usize> {
        let mut counts = vec![0; self.cells.len()];
        for &(pupil, column) in &self.places {
            counts[pupil * self.columns.len() + column] += 1;
        }
        counts
    }

    /// Where a run stands: the pupil, and the number of the cell.
    pub fn place(&self, index: usize) -> Option<(usize, usize)> {
        let &(pupil, column) = self.places.get(index)?;
        Some((pupil, pupil * self.columns.len() + column))
    }

    /// How many rows there are.
    pub fn pupil_count(&self) -> usize {
        self.pupils.len()
    }

    /// A row as it is now, with so many runs of each cell that are not judged.
    pub fn shown(&self, pupil: usize, waiting: &[usize]) -> Row {
        let first = pupil * self.columns.len();
        let cell = |column: usize| Cell {
            waiting: waiting.get(first + column).copied().unwrap_or(0),
            mark: self.cell(pupil, column).map(mark),
        };
        Row {
            cells: (0..self.columns.len()).map(cell).collect(),
            sum: self.sum(pupil),
            passed: self.has_passed(pupil),
        }
    }
}

fn mark(run: &Run) -> Mark {
    Mark {
        run: run.index,
        tone: match run.verdict {
            Verdict::Accomplished | Verdict::Ended => Tone::Good,
            Verdict::Wrong | Verdict::ModelTime | Verdict::Program => Tone::Wrong,
            Verdict::Structure | Verdict::NotRun => Tone::Broken,
        },
        verdict: Words::new(
            words::verdict(run.verdict, Locale::English),
            words::verdict(run.verdict, Locale::Russian),
        ),
        points: run.points,
        ms: run.verdict.is_judged().then_some(run.ms),
        solution: run.solution.clone(),
        why: run.why.clone(),
        replay: run.replay.clone(),
    }
}
