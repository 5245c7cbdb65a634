//! Everything that is wrong with a project, found at once and without running it.
//!
//! Owns the order: links and properties as `lower` finds them, expressions as far as types can be known beforehand, and
//! what no way leads to. The machine tells only what the flow comes to; this tells all.

use std::collections::{HashMap, HashSet, VecDeque};
use std::rc::Rc;

use super::lower::{Lowered, World, lower};
use super::program::{ArgumentKind, AssignedKind, Leads, NOWHERE, Node, Program};
use super::project::Project;
use super::words;
use lang_expr::tree::{Id, Node as Part, Tree};
use lang_expr::words::{Fault, Reason};
use lang_expr::{Compat, Kind, Kit, Names, Source, Value};
use lang_text::problem::{Place, Problem, Severity};

pub(crate) mod aside;
#[cfg(test)]
mod tests;

/// Checks a whole project as it would run in a world. At most [`lang_text::limits::PROBLEMS`] of each kind, errors first.
pub fn check(project: &Project, world: World) -> Vec<Problem> {
    let Lowered {
        program,
        mut problems,
    } = match lower(project, world) {
        Ok(lowered) => lowered,
        Err(problem) => return vec![problem],
    };
    let flow = Flow::of(&program);
    soften(&mut problems, &program, &flow);
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    problems.truncate(lang_text::limits::PROBLEMS);
    problems.extend(expressions(project, &program, &flow));
    problems.extend(dead_ends(project, &program, &flow));
    problems.extend(endless_calls(&program));
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
    problems
}

/// The names that can stand in expressions of a project: those of its kit, and variables of blocks that a program comes to.
pub fn names(project: &Project) -> Names {
    match lower(project, World::Robot) {
        Ok(Lowered { program, .. }) => {
            let mut names = Names::new(program.kit, Compat::Studio);
            taught(&program, &Flow::of(&program), &mut names);
            names
        }
        Err(_) => Names::new(Kit::default(), Compat::Studio),
    }
}

/// What is wrong with blocks that the program never comes to is less bad: it runs.
fn soften(problems: &mut [Problem], program: &Program, flow: &Flow) {
    let nodes: HashMap<&str, usize> = program
        .spots
        .iter()
        .enumerate()
        .map(|(node, spot)| (&*spot.id, node))
        .collect();
    for problem in problems {
        let node = problem.place.object.as_deref().and_then(|id| nodes.get(id));
        if node.is_some_and(|&node| !flow.is_reached[node]) {
            problem.severity = match problem.severity {
                Severity::Error => Severity::Warning,
                Severity::Note | Severity::Warning => Severity::Note,
            };
        }
    }
}

/// How far it is followed that nobody knows a value, and for how many names.
const ROUNDS: usize = 8;
const NAMES: usize = 200;

/// Which nodes can be reached, in an order in which they may be.
struct Flow {
    order: Vec<Node>,
    is_reached: Vec<bool>,
}

impl Flow {
    fn of(program: &Program) -> Self {
        let mut flow = Self {
            order: Vec::new(),
            is_reached: vec![false; program.len()],
        };
        let mut queue = VecDeque::new();
        let main = program
            .main
            .and_then(|main| program.entries.get(main as usize).copied());
        queue.extend(main.flatten());
        while let Some(node) = queue.pop_front() {
            match flow.is_reached.get_mut(node as usize) {
                Some(is_reached) if !*is_reached => *is_reached = true,
                _ => continue,
            }
            flow.order.push(node);
            successors(program, node, &mut |next| queue.push_back(next));
        }
        flow
    }
}

/// Where the flow may go from a node, the inside of a call first.
pub(super) fn successors(program: &Program, node: Node, tell: &mut dyn FnMut(Node)) {
    match program.leads(node) {
        None | Some(Leads::End | Leads::Fault(_)) => {}
        Some(Leads::To(next) | Leads::Join(_, next)) => tell(next),
        Some(Leads::Test(_, yes, no)) => [yes, no].into_iter().for_each(tell),
        Some(Leads::Ask(next, cancel)) => {
            tell(next);
            if cancel != NOWHERE {
                tell(cancel);
            }
        }
        Some(Leads::Switch(switch)) => {
            for (_, next) in &switch.branches {
                tell(*next);
            }
            tell(switch.other);
        }
        Some(Leads::Fork(fork)) => fork.branches.iter().for_each(|(_, next)| tell(*next)),
        Some(Leads::Call(call, next)) => {
            let entry = call
                .diagram
                .and_then(|one| program.entries.get(one as usize).copied());
            if let Some(entry) = entry.flatten() {
                tell(entry);
            }
            tell(next);
        }
    }
}

