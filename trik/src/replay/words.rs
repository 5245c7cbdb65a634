//! What a replay says to a person: where it is, and where programs leave the recording.
//!
//! Owns the lines; pure.

use super::order::{BadOrder, KEYS, Wanted};
use super::outputs::Difference;
use super::player::State;
use super::recording::Channel;
use lang_text::problem::Words;
use std::fmt::Write;
use std::time::Duration;

/// What a page is told that orders something of a world that was recorded.
pub(super) fn no_orders() -> Words {
    Words::new(
        "what was recorded takes no orders",
        "тем, что записано, нельзя распоряжаться",
    )
}

/// What a page is told whose order to a player is none.
pub(super) fn bad_order(why: &BadOrder) -> Words {
    let russian = match why {
        BadOrder::Word(word) => format!(
            "неизвестное слово '{word}': pause, go, step [NUMBER], speed NUMBER, seek TIME, loop on, loop off"
        ),
        BadOrder::Argument(wanted) => format!("ожидается {}", form(*wanted)),
    };
    Words::new(why.to_string(), russian)
}

/// The form of an order.
fn form(wanted: Wanted) -> &'static str {
    match wanted {
        Wanted::Step => "step NUMBER, от 1 до 1000000 событий",
        Wanted::Speed => "speed NUMBER, от 0.01 до 1000 раз быстрее времени",
        Wanted::Seek => "seek TIME: секунды, МИНУТЫ:СЕКУНДЫ или +СЕКУНДЫ и -СЕКУНДЫ от этого места",
        Wanted::Loop => "loop on или loop off",
        Wanted::Short => "одно слово и не больше одного числа после него",
        Wanted::WordAlone => "только это слово, без продолжения",
        Wanted::Printable => "одна строка из печатных символов",
    }
}

/// Cells of the bar.
const BAR: usize = 40;

/// The view: at most 79 characters in a line.
pub(super) fn view(name: &str, state: &State) -> Vec<String> {
    let share = match state.length.as_secs_f64() {
        0.0 => 1.0,
        length => state.position.as_secs_f64() / length,
    };
    let done: String = (0..BAR)
        .map(|cell| {
            let is_done = (cell as f64 + 0.5) / BAR as f64 <= share;
            if is_done { '=' } else { '.' }
        })
        .collect();
    let how = match (state.runs, state.is_at_end) {
        (true, _) => "runs",
        (false, true) => "at its end",
        (false, false) => "stands",
    };
    let mut lines = vec![
        format!(
            "{name}   {how}   speed {}{}",
            state.speed,
            if state.is_loop {
                "   again and again"
            } else {
                ""
            }
        ),
        format!("{} [{done}] {}", time(state.position), time(state.length)),
        format!(
            "events {}   without room {}   outputs as recorded {}   other {}",
            state.given,
            state.dropped,
            state.same,
            state.differences.len()
        ),
    ];
    lines.extend(state.differences.iter().take(4).cloned());
    lines.push(KEYS.to_owned());
    lines
        .iter()
        .map(|line| line.chars().take(79).collect())
        .collect()
}

/// Minutes, seconds and tenths.
pub(super) fn time(at: Duration) -> String {
    let tenths = at.as_millis() / 100;
    format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}

/// Where an actuator leaves the recording.
pub(super) fn difference(channel: &Channel, difference: &Difference) -> String {
    let shown = |tuple: &[u8]| channel.layout.show(tuple);
    let mut line = format!("{} at {}: ", channel.path, time(difference.at));
    let _ = match &difference.wrote {
        Some(tuple) => write!(line, "a program wrote {}, ", shown(tuple)),
        None => write!(line, "no program wrote, "),
    };
    let _ = match &difference.recorded {
        Some((at, tuple)) => write!(line, "recorded is {} at {}", shown(tuple), time(*at)),
        None => write!(line, "nothing more is recorded"),
    };
    line
}
