//! `trik check`: solutions of tasks are run in virtual time and judged by the rules of their worlds.
//!
//! Owns what a person or a grader sees: messages, table, lines of JSON, exit codes. Which runs there are is in `jobs`, one
//! of them in `run` and `staged`, many of them in `pool` and `worker`; `row` is what is said of one. What a world does and what its
//! rules mean is in crate `sim`.

mod args;
mod class;
mod confine;
mod grade_args;
#[cfg(feature = "nats")]
pub(crate) mod grader;
mod grades;
mod jobs;
mod live;
#[cfg(feature = "nats")]
mod lodging;
pub(crate) mod original;
mod page_args;
mod platform;
mod points;
mod pool;
mod recorded;
mod recorded_args;
mod row;
mod run;
mod sandbox_args;
mod script;
mod staged;
mod walk;
mod words;
mod worker;

use crate::debug;
use crate::output::{Output, settled, standard};
use crate::refusal::{Refusal, UNREADABLE, say};
use crate::terminal::named;
pub(crate) use args::{
    CheckArgs, MEMORY_MIB, MODEL_SECONDS, WALL_SECONDS, memory, model_seconds, wall_seconds,
};
use grades::Grades;
use jobs::Job;
use lang_text::problem::Locale;
use live::{Live, Replays};
use platform::Platform;
pub(crate) use platform::of_misuse;
use row::{Row, Widths};
pub(crate) use staged::{NO_BLOCKS, Ready, Staged, Start, staged};
use std::collections::HashSet;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use studio::verdict::{Counts, Verdict};

/// How often progress is shown.
const PROGRESS_EVERY: Duration = Duration::from_millis(200);

/// Judges, or serves as a process that does.
///
/// # Errors
/// There is nothing to judge, or what came out cannot be told.
pub(crate) fn run(args: &CheckArgs) -> Result<u8, Refusal> {
    // What could not be told is no verdict: 1 is for tasks that were not accomplished.
    checked(args).map_err(|refusal| Refusal {
        code: args.platform.map_or(UNREADABLE, Platform::failed),
        ..refusal
    })
}

fn checked(args: &CheckArgs) -> Result<u8, Refusal> {
    if args.worker {
        worker::serve(args)?;
        return Ok(0);
    }
    if args.is_debugging {
        let staged = staged(args).map_err(debug::refusal)?;
        return debug::talk(&staged, None, Start::Running);
    }
    let has_table = !args.grades.out.is_empty() || args.grades.tasks.is_some();
    if has_table || args.marks.is_served {
        return class(args);
    }
    let jobs = jobs::jobs(args)?;
    let results = args.results.as_deref().map(|path| Output {
        path: Some(path),
        force: args.force,
        source: jobs.first().map_or(Path::new(""), |job| job.judged(args)),
        locale: args.language,
    });
    if let Some(results) = &results {
        results.refuse_present()?;
    }
    refuse_present(&jobs, args, jobs.len() == 1)?;
    tell_left_out(args);
    let args = &confine::settle(&jobs, args)?;
    if let Some(platform) = args.platform {
        return answer(&jobs, args, platform);
    }
    match &jobs[..] {
        [job] => one(job, args, results),
        _ => many(&jobs, args, results, None, None),
    }
}

/// What a platform is told of all runs.
fn answer(jobs: &[Job], args: &CheckArgs, platform: Platform) -> Result<u8, Refusal> {
    let mut rows = Vec::new();
    match jobs {
        [job] => rows.push(pool::run_one(job.clone(), args)),
        jobs => {
            make_folders(args)?;
            let take = |_, row| {
                rows.push(row);
                Ok(())
            };
            pool::run(jobs, args, |_, _| {}, take)?;
        }
    }
    let answer = platform.answer(&rows, args.full_points, args.language);
    standard(answer.output.as_bytes())?;
    say(&answer.error);
    Ok(answer.code)
}

/// What is passed by, each with its reason, and how much it is.
fn tell_passed(lines: &[String], count: usize, locale: Locale) {
    if count > 0 {
        let last = words::passed_count(count, lines.len(), locale);
        let lines = lines.iter().chain([&last]);
        let lines: Vec<String> = lines.map(|line| format!("trik: {line}")).collect();
        say(&lines);
    }
}

fn tell_left_out(args: &CheckArgs) {
    let passed = jobs::passed(args);
    let told = passed.told.iter();
    let told = told.map(|(path, reason)| words::passed(&named(path), reason, args.language));
    tell_passed(&told.collect::<Vec<_>>(), passed.count, args.language);
    let left_out = jobs::left_out(args);
    if left_out > 0 {
        say(&[words::left_out(left_out, args.language)]);
    }
}

