//! What a browser and this server say to each other beside the control port: JSON objects.
//!
//! Owns their forms; `page/app/src/link/words.ts` has the other end. Pure.

use crate::control::Browser;
use crate::error::Error;
use crate::inside::Stages;
use crate::limits;
use lang_text::problem::{Locale, Words};
use serde_json::{Map, Value};

/// What a value is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// The node.
    pub path: String,
    /// A number of its converters; None: its own value.
    pub param: Option<String>,
}

/// What a browser wants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// A value for an actuator, or for a number of a node's converters, as text.
    Write(Target, String),
    /// To see the inside of a node, or of none any more.
    Inspect(Option<String>),
    /// An order to the world, in words.
    World(String),
    /// An order to the recording that is played, in words.
    Playback(String),
    /// Another configuration of the tree.
    Configure(String),
    /// A program goes.
    Remove(String),
    /// A program has another name.
    Rename(String, String),
    /// To see the world, or not any more: it costs time at every picture.
    Look(bool),
    /// To be in control, also if another browser is.
    Take,
    /// Not to be in control any more.
    Leave,
    /// A pairing code that somebody has typed.
    Pair(String),
    /// Everything to rest. Everybody may.
    Stop,
}

impl Order {
    /// Reads one.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let why = || Error::Words(text.chars().take(limits::REPEATED_MAX).collect());
        if text.len() > limits::WORLD_BYTES_MAX {
            return Err(why());
        }
        let is_long = text.len() > limits::WORDS_BYTES_MAX;
        let value: Value = serde_json::from_str(text).map_err(|_| why())?;
        let text = |name: &str| value.get(name).and_then(Value::as_str).map(str::to_owned);
        let order = match text("do").ok_or_else(why)?.as_str() {
            "write" => {
                let (path, param) = (text("path").ok_or_else(why)?, text("param"));
                Self::Write(Target { path, param }, text("value").ok_or_else(why)?)
            }
            "inspect" => Self::Inspect(text("path")),
            "world" => Self::World(text("order").ok_or_else(why)?),
            "playback" => Self::Playback(text("order").ok_or_else(why)?),
            "configure" => Self::Configure(text("text").ok_or_else(why)?),
            "remove" => Self::Remove(text("name").ok_or_else(why)?),
            "rename" => Self::Rename(text("name").ok_or_else(why)?, text("to").ok_or_else(why)?),
            "look" => Self::Look(
                value
                    .get("world")
                    .and_then(Value::as_bool)
                    .ok_or_else(why)?,
            ),
            "take" => Self::Take,
            "leave" => Self::Leave,
            "pair" => Self::Pair(text("code").ok_or_else(why)?),
            "stop" => Self::Stop,
            _ => return Err(why()),
        };
        // Only what a person has in a file may be long.
        if is_long && !matches!(order, Self::World(_) | Self::Configure(_)) {
            return Err(why());
        }
        Ok(order)
    }
}

/// What a browser is told.
#[derive(Clone, Debug, PartialEq)]
pub enum News {
    /// Who it talks to.
    Hello {
        /// The robot.
        name: String,
        /// Of this server.
        version: String,
        /// There is a world around the robot.
        has_world: bool,
        /// It takes orders.
        orders_world: bool,
        /// The studio is served beside it.
        has_studio: bool,
        /// This computer may do things.
        may_drive: bool,
        /// The configuration may be replaced from here.
        configures: bool,
    },
    /// The browser that is in control.
    Control {
        /// This browser.
        mine: bool,
        /// The address of the one who is; None if nobody is.
        who: Option<String>,
    },
    /// Whether the control port of the robot is reached; None if it is, else why not.
    Robot(Option<String>),
    /// A value was written, or not.
    Written {
        /// Where.
        target: Target,
        /// What should have been written.
        value: String,
        /// Why it was not.
        why: Option<Words>,
    },
    /// The inside of the node that this browser wants to see.
    Stages(Stages),
    /// The configuration was replaced, or not and why.
    Configured(Option<Words>),
    /// A program has another name; None: it is gone.
    Programs(String, Option<String>),
    /// This computer may do things from now on; or a pairing code was refused, and why.
    Paired(Option<Words>),
    /// Something was not done.
    Refused(Words),
    /// What stands still in the world.
    Scene(String),
    /// What moves.
    World(String),
    /// Where the recording is that is played.
    Playback(String),
    /// The server is there: a page cannot see pings.
    Beat,
}

