//! What Lua code finds of the host: the functions that the prelude gets, and LuaJIT's libraries behind them.
//!
//! LuaJIT's own libraries live in the state's first table of globals, which no program sees: the prelude picks from it.
//! Every function here is called by Lua, keeps no value with a destructor across a call that can raise, and lets no
//! panic out.

use super::bytecode::{self, Code, Part};
use super::own::{self, forget_library, push_raw_library};
use super::pattern::{self, Capture, Match};
use super::state::Host;
use crate::error::Error;
use crate::limits::UNDEFINED_MAX;
use crate::source::is_constructor;
use mlua_sys as lua;
use std::ffi::{c_char, c_int};
use std::panic::catch_unwind;

/// Chunk name of our own code, which has no lines: messages begin with [`NO_PLACE`].
const CHUNK: &std::ffi::CStr = c"=trikfs";
/// What Lua puts before the message of an error in our own code.
pub(super) const NO_PLACE: &str = "trikfs:0: ";

/// Registry place of the function that turns the compiler on; 1 is taken by `State`.
const START_COMPILER: c_int = 2;

/// Opens the sandbox in a bare state: leaves the array maker and `params` on the stack and makes the new globals.
/// Gives Lua's status; the message is on the top if it is not LUA_OK.
///
/// # Safety
/// Inside a protected call on a state made with a `Host` as the allocator's user data.
pub(super) unsafe fn install(l: *mut lua::lua_State, prelude: &[u8]) -> c_int {
    // SAFETY: the caller vouches for the state; each push is matched by the counts given to the calls.
    unsafe {
        lua::lua_pushcfunction(l, lua::luaopen_base);
        lua::lua_call(l, 0, 0);
        let status =
            lua::luaL_loadbuffer(l, prelude.as_ptr().cast(), prelude.len(), CHUNK.as_ptr());
        if status != lua::LUA_OK {
            return status;
        }
        push_with_raw(l, start_compiler);
        lua::lua_rawseti_(l, lua::LUA_REGISTRYINDEX, START_COMPILER);
        own::keep_raw(l);
        lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
        push_with_raw(l, part);
        lua::lua_pushcfunction(l, accessor);
        push_with_raw(l, ffi);
        lua::lua_call(l, 4, 4);
        // The last is what strings find when they are indexed.
        lua::lua_createtable(l, 0, 1);
        lua::lua_insert(l, -2);
        lua::lua_setfield(l, -2, c"__index".as_ptr());
        lua::lua_pushlstring_(l, c"".as_ptr(), 0);
        lua::lua_insert(l, -2);
        lua::lua_setmetatable(l, -2);
        lua::lua_settop(l, -2);
        // globals, array, params -> array, params, nil for the tree
        lua::lua_pushvalue(l, -3);
        lua::lua_replace(l, lua::LUA_GLOBALSINDEX);
        lua::lua_remove(l, -3);
        lua::lua_pushnil(l);
        lua::LUA_OK
    }
}

/// The host of a state.
///
/// # Safety
/// The state must be live and made by `State::bare`.
pub(super) unsafe fn host<'a>(l: *mut lua::lua_State) -> &'a Host {
    let mut user_data = std::ptr::null_mut();
    // SAFETY: `State::bare` passes the address of its `Host`, which outlives the state, as the user data.
    unsafe {
        lua::lua_getallocf(l, &raw mut user_data);
        &*user_data.cast::<Host>()
    }
}

/// Pushes a function that can reach LuaJIT's own libraries: its first upvalue is their table.
unsafe fn push_with_raw(l: *mut lua::lua_State, function: lua::lua_CFunction) {
    // SAFETY: called by `install` while the first globals are still in place.
    unsafe {
        lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
        lua::lua_pushcclosure(l, function, 1);
    }
}

/// The bytes of argument `index`, converted like Lua does; raises an error if it is no string.
///
/// # Safety
/// In a function that Lua called. The bytes live as long as the argument is on the stack.
unsafe fn argument<'a>(l: *mut lua::lua_State, index: c_int) -> &'a [u8] {
    let mut size = 0;
    // SAFETY: `luaL_checklstring` gives readable bytes or does not return.
    unsafe {
        let start = lua::luaL_checklstring(l, index, &raw mut size);
        std::slice::from_raw_parts(start.cast(), size)
    }
}

unsafe fn push_bytes(l: *mut lua::lua_State, bytes: &[u8]) {
    // SAFETY: Lua copies the bytes.
    unsafe { lua::lua_pushlstring_(l, bytes.as_ptr().cast::<c_char>(), bytes.len()) };
}

/// `log(text)`
unsafe extern "C-unwind" fn log(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; the argument stays on the stack during the call.
    unsafe {
        let text = argument(l, 1);
        host(l).log(text);
    }
    0
}

