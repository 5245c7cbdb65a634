//! The places that were reached, each with where it was reached from and how.
//!
//! Owns the memory of a search: places of leaves that are cut off are used again. Knows no metric.

use super::path::{Path, Piece};

/// Has no parent, or stands for no node.
const NONE: u32 = u32::MAX;

/// A tree. Its root is node 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    parts: usize,
    actions: usize,
    places: Vec<f64>,
    held: Vec<f64>,
    nodes: Vec<Node>,
    free: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    parent: u32,
    steps: u32,
    /// Steps from the root; `u64::MAX` for a node that is cut off.
    cost: u64,
    children: u32,
}

impl Tree {
    pub(super) fn new(root: &[f64], actions: usize) -> Self {
        Self {
            parts: root.len(),
            actions,
            places: root.to_vec(),
            held: vec![0.0; actions],
            nodes: vec![Node {
                parent: NONE,
                steps: 0,
                cost: 0,
                children: 0,
            }],
            free: Vec::new(),
        }
    }

    /// How many places there are.
    pub fn len(&self) -> usize {
        self.nodes.len() - self.free.len()
    }

    /// Whether there are none, which is never: the root stays.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn add(&mut self, parent: u32, action: &[f64], steps: u32, place: &[f64]) -> u32 {
        let node = Node {
            parent,
            steps,
            cost: self.cost(parent) + u64::from(steps),
            children: 0,
        };
        self.nodes[parent as usize].children += 1;
        if let Some(number) = self.free.pop() {
            let at = number as usize;
            self.nodes[at] = node;
            self.places[at * self.parts..(at + 1) * self.parts].copy_from_slice(place);
            self.held[at * self.actions..(at + 1) * self.actions].copy_from_slice(action);
            return number;
        }
        let number = self.nodes.len() as u32;
        self.nodes.push(node);
        self.places.extend_from_slice(place);
        self.held.extend_from_slice(action);
        number
    }

    /// Steps from the root.
    pub(super) fn cost(&self, node: u32) -> u64 {
        self.nodes[node as usize].cost
    }

    pub(super) fn place(&self, node: u32) -> &[f64] {
        let at = node as usize;
        &self.places[at * self.parts..(at + 1) * self.parts]
    }

    /// Cuts off a leaf and gives its parent; nothing if it has children or is the root.
    pub(super) fn cut(&mut self, node: u32) -> Option<u32> {
        let Node {
            parent, children, ..
        } = self.nodes[node as usize];
        if children > 0 || parent == NONE {
            return None;
        }
        self.nodes[node as usize].cost = u64::MAX;
        self.nodes[parent as usize].children -= 1;
        self.free.push(node);
        Some(parent)
    }

    pub(super) fn path(&self, mut node: u32, step: f64) -> Path {
        let mut pieces = Vec::new();
        loop {
            let Node { parent, steps, .. } = self.nodes[node as usize];
            if parent == NONE {
                break;
            }
            let at = node as usize;
            pieces.push(Piece {
                action: self.held[at * self.actions..(at + 1) * self.actions].to_vec(),
                steps,
                end: self.place(node).to_vec(),
            });
            node = parent;
        }
        pieces.reverse();
        Path {
            start: self.place(0).to_vec(),
            pieces,
            step,
        }
    }

    /// All branches: the place where one begins, the action, for how many steps it is held, the place where it ends.
    pub fn branches(&self) -> impl Iterator<Item = (&[f64], &[f64], u32, &[f64])> {
        let lives = |(_, node): &(usize, &Node)| node.parent != NONE && node.cost != u64::MAX;
        let all = self.nodes.iter().enumerate().filter(lives);
        all.map(|(at, node)| {
            let action = &self.held[at * self.actions..(at + 1) * self.actions];
            (
                self.place(node.parent),
                action,
                node.steps,
                self.place(at as u32),
            )
        })
    }
}
