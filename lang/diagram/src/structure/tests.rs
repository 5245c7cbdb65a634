//! Graphs drawn by hand and at random: the program visits what the graph visits.

use super::*;
use crate::tree::{Condition, size};
use proptest::prelude::*;
use std::collections::HashMap;

/// What was visited, and how many times each node decided already.
struct Walk {
    seed: u64,
    visits: HashMap<usize, u64>,
    seen: Vec<usize>,
    limit: usize,
}

struct Enough;

impl Walk {
    fn new(seed: u64) -> Self {
        Self {
            seed,
            visits: HashMap::new(),
            seen: Vec::new(),
            limit: 400,
        }
    }

    fn visit(&mut self, node: usize) -> Result<(), Enough> {
        if self.seen.len() == self.limit {
            return Err(Enough);
        }
        self.seen.push(node);
        Ok(())
    }

    /// A way, scripted by the seed, the node and how often it was asked.
    fn decide(&mut self, node: usize, ways: usize) -> usize {
        let visits = self.visits.entry(node).or_default();
        *visits += 1;
        let mut x = self.seed ^ (node as u64) << 32 ^ *visits;
        for _ in 0..3 {
            x = x.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            x ^= x >> 29;
        }
        (x % ways as u64) as usize
    }
}

fn walk_graph(graph: &Graph, walk: &mut Walk) {
    let mut at = graph.entry;
    while walk.visit(at).is_ok() {
        at = match &graph.ways[at] {
            Exit::End => return,
            Exit::Step(next) => *next,
            Exit::Test(yes, no) => [*yes, *no][walk.decide(at, 2)],
            Exit::Switch(all) => all[walk.decide(at, all.len())],
        };
    }
}

/// How a list of statements was left.
#[derive(Debug, PartialEq)]
enum Left {
    Through,
    Break(usize),
    Continue(usize),
    End,
    Goto(usize),
}

struct Machine<'a> {
    graph: &'a Graph,
    walk: Walk,
    variables: Vec<usize>,
    /// Statements without a visit, to notice a loop that does nothing.
    idle: usize,
}

impl Machine<'_> {
    fn holds(&mut self, when: &Condition) -> Result<bool, Enough> {
        let walk = &mut self.walk;
        when.decide(&mut |node| {
            walk.visit(node)?;
            Ok(walk.decide(node, 2) == 0)
        })
    }

    fn list(&mut self, list: &[Tree]) -> Result<Left, Enough> {
        let mut at = 0;
        while let Some(tree) = list.get(at) {
            at += 1;
            match self.one(tree)? {
                Left::Through => {}
                Left::Goto(label) => match list.iter().position(|tree| *tree == Tree::Label(label))
                {
                    Some(place) => at = place,
                    None => return Ok(Left::Goto(label)),
                },
                left => return Ok(left),
            }
        }
        Ok(Left::Through)
    }

    fn switch(&mut self, on: usize, branches: &[(Vec<usize>, Vec<Tree>)]) -> Result<Left, Enough> {
        self.walk.visit(on)?;
        let Exit::Switch(all) = &self.graph.ways[on] else {
            panic!("{on} is no switch");
        };
        let way = self.walk.decide(on, all.len());
        let mut fitting = branches.iter().filter(|(ways, _)| ways.contains(&way));
        let (_, body) = fitting.next().expect("a branch for each way");
        assert!(fitting.next().is_none());
        self.list(body)
    }

    fn one(&mut self, tree: &Tree) -> Result<Left, Enough> {
        self.idle += 1;
        assert!(self.idle < 100_000, "nothing is visited");
        Ok(match tree {
            Tree::Step(node) => {
                assert!(matches!(self.graph.ways[*node], Exit::Step(_)));
                self.walk.visit(*node)?;
                Left::Through
            }
            Tree::End(node) => {
                self.walk.visit(*node)?;
                Left::End
            }
            Tree::If { when, yes, no } => {
                let body = if self.holds(when)? { yes } else { no };
                self.list(body)?
            }
            Tree::Switch { on, branches } => self.switch(*on, branches)?,
            Tree::Loop { label, body } => loop {
                match self.list(body)? {
                    Left::Through => {}
                    Left::Continue(known) if known == *label => {}
                    Left::Break(known) if known == *label => break Left::Through,
                    left => break left,
                }
            },
            Tree::While { label, when, body } => loop {
                if !self.holds(when)? {
                    break Left::Through;
                }
                match self.list(body)? {
                    Left::Through => {}
                    Left::Continue(known) if known == *label => {}
                    Left::Break(known) if known == *label => break Left::Through,
                    left => break left,
                }
            },
            Tree::DoWhile { label, when, body } => loop {
                match self.list(body)? {
                    Left::Through => {}
                    Left::Break(known) if known == *label => break Left::Through,
                    left => break left,
                }
                if !self.holds(when)? {
                    break Left::Through;
                }
            },
            Tree::Break(label) => Left::Break(*label),
            Tree::Continue(label) => Left::Continue(*label),
            Tree::Set { variable, value } => {
                self.variables[*variable] = *value;
                Left::Through
            }
            Tree::Choice { variable, arms } => {
                let value = self.variables[*variable];
                match arms.iter().find(|(known, _)| *known == value) {
                    Some((_, body)) => self.list(body)?,
                    None => Left::Through,
                }
            }
            Tree::Goto(label) => Left::Goto(*label),
            Tree::Label(_) => Left::Through,
        })
    }
}

