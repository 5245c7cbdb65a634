//! Recordings through another configuration: what devices gave is converted once more, compared, drawn and played.
//!
//! Owns the recording of a made-up robot whose devices were recorded, and one of a virtual robot.

use crate::programs::Reachable;
use crate::replay::Recorder;
use crate::rig::{Home, Robot, TRIK};
use harness::{Board, Output, eventually, tools};
use journal::node::Node;
use journal::write::Writer;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, BufWriter, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Arc;

const MS: u64 = 1_000_000;
const ZERO: u64 = 1_700_000_000_000 * MS;

/// Two bytes of a device are a number, and three times as much is the distance.
const BEFORE: &str = "local function triple(a_s, a, b_s, b) ba.i32(b, 0, ba.u16(a, 0) * 3) end
trikfs = {
  sensors = { D = { src = '/dev/null', input_tuple_size = 2, format = 'i32 distance', units = 'mm', poll_ms = 10, converter = triple } },
  motor = { src = '/dev/null', format = 'i8 power', rest = 0 },
}
";

fn trik(board: &Board, words: &[&str]) -> Output {
    let mut command = Command::new(TRIK);
    command.args(words).current_dir(board.dir());
    tools::run(&mut command, b"")
}

fn differ(board: &Board, config: &str, words: &[&str]) -> Output {
    fs::write(board.dir().join("new.lua"), config).expect("written");
    let all = [
        &["replay", "run.mcap", "--config", "new.lua", "--diff"],
        words,
    ]
    .concat();
    trik(board, &all)
}

/// What is told of a command that is refused.
fn why_not(board: &Board, config: &str, words: &[&str]) -> String {
    let output = differ(board, config, words);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    output.stderr
}

/// 2 s at 50 Hz: a device that counts, and is unplugged for a moment; a motor.
fn record(path: &Path) {
    let file = BufWriter::new(File::create_new(path).expect("a new file"));
    let mut out = Writer::new(file, "test 1").expect("begun");
    out.attach(ZERO, "config.lua", "text/x-lua", BEFORE.as_bytes())
        .expect("a file");
    let mut node = Node::sensor("sensors/D", "i32 distance");
    node.units = "mm".to_owned();
    let mut motor = Node::sensor("motor", "i8 power");
    (motor.is_written, motor.rest) = (true, "0".to_owned());
    let raw = Node::raw("sensors/D", 2);
    let [node, motor, raw] = [node, motor, raw].map(|node| out.add(&node).expect("a node"));
    for step in 0..100_u16 {
        let at = ZERO + u64::from(step) * 20 * MS;
        if step == 50 {
            out.fault(raw, at, 19, "device: gone").expect("written");
            out.fault(node, at + 1_000, 19, "device: gone")
                .expect("written");
            continue;
        }
        // The numbers go up, and one of them is far off.
        let given = if step == 30 { 900 } else { step };
        out.sample(raw, at, &given.to_le_bytes()).expect("written");
        let sample = i32::from(given) * 3;
        out.sample(node, at + 1_000, &sample.to_le_bytes())
            .expect("written");
        out.sample(motor, at, &[7]).expect("written");
    }
    out.finish().expect("finished");
}

fn recorded() -> Board {
    let board = Board::new();
    record(&board.dir().join("run.mcap"));
    board
}

