//! Motors, encoders, sensors, buttons, screen, files: against numbers that the real program gave.

use super::{Ran, Sketch, chain, code, run, run_with};
use crate::lower::World;
use crate::machine::Options;
use crate::ports::Port;
use crate::stand_in::StandIn;

fn near(ran: &Ran, x: f64, y: f64, degrees: f64) {
    let pose = ran.robot.pose;
    let off = (pose.x - x)
        .abs()
        .max((pose.y - y).abs())
        .max((pose.degrees - degrees).abs());
    assert!(off < 6e-5, "{pose:?} for {x} {y} {degrees}");
}

/// Drives for a second with powers of both wheels, stops, notes encoder and gyroscope, and rolls out.
fn drive(left: &str, right: &str) -> Ran {
    run(
        &chain(&[
            ("TrikV6EnginesForward", &[("Ports", "M3"), ("Power", left)]),
            ("TrikV6EnginesForward", &[("Ports", "M4"), ("Power", right)]),
            ("Timer", &[("Delay", "1000")]),
            ("TrikV6EnginesStop", &[]),
            ("Function", &[("Body", "at_once = encoder3")]),
            ("Timer", &[("Delay", "100")]),
            (
                "Function",
                &[("Body", "later = encoder3; angle = gyroscope[6]")],
            ),
        ]),
        3000,
    )
}

#[test]
fn a_second_straight_on() {
    let ran = drive("100", "100");
    near(&ran, 76.7945, 0.0, 0.0);
    assert_eq!(
        (ran.text("at_once").as_str(), ran.text("later").as_str()),
        ("544", "550")
    );
    near(&drive("150", "100 + 50"), 76.7945, 0.0, 0.0);
    near(&drive("-50", "-49.6"), -38.3972, 0.0, 0.0);
}

#[test]
fn a_second_on_the_spot_and_around() {
    let ran = drive("100", "-100");
    near(&ran, -29.0954, -5.1303, 200.0);
    assert_eq!(ran.text("angle"), "-160000");
    near(&drive("100", "50"), 45.2007, 35.0667, 50.0);
}

#[test]
fn an_encoder_stops_at_363() {
    let ran = run(
        &chain(&[
            ("TrikV6EnginesForward", &[]),
            ("TrikV62WaitForEncoder", &[("TachoLimit", "360")]),
            ("TrikV6EnginesStop", &[]),
            ("Timer", &[("Delay", "100")]),
            ("Function", &[("Body", "seen = encoder3")]),
        ]),
        3000,
    );
    assert_eq!(ran.text("seen"), "363");
    assert!(
        (ran.robot.pose.x - 50.68).abs() < 0.005,
        "{:?}",
        ran.robot.pose
    );
}

#[test]
fn a_motor_without_a_wheel_turns_no_encoder() {
    let ran = run(
        &chain(&[
            ("TrikV6EnginesForward", &[("Ports", "M1")]),
            ("Timer", &[]),
            ("Function", &[("Body", "seen = encoder1")]),
        ]),
        3000,
    );
    assert_eq!(ran.text("seen"), "0");
    assert_eq!(ran.robot.power(Port::named("M1").unwrap()), 0);
}

#[test]
fn ports_are_lists_and_other_ports_are_left_out() {
    let ran = run(
        &chain(&[
            (
                "TrikV6EnginesForward",
                &[("Ports", "M1, 'M2', \"A1\", M4"), ("Power", "2 ^ 3")],
            ),
            ("TrikV6EnginesBackward", &[("Ports", "M3"), ("Power", "30")]),
            (
                "TrikV62AngularServo",
                &[("Ports", "S1, S2"), ("Power", "-145")],
            ),
            ("TrikV62ClearEncoder", &[("Ports", "E1, B2,M3,X")]),
            ("TrikV6EnginesStop", &[("Mode", "brake"), ("Ports", "M1")]),
        ]),
        100,
    );
    let expected = [
        "30 power M1 8",
        "30 power M2 8",
        "30 power M4 8",
        "30 power M3 -30",
        "30 servo S1 -145",
        "30 servo S2 -145",
        "30 reset E1",
        "30 reset E2",
        "30 reset E3",
        "30 off M1 brake",
        "30 rest",
    ];
    assert_eq!(ran.log(), expected);
}

