//! What a converter needs of a program: names, inputs, outputs, ports that react, timers, and what it cannot have.
//!
//! Owns decisions that both languages share. Knows no words of a language.

use super::target::Target;
use super::words;
use crate::limits;
use crate::program::{Act, Flow, Node, NodeId, Op, Program, Source, Target as To};
use crate::sensors;
use lang_diagram::generate::Language;
use lang_diagram::generate::names::Names;
use lang_diagram::ports::{Port, Sort};
use lang_expr::reserved::{SENSORS, SensorIndex, Shape};
use lang_expr::{Source as Formula, Value};
use lang_text::problem::{Place, Problem, Words};
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

/// A value that the converter remembers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Field {
    /// A number, and what it begins with.
    Number(String, f64),
    /// Any value; none at first.
    Value(String),
    /// Tokens that wait.
    Queue(String),
}

/// The first output of the block *Encoders*.
pub(super) const ENCODER_OUT: usize = 6;

/// Fields of every converter in Lua; those in C have names of another form.
const OWN: [&str; 2] = ["now", "firings"];
/// Everything that is decided before anything is written.
pub(super) struct Plan<'a> {
    pub program: &'a Program,
    pub target: Target,
    /// The name of each node.
    pub names: Vec<String>,
    /// Sensors; in the order of their names once all is written.
    pub inputs: Vec<SensorIndex>,
    /// What motors and servos are told.
    pub outputs: Vec<Port>,
    /// Ports that something comes to, in order; their places are what tokens are sent to.
    pub reacting: Vec<To>,
    /// Nodes that set timers, in order.
    pub timers: Vec<NodeId>,
    /// What is remembered, in the order in which it was asked for.
    pub fields: Vec<Field>,
    /// The longest list that is written down or read.
    pub longest: usize,
    pub problems: Vec<Problem>,
    variables: BTreeMap<Rc<str>, String>,
    sensors: BTreeMap<SensorIndex, String>,
    told: BTreeMap<&'static str, String>,
    of_nodes: HashMap<(NodeId, &'static str), String>,
    free: Names,
    places: HashMap<(NodeId, u8), usize>,
}

impl<'a> Plan<'a> {
    /// The plan of a program; with problems if it cannot be a converter.
    pub(super) fn of(program: &'a Program, target: Target) -> Self {
        let language = match target {
            Target::Lua => Language::Lua,
            Target::C => Language::C,
        };
        let mut free = language.names();
        for name in OWN {
            free.take(name);
        }
        let mut plan = Self {
            program,
            target,
            names: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            reacting: Vec::new(),
            timers: Vec::new(),
            fields: Vec::new(),
            longest: 2,
            problems: Vec::new(),
            variables: BTreeMap::new(),
            sensors: BTreeMap::new(),
            told: BTreeMap::new(),
            of_nodes: HashMap::new(),
            places: HashMap::new(),
            free: language.names(),
        };
        if program.nodes.len() > limits::CONVERTER_NODES_MAX {
            let words = words::too_large(limits::CONVERTER_NODES_MAX);
            plan.problem(Place::default(), words);
            return plan;
        }
        for node in &program.nodes {
            let instance = &program.instances[node.instance as usize];
            let caller = instance.caller.map(|caller| caller as usize);
            let above = caller.and_then(|caller| plan.names.get(caller));
            let wanted = match (above, node.caption.is_empty()) {
                (Some(above), false) => format!("{above}_{}", node.caption),
                (Some(above), true) => format!("{above}_{}", node.row.shown),
                (None, false) => node.caption.to_string(),
                (None, true) => node.row.shown.to_owned(),
            };
            plan.names.push(free.take(&wanted));
        }
        plan.free = free;
        for id in 0..program.nodes.len() as NodeId {
            plan.look_at(id);
        }
        plan.outputs.sort_by_key(|port| port.name());
        plan.find_reacting();
        plan
    }

