//! An arena as the rules of a task see it: objects by name, their types and what they say.
//!
//! Owns the names of objects and their numbers; `scene/places` says where things are, `scene/set` what rules may
//! change of them, `scene/shown` what is on a display.
//! Knows no rules. Names and types are those of the original: a type is the class there.
//!
//! A number of an object is good as long as the field is not edited.

mod names;
pub(super) mod places;
mod set;
mod shown;

use lang_constraint::{Missing, Object, ObjectPoint, Rect, Scene, Unfit, Value};
use lang_diagram::ports::{Device, Port, Sort};

use crate::arena::{Arena, Robot};
use crate::field::{Drawn, Material, Region, SensorKind, Shape, SolidKind};

/// An object of an arena.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum SceneObject {
    Robot(usize),
    /// What is on a port of a robot.
    Device(usize, Port),
    /// Something that every robot has.
    Part(usize, Part),
    Wall(usize),
    Solid(usize),
    Drawn(usize),
    Region(usize),
    Trace,
}

/// What every robot has beside devices on ports.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Part {
    Display,
    Shell,
    Led,
    Marker,
    Random,
    Speaker,
    Network,
}

/// Names of parts, and their classes.
const PARTS: [(&str, Part, &str); 7] = [
    (
        "display",
        Part::Display,
        "trik::robotModel::twoD::parts::Display",
    ),
    ("shell", Part::Shell, "trik::robotModel::twoD::parts::Shell"),
    ("led", Part::Led, "trik::robotModel::twoD::parts::TwoDLed"),
    (
        "marker",
        Part::Marker,
        "twoDModel::robotModel::parts::Marker",
    ),
    (
        "random",
        Part::Random,
        "kitBase::robotModel::robotParts::Random",
    ),
    (
        "speaker",
        Part::Speaker,
        "trik::robotModel::twoD::parts::TwoDSpeaker",
    ),
    (
        "communicator",
        Part::Network,
        "trik::robotModel::twoD::parts::TwoDNetworkCommunicator",
    ),
];

/// Bits of a number that say which one; those above say what it is.
const WHICH: u32 = 24;
/// Of an object of a robot: bits that say which one of the robot's.
const OF_ROBOT: u32 = 8;

impl SceneObject {
    fn number(self) -> Option<Object> {
        let of_robot = |robot: usize, which: u8| robot << OF_ROBOT | usize::from(which);
        let (kind, which) = match self {
            Self::Robot(robot) => (0, robot),
            Self::Device(robot, port) => (1, of_robot(robot, port.index())),
            Self::Part(robot, part) => (2, of_robot(robot, part as u8)),
            Self::Wall(index) => (3, index),
            Self::Solid(index) => (4, index),
            Self::Drawn(index) => (5, index),
            Self::Region(index) => (7, index),
            Self::Trace => (9, 0),
        };
        let which = u32::try_from(which).ok()?;
        (which < 1 << WHICH).then_some(Object(kind << WHICH | which))
    }

    fn of(object: Object) -> Option<Self> {
        let which = (object.0 & ((1 << WHICH) - 1)) as usize;
        let robot = which >> OF_ROBOT;
        let of_robot = (which & ((1 << OF_ROBOT) - 1)) as u8;
        Some(match object.0 >> WHICH {
            0 => Self::Robot(which),
            1 => Self::Device(robot, Port::at(of_robot)?),
            2 => Self::Part(robot, PARTS.get(usize::from(of_robot))?.1),
            3 => Self::Wall(which),
            4 => Self::Solid(which),
            5 => Self::Drawn(which),
            7 => Self::Region(which),
            9 => Self::Trace,
            _ => return None,
        })
    }
}

/// What kind of thing an object is, for those who have to know how its facts come about.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Subject {
    /// A robot by its number, from 0.
    Robot(usize),
    /// What is on a port of a robot.
    Device(usize, Port),
    /// What every robot has, by its name in rules.
    Part(usize, &'static str),
    /// What can be pushed, or drawn by a robot.
    Moving,
    /// What nothing changes but rules.
    Still,
}

/// What kind of thing it is; nothing for a number that is none.
pub(super) fn subject(object: Object) -> Option<Subject> {
    Some(match SceneObject::of(object)? {
        SceneObject::Robot(robot) => Subject::Robot(robot),
        SceneObject::Device(robot, port) => Subject::Device(robot, port),
        SceneObject::Part(robot, part) => Subject::Part(robot, PARTS[part as usize].0),
        SceneObject::Solid(_) | SceneObject::Trace => Subject::Moving,
        SceneObject::Wall(_) | SceneObject::Drawn(_) | SceneObject::Region(_) => Subject::Still,
    })
}

