//! What blocks do with tokens: those that compute, steer, wait and arbitrate.
//!
//! Owns one reaction at a time; devices are in `act`. Knows no order of tokens. Numbers of ports are those of the rows.

use super::state::Memory;
use super::values::{self, is_unit};
use super::words;
use super::{Env, Halt, Machine};
use crate::program::{Flow, Formula, Gathers, NodeId, Op, Target};
use lang_diagram::machine::STEP_MS;
use lang_expr::Value;
use std::rc::Rc;

/// Inputs and outputs of a function: I0 and O0 are 2 and 3.
const FUNCTION_IN: usize = 2;
const FUNCTION_OUT: u8 = 3;
/// The control input of most blocks.
const CONTROL: u8 = 0;

impl Machine {
    /// A token comes to a block that does not wait for several.
    pub(super) fn react(
        &mut self,
        to: Target,
        value: Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        match &env.program.node(to.node).op {
            Op::Flow(flow) => self.flow(to, value, flow, env),
            Op::Source(source) => self.start_source(to, &value, source, env),
            Op::Act(act) => self.act(to, &value, act, env),
        }
    }

    fn flow(
        &mut self,
        to: Target,
        value: Value,
        flow: &Flow,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let id = to.node;
        match flow {
            Flow::Stop => Err(Halt::Stop),
            Flow::Function { waits, texts } => self.function_token(to, value, *waits, texts, env),
            Flow::If(condition) => self.decide(to, value, *condition, env),
            Flow::Switch { arms, first_only } => self.switch(to, value, arms, *first_only, env),
            Flow::Loop { time_ms, .. } => self.count_token(to, value, *time_ms, env),
            Flow::Call(instance) => self.enter(to, value, *instance, env),
            Flow::InPort | Flow::Zip => Ok(()),
            Flow::OutPort(target) => match *target {
                Some(Target { node, port }) => self.send(node, port, &value, env),
                None => Ok(()),
            },
            Flow::Constant(constant) => self.send(id, 1, constant, env),
            Flow::Variable { run, names } => self.variable(to, value, *run, names, env),
            Flow::Random { bounds, every_ms } => match every_ms {
                Some(every) => {
                    self.set_timer(id, self.now.saturating_add(round_up(*every)));
                    Ok(())
                }
                None => self.random(id, *bounds, env),
            },
            Flow::Filter {
                quiet_ms,
                condition,
                ..
            } => self.filter(to, value, *quiet_ms, *condition, env),
            Flow::Wait { keeps, .. } => self.hold(to, value, *keeps, env),
            Flow::Replace(_) | Flow::Inhibit(_) => self.window(to, value, env),
            Flow::Unzip => self.unzip(to, &value, env),
        }
    }

    /// A block has a token at each of its linked data inputs, which are taken away.
    pub(super) fn react_to_all(&mut self, id: NodeId, env: &mut Env<'_>) -> Result<(), Halt> {
        let Some(gathers) = env.program.node(id).gathers() else {
            return Ok(());
        };
        match gathers {
            Gathers::Function(texts) => {
                for at in 0..texts.len() {
                    if let Some(value) = self.take(id, FUNCTION_IN + 2 * at) {
                        self.bind(id, at, &value);
                    }
                }
                self.compute_all(id, texts, env)
            }
            Gathers::Drive(devices) => {
                for (port, (device, _)) in (FUNCTION_IN..).zip(devices) {
                    if let Some(value) = self.take(id, port) {
                        let from = Target {
                            node: id,
                            port: port as u8,
                        };
                        self.drive(from, *device, &value, env)?;
                    }
                }
                self.done(id, env)
            }
            // DATA1, OUT, DATA2.
            Gathers::Zip => match [self.take(id, 0), self.take(id, 2)] {
                [Some(one), Some(other)] => {
                    self.send_made(id, 1, &values::list(vec![one, other]), env)
                }
                _ => Ok(()),
            },
        }
    }

