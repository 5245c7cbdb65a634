//! Robots that are reached over the network, real or virtual: `trik run`, `set`, `watch`, `break`, `step`, `stop`, `status`, `send`.
//!
//! Owns nothing but its parts: `target` is which robot is meant, `roster` those of a class, `link` one connection, `upload` how a program gets there,
//! `run` follows one program, `live` changes it, `watch` shows it, `debugged` stops it, `relay` lets it in when it connects to a debugger here, `step` gives one order, `fleet` does something with several
//! robots at once, `output` is where a program's text goes, `person` who
//! answers its questions, `recorded` fetches recordings, `bridged` is what bridges ask, and `stories` what they hear.

pub(crate) mod bridged;
pub(crate) mod debugged;
pub(crate) mod fleet;
mod link;
pub(crate) mod live;
mod output;
pub(crate) mod person;
pub(crate) mod recorded;
mod relay;
pub(crate) mod roster;
pub(crate) mod run;
pub(crate) mod step;
pub(crate) mod stories;
pub(crate) mod target;
mod upload;
pub(crate) mod watch;
pub(crate) mod words;
