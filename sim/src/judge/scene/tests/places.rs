//! Places: what is inside of a region, wholly or in part, and where things without a place are.

use super::*;

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
