//! `trik up`: a virtual board in this process, the tree over it in child processes, and the person in front of them.
//!
//! Owns the order of place and board, and what the board is for a `session`, which is the run over it. `tree` is the child,
//! `companion` others beside it, of which there are `trikd` and `ev3dev`, `world` reads worlds of TRIK Studio, `around` is the world for the
//! page and `telling` for recordings, `model` makes a robot of a model, `view` says how the robot is, `screen` draws it, `hints` says what to try.

pub(crate) mod args;
mod around;
mod companion;
mod ev3dev;
mod hints;
mod model;
pub(crate) mod page;
mod screen;
pub(crate) mod session;
pub(crate) mod telling;
pub(crate) mod tree;
pub(crate) mod trikd;
mod view;
mod words;
pub(crate) mod world;

use crate::error::Error;
use crate::place::{self, Place};
use crate::refusal::Refusal;
use ::page::world::World;
use args::{UpArgs, absolute};
use around::Around;
use page::Served;
use session::{Beneath, Over, Session, signals};
use sim::board::{Board, Options};
use sim::body::Body;
use sim::body::studio::{self, Studio};
use sim::field::{Field, Locks};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use telling::Telling;
use trikd::Trikd;

/// Runs a virtual robot until somebody stops it.
///
/// # Errors
/// Why it does not run, or how it ended.
pub(crate) fn run(args: UpArgs) -> Result<u8, Refusal> {
    simulate(args)?;
    Ok(0)
}

fn simulate(args: UpArgs) -> Result<(), Error> {
    let world = {
        let read = |path| world::read(path, args.serving.locale());
        args.world.as_deref().map(read).transpose()?
    };
    let platform = match &world {
        Some((field, locks)) => Platform::world(field, *locks, args.seed),
        None => Platform::robot(&args)?,
    };
    let config = match (&args.config, &platform.configuration) {
        // The configuration is made here, and includes this one.
        (None, Some(_)) => shipped(Path::new("trik.lua"), &args).map(|_| None)?,
        _ => Some(configuration(&args)?),
    };
    // Before the board has threads, so that these come to the main thread alone.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let mountpoint = args.mountpoint.as_deref().map(absolute).transpose()?;
    let mut place = Place::claim(&place::base()?, mountpoint.as_deref())?;
    let ev3dev = match &args.ev3dev {
        Some(wanted) => {
            let wanted = wanted.as_deref().map(absolute).transpose()?;
            let at = place.make_view(wanted.as_deref())?;
            Some((ev3dev::of(&place.mountpoint, &at), at))
        }
        None => None,
    };
    let trikd = match args.serving.no_trikd {
        true => None,
        false => Some(Trikd::of(&args.serving, &place)?),
    };
    let options = Options {
        speed: args.speed,
        seed: args.seed,
        ..Options::default()
    };
    let config = match (config, platform.configuration) {
        (None, Some(text)) => write(&text, &place.world)?,
        (config, _) => config.unwrap_or_default(),
    };
    let board = board(platform.body, options, &place)?;
    let arguments = arguments(&args, &config, &place);
    let virtual_robot = VirtualRobot {
        robot: if world.is_some() {
            "in the world"
        } else {
            &args.body
        },
        world: world.as_ref().map(|(field, _)| field),
        speed: args.speed,
        place: &place,
        board: &board,
    };
    let name = virtual_robot.robot.to_owned();
    let (beneath, telling) = seen(&board, &place)?;
    let page = Served::start(&args.serving, &place, trikd.as_ref(), name, beneath)?;
    let over = Over {
        ev3dev,
        trikd,
        page,
        has_view: !args.no_view,
    };
    let mut session = Session::start(&arguments, &virtual_robot, &place, signals, over)?;
    let end = session.run();
    drop(session);
    drop(telling);
    // Actuators have come to rest, so the board is not needed any more; then its place is free.
    drop(board);
    drop(place);
    end
}

fn board(body: Box<dyn Body>, options: Options, place: &Place) -> Result<Board, Error> {
    Board::start(&place.board, body, options).map_err(|error| {
        let what = format!("the virtual board in {}", place.board.display());
        Error::system(what, error)
    })
}

