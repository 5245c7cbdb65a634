//! Ways of edges in a picture: as they were drawn, unless they run through a block; then around it, by lines beside blocks.
//!
//! Owns which ways are bad, and how much is looked at for better ones: then edges stay as they were drawn. The same pictures
//! in the same order have the same ways each time. Knows neither ports nor colours.

mod search;

use crate::limits::{ROUTE_BOXES_MAX, ROUTE_LOOKS_MAX};
use std::collections::{BTreeSet, HashMap};
use std::ops::RangeInclusive;

/// A place, in px.
pub(super) type Place = (f64, f64);

/// The side of a square of the index, in px: about a block with its gap.
const SQUARE: f64 = 160.0;
/// How near a new way may come to a block.
const CLEAR: f64 = 6.0;
/// How deep an edge may run in its own block, to ports that are not at its border.
const CORE: f64 = 18.0;
/// How far beside blocks the ways of the first lane run.
const BESIDE: f64 = 10.0;
/// Between two lanes.
const LANE: f64 = 4.0;
/// How many lanes there are; as many fit between two columns.
const LANES: usize = 6;
/// How far beyond both ends blocks are gone around.
const AROUND: f64 = 400.0;

/// A block as something in the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Obstacle {
    /// Left and top.
    pub low: Place,
    /// Right and bottom.
    pub high: Place,
    /// How far its words reach below it: edges may run there, but rather do not.
    pub words: f64,
}

impl Obstacle {
    fn grown(&self, by: f64) -> [Place; 2] {
        [
            (self.low.0 - by, self.low.1 - by),
            (self.high.0 + by, self.high.1 + by),
        ]
    }

    fn below(&self) -> [Place; 2] {
        let bottom = self.high.1;
        [(self.low.0, bottom), (self.high.0, bottom + self.words)]
    }
}

/// An end of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    /// Where it is.
    pub at: Place,
    /// Its block, if it is at one.
    pub block: Option<usize>,
    /// Whether it is at a port; otherwise it is in the middle of its block.
    pub is_port: bool,
}

/// A port: the block, and its number.
type Port = (usize, i32);

/// What is in the way of a line.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Seen {
    Nothing,
    Words,
    Block,
}

/// How much may still be looked at for ways: of one picture, or of all those that are drawn one after the other, so that many
/// small ones take no longer than a large one.
#[derive(Debug)]
pub struct Looks {
    left: usize,
}

impl Looks {
    /// So many; without any, all edges stay as they were drawn.
    pub const fn at_most(left: usize) -> Self {
        Self { left }
    }

    /// How many are left.
    pub const fn left(&self) -> usize {
        self.left
    }
}

impl Default for Looks {
    fn default() -> Self {
        Self::at_most(ROUTE_LOOKS_MAX)
    }
}

/// The blocks of a picture, by the squares that they are in.
pub(super) struct Ways<'a> {
    blocks: Vec<Obstacle>,
    squares: HashMap<(i64, i64), Vec<u32>>,
    /// The lanes of ports from which edges run around blocks.
    lanes: HashMap<Port, usize>,
    looks: &'a mut Looks,
}

fn square(number: f64) -> i64 {
    (number / SQUARE).floor() as i64
}

impl<'a> Ways<'a> {
    pub fn new(blocks: Vec<Obstacle>, looks: &'a mut Looks) -> Self {
        let mut squares: HashMap<(i64, i64), Vec<u32>> = HashMap::new();
        for (index, block) in (0..).zip(&blocks) {
            let [low, high] = block.grown(CLEAR);
            for x in square(low.0)..=square(high.0) {
                for y in square(low.1)..=square(high.1 + block.words) {
                    squares.entry((x, y)).or_default().push(index);
                }
            }
        }
        Self {
            blocks,
            squares,
            lanes: HashMap::new(),
            looks,
        }
    }

