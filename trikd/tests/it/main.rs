//! `trikd` as clients and programs use it: raw bytes on real sockets, programs in real processes.
//!
//! Most tests have a plain directory instead of the tree; those in `board` have a virtual board. One binary, so
//! that linking happens once. Below is the table of contents.

/// Who may do what.
mod access;
/// With a virtual board and a mounted tree: rest within milliseconds, sensors that change.
mod board;
/// What the serving process leaves when it is killed.
mod crash;
/// Thousands of connections, bursts, floods.
mod crowds;
/// The debugger of diagrams, with several clients.
mod debugging;
/// The way of programs in Python to their debugger.
mod debugpy;
/// Diagrams of TRIK Studio.
mod diagrams;
/// What documents say, byte for byte.
mod documents;
/// Frames, good and bad, and the clocks of connections.
mod frames;
/// Any bytes for everything that decodes.
mod fuzz;
/// Gamepads.
mod gamepad;
/// What is given back after load.
mod growth;
/// Programs in JavaScript.
mod javascript;
/// JavaScript under the daemon, hostile programs, and what its document says.
mod javascript_served;
/// What Python and Lua have of the robot.
mod languages;
/// What stands in the log, and what cannot get there.
mod log;
/// Several robots.
mod mailbox;
/// The table of what the controller has.
mod official;
/// Mistakes of trikd itself.
mod panics;
/// Programs: how they are run, what they say, how they end.
mod programs;
/// A running trikd and its clients.
mod rig;
/// Status, variables, pictures, datagrams, discovery, and what is said at the start.
mod services;
/// Random clients and faults.
mod soak;
/// Uploads.
mod uploads;
/// New versions of a diagram that runs.
mod versions;
