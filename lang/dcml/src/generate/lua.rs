//! Lua 5.1 and later: a module of functions over arrays that begin with 1, for converters of trikfs and for plain use.
//!
//! Owns how Lua writes it. Nothing but `math` is asked of the host, and a call whose caller brings the result's array
//! makes no garbage.

use super::about;
use super::graph::Scene;
use super::names::letters;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::limits;
use crate::model::Symbol;
use crate::syntax::{Comparison, Domain};
use crate::tape::{Input, Operation, ValueId};

pub(super) const ROW: Row = Row {
    name: "lua",
    ending: "lua",
    values_max: crate::limits::DCML_LUA_VALUES,
    print,
};

const KEYWORDS: &str = "and break do else elseif end false for function goto if in local nil not or repeat return then \
    true until while";
/// And what is called here.
const TAKEN: &str = "math model state action params result dt k1 k2 k3 k4 at i row pi huge sin cos tan asin acos atan \
    atan2 sqrt exp log abs pow min max sign floor ceil shifted v _G _ENV self";

struct Lua<'s, 'm> {
    scene: &'s Scene<'m>,
    /// Whether there are more values than a function may have names.
    is_crowded: bool,
}

impl Dialect for Lua<'_, '_> {
    fn number(&self, number: f64) -> Text {
        if let Some(text) = Text::of_pi(number, "math.pi") {
            return text;
        }
        let digits = digits(number);
        // Some versions keep one zero for both.
        if digits == "-0.0" {
            return Text::new("-1 / math.huge", Level::Product);
        }
        // With a point: since Lua 5.3 whole numbers without one wrap at 64 bits.
        Text::number(&digits)
    }

    fn input(&self, input: Input, name: &str) -> String {
        if self.is_crowded {
            place(self.scene, input)
        } else {
            name.to_owned()
        }
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        if function == Function::Pow {
            let (x, y) = (x.at_least(Level::Whole), y.at_least(Level::Whole));
            return Text::new(format!("{x} ^ {y}"), Level::Power);
        }
        let name = function.name();
        Text::whole(match function.arguments() {
            1 => format!("{name}({})", x.text),
            _ => format!("{name}({}, {})", x.text, y.text),
        })
    }

    // A number counts as true.
    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.at_least(Level::Sum), right.at_least(Level::Sum));
        let (yes, no) = (yes.at_least(Level::Sum), no.at_least(Level::Sum));
        let text = format!("{left} {} {right} and {yes} or {no}", sign(comparison));
        Text::new(text, Level::Choice)
    }

    fn place(&self, value: ValueId) -> Option<String> {
        self.is_crowded.then(|| format!("v[{}]", value + 1))
    }
}

/// Where an input stands.
fn place(scene: &Scene<'_>, input: Input) -> String {
    match input {
        Input::State(at) => format!("state[{}]", at + 1),
        Input::Action(at) => format!("action[{}]", at + 1),
        Input::Param(_) => {
            let symbol = scene.input(input);
            field("params", symbol.map_or("", |one| one.name.as_str()))
        }
    }
}

/// A field by the name of the model, whatever Lua thinks of it.
fn field(table: &str, name: &str) -> String {
    let name = letters(name, usize::MAX);
    let is_plain = !name.starts_with(|first: char| first.is_ascii_digit())
        && !name.is_empty()
        && !KEYWORDS.split_whitespace().any(|word| word == name);
    match is_plain {
        true => format!("{table}.{name}"),
        false => format!("{table}['{name}']"),
    }
}

/// The whole module.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[KEYWORDS, TAKEN]);
    let leaf = |one: &&Operation| !matches!(one, Operation::Constant(_) | Operation::Input(_));
    let values = scene.graph.operations.iter().filter(leaf).count() + scene.model.symbols.len();
    let dialect = Lua {
        scene,
        is_crowded: values > limits::DCML_LUA_LOCALS,
    };
    let element = |array: &str, at: usize| format!("{array}[{}]", at + 1);
    let symbols = &scene.params;
    let param = |at: usize, _: &str| {
        let name = symbols.get(at).map_or("", |one| one.name.as_str());
        about::shown(&field("params", name))
    };
    let header = about::header(&planner, element, &param);
    let functions = functions(&mut planner, &dialect);
    let mut out = about::each("--", &header);
    out.push('\n');
    out.push_str(&locals(&planner));
    if dialect.is_crowded {
        out.push_str("-- Values: there are more than Lua has names for.\nlocal v = {}\n");
    }
    let name = letters(&scene.model.name, usize::MAX);
    out.push_str(&format!("\nlocal model = {{\n  NAME = '{name}',\n"));
    for (name, symbols) in [
        ("STATES", &scene.states),
        ("ACTIONS", &scene.actions),
        ("PARAMS", &scene.params),
        ("OUTPUTS", &scene.outputs),
    ] {
        let quoted = |one: &&Symbol| format!("'{}'", letters(&one.name, usize::MAX));
        let names: Vec<String> = symbols.iter().map(quoted).collect();
        out.push_str(&format!("  {name} = {{ {} }},\n", names.join(", ")).replace("{  }", "{}"));
    }
    out.push_str("}\n\n");
    out.push_str(&functions);
    out.push_str("return model\n");
    out
}

