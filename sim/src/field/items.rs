//! What is on a field, as plain data: one type for each kind of thing.
//!
//! Owns the types and the original's defaults. Knows no text and no physics.

use lang_diagram::ports::Port;
use lang_diagram::stand_in::PIXELS_IN_CM;
use lang_text::xml::Element;

use crate::geometry::{Point, point};

/// Unit of the numbers in a text.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Unit {
    /// Pixels of the scene.
    #[default]
    Pixels,
    /// Centimetres.
    Centimetres,
    /// Millimetres.
    Millimetres,
    /// Metres.
    Metres,
}

impl Unit {
    /// Pixels in one of it.
    pub fn pixels(self) -> f64 {
        match self {
            Self::Pixels => 1.0,
            Self::Centimetres => PIXELS_IN_CM,
            // The original has a tenth in 32 bits.
            Self::Millimetres => PIXELS_IN_CM * f64::from(0.1f32),
            Self::Metres => PIXELS_IN_CM * 100.0,
        }
    }
}

/// How a field is simulated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Masses and friction instead of ideal motion.
    pub realistic_physics: bool,
    /// Noise of sensors.
    pub realistic_sensors: bool,
    /// Noise of motors.
    pub realistic_motors: bool,
    /// Colour under everything; empty: white.
    pub background: String,
}

/// What a teacher has locked. It stands in the project, not in the world model.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Locks {
    /// Walls, colours, regions.
    pub world: bool,
    /// Which sensors there are and where.
    pub sensors: bool,
    /// Where the robot begins.
    pub robot_position: bool,
    /// Ports of the robot.
    pub robot_configuration: bool,
    /// The settings of the simulation.
    pub settings: bool,
}

impl Locks {
    /// The locks among the keys of a project.
    pub fn of(meta: &std::collections::BTreeMap<String, String>) -> Self {
        let is_on = |key: &str| {
            meta.get(key)
                .is_some_and(|value| value.eq_ignore_ascii_case("true"))
        };
        Self {
            world: is_on("twoDModelWorldReadOnly"),
            sensors: is_on("twoDModelSensorsReadOnly"),
            robot_position: is_on("twoDModelRobotPositionReadOnly"),
            robot_configuration: is_on("twoDModelRobotConfigurationReadOnly"),
            settings: is_on("twoDModelSimulationSettingsReadOnly"),
        }
    }
}

/// What a thing is made of. Only realistic physics asks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Material {
    /// Kilograms, by the original's account; 0 stands for ever.
    pub mass: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// How much of the speed comes back.
    pub restitution: f64,
    /// How fast turning ends.
    pub angular_damping: f64,
    /// How fast moving ends.
    pub linear_damping: f64,
}

/// A wall: a straight bar without round ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Its name in rules; may be empty.
    pub id: String,
    /// One end, in the middle of the bar.
    pub begin: Point,
    /// The other end.
    pub end: Point,
    /// Across the bar.
    pub width: f64,
    /// What it is made of.
    pub material: Material,
    pub(crate) source: Element<'static>,
}

/// Width of a wall that does not say it.
pub(super) const WALL_WIDTH: f64 = 10.0;

impl Wall {
    /// A wall as the editor makes it.
    pub fn new(begin: Point, end: Point) -> Self {
        Self {
            begin,
            end,
            ..Self::default()
        }
    }
}

impl Wall {
    /// The pen around it, if it has one.
    pub fn pen(&self) -> Option<Pen> {
        let text = |name| self.source.attribute(name).unwrap_or_default();
        let width: f64 = text("stroke-width").trim().parse().unwrap_or(0.0);
        let pen = Pen {
            colour: text("stroke").to_owned(),
            width: self.width,
            style: text("stroke-style").to_owned(),
            ..Pen::default()
        };
        (width > 0.0 && pen.style != "none").then_some(pen)
    }
}

impl Default for Wall {
    fn default() -> Self {
        Self {
            id: String::new(),
            begin: Point::default(),
            end: Point::default(),
            width: WALL_WIDTH,
            material: Material {
                friction: 1.0,
                restitution: 0.8,
                ..Material::default()
            },
            source: Element::new("wall"),
        }
    }
}

/// Kinds of things that a robot can push.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum SolidKind {
    /// A can.
    Skittle,
    /// A ball.
    Ball,
    /// A cube.
    Cube,
}

impl SolidKind {
    /// All of them, in the order in which a text has them.
    pub const ALL: [Self; 3] = [Self::Skittle, Self::Ball, Self::Cube];

    /// Its tag.
    pub fn tag(self) -> &'static str {
        match self {
            Self::Skittle => "skittle",
            Self::Ball => "ball",
            Self::Cube => "cube",
        }
    }

    pub(super) fn size(self) -> f64 {
        match self {
            Self::Skittle => 20.0,
            Self::Ball => 30.0,
            Self::Cube => 4.0 * PIXELS_IN_CM,
        }
    }

    pub(super) fn size_name(self) -> &'static str {
        match self {
            Self::Skittle | Self::Ball => "diameter",
            Self::Cube => "edgeSize",
        }
    }

    pub(super) fn material(self) -> Material {
        let (mass, friction, damping) = match self {
            Self::Skittle => (0.05, 0.2, 6.0),
            Self::Ball => (0.015, 1.0, 0.09),
            Self::Cube => (0.1, 0.3, 6.0),
        };
        Material {
            mass,
            friction,
            restitution: 0.8,
            angular_damping: damping,
            linear_damping: damping,
        }
    }
}

