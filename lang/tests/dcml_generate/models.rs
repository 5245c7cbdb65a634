//! Models for the tests: the published ones, random ones, and the ways to build them.

use lang::dcml::function::Function;
use lang::dcml::model::{Condition, Equation, Expr, Model, Symbol};
use lang::dcml::syntax::{Comparison, Domain, Kind, Operator, Span};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// The two published models, and one with everything that the language has beside them.
pub const PUBLISHED: &str = "
/**
 * A robot with two driven wheels.
 * Its place is the middle between them.
 */
BEGIN DifferentialDrive
PACKAGE: robotics.models;
ACTION: u_l, u_r;
PARAM: L, r;
CONFIG: x, y, theta;
d(x) = r / 2 * (u_l + u_r) * cos(theta);
d(y) = r / 2 * (u_l + u_r) * sin(theta);
d(theta) = (r / L) * (u_r - u_l);
END;
BEGIN Bart
PACKAGE: robotics.models;
ACTION: left_f_s, right_f_s, left_r_s, right_r_s;
PARAM : tt_wheel_half_axis, tt_wheel_radius, tt_steer_offset;
CONFIG: x, y, theta, x_front, y_front, phi_front, x_rear, y_rear, phi_rear;
VAR: k;
k = tt_steer_offset / tt_wheel_half_axis;
d(x_front) = (tt_wheel_radius/2) * (((cos(phi_front) - k * sin(phi_front)) * right_f_s) + ((cos(phi_front) + k * sin(phi_front)) * left_f_s));
d(y_front) = (tt_wheel_radius/2) * (((sin(phi_front) + k * cos(phi_front)) * right_f_s) + ((sin(phi_front) - k * cos(phi_front)) * left_f_s));
d(phi_front) = (tt_wheel_radius / (2 * tt_wheel_half_axis)) * (right_f_s - left_f_s);
d(x_rear) = (tt_wheel_radius/2) * (((cos(phi_rear) - k * sin(phi_rear)) * right_r_s) + ((cos(phi_rear) + k * sin(phi_rear)) * left_r_s));
d(y_rear) = (tt_wheel_radius/2) * (((sin(phi_rear) + k * cos(phi_rear)) * right_r_s) + ((sin(phi_rear) - k * cos(phi_rear)) * left_r_s));
d(phi_rear) = (tt_wheel_radius / (2 * tt_wheel_half_axis)) * (right_r_s - left_r_s);
x = (x_front + x_rear)/2;
y = (y_front + y_rear)/2;
theta = atan2((y_front-y_rear),(x_front-x_rear)) + (pi / 4);
END;
BEGIN Everything
ACTION: push [N] in -2 .. 2, turn [rad/s];
PARAM: mass [kg], drag;
CONST: g = 9.81, soft = 0.125;
CONFIG: theta [rad] in S1, v;
VAR: slope, force;
slope = sin(theta) * g;
force = piecewise(v < 0, push * soft, v > 2, max(push, -1), push);
d(theta) = turn + atan(v) * soft;
d(v) = force / mass - slope - drag * v * abs(v) + sign(push) * floor(v) - pow(soft, 2);
END;
";

/// The models of [`PUBLISHED`].
pub fn published() -> Vec<Model> {
    let understood = lang::dcml::understand(PUBLISHED);
    let told: Vec<_> = understood
        .diagnostics
        .iter()
        .map(|one| &one.message)
        .collect();
    assert_eq!(understood.models.len(), 3, "{told:?}");
    understood.models
}

/// The models that are shipped, under names that no other has.
pub fn shipped() -> Vec<Model> {
    let mut models = Vec::new();
    for lang::dcml::models::Shipped { name, text, .. } in lang::dcml::models::ALL {
        let mut understood = lang::dcml::understand(text);
        let mut model = understood.models.remove(0);
        model.name = format!("Shipped_{}", name.replace('-', "_"));
        models.push(model);
    }
    models
}

/// A symbol without anything.
pub fn symbol(kind: Kind, name: &str) -> Symbol {
    Symbol {
        name: name.to_owned(),
        span: Span::default(),
        kind,
        doc: None,
        unit: None,
        domain: None,
        value: 0.0,
    }
}

pub fn equation(target: usize, is_derivative: bool, value: Expr) -> Equation {
    Equation {
        target,
        is_derivative,
        value,
        span: Span::default(),
    }
}

