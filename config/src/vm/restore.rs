//! Puts an image into a state: makes what it names and leaves the tree with the node's converters.
//!
//! Owns the reading of images (persist.rs has the encoding). An image that is cut or torn is refused and touches nothing
//! outside its state.

use super::own;
use super::persist::{Image, Tag};
use super::state::{State, TREE_SLOT};
use crate::error::Error;
use crate::limits::ENTRIES_AHEAD_MAX;
use mlua_sys as lua;
use std::ffi::{CStr, c_int};

unsafe extern "C-unwind" {
    /// LuaJIT's own: makes upvalue `first_index` of one function the same variable as that of another.
    fn lua_upvaluejoin(
        l: *mut lua::lua_State,
        first: c_int,
        first_index: c_int,
        second: c_int,
        second_index: c_int,
    );
}

/// Operations that make objects; the numbers stand in lua/persist.lua, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Create {
    /// Entries of the list, other entries.
    Table = 1,
    /// Bytecode.
    Function = 2,
    /// The number of keys, and the keys.
    Permanent = 3,
}

/// Operations that fill them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
enum Fill {
    End = 0,
    /// Table, key, value.
    Entry = 1,
    /// Table, metatable.
    Metatable = 2,
    /// Function, index, value.
    Upvalue = 3,
    /// Function, index, another function, index there.
    Join = 4,
    /// Function, table.
    Environment = 5,
    /// Name, value.
    Global = 6,
    /// The tree.
    Root = 7,
}

impl Create {
    fn of(byte: u8) -> Option<Self> {
        let all = [Self::Table, Self::Function, Self::Permanent];
        all.into_iter().find(|operation| *operation as u8 == byte)
    }
}

impl Fill {
    fn of(byte: u8) -> Option<Self> {
        let all = [
            Self::End,
            Self::Entry,
            Self::Metatable,
            Self::Upvalue,
            Self::Join,
            Self::Environment,
            Self::Global,
            Self::Root,
        ];
        all.into_iter().find(|operation| *operation as u8 == byte)
    }
}

/// Stack place of the list of objects while an image is restored.
const OBJECTS: c_int = 1;
/// Name of code whose own name its bytecode has.
const CHUNK: &CStr = c"=trikfs";

/// Restores an image in a state with the sandbox in which no program ran. Its tree takes the place of `trikfs`.
///
/// # Errors
/// No memory; an image that is not whole.
pub(crate) fn restore(state: &State, image: &Image) -> Result<(), Error> {
    let whole = state.protect(&[], |l| {
        // SAFETY: inside a protected call without values; the readers own nothing, and the image outlives the call.
        unsafe {
            lua::lua_createtable(l, 0, 0);
            make(l, Reader(&image.create))?;
            complete(l, Reader(&image.fill))
        }
    })?;
    if whole.is_none() {
        // SAFETY: takes off what was made so far.
        unsafe { lua::lua_settop(state.raw(), TREE_SLOT) };
        return Err(Error::Ours("an image is not whole"));
    }
    // SAFETY: the list of objects and the tree were left on the stack.
    unsafe {
        lua::lua_replace(state.raw(), TREE_SLOT);
        lua::lua_settop(state.raw(), TREE_SLOT);
    }
    Ok(())
}

/// Makes all objects and numbers them.
unsafe fn make(l: *mut lua::lua_State, mut from: Reader<'_>) -> Option<()> {
    // SAFETY: the caller is in a protected call with the list of objects at its place; each branch leaves one value.
    unsafe {
        let mut number = 0;
        while !from.0.is_empty() {
            match Create::of(from.small()?)? {
                Create::Table => {
                    let (list, others) = (from.count()?, from.count()?);
                    lua::lua_createtable(l, list, others);
                }
                Create::Function => {
                    let code = from.text()?;
                    let (start, size) = (code.as_ptr().cast(), code.len());
                    if lua::luaL_loadbuffer(l, start, size, CHUNK.as_ptr()) != lua::LUA_OK {
                        lua::lua_error(l);
                    }
                }
                Create::Permanent => {
                    let keys = from.small()?;
                    push_permanent(l, &mut from, keys)?;
                }
            }
            number += 1;
            lua::lua_rawseti_(l, OBJECTS, number);
        }
        Some(())
    }
}

/// Pushes what every state has, by the keys that lead to it.
unsafe fn push_permanent(l: *mut lua::lua_State, from: &mut Reader<'_>, keys: u8) -> Option<()> {
    // SAFETY: as `make`; the metamethods that are met are those of the prelude.
    unsafe {
        for position in 0..keys {
            let key = from.text()?;
            match (position, key) {
                (0, b"(raw)") => own::push_raw(l),
                (0, b"(string)") => {
                    lua::lua_pushlstring_(l, c"".as_ptr(), 0);
                    lua::lua_getmetatable(l, -1);
                    lua::lua_remove(l, -2);
                }
                _ => {
                    if position == 0 {
                        lua::lua_pushvalue(l, lua::LUA_GLOBALSINDEX);
                    }
                    lua::lua_pushlstring_(l, key.as_ptr().cast(), key.len());
                    lua::lua_gettable(l, -2);
                    lua::lua_remove(l, -2);
                }
            }
        }
        Some(())
    }
}

