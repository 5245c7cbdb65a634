//! A world of TRIK Studio as a scene: pixels become metres, down becomes up.
//!
//! Owns what of a field people see and what lies over what; colours and dashes are those of pictures of judged runs. What is too
//! far away or too much is left out.

use super::{Item, Kind, Mark, Movable, Scene, Sensor, Shape, Wheel};
use crate::arena::{Arena, ranges};
use crate::field::{self, Blob, Drawn, Field, Image, Region, SensorKind, SolidKind};
use crate::geometry::{Point, Pose, point};
use crate::judge::picture::is_near;
use crate::judge::picture::shapes::{self, Style, colour};
use crate::limits;
use lang_diagram::stand_in::{PIXELS_IN_CM, Rolling};

/// Pixels in a metre.
pub const PIXELS_IN_M: f64 = PIXELS_IN_CM * 100.0;
/// Letters of a caption that people see.
const CAPTION_CHARS: usize = 200;

/// A place on the map.
pub fn place(at: Point) -> Point {
    point(at.x / PIXELS_IN_M, -at.y / PIXELS_IN_M)
}

/// A place of the field.
pub fn pixels(at: Point) -> Point {
    point(at.x * PIXELS_IN_M, -at.y * PIXELS_IN_M)
}

/// Everything that stands still; `start` is where the robot begins.
pub fn scene(arena: &Arena, start: Pose) -> Scene {
    let field = arena.field();
    let mut bounds = shapes::Bounds::default();
    shapes::bounds(field, &mut bounds);
    let begin = pixels(start.at);
    let reach = field::ROBOT_SIZE;
    bounds.add(begin.x - reach, begin.y - reach);
    bounds.add(begin.x + reach, begin.y + reach);
    let [left, top, width, height] = bounds.frame().map(|one| one / PIXELS_IN_M);
    let strokes = arena.trace();
    let newest = &strokes[strokes.len().saturating_sub(limits::STROKES_SHOWN)..];
    Scene {
        bounds: [left, -top - height, left + width, -top],
        floor: colour(&field.settings.background, "#ffffff"),
        items: items(field),
        marks: newest
            .iter()
            .map(|stroke| Mark {
                begin: place(stroke.begin),
                end: place(stroke.end),
                rgb: stroke.rgb,
            })
            .collect(),
        things: field.solids.iter().map(thing).collect(),
        start,
        robots: arena
            .robots()
            .iter()
            .map(|one| shape(one.description()))
            .collect(),
        ..Scene::default()
    }
}

fn thing(solid: &field::Solid) -> Movable {
    Movable {
        kind: match solid.kind {
            SolidKind::Skittle => "skittle",
            SolidKind::Ball => "ball",
            SolidKind::Cube => "cube",
        },
        size_m: solid.size / PIXELS_IN_M,
        colour: shapes::ink(solid.kind).to_owned(),
    }
}

/// What lies and stands on a field, the lowest first.
fn items(field: &Field) -> Vec<Item> {
    let mut all = Vec::new();
    let mut bytes = 0;
    for image in &field.images {
        if let Some(blob) = field.blobs.get(&image.image) {
            bytes += blob.text.len();
            if bytes <= limits::DRAWING_BYTES {
                all.extend(picture(image, blob));
            }
        }
    }
    all.extend(field.drawn.iter().map(drawn));
    for trace in &field.trace {
        let ink = colour(&trace.colour, "#000000");
        let ends = [trace.begin, trace.end];
        all.push(line(Kind::Line, &ends, &ink, trace.width));
    }
    for one in field.regions.iter().filter(|region| region.visible) {
        region(one, &mut all);
    }
    for wall in &field.walls {
        let ends = [wall.begin, wall.end];
        all.push(line(Kind::Wall, &ends, shapes::WALL, wall.width));
    }
    let limit = limits::FAR_PX / PIXELS_IN_M;
    all.retain(|item| {
        let is_near = |at: &Point| at.x.abs() < limit && at.y.abs() < limit;
        item.points.iter().all(is_near)
    });
    all
}

fn line(kind: Kind, points: &[Point], stroke: &str, width: f64) -> Item {
    let points = points.iter().copied().map(place).collect();
    Item::line(kind, points, stroke, width / PIXELS_IN_M)
}

