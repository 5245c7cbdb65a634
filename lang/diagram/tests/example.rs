//! The diagram of `examples/diagrams`: what it is made of.
//!
//! Owns its blocks and links. A save is an archive that no text editor shows, so the file in the repository is made here:
//! `TRIK_MAKE_EXAMPLES=1 cargo test -p lang-diagram --test example` writes it after a change.

use lang_diagram::archive;
use lang_diagram::sketch::Sketch;
use std::path::Path;

/// Follows a dark line with two light sensors, as `examples/dataflow/line.flow` does.
fn line() -> Vec<u8> {
    let mut sketch = Sketch::new();
    sketch.diagram_property("name", "Line");
    let start = sketch.block("InitialNode", &[]);
    let gains = sketch.block("Function", &[("Body", "kp = 0.6\nki = 0.02\nkd = 1.5")]);
    let memory = sketch.block("Function", &[("Body", "sum = 0.0\nold = 0.0")]);
    let sense = sketch.block("Function", &[("Body", "e = sensorA1 - sensorA2")]);
    let bounded = "sum = max(0 - 40, min(40, sum + e))";
    let regulate = "u = kp * e + ki * sum + kd * (e - old)\nold = e";
    let pid = sketch.block("Function", &[("Body", &format!("{bounded}\n{regulate}"))]);
    let motor = |port: &'static str, power: &'static str| [("Ports", port), ("Power", power)];
    let left = sketch.block("TrikV6EnginesForward", &motor("M3", "50 - u"));
    let right = sketch.block("TrikV6EnginesForward", &motor("M4", "50 + u"));
    let wait = sketch.block("Timer", &[("Delay", "10")]);
    sketch.chain(&[start, gains, memory, sense, pid, left, right, wait, sense]);
    // What is done once stands in a row, and what is done again and again in a ring.
    for (block, x, y) in [
        (start, 0, 0),
        (gains, 150, 0),
        (memory, 300, 0),
        (sense, 450, 0),
        (pid, 750, 0),
        (left, 750, 150),
        (right, 600, 150),
        (wait, 450, 150),
    ] {
        sketch.place(block, x, y);
    }
    sketch.qrs().expect("a save")
}

#[test]
fn the_example_is_what_is_made_here() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/diagrams/line.qrs");
    let made = line();
    if std::env::var_os("TRIK_MAKE_EXAMPLES").is_some() {
        std::fs::write(&file, &made).expect("the example is written");
    }
    let kept = std::fs::read(&file).expect("the example");
    // Archives of the same entries may differ by their compression.
    let open = |bytes: &[u8]| {
        archive::open(bytes, &mut Vec::new())
            .expect("a save")
            .entries
    };
    let (kept, made) = (open(&kept), open(&made));
    let other = kept.iter().zip(&made).find(|(kept, made)| kept != made);
    let other = other.map(|(kept, _)| &kept.name);
    assert_eq!((kept.len(), other), (made.len(), None));
}