/// What the page shows of a board: the world around it, if it has one, which is told to those who record it too.
fn seen(board: &Board, place: &Place) -> Result<(page::Beneath, Option<Telling>), Error> {
    let around =
        |watcher| -> Arc<dyn World> { Arc::new(Around::new(watcher, place.board.clone())) };
    let world = board.watcher().map(around);
    let folder = telling::folder(&place.board);
    let telling = (world
        .clone()
        .map(|world| Telling::start(world, folder.clone())))
    .transpose();
    let beneath = page::Beneath {
        world,
        ..page::Beneath::default()
    };
    Ok((
        beneath,
        telling.map_err(|error| Error::file(&folder, error))?,
    ))
}

/// A virtual board as what is beneath a tree.
struct VirtualRobot<'a> {
    robot: &'a str,
    /// The world of TRIK Studio around it.
    world: Option<&'a Field>,
    speed: f64,
    place: &'a Place,
    board: &'a Board,
}

impl Beneath for VirtualRobot<'_> {
    fn name(&self) -> String {
        format!("the robot {}", self.robot)
    }

    fn lines(&self) -> Vec<String> {
        view::lines(&self.board.view(), self.robot, self.speed)
    }

    /// What the robot gives to the ear.
    fn news(&self) -> Vec<String> {
        let said = self.board.take_said();
        said.iter().map(|words| view::sound(words)).collect()
    }

    fn hints(&self) -> Vec<(String, String)> {
        hints::of(self.robot, self.world)
            .into_iter()
            .map(|(command, meaning)| (command, meaning.to_owned()))
            .collect()
    }

    fn about(&self) -> String {
        let board = self.place.board.display();
        format!("\nIts virtual board, with pose, control/keys and faults, is {board}\n")
    }
}

/// What a virtual robot stands on: a body, and the configuration that goes with it if it is in no file.
struct Platform {
    body: Box<dyn Body>,
    configuration: Option<String>,
}

impl Platform {
    /// The robot of a world.
    fn world(field: &Field, locks: Locks, seed: u64) -> Self {
        Self {
            body: Box::new(Studio::new(field, seed).locked(locks)),
            configuration: Some(studio::configuration(field)),
        }
    }

    /// The robot of a name.
    fn robot(args: &UpArgs) -> Result<Self, Error> {
        if let Some(robot) = sim::robots::by_name(&args.body) {
            if let Some(option) = model::stray(args) {
                return Err(Error::Refused(format!(
                    "{option} is for a model: --body FILE.dcml; '{}' has its own",
                    args.body
                )));
            }
            return Ok(Self {
                body: robot.body(),
                configuration: None,
            });
        }
        let (body, configuration) = model::robot(args)?;
        Ok(Self {
            body,
            configuration: Some(configuration),
        })
    }
}

/// Writes a configuration into a file, and gives its name back.
fn write(text: &str, into: &Path) -> Result<PathBuf, Error> {
    std::fs::write(into, text).map_err(|error| Error::file(into, error))?;
    Ok(into.to_owned())
}

/// What the tree is to be made of.
fn configuration(args: &UpArgs) -> Result<PathBuf, Error> {
    match &args.config {
        Some(path) if path.is_file() => absolute(path),
        Some(path) => Err(Error::file(path, "no such configuration")),
        None => {
            let name = PathBuf::from(format!("robots/{}.lua", args.body));
            shipped(&name, args)
        }
    }
}

/// A file that comes with this program.
fn shipped(name: &Path, args: &UpArgs) -> Result<PathBuf, Error> {
    let include: Result<_, Error> = args.include.iter().map(|dir| absolute(dir)).collect();
    trikfs::cli::find_shipped(name, include?).map_err(|why| {
        Error::Refused(format!(
            "{why}; --include names another directory: that of the source is config/lua"
        ))
    })
}

/// The command line of trikfs.
fn arguments(args: &UpArgs, config: &Path, place: &Place) -> Vec<OsString> {
    let mut list: Vec<OsString> = vec!["mount".into()];
    let mut option = |name: &str, value: &Path| {
        // In one word, so that a path that begins with a dash stays a value.
        let mut argument = OsString::from(name);
        argument.push("=");
        argument.push(value);
        list.push(argument);
    };
    option("--config", config);
    option("--device-root", &place.board);
    for dir in &args.include {
        option("--include", dir);
    }
    if let Some(cache) = &args.cache {
        option("--cache", cache);
    }
    if let Some(group) = &args.group {
        option("--group", Path::new(group));
        list.push("--allow-other".into());
    }
    list.extend(args.raw.then(|| "--raw".into()));
    list.push("--".into());
    list.push(place.mountpoint.clone().into());
    list
}
