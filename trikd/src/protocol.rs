//! What goes over the wires, as plain functions between bytes and values: no sockets, no clocks, no files.

pub mod control;
pub mod dns;
pub mod gamepad;
pub mod http;
pub mod mail;
pub mod news;
pub mod program;
pub mod telemetry;
