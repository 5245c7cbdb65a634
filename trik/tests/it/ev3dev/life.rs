//! The life of the view: its processes, its mount, and a tree that goes, comes back and is another's.

use super::{LEFT, RIGHT, View, errno, seen};
use crate::rig::{Home, Robot, TRIK, robot};
use harness::{board, eventually, processes};
use nix::sys::signal::Signal;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Seek};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is noticed within a second has this much on a machine that is busy.
const NOTICED: Duration = Duration::from_secs(60);

/// The processes of the view of a robot: the one that keeps the mount, and the one that serves it.
fn view_processes(robot: &Robot) -> (u32, u32) {
    let is_keeper = |pid: &u32| {
        fs::read_to_string(format!("/proc/{pid}/comm"))
            .is_ok_and(|name| name.trim() == "trikfs-ev3dev")
    };
    let mut found = (0, 0);
    eventually("the view's processes", || {
        let keeper = processes::children(robot.pid()).into_iter().find(is_keeper);
        found.0 = keeper.unwrap_or(0);
        let server = keeper.and_then(|keeper| processes::children(keeper).first().copied());
        found.1 = server.unwrap_or(0);
        server.is_some()
    });
    found
}

#[test]
fn after_a_kill_of_either_process_motors_rest_and_the_view_comes_back() {
    let Some((robot, view)) = seen() else { return };
    for round in 0..2 {
        view.run(LEFT, &[("speed_sp", 400)], "run-forever");
        view.run("servo-motor/motor0", &[("position_sp", 20)], "run");
        view.run(RIGHT, &[("duty_cycle_sp", 30)], "run-direct");
        assert_ne!((robot.duty(3).unwrap(), robot.duty(4).unwrap()), (0, 0));
        let (keeper, server) = view_processes(&robot);
        processes::signal(if round == 0 { server } else { keeper }, Signal::SIGKILL);
        eventually("rest", || {
            (robot.duty(3).unwrap(), robot.duty(4).unwrap()) == (0, 0)
        });
        eventually("a servo without power", || {
            robot.number("servos/S1/power") == 0.0
        });
        eventually("both processes gone", || {
            !processes::is_alive(keeper) && !processes::is_alive(server)
        });
        eventually("the view again", || {
            view.read(&format!("{LEFT}/state")).is_ok()
        });
        assert_eq!(view.state(LEFT), "");
    }
    robot.complains("the view of ev3dev has ended; started again");
}

#[test]
fn a_serving_process_that_is_stopped_lets_its_motors_rest_and_the_view_comes_back() {
    let Some((robot, view)) = seen() else { return };
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    eventually("power", || robot.duty(3).unwrap() != 0);
    let (keeper, server) = view_processes(&robot);
    let begin = Instant::now();
    processes::signal(server, Signal::SIGSTOP);
    eventually("rest", || robot.duty(3).unwrap() == 0);
    let rested = begin.elapsed();
    println!("rest {rested:?} after the serving process was stopped");
    // Within a second where nothing else computes; never, if it is not noticed.
    assert!(rested < NOTICED, "{rested:?}");
    eventually("both processes gone", || {
        !processes::is_alive(keeper) && !processes::is_alive(server)
    });
    eventually("the view again", || {
        view.read(&format!("{LEFT}/state")).is_ok()
    });
    robot.complains("trikfs-ev3dev: the serving process was stopped and did not go on");
}

#[test]
fn while_the_keeper_is_stopped_motors_rest_and_it_is_told_to_go_on() {
    let Some((robot, view)) = seen() else { return };
    let both = view_processes(&robot);
    let (keeper, server) = both;
    for _ in 0..2 {
        view.run(LEFT, &[("speed_sp", 400)], "run-forever");
        view.run(RIGHT, &[("duty_cycle_sp", 30)], "run-direct");
        view.run("servo-motor/motor0", &[("position_sp", 20)], "run");
        eventually("power", || {
            robot.duty(3).unwrap() != 0 && robot.duty(4).unwrap() != 0
        });
        let begin = Instant::now();
        processes::signal(keeper, Signal::SIGSTOP);
        eventually("rest", || {
            (robot.duty(3).unwrap(), robot.duty(4).unwrap()) == (0, 0)
        });
        let rested = begin.elapsed();
        println!("rest {rested:?} after the keeper was stopped");
        // Within a second where nothing else computes; never, if it is not noticed.
        assert!(rested < NOTICED, "{rested:?}");
        eventually("a servo without power", || {
            robot.number("servos/S1/power") == 0.0
        });
        eventually("the keeper", || !processes::is_stopped(keeper));
        assert_eq!(view.state(LEFT), "");
        let why = view.text(&format!("{LEFT}/fault"));
        assert!(why.ends_with(&format!("({keeper}) was stopped")), "{why}");
    }
    assert_eq!(view_processes(&robot), both);
    robot.complains("was stopped: motors were brought to rest, and it was told to go on");
    // It keeps the mount as before.
    processes::signal(server, Signal::SIGKILL);
    eventually("the view again", || {
        view_processes(&robot) != both && view.read(&format!("{LEFT}/state")).is_ok()
    });
}

