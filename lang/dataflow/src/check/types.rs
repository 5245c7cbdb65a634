//! Types of tokens: what each output gives, as far as it is known before anything runs.
//!
//! Owns the inference. What is not known fits everywhere: then the program says so when it runs.

use super::conditions;
use super::fed::input;
use super::first;
use super::found::Found;
use super::givers::{Known, Variables, gives};
use super::statements;
use super::tokens::{self, taken};
use super::unassigned::Unassigned;
use super::units::assigned_last;
use super::words;
use crate::blocks::{Kind, Row};
use crate::limits;
use crate::lower::DATA;
use crate::program::{Act, Camera, Flow, NodeId, Op, Program, Read, Source as Gives, Target, Text};
use crate::sensors;
use lang_diagram::ports::Sort;
use lang_expr::names::{is_own, own_name, written};
use lang_expr::reserved::Shape;
use lang_expr::tree::Node as Part;
use lang_expr::{Names, Source, Type, Value, Wanted};
use std::collections::HashSet;
use std::rc::Rc;

/// What a token is.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(super) enum Of {
    /// No token comes there, as far as it is known yet.
    #[default]
    Never,
    /// A unit.
    Unit,
    /// A truth.
    Truth,
    /// A whole number.
    Whole,
    /// A number.
    Number,
    /// A text of the diagram that is a number.
    Digits,
    /// A text of the diagram that is none.
    Text,
    /// A text that nobody knows before.
    Computed,
    /// A list of so many items; 0: nobody knows how many.
    List(u16),
    /// The same, of whole numbers.
    Wholes(u16),
    /// Not known.
    Any,
}

impl Of {
    /// What it is if it may be either.
    fn join(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, one) | (one, Self::Never) => one,
            (one, other) if one == other => one,
            (Self::Whole, Self::Number) | (Self::Number, Self::Whole) => Self::Number,
            (Self::List(one) | Self::Wholes(one), Self::List(other) | Self::Wholes(other)) => {
                Self::List(if one == other { one } else { 0 })
            }
            (
                Self::Digits | Self::Text | Self::Computed,
                Self::Digits | Self::Text | Self::Computed,
            ) => Self::Computed,
            (
                Self::Unit
                | Self::Truth
                | Self::Whole
                | Self::Number
                | Self::Digits
                | Self::Text
                | Self::Computed
                | Self::List(_)
                | Self::Wholes(_)
                | Self::Any,
                _,
            ) => Self::Any,
        }
    }

    /// What a port gives by its kind alone.
    pub(super) fn of_kind(kind: Kind) -> Self {
        match kind {
            Kind::Unit => Self::Unit,
            Kind::Truth => Self::Truth,
            Kind::Whole => Self::Whole,
            Kind::Text => Self::Computed,
            Kind::List => Self::List(0),
            Kind::Items(count) => Self::List(count.into()),
            Kind::Any => Self::Any,
        }
    }

    fn of_value(value: &Value) -> Self {
        match value {
            Value::Nil => Self::Unit,
            Value::Bool(_) => Self::Truth,
            Value::Int(_) => Self::Whole,
            Value::Float(_) => Self::Number,
            Value::Text(text) if text.trim().parse::<f64>().is_ok() => Self::Digits,
            Value::Text(_) | Value::Unset => Self::Text,
            Value::List(list) => {
                let count = u16::try_from(list.items().len()).unwrap_or(0);
                let is_whole = |item: &Value| matches!(item, Value::Int(_));
                match list.items().iter().all(is_whole) {
                    true => Self::Wholes(count),
                    false => Self::List(count),
                }
            }
        }
    }

    fn of_type(of: Type) -> Self {
        match of {
            Type::Any | Type::Open | Type::Function => Self::Any,
            Type::Bool => Self::Truth,
            Type::Int => Self::Whole,
            Type::Float => Self::Number,
            Type::Text => Self::Computed,
            Type::Nil => Self::Unit,
            Type::Table(_) => Self::List(0),
        }
    }

    /// A value of this type, to teach the names of expressions; none if it is not known.
    fn example(self) -> Option<Value> {
        match self {
            // What the items are, nobody knows.
            Self::Never | Self::Unit | Self::Any | Self::List(_) => None,
            Self::Truth => Some(Value::Bool(true)),
            Self::Whole => Some(Value::Int(0)),
            Self::Number => Some(Value::Float(0.5)),
            Self::Digits | Self::Text | Self::Computed => Some(Value::text("")),
            Self::Wholes(_) => Some(Value::ints(&[0])),
        }
    }

    /// Whether a port may take it.
    pub(super) fn fits(self, kind: Kind) -> bool {
        match (kind, self) {
            (Kind::Unit | Kind::Any, _) => true,
            // What has no value is told as a warning.
            (_, Self::Never | Self::Unit | Self::Any) => true,
            (Kind::Truth, Self::Truth | Self::Whole | Self::Computed) => true,
            (Kind::Whole, Self::Whole | Self::Number | Self::Digits | Self::Computed) => true,
            (
                Kind::Text,
                Self::Truth
                | Self::Whole
                | Self::Number
                | Self::Digits
                | Self::Text
                | Self::Computed,
            ) => true,
            (Kind::List, Self::List(_) | Self::Wholes(_)) => true,
            (Kind::Items(_), Self::List(0) | Self::Wholes(0)) => true,
            (Kind::Items(count), Self::List(known) | Self::Wholes(known)) => {
                u16::from(count) == known
            }
            (
                Kind::Truth | Kind::Whole | Kind::Text | Kind::List | Kind::Items(_),
                Self::Truth
                | Self::Whole
                | Self::Number
                | Self::Digits
                | Self::Text
                | Self::Computed
                | Self::List(_)
                | Self::Wholes(_),
            ) => false,
        }
    }

    /// What it is, in words.
    pub(super) fn words(self) -> [&'static str; 2] {
        match self {
            Self::Never | Self::Any => words::A_VALUE,
            Self::Unit => words::A_UNIT,
            Self::Truth => words::A_TRUTH,
            Self::Whole => words::A_WHOLE,
            Self::Number => words::A_NUMBER,
            Self::Digits | Self::Text | Self::Computed => words::A_TEXT,
            Self::List(_) | Self::Wholes(_) => words::A_LIST,
        }
    }
}

