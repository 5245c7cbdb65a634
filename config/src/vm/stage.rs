//! Converters bound in a state: finding the function, its buffers, and the call.
//!
//! Owns the buffers that Lua sees as byte arrays. They are allocated once and freed after the state is closed, so no
//! proxy can outlive them.

use super::library;
use super::state::{ARRAY_SLOT, PARAMS_SLOT, State, TREE_SLOT, text_of, type_name};
use crate::error::{Error, Missing};
use converter::{Conversion, Direction, Fault};
use mlua_sys as lua;
use std::collections::BTreeMap;
use std::ffi::c_int;
use std::ptr::NonNull;

/// Bytes that Lua and the host share in turn.
struct Buffer {
    start: NonNull<u8>,
    size: usize,
}

// SAFETY: the bytes belong to what owns the buffer and its state, which move together.
unsafe impl Send for Buffer {}

impl Buffer {
    fn new(size: usize) -> Self {
        let bytes = Box::leak(vec![0u8; size].into_boxed_slice());
        Self {
            start: NonNull::from(bytes).cast(),
            size,
        }
    }

    /// The bytes, while Lua does not run.
    fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: made by `new` with this size; Lua reaches the bytes only inside calls of the stage's owner, which
        // holds this borrow exclusively.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr(), self.size) }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: leaked in `new` with this size. `Stages` closes the state before its buffers go.
        drop(unsafe {
            Box::from_raw(std::ptr::slice_from_raw_parts_mut(
                self.start.as_ptr(),
                self.size,
            ))
        });
    }
}

/// A bound converter: its function, input proxy and output proxy stand at `slot` and above.
struct Stage {
    slot: c_int,
    input: Buffer,
    output: Buffer,
}

/// A state with the converters that are bound in it.
pub(crate) struct Stages {
    /// Dropped first: fields are dropped in this order.
    state: State,
    stages: Vec<Stage>,
    /// Conversions until the compiler is turned on.
    cold: u8,
}

/// Conversions that run interpreted. Most open files convert a few tuples only and are closed again; for them turning
/// the compiler on costs more than it saves.
const COLD_CONVERSIONS: u8 = 8;
/// Tuples from this size on are compiled for at once.
const LARGE_TUPLE_BYTES: usize = 512;

impl Stages {
    pub(crate) fn new(state: State) -> Self {
        Self {
            state,
            stages: Vec::new(),
            cold: COLD_CONVERSIONS,
        }
    }

    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    /// Does what the first bound converter would have to wait for: opens what byte arrays are made with.
    pub(crate) fn prepare_arrays(&mut self) -> Result<(), Error> {
        self.state.protect(&[ARRAY_SLOT], |l| {
            // SAFETY: inside a protected call with the array maker on the stack; of no bytes none are reached.
            unsafe {
                push_array(l, std::ptr::null_mut(), 0);
                lua::lua_settop(l, 1);
            }
        })
    }

    /// Finds the function of one stage of a node and gives it buffers.
    pub(crate) fn bind(
        &mut self,
        node: &str,
        direction: Direction,
        position: usize,
        input_size: usize,
        output_size: usize,
    ) -> Result<usize, Error> {
        let (mut input, mut output) = (Buffer::new(input_size), Buffer::new(output_size));
        let (from, to) = (input.bytes().as_mut_ptr(), output.bytes().as_mut_ptr());
        let l = self.state.raw();
        // SAFETY: the state is live.
        let slot = unsafe { lua::lua_gettop(l) } + 1;
        let found = self.state.protect(&[ARRAY_SLOT, TREE_SLOT], |l| {
            // SAFETY: inside a protected call with the two given values on the stack; the buffers live as long as the
            // state.
            unsafe {
                let found = push_converter(l, 2, node, direction, position);
                if found.is_ok() {
                    push_array(l, from, input_size);
                    push_array(l, to, output_size);
                }
                found
            }
        })?;
        if let Err(missing) = found {
            // SAFETY: takes off whatever the search left.
            unsafe { lua::lua_settop(l, slot - 1) };
            let node = node.to_owned();
            return Err(Error::NoConverter { node, missing });
        }
        self.state.protect(&[], |l| {
            // SAFETY: inside a protected call.
            unsafe { lua::luaL_checkstack_(l, 32, c"too many converters".as_ptr()) };
        })?;
        // For a large tuple one call is work enough to be worth the compiler.
        if self.cold > 0 && input_size.max(output_size) >= LARGE_TUPLE_BYTES {
            self.cold = 1;
            self.warm_up();
        }
        self.stages.push(Stage {
            slot,
            input,
            output,
        });
        Ok(self.stages.len() - 1)
    }

