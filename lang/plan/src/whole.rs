//! Tests of robots of several bodies: a trailer in a narrow place, and two steered blocks below one plate.

use super::obstacles::{Footprint, Obstacles, Shape};
use super::room::{Body, Parts, Room};
use super::*;
use lang_dcml::robot::Robot;
use std::f64::consts::PI;

const RESOLUTION: f64 = 0.01;

fn robot(name: &str, params: &[f64]) -> Robot {
    let text = lang_dcml::models::named(name).unwrap().text;
    let model = lang_dcml::understand(text).models.remove(0);
    Robot::new(&model, params).unwrap()
}

fn axis(part: usize, low: f64, high: f64, weight: f64) -> Axis {
    let is_angle = high == PI;
    Axis {
        part,
        weight,
        low,
        high,
        is_angle,
    }
}

fn rectangle(back: f64, front: f64, half: f64) -> Footprint {
    Footprint::polygon(vec![
        [back, -half],
        [front, -half],
        [front, half],
        [back, half],
    ])
    .unwrap()
}

/// Goes along a path twenty times as finely.
fn along(robot: &mut Robot, path: &Path, mut look: impl FnMut(&[f64])) -> u64 {
    let mut looks = 0;
    path.replay(robot, 20, |_, place, _| {
        looks += 1;
        look(place);
    });
    looks
}

/// From one end of the yard to the other, with a bound for the output `bend`.
fn yard(bend: f64) -> Problem {
    Problem {
        start: vec![0.7, 0.4, 0.0, 0.0],
        axes: vec![
            axis(0, 0.0, 4.5, 1.0),
            axis(1, 0.0, 2.2, 1.0),
            axis(2, -PI, PI, 0.2),
            axis(3, -PI, PI, 0.1),
            axis(4, -bend, bend, 0.0),
        ],
        goal: vec![Goal {
            wanted: vec![(0, 3.8), (1, 1.6)],
            tolerance: 0.25,
        }],
        actions: vec![(-0.4, 0.5), (-0.6, 0.6)],
        step: 0.05,
        hold: (2, 20),
        links: Vec::new(),
    }
}

#[test]
fn a_trailer_in_a_narrow_place_touches_nothing_and_does_not_jack_knife() {
    // Two walls with gaps at opposite ends: an S of which each bend is too narrow for a straight way.
    let walls = [
        Shape::Wall([1.6, 0.0], [1.6, 1.3], 0.05),
        Shape::Wall([2.9, 0.9], [2.9, 2.2], 0.05),
    ];
    let obstacles = Obstacles::new(walls.to_vec(), Some([0.0, 0.0, 4.5, 2.2])).unwrap();
    let mut robot = robot("trailer", &[0.3, 0.35]);
    // x, y, theta, theta_trailer, and the output `bend`.
    let bend = 0.6;
    let car = rectangle(-0.08, 0.38, 0.12);
    let parts = Parts {
        x: 0,
        y: 1,
        heading: Some(2),
    };
    let bodies = [Body {
        parts: Parts {
            x: 0,
            y: 1,
            heading: Some(3),
        },
        footprint: rectangle(-0.45, -0.15, 0.12),
    }];
    let problem = yard(bend);
    let free = |place: &[f64]| {
        !obstacles.meets(&car, parts.pose(place), 0.0)
            && !obstacles.meets(&bodies[0].footprint, bodies[0].parts.pose(place), 0.0)
    };
    let mut without = 0;
    for seed in 1..=3 {
        let options = Options {
            seed,
            ..Options::default()
        };
        let room = Room::new(&obstacles, &car, parts, RESOLUTION).unwrap();
        let mut room = room.with_bodies(&bodies).unwrap();
        let outcome = plan(&mut robot, &mut room, &problem, &options, &mut |_| true).unwrap();
        let path = outcome.path.expect("a path");
        let (mut most, mut sharpest) = (0, 0.0_f64);
        let looks = along(&mut robot, &path, |place| {
            let angle = (place[2] - place[3])
                .sin()
                .atan2((place[2] - place[3]).cos());
            sharpest = sharpest.max(angle.abs());
            most += usize::from(!free(place));
        });
        assert!(
            looks > 1000 && most == 0,
            "{most} of {looks} touch something"
        );
        // Between two steps it bends by less than a hundredth more.
        assert!(sharpest <= bend + 0.01 && sharpest > 0.2, "{sharpest}");
        path.replay(&mut robot, 1, |_, place, _| assert!(place[4].abs() <= bend));
        // The same question without trailer and hitch: the answers are others, and some would not do.
        let mut plain = problem.clone();
        plain.axes.pop();
        let mut room = Room::new(&obstacles, &car, parts, RESOLUTION).unwrap();
        let outcome = plan(&mut robot, &mut room, &plain, &options, &mut |_| true).unwrap();
        let mut is_good = true;
        along(&mut robot, &outcome.path.expect("a path"), |place| {
            is_good &= free(place) && place[4].abs() <= bend;
        });
        without += usize::from(!is_good);
    }
    assert!(without > 0, "nothing of it matters here");
}

