//! An arena as the rules of a task see it: objects by name, their types and what they say.
//!
//! Owns the names of objects and their numbers; `scene/places` says where things are, `scene/shown` what is on a display.
//! Knows no rules. Names and types are those of the original: a type is the class there.
//!
//! A number of an object is good as long as the field is not edited.

mod places;
mod shown;

use lang_constraint::{Missing, Object, ObjectPoint, Rect, Scene, Unfit, Value};
use lang_diagram::brick::Brick;
use lang_diagram::ports::{Kit, Port, Sort, Way};

use crate::arena::{Arena, Robot, screen};
use crate::field::{Material, Pen, SensorKind, Shape, SolidKind};

/// An object of an arena.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Thing {
    Robot(usize),
    /// What is on a port of a robot.
    Device(usize, Port),
    /// Something that every robot has.
    Part(usize, Part),
    Wall(usize),
    Solid(usize),
    Drawn(usize),
    Image(usize),
    Region(usize),
    Comment(usize),
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

impl Thing {
    fn number(self) -> Option<Object> {
        let of_robot = |robot: usize, which: u8| robot << OF_ROBOT | usize::from(which);
        let (kind, which) = match self {
            Self::Robot(robot) => (0, robot),
            Self::Device(robot, port) => (1, of_robot(robot, port.index())),
            Self::Part(robot, part) => (2, of_robot(robot, part as u8)),
            Self::Wall(index) => (3, index),
            Self::Solid(index) => (4, index),
            Self::Drawn(index) => (5, index),
            Self::Image(index) => (6, index),
            Self::Region(index) => (7, index),
            Self::Comment(index) => (8, index),
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
            6 => Self::Image(which),
            7 => Self::Region(which),
            8 => Self::Comment(which),
            9 => Self::Trace,
            _ => return None,
        })
    }
}

/// The thing of a name.
fn named(arena: &Arena, name: &str) -> Option<Thing> {
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
                None => Some(Thing::Robot(index)),
                Some(inside) => of_robot(robot, index, inside),
            };
        }
    }
    if name == "trace" {
        return Some(Thing::Trace);
    }
    if name.is_empty() {
        return None;
    }
    let field = arena.field();
    at(&field.regions, |one| one.id == name)
        .map(Thing::Region)
        .or_else(|| at(&field.solids, |one| one.id == name).map(Thing::Solid))
        .or_else(|| at(&field.walls, |one| one.id == name).map(Thing::Wall))
        .or_else(|| at(&field.drawn, |one| one.id == name).map(Thing::Drawn))
        .or_else(|| at(&field.images, |one| one.id == name).map(Thing::Image))
        .or_else(|| at(&field.comments, |one| one.id == name).map(Thing::Comment))
}

fn at<T>(all: &[T], is_it: impl Fn(&T) -> bool) -> Option<usize> {
    all.iter().position(is_it)
}

/// What a robot has under a name: a part, or a device that is plugged in.
fn of_robot(robot: &Robot, index: usize, name: &str) -> Option<Thing> {
    if let Some((_, part, _)) = PARTS.iter().find(|(known, ..)| *known == name) {
        return Some(Thing::Part(index, *part));
    }
    let (name, ways) = if let Some(name) = name.strip_suffix("_in") {
        (name, &[Way::In][..])
    } else if let Some(name) = name.strip_suffix("_out") {
        (name, &[Way::Out][..])
    } else {
        (name, &[Way::Out, Way::In][..])
    };
    // Ports with long names go without the word `Port` and begin small.
    let mut long = String::new();
    if let Some(first) = name.chars().next().filter(char::is_ascii_lowercase) {
        long.push(first.to_ascii_uppercase());
        long.push_str(&name[1..]);
        long.push_str("Port");
    }
    let find = |text: &str| {
        let mut ways = ways.iter();
        ways.find_map(|&way| Port::find(Kit::V62, text, way))
    };
    let port = find(name).or_else(|| find(&long))?;
    is_plugged_in(robot, port).then_some(Thing::Device(index, port))
}

