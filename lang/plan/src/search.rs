//! The loops of the planners: sample, choose, propagate, keep.
//!
//! Owns one search. RRT keeps every place; SST keeps the best of a neighbourhood and cuts off what no longer leads
//! anywhere (Li, Littlefield, Bekris, *Asymptotically optimal sampling-based kinodynamic planning*, 2016).

use super::link::Links;
use super::motion::Propagator;
use super::nearest::{Key, Nearest};
use super::random::Random;
use super::space::{self, Space};
use super::tree::Tree;
use super::{Counts, End, Method, Options, Outcome, Path, Problem, Surroundings};
use crate::limits::{PLAN_MEMORY_NUMBERS, PLAN_REPORT_EVERY};
use lang_dcml::system::System;

/// What a place is to SST.
#[derive(Clone, Copy)]
struct Standing {
    /// Its key while it is the best of its neighbourhood.
    key: Option<Key>,
}

pub(super) struct Search<'a, S: System + ?Sized, W: ?Sized> {
    propagator: Propagator<'a, S>,
    surroundings: &'a mut W,
    problem: &'a Problem,
    options: &'a Options,
    /// So many places have room in memory.
    nodes: usize,
    space: Space,
    links: Links,
    random: Random,
    tree: Tree,
    /// The points of all places that may be gone on from.
    near: Nearest,
    standings: Vec<Standing>,
    /// One point of each neighbourhood, by its number; and the place that is its best.
    witnesses: Nearest,
    bests: Vec<u32>,
    counts: Counts,
    best: Option<Path>,
    nearest: Vec<f64>,
    /// Room for the place ahead.
    next: Vec<f64>,
}

/// Where an action led.
struct Reached {
    action: Vec<f64>,
    place: Vec<f64>,
    steps: u32,
    is_in_goal: bool,
}

impl Reached {
    fn new(parts: usize, actions: usize) -> Self {
        Self {
            action: vec![0.0; actions],
            place: vec![0.0; parts],
            steps: 0,
            is_in_goal: false,
        }
    }
}

impl<'a, S: System + ?Sized, W: Surroundings + ?Sized> Search<'a, S, W> {
    pub(super) fn new(
        propagator: Propagator<'a, S>,
        surroundings: &'a mut W,
        problem: &'a Problem,
        options: &'a Options,
        root: &[f64],
    ) -> Self {
        let space = Space::new(problem);
        let periods = space.periods();
        // A place, the action to it, and its point in both indices, twice while they are made anew.
        let numbers = root.len() + propagator.actions() + 4 * periods.len();
        let mut near = Nearest::new(&periods);
        let mut witnesses = Nearest::new(&periods);
        let mut point = Vec::new();
        space.project(root, &mut point);
        let key = Some(near.insert(0, &point));
        witnesses.insert(0, &point);
        Self {
            nodes: options.nodes.min(PLAN_MEMORY_NUMBERS / numbers),
            tree: Tree::new(root, propagator.actions()),
            propagator,
            surroundings,
            space,
            links: Links::new(problem, root),
            random: Random::new(options.seed),
            near,
            standings: vec![Standing { key }],
            witnesses,
            bests: vec![0],
            counts: Counts {
                nodes: 1,
                nearest: space::to_goal(problem, root),
                ..Counts::default()
            },
            best: None,
            nearest: root.to_vec(),
            next: Vec::new(),
            problem,
            options,
        }
    }

    pub(super) fn run<R: FnMut(&Counts) -> bool + ?Sized>(mut self, report: &mut R) -> Outcome {
        let root = self.nearest.clone();
        let end = if space::is_in_goal(self.problem, &root) {
            self.found(0);
            End::Found
        } else {
            self.search(report)
        };
        Outcome {
            path: self.best,
            end,
            counts: self.counts,
            nearest: self.nearest,
            tree: self.tree,
        }
    }

    fn search<R: FnMut(&Counts) -> bool + ?Sized>(&mut self, report: &mut R) -> End {
        let (parts, actions) = (self.propagator.parts(), self.propagator.actions());
        let mut reached = Reached::new(parts, actions);
        let mut best = Reached::new(parts, actions);
        let mut target = Vec::new();
        let mut point = Vec::new();
        while self.counts.iterations < self.options.iterations {
            if self.counts.iterations.is_multiple_of(PLAN_REPORT_EVERY) && !report(&self.counts) {
                return End::Stopped;
            }
            self.counts.iterations += 1;
            let aims = self.random.unit() < self.options.goal_bias;
            self.space.sample(&mut self.random, aims, &mut target);
            match self.options.method {
                Method::Rrt => {
                    if self.tree.len() >= self.nodes {
                        return End::Nodes;
                    }
                    if self.grow(&target, &mut reached, &mut best, &mut point) {
                        return End::Found;
                    }
                }
                Method::Sst { selection, pruning } => {
                    let from = self.select(&target, selection);
                    if self.try_action(from, &mut reached) {
                        self.keep_best(from, &reached, pruning, &mut point);
                    }
                }
            }
            self.counts.nodes = self.tree.len();
        }
        End::Iterations
    }

