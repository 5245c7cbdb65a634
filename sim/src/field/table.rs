//! Which tags a world model has, inside which others, and which attributes each of them is asked for.
//!
//! Owns where tags stand. Attributes are those that reading asks for: a [`Codec`] that only lists them goes the same way.

use lang_text::xml::Element;

use super::attributes::{Codec, Mode, Names};
use super::items::{
    Comment, Drawn, Image, Material, Pen, Region, Robot, Sensor, Settings, Shape, Solid, SolidKind,
    Start, Stroke, Trace, Wall,
};
use crate::geometry::Point;

/// Lists of things in a world, beside that of regions, in the order in which they are read.
pub(super) const LISTS: [&str; 8] = [
    "trace",
    "walls",
    "skittles",
    "balls",
    "cubes",
    "colorFields",
    "comments",
    "images",
];

/// A tag in a world model.
#[derive(Clone, Copy)]
pub struct Kind {
    /// The tag in which it stands, and it itself, as `walls/wall`.
    pub path: &'static str,
    /// Attributes that TRIK Studio writes, and that mean nothing.
    pub idle: &'static [&'static str],
    visit: fn(&mut Codec<'_, '_>),
}

impl Kind {
    const fn new(path: &'static str, visit: fn(&mut Codec<'_, '_>)) -> Self {
        Self {
            path,
            idle: &[],
            visit,
        }
    }

    const fn idle(mut self, idle: &'static [&'static str]) -> Self {
        self.idle = idle;
        self
    }

    /// The tag in which it stands; empty for the outermost.
    pub fn outside(&self) -> &'static str {
        self.path.split_once('/').map_or("", |(outside, _)| outside)
    }

    /// The tag itself.
    pub fn tag(&self) -> &'static str {
        let inside = self.path.split_once('/');
        inside.map_or(self.path, |(_, tag)| tag)
    }

    /// The attributes that mean something.
    pub fn attributes(&self) -> Vec<String> {
        let mut names = Names::default();
        // Some are asked for only if others are there, or are not.
        for is_there in [false, true] {
            names.is_there = is_there;
            let mut element = Element::new(self.tag());
            (self.visit)(&mut Codec {
                element: &mut element,
                mode: Mode::List(&mut names),
                scale: 1.0,
                ordinal: 1,
            });
        }
        names.all
    }

    /// Whether it is a thing of one of the lists of a world, any of which may hold it.
    pub fn is_thing(&self) -> bool {
        LISTS.contains(&self.outside())
    }
}

/// All tags, the outermost first; what stands in `constraints` is another language.
pub const KINDS: &[Kind] = &[
    Kind::new("root", |codec| named(codec, &["version"])),
    Kind::new("root/world", nothing),
    Kind::new("root/robots", nothing),
    Kind::new("root/settings", |codec| {
        named(codec, &["sizeUnit"]);
        Settings::default().visit(codec);
    })
    .idle(&["gridCellSize", "enableGrid"]),
    Kind::new("root/constraints", nothing),
    Kind::new("world/background", image).idle(BACKGROUND),
    Kind::new("world/trace", nothing),
    Kind::new("world/walls", nothing),
    Kind::new("world/skittles", nothing),
    Kind::new("world/balls", nothing),
    Kind::new("world/cubes", nothing),
    Kind::new("world/colorFields", nothing),
    Kind::new("world/comments", nothing),
    Kind::new("world/images", nothing),
    Kind::new("world/regions", nothing),
    Kind::new("world/robot", |codec| Robot::default().visit_place(codec)).idle(&["id"]),
    Kind::new("world/wheels", |codec| {
        let mut made = Material::default();
        codec.material(&mut made, Material::default());
    }),
    Kind::new("trace/segment", |codec| Trace::default().visit(codec)),
    Kind::new("walls/wall", |codec| {
        Wall::default().visit(codec);
        // Of its pen.
        named(codec, &["stroke", "stroke-style"]);
    })
    .idle(&["fill", "fill-style"]),
    Kind::new("skittles/skittle", |codec| solid(SolidKind::Skittle, codec)),
    Kind::new("balls/ball", |codec| solid(SolidKind::Ball, codec)),
    Kind::new("cubes/cube", |codec| solid(SolidKind::Cube, codec)),
    Kind::new("colorFields/line", |codec| {
        drawn(Shape::Line(ZERO, ZERO), codec);
    }),
    Kind::new("colorFields/rectangle", |codec| {
        drawn(Shape::Rectangle(ZERO, ZERO), codec);
    }),
    Kind::new("colorFields/ellipse", |codec| {
        drawn(Shape::Ellipse(ZERO, ZERO), codec);
    }),
    Kind::new("colorFields/cubicBezier", |codec| {
        drawn(Shape::Curve(ZERO, ZERO, ZERO, ZERO), codec);
    }),
    Kind::new("colorFields/stylus", |codec| {
        drawn(Shape::Stylus(Vec::new()), codec);
    }),
    Kind::new("stylus/stylusLine", |codec| Stroke::default().visit(codec)),
    Kind::new("comments/comment", |codec| Comment::default().visit(codec)),
    Kind::new("images/image", image).idle(BACKGROUND),
    Kind::new("regions/region", |codec| Region::default().visit(codec)),
    Kind::new("robots/robot", |codec| {
        named(codec, &["id"]);
        Robot::default().visit_place(codec);
    }),
    Kind::new("robot/startPosition", |codec| {
        let mut start = Start::default();
        codec.pair(["x", "y"], &mut start.at, ZERO);
        codec.plain("direction", &mut start.direction, 0.0);
    })
    .idle(&["id"]),
    Kind::new("robot/sensors", nothing),
    Kind::new("sensors/sensor", |codec| Sensor::blank().visit(codec)),
    Kind::new("robot/wheels", |codec| named(codec, &["left", "right"])),
    Kind::new("robot/configurators", nothing),
];

