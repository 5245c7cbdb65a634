//! Every property of every kind of object: what it is at the start, and what becomes of it when a rule sets it.
//!
//! Each row was written by hand from what is known of the original. A property that no row names fails a test, and so does a
//! row of which nothing is known.

use lang_constraint::{Catalogue as _, Missing, Scene as _, Value};
use lang_diagram::brick::{Brick as _, Command, Figure};

use super::names::CLASSES;
use crate::arena::{Arena, Setup};
use crate::field::Field;

/// What becomes of a text that a rule gives a property.
#[derive(Clone, Copy)]
enum Write {
    /// It becomes the first text, and is shown as the second one.
    Sets(&'static str, &'static str),
    /// The property is there, and stays as it was without a word.
    Stays,
    /// There is no such property to be set.
    Refused,
}

use Write::{Refused, Sets, Stays};

/// One thing of each kind, and a robot with every kind of sensor.
const WORLD: &str = r##"<root version="20251219"><world>
<walls><wall id="wall" begin="0:0" end="9:0"/></walls>
<skittles><skittle id="can" x="1" y="2"/></skittles><balls><ball id="ball" x="1" y="2"/></balls>
<cubes><cube id="cube" x="1" y="2"/></cubes>
<colorFields><line id="line" begin="3:3" end="9:9" stroke="#ff00ff00" stroke-width="4"/>
<rectangle id="box" begin="3:3" end="9:9" stroke="#ff00ff00" stroke-width="4"/>
<ellipse id="oval" begin="3:3" end="9:9" stroke="#ff00ff00" stroke-width="4"/>
<stylus id="hand" stroke="#ff00ff00" stroke-width="4"/>
<cubicBezier id="bow" begin="0:0" cp1="1:1" cp2="2:2" end="9:9" stroke="#ff00ff00" stroke-width="4"/></colorFields>
<regions><region id="here" type="rectangle" x="30" y="30" width="9" height="9"/>
<region id="round" type="ellipse"/><region id="ring" type="bound" boundItem="box"/></regions></world>
<settings sizeUnit="px"/><robots><robot id="trikKitRobot"><sensors>
<sensor port="A1###input######sensorA1" type="TrikLightSensor" position="75:25"/>
<sensor port="A2###input######sensorA2" type="TrikTouchSensor" position="75:25"/>
<sensor port="D1###input######sensorD1" type="TrikSonarSensor" position="75:25"/>
<sensor port="A3###input######sensorA3" type="TrikInfraredSensor" position="75:25"/>
<sensor port="LidarPort###input######lidar" type="TrikLidarSensor" position="75:25"/>
<sensor port="Video2Port###input######" type="TrikVideoCamera" position="60:25"/></sensors></robot></robots></root>"##;

const ITEMS: &[&str] = &[
    "wall", "can", "ball", "cube", "line", "box", "oval", "hand", "bow", "here", "round", "ring",
];
const DRAWN: &[&str] = &["line", "box", "oval", "hand", "bow"];
const REGIONS: &[&str] = &["here", "round", "ring"];
const SOLIDS: &[&str] = &["can", "ball", "cube"];
const STANDS: &[&str] = &[
    "wall", "line", "box", "oval", "hand", "bow", "here", "round", "ring",
];
const SCALARS: &[&str] = &[
    "robot1.A1",
    "robot1.A2",
    "robot1.A3",
    "robot1.D1",
    "robot1.E1",
    "robot1.Left",
    "robot1.objectSensorX",
    "robot1.objectSensorY",
    "robot1.objectSensorSize",
];
const VECTORS: &[&str] = &[
    "robot1.gyroscope",
    "robot1.accelerometer",
    "robot1.lineSensor",
    "robot1.colorSensor",
    "robot1.lidar",
];

