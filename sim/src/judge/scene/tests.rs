//! Names, properties and types of everything that rules can ask for; helpers for the subjects below.

mod changes;
mod places;

use lang_constraint::{Missing, Object, ObjectPoint, Rect, Scene, Unfit, Value};
use lang_diagram::brick::{Brick, Command, Figure};
use lang_diagram::ports::Port;
use lang_diagram::stand_in::Pose;

use crate::arena::{Arena, Setup};
use crate::field::{
    Drawn, Field, Pen, Region, Robot, Sensor, SensorKind, Shape, Solid, SolidKind, Wall,
};
use crate::geometry::point;

fn field() -> Field {
    let region = |id: &str, kind: &str, x: f64, y: f64, width: f64, height: f64| Region {
        id: id.to_owned(),
        kind: kind.to_owned(),
        at: point(x, y),
        size: point(width, height),
        text: "here".to_owned(),
        ..Region::default()
    };
    let mut wall = Wall::new(point(400.0, 0.0), point(400.0, 100.0));
    wall.id = "wall".to_owned();
    let mut ball = Solid::new(SolidKind::Ball, point(300.0, 20.0));
    ball.id = "ball".to_owned();
    let mut pool = Drawn::new(
        Shape::Ellipse(point(-100.0, -100.0), point(0.0, 0.0)),
        Pen::default(),
    );
    pool.id = "pool".to_owned();
    let mut robot = Robot::default();
    let port = |name: &str| Port::named(name).unwrap();
    robot.sensors = vec![
        Sensor::new(port("A1"), SensorKind::Infrared),
        Sensor::new(port("A2"), SensorKind::Light),
        Sensor::new(port("D1"), SensorKind::Sonar),
    ];
    let mut nothing = Sensor::new(port("A3"), SensorKind::Other);
    nothing.type_name.clear();
    robot.sensors.push(nothing);
    let alias = |name: &str, port: &str| (name.to_owned(), port.to_owned());
    robot.aliases = vec![alias("nose", "A1"), alias("screen", "DisplayPort")];
    Field {
        walls: vec![wall],
        solids: vec![ball],
        drawn: vec![pool],
        regions: vec![
            region("zone", "rectangle", 0.0, 0.0, 100.0, 100.0),
            region("round", "ellipse", 0.0, 0.0, 100.0, 100.0),
            region("turned", "rectangle", 100.0, 100.0, -100.0, -100.0),
            Region {
                bound: "pool".to_owned(),
                ..region("lake", "bound", 0.0, 0.0, 0.0, 0.0)
            },
        ],
        robots: vec![robot],
        ..Field::default()
    }
}

fn arena() -> Arena {
    Arena::new(&field(), Setup::default())
}

fn object(arena: &mut Arena, name: &str) -> Object {
    arena.find(name).unwrap_or_else(|| panic!("no {name}"))
}

fn get(arena: &mut Arena, name: &str, chain: &str) -> Result<String, Missing> {
    let object = object(arena, name);
    let chain: Vec<Box<str>> = chain.split('.').map(Into::into).collect();
    let value = arena.property(object, &chain)?;
    Ok(if matches!(value, Value::Null) {
        "null".to_owned()
    } else {
        value.to_text()
    })
}

#[track_caller]
fn says(arena: &mut Arena, name: &str, chain: &str, wanted: &str) {
    assert_eq!(
        get(arena, name, chain),
        Ok(wanted.to_owned()),
        "{name}.{chain}"
    );
}

fn put(arena: &mut Arena, x: f64, y: f64, degrees: f64) {
    arena.robot_mut(0).unwrap().put(Pose { x, y, degrees });
}

/// Sets a property, which must be there, and says what it is then.
#[track_caller]
fn sets(arena: &mut Arena, name: &str, property: &str, value: Value, wanted: &str) {
    let found = object(arena, name);
    assert!(
        arena.set_property(found, property, &value),
        "{name}.{property}"
    );
    says(arena, name, property, wanted);
}