    /// What a node brings with it, or why it cannot be there.
    fn look_at(&mut self, id: NodeId) {
        let node = self.program.node(id);
        match &node.op {
            Op::Flow(flow) => match flow {
                Flow::Random { .. } => self.refuse_block(id, words::no_chance()),
                Flow::Constant(value) => self.look_at_constant(id, value),
                Flow::Wait { keeps: true, .. } => self.refuse_block(id, words::no_keeping()),
                Flow::Loop { .. } | Flow::Wait { keeps: false, .. } => self.timers.push(id),
                Flow::Stop
                | Flow::Function { .. }
                | Flow::If(_)
                | Flow::Switch { .. }
                | Flow::Call(_)
                | Flow::InPort
                | Flow::OutPort(_)
                | Flow::Variable { .. }
                | Flow::Filter { .. }
                | Flow::Replace(_)
                | Flow::Inhibit(_)
                | Flow::Zip
                | Flow::Unzip => {}
            },
            Op::Source(source) => match source {
                Source::Sensor(sensor) => self.needs(*sensor),
                Source::Encoders(devices) => {
                    for (at, &(port, _)) in devices.iter().enumerate() {
                        if let (true, Some(sensor)) = (gives_encoder(node, at), shows(port)) {
                            self.needs(sensor);
                        }
                    }
                }
                Source::Detect(_) | Source::Gamepad | Source::Receive => self.refuse(id, node),
            },
            Op::Act(act) => match act {
                Act::Drive { devices, .. } => {
                    let used = |(at, _): &(usize, _)| node.is_linked(2 + *at as u8);
                    let is_started = self.is_started(id);
                    let all = devices.iter().map(|(port, _)| *port).enumerate();
                    let ports = all.filter(|one| is_started || used(one));
                    ports.for_each(|(_, port)| self.tells(port));
                }
                Act::WritePort { port, .. } => match port.sort() {
                    Sort::Motor | Sort::Servo => self.tells(*port),
                    Sort::Encoder | Sort::Scalar | Sort::Vector | Sort::Button(_) => {
                        self.refuse(id, node);
                    }
                },
                Act::ReadPort(_)
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
                | Act::Draw { .. } => self.refuse(id, node),
            },
        }
    }

    fn look_at_constant(&mut self, id: NodeId, value: &Value) {
        match value {
            Value::Text(_) | Value::Unset => self.refuse_block(id, words::no_texts()),
            Value::List(list) if list.items().len() > self.items_max() => {
                self.refuse_block(id, words::list_too_long(self.items_max()));
            }
            Value::List(list) => {
                self.longest = self.longest.max(list.items().len());
                for item in list.items() {
                    match item {
                        Value::Text(_) | Value::Unset => self.refuse_block(id, words::no_texts()),
                        Value::List(_) => self.refuse_block(id, words::no_nested_lists()),
                        Value::Nil | Value::Bool(_) | Value::Int(_) | Value::Float(_) => {}
                    }
                }
            }
            Value::Nil | Value::Bool(_) | Value::Int(_) | Value::Float(_) => {}
        }
    }

    /// How many items a list may have that is written down.
    pub(super) fn items_max(&self) -> usize {
        match self.target {
            Target::Lua => limits::ITEMS_MAX,
            Target::C => limits::C_ITEMS_MAX,
        }
    }

    /// Whether a text of a node reads an own name.
    pub(super) fn reads(&self, id: NodeId, name: &str) -> bool {
        let texts = self.program.formulas.iter();
        let mut of_node = texts.filter(|text| text.node == id);
        of_node.any(|text| {
            let source = Formula::new(&text.text, text.wanted);
            source.names().any(|one| one == name)
        })
    }

    /// Whether something starts a node by its control input.
    fn is_started(&self, id: NodeId) -> bool {
        let node = self.program.node(id);
        let control = node.row.control();
        control.is_some_and(|port| {
            let to = To { node: id, port };
            node.is_linked(port)
                || self.program.instances[node.instance as usize]
                    .starts
                    .contains(&to)
        })
    }

    fn find_reacting(&mut self) {
        let program = self.program;
        let mut all: Vec<To> = program
            .instances
            .iter()
            .flat_map(|instance| instance.starts.iter().copied())
            .collect();
        for id in 0..program.nodes.len() as NodeId {
            all.extend(program.edges(id).map(|(_, to)| to));
        }
        all.sort_by_key(|to| (to.node, to.port));
        all.dedup();
        self.places = (0..)
            .zip(&all)
            .map(|(at, to)| ((to.node, to.port), at))
            .collect();
        self.reacting = all;
    }

    /// All texts are written, and so everything is known that the program reads and has: inputs stand in the order of their
    /// names, in which the tuples of several nodes stand.
    pub(super) fn settle(&mut self) {
        self.inputs.sort_by_key(|&sensor| sensor_name(sensor));
        if !self.problems.is_empty() {
            return;
        }
        if self.inputs.is_empty() {
            self.problem(Place::default(), words::no_inputs());
        }
        if self.outputs.is_empty() && self.variables.is_empty() {
            self.problem(Place::default(), words::no_outputs());
        }
    }