#[test]
fn two_steered_blocks_keep_their_distance() {
    let walls = [Shape::Wall([1.5, 0.0], [1.5, 1.2], 0.05)];
    let obstacles = Obstacles::new(walls.to_vec(), Some([0.0, 0.0, 3.0, 2.5])).unwrap();
    // Half an axle, radius and offset of the joint: the wheels of a block turn it and push its joint.
    let mut robot = robot("bart", &[0.08, 0.04, 0.05]);
    // States: x, y, phi of front and rear; outputs: x, y, theta.
    let disc = Footprint::circle(0.12).unwrap();
    let middle = Footprint::circle(0.1).unwrap();
    let block = |x: usize| Body {
        parts: Parts {
            x,
            y: x + 1,
            heading: Some(x + 2),
        },
        footprint: disc.clone(),
    };
    let bodies = [block(0), block(3)];
    let link = Link {
        from: [0, 1],
        to: [3, 4],
        tolerance: 0.005,
    };
    let problem = Problem {
        start: vec![0.8, 0.5, 0.0, 0.4, 0.5, 0.0],
        axes: vec![
            axis(6, 0.0, 3.0, 1.0),
            axis(7, 0.0, 2.5, 1.0),
            axis(8, -PI, PI, 0.1),
        ],
        goal: vec![Goal {
            wanted: vec![(0, 2.3), (1, 0.6)],
            tolerance: 0.2,
        }],
        actions: vec![(-8.0, 8.0); 4],
        step: 0.02,
        hold: (5, 25),
        links: vec![link],
    };
    let parts = Parts {
        x: 6,
        y: 7,
        heading: Some(8),
    };
    for seed in 1..=3 {
        let options = Options {
            seed,
            ..Options::default()
        };
        let room = Room::new(&obstacles, &middle, parts, RESOLUTION).unwrap();
        let mut room = room.with_bodies(&bodies).unwrap();
        let outcome = plan(&mut robot, &mut room, &problem, &options, &mut |_| true).unwrap();
        let path = outcome.path.expect("a path");
        path.replay(&mut robot, 1, |_, place, _| {
            assert!((link.length(place) - 0.4).abs() <= link.tolerance);
        });
        along(&mut robot, &path, |place| {
            assert!((link.length(place) - 0.4).abs() <= 1.1 * link.tolerance);
            for body in &bodies {
                assert!(!obstacles.meets(&body.footprint, body.parts.pose(place), 0.0));
            }
        });
        for piece in &path.pieces {
            assert!(piece.action.iter().all(|one| one.abs() <= 8.0));
        }
    }
}

#[test]
fn links_and_bodies_that_mean_nothing_are_refused() {
    let mut robot = robot("differential-drive", &[0.2, 0.03]);
    let mut problem = Problem {
        start: vec![0.0; 3],
        axes: vec![axis(0, 0.0, 1.0, 1.0)],
        goal: vec![Goal {
            wanted: vec![(0, 1.0)],
            tolerance: 0.1,
        }],
        actions: vec![(-1.0, 1.0); 2],
        step: 0.05,
        hold: (1, 5),
        links: vec![Link {
            from: [0, 1],
            to: [2, 3],
            tolerance: 0.1,
        }],
    };
    let mut told = |problem: &Problem| {
        let refused = plan(
            &mut robot,
            &mut Anywhere,
            problem,
            &Options::default(),
            &mut |_| true,
        );
        refused.unwrap_err().to_string()
    };
    assert_eq!(
        told(&problem),
        "a link names a part of the place that is not there"
    );
    problem.links[0].to = [2, 2];
    problem.links[0].tolerance = f64::NAN;
    assert_eq!(
        told(&problem),
        "NaN is no tolerance of a link: it is above 0"
    );
    problem.links = vec![problem.links[0]; 17];
    assert_eq!(told(&problem), "17 links are more than 16");
    let (obstacles, disc) = (Obstacles::default(), Footprint::circle(0.1).unwrap());
    let parts = Parts {
        x: 0,
        y: 1,
        heading: None,
    };
    let bodies = vec![
        Body {
            parts,
            footprint: disc.clone()
        };
        65
    ];
    let room = Room::new(&obstacles, &disc, parts, RESOLUTION).unwrap();
    let fault = room.with_bodies(&bodies).unwrap_err();
    assert_eq!(fault.to_string(), "65 bodies are more than 64");
}
