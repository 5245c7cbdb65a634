//! The floor as optical sensors see it: its colour, pictures, drawn things, and what markers have left.
//!
//! Owns what lies over what, and windows: small pictures of the floor under a sensor, turned as the sensor is. A window is
//! painted when it is asked for, straight from the outlines that it meets, because its pixels lie between those of any
//! picture painted before. Robots and backgrounds are not on it: the original's sensors do not see them either.
//! Knows no sensors and no robots.
//!
//! Facts are those of the original: a window is an upright square of whole pixels that has room for the turned one; it is
//! painted with smooth edges, turned without smoothing, and its middle is cut out.

pub mod colour;
pub mod fuzz;
mod gradient;
mod lay;
pub mod outline;
pub mod picture;
pub mod raster;
pub mod sensors;
pub mod stroke;
mod words;

pub use lay::lay;

use std::collections::HashMap;
use std::sync::Arc;

use screen::Pixels;

use self::colour::Tint;
use self::gradient::Gradient;
use self::outline::{Affine, Bounds, Cap, Nib, Outline};
use self::picture::Paint;
use self::raster::Coverage;
use crate::geometry::{Point, point};
use crate::limits;

/// Across the line that a marker leaves, in pixels.
pub const MARKER_WIDTH: f64 = 6.0;
/// Side of a cell of the table of what lies where, in pixels.
const CELL: f64 = 64.0;
/// The original's painter shifts what it turns by so much, to round the right way.
const SHIFT: f64 = 1.0 / 65536.0;

/// Something on the floor.
#[derive(Clone, Debug)]
enum Covering {
    /// A painted area, and where it is looked for if that is not all of it.
    Area(Outline, Tint, Option<Bounds>),
    /// An area whose colour changes from place to place.
    Shade(Outline, Box<Gradient>),
    /// Pixels, and what takes a place of the scene to one of them.
    Pixels(Arc<Pixels>, Affine, Bounds),
    /// What a marker has left; its outline is made when somebody looks, because there are very many.
    Mark(Stroke),
}

impl Covering {
    fn bounds(&self) -> Bounds {
        match self {
            Self::Area(_, _, Some(bounds)) => *bounds,
            Self::Area(outline, ..) | Self::Shade(outline, _) => outline.bounds(),
            Self::Pixels(_, _, bounds) => *bounds,
            Self::Mark(stroke) => {
                let mut bounds = Bounds::NOTHING;
                for end in [stroke.begin, stroke.end] {
                    bounds.add(end.x - MARKER_WIDTH, end.y - MARKER_WIDTH);
                    bounds.add(end.x + MARKER_WIDTH, end.y + MARKER_WIDTH);
                }
                bounds
            }
        }
    }
}

/// What a marker has left in one piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// One end.
    pub begin: Point,
    /// The other.
    pub end: Point,
    /// Its colour.
    pub rgb: [u8; 3],
}

/// The floor.
#[derive(Clone, Debug)]
pub struct Floor {
    background: [u8; 3],
    things: Vec<Covering>,
    /// Things by the cells that they meet.
    cells: HashMap<(i32, i32), Vec<u32>>,
    /// Things that meet very many cells.
    everywhere: Vec<u32>,
    /// How many things are not of markers.
    count: usize,
    /// Lines and curves of all areas.
    steps: usize,
    /// Whether something was left out because there is too much.
    is_full: bool,
    trace: Vec<Stroke>,
    coverage: Coverage,
    found: Vec<u32>,
    canvas: Vec<[u8; 3]>,
}

impl Default for Floor {
    fn default() -> Self {
        Self::new([u8::MAX; 3])
    }
}

/// A square window's pixels.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Window {
    /// Pixels of a side.
    pub side: usize,
    /// Row by row; up is where the sensor looks.
    pub pixels: Vec<[u8; 3]>,
}

impl Floor {
    /// An empty floor.
    pub fn new(background: [u8; 3]) -> Self {
        Self {
            background,
            things: Vec::new(),
            cells: HashMap::new(),
            everywhere: Vec::new(),
            count: 0,
            steps: 0,
            is_full: false,
            trace: Vec::new(),
            coverage: Coverage::default(),
            found: Vec::new(),
            canvas: Vec::new(),
        }
    }

    /// Lays an area over everything that is there.
    pub fn add_area(&mut self, outline: Outline, tint: Tint) {
        self.add(Covering::Area(outline, tint, None));
        self.count = self.things.len();
    }

    /// The same for an area that only windows see which meet a rectangle, whatever else it covers.
    pub fn add_area_within(&mut self, outline: Outline, tint: Tint, bounds: Bounds) {
        self.add(Covering::Area(outline, tint, Some(bounds)));
        self.count = self.things.len();
    }

