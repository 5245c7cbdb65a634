use super::*;
use lang::diagram::machine::{STEP_MS, Status};
use lang::diagram::ports::Port;
use lang::diagram::stand_in::{Placing, StandIn};
use std::path::PathBuf;

/// Runs a program for at most so long; its log, its status and the first error.
fn run(text: &str, ms: u32, robot: &mut StandIn) -> (Status, String) {
    let mut program = JavaScript::new("p.js", text.to_owned(), PathBuf::from("/nowhere")).unwrap();
    let mut now = 0;
    let mut status = program.step(now, robot);
    while status == Status::Running && now < ms {
        now += STEP_MS;
        robot.tick();
        status = program.step(now, robot);
    }
    program.stop(robot);
    let errors: Vec<_> = program.errors().iter().map(ToString::to_string).collect();
    (status, errors.join("\n"))
}

fn robot() -> StandIn {
    let mut robot = StandIn::new(Placing::default());
    robot.readings.insert(Port::named("A1").unwrap(), 45);
    robot
}

fn log(text: &str) -> Vec<String> {
    let mut robot = robot();
    let (status, error) = run(text, 10_000, &mut robot);
    assert!(matches!(status, Status::Ended { .. }), "{text}: {status:?}");
    assert_eq!(error, "", "{text}");
    robot
        .log
        .iter()
        .map(|(ms, line)| format!("{ms} {line}"))
        .collect()
}

#[test]
fn a_wait_lets_the_world_move() {
    let told = log(
        "brick.motor(M3).setPower(50); script.wait(25); print(script.time() % 1000, ' ', brick.sensor(A1).read()); \
        brick.motor(M3).powerOff(); script.wait(0); print(brick.encoder(E3).read() > 0)",
    );
    assert_eq!(
        told,
        [
            "0 power M3 50",
            "30 print \"30 45\"",
            "30 power M3 0",
            "30 print \"true\"",
            "30 rest"
        ]
    );
}