fn is_plugged_in(robot: &Robot, port: Port) -> bool {
    match port.sort() {
        Sort::Motor | Sort::Servo | Sort::Encoder | Sort::Button(_) => true,
        Sort::Scalar | Sort::Vector => match port.name() {
            "GyroscopePort" | "AccelerometerPort" => true,
            "LidarPort" => robot.sensor_of(SensorKind::Lidar).is_some(),
            "LineSensorPort" | "ColorSensorPort" => robot.sensor_of(SensorKind::Camera).is_some(),
            name if name.starts_with("Gamepad") => robot.gamepad().is_some(),
            _ => robot
                .sensor(port)
                .is_some_and(|sensor| sensor.kind != SensorKind::Other),
        },
    }
}

/// The class of what is on a port.
fn class_of_device(robot: &Robot, port: Port) -> Option<&'static str> {
    Some(match port.sort() {
        Sort::Motor | Sort::Servo => "twoDModel::robotModel::parts::Motor",
        Sort::Encoder => "twoDModel::robotModel::parts::EncoderSensor",
        Sort::Button(_) => "twoDModel::robotModel::parts::Button",
        Sort::Scalar | Sort::Vector => match port.name() {
            "GyroscopePort" => "trik::robotModel::twoD::parts::GyroscopeSensor",
            "AccelerometerPort" => "twoDModel::robotModel::parts::Accelerometer",
            "LidarPort" => "twoDModel::robotModel::parts::Lidar",
            "LineSensorPort" => "trik::robotModel::twoD::parts::LineSensor",
            "ColorSensorPort" => "trik::robotModel::twoD::parts::ColorSensor",
            _ => match robot.sensor(port)?.kind {
                SensorKind::Infrared | SensorKind::Sonar => {
                    "twoDModel::robotModel::parts::RangeSensor"
                }
                SensorKind::Light => "trik::robotModel::twoD::parts::TwoDLightSensor",
                SensorKind::Touch => "twoDModel::robotModel::parts::TouchSensor",
                SensorKind::Camera => "trik::robotModel::twoD::parts::LineSensor",
                SensorKind::Lidar => "twoDModel::robotModel::parts::Lidar",
                SensorKind::Other => return None,
            },
        },
    })
}

fn class_of(arena: &Arena, thing: Thing) -> Option<&'static str> {
    let field = arena.field();
    Some(match thing {
        Thing::Robot(_) => "twoDModel::model::RobotModel",
        Thing::Device(robot, port) => class_of_device(arena.robots().get(robot)?, port)?,
        Thing::Part(_, part) => PARTS[part as usize].2,
        Thing::Wall(_) => "twoDModel::items::WallItem",
        Thing::Solid(index) => match field.solids.get(index)?.kind {
            SolidKind::Skittle => "twoDModel::items::SkittleItem",
            SolidKind::Ball => "twoDModel::items::BallItem",
            SolidKind::Cube => "twoDModel::items::CubeItem",
        },
        Thing::Drawn(index) => match field.drawn.get(index)?.shape {
            Shape::Line(..) => "twoDModel::items::LineItem",
            Shape::Rectangle(..) => "twoDModel::items::RectangleItem",
            Shape::Ellipse(..) => "twoDModel::items::EllipseItem",
            Shape::Curve(..) => "twoDModel::items::CurveItem",
            Shape::Stylus(..) => "twoDModel::items::StylusItem",
        },
        Thing::Image(_) => "twoDModel::items::ImageItem",
        Thing::Region(index) => match field.regions.get(index)?.kind.as_str() {
            "ellipse" => "twoDModel::items::EllipseRegion",
            "bound" => "twoDModel::items::BoundRegion",
            _ => "twoDModel::items::RectangularRegion",
        },
        Thing::Comment(_) => "twoDModel::items::CommentItem",
        Thing::Trace => "utils::ObjectsSetBase",
    })
}

impl Scene for Arena {
    fn find(&mut self, name: &str) -> Option<Object> {
        named(self, name)?.number()
    }

