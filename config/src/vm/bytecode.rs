//! From source text to LuaJIT's bytecode, which every state of a program loads instead of the text.
//!
//! Owns the bytecode of our own Lua files, compiled once per process. Only text is ever compiled for a user; bytecode
//! never comes from outside.

use super::accessors;
use super::state::{State, text_of};
use crate::error::Error;
use crate::limits::LOAD_MEMORY_BYTES;
use mlua_sys as lua;
use std::collections::HashMap;
use std::ffi::{CString, c_int, c_void};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Bytecode of a chunk.
pub(crate) type Code = Arc<[u8]>;

/// Our own Lua files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Part {
    /// Makes the globals.
    Prelude,
    /// The global `id_create`.
    IdCreate,
    /// Globals that most converters do without.
    Rare,
    /// The string library.
    String,
    /// The table library.
    Table,
    /// The coroutine library.
    Coroutine,
    /// The source constructors.
    Sources,
    /// The global `filter`.
    Filter,
    /// What it finds the filters in.
    Filters,
    /// The global `dcml`.
    Dcml,
    /// The global `dataflow`.
    Dataflow,
    /// Digests functions.
    Fingerprint,
    /// Notes what every state has.
    Permanents,
    /// Writes what a node's converters reach.
    Persist,
}

impl Part {
    fn source(self) -> &'static str {
        match self {
            Self::Prelude => include_str!("../../lua/prelude.lua"),
            Self::IdCreate => include_str!("lua/id_create.lua"),
            Self::Rare => include_str!("lua/rare.lua"),
            Self::String => include_str!("lua/string.lua"),
            Self::Table => include_str!("lua/table.lua"),
            Self::Coroutine => include_str!("lua/coroutine.lua"),
            Self::Sources => include_str!("lua/sources.lua"),
            Self::Dcml => concat!(
                include_str!("lua/options.lua"),
                include_str!("lua/dcml.lua")
            ),
            Self::Dataflow => {
                concat!(
                    include_str!("lua/options.lua"),
                    include_str!("lua/dataflow.lua")
                )
            }
            Self::Fingerprint => include_str!("lua/fingerprint.lua"),
            Self::Permanents => include_str!("lua/permanents.lua"),
            Self::Persist => include_str!("lua/persist.lua"),
            Self::Filter => include_str!("lua/filter.lua"),
            Self::Filters => include_str!("../../lua/filters.lua"),
        }
    }

    /// The part's bytecode without names and lines, which would only take memory in every state.
    ///
    /// # Errors
    /// No memory.
    pub(crate) fn code(self) -> Result<Code, Error> {
        cached(&format!("{self:?}"), || {
            compile(&format!("={self:?}"), self.source().as_bytes(), true)
        })
    }
}

/// Bytecode that makes the typed accessor `ba.NAME`; None if there is no such type.
pub(crate) fn accessor(name: &str) -> Option<Result<Code, Error>> {
    let source = accessors::source(name)?;
    Some(cached(name, || compile("=ba", source.as_bytes(), true)))
}

fn cached(name: &str, make: impl FnOnce() -> Result<Code, Error>) -> Result<Code, Error> {
    static CODES: OnceLock<Mutex<HashMap<String, Code>>> = OnceLock::new();
    let mut codes = CODES
        .get_or_init(Mutex::default)
        .lock()
        .unwrap_or_else(PoisonError::into_inner);
    if let Some(code) = codes.get(name) {
        return Ok(Arc::clone(code));
    }
    let code = make()?;
    codes.insert(name.to_owned(), Arc::clone(&code));
    Ok(code)
}

/// Compiles a text. `chunk_name` is Lua's: `@FILE` or `=WORD`, at most 59 bytes or messages will cut it.
///
/// # Errors
/// Lua's message, `FILE:LINE: REASON`.
pub(crate) fn compile(chunk_name: &str, source: &[u8], strip: bool) -> Result<Code, Error> {
    if source.first() == Some(&0x1b) {
        return Err(Error::Script("bytecode is not loaded, only text".into()));
    }
    let chunk_name = CString::new(chunk_name);
    let chunk_name = chunk_name.map_err(|_| Error::Ours("the name holds a zero byte"))?;
    let state = State::bare(LOAD_MEMORY_BYTES)?;
    let mut code: Vec<u8> = Vec::new();
    let target: *mut Vec<u8> = &raw mut code;
    let failed = state.protect(&[], |l| {
        // SAFETY: `protect` gives a live state inside a protected call; the source outlives the call; `write_code` gets
        // the vector that lives in the caller's frame, outside of the protected call.
        unsafe {
            let (start, size) = (source.as_ptr().cast(), source.len());
            let mut status = lua::luaL_loadbuffer(l, start, size, chunk_name.as_ptr());
            if status == lua::LUA_OK && strip {
                strip_function(l);
                append_string(l, target);
            } else if status == lua::LUA_OK {
                status = lua::lua_dump(l, write_code, target.cast(), 0);
            }
            status != lua::LUA_OK
        }
    })?;
    if failed {
        return Err(Error::Script(text_of(&state)));
    }
    Ok(code.into())
}

/// Replaces the function on the top by the string of its bytecode without names and lines.
///
/// # Safety
/// Inside a protected call, with a Lua function on the top.
unsafe fn strip_function(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state; three stack places are always free in a C function.
    unsafe {
        lua::lua_pushcfunction(l, lua::luaopen_string);
        lua::lua_call(l, 0, 1);
        lua::lua_getfield(l, -1, c"dump".as_ptr());
        lua::lua_pushvalue(l, -3);
        lua::lua_pushboolean(l, 1);
        lua::lua_call(l, 2, 1);
    }
}

/// Appends the string on the top to the vector.
///
/// # Safety
/// As [`strip_function`], with a string on the top; `target` must be a live vector.
unsafe fn append_string(l: *mut lua::lua_State, target: *mut Vec<u8>) {
    let mut size = 0;
    // SAFETY: the caller vouches for both pointers; the string stays on the stack while its bytes are copied.
    unsafe {
        let start = lua::lua_tolstring(l, -1, &raw mut size);
        if !start.is_null() {
            (*target).extend_from_slice(std::slice::from_raw_parts(start.cast(), size));
        }
    }
}

/// Lua's writer for `lua_dump`.
unsafe extern "C-unwind" fn write_code(
    _state: *mut lua::lua_State,
    bytes: *const c_void,
    size: usize,
    target: *mut c_void,
) -> c_int {
    // SAFETY: `compile` passes its vector as the target, and Lua passes `size` readable bytes.
    unsafe {
        (*target.cast::<Vec<u8>>())
            .extend_from_slice(std::slice::from_raw_parts(bytes.cast(), size));
    }
    0
}
