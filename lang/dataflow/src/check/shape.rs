//! Ways of tokens: cycles, blocks that nothing starts, outputs that nobody takes, motors with two masters.
//!
//! Owns what only the graph shows.

use super::found::{Found, port_place};
use super::{instant, words};
use crate::blocks::Direction;
use crate::limits;
use crate::program::{Act, Flow, NodeId, Op, Program, Source, Target};
use lang_diagram::ports::{Port, Sort};
use std::collections::{BTreeMap, HashSet};

pub(super) fn look(program: &Program, found: &mut Found) {
    let graph = Graph::new(program);
    let cycles = cycles(program, &graph);
    if cycles.is_empty() {
        instant::look(program, found);
    }
    for cycle in cycles {
        tell_cycle(program, cycle, found);
    }
    dead(program, &graph, found);
    for id in 0..program.nodes.len() as NodeId {
        node(program, id, found);
    }
    writers(program, &graph, found);
}

/// Where tokens go from node to node, through calls as well.
struct Graph {
    next: Vec<Vec<NodeId>>,
    previous: Vec<Vec<NodeId>>,
}

impl Graph {
    fn new(program: &Program) -> Self {
        let mut next: Vec<Vec<NodeId>> = (0..program.nodes.len() as NodeId)
            .map(|id| program.edges(id).map(|(_, to)| to.node).collect())
            .collect();
        for instance in &program.instances {
            let Some(caller) = instance.caller else {
                continue;
            };
            let into = instance.inputs.iter().map(|(_, input)| *input);
            let starts = instance.starts.iter().map(|start| start.node);
            // What leaves a body leaves its call, which is not what starts it: a call is two nodes in truth.
            next[caller as usize].extend(into.chain(starts));
        }
        for (id, node) in (0..).zip(&program.nodes) {
            if let Op::Flow(Flow::OutPort(Some(Target { node: call, port }))) = node.op {
                let out = program.node(call).outs.get(usize::from(port));
                let targets = out.into_iter().flatten().map(|to| to.node);
                let of_node: &mut Vec<NodeId> = &mut next[id as usize];
                of_node.extend(targets);
            }
        }
        // Edges out of a call begin at the output ports of its body.
        for (id, node) in (0usize..).zip(&program.nodes) {
            if let Op::Flow(Flow::Call(instance)) = node.op {
                let body = &program.instances[instance as usize];
                let inside = body.nodes.clone();
                next[id].retain(|to| inside.contains(to));
            }
        }
        let mut previous = vec![Vec::new(); next.len()];
        for (id, all) in (0..).zip(&next) {
            for to in all {
                let of_target: &mut Vec<NodeId> = &mut previous[*to as usize];
                of_target.push(id);
            }
        }
        Self { next, previous }
    }

    /// How many ways there are.
    fn edges(&self) -> usize {
        self.next.iter().map(Vec::len).sum()
    }

    /// All nodes that tokens of these reach, these included.
    fn reached(&self, from: impl IntoIterator<Item = NodeId>) -> HashSet<NodeId> {
        walk(&self.next, from)
    }

    /// All nodes whose tokens reach these, these included.
    fn sources(&self, of: impl IntoIterator<Item = NodeId>) -> HashSet<NodeId> {
        walk(&self.previous, of)
    }
}

fn walk(ways: &[Vec<NodeId>], from: impl IntoIterator<Item = NodeId>) -> HashSet<NodeId> {
    let mut reached = HashSet::new();
    let mut waiting: Vec<NodeId> = from.into_iter().collect();
    while let Some(id) = waiting.pop() {
        if reached.insert(id) {
            waiting.extend(&ways[id as usize]);
        }
    }
    reached
}

/// Whether tokens leave a node later than they come.
fn delays(op: &Op) -> bool {
    match op {
        Op::Flow(flow) => match flow {
            Flow::Wait { .. } | Flow::Loop { .. } => true,
            Flow::Random { every_ms, .. } => every_ms.is_some(),
            Flow::Stop
            | Flow::Function { .. }
            | Flow::If(_)
            | Flow::Switch { .. }
            | Flow::Call(_)
            | Flow::InPort
            | Flow::OutPort(_)
            | Flow::Constant(_)
            | Flow::Variable { .. }
            | Flow::Filter { .. }
            | Flow::Replace(_)
            | Flow::Inhibit(_)
            | Flow::Zip
            | Flow::Unzip => false,
        },
        Op::Source(_) => true,
        Op::Act(_) => false,
    }
}

