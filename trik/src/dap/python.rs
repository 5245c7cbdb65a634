//! Programs in Python: the adapter of debugpy here, the program under debugpy on the robot, and the editor between them.
//!
//! Owns what is added to their talk: where the program runs, that its motors rest while it is stopped, and that it ends with
//! the talk. All else passes as it is. `adapter` is the process of debugpy, `again` a restart.

mod adapter;
mod again;

use super::client::{Client, Incoming, Refused, Request};
use super::greeting::capabilities;
use super::keys;
use crate::debug::target::{Channel, Event, Target};
use crate::error::Error;
use crate::language;
use crate::remote::debugged::Debugged;
use crate::remote::target::{target as place, the_one};
use adapter::{Adapter, AdapterSays};
use again::{Again, Memory};
use lang_text::problem::Locale;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trikd::protocol::news::{self, End};

/// How long it waits for one of the three who speak before it hears the others.
const TURN: Duration = Duration::from_millis(2);
/// Our own requests have numbers from here on; no editor counts so far.
const OWN: u64 = 1 << 40;
/// How long the program may take for what it is asked to do before something else.
const ASIDE: Duration = Duration::from_secs(2);
/// How long the robot may take to tell of an end that debugpy has noticed.
const AFTER_END: Duration = Duration::from_secs(2);
/// When motors that do not rest at a stop are asked again to do so.
const HOLD_AGAIN: Duration = Duration::from_millis(200);

/// Whether a request is about a program in Python.
pub(super) fn is_meant(request: &Request) -> bool {
    let program = request.text("program").map(Path::new);
    let ending = program.and_then(Path::extension);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("py"))
}

/// Debugs until the talk is over, or false: it could not begin, which is told.
pub(super) fn serve(request: &Request, hello: &Value, client: &mut Client) -> bool {
    match begin(request) {
        Ok((adapter, robot, folder)) => {
            Session::new(client, (adapter, robot), request.clone(), hello).run(&folder)
        }
        Err(why) => {
            client.answer(request, Err(why));
            false
        }
    }
}

/// What `launch` knows for programs of blocks, and a robot in real time does not.
const NOT_HERE: [&str; 8] = [
    "field",
    "task",
    "inputs",
    "gamepad",
    "seed",
    "speed",
    "timeLimit",
    "stopAtEnd",
];

/// Whether all that is asked for goes with a program that runs in real time.
///
/// # Errors
/// What does not.
pub(super) fn is_for_robot(request: &Request, language: &str) -> Result<(), Refused> {
    let is_there = |name: &&&str| match request.arguments.get(**name) {
        None | Some(Value::Null | Value::Bool(false)) => false,
        Some(_) => true,
    };
    match NOT_HERE.iter().find(is_there) {
        None => Ok(()),
        Some(name) => Err(Refused::new(format!(
            "\"{name}\" is not for programs in {language}: they run on a robot, such as that of trik up, which has its own world and time"
        ))),
    }
}

fn begin(request: &Request) -> Result<(Adapter, Debugged, String), Refused> {
    if request.command == "attach" {
        return Err(Refused::new(
            "a program in Python that runs already cannot be joined: debugpy has to be in it from its beginning; launch it, which ends the one that runs",
        ));
    }
    is_for_robot(request, "Python")?;
    // All others may be debugpy's.
    keys::strangers(request, &keys::OF_PYTHON)?;
    let program = PathBuf::from(request.text("program").unwrap_or_default());
    let robot = match request.text("robot") {
        Some(robot) => place(robot),
        None => the_one(),
    };
    let why = |error: Error| Refused(error.to_string());
    let robot = robot.map_err(why)?;
    let adapter = Adapter::start(request.text("python").unwrap_or("python3"))?;
    let (debugged, folder) = Debugged::python(&program, &robot, locale(request)).map_err(why)?;
    Ok((adapter, debugged, folder))
}

/// The language of who debugs.
pub(super) fn locale(request: &Request) -> Locale {
    let named = request.text("language").map(language::locale);
    named.and_then(Result::ok).unwrap_or_default()
}