/// The thing of a name.
fn named(arena: &Arena, name: &str) -> Option<SceneObject> {
    if let Some(rest) = name.strip_prefix("robot") {
        let (number, inside) = match rest.split_once('.') {
            Some((number, inside)) => (number, Some(inside)),
            None => (rest, None),
        };
        let number = number.parse::<usize>().ok();
        let index = number.and_then(|number| number.checked_sub(1));
        if let Some(robot) = index.and_then(|index| arena.robots().get(index)) {
            let index = index.unwrap_or_default();
            return match inside {
                None => Some(SceneObject::Robot(index)),
                Some(inside) => of_robot(robot, index, inside),
            };
        }
    }
    if name == "trace" {
        return Some(SceneObject::Trace);
    }
    if name.is_empty() {
        return None;
    }
    let field = arena.field();
    // A region whose drawn thing is not there is not there either.
    let is_there =
        |one: &Region| !one.is_bound() || field.drawn.iter().any(|drawn| drawn.id == one.bound);
    at(&field.regions, |one| one.id == name && is_there(one))
        .map(SceneObject::Region)
        .or_else(|| at(&field.solids, |one| one.id == name).map(SceneObject::Solid))
        .or_else(|| at(&field.walls, |one| one.id == name).map(SceneObject::Wall))
        .or_else(|| at(&field.drawn, |one| one.id == name).map(SceneObject::Drawn))
}

/// Whether rules mean a robot or its trace by a name, whatever else has it.
pub(super) fn is_taken(name: &str) -> bool {
    name == "trace" || name == "robot1"
}

fn at<T>(all: &[T], is_it: impl Fn(&T) -> bool) -> Option<usize> {
    all.iter().position(is_it)
}

/// What a robot has under a name: a part, or a device that is plugged in.
fn of_robot(robot: &Robot, index: usize, name: &str) -> Option<SceneObject> {
    let own = |name: &str| {
        if let Some((_, part, _)) = PARTS.iter().find(|(known, ..)| *known == name) {
            return Some(SceneObject::Part(index, *part));
        }
        let port = Port::all().find(|port| port.name() == long_name(name))?;
        is_plugged_in(robot, port).then_some(SceneObject::Device(index, port))
    };
    own(name).or_else(|| {
        let aliases = &robot.description().aliases;
        let (_, port) = aliases.iter().find(|(alias, _)| alias == name)?;
        own(&short_name(port))
    })
}

/// The name of a port by that in rules: ports with long names go without the word `Port` and begin small there.
fn long_name(name: &str) -> String {
    match name.chars().next().filter(char::is_ascii_lowercase) {
        Some(first) => format!("{}{}Port", first.to_ascii_uppercase(), &name[1..]),
        // As it is written with a word `Port` it is no name in rules.
        None if name.ends_with("Port") => String::new(),
        None => name.to_owned(),
    }
}

/// The other way round.
fn short_name(port: &str) -> String {
    match port
        .strip_suffix("Port")
        .and_then(|short| short.chars().next())
    {
        Some(first) => {
            let rest = &port[first.len_utf8()..port.len() - 4];
            format!("{}{rest}", first.to_ascii_lowercase())
        }
        None => port.to_owned(),
    }
}

fn is_plugged_in(robot: &Robot, port: Port) -> bool {
    match port.device() {
        Device::Motor
        | Device::Servo
        | Device::Encoder
        | Device::Button(_)
        | Device::Gyroscope
        | Device::Accelerometer => true,
        Device::Lidar => robot.sensor_of(SensorKind::Lidar).is_some(),
        Device::LineSensor | Device::ColorSensor | Device::ObjectSensor(_) => {
            robot.sensor_of(SensorKind::Camera).is_some()
        }
        Device::Gamepad(_) => robot.gamepad().is_some(),
        Device::Plugged => robot
            .sensor(port)
            .is_some_and(|sensor| sensor.kind != SensorKind::Other),
    }
}

