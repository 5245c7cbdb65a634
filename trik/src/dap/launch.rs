//! What an editor wants to debug: a diagram or a data-flow program, in a simulated world or on a robot.
//!
//! Owns the keys of `launch` and `attach`, and how a program begins, again and again if the editor restarts it.

use super::client::{Client, Refused, Request};
use super::keys;
use super::points::Points;
use super::session::{After, Begins, Session};
use crate::check::Start;
use crate::debug::listing::Listing;
use crate::debug::stage::Stage;
use crate::debug::stops::words;
use crate::debug::target::{Changed, Target, Written};
use crate::debug::{WorldArgs, listing};
use crate::diagrams::flow::{self, Program};
use crate::diagrams::save::{self, must};
use crate::error::Error;
use crate::language;
use crate::refusal::Refusal;
use crate::remote::debugged::{Debugged, Runs};
use crate::remote::target::{Target as Place, target as place, the_one};
use lang_text::problem::Locale;
use serde_json::{Value, json};
use std::path::PathBuf;

/// What is to be debugged, and how.
pub(super) struct Launch {
    program: PathBuf,
    world: WorldArgs,
    pub stops_on_entry: bool,
    pub stops_at_end: bool,
    pub is_debugged: bool,
    /// On this robot instead of a simulated one.
    robot: Option<Place>,
    /// It runs there already.
    pub is_joining: bool,
}

/// What goes with no robot, as on a command line.
const OF_WORLDS: [&str; 5] = ["field", "task", "inputs", "gamepad", "speed"];

fn is_there(request: &Request, name: &str) -> bool {
    match request.arguments.get(name) {
        None | Some(Value::Null) => false,
        Some(_) => true,
    }
}

/// What becomes of a session.
enum Next {
    /// The talk is over.
    End,
    /// The program begins anew, and this request is answered then.
    Again(Request),
    /// It could not begin: the editor may try something else.
    Refused,
}

impl Launch {
    /// As the client says; a refusal is told.
    pub fn read(request: &Request, client: &mut Client) -> Option<Self> {
        let known = keys::strangers(request, &keys::OF_BLOCKS);
        match known.and_then(|strangers| Ok((strangers, Self::understood(request)?))) {
            Ok((strangers, launch)) => {
                if let Some(told) = keys::of_strangers(&strangers, &keys::OF_BLOCKS) {
                    important(client, &format!("trik dap: {told}"));
                }
                Some(launch)
            }
            Err(why) => {
                client.answer(request, Err(why));
                None
            }
        }
    }

    fn understood(request: &Request) -> Result<Self, Refused> {
        let program = request.text("program");
        let why = "\"program\" is needed: the path of a diagram NAME.qrs or of a data-flow program NAME.flow";
        let program = program.ok_or_else(|| Refused::new(why))?;
        let is_joining = request.command == "attach";
        let robot = match request.text("robot") {
            Some(robot) => Some(place(robot)),
            None => is_joining.then(the_one),
        };
        let robot = robot.transpose().map_err(|why| Refused(why.to_string()))?;
        if let Some(name) = OF_WORLDS.iter().find(|name| is_there(request, name))
            && robot.is_some()
        {
            return Err(Refused(format!(
                "\"{name}\" is for a simulated world: a robot has its own"
            )));
        }
        let path = |name| request.text(name).map(PathBuf::from);
        let seed = request
            .number("seed")
            .and_then(|seed| u32::try_from(seed).ok());
        let time_limit = request.arguments.get("timeLimit").and_then(Value::as_f64);
        let speed = request.arguments.get("speed").and_then(Value::as_f64);
        let locale = request.text("language").map(language::locale);
        Ok(Self {
            program: program.into(),
            world: WorldArgs {
                diagram: request.text("diagram").map(str::to_owned),
                field: path("field"),
                task: path("task"),
                inputs: path("inputs"),
                gamepad: path("gamepad"),
                time_limit: time_limit.unwrap_or(600.0),
                seed: seed.unwrap_or(1),
                speed,
                language: locale.and_then(Result::ok).unwrap_or_default(),
            },
            stops_on_entry: request.truth("stopOnEntry"),
            stops_at_end: request.truth("stopAtEnd"),
            is_debugged: !request.truth("noDebug"),
            robot,
            is_joining,
        })
    }

    /// The language of messages.
    pub fn locale(&self) -> Locale {
        self.world.language
    }

    /// Debugs until the talk is over, or false: it could not begin.
    pub fn serve(&self, mut request: Request, client: &mut Client) -> bool {
        let mut points = Points::default();
        let mut is_first = true;
        loop {
            let next = match &self.robot {
                Some(robot) => self.on_robot(robot, &request, client, (&mut points, is_first)),
                None => self.here(&request, client, (&mut points, is_first)),
            };
            match next {
                Next::End => return true,
                Next::Again(again) => request = again,
                Next::Refused => {
                    if !is_first {
                        client.event("terminated", json!({}));
                    }
                    return false;
                }
            }
            is_first = false;
        }
    }

    /// Once in a simulated world.
    fn here(&self, request: &Request, client: &mut Client, points: (&mut Points, bool)) -> Next {
        let seen = save::bytes(&self.program).ok();
        let staged = match self.world.stage(self.program.clone()) {
            Ok(staged) => staged,
            Err(lines) => {
                client.answer(request, Err(Refused(lines.join("\n"))));
                return Next::Refused;
            }
        };
        client.answer(request, Ok(Value::Null));
        for line in &staged.strange {
            important(client, line);
        }
        let mut stage = Stage::of(&staged, Start::Stopped).at_speed(self.world.speed);
        let sheets = Sheets {
            listing: listing(&staged),
            seen,
        };
        self.talk(client, &mut stage, sheets, points)
    }

