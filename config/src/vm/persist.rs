//! The state in which a configuration ran once, and the images of what single nodes reach in it.
//!
//! Owns the encoding of an image and the state that images are made from; restore.rs reads them. What is reached is found
//! by lua/persist.lua. Knows nothing of files that are open.
//!
//! An image is two lists of operations, each a number and its arguments: the first makes objects, which are numbered from
//! 1 in this order, the second fills them. Every value begins with a byte that says what it is (`Tag`).

use super::bytecode::Part;
use super::library;
use super::own;
use super::state::{State, TREE_SLOT, text_of};
use crate::error::Error;
use crate::limits::{IMAGE_BYTES_MAX, LOAD_TIME_MS};
use mlua_sys as lua;
use std::ffi::c_int;

/// Registry place of what permanents.lua noted.
const NOTED: c_int = 4;

/// What stands before a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Tag {
    Nil,
    False,
    True,
    /// One byte: a whole number from 0 to 255.
    Small,
    /// Eight bytes.
    Number,
    /// A length of four bytes, and as many bytes.
    Text,
    /// The number of an object, four bytes.
    Object,
}

impl Tag {
    /// The tag with this number.
    pub(super) fn of(byte: u8) -> Option<Self> {
        [
            Self::Nil,
            Self::False,
            Self::True,
            Self::Small,
            Self::Number,
            Self::Text,
            Self::Object,
        ]
        .into_iter()
        .find(|tag| *tag as u8 == byte)
    }
}

/// What one node's converters reach, ready to be restored in any state.
#[derive(Debug, Default)]
pub(crate) struct Image {
    /// Makes the objects.
    pub(super) create: Vec<u8>,
    /// Fills them.
    pub(super) fill: Vec<u8>,
}

impl Image {
    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> usize {
        self.create.len() + self.fill.len()
    }

    /// Whether one more value of `size` bytes may be appended.
    fn has_room(&self, size: usize) -> bool {
        self.bytes().saturating_add(size) <= IMAGE_BYTES_MAX
    }
}

/// Notes what the host gave, before the program runs.
pub(crate) fn keep_pristine(state: &State) -> Result<(), Error> {
    let code = Part::Permanents.code()?;
    let bytes: &[u8] = &code;
    state.protect(&[], |l| {
        // SAFETY: inside a protected call; the bytes outlive it.
        unsafe {
            lua::luaL_loadbuffer(l, bytes.as_ptr().cast(), bytes.len(), c"=trikfs".as_ptr());
            lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
            own::push_raw(l);
            own::push_debug(l);
            lua::lua_call(l, 3, 1);
            lua::lua_rawseti_(l, lua::LUA_REGISTRYINDEX, NOTED);
        }
    })
}

/// Pushes what was noted of the globals before the program ran, by name.
///
/// # Safety
/// Inside a protected call on a state where [`keep_pristine`] ran.
pub(super) unsafe fn push_pristine(l: *mut lua::lua_State) {
    // SAFETY: the caller vouches for the state.
    unsafe {
        lua::lua_rawgeti_(l, lua::LUA_REGISTRYINDEX, NOTED);
        lua::lua_getfield(l, -1, c"pristine".as_ptr());
        lua::lua_remove(l, -2);
    }
}

/// Makes the image of one node from a state in which the program ran.
///
/// # Errors
/// What the node reaches cannot be written, with what that is; no memory.
pub(crate) fn persist(state: &mut State, node: &str) -> Result<Image, Error> {
    let first = first_drawn()?;
    let code = Part::Persist.code()?;
    let bytes: &[u8] = &code;
    let l = state.raw();
    // SAFETY: the state is live.
    let top = unsafe { lua::lua_gettop(l) };
    *state.host().image.borrow_mut() = Some(Image::default());
    let pushed = state.protect(&[TREE_SLOT], |l| {
        // SAFETY: inside a protected call with the tree as the first value; bytes and node outlive it.
        unsafe {
            lua::luaL_checkstack_(l, 24, c"no stack".as_ptr());
            lua::luaL_loadbuffer(l, bytes.as_ptr().cast(), bytes.len(), c"=trikfs".as_ptr());
            lua::lua_createtable(l, 0, 0);
            for (position, segment) in (1..).zip(node.split('/')) {
                lua::lua_pushlstring_(l, segment.as_ptr().cast(), segment.len());
                lua::lua_rawseti_(l, -2, position);
            }
            lua::lua_pushvalue(l, 1);
            lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
            lua::lua_rawgeti_(l, lua::LUA_REGISTRYINDEX, NOTED);
            lua::lua_pushnumber(l, first);
            own::push_raw(l);
            own::push_string(l);
            own::push_debug(l);
            own::push_constants(l);
            for append in [create, fill, refer] {
                lua::lua_pushcfunction(l, append);
            }
        }
    });
    let ended = match pushed {
        Ok(()) if state.call(12, 0, LOAD_TIME_MS.saturating_mul(1_000)) => Ok(()),
        Ok(()) => Err(Error::Script(text_of(state))),
        Err(reason) => Err(reason),
    };
    // SAFETY: takes off what the call left.
    unsafe { lua::lua_settop(l, top) };
    let image = state.host().image.borrow_mut().take();
    ended.and_then(|()| image.ok_or(Error::Ours("no image")))
}

