//! Recordings of robots that are judged: the verdict of what really happened, and why there is none.

use crate::programs::Reachable;
use crate::replay::Recorder;
use crate::rig::{Home, TRIK};
use harness::{Board, Output, eventually, tools};
use journal::node::Node;
use journal::standard::{Level, Log};
use journal::write::{Story, Writer};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::Command;
use std::sync::Arc;

const MS: u64 = 1_000_000;
/// 2023-11-14 22:13:20 UTC.
const ZERO: u64 = 1_700_000_000_000 * MS;

/// A floor with a finish 35 cm ahead, before a wall that an infrared sensor sees, and these conditions beside being there.
fn world(conditions: &str) -> String {
    format!(
        r##"<root version="20251219">
<world>
<walls><wall id="wall" begin="400:-100" end="400:200" stroke="#ff000000" stroke-width="10"/></walls>
<balls><ball id="ball" x="0" y="300"/></balls>
<regions><region id="finish" type="rectangle" x="100" y="-10" width="120" height="120" visible="true"/></regions>
<robot position="0:0" direction="0"/>
</world>
<robots><robot id="trikKitRobot"><sensors><sensor port="A1###input######sensorA1" type="TrikInfraredSensor" position="75:25" direction="0"/></sensors><wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings/>
<constraints>
<timelimit value="20000"/>
<event id="there" settedUpInitially="true"><condition><conditions glue="and"><inside objectId="robot1" regionId="finish"/>{conditions}</conditions></condition>
<triggers><setter name="total_score"><int value="5"/></setter><message text="At the finish"/><success/></triggers></event>
</constraints>
</root>
"##
    )
}

/// A robot that drives half a metre in 2 s, 1 s after the recording begins, and what it says meanwhile.
struct Drive {
    place: Node,
    /// Of its program, and whether it failed.
    ends: Option<bool>,
    /// The place is lost in the middle.
    loses: bool,
    /// Where it was before that.
    from_mm: f32,
    /// The step, of 20 ms, at which its sensor speaks first; its program starts at the 50th.
    speaks_at: u32,
    /// Its place has this number once, in the middle.
    odd: Option<f32>,
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            place: Node::sensor("odometry", "f32 x, f32 y, f32 heading"),
            ends: Some(true),
            loses: false,
            from_mm: 0.0,
            speaks_at: 0,
            odd: None,
        }
    }
}

impl Drive {
    fn write(&self, path: &Path) {
        let file = BufWriter::new(File::create(path).expect("a file"));
        let mut out = Writer::new(file, "test 1").expect("begun");
        let place = out.add(&self.place).expect("a node");
        let mut distance = Node::sensor("sensors/A1", "i32 distance");
        distance.units = "cm".to_owned();
        let distance = out.add(&distance).expect("a node");
        let mut motors = Vec::new();
        for number in 1..=4 {
            let mut motor = Node::sensor(&format!("motors/M{number}"), "i32 duty_cycle");
            (motor.is_written, motor.rest) = (true, "0".to_owned());
            motors.push(out.add(&motor).expect("a node"));
        }
        let say = |text: &str, level| Log {
            level,
            name: "go.py".to_owned(),
            text: text.to_owned(),
            errno: 0,
        };
        for step in 0..=200_u32 {
            let at = ZERO + u64::from(step) * 20 * MS;
            if step == 50 {
                let text = "go.py has started as Python";
                out.line(Story::Programs, at, &say(text, Level::Info))
                    .expect("a line");
            }
            if step == 51 || step == 150 {
                let power: i32 = if step == 51 { 60 } else { 0 };
                for motor in &motors[2..] {
                    out.sample(*motor, at, &power.to_le_bytes()).expect("told");
                }
            }
            let driven = step.clamp(51, 151) - 51;
            let x = match self.odd.filter(|_| step == 100) {
                Some(odd) => odd,
                None => self.from_mm + driven as f32 * 5.0,
            };
            let tuple: Vec<u8> = [x, 0.0, 0.0].iter().flat_map(|n| n.to_le_bytes()).collect();
            match self.loses && step == 100 {
                true => out.fault(place, at, 19, "an encoder jumped"),
                false => out.sample(place, at, &tuple),
            }
            .expect("written");
            let cm = 120 - i32::try_from(driven / 2).expect("small");
            if step >= self.speaks_at {
                out.sample(distance, at, &cm.to_le_bytes())
                    .expect("written");
            }
            if step == 175
                && let Some(is_good) = self.ends
            {
                let (text, level) = match is_good {
                    true => ("go.py has ended after 2.5 s", Level::Info),
                    false => (
                        "go.py has failed with exit code 1 after 2.5 s",
                        Level::Error,
                    ),
                };
                out.line(Story::Programs, at, &say(text, level))
                    .expect("a line");
            }
        }
        out.finish().expect("finished");
    }
}