/// A thing that a robot can push.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its name in rules; may be empty.
    pub id: String,
    /// What it is.
    pub kind: SolidKind,
    /// Its centre.
    pub at: Point,
    /// Degrees clockwise.
    pub rotation: f64,
    /// Where its centre goes when the editor puts things back.
    pub start: Point,
    /// The rotation that it gets there.
    pub start_rotation: f64,
    /// Diameter or edge.
    pub size: f64,
    /// What it is made of.
    pub material: Material,
    pub(crate) source: Element<'static>,
}

impl Solid {
    /// A thing as the editor makes it.
    pub fn new(kind: SolidKind, at: Point) -> Self {
        Self {
            id: String::new(),
            kind,
            at,
            rotation: 0.0,
            start: at,
            start_rotation: 0.0,
            size: kind.size(),
            material: kind.material(),
            source: Element::new(kind.tag()),
        }
    }
}

/// A pen, and the brush that belongs to it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pen {
    /// Colour of the line, `#rrggbb`, `#aarrggbb` or a name; empty: black.
    pub colour: String,
    /// Across the line.
    pub width: f64,
    /// `solid`, `dot`, `dash`, `dashdot`, `dashdotdot` or `none`; empty: solid.
    pub style: String,
    /// Colour inside.
    pub fill: String,
    /// `solid` or `none`; empty: none.
    pub fill_style: String,
}

/// One straight piece of a drawn line.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// One end.
    pub begin: Point,
    /// The other end.
    pub end: Point,
    /// Its own pen, which the original writes and does not ask.
    pub pen: Pen,
    pub(crate) source: Element<'static>,
}

impl Default for Stroke {
    fn default() -> Self {
        Self {
            begin: Point::default(),
            end: Point::default(),
            pen: Pen::default(),
            source: Element::new("stylusLine"),
        }
    }
}

/// What a drawn thing looks like.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A straight line between two points.
    Line(Point, Point),
    /// A rectangle by two opposite corners.
    Rectangle(Point, Point),
    /// An ellipse in such a rectangle.
    Ellipse(Point, Point),
    /// A curve: begin, both control points, end.
    Curve(Point, Point, Point, Point),
    /// Drawn by hand.
    Stylus(Vec<Stroke>),
}

/// Something drawn on the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Its name in rules; may be empty.
    pub id: String,
    /// Where and what.
    pub shape: Shape,
    /// In which colours.
    pub pen: Pen,
    pub(crate) source: Element<'static>,
}

impl Drawn {
    /// A drawn thing.
    pub fn new(shape: Shape, pen: Pen) -> Self {
        let tag = match shape {
            Shape::Line(..) => "line",
            Shape::Rectangle(..) => "rectangle",
            Shape::Ellipse(..) => "ellipse",
            Shape::Curve(..) => "cubicBezier",
            Shape::Stylus(..) => "stylus",
        };
        Self {
            id: String::new(),
            shape,
            pen,
            source: Element::new(tag),
        }
    }
}

/// A picture on the floor.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Its name in rules; may be empty.
    pub id: String,
    /// Which of [`super::Field::blobs`] it shows.
    pub image: String,
    /// Upper left corner.
    pub at: Point,
    /// Width and height.
    pub size: Point,
    /// Whether it lies under the others.
    pub is_background: bool,
    pub(crate) source: Element<'static>,
}

/// Kinds of regions.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Its name in rules.
    pub id: String,
    /// `ellipse`, `rectangle` or `bound`.
    pub kind: String,
    /// Upper left corner of the rectangle around it.
    pub at: Point,
    /// Width and height; negative ones are as they were written.
    pub size: Point,
    /// Of a region of kind `bound`: the width of the ring along the outline that it is; 0: it is no ring.
    pub ring: f64,
    /// Of a region of kind `bound`: the drawn thing whose place it takes.
    pub bound: String,
    /// Whether it is shown hatched.
    pub filled: bool,
    /// Whether it is shown.
    pub visible: bool,
    /// Its colour.
    pub colour: String,
    /// Its caption.
    pub text: String,
    /// Where the caption is, from the region's corner.
    pub text_at: Point,
    pub(crate) source: Element<'static>,
}

impl Default for Region {
    fn default() -> Self {
        Self {
            id: String::new(),
            kind: "ellipse".to_owned(),
            at: Point::default(),
            size: point(200.0, 200.0),
            ring: 0.0,
            bound: String::new(),
            filled: true,
            visible: true,
            colour: "#87cefa".to_owned(),
            text: String::new(),
            text_at: Point::default(),
            source: Element::new("region"),
        }
    }
}