/// The class of what is on a port.
fn class_of_device(robot: &Robot, port: Port) -> Option<&'static str> {
    Some(match port.device() {
        Device::Motor | Device::Servo => "twoDModel::robotModel::parts::Motor",
        Device::Encoder => "twoDModel::robotModel::parts::EncoderSensor",
        Device::Button(_) => "twoDModel::robotModel::parts::Button",
        Device::Gyroscope => "trik::robotModel::twoD::parts::GyroscopeSensor",
        Device::Accelerometer => "twoDModel::robotModel::parts::Accelerometer",
        Device::Lidar => "twoDModel::robotModel::parts::Lidar",
        Device::LineSensor => "trik::robotModel::twoD::parts::LineSensor",
        Device::ColorSensor => "trik::robotModel::twoD::parts::ColorSensor",
        Device::ObjectSensor(_) => "trik::robotModel::twoD::parts::ObjectSensor",
        // The gamepad has a class only where a world puts a sensor at one of its ports.
        Device::Plugged | Device::Gamepad(_) => match robot.sensor(port)?.kind {
            SensorKind::Infrared | SensorKind::Sonar => "twoDModel::robotModel::parts::RangeSensor",
            SensorKind::Light => "trik::robotModel::twoD::parts::TwoDLightSensor",
            SensorKind::Touch => "twoDModel::robotModel::parts::TouchSensor",
            SensorKind::Camera => "trik::robotModel::twoD::parts::LineSensor",
            SensorKind::Lidar => "twoDModel::robotModel::parts::Lidar",
            SensorKind::Other => return None,
        },
    })
}

fn class_of(arena: &Arena, thing: SceneObject) -> Option<&'static str> {
    let field = arena.field();
    Some(match thing {
        SceneObject::Robot(_) => "twoDModel::model::RobotModel",
        SceneObject::Device(robot, port) => class_of_device(arena.robots().get(robot)?, port)?,
        SceneObject::Part(_, part) => PARTS[part as usize].2,
        SceneObject::Wall(_) => "twoDModel::items::WallItem",
        SceneObject::Solid(index) => match field.solids.get(index)?.kind {
            SolidKind::Skittle => "twoDModel::items::SkittleItem",
            SolidKind::Ball => "twoDModel::items::BallItem",
            SolidKind::Cube => "twoDModel::items::CubeItem",
        },
        SceneObject::Drawn(index) => match field.drawn.get(index)?.shape {
            Shape::Line(..) => "twoDModel::items::LineItem",
            Shape::Rectangle(..) => "twoDModel::items::RectangleItem",
            Shape::Ellipse(..) => "twoDModel::items::EllipseItem",
            Shape::Curve(..) => "twoDModel::items::CurveItem",
            Shape::Stylus(..) => "twoDModel::items::StylusItem",
        },
        SceneObject::Region(index) => match field.regions.get(index)? {
            region if region.is_ellipse() => "twoDModel::items::EllipseRegion",
            region if region.is_bound() => "twoDModel::items::BoundRegion",
            _ => "twoDModel::items::RectangularRegion",
        },
        SceneObject::Trace => "utils::ObjectsSetBase",
    })
}

impl Scene for Arena {
    fn find(&mut self, name: &str) -> Option<Object> {
        let thing = named(self, name)?;
        if let SceneObject::Device(robot, port) = thing
            && let Some(robot) = self.robot_mut(robot)
        {
            // What a rule may ask for is read every now and then from here on.
            robot.readings.watch(port);
        }
        thing.number()
    }

