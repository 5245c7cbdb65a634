//! The options of `trik check`.
//!
//! Owns the options and how they are passed to a worker process. Knows nothing of what they do.

use super::grade_args::GradeArgs;
use super::page_args::MarksPageArgs;
use super::platform::Platform;
use super::recorded_args::RecordedArgs;
use super::sandbox_args::SandboxArgs;
use crate::{language, limits};
use clap::{ArgGroup, Args};
use lang_text::problem::Locale;
use std::ffi::OsString;
use std::path::PathBuf;

/// Seconds of simulated time that a run may take.
pub(crate) const MODEL_SECONDS: f64 = 600.0;
/// Seconds of real time.
pub(crate) const WALL_SECONDS: f64 = 60.0;
/// Memory of one process.
pub(crate) const MEMORY_MIB: u32 = 1024;

/// Options of `trik check`.
#[derive(Args, Clone, Debug)]
#[command(group = ArgGroup::new("table").args(["out", "is_served"]).multiple(true))]
pub(crate) struct CheckArgs {
    /// Solutions: diagrams NAME.qrs, data-flow programs NAME.flow, programs NAME.js and NAME.py if a field is given, and
    /// directories of them.
    #[arg(value_name = "FILE|DIR", required_unless_present_any = ["worker", "log"])]
    pub paths: Vec<PathBuf>,
    /// Run the main diagram of this name instead of the first one of a diagram or data-flow program.
    #[arg(long, value_name = "NAME", conflicts_with = "log")]
    pub diagram: Option<String>,
    /// A world with its rules instead of the solution's own: walls, robot, sensors and constraints are all replaced. May
    /// be given several times; a directory means all NAME.xml in it.
    #[arg(long, value_name = "WORLD.xml")]
    pub field: Vec<PathBuf>,
    /// With --field: run each solution in its own world too.
    #[arg(long, requires = "field")]
    pub own: bool,
    /// The save that pupils were given: what it locks is taken from it, with its rules, and the rest of the world is the
    /// solution's own.
    #[arg(long, value_name = "TASK.qrs", conflicts_with_all = ["field", "log"])]
    pub task: Option<PathBuf>,
    /// A program in JavaScript or Python that drives the robot instead of the diagram.
    #[arg(long, value_name = "PROG.js|.py", conflicts_with = "log")]
    pub script: Option<PathBuf>,
    /// Tell why each run ended as it did: the rule that decided and when, the last values of its conditions, how near the
    /// others came, and the block that each thread was at.
    #[arg(long)]
    pub explain: bool,
    /// Run one diagram in the debugger: when the first rule has failed, what was can be looked at, and gone back to.
    #[arg(long = "debug", conflicts_with_all = ["script", "log", "report", "trajectory", "svg", "html", "display", "results", "platform", "out"])]
    pub is_debugging: bool,
    /// Lines that the program is given when it asks: answers for Input blocks, and what textual programs read.
    #[arg(long, value_name = "FILE")]
    pub inputs: Option<PathBuf>,
    /// What a person does with the gamepad and the keys: lines such as "1.5 pad 1 30 -50", with the time in seconds.
    #[arg(long, value_name = "FILE", conflicts_with = "log")]
    pub gamepad: Option<PathBuf>,
    /// Judge a recorded run instead of running a program, by the rules of FILE or of --field: a trajectory that
    /// --trajectory or TRIK Studio has written, or a recording of a robot, NAME.mcap. May be given several times; a
    /// directory means all NAME.json and NAME.mcap in it.
    #[arg(long, value_name = "T.json|T.mcap|DIR")]
    pub log: Vec<PathBuf>,
    /// Which run of a recording is judged, and by which node.
    #[command(flatten)]
    pub recorded: RecordedArgs,
    /// Write all messages as JSON, in the format of TRIK Studio. With several runs here and below: a directory, with a
    /// file for each run.
    #[arg(long, value_name = "OUT.json")]
    pub report: Option<PathBuf>,
    /// Write where the robot was in each tick and the commands to its devices, in the format of TRIK Studio.
    #[arg(long, value_name = "OUT.json")]
    pub trajectory: Option<PathBuf>,
    /// Draw the field and the path of the robot.
    #[arg(long, value_name = "OUT.svg")]
    pub svg: Option<PathBuf>,
    /// Write a page that shows the run, for any browser.
    #[arg(long, value_name = "OUT.html")]
    pub html: Option<PathBuf>,
    /// Write what is on the robot's display at the end, as a picture.
    #[arg(long, value_name = "OUT.png")]
    pub display: Option<PathBuf>,
    /// Write a line of JSON for each run, in the order of the runs; - is standard output, instead of the table.
    #[arg(long, value_name = "OUT.jsonl")]
    pub results: Option<PathBuf>,
    /// Answer as a grader of this platform, with its exit codes, instead of the table.
    #[arg(long = "for", value_name = "PLATFORM", value_enum, conflicts_with_all = ["results", "out"])]
    pub platform: Option<Platform>,
    /// With --for stepik: the points that make the whole score. Without it the score is 1 for an accomplished task, else 0.
    #[arg(long, value_name = "NUMBER", requires = "platform", value_parser = positive)]
    pub full_points: Option<f64>,
    /// The table of a class.
    #[command(flatten)]
    pub grades: GradeArgs,
    /// The page of marks.
    #[command(flatten)]
    pub marks: MarksPageArgs,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
    /// Go on after the first failure and collect all of them.
    #[arg(long = "continue")]
    pub keep_going: bool,
    /// How many runs at once [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: Option<u16>,
    /// Let markers leave traces that sensors and rules see, as in the window of TRIK Studio; graders run it without one,
    /// and there are none.
    #[arg(long)]
    pub marker_traces: bool,
    /// Longest run in seconds of simulated time, whatever the rules say.
    #[arg(long, value_name = "SECONDS", default_value_t = MODEL_SECONDS, value_parser = model_seconds)]
    pub time_limit: f64,
    /// Longest run in seconds of real time; a longer one counts as one that could not be run.
    #[arg(long, value_name = "SECONDS", default_value_t = WALL_SECONDS, value_parser = wall_seconds)]
    pub wall_limit: f64,
    /// Maximum memory of one process, in MiB.
    #[arg(long, value_name = "MIB", default_value_t = MEMORY_MIB, value_parser = memory())]
    pub memory: u32,
    /// What programs in Python are confined by.
    #[command(flatten)]
    pub sandbox: SandboxArgs,
    /// Seed of everything random. The same seed gives the same run.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u32,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
    /// Serve jobs from standard input.
    #[arg(long, hide = true)]
    pub worker: bool,
    /// Outputs are files, not directories.
    #[arg(long = "one", hide = true)]
    pub is_one: bool,
    /// Run the program that the save itself holds beside the diagram; for `2D-model --mode script`.
    #[arg(long = "embedded", hide = true)]
    pub is_embedded: bool,
}

