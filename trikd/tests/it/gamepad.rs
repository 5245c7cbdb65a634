//! Gamepads of both kinds: their lines come out of the pipe that the tree reads.

use crate::rig::{Client, Robot, robot};
use nix::sys::socket::{setsockopt, sockopt::Linger};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::time::{Duration, Instant};

/// The reader's end, opened for both so that it never ends.
fn pipe(robot: &Robot) -> BufReader<File> {
    let file = File::options()
        .read(true)
        .write(true)
        .open(robot.home.path("gamepad.fifo"));
    BufReader::new(file.expect("the pipe that trikd has made"))
}

fn line(pipe: &mut BufReader<File>) -> String {
    let mut line = String::new();
    pipe.read_line(&mut line).expect("a line");
    line
}

fn gamepad(robot: &Robot) -> Client {
    robot.client("gamepad")
}

#[test]
fn both_applications_drive_and_what_they_hold_is_released() {
    let robot = robot(&[]);
    let mut pipe = pipe(&robot);
    let (mut desktop, mut telephone) = (gamepad(&robot), gamepad(&robot));
    desktop.raw("keepalive 4000\npad 1 0 100 \n");
    assert_eq!(line(&mut pipe), "pad 1 0 100\n");
    telephone.raw("wheel 50\npa");
    assert_eq!(line(&mut pipe), "wheel 50\n");
    let pressed = Instant::now();
    telephone.raw("d 2 -7 8\nnonsense\nwheel\npad 9 9 9\nbtn 3 down\n");
    assert_eq!(line(&mut pipe), "pad 2 -7 8\n");
    assert_eq!(line(&mut pipe), "btn 3 down\n");
    assert_eq!(line(&mut pipe), "btn 3 up\n");
    assert!(pressed.elapsed() > Duration::from_millis(450));
    // A telephone says goodbye with a reset, and lets go of its pad only.
    setsockopt(
        &telephone.stream,
        Linger,
        &nix::libc::linger {
            l_onoff: 1,
            l_linger: 0,
        },
    )
    .unwrap();
    drop(telephone);
    assert_eq!(line(&mut pipe), "pad 2 up\n");
    desktop.raw("btn 1\n");
    assert_eq!(line(&mut pipe), "btn 1 down\n");
    drop(desktop);
    let mut last = [line(&mut pipe), line(&mut pipe)];
    last.sort();
    assert_eq!(last, ["btn 1 up\n", "pad 1 up\n"]);
}

#[test]
fn a_gamepad_that_falls_silent_lets_go_and_every_line_winds_its_clock() {
    let robot = robot(&[]);
    let mut pipe = pipe(&robot);
    let mut desktop = gamepad(&robot);
    desktop.raw("keepalive 3000\npad 1 5 5\n");
    assert_eq!(line(&mut pipe), "pad 1 5 5\n");
    // Together longer than the clock, each far shorter, so that a machine under load does not change what is seen.
    for step in 0..12 {
        std::thread::sleep(Duration::from_millis(300));
        desktop.raw(format!("wheel {step}\n"));
        assert_eq!(line(&mut pipe), format!("wheel {step}\n"));
    }
    assert_eq!(line(&mut pipe), "pad 1 up\n");
    desktop.raw("wheel 1\n");
    assert_eq!(line(&mut pipe), "wheel 1\n");
    assert!(
        robot.status().contains(" gamepad for "),
        "{}",
        robot.status()
    );
}

#[test]
fn a_flood_of_nonsense_harms_nobody() {
    let robot = robot(&[]);
    let mut pipe = pipe(&robot);
    let mut hostile = gamepad(&robot);
    hostile.raw(vec![b'x'; 1 << 20]);
    hostile.raw(b"\n\xff\xff\n\0\npad\n");
    let mut desktop = gamepad(&robot);
    desktop.raw("wheel 3\n");
    assert_eq!(line(&mut pipe), "wheel 3\n");
    robot.client("control").sync();
}
