//! A class: its tables in each form, hostile names, missing solutions; kinds of failure, platforms, and why a run ended so.

use super::{drive, endless, folder, trik, world};
use crate::diagrams::root;
use harness::documents::examples;
use harness::{Board, tools};
use lang_diagram::sketch::Sketch;
use std::fs;
use std::os::unix::fs::PermissionsExt;

/// A class of three with two tasks, as docs/teacher/class.md has it.
pub(super) fn school(board: &Board, near: &str) {
    for name in ["pupils/anna", "pupils/boris", "tasks/line"] {
        fs::create_dir_all(board.path("school").join(name)).expect("folders");
    }
    board.file("school/tasks/line/far.xml", world(300));
    board.file("school/tasks/line/near.xml", near);
    board.file(
        "school/tasks/rush.xml",
        near.replace("\"10000\"", "\"2000\""),
    );
    board.file("school/pupils/anna/line.qrs", drive("3000", None));
    board.file("school/pupils/anna/rush.qrs", endless(near));
    board.file("school/pupils/boris/line.qrs", b"PK\x03\x04 not a save");
    board.file("school/pupils/boris/rush.qrs", drive("3000", None));
    board.file("school/names.txt", "anna\nboris\n\nclara\n");
}

/// The checkers that docs/teacher/platforms.md shows.
pub(super) fn checkers(board: &Board) {
    let text = fs::read_to_string(root().join("docs/teacher/platforms.md")).expect("a document");
    for (info, name) in [("sh checker", "checker"), ("python stepik", "stepik.py")] {
        let all = examples(&text);
        let one = all.iter().find(|one| one.info == info).expect(info);
        board.file(name, &one.text);
        let mode = fs::Permissions::from_mode(0o755);
        fs::set_permissions(board.path(name), mode).expect("a mode");
    }
}

/// A name that spreadsheet programs, pages and shells would obey.
const HOSTILE: &str = "=HYPERLINK(\"http:x\")&<b>'";

/// Reads a spreadsheet as other programs do: sheets, rows and typed cells, without the library that wrote it.
const READER: &str = r##"
import sys, zipfile, xml.etree.ElementTree as tree
book = zipfile.ZipFile("g.ods")
first = book.infolist()[0]
assert first.filename == "mimetype" and first.compress_type == zipfile.ZIP_STORED, first
assert book.read("mimetype") == b"application/vnd.oasis.opendocument.spreadsheet"
tree.fromstring(book.read("META-INF/manifest.xml"))
space = {n: "urn:oasis:names:tc:opendocument:xmlns:%s:1.0" % n for n in ("table", "office", "text")}
name = lambda n: "{%s}%s" % (space[n.split(":")[0]], n.split(":")[1])
for sheet in tree.fromstring(book.read("content.xml")).iter(name("table:table")):
    print("#", sheet.get(name("table:name")))
    for row in sheet.iter(name("table:table-row")):
        cells = []
        for cell in row.iter(name("table:table-cell")):
            kind, value = cell.get(name("office:value-type")), cell.get(name("office:value"))
            formula = cell.get(name("table:formula")) or ""
            text = "".join(cell.itertext())
            cells.append({"float": "n:%s%s" % (value, formula), "string": "s:" + text, None: ""}[kind])
        print("|".join(cells))
"##;