/// A class, with the tables that are wanted of it.
fn class(args: &CheckArgs) -> Result<u8, Refusal> {
    let mut args = args.clone();
    args.html = args.html.or_else(|| args.grades.replays());
    let replays = Replays::settle(&mut args)?;
    let mut plan = class::plan(&args)?;
    if plan.columns.is_empty() || plan.pupils.is_empty() {
        return Err(Refusal::new(words::nobody(args.language)));
    }
    let jobs = std::mem::take(&mut plan.jobs);
    let outputs: Vec<PathBuf> = args.grades.out.clone();
    let outputs: Vec<Output<'_>> = outputs
        .iter()
        .map(|path| Output {
            path: Some(path),
            force: args.force,
            source: args.grades.pupils.as_deref().unwrap_or(Path::new("")),
            locale: args.language,
        })
        .collect();
    let results = args.results.as_deref().map(|path| Output {
        path: Some(path),
        force: args.force,
        source: Path::new(""),
        locale: args.language,
    });
    refuse_tables(&outputs, &args)?;
    if let Some(results) = &results {
        results.refuse_present()?;
    }
    refuse_present(&jobs, &args, false)?;
    say(&plan.notes);
    tell_passed(&plan.left_out, plan.left_out_count, args.language);
    let args = confine::settle(&jobs, &args)?;
    let grades = Grades::new(plan, &args.grades, args.language);
    let mut live = match args.marks.is_served {
        true => Some(Live::start(&args, grades.clone(), replays)?),
        false => None,
    };
    let grades = (!outputs.is_empty()).then_some((grades, &outputs[..]));
    let code = many(&jobs, &args, results, grades, live.as_mut())?;
    if let Some(live) = live {
        live.stay(&args);
    }
    Ok(code)
}

/// Refuses tables that are there or have no place, before anything runs.
fn refuse_tables(outputs: &[Output<'_>], args: &CheckArgs) -> Result<(), Refusal> {
    for (index, output) in outputs.iter().enumerate() {
        output.refuse_present()?;
        let folder = output.path.and_then(Path::parent);
        let folder = folder.filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            let why = words::no_folder(&named(folder), args.language);
            return Err(Refusal::new(why));
        }
        let others = outputs[..index].iter().filter_map(|other| other.path);
        let others: Vec<&Path> = others.chain(args.results.as_deref()).collect();
        output.spare(&others)?;
    }
    Ok(())
}

/// Refuses files that are there before anything runs: afterwards a verdict would be lost with them.
fn refuse_present(jobs: &[Job], args: &CheckArgs, is_one: bool) -> Result<(), Refusal> {
    let wanted = [
        (&args.report, run::REPORT),
        (&args.trajectory, run::TRAJECTORY),
        (&args.svg, run::SVG),
        (&args.html, run::HTML),
        (&args.display, run::DISPLAY),
    ];
    // Two options may not mean one file: the later would replace the earlier.
    let mut taken = HashSet::new();
    for (path, ending) in wanted {
        let Some(path) = path else { continue };
        // Below one directory names differ by their endings, unless two solutions are called so.
        let folder = settled(path);
        for job in jobs {
            let own = job.place(&folder, ending, is_one);
            let path = job.place(path, ending, is_one);
            let output = Output {
                path: Some(&path),
                force: args.force,
                source: job.judged(args),
                locale: args.language,
            };
            output.refuse_present()?;
            if !taken.insert(own) {
                output.spare(&[&path])?;
            }
        }
    }
    if let Some(results) = args
        .results
        .as_deref()
        .filter(|path| *path != Path::new("-"))
        && taken.contains(&settled(results))
    {
        let output = Output {
            path: Some(results),
            force: args.force,
            source: Path::new(""),
            locale: args.language,
        };
        output.spare(&[results])?;
    }
    Ok(())
}

/// One run: its outputs are files and not directories.
fn one(job: &Job, args: &CheckArgs, results: Option<Output<'_>>) -> Result<u8, Refusal> {
    let row = pool::run_one(job.clone(), args);
    let mut is_told = false;
    if let Some(results) = results {
        let line = row.write() + "\n";
        results.write(line.as_bytes())?;
        is_told = results.is_standard();
    }
    if !is_told {
        let lines = row.lines(args.language).join("\n") + "\n";
        standard(lines.as_bytes())?;
    }
    Ok(row.verdict.code())
}

/// Makes the directories for files of several runs.
fn make_folders(args: &CheckArgs) -> Result<(), Refusal> {
    let outputs = [&args.report, &args.trajectory, &args.svg, &args.html];
    let folders = outputs.into_iter().chain([&args.display]);
    for folder in folders.flatten() {
        std::fs::create_dir_all(folder).map_err(|error| {
            let name = named(folder);
            Refusal::new(format!(
                "{name}: with several runs this is a directory: {error}"
            ))
        })?;
    }
    Ok(())
}

