//! Tests of the planners on robots written by hand: paths are free, repeat exactly, keep to the ranges, and get shorter.

mod refused;

use super::obstacles::flat::wrapped;
use super::obstacles::{Footprint, Obstacles, Shape};
use super::room::{Parts, Room};
use super::*;
use std::f64::consts::PI;

/// x' = f(x, u) with so many states and actions; the third state is an angle, if there is one.
struct Robot {
    states: usize,
    actions: usize,
    slope: fn(&[f64], &[f64], &mut [f64]),
}

impl System for Robot {
    fn states(&self) -> usize {
        self.states
    }
    fn actions(&self) -> usize {
        self.actions
    }
    fn wraps(&self, state: usize) -> bool {
        state >= 2
    }
    fn derivative(&mut self, state: &[f64], action: &[f64], derivative: &mut [f64]) {
        (self.slope)(state, action, derivative);
    }
}

/// Speed and turning.
fn unicycle() -> Robot {
    Robot {
        states: 3,
        actions: 2,
        slope: |x, u, d| {
            d[0] = u[0] * x[2].cos();
            d[1] = u[0] * x[2].sin();
            d[2] = u[1];
        },
    }
}

/// A car of 0.3 m between the axles: speed and steering.
fn car() -> Robot {
    Robot {
        states: 3,
        actions: 2,
        slope: |x, u, d| {
            d[0] = u[0] * x[2].cos();
            d[1] = u[0] * x[2].sin();
            d[2] = u[0] * u[1].tan() / 0.3;
        },
    }
}

/// The same with a trailer of 0.4 m.
fn trailer() -> Robot {
    Robot {
        states: 4,
        actions: 2,
        slope: |x, u, d| {
            d[0] = u[0] * x[2].cos();
            d[1] = u[0] * x[2].sin();
            d[2] = u[0] * u[1].tan() / 0.3;
            d[3] = u[0] * (x[2] - x[3]).sin() / 0.4;
        },
    }
}

fn line(part: usize, low: f64, high: f64) -> Axis {
    Axis {
        part,
        weight: 1.0,
        low,
        high,
        is_angle: false,
    }
}

fn angle(part: usize, weight: f64) -> Axis {
    Axis {
        part,
        weight,
        low: -PI,
        high: PI,
        is_angle: true,
    }
}

/// In a room of 4 m x 3 m, to a place at its other end.
fn across() -> Problem {
    Problem {
        start: vec![0.5, 0.5, 0.0],
        axes: vec![line(0, 0.0, 4.0), line(1, 0.0, 3.0), angle(2, 0.2)],
        goal: vec![Goal {
            wanted: vec![(0, 3.5), (1, 2.5)],
            tolerance: 0.1,
        }],
        actions: vec![(0.0, 1.0), (-2.0, 2.0)],
        step: 0.05,
        hold: (2, 20),
        links: Vec::new(),
    }
}

const WALKS: [f64; 4] = [0.0, 0.0, 4.0, 3.0];
const PARTS: Parts = Parts {
    x: 0,
    y: 1,
    heading: Some(2),
};
const RESOLUTION: f64 = 0.02;

fn room(shapes: Vec<Shape>) -> Obstacles {
    Obstacles::new(shapes, Some(WALKS)).unwrap()
}

/// A wall across the room with a gap of 0.6 m at its upper end.
fn gap() -> Obstacles {
    room(vec![Shape::Wall([2.0, 0.0], [2.0, 2.4], 0.05)])
}

fn disc() -> Footprint {
    Footprint::circle(0.15).unwrap()
}

fn sst(iterations: u64) -> Options {
    Options {
        method: Method::Sst {
            selection: 0.3,
            pruning: 0.1,
        },
        iterations,
        ..Options::default()
    }
}

fn search(
    robot: &mut Robot,
    obstacles: &Obstacles,
    footprint: &Footprint,
    problem: &Problem,
    options: &Options,
) -> Outcome {
    let mut room = Room::new(obstacles, footprint, PARTS, RESOLUTION).unwrap();
    plan(robot, &mut room, problem, options, &mut |_| true).unwrap()
}

/// Goes along the path again, ten times as finely, and looks at everything that was promised.
fn inspect(
    robot: &mut Robot,
    obstacles: &Obstacles,
    footprint: &Footprint,
    problem: &Problem,
    path: &Path,
) {
    for piece in &path.pieces {
        assert!((1..=problem.hold.1).contains(&piece.steps));
        for (value, (low, high)) in piece.action.iter().zip(&problem.actions) {
            assert!((*low..=*high).contains(value));
        }
    }
    let mut last = Vec::new();
    path.replay(robot, 1, |seconds, place, _| {
        assert!(seconds <= path.duration() + 1e-9);
        last = place.to_vec();
    });
    assert_eq!(last, path.end(), "it repeats to the last bit");
    assert!(space::is_in_goal(problem, &last));
    let mut looked = 0;
    path.replay(robot, 10, |_, place, _| {
        assert!(
            !obstacles.meets(footprint, PARTS.pose(place), 0.0),
            "meets something at {place:?}"
        );
        looked += 1;
    });
    assert_eq!(looked, path.steps() * 10 + 1);
}

