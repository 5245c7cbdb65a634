//! Programs in JavaScript: what their engine lets a debugger do, for an editor.
//!
//! Owns the talk. The engine can be paused, says where threads have called the robot, and where an error came from; it
//! cannot stop at a line, step or show variables, which is refused in words.

use super::client::{Client, Incoming, Refused, Request};
use super::greeting::capabilities;
use super::keys;
use crate::debug::target::words::told;
use crate::debug::target::{Channel, Event, Target, why_not};
use crate::error::Error;
use crate::remote::debugged::{Debugged, Runs};
use crate::remote::target::{target as place, the_one};
use lang_diagram::debug::order::Order;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;
use trikd::protocol::news;

/// How long it waits for one of both who speak before it hears the other.
const TURN: Duration = Duration::from_millis(5);
/// The requests that such an engine has no answer to.
const NEVER: [&str; 14] = [
    "next",
    "stepIn",
    "stepOut",
    "stepBack",
    "reverseContinue",
    "goto",
    "restartFrame",
    "variables",
    "setVariable",
    "setExpression",
    "evaluate",
    "completions",
    "dataBreakpointInfo",
    "restart",
];
/// What the number of a frame has of that of its thread.
const FRAMES: u64 = 1000;

/// Whether a request is about a program in JavaScript.
pub(super) fn is_meant(request: &Request) -> bool {
    let program = request.text("program").map(Path::new);
    let ending = program.and_then(Path::extension);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("js"))
}

/// Debugs until the talk is over, or false: it could not begin, which is told.
pub(super) fn serve(request: &Request, client: &mut Client) -> bool {
    match begin(request) {
        Ok(mut robot) => {
            let strangers = keys::strangers(request, &keys::OF_JAVASCRIPT);
            let strangers = strangers.unwrap_or_default();
            client.answer(request, Ok(Value::Null));
            if let Some(told) = keys::of_strangers(&strangers, &keys::OF_JAVASCRIPT) {
                let text = format!("trik dap: {told}\n");
                let body = json!({"category": "important", "output": text});
                client.event("output", body);
            }
            let changed = changed();
            client.event("capabilities", json!({ "capabilities": changed }));
            Session {
                client,
                robot: &mut robot,
                launch: request.clone(),
                told: Value::Null,
                is_configured: false,
                is_stop_told: false,
                is_over: false,
                had_error: false,
            }
            .run();
            true
        }
        Err(why) => {
            client.answer(request, Err(why));
            false
        }
    }
}

fn begin(request: &Request) -> Result<Debugged, Refused> {
    super::python::is_for_robot(request, "JavaScript")?;
    keys::strangers(request, &keys::OF_JAVASCRIPT)?;
    let robot = match request.text("robot") {
        Some(robot) => place(robot),
        None => the_one(),
    };
    let why = |error: Error| Refused(error.to_string());
    let robot = robot.map_err(why)?;
    let program = Path::new(request.text("program").unwrap_or_default());
    match request.command == "attach" {
        true => Debugged::attach(&robot, Runs::JavaScript, super::python::locale(request)),
        false => Debugged::launch(program, None, &robot, super::python::locale(request)),
    }
    .map_err(why)
}

/// What remains of what an editor was told that knows programs of blocks.
fn changed() -> Value {
    let mut all = capabilities();
    if let Some(all) = all.as_object_mut() {
        for (name, value) in all.iter_mut() {
            let stays = [
                "supportsConfigurationDoneRequest",
                "supportsTerminateRequest",
                "supportsExceptionInfoRequest",
            ];
            if value.is_boolean() && !stays.contains(&name.as_str()) {
                *value = Value::Bool(false);
            }
        }
    }
    all["exceptionBreakpointFilters"] =
        json!([{"filter": "errors", "label": "Errors that nobody catches", "default": true}]);
    all
}

struct Session<'a> {
    client: &'a mut Client,
    robot: &'a mut dyn Target,
    launch: Request,
    /// Where the program is, as it was told last.
    told: Value,
    is_configured: bool,
    /// The editor knows that it is stopped.
    is_stop_told: bool,
    is_over: bool,
    had_error: bool,
}

