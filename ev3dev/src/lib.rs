//! A second mount that lays the devices of a trikfs tree out as the classes of ev3dev.
//!
//! It reads and writes files of the tree and nothing else: never a device. From the kernel inwards: `view` (the operations of
//! the mount), `table` (names and numbers), `scan` (what the tree has), `device` (what every device of a class is),
//! `motor`, `servo`, `sensor`, `fixed` (the devices), `tree` (files of the tree), `errno`.
//! Beside them: `cli`, `keeper` (the processes), `failure`, `limits`.

// A goal of a motor that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]
#![forbid(unsafe_code)]

pub mod cli;
pub mod device;
pub mod errno;
pub mod failure;
pub mod fixed;
pub mod keeper;
pub mod limits;
pub mod motor;
pub mod scan;
pub mod sensor;
pub mod servo;
pub mod table;
pub mod tree;
pub mod view;
