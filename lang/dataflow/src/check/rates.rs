//! How often tokens come: periods of sources, handed on, and what waits for streams of different ones.
//!
//! Owns the inference of periods. What is not known is not told.

use super::found::{Found, port_place, property_place};
use super::words;
use crate::limits;
use crate::machine::POLL_MS;
use crate::program::{Act, Flow, NodeId, Op, Program, Source, Target};
use lang_diagram::machine::STEP_MS;
use std::collections::HashMap;

/// How often tokens come to a port.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Rate {
    /// None, as far as it is known yet.
    #[default]
    Never,
    /// Once, or in one burst.
    Once,
    /// One in each period, in milliseconds.
    Every(u32),
    /// At most one in each period.
    AtMost(u32),
    /// When somebody outside does something, or nobody knows.
    Sporadic,
}

impl Rate {
    fn join(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, one) | (one, Self::Never) => one,
            (one, other) if one == other => one,
            (Self::Every(one) | Self::AtMost(one), Self::Every(other) | Self::AtMost(other))
                if one == other =>
            {
                Self::AtMost(one)
            }
            (Self::Once | Self::Every(_) | Self::AtMost(_) | Self::Sporadic, _) => Self::Sporadic,
        }
    }

    /// What is left if some tokens do not go on.
    fn thinned(self) -> Self {
        match self {
            Self::Every(period) => Self::AtMost(period),
            Self::Never | Self::Once | Self::AtMost(_) | Self::Sporadic => self,
        }
    }

    fn period(self) -> Option<u32> {
        match self {
            Self::Every(period) | Self::AtMost(period) => Some(period),
            Self::Never | Self::Once | Self::Sporadic => None,
        }
    }
}

type Rates = HashMap<(NodeId, u8), Rate>;

/// The input of a wait whose tokens go on.
const WAIT_DATA: u8 = 2;

pub(super) fn look(program: &Program, found: &mut Found) {
    let rates = infer(program);
    let may_end = after_loops(program);
    for id in 0..program.nodes.len() as NodeId {
        let node = program.node(id);
        if node.waits() {
            look_at_join(program, id, &rates, found);
        }
        look_at_time(program, id, (&rates, may_end[id as usize]), found);
    }
}

/// A wait or a window whose time is none, or too short; `may_end`: what comes to it may end soon. A time that a token brings is
/// not known.
fn look_at_time(
    program: &Program,
    id: NodeId,
    (rates, may_end): (&Rates, bool),
    found: &mut Found,
) {
    let node = program.node(id);
    let time = node.row.port("TIME");
    if time.is_some_and(|port| node.is_linked(port)) {
        return;
    }
    if let Op::Flow(Flow::Wait { ms, keeps }) = node.op {
        let takes = in_steps(u32::try_from(ms).unwrap_or(0));
        let came = rates.get(&(id, WAIT_DATA)).copied().unwrap_or_default();
        if ms <= 0 {
            let place = property_place(program, id, "time");
            found.warn(place, words::no_wait(ms, STEP_MS));
        } else if let Rate::Every(period) = came
            && keeps
            && period < takes
            && !may_end
        {
            let place = port_place(program, id, WAIT_DATA);
            found.warn(place, words::wait_falls_behind(period, takes));
        }
    }
    if let Op::Flow(Flow::Replace(ms) | Flow::Inhibit(ms)) = node.op {
        let trigger = rates.get(&(id, 0)).copied().unwrap_or_default();
        if ms <= 0 {
            let place = property_place(program, id, "time");
            found.warn(place, words::no_window(ms));
        } else if let Some(period) = trigger.period()
            && i64::from(ms) < i64::from(period)
        {
            found.warn(program.place(id), words::short_window(ms, period));
        }
    }
}

/// By node: whether a loop, which ends, has a part in what comes to it; what comes through a call is not known and may.
fn after_loops(program: &Program) -> Vec<bool> {
    let mut is_after = vec![false; program.nodes.len()];
    let gives = |id: &NodeId| {
        let op = &program.node(*id).op;
        matches!(
            op,
            Op::Flow(Flow::Loop { .. } | Flow::InPort | Flow::Call(_))
        )
    };
    let mut to_see: Vec<NodeId> = (0..program.nodes.len() as NodeId).filter(gives).collect();
    while let Some(from) = to_see.pop() {
        for (_, to) in program.edges(from) {
            if !std::mem::replace(&mut is_after[to.node as usize], true) {
                to_see.push(to.node);
            }
        }
    }
    is_after
}