impl Session<'_> {
    fn run(&mut self) {
        let talked = self.begin().and_then(|()| self.talk());
        if let Err(error) = talked {
            self.say("important", &format!("trik dap: {error}"));
            self.tell_end(1);
        }
        self.robot.close();
    }

    fn begin(&mut self) -> Result<(), Error> {
        // It has just been uploaded and stands before its first line, or it runs.
        self.look()?;
        let is_at_beginning = self.launch.command != "attach";
        while is_at_beginning && self.told["state"] != "stopped" && !self.is_over {
            for event in self.robot.turn(TURN)? {
                self.hear(event);
            }
        }
        self.client.event("initialized", json!({}));
        Ok(())
    }

    fn look(&mut self) -> Result<(), Error> {
        self.order(&Order::Look).map(|_| ())
    }

    fn order(&mut self, order: &Order) -> Result<Result<(), Refused>, Error> {
        let answer = self.robot.order(order)?;
        if let Some(told) = answer.get("program") {
            self.learn(told.clone());
        }
        Ok(why_not(&answer).map_or(Ok(()), |why| Err(Refused(why))))
    }

    fn talk(&mut self) -> Result<(), Error> {
        loop {
            match self.client.next(TURN) {
                Incoming::Request(request) => {
                    if self.receive(&request)? {
                        return Ok(());
                    }
                    // The answer may have told of a stop that no report tells any more.
                    self.tell_stop();
                }
                Incoming::Nothing => {}
                Incoming::End => return Ok(()),
            }
            if !self.is_over {
                for event in self.robot.turn(Duration::ZERO)? {
                    self.hear(event);
                }
            }
        }
    }

    fn hear(&mut self, event: Event) {
        match event {
            Event::Said(Channel::Output, text) => self.say("stdout", &text),
            Event::Said(Channel::Message, text) => {
                self.had_error = true;
                self.say("stderr", &text);
            }
            Event::Report(told) => {
                self.learn(told);
                self.tell_stop();
            }
            Event::Asked(_) => {}
            Event::Over(_) => self.tell_end(u8::from(self.had_error)),
        }
    }

    /// Where the program is; what is no state of one is none.
    fn learn(&mut self, told: Value) {
        if told.get("state").is_some() {
            self.told = told;
            self.is_stop_told &= self.told["state"] == "stopped";
        }
    }

    /// Tells a stop that the editor does not know, whichever way it was heard of.
    fn tell_stop(&mut self) {
        let is_stopped = self.told["state"] == "stopped" && !self.is_over;
        if is_stopped && self.is_configured && !self.is_stop_told {
            self.stopped();
        }
    }

    /// Tells why all threads stand still.
    fn stopped(&mut self) {
        self.is_stop_told = true;
        let stop = &self.told["stop"];
        let thread = stop["thread"].as_u64().or(self.first());
        let body = match stop["text"].as_str() {
            None => json!({"reason": "pause", "allThreadsStopped": true, "threadId": thread}),
            Some(text) => json!({
                "reason": "exception",
                "allThreadsStopped": true,
                "threadId": thread,
                "description": text.lines().next(),
                "text": text,
            }),
        };
        self.client.event("stopped", body);
    }

    fn threads(&self) -> &[Value] {
        self.told["threads"].as_array().map_or(&[], Vec::as_slice)
    }

    fn first(&self) -> Option<u64> {
        self.threads().first()?["number"].as_u64()
    }

    fn say(&mut self, category: &str, text: &str) {
        let text = format!("{}\n", text.trim_end_matches('\n'));
        let body = json!({"category": category, "output": text});
        self.client.event("output", body);
    }

    fn tell_end(&mut self, code: u8) {
        if !std::mem::replace(&mut self.is_over, true) {
            self.client.event("exited", json!({ "exitCode": code }));
            self.client.event("terminated", json!({}));
        }
    }

    /// One request; true: it was the last one.
    fn receive(&mut self, request: &Request) -> Result<bool, Error> {
        match request.command.as_str() {
            "disconnect" => {
                self.robot.close();
                self.client.answer(request, Ok(Value::Null));
                return Ok(true);
            }
            "terminate" => {
                // After its end another one may run.
                if !self.is_over {
                    self.robot.end();
                }
                self.client.answer(request, Ok(Value::Null));
                self.tell_end(0);
            }
            _ => {
                let answer = self.answer(request)?;
                self.client.answer(request, answer);
            }
        }
        Ok(false)
    }

    fn answer(&mut self, request: &Request) -> Result<Result<Value, Refused>, Error> {
        let command = request.command.as_str();
        if self.is_over && command != "threads" {
            return Ok(Err(Refused::new("the program has ended")));
        }
        Ok(match command {
            "configurationDone" => {
                self.is_configured = true;
                return self.start();
            }
            "continue" => {
                let done = self.order(&Order::Continue)?;
                // A stop that the answer tells of is the next one.
                self.is_stop_told &= done.is_err();
                done.map(|()| json!({"allThreadsContinued": true}))
            }
            "pause" => {
                let done = self.order(&Order::Pause)?;
                done.map(|()| Value::Null)
            }
            "setExceptionBreakpoints" => {
                let filters = request.items("filters");
                let is_wanted = filters.iter().any(|filter| filter == "errors");
                let done = self.order(&Order::Errors(is_wanted))?;
                done.map(|()| Value::Null)
            }
            "setBreakpoints" | "setFunctionBreakpoints" => {
                let locale = super::python::locale(&self.launch);
                let why = told(news::NOT_IN_JAVASCRIPT, locale);
                let points = request.items("breakpoints").iter();
                let none = points.map(|_| json!({"verified": false, "message": why}));
                let none: Vec<Value> = none.collect();
                Ok(json!({ "breakpoints": none }))
            }
            "threads" => Ok(self.named()),
            "stackTrace" => {
                self.look()?;
                Ok(self.stack(request.number("threadId").unwrap_or(0)))
            }
            "scopes" => Ok(json!({"scopes": []})),
            "exceptionInfo" => {
                let text = self.told["stop"]["text"].as_str().unwrap_or_default();
                Ok(json!({
                    "exceptionId": text.lines().next(),
                    "description": text,
                    "breakMode": "unhandled",
                }))
            }
            other if NEVER.contains(&other) => Err(Refused::new(news::NOT_IN_JAVASCRIPT)),
            other => {
                let why = format!("this adapter does not know '{other}' for JavaScript");
                Err(Refused(why))
            }
        })
    }

    /// The editor has said all that it wants to say first.
    fn start(&mut self) -> Result<Result<Value, Refused>, Error> {
        let is_stopped = self.told["state"] == "stopped";
        if self.launch.command == "attach" && !is_stopped {
            return Ok(Ok(Value::Null));
        }
        if self.launch.truth("stopOnEntry") || self.launch.command == "attach" {
            let body = json!({
                "reason": "entry",
                "allThreadsStopped": true,
                "threadId": self.first(),
            });
            self.is_stop_told = true;
            self.client.event("stopped", body);
            return Ok(Ok(Value::Null));
        }
        let done = self.order(&Order::Continue)?;
        Ok(done.map(|()| Value::Null))
    }

    fn named(&self) -> Value {
        let threads = self.threads().iter();
        let threads: Vec<Value> = threads
            .map(|thread| json!({"id": thread["number"], "name": thread["name"]}))
            .collect();
        json!({ "threads": threads })
    }

    /// The calls of a thread; of one that computes the last call of the robot.
    fn stack(&self, id: u64) -> Value {
        let program = self.launch.text("program").unwrap_or_default();
        let program = std::path::absolute(program).unwrap_or_else(|_| program.into());
        let mut threads = self.threads().iter();
        let thread = threads.find(|thread| thread["number"].as_u64() == Some(id));
        let calls = thread.and_then(|thread| thread["frames"].as_array());
        let calls = calls.map_or(&[][..], Vec::as_slice);
        let frames: Vec<Value> = (0u64..)
            .zip(calls)
            .map(|(index, call)| {
                let file = call["file"].as_str().unwrap_or_default();
                let path = match file {
                    "<program>" => program.clone(),
                    other => program.with_file_name(other),
                };
                let name = match call["function"].as_str().unwrap_or_default() {
                    "" => "<global>",
                    name => name,
                };
                json!({
                    "id": id.saturating_mul(FRAMES).saturating_add(index),
                    "name": name,
                    "line": call["line"],
                    "column": call["column"],
                    "source": {"name": path.file_name().map(|name| name.to_string_lossy()), "path": path},
                })
            })
            .collect();
        json!({"stackFrames": frames, "totalFrames": calls.len()})
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::debug::target::{Changed, Written};
    use lang_text::problem::Words;
    use std::io::{self, Write};
    use std::sync::{Arc, Mutex};

    /// A robot that answers with these, one after the other, and has no news.
    struct Robot(Vec<Value>);

    impl Target for Robot {
        fn order(&mut self, _: &Order) -> Result<Value, Error> {
            Ok(self.0.remove(0))
        }

        fn turn(&mut self, _: Duration) -> Result<Vec<Event>, Error> {
            Ok(Vec::new())
        }

        fn change(&mut self, _: &Path, _: Option<&str>, _: Written<'_>) -> Result<Changed, Error> {
            Ok(Changed::Wrong(String::new()))
        }

        fn end(&mut self) {}

        fn close(&mut self) {}

        fn keeps_past(&self) -> bool {
            false
        }

        fn scene(&self, _: u64) -> Option<Words> {
            None
        }
    }

    /// What an editor is told.
    #[derive(Clone, Default)]
    struct Screen(Arc<Mutex<Vec<u8>>>);

    impl Write for Screen {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().expect("nobody fails").extend(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Screen {
        fn stops(&self) -> usize {
            let told = self.0.lock().expect("nobody fails");
            let told = String::from_utf8_lossy(&told);
            told.matches("\"stopped\"").count()
        }
    }

    /// How a session that is configured takes these requests, each with an answer of the robot, and then a report.
    fn stops(requests: &[(&str, Value, Value)], report: Value) -> usize {
        let answers = requests.iter().map(|(_, _, answer)| answer.clone());
        let mut robot = Robot(answers.collect());
        let told = Screen::default();
        let mut client = Client::new(io::empty(), Box::new(told.clone()));
        let mut session = Session {
            client: &mut client,
            robot: &mut robot,
            launch: Request::of("launch", json!({"program": "x.js"})),
            told: Value::Null,
            is_configured: true,
            is_stop_told: false,
            is_over: false,
            had_error: false,
        };
        for (command, arguments, _) in requests {
            let request = Request::of(command, arguments.clone());
            assert!(!session.receive(&request).expect("a robot"));
            session.tell_stop();
        }
        session.hear(Event::Report(report));
        told.stops()
    }

    fn told(state: &str) -> Value {
        json!({"done": true, "program": {"state": state, "stop": {"text": "Line 4: no"}}})
    }

    #[test]
    fn a_stop_is_told_once_whichever_way_it_comes() {
        let report = json!({"state": "stopped", "stop": {"text": "Line 4: no"}});
        let request = |command, answer| (command, json!({"threadId": 1}), told(answer));
        // By the answer to some order alone, whose reports are forgotten.
        let look = [request("stackTrace", "stopped")];
        assert_eq!(stops(&look, report.clone()), 1);
        // The same error again, at once.
        let again = [request("pause", "stopped"), request("continue", "stopped")];
        assert_eq!(stops(&again, report.clone()), 2);
        let later = [request("pause", "stopped"), request("continue", "running")];
        assert_eq!(stops(&later, report), 2);
    }

    #[test]
    fn rubbish_of_robots_and_clients_is_no_end() {
        for rubbish in [
            json!(null),
            json!(7),
            json!([1]),
            json!("stopped"),
            json!({"state": 1, "stop": 2, "threads": 3}),
            json!({"state": "running", "threads": [7, {"number": u64::MAX, "frames": [1, {"line": []}]}]}),
        ] {
            let answer = json!({"done": true, "program": rubbish});
            let all = [
                ("stackTrace", json!({"threadId": u64::MAX}), answer.clone()),
                ("setExceptionBreakpoints", json!(7), answer.clone()),
                ("pause", json!([]), answer.clone()),
            ];
            assert_eq!(stops(&all, rubbish), 0);
        }
    }
}