    /// One sample of RRT: whether the goal is reached.
    fn grow(
        &mut self,
        target: &[f64],
        reached: &mut Reached,
        best: &mut Reached,
        point: &mut Vec<f64>,
    ) -> bool {
        let Some((from, _)) = self.near.nearest(target) else {
            return false;
        };
        let mut least = f64::INFINITY;
        for _ in 0..self.options.attempts {
            if !self.try_action(from, reached) {
                continue;
            }
            self.space.project(&reached.place, point);
            let far = self.space.square(point, target);
            if far < least || reached.is_in_goal {
                least = far;
                std::mem::swap(best, reached);
                if best.is_in_goal {
                    break;
                }
            }
        }
        if least == f64::INFINITY {
            return false;
        }
        self.space.project(&best.place, point);
        let node = self.tree.add(from, &best.action, best.steps, &best.place);
        self.near.insert(node, point);
        if best.is_in_goal {
            self.counts.nodes = self.tree.len();
            self.found(node);
        }
        best.is_in_goal
    }

    /// The place to go on from by SST: the one reached soonest near to the target, or the nearest.
    fn select(&self, target: &[f64], radius: f64) -> u32 {
        let mut best: Option<(u64, u32)> = None;
        self.near.within(target, radius, |node| {
            let one = (self.tree.cost(node), node);
            if best.is_none_or(|best| one < best) {
                best = Some(one);
            }
        });
        let nearest = || self.near.nearest(target).map(|(node, _)| node);
        best.map(|(_, node)| node).or_else(nearest).unwrap_or(0)
    }

    /// Holds a random action for a random time, until something is in the way or the goal is reached. Whether it led
    /// anywhere.
    fn try_action(&mut self, from: u32, reached: &mut Reached) -> bool {
        let (least, most) = self.problem.hold;
        for (value, (low, high)) in reached.action.iter_mut().zip(&self.problem.actions) {
            *value = self.random.between(*low, *high);
        }
        let wanted = self.random.whole(least, most);
        self.counts.propagations += 1;
        let place = self.tree.place(from);
        let problem = self.problem;
        self.links.bend(
            &mut self.propagator,
            problem,
            place,
            wanted,
            &mut reached.action,
        );
        reached.place.copy_from_slice(self.tree.place(from));
        reached.steps = 0;
        reached.is_in_goal = false;
        let mut next = std::mem::take(&mut self.next);
        next.clear();
        next.extend_from_slice(&reached.place);
        while reached.steps < wanted {
            self.counts.steps += 1;
            self.propagator.advance(&mut next, &reached.action);
            if !space::is_inside(&self.problem.axes, &next)
                || !self.links.hold(&next)
                || !self.surroundings.allows_way(&reached.place, &next)
            {
                self.counts.collisions += 1;
                break;
            }
            reached.place.copy_from_slice(&next);
            reached.steps += 1;
            self.look_at(&reached.place);
            if space::is_in_goal(self.problem, &reached.place) {
                reached.is_in_goal = true;
                break;
            }
        }
        self.next = next;
        reached.is_in_goal || reached.steps >= least
    }

    fn look_at(&mut self, place: &[f64]) {
        let far = space::to_goal(self.problem, place);
        if far < self.counts.nearest {
            self.counts.nearest = far;
            self.nearest.copy_from_slice(place);
        }
    }

    /// Keeps a place if it is the best of its neighbourhood, instead of the one that was.
    fn keep_best(&mut self, from: u32, reached: &Reached, radius: f64, point: &mut Vec<f64>) {
        let cost = self.tree.cost(from) + u64::from(reached.steps);
        if self.best.as_ref().is_some_and(|best| cost >= best.steps()) {
            return;
        }
        self.space.project(&reached.place, point);
        let witness = match self.witnesses.nearest(point) {
            Some((witness, far)) if far <= radius => Some(witness as usize),
            _ => None,
        };
        let old = witness.map(|witness| self.bests[witness]);
        if old.is_some_and(|old| self.tree.cost(old) <= cost) && !reached.is_in_goal {
            return;
        }
        let is_full = self.tree.len() + self.bests.len() >= self.nodes;
        if is_full && !reached.is_in_goal {
            return;
        }
        let node = self
            .tree
            .add(from, &reached.action, reached.steps, &reached.place);
        if reached.is_in_goal {
            self.found(node);
        }
        if old.is_some_and(|old| self.tree.cost(old) <= cost) {
            // A shorter way to the goal, beside a place that is reached sooner but is not in it.
            self.tree.cut(node);
            return;
        }
        let key = Some(self.near.insert(node, point));
        let at = node as usize;
        if self.standings.len() <= at {
            self.standings.resize(at + 1, Standing { key: None });
        }
        self.standings[at] = Standing { key };
        match (witness, old) {
            (Some(witness), Some(old)) => {
                self.bests[witness] = node;
                self.retire(old);
            }
            _ => {
                self.witnesses.insert(self.bests.len() as u32, point);
                self.bests.push(node);
            }
        }
    }

    /// A place that is no longer the best: nothing goes on from it, and if nothing does it is cut off, and so on down.
    fn retire(&mut self, node: u32) {
        if let Some(key) = self.standings[node as usize].key.take() {
            self.near.remove(key);
        }
        let mut at = node;
        while self.standings[at as usize].key.is_none() {
            let Some(parent) = self.tree.cut(at) else {
                break;
            };
            at = parent;
        }
    }

    fn found(&mut self, node: u32) {
        let path = self.tree.path(node, self.problem.step);
        self.counts.best = Some(path.duration());
        self.best = Some(path);
    }
}
