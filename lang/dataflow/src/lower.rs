//! A project to a program: instances of subprograms, targets of tokens, properties as values and expressions.
//!
//! Owns what is wrong with the project as far as blocks, ports and properties show it; `check` has what only types,
//! periods and cycles show. Knows no time.

mod properties;
mod unused;

use properties::port_of_call;
pub(crate) use properties::{DATA, INPUTS, chosen, color};

use crate::blocks::{self, CONTROL_OUT, Direction, Does, Kind, Row};
use crate::limits;
use crate::program::{
    Act, Flow, Gathers, Instance, Node, NodeId, Op, Program, Queue, Target, Text,
};
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project};
use crate::words;
use lang_expr::Kit;
use lang_text::problem::{Place, Problem, Words, keep};
use std::collections::{HashMap, VecDeque};
use std::rc::Rc;

/// A program, and what is wrong with it.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// Not to be run if one of the problems is an error.
    pub program: Program,
    /// What is wrong with blocks, ports and properties: as much as is kept of it.
    pub problems: Vec<Problem>,
    /// Whether one of the problems, kept or not, is an error.
    pub(crate) has_failed: bool,
}

impl Lowered {
    /// Whether it must not run.
    pub fn has_errors(&self) -> bool {
        self.has_failed
    }
}

/// Makes a project ready to run.
pub fn lower(project: &Project) -> Lowered {
    let mut lowering = Lowering::new(project);
    lowering.run();
    let Lowering {
        program,
        problems,
        has_failed,
        ..
    } = lowering;
    let mut lowered = Lowered {
        program,
        problems,
        has_failed,
    };
    if !lowered.has_failed {
        unused::look(project, &mut lowered);
    }
    lowered
}

struct Lowering<'a> {
    project: &'a Project,
    program: Program,
    problems: Vec<Problem>,
    /// Whether there was an error.
    has_failed: bool,
    edges: usize,
    /// Of all texts of properties.
    bytes: usize,
    /// Of each instance: the diagrams that it is called through, itself the last.
    chains: Vec<Vec<usize>>,
    called: HashMap<&'a str, usize>,
}

/// A block with what is needed to look around.
#[derive(Clone, Copy)]
struct At<'a> {
    diagram: &'a Diagram,
    block: &'a Block,
    row: &'static Row,
    node: NodeId,
}

impl At<'_> {
    fn place(&self) -> Place {
        place(self.diagram, self.block)
    }
}

/// What is wrong with a block that the language does not have.
fn unknown(block: &Block) -> Words {
    let element = block.element.as_str();
    match blocks::is_painter(element) {
        true => {
            let shape = block.properties.get(blocks::SHAPE);
            words::no_painter(element, shape.map(String::as_str))
        }
        false => words::unknown_element(element),
    }
}

fn place(diagram: &Diagram, block: &Block) -> Place {
    let shown = block.row.map_or(block.element.as_str(), |row| row.shown);
    Place {
        diagram: Some(diagram.name.clone()),
        object: Some(block.id.clone()),
        block: Some(crate::program::label(shown, &block.name)),
        ..Place::default()
    }
}

impl<'a> Lowering<'a> {
    fn new(project: &'a Project) -> Self {
        let kit = project.meta.get("lastKitId");
        Self {
            project,
            program: Program {
                kit: kit.and_then(|id| Kit::of_id(id)).unwrap_or_default(),
                ..Program::default()
            },
            problems: Vec::new(),
            has_failed: false,
            edges: 0,
            bytes: 0,
            chains: Vec::new(),
            called: project.by_logical(),
        }
    }

    fn run(&mut self) {
        let Some(main) = self.project.main else {
            self.error(Place::default(), words::no_main());
            return;
        };
        // All diagrams are looked at, also those that nobody calls.
        for diagram in &self.project.diagrams {
            self.look_at(diagram);
        }
        if self.has_failed {
            return;
        }
        let mut waiting = VecDeque::from([(main, None)]);
        while let Some((diagram, caller)) = waiting.pop_front() {
            if !self.instance(diagram, caller, &mut waiting) {
                return;
            }
        }
        self.connect_ports();
    }

