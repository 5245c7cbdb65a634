//! The options of `trik dcml sim`.
//!
//! Owns the options. Knows nothing of what they do.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The options of `trik dcml sim`.
#[derive(Args, Clone, Debug)]
pub(crate) struct SimArgs {
    /// A file with a model, - for standard input, or the name of a shipped model.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// A value for each parameter: L=0.4,r=0.05.
    #[arg(
        long,
        value_name = "NAME=NUMBER,...",
        default_value = "",
        hide_default_value = true
    )]
    pub params: String,
    /// The initial state; what is not named starts at 0.
    #[arg(
        long,
        value_name = "NAME=NUMBER,...",
        default_value = "",
        hide_default_value = true,
        allow_hyphen_values = true
    )]
    pub start: String,
    /// Formulas of the time t for all actions, 'u_l = 2 + sin(t); u_r = 3', or a table: its first line has the names
    /// t,u_l,u_r, each other line a time in s and the actions from then on.
    #[arg(long, value_name = "FORMULAS|FILE.csv")]
    pub actions: String,
    /// Duration in seconds.
    #[arg(long = "t", value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: f64,
    /// The solver.
    #[arg(long, value_enum, default_value = "rk45")]
    pub solver: Solver,
    /// Step size in s, by default a thousandth of the duration; for rk45 the largest step.
    #[arg(long, value_name = "SECONDS")]
    pub step: Option<f64>,
    /// For rk45: the error allowed in a step, relative to each state.
    #[arg(long, value_name = "PART", default_value_t = 1e-6)]
    pub rtol: f64,
    /// For rk45: the error allowed in a step, in the unit of the state.
    #[arg(long, value_name = "NUMBER", default_value_t = 1e-9)]
    pub atol: f64,
    /// Seconds between lines of the table, by default a two-hundredth of the duration.
    #[arg(long, value_name = "SECONDS")]
    pub every: Option<f64>,
    /// A new file for the table; - is standard output, as without this option.
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: Option<PathBuf>,
    /// Draw the path and everything over time into a new file, instead of the table, or with -o beside it; - is standard
    /// output.
    #[arg(long, value_name = "OUT.svg")]
    pub svg: Option<PathBuf>,
    /// What -o writes: the older spelling of --svg.
    #[arg(long, value_enum, hide = true, conflicts_with = "svg")]
    pub out: Option<Form>,
    /// Overwrite existing files.
    #[arg(long)]
    pub force: bool,
}

/// How a model is solved.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Solver {
    /// Dormand-Prince, order 5, with steps as the errors allow.
    Rk45,
    /// Runge-Kutta, order 4.
    Rk4,
    /// Order 2.
    Heun,
    /// Order 1.
    Euler,
}

/// What `-o` writes.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Form {
    /// A table.
    Csv,
    /// A picture.
    Svg,
}
