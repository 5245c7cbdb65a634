//! Solutions against exact ones, orders of convergence, events, failures, and another library's numbers.

use super::event::{Direction, Event};
use super::propagate::Propagator;
use super::run::Course;
use super::*;
use crate::robot::Robot;
use crate::sketch;
use std::f64::consts::{PI, TAU};

/// A system that is a closure: state, action, derivative.
struct Plain<F>(usize, usize, F);

impl<F: FnMut(&[f64], &[f64], &mut [f64])> System for Plain<F> {
    fn states(&self) -> usize {
        self.0
    }

    fn actions(&self) -> usize {
        self.1
    }

    fn derivative(&mut self, state: &[f64], action: &[f64], derivative: &mut [f64]) {
        (self.2)(state, action, derivative);
    }
}

/// A spring without loss: x = cos t from x = 1 at rest.
fn spring() -> impl System {
    Plain(2, 0, |x: &[f64], _: &[f64], d: &mut [f64]| {
        d[0] = x[1];
        d[1] = -x[0];
    })
}

fn nothing(_: f64, _: &mut [f64]) {}

fn course(to: f64) -> Course<'static> {
    Course {
        to,
        jumps: &[],
        events: &mut [],
    }
}

/// The spring from its start to a time.
fn sprung(options: Options, to: f64) -> Result<Solver, Failure> {
    let mut solver = Solver::new(options, 2, 0)?;
    solver.start(0.0, &[1.0, 0.0]);
    solver.run(&mut spring(), &mut nothing, &mut course(to), |_| ())?;
    Ok(solver)
}

#[test]
fn methods_have_their_order() -> Result<(), Failure> {
    for (method, order) in [(Method::Euler, 1), (Method::Heun, 2), (Method::Rk4, 4)] {
        let error = |step: f64| -> Result<f64, Failure> {
            let solver = sprung(Options::fixed(method, step), 2.0)?;
            Ok((solver.state()[0] - 2.0_f64.cos()).hypot(solver.state()[1] + 2.0_f64.sin()))
        };
        let found = (error(0.02)? / error(0.01)?).log2();
        assert!(
            (found - f64::from(order)).abs() < 0.1,
            "{method:?}: {found}"
        );
    }
    // Order five: the error of one step without control falls with its sixth power.
    let error = |step: f64| -> Result<f64, Failure> {
        let mut options = Options::adaptive(1.0, 1.0);
        options.step = step;
        let mut solver = Solver::new(options, 2, 0)?;
        solver.start(0.0, &[1.0, 0.0]);
        solver.next = step;
        solver.step(&mut spring(), &mut nothing, step)?;
        let (x, v) = (solver.state()[0], solver.state()[1]);
        Ok((x - step.cos()).hypot(v + step.sin()))
    };
    let found = (error(0.2)? / error(0.1)?).log2();
    assert!((found - 6.0).abs() < 0.2, "{found}");
    Ok(())
}

#[test]
fn tolerances_are_kept_and_cost_steps() -> Result<(), Failure> {
    let mut last = 0;
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let solver = sprung(Options::adaptive(tolerance, tolerance), 20.0)?;
        let error = (solver.state()[0] - 20.0_f64.cos()).abs();
        assert!(error < 100.0 * tolerance, "{tolerance}: {error}");
        assert!(solver.steps() > last, "{}", solver.steps());
        last = solver.steps();
    }
    assert!(last < 700, "{last}");
    Ok(())
}

#[test]
fn what_is_between_steps_is_nearly_as_good_as_their_ends() -> Result<(), Failure> {
    for options in [
        Options::adaptive(1e-9, 1e-9),
        Options::fixed(Method::Rk4, 0.01),
    ] {
        let mut solver = Solver::new(options, 2, 0)?;
        solver.start(0.0, &[1.0, 0.0]);
        let mut worst: f64 = 0.0;
        let mut count = 0;
        solver.run(&mut spring(), &mut nothing, &mut course(7.0), |solver| {
            let mut state = [0.0; 2];
            for part in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let time = solver.before() + part * (solver.time() - solver.before());
                solver.between(time, &mut state);
                worst = worst.max((state[0] - time.cos()).abs());
                count += 1;
            }
        })?;
        assert!(worst < 3e-8 && count > 100, "{worst} {count}");
    }
    Ok(())
}

