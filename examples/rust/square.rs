//! Drives a square of 30 cm by its encoders: rustc square.rs && ./square [TREE]

use std::fs::{self, File};
use std::io::{self, Write};
use std::thread::sleep;
use std::time::Duration;

/// Degrees of a wheel of 56 mm for 300 mm ahead, and for a quarter of a turn with wheels 155 mm apart.
const SIDE: i32 = 614;
const CORNER: i32 = 249;

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

    fn read_wheels(&self) -> io::Result<[i32; 2]> {
        Ok([
            self.read_number("encoders/left/value")?,
            self.read_number("encoders/right/value")?,
        ])
    }

    /// Turns the wheels by so many degrees. Goals grow from leg to leg, so small errors do not add up.
    fn turn_wheels(
        &mut self,
        goals: &mut [i32; 2],
        left_degrees: i32,
        right_degrees: i32,
    ) -> io::Result<()> {
        goals[0] += left_degrees;
        goals[1] += right_degrees;
        loop {
            let [left, right] = self.read_wheels()?;
            let powers = [power_for(goals[0] - left), power_for(goals[1] - right)];
            self.drive(powers[0], powers[1])?;
            if powers == [0, 0] {
                return Ok(());
            }
            sleep(Duration::from_millis(20));
        }
    }
}

/// The power that brings a wheel nearer to its goal.
fn power_for(missing: i32) -> i32 {
    (missing / 5).clamp(-30, 30)
}

fn drive_square(robot: &mut Robot) -> io::Result<()> {
    let mut goals = robot.read_wheels()?;
    for _ in 0..4 {
        robot.turn_wheels(&mut goals, SIDE, SIDE)?;
        robot.turn_wheels(&mut goals, -CORNER, CORNER)?;
    }
    Ok(())
}

fn main() -> io::Result<()> {
    let mut robot = Robot::open()?;
    let outcome = drive_square(&mut robot);
    // The end of main closes the motors, and a motor that is closed goes on as it was.
    robot.drive(0, 0)?;
    outcome
}