/// A block that waits for streams of which one has more tokens than another.
fn look_at_join(program: &Program, id: NodeId, rates: &Rates, found: &mut Found) {
    let node = program.node(id);
    let ports = (0..16u8).filter(|port| node.data & (1 << port) != 0);
    let all: Vec<(u8, Rate)> = ports
        .map(|port| (port, rates.get(&(id, port)).copied().unwrap_or_default()))
        .collect();
    let keeps_newest = |port: u8| node.queues[usize::from(port)].capacity == 1;
    for &(fast, one) in &all {
        for &(slow, other) in &all {
            let is_faster = match (one, other) {
                (Rate::Every(one), Rate::Every(other)) => one < other,
                (Rate::Every(_) | Rate::AtMost(_), Rate::Once) => true,
                (Rate::Every(one), Rate::AtMost(other)) => one <= other,
                _ => false,
            };
            if is_faster && !keeps_newest(fast) {
                let names = [fast, slow].map(|port| node.port_name(port));
                found.warn(port_place(program, id, fast), words::rates_differ(names));
                return;
            }
        }
    }
}

/// How often tokens come to each input.
fn infer(program: &Program) -> Rates {
    let mut ins = Rates::new();
    let mut outs = Rates::new();
    for instance in program.instances.iter().take(1) {
        for start in &instance.starts {
            ins.insert((start.node, start.port), Rate::Once);
        }
    }
    for _ in 0..limits::PASSES_MAX {
        let before = outs.clone();
        for id in 0..program.nodes.len() as NodeId {
            give(program, id, &ins, &mut outs);
            for (port, to) in program.edges(id) {
                let rate = outs.get(&(id, port)).copied().unwrap_or_default();
                let came = ins.entry((to.node, to.port)).or_default();
                *came = came.join(rate);
            }
        }
        through_calls(program, &mut ins, &mut outs);
        if before == outs {
            break;
        }
    }
    ins
}

fn through_calls(program: &Program, ins: &mut Rates, outs: &mut Rates) {
    for instance in &program.instances {
        let Some(caller) = instance.caller else {
            continue;
        };
        for &(port, input) in &instance.inputs {
            let rate = ins.get(&(caller, port)).copied().unwrap_or_default();
            let out = outs.entry((input, 0)).or_default();
            *out = out.join(rate);
        }
        for start in &instance.starts {
            ins.insert((start.node, start.port), Rate::Once);
        }
    }
}

/// How often the outputs of a node give.
fn give(program: &Program, id: NodeId, ins: &Rates, outs: &mut Rates) {
    let node = program.node(id);
    let came = |port: u8| ins.get(&(id, port)).copied().unwrap_or_default();
    let all = (0..node.row.ports.len() as u8).fold(Rate::Never, |all, port| all.join(came(port)));
    let waits = node.waits();
    let slowest = (0..16u8)
        .filter(|port| node.data & (1 << port) != 0)
        .map(came)
        .filter(|rate| *rate != Rate::Never)
        .reduce(|one, other| if one == other { one } else { Rate::Sporadic });
    let rate = match &node.op {
        Op::Flow(flow) => match flow {
            Flow::If(_) | Flow::Switch { .. } | Flow::Filter { .. } => all.thinned(),
            Flow::Inhibit(_) => came(1).thinned(),
            Flow::Replace(_) => came(0).join(came(1)).thinned(),
            Flow::Loop { time_ms, .. } => Rate::Every(in_steps(*time_ms)),
            Flow::Random { every_ms, .. } => {
                every_ms.map_or(all, |every| Rate::Every(in_steps(every)))
            }
            Flow::Wait { .. } => all.thinned(),
            Flow::Function { .. } | Flow::Zip if waits => slowest.unwrap_or_default(),
            Flow::Function { .. } | Flow::Constant(_) | Flow::Variable { .. } => all,
            Flow::Unzip | Flow::Zip => all,
            // What a call gives comes from its body; what an input port gives, from its call.
            Flow::OutPort(Some(Target { node, port })) => {
                let out = outs.entry((*node, *port)).or_default();
                *out = out.join(came(0));
                return;
            }
            Flow::Call(_) | Flow::InPort | Flow::OutPort(None) | Flow::Stop => return,
        },
        Op::Source(source) => match source {
            Source::Sensor(_) | Source::Detect(_) | Source::Encoders(_) => Rate::Every(POLL_MS),
            Source::Gamepad | Source::Receive => Rate::Sporadic,
        },
        Op::Act(Act::ReadFile { .. }) => Rate::Once,
        Op::Act(_) => all,
    };
    for port in 0..node.row.ports.len() as u8 {
        outs.insert((id, port), rate);
    }
}

/// A period as timers keep it.
fn in_steps(ms: u32) -> u32 {
    ms.max(1).div_ceil(STEP_MS).saturating_mul(STEP_MS)
}
