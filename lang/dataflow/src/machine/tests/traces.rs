//! The worked traces of the language: subsumption, a controller, motor schemas.

use super::*;

fn main_only(text: &str) -> Project {
    project(vec![diagram("main", DiagramKind::Main, text)])
}

/// Readings of two sensors at each poll from 20 ms on.
fn with(project: &Project, ports: [&'static str; 2], rows: &[(i32, i32)]) -> Vec<String> {
    let mut robot = Script::default();
    let until = 20 * rows.len() as u32;
    let (lines, status) = run(project, until, &mut robot, |now, robot| {
        let at = (now / 20).saturating_sub(1) as usize;
        let (one, other) = rows[at.min(rows.len() - 1)];
        robot.readings.insert(ports[0], vec![one]);
        robot.readings.insert(ports[1], vec![other]);
    });
    assert_eq!(status, Status::Running, "{lines:#?}");
    lines
}

/// Only what motors are told.
fn commits(lines: &[String]) -> Vec<String> {
    lines
        .iter()
        .map(|line| {
            let parts = line.split("; ").filter(|part| part.contains("[power"));
            let parts: Vec<&str> = parts.collect();
            let time = line.split(':').next().unwrap_or_default();
            format!("{time}: {}", parts.join(" "))
        })
        .filter(|line| line.contains('['))
        .collect()
}

const WALL: &str = "
    A Sensor {VarName=sensorA1}
    D Sensor {VarName=sensorD1}
    F Text programming {IO0=u = max(0-30, min(30, 2*(I0-20))) | IO1=50 - u | IO2=50 + u}
    C If {condition=data < 25}
    E Text programming {IO0=60 | IO1=0 - 60}
    SL Flow replacer {time=100}
    SR Flow replacer {time=100}
    M Motors {synch=false}
    A.OUT > F.I0
    D.OUT > C.DATA
    C.TRUE > E.I0
    F.O1 > SL.DATA
    F.O2 > SR.DATA
    E.O0 > SL.REPLACE_DATA
    E.O1 > SR.REPLACE_DATA
    SL.OUT > M.M3
    SR.OUT > M.M4";

const WALL_READINGS: [(i32, i32); 10] = [
    (20, 80),
    (25, 80),
    (25, 60),
    (30, 22),
    (40, 30),
    (20, 80),
    (18, 80),
    (20, 80),
    (20, 80),
    (15, 80),
];

#[test]
fn a_wall_follower_of_two_layers() {
    let lines = with(&main_only(WALL), ["A1", "D1"], &WALL_READINGS);
    let expected = [
        "20: A 20; D 80; F.O1 50; F.O2 50; SL 50; SR 50; [power M3 50]; [power M4 50]",
        "40: A 25; D 80; F.O1 40; F.O2 60; SL 40; SR 60; [power M3 40]; [power M4 60]",
        "60: A 25; D 60; F.O1 40; F.O2 60; SL 40; SR 60; [power M3 40]; [power M4 60]",
        "80: A 30; D 22; F.O1 30; F.O2 70; C.TRUE 22; SL 30; SR 70; E.O0 60; E.O1 -60; SL 60; SR -60; [power M3 60]; [power M4 -60]",
        "100: A 40; D 30; F.O1 20; F.O2 80",
        "120: A 20; D 80; F.O1 50; F.O2 50",
        "140: A 18; D 80; F.O1 54; F.O2 46",
        "160: A 20; D 80; F.O1 50; F.O2 50",
        "180: A 20; D 80; F.O1 50; F.O2 50; SL 50; SR 50; [power M3 50]; [power M4 50]",
        "200: A 15; D 80; F.O1 60; F.O2 40; SL 60; SR 40; [power M3 60]; [power M4 40]",
    ];
    assert_eq!(lines, expected);
}

#[test]
fn a_second_obstacle_keeps_the_window_and_a_short_one_is_one_instant() {
    let mut readings = WALL_READINGS;
    readings[6].1 = 20;
    let lines = with(&main_only(WALL), ["A1", "D1"], &readings);
    let last = commits(&lines).pop().unwrap_or_default();
    assert_eq!(last, "140: [power M3 60] [power M4 -60]");
    let short = WALL.replace("time=100", "time=10");
    let all = commits(&with(&main_only(&short), ["A1", "D1"], &WALL_READINGS));
    assert_eq!(all.len(), 10);
    assert_eq!(all[3], "80: [power M3 60] [power M4 -60]");
    assert_eq!(all[4], "100: [power M3 20] [power M4 80]");
}

#[test]
fn the_order_of_blocks_changes_no_command() {
    let swapped = WALL
        .replacen("A Sensor {VarName=sensorA1}", "", 1)
        .replacen(
            "D Sensor {VarName=sensorD1}",
            "D Sensor {VarName=sensorD1}\nA Sensor {VarName=sensorA1}",
            1,
        );
    let one = commits(&with(&main_only(WALL), ["A1", "D1"], &WALL_READINGS));
    let other = commits(&with(&main_only(&swapped), ["A1", "D1"], &WALL_READINGS));
    assert_eq!(one, other);
}

#[test]
fn a_line_follower_as_a_controller_in_functions() {
    let text = "
        V Variable {variable=kp = 0.5; ki = 0.25; kd = 2; e = 0.0; i = 0.0; ep = 0.0; u = 0.0}
        L Sensor {VarName=sensorA1}
        R Sensor {VarName=sensorA2}
        P Text programming {IO0=e = I0 - I1; i = max(0-40, min(40, i + e)) | IO1=u = kp*e + ki*i + kd*(e - ep); ep = e | IO2=50 - u | IO3=50 + u}
        M Motors {synch=false}
        L.OUT > P.I0
        R.OUT > P.I1
        P.O2 > M.M3
        P.O3 > M.M4";
    let readings = [
        (50, 50),
        (58, 50),
        (62, 50),
        (54, 50),
        (50, 50),
        (46, 50),
        (50, 54),
        (50, 50),
    ];
    let lines = with(&main_only(text), ["A1", "A2"], &readings);
    let wanted = [
        (50, 50),
        (28, 72),
        (31, 69),
        (58, 42),
        (52, 48),
        (55, 45),
        (48, 52),
        (38, 62),
    ];
    let wanted: Vec<String> = (1..)
        .zip(wanted)
        .map(|(at, (left, right))| format!("{}: [power M3 {left}] [power M4 {right}]", 20 * at))
        .collect();
    assert_eq!(commits(&lines), wanted);
    assert_eq!(
        lines[1],
        "40: L 58; R 50; P.O2 28; P.O3 72; [power M3 28]; [power M4 72]"
    );
    // Nothing is undeclared without the first block: its absence is an error at the first reading.
    let without = text.replacen(
        "V Variable {variable=kp = 0.5; ki = 0.25; kd = 2; e = 0.0; i = 0.0; ep = 0.0; u = 0.0}",
        "",
        1,
    );
    let mut robot = Script::default();
    robot.readings.insert("A1", vec![50]);
    robot.readings.insert("A2", vec![50]);
    let (lines, status) = run(&main_only(&without), 40, &mut robot, |_, _| {});
    let error = lines.last().cloned().unwrap_or_default();
    assert!(
        error.contains("main: Text programming 'P': 'IO0', 1:"),
        "{error}"
    );
    let ended = Status::Ended {
        at: 20,
        with_errors: true,
    };
    assert_eq!(status, ended);
    assert_eq!(robot.commands, ["rest"]);
}

#[test]
fn a_potential_field_of_motor_schemas() {
    let text = "
        L Sensor {VarName=sensorD1}
        R Sensor {VarName=sensorD2}
        RL Text programming {IO0=k = max(0, 60 - I0) | IO1={0 - 0.75*k, 0.5*k}}
        RR Text programming {IO0=k = max(0, 60 - I0) | IO1={0 - 0.75*k, 0 - 0.5*k}}
        S Text programming {IO0=x = 60 + I0[0] + I1[0] | IO1=y = I0[1] + I1[1] | IO2=x + y | IO3=x - y}
        M Motors {synch=true}
        L.OUT > RL.I0
        R.OUT > RR.I0
        RL.O1 > S.I0
        RR.O1 > S.I1
        S.O2 > M.M3
        S.O3 > M.M4";
    let readings = [
        (100, 100),
        (60, 100),
        (54, 100),
        (100, 20),
        (20, 20),
        (30, 50),
    ];
    let lines = with(&main_only(text), ["D1", "D2"], &readings);
    let wanted = [(60, 60), (60, 60), (59, 53), (10, 50), (0, 0), (40, 20)];
    let wanted: Vec<String> = (1..)
        .zip(wanted)
        .map(|(at, (left, right))| format!("{}: [power M3 {left}] [power M4 {right}]", 20 * at))
        .collect();
    assert_eq!(commits(&lines), wanted);
    assert!(lines[2].contains("S.O2 58.5; S.O3 52.5"), "{}", lines[2]);
}
