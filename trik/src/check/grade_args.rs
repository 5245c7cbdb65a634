//! The options of the table of a class.
//!
//! Owns these options, which forms a table has, and where points can come from. Knows nothing of what they do.

use crate::limits::WEIGHT_MAX;
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Options of the table of a class.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Options for a class")]
pub(crate) struct GradeArgs {
    /// Write the table of a class, with a row for each pupil, as .csv, .ods or .html; may be given several times. The
    /// directory given is the class, with a folder or a file for each pupil; of several directories each is a pupil.
    #[arg(long = "grades", value_name = "OUT.csv|.ods|.html", value_parser = form)]
    pub out: Vec<PathBuf>,
    /// The tasks of the class: fields NAME.xml, folders NAME with several fields, and saves NAME.qrs that pupils were
    /// given. A solution is for the task that its file or a folder on the way to it is named after. Without --grades
    /// the runs are told and no table is written.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["field", "own", "task", "script", "log", "platform"])]
    pub tasks: Option<PathBuf>,
    /// The names of all pupils, one in a line, as their folders or files are called: a pupil who has handed in nothing has
    /// a row too.
    #[arg(long, value_name = "NAMES.txt", requires = "table")]
    pub pupils: Option<PathBuf>,
    /// What the points of a task, or of one of its fields, are multiplied with for the sum: maze=2 or maze/far=0.5
    /// [default: 1].
    #[arg(long, value_name = "TASK[/FIELD]=NUMBER", value_delimiter = ',', requires = "table", value_parser = weight)]
    pub weights: Vec<(String, f64)>,
    /// The sum with which a pupil has passed.
    #[arg(long, value_name = "NUMBER", requires = "table", value_parser = finite)]
    pub pass_mark: Option<f64>,
    /// Where points come from.
    #[arg(long, value_enum, default_value_t = Source::Auto, requires = "table")]
    pub points: Source,
}

/// Where points come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Source {
    /// Total_score of the rules, or points that their messages tell; a column that has neither counts accomplished tasks.
    #[default]
    Auto,
    /// The variable total_score of the rules.
    TotalScore,
    /// What messages say beside a word for points, as "20 points" or "score: 20", in English and Russian.
    Words,
    /// The last whole number in the messages.
    LastNumber,
    /// 1 for an accomplished task.
    Accomplished,
}

/// Makes the type of all forms with the ending of their files, so that none is missing in a list.
macro_rules! forms {
    ($($(#[$what:meta])* $form:ident: $ending:literal,)+) => {
        /// A form of the table.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Form {
            $($(#[$what])* $form,)+
        }

        impl Form {
            /// By the name of a file.
            pub fn of(path: &Path) -> Option<Self> {
                let ending = path.extension()?.to_str()?.to_ascii_lowercase();
                match ending.as_str() {
                    $($ending => Some(Self::$form),)+
                    _ => None,
                }
            }
        }
    };
}

forms! {
    /// Text with commas.
    Csv: "csv",
    /// A table of spreadsheet programs.
    Ods: "ods",
    /// A page with links to replays.
    Html: "html",
}

fn form(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match Form::of(&path) {
        Some(_) => Ok(path),
        None => Err("its name ends with .csv, .ods or .html".to_owned()),
    }
}

fn finite(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok();
    let number = number.filter(|number| number.is_finite());
    number.ok_or_else(|| "not a number".to_owned())
}

fn weight(text: &str) -> Result<(String, f64), String> {
    let wrong = || "not TASK=NUMBER or TASK/FIELD=NUMBER".to_owned();
    let (name, number) = text.rsplit_once('=').ok_or_else(wrong)?;
    let number = finite(number.trim())?;
    if number.abs() > WEIGHT_MAX {
        return Err(format!("a weight is {WEIGHT_MAX} at most"));
    }
    Ok((name.trim().to_owned(), number))
}

impl GradeArgs {
    /// Where replays go that a page links to, unless `--html` names a directory.
    pub fn replays(&self) -> Option<PathBuf> {
        let page = self
            .out
            .iter()
            .find(|path| Form::of(path) == Some(Form::Html))?;
        let mut name = page.file_stem()?.to_owned();
        name.push("-replays");
        Some(page.with_file_name(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_that_mean_nothing_are_refused() {
        assert_eq!(weight("a=b=2"), Ok(("a=b".into(), 2.0)));
        assert_eq!(weight("maze/far=0.5"), Ok(("maze/far".into(), 0.5)));
        for text in ["maze", "maze=", "maze=NaN", "maze=inf", "maze=1e308", "=x"] {
            assert!(weight(text).is_err(), "{text}");
        }
        assert!(form("a.xlsx").is_err() && form("csv").is_err() && form("A.CSV").is_ok());
    }
}
