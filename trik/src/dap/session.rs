//! A talk with an editor about a program of blocks: to the end of the program, or of the editor's patience.
//!
//! Owns the order of the protocol and what each request does. The program begins stopped; it goes on when the editor has
//! said all its breakpoints. Between requests it runs in small pieces, so that no request waits for long.

use super::client::{Client, Incoming, Refused, Request};
use super::launch::Launch;
use super::points::{Kind, Points};
use super::view;
use crate::debug::listing::Listing;
use crate::debug::report::{Report, State};
use crate::debug::stops::words;
use crate::debug::target::{Channel, Event, Target, log_lines, why_not};
use crate::error::Error;
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Back, Step};
use serde_json::{Value, json};
use std::time::Duration;

/// How long the program runs between two looks for requests.
const PIECE: Duration = Duration::from_millis(5);
/// How long a program that is stopped waits for one.
const PATIENCE: Duration = Duration::from_millis(100);

/// How a program comes into a talk.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Begins {
    /// For the first time: the client says its breakpoints.
    First,
    /// Anew, with the breakpoints that were said before.
    Anew,
    /// It goes on as another version, with breakpoints and all it has.
    Changed,
    /// It goes on as it was: nothing has come of a restart.
    Same,
}

/// What becomes of a program.
pub(super) enum After {
    /// The talk is over.
    End,
    /// It begins anew, or becomes another version; this request is answered then. And whether its run is over.
    Again(Request, bool),
}

/// A program that is debugged.
pub(super) struct Session<'a> {
    client: &'a mut Client,
    target: &'a mut dyn Target,
    listing: &'a Listing,
    name: String,
    points: &'a mut Points,
    told: Report,
    /// The client has said all its breakpoints.
    is_configured: bool,
    /// The run is over, and only its past is left.
    is_over: bool,
    launch: &'a Launch,
}

