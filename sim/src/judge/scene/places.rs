//! Where things are, and whether they are in a region.
//!
//! Owns the outlines that rules compare. A point on the left or upper side of a region is in it, one on the right or lower
//! side is not; an outline that touches a side from within is in it. A robot's outline is its square without sensors; a
//! device that has no body, as a display, has that of its robot, and its place is the robot's corner.

use lang_constraint::{ObjectPoint, Point as Whole, Rect, Unfit};

use super::Thing;
use crate::arena::floor::MARKER_WIDTH;
use crate::arena::outline::{Bounds, Outline, is_inside as is_inside_figure};
use crate::arena::{Arena, solids};
use crate::field::{Drawn, Pen, Region, Shape};
use crate::geometry::{Point, point};

/// Corners of a round thing.
const ROUND: u32 = 64;
/// Pieces of a curve.
const CURVE: u32 = 32;

/// Whether a thing is in a region.
pub(super) fn is_inside(
    arena: &Arena,
    thing: Thing,
    region: usize,
    how: ObjectPoint,
) -> Result<bool, Unfit> {
    let field = arena.field();
    let region = field.regions.get(region).ok_or(Unfit::NoRegion)?;
    let place = Place::of(region, &field.drawn);
    if how == ObjectPoint::Center {
        let centre = centre(arena, thing).ok_or(Unfit::NoPlace)?;
        return Ok(place.holds(centre));
    }
    // A robot is asked in each tick, and needs no list of corners.
    if let Thing::Robot(index) = thing {
        let robot = arena.robots().get(index).ok_or(Unfit::NoPlace)?;
        return Ok(place.compares(&robot.square(), how));
    }
    let corners = outline(arena, thing).ok_or(Unfit::NoPlace)?;
    Ok(place.compares(&corners, how))
}

/// The place of a region.
enum Place {
    /// A rectangle along the axes: its smallest and largest coordinates.
    Rectangle(Point, Point),
    /// An ellipse in such a rectangle.
    Ellipse(Point, Point),
    /// Whatever is drawn.
    Figure(Vec<Point>),
}

impl Place {
    fn of(region: &Region, drawn: &[Drawn]) -> Self {
        if region.kind == "bound" {
            let bound = drawn.iter().find(|one| one.id == region.bound);
            return Self::Figure(bound.map(figure).unwrap_or_default());
        }
        let (at, size) = (region.at, region.size);
        let low = point(at.x.min(at.x + size.x), at.y.min(at.y + size.y));
        let high = point(at.x.max(at.x + size.x), at.y.max(at.y + size.y));
        if region.kind == "ellipse" {
            Self::Ellipse(low, high)
        } else {
            Self::Rectangle(low, high)
        }
    }

    fn holds(&self, at: Point) -> bool {
        match self {
            Self::Rectangle(low, high) => {
                at.x >= low.x && at.x < high.x && at.y >= low.y && at.y < high.y
            }
            Self::Ellipse(low, high) => is_in_ellipse(*low, *high, at),
            Self::Figure(corners) => is_inside_figure(corners, at),
        }
    }

    fn compares(&self, corners: &[Point], how: ObjectPoint) -> bool {
        match how {
            ObjectPoint::Center => false,
            ObjectPoint::All => self.holds_all(corners),
            ObjectPoint::Any => self.meets(corners),
        }
    }

    fn holds_all(&self, corners: &[Point]) -> bool {
        if corners.is_empty() {
            return false;
        }
        let mut all = corners.iter();
        match self {
            Self::Rectangle(low, high) => {
                all.all(|at| (low.x..=high.x).contains(&at.x) && (low.y..=high.y).contains(&at.y))
            }
            Self::Ellipse(low, high) => all.all(|at| is_in_ellipse(*low, *high, *at)),
            Self::Figure(figure) => {
                all.all(|at| is_inside_figure(figure, *at)) && !is_crossing(figure, corners)
            }
        }
    }

    fn meets(&self, corners: &[Point]) -> bool {
        let bounds = Bounds::of(corners);
        let own;
        let figure = match self {
            Self::Rectangle(low, high) => {
                if !bounds.meets(&Bounds {
                    low: *low,
                    high: *high,
                }) {
                    return false;
                }
                own = rectangle(*low, *high).to_vec();
                &own
            }
            Self::Ellipse(low, high) => {
                own = ellipse(*low, *high, 0.0);
                &own
            }
            Self::Figure(figure) => figure,
        };
        let Some((&first, &own_first)) = corners.first().zip(figure.first()) else {
            return false;
        };
        is_crossing(figure, corners)
            || is_inside_figure(figure, first)
            || is_inside_figure(corners, own_first)
    }
}

