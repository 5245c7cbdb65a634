//! Copies the globals `trikfs` and `setup` out of a state as plain values, without running any of the program's code.
//!
//! Owns the limits of what is copied. Shared tables are copied each time they are met, cycles are refused.

use super::state::{State, TREE_SLOT, type_name};
use crate::limits::{TABLE_DEPTH_MAX, TEXT_BYTES_MAX, VALUES_MAX};
use crate::value::{Function, Key, Table, Value, Values};
use mlua_sys as lua;
use std::ffi::{CStr, c_int, c_void};

/// Why a tree could not be copied.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Refusal {
    /// Keys to the place, from the global on.
    pub(crate) path: Vec<String>,
    /// Lower case, no trailing stop.
    pub(crate) reason: String,
}

/// Copies the tree. Leaves a Lua list of the functions, in the order of their numbers, on the state's stack.
///
/// # Errors
/// A table that holds itself, too deep or too much.
pub(crate) fn extract(state: &State) -> Result<Values, Refusal> {
    let mut copier = Copier::default();
    let target = &mut copier;
    let fits = state.protect(&[TREE_SLOT], |l| {
        // SAFETY: inside a protected call with the tree as the first value. The copier lives outside of it, so an error
        // of Lua skips no destructor.
        unsafe {
            lua::lua_newtable(l);
            target.path.push(b"trikfs".to_vec());
            let fits = target.value(l, 1).map(|value| target.values.root = value);
            let fits = fits.and_then(|()| target.setup(l));
            lua::lua_pushvalue(l, 2);
            lua::lua_replace(l, 1);
            lua::lua_settop(l, 1);
            lua::lua_pushvalue(l, 1);
            fits
        }
    });
    match fits {
        Ok(Some(())) => {
            copier.values.tables.iter_mut().for_each(Table::settle);
            Ok(copier.values)
        }
        Ok(None) => Err(Refusal {
            path: copier
                .path
                .iter()
                .map(|key| String::from_utf8_lossy(key).into_owned())
                .collect(),
            reason: copier.reason.into(),
        }),
        Err(reason) => Err(Refusal {
            path: Vec::new(),
            reason: reason.to_string(),
        }),
    }
}

#[derive(Default)]
struct Copier {
    values: Values,
    /// Tables that are being copied, outermost first.
    open: Vec<*const c_void>,
    /// Keys that lead to the value that is being copied.
    path: Vec<Vec<u8>>,
    /// Why the copy was given up.
    reason: &'static str,
    count: usize,
    text_bytes: usize,
}

impl Copier {
    fn refuse<T>(&mut self, reason: &'static str) -> Option<T> {
        self.reason = reason;
        None
    }

    /// Copies the value at a positive index; `Some(None)` is nil, None a refusal.
    ///
    /// # Safety
    /// Inside a protected call, with the list of functions at index 2.
    unsafe fn value(&mut self, l: *mut lua::lua_State, index: c_int) -> Option<Option<Value>> {
        self.count += 1;
        if self.count > VALUES_MAX {
            return self.refuse("the configuration has too many values");
        }
        // SAFETY: the caller vouches for the state; nothing here is read under a wrong type.
        unsafe {
            Some(Some(match lua::lua_type(l, index) {
                lua::LUA_TNIL => return Some(None),
                lua::LUA_TBOOLEAN => Value::Boolean(lua::lua_toboolean(l, index) != 0),
                lua::LUA_TNUMBER => Value::Number(lua::lua_tonumber(l, index)),
                lua::LUA_TSTRING => Value::Text(self.text(l, index)?),
                lua::LUA_TFUNCTION => self.function(l, index),
                lua::LUA_TTABLE => {
                    return self
                        .table(l, index)
                        .map(|number| Some(Value::Table(number)));
                }
                other => Value::Other(type_name(other)),
            }))
        }
    }

    /// Copies the global `setup`, which the program leaves beside the tree.
    ///
    /// # Safety
    /// As `value`.
    unsafe fn setup(&mut self, l: *mut lua::lua_State) -> Option<()> {
        self.path = vec![b"setup".to_vec()];
        // SAFETY: as `value`; the globals are a table, and a raw access runs none of the program's code.
        unsafe {
            lua::lua_pushlstring_(l, c"setup".as_ptr(), 5);
            lua::lua_rawget_(l, lua::LUA_GLOBALSINDEX);
            let at = lua::lua_gettop(l);
            self.values.setup = self.value(l, at)?;
            lua::lua_settop(l, at - 1);
        }
        Some(())
    }

