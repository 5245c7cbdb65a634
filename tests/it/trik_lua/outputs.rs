//! Motors and servos: what is written to a register or channel for a number, and what is read back.

use super::run::robot;

/// The list of duties of each type for these percents, from the register map of trikRuntime.
const PERCENTS: [f64; 8] = [1.0, 5.0, 10.0, 25.0, 50.0, 75.0, 90.0, 100.0];
const DUTIES: [(&str, [i8; 8]); 4] = [
    ("powerMotor", [1, 5, 10, 25, 50, 75, 90, 100]),
    ("motor95", [5, 6, 7, 11, 18, 33, 64, 100]),
    ("motor100", [4, 5, 7, 10, 16, 29, 49, 100]),
    ("motor350", [9, 9, 9, 10, 16, 29, 57, 100]),
];

#[test]
fn each_motor_type_has_the_duties_of_the_runtime() {
    for (kind, duties) in DUTIES {
        for (port, sign) in [("M1", 1), ("M2", -1), ("M3", -1), ("M4", -1)] {
            let mut robot = robot(&format!("{{ port = '{port}', type = '{kind}' }}"));
            let path = format!("motors/{port}");
            for (percent, duty) in PERCENTS.into_iter().zip(duties) {
                let place = format!("{kind} on {port} at {percent}");
                let forward = robot.write(&path, &[percent]);
                assert_eq!(forward, Ok(vec![(sign * duty) as u8]), "{place}");
                let backward = robot.write(&path, &[-percent]);
                assert_eq!(backward, Ok(vec![(-sign * duty) as u8]), "{place}");
            }
            assert_eq!(robot.write(&path, &[0.0]), Ok(vec![0]));
        }
    }
}

#[test]
fn a_motor_reads_the_least_percent_that_gives_its_duty() {
    let mut robot =
        robot("{ port = 'M2', type = 'powerMotor' }, { port = 'M1', type = 'motor350' }");
    for percent in -100..=100 {
        let byte = robot.write("motors/M2", &[f64::from(percent)]).unwrap();
        assert_eq!(robot.read("motors/M2", &byte), Ok(percent.to_string()));
    }
    // 1 to 24 percent of this motor are all a duty of 9.
    assert_eq!(robot.read("motors/M1", &[9]), Ok("1".into()));
    assert_eq!(robot.read("motors/M1", &[0xf7]), Ok("-1".into()));
    assert_eq!(robot.read("motors/M1", &[0]), Ok("0".into()));
    assert_eq!(robot.read("motors/M1/raw", &[0xf7]), Ok("-9".into()));
}

#[test]
fn a_motor_brakes_by_its_attribute_and_refuses_what_is_out_of_range() {
    let mut robot = robot("");
    assert_eq!(robot.write("motors/M3/brake", &[1.0]), Ok(vec![0x7f]));
    assert_eq!(robot.write("motors/M3/brake", &[0.0]), Ok(vec![0]));
    assert_eq!(robot.write("motors/M3", &[127.0]), Ok(vec![0x7f]));
    assert_eq!(robot.read("motors/M3/brake", &[0x7f]), Ok("1".into()));
    assert_eq!(robot.read("motors/M3/brake", &[100]), Ok("0".into()));
    assert_eq!(robot.read("motors/M3", &[0x7f]), Ok("127".into()));
    for wrong in [101.0, -101.0, 126.0, 128.0, 2147483647.0, -2147483648.0] {
        let reason = format!("ERANGE: duty_cycle is -100 to 100, not {wrong}");
        assert_eq!(robot.write("motors/M3", &[wrong]), Err(reason));
    }
    let reason = "ERANGE: brake is 0 to 1, not 2".to_owned();
    assert_eq!(robot.write("motors/M3/brake", &[2.0]), Err(reason));
}

