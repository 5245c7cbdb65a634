//! Recordings of a robot's tree: what its nodes gave, when, and why they gave nothing.
//!
//! A recording is an MCAP file with the profile `ros2`: chunks with lz4, a summary, messages in CDR with schemas in ros2msg,
//! so that the tools of that world open it. Each node has a topic of its own name and a type made from its `format`.
//! Knows no FUSE, no tree, no network and no thread; time is an argument.
//!
//! - `layout`: the text of a `format` file, and a tuple as numbers
//! - `cdr`: values as bytes, and back
//! - `chunk`: a chunk of a file, record by record
//! - `schema`: names and texts of types
//! - `shape`: lengths inside records of a file
//! - `standard`: the types of other people that are used here
//! - `node`: one recorded node, its channel, its messages
//! - `write`, `read`, `mend`: files; `records`: what is in one that is still made
//! - `error`, `limits`, `fuzz`

#![forbid(unsafe_code)]
// A type of number or a kind of message that is forgotten must not be recorded as something else.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod cdr;
mod chunk;
pub mod error;
pub mod fuzz;
pub mod layout;
pub mod limits;
pub mod mend;
pub mod node;
pub mod read;
pub mod records;
pub mod schema;
mod shape;
pub mod standard;
pub mod write;
