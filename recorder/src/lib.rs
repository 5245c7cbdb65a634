//! What happens in a mounted tree: for a recording, for a black box that keeps the last minutes, and for live streams.
//!
//! A tree is looked at from outside, through its rings of samples, its log and its texts, so nobody who samples or reads is
//! delayed. Knows no command, no network and no program of a robot; those who do hand their own lines over.
//!
//! - `entry`: something for a recording
//! - `nodes`, `watch`, `watched`: what a tree has, and what happens in it
//! - `raw`: what sources give, before it is converted
//! - `world`: what a virtual robot tells of the world around it
//! - `pen`: entries as messages of one recording
//! - `standard`: nodes as messages that other people's tools know
//! - `file`: the thread that writes them to a disk
//! - `kept`: the last minutes, as a ring of files
//! - `stream`: entries as bytes for one client, with its patterns and its rate
//! - `live`: entries as messages for other forms
//! - `desk`: the thread that looks, and all who take what it sees
//! - `pattern`, `error`, `limits`

#![forbid(unsafe_code)]
// An entry that is forgotten must not be lost in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod clock;
pub mod desk;
pub mod entry;
pub mod errno;
pub mod error;
pub mod file;
pub mod kept;
pub mod limits;
pub mod live;
pub mod nodes;
pub mod pattern;
mod pen;
mod raw;
mod standard;
pub mod stream;
pub mod watch;
mod watched;
pub mod world;

pub use standard::place_units;
