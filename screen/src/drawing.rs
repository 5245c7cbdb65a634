//! The list of what was drawn, and the pen.
//!
//! Owns the rules of the robot's display: a picture lies at the bottom, shapes over it in their order, labels on top; a
//! label replaces the one at the same place; colour and width of the pen hold for what is drawn after them.

use crate::colour::{BLACK, Colour, WHITE};
use crate::fault::Fault;
use crate::limits;
use crate::pixels::Pixels;
use std::collections::BTreeMap;

/// What a shape is. Angles are in degrees, counter-clockwise from the right.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Outline {
    /// From one point to another.
    Line([i32; 4]),
    /// One point.
    Point([i32; 2]),
    /// Corner, width and height.
    Rectangle([i32; 4]),
    /// The ellipse in such a rectangle.
    Ellipse([i32; 4]),
    /// A part of its rim: first angle and how far it goes.
    Arc([i32; 4], i32, i32),
}

/// One thing that was drawn.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Shape {
    /// What and where.
    pub outline: Outline,
    /// Whether its inside is filled.
    pub is_filled: bool,
    /// Of the pen.
    pub colour: Colour,
    /// Of the pen, in pixels.
    pub width: u16,
}

/// One text.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Label {
    /// As it was given; newlines begin a new line.
    pub text: String,
    /// Height of its letters in pixels.
    pub height: u16,
    /// Its colour.
    pub colour: Colour,
}

/// Everything on a display.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Drawing {
    background: Colour,
    picture: Option<Pixels>,
    /// What the oldest shapes have become.
    old: Option<Pixels>,
    shapes: Vec<Shape>,
    labels: BTreeMap<(i32, i32), Label>,
    pen: Colour,
    pen_width: u16,
    size: (u16, u16),
}

impl Default for Drawing {
    fn default() -> Self {
        Self::new(limits::WIDTH, limits::HEIGHT)
    }
}

fn cut(coordinate: i32) -> i32 {
    coordinate.clamp(-limits::COORDINATE_MAX, limits::COORDINATE_MAX)
}

/// A corner and a size; a negative size grows to the other side.
fn upright([x, y, width, height]: [i32; 4]) -> [i32; 4] {
    let along = |from: i32, size: i32| {
        let (from, to) = (cut(from), cut(from.saturating_add(size)));
        (from.min(to), (to - from).abs())
    };
    let ((x, width), (y, height)) = (along(x, width), along(y, height));
    [x, y, width, height]
}

impl Drawing {
    /// Nothing on white, for a display of this size.
    pub fn new(width: u16, height: u16) -> Self {
        Self {
            background: WHITE,
            picture: None,
            old: None,
            shapes: Vec::new(),
            labels: BTreeMap::new(),
            pen: BLACK,
            pen_width: 1,
            size: (width, height),
        }
    }

    /// Width and height of the display.
    pub fn size(&self) -> (u16, u16) {
        self.size
    }

    /// What is behind everything.
    pub fn background(&self) -> Colour {
        self.background
    }

    /// Changes what is behind everything.
    pub fn set_background(&mut self, colour: Colour) {
        self.background = colour;
    }

    /// The picture at the bottom.
    pub fn picture(&self) -> Option<&Pixels> {
        self.picture.as_ref()
    }

    /// A picture at the bottom instead of the one before, as large as the display lets it be.
    pub fn show(&mut self, picture: &Pixels) {
        self.picture = Some(picture.fitted(self.size.0, self.size.1));
    }

    /// What the oldest shapes have become when there were too many.
    pub fn old(&self) -> Option<&Pixels> {
        self.old.as_ref()
    }

    /// The newest shapes, in their order.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// The texts and where they stand.
    pub fn labels(&self) -> impl Iterator<Item = ((i32, i32), &Label)> {
        self.labels.iter().map(|(place, label)| (*place, label))
    }

    /// Colour of what is drawn from now on.
    pub fn set_pen(&mut self, colour: Colour) {
        self.pen = colour;
    }

    /// Width in pixels of what is drawn from now on; 0 is as thin as 1.
    pub fn set_pen_width(&mut self, width: i32) {
        let width = width.clamp(1, limits::PEN_MAX.into());
        self.pen_width = u16::try_from(width).unwrap_or(1);
    }

    /// Draws with the pen. Coordinates beyond [`limits::COORDINATE_MAX`] are cut.
    pub fn draw(&mut self, outline: Outline, is_filled: bool) {
        let outline = match outline {
            Outline::Line(ends) => Outline::Line(ends.map(cut)),
            Outline::Point(place) => Outline::Point(place.map(cut)),
            Outline::Rectangle(place) => Outline::Rectangle(upright(place)),
            Outline::Ellipse(place) => Outline::Ellipse(upright(place)),
            Outline::Arc(place, from, span) => {
                Outline::Arc(upright(place), from % 360, span.clamp(-360, 360))
            }
        };
        let shape = Shape {
            outline,
            is_filled,
            colour: self.pen,
            width: self.pen_width,
        };
        // Programs draw the same again and again in their loops.
        if self.shapes.last() == Some(&shape) {
            return;
        }
        self.shapes.push(shape);
        if self.shapes.len() > limits::SHAPES_MAX {
            let (width, height) = self.size;
            let old = self
                .old
                .get_or_insert_with(|| Pixels::new(width, height, None));
            for shape in self.shapes.drain(..limits::SHAPES_MAX / 2) {
                crate::paint::shape(old, &shape);
            }
        }
    }

    /// A text whose upper left corner is at (x, y), instead of the one there. Without a height it is
    /// [`limits::LETTER`].
    ///
    /// # Errors
    /// There are too many.
    pub fn add_label(
        &mut self,
        text: &str,
        x: i32,
        y: i32,
        height: Option<u16>,
    ) -> Result<(), Fault> {
        let place = (cut(x), cut(y));
        if self.labels.len() >= limits::LABELS_MAX && !self.labels.contains_key(&place) {
            return Err(Fault::Labels);
        }
        let label = Label {
            text: text.chars().take(limits::LABEL_CHARACTERS).collect(),
            height: height
                .unwrap_or(limits::LETTER)
                .clamp(1, limits::LETTER_MAX),
            colour: self.pen,
        };
        self.labels.insert(place, label);
        Ok(())
    }

    /// No texts any more.
    pub fn remove_labels(&mut self) {
        self.labels.clear();
    }

    /// As in the beginning.
    pub fn clear(&mut self) {
        *self = Self::new(self.size.0, self.size.1);
    }
}