/// What each output gives, and what comes to each input.
pub(super) struct Types {
    pub outs: Vec<Vec<Of>>,
    ins: Vec<Vec<Of>>,
}

/// Hands types on until nothing changes, and tells what is wrong with expressions.
pub(super) fn infer(program: &Program, found: &mut Found) -> Types {
    let mut unsure = HashSet::new();
    for _ in 0..limits::GUESSES_MAX {
        let mut inference = Inference::new(program, &unsure);
        let is_whole = inference.run();
        let before = unsure.len();
        unsure.extend(inference.doubts(is_whole));
        if unsure.len() == before {
            return inference.tell(found);
        }
    }
    // So many guesses were wrong that none is made.
    let every = Inference::new(program, &HashSet::new()).variables.fed;
    let unsure = every.into_iter().map(|one| one.name).collect();
    let mut inference = Inference::new(program, &unsure);
    inference.run();
    inference.tell(found)
}

struct Inference<'a> {
    program: &'a Program,
    types: Types,
    names: Names,
    /// What each expression gives.
    texts: Vec<Of>,
    /// Who gives variables their values, and who waits for them.
    variables: Variables,
    /// Names that nothing gives a value.
    unassigned: Unassigned,
    /// Variables that are read before they have a value.
    late: HashSet<Rc<str>>,
}

impl<'a> Inference<'a> {
    /// That of a program of which nothing is known; `unsure`: variables whose type is not taken from tokens.
    fn new(program: &'a Program, unsure: &HashSet<Rc<str>>) -> Self {
        let blank = || -> Vec<Vec<Of>> {
            let nodes = program.nodes.iter();
            nodes
                .map(|node| vec![Of::Never; node.row.ports.len()])
                .collect()
        };
        Self {
            program,
            types: Types {
                outs: blank(),
                ins: blank(),
            },
            names: sensors::names_of(program.kit),
            texts: program.formulas.iter().map(|_| Of::Any).collect(),
            variables: Variables::of(program, unsure),
            unassigned: Unassigned::default(),
            late: HashSet::new(),
        }
    }