/// The functions of the host, and those that it lacks.
fn locals(planner: &Planner<'_, '_>) -> String {
    let mut out = String::new();
    for function in &planner.functions {
        let name = function.name();
        out.push_str(&match function {
            Function::Pow => continue,
            Function::Atan2 => "local atan2 = math.atan2 or math.atan\n".to_owned(),
            // The other one where one is not a number.
            Function::Min => {
                "local function min(x, y) return (x < y or y ~= y) and x or y end\n".to_owned()
            }
            Function::Max => {
                "local function max(x, y) return (x > y or y ~= y) and x or y end\n".to_owned()
            }
            Function::Sign => {
                "local function sign(x) return x > 0 and 1.0 or x < 0 and -1.0 or x + 0.0 end\n"
                    .to_owned()
            }
            Function::Floor => {
                "local function floor(x) return math.floor(x) + 0.0 end\n".to_owned()
            }
            Function::Sin
            | Function::Cos
            | Function::Tan
            | Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Sqrt
            | Function::Exp
            | Function::Log
            | Function::Abs => format!("local {name} = math.{name}\n"),
        });
    }
    out
}

fn functions(planner: &mut Planner<'_, '_>, dialect: &Lua<'_, '_>) -> String {
    let scene = dialect.scene;
    let mut out = String::new();
    let mut function = |name: &str, about: &str, columns: usize, roots: &[ValueId]| {
        let body = planner.body(roots, dialect);
        out.push_str(&format!(
            "-- {about}\n-- In `result`, a new table if there is none.\n\
             function model.{name}(state, action, params, result)\n  result = result or {{}}\n{}  return result\nend\n\n",
            lines(&body, columns, dialect)
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
        function(
            "state_jacobian",
            about,
            states.max(1),
            &scene.state_jacobian,
        );
        let about =
            "The derivatives by the action: a row for each derivative, a column for each action.";
        function(
            "action_jacobian",
            about,
            actions.max(1),
            &scene.action_jacobian,
        );
    }
    out.push_str(&step(scene));
    out
}

fn lines(body: &Body, columns: usize, dialect: &Lua<'_, '_>) -> String {
    let mut out = String::new();
    let is_local = !dialect.is_crowded;
    if is_local {
        for (input, name) in &body.inputs {
            out.push_str(&format!(
                "  local {name} = {}\n",
                place(dialect.scene, *input)
            ));
        }
    }
    let word = if is_local { "local " } else { "" };
    for (name, text) in &body.lines {
        out.push_str(&format!("  {word}{name} = {text}\n"));
    }
    if columns > 0 {
        let rows = body.rows(columns);
        out.push_str(&format!(
            "  for i = 1, {rows} do result[i] = result[i] or {{}} end\n"
        ));
    }
    for (at, text) in body.results.iter().enumerate() {
        let place = match columns {
            0 => format!("[{}]", at + 1),
            columns => format!("[{}][{}]", at / columns + 1, at % columns + 1),
        };
        out.push_str(&format!("  result{place} = {text}\n"));
    }
    out
}

/// One step of the classical method of Runge and Kutta.
fn step(scene: &Scene<'_>) -> String {
    let count = scene.states.len();
    let mut out = format!(
        "local k1, k2, k3, k4, at = {{}}, {{}}, {{}}, {{}}, {{}}\n\n\
         local function shifted(state, k, part)\n  for i = 1, {count} do at[i] = state[i] + part * k[i] end\n  return at\nend\n\n\
         -- One step of dt seconds by the classical method of Runge and Kutta, with the action held: changes `state`.\n\
         function model.step(state, action, params, dt)\n  \
         model.derivative(state, action, params, k1)\n  \
         model.derivative(shifted(state, k1, dt / 2), action, params, k2)\n  \
         model.derivative(shifted(state, k2, dt / 2), action, params, k3)\n  \
         model.derivative(shifted(state, k3, dt), action, params, k4)\n  \
         for i = 1, {count} do\n    state[i] = state[i] + dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i])\n  end\n"
    );
    for (at, symbol) in scene.states.iter().enumerate() {
        if symbol.domain == Some(Domain::Circle) {
            let at = at + 1;
            out.push_str(&format!(
                "  state[{at}] = state[{at}] - 2 * math.pi * math.ceil((state[{at}] - math.pi) / (2 * math.pi))\n"
            ));
        }
    }
    out.push_str("  return state\nend\n\n");
    out
}
