//! What blocks do that know the time: gates, windows, waits and loops.
//!
//! Owns their statements and those of their timers. Knows no language.

use super::super::code::{Phrase, truth};
use super::super::language::Word;
use super::super::step::Step;
use super::{CONTROL, Writer};
use crate::program::{Flow, Formula, NodeId, Op, Target as To};
use lang_diagram::machine::STEP_MS;

/// Long before any program began.
const NEVER: f64 = -1e18;

impl Writer<'_, '_> {
    pub(super) fn filter(
        &mut self,
        to: To,
        quiet_ms: u32,
        condition: Formula,
        count: i32,
        pause_ms: u32,
    ) -> Vec<Step> {
        let id = to.node;
        let pause = self.number(id, "pause", pause_ms);
        let left = self.number(id, "count", count);
        let last = self.number(id, "last", NEVER);
        let whole = self.say(Word::AsWhole, &["token"]);
        match to.port {
            0 => return vec![Step::Set(pause, whole)],
            2 => return vec![Step::Set(left, whole)],
            _ => {}
        }
        let failure = self.send_unit(id, 1);
        let mut passes = vec![
            Step::If(
                self.say(Word::Greater, &[&left, "0"]),
                vec![Step::Set(
                    left.clone(),
                    self.say(Word::Subtract, &[&left, "1"]),
                )],
                Vec::new(),
            ),
            Step::Set(last.clone(), self.now()),
        ];
        passes.extend(self.send(id, 3, "token"));
        let data = self.value(id, "data");
        let (before, truth) = truth(self.plan, condition);
        let mut open = vec![Step::Set(data, "token".to_owned())];
        open.extend(before);
        open.push(Step::If(truth.text, passes, failure.clone()));
        let quiet = quiet_ms.to_string();
        let since = self.say(Word::Subtract, &[&self.now(), &last]);
        let is_late = self.say(Word::GreaterEqual, &[&since, &pause]);
        let is_over = self.say(Word::GreaterEqual, &[&self.now(), &quiet]);
        let gate = Step::If(
            is_over,
            vec![Step::If(is_late, open, Vec::new())],
            Vec::new(),
        );
        let none = self.say(Word::EqualNumbers, &[&left, "0"]);
        vec![Step::If(none, failure, vec![gate])]
    }

    pub(super) fn window(&mut self, to: To, ms: i32, replaces: bool) -> Vec<Step> {
        let time = self.number(to.node, "time", ms);
        let since = self.number(to.node, "since", NEVER);
        match to.port {
            0 => {
                let mut steps = vec![Step::Set(since, self.now())];
                if replaces {
                    steps.extend(self.send(to.node, 2, "token"));
                }
                steps
            }
            3 => vec![Step::Set(time, self.say(Word::AsWhole, &["token"]))],
            _ => {
                let passed = self.say(Word::Subtract, &[&self.now(), &since]);
                let is_open = self.say(Word::GreaterEqual, &[&passed, &time]);
                vec![Step::If(
                    is_open,
                    self.send(to.node, 2, "token"),
                    Vec::new(),
                )]
            }
        }
    }

    pub(super) fn hold(&mut self, to: To, ms: i32) -> Vec<Step> {
        const TIME: u8 = 4;
        let time = self.number(to.node, "time", ms);
        let holds = self.number(to.node, "holds", 0);
        let held = self.value(to.node, "held");
        let free = self.say(Word::EqualNumbers, &[&holds, "0"]);
        if to.port == TIME {
            let whole = self.say(Word::AsWhole, &["token"]);
            return vec![Step::If(free, vec![Step::Set(time, whole)], Vec::new())];
        }
        let kind = if to.port == CONTROL { "1" } else { "2" };
        let mut taken = vec![Step::Set(holds, kind.to_owned())];
        if to.port != CONTROL {
            taken.push(Step::Set(held, "token".to_owned()));
        }
        let steps = self.say(Word::RoundUp, &[&time]);
        taken.push(self.set_timer(to.node, &steps));
        vec![Step::If(free, taken, Vec::new())]
    }

    fn set_timer(&self, id: NodeId, after: &str) -> Step {
        let due = self.say(Word::Add, &[&self.now(), after]);
        let timer = self.plan.timer(id).to_string();
        Step::Do(self.say(Word::SetTimer, &[&timer, &due]))
    }

