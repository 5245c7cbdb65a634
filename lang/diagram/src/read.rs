//! Bytes of a save to a project.
//!
//! Owns the way from entries through objects to the graph, and the problems on it. Knows no meaning of a block. The
//! graph is what the editor's interpreter walks: blocks and links that a diagram lists as its children, and links in the
//! order of each block's own list.

use super::archive::{self, Archive};
use super::convert;
use super::objects::{self, Objects};
use super::project::Project;
use lang_text::problem::{Problem, Severity, keep};

pub(crate) mod graph;
mod meta;
pub(crate) mod parameters;
mod words;

pub use super::save::Save;
pub use meta::{BLOBS_FILE, META_FILE, Meta, TEMPLATES, WORLD_FILE};

/// Key of a save's version.
pub const VERSION_KEY: &str = "RobotsMetamodelVersion";
/// Key of the version of the language of data flow, where a save has such diagrams.
pub const DATAFLOW_VERSION_KEY: &str = "RobotsDataFlowMetamodelVersion";
/// The version of what is read here and written.
pub const VERSION: &str = "2024.1.0";

/// A save that was read.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What it means.
    pub project: Project,
    /// What is strange but does not keep it from being read.
    pub problems: Vec<Problem>,
    /// What it is made of: for writing it again.
    pub save: Save,
}

/// Reads a save in any container and of any version that the editor still opens.
///
/// # Errors
/// All reasons for which it cannot be read: it is no save, it is damaged or hostile, it is of a newer version.
pub fn read(bytes: &[u8]) -> Result<Opened, Vec<Problem>> {
    let mut problems = Vec::new();
    let archive = archive::open(bytes, &mut problems).map_err(|problem| vec![problem])?;
    let mut objects = read_objects(&archive, &mut problems);
    let mut meta = Meta::read(&archive, &mut problems);
    if let Err(problem) = convert::convert(&mut objects, &mut meta, &mut problems) {
        problems.push(problem);
    }
    if objects.get(objects::ROOT).is_none() && !has_errors(&problems) {
        problems.push(Problem::error(words::no_root()));
    }
    if has_errors(&problems) {
        return Err(limited(problems));
    }
    let project = graph::project(&objects, &meta, &mut problems);
    Ok(Opened {
        project,
        problems: limited(problems),
        save: Save {
            archive,
            objects,
            meta,
            is_edited: false,
        },
    })
}

fn has_errors(problems: &[Problem]) -> bool {
    problems.iter().any(|one| one.severity == Severity::Error)
}

/// The worst problems first, and a last one that counts those that are left out.
pub(super) fn limited(mut problems: Vec<Problem>) -> Vec<Problem> {
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    if problems.len() > lang_text::limits::PROBLEMS {
        let rest = problems.len() - lang_text::limits::PROBLEMS;
        problems.truncate(lang_text::limits::PROBLEMS);
        problems.push(Problem::warning(words::more_problems(rest)));
    }
    problems
}

fn read_objects(archive: &Archive, problems: &mut Vec<Problem>) -> Objects {
    let mut objects = Objects::default();
    let (mut references, mut errors) = (0, 0);
    for (at, entry) in archive.entries.iter().enumerate() {
        if !objects::is_object_file(&entry.name) {
            continue;
        }
        match objects::parse(entry, &mut references, problems) {
            Ok(mut object) => {
                object.entry = Some(at);
                if let Err(object) = objects.add(object) {
                    let mut problem = Problem::warning(words::same_id());
                    problem.place.file = Some(entry.name.clone());
                    problem.place.object = Some(object.id);
                    keep(problems, problem);
                }
            }
            Err(mut problem) => {
                problem.place.file = Some(entry.name.clone());
                // Before warnings, so that there is always room for it.
                problems.insert(0, problem);
                errors += 1;
                if errors == lang_text::limits::PROBLEMS {
                    break;
                }
            }
        }
    }
    objects
}

#[cfg(test)]
mod tests;
