//! `trik dcml plan`: a path of a robot from one place to another, among obstacles.
//!
//! Owns the words, the clock and the exit code: 0 a path, 1 none, 2 the search could not begin. How it is searched is known
//! to `lang_plan` alone; `ask` makes its question, `field` its obstacles from a world, `told` and `picture` show
//! the answer.

mod ask;
mod field;
mod forms;
mod picture;
mod told;

use self::ask::Asked;
use self::forms::{Footing, Given, Ranges};
use super::{load, values};
use crate::diagrams::output::Output;
use crate::diagrams::{Refusal, UNREADABLE, telling};
use clap::{Args, ValueEnum};
use lang_dcml::robot::Robot;
use lang_dcml::syntax::Kind;
use lang_plan::limits::{PLAN_ITERATIONS_MAX, PLAN_OBSTACLES_TEXT_MAX};
use lang_plan::obstacles::{Obstacles, text};
use lang_plan::room::Room;
use lang_plan::{Counts, Method, Options, Outcome, plan as search};
use std::fs::File;
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Exit code when there is no path.
const NO_PATH: u8 = 1;
/// How often a person sees how far it is.
const PROGRESS: Duration = Duration::from_millis(100);

/// What `trik dcml plan` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct PlanArgs {
    /// File with the model; - is standard input.
    #[arg(value_name = "MODEL")]
    pub file: PathBuf,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Its parameters, all of them: L=0.2,r=0.03.
    #[arg(long, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub params: Vec<Given>,
    /// The state where it starts; what is not named is 0, or with --world where the robot of the world stands.
    #[arg(long, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub start: Vec<Given>,
    /// Where it is to go: x=3,y=2 and perhaps theta=0. States and outputs may be named.
    #[arg(long, required = true, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub goal: Vec<Given>,
    /// How near to the goal is near enough, in the unit of x and y.
    #[arg(long, value_name = "R", default_value_t = 0.1, value_parser = forms::positive)]
    pub goal_radius: f64,
    /// The same for angles that the goal names, in radians.
    #[arg(long, value_name = "RADIANS", default_value_t = 0.2, value_parser = forms::positive)]
    pub goal_angle: f64,
    /// Which states or outputs say where it is [default: x, y and theta, in capitals too].
    #[arg(long, value_name = "X,Y[,HEADING]", value_delimiter = ',')]
    pub position: Vec<String>,
    /// States that are angles though the model does not say `in S1`; the heading is one anyway.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub angles: Vec<String>,
    /// Where states may be: x=0..3,y=0..2 [default: as the model says; for x and y around start, goal and obstacles].
    #[arg(long, value_name = "NAME=LOW..HIGH,...", value_parser = forms::ranges)]
    pub bounds: Vec<Ranges>,
    /// Where actions may be: u=-1..1 [default: as the model says].
    #[arg(long, value_name = "NAME=LOW..HIGH,...", value_parser = forms::ranges)]
    pub actions: Vec<Ranges>,
    /// How much a difference of 1 counts in distances [default: 1 for x and y, less for others].
    #[arg(long, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub weights: Vec<Given>,
    /// Obstacles: a world of TRIK Studio, FILE.xml or a project FILE.qrs. In metres, x to the right and y up, so y has the
    /// other sign than there.
    #[arg(long, value_name = "FILE", conflicts_with = "obstacles")]
    pub world: Option<PathBuf>,
    /// Obstacles: a text with lines like `wall 0 1 2 1 0.02`, `rectangle`, `polygon`, `circle`, `bounds`.
    #[arg(long, value_name = "FILE")]
    pub obstacles: Option<PathBuf>,
    /// What it covers: circle:RADIUS or polygon:X,Y,X,Y,..., convex, seen from its position [default: circle:0.1; with
    /// --world the robot of TRIK].
    #[arg(long, value_name = "SHAPE", value_parser = forms::footing)]
    pub footprint: Option<Footing>,
    /// Obstacles are looked at so closely; half of it is kept as a distance from them.
    #[arg(long, value_name = "LENGTH", default_value_t = 0.01, value_parser = forms::positive)]
    pub resolution: f64,
    /// Which planner.
    #[arg(long, value_enum, default_value_t = Planner::Rrt)]
    pub planner: Planner,
    /// Of all that is random: the same seed finds the same path.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Seconds after which the search ends [default: 60 without --iterations].
    #[arg(long, value_name = "SECONDS", value_parser = forms::positive, allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
    /// Samples after which it ends [default: 1000000; sst: 100000].
    #[arg(long, value_name = "NUMBER")]
    pub iterations: Option<u64>,
    /// Seconds of one step of the solver.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.05, value_parser = forms::positive)]
    pub step: f64,
    /// How long an action is held, in seconds.
    #[arg(long, value_name = "LOW..HIGH", default_value = "0.1..1", value_parser = forms::range)]
    pub hold: (f64, f64),
    /// How often the goal is aimed at, from 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.05)]
    pub goal_bias: f64,
    /// Actions that rrt tries from one place before it takes the best.
    #[arg(long, value_name = "NUMBER", default_value_t = 4)]
    pub attempts: u32,
    /// Of sst: the radius within which it goes on from the place that is reached soonest [default: by the size of the
    /// space].
    #[arg(long, value_name = "R", value_parser = forms::positive)]
    pub selection: Option<f64>,
    /// Of sst: the radius within which it keeps one place [default: by the size of the space].
    #[arg(long, value_name = "R", value_parser = forms::positive)]
    pub pruning: Option<f64>,
    /// Write the path here, - is standard output: a line for each step with time, actions, states, outputs.
    #[arg(short, long, value_name = "PATH.csv")]
    pub output: Option<PathBuf>,
    /// Draw obstacles, search and path.
    #[arg(long, value_name = "PICTURE.svg")]
    pub svg: Option<PathBuf>,
    /// Replace files that are there.
    #[arg(long)]
    pub force: bool,
    /// Tell the result as JSON.
    #[arg(long)]
    pub json: bool,
}