    fn type_of(&mut self, object: Object) -> Option<&'static str> {
        class_of(self, Thing::of(object)?)
    }

    fn property(&mut self, object: Object, chain: &[Box<str>]) -> Result<Value, Missing> {
        let thing = Thing::of(object).ok_or(Missing::Type(0))?;
        let Some((name, rest)) = chain.split_first() else {
            return Ok(Value::Object(object));
        };
        // How many figures there are is asked in each tick, and needs no list of them.
        if let (Thing::Part(robot, Part::Display), [last]) = (thing, rest)
            && let Some(robot) = self.robots().get(robot)
            && let Some(count) = shown::count(&robot.shown().screen, name, last)
        {
            return Ok(count);
        }
        let value = property(self, thing, name).ok_or(Missing::Property(0))?;
        value.descend(chain, 1)
    }

    fn set_property(&mut self, object: Object, property: &str, value: &Value) -> bool {
        match (Thing::of(object), property) {
            (Some(Thing::Part(robot, Part::Random)), "fixedValue") => {
                if let Some(robot) = self.robot_mut(robot) {
                    let is_null = matches!(value, Value::Null);
                    robot.dice.fixed = (!is_null).then(|| value.to_int());
                }
                true
            }
            (Some(Thing::Robot(index)), "rotation") => {
                if let Some(robot) = self.robot_mut(index) {
                    let mut pose = robot.pose();
                    pose.degrees = number(value);
                    robot.put(pose);
                }
                true
            }
            (Some(Thing::Solid(index)), "x" | "y" | "rotation") => {
                let number = number(value);
                self.edit(|field| {
                    if let Some(solid) = field.solids.get_mut(index) {
                        match property {
                            "x" => solid.at.x = number + solid.size / 2.0,
                            "y" => solid.at.y = number + solid.size / 2.0,
                            _ => solid.rotation = number,
                        }
                    }
                });
                true
            }
            // What is there and cannot be set stays as it is, without a word, as in the original.
            (Some(thing), _) => self::property(self, thing, property).is_some(),
            (None, _) => false,
        }
    }

    fn is_inside(
        &mut self,
        object: Object,
        region: Object,
        point: ObjectPoint,
    ) -> Result<bool, Unfit> {
        let Some(Thing::Region(region)) = Thing::of(region) else {
            return Err(Unfit::NoRegion);
        };
        let thing = Thing::of(object).ok_or(Unfit::NoPlace)?;
        places::is_inside(self, thing, region, point)
    }

    fn bounding_rect(&mut self, object: Object) -> Option<Rect> {
        let thing = Thing::of(object)?;
        if thing == Thing::Trace {
            return places::around_trace(self);
        }
        // Only the trace has a rectangle of its own there; of others their place is taken.
        Some(Rect {
            x: property(self, thing, "x")?.to_int(),
            y: property(self, thing, "y")?.to_int(),
            width: 1,
            height: 1,
        })
    }
}

/// A finite number; 0 for what is none, and no farther than a field is large.
fn number(value: &Value) -> f64 {
    let number = match value {
        Value::Double(number) => *number,
        other => f64::from(other.to_int()),
    };
    if number.is_nan() {
        return 0.0;
    }
    number.clamp(-crate::limits::FIELD_NUMBER, crate::limits::FIELD_NUMBER)
}

