//! What each port of a program does with a token, as statements in no language.
//!
//! Owns one arm for each kind of block, like `machine::fire`, whose order of sending it keeps. Knows no language.

mod timed;

use super::code::{Phrase, text, truth};
use super::language::{Word, quoted, say};
use super::plan::{ENCODER_OUT, Plan, gives_encoder, shows};
use super::step::{Body, Routine, Step};
use crate::machine::SERVO_DEGREES;
use crate::program::{Act, Flow, Formula, Gathers, NodeId, Op, Source, Target as To};
use crate::project::Policy;
use lang_diagram::ports::{Port, Sort};
use lang_expr::Value;
use std::rc::Rc;

/// Numbers of ports, as the rows have them.
const CONTROL: u8 = 0;
const DATA: u8 = 2;
const FUNCTION_OUT: u8 = 3;

/// Writes every reaction.
pub(super) fn body(plan: &mut Plan<'_>) -> Body {
    let reacting = plan.reacting.clone();
    let reactions = reacting.iter().map(|&to| {
        let node = plan.program.node(to.node);
        let about = format!(
            "{}.{}",
            plan.names[to.node as usize],
            node.port_name(to.port)
        );
        let steps = Writer { plan }.reaction(to);
        Routine { about, steps }
    });
    let reactions = reactions.collect();
    let timers = plan.timers.clone();
    let ticks = timers.iter().map(|&id| Routine {
        about: plan.names[id as usize].clone(),
        steps: Writer { plan }.tick(id),
    });
    let ticks = ticks.collect();
    let mut writer = Writer { plan };
    let starts = writer.plan.program.instances.first();
    let starts = starts.map(|main| main.starts.clone()).unwrap_or_default();
    Body {
        reactions,
        ticks,
        start: starts.into_iter().map(|to| writer.unit_to(to)).collect(),
        poll: writer.poll(),
    }
}

struct Writer<'a, 'p> {
    plan: &'a mut Plan<'p>,
}

impl Writer<'_, '_> {
    fn say(&self, word: Word, operands: &[&str]) -> String {
        say(self.plan.target, word, operands)
    }

    fn field(&self, name: &str) -> String {
        self.say(Word::Field, &[name])
    }

    /// A number that the block remembers.
    fn number(&mut self, id: NodeId, what: &'static str, start: impl Into<f64>) -> String {
        let name = self.plan.number_of(id, what, start.into());
        self.field(&name)
    }

    fn value(&mut self, id: NodeId, what: &'static str) -> String {
        let name = self.plan.value_of(id, what);
        self.field(&name)
    }

    fn fail(&self, reason: &str) -> Step {
        let reason = quoted(self.plan.target, reason);
        Step::Do(self.say(Word::Fail, &[&reason]))
    }

    fn now(&self) -> String {
        self.say(Word::Now, &[])
    }

    fn unit_to(&self, to: To) -> Step {
        let unit = self.say(Word::Unit, &[]);
        self.post(to, &unit)
    }

    fn post(&self, to: To, value: &str) -> Step {
        let place = self.plan.place(to).unwrap_or_default();
        let place = super::language::place(self.plan.target, place);
        Step::Do(self.say(Word::Post, &[&place, value]))
    }

    /// Sends a name on a port.
    fn send(&self, id: NodeId, port: u8, value: &str) -> Vec<Step> {
        let targets = self.plan.program.node(id).outs.get(usize::from(port));
        let targets = targets.map(|all| all.to_vec()).unwrap_or_default();
        targets.into_iter().map(|to| self.post(to, value)).collect()
    }

    fn send_unit(&self, id: NodeId, port: u8) -> Vec<Step> {
        let unit = self.say(Word::Unit, &[]);
        self.send(id, port, &unit)
    }

    /// Sends what is computed on a port; it is computed also where nobody waits for it.
    fn send_made(&self, id: NodeId, port: u8, value: &Phrase) -> Vec<Step> {
        let targets = &self.plan.program.node(id).outs[usize::from(port)];
        if targets.is_empty() {
            return vec![Step::Do(self.say(Word::Ignore, &[&value.text]))];
        }
        let mut steps = vec![Step::Set("made".to_owned(), value.text.clone())];
        steps.extend(self.send(id, port, "made"));
        steps
    }