impl CheckArgs {
    /// Those of a command line that names nothing.
    pub(super) fn plain() -> Self {
        Self {
            paths: Vec::new(),
            diagram: None,
            field: Vec::new(),
            own: false,
            task: None,
            script: None,
            explain: false,
            is_debugging: false,
            inputs: None,
            gamepad: None,
            log: Vec::new(),
            recorded: Default::default(),
            report: None,
            trajectory: None,
            svg: None,
            html: None,
            display: None,
            results: None,
            platform: None,
            full_points: None,
            grades: Default::default(),
            marks: Default::default(),
            force: false,
            keep_going: false,
            jobs: None,
            marker_traces: false,
            time_limit: MODEL_SECONDS,
            wall_limit: WALL_SECONDS,
            memory: MEMORY_MIB,
            sandbox: Default::default(),
            seed: 1,
            language: Locale::English,
            worker: false,
            is_one: false,
            is_embedded: false,
        }
    }

    /// The words with which a worker process is started that does such runs.
    pub(super) fn for_worker(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = vec!["check".into(), "--worker".into()];
        let paths = [
            ("--script", &self.script),
            ("--task", &self.task),
            ("--inputs", &self.inputs),
            ("--gamepad", &self.gamepad),
            ("--report", &self.report),
            ("--trajectory", &self.trajectory),
            ("--svg", &self.svg),
            ("--html", &self.html),
            ("--display", &self.display),
        ];
        for (name, path) in paths {
            if let Some(path) = path {
                let mut word = OsString::from(name);
                word.push("=");
                word.push(path);
                words.push(word);
            }
        }
        if let Some(diagram) = &self.diagram {
            words.push(format!("--diagram={diagram}").into());
        }
        for (name, is_set) in [
            ("--force", self.force),
            ("--continue", self.keep_going),
            ("--explain", self.explain),
            ("--marker-traces", self.marker_traces),
            ("--one", self.is_one),
            ("--embedded", self.is_embedded),
        ] {
            if is_set {
                words.push(name.into());
            }
        }
        words.extend(self.sandbox.for_worker());
        words.extend(self.recorded.for_worker());
        words.extend([
            format!("--time-limit={}", self.time_limit).into(),
            format!("--wall-limit={}", self.wall_limit).into(),
            format!("--memory={}", self.memory).into(),
            format!("--seed={}", self.seed).into(),
            format!("--language={}", self.language.name()).into(),
        ]);
        words
    }
}

pub(crate) fn model_seconds(text: &str) -> Result<f64, String> {
    seconds(text, limits::MODEL_SECONDS_MAX)
}

/// Of one process, in MiB.
pub(crate) fn memory() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(64..=65536)
}

pub(crate) fn wall_seconds(text: &str) -> Result<f64, String> {
    seconds(text, limits::WALL_SECONDS_MAX)
}

fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    let number = number.filter(|number| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "not a number above 0".to_owned())
}

fn seconds(text: &str, max: f64) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    number
        .filter(|seconds| (0.01..=max).contains(seconds))
        .ok_or_else(|| format!("not a number of seconds from 0.01 to {max}"))
}
