//! Which functions a program has: the main one, one for each thread, one for each subprogram; and the graph of each.
//!
//! Owns threads: which branch of a fork continues, who survives a join, under which names a subprogram runs. Knows no
//! expressions.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

use super::words;
use crate::limits;
use crate::program::{Fork, Leads, NOWHERE, Node, Op, Program};
use crate::structure::{Exit, Graph};
use lang_text::problem::Problem;

/// Whose function it is.
#[derive(Clone, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(crate) enum Owner {
    /// The program begins with it.
    Main,
    /// A subprogram, by its diagram.
    Subprogram(u32),
    /// A thread by its name and where it begins.
    Thread(Rc<str>, Node),
}

/// One function.
#[derive(Clone, Debug)]
pub(crate) struct Function {
    pub(crate) owner: Owner,
    pub(crate) graph: Graph,
    /// For each block of the graph its node.
    pub(crate) nodes: Vec<Node>,
    /// Which threads run it.
    pub(crate) threads: BTreeSet<Rc<str>>,
    /// Subprograms that it calls.
    pub(crate) calls: BTreeSet<u32>,
    /// Threads that its forks begin.
    pub(crate) begun: BTreeMap<Node, Vec<(Rc<str>, Node)>>,
}

/// All functions: the main one first, then subprograms, then threads.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) functions: Vec<Function>,
}

/// What follows a node in a function.
enum Follow {
    Ways(Exit),
    /// These begin threads, and the way goes on.
    Fork(Vec<(Rc<str>, Node)>, Node),
    /// This is called, and the way goes on.
    Call(u32, Node),
}

struct Planner<'a> {
    program: &'a Program,
    wanted: For,
    threads: BTreeMap<Owner, BTreeSet<Rc<str>>>,
    problems: BTreeMap<Node, Problem>,
    /// Fresh names of threads without one.
    fresh: HashMap<(Node, usize), Rc<str>>,
}

/// What the functions of a program are wanted for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum For {
    /// A person, who is shown every block.
    Show,
    /// A generator for the language of this name.
    Generator(&'static str),
}

/// The functions of a program; problems where it cannot be told what happens.
pub(crate) fn plan(program: &Program, wanted: For) -> Result<Plan, Vec<Problem>> {
    if program.len() > limits::GENERATED_BLOCKS_MAX {
        return Err(vec![Problem::error(words::too_many_blocks(program.len()))]);
    }
    let mut planner = Planner {
        program,
        wanted,
        threads: BTreeMap::new(),
        problems: BTreeMap::new(),
        fresh: HashMap::new(),
    };
    planner
        .threads
        .insert(Owner::Main, BTreeSet::from(["main".into()]));
    let mut waiting = vec![Owner::Main];
    let mut functions = BTreeMap::new();
    while let Some(owner) = waiting.pop() {
        if planner.threads.len() > limits::GENERATED_FUNCTIONS_MAX {
            return Err(vec![Problem::error(words::too_many_threads())]);
        }
        let Some(function) = planner.function(&owner, &mut waiting) else {
            return Err(planner.problems.into_values().collect());
        };
        functions.insert(owner, function);
    }
    if planner.problems.is_empty() {
        let functions = functions.into_values().collect();
        Ok(Plan { functions })
    } else {
        Err(planner.problems.into_values().collect())
    }
}

