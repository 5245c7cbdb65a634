//! Pictures and outlines of small projects, with friendly and hostile texts.

use super::labels::{self, Area, HALF};
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
fn an_outline_has_questions_with_and_without_a_way_for_no_answer() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let first = sketch.block("Input", &[("variable", "n"), ("prompt", "How many?")]);
    let second = sketch.block("Input", &[("variable", "m"), ("default", "2")]);
    let said = sketch.block("Function", &[("Body", "print(n * m)")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, first, second, said, end]);
    sketch.guarded(second, end, "cancel");
    let text = outline(&sketch.project(), Locale::English).unwrap();
    let first = "Program:\n  Input: n, How many?\n";
    let way = "  If there is an answer to Input: m, 2:\n    Function: print(n * m)\n";
    assert!(text.starts_with(&format!("{first}{way}")), "{text}");
}

#[test]
fn a_picture_has_blocks_links_guards_and_words() {
    let svg = picture(&project("M3").diagrams[0], Locale::English);
    insta::assert_snapshot!("picture", svg);
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

/// Numbers of an attribute, wherever it stands.
fn numbers<'a>(svg: &'a str, before: &str) -> Vec<Vec<f64>> {
    let parts: Vec<&'a str> = svg.split(before).skip(1).collect();
    let texts = parts.iter().filter_map(|part| part.split('"').next());
    let split = |text: &str| {
        text.split([' ', ','])
            .filter_map(|number| number.parse().ok())
            .collect()
    };
    texts.map(split).collect()
}

#[test]
fn links_and_guards_are_inside_the_picture() {
    let mut project = project("M3");
    project.diagrams[0].links[0].path =
        vec![(0.0, 0.0), (-300.0, -400.0), (700.0, 900.0), (1.0, 1.0)];
    let svg = picture(&project.diagrams[0], Locale::English);
    let shown = &numbers(&svg, "viewBox=\"")[0];
    for points in numbers(&svg, "points=\"") {
        for corner in points.chunks(2) {
            let (x, y) = (corner[0] - shown[0], corner[1] - shown[1]);
            assert!(x >= 0.0 && x <= shown[2], "{corner:?} {shown:?}");
            assert!(y >= 0.0 && y <= shown[3], "{corner:?} {shown:?}");
        }
    }
}

#[test]
fn labels_of_blocks_do_not_cover_each_other() {
    let middles: Vec<(f64, f64)> = (0..12)
        .map(|at| (f64::from(at % 4) * 75.0, f64::from(at / 4) * 100.0))
        .collect();
    let mut taken: Vec<Area> = Vec::new();
    for (own, &middle) in middles.iter().enumerate() {
        let room = labels::room(own, &middles);
        let text = "Wait for Ultrasonic Distance and for much more, whatever it may be";
        let lines = labels::wrapped(text, room.width, room.lines);
        assert!(!lines.is_empty() && lines.len() <= room.lines);
        for area in [
            Area::around(middle, HALF, HALF),
            Area::under(middle, &lines),
        ] {
            let other = taken.iter().find(|other| area.meets(other));
            assert!(other.is_none(), "{own}: {area:?} {other:?}");
            taken.push(area);
        }
    }
}

#[test]
fn a_text_is_put_where_nothing_is() {
    let place = |x| Area::around((x, 0.0), 5.0, 5.0);
    let mut taken = vec![place(0.0)];
    let found = labels::free(&[place(1.0), place(20.0)], &mut taken);
    assert_eq!(found.map(|area| area.low), Some((15.0, -5.0)));
    let found = labels::free(&[place(1.0), place(20.0)], &mut taken);
    assert_eq!(found.map(|area| area.low), Some((-4.0, -5.0)));
}

#[test]
fn nothing_has_a_picture_too() {
    let project = Sketch::new().project();
    let svg = picture(&project.diagrams[0], Locale::English);
    assert!(lang_text::xml::parse(&svg).is_ok());
    assert!(outline(&project, Locale::English).is_err());
}