    /// Lets go of all nodes but one: of the tree remains the path to that node. What only the others needed is thrown away
    /// when the state next collects, at the latest when the compiler is turned on.
    pub(crate) fn keep_only(&mut self, node: &str) -> Result<(), Error> {
        self.state.protect(&[TREE_SLOT], |l| {
            // SAFETY: inside a protected call with the tree as the only value; leaves the new tree above it.
            unsafe {
                push_path(l, node);
                lua::lua_pushlstring_(l, c"trikfs".as_ptr(), 6);
                lua::lua_pushvalue(l, -2);
                lua::lua_rawset(l, lua::LUA_GLOBALSINDEX);
            }
        })?;
        // SAFETY: `protect` left the new tree on the top.
        unsafe { lua::lua_replace(self.state.raw(), TREE_SLOT) };
        Ok(())
    }

    /// Bytes that a stage takes and gives.
    pub(crate) fn sizes(&self, index: usize) -> Option<(usize, usize)> {
        self.stages
            .get(index)
            .map(|stage| (stage.input.size, stage.output.size))
    }

    /// Converts one tuple. The sizes must be those of the stage.
    pub(crate) fn convert(
        &mut self,
        index: usize,
        input: &[u8],
        output: &mut [u8],
        budget_us: u32,
    ) -> Result<Conversion, Fault> {
        let stage = self
            .stages
            .get_mut(index)
            .ok_or("no such stage in this state")?;
        if input.len() != stage.input.size || output.len() != stage.output.size {
            return Err(Fault::new(format!(
                "the stage takes {} bytes and gives {}, not {} and {}",
                stage.input.size,
                stage.output.size,
                input.len(),
                output.len()
            )));
        }
        stage.input.bytes().copy_from_slice(input);
        stage.output.bytes().fill(0);
        let l = self.state.raw();
        // SAFETY: the state is live; `bind` left function and proxies at the slot and saw to the stack space; none of
        // these calls needs memory.
        unsafe {
            lua::lua_pushvalue(l, stage.slot);
            lua::lua_pushinteger(l, stage.input.size as lua::lua_Integer);
            lua::lua_pushvalue(l, stage.slot + 1);
            lua::lua_pushinteger(l, stage.output.size as lua::lua_Integer);
            lua::lua_pushvalue(l, stage.slot + 2);
        }
        let result = if self.state.call(4, 1, budget_us) {
            self.conversion()
        } else {
            Err(Fault::new(text_of(&self.state)))
        };
        // SAFETY: takes off the result or the error.
        unsafe { lua::lua_settop(l, -2) };
        if result == Ok(Conversion::Produced)
            && let Some(stage) = self.stages.get_mut(index)
        {
            output.copy_from_slice(stage.output.bytes());
        }
        if self.cold > 0 {
            self.warm_up();
        }
        result
    }

    /// The meaning of the value on the top.
    fn conversion(&self) -> Result<Conversion, Fault> {
        let l = self.state.raw();
        // SAFETY: the state is live and the result of the call is on its top.
        let (kind, truth) = unsafe { (lua::lua_type(l, -1), lua::lua_toboolean(l, -1) != 0) };
        match kind {
            lua::LUA_TNIL => Ok(Conversion::Produced),
            lua::LUA_TBOOLEAN if truth => Ok(Conversion::Produced),
            lua::LUA_TBOOLEAN => Ok(Conversion::Consumed),
            other => Err(Fault::new(format!(
                "the converter returned a {}, not true, false or nothing",
                type_name(other)
            ))),
        }
    }