#[test]
fn polarity_turns_a_motor_an_encoder_and_a_servo_round() {
    let mut robot = robot(
        "{ port = 'M1', type = 'powerMotor', polarity = 'inversed' }, { port = 'E1', polarity = 'inversed' },
         { port = 'S1', polarity = 'inversed' }, { port = 'S6', type = 'manipulatorServomotor', polarity = 'inversed' }",
    );
    assert_eq!(robot.write("motors/M1", &[10.0]), Ok(vec![0xf6]));
    assert_eq!(robot.read("motors/M1", &[0xf6]), Ok("10".into()));
    assert_eq!(
        robot.read("encoders/E1", &157i32.to_le_bytes()),
        Ok("100".into())
    );
    // 1425000 - 30 * 725000 / 90, cut.
    let width = 1_183_333u32.to_le_bytes();
    assert_eq!(robot.write("servos/S1", &[30.0]), Ok(width.to_vec()));
    assert_eq!(robot.read("servos/S1", &width), Ok("30".into()));
    let width = 2_300_000u32.to_le_bytes();
    assert_eq!(robot.write("servos/S6", &[0.0]), Ok(width.to_vec()));
}

#[test]
fn measured_points_make_a_motor_of_ones_own() {
    let mut robot = robot("{ port = 'M1', measures = { {0, 0}, {50, 100}, {100, 150} } }");
    // Speed 75 of 150 lies on the first segment: 37.5 percent of duty, cut. 70 percent is 105: 50 + 50 * 5 / 50.
    assert_eq!(robot.write("motors/M1", &[50.0]), Ok(vec![37]));
    assert_eq!(robot.write("motors/M1", &[70.0]), Ok(vec![55]));
    assert_eq!(robot.write("motors/M1", &[100.0]), Ok(vec![100]));
}

#[test]
fn each_servo_type_has_its_widths_and_reads_its_position_back() {
    let kinds = [
        (
            "angularServomotor",
            [-90, 0, 90],
            [700_000, 1_425_000, 2_150_000],
        ),
        (
            "continuousRotationServomotor",
            [-100, 0, 100],
            [700_000, 1_500_000, 2_300_000],
        ),
        (
            "manipulatorServomotor",
            [0, 50, 100],
            [530_000, 1_415_000, 2_300_000],
        ),
        (
            "quadroMotor",
            [0, 50, 100],
            [1_160_000, 1_580_000, 2_000_000],
        ),
        ("quadroEsc", [0, 50, 100], [1_100_000, 1_500_000, 1_900_000]),
    ];
    for (kind, positions, widths) in kinds {
        let mut robot = robot(&format!("{{ port = 'S4', type = '{kind}' }}"));
        for (position, width) in positions.into_iter().zip(widths) {
            let expected = u32::to_le_bytes(width).to_vec();
            let written = robot.write("servos/S4", &[f64::from(position)]);
            assert_eq!(written, Ok(expected), "{kind} at {position}");
        }
        for position in positions[0]..=positions[2] {
            let width = robot.write("servos/S4", &[f64::from(position)]).unwrap();
            assert_eq!(
                robot.read("servos/S4", &width),
                Ok(position.to_string()),
                "{kind}"
            );
        }
        let beyond = f64::from(positions[2] + 1);
        let reason = format!(
            "ERANGE: position is {} to {}, not {beyond}",
            positions[0], positions[2]
        );
        assert_eq!(robot.write("servos/S4", &[beyond]), Err(reason));
    }
}

#[test]
fn three_servo_ports_can_measure_pulses_instead() {
    let mut robot = robot("{ port = 'S2', type = 'pwmCapture', name = 'receiver' }");
    let text = |words: &str| {
        let mut tuple = words.as_bytes().to_vec();
        tuple.resize(64, 0);
        tuple
    };
    let good = text("50,52,49\n");
    assert_eq!(robot.read("servos/S2", &good), Ok("50".into()));
    assert_eq!(robot.read("servos/S2/raw", &good), Ok("50 52 49".into()));
    let duty = robot.read("servos/S2/duty_cycle", &text("7\n"));
    assert_eq!(duty, Ok("7".into()));
    for (words, reason) in [
        ("-1,-1,-1\n", "ETIMEDOUT: no pulses"),
        ("50,-1,50\n", "ETIMEDOUT: no pulses"),
        ("50,50\n", "EIO: '50,50' is no measurement"),
        ("", "EIO: '' is no measurement"),
        ("50,fast,50", "EIO: '50,fast,50' is no measurement"),
        ("50,50,9999999999", "EIO: 9999999999 is no measurement"),
    ] {
        assert_eq!(robot.read("servos/S2", &text(words)), Err(reason.into()));
    }
    assert_eq!(robot.node("servos/S2").rest, None);
    assert_eq!(robot.node("servos/S2").mode, 0o444);
    let setup = format!("{:?}", robot.loaded.config.setup);
    assert!(setup.contains("ecap_cap.1/capture") && !setup.contains("ecap_cap.2"));
    assert_eq!(
        super::run::refused("{ port = 'S4', type = 'pwmCapture' }"),
        "robot.lua:3: entry 1 (port 'S4'): only S1, S2 and S3 can measure pulses"
    );
}

