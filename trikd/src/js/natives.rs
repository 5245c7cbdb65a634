//! The functions that our scripts in JavaScript stand on: what cannot be said in the language itself.
//!
//! Owns what one engine has beside its values. `robot` has the functions over the tree, `media` those of display and
//! pictures, `system` those over files, processes and other threads.

pub mod media;
pub mod robot;
pub mod system;

use super::events::Record;
use super::failure::{self, Failure};
use super::machine::run_jobs;
use super::platform::Platform;
use super::shared::{Event, Shared, Slot};
use crate::brick::Brick;
use crate::limits;
use rquickjs::{Array, Ctx, Exception, Function, IntoJs, Object, Value};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;

/// What an engine has.
pub struct Own {
    /// What it runs on.
    pub platform: Rc<dyn Platform>,
    /// The robot.
    pub brick: Brick,
    /// The program.
    pub shared: Arc<Shared>,
    /// Its own slot in it.
    pub slot: Arc<Slot>,
    /// Whether it lives on after its text.
    pub events: Cell<bool>,
    /// A promise that failed and nobody looked.
    pub lost: RefCell<Option<Failure>>,
    text: Arc<str>,
}

impl Own {
    /// For one thread of a program with this text.
    pub fn new(
        platform: Rc<dyn Platform>,
        shared: Arc<Shared>,
        slot: Arc<Slot>,
        text: &Arc<str>,
    ) -> Self {
        Self {
            brick: platform.brick(),
            platform,
            shared,
            slot,
            events: Cell::new(false),
            lost: RefCell::default(),
            text: text.clone(),
        }
    }

    /// Tells who looks on at which line the program is, if somebody does.
    pub fn stand(&self, ctx: &Ctx<'_>) {
        if self.platform.is_watched()
            && let Some((file, line)) = failure::call_site(ctx)
        {
            self.platform.stand(&self.slot, &file, line);
        }
        if self.shared.debugger.is_attached() {
            let calls = failure::calls(ctx);
            self.shared.debugger.stand(self.slot.who(), calls);
            self.shared.pass(&self.slot);
        }
    }
}

/// An exception with a message.
pub fn failed(ctx: &Ctx<'_>, message: impl std::fmt::Display) -> rquickjs::Error {
    Exception::throw_message(ctx, &message.to_string())
}

/// Puts a function into the object.
pub fn put<'js, P, F>(object: &Object<'js>, name: &str, function: F) -> rquickjs::Result<()>
where
    F: rquickjs::function::IntoJsFunc<'js, P> + 'js,
{
    let function = Function::new(object.ctx().clone(), function)?;
    object.set(name, function)
}

/// The object with all of them.
///
/// # Errors
/// No memory.
pub fn make<'js>(ctx: &Ctx<'js>, own: &Rc<Own>) -> rquickjs::Result<Object<'js>> {
    let native = Object::new(ctx.clone())?;
    native.set("timersMax", limits::JS_TIMERS)?;
    events(&native, own)?;
    robot::install(&native, own)?;
    media::install(&native, own)?;
    system::install(&native, own)?;
    Ok(native)
}

fn events<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let with = || own.clone();
    let o = with();
    put(native, "clock", move || o.platform.clock_ms())?;
    let o = with();
    put(native, "next", move |ctx: Ctx<'js>, until_ms: f64| {
        next(&ctx, &o, until_ms)
    })?;
    let o = with();
    put(
        native,
        "listen",
        move |ctx: Ctx<'js>, path: String, numbers: usize| {
            o.platform
                .listen(&o.brick, &path, numbers)
                .map_err(|error| robot::unreadable(&ctx, &o.brick, &path, &error))
        },
    )?;
    let o = with();
    put(native, "tryListen", move |path: String, numbers: usize| {
        o.platform.listen(&o.brick, &path, numbers).is_ok()
    })?;
    let o = with();
    put(native, "forget", move |path: String| {
        o.platform.forget(&path);
    })?;
    let o = with();
    put(native, "drain", move |ctx: Ctx<'js>, path: String| {
        let all = Array::new(ctx.clone())?;
        for (index, record) in o.platform.drain(&path).into_iter().enumerate() {
            all.set(index, value(&ctx, record)?)?;
        }
        Ok::<_, rquickjs::Error>(all)
    })?;
    let o = with();
    put(native, "mentions", move |word: String| {
        o.text.contains(&word)
    })?;
    let o = with();
    put(native, "run", move || {
        if !o.events.replace(true) {
            o.shared.say(|output| output.events());
        }
    })?;
    let o = with();
    put(native, "quit", move || o.shared.quit(Some(&o.slot)))?;
    let o = with();
    put(native, "date", move || o.platform.date_ms())?;
    let o = with();
    put(native, "random", move |low: f64, high: f64| {
        o.platform.random(low as i32, high as i32)
    })
}

fn value<'js>(ctx: &Ctx<'js>, record: Record) -> rquickjs::Result<Value<'js>> {
    match record {
        Record::Numbers(numbers) => numbers.into_js(ctx),
        Record::Line(line) => line.into_js(ctx),
    }
}

/// A source and what it gives.
fn event<'js, const N: usize>(
    ctx: &Ctx<'js>,
    source: &str,
    values: [Value<'js>; N],
) -> rquickjs::Result<Value<'js>> {
    let event = Array::new(ctx.clone())?;
    event.set(0, source)?;
    for (index, value) in values.into_iter().enumerate() {
        event.set(index + 1, value)?;
    }
    Ok(event.into_value())
}

/// The next event as its source and values, null when the time has come or something has changed. Throws when the
/// program is to end.
fn next<'js>(ctx: &Ctx<'js>, own: &Own, until_ms: f64) -> rquickjs::Result<Value<'js>> {
    let mut woken = false;
    loop {
        run_jobs(ctx);
        if own.slot.stops() || own.shared.quits() {
            return Err(failed(ctx, "the program ends"));
        }
        if let Some(told) = own.slot.next() {
            return match told {
                Event::Mail(hull, text) => {
                    event(ctx, "mail", [hull.into_js(ctx)?, text.into_js(ctx)?])
                }
                Event::Direct(text) => event(ctx, "direct", [text.into_js(ctx)?]),
                Event::Web => event(ctx, "web", []),
            };
        }
        if let Some((path, record)) = own.platform.next() {
            return event(ctx, &path, [value(ctx, record)?]);
        }
        if woken {
            return Ok(Value::new_null(ctx.clone()));
        }
        own.stand(ctx);
        own.shared.debugger.waits(own.slot.who(), true);
        let waited = own.platform.wait(&own.slot, until_ms);
        own.shared.debugger.waits(own.slot.who(), false);
        own.shared.pass(&own.slot);
        waited.map_err(|error| failed(ctx, format!("nothing can be waited for: {error}")))?;
        woken = true;
    }
}