impl Planner<'_> {
    fn fail(&mut self, node: Node, words: lang_text::problem::Words) {
        let mut problem = Problem::error(words);
        problem.place = self.program.place(node);
        self.problems.insert(node, problem);
    }

    /// Where a function begins.
    fn start(&mut self, owner: &Owner) -> Option<Node> {
        let diagram = match owner {
            Owner::Main => self.program.main,
            Owner::Subprogram(diagram) => Some(*diagram),
            Owner::Thread(_, node) => return Some(*node),
        };
        let entry = diagram.and_then(|diagram| {
            self.program
                .entries
                .get(diagram as usize)
                .copied()
                .flatten()
        });
        if entry.is_none() {
            let mut problem = Problem::error(words::no_beginning());
            let sheet = diagram.and_then(|at| self.program.diagrams.get(at as usize));
            problem.place.diagram = sheet.map(|sheet| sheet.name.to_string());
            self.problems.insert(NOWHERE, problem);
        }
        entry
    }

    /// Walks a function; who else runs because of it waits to be walked.
    fn function(&mut self, owner: &Owner, waiting: &mut Vec<Owner>) -> Option<Function> {
        let entry = self.start(owner)?;
        let threads = self.threads.get(owner).cloned().unwrap_or_default();
        let mut nodes = vec![entry];
        let mut number = HashMap::from([(entry, 0)]);
        let mut ways = Vec::new();
        let mut calls = BTreeSet::new();
        let mut all_begun = BTreeMap::new();
        while let Some(&node) = nodes.get(ways.len()) {
            let way = match self.follow(node, &threads) {
                Follow::Ways(way) => way,
                Follow::Fork(begun, next) => {
                    for (name, first) in &begun {
                        let owner = Owner::Thread(name.clone(), *first);
                        self.run_by(owner, &BTreeSet::from([name.clone()]), waiting);
                    }
                    all_begun.insert(node, begun);
                    Exit::Step(next as usize)
                }
                Follow::Call(callee, next) => {
                    calls.insert(callee);
                    self.run_by(Owner::Subprogram(callee), &threads, waiting);
                    Exit::Step(next as usize)
                }
            };
            let mut local = |node: usize| {
                *number.entry(node as Node).or_insert_with(|| {
                    nodes.push(node as Node);
                    nodes.len() - 1
                })
            };
            ways.push(match way {
                Exit::End => Exit::End,
                Exit::Step(next) => Exit::Step(local(next)),
                Exit::Test(yes, no) => {
                    let yes = local(yes);
                    Exit::Test(yes, local(no))
                }
                Exit::Switch(all) => Exit::Switch(all.into_iter().map(local).collect()),
            });
        }
        Some(Function {
            owner: owner.clone(),
            graph: Graph { ways, entry: 0 },
            nodes,
            threads,
            calls,
            begun: all_begun,
        })
    }

    fn run_by(&mut self, owner: Owner, by: &BTreeSet<Rc<str>>, waiting: &mut Vec<Owner>) {
        let known = self.threads.get(&owner).map_or(0, BTreeSet::len);
        let threads = self.threads.entry(owner.clone()).or_default();
        threads.extend(by.iter().cloned());
        if threads.len() > known {
            waiting.push(owner);
        }
    }

    fn follow(&mut self, node: Node, threads: &BTreeSet<Rc<str>>) -> Follow {
        let program = self.program;
        let ways = match program.leads(node) {
            None | Some(Leads::End) => Exit::End,
            Some(Leads::Fault(fault)) => {
                let fault = program.faults[fault as usize].clone();
                self.problems.insert(node, fault);
                Exit::End
            }
            Some(Leads::To(next)) => Exit::Step(next as usize),
            Some(Leads::Test(_, yes, no)) => Exit::Test(yes as usize, no as usize),
            Some(Leads::Switch(switch)) => {
                let ways = switch.branches.iter().map(|&(_, to)| to as usize);
                Exit::Switch(ways.chain([switch.other as usize]).collect())
            }
            Some(Leads::Fork(fork)) => return self.fork(node, fork, threads),
            Some(Leads::Join(join, next)) => {
                match (threads.contains(&join.survivor), threads.len()) {
                    (true, 1) => Exit::Step(next as usize),
                    (false, _) => Exit::End,
                    _ => {
                        self.fail(node, words::unclear_thread());
                        Exit::End
                    }
                }
            }
            Some(Leads::Call(call, next)) => match call.diagram {
                Some(diagram) => return Follow::Call(diagram, next),
                None => {
                    self.fail(node, words::no_subprogram());
                    Exit::End
                }
            },
            Some(Leads::Ask(next, cancel)) => match self.wanted {
                For::Generator(language) => {
                    self.fail(node, words::no_questions(language));
                    Exit::End
                }
                For::Show if cancel == NOWHERE => Exit::Step(next as usize),
                For::Show => Exit::Test(next as usize, cancel as usize),
            },
        };
        Follow::Ways(ways)
    }

    fn fork(&mut self, node: Node, fork: &Fork, threads: &BTreeSet<Rc<str>>) -> Follow {
        let branches = &fork.branches;
        let mut own = branches
            .iter()
            .enumerate()
            .filter(|(_, (name, _))| name.as_ref().is_some_and(|name| threads.contains(name)));
        let first = own.next();
        // The branch of the present thread; which one that is must be known.
        let is_unclear = first.is_some() && threads.len() > 1;
        let blank = || {
            branches
                .iter()
                .enumerate()
                .find(|(_, (name, _))| name.is_none())
        };
        let (Some((chosen, &(_, next))), false) = (first.or_else(blank), is_unclear) else {
            let words = if is_unclear {
                words::unclear_thread()
            } else {
                words::no_own_branch()
            };
            self.fail(node, words);
            return Follow::Ways(Exit::End);
        };
        let others = branches
            .iter()
            .enumerate()
            .filter(|&(index, _)| index != chosen);
        let mut begun = Vec::new();
        for (index, (name, to)) in others {
            let name = match name {
                Some(name) => name.clone(),
                None => {
                    let count = self.fresh.len() + 1;
                    let fresh = || format!("thread{count}").into();
                    self.fresh
                        .entry((node, index))
                        .or_insert_with(fresh)
                        .clone()
                }
            };
            begun.push((name, *to));
        }
        // The original begins them by their names.
        begun.sort();
        Follow::Fork(begun, next)
    }
}

