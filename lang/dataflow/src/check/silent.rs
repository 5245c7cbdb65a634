//! Blocks and outputs that never do anything: rings that nothing starts, outputs that have nothing to give, and programs
//! that are over before motors turn.
//!
//! Owns that each of them is told once, at its cause: what only waits for something that is told already is not told.

use super::arrivals::{Arrivals, FED, given, ports};
use super::components;
use super::found::{Found, port_place};
use super::shape::delays;
use super::words;
use crate::blocks::Direction;
use crate::limits;
use crate::program::{Act, Flow, NodeId, Op, Program, Target};
use lang_diagram::ports::Sort;
use std::collections::HashMap;

pub(super) fn look(program: &Program, arrivals: &Arrivals, found: &mut Found) {
    for id in 0..program.nodes.len() as NodeId {
        without_input(program, id, found);
        without_start(program, id, found);
        outputs(program, arrivals, id, found);
    }
    rings(program, arrivals, found);
    // A program with errors does not even begin.
    if !found.has_failed {
        over_at_once(program, arrivals, found);
    }
}

/// What can come to a block if something comes to all that is connected.
fn all_that_comes(program: &Program, id: NodeId) -> u16 {
    let node = program.node(id);
    match &node.op {
        Op::Flow(Flow::InPort) => FED,
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => match node.linked {
            0 => node.row.control().map_or(0, |port| 1 << port),
            linked => linked,
        },
    }
}

/// Outputs that give nothing whatever comes to the block, as bits.
fn never_gives(program: &Program, arrivals: &Arrivals, id: NodeId) -> u16 {
    let given = match program.node(id).op {
        Op::Flow(Flow::Call(_)) => arrivals.has_out[id as usize],
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => given(program, id, all_that_comes(program, id)),
    };
    !given
}

/// A block that no edge leads to and that cannot begin by itself.
fn without_input(program: &Program, id: NodeId, found: &mut Found) {
    let node = program.node(id);
    let is_told = matches!(node.op, Op::Flow(Flow::Stop | Flow::InPort));
    if node.linked == 0 && node.row.control().is_none() && !is_told {
        found.warn(program.place(id), words::no_input());
    }
}

/// A block of which only parameters are connected.
fn without_start(program: &Program, id: NodeId, found: &mut Found) {
    let node = program.node(id);
    let is_told = match &node.op {
        // These give nothing at all, or their missing inputs are errors.
        Op::Flow(
            Flow::Stop | Flow::Call(_) | Flow::InPort | Flow::OutPort(_) | Flow::Zip | Flow::Unzip,
        ) => true,
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => false,
    };
    if is_told || node.linked == 0 || given(program, id, node.linked) != 0 {
        return;
    }
    let inputs = (0u8..).zip(node.row.ports);
    let inputs = inputs.filter(|(_, port)| port.way == Direction::In);
    let starts = inputs.filter(|(at, _)| given(program, id, 1 << at) != 0);
    let starts: Vec<&str> = starts.map(|(_, port)| port.name).collect();
    found.warn(program.place(id), words::only_parameters(&starts));
}

/// Outputs with edges that never give anything, for a reason of the block itself.
fn outputs(program: &Program, arrivals: &Arrivals, id: NodeId, found: &mut Found) {
    let node = program.node(id);
    if all_that_comes(program, id) == 0 {
        return;
    }
    let never = never_gives(program, arrivals, id);
    for (port, targets) in (0u8..).zip(&node.outs) {
        if targets.is_empty() || never & (1 << port) == 0 {
            continue;
        }
        let name = node.port_name(port);
        let number = port.saturating_sub(3);
        let words = match &node.op {
            Op::Flow(Flow::Function { texts, .. }) => match texts.get(usize::from(number / 2)) {
                Some(None) => words::empty_text(name, &format!("I{name}")),
                Some(Some(_)) => words::own_input(name, node.port_name(port - 1)),
                None => continue,
            },
            Op::Flow(Flow::Switch { .. }) => words::empty_text(name, &format!("cond{number}")),
            Op::Flow(Flow::Call(instance)) => {
                words::no_out_port(name, &program.instances[*instance as usize].name)
            }
            Op::Flow(Flow::Wait { .. }) if node.linked == 0 || node.is_linked(0) => {
                words::nothing_held()
            }
            // Told of as a whole, or where its flags are.
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => continue,
        };
        found.warn(port_place(program, id, port), words);
    }
}

/// What keeps all tokens from a block.
struct Blame {
    /// By node: nodes from which nothing comes. Behind the nodes stands one for each output of a call that leads somewhere,
    /// which waits for the output ports of its subprogram: else each edge would have all of them.
    on: Vec<Vec<NodeId>>,
    /// By node: whether it waits for something that is told elsewhere, or that nobody is sure of.
    is_told: Vec<bool>,
}