/// The planners by name.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum Planner {
    /// The first path that is found.
    Rrt,
    /// Ever shorter ones, until a limit.
    Sst,
}

/// Searches, and tells what it found.
pub(super) fn plan(args: &PlanArgs) -> Result<u8, Refusal> {
    // Whatever could not begin is 2 here: 1 says that there is no path.
    prepared(args).map_err(|refusal| Refusal {
        code: UNREADABLE,
        ..refusal
    })
}

fn prepared(args: &PlanArgs) -> Result<u8, Refusal> {
    let outputs = [&args.output, &args.svg].map(|path| {
        path.as_deref().map(|path| Output {
            path: Some(path),
            force: args.force,
            source: &args.file,
        })
    });
    let read = [&args.world, &args.obstacles];
    let read: Vec<&Path> = read.into_iter().flatten().map(PathBuf::as_path).collect();
    for output in outputs.iter().flatten() {
        output.look()?;
        output.spare(&read)?;
    }
    if let (Some(output), Some(picture)) = (&outputs[0], &args.svg) {
        output.spare(&[picture])?;
    }
    let (_, model) = load(&args.file, args.model.as_deref())?;
    let names: Vec<&str> = model
        .of_kind(Kind::Param)
        .map(|one| one.name.as_str())
        .collect();
    let given = args.params.iter().flat_map(|one| &one.0);
    let given = given.map(|(name, number)| (name.as_str(), *number));
    let params = values::in_order("--params", &names, given)?;
    let params = values::complete("--params", &names, params)?;
    let mut robot = Robot::new(&model, &params)
        .map_err(|refused| Refusal::new(format!("{}: {refused}", model.name)))?;
    let (obstacles, stands) = surroundings(args)?;
    let asked = ask::ask(args, &robot, &obstacles, stands.as_ref())?;
    let begun = Instant::now();
    let outcome = searched(args, &mut robot, &obstacles, &asked, begun)?;
    let seconds = begun.elapsed().as_secs_f64();
    if let Some(output) = &outputs[1] {
        output.write(picture::draw(&mut robot, &obstacles, &asked, &outcome).as_bytes())?;
    }
    if let (Some(output), Some(path)) = (&outputs[0], &outcome.path) {
        output.write(told::table(&mut robot, path).as_bytes())?;
    }
    let told = if args.json {
        told::json(&mut robot, &asked, &outcome, seconds)
    } else {
        told::summary(&mut robot, &asked, &outcome, seconds)
    };
    // Standard output is the table's if it goes there.
    if outputs[0].as_ref().is_some_and(Output::is_standard) {
        let _ = io::stderr().write_all(told.as_bytes());
    } else {
        crate::diagrams::output::standard(told.as_bytes())?;
    }
    Ok(if outcome.path.is_some() { 0 } else { NO_PATH })
}

