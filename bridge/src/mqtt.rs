//! A tree for MQTT: newest values as retained messages, whether the robot is there, and commands.
//!
//! `topics` has the names, `values` what is told of nodes, `inbox` and `hands` what is asked for, `discovery` what Home Assistant
//! reads, `client` the connection. Who may publish what is the broker's list of rights; here a robot drives only for one who
//! goes on to say so.

pub mod client;
pub mod discovery;
pub mod hands;
pub mod inbox;
pub mod topics;
pub mod values;

/// Something for the broker.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// Where it goes.
    pub topic: String,
    /// What it says; nothing takes a retained one away.
    pub payload: Vec<u8>,
    /// The broker keeps it for those who come later.
    pub is_retained: bool,
    /// What the answer to a command repeats of it.
    pub correlation: Option<Vec<u8>>,
}

impl Message {
    /// One that is kept.
    pub fn retained(topic: String, payload: impl Into<Vec<u8>>) -> Self {
        Self {
            topic,
            payload: payload.into(),
            is_retained: true,
            correlation: None,
        }
    }
}
