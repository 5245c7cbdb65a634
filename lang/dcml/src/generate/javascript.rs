//! JavaScript of ECMAScript 5: one object of functions over arrays, for node, browsers and the engine of trikd.
//!
//! Owns how JavaScript writes it.

use super::about;
use super::graph::Scene;
use super::names::letters;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::model::Symbol;
use crate::syntax::{Comparison, Domain};
use crate::tape::{Input, ValueId};

pub(super) const ROW: Row = Row {
    name: "javascript",
    ending: "js",
    values_max: usize::MAX,
    print,
};

/// Words of JavaScript, and what is called here.
const TAKEN: &str = "abstract arguments async await boolean break byte case catch char class const continue debugger \
    default delete do double else enum eval export extends false final finally float for function goto if implements \
    import in instanceof int interface let long native new null of package private protected public return short static \
    super switch synchronized this throw throws transient true try typeof var void volatile while with yield undefined \
    NaN Infinity Math Array Object Number String Function globalThis window module exports require state action params \
    result dt k1 k2 k3 k4 at i pow min max sign shifted rows derivative outputs stateJacobian actionJacobian step \
    constructor prototype toString valueOf hasOwnProperty isPrototypeOf propertyIsEnumerable toLocaleString __proto__";

struct JavaScript;

impl Dialect for JavaScript {
    fn number(&self, number: f64) -> Text {
        if let Some(text) = Text::of_pi(number, "Math.PI") {
            return text;
        }
        let digits = digits(number);
        Text::number(digits.strip_suffix(".0").unwrap_or(&digits))
    }

    fn input(&self, _: Input, name: &str) -> String {
        name.to_owned()
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let name = match function {
            // ECMAScript 5 has none, or another one.
            Function::Sign | Function::Pow | Function::Min | Function::Max => function.name(),
            Function::Sin
            | Function::Cos
            | Function::Tan
            | Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Atan2
            | Function::Sqrt
            | Function::Exp
            | Function::Log
            | Function::Abs
            | Function::Floor => &format!("Math.{}", function.name()),
        };
        Text::whole(match function.arguments() {
            1 => format!("{name}({})", x.text),
            _ => format!("{name}({}, {})", x.text, y.text),
        })
    }

    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.at_least(Level::Sum), right.at_least(Level::Sum));
        let (yes, no) = (yes.at_least(Level::Sum), no.at_least(Level::Sum));
        let text = format!("{left} {} {right} ? {yes} : {no}", sign(comparison));
        Text::new(text, Level::Choice)
    }
}

/// The whole module.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[TAKEN]);
    let model = planner.take(&scene.model.name);
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|_, name| format!("params.{name}"));
    let functions = functions(&mut planner);
    let mut out = about::block("/*", &header, "");
    out.push_str(&format!(
        "var {model} = (function () {{\n    'use strict';\n\n"
    ));
    for function in &planner.functions {
        out.push_str(helper(*function));
    }
    out.push_str(&functions);
    out.push_str("    return {\n");
    let name = letters(&scene.model.name, usize::MAX);
    out.push_str(&format!("        NAME: '{name}',\n"));
    for (name, symbols) in [
        ("STATES", &scene.states),
        ("ACTIONS", &scene.actions),
        ("PARAMS", &scene.params),
        ("OUTPUTS", &scene.outputs),
    ] {
        let is_key = name == "PARAMS";
        let word = |one: &&Symbol| match is_key {
            true => format!("'{}'", planner.symbol(one)),
            false => format!("'{}'", letters(&one.name, usize::MAX)),
        };
        let words: Vec<String> = symbols.iter().map(word).collect();
        out.push_str(&format!("        {name}: [{}],\n", words.join(", ")));
    }
    let mut names = vec!["derivative", "outputs"];
    if scene.jacobian {
        names.extend(["stateJacobian", "actionJacobian"]);
    }
    for name in names {
        out.push_str(&format!("        {name}: {name},\n"));
    }
    out.push_str("        step: step\n    };\n})();\n\n");
    out.push_str(&format!(
        "if (typeof module !== 'undefined' && module.exports) {{\n    module.exports = {model};\n}}\n"
    ));
    out
}

