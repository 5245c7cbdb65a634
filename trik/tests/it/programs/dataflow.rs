//! Programs of data flow on robots: as text and as saves, and what they cannot do yet.

use super::Reachable;
use harness::eventually;
use lang_dataflow::{save, text};

/// Drives to 20 cm before the wall and stays there.
const NEAR: &str = "
diagram \"Near\"
  wall: Sensor(VarName = sensorD1)
  slow: \"Text programming\"(IO0 = `speed = max(0-50, min(50, 2 * (I0 - 20)))`, IO1 = `speed`)
  wheels: Motors
  wall.OUT -> slow.I0
  slow.O1 -> wheels.M3
  slow.O1 -> wheels.M4
";

/// A program as the save that the editor would make.
fn saved(source: &str) -> Vec<u8> {
    let project = text::read(source).expect("a program");
    save::save(&project).write().expect("a save")
}

#[test]
fn a_data_flow_program_drives_to_its_distance_and_rests_when_it_is_stopped() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    for (name, program) in [
        ("near.flow", NEAR.as_bytes().to_vec()),
        ("near.qrs", saved(NEAR)),
    ] {
        let running = reachable.spawn(name, program);
        eventually("a place before the wall", || {
            let distance = reachable.robot.number("sensors/D1/value");
            (distance - 20.0).abs() < 4.0
        });
        let watched = reachable
            .robot
            .home
            .run(&["status", "--robot", reachable.ip()]);
        assert!(watched.stdout.contains(name), "{}", watched.stdout);
        let stopped = reachable
            .robot
            .home
            .run(&["stop", "--robot", reachable.ip()]);
        assert_eq!(stopped.code(), 0, "{}", stopped.stderr);
        assert!(reachable.rests());
        drop(running);
        // Away from the wall again, for the second form; a rest that comes late would take one order away.
        eventually("some way back", || {
            reachable.robot.drive(-40, -40);
            reachable.robot.number("sensors/D1/value") > 45.0
        });
        reachable.robot.write("stop", "1").expect("a rest");
    }
}

#[test]
fn mistakes_of_a_data_flow_program_are_told_where_they_are_and_nothing_moves() {
    let Some(reachable) = Reachable::new() else {
        return;
    };
    let bad = reachable.run(
        "bad.flow",
        "diagram \"Bad\"\n  A: Sensor\n  M: Motors\n  A.OUT -> M.M7\n",
    );
    assert_eq!(bad.code(), 1);
    assert!(
        bad.stderr
            .contains("bad.flow: 4:14 'Motors' has no port 'M7'"),
        "{}",
        bad.stderr
    );
    // What only the run shows ends it: a division by nothing after a first round that drove.
    let source = "diagram \"Late\"\n  L: Loop(end_border = 1, time = 50)\n  F: \"Text programming\"(IO0 = `60 / (1 - I0)`)\n  M: Motors\n  L.OUT -> F.I0\n  F.O0 -> M.M3\n";
    let late = reachable.run("late.flow", source);
    assert_eq!(late.code(), 1, "{}", late.stdout);
    assert!(
        late.stderr
            .contains("Late: Text programming 'F': 'IO0', 1:1 Division by zero"),
        "{}",
        late.stderr
    );
    assert!(reachable.rests());
}
