//! Models in DCML for pages: a text as an editor asks about it, written in other languages, and solved.
//!
//! Owns what a page can ask, over places in the units of JavaScript's texts. What a text means is known to `lang-dcml`, what an
//! editor is told to `lang-editor`. `bindings` alone knows JavaScript. It is a module of its own beside that of diagrams, so that a
//! page loads what it needs.

#![deny(clippy::wildcard_enum_match_arm)]

#[cfg(target_family = "wasm")]
mod bindings;
pub mod course;
pub mod failure;
pub mod limits;
pub mod text;
mod units;
