//! Solutions that are judged: verdicts, exit codes, files, many at once, and what hostile ones can do.
//!
//! Saves and worlds are made here.

mod class;
mod jobs;
mod limits;
mod recorded;
mod sandbox;
mod unsaid;

use crate::diagrams::root;
use crate::documents::transcripts;
use crate::rig::TRIK;
use harness::{Board, Output, tools};
use lang_diagram::read;
use lang_diagram::sketch::Sketch;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

/// A floor with a finish at a distance, and rules: reach it within 10 s.
fn world(finish: u32) -> String {
    format!(
        r##"<root version="20251219">
<world>
<walls><wall id="wall" begin="400:-100" end="400:200" stroke="#ff000000" stroke-width="10"/></walls>
<skittles/><balls/><cubes/><colorFields/><images/>
<regions><region id="finish" type="rectangle" x="{finish}" y="-10" width="120" height="120" filled="true" visible="true" color="#00aa00" text="finish" textX="0" textY="0"/></regions>
<robot position="0:0" direction="0"/>
</world>
<robots><robot id="trikKitRobot"><sensors/><wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings realisticPhysics="false" realisticSensors="false" realisticMotors="false"/>
<constraints>
<timelimit value="10000"/>
<event id="there" settedUpInitially="true"><condition><inside objectId="robot1" regionId="finish"/></condition>
<triggers><setter name="total_score"><int value="5"/></setter><message text="At the finish"/><success/></triggers></event>
</constraints>
</root>
"##
    )
}

/// A drive straight ahead, in a world; without rules if the world has none.
fn drive(ms: &str, world: Option<&str>) -> Vec<u8> {
    let mut sketch = Sketch::new();
    sketch.meta("twoDModelWorldReadOnly", "true");
    let start = sketch.block("InitialNode", &[]);
    let forward = sketch.block(
        "TrikV6EnginesForward",
        &[("Ports", "M3, M4"), ("Power", "100")],
    );
    let wait = sketch.block("Timer", &[("Delay", ms)]);
    let stop = sketch.block("TrikV6EnginesStop", &[("Ports", "M3, M4")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, forward, wait, stop, end]);
    if let Some(world) = world {
        sketch.world(world);
    }
    sketch.qrs().expect("a save")
}

/// A program that never waits.
fn endless(world: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let count = sketch.block("Function", &[("Body", "x = 1")]);
    let again = sketch.block("Function", &[("Body", "y = x")]);
    sketch.chain(&[start, count, again, count]);
    sketch.world(world);
    sketch.qrs().expect("a save")
}

/// Waits for a finger on the left pad, and prints where it is.
fn pad() -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let wait = sketch.block("TrikWaitPadPress", &[("Pad", "1")]);
    let print = sketch.block("Function", &[("Body", "print(gamepadPad1[1])")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, wait, print, end]);
    sketch.world("<root version=\"20251219\"><world/><settings/></root>");
    sketch.qrs().expect("a save")
}

/// A folder with solutions of each kind and another field.
fn folder() -> Board {
    let board = Board::new();
    for name in ["class/anna", "fields"] {
        fs::create_dir_all(board.path(name)).expect("folders");
    }
    let near = world(100);
    board.file("class/anna/line.qrs", drive("3000", Some(&near)));
    board.file("class/boris.qrs", drive("500", Some(&near)));
    board.file("class/damaged.qrs", b"PK\x03\x04 not a save");
    board.file("line.qrs", drive("3000", Some(&near)));
    board.file("short.qrs", drive("500", Some(&near)));
    let moved = near.replace("400:", "60:");
    board.file("moved.qrs", drive("3000", Some(&moved)));
    board.file("pad.qrs", pad());
    let checking = fs::read_to_string(root().join("docs/teacher/checking.md")).expect("a document");
    let hands = checking
        .split("```text\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    board.file(
        "hands.txt",
        hands.expect("an example of what a person does"),
    );
    board.file("fields/far.xml", world(300));
    board.file("fields/near.xml", &near);
    class::school(&board, &near);
    class::checkers(&board);
    board
}

