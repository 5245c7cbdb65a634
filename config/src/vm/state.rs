//! One Lua state: made, limited, called and closed.
//!
//! Owns the protected call and the layout of the state's stack. Knows nothing of nodes.

use super::bytecode::{Code, Part};
use super::library;
use super::memory::{Memory, allocate};
use super::persist::Image;
use crate::error::Error;
use crate::limits::LOG_LINE_BYTES_MAX;
use crate::watchdog::lua_budget;
use mlua_sys as lua;
use std::cell::{Cell, RefCell};
use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr::{self, NonNull};
use std::sync::Arc;

/// Where log lines go.
pub(crate) type LogSink = Arc<dyn Fn(&str) + Send + Sync>;
/// Finds the bytecode of an included file.
pub(crate) type Include = Box<dyn FnMut(&[u8]) -> Result<Code, Error> + Send>;

/// Stack place of the function that makes the proxy of a buffer.
pub(crate) const ARRAY_SLOT: c_int = 1;
/// Stack place of the global table `params`.
pub(crate) const PARAMS_SLOT: c_int = 2;
/// Stack place of the global `trikfs` as the program left it.
pub(crate) const TREE_SLOT: c_int = 3;

/// What Lua's callbacks find of the host. The allocator's user data points here.
#[repr(C)]
pub(crate) struct Host {
    /// First, because the allocator takes the same address for it.
    pub(crate) memory: Memory,
    log: RefCell<Option<LogSink>>,
    include: RefCell<Option<Include>>,
    /// Names of globals that were read and do not exist, the first few.
    pub(crate) undefined: RefCell<Vec<String>>,
    /// Bytecode that a callback is loading.
    pub(super) code: RefCell<Option<Code>>,
    /// A message that a callback is about to hand to Lua.
    pub(super) message: RefCell<String>,
    /// An image that is being written.
    pub(super) image: RefCell<Option<Image>>,
    /// What `State::protect` wants to run.
    pending: Cell<Option<Pending>>,
}