/// Objects, a property that each of them has, its value at the start, and what a rule can do with it.
const FACTS: &[(&[&str], &str, &str, Write)] = &[
    (&["robot1"], "x", "0", Stays),
    (&["robot1"], "y", "0", Stays),
    (&["robot1"], "rotation", "0", Sets("-45.5", "-45.5")),
    (&["robot1"], "isRiding", "false", Stays),
    (
        &["robot1.M1", "robot1.S1"],
        "power",
        "0",
        Sets("150", "150"),
    ),
    (SCALARS, "value", "0", Sets("34", "34")),
    (SCALARS, "locked", "false", Sets("true", "true")),
    (VECTORS, "value", "", Stays),
    (VECTORS, "locked", "false", Sets("1", "true")),
    (&["robot1.display"], "smiles", "false", Stays),
    (&["robot1.display"], "sadSmiles", "false", Stays),
    (
        &["robot1.display"],
        "background",
        "#a0a0a4",
        Sets("#0f0", "#00ff00"),
    ),
    (&["robot1.display"], "objects", "", Stays),
    (&["robot1.display"], "pixels", "", Stays),
    (&["robot1.display"], "segments", "", Stays),
    (&["robot1.display"], "rectangles", "", Stays),
    (&["robot1.display"], "ellipses", "", Stays),
    (&["robot1.display"], "arcs", "", Stays),
    (&["robot1.display"], "labels", "", Stays),
    (&["robot1.shell"], "lastPhrase", "", Sets("so", "so")),
    (
        &["robot1.led"],
        "color",
        "#ffffff",
        Sets("green", "#008000"),
    ),
    (&["robot1.marker"], "isDown", "false", Sets("true", "true")),
    (&["robot1.random"], "fixedValue", "null", Sets("-99", "-99")),
    (&["robot1.random"], "callsCount", "0", Stays),
    (&["robot1.random"], "lastValue", "0", Stays),
    (
        &["robot1.speaker", "robot1.communicator"],
        "objectName",
        "",
        Stays,
    ),
    (STANDS, "x", "0", Sets("7.5", "7.5")),
    (STANDS, "y", "0", Sets("7.5", "7.5")),
    (SOLIDS, "x", "1", Sets("7.5", "7.5")),
    (SOLIDS, "y", "2", Sets("7.5", "7.5")),
    (ITEMS, "rotation", "0", Sets("30", "30")),
    (ITEMS, "pos", "", Stays),
    (&["wall"], "visible", "true", Sets("false", "false")),
    (SOLIDS, "visible", "true", Sets("", "false")),
    (DRAWN, "visible", "true", Sets("0", "false")),
    // As the attribute says, and it is not there.
    (REGIONS, "visible", "false", Sets("true", "true")),
    (ITEMS, "z", "0", Stays),
    (ITEMS, "opacity", "1", Stays),
    (ITEMS, "scale", "1", Stays),
    (ITEMS, "enabled", "true", Stays),
    (&["wall"], "mass", "0", Refused),
    (&["wall"], "friction", "1", Refused),
    // Floats, shown as the doubles that they are.
    (
        &["wall", "can", "ball", "cube"],
        "restitution",
        "0.800000011920929",
        Refused,
    ),
    (&["can"], "mass", "0.05000000074505806", Refused),
    (&["ball"], "mass", "0.014999999664723873", Refused),
    (&["cube"], "mass", "0.10000000149011612", Refused),
    (&["can"], "friction", "0.20000000298023224", Refused),
    (&["ball"], "friction", "1", Refused),
    (&["cube"], "friction", "0.30000001192092896", Refused),
    (&["can", "cube"], "linearDamping", "6", Refused),
    (&["ball"], "linearDamping", "0.09000000357627869", Refused),
    (&["can", "cube"], "angularDamping", "6", Refused),
    (&["ball"], "angularDamping", "0.09000000357627869", Refused),
    (DRAWN, "color", "#00ff00", Sets("blue", "#0000ff")),
    (DRAWN, "thickness", "4", Sets("20", "20")),
    (&["box", "oval"], "filled", "false", Sets("true", "true")),
    (REGIONS, "color", "#87cefa", Sets("#123456", "#123456")),
    (REGIONS, "filled", "true", Sets("false", "false")),
    (&["trace"], "size", "0", Stays),
    (&["trace"], "isEmpty", "true", Stays),
];

