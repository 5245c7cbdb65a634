//! Slopes held against differences, corners, and what is refused.

use super::*;
use crate::lower::{equations, lower};
use crate::model::{Expr, Model};
use crate::sketch::{self, Sketch, if_less, number, numbers, of, of_two};
use crate::syntax::Kind;

/// Holds both Jacobians against differences of the derivatives at some states.
fn compare(model: &Model, scale: f64, shift: f64) -> Result<(), Refused> {
    let code = lower(model)?;
    let states = model.states().count();
    let actions = model.of_kind(Kind::Action).count();
    let params = model.of_kind(Kind::Param).count();
    let mut random = numbers(7).map(|one| one * scale + shift);
    for _ in 0..50 {
        let mut take = |count: usize| -> Vec<f64> { random.by_ref().take(count).collect() };
        let (state, action) = (take(states), take(actions));
        let params: Vec<f64> = take(params).iter().map(|one| one.abs() + 0.5).collect();
        let by_state = code.state_jacobian.reference(&state, &action, &params);
        let by_action = code.action_jacobian.reference(&state, &action, &params);
        for column in 0..states + actions {
            let at = |step: f64| {
                let (mut state, mut action) = (state.clone(), action.clone());
                match column.checked_sub(states) {
                    None => state[column] += step,
                    Some(action_column) => action[action_column] += step,
                }
                code.derivative.reference(&state, &action, &params)
            };
            let step = 1e-6;
            let (after, before) = (at(step), at(-step));
            for row in 0..states {
                let expected = (after[row] - before[row]) / (2.0 * step);
                let found = match column.checked_sub(states) {
                    None => by_state[row * states + column],
                    Some(column) => by_action[row * actions + column],
                };
                let allowed = 1e-7 * (1.0 + expected.abs());
                let name = &model.name;
                assert!(
                    (found - expected).abs() <= allowed,
                    "{name}: row {row}, column {column} at {state:?}, {action:?}: {found}, not {expected}"
                );
            }
        }
    }
    Ok(())
}

/// x' = f(x, u), with whatever f is made of.
fn with(name: &str, make: impl FnOnce(&Expr, &Expr) -> Expr) -> Model {
    let mut sketch = Sketch::new(name);
    let [u] = sketch.names(Kind::Action, ["u"]);
    let [x] = sketch.names(Kind::Config, ["x"]);
    let value = make(&x, &u);
    sketch.rate(&x, value);
    sketch.model()
}

#[test]
fn both_published_robots_have_the_slopes_of_their_derivatives() -> Result<(), Refused> {
    compare(&sketch::differential_drive(), 3.0, 0.0)?;
    compare(&sketch::bart(), 3.0, 0.0)
}

#[test]
fn every_function_has_its_slope() -> Result<(), Refused> {
    for function in Function::ALL {
        // Where all of them are smooth, but for corners that are not met.
        let (scale, shift) = match function {
            Function::Asin | Function::Acos => (0.8, 0.0),
            Function::Log | Function::Sqrt | Function::Pow => (0.9, 1.2),
            Function::Tan => (1.2, 0.0),
            _ => (2.0, 0.0),
        };
        let model = with(function.name(), |x, u| match function.arguments() {
            1 => of(function, x) * u.clone() + of(function, u),
            _ => of_two(function, x, u) * x.clone(),
        });
        compare(&model, scale, shift)?;
    }
    Ok(())
}

#[test]
fn quotients_branches_and_chains_have_their_slopes() -> Result<(), Refused> {
    compare(&with("quotient", |x, u| (x * u) / (x + u)), 0.9, 2.0)?;
    let chain = with("chain", |x, u| {
        let below = of(Function::Exp, &(of(Function::Sin, x) * u.clone())) + number(1.0);
        of_two(Function::Atan2, &below, &of(Function::Cos, u)) / below
    });
    compare(&chain, 1.0, 0.0)?;
    let branches = with("branches", |x, u| {
        let minus = Expr::Negative(Box::new(x * x));
        if_less(x, u, x * u, minus)
    });
    compare(&branches, 2.0, 0.0)?;
    let powers = with("powers", |x, u| {
        let square = of_two(Function::Pow, x, &number(2.0));
        let none = of_two(Function::Pow, x, &number(0.0));
        let cube = of_two(Function::Pow, u, &number(3.0));
        square + none + cube
    });
    compare(&powers, 2.0, 0.0)
}

#[test]
fn slopes_at_corners_are_those_of_one_side() -> Result<(), Refused> {
    let slope = |model: &Model, x: f64, u: f64| -> Result<[f64; 2], Refused> {
        let code = lower(model)?;
        let by_state = code.state_jacobian.reference(&[x], &[u], &[]);
        let by_action = code.action_jacobian.reference(&[x], &[u], &[]);
        Ok([by_state[0], by_action[0]])
    };
    let abs = with("abs", |x, _| of(Function::Abs, x));
    assert_eq!(slope(&abs, 0.0, 0.0)?, [0.0, 0.0]);
    for function in [Function::Min, Function::Max] {
        let model = with(function.name(), |x, u| of_two(function, x, u));
        assert_eq!(slope(&model, 1.0, 1.0)?, [1.0, 0.0]);
    }
    let power = with("power", |x, u| of_two(Function::Pow, x, u));
    assert_eq!(slope(&power, 0.0, 2.0)?, [0.0, 0.0]);
    assert!(slope(&power, -2.0, 3.0)?[1].is_nan(), "there is none");
    Ok(())
}

