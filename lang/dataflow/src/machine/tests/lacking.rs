//! Sensors that the robot does not have.

use super::*;

#[test]
fn a_missing_sensor_that_is_asked_later_is_told_before_anything_moves() {
    let text = "
        G Motors {M3Power=40}
        W Wait and send {time=100}
        A Sensor {VarName=sensorA1}
        B Sensor {VarName=sensorD1}
        S Say
        G.CF_OUT > W.CF_IN
        W.CF_OUT > A.CF_IN
        W.CF_OUT > B.CF_IN
        A.OUT > S.DATA
        B.OUT > S.DATA";
    let main = diagram("main", DiagramKind::Main, text);
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    robot.readings.insert("D1", vec![5]);
    machine.step(0, &mut robot, &mut Deaf);
    let told: Vec<String> = machine.warnings().iter().map(ToString::to_string).collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].contains("main: Sensor 'A': the robot has no such device"),
        "{told:?}"
    );
    assert_eq!(machine.status(), Status::Running);
    for now in (10..=100).step_by(10) {
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert_eq!(machine.errors().len(), 1);
    // One that has come meanwhile is a sensor like any other.
    let main = diagram("main", DiagramKind::Main, text);
    let (mut machine, mut robot) = (super::machine(&project(vec![main])), Script::default());
    machine.step(0, &mut robot, &mut Deaf);
    assert_eq!(machine.warnings().len(), 2);
    robot.readings.insert("A1", vec![4]);
    robot.readings.insert("D1", vec![5]);
    for now in (10..=140).step_by(10) {
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert_eq!(machine.status(), Status::Running);
    assert_eq!(robot.commands.last().map(String::as_str), Some("say \"5\""));
}

#[test]
fn a_missing_sensor_in_an_expression_is_told_before_anything_moves() {
    let text = "
        G Motors {M3Power=40}
        W Wait and send {time=100}
        F Text programming {IO0=sensorA1 + sensorD1}
        H Text programming {IO0=2 * sensorA1 + lineSensor[0]}
        M Motors
        G.CF_OUT > W.CF_IN
        W.CF_OUT > F.I0
        W.CF_OUT > H.I0
        F.O0 > M.M3";
    let main = diagram("main", DiagramKind::Main, text);
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    robot.readings.insert("D1", vec![5]);
    machine.step(0, &mut robot, &mut Deaf);
    let told: Vec<String> = machine.warnings().iter().map(ToString::to_string).collect();
    assert_eq!(
        told,
        [
            "main: Text programming 'F': 'IO0': the robot has no such device, or it says nothing: sensorA1; when this text is computed, the program ends with an error"
        ]
    );
    assert_eq!(machine.status(), Status::Running);
    for now in (10..=100).step_by(10) {
        machine.step(now, &mut robot, &mut Deaf);
    }
    assert_eq!(machine.errors().len(), 1);
}

#[test]
fn the_camera_is_not_asked_before_a_block_asks_it() {
    for sensor in [
        "lineSensor",
        "colorSensor",
        "colorSensorR",
        "colorSensorG",
        "colorSensorB",
        "objectSensorX",
        "objectSensorY",
        "objectSensorSize",
    ] {
        let text = format!(
            "W Wait and send {{time=100}}\nA Sensor {{VarName={sensor}}}\nS Say\nW.CF_OUT > A.CF_IN\nA.OUT > S.DATA"
        );
        let main = diagram("main", DiagramKind::Main, &text);
        let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
        for now in (0..100).step_by(10) {
            machine.step(now, &mut robot, &mut Deaf);
        }
        assert_eq!(machine.warnings(), [], "{sensor}");
        assert!(robot.asked.is_empty(), "{sensor}: {:?}", robot.asked);
        machine.step(100, &mut robot, &mut Deaf);
        assert_eq!(robot.asked.len(), 1, "{sensor}: {:?}", robot.asked);
        assert_eq!(machine.errors().len(), 1, "{sensor}");
    }
}

#[test]
fn many_sensors_that_begin_at_once_are_told_by_the_first_one() {
    let mut main = diagram("main", DiagramKind::Main, "A Sensor");
    main.blocks = (0..200_000)
        .map(|at| {
            let mut block = main.blocks[0].clone();
            // Texts of all blocks have a limit of their own.
            block.id = format!("{at}");
            block
        })
        .collect();
    let (mut machine, mut robot) = (machine(&project(vec![main])), Script::default());
    machine.step(0, &mut robot, &mut Deaf);
    assert_eq!(machine.warnings(), []);
    assert_eq!(machine.errors().len(), 1);
}
