//! Tests of the watchdog: lateness, budgets, compiled loops.

use super::*;
use std::ffi::{CStr, CString};
use std::sync::mpsc;

/// A state for one test, closed with it.
struct State(*mut lua::lua_State);

impl State {
    fn new() -> Self {
        // SAFETY: no preconditions; the libraries are opened on a live state with nothing else on its stack.
        unsafe {
            let state = lua::luaL_newstate();
            assert!(!state.is_null());
            lua::luaL_openlibs(state);
            Self(state)
        }
    }

    /// Runs a chunk under a budget; the error's text if it fails.
    fn run(&self, budget_us: u32, source: &str) -> Result<(), String> {
        let source = CString::new(source).unwrap();
        // SAFETY: the state is live, of this thread alone, and every call that can raise is a protected one.
        unsafe {
            assert_eq!(lua::luaL_loadstring(self.0, source.as_ptr()), 0);
            let status = lua_budget(self.0, budget_us, || lua::lua_pcall(self.0, 0, 0, 0));
            if status == 0 {
                return Ok(());
            }
            let text = CStr::from_ptr(lua::lua_tostring(self.0, -1))
                .to_string_lossy()
                .into_owned();
            lua::lua_settop(self.0, 0);
            Err(text)
        }
    }
}

impl Drop for State {
    fn drop(&mut self) {
        // SAFETY: `State::new` made it and nobody else has it.
        unsafe { lua::lua_close(self.0) };
    }
}

fn ends_in_time(source: &str) {
    let error = State::new().run(20_000, source).unwrap_err();
    assert!(error.ends_with("time budget spent (20000 us)"), "{error}");
}

#[test]
fn a_compiled_endless_loop_is_ended() {
    ends_in_time("while true do end");
    ends_in_time("local x = 0 for i = 1, 1e18 do x = x + i end");
    ends_in_time("local function f() return f() end f()");
    ends_in_time(
        "local t = setmetatable({}, {__index = function(t, k) return k end}) while t[1] do end",
    );
}

#[test]
fn loops_are_compiled_on_this_processor() {
    let loops =
        "local x = 0 for i = 1, 1000 do x = x + i end assert(jit.status(), 'the compiler is off')
        assert(require('jit.util').traceinfo(1), 'nothing was compiled')";
    assert_eq!(State::new().run(5_000_000, loops), Ok(()));
}

#[test]
fn pcall_cannot_swallow_the_end() {
    ends_in_time("while true do pcall(function() while true do end end) end");
    ends_in_time("while true do pcall(coroutine.wrap(function() while true do end end)) end");
}

#[test]
fn a_coroutine_is_ended_too() {
    ends_in_time("local c = coroutine.wrap(function() while true do end end) c()");
    ends_in_time(
        "local c = coroutine.wrap(function() while true do coroutine.yield() end end) while true do c() end",
    );
}

#[test]
fn a_state_works_again_after_its_budget_was_spent() {
    let state = State::new();
    for _ in 0..3 {
        assert!(state.run(5_000, "while true do end").is_err());
        assert_eq!(
            state.run(
                5_000_000,
                "local x = 0 for i = 1, 1e7 do x = x + i end assert(x > 0)"
            ),
            Ok(())
        );
    }
}

#[test]
fn the_message_names_the_line() {
    let error = State::new()
        .run(5_000, "\n\nwhile true do\nend")
        .unwrap_err();
    assert!(
        error.contains("\"]:3: ") || error.contains("\"]:4: "),
        "{error}"
    );
}

#[test]
fn calls_can_be_nested_on_two_states() {
    let (outer, inner) = (State::new(), State::new());
    // SAFETY: both states are live and of this thread; `run` lets no error out.
    unsafe {
        lua_budget(outer.0, 1_000_000, || {
            assert!(inner.run(5_000, "while true do end").is_err());
            assert_eq!(outer.run(5_000_000, "for i = 1, 1e6 do end"), Ok(()));
        });
    }
    assert!(outer.run(5_000, "while true do end").is_err());
}

#[test]
fn many_threads_are_ended_each_by_its_own_budget() {
    std::thread::scope(|scope| {
        for budget in [2_000, 5_000, 9_000, 30_000] {
            scope.spawn(move || {
                let error = State::new().run(budget, "while true do end").unwrap_err();
                assert!(error.contains(&format!("({budget} us)")), "{error}");
            });
        }
    });
}

#[test]
fn late_work_is_told_once_and_short_work_never() {
    let (tell, told) = mpsc::channel();
    let seat = Seat::take(
        Urgency::Awaited,
        Arc::new(move || {
            let _ = tell.send(());
        }),
    );
    seat.begin();
    seat.begin();
    seat.end();
    told.recv_timeout(Duration::from_secs(60))
        .expect("the watchdog tells of late work");
    let (tell_other, told_other) = mpsc::channel();
    let other = Seat::take(
        Urgency::Awaited,
        Arc::new(move || {
            let _ = tell_other.send(());
        }),
    );
    other.begin();
    told_other
        .recv_timeout(Duration::from_secs(60))
        .expect("a second seat is told of as well");
    // The rounds that found the second seat late passed the first one by.
    assert!(told.try_recv().is_err());
    other.end();
    seat.end();
}

#[test]
fn work_that_nobody_waits_for_is_late_too_if_it_does_not_end() {
    for _ in 0..3 {
        let (tell, told) = mpsc::channel();
        let seat = Seat::take(
            Urgency::Background,
            Arc::new(move || {
                let _ = tell.send(());
            }),
        );
        for _ in 0..100 {
            seat.begin();
            seat.end();
        }
        seat.begin();
        told.recv_timeout(Duration::from_secs(60))
            .expect("the watchdog tells of late work");
        seat.end();
    }
}

#[test]
fn the_watchdog_wakes_after_it_slept() {
    let (tell, told) = mpsc::channel();
    let seat = Seat::take(
        Urgency::Awaited,
        Arc::new(move || {
            let _ = tell.send(());
        }),
    );
    for _ in 0..3 {
        seat.begin();
        told.recv_timeout(Duration::from_secs(60))
            .expect("the watchdog is awake");
        seat.end();
    }
    drop(seat);
    assert!(
        told.recv_timeout(Duration::from_secs(60)).is_err(),
        "the sender is gone with the seat"
    );
}

#[test]
fn a_panicking_callback_does_not_end_the_watch() {
    let (tell_first, told_first) = mpsc::channel();
    let seat = Seat::take(
        Urgency::Awaited,
        Arc::new(move || {
            let _ = tell_first.send(());
            panic!("on purpose, in a test");
        }),
    );
    seat.begin();
    told_first
        .recv_timeout(Duration::from_secs(60))
        .expect("the callback is called");
    seat.end();
    let (tell, told) = mpsc::channel();
    let seat = Seat::take(
        Urgency::Awaited,
        Arc::new(move || {
            let _ = tell.send(());
        }),
    );
    seat.begin();
    told.recv_timeout(Duration::from_secs(60))
        .expect("the watchdog lives");
    seat.end();
}