#[test]
fn clearing_encoders_costs_a_step_within_a_turn() {
    for (delay, continues) in [("10", 40), ("20", 50), ("30", 60), ("40", 70)] {
        let mut sketch = Sketch::new();
        let start = sketch.block("InitialNode", &[]);
        // A wait for an encoder ends after the events of its step, where clearing waits for a turn.
        let wait = sketch.block("Timer", &[("Delay", delay)]);
        let passed = sketch.block("TrikV62WaitForEncoder", &[("TachoLimit", "-1")]);
        let clear = sketch.block("TrikV62ClearEncoder", &[]);
        let note = code(&mut sketch, "t = time()");
        let end = sketch.block("FinalNode", &[]);
        sketch.chain(&[start, wait, passed, clear, note, end]);
        let ran = run(&sketch, 500);
        let lost = if continues % 30 == 0 { 0 } else { 10 };
        assert_eq!(ran.text("t"), (continues + lost).to_string(), "{delay}");
    }
}

/// Waits with a script of readings by time, and says when it went on.
fn wait_for(
    kind: &str,
    properties: &[(&str, &str)],
    world: World,
    script: impl Fn(&mut StandIn),
) -> Ran {
    let sketch = chain(&[(kind, properties)]);
    run_with(&sketch, 2000, Options::of(world), world, script)
}

#[test]
fn sensors_are_compared_with_all_signs() {
    for (sign, reading, holds) in [
        ("greater", 31, true),
        ("greater", 30, false),
        ("less", 29, true),
        ("less", 30, false),
        ("notLess", 30, true),
        ("notLess", 29, false),
        ("notGreater", 30, true),
        ("notGreater", 31, false),
        ("equals", 30, true),
        ("equals", 29, false),
        ("nonsense", 30, false),
    ] {
        for (kind, port, value) in [
            ("TrikWaitForLight", "A3", "Percents"),
            ("TrikWaitForIRDistance", "A3", "Distance"),
            ("TrikWaitForSonarDistance", "D2", "Distance"),
        ] {
            let properties = [("Port", port), (value, "10 * 3"), ("Sign", sign)];
            let ran = wait_for(kind, &properties, World::default(), |robot| {
                robot.readings.insert(Port::named(port).unwrap(), reading);
            });
            assert_eq!(ran.end().is_some(), holds, "{kind} {sign} {reading}");
        }
    }
}

#[test]
fn a_sensor_that_is_not_there_is_told() {
    let ran = wait_for(
        "TrikWaitForTouchSensor",
        &[("Port", "A4")],
        World::default(),
        |_| {},
    );
    assert_eq!(ran.errors(), ["Touch sensor is not configured on port A4"]);
    let ran = wait_for(
        "TrikWaitForButton",
        &[("Button", "Hat")],
        World::default(),
        |_| {},
    );
    assert_eq!(ran.errors(), ["Incorrect button port Hat"]);
    let ran = wait_for("TrikReadLidar", &[], World::default(), |_| {});
    assert_eq!(ran.errors(), ["Lidar is not configured."]);
}

#[test]
fn another_sensor_on_the_port_keeps_the_program_from_running() {
    const WORLD: &str = r#"<root><robots><robot id="trikKitRobot"><sensors>
        <sensor port="JA1###input######sensor1" type="trik::robotModel::parts::TrikTouchSensor"/>
        <sensor port="A1###input###JA1###sensorA1" type="trik::robotModel::parts::TrikInfraredSensor"/>
        <sensor port="A2###input###JA2###sensorA2" type=""/>
        <sensor port="A3###input###sensorA3" type="trik::robotModel::parts::TrikTouchSensor"/>
    </sensors></robot></robots></root>"#;
    let told = |kind: &str, port: &str, locked: &str, world: World| {
        let mut sketch = chain(&[(kind, &[("Port", port), ("Sign", "greater")])]);
        sketch.world(WORLD);
        sketch.meta("twoDModelSensorsReadOnly", locked);
        let ran = run_with(&sketch, 100, Options::of(world), world, |robot| {
            robot.readings.insert(Port::named(port).unwrap(), 50);
        });
        ran.errors().join("; ")
    };
    let here = World::default();
    let wrong =
        |port| format!("Sensor on port {port} does not correspond to blocks on the diagram.");
    assert_eq!(told("TrikWaitForIRDistance", "A1", "false", here), "");
    assert_eq!(told("TrikWaitForLight", "A1", "false", here), wrong("A1"));
    assert_eq!(told("TrikWaitForLight", "A2", "false", here), "");
    assert_eq!(told("TrikWaitForLight", "A2", "true", here), wrong("A2"));
    assert_eq!(told("TrikWaitForLight", "A3", "false", here), "");
    assert_eq!(told("TrikWaitForLight", "A1", "true", World::Robot), "");
}