/// A property of a thing; nothing if it has none of this name.
fn property(arena: &mut Arena, thing: Thing, name: &str) -> Option<Value> {
    match thing {
        Thing::Robot(index) => {
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
        Thing::Device(index, port) => device(arena, index, port, name),
        Thing::Part(index, part) => of_part(arena.robots().get(index)?, part, name),
        Thing::Trace => match name {
            "size" => Some(count(arena.trace().len())),
            "isEmpty" => Some(Value::Bool(arena.trace().is_empty())),
            _ => None,
        },
        _ => of_item(arena, thing, name),
    }
}

fn device(arena: &mut Arena, index: usize, port: Port, name: &str) -> Option<Value> {
    let robot = arena.robots().get(index)?;
    match (port.sort(), name) {
        (Sort::Motor, "power" | "speed") => Some(Value::Int(robot.power(port))),
        (Sort::Servo, "power" | "value") => Some(Value::Int(robot.servo(port))),
        (Sort::Motor | Sort::Servo, _) => None,
        (Sort::Vector, "value" | "lastData") => {
            let mut numbers = Vec::new();
            arena.robot(index).vector(port, &mut numbers);
            Some(Value::list(numbers.into_iter().map(Value::Int)))
        }
        (_, "value" | "lastData") => {
            let reading = arena.robot(index).scalar(port);
            Some(Value::Int(reading.unwrap_or(0)))
        }
        _ => None,
    }
}

fn of_part(robot: &Robot, part: Part, name: &str) -> Option<Value> {
    let shown = robot.shown();
    match (part, name) {
        (Part::Display, _) => shown::property(&shown.screen, name),
        (Part::Shell, "lastPhrase") => Some(Value::text(&shown.last_phrase)),
        (Part::Led, "color") => Some(Value::Colour(shown.led.number())),
        (Part::Marker, "isDown") => Some(Value::Bool(robot.marker().is_down)),
        (Part::Marker, "color") => {
            let colour = screen::named(&robot.marker().colour);
            Some(Value::Colour(colour.number()))
        }
        (Part::Random, "fixedValue") => Some(robot.dice.fixed.map_or(Value::Null, Value::Int)),
        (Part::Random, "callsCount") => {
            let calls = i32::try_from(robot.dice.calls);
            Some(Value::Int(calls.unwrap_or(i32::MAX)))
        }
        (Part::Random, "lastValue") => Some(Value::Int(robot.dice.last)),
        (Part::Speaker, "isPlaying") => Some(Value::Bool(shown.beep_ms > 0)),
        _ => None,
    }
}

/// A property of something on the field.
fn of_item(arena: &Arena, thing: Thing, name: &str) -> Option<Value> {
    let field = arena.field();
    let (at, rotation) = places::corner(arena, thing)?;
    match name {
        "x" => return Some(Value::Double(at.x)),
        "y" => return Some(Value::Double(at.y)),
        "rotation" => return Some(Value::Double(rotation)),
        "pos" => return Some(Value::Point(places::whole(at))),
        _ => {}
    }
    match thing {
        Thing::Wall(index) => {
            let wall = field.walls.get(index)?;
            match name {
                "thickness" => Some(Value::Double(wall.width)),
                _ => of_material(&wall.material, name),
            }
        }
        Thing::Solid(index) => of_material(&field.solids.get(index)?.material, name),
        Thing::Drawn(index) => of_pen(&field.drawn.get(index)?.pen, name),
        Thing::Region(index) => {
            let region = field.regions.get(index)?;
            Some(match name {
                "filled" => Value::Bool(region.filled),
                "visible" => Value::Bool(region.visible),
                "color" => Value::Colour(screen::named(&region.colour).number()),
                "text" => Value::text(&region.text),
                "width" => Value::Double(region.size.x),
                "height" => Value::Double(region.size.y),
                _ => return None,
            })
        }
        Thing::Comment(index) => {
            let text = &field.comments.get(index)?.text;
            (name == "text").then(|| Value::text(text))
        }
        _ => None,
    }
}

fn of_material(material: &Material, name: &str) -> Option<Value> {
    Some(Value::Double(match name {
        "mass" => material.mass,
        "friction" => material.friction,
        "restitution" => material.restitution,
        "angularDamping" => material.angular_damping,
        "linearDamping" => material.linear_damping,
        _ => return None,
    }))
}

fn of_pen(pen: &Pen, name: &str) -> Option<Value> {
    Some(match name {
        "thickness" => Value::Double(pen.width),
        "color" => Value::Colour(screen::named(&pen.colour).number()),
        "filled" => Value::Bool(pen.fill_style == "solid"),
        _ => return None,
    })
}

fn count(length: usize) -> Value {
    Value::Int(i32::try_from(length).unwrap_or(i32::MAX))
}

#[cfg(test)]
mod tests;