#[test]
fn a_robot_under_one_action_drives_a_circle() -> Result<(), Box<dyn std::error::Error>> {
    let mut robot = Robot::new(&sketch::differential_drive(), &[0.4, 0.1])?;
    let action = [1.0, 3.0];
    // Both wheels: 0.2 m/s ahead, 0.5 rad/s to the left, so on a circle of 0.4 m.
    let at = |time: f64| {
        let angle = 0.5 * time;
        [0.4 * angle.sin(), 0.4 * (1.0 - angle.cos()), angle]
    };
    let mut solver = Solver::new(Options::adaptive(1e-10, 1e-12), 3, 2)?;
    let mut given = |_: f64, to: &mut [f64]| to.copy_from_slice(&action);
    solver.run(&mut robot, &mut given, &mut course(10.0), |_| ())?;
    let mut propagated = [0.0; 3];
    assert!(Propagator::new().run(&mut robot, &mut propagated, &action, 10.0, 1000));
    let mut many = vec![0.0; 3 * 70];
    let actions = [[1.0; 70], [3.0; 70]].concat();
    let mut batch = robot.batch()?;
    assert!(Propagator::new().batch(&mut batch, 70, &mut many, &actions, 10.0, 1000));
    for (part, expected) in at(10.0).into_iter().enumerate() {
        assert!((solver.state()[part] - expected).abs() < 1e-8, "{solver:?}");
        assert!(
            (propagated[part] - expected).abs() < 1e-10,
            "{propagated:?}"
        );
        assert!((many[part * 70 + 69] - expected).abs() < 1e-10);
    }
    Ok(())
}

#[test]
fn steps_end_where_actions_jump() -> Result<(), Failure> {
    // x' = u with u = 1, then -3 from 1 s on, then 0 from 1.5 s on.
    let mut system = Plain(1, 1, |_: &[f64], u: &[f64], d: &mut [f64]| d[0] = u[0]);
    let mut actions = |time: f64, to: &mut [f64]| {
        to[0] = match time {
            _ if time < 1.0 => 1.0,
            _ if time < 1.5 => -3.0,
            _ => 0.0,
        };
    };
    for options in [
        Options::adaptive(1e-6, 1e-9),
        Options::fixed(Method::Rk4, 0.3),
        Options::fixed(Method::Heun, 0.3),
        Options::fixed(Method::Euler, 0.3),
    ] {
        let mut solver = Solver::new(options, 1, 1)?;
        let mut course = course(4.0);
        course.jumps = &[0.0, 1.0, 1.5];
        let mut ends = Vec::new();
        solver.run(&mut system, &mut actions, &mut course, |solver| {
            ends.push(solver.time());
        })?;
        assert!(ends.contains(&1.0) && ends.contains(&1.5) && ends.contains(&4.0));
        let error = (solver.state()[0] + 0.5).abs();
        assert!(error < 1e-12, "{options:?}: {error}");
    }
    Ok(())
}

#[test]
fn steps_of_one_size_do_not_drift() -> Result<(), Failure> {
    let mut solver = sprung(Options::fixed(Method::Euler, 0.1), 10.0)?;
    assert_eq!((solver.steps(), solver.time()), (100, 10.0));
    solver = sprung(Options::fixed(Method::Euler, 0.3), 1.0)?;
    assert_eq!((solver.steps(), solver.time()), (4, 1.0));
    Ok(())
}

#[test]
fn events_are_found_with_their_direction() -> Result<(), Failure> {
    for options in [
        Options::adaptive(1e-10, 1e-10),
        Options::fixed(Method::Rk4, 0.01),
    ] {
        for (direction, expected) in [
            (Direction::Any, vec![0.5 * PI, 1.5 * PI, 2.5 * PI]),
            (Direction::Rising, vec![1.5 * PI]),
            (Direction::Falling, vec![0.5 * PI, 2.5 * PI]),
        ] {
            let mut solver = Solver::new(options, 2, 0)?;
            solver.start(0.0, &[1.0, 0.0]);
            let mut value = |_: f64, state: &[f64]| state[0];
            let mut events = [Event {
                value: &mut value,
                direction,
                is_terminal: false,
            }];
            let mut course = Course {
                to: 9.0,
                jumps: &[],
                events: &mut events,
            };
            let found = solver.run(&mut spring(), &mut nothing, &mut course, |_| ())?;
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found.time - expected).abs() < 1e-8, "{found:?}");
                assert!(found.state[0].abs() < 1e-8);
            }
            assert_eq!(solver.time(), 9.0);
        }
    }
    Ok(())
}

