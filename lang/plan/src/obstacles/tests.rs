//! Tests of obstacles: what is met and what is not, in poses and on the way.

use super::super::random::Random;
use super::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn at(x: f64, y: f64, heading: f64) -> Pose {
    Pose {
        at: [x, y],
        heading,
    }
}

fn square() -> Footprint {
    Footprint::polygon(vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]).unwrap()
}

/// A cup that is open above.
fn cup() -> Shape {
    Shape::Polygon(vec![
        [0.0, 0.0],
        [6.0, 0.0],
        [6.0, 4.0],
        [5.0, 4.0],
        [5.0, 1.0],
        [1.0, 1.0],
        [1.0, 4.0],
        [0.0, 4.0],
    ])
}

#[test]
fn a_disc_meets_what_is_nearer_than_its_radius() {
    let cup = Obstacles::new(vec![cup()], None).unwrap();
    let disc = Footprint::circle(1.5).unwrap();
    assert!(!cup.meets(&disc, at(3.0, 2.6, 0.0), 0.0));
    assert!(cup.meets(&disc, at(3.0, 2.6, 0.0), 0.2), "the floor");
    assert!(cup.meets(&disc, at(2.4, 2.6, 0.0), 0.0), "a side");
    let point = Footprint::circle(0.0).unwrap();
    assert!(cup.meets(&point, at(0.5, 2.0, 0.0), 0.0), "inside");
    assert!(!cup.meets(&point, at(3.0, 2.0, 0.0), 0.0), "in the cup");
}

#[test]
fn a_polygon_turns_with_the_heading() {
    let wall = Shape::Wall([3.0, -9.0], [3.0, 9.0], 0.5);
    let obstacles = Obstacles::new(vec![wall], None).unwrap();
    assert!(!obstacles.meets(&square(), at(1.5, 0.0, 0.0), 0.0));
    assert!(obstacles.meets(&square(), at(1.5, 0.0, FRAC_PI_4), 0.0));
    assert!(!obstacles.meets(&square(), at(1.5, 0.0, FRAC_PI_2), 0.0));
    assert!(
        obstacles.meets_between(
            &square(),
            at(1.5, 0.0, 0.0),
            at(1.5, 0.0, FRAC_PI_2),
            0.1,
            &mut Vec::new()
        ),
        "its corner on the way"
    );
}

#[test]
fn what_is_wholly_inside_of_the_other_is_met() {
    let small = Shape::Rectangle([-0.1, -0.1], [0.1, 0.1]);
    let obstacles = Obstacles::new(vec![small], None).unwrap();
    assert!(obstacles.meets(&square(), at(0.3, 0.0, 0.2), 0.0));
    let large = Shape::Rectangle([9.0, 9.0], [-9.0, -9.0]);
    let obstacles = Obstacles::new(vec![large], None).unwrap();
    assert!(obstacles.meets(&square(), at(0.3, 0.0, 0.2), 0.0));
    let disc = Obstacles::new(vec![Shape::Circle([0.0, 0.0], 9.0)], None).unwrap();
    assert!(disc.meets(&square(), at(3.0, 0.0, 0.2), 0.0));
    assert!(!disc.meets(&square(), at(10.1, 0.0, 0.0), 0.0));
}

#[test]
fn a_wall_without_thickness_is_not_jumped_over() {
    let wall = Shape::Wall([1.0, -1.0], [1.0, 1.0], 0.0);
    let obstacles = Obstacles::new(vec![wall], None).unwrap();
    let point = Footprint::circle(0.0).unwrap();
    let mut random = Random::new(4);
    for _ in 0..2000 {
        let from = at(random.between(0.0, 0.9), random.between(-0.5, 0.5), 0.0);
        let to = at(random.between(1.1, 2.0), random.between(-0.5, 0.5), 0.0);
        assert!(obstacles.meets_between(&point, from, to, 0.1, &mut Vec::new()));
    }
    let beside = (at(0.0, 2.0, 0.0), at(2.0, 2.0, 0.0));
    assert!(!obstacles.meets_between(&point, beside.0, beside.1, 0.1, &mut Vec::new()));
}

#[test]
fn a_robot_stays_in_the_workspace_with_all_of_it() {
    let obstacles = Obstacles::new(vec![], Some([0.0, 0.0, 4.0, 4.0])).unwrap();
    assert!(!obstacles.meets(&square(), at(1.1, 1.1, 0.0), 0.0));
    assert!(obstacles.meets(&square(), at(1.1, 1.1, FRAC_PI_4), 0.0));
    assert!(obstacles.meets(&square(), at(1.1, 1.1, 0.0), 0.2));
    assert!(obstacles.meets(&square(), at(9.0, 2.0, 0.0), 0.0));
}

