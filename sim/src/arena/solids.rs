//! What robots run into and rays end at: walls, and things that can be pushed.
//!
//! Owns their outlines and the search among them. Knows no robots. Walls stand in a tree of rectangles, so a million of
//! questions a second are answered among thousands of walls; things that move are few and are looked through.

use super::outline::{Bounds, Outline};
use crate::field::{Field, Solid, SolidKind, Wall};
use crate::geometry::{Point, point};

/// Walls of one leaf of the tree.
const LEAF: usize = 4;
/// The tree halves what it holds, so its depth is below this for any field.
const DEPTH: usize = 64;
/// A wall without a length is this long.
const POINT_LENGTH: f64 = 0.1;
/// By how much a thing's outline is within what is drawn of it.
const MARGIN: f64 = 1.0;

/// A part of the tree.
#[derive(Clone, Copy, Debug)]
struct Branch {
    bounds: Bounds,
    /// Of a leaf: its first and last wall.
    walls: (u32, u32),
    /// Of another one: its second half; the first one follows it.
    second: u32,
}

/// Everything solid on a field.
#[derive(Clone, Debug, Default)]
pub struct Solids {
    walls: Outline,
    tree: Vec<Branch>,
    movable: Vec<Outline>,
}

impl Solids {
    /// What is solid on a field.
    pub fn of(field: &Field) -> Self {
        let mut all: Vec<[Point; 4]> = field.walls.iter().map(wall).collect();
        let mut tree = Vec::new();
        if !all.is_empty() {
            let count = all.len();
            plant(&mut all, 0, count, &mut tree);
        }
        let mut walls = Outline::default();
        for corners in all {
            walls.add(corners);
        }
        Self {
            walls,
            tree,
            movable: field.solids.iter().map(outline_of).collect(),
        }
    }

    /// A thing has moved: `index` is that of [`Field::solids`].
    pub fn moved(&mut self, index: usize, solid: &Solid) {
        if let Some(outline) = self.movable.get_mut(index) {
            *outline = outline_of(solid);
        }
    }

    /// Whether figures touch or hold something solid, or are held by it.
    pub fn meets(&self, figures: &Outline) -> bool {
        let around = figures.bounds();
        let mut is_met = false;
        self.each_near(&around, |corners, bounds| {
            is_met = figures.is_crossed_by(corners, bounds) || figures.contains(corners[0]);
            !is_met
        });
        is_met
            || (0..figures.len()).any(|figure| {
                let corner = figures.corners(figure)[0];
                self.contains(corner)
            })
    }

    /// Whether a point is inside an odd number of solid things.
    pub fn contains(&self, at: Point) -> bool {
        let mut count = 0;
        self.each_near(&Bounds::of(&[at]), |corners, _| {
            count += usize::from(super::outline::is_inside(corners, at));
            true
        });
        count % 2 == 1
    }

    /// Shows the corners of everything that may be within a rectangle, until the answer is false.
    pub fn each_near(&self, around: &Bounds, mut show: impl FnMut(&[Point], &Bounds) -> bool) {
        for outline in &self.movable {
            let bounds = outline.bounds_of(0);
            if bounds.meets(around) && !show(outline.corners(0), &bounds) {
                return;
            }
        }
        let mut open = [0u32; DEPTH];
        let mut depth = usize::from(!self.tree.is_empty());
        while depth > 0 {
            depth -= 1;
            let at = open[depth];
            let branch = &self.tree[at as usize];
            if !branch.bounds.meets(around) {
                continue;
            }
            if branch.second == 0 {
                for wall in branch.walls.0..branch.walls.1 {
                    let bounds = self.walls.bounds_of(wall as usize);
                    if bounds.meets(around) && !show(self.walls.corners(wall as usize), &bounds) {
                        return;
                    }
                }
            } else if depth + 2 <= DEPTH {
                open[depth] = branch.second;
                open[depth + 1] = at + 1;
                depth += 2;
            }
        }
    }
}

/// Makes the tree over `all[begin..end]`, which it sorts.
fn plant(all: &mut [[Point; 4]], begin: usize, end: usize, tree: &mut Vec<Branch>) {
    let part = &mut all[begin..end];
    let bounds = part
        .iter()
        .fold(Bounds::NOTHING, |all, one| all.joined(Bounds::of(one)));
    let at = tree.len();
    tree.push(Branch {
        bounds,
        walls: (begin as u32, end as u32),
        second: 0,
    });
    if part.len() <= LEAF {
        return;
    }
    let size = bounds.high.from(bounds.low);
    let key = |corners: &[Point; 4]| {
        if size.x >= size.y {
            corners[0].x + corners[2].x
        } else {
            corners[0].y + corners[2].y
        }
    };
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |one, other| key(one).total_cmp(&key(other)));
    plant(all, begin, begin + middle, tree);
    tree[at].second = tree.len() as u32;
    plant(all, begin + middle, end, tree);
}