#[test]
fn objects_are_found_by_the_names_of_the_original_and_nothing_else_is() {
    let mut arena = arena();
    let names = [
        "robot1",
        "robot1.M1",
        "robot1.S6",
        "robot1.E3",
        "robot1.A1",
        "robot1.D1",
        "robot1.gyroscope",
        "robot1.accelerometer",
        "robot1.Left",
        "robot1.display",
        "robot1.shell",
        "robot1.led",
        "robot1.marker",
        "robot1.random",
        "robot1.speaker",
        "zone",
        "ball",
        "wall",
        "pool",
        "trace",
    ];
    let mut numbers: Vec<u32> = names.map(|name| object(&mut arena, name).0).to_vec();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), names.len());
    // An alias is the same object.
    assert_eq!(arena.find("robot1.nose"), arena.find("robot1.A1"));
    assert_eq!(arena.find("robot1.screen"), arena.find("robot1.display"));
    for name in [
        "",
        "robot",
        "robot0",
        "robot2",
        "robot1.",
        "robot1.A2_out",
        "robot1.M1_out",
        "robot1.GyroscopePort",
        "robot1.video2",
        "robot1.gamepadWheel",
        "remark",
        "robot1.A3",
        "robot1.A6",
        "robot1.lidar",
        "robot1.lineSensor",
        "robot1.X1",
        "robot1.display.labels",
        "nowhere",
        "robot99999999999999999999",
    ] {
        assert_eq!(arena.find(name), None, "{name}");
    }
}

#[test]
fn types_are_the_classes_of_the_original() {
    let mut arena = arena();
    for (name, class) in [
        ("robot1", "twoDModel::model::RobotModel"),
        ("robot1.A1", "twoDModel::robotModel::parts::RangeSensor"),
        (
            "robot1.A2",
            "trik::robotModel::twoD::parts::TwoDLightSensor",
        ),
        ("robot1.D1", "twoDModel::robotModel::parts::RangeSensor"),
        ("robot1.M3", "twoDModel::robotModel::parts::Motor"),
        ("robot1.E3", "twoDModel::robotModel::parts::EncoderSensor"),
        ("robot1.display", "trik::robotModel::twoD::parts::Display"),
        ("robot1.marker", "twoDModel::robotModel::parts::Marker"),
        ("ball", "twoDModel::items::BallItem"),
        ("zone", "twoDModel::items::RectangularRegion"),
        ("round", "twoDModel::items::EllipseRegion"),
    ] {
        let found = object(&mut arena, name);
        assert_eq!(arena.type_of(found), Some(class), "{name}");
    }
    assert_eq!(arena.type_of(Object(u32::MAX)), None);
    assert_eq!(arena.type_of(Object(7 << 24 | 99)), None);
}

#[test]
fn robots_and_their_parts_say_what_they_do() {
    let mut arena = arena();
    put(&mut arena, 1.5, -2.0, 90.0);
    says(&mut arena, "robot1", "x", "1.5");
    says(&mut arena, "robot1", "y", "-2");
    says(&mut arena, "robot1", "rotation", "90");
    says(&mut arena, "robot1", "isRiding", "false");
    says(&mut arena, "robot1.random", "fixedValue", "null");
    says(&mut arena, "robot1.random", "callsCount", "0");
    says(&mut arena, "robot1.marker", "isDown", "false");
    says(&mut arena, "robot1.led", "color", "#ffffff");
    let shell = object(&mut arena, "robot1.shell");
    let phrase = arena.property(shell, &["lastPhrase".into()]);
    assert!(matches!(phrase, Ok(Value::NoText)), "{phrase:?}");
    let port = Port::named("M3").unwrap();
    let mut robot = arena.robot(0);
    robot.command(Command::Power { port, percent: -40 });
    robot.command(Command::Say {
        text: Some("hello"),
    });
    robot.command(Command::Console { text: "printed" });
    robot.command(Command::Led { color: "green" });
    robot.command(Command::MarkerDown { color: "red" });
    says(&mut arena, "robot1", "isRiding", "true");
    says(&mut arena, "robot1.M3", "power", "-40");
    says(&mut arena, "robot1.shell", "lastPhrase", "hello");
    says(&mut arena, "robot1.led", "color", "#008000");
    says(&mut arena, "robot1.marker", "isDown", "true");
    assert_eq!(
        get(&mut arena, "robot1.marker", "color"),
        Err(Missing::Property(0))
    );
    says(&mut arena, "robot1.E3", "value", "0");
    assert!(get(&mut arena, "robot1.A1", "value").is_ok());
    assert_eq!(
        get(&mut arena, "robot1", "speed"),
        Err(Missing::Property(0))
    );
    assert_eq!(get(&mut arena, "robot1", "x.y"), Err(Missing::Type(1)));
}

#[test]
fn a_fixed_random_value_comes_in_place_of_all() {
    let mut arena = arena();
    let random = object(&mut arena, "robot1.random");
    assert!(arena.set_property(random, "fixedValue", &Value::Int(7)));
    assert_eq!(arena.robot(0).random(1, 2), 7);
    says(&mut arena, "robot1.random", "lastValue", "7");
    says(&mut arena, "robot1.random", "callsCount", "1");
    assert!(arena.set_property(random, "fixedValue", &Value::Null));
    assert!(arena.robot(0).random(1, 2) < 3);
    // What cannot be set is left out, and what is not there is not known.
    assert!(arena.set_property(random, "lastValue", &Value::Int(9)));
    assert!(!arena.set_property(random, "nothing", &Value::Int(9)));
}

