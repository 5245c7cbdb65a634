//! The protocol of Foxglove over WebSocket: what clients say, and how they are answered.
//!
//! Owns the bytes of `foxglove.sdk.v1`, which are those of `foxglove.websocket.v1` too. Everything that comes from a client is
//! checked here. Knows no sockets, no robot and no meaning of names.

use crate::limits::{NAME_BYTES_MAX, NAMES_MAX};
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// The subprotocols that are spoken, in the order in which they are taken from a client's list.
pub const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// The encoding of arguments and results of services.
pub const JSON: &str = "json";

/// What a client asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Pairs of a number of the client's own, and that of a channel.
    Subscribe(Vec<(u32, u32)>),
    /// Numbers of the client's own.
    Unsubscribe(Vec<u32>),
    /// Parameters of these names, all if there are none; and a word that the answer repeats.
    GetParameters(Vec<String>, Option<String>),
    /// New values of parameters, and a word that the answer repeats.
    SetParameters(Vec<(String, Value)>, Option<String>),
    /// To be told of changes of these parameters, of all if there are none.
    WatchParameters(Vec<String>),
    /// Not to be told any more.
    UnwatchParameters(Vec<String>),
    /// To be told who publishes and who listens, or not any more.
    WatchGraph(bool),
    /// A call of a service: its number, that of the call, and the arguments.
    Call(u32, u32, Value),
}

/// Why something that a client says is none of these.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mistake {
    /// It is no object in JSON.
    NotJson,
    /// Nobody here does that.
    Unknown(String),
    /// A part is missing or no such thing.
    Part(&'static str),
    /// More than is taken at once.
    TooMany,
    /// A binary message of another kind or length.
    Binary,
    /// A call of a service whose arguments cannot be read; with both its numbers.
    Arguments(u32, u32),
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotJson => f.write_str("a message must be a JSON object with 'op'"),
            Self::Unknown(op) => write!(f, "this server does not know '{op}'"),
            Self::Part(part) => write!(f, "'{part}' is missing in a message, or is no such thing"),
            Self::TooMany => write!(f, "a message names more than {NAMES_MAX} things"),
            Self::Binary => f.write_str("an unknown binary message"),
            Self::Arguments(..) => f.write_str("arguments of services are JSON objects"),
        }
    }
}

impl std::error::Error for Mistake {}

/// A message in text.
///
/// # Errors
/// It is none that is known here.
pub fn text(text: &str) -> Result<Request, Mistake> {
    let Ok(Value::Object(message)) = serde_json::from_str::<Value>(text) else {
        return Err(Mistake::NotJson);
    };
    let op = message.get("op").and_then(Value::as_str);
    match op.ok_or(Mistake::NotJson)? {
        "subscribe" => {
            let all = list(&message, "subscriptions")?;
            let pair = |one: &Value| Some((number(one.get("id"))?, number(one.get("channelId"))?));
            let pairs: Option<Vec<_>> = all.iter().map(pair).collect();
            Ok(Request::Subscribe(
                pairs.ok_or(Mistake::Part("subscriptions"))?,
            ))
        }
        "unsubscribe" => {
            let all = list(&message, "subscriptionIds")?;
            let all: Option<Vec<u32>> = all.iter().map(|one| number(Some(one))).collect();
            Ok(Request::Unsubscribe(
                all.ok_or(Mistake::Part("subscriptionIds"))?,
            ))
        }
        "getParameters" => Ok(Request::GetParameters(names(&message)?, id(&message)?)),
        "setParameters" => {
            let all = list(&message, "parameters")?;
            let pair = |one: &Value| {
                let name = short(one.get("name")?)?;
                Some((name, one.get("value").cloned().unwrap_or(Value::Null)))
            };
            let pairs: Option<Vec<_>> = all.iter().map(pair).collect();
            let pairs = pairs.ok_or(Mistake::Part("parameters"))?;
            Ok(Request::SetParameters(pairs, id(&message)?))
        }
        "subscribeParameterUpdates" => Ok(Request::WatchParameters(names(&message)?)),
        "unsubscribeParameterUpdates" => Ok(Request::UnwatchParameters(names(&message)?)),
        "subscribeConnectionGraph" => Ok(Request::WatchGraph(true)),
        "unsubscribeConnectionGraph" => Ok(Request::WatchGraph(false)),
        other => Err(Mistake::Unknown(
            other.chars().take(NAME_BYTES_MAX).collect(),
        )),
    }
}

