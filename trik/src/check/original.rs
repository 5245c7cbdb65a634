//! Instead of TRIK Studio's `2D-model` and `patcher`: the same option names, for graders that call these programs.
//!
//! Owns the words and the exit codes of both: 2D-model 0 done, 1 errors in the report, 2 could not be run, 3 no program
//! written, 4 unknown language; patcher 0 done, 1 unreadable, 2 contradicting options, 255 not saved. The exit code of the
//! original is 0 for failed tasks too; here it is true. What a run is, is in `run`.

use super::args::CheckArgs;
use super::confine;
use super::jobs::Job;
use super::pool;
use super::run::text;
use crate::diagrams::generate::{self, GenArgs};
use crate::diagrams::save::must_open;
use crate::error::Error;
use crate::output::Output;
use crate::refusal::say;
use crate::{language, limits};
use clap::Parser;
use lang_diagram::generate::Language;
use lang_text::problem::Locale;
use sim::field::Field;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// How Qt shows windows, in its own words.
const PLATFORMS: [&str; 12] = [
    "minimal",
    "offscreen",
    "xcb",
    "wayland",
    "wayland-egl",
    "vnc",
    "eglfs",
    "linuxfb",
    "minimalegl",
    "vkkhrdisplay",
    "windows",
    "cocoa",
];

/// What `2D-model` can be told.
#[derive(Parser, Debug)]
#[command(
    name = "2D-model",
    version,
    about = "Runs a save and judges it by the rules of its world, as TRIK Studio's 2D-model does.",
    after_help = "Exit status: 0 done; 1 the task was not accomplished, or the report has an error; 2 it could not be run; \
                  3 no program could be written; 4 unknown language."
)]
struct Model {
    /// Save that is run.
    #[arg(value_name = "qrs-file")]
    file: PathBuf,
    /// As fast as possible; it is always so here.
    #[arg(short, long)]
    background: bool,
    /// Needed there without a screen; does nothing here.
    #[arg(long, value_name = "PLATFORM", value_parser = platform)]
    platform: Option<String>,
    /// File for what the rules said (JSON).
    #[arg(short, long, value_name = "path-to-report")]
    report: Option<PathBuf>,
    /// File or FIFO for the trajectory (JSON); recorded with and without --console.
    #[arg(short, long, value_name = "path-to-trajectory")]
    trajectory: Option<PathBuf>,
    /// Lines for programs that read. A file that is not there has none: graders name one for each field.
    #[arg(short, long, value_name = "path-to-input")]
    input: Option<OsString>,
    /// "diagram", or "script" for the program in JavaScript or Python.
    #[arg(short, long, default_value = "diagram")]
    mode: String,
    /// Speed; does nothing here.
    #[arg(short, long, default_value = "0", value_parser = whole)]
    speed: i32,
    /// Does nothing here: there is no window.
    #[arg(long)]
    close: bool,
    /// Does nothing here: there is no window.
    #[arg(long, alias = "close-on-succes")]
    close_on_success: bool,
    /// Does nothing here.
    #[arg(short, long)]
    console: bool,
    /// Does nothing here.
    #[arg(short, long)]
    display: bool,
    /// New file for the diagram as a program.
    #[arg(long, value_name = "path-to-save-code")]
    generate_path: Option<PathBuf>,
    /// "python" or "javascript".
    #[arg(long, default_value = "javascript")]
    generate_mode: String,
    /// Program in JavaScript or Python that is run in the world of the save.
    #[arg(long, value_name = "script-path")]
    script_path: Option<OsString>,
    /// Only write the program.
    #[arg(long, requires = "generate_path")]
    only_generate: bool,
    /// Does nothing here.
    #[arg(long, value_name = "ms", default_value = "0", value_parser = whole)]
    delay_before_exit: i32,
}

/// What `patcher` can be told.
#[derive(Parser, Debug)]
#[command(
    name = "patcher",
    version,
    about = "Changes a save in its place, as TRIK Studio's patcher does.",
    after_help = "Exit status: 0 done; 1 a file cannot be read; 2 more than one of -f, -w and --wp; 255 not saved."
)]
struct Patcher {
    /// Save that is changed.
    #[arg(value_name = "save-file")]
    file: PathBuf,
    /// Field that replaces the whole world, with robot, sensors and rules.
    #[arg(short, value_name = "field.xml")]
    field: Option<PathBuf>,
    /// Field that replaces the world but for the robot, its place and its sensors.
    #[arg(short, value_name = "field.xml")]
    world: Option<PathBuf>,
    /// Field that replaces the world but for the robot's sensors.
    #[arg(long = "wp", value_name = "field.xml")]
    with_place: Option<PathBuf>,
    /// Program that is put into the save.
    #[arg(short, value_name = "script.js")]
    script: Option<OsString>,
    /// Puts the robot onto its start marker.
    #[arg(long = "rrp")]
    to_start: bool,
}

