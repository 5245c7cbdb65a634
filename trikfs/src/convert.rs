//! Converters as the filesystem sees them: a recipe made once per description, a pipeline made once per open file.
//!
//! Owns the chain of stages and its scratch buffers. Each of the three languages has a file below; nothing else in this
//! crate runs Lua or loads machine code.

pub mod inline_c;
pub mod isolated;
pub mod lua;
mod plan;
pub mod shared;

use crate::errno::Error;
use crate::events::lock;
use config::description::NodeDescription;
use config::problem::Problem;
use config::program::{StageId, Vm};
use converter::{Conversion, Direction};
use isolated::IsolatedStage;
use lua::StatePool;
use plan::Plan;
use shared::copies::Copies;
use shared::{Cache, NativeStage};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

/// Everything needed to make pipelines of one description.
pub struct Recipe {
    node: String,
    params: Mutex<Arc<Params>>,
    /// How often a param was changed; a pipeline that knows another number takes them anew.
    generation: AtomicU32,
    memory_kb: u32,
    budget_us: u32,
    /// Bytes of a tuple that passes unchanged, for a description without stages.
    tuple_size: usize,
    read: Vec<Plan>,
    write: Option<Vec<Plan>>,
    lua: Mutex<Option<Arc<StatePool>>>,
}

/// Params by name.
type Params = BTreeMap<String, f64>;

/// Where converters write their log lines.
pub type LogSink = Arc<dyn Fn(&str) + Send + Sync>;

/// What making recipes needs: the compiler, the cache of compiled code, and somebody to tell of progress.
pub struct Workshop<'a> {
    /// Keeps compiled and copied libraries.
    pub cache: &'a Cache,
    /// Which copies of shared libraries it loads.
    pub copies: &'a Copies,
    /// Told before something that takes long.
    pub progress: &'a dyn Fn(&str),
    /// Nodes whose isolated converters the kernel holds to no list of system calls, as they are found.
    pub unconfined: RefCell<Vec<String>>,
}

impl Recipe {
    /// Loads and compiles what the description names and opens native converters once, to hear what they refuse; opens
    /// no device and converts nothing.
    pub fn prepare(
        description: &NodeDescription,
        workshop: &Workshop<'_>,
        lua: Option<Arc<StatePool>>,
    ) -> Result<Self, Problem> {
        let (read, write) = plan::plans(description, workshop)?;
        Ok(Self {
            node: description.path.clone(),
            params: Mutex::new(Arc::new(description.params.clone())),
            generation: AtomicU32::new(0),
            memory_kb: description.memory_kb,
            budget_us: description.budget_us,
            tuple_size: description.input_tuple_size,
            read,
            write,
            lua: Mutex::new(lua.filter(|_| description.uses_lua())),
        })
    }

    /// Takes Lua states from another pool from here on: that of an equal description in a newer configuration.
    pub fn move_to(&self, pool: &Arc<StatePool>) {
        if let Some(current) = lock(&self.lua).as_mut() {
            *current = pool.clone();
        }
    }

    /// The node has left the tree: its process ends, also if a program still has files of it open.
    pub fn retire(&self) {
        let write = self.write.iter().flatten();
        for machine in self.read.iter().chain(write).flat_map(|plan| &plan.library) {
            machine.retire();
        }
    }

    /// A private pipeline for one open file.
    pub fn open(&self, log: &LogSink) -> Result<Pipeline, Error> {
        let pool = lock(&self.lua).clone();
        let generation = self.generation.load(Ordering::Acquire);
        let params = lock(&self.params).clone();
        let vm = match &pool {
            None => None,
            Some(pool) => {
                let mut vm = pool.take(&self.node).map_err(unusable)?;
                // First: what the converters hold may be more than the default allows.
                vm.limit(self.memory_kb, self.budget_us);
                vm.set_log(log.clone());
                vm.set_params(&self.node, &params).map_err(unusable)?;
                Some(vm)
            }
        };
        let unchanged = Chain::Unchanged {
            tuple_size: self.tuple_size,
        };
        let mut pipeline = Pipeline {
            vm,
            pool,
            generation,
            read: unchanged,
            write: None,
        };
        pipeline.read = self.chain(
            &self.read,
            Direction::Read,
            &params,
            pipeline.vm.as_mut(),
            log,
        )?;
        if let Some(write) = &self.write {
            let vm = pipeline.vm.as_mut();
            pipeline.write = Some(self.chain(write, Direction::Write, &params, vm, log)?);
        }
        Ok(pipeline)
    }

