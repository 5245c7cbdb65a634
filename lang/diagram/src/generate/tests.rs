//! Names, and small programs in all languages: shapes, hostile texts, what is refused.

use super::names::{Names, Rules};
use super::{Language, Options, generate};
use crate::project::Project;
use crate::sketch::{Sketch, Spot};

#[test]
fn names_are_what_the_language_allows() {
    let rules = Rules {
        cyrillic: false,
        caseless: true,
        reserved: &["if"],
        taken: "remainder",
        underscores: false,
    };
    let mut names = Names::new(rules);
    assert_eq!(names.take("if"), "if_2");
    assert_eq!(names.take("IF"), "IF_3");
    assert_eq!(names.take("\u{414}\u{430} 1"), "Da_1");
    assert_eq!(names.take("7;\n--"), "_7____");
    assert_eq!(names.take(""), "v_");
    assert_eq!(names.take("_Bool"), "v_Bool");
    assert_eq!(names.take("remainder"), "remainder_2");
}

/// Blocks one after the other, from the beginning to the end.
fn chain(blocks: &[(&str, &[(&str, &str)])]) -> Project {
    let mut sketch = Sketch::new();
    let mut last = sketch.block("InitialNode", &[]);
    for (kind, properties) in blocks {
        let next = sketch.block(kind, properties);
        sketch.link(last, next);
        last = next;
    }
    let end = sketch.block("FinalNode", &[]);
    sketch.link(last, end);
    sketch.project()
}

fn written(project: &Project, language: Language) -> String {
    let generated = generate(project, language, Options::default());
    generated
        .unwrap_or_else(|problems| panic!("{}", problems[0]))
        .text
}

fn refused(project: &Project, language: Language) -> String {
    match generate(project, language, Options::default()) {
        Ok(generated) => panic!("{}", generated.text),
        Err(problems) => problems[0].to_string(),
    }
}

fn function(body: &str) -> Project {
    chain(&[("Function", &[("Body", body)])])
}

/// The lines of a program, by the block that they say.
fn lines_of(project: &Project, language: Language, id: &str) -> Vec<String> {
    let generated = generate(project, language, Options::default()).unwrap();
    assert_eq!(generated.text.lines().count(), generated.origins.len());
    let lines = generated.text.lines().zip(&generated.origins);
    let own = lines.filter(|(_, blocks)| blocks.iter().any(|one| one == id));
    own.map(|(line, _)| line.trim().to_owned()).collect()
}

#[test]
fn each_line_names_the_blocks_that_it_says() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let motors = sketch.block("TrikV6EnginesForward", &[("Ports", "M3"), ("Power", "71")]);
    let test = sketch.block("IfBlock", &[("Condition", "sensorA1 > 23")]);
    let wait = sketch.block("Timer", &[("Delay", "517")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.link(start, motors);
    sketch.link(motors, test);
    sketch.guarded(test, wait, "true");
    sketch.guarded(test, end, "false");
    sketch.link(wait, end);
    let project = sketch.project();
    let id = |kind: &str| {
        let blocks = &project.diagrams[0].blocks;
        let block = blocks.iter().find(|one| one.kind == kind).unwrap();
        block.id.clone()
    };
    for language in Language::ALL {
        for (kind, said) in [
            ("TrikV6EnginesForward", "71"),
            ("IfBlock", "23"),
            ("Timer", "517"),
        ] {
            let lines = lines_of(&project, language, &id(kind));
            assert!(lines[0].contains(said), "{language:?}: {lines:?}");
            for other in ["71", "23", "517"] {
                let is_own = other == said;
                let is_there = lines.iter().any(|line| line.contains(other));
                assert_eq!(is_there, is_own, "{language:?} {kind}: {lines:?}");
            }
        }
        assert_eq!(lines_of(&project, language, &id("InitialNode")), [""; 0]);
    }
}

#[test]
fn the_shapes_of_trik_are_kept() {
    let project = chain(&[
        (
            "TrikV6EnginesForward",
            &[("Ports", "M3, M4"), ("Power", "70")],
        ),
        (
            "TrikWaitForSonarDistance",
            &[("Port", "D1"), ("Distance", "20"), ("Sign", "less")],
        ),
        ("Timer", &[("Delay", "500")]),
    ]);
    let text = written(&project, Language::JavaScript);
    let wanted = "\
    brick.motor(M3).setPower(70);
    brick.motor(M4).setPower(70);
    while (!(brick.sensor(D1).read() < 20)) {
        script.wait(20);
    }
    script.wait(500);
    brick.stop();
    return;
";
    assert!(text.contains(wanted), "{text}");
    let text = written(&project, Language::Python);
    assert!(
        text.contains("    brick.motor('M3').setPower(70)\n"),
        "{text}"
    );
    assert!(text.contains("  def execMain(self):\n"), "{text}");
    let text = written(&project, Language::Lua);
    assert!(text.contains("  setPower(\"M3\", 70)\n"), "{text}");
    assert!(text.contains("\"motors/\" .. port .. \"/value\""), "{text}");
}

/// A function, a loop with a counter, a branch, a wait and a stop.
fn with_all_shapes() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let count = sketch.block("Function", &[("Body", "laps = 0; far = 20.5")]);
    let repeat = sketch.block("Loop", &[("Iterations", "3")]);
    let go = sketch.block(
        "TrikV6EnginesForward",
        &[("Ports", "M3, M4"), ("Power", "70 - laps * 2")],
    );
    let near = [("Port", "D1"), ("Distance", "far"), ("Sign", "less")];
    let near = sketch.block("TrikWaitForSonarDistance", &near);
    let lap = sketch.block("Function", &[("Body", "laps = laps + 1")]);
    let when = sketch.block("IfBlock", &[("Condition", "laps > 1 && sensorA1 < 50")]);
    let say = sketch.block("TrikSay", &[("Text", "two \"laps\"")]);
    let rest = sketch.block("Timer", &[("Delay", "500")]);
    let stop = sketch.block("TrikV6EnginesStop", &[("Ports", "M3, M4")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, count, repeat, stop, end]);
    sketch.guarded(repeat, go, "iteration");
    sketch.chain(&[go, near, lap, when]);
    sketch.guarded(when, say, "true");
    sketch.guarded(when, rest, "false");
    sketch.link(say, rest);
    sketch.link(rest, repeat);
    sketch.project()
}