fn board(conditions: &str) -> Board {
    let board = Board::new();
    fs::write(board.path("world.xml"), world(conditions)).expect("a world");
    board
}

fn check(board: &Board, more: &[&str]) -> Output {
    let words = ["check", "--log", "run.mcap", "--field", "world.xml"];
    let mut command = Command::new(TRIK);
    command
        .args([&words[..], more].concat())
        .current_dir(board.dir());
    tools::run(&mut command, b"")
}

fn less(path: &str, value: i32) -> String {
    format!(r#"<less><objectState object="{path}"/><int value="{value}"/></less>"#)
}

fn riding() -> String {
    r#"<equals><objectState object="robot1.isRiding"/><bool value="true"/></equals>"#.to_owned()
}

#[test]
fn a_recorded_robot_is_judged_by_its_place_sensors_and_motors() {
    // The world alone would have the wall nearer than that from the beginning; what was recorded counts.
    let board = board(&format!("{}{}", less("robot1.A1.value", 91), riding()));
    Drive::default().write(&board.path("run.mcap"));
    let output = check(&board, &["--explain"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(output.stdout.contains("At the finish"), "{}", output.stdout);
    // 90 cm is what it says 60 steps after it starts to move, one step after the program.
    let last = "run.mcap: accomplished, 1.22 s, score: 5\n";
    assert!(output.stdout.ends_with(last), "{}", output.stdout);
    let russian = check(&board, &["--language", "ru"]).stdout;
    assert!(!russian.contains("accomplished, "), "{russian}");
    // Too near at the end, and only then.
    fs::write(board.path("world.xml"), world(&less("robot1.A1.value", 70))).expect("a world");
    let output = check(&board, &["--results", "-"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(
        output.stdout.contains(r#""failure":"wrong""#),
        "{}",
        output.stdout
    );
    fs::write(board.path("world.xml"), world("")).expect("a world");
    let svg = check(&board, &["--svg", "way.svg", "--trajectory", "way.json"]);
    assert_eq!(svg.status.code(), Some(0), "{svg:?}");
    assert!(board.path("way.svg").is_file());
    // The trajectory that comes out is judged alike.
    let words = ["check", "--log", "way.json", "--field", "world.xml"];
    let mut command = Command::new(TRIK);
    command.args(words).current_dir(board.dir());
    assert_eq!(tools::run(&mut command, b"").status.code(), Some(0));
}

#[test]
fn what_a_recording_cannot_tell_is_an_error_before_anything_is_judged() {
    let asked = [
        less("robot1.A2.value", 5),
        less("ball.x", 5),
        less("robot1.display.labels.size", 5),
        less("robot1.E1.value", 5),
        r#"<equals><objectState object="robot1.led.color"/><string value="red"/></equals>"#
            .to_owned(),
    ];
    let board = board(&asked.concat());
    Drive::default().write(&board.path("run.mcap"));
    let output = check(&board, &[]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let told = &output.stdout;
    for (what, node) in [
        ("robot1.E1.value", "encoders/E1"),
        ("robot1.led.color", "led/green"),
        ("robot1.led.color", "led/red"),
    ] {
        let is_told = told
            .lines()
            .any(|line| line.contains(what) && line.contains(node));
        assert!(is_told, "{what}: {told}");
    }
    for what in ["ball.x", "robot1.display.labels.size"] {
        let line = told.lines().find(|line| line.contains(what)).expect(what);
        assert!(
            line.contains("'there'") && line.contains("no recording"),
            "{line}"
        );
    }
    // Nothing is plugged in at A2 in this world, which a run tells as it does of a simulated one.
    assert!(!told.contains("At the finish"), "{told}");
}

#[test]
fn a_recording_without_a_place_is_refused_and_another_node_can_say_it() {
    let board = board("");
    let path = board.path("run.mcap");
    let mut drive = Drive::default();
    drive.place.path = "tracker".to_owned();
    drive.write(&path);
    let output = check(&board, &[]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        output.stdout.contains("no node odometry"),
        "{}",
        output.stdout
    );
    let output = check(&board, &["--pose", "tracker"]);
    assert!(output.stdout.contains("mm, deg"), "{}", output.stdout);
    drive.place.units = "mm, deg".to_owned();
    drive.write(&path);
    assert_eq!(check(&board, &["--pose", "tracker"]).status.code(), Some(0));
    // Where it had been driven to before counts only from the place where the node says 0.
    let drive = Drive {
        from_mm: 5000.0,
        ..Drive::default()
    };
    drive.write(&path);
    assert_eq!(check(&board, &[]).status.code(), Some(0));
    let output = check(&board, &["--pose-from", "zero"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let lost = Drive {
        loses: true,
        ends: None,
        ..Drive::default()
    };
    lost.write(&path);
    let far = world("").replace("x=\"100\"", "x=\"1000\"");
    fs::write(board.path("world.xml"), far).expect("a world");
    let output = check(&board, &[]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(
        output.stdout.contains("an encoder jumped"),
        "{}",
        output.stdout
    );
}

#[test]
fn what_nobody_knows_is_not_taken_for_zero() {
    let board = board(&less("robot1.A1.value", 91));
    let path = board.path("run.mcap");
    // 0.8 s after its program a sensor may speak first; what it says then counts from the beginning.
    for (speaks_at, code) in [(90, 0), (120, 2)] {
        let drive = Drive {
            speaks_at,
            ..Drive::default()
        };
        drive.write(&path);
        let output = check(&board, &[]);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let is_told = output.stdout.contains("sensors/A1 says nothing up to");
        assert_eq!(is_told, code == 2, "{}", output.stdout);
    }
    for odd in [f32::NAN, f32::INFINITY] {
        let drive = Drive {
            odd: Some(odd),
            ..Drive::default()
        };
        drive.write(&path);
        let output = check(&board, &[]);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let told = "unknown: odometry failed: no number";
        assert!(output.stdout.contains(told), "{}", output.stdout);
    }
}

#[test]
fn the_run_is_that_of_the_first_program_or_what_a_person_says() {
    let far = world("").replace("x=\"100\"", "x=\"1000\"");
    let board = board("");
    let path = board.path("run.mcap");
    fs::write(board.path("world.xml"), far).expect("a world");
    let ends_at = |more: &[&str]| {
        let output = check(&board, more);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        let last = output.stdout.lines().last().expect("a line").to_owned();
        last.split_once(", ").expect("a time").1.to_owned()
    };
    Drive::default().write(&path);
    assert_eq!(ends_at(&[]), "2.50 s");
    assert_eq!(ends_at(&["--from", "1.5", "--to", "2"]), "0.50 s");
    assert_eq!(ends_at(&["--time-limit", "1"]), "1.00 s");
    let open = Drive {
        ends: None,
        ..Drive::default()
    };
    open.write(&path);
    assert_eq!(ends_at(&[]), "3.00 s");
    let output = check(&board, &["--from", "9"]);
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(output.stdout.contains("4.0 s long"), "{}", output.stdout);
    let words = ["check", "go.js", "--field", "world.xml", "--from", "1"];
    let mut command = Command::new(TRIK);
    command.args(words).current_dir(board.dir());
    let output = tools::run(&mut command, b"");
    assert!(output.stderr.contains("--log"), "{output:?}");
    // A task that counts at the end of a program is not done by one that has failed.
    let deferred = world("").replace("<success/>", r#"<success deferred="true"/>"#);
    fs::write(board.path("world.xml"), deferred).expect("a world");
    for (ends, code) in [(Some(true), 0), (Some(false), 1), (None, 1)] {
        let drive = Drive {
            ends,
            ..Drive::default()
        };
        drive.write(&path);
        let output = check(&board, &[]);
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        let is_told = output.stdout.contains("ends before the program does");
        assert_eq!(is_told, ends.is_none(), "{}", output.stdout);
    }
}

#[test]
fn cut_and_damaged_recordings_have_no_verdict() {
    let board = board("");
    let path = board.path("run.mcap");
    Drive::default().write(&path);
    let whole = fs::read(&path).expect("bytes");
    for cut in [0, 4, whole.len() / 2, whole.len() - 1] {
        fs::write(&path, &whole[..cut]).expect("a cut file");
        let output = check(&board, &[]);
        assert_eq!(output.status.code(), Some(2), "{cut}: {output:?}");
        assert!(output.stdout.contains("run.mcap: "), "{}", output.stdout);
    }
    // A recording has either its own verdict or none, whatever is damaged: never a crash.
    let mut random = needs::Random::new(21);
    for _ in 0..24 {
        let mut bytes = whole.clone();
        for _ in 0..8 {
            let at = random.below(bytes.len());
            bytes[at] ^= 1 << random.below(8);
        }
        fs::write(&path, &bytes).expect("a damaged file");
        let output = check(&board, &[]);
        let told = &output.stdout;
        assert!(matches!(output.status.code(), Some(0 | 2)), "{output:?}");
        assert!(
            !told.contains("defect") && !told.contains("crashed"),
            "{told}"
        );
    }
}

#[test]
fn a_robot_gets_the_same_verdict_from_its_recording_as_from_the_simulator() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let near = world(&less("robot1.A1.value", 79));
    fs::write(home.0.path("near.xml"), &near).expect("a world");
    let far = near.replace("x=\"100\"", "x=\"1000\"");
    fs::write(home.0.path("far.xml"), far).expect("a world");
    let program = "brick.motor('M3').setPower(60); brick.motor('M4').setPower(60);\nscript.wait(2500);\nbrick.motor('M3').setPower(0); brick.motor('M4').setPower(0);\n";
    fs::write(home.0.path("go.js"), program).expect("a program");
    let reachable = Reachable::beside(&home, &["--field", "near.xml"]);
    let recorder = Recorder::start_to(&home, "run.mcap", &["--robot", reachable.ip()]);
    eventually("a recording", || home.0.path("run.mcap").exists());
    let ran = home.run(&["run", "--robot", reachable.ip(), "go.js"]);
    assert_eq!(ran.status.code(), Some(0), "{ran:?}");
    recorder.end();
    for (field, code) in [("near.xml", 0), ("far.xml", 1)] {
        let simulated = home.run(&["check", "go.js", "--field", field]);
        let recorded = home.run(&["check", "--log", "run.mcap", "--field", field]);
        assert_eq!(simulated.status.code(), Some(code), "{simulated:?}");
        assert_eq!(recorded.status.code(), Some(code), "{recorded:?}");
        let said = |output: &Output| output.stdout.contains("At the finish");
        assert_eq!(said(&recorded), said(&simulated));
    }
}