    /// Once on a robot.
    fn on_robot(
        &self,
        robot: &Place,
        request: &Request,
        client: &mut Client,
        points: (&mut Points, bool),
    ) -> Next {
        let seen = save::bytes(&self.program).ok();
        let opened = match self.opened() {
            Ok(opened) => opened,
            Err(refusal) => {
                client.answer(request, Err(Refused(refusal.lines.join("\n"))));
                return Next::Refused;
            }
        };
        let begun = match self.is_joining {
            true => Debugged::attach(robot, Runs::Blocks, self.locale()),
            false => Debugged::launch(&self.program, self.diagram(), robot, self.locale()),
        };
        let mut target = match begun {
            Ok(target) => target,
            Err(why) => {
                client.answer(request, Err(Refused(why.to_string())));
                return Next::Refused;
            }
        };
        client.answer(request, Ok(Value::Null));
        let sheets = Sheets::of(&opened, self.world.language, seen);
        let next = self.talk(client, &mut target, sheets, points);
        target.close();
        next
    }

    /// The main diagram that is debugged, if it is not the first one.
    fn diagram(&self) -> Option<&str> {
        self.world.diagram.as_deref()
    }

    /// The file as it is now.
    fn opened(&self) -> Result<Program, Refusal> {
        must(
            flow::open(&self.program, self.diagram()),
            &self.program,
            self.world.language,
        )
    }

    /// A talk about one run, whose program may become another version on the way.
    fn talk(
        &self,
        client: &mut Client,
        target: &mut dyn Target,
        mut sheets: Sheets,
        (points, is_first): (&mut Points, bool),
    ) -> Next {
        let mut begins = match is_first {
            true => Begins::First,
            false => Begins::Anew,
        };
        let mut is_over = false;
        loop {
            let talked = self.session(client, target, &sheets, (points, begins, is_over));
            let (request, was_over) = match talked {
                Ok(After::Again(request, is_over)) => (request, is_over),
                Ok(After::End) => return Next::End,
                Err(error) => {
                    important(client, &format!("trik dap: {error}"));
                    client.event("terminated", json!({}));
                    return Next::End;
                }
            };
            is_over = was_over;
            let (answer, next) = match self.restart(client, target, &mut sheets) {
                Restart::Anew => return Next::Again(request),
                Restart::Changed => (Ok(Value::Null), Begins::Changed),
                Restart::Refused(why) => (Err(Refused(why)), Begins::Same),
            };
            client.answer(&request, answer);
            begins = next;
        }
    }

    /// Replaces what runs by the file as it is now, if it has changed.
    fn restart(
        &self,
        client: &mut Client,
        target: &mut dyn Target,
        sheets: &mut Sheets,
    ) -> Restart {
        let now = save::bytes(&self.program).ok();
        // What an editor has joined may be another version than the file, and is not for it to begin.
        if now == sheets.seen && !self.is_joining {
            return Restart::Anew;
        }
        let opened = match self.opened() {
            Ok(opened) => opened,
            Err(refusal) => return Restart::Refused(refusal.lines.join("\n")),
        };
        match target.change(&self.program, self.diagram(), Written::of(&opened)) {
            Ok(Changed::InForce(what)) => {
                important(client, words::changed(&what).in_locale(self.locale()));
                *sheets = Sheets::of(&opened, self.world.language, now);
                Restart::Changed
            }
            Ok(Changed::Wrong(why)) => {
                let why = words::goes_on_as_it_was(&why);
                Restart::Refused(why.in_locale(self.locale()).to_owned())
            }
            Ok(Changed::CannotBe(why)) if self.is_joining => Restart::Refused(why),
            Ok(Changed::CannotBe(why)) => {
                important(client, words::begins_anew(&why).in_locale(self.locale()));
                Restart::Anew
            }
            Err(error) => Restart::Refused(error.to_string()),
        }
    }

    fn session(
        &self,
        client: &mut Client,
        target: &mut dyn Target,
        sheets: &Sheets,
        (points, begins, is_over): (&mut Points, Begins, bool),
    ) -> Result<After, Error> {
        let name = self.program.file_name().unwrap_or_default();
        let name = format!("{}.txt", name.to_string_lossy());
        let shown = (&sheets.listing, name);
        Session::new(client, target, shown, (points, is_over), self).run(begins)
    }
}

/// What a restart has come to.
enum Restart {
    /// Another version runs.
    Changed,
    /// Nothing has changed, and why.
    Refused(String),
    /// The program has to begin anew.
    Anew,
}

/// The program that runs.
struct Sheets {
    listing: Listing,
    /// Its file when it was read, to see whether it has changed.
    seen: Option<Vec<u8>>,
}

impl Sheets {
    fn of(program: &Program, locale: Locale, seen: Option<Vec<u8>>) -> Self {
        Self {
            listing: Listing::of_program(program, locale),
            seen,
        }
    }
}

fn important(client: &mut Client, line: &str) {
    let body = json!({"category": "important", "output": format!("{line}\n")});
    client.event("output", body);
}