fn is_crossing(figure: &[Point], corners: &[Point]) -> bool {
    let mut outline = Outline::default();
    outline.add(figure.iter().copied());
    outline.is_crossed_by(corners, &Bounds::of(corners))
}

fn is_in_ellipse(low: Point, high: Point, at: Point) -> bool {
    let (width, height) = (high.x - low.x, high.y - low.y);
    if width <= 0.0 || height <= 0.0 {
        return false;
    }
    let x = (at.x - low.x) / width * 2.0 - 1.0;
    let y = (at.y - low.y) / height * 2.0 - 1.0;
    x * x + y * y <= 1.0
}

fn rectangle(low: Point, high: Point) -> [Point; 4] {
    [low, point(high.x, low.y), high, point(low.x, high.y)]
}

fn ellipse(low: Point, high: Point, wider: f64) -> Vec<Point> {
    let centre = point((low.x + high.x) / 2.0, (low.y + high.y) / 2.0);
    let (a, b) = (
        (high.x - low.x) / 2.0 + wider,
        (high.y - low.y) / 2.0 + wider,
    );
    let corner = |index: u32| {
        let angle = f64::from(index) / f64::from(ROUND) * std::f64::consts::TAU;
        point(centre.x + a * angle.cos(), centre.y + b * angle.sin())
    };
    (0..ROUND).map(corner).collect()
}

/// The outline of a drawn thing, with its pen.
fn figure(drawn: &Drawn) -> Vec<Point> {
    let wider = half_width(&drawn.pen);
    match &drawn.shape {
        Shape::Line(begin, end) => bar(*begin, *end, wider),
        Shape::Rectangle(begin, end) => {
            let bounds = Bounds::of(&[*begin, *end]);
            let low = point(bounds.low.x - wider, bounds.low.y - wider);
            let high = point(bounds.high.x + wider, bounds.high.y + wider);
            rectangle(low, high).to_vec()
        }
        Shape::Ellipse(begin, end) => {
            let bounds = Bounds::of(&[*begin, *end]);
            ellipse(bounds.low, bounds.high, wider)
        }
        Shape::Curve(begin, first, second, end) => {
            let at = |index: u32| {
                let t = f64::from(index) / f64::from(CURVE);
                let rest = 1.0 - t;
                let parts = [
                    (begin, rest * rest * rest),
                    (first, 3.0 * rest * rest * t),
                    (second, 3.0 * rest * t * t),
                    (end, t * t * t),
                ];
                parts.into_iter().fold(point(0.0, 0.0), |sum, (one, part)| {
                    point(sum.x + one.x * part, sum.y + one.y * part)
                })
            };
            band((0..=CURVE).map(at).collect(), wider)
        }
        Shape::Stylus(strokes) => {
            let mut path: Vec<Point> = strokes.iter().map(|stroke| stroke.begin).collect();
            path.extend(strokes.last().map(|stroke| stroke.end));
            band(path, wider)
        }
    }
}

fn half_width(pen: &Pen) -> f64 {
    if pen.style == "none" {
        0.0
    } else {
        pen.width / 2.0
    }
}

/// A straight line as wide as its pen.
fn bar(begin: Point, end: Point, wider: f64) -> Vec<Point> {
    band(vec![begin, end], wider.max(0.5))
}

/// A path as wide as its pen: one side there, the other back.
fn band(path: Vec<Point>, wider: f64) -> Vec<Point> {
    let wider = wider.max(0.5);
    let aside = |index: usize| {
        let before = path[index.saturating_sub(1)];
        let after = path[(index + 1).min(path.len() - 1)];
        let along = after.from(before);
        let length = along.length().max(1e-9);
        point(-along.y / length * wider, along.x / length * wider)
    };
    let one = (0..path.len()).map(|index| {
        let (at, aside) = (path[index], aside(index));
        point(at.x + aside.x, at.y + aside.y)
    });
    let other = (0..path.len()).rev().map(|index| {
        let (at, aside) = (path[index], aside(index));
        point(at.x - aside.x, at.y - aside.y)
    });
    one.chain(other).collect()
}

