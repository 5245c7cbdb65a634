//! The way of a link on the canvas: from a side of one block to a side of another.
//!
//! Owns the numbers by which the editor keeps sides and corners: of a port the whole part is the side, clockwise from the
//! left, and the rest how far along it; corners are relative to the place of the link. Where a language has ports with places,
//! the number is that of the port.

use super::notation::Port;
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
    fn between(pen: &Pen<'_>, from: &str, to: &str) -> (Self, Self) {
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

/// Where a link leaves a block and enters another one, as a save has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    from: f64,
    to: f64,
}

impl Ends {
    /// Sides of two blocks that face each other.
    pub(super) fn between(pen: &Pen<'_>, from: &str, to: &str) -> Self {
        let (from, to) = Side::between(pen, from, to);
        Self {
            from: from.port(),
            to: to.port(),
        }
    }

    /// Ports by their numbers.
    pub(super) fn at(from: i32, to: i32) -> Self {
        Self {
            from: from.into(),
            to: to.into(),
        }
    }
}

/// The ports of a link, by their places among those of their blocks; nothing if one end is at none.
pub(super) fn places(pen: &Pen<'_>, link: &str) -> Option<(u8, u8)> {
    let object = pen.get(link)?;
    let place = |end: &str, port: &str| {
        let ports = pen.ports(object.property(end)?)?;
        let number: f64 = object.property(port)?.parse().ok()?;
        let is_meant = |one: &Port| f64::from(one.number) == number.round();
        u8::try_from(ports.iter().position(is_meant)?).ok()
    };
    Some((place("from", "fromPort")?, place("to", "toPort")?))
}

/// Where a port of a block is.
fn spot(pen: &Pen<'_>, block: &Object, port: f64) -> (f64, f64) {
    let area @ ((x, y), (width, height)) = area(block);
    let Some(ports) = pen.ports(&block.id) else {
        return on_side(area, port);
    };
    let is_meant = |one: &&Port| f64::from(one.number) == port.round();
    match ports.iter().find(is_meant) {
        Some(found) => (x + found.at.0, y + found.at.1),
        None => (x + width / 2.0, y + height / 2.0),
    }
}

fn on_side(((x, y), (width, height)): Area, port: f64) -> (f64, f64) {
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

/// Makes the way of a link straight.
pub(super) fn straight(pen: &mut Pen<'_>, link: &str, ends: Ends) {
    draw(pen, link, ends, &[]);
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
    let has_sides = pen.ports(from).is_none() && pen.ports(to).is_none();
    if has_sides && inner.is_empty() && pen.get(from).is_some() && pen.get(to).is_some() {
        let ends = Ends::between(pen, from, to);
        return straight(pen, link, ends);
    }
    let port = |key: &str| {
        let text = object.property(key).unwrap_or_default();
        text.parse().ok().filter(|port: &f64| port.is_finite())
    };
    let ends = Ends {
        from: port("fromPort").unwrap_or(2.5),
        to: port("toPort").unwrap_or(0.5),
    };
    draw(pen, link, ends, &inner);
}

fn draw(pen: &mut Pen<'_>, link: &str, ends: Ends, inner: &[(f64, f64)]) {
    let end = |key: &str, port: f64| {
        let block = pen.get(pen.get(link)?.property(key)?)?;
        (block.id != crate::objects::ROOT).then(|| spot(pen, block, port))
    };
    // A loose end stays where it is.
    let (Some(from), Some(to)) = (end("from", ends.from), end("to", ends.to)) else {
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
    object.set(number, "fromPort", &ends.from.to_string());
    object.set(number, "toPort", &ends.to.to_string());
}
