//! Ways of tokens: cycles and outputs that nobody takes, and numbers of a block that do not mean what they say.
//!
//! Owns the graph. What nothing starts is in `silent`, motors with two masters are in `writers`.

use super::arrivals::Arrivals;
use super::components;
use super::constants;
use super::found::{Found, port_place, property_place};
use super::instant;
use super::words;
use super::writers;
use crate::blocks::Direction;
use crate::limits;
use crate::program::{Act, Flow, NodeId, Op, Program, Source, Target};
use lang_diagram::ports::Port;
use std::collections::{HashMap, HashSet};

pub(super) fn look(program: &Program, arrivals: &Arrivals, found: &mut Found) {
    let graph = Graph::new(program);
    let cycles = cycles(program, &graph);
    if cycles.is_empty() {
        instant::look(program, found);
    }
    for cycle in cycles {
        // Others never begin, which is told as that.
        if cycle.iter().any(|&id| arrivals.came[id] != 0) {
            tell_cycle(program, cycle, found);
        }
    }
    for id in 0..program.nodes.len() as NodeId {
        node(program, id, found);
        numbers(program, arrivals.came[id as usize], id, found);
    }
    writers::look(program, &graph, found);
}

/// Where tokens go from node to node, through calls as well.
pub(super) struct Graph {
    /// Behind the nodes stands one for each output of a call that a body has, from which the edges of the call go on: else
    /// each output port of the body would have all of them.
    next: Vec<Vec<NodeId>>,
    previous: Vec<Vec<NodeId>>,
    /// How many nodes the program has.
    count: usize,
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
        let mut outputs: HashMap<(NodeId, u8), NodeId> = HashMap::new();
        for (id, node) in (0usize..).zip(&program.nodes) {
            if let Op::Flow(Flow::OutPort(Some(Target { node: call, port }))) = node.op {
                let output = *outputs.entry((call, port)).or_insert_with(|| {
                    let out = program.node(call).outs.get(usize::from(port));
                    next.push(out.into_iter().flatten().map(|to| to.node).collect());
                    next.len() as NodeId - 1
                });
                next[id].push(output);
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
        Self {
            next,
            previous,
            count: program.nodes.len(),
        }
    }

    /// How many ways there are.
    pub(super) fn edges(&self) -> usize {
        self.next.iter().map(Vec::len).sum()
    }

    /// All nodes that tokens of these reach, these included.
    pub(super) fn reached(&self, from: impl IntoIterator<Item = NodeId>) -> HashSet<NodeId> {
        self.walk(&self.next, from, |_| true)
    }

    /// The same, but beyond a node only if `passes` holds for it.
    pub(super) fn reached_through(
        &self,
        from: impl IntoIterator<Item = NodeId>,
        passes: impl Fn(NodeId) -> bool,
    ) -> HashSet<NodeId> {
        self.walk(&self.next, from, passes)
    }

    /// All nodes whose tokens reach these, these included.
    pub(super) fn sources(&self, of: impl IntoIterator<Item = NodeId>) -> HashSet<NodeId> {
        self.walk(&self.previous, of, |_| true)
    }

    /// Whether it is a node of the program, and not an output of a call.
    fn is_node(&self, id: NodeId) -> bool {
        (id as usize) < self.count
    }

    fn walk(
        &self,
        ways: &[Vec<NodeId>],
        from: impl IntoIterator<Item = NodeId>,
        passes: impl Fn(NodeId) -> bool,
    ) -> HashSet<NodeId> {
        let mut reached = HashSet::new();
        let mut waiting: Vec<NodeId> = from.into_iter().collect();
        while let Some(id) = waiting.pop() {
            if reached.insert(id) && (!self.is_node(id) || passes(id)) {
                waiting.extend(&ways[id as usize]);
            }
        }
        reached.retain(|&id| self.is_node(id));
        reached
    }
}

/// Whether tokens leave a node later than they come.
pub(super) fn delays(op: &Op) -> bool {
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
    let blocks = cycles.into_iter().flatten();
    blocks.map(|id| id as NodeId).collect()
}

/// Cycles without a node that delays.
fn cycles(program: &Program, graph: &Graph) -> Vec<Vec<usize>> {
    let delays = |id: usize| program.nodes.get(id).is_some_and(|node| delays(&node.op));
    let mut cycles = components::cycles(&graph.next, delays);
    for cycle in &mut cycles {
        cycle.retain(|&id| id < graph.count);
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
        // Only parameters are connected: nothing starts it, which is told as that.
        Op::Flow(Flow::Loop { .. }) if node.linked != 0 && !node.is_linked(3) => {}
        // Nobody hears of the numbers, or there are none.
        Op::Flow(Flow::Loop { .. }) if node.outs[usize::from(LOOP_OUT)].is_empty() => {
            found.warn(port_place(program, id, LOOP_OUT), words::empty_loop());
        }
        Op::Flow(Flow::Loop { bounds, .. })
            if node.linked & LOOP_BOUNDS == 0 && gives_none(*bounds) =>
        {
            found.warn(program.place(id), words::no_numbers(*bounds));
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

/// Numbers that stand in properties and mean something else: powers that no motor has, borders in the wrong order.
fn numbers(program: &Program, came: u16, id: NodeId, found: &mut Found) {
    let mut powers: Vec<(String, (Port, i32))> = Vec::new();
    let starts = program.node(id).row.control();
    // Without a start they do not count.
    if starts.is_none_or(|port| came & (1 << port) == 0) {
        return;
    }
    match &program.node(id).op {
        Op::Act(Act::Drive { devices, .. }) => {
            let named = |told: &(Port, i32)| (format!("{}Power", told.0.name()), *told);
            powers.extend(devices.iter().map(named));
        }
        Op::Act(Act::WritePort { port, value }) => {
            powers.push(("portImpulse".to_owned(), (*port, *value)));
        }
        Op::Flow(Flow::Random { bounds, .. }) => {
            let number = |at: usize| {
                let text = &program.formulas[bounds[at] as usize].text;
                text.trim().parse::<i32>().ok()
            };
            if let (Some(from), Some(to)) = (number(0), number(1))
                && from > to
            {
                let place = property_place(program, id, "toNumber");
                found.warn(place, words::borders_swapped(from, to));
            }
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => {}
    }
    for (name, (port, power)) in powers {
        if let Some(counts) = constants::counts_as(port, power) {
            let place = property_place(program, id, &name);
            found.warn(place, words::too_much_power(power, counts));
        }
    }
}
