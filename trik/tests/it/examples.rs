//! The programs of `examples`, each in five languages: run on a robot, and judged by where the robot truly was.
//!
//! Time runs faster than it is, as fast as the loops of the programs (50 in a second of theirs) still follow. A machine
//! that is too busy for that gets another try at half the speed: what is judged is the program. Nothing that it says
//! counts.

use crate::rig::{Home, Pose, Robot};
use harness::wait::{eventually, skip};
use harness::{processes, tools};
use nix::sys::signal::Signal;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples");
/// Folder of each language, and the ending of its programs.
const LANGUAGES: [(&str, &str); 5] = [
    ("shell", "sh"),
    ("python", "py"),
    ("c", "c"),
    ("javascript", "js"),
    ("rust", "rs"),
];
const TASKS: [&str; 3] = ["wall", "line", "square"];

/// How fast time runs, one try after the other.
const SPEEDS: [&str; 3] = ["5", "2.5", "1.25"];
/// A guard against hanging: at the least speed everything is over in half of it.
const LIMIT: Duration = Duration::from_secs(60);

/// A program that runs on a robot; dropping it ends it.
struct Program(Child);

impl Program {
    fn has_ended(&mut self) -> Option<ExitStatus> {
        self.0.try_wait().expect("a child")
    }

    /// Looks at the robot again and again until the program ends. True if the robot has been watched for long enough
    /// before that.
    fn watch(
        &mut self,
        robot: &Robot,
        mut is_enough: impl FnMut(Pose) -> Result<bool, String>,
    ) -> Result<bool, String> {
        let deadline = Instant::now() + LIMIT;
        while self.has_ended().is_none() {
            if is_enough(robot.pose())? {
                return Ok(true);
            }
            require(Instant::now() < deadline, || {
                format!("not within {LIMIT:?}")
            })?;
            std::thread::sleep(Duration::from_millis(2));
        }
        Ok(false)
    }

    /// It has ended, and well.
    fn has_succeeded(&mut self) -> Result<(), String> {
        let status = self.has_ended();
        require(status.is_some_and(|status| status.success()), || {
            format!("ended with {status:?}")
        })
    }
}

fn require(holds: bool, why: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(why()) }
}

impl Drop for Program {
    fn drop(&mut self) {
        if self.0.try_wait().is_ok_and(|status| status.is_none()) {
            let _ = self.0.kill();
            let _ = self.0.wait();
        }
    }
}

fn source(task: &str, language: &str) -> PathBuf {
    let (_, ending) = LANGUAGES
        .into_iter()
        .find(|(name, _)| *name == language)
        .expect("a language");
    Path::new(EXAMPLES)
        .join(language)
        .join(format!("{task}.{ending}"))
}

/// The words that run a program, after it was compiled if its language wants that.
fn words(home: &Home, task: &str, language: &str) -> Vec<String> {
    let source = source(task, language).display().to_string();
    let made = home.0.path("program").display().to_string();
    let all = |list: &[&str]| list.iter().map(|word| (*word).to_owned()).collect();
    let (compiler, options): (String, Vec<String>) = match language {
        "shell" => return all(&["sh", &source]),
        "python" => return all(&["python3", &source]),
        "javascript" => return all(&["node", &source]),
        "c" => (
            tools::c_compiler(),
            all(&["-Wall", "-Wextra", "-Werror", "-O1"]),
        ),
        _ => (
            "rustc".to_owned(),
            all(&["--edition", "2024", "-D", "warnings"]),
        ),
    };
    let mut command = Command::new(compiler);
    command.args(options).arg("-o").arg(&made).arg(&source);
    // There rustup knows which compiler is meant.
    tools::run(command.current_dir(EXAMPLES), b"").good();
    vec![made]
}

fn has_node() -> bool {
    let mut command = Command::new("node");
    let status = command.arg("--version").stdout(Stdio::null()).status();
    status.is_ok_and(|status| status.success())
}

/// A robot and a program that drives it; None where the language or mounting is missing, which has been said by name.
fn start(task: &str, language: &str, options: &[&str]) -> Option<(Robot, Program)> {
    let home = Arc::new(Home::new()?);
    let words = words(&home, task, language);
    if language == "javascript" && !has_node() {
        skip("there is no node");
        return None;
    }
    let robot = Robot::start(home, options);
    // A terminal's Ctrl-C has an effect even if these tests run where it has none.
    let mut command = Command::new("env");
    command.arg("--default-signal=INT").args(words);
    let child = command.arg(&robot.root).spawn().expect("a program");
    Some((robot, Program(child)))
}

/// Waits until the robot stands, and sees that nothing drives it.
fn rests(robot: &Robot) -> Pose {
    eventually("motors at rest", || {
        [3, 4].map(|motor| robot.duty(motor).ok()) == [Some(0), Some(0)]
    });
    let mut last = robot.pose();
    eventually("a standstill", || {
        std::thread::sleep(Duration::from_millis(50));
        let now = robot.pose();
        let stands = now.time_s == last.time_s;
        last = now;
        stands
    });
    last
}