#[test]
fn a_program_is_the_same_text_in_every_language() {
    let project = with_all_shapes();
    for language in Language::ALL {
        insta::assert_snapshot!(format!("{language:?}"), written(&project, language));
    }
}

#[test]
fn plain_operators_stand_where_they_do_the_same_and_helpers_elsewhere() {
    let text = written(
        &function("a = 7 // 2; b = 1 / 2; c = a / b; d = a and b"),
        Language::Python,
    );
    assert!(text.contains("self.a = divide_whole(7, 2)"), "{text}");
    assert!(text.contains("self.b = 1 / 2"), "{text}");
    assert!(
        text.contains("self.d = self.a != 0 and to_whole(self.b) != 0"),
        "{text}"
    );
    let text = written(
        &function("a = 1; b = -a; c = -0.1; d = -c; e = 'x' .. a"),
        Language::JavaScript,
    );
    assert!(text.contains("b = -a;"), "{text}");
    // The original's minus keeps the digits of a small float.
    assert!(text.contains("c = -0.10000000149011612;"), "{text}");
    assert!(text.contains("d = -Math.fround(c);"), "{text}");
    assert!(text.contains("e = \"x\" + String(a);"), "{text}");
}

#[test]
fn hostile_texts_stay_texts() {
    let nasty = "*/ \" ' \\ \n\r\u{2028} $1 ]] --[[ {} #{x} ${y} %s ??/ \u{202e}";
    let project = chain(&[("TrikSay", &[("Text", nasty)])]);
    for language in Language::ALL {
        let text = written(&project, language);
        let said: Vec<&str> = text
            .lines()
            .filter(|line| line.contains("]] --[["))
            .collect();
        assert_eq!(said.len(), 1, "{language:?}: {text}");
        assert!(
            !text.contains('\u{2028}') && !text.contains('\u{202e}'),
            "{text}"
        );
        assert!(!text.contains('\r'), "{text}");
    }
}

#[test]
fn names_of_the_language_are_renamed() {
    let project = function(
        "while_ = 1; brick = 2; self = 3; \u{448}\u{430}\u{433} = 4; text = brick + self + while_",
    );
    assert!(written(&project, Language::JavaScript).contains("brick_2 = 2;"));
    assert!(written(&project, Language::Python).contains("self.self_2 = 3\n"));
    assert!(written(&project, Language::Lua).contains("shag = 4\n"));
    assert!(written(&project, Language::C).contains("static Whole shag;\n"));
}