fn trik(board: &Board, words: &[&str]) -> Output {
    tools::run(Command::new(TRIK).args(words).current_dir(board.dir()), b"")
}

#[test]
fn what_documents_say_of_checking_is_what_really_happens() {
    let (mut count, mut complaints) = (0, Vec::new());
    for document in [
        "README.md",
        "docs/teacher/checking.md",
        "docs/ru/checking.md",
        "docs/teacher/class.md",
        "docs/teacher/grading.md",
        "docs/teacher/platforms.md",
    ] {
        let text = fs::read_to_string(root().join(document)).expect(document);
        let (steps, wrong) = transcripts(&folder(), document, &text, "sh check");
        count += steps;
        complaints.extend(wrong);
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(count > 8, "only {count} examples");
}

/// What is said, the exit code, and a part of the answer.
const CASES: &[(&[&str], i32, &str)] = &[
    (&["check", "line.qrs"], 0, "line.qrs: accomplished, "),
    (
        &["check", "short.qrs"],
        1,
        "short.qrs: not accomplished, 0.53",
    ),
    (
        &["check", "free.qrs"],
        0,
        "free.qrs: ended (no rules), 0.53",
    ),
    (
        &["check", "nowhere.qrs"],
        0,
        "nowhere.qrs: ended (no rules), ",
    ),
    (&["check", "class/damaged.qrs"], 2, "broken solution"),
    (
        &["check", "nothing.qrs"],
        2,
        "nothing.qrs: there is no such file",
    ),
    (&["check", "line.qrs", "--field", "bad.xml"], 2, "bad.xml: "),
    (
        &["check", "line.qrs", "--field", "no.xml"],
        2,
        "no.xml: there is no such file",
    ),
    (
        &["check", "line.qrs", "--field", "fields/far.xml"],
        1,
        "not accomplished",
    ),
    (
        &["check", "line.qrs", "--field", "fields/near.xml"],
        0,
        "accomplished",
    ),
    (
        &["check", "line.qrs", "--field", "fields", "--own"],
        1,
        "3 runs: 2 accomplished, 1 not",
    ),
    (
        &["check", "class"],
        2,
        "3 runs: 1 accomplished, 1 not accomplished, 1 broken solution, 0 could not be run",
    ),
    (
        &["check", "endless.qrs"],
        1,
        "endless.qrs: out of time, 10.0",
    ),
    (
        &["check", "endless.qrs", "--time-limit", "2"],
        1,
        "--time-limit allows more",
    ),
    (
        &["check", "fields"],
        2,
        "fields: there is no *.qrs or *.flow here",
    ),
    (&["check"], 2, ""),
    (&["check", "line.qrs", "--language", "ru"], 0, "line.qrs: "),
];

#[test]
fn what_cannot_be_written_is_no_verdict() {
    let board = folder();
    for words in [
        "check line.qrs > /dev/full",
        "check line.qrs line.qrs > /dev/full",
        "check line.qrs --results /dev/full --force",
        "check line.qrs --results none/such.jsonl",
    ] {
        let mut shell = Command::new("sh");
        let line = format!("\"$0\" {words}");
        let shell = shell.args(["-c", &line, TRIK]).current_dir(board.path(""));
        let output = shell.output().expect("sh runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{words}: {said}");
        assert!(said.contains("trik: "), "{words}: {said}");
    }
}

/// Writes lines as if it were the process that runs it: of itself, of the next one, something binary and a half line.
#[test]
fn exit_codes_are_true() {
    let board = folder();
    board.file(
        "free.qrs",
        drive(
            "500",
            Some("<root version=\"1\"><world/><robots/><settings/></root>"),
        ),
    );
    board.file("nowhere.qrs", drive("500", None));
    board.file("endless.qrs", endless(&world(300)));
    board.file(
        "bad.xml",
        world(100).replace("<timelimit value=\"10000\"/>", ""),
    );
    for (words, code, said) in CASES {
        let output = trik(&board, words);
        let all = format!("{}{}", output.stdout, output.stderr);
        assert_eq!(output.code(), *code, "{words:?}: {all}");
        assert!(all.contains(said), "{words:?}: {all}");
    }
}

#[test]
fn what_a_program_prints_is_shown_and_what_it_leaves_behind_is_ended() {
    let board = folder();
    // A program that root alone can read may start no others before Linux 6.14.
    let everybody = fs::Permissions::from_mode(0o755);
    fs::set_permissions(board.dir(), everybody).expect("its mode");
    let mark = format!("sleep 77{}", std::process::id());
    board.file(
        "left.py",
        format!(
            "import subprocess\nsubprocess.Popen('{mark}', shell=True, start_new_session=True)\nprint('a', 1)\nprint('b')\n"
        ),
    );
    let output = trik(&board, &["check", "line.qrs", "--script", "left.py"]);
    assert!(
        output.stdout.starts_with("print: a 1\nprint: b\n"),
        "{}{}",
        output.stdout,
        output.stderr
    );
    let lives = || {
        let all = fs::read_dir("/proc").expect("/proc").flatten();
        all.filter_map(|one| fs::read(one.path().join("cmdline")).ok())
            .any(|words| {
                String::from_utf8_lossy(&words)
                    .replace('\0', " ")
                    .contains(&mark)
            })
    };
    assert!(!lives());
    board.file("hello.js", "print('hello'); script.quit();");
    let output = trik(
        &board,
        &[
            "check",
            "line.qrs",
            "--script",
            "hello.js",
            "--results",
            "-",
        ],
    );
    assert!(
        output.stdout.contains("\"printed\":[\"hello\"]"),
        "{}",
        output.stdout
    );
}

#[test]
fn what_is_there_already_is_not_replaced_and_nothing_runs() {
    let board = folder();
    // A verdict beside a refusal would be lost.
    for paths in [&["line.qrs"][..], &["line.qrs", "line.qrs"]] {
        let place = if paths.len() == 1 { "p.svg" } else { "twice" };
        let words = [&["check"], paths, &["--svg", place]].concat();
        trik(&board, &words);
        let refused = trik(&board, &words);
        assert_eq!((refused.code(), &*refused.stdout), (2, ""), "{place}");
        assert!(
            refused.stderr.contains("is there already"),
            "{}",
            refused.stderr
        );
    }
}

#[test]
fn reports_trajectories_pictures_and_pages_are_written_for_each_run() {
    let board = folder();
    let one = [
        "check",
        "line.qrs",
        "--report",
        "r.json",
        "--trajectory",
        "t.json",
        "--svg",
        "p.svg",
        "--html",
        "p.html",
        "--results",
        "all.jsonl",
    ];
    assert_eq!(trik(&board, &one).code(), 0);
    let read = |name: &str| fs::read_to_string(board.path(name)).expect(name);
    assert!(read("r.json").contains(r#"{"level":"info","message":"At the finish"}"#));
    assert!(read("r.json").contains(r#""name":"total_score","value":5"#));
    assert!(
        read("t.json")
            .contains(r#"{"robotId":"trikKitRobot","rotation":0,"timestamp":10,"x":0,"y":0}"#)
    );
    assert!(read("p.svg").contains("finish</text>") && read("p.html").contains("At the finish"));
    let line = read("all.jsonl");
    assert!(
        line.starts_with(
            r#"{"solution":"line.qrs","field":null,"verdict":"accomplished","failure":null,"ms":"#
        ),
        "{line}"
    );
    assert!(line.contains(r#""total_score":5,"#), "{line}");
    // The record is judged as the run was, and no file is replaced by mistake.
    let again = trik(&board, &["check", "line.qrs", "--log", "t.json"]);
    assert_eq!(again.code(), 0, "{}{}", again.stdout, again.stderr);
    let refused = trik(&board, &one);
    assert!(
        refused.code() != 0
            && format!("{}{}", refused.stdout, refused.stderr).contains("is there already")
    );
    assert_eq!(trik(&board, &[&one[..], &["--force"]].concat()).code(), 0);
    // Several runs have a directory.
    let many = [
        "check",
        "class",
        "--field",
        "fields",
        "--report",
        "out",
        "--svg",
        "out",
        "--results",
        "-",
    ];
    let output = trik(&board, &many);
    assert_eq!(output.stdout.lines().count(), 6, "{}", output.stdout);
    for name in [
        "anna/line--far.json",
        "anna/line--near.svg",
        "boris--near.json",
        "damaged--near.json",
    ] {
        assert!(board.path("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn hundreds_of_solutions_come_in_order_whatever_some_of_them_do() {
    let board = Board::new();
    fs::create_dir(board.path("class")).expect("a folder");
    let near = world(100);
    let mut expected = String::new();
    for number in 0..300 {
        let name = format!("class/{number:03}.qrs");
        let (bytes, verdict) = match number % 3 {
            0 => (drive("3000", Some(&near)), "accomplished"),
            1 => (drive("100", Some(&near)), "failed"),
            _ => (b"rubbish".to_vec(), "broken"),
        };
        board.file(&name, bytes);
        expected.push_str(&format!("{name} {verdict}\n"));
    }
    let output = trik(&board, &["check", "class", "--results", "-", "--jobs", "3"]);
    assert_eq!(output.code(), 2, "{}", output.stderr);
    let part = |line: &str, name: &str| {
        let mark = format!("\"{name}\":\"");
        let at = line.find(&mark).expect(line) + mark.len();
        line[at..].split('"').next().unwrap_or_default().to_owned()
    };
    let lines = output.stdout.lines();
    let told: String = lines
        .map(|line| format!("{} {}\n", part(line, "solution"), part(line, "verdict")))
        .collect();
    assert!(told == expected, "{told}");
}

#[test]
fn hostile_worlds_and_programs_are_refused_or_ended_in_bounded_time() {
    let board = Board::new();
    let near = world(100);
    let walls: String = (0..1_000_000)
        .map(|_| "<wall id=\"\" begin=\"0:0\" end=\"1:1\"/>")
        .collect();
    let storm: String = (0..2_000)
        .map(|number| {
            format!(
                "<event id=\"e{number}\" settedUpInitially=\"true\" dropsOnFire=\"false\"><condition><true/></condition>\
                 <triggers><message text=\"m\"/><setUp id=\"e{}\"/></triggers></event>",
                (number + 1) % 2_000
            )
        })
        .collect();
    let cases = [
        ("nan", near.replace("400:-100", "NaN:0")),
        ("far", near.replace("400:-100", "1e308:-1e308")),
        ("zero", near.replace("width=\"120\" height=\"120\"", "width=\"0\" height=\"0\"")),
        ("walls", near.replace("<walls>", &format!("<walls>{walls}"))),
        ("blob", near.replace("<images/>", "<images><image id=\"i\" rect=\"0:0:10:10\" position=\"0:0\" imageId=\"gone\" isBackground=\"false\"/></images>")),
        ("both", near.replace("<timelimit value=\"10000\"/>", "<timelimit value=\"1\"/><timelimit value=\"2\"/>")),
        ("region", near.replace("regionId=\"finish\"", "regionId=\"nowhere\"")),
        ("object", near.replace("objectId=\"robot1\"", "objectId=\"robot7\"")),
        ("storm", near.replace("<timelimit value=\"10000\"/>", &format!("<timelimit value=\"1000\"/>{storm}"))),
        ("deep", near.replace("<inside", &"<not>".repeat(10_000))),
        ("empty", String::new()),
        ("binary", "\u{0}\u{1}".to_owned()),
    ];
    fs::create_dir(board.path("fields")).expect("a folder");
    board.file("line.qrs", drive("3000", None));
    for (name, world) in &cases {
        board.file(&format!("fields/{name}.xml"), world);
    }
    let begun = std::time::Instant::now();
    let words = [
        "check",
        "line.qrs",
        "--field",
        "fields",
        "--results",
        "-",
        "--wall-limit",
        "20",
    ];
    let output = trik(&board, &words);
    assert_eq!(output.code(), 2, "{}", output.stderr);
    assert_eq!(
        output.stdout.lines().count(),
        cases.len(),
        "{}",
        output.stdout
    );
    for line in output.stdout.lines() {
        let is_told =
            !line.contains("\"verdict\":\"broken\"") || line.contains("\"level\":\"error\"");
        assert!(is_told && !line.contains("has a defect"), "{line}");
    }
    // No case reaches the limit of real time.
    assert!(!output.stdout.contains("real time"), "{}", output.stdout);
    println!(
        "{} ms for {} fields",
        begun.elapsed().as_millis(),
        cases.len()
    );
}

#[test]
fn graders_that_call_programs_of_trik_studio_find_them() {
    let board = folder();
    for name in ["2D-model", "patcher"] {
        std::os::unix::fs::symlink(TRIK, board.path(name)).expect("a link");
    }
    let sh = |script: &str| {
        let mut command = tools::shell(script);
        command
            .current_dir(board.dir())
            .env("PATH", "/usr/bin:/bin")
            .env("LC_ALL", "C");
        tools::run(&mut command, b"")
    };
    let words =
        "-platform minimal -b --report r --trajectory t --input no-such-file --mode diagram";
    let done = sh(&format!("./2D-model {words} line.qrs"));
    assert_eq!(done.code(), 0, "{}", done.stderr);
    let text = fs::read_to_string(board.path("r")).expect("a report");
    assert!(text.contains("At the finish"), "{text}");
    assert!(
        fs::read_to_string(board.path("t"))
            .expect("a trajectory")
            .contains("\"rotation\"")
    );
    assert_eq!(sh(&format!("./2D-model {words} short.qrs")).code(), 1);
    assert_eq!(
        sh(&format!("./2D-model {words} class/damaged.qrs")).code(),
        2
    );
    assert_eq!(sh("./2D-model --mode dream line.qrs").code(), 2);
    assert_eq!(
        sh("./2D-model --generate-mode cobol --generate-path x line.qrs").code(),
        4
    );
    let code =
        sh("./2D-model --generate-mode python --generate-path x.py --only-generate line.qrs");
    assert_eq!(code.code(), 0, "{}", code.stderr);
    assert!(board.path("x.py").is_file());
    let again =
        sh("./2D-model --generate-mode python --generate-path x.py --only-generate line.qrs");
    assert_eq!(again.code(), 3, "{}", again.stderr);
    // The grader's own way: a copy of the solution with another field.
    let patched = sh("cp line.qrs copy.qrs && ./patcher copy.qrs -f fields/far.xml -s ''");
    assert_eq!(patched.code(), 0, "{}", patched.stderr);
    assert_eq!(sh(&format!("./2D-model {words} copy.qrs")).code(), 1);
    let save = read::read(&fs::read(board.path("copy.qrs")).expect("a save")).expect("a save");
    assert!(save.project.world.unwrap_or_default().contains("x=\"300\""));
    assert_eq!(
        sh("./patcher copy.qrs -f fields/far.xml -w fields/far.xml").code(),
        2
    );
    assert_eq!(sh("./patcher copy.qrs -f nowhere.xml").code(), 1);
    assert_eq!(
        sh("echo 'script.wait(1)' > p.js; ./patcher copy.qrs -s p.js --rrp").code(),
        0
    );
    let save = read::read(&fs::read(board.path("copy.qrs")).expect("a save")).expect("a save");
    assert_eq!(
        save.project.meta.get("activeCode").map(|code| code.trim()),
        Some("script.wait(1)")
    );
}
