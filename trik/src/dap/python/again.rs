//! A restart of a program in Python: the one that runs is ended, and its file, as it is now, begins with the same breakpoints.
//!
//! Owns what the editor has said that counts for the next program too, and the numbers that breakpoints have for it: debugpy
//! is another process then, and numbers them anew.

use super::{Adapter, Asked, Session, exceptions};
use crate::dap::client::{Refused, Request};
use crate::limits;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Instant;

/// What a request that a restart has overtaken is answered.
const OVERTAKEN: &str = "the program begins anew";
/// How far the numbers of breakpoints of one program are from those of the next one.
const RUN_NUMBERS: u64 = 1_000_000;

/// Breakpoints of one kind, or in one file, as the editor has said them last.
#[derive(Debug)]
struct RememberedPoints {
    request: Request,
    /// Their numbers as the editor knows them, where it does.
    numbers: Vec<Option<u64>>,
}

impl RememberedPoints {
    fn key(request: &Request) -> (&str, Option<&Value>) {
        (&request.command, request.arguments.get("source"))
    }
}

/// What an editor has said to debugpy, and heard.
#[derive(Debug, Default)]
pub(super) struct Memory {
    points: Vec<RememberedPoints>,
    /// Requests that debugpy has not answered.
    open: Vec<Request>,
    threads: BTreeSet<u64>,
    /// Those that have ended.
    ended: BTreeSet<u64>,
    /// Which of them was told to be stopped last.
    stopped: Option<u64>,
    /// How many programs there were before this one, and numbers of its breakpoints that have others for the editor.
    runs: u64,
    numbers: BTreeMap<u64, u64>,
}

impl Memory {
    /// This request is on its way to debugpy.
    pub fn note(&mut self, request: &Request) {
        if self.open.len() >= limits::DAP_WAITING {
            self.open.remove(0);
        }
        self.open.push(request.clone());
        if !request.command.starts_with("set") || !request.command.ends_with("Breakpoints") {
            return;
        }
        let key = RememberedPoints::key(request);
        self.points
            .retain(|said| RememberedPoints::key(&said.request) != key);
        if self.points.len() >= limits::DAP_SOURCES_MAX {
            self.points.remove(0);
        }
        let (request, numbers) = (request.clone(), Vec::new());
        self.points.push(RememberedPoints { request, numbers });
    }

    /// What debugpy says, with the numbers that the editor knows.
    pub fn hear(&mut self, message: &mut Value) {
        if let Some(body) = message.get_mut("body") {
            self.rename_all(body);
        }
        let thread = message["body"]["threadId"].as_u64();
        let is_end = message["body"]["reason"] == "exited";
        match (message["event"].as_str(), thread) {
            (Some("thread"), Some(thread)) if is_end => {
                self.threads.remove(&thread);
                if self.ended.len() < limits::DAP_WAITING {
                    self.ended.insert(thread);
                }
            }
            (Some("thread"), Some(thread)) if self.threads.len() < limits::DAP_WAITING => {
                self.ended.remove(&thread);
                self.threads.insert(thread);
            }
            (Some("stopped"), thread) => self.stopped = thread,
            (Some("continued"), _) => self.stopped = None,
            (Some(_) | None, _) => {}
        }
        let number = message.get("request_seq").and_then(Value::as_u64);
        let is_meant = |request: &Request| number == Some(request.seq());
        if let Some(at) = self.open.iter().position(is_meant) {
            let request = self.open.remove(at);
            let mut all = self.points.iter_mut();
            // A newer one about the same is not answered yet.
            if let Some(said) = all.find(|said| said.request == request) {
                said.numbers = numbers(message);
            }
        }
    }

    /// Numbers of breakpoints, wherever they stand.
    fn rename_all(&self, body: &mut Value) {
        if let Some(points) = body.get_mut("breakpoints").and_then(Value::as_array_mut) {
            for point in points {
                self.rename(point.get_mut("id"));
            }
        }
        self.rename(body.pointer_mut("/breakpoint/id"));
        let hit = body.get_mut("hitBreakpointIds");
        for number in hit.and_then(Value::as_array_mut).into_iter().flatten() {
            self.rename(Some(number));
        }
    }

    /// Whether a step is that of a thread that has ended, which debugpy takes for one that it can do.
    pub fn has_ended(&self, request: &Request) -> bool {
        let thread = request.arguments["threadId"].as_u64();
        request.command != "continue" && thread.is_some_and(|thread| self.ended.contains(&thread))
    }

    /// Whether some thread was told to be stopped, and not to go on.
    pub fn is_stopped(&self) -> bool {
        self.stopped.is_some()
    }

    /// All threads go on.
    pub fn goes_on(&mut self) {
        self.stopped = None;
    }

    /// How many programs there were before this one.
    pub fn runs(&self) -> u64 {
        self.runs
    }

    fn rename(&self, number: Option<&mut Value>) {
        if let Some(number) = number
            && let Some(own) = number.as_u64()
        {
            let known = self.numbers.get(&own).copied();
            *number = json!(known.unwrap_or(own + self.runs * RUN_NUMBERS));
        }
    }