    /// What is wrong with a diagram, from wherever it is called.
    fn look_at(&mut self, diagram: &'a Diagram) {
        for block in &diagram.blocks {
            let Some(row) = block.row else {
                self.error(place(diagram, block), unknown(block));
                continue;
            };
            let is_port = matches!(row.does, Does::InPort | Does::OutPort);
            if is_port && diagram.kind == DiagramKind::Main {
                self.error(place(diagram, block), words::port_in_main());
            }
            if row.does == Does::Call {
                self.look_at_call(diagram, block);
            }
        }
        let mut twins = std::collections::HashSet::new();
        for edge in &diagram.edges {
            let (Some(from), Some(to)) = (edge.from, edge.to) else {
                let words = match edge.gone {
                    Some((name, row)) => words::gone_port(name, row),
                    None => words::dangling(),
                };
                self.error(edge_place(diagram, edge), words);
                continue;
            };
            let ends = [(from, Direction::Out), (to, Direction::In)];
            let good = ends.map(|(end, way)| self.is_port(diagram, edge, end, way));
            let key = (from.block, from.port, to.block, to.port);
            if good == [true, true] && !twins.insert(key) {
                self.warn(edge_place(diagram, edge), words::twin_edge());
            }
        }
    }

    fn look_at_call(&mut self, diagram: &Diagram, block: &Block) {
        let called = block
            .calls
            .as_deref()
            .and_then(|id| self.called.get(id).copied());
        match called.map(|at| self.project.diagrams[at].kind) {
            Some(DiagramKind::Subprogram) => {}
            Some(DiagramKind::Main) => self.error(place(diagram, block), words::calls_main()),
            None => self.error(place(diagram, block), words::calls_nothing()),
        }
    }

    /// Whether an end of an edge is at a port that goes this way; says why not.
    fn is_port(&mut self, diagram: &Diagram, edge: &Edge, end: End, way: Direction) -> bool {
        let block = &diagram.blocks[end.block];
        let Some(row) = block.row else {
            return false;
        };
        let found = usize::try_from(end.port)
            .ok()
            .and_then(|at| row.ports.get(at));
        let words = match found {
            None => words::no_port(end.port, row.ports.len()),
            Some(port) if port.way != way => words::wrong_way(port.name, way),
            Some(_) => return true,
        };
        let mut place = place(diagram, block);
        place.object = Some(edge.id.clone());
        self.error(place, words);
        false
    }

    /// Adds the body of a call, or the main diagram; false if the program is too large.
    fn instance(
        &mut self,
        at: usize,
        caller: Option<NodeId>,
        waiting: &mut VecDeque<(usize, Option<NodeId>)>,
    ) -> bool {
        let diagram = &self.project.diagrams[at];
        let chain = match caller {
            None => Vec::new(),
            Some(node) => self.chains[self.program.node(node).instance as usize].clone(),
        };
        let too_large = if chain.contains(&at) {
            Some(words::recursion(&diagram.name))
        } else if chain.len() >= limits::DEPTH_MAX {
            Some(words::too_deep(limits::DEPTH_MAX))
        } else if self.program.instances.len() >= limits::INSTANCES_MAX {
            Some(words::too_many_instances(limits::INSTANCES_MAX))
        } else if self.program.nodes.len() + diagram.blocks.len() > limits::NODES_MAX
            || self.edges + diagram.edges.len() > limits::EDGES_MAX
        {
            Some(words::too_large(limits::NODES_MAX, limits::EDGES_MAX))
        } else {
            None
        };
        if let Some(words) = too_large {
            let place = caller
                .map(|node| self.program.place(node))
                .unwrap_or_default();
            self.error(place, words);
            return false;
        }
        self.edges += diagram.edges.len();
        let index = self.program.instances.len() as u32;
        let first = self.program.nodes.len() as NodeId;
        if let Some(caller) = caller {
            self.program.nodes[caller as usize].op = Flow::Call(index).into();
        }
        self.chains.push(chain.into_iter().chain([at]).collect());
        self.program.instances.push(Instance {
            name: diagram.name.as_str().into(),
            diagram: at as u32,
            caller,
            nodes: first..first + diagram.blocks.len() as NodeId,
            starts: Vec::new(),
            inputs: Vec::new(),
        });
        for block in &diagram.blocks {
            self.node(diagram, block, index, waiting);
        }
        let is_whole = self.bytes <= limits::TEXTS_BYTES_MAX;
        if is_whole {
            self.edges_of(diagram, index, first);
        }
        is_whole
    }

