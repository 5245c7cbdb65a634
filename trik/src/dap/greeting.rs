//! The beginning of a talk with an editor: what this adapter can, and about what program it is.
//!
//! Owns the requests before a program is there. Which of the others serves depends on the language of the program.

use super::client::{Client, Incoming, Refused};
use super::launch::Launch;
use super::{python, script};
use serde_json::{Value, json};
use std::time::Duration;

/// How long it waits for a request before it looks whether the client is still there.
const PATIENCE: Duration = Duration::from_millis(100);

/// Serves one client.
pub(super) fn serve(mut client: Client) {
    let mut hello = Value::Null;
    loop {
        let mut request = match client.next(PATIENCE) {
            Incoming::Request(request) => request,
            Incoming::Nothing => continue,
            Incoming::End => return,
        };
        if matches!(request.command.as_str(), "initialize" | "launch" | "attach") {
            client.hear_language(&mut request);
        }
        match request.command.as_str() {
            "initialize" => {
                client.answer(&request, Ok(capabilities()));
                hello = request.arguments;
            }
            "launch" | "attach" if python::is_meant(&request) => {
                if python::serve(&request, &hello, &mut client) {
                    return;
                }
            }
            "launch" | "attach" if script::is_meant(&request) => {
                if script::serve(&request, &mut client) {
                    return;
                }
            }
            "launch" | "attach" => {
                if let Some(launch) = Launch::read(&request, &mut client)
                    && launch.serve(request, &mut client)
                {
                    return;
                }
            }
            "disconnect" | "terminate" => {
                client.answer(&request, Ok(Value::Null));
                if request.command == "disconnect" {
                    return;
                }
            }
            _ => client.answer(&request, Err(Refused::new("launch a program first"))),
        }
    }
}

/// What the protocol lets an adapter do, and this one does with programs of blocks.
pub(super) fn capabilities() -> Value {
    let mut all = json!({
        "exceptionBreakpointFilters": [{"filter": "errors", "label": "Errors in blocks", "default": true}],
        "completionTriggerCharacters": [],
    });
    for name in [
        "supportsConfigurationDoneRequest",
        "supportsFunctionBreakpoints",
        "supportsConditionalBreakpoints",
        "supportsHitConditionalBreakpoints",
        "supportsLogPoints",
        "supportsInstructionBreakpoints",
        "supportsDataBreakpoints",
        "supportsStepBack",
        "supportsSetVariable",
        "supportsSetExpression",
        "supportsEvaluateForHovers",
        "supportsCompletionsRequest",
        "supportsRestartRequest",
        "supportsTerminateRequest",
        "supportsBreakpointLocationsRequest",
        "supportsExceptionInfoRequest",
        "supportsLoadedSourcesRequest",
        "supportsCancelRequest",
    ] {
        all[name] = Value::Bool(true);
    }
    all
}