/// Numbers that are asked for in a model: what is easy to get wrong.
const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    2.0,
    3.0,
    0.1,
    -2.5,
    std::f64::consts::PI,
    std::f64::consts::E,
    std::f64::consts::FRAC_PI_4,
    1e16,
    9007199254740993.0,
    1e-300,
    5e-324,
    1.7976931348623157e308,
];
/// Where the symbols of random models stand: 3 states, 2 actions, 2 parameters, a constant, 3 variables, 2 outputs.
pub const SYMBOLS: [(Kind, &str); 13] = [
    (Kind::Config, "x"),
    (Kind::Config, "y"),
    (Kind::Config, "theta"),
    (Kind::Action, "u"),
    (Kind::Action, "v"),
    (Kind::Param, "L"),
    (Kind::Param, "r"),
    (Kind::Const, "g"),
    (Kind::Var, "k"),
    (Kind::Var, "speed"),
    (Kind::Var, "slip"),
    (Kind::Config, "front"),
    (Kind::Config, "rear"),
];

/// An expression over the symbols before one.
fn expr(before: Vec<usize>) -> impl Strategy<Value = Expr> {
    let leaf = prop_oneof![
        5 => proptest::sample::select(before).prop_map(Expr::Symbol),
        1 => proptest::sample::select(&NUMBERS[..]).prop_map(Expr::Number),
        1 => (-100_i32..100).prop_map(|number| Expr::Number(f64::from(number) / 8.0)),
    ];
    leaf.prop_recursive(6, 60, 4, |inner| {
        let operators = [
            Operator::Add,
            Operator::Subtract,
            Operator::Multiply,
            Operator::Divide,
        ];
        let comparisons = [
            Comparison::Less,
            Comparison::LessOrEqual,
            Comparison::Greater,
            Comparison::GreaterOrEqual,
        ];
        let two = (inner.clone(), inner.clone());
        let four = (two.clone(), two.clone());
        prop_oneof![
            1 => inner.prop_map(|value| Expr::Negative(Box::new(value))),
            6 => (proptest::sample::select(operators.to_vec()), two.clone()).prop_map(|(operator, (left, right))| {
                Expr::Binary(operator, Box::new(left), Box::new(right))
            }),
            4 => (proptest::sample::select(&Function::ALL[..]), two).prop_map(|(function, (x, y))| {
                let mut arguments = vec![x, y];
                arguments.truncate(function.arguments());
                Expr::Call(function, arguments)
            }),
            1 => (proptest::sample::select(comparisons.to_vec()), four).prop_map(|(comparison, ((left, right), (yes, no)))| {
                Expr::Piecewise(vec![(Condition { comparison, left, right }, yes)], Box::new(no))
            }),
        ]
    })
}

/// A model of random equations.
fn model() -> impl Strategy<Value = Model> {
    let first = || (0..8).collect::<Vec<_>>();
    let with = |last: usize| (0..last).collect::<Vec<_>>();
    let vars = (expr(first()), expr(with(9)), expr(with(10)));
    let outputs = (expr(with(11)), expr(with(12)));
    let rates = (expr(with(13)), expr(with(13)), expr(with(13)));
    (vars, outputs, rates, 1..100_i32).prop_map(|(vars, outputs, rates, g)| {
        let mut symbols: Vec<Symbol> = SYMBOLS
            .iter()
            .map(|(kind, name)| symbol(*kind, name))
            .collect();
        symbols[7].value = f64::from(g) * 0.0981;
        symbols[2].domain = Some(Domain::Circle);
        let plain = [
            (8, vars.0),
            (9, vars.1),
            (10, vars.2),
            (11, outputs.0),
            (12, outputs.1),
        ];
        let plain = plain.map(|(target, value)| equation(target, false, value));
        let rates = [(0, rates.0), (1, rates.1), (2, rates.2)];
        let rates = rates.map(|(target, value)| equation(target, true, value));
        Model {
            name: "Random".to_owned(),
            package: None,
            doc: None,
            symbols,
            equations: plain.into_iter().chain(rates).collect(),
        }
    })
}

/// So many random models, the same ones each time.
pub fn random(count: usize) -> Vec<Model> {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let strategy = model();
    let mut models = Vec::new();
    while models.len() < count {
        let model = strategy.new_tree(&mut runner).unwrap().current();
        // Some have constants that no number can be.
        if lang::dcml::lower::lower(&model).is_ok() {
            models.push(model);
        }
    }
    for (at, model) in models.iter_mut().enumerate() {
        model.name = format!("Random{at}");
    }
    models
}
