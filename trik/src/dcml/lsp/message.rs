//! Messages of JSON-RPC 2.0: what came, and what is answered.
//!
//! Owns their shape and the numbers of errors. Knows no method.

use crate::limits;
use serde_json::{Value, json};

/// What is wrong with a request, with the number that the protocol has for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// The number.
    pub code: i32,
    /// A sentence for a person.
    pub reason: String,
}

/// The body is no JSON.
pub const PARSE_ERROR: i32 = -32700;
/// It is JSON and no message.
pub const INVALID_REQUEST: i32 = -32600;
/// Nobody knows the method.
pub const METHOD_NOT_FOUND: i32 = -32601;
/// The method is known and its parameters are not what it takes.
pub const INVALID_PARAMS: i32 = -32602;
/// Something was asked before `initialize`.
pub const NOT_INITIALIZED: i32 = -32002;
/// The client does not want the answer any more.
pub const CANCELLED: i32 = -32800;
/// The document has changed after the request.
pub const CONTENT_MODIFIED: i32 = -32801;
/// The request is right and cannot be done.
pub const FAILED: i32 = -32803;

impl Refusal {
    /// With its number and reason.
    pub fn new(code: i32, reason: impl Into<String>) -> Self {
        Self {
            code,
            reason: reason.into(),
        }
    }
}

/// What came.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// Wants an answer.
    Request {
        /// Names the answer.
        id: Value,
        /// What to do.
        method: String,
        /// With what.
        params: Value,
    },
    /// Wants none.
    Notification {
        /// What has happened.
        method: String,
        /// With what.
        params: Value,
    },
    /// An answer; this server asks nothing.
    Answer,
    /// No message.
    Bad(Value, Refusal),
}

impl Message {
    /// The message in the body of a frame.
    pub fn read(body: &[u8]) -> Self {
        let bad = |code, reason: String| Self::Bad(Value::Null, Refusal::new(code, reason));
        if !has_few_values(body) {
            let most = limits::LSP_VALUES;
            return bad(
                INVALID_REQUEST,
                format!("a message has at most {most} values"),
            );
        }
        match serde_json::from_slice(body) {
            Ok(Value::Object(all)) => Self::of(all),
            Ok(Value::Array(_)) => {
                let why = "the protocol has no batches: send messages one by one";
                bad(INVALID_REQUEST, why.to_owned())
            }
            Ok(_) => bad(INVALID_REQUEST, "a message is an object".to_owned()),
            Err(error) => bad(PARSE_ERROR, format!("this is no JSON: {error}")),
        }
    }

    fn of(mut all: serde_json::Map<String, Value>) -> Self {
        let id = all.remove("id");
        let params = all.remove("params").unwrap_or(Value::Null);
        let is_id = |id: &Value| {
            let text = id
                .as_str()
                .is_some_and(|text| text.len() <= limits::LSP_ID_BYTES);
            text || id.is_i64() || id.is_u64()
        };
        let (id, has_bad_id) = match id {
            Some(id) if is_id(&id) => (Some(id), false),
            Some(Value::Null) | None => (None, false),
            Some(_) => (None, true),
        };
        let bad = |id: Option<Value>, why: &str| {
            Self::Bad(
                id.unwrap_or(Value::Null),
                Refusal::new(INVALID_REQUEST, why),
            )
        };
        if has_bad_id {
            return bad(None, "an id is a whole number or a short text");
        }
        if all.get("jsonrpc").and_then(Value::as_str) != Some("2.0") {
            return bad(id, "jsonrpc must be \"2.0\"");
        }
        match (id, all.remove("method")) {
            (Some(id), Some(Value::String(method))) => Self::Request { id, method, params },
            (None, Some(Value::String(method))) => Self::Notification { method, params },
            (id, Some(_)) => bad(id, "method must be a text"),
            (_, None) if all.contains_key("result") || all.contains_key("error") => Self::Answer,
            (id, None) => bad(id, "there is no method"),
        }
    }
}

/// Whether a body has no more values than a message may have: each costs much more memory than its sign.
fn has_few_values(body: &[u8]) -> bool {
    let (mut values, mut is_text, mut is_escaped) = (0usize, false, false);
    for byte in body {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' if is_text => is_escaped = true,
            b'"' => is_text = !is_text,
            b',' | b':' | b'[' | b'{' if !is_text => values += 1,
            _ => {}
        }
    }
    values <= limits::LSP_VALUES
}

/// The answer to a request.
pub fn answer(id: &Value, result: Result<Value, Refusal>) -> Value {
    match result {
        Ok(result) => json!({"jsonrpc": "2.0", "id": id, "result": result}),
        Err(Refusal { code, reason }) => {
            json!({"jsonrpc": "2.0", "id": id, "error": {"code": code, "message": reason}})
        }
    }
}

/// News for the client.
pub fn notification(method: &str, params: Value) -> Value {
    json!({"jsonrpc": "2.0", "method": method, "params": params})
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_notifications_and_answers_are_told_apart() {
        let request = Message::read(br#"{"jsonrpc":"2.0","id":"a","method":"m","params":[1]}"#);
        assert_eq!(
            request,
            Message::Request {
                id: json!("a"),
                method: "m".into(),
                params: json!([1])
            }
        );
        let news = Message::read(br#"{"jsonrpc":"2.0","method":"m"}"#);
        assert!(matches!(
            news,
            Message::Notification {
                params: Value::Null,
                ..
            }
        ));
        let answer = Message::read(br#"{"jsonrpc":"2.0","id":1,"result":null}"#);
        assert_eq!(answer, Message::Answer);
    }

    #[test]
    fn what_is_no_message_says_why_and_keeps_its_id_if_it_has_one() {
        let deep = "[".repeat(100_000);
        let many = format!("[{}0]", "0,".repeat(limits::LSP_VALUES));
        for (body, id, code) in [
            ("", Value::Null, PARSE_ERROR),
            ("{", Value::Null, PARSE_ERROR),
            (deep.as_str(), Value::Null, PARSE_ERROR),
            (many.as_str(), Value::Null, INVALID_REQUEST),
            ("\"\u{0}\"", Value::Null, PARSE_ERROR),
            ("7", Value::Null, INVALID_REQUEST),
            ("[]", Value::Null, INVALID_REQUEST),
            (r#"{"id":7,"method":"m"}"#, json!(7), INVALID_REQUEST),
            (r#"{"jsonrpc":"2.0","id":7}"#, json!(7), INVALID_REQUEST),
            (
                r#"{"jsonrpc":"2.0","id":7,"method":7}"#,
                json!(7),
                INVALID_REQUEST,
            ),
            (
                r#"{"jsonrpc":"2.0","id":{},"method":"m"}"#,
                Value::Null,
                INVALID_REQUEST,
            ),
            (
                r#"{"jsonrpc":"2.0","id":1.5,"method":"m"}"#,
                Value::Null,
                INVALID_REQUEST,
            ),
        ] {
            match Message::read(body.as_bytes()) {
                Message::Bad(its, refusal) => {
                    let short: String = body.chars().take(50).collect();
                    assert_eq!((its, refusal.code), (id, code), "{short}");
                    assert!(!refusal.reason.is_empty());
                }
                Message::Request { .. } | Message::Notification { .. } | Message::Answer => {
                    panic!("{body} is understood")
                }
            }
        }
    }
}