#[test]
fn what_another_configuration_makes_of_the_same_bytes_is_compared_and_drawn() {
    let board = recorded();
    let same = differ(&board, BEFORE, &[]);
    assert_eq!(same.good(), "sensors/D: 99 samples, as recorded\n");
    // One with an outlier less, under another name as well, and a node that was not there.
    let calm = BEFORE.replace(
        "converter = triple }",
        "converter = function(a_s, a, b_s, b) ba.i32(b, 0, math.min(ba.u16(a, 0), 500) * 3) end },
         twice = { src = '/dev/null', input_tuple_size = 2, format = 'u16 x', poll_ms = 10 }",
    );
    let output = differ(&board, &calm, &["-o", "diff.svg"]);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    assert_eq!(
        output.stdout,
        "sensors/D: 99 samples, 1 differ; first at 0.600001 s: distance was 2700, is 1500; most at 0.600001 s, by 1200: distance was 2700, is 1500
sensors/twice: 99 samples, of what sensors/D gave; it was not recorded
"
    );
    let picture = fs::read_to_string(board.dir().join("diff.svg")).expect("a picture");
    assert!(
        picture.contains("grey: recorded; blue: by new.lua"),
        "{picture}"
    );
    assert_eq!(picture.matches("class=\"b\"").count(), 1);
    assert_eq!(picture.matches("class=\"l\"").count(), 1);
    // Again it is the same to the byte, and no file is overwritten.
    let again = differ(&board, &calm, &["-o", "diff.svg", "--force"]);
    assert_eq!(again.stdout, output.stdout);
    let second = fs::read_to_string(board.dir().join("diff.svg")).expect("a picture");
    assert!(picture == second, "the pictures differ");
    let refused = why_not(&board, &calm, &["-o", "diff.svg"]);
    assert!(refused.contains("diff.svg"), "{refused}");
    // From a later moment on nothing differs, and of the new node alone nothing can.
    for words in [&["--start", "0.61"][..], &["--only", "sensors/twice"]] {
        assert!(differ(&board, &calm, words).status.success(), "{words:?}");
    }
}

#[test]
fn a_number_that_has_another_name_now_is_drawn_under_both() {
    let board = recorded();
    let other = BEFORE.replace("i32 distance", "i32 range");
    assert_ne!(other, BEFORE);
    let output = differ(&board, &other, &["-o", "named.svg"]);
    assert_eq!(output.status.code(), Some(1), "{}", output.stderr);
    let picture = fs::read_to_string(board.dir().join("named.svg")).expect("a picture");
    for title in ["sensors/D.range", "sensors/D.distance"] {
        assert!(picture.contains(title), "{title}: {picture}");
    }
    assert_eq!(picture.matches("class=\"b\"").count(), 1);
    assert_eq!(picture.matches("class=\"l\"").count(), 1);
}

#[test]
fn a_filter_that_fails_or_swallows_is_told_where_it_does() {
    let board = recorded();
    let failing = BEFORE.replace(
        "ba.i32",
        "if ba.u16(a, 0) == 60 then error('sixty') end ba.i32",
    );
    let output = differ(&board, &failing, &[]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        output.stdout.contains("98 samples, recorded are 99, 1 differ; first at 1.200001 s: recorded is 180, now it fails: converter: "),
        "{}",
        output.stdout
    );
    let halves = BEFORE.replace(
        "ba.i32",
        "if ba.u16(a, 0) % 2 == 1 then return false end ba.i32",
    );
    let output = differ(&board, &halves, &[]);
    assert!(
        output.stdout.contains("now it is nothing"),
        "{}",
        output.stdout
    );
}

#[test]
fn what_cannot_be_compared_says_what_to_do() {
    let board = recorded();
    let refusals = [
        ("trikfs = {", "new.lua:1"),
        (
            "trikfs = { a = { src = fake{ data = 'x' }, input_tuple_size = 1 } }",
            "it has none of the nodes whose bytes are in run.mcap, and none with the same source: sensors/D",
        ),
        (
            &BEFORE.replace("input_tuple_size = 2", "input_tuple_size = 4"),
            "sensors/D takes 4 bytes from its device at once, and those of sensors/D in run.mcap are 2",
        ),
    ];
    for (config, wanted) in refusals {
        let refused = why_not(&board, config, &[]);
        assert!(refused.contains(wanted), "{refused}");
    }
    let refused = why_not(&board, BEFORE, &["--only", "nobody"]);
    assert!(refused.contains("none that --only matches"), "{refused}");
    let refused = why_not(&board, BEFORE, &["-o", "new.lua"]);
    assert!(refused.contains("its name ends with .svg"), "{refused}");
    // One without bytes of devices.
    trik(
        &board,
        &["cut", "run.mcap", "--only", "sensors", "-o", "plain.mcap"],
    )
    .good();
    let words = ["replay", "plain.mcap", "--config", "new.lua", "--diff"];
    let refused = trik(&board, &words).stderr;
    assert!(
        refused.contains("record it with trik record --raw"),
        "{refused}"
    );
    // A cut one is told as by every command.
    let whole = fs::read(board.dir().join("run.mcap")).expect("a recording");
    fs::write(board.dir().join("run.mcap"), &whole[..whole.len() / 2]).expect("written");
    let refused = why_not(&board, BEFORE, &[]);
    assert!(refused.contains("trik mend"), "{refused}");
}

