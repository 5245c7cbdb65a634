//! A field to the text of a world model.
//!
//! Owns where things stand in the text. What was read is changed only where a value is another one now.

use lang_text::xml::{self, Element, Node};

use super::Field;
use super::attributes::{Codec, Mode};
use super::items::{Drawn, Robot, Shape, SolidKind};

/// Of the text; the original takes it as its own.
const VERSION: &str = "20251219";
/// Spaces for each level.
const INDENT: usize = 4;

pub(super) fn write(field: &Field) -> String {
    let mut document = match &field.document {
        Some(document) => document.clone(),
        None => Element::new("root").with(
            "version",
            field.version.clone().unwrap_or(VERSION.to_owned()),
        ),
    };
    let scale = field.unit.pixels();
    if field.document.is_none() && document.child("settings").is_none() {
        document.child_mut("settings");
    }
    if document.child("settings").is_some() {
        let settings = document.child_mut("settings");
        let mut codec = codec(settings, scale);
        field.settings.clone().visit(&mut codec);
    }
    world(field, document.child_mut("world"), scale);
    robots(field, &mut document, scale);
    if let Some(constraints) = &field.constraints {
        document.nodes.push(Node::Element(constraints.clone()));
    }
    xml::write(&document, INDENT)
}

fn codec<'e>(element: &'e mut Element<'static>, scale: f64) -> Codec<'e, 'e> {
    Codec {
        element,
        mode: Mode::Write,
        scale,
        ordinal: 0,
    }
}

/// Puts tags in front of what a container has kept.
fn fill(world: &mut Element<'static>, name: &str, things: Vec<Element<'static>>) {
    if things.is_empty() && world.child(name).is_none() {
        return;
    }
    let list = world.child_mut(name);
    let kept = std::mem::take(&mut list.nodes);
    list.nodes = things.into_iter().map(Node::Element).chain(kept).collect();
}

fn world(field: &Field, world: &mut Element<'static>, scale: f64) {
    macro_rules! written {
        ($things:expr) => {
            $things
                .map(|thing| {
                    let mut element = thing.source.clone();
                    thing.clone().visit(&mut codec(&mut element, scale));
                    element
                })
                .collect::<Vec<_>>()
        };
    }
    fill(world, "walls", written!(field.walls.iter()));
    for kind in SolidKind::ALL {
        let name = format!("{}s", kind.tag());
        let of_kind = field.solids.iter().filter(|solid| solid.kind == kind);
        fill(world, &name, written!(of_kind));
    }
    let drawn = field.drawn.iter().map(|one| drawn(one, scale)).collect();
    fill(world, "colorFields", drawn);
    let is_old = |image: &&super::Image| image.source.name == "background";
    let old = written!(field.images.iter().filter(is_old));
    for (at, element) in old.into_iter().enumerate() {
        world.nodes.insert(at, Node::Element(element));
    }
    let new = written!(field.images.iter().filter(|image| !is_old(image)));
    fill(world, "images", new);
    fill(world, "regions", written!(field.regions.iter()));
    fill(world, "comments", written!(field.comments.iter()));
    fill(world, "trace", written!(field.trace.iter()));
}

fn drawn(drawn: &Drawn, scale: f64) -> Element<'static> {
    let mut element = drawn.source.clone();
    drawn.clone().visit(&mut codec(&mut element, scale));
    if let Shape::Stylus(strokes) = &drawn.shape {
        let kept = std::mem::take(&mut element.nodes);
        for stroke in strokes {
            let mut inner = stroke.source.clone();
            stroke.clone().visit(&mut codec(&mut inner, scale));
            element.nodes.push(Node::Element(inner));
        }
        element.nodes.extend(kept);
    }
    element
}

fn robots(field: &Field, document: &mut Element<'static>, scale: f64) {
    let mut elements = Vec::new();
    let mut in_world = document
        .child("world")
        .and_then(|world| world.child("robot").cloned());
    for robot in &field.robots {
        let mut element = robot.source.clone();
        robot_devices(robot, &mut element, scale);
        // The place stands where it stood; of new ones, in the world.
        let is_own = element.attribute("position").is_some() && in_world.is_none();
        if is_own {
            robot.clone().visit_place(&mut codec(&mut element, scale));
        } else if robot.is_trik() || field.robots.len() == 1 {
            let place = in_world.get_or_insert_with(|| Element::new("robot"));
            if let Some(start) = &robot.start
                && place.child("startPosition").is_none()
                && element.child("startPosition").is_none()
            {
                let marker = place.child_mut("startPosition");
                marker.set("x", &format!("{}", start.at.x / scale));
                marker.set("y", &format!("{}", start.at.y / scale));
                marker.set("direction", &format!("{}", start.direction));
            }
            robot.clone().visit_place(&mut codec(place, scale));
        }
        elements.push(element);
    }
    if let Some(place) = in_world
        && (!place.attributes.is_empty() || !place.nodes.is_empty())
    {
        *document.child_mut("world").child_mut("robot") = place;
    }
    let is_made_up = field.robots == [Robot::default()] && document.child("robots").is_none();
    if !is_made_up {
        fill(document, "robots", elements);
    }
}

fn robot_devices(robot: &Robot, element: &mut Element<'static>, scale: f64) {
    if element.attribute("id") != Some(robot.id.as_str()) {
        element.set("id", &robot.id);
    }
    let sensors = robot
        .sensors
        .iter()
        .map(|sensor| {
            let mut inner = sensor.source.clone();
            sensor.clone().visit(&mut codec(&mut inner, scale));
            inner
        })
        .collect();
    fill(element, "sensors", sensors);
    let sides = [("left", robot.left), ("right", robot.right)];
    let default = Robot::default();
    let is_usual = (robot.left, robot.right) == (default.left, default.right);
    if element.child("wheels").is_none() && is_usual {
        return;
    }
    let wheels = element.child_mut("wheels");
    for (side, motor) in sides {
        let there = wheels
            .attribute(side)
            .and_then(|text| super::read::port(text, lang_diagram::ports::Direction::Out));
        if there != motor || wheels.attribute(side).is_none() {
            let name = motor.map_or("None", lang_diagram::ports::Port::name);
            wheels.set(side, &format!("{name}###output######"));
        }
    }
}