    fn done(&self, id: NodeId) -> Vec<Step> {
        match self.plan.program.node(id).done {
            Some(port) => self.send_unit(id, port),
            None => Vec::new(),
        }
    }

    fn reaction(&mut self, to: To) -> Vec<Step> {
        let program = self.plan.program;
        let node = program.node(to.node);
        if !node.queues.is_empty() && node.data & (1 << to.port) != 0 {
            return self.queued(to);
        }
        let mut steps = vec![Step::Do(self.say(Word::Count, &[]))];
        steps.extend(match &node.op {
            Op::Flow(flow) => self.flow(to, flow),
            Op::Source(source) => match source {
                Source::Sensor(_) => {
                    let is_on = self.number(to.node, "on", 0);
                    vec![Step::Set(is_on, "1".to_owned())]
                }
                Source::Encoders(devices) => self.encoders(to, devices),
                Source::Detect(_) | Source::Gamepad | Source::Receive => Vec::new(),
            },
            Op::Act(act) => self.act(to, act),
        });
        steps
    }

    /// Encoders count from what they are told; the device itself is not told anything.
    fn encoders(&mut self, to: To, devices: &[(Port, bool); 4]) -> Vec<Step> {
        let mut steps = Vec::new();
        for (at, &(port, clears)) in devices.iter().enumerate() {
            let is_meant = match to.port {
                CONTROL => clears,
                port => usize::from(port - DATA) == at,
            };
            let Some((is_on, from, reading)) = self.encoder(to.node, at, port).filter(|_| is_meant)
            else {
                continue;
            };
            let reading = self.say(Word::Number, &[&reading]);
            let begins = match to.port {
                CONTROL => reading,
                _ => {
                    let number = self.say(Word::AsWhole, &["token"]);
                    self.say(Word::Subtract, &[&reading, &number])
                }
            };
            steps.push(Step::Set(is_on, "1".to_owned()));
            steps.push(Step::Set(from, begins));
        }
        steps.extend(self.done(to.node));
        steps
    }

    /// Whether an encoder's readings are given, from what they count, and the reading; none if nobody gets them.
    fn encoder(&mut self, id: NodeId, at: usize, port: Port) -> Option<(String, String, String)> {
        const ON: [&str; 4] = ["on1", "on2", "on3", "on4"];
        const FROM: [&str; 4] = ["from1", "from2", "from3", "from4"];
        if !gives_encoder(self.plan.program.node(id), at) {
            return None;
        }
        let sensor = shows(port)?;
        let is_on = self.number(id, ON[at], 0);
        let from = self.number(id, FROM[at], 0);
        Some((is_on, from, self.field(&self.plan.reading(sensor))))
    }

    /// A token of a block that waits for several.
    fn queued(&mut self, to: To) -> Vec<Step> {
        const NAMES: [&str; 16] = [
            "at0", "at1", "at2", "at3", "at4", "at5", "at6", "at7", "at8", "at9", "at10", "at11",
            "at12", "at13", "at14", "at15",
        ];
        let node = self.plan.program.node(to.node);
        let ports: Vec<usize> = (0..node.queues.len())
            .filter(|port| node.data & (1 << port) != 0)
            .collect();
        if let [port] = ports[..] {
            let mut steps = vec![Step::Do(self.say(Word::Count, &[]))];
            steps.extend(self.together(to.node, &[(port as u8, "token".to_owned())]));
            return steps;
        }
        let mut queues = Vec::new();
        for &port in &ports {
            let name = self.plan.queue_of(to.node, NAMES[port]);
            queues.push((port, self.field(&name)));
        }
        let rule = node.queues[usize::from(to.port)];
        let policy = match rule.policy {
            Policy::Fifo => "0",
            Policy::Latest => "1",
            Policy::Error => "2",
        };
        let own = queues
            .iter()
            .find(|(port, _)| *port == usize::from(to.port));
        let own = own.map(|(_, queue)| queue.clone()).unwrap_or_default();
        let capacity = rule.capacity.to_string();
        let mut steps = vec![Step::Do(
            self.say(Word::Push, &[&own, "token", &capacity, policy]),
        )];
        let mut all = String::new();
        let mut taken = Vec::new();
        for (port, queue) in &queues {
            let has = self.say(Word::Has, &[queue]);
            all = match all.is_empty() {
                true => has,
                false => self.say(Word::And, &[&all, &has]),
            };
            taken.push((*port as u8, self.say(Word::Take, &[queue])));
        }
        let mut round = vec![Step::Do(self.say(Word::Count, &[]))];
        round.extend(self.together(to.node, &taken));
        steps.push(Step::While(all, round));
        steps
    }

