//! The table of a class as a page, whose cells lead to the replays of their runs.
//!
//! Owns that form: one file without scripts; texts of files are never tags, and links lead only to files that are there.

use super::{Grades, Run, number};
use crate::check::words;
use lang_text::escape::escaped;
use std::fmt::Write as _;
use std::path::{Component, Path};
use studio::verdict::Verdict;

const STYLE: &str = "\
:root { color-scheme: light dark; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 1.5rem; }
table { border-collapse: collapse; }
th, td { border: 1px solid #8886; padding: .3rem .6rem; text-align: left; vertical-align: top; }
thead th { position: sticky; top: 0; background: Canvas; }
td.n { text-align: right; font-variant-numeric: tabular-nums; }
td b { font-size: 1.1em; }
td small { display: block; opacity: .8; }
.good { background: #2e9e4433; }
.wrong { background: #d6453333; }
.broken { background: #e0a80044; }
.missing { background: #8882; }
a { color: inherit; }
details { margin-top: 1.5rem; }
";

/// The whole page, which will be at a path.
pub(super) fn write(grades: &Grades, path: &Path) -> String {
    let titles = words::table(grades.locale);
    let language = words::code(grades.locale);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"{language}\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width\">\n<title>{0}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{0}</h1>\n\
         <table>\n<thead><tr><th>{1}</th>",
        titles.grades, titles.pupil
    );
    for column in &grades.columns {
        let _ = write!(out, "<th>{}", escaped(&column.name()));
        if grades.has_weights() {
            let _ = write!(out, " <small>&times;{}</small>", number(column.weight));
        }
        out.push_str("</th>");
    }
    let _ = write!(out, "<th>{}</th>", titles.sum);
    if let Some(mark) = grades.pass_mark {
        let _ = write!(
            out,
            "<th>{} <small>&ge; {}</small></th>",
            titles.passed,
            number(mark)
        );
    }
    out.push_str("</tr></thead>\n<tbody>\n");
    for (pupil, name) in grades.pupils.iter().enumerate() {
        let _ = write!(out, "<tr><th>{}</th>", escaped(name));
        for column in 0..grades.columns.len() {
            cell(&mut out, grades, grades.cell(pupil, column), path);
        }
        let sum = number(grades.sum(pupil));
        let _ = write!(out, "<td class=\"n\"><b>{sum}</b></td>");
        if let Some(passed) = grades.has_passed(pupil) {
            let class = if passed { "good" } else { "wrong" };
            let said = words::yes_or_no(passed, grades.locale);
            let _ = write!(out, "<td class=\"{class}\">{said}</td>");
        }
        out.push_str("</tr>\n");
    }
    out.push_str("</tbody>\n</table>\n");
    runs(&mut out, grades, path);
    left_out(&mut out, grades);
    out.push_str("</body>\n</html>\n");
    out
}

/// Points, how it ended, and the way to the replay.
fn cell(out: &mut String, grades: &Grades, run: Option<&Run>, path: &Path) {
    let points = run.and_then(|run| run.points).map(number);
    let why = run.map(|run| &*run.why).filter(|why| !why.is_empty());
    let title = why.map_or_else(String::new, |why| format!(" title=\"{}\"", escaped(why)));
    let class = class(run);
    let _ = write!(out, "<td class=\"n {class}\"{title}>");
    if let Some(points) = points {
        let _ = write!(out, "<b>{points}</b>");
    }
    let _ = write!(
        out,
        "<small>{}</small></td>",
        linked(grades.result(run), run, path)
    );
}

/// What was not judged, so that nobody has to look at the terminal for it.
fn left_out(out: &mut String, grades: &Grades) {
    let (lines, count) = &grades.left_out;
    if *count == 0 {
        return;
    }
    let count = words::passed_count(*count, lines.len(), grades.locale);
    let _ = write!(out, "<details open><summary>{count}</summary>\n<ul>\n");
    for line in lines {
        let _ = writeln!(out, "<li>{}</li>", escaped(line));
    }
    out.push_str("</ul>\n</details>\n");
}

/// All runs, one below the other, with their messages.
fn runs(out: &mut String, grades: &Grades, path: &Path) {
    let titles = words::table(grades.locale);
    let [solution, field, _, seconds, _, why] = words::heading(grades.locale);
    let _ = write!(
        out,
        "<details><summary>{}</summary>\n<table>\n<thead><tr><th>{}</th><th>{}</th><th>{solution}</th><th>{field}</th>\
         <th>{}</th><th>{seconds}</th><th>{why}</th></tr></thead>\n<tbody>\n",
        titles.runs, titles.pupil, titles.task, titles.result
    );
    for run in &grades.runs {
        let seconds = match run.verdict.is_judged() {
            true => words::seconds(run.ms, grades.locale),
            false => String::new(),
        };
        let own = words::own(grades.locale);
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"{}\">{}</td><td class=\"n\">{seconds}</td>\
             <td>{}</td></tr>",
            escaped(&grades.pupils[run.pupil]),
            escaped(&grades.columns[run.column].name()),
            escaped(&run.solution),
            escaped(run.field.as_deref().unwrap_or(own)),
            class(Some(run)),
            linked(grades.result(Some(run)), Some(run), path),
            escaped(&run.why),
        );
    }
    out.push_str("</tbody>\n</table>\n</details>\n");
}

fn class(run: Option<&Run>) -> &'static str {
    match run.map(|run| run.verdict) {
        None => "missing",
        Some(Verdict::Accomplished | Verdict::Ended) => "good",
        Some(Verdict::Wrong | Verdict::ModelTime | Verdict::Program) => "wrong",
        Some(Verdict::Structure | Verdict::NotRun) => "broken",
    }
}

/// A text that leads to a replay, if there is one.
fn linked(text: &str, run: Option<&Run>, path: &Path) -> String {
    let replay = run.and_then(|run| run.replay.as_deref());
    match replay.and_then(|replay| relative(path, replay)) {
        Some(link) => format!("<a href=\"{link}\">{}</a>", escaped(text)),
        None => escaped(text),
    }
}

/// The way from a page to a file, as a link has it.
fn relative(page: &Path, file: &Path) -> Option<String> {
    let folder = match page.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.canonicalize().ok()?,
        Some(_) | None => Path::new(".").canonicalize().ok()?,
    };
    let file = file.canonicalize().ok()?;
    let from: Vec<Component<'_>> = folder.components().collect();
    let to: Vec<Component<'_>> = file.components().collect();
    let same = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let mut parts = vec!["..".to_owned(); from.len() - same];
    parts.extend(to[same..].iter().map(|part| coded(part.as_os_str())));
    Some(parts.join("/"))
}

/// A name as a part of a link.
fn coded(name: &std::ffi::OsStr) -> String {
    use std::os::unix::ffi::OsStrExt;
    let mut out = String::new();
    for &byte in name.as_bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
                out.push(char::from(byte));
            }
            byte => {
                let _ = write!(out, "%{byte:02X}");
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsStr;

    #[test]
    fn names_are_links() {
        assert_eq!(coded(OsStr::new("a b#?\u{44f}\"")), "a%20b%23%3F%D1%8F%22");
    }
}
