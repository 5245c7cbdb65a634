//! Values worked out: variables, states of objects, and the arithmetic in whole numbers.
//!
//! Owns evaluation. Knows no events; what is wrong at run time is told to a [`Complaints`].

use std::cmp::Ordering;
use std::collections::HashMap;
use std::rc::Rc;

use super::rules::{Binary, Comparison, Name, Operand, Path, Unary};
use super::scene::{Missing, Object, Scene};
use super::value::{Point, Rect, Value};
use super::words;
use crate::limits;
use lang_text::problem::Words;

/// Where errors go that are found while checking.
pub(super) type Complaints = Vec<Words>;

/// What evaluation needs and changes.
pub(super) struct Context<'a> {
    pub scene: &'a mut dyn Scene,
    pub variables: &'a mut HashMap<Box<str>, Value>,
    /// Objects that were found, by slot: the object and how many names are its own.
    pub found: &'a mut [Option<(Object, usize)>],
    pub complaints: Complaints,
}

/// The object at the beginning of a path in a scene, and how many names are its own: as many as there are objects for.
pub(super) fn head<S: Scene + ?Sized>(scene: &mut S, path: &Path) -> Option<(Object, usize)> {
    let mut name = path.parts.first()?.to_string();
    let mut head = (scene.find(&name)?, 1);
    for part in path.parts.iter().skip(1) {
        name.push('.');
        name.push_str(part);
        match scene.find(&name) {
            Some(longer) => head = (longer, head.1 + 1),
            None => break,
        }
    }
    Some(head)
}

impl Context<'_> {
    fn complain(&mut self, words: Words) {
        if self.complaints.len() < limits::CONSTRAINT_COMPLAINTS_MAX {
            self.complaints.push(words);
        }
    }

    /// The object of a name.
    pub fn object(&mut self, name: &Name) -> Option<Object> {
        if let Some((object, _)) = self.found[name.slot] {
            return Some(object);
        }
        let object = self.scene.find(&name.text)?;
        self.found[name.slot] = Some((object, 0));
        Some(object)
    }

    /// The same, remembered.
    pub fn head(&mut self, path: &Path) -> Option<(Object, usize)> {
        if let Some(found) = self.found[path.slot] {
            return Some(found);
        }
        let head = head(self.scene, path)?;
        self.found[path.slot] = Some(head);
        Some(head)
    }

    /// The value of an operand.
    pub fn value(&mut self, operand: &Operand) -> Value {
        match operand {
            Operand::Constant(value) => value.clone(),
            Operand::Variable(path) => self.variable(path, true),
            Operand::State(path) => self.state(path, true),
            Operand::Either(path) => self.either(path),
            Operand::TypeOf(name) => {
                let object = self.object(name);
                let class = object.and_then(|object| self.scene.type_of(object));
                Value::text(class.unwrap_or("undefined"))
            }
            Operand::Unary(operation, operand) => {
                let value = self.value(operand);
                match operation {
                    Unary::Minus => Value::Int(value.to_int().wrapping_neg()),
                    Unary::Abs => Value::Int(value.to_int().wrapping_abs()),
                    Unary::BoundingRect => Value::Rect(self.bounding_rect(&value)),
                }
            }
            Operand::Binary(operation, operands) => {
                let left = self.value(&operands[0]);
                let right = self.value(&operands[1]);
                binary(*operation, &left, &right)
            }
        }
    }

    /// Whether two operands compare so.
    pub fn compare(&mut self, comparison: Comparison, operands: &[Operand; 2]) -> bool {
        // Texts that are only looked at need not be made, as in the check of what is plugged in.
        let [left, right] = operands;
        if let (Operand::TypeOf(name), Operand::Constant(Value::Text(wanted))) = (left, right) {
            let object = self.object(name);
            let class = object.and_then(|object| self.scene.type_of(object));
            let class = class.unwrap_or("undefined");
            match comparison {
                Comparison::Equals => return class == &**wanted,
                Comparison::NotEqual => return class != &**wanted,
                Comparison::Greater
                | Comparison::Less
                | Comparison::NotLess
                | Comparison::NotGreater => {}
            }
        }
        let left = self.value(left);
        let right = self.value(right);
        let order = || left.order(&right);
        match comparison {
            Comparison::Equals => left.equals(&right),
            Comparison::NotEqual => !left.equals(&right),
            Comparison::Greater => order() == Some(Ordering::Greater),
            Comparison::Less => order() == Some(Ordering::Less),
            Comparison::NotGreater => {
                matches!(order(), Some(Ordering::Less | Ordering::Equal))
            }
            Comparison::NotLess => {
                matches!(order(), Some(Ordering::Greater | Ordering::Equal))
            }
        }
    }

    /// A variable; one that was never set is nothing, and no error, because events come in no order that an author sees.
    fn variable(&mut self, path: &Path, loud: bool) -> Value {
        let value = path
            .parts
            .first()
            .and_then(|name| self.variables.get(name))
            .cloned();
        match value {
            Some(value) if path.parts.len() == 1 => value,
            Some(value) => self.descend(value, path, 1, loud),
            None => Value::Null,
        }
    }

    /// The state of an object.
    pub fn state(&mut self, path: &Path, loud: bool) -> Value {
        let Some((object, own)) = self.head(path) else {
            if loud && path.parts.is_empty() {
                self.complain(words::empty_path());
            } else if loud {
                let name = path.parts.first().map_or("", |name| name);
                self.complain(words::no_object(name));
            }
            return Value::Null;
        };
        self.descend(Value::Object(object), path, own, loud)
    }

    /// Gives a property of what is no object of the scene a value; false if it cannot be.
    pub fn set_within(&mut self, path: &Path, property: &str, value: &Value) -> bool {
        let Some((object, own)) = self.head(path) else {
            return false;
        };
        let chain = &path.parts[own..];
        self.scene.set_within(object, chain, property, value)
    }

    fn either(&mut self, path: &Path) -> Value {
        let mut value = self.variable(path, false);
        if matches!(value, Value::Null) {
            value = self.state(path, false);
        }
        if matches!(value, Value::Null | Value::NoText) {
            self.complain(words::no_name(&path.text));
        }
        value
    }

    fn descend(&mut self, value: Value, path: &Path, from: usize, loud: bool) -> Value {
        let chain = &path.parts[from..];
        if chain.is_empty() {
            return value;
        }
        let found = if let Value::Object(object) = value {
            self.scene.property(object, chain)
        } else {
            value.descend(chain, 0)
        };
        match found {
            Ok(value) => value,
            Err(missing) => {
                if loud {
                    let (Missing::Property(at) | Missing::Type(at)) = missing;
                    let at = (from + at).min(path.parts.len() - 1);
                    let before = path.parts[..at].join(".");
                    self.complain(match missing {
                        Missing::Property(_) => words::no_property(&before, &path.parts[at]),
                        Missing::Type(_) => words::no_type(&before),
                    });
                }
                Value::Null
            }
        }
    }

    /// The rectangle around a value, or around everything in it; an empty one if there is nothing.
    fn bounding_rect(&mut self, value: &Value) -> Rect {
        let mut bounds: Option<Bounds> = None;
        let one = std::slice::from_ref(value);
        let items: Rc<[Value]>;
        let items = if let Value::List(list) = value {
            items = Rc::clone(list);
            &items[..]
        } else {
            one
        };
        for item in items {
            let found = match item {
                Value::Object(object) => self.scene.bounding_rect(*object).map(Bounds::of),
                Value::Rect(rect) => Some(Bounds::around(rect.x, rect.y)),
                Value::Point(_) | Value::Place(_) => {
                    let Point { x, y } = item.to_point();
                    Some(Bounds::around(x, y))
                }
                Value::Record(_) => record_bounds(item),
                Value::Null
                | Value::Bool(_)
                | Value::Int(_)
                | Value::Double(_)
                | Value::NoText
                | Value::Text(_)
                | Value::Colour(_)
                | Value::Opaque
                | Value::List(_) => None,
            };
            bounds = match (bounds, found) {
                (Some(all), Some(more)) => Some(all.with(more)),
                (all, more) => all.or(more),
            };
        }
        bounds.map(Bounds::rect).unwrap_or_default()
    }
}

