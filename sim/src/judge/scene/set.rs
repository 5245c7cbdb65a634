//! What rules may change of things: which properties can be set, and what becomes of a value on the way.
//!
//! Owns conversions, which are those of the original: a value that cannot become what a property holds changes nothing, and
//! nobody is told. Knows no rules.

use lang_constraint::Value;
use lang_diagram::brick::{Brick as _, Command};
use lang_diagram::ports::{Port, Sort};
use screen::colour::Colour;

use super::{Part, SceneObject, property};
use crate::arena::graphic::Family;
use crate::arena::{Arena, Change};
use crate::field::{Drawn, Shape};
use crate::geometry::{Point, point};
use crate::limits;

/// Black that hides what is below it.
pub(super) const BLACK: u32 = 0xff00_0000;

/// The family of a thing that is drawn on the field, and which one of it.
pub(super) fn family(thing: SceneObject) -> Option<(Family, usize)> {
    match thing {
        SceneObject::Wall(index) => Some((Family::Wall, index)),
        SceneObject::Solid(index) => Some((Family::Solid, index)),
        SceneObject::Drawn(index) => Some((Family::Drawn, index)),
        SceneObject::Region(index) => Some((Family::Region, index)),
        SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => None,
    }
}

/// A colour as 0xaarrggbb: a name, `#rgb`, `#rrggbb` or `#aarrggbb`.
pub(super) fn argb(text: &str) -> Option<u32> {
    let text = text.trim();
    match text.strip_prefix('#') {
        Some(digits) if digits.len() == 8 => u32::from_str_radix(digits, 16).ok(),
        _ => {
            let colour = Colour::named(text).ok()?;
            Some(BLACK | colour.number())
        }
    }
}