/// A root or an arc sine behind a guard is level outside of it, although its own slope is infinite at the edge.
#[test]
fn what_a_guard_keeps_constant_is_level() -> Result<(), Refused> {
    let slope = |model: &Model, x: f64, u: f64| -> Result<f64, Refused> {
        Ok(lower(model)?.state_jacobian.reference(&[x], &[u], &[])[0])
    };
    let root = with("root", |x, _| {
        of(Function::Sqrt, &of_two(Function::Max, x, &number(0.0)))
    });
    assert_eq!(slope(&root, -1.0, 0.0)?, 0.0);
    assert_eq!(slope(&root, 4.0, 0.0)?, 0.25);
    let arc = with("arc", |x, _| {
        let least = of_two(Function::Max, x, &number(-1.0));
        of(Function::Acos, &of_two(Function::Min, &least, &number(1.0)))
    });
    for x in [-2.0, 2.0] {
        assert_eq!(slope(&arc, x, 0.0)?, 0.0, "{x}");
    }
    assert_eq!(slope(&arc, 0.0, 0.0)?, -1.0);
    Ok(())
}

#[test]
fn beside_what_is_no_number_the_other_one_is_followed() -> Result<(), Refused> {
    for function in [Function::Min, Function::Max] {
        for is_first in [true, false] {
            let model = with(function.name(), |x, u| {
                let root = of(Function::Sqrt, u);
                let twice = number(2.0) * x.clone();
                if is_first {
                    of_two(function, &root, &twice)
                } else {
                    of_two(function, &twice, &root)
                }
            });
            let code = lower(&model)?;
            let slope = code.state_jacobian.reference(&[3.0], &[-1.0], &[]);
            assert_eq!(slope, [2.0], "{function:?} {is_first}");
            let other = code.action_jacobian.reference(&[3.0], &[-1.0], &[]);
            assert_eq!(other, [0.0], "{function:?} {is_first}");
        }
    }
    Ok(())
}

#[test]
fn what_does_not_depend_is_zero_and_nothing_more() -> Result<(), Refused> {
    let code = lower(&sketch::differential_drive())?;
    let jacobian = &code.state_jacobian;
    let zero = |id: &ValueId| jacobian.operations[*id as usize] == Operation::Constant(0.0);
    let zeros: Vec<bool> = jacobian.results.iter().map(zero).collect();
    let expected = [true, true, false, true, true, false, true, true, true];
    assert_eq!(zeros, expected);
    // r cos(theta) / 2 twice: the same value.
    assert_eq!(
        code.action_jacobian.results[0],
        code.action_jacobian.results[1]
    );
    Ok(())
}

#[test]
fn a_chain_of_many_inputs_ends_with_an_error_and_not_with_the_memory() -> Result<(), Refused> {
    let mut sketch = Sketch::new("Chain");
    let names: Vec<String> = (0..1000).map(|at| format!("x{at}")).collect();
    let mut all = Vec::new();
    for name in &names {
        all.extend(sketch.names(Kind::Config, [name.as_str()]));
    }
    // Each intermediate value depends on all states.
    let mut last = number(0.0);
    for at in 0..20_000 {
        let [var] = sketch.names(Kind::Var, [format!("v{at}").as_str()]);
        sketch.set(&var, of(Function::Sin, &(&last + &all[at % all.len()])));
        last = var;
    }
    for x in &all {
        sketch.rate(x, last.clone());
    }
    let model = sketch.model();
    assert!(equations(&model).is_ok());
    assert!(matches!(lower(&model), Err(Refused::TooLarge(..))));
    Ok(())
}

/// Numbers of SymPy 1.14.0, with 17 digits.
#[test]
fn another_library_finds_the_same_slopes() -> Result<(), Refused> {
    let code = lower(&sketch::bart())?;
    let state = [1.0, 2.0, 0.7, 3.0, 4.0, -1.3];
    let (action, params) = ([2.0, -3.0, 0.5, 4.0], [0.2, 0.1, 0.05]);
    let compare = |tape: &Tape, columns: usize, expected: &[(usize, usize, f64)]| {
        let mut rest = tape.reference(&state, &action, &params);
        for (row, column, expected) in expected {
            let found = std::mem::take(&mut rest[row * columns + column]);
            assert!((found - expected).abs() < 1e-15, "{row} {column}: {found}");
        }
        assert!(rest.iter().all(|one| *one == 0.0), "{rest:?}");
    };
    let by_state = [
        (0, 2, 0.080_013_521_067_165_08),
        (1, 2, 0.002_021_496_088_131_269_5),
        (3, 5, 0.205_097_517_966_542_72),
        (4, 5, 0.102_342_907_052_534_36),
    ];
    compare(&code.state_jacobian, 6, &by_state);
    let by_action = [
        (0, 0, 0.046_294_830_454_695_56),
        (0, 1, 0.030_189_388_273_753_28),
        (1, 0, 0.022_650_357_020_828_447),
        (1, 1, 0.041_771_411_702_940_66),
        (2, 0, -0.25),
        (2, 1, 0.25),
        (3, 2, 0.001_330_464_113_514_458_3),
        (3, 3, 0.025_419_418_748_944_28),
        (4, 2, -0.051_521_644_628_666_99),
        (4, 3, -0.044_834_173_913_052_306),
        (5, 2, -0.25),
        (5, 3, 0.25),
    ];
    compare(&code.action_jacobian, 4, &by_action);
    Ok(())
}
