//! From the stages of a description to stages that are ready to be instantiated: what is loaded, compiled, and tried once.
//!
//! Owns where machine code runs, in the daemon or in a process of its own. What a stage does with tuples is known to `convert`.

use super::inline_c::Compiler;
use super::isolated::{Apart, Isolated};
use super::shared::{self, Library, LibraryError};
use super::{Code, Workshop};
use crate::errno::Error;
use config::description::{NodeDescription, StageDescription, StageKind};
use config::problem::Problem;
use converter::Direction;
use std::fmt::Display;
use std::sync::Arc;
use std::time::Duration;

/// One stage that is ready to be instantiated.
pub(super) struct Plan {
    /// Absent for a Lua function, which lives in the open file's own state.
    pub(super) library: Option<Machine>,
    pub(super) input_size: usize,
    pub(super) output_size: usize,
}

/// Machine code, and where it runs.
pub(super) enum Machine {
    Here(Library),
    Apart(Apart),
}

impl Machine {
    /// Why it cannot be opened, for one who has changed a param: the number is wrong, unless there is no process to ask.
    pub(super) fn refusal(&self, error: Error) -> Error {
        let is_asked = match self {
            Self::Here(_) => true,
            Self::Apart(apart) => apart.has_process(),
        };
        match error {
            Error::Converter(text) if is_asked => Error::Invalid(text),
            other => other,
        }
    }

    /// The node has left the tree.
    pub(super) fn retire(&self) {
        match self {
            Self::Here(_) => {}
            Self::Apart(apart) => apart.retire(),
        }
    }

    pub(super) fn open(&self, info: &shared::OpenInfo<'_>) -> Result<Code, Error> {
        match self {
            Self::Here(library) => {
                let opened = library.open(info).map(Code::Native);
                opened.map_err(|fault| Error::Converter(fault.to_string()))
            }
            Self::Apart(apart) => apart.open(info).map(Code::Isolated),
        }
    }
}

/// The plans of a description, for reading and, if it differs, for writing.
pub(super) fn plans(
    description: &NodeDescription,
    workshop: &Workshop<'_>,
) -> Result<(Vec<Plan>, Option<Vec<Plan>>), Problem> {
    let budget = Duration::from_micros(description.budget_us.into());
    let apart = description
        .isolate
        .then(|| Isolated::new(&description.path, budget));
    let plans = |stages: &[StageDescription]| -> Result<Vec<Plan>, Problem> {
        stages
            .iter()
            .map(|stage| plan(description, stage, apart.as_ref(), workshop))
            .collect()
    };
    let read = plans(&description.converter)?;
    let write = description.write_converter.as_deref().map(plans);
    let write = write.transpose()?;
    if let Some(apart) = &apart {
        seal(description, apart, workshop)?;
    }
    try_openings(description, &read, write.as_deref())?;
    Ok((read, write))
}

fn plan(
    description: &NodeDescription,
    stage: &StageDescription,
    apart: Option<&Arc<Isolated>>,
    workshop: &Workshop<'_>,
) -> Result<Plan, Problem> {
    let library = match &stage.kind {
        StageKind::Lua => None,
        StageKind::Library { path, name } => {
            let copied = workshop.copies.of(path, workshop.cache);
            let loaded = copied.and_then(|copy| {
                let name = name.as_deref();
                Ok(match apart {
                    None => Machine::Here(Library::load_copy_of(path, &copy, name)?),
                    Some(apart) => Machine::Apart(apart.load_copy_of(path, &copy, name)?),
                })
            });
            Some(loaded.map_err(|error| refused(description, stage, &error))?)
        }
        StageKind::InlineC { code } => {
            let node = &description.path;
            let tell = |text: &str| (workshop.progress)(&format!("node {node}: {text}"));
            let path = Compiler::compile_with_any(code, &stage.place, workshop.cache, &tell)?;
            let loaded: Result<_, LibraryError> = match apart {
                None => Library::load(&path, None, workshop.cache).map(Machine::Here),
                Some(apart) => apart.load_inline(&path).map(Machine::Apart),
            };
            Some(loaded.map_err(|error| refused(description, stage, &error))?)
        }
    };
    Ok(Plan {
        library,
        input_size: stage.input_size,
        output_size: stage.output_size,
    })
}

/// Everything of the node is loaded into its process.
fn seal(
    description: &NodeDescription,
    apart: &Isolated,
    workshop: &Workshop<'_>,
) -> Result<(), Problem> {
    let place = &description.place;
    let node = &description.path;
    match apart.seal() {
        Ok(true) => Ok(()),
        Ok(false) => {
            workshop.unconfined.borrow_mut().push(node.clone());
            Ok(())
        }
        Err(error) => Err(Problem::new(
            place.file.clone(),
            place.line,
            format!("node {node}: {error}"),
        )),
    }
}

/// What machine code would refuse to every open file, sizes and parameters, it refuses now.
fn try_openings(
    description: &NodeDescription,
    read: &[Plan],
    write: Option<&[Plan]>,
) -> Result<(), Problem> {
    let reading = (Direction::Read, &*description.converter, read);
    let writing = (
        Direction::Write,
        description.write_converter.as_deref().unwrap_or_default(),
        write.unwrap_or_default(),
    );
    for (direction, stages, plans) in [reading, writing] {
        for (stage, plan) in stages.iter().zip(plans) {
            let Some(library) = &plan.library else {
                continue;
            };
            let info = shared::OpenInfo {
                direction,
                input_size: stage.input_size,
                output_size: stage.output_size,
                node: &description.path,
                params: &description.params,
                log: Arc::new(|_| {}),
            };
            let opened = library.open(&info);
            opened.map_err(|error| refused(description, stage, &error))?;
        }
    }
    Ok(())
}

fn refused(
    description: &NodeDescription,
    stage: &StageDescription,
    reason: &dyn Display,
) -> Problem {
    Problem::new(
        stage.place.file.clone(),
        stage.place.line,
        format!("node {}: {reason}", description.path),
    )
}