    /// The program reads a sensor.
    pub(super) fn needs(&mut self, sensor: SensorIndex) {
        if !self.inputs.contains(&sensor) {
            let name = self.free.take(sensor_name(sensor));
            self.fields.push(Field::Value(name.clone()));
            self.sensors.insert(sensor, name);
            self.inputs.push(sensor);
        }
        if let Some(Shape::Numbers(count)) = shape(sensor) {
            self.longest = self.longest.max(count);
        }
    }

    fn tells(&mut self, port: Port) {
        if !self.outputs.contains(&port) {
            let name = self.free.take(port.name());
            self.fields.push(Field::Number(name.clone(), 0.0));
            self.told.insert(port.name(), name);
            self.outputs.push(port);
        }
    }

    fn refuse(&mut self, id: NodeId, node: &Node) {
        self.refuse_block(id, words::not_in_a_converter(node.row.shown));
    }

    fn refuse_block(&mut self, id: NodeId, words: Words) {
        let place = self.program.place(id);
        self.problem(place, words);
    }

    /// Something that a converter cannot have; each is told once.
    pub(super) fn problem(&mut self, place: Place, words: Words) {
        let problem = Problem {
            place,
            ..Problem::error(words)
        };
        let is_new = self.problems.iter().all(|known| *known != problem);
        if is_new && self.problems.len() < lang_text::limits::PROBLEMS_KEPT {
            self.problems.push(problem);
        }
    }

    /// The place of a port in what tokens are sent to.
    pub(super) fn place(&self, to: To) -> Option<usize> {
        self.places.get(&(to.node, to.port)).copied()
    }

    /// The number of a node's timer, from 1.
    pub(super) fn timer(&self, id: NodeId) -> usize {
        let at = self.timers.iter().position(|&one| one == id);
        at.map_or(0, |at| at + 1)
    }

    /// A variable of the program.
    pub(super) fn variable(&mut self, name: &Rc<str>) -> String {
        if let Some(known) = self.variables.get(name) {
            return known.clone();
        }
        let field = self.free.take(name);
        self.variables.insert(name.clone(), field.clone());
        self.fields.push(Field::Value(field.clone()));
        field
    }

    /// The variables that the program has, by their names, and their fields.
    pub(super) fn variables(&self) -> impl Iterator<Item = (&str, &str)> {
        self.variables
            .iter()
            .map(|(name, field)| (&**name, &**field))
    }

    /// A value that a node remembers.
    pub(super) fn value_of(&mut self, id: NodeId, what: &'static str) -> String {
        self.field(id, what, Field::Value)
    }

    /// A number that a node remembers, and what it is at first.
    pub(super) fn number_of(&mut self, id: NodeId, what: &'static str, start: f64) -> String {
        self.field(id, what, |name| Field::Number(name, start))
    }

    /// Tokens that wait at a port of a node.
    pub(super) fn queue_of(&mut self, id: NodeId, what: &'static str) -> String {
        self.field(id, what, Field::Queue)
    }

    fn field(&mut self, id: NodeId, what: &'static str, make: impl Fn(String) -> Field) -> String {
        if let Some(known) = self.of_nodes.get(&(id, what)) {
            return known.clone();
        }
        let name = self
            .free
            .take(&format!("{}_{what}", self.names[id as usize]));
        self.of_nodes.insert((id, what), name.clone());
        self.fields.push(make(name.clone()));
        name
    }

    /// The field of a sensor's reading.
    pub(super) fn reading(&self, sensor: SensorIndex) -> String {
        self.sensors.get(&sensor).cloned().unwrap_or_default()
    }

    /// The field of what a motor or servo was told last.
    pub(super) fn told(&self, port: Port) -> String {
        self.told.get(port.name()).cloned().unwrap_or_default()
    }
}

/// Whether somebody gets the readings of an encoder of the block *Encoders*.
pub(super) fn gives_encoder(node: &Node, at: usize) -> bool {
    let outs = node.outs.get(ENCODER_OUT + at);
    outs.is_some_and(|targets| !targets.is_empty())
}

/// The sensor variable that shows a port.
pub(super) fn shows(port: Port) -> Option<SensorIndex> {
    let mut all = (0..).zip(&SENSORS);
    let found = all.find(|(_, sensor)| Port::shown_by(sensor.name) == Some(port));
    found.map(|(sensor, _)| sensor)
}

/// The name of a sensor variable.
pub(super) fn sensor_name(sensor: SensorIndex) -> &'static str {
    sensors::name(sensor)
}

/// What a sensor variable holds.
pub(super) fn shape(sensor: SensorIndex) -> Option<Shape> {
    sensors::shape(sensor)
}