    /// Lays a picture over everything that is there. `place` takes its square from (0, 0) to (1, 1) to the scene.
    pub fn add_picture(&mut self, picture: &picture::Picture, place: &Affine) {
        for layer in &picture.layers {
            if let picture::Layer::Pixels(pixels, to) = layer {
                let to = to.then(place);
                let (width, height) = (f64::from(pixels.width()), f64::from(pixels.height()));
                let mut bounds = Bounds::NOTHING;
                for (x, y) in [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)] {
                    let (x, y) = to.apply(x, y);
                    bounds.add(x, y);
                }
                if let Some(back) = to.inverse() {
                    self.add(Covering::Pixels(Arc::clone(pixels), back, bounds));
                }
            } else if let Some((outline, paint)) = layer.outline(place) {
                self.add(match paint {
                    Paint::Plain(tint) => Covering::Area(outline, tint, None),
                    Paint::Shade(gradient) => Covering::Shade(outline, gradient),
                });
            }
        }
        self.count = self.things.len();
    }

    /// What a marker leaves on its way, over everything that is there. Nothing more when there is very much already.
    pub fn mark(&mut self, stroke: Stroke) {
        if stroke.begin == stroke.end || self.trace.len() >= limits::TRACE_STROKES {
            return;
        }
        self.add(Covering::Mark(stroke));
        self.trace.push(stroke);
    }

    /// What markers have left, in order.
    pub fn trace(&self) -> &[Stroke] {
        &self.trace
    }

    /// Takes away what markers have left.
    pub fn wipe(&mut self) {
        self.trace.clear();
        let count = self.count;
        self.things.truncate(count);
        let stays = |index: &u32| (*index as usize) < count;
        self.everywhere.retain(stays);
        self.cells.retain(|_, things| {
            things.retain(stays);
            !things.is_empty()
        });
    }

    fn add(&mut self, thing: Covering) {
        let Ok(index) = u32::try_from(self.things.len()) else {
            return;
        };
        let bounds = thing.bounds();
        let [left, top, right, bottom] = bounds.0.map(cell);
        if !bounds.0.iter().all(|side| side.is_finite()) {
            return;
        }
        if let Covering::Area(outline, ..) | Covering::Shade(outline, _) = &thing {
            if self.steps + outline.len() > limits::FLOOR_STEPS {
                self.is_full = true;
                return;
            }
            self.steps += outline.len();
        }
        let across = i64::from(right) - i64::from(left) + 1;
        let down = i64::from(bottom) - i64::from(top) + 1;
        if across.saturating_mul(down) > limits::CELLS_OF_THING {
            self.everywhere.push(index);
        } else {
            for row in top..=bottom {
                for column in left..=right {
                    self.cells.entry((column, row)).or_default().push(index);
                }
            }
        }
        self.things.push(thing);
    }

    /// Draws the floor as it is seen around `at`, turned by `degrees`. The sensor's picture has sides of `side` pixels, and `part` of
    /// it is seen: 1 is all of it, 2 is twice as far to each side.
    pub fn view(&mut self, at: Point, degrees: f64, side: u16, part: f64, window: &mut Window) {
        let half = f64::from(side) * part / 2.0;
        let (sine, cosine) = turn(degrees);
        let room = half * (sine.abs() + cosine.abs());
        let size = (2.0 * room).round() as usize;
        let cut = (half.round() as usize).saturating_sub(1);
        window.side = 2 * cut + 1;
        window.pixels.clear();
        window
            .pixels
            .resize(window.side * window.side, [u8::MAX; 3]);
        if size == 0 || !(at.x.abs() < limits::SCENE_EDGE && at.y.abs() < limits::SCENE_EDGE) {
            return;
        }
        let corner = point(at.x - room, at.y - room);
        self.paint(corner, size, size as f64 / (2.0 * room));
        // From the turned picture, whose corner is a whole pixel, back to the upright one.
        let (sine, cosine) = turn(-(90.0 + degrees));
        let full = size as f64;
        let ends = |one: f64, other: f64| {
            let (low, high) = (one.min(0.0) + other.min(0.0), one.max(0.0) + other.max(0.0));
            (low.floor(), high.ceil())
        };
        let (left, right) = ends(cosine * full, -sine * full);
        let (top, bottom) = ends(sine * full, cosine * full);
        let middle = |low: f64, high: f64| low + ((high - low - 1.0) / 2.0).floor() - cut as f64;
        let (first_x, first_y) = (middle(left, right) + 0.5, middle(top, bottom) + 0.5);
        // A canvas is far smaller than the largest i32.
        let last = i32::try_from(size - 1).unwrap_or(i32::MAX);
        let index = |value: f64| (value as i32).clamp(0, last) as usize;
        for (row, pixels) in window.pixels.chunks_exact_mut(window.side).enumerate() {
            let y = first_y + row as f64;
            let (sine_y, cosine_y) = (sine * y, cosine * y);
            for (column, pixel) in pixels.iter_mut().enumerate() {
                let x = first_x + column as f64;
                let from_x = index(cosine * x + sine_y - SHIFT);
                let from_y = index(cosine_y - sine * x - SHIFT);
                *pixel = self.canvas[from_y * size + from_x];
            }
        }
    }

    /// Paints a square of `size` pixels whose corner is at `corner` of the scene.
    fn paint(&mut self, corner: Point, size: usize, ratio: f64) {
        self.canvas.clear();
        self.canvas.resize(size * size, self.background);
        let far = size as f64 / ratio;
        let seen = Bounds([corner.x, corner.y, corner.x + far, corner.y + far]);
        self.found.clear();
        self.found.extend_from_slice(&self.everywhere);
        let [left, top, right, bottom] = seen.0.map(cell);
        for row in top..=bottom {
            for column in left..=right {
                if let Some(things) = self.cells.get(&(column, row)) {
                    self.found.extend_from_slice(things);
                }
            }
        }
        self.found.sort_unstable();
        self.found.dedup();
        for &index in &self.found {
            let Some(thing) = self.things.get(index as usize) else {
                continue;
            };
            if !thing.bounds().meets(&seen) {
                continue;
            }
            match thing {
                Covering::Area(outline, tint, _) => {
                    let (coverage, canvas) = (&mut self.coverage, &mut self.canvas);
                    fill(outline, *tint, coverage, canvas, corner, size, ratio);
                }
                Covering::Shade(outline, gradient) => {
                    let (coverage, canvas) = (&mut self.coverage, &mut self.canvas);
                    let tint = |x, y| gradient.tint(x, y);
                    shade(outline, tint, coverage, canvas, corner, size, ratio);
                }
                Covering::Mark(stroke) => {
                    if let Some(outline) = mark(stroke) {
                        let (coverage, canvas) = (&mut self.coverage, &mut self.canvas);
                        let tint = Tint::solid(stroke.rgb);
                        fill(&outline, tint, coverage, canvas, corner, size, ratio);
                    }
                }
                Covering::Pixels(pixels, back, _) => {
                    let whole = |value: f64| value.floor() as i32;
                    for (index, pixel) in self.canvas.iter_mut().enumerate() {
                        let along = |index: usize| (index as f64 + 0.5) / ratio;
                        let (x, y) = (along(index % size), along(index / size));
                        let (x, y) = back.apply(corner.x + x, corner.y + y);
                        if let Some(seen) = pixels.at(whole(x), whole(y)) {
                            *pixel = [seen.red, seen.green, seen.blue];
                        }
                    }
                }
            }
        }
    }
}

