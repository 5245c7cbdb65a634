//! A floor as sensors see it: windows, traces, pictures, fields; noise; and what must not happen.

use super::*;
use crate::geometry::point;

fn black_right_half() -> Floor {
    let mut floor = Floor::default();
    let path = outline::rectangle(point(0.0, -1e4), point(1e4, 1e4)).unwrap();
    let outline = Outline::inside(&path, &Affine::SAME, raster::Rule::NonZero).unwrap();
    floor.add_area(outline, Tint::solid([0; 3]));
    floor
}

fn seen(floor: &mut Floor, at: Point, degrees: f64, side: u16, part: f64) -> Window {
    let mut window = Window::default();
    floor.view(at, degrees, side, part, &mut window);
    window
}

#[test]
fn windows_have_the_sizes_of_the_original() {
    let mut floor = Floor::default();
    for (side, part, pixels) in [(12, 1.0, 11), (18, 2.0, 35), (18, 0.3, 5), (18, 0.2, 3)] {
        for degrees in [0.0, 45.0, 90.0, 123.4, -270.0, 1e9] {
            let window = seen(&mut floor, point(3.0, 4.0), degrees, side, part);
            assert_eq!(window.side, pixels);
            assert!(window.pixels.iter().all(|pixel| *pixel == [255; 3]));
        }
    }
}

#[test]
fn up_is_where_the_sensor_looks() {
    let mut floor = black_right_half();
    // Looking to the right: what is ahead is black and at the top.
    let window = seen(&mut floor, point(0.0, 0.0), 0.0, 12, 1.0);
    assert_eq!(window.pixels[5], [0; 3]);
    assert_eq!(window.pixels[10 * 11 + 5], [255; 3]);
    // Looking down: what is to the right of the scene is at the left.
    let window = seen(&mut floor, point(0.0, 0.0), 90.0, 12, 1.0);
    assert_eq!(window.pixels[5 * 11], [0; 3]);
    assert_eq!(window.pixels[5 * 11 + 10], [255; 3]);
    // The same at angles that are turned pixel by pixel.
    let window = seen(&mut floor, point(0.0, 0.0), 89.0, 12, 1.0);
    assert_eq!(window.pixels[5 * 11], [0; 3]);
    assert_eq!(window.pixels[5 * 11 + 10], [255; 3]);
}

#[test]
fn markers_leave_what_can_be_seen_and_wiped() {
    let mut floor = Floor::default();
    let red = Stroke {
        begin: point(-20.0, 0.0),
        end: point(20.0, 0.0),
        rgb: [255, 0, 0],
    };
    floor.mark(red);
    floor.mark(Stroke {
        end: red.begin,
        ..red
    });
    assert_eq!(floor.trace(), [red]);
    let window = seen(&mut floor, point(0.0, 0.0), 0.0, 12, 1.0);
    let count = window
        .pixels
        .iter()
        .filter(|pixel| **pixel == [255, 0, 0])
        .count();
    assert!((50..70).contains(&count), "{count} of 121 pixels are red");
    floor.wipe();
    assert!(floor.trace().is_empty());
    let window = seen(&mut floor, point(0.0, 0.0), 0.0, 12, 1.0);
    assert!(window.pixels.iter().all(|pixel| *pixel == [255; 3]));
}

#[test]
fn pixels_of_pictures_are_seen_where_they_lie() {
    let mut floor = Floor::default();
    let mut pixels = Pixels::new(2, 1, Some(screen::colour::BLACK));
    pixels.set(1, 0, screen::colour::colour(0, 255, 0));
    let own = Affine([0.5, 0.0, 0.0, 1.0, 0.0, 0.0]);
    let picture = picture::Picture {
        layers: vec![picture::Layer::Pixels(pixels.into(), own)],
        lacks: Vec::new(),
    };
    // 200 x 100 at (10, 20).
    floor.add_picture(&picture, &Affine([200.0, 0.0, 0.0, 100.0, 10.0, 20.0]));
    for (x, colour) in [(60.0, [0; 3]), (160.0, [0, 255, 0]), (300.0, [255; 3])] {
        let window = seen(&mut floor, point(x, 70.0), 30.0, 18, 0.3);
        assert!(window.pixels.iter().all(|pixel| *pixel == colour), "at {x}");
    }
}

