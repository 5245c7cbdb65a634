//! A project to a program: blocks to operations, links to targets, properties to texts and expressions.
//!
//! Owns the tables of the program and what is wrong with the project as far as one block with its links shows it. Knows
//! no expressions: it only keeps their texts. What the original says when the flow reaches a bad block is told here at
//! once, and the machine tells it then.

mod links;
mod properties;

use std::collections::HashMap;
use std::rc::Rc;

use super::blocks::{self, Act, Does, Row, Silent, Wait, foreign};
use super::devices;
use super::ports::{Direction, Kit, Port};
use super::program::{
    Action, Argument, ArgumentKind, Assignment, Call, Copying, DiagramName, Message, NOWHERE, Node,
    Op, Program, Sign, Source, Spot, Text, WatchedFor, Watching,
};
use super::project::{Block, Diagram, DiagramKind, Project};
use super::words;
use crate::limits;
use lang_text::problem::{Place, Problem, Words};
use properties::text;

/// Where a program runs: some blocks do nothing in some places.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum World {
    /// In a simulator.
    Simulated {
        /// Whether robots can send messages to each other there.
        mailbox: bool,
        /// Whether somebody may have a gamepad there. The original's simulator knows of none.
        gamepad: bool,
    },
    /// On a robot, or on a tree of files that stands for one.
    Robot,
}

impl Default for World {
    fn default() -> Self {
        Self::Simulated {
            mailbox: false,
            gamepad: false,
        }
    }
}

/// A program, and all that is wrong with it.
#[derive(Clone, Debug)]
pub struct Lowered {
    /// Ready to run: faulty blocks tell their fault when they are reached.
    pub program: Program,
    /// Everything that can be told without running it, but for expressions.
    pub problems: Vec<Problem>,
}

/// Makes a project ready to run.
///
/// # Errors
/// The project has more blocks than [`limits::NODES_MAX`].
pub fn lower(project: &Project, world: World) -> Result<Lowered, Problem> {
    let nodes: usize = project
        .diagrams
        .iter()
        .map(|diagram| diagram.blocks.len())
        .sum();
    if nodes > limits::NODES_MAX {
        let words = words::too_large(nodes, limits::NODES_MAX);
        return Err(Problem::error(words));
    }
    let mut lowering = Lowering::new(project, world);
    for (index, diagram) in project.diagrams.iter().enumerate() {
        lowering.diagram(index as u32, diagram);
    }
    if project.main.is_none() {
        lowering.problems.push(Problem::error(words::no_main()));
    }
    let mut lowered = lowering.finish(project);
    if world != World::Robot
        && let Some(problem) = devices::mismatch(project, &lowered.program)
    {
        lowered.problems.push(problem.clone());
        lowered.program.refusal = Some(problem);
    }
    Ok(lowered)
}

/// Tables that grow.
struct Lowering<'a> {
    world: World,
    kit: Kit,
    rows: HashMap<&'static str, &'static Row>,
    /// Diagrams by their logical ids.
    called: HashMap<&'a str, u32>,
    ops: Vec<Op>,
    spots: Vec<Spot>,
    entries: Vec<Option<Node>>,
    sources: Vec<Text>,
    faults: Vec<Problem>,
    problems: Vec<Problem>,
    switches: Vec<super::program::Switch>,
    forks: Vec<super::program::Fork>,
    joins: Vec<super::program::Join>,
    calls: Vec<Call>,
    messages: Vec<Message>,
    assignments: Vec<Assignment>,
    copies: Vec<Copying>,
    actions: Vec<Action>,
    watches: Vec<Watching>,
    loops: u32,
    /// Where a node begins: of the present diagram.
    base: Node,
}

/// One block with what is needed to look around.
#[derive(Clone, Copy)]
struct At<'a> {
    diagram: &'a Diagram,
    block: &'a Block,
    row: &'static Row,
    base: Node,
}

