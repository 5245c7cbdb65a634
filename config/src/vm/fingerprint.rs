//! Digests of the functions of a configuration: their code, what they close over, and the globals that they name.
//!
//! Owns the hash. Equal digests let a reload keep open files; a digest that differs without need only costs a reopening.

use super::bytecode::Part;
use super::own;
use super::persist;
use super::state::{State, text_of};
use crate::error::Error;
use crate::limits::LOAD_TIME_MS;
use crate::value::Values;
use mlua_sys as lua;
use std::ffi::c_int;
use std::hash::{DefaultHasher, Hasher};

/// A hash of 128 bits, not for secrets: two runs of the standard library's SipHash with different beginnings.
pub(crate) fn hash(bytes: &[u8]) -> u128 {
    let half = |first: u8| {
        let mut hasher = DefaultHasher::new();
        hasher.write_u8(first);
        hasher.write(bytes);
        u128::from(hasher.finish())
    };
    half(1) << 64 | half(2)
}

/// Fills in the digests of all functions. The list of functions that `extract` made must be on the top of the stack;
/// it is taken off. Where no digest can be made, `salt` stands in, which must differ when the program's text does.
pub(crate) fn digest_functions(state: &mut State, values: &mut Values, salt: u128) {
    let digests = digests(state, salt).unwrap_or_default();
    for (function, index) in values.functions.iter_mut().zip(0usize..) {
        let bytes = digests
            .get(index * 16..(index + 1) * 16)
            .and_then(|bytes| bytes.try_into().ok());
        function.digest = bytes.map_or(salt, u128::from_le_bytes);
    }
}

fn digests(state: &mut State, salt: u128) -> Result<Vec<u8>, Error> {
    let l = state.raw();
    // SAFETY: the state is live.
    let list = unsafe { lua::lua_gettop(l) };
    let code = Part::Fingerprint.code()?;
    let bytes: &[u8] = &code;
    let salt = salt.to_le_bytes();
    let pushed = state.protect(&[list], |l| {
        // SAFETY: inside a protected call with the list as the first value; the bytes outlive it.
        unsafe {
            lua::luaL_checkstack_(l, 16, c"no stack".as_ptr());
            lua::luaL_loadbuffer(l, bytes.as_ptr().cast(), bytes.len(), c"=trikfs".as_ptr());
            lua::lua_pushvalue(l, 1);
            lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
            persist::push_pristine(l);
            lua::lua_pushlstring_(l, salt.as_ptr().cast(), salt.len());
            own::push_raw(l);
            own::push_string(l);
            own::push_debug(l);
            own::push_constants(l);
            lua::lua_pushcfunction(l, digest);
            own::push_table(l);
        }
    });
    let result = match pushed {
        Ok(()) if state.call(10, 1, LOAD_TIME_MS.saturating_mul(1_000)) => {
            let mut size = 0;
            // SAFETY: the call left one value; its bytes are copied while it is on the stack.
            unsafe {
                match lua::lua_type(l, -1) {
                    lua::LUA_TSTRING => {
                        let start = lua::lua_tolstring(l, -1, &raw mut size);
                        Ok(std::slice::from_raw_parts(start.cast::<u8>(), size).to_vec())
                    }
                    _ => Err(Error::Ours("no digests")),
                }
            }
        }
        Ok(()) => Err(Error::Script(text_of(state))),
        Err(reason) => Err(reason),
    };
    // SAFETY: takes off the result and the list.
    unsafe { lua::lua_settop(l, list - 1) };
    result
}

/// `digest(text)`: 16 bytes.
unsafe extern "C-unwind" fn digest(l: *mut lua::lua_State) -> c_int {
    let mut size = 0;
    // SAFETY: Lua calls with a live state; `luaL_checklstring` gives readable bytes or does not return.
    unsafe {
        let start = lua::luaL_checklstring(l, 1, &raw mut size);
        let digest = hash(std::slice::from_raw_parts(start.cast(), size)).to_le_bytes();
        lua::lua_pushlstring_(l, digest.as_ptr().cast(), digest.len());
    }
    1
}
