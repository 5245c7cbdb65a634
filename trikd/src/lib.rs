//! `trikd`: the daemon of a robot that desktop clients, gamepads and programs talk to.
//!
//! One thread serves all sockets; programs run in child processes; the hardware is the mounted tree and nothing else.
//! `protocol` is bytes and values, `server` is sockets, `program` is child processes, `host` and `engine` are the
//! child's side, `brick` and `tree` are the robot.

pub mod access;
pub mod battery;
pub mod blame;
pub mod brick;
pub mod cli;
pub mod clients;
pub mod connection;
pub mod daemon;
pub mod diagram;
pub mod display;
pub mod engine;
pub mod error;
pub mod feedback;
pub mod fuzz;
pub mod guardian;
pub mod heartbeat;
pub mod host;
pub mod js;
pub mod keys;
pub mod limits;
pub mod log;
#[cfg(feature = "manual")]
pub mod manual;
pub mod outbox;
pub mod pace;
pub mod panics;
pub mod pictures;
pub mod priority;
pub mod program;
pub mod protocol;
pub mod record;
pub mod sampler;
pub mod scripts;
pub mod server;
pub mod settings;
pub mod standstill;
pub mod status;
pub mod tree;