/// Blocks to which tokens can come back within the instant in which they left.
pub(crate) fn on_cycles(program: &Program) -> HashSet<NodeId> {
    let cycles = cycles(program, &Graph::new(program));
    cycles
        .into_iter()
        .flatten()
        .map(|id| id as NodeId)
        .collect()
}

/// Strongly connected components without a node that delays (Tarjan 1972, without recursion).
fn cycles(program: &Program, graph: &Graph) -> Vec<Vec<usize>> {
    const UNSEEN: u32 = u32::MAX;
    let count = program.nodes.len();
    let (mut order, mut low) = (vec![UNSEEN; count], vec![0u32; count]);
    let (mut stack, mut on_stack) = (Vec::new(), vec![false; count]);
    let mut clock = 0;
    let mut cycles = Vec::new();
    for root in 0..count {
        let mut calls: Vec<(usize, usize)> = Vec::new();
        if order[root] == UNSEEN && !delays(&program.nodes[root].op) {
            calls.push((root, 0));
        }
        while let Some((id, at)) = calls.pop() {
            if at == 0 {
                (order[id], low[id]) = (clock, clock);
                clock += 1;
                stack.push(id);
                on_stack[id] = true;
            }
            let next = graph.next[id].iter().enumerate().skip(at);
            let mut next = next.map(|(at, &to)| (at, to as usize));
            let open = next.find(|&(_, to)| {
                let is_open = order[to] == UNSEEN && !delays(&program.nodes[to].op);
                if on_stack[to] {
                    low[id] = low[id].min(order[to]);
                }
                is_open
            });
            if let Some((at, to)) = open {
                calls.push((id, at + 1));
                calls.push((to, 0));
                continue;
            }
            if let Some(&(parent, _)) = calls.last() {
                low[parent] = low[parent].min(low[id]);
            }
            if low[id] == order[id] {
                let begin = stack.iter().rposition(|&one| one == id).unwrap_or(0);
                let component = stack.split_off(begin);
                component.iter().for_each(|&one| on_stack[one] = false);
                let is_cycle = component.len() > 1 || graph.next[id].contains(&(id as NodeId));
                if is_cycle {
                    cycles.push(component);
                }
            }
        }
    }
    cycles
}

fn tell_cycle(program: &Program, mut component: Vec<usize>, found: &mut Found) {
    component.sort_unstable();
    let shown = component.iter().take(limits::NAMED_MAX);
    let names: Vec<String> = shown.map(|&id| program.nodes[id].label()).collect();
    let place = program.place(component[0] as NodeId);
    found.warn(place, words::cycle(&names, component.len()));
}

/// Blocks that nothing starts.
fn dead(program: &Program, graph: &Graph, found: &mut Found) {
    let Some(main) = program.instances.first() else {
        return;
    };
    let reached = graph.reached(main.starts.iter().map(|start| start.node));
    for id in 0..program.nodes.len() as NodeId {
        let node = program.node(id);
        let is_stop = matches!(node.op, Op::Flow(Flow::Stop));
        let is_silent = node.linked == 0 && node.row.control().is_none();
        let is_lonely = is_stop && node.linked == 0;
        if !reached.contains(&id) && !is_lonely {
            let words = match is_silent {
                true => words::no_input(),
                false => words::dead(),
            };
            found.warn(program.place(id), words);
        }
    }
}

/// Inputs of a loop that change its numbers, as bits: FROM, TO and STEP.
const LOOP_BOUNDS: u16 = 0b111;
/// Where the numbers of a loop leave it.
const LOOP_OUT: u8 = 5;

/// Whether a loop is over before its first number.
fn gives_none([first, last, step]: [i32; 3]) -> bool {
    step > 0 && first > last || step < 0 && first < last
}

