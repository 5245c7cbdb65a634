//! What the language sees of a world: named objects with properties, types and places.
//!
//! Owns the border and nothing behind it.

use super::value::{Rect, Value};

/// An object of a scene, found by its name; the scene says what the number means.
#[derive(Clone, Copy, Debug, Eq, Hash, PartialEq)]
pub struct Object(pub u32);

/// What of an object must be in a region.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum ObjectPoint {
    /// Its centre.
    #[default]
    Center,
    /// Its whole outline.
    All,
    /// Any part of its outline.
    Any,
}

/// Why a chain of properties has no value.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Missing {
    /// What stands before the link of this index has no such property.
    Property(usize),
    /// What stands before the link of this index is of a type without properties.
    Type(usize),
}

/// Why an object and a region cannot be matched.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Unfit {
    /// The region is none.
    NoRegion,
    /// The object has no place.
    NoPlace,
}

/// A world with robots, as the language sees it.
///
/// Objects have the names of the original: `robot1`, `robot1.A1`, `robot1.display`, the id of an item, `trace`. An object
/// that was found stays the same for the whole run.
pub trait Scene {
    /// The object of a name.
    fn find(&mut self, name: &str) -> Option<Object>;

    /// Whether there is an object of a name.
    fn has(&mut self, name: &str) -> bool {
        self.find(name).is_some()
    }

    /// The name of the class of an object in the original program; `None` for what is not plugged in.
    fn type_of(&mut self, object: Object) -> Option<&'static str>;

    /// What stands at the end of a chain of properties of an object; the chain is not empty. A scene knows its own
    /// properties and leaves what follows them to [`Value::descend`].
    ///
    /// # Errors
    /// [`Missing`], with the index of the link that has no value.
    fn property(&mut self, object: Object, chain: &[Box<str>]) -> Result<Value, Missing>;

    /// Gives a property a value; false if the object has no such property. A value that the property cannot take is left
    /// out, as in the original.
    fn set_property(&mut self, object: Object, property: &str, value: &Value) -> bool;

    /// The same for what stands at the end of a chain of properties of an object and is no object of the scene itself, as
    /// a figure on a display.
    fn set_within(
        &mut self,
        _object: Object,
        _chain: &[Box<str>],
        _property: &str,
        _value: &Value,
    ) -> bool {
        false
    }

    /// Whether an object is in a region.
    ///
    /// # Errors
    /// [`Unfit`] if the one is no region or the other has no place.
    fn is_inside(
        &mut self,
        object: Object,
        region: Object,
        point: ObjectPoint,
    ) -> Result<bool, Unfit>;

    /// How far an object is from being in a region, in pixels; for explanations, and `None` where it has no meaning. It is
    /// asked only of what is not in the region.
    fn distance(&mut self, _object: Object, _region: Object, _point: ObjectPoint) -> Option<f64> {
        None
    }

    /// The smallest rectangle around an object, or around everything in it if it is a set; `None` if it has none.
    fn bounding_rect(&mut self, object: Object) -> Option<Rect>;
}
