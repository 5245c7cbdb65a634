//! A field onto the floor: its colour, pictures, drawn things and old traces, in the order in which they cover each other.
//!
//! Owns that order, and what is said of things that cannot be shown. Knows the plain data of a field and no physics.
//!
//! Two facts of the original: backgrounds, the colour of the scene among them, are for people only, sensors do not see them
//! but white; and straight lines, those of a
//! hand too, go from whole pixels to whole pixels.

use lang_text::problem::Problem;

use super::colour::Tint;
use super::outline::{self, Affine, Bounds, Cap, Nib, Outline};
use super::picture::Picture;
use super::{Floor, Stroke, words};
use crate::arena::solids;
use crate::field::{Drawn, Field, Image, Pen, Shape, Wall};
use crate::geometry::{Point, point};

/// Across the strip that sensors see of a wall.
const WALL_STRIP: f64 = 10.0;
/// What a sensor sees of its bricks on the whole: the picture of the original is its own.
const BRICKS: [u8; 3] = [150, 94, 70];

/// The floor of a field, and what is wrong with its pictures and colours.
pub fn lay(field: &Field) -> (Floor, Vec<Problem>) {
    let mut layer = Layer::default();
    for image in field.images.iter().filter(|image| !image.is_background) {
        layer.image(field, image);
    }
    for drawn in &field.drawn {
        layer.drawn(drawn);
    }
    for wall in &field.walls {
        layer.wall(wall);
    }
    for old in &field.trace {
        let rgb = layer.tint(&old.colour, "trace").rgb;
        layer.floor.mark(Stroke {
            begin: old.begin,
            end: old.end,
            rgb,
        });
    }
    if layer.floor.is_full {
        layer.warn("", words::too_much());
    }
    (layer.floor, layer.problems)
}

#[derive(Default)]
struct Layer {
    floor: Floor,
    problems: Vec<Problem>,
}

/// A point of a straight line.
fn whole(at: Point) -> Point {
    point(at.x.trunc(), at.y.trunc())
}

impl Layer {
    fn warn(&mut self, id: &str, words: lang_text::problem::Words) {
        let mut problem = Problem::warning(words);
        problem.place.object = Some(id.to_owned()).filter(|id| !id.is_empty());
        // The first ones tell enough.
        if self.problems.len() < crate::limits::FLOOR_PROBLEMS && !self.problems.contains(&problem)
        {
            self.problems.push(problem);
        }
    }

    fn tint(&mut self, text: &str, id: &str) -> Tint {
        if text.is_empty() {
            return Tint::solid([0; 3]);
        }
        Tint::named(text).unwrap_or_else(|| {
            self.warn(id, words::no_colour(text));
            Tint::solid([0; 3])
        })
    }

    fn image(&mut self, field: &Field, image: &Image) {
        let Some(blob) = field.blobs.get(&image.image) else {
            return self.warn(&image.id, words::no_picture(&image.image));
        };
        if blob.is_external {
            return self.warn(&image.id, words::outside(&blob.path));
        }
        match Picture::read(&blob.path, &blob.text) {
            Ok(picture) => {
                for lack in &picture.lacks {
                    self.warn(&image.id, words::lacks(*lack));
                }
                // The original draws it into a rectangle of whole pixels.
                let far = point(image.at.x + image.size.x, image.at.y + image.size.y);
                let [left, right] = [image.at.x.min(far.x), image.at.x.max(far.x)].map(f64::round);
                let [top, bottom] = [image.at.y.min(far.y), image.at.y.max(far.y)].map(f64::round);
                let place = [right - left, 0.0, 0.0, bottom - top, left, top];
                self.floor.add_picture(&picture, &Affine(place));
            }
            Err(why) => self.warn(&image.id, words::bad_picture(&image.image, &why.words())),
        }
    }

    fn drawn(&mut self, drawn: &Drawn) {
        match &drawn.shape {
            Shape::Line(begin, end) => {
                self.straight(whole(*begin), whole(*end), drawn);
            }
            Shape::Rectangle(one, other) => {
                let path = outline::rectangle(*one, *other);
                self.inside(*one, *other, drawn);
                self.pen(path.as_ref(), drawn, &drawn.pen, Cap::Square);
            }
            Shape::Ellipse(one, other) => {
                let path = outline::ellipse(*one, *other);
                self.brush(path.as_ref(), drawn);
                self.pen(path.as_ref(), drawn, &drawn.pen, Cap::Square);
            }
            Shape::Curve(begin, one, other, end) => {
                let path = outline::curve([*begin, *one, *other, *end]);
                self.brush(path.as_ref(), drawn);
                self.pen(path.as_ref(), drawn, &drawn.pen, Cap::Round);
            }
            Shape::Stylus(strokes) => {
                // It is looked for where its points are, however wide its pen is.
                let mut bounds = Bounds::NOTHING;
                for end in strokes.iter().flat_map(|one| [one.begin, one.end]) {
                    bounds.add(end.x, end.y);
                }
                for stroke in strokes {
                    let path = outline::line(whole(stroke.begin), whole(stroke.end));
                    if let Some((line, tint)) =
                        self.line(path.as_ref(), &drawn.id, &drawn.pen, Cap::Round)
                    {
                        self.floor.add_area_within(line, tint, bounds);
                    }
                }
            }
        }
    }

