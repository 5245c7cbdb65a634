//! Which ports a token can ever come to, from the starts on along the edges.
//!
//! Owns what each block gives for what comes to it, as far as its edges and texts show it. Whatever a condition decides is
//! taken as possible, so a port that no token comes to here gets none when the program runs.

use crate::blocks::{Direction, Row};
use crate::program::{Act, Flow, NodeId, Op, Program, Source, Target};

/// What stands for the tokens that come to an input port of a subprogram by its call; no block has so many ports.
pub(super) const FED: u16 = 1 << 15;

/// Which ports tokens may come to.
pub(super) struct Arrivals {
    /// By node: inputs, as bits by the number of the port.
    pub(super) came: Vec<u16>,
    /// By node: outputs, likewise.
    pub(super) gives: Vec<u16>,
    /// By node: outputs of calls that their subprograms have.
    pub(super) has_out: Vec<u16>,
    waiting: Vec<NodeId>,
}

/// Ports as bits, one after the other.
pub(super) fn ports(bits: u16) -> impl Iterator<Item = u8> {
    (0..16).filter(move |port| bits & (1 << port) != 0)
}

impl Arrivals {
    /// Those of a program from its starts on.
    pub(super) fn of(program: &Program) -> Self {
        let count = program.nodes.len();
        let mut all = Self {
            came: vec![0; count],
            gives: vec![0; count],
            has_out: vec![0; count],
            waiting: Vec::new(),
        };
        for node in &program.nodes {
            if let Op::Flow(Flow::OutPort(Some(Target { node: call, port }))) = node.op {
                all.has_out[call as usize] |= 1 << port;
            }
        }
        if let Some(main) = program.instances.first() {
            for start in &main.starts {
                all.arrive(start.node, 1 << start.port);
            }
        }
        while let Some(id) = all.waiting.pop() {
            all.react(program, id);
        }
        all
    }

    fn arrive(&mut self, id: NodeId, bit: u16) {
        let came = &mut self.came[id as usize];
        if *came & bit == 0 {
            *came |= bit;
            self.waiting.push(id);
        }
    }

    fn react(&mut self, program: &Program, id: NodeId) {
        let came = self.came[id as usize];
        self.give(program, id, given(program, id, came));
        match program.node(id).op {
            Op::Flow(Flow::Call(instance)) => {
                let body = &program.instances[instance as usize];
                for start in &body.starts {
                    self.arrive(start.node, 1 << start.port);
                }
                for &(port, input) in &body.inputs {
                    if came & (1 << port) != 0 {
                        self.arrive(input, FED);
                    }
                }
            }
            Op::Flow(Flow::OutPort(Some(Target { node, port }))) => {
                self.give(program, node, 1 << port);
            }
            Op::Flow(_) | Op::Source(_) | Op::Act(_) => {}
        }
    }

    fn give(&mut self, program: &Program, id: NodeId, bits: u16) {
        let new = bits & !self.gives[id as usize];
        self.gives[id as usize] |= new;
        for port in ports(new) {
            let targets = program.node(id).outs.get(usize::from(port));
            for to in targets.into_iter().flatten() {
                self.arrive(to.node, 1 << to.port);
            }
        }
    }
}

/// Which outputs may give a token if tokens come to these inputs; what leaves a call comes from its body.
pub(super) fn given(program: &Program, id: NodeId, came: u16) -> u16 {
    if came == 0 {
        return 0;
    }
    let node = program.node(id);
    let has = |port: u8| came & (1 << port) != 0;
    let is_started = node.row.control().is_some_and(has);
    let is_whole = came & node.data == node.data;
    let if_so = |holds: bool| if holds { outputs(node.row) } else { 0 };
    match &node.op {
        Op::Flow(flow) => match flow {
            Flow::Stop | Flow::Call(_) | Flow::OutPort(_) => 0,
            Flow::Function { .. } => function(program, id, came),
            Flow::If(_) | Flow::Variable { .. } => if_so(has(0) || has(1)),
            Flow::Switch { arms, .. } => {
                let conditions = (3..).zip(arms).filter(|(_, arm)| arm.0.is_some());
                let all = conditions.fold(1 << 1, |bits, (port, _)| bits | 1 << port);
                if has(0) || has(2) { all } else { 0 }
            }
            Flow::Loop { .. } | Flow::Constant(_) | Flow::Random { .. } => if_so(is_started),
            Flow::InPort => if_so(came & FED != 0),
            // DISPATCH_TIME, FAILURE, COUNT, OUT, DATA.
            Flow::Filter { .. } => if_so(has(4)),
            // CF_IN, CF_OUT, DATA, OUT, TIME.
            Flow::Wait { .. } if has(2) => outputs(node.row),
            Flow::Wait { .. } => u16::from(has(0)) << 1,
            Flow::Replace(_) => if_so(has(0) || has(1)),
            Flow::Inhibit(_) => if_so(has(1)),
            Flow::Zip => if_so(has(0) && has(2)),
            Flow::Unzip => if_so(has(0)),
        },
        Op::Source(source) => match source {
            Source::Sensor(_) | Source::Detect(_) | Source::Gamepad | Source::Receive => {
                if_so(is_started)
            }
            Source::Encoders(devices) => {
                let speaks = (2u8..)
                    .zip(devices)
                    .filter(|&(port, (_, clears))| has(port) || has(0) && *clears);
                speaks.fold(1 << 1, |bits, (port, _)| bits | 1 << (port + 4))
            }
        },
        Op::Act(act) => match act {
            Act::Drive { waits: true, .. } if node.data != 0 => if_so(is_started || is_whole),
            // A text and a number that come are only kept.
            Act::Print { .. } | Act::Send { .. } => if_so(came & !(1 << 3) != 0),
            Act::WritePort { .. }
            | Act::ReadPort(_)
            | Act::Drive { .. }
            | Act::Led(_)
            | Act::Say(_)
            | Act::Sound(_)
            | Act::System { .. }
            | Act::Stream
            | Act::StartCamera(_)
            | Act::WriteFile { .. }
            | Act::ReadFile { .. }
            | Act::RemoveFile(_)
            | Act::Pen { .. }
            | Act::Paint { .. }
            | Act::Clear
            | Act::Smile(_)
            | Act::Draw { .. } => outputs(node.row),
        },
    }
}

/// All outputs of a block, as bits.
fn outputs(row: &Row) -> u16 {
    let ports = (0..).zip(row.ports);
    let all = ports.filter(|(_, port)| port.way == Direction::Out);
    all.fold(0, |bits, (at, _)| bits | 1 << at)
}

/// What a function may give: of one with inputs, a text answers to all of them together or to its own.
fn function(program: &Program, id: NodeId, came: u16) -> u16 {
    let node = program.node(id);
    let Op::Flow(Flow::Function { waits, texts }) = &node.op else {
        return 0;
    };
    let has = |port: u8| came & (1 << port) != 0;
    let answers = |input: u8| match (node.data, waits) {
        (0, _) => has(0),
        (data, true) => came & data == data,
        (_, false) => has(input),
    };
    let mut bits = 0;
    for (input, text) in (2..).step_by(2).zip(texts) {
        if answers(input) {
            bits |= 1 << 1;
            if text.is_some() {
                bits |= 1 << (input + 1);
            }
        }
    }
    bits
}