    unsafe fn text(&mut self, l: *mut lua::lua_State, index: c_int) -> Option<Vec<u8>> {
        let mut size = 0;
        // SAFETY: the caller saw a string there; Lua keeps its bytes while it is on the stack.
        let bytes = unsafe {
            let start = lua::lua_tolstring(l, index, &raw mut size);
            std::slice::from_raw_parts(start.cast::<u8>(), size)
        };
        self.text_bytes += size;
        if self.text_bytes > TEXT_BYTES_MAX {
            return self.refuse("the configuration has too long strings");
        }
        Some(bytes.to_vec())
    }

    unsafe fn function(&mut self, l: *mut lua::lua_State, index: c_int) -> Value {
        let mut function = Function::default();
        // SAFETY: the caller saw a function there and vouches for the list at index 2. `lua_getinfo` takes the pushed
        // copy off and fills the record; its texts live as long as the function does.
        unsafe {
            let mut info: lua::lua_Debug = std::mem::zeroed();
            function.lua = lua::lua_iscfunction(l, index) == 0;
            lua::lua_pushvalue(l, index);
            lua::lua_getinfo(l, c">S".as_ptr(), &raw mut info);
            if let Some(source) = CStr::from_ptr(info.source).to_bytes().strip_prefix(b"@") {
                function.place.file = String::from_utf8_lossy(source).into_owned();
                function.place.line = u32::try_from(info.linedefined).unwrap_or(0);
            }
        }
        self.values.functions.push(function);
        let number = self.values.functions.len();
        // SAFETY: as above; an error for lack of memory finds nothing here that it could skip: `function` is moved.
        unsafe {
            lua::lua_pushvalue(l, index);
            lua::lua_rawseti_(l, 2, c_int::try_from(number).unwrap_or(c_int::MAX));
        }
        Value::Function(number - 1)
    }

    unsafe fn table(&mut self, l: *mut lua::lua_State, index: c_int) -> Option<usize> {
        // SAFETY: the caller saw a table there; the loop keeps key and value in place as `lua_next` wants and converts
        // no key.
        unsafe {
            let identity = lua::lua_topointer(l, index);
            if self.open.contains(&identity) {
                return self.refuse("the table holds itself");
            }
            if self.open.len() == TABLE_DEPTH_MAX {
                return self.refuse("tables are nested too deeply");
            }
            let number = self.values.tables.len();
            self.values.tables.push(Table::default());
            self.open.push(identity);
            lua::luaL_checkstack_(l, 8, c"tables are nested too deeply".as_ptr());
            lua::lua_pushnil(l);
            while lua::lua_next(l, index) != 0 {
                let at = lua::lua_gettop(l);
                self.entry(l, at, number)?;
                lua::lua_settop(l, at - 1);
            }
            self.open.pop();
            Some(number)
        }
    }

    /// Copies the entry whose value is at `at`, with the key below it.
    unsafe fn entry(&mut self, l: *mut lua::lua_State, at: c_int, number: usize) -> Option<()> {
        // SAFETY: as `table`.
        unsafe {
            let step = match lua::lua_type(l, at - 1) {
                lua::LUA_TSTRING => self.text(l, at - 1)?,
                lua::LUA_TNUMBER => lua::lua_tonumber(l, at - 1).to_string().into_bytes(),
                other => type_name(other).as_bytes().to_vec(),
            };
            self.path.push(step);
            let value = self.value(l, at)?;
            let step = self.path.pop()?;
            let key = match lua::lua_type(l, at - 1) {
                lua::LUA_TSTRING => Key::Text(step),
                lua::LUA_TNUMBER => Key::Number(lua::lua_tonumber(l, at - 1)),
                other => Key::Other(type_name(other)),
            };
            if let (Some(value), Some(table)) = (value, self.values.tables.get_mut(number)) {
                table.entries.push((key, value));
            }
        }
        Some(())
    }
}