/// Runs a program until a try satisfies.
fn judge(
    task: &str,
    language: &str,
    robot: &str,
    satisfies: fn(&Robot, &mut Program) -> Result<(), String>,
) {
    let mut complaints = Vec::new();
    for speed in SPEEDS {
        let options = ["--robot", robot, "--speed", speed];
        let Some((robot, mut program)) = start(task, language, &options) else {
            return;
        };
        match satisfies(&robot, &mut program) {
            Ok(()) => return,
            Err(why) => complaints.push(format!("at speed {speed}: {why}")),
        }
    }
    panic!("{}", complaints.join("\n"));
}

/// The box ahead begins at x = 1.3 m, and the robot's front is 11 cm before its middle.
fn stops_before_the_wall(robot: &Robot, program: &mut Program) -> Result<(), String> {
    program.watch(robot, |_| Ok(false))?;
    program.has_succeeded()?;
    let end = rests(robot);
    let gap_cm = (1.3 - 0.11 - end.x_m) * 100.0;
    require((18.5..22.5).contains(&gap_cm), || {
        format!("{gap_cm} cm before the wall: {end:?}")
    })?;
    require(end.bumps == 0.0, || format!("it touched: {end:?}"))
}

/// How far a place is from the middle of the line: a rectangle with round corners of 30 cm.
fn beside_the_line_m(pose: Pose) -> f64 {
    let (from_x, from_y) = ((pose.x_m - 1.5).abs() - 0.7, (pose.y_m - 1.0).abs() - 0.3);
    let outside = from_x.max(0.0).hypot(from_y.max(0.0));
    (outside + from_x.max(from_y).min(0.0) - 0.3).abs()
}

/// From the lower straight over two corners to beyond the crossing on the upper one, and then Ctrl-C.
fn stays_on_the_line(robot: &Robot, program: &mut Program) -> Result<(), String> {
    let mut was_right = false;
    let is_there = program.watch(robot, |pose| {
        require(beside_the_line_m(pose) < 0.05, || {
            format!("beside the line: {pose:?}")
        })?;
        was_right |= pose.x_m > 2.4;
        Ok(was_right && pose.x_m < 1.2)
    })?;
    require(is_there, || "it ended by itself".to_owned())?;
    let pose = robot.pose();
    require(pose.y_m > 1.5 && pose.bumps == 0.0, || format!("{pose:?}"))?;
    processes::signal(program.0.id(), Signal::SIGINT);
    eventually("the end of the program", || program.has_ended().is_some());
    let status = program.has_ended().expect("an end");
    let by_signal = status.signal() == Some(Signal::SIGINT as i32);
    assert!(by_signal || status.code() == Some(130), "{status}");
    rests(robot);
    Ok(())
}

/// From (0.8, 1.0) to the right, up, to the left and down again.
fn comes_back_over_four_corners(robot: &Robot, program: &mut Program) -> Result<(), String> {
    let begin = Pose {
        x_m: 0.8,
        y_m: 1.0,
        ..Pose::default()
    };
    let corner = |x: f64, y: f64| Pose {
        x_m: begin.x_m + x,
        y_m: begin.y_m + y,
        ..begin
    };
    let corners = [corner(0.3, 0.0), corner(0.3, 0.3), corner(0.0, 0.3), begin];
    let mut seen = 0;
    program.watch(robot, |pose| {
        let next = corners.get(seen);
        if next.is_some_and(|corner| pose.away_from(corner) < 0.04) {
            seen += 1;
        }
        Ok(false)
    })?;
    program.has_succeeded()?;
    let end = rests(robot);
    require(seen == corners.len(), || {
        format!("{seen} corners in their order: {end:?}")
    })?;
    require(end.away_from(&begin) < 0.04, || {
        format!("not back: {end:?}")
    })?;
    require((end.heading_deg - 360.0).abs() < 6.0, || {
        format!("not as in the beginning: {end:?}")
    })?;
    require(end.bumps == 0.0, || format!("it touched: {end:?}"))
}

#[test]
fn every_task_is_there_in_every_language_and_nothing_else_is() {
    let mut expected: Vec<PathBuf> = Vec::new();
    for (language, _) in LANGUAGES {
        expected.extend(TASKS.map(|task| source(task, language)));
    }
    let mut found: Vec<PathBuf> = Vec::new();
    let folders = std::fs::read_dir(EXAMPLES).expect("examples").flatten();
    // Programs of blocks have worlds of their own, and `diagrams::behaviours` knows them all.
    let of_blocks = ["dataflow", "diagrams"];
    let is_text =
        |folder: &std::fs::DirEntry| !of_blocks.iter().any(|name| folder.file_name() == *name);
    for folder in folders.filter(is_text) {
        let files = std::fs::read_dir(folder.path()).expect("a folder");
        found.extend(files.flatten().map(|file| file.path()));
    }
    expected.sort();
    found.sort();
    assert_eq!(found, expected);
}

/// A test for each language, so that they run beside each other.
macro_rules! tests {
    ($($language:ident)*) => { $(
        mod $language {
            const LANGUAGE: &str = stringify!($language);

            #[test]
            fn goes_to_the_wall() {
                super::judge("wall", LANGUAGE, "two-wheels", super::stops_before_the_wall);
            }

            #[test]
            fn follows_the_line() {
                super::judge("line", LANGUAGE, "line-follower", super::stays_on_the_line);
            }

            #[test]
            fn drives_a_square() {
                let satisfies = super::comes_back_over_four_corners;
                super::judge("square", LANGUAGE, "two-wheels", satisfies);
            }
        }
    )* };
}

tests! { shell python c javascript rust }