/// Many runs, in processes.
fn many(
    jobs: &[Job],
    args: &CheckArgs,
    results: Option<Output<'_>>,
    mut class: Option<(Grades, &[Output<'_>])>,
    mut live: Option<&mut Live>,
) -> Result<u8, Refusal> {
    make_folders(args)?;
    let mut report = Report::new(jobs, args, results)?;
    let replay = |index: usize| {
        let folder = args.html.as_deref()?;
        let page = jobs[index].place(folder, run::HTML, false);
        Some(page).filter(|page| page.is_file())
    };
    let hear = |index: usize, row: &Row| {
        if let Some(live) = &mut live {
            live.add(index, row, replay(index));
        }
    };
    pool::run(jobs, args, hear, |index, row| {
        if let Some((grades, _)) = &mut class {
            grades.add(index, &row, replay(index));
        }
        report.add(index, &row)
    })?;
    let has_table = report.has_table();
    let code = report.finish()?;
    if let Some((grades, outputs)) = class {
        let lines = grades.finish(outputs)?;
        match has_table {
            true => standard((lines.join("\n") + "\n").as_bytes())?,
            false => say(&lines),
        }
    }
    Ok(code)
}

/// The table of many runs and their lines of JSON, as far as they are written.
struct Report<'a> {
    locale: Locale,
    widths: Widths,
    counts: Counts,
    worst: Option<Verdict>,
    all: usize,
    /// Lines of JSON, written as they come: to a file beside the place of the result, or to standard output.
    results: Option<Results<'a>>,
    shown: Option<Instant>,
    is_terminal: bool,
}

struct Results<'a> {
    output: Output<'a>,
    bytes: Vec<u8>,
}

impl<'a> Report<'a> {
    fn new(jobs: &[Job], args: &CheckArgs, results: Option<Output<'a>>) -> Result<Self, Refusal> {
        let locale = args.language;
        let all: Vec<(String, Option<String>)> = jobs
            .iter()
            .map(|job| (named(job.judged(args)), job.rules(args).map(named)))
            .collect();
        let widths = Widths::new(
            all.iter()
                .map(|(solution, field)| (&**solution, field.as_deref())),
            locale,
        );
        let report = Self {
            locale,
            widths,
            counts: Counts::default(),
            worst: None,
            all: jobs.len(),
            results: results.map(|output| Results {
                output,
                bytes: Vec::new(),
            }),
            shown: None,
            is_terminal: io::stderr().is_terminal(),
        };
        if report.has_table() {
            let heading = report.widths.line(&words::heading(locale));
            standard(format!("{heading}\n").as_bytes())?;
        }
        Ok(report)
    }

    fn has_table(&self) -> bool {
        !self
            .results
            .as_ref()
            .is_some_and(|results| results.output.is_standard())
    }

    fn add(&mut self, index: usize, row: &Row) -> Result<(), Refusal> {
        self.counts[row.verdict as usize] += 1;
        self.worst = self.worst.max(Some(row.verdict));
        let has_table = self.has_table();
        if let Some(results) = &mut self.results {
            let line = row.write() + "\n";
            if results.output.is_standard() {
                standard(line.as_bytes())?;
            } else {
                results.bytes.extend_from_slice(line.as_bytes());
            }
        }
        if has_table {
            let line = self.widths.line(&row.cells(self.locale));
            self.clear();
            let mut lines = format!("{line}\n");
            row.explanation()
                .for_each(|line| lines.push_str(&format!("    {line}\n")));
            standard(lines.as_bytes())?;
        }
        self.progress(index + 1);
        Ok(())
    }

    /// How far it is, on a terminal only.
    fn progress(&mut self, done: usize) {
        let is_due = self
            .shown
            .is_none_or(|shown| shown.elapsed() > PROGRESS_EVERY);
        if self.is_terminal && is_due && done < self.all {
            let text = words::progress(done, self.all, self.locale);
            let _ = write!(io::stderr(), "\r{text}\x1b[K");
            self.shown = Some(Instant::now());
        }
    }

    fn clear(&self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    }

    fn finish(self) -> Result<u8, Refusal> {
        self.clear();
        let has_table = self.has_table();
        if let Some(results) = &self.results
            && has_table
        {
            results.output.write(&results.bytes)?;
        }
        if has_table {
            let summary = words::summary(self.counts, self.locale);
            standard(format!("{summary}\n").as_bytes())?;
        }
        Ok(self.worst.map_or(0, Verdict::code))
    }
}
