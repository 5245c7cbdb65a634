//! Edges with the types of what runs along them, and inputs without an edge.
//!
//! Owns what does not fit. Types are those of `types`.

use super::found::{Found, port_place};
use super::types::{Of, Types};
use super::words;
use crate::blocks::{Does, Kind, SYNCHRONIZED};
use crate::program::{Flow, NodeId, Op, Program, Target};
use lang_expr::Source;

/// Edges whose tokens their port cannot take, and inputs that a block needs and that have no edge.
pub(super) fn look(program: &Program, types: &Types, found: &mut Found) {
    for id in 0..program.nodes.len() as NodeId {
        for (port, to) in program.edges(id) {
            look_at_edge(
                program,
                types.outs[id as usize][usize::from(port)],
                to,
                found,
            );
        }
        look_at_inputs(program, id, found);
    }
}

fn look_at_edge(program: &Program, of: Of, to: Target, found: &mut Found) {
    let node = program.node(to.node);
    let Some(port) = node.row.ports.get(usize::from(to.port)) else {
        return;
    };
    let place = || port_place(program, to.node, to.port);
    let is_trigger = match node.row.does {
        Does::Stop
        | Does::If
        | Does::Switch
        | Does::Wait
        | Does::Inhibit
        | Does::Replace
        | Does::Call
        | Does::OutPort => true,
        Does::Function
        | Does::Loop
        | Does::InPort
        | Does::Value
        | Does::Variable
        | Does::Random
        | Does::Filter
        | Does::Zip
        | Does::Unzip
        | Does::WritePort
        | Does::ReadPort
        | Does::Sensor
        | Does::Motors
        | Does::Servos
        | Does::Encoders
        | Does::Led
        | Does::Gamepad
        | Does::Say
        | Does::Sound
        | Does::System
        | Does::Stream
        | Does::StartCamera
        | Does::Detect
        | Does::Send
        | Does::Receive
        | Does::WriteFile
        | Does::ReadFile
        | Does::RemoveFile
        | Does::Pen
        | Does::Paint
        | Does::Print
        | Does::Clear
        | Does::Smile
        | Does::Draw(_) => false,
    };
    if of == Of::Unit && port.of.is_data() && !is_trigger {
        found.warn(place(), words::unit_here(port.name));
    } else if (of, port.of) == (Of::Digits, Kind::Whole) {
        found.warn(place(), words::number_as_text());
    } else if !of.fits(port.of) {
        let wanted = match port.of {
            Kind::Unit | Kind::Any => words::A_VALUE,
            Kind::Truth => words::A_TRUTH,
            Kind::Whole => words::A_WHOLE,
            Kind::Text => words::A_TEXT,
            Kind::List | Kind::Items(_) => words::A_LIST,
        };
        let count = match port.of {
            Kind::Items(count) => Some(count),
            Kind::Unit | Kind::Any | Kind::Truth | Kind::Whole | Kind::Text | Kind::List => None,
        };
        found.error(place(), words::does_not_fit(of.words(), wanted, count));
    }
}

fn look_at_inputs(program: &Program, id: NodeId, found: &mut Found) {
    let node = program.node(id);
    let need = |found: &mut Found, port: u8| {
        if !node.is_linked(port) {
            found.error(port_place(program, id, port), words::unlinked());
        }
    };
    match &node.op {
        Op::Flow(Flow::Zip) => {
            need(found, 0);
            need(found, 2);
        }
        Op::Flow(Flow::Unzip) => need(found, 0),
        Op::Flow(Flow::Function { waits: true, texts }) => {
            for index in texts.iter().flatten() {
                let text = &program.formulas[*index as usize];
                let source = Source::new(&text.text, text.wanted);
                for name in source.names() {
                    if text.own.contains(&name)
                        && let Some(port) = node.row.port(name)
                        && !node.is_linked(port)
                    {
                        let place = program.property_place(id, text.property, None);
                        found.error(place, words::unlinked_name(name, SYNCHRONIZED));
                    }
                }
            }
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => {}
    }
}
