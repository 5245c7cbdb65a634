//! Where things are, and whether they are in a region.
//!
//! Owns the outlines that rules compare. A point on the left or upper side of a rectangle is in it, one on the right or
//! lower side is not; an outline that touches a side from within is not all in it. A robot's outline is its square without sensors; a
//! device that has no body, as a display, has that of its robot, and its place is the robot's corner.

use lang_constraint::{ObjectPoint, Point as Whole, Rect, Unfit};

use super::SceneObject;
use crate::arena::floor::MARKER_WIDTH;
use crate::arena::graphic::Family;
use crate::arena::outline::{Bounds, Outline, is_inside as is_inside_figure};
use crate::arena::{Arena, solids};
use crate::field::{Drawn, Field, Pen, Region, Shape};
use crate::geometry::{Point, Segment, point};
use lang_diagram::stand_in::PIXELS_IN_CM;

/// Corners of a round thing.
const ROUND: u32 = 64;
/// Pieces of a curve.
const CURVE: u32 = 32;

/// Whether a thing is in a region.
pub(super) fn is_inside(
    arena: &Arena,
    thing: SceneObject,
    region: usize,
    how: ObjectPoint,
) -> Result<bool, Unfit> {
    let field = arena.field();
    let graphic = arena.graphics.of(Family::Region, region);
    let region = field.regions.get(region).ok_or(Unfit::NoRegion)?;
    let place = Place::of(region, field);
    if how == ObjectPoint::Center {
        let centre = centre(arena, thing).ok_or(Unfit::NoPlace)?;
        return Ok(place.holds(graphic.back(centre)));
    }
    // A robot is asked in each tick, and needs no list of corners.
    if let SceneObject::Robot(index) = thing {
        let robot = arena.robots().get(index).ok_or(Unfit::NoPlace)?;
        let corners = robot.square().map(|at| graphic.back(at));
        return Ok(place.compares(&corners, how));
    }
    let mut corners = outline(arena, thing).ok_or(Unfit::NoPlace)?;
    corners.iter_mut().for_each(|at| *at = graphic.back(*at));
    Ok(place.compares(&corners, how))
}

/// How far a thing is from being in a region, in pixels; nothing if one of them has no place.
pub(super) fn distance(
    arena: &Arena,
    thing: SceneObject,
    region: usize,
    how: ObjectPoint,
) -> Option<f64> {
    let field = arena.field();
    let graphic = arena.graphics.of(Family::Region, region);
    let place = Place::of(field.regions.get(region)?, field);
    if how == ObjectPoint::Center {
        return place.distance(graphic.back(centre(arena, thing)?));
    }
    let corners = outline(arena, thing)?.into_iter();
    let corners: Vec<Point> = corners.map(|at| graphic.back(at)).collect();
    if how == ObjectPoint::All {
        // The corner that is farthest out has the longest way.
        let mut ways = corners.iter().map(|at| place.distance(*at));
        return ways.try_fold(0.0, |most: f64, way| Some(most.max(way?)));
    }
    let figures = place.figures();
    let ways = figures.iter().flat_map(|figure| {
        let to = corners.iter().map(|at| to_outline(figure, *at));
        let back = figure.iter().map(|at| to_outline(&corners, *at));
        to.chain(back)
    });
    ways.reduce(f64::min)
}

/// How far a point is from the outline of a figure.
fn to_outline(figure: &[Point], at: Point) -> f64 {
    let ends = figure.iter().cycle().skip(1);
    let sides = figure.iter().zip(ends);
    let ways = sides.map(|(begin, end)| {
        let nearest = Segment::new(*begin, *end).nearest(at);
        nearest.from(at).length()
    });
    ways.fold(f64::INFINITY, f64::min)
}

/// The place of a region before it was moved.
enum Place {
    /// Nothing is in it.
    Nowhere,
    /// A rectangle along the axes: its smallest and largest coordinates.
    Rectangle(Point, Point),
    /// An ellipse in such a rectangle.
    Ellipse(Point, Point),
    /// What is in the first figure and not in the second one.
    Ring(Vec<Point>, Vec<Point>),
}

/// Whether nothing can be in a region.
pub(in super::super) fn is_nowhere(region: &Region, field: &Field) -> bool {
    matches!(Place::of(region, field), Place::Nowhere)
}