/// Breaks and continues name the innermost loop, and gotos are absent, unless the language has more.
fn jumps_are_allowed(list: &[Tree], jumps: Jumps, around: &[usize]) {
    for tree in list {
        match tree {
            Tree::Break(label) | Tree::Continue(label) => match jumps {
                Jumps::Labelled => assert!(around.contains(label)),
                _ => assert_eq!(around.last(), Some(label)),
            },
            Tree::Goto(_) | Tree::Label(_) => assert_eq!(jumps, Jumps::Goto),
            Tree::Loop { label, body }
            | Tree::While { label, body, .. }
            | Tree::DoWhile { label, body, .. } => {
                let around = [around, &[*label]].concat();
                jumps_are_allowed(body, jumps, &around);
            }
            _ => tree
                .parts()
                .into_iter()
                .for_each(|part| jumps_are_allowed(part, jumps, around)),
        }
    }
}

fn same(graph: &Graph, jumps: Jumps) -> Structured {
    let structured = structure(graph, jumps);
    jumps_are_allowed(&structured.body, jumps, &[]);
    for seed in 0..12 {
        let mut walk = Walk::new(seed);
        walk_graph(graph, &mut walk);
        let mut machine = Machine {
            graph,
            walk: Walk::new(seed),
            variables: vec![0; structured.variables],
            idle: 0,
        };
        let _ = machine.list(&structured.body);
        assert_eq!(machine.walk.seen, walk.seen, "{graph:?}\n{structured:#?}");
    }
    structured
}

fn graph(ways: &[Exit]) -> Graph {
    Graph {
        ways: ways.to_vec(),
        entry: 0,
    }
}

use Exit::{End, Step, Switch, Test};

fn test(node: usize) -> Condition {
    Condition::Test(node)
}

#[test]
fn a_sequence_stays_one() {
    let structured = same(&graph(&[Step(1), Step(2), End]), Jumps::Plain);
    assert_eq!(
        structured.body,
        [Tree::Step(0), Tree::Step(1), Tree::End(2)]
    );
    assert_eq!(structured.manner, Manner::Exact);
}

#[test]
fn a_diamond_is_an_if_and_what_follows_stands_behind_it() {
    let structured = same(
        &graph(&[Test(1, 2), Step(3), Step(3), Step(4), End]),
        Jumps::Plain,
    );
    let when = test(0);
    let (yes, no) = (vec![Tree::Step(1)], vec![Tree::Step(2)]);
    assert_eq!(
        structured.body,
        [Tree::If { when, yes, no }, Tree::Step(3), Tree::End(4)]
    );
}

#[test]
fn a_condition_at_the_head_is_a_while_and_at_the_foot_a_do_while() {
    let structured = same(&graph(&[Test(1, 2), Step(0), End]), Jumps::Plain);
    let looped = Tree::While {
        label: 0,
        when: test(0),
        body: vec![Tree::Step(1)],
    };
    assert_eq!(structured.body, [looped, Tree::End(2)]);
    let structured = same(&graph(&[Step(1), Test(0, 2), End]), Jumps::Plain);
    let looped = Tree::DoWhile {
        label: 0,
        when: test(1),
        body: vec![Tree::Step(0)],
    };
    assert_eq!(structured.body, [looped, Tree::End(2)]);
}

#[test]
fn an_or_of_two_diamonds_is_an_or() {
    // 0 or 1 leads to 2, else 3; both meet in 4.
    let structured = same(
        &graph(&[Test(2, 1), Test(2, 3), Step(4), Step(4), End]),
        Jumps::Plain,
    );
    let when = Condition::Or(Box::new(test(0)), Box::new(test(1)));
    let (yes, no) = (vec![Tree::Step(2)], vec![Tree::Step(3)]);
    assert_eq!(structured.body, [Tree::If { when, yes, no }, Tree::End(4)]);
    assert_eq!(structured.manner, Manner::Exact);
}

#[test]
fn nested_diamonds_stay_nested() {
    let structured = same(
        &graph(&[Test(1, 3), Test(2, 3), Step(3), End]),
        Jumps::Plain,
    );
    let Tree::If { when, yes, .. } = &structured.body[0] else {
        panic!("{structured:?}");
    };
    assert_eq!((when, yes.len()), (&test(0), 1));
}

#[test]
fn a_loop_with_two_entries_gets_one() {
    let ways = [Test(1, 2), Step(2), Test(1, 3), End];
    for jumps in [Jumps::Plain, Jumps::Labelled, Jumps::Goto] {
        let structured = same(&graph(&ways), jumps);
        assert_eq!(structured.manner, Manner::Copied);
        assert!(size(&structured.body) < 8, "{structured:?}");
    }
}