    /// A straight line. Upright and level ones are bars, one for each dash; of oblique ones and of dots the recorded readings
    /// are nearer to what a pen leaves along a path.
    fn straight(&mut self, begin: Point, end: Point, drawn: &Drawn) {
        let is_bar = (begin.x == end.x) != (begin.y == end.y);
        if !is_bar {
            let path = outline::line(begin, end);
            return self.pen(path.as_ref(), drawn, &drawn.pen, Cap::Square);
        }
        let width = outline::pen_width(drawn.pen.width);
        let dashes = outline::dashes(begin, end, width, &drawn.pen.style);
        if dashes.is_empty() {
            return;
        }
        let tint = self.tint(&drawn.pen.colour, &drawn.id);
        for (begin, end) in dashes {
            if let Some(bar) = Outline::bar(begin, end, width, Cap::Square) {
                self.floor.add_area(bar, tint);
            }
        }
    }

    /// The inside of a rectangle, which is a bar too.
    fn inside(&mut self, one: Point, other: Point, drawn: &Drawn) {
        if drawn.pen.fill_style != "solid" {
            return;
        }
        let tint = self.tint(&drawn.pen.fill, &drawn.id);
        let middle = f64::midpoint(one.y, other.y);
        let (left, right) = (one.x.min(other.x), one.x.max(other.x));
        let height = (other.y - one.y).abs();
        let bar = Outline::bar(point(left, middle), point(right, middle), height, Cap::Flat);
        if let Some(bar) = bar {
            self.floor.add_area(bar, tint);
        }
    }

    fn brush(&mut self, path: Option<&usvg::tiny_skia_path::Path>, drawn: &Drawn) {
        if drawn.pen.fill_style != "solid" {
            return;
        }
        let tint = self.tint(&drawn.pen.fill, &drawn.id);
        let inside = path
            .and_then(|path| Outline::inside(path, &Affine::SAME, super::raster::Rule::EvenOdd));
        if let Some(inside) = inside {
            self.floor.add_area(inside, tint);
        }
    }

    fn pen(
        &mut self,
        path: Option<&usvg::tiny_skia_path::Path>,
        drawn: &Drawn,
        pen: &Pen,
        cap: Cap,
    ) {
        if let Some((line, tint)) = self.line(path, &drawn.id, pen, cap) {
            self.floor.add_area(line, tint);
        }
    }

    /// What a pen leaves along a path, and in which colour.
    fn line(
        &mut self,
        path: Option<&usvg::tiny_skia_path::Path>,
        id: &str,
        pen: &Pen,
        cap: Cap,
    ) -> Option<(Outline, Tint)> {
        let nib = Nib {
            width: pen.width,
            style: &pen.style,
            cap,
        };
        let line = path.and_then(|path| Outline::drawn(path, nib))?;
        Some((line, self.tint(&pen.colour, id)))
    }

    /// A wall: a strip of bricks of one width, whatever the wall's is, and a pen around it. It is looked for where the strip
    /// is.
    fn wall(&mut self, wall: &Wall) {
        let strip = solids::wall(&Wall {
            width: WALL_STRIP,
            ..wall.clone()
        });
        let mut bounds = Bounds::NOTHING;
        strip.iter().for_each(|at| bounds.add(at.x, at.y));
        let path = outline::polygon(&strip);
        let inside = path
            .as_ref()
            .and_then(|path| Outline::inside(path, &Affine::SAME, super::raster::Rule::EvenOdd));
        if let Some(inside) = inside {
            self.floor
                .add_area_within(inside, Tint::solid(BRICKS), bounds);
        }
        if let Some(pen) = wall.pen()
            && let Some((line, tint)) = self.line(path.as_ref(), &wall.id, &pen, Cap::Square)
        {
            self.floor.add_area_within(line, tint, bounds);
        }
    }
}
