//! Edges with the types of what runs along them, and inputs without an edge.
//!
//! Owns what does not fit. Types are those of `types`.

use super::constants;
use super::found::{Found, port_place};
use super::through::{Emitted, Through};
use super::types::{Of, Types};
use super::units::{Units, assigned_last};
use super::words;
use crate::blocks::{BACKGROUNDS, COLORS, Does, Kind, LED_COLORS, Row, SYNCHRONIZED};
use crate::lower::{DATA, chosen};
use crate::program::{Flow, Formula, NodeId, Op, Program, Target};
use lang_expr::tree::Node as Part;
use lang_expr::{Source, Value};
use lang_text::problem::Words;
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Edges whose tokens their port cannot take, and inputs that a block needs and that have no edge.
pub(super) fn look(program: &Program, types: &Types, found: &mut Found) {
    let mut texts = Texts::of(program);
    let through = Through::of(program, &types.outs);
    for id in 0..program.nodes.len() as NodeId {
        for (port, to) in program.edges(id) {
            let of = types.outs[id as usize][usize::from(port)];
            for made in through.made(Target { node: id, port }, of) {
                look_at_edge(made, to, &mut texts, found);
                look_at_word(made, to, &mut texts, found);
                constants::look(program, made, to, found);
            }
        }
        look_at_inputs(program, id, found);
    }
}

/// What is read of texts, each once, however many edges are there.
struct Texts<'a> {
    program: &'a Program,
    units: Units,
    /// Texts whose assignments are told.
    told: HashSet<Formula>,
    /// Whether a block that sends tokens on looks into them before.
    reads: HashMap<NodeId, bool>,
    /// Texts that outputs always give.
    constants: HashMap<(NodeId, u8), Option<Rc<str>>>,
}

fn look_at_edge(made: Emitted, to: Target, texts: &mut Texts<'_>, found: &mut Found) {
    let Emitted { of, by } = made;
    let program = texts.program;
    let node = program.node(to.node);
    let Some(port) = node.row.ports.get(usize::from(to.port)) else {
        return;
    };
    let place = || port_place(program, to.node, to.port);
    let is_unit = of == Of::Unit && port.of.is_data();
    if is_unit && (!is_trigger(node.row.does) || texts.reads_token(to)) {
        match texts.units.text(by.node, by.port) {
            Some(formula) => texts.tell_assignment(formula, port.name, found),
            None => found.warn(place(), words::unit_here(port.name)),
        }
    } else if (of, port.of) == (Of::Digits, Kind::Whole) {
        found.warn(place(), words::number_as_text());
    } else if !of.fits(port.of) {
        found.error(place(), misfit(of, port.of));
    }
}

/// What is wrong with a token of this type at a port of this kind.
pub(super) fn misfit(of: Of, kind: Kind) -> Words {
    let wanted = match kind {
        Kind::Unit | Kind::Any => words::A_VALUE,
        Kind::Truth => words::A_TRUTH,
        Kind::Whole => words::A_WHOLE,
        Kind::Text => words::A_TEXT,
        Kind::List | Kind::Items(_) => words::A_LIST,
    };
    let count = match kind {
        Kind::Items(count) => Some(count),
        Kind::Unit | Kind::Any | Kind::Truth | Kind::Whole | Kind::Text | Kind::List => None,
    };
    words::does_not_fit(of.words(), wanted, count)
}

/// Whether a block takes a token without a value as well as any other, or hands it on.
fn is_trigger(does: Does) -> bool {
    match does {
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
    }
}

impl<'a> Texts<'a> {
    fn of(program: &'a Program) -> Self {
        Self {
            program,
            units: Units::of(program),
            told: HashSet::new(),
            reads: HashMap::new(),
            constants: HashMap::new(),
        }
    }

    /// Whether a block that sends tokens on looks into those of this port before.
    fn reads_token(&mut self, to: Target) -> bool {
        let program = self.program;
        if program.node(to.node).row.port("DATA") != Some(to.port) {
            return false;
        }
        let reads = self.reads.entry(to.node);
        *reads.or_insert_with(|| reads_token(program, to.node))
    }