/// What one of our own requests to debugpy is for.
#[derive(Clone, Debug, PartialEq)]
enum Asked {
    /// Its capabilities.
    Hello,
    /// The beginning of the talk.
    Attach,
    /// That motors rest, which it says they do.
    Hold,
    /// That they go on; nothing waits for that.
    GoOn,
    /// Something that the program does before this is passed on.
    First(Request, Instant),
    /// Breakpoints of before a restart, those of the request with this number in the memory.
    Points(usize),
    /// The end of them.
    Configured,
}

/// A program that is debugged.
struct Session<'a> {
    client: &'a mut Client,
    adapter: Adapter,
    robot: Debugged,
    launch: Request,
    /// What the editor has said of itself.
    hello: Value,
    /// What is kept for a restart, and one that is under way.
    memory: Memory,
    again: Option<Again>,
    /// Our requests that are not answered, by their numbers.
    asked: Vec<(u64, Asked)>,
    next: u64,
    /// The editor knows that the program is there.
    is_begun: bool,
    /// The motors rest for a stop, or are asked to.
    is_held: bool,
    /// What goes on is one thread, by a step that the editor wants so.
    goes_alone: bool,
    /// The request for which motors go on already, while debugpy has not answered it.
    going: Option<u64>,
    /// How often they were.
    stops: u64,
    /// Since when some of them are known not to.
    turning: Option<Instant>,
    /// What the program has said went wrong before it could begin.
    errors: Vec<String>,
    /// It has ended.
    is_over: bool,
    /// When debugpy has lost it.
    lost: Option<Instant>,
    /// The editor knows the end.
    is_told: bool,
}

impl<'a> Session<'a> {
    fn new(
        client: &'a mut Client,
        (adapter, robot): (Adapter, Debugged),
        launch: Request,
        hello: &Value,
    ) -> Self {
        Self {
            client,
            adapter,
            robot,
            launch,
            hello: hello.clone(),
            memory: Memory::default(),
            again: None,
            asked: Vec::new(),
            next: OWN,
            is_begun: false,
            is_held: false,
            goes_alone: false,
            going: None,
            stops: 0,
            turning: None,
            errors: Vec::new(),
            is_over: false,
            lost: None,
            is_told: false,
        }
    }

    /// Until the talk is over; false if it could not begin.
    fn run(&mut self, folder: &str) -> bool {
        self.ask("initialize", self.hello.clone(), Asked::Hello);
        let attach = self.attachment(folder);
        self.ask("attach", attach, Asked::Attach);
        let is_good = loop {
            match self.turn() {
                Ok(None) => {}
                Ok(Some(is_good)) => break is_good,
                Err(error) => {
                    self.say("important", &format!("trik dap: {error}"));
                    self.tell_end(1);
                    break true;
                }
            }
        };
        self.robot.close();
        is_good
    }

    /// What debugpy is told of the program.
    fn attachment(&self, folder: &str) -> Value {
        let given = self.launch.arguments.as_object();
        let mut all = Value::Object(given.cloned().unwrap_or_default());
        let program = self.launch.text("program").unwrap_or_default();
        let program = std::path::absolute(program).unwrap_or_else(|_| program.into());
        let own = program.parent().unwrap_or(&program).to_string_lossy();
        for (name, value) in [
            ("type", json!("debugpy")),
            ("request", json!("attach")),
            ("listen", json!({"host": "127.0.0.1", "port": 0})),
            (
                "pathMappings",
                json!([{"localRoot": own, "remoteRoot": folder}]),
            ),
            // The module of the robot is no code of the person.
            ("rules", json!([{"path": "**/trik.py", "include": false}])),
            // It comes from the robot already.
            ("redirectOutput", json!(false)),
            ("subProcess", json!(false)),
        ] {
            all[name] = value;
        }
        if let Some(all) = all.as_object_mut() {
            for name in ["program", "python", "robot", "noDebug"] {
                all.remove(name);
            }
        }
        all
    }

    fn ask(&mut self, command: &str, arguments: Value, what: Asked) {
        let seq = self.next;
        self.next += 1;
        self.asked.push((seq, what));
        self.adapter.send(
            &json!({"seq": seq, "type": "request", "command": command, "arguments": arguments}),
        );
    }

