//! A display as rules see it: lists of figures by kind, each with its numbers.
//!
//! Owns the names of properties, which are those of the original.

use lang_constraint::{Point, Rect, Value};

use super::set::{colour, truth, whole};
use crate::arena::screen::{Form, Object, Screen};
use screen::colour::Colour;

/// Which figures a list holds, by its name.
fn is_in(list: &str) -> Option<fn(&Form) -> bool> {
    Some(match list {
        "objects" => |_| true,
        "pixels" => |form| matches!(form, Form::Point(_)),
        "segments" => |form| matches!(form, Form::Line(_)),
        "rectangles" => |form| matches!(form, Form::Rectangle(..)),
        "ellipses" => |form| matches!(form, Form::Ellipse(..)),
        "arcs" => |form| matches!(form, Form::Arc(_)),
        "labels" => |form| matches!(form, Form::Text(..)),
        _ => return None,
    })
}

/// How many figures a list has, or whether it has none, without the list.
pub(super) fn count(screen: &Screen, list: &str, property: &str) -> Option<Value> {
    let is_in = is_in(list)?;
    let mut found = screen.objects().iter().filter(|one| is_in(&one.form));
    match property {
        "size" => Some(super::count(found.count())),
        "isEmpty" => Some(Value::Bool(found.next().is_none())),
        _ => None,
    }
}

/// A property of a display.
pub(super) fn property(screen: &Screen, name: &str) -> Option<Value> {
    Some(match name {
        "smiles" => Value::Bool(screen.smiles()),
        "sadSmiles" => Value::Bool(screen.sad_smiles()),
        "background" => Value::colour(screen.background().number()),
        _ => {
            let is_in = is_in(name)?;
            let found = screen.objects().iter().filter(|one| is_in(&one.form));
            Value::list(found.map(figure))
        }
    })
}

/// A figure with its properties.
fn figure(object: &Object) -> Value {
    let mut fields = vec![
        ("color", Value::colour(object.colour.number())),
        ("thickness", Value::Int(object.thickness)),
    ];
    match &object.form {
        Form::Point([x, y]) => fields.extend(place(*x, *y)),
        Form::Line([x1, y1, x2, y2]) => {
            let length = |from: i32, to: i32| i32::try_from(from.abs_diff(to)).unwrap_or(i32::MAX);
            let around = rect([*x1.min(x2), *y1.min(y2), length(*x1, *x2), length(*y1, *y2)]);
            fields.extend([
                ("begin", at(*x1, *y1)),
                ("end", at(*x2, *y2)),
                ("boundingRect", around),
            ]);
        }
        Form::Rectangle(sides, filled) => fields.extend([
            ("shape", rect(*sides)),
            ("boundingRect", rect(*sides)),
            ("filled", Value::Bool(*filled)),
        ]),
        Form::Ellipse([x, y, a, b], filled) => {
            let corner = [x.saturating_sub(*a), y.saturating_sub(*b)];
            let size = [a.saturating_mul(2), b.saturating_mul(2)];
            fields.extend([
                ("center", at(*x, *y)),
                ("w", Value::Int(*a)),
                ("h", Value::Int(*b)),
                (
                    "boundingRect",
                    rect([corner[0], corner[1], size[0], size[1]]),
                ),
                ("filled", Value::Bool(*filled)),
            ]);
        }
        Form::Arc([x, y, width, height, start, span]) => {
            let around = rect([*x, *y, *width, *height]);
            let middle = |from: &i32, length: &i32| from.saturating_add((length - 1).div_euclid(2));
            let middle = at(middle(x, width), middle(y, height));
            fields.extend([
                ("ellipseCenter", middle),
                ("ellipseRect", around.clone()),
                ("boundingRect", around),
                ("startAngle", Value::Int(*start)),
                ("spanAngle", Value::Int(*span)),
            ]);
        }
        Form::Text([x, y], text, size) => {
            fields.extend(place(*x, *y));
            fields.extend([("text", Value::text(text)), ("fontSize", Value::Int(*size))]);
        }
    }
    Value::Record(fields.into())
}

/// Gives a property of a figure in a list a value; false if there is no such figure or property.
pub(super) fn set(
    screen: &mut Screen,
    (list, which): (&str, &str),
    property: &str,
    value: &Value,
) -> bool {
    let Some(is_in) = is_in(list) else {
        return false;
    };
    let found = screen.objects_mut().iter_mut();
    let mut found: Vec<&mut Object> = found.filter(|one| is_in(&one.form)).collect();
    let index = match which {
        "first" => Some(0),
        "last" => found.len().checked_sub(1),
        _ => which.parse().ok(),
    };
    let Some(object) = index.and_then(|index: usize| found.get_mut(index)) else {
        return false;
    };
    let is_there = matches!(figure(object), Value::Record(fields)
        if fields.iter().any(|(name, _)| *name == property));
    if is_there {
        change(object, property, value);
    }
    is_there
}

fn change(object: &mut Object, property: &str, value: &Value) {
    let number = whole(value);
    match (property, colour(value), number) {
        ("color", Some(argb), _) => object.colour = Colour::from_number(argb & 0xff_ffff),
        ("thickness", _, Some(number)) => object.thickness = number,
        _ => match (&mut object.form, property, number) {
            (Form::Point([x, _]) | Form::Text([x, _], ..), "x", Some(number)) => *x = number,
            (Form::Point([_, y]) | Form::Text([_, y], ..), "y", Some(number)) => *y = number,
            (Form::Text(_, text, _), "text", _) => *text = value.to_text(),
            (Form::Text(_, _, size), "fontSize", Some(number))
            | (Form::Ellipse([_, _, size, _], _), "w", Some(number))
            | (Form::Ellipse([_, _, _, size], _), "h", Some(number))
            | (Form::Arc([.., size, _]), "startAngle", Some(number))
            | (Form::Arc([.., size]), "spanAngle", Some(number)) => *size = number,
            (Form::Rectangle(_, filled) | Form::Ellipse(_, filled), "filled", _) => {
                *filled = truth(value).unwrap_or(*filled);
            }
            // Rectangles and places are only read.
            _ => {}
        },
    }
}

fn place(x: i32, y: i32) -> [(&'static str, Value); 3] {
    [
        ("x", Value::Int(x)),
        ("y", Value::Int(y)),
        ("pos", at(x, y)),
    ]
}

fn at(x: i32, y: i32) -> Value {
    Value::Point(Point { x, y })
}

fn rect([x, y, width, height]: [i32; 4]) -> Value {
    Value::Rect(Rect {
        x,
        y,
        width,
        height,
    })
}