/// The outline of what a marker has left.
fn mark(stroke: &Stroke) -> Option<Outline> {
    let nib = Nib {
        width: MARKER_WIDTH,
        style: "solid",
        cap: Cap::Round,
    };
    Outline::drawn(&outline::line(stroke.begin, stroke.end)?, nib)
}

/// Paints an area of one colour onto a square of `size` pixels.
fn fill(
    outline: &Outline,
    tint: Tint,
    coverage: &mut Coverage,
    canvas: &mut [[u8; 3]],
    corner: Point,
    size: usize,
    ratio: f64,
) {
    coverage.begin(outline.grid(), size, size);
    outline.cover(coverage, corner.x, corner.y, ratio);
    coverage.spans(outline.rule(), |y, columns, level| {
        let pixels = &mut canvas[y * size + columns.start..y * size + columns.end];
        if level == u8::MAX && tint.opacity == u8::MAX {
            return pixels.fill(tint.rgb);
        }
        for pixel in pixels {
            colour::lay(pixel, tint, level);
        }
    });
}

/// The same with a colour that changes: `tint` says that of a place of the scene.
fn shade(
    outline: &Outline,
    tint: impl Fn(f64, f64) -> Tint,
    coverage: &mut Coverage,
    canvas: &mut [[u8; 3]],
    corner: Point,
    size: usize,
    ratio: f64,
) {
    coverage.begin(outline.grid(), size, size);
    outline.cover(coverage, corner.x, corner.y, ratio);
    let along = |index: usize| (index as f64 + 0.5) / ratio;
    coverage.spans(outline.rule(), |y, columns, level| {
        for x in columns {
            let tint = tint(corner.x + along(x), corner.y + along(y));
            colour::lay(&mut canvas[y * size + x], tint, level);
        }
    });
}

fn cell(place: f64) -> i32 {
    (place / CELL).floor() as i32
}

/// Sine and cosine of degrees; exact where a turn is a quarter.
fn turn(degrees: f64) -> (f64, f64) {
    if degrees == 90.0 || degrees == -270.0 {
        (1.0, 0.0)
    } else if degrees == 270.0 || degrees == -90.0 {
        (-1.0, 0.0)
    } else if degrees == 180.0 || degrees == -180.0 {
        (0.0, -1.0)
    } else {
        libm::sincos(degrees.to_radians())
    }
}

#[cfg(test)]
mod tests;