    /// Hands types on until nothing changes; whether that came within the passes there are.
    fn run(&mut self) -> bool {
        for pass in 0..limits::PASSES_MAX {
            let before = (self.types.outs.clone(), self.variables.known.clone());
            self.feed();
            self.learn(None);
            self.pass();
            let is_same = before.0 == self.types.outs && before.1 == self.variables.known;
            if is_same && self.variables.is_forced {
                return true;
            }
            // Texts that wait for each other are looked at as they are, once everything else is known.
            self.variables.is_forced |= pass > 0 && is_same || pass + 2 >= limits::PASSES_MAX;
        }
        false
    }

    /// Gives variables that get tokens the types of these, as far as they are known.
    fn feed(&mut self) {
        for fed in &mut self.variables.fed {
            let mut of = Of::Never;
            for &(node, item) in &fed.by {
                let port = input(self.program.node(node).row).map_or(0, usize::from);
                of = of.join(taken(self.types.ins[node as usize][port], item));
            }
            let known = match (of.example(), of) {
                (Some(example), _) => match self.names.slot(&fed.name) {
                    Some(slot) => {
                        fed.is_typed = true;
                        self.names.retype(slot, &example);
                        Known::All
                    }
                    None => Known::Never,
                },
                (None, Of::Never) => Known::NotYet,
                (None, _) => Known::Never,
            };
            self.variables.known_fed.insert(fed.name.clone(), known);
        }
    }

    /// Variables that were given a type of tokens which turned out to be only some of those that come; `is_whole`: whether
    /// all of them are known.
    fn doubts(&mut self, is_whole: bool) -> Vec<Rc<str>> {
        self.feed();
        let known = &self.variables.known_fed;
        let typed = self.variables.fed.iter().filter(|one| one.is_typed);
        let doubtful = typed.filter(|one| !is_whole || known.get(&one.name) != Some(&Known::All));
        doubtful.map(|one| one.name.clone()).collect()
    }

    /// Tells what is wrong with expressions and variables.
    fn tell(mut self, found: &mut Found) -> Types {
        self.late = first::look(self.program, found);
        self.learn(Some(found));
        self.unassigned
            .tell_blocks(self.program, &self.variables, found);
        let known = &self.variables.known_fed;
        let of_variable = |name: &str| {
            let slot = self.names.find(name).filter(|_| !known.contains_key(name));
            let of = slot.map(|slot| Of::of_type(self.names.type_of(slot)));
            of.unwrap_or(Of::Any)
        };
        tokens::tell(self.program, &self.types.outs, of_variable, found);
        self.types
    }

    /// Looks at each expression with what is known of its names.
    fn learn(&mut self, mut found: Option<&mut Found>) {
        for index in 0..self.program.formulas.len() {
            let text = &self.program.formulas[index];
            let known = self.bind(index);
            self.variables.note(index, known);
            let rename = |name: &str| text.own.contains(&name).then(|| own_name(name, text.node));
            let mut source = Source::with_own_names(&text.text, text.wanted, &rename);
            let outcome = match (known, source.tree().root) {
                (Known::All, _) | (_, None) => lang_expr::analyse(&mut source, &mut self.names),
                // Without types only the grammar can be looked at.
                (Known::NotYet | Known::Never, Some(_)) => Ok(()),
            };
            self.texts[index] = match (known, &outcome) {
                (Known::All, Ok(())) => self.result(&source),
                (Known::Never, _) => self.own_result(text, &source).unwrap_or(Of::Any),
                // What is not known yet, or not understood before other texts are, may be known later.
                (Known::All | Known::NotYet, _) => Of::Never,
            };
            let Some(found) = found.as_deref_mut() else {
                continue;
            };
            if text.wanted == Wanted::Bool && assigned_last(&source).is_some() {
                let place = self.program.property_place(text.node, text.property, None);
                found.error(place, words::assigning_condition());
                continue;
            }
            let known_names = (&self.names, &self.variables);
            let is_unassigned =
                self.unassigned
                    .tell(self.program, text, &source, known_names, found);
            statements::look(self.program, text, &source, found);
            // The types of a text that reads what has no value are told of as that.
            if is_unassigned || self.variables.reads_any(index, &self.late) {
                continue;
            }
            match outcome {
                Err(problems) => {
                    for problem in problems {
                        let at = problem.place.position;
                        let place = self.program.property_place(text.node, text.property, at);
                        found.error(place, problem.words);
                    }
                }
                Ok(()) if text.wanted == Wanted::Bool && known == Known::All => {
                    conditions::look(self.program, text, (&source, &self.names), found);
                }
                Ok(()) => {}
            }
        }
    }

