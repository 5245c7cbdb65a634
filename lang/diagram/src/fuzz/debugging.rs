//! Arbitrary bytes as a program in a debugger, orders to it and new versions of it: [`debugging`].
//!
//! Owns the small language of bytes that says orders, so that nearly all bytes mean something.

use std::rc::Rc;

use super::lowering::{Bytes, project};
use crate::debug::Session;
use crate::debug::desk::Desk;
use crate::limits;
use crate::lower::{World, lower};
use crate::machine::patch::{Version, WhenGone};
use crate::machine::trace::Deaf;
use crate::machine::{Machine, Options, STEP_MS};
use crate::program::Program;
use crate::project::Project;
use crate::stand_in::{Placing, StandIn};
use lang_text::json::is_json;
use lang_text::problem::Locale;

/// How much of the past is kept: little, so that some of it is forgotten.
const HISTORY_BYTES: usize = 100_000;
/// Orders of one input.
const ORDERS: u32 = 60;
/// The first word of an order, and what follows it.
const FORMS: [&str; 33] = [
    "attach",
    "detach",
    "look",
    "pause",
    "continue",
    "step into",
    "step over",
    "step out",
    "step over main",
    "until BLOCK",
    "back into",
    "back over",
    "back out",
    "back continue",
    "back to TIME",
    "back start",
    "present",
    "hold main",
    "release main",
    "break BLOCK",
    "break BLOCK from 2\nif TEXT",
    "break BLOCK once",
    "break BLOCK\nlog x is {TEXT}",
    "watch x",
    "watch x from 2\nif TEXT",
    "breakpoints after 1",
    "clear all",
    "clear 1",
    "breakpoints",
    "errors stop",
    "set x=TEXT",
    "evaluate TEXT",
    "TEXT",
];

/// Half of the bytes are a program, the rest orders, steps and versions.
pub fn debugging(bytes: &[u8]) {
    let (program, script) = bytes.split_at(bytes.len() / 2);
    let own = project(program);
    let Ok(lowered) = lower(&own, World::Robot) else {
        return;
    };
    let machine = Machine::new(Rc::new(lowered.program), Options::default());
    let mut desk = Desk::new(Session::alone(machine), Locale::English, HISTORY_BYTES);
    let mut robot = StandIn::new(Placing::default());
    let mut script = Bytes(script);
    let mut now = 0;
    for tag in 0..ORDERS {
        match script.below(8) {
            0 => {
                for _ in 0..script.below(30) {
                    now += STEP_MS;
                    robot.tick();
                    desk.step(now, &mut robot, &mut Deaf);
                }
            }
            1 => patch(&mut desk, &own, &mut script, &mut robot),
            _ => {
                let order = order(&mut script, desk.live().program());
                let answer = desk.order((tag, &order), now, &mut robot, &mut Deaf);
                assert!(is_json(&answer), "{order}: {answer}");
                assert!(answer.contains("\"done\":"), "{order}: {answer}");
            }
        }
        for news in desk.news() {
            assert!(news.starts_with('{') && is_json(&news), "{news}");
        }
        assert!(desk.live().views().count() <= limits::THREADS_MAX);
        let session = desk.session();
        assert!(session.debugger().breakpoints().count() <= limits::BREAKPOINTS_MAX);
        if let Some((_, bytes)) = session.kept() {
            // A copy and the answers of some steps may come on top.
            assert!(
                bytes < 10 * HISTORY_BYTES + 10 * session.live().weight(),
                "{bytes}"
            );
        }
    }
}

fn order(script: &mut Bytes<'_>, program: &Program) -> String {
    let form = FORMS[script.below(FORMS.len())];
    let block = program.id(script.below(program.len().max(1)) as u32);
    let time = script.below(40) as u32 * STEP_MS;
    form.replace("BLOCK", block.unwrap_or("nowhere"))
        .replace("TIME", &time.to_string())
        .replace("TEXT", &script.text())
}

/// Another program, or this one, in its place.
fn patch(desk: &mut Desk, own: &Project, script: &mut Bytes<'_>, robot: &mut StandIn) {
    let when_gone = WhenGone::ALL[script.below(WhenGone::ALL.len())];
    let length = script.below(100).min(script.0.len());
    let (bytes, rest) = script.0.split_at(length);
    script.0 = rest;
    let other = match length {
        0 => own,
        _ => &project(bytes),
    };
    let Ok(version) = Version::of(other, World::Robot) else {
        return;
    };
    let before = desk.live().views().count();
    if desk
        .session()
        .patch(&version, when_gone, robot, &mut Deaf)
        .is_err()
    {
        assert_eq!(desk.live().views().count(), before, "it was refused");
    }
}