#[test]
fn both_planners_cross_an_empty_room_and_pass_a_gap() {
    for obstacles in [room(vec![]), gap()] {
        for options in [Options::default(), sst(8000)] {
            for seed in 1..=3 {
                let options = Options {
                    seed,
                    ..options.clone()
                };
                let (mut robot, problem) = (unicycle(), across());
                let outcome = search(&mut robot, &obstacles, &disc(), &problem, &options);
                let path = outcome.path.unwrap();
                inspect(&mut robot, &obstacles, &disc(), &problem, &path);
                assert!(path.duration() > 3.5, "as the crow flies");
                assert_eq!(outcome.counts.best, Some(path.duration()));
                assert!(outcome.counts.propagations > 0 && outcome.counts.collisions > 0);
            }
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_path_and_another_another() {
    let paths: Vec<Path> = [7, 7, 8]
        .map(|seed| {
            let options = Options {
                seed,
                ..Options::default()
            };
            let outcome = search(&mut unicycle(), &gap(), &disc(), &across(), &options);
            outcome.path.unwrap()
        })
        .into();
    assert_eq!(paths[0], paths[1]);
    assert_ne!(paths[0], paths[2]);
}

#[test]
fn a_path_of_an_exact_system_is_the_same_on_every_machine() {
    // A mass that is pushed: only sums and products. Worked out once; a machine that differs has another arithmetic.
    let mut mass = Robot {
        states: 2,
        actions: 1,
        slope: |x, u, d| {
            d[0] = x[1];
            d[1] = u[0];
        },
    };
    let problem = Problem {
        start: vec![0.0, 0.0],
        axes: vec![line(0, -2.0, 2.0), line(1, -1.0, 1.0)],
        goal: vec![Goal {
            wanted: vec![(0, 1.0), (1, 0.0)],
            tolerance: 0.05,
        }],
        actions: vec![(-1.0, 1.0)],
        step: 0.125,
        hold: (1, 8),
        links: Vec::new(),
    };
    let outcome = plan(&mut mass, &mut Anywhere, &problem, &sst(3000), &mut |_| {
        true
    })
    .unwrap();
    let path = outcome.path.unwrap();
    let bits: u64 = path
        .pieces
        .iter()
        .flat_map(|piece| piece.action.iter().chain(&piece.end))
        .fold(0, |hash: u64, one| {
            (hash ^ one.to_bits()).wrapping_mul(0x100_0000_01b3)
        });
    assert_eq!((path.steps(), bits), (22, 14_301_555_611_826_450_864));
}

#[test]
fn a_car_parks_between_two_others() {
    let boxes = vec![
        Shape::Rectangle([0.0, 0.0], [1.5, 0.3]),
        Shape::Rectangle([2.3, 0.0], [4.0, 0.3]),
    ];
    let obstacles = room(boxes);
    // From behind the rear axle to the bumper.
    let body = Footprint::polygon(vec![[-0.06, -0.1], [0.36, -0.1], [0.36, 0.1], [-0.06, 0.1]]);
    let body = body.unwrap();
    let mut problem = across();
    problem.start = vec![1.0, 0.6, 0.0];
    problem.goal = vec![
        Goal {
            wanted: vec![(0, 1.75), (1, 0.16)],
            tolerance: 0.06,
        },
        Goal {
            wanted: vec![(2, 0.0)],
            tolerance: 0.2,
        },
    ];
    problem.actions = vec![(-0.5, 0.5), (-0.6, 0.6)];
    let options = Options {
        goal_bias: 0.1,
        ..Options::default()
    };
    let outcome = search(&mut car(), &obstacles, &body, &problem, &options);
    let path = outcome.path.unwrap();
    inspect(&mut car(), &obstacles, &body, &problem, &path);
    let goes_back = path.pieces.iter().any(|piece| piece.action[0] < 0.0);
    assert!(goes_back, "nobody parks forward there");
}

#[test]
fn a_trailer_turns_round() {
    let mut problem = across();
    problem.start = vec![2.0, 1.0, 0.0, 0.0];
    problem.axes.push(angle(3, 0.1));
    problem.goal = vec![
        Goal {
            wanted: vec![(0, 2.0), (1, 2.0)],
            tolerance: 0.2,
        },
        Goal {
            wanted: vec![(2, PI)],
            tolerance: 0.4,
        },
        Goal {
            wanted: vec![(3, PI)],
            tolerance: 0.6,
        },
    ];
    problem.actions = vec![(-0.5, 0.5), (-0.6, 0.6)];
    let outcome = search(
        &mut trailer(),
        &room(vec![]),
        &disc(),
        &problem,
        &Options::default(),
    );
    let path = outcome.path.unwrap();
    inspect(&mut trailer(), &room(vec![]), &disc(), &problem, &path);
    assert!(wrapped(path.end()[3] - PI).abs() <= 0.6);
}

#[test]
fn the_path_of_sst_gets_shorter_with_more_samples() {
    let durations: Vec<f64> = [4000, 20_000, 100_000]
        .map(|iterations| {
            let outcome = search(
                &mut unicycle(),
                &gap(),
                &disc(),
                &across(),
                &sst(iterations),
            );
            assert_eq!(outcome.end, End::Iterations);
            // Sparse: one place for each neighbourhood that is reached, and those on the way to it.
            assert!(outcome.counts.nodes < 60_000, "{}", outcome.counts.nodes);
            outcome.path.unwrap().duration()
        })
        .into();
    assert!(
        durations[0] >= durations[1] && durations[1] >= durations[2],
        "{durations:?}"
    );
    assert!(durations[2] < durations[0] * 0.9, "{durations:?}");
}

#[test]
fn a_closed_room_ends_with_what_was_reached() {
    let obstacles = room(vec![Shape::Wall([2.0, -1.0], [2.0, 4.0], 0.0)]);
    for method in [Method::Rrt, sst(1).method] {
        let options = Options {
            method,
            iterations: 3000,
            ..Options::default()
        };
        let outcome = search(&mut unicycle(), &obstacles, &disc(), &across(), &options);
        assert_eq!((outcome.path, outcome.end), (None, End::Iterations));
        assert_eq!(outcome.counts.iterations, 3000);
        assert!(outcome.nearest[0] < 1.85 && outcome.nearest[0] > 1.0);
        assert!(outcome.counts.nearest > 1.5);
        assert_eq!(outcome.tree.branches().count(), outcome.tree.len() - 1);
    }
    let options = Options {
        nodes: 100,
        ..Options::default()
    };
    let outcome = search(&mut unicycle(), &obstacles, &disc(), &across(), &options);
    assert_eq!((outcome.end, outcome.counts.nodes), (End::Nodes, 100));
    let options = Options {
        nodes: 100,
        ..sst(2000)
    };
    let outcome = search(&mut unicycle(), &obstacles, &disc(), &across(), &options);
    assert!(outcome.counts.nodes <= 100);
}

#[test]
fn who_waits_can_end_it() {
    let obstacles = room(vec![Shape::Wall([2.0, -1.0], [2.0, 4.0], 0.0)]);
    let footprint = disc();
    let mut room = Room::new(&obstacles, &footprint, PARTS, RESOLUTION).unwrap();
    let mut asked = 0;
    let outcome = plan(
        &mut unicycle(),
        &mut room,
        &across(),
        &Options::default(),
        &mut |counts: &Counts| {
            asked += 1;
            assert_eq!(counts.iterations, (asked - 1) * PLAN_REPORT);
            asked < 5
        },
    )
    .unwrap();
    assert_eq!(outcome.end, End::Stopped);
}

const PLAN_REPORT: u64 = crate::limits::PLAN_REPORT_EVERY;

#[test]
fn a_robot_whose_pose_is_an_output_is_planned_for() {
    /// A unicycle that counts in decimetres.
    struct Scaled(Robot);
    impl System for Scaled {
        fn states(&self) -> usize {
            3
        }
        fn actions(&self) -> usize {
            2
        }
        fn outputs(&self) -> usize {
            2
        }
        fn output(&mut self, state: &[f64], _: &[f64], outputs: &mut [f64]) {
            outputs[0] = state[0] / 10.0;
            outputs[1] = state[1] / 10.0;
        }
        fn derivative(&mut self, state: &[f64], action: &[f64], derivative: &mut [f64]) {
            self.0
                .derivative(state, &[action[0] * 10.0, action[1]], derivative);
        }
    }
    let mut robot = Scaled(unicycle());
    let mut problem = across();
    problem.start = vec![5.0, 5.0, 0.0];
    problem.axes[0].part = 3;
    problem.axes[1].part = 4;
    let parts = Parts {
        x: 3,
        y: 4,
        heading: Some(2),
    };
    let (obstacles, footprint) = (gap(), disc());
    let mut room = Room::new(&obstacles, &footprint, parts, RESOLUTION).unwrap();
    let options = Options::default();
    let outcome = plan(&mut robot, &mut room, &problem, &options, &mut |_| true).unwrap();
    let end = outcome.path.unwrap().end().to_vec();
    assert!((end[3] - 3.5).hypot(end[4] - 2.5) <= 0.1);
    assert!((end[0] / 10.0 - end[3]).abs() < 1e-12);
}