impl News {
    /// About who is in control, for this browser.
    pub fn control(holder: Option<Browser>, me: Browser) -> Self {
        Self::Control {
            mine: holder == Some(me),
            who: holder.map(|who| who.address.ip().to_string()),
        }
    }

    /// As JSON, with sentences in a language.
    pub fn text(&self, locale: Locale) -> String {
        let said = |why: &Option<Words>| -> Value {
            why.as_ref()
                .map_or(Value::Null, |why| why.in_locale(locale).into())
        };
        match self {
            Self::Hello {
                name,
                version,
                has_world,
                orders_world,
                has_studio,
                may_drive,
                configures,
            } => object(
                "hello",
                vec![
                    ("name", name.as_str().into()),
                    ("version", version.as_str().into()),
                    ("world", (*has_world).into()),
                    ("orders", (*orders_world).into()),
                    ("studio", (*has_studio).into()),
                    ("drives", (*may_drive).into()),
                    ("configures", (*configures).into()),
                ],
            ),
            Self::Control { mine, who } => object(
                "control",
                vec![("mine", (*mine).into()), ("who", who.clone().into())],
            ),
            Self::Robot(why) => object(
                "robot",
                vec![("there", why.is_none().into()), ("why", why.clone().into())],
            ),
            Self::Written { target, value, why } => object(
                "written",
                vec![
                    ("path", target.path.as_str().into()),
                    ("param", target.param.clone().into()),
                    ("value", value.as_str().into()),
                    ("why", said(why)),
                ],
            ),
            Self::Stages(Stages { path, at, tuples }) => object(
                "stages",
                vec![
                    ("path", path.as_str().into()),
                    ("at_s", at.as_secs_f64().into()),
                    ("tuples", tuples.clone().into()),
                ],
            ),
            Self::Configured(why) => object("configured", vec![("why", said(why))]),
            Self::Paired(why) => object("paired", vec![("why", said(why))]),
            Self::Refused(why) => object("refused", vec![("why", why.in_locale(locale).into())]),
            Self::Programs(name, to) => object(
                "programs",
                vec![("name", name.as_str().into()), ("to", to.clone().into())],
            ),
            Self::Beat => object("beat", Vec::new()),
            // These are JSON already.
            Self::Scene(scene) => format!("{{\"is\":\"scene\",\"scene\":{scene}}}"),
            Self::Playback(state) => format!("{{\"is\":\"playback\",\"state\":{state}}}"),
            Self::World(state) => format!("{{\"is\":\"world\",\"state\":{state}}}"),
        }
    }
}

/// News of a kind, with these members.
fn object(is: &str, members: Vec<(&str, Value)>) -> String {
    let mut all = Map::new();
    all.insert("is".to_owned(), is.into());
    let members = members.into_iter();
    all.extend(members.map(|(name, value)| (name.to_owned(), value)));
    Value::Object(all).to_string()
}

/// Whether a request of the control port only looks, so that every browser may send it; the port has many more that change
/// something, and what is not known here does.
pub fn only_looks(request: &[u8]) -> bool {
    let plain = [
        "version",
        "configVersion",
        "watch",
        "unwatch",
        "status",
        "keepalive",
        "stop",
    ];
    if plain.iter().any(|word| request == word.as_bytes()) || request.starts_with(b"stream:") {
        return true;
    }
    let Some(order) = request.strip_prefix(b"debug:") else {
        return false;
    };
    let order = order
        .splitn(2, |&byte| byte == b' ')
        .nth(1)
        .unwrap_or_default();
    let first = order.split(|&byte| byte == b' ').next().unwrap_or_default();
    let looks: [&[u8]; 4] = [b"look", b"evaluate", b"breakpoints", b"leave"];
    looks.contains(&first)
}

