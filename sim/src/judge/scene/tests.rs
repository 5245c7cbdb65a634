//! Names, properties, types and places of everything that rules can ask for.

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
    Ok(match value {
        Value::Null => "null".to_owned(),
        value => value.to_text(),
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
    robot.command(Command::Say { text: "hello" });
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

/// Whether the robot, its corner at a place, is in a region: by its centre, all of it, any of it.
fn robot_in(region: &str, x: f64, y: f64, degrees: f64) -> [bool; 3] {
    let mut arena = arena();
    put(&mut arena, x, y, degrees);
    let robot = object(&mut arena, "robot1");
    let region = object(&mut arena, region);
    [ObjectPoint::Center, ObjectPoint::All, ObjectPoint::Any]
        .map(|point| arena.is_inside(robot, region, point).unwrap())
}

#[test]
fn a_robot_is_in_a_region_by_its_centre_wholly_or_in_part() {
    for zone in ["zone", "turned"] {
        assert_eq!(robot_in(zone, 25.0, 25.0, 0.0), [true, true, true]);
        // Sides that touch from within are not all in it.
        assert_eq!(robot_in(zone, 0.0, 50.0, 0.0), [true, false, true]);
        assert_eq!(robot_in(zone, -1.0, 25.0, 0.0), [true, false, true]);
        assert_eq!(robot_in(zone, -30.0, 25.0, 0.0), [false, false, true]);
        assert_eq!(robot_in(zone, -60.0, 25.0, 0.0), [false, false, false]);
        // Turned, its corners reach farther.
        assert_eq!(robot_in(zone, 5.0, 25.0, 45.0), [true, false, true]);
        assert_eq!(robot_in(zone, -55.0, 25.0, 45.0), [false, false, true]);
        assert_eq!(robot_in(zone, -55.0, 25.0, 0.0), [false, false, false]);
        // The left side is in it, the right one is not.
        assert!(robot_in(zone, -25.0, 25.0, 0.0)[0]);
        assert!(!robot_in(zone, 75.0, 25.0, 0.0)[0]);
    }
    assert_eq!(robot_in("round", 25.0, 25.0, 0.0), [true, true, true]);
    assert_eq!(robot_in("round", 0.0, 0.0, 0.0), [true, false, true]);
    assert_eq!(robot_in("round", -40.0, -40.0, 0.0), [false, false, false]);
    assert_eq!(robot_in("lake", -75.0, -75.0, 0.0), [true, true, true]);
    assert_eq!(robot_in("lake", -40.0, -60.0, 0.0), [true, false, true]);
    assert_eq!(robot_in("lake", 0.0, 0.0, 0.0), [false, false, false]);
}

#[test]
fn sensors_and_things_have_places_too_and_what_has_none_is_told() {
    let mut arena = arena();
    let zone = object(&mut arena, "zone");
    let place = |arena: &mut Arena, name: &str, point| {
        let found = object(arena, name);
        arena.is_inside(found, zone, point)
    };
    // The sensor is 50 px ahead of the centre.
    put(&mut arena, 40.0, 0.0, 0.0);
    assert_eq!(place(&mut arena, "robot1", ObjectPoint::Center), Ok(true));
    assert_eq!(
        place(&mut arena, "robot1.A2", ObjectPoint::Center),
        Ok(false)
    );
    put(&mut arena, 20.0, 0.0, 0.0);
    assert_eq!(
        place(&mut arena, "robot1.A2", ObjectPoint::Center),
        Ok(true)
    );
    assert_eq!(place(&mut arena, "robot1.A2", ObjectPoint::All), Ok(false));
    assert_eq!(place(&mut arena, "robot1.A2", ObjectPoint::Any), Ok(true));
    put(&mut arena, 20.0, 1.0, 0.0);
    // A display is where the corner of its robot is, and as large as the robot.
    assert_eq!(
        place(&mut arena, "robot1.display", ObjectPoint::Center),
        Ok(true)
    );
    assert_eq!(
        place(&mut arena, "robot1.display", ObjectPoint::All),
        Ok(true)
    );
    assert_eq!(place(&mut arena, "ball", ObjectPoint::Center), Ok(false));
    assert_eq!(place(&mut arena, "wall", ObjectPoint::Any), Ok(false));
    assert_eq!(place(&mut arena, "zone", ObjectPoint::All), Ok(false));
    assert_eq!(place(&mut arena, "zone", ObjectPoint::Any), Ok(true));
    assert_eq!(
        place(&mut arena, "trace", ObjectPoint::Any),
        Err(Unfit::NoPlace)
    );
    let ball = object(&mut arena, "ball");
    assert_eq!(
        arena.is_inside(ball, ball, ObjectPoint::Any),
        Err(Unfit::NoRegion)
    );
}

#[test]
fn the_trace_has_a_rectangle_and_other_things_have_their_place() {
    let mut arena = arena();
    let trace = object(&mut arena, "trace");
    assert_eq!(arena.bounding_rect(trace), None);
    let mut robot = arena.robot(0);
    robot.command(Command::MarkerDown { color: "red" });
    for name in ["M3", "M4"] {
        let port = Port::named(name).unwrap();
        robot.command(Command::Power { port, percent: 100 });
    }
    for _ in 0..102 {
        arena.tick();
    }
    // From its centre at 25:25, 100 ticks of 0.767945 px, and half of the marker around it.
    let found = arena.bounding_rect(trace).unwrap();
    assert_eq!((found.x, found.y, found.height), (22, 22, 6));
    assert!((82..=84).contains(&found.width), "{found:?}");
    let ball = object(&mut arena, "ball");
    let wanted = Rect {
        x: 300,
        y: 20,
        width: 1,
        height: 1,
    };
    assert_eq!(arena.bounding_rect(ball), Some(wanted));
}

#[test]
fn places_of_odd_things_are_worked_out_within_bounds() {
    let mut field = field();
    let odd = [f64::MAX, -1e308, 0.0, f64::NAN, f64::INFINITY];
    for (index, &x) in odd.iter().enumerate() {
        for shape in [
            Shape::Line(point(x, 0.0), point(0.0, x)),
            Shape::Rectangle(point(x, x), point(0.0, 0.0)),
            Shape::Curve(point(x, 0.0), point(0.0, 0.0), point(x, x), point(1.0, 1.0)),
            Shape::Stylus(Vec::new()),
        ] {
            let mut drawn = Drawn::new(shape, Pen::default());
            drawn.id = format!("odd{index}{}", field.drawn.len());
            field.regions.push(Region {
                id: format!("region{}", field.drawn.len()),
                kind: "bound".to_owned(),
                bound: drawn.id.clone(),
                ..Region::default()
            });
            field.drawn.push(drawn);
        }
        field.regions.push(Region {
            id: format!("round{index}"),
            size: point(x, x),
            ..Region::default()
        });
    }
    let regions: Vec<String> = field.regions.iter().map(|one| one.id.clone()).collect();
    let drawn: Vec<String> = field.drawn.iter().map(|one| one.id.clone()).collect();
    let mut arena = Arena::new(&field, Setup::default());
    for region in &regions {
        let region = object(&mut arena, region);
        for name in drawn.iter().map(String::as_str).chain(["robot1", "ball"]) {
            let found = object(&mut arena, name);
            for point in [ObjectPoint::Center, ObjectPoint::All, ObjectPoint::Any] {
                assert!(arena.is_inside(found, region, point).is_ok(), "{name}");
            }
        }
    }
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
fn rules_give_sensors_readings_and_lock_them() {
    let mut arena = arena();
    // Nothing is read as long as it is not due, and a rule reads nothing itself.
    says(&mut arena, "robot1.A1", "value", "0");
    says(&mut arena, "robot1.A1", "locked", "false");
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "74");
    sets(&mut arena, "robot1.A1", "value", Value::Int(5), "5");
    let port = Port::named("A1").unwrap();
    assert_eq!(arena.robot(0).announced(), Some((port, 5)));
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "74");
    sets(
        &mut arena,
        "robot1.A1",
        "locked",
        Value::text("true"),
        "true",
    );
    sets(&mut arena, "robot1.A1", "value", Value::text("7"), "7");
    for _ in 0..2 {
        arena.tick();
        arena.renew();
    }
    says(&mut arena, "robot1.A1", "value", "7");
    assert_eq!(arena.robot(0).locked(port), Some(7));
    // A block that waits for it reads it all the same.
    assert_eq!(arena.robot(0).scalar(port), Some(74));
    says(&mut arena, "robot1.A1", "value", "74");
    // What is no number changes nothing, and several numbers cannot be set or shown.
    sets(&mut arena, "robot1.A1", "value", Value::text("far"), "74");
    sets(&mut arena, "robot1.gyroscope", "value", Value::Int(3), "");
    sets(
        &mut arena,
        "robot1.gyroscope",
        "locked",
        Value::Bool(true),
        "true",
    );
    let missing = get(&mut arena, "robot1.gyroscope", "value.0");
    assert_eq!(missing, Err(Missing::Type(1)));
}

#[test]
fn rules_drive_motors_and_what_is_too_much_moves_no_faster() {
    let mut arena = arena();
    sets(&mut arena, "robot1.M3", "power", Value::Double(33.6), "34");
    sets(&mut arena, "robot1.M3", "power", Value::text("250"), "250");
    sets(&mut arena, "robot1.M4", "power", Value::Int(100), "100");
    says(&mut arena, "robot1", "isRiding", "true");
    for _ in 0..12 {
        arena.tick();
    }
    let pose = arena.robots()[0].pose();
    assert!((pose.x - 11.0 * 0.767945).abs() < 1e-4, "{pose:?}");
    assert_eq!(pose.degrees, 0.0);
}

#[test]
fn rules_speak_shine_and_draw() {
    let mut arena = arena();
    sets(
        &mut arena,
        "robot1.shell",
        "lastPhrase",
        Value::text("so"),
        "so",
    );
    sets(
        &mut arena,
        "robot1.led",
        "color",
        Value::text("red"),
        "#ff0000",
    );
    for none in ["off", "nonsense", ""] {
        sets(
            &mut arena,
            "robot1.led",
            "color",
            Value::text(none),
            "#ff0000",
        );
    }
    let faint = Value::text("#80112233");
    sets(&mut arena, "robot1.led", "color", faint, "#80112233");
    sets(
        &mut arena,
        "robot1.display",
        "background",
        Value::text("#0f0"),
        "#00ff00",
    );
    // What is there and only read stays as it is.
    sets(
        &mut arena,
        "robot1.display",
        "smiles",
        Value::Bool(true),
        "false",
    );
    sets(&mut arena, "robot1.marker", "isDown", Value::Int(1), "true");
    assert_eq!(arena.robots()[0].marker().colour, "black");
    sets(
        &mut arena,
        "robot1.marker",
        "isDown",
        Value::text("0"),
        "false",
    );
    let speaker = object(&mut arena, "robot1.speaker");
    assert!(!arena.set_property(speaker, "volume", &Value::Int(1)));
}

#[test]
fn rules_write_on_what_is_on_the_display() {
    let mut arena = arena();
    let (x, y, size) = (5, 6, 20);
    arena.robot(0).command(Command::Label {
        x,
        y,
        size,
        text: "abc",
    });
    let display = object(&mut arena, "robot1.display");
    let label: [Box<str>; 2] = ["labels".into(), "first".into()];
    for (property, value, wanted) in [
        ("text", Value::text("xyz"), "xyz"),
        ("x", Value::Int(50), "50"),
        ("fontSize", Value::text("9"), "9"),
        ("color", Value::text("red"), "#ff0000"),
    ] {
        assert!(arena.set_within(display, &label, property, &value));
        let chain = format!("labels.0.{property}");
        says(&mut arena, "robot1.display", &chain, wanted);
    }
    assert!(!arena.set_within(display, &label, "width", &Value::Int(1)));
    let none: [Box<str>; 2] = ["labels".into(), "1".into()];
    assert!(!arena.set_within(display, &none, "text", &Value::Int(1)));
}

#[test]
fn rules_move_and_paint_things_of_the_field() {
    let mut arena = arena();
    sets(&mut arena, "ball", "x", Value::Double(10.5), "10.5");
    assert_eq!(arena.field().solids[0].at.x, 10.5);
    let ball = object(&mut arena, "ball");
    assert!(!arena.set_property(ball, "mass", &Value::Int(9)));
    // A wall is only drawn elsewhere.
    sets(&mut arena, "wall", "x", Value::Int(100), "100");
    assert_eq!(arena.field().walls[0].begin.x, 400.0);
    let wall = object(&mut arena, "wall");
    assert!(!arena.set_property(wall, "thickness", &Value::Int(9)));
    sets(&mut arena, "pool", "x", Value::Int(150), "150");
    let shape = &arena.field().drawn[0].shape;
    assert_eq!(
        *shape,
        Shape::Ellipse(point(50.0, -100.0), point(150.0, 0.0))
    );
    sets(&mut arena, "pool", "thickness", Value::Int(20), "20");
    sets(&mut arena, "pool", "color", Value::text("blue"), "#0000ff");
    sets(&mut arena, "pool", "filled", Value::Bool(true), "true");
    sets(&mut arena, "pool", "visible", Value::Bool(false), "false");
    sets(&mut arena, "zone", "color", Value::text("blue"), "#0000ff");
    let robot = object(&mut arena, "robot1");
    assert!(arena.set_property(robot, "x", &Value::Int(9)));
    says(&mut arena, "robot1", "x", "0");
}

#[test]
fn a_region_that_was_moved_or_turned_is_there() {
    let mut arena = arena();
    let (robot, zone) = (object(&mut arena, "robot1"), object(&mut arena, "zone"));
    let is_in = |arena: &mut Arena| arena.is_inside(robot, zone, ObjectPoint::Center);
    assert_eq!(is_in(&mut arena), Ok(true));
    sets(&mut arena, "zone", "x", Value::Int(200), "200");
    assert_eq!(is_in(&mut arena), Ok(false));
    sets(&mut arena, "zone", "x", Value::Int(0), "0");
    sets(&mut arena, "zone", "rotation", Value::Int(180), "180");
    assert_eq!(is_in(&mut arena), Ok(false));
    sets(&mut arena, "zone", "rotation", Value::Int(45), "45");
    assert_eq!(is_in(&mut arena), Ok(true));
}

/// A field with a drawn thing, and a region bound to it.
fn bound(shape: Shape, width: f64, ring: f64) -> Arena {
    let pen = Pen {
        width,
        ..Pen::default()
    };
    let mut drawn = Drawn::new(shape, pen);
    drawn.id = "drawn".to_owned();
    let region = |id: &str, bound: &str| Region {
        id: id.to_owned(),
        kind: "bound".to_owned(),
        bound: bound.to_owned(),
        ring,
        ..Region::default()
    };
    let field = Field {
        drawn: vec![drawn],
        regions: vec![region("bound", "drawn"), region("lost", "nothing")],
        ..Field::default()
    };
    Arena::new(&field, Setup::default())
}

/// Whether the robot with its corner at (x, 0) is in that region: by its centre, all of it, any of it.
fn bound_in(arena: &mut Arena, x: f64) -> [bool; 3] {
    put(arena, x, 0.0, 0.0);
    let (robot, region) = (object(arena, "robot1"), object(arena, "bound"));
    [ObjectPoint::Center, ObjectPoint::All, ObjectPoint::Any]
        .map(|how| arena.is_inside(robot, region, how).unwrap())
}

#[test]
fn a_bound_region_is_the_outline_with_half_of_the_pen_and_a_ring_has_a_hole() {
    let square = || Shape::Rectangle(point(100.0, -200.0), point(300.0, 200.0));
    // Half of 7 pixels is 3, of 1 none.
    for (width, edge) in [(7.0, 97.0), (1.0, 100.0)] {
        let mut arena = bound(square(), width, 0.0);
        assert_eq!(bound_in(&mut arena, edge - 50.1), [false, false, false]);
        assert_eq!(bound_in(&mut arena, edge - 50.0), [false, false, true]);
        assert_eq!(bound_in(&mut arena, edge - 25.0), [true, false, true]);
        assert_eq!(bound_in(&mut arena, edge), [true, false, true]);
        assert_eq!(bound_in(&mut arena, edge + 0.1), [true, true, true]);
        assert_eq!(arena.find("lost"), None);
    }
    let mut ring = bound(square(), 6.0, 60.0);
    assert_eq!(bound_in(&mut ring, 16.9), [false, false, false]);
    assert_eq!(bound_in(&mut ring, 17.0), [false, false, true]);
    assert_eq!(bound_in(&mut ring, 67.5), [true, true, true]);
    assert_eq!(bound_in(&mut ring, 90.0), [true, false, true]);
    assert_eq!(bound_in(&mut ring, 170.0), [false, false, false]);
    let round = Shape::Ellipse(point(100.0, -80.0), point(310.0, 130.0));
    let mut ring = bound(round, 6.0, 20.0);
    assert_eq!(bound_in(&mut ring, 36.9), [false, false, false]);
    assert_eq!(bound_in(&mut ring, 37.1), [false, false, true]);
    assert_eq!(bound_in(&mut ring, 72.0), [true, false, true]);
    assert_eq!(bound_in(&mut ring, 180.0), [false, false, false]);
    for empty in [
        Shape::Line(point(0.0, 0.0), point(50.0, 50.0)),
        Shape::Curve(
            point(0.0, 0.0),
            point(9.0, 0.0),
            point(0.0, 9.0),
            point(50.0, 50.0),
        ),
        Shape::Stylus(Vec::new()),
    ] {
        let mut arena = bound(empty, 20.0, 0.0);
        assert_eq!(bound_in(&mut arena, 0.0), [false, false, false]);
    }
    // It follows what it is bound to.
    let mut arena = bound(square(), 6.0, 0.0);
    assert!(bound_in(&mut arena, 120.0)[0]);
    sets(&mut arena, "drawn", "x", Value::Int(150), "150");
    assert!(!bound_in(&mut arena, 120.0)[0]);
}