    /// A block has a token at each input that it waits for.
    fn together(&mut self, id: NodeId, tokens: &[(u8, String)]) -> Vec<Step> {
        let mut steps = Vec::new();
        let Some(gathers) = self.plan.program.node(id).gathers() else {
            return steps;
        };
        match gathers {
            Gathers::Function(texts) => {
                for (port, token) in tokens {
                    let own = crate::lower::INPUTS[usize::from((port - DATA) / 2)];
                    let field = self.value(id, own);
                    steps.push(Step::Set(field, token.clone()));
                }
                steps.extend(self.compute_all(id, texts));
            }
            Gathers::Drive(devices) => {
                for (port, token) in tokens {
                    let (device, _) = devices[usize::from(port - DATA)];
                    steps.push(self.tell(device, token));
                }
                steps.extend(self.done(id));
            }
            Gathers::Zip => {
                let items: Vec<String> = tokens.iter().map(|(_, token)| token.clone()).collect();
                if items.len() == 2 {
                    let list = super::language::list(self.plan.target, &items);
                    steps.extend(self.send_made(id, 1, &Phrase::atom(list)));
                }
            }
        }
        steps
    }

    /// A motor or servo is told the number of a token.
    fn tell(&self, port: Port, token: &str) -> Step {
        let number = self.say(Word::AsWhole, &[token]);
        let servo = SERVO_DEGREES.to_string();
        let most = match port.sort() {
            Sort::Servo => &*servo,
            Sort::Motor | Sort::Encoder | Sort::Scalar | Sort::Vector | Sort::Button(_) => "100",
        };
        let name = self.plan.told(port);
        Step::Set(self.field(&name), self.say(Word::Clamp, &[&number, most]))
    }

    fn tell_number(&self, port: Port, number: i32) -> Step {
        let number = super::language::number(self.plan.target, &Value::Int(number));
        let made = self.say(Word::ValueOfNumber, &[&number]);
        self.tell(port, &made)
    }

    fn act(&self, to: To, act: &Act) -> Vec<Step> {
        let is_start = self.plan.program.node(to.node).row.control() == Some(to.port);
        let mut steps = Vec::new();
        match act {
            Act::WritePort { port, value } => steps.push(match is_start {
                true => self.tell_number(*port, *value),
                false => self.tell(*port, "token"),
            }),
            Act::Drive { devices, .. } if is_start => {
                let all = devices.iter();
                steps.extend(all.map(|&(port, value)| self.tell_number(port, value)));
            }
            Act::Drive { devices, .. } => {
                steps.push(self.tell(devices[usize::from(to.port - DATA)].0, "token"));
            }
            // Refused by the plan.
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
            | Act::Draw { .. } => {}
        }
        steps.extend(self.done(to.node));
        steps
    }

