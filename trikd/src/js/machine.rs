//! One engine on one thread: made, limited, fed with the program, ended.
//!
//! Owns the order of things in a thread of a program, and what makes it end: its text, a failure, the end of all.

use super::failure::Failure as Thrown;
use super::natives::{self, Own};
use super::platform::{Mounted, Platform};
use super::shared::{Shared, Slot};
use crate::engine::{Failure, Outcome};
use crate::limits;
use lang_text::javascript as source;
use rquickjs::context::EvalOptions;
use rquickjs::{Context, Ctx, Error, Function, Object, Runtime, Value};
use std::rc::Rc;
use std::sync::Arc;

/// The name of the program's own text in backtraces; other files stand there with theirs.
pub const PROGRAM: &str = "<program>";
/// What the names of our own scripts begin with: they are not shown in backtraces.
pub const OWN: &str = "<trikd>";
/// The last line of a thread's text, which no person wrote.
const CALL: &str = "<trikd> thread";

/// What every engine begins with, in this order.
const SCRIPTS: [(&str, &str); 4] = [
    ("<trikd> base", include_str!("../../js/base.js")),
    ("<trikd> codes", include_str!("../../js/codes.js")),
    ("<trikd> robot", include_str!("../../js/robot.js")),
    ("<trikd> talk", include_str!("../../js/talk.js")),
];

/// What an engine does after the text of the program.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Kind {
    /// Nothing, or the events that the program asked for.
    Program,
    /// Calls a function, with variables of the thread that started it: JSON and a statement.
    Thread {
        /// Values of global variables.
        globals: String,
        /// The call.
        call: String,
    },
    /// One direct text after the other.
    Direct,
}

/// What an engine is made for.
#[derive(Clone, Debug)]
pub struct Job {
    /// The name of the thread.
    pub name: String,
    /// The text of the program.
    pub text: Arc<str>,
    /// What comes then.
    pub kind: Kind,
}

/// Evaluates a text in the global scope.
///
/// # Errors
/// An exception, which waits in the context.
pub fn evaluate<'js>(ctx: &Ctx<'js>, text: &str, name: &str) -> rquickjs::Result<Value<'js>> {
    if text.contains('\0') {
        let message = "a zero byte is in the text: is it a program?";
        return Err(rquickjs::Exception::throw_syntax(ctx, message));
    }
    let mut options = EvalOptions::default();
    options.strict = false;
    options.filename = Some(name.replace('\0', ""));
    ctx.eval_with_options(text, options)
}

/// Runs the promises that can go on.
pub fn run_jobs(ctx: &Ctx<'_>) {
    while ctx.execute_pending_job() {}
}

/// Runs one engine on the mounted tree to its end.
///
/// # Errors
/// The failure, if it was no end that was asked for.
pub fn run(job: &Job, shared: &Arc<Shared>, slot: &Arc<Slot>) -> Outcome {
    run_on(Rc::new(Mounted::new(&shared.root)), job, shared, slot)
}

/// Runs one engine to its end, on any platform.
///
/// # Errors
/// As [`run`].
pub fn run_on(
    platform: Rc<dyn Platform>,
    job: &Job,
    shared: &Arc<Shared>,
    slot: &Arc<Slot>,
) -> Outcome {
    let broken = |error: Error| Failure::Engine(error.to_string());
    let runtime = Runtime::new().map_err(broken)?;
    runtime.set_memory_limit(limits::JS_MEMORY_BYTES);
    runtime.set_max_stack_size(limits::JS_STACK_BYTES);
    let (asked, under, program) = (slot.clone(), platform.clone(), shared.clone());
    runtime.set_interrupt_handler(Some(Box::new(move || {
        program.pass(&asked);
        under.stops(&asked)
    })));
    let own = Rc::new(Own::new(platform, shared.clone(), slot.clone(), &job.text));
    let (lost, text) = (own.clone(), job.text.clone());
    runtime.set_host_promise_rejection_tracker(Some(Box::new(
        move |ctx, _promise, reason, is_handled| {
            let failure = (!is_handled).then(|| Thrown::new(&ctx, reason, &text));
            *lost.lost.borrow_mut() = failure;
        },
    )));
    let context = Context::full(&runtime).map_err(broken)?;
    context.with(|ctx| {
        let done = live(&ctx, job, &own);
        let failure = match done {
            Ok(()) => own.lost.borrow_mut().take(),
            Err(error) => Some(Thrown::of(&ctx, &error, &job.text)),
        };
        // An end that was asked for looks like a failure from inside.
        match failure.filter(|_| !slot.stops() && !shared.quits()) {
            Some(failure) => {
                let text = failure.of_program();
                if shared.debugger.failed(slot.who(), &text, failure.frames()) {
                    shared.bell.ring();
                    shared.pass(slot);
                }
                Err(Failure::Program(text))
            }
            None => Ok(()),
        }
    })
}

fn live<'js>(ctx: &Ctx<'js>, job: &Job, own: &Rc<Own>) -> rquickjs::Result<()> {
    let native = natives::make(ctx, own)?;
    let [base, rest @ ..] = SCRIPTS;
    let script = |(name, text)| evaluate(ctx, text, name)?.get::<Function<'js>>();
    let kit: Object<'js> = script(base)?.call((native,))?;
    for other in rest {
        script(other)?.call::<_, ()>((kit.clone(),))?;
    }
    // Before its first line, if that is wanted.
    own.shared.pass(&own.slot);
    match &job.kind {
        Kind::Program => {
            evaluate(ctx, &job.text, PROGRAM)?;
        }
        Kind::Thread { globals, call } => {
            let take: Function<'js> = kit.get("takeGlobals")?;
            // Before the text, which may ask for them, and after it, because it sets them to their first values.
            take.call::<_, ()>((globals.as_str(),))?;
            evaluate(ctx, source::without_call_of_main(&job.text), PROGRAM)?;
            take.call::<_, ()>((globals.as_str(),))?;
            evaluate(ctx, call, CALL)?;
        }
        Kind::Direct => own.events.set(true),
    }
    run_jobs(ctx);
    if own.events.get() && own.lost.borrow().is_none() {
        let survives = job.kind == Kind::Direct;
        let events: Function<'js> = kit.get("loop")?;
        events.call::<_, ()>((survives,))?;
    }
    Ok(())
}