    /// Counts down to the compiler. Without memory for it the state stays interpreted.
    #[cold]
    fn warm_up(&mut self) {
        self.cold -= 1;
        if self.cold == 0 {
            let _ = self.state.protect(&[], |l| {
                // SAFETY: inside a protected call on a state with the sandbox.
                unsafe { library::compile_from_here(l) };
            });
            // It has collected, too.
            self.state.host().memory.trim();
        }
    }

    /// Puts numbers into the global table `params` and into the description's own.
    pub(crate) fn set_params(
        &mut self,
        node: &str,
        params: &BTreeMap<String, f64>,
    ) -> Result<(), Error> {
        self.state.protect(&[PARAMS_SLOT, TREE_SLOT], |l| {
            // SAFETY: inside a protected call with the two given values on the stack; the names are borrowed from the
            // caller, so nothing here has a destructor.
            unsafe {
                fill(l, 1, params);
                if push_node(l, 2, node).is_ok() {
                    get_raw(l, -1, b"params");
                    if lua::lua_type(l, -1) == lua::LUA_TTABLE {
                        let own = lua::lua_gettop(l);
                        fill(l, own, params);
                    }
                }
                lua::lua_settop(l, 2);
            }
        })
    }
}

/// Writes numbers into the table at `index`.
unsafe fn fill(l: *mut lua::lua_State, index: c_int, params: &BTreeMap<String, f64>) {
    // SAFETY: the caller is in a protected call with a table at the index.
    unsafe {
        for (name, value) in params {
            lua::lua_pushlstring_(l, name.as_ptr().cast(), name.len());
            lua::lua_pushnumber(l, *value);
            lua::lua_rawset(l, index);
        }
    }
}

/// Calls the array maker at index 1 and leaves the proxy.
unsafe fn push_array(l: *mut lua::lua_State, start: *mut u8, size: usize) {
    // SAFETY: the caller is in a protected call with the array maker as the first value.
    unsafe {
        lua::lua_pushvalue(l, 1);
        lua::lua_pushlightuserdata(l, start.cast());
        lua::lua_pushinteger(l, size as lua::lua_Integer);
        lua::lua_call(l, 2, 1);
    }
}

/// Pushes `table[name]` without metamethods; the value at `index` must be a table.
unsafe fn get_raw(l: *mut lua::lua_State, index: c_int, name: &[u8]) {
    // SAFETY: the caller is in a protected call with a table at the index; a negative index moves by one with the push.
    unsafe {
        let index = if index < 0 { index - 1 } else { index };
        lua::lua_pushlstring_(l, name.as_ptr().cast(), name.len());
        lua::lua_rawget_(l, index);
    }
}

/// Whether the table on top is a node and no group: it has a source, which is no node that is called `src`.
unsafe fn is_node(l: *mut lua::lua_State) -> bool {
    // SAFETY: the caller is in a protected call with a table on top; only tables are indexed.
    unsafe {
        get_raw(l, -1, b"src");
        let mut is_node = lua::lua_type(l, -1) != lua::LUA_TNIL;
        if lua::lua_type(l, -1) == lua::LUA_TTABLE {
            get_raw(l, -1, b"src");
            get_raw(l, -2, b"");
            let is_named_so = lua::lua_type(l, -2) != lua::LUA_TNIL;
            let is_source = lua::lua_type(l, -1) != lua::LUA_TNIL;
            lua::lua_settop(l, -3);
            is_node = !is_named_so || is_source;
        }
        lua::lua_settop(l, -2);
        is_node
    }
}

