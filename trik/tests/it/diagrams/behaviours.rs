//! The library of behaviours in `examples/dataflow`: each program does what its world asks, and only because of each of its
//! parts. With one part taken away the same world says that the task was not done.

use super::{root, trik};
use harness::Board;
use std::fs;
use std::path::PathBuf;

/// What is taken out of a program, and what stands there then.
struct Without {
    program: &'static str,
    part: &'static str,
    instead: &'static str,
}

const WITHOUT: [Without; 7] = [
    Without {
        program: "walls",
        part: "`data < 25`",
        instead: "`data < 0`",
    },
    Without {
        program: "walls",
        part: "2*(I0 - 20)",
        instead: "0*I0",
    },
    Without {
        program: "line",
        part: "kp = 0.6; ki = 0.02; kd = 1.5",
        instead: "kp = 0.0; ki = 0.0; kd = 0.0",
    },
    Without {
        program: "light",
        part: "{45, I0 - I1}",
        instead: "{45, 0*(I0 - I1)}",
    },
    Without {
        program: "light",
        part: "`max(0, 50 - I0)`",
        instead: "`0*I0`",
    },
    Without {
        program: "votes",
        part: "{l, min(l, r), r}",
        instead: "{0*l, min(l, r), 0*r}",
    },
    Without {
        program: "straight",
        part: "0.9*(heading + step) + 0.1*I1[6]/1000",
        instead: "heading + step + 0*I1[6]",
    },
];

fn library() -> PathBuf {
    root().join("examples/dataflow")
}

/// The names of the programs.
fn programs() -> Vec<String> {
    let files = fs::read_dir(library()).expect("the library");
    let mut names: Vec<String> = files
        .filter_map(|file| file.ok()?.file_name().into_string().ok())
        .filter_map(|name| Some(name.strip_suffix(".flow")?.to_owned()))
        .collect();
    names.sort();
    names
}

/// A program as it is, and whether its world says that it does its task: the exit status and what was told.
fn judged(board: &Board, program: &str, source: &str) -> (i32, String) {
    let file = format!("{program}.flow");
    board.file(&file, source);
    let world = library().join(format!("{program}.xml"));
    let world = world.to_str().expect("a name in UTF-8");
    let found = trik(board, &["lint", &file, world]);
    assert_eq!(
        (found.code(), &*found.stdout),
        (0, "2 files: 0 errors, 0 warnings, 0 notes\n"),
        "{program}"
    );
    let run = trik(board, &["check", &file, "--field", world]);
    (run.code(), run.stdout)
}

fn source(program: &str) -> String {
    fs::read_to_string(library().join(format!("{program}.flow"))).expect("a program")
}

#[test]
fn each_behaviour_does_what_its_world_asks() {
    let board = Board::new();
    let programs = programs();
    assert_eq!(programs, ["light", "line", "straight", "votes", "walls"]);
    for program in programs {
        let (code, told) = judged(&board, &program, &source(&program));
        assert_eq!(code, 0, "{program}: {told}");
        assert!(told.contains("The task was accomplished"), "{told}");
        assert!(
            WITHOUT.iter().any(|without| without.program == program),
            "{program} has no part that is taken away"
        );
    }
}

#[test]
fn the_diagram_among_the_examples_follows_the_same_line() {
    let board = Board::new();
    let file = root().join("examples/diagrams/line.qrs");
    let world = library().join("line.xml");
    let [file, world] = [&file, &world].map(|path| path.to_str().expect("a name in UTF-8"));
    let found = trik(&board, &["lint", file]);
    assert_eq!(found.stdout, "1 file: 0 errors, 0 warnings, 0 notes\n");
    let run = trik(&board, &["check", file, "--field", world]);
    assert_eq!(run.code(), 0, "{}", run.stdout);
    assert!(run.stdout.contains("The task was accomplished"));
}

#[test]
fn without_one_of_its_parts_a_behaviour_fails_in_its_world() {
    let board = Board::new();
    for without in &WITHOUT {
        let whole = source(without.program);
        assert_eq!(whole.matches(without.part).count(), 1, "{}", without.part);
        let less = whole.replace(without.part, without.instead);
        let (code, told) = judged(&board, without.program, &less);
        assert_eq!(code, 1, "{} without {}", without.program, without.part);
        assert!(!told.contains("accomplished in"), "{told}");
    }
}

#[test]
fn the_document_names_each_behaviour() {
    let page = fs::read_to_string(root().join("docs/user/dataflow.md")).expect("the document");
    for program in programs() {
        let named = format!("examples/dataflow/{program}.flow");
        assert!(page.contains(&named), "{named}");
    }
}