/// What is strange about one block with its edges.
fn node(program: &Program, id: NodeId, found: &mut Found) {
    let node = program.node(id);
    let has_outputs = node.outs.iter().any(|targets| !targets.is_empty());
    let gives_values = node
        .row
        .ports
        .iter()
        .any(|port| port.way == Direction::Out && port.of.is_data());
    match &node.op {
        Op::Flow(Flow::Stop) if node.linked == 0 => {
            found.warn(program.place(id), words::stop_unlinked());
        }
        // Only parameters are connected: nothing starts it.
        Op::Flow(Flow::Loop { .. }) if node.linked != 0 && !node.is_linked(3) => {
            found.warn(program.place(id), words::dead());
        }
        // Nobody hears of the numbers, or there are none.
        Op::Flow(Flow::Loop { .. }) if node.outs[usize::from(LOOP_OUT)].is_empty() => {
            found.warn(port_place(program, id, LOOP_OUT), words::empty_loop());
        }
        Op::Flow(Flow::Loop { bounds, .. })
            if node.linked & LOOP_BOUNDS == 0 && gives_none(*bounds) =>
        {
            found.warn(program.place(id), words::no_numbers(*bounds));
        }
        Op::Flow(Flow::Wait { .. })
            if node.linked != 0 && !node.is_linked(0) && !node.is_linked(2) =>
        {
            found.warn(program.place(id), words::dead());
        }
        Op::Flow(Flow::Function { .. }) if node.data != 0 && node.is_linked(0) => {
            found.warn(port_place(program, id, 0), words::start_ignored());
        }
        Op::Flow(
            Flow::If(_) | Flow::Constant(_) | Flow::Zip | Flow::Unzip | Flow::Random { .. },
        )
        | Op::Act(Act::ReadPort(_))
        | Op::Source(Source::Sensor(_) | Source::Detect(_))
            if gives_values && !has_outputs =>
        {
            found.warn(program.place(id), words::unused());
        }
        Op::Source(Source::Encoders(devices)) => {
            for (at, (_, clears)) in (0..).zip(devices) {
                let is_taken = !node.outs[6 + usize::from(at)].is_empty();
                if is_taken && !clears && !node.is_linked(2 + at) {
                    found.warn(port_place(program, id, 6 + at), words::encoder_silent());
                }
            }
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => {}
    }
}

/// Who tells a port something: the node that a token comes from, or the block itself when it is started.
fn writers_of(program: &Program) -> BTreeMap<Port, Vec<(NodeId, Target)>> {
    let mut all: BTreeMap<Port, Vec<(NodeId, Target)>> = BTreeMap::new();
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

/// Motors that two parts of the program drive without anything that decides between them.
fn writers(program: &Program, graph: &Graph, found: &mut Found) {
    // Looking takes time with the size of the program; a large one is not looked at wholly.
    let most = limits::WRITER_WALKS_MAX / (program.nodes.len() + graph.edges()).max(1);
    let mut looked = 0;
    for (port, writers) in writers_of(program) {
        if port.sort() == Sort::Encoder {
            continue;
        }
        let mut pairs = 0;
        'port: for (at, &(one, first)) in writers.iter().enumerate() {
            for &(other, second) in &writers[at + 1..] {
                pairs += 1;
                looked += 4;
                if pairs > limits::WRITER_PAIRS_MAX || looked > most.max(4) {
                    break 'port;
                }
                if one != other && !is_separated(program, graph, (one, first), (other, second)) {
                    let names = [one, other].map(|id| program.node(id).label());
                    let place = program.place(first.node);
                    found.warn(place, words::two_writers(port.name(), &names));
                    break 'port;
                }
            }
        }
    }
}

/// Whether two writers follow each other, or a block decides which of them gets a token.
fn is_separated(
    program: &Program,
    graph: &Graph,
    one: (NodeId, Target),
    other: (NodeId, Target),
) -> bool {
    let follows = |from: (NodeId, Target), to: (NodeId, Target)| {
        graph.reached([from.0, from.1.node]).contains(&to.0)
    };
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