/// A binary message: a call of a service is the only one.
///
/// # Errors
/// It is none that is known here.
pub fn binary(bytes: &[u8]) -> Result<Request, Mistake> {
    let (head, rest) = bytes.split_at_checked(13).ok_or(Mistake::Binary)?;
    let word = |at: usize| {
        let four = head[at..at + 4].try_into();
        four.map_or(0, u32::from_le_bytes)
    };
    if head[0] != 2 {
        return Err(Mistake::Binary);
    }
    let (service, call) = (word(1), word(5));
    let length = usize::try_from(word(9)).unwrap_or(usize::MAX);
    let (encoding, payload) = rest.split_at_checked(length).ok_or(Mistake::Binary)?;
    let arguments = match (encoding == JSON.as_bytes(), payload) {
        (true, []) => Some(json!({})),
        (true, payload) => serde_json::from_slice(payload)
            .ok()
            .filter(Value::is_object),
        (false, _) => None,
    };
    let arguments = arguments.ok_or(Mistake::Arguments(service, call))?;
    Ok(Request::Call(service, call, arguments))
}

fn list<'a>(message: &'a Map<String, Value>, key: &'static str) -> Result<&'a [Value], Mistake> {
    let all = message.get(key).and_then(Value::as_array);
    let all = all.ok_or(Mistake::Part(key))?;
    match all.len() <= NAMES_MAX {
        true => Ok(all),
        false => Err(Mistake::TooMany),
    }
}

fn number(value: Option<&Value>) -> Option<u32> {
    u32::try_from(value?.as_u64()?).ok()
}

fn short(value: &Value) -> Option<String> {
    let text = value.as_str()?;
    (text.len() <= NAME_BYTES_MAX).then(|| text.to_owned())
}

fn names(message: &Map<String, Value>) -> Result<Vec<String>, Mistake> {
    let all = list(message, "parameterNames")?;
    let all: Option<Vec<String>> = all.iter().map(short).collect();
    all.ok_or(Mistake::Part("parameterNames"))
}

fn id(message: &Map<String, Value>) -> Result<Option<String>, Mistake> {
    match message.get("id") {
        None | Some(Value::Null) => Ok(None),
        Some(id) => short(id).map(Some).ok_or(Mistake::Part("id")),
    }
}

/// What is said of a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct About {
    /// Its topic.
    pub topic: String,
    /// The name of its type.
    pub schema_name: String,
    /// The text of its type.
    pub schema: String,
    /// What else is said of it.
    pub metadata: BTreeMap<String, String>,
}

/// The first message of a connection.
pub fn server_info(name: &str, session: &str) -> String {
    let capabilities = [
        "time",
        "connectionGraph",
        "parameters",
        "parametersSubscribe",
        "services",
    ];
    json!({
        "op": "serverInfo", "name": name, "capabilities": capabilities, "supportedEncodings": [JSON],
        "metadata": {}, "sessionId": session,
    })
    .to_string()
}

/// There are these channels, by number.
pub fn advertise<'a>(channels: impl Iterator<Item = (u32, &'a About)>) -> String {
    let all: Vec<Value> = channels
        .map(|(id, about)| {
            json!({
                "id": id, "topic": about.topic, "encoding": "cdr", "schemaName": about.schema_name,
                "schemaEncoding": "ros2msg", "schema": about.schema, "metadata": about.metadata,
            })
        })
        .collect();
    json!({"op": "advertise", "channels": all}).to_string()
}

/// These are gone.
pub fn unadvertise(channels: &[u32]) -> String {
    json!({"op": "unadvertise", "channelIds": channels}).to_string()
}

/// How much a status matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Something to know.
    Info = 0,
    /// Something may be wrong.
    Warning = 1,
    /// Something is wrong.
    Error = 2,
}

/// A sentence for the person; one with an id replaces the one before it, and can be taken back.
pub fn status(weight: Weight, message: &str, id: Option<&str>) -> String {
    let mut status = json!({"op": "status", "level": weight as u8, "message": message});
    if let (Some(id), Value::Object(members)) = (id, &mut status) {
        members.insert("id".to_owned(), id.into());
    }
    status.to_string()
}

/// Takes sentences back.
pub fn remove_status(ids: &[&str]) -> String {
    json!({"op": "removeStatus", "statusIds": ids}).to_string()
}

