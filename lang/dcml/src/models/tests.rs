//! Each shipped model has a property that is known of its robot.

use super::*;
use crate::model::Model;
use crate::robot::Robot;
use crate::solve::run::Course;
use crate::solve::{Options, Solver};
use crate::system::System;
use crate::{syntax::Kind, understand, understand_paper};
use std::f64::consts::FRAC_PI_4;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn model(name: &str) -> Model {
    let shipped = named(name).unwrap_or_else(|| panic!("no {name}"));
    let mut understood = understand(shipped.text);
    assert_eq!(understood.diagnostics, [], "{name}");
    assert_eq!(understood.models.len(), 1, "{name}");
    understood.models.remove(0)
}

/// Where a robot is after some seconds under one action.
fn driven(
    name: &str,
    params: &[f64],
    start: &[f64],
    action: &[f64],
    seconds: f64,
) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let mut robot = Robot::new(&model(name), params)?;
    let options = Options::adaptive(1e-10, 1e-12);
    let mut solver = Solver::new(options, robot.states(), robot.actions())?;
    solver.start(0.0, start);
    let mut given = |_: f64, to: &mut [f64]| to.copy_from_slice(action);
    let mut course = Course {
        to: seconds,
        jumps: &[],
        events: &mut [],
    };
    solver.run(&mut robot, &mut given, &mut course, |_| ())?;
    Ok(solver.state().to_vec())
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found_one, expected_one) in found.iter().zip(expected) {
        let error = (found_one - expected_one).abs();
        assert!(error < 1e-7, "{found:?}, not {expected:?}");
    }
}

/// The pose on a circle to the left, from the origin along x.
fn on_circle(radius: f64, angle: f64) -> [f64; 3] {
    [radius * angle.sin(), radius * (1.0 - angle.cos()), angle]
}

#[test]
fn all_are_understood_and_say_what_they_are() {
    for shipped in ALL {
        let model = model(shipped.name);
        let doc = model.doc.as_ref().map(|doc| doc.text.as_str());
        assert!(doc.unwrap_or_default().len() > 80, "{}", shipped.name);
        assert_eq!(model.package.as_deref(), Some("robotics.models"));
        assert!(model.of_kind(Kind::Action).count() > 0);
    }
    for name in ["differential-drive", "bart"] {
        let published = named(name).map(|one| understand_paper(one.text));
        let found = published.map(|one| (one.models.len(), one.diagnostics.len()));
        assert_eq!(found, Some((1, 0)), "{name}");
    }
}

#[test]
fn a_mistyped_name_finds_the_models_that_it_could_mean() {
    for (name, meant) in [
        ("diferential", &["differential-drive"][..]),
        ("differential_drive", &["differential-drive"]),
        ("DifferentialDrive", &["differential-drive"]),
        ("models/Bart.dcml", &["bart"]),
        ("bycicle", &["bicycle"]),
        ("unicylce", &["bicycle", "unicycle", "dynamic-unicycle"]),
        ("car", &["bicycle", "trailer", "dubins", "reeds-shepp"]),
        ("diff", &["differential-drive"]),
        ("reeds", &["reeds-shepp"]),
        ("submarine", &[]),
        ("", &[]),
    ] {
        let found: Vec<&str> = like(name).iter().map(|one| one.name).collect();
        assert_eq!(found, meant, "{name}");
    }
    assert_eq!(
        advice("diferential"),
        "did you mean the shipped model differential-drive?"
    );
    assert!(advice("reed-sheep").ends_with("reeds-shepp?"));
    assert!(advice("submarine").starts_with("shipped models are differential-drive, bart, "));
}

#[test]
fn texts_mean_the_models_that_were_made_by_hand() -> Outcome {
    use crate::{lower, sketch};
    for (name, by_hand) in [
        ("differential-drive", sketch::differential_drive()),
        ("bart", sketch::bart()),
    ] {
        let (read, made) = (lower::lower(&model(name))?, lower::lower(&by_hand)?);
        let mut random = sketch::numbers(5);
        for _ in 0..50 {
            let mut take = |count: usize| -> Vec<f64> { random.by_ref().take(count).collect() };
            let (state, action, params) = (take(6), take(4), take(3));
            for (read, made) in [
                (&read.derivative, &made.derivative),
                (&read.outputs, &made.outputs),
                (&read.state_jacobian, &made.state_jacobian),
            ] {
                let found = read.reference(&state, &action, &params);
                assert_near(&found, &made.reference(&state, &action, &params));
            }
        }
    }
    Ok(())
}

#[test]
fn constant_actions_give_the_known_arcs() -> Outcome {
    // Wheels of 0.1 m at 1 and 3 rad/s, 0.4 m apart: 0.2 m/s and 0.5 rad/s.
    let found = driven(
        "differential-drive",
        &[0.4, 0.1],
        &[0.0; 3],
        &[1.0, 3.0],
        4.0,
    )?;
    assert_near(&found, &on_circle(0.4, 2.0));
    // A car that steers by 45 degrees goes round in a circle of its length.
    let found = driven("bicycle", &[2.5], &[0.0; 3], &[1.0, FRAC_PI_4], 5.0)?;
    assert_near(&found, &on_circle(2.5, 2.0));
    let found = driven("unicycle", &[0.1], &[0.0; 3], &[5.0, 0.25], 4.0)?;
    assert_near(&found, &on_circle(2.0, 1.0));
    Ok(())
}

