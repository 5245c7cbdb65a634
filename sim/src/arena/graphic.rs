//! What rules have changed of things on a field as they are drawn: where, how turned, whether visible.
//!
//! Owns that of each thing by its number. A thing begins at (0, 0) of its own, wherever it lies: so it is in the original.
//! Knows no rules and no sensors.

use std::collections::BTreeMap;

use crate::geometry::{Point, point};

/// Families of things on a field.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Family {
    /// Walls.
    Wall,
    /// Balls, skittles and cubes.
    Solid,
    /// Drawn things.
    Drawn,
    /// Regions.
    Region,
}

/// A thing as it is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Graphic {
    /// By how much it was shifted.
    pub at: Point,
    /// Degrees clockwise, around where it begins.
    pub rotation: f64,
    /// Whether it is shown, if that was changed.
    pub is_visible: Option<bool>,
}

impl Graphic {
    /// A place of the field as the thing has it, which does not know that it was shifted and turned.
    pub fn back(&self, at: Point) -> Point {
        let moved = at.from(self.at);
        if self.rotation == 0.0 {
            return moved;
        }
        let (sin, cos) = libm::sincos((-self.rotation).to_radians());
        point(moved.x * cos - moved.y * sin, moved.x * sin + moved.y * cos)
    }
}

/// All things that were changed.
#[derive(Clone, Debug, Default)]
pub struct Graphics(BTreeMap<(Family, usize), Graphic>);

impl Graphics {
    /// A thing as it is drawn now.
    pub fn of(&self, family: Family, index: usize) -> Graphic {
        self.0.get(&(family, index)).copied().unwrap_or_default()
    }

    /// The same, to be changed.
    pub fn change(&mut self, family: Family, index: usize) -> &mut Graphic {
        self.0.entry((family, index)).or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn things_begin_unchanged_and_are_told_apart() {
        let mut graphics = Graphics::default();
        graphics.change(Family::Region, 1).rotation = 45.0;
        assert_eq!(graphics.of(Family::Region, 1).rotation, 45.0);
        assert_eq!(graphics.of(Family::Drawn, 1), Graphic::default());
    }
}
