//! Python: functions over NumPy arrays, for one state or many at once, as the solvers of SciPy call them.
//!
//! Owns how Python writes it.

use super::about;
use super::graph::Scene;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::syntax::{Comparison, Domain, Operator};
use crate::tape::{Input, ValueId};

pub(super) const ROW: Row = Row {
    name: "python",
    ending: "py",
    values_max: usize::MAX,
    print,
};

/// Words of Python, and what is called here.
const TAKEN: &str = "False None True and as assert async await break class continue def del elif else except finally for \
    from global if import in is lambda nonlocal not or pass raise return try while with yield match case type print exec \
    np float len zip range hasattr ValueError NAME STATES ACTIONS PARAMS OUTPUTS WRAPS t state action params dt shape \
    values names result derivative outputs state_jacobian action_jacobian step wrapped arrays given k1 k2 k3 k4";

struct Python;

impl Dialect for Python {
    fn number(&self, number: f64) -> Text {
        Text::of_pi(number, "np.pi").unwrap_or_else(|| Text::number(digits(number)))
    }

    fn input(&self, _: Input, name: &str) -> String {
        name.to_owned()
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let name = match function {
            Function::Asin => "arcsin",
            Function::Acos => "arccos",
            Function::Atan => "arctan",
            Function::Atan2 => "arctan2",
            Function::Pow => "power",
            Function::Min => "fmin",
            Function::Max => "fmax",
            Function::Sign => return Text::new(format!("np.sign({}) + 0.0", x.text), Level::Sum),
            Function::Sin
            | Function::Cos
            | Function::Tan
            | Function::Sqrt
            | Function::Exp
            | Function::Log
            | Function::Abs
            | Function::Floor => function.name(),
        };
        Text::whole(match function.arguments() {
            1 => format!("np.{name}({})", x.text),
            _ => format!("np.{name}({}, {})", x.text, y.text),
        })
    }

    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.at_least(Level::Sum), right.at_least(Level::Sum));
        let condition = format!("{left} {} {right}", sign(comparison));
        Text::whole(format!("np.where({condition}, {}, {})", yes.text, no.text))
    }

    fn binary(&self, operator: Operator, left: Text, right: Text) -> Text {
        // A quotient of plain numbers of Python raises an error where NumPy's is infinite.
        if left.is_number && right.is_number {
            let left = Text::whole(format!("np.float64({})", left.text));
            return Plain.binary(operator, left, right);
        }
        Plain.binary(operator, left, right)
    }
}

/// The operators of all languages.
struct Plain;

impl Dialect for Plain {
    fn number(&self, number: f64) -> Text {
        Python.number(number)
    }

    fn input(&self, input: Input, name: &str) -> String {
        Python.input(input, name)
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        Python.call(function, x, y)
    }

    fn select(&self, comparison: Comparison, values: [Text; 4]) -> Text {
        Python.select(comparison, values)
    }
}

