//! Findings as people see them: place, line, what to do.
//!
//! Owns the style: colours and frames on a terminal, ASCII for files and programs; and lines of JSON. Lines that are too long for a screen are shown in part.

use super::source::Source;
use ariadne::{CharSet, Color, Config, IndexType, Label, Report, ReportKind};
use lang_dcml::diagnostic::{Diagnostic, Severity};
use lang_dcml::lines::Lines;
use lang_dcml::syntax::Span;
use sim::judge::json;
use std::io::{self, IsTerminal, Write};
use std::ops::Range;

/// Bytes of a line that is shown whole.
const LINE_SHOWN: u32 = 400;
/// Bytes of a longer one that are shown on each side of a place.
const AROUND: usize = 60;

/// How findings are drawn.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Style {
    Colours,
    Frames,
    Ascii,
}

/// Shows all findings of a text on standard error.
pub(super) fn show(source: &Source, all: &[Diagnostic]) {
    let err = io::stderr();
    let style = match err.is_terminal() {
        true if std::env::var_os("NO_COLOR").is_some() => Style::Frames,
        true => Style::Colours,
        false => Style::Ascii,
    };
    let _ = err.lock().write_all(&written(source, all, style));
}

/// The same as text.
fn written(source: &Source, all: &[Diagnostic], style: Style) -> Vec<u8> {
    let mut out = Vec::new();
    if all.is_empty() {
        return out;
    }
    let lines = Lines::of(&source.text);
    let is_short = |span: Span| {
        let line = lines.span(lines.line(span.start));
        line.end - line.start <= LINE_SHOWN
    };
    // The whole text is looked at only if a part of it is shown.
    let mut text = None;
    for one in all {
        let mut spans = one.notes.iter().map(|(span, _)| *span).chain([one.span]);
        if spans.all(is_short) {
            let text = text.get_or_insert_with(|| ariadne::Source::from(source.text.as_str()));
            drawn(source, &lines, one, text, style, &mut out);
        } else {
            plain(source, &lines, one, &mut out);
        }
    }
    out
}

/// A place on its first line, which is enough to find it.
fn first_line(lines: &Lines<'_>, span: Span) -> Range<usize> {
    let line = lines.span(lines.line(span.start));
    let end = span.end.min(line.end).max(span.start);
    span.start as usize..end as usize
}

fn drawn<'a>(
    source: &'a Source,
    lines: &Lines<'_>,
    one: &Diagnostic,
    text: &ariadne::Source<&'a str>,
    style: Style,
    out: &mut Vec<u8>,
) {
    let name = source.name.as_str();
    let (kind, colour) = match one.severity {
        Severity::Error => (ReportKind::Error, Color::Red),
        Severity::Warning => (ReportKind::Warning, Color::Yellow),
    };
    let config = Config::default()
        .with_color(style == Style::Colours)
        .with_char_set(if style == Style::Ascii {
            CharSet::Ascii
        } else {
            CharSet::Unicode
        })
        .with_index_type(IndexType::Byte);
    let place = first_line(lines, one.span);
    let label = Label::new((name, place.clone()))
        .with_message(&one.label)
        .with_color(colour);
    let mut report = Report::build(kind, (name, place))
        .with_config(config)
        .with_code(one.code.name())
        .with_message(&one.message)
        .with_label(label);
    for (span, note) in &one.notes {
        let label = Label::new((name, first_line(lines, *span)));
        report = report.with_label(label.with_message(note).with_color(Color::Blue));
    }
    if let Some(hint) = &one.hint {
        report = report.with_help(hint);
    }
    let mut drawn = Vec::new();
    let _ = report.finish().write((name, text), &mut drawn);
    if style == Style::Colours {
        out.extend(drawn);
        return;
    }
    for line in String::from_utf8_lossy(&drawn).lines() {
        out.extend(line.trim_end().bytes());
        out.push(b'\n');
    }
}

/// A line for each finding, for programs.
pub(super) fn json(source: &Source, all: &[Diagnostic]) -> Vec<u8> {
    let lines = Lines::of(&source.text);
    let mut out = String::new();
    for one in all {
        let (start, end) = (lines.place(one.span.start), lines.place(one.span.end));
        out.push_str("{\"file\":");
        json::text(&mut out, &source.name);
        for (name, place) in [("", start), ("end_", end)] {
            out.push_str(&format!(
                ",\"{name}line\":{},\"{name}column\":{}",
                place.line, place.column
            ));
        }
        let severity = match one.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        for (name, text) in [
            ("severity", severity),
            ("code", one.code.name()),
            ("message", &one.message),
            ("hint", one.hint.as_deref().unwrap_or_default()),
        ] {
            out.push_str(&format!(",\"{name}\":"));
            json::text(&mut out, text);
        }
        out.push_str("}\n");
    }
    out.into_bytes()
}

/// Without a frame, and a part of the line.
fn plain(source: &Source, lines: &Lines<'_>, one: &Diagnostic, out: &mut Vec<u8>) {
    let kind = match one.severity {
        Severity::Error => "Error",
        Severity::Warning => "Warning",
    };
    let place = |span: Span| {
        let place = lines.place(span.start);
        format!("{}:{}:{}", source.name, place.line, place.column)
    };
    let _ = writeln!(out, "[{}] {kind}: {}", one.code.name(), one.message);
    let _ = writeln!(out, "   {}: {}", place(one.span), one.label);
    let _ = writeln!(out, "   ... {} ...", around(&source.text, lines, one.span));
    for (span, note) in &one.notes {
        let _ = writeln!(out, "   {}: {note}", place(*span));
    }
    if let Some(hint) = &one.hint {
        let _ = writeln!(out, "   Help: {hint}");
    }
}

/// What stands around a place on its line; signs that steer terminals are left out.
fn around(text: &str, lines: &Lines<'_>, span: Span) -> String {
    let line = lines.span(lines.line(span.start));
    let (line, at) = (line.start as usize..line.end as usize, span.start as usize);
    let mut start = at.saturating_sub(AROUND).max(line.start);
    let mut end = (at + AROUND).min(line.end);
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    while !text.is_char_boundary(end) {
        end += 1;
    }
    let part = text.get(start..end).unwrap_or_default();
    part.chars().filter(|sign| !sign.is_control()).collect()
}
