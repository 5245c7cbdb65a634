//! Rust without allocation: one module, with fixed arrays.
//!
//! Owns how Rust writes it.

use super::about;
use super::graph::Scene;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::syntax::{Comparison, Domain};
use crate::tape::{Input, ValueId};
use std::f64::consts::PI;

pub(super) const ROW: Row = Row {
    name: "rust",
    ending: "rs",
    values_max: usize::MAX,
    print,
};

/// Words of Rust, names that are patterns, and what is called here.
const TAKEN: &str = "abstract as async await become box break const continue crate do dyn else enum extern false final \
    fn for gen if impl in let loop macro match mod move mut override priv pub ref return self Self static struct super \
    trait true try type typeof union unsized use virtual where while yield None Some Ok Err f64 math core std \
    STATES ACTIONS PARAMS OUTPUTS STATE_NAMES ACTION_NAMES PARAM_NAMES OUTPUT_NAMES Params from_array state action \
    params derivative outputs jacobian dt k1 k2 k3 k4 at step state_jacobian action_jacobian shifted";
const ALLOWED: &str = "#[allow(dead_code, non_snake_case, clippy::all)]\n";

struct Rust;

impl Dialect for Rust {
    fn number(&self, number: f64) -> Text {
        for (times, name) in [(1.0, "PI"), (0.5, "FRAC_PI_2"), (0.25, "FRAC_PI_4")] {
            if number == PI * times {
                return Text::whole(format!("core::f64::consts::{name}"));
            }
        }
        Text::number(digits(number))
    }

    fn input(&self, input: Input, name: &str) -> String {
        match input {
            Input::Param(_) => format!("params.{name}"),
            Input::State(_) | Input::Action(_) => name.to_owned(),
        }
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let name = function.name();
        Text::whole(match function.arguments() {
            1 => format!("math::{name}({})", x.text),
            _ => format!("math::{name}({}, {})", x.text, y.text),
        })
    }

    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.at_least(Level::Sum), right.at_least(Level::Sum));
        let condition = format!("{left} {} {right}", sign(comparison));
        let text = format!("if {condition} {{ {} }} else {{ {} }}", yes.text, no.text);
        Text::new(text, Level::Choice)
    }
}

/// How the standard library computes a function.
fn method(function: Function) -> &'static str {
    match function {
        Function::Sin => "x.sin()",
        Function::Cos => "x.cos()",
        Function::Tan => "x.tan()",
        Function::Asin => "x.asin()",
        Function::Acos => "x.acos()",
        Function::Atan => "x.atan()",
        Function::Atan2 => "x.atan2(y)",
        Function::Sqrt => "x.sqrt()",
        Function::Exp => "x.exp()",
        Function::Log => "x.ln()",
        Function::Abs => "x.abs()",
        Function::Pow => "x.powf(y)",
        Function::Min => "x.min(y)",
        Function::Max => "x.max(y)",
        Function::Sign => "if x > 0.0 { 1.0 } else if x < 0.0 { -1.0 } else { x + 0.0 }",
        Function::Floor => "x.floor()",
    }
}

/// The whole module.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[TAKEN, "unsafe"]);
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|_, name| format!("params.{name}"));
    let functions = functions(&mut planner, scene);
    let mut out = about::each("//", &header);
    out.push('\n');
    for (name, what, symbols) in [
        ("STATE", "How many numbers a state has.", &scene.states),
        ("ACTION", "How many numbers an action has.", &scene.actions),
        ("PARAM", "How many parameters there are.", &scene.params),
        ("OUTPUT", "How many outputs there are.", &scene.outputs),
    ] {
        let count = symbols.len();
        out.push_str(&format!(
            "/// {what}\n#[allow(dead_code)]\npub const {name}S: usize = {count};\n"
        ));
    }
    out.push('\n');
    out.push_str(&params(&planner));
    out.push_str(&functions);
    let wraps = scene
        .states
        .iter()
        .any(|one| one.domain == Some(Domain::Circle));
    out.push_str(&maths(&planner, wraps));
    out
}

fn params(planner: &Planner<'_, '_>) -> String {
    let mut out = format!(
        "/// What is fixed for one robot.\n#[derive(Clone, Copy, Debug, Default, PartialEq)]\n{ALLOWED}pub struct Params {{\n"
    );
    for symbol in &planner.scene.params {
        let about = about::symbol(symbol);
        let about = if about.is_empty() {
            "A number of the model.".to_owned()
        } else {
            about
        };
        out.push_str(&format!(
            "    /// {about}\n    pub {}: f64,\n",
            planner.symbol(symbol)
        ));
    }
    out.push_str("}\n\n");
    out
}

