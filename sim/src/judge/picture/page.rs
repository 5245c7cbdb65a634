//! A run as a page for any browser: the field with robots that move, a bar of time, and what was said when.
//!
//! Owns the page, which needs no network and no other file. Its frame is `page.html`; every text of a run comes into it as
//! data, never as a tag.

use super::{body, ground};
use crate::field::Field;
use crate::judge::json;
use crate::judge::track::{Group, Track};
use crate::judge::trajectory::Trajectory;
use crate::judge::words;
use crate::limits;
use lang_constraint::{Entry, Level};
use lang_text::escape::escaped;
use lang_text::problem::Locale;
use std::fmt::Write as _;

/// The frame.
const FRAME: &str = include_str!("page.html");

/// What a page tells beside the run.
#[derive(Clone, Copy, Debug)]
pub struct Caption<'a> {
    /// Of what it is.
    pub title: &'a str,
    /// How it ended.
    pub verdict: &'a str,
    /// Whether that is good.
    pub is_good: bool,
    /// Language of the page's own words.
    pub locale: Locale,
    /// What the robot and its program did.
    pub track: &'a Track,
}

/// The page of a run.
pub fn page(
    field: &Field,
    trajectory: &Trajectory,
    entries: &[Entry],
    caption: Caption<'_>,
) -> String {
    let mut svg = ground(field, trajectory, caption.locale);
    for robot in 0..trajectory.robots.len() {
        svg.tag("g").with("id", format_args!("robot{robot}")).open();
        body(robot, &mut svg);
        svg.end();
    }
    let svg = svg.finish();
    let names = words::page(caption.locale);
    let (play, keys) = (words::play(caption.locale), words::keys(caption.locale));
    let language = match caption.locale {
        Locale::English => "en",
        Locale::Russian => "ru",
    };
    let data = data(trajectory, entries, caption);
    let parts: [(&str, &str); 13] = [
        ("LANG", language),
        ("TITLE", &escaped(caption.title)),
        ("CLASS", if caption.is_good { "good" } else { "bad" }),
        ("VERDICT", &escaped(caption.verdict)),
        ("TIME", names[0]),
        ("SPEED", names[1]),
        ("SAID", names[2]),
        ("STATE", names[3]),
        ("SECOND", words::second(caption.locale)),
        ("PLAY", play),
        ("KEYS", keys),
        ("SVG", svg.trim_end()),
        ("DATA", &data),
    ];
    // One walk, so that a text of the run cannot bring a mark of its own.
    let mut out = String::with_capacity(FRAME.len() + svg.len() + data.len());
    let mut rest = FRAME;
    while let Some(at) = rest.find('{') {
        let (before, behind) = rest.split_at(at);
        out.push_str(before);
        let mark = |(name, _): &&(&str, &str)| {
            behind[1..]
                .strip_prefix(*name)
                .is_some_and(|tail| tail.starts_with('}'))
        };
        match parts.iter().find(mark) {
            Some((name, text)) => {
                out.push_str(text);
                rest = &behind[name.len() + 2..];
            }
            None => {
                out.push('{');
                rest = &behind[1..];
            }
        }
    }
    out.push_str(rest);
    out
}

fn data(trajectory: &Trajectory, entries: &[Entry], caption: Caption<'_>) -> String {
    let mut out = String::from("{\"robots\":[");
    let mut end = 0.0f64;
    for robot in 0..trajectory.robots.len() {
        out.push_str(if robot == 0 { "[" } else { ",[" });
        let count = trajectory.poses(robot as u16).count();
        let every = count.div_ceil(limits::PAGE_POSES).max(1);
        let mut is_first = true;
        for (index, [ms, x, y, degrees]) in trajectory.poses(robot as u16).enumerate() {
            end = end.max(ms);
            if index % every != 0 && index + 1 != count {
                continue;
            }
            out.push_str(if is_first { "" } else { "," });
            is_first = false;
            let _ = write!(out, "[{ms},{x:.2},{y:.2},{degrees:.2}]");
        }
        out.push(']');
    }
    out.push_str("],\"said\":[");
    let mut is_first = true;
    for entry in entries {
        let level = match entry.level {
            Level::Info => "info",
            Level::Warning => "warning",
            Level::Error | Level::Critical => "error",
            Level::Log => "log",
            Level::Variables => continue,
        };
        end = end.max(entry.at_ms as f64);
        out.push_str(if is_first { "" } else { "," });
        is_first = false;
        let _ = write!(out, "[{},\"{level}\",", entry.at_ms);
        json::text(&mut out, &entry.line());
        out.push(']');
    }
    out.push_str("],\"groups\":[");
    for (index, group) in Group::ALL.into_iter().enumerate() {
        out.push_str(if index == 0 { "[" } else { ",[" });
        json::text(&mut out, words::group(group, caption.locale));
        for column in caption.track.columns() {
            if column.group != group {
                continue;
            }
            out.push_str(",[");
            json::text(&mut out, &column.name);
            for (ms, value) in &column.changes {
                end = end.max(f64::from(*ms));
                let _ = write!(out, ",{ms},");
                json::text(&mut out, value);
            }
            out.push(']');
        }
        out.push(']');
    }
    let _ = write!(out, "],\"end\":{end}}}");
    out
}
