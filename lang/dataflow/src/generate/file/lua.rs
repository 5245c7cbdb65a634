//! A converter in Lua.
//!
//! Owns where things stand in the file. What the helpers do is in `run.lua`.

use super::super::plan::{Field, Plan, sensor_name, shape};
use super::super::step::{Body, Routine, Step};
use super::super::target::Target;
use super::{lines, makes, syntax, title};
use crate::limits;
use crate::machine::POLL_MS;
use lang_expr::reserved::Shape;
use std::fmt::Write;

/// What every converter has, before and after its own functions.
const RUN: &str = include_str!("run.lua");
/// Where its own functions stand in that.
const HERE: &str = "  -- the program\n";

pub(super) fn assemble(plan: &Plan<'_>, body: &Body) -> String {
    let (before, after) = RUN.split_once(HERE).unwrap_or((RUN, ""));
    let mut out = format!(
        "-- {}: a program of data flow as a converter, for dataflow {{ program = 'FILE.lua', ... }}.\n",
        title(plan)
    );
    let _ = writeln!(
        out,
        "local FIRINGS_MAX, DELIVERIES_MAX, ITEMS_MAX, INSTANTS_MAX = {}, {}, {}, {}\nlocal QUEUED_MAX, POLL_MS = {}, {POLL_MS}",
        limits::FIRINGS_MAX,
        limits::DELIVERIES_MAX,
        limits::ITEMS_MAX,
        limits::CONVERTER_INSTANTS_MAX,
        limits::QUEUED_CELLS_MAX
    );
    out.push_str(before);
    for field in &plan.fields {
        let _ = match field {
            Field::Number(name, start) => writeln!(out, "  s.{name} = {start}"),
            Field::Value(_) => Ok(()),
            Field::Queue(name) => writeln!(out, "  s.{name} = {{ first = 1, last = 0 }}"),
        };
    }
    routines(&body.reactions, "reactions", "token", &mut out);
    routines(&body.ticks, "ticks", "due", &mut out);
    function("begin", &body.start, &mut out);
    function("poll", &body.poll, &mut out);
    out.push_str(after);
    let _ = writeln!(out, "return {{\n  name = '{}',", title(plan));
    out.push_str("  inputs = {\n");
    for &sensor in &plan.inputs {
        let count = match shape(sensor) {
            Some(Shape::Numbers(count)) => count,
            Some(Shape::Number) | None => 0,
        };
        let (name, field) = (sensor_name(sensor), plan.reading(sensor));
        let _ = writeln!(
            out,
            "    {{ name = '{name}', field = '{field}', count = {count} }},"
        );
    }
    out.push_str("  },\n  outputs = {\n");
    for &port in &plan.outputs {
        let (name, field) = (port.name(), plan.told(port));
        let _ = writeln!(out, "    {{ name = '{name}', field = '{field}' }},");
    }
    out.push_str("  },\n  variables = {\n");
    for (name, field) in plan.variables() {
        let _ = writeln!(out, "    {{ name = '{name}', field = '{field}' }},");
    }
    out.push_str("  },\n  new = new,\n}\n");
    out
}

fn routines(all: &[Routine], table: &str, parameter: &str, out: &mut String) {
    for (at, routine) in all.iter().enumerate() {
        let at = at + 1;
        let about = &routine.about;
        let _ = writeln!(out, "\n  names.{table}[{at}] = '{about}'");
        let _ = writeln!(out, "  {table}[{at}] = function({parameter})");
        inner(&routine.steps, out);
        out.push_str("  end\n");
    }
}

fn function(name: &str, steps: &[Step], out: &mut String) {
    let _ = writeln!(out, "\n  local function {name}()");
    inner(steps, out);
    out.push_str("  end\n");
}

fn inner(steps: &[Step], out: &mut String) {
    if makes(steps) {
        out.push_str("    local made\n");
    }
    lines(syntax(Target::Lua), steps, 2, out);
}