#[test]
fn bart_in_pure_translation_keeps_its_heading() -> Outcome {
    // Both blocks look 0.7 rad to the left and roll alike.
    let start = [1.0, 0.5, 0.7, -1.0, 0.25, 0.7];
    let params = [0.2, 0.1, 0.05];
    let mut robot = Robot::new(&model("bart"), &params)?;
    let end = driven("bart", &params, &start, &[3.0; 4], 10.0)?;
    let mut poses = [[0.0; 3]; 2];
    robot.output(&start, &[3.0; 4], &mut poses[0]);
    robot.output(&end, &[3.0; 4], &mut poses[1]);
    let way = 0.1 * 3.0 * 10.0;
    let [x, y, theta] = poses[0];
    let expected = [x + way * 0.7_f64.cos(), y + way * 0.7_f64.sin(), theta];
    assert_near(&poses[1], &expected);
    Ok(())
}

#[test]
fn a_trailer_gets_behind_its_car() -> Outcome {
    // Straight on, the angle between both falls by the law tan(a / 2) = tan(a0 / 2) e^(-s / hitch).
    let found = driven(
        "trailer",
        &[2.0, 3.0],
        &[0.0, 0.0, 0.0, -1.0],
        &[1.0, 0.0],
        6.0,
    )?;
    let angle = 2.0 * (0.5_f64.tan() * (-2.0_f64).exp()).atan();
    assert_near(&found, &[6.0, 0.0, 0.0, -angle]);
    Ok(())
}

#[test]
fn wheels_with_rollers_go_sideways_and_turn_on_the_spot() -> Outcome {
    let params = [0.05, 0.2, 0.15];
    let found = driven("mecanum", &params, &[0.0; 3], &[-4.0, 4.0, 4.0, -4.0], 5.0)?;
    assert_near(&found, &[0.0, 1.0, 0.0]);
    let found = driven("mecanum", &params, &[0.0, 0.0, 1.0], &[4.0; 4], 5.0)?;
    assert_near(&found, &[1.0_f64.cos(), 1.0_f64.sin(), 1.0]);
    let found = driven(
        "mecanum",
        &params,
        &[1.0, 2.0, 0.0],
        &[-4.0, 4.0, -4.0, 4.0],
        7.0,
    )?;
    assert_near(&found, &[1.0, 2.0, 0.05 * 4.0 * 7.0 / 0.35]);
    Ok(())
}

#[test]
fn a_car_of_dubins_has_one_speed_and_one_of_reeds_and_shepp_goes_back() -> Outcome {
    let params = [2.0, 4.0];
    let found = driven("dubins", &params, &[0.0; 3], &[1.0], 3.0)?;
    assert_near(&found, &on_circle(4.0, 1.5));
    let found = driven("dubins", &params, &[0.0; 3], &[0.0], 3.0)?;
    assert_near(&found, &[6.0, 0.0, 0.0]);
    let there = driven("reeds-shepp", &params, &[0.0; 3], &[1.0, 1.0], 3.0)?;
    assert_near(&there, &on_circle(4.0, 1.5));
    let back = driven("reeds-shepp", &params, &there, &[-0.3, 1.0], 3.0)?;
    assert_near(&back, &[0.0; 3]);
    let stood = driven("reeds-shepp", &params, &there, &[0.0, 1.0], 3.0)?;
    assert_near(&stood, &there);
    Ok(())
}

#[test]
fn a_force_gives_a_unicycle_its_speed() -> Outcome {
    let params = [2.0, 0.5];
    let found = driven("dynamic-unicycle", &params, &[0.0; 5], &[1.0, 0.0], 4.0)?;
    assert_near(&found, &[4.0, 0.0, 0.0, 2.0, 0.0]);
    let moving = [0.0, 0.0, 0.0, 1.0, 0.5];
    let found = driven("dynamic-unicycle", &params, &moving, &[0.0, 0.0], 2.0)?;
    let [x, y, theta] = on_circle(2.0, 1.0);
    assert_near(&found, &[x, y, theta, 1.0, 0.5]);
    Ok(())
}

#[test]
fn wheels_that_do_not_slip_never_move_along_their_axle() -> Outcome {
    for (name, params) in [
        ("differential-drive", vec![0.4, 0.1]),
        ("bicycle", vec![2.5]),
        ("trailer", vec![2.5, 3.0]),
        ("unicycle", vec![0.1]),
        ("dubins", vec![1.0, 2.0]),
        ("reeds-shepp", vec![1.0, 2.0]),
        ("dynamic-unicycle", vec![1.0, 2.0]),
    ] {
        let mut robot = Robot::new(&model(name), &params)?;
        let mut random = crate::sketch::numbers(9);
        for _ in 0..100 {
            let state: Vec<f64> = random.by_ref().take(robot.states()).collect();
            let action: Vec<f64> = random.by_ref().take(robot.actions()).collect();
            let mut rate = vec![0.0; robot.states()];
            robot.derivative(&state, &action, &mut rate);
            let aside = rate[0] * state[2].sin() - rate[1] * state[2].cos();
            assert!(aside.abs() < 1e-15, "{name}: {aside}");
            if name == "trailer" {
                // The axle of the trailer, `hitch` behind that of the car.
                let (sin, cos) = state[3].sin_cos();
                let (x, y) = (rate[0] + 3.0 * sin * rate[3], rate[1] - 3.0 * cos * rate[3]);
                let aside = x * sin - y * cos;
                assert!(aside.abs() < 1e-14, "{name}: {aside}");
            }
        }
    }
    Ok(())
}
