//! A table of marks, as the program that judges tells it.
//!
//! Owns the types alone. Names and texts are those of files of pupils: nothing in them is trusted.

use lang_text::problem::Words;
use std::path::PathBuf;

/// What is known before the first run.
#[derive(Clone, Debug, Default)]
pub struct MarkTable {
    /// What is judged, as a title.
    pub name: String,
    /// The names of the rows.
    pub pupils: Vec<String>,
    /// The columns, in their order.
    pub columns: Vec<Column>,
    /// The sum with which a pupil has passed.
    pub pass_mark: Option<f64>,
    /// How many runs there will be.
    pub runs: usize,
    /// The rows before the first run.
    pub rows: Vec<Row>,
    /// What is not judged, for people, and how much it is.
    pub left_out: (Vec<String>, usize),
}

/// A task in one of its worlds.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// As people write it.
    pub name: String,
    /// What its points are multiplied with.
    pub weight: f64,
}

/// A pupil.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// One for each column.
    pub cells: Vec<Cell>,
    /// Of all points that are known, with their weights.
    pub sum: f64,
    /// Whether that is enough; none without a mark to pass.
    pub passed: Option<bool>,
}

/// What a pupil has in a column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cell {
    /// Runs of it that are not judged yet.
    pub waiting: usize,
    /// The best of those that are.
    pub mark: Option<Mark>,
}

/// How a mark looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// The task was accomplished.
    Good,
    /// It was not.
    Wrong,
    /// It could not be judged.
    Broken,
}

/// A run that was judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Its number among all runs.
    pub run: usize,
    /// How it looks.
    pub tone: Tone,
    /// How it ended.
    pub verdict: Words,
    /// None: it was not judged.
    pub points: Option<f64>,
    /// When it ended, in milliseconds of its own time.
    pub ms: Option<u32>,
    /// The solution, as people write it.
    pub solution: String,
    /// The first error in what the rules said; may be empty.
    pub why: String,
    /// The page of its replay.
    pub replay: Option<PathBuf>,
}