/// What names were taught before a run.
struct Taught {
    texts: HashMap<u32, Source>,
    /// Names whose values nobody knows beforehand.
    unknown: HashSet<String>,
    /// What was wrong with texts at the first look, with advice: a variable whose type did not fit has none afterwards.
    advised: HashMap<u32, Vec<Problem>>,
}

/// Teaches names all that is known before a run.
fn taught(program: &Program, flow: &Flow, names: &mut Names) -> Taught {
    let mut unknown = HashSet::new();
    for &node in &flow.order {
        declare(program, node, names, &mut unknown);
    }
    let mut texts: HashMap<u32, Source> = HashMap::new();
    let mut advised = HashMap::new();
    // The first time teaches all names; what is still wrong the second time is wrong.
    for _ in 0..2 {
        for &node in &flow.order {
            for index in program.texts(node) {
                let Some(text) = program.sources.get(index as usize) else {
                    continue;
                };
                let source = texts
                    .entry(index)
                    .or_insert_with(|| Source::new(&text.text, text.wanted.wanted()));
                if let Err(problems) = lang_expr::analyse(source, names)
                    && is_advised(&problems)
                {
                    advised.entry(index).or_insert(problems);
                }
            }
        }
    }
    Taught {
        unknown: spread(unknown, &texts),
        texts,
        advised,
    }
}

fn is_advised(problems: &[Problem]) -> bool {
    problems.iter().any(|problem| problem.hint.is_some())
}

/// Errors of expressions that no order of running can mend.
fn expressions(project: &Project, program: &Program, flow: &Flow) -> Vec<Problem> {
    let mut names = Names::new(program.kit, Compat::Studio);
    let Taught {
        mut texts,
        unknown,
        mut advised,
    } = taught(program, flow, &mut names);
    let mut given = given(program, flow, &texts);
    let parameters = project.diagrams.iter().flat_map(|one| &one.parameters);
    given.extend(parameters.map(|parameter| Rc::from(&*parameter.name)));
    let mut problems = Vec::new();
    for &node in &flow.order {
        for index in program.texts(node) {
            let (Some(text), Some(source)) =
                (program.sources.get(index as usize), texts.get_mut(&index))
            else {
                continue;
            };
            // A message of another thread is an expression of its own: nobody knows its type.
            if problems.len() >= lang_text::limits::PROBLEMS
                || unknown.iter().any(|name| text.text.contains(name.as_str()))
            {
                continue;
            }
            let mut found = match lang_expr::analyse(source, &mut names) {
                Ok(()) => match source.out_of_range() {
                    Some(problem) => vec![problem],
                    None => source.warnings(),
                },
                Err(found) if is_advised(&found) => found,
                Err(found) => advised.remove(&index).unwrap_or(found),
            };
            if found.is_empty() {
                found = without_value(source.tree(), &names, &given);
            }
            for mut problem in found {
                let position = problem.place.position;
                problem.place = program.place(node);
                problem.place.property = Some(text.property.to_owned());
                problem.place.position = position;
                problems.push(problem);
            }
        }
    }
    problems
}

/// Names that get a value anywhere: in a text, or by a block.
fn given(program: &Program, flow: &Flow, texts: &HashMap<u32, Source>) -> HashSet<Rc<str>> {
    let mut given = HashSet::new();
    for source in texts.values() {
        each_node(source.tree(), &mut |tree, node, _| {
            let Part::Assign { target, .. } = node else {
                return;
            };
            let mut target = *target;
            while let Part::Index { table, .. } = tree.node(target) {
                target = *table;
            }
            if let Part::Name(name) = tree.node(target) {
                given.insert(name.clone());
            }
        });
    }
    for &node in &flow.order {
        if let Some((assignment, _)) = program.given(node) {
            given.insert((&*assignment.variable).into());
        }
        if let Some(Leads::Call(call, _)) = program.leads(node) {
            let arguments = call.arguments.iter();
            given.extend(arguments.map(|argument| Rc::from(&*argument.name)));
        }
    }
    given
}

/// Variables that a text reads and nothing gives a value.
fn without_value(tree: &Tree, names: &Names, given: &HashSet<Rc<str>>) -> Vec<Problem> {
    let mut found = Vec::new();
    each_node(tree, &mut |tree, node, id| {
        if let Part::Name(name) = node
            && !given.contains(name)
            && let Some(Kind::Variable) = names.find(name).and_then(|slot| names.kind(slot))
        {
            let fault = Fault::new(Reason::Undeclared(name.to_string()), tree.place(id));
            found.push(lang_expr::explained(&fault, tree, names));
        }
    });
    found.sort_by_key(|problem| problem.place.position);
    found.truncate(lang_expr::limits::EXPRESSION_PROBLEMS_MAX);
    found
}