    /// The same of a block whose only linked data input is this one.
    pub(super) fn react_to_one(
        &mut self,
        to: Target,
        value: &Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Some(gathers) = env.program.node(to.node).gathers() else {
            return Ok(());
        };
        let port = usize::from(to.port).saturating_sub(FUNCTION_IN);
        match gathers {
            Gathers::Function(texts) => {
                self.bind(to.node, port / 2, value);
                self.compute_all(to.node, texts, env)
            }
            Gathers::Drive(devices) => {
                if let Some((device, _)) = devices.get(port) {
                    self.drive(to, *device, value, env)?;
                }
                self.done(to.node, env)
            }
            // One token is no pair.
            Gathers::Zip => Ok(()),
        }
    }

    pub(super) fn bind(&mut self, id: NodeId, at: usize, value: &Value) {
        self.formulas
            .bind(id, at, value, &mut self.states[id as usize]);
    }

    fn function_token(
        &mut self,
        to: Target,
        value: Value,
        waits: bool,
        texts: &[Option<Formula>; 6],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let node = env.program.node(to.node);
        if to.port == CONTROL {
            // A start means nothing to a function that has inputs.
            return match node.data {
                0 => self.compute_all(to.node, texts, env),
                _ => Ok(()),
            };
        }
        debug_assert!(!waits, "its tokens are queued");
        let at = (usize::from(to.port) - FUNCTION_IN) / 2;
        self.bind(to.node, at, &value);
        if let Some(text) = texts[at] {
            self.compute(to.node, at, text, env)?;
        }
        self.done(to.node, env)
    }

    fn compute_all(
        &mut self,
        id: NodeId,
        texts: &[Option<Formula>; 6],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        for (at, text) in texts.iter().enumerate() {
            // Most functions have one text: no call for the others.
            if let Some(text) = *text {
                self.compute(id, at, text, env)?;
            }
        }
        self.done(id, env)
    }

    fn compute(
        &mut self,
        id: NodeId,
        at: usize,
        text: Formula,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let mut value = Value::Nil;
        self.evaluate_to(text, &mut value, env)?;
        self.send_made(id, FUNCTION_OUT + 2 * at as u8, &value, env)
    }

    /// Sends a value that was made here, unless it is too large for a token.
    fn send_made(
        &mut self,
        id: NodeId,
        port: u8,
        value: &Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        if !values::fits(value) {
            let at = Target { node: id, port };
            return Err(self.fault_at_port(at, words::too_large_token(), env));
        }
        self.send(id, port, value, env)
    }

    fn decide(
        &mut self,
        to: Target,
        value: Value,
        condition: Formula,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        if to.port != CONTROL {
            self.bind(to.node, 0, &value);
        }
        let port = if self.truth(condition, env)? { 2 } else { 3 };
        self.send(to.node, port, &value, env)
    }

    fn switch(
        &mut self,
        to: Target,
        value: Value,
        arms: &[(Option<Formula>, Option<Formula>); 6],
        first_only: bool,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        if to.port != CONTROL {
            self.bind(to.node, 0, &value);
        }
        for (port, (condition, text)) in (3..).zip(arms) {
            let holds = match condition {
                Some(condition) => self.truth(*condition, env)?,
                None => false,
            };
            if holds {
                let value = match text {
                    Some(text) => self.evaluate(*text, env)?,
                    // A start lets the last token through.
                    None if to.port == CONTROL => {
                        let state = &self.states[to.node as usize];
                        let last = self.formulas.own(to.node, 0, state);
                        last.unwrap_or_else(|| value.clone())
                    }
                    None => value.clone(),
                };
                self.send_made(to.node, port, &value, env)?;
                if first_only {
                    break;
                }
            }
        }
        self.done(to.node, env)
    }