#[test]
fn the_first_event_that_ends_a_solution_ends_it() -> Result<(), Failure> {
    // A stone from 10 m; the floor is reached after sqrt(20 / 9.81) s, and half the way before.
    let mut stone = Plain(2, 0, |x: &[f64], _: &[f64], d: &mut [f64]| {
        d[0] = x[1];
        d[1] = -9.81;
    });
    let mut floor = |_: f64, state: &[f64]| state[0];
    let mut half = |_: f64, state: &[f64]| state[0] - 5.0;
    let event = |value, is_terminal| Event {
        value,
        direction: Direction::Falling,
        is_terminal,
    };
    let mut events = [event(&mut floor, true), event(&mut half, false)];
    let mut solver = Solver::new(Options::adaptive(1e-9, 1e-9), 2, 0)?;
    solver.start(0.0, &[10.0, 0.0]);
    let mut course = Course {
        to: 100.0,
        jumps: &[],
        events: &mut events,
    };
    let mut seen = 0.0;
    let found = solver.run(&mut stone, &mut nothing, &mut course, |solver| {
        seen = solver.time();
        // What is shown of the last step is that of the whole one, up to its end.
        let mut state = [0.0; 2];
        let time = (solver.before() + solver.time()) / 2.0;
        solver.between(time, &mut state);
        assert!((state[0] - 10.0 + 4.905 * time * time).abs() < 1e-8);
    })?;
    let order: Vec<usize> = found.iter().map(|one| one.event).collect();
    assert_eq!(order, [1, 0]);
    let end = (20.0_f64 / 9.81).sqrt();
    assert!((solver.time() - end).abs() < 1e-9 && seen == solver.time());
    assert!(solver.state()[0].abs() < 1e-8);
    assert!((found[0].time - (10.0_f64 / 9.81).sqrt()).abs() < 1e-9);
    Ok(())
}

#[test]
fn failures_say_when_and_which() -> Result<(), Failure> {
    // x' = x^2 from 1 has a pole at 1 s; the first state is calm.
    let mut pole = Plain(2, 0, |x: &[f64], _: &[f64], d: &mut [f64]| {
        d[0] = 0.0;
        d[1] = x[1] * x[1];
    });
    let mut solver = Solver::new(Options::adaptive(1e-6, 1e-9), 2, 0)?;
    solver.start(0.0, &[1.0, 1.0]);
    let told = solver.run(&mut pole, &mut nothing, &mut course(2.0), |_| ());
    match told {
        Err(Failure::StepTooSmall { time, state: 1 } | Failure::NotFinite { time, state: 1 }) => {
            assert!((time - 1.0).abs() < 1e-3, "{time}");
        }
        other => panic!("{other:?}"),
    }
    let mut solver = Solver::new(Options::fixed(Method::Rk4, 0.01), 2, 0)?;
    solver.start(0.0, &[1.0, 1.0]);
    let told = solver.run(&mut pole, &mut nothing, &mut course(2.0), |_| ());
    assert!(
        matches!(told, Err(Failure::NotFinite { state: 1, .. })),
        "{told:?}"
    );
    // Not finite from the start on.
    let mut root = Plain(1, 0, |x: &[f64], _: &[f64], d: &mut [f64]| d[0] = x[0].ln());
    let mut solver = Solver::new(Options::adaptive(1e-6, 1e-9), 1, 0)?;
    let told = solver.run(&mut root, &mut nothing, &mut course(2.0), |_| ());
    let expected = Failure::NotFinite {
        time: 0.0,
        state: 0,
    };
    assert_eq!(told, Err(expected.clone()));
    assert!(expected.told("height").starts_with("at 0 s height or"));
    // Too many steps.
    let mut options = Options::fixed(Method::Euler, 1e-3);
    options.steps_max = 10;
    assert!(matches!(
        sprung(options, 1.0),
        Err(Failure::TooManySteps { .. })
    ));
    Ok(())
}

