//! `trik dcml plan`: a path of a robot from one place to another, among obstacles.
//!
//! Owns the words, the clock and the exit code: 0 a path, 1 none, 2 the search could not begin. How it is searched is known
//! to `lang_plan` alone; `ask` makes its question, `field` its obstacles from a world, `answer` and `picture` show
//! the answer.

mod answer;
pub(crate) mod args;
mod ask;
mod field;
mod forms;
mod picture;

use self::args::{PlanArgs, Planner};
use self::ask::Question;
use super::load::load;
use super::values;
use crate::error::Error;
use crate::input;
use crate::input::words::{A_FILE, why};
use crate::output::{Output, standard};
use crate::refusal::{Refusal, UNREADABLE};
use crate::terminal::named;
use lang_dcml::robot::Robot;
use lang_dcml::syntax::Kind;
use lang_plan::limits::{PLAN_ITERATIONS_MAX, PLAN_OBSTACLES_TEXT_MAX};
use lang_plan::obstacles::{Obstacles, text};
use lang_plan::room::Room;
use lang_plan::{Counts, Method, Options, Outcome, plan};
use lang_text::problem::Locale;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Exit code when there is no path.
const NO_PATH: u8 = 1;
/// How often a person sees how far it is.
const PROGRESS: Duration = Duration::from_millis(100);

/// Searches, and tells what it found.
pub(super) fn run(args: &PlanArgs) -> Result<u8, Refusal> {
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
            locale: Locale::English,
        })
    });
    let read = [&args.world, &args.obstacles];
    let read: Vec<&Path> = read.into_iter().flatten().map(PathBuf::as_path).collect();
    for output in outputs.iter().flatten() {
        output.refuse_present()?;
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
        output.write(answer::table(&mut robot, path).as_bytes())?;
    }
    let summary = if args.json {
        answer::json(&mut robot, &asked, &outcome, seconds)
    } else {
        answer::summary(&mut robot, &asked, &outcome, seconds)
    };
    // Standard output is the table's if it goes there.
    if outputs[0].as_ref().is_some_and(Output::is_standard) {
        let _ = io::stderr().write_all(summary.as_bytes());
    } else {
        standard(summary.as_bytes())?;
    }
    Ok(if outcome.path.is_some() { 0 } else { NO_PATH })
}

/// Obstacles, and with a world where its robot stands.
fn surroundings(args: &PlanArgs) -> Result<(Obstacles, Option<field::Stand>), Refusal> {
    if let Some(path) = &args.world {
        let (field, _) = crate::up::world::read(path, Locale::English)?;
        let obstacles = field::obstacles(&field)
            .map_err(|why| Refusal::new(format!("{}: {why}", named(path))))?;
        return Ok((obstacles, field::stand(&field)));
    }
    let Some(path) = &args.obstacles else {
        return Ok((Obstacles::default(), None));
    };
    let obstacles =
        text::read(&read(path)?).map_err(|why| Refusal::new(format!("{}: {why}", named(path))))?;
    Ok((obstacles, None))
}

fn read(path: &Path) -> Result<String, Error> {
    let refused = |why: String| Error::Refused(format!("{}: {why}", named(path)));
    // One more than may be, so that the reader of the text can say it.
    let limit = PLAN_OBSTACLES_TEXT_MAX as u64 + 1;
    let bytes =
        input::read(path, limit).map_err(|unread| refused(why(&unread, limit, A_FILE).english))?;
    String::from_utf8(bytes).map_err(|_| refused("is no text in UTF-8".to_owned()))
}

fn searched(
    args: &PlanArgs,
    robot: &mut Robot,
    obstacles: &Obstacles,
    asked: &Question,
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
        .and_then(|room| room.with_bodies(&asked.bodies))
        .map_err(|fault| Refusal::new(fault.to_string()))?;
    let is_watched = io::stderr().is_terminal() && !args.json;
    let mut shown = begun;
    let mut report = |counts: &Counts| {
        let now = Instant::now();
        if is_watched && now.duration_since(shown) >= PROGRESS {
            shown = now;
            eprint!("\r{}\x1b[K", answer::progress(counts));
        }
        limit.is_none_or(|limit| now.duration_since(begun).as_secs_f64() < limit)
    };
    let outcome = plan(robot, &mut room, &asked.problem, &options, &mut report);
    if is_watched {
        eprint!("\r\x1b[K");
    }
    outcome.map_err(|refusal| Refusal::new(refusal.told(&asked.names)))
}