    fn node(
        &mut self,
        diagram: &'a Diagram,
        block: &'a Block,
        instance: u32,
        waiting: &mut VecDeque<(usize, Option<NodeId>)>,
    ) {
        let Some(row) = block.row else {
            return;
        };
        let node = self.program.nodes.len() as NodeId;
        let texts = block
            .properties
            .iter()
            .map(|(name, text)| name.len() + text.len());
        self.bytes += texts.sum::<usize>() + block.name.len() + block.id.len();
        if self.bytes > limits::TEXTS_BYTES_MAX {
            // Told once, and nothing more is read of it.
            if !self.has_failed {
                self.error(
                    place(diagram, block),
                    words::too_much_text(limits::TEXTS_BYTES_MAX),
                );
            }
            return;
        }
        let at = At {
            diagram,
            block,
            row,
            node,
        };
        let op = self.op(at);
        if let Op::Flow(Flow::Call(_)) = op
            && let Some(called) = block
                .calls
                .as_deref()
                .and_then(|id| self.called.get(id).copied())
        {
            waiting.push_back((called, Some(node)));
        }
        self.program.nodes.push(Node {
            row,
            op,
            id: block.id.as_str().into(),
            caption: block.name.as_str().into(),
            instance,
            done: None,
            outs: vec![Box::default(); row.ports.len()].into(),
            linked: 0,
            data: 0,
            queues: Box::default(),
        });
    }

    fn edges_of(&mut self, diagram: &'a Diagram, instance: u32, first: NodeId) {
        let mut outs: Vec<Vec<Vec<Target>>> = diagram
            .blocks
            .iter()
            .map(|block| vec![Vec::new(); block.row.map_or(0, |row| row.ports.len())])
            .collect();
        let mut queues: Vec<Vec<Option<Queue>>> =
            outs.iter().map(|ports| vec![None; ports.len()]).collect();
        for edge in &diagram.edges {
            let (Some(from), Some(to)) = (edge.from, edge.to) else {
                continue;
            };
            let port = to.port as u8;
            let node = first + to.block as NodeId;
            outs[from.block][from.port as usize].push(Target { node, port });
            self.program.nodes[node as usize].linked |= 1 << port;
            let place = &mut queues[to.block][usize::from(port)];
            let wanted = queue(edge);
            if instance_is_first(instance, &self.chains, &self.program)
                && place.is_some_and(|had| had != wanted)
            {
                let place = edge_place(diagram, edge);
                self.error(place, words::queues_differ());
            }
            *place = Some(wanted);
        }
        for (at, (outs, queues)) in outs.into_iter().zip(queues).enumerate() {
            let node = &mut self.program.nodes[first as usize + at];
            node.outs = outs.into_iter().map(Vec::into_boxed_slice).collect();
            let has_edge = |port: &u8| !node.outs[usize::from(*port)].is_empty();
            node.done = node.row.port(CONTROL_OUT).filter(has_edge);
            node.data = node.linked & data_ports(node.row);
            if node.waits() {
                let or_usual = |queue: Option<Queue>| queue.unwrap_or(USUAL);
                node.queues = queues.into_iter().map(or_usual).collect();
            }
        }
        if instance_is_first(instance, &self.chains, &self.program) {
            self.warn_of_idle_queues(diagram, first);
        }
        self.starts(instance, first);
    }