#[test]
fn nonsense_is_refused() -> Result<(), Failure> {
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = Options::fixed(Method::Rk4, step);
        assert!(
            matches!(Solver::new(options, 1, 0), Err(Failure::Options(_))),
            "{step}"
        );
    }
    for (relative, absolute) in [(0.0, 0.0), (-1.0, 1.0), (1.0, f64::NAN)] {
        let options = Options::adaptive(relative, absolute);
        assert!(Solver::new(options, 1, 0).is_err());
    }
    let mut solver = Solver::new(Options::adaptive(1e-6, 1e-6), 2, 0)?;
    for limit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let told = solver.step(&mut spring(), &mut nothing, limit);
        assert!(matches!(told, Err(Failure::Options(_))), "{limit}");
    }
    // A step that is lost in the size of the time.
    let mut solver = Solver::new(Options::fixed(Method::Rk4, 1e-9), 2, 0)?;
    solver.start(1e12, &[1.0, 0.0]);
    let told = solver.step(&mut spring(), &mut nothing, 2e12);
    assert!(
        matches!(told, Err(Failure::StepTooSmall { .. })),
        "{told:?}"
    );
    // Nothing to solve is solved.
    let mut none = Plain(0, 0, |_: &[f64], _: &[f64], _: &mut [f64]| ());
    let mut solver = Solver::new(Options::adaptive(1e-6, 1e-6), 0, 0)?;
    solver.run(&mut none, &mut nothing, &mut course(3.0), |_| ())?;
    assert_eq!(solver.time(), 3.0);
    Ok(())
}

#[test]
fn angles_are_shown_on_the_circle() {
    for (angle, expected) in [
        (PI, PI),
        (-PI, PI),
        (3.5 * PI, -0.5 * PI),
        (TAU, 0.0),
        (1.0, 1.0),
    ] {
        assert!((wrapped(angle) - expected).abs() < 1e-12, "{angle}");
    }
    let tiny = wrapped(-PI - 1e-17);
    assert!(tiny > -PI && tiny <= PI);
}

/// Numbers of SciPy 1.17.1, solve_ivp with DOP853, rtol 1e-13 and atol 1e-14.
#[test]
fn another_library_gives_the_same() -> Result<(), Box<dyn std::error::Error>> {
    let text = crate::models::named("trailer").ok_or("no trailer")?.text;
    let understood = crate::understand(text);
    let mut robot = Robot::new(&understood.models[0], &[2.0, 3.0])?;
    let mut given = |time: f64, to: &mut [f64]| {
        to[0] = 1.0 + 0.5 * time.sin();
        to[1] = 0.4 * (2.0 * time).cos();
    };
    let mut solver = Solver::new(Options::adaptive(1e-11, 1e-12), 4, 2)?;
    solver.start(0.0, &[0.0, 0.0, 0.3, -1.0]);
    for (time, expected) in [
        (
            2.5,
            [
                3.241_035_362_269_989,
                0.957_782_129_132_259_7,
                0.117_934_384_443_737_44,
                -0.213_988_236_311_092_23,
            ],
        ),
        (
            10.0,
            [
                10.484_379_207_844_581,
                2.854_006_070_801_813_3,
                0.313_888_228_963_006_67,
                0.201_255_716_804_703_97,
            ],
        ),
    ] {
        solver.run(&mut robot, &mut given, &mut course(time), |_| ())?;
        for (found, expected) in solver.state().iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{:?}", solver.state());
        }
    }
    Ok(())
}

/// An oscillator with sharp corners, and where it goes through zero: numbers of SciPy as above.
#[test]
fn another_library_finds_the_same_events() -> Result<(), Failure> {
    let mut sharp = Plain(2, 0, |x: &[f64], _: &[f64], d: &mut [f64]| {
        d[0] = x[1];
        d[1] = 5.0 * (1.0 - x[0] * x[0]) * x[1] - x[0];
    });
    let mut value = |_: f64, state: &[f64]| state[0];
    let mut events = [Event {
        value: &mut value,
        direction: Direction::Any,
        is_terminal: false,
    }];
    let mut course = Course {
        to: 20.0,
        jumps: &[],
        events: &mut events,
    };
    let mut solver = Solver::new(Options::adaptive(1e-11, 1e-12), 2, 0)?;
    solver.start(0.0, &[2.0, 0.0]);
    let found = solver.run(&mut sharp, &mut nothing, &mut course, |_| ())?;
    let expected = [-1.601_296_879_542_836, 0.198_326_676_338_666_74];
    for (found, expected) in solver.state().iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{:?}", solver.state());
    }
    let expected = [
        5.122_878_795_047_989,
        10.928_994_128_907_734,
        16.735_109_462_767_493,
    ];
    assert_eq!(found.len(), 3);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found.time - expected).abs() < 1e-8, "{found:?}");
    }
    // With the tolerances that it has, SciPy's RK45 takes 312 steps.
    let mut solver = Solver::new(Options::adaptive(1e-6, 1e-9), 2, 0)?;
    solver.start(0.0, &[2.0, 0.0]);
    course.events = &mut [];
    solver.run(&mut sharp, &mut nothing, &mut course, |_| ())?;
    assert!((250..400).contains(&solver.steps()), "{}", solver.steps());
    Ok(())
}