/// Pushes the description of a node: a path through groups, and from a node through its attributes.
unsafe fn push_node(l: *mut lua::lua_State, tree: c_int, node: &str) -> Result<(), Missing> {
    // SAFETY: the caller is in a protected call; only tables are indexed.
    unsafe {
        lua::lua_pushvalue(l, tree);
        for (depth, segment) in node.split('/').enumerate() {
            if lua::lua_type(l, -1) != lua::LUA_TTABLE {
                return Err(Missing::Node);
            }
            // The tree itself is none, whatever its nodes are called.
            if depth > 0 && is_node(l) {
                get_raw(l, -1, b"attributes");
                lua::lua_remove(l, -2);
                if lua::lua_type(l, -1) != lua::LUA_TTABLE {
                    return Err(Missing::Node);
                }
            }
            get_raw(l, -1, segment.as_bytes());
            lua::lua_remove(l, -2);
        }
        if lua::lua_type(l, -1) == lua::LUA_TTABLE {
            Ok(())
        } else {
            Err(Missing::Node)
        }
    }
}

/// Pushes a tree that has only the groups on the way to a node, and the node itself, out of the tree at index 1.
unsafe fn push_path(l: *mut lua::lua_State, node: &str) {
    /// Stack places: the group that is looked at, and its copy.
    const GROUP: c_int = 3;
    const COPY: c_int = 4;
    // SAFETY: the caller is in a protected call with the tree as the only value; only tables are indexed.
    unsafe {
        lua::lua_createtable(l, 0, 1);
        lua::lua_pushvalue(l, 1);
        lua::lua_pushvalue(l, 2);
        for segment in node.split('/') {
            if lua::lua_type(l, GROUP) != lua::LUA_TTABLE {
                break;
            }
            get_raw(l, GROUP, segment.as_bytes());
            let is_group = lua::lua_type(l, -1) == lua::LUA_TTABLE && !is_node(l);
            if is_group {
                lua::lua_createtable(l, 0, 1);
            } else {
                lua::lua_pushvalue(l, -1);
            }
            lua::lua_pushlstring_(l, segment.as_ptr().cast(), segment.len());
            lua::lua_pushvalue(l, -2);
            lua::lua_rawset(l, COPY);
            if !is_group {
                break;
            }
            lua::lua_replace(l, COPY);
            lua::lua_replace(l, GROUP);
        }
        lua::lua_settop(l, 2);
    }
}

/// Pushes the function of one stage of a node and leaves nothing else.
unsafe fn push_converter(
    l: *mut lua::lua_State,
    tree: c_int,
    node: &str,
    direction: Direction,
    position: usize,
) -> Result<(), Missing> {
    // SAFETY: the caller is in a protected call; only tables are indexed.
    unsafe {
        push_node(l, tree, node)?;
        if direction == Direction::Write {
            get_raw(l, -1, b"write_converter");
            if lua::lua_type(l, -1) == lua::LUA_TNIL {
                lua::lua_settop(l, -2);
                get_raw(l, -1, b"converter");
            }
        } else {
            get_raw(l, -1, b"converter");
        }
        lua::lua_remove(l, -2);
        if lua::lua_type(l, -1) == lua::LUA_TTABLE {
            get_raw(l, -1, b"converter");
            if lua::lua_type(l, -1) == lua::LUA_TNIL {
                // A list; its first stage has the position 0.
                lua::lua_settop(l, -2);
                let index = c_int::try_from(position).unwrap_or(c_int::MAX - 1) + 1;
                lua::lua_rawgeti_(l, -1, index);
                if lua::lua_type(l, -1) == lua::LUA_TTABLE {
                    get_raw(l, -1, b"converter");
                    lua::lua_remove(l, -2);
                }
            }
            lua::lua_remove(l, -2);
        }
        if lua::lua_type(l, -1) == lua::LUA_TFUNCTION && lua::lua_iscfunction(l, -1) == 0 {
            Ok(())
        } else {
            Err(Missing::Converter)
        }
    }
}