#[test]
fn buttons_and_the_gamepad_are_waited_for() {
    let pressed = |name: &'static str| {
        move |robot: &mut StandIn| {
            robot.readings.insert(Port::named(name).unwrap(), 1);
        }
    };
    for (kind, properties, port) in [
        ("TrikWaitForButton", ("Button", "Esc"), "Esc"),
        (
            "TrikWaitGamepadButton",
            ("Button", "2"),
            "GamepadButton2Port",
        ),
        ("TrikWaitPadPress", ("Pad", "2"), "GamepadPad2PressedPort"),
        (
            "TrikWaitGamepadConnect",
            ("", ""),
            "GamepadConnectionIndicatorPort",
        ),
        ("TrikWaitForMotion", ("", ""), "F1"),
    ] {
        let ran = wait_for(kind, &[properties], World::Robot, pressed(port));
        assert_eq!(ran.end(), Some(0), "{kind}");
    }
    let ran = wait_for(
        "TrikWaitGamepadDisconnect",
        &[],
        World::Robot,
        pressed("GamepadConnectionIndicatorPort"),
    );
    assert_eq!((ran.end(), ran.errors().len()), (None, 0));
    let vector = |name: &'static str, numbers: &'static [i32]| {
        move |robot: &mut StandIn| {
            robot
                .vectors
                .insert(Port::named(name).unwrap(), numbers.to_vec());
        }
    };
    let upright = vector("AccelerometerPort", &[3, 4, 4090]);
    let axis = [("AccelerationAxis", "zAxis"), ("Acceleration", "4000")];
    assert!(
        wait_for("TrikWaitForAccelerometer", &axis, World::Robot, upright)
            .end()
            .is_some()
    );
    let turned = vector("GyroscopePort", &[0, 0, 0, 0, 0, 0, 45_999]);
    let properties = [("Degrees", "45"), ("Sign", "equals")];
    assert!(
        wait_for(
            "TrikWaitForGyroscope",
            &properties,
            World::default(),
            turned
        )
        .end()
        .is_some()
    );
}

#[test]
fn codes_of_buttons_come_after_20_ms() {
    let sketch = chain(&[("GetButtonCode", &[("Wait", "false")])]);
    let ran = run(&sketch, 1000);
    assert_eq!((ran.text("x").as_str(), ran.end()), ("-1", Some(50)));
    let down = |robot: &mut StandIn| {
        robot.readings.insert(Port::named("Down").unwrap(), 1);
    };
    let sketch = chain(&[("GetButtonCode", &[("Variable", "key")])]);
    let ran = run_with(&sketch, 1000, Options::simulated(), World::default(), down);
    assert_eq!((ran.text("key").as_str(), ran.end()), ("108", Some(50)));
}

#[test]
fn random_numbers_lie_between_both_bounds() {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let zero = code(&mut sketch, "low = 100; high = -100");
    let random = sketch.block("Randomizer", &[("LowerBound", "3"), ("UpperBound", "-2")]);
    let note = code(&mut sketch, "low = min(low, x); high = max(high, x)");
    sketch.chain(&[start, zero, random, note, random]);
    let ran = run(&sketch, 500);
    assert_eq!(
        (ran.text("low").as_str(), ran.text("high").as_str()),
        ("-2", "3")
    );
}

