//! `trik grade-worker`: judges submissions until somebody ends it.
//!
//! Owns its end: the first Ctrl-C lets what is judged come to its end, a second one does not wait. What a submission is judged by is
//! known to `check::grader`.

use super::args::WorkerArgs;
use super::way::with;
use crate::check::grader::{Wanted, graders};
use crate::output::standard;
use crate::refusal::{Refusal, say};
use crate::terminal::harmless;
use grading::{Ends, Judge, News, Submission, worker};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::available_parallelism;

/// Serves until a signal comes.
///
/// # Errors
/// There are no tasks, or the server is not reached.
pub fn serve(args: &WorkerArgs) -> Result<u8, Refusal> {
    let cores = available_parallelism().map_or(1, |count| count.get() as u16);
    let count = args.jobs.unwrap_or(cores);
    let wanted = Wanted {
        tasks: &args.tasks,
        explain: args.explain,
        time_limit: args.time_limit,
        wall_limit: args.wall_limit,
        memory: args.memory,
        require_sandbox: args.require_sandbox,
        language: args.language,
    };
    let (graders, tasks) = graders(&wanted, count)?;
    let judges = graders.into_iter();
    let judges = judges.map(|one| Box::new(one) as Box<dyn Judge>).collect();
    let name = args.name.clone().unwrap_or_else(host);
    with(&args.server, "grade-worker", async |queue| {
        let mut ends = Ends::new()?;
        let tasks = tasks.join(", ");
        standard(format!("{name} judges {count} at once: {tasks}; Ctrl-C ends it\n").as_bytes())?;
        let judged = Arc::new(AtomicU32::new(0));
        let count = judged.clone();
        let tell = move |news| {
            if let News::Judged(one) = &news {
                count.fetch_add(1, Ordering::Relaxed);
                // Results are told, also when nobody reads this.
                let _ = standard(format!("{}: judged\n", what(one)).as_bytes());
            }
            say(&line(&news));
        };
        worker::serve(queue, judges, &name, tell, &mut ends).await?;
        let judged = judged.load(Ordering::Relaxed);
        standard(format!("{judged} judged\n").as_bytes())?;
        Ok(0)
    })
}

/// The name of this computer.
fn host() -> String {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    match name.trim() {
        "" => "worker".to_owned(),
        name => name.to_owned(),
    }
}

/// What a submission is, for a person.
fn what(one: &Submission) -> String {
    format!("{}, {}", harmless(one.task()), harmless(one.file()))
}

/// What is told of a submission beside what is judged.
fn line(news: &News) -> Vec<String> {
    let line = match news {
        News::Judged(_) => return Vec::new(),
        News::Again(id) => format!("{id}: judged before"),
        News::Failed(one, why) => {
            format!("{}: tried again, because {}", what(one), harmless(why))
        }
        News::Dead(id, one, why) => {
            let one = one.as_ref().map_or("no submission".to_owned(), what);
            format!("{one}: put aside as {id}: {}", harmless(why))
        }
        News::Ends => {
            "what is judged now is judged to its end; Ctrl-C again does not wait".to_owned()
        }
        News::Server(why) => harmless(&why.to_string()),
    };
    vec![format!("trik: {line}")]
}
