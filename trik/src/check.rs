//! `trik check`: solutions of tasks are run in virtual time and judged by the rules of their worlds.
//!
//! Owns what a person or a grader sees: messages, table, lines of JSON, exit codes. Which runs there are is in `jobs`, one
//! of them in `run`, many of them in `pool` and `worker`; `row` is what is said of one. What a world does and what its
//! rules mean is in crate `sim`.

mod args;
mod jobs;
pub(crate) mod original;
mod pool;
mod row;
mod run;
mod script;
mod words;
mod worker;

use crate::output::{Output, standard};
use crate::refusal::{Refusal, UNREADABLE, say};
use crate::terminal::named;
pub(crate) use args::CheckArgs;
use jobs::Job;
use lang_text::problem::Locale;
use row::{Row, Verdict, Widths};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// How often progress is shown.
const PROGRESS_EVERY: Duration = Duration::from_millis(200);

/// Judges, or serves as a process that does.
///
/// # Errors
/// There is nothing to judge, or what came out cannot be told.
pub(crate) fn run(args: &CheckArgs) -> Result<u8, Refusal> {
    // What could not be told is no verdict: 1 is for tasks that were not accomplished.
    checked(args).map_err(|refusal| Refusal {
        code: UNREADABLE,
        ..refusal
    })
}

fn checked(args: &CheckArgs) -> Result<u8, Refusal> {
    if args.worker {
        worker::serve(args)?;
        return Ok(0);
    }
    let jobs = jobs::jobs(args).map_err(|why| Refusal {
        code: UNREADABLE,
        ..Refusal::from(why)
    })?;
    let results = args.results.as_deref().map(|path| Output {
        path: Some(path),
        force: args.force,
        source: jobs.first().map_or(Path::new(""), |job| job.judged(args)),
    });
    if let Some(results) = &results {
        results.refuse_present()?;
    }
    refuse_present(&jobs, args)?;
    let left_out = jobs::left_out(args);
    if left_out > 0 {
        say(&[words::left_out(left_out, args.language)]);
    }
    match &jobs[..] {
        [job] => one(job, args, results),
        _ => many(&jobs, args, results),
    }
}

/// Refuses files that are there before anything runs: afterwards a verdict would be lost with them.
fn refuse_present(jobs: &[Job], args: &CheckArgs) -> Result<(), Refusal> {
    let wanted = [
        (&args.report, run::REPORT),
        (&args.trajectory, run::TRAJECTORY),
        (&args.svg, run::SVG),
        (&args.html, run::HTML),
        (&args.display, run::DISPLAY),
    ];
    for (path, ending) in wanted {
        let Some(path) = path else { continue };
        for job in jobs {
            let path = job.place(path, ending, jobs.len() == 1);
            let output = Output {
                path: Some(&path),
                force: args.force,
                source: job.judged(args),
            };
            output.refuse_present()?;
        }
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

/// Many runs, in processes.
fn many(jobs: &[Job], args: &CheckArgs, results: Option<Output<'_>>) -> Result<u8, Refusal> {
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
    let mut report = Report::new(jobs, args, results)?;
    pool::run(jobs, args, |index, row| report.add(index, &row))?;
    report.finish()
}

/// The table of many runs and their lines of JSON, as far as they are written.
struct Report<'a> {
    locale: Locale,
    widths: Widths,
    counts: [usize; 4],
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
            counts: [0; 4],
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
            standard(format!("{line}\n").as_bytes())?;
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
        Ok(self.worst.map_or(UNREADABLE, Verdict::code))
    }
}
