//! A program of blocks in its world, ready to be debugged.
//!
//! Owns what a caller is given that runs it tick by tick. What of its files is taken is known in [`super::run`].

use super::args::CheckArgs;
use super::jobs::{jobs, shown};
use super::run::{Lines, Refused, Solution, line, ready, settings, world};
use super::words;
use crate::diagrams::flow::Flow;
use lang_diagram::lower::World;
use lang_diagram::program::Program as Lowered;
use lang_diagram::project::Project;
use sim::judge::{Settings, Task};
use std::path::PathBuf;
use std::rc::Rc;
use std::time::Duration;

/// How a program that is debugged begins.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Start {
    /// It is stopped before its first block.
    Stopped,
    /// It runs until something stops it.
    Running,
}

/// A program of blocks that is ready to run in its world, for a caller that runs it tick by tick.
pub(crate) struct Staged {
    pub file: PathBuf,
    /// Its main diagram, if that is not the first one.
    pub diagram: Option<String>,
    pub program: Ready,
    /// In which a diagram is lowered.
    pub world: World,
    pub task: Task,
    pub settings: Settings,
    /// What is strange in the world.
    pub strange: Lines,
}

/// Why a program is not debugged block by block.
pub(crate) const NO_BLOCKS: &str = "only diagrams have blocks to stop at; programs in Python and JavaScript are debugged in an editor (trik dap)";

/// A program as people see it, and as it runs.
pub(crate) enum Ready {
    /// A diagram of control flow.
    Diagram(Box<Project>, Rc<Lowered>),
    /// A data-flow program.
    Flow(Flow, Rc<lang_dataflow::program::Program>),
}

/// The only program of the arguments, ready to run.
///
/// # Errors
/// Lines that say why it cannot run: it has no blocks, or it, its world or its rules are broken.
pub(crate) fn staged(args: &CheckArgs) -> Result<Staged, Lines> {
    let jobs = jobs(args).map_err(line)?;
    let [job] = &jobs[..] else {
        return Err(vec![words::one_to_debug(jobs.len(), args.language)]);
    };
    let all = || {
        let settings = Settings {
            // A person thinks.
            longest: Duration::MAX,
            ..settings(job, args).map_err(line)?
        };
        let mut solution = Solution::read(&job.solution, args)?;
        if solution.script.is_some() {
            return Err(vec![format!("{}: {NO_BLOCKS}", shown(&job.solution))].into());
        }
        let (mut task, strange) = solution.task(job, args)?;
        let program = match solution.flow.take() {
            Some(flow) => {
                let program = ready(&flow, &job.solution, args)?;
                Ready::Flow(flow, program)
            }
            None => {
                let program = solution.diagram(&mut task, args)?;
                Ready::Diagram(Box::new(solution.project), program)
            }
        };
        Ok(Staged {
            file: job.solution.clone(),
            diagram: args.diagram.clone(),
            program,
            world: world(args),
            task,
            settings,
            strange,
        })
    };
    all().map_err(|refused: Refused| refused.lines)
}
