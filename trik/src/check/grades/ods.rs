//! The table of a class as an OpenDocument spreadsheet: a sheet with points, and one with every run.
//!
//! Owns that form: a zip with `mimetype`, a manifest and the content. Numbers are numbers, texts are texts and never
//! formulas; the only formulas are our own sums, so that a teacher who changes a cell sees the new sum.

use super::{Grades, Run, number};
use crate::check::words;
use lang_diagram::archive::{Entry, pack_document};
use lang_text::escape::escaped;
use lang_text::problem::Words;
use std::fmt::Write as _;
use studio::verdict::Verdict;

const TYPE: &str = "application/vnd.oasis.opendocument.spreadsheet";
/// Names of styles, and colours of cells.
const STYLES: [(&str, &str); 5] = [
    ("good", "#d7f0d7"),
    ("wrong", "#f7d9d5"),
    ("broken", "#fbe9b5"),
    ("missing", "#e6e6e6"),
    ("head", "#dfe7f5"),
];

/// The whole file.
///
/// # Errors
/// It is larger than a zip can be.
pub(super) fn write(grades: &Grades) -> Result<Vec<u8>, Words> {
    let entry = |name: &str, text: String| Entry {
        name: name.to_owned(),
        bytes: text.into_bytes(),
    };
    let entries = [
        entry("META-INF/manifest.xml", manifest()),
        entry("content.xml", content(grades)),
    ];
    pack_document(TYPE, &entries).map_err(|problem| problem.words)
}

fn manifest() -> String {
    let entry = |path: &str, kind: &str| {
        format!(
            "<manifest:file-entry manifest:full-path=\"{path}\" manifest:media-type=\"{kind}\"/>"
        )
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<manifest:manifest \
         xmlns:manifest=\"urn:oasis:names:tc:opendocument:xmlns:manifest:1.0\" manifest:version=\"1.2\">{}{}\
         </manifest:manifest>",
        entry("/", TYPE),
        entry("content.xml", "text/xml")
    )
}

fn content(grades: &Grades) -> String {
    let mut out = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<office:document-content \
         xmlns:office=\"urn:oasis:names:tc:opendocument:xmlns:office:1.0\" \
         xmlns:table=\"urn:oasis:names:tc:opendocument:xmlns:table:1.0\" \
         xmlns:text=\"urn:oasis:names:tc:opendocument:xmlns:text:1.0\" \
         xmlns:style=\"urn:oasis:names:tc:opendocument:xmlns:style:1.0\" \
         xmlns:fo=\"urn:oasis:names:tc:opendocument:xmlns:xsl-fo-compatible:1.0\" \
         xmlns:of=\"urn:oasis:names:tc:opendocument:xmlns:of:1.2\" office:version=\"1.2\"><office:automatic-styles>",
    );
    for (name, colour) in STYLES {
        let weight = if name == "head" { "bold" } else { "normal" };
        let _ = write!(
            out,
            "<style:style style:name=\"{name}\" style:family=\"table-cell\"><style:table-cell-properties \
             fo:background-color=\"{colour}\"/><style:text-properties fo:font-weight=\"{weight}\"/></style:style>"
        );
    }
    out.push_str("</office:automatic-styles><office:body><office:spreadsheet>");
    points(&mut out, grades);
    runs(&mut out, grades);
    out.push_str("</office:spreadsheet></office:body></office:document-content>\n");
    out
}

/// The sheet with points. Weights stand in its second row.
fn points(out: &mut String, grades: &Grades) {
    let titles = words::table(grades.locale);
    begin(out, titles.grades);
    out.push_str("<table:table-row>");
    text(out, titles.pupil, "head");
    for column in &grades.columns {
        text(out, &column.name(), "head");
    }
    text(out, titles.sum, "head");
    if grades.pass_mark.is_some() {
        text(out, titles.passed, "head");
    }
    out.push_str("</table:table-row><table:table-row>");
    text(out, titles.weight, "head");
    for column in &grades.columns {
        float(out, column.weight, "head");
    }
    text(out, "", "head");
    if let Some(mark) = grades.pass_mark {
        float(out, mark, "head");
    }
    out.push_str("</table:table-row>");
    for (pupil, name) in grades.pupils.iter().enumerate() {
        out.push_str("<table:table-row>");
        text(out, name, "");
        for column in 0..grades.columns.len() {
            let run = grades.cell(pupil, column);
            match run.and_then(|run| run.points) {
                Some(points) => float(out, points, style(run)),
                None => text(out, grades.result(run), style(run)),
            }
        }
        sum(out, grades, pupil);
        if let Some(passed) = grades.has_passed(pupil) {
            mark(out, grades, pupil, passed);
        }
        out.push_str("</table:table-row>");
    }
    out.push_str("</table:table>");
}