/// Work for a protected call, in the frame of `State::protect`.
type Pending = *mut (dyn FnMut(*mut lua::lua_State) + 'static);

/// Registry place of the function that runs the pending work.
const ENTER: c_int = 1;

/// Runs the pending work as a C function: in a frame of its own, whose values are the given ones.
unsafe extern "C-unwind" fn enter(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state; `protect` set the pending work, which lives in its frame.
    unsafe {
        let given = lua::lua_gettop(l);
        if let Some(pending) = library::host(l).pending.take() {
            (*pending)(l);
        }
        (lua::lua_gettop(l) - given).max(0)
    }
}

/// First call in a new state: keeps `enter`.
unsafe extern "C-unwind" fn settle(l: *mut lua::lua_State) -> c_int {
    // SAFETY: Lua calls with a live state, in a protected call.
    unsafe {
        lua::lua_pushcfunction(l, enter);
        lua::lua_rawseti_(l, lua::LUA_REGISTRYINDEX, ENTER);
    }
    0
}

impl Host {
    /// Sends a line to the log; no borrow is held while the sink runs.
    pub(super) fn log(&self, text: &[u8]) {
        let Some(sink) = self.log.borrow().clone() else {
            return;
        };
        let cut = text.get(..LOG_LINE_BYTES_MAX).unwrap_or(text);
        let line = String::from_utf8_lossy(cut);
        // The panic hook has told of it; a broken sink must not unwind through Lua.
        let _ = catch_unwind(AssertUnwindSafe(|| sink(&line)));
    }

    /// Bytecode of an included file.
    pub(super) fn include(&self, name: &[u8]) -> Result<Code, Error> {
        let Some(mut include) = self.include.borrow_mut().take() else {
            return Err(Error::Script("include is not possible here".into()));
        };
        let found = catch_unwind(AssertUnwindSafe(|| include(name)));
        *self.include.borrow_mut() = Some(include);
        found.unwrap_or(Err(Error::Ours("include failed inside")))
    }
}

/// A Lua state that belongs to one owner at a time.
pub(crate) struct State {
    lua: NonNull<lua::lua_State>,
    host: NonNull<Host>,
}

// SAFETY: a state and its host are reached only through their one owner (`&mut` for everything that runs Lua, and the
// methods that take `&self` are not callable from two threads because `State` is not Sync); neither is tied to a thread.
unsafe impl Send for State {}

impl State {
    /// A state without any library, for compiling.
    pub(crate) fn bare(memory_limit: usize) -> Result<Self, Error> {
        let host = NonNull::from(Box::leak(Box::new(Host {
            memory: Memory::new(memory_limit),
            log: RefCell::new(None),
            include: RefCell::new(None),
            undefined: RefCell::default(),
            code: RefCell::new(None),
            message: RefCell::new(String::new()),
            image: RefCell::new(None),
            pending: Cell::new(None),
        })));
        // SAFETY: `Host` begins with its `Memory` (repr(C)) and lives until `drop`, after the state is closed.
        let state = unsafe { lua::lua_newstate(allocate, host.as_ptr().cast()) };
        let Some(lua) = NonNull::new(state) else {
            // SAFETY: leaked above and given to nothing that still exists.
            drop(unsafe { Box::from_raw(host.as_ptr()) });
            return Err(Error::NoMemory);
        };
        let state = Self { lua, host };
        // SAFETY: the state is live; `settle` needs no argument.
        match unsafe { lua::lua_cpcall(state.raw(), settle, ptr::null_mut()) } {
            lua::LUA_OK => Ok(state),
            _ => Err(Error::NoMemory),
        }
    }

    /// A state with the sandbox's globals, ready to run programs. What is made in it is not garbage soon, so the collector
    /// rests until `run` or `collect`.
    pub(crate) fn new(
        memory_limit: usize,
        log: Option<LogSink>,
        include: Option<Include>,
    ) -> Result<Self, Error> {
        let prelude = Part::Prelude.code()?;
        let state = Self::bare(memory_limit)?;
        *state.host().log.borrow_mut() = log;
        *state.host().include.borrow_mut() = include;
        let code: &[u8] = &prelude;
        let status = state.protect(&[], |l| {
            // SAFETY: inside a protected call on a live state; the code outlives it.
            unsafe {
                lua::lua_gc(l, lua::LUA_GCSTOP, 0);
                library::install(l, code)
            }
        })?;
        if status != lua::LUA_OK {
            return Err(Error::Script(text_of(&state)));
        }
        Ok(state)
    }

    pub(crate) fn host(&self) -> &Host {
        // SAFETY: leaked in `bare`, freed in `drop`; only shared references to it exist.
        unsafe { self.host.as_ref() }
    }

    /// The raw state, for code of this module that makes its own calls.
    pub(super) fn raw(&self) -> *mut lua::lua_State {
        self.lua.as_ptr()
    }

    /// Replaces what finds included files.
    pub(crate) fn set_include(&self, include: Option<Include>) {
        *self.host().include.borrow_mut() = include;
    }

    /// Replaces the log.
    pub(crate) fn set_log(&self, sink: Option<LogSink>) {
        *self.host().log.borrow_mut() = sink;
    }

    /// Runs `work` in a protected call. It finds the values of the stack places `given` as its first values; what it
    /// leaves above them is left on the stack if it ends well.
    ///
    /// # Errors
    /// Lua's message if `work` raised an error. `work` must then own nothing with a destructor.
    pub(crate) fn protect<R>(
        &self,
        given: &[c_int],
        work: impl FnOnce(*mut lua::lua_State) -> R,
    ) -> Result<R, Error> {
        let mut result = None;
        let mut work = Some(work);
        let mut pending = |l: *mut lua::lua_State| result = work.take().map(|work| work(l));
        let pending: *mut dyn FnMut(*mut lua::lua_State) = &raw mut pending;
        // SAFETY: only the lifetime changes; `enter` takes the pointer out before this frame ends.
        let pending: Pending = unsafe { std::mem::transmute(pending) };
        self.host().pending.set(Some(pending));
        let l = self.raw();
        // SAFETY: the state is live; `bare` put `enter` into the registry; the stack has LUA_MINSTACK free places, of which `bind` keeps its own
        // account; no call outside of
        // `lua_pcall` needs memory.
        unsafe {
            let top = lua::lua_gettop(l);
            lua::lua_rawgeti_(l, lua::LUA_REGISTRYINDEX, ENTER);
            for index in given {
                lua::lua_pushvalue(l, *index);
            }
            let count = c_int::try_from(given.len()).unwrap_or(0);
            let status = lua::lua_pcall(l, count, lua::LUA_MULTRET, 0);
            self.host().pending.set(None);
            if status == lua::LUA_OK
                && let Some(result) = result
            {
                return Ok(result);
            }
            let text = text_at(l, -1);
            lua::lua_settop(l, top);
            Err(Error::Script(text))
        }
    }

    /// Calls the function below `arguments` values on the top, within a time budget. Like `lua_pcall`: on success
    /// `results` values are left, on failure the error alone.
    pub(crate) fn call(&mut self, arguments: c_int, results: c_int, budget_us: u32) -> bool {
        let l = self.raw();
        // SAFETY: the state is live and ours alone through `&mut`; `lua_pcall` lets no error out.
        unsafe {
            lua_budget(l, budget_us, || lua::lua_pcall(l, arguments, results, 0)) == lua::LUA_OK
        }
    }

    /// Runs the chunk `code` within a time budget.
    ///
    /// # Errors
    /// Lua's message.
    pub(crate) fn run(&mut self, code: &[u8], budget_us: u32) -> Result<(), Error> {
        self.protect(&[], |l| {
            // SAFETY: inside a protected call.
            unsafe { lua::lua_gc(l, lua::LUA_GCRESTART, 0) };
        })?;
        let l = self.raw();
        // SAFETY: the state is live and ours; `luaL_loadbuffer` is protected by itself and the code outlives it.
        let status = unsafe {
            lua::luaL_loadbuffer(l, code.as_ptr().cast(), code.len(), c"=config".as_ptr())
        };
        if status == lua::LUA_OK && self.call(0, 0, budget_us) {
            return Ok(());
        }
        let text = text_of(self);
        // SAFETY: takes off the error that the failed call left.
        unsafe { lua::lua_settop(l, -2) };
        Err(Error::Script(text))
    }

    /// Frees what is unreachable. Returns the bytes that are left.
    pub(crate) fn collect(&self) -> Result<usize, Error> {
        self.protect(&[], |l| {
            // SAFETY: inside a protected call.
            unsafe { lua::lua_gc(l, lua::LUA_GCCOLLECT, 0) };
        })?;
        self.host().memory.trim();
        Ok(self.host().memory.used())
    }

    /// Keeps the global `trikfs` as it is now in its stack place.
    pub(crate) fn keep_tree(&mut self) -> Result<(), Error> {
        self.protect(&[], |l| {
            // SAFETY: inside a protected call; the globals are a table.
            unsafe {
                lua::lua_pushlstring_(l, c"trikfs".as_ptr(), 6);
                lua::lua_rawget_(l, lua::LUA_GLOBALSINDEX);
            }
        })?;
        // SAFETY: `protect` left the value on the top.
        unsafe { lua::lua_replace(self.raw(), TREE_SLOT) };
        Ok(())
    }
}

impl Drop for State {
    fn drop(&mut self) {
        // SAFETY: made in `bare`, owned by us alone; the host goes last because closing frees through it.
        unsafe {
            lua::lua_close(self.raw());
            drop(Box::from_raw(self.host.as_ptr()));
        }
    }
}

/// The text of the error on the top of the stack.
pub(crate) fn text_of(state: &State) -> String {
    // SAFETY: the state is live; reading a value that is a string makes no calls that can fail.
    unsafe { text_at(state.raw(), -1) }
}

/// The text of the error value at `index`.
///
/// # Safety
/// The state must be live and the index valid.
unsafe fn text_at(l: *mut lua::lua_State, index: c_int) -> String {
    // SAFETY: a string is only looked at, a number is not converted in place (that would need memory).
    unsafe {
        match lua::lua_type(l, index) {
            lua::LUA_TSTRING => {
                let mut size = 0;
                let start = lua::lua_tolstring(l, index, &raw mut size);
                let bytes = std::slice::from_raw_parts(start.cast::<u8>(), size);
                let cut = bytes.get(..LOG_LINE_BYTES_MAX).unwrap_or(bytes);
                let text = String::from_utf8_lossy(cut);
                text.strip_prefix(library::NO_PLACE)
                    .unwrap_or(&text)
                    .to_owned()
            }
            lua::LUA_TNUMBER => lua::lua_tonumber(l, index).to_string(),
            other => format!("the error is not a text but a {}", type_name(other)),
        }
    }
}

/// Lua's word for a type number.
pub(crate) fn type_name(number: c_int) -> &'static str {
    match number {
        lua::LUA_TNIL => "nil",
        lua::LUA_TBOOLEAN => "boolean",
        lua::LUA_TNUMBER => "number",
        lua::LUA_TSTRING => "string",
        lua::LUA_TTABLE => "table",
        lua::LUA_TFUNCTION => "function",
        lua::LUA_TTHREAD => "coroutine",
        _ => "foreign value",
    }
}
