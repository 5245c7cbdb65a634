//! All nodes of a configuration on a bench: bytes of their devices go in, samples come out, with no mount and no device.
//!
//! Owns which node of a configuration is meant, and what a sample is: what the live node would publish, or why it would
//! publish nothing. When bytes came is not known here; converters know no time.

use crate::check::{self, SearchPaths};
use crate::cli::search_paths;
use crate::convert::lua::{StateMaker, StatePool};
use crate::convert::shared::copies::Copies;
use crate::convert::{LogSink, Pipeline, Recipe, Workshop};
use crate::errno::Error;
use crate::failure::Failure;
use crate::files::control::fault_line;
use config::description::NodeDescription;
use config::format::{FieldKind, Format};
use config::load::Loaded;
use converter::Direction;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A loaded configuration whose nodes can be tried.
pub struct Bench {
    loaded: Loaded,
    paths: SearchPaths,
    copies: Copies,
    pool: Arc<StatePool>,
    /// Makes the states of the pool, until it is dropped.
    _maker: StateMaker,
}

/// One node at work.
pub struct Trial {
    /// The text of its `format`.
    pub format: String,
    /// Its unit.
    pub units: String,
    /// What it is.
    pub about: String,
    /// Other names of it.
    pub aliases: Vec<String>,
    kinds: Format,
    input_size: usize,
    sample: Vec<u8>,
    pipeline: Pipeline,
    _recipe: Recipe,
}

/// Why a node has no value: the errno, and what its `fault` says.
pub type NoValue = (i32, String);

impl Bench {
    /// Loads a configuration file as a mount would; `include` stands before the usual folders.
    ///
    /// # Errors
    /// What `trikfs check` would say.
    pub fn load(file: &Path, include: Vec<PathBuf>, cache: Option<&Path>) -> Result<Self, Failure> {
        let paths = search_paths(include, cache, None)?;
        let loaded = check::load(file, &paths)?;
        Self::new(loaded, paths)
    }

    /// The same with a text, as if it stood in a file of this folder.
    ///
    /// # Errors
    /// As `load`.
    pub fn load_text(
        text: &[u8],
        folder: Option<&Path>,
        include: Vec<PathBuf>,
        cache: Option<&Path>,
    ) -> Result<Self, Failure> {
        let paths = search_paths(include, cache, None)?;
        let loaded = check::load_text("config", folder, text, &paths)?;
        Self::new(loaded, paths)
    }

    fn new(loaded: Loaded, paths: SearchPaths) -> Result<Self, Failure> {
        let maker = StateMaker::start();
        let maker = maker.map_err(|error| Failure::Opening(error.to_string()))?;
        Ok(Self {
            pool: maker.pool(loaded.program.clone()),
            loaded,
            paths,
            copies: Copies::default(),
            _maker: maker,
        })
    }

    /// The paths of all nodes, in their order.
    pub fn nodes(&self) -> impl Iterator<Item = &str> {
        self.loaded
            .config
            .nodes
            .iter()
            .map(|node| node.path.as_str())
    }

    /// The node of this name, which may be its second one.
    fn find(&self, name: &str) -> Option<&NodeDescription> {
        let aliases = &self.loaded.config.aliases;
        let second = aliases.iter().find(|alias| alias.path == name);
        let wanted = second.map_or(name, |alias| &alias.node);
        let nodes = &self.loaded.config.nodes;
        nodes.iter().find(|node| node.path == wanted)
    }

    /// Whether a name is a second one of the node at this path.
    pub fn is_second(&self, name: &str, path: &str) -> bool {
        name != path && self.find(name).is_some_and(|node| node.path == path)
    }

    /// Whether it is no sensor: it comes to rest, and what is written to it is what it has.
    pub fn is_actuator(&self, name: &str) -> bool {
        self.find(name).is_some_and(|node| node.rest.is_some())
    }

    /// Whether this node and the other one of another configuration have the same bytes of the same device.
    pub fn is_same_source(&self, name: &str, other: &Self, other_name: &str) -> bool {
        let (one, other) = (self.find(name), other.find(other_name));
        one.zip(other).is_some_and(|(one, other)| {
            one.source == other.source && one.input_tuple_size == other.input_tuple_size
        })
    }

    /// Opens the converters of a node as a live one would. None: there is no such node.
    ///
    /// # Errors
    /// What an open file would be told.
    pub fn open(&self, name: &str) -> Result<Option<Trial>, Failure> {
        let Some(node) = self.find(name) else {
            return Ok(None);
        };
        let workshop = Workshop {
            cache: &self.paths.cache,
            copies: &self.copies,
            progress: &|_| {},
            unconfined: RefCell::default(),
        };
        let pool = node.uses_lua().then(|| self.pool.clone());
        let recipe = Recipe::prepare(node, &workshop, pool)?;
        let log: LogSink = Arc::new(|text: &str| eprintln!("{text}"));
        let pipeline = recipe
            .open(&log)
            .map_err(|error| Failure::Opening(format!("{}: {error}", node.path)))?;
        let format = node.format.clone();
        let kinds = format.unwrap_or_else(|| Format::bytes(node.output_tuple_size));
        let aliases = self.loaded.config.aliases.iter();
        let own = aliases.filter(|alias| alias.node == node.path);
        Ok(Some(Trial {
            format: kinds.to_string(),
            units: node.units.clone(),
            about: node.about.clone(),
            aliases: own.map(|alias| alias.path.clone()).collect(),
            kinds,
            input_size: node.input_tuple_size,
            sample: vec![0; node.output_tuple_size],
            pipeline,
            _recipe: recipe,
        }))
    }
}

impl Trial {
    /// Bytes that its device gives at once.
    pub fn input_size(&self) -> usize {
        self.input_size
    }

    /// What the node would publish for these bytes, which are as many as it takes: a sample, nothing yet, or why not.
    pub fn convert(&mut self, given: &[u8]) -> Result<Option<&[u8]>, NoValue> {
        let mut batch = (self.pipeline).convert(Direction::Read, given, &mut self.sample);
        if let Some(fault) = batch.fault.take() {
            return Err(no_value(fault.of_reading()));
        }
        if batch.produced == 0 {
            return Ok(None);
        }
        let is_float = |kind| matches!(kind, FieldKind::F32 | FieldKind::F64);
        if self.kinds.fields().iter().any(|field| is_float(field.kind))
            && let Err(why) = self.kinds.render(&self.sample, &mut String::new())
        {
            return Err(no_value(Error::Converter(why.to_string())));
        }
        Ok(Some(&self.sample))
    }
}

fn no_value(error: Error) -> NoValue {
    (error.errno(), fault_line(&error))
}