    /// Edges that say of a queue what has no effect: their port has none, or another number of places counts.
    fn warn_of_idle_queues(&mut self, diagram: &Diagram, first: NodeId) {
        for edge in &diagram.edges {
            let Some(to) = edge.to else {
                continue;
            };
            if edge.policy.is_none() && edge.capacity.is_none() {
                continue;
            }
            let node = self.program.node(first + to.block as NodeId);
            let has_queue = node.waits() && node.data & (1 << to.port) != 0;
            let places = edge.capacity.map(usize::from);
            let words = match places {
                _ if !has_queue => words::no_queue(node.port_name(to.port as u8)),
                Some(0) => words::other_capacity(0, 1),
                Some(places) if places > limits::QUEUE_MAX => {
                    words::other_capacity(places, limits::QUEUE_MAX)
                }
                Some(_) | None => continue,
            };
            self.warn(edge_place(diagram, edge), words);
        }
    }

    /// Blocks without incoming edges that a unit starts.
    fn starts(&mut self, instance: u32, first: NodeId) {
        let instance = &mut self.program.instances[instance as usize];
        for (at, node) in (first..).zip(&self.program.nodes[first as usize..]) {
            // Ports of a subprogram have no control input, so nothing starts them.
            if let (Some(port), 0) = (node.row.control(), node.linked) {
                instance.starts.push(Target { node: at, port });
            }
        }
    }

    /// Ports inside of instances meet the ports of their calls.
    fn connect_ports(&mut self) {
        for index in 0..self.program.instances.len() {
            let Instance { caller, nodes, .. } = self.program.instances[index].clone();
            let diagram = &self.project.diagrams[self.program.instances[index].diagram as usize];
            for (node, block) in nodes.zip(&diagram.blocks) {
                let Some(caller) = caller else {
                    break;
                };
                let call = self.program.node(caller).row;
                let Some(port) = port_of_call(block).and_then(|name| call.port(name)) else {
                    continue;
                };
                match &mut self.program.nodes[node as usize].op {
                    Op::Flow(Flow::InPort) => {
                        self.program.instances[index].inputs.push((port, node))
                    }
                    Op::Flow(Flow::OutPort(target)) => {
                        *target = Some(Target { node: caller, port })
                    }
                    Op::Flow(_) | Op::Source(_) | Op::Act(_) => {}
                }
            }
            self.warn_of_lost_inputs(index);
        }
    }

    /// Tokens that come to a call's port and go nowhere.
    fn warn_of_lost_inputs(&mut self, index: usize) {
        let instance = &self.program.instances[index];
        let Some(caller) = instance.caller else {
            return;
        };
        let node = self.program.node(caller);
        let lost: Vec<&str> = (0..node.row.ports.len() as u8)
            .filter(|&port| node.is_linked(port) && Some(port) != node.row.control())
            .filter(|port| instance.inputs.iter().all(|(one, _)| one != port))
            .map(|port| node.port_name(port))
            .collect();
        let name = instance.name.clone();
        for port in lost {
            let place = self.program.property_place(caller, port, None);
            self.warn(place, words::no_such_input(port, &name));
        }
    }

    fn error(&mut self, place: Place, words: Words) {
        self.has_failed = true;
        // There is always room for an error.
        self.problems.truncate(lang_text::limits::PROBLEMS_KEPT - 1);
        let problem = Problem::error(words);
        keep(&mut self.problems, Problem { place, ..problem });
    }

    fn warn(&mut self, place: Place, words: Words) {
        let problem = Problem::warning(words);
        keep(&mut self.problems, Problem { place, ..problem });
    }

    /// Keeps an expression of a node.
    fn formula(&mut self, text: Text) -> crate::program::Formula {
        self.program.formulas.push(text);
        self.program.formulas.len() as u32 - 1
    }
}