    pub(super) fn count(&mut self, to: To, bounds: [i32; 3], time_ms: u32) -> Vec<Step> {
        // FROM, TO, STEP, CF_IN.
        const START: u8 = 3;
        let [from, last, step] = self.bounds(to.node, bounds);
        let next = self.number(to.node, "next", 0);
        let runs = self.number(to.node, "runs", 0);
        if to.port != START {
            let changed = [from, last, step].into_iter().nth(usize::from(to.port));
            let whole = self.say(Word::AsWhole, &["token"]);
            return changed
                .map(|bound| Step::Set(bound, whole))
                .into_iter()
                .collect();
        }
        let timer = self.plan.timer(to.node).to_string();
        let mut over = vec![
            Step::Set(runs.clone(), "0".to_owned()),
            Step::Do(self.say(Word::Cancel, &[&timer])),
        ];
        over.extend(self.done(to.node));
        let begins = vec![
            Step::Set(runs, "1".to_owned()),
            Step::Set(next, from.clone()),
            self.set_timer(to.node, &period(time_ms)),
        ];
        let is_over = self.say(Word::IsOver, &[&from, &last, &step]);
        let stands = self.say(Word::EqualNumbers, &[&step, "0"]);
        vec![Step::If(
            stands,
            vec![self.fail("the step of a loop is 0")],
            vec![Step::If(is_over, over, begins)],
        )]
    }

    fn bounds(&mut self, id: NodeId, bounds: [i32; 3]) -> [String; 3] {
        [
            self.number(id, "from", bounds[0]),
            self.number(id, "to", bounds[1]),
            self.number(id, "step", bounds[2]),
        ]
    }

    /// A timer of a node is due.
    pub(super) fn tick(&mut self, id: NodeId) -> Vec<Step> {
        let Op::Flow(flow) = &self.plan.program.node(id).op else {
            return Vec::new();
        };
        match flow {
            Flow::Loop { bounds, time_ms } => self.count_on(id, *bounds, *time_ms),
            Flow::Wait { .. } => {
                let holds = self.number(id, "holds", 0);
                let held = self.value(id, "held");
                let has_token = self.say(Word::EqualNumbers, &[&holds, "2"]);
                let mut steps = vec![Step::If(has_token, self.send(id, 3, &held), Vec::new())];
                steps.push(Step::Set(holds, "0".to_owned()));
                steps.extend(self.done(id));
                steps
            }
            Flow::Stop
            | Flow::Function { .. }
            | Flow::If(_)
            | Flow::Switch { .. }
            | Flow::Call(_)
            | Flow::InPort
            | Flow::OutPort(_)
            | Flow::Constant(_)
            | Flow::Variable { .. }
            | Flow::Random { .. }
            | Flow::Filter { .. }
            | Flow::Replace(_)
            | Flow::Inhibit(_)
            | Flow::Zip
            | Flow::Unzip => Vec::new(),
        }
    }

    fn count_on(&mut self, id: NodeId, bounds: [i32; 3], time_ms: u32) -> Vec<Step> {
        let [_, last, step] = self.bounds(id, bounds);
        let next = self.number(id, "next", 0);
        let runs = self.number(id, "runs", 0);
        let timer = self.plan.timer(id).to_string();
        let mut over = vec![Step::Set(runs.clone(), "0".to_owned())];
        over.extend(self.done(id));
        let mut gives = self.send_made(
            id,
            5,
            &Phrase::atom(self.say(Word::ValueOfNumber, &[&next])),
        );
        gives.push(Step::Set(
            next.clone(),
            self.say(Word::Add, &[&next, &step]),
        ));
        let again = self.say(Word::Repeat, &[&timer, "due", &period(time_ms)]);
        // A number beyond 32 bits is over too: nothing is between the last one and it.
        let is_over = self.say(Word::IsOver, &[&next, &last, &step]);
        gives.push(Step::If(
            is_over.clone(),
            over.clone(),
            vec![Step::Do(again)],
        ));
        let stands = self.say(Word::EqualNumbers, &[&step, "0"]);
        let fails = vec![self.fail("the step of a loop is 0")];
        let is_running = self.say(Word::EqualNumbers, &[&runs, "1"]);
        let goes = vec![Step::If(
            stands,
            fails,
            vec![Step::If(is_over, over, gives)],
        )];
        vec![Step::If(is_running, goes, Vec::new())]
    }
}

/// A period as timers keep it.
fn period(ms: u32) -> String {
    ms.max(1)
        .div_ceil(STEP_MS)
        .saturating_mul(STEP_MS)
        .to_string()
}
