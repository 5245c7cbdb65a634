//! Lua states: a sandbox over LuaJIT's C interface.
//!
//! Owns everything that calls Lua. Outside this module Lua is bytes that go in and bytes or messages that come out.
//! The rules of the calls: whatever can raise a Lua error runs in a protected call, and no value with a destructor is
//! alive in a frame that an error may leave.

pub(crate) mod accessors;
pub(crate) mod bytecode;
pub(crate) mod extract;
pub(crate) mod fingerprint;
mod library;
pub(crate) mod memory;
mod own;
pub(crate) mod pattern;
pub(crate) mod persist;
pub(crate) mod restore;
pub(crate) mod stage;
pub(crate) mod state;
