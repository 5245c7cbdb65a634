//! A loaded configuration program, and the private Lua states in which its converters run.
//!
//! Owns the compiled text of the program and of everything it included. Closures cannot move between Lua states, so each
//! state runs the whole program again, silently and with the same files, and takes the converters of its own run.

use crate::error::Error;
use crate::limits::{BUDGET_US, LOAD_MEMORY_BYTES, LOAD_TIME_MS, MEMORY_KB};
use crate::vm::bytecode::Code;
use crate::vm::stage::Stages;
use crate::vm::state::{Include, State};
use converter::{Conversion, Direction, Fault};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// A converter bound in a [`Vm`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageId(usize);

/// The text of a configuration with everything it included, compiled.
pub struct Program {
    code: Code,
    /// By the name that `include` was given.
    files: Arc<BTreeMap<Vec<u8>, Code>>,
}

impl fmt::Debug for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let files = self.files.keys().map(|name| String::from_utf8_lossy(name));
        f.debug_struct("Program")
            .field("files", &files.collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

impl Program {
    pub(crate) fn new(code: Code, files: BTreeMap<Vec<u8>, Code>) -> Self {
        Self {
            code,
            files: Arc::new(files),
        }
    }

    /// A fresh private state in which the program has run silently, ready to bind converters.
    ///
    /// # Errors
    /// The Lua error, if the program fails this time; no memory.
    pub fn prepare(&self) -> Result<Vm, Error> {
        let files = Arc::clone(&self.files);
        let include: Include = Box::new(move |name| {
            let code = files.get(name).map(Arc::clone);
            code.ok_or_else(|| {
                Error::Script(format!(
                    "'{}' was not included when the configuration was loaded",
                    String::from_utf8_lossy(name)
                ))
            })
        });
        let mut state = State::new(LOAD_MEMORY_BYTES, None, Some(include))?;
        state.run(&self.code, LOAD_TIME_MS.saturating_mul(1_000))?;
        state.keep_tree()?;
        let mut stages = Stages::new(state);
        stages.prepare_arrays()?;
        // What lies about would count against the converters' memory, and what they need first fits into its place.
        stages.state().collect()?;
        let mut vm = Vm {
            stages,
            budget_us: BUDGET_US,
        };
        vm.limit(MEMORY_KB, BUDGET_US);
        Ok(vm)
    }
}

/// A Lua state of its own for one open file.
pub struct Vm {
    stages: Stages,
    budget_us: u32,
}

impl fmt::Debug for Vm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Vm")
            .field("memory", &self.memory())
            .finish_non_exhaustive()
    }
}

impl Vm {
    /// Limits of everything that runs from here on: KiB of Lua memory (with the program itself), microseconds of
    /// processor time of one conversion.
    pub fn limit(&mut self, memory_kb: u32, budget_us: u32) {
        let bytes = usize::try_from(memory_kb)
            .unwrap_or(usize::MAX)
            .saturating_mul(1024);
        self.stages.state().host().memory.set_limit(bytes);
        self.budget_us = budget_us;
    }

    /// Bytes of Lua memory that the state holds. The buffers of the stages and compiled machine code come on top.
    pub fn memory(&self) -> usize {
        self.stages.state().host().memory.used()
    }

    /// Where `trikfs_log` and `print` go; nowhere without this. Lines are cut at `limits::LOG_LINE_BYTES_MAX`.
    pub fn set_log(&mut self, sink: Arc<dyn Fn(&str) + Send + Sync>) {
        self.stages.state().set_log(Some(sink));
    }

    /// Sets numbers in the global table `params` and in the `params` table of the node's own description, so that a
    /// converter sees them in whichever it looks at. Numbers that are not named stay.
    ///
    /// # Errors
    /// No memory.
    pub fn set_params(&mut self, node: &str, params: &BTreeMap<String, f64>) -> Result<(), Error> {
        self.stages.set_params(node, params)
    }

    /// Finds a converter of this state's own run and gives it buffers of these sizes. `node` is the path of a node or
    /// attribute; `position` counts the stages of its chain from 0. For writing, `write_converter` is taken if there is
    /// one and `converter` otherwise.
    ///
    /// # Errors
    /// The program made no such converter this time; no memory.
    pub fn bind(
        &mut self,
        node: &str,
        direction: Direction,
        position: usize,
        input_size: usize,
        output_size: usize,
    ) -> Result<StageId, Error> {
        self.stages
            .bind(node, direction, position, input_size, output_size)
            .map(StageId)
    }

    /// Lets go of all nodes but the one whose converters this state is for: of the global `trikfs` remain that node and the
    /// groups on the way to it. A node that is not there is told of by [`bind`](Self::bind).
    ///
    /// # Errors
    /// No memory.
    pub fn keep_only(&mut self, node: &str) -> Result<(), Error> {
        self.stages.keep_only(node)
    }

    /// Converts one tuple. `output` is zeroed before the converter sees it and keeps its old bytes unless the tuple was
    /// produced.
    ///
    /// # Errors
    /// The fault: Lua's message with file and line, the budget, the memory, a result that means nothing; or buffers that
    /// have not the sizes of the stage.
    pub fn convert(
        &mut self,
        stage: StageId,
        input: &[u8],
        output: &mut [u8],
    ) -> Result<Conversion, Fault> {
        self.stages.convert(stage.0, input, output, self.budget_us)
    }

    /// Converts tuple after tuple until the input has no whole tuple left, the output has no room for one, or one fails.
    /// Gives the tuples taken (with the failed one), the tuples produced, and the fault.
    pub fn convert_many(
        &mut self,
        stage: StageId,
        input: &[u8],
        output: &mut [u8],
    ) -> (usize, usize, Option<Fault>) {
        let Some((input_size, output_size)) = self.stages.sizes(stage.0) else {
            return (0, 0, Some("no such stage in this state".into()));
        };
        let (mut taken, mut produced) = (0, 0);
        let mut room = output.chunks_exact_mut(output_size.max(1));
        let mut place = room.next();
        for tuple in input.chunks_exact(input_size.max(1)) {
            let Some(out) = place.as_mut() else { break };
            taken += 1;
            match self.stages.convert(stage.0, tuple, out, self.budget_us) {
                Ok(Conversion::Produced) => {
                    produced += 1;
                    place = room.next();
                }
                Ok(Conversion::Consumed) => {}
                Err(fault) => return (taken, produced, Some(fault)),
            }
        }
        (taken, produced, None)
    }
}

#[cfg(test)]
mod tests;
