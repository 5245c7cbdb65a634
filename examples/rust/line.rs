//! Follows a dark line on a bright floor until Ctrl-C: rustc line.rs && ./line [TREE]

use std::fs::{self, File};
use std::io::{self, Write};
use std::thread::sleep;
use std::time::Duration;

struct Robot {
    tree: String,
    left_motor: File,
    right_motor: File,
}

impl Robot {
    /// Motors that stay open until the program ends come to rest then, also after Ctrl-C.
    fn open() -> io::Result<Self> {
        let tree = std::env::args().nth(1).or(std::env::var("TRIK_TREE").ok());
        let tree = tree.unwrap_or("/trikfs".to_owned());
        let motor = |name: &str| {
            File::options()
                .write(true)
                .open(format!("{tree}/motors/{name}/value"))
        };
        Ok(Self {
            left_motor: motor("left")?,
            right_motor: motor("right")?,
            tree,
        })
    }

    fn drive(&mut self, left: i32, right: i32) -> io::Result<()> {
        self.left_motor.write_all(left.to_string().as_bytes())?;
        self.right_motor.write_all(right.to_string().as_bytes())
    }

    fn read_number(&self, name: &str) -> io::Result<i32> {
        let text = fs::read_to_string(format!("{}/{name}", self.tree))?;
        text.trim().parse().map_err(io::Error::other)
    }
}

fn follow_line(robot: &mut Robot) -> io::Result<()> {
    loop {
        // The sensors look at the floor beside the line; the one that sees the line has the larger number.
        let left = robot.read_number("sensors/floor_left/value")?;
        let right = robot.read_number("sensors/floor_right/value")?;
        let turn = (left - right) / 4;
        robot.drive(20 - turn, 20 + turn)?;
        sleep(Duration::from_millis(20));
    }
}

fn main() -> io::Result<()> {
    let mut robot = Robot::open()?;
    let outcome = follow_line(&mut robot);
    // The end of main closes the motors, and a motor that is closed goes on as it was.
    robot.drive(0, 0)?;
    outcome
}
