//! `trik site`: the studio as files for a web server, empty or with a task that pupils solve in it.
//!
//! Owns which files of the built studio are copied, and what a task adds. The studio itself is
//! `page/app/src/studio`, which `web/site.sh` builds.

mod words;

use crate::diagrams::save::{bytes, must, must_open};
use crate::input;
use crate::language;
use crate::limits;
use crate::output::{Output, standard};
use crate::refusal::Refusal;
use crate::terminal::named;
use clap::Args;
use lang_text::escape::escaped;
use lang_text::problem::{Locale, Words};
use page::studio::{PAGE, WORKER, find, is_one, with_tag};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Component, Path, PathBuf};

/// What `trik site` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct SiteArgs {
    /// Folder to make, for a web server.
    #[arg(value_name = "OUT")]
    pub out: PathBuf,
    /// A project with a world and rules: the page opens it, and all programs are judged in its world.
    #[arg(long, value_name = "FILE.qrs")]
    pub task: Option<PathBuf>,
    /// The built studio, if it is not where trik looks for it: in share/trik/studio of its installation, or in target/web/site
    /// of the sources.
    #[arg(long, value_name = "FOLDER")]
    pub studio: Option<PathBuf>,
    /// Replace the files of a site that is there already. Other files in the folder stay.
    #[arg(long)]
    pub force: bool,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// The task, on every site that has one.
const TASK: &str = "task.qrs";
/// Licences of what is in the page: not kept by browsers, and always there.
const LICENCES: &str = "licences.txt";
/// The engine of programs in Python, which `web/site.sh --python` puts there: browsers do not keep it. The first one says whether
/// a studio has it.
const PYTHON: [&str; 7] = [
    "python/pyodide.mjs",
    "python/pyodide.asm.mjs",
    "python/pyodide.asm.wasm",
    "python/python_stdlib.zip",
    "python/pyodide-lock.json",
    "python/package.json",
    "python/README.md",
];
/// How the list of files begins in the worker; `page/app/offline.js` writes it.
const LIST: &str = "const FILES = ";
/// How the name of what the browser keeps ends.
const CACHE_END: &str = "';\n";

/// Makes a site.
///
/// # Errors
/// There is no built studio; the task cannot be read or has no world; a file is there already or cannot be written.
pub(crate) fn run(args: &SiteArgs) -> Result<u8, Refusal> {
    let refusal = |words: Words| Refusal::new(words.in_locale(args.language));
    let studio = studio(args)?;
    let read = |name: &str| {
        let path = studio.join(name);
        let text = input::read(&path, limits::SITE_FILE_BYTES_MAX);
        text.map_err(|_| refusal(words::broken_studio(&named(&studio), name)))
    };
    let worker = String::from_utf8_lossy(&read(WORKER)?).into_owned();
    let names =
        names(&worker).ok_or_else(|| refusal(words::broken_studio(&named(&studio), WORKER)))?;
    let mut files = Vec::new();
    let has_python = studio.join(PYTHON[0]).is_file();
    let python = if has_python { &PYTHON[..] } else { &[] };
    let others = [LICENCES].into_iter().chain(python.iter().copied());
    for name in names.iter().map(String::as_str).chain(others) {
        files.push((name.to_owned(), read(name)?));
    }
    files.push((WORKER.to_owned(), worker.into_bytes()));
    if let Some(task) = &args.task {
        add_task(&mut files, task, args.language)?;
    }
    write(args, &files)?;
    let told = words::written(&named(&args.out), args.task.is_some());
    standard(told.in_locale(args.language).as_bytes())?;
    Ok(0)
}

/// The folder of the built studio.
fn studio(args: &SiteArgs) -> Result<PathBuf, Refusal> {
    let refusal = |words: Words| Refusal::new(words.in_locale(args.language));
    if let Some(folder) = &args.studio {
        return match is_one(folder) {
            true => Ok(folder.clone()),
            false => Err(refusal(words::no_studio_in(&named(folder)))),
        };
    }
    find().ok_or_else(|| refusal(words::no_studio()))
}

/// The files that the worker of a studio lists, but the folder itself; nothing if it lists none or leads elsewhere.
fn names(worker: &str) -> Option<Vec<String>> {
    let list = worker.lines().find_map(|line| line.strip_prefix(LIST))?;
    let all: Vec<String> = serde_json::from_str(list.trim_end_matches(';')).ok()?;
    let is_inside = |name: &String| {
        let mut parts = Path::new(name).components();
        !name.is_empty() && parts.all(|part| matches!(part, Component::Normal(_)))
    };
    let all: Vec<String> = all.into_iter().filter(|name| name != "./").collect();
    let is_good = !all.is_empty() && all.len() <= limits::SITE_FILES_MAX;
    (is_good && all.iter().all(is_inside)).then_some(all)
}

/// The task as a file, its name in the page, and both in what browsers keep.
fn add_task(
    files: &mut Vec<(String, Vec<u8>)>,
    task: &Path,
    locale: Locale,
) -> Result<(), Refusal> {
    let opened = must_open(task, locale)?;
    if opened.project.world.is_none() {
        let why = words::no_world(&named(task));
        return Err(Refusal::new(why.in_locale(locale)));
    }
    let bytes = bytes(task).map_err(crate::diagrams::save::Unreadable::File);
    let bytes = must(bytes, task, locale)?;
    let mut hasher = DefaultHasher::new();
    let name = task.file_name().unwrap_or_default().to_string_lossy();
    (&bytes, &name).hash(&mut hasher);
    for (file, content) in files.iter_mut() {
        let text = String::from_utf8_lossy(content).into_owned();
        let changed = match file.as_str() {
            PAGE => {
                let tag = format!(
                    "<meta name=\"trik-task\" content=\"{TASK}\" data-name=\"{}\" />",
                    escaped(&name)
                );
                with_tag(&text, &tag)
            }
            WORKER => text
                .replacen(
                    CACHE_END,
                    &format!("-{:016x}{CACHE_END}", hasher.finish()),
                    1,
                )
                .replacen(&format!("{LIST}["), &format!("{LIST}[\"{TASK}\","), 1),
            _ => continue,
        };
        *content = changed.into_bytes();
    }
    files.push((TASK.to_owned(), bytes));
    Ok(())
}

/// All files, once none of them stands in the way.
fn write(args: &SiteArgs, files: &[(String, Vec<u8>)]) -> Result<(), Refusal> {
    let all: Vec<(PathBuf, &[u8])> = files
        .iter()
        .map(|(name, content)| (args.out.join(name), &content[..]))
        .collect();
    let output = |path| Output {
        path: Some(path),
        force: args.force,
        source: args.task.as_deref().unwrap_or(Path::new("")),
        locale: args.language,
    };
    for (path, _) in &all {
        output(path).refuse_present()?;
    }
    for (path, content) in &all {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|error| {
                let why = words::no_folder(&named(folder), error);
                Refusal::new(why.in_locale(args.language))
            })?;
        }
        output(path).write(content)?;
    }
    Ok(())
}
