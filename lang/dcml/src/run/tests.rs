//! The machine, one state and many at a time, against what tapes mean.

use super::batch::Batch;
use super::*;
use crate::lower::lower;
use crate::sketch::{self, Sketch, if_less, number, numbers, of, of_two};
use crate::syntax::Kind;
use crate::tape::Lowered;

/// A model with every operation.
fn everything() -> crate::model::Model {
    let mut sketch = Sketch::new("Everything");
    let [u] = sketch.names(Kind::Action, ["u"]);
    let [p] = sketch.names(Kind::Param, ["p"]);
    let [x, y] = sketch.names(Kind::Config, ["x", "y"]);
    let mut sum = number(1.0);
    for function in Function::ALL {
        let inner = &x * &p;
        sum = sum
            + match function.arguments() {
                1 => of(function, &inner) / number(8.0),
                _ => of_two(function, &inner, &u) / number(-3.0),
            };
    }
    sketch.rate(&x, if_less(&x, &u, sum.clone(), &y - &sum));
    sketch.rate(&y, crate::model::Expr::Negative(Box::new(sum)));
    sketch.model()
}

fn bits(numbers: &[f64]) -> Vec<u64> {
    let bits = |one: &f64| {
        if one.is_nan() {
            u64::MAX
        } else {
            one.to_bits()
        }
    };
    numbers.iter().map(bits).collect()
}

#[test]
fn the_machine_gives_what_the_tape_means() -> Result<(), Refused> {
    for model in [sketch::differential_drive(), sketch::bart(), everything()] {
        let Lowered {
            derivative,
            outputs,
            state_jacobian,
            action_jacobian,
        } = lower(&model)?;
        let params = [0.5, 0.125, 0.3];
        let params = &params[..model.of_kind(Kind::Param).count()];
        for tape in [derivative, outputs, state_jacobian, action_jacobian] {
            let mut machine = Machine::new(Program::new(&tape, params)?);
            let mut random = numbers(3);
            for _ in 0..200 {
                let state: Vec<f64> = random.by_ref().take(9).collect();
                let action: Vec<f64> = random.by_ref().take(4).collect();
                let expected = tape.reference(&state, &action, params);
                let mut found = vec![0.0; expected.len()];
                machine.run(&state, &action, &mut found);
                assert_eq!(bits(&found), bits(&expected), "{}", model.name);
            }
        }
    }
    Ok(())
}

#[test]
fn parameters_are_worked_in_and_registers_used_again() -> Result<(), Refused> {
    let code = lower(&sketch::bart())?;
    let program = Program::new(&code.derivative, &[0.2, 0.1, 0.05])?;
    assert!(program.registers() < code.derivative.operations.len() / 2);
    assert!(program.steps.len() < 35, "{}", program.steps.len());
    let fused = program
        .steps
        .iter()
        .filter(|one| matches!(one, Step::SinCos(..)));
    assert_eq!(fused.count(), 2);
    Ok(())
}

#[test]
fn numbers_that_are_none_are_refused_and_lost_ones_are_seen() -> Result<(), Refused> {
    let code = lower(&sketch::differential_drive())?;
    assert!(Program::new(&code.derivative, &[0.5]).is_err());
    assert!(Program::new(&code.derivative, &[0.5, f64::INFINITY]).is_err());
    let mut machine = Machine::new(Program::new(&code.derivative, &[0.0, 0.1])?);
    let mut found = [0.0; 3];
    machine.run(&[0.0; 3], &[1.0, 2.0], &mut found);
    assert_eq!(found[2], f64::INFINITY, "no distance between the wheels");
    machine.run(&[0.0; 2], &[1.0, 2.0], &mut found);
    assert!(found[0].is_nan());
    machine.run(&[0.0; 3], &[1.0, 2.0], &mut []);
    let mut wrong = code.derivative.clone();
    wrong.operations.swap(0, 15);
    assert!(Program::new(&wrong, &[0.5, 0.1]).is_err());
    Ok(())
}

#[test]
fn a_batch_gives_what_the_machine_gives_state_by_state() -> Result<(), Refused> {
    for (model, params) in [
        (sketch::bart(), vec![0.2, 0.1, 0.05]),
        (everything(), vec![0.7]),
    ] {
        let code = lower(&model)?;
        let program = Program::new(&code.derivative, &params)?;
        let (states, actions) = (model.states().count(), model.of_kind(Kind::Action).count());
        let mut machine = Machine::new(program.clone());
        let mut batch = Batch::new(program)?;
        for count in [0, 1, 63, 64, 65, 200] {
            let all: Vec<f64> = numbers(11).take(count * states).collect();
            let given: Vec<f64> = numbers(12).take(count * actions).collect();
            let mut found = vec![0.0; count * states];
            batch.run(count, &all, &given, &mut found);
            for one in 0..count {
                let column = |rows: &[f64]| -> Vec<f64> {
                    rows.iter().skip(one).step_by(count).copied().collect()
                };
                let mut expected = vec![0.0; states];
                machine.run(&column(&all), &column(&given), &mut expected);
                for (found, expected) in column(&found).iter().zip(&expected) {
                    let allowed = 1e-12 * (1.0 + expected.abs());
                    let is_same = found.is_nan() && expected.is_nan();
                    assert!(is_same || (found - expected).abs() <= allowed);
                }
            }
        }
    }
    Ok(())
}