    fn count_token(
        &mut self,
        to: Target,
        value: Value,
        time_ms: u32,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        // FROM, TO, STEP, CF_IN.
        const START: u8 = 3;
        let number = match to.port {
            START => None,
            _ => Some(self.whole(to, &value, env)?),
        };
        let Memory::Count { bounds, next } = &mut self.states[to.node as usize].memory else {
            return Ok(());
        };
        if let Some(number) = number {
            bounds[usize::from(to.port)] = number;
            return Ok(());
        }
        let [from, last, step] = *bounds;
        if step == 0 {
            return Err(self.fault(to.node, words::loop_step(), env));
        }
        if is_over(from, last, step) {
            *next = None;
            self.cancel_timer(to.node);
            return self.done(to.node, env);
        }
        *next = Some(from);
        self.set_timer(to.node, self.now.saturating_add(round_up(time_ms)));
        Ok(())
    }

    /// The time of a loop is over: it gives a number.
    fn count_on(
        &mut self,
        id: NodeId,
        due: u32,
        time_ms: u32,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Memory::Count { bounds, next } = &mut self.states[id as usize].memory else {
            return Ok(());
        };
        let (Some(number), [_, last, step]) = (*next, *bounds) else {
            return Ok(());
        };
        if step == 0 {
            return Err(self.fault(id, words::loop_step(), env));
        }
        // TO and STEP may have changed since.
        if is_over(number, last, step) {
            *next = None;
            return self.done(id, env);
        }
        let following = number
            .checked_add(step)
            .filter(|&one| !is_over(one, last, step));
        *next = following;
        self.send(id, 5, &Value::Int(number), env)?;
        match following {
            Some(_) => self.repeat(id, due, round_up(time_ms)),
            None => self.done(id, env)?,
        }
        Ok(())
    }

    /// Sets a timer anew, a period after the time at which it was due; one that is late for more than a period counts from
    /// now.
    fn repeat(&mut self, id: NodeId, due: u32, period: u32) {
        let next = due.saturating_add(period);
        let next = if next > self.now {
            next
        } else {
            self.now.saturating_add(period)
        };
        self.set_timer(id, next);
    }

    /// A timer of a node is due.
    pub(super) fn timer(&mut self, id: NodeId, due: u32, env: &mut Env<'_>) -> Result<(), Halt> {
        let Op::Flow(flow) = &env.program.node(id).op else {
            return Ok(());
        };
        match flow {
            Flow::Loop { time_ms, .. } => self.count_on(id, due, *time_ms, env),
            Flow::Random { bounds, every_ms } => {
                self.random(id, *bounds, env)?;
                if let Some(every_ms) = every_ms {
                    self.repeat(id, due, round_up(*every_ms));
                }
                Ok(())
            }
            Flow::Wait { .. } => self.end_hold(id, env),
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
            | Flow::Unzip => Ok(()),
        }
    }

    fn enter(
        &mut self,
        to: Target,
        value: Value,
        instance: u32,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Some(body) = env.program.instances.get(instance as usize) else {
            return Ok(());
        };
        if let Memory::Begun(begun) = &mut self.states[to.node as usize].memory
            && !std::mem::replace(begun, true)
        {
            let starts = body.starts.iter().map(|&start| (start, Value::Nil));
            self.deliveries.extend(starts);
        }
        for &(port, input) in &body.inputs {
            if port == to.port {
                self.send(input, 0, &value, env)?;
            }
        }
        Ok(())
    }

    fn variable(
        &mut self,
        to: Target,
        value: Value,
        run: Option<Formula>,
        names: &[Rc<str>],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        const OUT: u8 = 3;
        if to.port == CONTROL {
            if let Some(run) = run {
                self.evaluate(run, env)?;
            }
        } else {
            self.assign(to, value, names, env)?;
        }
        let node = env.program.node(to.node);
        if !node.outs[usize::from(OUT)].is_empty()
            && let Some(name) = names.first()
        {
            let Some(value) = self.formulas.get(name) else {
                return Err(self.fault(to.node, words::unbound(name), env));
            };
            self.send_made(to.node, OUT, &value, env)?;
        }
        self.done(to.node, env)
    }

