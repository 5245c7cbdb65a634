//! Everything that is wrong with a file: a program of blocks with the world in it, or a world.
//!
//! Owns what is a world: a file that begins with a tag, and the world model of a save. What is wrong is found in `lang` and
//! by the judge in `sim`.

use crate::findings::Findings;
use crate::program::{self, Flow, Unreadable};
use crate::words;
use lang_diagram::check::check;
use lang_diagram::lower::World;
use lang_diagram::project::Project;
use lang_diagram::read::{self, Opened};
use lang_text::problem::Problem;
use sim::judge::{self, Texts};
use std::path::Path;

/// The part of a save that lines and columns of its world are in.
const WORLD: &str = "worldModel";

/// What a file is.
pub enum Content {
    /// A save with a diagram of control flow.
    Diagram(Box<Opened>),
    /// A data-flow program, with the save that it is of.
    Flow(Flow, Option<Box<Opened>>),
    /// The text of a world model.
    World(String),
}

impl Content {
    /// What the bytes of a file are; one that begins with a tag is a world. Of its name only the ending counts.
    ///
    /// # Errors
    /// Why they are nothing that can be looked at.
    pub fn read(name: &Path, bytes: Vec<u8>) -> Result<Self, Unreadable> {
        if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
            return Err(Unreadable::File(words::utf_16()));
        }
        if is_script(name) {
            return Err(Unreadable::File(words::is_program()));
        }
        if program::is_text(name) {
            return Ok(Self::Flow(program::of_text(bytes)?, None));
        }
        if !is_world(&bytes) {
            let opened = read::read(&bytes).map_err(Unreadable::Save)?;
            return Ok(match program::of_save(opened) {
                program::Program::Diagram(opened) => Self::Diagram(opened),
                program::Program::Flow(flow, save) => Self::Flow(flow, Some(save)),
                program::Program::Text(flow) => Self::Flow(flow, None),
            });
        }
        let text = String::from_utf8(bytes)
            .map_err(|error| Unreadable::File(words::no_utf_8(error.utf8_error().valid_up_to())))?;
        Ok(Self::World(text))
    }

    /// Everything that is wrong with it, as it was found.
    pub fn problems(&self) -> Vec<Problem> {
        match self {
            Self::Diagram(opened) => of_project(&opened.project, opened.problems.clone()),
            Self::Flow(flow, None) => flow.found(),
            Self::Flow(flow, Some(opened)) => {
                of_flow(flow, &opened.project, opened.problems.clone())
            }
            Self::World(world) => judge::lint(Texts {
                world,
                ..Texts::default()
            }),
        }
    }

    /// What is known of the places in it.
    pub fn findings(&self) -> Findings<'_> {
        match self {
            Self::Diagram(opened) => Findings::new(Some(&opened.project)),
            Self::Flow(flow, None) => Findings::of_flow(flow),
            Self::Flow(_, Some(_)) | Self::World(_) => Findings::new(None),
        }
    }
}

impl Unreadable {
    /// The same as problems.
    pub fn problems(self) -> Vec<Problem> {
        match self {
            Self::File(words) | Self::Diagram(words) => vec![Problem::error(words)],
            Self::Save(problems) => problems,
        }
    }
}

/// What is known of the places in a file that could not be read.
pub fn unread(name: &Path) -> Findings<'static> {
    match program::is_text(name) {
        true => Findings::of_unread_text(),
        false => Findings::new(None),
    }
}

/// Whether the bytes of a file are a world: they begin with a tag.
pub fn is_world(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    text.trim_ascii_start().first() == Some(&b'<')
}

/// Whether a file is a program with text by its name.
fn is_script(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ["js", "py"].contains(&&*ending.to_ascii_lowercase()))
}

/// Everything that is wrong with a project of diagrams of control flow, after what was found while it was read.
pub fn of_project(project: &Project, found: Vec<Problem>) -> Vec<Problem> {
    let mut problems = found;
    problems.extend(check(project, World::Robot));
    problems.extend(of_world_in(project));
    problems
}

/// Everything that is wrong with a data-flow program of a save, after what was found while it was read. `project` is what
/// else the save has.
pub fn of_flow(flow: &Flow, project: &Project, found: Vec<Problem>) -> Vec<Problem> {
    let mut problems = found;
    problems.extend(flow.found());
    problems.extend(of_world_in(project));
    problems
}

/// What is wrong with the world in a save.
fn of_world_in(project: &Project) -> Vec<Problem> {
    let Some(world) = project.world.as_deref() else {
        return Vec::new();
    };
    let mut problems = judge::lint(Texts {
        world,
        blobs: project.blobs.as_deref(),
        templates: Some(&project.templates),
    });
    for problem in &mut problems {
        problem.place.file.get_or_insert_with(|| WORLD.to_owned());
    }
    problems
}
