//! Every attribute of every tag of a world: what becomes of it.
//!
//! Each row was written by hand: attributes, and what a field then has that it does not have without them. An attribute that
//! the table of tags knows and no row names fails the test.

use std::collections::BTreeSet;

use super::Field;
use super::table::KINDS;
use lang_diagram::ports::Port;

const SOLIDS: &[&str] = &["skittles/skittle", "balls/ball", "cubes/cube"];
const ROUND: &[&str] = &["skittles/skittle", "balls/ball"];
const MADE: &[&str] = &[
    "walls/wall",
    "skittles/skittle",
    "balls/ball",
    "cubes/cube",
    "world/robot",
    "robots/robot",
    "world/wheels",
];
const DRAWN: &[&str] = &[
    "colorFields/line",
    "colorFields/rectangle",
    "colorFields/ellipse",
    "colorFields/cubicBezier",
    "colorFields/stylus",
    "stylus/stylusLine",
];
const STRETCHED: &[&str] = &[
    "colorFields/line",
    "colorFields/rectangle",
    "colorFields/ellipse",
    "colorFields/cubicBezier",
    "stylus/stylusLine",
    "walls/wall",
    "comments/comment",
];
const THINGS: &[&str] = &[
    "walls/wall",
    "skittles/skittle",
    "balls/ball",
    "cubes/cube",
    "colorFields/line",
    "colorFields/rectangle",
    "colorFields/ellipse",
    "colorFields/cubicBezier",
    "colorFields/stylus",
    "comments/comment",
    "images/image",
    "world/background",
    "regions/region",
    "robots/robot",
];
const IMAGES: &[&str] = &["images/image", "world/background"];
const ROBOTS: &[&str] = &["world/robot", "robots/robot"];

