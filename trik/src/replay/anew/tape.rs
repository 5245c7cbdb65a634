//! What comes of a recording with another configuration, as a recording.
//!
//! Owns which nodes are in it: those that are converted anew, and all others as they were. It is played like any other.

use super::{Anew, Had, Run, Step};
use crate::error::Error;
use crate::limits;
use crate::recording::shared::Opened;
use journal::node::Node;
use journal::read::EventKind;
use journal::write::{Id, Writer};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Writes it into an empty file, of which errors have this name, until somebody wants an end of that.
///
/// # Errors
/// What the run says, the file cannot be written, or the end.
pub(crate) fn write(
    run: &mut Run,
    (file, into): (File, &Path),
    wants_end: &dyn Fn() -> bool,
) -> Result<(), Error> {
    let failed = |why: journal::error::Error| Error::file(into, why);
    let library = concat!("trik/", env!("CARGO_PKG_VERSION"));
    let mut out = Writer::new(BufWriter::new(file), library).map_err(failed)?;
    let anew = run
        .nodes
        .iter()
        .map(|anew| out.add(&node(anew, &run.plain)));
    let anew: Result<Vec<Id>, _> = anew.collect();
    let anew = anew.map_err(failed)?;
    let mut as_they_were = Vec::new();
    for (number, node) in run.plain.nodes().iter().enumerate() {
        let is_anew = run.nodes.iter().any(|one| one.recorded == Some(number));
        let id = (!is_anew).then(|| out.add(node)).transpose();
        as_they_were.push(id.map_err(failed)?);
    }
    let mut steps: usize = 0;
    run.walk(|plain, _, step| {
        steps += 1;
        if steps.is_multiple_of(limits::ANEW_STEPS) && wants_end() {
            return Err(Error::Refused("ended before all was converted".to_owned()));
        }
        let written = match step {
            Step::Given(node, at, Some(had)) => had_at(&mut out, anew[node], at, had),
            Step::Given(_, _, None) => Ok(()),
            Step::Recorded(event) => match &event.what {
                EventKind::Sample {
                    node,
                    layout,
                    tuple,
                    ..
                } => match as_they_were[*node] {
                    Some(id) if plain.layout(*node) == Some(&plain.layouts()[*layout]) => {
                        out.sample(id, event.unix_ns, tuple)
                    }
                    // Before its format changed it was another node.
                    Some(_) | None => Ok(()),
                },
                EventKind::Fault {
                    node,
                    errno,
                    reason,
                } => match as_they_were[*node] {
                    Some(id) => out.fault(id, event.unix_ns, *errno, reason),
                    None => Ok(()),
                },
                EventKind::Line(story, line) => out.line(*story, event.unix_ns, line),
            },
        };
        written.map_err(failed)
    })?;
    out.finish().map_err(failed)
}

fn had_at(
    out: &mut Writer<BufWriter<File>>,
    id: Id,
    at: u64,
    had: Had,
) -> Result<(), journal::error::Error> {
    match had {
        Ok(tuple) => out.sample(id, at, &tuple),
        Err((errno, why)) => out.fault(id, at, errno, &why),
    }
}

/// What is told of a node that is converted anew.
fn node(anew: &Anew, plain: &Opened) -> Node {
    let before = anew.recorded.map(|node| &plain.nodes()[node]);
    Node {
        path: anew.path.clone(),
        format: anew.trial.format.clone(),
        units: anew.trial.units.clone(),
        about: anew.trial.about.clone(),
        is_written: before.is_some_and(|before| before.is_written),
        rest: String::new(),
        aliases: anew.trial.aliases.clone(),
        is_raw: false,
    }
}
