//! The options of `trik dcml plan`.
//!
//! Owns the options. Their forms are those of `forms`, what they do is known to `plan` and `ask`.

use super::forms::{self, Assignments, Bodied, Footing, Linked, Ranges};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The options of `trik dcml plan`.
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
    pub params: Vec<Assignments>,
    /// The initial state; what is not named is 0, or with --field the position of its robot.
    #[arg(long, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub start: Vec<Assignments>,
    /// The goal: x=3,y=2 and optionally theta=0. States and outputs may be named.
    #[arg(long, required = true, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub goal: Vec<Assignments>,
    /// How near the goal is near enough, in the unit of x and y.
    #[arg(long, value_name = "R", default_value_t = 0.1, value_parser = forms::positive)]
    pub goal_radius: f64,
    /// The same for angles that the goal names, in radians.
    #[arg(long, value_name = "RADIANS", default_value_t = 0.2, value_parser = forms::positive)]
    pub goal_angle: f64,
    /// Which states or outputs are its position [default: x, y and theta, also in capitals].
    #[arg(long, value_name = "X,Y[,HEADING]", value_delimiter = ',')]
    pub position: Vec<String>,
    /// States that are angles though the model does not say `in S1`; the heading is one anyway.
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub angles: Vec<String>,
    /// Ranges of states and outputs, which no step of the path leaves: x=0..3,bend=-1..1 [default: as the model says; for x
    /// and y around start, goal and obstacles].
    #[arg(long, value_name = "NAME=LOW..HIGH,...", value_parser = forms::ranges)]
    pub bounds: Vec<Ranges>,
    /// Ranges of actions: u=-1..1 [default: as the model says].
    #[arg(long, value_name = "NAME=LOW..HIGH,...", value_parser = forms::ranges)]
    pub actions: Vec<Ranges>,
    /// Weight of a difference of 1 in distances [default: 1 for x and y, less for others].
    #[arg(long, value_name = "NAME=NUMBER,...", value_parser = forms::given)]
    pub weights: Vec<Assignments>,
    /// Obstacles: a world of TRIK Studio, FILE.xml or a project FILE.qrs. In metres, x to the right and y up, so y has the
    /// other sign than there.
    #[arg(
        long = "field",
        alias = "world",
        value_name = "FILE",
        conflicts_with = "obstacles"
    )]
    pub world: Option<PathBuf>,
    /// Obstacles: a text with lines like `wall 0 1 2 1 0.02`, `rectangle`, `polygon`, `circle`, `bounds`.
    #[arg(long, value_name = "FILE")]
    pub obstacles: Option<PathBuf>,
    /// The area that it covers: circle:RADIUS or polygon:X,Y,X,Y,..., convex, seen from its position [default: circle:0.1; with
    /// --field the robot of TRIK].
    #[arg(long, value_name = "SHAPE", value_parser = forms::footing)]
    pub footprint: Option<Footing>,
    /// One more body of the robot, such as a trailer: X,Y,HEADING=SHAPE, names of states or outputs that say where it is, and
    /// its area as --footprint has it. No body touches an obstacle. May be said several times.
    #[arg(long = "body", value_name = "X,Y[,HEADING]=SHAPE", value_parser = forms::body)]
    pub bodies: Vec<Bodied>,
    /// A rigid link of two points that only the actions keep: X,Y,X,Y=TOLERANCE, names of states or outputs. Their distance
    /// stays what it is at the start, as exactly as the tolerance says, after each step. May be said several times.
    #[arg(long = "link", value_name = "X,Y,X,Y=TOLERANCE", value_parser = forms::link)]
    pub links: Vec<Linked>,
    /// How finely paths are checked for obstacles; half of it is kept as distance from them.
    #[arg(long, value_name = "LENGTH", default_value_t = 0.01, value_parser = forms::positive)]
    pub resolution: f64,
    /// Which planner.
    #[arg(long, value_enum, default_value_t = Planner::Rrt)]
    pub planner: Planner,
    /// Seed of everything random: the same seed finds the same path.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Time in seconds after which the search ends [default: 60 without --iterations].
    #[arg(long, value_name = "SECONDS", value_parser = forms::positive, allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
    /// Samples after which it ends [default: 1000000; sst: 100000].
    #[arg(long, value_name = "NUMBER")]
    pub iterations: Option<u64>,
    /// Duration of one step of the solver, in seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.05, value_parser = forms::positive)]
    pub step: f64,
    /// How long an action is held, in seconds.
    #[arg(long, value_name = "LOW..HIGH", default_value = "0.1..1", value_parser = forms::range)]
    pub hold: (f64, f64),
    /// Share of samples that aim at the goal, from 0 to 1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.05)]
    pub goal_bias: f64,
    /// Actions that rrt tries from one place before it takes the best.
    #[arg(long, value_name = "NUMBER", default_value_t = 4)]
    pub attempts: u32,
    /// For sst: the radius within which it goes on from the place that is reached soonest [default: by the size of the
    /// space].
    #[arg(long, value_name = "R", value_parser = forms::positive)]
    pub selection: Option<f64>,
    /// For sst: the radius within which it keeps one place [default: by the size of the space].
    #[arg(long, value_name = "R", value_parser = forms::positive)]
    pub pruning: Option<f64>,
    /// Write the path here, - is standard output: a line for each step with time, actions, states, outputs.
    #[arg(short, long, value_name = "PATH.csv")]
    pub output: Option<PathBuf>,
    /// Draw obstacles, search and path.
    #[arg(long, value_name = "PICTURE.svg")]
    pub svg: Option<PathBuf>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
    /// Print the result as JSON.
    #[arg(long)]
    pub json: bool,
}

/// The planners by name.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum Planner {
    /// The first path found.
    Rrt,
    /// Shorter and shorter paths, until a limit.
    Sst,
}
