//! `trik replay`: the tree of a recording, which gives what was recorded when its time comes.
//!
//! Owns the order of place, player and tree, and what the player is for the session over it. `file` is the recording,
//! `player` has the clock, `tree` is the configuration, `outputs` compares what programs write, `order` are the words.

mod anew;
pub(crate) mod args;
mod clock;
mod file;
mod order;
mod outputs;
mod peer;
mod player;
mod recording;
mod tree;
mod words;
mod world;

use crate::error::Error;
use crate::output::{Output, standard};
use crate::place::{self, Place};
use crate::recording::shared::has_ending;
use crate::refusal::Refusal;
use crate::up::args::absolute;
use crate::up::page::{self, Served};
use crate::up::session::{Beneath, Over, Session, signals};
use crate::up::trikd::Trikd;
use ::page::playback::{Playback, State};
use ::page::world::{Refused, World};
use anew::{compare, tape};
use args::ReplayArgs;
use file::FileRecording;
use lang_text::problem::Locale;
use nix::sys::signalfd::SignalFd;
use order::Order;
use player::{Begin, CONTROL, Player, SOCKET};
use recording::Recording;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Arc;
use world::RecordedWorld;

/// Replays until somebody stops it.
///
/// # Errors
/// The file is no recording, the tree does not start, or with `--exit` programs did not do what was recorded.
pub(crate) fn run(args: &ReplayArgs) -> Result<u8, Refusal> {
    let is_same = match (&args.config, args.diff) {
        (Some(config), true) => differ(args, config)?,
        (_, _) => replay(args)?,
    };
    Ok(u8::from(!is_same))
}

/// Tells where another configuration makes something else of what devices gave; true if it does not.
fn differ(args: &ReplayArgs, config: &Path) -> Result<bool, Refusal> {
    let output = args.output.as_deref().map(|path| Output {
        path: Some(path),
        force: args.force,
        source: &args.file,
        locale: Locale::English,
    });
    if let Some(output) = &output {
        if !output.is_standard()
            && !args
                .output
                .as_deref()
                .is_some_and(|path| has_ending(path, "svg"))
        {
            return Err(Refusal::new("the picture is SVG: its name ends with .svg"));
        }
        output.refuse_present()?;
        output.spare(&[config])?;
    }
    let report = compare::compare(&compare::Wishes {
        of: anew::Of {
            file: &args.file,
            config,
            include: &args.include,
            only: &args.only,
        },
        from: u64::try_from(args.start.unwrap_or_default().as_nanos()).unwrap_or(u64::MAX),
        is_drawn: output.is_some(),
    })?;
    match output.zip(report.picture) {
        // The picture alone, for the next program.
        Some((output, picture)) if output.is_standard() => output.write(picture.as_bytes())?,
        Some((output, picture)) => {
            output.write(picture.as_bytes())?;
            standard(report.text.as_bytes())?;
        }
        None => standard(report.text.as_bytes())?,
    }
    Ok(report.is_same)
}

/// What is played: the recording, or what another configuration makes of it, which is in a file without a name.
fn played(args: &ReplayArgs, signals: &SignalFd) -> Result<FileRecording, Error> {
    let Some(config) = &args.config else {
        return FileRecording::open(&args.file);
    };
    let mut run = anew::Run::open(&anew::Of {
        file: &args.file,
        config,
        include: &args.include,
        only: &[],
    })?;
    // It has no name: what is wrong with its folder, such as no room, is told by that, and all else by the recording.
    let folder = std::env::temp_dir();
    let failed = |why| Error::file(&folder, why);
    let file = tempfile::tempfile_in(&folder).map_err(failed)?;
    let copy = file.try_clone().map_err(failed)?;
    let wants_end = || matches!(signals.read_signal(), Ok(Some(_)));
    tape::write(&mut run, (copy, &folder), &wants_end)?;
    FileRecording::of(file, &args.file)
}