/// Values of parameters; one without a value is not there.
pub fn parameter_values(values: &[(String, Option<Value>)], id: Option<&str>) -> String {
    let one = |(name, value): &(String, Option<Value>)| {
        let mut one = json!({"name": name});
        if let (Some(value), Value::Object(members)) = (value, &mut one) {
            if value.is_f64() {
                // A whole one would be taken for an integer otherwise.
                members.insert("type".to_owned(), "float64".into());
            }
            members.insert("value".to_owned(), value.clone());
        }
        one
    };
    let all: Vec<Value> = values.iter().map(one).collect();
    let mut message = json!({"op": "parameterValues", "parameters": all});
    if let (Some(id), Value::Object(members)) = (id, &mut message) {
        members.insert("id".to_owned(), id.into());
    }
    message.to_string()
}

/// There are these services: numbers from 1, names, and the names of the texts that they take.
pub fn advertise_services(services: &[(&str, &[&str])]) -> String {
    let schema = |name: &str, texts: &[&str]| {
        let texts: Map<String, Value> = texts
            .iter()
            .map(|text| ((*text).to_owned(), json!({"type": "string"})))
            .collect();
        let text = json!({"type": "object", "properties": texts}).to_string();
        json!({"encoding": JSON, "schemaName": name, "schemaEncoding": "jsonschema", "schema": text})
    };
    let all: Vec<Value> = (1..)
        .zip(services)
        .map(|(id, (name, texts)): (u32, _)| {
            let kind = format!("trik/{}", name.trim_start_matches('/'));
            json!({
                "id": id, "name": name, "type": kind,
                "request": schema(&format!("{kind}_Request"), texts),
                "response": schema(&format!("{kind}_Response"), &[]),
            })
        })
        .collect();
    json!({"op": "advertiseServices", "services": all}).to_string()
}

/// A service could not do it.
pub fn call_failed(service: u32, call: u32, message: &str) -> String {
    json!({"op": "serviceCallFailure", "serviceId": service, "callId": call, "message": message})
        .to_string()
}

/// A service has done it.
pub fn call_done(service: u32, call: u32) -> Vec<u8> {
    let mut out = vec![3];
    out.extend(service.to_le_bytes());
    out.extend(call.to_le_bytes());
    out.extend((JSON.len() as u32).to_le_bytes());
    out.extend(JSON.as_bytes());
    out.extend(b"{}");
    out
}

/// A message for the subscription with this number.
pub fn message(subscription: u32, log_ns: u64, payload: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(13 + payload.len());
    out.push(1);
    out.extend(subscription.to_le_bytes());
    out.extend(log_ns.to_le_bytes());
    out.extend(payload);
    out
}

/// What time it is.
pub fn time(ns: u64) -> Vec<u8> {
    let mut out = vec![2];
    out.extend(ns.to_le_bytes());
    out
}

/// Who publishes, who listens, and who offers services: of each topic and service the names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Graph {
    /// Topics, all of one publisher.
    pub topics: BTreeSet<String>,
    /// Topics with those who listen.
    pub listened: BTreeMap<String, BTreeSet<String>>,
    /// Services, all of one provider.
    pub services: BTreeSet<String>,
}