impl Blame {
    fn of(program: &Program, arrivals: &Arrivals) -> Self {
        let count = program.nodes.len();
        let mut all = Self {
            on: vec![Vec::new(); count],
            is_told: vec![false; count],
        };
        let leave = all.of_calls(program);
        for id in 0..count as NodeId {
            let never = never_gives(program, arrivals, id);
            let is_silent = all_that_comes(program, id) == 0;
            let is_call = matches!(program.node(id).op, Op::Flow(Flow::Call(_)));
            for (port, to) in program.edges(id) {
                let waits = to.node as usize;
                if arrivals.came[waits] & (1 << to.port) != 0 {
                    continue;
                }
                if is_silent || never & (1 << port) != 0 {
                    all.is_told[waits] = true;
                } else if is_call {
                    all.on[waits].extend(leave.get(&(id, port)));
                } else {
                    all.on[waits].push(id);
                }
            }
        }
        all.of_bodies(program, arrivals);
        all
    }

    /// Outputs of calls wait for the output ports of their subprograms; which node stands for each of them.
    fn of_calls(&mut self, program: &Program) -> HashMap<(NodeId, u8), NodeId> {
        let mut leave = HashMap::new();
        for (id, node) in (0..).zip(&program.nodes) {
            if let Op::Flow(Flow::OutPort(Some(Target { node: call, port }))) = node.op {
                let output = *leave.entry((call, port)).or_insert_with(|| {
                    self.on.push(Vec::new());
                    self.is_told.push(false);
                    self.on.len() as NodeId - 1
                });
                self.on[output as usize].push(id);
            }
        }
        leave
    }

    /// What a subprogram waits for comes from its call.
    fn of_bodies(&mut self, program: &Program, arrivals: &Arrivals) {
        for instance in &program.instances {
            let Some(caller) = instance.caller else {
                continue;
            };
            for start in &instance.starts {
                if arrivals.came[start.node as usize] == 0 {
                    self.on[start.node as usize].push(caller);
                }
            }
            for &(port, input) in &instance.inputs {
                if arrivals.came[input as usize] != 0 {
                    continue;
                }
                // A call may leave out an input that its subprogram can do without.
                match program.node(caller).is_linked(port) {
                    true => self.on[input as usize].push(caller),
                    false => self.is_told[input as usize] = true,
                }
            }
        }
    }
}

/// Rings of blocks that wait for each other, and for nothing else.
fn rings(program: &Program, arrivals: &Arrivals, found: &mut Found) {
    let blame = Blame::of(program, arrivals);
    let mut is_in = vec![false; blame.on.len()];
    for mut ring in components::cycles(&blame.on, |_| false) {
        ring.iter().for_each(|&id| is_in[id] = true);
        let is_cause = ring.iter().all(|&id| {
            let inside = blame.on[id].iter().all(|&on| is_in[on as usize]);
            inside && !blame.is_told[id]
        });
        ring.iter().for_each(|&id| is_in[id] = false);
        if is_cause {
            ring.retain(|&id| id < program.nodes.len());
            ring.sort_unstable();
            tell_ring(program, arrivals, &ring, found);
        }
    }
}

fn tell_ring(program: &Program, arrivals: &Arrivals, ring: &[usize], found: &mut Found) {
    let first = ring[0] as NodeId;
    let closes = ring.iter().flat_map(|&id| program.edges(id as NodeId));
    let mut closes = closes.map(|(_, to)| to).filter(|to| to.node == first);
    let closes = closes.find(|to| arrivals.came[ring[0]] & (1 << to.port) == 0);
    let shown = ring.iter().take(limits::NAMED_MAX);
    let names: Vec<String> = shown.map(|&id| program.nodes[id].label()).collect();
    let (place, port) = match closes {
        Some(to) => (
            port_place(program, first, to.port),
            program.node(first).port_name(to.port),
        ),
        None => (program.place(first), ""),
    };
    let is_awake = ring.iter().any(|&id| arrivals.came[id] != 0);
    let words = match is_awake {
        true => words::waiting_ring(port, &names, ring.len()),
        false => words::dead_ring(&names, ring.len()),
    };
    found.warn(place, words);
}

/// Motors in a program in which nothing ever takes time: it ends in the instant in which it begins.
fn over_at_once(program: &Program, arrivals: &Arrivals, found: &mut Found) {
    let takes_time = |id: usize| {
        let op = &program.nodes[id].op;
        let reads = matches!(op, Op::Act(Act::ReadFile { .. }));
        arrivals.came[id] != 0 && (delays(op) || reads)
    };
    if (0..program.nodes.len()).any(takes_time) {
        return;
    }
    let drives = |id: &NodeId| {
        let came = arrivals.came[*id as usize];
        let starts = program.node(*id).row.control();
        let is_started = starts.is_some_and(|port| came & (1 << port) != 0);
        match &program.node(*id).op {
            Op::Act(Act::Drive { devices, .. }) => {
                let is_told = ports(came).any(|port| Some(port) != starts);
                let mut motors = devices
                    .iter()
                    .filter(|(port, _)| port.sort() == Sort::Motor);
                motors.any(|(_, power)| is_told || is_started && *power != 0)
            }
            Op::Act(Act::WritePort { port, value }) => {
                port.sort() == Sort::Motor && came != 0 && !(is_started && *value == 0)
            }
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => false,
        }
    };
    if let Some(id) = (0..program.nodes.len() as NodeId).find(drives) {
        found.warn(program.place(id), words::over_at_once());
    }
}
