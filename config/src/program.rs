//! A loaded configuration program, and the private Lua states in which its converters run.
//!
//! Owns the compiled text of the program and of everything it included, the state in which it ran once, and images of what
//! single nodes reach there. An open file gets a blank state and a copy of its own node's functions and what they hold, so
//! that it costs the same however many nodes there are. What cannot be copied (a coroutine, for one) is made anew instead:
//! the whole program runs again in the file's state, silently and with the same files.

use crate::error::Error;
use crate::limits::{
    BUDGET_US, IMAGES_BYTES_MAX, LOAD_MEMORY_BYTES, LOAD_TIME_MS, MEMORY_KB, SETTLED_NODES_MAX,
};
use crate::vm::bytecode::Code;
use crate::vm::persist::{Image, persist};
use crate::vm::restore::restore;
use crate::vm::stage::Stages;
use crate::vm::state::{Include, State};
use converter::{Conversion, Direction, Fault};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A converter bound in a [`Vm`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageId(usize);

/// A configuration program: its text with everything it included, compiled, and the state in which it ran.
pub struct Program {
    code: Code,
    /// By the name that `include` was given.
    files: Arc<BTreeMap<Vec<u8>, Code>>,
    copies: Mutex<Copies>,
}

/// What states are copied from.
struct Copies {
    /// The state in which the program ran when it was loaded; none if no node needs it.
    original: Option<State>,
    /// What single nodes reach in it, by their paths; none where it cannot be copied.
    images: BTreeMap<String, Option<Arc<Image>>>,
    /// Bytes of all images.
    bytes: usize,
    /// Nodes and attributes with a converter in Lua, until the program is settled.
    unsettled: Vec<String>,
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
    /// `lua_nodes`: the paths of nodes and attributes with a converter in Lua.
    pub(crate) fn new(
        code: Code,
        files: BTreeMap<Vec<u8>, Code>,
        original: Option<State>,
        lua_nodes: Vec<String>,
    ) -> Self {
        Self {
            code,
            files: Arc::new(files),
            copies: Mutex::new(Copies {
                original,
                images: BTreeMap::new(),
                bytes: 0,
                unsettled: lua_nodes,
            }),
        }
    }

    /// Makes a blank state one in which the converters of `node`, the path of a node or attribute, can be bound. A node that
    /// is not there is told of by [`Vm::bind`].
    ///
    /// # Errors
    /// The Lua error, if the program must run anew and fails this time; no memory.
    pub fn prepare(&self, blank: Blank, node: &str) -> Result<Vm, Error> {
        let Some(image) = self.image(node) else {
            drop(blank);
            return self.anew(Some(node));
        };
        let stages = blank.stages;
        restore(stages.state(), &image)?;
        stages.state().set_include(Some(self.include()));
        Ok(Vm::new(stages))
    }

    /// A state for the converters of `node`, as [`prepare`](Self::prepare) makes it of a new blank one.
    ///
    /// # Errors
    /// As there.
    pub fn open(&self, node: &str) -> Result<Vm, Error> {
        self.prepare(Blank::new()?, node)
    }

    /// A state in which the program ran anew, for the converters of all nodes.
    ///
    /// # Errors
    /// The Lua error, if the program fails this time; no memory.
    pub fn run_anew(&self) -> Result<Vm, Error> {
        self.anew(None)
    }

    /// As `run_anew`; of the nodes only `node` is kept, if one is given.
    fn anew(&self, node: Option<&str>) -> Result<Vm, Error> {
        let mut state = State::new(LOAD_MEMORY_BYTES, None, Some(self.include()))?;
        state.run(&self.code, LOAD_TIME_MS.saturating_mul(1_000))?;
        state.keep_tree()?;
        let mut stages = Stages::new(state);
        if let Some(node) = node {
            stages.keep_only(node)?;
        }
        stages.prepare_arrays()?;
        // What lies about would count against the converters' memory, and what they need first fits into its place.
        stages.state().collect()?;
        Ok(Vm::new(stages))
    }

    /// What the converters of a node reach; None if it cannot be copied.
    fn image(&self, node: &str) -> Option<Arc<Image>> {
        let mut copies = self.copies();
        if let Some(known) = copies.images.get(node) {
            return known.clone();
        }
        let original = copies.original.as_mut()?;
        let image = persist(original, node).ok().map(Arc::new);
        let bytes = image.as_ref().map_or(0, |image| image.bytes());
        if copies.bytes.saturating_add(bytes) > IMAGES_BYTES_MAX {
            copies.images.clear();
            copies.bytes = 0;
        }
        copies.bytes += bytes;
        copies.images.insert(node.to_owned(), image.clone());
        image
    }

    /// Makes the images of all nodes, and gives up the state that they are made from if it takes more memory than they do.
    /// Takes some milliseconds for each node, during which others can open files. Later calls do nothing.
    pub fn settle(&self) {
        let nodes = std::mem::take(&mut self.copies().unsettled);
        let held = |copies: &Copies| {
            copies
                .original
                .as_ref()
                .map(|state| state.host().memory.used())
        };
        let Some(before) = held(&self.copies()) else {
            return;
        };
        let are_few = nodes.len() <= SETTLED_NODES_MAX;
        if are_few {
            for node in &nodes {
                self.image(node);
            }
        }
        let mut copies = self.copies();
        let are_made = nodes.iter().all(|node| copies.images.contains_key(node));
        if are_few && are_made && copies.bytes <= before {
            copies.original = None;
        } else if let Some(original) = &copies.original {
            // What making images has left lies about; if it cannot be freed now, it is when more is needed.
            let _ = original.collect();
        }
    }

    /// Whether a state for the node is a copy, and not one in which the program runs anew.
    pub fn is_copied(&self, node: &str) -> bool {
        self.image(node).is_some()
    }

    /// Whether the state in which the program ran is still there.
    #[cfg(test)]
    pub(crate) fn holds_original(&self) -> bool {
        self.copies().original.is_some()
    }

    fn copies(&self) -> MutexGuard<'_, Copies> {
        self.copies.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Finds the files that were included when the program was loaded, and no others.
    fn include(&self) -> Include {
        let files = Arc::clone(&self.files);
        Box::new(move |name| {
            let code = files.get(name).map(Arc::clone);
            code.ok_or_else(|| {
                Error::Script(format!(
                    "'{}' was not included when the configuration was loaded",
                    String::from_utf8_lossy(name)
                ))
            })
        })
    }
}

/// Gives memory of closed states back to the system, as far as the C library can: it keeps what was freed between blocks that
/// live. Takes some milliseconds of a heap of megabytes.
pub fn give_memory_back() {
    crate::vm::memory::give_back();
}

/// Keeps what the process allocates together, before it has threads: the C library would give each of them a place of its
/// own, most of it unused.
pub fn keep_memory_together() {
    crate::vm::memory::keep_together();
}

/// A Lua state with the sandbox, in which no program ran yet; it suits any program.
pub struct Blank {
    stages: Stages,
}

impl fmt::Debug for Blank {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Blank").finish_non_exhaustive()
    }
}

impl Blank {
    /// Makes a state. What its first converter would have to wait for is done here.
    ///
    /// # Errors
    /// No memory.
    pub fn new() -> Result<Self, Error> {
        let mut stages = Stages::new(State::new(LOAD_MEMORY_BYTES, None, None)?);
        stages.prepare_arrays()?;
        stages.state().collect()?;
        Ok(Self { stages })
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
    fn new(stages: Stages) -> Self {
        let mut vm = Self {
            stages,
            budget_us: BUDGET_US,
        };
        vm.limit(MEMORY_KB, BUDGET_US);
        vm
    }

    /// Limits of everything that runs from here on: KiB of Lua memory (with what the converters hold), microseconds of
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