impl Plan {
    /// The functions that a thread begins with: its name and the number of the function.
    pub(crate) fn thread(&self, name: &str, node: Node) -> Option<usize> {
        let is_it = |function: &Function| match &function.owner {
            Owner::Thread(known, start) => &**known == name && *start == node,
            Owner::Main | Owner::Subprogram(_) => false,
        };
        self.functions.iter().position(is_it)
    }

    /// The function of a subprogram.
    pub(crate) fn subprogram(&self, diagram: u32) -> Option<usize> {
        let owner = Owner::Subprogram(diagram);
        self.functions
            .iter()
            .position(|function| function.owner == owner)
    }

    /// Whether there is more than one thread.
    pub(crate) fn has_threads(&self) -> bool {
        let is_thread = |function: &Function| matches!(function.owner, Owner::Thread(..));
        self.functions.iter().any(is_thread)
    }

    /// Whether a thread is ended, or written to or read from, by its name.
    pub(crate) fn names_threads(&self, program: &Program) -> bool {
        let names = |node: &Node| {
            let op = program.ops[*node as usize];
            matches!(op, Op::Kill { .. } | Op::Send { .. } | Op::Receive { .. })
        };
        let mut functions = self.functions.iter();
        functions.any(|function| function.nodes.iter().any(names))
    }

    /// Whether a subprogram may be running more than once at a time.
    pub(crate) fn reenters(&self, diagram: u32) -> bool {
        let mut seen = BTreeSet::new();
        let calls = |at: u32| {
            let function = self.subprogram(at).map(|index| &self.functions[index]);
            function
                .map(|function| function.calls.clone())
                .unwrap_or_default()
        };
        let mut waiting: Vec<u32> = calls(diagram).into_iter().collect();
        while let Some(at) = waiting.pop() {
            if at == diagram {
                return true;
            }
            if seen.insert(at) {
                waiting.extend(calls(at));
            }
        }
        false
    }
}