/// Tags, one of their attributes, how it is written, with those that it needs beside it, and what a field then has. `PORT`
/// is the port M1, `SENSED` A1.
const FACTS: &[(&[&str], &str, &str, &str)] = &[
    (
        &["root"],
        "version",
        r#"version="20190101""#,
        "version: Some(\"20190101\")",
    ),
    (&["root/settings"], "sizeUnit", r#"sizeUnit="m""#, "Metres"),
    (
        &["root/settings"],
        "realisticPhysics",
        r#"realisticPhysics="true""#,
        "realistic_physics: true",
    ),
    (
        &["root/settings"],
        "realisticSensors",
        r#"realisticSensors="true""#,
        "realistic_sensors: true",
    ),
    (
        &["root/settings"],
        "realisticMotors",
        r#"realisticMotors="true""#,
        "realistic_motors: true",
    ),
    (
        &["root/settings"],
        "backgroundColor",
        r##"backgroundColor="#123456""##,
        "background: \"#123456\"",
    ),
    (THINGS, "id", r#"id="mine""#, "id: \"mine\""),
    (MADE, "mass", r#"mass="3""#, "mass: 3.0"),
    (MADE, "friction", r#"friction="0.25""#, "friction: 0.25"),
    (
        MADE,
        "restitution",
        r#"restitution="0.35""#,
        "restitution: 0.35",
    ),
    (
        MADE,
        "angularDamping",
        r#"angularDamping="0.45""#,
        "angular_damping: 0.45",
    ),
    (
        MADE,
        "linearDamping",
        r#"linearDamping="0.55""#,
        "linear_damping: 0.55",
    ),
    (
        STRETCHED,
        "begin",
        r#"begin="11:22""#,
        "Point { x: 11.0, y: 22.0 }",
    ),
    (
        STRETCHED,
        "end",
        r#"end="33:44""#,
        "Point { x: 33.0, y: 44.0 }",
    ),
    // A pen's width is that of the wall.
    (
        &["walls/wall"],
        "stroke-width",
        r#"stroke-width="30""#,
        "width: 30.0",
    ),
    (
        &["walls/wall"],
        "stroke",
        r##"stroke-width="30" stroke="#ff0000""##,
        "Pen { colour: \"#ff0000\"",
    ),
    (
        &["walls/wall"],
        "stroke-style",
        r#"stroke-width="30" stroke-style="dash""#,
        "style: \"dash\", fill",
    ),
    (
        DRAWN,
        "stroke",
        r##"stroke="#ff0000""##,
        "colour: \"#ff0000\"",
    ),
    (DRAWN, "stroke-width", r#"stroke-width="30""#, "width: 30.0"),
    (
        DRAWN,
        "stroke-style",
        r#"stroke-style="dash""#,
        "style: \"dash\", fill",
    ),
    (DRAWN, "fill", r##"fill="#00ff00""##, "fill: \"#00ff00\""),
    (
        DRAWN,
        "fill-style",
        r#"fill-style="solid""#,
        "fill_style: \"solid\"",
    ),
    (
        &["colorFields/cubicBezier"],
        "cp1",
        r#"cp1="1:2""#,
        "Point { x: 1.0, y: 2.0 }",
    ),
    (
        &["colorFields/cubicBezier"],
        "cp2",
        r#"cp2="3:4""#,
        "Point { x: 3.0, y: 4.0 }",
    ),
    (
        SOLIDS,
        "x",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        SOLIDS,
        "y",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    // Of the corner: the centre is half the size aside.
    (
        &["skittles/skittle"],
        "begin",
        r#"begin="7:8""#,
        "at: Point { x: 17.0, y: 18.0 }",
    ),
    (
        &["balls/ball"],
        "begin",
        r#"begin="7:8""#,
        "at: Point { x: 22.0, y: 23.0 }",
    ),
    (
        &["cubes/cube"],
        "begin",
        r#"begin="7:8" edgeSize="10""#,
        "at: Point { x: 12.0, y: 13.0 }",
    ),
    (SOLIDS, "rotation", r#"rotation="30""#, "rotation: 30.0"),
    (
        SOLIDS,
        "markerX",
        r#"markerX="7" markerY="8""#,
        "start: Point { x: 7.0, y: 8.0 }",
    ),
    (
        SOLIDS,
        "markerY",
        r#"markerX="7" markerY="8""#,
        "start: Point { x: 7.0, y: 8.0 }",
    ),
    (
        SOLIDS,
        "startRotation",
        r#"startRotation="30""#,
        "start_rotation: 30.0",
    ),
    (ROUND, "diameter", r#"diameter="77""#, "size: 77.0"),
    (
        &["cubes/cube"],
        "edgeSize",
        r#"edgeSize="77""#,
        "size: 77.0",
    ),
    (
        &["trace/segment"],
        "x1",
        r#"x1="7" y1="8""#,
        "begin: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["trace/segment"],
        "y1",
        r#"x1="7" y1="8""#,
        "begin: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["trace/segment"],
        "x2",
        r#"x2="7" y2="8""#,
        "end: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["trace/segment"],
        "y2",
        r#"x2="7" y2="8""#,
        "end: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["trace/segment"],
        "color",
        r#"color="blue""#,
        "colour: \"blue\"",
    ),
    (&["trace/segment"], "width", r#"width="77""#, "width: 77.0"),
    (
        &["comments/comment"],
        "text",
        r#"text="so""#,
        "text: \"so\"",
    ),
    (IMAGES, "imageId", r#"imageId="it""#, "image: \"it\""),
    (
        IMAGES,
        "rect",
        r#"rect="1:2:33:44""#,
        "at: Point { x: 1.0, y: 2.0 }, size: Point { x: 33.0, y: 44.0 }",
    ),
    (
        IMAGES,
        "position",
        r#"position="10:20" rect="1:2:33:44""#,
        "at: Point { x: 11.0, y: 22.0 }",
    ),
    (
        IMAGES,
        "backgroundRect",
        r#"backgroundRect="1:2:33:44""#,
        "size: Point { x: 33.0, y: 44.0 }, is_background: true",
    ),
    (
        &["images/image"],
        "isBackground",
        r#"isBackground="true""#,
        "is_background: true",
    ),
    (
        &["world/background"],
        "isBackground",
        r#"isBackground="false""#,
        "is_background: false",
    ),
    (
        IMAGES,
        "path",
        r#"path="a.png""#,
        "path: \"a.png\", is_external: false",
    ),
    (
        IMAGES,
        "external",
        r#"path="a.png" external="true""#,
        "path: \"a.png\", is_external: true",
    ),
    (
        &["regions/region"],
        "type",
        r#"type="Rectangle""#,
        "kind: \"Rectangle\"",
    ),
    (
        &["regions/region"],
        "boundItem",
        r#"boundItem="it""#,
        "bound: \"it\"",
    ),
    (
        &["regions/region"],
        "x",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "y",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "width",
        r#"width="7" height="8""#,
        "size: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "height",
        r#"width="7" height="8""#,
        "size: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "textX",
        r#"textX="7" textY="8""#,
        "text_at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "textY",
        r#"textX="7" textY="8""#,
        "text_at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["regions/region"],
        "filled",
        r#"filled="false""#,
        "filled: false",
    ),
    (
        &["regions/region"],
        "visible",
        r#"visible="true""#,
        "visible: true",
    ),
    (&["regions/region"], "stroke", r#"stroke="7""#, "ring: 7.0"),
    (
        &["regions/region"],
        "color",
        r#"color="blue""#,
        "colour: \"blue\"",
    ),
    (&["regions/region"], "text", r#"text="so""#, "text: \"so\""),
    (
        ROBOTS,
        "position",
        r#"position="7:8""#,
        "position: Point { x: 7.0, y: 8.0 }",
    ),
    (ROBOTS, "direction", r#"direction="77""#, "direction: 77.0"),
    (
        ROBOTS,
        "width",
        r#"width="77""#,
        "size: Point { x: 77.0, y: 50.0 }",
    ),
    (
        ROBOTS,
        "height",
        r#"height="77""#,
        "size: Point { x: 50.0, y: 77.0 }",
    ),
    (
        &["robot/startPosition"],
        "x",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["robot/startPosition"],
        "y",
        r#"x="7" y="8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["robot/startPosition"],
        "direction",
        r#"direction="77""#,
        "direction: 77.0",
    ),
    (
        &["sensors/sensor"],
        "type",
        r#"type="a::TrikTouchSensor""#,
        "kind: Touch",
    ),
    (
        &["sensors/sensor"],
        "position",
        r#"position="7:8""#,
        "at: Point { x: 7.0, y: 8.0 }",
    ),
    (
        &["sensors/sensor"],
        "direction",
        r#"direction="77""#,
        "direction: 77.0",
    ),
    (
        &["sensors/sensor"],
        "port",
        r#"port="A1###input######""#,
        "port: SENSED",
    ),
    (
        &["robot/wheels"],
        "left",
        r#"left="M1###output######""#,
        "left: PORT",
    ),
    (
        &["robot/wheels"],
        "right",
        r#"right="M1###output######""#,
        "right: PORT",
    ),
];

/// A world with one tag, and with its attributes.
fn world(path: &str, attributes: &str) -> String {
    let (outside, tag) = path.split_once('/').unwrap_or(("", path));
    let settings = r#"<settings sizeUnit="px"/>"#;
    let it = format!("<{tag} {attributes}/>");
    let robot = |inside: &str| {
        format!(
            "<root>{settings}<world/><robots><robot id=\"trikKitRobot\">{inside}</robot></robots></root>"
        )
    };
    let world = |inside: &str| {
        format!(
            "<root>{settings}<world>{inside}</world><robots><robot id=\"trikKitRobot\"/></robots></root>"
        )
    };
    match outside {
        "" => format!("<root {attributes}>{settings}<world/><robots/></root>"),
        "root" => format!("<root><world/><robots/>{it}</root>"),
        "world" => world(&it),
        "robots" => format!("<root>{settings}<world/><robots>{it}</robots></root>"),
        "robot" => robot(&it),
        "sensors" => robot(&format!("<sensors>{it}</sensors>")),
        "stylus" => world(&format!("<colorFields><stylus>{it}</stylus></colorFields>")),
        list => world(&format!("<{list}>{it}</{list}>")),
    }
}

/// All that a field has, without the texts from which it was read.
fn told(text: &str) -> String {
    let field = Field::read(text)
        .unwrap_or_else(|why| panic!("{text}: {why:?}"))
        .field;
    let pens: Vec<_> = field.walls.iter().map(super::Wall::pen).collect();
    format!("{field:?} {pens:?}")
}

#[test]
fn every_attribute_becomes_what_it_is_and_none_is_without_a_row() {
    let mut rows = BTreeSet::new();
    let mut wrong = Vec::new();
    for (paths, attribute, written, has) in FACTS {
        for path in *paths {
            rows.insert((*path, (*attribute).to_owned()));
            assert!(
                written.contains(&format!("{attribute}=")),
                "{path} {attribute}"
            );
            let has = has.replace("PORT", &format!("{:?}", Port::named("M1")));
            let has = has.replace("SENSED", &format!("{:?}", Port::named("A1")));
            let (with, without) = (told(&world(path, written)), told(&world(path, "")));
            if !with.contains(&has) || without.contains(&has) {
                wrong.push(format!("{path} {written} is not {has}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for kind in KINDS {
        for attribute in kind.attributes() {
            let is_told = rows.contains(&(kind.path, attribute.clone()));
            assert!(is_told, "nothing is told of {attribute} of {}", kind.path);
        }
    }
}