#[test]
fn a_pose_that_is_no_number_meets_something() {
    let none = Obstacles::default();
    let point = Footprint::circle(0.0).unwrap();
    for bad in [f64::NAN, f64::INFINITY, 1e308] {
        assert!(none.meets(&point, at(bad, 0.0, 0.0), 0.0));
        assert!(none.meets_between(
            &point,
            at(0.0, 0.0, 0.0),
            at(0.0, bad, 0.0),
            0.1,
            &mut vec![]
        ));
    }
    assert!(none.meets(&square(), at(0.0, 0.0, f64::NAN), 0.0));
    assert!(!none.meets(&square(), at(0.0, 0.0, 1e300), 0.0));
}

#[test]
fn footprints_that_are_none_are_refused() {
    let refused = |corners: &[Point]| {
        Footprint::polygon(corners.to_vec())
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        refused(&[[0.0, 0.0], [1.0, 0.0]]),
        "a polygon needs three corners or more, not 2"
    );
    assert_eq!(
        refused(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]),
        "the footprint has no area"
    );
    assert_eq!(
        refused(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]),
        "the footprint has no area"
    );
    let dart = [[0.0, 0.0], [2.0, -2.0], [1.0, 0.0], [2.0, 2.0]];
    assert_eq!(
        refused(&dart),
        "the footprint is not convex: give its convex hull"
    );
    let star: Vec<Point> = (0..5)
        .map(|at| {
            let angle = wrapped(f64::from(at * 2) * 1.256_637);
            let (sine, cosine) = sine_and_cosine(angle);
            [cosine, sine]
        })
        .collect();
    assert_eq!(
        refused(&star),
        "the footprint is not convex: give its convex hull"
    );
    assert!(Footprint::circle(-1.0).is_err());
    assert!(Footprint::circle(f64::NAN).is_err());
    // The other way round it is the same one.
    let clockwise = Footprint::polygon(vec![[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]).unwrap();
    assert_eq!(clockwise.reach(), 1.0);
    let wall = Obstacles::new(vec![Shape::Circle([0.2, 0.2], 0.0)], None).unwrap();
    assert!(wall.meets(&clockwise, at(0.0, 0.0, 0.0), 0.0));
}

#[test]
fn degenerate_polygons_are_thin_walls() {
    let line = Shape::Polygon(vec![[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, 0.0]]);
    let point = Shape::Rectangle([8.0, 8.0], [8.0, 8.0]);
    let dot = Shape::Wall([-5.0, 0.0], [-5.0, 0.0], 0.0);
    let obstacles = Obstacles::new(vec![line, point, dot], None).unwrap();
    let disc = Footprint::circle(0.5).unwrap();
    for (x, y, met) in [
        (1.0, 0.4, true),
        (1.0, 0.6, false),
        (8.3, 8.3, true),
        (-5.0, 0.4, true),
        (-6.0, 0.4, false),
    ] {
        assert_eq!(obstacles.meets(&disc, at(x, y, 0.0), 0.0), met, "{x} {y}");
    }
}

#[test]
fn a_million_obstacles_are_asked_fast() {
    let mut random = Random::new(8);
    let mut shapes = Vec::new();
    for _ in 0..1_000_000 {
        let (x, y) = (random.between(0.0, 1e3), random.between(0.0, 1e3));
        shapes.push(Shape::Circle([x, y], 0.1));
    }
    // One around all of them must not make each question long.
    shapes[0] = Shape::Wall([-10.0, 2e3], [2e3, -10.0], 0.1);
    let obstacles = Obstacles::new(shapes.clone(), None).unwrap();
    let disc = Footprint::circle(0.1).unwrap();
    let mut met = 0;
    for _ in 0..20_000 {
        let pose = at(random.between(0.0, 1e3), random.between(0.0, 1e3), 0.0);
        met += usize::from(obstacles.meets(&disc, pose, 0.0));
    }
    // A disc of radius 0.2 around each: 1 - exp(-0.1257).
    assert!((2100..2650).contains(&met), "{met}");
    shapes.push(Shape::Circle([0.0, 0.0], 1.0));
    assert_eq!(
        Obstacles::new(shapes, None).unwrap_err().to_string(),
        "1000001 obstacles are more than 1000000"
    );
}
