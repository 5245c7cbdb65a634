//! A model under actions for some time, as rows of numbers.
//!
//! Owns the options of a solution, which come without trust, and its rows. Solutions are made in `lang-dcml`.

use crate::failure::Failure;
use crate::limits;
use crate::text::Text;
use lang_dcml::model::Model;
use lang_dcml::robot::{Part, Robot};
use lang_dcml::solve::run::Course;
use lang_dcml::solve::{Method, Options, Solver, wrapped};
use lang_dcml::syntax::{Domain, Kind};
use serde_json::{Map, Value, json};

/// Rows that are shown if nothing else is said.
const SHOWN: f64 = 200.0;
/// Relative and absolute error of a step if nothing else is said, as `trik dcml sim` has them.
const ERRORS: (f64, f64) = (1e-6, 1e-9);
const METHODS: [Method; 4] = [Method::Euler, Method::Heun, Method::Rk4, Method::Rk45];

/// From when, and the actions that hold from then on.
type Piece = (f64, Map<String, Value>);

/// What is asked for.
struct Wish {
    model: Option<String>,
    params: Map<String, Value>,
    start: Map<String, Value>,
    actions: Vec<Piece>,
    seconds: f64,
    every: f64,
    method: Method,
    step: Option<f64>,
}

fn request(why: impl Into<String>) -> Failure {
    Failure::Request(why.into())
}

impl Wish {
    fn read(options: &str) -> Result<Self, Failure> {
        if options.len() > limits::OPTIONS_BYTES_MAX {
            return Err(request(format!(
                "options: at most {} bytes",
                limits::OPTIONS_BYTES_MAX
            )));
        }
        let Ok(Value::Object(mut all)) = serde_json::from_str(options) else {
            return Err(request("options: an object is wanted"));
        };
        let model = match all.remove("model") {
            None | Some(Value::Null) => None,
            Some(Value::String(name)) => Some(name),
            Some(_) => return Err(request("model: a name is wanted")),
        };
        let mut numbers = |name: &str| match all.remove(name) {
            None | Some(Value::Null) => Ok(Map::new()),
            Some(Value::Object(numbers)) => Ok(numbers),
            Some(_) => Err(request(format!("{name}: an object of numbers is wanted"))),
        };
        let (params, start) = (numbers("params")?, numbers("start")?);
        let actions = pieces(all.remove("actions"))?;
        let mut time = |name: &str| match all.remove(name) {
            None | Some(Value::Null) => Ok(None),
            Some(value) => match value
                .as_f64()
                .filter(|time| time.is_finite() && *time > 0.0)
            {
                Some(time) => Ok(Some(time)),
                None => Err(request(format!(
                    "{name}: a time in s, more than 0, is wanted"
                ))),
            },
        };
        let seconds = time("seconds")?.ok_or_else(|| request("seconds: say how long"))?;
        let every = time("every")?.unwrap_or(seconds / SHOWN);
        let step = time("step")?;
        if seconds / every > limits::ROWS_MAX as f64 {
            return Err(request(format!("every: at most {} rows", limits::ROWS_MAX)));
        }
        let method = match all.remove("method") {
            None | Some(Value::Null) => Method::Rk45,
            Some(name) => {
                let found = METHODS
                    .into_iter()
                    .find(|one| name.as_str() == Some(one.name()));
                found.ok_or_else(|| {
                    request(format!(
                        "method: {} are there",
                        METHODS.map(Method::name).join(", ")
                    ))
                })?
            }
        };
        match all.keys().next() {
            None => Ok(Self {
                model,
                params,
                start,
                actions,
                seconds,
                every,
                method,
                step,
            }),
            Some(name) => {
                let name: String = name.chars().take(40).collect();
                Err(request(format!("there is no option {name:?}")))
            }
        }
    }

    fn solver(&self) -> Options {
        let step = self.step.unwrap_or(self.seconds / 1000.0);
        let mut options = match self.method {
            Method::Rk45 => Options::adaptive(ERRORS.0, ERRORS.1),
            method @ (Method::Euler | Method::Heun | Method::Rk4) => Options::fixed(method, step),
        };
        options.step = self.step.unwrap_or(options.step);
        options.steps_max = limits::STEPS_MAX;
        options
    }
}

/// The actions, in the order of their times.
fn pieces(value: Option<Value>) -> Result<Vec<Piece>, Failure> {
    let wrong = || {
        request("actions: objects with a time at and numbers by the names of actions are wanted")
    };
    let pieces = match value {
        None | Some(Value::Null) => return Ok(Vec::new()),
        Some(Value::Array(pieces)) => pieces,
        Some(_) => return Err(wrong()),
    };
    let mut all: Vec<Piece> = Vec::new();
    for piece in pieces {
        let Value::Object(mut piece) = piece else {
            return Err(wrong());
        };
        let at = piece.remove("at").and_then(|at| at.as_f64());
        let at = at
            .filter(|at| at.is_finite() && *at >= 0.0)
            .ok_or_else(wrong)?;
        if all.last().is_some_and(|(before, _)| *before >= at) {
            return Err(request("actions: each begins later than the one before"));
        }
        all.push((at, piece));
    }
    Ok(all)
}