#[test]
fn a_servo_that_is_off_has_no_position() {
    let mut robot = robot("");
    assert_eq!(
        robot.read("servos/S1", &[0; 4]),
        Err("EIO: the servo is off".into())
    );
    assert_eq!(robot.read("servos/S1/power", &[0; 4]), Ok("0".into()));
    assert_eq!(
        robot.read("servos/S1/power", &1_425_000u32.to_le_bytes()),
        Ok("1".into())
    );
    assert_eq!(robot.write("servos/S1/power", &[0.0]), Ok(vec![0; 4]));
    let rest = robot.node("servos/S1").rest.clone().unwrap();
    assert_eq!(robot.write("servos/S1", &rest), Ok(vec![0; 4]));
    let refused = robot.write("servos/S1/power", &[1.0]).unwrap_err();
    assert!(refused.starts_with("EINVAL: only 0 "), "{refused}");
}

#[test]
fn a_tone_is_a_text_for_its_program_and_refused_if_nobody_could_hear_it() {
    let mut robot = robot("");
    let mut text = b"440 500".to_vec();
    text.resize(32, 0);
    assert_eq!(robot.write("sound/tone", &[440.0, 500.0]), Ok(text));
    for (tone, reason) in [
        ([-440.0, 500.0], "frequency_hz is 20 to 7000, not -440"),
        ([19.0, 500.0], "frequency_hz is 20 to 7000, not 19"),
        ([7001.0, 500.0], "frequency_hz is 20 to 7000, not 7001"),
        ([440.0, 0.0], "duration_ms is 1 to 10000, not 0"),
        ([440.0, 10001.0], "duration_ms is 1 to 10000, not 10001"),
    ] {
        let refused = robot.write("sound/tone", &tone);
        assert_eq!(refused, Err(format!("ERANGE: {reason}")));
    }
}

#[test]
fn a_spoken_text_is_no_option_of_the_program_that_speaks() {
    let mut robot = robot("");
    let long = "-".repeat(400);
    for (text, spoken) in [
        ("hello", "hello"),
        ("-5", " -5"),
        ("5 - 3", "5 - 3"),
        (&long, &format!(" {long}")),
    ] {
        let mut wanted = spoken.as_bytes().to_vec();
        wanted.resize(401, 0);
        assert_eq!(robot.write_text("sound/say", text), Ok(wanted), "{text}");
    }
}

#[test]
fn the_lights_and_the_loudness_are_texts_of_sysfs() {
    let mut robot = robot("");
    let text = |word: &str| {
        let mut tuple = vec![0; 64];
        tuple[..word.len()].copy_from_slice(word.as_bytes());
        tuple
    };
    assert_eq!(robot.write("led/red", &[1.0]), Ok(text("1\n")));
    assert_eq!(robot.read("led/red", &text("255\n")), Ok("255".into()));
    assert!(robot.read("led/red", &text("on")).is_err());
    assert_eq!(
        robot.write("led/green", &[2.0]),
        Err("ERANGE: brightness is 0 to 1, not 2".into())
    );
    assert_eq!(robot.write("sound/volume", &[20.0]), Ok(text("20\n")));
    assert_eq!(
        robot.read("sound/volume", &text("20\n-1\n")),
        Ok("20".into())
    );
}
