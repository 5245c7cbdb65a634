//! A page in the browser for one robot: its sensors, its programs and the world around it.
//!
//! The page itself is in `page/app`, in TypeScript; here is what serves it. It knows a robot by three things only: the files of
//! its tree, its control port, and, for a virtual one, the [`World`] around it. What goes over the control port is passed on and
//! hardly looked at: the page speaks it as every other client does.
//!
//! - `server`, `serving`, `door`, `route`: the page, its thread, connections, and which address gives what
//! - `class`, `marks`: the pages of many robots and of marks that come; `room`: how they are served, alone or together
//! - `seats`, `admission`: which connections have a place and which lose it; the places of browsers
//! - `guard`, `gate`: Host, Origin and the cookie, and what all requests pass
//! - `files`: the page as it was built, in the program; `plain`: a table where there is none
//! - `browser`, `word`, `relay`: one browser that looks, what it says, and its connection to the robot
//! - `shared`, `guests`, `control`: what all requests share; which computers may what; one of all browsers drives
//! - `drive`: what it writes to the tree, and rest when it leaves; `inside`: the converters of a node that it looks into;
//!   `tree`: files of the tree as both open them
//! - `store`, `diagrams`, `flows`: programs of the robot; diagrams and data-flow programs as pictures, and what stands in their
//!   blocks
//! - `studio`: the files of the studio, in which diagrams are drawn
//! - `world`, `playback`: borders to a simulator and to a player of recordings
//! - `error`, `words`, `limits`

#![forbid(unsafe_code)]
#![deny(clippy::wildcard_enum_match_arm)]

mod admission;
mod browser;
pub mod class;
#[cfg(test)]
mod client;
mod configuration;
mod control;
mod diagrams;
mod door;
mod drive;
pub mod error;
mod files;
mod flows;
mod gate;
mod guard;
mod guests;
mod inside;
pub mod limits;
pub mod marks;
mod plain;
pub mod playback;
mod relay;
mod room;
mod route;
pub mod seats;
mod server;
mod serving;
mod shared;
mod store;
pub mod studio;
mod tree;
mod word;
mod words;
pub mod world;

pub use guests::{Everybody, Guests, NotPaired};
pub use server::Page;
pub use shared::Settings;