impl<'a> Lowering<'a> {
    fn new(project: &'a Project, world: World) -> Self {
        let mut called = HashMap::new();
        for (index, diagram) in project.diagrams.iter().enumerate() {
            called
                .entry(diagram.logical.as_str())
                .or_insert(index as u32);
        }
        let kit = project.meta.get("lastKitId");
        Self {
            world,
            kit: kit.and_then(|id| Kit::of_id(id)).unwrap_or_default(),
            rows: blocks::table().map(|row| (row.kind, row)).collect(),
            called,
            ops: Vec::new(),
            spots: Vec::new(),
            entries: Vec::new(),
            sources: Vec::new(),
            faults: Vec::new(),
            problems: Vec::new(),
            switches: Vec::new(),
            forks: Vec::new(),
            joins: Vec::new(),
            calls: Vec::new(),
            messages: Vec::new(),
            assignments: Vec::new(),
            copies: Vec::new(),
            actions: Vec::new(),
            watches: Vec::new(),
            loops: 0,
            base: 0,
        }
    }

    fn finish(self, project: &Project) -> Lowered {
        let sheets = project.diagrams.iter().map(|diagram| DiagramName {
            id: diagram.id.as_str().into(),
            name: diagram.name.as_str().into(),
        });
        let program = Program {
            ops: self.ops.into(),
            spots: self.spots.into(),
            entries: self.entries.into(),
            diagrams: sheets.collect(),
            main: project.main.map(|main| main as u32),
            sources: self.sources.into(),
            faults: self.faults.into(),
            switches: self.switches.into(),
            forks: self.forks.into(),
            joins: self.joins.into(),
            calls: self.calls.into(),
            messages: self.messages.into(),
            assignments: self.assignments.into(),
            copies: self.copies.into(),
            actions: self.actions.into(),
            watches: self.watches.into(),
            refusal: None,
            has_gamepad: !matches!(self.world, World::Simulated { gamepad: false, .. }),
            loops: self.loops,
            kit: self.kit,
        };
        Lowered {
            program,
            problems: self.problems,
        }
    }

    fn diagram(&mut self, index: u32, diagram: &'a Diagram) {
        self.base = self.ops.len() as Node;
        let starts = |block: &&Block| block.kind == "InitialNode";
        let first = diagram.blocks.iter().position(|block| starts(&block));
        self.entries
            .push(first.map(|first| self.base + first as Node));
        let place = Place {
            diagram: Some(diagram.name.clone()),
            object: Some(diagram.id.clone()),
            ..Place::default()
        };
        let is_used = diagram.kind == DiagramKind::Main || !diagram.blocks.is_empty();
        if first.is_none() && is_used {
            let problem = Problem::warning(words::no_entry());
            self.problems.push(Problem { place, ..problem });
        } else if diagram.blocks.iter().filter(starts).count() > 1 {
            let problem = Problem::warning(words::several_entries());
            self.problems.push(Problem { place, ..problem });
        }
        for block in &diagram.blocks {
            self.block(index, diagram, block);
        }
    }

    fn block(&mut self, index: u32, diagram: &'a Diagram, block: &'a Block) {
        let row = self.rows.get(block.kind.as_str()).copied();
        self.spots.push(Spot {
            id: block.id.as_str().into(),
            diagram: index,
            row,
            position: block.position,
        });
        let before = self.problems.len();
        let base = self.base;
        let made = match row {
            Some(row) => self.known(At {
                diagram,
                block,
                row,
                base,
            }),
            None => {
                let words = match foreign::find(&block.kind) {
                    Some((kit, name)) => words::foreign_block(name, kit.name()),
                    None => words::unknown_block(&block.kind),
                };
                self.problems.push(Problem::warning(words));
                links::single(diagram, block, base).map(|next| Op::Pass { next })
            }
        };
        let place = Place {
            diagram: Some(diagram.name.clone()),
            object: Some(block.id.clone()),
            block: Some(row.map_or_else(|| block.kind.clone(), |row| row.shown.to_owned())),
            ..Place::default()
        };
        let op = made.unwrap_or_else(|words| {
            let mut problem = Problem::error(words);
            problem.place = place.clone();
            self.faults.push(problem.clone());
            self.problems.push(problem);
            Op::Fault {
                fault: self.faults.len() as u32 - 1,
            }
        });
        for problem in &mut self.problems[before..] {
            let property = problem.place.property.take();
            problem.place = Place {
                property,
                ..place.clone()
            };
        }
        self.ops.push(op);
    }

    /// A warning at the present block.
    fn warn(&mut self, words: Words, property: Option<&str>) {
        let mut problem = Problem::warning(words);
        problem.place.property = property.map(str::to_owned);
        self.problems.push(problem);
    }

