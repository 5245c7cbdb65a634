//! From the bytes of a configuration file to a checked `Config` and the program behind it.
//!
//! Owns the order of the steps and the limits of the first run. A failure at any step leaves nothing behind.

use crate::check::check;
use crate::dataflow::{self, Language};
use crate::dcml::{self, Named};
use crate::description::{Config, NodeDescription};
use crate::error::Error;
use crate::limits::{
    BLANK_BYTES, CONFIG_BYTES_MAX, INCLUDES_MAX, LOAD_MEMORY_BYTES, LOAD_TIME_MS, LOG_LINES_MAX,
    NODES_TRIED_MAX, ORIGINAL_BYTES_MAX,
};
use crate::problem::Problem;
use crate::program::Program;
use crate::search::Search;
use crate::texts::Texts;
use crate::vm::bytecode::{Code, compile};
use crate::vm::extract::extract;
use crate::vm::fingerprint::{digest_functions, hash};
use crate::vm::persist::keep_pristine;
use crate::vm::state::{Include, LogSink, State};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Where a configuration finds other files.
#[derive(Clone, Debug, Default)]
pub struct Loader {
    /// Folders for `include` and for recordings, first match wins.
    pub include_dirs: Vec<PathBuf>,
    /// Folders for converter libraries, after the configuration file's own.
    pub library_dirs: Vec<PathBuf>,
    /// Folder below which all device paths are taken: a virtual board.
    pub device_root: Option<PathBuf>,
}

/// A good configuration.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// All nodes, checked.
    pub config: Config,
    /// Source of the private Lua states.
    pub program: Arc<Program>,
    /// What is suspicious but allowed.
    pub warnings: Vec<Problem>,
    /// Lines that the program logged while it ran, at most a thousand.
    pub log: Vec<String>,
}

impl Loader {
    /// Runs and checks a configuration. `name` stands in messages; `base_dir` is the folder of the file, where libraries
    /// are looked for first, or None if there is no file.
    ///
    /// Takes at most about `limits::LOAD_TIME_MS` and `limits::LOAD_MEMORY_BYTES`. Opens included files, nothing else.
    ///
    /// # Errors
    /// The first problem found.
    pub fn load(
        &self,
        name: &str,
        base_dir: Option<&Path>,
        source: &[u8],
    ) -> Result<Loaded, Problem> {
        self.load_within(name, base_dir, source, LOAD_TIME_MS, LOAD_MEMORY_BYTES)
    }