#[test]
fn a_break_inside_of_a_branch_keeps_what_follows_once() {
    // while (true) { if (0) { 1 } else { if (2) break; 3 } 4 } 5
    let ways = [Test(1, 2), Step(4), Test(5, 3), Step(4), Step(0), End];
    assert_eq!(same(&graph(&ways), Jumps::Plain).manner, Manner::Exact);
}

#[test]
fn leaving_two_loops_at_once_needs_no_label() {
    // Outer loop 0..4, inner loop 1..2; from 2 to the end directly.
    let ways = [Step(1), Test(2, 3), Test(5, 1), Test(0, 4), Step(5), End];
    for jumps in [Jumps::Plain, Jumps::Labelled, Jumps::Goto] {
        same(&graph(&ways), jumps);
    }
}

#[test]
fn switches_share_branches() {
    let ways = [Switch(vec![1, 2, 1]), Step(3), Step(3), End];
    let structured = same(&graph(&ways), Jumps::Plain);
    let Tree::Switch { branches, .. } = &structured.body[0] else {
        panic!("{structured:?}");
    };
    assert_eq!(branches[0].0, [0, 2]);
}

#[test]
fn ways_to_nowhere_end_the_program() {
    let structured = structure(&graph(&[Step(7)]), Jumps::Plain);
    assert_eq!(structured.body, [Tree::Step(0), Tree::End(1)]);
    let nothing = Graph {
        ways: Vec::new(),
        entry: 0,
    };
    assert!(structure(&nothing, Jumps::Plain).body.is_empty());
}

#[test]
fn large_graphs_take_little_time_and_stay_small() {
    const COUNT: usize = 20_000;
    // A long chain; nested diamonds that end at one place; a thicket.
    let chain = (0..COUNT).map(|node| Step(node + 1));
    let nested = (0..COUNT).map(|node| Test(node + 1, COUNT));
    let thicket =
        (0..COUNT).map(|node| Test((node * 7919 + 13) % COUNT, (node * 104_729 + 7) % COUNT));
    let loops = (0..COUNT).map(|node| Test(node + 1, node / 2));
    for ways in [
        chain.chain([End]).collect::<Vec<_>>(),
        nested.chain([End]).collect(),
        thicket.collect(),
        loops.chain([End]).collect(),
    ] {
        let structured = structure(&graph(&ways), Jumps::Plain);
        assert!(
            size(&structured.body) < 8 * COUNT,
            "{}",
            size(&structured.body)
        );
    }
}

/// Any graph: each node has ways anywhere.
fn any_graph(most: usize) -> impl Strategy<Value = Graph> {
    let node = (0..8_usize, prop::collection::vec(0..most, 4));
    prop::collection::vec(node, 1..most).prop_map(|nodes| {
        let count = nodes.len();
        let way = |(kind, to): (usize, Vec<usize>)| {
            let to: Vec<usize> = to.iter().map(|to| to % count).collect();
            match kind {
                0 => End,
                1 => Switch(to),
                2..=4 => Test(to[0], to[1]),
                _ => Step(to[0]),
            }
        };
        Graph {
            ways: nodes.into_iter().map(way).collect(),
            entry: 0,
        }
    })
}

/// A graph as people draw them: mostly downwards, sometimes back.
fn drawn_graph(most: usize) -> impl Strategy<Value = Graph> {
    let node = (
        0..10_usize,
        prop::collection::vec((0..6_usize, 1..4_usize), 3),
    );
    prop::collection::vec(node, 1..most).prop_map(|nodes| {
        let count = nodes.len();
        let way = |(at, (kind, to)): (usize, (usize, Vec<(usize, usize)>))| {
            let to = |index: usize| {
                let (back, far): (usize, usize) = to[index];
                let to = if back == 0 {
                    at.saturating_sub(far * 2)
                } else {
                    at + far
                };
                to.min(count)
            };
            match kind {
                0 => Switch(vec![to(0), to(1), to(2)]),
                1..=4 => Test(to(0), to(1)),
                _ => Step(to(0)),
            }
        };
        let mut ways: Vec<Exit> = nodes.into_iter().enumerate().map(way).collect();
        ways.push(End);
        Graph { ways, entry: 0 }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_program_visits_what_its_graph_visits(graph in any_graph(14)) {
        for jumps in [Jumps::Plain, Jumps::Labelled, Jumps::Goto] {
            same(&graph, jumps);
        }
    }

    #[test]
    fn any_drawn_program_visits_what_its_graph_visits(graph in drawn_graph(40)) {
        for jumps in [Jumps::Plain, Jumps::Labelled, Jumps::Goto] {
            same(&graph, jumps);
        }
    }

    #[test]
    fn states_visit_what_the_graph_visits(graph in any_graph(20)) {
        let work = work::Work::new(&graph).unwrap();
        let body = states::states(&work);
        for seed in 0..8 {
            let mut walk = Walk::new(seed);
            walk_graph(&graph, &mut walk);
            let mut machine = Machine { graph: &graph, walk: Walk::new(seed), variables: vec![0], idle: 0 };
            let _ = machine.list(&body);
            prop_assert_eq!(&machine.walk.seen, &walk.seen);
        }
    }
}