#[test]
fn a_spreadsheet_has_numbers_texts_and_sums_and_names_are_never_more_than_texts() {
    let board = folder();
    let hostile = board.path("school/pupils").join(HOSTILE);
    fs::create_dir(&hostile).expect("a folder");
    fs::copy(
        board.path("school/pupils/boris/rush.qrs"),
        hostile.join("rush.qrs"),
    )
    .expect("a copy");
    let words = [
        "check",
        "school/pupils",
        "--tasks",
        "school/tasks",
        "--grades",
        "g.ods",
        "--grades",
        "g.html",
        "--grades",
        "g.csv",
        "--weights",
        "rush=0.5,line/near=3",
    ];
    let done = trik(&board, &words);
    assert_eq!(done.code(), 2, "{}{}", done.stdout, done.stderr);
    board.file("read.py", READER);
    let mut python = tools::shell("python3 read.py");
    let read = tools::run(python.current_dir(board.dir()), b"");
    assert_eq!(read.code(), 0, "{}", read.stderr);
    let points = read.stdout.split("# Runs").next().expect("a sheet");
    let expected = format!(
        "# Grades\n\
         s:pupil|s:line/far|s:line/near|s:rush|s:sum\n\
         s:weight|n:1|n:3|n:0.5|\n\
         s:{HOSTILE}|s:missing|s:missing|n:5|n:2.5of:=SUMPRODUCT([.B3:.D3];[.B$2:.D$2])\n\
         s:anna|n:0|n:5|n:0|n:15of:=SUMPRODUCT([.B4:.D4];[.B$2:.D$2])\n\
         s:boris|s:broken solution|s:broken solution|n:5|n:2.5of:=SUMPRODUCT([.B5:.D5];[.B$2:.D$2])\n"
    );
    assert_eq!(points, expected);
    let runs = read.stdout.split("# Runs").nth(1).expect("a sheet");
    assert!(
        runs.contains("s:anna|s:rush|s:school/pupils/anna/rush.qrs|s:school/tasks/rush.xml|s:out of time|n:2|n:0|s:"),
        "{runs}"
    );
    let csv = fs::read_to_string(board.path("g.csv")).expect("a table");
    assert!(
        csv.contains(
            "\"'=HYPERLINK(\"\"http:x\"\")&<b>'\",,missing,,missing,5,accomplished,2.5\r\n"
        ),
        "{csv}"
    );
    let page = fs::read_to_string(board.path("g.html")).expect("a page");
    assert!(
        page.contains("=HYPERLINK(&quot;http:x&quot;)&amp;&lt;b&gt;'") && !page.contains("<b>'"),
        "{page}"
    );
    // Each link leads to a page that is there; runs that could not be have none.
    let links: Vec<&str> = page
        .split("href=\"")
        .skip(1)
        .filter_map(|rest| rest.split('"').next())
        .collect();
    assert_eq!(links.len(), 10, "{links:?}");
    for link in links {
        let name = decoded(link);
        assert!(board.path(&name).is_file(), "{name}");
    }
}

fn decoded(link: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = link.bytes();
    while let Some(byte) = rest.next() {
        let digits: Vec<u8> = match byte {
            b'%' => rest.by_ref().take(2).collect(),
            _ => Vec::new(),
        };
        let text = String::from_utf8_lossy(&digits);
        bytes.push(u8::from_str_radix(&text, 16).unwrap_or(byte));
    }
    String::from_utf8(bytes).expect("a name")
}

/// Options that mean nothing, and what is said of them.
const MISTAKES: &[(&[&str], &str)] = &[
    (&["--grades", "c.csv"], "c.csv is there already"),
    (
        &["--grades", "c.xlsx"],
        "its name ends with .csv, .ods or .html",
    ),
    (
        &["--grades", "none/d.csv"],
        "none: there is no such directory",
    ),
    (&["--pass-mark", "3"], "--grades"),
    (
        &["--grades", "d.csv", "--weights", "task=x"],
        "not a number",
    ),
    (
        &["--grades", "d.csv", "--weights", "maze=2"],
        "there is no 'maze'; there are: task",
    ),
    (
        &["--grades", "d.csv", "--weights", "task=2,task=3"],
        "'task' has two weights",
    ),
    (
        &["--grades", "d.csv", "--tasks", "class"],
        "class/anna: there is no *.xml here",
    ),
    (
        &["--grades", "d.csv", "--tasks", "nowhere"],
        "nowhere: there is no such file",
    ),
    (
        &["--grades", "d.csv", "--pupils", "nobody.txt"],
        "there is no such file",
    ),
    (
        &["--grades", "d.csv", "--results", "d.csv"],
        "needed for something else",
    ),
    (
        &["--grades", "d.csv", "--for", "stepik"],
        "cannot be used with",
    ),
];

#[test]
fn a_class_without_tasks_is_understood_from_its_files_and_mistakes_are_refused() {
    let board = folder();
    // Somebody has handed in an empty folder.
    fs::create_dir(board.path("class/dora")).expect("a folder");
    let done = trik(&board, &["check", "class", "--grades", "c.csv"]);
    assert_eq!(done.code(), 2, "{}{}", done.stdout, done.stderr);
    let csv = fs::read_to_string(board.path("c.csv")).expect("a table");
    assert_eq!(
        csv,
        "\u{feff}pupil,task,task: result,sum\r\nanna,5,accomplished,5\r\nboris,0,not accomplished,0\r\n\
         damaged,,broken solution,0\r\ndora,,missing,0\r\n"
    );
    let both = ["check", "school/pupils/anna", "school/pupils/boris"];
    let words = [
        &both[..],
        &["--field", "fields/near.xml", "--grades", "two.csv"],
    ]
    .concat();
    assert_eq!(trik(&board, &words).code(), 2);
    let csv = fs::read_to_string(board.path("two.csv")).expect("a table");
    assert!(csv.starts_with(
        "\u{feff}pupil,line,line: result,rush,rush: result,sum\r\nanna,5,accomplished,"
    ));
    for (words, said) in MISTAKES {
        let refused = trik(&board, &[&["check", "class"][..], words].concat());
        assert_eq!(refused.code(), 2, "{words:?}: {}", refused.stderr);
        assert!(
            refused.stderr.contains(said),
            "{words:?}: {}",
            refused.stderr
        );
        assert_eq!(refused.stdout, "", "{words:?}");
    }
    assert!(!board.path("d.csv").exists());
}

