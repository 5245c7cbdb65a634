//! `trik dcml drive` on whole virtual robots: a planned path is driven to its end, and motors are stopped whatever happens.

use crate::rig::{Home, Robot, robot};
use harness::{eventually, processes};
use nix::sys::signal::Signal;
use std::process::Stdio;
use std::sync::Arc;

const DRIVE: [&str; 6] = [
    "differential-drive",
    "path.csv",
    "--params",
    "L=0.155,r=0.028",
    "--drive",
    "u_l=M3,u_r=M4",
];

/// A path of the robot from where it begins, over free floor.
fn planned(robot: &Robot) -> [f64; 2] {
    let words = "dcml plan differential-drive --params L=0.155,r=0.028 --actions u_l=-3..9,u_r=-3..9 --start x=0.8,y=1 \
        --goal x=1.2,y=1.25 --goal-radius 0.05 --bounds x=0.5..1.5,y=0.7..1.5 --planner sst --iterations 3000 -o path.csv";
    let words: Vec<&str> = words.split_whitespace().collect();
    robot.home.run(&words).good();
    let table = std::fs::read_to_string(robot.home.0.path("path.csv")).expect("a path");
    let last = table.lines().last().expect("an end");
    let numbers: Vec<f64> = last
        .split(',')
        .map(|one| one.parse().expect("a number"))
        .collect();
    [numbers[3], numbers[4]]
}

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let mut all = vec!["dcml", "drive"];
    all.extend(DRIVE);
    all.extend(more);
    all
}

fn stands(robot: &Robot) {
    assert_eq!(robot.number("motors/M3/value"), 0.0);
    assert_eq!(robot.number("motors/M4/value"), 0.0);
}

#[test]
fn a_planned_path_is_driven_to_its_end() {
    let Some(robot) = robot(&[]) else { return };
    let [x, y] = planned(&robot);
    let said = robot.home.run(&words(&[])).good();
    assert!(
        said.starts_with("Driven in ") && said.contains("By its encoders it is at x = "),
        "{said}"
    );
    stands(&robot);
    let truth = robot.pose();
    let away = (truth.x_m - x).hypot(truth.y_m - y);
    assert!(
        away < 0.03,
        "{away} m from the end of the path: {truth:?}, {said}"
    );
    assert_eq!(truth.bumps, 0.0);
}

#[test]
fn a_car_of_a_model_is_driven_with_its_servo() {
    let Some(home) = Home::new() else { return };
    home.0
        .file("path.csv", "t,speed,steer\n0,0.1,0.3\n1,0.1,-0.3\n2,0,0\n");
    let drive = "speed=M3*0.03,steer=S1*0.5";
    let up = ["--robot", "bicycle", "--params", "L=0.2", "--drive", drive];
    let robot = Robot::start(Arc::new(home), &up);
    let begun = robot.pose();
    let all = [
        "dcml", "drive", "bicycle", "path.csv", "--params", "L=0.2", "--drive", drive,
    ];
    robot.home.run(&all).good();
    assert_eq!(robot.number("motors/M3/value"), 0.0);
    // Two arcs of 0.1 m on a circle of 0.2 / tan(0.3): to the left, and back into the old heading.
    let radius = 0.2 / 0.3_f64.tan();
    let turned = 0.1 / radius;
    let (x, y) = (
        2.0 * radius * turned.sin(),
        2.0 * radius * (1.0 - turned.cos()),
    );
    let truth = robot.pose();
    let away = (truth.x_m - begun.x_m - x).hypot(truth.y_m - begun.y_m - y);
    assert!(away < 0.03, "{away}: {begun:?} {truth:?}");
    assert_eq!(truth.bumps, 0.0);
}

#[test]
fn a_signal_and_a_lost_encoder_stop_the_motors() {
    let Some(robot) = robot(&[]) else { return };
    robot.home.0.file("path.csv", "t,u_l,u_r\n0,1,3\n60,0,0\n");
    for signal in [Some(Signal::SIGINT), Some(Signal::SIGTSTP), None] {
        let begun = robot.pose();
        let mut command = robot.home.command(&words(&[]));
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = command.spawn().expect("trik");
        eventually("a way", || robot.pose().away_from(&begun) > 0.02);
        match signal {
            Some(signal) => processes::signal(child.id(), signal),
            None => drop(robot.fault(&["E3", "unplug"])),
        }
        let output = child.wait_with_output().expect("its end");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert!(said.contains("the motors are stopped"), "{said}");
        stands(&robot);
    }
}

#[test]
fn what_no_motor_can_do_is_refused_before_anything_moves() {
    let Some(robot) = robot(&[]) else { return };
    let begun = robot.pose();
    for (table, more, why) in [
        (
            "t,u_l,u_r\n0,nan,1\n1,0,0\n",
            &[][..],
            "\"nan\" is no number",
        ),
        (
            "t,u_l,u_r\n0,1,1\n1,inf,1\n2,0,0\n",
            &[],
            "\"inf\" is no number",
        ),
        (
            "t,u_l,u_r\n0,1,1\n1,30,1\n2,0,0\n",
            &[],
            "at 1 s u_l on M3 would need 1719 degrees per second, and 1200",
        ),
        // The last line, too.
        (
            "t,u_l,u_r\n0,1,1\n1,30,0\n",
            &[],
            "at 1 s u_l on M3 would need 1719 degrees per second, and 1200",
        ),
        (
            "t,u_l,u_r\n0,1,1\n1e300,0,0\n",
            &[],
            "a drive takes 3600 s at most",
        ),
        ("t,u_l,u_r\n-1e308,1,1\n1e308,0,0\n", &[], "it takes inf s"),
        ("t,u_l\n0,1\n1,0\n", &[], "u_r"),
        ("t,u_l,u_r\n0,1,1\n", &[], "one line is no path"),
        ("", &[], "the table is empty"),
        (
            "t,u_l,u_r\n0,1,1\n1,0,0\n",
            &["--drive", "u_l=M1"],
            "--drive: u_l is there twice",
        ),
        (
            "t,u_l,u_r\n0,1,1\n1,0,0\n",
            &["--top-speed", "0"],
            "--top-speed: give a number above 0",
        ),
        (
            "t,u_l,u_r\n0,1,1\n1,0,0\n",
            &["--robot", "/nowhere"],
            "there is no such file",
        ),
    ] {
        robot.home.0.file("path.csv", table);
        let output = robot.home.run(&words(more));
        assert!(
            output.code() > 0 && output.stderr.contains(why),
            "{table}{more:?}: {}",
            output.stderr
        );
    }
    stands(&robot);
    assert!(robot.pose().away_from(&begun) < 1e-6);
}

#[test]
fn two_actions_on_one_motor_are_refused() {
    let Some(robot) = robot(&[]) else { return };
    robot.home.0.file("path.csv", "t,u_l,u_r\n0,1,1\n1,0,0\n");
    let same: Vec<&str> = words(&[])
        .into_iter()
        .map(|word| {
            word.strip_suffix("u_r=M4")
                .map_or(word, |_| "u_l=M3,u_r=M3")
        })
        .collect();
    let output = robot.home.run(&same);
    assert!(
        output.code() > 0 && output.stderr.contains("u_r on M3 would drive the same one"),
        "{same:?}: {}",
        output.stderr
    );
    stands(&robot);
}
