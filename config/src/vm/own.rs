//! LuaJIT's own libraries, which no program sees: the prelude and its parts are made from them.
//!
//! Owns where their table is kept, and opening and releasing them.

use mlua_sys as lua;
use std::ffi::{CStr, c_int};

/// Registry place of LuaJIT's base library, which becomes the table of all of LuaJIT's own.
const RAW: c_int = 3;

/// Keeps the present globals as the table of LuaJIT's own libraries.
///
/// # Safety
/// Inside a protected call on a state whose globals are still LuaJIT's base library.
pub(super) unsafe fn keep_raw(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state.
    unsafe {
        lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
        lua::lua_rawseti_(l, lua::LUA_REGISTRYINDEX, RAW);
    }
}

/// Pushes LuaJIT's own library `name`, opening it with the raw table as the globals if need be. `raw` is that table's place,
/// which does not count from the top.
///
/// # Safety
/// Inside a protected call.
pub(super) unsafe fn push_raw_library(
    l: *mut lua::lua_State,
    raw: c_int,
    name: &CStr,
    open: lua::lua_CFunction,
) {
    // SAFETY: the caller is in a protected call. The globals are put back whether opening succeeds or not.
    unsafe {
        lua::lua_getfield(l, raw, name.as_ptr());
        if lua::lua_type(l, -1) != lua::LUA_TNIL {
            return;
        }
        lua::lua_settop(l, -2);
        lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
        lua::lua_pushcfunction(l, open);
        lua::lua_pushstring_(l, name.as_ptr());
        lua::lua_pushvalue(l, raw);
        lua::lua_replace(l, lua::LUA_GLOBALSINDEX);
        let status = lua::lua_pcall(l, 1, 1, 0);
        lua::lua_pushvalue(l, -2);
        lua::lua_replace(l, lua::LUA_GLOBALSINDEX);
        lua::lua_remove(l, -2);
        if status != lua::LUA_OK {
            lua::lua_error(l);
        }
        // `luaopen_ffi` gives its table and makes no global; `luaopen_jit` makes a global and gives something else.
        if lua::lua_type(l, -1) == lua::LUA_TTABLE {
            lua::lua_pushvalue(l, -1);
            lua::lua_setfield(l, raw, name.as_ptr());
        } else {
            lua::lua_settop(l, -2);
            lua::lua_getfield(l, raw, name.as_ptr());
        }
    }
}

/// Releases a library that is not needed again. The raw table must be upvalue 1.
///
/// # Safety
/// In a function that Lua called.
pub(super) unsafe fn forget_library(l: *mut lua::lua_State, name: &CStr) {
    // SAFETY: called by functions whose upvalue 1 is the table of the raw libraries.
    unsafe {
        lua::lua_pushnil(l);
        lua::lua_setfield(l, lua::lua_upvalueindex(1), name.as_ptr());
        for list in [c"_LOADED", c"_PRELOAD"] {
            lua::lua_pushnil(l);
            lua::lua_setfield(l, lua::LUA_REGISTRYINDEX, list.as_ptr());
        }
    }
}

/// Pushes LuaJIT's base library.
///
/// # Safety
/// Inside a protected call on a state with the sandbox.
pub(super) unsafe fn push_raw(l: *mut lua::lua_State) {
    // SAFETY: `keep_raw` put the table there.
    unsafe {
        lua::lua_rawgeti_(l, lua::LUA_REGISTRYINDEX, RAW);
    }
}

/// Pushes one of LuaJIT's own libraries.
unsafe fn push_own(l: *mut lua::lua_State, name: &CStr, open: lua::lua_CFunction) {
    // SAFETY: the caller is in a protected call on a state with the sandbox.
    unsafe {
        push_raw(l);
        let raw = lua::lua_gettop(l);
        push_raw_library(l, raw, name, open);
        lua::lua_remove(l, raw);
    }
}

/// Pushes LuaJIT's debug library.
///
/// # Safety
/// As [`push_raw`].
pub(super) unsafe fn push_debug(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state.
    unsafe { push_own(l, c"debug", lua::luaopen_debug) };
}

/// Pushes LuaJIT's string library, which has `dump` until a program uses strings; then the base library has it.
///
/// # Safety
/// As [`push_raw`].
pub(super) unsafe fn push_string(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state.
    unsafe { push_own(l, c"string", lua::luaopen_string) };
}

/// Pushes `jit.util.funck`, which gives the constants of a function.
///
/// # Safety
/// As [`push_raw`].
pub(super) unsafe fn push_constants(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state. `luaopen_jit` registers the opener of `jit.util` as a preload function.
    unsafe {
        push_own(l, c"jit", lua::luaopen_jit);
        lua::lua_settop(l, -2);
        lua::lua_getfield(l, lua::LUA_REGISTRYINDEX, c"_PRELOAD".as_ptr());
        lua::lua_getfield(l, -1, c"jit.util".as_ptr());
        lua::lua_remove(l, -2);
        lua::lua_call(l, 0, 1);
        lua::lua_getfield(l, -1, c"funck".as_ptr());
        lua::lua_remove(l, -2);
    }
}

/// Pushes the table library, LuaJIT's own or what ours made of it.
///
/// # Safety
/// As [`push_raw`].
pub(super) unsafe fn push_table(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state.
    unsafe { push_own(l, c"table", lua::luaopen_table) };
}