    /// Teaches the names what the own ones of a text are, as far as that is known.
    fn bind(&mut self, index: usize) -> Known {
        let text = &self.program.formulas[index];
        let node = self.program.node(text.node);
        let mut known = Known::All;
        let source = Source::new(&text.text, text.wanted);
        for name in text.own {
            if !source.names().any(|one| one == *name) {
                continue;
            }
            let port = own_port(node.row, text.own, name);
            let ins = &self.types.ins[text.node as usize];
            let of = port.map_or(Of::Any, |port| ins[usize::from(port)]);
            let slot = self.names.slot(&own_name(name, text.node));
            known = known.and(match (of.example(), slot, of) {
                (Some(example), Some(slot), _) => {
                    self.names.retype(slot, &example);
                    Known::All
                }
                (_, _, Of::Never) => Known::NotYet,
                _ => Known::Never,
            });
        }
        self.variables.and(index, known, |name| {
            let slot = self.names.find(name);
            slot.is_some_and(|slot| self.names.type_of(slot) != Type::Any)
        })
    }

    /// What an expression that is understood gives.
    fn result(&self, source: &Source) -> Of {
        let statements = source.tree().statements();
        let Some(&last) = statements.last() else {
            return Of::Unit;
        };
        let part = source.tree().node(last);
        if let Part::Assign { .. } = part {
            return Of::Unit;
        }
        if let Part::Text(text) = part {
            return Of::of_value(&Value::text(text.clone()));
        }
        if let Part::Table { fields, .. } = part
            && fields.iter().all(|field| field.key.is_none())
        {
            return Of::List(u16::try_from(fields.len()).unwrap_or(0));
        }
        Of::of_type(source.type_of(last, &self.names))
    }

    /// What an expression gives whose last statement is a name of its own and nothing else: what comes there.
    fn own_result(&self, text: &Text, source: &Source) -> Option<Of> {
        let tree = source.tree();
        let &last = tree.statements().last()?;
        let Part::Name(name) = tree.node(last) else {
            return None;
        };
        let is_own = is_own(name) && !gives(tree).contains(name);
        let port = own_port(self.program.node(text.node).row, text.own, written(name));
        let ins = &self.types.ins[text.node as usize];
        is_own.then_some(ins[usize::from(port?)])
    }

    fn pass(&mut self) {
        let program = self.program;
        for id in 0..program.nodes.len() as NodeId {
            self.node(id);
            for (port, to) in program.edges(id) {
                let of = self.types.outs[id as usize][usize::from(port)];
                let came = &mut self.types.ins[to.node as usize][usize::from(to.port)];
                *came = came.join(of);
            }
        }
        for instance in &program.instances {
            let Some(caller) = instance.caller else {
                continue;
            };
            for &(port, input) in &instance.inputs {
                let of = self.types.ins[caller as usize][usize::from(port)];
                self.types.outs[input as usize][0] = self.types.outs[input as usize][0].join(of);
            }
        }
    }