/// The outline of a thing; nothing if it has none.
fn outline(arena: &Arena, thing: Thing) -> Option<Vec<Point>> {
    let field = arena.field();
    Some(match thing {
        Thing::Robot(index) | Thing::Part(index, _) => arena.robots().get(index)?.square().to_vec(),
        Thing::Device(index, port) => {
            let robot = arena.robots().get(index)?;
            let body = robot.sensor(port).and_then(|one| robot.sensor_corners(one));
            body.unwrap_or_else(|| robot.square()).to_vec()
        }
        Thing::Wall(index) => solids::wall(field.walls.get(index)?).to_vec(),
        Thing::Solid(index) => solids::outline_of(field.solids.get(index)?)
            .corners(0)
            .to_vec(),
        Thing::Drawn(index) => figure(field.drawn.get(index)?),
        Thing::Image(index) => {
            let image = field.images.get(index)?;
            let end = point(image.at.x + image.size.x, image.at.y + image.size.y);
            rectangle(image.at, end).to_vec()
        }
        Thing::Region(index) => {
            let region = field.regions.get(index)?;
            match Place::of(region, &field.drawn) {
                Place::Rectangle(low, high) => rectangle(low, high).to_vec(),
                Place::Ellipse(low, high) => ellipse(low, high, 0.0),
                Place::Figure(figure) => figure,
            }
        }
        Thing::Comment(index) => {
            let comment = field.comments.get(index)?;
            let bounds = Bounds::of(&[comment.begin, comment.end]);
            rectangle(bounds.low, bounds.high).to_vec()
        }
        Thing::Trace => return None,
    })
}

/// The centre of a thing; nothing if it has no place.
fn centre(arena: &Arena, thing: Thing) -> Option<Point> {
    match thing {
        Thing::Robot(index) => Some(arena.robots().get(index)?.centre()),
        Thing::Part(index, _) => Some(arena.robots().get(index)?.square()[0]),
        Thing::Device(index, port) => {
            let robot = arena.robots().get(index)?;
            let place = robot.sensor(port).map(|one| robot.sensor_pose(one).0);
            Some(place.unwrap_or_else(|| robot.square()[0]))
        }
        Thing::Solid(index) => Some(arena.field().solids.get(index)?.at),
        thing => {
            let bounds = Bounds::of(&outline(arena, thing)?);
            Some(point(
                (bounds.low.x + bounds.high.x) / 2.0,
                (bounds.low.y + bounds.high.y) / 2.0,
            ))
        }
    }
}

/// The upper left corner of something on the field, and its rotation in degrees.
pub(super) fn corner(arena: &Arena, thing: Thing) -> Option<(Point, f64)> {
    let field = arena.field();
    Some(match thing {
        Thing::Solid(index) => {
            let solid = field.solids.get(index)?;
            let half = solid.size / 2.0;
            (point(solid.at.x - half, solid.at.y - half), solid.rotation)
        }
        Thing::Wall(index) => (field.walls.get(index)?.begin, 0.0),
        Thing::Image(index) => (field.images.get(index)?.at, 0.0),
        Thing::Region(index) => (field.regions.get(index)?.at, 0.0),
        Thing::Comment(index) => (field.comments.get(index)?.begin, 0.0),
        Thing::Drawn(_) => (Bounds::of(&outline(arena, thing)?).low, 0.0),
        Thing::Robot(_) | Thing::Device(..) | Thing::Part(..) | Thing::Trace => return None,
    })
}

/// A place in whole pixels.
pub(super) fn whole(at: Point) -> Whole {
    Whole {
        x: (at.x + 0.5).floor() as i32,
        y: (at.y + 0.5).floor() as i32,
    }
}

/// The rectangle around what markers have left; nothing if that is nothing.
pub(super) fn around_trace(arena: &Arena) -> Option<Rect> {
    let strokes = arena.trace();
    if strokes.is_empty() {
        return None;
    }
    let all = strokes.iter().fold(Bounds::NOTHING, |all, stroke| {
        all.with(stroke.begin).with(stroke.end)
    });
    let half = MARKER_WIDTH / 2.0;
    let low = whole(point(all.low.x - half, all.low.y - half));
    let high = whole(point(all.high.x + half, all.high.y + half));
    Some(Rect {
        x: low.x,
        y: low.y,
        width: high.x.saturating_sub(low.x),
        height: high.y.saturating_sub(low.y),
    })
}
