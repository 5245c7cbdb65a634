//! Which attributes each kind of thing has.
//!
//! Owns the lists, each of which serves for reading and writing. Knows no containers.

use lang_diagram::ports::Direction;
use lang_text::xml::Element;

use super::attributes::Codec;
use super::items::{
    Comment, Drawn, Image, ROBOT_SIZE, Region, Robot, Sensor, SensorKind, Settings, Shape, Solid,
    SolidKind, Start, Stroke, Trace, WALL_WIDTH, Wall,
};
use super::read::port;
use crate::geometry::{Point, point};

impl Settings {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.flag("realisticPhysics", &mut self.realistic_physics, false);
        codec.flag("realisticSensors", &mut self.realistic_sensors, false);
        codec.flag("realisticMotors", &mut self.realistic_motors, false);
        codec.text("backgroundColor", &mut self.background, "");
    }
}

impl Wall {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.text("id", &mut self.id, "");
        codec.point("begin", &mut self.begin, Point::default());
        codec.point("end", &mut self.end, Point::default());
        // A width of nothing is the usual one.
        let usual = |width: f64| {
            if width == 0.0 {
                WALL_WIDTH
            } else {
                width.abs()
            }
        };
        codec.length_as("stroke-width", &mut self.width, usual);
        codec.material(&mut self.material, Self::default().material);
    }
}

impl Solid {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.text("id", &mut self.id, "");
        codec.plain("rotation", &mut self.rotation, 0.0);
        codec.length(self.kind.size_name(), &mut self.size, self.kind.size());
        if codec.is_reading() {
            self.at = self.place(codec);
        } else if self.place(codec) != self.at {
            codec.element.take("begin");
            codec.pair(["x", "y"], &mut self.at, Point::default());
        }
        codec.pair(["markerX", "markerY"], &mut self.start, Point::default());
        codec.plain("startRotation", &mut self.start_rotation, 0.0);
        codec.material(&mut self.material, self.kind.material());
    }

    /// Where the text puts the centre: there, or beside the corner that it names.
    fn place(&self, codec: &mut Codec<'_, '_>) -> Point {
        let mut read = codec.reading();
        let mut at = Point::default();
        if !read.has("begin") {
            read.pair(["x", "y"], &mut at, Point::default());
            return at;
        }
        read.point("begin", &mut at, Point::default());
        let half = self.size / 2.0;
        let radians = match self.kind {
            SolidKind::Cube => self.rotation.to_radians(),
            SolidKind::Skittle | SolidKind::Ball => 0.0,
        };
        let (sin, cos) = libm::sincos(radians);
        point(at.x + half * (cos - sin), at.y + half * (cos + sin))
    }
}

impl Drawn {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        let none = Point::default();
        codec.text("id", &mut self.id, "");
        match &mut self.shape {
            Shape::Line(begin, end) | Shape::Rectangle(begin, end) | Shape::Ellipse(begin, end) => {
                codec.point("begin", begin, none);
                codec.point("end", end, none);
            }
            Shape::Curve(begin, first, second, end) => {
                codec.point("begin", begin, none);
                codec.point("cp1", first, none);
                codec.point("cp2", second, none);
                codec.point("end", end, none);
            }
            Shape::Stylus(_) => {}
        }
        codec.pen(&mut self.pen);
    }
}

impl Stroke {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.point("begin", &mut self.begin, Point::default());
        codec.point("end", &mut self.end, Point::default());
        codec.pen(&mut self.pen);
    }
}

impl Default for Image {
    fn default() -> Self {
        Self {
            id: String::new(),
            image: String::new(),
            at: Point::default(),
            size: Point::default(),
            is_background: false,
            source: Element::new("image"),
        }
    }
}

impl Image {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.text("id", &mut self.id, "");
        codec.text("imageId", &mut self.image, "");
        if codec.has("backgroundRect") {
            codec.rectangle("backgroundRect", &mut self.at, &mut self.size);
            self.is_background = true;
            return;
        }
        let is_old = codec.element.name == "background";
        codec.flag("isBackground", &mut self.is_background, is_old);
        // The corner is that of `rect`, moved by `position`.
        let mut moved = Point::default();
        if codec.is_reading() {
            codec.point("position", &mut moved, Point::default());
            codec.rectangle("rect", &mut self.at, &mut self.size);
            self.at = point(self.at.x + moved.x, self.at.y + moved.y);
        } else {
            let mut there = Self::default();
            there.visit(&mut codec.reading());
            if (there.at, there.size) != (self.at, self.size) {
                codec.point("position", &mut moved, Point::default());
                codec.rectangle("rect", &mut self.at, &mut self.size);
            }
        }
    }
}