    /// The way of an edge: `drawn`, or around what that runs through. Edges that begin at one port share their
    /// lines, and others have their own as long as there are lanes.
    pub fn way(&mut self, drawn: Vec<Place>, ends: [Stop; 2], from: Option<Port>) -> Vec<Place> {
        if !self.is_bad(&drawn, ends) {
            return drawn;
        }
        let next = self.lanes.len();
        let lane = from.map_or(next, |from| *self.lanes.entry(from).or_insert(next));
        let beside = BESIDE + LANE * (lane % LANES) as f64;
        self.around(ends, beside).unwrap_or(drawn)
    }

    /// Whether a way runs through a block that is not its own, or through the middle of one that is.
    fn is_bad(&mut self, way: &[Place], ends: [Stop; 2]) -> bool {
        let space = |index: usize| {
            let own = ends.iter().find(|end| end.block == Some(index));
            match own {
                None => Some(0.0),
                // From the middle of a block every way leads through it.
                Some(_) => ends
                    .iter()
                    .all(|end| end.is_port || end.block != Some(index))
                    .then_some(-CORE),
            }
        };
        way.windows(2)
            .any(|line| self.look(line[0], line[1], &space) == Seen::Block)
    }

    /// A way around all blocks: straight out of both, and between them by lines beside blocks.
    fn around(&mut self, ends: [Stop; 2], beside: f64) -> Option<Vec<Place>> {
        let mut outer = [(0.0, 0.0); 2];
        for (end, outer) in ends.iter().zip(&mut outer) {
            *outer = self.outside(end, beside);
            let space = |index: usize| (end.block != Some(index)).then_some(0.0);
            if self.look(end.at, *outer, &space) == Seen::Block {
                return None;
            }
        }
        let near = self.near(outer);
        let inner = search::search(self, &near, outer, beside)?;
        let mut way = vec![ends[0].at];
        way.extend(inner);
        way.push(ends[1].at);
        Some(straightened(&way))
    }

    /// The place beside its block from which the way to an end is straight: by the side that is nearest.
    fn outside(&self, end: &Stop, beside: f64) -> Place {
        let Some(block) = end.block.and_then(|block| self.blocks.get(block)) else {
            return end.at;
        };
        let (x, y) = end.at;
        let ([left, top], [right, bottom]) = (
            [block.low.0 - beside, block.low.1 - beside],
            [block.high.0 + beside, block.high.1 + beside],
        );
        let sides = [(left, y), (right, y), (x, top), (x, bottom)];
        let far = |place: &Place| (place.0 - x).abs() + (place.1 - y).abs();
        let nearest = sides
            .into_iter()
            .min_by(|one, other| far(one).total_cmp(&far(other)));
        nearest.unwrap_or(end.at)
    }

    /// Blocks beside which a way may run: those in the squares between both ends and a little around, the nearest to the
    /// first end before others.
    fn near(&mut self, [from, to]: [Place; 2]) -> Vec<usize> {
        let low = (from.0.min(to.0) - AROUND, from.1.min(to.1) - AROUND);
        let high = (from.0.max(to.0) + AROUND, from.1.max(to.1) + AROUND);
        let mut near = self.within(low, high);
        let line = |index: &usize| {
            let block = &self.blocks[*index];
            let middle = (
                f64::midpoint(block.low.0, block.high.0),
                f64::midpoint(block.low.1, block.high.1),
            );
            // By both legs of the triangle: what is near the straight line comes first.
            let leg = |end: Place| libm::hypot(middle.0 - end.0, middle.1 - end.1);
            leg(from) + leg(to)
        };
        near.sort_by(|one, other| line(one).total_cmp(&line(other)));
        near.truncate(ROUTE_BOXES_MAX);
        near
    }