/// How the graph differs from an earlier one; None if it does not.
pub fn graph_update(before: &Graph, now: &Graph, who: &str) -> Option<String> {
    if before == now {
        return None;
    }
    let new = now.topics.difference(&before.topics);
    let published: Vec<Value> = new
        .map(|topic| json!({"name": topic, "publisherIds": [who]}))
        .collect();
    let changed = |(topic, listeners): &(&String, &BTreeSet<String>)| {
        before.listened.get(*topic) != Some(*listeners)
    };
    let mut subscribed: Vec<Value> = now
        .listened
        .iter()
        .filter(changed)
        .map(|(topic, listeners)| json!({"name": topic, "subscriberIds": listeners}))
        .collect();
    let left = before.listened.keys();
    let left =
        left.filter(|topic| !now.listened.contains_key(*topic) && now.topics.contains(*topic));
    subscribed.extend(left.map(|topic| json!({"name": topic, "subscriberIds": []})));
    let offered = now.services.difference(&before.services);
    let offered: Vec<Value> = offered
        .map(|name| json!({"name": name, "providerIds": [who]}))
        .collect();
    let gone: Vec<&String> = before.topics.difference(&now.topics).collect();
    let withdrawn: Vec<&String> = before.services.difference(&now.services).collect();
    Some(
        json!({
            "op": "connectionGraphUpdate", "publishedTopics": published, "subscribedTopics": subscribed,
            "advertisedServices": offered, "removedTopics": gone, "removedServices": withdrawn,
        })
        .to_string(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_and_mistakes_are_told() {
        let subscribe =
            r#"{"op":"subscribe","subscriptions":[{"id":1,"channelId":7},{"id":2,"channelId":8}]}"#;
        assert_eq!(
            text(subscribe),
            Ok(Request::Subscribe(vec![(1, 7), (2, 8)]))
        );
        let set = r#"{"op":"setParameters","id":"x","parameters":[{"name":"a","value":1.5},{"name":"b"}]}"#;
        let values = vec![("a".to_owned(), json!(1.5)), ("b".to_owned(), Value::Null)];
        assert_eq!(
            text(set),
            Ok(Request::SetParameters(values, Some("x".to_owned())))
        );
        assert_eq!(
            text(r#"{"op":"subscribeConnectionGraph"}"#),
            Ok(Request::WatchGraph(true))
        );
        let deep = format!("{{\"op\":{}", "[".repeat(100_000));
        let long = format!(
            r#"{{"op":"getParameters","parameterNames":["{}"]}}"#,
            "a".repeat(9000)
        );
        let many = format!(
            r#"{{"op":"unsubscribe","subscriptionIds":[{}1]}}"#,
            "1,".repeat(NAMES_MAX)
        );
        for (message, mistake) in [
            ("", Mistake::NotJson),
            ("[]", Mistake::NotJson),
            (r#"{"op":7}"#, Mistake::NotJson),
            (&deep, Mistake::NotJson),
            (
                r#"{"op":"advertise"}"#,
                Mistake::Unknown("advertise".to_owned()),
            ),
            (r#"{"op":"subscribe"}"#, Mistake::Part("subscriptions")),
            (
                r#"{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}"#,
                Mistake::Part("subscriptions"),
            ),
            (
                r#"{"op":"unsubscribe","subscriptionIds":[4294967296]}"#,
                Mistake::Part("subscriptionIds"),
            ),
            (&long, Mistake::Part("parameterNames")),
            (&many, Mistake::TooMany),
        ] {
            assert_eq!(text(message), Err(mistake));
        }
    }

    #[test]
    fn calls_are_bytes_and_anything_else_is_none() {
        let call = b"\x02\x01\0\0\0\x09\0\0\0\x04\0\0\0json{\"file\":\"a\"}";
        assert_eq!(binary(call), Ok(Request::Call(1, 9, json!({"file": "a"}))));
        let bare = b"\x02\x01\0\0\0\x09\0\0\0\x04\0\0\0json";
        assert_eq!(binary(bare), Ok(Request::Call(1, 9, json!({}))));
        let other = b"\x02\x01\0\0\0\x09\0\0\0\x04\0\0\0ros1x";
        assert_eq!(binary(other), Err(Mistake::Arguments(1, 9)));
        for wrong in [
            &b""[..],
            b"\x02",
            &[1; 40],
            b"\x02\x01\0\0\0\x09\0\0\0\xff\xff\xff\xffjson",
        ] {
            assert_eq!(binary(wrong), Err(Mistake::Binary));
        }
    }

    #[test]
    fn answers_are_what_the_protocol_says() {
        let values = [
            ("a".to_owned(), Some(json!(2.0))),
            ("b".to_owned(), Some(json!(2))),
            ("c".to_owned(), None),
        ];
        let told: Value = serde_json::from_str(&parameter_values(&values, Some("x"))).unwrap();
        assert_eq!(
            told,
            json!({"op":"parameterValues","id":"x","parameters":[
                {"name":"a","value":2.0,"type":"float64"},{"name":"b","value":2},{"name":"c"}]})
        );
        assert_eq!(message(7, 9, b"ab"), b"\x01\x07\0\0\0\x09\0\0\0\0\0\0\0ab");
        assert_eq!(call_done(1, 2), b"\x03\x01\0\0\0\x02\0\0\0\x04\0\0\0json{}");
        let mut now = Graph::default();
        assert_eq!(graph_update(&Graph::default(), &now, "r"), None);
        now.topics.insert("/a".to_owned());
        let listeners = BTreeSet::from(["c".to_owned()]);
        now.listened.insert("/a".to_owned(), listeners);
        let told = graph_update(&Graph::default(), &now, "r").unwrap();
        assert!(told.contains(r#""subscriberIds":["c"]"#), "{told}");
        let told = graph_update(&now, &Graph::default(), "r").unwrap();
        assert!(told.contains(r#""removedTopics":["/a"]"#), "{told}");
    }
}
