//! A model with parameters as a system.

use super::*;
use crate::sketch;

#[test]
fn a_robot_is_a_system() -> Result<(), Refused> {
    let mut model = sketch::differential_drive();
    model.symbols[0].domain = Some(Domain::Range(-2.0, 2.0));
    model.symbols[6].domain = Some(Domain::Circle);
    let mut robot = Robot::new(&model, &[0.4, 0.1])?;
    assert_eq!((robot.states(), robot.actions()), (3, 2));
    assert_eq!(robot.action_range(0), Some((-2.0, 2.0)));
    assert_eq!(robot.action_range(1), None);
    assert_eq!(
        [0, 1, 2, 3].map(|one| robot.wraps(one)),
        [false, false, true, false]
    );
    assert_eq!(robot.state_parts()[2].name, "theta");
    let mut derivative = [0.0; 3];
    robot.derivative(&[0.0; 3], &[1.0, 2.0], &mut derivative);
    for (found, expected) in derivative.iter().zip([0.15, 0.0, 0.25]) {
        assert!((found - expected).abs() < 1e-15, "{derivative:?}");
    }
    Ok(())
}

#[test]
fn outputs_and_slopes_are_there_too() -> Result<(), Refused> {
    let model = sketch::bart();
    let mut robot = Robot::new(&model, &[0.2, 0.1, 0.05])?;
    let mut outputs = [0.0; 3];
    robot.output(&[2.0, 1.0, 0.0, 0.0, 1.0, 0.0], &[0.0; 4], &mut outputs);
    assert_eq!(outputs, [1.0, 1.0, std::f64::consts::FRAC_PI_4]);
    let mut jacobians = Jacobians::new(&model, &[0.2, 0.1, 0.05])?;
    let mut by_action = [f64::NAN; 24];
    jacobians.by_action(&[0.0; 6], &[0.0; 4], &mut by_action);
    // The right front wheel of a block that looks along x: ahead, aside by the offset, and round.
    let column = [by_action[1], by_action[5], by_action[9], by_action[13]];
    for (found, expected) in column.iter().zip([0.05, 0.0125, 0.25, 0.0]) {
        assert!((found - expected).abs() < 1e-15, "{column:?}");
    }
    let mut by_state = [f64::NAN; 36];
    jacobians.by_state(&[0.0; 6], &[0.0; 4], &mut by_state);
    assert_eq!(by_state, [0.0; 36], "a robot that stands");
    Ok(())
}

#[test]
fn parameters_are_counted_and_named() {
    let model = sketch::differential_drive();
    let told = |params: &[f64]| Robot::new(&model, params).map_err(|refused| refused.to_string());
    assert_eq!(
        told(&[1.0]).err().as_deref(),
        Some("the model has 2 parameters, and 1 were given")
    );
    assert_eq!(
        told(&[1.0, f64::NAN]).err().as_deref(),
        Some("the parameter r cannot be NaN: give a number")
    );
}
