//! What a viewer of marks is told: JSON objects. It has nothing to say itself.
//!
//! Owns their forms; `page/app/src/marks/news.ts` has the other end. Pure.

use super::board::{Progress, Title};
use super::sheet::{Cell, Row, Tone};
use lang_text::problem::Locale;
use serde_json::{Value, json};

/// What a viewer is told first.
pub fn hello(title: &Title) -> String {
    let columns = title.columns.iter();
    let columns: Vec<Value> = columns
        .map(|one| json!({ "name": one.name, "weight": one.weight }))
        .collect();
    let (left_out, count) = &title.left_out;
    json!({
        "is": "hello",
        "name": title.name,
        "version": env!("CARGO_PKG_VERSION"),
        "pupils": title.pupils,
        "columns": columns,
        "passMark": title.pass_mark,
        "leftOut": left_out,
        "leftOutCount": count,
    })
    .to_string()
}

/// The server is there: a page cannot see pings.
pub fn beat() -> String {
    json!({ "is": "beat" }).to_string()
}

/// How far the judging is.
pub fn progress(progress: Progress) -> String {
    let Progress { done, all, is_over } = progress;
    json!({ "is": "progress", "done": done, "all": all, "over": is_over }).to_string()
}

/// The row of a pupil.
pub fn row(id: usize, row: &Row, locale: Locale) -> String {
    let cells: Vec<Value> = row.cells.iter().map(|one| cell(one, locale)).collect();
    json!({ "is": "row", "id": id, "cells": cells, "sum": row.sum, "passed": row.passed })
        .to_string()
}

fn cell(cell: &Cell, locale: Locale) -> Value {
    let mark = cell.mark.as_ref().map(|mark| {
        json!({
            "tone": tone(mark.tone),
            "verdict": mark.verdict.in_locale(locale),
            "points": mark.points,
            "ms": mark.ms,
            "solution": mark.solution,
            "why": mark.why,
            // The number alone: where files are is nobody's business.
            "replay": mark.replay.as_ref().map(|_| mark.run),
        })
    });
    json!({ "waiting": cell.waiting, "mark": mark })
}

fn tone(tone: Tone) -> &'static str {
    match tone {
        Tone::Good => "good",
        Tone::Wrong => "wrong",
        Tone::Broken => "broken",
    }
}