/// Obstacles, and with a world where its robot stands.
fn surroundings(args: &PlanArgs) -> Result<(Obstacles, Option<field::Stand>), Refusal> {
    if let Some(path) = &args.world {
        let (field, _) = crate::up::world::read(path).map_err(Refusal::new)?;
        let obstacles = field::obstacles(&field)
            .map_err(|why| Refusal::new(format!("{}: {why}", telling::named(path))))?;
        return Ok((obstacles, field::stand(&field)));
    }
    let Some(path) = &args.obstacles else {
        return Ok((Obstacles::default(), None));
    };
    let told = |why: String| Refusal::new(format!("{}: {why}", telling::named(path)));
    let obstacles = read(path)
        .and_then(|text| text::read(&text).map_err(|fault| fault.to_string()))
        .map_err(told)?;
    Ok((obstacles, None))
}

fn read(path: &Path) -> Result<String, String> {
    let mut bytes = Vec::new();
    let limit = PLAN_OBSTACLES_TEXT_MAX as u64 + 1;
    File::open(path)
        .and_then(|file| file.take(limit).read_to_end(&mut bytes))
        .map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|_| "is no text in UTF-8".to_owned())
}

fn searched(
    args: &PlanArgs,
    robot: &mut Robot,
    obstacles: &Obstacles,
    asked: &Asked,
    begun: Instant,
) -> Result<Outcome, Refusal> {
    let default = Options::default();
    // A limit of time is the only one then.
    let iterations = |number: u64| match args.time_limit {
        Some(_) => PLAN_ITERATIONS_MAX,
        None => number,
    };
    let (method, iterations) = match args.planner {
        Planner::Rrt => (Method::Rrt, iterations(default.iterations)),
        Planner::Sst => {
            let method = Method::Sst {
                selection: args.selection.unwrap_or(asked.size * 0.075),
                pruning: args.pruning.unwrap_or(asked.size * 0.025),
            };
            (method, iterations(100_000))
        }
    };
    let options = Options {
        method,
        seed: args.seed,
        goal_bias: args.goal_bias,
        attempts: args.attempts,
        iterations: args.iterations.unwrap_or(iterations),
        ..default
    };
    let limit = match (args.time_limit, args.iterations) {
        (None, Some(_)) => None,
        (limit, _) => Some(limit.unwrap_or(60.0)),
    };
    let mut room = Room::new(obstacles, &asked.footprint, asked.parts, args.resolution)
        .map_err(|fault| Refusal::new(fault.to_string()))?;
    let is_watched = io::stderr().is_terminal() && !args.json;
    let mut shown = begun;
    let mut report = |counts: &Counts| {
        let now = Instant::now();
        if is_watched && now.duration_since(shown) >= PROGRESS {
            shown = now;
            eprint!("\r{}\x1b[K", told::progress(counts));
        }
        limit.is_none_or(|limit| now.duration_since(begun).as_secs_f64() < limit)
    };
    let outcome = search(robot, &mut room, &asked.problem, &options, &mut report);
    if is_watched {
        eprint!("\r\x1b[K");
    }
    outcome.map_err(|refusal| Refusal::new(refusal.to_string()))
}