    fn known(&mut self, at: At<'a>) -> Result<Op, Words> {
        if !at.row.is_of(self.kit) {
            self.warn(words::other_kit(at.row.kind), None);
            let next = links::single(at.diagram, at.block, at.base)?;
            return Ok(Op::Pass { next });
        }
        self.look_at_properties(at);
        let silent = match (at.row.silent, self.world) {
            (Silent::Never, _) => false,
            (Silent::Always, _) => true,
            (Silent::Real, world) => world == World::Robot,
            (Silent::Simulated, world) => world != World::Robot,
            (Silent::WithoutMailbox, world) => {
                matches!(world, World::Simulated { mailbox: false, .. })
            }
            (Silent::WithoutGamepad, world) => {
                matches!(world, World::Simulated { gamepad: false, .. })
            }
        };
        if silent {
            let next = links::single(at.diagram, at.block, at.base)?;
            return Ok(Op::Pass { next });
        }
        self.operation(at)
    }

    fn operation(&mut self, at: At<'a>) -> Result<Op, Words> {
        // Links first: a block whose links are wrong has no other faults.
        let next = || links::single(at.diagram, at.block, at.base);
        Ok(match at.row.does {
            Does::Start | Does::Merge => Op::Pass { next: next()? },
            Does::End => Op::End,
            Does::Comment if at.block.incoming.is_empty() => Op::End,
            Does::Comment => return Err(words::comment_in_flow()),
            Does::If => {
                let (yes, no) = links::two_branches(at)?;
                let source = self.expression(at, "Condition");
                Op::If { source, yes, no }
            }
            Does::While => {
                let (yes, no) = self.loop_links(at)?;
                let source = self.expression(at, "Condition");
                Op::If { source, yes, no }
            }
            Does::Loop => self.counted(at)?,
            Does::Switch => self.switch(at)?,
            Does::Fork => self.fork(at)?,
            Does::Join => self.join(at, next()?)?,
            Does::Kill => self.kill(at, next()?)?,
            Does::Send => self.send(at, next()?)?,
            Does::Receive => self.receive(at, next()?)?,
            Does::Call => self.call(at, next()?)?,
            Does::Ask => self.ask(at)?,
            Does::Statements => {
                let (next, source) = (next()?, self.expression(at, "Body"));
                Op::Run { source, next }
            }
            Does::Assign => {
                let (next, source) = (next()?, self.spliced(at, text(at, "value")));
                Op::Run { source, next }
            }
            Does::Timer => {
                let (next, source) = (next()?, self.expression(at, "Delay"));
                Op::Timer { source, next }
            }
            Does::Random => {
                let (next, assignment) = (next()?, self.assignment(at));
                Op::Random { assignment, next }
            }
            Does::AnyButton => {
                let (next, assignment) = (next()?, self.assignment(at));
                Op::AnyButton { assignment, next }
            }
            Does::Mail => {
                let (next, assignment) = (next()?, self.assignment(at));
                Op::Mail { assignment, next }
            }
            Does::Copy(copied) => {
                let (next, copy) = (next()?, self.copied(at, copied));
                Op::Copy { copy, next }
            }
            Does::Act(act) => {
                let (next, action) = (next()?, self.action(at, act));
                Op::Act { action, next }
            }
            Does::Wait(wait) => {
                let (next, watch) = (next()?, self.watch(at, wait));
                Op::Watch { watch, next }
            }
        })
    }

    fn counted(&mut self, at: At<'a>) -> Result<Op, Words> {
        let (body, next) = self.loop_links(at)?;
        let source = self.expression(at, "Iterations");
        self.loops += 1;
        Ok(Op::Loop {
            source,
            body,
            next,
            counter: self.loops - 1,
        })
    }

    fn fork(&mut self, at: At<'a>) -> Result<Op, Words> {
        let branches = links::threads(at)?;
        self.forks.push(super::program::Fork {
            branches: branches.into(),
        });
        Ok(Op::Fork {
            fork: self.forks.len() as u32 - 1,
        })
    }

