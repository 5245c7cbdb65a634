//! A run of a project that is drawn while it goes: some ticks in each call.
//!
//! Owns the debugger and new versions of the program. What is seen is known in `course`; orders to a debugger are those of
//! `trik debug`.

use crate::course::Course;
use crate::failure::Failure;
use crate::judged::{self, Machine, Staged, Wish, stage, world};
use crate::project::{Answer, Project};
use crate::{limits, words};
use lang_dataflow::machine::patch as flow;
use lang_diagram::machine::patch as diagram;
use lang_text::problem::Locale;
use serde_json::Value;
use sim::judge::debugged::{self, Refused, Version};
use sim::judge::{Clock, Settings};
use std::time::Duration;
use studio::program::Program;

/// A run between its beginning and its verdict, and after it.
pub struct Run {
    project: Project,
    machine: Machine,
    course: Course,
}

impl Run {
    /// Before the first tick. Options are those of [`Wish::read`]; the caller bounds real time.
    pub fn begin(project: &Project, options: &str) -> Answer<Self> {
        let mut locale = Locale::default();
        let begun = Wish::read(options, Clock::default(), &mut locale).and_then(|mut wish| {
            // Somebody looks at it, and may let it stand for an hour.
            wish.settings.longest = Duration::MAX;
            wish.settings.is_showing = true;
            let staged =
                stage(project, &wish).map_err(|refused: Box<judged::Refused>| refused.failure)?;
            Ok(Self::of(project.clone(), staged, wish.settings))
        });
        (begun, locale)
    }

    fn of(project: Project, staged: Staged, settings: Settings) -> Self {
        let mut machine = staged.program;
        let course = Course::new(&staged.task, staged.strange, machine.program(), settings);
        Self {
            project,
            machine,
            course,
        }
    }

    /// What there is to see of it.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// What it is doing.
    pub fn progress(&self) -> &'static str {
        self.course.progress()
    }

    /// Makes at most so many ticks of 10 ms, and not more than [`limits::TICKS_MAX`]; one that a debugger holds makes none,
    /// and goes on with a search through its past. What it is doing then.
    pub fn tick(&mut self, count: u32) -> &'static str {
        for _ in 0..count.min(limits::TICKS_MAX) {
            if self.progress() != "runs" {
                break;
            }
            self.course.tick(self.machine.program());
        }
        if let Machine::Debugged(program) = &mut self.machine {
            let mut pieces = 0..limits::SEARCHES_MAX;
            while program.search_on() && pieces.next().is_some() {}
        }
        self.course.settle(self.machine.program());
        self.progress()
    }

    /// Ends it as it is: the program is stopped. What is not decided then stays so.
    pub fn end(&mut self) {
        self.course.end(self.machine.program());
    }

    /// What came out, as [`crate::judged::judge`] tells it; nothing before the end.
    pub fn outcome(&self) -> Option<Value> {
        let project = &self.project;
        self.course.outcome(&project.name, project.findings())
    }

    /// What moves in the world, and what the program does, as JSON.
    pub fn state(&self) -> String {
        self.course.state(self.machine.seen())
    }

    /// What rules and program have said and printed since the last time.
    pub fn news(&mut self) -> Value {
        self.course.news()
    }

    /// Gives its debugger an order, a line as `trik debug` sends it: `attach`, `pause`, `break ID`, `step in`. The answer is
    /// that of the desk of its language, as JSON.
    ///
    /// # Errors
    /// It has no debugger, or the order is longer than [`limits::ORDER_BYTES_MAX`].
    pub fn order(&mut self, text: &str) -> Result<String, Failure> {
        if text.len() > limits::ORDER_BYTES_MAX {
            let most = limits::ORDER_BYTES_MAX;
            let words = words::too_long("an order", text.len(), most);
            return Err(Failure::Request(words));
        }
        let Machine::Debugged(program) = &mut self.machine else {
            return Err(Failure::Request(words::no_debugger()));
        };
        let answer = match self.course.trial() {
            Some(trial) => debugged::order(trial, program, 0, text),
            None => debugged::order_after(program, 0, text),
        };
        self.course.settle(self.machine.program());
        Ok(answer)
    }

    /// Puts a new version of its program into the run, between two ticks: what stays keeps its state. What has changed, in words.
    ///
    /// # Errors
    /// It has no debugger or is over, the version has mistakes, or a thread is where the version has nothing. Nothing has
    /// changed then.
    pub fn patch(&mut self, project: &Project) -> Result<String, Failure> {
        let Machine::Debugged(program) = &mut self.machine else {
            return Err(Failure::Request(words::no_debugger()));
        };
        let world = world(self.course.settings());
        let Some(trial) = self.course.trial() else {
            return Err(Failure::Request(words::run_is_over()));
        };
        let version = match &project.program {
            Program::Diagram(opened) => {
                let version = diagram::Version::of(&opened.project, world);
                Version::Diagram(version.map_err(|why| refused(&Refused::Diagram(why)))?)
            }
            Program::Flow(flow, _) | Program::Text(flow) => {
                Version::Flow(flow.ready().map_err(Failure::Program)?.into())
            }
        };
        let patched = debugged::patch(trial, program, &version);
        let patched = patched.map_err(|why| refused(&why))?;
        self.project = project.clone();
        self.course.settle(self.machine.program());
        Ok(patched)
    }

    /// What its debugger tells by itself since the last time: JSON, a list.
    pub fn reports(&mut self) -> String {
        match &mut self.machine {
            Machine::Debugged(program) => format!("[{}]", program.news().join(",")),
            Machine::Diagram(_) | Machine::Flow(_) => "[]".to_owned(),
        }
    }

    /// The language of its messages.
    pub fn locale(&self) -> Locale {
        self.course.locale()
    }

    /// What is run.
    pub fn project(&self) -> &Project {
        &self.project
    }
}

/// Why a version is not taken.
fn refused(why: &Refused) -> Failure {
    let problems = match why {
        Refused::Diagram(why) => why.problems(),
        Refused::Flow(flow::Refused::Ended) => &[],
        Refused::Flow(flow::Refused::Mistakes(problems)) => problems,
        Refused::OtherLanguage => return Failure::Request(words::other_language()),
    };
    match problems {
        [] => Failure::Request(words::run_is_over()),
        problems => Failure::Program(problems.to_vec()),
    }
}