fn styled(kind: Kind, points: &[Point], style: &Style) -> Item {
    let visible = |colour: &str| {
        let is_none = colour == "none";
        if is_none {
            String::new()
        } else {
            colour.to_owned()
        }
    };
    let opacity = style.fill_opacity.and_then(|text| text.parse().ok());
    Item {
        dashes_m: style.dashes.iter().map(|one| one / PIXELS_IN_M).collect(),
        fill: style.fill.as_deref().map(visible).unwrap_or_default(),
        opacity: opacity.unwrap_or(1.0),
        ..line(kind, points, &visible(&style.stroke), style.width)
    }
}

fn drawn(drawn: &Drawn) -> Item {
    let style = Style::of(&drawn.pen);
    let (kind, points) = match &drawn.shape {
        field::Shape::Line(a, b) => (Kind::Line, vec![*a, *b]),
        field::Shape::Rectangle(a, b) => (Kind::Rectangle, vec![*a, *b]),
        field::Shape::Ellipse(a, b) => (Kind::Ellipse, vec![*a, *b]),
        field::Shape::Curve(a, b, c, d) => (Kind::Curve, vec![*a, *b, *c, *d]),
        field::Shape::Stylus(strokes) => {
            let ends = strokes.iter().flat_map(|one| [one.begin, one.end]);
            (Kind::Strokes, ends.collect())
        }
    };
    styled(kind, &points, &style)
}

fn region(region: &Region, all: &mut Vec<Item>) {
    if !is_near(region.at) || !is_near(region.size) {
        return;
    }
    let [left, top, width, height] = shapes::upright(region.at, region.size);
    let corners = [point(left, top), point(left + width, top + height)];
    let ink = colour(&region.colour, "#87cefa");
    let kind = match &*region.kind {
        "ellipse" => Kind::Ellipse,
        "rectangle" => Kind::Rectangle,
        _ => return,
    };
    all.push(styled(kind, &corners, &Style::region(region, &ink)));
    if !region.text.is_empty() {
        let at = point(left + region.text_at.x, top + region.text_at.y);
        all.push(Item {
            text: region.text.chars().take(CAPTION_CHARS).collect(),
            ..line(Kind::Text, &[at], "", 0.0)
        });
    }
}

fn picture(image: &Image, blob: &Blob) -> Option<Item> {
    if !is_near(image.at) || !is_near(image.size) {
        return None;
    }
    let text = match blob.path.to_ascii_lowercase().ends_with(".svg") {
        true => vector(&blob.text),
        false => shapes::data(blob)?,
    };
    let [left, top, width, height] = shapes::upright(image.at, image.size);
    let corners = [point(left, top), point(left + width, top + height)];
    Some(Item {
        text,
        ..line(Kind::Image, &corners, "", 0.0)
    })
}