#[test]
fn gradients_of_pictures_are_seen_where_they_lie() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10'><defs>\
        <linearGradient id='g'><stop offset='0' stop-color='black'/><stop offset='1' stop-color='white'/></linearGradient>\
        <radialGradient id='r'><stop offset='0' stop-color='red'/><stop offset='1' stop-color='blue'/></radialGradient>\
        </defs><rect width='10' height='5' fill='url(#g)'/><circle cx='5' cy='7.5' r='2.5' fill='url(#r)'/></svg>";
    let picture = picture::Picture::read("g.svg", text).unwrap();
    assert!(picture.lacks.is_empty(), "{:?}", picture.lacks);
    let mut floor = Floor::default();
    floor.add_picture(&picture, &Affine([200.0, 0.0, 0.0, 200.0, 100.0, 0.0]));
    let mut middle = |x: f64, y: f64| {
        let window = seen(&mut floor, point(x, y), 0.0, 12, 1.0);
        window.pixels[window.side * window.side / 2]
    };
    for (x, gray) in [(120.0, 25.5), (200.0, 127.5), (280.0, 229.5)] {
        let seen = middle(x, 50.0);
        assert!(
            seen.iter()
                .all(|part| (f64::from(*part) - gray).abs() < 2.0),
            "{x}: {seen:?}"
        );
    }
    let [red, _, blue] = middle(200.0, 150.0);
    assert!(red > 245 && blue < 10, "{red} {blue}");
    let [red, _, blue] = middle(225.0, 150.0);
    assert!(
        (120..136).contains(&red) && (120..136).contains(&blue),
        "{red} {blue}"
    );
}

#[test]
fn places_that_are_none_are_white() {
    let mut floor = black_right_half();
    for place in [f64::NAN, f64::INFINITY, 1e308] {
        let window = seen(&mut floor, point(place, 0.0), 10.0, 12, 1.0);
        assert_eq!(window.pixels[0], [255; 3]);
    }
    let window = seen(&mut floor, point(0.0, 0.0), f64::NAN, 12, 1.0);
    assert_eq!(window.side, 11);
}

/// What a light sensor would see in the middle of a window.
fn middle(text: &str, x: f64) -> [u8; 3] {
    let field = crate::field::Field::read(text).unwrap().field;
    let (mut floor, _) = lay(&field);
    let window = seen(&mut floor, point(x, 0.0), 0.0, 12, 1.0);
    window.pixels[window.pixels.len() / 2]
}

#[test]
fn walls_are_seen_as_strips_of_one_width_with_their_pens() {
    let text = "<root version=\"20251219\"><world><walls>\
        <wall id=\"a\" begin=\"0:-50\" end=\"0:50\" stroke=\"#ff000000\" stroke-width=\"0\" stroke-style=\"none\"/>\
        <wall id=\"b\" begin=\"100:-50\" end=\"100:50\" stroke=\"#ffff0000\" stroke-width=\"30\" stroke-style=\"solid\"/>\
        </walls></world><settings/></root>";
    let bricks = middle(text, 0.0);
    assert!(bricks != [255; 3] && bricks[0] > bricks[2], "{bricks:?}");
    assert_eq!(middle(text, 12.0), [255; 3]);
    assert_eq!(middle(text, 110.0), [255, 0, 0]);
    // The pen is there, but a window that does not meet the strip does not see it.
    assert_eq!(middle(text, 116.0), [255; 3]);
}

#[test]
fn a_stylus_is_looked_for_where_its_points_are() {
    let text = "<root version=\"20251219\"><world><colorFields>\
        <stylus id=\"s\" stroke=\"#ff000000\" stroke-width=\"40\" stroke-style=\"solid\">\
        <stylusLine begin=\"0:-50\" end=\"0:50\"/></stylus>\
        <line id=\"l\" begin=\"100:-50\" end=\"100:50\" stroke=\"#ff000000\" stroke-width=\"40\" stroke-style=\"solid\"/>\
        </colorFields></world><settings/></root>";
    assert_eq!(middle(text, 4.0), [0; 3]);
    assert_eq!(middle(text, 8.0), [255; 3]);
    assert_eq!(middle(text, 110.0), [0; 3]);
}

#[test]
fn fields_are_laid_and_what_cannot_be_shown_is_told() {
    use crate::field::{Drawn, Field, Pen, Shape};
    let text = "<root version=\"20251219\"><world><colorFields>\
        <line id=\"a\" begin=\"0:-50\" end=\"0:50\" stroke=\"#ff0000\" stroke-width=\"40\" stroke-style=\"solid\"/>\
        <ellipse id=\"b\" begin=\"60:-20\" end=\"100:20\" stroke=\"blu\" stroke-width=\"4\" stroke-style=\"none\" fill=\"#0000ff\" fill-style=\"solid\"/>\
        </colorFields><images><image id=\"i\" imageId=\"none\" rect=\"0:0:10:10\" position=\"0:0\" isBackground=\"false\"/>\
        </images></world><settings backgroundColor=\"#00ff00\"/></root>";
    let field = Field::read(text).unwrap().field;
    let (mut floor, problems) = lay(&field);
    assert!(
        problems
            .iter()
            .any(|problem| problem.words.english.contains("none")),
        "{problems:?}"
    );
    for (x, colour) in [
        (0.0, [255, 0, 0]),
        (80.0, [0, 0, 255]),
        // The colour of the scene is for people only.
        (-200.0, [255, 255, 255]),
    ] {
        let window = seen(&mut floor, point(x, 0.0), 12.0, 12, 1.0);
        assert!(window.pixels.iter().all(|pixel| *pixel == colour), "at {x}");
    }
    let mut field = Field::default();
    let pen = Pen {
        colour: "blu".to_owned(),
        width: 3.0,
        ..Pen::default()
    };
    let line = Shape::Line(point(0.0, 0.0), point(9.0, 9.0));
    field.drawn.push(Drawn::new(line, pen));
    let (_, problems) = lay(&field);
    assert!(problems[0].words.english.contains("'blu' is no colour"));
}