    /// Hears each of the three once; whether the talk is over, and was good.
    fn turn(&mut self) -> Result<Option<bool>, Error> {
        let mut wait = Duration::ZERO;
        match self.adapter.next(TURN) {
            AdapterSays::Message(message) => {
                if let Some(is_good) = self.hear(message) {
                    return Ok(Some(is_good));
                }
            }
            AdapterSays::Nothing => {}
            // It says so at once, again and again.
            AdapterSays::End if self.is_told => wait = TURN,
            AdapterSays::End => {
                self.say("important", "trik dap: debugpy has ended");
                self.robot.end();
                self.tell_end_because(1, "debugpy has ended");
            }
        }
        for event in self.robot.turn(Duration::ZERO)? {
            self.hear_robot(event);
        }
        if self.is_over && !self.is_begun {
            let why = std::mem::take(&mut self.errors).join("\n");
            if self.again.is_none() {
                self.client.answer(&self.launch, Err(Refused(why)));
                return Ok(Some(false));
            }
            self.is_begun = true;
            self.tell_end_because(1, &why);
        }
        self.hold_again();
        self.end_late();
        match self.client.next(wait) {
            Incoming::Request(request) => Ok(self.receive(request)),
            Incoming::Nothing => Ok(None),
            Incoming::End => Ok(Some(true)),
        }
    }

    /// What debugpy says; whether the talk is over.
    fn hear(&mut self, mut message: Value) -> Option<bool> {
        let number = message.get("request_seq").and_then(Value::as_u64);
        if let Some(at) = self.asked.iter().position(|(seq, _)| Some(*seq) == number) {
            let (_, asked) = self.asked.remove(at);
            return self.answered(asked, &message);
        }
        self.memory.hear(&mut message);
        let resumes = message["command"].as_str().is_some_and(is_resuming);
        if resumes && message["success"] == true && !self.goes_alone {
            self.memory.goes_on();
        }
        if number.is_some() && number == self.going {
            self.going = None;
            // The program stands where it was.
            if message["success"] != true && self.lost.is_none() {
                self.hold();
            }
        }
        match message["event"].as_str() {
            Some("debugpyWaitingForServer") => {
                let port = message["body"]["port"].as_u64();
                if let Some(port) = port.and_then(|port| u16::try_from(port).ok()) {
                    match self.adapter.connect(port) {
                        Ok(debugger) => self.robot.lead_to(debugger),
                        Err(why) => self.say("important", &format!("trik dap: debugpy: {why}")),
                    }
                }
            }
            // Of who makes debugpy, and not for an editor.
            Some("debugpySockets") => {}
            Some("output") if message["body"]["category"] == "telemetry" => {}
            Some("initialized") => {
                self.is_begun = true;
                match self.again {
                    Some(_) => self.configure_again(),
                    // It comes too late for an editor that has ended it.
                    None if self.is_told => {}
                    None => self.client.pass(message),
                }
            }
            Some("stopped") => {
                let are_all = message["body"]["allThreadsStopped"] == true;
                self.client.pass(message);
                // The others go on, and drive.
                if are_all {
                    self.hold();
                }
            }
            // However it came to that; after a request of the editor motors go on already.
            Some("continued") => {
                if self.goes_alone
                    && let Some(body) = message.get_mut("body").and_then(Value::as_object_mut)
                {
                    body.insert("allThreadsContinued".to_owned(), json!(false));
                }
                self.client.pass(message);
                if std::mem::take(&mut self.is_held) {
                    self.in_program(&format!("_go_on({})", self.stops), Asked::GoOn);
                }
            }
            // The robot knows more of the end.
            Some("exited") => {}
            Some("terminated") => self.lost = Some(Instant::now()),
            Some(_) | None => self.client.pass(message),
        }
        None
    }