impl Place {
    fn of(region: &Region, field: &Field) -> Self {
        if region.is_bound() {
            let bound = field.drawn.iter().find(|one| one.id == region.bound);
            let unit = field.unit.pixels();
            return bound.map_or(Self::Nowhere, |bound| {
                Self::around(bound, region.ring, unit)
            });
        }
        let (at, size) = (region.at, region.size);
        let low = point(at.x.min(at.x + size.x), at.y.min(at.y + size.y));
        let high = point(at.x.max(at.x + size.x), at.y.max(at.y + size.y));
        if low.x >= high.x || low.y >= high.y {
            Self::Nowhere
        } else if region.is_ellipse() {
            Self::Ellipse(low, high)
        } else {
            Self::Rectangle(low, high)
        }
    }

    /// The outline of a rectangle or an ellipse, with half of its pen in whole units of the text, filled or not; or the ring
    /// along that outline. Lines and curves have none.
    fn around(drawn: &Drawn, ring: f64, unit: f64) -> Self {
        let (begin, end) = match &drawn.shape {
            Shape::Rectangle(begin, end) | Shape::Ellipse(begin, end) => (*begin, *end),
            Shape::Line(..) | Shape::Curve(..) | Shape::Stylus(_) => return Self::Nowhere,
        };
        let bounds = Bounds::of(&[begin, end]);
        let half_pen = f64::from((drawn.pen.width / unit).round() as i32 / 2) * unit;
        let grown = |by: f64| {
            let (low, high) = (bounds.low, bounds.high);
            (
                point(low.x - by, low.y - by),
                point(high.x + by, high.y + by),
            )
        };
        let is_ellipse = matches!(drawn.shape, Shape::Ellipse(..));
        let (low, high) = grown(half_pen);
        let half = ring / 2.0;
        if ring == 0.0 {
            return match is_ellipse {
                true => Self::Ellipse(low, high),
                false => Self::Rectangle(low, high),
            };
        }
        let (inner_low, inner_high) = grown(half_pen - half);
        let is_hollow = inner_low.x < inner_high.x && inner_low.y < inner_high.y;
        let inner = match (is_hollow, is_ellipse) {
            (false, _) => Vec::new(),
            (true, true) => ellipse(inner_low, inner_high, 0.0),
            (true, false) => rectangle(inner_low, inner_high).to_vec(),
        };
        let outer = match is_ellipse {
            true => ellipse(low, high, half),
            false => bevelled(low, high, half),
        };
        Self::Ring(outer, inner)
    }

    /// Its outlines.
    fn figures(&self) -> Vec<Vec<Point>> {
        match self {
            Self::Nowhere => Vec::new(),
            Self::Rectangle(low, high) => vec![rectangle(*low, *high).to_vec()],
            Self::Ellipse(low, high) => vec![ellipse(*low, *high, 0.0)],
            Self::Ring(outer, inner) => vec![outer.clone(), inner.clone()],
        }
    }

    /// How far a point is from it: 0 inside, and nothing if it is nowhere.
    fn distance(&self, at: Point) -> Option<f64> {
        if self.holds(at) {
            return Some(0.0);
        }
        let figures = self.figures();
        let ways = figures.iter().map(|figure| to_outline(figure, at));
        ways.reduce(f64::min).filter(|way| way.is_finite())
    }

    fn holds(&self, at: Point) -> bool {
        match self {
            Self::Nowhere => false,
            Self::Rectangle(low, high) => {
                at.x >= low.x && at.x < high.x && at.y >= low.y && at.y < high.y
            }
            Self::Ellipse(low, high) => is_in_ellipse(*low, *high, at),
            Self::Ring(outer, inner) => is_inside_figure(outer, at) && !is_inside_figure(inner, at),
        }
    }

    fn compares(&self, corners: &[Point], how: ObjectPoint) -> bool {
        match how {
            ObjectPoint::Center => false,
            ObjectPoint::All => self.holds_all(corners),
            ObjectPoint::Any => self.meets(corners),
        }
    }

    /// Sides that touch are not within each other.
    fn holds_all(&self, corners: &[Point]) -> bool {
        if corners.is_empty() {
            return false;
        }
        let mut all = corners.iter();
        match self {
            Self::Nowhere => false,
            Self::Rectangle(low, high) => {
                all.all(|at| low.x < at.x && at.x < high.x && low.y < at.y && at.y < high.y)
            }
            Self::Ellipse(low, high) => all.all(|at| is_in_ellipse(*low, *high, *at)),
            Self::Ring(outer, inner) => {
                let hole = inner.first();
                all.all(|at| self.holds(*at))
                    && !is_crossing(outer, corners)
                    && !is_crossing(inner, corners)
                    && !hole.is_some_and(|&hole| is_inside_figure(corners, hole))
            }
        }
    }