/// A drive whose diagram has an error while it runs.
fn faulty(world: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wrong = sketch.block("Function", &[("Body", "x = 1 + nothing")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wrong, end]);
    sketch.world(world);
    sketch.qrs().expect("a save")
}

#[test]
fn kinds_of_failure_are_told_apart() {
    let board = folder();
    let near = world(100);
    board.file("faulty.qrs", faulty(&near));
    board.file("endless.qrs", endless(&near));
    board.file("bad.xml", near.replace("timelimit", "timelimt"));
    board.file("throws.js", "nothing.at.all();");
    for (words, verdict, code, yandex) in [
        (&["line.qrs"][..], "\"accomplished\",\"failure\":null", 0, 0),
        (&["short.qrs"], "\"failed\",\"failure\":\"wrong\"", 1, 1),
        (
            &["endless.qrs"],
            "\"failed\",\"failure\":\"model_time\"",
            1,
            1,
        ),
        (
            &["endless.qrs", "--time-limit", "1"],
            "\"failed\",\"failure\":\"model_time\"",
            1,
            1,
        ),
        (&["faulty.qrs"], "\"failed\",\"failure\":\"program\"", 1, 1),
        (
            &["throws.js", "--field", "fields/near.xml"],
            "\"failed\",\"failure\":\"program\"",
            1,
            1,
        ),
        (
            &["class/damaged.qrs"],
            "\"broken\",\"failure\":\"structure\"",
            2,
            2,
        ),
        (
            &["line.qrs", "--field", "bad.xml"],
            "\"broken\",\"failure\":\"not_run\"",
            2,
            3,
        ),
        (
            &["nowhere.qrs"],
            "trik: nowhere.qrs: there is no such file",
            2,
            3,
        ),
    ] {
        let words = [&["check"], words].concat();
        let done = trik(&board, &[&words[..], &["--results", "-"]].concat());
        let all = format!("{}{}", done.stdout, done.stderr);
        assert!(all.contains(verdict), "{words:?}: {all}");
        assert_eq!(done.code(), code, "{words:?}: {all}");
        let done = trik(&board, &[&words[..], &["--for", "yandex-contest"]].concat());
        assert_eq!(
            (done.code(), &*done.stdout),
            (yandex, ""),
            "{words:?}: {}",
            done.stderr
        );
    }
}

#[test]
fn why_a_run_ended_so_is_told_in_both_languages_and_changes_nothing() {
    let board = folder();
    let plain = trik(&board, &["check", "short.qrs", "--results", "-"]);
    let words = ["check", "short.qrs", "--explain"];
    let json = trik(&board, &[&words[..], &["--results", "-"]].concat());
    let (same, explain) = json
        .stdout
        .split_once(",\"explain\":")
        .expect("an explanation");
    assert_eq!(format!("{same}}}\n"), plain.stdout);
    for part in [
        "\"decided_by\":null",
        "\"text\":\"robot1 inside finish\"",
        "\"holds\":false",
        "\"unit\":\"px\"",
        "\"kind\":\"FinalNode\"",
        "\"thread\":\"main\"",
        "\"diagram\":\"",
    ] {
        assert!(explain.contains(part), "{part}: {explain}");
    }
    let told = trik(&board, &words);
    let lines: Vec<&str> = told.stdout.lines().collect();
    assert_eq!(
        lines[1..3],
        [
            "why: the program ended at 0.53 s, and no rule had said that the task is done",
            "  event 'there': never fired"
        ]
    );
    assert!(
        lines[3].starts_with("    robot1 inside finish: false; nearest "),
        "{lines:?}"
    );
    assert!(
        lines[4].starts_with("thread main: ended at 0.53 s after 'Final Node' (FinalNode {"),
        "{lines:?}"
    );
    let told = trik(&board, &[&words[..], &["--language", "ru"]].concat());
    assert!(
        !told.stdout.contains("why:")
            && !["event", "inside", " px", "thread"]
                .iter()
                .any(|word| told.stdout.contains(word)),
        "{}",
        told.stdout
    );
    // The rule that decides, in the table of several runs.
    let told = trik(&board, &["check", "line.qrs", "short.qrs", "--explain"]);
    assert!(
        told.stdout.contains(
            "\n    why: event 'there' decided at 1.02 s\n      event 'there': fired at 1.02 s\n"
        ),
        "{}",
        told.stdout
    );
}
