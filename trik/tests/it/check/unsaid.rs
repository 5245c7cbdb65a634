//! Nothing is left unsaid: what a class has beside solutions, where programs with text stood, scores that are none, and
//! files that two options name.

use super::{drive, folder, trik, world};
use harness::Board;
use nix::sys::stat::Mode;
use nix::unistd::mkfifo;
use std::fs;
use std::os::unix::fs::symlink;

/// A letter that Russian has and English has not.
fn is_russian(text: &str) -> bool {
    text.chars().any(|c| ('\u{410}'..='\u{44f}').contains(&c))
}

/// A class with all that is no solution.
fn strange(board: &Board) {
    let anna = board.path("school/pupils/anna");
    board.file("school/pupils/anna/LINE.QRS", "not read");
    board.file("school/pupils/anna/photo\n.png", "not read");
    symlink("nowhere", anna.join("gone.qrs")).expect("a link");
    symlink(board.path("class"), anna.join("all")).expect("a link");
    mkfifo(&anna.join("pipe.qrs"), Mode::S_IRWXU).expect("a FIFO");
    board.file("school/pupils/boris/other.qrs", drive("500", None));
    fs::create_dir_all(anna.join("1/2/3/4/5/6/7/8")).expect("folders");
    board.file("school/tasks/notes.txt", "not read");
}

#[test]
fn whatever_a_class_has_beside_solutions_is_named_with_its_reason_and_counted() {
    let board = folder();
    strange(&board);
    let words = ["check", "school/pupils", "--tasks", "school/tasks"];
    let told = trik(
        &board,
        &[&words[..], &["--grades", "g.csv", "--grades", "g.html"]].concat(),
    );
    let said: Vec<&str> = told.stderr.lines().collect();
    let starts = [
        "trik: school/tasks/notes.txt is left out: it is no task",
        "trik: school/pupils/anna/1/2/3/4/5/6/7 is left out: folders so deep",
        "trik: school/pupils/anna/LINE.QRS is left out: it is no solution",
        "trik: school/pupils/anna/all is left out: it is a link to a folder",
        "trik: school/pupils/anna/gone.qrs is left out: it is a link to nothing",
        "trik: school/pupils/anna/photo .png is left out: it is no solution",
        "trik: school/pupils/anna/pipe.qrs is left out: it is a FIFO",
        "trik: school/pupils/boris/other.qrs is left out: its name and its folders",
        "trik: left out: 8",
    ];
    assert_eq!(said.len(), starts.len(), "{}", told.stderr);
    for (line, start) in said.iter().zip(starts) {
        assert!(line.starts_with(start), "{start}: {line}");
    }
    let page = fs::read_to_string(board.path("g.html")).expect("a page");
    assert!(
        page.contains("<summary>left out: 8</summary>")
            && page.contains("<li>school/pupils/anna/gone.qrs is left out"),
        "{page}"
    );
    // Without a table the same is said, in Russian too, and no page is written.
    let told = trik(&board, &[&words[..], &["--language", "ru"]].concat());
    assert_eq!(told.stderr.lines().count(), starts.len(), "{}", told.stderr);
    for line in told.stderr.lines() {
        assert!(is_russian(line) && !line.contains(" is "), "{line}");
    }
    assert!(
        told.stdout.contains("school/tasks/line/near.xml"),
        "{}",
        told.stdout
    );
    assert!(!board.path("grades-replays").exists());
    // A directory of solutions is no class: other files in it are nobody's business, a FIFO is.
    let told = trik(&board, &["check", "school/pupils", "--field", "fields"]);
    assert!(
        told.stderr.contains("pipe.qrs is left out") && !told.stderr.contains("photo"),
        "{}",
        told.stderr
    );
}

#[test]
fn a_misspelt_task_and_a_misspelt_pupil_are_told_with_what_was_meant() {
    let board = folder();
    board.file("school/pupils/boris/rsuh.qrs", drive("500", None));
    board.file("school/short.txt", "Anna\nboris\n");
    let words = ["check", "school/pupils", "--tasks", "school/tasks"];
    let list = ["--pupils", "school/short.txt", "--grades", "g.csv"];
    let told = trik(&board, &[&words[..], &list].concat());
    let said: Vec<&str> = told.stderr.lines().collect();
    assert_eq!(
        said[..2],
        [
            "trik: 'anna' is not in the list of --pupils; the row is added; did you mean 'Anna'?",
            "trik: school/pupils/boris/rsuh.qrs is left out: its name and its folders name no task; did you mean 'rush'?",
        ],
        "{}",
        told.stderr
    );
    let table = fs::read_to_string(board.path("g.csv")).expect("a table");
    let rows: Vec<&str> = table.lines().skip(1).collect();
    assert!(
        rows[0].starts_with("Anna,,missing") && rows[2].starts_with("anna,0,"),
        "{table}"
    );
}