    /// How often a param was changed. Wraps.
    pub fn generation(&self) -> u32 {
        self.generation.load(Ordering::Acquire)
    }

    /// The present value of a param.
    pub fn param(&self, name: &str) -> Option<f64> {
        lock(&self.params).get(name).copied()
    }

    /// Changes a param for all pipelines, open ones included, which take it before their next tuple: a Lua converter
    /// finds it in `params`, a library converter is opened anew and begins afresh.
    ///
    /// # Errors
    /// The reason of a library that refuses the number; then nothing has changed.
    pub fn set_param(&self, name: &str, value: f64) -> Result<(), Error> {
        let mut params = lock(&self.params);
        let mut changed = Params::clone(&params);
        changed.insert(name.to_owned(), value);
        let write = self
            .write
            .iter()
            .flatten()
            .map(|plan| (plan, Direction::Write));
        for (plan, direction) in self
            .read
            .iter()
            .map(|plan| (plan, Direction::Read))
            .chain(write)
        {
            if let Some(library) = &plan.library {
                let log: LogSink = Arc::new(|_| {});
                let info = self.open_info(plan, direction, &changed, &log);
                let opened = library.open(&info);
                opened.map_err(|error| library.refusal(error))?;
            }
        }
        *params = Arc::new(changed);
        self.generation.fetch_add(1, Ordering::Release);
        Ok(())
    }

    /// Gives a param the number back that it had: no library is asked, because each has taken it before.
    pub fn restore_param(&self, name: &str, value: f64) {
        let mut params = lock(&self.params);
        let mut restored = Params::clone(&params);
        restored.insert(name.to_owned(), value);
        *params = Arc::new(restored);
        self.generation.fetch_add(1, Ordering::Release);
    }

    /// Gives a pipeline the params of now, if it does not have them.
    #[inline]
    pub fn renew(&self, pipeline: &mut Pipeline, log: impl Fn() -> LogSink) -> Result<(), Error> {
        let generation = self.generation.load(Ordering::Acquire);
        if pipeline.generation == generation {
            return Ok(());
        }
        let params = lock(&self.params).clone();
        if let Some(vm) = pipeline.vm.as_mut() {
            vm.set_params(&self.node, &params).map_err(unusable)?;
        }
        let log = log();
        let (read, write) = (&mut pipeline.read, pipeline.write.as_mut());
        self.reopen(&self.read, read, Direction::Read, &params, &log)?;
        if let (Some(plans), Some(chain)) = (&self.write, write) {
            self.reopen(plans, chain, Direction::Write, &params, &log)?;
        }
        pipeline.generation = generation;
        Ok(())
    }

    fn reopen(
        &self,
        plans: &[Plan],
        chain: &mut Chain,
        direction: Direction,
        params: &Params,
        log: &LogSink,
    ) -> Result<(), Error> {
        let Chain::Stages(stages) = chain else {
            return Ok(());
        };
        for (plan, stage) in plans.iter().zip(stages) {
            if let Some(library) = &plan.library {
                let info = self.open_info(plan, direction, params, log);
                stage.code = library.open(&info)?;
            }
        }
        Ok(())
    }

