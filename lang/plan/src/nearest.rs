//! Nearest neighbours among points that come and go, on lines and circles: exact, and the first of equals.
//!
//! Owns the index: k-d trees with boxes whose sizes double, so that adding a point is cheap. Knows no robot.

use std::mem;

use crate::limits::PLAN_AXES_MAX;

/// Points that are looked at one by one, before they make a tree.
const FRESH: usize = 32;
/// Points of a leaf.
const LEAF: usize = 8;
/// Stands for a point that was taken away.
const GONE: u32 = u32::MAX;

/// What [`Nearest::insert`] gives, for [`Nearest::remove`].
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Key(u32);

/// Points with a number each. Coordinates are as the metric scales them; the distance is the square root of the sum of
/// squares, where a coordinate with a period is measured the short way round.
#[derive(Clone, Debug)]
pub struct Nearest {
    /// Infinite where there is no circle.
    periods: Vec<f64>,
    /// The number of each key, or [`GONE`].
    numbers: Vec<u32>,
    fresh: Cloud,
    trees: Vec<Option<Tree>>,
    live: usize,
    dead: usize,
}

/// Points in a row with their keys.
#[derive(Clone, Debug, Default)]
struct Cloud {
    points: Vec<f64>,
    keys: Vec<u32>,
}

#[derive(Clone, Debug)]
struct Tree {
    cloud: Cloud,
    /// In preorder: the left child of a node is the next one.
    nodes: Vec<Node>,
    /// For each node its lowest coordinates and then its highest.
    boxes: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    from: u32,
    to: u32,
    /// The right child, 0 for a leaf.
    right: u32,
    /// The least key in it: of equal distances the first point counts, so that nothing else of a heap of equal points
    /// is looked at.
    first: u32,
}

/// The best so far: squared distance, then key.
#[derive(Clone, Copy)]
struct Best {
    square: f64,
    key: u32,
}

impl Best {
    fn offer(&mut self, square: f64, key: u32) {
        if square < self.square || (square == self.square && key < self.key) {
            *self = Self { square, key };
        }
    }
}

impl Nearest {
    /// An empty one for points with so many coordinates, at most [`PLAN_AXES_MAX`]; those on a circle have its length,
    /// others an infinite one, and stay within half of it around zero.
    pub fn new(periods: &[f64]) -> Self {
        let used = periods.len().min(PLAN_AXES_MAX);
        Self {
            periods: periods[..used].to_vec(),
            numbers: Vec::new(),
            fresh: Cloud::default(),
            trees: Vec::new(),
            live: 0,
            dead: 0,
        }
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.live
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.live == 0
    }

    /// Adds a point under a number below `u32::MAX`.
    pub fn insert(&mut self, number: u32, point: &[f64]) -> Key {
        let key = u32::try_from(self.numbers.len()).unwrap_or(GONE);
        self.numbers.push(number);
        self.fresh.push(point, key);
        self.live += 1;
        if self.fresh.keys.len() >= FRESH {
            let cloud = mem::take(&mut self.fresh);
            self.carry(cloud);
        }
        Key(key)
    }

    /// Takes a point away; a second time nothing happens.
    pub fn remove(&mut self, key: Key) {
        let Some(number) = self.numbers.get_mut(key.0 as usize) else {
            return;
        };
        if *number == GONE {
            return;
        }
        *number = GONE;
        self.live -= 1;
        self.dead += 1;
        if self.dead > self.live + 2 * FRESH {
            let mut all = mem::take(&mut self.fresh);
            for tree in mem::take(&mut self.trees).into_iter().flatten() {
                all.append(tree.cloud);
            }
            self.dead = 0;
            self.carry(all);
        }
    }

    /// The nearest point and how far it is; of several the one that was added first. Nothing near a point that is no
    /// number.
    pub fn nearest(&self, point: &[f64]) -> Option<(u32, f64)> {
        let mut best = Best {
            square: f64::INFINITY,
            key: GONE,
        };
        // The largest first: what it finds saves work in the others.
        for tree in self.trees.iter().rev().flatten() {
            tree.nearest(self, 0, tree.gap(self, 0, point), point, &mut best);
        }
        self.fresh
            .offer_range(self, 0, self.fresh.keys.len(), point, &mut best);
        let number = *self.numbers.get(best.key as usize)?;
        Some((number, best.square.sqrt()))
    }

    /// Calls for each point that is not further away than a radius, with its number; in no order that means anything, but
    /// always in the same.
    pub fn within(&self, point: &[f64], radius: f64, mut found: impl FnMut(u32)) {
        let most = radius * radius;
        let mut look = |cloud: &Cloud, from: usize, to: usize| {
            for at in from..to {
                let number = self.numbers[cloud.keys[at] as usize];
                if number != GONE && self.square(cloud.point(self, at), point) <= most {
                    found(number);
                }
            }
        };
        for tree in self.trees.iter().rev().flatten() {
            tree.within(self, 0, most, point, &mut look);
        }
        look(&self.fresh, 0, self.fresh.keys.len());
    }

