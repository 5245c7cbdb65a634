//! `trik debug`: a debugger for diagrams, forwards and backwards, and for data-flow programs, in a terminal.
//!
//! Owns the options, and which target a front end gets. `stage` is a simulated robot in this process, one in the network is
//! in `remote::debugged`; `terminal` talks to a person, `lines` reads what is typed, `complete` what Tab offers, `signals` has Ctrl-C, `asking` the program's questions to a person,
//! `stops` says where it is stopped, `listing` is the program as text, `words` what can be typed, `report` what comes back.
//! The debuggers themselves are in `lang_diagram::debug` and `lang_dataflow::debug`.

pub(crate) mod asking;
mod complete;
mod lines;
pub(crate) mod listing;
pub(crate) mod report;
mod signals;
pub(crate) mod stage;
pub(crate) mod stops;
pub(crate) mod target;
mod terminal;
mod words;

use crate::check::{CheckArgs, NO_BLOCKS, Ready, Staged, Start, model_seconds, staged};
use crate::error::Error;
use crate::language;
use crate::refusal::{Refusal, UNREADABLE, say};
use crate::remote;
use crate::remote::debugged::{Debugged, Runs};
use asking::Listener;
use clap::{Args, FromArgMatches};
use lang_diagram::debug::order::Order;
use lang_text::problem::Locale;
use listing::{Listing, listing_of};
use stage::Stage;
use std::ffi::OsString;
use std::path::PathBuf;
use target::Target as _;
use terminal::{Source, Terminal};

/// What `trik debug` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct DebugArgs {
    /// The diagram, a file NAME.qrs, or a data-flow program as text, a file NAME.flow.
    pub file: PathBuf,
    #[command(flatten)]
    pub world: WorldArgs,
    /// Debug it on this robot instead: its name or address, with its port if that is not 8888, or where the tree of a
    /// virtual one is mounted, a path with a slash. It is sent there and stopped before its first block; at the end it is
    /// stopped.
    #[arg(long, value_name = "ROBOT", value_parser = remote::target::target, conflicts_with_all = ["field", "task", "inputs", "gamepad", "speed"])]
    pub robot: Option<remote::target::Target>,
    /// Join the diagram that runs on the robot already, instead of starting it; FILE is what runs there. It is stopped, with
    /// its motors at rest, and goes on at the end.
    #[arg(long, requires = "robot")]
    pub attach: bool,
}

/// Which diagram is debugged, and in which world.
#[derive(Args, Clone, Debug)]
pub(crate) struct WorldArgs {
    /// Run the main diagram of this name instead of the first one.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// A world with its rules instead of the diagram's own.
    #[arg(long, value_name = "WORLD.xml")]
    pub field: Option<PathBuf>,
    /// The save that pupils were given: what it locks is taken from it, with its rules.
    #[arg(long, value_name = "TASK.qrs", conflicts_with = "field")]
    pub task: Option<PathBuf>,
    /// Lines with answers for Input blocks.
    #[arg(long, value_name = "FILE")]
    pub inputs: Option<PathBuf>,
    /// What a person does with the gamepad: lines such as "1.5 pad 1 30 -50", with the time in seconds.
    #[arg(long, value_name = "FILE")]
    pub gamepad: Option<PathBuf>,
    /// Longest run in seconds of simulated time, whatever the rules say.
    #[arg(long, value_name = "SECONDS", default_value_t = 600.0, value_parser = model_seconds)]
    pub time_limit: f64,
    /// Seed of everything random. The same seed gives the same run.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u32,
    /// How many times faster than real time the program runs [default: as fast as can be].
    #[arg(long, value_name = "FACTOR", value_parser = speed)]
    pub speed: Option<f64>,
    /// Language of messages and of the text of the diagram: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(times) if (0.01..=1000.0).contains(&times) => Ok(times),
        Ok(_) | Err(_) => Err("a number from 0.01 to 1000 is wanted".to_owned()),
    }
}

