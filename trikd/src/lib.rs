//! `trikd`: the daemon of a robot that desktop clients, gamepads and programs talk to.
//!
//! One thread serves all sockets; programs run in child processes; the hardware is the mounted tree and nothing else.
//! `protocol` is bytes and values, `server` is sockets, `program` is child processes, `host` and `engine` are the
//! child's side, `brick` and `tree` are the robot.

pub mod brick;
pub mod cli;
pub mod engine;
pub mod host;
pub mod js;
pub mod limits;
pub mod protocol;
#[doc(hidden)]
pub mod scratch;
pub mod tree;
