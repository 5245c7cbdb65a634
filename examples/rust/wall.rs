//! Goes to the wall ahead and stops 20 cm before it: rustc wall.rs && ./wall [TREE]

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

fn go_to_wall(robot: &mut Robot) -> io::Result<()> {
    loop {
        match robot.read_number("sensors/front/value") {
            Ok(20) => return Ok(()),
            Ok(distance) => {
                let power = ((distance - 20) * 2).clamp(-30, 30);
                robot.drive(power, power)?;
            }
            // No echo: nobody knows how far the wall is.
            Err(_) => robot.drive(0, 0)?,
        }
        sleep(Duration::from_millis(20));
    }
}

fn main() -> io::Result<()> {
    let mut robot = Robot::open()?;
    let outcome = go_to_wall(&mut robot);
    // The end of main closes the motors, and a motor that is closed goes on as it was.
    robot.drive(0, 0)?;
    outcome
}
