//! The rows of all pupils, and how far the judging is.
//!
//! Owns them, and who is told of a change. Only the newest of a row is ever shown, so a viewer that is slow misses what lay
//! between and delays nobody.

use super::sheet::{Column, MarkTable, Row};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::watch;

/// How far the judging is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Runs that are judged.
    pub done: usize,
    /// Of so many.
    pub all: usize,
    /// Nothing more comes.
    pub is_over: bool,
}

/// What viewers are told once.
pub struct Title {
    pub name: String,
    pub pupils: Vec<String>,
    pub columns: Vec<Column>,
    pub pass_mark: Option<f64>,
    pub left_out: (Vec<String>, usize),
}

/// What changes, each with the number of its last change.
struct State {
    rows: Vec<(u64, Row)>,
    progress: (u64, Progress),
}

/// The table.
pub struct Board {
    pub title: Title,
    state: Mutex<State>,
    /// The number of the last change of all.
    changes: watch::Sender<u64>,
}

impl Board {
    /// Before the first run.
    pub fn new(sheet: MarkTable) -> Self {
        let mut rows = sheet.rows;
        rows.resize_with(sheet.pupils.len(), Row::default);
        let progress = Progress {
            all: sheet.runs,
            ..Progress::default()
        };
        // The first state is a change, so that a viewer who has seen nothing is told of it.
        let state = State {
            rows: rows.into_iter().map(|row| (1, row)).collect(),
            progress: (1, progress),
        };
        Self {
            title: Title {
                name: sheet.name,
                pupils: sheet.pupils,
                columns: sheet.columns,
                pass_mark: sheet.pass_mark,
                left_out: sheet.left_out,
            },
            state: Mutex::new(state),
            changes: watch::Sender::new(1),
        }
    }

    /// Nothing that holds this lock can fail halfway.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Hears of every change.
    pub fn watch(&self) -> watch::Receiver<u64> {
        self.changes.subscribe()
    }

    /// The rows that have changed since this change, with their numbers, and the progress if that has.
    pub fn since(&self, change: u64) -> (Vec<(usize, Row)>, Option<Progress>) {
        let state = self.state();
        let changed = state.rows.iter().enumerate();
        let changed = changed.filter(|(_, (at, _))| *at > change);
        let rows = changed.map(|(id, (_, row))| (id, row.clone())).collect();
        let (at, progress) = state.progress;
        (rows, (at > change).then_some(progress))
    }

    /// A row is so now.
    pub fn row(&self, pupil: usize, row: Row) {
        let mut state = self.state();
        if let Some((at, old)) = state.rows.get_mut(pupil)
            && *old != row
        {
            *old = row;
            *at = self.next();
        }
    }

    /// The judging goes on.
    pub fn progress(&self, change: impl FnOnce(&mut Progress)) {
        let mut state = self.state();
        let (at, progress) = &mut state.progress;
        let before = *progress;
        change(progress);
        if *progress != before {
            *at = self.next();
        }
    }

    /// Tells of a change, and gives its number. The lock of the state is held, so nobody sees the number before the change.
    fn next(&self) -> u64 {
        let mut next = 0;
        self.changes.send_modify(|number| {
            *number += 1;
            next = *number;
        });
        next
    }

    /// The page of the replay of a run that is shown.
    pub fn replay(&self, run: usize) -> Option<PathBuf> {
        let state = self.state();
        let mut cells = state.rows.iter().flat_map(|(_, row)| &row.cells);
        cells.find_map(|cell| {
            let mark = cell.mark.as_ref().filter(|mark| mark.run == run)?;
            mark.replay.clone()
        })
    }
}
