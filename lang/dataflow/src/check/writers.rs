//! Motors with two masters: who drives them, and what decides between them.
//!
//! Owns that two blocks are told of once, with all ports that both drive.

use super::found::Found;
use super::shape::{Graph, delays};
use super::words;
use crate::limits;
use crate::program::{Act, Flow, NodeId, Op, Program, Target};
use lang_diagram::ports::{Port, Sort};
use std::collections::{BTreeMap, HashMap, HashSet};

/// What tells a port something: the node that a token comes from, and where it comes to; a block that is started is both.
type Writer = (NodeId, Target);

/// Two blocks that drive the same ports: where that is told, their names, and the ports.
struct Pair {
    at: NodeId,
    names: [String; 2],
    ports: Vec<&'static str>,
}

/// Motors that two parts of the program drive without anything that decides between them.
pub(super) fn look(program: &Program, graph: &Graph, found: &mut Found) {
    // Looking takes time with the size of the program; a large one is not looked at wholly.
    let most = limits::WRITER_WALKS_MAX / (program.nodes.len() + graph.edges()).max(1);
    let early = early(program, graph);
    let mut looked = 0;
    let mut told: Vec<Pair> = Vec::new();
    let mut places: HashMap<(NodeId, NodeId, NodeId), usize> = HashMap::new();
    for (port, writers) in writers_of(program) {
        if port.sort() == Sort::Encoder {
            continue;
        }
        let mut pairs = 0;
        'port: for (at, &first) in writers.iter().enumerate() {
            for &second in &writers[at + 1..] {
                pairs += 1;
                looked += 4;
                if pairs > limits::WRITER_PAIRS_MAX || looked > most.max(4) {
                    break 'port;
                }
                let is_one = first.0 == second.0
                    || is_before(program, &early, first, second)
                    || is_separated(program, graph, first, second);
                if is_one {
                    continue;
                }
                // Who drives the port, or if that is one block, who tells it what.
                let blocks = match first.1.node == second.1.node {
                    true => [first.0, second.0],
                    false => [first.1.node, second.1.node],
                };
                let place = places.entry((first.1.node, blocks[0], blocks[1]));
                let place = *place.or_insert_with(|| {
                    told.push(Pair {
                        at: first.1.node,
                        names: blocks.map(|id| program.node(id).label()),
                        ports: Vec::new(),
                    });
                    told.len() - 1
                });
                told[place].ports.push(port.name());
                break 'port;
            }
        }
    }
    for Pair { at, names, ports } in told {
        found.warn(
            program.place(at),
            words::two_writers(&ports.join(", "), &names),
        );
    }
}

/// Nodes that tokens reach in the instant in which the program begins.
fn early(program: &Program, graph: &Graph) -> HashSet<NodeId> {
    let main = program.instances.first();
    let starts = main.into_iter().flat_map(|main| &main.starts);
    graph.reached_through(starts.map(|start| start.node), |id| {
        !delays(&program.node(id).op)
    })
}

/// Whether one of two writers is a start of the program and the other one speaks later: then each has its time.
fn is_before(program: &Program, early: &HashSet<NodeId>, one: Writer, other: Writer) -> bool {
    let begins = |(from, to): Writer| {
        let node = program.node(from);
        from == to.node && node.linked == 0 && node.instance == 0
    };
    let is_later = |(from, _): Writer| !early.contains(&from) || delays(&program.node(from).op);
    begins(one) && is_later(other) || begins(other) && is_later(one)
}

/// Who tells a port something: the node that a token comes from, or the block itself when it is started.
fn writers_of(program: &Program) -> BTreeMap<Port, Vec<Writer>> {
    let mut all: BTreeMap<Port, Vec<Writer>> = BTreeMap::new();
    let written = |to: Target| -> Vec<Port> {
        match &program.node(to.node).op {
            Op::Act(Act::Drive { devices, .. }) => match to.port.checked_sub(2) {
                Some(at) => vec![devices[usize::from(at)].0],
                None => devices.iter().map(|(port, _)| *port).collect(),
            },
            Op::Act(Act::WritePort { port, .. }) => vec![*port],
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => Vec::new(),
        }
    };
    for id in 0..program.nodes.len() as NodeId {
        for (_, to) in program.edges(id) {
            for port in written(to) {
                all.entry(port).or_default().push((id, to));
            }
        }
    }
    for instance in &program.instances {
        for &start in &instance.starts {
            for port in written(start) {
                all.entry(port).or_default().push((start.node, start));
            }
        }
    }
    all
}

/// Whether two writers follow each other, or a block decides which of them gets a token.
fn is_separated(program: &Program, graph: &Graph, one: Writer, other: Writer) -> bool {
    let follows = |from: Writer, to: Writer| graph.reached([from.0, from.1.node]).contains(&to.0);
    if follows(one, other) || follows(other, one) {
        return true;
    }
    // Starts that come of one block follow each other, or are meant to come together.
    let are_starts = [one.1, other.1]
        .iter()
        .all(|to| program.node(to.node).row.control() == Some(to.port));
    let of_one = graph.sources([one.0]);
    graph.sources([other.0]).iter().any(|id| {
        if are_starts && of_one.contains(id) {
            return true;
        }
        let decides = matches!(
            program.node(*id).op,
            Op::Flow(Flow::If(_) | Flow::Switch { .. } | Flow::Unzip)
        );
        decides && of_one.contains(id)
    })
}