#[test]
fn a_tree_gives_what_another_configuration_makes() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    record(&home.0.path("run.mcap"));
    let ten = BEFORE.replace("* 3", "* 10").replace("'mm'", "'um'");
    fs::write(home.0.path("new.lua"), ten).expect("written");
    // What cannot be played is told by the name of the recording.
    let large = BEFORE.replace(
        "format = 'i32 distance', units = 'mm'",
        "output_tuple_size = 140000",
    );
    fs::write(home.0.path("large.lua"), large).expect("written");
    let refused = home.run(&["replay", "run.mcap", "--config", "large.lua", "--exit"]);
    let why = refused.stderr;
    assert!(
        why.starts_with("trik: run.mcap: sensors/D: tuples of 140000 bytes"),
        "{why}"
    );
    let mut nowhere = home.command(&["replay", "run.mcap", "--config", "new.lua", "--exit"]);
    let refused = tools::run(nowhere.env("TMPDIR", "/nowhere"), b"").stderr;
    assert!(refused.starts_with("trik: /nowhere: "), "{refused}");
    let words = ["--config", "new.lua", "--paused"];
    let mut replay = Robot::replay(home.clone(), "run.mcap", &words);
    let order = |line: &str| {
        fs::write(replay.devices.join("replay"), format!("{line}\n")).expect("an order");
    };
    order("seek 0.21");
    eventually("ten times as much", || {
        replay.errno("sensors/D/value") == 0 && replay.number("sensors/D/value") == 100.0
    });
    assert_eq!(replay.read("sensors/D/units").expect("units"), "um");
    assert_eq!(replay.number("motor/value"), 7.0, "as it was recorded");
    order("seek 1.01");
    eventually("the failure of the device", || {
        replay.errno("sensors/D/value") == nix::libc::ENODEV
    });
    assert!(replay.end(Signal::SIGINT).success());
}

/// The usual robot, whose distance sensors keep no earlier values: a recording does not have what was before it.
fn forgetful(home: &Home) -> String {
    let shipped = include_str!("../../../config/lua/robots/two-wheels.lua");
    let text = shipped.replace(
        "type = 'ultrasonic',",
        "type = 'ultrasonic', median3 = false,",
    );
    assert_eq!(text.matches("median3 = false").count(), 2, "D1 and D2");
    home.0.file("robot.lua", text).display().to_string()
}

#[test]
fn a_virtual_robot_makes_the_same_of_its_bytes_once_more() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let config = forgetful(&home);
    let mut robot = Robot::start(home.clone(), &["--raw", "--config", &config]);
    let recorder = Recorder::start_to(&home, "run.mcap", &["--raw"]);
    eventually("a recording", || home.0.path("run.mcap").exists());
    robot.drive(30, 40);
    eventually("a way", || robot.number("encoders/E3/value") > 300.0);
    robot.write("stop", "1").expect("stop");
    recorder.end();
    let info = home.run(&["info", "run.mcap"]).good();
    assert!(info.contains("raw/sensors/A1"), "{info}");
    // What is written to a motor has no device before it.
    assert!(!info.contains("raw/motors"), "{info}");
    fs::copy(robot.root.join("config"), home.0.path("same.lua")).expect("a copy");
    assert!(robot.end(Signal::SIGINT).success());
    let words = [
        "replay", "run.mcap", "--config", "same.lua", "--diff", "--only", "sensors", "--only",
        "encoders",
    ];
    let said = home.run(&words).good();
    assert!(said.lines().count() >= 10, "{said}");
    assert!(
        said.lines()
            .all(|line| line.ends_with("as recorded") || line.contains("lost events")),
        "{said}"
    );
}

