//! The world around a robot: walls, a floor with lines painted on it, and coloured balls.
//!
//! Owns what stands where and what a ray meets; knows no robot and no sensor.

use crate::geometry::{Point, Segment, circle_met_by, point};
use crate::show::{Item, Kind, Movable};

/// Red, green and blue, 0 to 255 each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour {
    /// Red.
    pub red: u8,
    /// Green.
    pub green: u8,
    /// Blue.
    pub blue: u8,
}

impl Colour {
    /// As `#rrggbb`.
    pub fn text(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.red, self.green, self.blue)
    }
}

/// A colour from its parts.
pub const fn colour(red: u8, green: u8, blue: u8) -> Colour {
    Colour { red, green, blue }
}

/// The colour of the floor where no line is.
pub const FLOOR: Colour = colour(235, 235, 230);
const LINE: Colour = colour(12, 12, 12);
const WALL: Colour = colour(120, 150, 190);
/// Walls have no width; people see this one.
const WALL_SHOWN_M: f64 = 0.012;

/// A painted line on the floor.
#[derive(Debug, Clone)]
struct Line {
    corners: Vec<Point>,
    width_m: f64,
}

/// A ball on the floor, for the object sensor; robots push it aside: it is no obstacle.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    /// Where it lies.
    pub at: Point,
    /// Its radius.
    pub radius_m: f64,
    /// Its colour.
    pub colour: Colour,
}

/// Walls, floor and things.
#[derive(Debug, Clone, Default)]
pub struct World {
    walls: Vec<Segment>,
    lines: Vec<Line>,
    balls: Vec<Ball>,
}

impl World {
    /// An endless empty white floor.
    pub fn empty() -> Self {
        Self::default()
    }

    /// A closed room of 3 m x 2 m with its corner at (0, 0), two boxes, a black loop with a crossing, and a red ball.
    pub fn room() -> Self {
        let mut world = Self::empty();
        world.add_box(point(0.0, 0.0), point(3.0, 2.0));
        world.add_box(point(1.3, 0.85), point(1.6, 1.15));
        world.add_box(point(2.75, 1.75), point(3.0, 2.0));
        world.add_line(loop_of(point(0.5, 0.4), point(2.5, 1.6), 0.3), 0.03);
        // The crossing is on the upper straight.
        world.add_line(vec![point(1.5, 1.5), point(1.5, 1.7)], 0.03);
        world.balls.push(Ball {
            at: point(2.7, 1.0),
            radius_m: 0.035,
            colour: colour(210, 20, 20),
        });
        world
    }

    /// One wall.
    pub fn add_wall(&mut self, from: Point, to: Point) {
        self.walls.push(Segment::new(from, to));
    }

    /// Four walls around a rectangle.
    pub fn add_box(&mut self, low: Point, high: Point) {
        let corners = [low, point(high.x, low.y), high, point(low.x, high.y)];
        for (index, &corner) in corners.iter().enumerate() {
            self.add_wall(corner, corners[(index + 1) % 4]);
        }
    }

    /// A black line along these corners.
    pub fn add_line(&mut self, corners: Vec<Point>, width_m: f64) {
        self.lines.push(Line { corners, width_m });
    }

    /// How far a ray goes before it meets a wall or a ball.
    pub fn ray(&self, origin: Point, towards: Point) -> Option<f64> {
        let walls = self
            .walls
            .iter()
            .filter_map(|wall| wall.met_by(origin, towards));
        let balls = self
            .balls
            .iter()
            .filter_map(|ball| circle_met_by(ball.at, ball.radius_m, origin, towards));
        walls.chain(balls).min_by(f64::total_cmp)
    }

    /// The nearest wall before `limit_m`, and its colour.
    pub(crate) fn wall_ahead(
        &self,
        origin: Point,
        towards: Point,
        limit_m: f64,
    ) -> Option<(f64, Colour)> {
        let met = self
            .walls
            .iter()
            .filter_map(|wall| wall.met_by(origin, towards));
        let nearest = met.min_by(f64::total_cmp)?;
        (nearest < limit_m).then_some((nearest, WALL))
    }

    /// The balls.
    pub fn balls(&self) -> &[Ball] {
        &self.balls
    }

    /// A hand puts a ball elsewhere. False: there is no such ball.
    pub fn put_ball(&mut self, index: usize, at: Point) -> bool {
        let ball = self.balls.get_mut(index);
        ball.map(|ball| ball.at = at).is_some()
    }

    /// All balls go to where another world has them.
    pub fn put_balls_of(&mut self, other: &Self) {
        self.balls.clone_from(&other.balls);
    }

    /// Left, bottom, right and top of its walls; nothing without any.
    pub fn bounds(&self) -> Option<[f64; 4]> {
        let ends = || self.walls.iter().flat_map(|wall| [wall.from, wall.to]);
        let first = ends().next()?;
        let begin = [first.x, first.y, first.x, first.y];
        let grown = |[left, bottom, right, top]: [f64; 4], at: Point| {
            [
                left.min(at.x),
                bottom.min(at.y),
                right.max(at.x),
                top.max(at.y),
            ]
        };
        Some(ends().fold(begin, grown))
    }