impl Region {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        let default = Self::default();
        codec.text("id", &mut self.id, "");
        codec.text("type", &mut self.kind, &default.kind);
        codec.text("boundItem", &mut self.bound, "");
        // The original takes numbers in pairs or not at all.
        codec.both(["x", "y"], &mut self.at, default.at);
        codec.both(["width", "height"], &mut self.size, default.size);
        codec.both(["textX", "textY"], &mut self.text_at, default.text_at);
        codec.flag("filled", &mut self.filled, default.filled);
        codec.flag("visible", &mut self.visible, false);
        if codec.is_reading() {
            // Only a whole number of units counts, and of pixels too.
            let whole = codec.attribute("stroke");
            let whole: i32 = whole.and_then(|text| text.trim().parse().ok()).unwrap_or(0);
            self.ring = (f64::from(whole.max(0)) * codec.scale).trunc();
        }
        codec.text("color", &mut self.colour, &default.colour);
        codec.text("text", &mut self.text, "");
    }

    /// Whether it takes its place from a drawn thing.
    pub fn is_bound(&self) -> bool {
        self.kind.eq_ignore_ascii_case("bound")
    }

    /// Whether it is an ellipse.
    pub fn is_ellipse(&self) -> bool {
        self.kind.eq_ignore_ascii_case("ellipse")
    }
}

impl Default for Comment {
    fn default() -> Self {
        Self {
            id: String::new(),
            begin: Point::default(),
            end: Point::default(),
            text: String::new(),
            source: Element::new("comment"),
        }
    }
}

impl Comment {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.text("id", &mut self.id, "");
        codec.point("begin", &mut self.begin, Point::default());
        codec.point("end", &mut self.end, Point::default());
        codec.text("text", &mut self.text, "");
    }
}

impl Default for Trace {
    fn default() -> Self {
        Self {
            begin: Point::default(),
            end: Point::default(),
            colour: String::new(),
            width: 0.0,
            source: Element::new("segment"),
        }
    }
}

impl Trace {
    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.pair(["x1", "y1"], &mut self.begin, Point::default());
        codec.pair(["x2", "y2"], &mut self.end, Point::default());
        codec.text("color", &mut self.colour, "");
        codec.length("width", &mut self.width, 0.0);
    }
}

impl Sensor {
    pub(super) fn blank() -> Self {
        Self {
            port: None,
            kind: SensorKind::Other,
            type_name: String::new(),
            at: Point::default(),
            direction: 0.0,
            source: Element::new("sensor"),
        }
    }

    pub(super) fn visit(&mut self, codec: &mut Codec<'_, '_>) {
        codec.text("type", &mut self.type_name, "");
        codec.point("position", &mut self.at, Point::default());
        codec.plain("direction", &mut self.direction, 0.0);
        if codec.is_reading() {
            let text = codec.attribute("port").unwrap_or_default();
            // A port has exactly four parts; another text is none.
            let is_whole = text.split("###").count() == 4;
            self.port = is_whole.then(|| port(text, Direction::In)).flatten();
            self.kind = SensorKind::named(&self.type_name);
        }
    }
}

impl SensorKind {
    /// Types of sensors, without what stands before their names, and what they are.
    pub const TYPES: [(&'static str, Self); 13] = [
        ("TrikInfraredSensor", Self::Infrared),
        ("TrikSonarSensor", Self::Sonar),
        ("TrikLightSensor", Self::Light),
        ("LightSensor", Self::Light),
        ("TrikTouchSensor", Self::Touch),
        ("TouchSensor", Self::Touch),
        ("TrikVideoCamera", Self::Camera),
        ("TrikLineSensor", Self::Camera),
        ("TrikColorSensor", Self::Camera),
        ("TrikObjectSensor", Self::Camera),
        ("TrikLidarSensor", Self::Lidar),
        ("LidarSensor", Self::Lidar),
        ("TrikLidar", Self::Lidar),
    ];

    /// The kind with a type's name, as `trik::robotModel::parts::TrikTouchSensor`.
    pub fn named(name: &str) -> Self {
        let name = name.rsplit("::").next().unwrap_or(name);
        let found = Self::TYPES.iter().find(|(known, _)| *known == name);
        found.map_or(Self::Other, |(_, kind)| *kind)
    }
}

impl Robot {
    /// Where it stands and what it is made of: in `world/robot`, or in its own tag in older worlds.
    pub(super) fn visit_place(&mut self, codec: &mut Codec<'_, '_>) {
        if !codec.is_reading() || codec.has("position") {
            codec.point("position", &mut self.position, Point::default());
        }
        if !codec.is_reading() || codec.has("direction") {
            codec.plain("direction", &mut self.direction, 0.0);
        }
        let default = Self::default();
        codec.length("width", &mut self.size.x, default.size.x);
        codec.length("height", &mut self.size.y, default.size.y);
        codec.material(&mut self.material, default.material);
        let Some(at) = codec.element.nodes.iter().position(
            |node| matches!(node, lang_text::xml::Node::Element(one) if one.name == "startPosition"),
        ) else {
            return;
        };
        let mut node = codec.element.nodes.remove(at);
        if let lang_text::xml::Node::Element(element) = &mut node {
            let mut start = self.start.clone().unwrap_or_default();
            let mut inner = codec.inside(element);
            let half = ROBOT_SIZE / 2.0;
            inner.pair(["x", "y"], &mut start.at, point(half, half));
            inner.plain("direction", &mut start.direction, 0.0);
            if codec.is_reading() {
                self.start = Some(start);
            }
        }
        codec.element.nodes.insert(at, node);
    }
}

impl Start {
    /// A marker for the centre of a robot.
    pub fn new(at: Point, direction: f64) -> Self {
        Self { at, direction }
    }
}