#[test]
fn many_dashes_are_one_line() {
    let path = outline::line(point(0.0, 0.0), point(9e5, 0.0)).unwrap();
    let nib = |width, style| Nib {
        width,
        style,
        cap: Cap::Flat,
    };
    let whole = Outline::drawn(&path, nib(1.0, "dash")).unwrap();
    assert!(whole.len() < 20);
    let dashed = Outline::drawn(&path, nib(100.0, "dash")).unwrap();
    assert!(dashed.len() > 2000, "{}", dashed.len());
}

/// A robot with a light sensor behind it and a camera ahead of it, on an empty field.
fn robot_with_sensors(is_noisy: bool) -> crate::arena::Arena {
    use crate::field::{Field, Robot, Sensor, SensorKind};
    use lang_diagram::ports::Port;
    let mut robot = Robot::default();
    let mut light = Sensor::new(Port::named("A1").unwrap(), SensorKind::Light);
    light.at = point(-20.0, 25.0);
    let camera = Sensor::new(Port::named("LineSensorPort").unwrap(), SensorKind::Camera);
    robot.sensors = vec![light, camera];
    let mut field = Field::default();
    field.settings.realistic_sensors = is_noisy;
    field.robots.push(robot);
    let setup = crate::arena::Setup {
        seed: 11,
        ..Default::default()
    };
    crate::arena::Arena::new(&field, setup)
}

#[test]
fn sensors_see_what_a_marker_has_left() {
    use lang_diagram::brick::{Brick, Command};
    use lang_diagram::ports::Port;
    let mut arena = robot_with_sensors(false);
    let port = |name| Port::named(name).unwrap();
    assert_eq!(arena.robot(0).scalar(port("A1")), Some(0));
    let mut line = Vec::new();
    assert!(arena.robot(0).vector(port("LineSensorPort"), &mut line));
    assert_eq!(line, [0, 0, 0]);
    arena
        .robot(0)
        .command(Command::MarkerDown { color: "black" });
    for name in ["M3", "M4"] {
        let port = port(name);
        arena
            .robot(0)
            .command(Command::Power { port, percent: 100 });
    }
    for _ in 0..200 {
        arena.tick();
    }
    // A line of 6 px under a window of 11.
    let light = arena.robot(0).scalar(port("A1")).unwrap();
    assert!((45..65).contains(&light), "{light}");
    assert!(arena.trace().len() > 190);
    // Back over it: the camera is ahead and sees it in the middle.
    for name in ["M3", "M4"] {
        let port = port(name);
        arena.robot(0).command(Command::Power {
            port,
            percent: -100,
        });
    }
    arena.robot(0).command(Command::MarkerUp);
    let marks = arena.trace().len();
    for _ in 0..100 {
        arena.tick();
    }
    assert_eq!(arena.trace().len(), marks);
    line.clear();
    assert!(arena.robot(0).vector(port("LineSensorPort"), &mut line));
    assert!(line[0].abs() <= 3 && (5..=7).contains(&line[2]), "{line:?}");
    // It learns another colour, and black is no line any more.
    arena
        .robot_mut(0)
        .unwrap()
        .put(lang_diagram::stand_in::Pose::default());
    arena.robot(0).command(Command::Detect { mode: "line" });
    line.clear();
    arena.robot(0).vector(port("ColorSensorPort"), &mut line);
    assert_eq!(line.len(), 3);
}

#[test]
fn noise_is_the_same_for_the_same_seed() {
    use lang_diagram::brick::Brick;
    use lang_diagram::ports::Port;
    let readings = || {
        let mut arena = robot_with_sensors(true);
        (0..50)
            .map(|_| arena.robot(0).scalar(Port::named("A1").unwrap()).unwrap())
            .collect::<Vec<_>>()
    };
    let first = readings();
    assert_eq!(first, readings());
    assert!(first.iter().any(|reading| *reading > 0), "{first:?}");
}

#[test]
fn a_look_meets_only_what_lies_around_it() {
    let mut floor = Floor::default();
    for index in 0..5000 {
        let at = f64::from(index);
        floor.mark(Stroke {
            begin: point(at, 0.0),
            end: point(at + 1.0, 0.0),
            rgb: [0; 3],
        });
    }
    for index in [0, 700, 2500, 4990] {
        seen(&mut floor, point(f64::from(index), 0.0), 33.0, 18, 2.0);
        let looked_at = floor.found.len();
        assert!((10..500).contains(&looked_at), "{looked_at} of 5000");
    }
}