    fn answered(&mut self, asked: Asked, message: &Value) -> Option<bool> {
        let is_done = message["success"] == true;
        match asked {
            Asked::Hello => {
                let changed = changed(&message["body"]);
                self.client
                    .event("capabilities", json!({ "capabilities": changed }));
            }
            Asked::Attach => {
                let why = message["message"].as_str().unwrap_or("debugpy refuses");
                if self.again.is_some() && is_done {
                    return self.answer_again(None);
                } else if self.again.is_some() {
                    self.robot.end();
                    self.tell_end_because(1, why);
                    return None;
                }
                // The editor has ended a restart, which was answered then.
                if self.memory.runs() > 0 {
                    return None;
                }
                let answer = match is_done {
                    true => Ok(Value::Null),
                    false => Err(Refused::new(why)),
                };
                self.client.answer(&self.launch, answer);
                return (!is_done).then_some(false);
            }
            Asked::Hold => {
                let do_rest = is_done && message["body"]["result"] == "True";
                self.turning = (!do_rest).then(Instant::now);
            }
            Asked::GoOn | Asked::Configured => {}
            Asked::Points(at) => self.points_again(at, message),
            Asked::First(request, _) => self.adapter.send(&request.whole()),
        }
        None
    }

    /// Motors rest while all threads are stopped, unless the editor has asked otherwise.
    fn hold(&mut self) {
        if self.launch.text("motors") == Some("keep") {
            return;
        }
        self.is_held = true;
        self.stops += 1;
        self.in_program(&format!("_hold({})", self.stops), Asked::Hold);
    }

    /// Asks again for the rest of motors that have failed.
    fn hold_again(&mut self) {
        let is_due = self.turning.is_some_and(|at| at.elapsed() >= HOLD_AGAIN);
        if is_due && self.is_held && self.lost.is_none() {
            self.turning = None;
            self.in_program(&format!("_hold({})", self.stops), Asked::Hold);
        }
    }

    /// Has the program do something with its robot.
    fn in_program(&mut self, what: &str, asked: Asked) {
        let expression = format!("__import__('trik').{what}");
        let arguments = json!({"expression": expression, "context": "repl"});
        self.ask("evaluate", arguments, asked);
    }

    fn hear_robot(&mut self, event: Event) {
        match event {
            Event::Said(Channel::Output, text) => self.say("stdout", &text),
            Event::Said(Channel::Message, text) => {
                if self.is_begun {
                    self.say("stderr", &text);
                } else {
                    self.errors.push(text.trim_end().to_owned());
                }
            }
            Event::Over(text) => {
                self.is_over = true;
                if self.is_begun {
                    let is_good = ended_well(&self.launch, &text);
                    if !is_good && !self.is_told {
                        self.say("console", &text);
                    }
                    self.tell_end(u8::from(!is_good));
                } else {
                    self.errors.push(text);
                }
            }
            Event::Report(_) | Event::Asked(_) => {}
        }
    }

    /// What waits for too long: the end that debugpy has told and the robot has not, and a program that does not answer.
    fn end_late(&mut self) {
        if self.lost.is_some_and(|at| at.elapsed() > AFTER_END) && !self.is_told {
            self.robot.end();
            self.tell_end(1);
        }
        let mut late = self.asked.iter();
        let late = late.position(
            |(_, asked)| matches!(asked, Asked::First(_, since) if since.elapsed() > ASIDE),
        );
        if let Some(at) = late
            && let (_, Asked::First(request, _)) = self.asked.remove(at)
        {
            self.adapter.send(&request.whole());
        }
    }

    fn tell_end(&mut self, code: u8) {
        self.tell_end_because(code, "the program has ended");
    }

    /// The end, and to a restart that is under way why it has not come about.
    fn tell_end_because(&mut self, code: u8, why: &str) {
        let is_news = !std::mem::replace(&mut self.is_told, true);
        self.answer_again(Some(why));
        if is_news {
            self.client.event("exited", json!({ "exitCode": code }));
            self.client.event("terminated", json!({}));
        }
    }

