//! Output, files, processes, the mailbox and other threads for our scripts.
//!
//! Owns what a program may do beside its robot: everything that the user of programs may, and no more.

use super::{Own, failed, put};
use crate::js::failure::Failure;
use crate::js::machine::{Job, Kind, evaluate};
use rquickjs::{Ctx, Error, Object, Value};
use std::io;
use std::rc::Rc;
use std::sync::Arc;

/// The functions around the robot.
///
/// # Errors
/// No memory.
pub fn install<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    output(native, own)?;
    texts(native, own)?;
    files(native, own)?;
    mailbox(native, own)?;
    threads(native, own)
}

fn output<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(native, "print", move |text: String| {
        o.shared.say(|output| output.print(&text));
        o.platform.has_spoken();
    })?;
    let o = own.clone();
    put(native, "info", move |text: String| {
        o.shared.say(|output| output.info(&text));
    })?;
    let o = own.clone();
    put(native, "web", move |json: String| {
        o.shared.say(|output| output.web(&json));
    })
}

/// Texts of programs that come later.
fn texts<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(native, "include", move |ctx: Ctx<'js>, file: String| {
        let text = o.platform.include(&o.shared, &file);
        let text = text.map_err(|reason| failed(&ctx, format!("include: {reason}")))?;
        evaluate(&ctx, &text, &file).map(drop)
    })?;
    let o = own.clone();
    put(native, "direct", move |ctx: Ctx<'js>, text: String| {
        let failure = match evaluate(&ctx, &text, crate::js::machine::PROGRAM) {
            Ok(_) => {
                super::run_jobs(&ctx);
                o.lost.borrow_mut().take()
            }
            Err(error) => Some(Failure::of(&ctx, &error, &text)),
        };
        if let Some(failure) = failure {
            survive(&o, &failure);
        }
    })?;
    let o = own.clone();
    put(
        native,
        "survive",
        move |ctx: Ctx<'js>, error: Value<'js>| survive(&o, &Failure::new(&ctx, error, &o.text)),
    )
}

/// Tells a failure that ends nothing; false when the program is to end.
fn survive(own: &Own, failure: &Failure) -> bool {
    let lives = !own.slot.stops() && !own.shared.quits();
    if lives {
        own.shared.say(|output| output.error(&failure.of_direct()));
    }
    lives
}

fn files<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let told =
        |ctx: &Ctx<'js>, file: &str, error: &io::Error| failed(ctx, format!("{file}: {error}"));
    let o = own.clone();
    put(
        native,
        "append",
        move |ctx: Ctx<'js>, file: String, text: String| {
            let done = o.platform.append(&o.shared, &file, text.as_bytes());
            done.map_err(|error| told(&ctx, &file, &error))
        },
    )?;
    let o = own.clone();
    put(
        native,
        "appendBytes",
        move |ctx: Ctx<'js>, file: String, bytes: Vec<u8>| {
            let done = o.platform.append(&o.shared, &file, &bytes);
            done.map_err(|error| told(&ctx, &file, &error))
        },
    )?;
    let o = own.clone();
    put(native, "readAll", move |ctx: Ctx<'js>, file: String| {
        let text = o.platform.read_file(&o.shared, &file);
        let text = text.map_err(|reason| failed(&ctx, reason))?;
        let lines = text.split_inclusive('\n').map(str::to_owned);
        Ok::<_, Error>(lines.collect::<Vec<_>>())
    })?;
    let o = own.clone();
    put(native, "remove", move |ctx: Ctx<'js>, file: String| {
        let done = o.platform.remove(&o.shared, &file);
        done.map_err(|error| told(&ctx, &file, &error))
    })?;
    let o = own.clone();
    put(
        native,
        "system",
        move |ctx: Ctx<'js>, command: String, waits: bool| {
            let code = o.platform.system(&o.shared, &command, waits);
            code.map_err(|error| failed(&ctx, format!("script.system: {error}")))
        },
    )
}

fn mailbox<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(native, "mailbox", move |ctx: Ctx<'js>, words: String| {
        let answer = o.platform.mailbox(&o.shared, words);
        answer.map_err(|error| failed(&ctx, format!("mailbox: {error}")))
    })?;
    let o = own.clone();
    put(native, "takeMail", move || o.shared.take_mail())?;
    let o = own.clone();
    put(native, "hasMail", move || o.shared.has_mail())
}

fn threads<'js>(native: &Object<'js>, own: &Rc<Own>) -> rquickjs::Result<()> {
    let o = own.clone();
    put(
        native,
        "startThread",
        move |ctx: Ctx<'js>, name: String, globals: String, call: String| {
            let job = Job {
                name,
                text: Arc::clone(&o.text),
                kind: Kind::Thread { globals, call },
            };
            o.platform
                .start(&o.shared, job)
                .map_err(|reason| failed(&ctx, format!("Threading: {reason}")))
        },
    )?;
    let o = own.clone();
    put(native, "isRunning", move |ctx: Ctx<'js>, name: String| {
        if name == o.slot.name {
            return Err(failed(
                &ctx,
                "Threading: a thread cannot wait for its own end",
            ));
        }
        Ok(o.shared.runs(Some(&name)))
    })?;
    let o = own.clone();
    put(native, "killThread", move |name: String| {
        o.shared.kill(|other| other == name);
        o.platform.give_way();
    })?;
    let o = own.clone();
    put(native, "killOthers", move || {
        o.shared
            .kill(|other| other != o.slot.name && other != crate::js::shared::MAIN);
        o.platform.give_way();
    })?;
    let o = own.clone();
    put(native, "sendMessage", move |name: String, text: String| {
        o.shared.leave_note(&name, text);
        o.platform.give_way();
    })?;
    let o = own.clone();
    put(native, "takeMessage", move || {
        o.shared.take_note(&o.slot.name)
    })
}