    fn flow(&mut self, to: To, flow: &Flow) -> Vec<Step> {
        let id = to.node;
        match flow {
            Flow::Stop => vec![Step::Do(self.say(Word::Stop, &[]))],
            Flow::Function { texts, .. } => self.function(to, texts),
            Flow::If(condition) => self.decide(to, *condition),
            Flow::Switch { arms, first_only } => self.switch(to, arms, *first_only),
            Flow::Loop { bounds, time_ms } => self.count(to, *bounds, *time_ms),
            Flow::Call(instance) => self.enter(to, *instance),
            Flow::OutPort(Some(at)) => self.send(at.node, at.port, "token"),
            Flow::Constant(constant) => {
                let value = super::language::constant(self.plan.target, constant);
                self.send(id, 1, &value)
            }
            Flow::Variable { run, names } => self.variable(to, *run, names),
            Flow::Filter {
                quiet_ms,
                condition,
                count,
                pause_ms,
            } => self.filter(to, *quiet_ms, *condition, *count, *pause_ms),
            Flow::Wait { ms, .. } => self.hold(to, *ms),
            Flow::Replace(ms) => self.window(to, *ms, true),
            Flow::Inhibit(ms) => self.window(to, *ms, false),
            Flow::Unzip => {
                let pair = Step::Do(self.say(Word::NeedsPair, &["token"]));
                let item = |at| Phrase::atom(self.say(Word::Item, &["token", at]));
                let mut steps = vec![pair];
                steps.extend(self.send_made(id, 1, &item("0")));
                steps.extend(self.send_made(id, 2, &item("1")));
                steps
            }
            Flow::InPort | Flow::OutPort(None) | Flow::Random { .. } | Flow::Zip => Vec::new(),
        }
    }

    fn function(&mut self, to: To, texts: &[Option<Formula>; 6]) -> Vec<Step> {
        if to.port == CONTROL {
            // A start means nothing to a function that has inputs.
            return match self.plan.program.node(to.node).data {
                0 => self.compute_all(to.node, texts),
                _ => Vec::new(),
            };
        }
        let at = usize::from((to.port - DATA) / 2);
        let field = self.value(to.node, crate::lower::INPUTS[at]);
        let mut steps = vec![Step::Set(field, "token".to_owned())];
        steps.extend(self.compute(to.node, at, texts[at]));
        steps.extend(self.done(to.node));
        steps
    }

    fn compute_all(&mut self, id: NodeId, texts: &[Option<Formula>; 6]) -> Vec<Step> {
        let mut steps = Vec::new();
        for (at, text) in texts.iter().enumerate() {
            steps.extend(self.compute(id, at, *text));
        }
        steps.extend(self.done(id));
        steps
    }

    fn compute(&mut self, id: NodeId, at: usize, formula: Option<Formula>) -> Vec<Step> {
        let port = FUNCTION_OUT + 2 * at as u8;
        formula.map_or_else(Vec::new, |formula| self.send_text(id, port, formula))
    }

    fn send_text(&mut self, id: NodeId, port: u8, formula: Formula) -> Vec<Step> {
        let (mut steps, value) = text(self.plan, formula);
        steps.extend(match value {
            Some(value) => self.send_made(id, port, &value),
            None => self.send_unit(id, port),
        });
        steps
    }

    fn decide(&mut self, to: To, condition: Formula) -> Vec<Step> {
        let mut steps = self.bind(to);
        let (before, truth) = truth(self.plan, condition);
        steps.extend(before);
        let ways = [2, 3].map(|port| self.send(to.node, port, "token"));
        let [yes, no] = ways;
        steps.push(Step::If(truth.text, yes, no));
        steps
    }

    /// Keeps a token as `data`; a start is none.
    fn bind(&mut self, to: To) -> Vec<Step> {
        if to.port == CONTROL {
            return Vec::new();
        }
        let data = self.value(to.node, "data");
        vec![Step::Set(data, "token".to_owned())]
    }

    fn switch(
        &mut self,
        to: To,
        arms: &[(Option<Formula>, Option<Formula>); 6],
        first_only: bool,
    ) -> Vec<Step> {
        let mut steps = self.bind(to);
        let mut ways = Vec::new();
        for (port, (condition, value)) in (3..).zip(arms) {
            let Some(condition) = condition else {
                continue;
            };
            let sends = match value {
                Some(value) => self.send_text(to.node, port, *value),
                // A start lets the last token through, if it was kept for a text.
                None if to.port == CONTROL && !self.plan.reads(to.node, "data") => {
                    self.send_unit(to.node, port)
                }
                None if to.port == CONTROL => {
                    let data = self.value(to.node, "data");
                    self.send(to.node, port, &data)
                }
                None => self.send(to.node, port, "token"),
            };
            ways.push((truth(self.plan, *condition), sends));
        }
        // The last way is the innermost.
        let mut inner: Vec<Step> = Vec::new();
        for ((mut before, truth), sends) in ways.into_iter().rev() {
            let other = match first_only {
                true => std::mem::take(&mut inner),
                false => Vec::new(),
            };
            before.push(Step::If(truth.text, sends, other));
            before.append(&mut inner);
            inner = before;
        }
        steps.extend(inner);
        steps.extend(self.done(to.node));
        steps
    }