    /// Blocks in the squares of a rectangle, or, if these are more than there are blocks, blocks in the rectangle.
    fn within(&mut self, low: Place, high: Place) -> Vec<usize> {
        let (columns, rows) = (
            square(low.0)..=square(high.0),
            square(low.1)..=square(high.1),
        );
        let count = |one: &RangeInclusive<i64>| usize::try_from(one.end() - one.start() + 1);
        let squares = count(&columns)
            .and_then(|columns| Ok(columns.saturating_mul(count(&rows)?)))
            .unwrap_or(usize::MAX);
        self.looks.left = self
            .looks
            .left
            .saturating_sub(squares.min(self.blocks.len()));
        if squares > self.blocks.len() {
            let is_in = |block: &Obstacle| {
                let (right, bottom) = block.high;
                block.low.0 <= high.0 && right >= low.0 && block.low.1 <= high.1 && bottom >= low.1
            };
            let all = self.blocks.iter().enumerate();
            return all
                .filter_map(|(index, block)| is_in(block).then_some(index))
                .collect();
        }
        let mut found = BTreeSet::new();
        for x in columns {
            for y in rows.clone() {
                let blocks = self.squares.get(&(x, y)).map_or(&[][..], Vec::as_slice);
                found.extend(blocks.iter().map(|index| *index as usize));
            }
        }
        found.into_iter().collect()
    }

    /// What a straight line meets. `space` says how far around a block it may not run, below 0: how deep it may run in it,
    /// and nothing if the block is not in its way.
    fn look(&mut self, from: Place, to: Place, space: &dyn Fn(usize) -> Option<f64>) -> Seen {
        let mut seen = Seen::Nothing;
        let (left, right) = (from.0.min(to.0), from.0.max(to.0));
        for x in square(left)..=square(right) {
            // The part of the line in this column of squares.
            let at = |edge: f64| {
                let part = (edge.clamp(left, right) - from.0) / (to.0 - from.0);
                from.1 + part * (to.1 - from.1)
            };
            let (one, other) = match (right - left).abs() < f64::EPSILON {
                true => (from.1, to.1),
                false => (at(x as f64 * SQUARE), at((x + 1) as f64 * SQUARE)),
            };
            for y in square(one.min(other))..=square(one.max(other)) {
                let blocks = self.squares.get(&(x, y)).map_or(&[][..], Vec::as_slice);
                let cost = blocks.len() + 1;
                if self.looks.left < cost {
                    self.looks.left = 0;
                    return seen;
                }
                self.looks.left -= cost;
                for &index in blocks {
                    let block = &self.blocks[index as usize];
                    let Some(space) = space(index as usize) else {
                        continue;
                    };
                    if meets(from, to, block.grown(space)) {
                        return Seen::Block;
                    }
                    if seen == Seen::Nothing && meets(from, to, block.below()) {
                        seen = Seen::Words;
                    }
                }
            }
        }
        seen
    }
}

/// Whether a line has a part inside of a rectangle; its border is outside.
pub(super) fn meets(from: Place, to: Place, [low, high]: [Place; 2]) -> bool {
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    let sides = [
        (from.0, to.0 - from.0, low.0, high.0),
        (from.1, to.1 - from.1, low.1, high.1),
    ];
    for (start, long, low, high) in sides {
        if low >= high {
            return false;
        }
        if long == 0.0 {
            if start <= low || start >= high {
                return false;
            }
            continue;
        }
        let (one, other) = ((low - start) / long, (high - start) / long);
        first = first.max(one.min(other));
        last = last.min(one.max(other));
    }
    first < last
}

/// A way without places between two others on one line.
fn straightened(way: &[Place]) -> Vec<Place> {
    let mut all: Vec<Place> = Vec::with_capacity(way.len());
    for &place in way {
        if all.last() == Some(&place) {
            continue;
        }
        if let [.., before, last] = all[..] {
            let is_upright = before.0 == last.0 && last.0 == place.0;
            let is_level = before.1 == last.1 && last.1 == place.1;
            if is_upright || is_level {
                all.pop();
            }
        }
        all.push(place);
    }
    all
}

#[cfg(test)]
mod tests;