    fn open_info<'a>(
        &'a self,
        plan: &Plan,
        direction: Direction,
        params: &'a Params,
        log: &LogSink,
    ) -> shared::OpenInfo<'a> {
        shared::OpenInfo {
            direction,
            input_size: plan.input_size,
            output_size: plan.output_size,
            node: &self.node,
            params,
            log: log.clone(),
        }
    }

    fn chain(
        &self,
        plans: &[Plan],
        direction: Direction,
        params: &Params,
        mut vm: Option<&mut Vm>,
        log: &LogSink,
    ) -> Result<Chain, Error> {
        if plans.is_empty() {
            let tuple_size = self.tuple_size;
            return Ok(Chain::Unchanged { tuple_size });
        }
        let mut stages = Vec::with_capacity(plans.len());
        for (position, plan) in plans.iter().enumerate() {
            let (input_size, output_size) = (plan.input_size, plan.output_size);
            let code = if let Some(library) = &plan.library {
                let info = self.open_info(plan, direction, params, log);
                library.open(&info)?
            } else {
                let Some(vm) = vm.as_mut() else {
                    return Err(Error::Internal(format!(
                        "{}: a Lua stage without a Lua state",
                        self.node
                    )));
                };
                Code::Lua(
                    vm.bind(&self.node, direction, position, input_size, output_size)
                        .map_err(unusable)?,
                )
            };
            stages.push(Stage {
                code,
                input_size,
                between: vec![0; output_size],
                has_given: false,
            });
        }
        Ok(Chain::Stages(stages))
    }
}

/// A converter that cannot be opened.
fn unusable(why: impl Display) -> Error {
    Error::Converter(why.to_string())
}

/// The stages of one open file, both directions, with their state.
pub struct Pipeline {
    vm: Option<Vm>,
    pool: Option<Arc<StatePool>>,
    /// Which params it has; see `Recipe::generation`.
    generation: u32,
    read: Chain,
    /// Absent when both directions go through the same stages.
    write: Option<Chain>,
}

impl Pipeline {
    /// Bytes that its Lua state holds; what native converters allocate is not known.
    pub fn memory(&self) -> usize {
        self.vm.as_ref().map_or(0, Vm::memory)
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // Closing a Lua state takes longer than a read: leave it to the pool's thread.
        if let (Some(vm), Some(pool)) = (self.vm.take(), self.pool.take()) {
            pool.discard(vm);
        }
    }
}

/// One direction.
enum Chain {
    /// There are no stages: tuples pass as they are.
    Unchanged { tuple_size: usize },
    /// Each tuple passes all, in this order; there is at least one.
    Stages(Vec<Stage>),
}

struct Stage {
    code: Code,
    input_size: usize,
    /// Output of this stage on its way to the next one.
    between: Vec<u8>,
    /// It gave one for the last tuple that came to it.
    has_given: bool,
}

enum Code {
    Lua(StageId),
    Native(NativeStage),
    Isolated(IsolatedStage),
}

/// What became of a run of tuples.
#[derive(Debug, Default)]
pub struct Batch {
    /// Tuples taken from the input, the failing one included.
    pub consumed: usize,
    /// Tuples put into the output.
    pub produced: usize,
    /// Why it stopped before the input's end or the output's.
    pub fault: Option<Error>,
}

impl Pipeline {
    /// Converts as many whole tuples as there are and as fit. `input` and `output` are multiples of the tuple sizes.
    pub fn convert(&mut self, direction: Direction, input: &[u8], output: &mut [u8]) -> Batch {
        let chain = match (direction, &mut self.write) {
            (Direction::Write, Some(write)) => write,
            _ => &mut self.read,
        };
        chain.convert(self.vm.as_mut(), input, output)
    }

    /// What each stage but the last has made of the last tuple that was read, as far as it came. True: the last one has given too.
    pub fn tell_stages(&self, tell: &mut dyn FnMut(&[u8])) -> bool {
        let Chain::Stages(stages) = &self.read else {
            return true;
        };
        let given = stages.iter().take_while(|stage| stage.has_given).count();
        let inner = stages.len() - 1;
        for stage in &stages[..given.min(inner)] {
            tell(&stage.between);
        }
        given > inner
    }
}

