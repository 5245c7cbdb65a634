//! Models for the tests: one with everything, the shipped ones, random ones, and the ways to build them.

use lang_dcml::function::Function;
use lang_dcml::model::{Condition, Equation, Expr, Model, Symbol};
use lang_dcml::syntax::{Comparison, Domain, Kind, Operator, Span};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// What the language has beside the published models, in one model with documentation.
const EVERYTHING: &str = "
/**
 * A cart that is pushed on a slope.
 * It has all parts.
 */
BEGIN Everything
ACTION: push [N] in -2 .. 2, turn [rad/s];
PARAM: mass [kg], drag;
CONST: g = 9.81, soft = 0.125;
CONFIG: theta [rad] in S1, v, felt;
VAR: slope, force;
slope = sin(theta) * g;
force = piecewise(v < 0, push * soft, v > 2, max(push, -1), push);
d(theta) = turn + atan(v) * soft;
d(v) = force / mass - slope - drag * v * abs(v) + sign(push) * floor(v) - pow(soft, 2);
felt = d(v) + slope * d(theta);
END;
";

/// The only model of a text.
fn only(text: &str) -> Model {
    let mut understood = lang_dcml::understand(text);
    let told = understood.diagnostics.iter().map(|one| &one.message);
    let told: Vec<_> = told.collect();
    assert_eq!(understood.models.len(), 1, "{told:?}");
    understood.models.remove(0)
}

/// The model with everything.
pub fn everything() -> Model {
    only(EVERYTHING)
}

/// The models that are shipped, the published ones among them.
pub fn shipped() -> Vec<Model> {
    let all = lang_dcml::models::ALL.iter();
    all.map(|one| only(one.text)).collect()
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
        if lang_dcml::lower::lower(&model).is_ok() {
            models.push(model);
        }
    }
    for (at, model) in models.iter_mut().enumerate() {
        model.name = format!("Random{at}");
    }
    models
}