/// Loads bytecode that `host.code` holds; pushes the function, or nil and the reason.
unsafe fn push_code(l: *mut lua::lua_State, found: Result<Code, Error>) -> c_int {
    let found = found.map_err(|error| error.to_string());
    // SAFETY: called from functions that Lua called. The code and the message are moved into the host before anything
    // here can raise an error, and stay there while Lua reads them: nothing else touches them before this returns.
    unsafe {
        let host = host(l);
        match found {
            Ok(code) => {
                let (start, size) = (code.as_ptr(), code.len());
                *host.code.borrow_mut() = Some(code);
                if lua::luaL_loadbuffer(l, start.cast(), size, CHUNK.as_ptr()) == lua::LUA_OK {
                    return 1;
                }
                lua::lua_pushnil(l);
                lua::lua_insert(l, -2);
            }
            Err(message) => {
                let (start, size) = (message.as_ptr(), message.len());
                *host.message.borrow_mut() = message;
                lua::lua_pushnil(l);
                lua::lua_pushlstring_(l, start.cast(), size);
            }
        }
    }
    2
}

/// `chunk(name)`: the function of an included file, or nil and the reason.
unsafe extern "C-unwind" fn chunk(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; the argument stays on the stack.
    unsafe {
        if lua::lua_type(l, 1) != lua::LUA_TSTRING {
            let refused = Error::Script("include wants the name of a file".to_owned());
            return push_code(l, Err(refused));
        }
        let name = argument(l, 1);
        push_code(l, host(l).include(name))
    }
}

/// `part(name)`: maker and its arguments for a global that is made on first use; nil and the value if it needs no maker;
/// nothing if there is no such global.
unsafe extern "C-unwind" fn part(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; upvalue 1 is the table of the raw libraries (`push_with_raw`).
    unsafe {
        if lua::lua_type(l, 1) != lua::LUA_TSTRING {
            return 0;
        }
        let raw = lua::lua_upvalueindex(1);
        match argument(l, 1) {
            b"math" => push_library(l, None, c"math", lua::luaopen_math),
            b"bit" => push_library(l, None, c"bit", lua::luaopen_bit),
            b"table" => {
                let made = push_library(l, Some(Part::Table), c"table", lua::luaopen_table);
                lua::lua_pushvalue(l, raw);
                made + 1
            }
            b"string" => {
                let made = push_library(l, Some(Part::String), c"string", lua::luaopen_string);
                lua::lua_pushvalue(l, raw);
                lua::lua_pushcfunction(l, string_find);
                lua::lua_pushcfunction(l, string_match);
                lua::lua_pushcfunction(l, string_scan);
                push_with_raw_of(l, library);
                made + 5
            }
            b"coroutine" => {
                push_maker(l, Part::Coroutine);
                lua::lua_getfield(l, raw, c"coroutine".as_ptr());
                lua::lua_pushvalue(l, raw);
                3
            }
            b"filter" => {
                push_maker(l, Part::Filter);
                lua::lua_pushvalue(l, raw);
                lua::lua_pushcfunction(l, filters);
                3
            }
            name @ (b"dataflow" | b"dcml" | b"include" | b"load" | b"loadstring" | b"print"
            | b"trikfs_log" | b"xpcall") => {
                push_maker(l, of_host(name));
                lua::lua_pushvalue(l, 1);
                lua::lua_pushvalue(l, raw);
                lua::lua_pushcfunction(l, log);
                lua::lua_pushcfunction(l, chunk);
                5
            }
            b"id_create" => {
                push_maker(l, Part::IdCreate);
                lua::lua_pushvalue(l, 1);
                lua::lua_pushvalue(l, raw);
                3
            }
            name if is_constructor(name) => {
                push_maker(l, Part::Sources);
                lua::lua_pushvalue(l, 1);
                lua::lua_pushvalue(l, raw);
                3
            }
            name => {
                let mut undefined = host(l).undefined.borrow_mut();
                let name = String::from_utf8_lossy(name);
                if undefined.len() < UNDEFINED_MAX && !undefined.iter().any(|known| *known == name)
                {
                    undefined.push(name.into_owned());
                }
                0
            }
        }
    }
}

/// The part that makes a global which needs the program around Lua.
fn of_host(name: &[u8]) -> Part {
    match name {
        b"dataflow" => Part::Dataflow,
        b"dcml" => Part::Dcml,
        _ => Part::Rare,
    }
}

/// `filters()`: the function that makes all filters.
unsafe extern "C-unwind" fn filters(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state.
    unsafe { push_maker(l, Part::Filters) };
    1
}

