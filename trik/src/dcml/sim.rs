//! `trik dcml sim`: a model under actions for some time, as a table or a picture.
//!
//! Owns the way from the command line to a solution and what is kept of it. Solutions are made in `lang`; where actions
//! come from is known to `sim/actions`, the picture to `sim/plot`.

mod actions;
pub(crate) mod args;
mod plot;
mod table;

use super::load::load;
use super::values;
use crate::limits;
use crate::output::Output;
use crate::refusal::{REFUSED, Refusal, say};
use actions::Actions;
use args::{Form, SimArgs, Solver as Named};
use lang_dcml::model::Model;
use lang_dcml::robot::Robot;
use lang_dcml::solve::run::Course;
use lang_dcml::solve::{Failure, Method, Options, Solver, wrapped};
use lang_dcml::syntax::Kind;
use lang_text::problem::Locale;
use std::path::Path;
use table::{Column, Table};

/// Pieces of the time that are shown if nothing else is said.
const SHOWN: f64 = 200.0;
/// Steps of one size if nothing else is said.
const STEPS: f64 = 1000.0;

/// Solves it and writes what comes out.
pub(super) fn run(args: &SimArgs) -> Result<u8, Refusal> {
    let outputs = Outputs::new(args);
    outputs.refuse()?;
    let (_, model) = load(&args.file, args.model.as_deref())?;
    let is_time = |time: f64| time.is_finite() && time > 0.0;
    if !is_time(args.time) {
        return Err(Refusal::new("--t: give a time in s, more than 0"));
    }
    let every = args.every.unwrap_or(args.time / SHOWN);
    if !is_time(every) || args.time / every > limits::DCML_ROWS_MAX as f64 {
        let most = limits::DCML_ROWS_MAX;
        let why = format!("--every: give a time in s, more than 0, for at most {most} lines");
        return Err(Refusal::new(why));
    }
    let mut simulation = Simulation::new(args, &model)?;
    let failure = simulation.run(args, every);
    if let Err(failure) = &failure {
        let name = failure
            .state()
            .and_then(|at| simulation.robot.state_parts().get(at));
        let told = failure.told(name.map_or("the state", |part| part.name.as_str()));
        say(&[format!("trik: {}: {told}", args.file.display())]);
    }
    say(&simulation.actions.held());
    let table = &simulation.table;
    if table.rows.is_empty() {
        return Ok(REFUSED);
    }
    if let Some(output) = &outputs.table {
        output.write(table.csv().as_bytes())?;
    }
    if let Some(output) = &outputs.picture {
        output.write(plot::svg(&model.name, table).as_bytes())?;
    }
    Ok(if failure.is_err() { REFUSED } else { 0 })
}

/// Where the table and the picture go.
struct Outputs<'a> {
    table: Option<Output<'a>>,
    picture: Option<Output<'a>>,
    actions: &'a Path,
}

impl<'a> Outputs<'a> {
    /// As the options say.
    fn new(args: &'a SimArgs) -> Self {
        let output = |path| Output {
            path,
            force: args.force,
            source: &args.file,
            locale: Locale::English,
        };
        let (named, svg) = (args.output.as_deref(), args.svg.as_deref());
        let (table, picture) = match (args.out, svg) {
            (Some(Form::Svg), _) => (None, Some(output(named))),
            (Some(Form::Csv) | None, None) => (Some(output(named)), None),
            (Some(Form::Csv) | None, Some(_)) => {
                (named.map(|path| output(Some(path))), Some(output(svg)))
            }
        };
        Self {
            table,
            picture,
            actions: Path::new(&args.actions),
        }
    }

    /// Refuses what must not be replaced.
    fn refuse(&self) -> Result<(), Refusal> {
        for output in [&self.table, &self.picture].into_iter().flatten() {
            output.refuse_present()?;
            output.spare(&[self.actions])?;
        }
        match (&self.table, &self.picture) {
            (Some(table), Some(picture)) => table.spare(picture.path.as_slice()),
            _ => Ok(()),
        }
    }
}

struct Simulation {
    robot: Robot,
    actions: Actions,
    solver: Solver,
    table: Table,
}