/// A sum that follows the cells of its row.
fn sum(out: &mut String, grades: &Grades, pupil: usize) {
    let value = number(grades.sum(pupil));
    let row = pupil + 3;
    let last = letters(grades.columns.len());
    let formula = match grades.columns.is_empty() {
        true => String::new(),
        false => {
            format!(" table:formula=\"of:=SUMPRODUCT([.B{row}:.{last}{row}];[.B$2:.{last}$2])\"")
        }
    };
    let _ = write!(
        out,
        "<table:table-cell office:value-type=\"float\" office:value=\"{value}\"{formula}><text:p>{value}</text:p>\
         </table:table-cell>"
    );
}

/// Whether a sum reaches the mark in the second row; it follows both, so it has no colour of its own.
fn mark(out: &mut String, grades: &Grades, pupil: usize, passed: bool) {
    let (row, sum, mark) = (
        pupil + 3,
        letters(grades.columns.len() + 1),
        letters(grades.columns.len() + 2),
    );
    let [yes, no] = [true, false].map(|one| words::yes_or_no(one, grades.locale));
    let shown = words::yes_or_no(passed, grades.locale);
    let _ = write!(
        out,
        "<table:table-cell office:value-type=\"string\" office:string-value=\"{shown}\" \
         table:formula=\"of:=IF([.{sum}{row}]&gt;=[.{mark}$2];&quot;{yes}&quot;;&quot;{no}&quot;)\"><text:p>{shown}</text:p>\
         </table:table-cell>"
    );
}

/// The letters of a column, from 0.
fn letters(column: usize) -> String {
    let letter = char::from(b'A' + (column % 26) as u8);
    match column / 26 {
        0 => letter.to_string(),
        more => format!("{}{letter}", letters(more - 1)),
    }
}

/// The sheet with all runs.
fn runs(out: &mut String, grades: &Grades) {
    let titles = words::table(grades.locale);
    begin(out, titles.runs);
    out.push_str("<table:table-row>");
    let heads = words::heading(grades.locale);
    let [solution, field, _, seconds, _, why] = heads;
    for title in [
        titles.pupil,
        titles.task,
        solution,
        field,
        titles.result,
        seconds,
        titles.points,
        why,
    ] {
        text(out, title, "head");
    }
    out.push_str("</table:table-row>");
    for run in &grades.runs {
        out.push_str("<table:table-row>");
        text(out, &grades.pupils[run.pupil], "");
        text(out, &grades.columns[run.column].name(), "");
        text(out, &run.solution, "");
        let own = words::own(grades.locale);
        text(out, run.field.as_deref().unwrap_or(own), "");
        text(out, grades.result(Some(run)), style(Some(run)));
        match run.verdict.is_judged() {
            true => float(out, f64::from(run.ms) / 1000.0, ""),
            false => text(out, "", ""),
        }
        match run.points {
            Some(points) => float(out, points, ""),
            None => text(out, "", ""),
        }
        text(out, &run.why, "");
        out.push_str("</table:table-row>");
    }
    out.push_str("</table:table>");
}

fn style(run: Option<&Run>) -> &'static str {
    match run.map(|run| run.verdict) {
        None => "missing",
        Some(Verdict::Accomplished | Verdict::Ended) => "good",
        Some(Verdict::Wrong | Verdict::ModelTime | Verdict::Program) => "wrong",
        Some(Verdict::Structure | Verdict::NotRun) => "broken",
    }
}

fn begin(out: &mut String, name: &str) {
    let _ = write!(out, "<table:table table:name=\"{}\">", escaped(name));
}

fn styled(style: &str) -> String {
    match style {
        "" => String::new(),
        style => format!(" table:style-name=\"{style}\""),
    }
}

fn text(out: &mut String, text: &str, style: &str) {
    let style = styled(style);
    let _ = match text {
        "" => write!(out, "<table:table-cell{style}/>"),
        text => write!(
            out,
            "<table:table-cell{style} office:value-type=\"string\"><text:p>{}</text:p></table:table-cell>",
            escaped(text)
        ),
    };
}

fn float(out: &mut String, value: f64, style: &str) {
    let (style, value) = (styled(style), number(value));
    let _ = write!(
        out,
        "<table:table-cell{style} office:value-type=\"float\" office:value=\"{value}\"><text:p>{value}</text:p>\
         </table:table-cell>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_letters() {
        let all = [0, 1, 25, 26, 51, 52, 701, 702].map(letters);
        assert_eq!(all, ["A", "B", "Z", "AA", "AZ", "BA", "ZZ", "AAA"]);
    }
}
