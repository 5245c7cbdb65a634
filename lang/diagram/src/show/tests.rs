//! Pictures and outlines of small projects, with friendly and hostile texts.

use super::outline::outline;
use super::picture::picture;
use crate::project::Project;
use crate::sketch::Sketch;
use lang_text::problem::Locale;

/// Forward, three times a second, stop; with a name of choice.
fn project(ports: &str) -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let go = sketch.block("TrikV6EnginesForward", &[("Ports", ports), ("Power", "70")]);
    let repeat = sketch.block("Loop", &[("Iterations", "3")]);
    let timer = sketch.block("Timer", &[("Delay", "1000")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.link(start, go);
    sketch.link(go, repeat);
    sketch.guarded(repeat, timer, "iteration");
    sketch.link(timer, repeat);
    sketch.link(repeat, end);
    sketch.project()
}

#[test]
fn an_outline_has_loops_and_names_in_both_languages() {
    let text = outline(&project("M3"), Locale::English).unwrap();
    let wanted =
        "Program:\n  Motors Forward: M3, 70\n  Repeat, times: 3:\n    Timer: 1000\n  End\n";
    assert_eq!(text, wanted);
    let text = outline(&project("M3"), Locale::Russian).unwrap();
    assert_eq!(text.lines().count(), 5);
    assert!(!text.contains("Timer"), "{text}");
}

#[test]
fn a_picture_is_xml_whatever_the_texts_say() {
    for text in [
        "M3",
        "</text><script>alert(1)</script>",
        "\"&<>'\u{0}\u{ffff}\u{202e}",
    ] {
        let project = project(text);
        let svg = picture(&project.diagrams[0], Locale::Russian);
        let root = lang_text::xml::parse(&svg).unwrap_or_else(|error| panic!("{error:?}\n{svg}"));
        assert_eq!(root.name, "svg");
        assert!(!svg.contains("<script"));
        assert_eq!(svg.matches("<rect x=\"-25\"").count(), 5);
        assert_eq!(svg.matches("<polyline").count(), 5);
        assert!(svg.contains(">iteration<"));
    }
}

#[test]
fn places_that_are_none_are_drawn_somewhere() {
    let mut project = project("M3");
    project.diagrams[0].blocks[1].position = (f64::NAN, f64::INFINITY);
    project.diagrams[0].links[0].path = vec![(f64::NAN, 1e300); 10_000];
    let svg = picture(&project.diagrams[0], Locale::English);
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    assert!(svg.len() < 20_000, "{}", svg.len());
}

#[test]
fn nothing_has_a_picture_too() {
    let project = Sketch::new().project();
    let svg = picture(&project.diagrams[0], Locale::English);
    assert!(lang_text::xml::parse(&svg).is_ok());
    assert!(outline(&project, Locale::English).is_err());
}
