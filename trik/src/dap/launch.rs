//! What an editor wants to debug: a diagram in a simulated world, or on a robot.
//!
//! Owns the keys of `launch` and `attach`, and how a program begins, again and again if the editor restarts it.

use super::client::{Client, Refused, Request};
use super::points::Points;
use super::session::{After, Session};
use crate::check::Start;
use crate::debug::WorldArgs;
use crate::debug::listing::Listing;
use crate::debug::stage::Stage;
use crate::debug::target::Target;
use crate::diagrams::save::must_open;
use crate::language;
use crate::remote::debugged::Debugged;
use crate::remote::target::{Target as Place, target as place, the_one};
use lang_diagram::project::Project;
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
        match Self::understood(request) {
            Ok(launch) => Some(launch),
            Err(why) => {
                client.answer(request, Err(why));
                None
            }
        }
    }

    fn understood(request: &Request) -> Result<Self, Refused> {
        let program = request.text("program");
        let why = "\"program\" is needed: the path of a diagram NAME.qrs";
        let program = program.ok_or_else(|| Refused::new(why))?;
        let is_joining = request.command == "attach";
        let robot = match request.text("robot") {
            Some(robot) => Some(place(robot)),
            None => is_joining.then(the_one),
        };
        let robot = robot.transpose().map_err(|why| Refused(why.to_string()))?;
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
                field: path("field"),
                task: path("task"),
                inputs: path("inputs"),
                gamepad: path("gamepad"),
                time_limit: time_limit
                    .filter(|seconds| (0.01..=3600.0).contains(seconds))
                    .unwrap_or(600.0),
                seed: seed.unwrap_or(1),
                speed: speed.filter(|speed| (0.01..=1000.0).contains(speed)),
                language: locale.and_then(Result::ok).unwrap_or_default(),
            },
            stops_on_entry: request.truth("stopOnEntry"),
            stops_at_end: request.truth("stopAtEnd"),
            is_debugged: !request.truth("noDebug"),
            robot,
            is_joining,
        })
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
        let staged = match self.world.stage(self.program.clone()) {
            Ok(staged) => staged,
            Err(lines) => {
                client.answer(request, Err(Refused(lines.join("\n"))));
                return Next::Refused;
            }
        };
        client.answer(request, Ok(Value::Null));
        for line in &staged.strange {
            let body = json!({"category": "important", "output": format!("{line}\n")});
            client.event("output", body);
        }
        let listing = Listing::of(&staged.project, staged.settings.locale);
        let mut stage = Stage::of(&staged, Start::Stopped).at_speed(self.world.speed);
        self.session(client, &mut stage, (&listing, &staged.project), points)
    }

    /// Once on a robot.
    fn on_robot(
        &self,
        robot: &Place,
        request: &Request,
        client: &mut Client,
        points: (&mut Points, bool),
    ) -> Next {
        let opened = match must_open(&self.program, self.world.language) {
            Ok(opened) => opened,
            Err(refusal) => {
                client.answer(request, Err(Refused(refusal.lines.join("\n"))));
                return Next::Refused;
            }
        };
        let begun = match self.is_joining {
            true => Debugged::attach(robot),
            false => Debugged::launch(&self.program, robot),
        };
        let mut target = match begun {
            Ok(target) => target,
            Err(why) => {
                client.answer(request, Err(Refused(why.to_string())));
                return Next::Refused;
            }
        };
        client.answer(request, Ok(Value::Null));
        let listing = Listing::of(&opened.project, self.world.language);
        let next = self.session(client, &mut target, (&listing, &opened.project), points);
        target.close();
        next
    }

    fn session(
        &self,
        client: &mut Client,
        target: &mut dyn Target,
        (listing, project): (&Listing, &Project),
        (points, is_first): (&mut Points, bool),
    ) -> Next {
        let name = self.program.file_name().unwrap_or_default();
        let name = format!("{}.txt", name.to_string_lossy());
        let mut session = Session::new(client, target, (listing, project, name), points, self);
        match session.run(is_first) {
            Ok(After::End) => Next::End,
            Ok(After::Again(again)) => Next::Again(again),
            Err(error) => {
                let text = format!("trik dap: {error}\n");
                client.event("output", json!({"category": "important", "output": text}));
                client.event("terminated", json!({}));
                Next::End
            }
        }
    }
}