/// Pushes the same table of raw libraries into another function.
unsafe fn push_with_raw_of(l: *mut lua::lua_State, function: lua::lua_CFunction) {
    // SAFETY: called by functions whose upvalue 1 is the table.
    unsafe {
        lua::lua_pushvalue(l, lua::lua_upvalueindex(1));
        lua::lua_pushcclosure(l, function, 1);
    }
}

/// Pushes the function of one of our parts; raises an error if there is no memory.
unsafe fn push_maker(l: *mut lua::lua_State, part: Part) {
    // SAFETY: called by functions that Lua called.
    unsafe {
        if push_code(l, part.code()) == 2 {
            lua::lua_error(l);
        }
    }
}

/// Pushes a maker (or nil) and LuaJIT's own library; opens it if it is not open yet. Gives the number of values.
unsafe fn push_library(
    l: *mut lua::lua_State,
    maker: Option<Part>,
    name: &std::ffi::CStr,
    open: lua::lua_CFunction,
) -> c_int {
    // SAFETY: called by functions that Lua called whose upvalue 1 is the table of the raw libraries.
    unsafe {
        match maker {
            Some(part) => push_maker(l, part),
            None => lua::lua_pushnil(l),
        }
        push_raw_library(l, lua::lua_upvalueindex(1), name, open);
    }
    2
}

/// `library(name)`: LuaJIT's own table library.
unsafe extern "C-unwind" fn library(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; upvalue 1 is the table of the raw libraries.
    unsafe { push_raw_library(l, lua::lua_upvalueindex(1), c"table", lua::luaopen_table) };
    1
}

/// `ffi()`: LuaJIT's foreign function interface.
unsafe extern "C-unwind" fn ffi(l: *mut lua::lua_State) -> c_int {
    // SAFETY: as above.
    unsafe { push_raw_library(l, lua::lua_upvalueindex(1), c"ffi", lua::luaopen_ffi) };
    1
}

/// Turns the compiler on.
///
/// # Safety
/// Inside a protected call on a state where `install` ran.
pub(super) unsafe fn compile_from_here(l: *mut lua::lua_State) {
    // SAFETY: `install` put the function there.
    unsafe {
        lua::lua_rawgeti_(l, lua::LUA_REGISTRYINDEX, START_COMPILER);
        lua::lua_call(l, 0, 0);
    }
}

/// Turns the compiler on, with a memory budget for its code that suits a state per open file, and collects what is not
/// needed any more. The raw table must be upvalue 1.
///
/// One area of 16 KiB of code is touched at both ends, two pages, by a small converter; 128 KiB are enough for any
/// that people write by hand. A state that comes here converts a lot: a loop is hot early, because interpreted code
/// leaves garbage that compiled code does not, and the collector starts when a fifth was added to what it left.
unsafe extern "C-unwind" fn start_compiler(l: *mut lua::lua_State) -> c_int {
    // SAFETY: as above.
    unsafe {
        // The prelude has kept what it needs of the foreign function interface.
        forget_library(l, c"ffi");
        lua::lua_gc(l, lua::LUA_GCCOLLECT, 0);
        push_raw_library(l, lua::lua_upvalueindex(1), c"jit", lua::luaopen_jit);
        lua::lua_getfield(l, -1, c"opt".as_ptr());
        lua::lua_getfield(l, -1, c"start".as_ptr());
        lua::lua_pushstring_(l, c"hotloop=12".as_ptr());
        lua::lua_pushstring_(l, c"sizemcode=16".as_ptr());
        lua::lua_pushstring_(l, c"maxmcode=128".as_ptr());
        lua::lua_pushstring_(l, c"maxtrace=64".as_ptr());
        lua::lua_call(l, 4, 0);
        lua::lua_settop(l, 0);
        forget_library(l, c"jit");
        lua::lua_gc(l, lua::LUA_GCSETPAUSE, 120);
        lua::lua_gc(l, lua::LUA_GCCOLLECT, 0);
    }
    0
}

/// `accessor(type)`: the maker of a typed accessor, or nothing.
unsafe extern "C-unwind" fn accessor(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state.
    unsafe {
        if lua::lua_type(l, 1) != lua::LUA_TSTRING {
            return 0;
        }
        let Ok(name) = std::str::from_utf8(argument(l, 1)) else {
            return 0;
        };
        let Some(found) = bytecode::accessor(name) else {
            return 0;
        };
        if push_code(l, found) == 2 {
            lua::lua_error(l);
        }
    }
    1
}