impl Simulation {
    fn new(args: &SimArgs, model: &Model) -> Result<Self, Refusal> {
        let names =
            |kind| -> Vec<&str> { model.of_kind(kind).map(|one| one.name.as_str()).collect() };
        let names = names(Kind::Param);
        let params = values::values("--params", &args.params, &names)?;
        let params = values::complete("--params", &names, params)?;
        let refused = |why: String| Refusal::new(format!("{}: {why}", args.file.display()));
        let robot = Robot::new(model, &params).map_err(|why| refused(why.to_string()))?;
        let actions = Actions::new(&args.actions, &robot)?;
        let states: Vec<&str> = model.states().map(|one| one.name.as_str()).collect();
        let start = values::values("--start", &args.start, &states)?;
        let start: Vec<f64> = start.into_iter().map(Option::unwrap_or_default).collect();
        let method = match args.solver {
            Named::Euler => Method::Euler,
            Named::Heun => Method::Heun,
            Named::Rk4 => Method::Rk4,
            Named::Rk45 => Method::Rk45,
        };
        let mut options = match method {
            Method::Rk45 => Options::adaptive(args.rtol, args.atol),
            Method::Euler | Method::Heun | Method::Rk4 => Options::fixed(method, args.time / STEPS),
        };
        options.step = args.step.unwrap_or(options.step);
        let mut solver = Solver::new(options, states.len(), robot.action_parts().len())
            .map_err(|why| Refusal::new(format!("--step, --rtol, --atol: {why}")))?;
        solver.start(0.0, &start);
        let time = Column {
            name: "t".into(),
            unit: Some("s".into()),
            is_circle: false,
        };
        let configs = robot.state_parts().iter().chain(robot.output_parts());
        let configs: Vec<Column> = configs.map(Column::of).collect();
        let count = configs.len();
        let given = robot.action_parts().iter().map(Column::of);
        Ok(Self {
            table: Table {
                configs: count,
                columns: [time].into_iter().chain(configs).chain(given).collect(),
                rows: Vec::new(),
            },
            robot,
            actions,
            solver,
        })
    }

    /// Solves it, and keeps a line for the begin, each `every` seconds, and the end.
    fn run(&mut self, args: &SimArgs, every: f64) -> Result<(), Failure> {
        let jumps = self.actions.jumps().to_vec();
        let mut course = Course {
            to: args.time,
            jumps: &jumps,
            events: &mut [],
        };
        let mut shower = Shower {
            outputs: self.robot.clone(),
            actions: self.actions.clone(),
            state: self.solver.state().to_vec(),
            table: &mut self.table,
        };
        shower.row(0.0);
        let mut line = 1.0;
        let (solver, actions) = (&mut self.solver, &mut self.actions);
        let mut given = |time: f64, to: &mut [f64]| actions.at(time, to);
        let end = args.time;
        let solved = solver.run(&mut self.robot, &mut given, &mut course, |solver| {
            // A time that differs from the end by rounding is the end, which has its own line.
            while line * every <= solver.time() && line * every < end * (1.0 - 1e-12) {
                solver.between(line * every, &mut shower.state);
                shower.row(line * every);
                line += 1.0;
            }
            if solver.time() >= end {
                solver.between(end, &mut shower.state);
                shower.row(end);
            }
        });
        solved.map(|_| ())
    }
}

/// Puts lines into the table.
struct Shower<'a> {
    outputs: Robot,
    actions: Actions,
    state: Vec<f64>,
    table: &'a mut Table,
}

impl Shower<'_> {
    fn row(&mut self, time: f64) {
        let parts = self.outputs.action_parts().len();
        let mut action = vec![0.0; parts];
        self.actions.at(time, &mut action);
        let mut outputs = vec![0.0; self.outputs.output_parts().len()];
        self.outputs.output(&self.state, &action, &mut outputs);
        let mut row = vec![time];
        row.extend(self.state.iter().chain(&outputs).chain(&action));
        for (number, column) in row.iter_mut().zip(&self.table.columns) {
            if column.is_circle {
                *number = wrapped(*number);
            }
        }
        self.table.rows.push(row);
    }
}