#[test]
fn an_unmount_of_the_view_brings_its_motors_to_rest() {
    let Some(robot) = robot(&[]) else { return };
    let mut alone = Alone::start(&robot.home, &robot.root, &[]);
    alone.view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    eventually("power", || robot.duty(3).unwrap() != 0);
    let done = Command::new("umount").arg(&alone.view.0).status();
    assert!(done.expect("umount").success());
    eventually("the end", || {
        alone.process.try_wait().expect("a child").is_some()
    });
    eventually("rest", || robot.duty(3).unwrap() == 0);
}

#[test]
fn the_end_of_the_robot_ends_the_view_with_motors_that_run() {
    let Some((mut robot, view)) = seen() else {
        return;
    };
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    let held = File::open(view.0.join(LEFT).join("state")).unwrap();
    let (keeper, server) = view_processes(&robot);
    assert_eq!(
        robot.end(Signal::SIGTERM).code(),
        Some(0),
        "{}",
        robot.complaints()
    );
    assert!(!processes::is_alive(keeper) && !processes::is_alive(server));
    assert!(
        !robot.complaints().contains("detached"),
        "{}",
        robot.complaints()
    );
    assert!((&held).read(&mut [0; 8]).is_err());
    drop(held);
    assert!(board::mounts_below(&view.0).is_empty() && !view.0.exists());
    robot.leaves_nothing();
}

#[test]
fn a_kill_of_trik_ends_the_view_and_the_next_robot_removes_what_is_left() {
    let Some((mut robot, view)) = seen() else {
        return;
    };
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    let (keeper, server) = view_processes(&robot);
    robot.end(Signal::SIGKILL);
    eventually("the end of the view", || {
        !processes::is_alive(keeper) && !processes::is_alive(server)
    });
    assert!(board::mounts_below(&view.0).is_empty());
    eventually("the end of the tree", || {
        board::mounts_below(&robot.root).is_empty()
    });
    drop(Robot::start(Arc::clone(&robot.home), &[]));
    assert!(!view.0.exists());
}

/// A view that was started by itself.
struct Alone {
    process: Child,
    view: View,
}

impl Alone {
    fn start(home: &Home, tree: &Path, words: &[&str]) -> Self {
        let at = home.0.path("view");
        let mut tree_word = std::ffi::OsString::from("--tree=");
        tree_word.push(tree);
        let process = Command::new(TRIK)
            .arg0("trikfs-ev3dev")
            .arg(tree_word)
            .args(words)
            .arg(&at)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("a view");
        eventually("the view", || at.join("tacho-motor").is_dir());
        Self {
            process,
            view: View(at),
        }
    }
}

impl Drop for Alone {
    fn drop(&mut self) {
        if let Ok(None) = self.process.try_wait() {
            processes::signal(self.process.id(), Signal::SIGTERM);
        }
        let status = self.process.wait();
        if !std::thread::panicking() {
            assert!(status.is_ok_and(|status| status.success()));
            assert!(board::mounts_below(&self.view.0).is_empty());
            assert!(!self.view.0.exists(), "it has made the directory");
        }
    }
}

#[test]
fn a_tree_that_goes_and_comes_back_is_seen_through_the_same_open_files() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let tree = home.0.path("tree");
    let mut alone = Alone::start(&home, &tree, &[]);
    let mut warning = String::new();
    let stderr = alone.process.stderr.take().expect("a pipe");
    BufReader::new(stderr).read_line(&mut warning).unwrap();
    let expected = format!(
        "trikfs-ev3dev: {}: no tree is mounted there; the view is empty until there is one (--tree=DIR says another place)\n",
        tree.display()
    );
    assert_eq!(warning, expected);
    let view = &alone.view;
    assert_eq!(fs::read_dir(view.0.join("tacho-motor")).unwrap().count(), 0);
    let words = ["tree"];
    let mut robot = Robot::start(Arc::clone(&home), &words);
    eventually("devices", || view.read(&format!("{LEFT}/position")).is_ok());
    let mut file = File::open(view.0.join(LEFT).join("position")).unwrap();
    let mut position = || -> i32 {
        let mut text = String::new();
        errno(
            file.rewind()
                .and_then(|()| file.read_to_string(&mut text).map(drop)),
        )
    };
    assert_eq!(position(), 0);
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    assert_eq!(
        robot.end(Signal::SIGTERM).code(),
        Some(0),
        "{}",
        robot.complaints()
    );
    eventually("a motor that is gone", || view.state(LEFT).is_empty());
    assert_eq!(position(), libc::ENODEV);
    assert_eq!(
        view.errno_of_read("lego-sensor/sensor6/value0"),
        libc::ENODEV
    );
    assert_eq!(
        view.errno_of_write(&format!("{LEFT}/command"), "run-forever"),
        libc::ENODEV
    );
    assert!(
        view.text(&format!("{LEFT}/fault"))
            .contains("motors/M3/value")
    );
    assert_eq!(
        view.errno_of_write("leds/led0:red:brick-status/brightness", "1"),
        libc::ENODEV
    );
    let robot = Robot::start(Arc::clone(&home), &words);
    assert_eq!(position(), 0);
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    eventually("movement", || robot.turned_deg(3) > 90.0);
    assert_eq!(view.text(&format!("{LEFT}/fault")), "");
    drop(robot);
}