    /// As [`load`](Self::load) with other limits.
    pub(crate) fn load_within(
        &self,
        name: &str,
        base_dir: Option<&Path>,
        source: &[u8],
        time_ms: u32,
        memory_bytes: usize,
    ) -> Result<Loaded, Problem> {
        if source.len() > CONFIG_BYTES_MAX {
            return Err(Problem::new(
                name,
                0,
                format!("the configuration has more than {CONFIG_BYTES_MAX} bytes"),
            ));
        }
        let search = Search {
            base_dir: base_dir.map(Path::to_path_buf),
            include_dirs: self.include_dirs.clone(),
            library_dirs: self.library_dirs.clone(),
        };
        let run = Arc::new(Mutex::new(Run {
            texts: Texts::default(),
            search,
            files: BTreeMap::new(),
            salt: hash(source),
            log: Vec::new(),
        }));
        // The lock is taken for a moment each time: callbacks of the state take it, too.
        let problem = |error: Error| locked(&run).texts.problem(&error.to_string());
        let compiled = locked(&run).compile(name, source);
        let code = compiled.map_err(problem)?;
        let mut state = new_state(&run, memory_bytes).map_err(problem)?;
        let ended = state
            .run(&code, time_ms.saturating_mul(1_000))
            .and_then(|()| state.keep_tree());
        ended.map_err(problem)?;
        let undefined = state.host().undefined.take();
        let mut values = extract(&state).map_err(|refusal| {
            let keys: Vec<&str> = refusal.path.iter().map(String::as_str).collect();
            let place = locked(&run).texts.place(&keys);
            let path = match keys.as_slice() {
                [] => "trikfs".to_owned(),
                ["trikfs", inner @ ..] if !inner.is_empty() => inner.join("/"),
                all => all.join("/"),
            };
            Problem::new(
                place.file,
                place.line,
                format!("{path}: {}", refusal.reason),
            )
        })?;
        let salt = locked(&run).salt;
        digest_functions(&mut state, &mut values, salt);
        let held_bytes = state.collect().map_err(problem)?;
        // From here on it is only read.
        state.set_log(None);
        state.set_include(None);
        state
            .host()
            .memory
            .set_limit(memory_bytes.saturating_mul(2));
        let mut run = locked(&run);
        let (mut config, mut warnings) = check(&values, &run.texts, &run.search)?;
        let is_kept = held_bytes <= ORIGINAL_BYTES_MAX && lua_nodes(&config).next().is_some();
        let original = is_kept.then_some(state);
        let files = std::mem::take(&mut run.files);
        let nodes = lua_nodes(&config).map(|node| node.path.clone()).collect();
        let program = Arc::new(Program::new(code, files, original, nodes));
        enough_memory(&config, &program, held_bytes)?;
        if let Some(root) = &self.device_root {
            crate::device_root::take_below(&mut config, root);
        }
        warnings.extend(undefined.iter().map(|name| run.texts.undefined(name)));
        Ok(Loaded {
            config,
            program,
            warnings,
            log: std::mem::take(&mut run.log),
        })
    }
}

/// Nodes and attributes with a converter in Lua.
fn lua_nodes(config: &Config) -> impl Iterator<Item = &NodeDescription> {
    let nodes = config.nodes.iter();
    nodes
        .flat_map(|node| std::iter::once(node).chain(&node.attributes))
        .filter(|node| node.uses_lua())
}

/// Every open file of a Lua node has a state with what its converters hold: the node's memory must have room for that.
/// Only a node with less memory than the whole program holds is tried, and only the first few of those: each costs a state.
fn enough_memory(config: &Config, program: &Program, held_bytes: usize) -> Result<(), Problem> {
    let bytes_of = |node: &NodeDescription| {
        let kib = usize::try_from(node.memory_kb).unwrap_or(usize::MAX);
        kib.saturating_mul(1024)
    };
    let doubtful =
        lua_nodes(config).filter(|node| held_bytes.saturating_add(BLANK_BYTES) > bytes_of(node));
    for node in doubtful.take(NODES_TRIED_MAX) {
        let reason = match program.open(&node.path) {
            Ok(vm) if vm.memory() <= bytes_of(node) => continue,
            Ok(vm) => format!(
                "what its converters hold takes {} KiB in each open file's lua state, memory_kb = {} leaves no room",
                vm.memory().div_ceil(1024),
                node.memory_kb
            ),
            Err(error) => format!("no lua state can be made for its converters: {error}"),
        };
        return Err(Problem::new(
            node.place.file.clone(),
            node.place.line,
            format!("node {}: {reason}", node.path),
        ));
    }
    Ok(())
}

/// What the first run of a program gathers. Shared with the callbacks of its state.
struct Run {
    texts: Texts,
    search: Search,
    files: BTreeMap<Vec<u8>, Code>,
    /// Changes with every change of any of the texts.
    salt: u128,
    log: Vec<String>,
}

fn locked(run: &Mutex<Run>) -> MutexGuard<'_, Run> {
    run.lock().unwrap_or_else(PoisonError::into_inner)
}

fn new_state(run: &Arc<Mutex<Run>>, memory_bytes: usize) -> Result<State, Error> {
    let logged = Arc::clone(run);
    let log: LogSink = Arc::new(move |line| {
        let mut run = locked(&logged);
        if run.log.len() < LOG_LINES_MAX {
            run.log.push(line.to_owned());
        }
    });
    let including = Arc::clone(run);
    let include: Include = Box::new(move |name| locked(&including).include(name));
    let state = State::new(memory_bytes, Some(log), Some(include))?;
    keep_pristine(&state)?;
    Ok(state)
}