    fn join(&mut self, at: At<'a>, next: Node) -> Result<Op, Words> {
        let guard = at.block.outgoing.first();
        let guard = guard.and_then(|&link| at.diagram.links.get(link));
        let survivor = guard.map_or("", |link| link.guard.as_str());
        if survivor.is_empty() {
            return Err(words::join_needs_name());
        }
        self.joins.push(super::program::Join {
            survivor: survivor.into(),
            incoming: at.block.incoming.len() as u32,
        });
        Ok(Op::Join {
            join: self.joins.len() as u32 - 1,
            next,
        })
    }

    fn switch(&mut self, at: At<'a>) -> Result<Op, Words> {
        let (mut exact, other) = links::many_branches(at)?;
        exact.sort();
        let lower = |(guard, to): &(Box<str>, Node)| (guard.to_lowercase().into(), *to);
        let mut branches: Vec<(Box<str>, Node)> = exact.iter().map(lower).collect();
        for ((written, _), (lower, _)) in exact.iter().zip(&branches) {
            if written != lower {
                self.warn(words::never_matches(written), None);
            }
        }
        branches.sort();
        let source = self.expression(at, "Expression");
        self.switches.push(super::program::Switch {
            source,
            branches: branches.into(),
            exact: exact.into(),
            other,
        });
        Ok(Op::Switch {
            switch: self.switches.len() as u32 - 1,
        })
    }

    fn loop_links(&mut self, at: At<'a>) -> Result<(Node, Node), Words> {
        let found = links::body_and_exit(at)?;
        for guard in found.ignored {
            self.warn(words::ignored_link(&guard), None);
        }
        Ok((found.body, found.exit))
    }

    fn ask(&mut self, at: At<'a>) -> Result<Op, Words> {
        let (next, cancel) = links::question(at)?;
        Ok(Op::Ask {
            assignment: self.assignment(at),
            next,
            cancel,
        })
    }

    fn receive(&mut self, at: At<'a>, next: Node) -> Result<Op, Words> {
        if text(at, "Variable").is_empty() {
            return Err(words::nothing_to_receive_into());
        }
        Ok(Op::Receive {
            assignment: self.assignment(at),
            next,
        })
    }

    fn kill(&mut self, at: At<'a>, next: Node) -> Result<Op, Words> {
        let message = self.message(at, false);
        if text(at, "Thread").is_empty() {
            return Err(words::nobody_to_kill());
        }
        Ok(Op::Kill { message, next })
    }

    fn send(&mut self, at: At<'a>, next: Node) -> Result<Op, Words> {
        if text(at, "Thread").is_empty() {
            return Err(words::nobody_to_send_to());
        }
        Ok(Op::Send {
            message: self.message(at, true),
            next,
        })
    }

    fn message(&mut self, at: At<'a>, has_text: bool) -> u32 {
        let source = if has_text {
            self.expression(at, "Message")
        } else {
            NOWHERE
        };
        self.messages.push(Message {
            thread: text(at, "Thread").into(),
            source,
        });
        self.messages.len() as u32 - 1
    }

    fn call(&mut self, at: At<'a>, next: Node) -> Result<Op, Words> {
        let name = at.block.name.as_str();
        if !name
            .chars()
            .any(|letter| letter.is_alphabetic() || letter == '_')
        {
            return Err(words::bad_name(name));
        }
        let logical = at.block.calls.as_deref();
        let diagram = logical.and_then(|id| self.called.get(id).copied());
        if diagram.is_none() {
            self.warn(words::no_such_subprogram(), None);
        }
        let arguments = at.block.arguments.iter().map(|argument| {
            let (kind, wanted) = match argument.kind.as_str() {
                "bool" => (ArgumentKind::Truth, blocks::Type::Truth),
                "int" => (ArgumentKind::Whole, blocks::Type::Whole),
                "float" => (ArgumentKind::Number, blocks::Type::Number),
                _ => (ArgumentKind::Text, blocks::Type::Text),
            };
            self.sources.push(Text {
                text: argument.value.as_str().into(),
                wanted,
                property: "",
            });
            Argument {
                name: argument.name.as_str().into(),
                kind,
                source: self.sources.len() as Source - 1,
            }
        });
        let arguments = arguments.collect();
        self.calls.push(Call { diagram, arguments });
        let call = self.calls.len() as u32 - 1;
        Ok(Op::Call { call, next })
    }
}

/// A name that threads are compared by.
fn name(text: &str) -> Rc<str> {
    text.into()
}