#[test]
fn bytes_of_devices_come_over_the_network_and_are_in_the_black_box() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let config = forgetful(&home);
    let robot = Reachable::beside(&home, &["--raw", "--config", &config]);
    let refused = home.run(&["record", "--robot", robot.ip(), "--raw", "--hz", "5"]);
    assert!(
        refused.stderr.contains("leave --hz out"),
        "{}",
        refused.stderr
    );
    let words = [
        "--robot",
        robot.ip(),
        "--raw",
        "--only",
        "sensors",
        "--only",
        "encoders",
    ];
    let recorder = Recorder::start_to(&home, "run.mcap", &words);
    eventually("a recording", || home.0.path("run.mcap").exists());
    // Another client, who has not asked for them, has none.
    let plain = ["--robot", robot.ip(), "--only", "sensors"];
    let plain = Recorder::start_to(&home, "plain.mcap", &plain);
    robot.robot.drive(30, 40);
    eventually("a way", || robot.robot.number("encoders/E3/value") > 300.0);
    robot.robot.write("stop", "1").expect("stop");
    eventually("a recording", || home.0.path("plain.mcap").exists());
    recorder.end();
    plain.end();
    let info = home.run(&["info", "run.mcap"]).good();
    assert!(info.contains("raw/sensors/A1"), "{info}");
    assert!(!info.contains("raw/gyroscope"), "not asked for: {info}");
    let other = home.run(&["info", "plain.mcap"]).good();
    assert!(!other.contains("raw/"), "{other}");
    home.run(&["box", "save", "-o", "box.mcap", "--robot", robot.ip()])
        .good();
    let kept = home.run(&["info", "box.mcap"]).good();
    assert!(kept.contains("raw/gyroscope"), "{kept}");
    fs::copy(robot.robot.root.join("config"), home.0.path("same.lua")).expect("a copy");
    for file in ["run.mcap", "box.mcap"] {
        let words = [
            "replay", file, "--config", "same.lua", "--diff", "--only", "sensors", "--only",
            "encoders",
        ];
        let said = home.run(&words).good();
        assert!(said.lines().count() >= 10, "{said}");
        let is_same = |line: &str| line.ends_with("as recorded") || line.contains("lost events");
        assert!(said.lines().all(is_same), "{file}: {said}");
    }
}

#[test]
fn a_tree_without_bytes_of_devices_says_how_there_are_some() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let mut robot = Reachable::beside(&home, &[]);
    let words = ["record", "--raw", "-o", "far.mcap", "--robot", robot.ip()];
    let mut command = home.command(&words);
    let recorder = command.stdout(Stdio::null()).stderr(Stdio::piped());
    let mut recorder = recorder.spawn().expect("trik record");
    let mut told = BufReader::new(recorder.stderr.take().expect("standard error"));
    // While it records, and once.
    let mut why = String::new();
    told.read_line(&mut why).expect("a line");
    assert!(
        why.contains("far.mcap") && why.contains("trik up --raw"),
        "{why}"
    );
    assert!(home.0.path("far.mcap").exists());
    let pid = Pid::from_raw(i32::try_from(recorder.id()).expect("a pid"));
    kill(pid, Signal::SIGINT).expect("SIGINT");
    assert_eq!(recorder.wait().expect("an end").code(), Some(1));
    let mut rest = String::new();
    told.read_to_string(&mut rest).expect("the rest");
    assert_eq!(rest, "");
    // What there is stays.
    home.run(&["info", "far.mcap"]).good();
    let refused = home.run(&["record", "--raw", "-o", "run.mcap"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(
        refused.stderr.contains("trik up --raw"),
        "{}",
        refused.stderr
    );
    assert!(!home.0.path("run.mcap").exists());
    assert!(robot.robot.end(Signal::SIGINT).success());
}