/// What the original does not have, although one may think so.
const ABSENT: &[(&str, &str)] = &[
    ("robot1.marker", "color"),
    ("robot1.M1", "value"),
    ("robot1.M1", "locked"),
    ("robot1.speaker", "volume"),
    ("robot1.display", "circles"),
    ("line", "filled"),
    ("bow", "filled"),
    ("hand", "filled"),
    ("here", "width"),
    ("here", "thickness"),
    ("wall", "linearDamping"),
    ("wall", "thickness"),
    ("ball", "color"),
    ("trace", "color"),
];

fn arena() -> Arena {
    let field = Field::read(WORLD).expect("a world").field;
    Arena::new(&field, Setup::default())
}

fn shown(arena: &mut Arena, name: &str, chain: &str) -> Result<String, Missing> {
    let object = arena.find(name).unwrap_or_else(|| panic!("no {name}"));
    let chain: Vec<Box<str>> = chain.split('.').map(Into::into).collect();
    let value = arena.property(object, &chain)?;
    Ok(if matches!(value, Value::Null) {
        "null".to_owned()
    } else {
        value.to_text()
    })
}

#[test]
fn every_property_is_what_it_is_in_the_original_and_is_set_as_there() {
    let mut wrong = Vec::new();
    for (names, property, start, write) in FACTS {
        for name in *names {
            let mut arena = arena();
            let object = arena.find(name).unwrap_or_else(|| panic!("no {name}"));
            let before = shown(&mut arena, name, property);
            let (text, is_taken, then) = match write {
                Sets(text, then) => (*text, true, *then),
                Stays => ("77", true, *start),
                Refused => ("77", false, *start),
            };
            let taken = arena.set_property(object, property, &Value::text(text));
            let after = shown(&mut arena, name, property);
            let wanted = (Ok((*start).to_owned()), is_taken, Ok(then.to_owned()));
            if (&before, taken, &after) != (&wanted.0, wanted.1, &wanted.2) {
                wrong.push(format!("{name}.{property}: {before:?} {taken} {after:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (name, property) in ABSENT {
        let mut arena = arena();
        let missing = shown(&mut arena, name, property);
        assert_eq!(missing, Err(Missing::Property(0)), "{name}.{property}");
        let object = arena.find(name).expect("it is there");
        assert!(!arena.set_property(object, property, &Value::text("1")));
    }
}

#[test]
fn no_property_and_no_class_is_without_a_row() {
    let mut arena = arena();
    let mut rows = Vec::new();
    for (names, property, ..) in FACTS {
        for name in *names {
            let object = arena.find(name).expect("rows name objects");
            rows.push((arena.type_of(object), *property));
        }
    }
    for name in arena.names() {
        let object = arena.find(&name).expect("it is there");
        let class = arena.type_of(object);
        for property in arena.properties(object) {
            let is_told = rows.contains(&(class, property));
            assert!(is_told, "nothing is told of {property} of a {class:?}");
        }
    }
    for class in CLASSES {
        let is_told = rows.iter().any(|(one, _)| *one == Some(*class));
        assert!(is_told, "nothing is told of {class}");
    }
}

/// Lists of a display, a property of what is in them, its value, and what a rule can do with it.
const FIGURES: &[(&str, &str, &str, Write)] = &[
    ("pixels", "x", "5", Sets("8", "8")),
    ("pixels", "y", "6", Sets("8", "8")),
    ("pixels", "pos.x", "5", Stays),
    ("pixels", "pos.y", "6", Stays),
    ("labels", "x", "7", Sets("9", "9")),
    ("labels", "y", "8", Sets("9", "9")),
    ("labels", "pos.x", "7", Stays),
    ("labels", "text", "hi", Sets("so", "so")),
    ("labels", "fontSize", "20", Sets("12", "12")),
    ("segments", "begin.x", "9", Stays),
    ("segments", "end.y", "2", Stays),
    ("segments", "boundingRect.width", "8", Stays),
    ("rectangles", "shape.width", "3", Stays),
    ("rectangles", "boundingRect.height", "4", Stays),
    ("rectangles", "filled", "false", Sets("true", "true")),
    ("ellipses", "center.x", "10", Stays),
    ("ellipses", "w", "3", Sets("6", "6")),
    ("ellipses", "h", "4", Sets("6", "6")),
    ("ellipses", "boundingRect.x", "7", Stays),
    ("ellipses", "filled", "true", Sets("false", "false")),
    // x + (w - 1) / 2 and y + (h - 1) / 2, rounded down.
    ("arcs", "ellipseCenter.x", "34", Stays),
    ("arcs", "ellipseCenter.y", "49", Stays),
    ("arcs", "ellipseRect.width", "40", Stays),
    ("arcs", "boundingRect.y", "25", Stays),
    ("arcs", "startAngle", "30", Sets("90", "90")),
    ("arcs", "spanAngle", "60", Sets("90", "90")),
];

/// The lists, each with one figure in it here.
const LISTS: [&str; 6] = [
    "pixels",
    "labels",
    "segments",
    "rectangles",
    "ellipses",
    "arcs",
];

fn drawn() -> Arena {
    let mut arena = arena();
    let mut robot = arena.robot(0);
    robot.command(Command::PenColor { color: "red" });
    robot.command(Command::PenWidth { width: 3 });
    robot.command(Command::Draw(Figure::Ellipse([10, 20, 3, 4], true)));
    robot.command(Command::Draw(Figure::Arc([15, 25, 40, 50, 30, 60])));
    robot.command(Command::Draw(Figure::Line([9, 8, 1, 2])));
    robot.command(Command::Draw(Figure::Pixel([5, 6])));
    robot.command(Command::Draw(Figure::Rectangle([1, 2, 3, 4], false)));
    let (x, y, size, text) = (7, 8, 20, "hi");
    robot.command(Command::Label { x, y, size, text });
    arena
}

#[test]
fn every_figure_of_a_display_has_the_properties_of_the_original() {
    let common = LISTS.iter().flat_map(|list| {
        [
            (*list, "color", "#ff0000", Sets("blue", "#0000ff")),
            (*list, "thickness", "3", Sets("5", "5")),
        ]
    });
    let rows: Vec<_> = FIGURES.iter().copied().chain(common).collect();
    for (list, property, start, write) in &rows {
        let mut arena = drawn();
        let chain = format!("{list}.first.{property}");
        assert_eq!(
            shown(&mut arena, "robot1.display", &chain),
            Ok((*start).to_owned()),
            "{chain}"
        );
        let display = arena.find("robot1.display").expect("it is there");
        let figure: [Box<str>; 2] = [(*list).into(), "first".into()];
        let (text, then) = match write {
            Sets(text, then) => (*text, *then),
            Stays | Refused => ("77", *start),
        };
        let name = property.split('.').next().unwrap_or_default();
        assert!(
            arena.set_within(display, &figure, name, &Value::text(text)),
            "{chain}"
        );
        assert_eq!(
            shown(&mut arena, "robot1.display", &chain),
            Ok(then.to_owned()),
            "{chain}"
        );
    }
    let mut arena = drawn();
    let display = arena.find("robot1.display").expect("it is there");
    for list in LISTS {
        let chain: [Box<str>; 2] = [list.into(), "first".into()];
        let Ok(Value::Record(fields)) = arena.property(display, &chain) else {
            panic!("{list} has no figure");
        };
        for (field, _) in fields.iter() {
            let is_told = |row: &(&str, &str, &str, Write)| {
                row.0 == list && row.1.split('.').next() == Some(*field)
            };
            assert!(
                rows.iter().any(is_told),
                "nothing is told of {list}.{field}"
            );
        }
        for absent in ["x1", "a", "semiX", "width"] {
            let chain: Vec<Box<str>> = vec![list.into(), "first".into(), absent.into()];
            assert!(arena.property(display, &chain).is_err(), "{list}.{absent}");
        }
    }
    for list in LISTS.iter().chain(&["objects"]) {
        let count = if *list == "objects" { "6" } else { "1" };
        assert_eq!(
            shown(&mut arena, "robot1.display", &format!("{list}.size")),
            Ok(count.to_owned())
        );
        assert_eq!(
            shown(&mut arena, "robot1.display", &format!("{list}.isEmpty")),
            Ok("false".to_owned())
        );
    }
}
