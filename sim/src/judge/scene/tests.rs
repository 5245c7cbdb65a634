//! Names, properties, types and places of everything that rules can ask for.

use lang_constraint::{Missing, Object, ObjectPoint, Rect, Scene, Unfit, Value};
use lang_diagram::brick::{Brick, Command, Figure};
use lang_diagram::ports::Port;
use lang_diagram::stand_in::Pose;

use crate::arena::{Arena, Setup};
use crate::field::{
    Comment, Drawn, Field, Pen, Region, Robot, Sensor, SensorKind, Shape, Solid, SolidKind, Wall,
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
        "robot1.M1_out",
        "robot1.S6",
        "robot1.E3",
        "robot1.A1",
        "robot1.A1_in",
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
    // The same port by two names is one object.
    assert_eq!(numbers.len(), names.len() - 2);
    for name in [
        "",
        "robot",
        "robot0",
        "robot2",
        "robot1.",
        "robot1.A2_out",
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
    let port = Port::named("M3").unwrap();
    let mut robot = arena.robot(0);
    robot.tell(Command::Power { port, percent: -40 });
    robot.tell(Command::Say { text: "hello" });
    robot.tell(Command::Led { color: "green" });
    robot.tell(Command::MarkerDown { color: "red" });
    says(&mut arena, "robot1", "isRiding", "true");
    says(&mut arena, "robot1.M3", "power", "-40");
    says(&mut arena, "robot1.shell", "lastPhrase", "hello");
    says(&mut arena, "robot1.led", "color", "#008000");
    says(&mut arena, "robot1.marker", "isDown", "true");
    says(&mut arena, "robot1.marker", "color", "#ff0000");
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
    says(&mut arena, "robot1", "rotation", "0");
    let ball = object(&mut arena, "ball");
    assert!(arena.set_property(ball, "x", &Value::Double(1e308)));
    says(&mut arena, "ball", "x", "1e+06");
    arena.tick();
}

#[test]
fn a_display_says_what_is_on_it() {
    let mut arena = arena();
    let mut robot = arena.robot(0);
    robot.tell(Command::PenColor { color: "red" });
    robot.tell(Command::Draw(Figure::Ellipse([10, 20, 3, 4], true)));
    robot.tell(Command::Draw(Figure::Arc([0, 0, 20, 40, 30, 60])));
    robot.tell(Command::Draw(Figure::Line([9, 8, 1, 2])));
    robot.tell(Command::Draw(Figure::Pixel([5, 6])));
    robot.tell(Command::Draw(Figure::Rectangle([1, 2, 3, 4], false)));
    let label = Command::Label {
        x: 7,
        y: 8,
        size: 20,
        text: "hi",
    };
    robot.tell(label);
    robot.tell(Command::Smile { sad: true });
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
        ("arcs.0.ellipseCenter.y", "20"),
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
        ("ball", "x", "285"),
        ("ball", "rotation", "0"),
        ("ball", "mass", "0.015"),
        ("wall", "thickness", "10"),
        ("wall", "friction", "1"),
        ("zone", "x", "0"),
        ("zone", "width", "100"),
        ("zone", "text", "here"),
        ("zone", "filled", "true"),
        ("zone", "pos.x", "0"),
        ("trace", "isEmpty", "true"),
    ] {
        says(&mut arena, name, chain, wanted);
    }
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
        assert_eq!(robot_in(zone, 0.0, 50.0, 0.0), [true, true, true]);
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
    assert_eq!(place(&mut arena, "zone", ObjectPoint::All), Ok(true));
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
    robot.tell(Command::MarkerDown { color: "red" });
    for name in ["M3", "M4"] {
        let port = Port::named(name).unwrap();
        robot.tell(Command::Power { port, percent: 100 });
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
        x: 285,
        y: 5,
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
    field.comments.push(remark());
    let regions: Vec<String> = field.regions.iter().map(|one| one.id.clone()).collect();
    let drawn: Vec<String> = field.drawn.iter().map(|one| one.id.clone()).collect();
    let mut arena = Arena::new(&field, Setup::default());
    for region in &regions {
        let region = object(&mut arena, region);
        for name in drawn
            .iter()
            .map(String::as_str)
            .chain(["robot1", "ball", "remark"])
        {
            let found = object(&mut arena, name);
            for point in [ObjectPoint::Center, ObjectPoint::All, ObjectPoint::Any] {
                assert!(arena.is_inside(found, region, point).is_ok(), "{name}");
            }
        }
    }
}

fn remark() -> Comment {
    let text = r#"<root><world><comments><comment id="remark" begin="0:0" end="10:10" text="a"/></comments></world><settings/></root>"#;
    let opened = Field::read(text);
    opened
        .map(|opened| opened.field.comments[0].clone())
        .expect("a field with a remark")
}