    fn square(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut sum = 0.0;
        for ((a, b), period) in a.iter().zip(b).zip(&self.periods) {
            let gap = around((a - b).abs(), *period);
            sum += gap * gap;
        }
        sum
    }

    /// Puts points into the smallest free tree that is large enough, together with all trees below it.
    fn carry(&mut self, mut cloud: Cloud) {
        let mut level = 0;
        loop {
            if self.trees.len() <= level {
                self.trees.push(None);
            }
            match self.trees[level].take() {
                Some(tree) => cloud.append(tree.cloud),
                None if cloud.keys.len() <= FRESH << level => break,
                None => {}
            }
            level += 1;
        }
        let before = cloud.keys.len();
        cloud.forget_dead(&self.numbers, self.periods.len());
        self.dead = self.dead.saturating_sub(before - cloud.keys.len());
        if !cloud.keys.is_empty() {
            self.trees[level] = Some(Tree::new(cloud, self.periods.len()));
        }
    }
}

/// The short way, of two ways round a circle.
fn around(gap: f64, period: f64) -> f64 {
    gap.min((period - gap).abs())
}

impl Cloud {
    fn push(&mut self, point: &[f64], key: u32) {
        self.points.extend_from_slice(point);
        self.keys.push(key);
    }

    fn append(&mut self, mut other: Self) {
        self.points.append(&mut other.points);
        self.keys.append(&mut other.keys);
    }

    fn point(&self, of: &Nearest, at: usize) -> &[f64] {
        let size = of.periods.len();
        &self.points[at * size..(at + 1) * size]
    }

    fn forget_dead(&mut self, numbers: &[u32], size: usize) {
        let mut kept = 0;
        for at in 0..self.keys.len() {
            if numbers[self.keys[at] as usize] != GONE {
                self.keys[kept] = self.keys[at];
                self.points
                    .copy_within(at * size..(at + 1) * size, kept * size);
                kept += 1;
            }
        }
        self.keys.truncate(kept);
        self.points.truncate(kept * size);
    }

    fn offer_range(&self, of: &Nearest, from: usize, to: usize, point: &[f64], best: &mut Best) {
        for at in from..to {
            let key = self.keys[at];
            if of.numbers[key as usize] != GONE {
                best.offer(of.square(self.point(of, at), point), key);
            }
        }
    }
}

impl Tree {
    fn new(cloud: Cloud, size: usize) -> Self {
        let mut order: Vec<u32> = (0..cloud.keys.len()).map(|at| at as u32).collect();
        let mut tree = Self {
            cloud: Cloud::default(),
            nodes: Vec::new(),
            boxes: Vec::new(),
        };
        tree.grow(&cloud, size, &mut order, 0);
        for at in order {
            let at = at as usize;
            let point = &cloud.points[at * size..(at + 1) * size];
            tree.cloud.push(point, cloud.keys[at]);
        }
        tree
    }