/// All nodes of a text.
fn each_node(tree: &Tree, seen: &mut dyn FnMut(&Tree, &Part, Id)) {
    let mut left = tree.statements();
    while let Some(id) = left.pop() {
        seen(tree, tree.node(id), id);
        tree.children(id, |child| left.push(child));
    }
}

/// Names whose values nobody knows beforehand, and those that get their values from them.
fn spread(unknown: HashSet<&str>, texts: &HashMap<u32, Source>) -> HashSet<String> {
    let mut all: HashSet<String> = unknown.into_iter().map(str::to_owned).collect();
    for _ in 0..ROUNDS {
        let before = all.len();
        for source in texts.values() {
            if !all.iter().any(|name| source.text().contains(name.as_str())) {
                continue;
            }
            for node in &source.tree().nodes {
                if let lang_expr::tree::Node::Assign { target, .. } = node
                    && let lang_expr::tree::Node::Name(name) = source.tree().node(*target)
                {
                    all.insert(name.to_string());
                }
            }
        }
        if all.len() == before || all.len() > NAMES {
            break;
        }
    }
    all
}

/// Names that a block gives a value without an expression.
fn declare<'a>(
    program: &'a Program,
    node: Node,
    names: &mut Names,
    unknown: &mut HashSet<&'a str>,
) {
    if let Some((assignment, given)) = program.given(node) {
        match given {
            AssignedKind::Whole => {
                names.declare(&assignment.variable, &Value::Int(0));
            }
            AssignedKind::Text => {
                names.declare(&assignment.variable, &Value::text(""));
            }
            AssignedKind::Any | AssignedKind::Answer => {
                unknown.insert(&assignment.variable);
            }
        }
    }
    if let Some(Leads::Call(call, _)) = program.leads(node) {
        for argument in &call.arguments {
            let value = match argument.kind {
                ArgumentKind::Truth => Value::Bool(false),
                ArgumentKind::Whole => Value::Int(0),
                ArgumentKind::Number => Value::Float(0.0),
                ArgumentKind::Text => Value::text(""),
            };
            names.declare(&argument.name, &value);
        }
    }
}

/// Blocks where a piece begins that no way leads to.
fn dead_ends(project: &Project, program: &Program, flow: &Flow) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut node: Node = 0;
    for diagram in &project.diagrams {
        for block in &diagram.blocks {
            let is_note = program
                .row(node)
                .is_some_and(|row| row.kind == "CommentBlock");
            let is_start = block.kind == "InitialNode";
            let is_reached = flow.is_reached.get(node as usize).copied().unwrap_or(false);
            if !is_reached
                && !is_note
                && block.incoming.is_empty()
                && problems.len() < lang_text::limits::PROBLEMS
            {
                let words = match is_start {
                    true => words::never_called(&diagram.name),
                    false => words::unreachable(),
                };
                problems.push(Problem {
                    severity: Severity::Note,
                    place: program.place(node),
                    words,
                    hint: None,
                });
            }
            node += 1;
        }
    }
    problems
}

/// Subprograms that come to a call of themselves whatever happens.
fn endless_calls(program: &Program) -> Vec<Problem> {
    let mut certain: Vec<Option<(u32, Node)>> = Vec::with_capacity(program.entries.len());
    let mut seen = HashSet::new();
    for entry in &program.entries {
        let mut at = *entry;
        let mut found = None;
        while let Some(node) = at {
            if !seen.insert(node) {
                break;
            }
            at = None;
            match program.leads(node) {
                Some(Leads::Call(call, _)) => {
                    found = call.diagram.map(|diagram| (diagram, node));
                }
                Some(Leads::To(next) | Leads::Join(_, next)) => at = Some(next),
                None
                | Some(
                    Leads::End
                    | Leads::Fault(_)
                    | Leads::Test(..)
                    | Leads::Switch(_)
                    | Leads::Fork(_)
                    | Leads::Ask(..),
                ) => {}
            }
        }
        certain.push(found);
    }
    let mut problems = Vec::new();
    let mut visited = vec![0_u32; certain.len()];
    for start in 0..certain.len() {
        let round = start as u32 + 1;
        let mut at = start;
        while let Some(&Some((next, node))) = certain.get(at) {
            if visited[at] == round && problems.len() < lang_text::limits::PROBLEMS {
                let name = program.diagrams.get(at).map_or("", |sheet| &*sheet.name);
                problems.push(Problem {
                    severity: Severity::Warning,
                    place: Place {
                        ..program.place(node)
                    },
                    words: words::endless_call(name),
                    hint: None,
                });
            }
            if visited[at] != 0 {
                break;
            }
            visited[at] = round;
            at = next as usize;
        }
    }
    problems
}