    /// Tells the text whose last statement gives a variable a value, and so none to its output.
    fn tell_assignment(&mut self, formula: Formula, port: &str, found: &mut Found) {
        if !self.told.insert(formula) {
            return;
        }
        let text = &self.program.formulas[formula as usize];
        let source = Source::new(&text.text, text.wanted);
        let Some(target) = assigned_last(&source) else {
            return;
        };
        let tree = source.tree();
        let mut name = None;
        if let Part::Name(one) = tree.node(target) {
            name = Some(&**one);
        }
        let at = Some(tree.place(target));
        let place = self.program.property_place(text.node, text.property, at);
        found.warn(place, words::assigns_last(text.property, port, name));
    }

    /// The text that an output always gives, where that is known.
    fn constant(&mut self, from: Target) -> Option<Rc<str>> {
        let program = self.program;
        let known = self.constants.entry((from.node, from.port));
        known.or_insert_with(|| constant(program, from)).clone()
    }
}

/// Whether a condition of a block reads its token, before others may have decided.
fn reads_token(program: &Program, id: NodeId) -> bool {
    let reads = |formula: &Formula| {
        let text = &program.formulas[*formula as usize];
        let source = Source::new(&text.text, text.wanted);
        source.names().any(|name| DATA.contains(&name))
    };
    match &program.node(id).op {
        Op::Flow(Flow::If(condition)) => reads(condition),
        Op::Flow(Flow::Switch { arms, .. }) => {
            let mut conditions = arms.iter().filter_map(|(condition, _)| condition.as_ref());
            conditions.next().is_some_and(reads)
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => false,
    }
}

/// Words that a port takes and no others.
fn choices(row: &Row, port: u8) -> Option<&'static [&'static str]> {
    if row.does == Does::Led && row.port("DATA") == Some(port) {
        return Some(LED_COLORS);
    }
    let colours = [
        (Does::Pen, "COLOR", COLORS),
        (Does::Paint, "BRUSH_COLOR", COLORS),
        (Does::Paint, "BACKGROUND_COLOR", BACKGROUNDS),
    ];
    let mut colours = colours.into_iter();
    let taken = colours.find(|(does, name, _)| row.does == *does && row.port(name) == Some(port));
    taken.map(|(.., words)| words)
}

/// A token that is none of the words that its port takes.
fn look_at_word(made: Emitted, to: Target, texts: &mut Texts<'_>, found: &mut Found) {
    let Emitted { of, by } = made;
    let program = texts.program;
    let Some(choices) = choices(program.node(to.node).row, to.port) else {
        return;
    };
    let place = || port_place(program, to.node, to.port);
    match of {
        Of::Truth | Of::Whole | Of::Number | Of::Digits => {
            found.error(place(), words::no_word(of.words(), choices));
        }
        Of::Text => {
            if let Some(text) = texts.constant(by)
                && chosen(choices, &text).is_none()
            {
                found.error(place(), crate::words::no_choice(&text, choices));
            }
        }
        // Told as what does not fit, or not known.
        Of::Never | Of::Unit | Of::Computed | Of::List(_) | Of::Wholes(_) | Of::Any => {}
    }
}

/// The text that an output always gives, where that is known.
fn constant(program: &Program, from: Target) -> Option<Rc<str>> {
    match &program.node(from.node).op {
        Op::Flow(Flow::Constant(Value::Text(text))) => Some(text.clone()),
        Op::Flow(Flow::Function { texts, .. }) => {
            let at = usize::from(from.port.checked_sub(3)?) / 2;
            let formula = (*texts.get(at)?)?;
            let text = &program.formulas[formula as usize];
            let source = Source::new(&text.text, text.wanted);
            let last = source.tree().statements().last().copied()?;
            let Part::Text(text) = source.tree().node(last) else {
                return None;
            };
            Some(text.clone())
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => None,
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