    fn type_of(&mut self, object: Object) -> Option<&'static str> {
        let class = class_of(self, SceneObject::of(object)?)?;
        debug_assert!(names::CLASSES.contains(&class), "{class}");
        Some(class)
    }

    fn property(&mut self, object: Object, chain: &[Box<str>]) -> Result<Value, Missing> {
        let thing = SceneObject::of(object).ok_or(Missing::Type(0))?;
        let Some((name, rest)) = chain.split_first() else {
            return Ok(Value::Object(object));
        };
        // How many figures there are is asked in each tick, and needs no list of them.
        if let (SceneObject::Part(robot, Part::Display), [last]) = (thing, rest)
            && let Some(robot) = self.robots().get(robot)
            && let Some(count) = shown::count(&robot.shown().screen, name, last)
        {
            return Ok(count);
        }
        let value = property(self, thing, name).ok_or(Missing::Property(0))?;
        value.descend(chain, 1)
    }

    fn set_property(&mut self, object: Object, property: &str, value: &Value) -> bool {
        let thing = SceneObject::of(object);
        thing.is_some_and(|thing| set::set(self, thing, property, value))
    }

    fn set_within(
        &mut self,
        object: Object,
        chain: &[Box<str>],
        property: &str,
        value: &Value,
    ) -> bool {
        let (Some(SceneObject::Part(robot, Part::Display)), [list, which]) =
            (SceneObject::of(object), chain)
        else {
            return false;
        };
        self.robot_mut(robot).is_some_and(|robot| {
            shown::set(&mut robot.shown.screen, (list, which), property, value)
        })
    }

    fn is_inside(
        &mut self,
        object: Object,
        region: Object,
        point: ObjectPoint,
    ) -> Result<bool, Unfit> {
        let Some(SceneObject::Region(region)) = SceneObject::of(region) else {
            return Err(Unfit::NoRegion);
        };
        let thing = SceneObject::of(object).ok_or(Unfit::NoPlace)?;
        places::is_inside(self, thing, region, point)
    }

    fn distance(&mut self, object: Object, region: Object, point: ObjectPoint) -> Option<f64> {
        let Some(SceneObject::Region(region)) = SceneObject::of(region) else {
            return None;
        };
        places::distance(self, SceneObject::of(object)?, region, point)
    }

    fn bounding_rect(&mut self, object: Object) -> Option<Rect> {
        let thing = SceneObject::of(object)?;
        if thing == SceneObject::Trace {
            return places::around_trace(self);
        }
        // Only the trace has a rectangle of its own there; of others where they are is taken.
        Some(Rect {
            x: property(self, thing, "x")?.to_int(),
            y: property(self, thing, "y")?.to_int(),
            width: 1,
            height: 1,
        })
    }
}

/// A property of a thing; nothing if it has none of this name.
fn property(arena: &Arena, thing: SceneObject, name: &str) -> Option<Value> {
    let found = known_property(arena, thing, name);
    debug_assert!(
        found.is_none() || names::PROPERTIES.contains(&name),
        "{name}"
    );
    found
}

fn known_property(arena: &Arena, thing: SceneObject, name: &str) -> Option<Value> {
    match thing {
        SceneObject::Robot(index) => {
            let robot = arena.robots().get(index)?;
            let pose = robot.pose();
            Some(match name {
                "x" => Value::Double(pose.x),
                "y" => Value::Double(pose.y),
                "rotation" => Value::Double(pose.degrees),
                "isRiding" => Value::Bool(robot.is_riding()),
                _ => return None,
            })
        }
        SceneObject::Device(index, port) => device(arena, index, port, name),
        SceneObject::Part(index, part) => of_part(arena.robots().get(index)?, part, name),
        SceneObject::Trace => match name {
            "size" => Some(count(arena.trace().len())),
            "isEmpty" => Some(Value::Bool(arena.trace().is_empty())),
            _ => None,
        },
        SceneObject::Wall(_)
        | SceneObject::Solid(_)
        | SceneObject::Drawn(_)
        | SceneObject::Region(_) => of_item(arena, thing, name),
    }
}

fn device(arena: &Arena, index: usize, port: Port, name: &str) -> Option<Value> {
    let robot = arena.robots().get(index)?;
    match (port.sort(), name) {
        (Sort::Motor, "power") => Some(Value::Int(robot.power(port))),
        (Sort::Servo, "power") => Some(Value::Int(robot.servo(port))),
        (Sort::Motor | Sort::Servo, _) => None,
        (Sort::Encoder | Sort::Scalar | Sort::Button(_) | Sort::Vector, "locked") => {
            Some(Value::Bool(robot.readings.is_locked(port)))
        }
        (Sort::Vector, "value") => Some(Value::Opaque),
        (Sort::Encoder | Sort::Scalar | Sort::Button(_), "value") => {
            Some(Value::Int(robot.readings.last(port)))
        }
        (Sort::Encoder | Sort::Scalar | Sort::Button(_) | Sort::Vector, _) => None,
    }
}

