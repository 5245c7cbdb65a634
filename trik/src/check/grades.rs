//! The table of a class: a row for each pupil, a column for each task and field, points, sums and a mark to pass.
//!
//! Owns what a cell is worth; each form of the table is a file of `grades/`. Whose a run is, is known to `class`; how it
//! ended, to `row`.

mod csv;
mod html;
mod ods;
mod page;

use super::class::{Column, Plan};
use super::grade_args::{Form, GradeArgs, Source};
use super::row::Row;
use super::words;
use crate::output::Output;
use crate::refusal::Refusal;
use crate::terminal::{harmless, named};
use lang_text::problem::Locale;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use studio::verdict::Verdict;

/// One run as the table keeps it.
#[derive(Clone, Debug)]
struct Run {
    /// Its number among all runs.
    index: usize,
    pupil: usize,
    column: usize,
    solution: String,
    field: Option<String>,
    verdict: Verdict,
    ms: u32,
    total_score: Option<f64>,
    in_words: Option<f64>,
    last_number: Option<i64>,
    why: String,
    /// The page of the replay, if there is one.
    replay: Option<PathBuf>,
    /// Once all are known.
    points: Option<f64>,
}

/// The table.
#[derive(Clone, Debug)]
pub(super) struct Grades {
    locale: Locale,
    pupils: Vec<String>,
    columns: Vec<Column>,
    places: Vec<(usize, usize)>,
    source: Source,
    pass_mark: Option<f64>,
    runs: Vec<Run>,
    /// What is not judged, for people, and how much it is.
    left_out: (Vec<String>, usize),
    /// Columns in which a run has points of its own.
    pointed: BTreeSet<usize>,
    /// The run that counts for each pupil and column, row by row.
    cells: Vec<Option<usize>>,
}

impl Grades {
    /// Before the first run.
    pub fn new(plan: Plan, args: &GradeArgs, locale: Locale) -> Self {
        Self {
            locale,
            cells: vec![None; plan.pupils.len() * plan.columns.len()],
            pupils: plan.pupils,
            columns: plan.columns,
            places: plan.places,
            source: args.points,
            pass_mark: args.pass_mark,
            runs: Vec::new(),
            left_out: (plan.left_out, plan.left_out_count),
            pointed: BTreeSet::new(),
        }
    }

    /// Keeps what came of a run. In whatever order they come, they stand in that of the runs.
    pub fn add(&mut self, index: usize, row: &Row, replay: Option<PathBuf>) {
        let Some(&(pupil, column)) = self.places.get(index) else {
            return;
        };
        let run = Run {
            index,
            pupil,
            column,
            solution: harmless(&row.solution),
            field: row.field.as_deref().map(harmless),
            verdict: row.verdict,
            ms: row.ms,
            total_score: row.score(),
            in_words: row.points_in_words(),
            last_number: row.last_number(),
            why: harmless(row.why()),
            replay,
            points: None,
        };
        let at = self.runs.partition_point(|other| other.index < index);
        self.runs.insert(at, run);
    }

    /// Works out points of the runs that are known. Of several solutions for a task the best one counts. True: a column has
    /// points of its own that had none, so that other cells of it may have changed.
    pub fn settle(&mut self) -> bool {
        self.cells.fill(None);
        let pointed: BTreeSet<usize> = self
            .runs
            .iter()
            .filter(|run| run.total_score.or(run.in_words).is_some())
            .map(|run| run.column)
            .collect();
        for index in 0..self.runs.len() {
            let run = &mut self.runs[index];
            let done = f64::from(u8::from(run.verdict.is_good()));
            let points = match self.source {
                Source::Auto if pointed.contains(&run.column) => run.total_score.or(run.in_words),
                Source::Auto | Source::Accomplished => Some(done),
                Source::TotalScore => run.total_score,
                Source::Words => run.in_words,
                Source::LastNumber => run.last_number.map(|number| number as f64),
            };
            let points = points.unwrap_or(0.0);
            run.points = run.verdict.is_judged().then_some(points);
            let rank = |run: &Run| (run.points, std::cmp::Reverse(run.verdict));
            let cell = run.pupil * self.columns.len() + run.column;
            let is_better =
                self.cells[cell].is_none_or(|old| rank(&self.runs[index]) > rank(&self.runs[old]));
            if is_better {
                self.cells[cell] = Some(index);
            }
        }
        let others_change = pointed != self.pointed;
        self.pointed = pointed;
        others_change
    }

    /// The run that counts for a pupil in a column.
    fn cell(&self, pupil: usize, column: usize) -> Option<&Run> {
        let index = self.cells[pupil * self.columns.len() + column]?;
        self.runs.get(index)
    }

    /// The sum of a pupil, with weights.
    fn sum(&self, pupil: usize) -> f64 {
        let columns = self.columns.iter().enumerate();
        let points = columns.map(|(index, column)| {
            let points = self.cell(pupil, index).and_then(|run| run.points);
            points.unwrap_or(0.0) * column.weight
        });
        // What a person adds up in decimals has no digits beyond them.
        (points.sum::<f64>() * 1e9).round() / 1e9
    }

    /// Whether a pupil has passed, if there is a mark.
    fn has_passed(&self, pupil: usize) -> Option<bool> {
        self.pass_mark.map(|mark| self.sum(pupil) >= mark)
    }

    /// What a person reads in a cell: how it ended, or that there is none.
    fn result(&self, run: Option<&Run>) -> &'static str {
        run.map_or(words::missing(self.locale), |run| {
            words::verdict(run.verdict, self.locale)
        })
    }

    /// Whether columns have different weights.
    fn has_weights(&self) -> bool {
        self.columns.iter().any(|column| column.weight != 1.0)
    }

    /// The bytes of a form; a page is at a path, from where its links go.
    fn write(&self, form: Form, path: &Path) -> Result<Vec<u8>, Refusal> {
        match form {
            Form::Csv => Ok(csv::write(self).into_bytes()),
            Form::Ods => {
                let written = ods::write(self);
                written.map_err(|words| {
                    let why = words.in_locale(self.locale);
                    Refusal::new(format!("{}: {why}", named(path)))
                })
            }
            Form::Html => Ok(html::write(self, path).into_bytes()),
        }
    }

    /// Writes all forms, and tells a line for each.
    ///
    /// # Errors
    /// What the system says of a file.
    pub fn finish(mut self, outputs: &[Output<'_>]) -> Result<Vec<String>, Refusal> {
        self.settle();
        let missing = self.cells.iter().filter(|cell| cell.is_none()).count();
        let mut lines = Vec::new();
        for output in outputs {
            let path = output.path.unwrap_or(Path::new("-"));
            let form = Form::of(path).unwrap_or(Form::Csv);
            output.write(&self.write(form, path)?)?;
            let counts = [self.pupils.len(), self.columns.len(), missing];
            lines.push(words::graded(&named(path), counts, self.locale));
        }
        Ok(lines)
    }
}

/// A number as tables have it: no more digits than it needs.
fn number(number: f64) -> String {
    // Minus zero is what nobody has earned.
    (number + 0.0).to_string()
}

#[cfg(test)]
mod tests;