/// What a port has if no edge says anything.
const USUAL: Queue = Queue {
    policy: Policy::Fifo,
    capacity: limits::QUEUE_MAX as u16,
};

fn queue(edge: &Edge) -> Queue {
    let policy = edge.policy.unwrap_or_default();
    let places = match policy {
        Policy::Latest => 1,
        Policy::Fifo | Policy::Error => edge.capacity.unwrap_or(USUAL.capacity),
    };
    Queue {
        policy,
        capacity: places.clamp(1, USUAL.capacity),
    }
}

/// Whether no instance before this one is of the same diagram: what is wrong with that is told once.
fn instance_is_first(instance: u32, chains: &[Vec<usize>], program: &Program) -> bool {
    let of = |index: usize| program.instances[index].diagram;
    let index = instance as usize;
    debug_assert!(index < chains.len(), "each instance has a chain");
    (0..index).all(|other| of(other) != of(index))
}

fn edge_place(diagram: &Diagram, edge: &Edge) -> Place {
    let end = |end: Option<End>| {
        let block = end.map(|end| &diagram.blocks[end.block]);
        block.map_or_else(
            || "?".to_owned(),
            |block| {
                let shown = block.row.map_or(block.element.as_str(), |row| row.shown);
                crate::program::label(shown, &block.name)
            },
        )
    };
    Place {
        diagram: Some(diagram.name.clone()),
        object: Some(edge.id.clone()),
        block: Some(format!("{} -> {}", end(edge.from), end(edge.to))),
        ..Place::default()
    }
}

impl Node {
    /// Whether it fires only when all its linked data inputs have tokens.
    pub fn waits(&self) -> bool {
        self.gathers().is_some()
    }

    /// What it does when all its linked data inputs have tokens; none: it reacts to each token by itself.
    pub fn gathers(&self) -> Option<Gathers<'_>> {
        match &self.op {
            Op::Flow(flow) => match flow {
                Flow::Function { waits, texts } => {
                    (*waits && self.data != 0).then_some(Gathers::Function(texts))
                }
                Flow::Zip => Some(Gathers::Zip),
                Flow::Stop
                | Flow::If(_)
                | Flow::Switch { .. }
                | Flow::Loop { .. }
                | Flow::Call(_)
                | Flow::InPort
                | Flow::OutPort(_)
                | Flow::Constant(_)
                | Flow::Variable { .. }
                | Flow::Random { .. }
                | Flow::Filter { .. }
                | Flow::Wait { .. }
                | Flow::Replace(_)
                | Flow::Inhibit(_)
                | Flow::Unzip => None,
            },
            Op::Source(_) => None,
            Op::Act(act) => match act {
                Act::Drive { waits, devices } => {
                    (*waits && self.data != 0).then_some(Gathers::Drive(devices))
                }
                Act::WritePort { .. }
                | Act::ReadPort(_)
                | Act::Led(_)
                | Act::Say(_)
                | Act::Sound(_)
                | Act::System { .. }
                | Act::Stream
                | Act::StartCamera(_)
                | Act::Send { .. }
                | Act::WriteFile { .. }
                | Act::ReadFile { .. }
                | Act::RemoveFile(_)
                | Act::Pen { .. }
                | Act::Paint { .. }
                | Act::Print { .. }
                | Act::Clear
                | Act::Smile(_)
                | Act::Draw { .. } => None,
            },
        }
    }
}

/// Inputs that carry values, as bits by the number of the port.
fn data_ports(row: &Row) -> u16 {
    let ports = row.ports.iter().enumerate();
    let data = ports.filter(|(_, port)| port.way == Direction::In && port.of != Kind::Unit);
    data.fold(0, |bits, (at, _)| bits | 1 << at)
}

/// Shared texts.
pub(crate) fn shared(text: &str) -> Rc<str> {
    text.into()
}