    /// What the outputs of a node give.
    fn node(&mut self, id: NodeId) {
        let node = self.program.node(id);
        let ins = self.types.ins[id as usize].clone();
        let give = |types: &mut Types, port: u8, of: Of| {
            let out = &mut types.outs[id as usize][usize::from(port)];
            *out = out.join(of);
        };
        for (port, row) in (0..).zip(node.row.ports) {
            let fixed = match row.of {
                Kind::Unit => Of::Unit,
                Kind::Truth => Of::Truth,
                Kind::Whole => Of::Whole,
                Kind::Text => Of::Computed,
                Kind::List | Kind::Any => continue,
                Kind::Items(count) => Of::List(u16::from(count)),
            };
            if row.way == crate::blocks::Direction::Out {
                give(&mut self.types, port, fixed);
            }
        }
        match &node.op {
            Op::Flow(flow) => self.flow(id, flow, &ins),
            Op::Source(source) => match source {
                Gives::Sensor(sensor) => {
                    let of = match sensors::shape(*sensor) {
                        Some(Shape::Number) => Of::Whole,
                        Some(Shape::Numbers(count)) => {
                            Of::Wholes(u16::try_from(count).unwrap_or(0))
                        }
                        None => Of::Any,
                    };
                    give(&mut self.types, 1, of);
                }
                Gives::Detect(Camera::Line | Camera::Object | Camera::Color) => {
                    give(&mut self.types, 1, Of::Wholes(3));
                }
                Gives::Encoders(_) | Gives::Gamepad | Gives::Receive => {}
            },
            Op::Act(Act::ReadPort(read)) => {
                let of = match read {
                    Read::Told(_) | Read::Part(..) => Of::Whole,
                    Read::Device(port) if port.sort() == Sort::Vector => Of::Wholes(0),
                    Read::Device(_) => Of::Whole,
                };
                give(&mut self.types, 1, of);
            }
            Op::Act(_) => {}
        }
    }

    fn flow(&mut self, id: NodeId, flow: &Flow, ins: &[Of]) {
        let texts = &self.texts;
        let text = |index: &Option<u32>| index.map(|index| texts[index as usize]);
        let mut gives: Vec<(u8, Of)> = Vec::new();
        match flow {
            Flow::Function { texts, .. } => {
                let all = (0..).zip(texts);
                gives.extend(all.filter_map(|(at, one)| Some((3 + 2 * at, text(one)?))));
            }
            Flow::If(_) => {
                // A start sends a unit the same ways.
                let of = match self.program.node(id).is_linked(0) {
                    true => ins[1].join(Of::Unit),
                    false => ins[1],
                };
                gives.extend([(2, of), (3, of)]);
            }
            Flow::Switch { arms, .. } => {
                let all = (3..).zip(arms);
                gives.extend(all.map(|(port, (_, one))| (port, text(one).unwrap_or(ins[2]))));
            }
            Flow::Constant(value) => gives.push((1, Of::of_value(value))),
            Flow::Variable { names, .. } => {
                let slot = names.first().and_then(|name| self.names.find(name));
                // A variable whose type nobody has said yet may get one.
                let of = slot.map_or(Of::Never, |slot| {
                    match Of::of_type(self.names.type_of(slot)) {
                        Of::Any => Of::Never,
                        known @ (Of::Never
                        | Of::Unit
                        | Of::Truth
                        | Of::Whole
                        | Of::Number
                        | Of::Digits
                        | Of::Text
                        | Of::Computed
                        | Of::List(_)
                        | Of::Wholes(_)) => known,
                    }
                });
                gives.push((3, of));
            }
            Flow::Filter { .. } => gives.push((3, ins[4])),
            Flow::Wait { .. } => gives.push((3, ins[2])),
            Flow::Replace(_) => gives.push((2, ins[0].join(ins[1]))),
            Flow::Inhibit(_) => gives.push((2, ins[1])),
            Flow::Unzip => gives.extend([(1, Of::Any), (2, Of::Any)]),
            Flow::OutPort(Some(Target { node, port })) => {
                let out = &mut self.types.outs[*node as usize][usize::from(*port)];
                *out = out.join(ins[0]);
            }
            Flow::Stop
            | Flow::Loop { .. }
            | Flow::Call(_)
            | Flow::InPort
            | Flow::OutPort(None)
            | Flow::Random { .. }
            | Flow::Zip => {}
        }
        for (port, of) in gives {
            let out = &mut self.types.outs[id as usize][usize::from(port)];
            *out = out.join(of);
        }
    }
}

/// The port whose tokens a name of a block's own stands for.
fn own_port(row: &Row, own: &[&str], name: &str) -> Option<u8> {
    match own == DATA {
        true => row.port("DATA"),
        false => row.port(name),
    }
}