/// A number that means nothing here, but must be one.
fn whole(text: &str) -> Result<i32, String> {
    let number = text.parse().ok().filter(|number| *number >= 0);
    number.ok_or_else(|| "not a whole number from 0 on".to_owned())
}

/// Platforms of Qt, perhaps with parameters after a colon.
fn platform(name: &str) -> Result<String, String> {
    let known = PLATFORMS.contains(&name.split(':').next().unwrap_or_default());
    let names = PLATFORMS.join(", ");
    known
        .then(|| name.to_owned())
        .ok_or_else(|| format!("Qt has {names}; none of them is needed here"))
}

/// Whether a program's name is one of the original's, perhaps with the ending of its debug build.
pub(crate) fn is_model(name: &str) -> bool {
    matches!(name, "2D-model" | "2D-model-d")
}

/// See [`is_model`].
pub(crate) fn is_patcher(name: &str) -> bool {
    matches!(name, "patcher" | "patcher-d")
}

/// `-platform` and its like, as Qt has them, with two dashes.
fn words(name: &str, arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let long = |word: OsString| match word.to_str() {
        Some("-platform") => "--platform".into(),
        Some("-wp") => "--wp".into(),
        Some("-rrp") => "--rrp".into(),
        _ => word,
    };
    std::iter::once(name.into())
        .chain(arguments.map(long))
        .collect()
}

fn parsed<T: Parser>(name: &str, arguments: impl Iterator<Item = OsString>) -> Result<T, u8> {
    T::try_parse_from(words(name, arguments)).map_err(|error| {
        let _ = error.print();
        u8::try_from(error.exit_code()).unwrap_or(2)
    })
}

/// A path that was named; graders give an empty one for none.
fn named(path: &Option<OsString>) -> Option<PathBuf> {
    path.as_ref()
        .filter(|path| !path.is_empty())
        .map(PathBuf::from)
}

/// `2D-model` with these arguments.
pub(crate) fn model(arguments: impl Iterator<Item = OsString>) -> u8 {
    let args: Model = match parsed("2D-model", arguments) {
        Ok(args) => args,
        Err(code) => return code,
    };
    let code = match &args.generate_path {
        Some(path) => generated(&args, path),
        None => 0,
    };
    if code != 0 || args.only_generate {
        return code;
    }
    let is_script = match &*args.mode {
        "diagram" => false,
        "script" => true,
        other => {
            say(&[format!(
                "2D-model: there is no mode '{other}'; there are diagram and script"
            )]);
            return 2;
        }
    };
    if named(&args.script_path).is_some() && !is_script {
        say(&["2D-model: --script-path is used only with --mode script".to_owned()]);
        return 2;
    }
    let job = Job {
        solution: args.file.clone(),
        field: None,
        log: None,
        given: None,
        inputs: None,
        name: PathBuf::new(),
    };
    let is_input_there = named(&args.input).is_none_or(|path| path.exists());
    let check = wanted(args, is_script);
    let check = match confine::settle(std::slice::from_ref(&job), &check) {
        Ok(check) => check,
        Err(refusal) => {
            say(&refusal.lines);
            return refusal.code;
        }
    };
    let row = pool::run_one(job, &check);
    if !is_input_there {
        // check-solution.sh names a file for each field, whether there is one or not: that is no error.
        say(&[
            "2D-model: warning: the file of --input is not there: nothing can be read".to_owned(),
        ]);
    }
    say(&row.lines(check.language));
    let has_error = row.messages.iter().any(|(level, _)| level == "error");
    row.verdict.code().max(u8::from(has_error))
}

/// The same in the words of `trik check`.
fn wanted(args: Model, is_script: bool) -> CheckArgs {
    CheckArgs {
        script: named(&args.script_path),
        inputs: named(&args.input).filter(|path| path.exists()),
        paths: vec![args.file],
        report: args.report,
        trajectory: args.trajectory,
        force: true,
        time_limit: limits::MODEL_SECONDS_MAX,
        wall_limit: limits::WALL_SECONDS_MAX,
        language: language::of_system(),
        is_one: true,
        is_embedded: is_script,
        ..CheckArgs::plain()
    }
}

/// Writes the diagram as a program; the exit code if that is all.
fn generated(args: &Model, path: &Path) -> u8 {
    let lang = match &*args.generate_mode {
        "python" => Language::Python,
        "javascript" => Language::JavaScript,
        other => {
            say(&[format!(
                "2D-model: there is no language '{other}'; there are python and javascript"
            )]);
            return 4;
        }
    };
    let wanted = GenArgs {
        file: args.file.clone(),
        lang,
        diagram: None,
        output: Some(path.to_owned()),
        force: false,
        goto: false,
        language: language::of_system(),
    };
    match generate::run(&wanted) {
        Ok(_) => 0,
        Err(refusal) => {
            say(&refusal.lines);
            3
        }
    }
}