/// A remark for people.
#[derive(Clone, Debug, PartialEq)]
pub struct Comment {
    /// Its name in rules; may be empty.
    pub id: String,
    /// One corner.
    pub begin: Point,
    /// The opposite corner.
    pub end: Point,
    /// HTML.
    pub text: String,
    pub(crate) source: Element<'static>,
}

/// A stroke of a marker.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// One end.
    pub begin: Point,
    /// The other end.
    pub end: Point,
    /// Its colour.
    pub colour: String,
    /// Across the line.
    pub width: f64,
    pub(crate) source: Element<'static>,
}

/// Kinds of sensors that stand on a robot.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum SensorKind {
    /// Distance by infrared light, to 80 cm.
    Infrared,
    /// Distance by sound, to 300 cm.
    Sonar,
    /// Brightness of the floor.
    Light,
    /// A button that touches.
    Touch,
    /// The camera: line, colour and object sensors.
    Camera,
    /// Distances all around, to 400 cm.
    Lidar,
    /// Something that the simulator does not show, as a motor.
    Other,
}

/// A sensor of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    /// Where it is plugged in; nothing if no such port is known.
    pub port: Option<Port>,
    /// What it is.
    pub kind: SensorKind,
    /// Its type as written.
    pub type_name: String,
    /// Its centre in the robot's own coordinates, from the upper left corner.
    pub at: Point,
    /// Degrees clockwise from straight ahead.
    pub direction: f64,
    pub(crate) source: Element<'static>,
}

impl Sensor {
    /// A sensor where the original puts one that a program needs: half a robot's length ahead.
    pub fn new(port: Port, kind: SensorKind) -> Self {
        let type_name = match kind {
            SensorKind::Infrared => "TrikInfraredSensor",
            SensorKind::Sonar => "TrikSonarSensor",
            SensorKind::Light => "TrikLightSensor",
            SensorKind::Touch => "TrikTouchSensor",
            SensorKind::Camera => "TrikVideoCamera",
            SensorKind::Lidar => "TrikLidarSensor",
            SensorKind::Other => "",
        };
        let variable = port.variable().unwrap_or_default();
        let source = Element::new("sensor")
            .with("port", format!("{}###input######{variable}", port.name()))
            .with("type", format!("trik::robotModel::parts::{type_name}"));
        Self {
            port: Some(port),
            kind,
            type_name: format!("trik::robotModel::parts::{type_name}"),
            at: point(75.0, 25.0),
            direction: 0.0,
            source,
        }
    }
}

/// Where a robot is put back to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Centre of the robot.
    pub at: Point,
    /// Degrees clockwise.
    pub direction: f64,
}

/// A robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Its kit, as `trikKitRobot`.
    pub id: String,
    /// Upper left corner of the unturned robot.
    pub position: Point,
    /// Degrees clockwise; 0 looks to the right.
    pub direction: f64,
    /// Where it is put back to.
    pub start: Option<Start>,
    /// Motor of the left wheel.
    pub left: Option<Port>,
    /// Motor of the right wheel.
    pub right: Option<Port>,
    /// Its sensors.
    pub sensors: Vec<Sensor>,
    /// Whether it stands in a text of an old version, where robots of both kits of TRIK have names of their own.
    pub is_old: bool,
    /// Other names of its ports in rules, and the ports.
    pub aliases: Vec<(String, String)>,
    /// Length and width.
    pub size: Point,
    /// What its body is made of.
    pub material: Material,
    /// What its wheels are made of.
    pub wheels: Material,
    pub(crate) source: Element<'static>,
}

/// Across the robot of TRIK, in both directions.
pub const ROBOT_SIZE: f64 = 50.0;

impl Robot {
    /// Whether it is the robot of TRIK.
    pub fn is_trik(&self) -> bool {
        self.id == "trikKitRobot" || (self.is_old && self.id.starts_with("trik"))
    }

    /// The sensor on a port.
    pub fn sensor(&self, port: Port) -> Option<&Sensor> {
        self.sensors
            .iter()
            .rev()
            .find(|sensor| sensor.port == Some(port))
    }

    /// Onto its start marker, if it has one.
    pub fn to_start(&mut self) {
        if let Some(start) = &self.start {
            let half = point(self.size.x / 2.0, self.size.y / 2.0);
            self.position = start.at.from(half);
            self.direction = start.direction;
        }
    }
}

impl Default for Robot {
    fn default() -> Self {
        Self {
            id: "trikKitRobot".to_owned(),
            position: Point::default(),
            direction: 0.0,
            start: None,
            left: Port::named("M4"),
            right: Port::named("M3"),
            sensors: Vec::new(),
            is_old: false,
            aliases: Vec::new(),
            size: point(ROBOT_SIZE, ROBOT_SIZE),
            material: Material {
                mass: 1.05,
                friction: 0.3,
                restitution: 0.6,
                angular_damping: 1.0,
                linear_damping: 1.0,
            },
            wheels: Material {
                mass: 0.1,
                friction: 1.0,
                restitution: 0.5,
                ..Material::default()
            },
            source: Element::new("robot"),
        }
    }
}
