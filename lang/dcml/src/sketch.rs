//! Small models made by a program, for tests of what comes after the reader of texts.

use super::function::Function;
use super::model::{Condition, Equation, Expr, Model, Symbol};
use super::syntax::{Comparison, Kind, Operator, Span};
use std::ops;

/// A model that grows.
pub struct Sketch(Model);

impl Sketch {
    /// An empty one.
    pub fn new(name: &str) -> Self {
        Self(Model {
            name: name.into(),
            package: None,
            doc: None,
            symbols: Vec::new(),
            equations: Vec::new(),
        })
    }

    /// Declares names, and gives what they are in expressions.
    pub fn names<const N: usize>(&mut self, kind: Kind, names: [&str; N]) -> [Expr; N] {
        names.map(|name| {
            self.0.symbols.push(Symbol {
                name: name.into(),
                span: Span::default(),
                kind,
                doc: None,
                unit: None,
                domain: None,
                value: 0.0,
            });
            Expr::Symbol(self.0.symbols.len() - 1)
        })
    }

    /// `target = value;`
    pub fn set(&mut self, target: &Expr, value: Expr) {
        self.equation(target, false, value);
    }

    /// `d(target) = value;`
    pub fn rate(&mut self, target: &Expr, value: Expr) {
        self.equation(target, true, value);
    }

    fn equation(&mut self, target: &Expr, is_derivative: bool, value: Expr) {
        let Expr::Symbol(target) = target else {
            panic!("only symbols have equations");
        };
        self.0.equations.push(Equation {
            target: *target,
            is_derivative,
            value,
            span: Span::default(),
        });
    }

    /// The model; derivatives are to be given last, in the order of states.
    pub fn model(self) -> Model {
        self.0
    }
}

/// A number.
pub fn number(number: f64) -> Expr {
    Expr::Number(number)
}

/// A function of one value.
pub fn of(function: Function, x: &Expr) -> Expr {
    Expr::Call(function, vec![x.clone()])
}

/// A function of two values.
pub fn of_two(function: Function, x: &Expr, y: &Expr) -> Expr {
    Expr::Call(function, vec![x.clone(), y.clone()])
}

/// `piecewise(left < right, value, otherwise)`
pub fn if_less(left: &Expr, right: &Expr, value: Expr, otherwise: Expr) -> Expr {
    let condition = Condition {
        comparison: Comparison::Less,
        left: left.clone(),
        right: right.clone(),
    };
    Expr::Piecewise(vec![(condition, value)], Box::new(otherwise))
}

macro_rules! operator {
    ($form:ident, $method:ident, $operator:ident) => {
        impl ops::$form for Expr {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self::Binary(Operator::$operator, Box::new(self), Box::new(other))
            }
        }
        impl ops::$form for &Expr {
            type Output = Expr;
            fn $method(self, other: Self) -> Expr {
                self.clone().$method(other.clone())
            }
        }
    };
}
operator!(Add, add, Add);
operator!(Sub, sub, Subtract);
operator!(Mul, mul, Multiply);
operator!(Div, div, Divide);

/// The published robot with two driven wheels.
pub fn differential_drive() -> Model {
    let mut sketch = Sketch::new("DifferentialDrive");
    let [left, right] = sketch.names(Kind::Action, ["u_l", "u_r"]);
    let [l, r] = sketch.names(Kind::Param, ["L", "r"]);
    let [x, y, theta] = sketch.names(Kind::Config, ["x", "y", "theta"]);
    let half = &r / &number(2.0);
    let ahead = &half * &(&left + &right);
    sketch.rate(&x, &ahead * &of(Function::Cos, &theta));
    sketch.rate(&y, &ahead * &of(Function::Sin, &theta));
    sketch.rate(&theta, &(&r / &l) * &(&right - &left));
    sketch.model()
}

/// The published robot with two steered blocks of two wheels.
pub fn bart() -> Model {
    let mut sketch = Sketch::new("Bart");
    let [lf, rf, lr, rr] = sketch.names(
        Kind::Action,
        ["left_f_s", "right_f_s", "left_r_s", "right_r_s"],
    );
    let [half_axis, radius, offset] = sketch.names(
        Kind::Param,
        ["tt_wheel_half_axis", "tt_wheel_radius", "tt_steer_offset"],
    );
    let [x, y, theta] = sketch.names(Kind::Config, ["x", "y", "theta"]);
    let front = sketch.names(Kind::Config, ["x_front", "y_front", "phi_front"]);
    let rear = sketch.names(Kind::Config, ["x_rear", "y_rear", "phi_rear"]);
    let [k] = sketch.names(Kind::Var, ["k"]);
    let two = number(2.0);
    sketch.set(&k, &offset / &half_axis);
    sketch.set(&x, &(&front[0] + &rear[0]) / &two);
    sketch.set(&y, &(&front[1] + &rear[1]) / &two);
    let across = of_two(
        Function::Atan2,
        &(&front[1] - &rear[1]),
        &(&front[0] - &rear[0]),
    );
    sketch.set(&theta, across + number(std::f64::consts::PI) / number(4.0));
    for ([x, y, phi], right, left) in [(front, rf, lf), (rear, rr, lr)] {
        let (sin, cos) = (of(Function::Sin, &phi), of(Function::Cos, &phi));
        let half = &radius / &two;
        let (ks, kc) = (&k * &sin, &k * &cos);
        sketch.rate(
            &x,
            &half * &(&((&cos - &ks) * right.clone()) + &((&cos + &ks) * left.clone())),
        );
        sketch.rate(
            &y,
            &half * &(&((&sin + &kc) * right.clone()) + &((&sin - &kc) * left.clone())),
        );
        sketch.rate(&phi, &(&radius / &(&two * &half_axis)) * &(&right - &left));
    }
    sketch.model()
}

/// Numbers that look random, from -1 to 1.
pub fn numbers(seed: u32) -> impl Iterator<Item = f64> {
    let mut state = seed.wrapping_mul(2_654_435_761) | 1;
    std::iter::repeat_with(move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        f64::from(state) / f64::from(u32::MAX) * 2.0 - 1.0
    })
}
