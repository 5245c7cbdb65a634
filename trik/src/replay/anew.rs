//! A recording through another configuration: what devices gave goes through its converters once more.
//!
//! Owns which node gets whose bytes, and the order of what was recorded and what comes of it now. `tape` makes a recording of
//! it, `compare` tells where both differ, `picture` draws them. Nothing here knows a clock: two runs give the same.

pub(super) mod compare;
mod picture;
pub(super) mod tape;

use crate::error::Error;
use crate::recording::shared::{Opened, Progress, open};
use crate::terminal::{harmless, named};
use journal::layout::Layout;
use journal::read::{Event, RawEvent};
use recorder::pattern::matches;
use std::path::{Path, PathBuf};
use trikfs::trial::bench::{Bench, NoValue, Trial};

/// What a node has at a moment: a tuple, or why none.
pub(super) type Had = Result<Vec<u8>, NoValue>;

/// One node that is converted anew.
pub(super) struct Anew {
    /// Its path in the configuration.
    pub(super) path: String,
    /// The node whose device's bytes it gets.
    pub(super) of: String,
    /// It among the nodes of the recording; None: it is new.
    pub(super) recorded: Option<usize>,
    /// The form of its samples.
    pub(super) layout: Layout,
    trial: Trial,
    /// The failure that stands there: one that lasts is told once.
    failure: Option<NoValue>,
}

/// What is taken.
pub(super) struct Of<'a> {
    /// The recording.
    pub(super) file: &'a Path,
    /// The other configuration.
    pub(super) config: &'a Path,
    /// Folders of what it includes, before the usual ones.
    pub(super) include: &'a [PathBuf],
    /// Patterns of the nodes that are converted anew; all if there are none.
    pub(super) only: &'a [String],
}

/// A recording and a configuration.
pub(super) struct Run {
    path: PathBuf,
    config: PathBuf,
    /// What nodes had, in the order of time.
    plain: Opened,
    /// What devices gave.
    raw: Opened,
    pub(super) nodes: Vec<Anew>,
    /// Of each source the nodes that get what it gave.
    feeds: Vec<Vec<usize>>,
}

/// What happens, in the order of time.
pub(super) enum Step<'a> {
    /// Something was recorded.
    Recorded(&'a Event),
    /// The device of this node gave something at this moment, in ns since 1970, and that comes of it now.
    Given(usize, u64, Option<Had>),
}

impl Run {
    /// Opens both.
    ///
    /// # Errors
    /// One of them cannot be read, the recording has no bytes of devices, or the configuration has none of these nodes.
    pub(super) fn open(of: &Of<'_>) -> Result<Self, Error> {
        let (path, config, include) = (of.file, of.config, of.include);
        let mut plain = open(path)?;
        if !plain.has_raw() {
            let why = "it has no bytes of devices, which another configuration could convert: record it with trik record \
                       --raw, on a robot of trik up --raw or of nodes with raw = true";
            return Err(Error::file(path, why));
        }
        let refused = |why: trikfs::failure::Failure| Error::Refused(why.to_string());
        let bench = Bench::load(config, include.to_vec(), None).map_err(refused)?;
        // Without it nodes are found by their names.
        let text = plain.attachment("config.lua").ok();
        let before = text
            .and_then(|text| Bench::load_text(&text, config.parent(), include.to_vec(), None).ok());
        let mut run = Self {
            path: path.to_owned(),
            config: config.to_owned(),
            raw: open(path)?,
            feeds: vec![Vec::new(); plain.raws().len()],
            plain,
            nodes: Vec::new(),
        };
        let is_wanted =
            |node: &&str| of.only.is_empty() || of.only.iter().any(|one| matches(one, node));
        let sensors = bench.nodes().filter(|node| !bench.is_actuator(node));
        for node in sensors.filter(is_wanted) {
            let Some(raw) = source_of(node, &bench, before.as_ref(), run.plain.raws()) else {
                continue;
            };
            if let Some(trial) = bench.open(node).map_err(refused)? {
                run.add(node, raw, trial)?;
            }
        }
        if run.nodes.is_empty() {
            return Err(run.has_none(of.only));
        }
        Ok(run)
    }

    fn add(&mut self, node: &str, raw: usize, trial: Trial) -> Result<(), Error> {
        let layout = Layout::parse(&trial.format).map_err(|why| Error::file(&self.config, why))?;
        self.feeds[raw].push(self.nodes.len());
        let mut recorded = self.plain.nodes().iter();
        let is_same = |one: &&String| *one == node || trial.aliases.contains(one);
        self.nodes.push(Anew {
            path: node.to_owned(),
            of: self.plain.raws()[raw].clone(),
            recorded: recorded.position(|other| is_same(&&other.path)),
            layout,
            trial,
            failure: None,
        });
        Ok(())
    }