/// `patcher` with these arguments.
pub(crate) fn patcher(arguments: impl Iterator<Item = OsString>) -> u8 {
    let args: Patcher = match parsed("patcher", arguments) {
        Ok(args) => args,
        Err(code) => return code,
    };
    match patched(&args) {
        Ok(()) => 0,
        Err((lines, code)) => {
            say(&lines);
            code
        }
    }
}

type Refused = (Vec<String>, u8);

fn patched(args: &Patcher) -> Result<(), Refused> {
    let because = |code: u8| move |why: String| (vec![format!("patcher: {why}")], code);
    let locale = language::of_system();
    let fields = [&args.field, &args.world, &args.with_place];
    if fields.iter().filter(|field| field.is_some()).count() > 1 {
        return Err(because(2)("use only one of -f, -w and --wp".to_owned()));
    }
    let mut opened = must_open(&args.file, locale).map_err(|refusal| (refusal.lines, 1))?;
    let told = |problem: lang_text::problem::Problem| because(1)(problem.in_locale(locale));
    if let Some(path) = fields.into_iter().flatten().next() {
        let world = text(path, limits::WORLD_BYTES_MAX, locale)
            .map_err(|why| because(1)(why.to_string()))?;
        let world = match &args.field {
            Some(_) => world,
            None => {
                let old = opened.project.world.as_deref().unwrap_or_default();
                merged(&world, old, args.world.is_some())
                    .map_err(|why| because(1)(why.to_string()))?
            }
        };
        opened.save.set_world(&world).map_err(told)?;
    }
    if let Some(path) = named(&args.script) {
        let code = text(&path, limits::WORLD_BYTES_MAX, locale)
            .map_err(|why| because(1)(why.to_string()))?;
        let ending = path
            .extension()
            .and_then(OsStr::to_str)
            .unwrap_or("js")
            .to_lowercase();
        opened.save.set_code(&code, &ending).map_err(told)?;
    }
    if args.to_start {
        let (project, _) = opened.save.project();
        let mut field = field_of(project.world.as_deref().unwrap_or_default(), locale)
            .map_err(|why| because(1)(why.to_string()))?;
        if let Some(robot) = field.robot_mut() {
            robot.to_start();
        }
        opened.save.set_world(&field.write()).map_err(told)?;
    }
    let bytes = opened
        .save
        .write()
        .map_err(|problem| because(255)(problem.in_locale(locale)))?;
    let output = Output {
        path: Some(&args.file),
        force: true,
        // The save itself is what is replaced.
        source: Path::new(""),
        locale: Locale::English,
    };
    output.write(&bytes).map_err(|refusal| (refusal.lines, 255))
}

fn field_of(world: &str, locale: Locale) -> Result<Field, Error> {
    let opened = Field::read(world).map_err(|problems| {
        let lines: Vec<String> = problems
            .iter()
            .map(|problem| problem.in_locale(locale))
            .collect();
        Error::Refused(lines.join("; "))
    })?;
    Ok(opened.field)
}

/// A new world with the robots of an old one; they keep the new place unless `keep_place`.
fn merged(new: &str, old: &str, keep_place: bool) -> Result<String, Error> {
    let locale = language::of_system();
    let mut field = field_of(new, locale)?;
    let old = field_of(old, locale)?;
    if let (Some(robot), Some(before)) = (field.robot_mut(), old.robot()) {
        let (position, direction, start) = (robot.position, robot.direction, robot.start.clone());
        *robot = before.clone();
        if !keep_place {
            (robot.position, robot.direction, robot.start) = (position, direction, start);
        }
    }
    Ok(field.write())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_words_of_the_original_are_understood() {
        Model::command().debug_assert();
        Patcher::command().debug_assert();
        let line = "-b -platform minimal --report r -t t -i i -m script -s 20 --close -c x.qrs";
        let words = words("2D-model", line.split(' ').map(OsString::from));
        let args = Model::try_parse_from(words).unwrap();
        assert_eq!(args.platform.as_deref(), Some("minimal"));
        assert_eq!((args.file, args.mode.as_str()), ("x.qrs".into(), "script"));
        assert_eq!(args.report, Some("r".into()));
        let line = "x.qrs -f field.xml -s ";
        let words: Vec<_> = line.split(' ').map(OsString::from).collect();
        let args = Patcher::try_parse_from(super::words("patcher", words.into_iter())).unwrap();
        assert_eq!(args.field, Some("field.xml".into()));
        assert_eq!(args.script, Some("".into()));
        for wrong in [
            "--platform nope x.qrs",
            "--speed NaN x.qrs",
            "--speed -5 x.qrs",
            "--delay-before-exit soon x.qrs",
            "--only-generate x.qrs",
            "--fly x.qrs",
            "x.qrs y.qrs",
        ] {
            let words = super::words("2D-model", wrong.split(' ').map(OsString::from));
            assert!(Model::try_parse_from(words).is_err(), "{wrong}");
        }
    }
}
