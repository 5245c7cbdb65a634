//! Pictures of the filters that work on single values.

use crate::noise::Noise;
use crate::run::Filter;
use crate::svg::{Plot, Role};
use trikfs_filters::trig::sin_cos;

/// Samples in each picture and the time between two.
const SAMPLES: u32 = 240;
const PERIOD_S: f64 = 0.02;

/// A line through what a function of the time says.
fn curve(value: impl FnMut(f64) -> f64) -> Vec<(f64, f64)> {
    let mut value = value;
    let times = (0..SAMPLES).map(|n| f64::from(n) * PERIOD_S);
    times.map(|t| (t, value(t))).collect()
}

/// Whole numbers, as a sensor gives them.
fn counts(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.into_iter().map(|(t, y)| (t, y.round())).collect()
}

/// What a filter makes of a line.
fn filtered(name: &str, params: &[(&str, f64)], raw: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut filter = Filter::<1, 1>::open(name, params);
    let results = raw
        .iter()
        .filter_map(|(t, y)| Some((*t, filter.step::<i32>([*y as i32])?[0])));
    results.collect()
}

/// A slow wave with a step in the middle.
fn wave(t: f64) -> f64 {
    500.0 + 120.0 * sin_cos(t * 2.0).0 + if t > 2.4 { 200.0 } else { 0.0 }
}

/// A picture of noise, what a filter makes of it, and the truth.
fn calmed(title: &'static str, name: &str, params: &[(&str, f64)], raw: Vec<(f64, f64)>) -> Plot {
    let out = filtered(name, params, &raw);
    Plot::new(title, "counts")
        .line(Role::Raw, "sensor", raw)
        .line(Role::Truth, "truth", curve(wave))
        .line(Role::Filtered, "filtered", out)
}

fn noisy(seed: u64, deviation: f64) -> Vec<(f64, f64)> {
    let mut noise = Noise::new(seed);
    counts(curve(|t| wave(t) + noise.normal(deviation)))
}

fn spikes() -> Vec<(f64, f64)> {
    let mut noise = Noise::new(3);
    counts(curve(|t| {
        let is_spike = noise.uniform() < 0.06;
        wave(t)
            + noise.normal(3.0)
            + if is_spike {
                600.0 * (noise.uniform() - 0.5)
            } else {
                0.0
            }
    }))
}

fn calming() -> Vec<(&'static str, Plot)> {
    vec![
        (
            "median3",
            calmed("median3: outliers go, edges stay", "median3", &[], spikes()),
        ),
        (
            "moving_average",
            calmed(
                "moving_average, window 8",
                "moving_average",
                &[("window", 8.0)],
                noisy(4, 30.0),
            ),
        ),
        (
            "low_pass",
            calmed(
                "low_pass, alpha 1/4",
                "low_pass",
                &[("alpha", 0.25)],
                noisy(5, 30.0),
            ),
        ),
        (
            "kalman",
            calmed(
                "kalman, q 100, r 900",
                "kalman",
                &[("q", 100.0), ("r", 900.0)],
                noisy(6, 30.0),
            ),
        ),
    ]
}

fn shaping() -> Vec<(&'static str, Plot)> {
    let light = counts(curve(|t| 526.0 - 496.0 * sin_cos(t * 1.5).1));
    let params = [("x0", 30.0), ("x1", 1023.0), ("y1", 100.0)];
    let percent = filtered("scale", &params, &light);
    let scale = Plot::new("scale: 30 to 1023 counts are 0 to 100 percent", "counts, %")
        .line(Role::Raw, "counts", light)
        .line(Role::Filtered, "percent", percent);

    let raw = counts(curve(|t| 8697.0 / (35.0 - 25.0 * sin_cos(t * 1.5).1 + 2.0)));
    let centimetres = filtered("inverse", &[], &raw);
    let inverse = Plot::new("inverse: a Sharp sensor moved away and back", "counts, cm")
        .line(Role::Raw, "counts", raw)
        .line(Role::Filtered, "centimetres", centimetres);

    let mut noise = Noise::new(7);
    let stick = counts(curve(|t| {
        let moved = if t > 1.2 && t < 3.6 {
            sin_cos((t - 1.2) * 2.618).0
        } else {
            0.0
        };
        128.0 + 110.0 * moved + noise.normal(3.0)
    }));
    let rested = filtered("dead_band", &[("width", 12.0), ("center", 128.0)], &stick);
    let dead_band = Plot::new("dead_band, width 12, center 128", "counts")
        .line(Role::Raw, "stick", stick)
        .line(Role::Filtered, "filtered", rested);

    let angle = counts(curve(|t| 200.0 - 200.0 * sin_cos(t * 1.3).1));
    let speed = filtered("rate", &[("period_ms", 20.0)], &angle);
    let rate = Plot::new(
        "rate: an encoder's whole degrees become a speed",
        "deg, deg/s",
    )
    .line(Role::Filtered, "speed", speed)
    .line(Role::Raw, "angle", angle);
    vec![
        ("scale", scale),
        ("inverse", inverse),
        ("dead_band", dead_band),
        ("rate", rate),
    ]
}

fn switching() -> Vec<(&'static str, Plot)> {
    let mut noise = Noise::new(8);
    let key = |t: f64| f64::from(u8::from(t % 1.6 > 0.8));
    let bouncing = curve(|t| {
        let bounces = (t % 0.8) < 0.1 && noise.uniform() < 0.5;
        if bounces { 1.0 - key(t) } else { key(t) }
    });
    let calm = filtered("debounce", &[("samples", 4.0)], &bouncing);
    // Moved up, so that the lines do not cover each other.
    let calm = calm.into_iter().map(|(t, y)| (t, y + 1.2)).collect();
    let debounce = Plot::new("debounce, 4 samples; the upper line is moved up", "pressed")
        .line(Role::Raw, "contact", bouncing)
        .line(Role::Filtered, "debounced", calm);

    let mut noise = Noise::new(9);
    let light = counts(curve(|t| {
        50.0 - 35.0 * sin_cos(t * 1.8).1 + noise.normal(6.0)
    }));
    let params = [("low", 40.0), ("high", 60.0)];
    let on = filtered("hysteresis", &params, &light);
    let on = on.into_iter().map(|(t, y)| (t, y * 100.0)).collect();
    let hysteresis = Plot::new(
        "hysteresis, low 40, high 60; the result is drawn 100 times as high",
        "%",
    )
    .line(Role::Raw, "light", light)
    .line(Role::Other, "40", curve(|_| 40.0))
    .line(Role::Other, "60", curve(|_| 60.0))
    .line(Role::Filtered, "result", on);
    vec![("debounce", debounce), ("hysteresis", hysteresis)]
}

/// All of them.
pub fn plots() -> Vec<(&'static str, Plot)> {
    let mut plots = calming();
    plots.extend(shaping());
    plots.extend(switching());
    plots
}