    /// What stands and lies there, for people: lines, then walls.
    pub fn items(&self) -> Vec<Item> {
        let line =
            |line: &Line| Item::line(Kind::Line, line.corners.clone(), &LINE.text(), line.width_m);
        let wall = |wall: &Segment| {
            let points = vec![wall.from, wall.to];
            Item::line(Kind::Wall, points, &WALL.text(), WALL_SHOWN_M)
        };
        let lines = self.lines.iter().map(line);
        lines.chain(self.walls.iter().map(wall)).collect()
    }

    /// Its balls, for people.
    pub fn things(&self) -> Vec<Movable> {
        let thing = |ball: &Ball| Movable {
            kind: "ball",
            size_m: 2.0 * ball.radius_m,
            colour: ball.colour.text(),
        };
        self.balls.iter().map(thing).collect()
    }

    /// How dark the floor is under a spot of this radius: 0 is white, 1 is a black line.
    pub fn darkness(&self, at: Point, spot_radius_m: f64) -> f64 {
        let dark = |line: &Line| {
            let pieces = line
                .corners
                .windows(2)
                .map(|pair| Segment::new(pair[0], pair[1]));
            let distance = pieces
                .map(|piece| piece.nearest(at).from(at).length())
                .fold(f64::INFINITY, f64::min);
            // The share of the spot that lies on the line, as if the spot were a square.
            ((line.width_m / 2.0 + spot_radius_m - distance) / (2.0 * spot_radius_m))
                .clamp(0.0, 1.0)
        };
        self.lines.iter().map(dark).fold(0.0, f64::max)
    }

    /// The colour of the floor.
    pub(crate) fn floor_colour(&self, at: Point) -> Colour {
        if self.darkness(at, 0.002) > 0.5 {
            LINE
        } else {
            FLOOR
        }
    }

    /// Where a circle that wants to be at `centre` can be: pushed out of every wall that it overlaps.
    /// Says also whether it touched one.
    pub fn pushed_out(&self, mut centre: Point, radius_m: f64) -> (Point, bool) {
        let mut touched = false;
        // In a corner two walls push in turn; a few rounds are enough for a step of a millimetre.
        for _ in 0..4 {
            let mut moved = false;
            for wall in &self.walls {
                let away = centre.from(wall.nearest(centre));
                let distance = away.length();
                if distance >= radius_m || distance == 0.0 {
                    continue;
                }
                centre = centre.moved(away, (radius_m - distance) / distance);
                (touched, moved) = (true, true);
            }
            if !moved {
                break;
            }
        }
        (centre, touched)
    }
}

/// A rectangle with round corners, closed, counter-clockwise.
fn loop_of(low: Point, high: Point, radius_m: f64) -> Vec<Point> {
    const STEPS: usize = 6;
    let centres = [
        point(high.x - radius_m, low.y + radius_m),
        point(high.x - radius_m, high.y - radius_m),
        point(low.x + radius_m, high.y - radius_m),
        point(low.x + radius_m, low.y + radius_m),
    ];
    let mut corners = Vec::new();
    for (quarter, centre) in centres.into_iter().enumerate() {
        for step in 0..=STEPS {
            let turns = (quarter as f64 - 1.0 + step as f64 / STEPS as f64) / 4.0;
            let direction = Point::towards(turns * std::f64::consts::TAU);
            corners.push(centre.moved(direction, radius_m));
        }
    }
    corners.push(corners[0]);
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_loop_is_dark_on_it_and_white_beside_it() {
        let world = World::room();
        assert_eq!(world.darkness(point(1.5, 0.4), 0.005), 1.0);
        assert_eq!(world.darkness(point(1.5, 0.45), 0.005), 0.0);
        // On the edge half of the spot is dark.
        let edge = world.darkness(point(1.5, 0.415), 0.005);
        assert!((edge - 0.5).abs() < 1e-9, "{edge}");
        // The closing straight on the left.
        assert_eq!(world.darkness(point(0.5, 1.0), 0.005), 1.0);
    }

    #[test]
    fn a_circle_cannot_be_in_a_wall() {
        let world = World::room();
        let (centre, touched) = world.pushed_out(point(0.05, 0.03), 0.1);
        assert!(touched);
        assert!((centre.x - 0.1).abs() < 1e-9 && (centre.y - 0.1).abs() < 1e-9);
        let (centre, touched) = world.pushed_out(point(0.7, 1.0), 0.1);
        assert_eq!((centre, touched), (point(0.7, 1.0), false));
    }

    #[test]
    fn a_ball_hides_the_wall_behind_it() {
        let world = World::room();
        let distance = world.ray(point(2.0, 1.0), point(1.0, 0.0)).unwrap();
        assert!((distance - 0.665).abs() < 1e-9, "{distance}");
    }
}
