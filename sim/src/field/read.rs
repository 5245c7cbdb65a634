//! The text of a world model to a field.
//!
//! Owns which tags there are, where they stand and what each of them says. Knows no simulation.

use std::collections::{BTreeMap, BTreeSet};

use lang_diagram::ports::{Direction, Kit, Port};
use lang_text::problem::{Problem, Severity, keep};
use lang_text::xml::{self, Element, Node};

use super::attributes::{Codec, Mode};
use super::blob::Blob;
use super::items::{
    Comment, Drawn, Image, Pen, Region, Robot, Sensor, Settings, Shape, Solid, SolidKind, Stroke,
    Trace, Unit, Wall,
};
use super::{Field, words};
use crate::geometry::Point;
use crate::limits;

/// A field that was read.
#[derive(Clone, Debug)]
pub struct Opened {
    /// What it has.
    pub field: Field,
    /// What is strange but does not keep it from being simulated.
    pub problems: Vec<Problem>,
}

pub(super) fn read(text: &str) -> Result<Opened, Vec<Problem>> {
    let document = xml::parse(text).map_err(|problem| vec![problem])?;
    let mut document = document.into_owned();
    // TRIK Studio exports a world together with its images.
    let mut blobs = BTreeMap::new();
    gather_blobs(&document, &mut blobs);
    if document.name != "root"
        && let Some(at) = document
            .nodes
            .iter()
            .position(|node| matches!(node, Node::Element(one) if one.name == "root"))
        && let Node::Element(root) = document.nodes.swap_remove(at)
    {
        document = root;
    }
    if document.child("world").is_none() {
        return Err(vec![Problem::error(words::no_world())]);
    }
    gather_blobs(&document, &mut blobs);
    let mut reader = Reader::new(&document);
    reader.field.blobs = blobs;
    reader.settings(&mut document);
    reader.world(&mut document);
    reader.robots(&mut document);
    reader.constraints(&mut document);
    reader.bounds();
    reader.pushed();
    let Reader {
        mut field,
        problems,
        ..
    } = reader;
    field.document = Some(document);
    if problems.iter().any(|one| one.severity == Severity::Error) {
        return Err(problems);
    }
    Ok(Opened { field, problems })
}

struct Reader {
    field: Field,
    problems: Vec<Problem>,
    scale: f64,
    /// Ids of each family of things, as the original keeps them apart.
    ids: BTreeSet<(&'static str, String)>,
    count: usize,
}

impl Reader {
    fn new(document: &Element<'static>) -> Self {
        let version = document.attribute("version").map(str::to_owned);
        // Since 2025 the original reads a text without settings in centimetres, also one that is older and was not meant so.
        let unit = match document.child("settings") {
            None => Unit::Centimetres,
            Some(settings) => match settings.attribute("sizeUnit") {
                Some("cm") => Unit::Centimetres,
                Some("mm") => Unit::Millimetres,
                Some("m") => Unit::Metres,
                _ => Unit::Pixels,
            },
        };
        let is_old = version.is_none() && document.child("settings").is_none();
        let problems = is_old.then(|| Problem::warning(words::no_settings()));
        Self {
            field: Field {
                version,
                unit,
                ..Field::default()
            },
            problems: problems.into_iter().collect(),
            scale: unit.pixels(),
            ids: BTreeSet::new(),
            count: 0,
        }
    }

    fn codec<'s>(&'s mut self, element: &'s mut Element<'static>, ordinal: usize) -> Codec<'s, 's> {
        Codec {
            element,
            mode: Mode::Read(&mut self.problems),
            scale: self.scale,
            ordinal,
        }
    }

    fn settings(&mut self, document: &mut Element<'static>) {
        let Some(element) = document
            .elements_mut()
            .find(|element| element.name == "settings")
        else {
            return;
        };
        let mut settings = Settings::default();
        settings.visit(&mut self.codec(element, 1));
        self.field.settings = settings;
    }

    /// Realistic physics computes every touch of every two things in every tick.
    fn pushed(&mut self) {
        let count = self.field.solids.len();
        if self.field.settings.realistic_physics && count > limits::FIELD_PUSHED {
            let problem = Problem::error(words::too_many_pushed(count, limits::FIELD_PUSHED));
            self.problems.push(problem);
        }
    }

