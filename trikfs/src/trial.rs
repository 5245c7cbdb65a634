//! `trikfs convert`: the converter of one node over given bytes, without a mount and without a device.
//!
//! Owns the converter that is tried: loaded and opened as the live node would. `stream` runs bytes through it, and the
//! judging by vectors and by random bytes is that of the crate `converter`, the same for every language.

pub mod bench;
pub mod faults;
pub mod stream;
pub mod timing;

use crate::check::{self, SearchPaths};
use crate::convert::lua::{StateMaker, StatePool};
use crate::convert::shared::copies::Copies;
use crate::convert::{LogSink, Pipeline, Recipe, Workshop};
use crate::errno::Error;
use crate::failure::Failure;
use crate::reload;
use config::description::NodeDescription;
use config::format::Format;
use converter::Direction;
use converter::error::Blame;
use converter::limits::VECTORS_BYTES_MAX;
use converter::trial::{Opened, Report, Trial};
use converter::{Conversion, Fault, trial, vectors};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// One node of a configuration file, ready to be tried.
pub struct Subject {
    description: NodeDescription,
    /// Of a result; bytes of a device have none.
    format: Format,
    direction: Direction,
    recipe: Recipe,
    /// Makes the states of the pool, until it is dropped.
    _maker: StateMaker,
}

impl Subject {
    /// Loads the configuration and prepares the converter of the node in one direction; `params` replace those of the
    /// description.
    ///
    /// # Errors
    /// What `trikfs check` would say, or the nodes that there are.
    pub fn load(
        (file, node): (&Path, &str),
        direction: Direction,
        paths: &SearchPaths,
        params: &BTreeMap<String, f64>,
    ) -> Result<Self, Failure> {
        let loaded = check::load(file, paths)?;
        let nodes = || reload::all(&loaded.config);
        let aliases = &loaded.config.aliases;
        let second = aliases.iter().find(|alias| alias.path == node);
        let wanted = second.map_or(node, |alias| &alias.node);
        let Some(mut description) = nodes().find(|one| one.path == wanted).cloned() else {
            let known = nodes().map(|one| one.path.as_str());
            let known = known.chain(aliases.iter().map(|alias| alias.path.as_str()));
            let known: Vec<_> = known.collect();
            let known = known.join(", ");
            let why = format!("there is no node {node}; there are: {known}");
            return Err(Failure::file(file, why));
        };
        description
            .params
            .extend(params.iter().map(|(name, value)| (name.clone(), *value)));
        let workshop = Workshop {
            cache: &paths.cache,
            copies: &Copies::default(),
            progress: &|_| {},
            unconfined: RefCell::default(),
        };
        let maker = StateMaker::start();
        let maker = maker.map_err(|error| Failure::Opening(error.to_string()))?;
        let pool: Option<Arc<StatePool>> = description
            .uses_lua()
            .then(|| maker.pool(loaded.program.clone()));
        let recipe = Recipe::prepare(&description, &workshop, pool)?;
        let (_, output_size) = sizes(&description, direction);
        let format = description.format.clone();
        let format = format.filter(|_| direction == Direction::Read);
        Ok(Self {
            format: format.unwrap_or_else(|| Format::bytes(output_size)),
            direction,
            description,
            recipe,
            _maker: maker,
        })
    }

    /// The node.
    pub fn description(&self) -> &NodeDescription {
        &self.description
    }

    /// The converter opened afresh. What it logs goes to standard error.
    ///
    /// # Errors
    /// What an open file would be told.
    pub fn open(&self) -> Result<Pipeline, Error> {
        let log: LogSink = Arc::new(|text: &str| eprintln!("{text}"));
        self.recipe.open(&log)
    }

    fn opener(&self) -> impl FnMut() -> Result<Opened, Fault> {
        let fault = |error: Error| Fault::new(error.to_string());
        move || {
            let mut pipeline = self.open().map_err(fault)?;
            let direction = self.direction;
            Ok(Box::new(move |input: &[u8], output: &mut [u8]| {
                convert(&mut pipeline, direction, input, output).map_err(fault)
            }))
        }
    }
}

/// One tuple through a pipeline.
///
/// # Errors
/// The fault.
pub fn convert(
    pipeline: &mut Pipeline,
    direction: Direction,
    input: &[u8],
    output: &mut [u8],
) -> Result<Conversion, Error> {
    let batch = pipeline.convert(direction, input, output);
    match batch.fault {
        Some(fault) => Err(fault),
        None if batch.produced > 0 => Ok(Conversion::Produced),
        None => Ok(Conversion::Consumed),
    }
}

