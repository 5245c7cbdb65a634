//! What is said of mistakes, literally and in both languages.

use super::super::read;
use lang_text::problem::Locale;
use std::fmt::Write as _;

/// Texts with mistakes.
const MISTAKES: [&str; 49] = [
    "diagram a\n  A: Sensr",
    "diagram a\n  A: Text programming",
    "diagram a\n  A: Draw hexagon",
    "diagram a\n  A: Motors(M3Powr = 1)",
    "diagram a\n  A: Loop(border = 1)",
    "diagram a\n  A: Motors(M3Power = 1, M3Power = 2)",
    "diagram a\n  A: Motors(M3Power 1)\n  A.M9 -> A.M1",
    "diagram a\n  A: Motors(M3Power = 1\n  B: Motors\n  B.M9 -> A.CF_IN",
    "diagram a\n  A: Motors(M3Power = )",
    "diagram a\n  A: Motors att 1, 2",
    "diagram a\n  A: Motors at 1",
    "diagram a\n  A: Motors at 1, 1e999",
    "diagram a\n  A: Motors at 1, 2 at 1, 2",
    "diagram a\n  A: Motors\n  A: If",
    "diagram a\n  motor: Motors\n  moter.CF_OUT -> nowhere",
    "diagram a\n  A: Motors\n  A.CF_OUTT -> A.CF_IN",
    "diagram a\n  A: unknown \"X\"\n  A.OUT -> A.1",
    "diagram a\n  A: Motors\n  A -> A.CF_IN",
    "diagram a\n  A: Motors\n  A.CF_OUT -> A",
    "diagram a\n  A: Motors\n  A.CF_OUT -> ",
    "diagram a\n  A: Motors\n  A.1.5 -> A.CF_IN",
    "diagram a\n  A: Motors\n  A.CF_OUT -> A.CF_IN fifo 70000",
    "diagram a\n  A: Motors\n  A.CF_OUT -> A.CF_IN fifo latest",
    "diagram a\n  A: Motors\n  A.CF_OUT -> A.CF_IN letest",
    "diagram a\n  A: Motors\n  A.CF_OUT - A.CF_IN",
    "diagram a\n  A: \"User block\" of \"innner\"\nsubprogram inner",
    "diagram a\n  A: \"User block\" of b\nsubprogram b\nsubprogram b",
    "diagram a\n  A: If id \"../x\"",
    "diagram a\n  A: If id \"x\"\n  B: If id \"x\"",
    "A: If",
    "nowhere -> A.IN",
    "diagrom a",
    "diagram",
    "diagram a at 1, 2",
    "diagram a run\ndiagram b run",
    "run diagram",
    "kit a\nkit b",
    "meta a b",
    "meta a = b c",
    "diagram \"a",
    "diagram \"a\\q\"",
    "diagram a\n  A: If(condition = `data > 1)",
    "= 1",
    "diagram a\n  my motor: Motors",
    "diagram a\n  A: Led(color = red)",
    "diagram a\n  A: Motors(M3 = 50)",
    "diagram a\n  A: Wait",
    "A: If\nB: If\nA.TRUE -> B.DATA\nB.TRUE -> A.DATA -> B.CF_IN",
    "diagram a\n  // a comment",
];

#[test]
fn mistakes_are_told_where_they_are_with_what_was_meant() {
    let mut out = String::new();
    for text in MISTAKES {
        let _ = writeln!(out, "{text}");
        for problem in read(text).expect_err(text) {
            for locale in [Locale::English, Locale::Russian] {
                let _ = writeln!(out, "! {}", problem.in_locale(locale));
            }
        }
        out.push('\n');
    }
    insta::assert_snapshot!("mistakes", out);
}

#[test]
fn one_mistake_is_one_problem() {
    // A block with a mistake has its label, and what follows is read.
    let text = "diagram a\n A: Sensr\n B: Motors(\n M3Powr = 1,\n M4Power = 2)\n A.OUT -> B.M3\n B.X -> A.OUT\n";
    let problems = read(text).expect_err("mistakes");
    let lines: Vec<u32> = problems
        .iter()
        .filter_map(|one| Some(one.place.position?.line))
        .collect();
    assert_eq!(lines, [2, 4]);
}

#[test]
fn there_are_no_more_problems_than_anybody_reads() {
    let limit = lang_text::limits::PROBLEMS;
    for line in [
        "%\n",
        "x\n",
        "nowhere -> A.x\n",
        "A.x -> B.y\n",
        "A: If\n",
        "B: I\n",
        "x \"\n",
    ] {
        let text = format!("diagram a\nA: If\nA: If\n{}", line.repeat(10 * limit));
        assert_eq!(read(&text).expect_err(line).len(), limit, "{line}");
    }
}

#[test]
fn a_text_that_is_too_large_is_refused() {
    use crate::limits;
    let refused = |text: &str| {
        let problems = read(text).expect_err("too large");
        assert_eq!(problems.len(), 1);
        problems[0].to_string()
    };
    let text = " ".repeat(limits::SOURCE_BYTES_MAX + 1);
    assert_eq!(
        refused(&text),
        "1:1 the text is too long: at most 33554432 bytes"
    );
    let text = "diagram a\n".repeat(limits::SOURCE_DIAGRAMS_MAX + 1);
    assert_eq!(refused(&text), "10001:1 too many diagrams: at most 10000");
    let mut text = "diagram a\n".to_owned();
    for at in 0..=limits::SOURCE_BLOCKS_MAX {
        let _ = writeln!(text, "a{at}: If");
    }
    assert_eq!(refused(&text), "100002:1 too many blocks: at most 100000");
    let edges = "A.1 -> A.1\n".repeat(limits::SOURCE_EDGES_MAX + 1);
    let text = format!("diagram a\nA: If\n{edges}");
    assert_eq!(refused(&text), "400003:1 too many edges: at most 400000");
    let mut text = "diagram a\nA: If(\n".to_owned();
    for at in 0..=limits::SOURCE_PROPERTIES_MAX {
        let _ = writeln!(text, "\"{at}\"=1,");
    }
    let said = "1000003:1 too many properties and keys: at most 1000000";
    assert_eq!(refused(&text), said);
}

#[test]
fn names_that_nobody_knows_cost_little() {
    // Long, and many: each would be compared with all.
    let name = |at: usize| format!("{}{at}", "ab".repeat(90));
    let mut text = "diagram a\n".to_owned();
    for at in 0..20_000 {
        let _ = writeln!(text, "{}: If", name(at));
    }
    for at in 0..200 {
        let _ = writeln!(text, "ba{}.TRUE -> nowhere", name(at));
    }
    let problems = read(&text).expect_err("unknown labels");
    assert_eq!(problems.len(), 200);
    let hinted =
        |problem: &&lang_text::problem::Problem| problem.words.english.contains("did you mean");
    assert!(problems.iter().filter(hinted).count() < 2);
}
