//! Places for blocks that have none: columns by their distance from where the program starts.
//!
//! Owns the distances and the gaps. All numbers are whole, so that a text which leaves them out is the same on each machine.

use crate::blocks::Row;
use std::collections::VecDeque;

/// Between two columns, in pixels.
const BESIDE: f64 = 100.0;
/// Between two blocks of a column: six lines of words stand there.
const BENEATH: f64 = 80.0;
/// The size of a block that no row knows.
const UNKNOWN: (u16, u16) = (100, 100);

/// What is to be placed: rows of blocks, and edges from block to block.
pub(super) struct Graph<'a> {
    pub rows: &'a [Option<&'static Row>],
    pub edges: &'a [(usize, usize)],
}

/// Width and height of a block.
fn size(row: Option<&'static Row>) -> (f64, f64) {
    let (width, height) = row.map_or(UNKNOWN, |row| row.size);
    (f64::from(width), f64::from(height))
}

/// Places for all blocks, from the origin on.
pub(super) fn places(graph: &Graph<'_>) -> Vec<(f64, f64)> {
    complete(graph, &vec![None; graph.rows.len()])
}

/// Places for blocks of which some have one: the others stand below them.
pub(super) fn complete(graph: &Graph<'_>, given: &[Option<(f64, f64)>]) -> Vec<(f64, f64)> {
    let bottom = |(row, place): (&Option<&'static Row>, &Option<(f64, f64)>)| {
        let (_, y) = (*place)?;
        let bottom = y + size(*row).1;
        bottom.is_finite().then_some(bottom)
    };
    let lowest = graph
        .rows
        .iter()
        .zip(given)
        .filter_map(bottom)
        .reduce(f64::max);
    let below = lowest.map_or(0.0, |lowest| lowest.ceil() + BENEATH);
    let columns = columns(graph);
    let count = columns.iter().max().map_or(0, |last| last + 1);
    let mut widths = vec![0.0_f64; count];
    for (&column, &row) in columns.iter().zip(graph.rows) {
        widths[column] = widths[column].max(size(row).0);
    }
    let mut lefts = Vec::with_capacity(count);
    let mut left = 0.0;
    for width in widths {
        lefts.push(left);
        left += width + BESIDE;
    }
    let mut bottoms = vec![below; count];
    let mut all = Vec::with_capacity(columns.len());
    for ((column, &row), given) in columns.into_iter().zip(graph.rows).zip(given) {
        all.push(given.unwrap_or((lefts[column], bottoms[column])));
        if given.is_none() {
            bottoms[column] += size(row).1 + BENEATH;
        }
    }
    all
}

/// The column of each block: how many edges it is from the nearest block into which none leads. A circle into which
/// nothing leads begins at its first block.
fn columns(graph: &Graph<'_>) -> Vec<usize> {
    let count = graph.rows.len();
    let mut following: Vec<Vec<usize>> = vec![Vec::new(); count];
    let mut is_entered = vec![false; count];
    for &(from, to) in graph.edges {
        following[from].push(to);
        is_entered[to] |= from != to;
    }
    let mut columns: Vec<Option<usize>> = vec![None; count];
    let mut waiting = VecDeque::new();
    let starts = (0..count).filter(|&block| !is_entered[block]);
    for block in starts {
        columns[block] = Some(0);
        waiting.push_back((block, 0));
    }
    for first in 0..count {
        while let Some((block, column)) = waiting.pop_front() {
            for &next in &following[block] {
                if columns[next].is_none() {
                    columns[next] = Some(column + 1);
                    waiting.push_back((next, column + 1));
                }
            }
        }
        if columns[first].is_none() {
            columns[first] = Some(0);
            waiting.push_back((first, 0));
        }
    }
    columns.into_iter().map(Option::unwrap_or_default).collect()
}