/// What checks arguments.
const GIVEN: &str = "\
def _given(values, names, what):
    \"\"\"Numbers in the order of names: of a mapping by its keys, or of a sequence.\"\"\"
    if hasattr(values, \"keys\"):
        values = [values[name] for name in names]
    values = np.asarray(values, dtype=float)
    if values.shape[:1] != (len(names),):
        raise ValueError(f\"{what} has the shape {values.shape}, and begins with {len(names)}: {', '.join(names)}\")
    return values


def _arrays(state, action, params):
    state, action, params = (
        _given(state, STATES, \"state\"),
        _given(action, ACTIONS, \"action\"),
        _given(params, PARAMS, \"params\"),
    )
    return state, action, params, np.broadcast_shapes(state.shape[1:], action.shape[1:], params.shape[1:])


";

/// The whole module.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[TAKEN]);
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|at, _| format!("params[{at}]"));
    let mut out = about::each("#", &header);
    out.push_str("\nimport numpy as np\n\n");
    out.push_str(&format!("NAME = {}\n", quoted(&scene.model.name)));
    for (name, symbols) in [
        ("STATES", &scene.states),
        ("ACTIONS", &scene.actions),
        ("PARAMS", &scene.params),
        ("OUTPUTS", &scene.outputs),
    ] {
        let names: Vec<String> = symbols.iter().map(|one| quoted(&one.name)).collect();
        // A tuple of one has a comma.
        let comma = if names.len() == 1 { "," } else { "" };
        out.push_str(&format!("{name} = ({}{comma})\n", names.join(", ")));
    }
    out.push_str("\n\n");
    out.push_str(GIVEN);
    functions(&mut planner, scene, &mut out);
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", super::names::letters(name, usize::MAX))
}

fn functions(planner: &mut Planner<'_, '_>, scene: &Scene<'_>, out: &mut String) {
    let (states, actions) = (scene.states.len(), scene.actions.len());
    let mut function = |name: &str, about: &str, size: &str, columns: usize, roots: &[ValueId]| {
        let body = planner.body(roots, &Python);
        let time = if name == "derivative" { "t, " } else { "" };
        out.push_str(&format!(
            "def {name}({time}state, action, params):\n    \"\"\"{about}\"\"\"\n    \
             state, action, params, shape = _arrays(state, action, params)\n{}    \
             result = np.empty({size} + shape)\n    with np.errstate(all=\"ignore\"):\n{}    return result\n\n\n",
            inputs(&body),
            lines(&body, columns)
        ));
    };
    let about = "The derivative of the state: with args=(action, params) for scipy.integrate.solve_ivp.\n\n    \
                 State, action and params may have a further axis: many states at once.\n    \
                 Action and params may also be mappings with names.\n    ";
    function(
        "derivative",
        about,
        &format!("({states},)"),
        0,
        &scene.derivative,
    );
    if !scene.outputs.is_empty() {
        let size = format!("({},)", scene.outputs.len());
        let about = "What is computed from the state and the action.";
        function("outputs", about, &size, 0, &scene.output_values);
    }
    if scene.jacobian {
        let about =
            "The derivatives by the state: a row for each derivative, a column for each state.";
        let size = format!("({states}, {states})");
        function(
            "state_jacobian",
            about,
            &size,
            states.max(1),
            &scene.state_jacobian,
        );
        let about =
            "The derivatives by the action: a row for each derivative, a column for each action.";
        let size = format!("({states}, {actions})");
        function(
            "action_jacobian",
            about,
            &size,
            actions.max(1),
            &scene.action_jacobian,
        );
    }
    out.push_str(
        "def step(state, action, params, dt):\n    \
         \"\"\"The state after dt seconds: one step of the classical method of Runge and Kutta, with the action held.\"\"\"\n    \
         state = _given(state, STATES, \"state\")\n    \
         with np.errstate(all=\"ignore\"):\n        \
         k1 = derivative(0.0, state, action, params)\n        \
         k2 = derivative(0.0, state + dt / 2.0 * k1, action, params)\n        \
         k3 = derivative(0.0, state + dt / 2.0 * k2, action, params)\n        \
         k4 = derivative(0.0, state + dt * k3, action, params)\n        \
         state = state + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)\n",
    );
    for (at, symbol) in scene.states.iter().enumerate() {
        if symbol.domain == Some(Domain::Circle) {
            out.push_str(&format!(
                "        state[{at}] -= 2.0 * np.pi * np.ceil((state[{at}] - np.pi) / (2.0 * np.pi))\n"
            ));
        }
    }
    out.push_str("    return state\n");
}

fn inputs(body: &Body) -> String {
    let mut out = String::new();
    for (input, name) in &body.inputs {
        let place = match input {
            Input::State(at) => format!("state[{at}]"),
            Input::Action(at) => format!("action[{at}]"),
            Input::Param(at) => format!("params[{at}]"),
        };
        out.push_str(&format!("    {name} = {place}\n"));
    }
    out
}

fn lines(body: &Body, columns: usize) -> String {
    let mut out = String::new();
    for (name, text) in &body.lines {
        out.push_str(&format!("        {name} = {text}\n"));
    }
    for (at, text) in body.results.iter().enumerate() {
        let place = match columns {
            0 => at.to_string(),
            columns => format!("{}, {}", at / columns, at % columns),
        };
        out.push_str(&format!("        result[{place}] = {text}\n"));
    }
    if out.is_empty() {
        out.push_str("        pass\n");
    }
    out
}