    /// Adds the node of these points, whose first one has the place `from` in the end, and all nodes below it. No deeper
    /// than the logarithm of their number.
    fn grow(&mut self, cloud: &Cloud, size: usize, order: &mut [u32], from: usize) {
        let this = self.nodes.len();
        self.nodes.push(Node {
            from: from as u32,
            to: (from + order.len()) as u32,
            right: 0,
            first: order
                .iter()
                .map(|&at| cloud.keys[at as usize])
                .min()
                .unwrap_or(GONE),
        });
        let of = |at: u32, axis: usize| cloud.points[at as usize * size + axis];
        let (mut widest, mut width) = (0, -1.0);
        let base = self.boxes.len();
        self.boxes.resize(base + 2 * size, 0.0);
        for axis in 0..size {
            let values = || order.iter().map(|&at| of(at, axis));
            let low = values().fold(f64::INFINITY, f64::min);
            let high = values().fold(f64::NEG_INFINITY, f64::max);
            self.boxes[base + axis] = low;
            self.boxes[base + size + axis] = high;
            if high - low > width {
                (widest, width) = (axis, high - low);
            }
        }
        if order.len() <= LEAF {
            return;
        }
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&a, &b| {
            let by_place = of(a, widest).total_cmp(&of(b, widest));
            by_place.then(cloud.keys[a as usize].cmp(&cloud.keys[b as usize]))
        });
        let (left, right) = order.split_at_mut(middle);
        self.grow(cloud, size, left, from);
        self.nodes[this].right = self.nodes.len() as u32;
        self.grow(cloud, size, right, from + middle);
    }

    /// The squared distance of a point to the box of a node.
    fn gap(&self, of: &Nearest, node: usize, point: &[f64]) -> f64 {
        let size = of.periods.len();
        let (lows, highs) = self.boxes[node * 2 * size..(node + 1) * 2 * size].split_at(size);
        let mut sum = 0.0;
        for axis in 0..size {
            let (at, low, high) = (point[axis], lows[axis], highs[axis]);
            let outside = (low - at).max(at - high);
            if outside > 0.0 {
                let period = of.periods[axis];
                let near = around((low - at).abs(), period).min(around((at - high).abs(), period));
                sum += near * near;
            }
        }
        sum
    }

    fn nearest(&self, of: &Nearest, node: usize, gap: f64, point: &[f64], best: &mut Best) {
        let Node {
            from,
            to,
            right,
            first,
        } = self.nodes[node];
        if gap > best.square || (gap == best.square && first > best.key) {
            return;
        }
        if right == 0 {
            self.cloud
                .offer_range(of, from as usize, to as usize, point, best);
            return;
        }
        let (left, right) = (node + 1, right as usize);
        let (left_gap, right_gap) = (self.gap(of, left, point), self.gap(of, right, point));
        let is_first = self.nodes[left].first < self.nodes[right].first;
        if left_gap < right_gap || (left_gap == right_gap && is_first) {
            self.nearest(of, left, left_gap, point, best);
            self.nearest(of, right, right_gap, point, best);
        } else {
            self.nearest(of, right, right_gap, point, best);
            self.nearest(of, left, left_gap, point, best);
        }
    }

    fn within(
        &self,
        of: &Nearest,
        node: usize,
        most: f64,
        point: &[f64],
        look: &mut impl FnMut(&Cloud, usize, usize),
    ) {
        if self.gap(of, node, point) > most {
            return;
        }
        let Node {
            from, to, right, ..
        } = self.nodes[node];
        if right == 0 {
            look(&self.cloud, from as usize, to as usize);
        } else {
            self.within(of, node + 1, most, point, look);
            self.within(of, right as usize, most, point, look);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;
    use std::f64::consts::PI;

    /// What the index must find: all, one by one.
    struct Plain(Vec<(u32, Vec<f64>, Key)>);

    impl Plain {
        fn nearest(&self, of: &Nearest, point: &[f64]) -> Option<(u32, f64)> {
            let mut best: Option<(u32, f64)> = None;
            for (number, at, _) in &self.0 {
                let far = of.square(at, point);
                if best.is_none_or(|(_, least)| far < least) {
                    best = Some((*number, far));
                }
            }
            best.map(|(number, far)| (number, far.sqrt()))
        }
    }

    /// Some coordinates are rounded, so that equal distances and equal points are common.
    fn point(random: &mut Random, periods: &[f64]) -> Vec<f64> {
        let mut one = |period: &f64| {
            let far = if period.is_finite() {
                period / 2.0
            } else {
                3.0
            };
            let at = random.between(-far, far);
            if random.whole(0, 2) == 0 {
                at.round()
            } else {
                at
            }
        };
        periods.iter().map(&mut one).collect()
    }

    #[test]
    fn finds_what_looking_at_all_points_finds() {
        const LINE: f64 = f64::INFINITY;
        for (seed, periods) in [
            &[LINE][..],
            &[2.0 * PI],
            &[LINE, LINE, 2.0 * PI],
            &[LINE, 1.0, 2.0 * PI, LINE, LINE],
        ]
        .iter()
        .enumerate()
        {
            let mut random = Random::new(seed as u64);
            let mut index = Nearest::new(periods);
            let mut plain = Plain(Vec::new());
            assert_eq!(index.nearest(&vec![0.0; periods.len()]), None);
            for number in 0..3000 {
                let at = point(&mut random, periods);
                let key = index.insert(number, &at);
                plain.0.push((number, at, key));
                // In the middle more go than come.
                let takes = if (1000..1800).contains(&number) { 2 } else { 0 };
                for _ in 0..takes {
                    if plain.0.len() > 1 {
                        let last = u32::try_from(plain.0.len() - 1).unwrap();
                        let (_, _, key) = plain.0.remove(random.whole(0, last) as usize);
                        index.remove(key);
                        index.remove(key);
                    }
                }
                assert_eq!(index.len(), plain.0.len());
                let asked = point(&mut random, periods);
                assert_eq!(index.nearest(&asked), plain.nearest(&index, &asked));
                if number % 50 == 0 {
                    let mut found = Vec::new();
                    index.within(&asked, 0.8, |number| found.push(number));
                    found.sort_unstable();
                    let near =
                        |one: &&(u32, Vec<f64>, Key)| index.square(&one.1, &asked) <= 0.8 * 0.8;
                    let want: Vec<u32> = plain.0.iter().filter(near).map(|one| one.0).collect();
                    assert_eq!(found, want);
                }
            }
        }
    }

    #[test]
    fn a_point_that_is_no_number_is_near_to_nothing() {
        let mut index = Nearest::new(&[f64::INFINITY]);
        for number in 0..100 {
            index.insert(number, &[f64::from(number)]);
        }
        assert_eq!(index.nearest(&[f64::NAN]), None);
        assert_eq!(index.nearest(&[1e100]).map(|(_, far)| far), Some(1e100));
    }
}