const ZERO: Point = Point { x: 0.0, y: 0.0 };
const BACKGROUND: &[&str] = &["id"];

fn nothing(_: &mut Codec<'_, '_>) {}

/// Attributes that the reader of the tag asks for itself.
fn named(codec: &mut Codec<'_, '_>, names: &[&str]) {
    for name in names {
        codec.attribute(name);
    }
}

fn solid(kind: SolidKind, codec: &mut Codec<'_, '_>) {
    Solid::new(kind, ZERO).visit(codec);
}

fn drawn(shape: Shape, codec: &mut Codec<'_, '_>) {
    Drawn::new(shape, Pen::default()).visit(codec);
}

fn image(codec: &mut Codec<'_, '_>) {
    Image::default().visit(codec);
    // Old versions keep the contents inside.
    named(codec, &["path", "external"]);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::SensorKind;
    use std::collections::BTreeSet;

    /// The names in the first cells of the rows of all tables in a text.
    fn first_cells(text: &str) -> Vec<String> {
        let rows = text.lines().filter(|line| line.starts_with("| `"));
        let cells = rows.filter_map(|row| row.split('|').nth(1));
        cells
            .flat_map(|cell| cell.split('`').skip(1).step_by(2))
            .map(str::to_owned)
            .collect()
    }

    #[test]
    fn the_page_of_worlds_has_every_tag_attribute_and_type_of_sensor_and_no_other() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/teacher/world.md");
        let text = std::fs::read_to_string(path).expect(path);
        let mut told: BTreeSet<String> = BTreeSet::new();
        for section in text.split("\n### ").skip(1) {
            let (heading, body) = section.split_once('\n').unwrap_or((section, ""));
            let body = body.split("\n## ").next().unwrap_or_default();
            let paths: Vec<&str> = heading.split('`').skip(1).step_by(2).collect();
            assert!(!paths.is_empty(), "no tag in '{heading}'");
            for path in paths {
                let kind = KINDS.iter().find(|kind| kind.path == path);
                let kind = kind.unwrap_or_else(|| panic!("there is no {path}"));
                let (mut there, mut wanted) = (first_cells(body), kind.attributes());
                there.sort();
                wanted.sort();
                assert_eq!(there, wanted, "attributes of {path}");
                assert!(told.insert(path.to_owned()), "{path} twice");
            }
        }
        // What has no attributes has one sentence for all.
        for kind in KINDS {
            let is_bare = kind.attributes().is_empty();
            let is_named = text.contains(&format!("`{}`", kind.tag()));
            assert!(
                told.contains(kind.path) || is_bare && is_named,
                "{}",
                kind.path
            );
        }
        let mut sections = text.split("\n## ");
        let sensors = sections.find(|part| part.starts_with("Types of sensors"));
        let told: BTreeSet<String> = first_cells(sensors.expect("a section"))
            .into_iter()
            .collect();
        let known = SensorKind::TYPES.iter().map(|(name, _)| (*name).to_owned());
        assert_eq!(told, known.collect());
    }

    #[test]
    fn every_tag_is_known_once() {
        let paths: BTreeSet<&str> = KINDS.iter().map(|kind| kind.path).collect();
        assert_eq!(paths.len(), KINDS.len());
    }
}