/// Whether a request asks for the past of the robot. It changes nothing that moves, so it needs no control, but the robot sends
/// it to paired computers only.
pub fn looks_back(request: &[u8]) -> bool {
    request == b"box"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_read_and_rubbish_is_none() {
        let write = |param: Option<&str>| {
            let (path, param) = ("motors/M1".to_owned(), param.map(str::to_owned));
            Order::Write(Target { path, param }, "30".to_owned())
        };
        for (text, order) in [
            (
                r#"{"do":"write","path":"motors/M1","value":"30"}"#,
                write(None),
            ),
            (
                r#"{"do":"write","path":"motors/M1","param":"gain","value":"30"}"#,
                write(Some("gain")),
            ),
            (
                r#"{"do":"inspect","path":"m"}"#,
                Order::Inspect(Some("m".to_owned())),
            ),
            (r#"{"do":"inspect","path":null}"#, Order::Inspect(None)),
        ] {
            assert_eq!(Order::parse(text).unwrap(), order);
        }
        assert_eq!(
            Order::parse(r#"{"do":"look","world":true}"#).unwrap(),
            Order::Look(true)
        );
        assert_eq!(Order::parse(r#"{"do":"stop"}"#).unwrap(), Order::Stop);
        assert_eq!(
            Order::parse(r#"{"do":"pair","code":"123456"}"#).unwrap(),
            Order::Pair("123456".to_owned())
        );
        for bad in [
            "",
            "{}",
            "[]",
            "null",
            r#"{"do":"write","path":"a"}"#,
            r#"{"do":"write","path":"a","value":30}"#,
            r#"{"do":"look","world":1}"#,
            r#"{"do":"fly"}"#,
            r#"{"do":"pair","code":123456}"#,
            &format!(
                r#"{{"do":"world","order":"{}"}}"#,
                "x".repeat(limits::WORLD_BYTES_MAX)
            ),
            &format!(
                r#"{{"do":"write","path":"a","value":"{}"}}"#,
                "x".repeat(limits::WORDS_BYTES_MAX)
            ),
        ] {
            assert!(Order::parse(bad).is_err(), "{:.80}", bad);
        }
        let world = "x".repeat(limits::WORDS_BYTES_MAX);
        let long = format!(r#"{{"do":"world","order":"{world}"}}"#);
        assert_eq!(Order::parse(&long).unwrap(), Order::World(world));
    }

    #[test]
    fn what_changes_something_needs_control() {
        for looks in [
            "version",
            "stop",
            "stream:;hz=30",
            "debug:1 look",
            "debug:2 evaluate n + 1",
            "debug:3 breakpoints after 4",
        ] {
            assert!(only_looks(looks.as_bytes()), "{looks}");
        }
        for acts in [
            "run:a.js",
            "file:a.js:x",
            "direct:x",
            "set:n=5",
            "patch:end:a.qrs",
            "debug:1 continue",
            "debug:1 lookout",
            "debug:look",
            "stopp",
            "answer:1:x",
            "box",
            "",
            "versionx",
        ] {
            assert!(!only_looks(acts.as_bytes()), "{acts}");
        }
        assert!(looks_back(b"box") && !looks_back(b"boxes"));
    }

    #[test]
    fn news_are_json() {
        let all = [
            News::Hello {
                name: "a\"b".to_owned(),
                version: "1".to_owned(),
                has_world: true,
                orders_world: false,
                has_studio: true,
                may_drive: false,
                configures: false,
            },
            News::Control {
                mine: false,
                who: None,
            },
            News::Robot(Some("gone".to_owned())),
            News::Stages(Stages {
                path: "m".to_owned(),
                at: std::time::Duration::from_millis(1500),
                tuples: vec!["00".to_owned()],
            }),
            News::Written {
                target: Target {
                    path: "m".to_owned(),
                    param: Some("gain".to_owned()),
                },
                value: "1".to_owned(),
                why: None,
            },
            News::Configured(None),
            News::Refused(Words::new("no", "net")),
            News::Scene("{\"walls\":[]}".to_owned()),
            News::World("{\"t\":1}".to_owned()),
            News::Playback("{\"at_s\":1}".to_owned()),
            News::Beat,
        ];
        for news in all {
            let text = news.text(Locale::English);
            let value: Value = serde_json::from_str(&text).unwrap();
            assert!(value["is"].is_string(), "{text}");
        }
        let refused = News::Refused(Words::new("no", "net")).text(Locale::Russian);
        assert_eq!(refused, "{\"is\":\"refused\",\"why\":\"net\"}");
    }
}