impl Chain {
    fn convert(&mut self, vm: Option<&mut Vm>, input: &[u8], output: &mut [u8]) -> Batch {
        match self {
            Self::Unchanged { tuple_size } => {
                let n = input.len().min(output.len());
                output[..n].copy_from_slice(&input[..n]);
                let tuples = n / *tuple_size;
                Batch {
                    consumed: tuples,
                    produced: tuples,
                    fault: None,
                }
            }
            Self::Stages(stages) => match stages.as_mut_slice() {
                [only] => {
                    let batch = only.convert_many(vm, input, output);
                    only.has_given = batch.produced > 0;
                    batch
                }
                stages => convert_through(stages, vm, input, output),
            },
        }
    }
}

fn convert_through(
    stages: &mut [Stage],
    mut vm: Option<&mut Vm>,
    input: &[u8],
    output: &mut [u8],
) -> Batch {
    let mut batch = Batch::default();
    let (input_size, output_size) = (stages[0].input_size, stages[stages.len() - 1].between.len());
    let mut outputs = output.chunks_exact_mut(output_size);
    let mut target = outputs.next();
    for tuple in input.chunks_exact(input_size) {
        let Some(out) = target.as_deref_mut() else {
            break;
        };
        batch.consumed += 1;
        match one_through(stages, vm.as_deref_mut(), tuple, out) {
            Ok(Conversion::Produced) => {
                batch.produced += 1;
                target = outputs.next();
            }
            Ok(Conversion::Consumed) => {}
            Err(error) => {
                batch.fault = Some(error);
                break;
            }
        }
    }
    batch
}

fn one_through(
    stages: &mut [Stage],
    mut vm: Option<&mut Vm>,
    input: &[u8],
    output: &mut [u8],
) -> Result<Conversion, Error> {
    let last = stages.len() - 1;
    for index in 0..=last {
        let (before, rest) = stages.split_at_mut(index);
        let stage = &mut rest[0];
        let from = before
            .last()
            .map_or(input, |stage| stage.between.as_slice());
        let outcome = if index == last {
            stage.code.convert(vm.as_deref_mut(), from, output)
        } else {
            stage
                .code
                .convert(vm.as_deref_mut(), from, &mut stage.between)
        };
        stage.has_given = matches!(outcome, Ok(Conversion::Produced));
        let outcome = outcome.map_err(|error| in_stage(error, index, last))?;
        if outcome == Conversion::Consumed {
            return Ok(Conversion::Consumed);
        }
    }
    Ok(Conversion::Produced)
}

/// A converter's own fault with its place in the chain.
fn in_stage(error: Error, index: usize, last: usize) -> Error {
    match error {
        Error::Converter(text) => {
            Error::Converter(format!("stage {} of {}: {text}", index + 1, last + 1))
        }
        other => other,
    }
}

const NO_STATE: &str = "a Lua stage without a Lua state";

impl Stage {
    fn convert_many(&mut self, vm: Option<&mut Vm>, input: &[u8], output: &mut [u8]) -> Batch {
        let (consumed, produced, fault) = match (&mut self.code, vm) {
            (Code::Native(native), _) => native.convert_many(input, output),
            (Code::Isolated(isolated), _) => {
                let (consumed, produced, fault) = isolated.convert_many(input, output);
                return Batch {
                    consumed,
                    produced,
                    fault,
                };
            }
            (Code::Lua(stage), Some(vm)) => vm.convert_many(*stage, input, output),
            (Code::Lua(_), None) => (0, 0, Some(NO_STATE.into())),
        };
        Batch {
            consumed,
            produced,
            fault: fault.as_ref().map(Error::of_converter),
        }
    }
}

impl Code {
    fn convert(
        &mut self,
        vm: Option<&mut Vm>,
        input: &[u8],
        output: &mut [u8],
    ) -> Result<Conversion, Error> {
        match (self, vm) {
            (Self::Native(native), _) => native
                .convert(input, output)
                .map_err(|fault| Error::of_converter(&fault)),
            (Self::Isolated(isolated), _) => isolated.convert(input, output),
            (Self::Lua(stage), Some(vm)) => vm
                .convert(*stage, input, output)
                .map_err(|fault| Error::of_converter(&fault)),
            (Self::Lua(_), None) => Err(Error::Converter(NO_STATE.to_owned())),
        }
    }
}