impl WorldArgs {
    /// The same as options of a run that is judged, whose limits are there for graders and not for people.
    pub(crate) fn check_args(&self, file: PathBuf) -> Result<CheckArgs, clap::Error> {
        let mut words: Vec<OsString> = vec!["check".into()];
        let files = [
            ("--field", &self.field),
            ("--task", &self.task),
            ("--inputs", &self.inputs),
            ("--gamepad", &self.gamepad),
        ];
        for (name, path) in files {
            if let Some(path) = path {
                words.extend([name.into(), path.clone().into_os_string()]);
            }
        }
        if let Some(diagram) = &self.diagram {
            words.push(format!("--diagram={diagram}").into());
        }
        words.push(format!("--seed={}", self.seed).into());
        words.push(format!("--time-limit={}", self.time_limit).into());
        words.extend(["--".into(), file.into_os_string()]);
        let command = CheckArgs::augment_args(clap::Command::new("check"));
        let matches = command.try_get_matches_from(words)?;
        let mut args = CheckArgs::from_arg_matches(&matches)?;
        args.language = self.language;
        Ok(args)
    }

    /// The diagram in its world, ready to run.
    ///
    /// # Errors
    /// Lines that say why it cannot run.
    pub(crate) fn stage(&self, file: PathBuf) -> Result<Staged, Vec<String>> {
        let args = self.check_args(file);
        let args = args.map_err(|why| vec![why.to_string()])?;
        staged(&args)
    }
}

/// Debugs a program in a simulated world.
///
/// # Errors
/// It cannot run, or the terminal is gone.
pub(crate) fn run(args: &DebugArgs) -> Result<u8, Refusal> {
    if let Some(robot) = &args.robot {
        return run_on(robot, args);
    }
    let staged = args.world.stage(args.file.clone()).map_err(refusal)?;
    talk(&staged, args.world.speed, Start::Stopped)
}

/// A person debugs a diagram on a robot.
fn run_on(robot: &remote::target::Target, args: &DebugArgs) -> Result<u8, Refusal> {
    let ending = args.file.extension().and_then(|ending| ending.to_str());
    if let Some("py" | "js") = ending {
        let why = format!("{}: {NO_BLOCKS}", args.file.display());
        return Err(Refusal::new(why));
    }
    let diagram = args.world.diagram.as_deref();
    let listing = listing_of(&args.file, diagram, args.world.language)?;
    let unreachable = |error: Error| Refusal {
        code: UNREADABLE,
        ..Refusal::new(error.to_string())
    };
    let begun = match args.attach {
        false => Debugged::launch(&args.file, diagram, robot, args.world.language),
        true => Debugged::attach(robot, Runs::Blocks, args.world.language),
    };
    let mut target = begun.map_err(unreachable)?;
    if args.attach {
        // A person types at a program that is stopped.
        target.order(&Order::Pause).map_err(unreachable)?;
    }
    target.attend(Listener::Person);
    let source = Source {
        file: args.file.clone(),
        diagram: args.world.diagram.clone(),
        locale: args.world.language,
    };
    let talked = Terminal::new(&mut target, listing, source).run();
    target.close();
    talked.map_err(unreachable)?;
    Ok(0)
}

/// A person debugs what was prepared.
///
/// # Errors
/// The terminal is gone.
pub(crate) fn talk(staged: &Staged, speed: Option<f64>, start: Start) -> Result<u8, Refusal> {
    say(&staged.strange);
    let listing = listing(staged);
    let mut stage = Stage::of(staged, start).at_speed(speed);
    match start {
        Start::Stopped => stage.attend(Listener::Person),
        // It does what it has done when it was judged.
        Start::Running => {}
    }
    let source = Source {
        file: staged.file.clone(),
        diagram: staged.diagram.clone(),
        locale: staged.settings.locale,
    };
    Terminal::new(&mut stage, listing, source).run()?;
    Ok(0)
}

/// The text of a program that is ready to run.
pub(crate) fn listing(staged: &Staged) -> Listing {
    let locale = staged.settings.locale;
    match &staged.program {
        Ready::Diagram(project, _) => Listing::of(project, locale),
        Ready::Flow(flow, _) => Listing::of_flow(&flow.project, locale),
    }
}

/// Lines that say why a diagram cannot run.
pub(crate) fn refusal(lines: Vec<String>) -> Refusal {
    Refusal {
        lines: lines.iter().map(|line| format!("trik: {line}")).collect(),
        code: UNREADABLE,
    }
}