/// The text of an SVG as an address that holds it. A page shows it as a picture, in which no script runs.
fn vector(text: &str) -> String {
    use std::fmt::Write as _;
    let mut address = "data:image/svg+xml,".to_owned();
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b" -_.~/:;=,'()".contains(&byte) {
            address.push(char::from(byte));
        } else {
            let _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

/// A robot of TRIK as people see it.
fn shape(robot: &field::Robot) -> Shape {
    let rolling = Rolling::of_size(robot.size.x, robot.size.y);
    let wheel = |port: Option<lang_diagram::ports::Port>, side: f64| {
        port.map(|port| Wheel {
            port: port.name().to_owned(),
            at: point(
                rolling.axle / PIXELS_IN_M,
                side * rolling.track / 2.0 / PIXELS_IN_M,
            ),
            radius_m: rolling.radius / PIXELS_IN_M,
        })
    };
    let wheels = [wheel(robot.left, 1.0), wheel(robot.right, -1.0)];
    Shape {
        size_m: [robot.size.x / PIXELS_IN_M, robot.size.y / PIXELS_IN_M],
        is_round: false,
        wheels: wheels.into_iter().flatten().collect(),
        sensors: robot
            .sensors
            .iter()
            .filter_map(|one| sensor(robot, one))
            .collect(),
    }
}

/// A sensor that people see.
pub fn sensor(robot: &field::Robot, sensor: &field::Sensor) -> Option<Sensor> {
    let none = ranges::Beam {
        degrees: 0.0,
        reach_cm: 0,
    };
    let (kind, beam) = match sensor.kind {
        SensorKind::Infrared => ("infrared", ranges::INFRARED),
        SensorKind::Sonar => ("sonar", ranges::SONAR),
        SensorKind::Light => ("light", none),
        SensorKind::Touch => ("touch", none),
        SensorKind::Camera => ("camera", none),
        SensorKind::Lidar => ("lidar", ranges::LIDAR),
        SensorKind::Other => return None,
    };
    let port = sensor.port.map_or("", |port| port.name());
    let (x, y) = (
        sensor.at.x - robot.size.x / 2.0,
        sensor.at.y - robot.size.y / 2.0,
    );
    Some(Sensor {
        kind,
        port: port.to_owned(),
        at: place(point(x, y)),
        degrees: -sensor.direction,
        reach_m: f64::from(beam.reach_cm) / 100.0,
        beam_degrees: beam.degrees,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arena::Setup;

    fn of(text: &str) -> Scene {
        let field = Field::read(text).unwrap().field;
        scene(&Arena::new(&field, Setup::default()), Pose::default())
    }

    #[test]
    fn what_is_on_a_field_is_in_the_scene_from_below_to_above() {
        let scene = of(
            "<root version=\"20251219\"><settings backgroundColor=\"#fff0f0f0\"/><world>\
            <walls><wall begin=\"0:0\" end=\"285.714286:0\" id=\"w\"/></walls>\
            <colorFields><line begin=\"0:10\" end=\"100:10\" stroke=\"#ff000000\" stroke-width=\"6\"/>\
            <ellipse begin=\"0:20\" end=\"50:60\" stroke=\"#ff0000ff\" stroke-width=\"2\" fill=\"#80ff0000\" fill-style=\"solid\"/>\
            </colorFields><regions><region id=\"r\" type=\"rectangle\" x=\"10\" y=\"20\" width=\"40\" height=\"50\" filled=\"true\" \
            text=\"finish\" visible=\"true\"/></regions><balls><ball id=\"b\" x=\"100\" y=\"100\" markerX=\"100\" markerY=\"100\" \
            rotation=\"0\" startRotation=\"0\"/></balls></world></root>",
        );
        let kinds: Vec<Kind> = scene.items.iter().map(|item| item.kind).collect();
        let expected = [
            Kind::Line,
            Kind::Ellipse,
            Kind::Rectangle,
            Kind::Text,
            Kind::Wall,
        ];
        assert_eq!(kinds, expected);
        let wall = &scene.items[4];
        assert!((wall.points[1].x - 1.0).abs() < 1e-6, "{wall:?}");
        assert_eq!(scene.items[1].fill, "#ff000080");
        // Down on the field is down on the map, where y counts up.
        assert!(scene.items[1].points[0].y < 0.0);
        assert_eq!(scene.items[2].opacity, 0.18);
        assert_eq!(scene.items[3].text, "finish");
        assert_eq!(scene.things.len(), 1);
        let [left, bottom, right, top] = scene.bounds;
        assert!(left < 0.0 && bottom < -0.1 && right > 1.0 && top > 0.0);
    }

    #[test]
    fn a_picture_cannot_leave_its_address() {
        let address = vector("<svg onload=\"x\">\u{e9}\n#</svg>");
        assert_eq!(
            address,
            "data:image/svg+xml,%3Csvg onload=%22x%22%3E%C3%A9%0A%23%3C/svg%3E"
        );
    }

    #[test]
    fn sensors_are_where_they_are_on_the_robot() {
        let robot = field::Robot::default();
        let mut one = field::Sensor::new(
            lang_diagram::ports::Port::named("D1").unwrap(),
            SensorKind::Sonar,
        );
        one.at = point(50.0, 0.0);
        one.direction = 90.0;
        let seen = sensor(&robot, &one).unwrap();
        assert!(seen.at.x > 0.0 && seen.at.y > 0.0, "ahead and left");
        assert_eq!(
            (seen.degrees, seen.reach_m, seen.kind),
            (-90.0, 3.0, "sonar")
        );
    }
}