#[test]
fn what_is_printed_again_is_the_same() {
    let project = function("x = 1");
    for language in Language::ALL {
        let text = written(&project, language);
        assert_eq!(text, written(&project, language));
        assert!(
            text.ends_with('\n') && !text.contains(" \n") && !text.contains("\n\n\n"),
            "{text}"
        );
    }
}

/// A loop with a counter whose body may be left by a condition.
fn counted(is_left: bool) -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let repeat = sketch.block("Loop", &[("Iterations", "3")]);
    let led = sketch.block("TrikLed", &[]);
    let end = sketch.block("FinalNode", &[]);
    let guard =
        |sketch: &mut Sketch, from: Spot, to: Spot, guard: &str| sketch.guarded(from, to, guard);
    sketch.link(start, repeat);
    guard(&mut sketch, repeat, led, "iteration");
    if is_left {
        let when = sketch.block("IfBlock", &[("Condition", "sensorA1 > 5")]);
        let say = sketch.block("TrikSay", &[]);
        sketch.link(led, when);
        guard(&mut sketch, when, repeat, "false");
        guard(&mut sketch, when, say, "true");
        sketch.link(say, end);
    } else {
        sketch.link(led, repeat);
    }
    sketch.link(repeat, end);
    sketch.project()
}

#[test]
fn counters_are_seen_only_where_a_loop_is_left_half_way() {
    let text = written(&counted(false), Language::JavaScript);
    assert!(
        text.contains("for (var __round1 = 0; __round1 < 3; __round1++) {"),
        "{text}"
    );
    assert!(written(&counted(false), Language::Python).contains("for __round1 in range(3):"));
    let text = written(&counted(true), Language::JavaScript);
    assert!(text.contains("while (again(0, 3)) {"), "{text}");
}

#[test]
fn what_cannot_be_written_is_refused_with_a_reason() {
    let told = refused(&function("x = y"), Language::Python);
    assert!(told.contains("Undeclared identifier: y"), "{told}");
    let told = refused(&function("x = "), Language::Python);
    assert!(told.contains("Function"), "{told}");
    let told = refused(&function("f(1)"), Language::Python);
    assert!(told.contains("Unknown function"), "{told}");
    let told = refused(&function("sensorA1 = 2"), Language::Python);
    assert!(told.contains("read-only"), "{told}");
    let told = refused(&function("x = 1; x = 'a'"), Language::C);
    assert!(told.contains("several kinds"), "{told}");
    let told = refused(&Sketch::new().project(), Language::Lua);
    assert!(told.contains("entry point"), "{told}");
}

#[test]
fn languages_are_known_by_their_names() {
    for language in Language::ALL {
        assert_eq!(Language::named(language.name()), Some(language));
        assert_eq!(Language::named(language.ending()), Some(language));
    }
    assert_eq!(Language::named("FSharp"), Some(Language::FSharp));
    assert_eq!(Language::named("cobol"), None);
}

#[test]
fn a_name_in_a_text_or_a_comment_brings_no_helper() {
    let project = chain(&[
        (
            "Function",
            &[("Body", "print('the gyroscope \" is sensor')")],
        ),
        ("TrikCalibrateGyroscope", &[]),
    ]);
    for language in [Language::C, Language::Lua] {
        let text = written(&project, language);
        assert!(!text.contains("gyroscope("), "{text}");
        assert!(!text.contains("sensor("), "{text}");
    }
}

#[test]
fn a_timer_that_another_one_leads_to_counts_the_step_in_which_it_begins() {
    let timer = |delay: &'static str| [("Delay", delay)];
    let (long, other, short) = (timer("500"), timer("300"), timer("10"));
    let sensor = [("Port", "D1"), ("Distance", "20"), ("Sign", "less")];
    let project = chain(&[
        ("Timer", &long),
        ("TrikLed", &[]),
        ("Timer", &other),
        ("TrikWaitForSonarDistance", &sensor),
        ("Timer", &long),
        ("Timer", &short),
    ]);
    let text = written(&project, Language::JavaScript);
    let waits: Vec<&str> = text
        .lines()
        .map(str::trim)
        .filter(|line| line.contains("script.wait(") || line.contains("Timer 10"))
        .collect();
    let wanted = [
        "script.wait(500);",
        "script.wait(300 - 10);",
        "script.wait(20);",
        "script.wait(500);",
        "// Timer 10: over in the step in which it begins",
    ];
    assert_eq!(waits, wanted);
}
