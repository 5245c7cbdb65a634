//! How fast a document of DCML is understood, beside reading as much XML with quick-xml, and beside counting its lines.
//!
//! Two documents of 10,000 lines: many models of usual size, and one model with everything in it. `cargo bench -p lang-dcml
//! --bench front`; the least of several runs counts. Time is that of the processor, where the system tells it, because
//! other work on the machine takes turns.

use lang_dcml::{format::format, understand};
use quick_xml::Reader;
use quick_xml::events::Event;
use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// What parse and check of such a document may take.
const GOAL: Duration = Duration::from_millis(50);
const LINES: usize = 10_000;
const RUNS: usize = 3;
/// How long a run is at least.
const BATCH: Duration = Duration::from_millis(300);

fn main() {
    for (name, text) in [("500 models", many()), ("one model", one())] {
        let lines = text.lines().count();
        assert!((LINES..LINES + 30).contains(&lines));
        let understood = understand(&text);
        assert!(
            understood.diagnostics.is_empty(),
            "{:?}",
            understood.diagnostics[0]
        );
        let taken = least(|| drop(black_box(understand(black_box(&text)))));
        let laid = least(|| drop(black_box(format(black_box(&text)))));
        let counted = least(|| {
            black_box(
                black_box(&text)
                    .bytes()
                    .filter(|byte| *byte == b'\n')
                    .count(),
            );
        });
        let xml = as_xml(&text);
        let read = least(|| {
            black_box(events(black_box(&xml)));
        });
        println!("{name}: {lines} lines, {} kB", text.len() / 1000);
        println!(
            "  parse + check: {:.2} ms, {:.3} of the goal of {} ms",
            taken.as_secs_f64() * 1e3,
            taken.as_secs_f64() / GOAL.as_secs_f64(),
            GOAL.as_millis()
        );
        println!(
            "  layout: {:.2} ms; quick-xml over the same as {} kB of XML: {:.2} ms, parse + check is {:.1} of it; counting lines: {:.3} ms",
            laid.as_secs_f64() * 1e3,
            xml.len() / 1000,
            read.as_secs_f64() * 1e3,
            taken.as_secs_f64() / read.as_secs_f64(),
            counted.as_secs_f64() * 1e3
        );
    }
}

fn least(mut work: impl FnMut()) -> Duration {
    let begin = Instant::now();
    let clock = || processor_time().unwrap_or_else(|| begin.elapsed());
    // The clock of the processor has ticks of milliseconds.
    let runs = (0..RUNS).map(|_| {
        let start = clock();
        let mut count = 0;
        loop {
            work();
            count += 1;
            let taken = clock().saturating_sub(start);
            if taken > BATCH {
                return taken / count;
            }
        }
    });
    runs.min().unwrap_or_default()
}

/// How long this thread has run: the first number of Linux's `schedstat`, in ns.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let first = text.split(' ').next()?.parse().ok()?;
    Some(Duration::from_nanos(first))
}

/// Models of twenty lines, in the manner of the published ones.
fn many() -> String {
    let mut text = String::new();
    for at in 0..LINES / 20 {
        let _ = write!(
            text,
            "/** Robot {at}. */\nBEGIN Robot{at}\nPACKAGE: robotics.models;\nACTION: left_f_s, right_f_s;\n\
             PARAM : tt_wheel_half_axis, tt_wheel_radius, tt_steer_offset;\n\
             CONFIG: x_front, y_front, phi_front, x_rear, y_rear, phi_rear, x, y, theta;\nVAR: k, half;\n\
             k = tt_steer_offset / tt_wheel_half_axis;\nhalf = tt_wheel_radius / 2;\n"
        );
        for end in ["front", "rear"] {
            let _ = write!(
                text,
                "d(x_{end}) = half * (((cos(phi_{end}) - k * sin(phi_{end})) * right_f_s) + ((cos(phi_{end}) + k * sin(phi_{end})) * left_f_s));\n\
                 d(y_{end}) = half * (((sin(phi_{end}) + k * cos(phi_{end})) * right_f_s) + ((sin(phi_{end}) - k * cos(phi_{end})) * left_f_s));\n\
                 d(phi_{end}) = (tt_wheel_radius / (2 * tt_wheel_half_axis)) * (right_f_s - left_f_s);\n"
            );
        }
        text.push_str("x = (x_front + x_rear)/2;\ny = (y_front + y_rear)/2;\n");
        text.push_str("theta = atan2((y_front-y_rear),(x_front-x_rear)) + (pi / 4);\nEND;\n\n");
    }
    text
}

/// One model whose variables need each other in a row, each on its line of the section and of the equations.
fn one() -> String {
    let count = LINES / 2 - 3;
    let mut text = "BEGIN Long\nACTION: u;\nCONFIG: x;\nVAR: v0".to_owned();
    for at in 1..count {
        let _ = write!(text, ",\nv{at}");
    }
    text.push_str(";\n");
    for at in (1..count).rev() {
        let _ = writeln!(text, "v{at} = v{} * 0.5 + sin(x) * (u - {at}.25);", at - 1);
    }
    let _ = write!(text, "v0 = u;\nd(x) = v{};\nEND;\n", count - 1);
    while text.lines().count() < LINES {
        text.push('\n');
    }
    text
}

/// Each line as an attribute of a tag.
fn as_xml(text: &str) -> String {
    let mut xml = String::with_capacity(text.len() * 2);
    xml.push_str("<models>");
    for line in text.lines() {
        let line = line.replace(['<', '>', '&', '"'], " ");
        let _ = write!(xml, "<line text=\"{line}\"/>");
    }
    xml.push_str("</models>");
    xml
}

fn events(xml: &str) -> usize {
    let mut reader = Reader::from_str(xml);
    let mut count = 0;
    loop {
        match reader.read_event() {
            Ok(Event::Eof) | Err(_) => return count,
            Ok(Event::Empty(tag)) => {
                count += tag
                    .attributes()
                    .flatten()
                    .map(|one| one.value.len())
                    .sum::<usize>()
            }
            Ok(_) => count += 1,
        }
    }
}