/// Numbers in the order of these names.
fn in_order<'a>(
    option: &str,
    names: impl Iterator<Item = &'a str>,
    given: &Map<String, Value>,
    missing: Option<f64>,
) -> Result<Vec<f64>, Failure> {
    let names: Vec<&str> = names.collect();
    if let Some(strange) = given.keys().find(|name| !names.contains(&name.as_str())) {
        let strange: String = strange.chars().take(40).collect();
        let all = if names.is_empty() {
            "there are none".to_owned()
        } else {
            format!("there are {}", names.join(", "))
        };
        return Err(request(format!("{option}: there is no {strange:?}; {all}")));
    }
    let number = |name: &&str| match (given.get(*name), missing) {
        (None, Some(missing)) => Ok(missing),
        (None, None) => Err(request(format!("{option}: {name} is missing"))),
        (Some(value), _) => {
            let number = value.as_f64().filter(|number| number.is_finite());
            number.ok_or_else(|| request(format!("{option}: {name} is no number")))
        }
    };
    names.iter().map(number).collect()
}

/// Solves a model of a text. Options are an object of JSON: `model`, `params`, `start` and `actions` by their names, `seconds`,
/// `every`, `method`, `step`; `types.d.ts` tells them. Gives `columns` and `rows`, for the beginning, each `every` and the end.
///
/// # Errors
/// [`Failure`]: an option, the model, or the solution.
pub fn solve(text: &Text, options: &str) -> Result<Value, Failure> {
    let wish = Wish::read(options)?;
    let model = text.model(wish.model.as_deref())?;
    let of = |kind| model.of_kind(kind).map(|one| one.name.as_str());
    let params = in_order("params", of(Kind::Param), &wish.params, None)?;
    let robot = Robot::new(&model, &params).map_err(|why| Failure::Refused(why.to_string()))?;
    let states = model.states().map(|one| one.name.as_str());
    let start = in_order("start", states, &wish.start, Some(0.0))?;
    let mut actions = Vec::new();
    for (at, given) in &wish.actions {
        actions.push((
            *at,
            in_order("actions", of(Kind::Action), given, Some(0.0))?,
        ));
    }
    let table = Table::new(&wish, &model, &robot)?;
    table.solved(&wish, robot, &start, &actions)
}

/// The actions at a time: those of the last piece that has begun, and zeros before.
fn at(actions: &[(f64, Vec<f64>)], time: f64, to: &mut [f64]) {
    let begun = actions.partition_point(|(begin, _)| *begin <= time);
    match begun.checked_sub(1) {
        Some(last) => to.copy_from_slice(&actions[last].1),
        None => to.fill(0.0),
    }
}

/// Rows as they come.
struct Table {
    columns: Vec<Value>,
    circles: Vec<bool>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn new(wish: &Wish, model: &Model, robot: &Robot) -> Result<Self, Failure> {
        let parts = || {
            let parts = robot.state_parts().iter().chain(robot.output_parts());
            parts.chain(robot.action_parts())
        };
        let numbers = (wish.seconds / wish.every + 2.0) * (parts().count() + 1) as f64;
        if numbers > limits::NUMBERS_MAX as f64 {
            let why = format!(
                "every: {} has so many values that there are too many numbers",
                model.name
            );
            return Err(request(why));
        }
        let column = |part: &Part| json!({"name": part.name, "unit": part.unit});
        let time = json!({"name": "t", "unit": "s"});
        Ok(Self {
            columns: [time].into_iter().chain(parts().map(column)).collect(),
            circles: [false]
                .into_iter()
                .chain(parts().map(|part| part.domain == Some(Domain::Circle)))
                .collect(),
            rows: Vec::new(),
        })
    }

    fn solved(
        mut self,
        wish: &Wish,
        mut robot: Robot,
        start: &[f64],
        actions: &[(f64, Vec<f64>)],
    ) -> Result<Value, Failure> {
        let count = robot.action_parts().len();
        let solver = Solver::new(wish.solver(), start.len(), count);
        let mut solver = solver.map_err(|why| request(why.to_string()))?;
        solver.start(0.0, start);
        let jumps: Vec<f64> = actions.iter().map(|(at, _)| *at).collect();
        let mut course = Course {
            to: wish.seconds,
            jumps: &jumps,
            events: &mut [],
        };
        let mut shown = robot.clone();
        let mut state = start.to_vec();
        self.row(&mut shown, 0.0, &state, actions);
        let mut line = 1.0;
        let end = wish.seconds;
        let mut given = |time: f64, to: &mut [f64]| at(actions, time, to);
        let names: Vec<String> = robot
            .state_parts()
            .iter()
            .map(|part| part.name.clone())
            .collect();
        let solved = solver.run(&mut robot, &mut given, &mut course, |solver| {
            // A time that differs from the end by rounding is the end, which has its own row.
            while line * wish.every <= solver.time() && line * wish.every < end * (1.0 - 1e-12) {
                solver.between(line * wish.every, &mut state);
                self.row(&mut shown, line * wish.every, &state, actions);
                line += 1.0;
            }
            if solver.time() >= end {
                solver.between(end, &mut state);
                self.row(&mut shown, end, &state, actions);
            }
        });
        match solved {
            Ok(_) => Ok(json!({"columns": self.columns, "rows": self.rows})),
            Err(failure) => {
                let name = failure.state().and_then(|at| names.get(at));
                let told = failure.told(name.map_or("the state", String::as_str));
                Err(Failure::Solution(told))
            }
        }
    }

    fn row(&mut self, robot: &mut Robot, time: f64, state: &[f64], actions: &[(f64, Vec<f64>)]) {
        let mut action = vec![0.0; robot.action_parts().len()];
        at(actions, time, &mut action);
        let mut outputs = vec![0.0; robot.output_parts().len()];
        robot.output(state, &action, &mut outputs);
        let all = [time]
            .into_iter()
            .chain(state.iter().copied())
            .chain(outputs)
            .chain(action);
        let row = all
            .zip(&self.circles)
            .map(|(number, is_circle)| if *is_circle { wrapped(number) } else { number });
        self.rows.push(row.collect());
    }
}