impl<'a> Session<'a> {
    pub fn new(
        client: &'a mut Client,
        target: &'a mut dyn Target,
        (listing, name): (&'a Listing, String),
        (points, is_over): (&'a mut Points, bool),
        launch: &'a Launch,
    ) -> Self {
        Self {
            client,
            target,
            listing,
            name,
            points,
            told: Report::default(),
            is_configured: false,
            is_over,
            launch,
        }
    }

    /// Until the talk is over, or the program is to begin anew.
    ///
    /// # Errors
    /// The robot is gone.
    pub fn run(&mut self, begins: Begins) -> Result<After, Error> {
        match begins {
            Begins::First | Begins::Anew => self.start(begins)?,
            Begins::Changed => self.go_on_changed()?,
            Begins::Same => {
                self.is_configured = true;
                self.order(&Order::Look)?.ok();
            }
        }
        self.talk()
    }

    /// To the stop before the first block, and on if nobody wants it there.
    fn start(&mut self, begins: Begins) -> Result<(), Error> {
        let mut events = Vec::new();
        while !self.launch.is_joining && self.told.state == State::Running && !self.is_over {
            events.extend(self.turn(PIECE)?);
        }
        self.hear(&events, false);
        if begins == Begins::First {
            self.client.event("initialized", json!({}));
        } else {
            self.tell_text();
            self.points.set_again(self.target)?;
            self.tell_points();
            self.order(&Order::Errors(self.points.stops_at_errors))?
                .ok();
            self.begin()?;
        }
        Ok(())
    }

    /// Another version runs: its text is another one, and breakpoints are elsewhere in it.
    fn go_on_changed(&mut self) -> Result<(), Error> {
        self.is_configured = true;
        self.order(&Order::Look)?.ok();
        self.tell_text();
        self.points.set_missing(self.target)?;
        self.tell_points();
        if matches!(self.told.state, State::Stopped | State::Past) {
            self.tell_stop();
        }
        Ok(())
    }

    /// The text that the client has may be another one now.
    fn tell_text(&mut self) {
        let source = view::source(&self.name);
        self.client.event(
            "loadedSource",
            json!({"reason": "changed", "source": source}),
        );
    }

    /// Which breakpoints are set now, and where.
    fn tell_points(&mut self) {
        for point in self.points.places(self.listing) {
            let body = json!({"reason": "changed", "breakpoint": point});
            self.client.event("breakpoint", body);
        }
    }

    fn talk(&mut self) -> Result<After, Error> {
        loop {
            let is_running = self.is_configured && self.told.state.is_under_way() && !self.is_over
                || self.told.state == State::Searching;
            let wait = if is_running { Duration::ZERO } else { PATIENCE };
            match self.client.next(wait) {
                Incoming::Request(request) => {
                    if let Some(after) = self.receive(request)? {
                        return Ok(after);
                    }
                }
                Incoming::End => return Ok(After::End),
                Incoming::Nothing if is_running => {
                    let events = self.turn(PIECE)?;
                    self.hear(&events, true);
                }
                Incoming::Nothing => {
                    // A robot goes on living while a person thinks.
                    let events = self.turn(Duration::ZERO)?;
                    self.hear(&events, true);
                }
            }
        }
    }

    /// Lets the program go on after its beginning.
    fn begin(&mut self) -> Result<(), Error> {
        self.is_configured = true;
        if self.launch.is_joining {
            self.order(&Order::Look)?.ok();
            self.tell_another();
        }
        if self.is_over {
            self.ended(0);
        } else if self.launch.is_joining && self.told.state == State::Running {
            // It runs, and goes on running, unless the editor wants it to stop.
            if self.launch.stops_on_entry
                && self.launch.is_debugged
                && let Err(Refused(why)) = self.order(&Order::Pause)?
            {
                self.output("important", &why);
            }
        } else if self.launch.stops_on_entry && self.launch.is_debugged {
            self.stopped("entry", None);
        } else {
            if let Err(Refused(why)) = self.order(&Order::Continue)? {
                self.output("important", &why);
            }
            self.settle();
        }
        Ok(())
    }

    /// Says it if what runs is not what the editor shows.
    fn tell_another(&mut self) {
        let mut blocks = self.told.threads.iter().map(|thread| &thread.at.id);
        if blocks.any(|id| !id.is_empty() && !self.listing.has(id)) {
            let what = super::words::another_runs(&self.name);
            self.output("important", &words::in_locale(self.launch.locale(), what));
        }
    }

    /// Lets the program run, or waits. What an answer has said already is not among what has happened.
    fn turn(&mut self, wait: Duration) -> Result<Vec<Event>, Error> {
        let mut events = self.target.turn(wait)?;
        events.retain(|event| match event {
            Event::Report(value) => match Report::read(value) {
                Some(told) => {
                    let is_new = !told.is_same(&self.told);
                    self.told = told;
                    is_new
                }
                None => true,
            },
            Event::Over(_) => {
                self.is_over = true;
                true
            }
            Event::Said(..) | Event::Asked(_) => true,
        });
        Ok(events)
    }

    /// Passes on what has happened.
    fn hear(&mut self, events: &[Event], tells_stops: bool) {
        let (mut is_stopped, mut is_at_end) = (false, false);
        let mut over = None;
        for event in events {
            match event {
                Event::Report(value) => {
                    for line in log_lines(value) {
                        self.output("console", line);
                    }
                    let state = Report::read(value).map(|told| told.state);
                    is_stopped |= matches!(state, Some(State::Stopped | State::Past));
                    is_at_end |= self.is_over && state == Some(State::Ended);
                }
                Event::Said(Channel::Output, text) => self.output("stdout", text),
                Event::Said(Channel::Message, text) => self.output("stderr", text),
                // An editor has no place to answer, and does not say that somebody would.
                Event::Asked(_) => {}
                Event::Over(why) => over = Some(why.clone()),
            }
        }
        if let Some(why) = over {
            self.output("console", &why);
            let is_good = !self.told.with_errors;
            if self.launch.stops_at_end && self.launch.is_debugged {
                self.stopped("pause", Some(why));
            } else if self.is_configured {
                self.ended(u8::from(!is_good));
            }
        } else if is_stopped && tells_stops {
            self.tell_stop();
        } else if is_at_end && tells_stops {
            self.at_end();
        }
    }

    fn output(&mut self, category: &str, text: &str) {
        let text = format!("{}\n", text.trim_end_matches('\n'));
        let body = json!({"category": category, "output": text});
        self.client.event("output", body);
    }

    fn ended(&mut self, code: u8) {
        self.client.event("exited", json!({ "exitCode": code }));
        self.client.event("terminated", json!({}));
    }

    /// Tells where it is stopped, as the debugger has it.
    fn tell_stop(&mut self) {
        let stop = self.told.stop.clone().unwrap_or_default();
        let reason = match stop.reason.as_str() {
            "breakpoint" | "condition" => "breakpoint",
            "change" => "data breakpoint",
            "error" => "exception",
            "step" | "thread ended" => "step",
            _ => "pause",
        };
        let token = stop.at.and_then(|at| at.token);
        let text = match (stop.change, token) {
            (Some(change), _) => change.sentence(self.launch.locale()),
            (None, Some(token)) if stop.text.is_empty() => {
                let what = words::token(&token.full_name(), &token.value);
                words::in_locale(self.launch.locale(), what)
                    .trim()
                    .to_owned()
            }
            (None, _) => stop.text,
        };
        self.stopped(reason, (!text.is_empty()).then_some(text));
    }

    fn stopped(&mut self, reason: &str, text: Option<String>) {
        let stop = self.told.stop.clone().unwrap_or_default();
        let mut body = json!({"reason": reason, "allThreadsStopped": true});
        if let Some(thread) = view::stopped_thread(&self.told) {
            body["threadId"] = json!(thread);
        }
        if let Some(id) = stop.number.and_then(|number| self.points.id_of(number)) {
            body["hitBreakpointIds"] = json!([id]);
        }
        if let Some(text) = text {
            body["description"] = json!(text);
            body["text"] = json!(text);
        }
        self.client.event("stopped", body);
    }

    /// Gives an order; what it says of the program is kept.
    fn order(&mut self, order: &Order) -> Result<Result<Value, Refused>, Error> {
        let answer = self.target.order(order)?;
        if let Some(told) = answer.get("program").and_then(Report::read) {
            self.told = told;
        }
        Ok(match why_not(&answer) {
            None => Ok(answer),
            Some(why) => Err(Refused(why)),
        })
    }

    /// After an order that moves the program: what came of it at once.
    fn settle(&mut self) {
        match self.told.state {
            State::Stopped | State::Past => {
                // Lines of breakpoints come by news; the stop is told here.
                if let Ok(events) = self.turn(Duration::ZERO) {
                    self.hear(&events, false);
                }
                self.tell_stop();
            }
            State::Ended if self.is_over => self.at_end(),
            State::Running | State::Searching | State::Ended => {}
        }
    }

    /// An editor that looked at the past of a run that is over is at its end again.
    fn at_end(&mut self) {
        match self.launch.stops_at_end && self.launch.is_debugged {
            true => self.stopped("pause", None),
            false => self.ended(0),
        }
    }

    /// The program is to stop, or a search through its past is to end where it began.
    fn pause(&mut self, request: &Request) -> Result<(), Error> {
        let was = self.told.state;
        let answer = self.order(&Order::Pause)?.map(|_| Value::Null);
        self.client.answer(request, answer);
        if was == State::Searching {
            self.settle();
        }
        Ok(())
    }

    /// One request; what becomes of the program if this was its last one.
    fn receive(&mut self, request: Request) -> Result<Option<After>, Error> {
        match request.command.as_str() {
            "disconnect" => {
                self.client.answer(&request, Ok(Value::Null));
                return Ok(Some(After::End));
            }
            "restart" => return Ok(Some(After::Again(request, self.is_over))),
            "configurationDone" => {
                self.client.answer(&request, Ok(Value::Null));
                if !self.is_configured {
                    self.begin()?;
                }
                return Ok(None);
            }
            "terminate" => {
                self.target.end();
                self.client.answer(&request, Ok(Value::Null));
                self.is_over = true;
                self.ended(0);
                return Ok(None);
            }
            "pause" => return self.pause(&request).map(|()| None),
            "cancel" if self.told.state == State::Searching => {
                return self.pause(&request).map(|()| None);
            }
            "cancel" => {
                self.client.answer(&request, Ok(Value::Null));
                return Ok(None);
            }
            _ => {}
        }
        if let Some(order) = self.moving(&request)? {
            return self.go(&request, &order).map(|()| None);
        }
        let answer = self.answer(&request)?;
        self.client.answer(&request, answer);
        Ok(None)
    }

    /// The order of a request that moves the program.
    fn moving(&self, request: &Request) -> Result<Option<Order>, Error> {
        let thread = request.number("threadId").map(view::thread_of);
        let mut threads = self.told.threads.iter();
        let thread = threads.find(|found| Some(found.number) == thread);
        let name = thread.map(|thread| thread.name.as_str().into());
        Ok(Some(match request.command.as_str() {
            "continue" => Order::Continue,
            "next" => Order::Step(Step::Over, name),
            "stepIn" => Order::Step(Step::Into, name),
            "stepOut" => Order::Step(Step::Out, name),
            "stepBack" => Order::Back(Back::Step(Step::Over)),
            "reverseContinue" => Order::Back(Back::Continue),
            _ => return Ok(None),
        }))
    }

    fn go(&mut self, request: &Request, order: &Order) -> Result<(), Error> {
        let is_present = !matches!(self.told.state, State::Past | State::Searching);
        if self.is_over && is_present && !matches!(order, Order::Back(_)) {
            self.client
                .answer(request, Ok(json!({"allThreadsContinued": true})));
            self.ended(0);
            return Ok(());
        }
        match self.order(order)? {
            Err(why) => self.client.answer(request, Err(why)),
            Ok(_) => {
                let body = match request.command.as_str() {
                    "continue" => json!({"allThreadsContinued": true}),
                    _ => Value::Null,
                };
                self.client.answer(request, Ok(body));
                self.settle();
            }
        }
        Ok(())
    }

    fn answer(&mut self, request: &Request) -> Result<Result<Value, Refused>, Error> {
        let listing = self.listing;
        let set = |session: &mut Self, kind, items| {
            session.points.set(kind, items, listing, session.target)
        };
        Ok(Ok(match request.command.as_str() {
            "setBreakpoints" => {
                let old = request.items("breakpoints");
                set(self, Kind::Line, old)?
            }
            "setFunctionBreakpoints" => set(self, Kind::Name, request.items("breakpoints"))?,
            "setInstructionBreakpoints" => set(self, Kind::Id, request.items("breakpoints"))?,
            "dataBreakpointInfo" => {
                view::data(&self.told, request.text("name").unwrap_or_default())
            }
            "setDataBreakpoints" => set(self, Kind::Variable, request.items("breakpoints"))?,
            "setExceptionBreakpoints" => {
                let filters = request.items("filters");
                let is_wanted = filters.iter().any(|filter| filter == "errors");
                self.points.stops_at_errors = is_wanted;
                // An editor asks for it by itself, so that no is an answer and no error.
                return Ok(Ok(match self.order(&Order::Errors(is_wanted))? {
                    Ok(_) => Value::Null,
                    Err(Refused(why)) => {
                        json!({"breakpoints": [{"verified": false, "message": why}]})
                    }
                }));
            }
            "threads" => view::threads(&self.told),
            "stackTrace" => {
                let window = (
                    request.number("startFrame").unwrap_or(0),
                    request.number("levels").unwrap_or(0),
                );
                let id = request.number("threadId").unwrap_or(0);
                view::stack(&self.told, id, window, self.listing, &self.name)
            }
            "scopes" => view::scopes(&self.told, self.launch.locale()),
            "variables" => {
                let _ = self.order(&Order::Look)?;
                let reference = request.number("variablesReference").unwrap_or(0);
                view::variables(&self.told, reference, self.target)?
            }
            "setVariable" | "setExpression" => {
                let name = request.text("name").or(request.text("expression"));
                let value = request.text("value").unwrap_or_default();
                return self.assign(name.unwrap_or_default(), value);
            }
            "evaluate" => return self.evaluate(request),
            "completions" => view::completions(
                &self.told,
                request.text("text").unwrap_or_default(),
                request.number("column").unwrap_or(1),
            ),
            "source" => json!({"content": self.listing.whole(), "mimeType": "text/plain"}),
            "loadedSources" => json!({"sources": [view::source(&self.name)]}),
            "breakpointLocations" => self.locations(request),
            "exceptionInfo" => {
                let stop = self.told.stop.clone().unwrap_or_default();
                json!({"exceptionId": "error", "description": stop.text, "breakMode": "always"})
            }
            other => {
                return Ok(Err(Refused(format!(
                    "this adapter does not know '{other}'"
                ))));
            }
        }))
    }

    fn assign(&mut self, name: &str, value: &str) -> Result<Result<Value, Refused>, Error> {
        let assigned = self.order(&Order::Set(name.into(), value.into()))?;
        Ok(assigned.map(|answer| {
            json!({
                "value": view::word(&answer, "value"),
                "type": view::word(&answer, "type"),
                "variablesReference": 0,
            })
        }))
    }

    fn evaluate(&mut self, request: &Request) -> Result<Result<Value, Refused>, Error> {
        let text = request
            .text("expression")
            .unwrap_or_default()
            .trim()
            .to_owned();
        let is_assignment = text.split_once('=').is_some_and(|(name, value)| {
            let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == ' ';
            !name.is_empty() && name.chars().all(is_name) && !value.starts_with('=')
        });
        let answer = match (request.text("context"), text.split_once('=')) {
            (Some("repl"), Some((name, value))) if is_assignment => {
                self.order(&Order::Set(name.trim().into(), value.trim().into()))?
            }
            _ => self.order(&Order::Evaluate(text.as_str().into()))?,
        };
        Ok(answer.map(|answer| {
            json!({
                "result": view::word(&answer, "value"),
                "type": view::word(&answer, "type"),
                "variablesReference": 0,
            })
        }))
    }

    fn locations(&self, request: &Request) -> Value {
        let line = |name| {
            let line = request.number(name);
            line.and_then(|line| usize::try_from(line).ok())
        };
        let from = line("line").unwrap_or(1).max(1);
        let to = line("endLine").unwrap_or(from).min(self.listing.len());
        let lines = (from..=to).filter(|line| !self.listing.blocks(*line).is_empty());
        let lines: Vec<Value> = lines.map(|line| json!({ "line": line })).collect();
        json!({ "breakpoints": lines })
    }
}
