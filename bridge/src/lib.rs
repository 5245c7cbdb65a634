//! A mounted tree for tools of other people: Prometheus, Foxglove and MQTT.
//!
//! What is seen in a tree is `recorder`'s, and what a message is `journal`'s. Here is only what those tools ask for. Knows no
//! command and no robot; runs on a PC.
//!
//! - `follow`: a tree that may go and come back
//! - `prometheus`, `http`: numbers as a text, and the small server that gives it
//! - `foxglove`: channels, parameters and services, over WebSocket
//! - `mqtt`: newest values and commands, by way of a broker
//! - `error`, `limits`

#![forbid(unsafe_code)]
#![deny(clippy::wildcard_enum_match_arm)]

pub mod error;
pub mod follow;
pub mod foxglove;
pub mod http;
pub mod limits;
pub mod mqtt;
pub mod prometheus;