    fn assign(
        &mut self,
        to: Target,
        value: Value,
        names: &[Rc<str>],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let values = match names {
            [_] if is_unit(&value) => Err(words::unit()),
            [_] => Ok(vec![value]),
            _ => values::items(&value).and_then(|items| match items.len() < names.len() {
                true => Err(words::list_short(items.len(), names.len())),
                false => Ok(items.to_vec()),
            }),
        };
        let values = values.map_err(|words| self.fault_at_port(to, words, env))?;
        for (name, value) in names.iter().zip(values) {
            let assigned = self.formulas.assign(name, value);
            assigned.map_err(|words| self.fault_at_port(to, words, env))?;
        }
        Ok(())
    }

    fn random(&mut self, id: NodeId, bounds: [Formula; 2], env: &mut Env<'_>) -> Result<(), Halt> {
        let mut ends = [0; 2];
        for (end, formula) in ends.iter_mut().zip(bounds) {
            *end = self.evaluate(formula, env)?.to_int();
        }
        ends.sort_unstable();
        let number = env.brick.random(ends[0], ends[1]);
        self.send(id, 1, &Value::Int(number), env)
    }

    fn filter(
        &mut self,
        to: Target,
        value: Value,
        quiet_ms: u32,
        condition: Formula,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        // DISPATCH_TIME, FAILURE, COUNT, OUT, DATA.
        const DATA: u8 = 4;
        let number = match to.port {
            DATA => 0,
            _ => self.whole(to, &value, env)?,
        };
        let Memory::Gate {
            pause_ms,
            count,
            last,
        } = &mut self.states[to.node as usize].memory
        else {
            return Ok(());
        };
        match to.port {
            0 => *pause_ms = number,
            2 => *count = number,
            _ if *count == 0 => return self.send(to.node, 1, &Value::Nil, env),
            _ => {
                let pause = u32::try_from(*pause_ms).unwrap_or(0);
                let is_early =
                    self.now < quiet_ms || last.is_some_and(|last| self.now - last < pause);
                if is_early {
                    return Ok(());
                }
                self.bind(to.node, 0, &value);
                if !self.truth(condition, env)? {
                    return self.send(to.node, 1, &Value::Nil, env);
                }
                if let Memory::Gate { count, last, .. } = &mut self.states[to.node as usize].memory
                {
                    *count -= i32::from(*count > 0);
                    *last = Some(self.now);
                }
                return self.send(to.node, 3, &value, env);
            }
        }
        Ok(())
    }

    fn window(&mut self, to: Target, value: Value, env: &mut Env<'_>) -> Result<(), Halt> {
        // The stream that opens the window, DATA, OUT, TIME.
        let time = match to.port {
            3 => Some(self.whole(to, &value, env)?),
            _ => None,
        };
        let replaces = matches!(env.program.node(to.node).op, Op::Flow(Flow::Replace(_)));
        let Memory::Window { ms, since } = &mut self.states[to.node as usize].memory else {
            return Ok(());
        };
        if let Some(time) = time {
            *ms = time;
            return Ok(());
        }
        let passes = if to.port == 0 {
            *since = Some(self.now);
            replaces
        } else {
            let time = u32::try_from(*ms).unwrap_or(0);
            since.is_none_or(|since| self.now - since >= time)
        };
        match passes {
            true => self.send(to.node, 2, &value, env),
            false => Ok(()),
        }
    }

    fn unzip(&mut self, to: Target, value: &Value, env: &mut Env<'_>) -> Result<(), Halt> {
        let items = values::items(value).map_err(|words| self.fault_at_port(to, words, env))?;
        let [one, other, ..] = items else {
            let words = words::list_short(items.len(), 2);
            return Err(self.fault_at_port(to, words, env));
        };
        self.send(to.node, 1, one, env)?;
        self.send(to.node, 2, other, env)
    }
}

/// Whether a loop has nothing more to give.
fn is_over(next: i32, last: i32, step: i32) -> bool {
    if step > 0 { next > last } else { next < last }
}

/// A time above 0 as timers keep it.
fn round_up(ms: u32) -> u32 {
    ms.max(1).div_ceil(STEP_MS).saturating_mul(STEP_MS)
}