    fn has_none(&self, only: &[String]) -> Error {
        let raws = self.plain.raws();
        let some: Vec<String> = raws.iter().take(4).map(|raw| harmless(raw)).collect();
        let more = if raws.len() > some.len() { ", ..." } else { "" };
        let which = if only.is_empty() {
            "none"
        } else {
            "none that --only matches"
        };
        let why = format!(
            "it has {which} of the nodes whose bytes are in {}, and none with the same source: {}{more}",
            named(&self.path),
            some.join(", ")
        );
        Error::file(&self.config, why)
    }

    /// When the recording begins, in ns since 1970.
    pub(super) fn begin_ns(&self) -> u64 {
        self.plain.begin_ns()
    }

    /// When it ends.
    pub(super) fn end_ns(&self) -> u64 {
        self.plain.end_ns()
    }

    /// All that happens, from the beginning to the end. What a device gave comes before what was made of it then.
    ///
    /// # Errors
    /// The recording contradicts itself, a device gave another number of bytes than the configuration takes, or `take` fails.
    pub(super) fn walk(
        &mut self,
        mut take: impl FnMut(&Opened, &[Anew], Step<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let (begin, length) = (
            self.begin_ns(),
            self.end_ns().saturating_sub(self.begin_ns()),
        );
        let mut progress = Progress::new();
        self.plain.seek(begin);
        self.raw.seek_raw(begin);
        let path = self.path.clone();
        let fail = |why| Error::file(&path, why);
        let mut given = self.raw.next_raw().map_err(fail)?;
        let mut event = self.plain.next().map_err(fail)?;
        loop {
            let at = event.as_ref().map_or(u64::MAX, |event| event.unix_ns);
            match (given.take(), &event) {
                (Some(first), _) if first.unix_ns <= at => {
                    progress.at(first.unix_ns.saturating_sub(begin), length);
                    self.feed(&first, &mut take)?;
                    given = self.raw.next_raw().map_err(fail)?;
                }
                (later, Some(happened)) => {
                    given = later;
                    take(&self.plain, &self.nodes, Step::Recorded(happened))?;
                    event = self.plain.next().map_err(fail)?;
                }
                (_, None) => return Ok(()),
            }
        }
    }

    fn feed(
        &mut self,
        event: &RawEvent,
        take: &mut impl FnMut(&Opened, &[Anew], Step<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        for node in self.feeds[event.raw].clone() {
            let had = match &event.given {
                Ok(bytes) => self.convert(node, bytes)?,
                Err(why) => Some(Err(why.clone())),
            };
            let anew = &mut self.nodes[node];
            let had = had.filter(|had| had.as_ref().err() != anew.failure.as_ref() || had.is_ok());
            if let Some(had) = &had {
                anew.failure = had.as_ref().err().cloned();
            }
            take(
                &self.plain,
                &self.nodes,
                Step::Given(node, event.unix_ns, had),
            )?;
        }
        Ok(())
    }

    fn convert(&mut self, node: usize, bytes: &[u8]) -> Result<Option<Had>, Error> {
        let anew = &mut self.nodes[node];
        let wanted = anew.trial.input_size();
        if bytes.len() != wanted {
            let why = format!(
                "{} takes {wanted} bytes from its device at once, and those of {} in {} are {}: input_tuple_size or \
                 input_format is another one",
                harmless(&anew.path),
                harmless(&anew.of),
                named(&self.path),
                bytes.len()
            );
            return Err(Error::file(&self.config, why));
        }
        Ok(match anew.trial.convert(bytes) {
            Ok(sample) => sample.map(|sample| Ok(sample.to_vec())),
            Err(why) => Some(Err(why)),
        })
    }
}

/// Which of the sources a node gets: that of its name or second name, or else one that was the same in the configuration
/// before.
fn source_of(node: &str, bench: &Bench, before: Option<&Bench>, raws: &[String]) -> Option<usize> {
    let by_name = raws.iter().position(|raw| raw == node);
    let by_second = || {
        let is_it = |raw: &String| bench.is_second(raw, node);
        raws.iter().position(is_it)
    };
    let by_source = || {
        let before = before?;
        raws.iter()
            .position(|raw| bench.is_same_source(node, before, raw))
    };
    by_name.or_else(by_second).or_else(by_source)
}