#[test]
fn a_motor_without_encoder_is_a_dc_motor_and_a_leased_one_is_busy() {
    let Some(robot) = robot(&[]) else { return };
    let alone = Alone::start(&robot.home, &robot.root, &["--encoder", "M3=none"]);
    let view = &alone.view;
    let motor = "dc-motor/motor0";
    assert_eq!(view.text(&format!("{motor}/address")), "ev3-ports:outC:M3");
    assert_eq!(view.text("tacho-motor/motor2/address"), "ev3-ports:outD:M4");
    view.run(motor, &[("duty_cycle_sp", 55)], "run-forever");
    assert!((50.0..=55.0).contains(&robot.number("motors/M3/value")));
    view.write(&format!("{motor}/stop_action"), "brake");
    view.run(
        motor,
        &[("time_sp", 200), ("duty_cycle_sp", -30)],
        "run-timed",
    );
    view.until_done(motor);
    // The board has the brake a moment after the view says that the run has ended.
    eventually("the brake", || robot.duty(3).unwrap() == 127);
    // The view is a child of this process, which would share its lease with it.
    let script = "exec 3> \"$1\"; echo held; exec sleep 1000";
    let mut holder = Command::new("setsid")
        .args(["--fork", "sh", "-c", &format!("echo $$; {script}"), "sh"])
        .arg(robot.path("motors/M3/owner"))
        .stdout(Stdio::piped())
        .spawn()
        .expect("a holder");
    let mut lines = BufReader::new(holder.stdout.take().expect("a pipe")).lines();
    let pid = lines.next().expect("a line").expect("a number");
    assert_eq!(lines.next().expect("a line").expect("text"), "held");
    holder.wait().expect("setsid");
    let busy = view.errno_of_write(&format!("{motor}/command"), "run-forever");
    processes::signal(pid.parse().expect("a number"), Signal::SIGKILL);
    assert_eq!(busy, libc::EBUSY);
    assert_eq!(view.state(motor), "");
    // The rest at the end of the lease comes a moment after it.
    eventually("a free motor", || {
        view.try_write(&format!("{motor}/command"), "run-forever")
            .is_ok()
    });
    view.write(&format!("{motor}/stop_action"), "coast");
    view.write(&format!("{motor}/command"), "stop");
}

#[test]
fn a_command_is_no_mount_point() {
    let Some(home) = Home::new() else { return };
    let run = |words: &[&str]| {
        let mut command = Command::new(TRIK);
        command.arg0("trikfs-ev3dev").current_dir(home.0.dir());
        harness::tools::run(command.args(words), b"")
    };
    assert!(run(&["man"]).good().contains("trikfs\\-ev3dev"));
    assert!(run(&["completions", "bash"]).good().contains("--encoder"));
    let refusal = run(&["--tree=tree", "man"]);
    assert_eq!(refusal.code(), 2);
    assert!(refusal.stderr.contains("is ./man"), "{}", refusal.stderr);
    assert!(!home.0.path("man").exists());
}

#[test]
fn the_view_of_a_tree_elsewhere_is_beside_that_tree() {
    let Some(home) = Home::new() else { return };
    let home = Arc::new(home);
    let robot = Robot::start(Arc::clone(&home), &["--ev3dev", "mine"]);
    let view = home.0.path("mine.ev3dev");
    assert!(view.join("tacho-motor/motor0").exists());
    assert!(robot.said().contains(&format!("ls {}/", view.display())));
    drop(robot);
    assert!(!view.exists());
}

#[test]
fn a_directory_that_cannot_be_used_ends_the_robot_with_a_reason() {
    let Some(home) = Home::new() else { return };
    fs::create_dir_all(home.0.path("full/x")).unwrap();
    let refusal = home.run(&["up", "--ev3dev=full"]);
    assert_eq!(refusal.code(), 1);
    assert!(
        refusal.stderr.contains("full is not empty"),
        "{}",
        refusal.stderr
    );
    assert!(!home.base().exists());
}
