//! The textual form of a data-flow project: what people write, review and compare line by line, without loss.
//!
//! Owns the grammar, and which ids and places are left to the reader because it would make the same ones. Knows neither
//! saves nor what a block does.
//!
//! A text is lines; `#` begins a comment, and line ends inside of parentheses and backticks end nothing.
//!
//! ```text
//! kit trikV62Kit                          # the key lastKitId of metaInfo.xml
//! meta "KEY" = "VALUE"                    # any other key
//! diagram "Wall follower"                 # or: subprogram "Name"
//!   A: Sensor(VarName = sensorD1)
//!   F: "Text programming"(IO0 = `u = 2 * (I0 - 20)`, IO1 = `50 - u`) at 300, 100
//!   call: "User block" of "Name"
//!   A.OUT -> F.I0
//!   F.O1 -> call.I0 fifo 16               # or: latest, error, capacity 16
//! ```
//!
//! | line | is |
//! | --- | --- |
//! | `kit VALUE`, `meta NAME = VALUE` | keys of the project |
//! | `run nothing` | no diagram is run; by default the first `diagram` is, or the one that says `run` |
//! | `diagram NAME ...`, `subprogram NAME ...` | a diagram; then `run`, `id TEXT`, `logical TEXT` |
//! | `LABEL: BLOCK(PROPERTY = VALUE, ...) ...` | a block; then `of CALLED`, `named TEXT`, `at X, Y`, `element TEXT`, `id TEXT`, `logical TEXT` |
//! | `END -> END ...` | an edge; then `fifo`, `latest`, `error` with a capacity or without, `capacity N`, `via X, Y; X, Y`, `id TEXT` |
//!
//! `BLOCK` is the name that the editor shows, in English or Russian, or the element name; `unknown "ELEMENT"` is a block
//! that no row knows. `END` is `LABEL.PORT`, the port by its name or number, or `nowhere`. `CALLED` is the name of a diagram,
//! or `id TEXT`. `VALUE` is a word, a number, a text in quotes with the escapes `\" \\ \n \r \t \u{HEX}`, or a text in
//! backticks, which has no escapes and may have several lines. A property that the block does not know has its name in
//! quotes. A block without `named` has its label as its caption; one without `at` is placed by its distance from the start.
//! The order of blocks is that of the diagram's children; the order of edges that leave one block is that of delivery.

mod draft;
mod ids;
mod labels;
mod layout;
mod lexer;
mod parser;
mod places;
mod resolve;
mod words;
mod writer;

#[cfg(test)]
mod tests;

pub use places::Places;

use crate::project::Project;
use lang_text::problem::{Problem, locate};

/// A project as text.
///
/// Not part of it: [`Project::world`], which [`read`] gives as `None`; comments; ids that no save could hold, and those of
/// blocks and edges that others have already, for which `read` makes new ones.
pub fn write(project: &Project) -> String {
    writer::write(project)
}

/// The project of a text.
///
/// # Errors
/// What is wrong with it, by line and column, at most [`lang_text::limits::PROBLEMS`] of them.
pub fn read(text: &str) -> Result<Project, Vec<Problem>> {
    // What `locate` leaves out too.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut problems = Vec::new();
    let draft = parser::parse(text, &mut problems);
    let project = resolve::project(draft, &mut problems);
    if problems.is_empty() {
        return Ok(project);
    }
    problems.sort_by_key(|problem| problem.place.offset);
    locate(&mut problems, text);
    Err(problems)
}

/// An error at a byte of the text.
fn error_at(at: usize, words: lang_text::problem::Words) -> Problem {
    let mut problem = Problem::error(words);
    problem.place.offset = Some(u32::try_from(at).unwrap_or(u32::MAX));
    problem
}

/// Keeps a problem unless there are as many already as one reading tells.
fn tell(problems: &mut Vec<Problem>, problem: Problem) {
    if problems.len() < lang_text::limits::PROBLEMS {
        problems.push(problem);
    }
}