/// The corners of a wall: a bar without round ends.
pub fn wall(wall: &Wall) -> [Point; 4] {
    let begin = wall.begin;
    let mut end = wall.end;
    let mut along = end.from(begin);
    if along.length() < 1e-8 {
        end = point(end.x + POINT_LENGTH, end.y);
        along = point(POINT_LENGTH, 0.0);
    }
    let half = wall.width / 2.0 / along.length();
    let aside = point(-along.y * half, along.x * half);
    [
        point(begin.x + aside.x, begin.y + aside.y),
        point(end.x + aside.x, end.y + aside.y),
        point(end.x - aside.x, end.y - aside.y),
        point(begin.x - aside.x, begin.y - aside.y),
    ]
}

/// The outline of a thing that can be pushed.
pub fn outline_of(solid: &Solid) -> Outline {
    let mut outline = Outline::default();
    let half = solid.size / 2.0;
    let (sin, cos) = libm::sincos(solid.rotation.to_radians());
    let turned = |x: f64, y: f64| point(x * cos - y * sin, x * sin + y * cos);
    if solid.kind == SolidKind::Cube {
        outline.add(
            [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| {
                let corner = turned(x, y);
                point(solid.at.x + corner.x, solid.at.y + corner.y)
            }),
        );
        return outline;
    }
    // The original turns a round thing about the corner of its square.
    let radius = (half - MARGIN).max(0.0);
    let centre = turned(radius, radius);
    let corner = point(solid.at.x - radius, solid.at.y - radius);
    outline.add_circle(point(corner.x + centre.x, corner.y + centre.y), radius);
    outline
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn spot(x: f64, y: f64, size: f64) -> Outline {
        let mut outline = Outline::default();
        outline.add([
            point(x, y),
            point(x + size, y),
            point(x + size, y + size),
            point(x, y + size),
        ]);
        outline
    }

    #[test]
    fn a_wall_is_as_wide_as_it_says_and_has_flat_ends() {
        let field = Field {
            walls: vec![Wall::new(point(200.0, -100.0), point(200.0, 100.0))],
            ..Field::default()
        };
        let solids = Solids::of(&field);
        assert!(!solids.meets(&spot(184.9, 0.0, 10.0)));
        assert!(solids.meets(&spot(185.0, 0.0, 10.0)));
        assert!(solids.meets(&spot(199.0, 0.0, 1.0)));
        assert!(!solids.meets(&spot(199.0, 100.1, 1.0)));
        assert!(solids.contains(point(204.0, 99.0)));
    }

    #[test]
    fn the_tree_finds_what_a_look_at_all_finds() {
        let mut random = Random::new(5);
        let mut walls = Vec::new();
        for _ in 0..500 {
            let begin = point(random.within(1000.0), random.within(1000.0));
            let end = point(begin.x + random.within(60.0), begin.y + random.within(60.0));
            walls.push(Wall::new(begin, end));
        }
        let solids = Solids::of(&Field {
            walls: walls.clone(),
            ..Field::default()
        });
        let mut met = 0;
        for _ in 0..2000 {
            let one = spot(random.within(1000.0), random.within(1000.0), 10.0);
            let plain = walls.iter().any(|other| {
                let mut figure = Outline::default();
                figure.add(wall(other));
                one.is_crossed_by(figure.corners(0), &figure.bounds_of(0))
                    || one.contains(figure.corners(0)[0])
                    || figure.contains(one.corners(0)[0])
            });
            assert_eq!(solids.meets(&one), plain);
            met += usize::from(plain);
        }
        assert!((100..1900).contains(&met), "{met}");
    }

    #[test]
    fn balls_are_a_pixel_smaller_than_they_look() {
        let ball = Solid::new(SolidKind::Ball, point(100.0, 0.0));
        let solids = Solids::of(&Field {
            solids: vec![ball],
            ..Field::default()
        });
        assert!(!solids.meets(&spot(75.0, -5.0, 10.9)));
        assert!(solids.meets(&spot(75.0, -5.0, 11.1)));
        // A robot over it holds it.
        assert!(solids.meets(&spot(50.0, -50.0, 100.0)));
    }
}