    fn meets(&self, corners: &[Point]) -> bool {
        let bounds = Bounds::of(corners);
        let own;
        let figure = match self {
            Self::Nowhere => return false,
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
            Self::Ring(outer, inner) => {
                let first = corners.first();
                return is_crossing(outer, corners)
                    || is_crossing(inner, corners)
                    || first.is_some_and(|&first| self.holds(first))
                    || is_inside_figure(corners, outer[0]);
            }
        };
        let Some((&first, &own_first)) = corners.first().zip(figure.first()) else {
            return false;
        };
        is_crossing(figure, corners)
            || is_inside_figure(figure, first)
            || is_inside_figure(corners, own_first)
    }
}

/// A rectangle with its sides so far outwards and its corners cut.
fn bevelled(low: Point, high: Point, by: f64) -> Vec<Point> {
    vec![
        point(low.x, low.y - by),
        point(high.x, low.y - by),
        point(high.x + by, low.y),
        point(high.x + by, high.y),
        point(high.x, high.y + by),
        point(low.x, high.y + by),
        point(low.x - by, high.y),
        point(low.x - by, low.y),
    ]
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
    // The outermost points are outside.
    x * x + y * y < 1.0
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
        point(
            centre.x + a * libm::cos(angle),
            centre.y + b * libm::sin(angle),
        )
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
fn outline(arena: &Arena, thing: SceneObject) -> Option<Vec<Point>> {
    let field = arena.field();
    Some(match thing {
        SceneObject::Robot(index) | SceneObject::Part(index, _) => {
            arena.robots().get(index)?.square().to_vec()
        }
        SceneObject::Device(index, port) => {
            let robot = arena.robots().get(index)?;
            let body = robot.sensor(port).and_then(|one| robot.sensor_corners(one));
            body.unwrap_or_else(|| robot.square()).to_vec()
        }
        SceneObject::Wall(index) => solids::wall(field.walls.get(index)?).to_vec(),
        SceneObject::Solid(index) => solids::outline_of(field.solids.get(index)?)
            .corners(0)
            .to_vec(),
        SceneObject::Drawn(index) => figure(field.drawn.get(index)?),
        SceneObject::Region(index) => {
            let region = field.regions.get(index)?;
            match Place::of(region, field) {
                Place::Nowhere => return None,
                Place::Rectangle(low, high) => rectangle(low, high).to_vec(),
                Place::Ellipse(low, high) => ellipse(low, high, 0.0),
                Place::Ring(figure, _) => figure,
            }
        }
        SceneObject::Trace => return None,
    })
}

/// The centre of a thing; nothing if it has no place.
fn centre(arena: &Arena, thing: SceneObject) -> Option<Point> {
    match thing {
        SceneObject::Robot(index) => Some(arena.robots().get(index)?.centre()),
        SceneObject::Part(index, _) => Some(arena.robots().get(index)?.square()[0]),
        SceneObject::Device(index, port) => {
            let robot = arena.robots().get(index)?;
            let place = robot.sensor(port).map(|one| robot.sensor_pose(one).0);
            Some(place.unwrap_or_else(|| robot.square()[0]))
        }
        SceneObject::Solid(index) => Some(arena.field().solids.get(index)?.at),
        SceneObject::Wall(_)
        | SceneObject::Drawn(_)
        | SceneObject::Region(_)
        | SceneObject::Trace => {
            let bounds = Bounds::of(&outline(arena, thing)?);
            Some(point(
                (bounds.low.x + bounds.high.x) / 2.0,
                (bounds.low.y + bounds.high.y) / 2.0,
            ))
        }
    }
}

/// The centre of a ball, skittle or cube as the original tells it: what a rule has set, else what comes back from its
/// physics, which counts in 32 bits and in other units.
pub(super) fn as_told(at: Point, set: Point) -> Point {
    let told = |number: f64, set: f64| {
        if number == set {
            return number;
        }
        let unit = f64::from(0.1f32) * PIXELS_IN_CM;
        let centimetres = (f64::from(number as f32) / unit) as f32;
        let metres = centimetres * 0.01f32;
        f64::from(metres * 100.0 * unit as f32)
    };
    point(told(at.x, set.x), told(at.y, set.y))
}

/// A place in whole pixels.
fn whole(at: Point) -> Whole {
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