/// Fills the objects; leaves the tree.
unsafe fn complete(l: *mut lua::lua_State, mut from: Reader<'_>) -> Option<()> {
    // SAFETY: the caller is in a protected call with the list of objects at its place. Every operation takes off what it
    // pushed; the types that a call wants are looked at before it.
    unsafe {
        loop {
            match Fill::of(from.small()?)? {
                Fill::End => {
                    lua::lua_settop(l, OBJECTS + 1);
                    return Some(());
                }
                Fill::Entry => {
                    from.push_object(l, lua::LUA_TTABLE)?;
                    from.push(l)?;
                    from.push(l)?;
                    lua::lua_rawset(l, -3);
                }
                Fill::Metatable => {
                    from.push_object(l, lua::LUA_TTABLE)?;
                    from.push(l)?;
                    lua::lua_setmetatable(l, -2);
                }
                Fill::Upvalue => {
                    from.push_object(l, lua::LUA_TFUNCTION)?;
                    let index = from.count()?;
                    from.push(l)?;
                    lua::lua_setupvalue(l, -2, index);
                }
                Fill::Join => {
                    from.push_object(l, lua::LUA_TFUNCTION)?;
                    let index = from.count()?;
                    from.push_object(l, lua::LUA_TFUNCTION)?;
                    let other = from.count()?;
                    for (place, at) in [(-2, index), (-1, other)] {
                        if lua::lua_getupvalue(l, place, at).is_null() {
                            return None;
                        }
                        lua::lua_settop(l, -2);
                    }
                    lua_upvaluejoin(l, -2, index, -1, other);
                }
                Fill::Environment => {
                    from.push_object(l, lua::LUA_TFUNCTION)?;
                    from.push_object(l, lua::LUA_TTABLE)?;
                    lua::lua_setfenv(l, -2);
                }
                Fill::Global => {
                    let name = from.text()?;
                    lua::lua_pushlstring_(l, name.as_ptr().cast(), name.len());
                    from.push(l)?;
                    lua::lua_rawset(l, lua::LUA_GLOBALSINDEX);
                }
                Fill::Root => {
                    // Below what the operations after it push and take off.
                    from.push_object(l, lua::LUA_TTABLE)?;
                    lua::lua_insert(l, OBJECTS + 1);
                    continue;
                }
            }
            lua::lua_settop(l, OBJECTS);
        }
    }
}

/// What is left of one half of an image.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, size: usize) -> Option<&'a [u8]> {
        let (taken, left) = self.0.split_at_checked(size)?;
        self.0 = left;
        Some(taken)
    }

    fn word(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.take(4)?.try_into().ok()?))
    }

    fn tag(&mut self) -> Option<Tag> {
        Tag::of(*self.take(1)?.first()?)
    }

    fn small(&mut self) -> Option<u8> {
        match self.tag()? {
            Tag::Small => self.take(1)?.first().copied(),
            Tag::Nil | Tag::False | Tag::True | Tag::Number | Tag::Text | Tag::Object => None,
        }
    }

    fn number(&mut self) -> Option<f64> {
        Some(f64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// A number of entries or of a variable.
    fn count(&mut self) -> Option<c_int> {
        match self.tag()? {
            Tag::Small => Some(c_int::from(*self.take(1)?.first()?)),
            Tag::Number => Some((self.number()? as c_int).clamp(0, ENTRIES_AHEAD_MAX)),
            Tag::Nil | Tag::False | Tag::True | Tag::Text | Tag::Object => None,
        }
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        match self.tag()? {
            Tag::Text => {
                let size = self.word()?;
                self.take(usize::try_from(size).ok()?)
            }
            Tag::Nil | Tag::False | Tag::True | Tag::Small | Tag::Number | Tag::Object => None,
        }
    }

    /// Pushes the next value.
    unsafe fn push(&mut self, l: *mut lua::lua_State) -> Option<()> {
        // SAFETY: the caller is in a protected call with the list of objects at its place.
        unsafe {
            match self.tag()? {
                Tag::Nil => lua::lua_pushnil(l),
                Tag::False => lua::lua_pushboolean(l, 0),
                Tag::True => lua::lua_pushboolean(l, 1),
                Tag::Small => {
                    lua::lua_pushinteger(l, lua::lua_Integer::from(*self.take(1)?.first()?));
                }
                Tag::Number => lua::lua_pushnumber(l, self.number()?),
                Tag::Text => {
                    let size = usize::try_from(self.word()?).ok()?;
                    let text = self.take(size)?;
                    lua::lua_pushlstring_(l, text.as_ptr().cast(), text.len());
                }
                Tag::Object => {
                    let number = c_int::try_from(self.word()?).ok()?;
                    lua::lua_rawgeti_(l, OBJECTS, number);
                }
            }
        }
        Some(())
    }

    /// Pushes the next value, which must be an object of this type.
    unsafe fn push_object(&mut self, l: *mut lua::lua_State, wanted: c_int) -> Option<()> {
        // SAFETY: as `push`.
        unsafe {
            self.push(l)?;
            (lua::lua_type(l, -1) == wanted).then_some(())
        }
    }
}