/// Position from 1 or from the end (negative) to an offset from 0; beyond the end it stays beyond.
unsafe fn start_offset(l: *mut lua::lua_State, index: c_int, size: usize) -> usize {
    // SAFETY: called by functions that Lua called; `luaL_optnumber` gives a number or does not return.
    let init = unsafe { lua::luaL_optnumber(l, index, 1.0) };
    if init < 0.0 {
        // Saturating conversions: everything before the beginning is the beginning.
        size.saturating_sub(-init as usize)
    } else {
        (init as usize).saturating_sub(1)
    }
}

/// Runs the matcher; its panics are turned into an error.
fn search(
    subject: &[u8],
    pattern: &[u8],
    from: usize,
    anchors: bool,
) -> Result<Option<Match>, &'static str> {
    catch_unwind(|| pattern::find(subject, pattern, from, anchors))
        .unwrap_or(Err("pattern match failed inside"))
}

/// Pushes the captures, or the whole match if there are none and `whole` is set. Gives their number.
unsafe fn push_captures(
    l: *mut lua::lua_State,
    subject: &[u8],
    found: &Match,
    whole: bool,
) -> c_int {
    // SAFETY: called by functions that Lua called; at most 32 captures and the two positions fit into the stack space
    // that `luaL_checkstack` makes.
    unsafe {
        lua::luaL_checkstack_(l, 40, c"too many captures".as_ptr());
        let mut count = 0;
        for capture in found.captures() {
            match *capture {
                Capture::Text(from, to) => push_bytes(l, subject.get(from..to).unwrap_or_default()),
                Capture::Position(at) | Capture::Open(at) => {
                    lua::lua_pushnumber(l, (at + 1) as f64)
                }
            }
            count += 1;
        }
        if count == 0 && whole {
            push_bytes(l, subject.get(found.start..found.end).unwrap_or_default());
            count = 1;
        }
        count
    }
}

unsafe fn raise(l: *mut lua::lua_State, reason: &'static str) -> c_int {
    // SAFETY: called by functions that Lua called; the reason is static.
    unsafe {
        lua::luaL_where(l, 1);
        push_bytes(l, reason.as_bytes());
        lua::lua_concat(l, 2);
        lua::lua_error(l)
    }
}

/// `string.find(text, pattern, init, plain)`
unsafe extern "C-unwind" fn string_find(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; the arguments stay on the stack.
    unsafe {
        let (subject, pattern) = (argument(l, 1), argument(l, 2));
        let from = start_offset(l, 3, subject.len());
        let special = pattern.iter().any(|byte| b"^$*+?.([%-".contains(byte));
        if lua::lua_toboolean(l, 4) != 0 || !special {
            return match pattern::find_plain(subject, pattern, from) {
                Ok(Some(at)) => {
                    lua::lua_pushnumber(l, (at + 1) as f64);
                    lua::lua_pushnumber(l, (at + pattern.len()) as f64);
                    2
                }
                Ok(None) => {
                    lua::lua_pushnil(l);
                    1
                }
                Err(reason) => raise(l, reason),
            };
        }
        match search(subject, pattern, from, true) {
            Ok(Some(found)) => {
                lua::lua_pushnumber(l, (found.start + 1) as f64);
                lua::lua_pushnumber(l, found.end as f64);
                2 + push_captures(l, subject, &found, false)
            }
            Ok(None) => {
                lua::lua_pushnil(l);
                1
            }
            Err(reason) => raise(l, reason),
        }
    }
}

/// `string.match(text, pattern, init)`
unsafe extern "C-unwind" fn string_match(l: *mut lua::lua_State) -> c_int {
    // SAFETY: as above.
    unsafe {
        let (subject, pattern) = (argument(l, 1), argument(l, 2));
        let from = start_offset(l, 3, subject.len());
        match search(subject, pattern, from, true) {
            Ok(Some(found)) => push_captures(l, subject, &found, true),
            Ok(None) => {
                lua::lua_pushnil(l);
                1
            }
            Err(reason) => raise(l, reason),
        }
    }
}

/// `scan(text, pattern, from, anchors)`: first and last position and the captures, nil, or false and the reason.
unsafe extern "C-unwind" fn string_scan(l: *mut lua::lua_State) -> c_int {
    // SAFETY: as above.
    unsafe {
        let (subject, pattern) = (argument(l, 1), argument(l, 2));
        let from = start_offset(l, 3, subject.len());
        let anchors = lua::lua_toboolean(l, 4) != 0;
        match search(subject, pattern, from, anchors) {
            Ok(Some(found)) => {
                lua::lua_pushnumber(l, (found.start + 1) as f64);
                lua::lua_pushnumber(l, found.end as f64);
                2 + push_captures(l, subject, &found, true)
            }
            Ok(None) => {
                lua::lua_pushnil(l);
                1
            }
            Err(reason) => {
                lua::lua_pushboolean(l, 0);
                push_bytes(l, reason.as_bytes());
                2
            }
        }
    }
}
