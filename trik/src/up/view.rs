//! How a virtual robot is, as lines of text: where it stands, what drives it, what its sensors have before them.
//!
//! Owns the words and their places; pure. These are facts of the simulator: what programs read has noise and faults.

use crate::limits;
use sim::board::View;

/// The robot in a few lines of at most 79 characters.
pub(super) fn lines(view: &View, robot: &str, speed: f64) -> Vec<String> {
    let led = match view.led {
        (false, false) => "off",
        (true, false) => "green",
        (false, true) => "red",
        (true, true) => "orange",
    };
    let servos = view
        .servos_ns
        .map(|ns| (ns > 0).then(|| format!("{}", ns / 1000)));
    let mut lines = vec![
        format!(
            "{robot}   {:.1} s at speed {speed}   battery {:.2} V   led {led}",
            view.time_s, view.battery_v
        ),
        format!(
            "position        x {:5.2} m   y {:5.2} m   heading {:4.0} deg",
            view.x_m,
            view.y_m,
            heading(view.heading_deg)
        ),
        row(
            "motors, %",
            "M",
            &view.motors_percent.map(|value| value.map(whole)),
        ),
        row(
            "encoders, deg",
            "E",
            &view.encoders_deg.map(|value| Some(whole(value))),
        ),
        row(
            "ultrasonic, cm",
            "D",
            &view
                .ultrasonic_m
                .map(|value| value.map(|m| whole(m * 100.0))),
        ),
        row(
            "analog, raw",
            "A",
            &view
                .analog_raw
                .map(|value| value.map(|raw| raw.to_string())),
        ),
        row("servos, us", "S", &servos),
    ];
    if !view.said.is_empty() {
        lines.push(format!("said            {}", harmless(&view.said, 63)));
    }
    lines
}

/// What the loudspeaker gave, as a line for where nothing is drawn.
pub(super) fn sound(words: &str) -> String {
    format!("said: {}", harmless(words, limits::SOUND_CHARS_MAX))
}

/// Words come from outside: they may be long, and a terminal would obey some.
fn harmless(words: &str, most: usize) -> String {
    words
        .chars()
        .filter(|c| !c.is_control())
        .take(most)
        .collect()
}

fn whole(value: f64) -> String {
    // The sum takes the sign from a zero.
    format!("{}", value.round() + 0.0)
}

/// Within half a turn to each side.
fn heading(degrees: f64) -> f64 {
    let turned = (degrees + 180.0).rem_euclid(360.0) - 180.0;
    // Minus zero, and what would be rounded to it, is zero.
    if turned.abs() < 0.5 { 0.0 } else { turned }
}

/// `what   M1    0  M2    -`; a dash where there is nothing.
fn row(what: &str, letter: &str, values: &[Option<String>]) -> String {
    let mut text = format!("{what:<15}");
    for (index, value) in values.iter().enumerate() {
        let value = value.as_deref().unwrap_or("-");
        text.push_str(&format!(" {letter}{} {value:<6}", index + 1));
    }
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        View {
            time_s: 12.34,
            x_m: 1.5,
            y_m: -0.25,
            heading_deg: 350.0,
            motors_percent: [Some(0.0), None, Some(-100.0), Some(100.0)],
            encoders_deg: [0.0, -0.2, -123456.0, 123456.0],
            battery_v: 12.345,
            servos_ns: [0, 1_425_000, 0, 0, 0, 2_300_000],
            led: (true, true),
            ultrasonic_m: [Some(1.204), None, Some(4.0)],
            analog_raw: [Some(1023), None, Some(0), None, Some(85), Some(84)],
            i2c: Default::default(),
            said: "hello".to_owned(),
        }
    }

    #[test]
    fn the_robot_is_told_in_lines_that_fit_a_terminal() {
        let lines = lines(&view(), "two-wheels", 2.0);
        let expected = [
            "two-wheels   12.3 s at speed 2   battery 12.35 V   led orange",
            "position        x  1.50 m   y -0.25 m   heading  -10 deg",
            "motors, %       M1 0      M2 -      M3 -100   M4 100",
            "encoders, deg   E1 0      E2 0      E3 -123456 E4 123456",
            "ultrasonic, cm  D1 120    D2 -      D3 400",
            "analog, raw     A1 1023   A2 -      A3 0      A4 -      A5 85     A6 84",
            "servos, us      S1 -      S2 1425   S3 -      S4 -      S5 -      S6 2300",
            "said            hello",
        ];
        assert_eq!(lines, expected);
        assert!(lines.iter().all(|line| line.len() < 80));
    }

    #[test]
    fn words_cannot_command_the_terminal() {
        let mut view = view();
        view.said = format!("\x1b[2J{}", "x".repeat(1000));
        let lines = lines(&view, "two-wheels", 1.0);
        let said = lines.last().expect("a line");
        assert!(said.len() < 80 && !said.contains('\x1b'), "{said:?}");
        assert_eq!(sound("\x1b[2Jhello\n"), "said: [2Jhello");
        let long = sound(&"x".repeat(10_000));
        assert_eq!(long.len(), "said: ".len() + limits::SOUND_CHARS_MAX);
    }

    #[test]
    fn a_heading_stays_within_half_a_turn() {
        for (degrees, shown) in [(0.0, 0.0), (190.0, -170.0), (-725.0, -5.0), (-0.1, 0.0)] {
            assert_eq!(heading(degrees), shown, "{degrees}");
        }
    }
}