fn record_bounds(record: &Value) -> Option<Bounds> {
    let field = |name: &str| record.clone().descend(&[name.into()], 0).ok();
    match field("boundingRect") {
        Some(Value::Rect(rect)) => Some(Bounds::of(rect)),
        _ => Some(Bounds::around(field("x")?.to_int(), field("y")?.to_int())),
    }
}

/// The outermost pixels of something, as the original keeps them: the right side of a rectangle is inside it.
#[derive(Clone, Copy)]
struct Bounds {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

impl Bounds {
    fn of(rect: Rect) -> Self {
        Self {
            left: rect.x,
            top: rect.y,
            right: rect.x.saturating_add(rect.width).saturating_sub(1),
            bottom: rect.y.saturating_add(rect.height).saturating_sub(1),
        }
    }

    fn around(x: i32, y: i32) -> Self {
        Self {
            left: x,
            top: y,
            right: x,
            bottom: y,
        }
    }

    fn with(self, other: Self) -> Self {
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    fn rect(self) -> Rect {
        let length = |from: i32, to: i32| to.saturating_sub(from).saturating_add(1);
        Rect {
            x: self.left,
            y: self.top,
            width: length(self.left, self.right),
            height: length(self.top, self.bottom),
        }
    }
}

fn binary(operation: Binary, left: &Value, right: &Value) -> Value {
    if matches!(operation, Binary::Distance) {
        let (left, right) = (left.to_point(), right.to_point());
        let x = f64::from(left.x) - f64::from(right.x);
        let y = f64::from(left.y) - f64::from(right.y);
        return Value::Double(libm::hypot(x, y));
    }
    let (left, right) = (left.to_int(), right.to_int());
    Value::Int(match operation {
        Binary::Sum => left.wrapping_add(right),
        Binary::Difference => left.wrapping_sub(right),
        Binary::Mul => left.wrapping_mul(right),
        Binary::Min => left.min(right),
        Binary::Max | Binary::Distance => left.max(right),
    })
}