    fn world(&mut self, document: &mut Element<'static>) {
        if let Some(world) = document.elements_mut().find(|one| one.name == "world") {
            // Backgrounds come first in the original, whatever their place is.
            self.take(world, |reader, element| {
                if element.name == "background" {
                    reader.background(element)
                } else {
                    Err(element)
                }
            });
            for name in super::table::LISTS {
                for list in world.elements_mut().filter(|one| one.name == name) {
                    self.take(list, Self::thing);
                }
            }
            // Only the first list of regions counts.
            if let Some(list) = world.elements_mut().find(|one| one.name == "regions") {
                self.take(list, Self::thing);
            }
        }
    }

    /// Gives each tag inside another one away; who does not want it gives it back.
    fn take(
        &mut self,
        list: &mut Element<'static>,
        mut give: impl FnMut(&mut Self, Element<'static>) -> Result<(), Element<'static>>,
    ) {
        for node in std::mem::take(&mut list.nodes) {
            match node {
                Node::Element(element) if self.count < limits::FIELD_THINGS => {
                    match give(self, element) {
                        Ok(()) => self.count += 1,
                        Err(element) => list.nodes.push(Node::Element(element)),
                    }
                    if self.count == limits::FIELD_THINGS {
                        let problem = Problem::error(words::too_many(limits::FIELD_THINGS));
                        self.problems.insert(0, problem);
                    }
                }
                other => list.nodes.push(other),
            }
        }
    }

    /// Whether an id is still free in its family; things without one have one of their own each.
    fn is_new(&mut self, family: &'static str, element: &Element<'static>) -> bool {
        let id = element.attribute("id").unwrap_or_default();
        if id.is_empty() || self.ids.insert((family, id.to_owned())) {
            return true;
        }
        let mut problem = Problem::warning(words::same_id(&element.name, id));
        problem.place.object = Some(id.to_owned());
        problem.place.offset = Some(element.start.0);
        keep(&mut self.problems, problem);
        false
    }

    fn thing(&mut self, mut element: Element<'static>) -> Result<(), Element<'static>> {
        let family = match element.name.as_ref() {
            "wall" => "wall",
            "skittle" => "skittle",
            "ball" => "ball",
            "cube" => "cube",
            "line" | "rectangle" | "ellipse" | "cubicBezier" | "stylus" => "drawn",
            "image" => "image",
            "comment" => "comment",
            "segment" => "segment",
            "region" => return self.region(element),
            _ => return Err(element),
        };
        if !self.is_new(family, &element) {
            return Err(element);
        }
        let ordinal = self.count + 1;
        let kind = SolidKind::ALL.into_iter().find(|kind| kind.tag() == family);
        if let Some(kind) = kind {
            let mut solid = Solid::new(kind, Point::default());
            solid.visit(&mut self.codec(&mut element, ordinal));
            solid.source = element;
            self.field.solids.push(solid);
            return Ok(());
        }
        match family {
            "wall" => {
                let mut wall = Wall::default();
                wall.visit(&mut self.codec(&mut element, ordinal));
                wall.source = element;
                self.field.walls.push(wall);
            }
            "drawn" => {
                let drawn = self.drawn(element, ordinal);
                self.field.drawn.push(drawn);
            }
            "image" => {
                let mut image = Image::default();
                image.visit(&mut self.codec(&mut element, ordinal));
                self.own_blob(&mut image, &element);
                image.source = element;
                self.field.images.push(image);
            }
            "comment" => {
                let mut comment = Comment::default();
                comment.visit(&mut self.codec(&mut element, ordinal));
                comment.source = element;
                self.field.comments.push(comment);
            }
            _ => {
                let mut trace = Trace::default();
                trace.visit(&mut self.codec(&mut element, ordinal));
                trace.source = element;
                self.field.trace.push(trace);
            }
        }
        Ok(())
    }

    fn background(&mut self, mut element: Element<'static>) -> Result<(), Element<'static>> {
        let mut image = Image {
            is_background: true,
            ..Image::default()
        };
        image.visit(&mut self.codec(&mut element, 1));
        self.own_blob(&mut image, &element);
        image.source = element;
        self.field.images.push(image);
        Ok(())
    }

    /// Old versions keep the contents with the picture.
    fn own_blob(&mut self, image: &mut Image, element: &Element<'static>) {
        let Some(path) = element.attribute("path") else {
            return;
        };
        if image.image.is_empty() {
            image.image = format!("of {}", self.count);
        }
        let blob = blob_of(element, path);
        self.field.blobs.insert(image.image.clone(), blob);
    }

    fn drawn(&mut self, mut element: Element<'static>, ordinal: usize) -> Drawn {
        let none = Point::default();
        let shape = match element.name.as_ref() {
            "line" => Shape::Line(none, none),
            "rectangle" => Shape::Rectangle(none, none),
            "ellipse" => Shape::Ellipse(none, none),
            "cubicBezier" => Shape::Curve(none, none, none, none),
            _ => Shape::Stylus(Vec::new()),
        };
        let mut drawn = Drawn::new(shape, Pen::default());
        drawn.visit(&mut self.codec(&mut element, ordinal));
        if let Shape::Stylus(_) = drawn.shape {
            let mut strokes = Vec::new();
            self.take(&mut element, |reader, mut inner| {
                if inner.name != "stylusLine" {
                    return Err(inner);
                }
                let mut stroke = Stroke::default();
                stroke.visit(&mut reader.codec(&mut inner, ordinal));
                stroke.source = inner;
                strokes.push(stroke);
                Ok(())
            });
            drawn.shape = Shape::Stylus(strokes);
        }
        drawn.source = element;
        drawn
    }

    fn region(&mut self, mut element: Element<'static>) -> Result<(), Element<'static>> {
        let ordinal = self.count + 1;
        let mut region = Region::default();
        region.visit(&mut self.codec(&mut element, ordinal));
        let kind = region.kind.to_lowercase();
        if !["ellipse", "rectangle", "bound"].contains(&kind.as_str()) {
            let mut problem = Problem::warning(words::bad_region(&region.kind));
            problem.place.offset = Some(element.start.0);
            keep(&mut self.problems, problem);
            return Err(element);
        }
        region.source = element;
        // The last one with an id takes the place of the others.
        let same = |one: &Region| !region.id.is_empty() && one.id == region.id;
        match self.field.regions.iter().position(same) {
            Some(at) => self.field.regions[at] = region,
            None => self.field.regions.push(region),
        }
        Ok(())
    }

    /// Regions that take their place from a drawn thing need one.
    fn bounds(&mut self) {
        let ids: BTreeSet<&str> = self
            .field
            .drawn
            .iter()
            .map(|drawn| drawn.id.as_str())
            .filter(|id| !id.is_empty())
            .collect();
        for region in &self.field.regions {
            if region.is_bound() && !ids.contains(region.bound.as_str()) {
                let mut problem = Problem::warning(words::bad_bound(&region.bound));
                problem.place.object = Some(region.id.clone());
                problem.place.offset = Some(region.source.start.0);
                keep(&mut self.problems, problem);
            }
        }
    }

    fn constraints(&mut self, document: &mut Element<'static>) {
        let found = document
            .nodes
            .iter()
            .position(|node| matches!(node, Node::Element(one) if one.name == "constraints"));
        if let Some(at) = found
            && let Node::Element(constraints) = document.nodes.remove(at)
        {
            self.field.constraints = Some(constraints);
        }
    }

    fn robots(&mut self, document: &mut Element<'static>) {
        let in_world = document
            .child("world")
            .and_then(|world| world.child("robot").cloned());
        let wheels = document
            .child("world")
            .and_then(|world| world.child("wheels").cloned());
        let mut robots = Vec::new();
        for list in document.elements_mut().filter(|one| one.name == "robots") {
            self.take(list, |reader, element| {
                if element.name != "robot" || robots.len() == limits::FIELD_ROBOTS {
                    return Err(element);
                }
                let robot = reader.robot(element, robots.len() + 1);
                robots.push(robot);
                Ok(())
            });
        }
        if !robots.iter().any(Robot::is_trik) && robots.is_empty() {
            robots.push(Robot::default());
        }
        for robot in &mut robots {
            if let Some(mut element) = in_world.clone() {
                robot.visit_place(&mut self.codec(&mut element, 1));
            }
            if let Some(mut element) = wheels.clone() {
                let default = Robot::default().wheels;
                self.codec(&mut element, 1)
                    .material(&mut robot.wheels, default);
            }
        }
        self.field.robots = robots;
    }

    fn robot(&mut self, mut element: Element<'static>, ordinal: usize) -> Robot {
        let mut robot = Robot {
            aliases: aliases(&element),
            is_old: self.field.version.is_none(),
            ..Robot::default()
        };
        self.codec(&mut element, ordinal)
            .text("id", &mut robot.id, "");
        // Older worlds keep the place with the robot's devices.
        robot.visit_place(&mut self.codec(&mut element, ordinal));
        if let Some(list) = element
            .elements_mut()
            .find(|element| element.name == "sensors")
        {
            let mut sensors = Vec::new();
            self.take(list, |reader, mut inner| {
                if inner.name != "sensor" || sensors.len() == limits::FIELD_SENSORS {
                    return Err(inner);
                }
                let mut sensor = Sensor::blank();
                sensor.visit(&mut reader.codec(&mut inner, sensors.len() + 1));
                sensor.source = inner;
                sensors.push(sensor);
                Ok(())
            });
            robot.sensors = sensors;
        }
        if let Some(wheels) = element.child("wheels") {
            for (side, wheel) in [("left", &mut robot.left), ("right", &mut robot.right)] {
                let Some(text) = wheels.attribute(side) else {
                    continue;
                };
                *wheel = port(text, Direction::Out);
                let is_named = !text.starts_with("None") && !text.starts_with("###");
                if wheel.is_none() && is_named && robot.id.starts_with("trik") {
                    let mut problem = Problem::warning(words::bad_port(text));
                    problem.place.offset = Some(wheels.start.0);
                    keep(&mut self.problems, problem);
                }
            }
        }
        robot.source = element;
        robot
    }
}

/// Other names of ports that the texts of a robot's ports have in their third part, divided by `$$$`.
fn aliases(robot: &Element<'_>) -> Vec<(String, String)> {
    let inside = |name: &str, attribute: &'static str| {
        let list = robot.child(name).into_iter().flat_map(Element::elements);
        let texts = list.filter_map(move |one| one.attribute(attribute));
        texts
            .take(limits::FIELD_SENSORS)
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let mut texts = inside("sensors", "port");
    texts.extend(inside("configurators", "port"));
    for side in ["left", "right"] {
        let wheel = robot.child("wheels").and_then(|one| one.attribute(side));
        texts.extend(wheel.map(str::to_owned));
    }
    let mut found = Vec::new();
    for text in &texts {
        let parts: Vec<&str> = text.split("###").collect();
        let [port, _, names, ..] = parts[..] else {
            continue;
        };
        let names = names.split("$$$").filter(|name| !name.is_empty());
        found.extend(names.map(|name| (name.to_owned(), port.to_owned())));
    }
    found.truncate(limits::FIELD_SENSORS);
    found
}

/// The port that a text with four parts means.
pub(super) fn port(text: &str, direction: Direction) -> Option<Port> {
    let name = text.split("###").next().unwrap_or_default();
    Port::find(Kit::V62, name, direction)
}

/// Contents of a picture, from its tag.
fn blob_of(element: &Element<'static>, path: &str) -> Blob {
    let mut text = String::new();
    for node in &element.nodes {
        match node {
            Node::Text(part) => text.push_str(part),
            Node::Element(inner) => text.push_str(&xml::write(inner, 0)),
            Node::Comment(_) => {}
        }
    }
    Blob {
        path: path.to_owned(),
        is_external: element.attribute("external") == Some("true"),
        text,
    }
}

/// The contents of images that stand in a tag beside others.
fn gather_blobs(outside: &Element<'static>, all: &mut BTreeMap<String, Blob>) {
    if let Some(blobs) = outside.child("blobs") {
        images_of(blobs, all);
    }
}

fn images_of(blobs: &Element<'static>, all: &mut BTreeMap<String, Blob>) {
    let lists = blobs.elements().filter(|one| one.name == "images");
    for image in lists.flat_map(Element::elements) {
        let id = image.attribute("imageId").unwrap_or_default();
        let path = image.attribute("path").unwrap_or_default();
        all.insert(id.to_owned(), blob_of(image, path));
    }
}

pub(super) fn add_blobs(field: &mut Field, text: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    if !text.trim().is_empty() {
        match xml::parse(text) {
            Ok(root) => {
                let root = root.into_owned();
                match root.name.as_ref() {
                    "blobs" => images_of(&root, &mut field.blobs),
                    _ => match root.child("blobs") {
                        Some(blobs) => images_of(blobs, &mut field.blobs),
                        None => images_of(&root, &mut field.blobs),
                    },
                }
            }
            Err(problem) => problems.push(problem),
        }
    }
    for image in &field.images {
        let words = match field.blobs.get(&image.image) {
            None => Some(words::no_blob(&image.image)),
            Some(blob) if blob.is_external || blob.begins_as_picture() => None,
            Some(_) => Some(words::no_contents(&image.image)),
        };
        if let Some(words) = words {
            let mut problem = Problem::warning(words);
            problem.place.object = Some(image.id.clone());
            problem.place.offset = Some(image.source.start.0);
            keep(&mut problems, problem);
        }
    }
    problems
}