fn helper(function: Function) -> &'static str {
    match function {
        Function::Sign => {
            "    function sign(x) {\n        return x > 0 ? 1 : (x < 0 ? -1 : x + 0);\n    }\n\n"
        }
        Function::Min => {
            "    /* The other one where one is not a number. */\n    function min(x, y) {\n        \
             return x !== x ? y : (y !== y ? x : Math.min(x, y));\n    }\n\n"
        }
        Function::Max => {
            "    /* The other one where one is not a number. */\n    function max(x, y) {\n        \
             return x !== x ? y : (y !== y ? x : Math.max(x, y));\n    }\n\n"
        }
        Function::Pow => {
            "    /* As in C: 1 to any power is 1, and -1 to an infinite one too. */\n    function pow(x, y) {\n        \
             return x === 1 || (x === -1 && (y === Infinity || y === -Infinity)) ? 1 : Math.pow(x, y);\n    }\n\n"
        }
        Function::Sin
        | Function::Cos
        | Function::Tan
        | Function::Asin
        | Function::Acos
        | Function::Atan
        | Function::Atan2
        | Function::Sqrt
        | Function::Exp
        | Function::Log
        | Function::Abs
        | Function::Floor => "",
    }
}

fn functions(planner: &mut Planner<'_, '_>) -> String {
    let scene = planner.scene;
    let mut out = String::new();
    let mut function = |name: &str, about: &str, columns: usize, roots: &[ValueId]| {
        let body = planner.body(roots, &JavaScript);
        out.push_str(&format!(
            "    /* {about} In `result`, a new array if there is none. */\n    \
             function {name}(state, action, params, result) {{\n        result = result || [];\n{}        return result;\n    }}\n\n",
            lines(&body, columns)
        ));
    };
    let (states, actions) = (scene.states.len(), scene.actions.len());
    let about = "The derivative of the state.";
    function("derivative", about, 0, &scene.derivative);
    let about = "What is computed from the state and the action.";
    function("outputs", about, 0, &scene.output_values);
    if scene.jacobian {
        let about =
            "The derivatives by the state: a row for each derivative, a column for each state.";
        function("stateJacobian", about, states.max(1), &scene.state_jacobian);
        let about =
            "The derivatives by the action: a row for each derivative, a column for each action.";
        function(
            "actionJacobian",
            about,
            actions.max(1),
            &scene.action_jacobian,
        );
    }
    out.push_str(&step(scene));
    out
}

fn lines(body: &Body, columns: usize) -> String {
    let mut out = String::new();
    for (input, name) in &body.inputs {
        let place = match input {
            Input::State(at) => format!("state[{at}]"),
            Input::Action(at) => format!("action[{at}]"),
            Input::Param(_) => format!("params.{name}"),
        };
        out.push_str(&format!("        var {name} = {place};\n"));
    }
    for (name, text) in &body.lines {
        out.push_str(&format!("        var {name} = {text};\n"));
    }
    if columns > 0 {
        let rows = body.rows(columns);
        out.push_str(&format!(
            "        for (var i = 0; i < {rows}; i++) {{\n            result[i] = result[i] || [];\n        }}\n"
        ));
    }
    for (at, text) in body.results.iter().enumerate() {
        let place = match columns {
            0 => format!("[{at}]"),
            columns => format!("[{}][{}]", at / columns, at % columns),
        };
        out.push_str(&format!("        result{place} = {text};\n"));
    }
    out
}

/// One step of the classical method of Runge and Kutta.
fn step(scene: &Scene<'_>) -> String {
    let mut out = "    function shifted(state, k, part) {\n        \
         return state.map(function (value, i) { return value + part * k[i]; });\n    }\n\n    \
         /* One step of dt seconds by the classical method of Runge and Kutta, with the action held: changes `state`. */\n    \
         function step(state, action, params, dt) {\n        \
         var k1 = derivative(state, action, params);\n        \
         var k2 = derivative(shifted(state, k1, dt / 2), action, params);\n        \
         var k3 = derivative(shifted(state, k2, dt / 2), action, params);\n        \
         var k4 = derivative(shifted(state, k3, dt), action, params);\n        \
         for (var i = 0; i < state.length; i++) {\n            \
         state[i] += dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);\n        }\n"
        .to_owned();
    for (at, symbol) in scene.states.iter().enumerate() {
        if symbol.domain == Some(Domain::Circle) {
            out.push_str(&format!(
                "        state[{at}] -= 2 * Math.PI * Math.ceil((state[{at}] - Math.PI) / (2 * Math.PI));\n"
            ));
        }
    }
    out.push_str("        return state;\n    }\n\n");
    out
}