/// The value as a number that a field can hold; nothing for what is none.
pub(super) fn real(value: &Value) -> Option<f64> {
    let number = match value {
        Value::Double(number) => *number,
        Value::Int(number) => f64::from(*number),
        Value::Bool(yes) => f64::from(u8::from(*yes)),
        Value::Text(text) => text.trim().parse().ok()?,
        Value::Null
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Colour(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => return None,
    };
    let most = limits::FIELD_NUMBER;
    number.is_finite().then(|| number.clamp(-most, most))
}

/// The value as a whole number; nothing for what is none.
pub(super) fn whole(value: &Value) -> Option<i32> {
    match value {
        Value::Int(_) | Value::Bool(_) | Value::Double(_) => Some(value.to_int()),
        Value::Text(text) => text.trim().parse().ok(),
        Value::Colour(_)
        | Value::Null
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => None,
    }
}

/// The value as true or false; nothing for what is neither.
pub(super) fn truth(value: &Value) -> Option<bool> {
    match value {
        Value::Bool(yes) => Some(*yes),
        Value::Int(number) => Some(*number != 0),
        Value::Double(number) => Some(*number != 0.0),
        Value::Text(text) => Some(!["", "0", "false"].contains(&text.to_lowercase().as_str())),
        Value::Colour(_)
        | Value::Null
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => None,
    }
}

/// The value as a colour; nothing for what is none.
pub(super) fn colour(value: &Value) -> Option<u32> {
    match value {
        Value::Colour(argb) => Some(*argb),
        Value::Text(text) => argb(text),
        Value::Bool(_)
        | Value::Int(_)
        | Value::Double(_)
        | Value::Null
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => None,
    }
}

/// Gives a property of a thing a value; false if it has no such property, or if it can only be read through another name.
pub(super) fn set(arena: &mut Arena, thing: SceneObject, name: &str, value: &Value) -> bool {
    match thing {
        SceneObject::Robot(index) if name == "rotation" => {
            if let (Some(robot), Some(degrees)) = (arena.robot_mut(index), real(value)) {
                let mut pose = robot.pose();
                pose.degrees = degrees;
                robot.put(pose);
            }
            true
        }
        SceneObject::Device(index, port) => device(arena, (index, port), name, value),
        SceneObject::Part(index, which) => part(arena, (index, which), name, value),
        SceneObject::Wall(_)
        | SceneObject::Solid(_)
        | SceneObject::Drawn(_)
        | SceneObject::Region(_) => item(arena, thing, name, value),
        // What is there and cannot be set stays as it is, without a word.
        SceneObject::Robot(_) | SceneObject::Trace => property(arena, thing, name).is_some(),
    }
}

fn device(arena: &mut Arena, (index, port): (usize, Port), name: &str, value: &Value) -> bool {
    if property(arena, SceneObject::Device(index, port), name).is_none() {
        return false;
    }
    let Some(robot) = arena.robot_mut(index) else {
        return false;
    };
    match (port.sort(), name) {
        (Sort::Motor, "power") => {
            if let Some(percent) = whole(value) {
                robot.set_power(port, percent);
            }
        }
        (Sort::Servo, "power") => {
            if let Some(degrees) = whole(value) {
                robot.set_servo(port, degrees);
            }
        }
        (_, "locked") => {
            if let Some(is_locked) = truth(value) {
                robot.readings.lock(port, is_locked);
            }
        }
        (Sort::Vector, _) => {}
        (Sort::Motor | Sort::Servo | Sort::Encoder | Sort::Scalar | Sort::Button(_), _) => {
            if let Some(reading) = whole(value) {
                robot.readings.give(port, reading);
            }
        }
    }
    true
}

fn part(arena: &mut Arena, (index, part): (usize, Part), name: &str, value: &Value) -> bool {
    if property(arena, SceneObject::Part(index, part), name).is_none() {
        return false;
    }
    let change = match (part, name) {
        (Part::Random, "fixedValue") => {
            let fixed = whole(value);
            if let Some(robot) = arena.robot_mut(index)
                && (fixed.is_some() || matches!(value, Value::Null))
            {
                robot.dice.fixed = fixed;
            }
            return true;
        }
        (Part::Led, "color") => colour(value)
            .zip(arena.robot_mut(index))
            .map(|(argb, robot)| {
                robot.shown.led = Colour::from_number(argb & !BLACK);
                robot.shown.led_alpha = (argb >> 24) as u8;
                Change::Led
            }),
        (Part::Display, "background") => {
            colour(value)
                .zip(arena.robot_mut(index))
                .map(|(argb, robot)| {
                    let colour = Colour::from_number(argb & !BLACK);
                    robot.shown.screen.set_background(colour);
                    Change::Background
                })
        }
        (Part::Shell, "lastPhrase") => {
            let text = value.to_text();
            let text = Some(&*text);
            arena.robot(index).command(Command::Say { text });
            Some(Change::Phrase)
        }
        (Part::Marker, "isDown") => truth(value).map(|is_down| {
            arena.robot(index).command(match is_down {
                true => Command::MarkerDown { color: "black" },
                false => Command::MarkerUp,
            });
            Change::Marker
        }),
        (
            Part::Display
            | Part::Shell
            | Part::Led
            | Part::Marker
            | Part::Random
            | Part::Speaker
            | Part::Network,
            _,
        ) => None,
    };
    if let Some(change) = change {
        arena.note(index, change);
    }
    true
}

fn item(arena: &mut Arena, thing: SceneObject, name: &str, value: &Value) -> bool {
    let Some((family, index)) = family(thing) else {
        return false;
    };
    let is_of_pen = match thing {
        SceneObject::Drawn(_) => ["color", "thickness", "filled"].contains(&name),
        SceneObject::Region(_) => ["color", "filled"].contains(&name),
        SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Wall(_)
        | SceneObject::Solid(_)
        | SceneObject::Trace => false,
    };
    if is_of_pen {
        if property(arena, thing, name).is_some() {
            paint(arena, thing, name, value);
            return true;
        }
        return false;
    }
    match name {
        "x" | "y" => {
            if let Some(number) = real(value) {
                shift(arena, thing, name == "x", number);
            }
        }
        "rotation" => {
            if let Some(degrees) = real(value) {
                arena.graphics.change(family, index).rotation = degrees;
                if let SceneObject::Solid(index) = thing {
                    arena.edit(|field| {
                        if let Some(solid) = field.solids.get_mut(index) {
                            solid.rotation = degrees;
                        }
                    });
                }
            }
        }
        "visible" => {
            if let Some(is_visible) = truth(value) {
                arena.graphics.change(family, index).is_visible = Some(is_visible);
            }
        }
        "pos" | "z" | "opacity" | "enabled" | "scale" => {}
        // What a thing is made of is found for reading only.
        _ => return false,
    }
    true
}

/// Puts a thing elsewhere: a ball with its centre there, everything else so far from where it was drawn. A wall is only
/// drawn elsewhere, and stands where it stood.
fn shift(arena: &mut Arena, thing: SceneObject, is_x: bool, number: f64) {
    let Some((family, index)) = family(thing) else {
        return;
    };
    let graphic = arena.graphics.change(family, index);
    let place = if is_x {
        &mut graphic.at.x
    } else {
        &mut graphic.at.y
    };
    let by = number - *place;
    *place = number;
    let by = if is_x { point(by, 0.0) } else { point(0.0, by) };
    match thing {
        SceneObject::Solid(index) => arena.edit(|field| {
            if let Some(solid) = field.solids.get_mut(index) {
                *(if is_x {
                    &mut solid.at.x
                } else {
                    &mut solid.at.y
                }) = number;
            }
        }),
        SceneObject::Drawn(index) => arena.edit(|field| {
            if let Some(drawn) = field.drawn.get_mut(index) {
                move_drawn(drawn, by);
            }
        }),
        SceneObject::Wall(_)
        | SceneObject::Region(_)
        | SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => {}
    }
}

fn move_drawn(drawn: &mut Drawn, by: Point) {
    let move_point = |at: &mut Point| *at = point(at.x + by.x, at.y + by.y);
    match &mut drawn.shape {
        Shape::Line(begin, end) | Shape::Rectangle(begin, end) | Shape::Ellipse(begin, end) => {
            [begin, end].into_iter().for_each(move_point);
        }
        Shape::Curve(begin, one, other, end) => {
            [begin, one, other, end].into_iter().for_each(move_point);
        }
        Shape::Stylus(strokes) => {
            for stroke in strokes {
                [&mut stroke.begin, &mut stroke.end]
                    .into_iter()
                    .for_each(move_point);
            }
        }
    }
}

fn paint(arena: &mut Arena, thing: SceneObject, name: &str, value: &Value) {
    let hex = colour(value).map(|argb| format!("#{argb:08x}"));
    let (number, is_filled) = (real(value), truth(value));
    arena.edit(|field| match thing {
        SceneObject::Drawn(index) => {
            let Some(drawn) = field.drawn.get_mut(index) else {
                return;
            };
            match (name, hex, number, is_filled) {
                ("color", Some(hex), ..) => drawn.pen.colour = hex,
                ("thickness", _, Some(width), _) => drawn.pen.width = width.max(0.0).round(),
                ("filled", _, _, Some(is_filled)) => {
                    let style = if is_filled { "solid" } else { "none" };
                    style.clone_into(&mut drawn.pen.fill_style);
                }
                _ => {}
            }
        }
        SceneObject::Region(index) => {
            let Some(region) = field.regions.get_mut(index) else {
                return;
            };
            match (name, hex, is_filled) {
                ("color", Some(hex), _) => region.colour = hex,
                ("filled", _, Some(is_filled)) => region.filled = is_filled,
                _ => {}
            }
        }
        SceneObject::Wall(_)
        | SceneObject::Solid(_)
        | SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => {}
    });
}
