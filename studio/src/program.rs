//! A program of blocks from the bytes of its file: a diagram or a data-flow program of a save, or one in its textual form.
//!
//! Owns which files are such programs, which of a save is run, when one must not run, and how a line begins that tells why.
//! Opens no file. What is wrong with a program is found in `lang`.

use crate::words;
use lang_dataflow::check::check;
use lang_dataflow::project::{DiagramKind, Project};
use lang_dataflow::read::{Language, choose, language, project};
use lang_dataflow::save::save;
use lang_dataflow::text::Places;
use lang_dataflow::{program, text};
use lang_diagram::read::{self, Opened, Save};
use lang_text::problem::{Locale, Position, Problem, Severity, Words};
use std::path::Path;
use std::rc::Rc;

/// The ending of a data-flow program in its textual form.
pub const ENDING: &str = "flow";

/// A data-flow program that was read.
#[derive(Clone, Debug)]
pub struct Flow {
    /// What it means.
    pub project: Project,
    /// What is strange but does not keep it from being read.
    pub problems: Vec<Problem>,
    /// Its text, if it is not of a save.
    pub text: Option<String>,
}

/// What a file has.
#[derive(Clone, Debug)]
pub enum Program {
    /// A save whose diagrams of control flow are run.
    Diagram(Box<Opened>),
    /// A save whose diagrams of data flow are run.
    Flow(Flow, Box<Opened>),
    /// A data-flow program in its textual form.
    Text(Flow),
}

/// Whether a file is a program of blocks, by its name: a save, or a data-flow program in its textual form.
pub fn is_of_blocks(path: &Path) -> bool {
    let ending = path.extension();
    is_text(path) || ending.is_some_and(|ending| ending.eq_ignore_ascii_case("qrs"))
}

/// Whether a file is a data-flow program in its textual form, by its name.
pub fn is_text(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// Why a file is no program that can be looked at.
#[derive(Clone, Debug)]
pub enum Unreadable {
    /// The file itself.
    File(Words),
    /// What is in it.
    Save(Vec<Problem>),
    /// It has no such diagram to run.
    Diagram(Words),
}

/// Reads a save, or a program in its textual form. `diagram` is the main diagram that is run, if it is not the first one.
///
/// # Errors
/// Why there is no such program.
pub fn of_bytes(
    bytes: Vec<u8>,
    is_text: bool,
    diagram: Option<&str>,
) -> Result<Program, Unreadable> {
    if is_text {
        let mut flow = of_text(bytes)?;
        if let Some(diagram) = diagram {
            let chosen = flow.project.choose(diagram);
            chosen.map_err(Unreadable::Diagram)?;
        }
        return Ok(Program::Text(flow));
    }
    let mut opened = read::read(&bytes).map_err(Unreadable::Save)?;
    if let Some(diagram) = diagram {
        choose(&mut opened.save, diagram).map_err(Unreadable::Diagram)?;
        (opened.project, _) = opened.save.project();
    }
    Ok(of_save(opened))
}

/// A program whose main diagram is another one, as a robot gets it: there is no word for it on the way. Of a data-flow
/// program other main diagrams stay here, so that the robot does not tell that they are not run.
///
/// # Errors
/// Why it cannot be read or has no such diagram.
pub fn with_main(path: &Path, bytes: Vec<u8>, diagram: &str) -> Result<Vec<u8>, Unreadable> {
    let written = |save: &Save| save.write().map_err(|why| Unreadable::Save(vec![why]));
    match of_bytes(bytes, is_text(path), Some(diagram))? {
        Program::Diagram(opened) => written(&opened.save),
        Program::Flow(flow, _) => written(&save(&alone(flow.project))),
        Program::Text(flow) => Ok(text::write(&alone(flow.project)).into_bytes()),
    }
}

/// A project with one main diagram, the one that is run.
fn alone(mut project: Project) -> Project {
    let main = project.main;
    let all = std::mem::take(&mut project.diagrams);
    let kept = all.into_iter().enumerate();
    let kept = kept.filter(|(at, one)| Some(*at) == main || one.kind == DiagramKind::Subprogram);
    project.diagrams = kept.map(|(_, one)| one).collect();
    let mut diagrams = project.diagrams.iter();
    project.main = diagrams.position(|one| one.kind == DiagramKind::Main);
    project
}

/// The data-flow program that bytes spell out.
///
/// # Errors
/// They are no text, or no such program.
pub fn of_text(bytes: Vec<u8>) -> Result<Flow, Unreadable> {
    let text = String::from_utf8(bytes)
        .map_err(|error| Unreadable::File(words::no_text(error.utf8_error().valid_up_to())))?;
    let project = text::read(&text).map_err(Unreadable::Save)?;
    Ok(Flow {
        project,
        problems: Vec::new(),
        text: Some(text),
    })
}

/// What of a save is run.
pub fn of_save(opened: Opened) -> Program {
    match language(&opened.save) {
        Language::Diagram => Program::Diagram(Box::new(opened)),
        Language::Dataflow => Program::Flow(Flow::of_save(&opened), Box::new(opened)),
    }
}

/// What is wrong with a file that could not be read, a line for each; of a text with the place to which editors go.
pub fn unread(file: &Path, problems: &[Problem], locale: Locale) -> Vec<String> {
    let line = |problem: &Problem| match problem.place.position.filter(|_| is_text(file)) {
        None => line(file, None, problem, locale),
        at => line(file, at, &problem.without_position(), locale),
    };
    problems.iter().map(line).collect()
}

fn line(file: &Path, at: Option<Position>, problem: &Problem, locale: Locale) -> String {
    let told = problem.in_locale(locale);
    let file = file.display();
    match at {
        Some(at) => format!("{file}:{}:{}: {told}", at.line, at.column),
        None => format!("{file}: {told}"),
    }
}

impl Flow {
    /// That of a save.
    pub fn of_save(opened: &Opened) -> Self {
        Self::of_only(&opened.save)
    }

    /// The same without what else is known of the save.
    pub fn of_only(save: &Save) -> Self {
        let (project, problems) = project(save);
        Self {
            project,
            problems,
            text: None,
        }
    }

    /// Everything that is wrong with it.
    pub fn found(&self) -> Vec<Problem> {
        let mut problems = self.problems.clone();
        problems.extend(check(&self.project).problems);
        problems
    }

    /// What is wrong with it, a line for each; of a text with the place to which editors go.
    pub fn lines(&self, file: &Path, problems: &[Problem], locale: Locale) -> Vec<String> {
        let places = match &self.text {
            Some(text) => Places::of(text, &self.project).locate(problems),
            None => vec![None; problems.len()],
        };
        let both = problems.iter().zip(places);
        both.map(|(problem, at)| line(file, at, problem, locale))
            .collect()
    }

    /// Ready to run.
    ///
    /// # Errors
    /// What keeps it from running.
    pub fn ready(&self) -> Result<Rc<program::Program>, Vec<Problem>> {
        let checked = check(&self.project);
        let is_error = |one: &&Problem| one.severity == Severity::Error;
        let all = self.problems.iter().chain(&checked.problems);
        let errors: Vec<Problem> = all.filter(is_error).cloned().collect();
        if checked.has_errors() || !errors.is_empty() {
            return Err(errors);
        }
        Ok(Rc::new(checked.program))
    }
}