#[test]
fn things_can_be_turned_and_moved_and_numbers_that_are_none_do_no_harm() {
    let mut arena = arena();
    let robot = object(&mut arena, "robot1");
    assert!(arena.set_property(robot, "rotation", &Value::Double(45.0)));
    says(&mut arena, "robot1", "rotation", "45");
    assert!(arena.set_property(robot, "rotation", &Value::Double(f64::NAN)));
    says(&mut arena, "robot1", "rotation", "45");
    let ball = object(&mut arena, "ball");
    assert!(arena.set_property(ball, "x", &Value::Double(1e308)));
    says(&mut arena, "ball", "x", "1e+06");
    arena.tick();
}

#[test]
fn a_display_says_what_is_on_it() {
    let mut arena = arena();
    let mut robot = arena.robot(0);
    robot.command(Command::PenColor { color: "red" });
    robot.command(Command::Draw(Figure::Ellipse([10, 20, 3, 4], true)));
    robot.command(Command::Draw(Figure::Arc([0, 0, 20, 40, 30, 60])));
    robot.command(Command::Draw(Figure::Line([9, 8, 1, 2])));
    robot.command(Command::Draw(Figure::Pixel([5, 6])));
    robot.command(Command::Draw(Figure::Rectangle([1, 2, 3, 4], false)));
    let label = Command::Label {
        x: 7,
        y: 8,
        size: 20,
        text: "hi",
    };
    robot.command(label);
    robot.command(Command::Smile { sad: true });
    for (chain, wanted) in [
        ("smiles", "false"),
        ("sadSmiles", "true"),
        ("background", "#a0a0a4"),
        ("objects.size", "6"),
        ("ellipses.size", "1"),
        ("ellipses.isEmpty", "false"),
        ("ellipses.last.center.x", "10"),
        ("ellipses.first.w", "3"),
        ("ellipses.0.boundingRect.x", "7"),
        ("ellipses.0.filled", "true"),
        ("ellipses.0.color", "#ff0000"),
        ("arcs.0.ellipseCenter.y", "19"),
        ("arcs.0.spanAngle", "60"),
        ("segments.0.begin.x", "9"),
        ("segments.0.boundingRect.width", "8"),
        ("pixels.0.pos.y", "6"),
        ("rectangles.0.shape.height", "4"),
        ("labels.0.text", "hi"),
        ("labels.0.x", "7"),
        ("objects.5.fontSize", "20"),
    ] {
        says(&mut arena, "robot1.display", chain, wanted);
    }
    assert_eq!(
        get(&mut arena, "robot1.display", "ellipses.1.w"),
        Err(Missing::Property(1))
    );
    assert_eq!(
        get(&mut arena, "robot1.display", "ellipses.0.x"),
        Err(Missing::Property(2))
    );
    assert_eq!(
        get(&mut arena, "robot1.display", "circles.size"),
        Err(Missing::Property(0))
    );
}

#[test]
fn things_on_the_field_say_where_and_what_they_are() {
    let mut arena = arena();
    for (name, chain, wanted) in [
        ("ball", "x", "300"),
        ("ball", "pos.y", "20"),
        ("ball", "rotation", "0"),
        ("ball", "visible", "true"),
        // As 32 bits have it.
        ("ball", "mass", "0.014999999664723873"),
        ("wall", "x", "0"),
        ("wall", "friction", "1"),
        ("pool", "thickness", "0"),
        ("pool", "color", "#000000"),
        ("pool", "filled", "false"),
        ("zone", "x", "0"),
        ("zone", "color", "#87cefa"),
        ("zone", "filled", "true"),
        ("zone", "pos.x", "0"),
        ("trace", "isEmpty", "true"),
    ] {
        says(&mut arena, name, chain, wanted);
    }
    for (name, property) in [
        ("wall", "thickness"),
        ("zone", "width"),
        ("zone", "text"),
        ("ball", "objectName"),
    ] {
        let missing = get(&mut arena, name, property);
        assert_eq!(missing, Err(Missing::Property(0)), "{name}.{property}");
    }
    // Nothing can be asked of the place of a wall.
    assert_eq!(get(&mut arena, "wall", "pos.x"), Err(Missing::Type(1)));
}