/// Runs a file of vectors through the node, with the params of that file, and tells how many there were.
///
/// # Errors
/// Vectors of other sizes than the node's, or the first one that is not met.
pub fn check_vectors(
    (file, node): (&Path, &str),
    direction: Direction,
    paths: &SearchPaths,
    vectors: &Path,
) -> Result<String, Failure> {
    let shown = vectors.display();
    let bytes = read(vectors, VECTORS_BYTES_MAX)?;
    let text = String::from_utf8(bytes).map_err(|error| Failure::file(vectors, error))?;
    let parsed = vectors::parse(&text).map_err(|error| Failure::file(vectors, error))?;
    let subject = Subject::load((file, node), direction, paths, &parsed.params)?;
    let shown_sizes = |(input, output)| format!("{input} and {output} bytes");
    let (theirs, ours) = ((parsed.input_size, parsed.output_size), subject.sizes());
    if theirs != ours {
        let why = format!(
            "the vectors have tuples of {}, node {node} of {}",
            shown_sizes(theirs),
            shown_sizes(ours)
        );
        return Err(Failure::file(vectors, why));
    }
    let count = trial::check_vectors(&parsed, &mut subject.opener());
    let count = count.map_err(|error| judged(&error).at(shown.to_string()))?;
    Ok(format!("{shown}: {count} vectors hold\n"))
}

/// Random bytes for the node's converter.
pub struct Random {
    /// How many tuples.
    pub tuples: usize,
    /// The same tuples for the same number.
    pub seed: u32,
}

/// Gives the node's converter random tuples (see [`trial::check_properties`]) and tells what became of them. Numbers
/// that its `format` calls floats must be finite. `recorded` has tuples of the device, perhaps none.
///
/// # Errors
/// What was not true, of which tuple.
pub fn check_random(
    subject: &Subject,
    random: &Random,
    recorded: &[u8],
) -> Result<String, Failure> {
    let (input_size, output_size) = subject.sizes();
    let check = |output: &[u8]| match subject.format.is_text() {
        // Any bytes may be a text; its file says so where they are none.
        true => Ok(()),
        false => subject
            .format
            .render(output, &mut String::new())
            .map_err(|why| Fault::new(why.to_string())),
    };
    let trial = Trial {
        input_size,
        output_size,
        tuples: random.tuples,
        seed: random.seed,
        recorded,
        check: &check,
    };
    let node = &subject.description.path;
    trial::check_properties(&trial, &mut subject.opener())
        .map(|report| render(node, random, &report))
        .map_err(|error| judged(&error).at(format!("node {node}")))
}

/// What a trial of a converter found.
fn judged(error: &converter::error::Error) -> Failure {
    match error.blame() {
        Blame::Author => Failure::Converter(error.to_string()),
        Blame::Configuration => Failure::Opening(error.to_string()),
        Blame::Vectors => Failure::Refused(error.to_string()),
    }
}

fn render(node: &str, random: &Random, report: &Report) -> String {
    let refused: usize = report.faults.values().sum();
    let mut text = format!(
        "node {node}: {} random tuples, seed {}: {} converted, {} taken without output, {refused} refused\n",
        report.produced + report.consumed + refused,
        random.seed,
        report.produced,
        report.consumed,
    );
    for (reason, count) in &report.faults {
        text.push_str(&format!("  {count} times: {reason}\n"));
    }
    text
}

impl Subject {
    /// Bytes of a tuple before and after the converter.
    fn sizes(&self) -> (usize, usize) {
        sizes(&self.description, self.direction)
    }
}

/// Bytes of a tuple before and after the conversion in a direction.
fn sizes(description: &NodeDescription, direction: Direction) -> (usize, usize) {
    match direction {
        Direction::Read => (description.input_tuple_size, description.output_tuple_size),
        Direction::Write => description.write_conversion_sizes(),
    }
}

/// A file, at most so many bytes of it.
///
/// # Errors
/// It cannot be read, or is larger.
pub fn read(file: &Path, bytes_max: usize) -> Result<Vec<u8>, Failure> {
    let failed = |error: std::io::Error| Failure::file(file, error);
    let opened = std::fs::File::open(file).map_err(failed)?;
    let mut bytes = Vec::new();
    opened
        .take(bytes_max as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() > bytes_max {
        return Err(Failure::file(file, format!("more than {bytes_max} bytes")));
    }
    Ok(bytes)
}
