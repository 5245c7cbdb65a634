//! Why a run ended as it did, as `trik check --explain` and the studio tell it: lines for people, and a value for JSON.
//!
//! Owns both forms. What is known is kept by `lang-constraint`, for rules, and by `sim`, for the blocks of programs.

pub mod words;

use crate::verdict::Verdict;
use lang_constraint::{Explained, Kind, Near, Seen, Standing, Unit};
use lang_diagram::stand_in::PIXELS_IN_CM;
use lang_text::problem::Locale;
use serde_json::{Value, json};
use sim::judge::{Outcome, Running, Spot};

/// What is told of a run: an object, whose `text` has the lines for people.
pub fn explanation(outcome: &Outcome, locale: Locale) -> Value {
    let verdict = Verdict::of(outcome);
    let rules = outcome.explanation.as_ref();
    let told: &[Explained] = rules.map_or(&[], |rules| &rules.rules);
    let decided = told.iter().find(|rule| rule.decided);
    let mut lines = vec![words::why(
        verdict,
        decided.map(|rule| named(rule, locale)),
        outcome.ms,
        locale,
    )];
    for rule in told {
        lines.extend(rule_lines(rule, locale));
    }
    let more = rules.map_or(0, |rules| rules.more);
    if more > 0 {
        lines.push(format!("  {}", words::more(more, locale)));
    }
    lines.extend(
        outcome
            .running
            .iter()
            .map(|one| words::running(one, locale)),
    );
    json!({
        "text": lines,
        "ms": outcome.ms,
        "decided_by": decided.map(|rule| json!({
            "kind": kind(rule.kind), "id": rule.id, "number": rule.number,
        })),
        "rules": told.iter().map(rule_json).collect::<Vec<_>>(),
        "more_rules": more,
        "threads": outcome.running.iter().map(|one| thread_json(one, locale)).collect::<Vec<_>>(),
    })
}

/// A rule as people find it: its tag, and its id or its place.
fn named(rule: &Explained, locale: Locale) -> String {
    words::rule(rule.kind, &rule.id, rule.number, locale)
}

/// A kind of rules for programs.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Event => "event",
        Kind::Constraint => "constraint",
        Kind::TimeLimit => "timelimit",
        Kind::Init => "init",
    }
}

fn rule_lines(rule: &Explained, locale: Locale) -> Vec<String> {
    let by: Vec<String> = rule
        .set_up_by
        .iter()
        .map(|(kind, id, number)| words::rule(*kind, id, *number, locale))
        .collect();
    let standing = match (rule.fired_ms, rule.state) {
        (Some(ms), _) => words::fired(rule.kind, ms, locale),
        (None, Standing::Alive) => words::never_true(locale),
        (None, Standing::Dropped) => words::dropped(locale),
        (None, Standing::NeverSetUp) => words::never_set_up(&by.join(", "), locale),
    };
    let mut lines = vec![format!("  {}: {standing}", named(rule, locale))];
    for seen in &rule.conditions {
        let indent = "  ".repeat(seen.depth + 2);
        lines.push(format!("{indent}{}", condition_line(rule, seen, locale)));
    }
    if rule.more > 0 {
        lines.push(format!("    {}", words::more(rule.more, locale)));
    }
    lines
}

fn condition_line(rule: &Explained, seen: &Seen, locale: Locale) -> String {
    if is_head(seen) {
        return format!("{}:", words::head(&seen.text, locale));
    }
    let not = if seen.negated { words::not(locale) } else { "" };
    let mut line = format!("{not}{}: ", seen.text);
    let is_met = seen.holds.map(|holds| holds != seen.negated);
    match is_met {
        None => line.push_str(words::not_looked_at(locale)),
        Some(is_met) => {
            line.push_str(words::holds(is_met, locale));
            line.push_str(&values(seen, locale));
        }
    }
    // Of what has fired, and of what is met, it is known how near it came.
    if let (None, Some(false), Some(near)) = (rule.fired_ms, is_met, &seen.nearest) {
        line.push_str(&words::nearest(&distance(near, locale), near.at_ms, locale));
    }
    line
}

/// The values of both sides; only that of the left side if the right one is written there.
fn values(seen: &Seen, locale: Locale) -> String {
    let [left, right] = &seen.values[..] else {
        return String::new();
    };
    let is_timer = matches!(&seen.nearest, Some(near) if near.unit == Unit::Milliseconds);
    match () {
        () if is_timer => format!(" ({left} {})", words::units(locale).ms),
        () if seen.text.ends_with(&format!(" {right}")) => format!(" ({left})"),
        () => format!(" ({})", words::values(left, right, locale)),
    }
}

fn is_head(seen: &Seen) -> bool {
    matches!(&*seen.text, "and" | "or")
}

/// A gap with its unit, as `12.4 px = 4.3 cm`.
fn distance(near: &Near, locale: Locale) -> String {
    let units = words::units(locale);
    match near.unit {
        Unit::Value => short(near.gap, 3),
        Unit::Milliseconds => format!("{} {}", short(near.gap, 0), units.ms),
        Unit::Pixels => format!(
            "{} {} = {} {}",
            short(near.gap, 1),
            units.px,
            short(near.gap / PIXELS_IN_CM, 1),
            units.cm
        ),
    }
}

fn short(number: f64, digits: usize) -> String {
    let text = format!("{number:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

fn rule_json(rule: &Explained) -> Value {
    json!({
        "kind": kind(rule.kind),
        "id": rule.id,
        "number": rule.number,
        "decided": rule.decided,
        "fired_ms": rule.fired_ms,
        "state": match rule.state {
            Standing::Alive => "alive",
            Standing::Dropped => "dropped",
            Standing::NeverSetUp => "never_set_up",
        },
        "set_up_by": rule.set_up_by.iter()
            .map(|(of, id, number)| json!({"kind": kind(*of), "id": id, "number": number}))
            .collect::<Vec<_>>(),
        "conditions": rule.conditions.iter().map(condition_json).collect::<Vec<_>>(),
        "more_conditions": rule.more,
    })
}

fn condition_json(seen: &Seen) -> Value {
    let nearest = seen.nearest.map(|near| {
        let unit = match near.unit {
            Unit::Value => "value",
            Unit::Pixels => "px",
            Unit::Milliseconds => "ms",
        };
        json!({"gap": near.gap, "unit": unit, "ms": near.at_ms})
    });
    json!({
        "text": seen.text,
        "depth": seen.depth,
        "negated": seen.negated,
        "holds": seen.holds,
        "values": seen.values,
        "nearest": nearest,
    })
}

fn thread_json(one: &Running, locale: Locale) -> Value {
    match &one.at {
        Spot::Block {
            diagram,
            id,
            kind,
            caption,
        } => {
            let caption = caption.in_locale(locale);
            json!({
                "thread": one.thread,
                "ended_ms": one.ended_ms,
                "diagram": diagram,
                "block": {"id": id, "kind": kind, "caption": caption},
            })
        }
        Spot::Line { file, line, at_ms } => json!({
            "thread": one.thread,
            "ended_ms": one.ended_ms,
            "file": file,
            "line": line,
            "at_ms": at_ms,
        }),
    }
}

/// The lines of such a value.
pub fn lines(explanation: &Value) -> impl Iterator<Item = &str> {
    let text = explanation.get("text").and_then(Value::as_array);
    text.into_iter().flatten().filter_map(Value::as_str)
}
