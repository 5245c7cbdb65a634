//! A data-flow program under judgement.
//!
//! Owns the border between the judge and the machine of `lang_dataflow`, which has a debugger's desk about it. Knows no rules
//! and no orders.

use super::program::{Program, Running, Spot};
use super::track::Group;
use lang_dataflow::debug::Desk;
use lang_dataflow::machine::Machine;
use lang_dataflow::machine::trace::{Deaf, Trace};
use lang_dataflow::program::{NodeId, Program as Lowered};
use lang_diagram::brick::Brick;
use lang_diagram::limits::HISTORY_BYTES;
use lang_diagram::machine::Status;
use lang_text::problem::{Locale, Problem, Words};
use std::rc::Rc;

/// A data-flow program. It has no threads: what it did last is the block that reacted last.
#[derive(Debug)]
pub struct Dataflow {
    desk: Desk,
    last: Last,
}

/// The block that reacted last.
#[derive(Debug, Default)]
struct Last(Option<NodeId>);

impl Trace for Last {
    fn fired(&mut self, _now: u32, node: NodeId) {
        self.0 = Some(node);
    }
}

impl Dataflow {
    /// Before its first instant. `locale` is that of a debugger, if one comes.
    pub fn new(program: Rc<Lowered>, locale: Locale) -> Self {
        Self {
            desk: Desk::new(Machine::new(program), locale, HISTORY_BYTES),
            last: Last::default(),
        }
    }

    /// Takes orders while the program is not in a step.
    pub(super) fn desk(&mut self) -> &mut Desk {
        &mut self.desk
    }

    fn machine(&self) -> &Machine {
        self.desk.machine()
    }

    /// Milliseconds of its time.
    pub(super) fn now(&self) -> u32 {
        self.machine().now()
    }
}

impl Program for Dataflow {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        self.desk.step(now_ms, robot, &mut self.last)
    }

    fn is_held(&self) -> bool {
        self.desk.is_stopped()
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        self.desk.stop(robot, &mut Deaf);
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        if let Some(id) = self.last.0 {
            let row = self.machine().program().node(id).row;
            tell(Group::Block, "flow", row.shown_in(locale));
        }
        for (name, value) in self.machine().variables() {
            tell(Group::Variable, name, &value.brief());
        }
    }

    fn errors(&self) -> &[Problem] {
        self.machine().errors()
    }

    fn warnings(&self) -> &[Problem] {
        self.machine().warnings()
    }

    fn running(&self) -> Vec<Running> {
        let program = self.machine().program();
        let at = self.last.0.map(|id| {
            let node = program.node(id);
            let instance = program.instances.get(node.instance as usize);
            Running {
                thread: "flow".to_owned(),
                ended_ms: match self.machine().status() {
                    Status::Running => None,
                    Status::Ended { at, .. } => Some(at),
                },
                at: Spot::Block {
                    diagram: instance.map_or_else(String::new, |one| one.name.to_string()),
                    id: node.id.to_string(),
                    kind: node.row.element.to_owned(),
                    // A person knows a block by its label; the type stands beside it.
                    caption: match node.caption.is_empty() {
                        true => Words::new(node.row.shown, node.row.russian),
                        false => Words::new(&*node.caption, &*node.caption),
                    },
                },
            }
        });
        at.into_iter().collect()
    }
}
