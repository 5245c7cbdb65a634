//! `trik grade-status`: how much is where in the queue, as lines or as a page.
//!
//! Owns both forms.

use super::args::StatusArgs;
use super::way::with;
use crate::error::Error;
use crate::output::standard;
use crate::refusal::Refusal;
use crate::terminal::harmless;
use bridge::http::{Served, serve};
use grading::{DeadLetter, Ends, Look, State, watch};
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Tells it.
///
/// # Errors
/// The server is not reached, or nobody can listen there.
pub fn status(args: &StatusArgs) -> Result<u8, Refusal> {
    with(&args.server, "grade-status", async |queue| {
        let look = Look::at(&queue).await?;
        if !args.page {
            standard(lines(&look).as_bytes())?;
            return Ok(0);
        }
        let mut ends = Ends::new()?;
        let shown = Arc::new(Mutex::new(page(&look, None, true)));
        let text = shown.clone();
        let address = SocketAddr::new(args.address, args.port);
        let served = Served {
            path: "/",
            media_type: "text/html; charset=utf-8",
            text: Arc::new(move || text.lock().unwrap_or_else(PoisonError::into_inner).clone()),
        };
        let address = serve(address, served).map_err(|why| Error::Refused(why.to_string()))?;
        standard(
            format!("the queue, in a browser: http://{address}/\nCtrl-C ends it\n").as_bytes(),
        )?;
        let (mut last, mut at) = (look, Instant::now());
        let tell = |now: Option<Look>| {
            let text = match now {
                Some(now) => {
                    let seconds = at.elapsed().as_secs_f64().max(f64::MIN_POSITIVE);
                    let count = now.state.judged.saturating_sub(last.state.judged);
                    (last, at) = (now, Instant::now());
                    page(&last, Some(count as f64 / seconds), true)
                }
                None => page(&last, None, false),
            };
            *shown.lock().unwrap_or_else(PoisonError::into_inner) = text;
        };
        watch(&queue, &mut ends, tell).await;
        Ok(0)
    })
}

/// What is where, with words for it.
fn rows(state: State) -> [(&'static str, u64); 4] {
    let State {
        waiting,
        taken,
        judged,
        dead,
    } = state;
    [
        ("waiting", waiting),
        ("being judged", taken),
        ("judged", judged),
        ("put aside", dead),
    ]
}

fn lines(look: &Look) -> String {
    let rows = rows(look.state).into_iter();
    let rows = rows.map(|(name, count)| format!("{name:<13} {count}\n"));
    let dead = look.dead.iter();
    let dead = dead.map(|one| format!("  {}: {}\n", harmless(&what(one)), harmless(&one.why)));
    rows.chain(dead).chain(more(look)).collect()
}

/// What was put aside, for a person.
fn what(one: &DeadLetter) -> String {
    match &one.what {
        Some((task, file)) => format!("{task}, {file}"),
        None => format!("no submission, {}", one.id),
    }
}

/// That not all of what was put aside is shown.
fn more(look: &Look) -> Option<String> {
    let count = look.state.dead.saturating_sub(look.dead.len() as u64);
    (count > 0).then(|| format!("  and {count} more\n"))
}

/// What was put aside, as a list.
fn list(look: &Look) -> String {
    if look.dead.is_empty() {
        return String::new();
    }
    let row = |one: &DeadLetter| {
        let (what, why) = (escaped(&harmless(&what(one))), escaped(&harmless(&one.why)));
        format!("<li><b>{what}</b>: {why}</li>")
    };
    let rows: String = look.dead.iter().map(row).collect();
    let more = more(look).unwrap_or_default();
    format!("<h2>Put aside</h2><ul>{rows}</ul><p>{more}</p>")
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

fn page(look: &Look, rate: Option<f64>, is_there: bool) -> String {
    let list = list(look);
    let rows: String = rows(look.state)
        .into_iter()
        .map(|(name, count)| format!("<tr><th scope=\"row\">{name}</th><td>{count}</td></tr>"))
        .collect();
    let rate = rate.map_or_else(String::new, |rate| {
        format!("<p>{rate:.1} judged a second</p>")
    });
    let gone = match is_there {
        true => "",
        false => "<p role=\"alert\">The server does not answer; this is the last that it said.</p>",
    };
    format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"2\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>TRIK queue</title>\
         <style>:root{{color-scheme:light dark;font-family:system-ui}}th{{text-align:left;padding-right:2rem}}\
         td{{text-align:right;font-variant-numeric:tabular-nums}}li{{overflow-wrap:anywhere;margin-bottom:0.3rem}}</style>\
         <main><h1>Queue</h1>{gone}<table>{rows}</table>{rate}{list}</main></html>"
    )
}