impl Run {
    /// Compiles a file after the checks that need no parser.
    fn compile(&mut self, name: &str, source: &[u8]) -> Result<Code, Error> {
        let chunk = self.texts.add(name, source);
        if source.first() == Some(&0x1b) {
            return Err(Error::Script(format!(
                "{}:1: bytecode is not loaded, only text",
                &chunk[1..]
            )));
        }
        if let Some(at) = source.iter().position(|byte| *byte == 0) {
            let line = source
                .iter()
                .take(at)
                .filter(|byte| **byte == b'\n')
                .count()
                + 1;
            return Err(Error::Script(format!(
                "{}:{line}: the file contains a zero byte and is no text",
                &chunk[1..]
            )));
        }
        compile(&chunk, source, false)
    }

    /// Finds and compiles an included file; each is read once.
    fn include(&mut self, name: &[u8]) -> Result<Code, Error> {
        if let Some(code) = self.files.get(name) {
            return Ok(Arc::clone(code));
        }
        if self.files.len() == INCLUDES_MAX {
            return Err(Error::Script(format!(
                "more than {INCLUDES_MAX} files are included"
            )));
        }
        if let Some(model) = name.strip_prefix(dcml::PREFIX) {
            let code = self.model(Named::of(model))?;
            self.files.insert(name.to_vec(), Arc::clone(&code));
            return Ok(code);
        }
        if let Some((program, language)) = dataflow::asked(name) {
            let code = self.dataflow(program, language)?;
            self.files.insert(name.to_vec(), Arc::clone(&code));
            return Ok(code);
        }
        let (shown, source) = self.search.include(name)?;
        self.salt ^= hash(&source).rotate_left(1);
        let code = self.compile(&shown, &source)?;
        self.files.insert(name.to_vec(), Arc::clone(&code));
        Ok(code)
    }

    /// Finds and translates a program of data flow.
    fn dataflow(&mut self, name: &[u8], language: Language) -> Result<Code, Error> {
        let (shown, source) = match dataflow::is_text(name) {
            true => ("the text of the program".to_owned(), name.to_vec()),
            false => self.search.beside(name, &[""])?,
        };
        self.salt ^= hash(&source).rotate_left(3);
        match dataflow::is_written(name) {
            true if language == Language::Lua => self.compile(&shown, &source),
            true => Err(Error::Named(format!(
                "'{shown}' is Lua already: language = 'c' takes the program itself"
            ))),
            false => {
                let lua = dataflow::chunk(source, name, &shown, language)?;
                compile("=dataflow", lua.as_bytes(), true)
            }
        }
    }

    /// Finds and translates a model in DCML.
    fn model(&mut self, named: Named<'_>) -> Result<Code, Error> {
        let (shown, source, wanted, place) = match named {
            Named::Text(text) => {
                let place = self.texts.of_text(text).unwrap_or_default();
                (
                    "the text of the model".to_owned(),
                    text.to_vec(),
                    None,
                    Some(place),
                )
            }
            Named::File(name, wanted) => {
                let (shown, source) = self.search.model(name)?;
                (shown, source, wanted, None)
            }
        };
        self.salt ^= hash(&source).rotate_left(2);
        let text = lang_dcml::decode(source)
            .map_err(|reason| Error::Named(format!("{shown}:{reason}")))?;
        let wanted = wanted.map(String::from_utf8_lossy);
        let lua = dcml::chunk(
            &text,
            wanted.as_deref(),
            &shown,
            |line, column| match &place {
                // Lines of the configuration; columns are those of the text, which differ in its first line only.
                Some(place) => {
                    format!("{}:{}:{column}", place.file, place.line as usize + line - 1)
                }
                None => format!("{shown}:{line}:{column}"),
            },
        )?;
        compile("=model", lua.as_bytes(), true)
    }
}

#[cfg(test)]
mod tests;