    fn enter(&mut self, to: To, instance: u32) -> Vec<Step> {
        let program = self.plan.program;
        let Some(body) = program.instances.get(instance as usize) else {
            return Vec::new();
        };
        let begun = self.number(to.node, "begun", 0);
        let mut first = vec![Step::Set(begun.clone(), "1".to_owned())];
        first.extend(body.starts.iter().map(|&start| self.unit_to(start)));
        let is_new = self.say(Word::EqualNumbers, &[&begun, "0"]);
        let mut steps = vec![Step::If(is_new, first, Vec::new())];
        let inputs = body.inputs.iter().filter(|(port, _)| *port == to.port);
        steps.extend(inputs.flat_map(|&(_, input)| self.send(input, 0, "token")));
        steps
    }

    fn variable(&mut self, to: To, run: Option<Formula>, names: &[Rc<str>]) -> Vec<Step> {
        const OUT: u8 = 3;
        let fields: Vec<String> = names
            .iter()
            .map(|name| {
                let name = self.plan.variable(name);
                self.field(&name)
            })
            .collect();
        let mut steps = Vec::new();
        if to.port == CONTROL {
            if let Some(run) = run {
                let (before, value) = text(self.plan, run);
                steps.extend(before);
                let ignored = value.map(|value| self.say(Word::Ignore, &[&value.text]));
                steps.extend(ignored.map(Step::Do));
            }
        } else if let [field] = &fields[..] {
            let needed = self.say(Word::NeedsValue, &["token"]);
            steps.push(Step::Set(field.clone(), needed));
        } else {
            let count = fields.len().to_string();
            steps.push(Step::Do(self.say(Word::NeedsItems, &["token", &count])));
            for (at, field) in fields.iter().enumerate() {
                let item = self.say(Word::Item, &["token", &at.to_string()]);
                steps.push(Step::Set(field.clone(), item));
            }
        }
        let has_targets = !self.plan.program.node(to.node).outs[usize::from(OUT)].is_empty();
        if let (true, Some(first)) = (has_targets, fields.first()) {
            let value = self.say(Word::NeedsValue, &[first]);
            steps.extend(self.send_made(to.node, OUT, &Phrase::atom(value)));
        }
        steps.extend(self.done(to.node));
        steps
    }

    /// Readings of the sensors that are on, in the order of blocks.
    fn poll(&mut self) -> Vec<Step> {
        let program = self.plan.program;
        let mut steps = Vec::new();
        for id in 0..program.nodes.len() as NodeId {
            match &program.node(id).op {
                // Nobody gets it.
                Op::Source(Source::Sensor(_)) if program.node(id).outs[1].is_empty() => {}
                Op::Source(Source::Sensor(sensor)) => {
                    let is_on = self.number(id, "on", 0);
                    let reading = self.field(&self.plan.reading(*sensor));
                    let when = self.say(Word::EqualNumbers, &[&is_on, "1"]);
                    steps.push(Step::If(when, self.send(id, 1, &reading), Vec::new()));
                }
                Op::Source(Source::Encoders(devices)) => {
                    for (at, &(port, _)) in devices.iter().enumerate() {
                        let Some((is_on, from, reading)) = self.encoder(id, at, port) else {
                            continue;
                        };
                        let reading = self.say(Word::Number, &[&reading]);
                        let turned = self.say(Word::Subtract, &[&reading, &from]);
                        let value = self.say(Word::ValueOfNumber, &[&turned]);
                        let when = self.say(Word::EqualNumbers, &[&is_on, "1"]);
                        let port = (ENCODER_OUT + at) as u8;
                        let sends = self.send_made(id, port, &Phrase::atom(value));
                        steps.push(Step::If(when, sends, Vec::new()));
                    }
                }
                Op::Source(Source::Detect(_) | Source::Gamepad | Source::Receive)
                | Op::Flow(_)
                | Op::Act(_) => {}
            }
        }
        steps
    }
}
