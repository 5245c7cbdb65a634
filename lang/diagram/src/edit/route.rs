//! The way of a link on the canvas: from a side of one block to a side of another.
//!
//! Owns the numbers by which the editor keeps sides and corners: of a port the whole part is the side, clockwise from the
//! left, and the rest how far along it; corners are relative to the place of the link.

use super::pen::Pen;
use crate::objects::{Kind, Object};
use crate::read::graph::{point, points};

/// Width and height of a block, in px.
pub(super) const SIZE: f64 = 50.0;

/// A side of a block.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Side {
    Left,
    Top,
    Right,
    Bottom,
}

/// A block on the canvas: its upper left corner, width and height.
type Area = ((f64, f64), (f64, f64));

impl Side {
    /// The sides of two blocks that face each other.
    pub(super) fn between(pen: &Pen<'_>, from: &str, to: &str) -> (Self, Self) {
        let middle = |id| {
            let ((x, y), (width, height)) = pen.get(id).map_or(((0.0, 0.0), (0.0, 0.0)), area);
            (x + width / 2.0, y + height / 2.0)
        };
        let (from, to) = (middle(from), middle(to));
        let (right, down) = (to.0 - from.0, to.1 - from.1);
        match (right.abs() >= down.abs(), right >= 0.0, down >= 0.0) {
            (true, true, _) => (Self::Right, Self::Left),
            (true, false, _) => (Self::Left, Self::Right),
            (false, _, true) => (Self::Bottom, Self::Top),
            (false, _, false) => (Self::Top, Self::Bottom),
        }
    }

    /// The middle of this side as a port.
    fn port(self) -> f64 {
        match self {
            Self::Left => 0.5,
            Self::Top => 1.5,
            Self::Right => 2.5,
            Self::Bottom => 3.5,
        }
    }
}

/// Where a port of a block is.
fn spot(((x, y), (width, height)): Area, port: f64) -> (f64, f64) {
    let part = port.rem_euclid(1.0);
    match port.rem_euclid(4.0).floor() {
        0.0 => (x, y + height * part),
        1.0 => (x + width * part, y),
        2.0 => (x + width, y + height * part),
        _ => (x + width * part, y + height),
    }
}

fn area(object: &Object) -> Area {
    let corners = points(object, "configuration");
    let extent = |pick: fn(&(f64, f64)) -> f64| {
        let most = corners.iter().map(pick).fold(0.0, f64::max);
        if most > 0.0 { most } else { SIZE }
    };
    (
        point(object, "position"),
        (extent(|corner| corner.0), extent(|corner| corner.1)),
    )
}

/// Makes the way of a link straight between two sides.
pub(super) fn straight(pen: &mut Pen<'_>, link: &str, (from, to): (Side, Side)) {
    draw(pen, link, (from.port(), to.port()), &[]);
}

/// The ends of a link go with their blocks; corners between them stay.
pub(super) fn follow(pen: &mut Pen<'_>, link: &str) {
    let Some(object) = pen.get(link) else { return };
    let (x, y) = point(object, "position");
    let corners = points(object, "configuration");
    let inner: Vec<(f64, f64)> = match corners.len() {
        0..=2 => Vec::new(),
        count => corners[1..count - 1]
            .iter()
            .map(|corner| (corner.0 + x, corner.1 + y))
            .collect(),
    };
    let (Some(from), Some(to)) = (object.property("from"), object.property("to")) else {
        return;
    };
    if inner.is_empty() && pen.get(from).is_some() && pen.get(to).is_some() {
        let sides = Side::between(pen, from, to);
        return straight(pen, link, sides);
    }
    let port = |key: &str| {
        let text = object.property(key).unwrap_or_default();
        text.parse().ok().filter(|port: &f64| port.is_finite())
    };
    let ports = (
        port("fromPort").unwrap_or(2.5),
        port("toPort").unwrap_or(0.5),
    );
    draw(pen, link, ports, &inner);
}

fn draw(pen: &mut Pen<'_>, link: &str, ports: (f64, f64), inner: &[(f64, f64)]) {
    let end = |key: &str, port: f64| {
        let block = pen.get(pen.get(link)?.property(key)?)?;
        (block.id != crate::objects::ROOT).then(|| spot(area(block), port))
    };
    // A loose end stays where it is.
    let (Some(from), Some(to)) = (end("from", ports.0), end("to", ports.1)) else {
        return;
    };
    let mut corners = String::from("0, 0 : ");
    for (x, y) in inner.iter().chain([&to]) {
        corners.push_str(&format!("{}, {} : ", x - from.0, y - from.1));
    }
    let Some(object) = pen.get_mut(link) else {
        return;
    };
    let position = format!("{}, {}", from.0, from.1);
    object.set(Kind::Shape("QPointF"), "position", &position);
    object.set(Kind::Shape("QPolygon"), "configuration", &corners);
    let number = Kind::Number("double");
    object.set(number, "fromPort", &ports.0.to_string());
    object.set(number, "toPort", &ports.1.to_string());
}
