//! `trik new-task`: a task that works, to be changed: a world with rules, a text for pupils, a solution and a wrong one.
//!
//! Owns the names of the files and the marks in them that are filled. The files are in the folder `task` beside this one.

mod words;

use crate::language;
use crate::output::{Output, standard};
use crate::refusal::Refusal;
use crate::terminal::named;
use clap::{Args, ValueEnum};
use lang_text::problem::Locale;
use std::fs;
use std::path::{Path, PathBuf};

/// What `trik new-task` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct NewTaskArgs {
    /// Folder to make: letters, digits, '-', '_' and '.', perhaps in another folder.
    #[arg(value_name = "NAME")]
    pub name: PathBuf,
    /// Language of both programs.
    #[arg(long, value_enum, value_name = "LANGUAGE", default_value_t = Language::Js)]
    pub lang: Language,
    /// Language of all texts, those of the rules too: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
    /// Replace files of a task that is there already. Other files in the folder stay.
    #[arg(long)]
    pub force: bool,
}

/// Languages of programs in which solutions are made.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum Language {
    /// JavaScript.
    #[value(name = "javascript", alias = "js")]
    Js,
    /// Python 3.
    #[value(alias = "py")]
    Python,
}

impl Language {
    fn ending(self) -> &'static str {
        match self {
            Self::Js => "js",
            Self::Python => "py",
        }
    }

    /// The solution, and the program that is none.
    fn programs(self) -> [&'static str; 2] {
        match self {
            Self::Js => [
                include_str!("task/solution.js"),
                include_str!("task/wrong.js"),
            ],
            Self::Python => [
                include_str!("task/solution.py"),
                include_str!("task/wrong.py"),
            ],
        }
    }
}

/// Makes a task.
///
/// # Errors
/// The name is none for a folder, a file of the task is there already, or it cannot be written; nothing is replaced then.
pub(crate) fn run(args: &NewTaskArgs) -> Result<u8, Refusal> {
    let name = name(&args.name, args.language)?;
    let ending = args.lang.ending();
    let mut all = Vec::new();
    for (file, text) in files(args.lang, args.language) {
        all.push((
            args.name.join(file),
            filled(text, title(&args.name), ending, args.language),
        ));
    }
    let output = |path| Output {
        path: Some(path),
        force: args.force,
        source: Path::new(""),
        locale: args.language,
    };
    // What is replaced is in this folder, wherever a link leads.
    for path in all.iter().map(|(path, _)| path).chain([&args.name]) {
        if path.is_symlink() {
            let why = words::is_link(&named(path));
            return Err(Refusal::new(why.in_locale(args.language)));
        }
    }
    for (path, _) in &all {
        output(path).refuse_present()?;
    }
    fs::create_dir_all(&args.name).map_err(|error| {
        let why = words::no_folder(&name, error);
        Refusal::new(why.in_locale(args.language))
    })?;
    for (path, text) in &all {
        output(path).write(text.as_bytes())?;
    }
    standard(words::written(&name, ending, args.language).as_bytes())?;
    Ok(0)
}

/// The name as commands can have it without quotes.
fn name(path: &Path, locale: Locale) -> Result<String, Refusal> {
    let text = path.to_str().unwrap_or_default();
    let is_plain = |c: char| c.is_alphanumeric() || "-_./".contains(c);
    // What begins with '-' would be an option of the commands that are printed.
    if text.is_empty()
        || text.starts_with('-')
        || !text.chars().all(is_plain)
        || path.file_name().is_none()
    {
        let why = words::no_name(&named(path));
        return Err(Refusal::new(why.in_locale(locale)));
    }
    Ok(text.trim_end_matches('/').to_owned())
}

/// What the text for pupils is headed with.
fn title(path: &Path) -> &str {
    let last = path.file_name().and_then(|name| name.to_str());
    last.unwrap_or_default()
}

/// Names and contents, with marks.
fn files(lang: Language, locale: Locale) -> [(String, &'static str); 4] {
    let readme = match locale {
        Locale::English => include_str!("task/README.en.md"),
        Locale::Russian => include_str!("task/README.ru.md"),
    };
    let [solution, wrong] = lang.programs();
    let ending = lang.ending();
    [
        ("world.xml".to_owned(), include_str!("task/world.xml")),
        ("README.md".to_owned(), readme),
        (format!("solution.{ending}"), solution),
        (format!("wrong.{ending}"), wrong),
    ]
}

/// A text with its marks filled.
fn filled(text: &str, title: &str, ending: &str, locale: Locale) -> String {
    let own = [("NAME", title), ("ENDING", ending)];
    let all = own.into_iter().chain(words::texts(locale));
    all.fold(text.to_owned(), |text, (mark, value)| {
        text.replace(&format!("{{{mark}}}"), value)
    })
}
