//! Published robots against their formulas, and models that are too large or wrong.

use super::*;
use crate::function::Function;
use crate::sketch::{self, Sketch, number, of};

#[test]
fn the_published_robots_are_the_formulas_of_their_paper() -> Result<(), Refused> {
    let code = lower(&sketch::differential_drive())?;
    let found = code
        .derivative
        .reference(&[7.0, 8.0, 0.5], &[1.0, 3.0], &[0.4, 0.1]);
    let expected = [0.2 * 0.5_f64.cos(), 0.2 * 0.5_f64.sin(), 0.5];
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    let code = lower(&sketch::bart())?;
    let state = [2.0, 1.0, 0.3, -1.0, 1.0, 0.3];
    let found = code
        .derivative
        .reference(&state, &[1.0; 4], &[0.2, 0.1, 0.05]);
    assert_eq!(found[2], 0.0, "equal wheels do not turn a block");
    assert!((found[0] - 0.1 * 0.3_f64.cos()).abs() < 1e-15);
    let outputs = code.outputs.reference(&state, &[1.0; 4], &[0.2, 0.1, 0.05]);
    assert_eq!(outputs, [0.5, 1.0, std::f64::consts::FRAC_PI_4]);
    Ok(())
}

#[test]
fn each_value_is_computed_once() -> Result<(), Refused> {
    let code = lower(&sketch::differential_drive())?;
    // Two actions, a state, two parameters, 2; r/2, the sum, their product, cos, sin, two products, r/L, a difference and
    // the last product.
    assert_eq!(code.derivative.operations.len(), 16);
    let code = lower(&sketch::bart())?;
    let is_trig = |one: &&Operation| matches!(one, Operation::Call(..));
    let count = code.derivative.operations.iter().filter(is_trig).count();
    assert_eq!(count, 4, "sine and cosine of two angles");
    Ok(())
}

#[test]
fn conditions_are_tried_in_their_order() -> Result<(), Refused> {
    let mut sketch = Sketch::new("Steps");
    let [u] = sketch.names(Kind::Action, ["u"]);
    let [x] = sketch.names(Kind::Config, ["x"]);
    let less = |limit: f64| Condition {
        comparison: crate::syntax::Comparison::Less,
        left: u.clone(),
        right: number(limit),
    };
    let branches = vec![(less(0.0), number(1.0)), (less(10.0), number(2.0))];
    sketch.rate(&x, Expr::Piecewise(branches, Box::new(number(3.0))));
    let code = lower(&sketch.model())?;
    let at = |u: f64| code.derivative.reference(&[0.0], &[u], &[])[0];
    assert_eq!(
        [at(-1.0), at(5.0), at(10.0), at(f64::NAN)],
        [1.0, 2.0, 3.0, 3.0]
    );
    Ok(())
}

#[test]
fn what_no_check_has_seen_is_refused_and_harms_nobody() {
    let mut sketch = Sketch::new("Wrong");
    let [x, y] = sketch.names(Kind::Config, ["x", "y"]);
    sketch.rate(&x, y.clone());
    let told = lower(&sketch.model()).map_err(|refused| refused.to_string());
    assert_eq!(told, Err("y is used before it has a value".into()));
    for wrong in [
        Expr::Symbol(99),
        Expr::Call(Function::Atan2, vec![number(1.0)]),
        Expr::Call(Function::Sin, vec![]),
        number(f64::NAN),
    ] {
        let mut sketch = Sketch::new("Wrong");
        let [x] = sketch.names(Kind::Config, ["x"]);
        sketch.rate(&x, wrong);
        assert!(lower(&sketch.model()).is_err());
    }
}

#[test]
fn size_and_depth_have_ends() {
    let mut sketch = Sketch::new("Deep");
    let [x] = sketch.names(Kind::Config, ["x"]);
    let mut deep = x.clone();
    for _ in 0..2 * limits::DCML_DEPTH {
        deep = of(Function::Sin, &deep);
    }
    sketch.rate(&x, deep);
    assert!(matches!(lower(&sketch.model()), Err(Refused::TooLarge(..))));

    let mut sketch = Sketch::new("Wide");
    let count = 1100;
    let mut all = Vec::new();
    for at in 0..count {
        let [x] = sketch.names(Kind::Config, [format!("x{at}").as_str()]);
        all.push(x);
    }
    for x in &all {
        sketch.rate(x, x.clone());
    }
    let model = sketch.model();
    assert!(equations(&model).is_ok(), "it can be run");
    let told = lower(&model).map_err(|refused| refused.to_string());
    let expected = "the model is too large: more than 1048576 elements of a Jacobian";
    assert_eq!(told.err().as_deref(), Some(expected));
}