#[test]
fn a_program_with_text_runs_in_the_save_that_was_given_out() {
    let board = folder();
    for folder in ["handed/line", "given"] {
        fs::create_dir_all(board.path(folder)).expect("folders");
    }
    let program = "brick.motor(M3).setPower(100); brick.motor(M4).setPower(100); script.wait(3000)";
    board.file("handed/line/anna.js", program);
    board.file("handed/line/boris.qrs", drive("3000", Some(&world(100))));
    board.file("given/line.qrs", drive("0", Some(&world(100))));
    let words = ["check", "handed", "--tasks", "given", "--grades", "h.csv"];
    let done = trik(&board, &words);
    assert_eq!(done.code(), 0, "{}{}", done.stdout, done.stderr);
    let table = fs::read_to_string(board.path("h.csv")).expect("a table");
    assert!(
        table.ends_with("anna,5,accomplished,5\r\nboris,5,accomplished,5\r\n"),
        "{table}"
    );
    let words = ["check", "handed/line/anna.js", "--task", "given/line.qrs"];
    assert_eq!(trik(&board, &words).code(), 0);
    let alone = trik(&board, &["check", "handed/line/anna.js"]);
    assert_eq!(alone.code(), 2);
    assert!(
        alone
            .stdout
            .contains("--field WORLD.xml gives one, or --task TASK.qrs"),
        "{}",
        alone.stdout
    );
}

/// A program that waits at two lines, computes, and never ends.
const WAITS: [(&str, &str); 2] = [
    (
        "w.js",
        "function rest(ms) {\n    script.wait(ms);\n}\nrest(20);\nbrick.sensor(D1).read();\nfor (;;);\n",
    ),
    (
        "w.py",
        "from trik import brick, script\n\ndef rest(ms):\n    script.wait(ms)\n\nrest(20)\nwhile True:\n    script.wait(50)\n",
    ),
];

#[test]
fn the_line_at_which_a_program_with_text_stood_is_told_and_shown() {
    let board = folder();
    for ((name, text), line) in WAITS.into_iter().zip([2, 8]) {
        board.file(name, text.replace("brick.sensor(D1).read();\n", "\n"));
        let words = [
            "check",
            name,
            "--field",
            "fields/far.xml",
            "--time-limit",
            "1",
        ];
        let plain = trik(&board, &[&words[..], &["--results", "-"]].concat());
        let watched = ["--explain", "--html", "w.html", "--force", "--results", "-"];
        let watched = trik(&board, &[&words[..], &watched].concat());
        let (same, explain) = watched
            .stdout
            .split_once(",\"explain\":")
            .expect("an explanation");
        assert_eq!(format!("{same}}}\n"), plain.stdout, "{name}");
        let place = format!("thread main: waits or asked last at line {line} of {name}, since ");
        assert!(explain.contains(&place), "{name}: {explain}");
        assert!(
            explain.contains(&format!("\"file\":\"{name}\",\"line\":{line}")),
            "{explain}"
        );
        let page = fs::read_to_string(board.path("w.html")).expect("a page");
        assert!(
            page.contains(&format!(
                "[\"main\",30,\"line {}\"",
                [2, 4][usize::from(line == 8)]
            )),
            "{name}: {page}"
        );
        let told = trik(
            &board,
            &[&words[..], &["--explain", "--language", "ru"]].concat(),
        );
        assert!(
            !told.stdout.contains("thread") && !told.stdout.contains(" at "),
            "{}",
            told.stdout
        );
    }
}

#[test]
fn a_score_that_is_no_number_is_told_and_counts_as_none() {
    let board = folder();
    let scored = |value: &str| {
        world(100).replace(
            "<int value=\"5\"/>",
            &format!("<string value=\"{value}\"/>"),
        )
    };
    board.file("words.xml", scored("five"));
    board.file("digits.xml", scored("7"));
    let told = trik(&board, &["check", "line.qrs", "--field", "words.xml"]);
    assert!(
        told.stdout
            .contains("warning: total_score is 'five', which is no number"),
        "{}",
        told.stdout
    );
    let told = trik(&board, &["check", "line.qrs", "--field", "digits.xml"]);
    assert!(
        told.stdout.contains("score: 7") && !told.stdout.contains("warning"),
        "{}",
        told.stdout
    );
}

#[test]
fn one_file_under_two_names_is_refused_in_both_languages() {
    let board = folder();
    for words in [
        &["--svg", "o", "--html", "./o"][..],
        &["--report", "o.json", "--results", "./o.json"],
        &["--grades", "o.csv", "--grades", "./o.csv"],
        &["--grades", "o.csv", "--results", "class/../o.csv"],
    ] {
        let all = [&["check", "line.qrs"][..], words].concat();
        let told = trik(&board, &all);
        assert_eq!(told.code(), 2, "{words:?}: {}", told.stdout);
        assert!(
            told.stderr.contains("needed for something else"),
            "{words:?}: {}",
            told.stderr
        );
        let told = trik(&board, &[&all[..], &["--language", "ru"]].concat());
        assert!(is_russian(&told.stderr), "{words:?}: {}", told.stderr);
        assert!(!board.path("o").exists() && !board.path("o.csv").exists());
    }
    let same = ["check", "line.qrs", "--svg", "line.qrs", "--language", "ru"];
    assert!(is_russian(&trik(&board, &same).stderr));
}