    /// Breakpoints of this request have those numbers in the next program; each as it is now, for the editor.
    fn again(&mut self, at: usize, message: &Value) -> Vec<Value> {
        let Some(said) = self.points.get(at) else {
            return Vec::new();
        };
        let points = message["body"]["breakpoints"].as_array();
        let points = points.into_iter().flatten().zip(&said.numbers);
        let known = points.filter_map(|(point, known)| {
            self.numbers.insert(point.get("id")?.as_u64()?, (*known)?);
            let mut point = point.clone();
            point["id"] = json!(known);
            Some(point)
        });
        known.collect()
    }
}

/// Numbers of the breakpoints in an answer.
fn numbers(message: &Value) -> Vec<Option<u64>> {
    let points = message["body"]["breakpoints"].as_array();
    let points = points.into_iter().flatten();
    points
        .map(|point| point.get("id").and_then(Value::as_u64))
        .collect()
}

/// A restart that is under way.
pub(super) struct Again {
    request: Request,
    /// What the editor has asked for meanwhile.
    waiting: Vec<Request>,
}

impl Session<'_> {
    /// Has the file begin anew, as it is now. If it cannot be sent, what runs goes on.
    pub(super) fn restart(&mut self, request: Request) {
        if !self.is_begun || self.is_told {
            return self.refuse(&request, "there is no program that could begin anew");
        }
        let python = self.launch.text("python").unwrap_or("python3");
        let program = self.launch.text("program").unwrap_or_default();
        let adapter = Adapter::start(python);
        let begun = adapter.and_then(|adapter| {
            let folder = self.robot.python_again(Path::new(program));
            let folder = folder.map_err(|why| Refused(why.to_string()))?;
            Ok((adapter, folder))
        });
        match begun {
            Err(why) => self.client.answer(&request, Err(why)),
            Ok((adapter, folder)) => {
                // The end of the old one is none for its program, which has ended and left its motors at rest.
                self.adapter = adapter;
                self.forget();
                let waiting = Vec::new();
                self.again = Some(Again { request, waiting });
                let hello = self.hello.clone();
                self.ask("initialize", hello, Asked::Hello);
                let attach = self.attachment(&folder);
                self.ask("attach", attach, Asked::Attach);
            }
        }
    }

    /// Nothing is left of the program that ran.
    fn forget(&mut self) {
        self.asked.clear();
        self.errors.clear();
        (self.is_begun, self.is_over, self.is_held) = (false, false, false);
        (self.goes_alone, self.going) = (false, None);
        self.memory.ended.clear();
        (self.stops, self.turning, self.lost) = (0, None, None);
        for request in std::mem::take(&mut self.memory.open) {
            self.refuse(&request, OVERTAKEN);
        }
        if let Some(thread) = self.memory.stopped.take() {
            let body = json!({"threadId": thread, "allThreadsContinued": true});
            self.client.event("continued", body);
        }
        for thread in std::mem::take(&mut self.memory.threads) {
            let body = json!({"reason": "exited", "threadId": thread});
            self.client.event("thread", body);
        }
        self.memory.runs += 1;
        self.memory.numbers.clear();
    }

    /// The next program waits for its breakpoints: it gets those of the last one, and begins.
    pub(super) fn configure_again(&mut self) {
        for at in 0..self.memory.points.len() {
            let request = exceptions(&self.memory.points[at].request);
            let command = self.memory.points[at].request.command.clone();
            self.ask(&command, request["arguments"].clone(), Asked::Points(at));
        }
        let done = Request::own(self.next, "configurationDone");
        self.asked.push((self.next, Asked::Configured));
        self.next += 1;
        if self.launch.truth("stopOnEntry") {
            self.in_program("_stop_on_entry()", Asked::First(done, Instant::now()));
        } else {
            self.adapter.send(&done.whole());
        }
    }

    /// The editor hears where its breakpoints are now.
    pub(super) fn points_again(&mut self, at: usize, message: &Value) {
        for point in self.memory.again(at, message) {
            let body = json!({"reason": "changed", "breakpoint": point});
            self.client.event("breakpoint", body);
        }
    }

    /// A restart has come to its end: the program runs, or why it does not.
    pub(super) fn answer_again(&mut self, why: Option<&str>) -> Option<bool> {
        let again = self.again.take()?;
        let answer = match why {
            None => Ok(Value::Null),
            Some(why) => Err(Refused::new(why)),
        };
        self.client.answer(&again.request, answer);
        for request in again.waiting {
            if let Some(is_good) = self.receive(request) {
                return Some(is_good);
            }
        }
        None
    }

    /// Whether a request waits for the end of a restart; if not, it is given back.
    pub(super) fn waits(&mut self, request: Request) -> Option<Request> {
        let is_end = matches!(request.command.as_str(), "disconnect" | "terminate");
        match &mut self.again {
            Some(again) if !is_end => {
                if again.waiting.len() < limits::DAP_WAITING {
                    again.waiting.push(request);
                } else {
                    self.refuse(&request, OVERTAKEN);
                }
                None
            }
            Some(_) | None => Some(request),
        }
    }
}