/// What `math.random` gives first in a new state.
fn first_drawn() -> Result<f64, Error> {
    static FIRST: std::sync::OnceLock<f64> = std::sync::OnceLock::new();
    if let Some(first) = FIRST.get() {
        return Ok(*first);
    }
    let state = State::bare(1 << 20)?;
    let mut first = 0.0;
    state.protect(&[], |l| {
        // SAFETY: inside a protected call; the library's table is the value that opening leaves.
        unsafe {
            lua::lua_pushcfunction(l, lua::luaopen_math);
            lua::lua_call(l, 0, 1);
            lua::lua_getfield(l, -1, c"random".as_ptr());
            lua::lua_call(l, 0, 1);
            first = lua::lua_tonumber(l, -1);
            lua::lua_settop(l, 0);
        }
    })?;
    Ok(*FIRST.get_or_init(|| first))
}

/// `create(...)`: appends the arguments to the first half.
unsafe extern "C-unwind" fn create(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state.
    unsafe { append(l, |image| &mut image.create) }
}

/// `fill(...)`: appends the arguments to the second half.
unsafe extern "C-unwind" fn fill(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state.
    unsafe { append(l, |image| &mut image.fill) }
}

/// `refer(id)`: appends an object to the second half.
unsafe extern "C-unwind" fn refer(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; the borrow ends before an error is raised.
    unsafe {
        let id = lua::lua_tointeger(l, 1) as u32;
        let fits = library::host(l)
            .image
            .borrow_mut()
            .as_mut()
            .is_some_and(|image| {
                let fits = image.has_room(5);
                if fits {
                    image.fill.push(Tag::Object as u8);
                    image.fill.extend_from_slice(&id.to_le_bytes());
                }
                fits
            });
        told(l, fits)
    }
}

unsafe fn append(l: *mut lua::lua_State, half: fn(&mut Image) -> &mut Vec<u8>) -> c_int {
    // SAFETY: called by functions that Lua called. The borrow ends before an error is raised; texts stay on the stack while
    // their bytes are copied.
    unsafe {
        let mut fits = true;
        for index in 1..=lua::lua_gettop(l) {
            let mut bytes: &[u8] = &[];
            if lua::lua_type(l, index) == lua::LUA_TSTRING {
                let mut size = 0;
                let start = lua::lua_tolstring(l, index, &raw mut size);
                bytes = std::slice::from_raw_parts(start.cast(), size);
            }
            let mut image = library::host(l).image.borrow_mut();
            fits &= image.as_mut().is_some_and(|image| {
                let fits = image.has_room(bytes.len() + 9);
                if fits {
                    append_value(l, index, bytes, half(image));
                }
                fits
            });
        }
        told(l, fits)
    }
}

/// Appends the value at `index`, whose bytes are `text` if it is one.
unsafe fn append_value(l: *mut lua::lua_State, index: c_int, text: &[u8], out: &mut Vec<u8>) {
    // SAFETY: the caller is a function that Lua called; nothing is read under a wrong type and nothing here can raise.
    unsafe {
        match lua::lua_type(l, index) {
            lua::LUA_TBOOLEAN if lua::lua_toboolean(l, index) != 0 => out.push(Tag::True as u8),
            lua::LUA_TBOOLEAN => out.push(Tag::False as u8),
            lua::LUA_TNUMBER => {
                let number = lua::lua_tonumber(l, index);
                if (0.0..256.0).contains(&number)
                    && number.fract() == 0.0
                    && !number.is_sign_negative()
                {
                    out.extend_from_slice(&[Tag::Small as u8, number as u8]);
                } else {
                    out.push(Tag::Number as u8);
                    out.extend_from_slice(&number.to_le_bytes());
                }
            }
            lua::LUA_TSTRING => {
                out.push(Tag::Text as u8);
                out.extend_from_slice(&u32::try_from(text.len()).unwrap_or(0).to_le_bytes());
                out.extend_from_slice(text);
            }
            _ => out.push(Tag::Nil as u8),
        }
    }
}

/// Ends a function that appends: raises an error if there was no room.
unsafe fn told(l: *mut lua::lua_State, fits: bool) -> c_int {
    if !fits {
        // SAFETY: called by functions that Lua called, with no borrow and no destructor left in their frames.
        unsafe {
            lua::lua_pushlstring_(l, c"too much".as_ptr(), 8);
            lua::lua_error(l);
        }
    }
    0
}

#[cfg(test)]
mod tests;