#[test]
fn mail_is_a_text_whatever_is_in_it() {
    let world = World::Simulated {
        mailbox: true,
        gamepad: false,
    };
    let sketch = chain(&[
        ("TrikWaitForMessage", &[("Variable", "m")]),
        (
            "TrikWaitForMessage",
            &[("Variable", "n"), ("Synchronized", "false")],
        ),
        (
            "TrikWaitForMessage",
            &[("Variable", "o"), ("Synchronized", "false")],
        ),
        (
            "TrikSendMessage",
            &[("Message", "x + 1"), ("HullNumber", "2 + 1")],
        ),
        ("TrikSendMessage", &[("Message", "all")]),
        ("TrikJoinNetwork", &[("HullNumber", "7")]),
    ]);
    let ran = run_with(&sketch, 1000, Options::of(world), world, |robot| {
        robot.mail.push_back("\"quoted\"".into());
        robot.mail.push_back("a\" .. b\\\n".into());
    });
    assert_eq!(
        [ran.text("m"), ran.text("n"), ran.text("o")],
        ["quoted", "a\" .. b\\\n", ""]
    );
    let expected = [
        "130 send \"x + 1\" 3",
        "130 send \"all\"",
        "130 join 192.168.77.1 8889 7",
        "130 rest",
    ];
    assert_eq!(ran.log(), expected);
    assert_eq!(run(&sketch, 1000).end(), Some(30), "without a mailbox");
}

#[test]
fn a_person_is_asked_until_he_answers() {
    let sketch = chain(&[("Input", &[("variable", "x"), ("default", "9")])]);
    let answer =
        |text: &'static str| move |robot: &mut StandIn| robot.answers.push_back(text.into());
    let asked = |text| {
        run_with(
            &sketch,
            1000,
            Options::simulated(),
            World::default(),
            answer(text),
        )
    };
    assert_eq!(asked("2 + 3").text("x"), "5");
    assert_eq!(asked("").text("x"), "9");
    assert_eq!(run(&sketch, 1000).end(), None);
    let nonsense = asked("nonsense").errors();
    assert!(
        nonsense[0].contains("Undeclared identifier: nonsense"),
        "{nonsense:?}"
    );
}

#[test]
fn a_wrong_answer_is_asked_for_once_more_before_the_program_fails() {
    let question = [("variable", "x")];
    let sketch = chain(&[("Input", &question), ("Function", &[("Body", "y = x * 2")])]);
    let asked = |answers: &[&'static str], second_chances| {
        let answers: Vec<String> = answers.iter().map(|text| (*text).into()).collect();
        let answer = move |robot: &mut StandIn| {
            robot.answers.extend(answers.clone());
            robot.second_chances = second_chances;
        };
        run_with(
            &sketch,
            1000,
            Options::simulated(),
            World::default(),
            answer,
        )
    };
    // A name, nothing at all, a text where the program computes, half an expression, and a number that would count as 0.
    let ran = asked(&["nonsense", "", "'five'", "2 +", "99999999999", "21"], 5);
    assert_eq!(ran.errors(), Vec::<String>::new());
    assert_eq!(ran.text("y"), "42");
    let ran = asked(&["nonsense", "'five'"], 1);
    let error = &ran.machine.errors()[0];
    assert_eq!(error.words.english, "Type mismatch.");
    assert_eq!(error.place.property.as_deref(), Some("Expression"));
}

#[test]
fn what_is_printed_comes_to_the_console() {
    let ran = run(&chain(&[("Function", &[("Body", "print(1 .. 'x')")])]), 100);
    assert_eq!(ran.robot.log[0].1, "print \"1x\"");
}

#[test]
fn copies_of_sensors() {
    let sketch = chain(&[
        ("TrikDetectorToVariable", &[]),
        ("TrikReadLidar", &[("variable", "far")]),
    ]);
    let ran = run_with(
        &sketch,
        100,
        Options::simulated(),
        World::default(),
        |robot| {
            robot
                .vectors
                .insert(Port::named("LineSensorPort").unwrap(), vec![-17, 0, 30]);
            robot
                .vectors
                .insert(Port::named("LidarPort").unwrap(), vec![5; 360]);
        },
    );
    assert_eq!((ran.text("err").as_str(), ran.errors().len()), ("-17", 0));
    let Some(lang_expr::Value::List(list)) = ran.machine.variable("far") else {
        panic!("{:?}", ran.machine.variable("far"));
    };
    assert_eq!(list.items().len(), 360);
}