/// True if nothing differs from the recording.
fn replay(args: &ReplayArgs) -> Result<bool, Error> {
    // Before anything is mounted it is known whether the file can be played.
    let length = FileRecording::open(&args.file)?.length();
    let begin = Begin {
        at: args.start.unwrap_or_default(),
        speed: args.speed,
        is_paused: args.paused,
        is_loop: args.is_loop,
    };
    if begin.at > length {
        let why = format!("the recording has {} only", words::time(length));
        return Err(Error::file(&args.file, why));
    }
    // Before converters and the player have threads, so that these come to the main thread alone.
    let signals = signals().map_err(|error| Error::system("signals", error))?;
    let recording = played(args, &signals)?;
    let mountpoint = args.mountpoint.as_deref().map(absolute).transpose()?;
    let place = Place::claim(&place::base()?, mountpoint.as_deref())?;
    let trikd = match args.serving.no_trikd {
        true => None,
        false => Some(Trikd::of(&args.serving, &place)?),
    };
    std::fs::create_dir_all(&place.board).map_err(|why| Error::file(&place.board, why))?;
    let _board = Board(&place.board);
    let text = tree::configuration(recording.channels(), &place.board.join(SOCKET));
    std::fs::write(&place.world, text).map_err(|why| Error::file(&place.world, why))?;
    let hints = hints(recording.channels());
    let name = args.file.file_name().unwrap_or_default().to_string_lossy();
    let player = Arc::new(Player::start(Box::new(recording), &place.board, begin)?);
    let beneath = Replay {
        name: name.into_owned(),
        hints,
        ends: args.exit,
        folder: &place.board,
        press: &|key| {
            if let Some(order) = Order::of_key(key) {
                player.order(order);
            }
        },
        player: &player,
    };
    let arguments: Vec<OsString> = vec![
        "mount".into(),
        option("--config", &place.world),
        "--".into(),
        place.mountpoint.clone().into(),
    ];
    let shown = page::Beneath {
        world: world_of(&args.file, &player)?,
        playback: Some(player.clone()),
    };
    let page = Served::start(
        &args.serving,
        &place,
        trikd.as_ref(),
        beneath.name.clone(),
        shown,
    )?;
    let over = Over::of(trikd, page, !args.no_view);
    let mut session = Session::start(&arguments, &beneath, &place, signals, over)?;
    let end = session.run();
    drop(session);
    let state = player.state();
    match state.failure {
        Some(why) => end.and(Err(Error::Refused(why))),
        None => end.map(|()| state.differences.is_empty() || !args.exit),
    }
}

/// The world of the recording, where the player is.
fn world_of(file: &Path, player: &Arc<Player>) -> Result<Option<Arc<dyn World>>, Error> {
    let player = player.clone();
    let world = RecordedWorld::open(file, move || Player::state(&player).position)?;
    Ok(world.map(|world| Arc::new(world) as Arc<dyn World>))
}

/// An option of trikfs in one word, so that a path that begins with a dash stays a value.
fn option(name: &str, value: &Path) -> OsString {
    let mut argument = OsString::from(name);
    argument.push("=");
    argument.push(value);
    argument
}

/// The folder of the player, which goes with it.
struct Board<'a>(&'a Path);

impl Drop for Board<'_> {
    fn drop(&mut self) {
        // It may have gone with the place.
        let _ = std::fs::remove_dir_all(self.0);
    }
}

/// The player of a recording as what is beneath a tree.
struct Replay<'a> {
    name: String,
    hints: Vec<(String, String)>,
    /// The session ends with the recording.
    ends: bool,
    folder: &'a Path,
    press: &'a dyn Fn(u8),
    player: &'a Player,
}

impl Beneath for Replay<'_> {
    fn name(&self) -> String {
        format!("the recording {}", self.name)
    }

    fn lines(&self) -> Vec<String> {
        words::view(&self.name, &self.player.state())
    }

    fn news(&self) -> Vec<String> {
        self.player.take_news()
    }

    fn hints(&self) -> Vec<(String, String)> {
        self.hints.clone()
    }

    fn about(&self) -> String {
        let control = self.folder.join(CONTROL);
        let state = self.player.state();
        format!(
            "\nIt lasts {}. Its clock is driven by lines in {}:\npause, go, step 10, speed 2, seek 1:30, seek +5, loop on\n",
            words::time(state.length),
            control.display()
        )
    }

    fn keys(&self) -> Option<&dyn Fn(u8)> {
        Some(self.press)
    }

    fn is_over(&self) -> bool {
        self.ends && self.player.state().is_at_end
    }
}

impl Playback for Player {
    fn state(&self) -> State {
        let state = Player::state(self);
        State {
            position: state.position,
            length: state.length,
            speed: state.speed,
            runs: state.runs,
            is_loop: state.is_loop,
        }
    }

    fn order(&self, words: &str) -> Result<(), Refused> {
        let order = Order::read(words).map_err(|why| Refused(words::bad_order(&why)))?;
        Player::order(self, order);
        Ok(())
    }
}

/// Nodes to look at.
fn hints(channels: &[recording::Channel]) -> Vec<(String, String)> {
    let sensors = channels.iter().filter(|channel| !channel.is_written);
    let some = sensors.take(3).map(|channel| {
        let unit = match channel.units.is_empty() {
            true => "what was recorded".to_owned(),
            false => format!("what was recorded, in {}", channel.units),
        };
        (format!("cat {}/value", channel.path), unit)
    });
    some.collect()
}