fn functions(planner: &mut Planner<'_, '_>, scene: &Scene<'_>) -> String {
    let mut out = String::new();
    let (states, actions) = (scene.states.len(), scene.actions.len());
    let mut function = |name: &str, about: &str, kind: &str, rows: usize, roots: &[ValueId]| {
        let body = planner.body(roots, &Rust);
        let mark = |is_used: bool| if is_used { "" } else { "_" };
        out.push_str(&format!(
            "/// {about}\n{ALLOWED}#[inline]\npub fn {name}({}state: &[f64; {states}], {}action: &[f64; {actions}], {}params: \
             &Params) -> {kind} {{\n{}}}\n\n",
            mark(body.uses_state()),
            mark(body.uses_action()),
            mark(body.uses_params()),
            lines(&body, rows, kind)
        ));
    };
    let plain = |count: usize| format!("[f64; {count}]");
    let about = "The derivative of the state.";
    function("derivative", about, &plain(states), 0, &scene.derivative);
    if !scene.outputs.is_empty() {
        let about = "What is computed from the state and the action.";
        let kind = plain(scene.outputs.len());
        function("outputs", about, &kind, 0, &scene.output_values);
    }
    if scene.jacobian {
        let about =
            "The derivatives by the state: a row for each derivative, a column for each state.";
        let kind = format!("[[f64; {states}]; {states}]");
        function(
            "state_jacobian",
            about,
            &kind,
            states.max(1),
            &scene.state_jacobian,
        );
        let about =
            "The derivatives by the action: a row for each derivative, a column for each action.";
        let kind = format!("[[f64; {actions}]; {states}]");
        function(
            "action_jacobian",
            about,
            &kind,
            actions.max(1),
            &scene.action_jacobian,
        );
    }
    if states > 0 {
        out.push_str(&step(scene));
    }
    out
}

fn lines(body: &Body, columns: usize, kind: &str) -> String {
    let mut out = String::new();
    for (input, name) in &body.inputs {
        match input {
            Input::State(at) => out.push_str(&format!("    let {name} = state[{at}];\n")),
            Input::Action(at) => out.push_str(&format!("    let {name} = action[{at}];\n")),
            Input::Param(_) => {}
        }
    }
    for (name, text) in &body.lines {
        out.push_str(&format!("    let {name}: f64 = {text};\n"));
    }
    if body.results.is_empty() {
        // No rows, or rows without columns.
        out.push_str(
            match kind.starts_with("[[f64; 0]") && !kind.ends_with("; 0]") {
                true => "    [[]; STATES]\n",
                false => "    []\n",
            },
        );
        return out;
    }
    out.push_str("    [\n");
    match columns {
        0 => {
            for text in &body.results {
                out.push_str(&format!("        {text},\n"));
            }
        }
        columns => {
            for row in body.results.chunks(columns) {
                out.push_str(&format!("        [{}],\n", row.join(", ")));
            }
        }
    }
    out.push_str("    ]\n");
    out
}

/// One step of the classical method of Runge and Kutta.
fn step(scene: &Scene<'_>) -> String {
    let (states, actions) = (scene.states.len(), scene.actions.len());
    let mut out = format!(
        "/// One step of `dt` seconds by the classical method of Runge and Kutta, with the action held.\n{ALLOWED}#[inline]\n\
         pub fn step(state: &mut [f64; {states}], action: &[f64; {actions}], params: &Params, dt: f64) {{\n    \
         let shifted = |k: &[f64; {states}], part: f64| {{\n        let mut at = *state;\n        \
         for (one, slope) in at.iter_mut().zip(k) {{\n            *one += part * slope;\n        }}\n        at\n    }};\n    \
         let k1 = derivative(state, action, params);\n    \
         let k2 = derivative(&shifted(&k1, dt / 2.0), action, params);\n    \
         let k3 = derivative(&shifted(&k2, dt / 2.0), action, params);\n    \
         let k4 = derivative(&shifted(&k3, dt), action, params);\n    \
         for (at, one) in state.iter_mut().enumerate() {{\n        \
         *one += dt / 6.0 * (k1[at] + 2.0 * k2[at] + 2.0 * k3[at] + k4[at]);\n    }}\n"
    );
    for (at, symbol) in scene.states.iter().enumerate() {
        if symbol.domain == Some(Domain::Circle) {
            out.push_str(&format!("    state[{at}] = math::wrapped(state[{at}]);\n"));
        }
    }
    out.push_str("}\n\n");
    out
}

fn maths(planner: &Planner<'_, '_>, wraps: bool) -> String {
    if planner.functions.is_empty() && !wraps {
        return String::new();
    }
    let mut out = "/// The functions that are used. Where there is no std, let them call those of crate libm.\n\
                   #[allow(dead_code)]\nmod math {\n"
        .to_owned();
    for function in &planner.functions {
        let arguments = match function.arguments() {
            1 => "x: f64",
            _ => "x: f64, y: f64",
        };
        let (name, method) = (function.name(), method(*function));
        out.push_str(&format!(
            "    #[inline]\n    pub(super) fn {name}({arguments}) -> f64 {{\n        {method}\n    }}\n\n"
        ));
    }
    if wraps {
        out.push_str(
            "    /// The same angle above -pi, up to pi.\n    #[inline]\n    pub(super) fn wrapped(x: f64) -> f64 {\n        \
             const PI: f64 = core::f64::consts::PI;\n        x - 2.0 * PI * ((x - PI) / (2.0 * PI)).ceil()\n    }\n\n",
        );
    }
    out.truncate(out.len() - 1);
    out.push_str("}\n");
    out
}