    /// What the editor wants; whether the talk is over.
    fn receive(&mut self, request: Request) -> Option<bool> {
        let request = self.waits(request)?;
        if is_resuming(&request.command) {
            // debugpy says of such a step too that all go on.
            let resumes = self.launch.arguments.get("steppingResumesAllThreads");
            let is_step = request.command != "continue";
            self.goes_alone = is_step && resumes == Some(&Value::Bool(false));
        }
        match request.command.as_str() {
            "disconnect" => {
                // The program and its motors first: debugpy would let it drive on. After its end another one may run.
                self.robot.close();
                self.client.answer(&request, Ok(Value::Null));
                return Some(true);
            }
            "terminate" => {
                if !self.is_told {
                    self.robot.end();
                }
                self.client.answer(&request, Ok(Value::Null));
                self.tell_end(0);
            }
            "restart" => self.restart(request),
            "stepBack" | "reverseContinue" => {
                self.refuse(&request, "a program in Python cannot be taken back");
            }
            "continue" | "next" | "stepIn" | "stepOut" | "goto" if self.is_held => {
                if self.memory.has_ended(&request) {
                    self.refuse(&request, "this thread has ended");
                    return None;
                }
                (self.is_held, self.turning) = (false, None);
                self.going = Some(request.seq());
                let what = format!("_go_on({})", self.stops);
                self.memory.note(&request);
                self.in_program(&what, Asked::First(request, Instant::now()));
            }
            _ if self.is_told => self.refuse(&request, "the program has ended"),
            // debugpy would answer when a thread has stopped, and nothing else until then.
            "continue" if self.is_begun && !self.memory.is_stopped() => {
                let body = json!({"allThreadsContinued": true});
                self.client.answer(&request, Ok(body));
            }
            "configurationDone" if self.launch.truth("stopOnEntry") => {
                self.memory.note(&request);
                self.in_program("_stop_on_entry()", Asked::First(request, Instant::now()));
            }
            _ => {
                self.memory.note(&request);
                self.adapter.send(&exceptions(&request));
            }
        }
        None
    }

    fn refuse(&mut self, request: &Request, why: &str) {
        self.client.answer(request, Err(Refused::new(why)));
    }

    fn say(&mut self, category: &str, text: &str) {
        let text = format!("{}\n", text.trim_end_matches('\n'));
        let body = json!({"category": category, "output": text});
        self.client.event("output", body);
    }
}

/// Whether threads go on after a request that is granted.
fn is_resuming(command: &str) -> bool {
    matches!(command, "continue" | "next" | "stepIn" | "stepOut")
}

/// What debugpy can, for an editor that was told of programs of blocks.
fn changed(can: &Value) -> Value {
    let mut all = can.clone();
    if let (Some(all), Some(blocks)) = (all.as_object_mut(), capabilities().as_object()) {
        for (name, value) in blocks {
            if value.as_bool() == Some(true) {
                all.entry(name).or_insert(Value::Bool(false));
            }
        }
        all.insert("supportsRestartRequest".to_owned(), Value::Bool(true));
    }
    all
}

/// A request as debugpy gets it: an editor that knows the filter of programs of blocks alone means errors that nobody catches.
fn exceptions(request: &Request) -> Value {
    let mut all = request.whole();
    if request.command != "setExceptionBreakpoints" {
        return all;
    }
    let filters = all.pointer_mut("/arguments/filters");
    if let Some(filters) = filters.and_then(Value::as_array_mut) {
        for filter in filters {
            if filter == "errors" {
                *filter = json!("uncaught");
            }
        }
    }
    all
}

/// Whether the robot tells that the program has ended well.
fn ended_well(launch: &Request, text: &str) -> bool {
    let program = launch.text("program").map(Path::new);
    let name = program.and_then(Path::file_name).unwrap_or_default();
    news::ended(text, &name.to_string_lossy()) == Some(End::Well)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(arguments: Value) -> Request {
        Request::of("setExceptionBreakpoints", arguments)
    }

    #[test]
    fn the_filter_of_blocks_means_errors_that_nobody_catches() {
        let all = exceptions(&request(json!({"filters": ["errors", "raised", 3]})));
        assert_eq!(
            all["arguments"]["filters"],
            json!(["uncaught", "raised", 3])
        );
        for rubbish in [
            json!(null),
            json!(7),
            json!(["errors"]),
            json!({"filters": "errors"}),
            json!({"filters": {"errors": 1}}),
        ] {
            let all = exceptions(&request(rubbish.clone()));
            assert_eq!(all["arguments"], rubbish);
        }
    }
}