fn of_part(robot: &Robot, part: Part, name: &str) -> Option<Value> {
    let shown = robot.shown();
    match (part, name) {
        (Part::Display, _) => shown::property(&shown.screen, name),
        (Part::Shell, "lastPhrase") => {
            let phrase = shown.last_phrase.as_deref();
            Some(phrase.map_or(Value::NoText, Value::text))
        }
        (Part::Led, "color") => {
            let alpha = u32::from(shown.led_alpha) << 24;
            Some(Value::Colour(alpha | shown.led.number()))
        }
        (Part::Marker, "isDown") => Some(Value::Bool(robot.marker().is_down)),
        (Part::Random, "fixedValue") => Some(robot.dice.fixed.map_or(Value::Null, Value::Int)),
        (Part::Random, "callsCount") => {
            let calls = i32::try_from(robot.dice.calls);
            Some(Value::Int(calls.unwrap_or(i32::MAX)))
        }
        (Part::Random, "lastValue") => Some(Value::Int(robot.dice.last)),
        // All that these have, and it was never set.
        (Part::Speaker | Part::Network, "objectName") => Some(Value::NoText),
        (
            Part::Shell | Part::Led | Part::Marker | Part::Random | Part::Speaker | Part::Network,
            _,
        ) => None,
    }
}

/// A property of something on the field.
fn of_item(arena: &Arena, thing: SceneObject, name: &str) -> Option<Value> {
    let field = arena.field();
    let (family, index) = set::family(thing)?;
    let graphic = arena.graphics.of(family, index);
    let (at, rotation) = match thing {
        SceneObject::Solid(index) => {
            let solid = field.solids.get(index)?;
            (places::as_told(solid.at, graphic.at), solid.rotation)
        }
        SceneObject::Wall(_)
        | SceneObject::Drawn(_)
        | SceneObject::Region(_)
        | SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => (graphic.at, graphic.rotation),
    };
    let visible = match thing {
        SceneObject::Region(index) => field.regions.get(index)?.visible,
        SceneObject::Wall(_)
        | SceneObject::Solid(_)
        | SceneObject::Drawn(_)
        | SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => true,
    };
    match name {
        "x" => return Some(Value::Double(at.x)),
        "y" => return Some(Value::Double(at.y)),
        "rotation" => return Some(Value::Double(rotation)),
        // Nothing can be asked of that of a wall, as in the original.
        "pos" if matches!(thing, SceneObject::Wall(_)) => return Some(Value::Opaque),
        "pos" => return Some(Value::Place([at.x, at.y])),
        "visible" => return Some(Value::Bool(graphic.is_visible.unwrap_or(visible))),
        "enabled" => return Some(Value::Bool(true)),
        "z" => return Some(Value::Double(0.0)),
        "opacity" | "scale" => return Some(Value::Double(1.0)),
        _ => {}
    }
    match thing {
        SceneObject::Wall(index) => {
            let material = &field.walls.get(index)?.material;
            let asked = ["mass", "friction", "restitution"].contains(&name);
            asked.then(|| of_material(material, name)).flatten()
        }
        SceneObject::Solid(index) => of_material(&field.solids.get(index)?.material, name),
        SceneObject::Drawn(index) => of_drawn(field.drawn.get(index)?, name),
        SceneObject::Region(index) => {
            let region = field.regions.get(index)?;
            Some(match name {
                "filled" => Value::Bool(region.filled),
                "color" => Value::Colour(set::argb(&region.colour).unwrap_or(set::BLACK)),
                _ => return None,
            })
        }
        SceneObject::Robot(_)
        | SceneObject::Device(..)
        | SceneObject::Part(..)
        | SceneObject::Trace => None,
    }
}

/// The original keeps these in 32 bits.
fn of_material(material: &Material, name: &str) -> Option<Value> {
    let number = match name {
        "mass" => material.mass,
        "friction" => material.friction,
        "restitution" => material.restitution,
        "angularDamping" => material.angular_damping,
        "linearDamping" => material.linear_damping,
        _ => return None,
    };
    Some(Value::Double(f64::from(number as f32)))
}

fn of_drawn(drawn: &Drawn, name: &str) -> Option<Value> {
    let pen = &drawn.pen;
    Some(match name {
        "thickness" => Value::Double(pen.width),
        "color" => Value::Colour(set::argb(&pen.colour).unwrap_or(set::BLACK)),
        "filled" if matches!(drawn.shape, Shape::Rectangle(..) | Shape::Ellipse(..)) => {
            Value::Bool(pen.fill_style == "solid")
        }
        _ => return None,
    })
}

fn count(length: usize) -> Value {
    Value::Int(i32::try_from(length).unwrap_or(i32::MAX))
}

#[cfg(test)]
mod facts;
#[cfg(test)]
mod tests;
